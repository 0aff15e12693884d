//! Reduced parts beside the parts that they stand for: static response, frequencies, motion, momenta, stages, and what is refused.

use crate::support::{assert_says_what_to_change, read_deck, read_stages, run_source, run_to_the_end, tables_of};
use nalgebra::{DMatrix, SymmetricEigen};
use rdsolve::diagnostic::Source;
use rdsolve::model::{self, Model};
use rdsolve::solve::{Frame, Outcome};
use std::f64::consts::TAU;

/// A steel arm of 20 elements, whose inner point `mid` nothing holds.
const ARM: &str = r#"
[materials.steel]
model = "elastic"
youngs_modulus = 2e11
poisson_ratio = 0.3
density = 7800.0
[sections.bar]
shape = "rectangle"
height = 0.02
width = 0.03
[points]
root = [0.0, 0.0, 0.0]
mid = [0.6, 0.0, 0.0]
tip = [1.0, 0.0, 0.2]
[[beams]]
name = "arm"
path = ["root", "mid", "tip"]
elements = 5
section = "bar"
material = "steel"
orientation = [0.0, 1.0, 0.0]
"#;
const CLAMP: &str = "[[supports]]\nat = \"root\"\nfix = \"all\"\n";
const TIP_LOAD: &str = "[[loads]]\nat = \"tip\"\nforce = [10.0, 20.0, -30.0]\nmoment = [1.0, -2.0, 3.0]\namplitude = \"force\"\n[amplitudes.force]\n";

/// A free plate of aluminium.
const PLATE: &str = r#"
[materials.metal]
model = "elastic"
youngs_modulus = 7e10
poisson_ratio = 0.3
density = 2700.0
[points]
a = [0.0, 0.0, 0.0]
b = [0.6, 0.0, 0.0]
c = [0.6, 0.4, 0.0]
d = [0.0, 0.4, 0.0]
[[shells]]
name = "plate"
corners = ["a", "b", "c", "d"]
elements = [6, 4]
thickness = 0.004
material = "metal"
"#;

fn reduced(text: &str, modes: usize) -> String {
    let key = format!("reduced = {modes}\n");
    let shell = text.contains("[[shells]]");
    let line = if shell { "thickness = 0.004\n" } else { "elements = 5\n" };
    text.replacen(line, &format!("{line}{key}"), 1)
}

fn last(of: &Model, probe: &mut dyn FnMut(&Frame) -> Vec<f64>) -> Vec<f64> {
    run_to_the_end(of, probe).rows.pop().expect("a row")
}

