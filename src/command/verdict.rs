//! The end of a run in words: its status, its warnings about energy, its expectations.

use base::names::{instant, short, to_digits};
use base::quantities::{Unit, UnitSystem};
use mechanics::integrators::spectrum::spectrum;
use model::{AnalysisKind, ArcLength, DIRECTIONS, History, Load, Model, StepLength, StopQuantity};
use results::error_bars::ErrorBar;
use results::expect::Verdict;
use results::result_json::Status;
use solve::system::energy::Balance;
use solve::{Counts, Outcome, Run, settling_energy};
use std::io;

/// A larger part of the energy is seen in the results.
const SEEN: f64 = 0.02;
/// Largest part of the energy from time integration with which the motion counts as real.
const BLOWN_UP: f64 = 0.5;

/// Smallest excess of the dissipation of dampers that has a line, as part of the energy of the motion.
const UNTOLD: f64 = 1e-3;

/// The end of a run.
pub struct End {
    /// The kind of end, which decides the exit code.
    pub status: Status,
    /// The reason in a sentence without a full stop; it is empty when done.
    pub reason: String,
    /// The time up to which results are valid, if the run stopped early.
    pub valid_until: Option<f64>,
    /// True if that time lies before the end.
    pub is_valid_before: bool,
}

impl End {
    /// The reason and its consequence for the results.
    pub fn sentence(&self) -> String {
        let valid = match self.valid_until {
            Some(_) if self.reason.contains('\n') => "\n  results are valid up to ",
            Some(_) => "; results are valid up to ",
            None => return self.reason.clone(),
        };
        let until = match self.valid_until.filter(|_| self.is_valid_before) {
            Some(time) => format!("t = {}", instant(time)),
            None => "this time".to_owned(),
        };
        format!("{}{valid}{until}", self.reason)
    }
}

/// True where time integration has made most of the energy.
pub fn has_blown_up(balance: &Balance) -> bool {
    balance.generated > BLOWN_UP * balance.peak.max(balance.rounding)
}

/// Judges the end of a run by its expectations, the stops it has missed, the time of the first unstable equilibrium, and whether the run has blown
/// up. An error is one of input/output.
pub fn end(
    outcome: Outcome,
    (short, unstable_from, has_blown_up): (&[String], Option<f64>, bool),
    expectations: &[Verdict],
) -> io::Result<End> {
    let mut is_valid_before = false;
    let (status, reason, valid_until) = match outcome {
        Outcome::Io(error) => return Err(error),
        Outcome::Failed { time, failure } => {
            let status = if failure.is_of_memory() { Status::TooLittleMemory } else { Status::NotConverged };
            let valid_until = failure.valid_until().or((!has_blown_up).then_some(time));
            is_valid_before = valid_until.is_some_and(|until| until < time);
            let invalid = match (valid_until.is_none(), failure.to_string().contains('\n')) {
                (false, _) => "",
                (true, true) => "\n  results before this time are not valid: see the growth of energy",
                (true, false) => "; results before this time are not valid: see the growth of energy",
            };
            (status, vec![format!("at t = {}: {failure}{invalid}", instant(time))], valid_until)
        }
        Outcome::Stopped { time, cut } => {
            let why = cut.as_ref().map_or_else(String::new, |cut| format!(" in a step that was cut back: {cut}"));
            (Status::Stopped, vec![format!("stopped by a signal at t = {}{why}", instant(time))], Some(time))
        }
        Outcome::Done => {
            let missed = expectations.iter().filter(|verdict| !verdict.passed).count();
            let missed = (missed > 0).then(|| format!("{missed} of {} expected values missed", expectations.len()));
            let missed: Vec<String> = missed.into_iter().chain(short.iter().cloned()).collect();
            is_valid_before = true;
            match unstable_from {
                Some(_) => {
                    let unstable = "the equilibrium is unstable: the structure buckles".to_owned();
                    (Status::NotConverged, [missed, vec![unstable]].concat(), unstable_from)
                }
                None if missed.is_empty() => (Status::Done, missed, None),
                None => (Status::ExpectationMissed, missed, None),
            }
        }
    };
    let valid_until = valid_until.map(|time| unstable_from.map_or(time, |unstable| unstable.min(time)));
    is_valid_before |= unstable_from.is_some();
    Ok(End { status, reason: reason.join("; "), valid_until, is_valid_before })
}

