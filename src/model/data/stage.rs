//! A stage among those of a run.

use std::ops::Range;

/// A stage among those of a run.
#[derive(Debug, Clone)]
pub struct RunStage {
    /// The deck's name.
    pub name: String,
    /// Its index among the stages.
    pub index: usize,
    /// The number of stages.
    pub count: usize,
    /// True where the motion of a dynamic stage goes on in this one, with the same supports, joints, contacts and loads.
    pub goes_on: bool,
    /// True where the motion goes on and only loads come or go.
    pub loads_alone_change: bool,
    /// True where an earlier stage is dynamic: the initial state contains the errors of its steps.
    pub follows_motion: bool,
    /// True where residual forces at the beginning of a static stage decrease to zero over it.
    pub holds_back: bool,
    /// The amplitude of loads that first act here and have no other; a buckling stage seeks the factor of these.
    pub own_amplitude: usize,
    /// True where loads without an amplitude begin here.
    pub loads_grow: bool,
    /// The condition for an early end.
    pub stop: Option<Stop>,
}

/// A value that ends a stage.
#[derive(Debug, Clone)]
pub struct Stop {
    /// The quantity compared with the value.
    pub quantity: StopQuantity,
    /// The value, which it passes from either side.
    pub value: f64,
    /// The quantity as messages name it.
    pub label: String,
    /// True if the stage must reach it.
    pub required: bool,
}

/// The quantity that ends a stage at a value.
#[derive(Debug, Clone)]
pub enum StopQuantity {
    /// A displacement, or a component of the rotation vector, counted from t = 0: the node, and 0..6 for ux, uy, uz, rx, ry, rz.
    Displacement([usize; 2]),
    /// Work that loads and supports have done since the stage began.
    Work(Actors),
    /// The magnitude of the sum of their forces.
    Force(Actors),
}

/// The loads and prescribed motions of one name.
#[derive(Debug, Clone, Default)]
pub struct Actors {
    /// Indices into [`super::Loading::nodal`].
    pub nodal: Range<usize>,
    /// Indices into [`super::Loading::pressures`].
    pub pressures: Range<usize>,
    /// Indices into [`super::Loading::centrifugal`].
    pub centrifugal: Range<usize>,
    /// Node and degree of freedom of restraints whose motion is prescribed.
    pub motions: Vec<[usize; 2]>,
    /// True for loads that did not act in the stage before.
    pub are_new: bool,
}
