//! What errors of steps are compared with: the largest motion so far, or ahead.

use crate::math::{Vec6, angular, linear};
use crate::model::Model;
use crate::solve::size::Size;
use crate::state::State;

/// The part of a run after which the motion speaks for itself.
const AHEAD: f64 = 0.2;
/// Motion of one kind over that of the other, over the model's length: less is rounding.
const TRACE: f64 = 1e-6;

/// Makes errors relative.
pub struct ErrorMeasure {
    /// Largest motion of the trial steps at the start, and when these were.
    ahead: Size,
    begun: Option<f64>,
    /// The largest distance in the scene: what displacements and turns are compared by.
    extent: f64,
    end_time: f64,
    /// Nodes of bodies: the errors of their rotations count.
    bodies: Vec<usize>,
}

impl ErrorMeasure {
    pub fn new(model: &Model, extent: f64) -> ErrorMeasure {
        ErrorMeasure {
            ahead: Size::default(),
            begun: None,
            extent,
            end_time: model.analysis.end_time,
            bodies: model.bodies.iter().map(|body| body.node).collect(),
        }
    }

    /// Nothing has moved yet.
    pub fn is_waiting(&self) -> bool {
        self.begun.is_none()
    }

    /// The trial steps from this time on have been taken.
    pub fn begin(&mut self, time: f64) {
        self.begun = Some(time);
    }

    /// Takes in the motion of a trial step.
    pub fn look_ahead(&mut self, model: &Model, state: &State) {
        self.ahead = self.with(self.ahead, model, state);
    }

    /// Largest displacements and turns so far, with those of a state.
    pub fn with(&self, largest: Size, model: &Model, state: &State) -> Size {
        let moved = state.nodes.iter().zip(&model.nodes).map(|(node, spec)| node.moved(&spec.x).norm());
        let turned = self.bodies.iter().map(|&body| 2.0 * state.nodes[body].rotation.imag().norm());
        Size {
            translation: moved.fold(largest.translation, f64::max),
            rotation: turned.fold(largest.rotation, f64::max),
        }
    }

    /// One length for a motion of both kinds.
    pub fn whole(&self, motion: Size) -> f64 {
        motion.translation.max(motion.rotation * self.extent)
    }

    /// Errors per node, relative to the largest motion.
    pub fn relative(&self, errors: &[Vec6], motion: Size, time: f64) -> f64 {
        let early = self.begun.is_some_and(|begun| time < begun + AHEAD * self.end_time);
        let ahead = if early { self.ahead } else { Size::default() };
        let (translation, rotation) = (motion.translation.max(ahead.translation), motion.rotation.max(ahead.rotation));
        // What is not a number must not vanish among those that are.
        let worst = |most: f64, e: f64| if e > most || e.is_nan() { e } else { most };
        let error = errors.iter().map(|e| linear(e).norm()).fold(0.0, worst);
        let turn = self.bodies.iter().map(|&body| angular(&errors[body]).norm()).fold(0.0, worst);
        // Nothing moves, nothing is wrong.
        let part = |error: f64, of: f64| if error == 0.0 { 0.0 } else { error / of };
        part(error, translation.max(TRACE * rotation * self.extent))
            .max(part(turn, rotation.max(translation / self.extent)))
    }
}
