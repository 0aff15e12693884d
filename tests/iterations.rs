//! The number of corrections that an equilibrium takes.

use crate::support::{read, read_deck, run_to_the_end};

/// Steps of a slender frame that are long for it, a sixtieth of the run: stages converge in three to four corrections each. Without the
/// stresses extrapolated from the iterate before, these take 7.5.
#[test]
fn long_steps_of_slender_beams() {
    let sets = [
        "expect=[]",
        "integrator={scheme=\"esdirk3\"}",
        "analysis={kind=\"dynamic\",end_time=15.0,time_step=0.5}",
        "iteration={tolerance=1e-6}",
        "beams.legs.elements=1",
        "beams.legs.order=4",
        "output={every=1}",
    ];
    let model = read("right_angle_cantilever", &sets.map(str::to_owned));
    let done = run_to_the_end(&model, &mut |_| Vec::new());
    let stages = 4.0 * done.counts.steps as f64;
    let each = done.counts.iterations as f64 / stages;
    println!("{each:.2} corrections a stage, {} cuts", done.counts.cuts);
    assert!(done.counts.cuts == 0 && each < 4.5, "{each} {:?}", done.counts);
}

/// A slender cantilever bent to a full circle by ten equal moments: every load step converges in few corrections, whose number does not
/// grow with the slenderness.
#[test]
fn load_steps_of_slender_beams() {
    let corrections = |thickness: f64| {
        let moment = std::f64::consts::TAU * 210e9 * 0.1 * thickness.powi(3) / 12.0;
        let model = read_deck(&format!(
            r#"
            analysis = {{ kind = "static", end_time = 1.0, time_step = 0.1 }}
            points = {{ root = [0.0, 0.0, 0.0], tip = [1.0, 0.0, 0.0] }}
            materials = {{ steel = {{ model = "elastic", youngs_modulus = 210e9, poisson_ratio = 0.3 }} }}
            sections = {{ strip = {{ shape = "rectangle", width = 0.1, height = {thickness} }} }}
            beams = [{{ name = "b", path = ["root", "tip"], elements = 6, order = 2, material = "steel", section = "strip", orientation = [0.0, 0.0, 1.0] }}]
            supports = [{{ at = "root", fix = "all" }}]
            loads = [{{ at = "tip", moment = [0.0, {moment:e}, 0.0], amplitude = "ramp" }}]
            amplitudes = {{ ramp = {{ kind = "table", points = [[0.0, 0.0], [1.0, 1.0]] }} }}
            "#
        ));
        let done = run_to_the_end(&model, &mut |_| Vec::new());
        done.counts.iterations as f64 / done.counts.steps as f64
    };
    for thickness in [0.05, 0.005, 0.0005] {
        let each = corrections(thickness);
        println!("thickness {thickness}: {each:.1} corrections a step");
        assert!(each < 7.0, "{thickness}: {each}");
    }
}
