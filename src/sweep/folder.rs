//! The folder of a sweep: `cases.csv`, `summary.csv`, and a folder for each case, named by the hash of all that it is computed from.
//!
//! Any number of processes on any number of machines may fill one folder at once: a case belongs to the process that locks its folder, and
//! is complete once its `result.json` exists. Files that all of them write are moved in whole, and are the same bytes whoever writes them.

use super::case_state::{CaseOutcome, CaseState, Computed, one_line};
use super::cases::Cases;
use super::file::{KeptFolders, SweepFile};
use super::page::page;
use super::records::{Records, remove_folder};
use base::diagnostic::Source;
use base::text_file::{read_regular, read_text};
use deck::Deck;
use rayon::prelude::*;
use results::collected::{Collected, FoundNumber, collect, in_words};
use results::result_json::Status;
use results::{RunKeeps, at, result_json, torn_tables};
use serde::Deserialize;
use sha2::{Digest, Sha256};
use std::collections::HashMap;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The name of the file in the folder of a case that says why it could not be run.
pub const FAILURE: &str = "failure.txt";

/// The folder of a sweep and those of its cases.
pub struct SweepFolder {
    /// Its path.
    pub path: PathBuf,
    /// The names of the folders of all cases, in their order.
    pub names: Vec<String>,
    /// The digests of the files named by decks, for the names of the folders.
    pub files: HashMap<PathBuf, Vec<u8>>,
    /// The cases whose folders are kept.
    pub keep: KeptFolders,
    /// The numbers that are read from each result.
    pub collect: Vec<Collected>,
    /// The records of the other cases.
    records: Records,
}

impl SweepFolder {
    /// Finds the names of all cases: hashes of the version, the deck, the overrides and the files that the deck names.
    pub fn new(path: PathBuf, deck: (&str, &str), cases: &Cases, version: &str, file: &SweepFile) -> SweepFolder {
        let mut names = CaseNames::new(deck, &cases.keys, version);
        let all = (0..cases.values.len()).map(|case| names.of(&cases.sets(case))).collect();
        let (keep, collect) = (file.keep, file.collect.clone());
        let records = Records::new(&path, &collect);
        SweepFolder { path, names: all, files: names.digests, keep, collect, records }
    }

    /// The folder of a case, counted from 0.
    pub fn case(&self, case: usize) -> PathBuf {
        self.path.join(&self.names[case])
    }

