//! Events that a run has met: impacts, slip, yielding, stops, breaking, and other kinks of forces. Where one falls into a step, the error of
//! the step is of first order in its length, whatever the scheme.

use super::context::Context;
use crate::system::kinks;
use base::snapshot::keep;
use mechanics::materials::Dissipation;
use mechanics::state::State;
use model::StepLength;

/// Watches for events in runs that estimate the error of their steps. Other runs are not watched.
#[derive(Default)]
pub struct Events {
    /// The branches at the beginning; `None` if the run is not watched.
    branches: Option<usize>,
    /// The dissipation before the run or stage.
    spent: Dissipation,
    met: bool,
}

keep!(Events { branches, spent, met });

impl Events {
    /// Begins with the state at the beginning of a run, or of a stage.
    pub fn begin(&mut self, cx: &Context, state: &State) {
        let tells = matches!(cx.model.analysis.step_length, StepLength::ErrorControlled { .. });
        let branches = (tells && kinks::has_kinks(cx.system)).then(|| kinks::branches(cx.system, state));
        *self = Events { branches, spent: state.work.material, met: false };
    }

    /// Looks at the state at the end of a step.
    pub fn look(&mut self, cx: &Context, state: &State) {
        if let Some(first) = self.branches.filter(|_| !self.met) {
            self.met = state.work.material != self.spent || kinks::branches(cx.system, state) != first;
        }
    }

    /// True where the run has met any.
    pub fn met(&self) -> bool {
        self.met
    }
}
