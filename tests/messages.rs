//! What the program says about wrong decks, compared as text with `tests/snapshots`.

use crate::support::assert_says_what_to_change;
use insta::assert_snapshot;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::diagnostic::Source;

/// A sound deck; each test spoils a part of it.
const PORTAL: &str = r#"
title = "Portal frame hit by a block"

[analysis]
kind = "dynamic"
end_time = 0.3
time_step = 1e-4

[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0

[sections.square]
shape = "rectangle"
width = 0.05
height = 0.05

[points]
foot_left = [0.0, 0.0, 0.0]
knee_left = [0.0, 0.0, 2.0]
knee_right = [1.5, 0.0, 2.0]
foot_right = [1.5, 0.0, 0.0]

[sets]
feet = ["foot_left", "foot_right"]

[[beams]]
name = "portal"
path = ["foot_left", "knee_left", "knee_right", "foot_right"]
elements = 12
material = "steel"
section = "square"
orientation = [0.0, 1.0, 0.0]

[[bodies]]
name = "block"
center = [-0.5, 0.0, 2.0]
mass = 500.0
inertia = [20.0, 20.0, 20.0]
velocity = [4.0, 0.0, 0.0]

[[supports]]
at = "feet"
fix = "all"

[[links]]
name = "bumper"
from = { body = "block", point = [-0.1, 0.0, 2.0] }
to = { node = "knee_left" }
law = "compression-only"
stiffness = 5e6

[[loads]]
at = "knee_right"
force = [0.0, 0.0, -100.0]
amplitude = "pulse"

[amplitudes.pulse]
kind = "table"
points = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]
"#;

/// Everything that is said about a deck.
fn said(text: &str, sets: &[&str]) -> String {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let source = Source::new("portal.toml", text, &sets);
    let (model, problems) = rdsolve::model::read(&source);
    assert_eq!(model.is_none(), problems.iter().any(|problem| problem.is_error()), "a model without errors only");
    problems.iter().for_each(assert_says_what_to_change);
    let drawn: Vec<String> = problems.iter().map(|problem| problem.draw(&source, false)).collect();
    drawn.join("\n\n")
}

/// The portal with parts replaced.
fn edited(edits: &[(&str, &str)]) -> String {
    let mut text = PORTAL.to_owned();
    for (old, new) in edits {
        assert_eq!(text.matches(old).count(), 1, "`{old}` must stand once in the deck");
        text = text.replace(old, new);
    }
    text
}

fn portal(edits: &[(&str, &str)]) -> String {
    said(&edited(edits), &[])
}

/// The portal with tables added.
fn portal_and(more: &str) -> String {
    said(&format!("{PORTAL}\n{more}"), &[])
}

fn portal_set(sets: &[&str]) -> String {
    said(PORTAL, sets)
}

#[test]
fn a_sound_deck_is_silent() {
    assert_eq!(portal(&[]), "");
}

/// A slip of an exponent, wherever it stands, ends with a word about it and not with a singular matrix.
#[test]
fn lengths_that_nothing_can_be_computed_with_are_refused_wherever_they_stand() {
    let body = |shape: &str| {
        format!("[[bodies]]\nname = \"b\"\ncenter = [9.0, 9.0, 9.0]\nmass = 1.0\nshape = {{ {shape} }}\n")
    };
    let surface = |surface: &str| {
        format!("[[contacts]]\nname = \"c\"\nsurface = {{ {surface} }}\nwith = \"block\"\nstiffness = 1.0\n")
    };
    let section = |shape: &str| format!("[sections.more]\n{shape}\n");
    let mut tables = vec![
        "[[bodies]]\nname = \"b\"\ncenter = [L, 9.0, 9.0]\nmass = 1.0\n".to_owned(),
        "[[links]]\nname = \"l\"\nfrom = { ground = [L, 0.0, 0.0] }\nto = { body = \"block\" }\nstiffness = 1.0\n"
            .to_owned(),
    ];
    tables.extend(
        [
            r#"kind = "box", size = [L, 1.0, 1.0]"#,
            r#"kind = "sphere", radius = L"#,
            r#"kind = "cylinder", radius = L, length = 1.0, axis = [0.0, 0.0, 1.0]"#,
            r#"kind = "cylinder", radius = 1.0, length = L, axis = [0.0, 0.0, 1.0]"#,
            r#"kind = "tube", radius = L, thickness = 0.1, length = 1.0, axis = [0.0, 0.0, 1.0]"#,
            r#"kind = "capsule", radius = 1.0, ends = [[9.0, 9.0, 9.0], [9.0, L, 9.0]]"#,
            r#"kind = "hull", points = [[9.0, 9.0, 9.0], [9.0, 9.0, L], [9.0, 8.0, 9.0], [8.0, 9.0, 9.0]]"#,
        ]
        .map(body),
    );
    tables.extend(
        [
            r#"shape = "plane", point = [0.0, 0.0, -L], normal = [0.0, 0.0, 1.0]"#,
            r#"shape = "sphere", center = [0.0, 0.0, 9.0], radius = L"#,
            r#"shape = "box", center = [0.0, 9.0, 0.0], size = [1.0, L, 1.0]"#,
            r#"shape = "cylinder", center = [0.0, 9.0, 0.0], axis = [1.0, 0.0, 0.0], radius = 1.0, length = L"#,
        ]
        .map(surface),
    );
    tables.extend(
        [
            "shape = \"rectangle\"\nwidth = L\nheight = 1.0",
            "shape = \"tube\"\nradius = L\nthickness = 1.0",
            "shape = \"general\"\narea = P2\nmoments = [1.0, 1.0]\ntorsion_constant = 1.0",
            "shape = \"general\"\narea = 1.0\nmoments = [1.0, P4]\ntorsion_constant = 1.0",
        ]
        .map(section),
    );
    for length in [1e31, 1e100, 1e200] {
        let power = |k: i32| format!("{:e}", f64::powi(length, k).min(1e300));
        let refused = |text: &str| {
            let text = text.replace("P2", &power(2)).replace("P4", &power(4)).replace('L', &format!("{length:e}"));
            assert!(said(&text, &[]).contains("no length may be above 1e30"), "{text}");
        };
        tables.iter().for_each(|table| refused(&format!("{PORTAL}\n{table}")));
        refused(&edited(&[("[1.5, 0.0, 2.0]", "[1.5, 0.0, -L]")]));
        refused(&edited(&[("point = [-0.1, 0.0, 2.0]", "point = [-0.1, L, 2.0]")]));
    }
}

/// Of Fortran and C, with a unit, with a comma.
#[test]
fn numbers_as_others_write_them() {
    let edits = [
        ("end_time = 0.3", "end_time = .3"),
        ("time_step = 1e-4", "time_step = 1d-4"),
        ("width = 0.05", "width = 0,05"),
        ("height = 0.05", "height = 5 cm"),
        ("knee_right = [1.5, 0.0, 2.0]", "knee_right = [1.5, 0., 2.0]"),
    ];
    assert_snapshot!("number_slips", portal(&edits));
    assert_snapshot!("number_slip_in_set", said(PORTAL, &["analysis.end_time=.3"]));
}

#[test]
fn syntax() {
    assert_snapshot!("broken_line", portal(&[("height = 0.05", "height = ")]));
    assert_snapshot!("open_bracket", portal(&[("[amplitudes.pulse]", "[amplitudes.pulse")]));
    assert_snapshot!("key_twice", portal(&[("elements = 12", "elements = 12\nelements = 13")]));
    assert_snapshot!("empty_deck", said("", &[]));
}

#[test]
fn keys_and_types() {
    assert_snapshot!("unknown_key", portal(&[("elements = 12", "element = 12")]));
    assert_snapshot!("unknown_key_without_neighbour", portal(&[("elements = 12", "elements = 12\nfriction = 0.3")]));
    assert_snapshot!("unknown_table", portal_and("[[gears]]\nratio = 0.3"));
    assert_snapshot!("text_for_number", portal(&[("youngs_modulus = 210e9", "youngs_modulus = \"210e9\"")]));
    assert_snapshot!("number_for_text", portal(&[("material = \"steel\"", "material = 7")]));
    assert_snapshot!("fraction_for_count", portal(&[("elements = 12", "elements = 1.5")]));
    assert_snapshot!("two_coordinates", portal(&[("[0.0, 0.0, 2.0]", "[0.0, 2.0]")]));
    assert_snapshot!("text_in_vector", portal(&[("[0.0, 0.0, -100.0]", "[0.0, 0.0, \"down\"]")]));
    assert_snapshot!("table_for_list", portal(&[("[[supports]]", "[supports]")]));
    assert_snapshot!("list_for_table", portal(&[("[analysis]", "[[analysis]]")]));
    assert_snapshot!("not_finite", portal(&[("mass = 500.0", "mass = nan"), ("stiffness = 5e6", "stiffness = inf")]));
    assert_snapshot!(
        "lengths_beyond_all",
        portal(&[("[1.5, 0.0, 2.0]", "[1.5, 0.0, 1e40]"), ("height = 0.05", "height = -1e200")])
    );
    assert_snapshot!("lengths_far_apart", portal(&[("height = 0.05", "height = 1e20")]));
    // Points of a curve are no places: forces and stresses may have any size beside lengths.
    let film = SHEET.replacen("thickness = 0.01", "thickness = 1e-7", 1);
    let spring = "[[links]]\nname = \"k\"\nlaw = \"table\"\npoints = [[0.0, 0.0], [1.0, 5e9]]\n";
    let told = said(&(film + spring), &[]);
    assert!(!told.contains("do not go together"), "{told}");
    assert_snapshot!("unknown_word", portal(&[("kind = \"dynamic\"", "kind = \"dinamic\"")]));
    assert_snapshot!("unknown_direction", portal(&[("fix = \"all\"", "fix = [\"ux\", \"uu\"]")]));
    assert_snapshot!(
        "missing_keys",
        portal(&[("elements = 12\n", ""), ("mass = 500.0\n", ""), ("end_time = 0.3\n", "")])
    );
}

#[test]
fn many_at_once() {
    let edits = [
        ("title =", "titel ="),
        ("end_time = 0.3", "end_time = \"long\""),
        ("poisson_ratio = 0.3", "poisson_ratio = 0.7"),
        ("height = 0.05", "height = "),
        ("\"knee_right\", \"foot_right\"]\nelements", "\"knee_rihgt\", \"foot_right\"]\nelements"),
        ("material = \"steel\"", "material = \"steal\""),
        ("fix = \"all\"", "fix = \"everything\""),
    ];
    assert_snapshot!("many_at_once", portal(&edits));
}

#[test]
fn overrides() {
    assert_snapshot!("set_value", portal_set(&["beams.portal.elements=-3"]));
    assert_snapshot!("set_zero", portal_set(&["materials.steel.density=0.0", "beams.portal.elements=0"]));
    assert_snapshot!("set_item", portal_set(&["beams.portel.elements=3", "links.4.stiffness=1.0"]));
    assert_snapshot!("set_name", portal_set(&["materials.stel.density=1.0"]));
    assert_snapshot!("set_key", portal_set(&["analysis.endtime=1.0"]));
    assert_snapshot!("set_table", portal_set(&["beems.portal.elements=3"]));
    assert_snapshot!("set_no_value", portal_set(&["analysis.end_time"]));
    assert_snapshot!("set_syntax", portal_set(&["points.knee_left=[0.0, 0.0"]));
    assert_snapshot!("set_word", portal_set(&["integrator.scheme=wilson-thata"]));
    assert_snapshot!("set_part", portal_set(&["beams.portal=3"]));
    assert_snapshot!("set_name_in_file", portal_set(&["beams.portal.material=copper"]));
    assert_eq!(
        portal_set(&["integrator.scheme=wilson-theta", "points.knee_left.2=2.5", "damping.mass_factor=0.1"]),
        ""
    );
    assert_eq!(portal_set(&["links.0.stiffness=1e6", "beams.portal.elements=[2, 3, 4]", "title=fine/other.msh"]), "");
}