/// Positions of all nodes with a place, one after the other.
fn places(frame: &Frame) -> Vec<f64> {
    let places = frame.state.nodes.iter().zip(&frame.model.nodes).filter(|(_, node)| !node.is_number);
    places.flat_map(|(node, _)| [node.x.x, node.x.y, node.x.z]).collect()
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

const LINEAR: &str = "[analysis]\nkind = \"static\"\ngeometry = \"linear\"\n";

/// Loads on the interface deform it, and all inner nodes, exactly as without reduction; so do section forces.
#[test]
fn static_response_to_loads_on_the_interface_is_exact() {
    let loads = TIP_LOAD.replace("amplitude = \"force\"\n[amplitudes.force]\n", "");
    let text = format!("{LINEAR}{ARM}{CLAMP}{loads}[output]\nsections = true\nnodes = \"all\"\n");
    let tables = [text.clone(), reduced(&text, 3)].map(|text| tables_of(&read_deck(&text)));
    let columns = |file: &str, column: &str| {
        tables.each_ref().map(|tables| -> Vec<f64> { tables.rows(file).iter().map(|row| row.number(column)).collect() })
    };
    // Rounding of 121 unknowns, times the ratio of the stiffness of an element to that of the arm; an axial force of 1e-7 has a strain of 1e-15.
    for (file, names, tolerance) in [
        ("nodes.csv", &["ux", "uy", "uz", "rx", "ry", "rz"][..], 1e-9),
        ("sections.csv", &["N", "Vy", "Vz", "T", "My", "Mz"], 1e-8),
    ] {
        let all = names.iter().flat_map(|name| columns(file, name)[0].clone());
        let largest = all.fold(0.0, |most: f64, value| most.max(value.abs()));
        for name in names {
            let [full, few] = columns(file, name);
            assert_eq!(full.len(), few.len());
            let off = largest_difference(&full, &few);
            assert!(off < tolerance * largest, "{name} {off:e}");
        }
    }
}

/// Weight and loads per length act by the shapes. Static shapes of inertia loads have their deflections and section forces without any mode.
#[test]
fn spread_loads_act_by_the_shapes() {
    let rest =
        "[environment]\ngravity = [0.0, 0.0, -9.81]\n[[loads]]\npart = \"arm\"\nforce_per_length = [0.0, 40.0, 30.0]\n";
    let text = format!("{LINEAR}{ARM}{CLAMP}{rest}[output]\nreactions = true\nsections = true\n");
    let reactions = |text: &str| -> Vec<f64> {
        tables_of(&read_deck(text)).rows("reactions.csv").iter().map(|row| row.number("value")).collect()
    };
    let full = reactions(&text);
    let few = reactions(&reduced(&text, 4));
    // The largest reaction is a moment of 30.
    assert!(largest_difference(&full, &few) < 1e-8, "{full:?} {few:?}");
    let deflections = |text: &str| last(&read_deck(text), &mut places);
    let exact = deflections(&text);
    let start: Vec<f64> = read_deck(&text).nodes.iter().flat_map(|node| [node.x.x, node.x.y, node.x.z]).collect();
    let moved = largest_difference(&exact, &start);
    let normal = |text: &str| -> Vec<f64> {
        tables_of(&read_deck(text)).rows("sections.csv").iter().map(|row| row.number("N")).collect()
    };
    let of_all = normal(&text);
    for modes in [0, 12] {
        let few = reduced(&text, modes);
        let off = largest_difference(&exact, &deflections(&few)) / moved;
        let off_inside =
            largest_difference(&of_all, &normal(&few)) / of_all.iter().fold(0.0f64, |most, n| most.max(n.abs()));
        println!("{modes} modes: {off:e} {off_inside:e}");
        assert!(off < 1e-9 && off_inside < 1e-6, "{modes} modes: {off:e} {off_inside:e}");
    }
}

fn frequencies(text: &str, modes: usize) -> Vec<f64> {
    let model = read_deck(&format!("[analysis]\nkind = \"modal\"\nmodes = {modes}\n{text}"));
    let modes = tables_of(&model);
    modes.rows("modes.csv").iter().map(|row| row.number("frequency")).collect()
}

/// Frequencies approach those of the whole part from above.
#[test]
fn frequencies_converge_from_above() {
    let text = format!("{ARM}{CLAMP}[[masses]]\nat = \"tip\"\nmass = 0.5\n");
    let full = frequencies(&text, 4);
    let errors = [0, 2, 8, 24].map(|modes| {
        let near = frequencies(&reduced(&text, modes), 4);
        let error = |(near, full): (&f64, &f64)| near / full - 1.0;
        // Rounding of the frequencies themselves.
        assert!(near.iter().zip(&full).all(|pair| error(pair) > -1e-8), "{near:?} {full:?}");
        error((&near[3], &full[3]))
    });
    // The first modes are nearly among the static shapes of inertia loads, which alone err by 9e-7. Others follow with 1.6e-7 and 1.4e-8.
    let falls = errors[1] < errors[0] && errors[2] < 0.3 * errors[1] && errors[3] < 0.15 * errors[2];
    assert!(falls && errors[0] < 2e-6 && errors[3] < 3e-8, "{errors:?}");
}

/// The second and third mode of a stubby square tube are a pair, and stay one; nodes that were reserved in vain belong to nothing.
#[test]
fn equal_frequencies_stay_together() {
    let metal = PLATE.split("[points]").next().unwrap_or_default();
    let mut text = format!("[analysis]\nkind = \"modal\"\nmodes = 1\n{metal}[points]\n");
    for (name, x, y) in [("a", 0.0, 0.0), ("b", 0.2, 0.0), ("c", 0.2, 0.2), ("d", 0.0, 0.2)] {
        text += &format!("{name} = [{x:?}, {y:?}, 0.0]\n{name}1 = [{x:?}, {y:?}, 0.3]\n");
    }
    for (a, b) in [("a", "b"), ("b", "c"), ("c", "d"), ("d", "a")] {
        text += &format!(
            "[[shells]]\nname = \"{a}{b}\"\ncorners = [\"{a}\", \"{b}\", \"{b}1\", \"{a}1\"]\nelements = [2, 3]\nthickness = 0.02\nmaterial = \"metal\"\n\
             [[supports]]\nat = \"{a}{b}.edge1\"\nfix = \"all\"\n"
        );
    }
    text += "[[parts]]\nname = \"tube\"\nparts = [\"ab\", \"bc\", \"cd\", \"da\"]\nreduced = 2\n";
    let model = read_deck(&text);
    let made = model.reductions[0].made.as_ref().expect("matrices");
    assert_eq!((made.frequencies.len(), made.inertia_shapes), (3, 12));
    assert!(model.nodes.iter().all(|node| node.is_number || !node.label.is_empty()));
}

/// A free part has six motions without stiffness; the other frequencies are those of its matrices and those of the whole part.
#[test]
fn a_free_part_has_the_frequencies_of_its_matrices() {
    let text = reduced(ARM, 20);
    let found = frequencies(&text, 10);
    let full = frequencies(ARM, 10);
    let model = read_deck(&format!("[analysis]\nkind = \"modal\"\n{text}"));
    let data = &model.reductions[0].made.as_ref().expect("matrices").matrices;
    let size = data.size();
    let matrix = |of: &[f64]| DMatrix::from_row_slice(size, size, of);
    let inverse = matrix(&data.mass).cholesky().expect("mass").l().try_inverse().expect("mass");
    let scaled = &inverse * matrix(&data.stiffness) * inverse.transpose();
    let mut squares: Vec<f64> = SymmetricEigen::new(scaled).eigenvalues.iter().copied().collect();
    squares.sort_by(f64::total_cmp);
    assert!(found[..6].iter().all(|zero| *zero < 1e-4 * found[6]), "{found:?}");
    for k in 6..10 {
        // Rounding of the largest eigenvalue, 1e7 times the square of the lowest.
        assert!((found[k] / (squares[k].sqrt() / TAU) - 1.0).abs() < 1e-7, "{found:?} {squares:?}");
        assert!((0.0..1e-3).contains(&(found[k] / full[k] - 1.0 + 1e-9)), "{found:?} {full:?}");
    }
}

const STEPS: &str = "[integrator]\nscheme = \"generalized-alpha\"\nspectral_radius = 0.9\n";

/// A small vibration is that of the whole part, the more so with more modes.
#[test]
fn small_motion_converges_to_that_of_the_whole_part() {
    let text = format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 0.1\ntime_step = 1e-3\n{STEPS}{ARM}{CLAMP}{TIP_LOAD}kind = \"sine-squared\"\nangular_frequency = 31.41592653589793\nend = 0.1\n"
    )
    .replace("[10.0, 20.0, -30.0]", "[0.01, 0.02, -0.03]")
    .replace("[1.0, -2.0, 3.0]", "[1e-3, -2e-3, 3e-3]");
    let rows = |text: &str| run_to_the_end(&read_deck(text), &mut places).rows;
    let full = rows(&text);
    let largest = |rows: &[Vec<f64>], others: &dyn Fn(usize) -> Vec<f64>| {
        rows.iter().enumerate().map(|(k, row)| largest_difference(row, &others(k))).fold(0.0, f64::max)
    };
    let moved = largest(&full, &|_| full[0].clone());
    let errors = [0, 2, 10].map(|modes| largest(&rows(&reduced(&text, modes)), &|k| full[k].clone()) / moved);
    // Measured 2.1e-6, 2.0e-7 and 3.4e-8, the last by the tolerance of the iteration.
    let falls = errors[1] < 0.3 * errors[0] && errors[2] < 0.3 * errors[1];
    assert!(moved > 1e-7 && falls && errors[0] < 5e-6, "{errors:?}");
}

