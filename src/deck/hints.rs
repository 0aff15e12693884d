//! Words that other programs have for what ours has another word for. A user who guesses one is told ours.
//!
//! Words for schemes, sections and joints stand with these, see [`Kind`]. A row is only used where one of our words is known in
//! the table at hand, so that the same guess may mean `area` in a section and nothing elsewhere. What stands in another place of the deck has a sentence of its own.

use base::words::kinds::Kind;
use mechanics::constraints::joints::JOINTS;
use mechanics::elements::contact::surfaces::SURFACES;
use mechanics::integrators::SCHEMES;
use mechanics::materials::models::MATERIALS;
use mechanics::materials::overstress::OVERSTRESSES;
use mechanics::sections::SECTIONS;
use mechanics::solids::SOLIDS;

/// Guessed words, and ours: the first that is known where the guess stands.
type Row = (&'static [&'static str], &'static [&'static str]);

const KEYS: &[Row] = &[
    (&["type", "kind", "shape", "model", "law", "class"], &["kind", "shape", "model", "law", "scheme", "format"]),
    (&["dt", "h", "step", "timestep", "delta_t", "step_size", "increment"], &["time_step", "interval"]),
    (&["tend", "t_end", "tmax", "t_max", "duration", "total_time", "final_time", "stop_time"], &["end_time"]),
    (&["dtmin", "dt_min", "min_step", "minimum_step", "min_time_step"], &["least_step"]),
    (&["tol", "rtol", "epsilon"], &["tolerance", "error_tolerance"]),
    (&["max_iterations", "max_iter", "maxiter", "iterations"], &["limit"]),
    (&["algorithm", "integrator", "solver"], &["scheme", "method"]),
    (&["rho_inf", "rhoinf", "rho_infinity"], &["spectral_radius"]),
    (&["e", "young", "youngs", "young_modulus", "elastic_modulus", "modulus", "Ex"], &["youngs_modulus"]),
    (&["poisson", "poissons_ratio", "PRXY", "prxy"], &["poisson_ratio"]),
    (&["mass_density", "DENS", "dens"], &["density"]),
    (&["fy", "Fy", "sigma_y", "SIGY", "yield", "yield_strength", "sigy"], &["yield_stress"]),
    (&["tangent_modulus", "ETAN", "etan", "plastic_modulus", "H"], &["hardening_modulus"]),
    (&["plastic", "hardening_curve", "stress_strain"], &["hardening"]),
    (&["cowper_symonds", "cowper-symonds", "perzyna", "rate_dependent"], &["viscosity"]),
    (&["D"], &["rate", "diameter"]),
    (&["q", "n", "m"], &["exponent"]),
    (&["A", "cross_section_area"], &["area"]),
    (&["Iy", "Iz", "I", "Iyy", "Izz", "second_moments"], &["moments"]),
    (&["Iyz"], &["product_moment"]),
    (&["J", "It", "Ip", "Jxx"], &["torsion_constant", "inertia"]),
    (&["Ay", "Az", "Avy", "Avz"], &["shear_areas"]),
    (&["EA"], &["axial_stiffness"]),
    (&["EI", "EIy", "EIz"], &["bending_stiffness"]),
    (&["GA", "GAy", "GAz"], &["shear_stiffness"]),
    (&["GJ", "GIt"], &["torsional_stiffness"]),
    (&["b", "B", "breadth"], &["width"]),
    (&["h", "depth"], &["height"]),
    (&["d", "outer_diameter"], &["diameter", "damping"]),
    (&["r", "R", "outer_radius"], &["radius"]),
    (&["t", "wall", "wall_thickness", "thick"], &["thickness"]),
    (&["tw"], &["web_thickness"]),
    (&["tf"], &["flange_thickness"]),
    (&["position", "pos", "cog", "cg", "com", "centre", "origin", "location", "center_of_mass"], &["center", "point"]),
    (&["omega", "rotational_velocity", "spin"], &["angular_velocity"]),
    (&["initial_velocity", "v", "v0"], &["velocity"]),
    (&["geometry"], &["shape"]),
    (&["node", "nodes", "point", "on", "set"], &["at", "nodes", "with", "path"]),
    (&["fixed", "dof", "dofs", "constrain", "restrain", "boundary"], &["fix"]),
    (&["displacement", "prescribed", "imposed", "move"], &["motion"]),
    (&["euler", "euler_angles", "rotation_sequence", "rotation_order"], &["rotation"]),
    (&["torque", "couple", "moments"], &["moment"]),
    (&["value", "magnitude", "f", "F"], &["force"]),
    (&["function", "curve", "time_series", "time_function", "drive", "tsTag"], &["amplitude"]),
    (&["factor"], &["scale"]),
    (&["table"], &["points"]),
    (&["freq", "f"], &["frequency"]),
    (&["k", "K", "spring", "rate", "penalty", "contact_stiffness"], &["stiffness"]),
    (&["c", "C", "damper", "viscous"], &["damping"]),
    (&["rest_length", "natural_length", "unstretched_length", "l0", "L0", "length"], &["free_length"]),
    (&["prestress", "pretension", "prestrain", "preload"], &["preload", "free_length"]),
    (&["clearance", "slack", "initial_gap"], &["gap"]),
    (&["body1", "body_1", "body_a", "body_i", "bodyA", "parent", "node1", "node_i", "start"], &["from"]),
    (&["body2", "body_2", "body_b", "body_j", "bodyB", "child", "node2", "node_j", "end"], &["to"]),
    (&["mu", "coulomb", "friction_coefficient"], &["friction"]),
    (&["cor", "e", "bounce"], &["restitution"]),
    (&["slave", "slaves", "secondary", "points"], &["with", "nodes"]),
    (&["master", "primary", "target"], &["surface"]),
    (&["master", "rigid_body", "reference"], &["body"]),
    (&["n", "divisions", "mesh", "num_elements", "n_elements", "nel"], &["elements"]),
    (&["mat", "material_name"], &["material"]),
    (&["profile", "cross_section", "sec"], &["section"]),
    (&["up", "n1", "y_axis", "local_y"], &["orientation"]),
    (&["degree", "p"], &["order"]),
    (&["frequency", "stride", "freq"], &["every"]),
    (&["g", "acceleration"], &["gravity"]),
    (&["alphaM", "a0", "alpha_m"], &["mass_factor"]),
    (&["betaK", "a1", "beta_k", "beta_R"], &["stiffness_factor"]),
    (&["nodes", "node", "coordinates", "vertices"], &["points"]),
    (&["truss", "trusses", "cables", "rods", "ropes"], &["bars"]),
    (&["frames", "frame", "members"], &["beams"]),
    (&["plates", "membranes", "plate"], &["shells"]),
    (&["rigid_bodies", "rigid", "body"], &["bodies"]),
    (&["boundary", "boundaries", "bc", "bcs", "constraints", "spc", "fixes", "boundary_conditions"], &["supports"]),
    (&["springs", "spring", "dampers", "bushings", "connectors", "gaps"], &["links"]),
    (&["forces", "force", "cload", "pressures"], &["loads"]),
    (&["curves", "functions", "time_series", "timeseries", "drives", "amplitude"], &["amplitudes"]),
    (&["groups", "nset", "elset"], &["sets"]),
    (&["mpc", "rbe2", "equaldof", "couplings", "tie", "ties"], &["attachments"]),
    (&["contact_pairs", "collisions", "interactions"], &["contacts"]),
    (&["initial_conditions", "initial_velocity"], &["initial"]),
    (&["step", "steps", "simulation", "control", "time"], &["analysis"]),
    (&["solver", "newton", "nonlinear"], &["iteration"]),
    (&["results", "recorder", "recorders", "history"], &["output"]),
    (&["assertions", "tests", "checks"], &["expect"]),
];

