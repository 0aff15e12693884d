//! Links by full matrices: their rows, and their speeds.

use super::line_keys::of_lines;
use crate::data::LinkKind;
use crate::places::axes::axes;
use crate::report::{Owner, Report};
use crate::values::keys;
use base::diagnostic::At;
use base::math::{Mat3, Mat6};
use deck::links as words;
use deck::words::{Maybe, Table};
use mechanics::elements::bearing::BearingMatrices;

/// The place of the rotation about the first axis.
const SPIN: usize = 3;

/// A link by its `matrices`.
pub fn bearing<'d>(
    owner: &Owner<'d>,
    link: &'d words::Link,
    list: &'d At<Vec<At<Table<words::LinkMatrices>>>>,
    report: &mut Report<'d>,
) -> Option<LinkKind> {
    report.reject_unused("a link with `matrices`", &of_lines(link));
    report.reject_unused("a link with `matrices`", &keys!(link; bushing, bushing_damping, failure));
    if list.value.is_empty() {
        let hint = "give one table, such as [{ stiffness = [[1e7, 2e6], [-2e6, 1e7]] }]";
        return report.error_with(&list.span, "`matrices` is empty", hint);
    }
    let axes = match &link.axes {
        Some(table) => axes(table, report)?,
        None => Mat3::identity(),
    };
    let mut matrices: Vec<BearingMatrices> = Vec::new();
    for At { value: table, span: place } in &list.value {
        if list.value.len() > 1 && table.speed.is_none() {
            let hint = "give each its angular velocity, in ascending order";
            report.error_with::<()>(place, "several `matrices` need `speed`", hint);
        }
        let speed = report.not_negative("speed", &table.speed, 0.0);
        if let (Some(before), Some(given)) = (matrices.last(), &table.speed)
            && speed <= before.speed
        {
            report.error_with::<()>(
                &given.span,
                "the speeds of `matrices` do not rise",
                "put the tables in ascending order",
            );
        }
        report.require(owner, "stiffness", &table.stiffness);
        let [stiffness, damping] =
            [("stiffness", &table.stiffness), ("damping", &table.damping)].map(|(key, rows)| matrix(key, rows, report));
        matrices.push(BearingMatrices { speed, stiffness: stiffness?, damping: damping? });
    }
    Some(LinkKind::Bearing { matrices, axes })
}

/// The matrix of all six components by its rows: two, three or six of as many numbers. Zero where it is not given.
fn matrix(key: &str, rows: &Maybe<Vec<At<Vec<f64>>>>, report: &mut Report) -> Option<Mat6> {
    let Some(At { value: rows, span: place }) = rows else { return Some(Mat6::zeros()) };
    let n = rows.len();
    let first = match n {
        2 => 1,
        3 | 6 => 0,
        _ => {
            let hint = "two rows are for y and z, three for x, y and z, six for rotations too";
            return report.error_with(place, format!("`{key}` has {n} rows, and takes 2, 3 or 6"), hint);
        }
    };
    if let Some(row) = rows.iter().find(|row| row.value.len() != n) {
        let message = format!("a row of `{key}` has {} numbers, and there are {n} rows", row.value.len());
        return report.error_with(&row.span, message, format!("give {n} numbers"));
    }
    let mut all = Mat6::zeros();
    for (i, row) in rows.iter().enumerate() {
        for (j, value) in row.value.iter().enumerate() {
            all[(first + i, first + j)] = *value;
        }
    }
    let about_shaft = |k: usize| all[(SPIN, k)] != 0.0 || all[(k, SPIN)] != 0.0;
    if let Some(row) = rows.get(SPIN)
        && (0..6).any(about_shaft)
    {
        let hint = "put 0 in the fourth row and column, and a second link with `bushing` beside it";
        return report.error_with(
            &row.span,
            format!("`{key}` acts on rotation about the first axis, which is free"),
            hint,
        );
    }
    Some(all)
}
