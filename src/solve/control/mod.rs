//! Control of the step length: each method has its own controller, which drives its stepper through the run.

mod adaptive;
mod arc_length;
mod controller;
mod embedded_error;
mod end_at_stop;
mod error_controlled;
mod error_measure;
mod fixed;
mod intervals;
mod lasting_error;
mod stability_limited;
mod targets;
mod tolerance;

pub use controller::Controller;
pub use intervals::{COMPARISONS, Interval, Schedule, comparison_time, comparison_times};
