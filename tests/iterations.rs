//! The number of corrections that an equilibrium takes.

use crate::support::{read, run_to_the_end};

/// Automatic steps of a slender frame that are long for it, a fiftieth of the run: stages converge in three to four corrections each.
/// Without the stresses extrapolated from the iterate before, these take 7.5.
#[test]
fn long_steps_of_slender_beams() {
    let sets = [
        "expect=[]",
        "integrator={scheme=\"esdirk3\"}",
        "analysis={kind=\"dynamic\",end_time=30.0,time_step=\"auto\",error_tolerance=1e-2}",
        "beams.legs.elements=1",
        "beams.legs.order=4",
        "output={every=1}",
    ];
    let model = read("right_angle_cantilever", &sets.map(str::to_owned));
    let done = run_to_the_end(&model, &mut |_| Vec::new());
    let stages = 4.0 * done.counts.steps as f64;
    let each = done.counts.iterations as f64 / stages;
    println!("{each:.2} corrections a stage, {:?}", done.counts);
    assert!(each < 4.5, "{each} {:?}", done.counts);
}