/// A `stop` that a stage or path did not reach before its end.
pub struct MissedStop {
    /// The value, and what to change.
    pub words: String,
    /// True unless the deck allows it.
    pub required: bool,
}

/// The `stop` that a run has missed; `None` without one.
pub fn missed_stop(model: &Model, run: &Run, time: f64) -> Option<MissedStop> {
    let remedy = "or give `stop` a value that it reaches, or `required = false`";
    let of_path = match &model.analysis.step_length {
        StepLength::ArcLength(ArcLength { stop, .. }) => stop.as_ref().zip(run.short_of_stop()),
        _ => None,
    };
    if let Some((stop, value)) = of_path {
        let (node, direction) = (&model.nodes[stop.node].label, DIRECTIONS[stop.dof]);
        let pass = if stop.pass == 1 { String::new() } else { format!(" for pass {}", stop.pass) };
        let words = format!(
            "`stop` was not reached: {direction} of `{node}` never reached {}{pass}, and is {} at the end, t = {}, after {} steps. Run longer, \
             {remedy}",
            stop.value,
            to_digits(value, DIGITS),
            instant(time),
            run.counts().steps
        );
        return Some(MissedStop { words, required: stop.required });
    }
    let stop = model.analysis.stage.as_ref()?.stop.as_ref()?;
    (run.has_stopped() == Some(false)).then(|| MissedStop {
        words: format!(
            "`stop` was not reached: {} did not come to {} until the end of the stage, t = {}. Give a longer `duration`, {remedy}",
            stop.label,
            stop.value,
            instant(time)
        ),
        required: stop.required,
    })
}

/// Notes a `stop` by work within the first step of a stage, such as joules in a deck of N and mm.
pub fn early_stop(model: &Model, run: &Run, steps: usize) -> Option<String> {
    let stop = model.analysis.stage.as_ref()?.stop.as_ref()?;
    let is_work = matches!(stop.quantity, StopQuantity::Work(_));
    (is_work && steps <= 1 && run.has_stopped() == Some(true)).then(|| {
        let units = model.output.units.as_deref().and_then(UnitSystem::find);
        let unit = Unit::Energy.text(units);
        format!("{} came to {} within the first step: see that this is in {unit}", stop.label, stop.value)
    })
}

/// The change of energy by time integration, in a line; `None` if nothing moves.
pub fn energy_line(balance: &Balance, model: &Model) -> Option<String> {
    let motion = balance.motion();
    if model.analysis.kind != AnalysisKind::Dynamic {
        return None;
    }
    if !model.output.energy {
        return Some("numerical dissipation: not measured, because `energy` in [output] is false".to_owned());
    }
    if !(motion.is_finite() && balance.lost().is_finite()) {
        return Some("numerical dissipation: not measured, because energies are not finite".to_owned());
    }
    // Steps sum the work of dampers to a few digits.
    let is_work = balance.lost() < 0.0 && balance.is_work_of_dampers(-balance.lost());
    if motion <= balance.rounding || is_work && -balance.lost() < UNTOLD * motion {
        return None;
    }
    let of = |energy: f64| of_motion(energy, balance);
    Some(if is_work {
        format!("balance of energy: dampers have dissipated more than there was, by {}", of(-balance.lost()))
    } else if is_seen(balance.generated, balance, model) {
        format!("numerical growth of energy: {}", of_largest(balance.generated, balance))
    } else if balance.lost() < 0.0 {
        format!("numerical growth of energy: {}", of(-balance.lost()))
    } else {
        format!("numerical dissipation: {}", of(balance.lost()))
    })
}

/// True where energy that was generated is seen in the results.
fn is_seen(generated: f64, balance: &Balance, model: &Model) -> bool {
    generated > SEEN * balance.peak.max(unseen(balance, model))
}

