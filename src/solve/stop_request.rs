//! The request to end a run, and how long the step under way may go on after it.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A step that takes longer is given up: schedulers kill a process half a minute after their signal, or sooner. A run that goes on at the end of
/// a step gives the same bits as one that was never stopped, so nearly all steps are to come to their end.
const PATIENCE: Duration = Duration::from_secs(2);

/// A request to end a run.
pub struct StopRequest<'a> {
    flag: &'a AtomicBool,
    /// The time from the request on after which a step is given up.
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

    /// True where the run was to end so long ago that the step under way is given up.
    #[inline]
    pub fn is_overdue(&self) -> bool {
        self.is_made() && self.seen.get_or_init(Instant::now).elapsed() >= self.patience
    }
}
