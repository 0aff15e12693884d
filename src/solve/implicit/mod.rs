//! Implicit steps: equilibrium is found by iteration with a matrix.

mod accept;
mod anderson;
mod arc_length;
mod augmentation;
mod beam_trees;
mod composite;
mod convergence;
mod correction;
mod ending;
mod jump;
mod lead;
mod line_search;
mod massless;
mod mechanism;
mod mode;
mod newton;
mod out_of_plane;
mod refresh;
mod runge_kutta;
mod stability;
mod stepper;
mod strained_line;
mod tangent;
mod turning;

pub use arc_length::{ArcLengthConstraint, Condition, StepMotion};
pub use newton::Newton;
pub use stepper::Implicit;
