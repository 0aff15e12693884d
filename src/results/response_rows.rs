//! Values and rows of the tables of a frequency response.

use crate::table::WriteRow;
use model::{ExpectAt, OverFrequencies, ResponseOf};
use solve::Frame;
use solve::modes::{Response, ResponseRow};
use std::io;

/// The value of a column of a response at its frequency, or its extreme.
pub fn value(at: ExpectAt, index: usize, frame: &Frame) -> Option<f64> {
    let ExpectAt::Response(of, over) = at else { return None };
    let response = frame.modes?.response.as_ref()?;
    let of = |row: &ResponseRow| response.amplitudes(row, of).map(|values| values[index]);
    let all = || response.rows.iter().filter_map(of);
    // Where nothing limits the motion there is no largest.
    let unlimited = all().any(|value| !value.is_finite());
    let finite = || all().filter(|value| value.is_finite());
    match over {
        OverFrequencies::Max | OverFrequencies::Abs if unlimited => None,
        OverFrequencies::At(frequency) => {
            response.rows.iter().find(|row| row.frequency == frequency).and_then(of).filter(|value| value.is_finite())
        }
        OverFrequencies::Max => finite().max_by(f64::total_cmp),
        OverFrequencies::Min => finite().min_by(f64::total_cmp),
        OverFrequencies::Abs => finite().max_by(|a, b| a.abs().total_cmp(&b.abs())),
    }
}

/// Writes the rows of a frequency, one for each of `named`.
///
/// # Errors
/// Errors of writing.
pub fn write(
    table: &mut dyn WriteRow,
    frame: &Frame,
    (response, row): (&Response, &ResponseRow),
    named: &[(&str, ResponseOf)],
) -> io::Result<()> {
    for &(name, of) in named {
        let Some(values) = response.amplitudes(row, of) else { continue };
        let mut out = table.row(frame.step, frame.state.time).number(row.frequency).text(name);
        for value in values {
            out = if value.is_finite() { out.number(value) } else { out.text("") };
        }
        out.end()?;
    }
    Ok(())
}
