//! What would it cost to make a part rigid, and what would it save? Each part's share of the elastic energy says where to look;
//! a run with that part rigid says what comes of it.

use super::grid::{SAMPLES, output};
use super::manifest::Manifest;
use super::process::{Ended, Program};
use super::progress::Progress;
use super::runs::{AS_IT_IS, RIGID, RUNS, Run, Status, program};
use super::study_csv::{field, maybe};
use super::table::seconds;
use super::{Fault, Options, columns, history};
use crate::deck::Deck;
use crate::diagnostic::Diagnostic;
use crate::model::Model;
use crate::model::study::{Quantity, obstacle};
use crate::output::table_reader::{TableReader, fields, number, text};
use std::collections::HashMap;
use std::io;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// What the advisor writes besides its runs.
const TABLE: &str = "rigidify.csv";

/// A beam, bar or shell that deforms.
#[derive(Debug, Clone)]
pub struct Part {
    pub kind: &'static str,
    pub name: String,
    /// Of the largest elastic energy of all parts together at any time: the largest of this part's. `None`, as the next: the deck
    /// as it is did not come to its end.
    pub peak_share: Option<f64>,
    /// Of the energy over all times: this part's.
    pub mean_share: Option<f64>,
    /// The run with this part rigid; a reason alone where there can be none.
    pub rigid: Result<Run, String>,
}

/// What the parts of a deck cost and carry.
pub struct Advice {
    pub quantities: Vec<Quantity>,
    pub samples: usize,
    /// The deck as it is.
    pub base: Run,
    pub parts: Vec<Part>,
    pub stopped: bool,
}

/// A part of the deck, before anything is known of it.
struct Candidate {
    kind: &'static str,
    name: String,
    /// The override that makes it rigid.
    set: Option<String>,
}

/// Runs the deck as it is and with each part rigid; writes rigidify.csv.
pub fn rigidify(model: &Model, deck: &Deck, options: &Options, stop: &AtomicBool) -> Result<Advice, Fault> {
    let asked = model.study.clone().unwrap_or_default();
    let quantities = history::quantities(model, &asked);
    let candidates = candidates(deck);
    let mut problems: Vec<Diagnostic> = obstacle(model).map(Diagnostic::error).into_iter().collect();
    if quantities.is_empty() {
        let hint = "name a point or a body, or list `quantities` in `[study]`";
        problems.push(Diagnostic::error("there is nothing to measure errors on").hint(hint));
    }
    if candidates.is_empty() {
        problems.push(Diagnostic::error("the deck has no part that deforms"));
    }
    if !problems.is_empty() {
        return Err(Fault::Deck(problems));
    }
    let folder =
        |index: usize| if index == 0 { format!("{RUNS}/{AS_IT_IS}") } else { format!("{RUNS}/{RIGID}{index}") };
    let folders: Vec<String> = (0..=candidates.len()).map(folder).collect();
    let mut manifest = Manifest::begin(&options.folder, &[TABLE], &folders)?;
    let end = model.analysis.end_time;
    // Samples closer together than the deck's steps would shorten these.
    let steps = (end / model.analysis.nominal_step() + 1e-9).floor().max(1.0);
    let samples = asked.samples.unwrap_or(SAMPLES.min(steps as usize));
    let program = program(options)?;
    let common = [output(&quantities, end / samples as f64, true), "expect=[]".to_owned()];
    let mut jobs: Vec<Option<Vec<String>>> = vec![Some(Vec::new())];
    jobs.extend(candidates.iter().map(|candidate| candidate.set.clone().map(|set| vec![set])));
    let mut runs: Vec<Option<Run>> = vec![None; jobs.len()];
    let mut shares = HashMap::new();
    let mut progress = Progress::new(options.quiet, (options.repeats * jobs.len()) as f64);
    let mut stopped = false;
    'all: for repeat in 0..options.repeats {
        for (index, job) in jobs.iter().enumerate() {
            let label = index.checked_sub(1).map_or("as it is".into(), |i| format!("{} rigid", candidates[i].name));
            progress.show(&label, repeat + 1, options.repeats);
            progress.did(1.0);
            let Some(own) = job else { continue };
            let enough = |run: &Run| run.status != Status::Done || run.process_s * repeat as f64 > options.budget;
            if repeat > 0 && runs[index].as_ref().is_none_or(enough) {
                continue;
            }
            let folder = folders[index].clone();
            let place = options.folder.join(&folder);
            if repeat == 0 {
                manifest.note(&folder)?;
            }
            let sets: Vec<String> = options.sets.iter().chain(own).chain(&common).cloned().collect();
            let Some(ended) = run(&program, &sets, &place, stop)? else {
                stopped = true;
                break 'all;
            };
            let done = Run::new(0, model.analysis.nominal_step(), folder, &ended, &place)?;
            if let Some(before) = &mut runs[index] {
                if done.status == Status::Done {
                    before.again(done.loop_s, ended.process_s);
                }
                continue;
            }
            let done = done.with_history(&quantities, samples, end, &place);
            if index == 0 {
                if done.status == Status::Failed {
                    return Err(Fault::Deck(vec![Diagnostic::error(format!(
                        "the deck as it is fails: {}",
                        done.reason
                    ))]));
                }
                if done.status == Status::Done {
                    shares = read_shares(&place.join("parts.csv"))?;
                }
            }
            runs[index] = Some(done);
        }
    }
    progress.finish();
    let mut runs = runs.into_iter();
    let Some(base) = runs.next().flatten() else {
        return Err(Fault::Io(io::Error::new(
            io::ErrorKind::Interrupted,
            "stopped before the first run came to its end",
        )));
    };
    let count = quantities.len();
    let part = |(candidate, run): (Candidate, Option<Run>)| {
        let key = (candidate.kind.to_owned(), candidate.name.clone());
        let [peak_share, mean_share] = match base.status {
            Status::Done => shares.get(&key).copied().unwrap_or([0.0; 2]).map(Some),
            _ => [None; 2],
        };
        let rigid = match (run, &candidate.set) {
            (Some(mut run), _) => {
                if run.status == Status::Done && base.status == Status::Done {
                    run.error = Some(history::error(&run.history, &base.history, count, |_| true));
                    run.errors =
                        (0..count).map(|k| history::error(&run.history, &base.history, count, |i| i == k)).collect();
                }
                Ok(run)
            }
            (None, None) => Err("a bar has no inertia about itself, so it cannot be a body".to_owned()),
            (None, Some(_)) => Err("not run".to_owned()),
        };
        Part { kind: candidate.kind, name: candidate.name, peak_share, mean_share, rigid }
    };
    let parts = candidates.into_iter().zip(runs).map(part).collect();
    let advice = Advice { quantities, samples, base, parts, stopped };
    manifest.write(TABLE, advice.table().as_bytes())?;
    Ok(advice)
}

