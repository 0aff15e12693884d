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
mod equilibrium;
mod iteration_matrix;
mod jump;
mod lead;
mod line_search;
mod massless;
mod mechanism;
mod mechanism_watch;
mod mode;
mod newton;
mod out_of_plane;
mod refresh;
mod runge_kutta;
mod stability;
mod stabilization;
mod step_progress;
mod stepper;
mod strained_line;
mod tangent;
mod turning;

pub use arc_length::{ArcLengthConstraint, Condition, StepMotion};
pub use equilibrium::EquilibriumSolver;
pub use iteration_matrix::IterationMatrix;
pub use stepper::Implicit;