    /// The results that the run of a case keeps.
    pub fn keeps(&self) -> RunKeeps<'_> {
        RunKeeps { files: self.keep != KeptFolders::Summary, numbers: &self.collect }
    }

    /// The state of a case.
    pub fn state(&self, case: usize) -> CaseState {
        match self.records.find(&self.names[case]) {
            Some(record) => record.state(),
            None => found(&self.case(case)).0.state,
        }
    }

    /// Records those of these cases whose folders are not kept, and removes the folders; returns the other cases. A case that another
    /// process has taken over is left to it.
    ///
    /// # Errors
    /// A table cannot be read, a record cannot be written, or a folder cannot be removed; the error names it.
    pub fn let_go(&self, cases: Vec<Computed>) -> io::Result<Vec<Computed>> {
        let (stay, mut go): (Vec<_>, Vec<_>) = cases.into_iter().partition(|case| self.keep.keeps(&case.outcome.state));
        go.retain(|case| case.lock.is_held());
        let mut records = Vec::new();
        for Computed { folder, outcome, numbers, .. } in &go {
            let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let numbers = if stands(&outcome.state) { numbers.clone() } else { vec![None; self.collect.len()] };
            records.push((name, outcome, numbers.into_iter().map(in_words).collect()));
        }
        if !records.is_empty() {
            self.records.add(&records)?;
        }
        go.iter().try_for_each(|case| remove_folder(&case.folder))?;
        Ok(stay)
    }

    /// Writes `cases.csv`: the folder and the values of each case.
    ///
    /// # Errors
    /// The file cannot be written; the error names it.
    pub fn write_cases(&self, cases: &Cases) -> io::Result<()> {
        let header = ["case", "folder"].into_iter().chain(cases.keys.iter().map(String::as_str));
        let row = |(case, values): (usize, &Vec<String>)| {
            [vec![(case + 1).to_string(), self.names[case].clone()], values.clone()].concat()
        };
        self.write("cases.csv", header.map(str::to_owned).collect(), cases.values.iter().enumerate().map(row))
    }

    /// Writes `summary.csv` (the varied entries, the state, the collected numbers, the reason and the warnings of each case) and its page.
    /// It includes the cases completed by other processes meanwhile: the last writer writes all complete cases.
    ///
    /// # Errors
    /// A table cannot be read, or the file cannot be written; the error names it.
    pub fn write_summary(&self, cases: &Cases) -> io::Result<Vec<CaseOutcome>> {
        let mut outcomes = self.write_what_stands(cases)?;
        // Each round is for a case that has ended since the one before.
        for _ in 0..outcomes.len() {
            let was_pending = |&case: &usize| outcomes[case].state == CaseState::Pending;
            if !(0..outcomes.len()).filter(was_pending).any(|case| self.state(case) != CaseState::Pending) {
                break;
            }
            outcomes = self.write_what_stands(cases)?;
        }
        Ok(outcomes)
    }

    /// The collected columns without any value in the finished cases.
    ///
    /// # Errors
    /// The summary cannot be read.
    pub fn empty_columns(&self) -> io::Result<Vec<&Collected>> {
        let mut rows = csv::Reader::from_path(self.path.join("summary.csv"))?;
        let header = rows.headers()?.clone();
        let place = |name: &str| (0..header.len()).rev().find(|&place| &header[place] == name);
        let mut empty: Vec<(&Collected, Option<usize>)> =
            self.collect.iter().map(|one| (one, place(&one.name))).collect();
        let (status, mut done) = (place("status"), 0);
        for row in rows.records() {
            let row = row?;
            if status.and_then(|status| row.get(status)) == Some(CaseState::Done.word()) {
                done += 1;
                empty.retain(|(_, place)| place.and_then(|place| row.get(place)).is_none_or(str::is_empty));
            }
        }
        Ok(if done > 0 { empty.into_iter().map(|(one, _)| one).collect() } else { Vec::new() })
    }

    /// The tables of complete cases that end within a row, with the number of the case from 1.
    ///
    /// # Errors
    /// A folder of a case cannot be read.
    pub fn torn_tables(&self, outcomes: &[CaseOutcome]) -> io::Result<Vec<(usize, String)>> {
        let of_case = |(case, _)| Ok(torn_tables(&self.case(case))?.into_iter().map(|torn| (case + 1, torn)).collect());
        let has_tables = |case: usize, state: &CaseState| stands(state) && self.case(case).exists();
        let standing = outcomes.par_iter().enumerate().filter(|(case, outcome)| has_tables(*case, &outcome.state));
        Ok(standing.map(of_case).collect::<io::Result<Vec<Vec<_>>>>()?.concat())
    }

    /// Writes the summary of the cases that stand now.
    fn write_what_stands(&self, cases: &Cases) -> io::Result<Vec<CaseOutcome>> {
        let wanted = &self.collect;
        let header: Vec<String> = ["case".to_owned()]
            .into_iter()
            .chain(cases.keys.iter().cloned())
            .chain(["status".to_owned()])
            .chain(wanted.iter().map(|one| one.name.clone()))
            .chain(["reason".to_owned(), "warnings".to_owned()])
            .collect();
        let row = |(case, values): (usize, &Vec<String>)| {
            let (outcome, numbers) = match self.records.find(&self.names[case]) {
                Some(record) => (record.outcome(), record.numbers),
                None => {
                    let folder = self.case(case);
                    let (outcome, of_run) = found(&folder);
                    let numbers = match stands(&outcome.state) {
                        true => collect(&folder, wanted, &of_run)?,
                        false => vec![None; wanted.len()],
                    };
                    (outcome, numbers.into_iter().map(in_words).collect())
                }
            };
            let state = outcome.state.word().to_owned();
            let mut row = [vec![(case + 1).to_string()], values.clone(), vec![state]].concat();
            row.extend(numbers);
            row.push(outcome.state.reason().to_owned());
            row.push(outcome.warnings.join("; "));
            Ok((row, outcome))
        };
        let all = cases.values.par_iter().enumerate().map(row).collect::<io::Result<Vec<_>>>()?;
        let (rows, outcomes): (Vec<Vec<String>>, Vec<CaseOutcome>) = all.into_iter().unzip();
        let has_folder = |name: &&String| self.keep == KeptFolders::All || self.path.join(name).exists();
        let folders: Vec<&str> =
            self.names.iter().map(|name| Some(name).filter(has_folder).map_or("", String::as_str)).collect();
        let page = page(&header, &rows, &folders, [cases.keys.len(), wanted.len()]);
        self.move_in("summary.html", page.as_bytes())?;
        self.write("summary.csv", header, rows.into_iter())?;
        Ok(outcomes)
    }

    /// Writes a file of comma separated values.
    fn write(&self, name: &str, header: Vec<String>, rows: impl Iterator<Item = Vec<String>>) -> io::Result<()> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let written = writer.write_record(&header).and_then(|()| {
            let mut rows = rows;
            rows.try_for_each(|row| writer.write_record(&row))
        });
        let bytes = written
            .map_err(io::Error::from)
            .and_then(|()| writer.into_inner().map_err(|error| io::Error::other(error.to_string())))?;
        self.move_in(name, &bytes)
    }

    /// Writes a file under a name of this process, and moves it in whole.
    fn move_in(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        let (path, own) = (self.path.join(name), self.path.join(format!("{name}.{}.tmp", std::process::id())));
        let moved =
            fs::File::create(&own).and_then(|mut file| file.write_all(bytes)).and_then(|()| fs::rename(&own, &path));
        moved.map_err(|error| {
            let _ = fs::remove_file(&own);
            at(&path, error)
        })
    }
}

