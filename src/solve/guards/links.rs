//! Checks that the moments of bushings and the prescribed rotations of supports are still defined at the end of a step.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::guard::Guard;
use crate::step::trial::Step;
use crate::system::results::{bushing_turned_over, bushing_turns_too_far};
use crate::workspace::Workspace;
use mechanics::constraints::joint::ConstraintEquation;
use mechanics::materials::Dissipation;
use mechanics::state::{Node, State};
use model::Link;

/// Refuses a step that loses the turn count of a bushing or support.
pub struct LinkGuard;

impl Guard for LinkGuard {
    fn at_end(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        step: &Step,
        _dissipated: &Dissipation,
    ) -> Result<(), Failure> {
        check(cx, &ws.end.nodes, step.state, step.dt())
    }
}

/// Checks the motion from a state to these nodes, at the end of a step of length `dt`.
///
/// # Errors
/// [`Failure::BushingTurnedOver`] if the ends of a bushing have turned against each other by half a turn. [`Failure::BushingTurnsTooFar`]
/// if the turn of one step is ambiguous. [`Failure::GivenRotationLost`] if a prescribed rotation beside a free one is no longer known.
pub fn check(cx: &Context, nodes: &[Node], state: &State, dt: f64) -> Result<(), Failure> {
    let name = |place: usize| cx.model.each::<Link>().nth(place).map(|link| link.name.clone());
    // The longer step is the cause where both hold.
    if let Some(name) = bushing_turns_too_far(cx.system, &state.nodes, nodes, dt).and_then(name) {
        return Err(Failure::BushingTurnsTooFar { name, dt });
    }
    let turned = bushing_turned_over(cx.system, &state.nodes, nodes).and_then(name);
    turned.map_or(Ok(()), |name| Err(Failure::BushingTurnedOver { name }))?;
    for joint in cx.system.joints.iter().filter(|joint| joint.supports) {
        let [node, support] = joint.nodes;
        let both = [&state.nodes[node], &nodes[node]];
        let lost = |row: &ConstraintEquation| match row {
            ConstraintEquation::Given(angle) => angle.is_lost(both, &nodes[support]),
            _ => false,
        };
        if joint.equations.iter().any(lost) {
            return Err(Failure::GivenRotationLost { label: cx.model.nodes[node].label.clone() });
        }
    }
    Ok(())
}