/// A support on nothing would leave the structure free without a word.
#[test]
fn empty_sets() {
    let sets = ("[sets]\n", "[sets]\nnone = []\nbumpers = [\"bumper\"]\nall_of_none = [\"none\"]\n");
    let tables = "fix = \"all\"

[[supports]]
at = \"all_of_none\"
fix = \"all\"

[[supports]]
at = [\"feet\", \"bumpers\"]
fix = \"all\"

[[attachments]]
body = \"block\"
nodes = \"none\"

[[contacts]]
name = \"floor\"
surface = { shape = \"plane\", point = [0.0, 0.0, -1.0], normal = [0.0, 0.0, 1.0] }
with = [\"none\"]

[[initial]]
at = \"none\"
velocity = [1.0, 0.0, 0.0]

[damping]
nodal = [{ at = \"none\", translation = 1.0 }]
";
    let edits = [sets, ("at = \"feet\"", "at = \"none\""), ("at = \"knee_right\"", "at = \"none\"")];
    assert_snapshot!("empty_sets", portal(&[&edits[..], &[("fix = \"all\"\n", tables)]].concat()));
    // What is wrong with a member is said alone.
    let wrong = ("[sets]\n", "[sets]\nnone = [\"fooot\"]\n");
    assert_snapshot!("empty_by_a_slip", portal(&[wrong, ("at = \"feet\"", "at = \"none\"")]));
}

/// A beam is no list of nodes, so it is not offered as one.
#[test]
fn names_that_are_offered_fit() {
    assert_snapshot!("not_a_beam", portal(&[("at = \"knee_right\"", "at = \"portel\"")]));
}

#[test]
fn schemes_in_statics() {
    let integrator = ("[materials.steel]", "[integrator]\nscheme = \"wilson-theta\"\ntheta = 1.5\n\n[materials.steel]");
    let velocity = ("velocity = [4.0, 0.0, 0.0]\n", "");
    assert_snapshot!("static_scheme", portal(&[("\"dynamic\"", "\"static\""), velocity, integrator]));
    let rotations = ("[materials.steel]", "[integrator]\nrotation_update = \"second-order\"\n\n[materials.steel]");
    assert_eq!(portal(&[("\"dynamic\"", "\"static\""), velocity, rotations]), "");
}

#[test]
fn quantities() {
    assert_snapshot!("times", portal(&[("time_step = 1e-4", "time_step = 1.0\nleast_step = 2.0")]));
    assert_snapshot!("negative_modulus", portal(&[("youngs_modulus = 210e9", "youngs_modulus = -210e9")]));
    assert_snapshot!("thin_inertia", portal(&[("inertia = [20.0, 20.0, 20.0]", "inertia = [20.0, 20.0, 50.0]")]));
    assert_snapshot!("indefinite_inertia", portal(&[("[20.0, 20.0, 20.0]", "[20.0, 20.0, 20.0, 0.0, 0.0, 30.0]")]));
    assert_snapshot!("four_moments", portal(&[("[20.0, 20.0, 20.0]", "[20.0, 20.0, 20.0, 0.0]")]));
    assert_snapshot!(
        "mass_and_density",
        portal(&[(
            "inertia = [20.0, 20.0, 20.0]",
            "shape = { kind = \"box\", size = [1.0, 1.0, 1.0], radius = 1.0, density = 500.0 }"
        )])
    );
    assert_snapshot!("theta", portal_and("[integrator]\ntheta = 1.2"));
    assert_snapshot!("low_theta", portal_and("[integrator]\ntheta = 0.9"));
    // Of order 8 a tolerance asks for far fewer steps.
    let of = |tolerance: &str, scheme: &str| {
        let text = format!("time_step = \"auto\"\nerror_tolerance = {tolerance}\n[integrator]\nscheme = \"{scheme}\"");
        portal(&[("time_step = 1e-4", &text)])
    };
    assert_snapshot!("tiny_tolerance", of("1e-12", "generalized-alpha"));
    for tolerance in ["0.0", "-1e-3", "inf", "nan"] {
        assert!(of(tolerance, "bathe").starts_with("error: "), "{tolerance}");
    }
    assert!(of("1e-12", "runge-kutta").is_empty() && of("1e-9", "bathe").is_empty());
    assert_snapshot!(
        "stray_keys",
        portal(&[
            ("height = 0.05", "height = 0.05\nradius = 0.1"),
            ("stiffness = 5e6", "stiffness = 5e6\npreload = 1.0")
        ])
    );
    assert_snapshot!("falling_times", portal(&[("[2.0, 0.0]", "[0.5, 0.0]")]));
    let table = |keys: &str| portal(&[("[2.0, 0.0]]\n", &format!("[2.0, 0.0]]\n{keys}\n"))]);
    assert_snapshot!("amplitude_interpolation", table("interpolation = \"spline\"\nrows = true"));
    let ramp = "kind = \"ramp\"\nend = 1.0\ninterpolation = \"cubic\"\n";
    assert_snapshot!("amplitude_interpolation_of_a_ramp", portal(&[("kind = \"table\"\n", ramp)]));
    assert_snapshot!("implausible_units", portal(&[("title =", "units = \"mm-t-s\"\ntitle =")]));
}

/// The portal with a material that yields, and more in its material and in its beam.
fn yielding(model: &str, material: &str, beam: &str) -> String {
    portal(&[
        ("model = \"elastic\"\n", &format!("model = \"{model}\"\n{material}\n")),
        ("elements = 12\n", &format!("elements = 12\n{beam}\n")),
    ])
}

#[test]
fn materials_that_yield() {
    let plastic = |material: &str| yielding("elastic-plastic", material, "");
    let viscous = |material: &str| yielding("elastic-viscoplastic", material, "");
    let stress = "yield_stress = 275e6";
    let viscosity = "viscosity = { law = \"power\", rate = 40.0, exponent = 5.0 }";
    assert_eq!(plastic(stress), "");
    assert_eq!(plastic("hardening = [[0.0, 275e6], [0.1, 300e6]]\nkinematic_share = 1.0"), "");
    assert_eq!(viscous(&format!("{stress}\n{viscosity}")), "");
    assert_snapshot!("yield_stress_when_elastic", yielding("elastic", &format!("{stress}\n{viscosity}"), ""));
    // What depends on a material with errors is not judged.
    assert_snapshot!("no_yield_stress", plastic("kinematic_share = 0.5"));
    assert_eq!(yielding("elastic-plastic", "kinematic_share = 0.5", "points = 4"), plastic("kinematic_share = 0.5"));
    assert_snapshot!("viscosity_when_plastic", plastic(&format!("{stress}\n{viscosity}")));
    assert_snapshot!("no_viscosity", viscous(stress));
    assert_snapshot!("falling_hardening", plastic("hardening = [[0.0, 275e6], [0.1, 270e6]]"));
    assert_snapshot!("late_hardening", plastic("hardening = [[0.01, 275e6], [0.1, 300e6]]"));
    assert_snapshot!("hardening_back_in_strain", plastic("hardening = [[0.0, 275e6], [0.1, 300e6], [0.05, 310e6]]"));
    assert_snapshot!("empty_hardening", plastic("hardening = []"));
    assert_snapshot!(
        "two_hardenings",
        plastic("yield_stress = 275e6\nhardening_modulus = 1e9\nhardening = [[0.0, 275e6], [0.1, 300e6]]")
    );
    assert_snapshot!("softening", plastic("yield_stress = 275e6\nhardening_modulus = -1e9"));
    assert_snapshot!("kinematic_share", plastic("yield_stress = 275e6\nkinematic_share = 2.0"));
    assert_snapshot!("failure_strain", plastic("yield_stress = 275e6\nfailure_strain = 0.0"));
    assert_snapshot!("failure_in_per_cent", plastic("yield_stress = 275e6\nfailure_strain = 25.0"));
    let factors = "failure_triaxiality = [[0.3, 1.0], [0.3, 2.0]]\nfailure_rate = [[-1.0, 1.0]]";
    assert_snapshot!("failure_factors", plastic(&format!("yield_stress = 275e6\nfailure_strain = 0.2\n{factors}")));
    assert_snapshot!("failure_factors_alone", plastic(&format!("yield_stress = 275e6\n{factors}")));
    assert_snapshot!("failure_when_elastic", yielding("elastic", "failure_strain = 0.2", ""));
    assert_snapshot!("overstress_exponent", viscous(&format!("{stress}\n{}", viscosity.replace("5.0", "0.5"))));
    assert_snapshot!(
        "overstress_without_exponent",
        viscous(&format!("{stress}\n{}", viscosity.replace(", exponent = 5.0", "")))
    );
    assert_snapshot!("exponent_of_a_line", viscous(&format!("{stress}\n{}", viscosity.replace("power", "linear"))));
    assert_snapshot!("overstress_law", viscous(&format!("{stress}\n{}", viscosity.replace("power", "cowper-symonds"))));
}

#[test]
fn beams_that_yield() {
    let beam = |keys: &str| yielding("elastic-plastic", "yield_stress = 275e6", keys);
    assert_eq!(beam("integration = \"lobatto\"\npoints = 5\nshear_yields = false"), "");
    assert_snapshot!("few_points", beam("points = 2"));
    assert_snapshot!("many_points", beam("points = 6"));
    assert_snapshot!("short_lobatto", beam("order = 2\nintegration = \"lobatto\"\npoints = 2"));
    assert_snapshot!("short_lobatto_by_order", beam("order = 1\nintegration = \"lobatto\""));
    assert_snapshot!(
        "integration_when_elastic",
        portal(&[("elements = 12", "elements = 12\nintegration = \"gauss\"\npoints = 4\nshear_yields = false")])
    );
    assert_snapshot!(
        "general_that_yields",
        portal(&[
            ("model = \"elastic\"\n", "model = \"elastic-plastic\"\nyield_stress = 275e6\n"),
            (
                "shape = \"rectangle\"\nwidth = 0.05\nheight = 0.05",
                "shape = \"general\"\narea = 25e-4\nmoments = [5e-7, 5e-7]\ntorsion_constant = 9e-7\nshear_areas = [2e-3, 2e-3]"
            ),
        ])
    );
    let expect =
        "[[expect]]\nat = \"portal\"\nquantity = \"plastic_strain\"\npeak = \"max\"\nvalue = 0.01\ntolerance = 0.1";
    assert_snapshot!("plastic_strain_when_elastic", portal_and(expect));
    assert_snapshot!(
        "quantity_of_a_beam",
        said(
            &format!(
                "{}\n{}",
                edited(&[("model = \"elastic\"\n", "model = \"elastic-plastic\"\nyield_stress = 275e6\n")]),
                expect.replace("plastic_strain", "strain")
            ),
            &[]
        )
    );
    assert_snapshot!("iteration_method", portal_and("[iteration]\nmethod = \"initial-stress\""));
}

#[test]
fn shear_factors() {
    let square = |factor: &str| portal(&[("height = 0.05", &format!("height = 0.05\nshear_factor = {factor}"))]);
    for sound in ["0.8333", "1", "[0.5, 1.0]"] {
        assert_eq!(square(sound), "");
    }
    assert_snapshot!("shear_factor_above_one", square("1.2"));
    assert_snapshot!("shear_factor_of_zero", square("[0.8, 0.0]"));
    assert_snapshot!("shear_factor_not_a_number", square("nan"));
    assert_snapshot!("shear_factor_of_three", square("[0.8, 0.8, 0.8]"));
    assert_snapshot!("shear_factor_empty", square("[]"));
    let general =
        "shape = \"general\"\narea = 1e-2\nmoments = [1e-5, 1e-5]\ntorsion_constant = 1e-5\nshear_areas = [8e-3, 8e-3]";
    let square = "shape = \"rectangle\"\nwidth = 0.05\nheight = 0.05";
    assert_snapshot!("shear_factor_of_general", portal(&[(square, &format!("{general}\nshear_factor = 0.8"))]));
}

#[test]
fn geometry() {
    assert_snapshot!(
        "parallel_orientation",
        portal(&[("orientation = [0.0, 1.0, 0.0]", "orientation = [0.0, 0.0, 2.0]")])
    );
    assert_snapshot!("zero_orientation", portal(&[("orientation = [0.0, 1.0, 0.0]", "orientation = [0.0, 0.0, 0.0]")]));
    assert_snapshot!("no_length", portal(&[("knee_right = [1.5, 0.0, 2.0]", "knee_right = [0.0, 0.0, 2.0]")]));
    assert_snapshot!("elements_per_segment", portal(&[("elements = 12", "elements = [12, 0]")]));
    assert_snapshot!("grading_out_of_range", portal(&[("elements = 12", "elements = 12\ngrading = [0.0, 1.5, 0.5]")]));
    assert_snapshot!("grading_per_segment", portal(&[("elements = 12", "elements = 12\ngrading = [0.1, 0.2]")]));
    assert_snapshot!("grading_of_two", portal(&[("elements = 12", "elements = [12, 2, 12]\ngrading = 0.1")]));
    assert_snapshot!(
        "short_path",
        portal(&[("path = [\"foot_left\", \"knee_left\", \"knee_right\", \"foot_right\"]", "path = \"foot_left\"")])
    );
    assert_snapshot!("coincident_ends", portal(&[("point = [-0.1, 0.0, 2.0]", "point = [0.0, 0.0, 2.0]")]));
    assert_snapshot!(
        "ambiguous_end",
        portal(&[("to = { node = \"knee_left\" }", "to = { node = \"knee_left\", ground = [0.0, 0.0, 0.0] }")])
    );
}

#[test]
fn names() {
    assert_snapshot!("unknown_point", portal(&[("at = \"knee_right\"", "at = \"knee_rihgt\"")]));
    assert_snapshot!("unknown_amplitude", portal(&[("amplitude = \"pulse\"", "amplitude = \"pulses\"")]));
    assert_snapshot!("name_taken", portal(&[("name = \"block\"", "name = \"portal\"")]));
    assert_snapshot!("reserved_name", portal(&[("feet = [", "all = [\"foot_left\"]\nfeet = [")]));
    assert_snapshot!("set_of_itself", portal(&[("feet = [", "feet = [\"feet\", ")]));
    assert_snapshot!("beam_for_point", portal(&[("at = \"knee_right\"", "at = \"portal\"")]));
    assert_snapshot!("point_for_body", portal_and("[[attachments]]\nbody = \"knee_left\"\nnodes = \"knee_right\""));
    assert_snapshot!(
        "unused",
        portal(&[
            ("foot_right = [1.5, 0.0, 0.0]", "foot_right = [1.5, 0.0, 0.0]\nlost = [0.0, 0.0, 9.0]"),
            ("[sections.square]", "[materials.spare]\nmodel = \"elastic\"\nyoungs_modulus = 1e9\n\n[sections.square]"),
        ])
    );
}

#[test]
fn schemes() {
    let scheme = |text: &str| portal_and(&format!("[integrator]\n{text}"));
    assert_snapshot!("scheme_word", scheme("scheme = \"newmarc\""));
    assert_snapshot!("scheme_strays", scheme("scheme = \"bathe\"\ntheta = 1.4\nalpha = -0.1"));
    assert_snapshot!("scheme_ranges", scheme("scheme = \"hht-alpha\"\nalpha = 0.1"));
    assert_snapshot!("scheme_newmark", scheme("scheme = \"newmark\"\ngamma = 0.4\nbeta = 0.0"));
    assert_snapshot!("scheme_newmark_warnings", scheme("scheme = \"newmark\"\ngamma = 0.6\nbeta = 0.25"));
}

#[test]
fn explicit_schemes() {
    let scheme = |text: &str| portal_and(&format!("[integrator]\n{text}"));
    assert_snapshot!(
        "explicit_order",
        scheme("scheme = \"runge-kutta\"\norder = 4\nrotation_update = \"first-order\"")
    );
    assert_snapshot!("explicit_stray_order", scheme("scheme = \"central-difference\"\norder = 5"));
    let plastic = "model = \"elastic-plastic\"\nyield_stress = 275e6\n";
    let yields = [
        ("model = \"elastic\"\n", plastic),
        ("[materials.steel]", "[integrator]\nscheme = \"runge-kutta\"\n[materials.steel]"),
    ];
    assert_snapshot!("explicit_yields", portal(&yields));
    let free = "time_step = \"auto\"\nerror_tolerance = 1e-4\n[integrator]\nscheme = \"central-difference\"";
    assert_snapshot!("explicit_tolerance", portal(&[("time_step = 1e-4", free)]));
    let heavy = "orientation = [0.0, 1.0, 0.0]\nmass = \"consistent\"\n[integrator]\nscheme = \"central-difference\"";
    assert_snapshot!("explicit_consistent", portal(&[("orientation = [0.0, 1.0, 0.0]", heavy)]));
}

#[test]
fn links_that_fail() {
    let link = |failure: &str, more: &str| {
        format!(
            "[[links]]\nname = \"{more}{failure}\"\nfrom = {{ node = \"knee_right\" }}\nto = {{ ground = [1.5, 0.0, 3.0] }}\n{more}\n\
             failure = {{ {failure} }}\n"
        )
        .replacen(&format!("\"{more}{failure}\""), &format!("\"of {} and {}\"", more.len(), failure.len()), 1)
    };
    let bushing = "bushing = [1e6, 1e6, 1e6, 1e3, 1e3, 1e3]";
    let links = [
        link("normal = 3e3, shear = 2e3", "stiffness = 1e5"),
        link("normal = -3e3", "stiffness = 1e5"),
        link("exponents = [2.0, 2.0]", bushing),
        link("shear = 2e3, exponents = [2.0, 0.0]", bushing),
        link("normal = 2e3, force = 2e3", bushing),
    ];
    assert_snapshot!("links_that_fail", portal_and(&links.join("\n")));
    assert_eq!(portal_and(&link("normal = 3e3", "stiffness = 1e5")).trim(), "");
}

/// Links that remember.
#[test]
fn dampers_with_exponents() {
    let link = |name: &str, text: &str| {
        format!(
            "[[links]]\nname = \"{name}\"\nfrom = {{ node = \"knee_right\" }}\nto = {{ ground = [3.0, 0.0, 2.0] }}\n{text}\n"
        )
    };
    let good = "damping = { viscous = 1e4, exponent = 0.3, slow = 1e-3 }";
    assert_eq!(portal_and(&link("good", good)).trim(), "");
    let bad = [
        "damping = { viscous = 1e4, exponent = 0.3 }",
        "damping = { viscous = 1e4, exponent = 0.3, slow = 0.0 }",
        "damping = { viscous = 1e4, exponent = 0.0, slow = 1e-3 }",
        "damping = { viscous = 1e4, exponent = 5.0 }",
        "damping = { exponent = 2.0, beta = 1e-3 }\nstiffness = 1e5",
        "damping = { viscous = 1e4, slow = 1e-3 }",
        "bushing = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0]\ndamping = { exponent = 2.0, beta = 1e-3 }",
    ];
    let joint = "[[joints]]\nname = \"pin\"\nkind = \"revolute\"\nfrom = { node = \"knee_right\" }\nto = { ground = [1.5, 0.0, 2.0] }\n\
                 axis = [0.0, 1.0, 0.0]\ndamping = { viscous = 1.0, exponent = 0.5, slow = 1e-3 }\n";
    let bad = bad.iter().enumerate().map(|(k, text)| link(&format!("bad_{k}"), text)).collect::<String>() + joint;
    assert_snapshot!("dampers_with_exponents", portal_and(&bad));
    let dynamic = "kind = \"dynamic\"\nend_time = 0.3\ntime_step = 1e-4\n";
    let modes = |damped: &str| portal(&[(dynamic, damped), ("[analysis]", &(link("good", good) + "[analysis]"))]);
    assert_snapshot!("dampers_with_exponents_in_modes", modes("kind = \"modal\"\ndamped = true\n"));
    assert!(!modes("kind = \"modal\"\n").contains("error"));
}

#[test]
fn links_that_yield() {
    let link = |name: &str, text: &str| {
        format!(
            "[[links]]\nname = \"{name}\"\nfrom = {{ node = \"knee_right\" }}\nto = {{ ground = [3.0, 0.0, 2.0] }}\n{text}\n"
        )
    };
    let good = "stiffness = 1e6\nyield_force = 1e3\npost_yield_stiffness = 1e5";
    for law in ["yielding", "bouc-wen"] {
        assert_eq!(portal_and(&link(law, &format!("law = \"{law}\"\n{good}"))).trim(), "");
    }
    let links = [
        "law = \"yielding\"\nstiffness = 1e6".to_owned(),
        "law = \"yielding\"\nstiffness = 1e5\nyield_force = 1e3\npost_yield_stiffness = 1e5".to_owned(),
        "law = \"yielding\"\nbackbone = [[0.01, 1e3], [0.02, 9e3]]".to_owned(),
        format!(
            "law = \"yielding\"\n{good}\nexponent = 2.0\ngap = 0.1\nfailure = {{ normal = 1e3 }}\npretension = 5.0"
        ),
        format!("law = \"bouc-wen\"\n{good}\nexponent = 0.5\nunloading = 0.2\nstrength_loss = -1.0"),
        format!("law = \"bouc-wen\"\n{good}\nbackbone = [[0.01, 1e3]]\npreload = 2.0"),
        "stiffness = 1e6\nyield_force = 1e3".to_owned(),
    ];
    let links: Vec<String> = links.iter().enumerate().map(|(i, text)| link(&format!("l{i}"), text)).collect();
    assert_snapshot!("links_that_yield", portal_and(&links.join("\n")));
}

/// Modal damping.
#[test]
fn modal_damping() {
    let damping = |text: &str| portal_and(&format!("[damping]\nmodal = {{ {text} }}\n"));
    assert_eq!(damping("ratio = 0.02, modes = 5").trim(), "");
    assert_eq!(damping("ratios = [0.02, 0.03]").trim(), "");
    assert_snapshot!("modal_damping_without_modes", damping("ratio = 0.02"));
    assert_snapshot!("modal_damping_too_strong", damping("ratio = 2.0, modes = 5"));
    assert_snapshot!("modal_damping_of_all", damping("ratio = 0.02, modes = 100000"));
    assert_snapshot!("modal_damping_twice", damping("ratio = 0.02, ratios = [0.02, -0.1]"));
    let explicit = damping("ratio = 0.02, modes = 5 }\n[integrator]\nscheme = \"central-difference\"\n# {");
    assert!(explicit.contains("`modal` damping does not go with explicit schemes"), "{explicit}");
    let modal = [("kind = \"dynamic\"\nend_time = 0.3\ntime_step = 1e-4\n", "kind = \"modal\"\n")];
    let text = "[damping]\nmodal = { ratio = 0.02, modes = 5 }\n[analysis]";
    assert_snapshot!("modal_damping_of_modes", portal(&[modal[0], ("[analysis]", text)]));
}

/// Hysteresis that falls, and that pinches.
#[test]
fn hysteresis_that_deteriorates() {
    let link = |name: &str, text: &str| {
        format!(
            "[[links]]\nname = \"{name}\"\nfrom = {{ node = \"knee_right\" }}\nto = {{ ground = [3.0, 0.0, 2.0] }}\n{text}\n"
        )
    };
    let yields = "law = \"ibarra-medina-krawinkler\"\nstiffness = 1e6\nyield_force = 1e3\npost_yield_stiffness = 1e4";
    let pinches = "law = \"pinching\"\nbackbone = [[0.001, 1e3], [0.01, 1.2e3], [0.05, 5e2]]";
    let good = [
        format!(
            "{yields}\ndeterioration = {{ capping = 0.02, post_capping = 0.1, residual = 0.2, ultimate = 0.2, strength = 1.0, softening = 1.0, unloading = 2.0, exponent = 1.2 }}"
        ),
        format!(
            "{pinches}\npinching = {{ force = 0.4, elongation = 0.7, ductility = 0.01, energy = 0.02, unloading = 0.3 }}"
        ),
    ];
    for text in good {
        assert_eq!(portal_and(&link("fuse", &text)).trim(), "");
    }
    let links = [
        yields.to_owned(),
        format!("{yields}\ndeterioration = {{ capping = 0.0, residual = 1.0, strength = -1.0, exponent = 3.0 }}"),
        format!(
            "{yields}\ndeterioration = {{ capping = 0.02, post_capping = 0.1 }}\nexponent = 2.0\npinching = {{ force = 0.4 }}\npreload = 1.0"
        ),
        pinches.to_owned(),
        format!("{pinches}\npinching = {{ force = 1.5, elongation = 0.0, energy = -0.1 }}"),
        "law = \"pinching\"\nbackbone = [[0.001, 1e3], [0.01, 1.2e4]]\npinching = { force = 0.5 }\nstiffness = 1e6"
            .to_owned(),
        "law = \"yielding\"\nstiffness = 1e6\nyield_force = 1e3\npinching = { force = 0.5 }".to_owned(),
    ];
    let links: Vec<String> = links.iter().enumerate().map(|(i, text)| link(&format!("l{i}"), text)).collect();
    assert_snapshot!("hysteresis_that_deteriorates", portal_and(&links.join("\n")));
    let joint = |name: &str, text: &str| {
        format!(
            "[[joints]]\nname = \"{name}\"\nkind = \"revolute\"\nfrom = {{ node = \"knee_right\" }}\nto = {{ ground = [3.0, 0.0, 2.0] }}\naxis = [0.0, 1.0, 0.0]\n{text}\n"
        )
    };
    let joints = [
        "stiffness = 1e6\ndeterioration = { capping = 0.02, post_capping = 0.1 }",
        "backbone = [[0.01, 1e3]]\ndeterioration = { capping = 0.02, post_capping = 0.1 }",
        "stiffness = 1e6\nyield_moment = 1e3\npinching = { force = 0.5 }",
        "backbone = [[0.01, 1e3], [0.005, 1e3]]\npinching = { force = 0.5 }",
    ];
    let joints: Vec<String> = joints.iter().enumerate().map(|(i, text)| joint(&format!("j{i}"), text)).collect();
    assert_snapshot!("joints_that_deteriorate", portal_and(&joints.join("\n")));
}

/// Isolators.
#[test]
fn isolators() {
    let link = |name: &str, text: &str| {
        format!(
            "[[links]]\nname = \"{name}\"\nfrom = {{ ground = [3.0, 0.0, 1.0] }}\nto = {{ node = \"knee_right\" }}\n{text}\n"
        )
    };
    let axes = "axes = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]";
    let pendulum = "law = \"friction-pendulum\"\nstiffness = 1e7\naxial_stiffness = 1e9\nradius = 2.0";
    let rubber = "law = \"lead-rubber\"\nstiffness = 1e6\naxial_stiffness = 1e9\nyield_force = 1e3";
    let good = [
        format!("{pendulum}\n{axes}\nfriction = {{ slow = 0.03, fast = 0.06, rate = 50.0 }}"),
        format!("{rubber}\n{axes}\npost_yield_stiffness = 1e5\ndamping = {{ beta = 1e-3 }}"),
    ];
    for text in good {
        assert_eq!(portal_and(&link("bearing", &text)).trim(), "");
    }
    let links = [
        "law = \"friction-pendulum\"".to_owned(),
        format!("{pendulum}\n{axes}\nfriction = -0.1"),
        format!("{pendulum}\n{axes}\nfriction = 0.1\ndamping = {{ beta = 1e-3 }}"),
        format!("{pendulum}\n{axes}\nfriction = {{ slow = 0.03, fast = -0.06 }}"),
        format!(
            "{pendulum}\n{axes}\nfriction = 0.1\nyield_force = 1e3\ndirection = [0.0, 0.0, 1.0]\ndamping = 10.0\npretension = 5.0"
        ),
        format!("{rubber}\n{axes}"),
        format!("{rubber}\n{axes}\npost_yield_stiffness = 2e6\nradius = 1.0\nhardening = \"isotropic\""),
        format!("{rubber}\n{axes}\npost_yield_stiffness = 2e5\nbushing = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0]"),
        "stiffness = 1e6\nradius = 1e3".to_owned(),
    ];
    let links: Vec<String> = links.iter().enumerate().map(|(i, text)| link(&format!("l{i}"), text)).collect();
    assert_snapshot!("isolators", portal_and(&links.join("\n")));
}

/// A section by its matrix.
#[test]
fn matrices_of_sections() {
    let section =
        |text: &str| portal(&[("[points]", &format!("[sections.blade]\nshape = \"general\"\n{text}\n[points]"))]);
    let rows = |change: &str| {
        let row = |i: usize| (0..6).map(|j| if i == j { "1e6" } else { "0.0" }).collect::<Vec<_>>().join(", ");
        let rows: Vec<String> = (0..6).map(|i| format!("[{}]", row(i))).collect();
        format!("stiffness = [{}]", rows.join(", ")).replacen("1e6, 0.0", change, 1)
    };
    assert_snapshot!("section_matrix_unsymmetric", section(&rows("1e6, 5e4")));
    assert_snapshot!("section_matrix_indefinite", section(&rows("-1e6, 0.0")));
    assert_snapshot!("section_matrix_and_more", section(&(rows("1e6, 0.0") + "\naxial_stiffness = 1e6\narea = 1.0")));
    assert_snapshot!("section_matrix_short", section("stiffness = [[1e6, 0.0], [0.0, 1e6]]"));
}

/// Sections of polygons.
#[test]
fn polygons_of_sections() {
    let square = "[[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]]";
    let inner = "[[0.02, 0.02], [0.08, 0.02], [0.08, 0.08], [0.02, 0.08]]";
    let section = |keys: &str| {
        let shape = "shape = \"rectangle\"\nwidth = 0.05\nheight = 0.05\n";
        portal(&[(shape, &format!("shape = \"polygons\"\n{keys}\n"))])
    };
    let of = |points: &str| format!("polygons = [{{ points = {points} }}]");
    let faults = [
        of("[[0.0, 0.0], [0.1, 0.1], [0.1, 0.0], [0.0, 0.2]]"),
        of("[[0.0, 0.0], [0.1, 0.0]]"),
        of("[[0.0, 0.0], [0.1, 0.0], [0.2, 0.0]]"),
        of("[[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.05, 0.05], [0.0, 0.1], [0.05, 0.05]]"),
        format!("polygons = [{{ points = {square}, holes = [[[0.2, 0.0], [0.3, 0.0], [0.3, 0.1]]] }}]"),
        format!("polygons = [{{ points = {square}, holes = [{square}] }}]"),
        format!("polygons = [{{ points = {square} }}, {{ points = {inner} }}]"),
        format!("polygons = [{{ points = {square} }}, {{ points = {square} }}]"),
        format!(
            "polygons = [{{ points = {square} }}, {{ points = [[0.05, 0.05], [0.2, 0.05], [0.2, 0.2], [0.05, 0.2]] }}]"
        ),
        format!("polygons = [{{ points = {square} }}, {{ points = [[0.2, 0.0], [0.3, 0.0], [0.3, 0.1]] }}]"),
        format!("polygons = [{{ points = {square}, material = \"steal\" }}]"),
        format!("mesh_size = 1e-5\npolygons = [{{ points = {square} }}]"),
        format!("mesh_size = 0.1\npolygons = [{{ points = {square} }}]"),
        "polygons = []".to_owned(),
        // Edges that share their ends with the square lead through it.
        "polygons = [{ points = [[0, 0], [1, 0], [1, 1], [0, 1]] }, { points = [[1, 0], [2, 0], [2, 2], [-1, 2], [0, 0], [1, 1]] }]"
            .to_owned(),
        format!(
            "polygons = [{{ points = {square}, holes = [{inner}, [[0.08, 0.02], [0.09, 0.02], [0.09, 0.08], [0.08, 0.08]]] }}]"
        ),
        // A hole that leaves the outline between two of its corners.
        "polygons = [{ points = [[0, 0], [4, 0], [4, 4], [2, 1], [0, 4]], holes = [[[0, 4], [2, 0.5], [4, 4]]] }]".to_owned(),
        String::new(),
    ];
    let said: Vec<String> = faults.iter().map(|keys| section(keys)).collect();
    assert_snapshot!("polygons_of_sections", said.join("\n"));
}

/// Materials of polygons, and what does not go with polygons.
#[test]
fn materials_of_polygons() {
    let square = "[[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]]";
    let section = |keys: &str, more: &[(&str, &str)]| {
        let shape = "shape = \"rectangle\"\nwidth = 0.05\nheight = 0.05\n";
        let keys = format!("{keys}\n");
        portal(&[&[(shape, keys.as_str())], more].concat())
    };
    let with = |keys: &str| format!("shape = \"polygons\"\npolygons = [{{ points = {square}{keys} }}]");
    let lamina = |direction: &str, moduli: &str, ratios: &str| {
        with(&format!(
            ", lamina = {{ youngs_moduli = [{moduli}], shear_moduli = [1e9, 1e9, 1e9], poisson_ratios = [{ratios}], density = 1.0, direction = [{direction}] }}"
        ))
    };
    let (moduli, ratios, along) = ("1e11, 1e10, 1e10", "0.3, 0.3, 0.3", "1.0, 0.0");
    let sound = lamina(along, moduli, ratios);
    let none: (&str, &str) = ("material = \"steel\"\nsection", "section");
    let said = [
        section(&sound, &[]),
        section(&sound.replace("lamina", "material = \"steel\", lamina"), &[none]),
        section(&sound.replace(", density = 1.0", ""), &[none]),
        section(&lamina(along, "1e11, 0.0, 1e10", ratios), &[none]),
        section(&lamina("0.0, 0.0", moduli, ratios), &[none]),
        section(&lamina(along, moduli, "4.0, 0.3, 0.3"), &[none]),
        section(&with(", material = \"steel\""), &[]),
        section(&with(""), &[none]),
        section(&with(""), &[("poisson_ratio = 0.3", "poisson_ratio = 0.4995")]),
        section(
            &with(""),
            &[("model = \"elastic\"", "model = \"elastic-plastic\"\nyield_stress = 2e8\nhardening_modulus = 1e9")],
        ),
        section(&format!("{}\nbars = [{{ material = \"steel\", area = 1e-4, at = [0.0, 0.0] }}]", with("")), &[]),
        section(&with("").replace("\"polygons\"", "\"circle\"\nradius = 0.1"), &[]),
    ];
    assert_snapshot!("materials_of_polygons", said.join("\n"));
}

/// Links by full matrices.
#[test]
fn matrices_of_links() {
    let link = |name: &str, text: &str| {
        format!(
            "[[links]]\nname = \"{name}\"\nfrom = {{ node = \"knee_right\" }}\nto = {{ ground = [3.0, 0.0, 2.0] }}\n{text}\n"
        )
    };
    let two = "stiffness = [[1e6, 2e5], [-2e5, 1e6]]";
    assert_eq!(portal_and(&link("film", &format!("matrices = [{{ {two} }}]"))).trim(), "");
    let six = "[0.0, 0.0, 0.0, 0.0, 0.0, 0.0]";
    let about = format!("stiffness = [{six}, {six}, {six}, [0.0, 0.0, 0.0, 1.0, 0.0, 0.0], {six}, {six}]");
    let tables = [
        String::new(),
        "{ damping = [[1.0, 0.0], [0.0, 1.0]] }".to_owned(),
        format!("{{ {two} }}, {{ {two} }}"),
        format!("{{ speed = 2.0, {two} }}, {{ speed = 2.0, {two} }}"),
        format!("{{ speed = -1.0, {two} }}"),
        "{ stiffness = [[1e6]] }".to_owned(),
        "{ stiffness = [[1e6, 0.0], [0.0, 1e6, 0.0]] }".to_owned(),
        format!("{{ {about} }}"),
    ];
    let mut links: Vec<String> =
        tables.iter().enumerate().map(|(i, of)| link(&format!("l{i}"), &format!("matrices = [{of}]"))).collect();
    let others =
        "bushing = [1e6, 1e6, 1e6, 1e3, 1e3, 1e3]\nstiffness = 1.0\nfailure = { normal = 1.0 }\npretension = 1.0";
    links.push(link("others", &format!("matrices = [{{ {two} }}]\n{others}")));
    assert_snapshot!("matrices_of_links", portal_and(&links.join("\n")));
}

/// Mass scaling, and what it does not go with.
#[test]
fn mass_scaling() {
    let scheme = |text: &str| format!("[integrator]\n{text}\n");
    let scaled = |step: &str| scheme(&format!("scheme = \"central-difference\"\nmass_scaling_step = {step}"));
    assert_eq!(portal_and(&scaled("1e-4")).trim(), "");
    assert_snapshot!("mass_scaling_step", portal_and(&scaled("0.0")));
    assert_snapshot!("mass_scaling_implicit", portal_and(&scheme("scheme = \"newmark\"\nmass_scaling_step = 1e-4")));
    assert_snapshot!(
        "mass_scaling_runge_kutta",
        portal_and(&scheme("scheme = \"runge-kutta\"\nmass_scaling_step = 1e-4"))
    );
    let with = |mass: &str| {
        let beam = format!("orientation = [0.0, 1.0, 0.0]\nmass = \"{mass}\"\n{}", scaled("1e-4"));
        portal(&[("orientation = [0.0, 1.0, 0.0]", &beam)])
    };
    assert_snapshot!("mass_scaling_consistent", with("consistent"));
    assert_snapshot!("mass_scaling_of_nothing", with("none"));
    assert_snapshot!("mass_scaling_long_step", portal_and(&scaled("5e-5")));
    assert_snapshot!("mass_scaling_beyond_the_end", portal_and(&scaled("1e150")));
    assert_snapshot!("mass_scaling_short_step", portal_and(&scaled("1e-3")));
    let automatic = |step: &str| portal(&[("time_step = 1e-4\n", &format!("time_step = \"auto\"\n{}", scaled(step)))]);
    assert_eq!(automatic("0.01").trim(), "");
    assert_snapshot!("mass_scaling_unused_step", automatic("0.05"));
    // Modes take no steps.
    let modal = [("kind = \"dynamic\"\nend_time = 0.3\ntime_step = 1e-4\n", "kind = \"modal\"\n")];
    assert!(!portal(&[modal[0], ("[analysis]", &(scaled("0.5") + "[analysis]"))]).contains("motion"));
    let more = "[damping]\nmass_factor = 2e4\n[[environment.base_acceleration]]\ndirection = [1.0, 0.0, 0.0]\namplitude = \"pulse\"\n";
    assert_snapshot!("mass_scaling_and_the_ground", portal_and(&(scaled("1e-4") + more)));
    let analysis = "[analysis]\nkind = \"dynamic\"\nend_time = 0.3\ntime_step = 1e-4\n";
    let stage = |name: &str, own: &str| {
        format!("[[stages]]\nname = \"{name}\"\nkind = \"dynamic\"\nduration = 0.1\ntime_step = 1e-4\n{own}")
    };
    let stages = |own: &str| portal(&[(analysis, &(scaled("1e-4") + &stage("first", "") + &stage("second", own)))]);
    assert_eq!(stages("").trim(), "");
    assert_eq!(stages("integrator = { scheme = \"newmark\" }\n").trim(), "");
    let other = "integrator = { scheme = \"central-difference\", mass_scaling_step = 2e-4 }\n";
    assert_snapshot!("mass_scaling_in_one_stage", stages(other));
    let central = |word: &str| format!("[integrator]\nscheme = \"central-difference\"\nmass_scaling = \"{word}\"\n");
    assert_snapshot!("mass_scaling_off_and_step", portal_and(&(central("off") + "mass_scaling_step = 1e-4\n")));
    assert_snapshot!(
        "mass_scaling_of_newmark",
        portal_and("[integrator]\nscheme = \"newmark\"\nmass_scaling = \"off\"\n")
    );
}

/// Links are pulled in static stages.
#[test]
fn pretensions() {
    let link = |name: &str, text: &str| {
        format!(
            "[[links]]\nname = \"{name}\"\nfrom = {{ node = \"knee_right\" }}\nto = {{ ground = [3.0, 0.0, 2.0] }}\n\
             pretension = 1e3\n{text}\n"
        )
    };
    let laws = [
        "law = \"compression-only\"\nstiffness = 1e5",
        "law = \"tension-only\"\nstiffness = 1e5\ngap = 0.1",
        "damping = 10.0",
        "bushing = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0]",
        "stiffness = 1e5\npreload = 1.0",
    ];
    let links: Vec<String> = laws.iter().enumerate().map(|(i, law)| link(&format!("l{i}"), law)).collect();
    assert_snapshot!("pretension_without_stage", portal_and(&link("tie", "stiffness = 1e5")));
    let stages = |kinds: &str, links: &str| {
        let stage = |(i, kind): (usize, &str)| {
            format!("[[stages]]\nname = \"s{i}\"\nkind = \"{kind}\"\nduration = 1.0\ntime_step = 0.1\n")
        };
        let analysis = "[analysis]\nkind = \"dynamic\"\nend_time = 0.3\ntime_step = 1e-4\n";
        let stages: String = kinds.split(' ').enumerate().map(stage).collect();
        portal(&[(analysis, &format!("{stages}{links}"))])
    };
    assert_snapshot!("pretension_laws", stages("static dynamic", &links.concat()));
    let tie = |names: &str| link("tie", &format!("stiffness = 1e5\nstages = {names}"));
    assert_snapshot!("pretension_in_motion", stages("static dynamic", &tie("[\"s1\"]")));
    assert_snapshot!("pretension_and_break", stages("static dynamic dynamic", &tie("[\"s0\", \"s2\"]")));
    assert_eq!(stages("dynamic static dynamic", &tie("[\"s1\", \"s2\"]")).trim(), "");
}

/// Joints with what acts along their coordinates; everything that is wrong is said at once.
#[test]
fn joint_coordinates() {
    let ends = "from = { node = \"knee_right\" }\nto = { ground = [1.5, 0.0, 2.0] }";
    let joint = |name: &str, kind: &str, text: &str| {
        let axis = if kind == "spherical" { "" } else { "axis = [0.0, 1.0, 0.0]\n" };
        format!("[[joints]]\nname = \"{name}\"\nkind = \"{kind}\"\n{axis}{ends}\n{text}\n")
    };
    let swing = "[amplitudes.swing]\nkind = \"sine\"\nfrequency = 0.25\nphase = 1.0\n";
    let position = "motion = { position = 8.0, amplitude = \"swing\" }";
    let all = |joints: &[[&str; 2]]| -> String {
        let joints = joints.iter().enumerate().map(|(i, [kind, text])| joint(&format!("j{i}"), kind, text));
        portal_and(&(swing.to_owned() + &joints.collect::<Vec<_>>().join("\n")))
    };
    let on_none = "coordinate = \"angle\"\nmotion = { velocity = 1.0 }\nstiffness = 3.0\nlimits = [-1.0, 1.0]";
    let against = format!("{position}\neffort = {{ value = 1.0 }}\nlimits = [-0.1, 0.2]\nlimit_stiffness = 10.0");
    assert_snapshot!(
        "joint_motions",
        all(&[
            ["spherical", on_none],
            ["revolute", &against],
            ["revolute", "motion = { position = 8.0, velocity = 1.0, amplitude = \"swing\" }"],
            ["revolute", "motion = { position = 8.0 }"],
            ["revolute", "motion = { velocity = 8.0, amplitude = \"swung\" }"],
            ["prismatic", "motion = { }"],
            ["prismatic", "motion = { speed = 1.0 }"],
            ["prismatic", position],
        ])
    );
    assert_snapshot!(
        "joint_efforts",
        all(&[
            ["revolute", "coordinate = \"distance\"\neffort = { amplitude = \"swing\" }"],
            ["revolute", "limits = [0.2, -0.1]\nrestitution = 2.0"],
            ["revolute", "limits = [0.1, 0.2]\nlimit_stiffness = 0.0"],
            ["revolute", "rest = 1.0\nlimit_stiffness = 3.0\nstick = 1e-3"],
            ["cylindrical", "friction_moment = 3.0\nstiffness = -1.0"],
            ["screw", "lead = 0.0\nfriction_moment = -3.0"],
            ["screw", "lead = 0.1\nfriction = 0.1\nradius = 0.02"],
            ["revolute", "friction = 0.1"],
            ["revolute", "friction = -0.1\nradius = 0.0"],
            ["prismatic", "friction = 0.1\nradius = 0.02"],
            ["prismatic", "radius = 0.02"],
            ["screw", "torque = 3.0"],
        ])
    );
    assert_snapshot!(
        "joint_yields",
        all(&[
            ["revolute", "yield_moment = 3.0"],
            ["revolute", "yield_moment = -3.0\nstiffness = 10.0\nrest = 0.1"],
            ["revolute", "yield_force = 3.0\nstiffness = 10.0"],
            ["revolute", "yield_moment = 3.0\nstiffness = 10.0\npost_yield_stiffness = 20.0"],
            ["revolute", "post_yield_stiffness = 20.0"],
            ["revolute", "backbone = [[0.1, 3.0], [0.05, 4.0]]\nstiffness = 1.0"],
            ["prismatic", "backbone = [[0.1, 3.0], [0.2, 7.0]]"],
            ["prismatic", "backbone = []"],
            ["spherical", "yield_moment = 3.0"],
        ])
    );
    let rubs = joint("rail", "revolute", "friction = 0.1\nradius = 0.02");
    let step = |to: &str| portal(&[("time_step = 1e-4", to), ("[sets]", &format!("{rubs}\n[sets]"))]);
    assert_snapshot!("friction_and_automatic_steps", step("time_step = \"auto\""));
    assert_eq!(step("time_step = 1e-4").trim(), "");
    let gear = |joint: &str| format!("gear = {{ joint = \"{joint}\", ratio = 2.0 }}");
    assert_snapshot!(
        "joint_gears",
        all(&[
            ["revolute", "gear = { joint = \"j1\", ratio = 0.0 }"],
            ["revolute", "gear = { joint = \"j2\" }"],
            ["revolute", &gear("j2")],
            ["revolute", &gear("j4")],
            ["revolute", &gear("j3")],
            ["revolute", &gear("j12")],
            ["spherical", &gear("j0")],
            ["revolute", &gear("j6")],
            ["prismatic", &format!("motion = {{ velocity = 1.0 }}\n{}", gear("j0"))],
        ])
    );
    let drive = |velocity: &str| {
        format!(
            "[[bodies]]\nname = \"wheel\"\ncenter = [1.5, 9.0, 2.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n{velocity}\n\
             [[joints]]\nname = \"slew\"\nkind = \"revolute\"\naxis = [0.0, 1.0, 0.0]\nfrom = {{ ground = [1.5, 9.0, 2.0] }}\n\
             to = {{ body = \"wheel\" }}\nmotion = {{ velocity = 0.2 }}"
        )
    };
    assert_snapshot!("joint_speed", portal_and(&drive("angular_velocity = [0.0, 0.3, 0.0]")));
    assert_snapshot!("joint_fixed_ends", portal_and(&drive("[[supports]]\nat = \"wheel\"\nfix = \"all\"")));
    let fixed = drive("angular_velocity = [0.0, 0.2, 0.0]");
    assert_eq!(portal_and(&fixed).trim(), "", "the same speed is no contradiction");
}

#[test]
fn joints() {
    let joint = |text: &str| portal_and(&format!("[[joints]]\nname = \"pin\"\n{text}"));
    let ends = "from = { node = \"knee_right\" }\nto = { ground = [1.5, 0.0, 2.0] }";
    assert_snapshot!("joint_empty", portal_and("[[joints]]"));
    assert_snapshot!("joint_kind", joint(&format!("kind = \"hing\"\n{ends}")));
    assert_snapshot!("joint_without_axis", joint(&format!("kind = \"hinge\"\n{ends}")));
    assert_snapshot!("joint_with_axis", joint(&format!("kind = \"ball\"\naxis = [1.0, 0.0, 0.0]\n{ends}")));
    assert_snapshot!("joint_axis_zero", joint(&format!("kind = \"slider\"\naxis = [0.0, 0.0, 0.0]\n{ends}")));
    assert_snapshot!(
        "joint_cross",
        joint(&format!("kind = \"universal\"\naxis = [1.0, 0.0, 0.0]\ncross_axis = [1.0, 1.0, 0.0]\n{ends}"))
    );
    assert_snapshot!(
        "joint_apart",
        joint("kind = \"ball\"\nfrom = { node = \"knee_right\" }\nto = { body = \"block\", point = [0.0, 0.0, 2.0] }")
    );
    assert_snapshot!(
        "joint_nowhere",
        joint(
            "kind = \"distance\"\nfrom = { node = \"knee_right\" }\nto = { body = \"block\", point = [1.5, 0.0, 2.0] }"
        )
    );
    assert_snapshot!(
        "joint_to_itself",
        joint("kind = \"ball\"\nfrom = { body = \"block\" }\nto = { body = \"block\" }")
    );
    assert_snapshot!(
        "joint_unknown",
        joint("kind = \"ball\"\nfrom = { node = \"knee_rihgt\" }\nto = { body = \"blok\" }")
    );
    assert_snapshot!(
        "joint_for_point",
        portal_and(&format!(
            "[[joints]]\nname = \"pin\"\nkind = \"ball\"\n{ends}\n\n[[loads]]\nat = \"pin\"\nforce = [1.0, 0.0, 0.0]"
        ))
    );
}

#[test]
fn constraints() {
    let second = "[[bodies]]\nname = \"second\"\ncenter = [3.0, 0.0, 2.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n";
    assert_snapshot!(
        "attached_twice",
        portal_and(&format!(
            "{second}[[attachments]]\nbody = \"block\"\nnodes = \"knee_right\"\n
[[attachments]]\nbody = \"second\"\nnodes = [\"knee_right\"]\nmethod = \"elimination\"\n
[[attachments]]\nbody = \"block\"\nnodes = [\"knee_right\"]"
        ))
    );
    assert_snapshot!(
        "attached_in_a_circle",
        portal_and(&format!(
            "{second}[[attachments]]\nbody = \"block\"\nnodes = \"second\"\n\n[[attachments]]\nbody = \"second\"\nnodes = \"block\""
        ))
    );
    assert_snapshot!("attached_to_itself", portal_and("[[attachments]]\nbody = \"block\"\nnodes = \"block\""));
    assert_snapshot!(
        "attached_to_itself_by_a_set",
        portal(&[
            ("[sets]\n", "[sets]\nright = [\"block\", \"knee_right\"]\n"),
            ("[[supports]]", "[[attachments]]\nbody = \"block\"\nnodes = \"right\"\n\n[[supports]]"),
        ])
    );
    assert_snapshot!(
        "fixed_and_moved",
        portal_and(
            "[[supports]]\nat = \"foot_left\"\nmotion = { ux = { amplitude = \"pulse\" } }\n
[[supports]]\nat = \"knee_right\"\nfix = [\"uz\"]\nmotion = { uz = { amplitude = \"pulse\" } }"
        )
    );
    assert_snapshot!("support_of_nothing", portal_and("[[supports]]\nat = \"block\""));
}

#[test]
fn loads_and_values() {
    assert_snapshot!(
        "load_on_nothing",
        portal(&[
            ("foot_right = [1.5, 0.0, 0.0]", "foot_right = [1.5, 0.0, 0.0]\nlost = [0.0, 0.0, 9.0]"),
            ("at = \"knee_right\"", "at = \"lost\""),
        ])
    );
    let bar = "[[bars]]\nname = \"stay\"\npath = [\"knee_left\", \"tip\"]\nmaterial = \"steel\"\narea = 1e-4\n";
    assert_snapshot!(
        "moment_on_a_bar",
        portal(&[
            ("foot_right = [1.5, 0.0, 0.0]", "foot_right = [1.5, 0.0, 0.0]\ntip = [0.0, 0.0, 9.0]"),
            ("[[bodies]]", &format!("{bar}\n[[bodies]]")),
            ("at = \"knee_right\"\nforce", "at = \"tip\"\nmoment"),
        ])
    );
    assert_snapshot!("empty_load", portal_and("[[loads]]\nat = \"knee_left\""));
    assert_snapshot!(
        "expect",
        portal_and(
            "[[expect]]\nat = \"knee_right\"\nquantity = \"qw\"\ntime = 4.0\nvalue = 0.0\ntolerance = 0.1\n
[[expect]]\nat = \"energy\"\nquantity = \"kinetik\"\npeak = \"max\"\nvalue = 1.0\n
[[expect]]\nat = \"feet\"\nquantity = \"ux\"\npeak = \"max\"\nvalue = 1.0\ntolerance = 0.1\n\
             [[supports]]\nname = \"side\"\nat = \"knee_left\"\nfix = [\"uy\"]\n\
             [[expect]]\nat = \"side\"\nquantity = \"fy\"\npeak = \"max\"\nvalue = 1.0\ntolerance = 0.1"
        )
    );
    assert_snapshot!(
        "output",
        portal_and(
            "[output]\nnodes = [\"block\", \"knee_left\"]\nevery = 0\nfields = { every = 2 }\ncheckpoint = 0.0\ncontacts = { by = \"pair\" }\nsections = {}"
        )
    );
    assert_snapshot!("initial", portal_and("[[initial]]\nat = [\"portal\", \"everything\"]"));
    assert_snapshot!("initial_normal", portal_and("[[initial]]\nat = \"portal\"\nnormal_velocity = 1.0"));
    assert_snapshot!(
        "initial_normal_and_more",
        portal_and(
            "[[initial]]\nat = \"block\"\nvelocity = [1.0, 0.0, 0.0]\nnormal_velocity = 1.0\n
[[initial]]\nat = \"block\"\nvelocity = [1.0, 0.0, 0.0]\nabout = [0.0, 0.0, 0.0]\nprofile = []"
        )
    );
    assert_snapshot!(
        "initial_profile",
        portal_and(
            "[[initial]]\nat = \"block\"\nvelocity = [1.0, 0.0, 0.0]\nreplaces = true\nprofile = [\n  {},\n
  { amplitude = \"wave\", direction = [0.0, 0.0, 0.0] },\n
  { amplitude = \"wave\", direction = [1.0, 0.0, 0.0], axis = [-2.0, 0.0, 0.0] },\n]"
        )
    );
}

/// Whatever is done to a deck, it is answered, by a model or by errors, and every answer can be drawn.
#[test]
fn no_text_is_too_wrong() {
    let sound = include_str!("everything.toml");
    let scraps =
        ["[", "]", "{", "}", "=", "\"", "\n", ".", ",", "#", "0", "-1", "1e999", "nan", "true", "\u{e9}", "[[x]]\n"];
    let mut random = StdRng::seed_from_u64(1993);
    for _ in 0..1500 {
        let mut text = sound.to_owned();
        for _ in 0..random.random_range(1..4) {
            let mut cut = [random.random_range(0..text.len()), random.random_range(0..text.len())];
            cut.sort_unstable();
            if cut[1] - cut[0] > 40 {
                cut[1] = cut[0] + random.random_range(0..8);
            }
            if text.is_char_boundary(cut[0]) && text.is_char_boundary(cut[1]) {
                text.replace_range(cut[0]..cut[1], scraps[random.random_range(0..scraps.len())]);
            }
        }
        said(&text, &[]);
    }
}

/// A sound deck of two patches; as with [`PORTAL`].
const SHEET: &str = r#"
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.1

[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3

[points]
a = [0.0, 0.0, 0.0]
b = [1.0, 0.0, 0.0]
c = [1.0, 1.0, 0.0]
d = [0.0, 1.0, 0.0]
e = [2.0, 0.5, 0.0]

[[shells]]
name = "sheet"
corners = ["a", "b", "c", "d"]
elements = [3, 4]
thickness = 0.01
material = "steel"

[[shells]]
name = "flap"
corners = ["b", "e", "c"]
elements = 4
thickness = 0.02
material = "steel"

[[supports]]
at = "sheet.edge4"
fix = "all"

[[loads]]
at = "flap"
pressure = 1e3
"#;

fn sheet(old: &str, new: &str) -> String {
    assert!(SHEET.contains(old), "`{old}` is not in the deck");
    said(&SHEET.replacen(old, new, 1), &[])
}

#[test]
fn shells() {
    assert_eq!(said(SHEET, &[]), "");
    let four = r#"["a", "b", "c", "d"]"#;
    assert_snapshot!("shell_of_two_corners", sheet(four, r#"["a", "b"]"#));
    assert_snapshot!("shell_unknown_corner", sheet(four, r#"["a", "b", "c", "dd"]"#));
    assert_snapshot!("shell_corner_twice", sheet(four, r#"["a", "b", "c", "c"]"#));
    assert_snapshot!("shell_crossed_corners", sheet(four, r#"["a", "c", "b", "d"]"#));
    assert_snapshot!("shell_without_thickness", sheet("thickness = 0.01\n", ""));
    assert_snapshot!("shell_of_no_thickness", sheet("thickness = 0.01", "thickness = 0.0"));
    assert_snapshot!("shell_of_no_elements", sheet("[3, 4]", "[3, 0]"));
    assert_snapshot!("shell_of_three_counts", sheet("[3, 4]", "[3, 4, 5]"));
    assert_snapshot!("shell_edges_that_differ", sheet("[3, 4]", "[3, 5]"));
    assert_snapshot!("shell_three_corners_two_counts", sheet("elements = 4", "elements = [4, 3]"));
    assert_snapshot!(
        "shell_three_corners_quadrilateral",
        sheet("elements = 4", "elements = 4\nkind = \"quadrilateral\"")
    );
    assert_snapshot!("shell_kind", sheet("[3, 4]", "[3, 4]\nkind = \"quad\""));
    assert_snapshot!("shell_layers_when_elastic", sheet("[3, 4]", "[3, 4]\nlayers = 5"));
    assert_snapshot!("shell_strain_when_elastic", sheet("[3, 4]", "[3, 4]\nstrain = \"logarithmic\""));
    let plastic = SHEET.replace("model = \"elastic\"", "model = \"elastic-plastic\"\nyield_stress = 2e8");
    assert_snapshot!("shell_of_an_odd_number_of_layers", said(&plastic.replace("[3, 4]", "[3, 4]\nlayers = 13"), &[]));
    assert_eq!(said(&plastic.replace("[3, 4]", "[3, 4]\nlayers = 24"), &[]), "");
    assert_snapshot!("shell_of_one_layer", said(&plastic.replace("[3, 4]", "[3, 4]\nlayers = 1"), &[]));
    assert_eq!(sheet("poisson_ratio = 0.3", "poisson_ratio = 0.5"), "");
    assert_snapshot!("shell_poisson_ratio", sheet("poisson_ratio = 0.3", "poisson_ratio = 0.51"));
    assert_snapshot!("shell_without_poisson_ratio", sheet("poisson_ratio = 0.3\n", ""));
    let dynamic = SHEET.replace("\"static\"", "\"dynamic\"");
    assert_snapshot!("shell_without_density", said(&dynamic, &[]));
    let on = |surface: &str| sheet("[3, 4]", &format!("[3, 4]\nsurface = {{ {surface} }}"));
    assert_snapshot!("shell_corner_on_the_axis", on(r#"kind = "cylinder", axis = [0.0, 0.0, 1.0]"#));
    assert_snapshot!("shell_cylinder_without_axis", on(r#"kind = "cylinder""#));
    let far = SHEET.replace("a = [0.0, 0.0, 0.0]", "a = [0.0, 0.0, 0.2]");
    let ball = "[3, 4]\nsurface = { kind = \"sphere\", center = [0.5, 0.5, -1.0] }";
    assert_eq!(sheet("[3, 4]", ball), "");
    assert_snapshot!("shell_off_the_sphere", said(&far.replacen("[3, 4]", ball, 1), &[]));
    assert_snapshot!("shell_zero_axis", sheet("[3, 4]", "[3, 4]\naxis = [0.0, 0.0, 0.0]"));
    assert_snapshot!(
        "shell_slivers",
        sheet("c = [1.0, 1.0, 0.0]\nd = [0.0, 1.0, 0.0]", "c = [1.0, 1e-4, 0.0]\nd = [0.0, 1e-4, 0.0]")
    );
    let thin = SHEET.replacen("thickness = 0.01", "thickness = 0.005", 1);
    assert_eq!(said(&thin.replacen("[3, 4]", ball, 1), &[]), "");
    let triangles = format!("{ball}\nkind = \"triangle\"");
    assert_snapshot!("shell_of_long_triangles", said(&thin.replacen("[3, 4]", &triangles, 1), &[]));
    let coarse = SHEET.replace("[3, 4]", "1").replace("elements = 4", "elements = 1");
    assert_snapshot!(
        "shell_flat_corner",
        said(&coarse.replace("c = [1.0, 1.0, 0.0]", "c = [0.5001, 0.5001, 0.0]"), &[])
    );
    let load = |load: &str| sheet("at = \"flap\"\npressure = 1e3", load);
    assert_snapshot!("pressure_on_an_edge", load("at = \"flap.edge2\"\npressure = 1e3"));
    assert_snapshot!("line_load_on_a_shell", load("at = \"flap\"\nforce_per_length = [1.0, 0.0, 0.0]"));
    assert_snapshot!(
        "line_load_that_follows",
        load("at = \"flap.edge2\"\nforce_per_length = [1.0, 0.0, 0.0]\nfollower = true")
    );
    let both =
        "at = \"flap\"\npart = \"flap\"\nlocal = [0.0, 0.0, 1.0]\nforce_per_length = [0.0, 0.0, 1.0]\nprojected = true";
    assert_snapshot!("line_load_said_twice", load(both));
    assert_snapshot!(
        "part_of_a_nodal_load",
        load("part = \"flap\"\nforce = [0.0, 0.0, 1.0]\nprofile = [[0.0, 1.0], [1.0, 1.0]]")
    );
    assert_snapshot!("local_load_on_an_edge", load("at = \"flap.edge2\"\nlocal = [0.0, 0.0, 1.0]"));
    let on_beam = |keys: &str| portal_and(&format!("[[loads]]\npart = \"portal\"\n{keys}\n"));
    assert_snapshot!("line_load_profile_falls", on_beam("local = [0.0, 0.0, 1.0]\nprofile = [[0.5, 1.0], [0.2, 1.0]]"));
    assert_snapshot!(
        "line_load_profile_outside",
        on_beam("force_per_length = [0.0, 0.0, 1.0]\nprofile = [[0.0, 1.0], [6.0, 1.0]]")
    );
    assert_snapshot!("pressure_on_a_beam", on_beam("pressure = 3.0"));
    assert_snapshot!("pressure_with_a_force", load("at = \"flap\"\npressure = 1e3\nforce = [1.0, 0.0, 0.0]"));
    let expect = |quantity: &str| {
        said(
            &format!(
                "{SHEET}[[expect]]\nat = \"flap\"\nquantity = \"{quantity}\"\npeak = \"max\"\nvalue = 1.0\ntolerance = 0.1\n"
            ),
            &[],
        )
    };
    assert_eq!(expect("von_mises"), "");
    assert_snapshot!("shell_quantity", expect("von_misses"));
    assert_snapshot!("shell_plastic_strain_when_elastic", expect("plastic_strain"));
}

/// A shallow truss by arc length.
const PATH: &str = r#"
[analysis]
kind = "static"
control = "arc-length"
end_time = 1.0
time_step = 0.1
stop = { at = "crown", quantity = "uz", value = -0.8 }

[points]
left = [-1.0, 0.0, 0.0]
right = [1.0, 0.0, 0.0]
crown = [0.0, 0.0, 0.5]

[[bars]]
name = "bars"
path = ["left", "crown", "right"]
axial_stiffness = 1000.0
mass_per_length = 0.0

[[supports]]
at = ["left", "right"]
fix = "translations"

[[loads]]
at = "crown"
force = [0.0, 0.0, -60.0]
"#;

#[test]
fn paths() {
    let path = |edits: &[(&str, &str)]| {
        let mut text = PATH.to_owned();
        for (old, new) in edits {
            assert_eq!(text.matches(old).count(), 1, "`{old}` must stand once in the deck");
            text = text.replace(old, new);
        }
        said(&text, &[])
    };
    assert_eq!(path(&[]), "");
    assert_snapshot!("path_in_time", path(&[("kind = \"static\"", "kind = \"dynamic\"")]));
    let time = ("control = \"arc-length\"", "steps = 3\ngrowth = 2.0");
    let expect = "[[expect]]\nat = \"analysis\"\nquantity = \"time\"\nwhen = { at = \"crown\", quantity = \"uz\", value = -0.3 }\n\
                  value = 0.6\ntolerance = 0.1\n[[loads]]";
    assert_snapshot!("words_of_paths_without_one", path(&[time, ("[[loads]]", expect)]));
    assert_snapshot!("misspelt_control", path(&[("arc-length", "arclength"), ("[[loads]]", expect)]));
    assert_snapshot!(
        "stop",
        path(&[("stop = { at = \"crown\", quantity = \"uz\"", "stop = { at = \"crwn\", quantity = \"rz\"")])
    );
    assert_snapshot!("stop_at_a_support", path(&[("at = \"crown\", quantity", "at = \"left\", quantity")]));
    assert_snapshot!("stop_at_the_start", path(&[("value = -0.8", "value = 0.0, pass = 0")]));
    assert_snapshot!("path_numbers", path(&[("time_step = 0.1", "time_step = 0.1\nsteps = 0\ngrowth = 0.5")]));
    let wrong = "[iteration]\nmethod = \"initial-load\"\nupdate = \"never\"\n[output]\ninterval = 0.1\n[points]";
    assert_snapshot!("path_iteration", path(&[("[points]", wrong)]));
    let jump = "force = [0.0, 0.0, -60.0]\namplitude = \"jump\"\n[amplitudes.jump]\nkind = \"step\"\nstart = 0.5\n";
    let viscous = "material = \"fast\"\narea = 1.0\n[materials.fast]\nmodel = \"elastic-viscoplastic\"\n\
                   youngs_modulus = 1e3\npoisson_ratio = 0.3\nyield_stress = 10.0\n\
                   viscosity = { law = \"linear\", rate = 1.0 }\n";
    let edits = [("force = [0.0, 0.0, -60.0]\n", jump), ("axial_stiffness = 1000.0\nmass_per_length = 0.0\n", viscous)];
    assert_snapshot!("path_across_a_jump", path(&edits));
    let turn =
        jump.replace("kind = \"step\"\nstart = 0.5", "kind = \"table\"\npoints = [[0.0, 0.0], [0.5, 1.0], [1.0, 0.5]]");
    assert_snapshot!("path_that_turns", path(&[("force = [0.0, 0.0, -60.0]\n", &turn)]));
    // A set of one point stands for it.
    let sets = "[sets]\none = [\"crown\"]\nfeet = [\"left\", \"right\"]\n[points]";
    let stop_at =
        |name: &str| path(&[("at = \"crown\", quantity", &format!("at = \"{name}\", quantity")), ("[points]", sets)]);
    assert_eq!(stop_at("one").lines().filter(|line| line.starts_with("error")).count(), 0);
    assert_snapshot!("stop_at_a_set", stop_at("feet"));
    let loose =
        [("at = \"crown\", quantity", "at = \"loose\", quantity"), ("[points]", "[points]\nloose = [0.0, 0.0, 2.0]")];
    assert_snapshot!("stop_where_nothing_acts", path(&loose));
    let moved = ("control = \"arc-length\"", "control = \"displacement\"");
    assert_eq!(path(&[moved, ("end_time = 1.0\n", ""), ("time_step = 0.1\n", "")]), "");
    let keys = ("control = \"arc-length\"", "control = \"displacement\"\nsteps = 3\ngrowth = 2.0\nincrement = 0.9");
    assert_snapshot!("moved_by_wrong_keys", path(&[keys, ("value = -0.8", "value = -0.8, pass = 2")]));
    let stop = PATH.lines().find(|line| line.starts_with("stop = ")).unwrap();
    assert_snapshot!("moved_without_stop", path(&[moved, (stop, "increment = -1.0")]));
    assert_snapshot!("increment_of_an_arc", path(&[("time_step = 0.1", "time_step = 0.1\nincrement = 0.01")]));
    let both = expect.replace("value = 0.6", "time = 0.5\nvalue = 0.6");
    assert_snapshot!("when_and_time", path(&[("[[loads]]", &both)]));
}

/// Each count is sensible, all together are not; said once, before they take memory. Which table is the first too many depends on the machine.
#[test]
fn elements_beyond_memory() {
    let roof = |k: usize| {
        format!(
            "[[shells]]\nname = \"roof{k}\"\ncorners = [\"foot_left\", \"knee_left\", \"knee_right\", \"foot_right\"]\n\
             elements = [1000, 1000]\nthickness = 0.01\nmaterial = \"steel\"\n"
        )
    };
    // 1e10 elements, 40 TB.
    let text = portal_and(&(0..10_000).map(roof).collect::<String>());
    assert_eq!(text.matches("more memory than there is").count(), 1, "{text}");
    assert!(text.contains("with this the deck has ") && text.contains("elements = [1000, 1000]"), "{text}");
}

/// Points of a set that are wrong in the same way are one message, those named one by one keep their places.
#[test]
fn many_points_with_one_mistake() {
    let names: Vec<String> = (0..9).map(|k| format!("p{k}")).collect();
    let points: String = names.iter().map(|name| format!("{name} = [5.0, 0.0, 0.0]\n")).collect();
    let deck = PORTAL.replace("[sets]", &format!("{points}[sets]\nlost = {names:?}\npair = [\"p0\", \"p1\"]"));
    let load = |at: &str| format!("{deck}[[loads]]\nat = {at}\nforce = [1.0, 0.0, 0.0]\n");
    assert_snapshot!("many_loose_points", said(&load("\"lost\""), &[]));
    assert_snapshot!("two_loose_points", said(&load("\"pair\""), &[]));
    assert_eq!(said(&load("[\"p0\", \"p1\", \"p2\"]"), &[]).matches("nothing is connected").count(), 3);
}

#[test]
fn contacts() {
    let contact = |surface: &str, more: &str| {
        portal_and(&format!("[[contacts]]\nname = \"touch\"\nsurface = {{ {surface} }}\n{more}"))
    };
    let plane = r#"shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0]"#;
    assert_eq!(contact(plane, "with = \"portal\"\nradius = 0.0\nstiffness = 1e5"), "");
    let numbers = "with = [\"portel\", \"bumper\"]\nstiffness = -1.0\nfriction = -0.1\nrestitution = 1.5\ndamping = 1.0\nradius = -1.0";
    assert_snapshot!("contact_numbers", contact(plane, numbers));
    let two = "with = \"portal\"\nstiffness = 1e5\nfriction = { static = 0.2, kinetic = 0.3, decay = 0.0 }";
    assert_snapshot!("contact_two_coefficients", contact(plane, two));
    let half = "with = \"portal\"\nstiffness = 1e5\nfriction = { static = -0.2 }";
    assert_snapshot!("contact_half_of_two_coefficients", contact(plane, half));
    let both = "with = \"portal\"\nstiffness = 1e5\nradius = 0.0\nfriction = { static = 0.3, kinetic = 0.2 }";
    assert_eq!(contact(plane, both), "");
    let statics = format!(
        "{}\n[[contacts]]\nname = \"touch\"\nsurface = {{ {plane} }}\n{both}",
        PORTAL.replace("\"dynamic\"", "\"static\"")
    );
    let told = said(&statics, &[]);
    assert!(told.contains("has two coefficients of friction, and a static analysis has no slip speed"), "{told}");
    assert!(told.contains("give one coefficient, 0.3 while nothing slips"), "{told}");
    let box_on = r#"shape = "box", body = "block", size = [1.0, 0.0, 1.0], radius = 1.0, normal = [1.0, 0.0, 0.0]"#;
    assert_snapshot!("contact_box", contact(box_on, "with = \"block\""));
    let axes = r#"shape = "box", size = [1.0, 1.0, 1.0], axes = [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]"#;
    assert_snapshot!("contact_axes", contact(axes, "with = []"));
    let line = r#"shape = "capsule", ends = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], radius = 0.0"#;
    assert_snapshot!("contact_capsule", contact(line, "with = \"portal\"\npoints = 1000"));
    let round = r#"shape = "cylinder", center = [9.0, 0.0, 0.0], axis = [0.0, 0.0, 0.0], length = -1.0"#;
    assert_snapshot!("contact_cylinder", contact(round, "with = \"knee_left\"\nstiffness = 1e6\npoints = 2"));
    let own = r#"shape = "sphere", body = "block", radius = 0.1"#;
    assert_snapshot!("contact_with_itself", contact(own, "with = [\"knee_left\", \"block\"]"));
    assert_snapshot!("contact_zone", contact(plane, "with = \"portal\"\nstiffness = 0.0\nfriction = 0.1"));
    let multipliers = "with = \"portal\"\nstiffness = 1e5\nmethod = \"augmented-lagrangian\"\npenetration_tolerance = 0.0\nrestitution = 0.5";
    assert_snapshot!("contact_multipliers_in_motion", contact(plane, multipliers));
    let loose = "with = \"portal\"\nmethod = \"augmented-lagrangian\"\npenetration_tolerance = 0.5";
    assert_snapshot!("contact_loose_multipliers", contact(plane, loose));
    let springs = "with = \"portal\"\nstiffness = 1e5\npenetration_tolerance = 1e-6\nmethod = \"penalty\"";
    assert_snapshot!("contact_springs", contact(plane, springs));
    assert_snapshot!("contact_method", contact(plane, "with = \"portal\"\nmethod = \"uzawa\""));
    let zone = "with = \"portal\"\nstiffness = 0.0\nmethod = \"augmented-lagrangian\"";
    assert_snapshot!("contact_multipliers_of_zone", contact(plane, zone));
    let own_faces = "[[contacts]]\nname = \"touch\"\nsurface = { part = \"portal\" }\nwith = \"block\"\nmethod = \"augmented-lagrangian\"\n";
    assert_snapshot!("contact_multipliers_of_faces", portal_and(own_faces));
    assert_snapshot!("contact_missing", portal_and("[[contacts]]\n[[contacts]]\nname = \"b\"\nsurface = {}"));
    let inside = r#"shape = "sphere", center = [0.0, 0.0, 2.0], radius = 0.1"#;
    assert_snapshot!("contact_closed", contact(inside, "with = \"portal\"\nstiffness = 1e5"));
    let bounds = "[[expect]]\nat = \"block\"\nquantity = \"ux\"\nat_least = 0.0\nat_most = 1.0\n\
                  [[expect]]\nat = \"block\"\nquantity = \"ux\"\nat_least = 0.0\nvalue = 1.0\ntolerance = 0.1";
    assert_snapshot!("expect_bounds", portal_and(bounds));
}

/// A sheet, a rod along its edge, and two bodies over it.
const FACES: &str = r#"
[analysis]
kind = "dynamic"
end_time = 1.0
time_step = 1e-6
[materials.steel]
model = "elastic"
youngs_modulus = 2e11
poisson_ratio = 0.3
density = 7800.0
[points]
s1 = [10.0, 0.0, 0.0]
s2 = [11.0, 0.0, 0.0]
s3 = [11.0, 1.0, 0.0]
s4 = [10.0, 1.0, 0.0]
[[bars]]
name = "rod"
path = ["s1", "s2"]
axial_stiffness = 1e6
mass_per_length = 1.0
[[shells]]
name = "sheet"
corners = ["s1", "s2", "s3", "s4"]
elements = 2
thickness = 0.01
material = "steel"
[[bodies]]
name = "brick"
center = [10.5, 0.5, 3.0]
mass = 1.0
shape = { kind = "box", size = [0.1, 0.1, 0.1] }
[[bodies]]
name = "marble"
center = [10.5, 0.5, 4.0]
mass = 1.0
shape = { kind = "sphere", radius = 0.1 }
"#;

/// Contacts of faces and of balls among themselves.
#[test]
fn contacts_of_faces() {
    let faces = |contact: &str| {
        let contact = format!("[[contacts]]\nname = \"touch\"\n{contact}");
        said(&format!("{FACES}\n{contact}\n"), &[])
    };
    assert_eq!(faces("surface = { part = \"sheet\" }\nwith = [\"brick\", \"marble\"]"), "");
    assert_eq!(faces("surface = { part = \"sheet\" }\nwith = \"itself\""), "");
    assert_snapshot!("faces_unknown", faces("surface = { part = \"sheat\" }\nwith = \"brick\""));
    assert_snapshot!("faces_of_a_body", faces("surface = { part = \"marble\" }\nwith = \"brick\""));
    assert_snapshot!("bar_without_radius", faces("surface = { part = \"rod\" }\nwith = \"brick\""));
    assert_snapshot!(
        "bar_that_rubs",
        faces("surface = { part = \"rod\", radius = 0.01, axis = [0.0, 0.0, 1.0] }\nwith = \"marble\"\nfriction = 0.3")
    );
    assert_snapshot!("bar_and_radius", faces("surface = { part = \"rod\", radius = -0.01 }\nwith = \"rod\""));
    assert_snapshot!(
        "lines_that_rub",
        faces("surface = { part = \"rod\", radius = 0.01 }\nwith = \"itself\"\nfriction = 0.3")
    );
    assert_eq!(faces("surface = { part = \"rod\", radius = 0.01 }\nwith = \"marble\""), "");
    assert_eq!(faces("surface = { part = \"rod\", radius = 0.01 }\nwith = \"itself\""), "");
    assert_snapshot!(
        "faces_and_shape",
        faces("surface = { part = \"sheet\", shape = \"plane\", body = \"brick\", radius = 0.1 }\nwith = \"brick\"")
    );
    assert_eq!(faces("surface = { part = \"sheet\", edges = true }\nwith = [\"brick\", \"marble\"]"), "");
    assert_eq!(faces("surface = { part = \"sheet\", edges = true, radius = 0.01 }\nwith = \"itself\""), "");
    assert_snapshot!(
        "edges_of_a_bar",
        faces("surface = { part = \"rod\", radius = 0.01, edges = true }\nwith = \"sheet\"")
    );
    assert_snapshot!(
        "edges_of_a_shape",
        faces("surface = { shape = \"sphere\", radius = 0.1, body = \"marble\", edges = true }\nwith = \"sheet\"")
    );
    assert_snapshot!(
        "edges_without_radius",
        faces("surface = { part = \"sheet\", edges = true, radius = 0.0 }\nwith = \"sheet\"")
    );
    assert_snapshot!("faces_of_their_own_part", faces("surface = { part = \"sheet\" }\nwith = \"sheet\""));
    assert_snapshot!(
        "faces_with_itself_and_more",
        faces("surface = { part = \"sheet\" }\nwith = [\"itself\", \"brick\"]")
    );
    assert_snapshot!(
        "itself_of_a_body",
        faces("surface = { shape = \"sphere\", radius = 0.1, body = \"marble\" }\nwith = \"itself\"")
    );
    assert_eq!(faces("among = [\"marble\", \"brick\"]\nstiffness = 1e5"), "");
    assert_snapshot!("among_points_without_radius", faces("among = [\"marble\", \"s1\"]"));
    assert_snapshot!("among_parts", faces("among = [\"marble\", \"sheet\"]"));
    assert_snapshot!("among_one", faces("among = \"marble\""));
    let cube = "[[bodies]]\nname = \"roll\"\ncenter = [10.5, 0.5, 6.0]\nmass = 1.0\n\
                shape = { kind = \"cylinder\", radius = 0.1, length = 0.2, axis = [0.0, 0.0, 1.0] }\n\
                [[bodies]]\nname = \"lump\"\ncenter = [10.5, 0.5, 8.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n";
    let bodies = |contact: &str| said(&format!("{FACES}{cube}[[contacts]]\nname = \"touch\"\n{contact}\n"), &[]);
    assert_snapshot!(
        "points_of_solids",
        bodies("surface = { body = \"brick\" }\nwith = [\"marble\", \"roll\"]\npoints = 3\nstiffness = 1e5")
    );
    assert_eq!(bodies("among = [\"brick\", \"roll\"]\nstiffness = 1e5"), "");
    assert_eq!(bodies("surface = { body = \"roll\" }\nwith = \"brick\"\nstiffness = 1e5"), "");
    assert_snapshot!("among_bodies_without_shape", bodies("among = [\"brick\", \"lump\"]"));
    assert_snapshot!("surface_of_no_shape", bodies("surface = { body = \"lump\", radius = 0.1 }\nwith = \"brick\""));
    let hull = |points: &str, more: &str| {
        let body =
            format!("[[bodies]]\nname = \"stone\"\nmass = 1.0\nshape = {{ kind = \"hull\", points = [{points}] }}\n");
        said(&format!("{FACES}{body}{more}\n"), &[])
    };
    let corners = "[20.0, 0.0, 0.0], [21.0, 0.0, 0.0], [20.0, 1.0, 0.0], [20.0, 0.0, 1.0]";
    assert_snapshot!("hull_of_three", hull("[20.0, 0.0, 0.0], [21.0, 0.0, 0.0], [20.0, 1.0, 0.0]", ""));
    assert_snapshot!(
        "hull_that_is_flat",
        hull("[20.0, 0.0, 0.0], [21.0, 0.0, 0.0], [20.0, 1.0, 0.0], [21.0, 1.0, 0.0]", "")
    );
    let ring: Vec<String> = (0..40)
        .map(|k| (0.157 * f64::from(k)).sin_cos())
        .flat_map(|(s, c)| [format!("[{s:.3}, {c:.3}, 20.0]"), format!("[{s:.3}, {c:.3}, 21.0]")])
        .collect();
    assert_snapshot!("hull_of_many_corners", hull(&ring.join(", "), ""));
    let fine = [&ring[..], &ring[..]].concat();
    assert_snapshot!("hull_of_many_points", hull(&fine.join(", "), ""));
    let touch = "[[contacts]]\nname = \"touch\"\namong = [\"stone\", \"brick\"]\nstiffness = 1e5\n";
    assert_eq!(hull(corners, touch), "");
    assert_snapshot!("hull_with_radius", hull(corners, &format!("{touch}radius = 0.1")));
    let capsule = |keys: &str| {
        let body = format!("[[bodies]]\nname = \"log\"\nmass = 1.0\nshape = {{ kind = \"capsule\", {keys} }}\n");
        said(&format!("{FACES}{body}"), &[])
    };
    assert_eq!(capsule("ends = [[20.0, 0.0, 0.0], [21.0, 0.0, 0.0]], radius = 0.1"), "");
    assert_snapshot!("capsule_of_one_place", capsule("ends = [[20.0, 0.0, 0.0], [20.0, 1e-200, 0.0]], radius = 0.1"));
    assert_snapshot!("capsule_of_one_end", capsule("ends = [[20.0, 0.0, 0.0]], radius = 0.1"));
    assert_snapshot!("capsule_without_radius", capsule("ends = [[20.0, 0.0, 0.0], [21.0, 0.0, 0.0]], length = 1.0"));
    assert_snapshot!("among_and_with", faces("among = [\"marble\", \"brick\"]\nradius = 0.1\nwith = \"sheet\""));
}

#[test]
fn linear_statics() {
    let asked = |keys: &str, more: &str| {
        let kind = ("kind = \"dynamic\"\nend_time = 0.3\ntime_step = 1e-4", keys);
        said(&format!("{}\n{more}", edited(&[kind])), &[])
    };
    let linear = "kind = \"static\"\ngeometry = \"linear\"";
    assert_snapshot!("linear_contacts_and_gaps", asked(linear, ""));
    assert_snapshot!("linear_dynamics", portal(&[("end_time = 0.3", "geometry = \"linear\"\nend_time = 0.3")]));
    assert_snapshot!("linear_steps", asked(&format!("{linear}\ntime_step = 2.0\nerror_tolerance = 1e-3"), ""));
    let cases = "[[load_cases]]\nname = \"a\"\nloads = [\"gravty\", \"gravity\"]\nfactors = [1.0]\n\
                 [[combinations]]\nname = \"a\"\ncases = [\"b\"]\n[[envelopes]]\nname = \"e\"\ncases = \"c\"\n\
                 [[expect]]\nat = \"knee_right\"\nquantity = \"ux\"\ncase = \"d\"\nvalue = 1.0\ntolerance = 0.1\n";
    assert_snapshot!("linear_cases", asked(linear, cases));
    assert_snapshot!("linear_cases_in_dynamics", portal_and("[[load_cases]]\nname = \"a\"\nloads = \"gravity\"\n"));
}

#[test]
fn accuracy() {
    let asked = |keys: &str| portal(&[("end_time = 0.3\ntime_step = 1e-4", keys)]);
    assert_snapshot!("accuracy_and_time_step", asked("end_time = 0.3\ntime_step = 1e-4\naccuracy = 1e-3"));
    assert_snapshot!("accuracy_above_1", asked("end_time = 0.3\naccuracy = 2.0"));
    assert_snapshot!("accuracy_below_tolerance", asked("end_time = 0.3\naccuracy = 1e-3\nerror_tolerance = 1e-2"));
    let central = "end_time = 0.3\naccuracy = 1e-3\n[integrator]\nscheme = \"central-difference\"";
    assert_snapshot!("accuracy_and_stable_steps", asked(central));
    let kind = |keys: &str| portal(&[("kind = \"dynamic\"\nend_time = 0.3\ntime_step = 1e-4", keys)]);
    assert_snapshot!("accuracy_of_modes", kind("kind = \"modal\"\naccuracy = 1e-3"));
    let path = "kind = \"static\"\ncontrol = \"arc-length\"\nend_time = 1.0\ntime_step = 0.1\naccuracy = 1e-3";
    assert_snapshot!("accuracy_of_a_path", kind(path));
}

#[test]
fn modes() {
    let asked = |keys: &str| portal(&[("kind = \"dynamic\"\nend_time = 0.3\ntime_step = 1e-4", keys)]);
    assert_snapshot!("modes_and_up_to", asked("kind = \"modal\"\nmodes = 3\nup_to = 50.0"));
    assert_snapshot!("modes_numbers", asked("kind = \"modal\"\nup_to = -1.0\nend_time = 2.0"));
    assert_snapshot!("modes_none", asked("kind = \"modal\"\nmodes = 0\ncontrol = \"arc-length\""));
    assert_snapshot!("modes_too_many", asked("kind = \"modal\"\nmodes = 100000"));
    assert_snapshot!("modes_of_buckling", asked("kind = \"buckling\"\nup_to = 5.0\ndamped = true"));
    let speeds = "speeds = { from = 5.0, to = 2.0, steps = 1 }\n[[expect]]\ncritical_speed = 0\nquantity = \"speed\"\nvalue = 1.0\n\
                  tolerance = 0.1\n[[expect]]\ncritical_speed = 1\nat = \"block\"\nquantity = \"sped\"\nvalue = 1.0\ntolerance = 0.1\n";
    assert_snapshot!("speeds_numbers", asked(&format!("kind = \"modal\"\n{speeds}")));
    let sound = speeds.replace("from = 5.0, to = 2.0, steps = 1", "to = 2.0");
    assert_snapshot!("critical_speeds_expected", asked(&format!("kind = \"modal\"\ndamped = true\n{sound}")));
    assert_snapshot!("speeds_of_motion", portal(&[("end_time = 0.3", "end_time = 0.3\nspeeds = { to = 2.0 }")]));
    assert_snapshot!("modes_of_motion", portal(&[("end_time = 0.3", "end_time = 0.3\nmodes = 3\ndamped = true")]));
    let expect = |of: &str| format!("kind = \"modal\"\nmodes = 3\n[[expect]]\n{of}\nvalue = 1.0\ntolerance = 0.1\n");
    assert_snapshot!(
        "modes_expected",
        asked(
            &(expect("mode = 4\nquantity = \"frequency\"")
                + &expect("mode = 0\nquantity = \"frequncy\"\ntime = 1.0")
                    .replace("kind = \"modal\"\nmodes = 3\n", ""))
        )
    );
    let expect = "[[expect]]\nmode = 1\nquantity = \"frequency\"\nvalue = 1.0\ntolerance = 0.1\n[materials.steel]";
    assert_snapshot!("modes_expected_of_motion", portal(&[("[materials.steel]", expect)]));
}

#[test]
fn profiles() {
    let of = |keys: &str| portal(&[("shape = \"rectangle\"\nwidth = 0.05\nheight = 0.05\n", &format!("{keys}\n"))]);
    assert_eq!(of("profile = \"SHS 50x4\"\nunit = \"m\""), "");
    for (name, keys) in [
        ("without_units", "profile = \"IPE 200\""),
        ("unknown", "profile = \"IPE 210\"\nunit = \"m\""),
        ("other_family", "profile = \"S12x35\"\nunit = \"m\""),
        ("with_a_shape", "shape = \"i\"\nprofile = \"IPE 200\"\nunit = \"m\""),
        ("of_a_number", "profile = 200"),
    ] {
        assert_snapshot!(format!("profile_{name}"), of(keys));
    }
}

#[test]
fn releases_and_shares() {
    let of = |keys: &str| portal(&[("elements = 12", &format!("elements = 12\n{keys}"))]);
    assert_snapshot!("release_of_translations", of("release = { start = [\"ux\", \"ry\"], ends = \"ry\" }"));
    assert_snapshot!("foundation_that_pushes", of("foundation = [0.0, 0.0, -1e7]"));
    assert_snapshot!("foundation_of_a_rigid_beam", of("rigid = true\nfoundation = [0.0, 0.0, 1e7]"));
    let actuator = |keys: &str| {
        let ends = "from = { node = \"knee_left\" }\nto = { body = \"block\" }";
        portal_and(&format!("[[actuators]]\nname = \"ram\"\n{ends}\n{keys}\n"))
    };
    assert_eq!(actuator("motion = { velocity = 0.1 }"), "");
    assert_snapshot!("actuator_without_action", actuator(""));
    assert_snapshot!("actuator_with_a_kind", actuator("kind = \"revolute\"\nmotion = { velocity = 0.1 }"));
    assert_snapshot!("actuator_with_an_axis", actuator("axis = [1.0, 0.0, 0.0]\nmotion = { velocty = 0.1 }"));
    assert_snapshot!("hinges_of_others", of("hinges = \"start\"\nreleases = [\"ry\"]"));
    let both = "force = [0.0, 0.0, -100.0]\ntotal_force = [0.0, 0.0, -100.0]";
    assert_snapshot!("force_and_share", portal(&[("force = [0.0, 0.0, -100.0]", both)]));
}

#[test]
fn loads_of_temperature() {
    let expands = ("density = 7850.0", "density = 7850.0\nexpansion = 1.2e-5");
    let load = |keys: &str| portal(&[expands, ("[[loads]]", &format!("[[loads]]\n{keys}\n[[loads]]"))]);
    assert_eq!(load("part = \"portal\"\ntemperature = 40.0\ntemperature_gradient = [1.0, 2.0]"), "");
    assert_snapshot!("heat_without_expansion", portal_and("[[loads]]\npart = \"portal\"\ntemperature = 40.0"));
    assert_snapshot!(
        "heat_of_a_body",
        load("part = [\"block\", \"feet\"]\ntemperature = 40.0\nforce = [1.0, 0.0, 0.0]")
    );
    assert_snapshot!("gradient_of_a_beam", load("part = \"portal\"\ntemperature_gradient = 40.0"));
    let twice = "part = \"portal\"\ntemperature = 1.0\n[[loads]]\npart = \"portal\"\ntemperature = 2.0";
    assert_snapshot!("heated_twice", load(twice));
    let buckling = ("kind = \"dynamic\"\nend_time = 0.3\ntime_step = 1e-4", "kind = \"buckling\"");
    let heat = (
        "[[loads]]",
        "[[loads]]\npart = \"portal\"\ntemperature = 1.0\namplitude = \"ramp\"\n[amplitudes.ramp]\nkind = \"constant\"\n[[loads]]",
    );
    assert_snapshot!("heat_that_buckles", portal(&[expands, buckling, heat]));
}

#[test]
fn centrifugal_loads() {
    let dynamic = "kind = \"dynamic\"\nend_time = 0.3\ntime_step = 1e-4";
    let turning = |kind: &str, keys: &str, rotation: &str| {
        let load = format!("[[loads]]\n{keys}\ncentrifugal = {rotation}\n[[loads]]");
        portal(&[(dynamic, kind), ("[[loads]]", &load)])
    };
    let (statics, sound) =
        ("kind = \"static\"\nend_time = 0.3\ntime_step = 0.1", "{ speed = 10.0, axis = [0.0, 0.0, 1.0] }");
    let says = turning(statics, "part = [\"portal\", \"block\"]", sound);
    assert!(!says.contains("error"), "{says}");
    assert_snapshot!("centrifugal_in_dynamics", turning(dynamic, "", sound));
    assert_snapshot!("centrifugal_without_keys", turning(statics, "at = \"feet\"", "{ axis = [0.0, 0.0, 0.0] }"));
    assert_snapshot!("centrifugal_on_nothing", turning(statics, "part = [\"bumper\", \"knee_left\"]", sound));
    assert_snapshot!("centrifugal_without_mass", turning(statics, "part = \"knee_left\"", sound));
    let speeds = "kind = \"modal\"\ndamped = true\nspeeds = { from = 0.0, to = 1.0 }";
    assert_snapshot!("centrifugal_beside_speeds", turning(speeds, "", sound));
    let guess = |key: &str| portal(&[("[[loads]]", &format!("[[loads]]\n{key} = 10.0\n[[loads]]"))]);
    assert_snapshot!("centrifugal_by_other_words", ["rpm", "kind"].map(guess).join("\n"));
}

#[test]
fn loads_on_beams() {
    let load = |keys: &str| portal_and(&format!("[[loads]]\npart = \"portal\"\n{keys}\n"));
    assert_eq!(load("distance = 1.0\nforce = [0.0, 0.0, -1.0]"), "");
    assert_snapshot!("load_beyond_a_beam", load("distance = 99.0\nforce = [0.0, 0.0, -1.0]\nfollower = true"));
    assert_snapshot!("load_on_a_beam_of_nothing", load("distance = 1.0"));
    let block = "[[loads]]\npart = \"block\"\ndistance = 1.0\nforce = [0.0, 0.0, -1.0]\nat = \"feet\"";
    assert_snapshot!("load_along_a_body", portal_and(block));
    let low = [
        ("elements = 12", "elements = 12\norder = 2"),
        ("[[loads]]", "[[loads]]\npart = \"portal\"\ndistance = 1.0\nforce = [0.0, 0.0, -1.0]\n[[loads]]"),
    ];
    assert_snapshot!("load_on_a_beam_of_low_order", portal(&low));
}

#[test]
fn comments_and_signs_of_others() {
    assert_snapshot!("comment_of_c", portal(&[("height = 0.05", "height = 0.05 // half")]));
    assert_snapshot!("minus_of_mathematics", portal(&[("[0.0, 0.0, -100.0]", "[0.0, 0.0, \u{2212}100.0]")]));
    assert_snapshot!("step_in_quotes", portal(&[("time_step = 1e-4", "time_step = \"1e-4\"")]));
    assert_snapshot!("number_of_steps", portal(&[("time_step = 1e-4", "steps = 300")]));
    let support = |key: &str| portal(&[("at = \"feet\"\nfix = \"all\"", &format!("at = \"feet\"\n{key}"))]);
    assert_snapshot!("skew_support", support("fix = \"all\"\nskew = 30.0"));
    assert_snapshot!("pinned_support", support("pinned = true"));
    assert_snapshot!("steps_and_equations_of_others", portal_and("[[steps]]\nname = \"a\"\n[[mpc]]\nname = \"b\"\n"));
    let section = |text: &str| portal_and(&format!("[sections.more]\n{text}\n"));
    assert_snapshot!("profile_of_no_table", section("profile = \"W14x91\"\nunit = \"m\""));
    let channel = "shape = \"c\"\nheight = 0.2\nwidth = 0.075\nweb_thickness = 0.0085\nflange_thickness = 0.0115";
    let square = "shape = \"rectangle\"\nwidth = 0.05\nheight = 0.05";
    let said = portal(&[(square, &format!("{channel}\nflange_slope = 0.08"))]);
    assert!(said.contains("applies to rolled channels alone") && said.contains("`root_radius`"), "{said}");
}

#[test]
fn drifts() {
    let drift =
        |name: &str, from: &str, to: &str| format!("[[drifts]]\nname = \"{name}\"\nfrom = \"{from}\"\nto = \"{to}\"\n");
    assert_eq!(portal_and(&drift("storey", "foot_left", "block")), "");
    let wrong = drift("knee_left", "foot_left", "knee_left")
        + &drift("one", "portal", "knee_lft")
        + &drift("two", "feet", "foot_left")
        + &drift("three", "foot_left", "foot_left")
        + "[[drifts]]\nname = \"four\"\n[[expect]]\nat = \"four\"\nquantity = \"rato\"\ntime = 0.1\nvalue = 1.0\ntolerance = 0.1\n";
    assert_snapshot!("drifts_wrong", portal_and(&wrong));
}

#[test]
fn stages() {
    let analysis = "[analysis]\nkind = \"dynamic\"\nend_time = 0.3\ntime_step = 1e-4\n";
    let stage = |name: &str, kind: &str, more: &str| {
        format!("[[stages]]\nname = \"{name}\"\nkind = \"{kind}\"\nduration = 1.0\ntime_step = 0.1\n{more}\n")
    };
    let with = |stages: &str, more: &str| {
        said(&edited(&[(analysis, stages)]).replace("[sets]", &format!("{more}\n[sets]")), &[])
    };
    let two = stage("weight", "static", "") + &stage("impact", "dynamic", "");
    assert_eq!(with(&two, ""), "");
    let kinds =
        stage("a", "modal", "") + &stage("a", "dynamic", "") + "[[stages]]\nkind = \"static\"\nduration = 0.0\n";
    assert_snapshot!("stages_wrong", with(&kinds, ""));
    let modes =
        |name: &str, kind: &str, more: &str| format!("[[stages]]\nname = \"{name}\"\nkind = \"{kind}\"\n{more}\n");
    assert_snapshot!("stages_of_modes_alone", with(&modes("a", "modal", ""), ""));
    let of_modes = two.clone()
        + &modes("low", "modal", "modes = 2\nup_to = 3.0\nduration = 1.0\ntime_step = 0.1")
        + &modes("more", "buckling", "damped = true")
        + &modes("all", "buckling", "");
    let of_stages = "[[loads]]\nat = \"knee_left\"\nforce = [1.0, 0.0, 0.0]\nstages = \"low\"\n\
                     [[loads]]\nat = \"knee_left\"\nforce = [1.0, 0.0, 0.0]\nstages = \"more\"\namplitude = \"up\"\n\
                     [amplitudes.up]\nkind = \"ramp\"\nend = 1.0\n\
                     [[expect]]\nmode = 1\nquantity = \"frequency\"\nvalue = 1.0\ntolerance = 0.1\n\
                     [[expect]]\nmode = 1\nquantity = \"frequency\"\nstage = \"weight\"\nvalue = 1.0\ntolerance = 0.1\n";
    assert_snapshot!("stages_of_modes", with(&of_modes, of_stages));
    let not_there =
        two.replace("kind = \"dynamic\"", "kind = \"dynamic\"\nstop = { time = 5.0 }") + &modes("low", "modal", "");
    let expected = "[[supports]]\nat = \"knee_left\"\nmotion = { uy = { scale = 1e-3 } }\nstages = \"low\"\n\
                    [[expect]]\nat = \"knee_left\"\nquantity = \"ux\"\nstage = \"low\"\nvalue = 1.0\ntolerance = 0.1\n\
                    [[expect]]\nat = \"pad\"\nquantity = \"force\"\nstage = \"impact\"\nvalue = 1.0\ntolerance = 0.1\n\
                    [[links]]\nname = \"pad\"\nfrom = { node = \"knee_left\" }\nto = { ground = [0.0, 0.0, 0.0] }\nstiffness = 1.0\nstages = \"weight\"\n";
    assert_snapshot!("stages_not_there", with(&not_there, expected));
    let integrator = "integrator = { scheme = \"newmark\" }";
    let dynamic_keys = stage("weight", "static", integrator).replace("time_step = 0.1", "time_step = \"auto\"");
    assert_snapshot!("stages_dynamic_keys", with(&dynamic_keys, ""));
    assert_snapshot!("stages_and_analysis", with(&format!("{analysis}{two}"), ""));
    let named = "[[loads]]\nat = \"knee_left\"\nforce = [1.0, 0.0, 0.0]\nstages = [\"wieght\", \"impact\"]\n\
                 [[supports]]\nat = \"knee_left\"\nfix = [\"uy\"]\nstages = []\n\
                 [[initial]]\nat = \"knee_left\"\nvelocity = [1.0, 0.0, 0.0]\nstages = \"weight\"\n\
                 [[expect]]\nat = \"knee_left\"\nquantity = \"ux\"\nstage = \"impact\"\ntime = 1.0\nvalue = 1.0\ntolerance = 0.1\n";
    assert_snapshot!("stages_unknown", with(&two, named));
    assert_snapshot!(
        "stages_none",
        portal_and("[[loads]]\nat = \"knee_left\"\nforce = [1.0, 0.0, 0.0]\nstages = \"weight\"")
    );
    let stops = [
        "stop = { at = \"knee_left\", quantity = \"ux\", value = 0.1, work = 1.0 }",
        "stop = { load = \"ram\", work = 1.0 }",
        "stop = { load = \"push\" }",
        "stop = { load = \"push\", force = 0.0 }",
        "stop = {}",
        "stop = { time = 1.5 }",
    ];
    let stopping: String = stops.iter().enumerate().map(|(k, stop)| stage(&format!("s{k}"), "static", stop)).collect();
    let push = "[[loads]]\nname = \"push\"\nat = \"knee_left\"\nforce = [1.0, 0.0, 0.0]";
    assert_snapshot!("stages_stops", with(&stopping, push));
    let paths = stage("gravity", "static", "")
        + &stage(
            "push",
            "static",
            "control = \"displacement\"\nstop = { load = \"push\", force = 3.0 }\nincrement = 1e-3",
        )
        + &stage(
            "arc",
            "static",
            "control = \"arc-length\"\nstop = { at = \"knee_left\", quantity = \"rx\", value = 0.1 }",
        )
        + &stage("blow", "dynamic", "control = \"arc-length\"");
    let steady = ("amplitude = \"pulse\"\n", "");
    assert_snapshot!(
        "stages_of_paths",
        said(&edited(&[(analysis, &paths), steady]).replace("[sets]", &format!("{push}\n[sets]")), &[])
    );
    // What is wrong in one stage only is said with its name.
    let hinge = "[[joints]]\nname = \"hinge\"\nkind = \"spherical\"\nfrom = { node = \"knee_right\" }\nto = { body = \"block\", }\nstages = \"impact\"\naxis = [1.0, 0.0, 0.0]";
    assert_snapshot!("stages_in_one", with(&two, hinge));
}

#[test]
fn responses() {
    let asked = |keys: &str| {
        portal(&[(
            "kind = \"dynamic\"\nend_time = 0.3\ntime_step = 1e-4",
            &format!("kind = \"frequency-response\"\n{keys}"),
        )])
    };
    assert_snapshot!("response_of_nothing", asked("damped = true\nmodes = 3\ndamping_ratio = -0.1"));
    assert_snapshot!("response_range", asked("frequencies = { from = 5.0, to = 1.0, steps = 0 }\nend_time = 2.0"));
    assert_snapshot!(
        "response_logarithmic",
        asked("frequencies = { from = 0.0, to = 1.0, steps = 5, spacing = \"logarithmic\" }")
    );
    assert_snapshot!("response_list", asked("frequencies = [1.0, -2.0]\nmethod = \"harmonic\""));
    assert_snapshot!("response_word", asked("frequencies = \"all\"\nmethod = \"modal\"\nmodes = 3\nup_to = 5.0"));
    let harmonic = "[amplitudes.shake]\nkind = \"harmonic\"\nphase = 1.0\nphase_degrees = 30.0\nfrequency = 2.0\n\
                    [[loads]]\nat = \"knee_left\"\nforce = [1.0, 0.0, 0.0]\namplitude = \"shake\"\n";
    assert_snapshot!("response_over_time", portal_and(harmonic));
    assert_snapshot!(
        "response_keys_of_motion",
        portal(&[("end_time = 0.3", "end_time = 0.3\nfrequencies = 3.0\nmethod = \"modal\"")])
    );
    let expect = "[[expect]]\nat = \"portal\"\nquantity = \"ux\"\nfrequency = 1.0\npeak = \"max\"\nvalue = 1.0\ntolerance = 0.1\n\
                  [[expect]]\nat = \"knee_left\"\nquantity = \"vx\"\nfrequency = 1.0\nvalue = 1.0\ntolerance = 0.1\n\
                  [[expect]]\nmode = 1\nquantity = \"frequency\"\nvalue = 1.0\ntolerance = 0.1\n";
    assert_snapshot!("response_expected", asked(&("frequencies = 1.0\n".to_owned() + expect)));
    assert_snapshot!("response_expected_of_motion", portal_and(&expect.replace("mode = 1", "mode = 0")));
}

/// Patches of shells whose elements are of no order, or of two along an edge.
#[test]
fn orders_of_shells() {
    let patches = |order: &str| {
        format!(
            "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[materials.steel]\nmodel = \"elastic\"\n\
             youngs_modulus = 210e9\npoisson_ratio = 0.3\n[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nc = [1.0, 1.0, 0.0]\n\
             d = [0.0, 1.0, 0.0]\ne = [2.0, 0.0, 0.0]\nf = [2.0, 1.0, 0.0]\n[[shells]]\nname = \"left\"\n\
             corners = [\"a\", \"b\", \"c\", \"d\"]\nelements = 2\nthickness = 0.01\nmaterial = \"steel\"\n{order}\n[[shells]]\n\
             name = \"right\"\ncorners = [\"b\", \"e\", \"f\", \"c\"]\nelements = 4\nthickness = 0.01\nmaterial = \"steel\"\n\
             [[supports]]\nat = \"left.edge4\"\nfix = \"all\"\n[[loads]]\nat = \"f\"\nforce = [0.0, 0.0, 1.0]\n"
        )
    };
    assert_snapshot!("shell_order", said(&patches("order = 3"), &[]));
    assert_snapshot!("shell_orders_apart", said(&patches("order = 2"), &[]));
}

#[test]
fn supports_along_axes() {
    let support = |text: &str| {
        portal_and(&format!(
            "[amplitudes.a]\nkind = \"ramp\"\nstart = -1.0\nend = 1.0\n[[supports]]\nat = \"knee_right\"\n{text}"
        ))
    };
    assert_snapshot!(
        "axes_are_wrong",
        support("axes = [[1.0, 0.0, 1.0], [2.0, 0.0, 2.0]]\nfix = \"ux\"\nrotation = \"xyz\"\n")
    );
    let slanted = "axes = [[1.0, 0.0, 1.0], [0.0, 1.0, 0.0]]\n";
    assert_snapshot!(
        "axes_turn_no_motion",
        support(&format!("{slanted}motion = {{ rx = {{ amplitude = \"a\" }} }}\n"))
    );
    let moved = "motion = { ux = { amplitude = \"a\", scale = 0.01 } }\n";
    assert_snapshot!("axes_begin_displaced", support(&format!("{slanted}{moved}")));
    let twice = format!("{slanted}fix = \"ux\"\n[[supports]]\nat = \"knee_right\"\n{slanted}{moved}")
        .replace("amplitude = \"a\"", "amplitude = \"pulse\"");
    assert_snapshot!("axes_given_twice", support(&twice));
}

#[test]
fn equations() {
    let term =
        |node: &str, dof: &str, factor: &str| format!("{{ node = \"{node}\", dof = \"{dof}\", factor = {factor} }}");
    let equation =
        |name: &str, terms: &[String]| format!("[[equations]]\nname = \"{name}\"\nterms = [{}]\n", terms.join(", "));
    let text = [
        equation("one", &[term("knee_left", "ux", "1.0")]),
        equation("twice", &[term("knee_left", "ux", "1.0"), term("knee_left", "ux", "2.0")]),
        equation("nothing", &[term("knee_left", "ux", "0.0"), term("portal", "ux", "2.0")]),
        equation("nowhere", &[term("kne_left", "ux", "1.0"), term("knee_left", "u", "2.0")]),
    ];
    assert_snapshot!("equations", portal_and(&text.concat()));
}

#[test]
fn shells_beside_their_nodes() {
    let shell = |more: &str| {
        let corners = "corners = [\"foot_left\", \"knee_left\", \"knee_right\", \"foot_right\"]";
        portal_and(&format!(
            "[[shells]]\nname = \"wall\"\n{corners}\nelements = 2\nmaterial = \"steel\"\nthickness = 0.01\n{more}"
        ))
    };
    assert_snapshot!("offset_of_a_rigid_shell", shell("rigid = true\noffset = 0.02\n"));
    assert_snapshot!("nodal_thickness", shell("nodal_thickness = { \"wall.edge1\" = 0.0, block = 0.1, wal = 0.1 }\n"));
}

/// Lines of comments of another language are one error, and hide nothing below them.
#[test]
fn comments_of_other_languages_hide_nothing() {
    let found = said(
        &format!("// the portal\n{}", PORTAL.replace("[sections.square]", "  // a section\n[sections.square]")),
        &[],
    );
    assert!(
        found.contains("`//` begins no comment in TOML") && found.contains("the same goes for 1 more lines"),
        "{found}"
    );
    assert_eq!(found.matches("error").count(), 1, "{found}");
    // Within a text of several lines they may be meant.
    let text = PORTAL.replace("title = \"Portal frame hit by a block\"", "title = \"\"\"\n// a title\n\"\"\"");
    assert_eq!(said(&text, &[]), "");
}

/// Groups of directions stand in lists beside single ones.
#[test]
fn lists_of_directions_take_groups() {
    assert_eq!(portal(&[("fix = \"all\"", "fix = [\"translations\", \"rx\", \"ry\", \"rz\"]")]), "");
    let found = portal(&[("fix = \"all\"", "fix = [\"translation\"]")]);
    assert!(found.contains("did you mean `translations`?"), "{found}");
}

/// An unbalance needs a spin, and a response that follows it; the plan tells which.
#[test]
fn unbalances() {
    let scene = |keys: &str, spin: &str, load: &str| {
        let kind = ("kind = \"dynamic\"\nend_time = 0.3\ntime_step = 1e-4", keys);
        let load = format!("[[loads]]\n{load}\n[[loads]]");
        portal(&[kind, ("velocity = [4.0, 0.0, 0.0]", spin), ("[[loads]]", &load)])
    };
    let (response, spin) = ("kind = \"frequency-response\"\nfrequencies = [1.0]", "angular_velocity = [5.0, 0.0, 0.0]");
    let load = "at = \"block\"\nunbalance = [0.0, 0.1, 0.0]";
    let says = scene(response, spin, load);
    assert!(!says.contains("error"), "{says}");
    assert_snapshot!("unbalance_in_time", scene("kind = \"dynamic\"\nend_time = 0.3\ntime_step = 1e-4", spin, load));
    assert_snapshot!(
        "unbalance_without_spin",
        scene(response, "", "at = [\"block\", \"knee_left\"]\nunbalance = [0.0, 0.1, 0.0]")
    );
    assert_snapshot!(
        "unbalance_along_the_axis",
        scene(response, spin, "at = \"block\"\nunbalance = [0.1, 0.1, 0.0]\nforce = [1.0, 0.0, 0.0]")
    );
    let by_modes = "kind = \"frequency-response\"\nfrequencies = { from = 1.0, to = 2.0, steps = 3, around_resonances = 2 }\nmethod = \"modal\"";
    assert_snapshot!("unbalance_by_modes", scene(by_modes, spin, load));
    let turning = format!("{load}\n[[loads]]\ncentrifugal = {{ speed = 5.0, axis = [1.0, 0.0, 0.0] }}");
    assert_snapshot!("unbalance_and_centrifugal", scene(response, spin, &turning));
    let twice = format!(
        "{load}\n[[loads]]\nat = \"foot\"\nunbalance = [0.0, 0.1, 0.0]\n[[bodies]]\nname = \"foot\"\ncenter = [0.0, 5.0, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\nangular_velocity = [9.0, 0.0, 0.0]"
    );
    assert_snapshot!("unbalance_at_two_speeds", scene(response, spin, &twice));
}
