//! What load steps keep.

use crate::allocations::allocations;
use rdsolve::solve::inner::{LoadSteps, Peak, SuddenLoads};
use rdsolve::system::{Loading, Prescribed, Scale};

/// The copy keeps its own memory, which is at hand before the step: a step allocates nothing.
#[test]
fn sudden_loads_are_copied_into_the_memory_at_hand() {
    let of = |value: f64| {
        let jump = Loading { factors: vec![value; 3], pressures: vec![value; 2], ..Loading::default() };
        LoadSteps { sudden: Some(SuddenLoads::new(value, 2.0 * value, jump)), ..LoadSteps::default() }
    };
    let (mut own, other) = (of(1.0), LoadSteps { careful: true, doubtful: Some((3.0, 4.0)), ..of(5.0) });
    let before = allocations();
    own.copy_from(&other);
    assert_eq!(allocations(), before);
    assert_eq!(format!("{own:?}"), format!("{other:?}"));
    own.copy_from(&LoadSteps::default());
    assert!(own.sudden.is_none() && !own.careful);
    own.copy_from(&other);
    assert_eq!(format!("{own:?}"), format!("{other:?}"));
}

#[test]
fn forces_of_the_run_count_where_nothing_acts_any_more() {
    let mut none = Peak::default();
    none.begin_step(&Loading { factors: vec![0.0], ..Loading::default() }, &[], 1.0);
    assert!(none.is_unstressed(1.0) && !none.is_unstressed(1e-3) && none.scale(Scale::default()) == Scale::default());
    let loads = |factor: f64| Loading { factors: vec![factor, 0.0], ..Loading::default() };
    let of = |force: f64| Scale { force, moment: 0.0 };
    // A body that a support moves, and that was stressed before: half of its force out of balance is no equilibrium.
    let mut moved = Peak::default();
    moved.begin_step(&loads(1.0), &[], 1.0);
    moved.scale(of(30.0));
    moved.keep(1e-9);
    let support = Prescribed { u: 1e-3, ..Prescribed::default() };
    moved.begin_step(&loads(0.0), &[support], 1.0);
    for (force, unstressed) in [(15.0, false), (1e-3, false), (3e-9, true)] {
        moved.scale(of(force));
        assert_eq!(moved.is_unstressed(0.5), unstressed, "{force}");
        assert!(!moved.is_unstressed(0.05), "{force}");
    }
    let mut peak = Peak::default();
    for (factor, own, measure) in
        [(1.0, 30.0, 30.0), (0.5, 15.0, 15.0), (1e-9, 3e-8, 3e-8), (1e-16, 3e-9, 30.0), (0.0, 1e-9, 30.0)]
    {
        peak.begin_step(&loads(factor), &[], 1.0);
        assert_eq!(peak.scale(of(own)), of(measure), "{factor}");
        peak.keep(1e-9);
    }
}

/// A portal whose sections yield in bending and shear at the ends of its legs: tangents lead away there, and steps would be cut into hundreds. With
/// the elastic matrix they converge, to the equilibrium that the initial load method finds alone.
#[test]
fn steps_that_tangents_lead_astray_converge_with_the_elastic_matrix() {
    const PORTAL: &str = r#"
analysis = { kind = "static", end_time = 1.0, time_step = 0.1 }
materials.steel = { model = "elastic-plastic", youngs_modulus = 210e3, poisson_ratio = 0.3, yield_stress = 355.0, hardening_modulus = 2000.0 }
sections.post = { shape = "box", width = 80.0, height = 80.0, thickness = 5.0 }
points = { f1 = [0.0, 0.0, 0.0], f2 = [0.0, 1000.0, 0.0], k1 = [0.0, 0.0, 1600.0], k2 = [0.0, 1000.0, 1600.0] }
supports = [{ at = ["f1", "f2"], fix = "all" }, { at = "k1", motion = { uy = { amplitude = "push", scale = 100.0 } } }]
amplitudes.push = { kind = "ramp", end = 1.0 }
[[beams]]
name = "hoop"
path = ["f1", "k1", "k2", "f2"]
elements = 6
material = "steel"
section = "post"
orientation = [1.0, 0.0, 0.0]
"#;
    let run = |method: &str| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("d.toml"), format!("iteration.method = \"{method}\"\n{PORTAL}")).unwrap();
        let mut command = assert_cmd::Command::cargo_bin("rdsolve").unwrap();
        command.current_dir(folder.path()).args(["d.toml", "--quiet"]).assert().code(0);
        let read = |file: &str| std::fs::read_to_string(folder.path().join("d.out").join(file)).unwrap();
        let result: serde_json::Value = serde_json::from_str(&read("result.json")).unwrap();
        let energy = read("energy.csv");
        let place = energy.lines().next().unwrap().split(',').position(|name| name == "external").unwrap();
        let work: f64 = energy.lines().last().unwrap().split(',').nth(place).unwrap().parse().unwrap();
        (result["counts"]["steps"].as_u64().unwrap(), work)
    };
    let ((steps, work), (_, alone)) = (run("auto"), run("initial-load"));
    // One of 10 steps is cut; tangents alone need 441.
    assert!(steps < 20, "{steps}");
    // The step that is cut changes the error of the flow by 7e-6.
    assert!((work / alone - 1.0).abs() < 1e-4, "{work} {alone}");
}