fn plate(end: f64, step: f64, motion: &str) -> String {
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = {end}\ntime_step = {step}\n{STEPS}{}[[initial]]\nat = [\"plate\"]\n{motion}\n",
        reduced(PLATE, 12)
    )
}

#[test]
fn a_free_part_keeps_its_velocity() {
    let text = plate(1.0, 0.01, "velocity = [1.0, -2.0, 3.0]");
    let model = read_deck(&text);
    let end = last(&model, &mut places);
    let start = model.nodes.iter().filter(|node| !node.is_number).flat_map(|node| {
        let x = node.x + rdsolve::math::Vec3::new(1.0, -2.0, 3.0);
        [x.x, x.y, x.z]
    });
    // Rounding of 100 steps of coordinates of size 3.
    let off = largest_difference(&end, &start.collect::<Vec<f64>>());
    assert!(off < 1e-12, "{off:e}");
}

/// A tumbling part keeps both momenta and its energy.
#[test]
fn a_tumbling_part_keeps_its_momenta() {
    let motion = "velocity = [1.0, 2.0, 3.0]\nangular_velocity = [3.0, -2.0, 8.0]\nabout = [0.3, 0.2, 0.0]";
    let text = plate(2.0, 0.002, motion).replace("spectral_radius = 0.9", "spectral_radius = 1.0");
    let momenta = |frame: &Frame| {
        let energy = frame.derived.energy.expect("energies");
        let [p, l] = [energy.p, energy.l];
        vec![p.x, p.y, p.z, l.x, l.y, l.z, energy.mechanical]
    };
    let rows = run_to_the_end(&read_deck(&text), &mut |frame| momenta(frame)).rows;
    let first = &rows[0];
    assert!(rows.len() > 100 && first[..3].iter().all(|p| p.abs() > 1.0));
    let off = |range: std::ops::Range<usize>, row: &[f64]| {
        let size = range.clone().fold(0.0f64, |most, k| most.max(first[k].abs()));
        range.fold(0.0f64, |most, k| most.max((row[k] - first[k]).abs())) / size
    };
    let worst = |range: std::ops::Range<usize>| rows.iter().map(|row| off(range.clone(), row)).fold(0.0, f64::max);
    // Linear momentum to the tolerance of the iteration; angular momentum and energy to the error of the steps, of second order.
    assert!(worst(0..3) < 1e-9, "{:e}", worst(0..3));
    assert!(worst(3..6) < 1e-4, "{:e}", worst(3..6));
    assert!(worst(6..7) < 1e-3, "{:e}", worst(6..7));
}

