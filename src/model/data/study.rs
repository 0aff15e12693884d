//! What `rdsolve study` goes over.

use crate::deck::analysis::Method;
use crate::integrators::Scheme;
use std::sync::Arc;

/// What is gone over, and what errors are measured on.
#[derive(Debug, Clone, Default)]
pub struct Study {
    /// Empty: displacements of all nodes in nodes.csv and of all bodies.
    pub quantities: Vec<Quantity>,
    /// File as the deck names it.
    pub reference: Option<String>,
    /// Of each quantity: its column in that file.
    pub columns: Vec<String>,
    /// Intervals; `None`: as the reference has them, or 200.
    pub samples: Option<usize>,
    /// Longest first; empty: from the deck's own.
    pub time_steps: Vec<f64>,
    /// Of an automatic step, largest first; empty: none, unless the deck's step is one.
    pub error_tolerances: Vec<f64>,
    /// Of the one time step.
    pub halvings: usize,
    /// Empty: the deck's own.
    pub schemes: Vec<Choice>,
    /// Empty: the deck's own.
    pub methods: Vec<Method>,
    /// Factors on numbers of elements, rising; empty: 1.
    pub meshes: Vec<f64>,
    /// Largest first; empty: 1e-2, 1e-3, 1e-4.
    pub wanted_errors: Vec<f64>,
}

/// One number of one node at every time.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// As `output.nodes` and the deck name it.
    pub name: String,
    /// As nodes.csv or bodies.csv has it.
    pub label: String,
    /// In bodies.csv.
    pub body: bool,
    /// A column of [`crate::quantities::MOTION`], or one that follows from it.
    pub column: &'static str,
}

impl Quantity {
    /// "tip.uz".
    pub fn word(&self) -> String {
        format!("{}.{}", self.name, self.column)
    }
}

/// A scheme with its parameters.
#[derive(Debug, Clone)]
pub struct Choice {
    /// "newmark:gamma=0.6".
    pub label: String,
    pub scheme: Arc<dyn Scheme>,
    /// The table `[integrator]` that asks for it, in line.
    pub table: String,
}
