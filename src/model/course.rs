//! `[[stages]]`: their order and times, and the deck as each of them sees it.

use super::data::AnalysisKind;
use super::report::{Owner, Report};
use super::response::names_harmonic;
use super::shell_edges::Bulges;
use super::values::span;
use crate::amplitude::{Amplitude, StraightLines};
use crate::deck::Deck;
use crate::deck::analysis::{self as words, Analysis};
use crate::deck::expect::Expect;
use crate::deck::loads::Load;
use crate::deck::stages::{Stage, StageKind};
use crate::deck::words::{Maybe, Names, Table};
use crate::diagnostic::{At, Diagnostic, Span};
use crate::names::short;
use std::collections::{HashMap, HashSet};

/// The stages of a deck, one after the other.
pub(super) struct Course<'d> {
    /// The deck with all that is there in any stage.
    pub whole: &'d Deck,
    /// True after stages of which one has ended before its time: what the deck expects later is missed then, but no error.
    pub is_shortened: bool,
    /// The most that each edge of each shell may bulge; empty where only the stage itself holds edges straight.
    pub bulges: Vec<Bulges>,
    stages: Vec<PlannedStage<'d>>,
}

/// A stage of less than this part of the time at its end is lost in the rounding of times: events that are no farther than 1e-9 of it apart
/// are one, and a stage needs sixteen at which runs are compared.
const SHORTEST: f64 = 1e-7;

/// A stage with its times, which are those of the run.
struct PlannedStage<'d> {
    table: &'d At<Table<Stage>>,
    name: String,
    kind: AnalysisKind,
    /// True where modes are found, and no time passes.
    has_modes: bool,
    begin: f64,
    duration: f64,
    /// The time at which it has ended, or will if nothing stops it.
    end: f64,
}

impl PlannedStage<'_> {
    /// True where an expected value, of a mode, at a frequency or at a time, can be read: the peak over frequencies where it names the stage.
    fn reads(&self, expect: &Expect) -> bool {
        let kind = self.table.kind.as_ref().map(|kind| kind.value);
        match (expect.mode.is_some(), expect.frequency.is_some()) {
            (true, _) => self.has_modes,
            (_, true) => kind == Some(StageKind::FrequencyResponse),
            _ if kind == Some(StageKind::FrequencyResponse) => name_of(&expect.stage) == Some(self.name.as_str()),
            _ => !self.has_modes,
        }
    }
}

/// The stage whose model is built.
#[derive(Clone, Copy)]
pub(super) struct CurrentStage<'d> {
    /// All stages.
    pub course: &'d Course<'d>,
    /// Its index among them.
    pub index: usize,
}

