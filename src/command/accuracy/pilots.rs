//! Pilot runs: the deck with other settings, observed at a few times and otherwise unseen.

use super::super::load::read_with;
use super::pilot_run::PilotRun;
use base::diagnostic::Source;
use deck::Deck;
use model::{Cadence, Model, StepLength, When};
use results::observed::RunDifference;
use results::wanted;
use solve::plan::Plan;
use solve::system::System;
use solve::{Counts, Outcome, Run, StepError, comparison_times};
use std::sync::atomic::AtomicBool;

/// Ratio of the step tolerance of the first run to the error asked for: steps about twice as long by a scheme of third order. Longer steps damp
/// vibrations that distinguish meshes. At an error of 1e-4 under a sudden load, a tolerance of 1e-2 made the error of the mesh seem 60 times too small.
const LOOSER: f64 = 10.0;
/// The largest of these tolerances, with which steps still resolve the motion.
const RESOLVES: f64 = 0.05;
/// Ratio of the tolerances of later runs and the first. These runs take the steps of the first one and shorten only steps with four times its
/// error.
const SLACK: f64 = 4.0;
/// The longest step of these runs, as a part of the duration: twice that of the last run, which would otherwise have the same steps.
const LONGEST: f64 = 0.04;
/// Largest number of times of comparison of a static analysis.
const LOAD_TIMES: usize = 32;

/// Makes pilot runs of one deck, and counts their effort.
pub struct Pilots<'a> {
    /// The text of the deck with the overrides of the user.
    pub source: &'a Source,
    /// Its tables.
    pub deck: &'a Deck,
    /// Its model.
    pub model: &'a Model,
    /// The tolerance of automatic steps.
    pub tolerance: f64,
    pub threads: usize,
    /// True once a signal has asked for the end of all runs.
    pub stop: &'a AtomicBool,
    /// The ends of the steps of the first run; later ones end steps there, too, so step errors cancel in the difference between meshes.
    pub ends: Vec<f64>,
    /// Number of runs so far, and their effort.
    pub runs: usize,
    pub effort: Counts,
}

impl Pilots<'_> {
    /// True if the deck has automatic steps.
    pub fn is_automatic(&self) -> bool {
        matches!(self.model.analysis.step_length, StepLength::ErrorControlled { .. })
    }

    /// The results of the deck with these overrides.
    ///
    /// # Errors
    /// The deck is not valid with them, or the run does not come to its end.
    pub fn run(&mut self, sets: &[String]) -> Result<PilotRun, String> {
        let with = if sets.is_empty() { String::new() } else { format!(" with {}", sets.join(", ")) };
        let mut model = read_with(self.source, sets)?;
        // Times of output would limit steps.
        model.output.cadence = Cadence::Steps(usize::MAX);
        let system = System::new(&model)?;
        let plan = Plan::new(&model, &system, self.threads);
        let run = Run::new(&model, &system, &plan, wanted(&model).where_due(), self.stop);
        let mut run = run.map_err(|error| error.to_string())?;
        let mut observed = PilotRun::new(&model);
        let is_automatic = self.is_automatic();
        let like = is_automatic.then(|| StepError::new(self.tolerance));
        // Events of another mesh or stiffness come at other times, and need steps of their own.
        let like = like.map(|like| if run.has_kinks() { like } else { self.with_shared_steps(like) });
        let (outcome, motion) = run.rehearse(self.times(), (like, &self.ends), &mut observed);
        if is_automatic {
            if !run.has_kinks() && matches!(outcome, Outcome::Done) && self.ends.is_empty() {
                self.ends.clone_from(&motion.ends);
            }
            observed.motion = Some(motion);
        }
        let Counts { steps, iterations, factorizations, .. } = run.counts();
        self.runs += 1;
        self.effort.steps += steps;
        self.effort.iterations += iterations;
        self.effort.factorizations += factorizations;
        match outcome {
            Outcome::Done => Ok(observed),
            Outcome::Failed { time, failure } => Err(format!("the pilot run{with} ends at t = {time}: {failure}")),
            Outcome::Stopped { time, .. } => Err(format!("the pilot run{with} was stopped at t = {time}")),
            Outcome::Io(error) => Err(error.to_string()),
        }
    }

    /// The tolerance of steps that runs share, with the iteration as for the error asked for.
    fn with_shared_steps(&self, like: StepError) -> StepError {
        let loose = (LOOSER * self.tolerance).min(RESOLVES).max(self.tolerance);
        let longest = Some(LONGEST * self.model.analysis.duration());
        StepError { tolerance: if self.ends.is_empty() { loose } else { SLACK * loose }, longest, ..like }
    }

    /// The difference between the results of a run and those of a coarser one.
    ///
    /// # Errors
    /// The runs have no results in common, or a difference is no number.
    pub fn difference(&self, fine: &PilotRun, coarse: &PilotRun) -> Result<RunDifference, String> {
        let none = "no result changes with them: name points in `[points]`, or values in `[[expect]]`";
        let difference = fine.observed.difference(&coarse.observed).ok_or_else(|| none.to_owned())?;
        if difference.size.is_finite() { Ok(difference) } else { Err(format!("the {} is not finite", difference.of)) }
    }

    /// The times of comparison. Motions have the times of global error control and of `[[expect]]`. Load steps end at these times, and so do
    /// steps of twice the length.
    fn times(&self) -> Vec<f64> {
        let analysis = &self.model.analysis;
        let end = analysis.end_time;
        if analysis.is_dynamic() {
            let expected = self.model.expects.iter().filter_map(|expect| match expect.when {
                When::Time(time) => Some(time),
                _ => None,
            });
            return comparison_times([analysis.begin, end]).chain(expected).chain([end]).collect();
        }
        let pairs = (end / (2.0 * analysis.nominal_step())) as usize;
        let stride = pairs.div_ceil(LOAD_TIMES).max(1);
        let times = (1..=pairs / stride).map(|k| 2.0 * analysis.nominal_step() * (k * stride) as f64);
        times.filter(|time| *time < end * (1.0 - 1e-9)).chain([end]).collect()
    }
}
