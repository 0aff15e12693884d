//! Checks of stages: tables that name them, and input for some kinds of stages only.

use super::current::CurrentStage;
use super::sequence::{StageSequence, buckles, name_of, responds};
use crate::procedure::response::is_excitation;
use crate::procedure::scaled_masses::{KEY, masses};
use crate::report::Report;
use crate::values::keys;
use base::diagnostic::At;
use deck::Deck;
use deck::stages::StageKind;
use deck::words::{Maybe, Names};
use std::collections::{HashMap, HashSet};

/// Reports errors of the stages of a deck, and of the tables that name them.
pub fn check<'d>(sequence: &StageSequence<'d>, report: &mut Report<'d>) {
    check_rest(sequence, report);
    check_initial(sequence, report);
    check_modes(sequence, report);
    check_masses(sequence, report);
    check_names(sequence.whole, report);
    check_tables(sequence, report);
    check_expected(sequence, report);
}

/// Reports input for runs without stages only.
fn check_rest<'d>(sequence: &StageSequence<'d>, report: &mut Report<'d>) {
    if let Some(study) = &sequence.whole.study {
        report.error_with::<()>(
            &study.span,
            "a study does not go over stages",
            "remove it, or give one [analysis] in place of the stages",
        );
    }
    let Some(analysis) = &sequence.whole.analysis else { return };
    let keys = keys!(
        analysis; kind, geometry, control, end_time, time_step, stop, increment, steps, growth, modes, up_to, damped, speeds,
        frequencies, method, damping_ratio, accuracy
    );
    report.reject_unused("a deck with `[[stages]]`, which have their kinds, durations and steps", &keys);
}

/// Reports what there is too much or too little of for stages of modes.
fn check_modes<'d>(sequence: &StageSequence<'d>, report: &mut Report<'d>) {
    let of_modes: Vec<usize> = (0..sequence.stages.len()).filter(|&index| sequence.stages[index].has_modes()).collect();
    if let (Some(&first), None) = (of_modes.first(), sequence.in_time().next()) {
        let message = "no stage is static or dynamic, so nothing leads to a state about which modes are found";
        let hint = "`kind` of `[analysis]` finds those about the equilibrium under the loads of the deck";
        report.error_with::<()>(&sequence.stages[first].table.span, message, hint);
        return;
    }
    of_modes.iter().for_each(|&index| check_new(sequence, index, report));
    for expect in sequence.whole.expect.iter().filter(|expect| expect.is_of_modes() && expect.stage.is_none()) {
        if of_modes.len() > 1 {
            let hint = "several stages have modes";
            report.error_with::<()>(&expect.span, "an expected value of a mode needs `stage` here", hint);
        }
    }
    let responses = of_modes.iter().filter(|&&index| responds(sequence.stages[index].table)).count();
    let others = sequence.whole.expect.iter().filter(|expect| !expect.is_of_modes() && expect.time.is_none());
    for expect in others.filter(|expect| expect.stage.is_none()) {
        let is_open = if expect.frequency.is_some() { responses > 1 } else { responses > 0 };
        if is_open {
            let hint = "it may be that of a response over frequencies, or of a motion over time";
            report.error_with::<()>(&expect.span, "an expected value needs `stage` here", hint);
        }
    }
}

/// Reports a motion that would go on with other masses than it has begun with.
fn check_masses<'d>(sequence: &StageSequence<'d>, report: &mut Report<'d>) {
    let known = sequence.masses();
    for stage in sequence.stages.iter().filter(|stage| stage.kind == StageKind::Dynamic) {
        let given = masses(sequence.integrator(stage));
        if given.is_some() && given != known {
            let place = stage.table.integrator.as_ref().map_or(&stage.table.span, |own| &own.span);
            let message = format!("stage `{}` would go on with other masses than the stage before", stage.name);
            let hint = format!("give the same `mass_scaling` and `{KEY}` in all stages with central differences");
            report.error_with::<()>(place, message, hint);
        }
    }
}

