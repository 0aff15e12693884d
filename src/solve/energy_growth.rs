//! Whether central differences make energy: nothing else tells of motion that grows though the scene as it lies is stable.

use super::failure::Failure;
use crate::integrators::Stepping;
use crate::model::{AnalysisKind, Model, Part};
use crate::plan::Plan;
use crate::state::State;
use crate::system::System;
use crate::system::energy::{Balance, Energy};

/// The balance of energies of a motion in time. In statics the work of a step is that of its ends, whatever lies between.
#[derive(Default)]
pub struct EnergyGrowth {
    pub balance: Balance,
    /// More energy was made than there was, when last looked at.
    growing: bool,
}

impl EnergyGrowth {
    /// Sums the balance up; `energy` is that of the state, where it is known. Central differences that have made more than there
    /// was have failed; while there is next to nothing yet that says little, unless it is by far. What there was does not depend on
    /// the times of output: work is looked at in every step, and energies are where links may let some go.
    pub fn check(
        &mut self,
        (model, plan, system): (&Model, &Plan, &System),
        state: &State,
        energy: Option<Energy>,
        initial: Option<f64>,
        last: bool,
    ) -> Option<Failure> {
        const FAR: f64 = 100.0;
        if model.analysis.kind != AnalysisKind::Dynamic {
            return None;
        }
        self.balance.update_work(state.work.external);
        let letting_go = || {
            (is_watched(model) && model.parts.iter().any(Part::may_release))
                .then(|| system.energy(state, initial, plan.threads))
        };
        self.balance.update(&energy.or_else(letting_go)?);
        let Balance { generated, available, plastic, .. } = self.balance;
        // What plastic flow takes too much of does not move.
        let most = if last && generated > plastic { available } else { FAR * available };
        // A load that begins at rest moves things before it has done work: what grows does so in the next step too.
        let grows = is_watched(model) && available > 0.0 && generated > most;
        let went_on = std::mem::replace(&mut self.growing, grows) || last;
        (grows && went_on).then(|| Failure::EnergyGrowth { ratio: generated / available })
    }
}

/// Energies are summed whoever wants them.
pub fn is_watched(model: &Model) -> bool {
    matches!(model.solution.scheme.stepping(), Stepping::Verlet) && model.analysis.kind == AnalysisKind::Dynamic
}
