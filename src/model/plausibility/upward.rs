//! Loads against gravity: a sign that was forgotten, where a weight is meant.

use crate::environment::gravity;
use crate::report::Report;
use crate::values::vec3;
use base::diagnostic::At;
use base::math::Vec3;
use deck::Deck;
use deck::amplitudes::AmplitudeKind;
use deck::loads::Load;
use deck::words::Table;

/// Cosine beyond which a load acts along a direction: inclined loads are no weights.
const ALONG: f64 = 0.9999;

/// Notes loads that act straight against gravity for the whole run, as a weight of the wrong sign does. Loads that lift are as frequent, so
/// that this is no warning. Where gravity is along a positive axis and against all of them, the note is about gravity.
pub fn check_upward(deck: &Deck, report: &mut Report) {
    let Some(down) = gravity(deck).try_normalize(0.0) else { return };
    let stays = |load: &&At<Table<Load>>| stays(deck, load) && load.follower.as_ref().is_none_or(|at| !at.value);
    let given = deck.loads.iter().filter(stays).flat_map(|load| {
        [&load.force, &load.total_force, &load.force_per_length, &load.force_per_area].into_iter().flatten()
    });
    let (against, with): (Vec<_>, Vec<_>) = given
        .map(|at| (at, vec3(at)))
        .filter(|(_, force)| force.dot(&down).abs() > ALONG * force.norm())
        .partition(|(_, force)| force.dot(&down) < 0.0);
    let turned = |vector: &Vec3| {
        let [x, y, z]: [f64; 3] = vector.map(|x| if x == 0.0 { 0.0 } else { -x }).into();
        format!("[{x:?}, {y:?}, {z:?}]")
    };
    let environment = deck.environment.as_ref().and_then(|environment| environment.gravity.as_ref());
    if let Some(at) = environment.filter(|_| with.is_empty() && against.len() > 1 && down.max() > ALONG) {
        let message = "gravity acts upwards, against all loads along it";
        let hint = format!("for weights write {}; loads that lift are right as they are", turned(&gravity(deck)));
        return report.note(&at.span, message, hint);
    }
    for (at, force) in against {
        let message = "this load acts upwards, against gravity";
        let hint = format!("for a weight write {}; a load that lifts is right as it is", turned(&force));
        report.note(&at.span, message, hint);
    }
}

/// True for a load that acts with its sign for the whole run. A load of load cases has the signs of their factors.
fn stays(deck: &Deck, load: &Load) -> bool {
    if load.stages.is_some() || !deck.load_cases.is_empty() {
        return false;
    }
    let Some(name) = &load.amplitude else { return true };
    let kind = deck.amplitudes.position(name).and_then(|place| deck.amplitudes.0[place].1.kind.as_ref());
    kind.is_some_and(|kind| matches!(kind.value, AmplitudeKind::Constant | AmplitudeKind::Ramp))
}
