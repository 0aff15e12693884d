//! Values the deck expects, taken while the run goes and judged at its end.
//!
//! Peaks look at every accepted step, whenever tables have rows.

use super::error_bars::{ComparedHistory, Told};
use super::table::Answers;
use super::tables::TABLES;
use base::snapshot::keep;
use model::{Expect, ExpectAt, Model, OverFrequencies, Tolerance, When};
use serde::Serialize;
use solve::{Frame, Observer, OtherRun, Wanted};
use std::io;

/// The names that `quantity` may have for one thing, over all tables with such rows.
pub fn quantities(at: ExpectAt) -> Vec<&'static str> {
    answers(at).flat_map(|answers| (answers.quantities)(at)).collect()
}

/// The quantities that the solver must compute for an expected quantity of one thing.
pub fn needs(at: ExpectAt, quantity: &str) -> Wanted {
    find(at, quantity).map_or(Wanted::NOTHING, |(answers, _)| answers.needs)
}

/// The answers of the tables that know quantities of one thing.
fn answers(at: ExpectAt) -> impl Iterator<Item = &'static Answers> {
    let all = TABLES.iter().copied().filter_map(|table| table.answers.as_ref());
    all.filter(move |answers| !(answers.quantities)(at).is_empty())
}

/// The answers with a quantity of one thing, and its index among them; `None` if no table has it.
pub(super) fn find(at: ExpectAt, quantity: &str) -> Option<(&'static Answers, usize)> {
    answers(at).find_map(|answers| {
        let index = (answers.quantities)(at).iter().position(|name| *name == quantity)?;
        Some((answers, index))
    })
}

/// The judgement on one expectation, as it stands in result.json.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// The quantity, where and when, in words: `ux of tip at t = 1`.
    pub label: String,
    /// The computed value; `None` where the run never came to it.
    pub value: Option<f64>,
    /// The time of the sample.
    pub time: Option<f64>,
    /// The value that the deck expects, in the units of the deck.
    pub expected: f64,
    /// The absolute value of computed less expected, divided by the magnitude of the expected value where `relative`; of a
    /// bound, how far it is exceeded. `None` where this is no finite number.
    pub error: Option<f64>,
    /// The error that automatic steps leave in the computed value, a bound by estimate, in its unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step_error: Option<f64>,
    /// The same bound for the error by the mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh_error: Option<f64>,
    /// The largest error that passes; 0 for a bound.
    pub tolerance: f64,
    /// Whether error and tolerance are parts of the expected value; else they have its unit.
    pub relative: bool,
    /// "at least" or "at most" where the expected value is a bound.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bound: Option<&'static str>,
    /// Whether the error is within the tolerance; an expectation without a value has not passed.
    pub passed: bool,
    /// Where the expected value comes from, as the deck says.
    pub source: String,
    /// Why it was missed, in a sentence without a full stop; `None` where it has passed.
    pub reason: Option<String>,
}

/// Takes the values that the deck expects while the run goes; [`Expectations::verdicts`] judges them.
pub struct Expectations {
    watches: Vec<Watch>,
    end_time: f64,
}

keep!(Expectations { watches } without { end_time });

struct Watch {
    expect: Expect,
    /// True if the current stage has the expected thing.
    is_here: bool,
    /// The answers with this quantity, and its index among them; `None` if no quantity has that name.
    quantity: Option<(&'static Answers, usize)>,
    sample: Option<Sample>,
    /// The sample at the beginning of the current stage.
    of_stages_before: Option<Sample>,
    history: ComparedHistory,
    /// Both of the run before, ...
    before: (Option<Sample>, ComparedHistory),
    /// ... and the values of an unseen run.
    unseen: ComparedHistory,
    /// The values of a pilot run.
    pilot: ComparedHistory,
    step_error: Option<f64>,
    mesh_error: Option<f64>,
}

keep!(Watch { is_here, sample, of_stages_before, history, before, unseen, step_error, mesh_error } without { expect, quantity, pilot });

#[derive(Clone, Copy, Default)]
struct Sample {
    time: f64,
    value: f64,
    /// The value of another run at this time.
    other: Option<f64>,
}

keep!(Sample: Default { time, value, other });

impl Sample {
    /// Keeps the value of another run at the time of the sample.
    fn read(sample: &mut Option<Sample>, time: f64, value: f64, end_time: f64) {
        if let Some(sample) = sample.as_mut().filter(|own| (own.time - time).abs() <= 1e-9 * end_time) {
            sample.other = Some(value);
        }
    }
}

impl Expectations {
    /// Expectations of a deck before the first step.
    pub fn new(model: &Model) -> Expectations {
        Expectations { watches: model.expects.iter().map(Watch::new).collect(), end_time: model.analysis.end_time }
    }