/// Guesses at the top of the deck, or anywhere, for what stands elsewhere.
const ELSEWHERE: &[(&[&str], &str)] = &[
    (&["rayleigh"], "Rayleigh damping is [damping] with `alpha` (mass_factor) and `beta` (stiffness_factor)"),
    (&["extends", "include", "import", "base"], "a deck is one file; variants of it are made with --set KEY=VALUE"),
    (&["elements"], "elements are [[beams]], [[bars]] and [[shells]]"),
    (
        &["modes", "eigenvalues", "modal"],
        "modes are `kind = \"modal\"` in [analysis], with their number or `up_to` a frequency",
    ),
    (
        &["frequencies", "response", "harmonic", "frequency_response", "steady_state"],
        "a frequency response is `kind = \"frequency-response\"` in [analysis], with its `frequencies`",
    ),
    (&["temperature", "thermal"], "there are no temperatures"),
];

/// Guesses that one word of ours does not answer, in the table that has the key in the middle: the sentence, and the key that
/// is then not missing.
const NOTES: &[(&[&str], &str, &str, Option<&str>)] = &[
    (
        &["vecxz", "local_z", "z_axis"],
        "shear_yields",
        "that is `orientation` here, which lies in the local x-y plane, not in x-z",
        Some("orientation"),
    ),
    (
        &["csv", "path", "record", "file_name", "filename", "filePath"],
        "angular_frequency",
        "that is `file` here; `columns`, `rows` and `time_step` say how it is read",
        Some("file"),
    ),
    (
        &["times", "time", "t", "values", "data", "y"],
        "angular_frequency",
        "that is `points` here, in pairs: [[time, value], ...]",
        Some("points"),
    ),
    (&["rayleigh"], "nodal", "those are `alpha` and `beta` here: C = alpha M + beta K", None),
    (
        &["ratio", "damping_ratio", "xi", "zeta", "critical", "modal"],
        "nodal",
        "a ratio xi at the angular frequency w is `alpha` = 2 xi w, or `beta` = 2 xi / w",
        None,
    ),
    (
        &["drive", "velocity", "angular_velocity", "speed", "position", "acceleration", "angle"],
        "cross_axis",
        "a driven joint has `motion` = { position | velocity | acceleration = ..., amplitude = \"...\" }",
        Some("motion"),
    ),
    (
        &["motor", "torque", "moment", "force", "actuator"],
        "cross_axis",
        "a force or moment between the ends is `effort` = { value = ..., amplitude = \"...\" }",
        Some("effort"),
    ),
    (&["spring", "k"], "cross_axis", "that is `stiffness` here, along the coordinate", Some("stiffness")),
    (&["stops", "stop", "range"], "cross_axis", "that is `limits` = [a, b], with `limit_stiffness`", Some("limits")),
    (&["pitch"], "cross_axis", "that is `lead`, the length of a turn", Some("lead")),
    (&["bodies", "between", "nodes", "ends"], "cross_axis", "give its two ends: `from` and `to`", None),
    (&["name", "at", "id"], "ground", "an end is { node = ... }, { body = ... } or { ground = [x, y, z] }", None),
    (
        &["fx", "fy", "fz", "Fx", "Fy", "Fz", "px", "py", "pz"],
        "follower",
        "that is `force` = [x, y, z] here",
        Some("force"),
    ),
    (&["mx", "my", "mz", "Mx", "My", "Mz"], "follower", "that is `moment` = [x, y, z] here", Some("moment")),
    (
        &["q", "w", "udl", "beam", "beams", "line_load", "distributed", "load_per_length"],
        "follower",
        "that is `force_per_length` here, in global axes, or `local` in those of the section",
        Some("force_per_length"),
    ),
    (&["phases", "phase", "load_cases"], "integrator", "that is [[stages]] here", Some("stages")),
    (
        &["rigid_links", "rigid_link", "diaphragm", "diaphragms", "rigid_diaphragm", "rigid_elements"],
        "integrator",
        "that is a body in [[bodies]], with the nodes that move with it in [[attachments]]",
        None,
    ),
    (
        &[
            "ground_motion",
            "earthquake",
            "base_acceleration",
            "base_excitation",
            "uniform_excitation",
            "ground_acceleration",
        ],
        "integrator",
        "that is [[environment.base_acceleration]] here",
        None,
    ),
    (
        &["displacement", "displacements", "velocity", "velocities", "acceleration", "accelerations", "disp", "u"],
        "reactions",
        "nodes.csv has them, for the nodes that `nodes` chooses",
        None,
    ),
    (&["stress", "stresses", "strain", "forces", "section_forces", "S"], "reactions", "that is `sections` here", None),
    (&["joint_forces", "rf", "RF"], "reactions", "that is `reactions` here", None),
    (&["bodies"], "reactions", "bodies.csv is written by itself", None),
    (&["vtk", "vtu", "paraview"], "reactions", "that is `fields` = { format = \"vtu\" } here", None),
    (
        &["half", "half_size", "half_lengths", "dimensions", "lengths", "extent"],
        "ends",
        "that is `size` here, full lengths",
        Some("size"),
    ),
    (
        &["displacement", "displacements", "position", "positions", "rotation"],
        "normal_velocity",
        "parts begin where their points lie: only velocities are given",
        None,
    ),
    (
        &["value", "constant"],
        "history",
        "that is `scale` here, with an `amplitude` of kind \"constant\" or \"ramp\"",
        None,
    ),
    (
        &["rotation", "euler", "angles", "quaternion", "orientation", "frame"],
        "inertia",
        "a body's axes at t = 0 are the global ones: give its inertia about them",
        None,
    ),
];