/// An energy too small to be seen.
fn unseen(balance: &Balance, model: &Model) -> f64 {
    settling_energy(model).max(balance.rounding)
}

/// A part of the largest energy in words.
fn of_largest(energy: f64, balance: &Balance) -> String {
    format!("{} % of the largest energy", to_digits(100.0 * energy / balance.peak, 2))
}

/// A part of the energy of the motion in words. Of steady motion it is far from that of all energy, and neither alone says how much
/// is missing: both are given.
fn of_motion(energy: f64, balance: &Balance) -> String {
    let percent = |of: f64| to_digits(100.0 * energy / of, 2);
    let (motion, peak) = (balance.motion(), balance.peak);
    let all = if motion < 0.5 * peak { format!(", {} % of the largest energy", percent(peak)) } else { String::new() };
    format!("{} % of the energy of the motion{all}", percent(motion))
}

/// The warning about a static analysis whose loads do other work than is stored and dissipated.
pub fn work_warning(run: &Run) -> Option<String> {
    /// Part of the energy lost by steps that jump, or bend between their ends; a gap that closes in one of twenty steps loses 0.03.
    const SEEN: f64 = 0.04;
    let (missed, energy) = run.missed_work()?;
    if missed.abs() <= SEEN * energy {
        return None;
    }
    let percent = to_digits(100.0 * missed.abs() / energy, 2);
    let how = if missed > 0.0 { "more" } else { "less" };
    Some(format!(
        "loads and supports do {how} work than is stored and dissipated at the end, by {percent} % of the energy. Either the load steps are too \
         long to sum this work, and displacements may still be right, or a step jumps to another equilibrium. Give a tenth of `time_step`; \
         `numerical` in energy.csv shows the step with the jump"
    ))
}

/// The warning about automatic steps of central differences at the limit of stability: they do not resolve a motion in the fastest modes.
pub fn overshoot_warning(run: &Run) -> Option<String> {
    /// A larger part is no error of ordinary steps.
    const SEEN: f64 = 0.1;
    run.overshoot().filter(|part| *part > SEEN).map(|part| {
        format!(
            "the motion lies in the fastest modes of the scene, and steps at the stability limit do not resolve them. Displacements overshoot by \
             about {} %. Give a `time_step` of a tenth of the period of interest, or an implicit scheme with `error_tolerance`",
            to_digits(100.0 * part, 2)
        )
    })
}

/// The warning about rows of tables that are too far apart for the motion.
pub fn rows_warning(run: &Run, model: &Model) -> Option<String> {
    /// Rows of a period that show its peak within 1.2 %.
    const ROWS: f64 = 20.0;
    run.row_gap().map(|gap| {
        let label = &model.nodes[gap.node].label;
        let [amplitude, share, period] = [gap.amplitude, 100.0 * gap.share, gap.period].map(|number| to_digits(number, 2));
        format!(
            "the rows of tables are too far apart for `{label}`: between them it moves by about {amplitude}, {share} % of its whole motion, with a \
             period near {period}. Peaks in tables are too small. Give `interval` = {} in `[output]`, or `every` = 1",
            to_digits(gap.period / ROWS, 1)
        )
    })
}

/// The warning about a run without any load or motion.
pub fn rest_warning(balance: &Balance, model: &Model) -> Option<String> {
    let is_summed = match model.analysis.kind {
        AnalysisKind::Static => !model.analysis.is_linear(),
        AnalysisKind::Dynamic => model.output.energy,
        _ => false,
    };
    // In statics a given motion may move bodies without any work.
    let is_moved = model.constraints.restraints.iter().any(|held| held.motion.is_some());
    (is_summed && !is_moved && balance.peak == 0.0).then(|| {
        "nothing moves: no load, weight, motion or initial velocity acts on a part that can follow. Give `[[loads]]`, `gravity` in `[environment]`, \
         or `[[initial]]`"
            .to_owned()
    })
}