/// Stages share an interface: an edge that a later stage holds moves on its own from the start. Bent and released, the plate moves as without
/// reduction.
#[test]
fn stages_share_an_interface() {
    let text = format!(
        "{STEPS}{PLATE}[[supports]]\nat = \"plate.edge4\"\nfix = \"all\"\n\
         [[stages]]\nname = \"bend\"\nkind = \"static\"\nduration = 1.0\ntime_step = 0.5\n\
         [[stages]]\nname = \"swing\"\nkind = \"dynamic\"\nduration = 0.1\ntime_step = 1e-3\n\
         [[loads]]\nat = [\"b\", \"c\"]\nforce = [0.0, 0.0, -0.2]\nstages = [\"bend\"]\n\
         [[supports]]\nat = \"plate.edge2\"\nfix = [\"ry\"]\nstages = [\"swing\"]\n"
    );
    let swing = |text: &str| {
        let mut swing: Vec<f64> = Vec::new();
        let done = run_source(&Source::new("deck.toml", text, &[]), &mut |frame| {
            let tip = frame.model.nodes.iter().position(|node| node.label == "b").expect("b");
            swing.push(frame.state.nodes[tip].x.z);
            Vec::new()
        });
        assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
        swing
    };
    let few = reduced(&text, 10);
    let models = read_stages(&Source::new("deck.toml", few.as_str(), &[]));
    // Both edges have five nodes.
    assert!(models.len() == 2 && models.iter().all(|model| model.reductions[0].interface.len() == 10));
    let (full, few) = (swing(&text), swing(&few));
    let size = full.iter().fold(0.0f64, |most, z| most.max(z.abs()));
    let off = largest_difference(&full, &few);
    // Modes beyond the tenth.
    assert!(full.len() == few.len() && size > 1e-4 && off < 0.02 * size, "{off:e} of {size:e}");
}

/// What the reader says of a deck.
fn said(text: &str) -> String {
    let source = Source::new("deck.toml", text, &[]);
    let (mut models, mut problems) = model::read_stages(&source);
    if let Err(more) = rdsolve::modes::reduce(&mut models.iter_mut().collect::<Vec<_>>()) {
        problems.extend(more);
    }
    problems.iter().filter(|problem| problem.is_error()).for_each(assert_says_what_to_change);
    problems
        .iter()
        .filter(|problem| problem.is_error())
        .map(|problem| problem.message.clone())
        .collect::<Vec<_>>()
        .join("\n")
}

/// A section beside the axis.
const BESIDE: &str = "stations = [{ at = 0.0, section = \"bar\", offset = [0.01, 0.0] }, { at = 1.0, section = \"bar\", offset = [0.01, 0.0] }]\n";

