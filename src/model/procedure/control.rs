//! Control of a static analysis: `control` of `[analysis]` and the words that go with it.

use crate::data::{ArcLength, DisplacementTarget, History, Iteration, Method, Restraint, Update};
use crate::places::nodes::Topology;
use crate::plausibility::usage::named_amplitudes;
use crate::procedure::displacement_targets::displacement_target;
use crate::report::Report;
use crate::scene::Scene;
use crate::values::keys;
use base::diagnostic::At;
use base::names::short;
use deck::Deck;
use deck::analysis as words;
use mechanics::amplitude::Amplitude;

/// Steps to the value of `stop` with control by displacement, unless the deck says otherwise.
const INCREMENTS: f64 = 100.0;

/// The arc-length steps of the deck; `None` for time steps. A displacement to stop at must be an unknown, so supports are known.
pub fn control<'d>(
    scene: &Scene<'d>,
    amplitudes: &[Amplitude],
    topology: &Topology,
    report: &mut Report<'d>,
) -> Option<ArcLength> {
    let analysis = scene.deck.analysis.as_ref()?;
    // The step of the deck becomes the first of the path.
    let first = scene.analysis.nominal_step();
    if report.is_spoiled(&analysis.span, "control") {
        // Whatever it was to be, it is not held against the words that go with it.
        return Some(ArcLength { first, stop: None, steps: None, increment: None, growth: 1.0 });
    }
    let Some(at) = analysis.control.as_ref().filter(|at| at.value != words::Control::Time) else {
        let keys = keys!(analysis; stop, increment, growth);
        report.reject_unused("`control = \"time\"`", &keys);
        reject_steps(analysis, report);
        return None;
    };
    if scene.analysis.is_dynamic() {
        let by = if at.value == words::Control::Displacement { "displacement" } else { "arc-length" };
        let message = format!("{by} control needs `kind = \"static\"`, and this analysis is dynamic");
        return report.error(&at.span, message);
    }
    check_iteration(scene.deck, report);
    check_history(scene, amplitudes, topology, report);
    if let (Some(stage), None) = (&scene.stage, &analysis.stop)
        && let Some(stop) = stage.table().stop.as_ref().filter(|stop| stop.time.is_none())
    {
        let hint = "such as { at = \"crown\", quantity = \"uz\", value = -0.1 }";
        report.error_with::<()>(&stop.span, "a stage that follows a path stops at a displacement", hint);
    }
    let stop = analysis.stop.as_ref().and_then(|stop| displacement_target("`stop`", stop, scene, topology, report));
    let steps = analysis.steps.as_ref().map(|_| report.count("steps", &analysis.steps, 1));
    let growth = report.positive("growth", &analysis.growth).unwrap_or(f64::INFINITY);
    if let Some(at) = analysis.growth.as_ref().filter(|at| at.value > 0.0 && at.value < 1.0) {
        report.error::<()>(
            &at.span,
            "`growth` must be at least 1: `time_step` sets the first step, which is the shortest",
        );
    }
    if at.value == words::Control::Displacement {
        return by_displacement(analysis, at, stop, report);
    }
    report.reject_unused("`control = \"arc-length\"`", &keys!(analysis; increment));
    Some(ArcLength { first, stop, steps, increment: None, growth })
}

/// Reports a number of steps where their length is wanted.
fn reject_steps(analysis: &words::Analysis, report: &mut Report) {
    let Some(steps) = &analysis.steps else { return };
    let hint = match &analysis.end_time {
        Some(end) if steps.value > 0 => {
            format!("time_step = {} makes {} steps", short(end.value / steps.value as f64), steps.value)
        }
        _ => "`time_step` is their length".to_owned(),
    };
    report.error_with::<()>(&steps.span, "`steps` does not apply to `control = \"time\"`", hint);
}