impl<'d> Course<'d> {
    /// Reads `[[stages]]` and checks what names them; the first stages have ended at the times `reached`.
    pub fn new(deck: &'d Deck, reached: &[f64], report: &mut Report<'d>) -> Course<'d> {
        let mut course =
            Course { whole: deck, is_shortened: !reached.is_empty(), bulges: Vec::new(), stages: Vec::new() };
        let mut begin = 0.0;
        for (index, table) in deck.stages.iter().enumerate() {
            let stage = course.stage(table, begin, reached.get(index).copied(), report);
            begin = stage.end;
            course.stages.push(stage);
        }
        course.check_rest(report);
        course.check_initial(report);
        course.check_modes(report);
        check_names(deck, report);
        course.check_tables(report);
        course
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
        let kind = report.require(&owner, "kind", &table.kind);
        let is_static = kind.is_some_and(|kind| kind.value == StageKind::Static);
        let of_modes = kind.and_then(|kind| match kind.value {
            StageKind::Static | StageKind::Dynamic => None,
            StageKind::Modal => Some("a modal stage"),
            StageKind::Buckling => Some("a buckling stage"),
            StageKind::FrequencyResponse => Some("a stage of a frequency response"),
        });
        let has_modes = of_modes.is_some();
        if let Some(what) = of_modes.or(is_static.then_some("a static stage")) {
            report.reject_unused(what, &[("integrator", span(&table.integrator))]);
        }
        if let Some(what) = of_modes {
            report.reject_unused(what, &keys_of_time(table));
        }
        let duration = match of_modes {
            Some(_) => 0.0,
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
            kind: if is_static || has_modes { AnalysisKind::Static } else { AnalysisKind::Dynamic },
            has_modes,
            begin,
            duration,
            end,
        }
    }

    /// The time at which a stage ends if nothing but time stops it.
    fn end_of(&self, table: &'d At<Table<Stage>>, begin: f64, duration: f64, report: &mut Report<'d>) -> f64 {
        let end = begin + duration;
        let Some(time) = table.stop.as_ref().and_then(|stop| stop.time.as_ref()) else { return end };
        if time.value > end && !self.is_shortened {
            let message = format!("the stage ends at {} before it comes to this", short(end));
            report.error_with::<()>(&time.span, message, "`time` is that of the run");
        }
        if time.value <= begin {
            let message = format!("the stage begins at {begin} already");
            report.error_with::<()>(&time.span, message, "`time` is that of the run");
            return end;
        }
        end.min(time.value)
    }

    /// Reports what goes with a run without stages only.
    fn check_rest(&self, report: &mut Report<'d>) {
        if let Some(study) = &self.whole.study {
            report.error::<()>(&study.span, "a study does not go over stages");
        }
        let Some(analysis) = &self.whole.analysis else { return };
        let keys = [
            ("kind", span(&analysis.kind)),
            ("control", span(&analysis.control)),
            ("end_time", span(&analysis.end_time)),
            ("time_step", span(&analysis.time_step)),
            ("stop", span(&analysis.stop)),
            ("steps", span(&analysis.steps)),
            ("growth", span(&analysis.growth)),
            ("modes", span(&analysis.modes)),
            ("up_to", span(&analysis.up_to)),
            ("damped", span(&analysis.damped)),
            ("frequencies", span(&analysis.frequencies)),
            ("method", span(&analysis.method)),
            ("damping_ratio", span(&analysis.damping_ratio)),
        ];
        report.reject_unused("a deck with `[[stages]]`, which have kinds, durations and steps of their own", &keys);
    }

    /// Reports what there is too much or too little of for stages of modes.
    fn check_modes(&self, report: &mut Report<'d>) {
        let of_modes: Vec<usize> = (0..self.stages.len()).filter(|&index| self.stages[index].has_modes).collect();
        if let (Some(&first), None) = (of_modes.first(), self.in_time().next()) {
            let message = "no stage is static or dynamic, so nothing leads to a state about which modes are found";
            let hint = "`kind` of `[analysis]` finds those about the equilibrium under the loads of the deck";
            report.error_with::<()>(&self.stages[first].table.span, message, hint);
            return;
        }
        of_modes.iter().for_each(|&index| self.check_new(index, report));
        for expect in self.whole.expect.iter().filter(|expect| expect.mode.is_some() && expect.stage.is_none()) {
            if of_modes.len() > 1 {
                let hint = "several stages have modes";
                report.error_with::<()>(&expect.span, "an expected value of a mode needs `stage` here", hint);
            }
        }
        let responses = of_modes.iter().filter(|&&index| responds(self.stages[index].table)).count();
        let others = self.whole.expect.iter().filter(|expect| expect.mode.is_none() && expect.time.is_none());
        for expect in others.filter(|expect| expect.stage.is_none()) {
            let is_open = if expect.frequency.is_some() { responses > 1 } else { responses > 0 };
            if is_open {
                let hint = "it may be that of a response over frequencies, or of a motion over time";
                report.error_with::<()>(&expect.span, "an expected value needs `stage` here", hint);
            }
        }
    }

    /// Reports what first acts in a stage of modes and has no meaning there, or nothing that a buckling stage seeks the factor of.
    fn check_new(&self, index: usize, report: &mut Report<'d>) {
        let stage = &self.stages[index];
        let before = self.before(index);
        let buckles = buckles(stage.table);
        let is_new = |stages: &Maybe<Names>| {
            let all = buckles && before.is_none();
            (all || stages.is_some())
                && self.holds(index, stages)
                && !before.is_some_and(|before| self.holds(before, stages))
        };
        let new: Vec<_> = self.whole.loads.iter().filter(|load| is_new(&load.stages)).collect();
        for support in self.whole.supports.iter().filter(|support| is_new(&support.stages)) {
            if let Some(motion) = support.motion.as_ref().filter(|_| !responds(stage.table)) {
                let message = format!("nothing moves in stage `{}`", stage.name);
                report.error_with::<()>(&motion.span, message, "let the motion first act in a static or dynamic stage");
            }
        }
        if buckles && new.is_empty() {
            let message =
                format!("no load first acts in stage `{}`, so none has a factor at which it buckles", stage.name);
            let hint =
                format!("give a load `stages = [\"{}\"]`; those of the stage before stay as they are", stage.name);
            report.error_with::<()>(&stage.table.span, message, hint);
        }
        for load in new {
            match &load.amplitude {
                Some(amplitude) if !buckles && names_harmonic(self.whole, amplitude.as_str()) => {}
                _ if !buckles => {
                    let message = format!("nothing brings this load on before the modes of stage `{}`", stage.name);
                    let hint = "they are those about the state that has been reached: name a static stage before it";
                    report.error_with::<()>(&load.span, message, hint);
                }
                Some(amplitude) => {
                    let message = format!("a load of the buckling stage `{}` has no amplitude", stage.name);
                    report.error_with::<()>(&amplitude.span, message, "it is multiplied by the factor that is sought");
                }
                None => {}
            }
        }
    }

    /// Reports initial motions in stages without motion.
    fn check_initial(&self, report: &mut Report<'d>) {
        let first_dynamic = self.first_dynamic();
        for table in &self.whole.initial {
            for name in table.stages.iter().flat_map(|names| &names.values) {
                if self.position(name).is_some_and(|index| self.stages[index].kind == AnalysisKind::Static) {
                    let message = format!("nothing moves in stage `{}`", name.value);
                    report.error_with::<()>(&name.span, message, "name a dynamic stage");
                }
            }
            if table.stages.is_none() && first_dynamic.is_none() {
                report.warn(&table.span, "this has no effect", "no stage is dynamic");
            }
        }
    }

    /// Reports tables of one name in stages apart: what a stage finds of the one before is known by its name. Two in one stage are
    /// reported with the names of that stage.
    fn check_tables(&self, report: &mut Report<'d>) {
        let deck = self.whole;
        let joints = deck.joints.iter().map(|table| (&table.name, &table.stages));
        let links = deck.links.iter().map(|table| (&table.name, &table.stages));
        let contacts = deck.contacts.iter().map(|table| (&table.name, &table.stages));
        let mut known: HashMap<&str, Vec<&Maybe<Names>>> = HashMap::new();
        for (name, stages) in joints.chain(links).chain(contacts) {
            let Some(name) = name else { continue };
            let others = known.entry(name.as_str()).or_default();
            let meets = |other: &&Maybe<Names>| {
                (0..self.stages.len()).any(|index| self.holds(index, other) && self.holds(index, stages))
            };
            if !others.is_empty() && !others.iter().any(meets) {
                let message = format!("the name `{}` is taken", name.value);
                let hint = "a table of other stages has it, and what is carried over is known by its name";
                report.error_with::<()>(&name.span, message, hint);
            }
            others.push(stages);
        }
    }

    /// Reports expected values that no stage has.
    pub fn check_expected(&self, report: &mut Report<'d>) {
        let known: HashSet<usize> = CurrentStage::all(self).flat_map(|stage| stage.expected()).collect();
        for (index, expect) in self.whole.expect.iter().enumerate().filter(|(index, _)| !known.contains(index)) {
            let named = name_of(&expect.stage).and_then(|name| self.position(name));
            if expect.stage.is_some() && named.is_none() {
                // That there is no such stage has been said.
                continue;
            }
            let has_modes = named.is_some_and(|named| self.stages[named].has_modes);
            let (message, hint) = match (&expect.mode, &expect.frequency) {
                (Some(_), _) => ("no modes are found there", "`mode` is expected of a modal or a buckling stage"),
                (_, Some(_)) => {
                    ("no response is found there", "`frequency` is expected of a stage of frequency response")
                }
                _ if has_modes => ("no time passes in this stage", "expect a `mode`, or name another stage"),
                _ => ("what this is expected of is not there", "name a stage in which it is"),
            };
            report.error_with::<()>(&self.whole.expect[index].span, message, hint);
        }
    }

    /// The end of the last stage.
    pub fn end(&self) -> f64 {
        self.stages.last().map_or(0.0, |stage| stage.end)
    }

    fn first_dynamic(&self) -> Option<usize> {
        self.stages.iter().position(|stage| stage.kind == AnalysisKind::Dynamic)
    }

    fn position(&self, name: &str) -> Option<usize> {
        self.stages.iter().position(|stage| stage.name == name)
    }

    /// True where a table with these `stages` is there in a stage.
    fn holds(&self, index: usize, stages: &Maybe<Names>) -> bool {
        stages.as_ref().is_none_or(|names| names.values.iter().any(|name| name.value == self.stages[index].name))
    }

    /// The first stage in which time passes and a table with these `stages` is there, or the first of all where it is there.
    fn first(&self, stages: &Maybe<Names>) -> usize {
        let there = |index: &usize| self.holds(*index, stages);
        self.in_time().find(there).or_else(|| (0..self.stages.len()).find(there)).unwrap_or(0)
    }

    /// The stages in which time passes.
    fn in_time(&self) -> impl DoubleEndedIterator<Item = usize> {
        (0..self.stages.len()).filter(|&index| !self.stages[index].has_modes)
    }

    /// The last stage before this one in which time has passed.
    fn before(&self, index: usize) -> Option<usize> {
        self.in_time().rfind(|&before| before < index)
    }

    /// Which tables that may be limited to stages are there in one, in the order of the deck.
    fn held(&self, index: usize) -> Vec<bool> {
        let deck = self.whole;
        let supports = deck.supports.iter().map(|table| &table.stages);
        let joints = deck.joints.iter().map(|table| &table.stages);
        let links = deck.links.iter().map(|table| &table.stages);
        let contacts = deck.contacts.iter().map(|table| &table.stages);
        let loads = deck.loads.iter().map(|table| &table.stages);
        let all = supports.chain(joints).chain(links).chain(contacts).chain(loads);
        all.map(|stages| self.holds(index, stages)).collect()
    }

    /// The functions of time of loads without an amplitude, one for each stage in which they may first act: over a static stage they grow,
    /// and stay at what they have reached.
    fn own_amplitudes(&self) -> impl Iterator<Item = Amplitude> {
        self.stages.iter().map(|stage| {
            let planned = stage.begin + stage.duration;
            match stage.kind {
                AnalysisKind::Dynamic => Amplitude::Constant,
                AnalysisKind::Static if stage.has_modes => Amplitude::Constant,
                AnalysisKind::Static if stage.end >= planned => Amplitude::Ramp { start: stage.begin, end: planned },
                AnalysisKind::Static => {
                    let reached = (stage.end - stage.begin) / stage.duration;
                    Amplitude::Table(StraightLines::new(vec![[stage.begin, 0.0], [stage.end, reached]]))
                }
            }
        })
    }
}

