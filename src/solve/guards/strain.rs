//! Checks the strain of yielding shells, and the rotations of superelements and reduced parts in their frames: beyond the range of their strain measure
//! forces are wrong. In decks with units it checks the strain of elastic beams, which no material bears: loads have another unit.

use crate::context::Context;
use crate::guards::guard::{Guard, Taken};
use crate::system::{SectionPoint, judges_stresses, largest_elastic_strain, section_points};
use crate::tolerances::strain::{BENT, BEYOND_ELASTIC, LARGE, LARGE_LOGARITHMIC, LOOKS};
use crate::warning::{Warnings, bending_error};
use crate::workspace::Workspace;
use mechanics::state::State;
use model::Model;

/// Records the largest strain at the end of a step that passes one of a hundred equal parts of the run.
#[derive(Default)]
pub struct StrainGuard {
    /// Room for the resultants of beams.
    points: Vec<SectionPoint>,
}

impl Guard for StrainGuard {
    fn after_step(&mut self, cx: &Context, ws: &mut Workspace, taken: &Taken) {
        let (begin, end) = (cx.model.analysis.begin, cx.model.analysis.end_time);
        let part = |time: f64| (LOOKS * (time - begin) / (end - begin)).floor();
        if part(taken.from) != part(taken.state.time) {
            look(cx, &mut ws.warnings, taken.state);
            if judges_stresses(cx.model) {
                section_points(
                    cx.system.shown_groups(),
                    cx.model,
                    &taken.state.configuration(),
                    None,
                    &mut self.points,
                );
                look_at_beams(cx.model, &self.points, &mut ws.warnings);
            }
        }
    }
}

/// Warns of an elastic beam with implausible strain.
pub fn look_at_beams(model: &Model, points: &[SectionPoint], warnings: &mut Warnings) {
    let found = largest_elastic_strain(model, points);
    if let Some((part, of)) = found.filter(|(_, [_, strain])| *strain > BEYOND_ELASTIC) {
        warnings.beyond_elastic(model.parts[part].name(), of);
    }
}

fn look(cx: &Context, warnings: &mut Warnings, state: &State) {
    let now = state.configuration();
    for following in cx.system.following() {
        let turn = following.rotation(&state.nodes);
        bend(warnings, &following.name, [true, following.is_linear()], turn);
    }
    for group in &cx.system.groups {
        let own = group.configuration(&now);
        let of = cx.model.reduction(group.part).filter(|_| group.reduces);
        let is_linear =
            of.is_none_or(|of| cx.model.reductions.iter().any(|piece| piece.parts == of.parts && piece.is_linear()));
        let name = of.map_or_else(|| group.part_of(0, cx.model).name(), |of| &of.name);
        bend(warnings, name, [of.is_some(), is_linear], group.block.local_rotation(&own));
        group.block.surface_strains(&own, &mut |e, strain, is_logarithmic| {
            let [least, most] = if is_logarithmic { LARGE_LOGARITHMIC } else { [-LARGE, LARGE] };
            if !(least..=most).contains(&strain) {
                warnings.stretch(group.part_of(e, cx.model).name(), (strain, is_logarithmic));
            }
        });
    }
}

/// Warns of a part that is bent too far.
fn bend(warnings: &mut Warnings, name: &str, [reduced, linear]: [bool; 2], turn: f64) {
    if bending_error(linear, turn) > BENT {
        warnings.bend(name, [reduced, linear], turn);
    }
}
