//! Values that a run must reach.

use super::passage::Passage;
use crate::deck::parts::PartIndex;

/// A value that the run must reach.
#[derive(Debug, Clone)]
pub struct Expect {
    pub at: ExpectAt,
    pub quantity: String,
    pub when: When,
    pub value: f64,
    pub tolerance: Tolerance,
    pub source: String,
    /// As written in the deck, for the message.
    pub label: String,
}

/// Where an expected value is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ExpectAt {
    /// The time, which follows where the path is followed by arc length.
    Analysis,
    Node(usize),
    /// Columns of energy.csv.
    Energy,
    /// Columns of the table of links or of contacts, and the magnitude of the force of a contact.
    Part(PartIndex),
    /// Force and moment on the first end of a joint.
    Joint(usize),
    /// Largest values over the shells from one place in [`Model::parts`] to before another: of von Mises stress and plastic strain.
    Shells(usize, usize),
    /// The largest plastic strain of elements, from one to before another, counted through all beams, then all bars.
    Elements(usize, usize),
}

/// At which instant an expected value is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum When {
    /// With arc-length: the first time the load comes to it, from below.
    Time(f64),
    /// With arc-length alone.
    Passing(Passage),
    Max,
    Min,
    /// Greatest absolute value.
    Abs,
}

/// How far a value may lie from the expected one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    Relative(f64),
    Absolute(f64),
    /// The value is a bound.
    AtLeast,
    AtMost,
}