impl<'d> CurrentStage<'d> {
    /// All stages, each as the one whose model is built.
    pub fn all(course: &'d Course<'d>) -> impl Iterator<Item = CurrentStage<'d>> {
        (0..course.stages.len()).map(move |index| CurrentStage { course, index })
    }

    /// Its table.
    pub fn table(&self) -> &'d Stage {
        &self.course.stages[self.index].table.value
    }

    /// The name of the stage.
    pub fn name(&self) -> &'d str {
        &self.course.stages[self.index].name
    }

    /// The time of its beginning and that of its end.
    pub fn times(&self) -> [f64; 2] {
        let PlannedStage { begin, end, .. } = self.course.stages[self.index];
        [begin, end]
    }

    /// Number of stages.
    pub fn count(&self) -> usize {
        self.course.stages.len()
    }

    /// The amplitudes of loads without one, which stand behind those of the deck.
    pub fn own_amplitudes(&self) -> impl Iterator<Item = Amplitude> {
        self.course.own_amplitudes()
    }

    /// The index of the amplitude of a load with these `stages` that has none.
    pub fn own_amplitude(&self, stages: &Maybe<Names>) -> usize {
        // What comes with a buckling stage is what it seeks the factor of, whatever becomes of it later.
        if buckles(self.table()) && self.is_new(stages) {
            return self.amplitude_of_stage();
        }
        self.course.whole.amplitudes.0.len() + self.course.first(stages)
    }

    /// The index of the amplitude of loads that first act in this stage and have none.
    pub fn amplitude_of_stage(&self) -> usize {
        self.course.whole.amplitudes.0.len() + self.index
    }

    /// True where a table with these `stages` is not there at t = 0.
    pub fn comes_later(&self, stages: &Maybe<Names>) -> bool {
        self.course.before(self.course.first(stages)).is_some()
    }

    /// True where a table with these `stages` is there at t = 0, and in all stages from there to its last.
    pub fn is_carried(&self, stages: &Maybe<Names>) -> bool {
        let held: Vec<bool> = self.course.in_time().map(|index| self.course.holds(index, stages)).collect();
        held.is_sorted_by(|before, after| before >= after) && !self.comes_later(stages)
    }

    /// True where no time has passed before the stage.
    pub fn is_first(&self) -> bool {
        self.course.before(self.index).is_none()
    }

    /// True where a table with these `stages` is not there in the stage before.
    pub fn is_new(&self, stages: &Maybe<Names>) -> bool {
        self.course.before(self.index).is_none_or(|before| !self.course.holds(before, stages))
    }

    /// True where the first stage with a table of these `stages` is static, and no stage of modes.
    pub fn begins_pulling(&self, stages: &Maybe<Names>) -> bool {
        let first = &self.course.stages[self.course.first(stages)];
        first.kind == AnalysisKind::Static && !first.has_modes
    }

    /// True where a table with these `stages` first acts in this one.
    pub fn is_pulled(&self, stages: &Maybe<Names>) -> bool {
        self.course.first(stages) == self.index
    }

    /// True where a table with these `stages` does not go and come back.
    pub fn is_there_once(&self, stages: &Maybe<Names>) -> bool {
        let held = self.course.in_time().map(|index| self.course.holds(index, stages));
        let changes: Vec<bool> = held.skip_while(|there| !there).collect();
        changes.is_sorted_by(|before, after| before >= after)
    }

    /// True where a support with these `stages` first acts in a static stage.
    pub fn begins_static(&self, stages: &Maybe<Names>) -> bool {
        self.course.stages[self.course.first(stages)].kind == AnalysisKind::Static
    }

    /// The time at which the clock of an amplitude starts.
    pub fn clock(&self, stage: &Maybe<String>) -> f64 {
        let named = stage.as_ref().and_then(|name| self.course.position(name));
        named.map_or(0.0, |index| self.course.stages[index].begin)
    }

    /// True where the stage before is dynamic like this one, and nothing else holds, joins, touches or loads the scene than in that one.
    pub fn goes_on(&self) -> bool {
        self.is_like_before(|index| self.course.held(index))
    }

    /// True where it is so but for the loads.
    pub fn loads_alone_change(&self) -> bool {
        // They stand last among all that a stage may have.
        let others = self.course.whole.loads.len();
        let without_loads = |index| {
            let mut held = self.course.held(index);
            held.truncate(held.len() - others);
            held
        };
        !self.goes_on() && self.is_like_before(without_loads)
    }

    fn is_like_before(&self, held: impl Fn(usize) -> Vec<bool>) -> bool {
        let Some(before) = self.course.before(self.index) else { return false };
        let dynamic = |index: usize| self.course.stages[index].kind == AnalysisKind::Dynamic;
        dynamic(before)
            && dynamic(self.index)
            && held(before) == held(self.index)
            && !self.course.whole.initial.iter().any(|table| table.stages.is_some() && self.holds(&table.stages))
    }

    fn holds(&self, stages: &Maybe<Names>) -> bool {
        self.course.holds(self.index, stages)
    }

    /// True where a load with these `stages` acts: about modes those of the stage before do.
    fn is_loaded(&self, stages: &Maybe<Names>) -> bool {
        let before = self.course.before(self.index).filter(|_| self.has_modes());
        self.holds(stages) || before.is_some_and(|before| self.course.holds(before, stages))
    }

    /// True where modes are found, and no time passes.
    pub fn has_modes(&self) -> bool {
        self.course.stages[self.index].has_modes
    }

    /// The deck as this stage sees it, and which of its expected values are read here, by their index in the deck.
    pub fn deck(&self) -> (Deck, Vec<usize>) {
        let (whole, planned) = (self.course.whole, &self.course.stages[self.index]);
        let mut deck = whole.clone();
        deck.supports.retain(|table| self.holds(&table.stages));
        deck.joints.retain(|table| self.holds(&table.stages));
        deck.links.retain(|table| self.holds(&table.stages));
        deck.contacts.retain(|table| self.holds(&table.stages));
        let excites = |load: &Load| load.amplitude.as_ref().is_some_and(|name| names_harmonic(whole, name.as_str()));
        deck.loads.retain(|table| match excites(table) {
            true => self.holds(&table.stages),
            false => self.is_loaded(&table.stages),
        });
        let first_dynamic = self.course.first_dynamic();
        // Modes before anything has moved are those of a scene that moves as it will.
        let starts = match planned.has_modes {
            true => first_dynamic.is_none_or(|first| self.index < first),
            false => first_dynamic == Some(self.index),
        };
        deck.initial.retain(|table| match &table.stages {
            Some(_) => self.holds(&table.stages),
            None => starts,
        });
        if !starts && (first_dynamic.is_some() || self.index > 0) {
            for body in &mut deck.bodies {
                (body.value.velocity, body.value.angular_velocity) = (None, None);
            }
        }
        let here = self.expected();
        let mut index = 0..;
        deck.expect.retain(|_| index.next().is_some_and(|index| here.contains(&index)));
        deck.analysis = Some(At { value: Table::new(self.analysis()), span: planned.table.span.clone() });
        if let Some(own) = &planned.table.integrator {
            deck.integrator = Some(own.clone());
        }
        if let Some(own) = &planned.table.iteration {
            deck.iteration = Some(own.clone());
        }
        if planned.kind == AnalysisKind::Static && first_dynamic.is_some() {
            deck.integrator = None;
            deck.damping.take_if(|_| !planned.has_modes);
        }
        deck.study = None;
        (deck, here)
    }

    /// The expected values that can be read in this stage.
    fn expected(&self) -> Vec<usize> {
        let deck = self.course.whole;
        let name = |name: &'d Maybe<String>| name.as_ref().map(|name| name.as_str());
        let joints = deck.joints.iter().filter(|table| !self.holds(&table.stages)).map(|table| &table.name);
        let links = deck.links.iter().filter(|table| !self.holds(&table.stages)).map(|table| &table.name);
        let contacts = deck.contacts.iter().filter(|table| !self.holds(&table.stages)).map(|table| &table.name);
        let absent: HashSet<&str> = joints.chain(links).chain(contacts).filter_map(name).collect();
        let here = |expect: &Expect| {
            name_of(&expect.at).is_none_or(|at| !absent.contains(at))
                && self.course.stages[self.index].reads(expect)
                && name_of(&expect.stage).is_none_or(|stage| stage == self.name())
        };
        let all = deck.expect.iter().enumerate();
        all.filter(|(_, expect)| here(expect)).map(|(index, _)| index).collect()
    }

    /// The stage as `[analysis]` of its deck; its time counts from the beginning of the stage, and is that which the deck gives: steps that
    /// fit into it still do after rounding, and after a stop.
    fn analysis(&self) -> Analysis {
        let PlannedStage { table, kind, has_modes, duration, .. } = &self.course.stages[self.index];
        let all = self.course.whole.analysis.as_ref();
        let place = |own: Option<&Span>| own.unwrap_or(&table.span).clone();
        let automatic = table.time_step.as_ref().is_some_and(|at| at.value == crate::deck::words::NumberOrAuto::Auto);
        let general = all.and_then(|all| all.error_tolerance.clone()).filter(|_| automatic);
        let word = match table.kind.as_ref().map(|kind| kind.value) {
            Some(StageKind::Modal) => words::AnalysisKind::Modal,
            Some(StageKind::Buckling) => words::AnalysisKind::Buckling,
            Some(StageKind::FrequencyResponse) => words::AnalysisKind::FrequencyResponse,
            _ if *kind == AnalysisKind::Static => words::AnalysisKind::Static,
            _ => words::AnalysisKind::Dynamic,
        };
        let least_step = table.least_step.clone().or_else(|| all.and_then(|all| all.least_step.clone()));
        Analysis {
            kind: Some(At { value: word, span: place(span(&table.kind)) }),
            control: None,
            end_time: (!has_modes).then(|| At { value: *duration, span: place(span(&table.duration)) }),
            time_step: table.time_step.clone().filter(|_| !has_modes),
            error_tolerance: table.error_tolerance.clone().or(general).filter(|_| !has_modes),
            least_step: least_step.filter(|_| !has_modes),
            stop: None,
            steps: None,
            growth: None,
            plane: all.and_then(|all| all.plane.clone()),
            modes: table.modes.clone(),
            up_to: table.up_to.clone(),
            damped: table.damped.clone(),
            frequencies: table.frequencies.clone(),
            method: table.method.clone(),
            damping_ratio: table.damping_ratio.clone(),
        }
    }
}

