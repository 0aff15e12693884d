//! The time that a run will take on this machine, by its first steps, and its first natural period.

use super::automatic_steps::strikes_deformable;
use super::console::counted;
use base::names::{instant, short, to_digits};
use deck::parts::PartKind;
use mechanics::integrators::stability_limited;
use model::{AnalysisKind, ElementMasses, ModeExtent, Model, ModesAsked, StepLength};
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
/// The time after which they end though none has been measured.
const PATIENCE: Duration = Duration::from_secs(2);
/// Central differences are not offered for longer runs, in seconds.
const LONGEST: f64 = 600.0;
/// Modes among which the first with stiffness is looked for: six rigid motions may come before it.
const MODES: usize = 7;

/// The beginnings of steps.
struct Clock<'s> {
    /// Ends the run once steps are measured.
    stop: &'s AtomicBool,
    /// The beginning of the run.
    began: Instant,
    /// The beginning of the second step: the first has what is done once.
    second: Option<Instant>,
    last: Option<Instant>,
    steps: usize,
}

impl Observer for Clock<'_> {
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
        if self.rate().is_some() && now.duration_since(self.began) > BUDGET {
            self.stop.store(true, Ordering::Relaxed);
        }
        false
    }
}

impl Clock<'_> {
    /// Steps that have been measured, and the time of one.
    fn rate(&self) -> Option<(usize, f64)> {
        let (second, last) = (self.second?, self.last?);
        let steps = self.steps.saturating_sub(2);
        (steps > 0).then(|| (steps, last.duration_since(second).as_secs_f64() / steps as f64))
    }
}

/// The first steps of a run, made and forgotten.
struct Rehearsal {
    /// The number of all steps, where they have one length.
    steps: Option<f64>,
    /// The number of steps that were measured, and the time of one in seconds.
    rate: Option<(usize, f64)>,
    /// The time of the run that they reached.
    reached: f64,
}

/// Makes the first steps of a run and forgets them. `None` where there are no steps in time.
fn rehearse(model: &Model, system: &System, plan: &Plan) -> Option<Rehearsal> {
    let analysis = &model.analysis;
    if analysis.has_modes() {
        return None;
    }
    let stop = AtomicBool::new(false);
    let mut run = Run::new(model, system, plan, Wanted::default(), &stop).ok()?;
    let mut clock = Clock { stop: &stop, began: Instant::now(), second: None, last: None, steps: 0 };
    let (done, is_done) = mpsc::channel();
    let outcome = thread::scope(|scope| {
        scope.spawn(|| {
            let is_done = is_done;
            if is_done.recv_timeout(PATIENCE).is_err() {
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
        Outcome::Stopped { time, .. } | Outcome::Failed { time, .. } => time,
        Outcome::Io(_) => return None,
    };
    let steps = match &analysis.step_length {
        StepLength::Fixed { step } => Some((analysis.duration() / step - 1e-9).ceil().max(1.0)),
        StepLength::StabilityLimited { .. } if clock.steps > 1 && reached > analysis.begin => {
            Some((analysis.duration() * (clock.steps - 1) as f64 / (reached - analysis.begin)).ceil())
        }
        _ => None,
    };
    Some(Rehearsal { steps, rate: clock.rate(), reached })
}

/// The number of steps and their time on this machine, by the first ones. `None` where there are no steps in time.
pub fn effort(model: &Model, system: &System, plan: &Plan) -> Option<String> {
    let Rehearsal { steps, rate, reached } = rehearse(model, system, plan)?;
    match (steps, rate) {
        (Some(all), Some((measured, each))) => {
            // Steps that are cut are counted too.
            let measured = measured.min(all as usize);
            let about = if matches!(model.analysis.step_length, StepLength::Fixed { .. }) { "" } else { "about " };
            // Nothing touches or yields at the drawn state, mostly.
            let changes = (measured as f64) < all && (model.may_stiffen() || model.yields());
            let later = if changes { "; parts that touch or yield later, and cutbacks, take more" } else { "" };
            Some(format!(
                "{about}{} in {} without output: {} a second on this machine, at the rate of the first {measured}{later}",
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

/// Offers central differences if automatic steps by an error have no scheme in the deck, deformable parts strike something and the run takes minutes
/// at most. All schemes resolve a blow by short steps.
pub fn alternative(model: &Model, threads: usize) -> Option<String> {
    let has_part = |is: fn(PartKind) -> bool| model.parts.iter().any(|part| is(part.kind()));
    let fits = !has_part(PartKind::is_floating) && model.damping.modal.is_empty();
    let follows_error = matches!(model.analysis.step_length, StepLength::ErrorControlled { .. });
    if !(model.analysis.is_dynamic()
        && model.solution.is_chosen()
        && follows_error
        && fits
        && strikes_deformable(model))
    {
        return None;
    }
    let mut by_central = model.clone();
    by_central.solution.scheme = stability_limited();
    by_central.solution.masses = ElementMasses::Rotary;
    by_central.analysis.step_length = StepLength::StabilityLimited { fraction: model.stable_fraction() };
    let system = System::new(&by_central).ok()?;
    let plan = Plan::new(&by_central, &system, threads);
    if !plan.massless(&by_central, &system).is_empty() {
        return None;
    }
    let Rehearsal { steps, rate, .. } = rehearse(&by_central, &system, &plan)?;
    let (all, (_, each)) = (steps?, rate?);
    (all * each < LONGEST).then(|| {
        format!(
            "blows of parts that deform often take less time by `scheme = \"central-difference\"` in [integrator] with `time_step = \"auto\"`, without \
             `error_tolerance` and `accuracy`: here about {} in {} on this machine. Compare both",
            counted_steps(all),
            span(all * each)
        )
    })
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
