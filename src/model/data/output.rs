//! What a run writes.

/// What the run writes.
#[derive(Debug, Clone)]
pub struct Output {
    /// Label of the unit system.
    pub units: Option<String>,
    /// Nodes whose histories go to nodes.csv, in deck order (bodies are not among them).
    pub nodes: Vec<usize>,
    pub cadence: Cadence,
    pub energy: bool,
    pub links: bool,
    pub contacts: bool,
    pub reactions: bool,
    pub sections: bool,
    pub layers: bool,
    pub parts: bool,
    /// Steps between two field files; `None`: no fields.
    pub fields: Option<usize>,
}

/// At which steps histories are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cadence {
    /// Every so many accepted steps.
    Steps(usize),
    /// At multiples of this time; steps land on them.
    Interval(f64),
}
