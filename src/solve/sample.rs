//! The times inside steps with an evaluation of the motion.

use base::snapshot::{Keep, Snapshot};

/// A time inside the steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// The time.
    pub time: f64,
    /// True for an output time.
    pub due: bool,
    /// True for a time for the comparison of runs.
    pub compared: bool,
}

/// Times of evaluations inside steps, in order.
pub struct Samples<'s> {
    coming: &'s [Sample],
}

impl Keep for Samples<'_> {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        let Samples { coming } = self;
        let mut left = coming.len();
        left.keep(snapshot);
        match coming.len().checked_sub(left) {
            Some(passed) => *coming = &coming[passed..],
            None => snapshot.tear(),
        }
    }
}

impl<'s> Samples<'s> {
    /// All of these.
    pub fn new(coming: &'s [Sample]) -> Self {
        Samples { coming }
    }

    /// The next time up to this one.
    pub fn next(&self, until: f64) -> Option<Sample> {
        self.coming.first().copied().filter(|next| next.time <= until)
    }

    /// Goes on to the time after the next.
    pub fn pass(&mut self) {
        self.coming = self.coming.get(1..).unwrap_or_default();
    }
}
