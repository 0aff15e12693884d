//! Loads against gravity: a sign that was forgotten, where a weight is meant.

use crate::environment::gravity;
use crate::report::Report;
use crate::values::vec3_or_zero;
use base::math::Vec3;
use deck::Deck;
use deck::amplitudes::AmplitudeKind;
use deck::loads::Load;

/// Cosine beyond which a load acts along a direction: inclined loads are no weights.
const ALONG: f64 = 0.9999;

/// Notes loads that act straight against gravity for the whole run, as a weight of the wrong sign does. Loads that lift are as frequent, so
/// that this is no warning.
pub fn check_upward(deck: &Deck, report: &mut Report) {
    let Some(down) = gravity(deck).try_normalize(0.0) else { return };
    for load in deck.loads.iter().filter(|load| stays(deck, load) && load.follower.as_ref().is_none_or(|at| !at.value))
    {
        for given in [&load.force, &load.total_force, &load.force_per_length, &load.force_per_area] {
            let force = vec3_or_zero(given);
            let Some(at) = given.as_ref().filter(|_| force.dot(&down) < -ALONG * force.norm()) else { continue };
            let turned: Vec3 = force.map(|x| if x == 0.0 { 0.0 } else { -x });
            let message = "this load acts upwards, against gravity";
            let hint = format!(
                "for a weight write [{:?}, {:?}, {:?}]; a load that lifts is right as it is",
                turned.x, turned.y, turned.z
            );
            report.note(&at.span, message, hint);
        }
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
