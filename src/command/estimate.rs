//! The time that a run will take on this machine, by its first steps, and its first natural period.

use super::console::counted;
use base::names::{instant, short, to_digits};
use model::{AnalysisKind, ModeExtent, Model, ModesAsked, StepLength};
use solve::modes::EigenMode;
use solve::plan::Plan;
use solve::system::System;
use solve::{Frame, Observer, Outcome, Run, Wanted};
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

/// The time for which the first steps of a run are measured.
const BUDGET: Duration = Duration::from_millis(250);
/// Modes among which the first with stiffness is looked for: six rigid motions may come before it.
const MODES: usize = 7;

/// The beginnings of steps.
#[derive(Default)]
struct Clock {
    /// The beginning of the second step: the first has what is done once.
    second: Option<Instant>,
    last: Option<Instant>,
    steps: usize,
}

impl Observer for Clock {
    fn on_step(&mut self, _: &Frame) -> io::Result<()> {
        Ok(())
    }

    fn wants_checkpoint(&mut self, _: bool) -> bool {
        let now = Instant::now();
        self.steps += 1;
        if self.steps == 2 {
            self.second = Some(now);
        }
        self.last = Some(now);
        false
    }
}

impl Clock {
    /// Steps that have been measured, and the time of one.
    fn rate(&self) -> Option<(usize, f64)> {
        let (second, last) = (self.second?, self.last?);
        let steps = self.steps.saturating_sub(2);
        (steps > 0).then(|| (steps, last.duration_since(second).as_secs_f64() / steps as f64))
    }
}

/// The number of steps and their time on this machine, by the first ones, which are made and forgotten. `None` where there are no steps in time.
pub fn effort(model: &Model, system: &System, plan: &Plan) -> Option<String> {
    let analysis = &model.analysis;
    if analysis.has_modes() {
        return None;
    }
    let stop = AtomicBool::new(false);
    let mut run = Run::new(model, system, plan, Wanted::default(), &stop).ok()?;
    let mut clock = Clock::default();
    let (done, is_done) = mpsc::channel();
    let outcome = thread::scope(|scope| {
        scope.spawn(|| {
            let is_done = is_done;
            if is_done.recv_timeout(BUDGET).is_err() {
                stop.store(true, Ordering::Relaxed);
            }
        });
        let outcome = run.rehearse(Vec::new(), (None, &[]), &mut clock).0;
        // The thread that waits may have ended before.
        done.send(()).ok();
        outcome
    });
    let reached = match outcome {
        Outcome::Done => analysis.end_time,
        Outcome::Stopped { time } | Outcome::Failed { time, .. } => time,
        Outcome::Io(_) => return None,
    };
    let all = match &analysis.step_length {
        StepLength::Fixed { step } => Some((analysis.duration() / step - 1e-9).ceil().max(1.0)),
        StepLength::StabilityLimited { .. } if clock.steps > 1 && reached > analysis.begin => {
            Some((analysis.duration() * (clock.steps - 1) as f64 / (reached - analysis.begin)).ceil())
        }
        _ => None,
    };
    let rate = clock.rate();
    match (all, rate) {
        (Some(all), Some((measured, each))) => {
            // Steps that are cut are counted too.
            let measured = measured.min(all as usize);
            let about = if matches!(analysis.step_length, StepLength::Fixed { .. }) { "" } else { "about " };
            Some(format!(
                "{about}{} in {} without output: {} a second on this machine, at the rate of the first {measured}",
                counted_steps(all),
                span(all * each),
                to_digits(1.0 / each, 2)
            ))
        }
        (Some(all), None) => Some(counted_steps(all)),
        (None, Some((measured, each))) => Some(format!(
            "{} a second on this machine, at the rate of the first {measured}, which reach t = {}; their number follows the motion",
            to_digits(1.0 / each, 2),
            instant(reached)
        )),
        (None, None) => None,
    }
}

fn counted_steps(all: f64) -> String {
    if all < 1e6 { counted(all as usize, "step") } else { format!("{} steps", to_digits(all, 3)) }
}

/// A time in words: "about 40 s", "about 12 min", "about 3 h".
fn span(seconds: f64) -> String {
    match seconds {
        _ if seconds < 0.1 => "less than 0.1 s".to_owned(),
        _ if seconds < 120.0 => format!("about {} s", to_digits(seconds, 2)),
        _ if seconds < 7200.0 => format!("about {} min", to_digits(seconds / 60.0, 2)),
        _ => format!("about {} h", to_digits(seconds / 3600.0, 2)),
    }
}

/// The mode that a run of modes shows first with stiffness.
#[derive(Default)]
struct FirstMode(Option<EigenMode>);

impl Observer for FirstMode {
    fn on_step(&mut self, _: &Frame) -> io::Result<()> {
        Ok(())
    }

    fn on_modes(&mut self, frame: &Frame) -> io::Result<()> {
        let modes = frame.modes.iter().flat_map(|modes| &modes.list);
        self.0 = modes.clone().find(|mode| mode.frequency() > 0.0).cloned();
        Ok(())
    }
}

/// The first natural period of the scene as the deck draws it, without loads; the reason where there is none.
pub fn first_period(model: &Model) -> String {
    let mut bare = model.clone();
    let loading = &mut bare.loading;
    loading.nodal.clear();
    loading.pressures.clear();
    loading.centrifugal.clear();
    loading.base_accelerations.clear();
    loading.gravity.fill(0.0);
    bare.expects.clear();
    let analysis = &mut bare.analysis;
    analysis.kind =
        AnalysisKind::Modal(ModesAsked { extent: ModeExtent::Count(MODES), damped: false, speeds: Vec::new() });
    (analysis.begin, analysis.end_time, analysis.stage, analysis.plane) = (0.0, 1.0, None, false);
    analysis.step_length = StepLength::Fixed { step: 1.0 };
    let found = System::new(&bare).and_then(|system| {
        let (plan, never) = (Plan::new(&bare, &system, 1), AtomicBool::new(false));
        let mut run = Run::new(&bare, &system, &plan, Wanted::default(), &never).map_err(|error| error.to_string())?;
        let mut first = FirstMode::default();
        match run.run(&mut first).0 {
            Outcome::Failed { failure, .. } => Err(failure.to_string()),
            _ => first.0.ok_or_else(|| "no mode has stiffness".to_owned()),
        }
    });
    match found {
        Ok(mode) => {
            let period = 1.0 / mode.frequency();
            let step = match model.analysis.step_length {
                StepLength::Fixed { step } if model.analysis.is_dynamic() => {
                    format!("; {} steps a period", to_digits(period / step, 3))
                }
                _ => String::new(),
            };
            let frequency = short(mode.frequency());
            format!("period {}, frequency {frequency}, of the scene as drawn, without loads{step}", short(period))
        }
        Err(why) => format!("none is found for the scene as drawn, without loads: {why}"),
    }
}
