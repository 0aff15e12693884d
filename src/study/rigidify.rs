//! The price and the gain of making a part rigid or reduced. The share of each part in the elastic energy suggests candidates; a run with
//! that part rigid, and runs with it reduced to a few modes, measure the error and the time.

use super::advice::{AdvisedPart, StudyAdvice};
use super::grid::{SAMPLES, output};
use super::history;
use super::manifest::Manifest;
use super::options::{AS_IT_IS, Options, RIGID, RUNS, StudyFault};
use super::run::{RunStatus, StudyRun};
use super::run_all::{Job, RunSeries};
use base::diagnostic::Diagnostic;
use deck::Deck;
use deck::parts::DeckPart;
use model::Model;
use model::study::{Quantity, obstacle};
use results::table_reader::{TableReader, fields, number, text};
use std::collections::HashMap;
use std::io;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The table that is written besides the runs.
const TABLE: &str = "rigidify.csv";

/// The numbers of modes of reduced parts.
const MODES: [usize; 4] = [5, 10, 20, 40];

/// A part of the deck in another form, before anything is known of it.
struct Candidate {
    kind: &'static str,
    name: String,
    /// The entry of the part that makes it so: `rigid = true`.
    form: String,
    /// The override that makes it so.
    set: Option<String>,
}

/// For each part, by kind and name, the largest share in the elastic energy and that over all times.
type Shares = HashMap<(String, String), [f64; 2]>;

/// Runs the original deck, one with each part rigid, and some with it reduced, and writes rigidify.csv. Raising `stop` ends it with the runs that are complete.
///
/// # Errors
/// There is no part that could be rigid or nothing to measure errors on, or a file cannot be read or written.
pub fn rigidify(model: &Model, deck: &Deck, options: &Options, stop: &AtomicBool) -> Result<StudyAdvice, StudyFault> {
    let asked = model.study.clone().unwrap_or_default();
    let quantities = history::quantities(model, &asked);
    let candidates = candidates(deck);
    check(model, &quantities, &candidates)?;
    let (end, time_step) = (model.analysis.end_time, model.analysis.nominal_step());
    // Steps end at samples, so samples closer together than the deck's steps would shorten these.
    let steps = (end / time_step + 1e-9).floor().max(1.0);
    let samples = asked.samples.unwrap_or(SAMPLES.min(steps as usize));
    let common = [output(&quantities, end / samples as f64, true), "expect=[]".to_owned()];
    let jobs = jobs(&candidates, options, &common, time_step);
    let folders: Vec<String> = jobs.iter().map(|job| job.folder.clone()).collect();
    let mut manifest = Manifest::begin(&options.folder, &[TABLE], &folders)?;
    let mut shares = Shares::new();
    let once_run = &mut |index, run: &StudyRun, place: &Path| {
        if index == 0 {
            shares = shares_of(run, place)?;
        }
        Ok(())
    };
    let series = RunSeries { options, quantities: &quantities, samples, end, once_run };
    let (runs, stopped) = series.run_all(&jobs, &mut manifest, stop)?;
    let mut runs = runs.into_iter();
    let Some(base) = runs.next().flatten() else {
        let message = "stopped before the first run came to its end";
        return Err(StudyFault::Io(io::Error::new(io::ErrorKind::Interrupted, message)));
    };
    let count = quantities.len();
    let parts = candidates.into_iter().zip(runs).map(|(candidate, run)| part(candidate, run, &base, &shares, count));
    let parts = parts.collect();
    let advice = StudyAdvice { quantities, samples, base, parts, stopped };
    manifest.write(TABLE, advice.table().as_bytes())?;
    Ok(advice)
}

/// Makes sure that the study can be run.
fn check(model: &Model, quantities: &[Quantity], candidates: &[Candidate]) -> Result<(), StudyFault> {
    let mut problems: Vec<Diagnostic> = obstacle(model).map(Diagnostic::error).into_iter().collect();
    if quantities.is_empty() {
        let hint = "name a point or a body, or list `quantities` in `[study]`";
        problems.push(Diagnostic::error("there is nothing to measure errors on").hint(hint));
    }
    if candidates.is_empty() {
        problems.push(Diagnostic::error("the deck has no part that deforms by itself").hint("remove `rigidify`"));
    }
    if problems.is_empty() { Ok(()) } else { Err(StudyFault::Deck(problems)) }
}

/// The decks to run, first the original deck; `common` are the overrides of all of them.
fn jobs(candidates: &[Candidate], options: &Options, common: &[String], time_step: f64) -> Vec<Job> {
    let sets = |own: &[String]| options.sets.iter().chain(own).chain(common).cloned().collect();
    let job = |label: String, folder: String, sets| Job { label, folder, setting: (0, time_step), work: 1.0, sets };
    let base = job("as it is".to_owned(), format!("{RUNS}/{AS_IT_IS}"), Some(sets(&[])));
    let rigid = candidates.iter().enumerate().map(|(i, candidate)| {
        let own = candidate.set.as_ref().map(|set| sets(std::slice::from_ref(set)));
        job(format!("{} {}", candidate.name, candidate.form), format!("{RUNS}/{RIGID}{}", i + 1), own)
    });
    std::iter::once(base).chain(rigid).collect()
}