/// Examples of values behind a key, for whoever has written another type.
const EXAMPLES: &[(&[&str], &str)] = &[
    (&["from", "to"], "such as { body = \"block\" }, { node = \"tip\" } or { ground = [0.0, 0.0, 0.0] }"),
    (&["surface"], "such as { shape = \"plane\", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }"),
    (&["fields"], "such as { format = \"vtu\" }"),
    (&["stop", "when"], "such as { at = \"knee\", quantity = \"ux\", value = 0.2 }"),
    (&["viscosity"], "such as { law = \"power\", rate = 40.4, exponent = 5.0 }"),
    (&["motion"], "such as { ux = { amplitude = \"quake\" } }"),
    (&["ux", "uy", "uz", "rx", "ry", "rz"], "such as { amplitude = \"quake\", scale = 0.1 }"),
    (&["shape"], "such as { kind = \"box\", size = [1.0, 1.0, 1.0] }"),
    (&["base_acceleration"], "begin it with [[environment.base_acceleration]]"),
    (&["point"], "coordinates; an end of a link or joint on a named point is { node = ... }"),
    (&["inertia"], "three moments: xx, yy, zz; or six: xx, yy, zz, xy, yz, zx"),
    (&["fix", "dofs"], "\"all\", or directions such as [\"ux\", \"ry\"]"),
];

