//! shells.csv: stress resultants of the shells' elements; layers.csv: stress through their thickness.

use super::table::Table;
use crate::model::{Model, Part, PartType, Shell};
use crate::solve::{Frame, ShellState};
use std::io;

/// In which order elements of shells are written: that of the deck, which is not that of the frame where a part of the mesh has
/// triangles and quadrilaterals.
pub(super) struct Order(Vec<u32>);

impl Order {
    /// Empty where the two are the same.
    pub fn of(model: &Model) -> Order {
        if model.each::<Shell>().all(|shell| shell.numbers.is_empty()) {
            return Order(Vec::new());
        }
        let mut order = Vec::new();
        for part in model.parts.chunk_by(Part::is_one_with) {
            let first = order.len() as u32;
            let numbers =
                part.iter().filter_map(Shell::of).flat_map(|shell| (0..shell.elements.len()).map(|e| shell.number(e)));
            let mut of: Vec<(usize, u32)> = numbers.zip(first..).collect();
            of.sort_unstable();
            order.extend(of.into_iter().map(|(_, place)| place));
        }
        Order(order)
    }

    fn states<'f>(&self, frame: &'f Frame) -> impl Iterator<Item = &'f ShellState> {
        (0..frame.shells.len()).map(|k| &frame.shells[self.0.get(k).map_or(k, |&place| place as usize)])
    }
}

pub(super) fn header() -> String {
    "step,time,shell,element,N11,N22,N12,M11,M22,M12,Q1,Q2,von_mises_bottom,von_mises_top,plastic_strain".into()
}

pub(super) fn write(table: &mut Table, order: &Order, frame: &Frame) -> io::Result<()> {
    order.states(frame).try_for_each(|state| {
        let at = &state.at;
        table.row(frame.step, frame.state.time).text(frame.model.parts[state.part].name()).count(state.element);
        table.numbers(&at.N).numbers(&at.M).numbers(&at.Q).numbers(&outer(state)).number(plastic_strain(state)).end()
    })
}

pub(super) fn header_of_layers() -> String {
    "step,time,shell,element,layer,z,s11,s22,s12,von_mises,plastic_strain".into()
}

pub(super) fn write_layers(table: &mut Table, order: &Order, frame: &Frame) -> io::Result<()> {
    let layers = order.states(frame).flat_map(|state| state.at.layers().iter().enumerate().map(move |at| (state, at)));
    layers.into_iter().try_for_each(|(state, (number, layer))| {
        table.row(frame.step, frame.state.time).text(frame.model.parts[state.part].name()).count(state.element);
        table.count(number).number(layer.z).numbers(&layer.stress).number(layer.von_mises());
        table.number(layer.plastic_strain).end()
    })
}

/// Von Mises stress in the lowest layer and in the highest.
pub fn outer(state: &ShellState) -> [f64; 2] {
    let layers = state.at.layers();
    [layers.first(), layers.last()].map(|layer| layer.map_or(0.0, |layer| layer.von_mises()))
}

/// Largest over the layers.
pub fn von_mises(state: &ShellState) -> f64 {
    state.at.layers().iter().map(|layer| layer.von_mises()).fold(0.0, f64::max)
}

/// Largest over the layers.
pub fn plastic_strain(state: &ShellState) -> f64 {
    state.at.layers().iter().map(|layer| layer.plastic_strain).fold(0.0, f64::max)
}
