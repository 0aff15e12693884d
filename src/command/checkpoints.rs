//! The checkpoints of a run: their times and their contents.

use results::checkpoint::{Checkpoint, CheckpointOrigin};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// The checkpoints that a run is to write.
#[derive(Debug, Clone)]
pub struct CheckpointsWanted {
    /// What they belong to.
    pub origin: CheckpointOrigin,
    /// The seconds between two; `None` if only a signal requests one.
    pub apart: Option<f64>,
    /// True if the end of the run keeps one, so that the run can be extended.
    pub keeps_last: bool,
}

/// Writes checkpoints into the folder of a run.
pub struct Checkpoints {
    folder: PathBuf,
    /// The next checkpoint; its memory is reused.
    next: Checkpoint,
    /// Raised by the clock.
    due: Arc<AtomicBool>,
    /// The clock runs as long as this is there.
    _clock: Option<Sender<()>>,
    /// True once the first has been written, or was there.
    any: bool,
    /// True if the end of a run keeps one, so that the run can be extended.
    keeps_last: bool,
}

impl Checkpoints {
    /// The checkpoints of a run that writes into this folder.
    pub fn new(folder: &Path, wanted: CheckpointsWanted) -> Checkpoints {
        let CheckpointsWanted { origin, apart, keeps_last } = wanted;
        let due = Arc::new(AtomicBool::new(false));
        // A thread looks at the clock: to look at it before every step would cost a small scene a twentieth.
        let clock = apart.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()).map(|apart| {
            let (alive, ended) = channel::<()>();
            let due = due.clone();
            std::thread::spawn(move || {
                while ended.recv_timeout(apart) == Err(RecvTimeoutError::Timeout) {
                    due.store(true, Ordering::Relaxed);
                }
            });
            alive
        });
        let next = Checkpoint { origin, ..Checkpoint::default() };
        Checkpoints { folder: folder.to_owned(), next, due, _clock: clock, any: false, keeps_last }
    }

    /// The same checkpoints, if the folder already has one.
    #[must_use]
    pub fn after_another(self, any: bool) -> Checkpoints {
        Checkpoints { any, ..self }
    }

    /// True where a checkpoint is due, between two steps or at the end of the run.
    pub fn is_due(&self, at_end: bool) -> bool {
        if at_end { self.keeps_last } else { self.due.load(Ordering::Relaxed) }
    }

    /// True if the last one was written at the end of the run.
    pub fn is_over(&self) -> bool {
        self.next.origin.is_over
    }

    /// Records the results of the stages before the current one.
    pub fn begin_stage(&mut self, stages: Vec<u8>) {
        self.next.stages = stages;
    }

    /// Writes a checkpoint.
    ///
    /// # Errors
    /// It cannot be written; the one before then stands.
    pub fn write(&mut self, watchers: Vec<u8>, (run, at_end): (&[u8], bool)) -> io::Result<()> {
        self.next.origin.is_over = at_end;
        self.next.watchers = watchers;
        self.next.run.clear();
        self.next.run.extend_from_slice(run);
        self.next.write(&self.folder)?;
        self.due.store(false, Ordering::Relaxed);
        self.any = true;
        Ok(())
    }

    /// Takes the checkpoint away, for its tables are about to be written anew; the next is due at once where there was one.
    ///
    /// # Errors
    /// It cannot be removed.
    pub fn withdraw(&mut self) -> io::Result<()> {
        if std::mem::take(&mut self.any) {
            self.due.store(true, Ordering::Relaxed);
        }
        Checkpoint::remove(&self.folder)
    }
}
