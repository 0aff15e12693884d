//! Values the deck expects, taken while the run goes and judged at its end.
//!
//! Peaks of motion look at every accepted step, those of energies, links and plastic strains at the steps where these are formed.

use super::tables::{bodies, contacts, energy, links, nodes, reactions, shells};
use crate::model::{Expect, ExpectAt, Model, Tolerance, When};
use crate::quantities::{
    CONTACT, CONTACT_FORCE, ENERGY, JOINT, LINK, MOTION, PLASTIC_STRAIN, QUATERNION, TIME, VON_MISES, names,
};
use crate::solve::{Frame, Observer};
use serde::Serialize;
use std::io;

/// The names `quantity` may take, in the order in which their values are taken.
pub fn quantities(at: ExpectAt) -> Vec<&'static str> {
    match at {
        ExpectAt::Analysis => vec![TIME.name],
        ExpectAt::Node(_) => [names(&MOTION), names(&[&QUATERNION])].concat(),
        ExpectAt::Energy => names(&[&ENERGY]),
        ExpectAt::Link(_) => names(&[&LINK]),
        ExpectAt::Joint(_) => names(&[&JOINT]),
        ExpectAt::Contact(_) => names(&[&CONTACT, &[CONTACT_FORCE]]),
        ExpectAt::Elements(..) => vec![PLASTIC_STRAIN.name],
        ExpectAt::Shells(..) => vec![VON_MISES.name, PLASTIC_STRAIN.name],
    }
}

/// How one expectation went.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    pub label: String,
    /// `None`: the run never came to it.
    pub value: Option<f64>,
    /// Time of the value.
    pub time: Option<f64>,
    pub expected: f64,
    /// Of the kind of the tolerance.
    pub error: Option<f64>,
    pub tolerance: f64,
    pub relative: bool,
    /// "at least" or "at most" where the expected value is a bound.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bound: Option<&'static str>,
    pub passed: bool,
    pub source: String,
    /// Why it was missed.
    pub reason: Option<String>,
}

/// Collects samples; [`Expectations::verdicts`] compares them.
pub struct Expectations {
    watches: Vec<Watch>,
    end_time: f64,
}

struct Watch {
    expect: Expect,
    /// Index into [`quantities`].
    column: Option<usize>,
    sample: Option<Sample>,
}

#[derive(Clone, Copy)]
struct Sample {
    time: f64,
    value: f64,
}

impl Expectations {
    pub fn new(model: &Model) -> Expectations {
        let watch = |expect: &Expect| Watch {
            column: quantities(expect.at).iter().position(|name| *name == expect.quantity),
            expect: expect.clone(),
            sample: None,
        };
        Expectations { watches: model.expects.iter().map(watch).collect(), end_time: model.analysis.end_time }
    }

    /// In deck order.
    pub fn verdicts(&self) -> Vec<Verdict> {
        self.watches.iter().map(Watch::verdict).collect()
    }
}

impl Observer for Expectations {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        let time = frame.state.time;
        for (index, watch) in self.watches.iter_mut().enumerate() {
            if matches!(watch.expect.when, When::Passing(_)) && !frame.passed.contains(&index) {
                continue;
            }
            if matches!(watch.expect.when, When::Time(t) if (time - t).abs() > 1e-9 * self.end_time) {
                continue;
            }
            let Some(value) = watch.column.and_then(|column| sample(watch.expect.at, column, frame)) else { continue };
            let better = |old: Sample| match watch.expect.when {
                When::Time(t) => (time - t).abs() < (old.time - t).abs(),
                When::Passing(_) => false,
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
}

/// The value of a column now, where this frame has it.
fn sample(at: ExpectAt, column: usize, frame: &Frame) -> Option<f64> {
    let derived = frame.derived;
    match at {
        ExpectAt::Node(i) => {
            let now = frame.state.nodes.get(i)?;
            let motion = nodes::values(&frame.model.nodes[i], now);
            Some(motion.get(column).copied().unwrap_or_else(|| bodies::quaternion(now)[column - motion.len()]))
        }
        ExpectAt::Analysis => Some(frame.state.time),
        ExpectAt::Energy => derived.energy.as_ref().map(|of| energy::values(of)[column]),
        ExpectAt::Link(i) => derived.links.get(i).map(|link| links::values(link)[column]),
        ExpectAt::Joint(i) => derived.joints.get(i).map(|joint| reactions::of_joint(joint)[column]),
        ExpectAt::Contact(i) => derived.contacts.get(i).map(|contact| contacts::values(contact)[column]),
        ExpectAt::Shells(from, to) => {
            let of = [shells::von_mises, shells::plastic_strain][column];
            derived.shells.iter().filter(|state| (from..to).contains(&state.part)).map(of).reduce(f64::max)
        }
        ExpectAt::Elements(from, to) => derived.plastic_strains.get(from..to)?.iter().copied().reduce(f64::max),
    }
}

impl Watch {
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
        // Multiplied rather than divided: an expected 0 with a relative tolerance is met by 0.
        let passed = difference.is_some_and(|difference| difference <= limit * unit);
        let reason = match (self.column, self.sample, *when) {
            _ if passed => None,
            (None, ..) => Some(format!("there is no quantity `{quantity}` here")),
            (_, None, When::Time(t)) => Some(format!("the run has no step at time {t}")),
            (_, None, When::Passing(_)) => Some("the path never came there".to_string()),
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
