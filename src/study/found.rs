//! The outcome of a study.

use super::asked::Asked;
use super::cheapest::Cheapest;
use super::grid::StudyGrid;
use super::order::Order;
use super::reference::Reference;
use super::run::StudyRun;
use model::study::Quantity;

/// A study that has been run.
pub struct Found {
    /// The title of the deck, or its path where it has none.
    pub title: String,
    /// The path of the deck, as it was given.
    pub deck: String,
    /// The quantities that errors are measured on.
    pub quantities: Vec<Quantity>,
    /// The settings that were asked for.
    pub grid: StudyGrid,
    /// The runs that came to be, line by line, each from the longest time step down.
    pub runs: Vec<StudyRun>,
    /// The reference of the errors, or in words why there is none.
    pub reference: Result<Reference, String>,
    /// The measured order of each line; or in words why it has none.
    pub orders: Vec<Result<Order, &'static str>>,
    /// For each error asked for, the lines that come to it, the cheapest first.
    pub cheapest: Vec<(f64, Vec<Cheapest>)>,
    /// Requested and reached errors of automatic steps.
    pub asked: Vec<Asked>,
    /// True where a signal has ended it before all runs were done.
    pub stopped: bool,
}
