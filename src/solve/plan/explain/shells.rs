//! Shells: how they yield.

use super::explanation::Explanation;
use crate::system::System;
use crate::tolerances::explained_shells::{CYCLES_WANT, MOMENT_OFF};
use model::{Model, Part, PartType, Shell};

/// Adds lines about shells.
pub fn explain(text: &mut Explanation, model: &Model, _: &System) {
    for part in model.parts.chunk_by(Part::is_one_with) {
        let Some(shell) = Shell::of(&part[0]) else { continue };
        let Some(yielding) = &shell.yielding else { continue };
        let layers = yielding.layers;
        let mut what = format!("{layers} layers, yielding in plane stress; transverse shear elastic");
        if let Some((_, [first, cycles, changing])) = MOMENT_OFF.iter().find(|(most, _)| layers <= *most) {
            what += &format!(
                "; moments err by up to {first} % of the plastic moment in first bending, {cycles} % over cycles, {changing} % if amplitudes \
                 change; with `layers` = {CYCLES_WANT} by 0.33, 0.9 and 2.1 %"
            );
        }
        text.add_of("yielding", ["shell", "shells"], &shell.name, what);
    }
}
