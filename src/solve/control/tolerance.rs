//! Controllers whose steps follow a tolerance.

use crate::context::Context;
use crate::system::kinks;
use crate::tolerances::tolerance::LONGEST_WITH_EVENT;
use base::snapshot::keep;
use mechanics::state::State;

/// A controller that can run again with another tolerance.
pub trait FollowTolerance {
    /// Prepares for a run with this error tolerance and with steps no longer than `longest`; with `None` only the controller limits the
    /// length. Statistics of the iteration from earlier runs are discarded.
    fn follow(&mut self, cx: &Context, tolerance: f64, longest: Option<f64>);
}

/// Finds steps that are too long for an event inside them.
#[derive(Debug, Clone, Copy, Default)]
pub struct EventLimit {
    /// True if material flows, and if contacts slip, in the last accepted step.
    flows: [bool; 2],
}

keep!(EventLimit { flows });

impl EventLimit {
    /// True where the step from a state to the next is to be taken in halves. A failure inside the step may be late by `tolerance` times
    /// the duration of the run, which shifts motions by the same part. Other events change only the slope of forces.
    pub fn is_passed(&self, cx: &Context, [before, after]: [&State; 2], tolerance: f64) -> bool {
        let (dt, analysis) = (after.time - before.time, &cx.model.analysis);
        let longer_than = |part: f64| dt > (part * analysis.duration()).max(2.0 * analysis.least_step);
        if after.work.material.eroded != before.work.material.eroded && longer_than(tolerance) {
            return true;
        }
        longer_than(LONGEST_WITH_EVENT * tolerance.sqrt())
            && kinks::has_kinks(cx.system)
            && (self.flows_otherwise(cx, flows(before, after))
                || kinks::branches(cx.system, before) != kinks::branches(cx.system, after))
    }

    /// True where flow begins or ends.
    fn flows_otherwise(&self, cx: &Context, [yields, slips]: [bool; 2]) -> bool {
        slips != self.flows[1] || yields != self.flows[0] && kinks::yields_at_once(cx.system)
    }

    /// Records the flow of an accepted step.
    pub fn accept(&mut self, [before, after]: [&State; 2]) {
        self.flows = flows(before, after);
    }
}

fn flows(before: &State, after: &State) -> [bool; 2] {
    let [before, after] = [before, after].map(|state| &state.work.material);
    [(after.plastic, after.viscous) != (before.plastic, before.viscous), after.friction != before.friction]
}
