//! The choice of load steps in statics. They cause errors in path-dependent models: yielding, friction.

use super::numbers::two_digits;
use super::pilot_run::PilotRun;
use super::pilots::Pilots;
use model::StepLength;

/// Largest number of shorter steps that are tried, ...
const MOST_ROUNDS: usize = 4;
/// ... and largest factor at once.
const MOST_AT_ONCE: f64 = 8.0;

/// The chosen load steps.
pub struct ChosenSteps {
    /// The override; `None` where the step of the deck suffices.
    pub set: Option<String>,
    /// The estimated error of the results; `None` where it is not known.
    pub error: Option<f64>,
    /// Reasons for errors that remain or are not known.
    pub remarks: Vec<String>,
}

/// Chooses load steps with an error of at most `share`, for given other settings and their results. The error is assumed proportional to the
/// step.
pub fn choose_load_steps(pilots: &mut Pilots, (sets, observed): (&[String], &PilotRun), share: f64) -> ChosenSteps {
    let mut chosen = ChosenSteps { set: None, error: None, remarks: Vec::new() };
    let StepLength::Fixed { step } = pilots.model.analysis.step_length else { return chosen };
    let with = |step: f64| [sets, &[format!("analysis.time_step={step:e}")]].concat();
    if pilots.model.analysis.duration() > 1.5 * step {
        let longer = pilots.run(&with(2.0 * step)).and_then(|longer| pilots.difference(observed, &longer));
        chosen.error = longer.ok().map(|difference| difference.size);
    }
    let (mut step, mut own) = (step, None);
    for _ in 0..MOST_ROUNDS {
        if chosen.error.is_some_and(|error| error <= share) {
            return chosen;
        }
        let parts = chosen.error.map_or(2.0, |error| (error / share).log2().ceil().exp2()).clamp(2.0, MOST_AT_ONCE);
        let shorter = pilots.run(&with(step / parts)).and_then(|run| {
            pilots.difference(&run, own.as_ref().unwrap_or(observed)).map(|difference| (run, difference))
        });
        match shorter {
            Ok((run, difference)) => {
                step /= parts;
                chosen.error = Some(difference.size / (parts - 1.0));
                chosen.set = Some(format!("analysis.time_step={step:e}"));
                own = Some(run);
            }
            Err(reason) => {
                chosen.remarks.push(format!("load steps cannot be shorter: {reason}. Raise `accuracy`"));
                break;
            }
        }
    }
    match chosen.error {
        Some(error) if error > share => {
            chosen.remarks.push(format!(
                "the error of the load steps is about {}. Give a shorter `time_step`",
                two_digits(error)
            ));
        }
        Some(_) => {}
        None => chosen
            .remarks
            .push("the error of the load steps is not known. Compare with a shorter `time_step`".to_owned()),
    }
    chosen
}
