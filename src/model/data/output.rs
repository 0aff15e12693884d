//! The output of a run.

use super::step_length::StepLength;
use deck::output::{ContactRows, SectionPlaces};

/// What stands between the names of the sets of a node.
pub const BETWEEN_SETS: &str = "|";

/// The ends of the names of the rows of an envelope: of the greatest and of the least values.
pub const ENVELOPE_ENDS: [&str; 2] = [".max", ".min"];

/// The tables and fields that the run writes.
#[derive(Debug, Clone)]
pub struct Output {
    /// Label of the unit system.
    pub units: Option<String>,
    /// Nodes whose histories go to nodes.csv, in deck order (bodies are not among them).
    pub nodes: Vec<usize>,
    /// For each of them the names under which `[output] nodes` lists it; empty if it lists points alone, or all.
    pub sets: Vec<String>,
    /// The relative displacements in drifts.csv, in deck order.
    pub drifts: Vec<Drift>,
    /// The times of the histories.
    pub cadence: Cadence,
    /// True where the deck does not give these times.
    pub cadence_is_open: bool,
    /// True where energy.csv is written.
    pub energy: bool,
    /// True where links.csv is written.
    pub links: bool,
    /// The rows of the contact tables; `None` without these tables.
    pub contacts: Option<ContactRows>,
    /// True where reactions.csv is written.
    pub reactions: bool,
    /// The places of beams that sections.csv is about; `None`: neither it nor the tables of bars and shells are written.
    pub sections: Option<SectionPlaces>,
    /// True where something in the deck may fail; tables then have columns for it.
    pub failures: bool,
    /// True where layers.csv is written.
    pub layers: bool,
    /// True where parts.csv is written.
    pub parts: bool,
    /// True where joints.csv is written.
    pub joints: bool,
    /// The field files; `None`: no fields.
    pub fields: Option<FieldFiles>,
    /// Seconds of run time between two checkpoints; `None`: only when the run is stopped.
    pub checkpoint: Option<f64>,
}

/// The displacement of a node relative to another.
#[derive(Debug, Clone, PartialEq)]
pub struct Drift {
    /// Its name.
    pub name: String,
    /// The node that it is relative to, and the node whose displacement it is.
    pub ends: [usize; 2],
}

/// The field files of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldFiles {
    /// Their times.
    pub cadence: Cadence,
    /// Their format.
    pub format: FieldFormat,
}

/// The format of field files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FieldFormat {
    /// Grids of VTK, a file for each time.
    #[default]
    Vtu,
    /// One file as CalculiX writes it.
    Frd,
}

/// The times of output to histories or fields; t = 0 and the end are always among them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cadence {
    /// Every so many accepted steps.
    Steps(usize),
    /// At multiples of this time; steps hit them exactly.
    Interval(f64),
    /// At the first step that ends this time or more after the last output.
    Apart(f64),
}

impl Cadence {
    /// A cadence of at most `times` outputs and at least two fifths of them, in a run of given length. It counts steps if their length is
    /// fixed, and time otherwise. Every step is written in shorter runs, and along a path, because its length is unknown.
    pub fn at_most(times: f64, end_time: f64, step_length: &StepLength) -> Cadence {
        match step_length {
            StepLength::Fixed { step } => Cadence::Steps(round_up(end_time / step / times)),
            StepLength::ArcLength(_) => Cadence::Steps(1),
            StepLength::ErrorControlled { .. } | StepLength::StabilityLimited { .. } => {
                Cadence::Apart(end_time / times)
            }
        }
    }
}

/// The next of 1, 2, 5, 10, 20, … that is not below a number.
pub fn round_up(number: f64) -> usize {
    // A rounding error beyond a whole number is none.
    let reaches = |round: f64| round >= number * (1.0 - 1e-9);
    let mut power = 1.0;
    while power < 1e15 {
        if let Some(factor) = [1.0, 2.0, 5.0].into_iter().find(|factor| reaches(factor * power)) {
            return (factor * power) as usize;
        }
        power *= 10.0;
    }
    power as usize
}
