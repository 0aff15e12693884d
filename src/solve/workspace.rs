//! What a step writes to, as plain data: allocated once, with no behaviour of its own.

use super::context::{self, Context};
use super::linear_system::LinearSystem;
use crate::linear::TooLarge;
use crate::state::{Increment, Node};
use crate::system::{Forces, Loading, Prescribed};

/// The numbers of the step at hand.
pub struct Workspace {
    /// The motion at the instant of equilibrium, later that at the end of the step; by node.
    pub trial: Vec<Node>,
    /// The motion from the start of the step, with its rates; by node.
    pub increments: Vec<Increment>,
    /// What material points will remember at the end of the step.
    pub history: Vec<f64>,
    /// Residual forces of the trial motion, and the multipliers of joints.
    pub forces: Forces,
    /// The residual, then the correction; by unknown.
    pub r: Vec<f64>,
    pub loads: AtTimes<Loading>,
    /// Displacements, velocities and accelerations of prescribed directions, in the order of the model's list.
    pub prescribed: AtTimes<Vec<Prescribed>>,
    /// The largest coordinate of a node at the start of the step, counted from the first node at t = 0: what distances are rounded
    /// against.
    pub reach: f64,
    /// The matrix of the step: of its tangent, or of the masses.
    pub matrix: LinearSystem,
    pub factorizations: usize,
    pub solves: usize,
    /// The largest departure from orthogonality that a truncated rotation update left to be mended, over all steps.
    pub rotation_drift: f64,
    /// The largest gap of a joint that the end of a step was left with, relative to the reach, over all steps.
    pub joint_violation: f64,
}

/// Something that is given over time, at the times that count in a step.
#[derive(Default)]
pub struct AtTimes<T> {
    pub start: T,
    pub end: T,
    /// The instant where equilibrium is written.
    pub instant: T,
}

impl Workspace {
    /// # Errors
    /// There is no memory for the solver.
    pub fn new(cx: &Context) -> Result<Workspace, TooLarge> {
        let n = cx.model.nodes.len();
        let (solver, assembly) = cx.plan.build(cx.system)?;
        Ok(Workspace {
            trial: context::at_rest(cx.model),
            increments: vec![Increment::ZERO; n],
            history: vec![0.0; cx.system.history],
            forces: Forces::new(cx.system, n).on_threads(cx.plan.threads),
            r: vec![0.0; cx.plan.dofs.unknowns()],
            loads: AtTimes::default(),
            prescribed: AtTimes::default(),
            reach: cx.length,
            matrix: LinearSystem { solver, assembly },
            factorizations: 0,
            solves: 0,
            rotation_drift: 0.0,
            joint_violation: 0.0,
        })
    }
}