const VALUES: &[Row] = &[
    (&["transient", "time-history", "time_history", "explicit", "implicit", "dynamics"], &["dynamic"]),
    (&["eigen", "eigenvalue", "frequency", "natural", "modes"], &["modal"]),
    (&["linear-buckling", "buckle", "stability"], &["buckling"]),
    (&["harmonic", "frf", "steady-state", "steady-state-dynamics", "response"], &["frequency-response"]),
    (&["quasi-static", "quasistatic", "statics", "load-stepping"], &["static"]),
    (&["riks", "arclength", "arc_length"], &["arc-length"]),
    (&["newton", "newton-raphson", "full-newton"], &["tangent-stiffness", "iteration"]),
    (&["modified-newton", "modified_newton"], &["step", "initial-load"]),
    (&["initial-stiffness", "elastic"], &["initial-load", "elastic"]),
    (&["pin", "pinned"], &["translations"]),
    (&["fixed", "encastre", "clamped", "fully-fixed", "built-in"], &["all"]),
    (&["simply-supported", "displacements", "xyz"], &["translations"]),
    (&["quad", "quad4", "S4", "shell4", "mitc4"], &["quadrilateral"]),
    (&["tri", "tri3", "S3", "shell3"], &["triangle"]),
    (&["tabular", "series", "piecewise-linear", "points"], &["table"]),
    (&["sin", "harmonic", "cos", "cosine", "periodic"], &["sine"]),
    (&["heaviside", "rectangular", "pulse"], &["step"]),
    (&["spring", "elastic"], &["linear"]),
    (&["nonlinear", "multilinear"], &["table"]),
    (&["maximum", "largest"], &["max"]),
    (&["minimum", "smallest"], &["min"]),
    (&["absolute", "absmax"], &["abs"]),
    (&["gap", "compression", "no-tension"], &["compression-only"]),
    (&["cable", "tension", "no-compression", "hook"], &["tension-only"]),
    (&["diagonal"], &["lumped"]),
    (&["multiplier", "lagrange", "penalty"], &["multipliers"]),
    (&["eliminate", "transformation"], &["elimination"]),
    (&["vtk", "paraview", "pvd"], &["vtu"]),
    (&["U1", "u1", "1", "x", "dx", "UX"], &["ux"]),
    (&["U2", "u2", "2", "y", "dy", "UY"], &["uy"]),
    (&["U3", "u3", "3", "z", "dz", "UZ"], &["uz"]),
    (&["UR1", "ur1", "4", "rotx", "RX"], &["rx"]),
    (&["UR2", "ur2", "5", "roty", "RY"], &["ry"]),
    (&["UR3", "ur3", "6", "rotz", "RZ"], &["rz"]),
];

