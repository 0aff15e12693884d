//! `rdsolve schema`: the JSON Schema of the deck, for completion and checks in editors.

use super::Exit;
use crate::deck::Deck;

pub(super) fn schema() -> Result<(), Exit> {
    let schema = schemars::schema_for!(Deck);
    let text = serde_json::to_string_pretty(&schema).map_err(|_| Exit::Internal)?;
    super::print(&format!("{text}\n"))
}