/// True where gravity acts at once at t = 0 on deformable parts, and supports hold all that has mass.
fn weighs_at_once(model: &Model) -> bool {
    let loading = &model.loading;
    let at_start = loading.gravity_amplitude.map_or(1.0, |index| loading.amplitudes[index].value(0.0));
    let deforms = model.parts.iter().any(|part| part.kind().is_deformable());
    model.analysis.begin == 0.0 && at_start * loading.gravity.norm() != 0.0 && deforms && model::holds_all(model)
}

/// True where a load acts at once at t = 0.
fn pushes_at_once(model: &Model) -> bool {
    let loading = &model.loading;
    let at_start = |load: &Load| load.amplitude.map_or(1.0, |index| loading.amplitudes[index].value(0.0));
    model.analysis.begin == 0.0 && loading.nodal.iter().any(|load| at_start(load) != 0.0)
}

/// The warning about a bad energy balance; `None` if it is good.
pub fn energy_warning(balance: &Balance, model: &Model) -> Option<String> {
    /// The limit for the largest energy on the way. It is less strict, because an impact stores and returns energy within a step.
    const ON_THE_WAY: f64 = 0.2;
    if model.analysis.kind != AnalysisKind::Dynamic {
        return None;
    }
    let (motion, unseen) = (balance.motion(), unseen(balance, model));
    let part = |energy: f64| of_largest(energy, balance);
    let shorter = match model.analysis.step_length {
        StepLength::Fixed { .. } | StepLength::ArcLength(_) => "a tenth of `time_step`",
        StepLength::StabilityLimited { .. } => "a number as `time_step`, shorter than the steps of \"auto\"",
        StepLength::ErrorControlled { .. } => "a tenth of `error_tolerance`",
    };
    let remedy = match velocity_jump(model) {
        Some(time) => format!(
            "The velocity of a prescribed motion jumps, first at t = {}. Let steps end there, or give its amplitude `interpolation` = \"monotone\"; \
             `numerical` in energy.csv shows the effect",
            instant(time)
        ),
        None => format!("Give {shorter}; `numerical` in energy.csv shows the effect"),
    };
    let remedy = match (weighs_at_once(model), pushes_at_once(model)) {
        (true, _) => {
            format!("{remedy}. Gravity acts at once at t = 0: bring it on in a static stage before the motion")
        }
        (false, true) => format!(
            "{remedy}. Loads act at once at t = 0: forces and energies in the first rows may be those of the scheme. Let the loads grow over ten steps"
        ),
        (false, false) => remedy,
    };
    if is_seen(balance.generated, balance, model) {
        let part = part(balance.generated);
        // Plastic work is booked with the stress at the end of a step, which the motion meets only then. It is the plastic
        // strain that comes out wrong by it: no motion is made.
        Some(if balance.generated <= balance.plastic {
            format!(
                "plastic flow has dissipated more energy than was available, by {part}: steps do not resolve the onset of yielding, and plastic \
                 strains are too large. {remedy}"
            )
        } else if balance.is_work_of_dampers(balance.generated) {
            format!(
                "dampers have dissipated more energy than was available, by {part}: steps are too long to sum their work, or the time integration \
                 adds energy that they dissipate. {remedy}"
            )
        } else {
            format!("energy growth: the time integration has added {part}. {remedy}")
        })
    } else if balance.lost() > SEEN * motion.max(unseen) {
        let lost = of_motion(balance.lost(), balance);
        Some(format!("numerical dissipation: the time integration has removed {lost}. {remedy}"))
    } else if balance.dissipated > ON_THE_WAY * balance.peak.max(balance.rounding) {
        Some(format!("numerical dissipation: the time integration has removed {}. {remedy}", part(balance.dissipated)))
    } else {
        None
    }
}

/// The first time within the run at which a prescribed velocity of a support or a joint jumps.
fn velocity_jump(model: &Model) -> Option<f64> {
    let [begin, end] = [model.analysis.begin, model.analysis.end_time];
    let motions = model.constraints.restraints.iter().filter_map(|restraint| restraint.motion.as_ref());
    let positions = motions.filter(|motion| motion.history == History::Displacement);
    let jumps = positions.flat_map(|motion| model.loading.amplitudes[motion.amplitude].slope_jumps());
    jumps.filter(|time| (begin..end).contains(time) && *time > begin).min_by(f64::total_cmp)
}

