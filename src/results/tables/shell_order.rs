//! The order of shell elements in tables: the order of the deck. The order in a frame differs if a part of the mesh has triangles and
//! quadrilaterals.

use model::{Model, Part, PartType, Shell};
use solve::{Frame, ShellState};

/// The places of the elements in the frame, in the order of writing; empty where the two orders are the same.
pub struct ShellOrder(Vec<u32>);

impl ShellOrder {
    /// The order for a model, which holds for all of its frames.
    pub fn of(model: &Model) -> ShellOrder {
        if model.each::<Shell>().all(|shell| shell.numbers.is_empty()) {
            return ShellOrder(Vec::new());
        }
        let mut order = Vec::new();
        for part in model.parts.chunk_by(Part::is_one_with) {
            let first = order.len() as u32;
            let shells = part.iter().filter_map(Shell::of);
            let numbers = shells.flat_map(|shell| (0..shell.elements.len()).map(|e| shell.number(e)));
            let mut of: Vec<(usize, u32)> = numbers.zip(first..).collect();
            of.sort_unstable();
            order.extend(of.into_iter().map(|(_, place)| place));
        }
        ShellOrder(order)
    }

    /// The states of the shells' elements in a frame, in the order of writing.
    pub fn states<'f>(&self, frame: &'f Frame) -> impl Iterator<Item = &'f ShellState> {
        let states = &frame.derived.shells;
        (0..states.len()).map(|k| &states[self.0.get(k).map_or(k, |&place| place as usize)])
    }
}
