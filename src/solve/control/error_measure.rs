//! The reference of errors: the largest motion so far, or that of trial steps ahead.

use crate::step::size::{ModelSize, Size};
use crate::tolerances::error_measure::{AHEAD, TRACE};
use base::math::{Vec6, angular, linear};
use base::snapshot::keep;
use mechanics::state::State;
use model::Model;

/// The measure that makes errors relative.
pub struct ErrorMeasure {
    /// Largest motion of the trial steps, and the time of these steps.
    ahead: Size,
    begun: Option<f64>,
    /// The largest distance in the scene, the scale between displacements and rotations.
    length: f64,
    /// The least motion that errors are relative to.
    least: Size,
    end_time: f64,
    /// The nodes of bodies: errors of their rotations count.
    bodies: Vec<usize>,
    /// The nodes whose displacements are numbers, such as angles.
    numbers: Vec<usize>,
}

keep!(ErrorMeasure { ahead, begun } without { length, least, end_time, bodies, numbers });

impl ErrorMeasure {
    /// A measure for this model and this relative error.
    pub fn new(model: &Model, size: ModelSize, error: f64) -> ErrorMeasure {
        ErrorMeasure {
            ahead: Size::default(),
            begun: None,
            length: size.length,
            least: size.least_motion(error),
            end_time: model.analysis.duration(),
            bodies: model.bodies.iter().map(|body| body.node).collect(),
            numbers: model.number_nodes().collect(),
        }
    }

    /// The motion of a model at rest. Rounding moves it too, and errors relative to that have no meaning.
    pub fn at_rest(&self) -> Size {
        self.least
    }

    /// True where motion begins with this one.
    pub fn begins_with(&self, motion: Size) -> bool {
        self.begun.is_none() && motion != self.least
    }

    /// Records that the trial steps from this time on are complete.
    pub fn begin(&mut self, time: f64) {
        self.begun = Some(time);
    }

    /// Includes the motion of a trial step in the reference.
    pub fn look_ahead(&mut self, model: &Model, state: &State) {
        self.ahead = self.with(self.ahead, model, state);
    }

    /// The largest displacements and rotations so far, including those of a state.
    pub fn with(&self, largest: Size, model: &Model, state: &State) -> Size {
        let nodes = state.nodes.iter().zip(&model.nodes).enumerate();
        let nodes = nodes.filter(|(node, _)| self.numbers.is_empty() || !self.numbers.contains(node));
        let moved = nodes.map(|(_, (node, spec))| node.moved(&spec.x).norm());
        let turned = self.bodies.iter().map(|&body| 2.0 * state.nodes[body].rotation.imag().norm());
        Size {
            translation: moved.fold(largest.translation, f64::max),
            rotation: turned.fold(largest.rotation, f64::max),
        }
    }

    /// The size of a motion as one length.
    pub fn whole(&self, motion: Size) -> f64 {
        motion.translation.max(motion.rotation * self.length)
    }

    /// The motion that errors at this time are relative to.
    pub fn reference(&self, motion: Size, time: f64) -> Size {
        let early = self.begun.is_some_and(|begun| time < begun + AHEAD * self.end_time);
        let ahead = if early { self.ahead } else { Size::default() };
        motion.max(ahead)
    }

    /// The largest of the errors by node, relative to the largest motion.
    pub fn relative(&self, errors: &[Vec6], motion: Size, time: f64) -> f64 {
        let Size { translation, rotation } = self.reference(motion, time);
        // A NaN must not vanish in the maximum.
        let worst = |most: f64, e: f64| if e > most || e.is_nan() { e } else { most };
        let error = errors.iter().map(|e| linear(e).norm()).fold(0.0, worst);
        let turn = self.bodies.iter().map(|&body| angular(&errors[body]).norm()).fold(0.0, worst);
        // Nothing moves, so nothing is wrong.
        let part = |error: f64, of: f64| if error == 0.0 { 0.0 } else { error / of };
        part(error, translation.max(TRACE * rotation * self.length))
            .max(part(turn, rotation.max(translation / self.length)))
    }
}
