//! Steady motions: `*STEADY STATE DYNAMICS`, the real and imaginary parts of its loads, and `*MODAL DAMPING`.
//!
//! A load a + i b of these programs is a cos ωt − b sin ωt: its imaginary part has a phase of 90 degrees.

use crate::deck_text::{DeckTable, inline, number, quoted};
use crate::dialect::Dialect;
use crate::file_content::{AmplitudeCard, ModalDamping, ResponseCard, StepCard, StepProcedure, SupportLine};
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::step_cards;

/// Frequencies between two natural ones unless the file says otherwise, in both programs.
const POINTS: u64 = 20;
/// The amplitudes of real and imaginary parts in the deck, and their phases. No name of a file begins with an asterisk.
const PARTS: [(&str, f64); 2] = [("*real", 0.0), ("*imaginary", 90.0)];

/// `*STEADY STATE DYNAMICS`.
pub fn steady_state(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    let is_no = |name: &str| keyword.value(name).is_some_and(|value| value.eq_ignore_ascii_case("NO"));
    if is_no("HARMONIC") {
        return im.refuse(line, "loads are harmonic in rdsolve: compute other periodic loads by *DYNAMIC");
    }
    let lines: Vec<_> = block.data.iter().filter(|data| data.filled() > 0).collect();
    let [data] = lines[..] else {
        return im.refuse(line, "*STEADY STATE DYNAMICS needs one line with its lowest and highest frequency");
    };
    let mut at = |at: usize| im.number_at(data, at).filter(|x| *x > 0.0);
    let from = at(0).unwrap_or(0.0);
    let (to, points) = (at(1).unwrap_or(from), at(2).map_or(POINTS, |count| count as u64));
    if to < from {
        return im.refuse(line, "the highest frequency must not be below the lowest");
    }
    let is_direct = keyword.has("DIRECT");
    let is = |name: &str, word: &str| keyword.value(name).is_some_and(|value| value.eq_ignore_ascii_case(word));
    let in_abaqus = im.dialect == Some(Dialect::Abaqus);
    let is_gathered = !is("INTERVAL", "RANGE") && !is_direct && to > from;
    let is_logarithmic = in_abaqus && !is("FREQUENCYSCALE", "LINEAR") && from > 0.0;
    let points = if to > from { points.max(2) } else { 1 };
    let card = ResponseCard { range: [from, to], points, is_logarithmic, is_gathered, is_direct, modes: (None, None) };
    step_cards::set(im, line, StepProcedure::Response(card));
}

/// `*MODAL DAMPING`.
pub fn modal_damping(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    if keyword.has("STRUCTURAL") {
        return im.refuse(line, "rdsolve has no structural damping; give a damping ratio");
    }
    let rows: Vec<Vec<f64>> = block.data.iter().filter(|data| data.filled() > 0).map(|data| im.numbers(data)).collect();
    let is_rayleigh = keyword.has("RAYLEIGH");
    // Modes from and to, then a ratio or alpha and beta; frequency and ratio with DEFINITION=FREQUENCY RANGE.
    let of_frequency =
        keyword.value("DEFINITION").is_some_and(|by| by.to_ascii_uppercase().starts_with("FREQUENCY")) && !is_rayleigh;
    let first = if of_frequency { 1 } else { 2 };
    let of = |row: &Vec<f64>, at: usize| row.get(first + at).copied().unwrap_or(0.0);
    let all: Vec<[f64; 2]> = rows.iter().map(|row| [of(row, 0), if is_rayleigh { of(row, 1) } else { 0.0 }]).collect();
    let Some(&values) = all.first() else { return im.refuse(line, "*MODAL DAMPING needs values on the line below") };
    if all.iter().any(|other| *other != values) {
        return im.refuse(line, "all modes have the same damping in rdsolve");
    }
    let damping = if is_rayleigh { ModalDamping::Rayleigh(values) } else { ModalDamping::Ratio(values[0]) };
    im.steps.at_hand().damping = Some((damping, line));
}