    /// Goes on with the next stage, whose model this is.
    pub fn next_stage(&mut self, model: &Model) {
        self.end_time = model.analysis.end_time;
        for watch in &mut self.watches {
            (watch.is_here, watch.of_stages_before) = (false, watch.sample);
            watch.history.clear();
        }
        for expect in &model.expects {
            match self.watches.iter_mut().find(|watch| watch.expect.index == expect.index) {
                Some(watch) => (watch.expect, watch.is_here) = (expect.clone(), true),
                None => self.watches.push(Watch::new(expect)),
            }
        }
        self.watches.sort_by_key(|watch| watch.expect.index);
    }

    /// The times at which a run with another mesh must have frames.
    pub fn times_for_mesh(&self) -> Vec<f64> {
        let all = self.watches.iter().flat_map(|watch| watch.history.times().iter().copied());
        all.chain(self.times_to_compare()).collect()
    }

    /// Receives a frame of a run with another mesh; the expectations of that run find the values.
    pub fn on_other_mesh(&mut self, theirs: &Expectations, frame: &Frame) {
        for (watch, theirs) in self.watches.iter_mut().zip(&theirs.watches) {
            watch.read(theirs.value(frame), frame.state.time, self.end_time);
        }
    }

    /// Records that a run with a coarser mesh has ended; its errors are larger by this factor.
    pub fn on_coarser_mesh(&mut self, apart: f64) {
        for watch in &mut self.watches {
            watch.mesh_error = watch.told_by(watch.sample, &watch.unseen, apart, self.end_time);
        }
    }

    /// Receives a frame of the run itself, a pilot run without tables.
    pub fn on_pilot(&mut self, frame: &Frame) {
        for watch in &mut self.watches {
            if let Some(value) = watch.value(frame) {
                watch.pilot.keep(frame.state.time, &[value]);
            }
        }
    }

    /// Keeps the values of a pilot run that may tell the errors by the steps.
    pub fn compare_with(&mut self, pilot: &Expectations) {
        for (watch, pilot) in self.watches.iter_mut().zip(&pilot.watches) {
            watch.pilot.clone_from(&pilot.pilot);
        }
    }

    /// Tells the errors by the mesh from two pilot runs, the second with a coarser mesh and errors larger by this factor.
    pub fn told_by_pilots(&mut self, [fine, coarse]: [&Expectations; 2], apart: f64) {
        let rounding = 1e-9 * self.end_time;
        for (watch, (fine, coarse)) in self.watches.iter_mut().zip(fine.watches.iter().zip(&coarse.watches)) {
            let histories = [&fine.pilot, &coarse.pilot];
            let at = |time: f64| histories.map(|history| Some(history.numbers_at(time, rounding)?[0]));
            let value = watch.sample.map(|sample| sample.value);
            let pair = match watch.sample.map(|sample| at(sample.time)) {
                Some([Some(fine), Some(coarse)]) => [Some(fine), Some(coarse)],
                _ => [value, None],
            };
            let anywhere = histories[0].largest_differences(histories[1], 1, rounding);
            watch.mesh_error = Told::by(pair, anywhere.map(|all| all[0]), apart).error;
        }
    }

    /// Judges all samples so far, in the order of the deck.
    pub fn verdicts(&self) -> Vec<Verdict> {
        self.watches.iter().map(Watch::verdict).collect()
    }
}

impl Observer for Expectations {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        let time = frame.state.time;
        for (index, watch) in self.watches.iter_mut().enumerate() {
            if matches!(watch.expect.when, When::Target(_)) && !frame.passed.contains(&index) {
                continue;
            }
            let case = frame.case.and_then(|case| case.name).map(|(place, _)| place);
            if matches!(watch.expect.when, When::Case(place) if case != Some(place)) {
                continue;
            }
            if !watch.is_here || watch.expect.when == When::End && !frame.last {
                continue;
            }
            let elsewhere = matches!(watch.expect.when, When::Time(t) if (time - t).abs() > 1e-9 * self.end_time);
            if elsewhere && !frame.compared {
                continue;
            }
            let Some(value) = watch.value(frame) else { continue };
            if frame.compared {
                Sample::read(&mut watch.before.0, time, value, self.end_time);
                watch.history.keep(time, &[value]);
            }
            if elsewhere {
                continue;
            }
            let better = |old: Sample| match watch.expect.when {
                When::Time(t) => (time - t).abs() < (old.time - t).abs(),
                When::Target(_) => false,
                When::End | When::Case(_) => true,
                When::Max => value > old.value,
                When::Min => value < old.value,
                When::Abs => value.abs() > old.value.abs(),
            };
            if watch.sample.is_none_or(better) {
                watch.sample = Some(Sample { time, value, other: None });
            }
        }
        Ok(())
    }

