//! Bars: how they yield.

use super::explanation::Explanation;
use crate::system::System;
use model::{Bar, Model};

/// Adds lines about bars.
pub fn explain(text: &mut Explanation, model: &Model, _: &System) {
    for bar in model.each::<Bar>().filter(|bar| bar.yielding.is_some()) {
        text.add_of("yielding", ["bar", "bars"], &bar.name, "under normal stress");
    }
}