/// Gives loads of steady motions their amplitudes, and joins the modes that such a motion is made of with it.
pub fn prepare(im: &mut Importer) {
    let (mut modes, mut at) = ((None, None), 0);
    while at < im.steps.list.len() {
        match im.steps.list[at].procedure.clone() {
            Some((StepProcedure::Frequency { count, up_to, is_complex: false }, _)) => modes = (count, up_to),
            Some((StepProcedure::Response(card), line)) => {
                phases(im, at);
                ground(im);
                at = join(im, at, ResponseCard { modes, ..card }, line);
            }
            _ => refuse_phases(im, at),
        }
        check_damping(im, at);
        at += 1;
    }
}

/// Joins a steady motion with the step of modes right before it, and returns its index then. Its table of results has these modes too.
fn join(im: &mut Importer, at: usize, card: ResponseCard, line: usize) -> usize {
    let (is_direct, is_gathered) = (card.is_direct, card.is_gathered);
    im.steps.list[at].procedure = Some((StepProcedure::Response(card), line));
    if is_direct {
        return at;
    }
    let spaced = "frequencies are evenly spaced, with further ones about each natural frequency; ";
    let spaced = if is_gathered { spaced } else { "" };
    im.change(line, &format!("{spaced}all other modes count as well, without inertia"));
    let is_modes = |step: &StepCard| {
        let is_modes = matches!(step.procedure, Some((StepProcedure::Frequency { is_complex: false, .. }, _)));
        is_modes && step.temperatures.is_empty()
    };
    let Some(before) = at.checked_sub(1).filter(|before| is_modes(&im.steps.list[*before])) else { return at };
    let modes = im.steps.list.remove(before);
    let step = &mut im.steps.list[before];
    step.supports.splice(0..0, modes.supports);
    step.new_supports |= modes.new_supports;
    step.is_perturbation |= modes.is_perturbation;
    before
}

/// Gives the loads and motions of a steady motion the amplitude of their part.
fn phases(im: &mut Importer, at: usize) {
    let step = &mut im.steps.list[at];
    let mut refused = Vec::new();
    let mut give = |amplitude: &mut Option<String>, is_imaginary: bool, line: usize| {
        let (name, phase) = PARTS[usize::from(is_imaginary)];
        if amplitude.replace(name.to_owned()).is_some() {
            refused.push((line, "a load that depends on the frequency is not translated"));
        }
        if !im.amplitudes.iter().any(|card| card.name == name) {
            let (name, harmonic) = (name.to_owned(), Some(phase));
            im.amplitudes.push(AmplitudeCard { name, line, harmonic, ..AmplitudeCard::default() });
        }
    };
    step.forces.iter_mut().for_each(|load| give(&mut load.amplitude, load.is_imaginary, load.line));
    step.spread.iter_mut().for_each(|load| give(&mut load.amplitude, load.is_imaginary, load.line));
    let moved = step.supports.iter_mut().filter(|support| support.value != 0.0);
    moved.for_each(|support| give(&mut support.amplitude, support.is_imaginary, support.line));
    for load in step.spread.iter().filter(|load| ["GRAV", "CENTRIF", "CENT"].contains(&&load.kind[..])) {
        refused.push((load.line, "gravity and rotation do not vary with a frequency: give *BASE MOTION"));
    }
    let parts = |is_imaginary: bool| step.supports.iter().filter(move |support| support.is_imaginary == is_imaginary);
    for support in parts(true) {
        let is_same = |other: &&SupportLine| {
            other.target.name == support.target.name && other.value != 0.0 && other.degrees == support.degrees
        };
        if parts(false).any(|other| is_same(&other)) {
            refused.push((support.line, "a support moves in one phase: give its motion as one part"));
        }
    }
    refused.into_iter().for_each(|(line, why)| im.refuse(line, why));
}