    fn on_modes(&mut self, frame: &Frame) -> io::Result<()> {
        let of_mode = |watch: &&mut Watch| {
            watch.is_here
                && matches!(watch.expect.at, ExpectAt::Mode(_) | ExpectAt::CriticalSpeed(_) | ExpectAt::Response(..))
        };
        for watch in self.watches.iter_mut().filter(of_mode) {
            watch.sample = watch.value(frame).map(|value| Sample { time: frame.state.time, value, other: None });
        }
        Ok(())
    }

    fn restart(&mut self, _: &Model) -> io::Result<()> {
        for watch in &mut self.watches {
            watch.before = (watch.sample.take(), std::mem::take(&mut watch.history));
            watch.sample = watch.of_stages_before;
            watch.unseen.clear();
        }
        Ok(())
    }

    fn times_to_compare(&self) -> Vec<f64> {
        self.watches.iter().filter_map(|watch| Some(watch.sample?.time)).collect()
    }

    fn begin_comparison(&mut self) {
        for watch in &mut self.watches {
            watch.unseen.clear();
            if let Some(sample) = &mut watch.sample {
                sample.other = None;
            }
        }
    }

    fn on_comparison(&mut self, frame: &Frame) -> io::Result<()> {
        for watch in &mut self.watches {
            watch.read(watch.value(frame), frame.state.time, self.end_time);
        }
        Ok(())
    }

    fn on_other_run(&mut self, other: Option<OtherRun>) {
        for watch in &mut self.watches {
            watch.step_error = match other {
                Some(OtherRun::Comparison(apart)) => watch.told_by(watch.sample, &watch.unseen, apart, self.end_time),
                Some(OtherRun::Before(apart)) => watch.told_by(watch.before.0, &watch.before.1, apart, self.end_time),
                Some(OtherRun::Pilot(apart)) => watch.told_by_pilot(apart, self.end_time),
                None => None,
            };
        }
    }
}

impl Watch {
    /// Nothing taken yet.
    fn new(expect: &Expect) -> Watch {
        Watch {
            quantity: find(expect.at, &expect.quantity),
            expect: expect.clone(),
            is_here: true,
            sample: None,
            of_stages_before: None,
            history: ComparedHistory::default(),
            before: Default::default(),
            unseen: ComparedHistory::default(),
            pilot: ComparedHistory::default(),
            step_error: None,
            mesh_error: None,
        }
    }

    /// Keeps the value of an unseen run at this time.
    fn read(&mut self, value: Option<f64>, time: f64, end_time: f64) {
        if let Some(value) = value {
            Sample::read(&mut self.sample, time, value, end_time);
            self.unseen.keep(time, &[value]);
        }
    }

    /// The error estimated from a pilot run.
    fn told_by_pilot(&self, apart: f64, end_time: f64) -> Option<f64> {
        let at = |sample: Sample| self.pilot.numbers_at(sample.time, 1e-9 * end_time).map(|numbers| numbers[0]);
        let sample = self.sample.map(|sample| Sample { other: at(sample), ..sample });
        self.told_by(sample, &self.pilot, apart, end_time)
    }

    /// The error estimated from the history of another run and its value at the time of either sample.
    fn told_by(&self, sample: Option<Sample>, other: &ComparedHistory, apart: f64, end_time: f64) -> Option<f64> {
        let pair = [sample.map(|sample| sample.value), sample.and_then(|sample| sample.other)];
        let anywhere = self.history.largest_differences(other, 1, 1e-9 * end_time);
        Told::by(pair, anywhere.map(|all| all[0]), apart).error
    }