fn run(program: &Program, sets: &[String], place: &Path, stop: &AtomicBool) -> io::Result<Option<Ended>> {
    std::fs::create_dir_all(place).map_err(|error| crate::output::at(place, error))?;
    program.run(sets, place, stop)
}

/// Parts that are not rigid already.
fn candidates(deck: &Deck) -> Vec<Candidate> {
    let rigid = |flag: &crate::deck::words::Maybe<bool>| flag.as_ref().is_some_and(|at| at.value);
    let bodies = deck.bodies.iter().filter_map(|body| body.parts.as_ref());
    let of_bodies: Vec<&str> = bodies.flat_map(|parts| &parts.values).map(|name| name.as_str()).collect();
    let mut found = Vec::new();
    let mut add = |kind: &'static str, table: &str, i: usize, name: Option<&str>, rigid: bool| {
        let set = (kind != "bar").then(|| format!("{table}.{i}.rigid=true"));
        let name = name.map_or_else(|| format!("{table}.{i}"), str::to_owned);
        if !rigid && !of_bodies.contains(&name.as_str()) {
            found.push(Candidate { kind, name, set });
        }
    };
    for (i, part) in deck.beams.iter().enumerate() {
        let name = part.name.as_ref().or(part.group.as_ref()).map(|name| name.as_str());
        add("beam", "beams", i, name, rigid(&part.rigid));
    }
    for (i, part) in deck.bars.iter().enumerate() {
        add("bar", "bars", i, part.name.as_ref().map(|name| name.as_str()), false);
    }
    for (i, part) in deck.shells.iter().enumerate() {
        let name = part.name.as_ref().or(part.group.as_ref()).map(|name| name.as_str());
        add("shell", "shells", i, name, rigid(&part.rigid));
    }
    found
}

