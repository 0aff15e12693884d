//! `[[loads]]` with `unbalance`: forces that turn with the spin of their nodes. Spins then follow the frequency of a response.

use crate::data::{Load, LoadOrigin, ResponseMethod};
use crate::places::nodes::Topology;
use crate::procedure::response::has_response;
use crate::report::{Owner, Report};
use crate::scene::{Reach, Scene};
use crate::values::{keys, vec3};
use base::diagnostic::At;
use base::math::Vec3;
use base::names::short;
use deck::words::Vector;
use mechanics::amplitude::Amplitude;
use std::f64::consts::FRAC_PI_2;

/// Part of an unbalance along the axis, and difference of two speeds, that digits of the deck leave.
const AS_WRITTEN: f64 = 1e-6;

/// The loads of all unbalances. The initial spins of the nodes are known.
pub fn unbalances<'d>(
    scene: &Scene<'d>,
    amplitudes: &mut Vec<Amplitude>,
    topology: &Topology,
    report: &mut Report<'d>,
) -> Vec<Load> {
    let (mut loads, mut reference) = (Vec::new(), None);
    for load in &scene.deck.loads {
        let Some(given) = load.unbalance.as_ref().filter(|given| responds(scene, given, report)) else { continue };
        let unused = keys!(load; part, force, total_force, moment, distance, force_per_length, local, projected, profile, force_per_area, pressure, temperature, temperature_gradient, centrifugal, follower, name, amplitude);
        report.reject_unused("an unbalance", &unused);
        for spot in scene.spots(&Owner::new("`[[loads]]`", &load.span), "at", &load.at, Reach::Nodes, report) {
            let omega = topology.list[spot.node].omega;
            let speed = omega.norm();
            if speed == 0.0 {
                let message = format!("`{}` does not spin at t = 0, so its unbalance has no axis", spot.name);
                let hint = "give it an `angular_velocity`, in `[[bodies]]` or `[[initial]]`: its direction is the axis, and the frequency gives the speed";
                report.error_with::<()>(spot.span, message, hint);
                continue;
            }
            let (first, name) = *reference.get_or_insert((speed, spot.name));
            if (speed - first).abs() > AS_WRITTEN * first {
                let message = format!("`{}` spins at {}, and `{name}` at {}", spot.name, short(speed), short(first));
                let hint = "the frequency is one speed: write a second deck for unbalances at other speeds";
                report.error_with::<()>(spot.span, message, hint);
            }
            loads.extend(rotating(spot.node, given, &(omega / speed), amplitudes, report).into_iter().flatten());
        }
    }
    loads
}

/// The force of an unbalance at a spin of 1 about an axis: along itself as cos ωt, and a quarter of a turn ahead as sin ωt.
fn rotating(
    node: usize,
    given: &At<Vector>,
    axis: &Vec3,
    amplitudes: &mut Vec<Amplitude>,
    report: &mut Report,
) -> Option<[Load; 2]> {
    let force = vec3(given);
    if axis.dot(&force).abs() > AS_WRITTEN * force.norm() {
        let across = force - axis * axis.dot(&force);
        let [x, y, z] = [across.x, across.y, across.z].map(short);
        let hint = format!("give its part across the axis: [{x}, {y}, {z}]");
        return report.error_with(&given.span, "this unbalance has a part along the axis of the spin", hint);
    }
    Some([(0.0, force), (-FRAC_PI_2, axis.cross(&force))].map(|(phase, force)| {
        amplitudes.push(Amplitude::Harmonic { phase });
        let (amplitude, origin) = (Some(amplitudes.len() - 1), Some(LoadOrigin::Unbalance));
        Load { node, force, moment: Vec3::zeros(), follower: false, amplitude, origin, moment_counts: true }
    }))
}

/// True in a frequency response. It is solved directly, at frequencies that the deck gives.
fn responds(scene: &Scene, given: &At<Vector>, report: &mut Report) -> bool {
    let Some(asked) = scene.analysis.response() else {
        if scene.stage.is_none_or(|stage| !has_response(stage.sequence.whole)) {
            let hint = "give `kind = \"frequency-response\"` in `[analysis]`; in time, put a mass beside the axis";
            report.error_with::<()>(&given.span, "`unbalance` acts in a frequency response alone", hint);
        }
        return false;
    };
    if asked.method == ResponseMethod::Modal {
        let hint = "leave out `method = \"modal\"`: the direct method forms the matrices at each speed";
        report.error_with::<()>(
            &given.span,
            "natural modes do not answer an unbalance: they change with the spin",
            hint,
        );
    }
    true
}
