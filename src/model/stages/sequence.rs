//! The stages of a deck in order: their times, and the tables active in each.

use crate::data::ElementMasses;
use crate::procedure::scaled_masses::masses;
use crate::report::{Owner, Report};
use crate::shells::edges::Bulges;
use crate::values::keys;
use base::diagnostic::{At, Span};
use base::names::short;
use base::words::kinds::OneOf;
use deck::Deck;
use deck::analysis::{Control, Integrator};
use deck::expect::Expect;
use deck::stages::{Stage, StageKind};
use deck::words::{Maybe, Names, Table};
use mechanics::amplitude::{Amplitude, StraightLines};

/// The stages of a deck, one after the other.
pub struct StageSequence<'d> {
    /// The deck with the tables of all stages.
    pub whole: &'d Deck,
    /// True after a stage with an early end: expected values after it are then skipped without an error.
    pub is_shortened: bool,
    /// Upper bounds for the bulge of each edge of each shell; empty if each stage decides alone.
    pub bulges: Vec<Bulges>,
    /// The stages.
    pub stages: Vec<PlannedStage<'d>>,
}

/// Least duration of a stage, relative to the time at its end, against rounding of times. Events within 1e-9 of that time count as one, and
/// a comparison of runs needs sixteen of them in a stage.
const SHORTEST: f64 = 1e-7;
/// How far a displacement can lead loads, in durations of its stage.
const FARTHEST: f64 = 1e6;

/// A stage with its times, which are those of the run.
pub struct PlannedStage<'d> {
    pub table: &'d At<Table<Stage>>,
    pub name: String,
    pub kind: StageKind,
    pub begin: f64,
    pub duration: f64,
    /// Its end time, past or planned.
    pub end: f64,
    /// True if the stage has ended.
    has_ended: bool,
}

impl PlannedStage<'_> {
    /// True where modes are found, and no time passes.
    pub fn has_modes(&self) -> bool {
        !matches!(self.kind, StageKind::Static | StageKind::Dynamic)
    }

    /// True if the stage can give an expected value, of a mode, at a frequency or at a time; a peak over frequencies must name the stage.
    pub fn reads(&self, expect: &Expect) -> bool {
        let responds = self.kind == StageKind::FrequencyResponse;
        match (expect.is_of_modes(), expect.frequency.is_some()) {
            (true, _) => self.has_modes(),
            (_, true) => responds,
            _ if responds => name_of(&expect.stage) == Some(self.name.as_str()),
            _ => !self.has_modes(),
        }
    }
}

