//! Controllers whose steps follow a tolerance.

use crate::solve::context::Context;
use crate::state::State;

/// A controller that can run again with another tolerance.
pub trait FollowTolerance {
    /// Prepares for a run with this tolerance of the error of its steps, none of which is longer than `longest`; `None`: as long as the
    /// controller allows. It forgets what the iteration has learnt in earlier runs.
    fn follow(&mut self, cx: &Context, tolerance: f64, longest: Option<f64>);
}

/// True where something failed in a step from a state to the next, and the step is too long for the time of that: it may err by the
/// `tolerance` times the duration of the run, over which motions err by the same part. The step is then to be taken in halves.
pub fn fails_late(cx: &Context, [before, after]: [&State; 2], tolerance: f64) -> bool {
    let dt = after.time - before.time;
    let analysis = &cx.model.analysis;
    after.work.material.eroded != before.work.material.eroded
        && dt > (tolerance * analysis.duration()).max(2.0 * analysis.least_step)
}