/// Reports input without meaning in a stage of modes, and buckling stages without loads to scale.
fn check_new<'d>(sequence: &StageSequence<'d>, index: usize, report: &mut Report<'d>) {
    let stage = &sequence.stages[index];
    let before = sequence.before(index);
    let buckles = buckles(stage.table);
    let is_new = |stages: &Maybe<Names>| {
        let all = buckles && before.is_none();
        (all || stages.is_some())
            && sequence.holds(index, stages)
            && !before.is_some_and(|before| sequence.holds(before, stages))
    };
    let new: Vec<_> = sequence.whole.loads.iter().filter(|load| is_new(&load.stages)).collect();
    for support in sequence.whole.supports.iter().filter(|support| is_new(&support.stages)) {
        if let Some(motion) = support.motion.as_ref().filter(|_| !responds(stage.table)) {
            let message = format!("nothing moves in stage `{}`", stage.name);
            report.error_with::<()>(&motion.span, message, "let the motion first act in a static or dynamic stage");
        }
    }
    if buckles && new.is_empty() {
        let message = format!("no load first acts in stage `{}`, so no buckling factor exists", stage.name);
        let hint = format!("give a load `stages = [\"{}\"]`; those of the previous stage do not change", stage.name);
        report.error_with::<()>(&stage.table.span, message, hint);
    }
    for load in new {
        match &load.amplitude {
            _ if !buckles && is_excitation(sequence.whole, load) => {}
            _ if !buckles => {
                let message = format!("nothing applies this load before the modes of stage `{}`", stage.name);
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
fn check_initial<'d>(sequence: &StageSequence<'d>, report: &mut Report<'d>) {
    let first_dynamic = sequence.first_dynamic();
    for table in &sequence.whole.initial {
        for name in table.stages.iter().flat_map(|names| &names.values) {
            if sequence.position(name).is_some_and(|index| sequence.stages[index].kind != StageKind::Dynamic) {
                let message = format!("nothing moves in stage `{}`", name.value);
                report.error_with::<()>(&name.span, message, "name a dynamic stage");
            }
        }
        if table.stages.is_none() && first_dynamic.is_none() {
            report.warn(&table.span, "this has no effect", "remove it: no stage is dynamic");
        }
    }
}

/// Reports equal names of tables in separate stages, because data are carried over between stages by name. Two in one stage are reported
/// with the names of that stage.
fn check_tables<'d>(sequence: &StageSequence<'d>, report: &mut Report<'d>) {
    let mut known: HashMap<&str, Vec<&Maybe<Names>>> = HashMap::new();
    for (name, stages) in sequence.whole.staged() {
        let Some(name) = name else { continue };
        let others = known.entry(name.as_str()).or_default();
        let meets = |other: &&Maybe<Names>| {
            (0..sequence.stages.len()).any(|index| sequence.holds(index, other) && sequence.holds(index, stages))
        };
        if !others.is_empty() && !others.iter().any(meets) {
            let message = format!("the name `{}` is taken", name.value);
            let hint = "a table of other stages has it, and parts are carried over by their names";
            report.error_with::<()>(&name.span, message, hint);
        }
        others.push(stages);
    }
}

/// Reports expected values that no stage has.
fn check_expected<'d>(sequence: &StageSequence<'d>, report: &mut Report<'d>) {
    let known: HashSet<usize> = CurrentStage::all(sequence).flat_map(|stage| stage.expected()).collect();
    for (index, expect) in sequence.whole.expect.iter().enumerate().filter(|(index, _)| !known.contains(index)) {
        let named = name_of(&expect.stage).and_then(|name| sequence.position(name));
        if expect.stage.is_some() && named.is_none() {
            // That there is no such stage has been said.
            continue;
        }
        let has_modes = named.is_some_and(|named| sequence.stages[named].has_modes());
        let (message, hint) = match (expect.is_of_modes(), &expect.frequency) {
            (true, _) => ("no modes are found there", "`mode` is expected of a modal or a buckling stage"),
            (_, Some(_)) => ("no response is found there", "`frequency` is expected of a stage of frequency response"),
            _ if has_modes => ("no time passes in this stage", "expect a `mode`, or name another stage"),
            _ => ("what this is expected of is not there", "name a stage in which it is"),
        };
        report.error_with::<()>(&sequence.whole.expect[index].span, message, hint);
    }
}

/// Reports names of stages that there are not, in any table.
pub fn check_names<'d>(deck: &'d Deck, report: &mut Report<'d>) {
    let lists = deck.staged().into_iter().map(|(_, stages)| stages);
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
