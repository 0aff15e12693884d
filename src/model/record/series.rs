//! The selection from a record, and the time series of its file.

use super::unit::RecordUnit;

/// A column of a record.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RecordColumn {
    /// By its name in the line of names.
    Name(String),
    /// By its number, counted from 1.
    Number(u64),
}

/// The part of a record that is wanted.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordSelection {
    /// The columns of time and value, or of the value alone; empty if the file has no others.
    pub columns: Vec<RecordColumn>,
    /// The time between two values, the first at 0; `None` where the file has the times or says their distance.
    pub time_step: Option<f64>,
    /// Whether values follow one another along the lines; `None` where the header of the file says it.
    pub rows: Option<bool>,
    /// The unit of the times wanted, in seconds; `None` for times as the file has them.
    pub time_unit: Option<f64>,
}

/// A record as its file has it.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeSeries {
    /// The points (time, value), times in the unit of the selection where the file names its own.
    pub points: Vec<[f64; 2]>,
    /// The unit of the values, where the header names one.
    pub unit: Option<RecordUnit>,
    /// The offset of the instrument that was subtracted from all values, in their unit.
    pub offset: Option<f64>,
    /// The number of values per line, if the lines look like one sequence and the column is only a part of it.
    pub sequence: Option<usize>,
    /// The unit of the times in the file, where it is not the one wanted.
    pub times: Option<UnitOfTimes>,
}

/// A unit of times that a file names.
#[derive(Debug, Clone, PartialEq)]
pub enum UnitOfTimes {
    /// So many seconds; the times are converted.
    Converted(f64),
    /// No unit of time; the times are as the file has them.
    Unknown(String),
}
