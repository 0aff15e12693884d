//! What a study has found.

use super::grid::StudyGrid;
use super::order::{Cheapest, Order};
use super::reference::Reference;
use super::run::StudyRun;
use crate::model::study::Quantity;

/// A study that has been run.
pub struct Found {
    pub title: String,
    pub deck: String,
    pub quantities: Vec<Quantity>,
    pub grid: StudyGrid,
    /// By line, longest time step first.
    pub runs: Vec<StudyRun>,
    /// Or why there is none, in words.
    pub reference: Result<Reference, String>,
    /// Of each line; or why there is none, in words.
    pub orders: Vec<Result<Order, &'static str>>,
    /// For each error asked for, by cost; empty where no line comes to it.
    pub cheapest: Vec<(f64, Vec<Cheapest>)>,
    /// A signal ended it.
    pub stopped: bool,
}
