//! Sections of concrete with bars: what the model makes of them, and what it says about wrong ones.

use rdsolve::diagnostic::Source;
use rdsolve::model::{self, Model};

const COLUMN: &str = r#"
analysis = { kind = "static", end_time = 1.0, time_step = 0.1 }
points = { foot = [0.0, 0.0, 0.0], top = [0.0, 0.0, 3.0] }
supports = [{ at = "foot", fix = "all" }]

[materials.plain]
model = "concrete"
youngs_modulus = 30e9
poisson_ratio = 0.2
density = 2400.0
compressive_strength = 30e6
crushing_strain = 0.006

[materials.rebar]
model = "menegotto-pinto"
youngs_modulus = 200e9
poisson_ratio = 0.3
density = 7850.0
yield_stress = 500e6

[materials.steel]
model = "elastic"
youngs_modulus = 200e9
poisson_ratio = 0.3
density = 7850.0

[sections.column]
shape = "rectangle"
width = 0.4
height = 0.5
bars = [{ material = "rebar", diameter = 0.02, count = 2, from = [-0.14, 0.19], to = [0.14, 0.19] }]

[[beams]]
name = "column"
path = ["foot", "top"]
elements = 4
material = "plain"
section = "column"
orientation = [0.0, 1.0, 0.0]
"#;

/// The deck with some words in place of others.
fn with(old: &str, new: &str) -> String {
    assert!(COLUMN.contains(old), "{old}");
    COLUMN.replace(old, new)
}

fn read(text: &str) -> (Option<Model>, String) {
    let source = Source::new("deck.toml".to_owned(), text.to_owned(), &[]);
    let (model, problems) = model::read(&source);
    (model, problems.iter().map(|problem| format!("{}; {}\n", problem.message, problem.hints.join("; "))).collect())
}

/// Stiffness and mass of the section by hand, with two bars beside the centre. Sums of 146 fibres round to some 1e-14.
#[test]
fn bars_count_in_stiffness_and_mass() {
    let (model, _) = read(COLUMN);
    let section = &model.unwrap().stiffnesses[0];
    let bars = 2.0 * std::f64::consts::PI * 1e-4;
    let close = |value: f64, exact: f64| assert!((value - exact).abs() < 1e-12 * exact.abs(), "{value} for {exact}");
    close(section.N[(0, 0)], 30e9 * 0.2 + 170e9 * bars);
    close(section.NM[(0, 1)], 170e9 * bars * 0.19);
    close(section.M[(1, 1)], 30e9 * 0.2 * 0.25 / 12.0 + 170e9 * bars * 0.19 * 0.19);
    close(section.M[(2, 2)], 30e9 * 0.2 * 0.16 / 12.0 + 170e9 * bars * 0.14 * 0.14);
    let mass = 2400.0 * 0.2 + 5450.0 * bars;
    close(section.mass_per_length, mass);
    close(section.mass_center[1], 5450.0 * bars * 0.19 / mass);
    let about_origin = 2400.0 * 0.2 * 0.25 / 12.0 + 5450.0 * bars * 0.19 * 0.19;
    close(section.inertia_per_length[(1, 1)], about_origin - mass * section.mass_center[1].powi(2));
}

/// Resultants of a uniform strain stretch concrete and bars alike; those of a curvature stress the bars by E z κ. Both are exact but for the
/// rounding of sums over 146 fibres.
#[test]
fn elastic_stresses_are_those_of_concrete_and_bars() {
    let (model, _) = read(COLUMN);
    let stresses = model.unwrap().stresses[0].clone().unwrap();
    let bars = 170e9 * 2.0 * std::f64::consts::PI * 1e-4;
    let [EA, ES, EI] = [6e9 + bars, bars * 0.19, 6e9 * 0.25 / 12.0 + bars * 0.19 * 0.19];
    let close = |value: f64, exact: f64| assert!((value - exact).abs() < 1e-11 * exact.abs(), "{value} for {exact}");
    let [most, least, shear, mises] = stresses.extremes(&[1e-4 * EA, 0.0, 0.0, 0.0, 1e-4 * ES, 0.0]).values;
    close(most, 200e9 * 1e-4);
    close(least, 30e9 * 1e-4);
    close(mises, most);
    assert_eq!(shear, 0.0);
    close(stresses.extremes(&[1e-3 * ES, 0.0, 0.0, 0.0, 1e-3 * EI, 0.0]).values[0], 200e9 * 0.19 * 1e-3);
    // Shear is that of a rectangle of concrete alone: about 3/2 V/A.
    let shear = stresses.extremes(&[0.0, 0.0, 2e5, 0.0, 0.0, 0.0]).values[2];
    assert!(shear > 1.4e6 && shear < 1.8e6, "{shear}");
}

