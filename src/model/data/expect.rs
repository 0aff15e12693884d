//! Values that a run is expected to reach.

use super::displacement_target::DisplacementTarget;
use deck::parts::PartIndex;

/// An expected value, checked at the end of the run.
#[derive(Debug, Clone)]
pub struct Expect {
    /// Its index among those of the deck.
    pub index: usize,
    /// The object.
    pub at: ExpectAt,
    /// Name of the quantity.
    pub quantity: String,
    /// The instant.
    pub when: When,
    /// The expected value.
    pub value: f64,
    /// The tolerance.
    pub tolerance: Tolerance,
    /// Source of the value, such as author, year and figure.
    pub source: String,
    /// Label as the deck writes it, for the message.
    pub label: String,
}

/// The object whose quantity is expected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ExpectAt {
    /// The analysis itself: the time, which follows along a path.
    Analysis,
    /// The motion of a node, or of a body by its node.
    Node(usize),
    /// The reactions of a set, summed over its nodes: by the place of [`super::Constraints::sums`].
    Reactions(usize),
    /// Columns of energy.csv.
    Energy,
    /// Columns of modes.csv, of the mode at this place of its list.
    Mode(usize),
    /// Columns of response.csv or response_links.csv, at one frequency or the extreme over all.
    Response(ResponseOf, OverFrequencies),
    /// Columns of the table of links or of contacts, and the magnitude of the force of a contact.
    Part(PartIndex),
    /// Columns of drifts.csv, by the place in [`super::Output::drifts`].
    Drift(usize),
    /// Columns of critical_speeds.csv, of the speed at this place of its list.
    CriticalSpeed(usize),
    /// Force and moment on the first end of a joint.
    Joint(usize),
    /// Columns of ties.csv, by the place in [`super::Constraints::ties`].
    Tie(usize),
    /// Largest values over the shells from one place in [`Model::parts`] to before another: of von Mises stress and plastic strain.
    Shells(usize, usize),
    /// A beam by its place in [`super::Model::parts`]: of forces and moments in its sections those of the largest magnitude, and its largest
    /// plastic strain.
    Sections(usize),
    /// The largest plastic strain of elements, from one to before another, counted through all beams, then all bars.
    Elements(usize, usize),
}

/// The object whose steady response is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResponseOf {
    /// A node, or a body by its node.
    Node(usize),
    /// The force of a link, by its place among all links.
    LinkForce(usize),
}

/// The frequency for reading a response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OverFrequencies {
    /// This one.
    At(f64),
    /// The frequency of the greatest value.
    Max,
    /// The frequency of the least value.
    Min,
    /// The frequency of the greatest absolute value.
    Abs,
}

/// The instant for reading the value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum When {
    /// At this time; along a path, when the load reaches it for the first time from below.
    Time(f64),
    /// In the case at this place of the model's list.
    Case(usize),
    /// When a displacement passes its target, along a path.
    Target(DisplacementTarget),
    /// At the end of the run, or of the stage that the deck names.
    End,
    /// The greatest value of the run, with its sign.
    Max,
    /// The least value of the run, with its sign.
    Min,
    /// The largest absolute value of the run.
    Abs,
}

/// The tolerance of an expected value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    /// The largest difference, as a part of the expected value.
    Relative(f64),
    /// The largest difference, in the unit of the value.
    Absolute(f64),
    /// The expected value is a lower bound.
    AtLeast,
    /// The expected value is an upper bound.
    AtMost,
}
