//! The variants that `rdsolve study` runs.

use deck::analysis::Method;
use mechanics::integrators::Scheme;
use std::sync::Arc;

/// The schemes, methods, steps and meshes to be compared, and the quantities whose errors are measured.
#[derive(Debug, Clone, Default)]
pub struct Study {
    /// Quantities whose errors are measured; if empty, displacements of all nodes in nodes.csv and of all bodies.
    pub quantities: Vec<Quantity>,
    /// The reference file as the deck names it.
    pub reference: Option<String>,
    /// The column of each quantity in that file.
    pub columns: Vec<String>,
    /// Number of sampling intervals; `None`: those of the reference, or 200.
    pub samples: Option<usize>,
    /// Time steps, longest first; if empty, from the deck's own.
    pub time_steps: Vec<f64>,
    /// Error tolerances of automatic steps, largest first; if empty, none unless the deck's step is automatic.
    pub error_tolerances: Vec<f64>,
    /// Number of halvings of the one time step.
    pub halvings: usize,
    /// The scheme.
    ///
    /// Schemes; if empty, the deck's own.
    pub schemes: Vec<Choice>,
    /// Iteration methods; if empty, the deck's own.
    pub methods: Vec<Method>,
    /// Tolerances of the iteration, largest first; if empty, the deck's own.
    pub iteration_tolerances: Vec<f64>,
    /// Factors on numbers of elements, ascending; if empty, 1.
    pub meshes: Vec<f64>,
    /// Polynomial degrees of the elements of all beams, ascending; if empty, the deck's own.
    pub beam_orders: Vec<u64>,
    /// Error levels for the search of the cheapest variant, largest first; if empty, 1e-2, 1e-3, 1e-4.
    pub wanted_errors: Vec<f64>,
}

/// One component of the motion of one node at all times.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// Name of the node as `output.nodes` and the deck give it.
    pub name: String,
    /// Name as nodes.csv or bodies.csv gives it.
    pub label: String,
    /// True for a body, whose motion is in bodies.csv.
    pub body: bool,
    /// Column of [`base::quantities::MOTION`], or one that follows from it.
    pub column: &'static str,
}

impl Quantity {
    /// The quantity in a word, like "tip.uz".
    pub fn word(&self) -> String {
        format!("{}.{}", self.name, self.column)
    }
}

/// A scheme with its parameters.
#[derive(Debug, Clone)]
pub struct Choice {
    /// Label like "newmark:gamma=0.6".
    pub label: String,
    /// The scheme itself.
    pub scheme: Arc<dyn Scheme>,
    /// The table `[integrator]` for it, on one line.
    pub table: String,
}