/// True for a stage that seeks factors of loads.
fn buckles(table: &Stage) -> bool {
    table.kind.as_ref().is_some_and(|kind| kind.value == StageKind::Buckling)
}

/// True for a stage that finds a response over frequencies.
fn responds(table: &Stage) -> bool {
    table.kind.as_ref().is_some_and(|kind| kind.value == StageKind::FrequencyResponse)
}

/// The keys of a stage in which time passes.
fn keys_of_time(table: &Stage) -> [(&'static str, Option<&Span>); 6] {
    [
        ("duration", span(&table.duration)),
        ("time_step", span(&table.time_step)),
        ("error_tolerance", span(&table.error_tolerance)),
        ("least_step", span(&table.least_step)),
        ("stop", span(&table.stop)),
        ("iteration", span(&table.iteration)),
    ]
}

fn name_of(name: &Maybe<String>) -> Option<&str> {
    name.as_ref().map(|name| name.as_str())
}

/// Reports names of stages that there are not, in any table.
pub(super) fn check_names<'d>(deck: &'d Deck, report: &mut Report<'d>) {
    let lists = deck.supports.iter().map(|table| &table.stages);
    let lists = lists.chain(deck.joints.iter().map(|table| &table.stages));
    let lists = lists.chain(deck.links.iter().map(|table| &table.stages));
    let lists = lists.chain(deck.contacts.iter().map(|table| &table.stages));
    let lists = lists.chain(deck.loads.iter().map(|table| &table.stages));
    let lists = lists.chain(deck.initial.iter().map(|table| &table.stages)).flatten();
    let lists: Vec<&At<Names>> = lists.collect();
    for list in lists.iter().filter(|list| list.values.is_empty()) {
        report.error_with::<()>(&list.span, "`stages` is empty", "leave it out for all stages");
    }
    let single = deck.expect.iter().map(|table| &table.stage);
    let single = single.chain(deck.amplitudes.0.iter().map(|(_, table)| &table.stage)).flatten();
    let known: Vec<&str> = deck.stages.iter().filter_map(|stage| name_of(&stage.name)).collect();
    for name in lists.iter().flat_map(|list| &list.values).chain(single) {
        if !known.contains(&name.as_str()) {
            report.unknown::<()>("stage", name, known.iter().copied());
        }
    }
}

/// What is said of the decks of several stages: each thing once, and in which stages where not in all.
pub(super) fn merge(of_stages: Vec<(String, Vec<Diagnostic>)>) -> Vec<Diagnostic> {
    let count = of_stages.len();
    let mut all: Vec<(Diagnostic, Vec<String>)> = Vec::new();
    for (name, problems) in of_stages {
        for problem in problems {
            match all.iter_mut().find(|(said, _)| *said == problem) {
                Some((_, stages)) => stages.push(name.clone()),
                None => all.push((problem, vec![name.clone()])),
            }
        }
    }
    let told = |(problem, stages): (Diagnostic, Vec<String>)| match stages.len() < count {
        true => {
            let (word, named) = (if stages.len() == 1 { "stage" } else { "stages" }, stages.join("`, `"));
            problem.hint(format!("in {word} `{named}`"))
        }
        false => problem,
    };
    all.into_iter().map(told).collect()
}
