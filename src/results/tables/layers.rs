//! layers.csv: stress through the thickness of the shells.

use super::shell_order::ShellOrder;
use crate::extent::Rows;
use crate::table::{TableKind, WriteRow};
use base::quantities::{Axes, Column, PLASTIC_STRAIN, Unit, VON_MISES};
use model::Shell;
use solve::{Frame, Wanted};
use std::io;

const fn stress(name: &'static str) -> Column {
    Column::scalar(name, "stress in the layer", Unit::Stress).kind("stress").in_axes(Axes::Surface).positive("tension")
}

pub static TABLE: TableKind = TableKind {
    file: "layers.csv",
    about: "One row for each layer of each shell element, from the bottom up; of an elastic shell its two surfaces. Means over the \
            element. Written if `[output] layers = true` and there are shells.",
    columns: &[&[
        Column::key("shell", "name of the shell"),
        Column::key("element", "number of the element in its part, from 0"),
        Column::key("layer", "number of the layer, from 0 at the bottom"),
        Column::scalar("z", "height of the layer above the mid-surface", Unit::Length).positive("towards the normal"),
        stress("s11"),
        stress("s22"),
        stress("s12"),
        VON_MISES,
        PLASTIC_STRAIN,
    ]],
    wanted: |model| model.output.layers && model.has_surfaces(),
    needs: Wanted::SHELLS,
    has_last: |_| true,
    every_step: false,
    extent: |extent| {
        let shells = || extent.model.each::<Shell>();
        let layers = |shell: &Shell| shell.yielding.as_ref().map_or(2, |layers| layers.layers) * shell.elements.len();
        let names = shells().flat_map(|shell| std::iter::repeat_n(shell.name.as_str(), layers(shell)));
        let numbers = |shell: &Shell| layers(shell) * (4 + usize::from(shell.yielding.is_some()));
        Rows::named(names, shells().map(numbers).sum())
    },
    rows: |model| {
        let order = ShellOrder::of(model);
        Box::new(move |table, frame| write(table, &order, frame))
    },
    answers: None,
};

fn write(table: &mut dyn WriteRow, order: &ShellOrder, frame: &Frame) -> io::Result<()> {
    let layers = order.states(frame).flat_map(|state| state.at.layers().iter().enumerate().map(move |at| (state, at)));
    layers.into_iter().try_for_each(|(state, (number, layer))| {
        table.row(frame.step, frame.state.time).text(frame.model.parts[state.part].name()).count(state.element);
        table.count(number).number(layer.z).numbers(&layer.stress).number(layer.von_mises());
        table.number(layer.plastic_strain).end()
    })
}