#[test]
fn what_shapes_do_not_have_is_refused() {
    let dynamic = "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 0.01\n";
    let arm = reduced(ARM, 5);
    let yielding = arm
        .replace("model = \"elastic\"\n", "model = \"elastic-plastic\"\nyield_stress = 2e8\nhardening_modulus = 1e9\n");
    let spread = "[[loads]]\npart = \"plate\"\npressure = 10.0\nfollower = true\n[[supports]]\nat = \"plate.edge1\"\nfix = \"all\"\n";
    let cases = [
        (format!("{dynamic}{}", arm.replace("reduced = 5", "reduced = 5\nrigid = true")), "`rigid` and `reduced`"),
        (format!("{dynamic}{}", arm.replace("reduced = 5", "reduced = 2.5")), "a whole number of modes"),
        (format!("{dynamic}{}", arm.replace("reduced = 5", "reduced = {}")), "`reduced` asks for nothing"),
        (format!("{dynamic}{}", arm.replace("reduced = 5", "reduced = { pieces = 0 }")), "`pieces` is 0"),
        (
            format!("{dynamic}{}", arm.replace("reduced = 5", "reduced = { modes = 2, pieces = 11 }")),
            "has 10 elements, and 11 pieces",
        ),
        (
            format!("{dynamic}{}", reduced(PLATE, 5).replace("reduced = 5", "reduced = { modes = 5, pieces = 2 }")),
            "shell `plate` cannot be cut",
        ),
        (format!("{dynamic}{}", arm.replace("reduced = 5", "reduced = { up_to = -1.0 }")), "must be above zero"),
        (format!("{dynamic}{}", arm.replace("reduced = 5", "reduced = 5\nmass = \"free-nodes\"")), "free-nodes"),
        (
            format!("{dynamic}{}", arm.replace("section = \"bar\"\n", BESIDE)),
            "the mass of beam `arm` lies beside its nodes",
        ),
        (
            format!(
                "[analysis]\nkind = \"modal\"\nmodes = 2\n{arm}{CLAMP}[[loads]]\ncentrifugal = {{ speed = 1.0, axis = [0.0, 0.0, 1.0] }}\n"
            ),
            "in statics alone",
        ),
        (format!("{dynamic}{yielding}"), "yields, and reduced shapes are elastic"),
        (
            format!("{dynamic}[integrator]\nscheme = \"central-difference\"\n{arm}"),
            "explicit schemes do not take beam `arm`",
        ),
        (
            format!("{LINEAR}{}{spread}", reduced(PLATE, 5))
                .replace("geometry = \"linear\"", "end_time = 1.0\ntime_step = 0.1"),
            "a pressure turns with the surface",
        ),
        (
            format!("{dynamic}{arm}[[initial]]\nat = [\"mid\"]\nvelocity = [0.0, 1.0, 0.0]\n"),
            "is not that of the static shapes",
        ),
        (
            format!("{dynamic}{}", reduced(ARM, 5).replace("elements = 5", "elements = 1\norder = 1\n"))
                + CLAMP
                + &CLAMP.replace("root", "mid")
                + &CLAMP.replace("root", "tip"),
            "leaves nothing out",
        ),
    ];
    for (text, expected) in cases {
        let said = said(&text);
        assert!(said.contains(expected), "{expected}: {said}");
    }
}

/// The damping that hardly damps changes nothing, even where a sudden load gives accelerations that no step resolves.
#[test]
fn a_trace_of_damping_changes_nothing() {
    let text = format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 0.1\ntime_step = 2e-3\n{STEPS}{ARM}{CLAMP}[[loads]]\nat = \"tip\"\nforce = [0.0, 10.0, -30.0]\nmoment = [1.0, 0.0, 0.0]\n"
    );
    let text = reduced(&text, 8);
    let rows = |damping: &str| run_to_the_end(&read_deck(&format!("{text}{damping}")), &mut places).rows;
    let none = rows("");
    let largest = |others: &dyn Fn(usize) -> Vec<f64>| {
        none.iter().enumerate().map(|(k, row)| largest_difference(row, &others(k))).fold(0.0, f64::max)
    };
    let moved = largest(&|_| none[0].clone());
    // Beta damps the highest mode kept, of 1e5 rad/s, by 5e-5 of critical damping; its part of the motion is small.
    for (damping, part) in [("alpha", 1e-6), ("beta", 1e-5)] {
        let damped = rows(&format!("[damping]\n{damping} = 1e-9\n"));
        let off = largest(&|k| damped[k].clone());
        assert!(damped.len() == none.len() && moved > 1e-3 && off < part * moved, "{damping} {off:e} of {moved:e}");
    }
}

