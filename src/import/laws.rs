//! Values in time: amplitudes of the file, and tables over all steps.

use crate::build::Build;
use crate::deck_text::{DeckTable, list, vector};
use crate::file_content::{AmplitudeCard, StepCard, StepProcedure};
use crate::time_formula::TimeFormula;
use crate::timeline::{GivenValue, InStep, TimeLaw};

/// A value jumps within this part of a step.
const JUMP: f64 = 1e-9;
/// Why a table cannot hold an amplitude by formula.
const MANY_PERIODS: &str =
    "an amplitude by formula has more than 40 periods here, too many for a table of points: give it shorter steps";
/// What becomes of an amplitude by formula.
const DRAWN: &str = "an amplitude by formula is a table of 200 points a step or more, 100 a period";

impl Build<'_, '_, '_> {
    /// The law of a value from its entries in the general steps. `is_motion`: of a support.
    pub fn law(&mut self, history: &[InStep], is_motion: bool) -> TimeLaw {
        let first = history.iter().position(|state| *state != InStep::Absent).unwrap_or(0);
        let is_plain = history[first.min(history.len())..].iter().skip(1).all(|state| *state == InStep::Holds);
        let steps = &self.im.steps.list;
        if let Some(InStep::Begins(given)) = history.get(first)
            && is_plain
            && !self.timeline.is_joined()
        {
            let stage = &self.timeline.stages[self.timeline.general[first]];
            let jumps = steps[stage.step].jumps.unwrap_or(stage.is_dynamic);
            let stages = self.timeline.from(first);
            // A motion grows by itself in static stages alone.
            let is_custom = !is_motion || !stage.is_dynamic && self.timeline.is_staged();
            if given.amplitude.is_none() && jumps == stage.is_dynamic && is_custom {
                return TimeLaw { scale: given.value, amplitude: None, stages };
            }
            if given.amplitude.is_none() && jumps && !self.timeline.is_staged() {
                let table = DeckTable::new("amplitudes", stage_line(&steps[stage.step])).text("kind", "constant");
                let amplitude = Some(self.amplitude("constant", table));
                return TimeLaw { scale: given.value, amplitude, stages };
            }
            let is_alone = self.timeline.general.len() == 1;
            // The deck counts times from the start of the run too.
            let holds = |name: &String| is_alone || first == 0 && self.is_total(name);
            if let Some(name) = given.amplitude.clone().filter(holds) {
                let scale = given.value * self.over_sine(&name);
                return TimeLaw { scale, amplitude: self.amplitude_of_file(&name, given.line), stages };
            }
        }
        self.law_as_table(history)
    }

    /// The law of the root of a value as a table over all general steps; `None` for negative values.
    pub fn law_of_roots(&mut self, history: &[InStep]) -> Option<TimeLaw> {
        let mut points = self.points(history);
        if points.iter().any(|point| point[1] < 0.0) {
            return None;
        }
        points.iter_mut().for_each(|point| point[1] = point[1].sqrt());
        Some(self.table_of(points, history))
    }

    /// The law of a value as a table over all general steps.
    pub fn law_as_table(&mut self, history: &[InStep]) -> TimeLaw {
        let points = self.points(history);
        self.table_of(points, history)
    }

    fn table_of(&mut self, points: Vec<[f64; 2]>, history: &[InStep]) -> TimeLaw {
        let scale = points.iter().map(|point| point[1]).fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
        if scale == 0.0 {
            return TimeLaw { scale: 0.0, amplitude: None, stages: None };
        }
        let rows = list(points.iter().map(|[t, value]| vector(&[*t, value / scale])));
        let line =
            history.iter().find_map(|state| if let InStep::Begins(given) = state { Some(given.line) } else { None });
        let table = DeckTable::new("amplitudes", line.unwrap_or(0)).text("kind", "table").value("points", rows);
        TimeLaw { scale, amplitude: Some(self.amplitude("history", table)), stages: None }
    }

    /// Times and values over all general steps.
    fn points(&mut self, history: &[InStep]) -> Vec<[f64; 2]> {
        let (mut points, mut value) = (vec![[0.0, 0.0]], 0.0);
        let (mut refused, mut drawn) = (Vec::new(), Vec::new());
        let mut followed: Option<(AmplitudeCard, f64, usize)> = None;
        let mut add = |t: f64, value: f64| match points.last_mut() {
            Some(last) if t <= last[0] => last[1] = value,
            _ => points.push([t, value]),
        };
        for (state, &at) in history.iter().zip(&self.timeline.general) {
            let stage = &self.timeline.stages[at];
            let (start, end) = (stage.start, stage.start + stage.duration);
            let jumps = self.im.steps.list[stage.step].jumps.unwrap_or(stage.is_dynamic);
            let soon = if start > 0.0 { start + JUMP * stage.duration } else { 0.0 };
            if let InStep::Begins(GivenValue { value: to, amplitude: Some(name), line }) = state {
                let card = self.im.amplitudes.iter().rfind(|card| card.name.to_lowercase() == name.to_lowercase());
                if card.is_none() {
                    refused.push((*line, format!("no amplitude is named `{name}`")));
                }
                followed = card.map(|card| (card.clone(), *to, *line));
            } else if *state != InStep::Holds || followed.as_ref().is_some_and(|(card, ..)| !card.is_total) {
                followed = None;
            }
            match (state, &followed) {
                // Values by the time of the run go on in later steps.
                (_, Some((card, to, line))) => {
                    drawn.extend(card.formula.as_ref().map(|_| *line));
                    let card = if card.is_total { card.seen_from(start) } else { card.clone() };
                    if card.formula.as_ref().is_some_and(|formula| formula.has_many_periods(stage.duration)) {
                        refused.push((*line, MANY_PERIODS.to_owned()));
                    }
                    for t in card.corners(stage.duration) {
                        value = to * card.at(t);
                        add(if t == 0.0 && *state != InStep::Holds { soon } else { start + t }, value);
                    }
                }
                (InStep::Holds, None) => {}
                (other, None) => {
                    let to = if let InStep::Begins(given) = other { given.value } else { 0.0 };
                    if to != value && jumps {
                        add(start, value);
                        add(soon, to);
                    } else if to != value {
                        add(start, value);
                    }
                    value = to;
                }
            }
            add(end, value);
        }
        refused.dedup();
        refused.into_iter().for_each(|(line, why)| self.im.refuse(line, &why));
        drawn.dedup();
        drawn.into_iter().for_each(|line| self.im.change(line, DRAWN));
        points
    }

    /// The law of a load that acts in one stage alone.
    pub fn law_in(&mut self, stage: &str, given: &GivenValue) -> TimeLaw {
        let amplitude = given.amplitude.as_ref().and_then(|name| self.amplitude_of_file(name, given.line));
        TimeLaw { scale: given.value, amplitude, stages: Some(vec![stage.to_owned()]) }
    }

    /// Stages of buckling factors and steady motions beside steps that advance time, and the indices of their steps.
    pub fn stages_with_own_loads(&self) -> Vec<(String, usize)> {
        let is_own = |at: usize| {
            let procedure = self.im.steps.list[self.timeline.stages[at].step].procedure.as_ref();
            matches!(procedure, Some((StepProcedure::Buckle { .. } | StepProcedure::Response(_), _)))
                && !self.timeline.general.contains(&at)
        };
        let count = if self.timeline.is_staged() { self.timeline.stages.len() } else { 0 };
        let stages = (0..count).filter(|at| is_own(*at)).map(|at| &self.timeline.stages[at]);
        stages.map(|stage| (stage.name.clone(), stage.step)).collect()
    }

    /// True for an amplitude whose times count from the start of the run.
    fn is_total(&self, name: &str) -> bool {
        let card = self.im.amplitudes.iter().rfind(|card| card.name.to_lowercase() == name.to_lowercase());
        card.is_some_and(|card| card.is_total)
    }

    /// The largest value of a sine of the file, which is 1 in the deck; 1 for other amplitudes.
    pub fn over_sine(&self, name: &str) -> f64 {
        let card = self.im.amplitudes.iter().rfind(|card| card.name.to_lowercase() == name.to_lowercase());
        card.and_then(|card| card.formula.as_ref()?.sine()).map_or(1.0, |[_, _, scale, _]| scale)
    }

    /// Adds an amplitude of the file to the deck and returns its name there; refuses one that does not exist.
    pub fn amplitude_of_file(&mut self, name: &str, line: usize) -> Option<String> {
        let card = self.im.amplitudes.iter().rfind(|card| card.name.to_lowercase() == name.to_lowercase()).cloned();
        let Some(card) = card else {
            self.im.refuse(line, &format!("no amplitude is named `{name}`"));
            return None;
        };
        let table = DeckTable::new("amplitudes", card.line);
        if let Some(phase) = card.harmonic {
            let table = table.text("kind", "harmonic");
            let table = if phase == 0.0 { table } else { table.number("phase_degrees", phase) };
            return Some(self.amplitude(card.name.trim_start_matches('*'), table));
        }
        let end = self.timeline.end();
        let table = match card.formula.as_ref().map(TimeFormula::sine) {
            Some(None) if card.formula.as_ref().is_some_and(|formula| formula.has_many_periods(end)) => {
                self.im.refuse(line, MANY_PERIODS);
                return None;
            }
            Some(None) => {
                self.im.change(line, DRAWN);
                let rows = card.corners(end).into_iter().map(|t| vector(&[t, card.at(t)]));
                table.text("kind", "table").value("points", list(rows)).text("after", "hold")
            }
            Some(Some([frequency, phase, _, start])) => {
                let table = table.text("kind", "sine").number("frequency", frequency).number("phase", phase);
                if start == 0.0 { table } else { table.number("start", start) }
            }
            None if card.points.len() == 1 => {
                let [t, value] = card.points[0];
                let rows = [vector(&[t, value]), vector(&[t + 1.0, value])];
                table
                    .text("kind", "table")
                    .value("points", list(rows.into_iter()))
                    .text("before", "hold")
                    .text("after", "hold")
            }
            None => {
                let rows = card.points.iter().map(|[t, value]| vector(&[*t, *value]));
                table.text("kind", "table").value("points", list(rows)).text("before", "hold").text("after", "hold")
            }
        };
        Some(self.amplitude(&card.name, table))
    }

    /// Adds an amplitude unless the deck has one like it; returns its name.
    pub fn amplitude(&mut self, name: &str, table: DeckTable) -> String {
        let content = table.content();
        if let Some(known) = self.amplitudes.0.get(&content) {
            return known.clone();
        }
        let unique = self.amplitudes.1.unique(name);
        self.deck.add(table.with_name(&unique));
        self.amplitudes.0.insert(content, unique.clone());
        unique
    }
}

/// The line of the procedure of a step.
fn stage_line(step: &StepCard) -> usize {
    step.procedure.as_ref().map_or(step.line, |(_, line)| *line)
}
