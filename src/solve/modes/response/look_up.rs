//! The check for the end of a search between two frequencies.

use super::super::fault::ModesFault;
use super::super::linearized::Linearized;

/// Ends the search between two frequencies after a signal, or for a pause once it has made progress.
///
/// # Errors
/// [`ModesFault::Stopped`].
pub(super) fn look_up(at: &Linearized, came_on: bool, pauses: &mut dyn FnMut() -> bool) -> Result<(), ModesFault> {
    at.check_stop()?;
    if came_on && pauses() { Err(ModesFault::Stopped) } else { Ok(()) }
}
