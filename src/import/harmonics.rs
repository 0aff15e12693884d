//! Steady motions: `*STEADY STATE DYNAMICS`, the real and imaginary parts of its loads, and `*MODAL DAMPING`.
//!
//! A load a + i b of these programs is a cos ωt − b sin ωt: its imaginary part has a phase of 90 degrees.

use crate::deck_text::{DeckTable, inline, number, quoted};
use crate::dialect::Dialect;
use crate::file_content::{AmplitudeCard, DampingOfModes, ResponseCard, StepCard, StepProcedure, SupportLine};
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::step_cards;

/// Frequencies between two natural ones unless the file says otherwise, in both programs.
const POINTS: u64 = 20;
/// The most of them; half of them stand on each side of a natural frequency.
const MOST_POINTS: u64 = 2000;
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
    let [low, high, count, bias, scale] = [0, 1, 2, 3, 4].map(|at| im.number_at(data, at).filter(|x| *x > 0.0));
    let from = low.unwrap_or(0.0);
    let is_direct = keyword.has("DIRECT");
    let is = |name: &str, word: &str| keyword.value(name).is_some_and(|value| value.eq_ignore_ascii_case(word));
    let has_spacing = keyword.value("FREQUENCYSCALE").is_some() || from == 0.0 || high == Some(from);
    let few = count.is_some_and(|count| count < 2.0);
    let to = match (im.dialect, high) {
        (None, _) if !has_spacing || high.is_none() || few => {
            let why = "spacing, blank bounds and fewer than 2 points differ: say --from abaqus or --from calculix";
            return im.refuse(line, why);
        }
        (_, Some(high)) => high,
        (Some(Dialect::Abaqus), None) => from,
        (_, None) => return im.refuse(line, "*STEADY STATE DYNAMICS needs its highest frequency"),
    };
    let in_abaqus = im.dialect == Some(Dialect::Abaqus);
    let points = match count {
        Some(_) if few && in_abaqus => POINTS,
        Some(count) if count > MOST_POINTS as f64 => return im.refuse(line, "these are too many frequencies"),
        Some(count) => count as u64,
        None => POINTS,
    };
    if to < from {
        return im.refuse(line, "the highest frequency must not be below the lowest");
    }
    if is("INTERVAL", "SPREAD") {
        return im.refuse(line, "INTERVAL=SPREAD is not translated: give INTERVAL=RANGE");
    }
    if bias.is_some_and(|bias| bias != 1.0) || in_abaqus && scale.is_some_and(|scale| scale != 1.0) {
        im.change(line, "bias and scale of its frequencies are not used");
    }
    let is_gathered = !is("INTERVAL", "RANGE") && !is_direct && to > from;
    let is_logarithmic = in_abaqus && !is("FREQUENCYSCALE", "LINEAR") && from > 0.0;
    let points = if to > from { points.max(2) } else { 1 };
    let card = ResponseCard { range: [from, to], points, is_logarithmic, is_gathered, is_direct, modes: (None, None) };
    step_cards::set(im, line, StepProcedure::Response(card));
}

/// `*MODAL DAMPING`.
pub fn modal_damping(im: &mut Importer, block: &KeywordBlock) {
    let (keyword, line) = (&block.keyword, block.keyword.line);
    let viscous = keyword.value("VISCOUS").unwrap_or_default().to_ascii_uppercase();
    if keyword.has("STRUCTURAL") {
        return im.refuse(line, "rdsolve has no structural damping; give a damping ratio");
    }
    let modal = keyword.value("MODAL").unwrap_or_default().to_ascii_uppercase();
    if [&viscous, &modal].iter().any(|word| word.starts_with("COMPOSITE")) {
        return im.refuse(line, "composite damping is not translated; give the ratio of each mode");
    }
    let is_rayleigh = keyword.has("RAYLEIGH") || viscous.starts_with("RAYLEIGH");
    // Modes from and to, then a ratio or alpha and beta; frequency and ratio with DEFINITION=FREQUENCY RANGE.
    let of_frequency = keyword.value("DEFINITION").is_some_and(|by| by.to_ascii_uppercase().starts_with("FREQUENCY"));
    let first = if of_frequency { 1 } else { 2 };
    let (mut all, mut last) = (Vec::new(), 0);
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let value = im.number_at(data, first);
        let Some(value) = value else {
            return im.refuse(data.line, "this line needs a damping ratio, or alpha, behind its modes");
        };
        all.push([value, if is_rayleigh { im.number_at(data, first + 1).unwrap_or(0.0) } else { 0.0 }]);
        let [begin, end] = [0, 1].map(|at| data.words.get(at).and_then(|word| word.whole()));
        last = match (begin, end) {
            _ if of_frequency => 0,
            (None, None) => u64::MAX,
            (Some(begin), end) if begin <= last + 1 => last.max(end.unwrap_or(begin)),
            _ => last,
        };
    }
    let Some(&values) = all.first() else { return im.refuse(line, "*MODAL DAMPING needs values on the line below") };
    if all.iter().any(|other| *other != values) {
        return im.refuse(line, "all modes have the same damping in rdsolve");
    }
    let damping = if is_rayleigh { DampingOfModes::Rayleigh(values) } else { DampingOfModes::Ratio(values[0]) };
    let step = im.steps.at_hand();
    step.damping = Some((damping, line, last));
}