/// Gives accelerations of the ground in a steady motion the amplitude of their part. Those of the file must be the same at all frequencies.
fn ground(im: &mut Importer) {
    let mut refused = Vec::new();
    for motion in &mut im.steps.base_motions {
        let (name, phase) = PARTS[usize::from(motion.is_imaginary)];
        let given = im.amplitudes.iter().rfind(|card| card.name.eq_ignore_ascii_case(&motion.amplitude));
        let values = given.map(|card| card.points.iter().map(|point| point[1]).collect::<Vec<_>>());
        match values.as_deref() {
            Some([first, rest @ ..]) if rest.iter().all(|value| value == first) => motion.scale *= first,
            None if motion.amplitude == name => continue,
            _ => refused.push(motion.line),
        }
        motion.amplitude = name.to_owned();
        if !im.amplitudes.iter().any(|card| card.name == name) {
            let (name, line, harmonic) = (name.to_owned(), motion.line, Some(phase));
            im.amplitudes.push(AmplitudeCard { name, line, harmonic, ..AmplitudeCard::default() });
        }
    }
    for line in refused {
        im.refuse(line, "the base needs an AMPLITUDE with one value at all frequencies");
    }
}

/// Refuses imaginary parts outside of steady motions.
fn refuse_phases(im: &mut Importer, at: usize) {
    let step = &im.steps.list[at];
    let forces = step.forces.iter().filter(|load| load.is_imaginary).map(|load| load.line);
    let spread = step.spread.iter().filter(|load| load.is_imaginary).map(|load| load.line);
    let supports = step.supports.iter().filter(|load| load.is_imaginary).map(|load| load.line);
    let lines: Vec<usize> = forces.chain(spread).chain(supports).collect();
    lines.into_iter().for_each(|line| im.refuse(line, "an imaginary part acts in *STEADY STATE DYNAMICS alone"));
}

/// Refuses damping by modes where the deck does not go by modes.
fn check_damping(im: &mut Importer, at: usize) {
    let step = &im.steps.list[at];
    let by_modes = matches!(&step.procedure, Some((StepProcedure::Response(card), _)) if !card.is_direct);
    if let Some((ModalDamping::Ratio(_), line)) = step.damping
        && !by_modes
    {
        im.refuse(line, "rdsolve computes this step without modes: give *MODAL DAMPING, RAYLEIGH");
    }
}

/// Alpha and beta of all steps that have inertia, and their line; `None` where these do not damp modes.
pub fn rayleigh(im: &mut Importer) -> Option<([f64; 2], usize)> {
    let moving: Vec<_> = im
        .steps
        .list
        .iter()
        .filter(|step| matches!(step.procedure, Some((StepProcedure::Dynamic { .. } | StepProcedure::Response(_), _))))
        .map(|step| match step.damping {
            Some((ModalDamping::Rayleigh(values), line)) => Some((values, line)),
            _ => None,
        })
        .collect();
    let first = moving.iter().flatten().next().copied()?;
    if moving.iter().any(|other| other.map(|(values, _)| values) != Some(first.0)) {
        im.refuse(first.1, "[damping] holds for all steps: give each step a file");
    }
    Some(first)
}

/// Adds the keys of a frequency response.
pub fn keys(table: DeckTable, card: &ResponseCard) -> DeckTable {
    let [from, to] = card.range;
    let mut range = vec![("from", number(from)), ("to", number(to)), ("steps", card.points.to_string())];
    if card.is_logarithmic {
        range.push(("spacing", quoted("logarithmic")));
    }
    if card.is_gathered {
        range.push(("around_resonances", (card.points / 2).to_string()));
    }
    let frequencies = if from == to { number(from) } else { inline(&range) };
    let table = table.value("frequencies", frequencies);
    if card.is_direct {
        return table;
    }
    let table = table.text("method", "modal");
    match card.modes {
        (Some(count), _) => table.value("modes", count.max(1).to_string()),
        (None, Some(up_to)) => table.number("up_to", up_to),
        (None, None) => table,
    }
}
