//! Values the deck expects, taken while the run goes and judged at its end.
//!
//! Peaks look at every accepted step, whenever tables have rows.

use super::table::Answers;
use super::tables::TABLES;
use crate::model::{Expect, ExpectAt, Model, Tolerance, When};
use crate::solve::{Frame, Observer, Wanted};
use serde::Serialize;
use std::io;

/// The names that `quantity` may take for one thing, over all tables that know it.
pub fn quantities(at: ExpectAt) -> Vec<&'static str> {
    answers(at).flat_map(|answers| (answers.quantities)(at)).collect()
}

/// What the solver must compute where something is expected of one thing.
pub fn needs(at: ExpectAt) -> Wanted {
    answers(at).fold(Wanted::NOTHING, |all, answers| all | answers.needs)
}

/// The answers of the tables that know quantities of one thing.
fn answers(at: ExpectAt) -> impl Iterator<Item = &'static Answers> {
    let all = TABLES.iter().copied().filter_map(|table| table.answers.as_ref());
    all.filter(move |answers| !(answers.quantities)(at).is_empty())
}

/// The answers that a quantity of one thing is among, and its index there; `None` where no table has it.
fn find(at: ExpectAt, quantity: &str) -> Option<(&'static Answers, usize)> {
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
    /// The time at which the value was taken.
    pub time: Option<f64>,
    /// The value that the deck expects, in the units of the deck.
    pub expected: f64,
    /// The absolute value of computed less expected, divided by the magnitude of the expected value where `relative`; of a
    /// bound, how far it is exceeded. `None` where this is no finite number.
    pub error: Option<f64>,
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

struct Watch {
    expect: Expect,
    /// The answers that the quantity is among and its index there; `None` where there is no quantity of that name.
    quantity: Option<(&'static Answers, usize)>,
    sample: Option<Sample>,
}

#[derive(Clone, Copy)]
struct Sample {
    time: f64,
    value: f64,
}

impl Expectations {
    /// Expectations of a deck before the first step.
    pub fn new(model: &Model) -> Expectations {
        let watch = |expect: &Expect| Watch {
            quantity: find(expect.at, &expect.quantity),
            expect: expect.clone(),
            sample: None,
        };
        Expectations { watches: model.expects.iter().map(watch).collect(), end_time: model.analysis.end_time }
    }

    /// Judges what has been taken so far, in the order of the deck.
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
            if matches!(watch.expect.when, When::Time(t) if (time - t).abs() > 1e-9 * self.end_time) {
                continue;
            }
            let Some(value) = watch.value(frame) else { continue };
            let better = |old: Sample| match watch.expect.when {
                When::Time(t) => (time - t).abs() < (old.time - t).abs(),
                When::Target(_) => false,
                When::Max => value > old.value,
                When::Min => value < old.value,
                When::Abs => value.abs() > old.value.abs(),
            };
            if watch.sample.is_none_or(better) {
                watch.sample = Some(Sample { time, value });
            }
        }
        Ok(())
    }

    fn restart(&mut self, _: &Model) -> io::Result<()> {
        self.watches.iter_mut().for_each(|watch| watch.sample = None);
        Ok(())
    }
}

impl Watch {
    /// The value in a frame; `None` where the frame does not have it.
    fn value(&self, frame: &Frame) -> Option<f64> {
        let (answers, index) = self.quantity?;
        (answers.value)(self.expect.at, index, frame)
    }

    /// Judges the value taken.
    fn verdict(&self) -> Verdict {
        let Expect { quantity, value: expected, tolerance, when, source, label, .. } = &self.expect;
        let (limit, unit, relative) = match *tolerance {
            Tolerance::Relative(tolerance) => (tolerance, expected.abs(), true),
            Tolerance::Absolute(tolerance) => (tolerance, 1.0, false),
            Tolerance::AtLeast | Tolerance::AtMost => (0.0, 1.0, false),
        };
        let difference = self.sample.map(|sample| match tolerance {
            Tolerance::AtLeast => (expected - sample.value).max(0.0),
            Tolerance::AtMost => (sample.value - expected).max(0.0),
            _ => (sample.value - expected).abs(),
        });
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
            (_, None, When::Time(t)) => Some(format!("the run has no step at time {t}")),
            (_, None, When::Target(_)) => Some("the path never came there".to_string()),
            (_, None, _) => Some(format!("the run never formed `{quantity}`")),
            (_, Some(sample), _) if bound.is_some() => {
                let bound = bound.unwrap_or_default();
                Some(format!("{} at time {} is not {bound} {expected}", sample.value, sample.time))
            }
            (_, Some(sample), _) => Some(format!(
                "{} at time {} is not {expected} within {limit}{}",
                sample.value,
                sample.time,
                if relative { " of it" } else { "" }
            )),
        };
        Verdict {
            label: label.clone(),
            value: self.sample.map(|sample| sample.value),
            time: self.sample.map(|sample| sample.time),
            expected: *expected,
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
