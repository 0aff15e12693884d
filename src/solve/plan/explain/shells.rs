//! Shells: how they yield.

use super::explanation::Explanation;
use crate::system::System;
use model::{Model, Part, PartType, Shell};

/// Adds lines about shells.
pub fn explain(text: &mut Explanation, model: &Model, _: &System) {
    for part in model.parts.chunk_by(Part::is_one_with) {
        let Some(shell) = Shell::of(&part[0]) else { continue };
        let Some(yielding) = &shell.yielding else { continue };
        let what = format!("{} layers, yielding in plane stress; transverse shear elastic", yielding.layers);
        text.add_of("yielding", ["shell", "shells"], &shell.name, what);
    }
}
