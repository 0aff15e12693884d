//! Steps in the order of the deck, and how values continue from one to the next.

use crate::dialect::Dialect;
use crate::file_content::{StepCard, StepProcedure};
use crate::importer::Importer;
use crate::linear;
use std::collections::BTreeMap;

/// A stage of the deck.
#[derive(Debug, Clone)]
pub struct StageOfStep {
    /// Its name.
    pub name: String,
    /// The index of its step.
    pub step: usize,
    /// Its begin time.
    pub start: f64,
    /// How long it lasts; 0 for modes.
    pub duration: f64,
    /// True for motion in time.
    pub is_dynamic: bool,
}

/// All stages.
#[derive(Debug, Default)]
pub struct Timeline {
    /// Stages in the order of the deck.
    pub stages: Vec<StageOfStep>,
    /// The indices of steps that advance time; the first step if there are none.
    pub general: Vec<usize>,
    /// The time step where all steps are one linear analysis.
    pub linear_step: Option<f64>,
    /// The steps of elements named by `*MODEL CHANGE`, by cell: true where the element acts.
    pub acting: BTreeMap<usize, Vec<bool>>,
}

/// The entry of a line: value, amplitude, line.
#[derive(Debug, Clone, PartialEq)]
pub struct GivenValue {
    /// The value.
    pub value: f64,
    /// The name of an amplitude of the file.
    pub amplitude: Option<String>,
    /// The line.
    pub line: usize,
}

/// The entry that holds in a step.
#[derive(Debug, Clone, PartialEq)]
pub enum InStep {
    /// Nothing acts.
    Absent,
    /// It begins, or has a new value.
    Begins(GivenValue),
    /// It goes on from the step before.
    Holds,
}

/// A value in time as the deck has it.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeLaw {
    /// The factor.
    pub scale: f64,
    /// The name of an amplitude of the deck.
    pub amplitude: Option<String>,
    /// Its stages, if it does not act in all.
    pub stages: Option<Vec<String>>,
}

impl Timeline {
    /// The stages of the steps of a file.
    pub fn new(im: &mut Importer) -> Timeline {
        let (mut first, mut rest) = (Vec::new(), Vec::new());
        let (mut start, mut unsure) = (0.0, Vec::new());
        let names = names(&im.steps.list);
        for step in 0..im.steps.list.len() {
            let (card, name) = (&im.steps.list[step], names[step].clone());
            let stage = |duration: f64, is_dynamic: bool| StageOfStep { name, step, start, duration, is_dynamic };
            match &card.procedure {
                Some((StepProcedure::Static { duration, .. }, _)) => {
                    rest.push(stage(*duration, false));
                    start += duration;
                }
                Some((StepProcedure::Dynamic { duration, .. }, _)) => {
                    rest.push(stage(*duration, true));
                    start += duration;
                }
                Some((
                    StepProcedure::Frequency { .. } | StepProcedure::Buckle { .. } | StepProcedure::Response(_),
                    _,
                )) => {
                    let in_abaqus = im.steps.list[..step].iter().any(StepCard::is_large);
                    let counts = match im.dialect {
                        Some(Dialect::Calculix) => card.is_perturbation,
                        _ => in_abaqus,
                    };
                    if im.dialect.is_none() && step > 0 && in_abaqus != card.is_perturbation {
                        unsure.push(card.line);
                    }
                    let place = if counts { &mut rest } else { &mut first };
                    place.push(stage(0.0, false));
                }
                None => {}
            }
        }
        let why = "modes see the load before them if that step has NLGEOM in Abaqus, with PERTURBATION in CalculiX: say --from abaqus or --from calculix";
        unsure.iter().for_each(|line| im.refuse(*line, why));
        first.iter_mut().for_each(|stage| stage.start = 0.0);
        first.append(&mut rest);
        let timed: Vec<usize> = (0..first.len()).filter(|&at| first[at].duration > 0.0).collect();
        // A file of modes alone uses the loads of their own step.
        let general = if timed.is_empty() { (0..first.len().min(1)).collect() } else { timed };
        Timeline { stages: first, general, linear_step: linear::time_step(im), acting: BTreeMap::new() }
    }

    /// True for a deck of stages; false for one of a single analysis.
    pub fn is_staged(&self) -> bool {
        self.stages.len() > 1 && self.linear_step.is_none()
    }

    /// True where several steps are one analysis.
    pub fn is_joined(&self) -> bool {
        self.stages.len() > 1 && self.linear_step.is_some()
    }

    /// The end time of the last stage.
    pub fn end(&self) -> f64 {
        self.stages.last().map_or(0.0, |stage| stage.start + stage.duration)
    }

    /// The stages of a value that begins in a general stage;  `None` where these are all.
    pub fn from(&self, first: usize) -> Option<Vec<String>> {
        let begin = self.general.get(first).copied().unwrap_or(0);
        (begin > 0 && self.is_staged()).then(|| self.stages[begin..].iter().map(|stage| stage.name.clone()).collect())
    }
}

/// Names of steps, each once.
fn names(steps: &[StepCard]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for step in steps {
        let mut name = step.name.clone();
        let mut next = 2;
        while names.iter().any(|known| known.to_lowercase() == name.to_lowercase()) {
            name = format!("{}_{next}", step.name);
            next += 1;
        }
        names.push(name);
    }
    names
}

/// The entries of all general steps, from lines that replace earlier ones. `lines`: of a step; `is_new`: earlier ones end.
pub fn histories<K: Ord + Clone>(
    timeline: &Timeline,
    steps: &[StepCard],
    before: Vec<(K, GivenValue)>,
    lines: impl Fn(&StepCard) -> Vec<(K, GivenValue)>,
    is_new: impl Fn(&StepCard) -> bool,
) -> BTreeMap<K, Vec<InStep>> {
    let count = timeline.general.len();
    let mut histories: BTreeMap<K, Vec<InStep>> = BTreeMap::new();
    let mut current: BTreeMap<K, GivenValue> = BTreeMap::new();
    for (at, &stage) in timeline.general.iter().enumerate() {
        let step = &steps[timeline.stages[stage].step];
        let mut next = if at == 0 { before.iter().cloned().collect() } else { current.clone() };
        if is_new(step) {
            next.clear();
        }
        next.extend(lines(step));
        for (key, given) in &next {
            let history = histories.entry(key.clone()).or_insert_with(|| vec![InStep::Absent; count]);
            let same = |old: &GivenValue| old.value == given.value && old.amplitude == given.amplitude;
            let goes_on = at > 0 && current.get(key).is_some_and(same);
            history[at] = if goes_on { InStep::Holds } else { InStep::Begins(given.clone()) };
        }
        current = next;
    }
    histories
}
