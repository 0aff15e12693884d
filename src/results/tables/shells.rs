//! shells.csv: stress resultants of the shells' elements.

use super::shell_order::ShellOrder;
use crate::extent::Rows;
use crate::table::{Answers, TableKind, WriteRow};
use base::quantities::{Column, PLASTIC_STRAIN, SHELL_RESULTANTS, VON_MISES, names};
use model::{ExpectAt, PartKind, Shell};
use solve::{Frame, ShellState, Wanted};
use std::io;

pub static TABLE: TableKind = TableKind {
    file: "shells.csv",
    about: "One row for each shell element: means over the element, per length in the initial state, in axes that turn with the \
            surface (`axis_1` of the fields). Written if `[output] sections = true` and there are shells.",
    columns: &[
        &[
            Column::key("shell", "name of the shell"),
            Column::key("element", "number of the element in its part, from 0"),
        ],
        &SHELL_RESULTANTS,
        &[PLASTIC_STRAIN],
    ],
    wanted: |model| model.output.sections.is_some() && model.has(PartKind::Shell),
    needs: Wanted::SHELLS,
    has_last: |_| true,
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
        ExpectAt::Shells(..) => names(&[&[VON_MISES, PLASTIC_STRAIN], &SHELL_RESULTANTS]),
        _ => Vec::new(),
    }
}

/// The value of the largest magnitude over the shell, with its sign.
fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::Shells(from, to) = at else { return None };
    let of = |state: &ShellState| match index {
        0 => state.von_mises(),
        1 => state.plastic_strain(),
        _ => resultants(state)[index - 2],
    };
    let all = frame.derived.shells.iter().filter(|state| (from..to).contains(&state.part)).map(of);
    all.reduce(|most, value| if value.abs() > most.abs() { value } else { most })
}

/// The values of [`SHELL_RESULTANTS`].
fn resultants(state: &ShellState) -> [f64; 10] {
    let (at, [bottom, top]) = (&state.at, state.outer_von_mises());
    let ([n1, n2, n3], [m1, m2, m3], [q1, q2]) = (at.N, at.M, at.Q);
    [n1, n2, n3, m1, m2, m3, q1, q2, bottom, top]
}

fn write(table: &mut dyn WriteRow, order: &ShellOrder, frame: &Frame) -> io::Result<()> {
    order.states(frame).try_for_each(|state| {
        table.row(frame.step, frame.state.time).text(frame.model.parts[state.part].name()).count(state.element);
        table.numbers(&resultants(state)).number(state.plastic_strain()).end()
    })
}
