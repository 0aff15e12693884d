//! The stage whose model is built, and the deck as it sees it.

use super::sequence::{PlannedStage, StageSequence, buckles, name_of};
use crate::procedure::response::is_excitation;
use crate::values::span;
use base::diagnostic::{At, Span};
use deck::Deck;
use deck::analysis::{self as words, Analysis};
use deck::expect::Expect;
use deck::stages::{Stage, StageKind, Stop, StopQuantity};
use deck::words::{Maybe, Names, Table};
use mechanics::amplitude::Amplitude;
use std::collections::HashSet;

/// The stage whose model is built.
#[derive(Clone, Copy)]
pub struct CurrentStage<'d> {
    /// All stages.
    pub sequence: &'d StageSequence<'d>,
    /// Its index among them.
    pub index: usize,
}

impl<'d> CurrentStage<'d> {
    /// All stages, each as the one whose model is built.
    pub fn all(sequence: &'d StageSequence<'d>) -> impl Iterator<Item = CurrentStage<'d>> {
        (0..sequence.stages.len()).map(move |index| CurrentStage { sequence, index })
    }

    /// Its table.
    pub fn table(&self) -> &'d Stage {
        &self.sequence.stages[self.index].table.value
    }

    /// The name of the stage.
    pub fn name(&self) -> &'d str {
        &self.sequence.stages[self.index].name
    }

    /// The time of its beginning and that of its end.
    pub fn times(&self) -> [f64; 2] {
        let PlannedStage { begin, end, .. } = self.sequence.stages[self.index];
        [begin, end]
    }

    /// Number of stages.
    pub fn count(&self) -> usize {
        self.sequence.stages.len()
    }

    /// The amplitudes of actions without one, which stand behind those of the deck.
    pub fn own_amplitudes(&self) -> impl Iterator<Item = Amplitude> {
        self.sequence.own_amplitudes()
    }

    /// The index of the amplitude of a load with these `stages` that has none.
    pub fn amplitude_of_load(&self, stages: &Maybe<Names>) -> usize {
        let own = self.own_amplitude(stages);
        let first = own - self.sequence.whole.amplitudes.0.len();
        own - first + self.sequence.amplitude_of_loads(first)
    }

    /// The index of the amplitude of another action with these `stages` that has none.
    pub fn own_amplitude(&self, stages: &Maybe<Names>) -> usize {
        // A buckling stage scales the loads that first act in it, also if they act later.
        if buckles(self.table()) && self.is_new(stages) {
            return self.amplitude_of_stage();
        }
        self.sequence.whole.amplitudes.0.len() + self.sequence.first(stages)
    }

    /// The index of the amplitude of actions that first act in this stage and have none.
    pub fn amplitude_of_stage(&self) -> usize {
        self.sequence.whole.amplitudes.0.len() + self.index
    }

    /// The index of the amplitude of loads likewise.
    pub fn amplitude_of_loads(&self) -> usize {
        self.sequence.whole.amplitudes.0.len() + self.sequence.amplitude_of_loads(self.index)
    }

    /// True where a table with these `stages` is not there at t = 0.
    pub fn comes_later(&self, stages: &Maybe<Names>) -> bool {
        self.sequence.before(self.sequence.first(stages)).is_some()
    }

    /// True where a table with these `stages` is there at t = 0, and in all stages from there to its last.
    pub fn is_carried(&self, stages: &Maybe<Names>) -> bool {
        let held: Vec<bool> = self.sequence.in_time().map(|index| self.sequence.holds(index, stages)).collect();
        held.is_sorted_by(|before, after| before >= after) && !self.comes_later(stages)
    }

    /// True where a table with these `stages`, once there, is in all later ones.
    pub fn stays(&self, stages: &Maybe<Names>) -> bool {
        self.sequence.in_time().map(|index| self.sequence.holds(index, stages)).is_sorted()
    }

    /// True for a stage that seeks factors of loads.
    pub fn buckles(&self) -> bool {
        buckles(self.table())
    }

    /// True where no time has passed before the stage.
    pub fn is_first(&self) -> bool {
        self.sequence.before(self.index).is_none()
    }

    /// True where a table with these `stages` is not there in the stage before.
    pub fn is_new(&self, stages: &Maybe<Names>) -> bool {
        self.sequence.before(self.index).is_none_or(|before| !self.sequence.holds(before, stages))
    }

    /// True where the first stage with a table of these `stages` is static, and no stage of modes.
    pub fn begins_pulling(&self, stages: &Maybe<Names>) -> bool {
        self.sequence.stages[self.sequence.first(stages)].kind == StageKind::Static
    }

    /// True where a table with these `stages` first acts in this one.
    pub fn is_pulled(&self, stages: &Maybe<Names>) -> bool {
        self.sequence.first(stages) == self.index
    }

    /// True where a table with these `stages` does not go and come back.
    pub fn is_there_once(&self, stages: &Maybe<Names>) -> bool {
        let held = self.sequence.in_time().map(|index| self.sequence.holds(index, stages));
        let changes: Vec<bool> = held.skip_while(|there| !there).collect();
        changes.is_sorted_by(|before, after| before >= after)
    }

    /// True where a support with these `stages` first acts in a static stage.
    pub fn begins_static(&self, stages: &Maybe<Names>) -> bool {
        self.sequence.stages[self.sequence.first(stages)].kind != StageKind::Dynamic
    }

    /// The zero time of an amplitude.
    pub fn clock(&self, stage: &Maybe<String>) -> f64 {
        let named = stage.as_ref().and_then(|name| self.sequence.position(name));
        named.map_or(0.0, |index| self.sequence.stages[index].begin)
    }

    /// The start and the name of the first dynamic stage, if other stages with time come before it: there a record of the ground begins.
    pub fn start_of_motion(&self) -> Option<(f64, &'d str)> {
        let first = self.sequence.first_dynamic()?;
        let stage = &self.sequence.stages[first];
        self.sequence.before(first).map(|_| (stage.begin, stage.name.as_str()))
    }

    /// True where an earlier stage is dynamic.
    pub fn follows_motion(&self) -> bool {
        self.sequence.first_dynamic().is_some_and(|first| first < self.index)
    }

    /// True if the stage before is dynamic like this one, with the same supports, joints, contacts and loads.
    pub fn goes_on(&self) -> bool {
        self.is_like_before(|index| self.sequence.held(index))
    }

    /// True if this holds except for the loads.
    pub fn loads_alone_change(&self) -> bool {
        // Loads and gravity come last in the list of tables with stages.
        let whole = self.sequence.whole;
        let others = whole.loads.len() + usize::from(whole.environment.is_some());
        let without_loads = |index| {
            let mut held = self.sequence.held(index);
            held.truncate(held.len() - others);
            held
        };
        !self.goes_on() && self.is_like_before(without_loads)
    }

    fn is_like_before(&self, held: impl Fn(usize) -> Vec<bool>) -> bool {
        let Some(before) = self.sequence.before(self.index) else { return false };
        let dynamic = |index: usize| self.sequence.stages[index].kind == StageKind::Dynamic;
        dynamic(before)
            && dynamic(self.index)
            && held(before) == held(self.index)
            && !self.sequence.whole.initial.iter().any(|table| table.stages.is_some() && self.holds(&table.stages))
    }

    fn holds(&self, stages: &Maybe<Names>) -> bool {
        self.sequence.holds(self.index, stages)
    }

    /// The names of the nodes at the ends of links and joints that other stages have.
    pub fn ends_elsewhere(&self) -> impl Iterator<Item = &'d At<String>> {
        let whole = self.sequence.whole;
        let links = whole.links.iter().map(|link| (&link.stages, [&link.from, &link.to]));
        let joints = whole.joints.iter().map(|joint| (&joint.stages, [&joint.from, &joint.to]));
        let away = links.chain(joints).filter(|(stages, _)| !self.holds(stages));
        away.flat_map(|(_, ends)| ends).flatten().filter_map(|end| end.node.as_ref())
    }

    /// True where a load with these `stages` acts: about modes those of the stage before do.
    pub fn is_loaded(&self, stages: &Maybe<Names>) -> bool {
        let before = self.sequence.before(self.index).filter(|_| self.has_modes());
        self.holds(stages) || before.is_some_and(|before| self.sequence.holds(before, stages))
    }

    /// True where modes are found, and no time passes.
    pub fn has_modes(&self) -> bool {
        self.sequence.stages[self.index].has_modes()
    }

    /// The deck as this stage sees it, and which of its expected values are read here, by their index in the deck.
    pub fn deck(&self) -> (Deck, Vec<usize>) {
        let (whole, planned) = (self.sequence.whole, &self.sequence.stages[self.index]);
        let mut deck = whole.clone();
        deck.supports.retain(|table| self.holds(&table.stages));
        deck.joints.retain(|table| self.holds(&table.stages));
        deck.links.retain(|table| self.holds(&table.stages));
        deck.contacts.retain(|table| self.holds(&table.stages));
        deck.loads.retain(|table| match is_excitation(whole, table) {
            true => self.holds(&table.stages),
            false => self.is_loaded(&table.stages),
        });
        let first_dynamic = self.sequence.first_dynamic();
        // Modes before anything has moved are those of a scene that moves as it will.
        let starts = match planned.has_modes() {
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
        if planned.kind != StageKind::Dynamic && first_dynamic.is_some() {
            deck.integrator = None;
            deck.damping.take_if(|_| !planned.has_modes());
        }
        deck.study = None;
        (deck, here)
    }

    /// The expected values that can be read in this stage.
    pub fn expected(&self) -> Vec<usize> {
        let deck = self.sequence.whole;
        let absent = deck.staged().into_iter().filter(|(_, stages)| !self.holds(stages));
        let absent: HashSet<&str> = absent.filter_map(|(name, _)| Some(name?.as_str())).collect();
        let here = |expect: &Expect| {
            name_of(&expect.at).is_none_or(|at| !absent.contains(at))
                && self.sequence.stages[self.index].reads(expect)
                && name_of(&expect.stage).is_none_or(|stage| stage == self.name())
        };
        let all = deck.expect.iter().enumerate();
        all.filter(|(_, expect)| here(expect)).map(|(index, _)| index).collect()
    }

    /// The `stop` of a stage that follows a path, as that of `[analysis]`. Rotations and loads do not stop a path.
    fn path_stop(&self) -> Maybe<Table<words::DisplacementTarget>> {
        let table = self.table();
        table.control.as_ref().filter(|at| at.value != words::Control::Time)?;
        let given = table.stop.as_ref()?;
        let stop: &Stop = &given.value;
        let word = |quantity: StopQuantity| match quantity {
            StopQuantity::Ux => Some(words::Displacement::Ux),
            StopQuantity::Uy => Some(words::Displacement::Uy),
            StopQuantity::Uz => Some(words::Displacement::Uz),
            StopQuantity::Rx | StopQuantity::Ry | StopQuantity::Rz => None,
        };
        let quantity = stop.quantity.as_ref()?;
        let target = words::DisplacementTarget {
            at: stop.at.clone(),
            quantity: Some(At { value: word(quantity.value)?, span: quantity.span.clone() }),
            value: stop.value.clone(),
            pass: None,
            required: stop.required.clone(),
        };
        Some(At { value: Table::new(target), span: given.span.clone() })
    }

    /// The stage as `[analysis]` of its deck. Its time counts from the beginning of the stage with the duration of the deck, so that steps
    /// fit into it exactly, also after a stop.
    fn analysis(&self) -> Analysis {
        let PlannedStage { table, kind, duration, .. } = &self.sequence.stages[self.index];
        let has_modes = self.has_modes();
        let all = self.sequence.whole.analysis.as_ref();
        let place = |own: Option<&Span>| own.unwrap_or(&table.span).clone();
        let automatic =
            table.time_step.as_ref().is_some_and(|at| matches!(at.value, deck::words::NumberOrAuto::Word(_)));
        let general = all.and_then(|all| all.error_tolerance.clone()).filter(|_| automatic);
        let word = match kind {
            StageKind::Static => words::AnalysisKind::Static,
            StageKind::Dynamic => words::AnalysisKind::Dynamic,
            StageKind::Modal => words::AnalysisKind::Modal,
            StageKind::Buckling => words::AnalysisKind::Buckling,
            StageKind::FrequencyResponse => words::AnalysisKind::FrequencyResponse,
        };
        let least_step = table.least_step.clone().or_else(|| all.and_then(|all| all.least_step.clone()));
        Analysis {
            kind: Some(At { value: word, span: place(span(&table.kind)) }),
            control: table.control.clone().filter(|_| !has_modes),
            geometry: None,
            end_time: (!has_modes).then(|| At { value: *duration, span: place(span(&table.duration)) }),
            time_step: table.time_step.clone().filter(|_| !has_modes),
            accuracy: None,
            error_tolerance: table.error_tolerance.clone().or(general).filter(|_| !has_modes),
            least_step: least_step.filter(|_| !has_modes),
            stop: self.path_stop(),
            increment: table.increment.clone(),
            steps: table.steps.clone(),
            growth: table.growth.clone(),
            plane: all.and_then(|all| all.plane.clone()),
            modes: table.modes.clone(),
            up_to: table.up_to.clone(),
            damped: table.damped.clone(),
            speeds: table.speeds.clone(),
            frequencies: table.frequencies.clone(),
            method: table.method.clone(),
            damping_ratio: table.damping_ratio.clone(),
        }
    }
}