impl<'d> StageSequence<'d> {
    /// Reads `[[stages]]`; the first stages have ended at the times `reached`.
    pub fn new(deck: &'d Deck, reached: &[f64], report: &mut Report<'d>) -> StageSequence<'d> {
        let mut sequence =
            StageSequence { whole: deck, is_shortened: !reached.is_empty(), bulges: Vec::new(), stages: Vec::new() };
        let mut begin = 0.0;
        for (index, table) in deck.stages.iter().enumerate() {
            let stage = sequence.stage(table, begin, reached.get(index).copied(), report);
            begin = stage.end;
            sequence.stages.push(stage);
        }
        sequence
    }

    fn stage(
        &self,
        table: &'d At<Table<Stage>>,
        begin: f64,
        reached: Option<f64>,
        report: &mut Report<'d>,
    ) -> PlannedStage<'d> {
        let owner = Owner::new("`[[stages]]`", &table.span);
        let name = report.require(&owner, "name", &table.name);
        if let Some(name) = name {
            if name.is_empty() {
                report.error::<()>(&name.span, "a name must not be empty");
            } else if self.stages.iter().any(|other| other.name == name.as_str()) {
                report.error::<()>(&name.span, format!("two stages have the name `{}`", name.value));
            }
        }
        let kind = report.require(&owner, "kind", &table.kind).map_or(StageKind::Dynamic, |kind| kind.value);
        let of_modes = match kind {
            StageKind::Static | StageKind::Dynamic => None,
            StageKind::Modal => Some("a modal stage"),
            StageKind::Buckling => Some("a buckling stage"),
            StageKind::FrequencyResponse => Some("a stage of a frequency response"),
        };
        let has_modes = of_modes.is_some();
        if let Some(what) = of_modes.or((kind == StageKind::Static).then_some("a static stage")) {
            report.reject_unused(what, &keys!(table; integrator));
        }
        if let Some(what) = of_modes {
            report.reject_unused(what, &keys_of_time(table));
        }
        let duration = match of_modes {
            Some(_) => 0.0,
            // The load factor of a path: loads without an amplitude have their value after this time.
            None if is_moved(table) && table.duration.is_none() => 1.0,
            None => report.require_positive(&owner, "duration", &table.duration).unwrap_or(1.0),
        };
        let end = match reached {
            Some(reached) => reached,
            None if has_modes => begin,
            None => self.end_of(table, begin, duration, report),
        };
        if reached.is_none() && !has_modes && end - begin <= SHORTEST * end {
            let message = format!("the stage goes from {begin} to {end}, too short a time to be told from none");
            let hint = format!("it must be longer than {} of the time at its end", short(SHORTEST));
            report.error_with::<()>(&table.span, message, hint);
        }
        PlannedStage {
            table,
            name: name.map_or_else(|| format!("stages.{}", self.stages.len()), |name| name.value.clone()),
            kind,
            begin,
            duration,
            end,
            has_ended: reached.is_some(),
        }
    }

    /// The planned end time of a stage, without stops by quantities.
    fn end_of(&self, table: &'d At<Table<Stage>>, begin: f64, duration: f64, report: &mut Report<'d>) -> f64 {
        let end = begin + duration;
        let Some(time) = table.stop.as_ref().and_then(|stop| stop.time.as_ref()) else { return end };
        if time.value > end && !self.is_shortened {
            let message = format!("the stage ends at {} before this time", short(end));
            report.error_with::<()>(&time.span, message, "`time` is that of the run");
        }
        if time.value <= begin {
            let message = format!("the stage begins at {begin} already");
            report.error_with::<()>(&time.span, message, "`time` is that of the run");
            return end;
        }
        end.min(time.value)
    }

    /// The end of the last stage.
    pub fn end(&self) -> f64 {
        self.stages.last().map_or(0.0, |stage| stage.end)
    }

    pub fn first_dynamic(&self) -> Option<usize> {
        self.stages.iter().position(|stage| stage.kind == StageKind::Dynamic)
    }

    /// The integrator of a stage.
    pub fn integrator(&self, stage: &PlannedStage<'d>) -> Option<&'d At<OneOf<Integrator>>> {
        stage.table.integrator.as_ref().or(self.whole.integrator.as_ref())
    }

    /// The masses of elements in all dynamic stages: those of the first with central differences, because a motion goes on with the masses it
    /// has. `None` without such a stage.
    pub fn masses(&self) -> Option<ElementMasses> {
        let mut moves = self.stages.iter().filter(|stage| stage.kind == StageKind::Dynamic);
        moves.find_map(|stage| masses(self.integrator(stage)))
    }

    pub fn position(&self, name: &str) -> Option<usize> {
        self.stages.iter().position(|stage| stage.name == name)
    }

    /// True where a table with these `stages` is there in a stage.
    pub fn holds(&self, index: usize, stages: &Maybe<Names>) -> bool {
        stages.as_ref().is_none_or(|names| names.values.iter().any(|name| name.value == self.stages[index].name))
    }

    /// The first stage with time and with a table of these `stages`, or else the first with the table.
    pub fn first(&self, stages: &Maybe<Names>) -> usize {
        let there = |index: &usize| self.holds(*index, stages);
        self.in_time().find(there).or_else(|| (0..self.stages.len()).find(there)).unwrap_or(0)
    }

    /// The stages with time, without stages of modes.
    pub fn in_time(&self) -> impl DoubleEndedIterator<Item = usize> {
        (0..self.stages.len()).filter(|&index| !self.stages[index].has_modes())
    }

    /// The last stage with time before this one.
    pub fn before(&self, index: usize) -> Option<usize> {
        self.in_time().rfind(|&before| before < index)
    }

    /// For each table with `stages`, in deck order, whether it is active in one stage.
    pub fn held(&self, index: usize) -> Vec<bool> {
        self.whole.staged().iter().map(|(_, stages)| self.holds(index, stages)).collect()
    }

    /// The functions of time for actions without an amplitude, one per stage of their first action: a static stage ramps them up, then they
    /// stay constant. Amplitudes of loads follow; under displacement control they grow or fall, below zero too, until the end of the stage.
    pub fn own_amplitudes(&self) -> impl Iterator<Item = Amplitude> {
        let ends = self.stages.iter().map(|stage| (stage, stage.end.min(stage.begin + stage.duration)));
        let of_loads = self.stages.iter().map(|stage| match is_moved(stage.table) && !stage.has_ended {
            true => (stage, stage.begin + FARTHEST * stage.duration),
            false => (stage, stage.end),
        });
        ends.chain(of_loads).map(|(stage, end)| {
            if stage.kind != StageKind::Static {
                return Amplitude::Constant;
            }
            if end == stage.begin + stage.duration {
                return Amplitude::Ramp { start: stage.begin, end };
            }
            let reached = (end - stage.begin) / stage.duration;
            Amplitude::Table(StraightLines::new(vec![[stage.begin, 0.0], [end, reached]]))
        })
    }

    /// The index of the amplitude of loads that first act in a stage, among those of [`StageSequence::own_amplitudes`].
    pub fn amplitude_of_loads(&self, index: usize) -> usize {
        index + if is_moved(self.stages[index].table) { self.stages.len() } else { 0 }
    }
}

/// True for a stage whose steps move a displacement.
fn is_moved(table: &Stage) -> bool {
    table.control.as_ref().is_some_and(|control| control.value == Control::Displacement)
}

/// True for a stage that seeks factors of loads.
pub fn buckles(table: &Stage) -> bool {
    table.kind.as_ref().is_some_and(|kind| kind.value == StageKind::Buckling)
}

/// True for a stage that finds a response over frequencies.
pub fn responds(table: &Stage) -> bool {
    table.kind.as_ref().is_some_and(|kind| kind.value == StageKind::FrequencyResponse)
}

/// The keys of a stage with time.
fn keys_of_time(table: &Stage) -> [(&'static str, Option<&Span>); 6] {
    keys!(table; duration, time_step, error_tolerance, least_step, stop, iteration)
}

pub fn name_of(name: &Maybe<String>) -> Option<&str> {
    name.as_ref().map(|name| name.as_str())
}
