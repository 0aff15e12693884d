//! The scale of differences in a column: the range of the column. A constant column has the largest number of its kind in the file instead.

use super::cursor::Range;
use crate::table::TableKind;
use crate::tables::{self, TABLES};

/// The kind of a column. Columns of one kind are components of one thing, or amounts that are exchanged with each other; a column
/// without a kind stands alone.
fn kind(file: &str, column: &str) -> Option<&'static str> {
    let of = |table: &TableKind| table.columns().find(|known| known.name == column).map(|known| known.kind);
    match tables::of_file(file) {
        Some(table) => of(table),
        None => TABLES.iter().copied().find_map(of),
    }
}

/// A column is constant if it varies by less than this part of the largest number of its kind: rounding of thousands of steps adds up to so
/// much.
const ROUNDING: f64 = 1e-9;

/// The scale of each column, from its range in either table.
pub fn scales(file: &str, names: &[&str], ranges: [&[Range]; 2]) -> Vec<f64> {
    let both = |i: usize| ranges[0][i].with(ranges[1][i]);
    let kinds: Vec<Option<&str>> = names.iter().map(|name| kind(file, name)).collect();
    let magnitude = |i: usize| {
        let alike = |other: &usize| *other == i || kinds[i].is_some() && kinds[*other] == kinds[i];
        (0..names.len()).filter(alike).map(|other| both(other).magnitude()).fold(0.0, f64::max)
    };
    let scale = |i: usize| {
        let largest = magnitude(i);
        let constant = ranges.iter().all(|side| side[i].width() <= ROUNDING * largest);
        if constant { largest } else { both(i).width() }
    };
    (0..names.len()).map(scale).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_counts_and_rounding_does_not() {
        let range = |least, most| Range { least, most };
        let a = [range(-1.0, 1.0), range(-1e-14, 1e-14), range(5.0, 5.0)];
        let b = [range(-1.0, 3.0), range(0.0, 0.0), range(5.5, 5.5)];
        assert_eq!(scales("nodes.csv", &["ux", "uy", "gap"], [&a, &b]), [4.0, 3.0, 5.5]);
        // Without another column, only the noise itself gives a scale.
        assert_eq!(scales("nodes.csv", &["uy"], [&a[1..2], &b[1..2]]), [2e-14]);
    }
}