/// The shares in the energy of the original deck, which must run.
fn shares_of(base: &StudyRun, place: &Path) -> Result<Shares, StudyFault> {
    match base.status {
        RunStatus::Failed => {
            let message = format!("the deck as it is fails: {}", base.reason);
            Err(StudyFault::Deck(vec![Diagnostic::error(message)]))
        }
        RunStatus::Done => Ok(read_shares(&place.join("parts.csv"))?),
        RunStatus::NotConverged => Ok(Shares::new()),
    }
}

/// A part with all that is known of it; `count` is the number of quantities.
fn part(candidate: Candidate, run: Option<StudyRun>, base: &StudyRun, shares: &Shares, count: usize) -> AdvisedPart {
    let key = (candidate.kind.to_owned(), candidate.name.clone());
    let [peak_share, mean_share] = match base.status {
        RunStatus::Done => shares.get(&key).copied().unwrap_or([0.0; 2]).map(Some),
        _ => [None; 2],
    };
    let run = match (run, &candidate.set) {
        (Some(mut run), _) => {
            if run.status == RunStatus::Done && base.status == RunStatus::Done {
                let error = |of: &dyn Fn(usize) -> bool| history::error(&run.history, &base.history, count, of);
                let (all, each) = (error(&|_| true), (0..count).map(|k| error(&|i| i == k)).collect());
                (run.error, run.errors) = (Some(all), each);
            }
            Ok(run)
        }
        (None, None) => Err("a bar has no inertia about itself, so it cannot be a body".to_owned()),
        (None, Some(_)) => Err("not run".to_owned()),
    };
    AdvisedPart { kind: candidate.kind, name: candidate.name, form: candidate.form, peak_share, mean_share, run }
}

/// The parts that deform, and belong neither to a body nor to `[[parts]]`.
fn candidates(deck: &Deck) -> Vec<Candidate> {
    let bodies = deck.bodies.iter().filter_map(|body| body.parts.as_ref());
    let of_bodies: Vec<&str> = bodies.flat_map(|parts| &parts.values).map(|name| name.as_str()).collect();
    let of_sets = deck.part_sets.iter().filter_map(|set| set.parts.as_ref()).flat_map(|parts| &parts.values);
    let of_sets: Vec<_> = of_sets.flat_map(|entry| deck.members(entry)).collect();
    let is_candidate = |part: &DeckPart| {
        (part.at.kind.is_line() || part.at.kind.is_surface())
            && !part.is_rigid()
            && !of_bodies.contains(&part.label().as_str())
            && !of_sets.iter().any(|name| part.is_named(name))
    };
    let forms = |part: DeckPart| {
        let reduced = MODES.map(|modes| format!("reduced = {modes}"));
        // A bar has neither form.
        let count = if part.table.rigid().is_some() { 1 + MODES.len() } else { 1 };
        let forms = std::iter::once("rigid = true".to_owned()).chain(reduced).take(count);
        let candidate = |form: String| Candidate {
            kind: part.at.kind.word(),
            name: part.label(),
            set: part.table.rigid().map(|_| format!("{}.{}", part.table_path(), form.replace(' ', ""))),
            form,
        };
        forms.map(candidate).collect::<Vec<_>>()
    };
    deck.parts().filter(is_candidate).flat_map(forms).collect()
}

/// Reads parts.csv: for each part, by kind and name, its largest energy and its energy over all times, each divided by the energy of all
/// parts.
fn read_shares(path: &Path) -> io::Result<Shares> {
    let mut rows = TableReader::open(path)?;
    let mut peaks: Shares = HashMap::new();
    // The current step, the energy of all parts in it, the largest such energy so far, and the sum over all steps.
    let (mut step, mut now, mut largest, mut sum) = (Vec::new(), 0.0, 0.0f64, 0.0);
    while let Some(row) = rows.next_row()? {
        let cells: Vec<&[u8]> = fields(row).collect();
        let [of, _, kind, part, strain] = cells[..] else { continue };
        if of != step {
            largest = largest.max(now);
            now = 0.0;
            step = of.to_vec();
        }
        let strain = number(strain);
        now += strain;
        sum += strain;
        let entry = peaks.entry((text(kind).into_owned(), text(part).into_owned())).or_default();
        entry[0] = entry[0].max(strain);
        entry[1] += strain;
    }
    largest = largest.max(now);
    let part = |of: f64, all: f64| if all > 0.0 { of / all } else { 0.0 };
    Ok(peaks.into_iter().map(|(key, [peak, mean])| (key, [part(peak, largest), part(mean, sum)])).collect())
}
