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
    /// True where the motion of a dynamic stage goes on in this one, with all that holds, joins, touches or loads the scene.
    pub goes_on: bool,
    /// True where it does but for loads that come or go.
    pub loads_alone_change: bool,
    /// True where forces that a static stage finds out of balance at its beginning go to zero over it.
    pub holds_back: bool,
    /// The amplitude of loads that first act here and have none of their own; a buckling stage seeks the factor of these.
    pub own_amplitude: usize,
    /// What ends it before its time.
    pub stop: Option<Stop>,
}

/// A value at which a stage ends.
#[derive(Debug, Clone)]
pub struct Stop {
    /// The quantity that comes to the value.
    pub quantity: StopQuantity,
    /// The value, which it passes from either side.
    pub value: f64,
    /// The quantity as messages name it.
    pub label: String,
}

/// The quantity at a value of which a stage ends.
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
    /// Node and degree of freedom of restraints whose motion is prescribed.
    pub motions: Vec<[usize; 2]>,
    /// True for loads that did not act in the stage before.
    pub are_new: bool,
}
