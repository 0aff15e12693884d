//! shells.csv: stress resultants of the shells' elements.

use super::shell_order::ShellOrder;
use crate::model::{ExpectAt, PartKind, Shell};
use crate::output::extent::Rows;
use crate::output::table::{Answers, TableKind, WriteRow};
use crate::quantities::{Axes, Column, PLASTIC_STRAIN, Unit, VON_MISES};
use crate::solve::{Frame, ShellState, Wanted};
use std::io;

const fn membrane(name: &'static str) -> Column {
    Column::scalar(name, "membrane force per length", Unit::ForcePerLength)
        .kind("membrane force")
        .in_axes(Axes::Surface)
        .positive("tension")
}

const fn bending(name: &'static str) -> Column {
    Column::scalar(name, "bending moment per length", Unit::MomentPerLength)
        .kind("bending moment")
        .in_axes(Axes::Surface)
        .positive("tension at the top, the side of the normal")
}

const fn shear(name: &'static str) -> Column {
    Column::scalar(name, "transverse shear force per length", Unit::ForcePerLength)
        .kind("shear force")
        .in_axes(Axes::Surface)
        .positive("∂M11/∂1 + ∂M12/∂2 = Q1")
}

const fn surface_stress(name: &'static str, meaning: &'static str) -> Column {
    Column::scalar(name, meaning, Unit::Stress).kind("surface stress")
}

pub static TABLE: TableKind = TableKind {
    file: "shells.csv",
    about: "One row for each shell element: means over the element, per length in the initial state, in axes that turn with the \
            surface (`axis_1` of the fields). Written if `[output] sections = true` and there are shells.",
    columns: &[&[
        Column::key("shell", "name of the shell"),
        Column::key("element", "number of the element in its part, from 0"),
        membrane("N11"),
        membrane("N22"),
        membrane("N12"),
        bending("M11"),
        bending("M22"),
        bending("M12"),
        shear("Q1"),
        shear("Q2"),
        surface_stress("von_mises_bottom", "von Mises stress in the lowest layer; of an elastic shell, at the surface"),
        surface_stress("von_mises_top", "von Mises stress in the highest layer; of an elastic shell, at the surface"),
        PLASTIC_STRAIN,
    ]],
    wanted: |model| model.output.sections.is_some() && model.has(PartKind::Shell),
    needs: Wanted::SHELLS,
    tells_failures: false,
    every_step: false,
    extent: |extent| {
        let shells = || extent.model.each::<Shell>();
        let names = shells().flat_map(|shell| std::iter::repeat_n(shell.name.as_str(), shell.elements.len()));
        let numbers = |shell: &Shell| shell.elements.len() * (10 + usize::from(shell.yielding.is_some()));
        Rows::named(names, shells().map(numbers).sum())
    },
    rows: |model| {
        let order = ShellOrder::of(model);
        Box::new(move |table, frame| write(table, &order, frame))
    },
    answers: Some(Answers { quantities, needs: Wanted::SHELLS, value }),
};

fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Shells(..) => vec![VON_MISES.name, PLASTIC_STRAIN.name],
        _ => Vec::new(),
    }
}

fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::Shells(from, to) = at else { return None };
    let of = [ShellState::von_mises, ShellState::plastic_strain][index];
    frame.derived.shells.iter().filter(|state| (from..to).contains(&state.part)).map(of).reduce(f64::max)
}

fn write(table: &mut dyn WriteRow, order: &ShellOrder, frame: &Frame) -> io::Result<()> {
    order.states(frame).try_for_each(|state| {
        let at = &state.at;
        table.row(frame.step, frame.state.time).text(frame.model.parts[state.part].name()).count(state.element);
        table
            .numbers(&at.N)
            .numbers(&at.M)
            .numbers(&at.Q)
            .numbers(&state.outer_von_mises())
            .number(state.plastic_strain())
            .end()
    })
}
