//! Checks whether a step is short enough for the contacts that it meets.

use super::context::Context;
use super::failure::Failure;
use super::workspace::Workspace;
use crate::state::{Configuration, State};

/// Checks a step that reaches `ahead` before any work is done on it: an impact must go on in steps that resolve it.
///
/// # Errors
/// [`Failure::ContactNotResolved`] where the step is too long for a contact.
pub fn check_length(cx: &Context, state: &State, ahead: f64) -> Result<(), Failure> {
    if !cx.system.has_contacts() {
        return Ok(());
    }
    cx.system.unresolved_impact(state, ahead).map_or(Ok(()), |contact| Err(too_long(cx, contact)))
}

/// Checks the motion found at `ahead` of the state: no point may have passed through a surface.
///
/// # Errors
/// [`Failure::ContactNotResolved`] where something has.
pub fn check_passage(cx: &Context, ws: &Workspace, state: &State, ahead: f64) -> Result<(), Failure> {
    if !cx.system.has_contacts() {
        return Ok(());
    }
    let now = Configuration { nodes: &ws.trial, history: &state.history, dt: ahead };
    cx.system.missed_contact(&state.nodes, &now).map_or(Ok(()), |contact| Err(too_long(cx, contact)))
}

fn too_long(cx: &Context, contact: usize) -> Failure {
    Failure::ContactNotResolved { name: cx.model.parts[contact].name().to_owned() }
}