/// Values that no word of ours stands for.
const NO_VALUES: &[(&[&str], &str)] = &[
    (&["hex", "hexahedron", "hex8", "tet", "tetrahedron", "C3D8", "wedge"], "there are no solid elements"),
    (&["johnson-cook", "hyperelastic", "concrete"], "the material models are elastic and J2 plasticity"),
];

/// The kind that a guessed word is meant to be, by what the kinds themselves say.
fn kind(guess: &str, known: &[&str]) -> Option<&'static str> {
    fn words<M>(list: &'static [&'static Kind<M>]) -> impl Iterator<Item = Row> {
        list.iter().map(|kind| (kind.guesses, std::slice::from_ref(&kind.word)))
    }
    let of_parts = words(SECTIONS).chain(words(MATERIALS)).chain(words(OVERSTRESSES)).chain(words(SOLIDS));
    let all: Vec<Row> = words(SCHEMES).chain(words(JOINTS)).chain(words(SURFACES)).chain(of_parts).collect();
    ours(&all, guess, known)
}

/// Second words of the kinds that are known here: a slip of the pen may be meant for one of them.
pub fn aliases(known: &[&str]) -> Vec<&'static str> {
    fn of<M>(list: &'static [&'static Kind<M>], known: &[&str]) -> Vec<&'static str> {
        list.iter().filter(|kind| known.contains(&kind.word)).flat_map(|kind| kind.aliases).copied().collect()
    }
    let of_parts = [of(SECTIONS, known), of(MATERIALS, known), of(OVERSTRESSES, known), of(SOLIDS, known)].concat();
    [of(SCHEMES, known), of(JOINTS, known), of(SURFACES, known), of_parts].concat()
}

/// Our word for a guessed one among those known here.
fn ours(rows: &[Row], guess: &str, known: &[&str]) -> Option<&'static str> {
    let of = rows.iter().filter(|(guesses, _)| guesses.contains(&guess)).flat_map(|(_, ours)| ours.iter());
    of.copied().find(|word| *word != guess && known.contains(word))
}

/// The key of a table that a guessed one is meant to be.
pub fn key(guess: &str, known: &[&str]) -> Option<&'static str> {
    ours(KEYS, guess, known)
}

/// What to say of a guessed key that one word does not answer, and the key that is then not missing.
pub fn note(guess: &str, known: &[&str]) -> Option<(&'static str, Option<&'static str>)> {
    let meant = |(guesses, mark, ..): &&(&[&str], &str, _, _)| guesses.contains(&guess) && known.contains(mark);
    NOTES.iter().find(meant).map(|(_, _, sentence, key)| (*sentence, *key))
}

