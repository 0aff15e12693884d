//! The marks of completed cases. A case is marked once all of its files are safe on the disk, so that no case seems complete after a power
//! cut but is not. Cases that end while others are being made safe are made safe together.

use super::case_state::{CaseState, Computed};
use super::folder::SweepFolder;
use results::checkpoint::Checkpoint;
use results::{make_safe, result_json};
use std::io;
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

/// The time between two calls that make files safe: a case waits no longer than this for others.
const APART: Duration = Duration::from_millis(200);

/// Marks cases in the folder of a sweep as they come, until no more do.
///
/// # Errors
/// The disk did not store the files; cases without a mark run again.
pub fn mark_all(within: &SweepFolder, computed: &Receiver<Computed>) -> io::Result<()> {
    let mut next = Instant::now();
    while let Ok(first) = computed.recv() {
        let mut cases = vec![first];
        while let Ok(case) = computed.recv_timeout(next.saturating_duration_since(Instant::now())) {
            cases.push(case);
        }
        next = Instant::now() + APART;
        // A case that a signal has stopped is pending, and stays; without files, its checkpoint is safe already.
        let stay = within.let_go(cases)?;
        if !within.keeps().files {
            continue;
        }
        if !stay.is_empty() {
            make_safe(&within.path, &stay.iter().map(|case| case.folder.clone()).collect::<Vec<_>>())?;
        }
        for Computed { folder, outcome, lock, .. } in stay {
            result_json::mark(&folder)?;
            if outcome.state != CaseState::Pending {
                Checkpoint::remove(&folder)?;
            }
            drop(lock);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case_state::CaseOutcome;
    use crate::cases::Cases;
    use crate::file::SweepFile;
    use results::FolderLock;
    use std::fs;
    use std::sync::mpsc::channel;

    #[test]
    fn cases_are_marked_and_let_go() {
        let root = tempfile::tempdir().unwrap();
        let none = Cases { keys: Vec::new(), values: Vec::new() };
        let within = SweepFolder::new(root.path().to_owned(), ("", ""), &none, "", &SweepFile::default());
        let (done, computed) = channel();
        let folders = ["ended", "stopped"].map(|name| root.path().join(name));
        for (folder, state) in folders.iter().zip([CaseState::Done, CaseState::Pending]) {
            let lock = FolderLock::make(folder).unwrap();
            fs::write(folder.join("result.json.tmp"), "{}").unwrap();
            fs::write(Checkpoint::path(folder), "state").unwrap();
            let outcome = CaseOutcome::without_result(state);
            done.send(Computed { folder: folder.clone(), lock, outcome, numbers: Vec::new() }).unwrap();
        }
        assert!(folders.iter().all(|folder| !folder.join("result.json").exists()));
        drop(done);
        mark_all(&within, &computed).unwrap();
        for (folder, keeps) in folders.iter().zip([false, true]) {
            assert!(folder.join("result.json").exists() && FolderLock::take(folder).is_ok());
            assert_eq!(Checkpoint::path(folder).exists(), keeps);
        }
    }
}