/// Gives loads of steady motions their amplitudes, and joins the modes that such a motion is made of with it.
pub fn prepare(im: &mut Importer) {
    let (mut modes, mut at) = ((None, None), 0);
    while at < im.steps.list.len() {
        match im.steps.list[at].procedure.clone() {
            Some((StepProcedure::Frequency { count, up_to, is_complex: false }, _)) => modes = (count, up_to),
            Some((StepProcedure::Response(card), line)) => {
                phases(im, at);
                ground(im, at);
                check_loads(im, at, line);
                check_extent(im, at, modes.0);
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
    let ResponseCard { is_direct, is_gathered, is_logarithmic, .. } = card;
    im.steps.list[at].procedure = Some((StepProcedure::Response(card), line));
    if is_direct {
        return at;
    }
    let even = if is_logarithmic { "by equal factors" } else { "evenly" };
    let spaced = format!("frequencies are spaced {even}, with further ones about each natural frequency; ");
    let spaced = if is_gathered { spaced } else { String::new() };
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
fn ground(im: &mut Importer, at: usize) {
    let (mut refused, step) = (Vec::new(), im.steps.list[at].line);
    for motion in im.steps.base_motions.iter_mut().filter(|motion| motion.step == step) {
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

/// Refuses a steady motion that nothing excites.
fn check_loads(im: &mut Importer, at: usize, line: usize) {
    let step = &im.steps.list[at];
    let is_moved = step.supports.iter().any(|support| support.value != 0.0);
    let is_shaken = im.steps.base_motions.iter().any(|motion| motion.step == step.line);
    if step.forces.is_empty() && step.spread.is_empty() && !is_moved && !is_shaken {
        im.refuse(line, "nothing excites this step: it has no loads of its own");
    }
}

/// Says where modes have damping that the file does not give them.
fn check_extent(im: &mut Importer, at: usize, modes: Option<u64>) {
    let step = &im.steps.list[at];
    if let Some((_, line, last)) = step.damping
        && last < modes.unwrap_or(u64::MAX)
    {
        im.change(line, "all modes have this damping, not those alone that the file names");
    }
}

/// Refuses imaginary parts outside of steady motions.
fn refuse_phases(im: &mut Importer, at: usize) {
    let step = &im.steps.list[at];
    let buckles = matches!(step.procedure, Some((StepProcedure::Buckle { .. }, _)));
    if let Some(line) = step.supports.iter().find(|line| line.is_imaginary && buckles).map(|line| line.line) {
        return im.refuse(line, "modes of buckling have the supports of the loads: LOAD CASE=2 is not translated");
    }
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
    if let Some((DampingOfModes::Ratio(_), line, _)) = step.damping
        && !by_modes
    {
        im.refuse(line, "rdsolve computes this step without modes: give *MODAL DAMPING, RAYLEIGH");
    }
}

/// True where all steps that have inertia are steady motions by modes, which material damping does not act on.
fn goes_by_modes(im: &Importer) -> bool {
    let of = |step: &StepCard| match &step.procedure {
        Some((StepProcedure::Response(card), _)) => Some(!card.is_direct),
        Some((StepProcedure::Dynamic { .. }, _)) => Some(false),
        _ => None,
    };
    let mut moving = im.steps.list.iter().filter_map(of).peekable();
    moving.peek().is_some() && moving.all(|by_modes| by_modes)
}

/// Alpha and beta of each step that has inertia, and their line.
fn factors(im: &Importer) -> Vec<Option<([f64; 2], usize)>> {
    im.steps
        .list
        .iter()
        .filter(|step| matches!(step.procedure, Some((StepProcedure::Dynamic { .. } | StepProcedure::Response(_), _))))
        .map(|step| match step.damping {
            Some((DampingOfModes::Rayleigh(values), line, _)) => Some((values, line)),
            _ => None,
        })
        .collect()
}

/// True where modes have damping of their own, and materials none.
pub fn replaces_damping(im: &Importer) -> bool {
    goes_by_modes(im) || factors(im).iter().any(Option::is_some)
}

/// Alpha and beta of all steps that have inertia, and their line; `None` where these do not damp modes.
pub fn rayleigh(im: &mut Importer) -> Option<([f64; 2], usize)> {
    let moving = factors(im);
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