/// What may stand behind a key.
pub fn example(key: &str) -> Option<&'static str> {
    EXAMPLES.iter().find(|(keys, _)| keys.contains(&key)).map(|(_, example)| *example)
}

/// Where to say what a guessed key says, if not in this table.
pub fn elsewhere(guess: &str) -> Option<&'static str> {
    ELSEWHERE.iter().find(|(guesses, _)| guesses.contains(&guess)).map(|(_, hint)| *hint)
}

/// What a guessed value should be.
pub fn value(guess: &str, known: &[&str]) -> Option<String> {
    if guess == "cowper-symonds" && known.contains(&"power") {
        return Some("Cowper-Symonds is the law \"power\", with rate = D and exponent = q".to_owned());
    }
    let word = kind(guess, known).or_else(|| ours(VALUES, guess, known)).map(|word| format!("that is `{word}` here"));
    word.or_else(|| NO_VALUES.iter().find(|(guesses, _)| guesses.contains(&guess)).map(|(_, hint)| (*hint).to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tables::{DeckTable, tables};
    use std::collections::HashSet;

    /// Keys and words that the schema knows.
    fn known() -> (HashSet<String>, HashSet<String>) {
        fn collect(value: &serde_json::Value, words: &mut HashSet<String>) {
            match value {
                serde_json::Value::Object(entries) => {
                    words.extend(entries.get("const").and_then(|word| word.as_str()).map(str::to_owned));
                    let list = entries.get("enum").and_then(|list| list.as_array()).into_iter().flatten();
                    words.extend(list.filter_map(|word| word.as_str().map(str::to_owned)));
                    entries.values().for_each(|value| collect(value, words));
                }
                serde_json::Value::Array(list) => list.iter().for_each(|value| collect(value, words)),
                _ => {}
            }
        }
        let mut words = HashSet::new();
        collect(schemars::schema_for!(crate::Deck).as_value(), &mut words);
        (tables().iter().flat_map(|table| table.keys.clone()).collect(), words)
    }

    /// All sentences, each with a key of the tables in which it is said, if it is said in some alone.
    fn sentences() -> impl Iterator<Item = (&'static str, &'static str)> {
        let notes = NOTES.iter().map(|(_, mark, sentence, _)| (*sentence, *mark));
        let anywhere = ELSEWHERE.iter().chain(NO_VALUES).map(|(_, sentence)| *sentence);
        let examples = EXAMPLES.iter().map(|(_, sentence)| *sentence);
        notes.chain(anywhere.chain(examples).map(|sentence| (sentence, "")))
    }

    #[test]
    fn every_hint_names_a_word_of_the_deck() {
        let (keys, words) = known();
        for (_, ours) in KEYS {
            ours.iter().for_each(|word| assert!(keys.contains(*word), "there is no key `{word}`"));
        }
        for (_, mark, _, meant) in NOTES {
            [Some(*mark), *meant]
                .into_iter()
                .flatten()
                .for_each(|word| assert!(keys.contains(word), "no key `{word}`"));
        }
        for (named, _) in EXAMPLES {
            named.iter().for_each(|word| assert!(keys.contains(*word), "there is no key `{word}`"));
        }
        for (_, ours) in VALUES {
            ours.iter().for_each(|word| assert!(words.contains(*word), "there is no word `{word}`"));
        }
    }

    /// Keys and tables that stand in a sentence between backticks or brackets are those of the deck.
    #[test]
    fn sentences_speak_of_what_there_is() {
        let (keys, words) = known();
        let labels: HashSet<&str> = tables().iter().map(|table| table.label.as_str()).collect();
        let mut seen = 0;
        for (sentence, _) in sentences() {
            for quoted in sentence.split('`').skip(1).step_by(2) {
                let of_text = quoted.split(|c: char| !(c.is_ascii_alphanumeric() || "_-".contains(c)));
                for word in of_text.filter(|word| word.starts_with(|c: char| c.is_ascii_alphabetic())) {
                    seen += 1;
                    assert!(keys.contains(word) || words.contains(word), "`{word}` in: {sentence}");
                }
            }
            for bracket in sentence.split_inclusive(']').filter_map(|part| part.rfind('[').map(|at| &part[at..])) {
                let name = bracket.trim_matches(['[', ']']);
                if keys.contains(name.split('.').next().unwrap()) && !name.contains([',', ' ']) {
                    seen += 1;
                    let is_there = [format!("[{name}]"), format!("[[{name}]]"), format!("[{name}.NAME]")];
                    assert!(is_there.iter().any(|label| labels.contains(label.as_str())), "[{name}] in: {sentence}");
                }
            }
        }
        assert!(seen > 40, "{seen}");
    }

    /// What a sentence denies is not there: keys, or words, of its tables that hold one of these. Whoever adds such a key finds the
    /// sentence here that denies it.
    const DENIALS: &[(&str, &[&str])] = &[
        ("that is `orientation` here, which lies in the local x-y plane, not in x-z", &["xz"]),
        ("parts begin where their points lie: only velocities are given", &["displace", "position"]),
        ("there are no temperatures", &["temperature", "thermal"]),
        ("there are no solid elements", &["solid", "hexa", "tetra"]),
        ("the material models are elastic and J2 plasticity", &["johnson", "hyper", "concrete"]),
        (
            "a body's axes at t = 0 are the global ones: give its inertia about them",
            &["orientation", "rotation", "frame"],
        ),
        ("bodies.csv is written by itself", &["bodies"]),
    ];

    #[test]
    fn no_hint_denies_what_there_is() {
        let (keys, words) = known();
        let tables = tables();
        let of_tables = |mark: &str| tables.iter().filter(|table| table.keys.iter().any(|key| key == mark)).collect();
        for (sentence, mark) in sentences() {
            let denies = |word: &str| ["no", "not", "only", "nothing", "never", "none", "cannot"].contains(&word);
            let listed = DENIALS.iter().find(|(listed, _)| *listed == sentence);
            let mut parts = sentence.split(|c: char| !c.is_ascii_alphabetic());
            assert!(listed.is_some() || !parts.any(denies), "list what this sentence denies: {sentence}");
            let here: Vec<&DeckTable> = of_tables(mark);
            let here: HashSet<&String> = match mark {
                "" => keys.union(&words).collect(),
                _ => here.into_iter().flat_map(|table| &table.keys).collect(),
            };
            for stem in listed.into_iter().flat_map(|(_, stems)| *stems) {
                let found = here.iter().find(|word| word.contains(stem));
                assert!(found.is_none(), "there is `{}`, which is denied: {sentence}", found.unwrap());
            }
        }
        for (listed, _) in DENIALS {
            assert!(sentences().any(|(sentence, _)| sentence == *listed), "nothing says: {listed}");
        }
        // A guess that is a key of the table is no guess.
        for (guesses, mark, sentence, _) in NOTES {
            for table in of_tables(mark) as Vec<&DeckTable> {
                let key = table.keys.iter().find(|key| guesses.contains(&key.as_str()));
                assert!(
                    key.is_none(),
                    "`{}` is a key of {}, and so no guess for: {sentence}",
                    key.unwrap(),
                    table.label
                );
            }
        }
    }

    #[test]
    fn a_guess_is_answered_where_our_word_is_known() {
        assert_eq!(key("torque", &["force", "moment"]), Some("moment"));
        assert_eq!(key("torque", &["axis"]), None);
        assert_eq!(key("dt", &["end_time", "time_step"]), Some("time_step"));
        assert_eq!(value("encastre", &["all", "translations"]).unwrap(), "that is `all` here");
        assert_eq!(value("verlet", &["newmark", "central-difference"]).unwrap(), "that is `central-difference` here");
        assert!(value("cowper-symonds", &["power", "linear"]).unwrap().contains("exponent = q"));
        assert!(value("hex", &["quadrilateral"]).unwrap().contains("no solid elements"));
        assert!(elsewhere("extends").unwrap().contains("--set"));
        assert_eq!(note("vecxz", &["orientation", "shear_yields"]).unwrap().1, Some("orientation"));
        assert!(note("vecxz", &["axis"]).is_none());
    }
}
