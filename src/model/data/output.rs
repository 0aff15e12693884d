//! The output of a run.

/// The tables and fields that the run writes.
#[derive(Debug, Clone)]
pub struct Output {
    /// Label of the unit system.
    pub units: Option<String>,
    /// Nodes whose histories go to nodes.csv, in deck order (bodies are not among them).
    pub nodes: Vec<usize>,
    /// The times of the histories.
    pub cadence: Cadence,
    /// True where energy.csv is written.
    pub energy: bool,
    /// True where links.csv is written.
    pub links: bool,
    /// True where contacts.csv is written.
    pub contacts: bool,
    /// True where reactions.csv is written.
    pub reactions: bool,
    /// True where sections.csv is written.
    pub sections: bool,
    /// True where layers.csv is written.
    pub layers: bool,
    /// True where parts.csv is written.
    pub parts: bool,
    /// Steps between two field files; `None`: no fields.
    pub fields: Option<usize>,
}

/// The steps at which histories are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cadence {
    /// Histories are written every so many accepted steps.
    Steps(usize),
    /// Histories are written at multiples of this time, which steps hit exactly.
    Interval(f64),
}
