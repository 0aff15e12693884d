//! The largest value of each column of a table, and what another run has at its place.

use super::rows::CollectedRows;
use base::snapshot::{Keep, Snapshot, keep};

/// The number of largest magnitude in one column.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Extreme {
    /// The number, with its sign.
    pub value: f64,
    /// The time of the extreme value.
    pub time: f64,
    /// The subject of its row.
    pub label: String,
    /// The row, counted in the frame.
    pub row: usize,
    /// The number of another run at this time in this row.
    pub other: Option<f64>,
}

keep!(Extreme: Default { value, time, label, row, other });

/// The extremes of all columns with numbers, in their order; `None` where no number has come yet.
#[derive(Debug, Clone, Default)]
pub struct Extremes(pub Vec<Option<Extreme>>);

impl Keep for Extremes {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        self.0.keep(snapshot);
    }
}

impl Extremes {
    /// Takes account of the rows of a frame.
    pub fn update(&mut self, rows: &CollectedRows, time: f64) {
        let width = rows.width();
        self.0.resize(width, None);
        for (index, &value) in rows.numbers().iter().enumerate() {
            let extreme = &mut self.0[index % width];
            let larger = extreme.as_ref().is_none_or(|extreme| value.abs() > extreme.value.abs());
            if larger && value.is_finite() {
                let row = index / width;
                let mut label = extreme.take().map(|before| before.label).unwrap_or_default();
                label.clear();
                label.push_str(rows.label(row));
                *extreme = Some(Extreme { value, time, label, row, other: None });
            }
        }
    }

    /// Reads what another run has at the places of the extremes of this time, to `rounding`; it may have another mesh.
    pub fn read(&mut self, rows: &CollectedRows, time: f64, rounding: f64, same_mesh: bool) {
        for (column, extreme) in self.0.iter_mut().enumerate() {
            let Some(extreme) = extreme.as_mut().filter(|extreme| (extreme.time - time).abs() <= rounding) else {
                continue;
            };
            extreme.other = rows.find((extreme.row, &extreme.label), column, same_mesh);
        }
    }

    /// Forgets what another run has.
    pub fn forget_others(&mut self) {
        self.0.iter_mut().flatten().for_each(|extreme| extreme.other = None);
    }

    /// The times of all extremes.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        self.0.iter().flatten().map(|extreme| extreme.time)
    }
}