    /// The value in a frame; `None` where the frame does not have it.
    fn value(&self, frame: &Frame) -> Option<f64> {
        let (answers, index) = self.quantity?;
        (answers.value)(self.expect.at, index, frame)
    }

    /// The distance of a value from the expected value, or from its bound.
    fn difference(&self, value: f64) -> f64 {
        let Expect { quantity, value: expected, tolerance, .. } = &self.expect;
        match tolerance {
            Tolerance::AtLeast => (expected - self.bounded(value)).max(0.0),
            Tolerance::AtMost => (self.bounded(value) - expected).max(0.0),
            // A phase is the same after a full turn.
            _ if quantity.ends_with("_phase") => {
                let apart = (value - expected).rem_euclid(360.0);
                apart.min(360.0 - apart)
            }
            _ => (value - expected).abs(),
        }
    }

    /// The bounded number: the magnitude for the greatest absolute value, else the value.
    fn bounded(&self, value: f64) -> f64 {
        let is_size = match self.expect.at {
            ExpectAt::Response(_, over) => over == OverFrequencies::Abs,
            // Of modes there is one value.
            ExpectAt::Mode(_) | ExpectAt::CriticalSpeed(_) => false,
            _ => self.expect.when == When::Abs,
        };
        if is_size { value.abs() } else { value }
    }

    /// The time of a sample in words; nothing of modes and of responses, which have none.
    fn moment(&self, sample: Sample) -> String {
        match self.expect.at {
            ExpectAt::Mode(_) | ExpectAt::CriticalSpeed(_) | ExpectAt::Response(..) => String::new(),
            _ => format!(" at time {}", sample.time),
        }
    }

    fn verdict(&self) -> Verdict {
        let Expect { quantity, value: expected, tolerance, when, source, label, .. } = &self.expect;
        let (limit, unit, relative) = match *tolerance {
            Tolerance::Relative(tolerance) => (tolerance, expected.abs(), true),
            Tolerance::Absolute(tolerance) => (tolerance, 1.0, false),
            Tolerance::AtLeast | Tolerance::AtMost => (0.0, 1.0, false),
        };
        let difference = self.sample.map(|sample| self.difference(sample.value));
        let bound = match tolerance {
            Tolerance::AtLeast => Some("at least"),
            Tolerance::AtMost => Some("at most"),
            _ => None,
        };
        // The tolerance is multiplied rather than the difference divided: an expected 0 with a relative tolerance is met by 0.
        let passed = difference.is_some_and(|difference| difference <= limit * unit);
        let reason = match (self.quantity, self.sample, *when) {
            _ if passed => None,
            (None, ..) => Some(format!("there is no quantity `{quantity}` here")),
            (_, None, _) if matches!(self.expect.at, ExpectAt::Mode(_) | ExpectAt::CriticalSpeed(_)) => {
                Some(format!("there is no such mode, or it has no `{quantity}`"))
            }
            (_, None, _) if matches!(self.expect.at, ExpectAt::Response(..)) => {
                Some(format!("there is no steady motion there, or no `{quantity}`"))
            }
            (_, None, When::Time(t)) => Some(format!("the run has no step at time {t}")),
            (_, None, When::Case(_)) => Some("the run never came to the case".to_string()),
            (_, None, When::End) => Some("the run never came to the end".to_string()),
            (_, None, When::Target(_)) => Some("the path never came there".to_string()),
            (_, None, _) => Some(format!("the run never formed `{quantity}`")),
            (_, Some(sample), _) if bound.is_some() => {
                let bound = bound.unwrap_or_default();
                Some(format!("{}{} is not {bound} {expected}", self.bounded(sample.value), self.moment(sample)))
            }
            (_, Some(sample), _) => Some(format!(
                "{}{} is not {expected} within {limit}{}",
                sample.value,
                self.moment(sample),
                if relative { " of it" } else { "" }
            )),
        };
        Verdict {
            label: label.clone(),
            value: self.sample.map(|sample| if bound.is_some() { self.bounded(sample.value) } else { sample.value }),
            time: self.sample.map(|sample| sample.time),
            expected: *expected,
            step_error: self.step_error,
            mesh_error: self.mesh_error,
            error: difference.map(|difference| difference / unit).filter(|error| error.is_finite()),
            tolerance: limit,
            relative,
            bound,
            passed,
            source: source.clone(),
            reason,
        }
    }
}