/// The outcome of a case and the numbers that its run has found, from its folder.
fn found(folder: &Path) -> (CaseOutcome, Vec<FoundNumber>) {
    // A power cut may leave an empty one.
    if let Some(reason) = read_text(folder.join(FAILURE)).ok().filter(|reason| !reason.is_empty()) {
        return (CaseOutcome::without_result(CaseState::Failed(one_line(&reason))), Vec::new());
    }
    /// The entries of a result that say how a run ended.
    #[derive(Deserialize)]
    struct RunEnd {
        status: Status,
        reason: String,
        warnings: Vec<String>,
        #[serde(default)]
        collected: Vec<FoundNumber>,
    }
    let result = read_regular(folder.join(result_json::NAME)).ok();
    match result.and_then(|bytes| serde_json::from_slice::<RunEnd>(&bytes).ok()) {
        Some(RunEnd { status, reason, warnings, collected }) => {
            (CaseOutcome::of(status, &reason, &warnings), collected)
        }
        None => (CaseOutcome::without_result(CaseState::Pending), Vec::new()),
    }
}

/// True for a case whose tables are complete.
fn stands(state: &CaseState) -> bool {
    matches!(state, CaseState::Done | CaseState::Missed(_))
}

/// Computes the names of cases: 16 hexadecimal digits of a SHA-256 each.
struct CaseNames<'d> {
    /// The path and the text of the deck.
    deck: (&'d str, &'d str),
    /// The hash of the common input of all cases: the version and the deck.
    begun: Sha256,
    /// The other input files of all cases besides the deck; `None` if they may differ from case to case.
    files: Option<Vec<String>>,
    /// The digests of files, empty of those that cannot be read.
    digests: HashMap<PathBuf, Vec<u8>>,
}

impl<'d> CaseNames<'d> {
    /// For cases that differ in these keys.
    fn new(deck: (&'d str, &'d str), keys: &[String], version: &str) -> CaseNames<'d> {
        let mut begun = Sha256::new();
        [version, deck.1].into_iter().for_each(|part| add(&mut begun, part));
        // To read the deck once more for each case would take a quarter of a millisecond.
        let may_name_files = |key: &String| key.contains("mesh") || key.contains("amplitudes");
        let files = match keys.iter().any(may_name_files) {
            true => None,
            false => deck::read(&Source::new(deck.0, deck.1, &[])).0.map(|deck| files(&deck)),
        };
        CaseNames { deck, begun, files, digests: HashMap::new() }
    }

    /// The name of the case with these overrides.
    fn of(&mut self, sets: &[String]) -> String {
        let mut hasher = self.begun.clone();
        sets.iter().for_each(|set| add(&mut hasher, set));
        let own = || deck::read(&Source::new(self.deck.0, self.deck.1, sets)).0.map(|deck| files(&deck));
        let folder = Path::new(self.deck.0).parent().unwrap_or(Path::new(""));
        for file in self.files.clone().or_else(own).unwrap_or_default() {
            let digest = self.digests.entry(folder.join(file)).or_insert_with_key(|path| {
                read_regular(path).map(|bytes| Sha256::digest(&bytes).to_vec()).unwrap_or_default()
            });
            hasher.update(digest);
        }
        hasher.finalize().iter().take(8).map(|byte| format!("{byte:02x}")).collect()
    }
}

/// Hashes a text, apart from the one that follows.
fn add(hasher: &mut Sha256, part: &str) {
    hasher.update(part);
    hasher.update([0]);
}

/// The files that a deck is computed from, besides itself.
fn files(deck: &Deck) -> Vec<String> {
    let mesh = deck.mesh.iter().filter_map(|mesh| mesh.file.as_ref());
    let records = deck.amplitudes.0.iter().filter_map(|(_, amplitude)| amplitude.file.as_ref());
    mesh.chain(records).map(|file| file.value.clone()).collect()
}
