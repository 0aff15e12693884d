//! Whether bushings still know their moments at the end of a step.

use super::context::Context;
use super::failure::Failure;
use super::workspace::Workspace;
use crate::model::Link;
use crate::state::State;
use crate::system::results::bushing_turned_over;

/// Before the trial motion is taken.
///
/// # Errors
/// [`Failure::BushingTurnedOver`] where the ends of a bushing have turned against each other by half a turn.
pub fn check(cx: &Context, ws: &Workspace, state: &State) -> Result<(), Failure> {
    let turned = bushing_turned_over(cx.system, &state.nodes, &ws.trial);
    let link = turned.and_then(|place| cx.model.each::<Link>().nth(place));
    link.map_or(Ok(()), |link| Err(Failure::BushingTurnedOver { name: link.name.clone() }))
}