/// Each wrong deck, and words of its one message.
#[test]
fn wrong_decks_are_told_what_to_change() {
    let bars =
        r#"bars = [{ material = "rebar", diameter = 0.02, count = 2, from = [-0.14, 0.19], to = [0.14, 0.19] }]"#;
    let bar = |text: &str| with(bars, &format!("bars = [{{ {text} }}]"));
    let concrete = |text: &str| with("crushing_strain = 0.006", text);
    let rows = [
        (
            with("= 30e6", "= -30e6"),
            "`compressive_strength` is -3e7, but strengths and strains of concrete are magnitudes, above 0; take 3e7",
        ),
        (
            concrete("crushing_strain = -0.006"),
            "`crushing_strain` is -0.006, but strengths and strains of concrete are magnitudes",
        ),
        (concrete(""), "material `plain` needs `crushing_strain` or `crushing_energy`"),
        (
            concrete("crushing_strain = 0.001"),
            "the strength is reached at 2 compressive_strength / youngs_modulus = 0.002",
        ),
        (
            concrete("crushing_strain = 0.006\ncrushing_energy = 3e4"),
            "takes `crushing_strain` or `crushing_energy`, not both",
        ),
        (
            concrete("crushing_strain = 0.006\ntensile_strength = 2e6"),
            "needs `tension_softening_modulus` or `fracture_energy`",
        ),
        (
            concrete("crushing_strain = 0.006\ntensile_strength = 40e6\ntension_softening_modulus = 1e9"),
            "`tensile_strength` is 4e7, above the compressive strength 3e7; a tenth of it is common",
        ),
        (concrete("crushing_strain = 0.006\nfracture_energy = 100.0"), "`fracture_energy` needs `tensile_strength`"),
        (
            concrete("crushing_strain = 0.006\nresidual_strength = 31e6"),
            "`residual_strength` is 3.1e7, above the compressive strength",
        ),
        (
            concrete("crushing_strain = 0.006\nunloading_ratio = 0.01"),
            "unloading from the crushing strain would end in tension; take 0.03333 or more",
        ),
        (
            concrete("crushing_energy = 3e3"),
            "of material `plain` is 3000, but an integration point stands for a length of 0.333",
        ),
        (with("yield_stress = 500e6", ""), "material `rebar` needs `yield_stress`"),
        (
            with("yield_stress = 500e6", "yield_stress = 500e6\nisotropic = [0.1, 1.0]"),
            "`isotropic` takes four numbers",
        ),
        (with("yield_stress = 500e6", "yield_stress = 500e6\ncurvature = [20.0, 1.0, 0.15]"), "cR1 from 0 to below 1"),
        (
            bar(r#"material = "rebar", diameter = 0.02, at = [0.0, 0.245]"#),
            "the bar at [0, 0.245] does not lie within section `column`; its centre is 0.005 deep, its radius is 0.01",
        ),
        (
            bar(r#"material = "plain", diameter = 0.02, at = [0.0, 0.0]"#),
            "are of concrete, material `plain`; name a material of steel",
        ),
        (
            bar(r#"material = "rebar", diameter = 0.02"#),
            "need a place: `at`, `from` and `to` with `count`, or `circle` with `count`",
        ),
        (bar(r#"material = "rebar", at = [0.0, 0.0]"#), "needs `diameter`"),
        (
            bar(r#"material = "rebar", diameter = 0.02, area = 1e-4, at = [0.0, 0.0]"#),
            "take `diameter` or `area`, not both",
        ),
        (bar(r#"material = "rebar", diameter = 0.02, circle = 0.1"#), "needs `count`"),
        (bar(r#"material = "rebar", diameter = 0.02, circle = 0.1, count = 1"#), "`count` must lie between 2 and 1000"),
        (bar(r#"diameter = 0.02, at = [0.0, 0.0]"#), "needs `material`"),
        (
            with(
                "shape = \"rectangle\"\nwidth = 0.4\nheight = 0.5",
                "shape = \"general\"\narea = 0.2\nmoments = [4e-3, 3e-3]\ntorsion_constant = 5e-3\nshear_areas = [0.16, 0.16]",
            ),
            "section `column`: a general section has no fibres, because it gives an area without its place",
        ),
        (
            bar(r#"material = "rebar", diameter = 0.02, count = 3, from = [0.0, 0.0], to = [0.03, 0.0]"#),
            "the bars at [0.015, 0] and [0, 0] of section `column` overlap; a bar counts once",
        ),
        (with(bars, "cover = 0.04"), "has a `cover`, but no `core`; name the material of the core"),
        (with(bars, "core = \"plain\""), "section `column` needs `cover`"),
        (with(bars, "core = \"plain\"\ncover = 0.2"), "section `column` has no core within a cover of 0.2"),
        (with(bars, "core = \"steel\"\ncover = 0.04"), "material `steel` is no concrete"),
        (with("material = \"plain\"", "material = \"steel\""), "material `steel` is no concrete"),
        (
            with("elements = 4\n", "elements = 4\nshear_yields = true\n"),
            "is of a material under normal stress alone: shear and torsion stay elastic",
        ),
        (
            format!(
                "{COLUMN}\n[[bars]]\nname = \"stay\"\npath = [\"foot\", \"top\"]\nmaterial = \"rebar\"\narea = 1e-4\n"
            ),
            "bar `stay` cannot be made of material `rebar`: model \"menegotto-pinto\" is for beams",
        ),
    ];
    for (deck, words) in rows {
        let (model, said) = read(&deck);
        assert!(model.is_none() && said.contains(words), "{words}\n{said}\n{deck}");
    }
}
