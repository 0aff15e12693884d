//! Watches the balance of energy: no other check detects growing motion in a model that is stable in its current configuration.

use super::failure::Failure;
use crate::plan::Plan;
use crate::system::System;
use crate::system::energy::{Balance, Energy, kinetic_energy, mass_and_center};
use crate::tolerances::energy_growth::{FAR, LOST, SOUND};
use base::snapshot::keep;
use mechanics::integrators::Stepping;
use mechanics::state::State;
use model::{AnalysisKind, Model, StepLength};

/// The balance of energy of an analysis. In statics the work of a step uses only its ends, so the missing energy is reported only at the
/// end of the run.
#[derive(Default)]
pub struct EnergyGrowth {
    /// The largest departures from the balance so far.
    pub balance: Balance,
    /// True where energy had grown at the last check.
    growing: bool,
    /// Time of the last check with a kept balance.
    kept_until: f64,
    /// An upper bound of the energy, for runs that do not sum energies; `None` for others, and if loads make it unknown.
    bound: Option<f64>,
}

keep!(EnergyGrowth { balance, growing, kept_until, bound });

impl EnergyGrowth {
    /// Begins with a balance at a time.
    pub fn begin(&mut self, balance: Balance, time: f64) {
        (self.balance, self.kept_until) = (balance, time);
    }

    /// Notes the most energy that a motion without a balance can reach: it is checked once, at the end.
    pub fn begin_without_balance(&mut self, (model, plan, system): (&Model, &Plan, &System), state: &State) {
        if model.analysis.kind == AnalysisKind::Dynamic && is_moved_by_weight_alone(model) {
            let start = Energy::of(system, state, None, plan.threads).mechanical;
            self.bound = Some(most_energy(model, system, start));
        }
    }

    /// Updates the balance; `energy` is the energy of the state, if known. Central differences have failed if they have generated more
    /// energy than was available, and much more as long as little is available. The verdict must not depend on output times: work is taken
    /// account of in every step, and energies are summed where links may release some. Other schemes have failed if the kinetic energy at the
    /// end is ten times what was available.
    pub fn check(
        &mut self,
        (model, plan, system): (&Model, &Plan, &System),
        state: &State,
        energy: Option<Energy>,
        initial: Option<f64>,
        last: bool,
    ) -> Option<Failure> {
        self.balance.update_work(state.work.external);
        if model.analysis.kind != AnalysisKind::Dynamic {
            if last {
                self.balance.update(&energy.unwrap_or_else(|| Energy::of(system, state, initial, plan.threads)));
            }
            return None;
        }
        let letting_go = || {
            (checks_energy_growth(model) && model.parts.iter().any(|part| part.may_release()))
                .then(|| Energy::of(system, state, initial, plan.threads))
        };
        let Some(energy) = energy.or_else(letting_go) else {
            let bound = self.bound.filter(|_| last)?;
            let gained = kinetic_energy(system, &state.nodes) - bound;
            return (bound > 0.0 && gained > LOST * bound).then(|| self.failure(gained / bound, model));
        };
        self.balance.update(&energy);
        let Balance { generated, available, plastic, rounding, .. } = self.balance;
        if generated <= SOUND * available.max(rounding) {
            self.kept_until = state.time;
        }
        let is_central = checks_energy_growth(model);
        // Energy that plastic flow has dissipated in excess does not move anything.
        let most = if last && generated > plastic { available } else { FAR * available };
        // A load that begins at rest moves nodes before it has done work: true growth is there in the next step too.
        let grows = is_central && available > 0.0 && generated > most;
        let went_on = std::mem::replace(&mut self.growing, grows) || last;
        if is_central || !last {
            return (grows && went_on).then(|| self.failure(generated / available, model));
        }
        // Strain energy of stiff springs and the work of dampers may be far too large while the motion is right, so kinetic energy decides.
        let gained = energy.kinetic - available;
        (available > 0.0 && gained > LOST * available.max(rounding)).then(|| self.failure(gained / available, model))
    }

    fn failure(&self, ratio: f64, model: &Model) -> Failure {
        let shortens = match model.analysis.step_length {
            StepLength::ErrorControlled { .. } => "error_tolerance",
            StepLength::Fixed { .. } | StepLength::StabilityLimited { .. } | StepLength::ArcLength(_) => "time_step",
        };
        Failure::EnergyGrowth {
            ratio,
            scheme: (!checks_energy_growth(model)).then(|| model.solution.scheme.word().to_owned()),
            shortens: shortens.to_owned(),
            kept_until: self.kept_until,
        }
    }
}

/// True where a constant weight alone does work. Loads, motors, pretension and given motions do work too, and matrices of bearings may feed a
/// whirl.
fn is_moved_by_weight_alone(model: &Model) -> bool {
    let loading = &model.loading;
    let is_loaded = !(loading.nodal.is_empty() && loading.pressures.is_empty() && loading.centrifugal.is_empty());
    let is_driven = !loading.base_accelerations.is_empty() || loading.gravity_amplitude.is_some();
    let is_led = model.constraints.restraints.iter().any(|restraint| restraint.motion.is_some());
    let is_fed = model.parts.iter().any(|part| part.may_feed());
    !(is_loaded || is_driven || is_led || is_fed)
}

/// The most energy of a motion under its weight. √E grows by at most g √(M/2) per time: dE/dt is M g·v, and E contains ½ M v².
fn most_energy(model: &Model, system: &System, start: f64) -> f64 {
    let mass = mass_and_center(system, &model.nodes).map_or(0.0, |(mass, _)| mass);
    let gained = model.loading.gravity.norm() * model.analysis.duration() * (0.5 * mass).sqrt();
    (start.max(0.0).sqrt() + gained).powi(2)
}

/// True where energies are summed whether the output wants them or not.
pub fn checks_energy_growth(model: &Model) -> bool {
    matches!(model.solution.scheme.stepping(), Stepping::Verlet) && model.analysis.kind == AnalysisKind::Dynamic
}
