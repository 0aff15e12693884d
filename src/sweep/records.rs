//! The records of cases whose folders are not kept: a line of JSON each, with the state of the case and its collected numbers.
//!
//! Each process appends to a separate file in the folder `records`, and reads the files of all: any number of processes, on any number of
//! machines, may fill one sweep. A line without its end comes from a killed process and does not count.

use super::case_state::{CaseOutcome, CaseState, one_line};
use results::at;
use results::collected::Collected;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// The folder of the records in that of the sweep.
const NAME: &str = "records";

/// The record of a case without folder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseRecord {
    /// The name of the folder that the case had.
    folder: String,
    /// The digest of the list of collected numbers: other numbers need another run.
    collect: String,
    /// How often the case has been run; the last run counts.
    run: usize,
    /// The word of its state.
    status: String,
    /// The reason of a failure or a miss, in one line.
    reason: String,
    /// The warnings of its run.
    #[serde(default)]
    warnings: Vec<String>,
    /// The collected numbers as the summary has them, empty where a table has none.
    pub numbers: Vec<String>,
}

impl CaseRecord {
    /// The state of the case.
    pub fn state(&self) -> CaseState {
        match self.status.as_str() {
            "done" => CaseState::Done,
            "failed" => CaseState::Failed(self.reason.clone()),
            _ => CaseState::Missed(self.reason.clone()),
        }
    }

    /// The state of the case, with its warnings.
    pub fn outcome(&self) -> CaseOutcome {
        CaseOutcome { state: self.state(), warnings: self.warnings.clone() }
    }
}

/// The records of a sweep.
pub struct Records {
    dir: PathBuf,
    collect: String,
    known: Mutex<Known>,
}

/// The records read so far, and the file of this process.
#[derive(Default)]
struct Known {
    /// The bytes of each file that have been read.
    read: HashMap<PathBuf, u64>,
    /// The last record of each case, by the name of its folder.
    records: HashMap<String, CaseRecord>,
    own: Option<File>,
}

impl Records {
    /// The records in the folder of a sweep that collects these numbers; no file is made before the first record is.
    pub fn new(sweep: &Path, wanted: &[Collected]) -> Records {
        let collect = Sha256::digest(format!("{wanted:?}")).iter().take(8).map(|byte| format!("{byte:02x}")).collect();
        Records { dir: sweep.join(NAME), collect, known: Mutex::default() }
    }

    /// The record of a case, by the name of its folder; new records of other processes are read first.
    pub fn find(&self, folder: &str) -> Option<CaseRecord> {
        let mut known = self.known.lock().ok()?;
        known.refresh(&self.dir);
        known.records.get(folder).filter(|record| record.collect == self.collect).cloned()
    }

    /// Adds cases, each with its folder, its outcome and its numbers as the summary has them, and waits until they are safe on the disk.
    ///
    /// # Errors
    /// The file of this process cannot be written; the error names it.
    pub fn add(&self, cases: &[(String, &CaseOutcome, Vec<String>)]) -> io::Result<()> {
        let Ok(mut known) = self.known.lock() else { return Ok(()) };
        known.refresh(&self.dir);
        let mut lines = String::new();
        for (folder, outcome, numbers) in cases {
            let run = known.records.get(folder).map_or(0, |before| before.run) + 1;
            let (folder, collect, numbers) = (folder.clone(), self.collect.clone(), numbers.clone());
            let (status, reason) = (outcome.state.word().to_owned(), outcome.state.reason().to_owned());
            let record =
                CaseRecord { folder, collect, run, status, reason, warnings: outcome.warnings.clone(), numbers };
            lines += &serde_json::to_string(&record)?;
            lines.push('\n');
        }
        let path = self.dir.join(format!("{}.{}.jsonl", this_host(), std::process::id()));
        known.append(&self.dir, &path, &lines).map_err(|error| at(&path, error))
    }
}

impl Known {
    fn append(&mut self, dir: &Path, path: &Path, lines: &str) -> io::Result<()> {
        if self.own.is_none() {
            fs::create_dir_all(dir)?;
            self.own = Some(OpenOptions::new().create(true).append(true).open(path)?);
        }
        let Some(own) = &mut self.own else { return Ok(()) };
        // One call writes all lines, so that readers see whole ones.
        own.write_all(lines.as_bytes())?;
        own.sync_data()
    }

    /// Reads new lines of the files. Lines that cannot be read are omitted: their cases run again.
    fn refresh(&mut self, dir: &Path) {
        let Ok(entries) = fs::read_dir(dir) else { return };
        for entry in entries.flatten() {
            let path = entry.path();
            let from = self.read.get(&path).copied().unwrap_or(0);
            let length = entry.metadata().map_or(0, |found| if found.is_file() { found.len() } else { 0 });
            if length > from
                && let Ok(text) = tail(&path, from)
            {
                let whole = text.rfind('\n').map_or(0, |end| end + 1);
                text[..whole].lines().for_each(|line| self.learn(line));
                self.read.insert(path, from + whole as u64);
            }
        }
    }

    fn learn(&mut self, line: &str) {
        let Ok(record) = serde_json::from_str::<CaseRecord>(line) else { return };
        let is_newer = self.records.get(&record.folder).is_none_or(|before| before.run <= record.run);
        if is_newer {
            self.records.insert(record.folder.clone(), CaseRecord { reason: one_line(&record.reason), ..record });
        }
    }
}

/// The text of a file from a byte on.
fn tail(path: &Path, from: u64) -> io::Result<String> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(from))?;
    let mut text = String::new();
    file.read_to_string(&mut text)?;
    Ok(text)
}

/// The name of this host as a part of a file's name.
fn this_host() -> String {
    results::host().chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect()
}

/// Removes the folder of a case whose record stands. Another process may just be creating it to check whether the case is open, and removes
/// it itself.
///
/// # Errors
/// A file in it cannot be removed.
pub fn remove_folder(folder: &Path) -> io::Result<()> {
    match fs::remove_dir_all(folder) {
        Err(error) if [ErrorKind::NotFound, ErrorKind::DirectoryNotEmpty].contains(&error.kind()) => Ok(()),
        removed => removed.map_err(|error| at(folder, error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_whole_record_counts() {
        let root = tempfile::tempdir().unwrap();
        let (one, other) = (Records::new(root.path(), &[]), Records::new(root.path(), &[]));
        assert_eq!(one.find("a"), None);
        let failed = CaseOutcome::without_result(CaseState::Failed("no\nforce".into()));
        one.add(&[("a".into(), &failed, vec![])]).unwrap();
        assert_eq!(other.find("a").unwrap().state(), CaseState::Failed("no force".into()));
        let warned = CaseOutcome { state: CaseState::Done, warnings: vec!["it slips".into()] };
        other.add(&[("a".into(), &warned, vec!["1.5".into()])]).unwrap();
        let found = one.find("a").unwrap();
        assert_eq!((found.outcome(), found.numbers), (warned, vec!["1.5".to_owned()]));
        // A truncated line, and another list of collected numbers.
        fs::write(root.path().join(NAME).join("gone.1.jsonl"), "{\"folder\":\"b\"").unwrap();
        assert_eq!(one.find("b"), None);
        let others = Collected {
            name: "x".into(),
            at: "b".into(),
            quantity: "ux".into(),
            stage: None,
            when: results::collected::CollectedWhen::End,
        };
        assert_eq!(Records::new(root.path(), &[others]).find("a"), None);
    }
}