/// The warning about an undamped scheme with yielding material and difficult steps, from the effort of the steps.
pub fn ringing_warning(effort: Counts, model: &Model) -> Option<String> {
    /// The ratio of step to period, times 2π, of modes that no step resolves.
    const UNRESOLVED: f64 = 30.0;
    /// Damping ratio below which there is none.
    const NONE: f64 = 1e-6;
    /// Parts of the steps that are cut, and factorizations a step: dissipating schemes stay at a tenth of these.
    const HARD: (f64, f64) = (0.02, 4.0);
    let scheme = &*model.solution.scheme;
    let is_implicit = model.analysis.kind == AnalysisKind::Dynamic && !scheme.is_explicit();
    if !is_implicit || !model.yields() || effort.steps < 100 || spectrum(scheme, UNRESOLVED).damping.abs() > NONE {
        return None;
    }
    let per_step = |count: usize| count as f64 / effort.steps as f64;
    (per_step(effort.cuts) > HARD.0 || per_step(effort.factorizations) > HARD.1).then(|| {
        format!(
            "steps converge slowly: {} factorizations and {} cutbacks in {} steps. The scheme {} has no numerical dissipation, so unresolved modes ring \
             on, and yielding material loads and unloads with them. A scheme that damps these modes alone is faster: give \
             `scheme = \"generalized-alpha\"` with `spectral_radius = 0.8`",
            effort.factorizations,
            effort.cuts,
            effort.steps,
            scheme.word()
        )
    })
}

/// The errors of a value, as they stand behind it.
fn plus_minus(by_steps: Option<f64>, by_mesh: Option<f64>) -> String {
    let errors = [(by_steps, "by the steps"), (by_mesh, "by the mesh")];
    let told = errors.iter().filter_map(|(error, whence)| Some(format!(" ± {} {whence}", to_digits((*error)?, 2))));
    told.collect()
}

/// The error of the largest value of each column, in lines for the log.
pub fn error_bars_in_words(bars: &[ErrorBar]) -> Vec<String> {
    let title = "largest values, and bounds of their errors by estimate:".to_owned();
    let line = |bar: &ErrorBar| {
        let at = if bar.at.is_empty() { String::new() } else { format!("{}, ", bar.at) };
        let (value, errors) = (to_digits(bar.value, DIGITS), plus_minus(bar.step_error, bar.mesh_error));
        format!("  {} {}: {value}{errors} ({at}t = {})", bar.table, bar.column, instant(bar.time))
    };
    let is_zero = |bar: &&ErrorBar| {
        let errors = [bar.step_error, bar.mesh_error].into_iter().flatten();
        bar.value == 0.0 && errors.fold(0.0, f64::max) == 0.0
    };
    let lines: Vec<String> = bars.iter().filter(|bar| !is_zero(bar)).map(line).collect();
    if lines.is_empty() { lines } else { std::iter::once(title).chain(lines).collect() }
}

/// The number of digits of values and of expected values.
const DIGITS: usize = 7;

/// The line on an expectation: whether it is met, its value, the expected value, and the error.
pub fn line(v: &Verdict) -> String {
    let mark = if v.passed { "ok  " } else { "MISS" };
    let value = v.value.map_or("no value".to_string(), |value| to_digits(value, DIGITS));
    let expected = to_digits(v.expected, DIGITS);
    let errors = plus_minus(v.step_error, v.mesh_error);
    if let Some(bound) = v.bound {
        return format!("{mark} {}: {value}{errors}, {bound} {expected}", v.label);
    }
    let error = match (v.error, &v.reason) {
        (Some(error), _) => {
            let kind = if v.relative { "relative" } else { "absolute" };
            format!("{kind} error {}, tolerance {}", to_digits(error, 3), short(v.tolerance))
        }
        (None, Some(reason)) => reason.clone(),
        (None, None) => String::new(),
    };
    format!("{mark} {}: {value}{errors}, expected {expected}, {error}", v.label)
}
