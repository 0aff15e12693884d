//! Why a step could not be taken, in names.

use crate::model::{DIRECTIONS, Model};
use std::fmt;

/// A step that was given up.
#[derive(Debug, Clone, PartialEq)]
pub enum Failure {
    /// The matrix has a vanishing pivot at this direction.
    Singular { label: String, direction: &'static str },
    /// Iterations did not contract.
    NotConverged { iterations: usize, largest: Vec<Largest> },
    /// A step of the deck needs too many pieces.
    Crawling { pieces: usize, dt: f64 },
    /// No equilibrium lies on the arc of a step.
    Bend { largest: Vec<Largest> },
    /// Nothing moves with the time that could lead on along a path.
    Idle { time: f64 },
    /// A path went on for ever.
    Endless { steps: usize },
    /// A number stopped being one.
    NotFinite { largest: Vec<Largest> },
}

/// An unbalanced force.
#[derive(Debug, Clone, PartialEq)]
pub struct Largest {
    pub label: String,
    pub direction: &'static str,
    pub residual: f64,
}

impl Failure {
    pub(super) fn singular(model: &Model, (node, dof): (usize, usize)) -> Failure {
        Failure::Singular { label: model.nodes[node].label.clone(), direction: DIRECTIONS[dof] }
    }
}

/// The five largest residuals by name.
pub(super) fn largest(model: &Model, directions: &[(usize, usize)], residual: &[f64]) -> Vec<Largest> {
    let mut order: Vec<usize> = (0..residual.len()).collect();
    let size = |i: usize| if residual[i].is_nan() { f64::INFINITY } else { residual[i].abs() };
    order.sort_by(|&a, &b| size(b).total_cmp(&size(a)));
    let name = |&i: &usize| {
        let (node, dof) = directions[i];
        Largest { label: model.nodes[node].label.clone(), direction: DIRECTIONS[dof], residual: residual[i] }
    };
    order.iter().take(5).map(name).collect()
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let list = |f: &mut fmt::Formatter, largest: &[Largest]| {
            largest.iter().try_for_each(|l| write!(f, "\n  {} {}: {:.3e}", l.label, l.direction, l.residual))
        };
        match self {
            Failure::Singular { label, direction } => write!(
                f,
                "the system is singular at `{label}` in direction {direction}: nothing holds it there (a missing support, \
                 a mechanism, a bifurcation, or a motion beyond what the model can bear)"
            ),
            Failure::NotConverged { iterations, largest } => {
                write!(f, "no convergence in {iterations} iterations; the largest unbalanced forces are")?;
                list(f, largest)
            }
            Failure::Crawling { pieces, dt } => write!(
                f,
                "the step was cut into {pieces} pieces, the last of {dt:.1e}, and has not ended: the loads are too large or \
                 `time_step` is too long for this motion"
            ),
            Failure::Bend { largest } => {
                write!(
                    f,
                    "the path of equilibria bends too sharply for the least step; the largest unbalanced forces are"
                )?;
                list(f, largest)
            }
            Failure::Idle { time } => {
                write!(f, "no load or held motion changes with the time at t = {time}: nothing leads on along the path")
            }
            Failure::Endless { steps } => write!(
                f,
                "the path came neither to `end_time` nor to `stop` in {steps} steps; `steps` ends a run earlier, or later"
            ),
            Failure::NotFinite { largest } => {
                write!(f, "the motion left the range of numbers; the largest unbalanced forces are")?;
                list(f, largest)
            }
        }
    }
}