/// Rayleigh damping takes from a reduced part what it takes from the whole part.
#[test]
fn damping_is_that_of_the_whole_part() {
    let text = format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 0.2\ntime_step = 1e-3\n{STEPS}{ARM}{CLAMP}{TIP_LOAD}kind = \"sine-squared\"\nangular_frequency = 31.41592653589793\nend = 0.1\n"
    )
    .replace("[10.0, 20.0, -30.0]", "[0.01, 0.02, -0.03]")
    .replace("[1.0, -2.0, 3.0]", "[1e-3, -2e-3, 3e-3]");
    let rows = |text: &str, damping: &str| run_to_the_end(&read_deck(&format!("{text}{damping}")), &mut places).rows;
    let few = reduced(&text, 10);
    let none = rows(&few, "");
    for damping in ["[damping]\nalpha = 20.0\n", "[damping]\nbeta = 1e-3\n"] {
        let [full, few] = [&text, &few].map(|text| rows(text, damping));
        let largest = |rows: &[Vec<f64>]| {
            full.iter().zip(rows).map(|(row, other)| largest_difference(row, other)).fold(0.0, f64::max)
        };
        let (off, damped) = (largest(&few), largest(&none));
        assert!(few.len() == full.len() && damped > 1e-7 && off < 1e-3 * damped, "{damping} {off:e} of {damped:e}");
    }
}

/// Weight and loads per length on inner nodes are in equilibrium in one step of nonlinear statics, near that of the whole part.
#[test]
fn spread_loads_need_one_step_of_statics() {
    let statics = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n";
    for load in [
        "[[loads]]\npart = \"arm\"\nforce_per_length = [0.0, 0.0, -60.0]\n",
        "[environment]\ngravity = [0.0, 0.0, -9.81]\n",
    ] {
        let text = format!("{statics}{ARM}{CLAMP}{load}");
        let [full, few] = [text.clone(), reduced(&text, 8)].map(|text| {
            let model = read_deck(&text);
            let tip = model.nodes.iter().position(|node| node.label == "tip").expect("tip");
            let height = |frame: &Frame| vec![frame.state.nodes[tip].x.z - frame.model.nodes[tip].x.z];
            run_to_the_end(&model, &mut |frame| height(frame)).rows
        });
        assert!(few.len() == 2, "{few:?}");
        let (full, few) = (full[full.len() - 1][0], few[1][0]);
        assert!(full < -1e-3 && (few / full - 1.0).abs() < 1e-3, "{few:e} {full:e}");
    }
}

/// An interface that is larger than the part inside is refused.
#[test]
fn a_large_interface_is_refused() {
    let text = reduced(PLATE, 4).replace("elements = [6, 4]", "elements = [40, 2]");
    let edges =
        "[[supports]]\nat = [\"plate.edge1\", \"plate.edge2\", \"plate.edge3\", \"plate.edge4\"]\nfix = \"all\"\n";
    let said = said(&format!("{LINEAR}{text}{edges}"));
    assert!(said.contains("its interface has 84 nodes, beside 39 inside"), "{said}");
}

/// Stages may hold so much of a part that they have fewer unknowns inside than modes.
#[test]
fn stages_hold_different_numbers_of_nodes() {
    let held = "[[supports]]\nat = [\"plate.edge1\", \"plate.edge2\"]\nfix = \"all\"\nstages = [\"second\"]\n";
    let text = format!(
        "{}[[supports]]\nat = \"plate.edge4\"\nfix = \"all\"\n{held}\
         [[stages]]\nname = \"first\"\nkind = \"static\"\nduration = 1.0\ntime_step = 1.0\n\
         [[stages]]\nname = \"second\"\nkind = \"static\"\nduration = 1.0\ntime_step = 1.0\n",
        reduced(PLATE, 30).replace("elements = [6, 4]", "elements = [2, 2]")
    );
    let models = read_stages(&Source::new("deck.toml", text.as_str(), &[]));
    let kept = |model: &Model| model.reductions[0].amplitudes.len();
    assert!(models.len() == 2 && models.iter().all(|model| kept(model) == kept(&models[0])));
    // Two nodes are inside of both.
    assert!((1..=12).contains(&kept(&models[0])), "{}", kept(&models[0]));
}
