//! The march through time. `solve` shows each accepted step to an [`Observer`]; it knows nothing of files.

mod accelerate;
mod accept;
mod arc;
mod central_difference;
mod composite;
mod convergence;
mod correction;
mod derived;
mod explicit;
mod failure;
mod frame;
mod joints;
mod march;
mod motion;
mod own_length;
mod pace;
mod path;
mod refresh;
mod runge_kutta;
mod search;
mod stable;
mod start;
mod stations;
mod step;

pub use crate::system::results::{LinkState, SectionPoint, ShellState};
pub use crate::system::{ContactState, JointState};
pub use derived::{Derived, Wanted};
pub use failure::{Failure, Largest};
pub use frame::{Frame, Observer};
pub use march::{Counts, Outcome, Run};
