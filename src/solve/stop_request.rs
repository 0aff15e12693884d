//! The request to end a run, and the time limit of the current step after it.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Time limit for the current step after a signal, since schedulers kill a process half a minute after their signal, or sooner. Nearly all
/// steps should be completed: a run resumed at the end of a step gives the same bits as an uninterrupted one.
const PATIENCE: Duration = Duration::from_secs(2);

/// A request to end a run.
pub struct StopRequest<'a> {
    flag: &'a AtomicBool,
    /// The time from the request after which a step is aborted.
    patience: Duration,
    /// When the request was seen first.
    seen: OnceLock<Instant>,
}

impl<'a> StopRequest<'a> {
    /// The request that this flag makes when it is raised.
    pub fn of(flag: &'a AtomicBool) -> StopRequest<'a> {
        StopRequest { flag, patience: PATIENCE, seen: OnceLock::new() }
    }

    /// True where the run is to end.
    #[inline]
    pub fn is_made(&self) -> bool {
        self.flag.load(Ordering::Relaxed)
    }

    /// True if the request was made so long ago that the current step is aborted.
    #[inline]
    pub fn is_overdue(&self) -> bool {
        self.is_made() && self.seen.get_or_init(Instant::now).elapsed() >= self.patience
    }
}