/// Steps of equal displacement up to the value of `stop`.
fn by_displacement<'d>(
    analysis: &'d words::Analysis,
    control: &'d At<words::Control>,
    stop: Option<DisplacementTarget>,
    report: &mut Report<'d>,
) -> Option<ArcLength> {
    report.reject_unused("`control = \"displacement\"`, whose steps are equal", &keys!(analysis; growth));
    if let Some(steps) = analysis.steps.as_ref().filter(|steps| steps.value > 0) {
        let end = stop.as_ref().map_or(1.0, |stop| stop.value.abs());
        let hint = format!("increment = {} makes {} steps", short(end / steps.value as f64), steps.value);
        report.error_with::<()>(&steps.span, "`steps` does not apply to `control = \"displacement\"`", hint);
    }
    if analysis.stop.is_none() && !report.is_spoiled(&control.span, "stop") {
        let hint = "such as stop = { at = \"roof\", quantity = \"ux\", value = 0.3 }";
        return report.error_with(
            &control.span,
            "displacement control needs `stop`, the displacement that it moves",
            hint,
        );
    }
    let stop = stop?;
    if let Some(at) = analysis.stop.as_ref().and_then(|at| at.pass.as_ref()) {
        report.error_with::<()>(&at.span, "a displacement that steps move passes its value once", "remove `pass`");
    }
    if let Some(at) = analysis.stop.as_ref().and_then(|at| at.required.as_ref()) {
        report.error_with::<()>(
            &at.span,
            "steps of displacement control end at `stop`, or the run fails",
            "remove `required`",
        );
    }
    let increment = report.positive("increment", &analysis.increment).unwrap_or(stop.value.abs() / INCREMENTS);
    if let Some(at) = analysis.increment.as_ref().filter(|at| at.value > stop.value.abs()) {
        let message = format!("`increment` must not exceed the displacement of `stop`, which is {}", stop.value);
        report.error::<()>(&at.span, message);
    }
    let first = increment / stop.value.abs();
    Some(ArcLength { first, stop: Some(stop), steps: None, increment: Some(increment), growth: 1.0 })
}

/// The iteration along a path, with the current tangent, which gives the direction of the path.
pub fn path_iteration(deck: &Deck, iteration: Iteration) -> Iteration {
    match deck.iteration {
        Some(_) => Iteration { method: Method::TangentStiffness, update: Update::Iteration, ..iteration },
        None => iteration,
    }
}

fn check_iteration(deck: &Deck, report: &mut Report) {
    let Some(iteration) = &deck.iteration else { return };
    let reason = "arc-length control forms the tangent stiffness at every iteration";
    if let Some(at) = iteration.method.as_ref().filter(|at| at.value == Method::InitialLoad) {
        report.error_with::<()>(&at.span, "`method = \"initial-load\"` does not go with arc-length control", reason);
    }
    let kept = |at: &&At<Update>| matches!(at.value, Update::Step | Update::Never);
    if let Some(at) = iteration.update.as_ref().filter(kept) {
        report.error_with::<()>(&at.span, "`update` must be \"auto\" or \"iteration\" with arc-length control", reason);
    }
}

/// A path needs continuous loads and materials: jumps and rates are refused, because time may decrease.
fn check_history(scene: &Scene, amplitudes: &[Amplitude], topology: &Topology, report: &mut Report) {
    for contact in &scene.deck.contacts {
        if contact.stiffness.as_ref().is_none_or(|at| at.value != 0.0) {
            let message =
                "arc-length control does not go with contacts: the path of equilibria has a kink where they close";
            let hint = "use `control = \"time\"`, or `stiffness = 0` to monitor the clearance only";
            report.error_with::<()>(&contact.span, message, hint);
        }
    }
    for (name, material) in &scene.deck.materials.0 {
        if let Some(at) = &material.viscosity {
            let message = format!(
                "material `{}` is viscous, and with arc-length control time is the load factor only",
                name.value
            );
            report.error_with::<()>(&at.span, message, "remove `viscosity`, or give `control` = \"time\"");
        }
        if let Some(place) = material.values.place("failure_rate") {
            let message = format!(
                "material `{}` fails by the rate of its strain, and with arc-length control time is the load factor only",
                name.value
            );
            report.error_with::<()>(place, message, "remove `failure_rate`, or give `control` = \"time\"");
        }
    }
    let used = named_amplitudes(scene.deck);
    for (index, (name, amplitude)) in scene.deck.amplitudes.0.iter().enumerate() {
        let jumps = amplitudes.get(index).is_some_and(|amplitude| !amplitude.jumps().is_empty());
        if jumps && used.contains(name.as_str()) {
            let message = format!("amplitude `{}` jumps, which arc-length control cannot follow", name.value);
            report.error_with::<()>(&amplitude.span, message, "let it rise over a finite time");
        }
        // The reversal of a velocity does not reverse the motion.
        let moves = |restraint: &Restraint| {
            let motion = restraint.motion.as_ref().filter(|motion| motion.amplitude == index);
            motion.is_some_and(|motion| motion.history != History::Displacement)
        };
        let turn = amplitudes.get(index).and_then(|read| read.turn(scene.analysis.end_time));
        if let Some(time) = turn
            && used.contains(name.as_str())
            && !topology.restraints().any(moves)
        {
            let message = format!("amplitude `{}` turns at t = {}", name.value, short(time));
            let hint =
                "with arc-length control a load that turns leads back along its path: let it only rise or only fall";
            report.error_with::<()>(&amplitude.span, message, hint);
        }
    }
}