/// By kind and name: the largest energy, and that over all times, each of that of all parts.
fn read_shares(path: &Path) -> io::Result<HashMap<(String, String), [f64; 2]>> {
    let mut rows = TableReader::open(path)?;
    let mut peaks: HashMap<(String, String), [f64; 2]> = HashMap::new();
    // Of the time at hand, its energy, the largest so far, the sum.
    let (mut step, mut now, mut largest, mut sum) = (Vec::new(), 0.0, 0.0f64, 0.0);
    while let Some(row) = rows.next()? {
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

impl Advice {
    /// For standard output: the parts, those that could go first.
    pub fn text(&self) -> String {
        let head = ["part", "kind", "energy, most", "mean", "error if rigid", "loop s", "saved", "unknowns", "status"];
        let percent = |part: Option<f64>| match part.map(|part| 100.0 * part) {
            None => String::new(),
            Some(0.0) => "0 %".to_owned(),
            Some(p) if p.abs() < 0.1 => format!("{p:.0e} %"),
            Some(p) => format!("{p:.1} %"),
        };
        let base = &self.base;
        let mut rows = vec![head.map(String::from).to_vec()];
        let empty = String::new;
        let (loop_s, unknowns) = (seconds(base.loop_s), base.measured.unknowns.to_string());
        let status = if base.status == Status::Done {
            "done".into()
        } else {
            format!("{}: {}", base.status.word(), base.reason)
        };
        rows.push(vec!["(as it is)".into(), empty(), empty(), empty(), empty(), loop_s, empty(), unknowns, status]);
        let mut parts: Vec<&Part> = self.parts.iter().collect();
        let error = |part: &Part| part.rigid.as_ref().ok().and_then(|run| run.error).unwrap_or(f64::INFINITY);
        let share = |part: &Part| part.peak_share.unwrap_or(0.0);
        parts.sort_by(|a, b| error(a).total_cmp(&error(b)).then(share(a).total_cmp(&share(b))));
        for part in parts {
            let mut row =
                vec![part.name.clone(), part.kind.to_owned(), percent(part.peak_share), percent(part.mean_share)];
            match &part.rigid {
                Ok(run) if run.status == Status::Done => row.extend([
                    run.error.map_or(empty(), |error| format!("{error:.2e}")),
                    seconds(run.loop_s),
                    percent((base.status == Status::Done).then(|| 1.0 - run.loop_s / base.loop_s)),
                    run.measured.unknowns.to_string(),
                    "done".into(),
                ]),
                Ok(run) => {
                    row.extend([empty(), empty(), empty(), empty(), format!("{}: {}", run.status.word(), run.reason)])
                }
                Err(reason) => row.extend([empty(), empty(), empty(), empty(), reason.clone()]),
            }
            rows.push(row);
        }
        let (samples, count) = (self.samples + 1, self.quantities.len());
        let what = if count == 1 { "quantity" } else { "quantities" };
        format!("{}\nerror: against the deck as it is, {count} {what} at {samples} times\n", columns(&rows, 2))
    }

    /// The text of rigidify.csv.
    fn table(&self) -> String {
        let head = "kind,part,peak_share,mean_share,status,error,loop_s,process_s,repeats,unknowns,folder,reason";
        let mut out = head.to_owned();
        self.quantities
            .iter()
            .for_each(|quantity| out += &format!(",{}", field(&format!("error:{}", quantity.word()))));
        out.push('\n');
        let mut row = |kind: &str, name: &str, shares: [Option<f64>; 2], run: Result<&Run, &str>| {
            let [peak, mean] = shares.map(maybe);
            out += &format!("{kind},{},{peak},{mean}", field(name));
            match run {
                Ok(run) => {
                    let [loop_s, process_s] = [run.loop_s, run.process_s].map(|s| maybe(Some(s)));
                    out += &format!(",{},{},{loop_s},{process_s}", run.status.word(), maybe(run.error));
                    out += &format!(
                        ",{},{},{},{}",
                        run.times.len(),
                        run.measured.unknowns,
                        run.folder,
                        field(&run.reason)
                    );
                }
                Err(reason) => out += &format!(",none,,,,,,,{}", field(reason)),
            }
            for i in 0..self.quantities.len() {
                let error = run.ok().and_then(|run| run.errors.get(i).copied());
                out += &format!(",{}", maybe(error));
            }
            out.push('\n');
        };
        row("all", "", [None, None], Ok(&self.base));
        for part in &self.parts {
            let shares = [part.peak_share, part.mean_share];
            row(part.kind, &part.name, shares, part.rigid.as_ref().map_err(String::as_str));
        }
        out
    }
}
