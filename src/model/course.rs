//! `[[stages]]`: their order and times, and the deck as each of them sees it.

use super::data::AnalysisKind;
use super::report::{Owner, Report};
use super::shell_edges::Bulges;
use super::values::span;
use crate::amplitude::{Amplitude, StraightLines};
use crate::deck::Deck;
use crate::deck::analysis::{self as words, Analysis};
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
    begin: f64,
    duration: f64,
    /// The time at which it has ended, or will if nothing stops it.
    end: f64,
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
        if let Some(kind) = kind.filter(|kind| matches!(kind.value, StageKind::Modal | StageKind::Buckling)) {
            let word = if kind.value == StageKind::Modal { "modal" } else { "buckling" };
            let message = format!("stages of the kind \"{word}\" are not supported");
            report.error_with::<()>(&kind.span, message, "a stage is \"static\" or \"dynamic\"");
        }
        if is_static {
            report.reject_unused("a static stage", &[("integrator", span(&table.integrator))]);
        }
        let duration = report.require_positive(&owner, "duration", &table.duration).unwrap_or(1.0);
        let end = reached.unwrap_or_else(|| self.end_of(table, begin, duration, report));
        if reached.is_none() && end - begin <= SHORTEST * end {
            let message = format!("the stage goes from {begin} to {end}, too short a time to be told from none");
            let hint = format!("it must be longer than {} of the time at its end", short(SHORTEST));
            report.error_with::<()>(&table.span, message, hint);
        }
        PlannedStage {
            table,
            name: name.map_or_else(|| format!("stages.{}", self.stages.len()), |name| name.value.clone()),
            kind: if is_static { AnalysisKind::Static } else { AnalysisKind::Dynamic },
            begin,
            duration,
            end,
        }
    }

    /// The time at which a stage ends if nothing but time stops it.
    fn end_of(&self, table: &'d At<Table<Stage>>, begin: f64, duration: f64, report: &mut Report<'d>) -> f64 {
        let end = begin + duration;
        let Some(time) = table.stop.as_ref().and_then(|stop| stop.time.as_ref()) else { return end };
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
        ];
        report.reject_unused("a deck with `[[stages]]`, which have kinds, durations and steps of their own", &keys);
    }

    /// Reports initial motions in stages without motion.
    fn check_initial(&self, report: &mut Report<'d>) {
        let first_dynamic = self.first_dynamic();
        for table in &self.whole.initial {
            for name in table.stages.iter().flat_map(|names| &names.values) {
                let named = self.position(name).filter(|&index| self.stages[index].kind == AnalysisKind::Static);
                if named.is_some() {
                    let message = format!("stage `{}` is static, so nothing moves in it", name.value);
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

    /// The first stage in which a table with these `stages` is there.
    fn first(&self, stages: &Maybe<Names>) -> usize {
        (0..self.stages.len()).find(|&index| self.holds(index, stages)).unwrap_or(0)
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
        self.course.whole.amplitudes.0.len() + self.course.first(stages)
    }

    /// True where a table with these `stages` is not there at t = 0.
    pub fn comes_later(&self, stages: &Maybe<Names>) -> bool {
        self.course.first(stages) > 0
    }

    /// True where a table with these `stages` is not there in the stage before.
    pub fn is_new(&self, stages: &Maybe<Names>) -> bool {
        self.index.checked_sub(1).is_none_or(|before| !self.course.holds(before, stages))
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
        let Some(before) = self.index.checked_sub(1) else { return false };
        let dynamic = |index: usize| self.course.stages[index].kind == AnalysisKind::Dynamic;
        dynamic(before)
            && dynamic(self.index)
            && held(before) == held(self.index)
            && !self.course.whole.initial.iter().any(|table| table.stages.is_some() && self.holds(&table.stages))
    }

    fn holds(&self, stages: &Maybe<Names>) -> bool {
        self.course.holds(self.index, stages)
    }

    /// The deck as this stage sees it, and which of its expected values are read here, by their index in the deck.
    pub fn deck(&self) -> (Deck, Vec<usize>) {
        let (whole, planned) = (self.course.whole, &self.course.stages[self.index]);
        let mut deck = whole.clone();
        deck.supports.retain(|table| self.holds(&table.stages));
        deck.joints.retain(|table| self.holds(&table.stages));
        deck.links.retain(|table| self.holds(&table.stages));
        deck.contacts.retain(|table| self.holds(&table.stages));
        deck.loads.retain(|table| self.holds(&table.stages));
        let first_dynamic = self.course.first_dynamic();
        deck.initial.retain(|table| match &table.stages {
            Some(_) => self.holds(&table.stages),
            None => first_dynamic == Some(self.index),
        });
        if first_dynamic.unwrap_or(0) != self.index {
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
            (deck.integrator, deck.damping) = (None, None);
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
        let here = |expect: &crate::deck::expect::Expect| {
            name_of(&expect.at).is_none_or(|at| !absent.contains(at))
                && name_of(&expect.stage).is_none_or(|stage| stage == self.name())
        };
        let all = deck.expect.iter().enumerate();
        all.filter(|(_, expect)| here(expect)).map(|(index, _)| index).collect()
    }

    /// The stage as `[analysis]` of its deck; its time counts from the beginning of the stage, and is that which the deck gives: steps that
    /// fit into it still do after rounding, and after a stop.
    fn analysis(&self) -> Analysis {
        let PlannedStage { table, kind, duration, .. } = &self.course.stages[self.index];
        let all = self.course.whole.analysis.as_ref();
        let place = |own: Option<&Span>| own.unwrap_or(&table.span).clone();
        let automatic = table.time_step.as_ref().is_some_and(|at| at.value == crate::deck::words::NumberOrAuto::Auto);
        let general = all.and_then(|all| all.error_tolerance.clone()).filter(|_| automatic);
        let word = match kind {
            AnalysisKind::Static => words::AnalysisKind::Static,
            AnalysisKind::Dynamic => words::AnalysisKind::Dynamic,
        };
        Analysis {
            kind: Some(At { value: word, span: place(span(&table.kind)) }),
            control: None,
            end_time: Some(At { value: *duration, span: place(span(&table.duration)) }),
            time_step: table.time_step.clone(),
            error_tolerance: table.error_tolerance.clone().or(general),
            least_step: table.least_step.clone().or_else(|| all.and_then(|all| all.least_step.clone())),
            stop: None,
            steps: None,
            growth: None,
            plane: all.and_then(|all| all.plane.clone()),
            modes: None,
            up_to: None,
            damped: None,
        }
    }
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
