//! What a run has to say about its own results: they may not be the answer to the deck, or not to all of it.

use crate::names::short;
use std::fmt;
use std::mem::discriminant;

/// A doubt about results, with what it concerns.
#[derive(Debug, Clone, PartialEq)]
pub enum Warning {
    /// Initial velocities do not agree with the joints; the largest change over the largest velocity.
    InitialVelocities { change: f64 },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Warning::InitialVelocities { change } => {
                let part = short(*change);
                write!(
                    f,
                    "initial velocities violate the joints: they were corrected by up to {part} of the largest velocity"
                )
            }
        }
    }
}

/// The warnings of a run, each kind once: the first tells.
#[derive(Debug, Clone, Default)]
pub struct Warnings(Vec<Warning>);

impl Warnings {
    pub fn add(&mut self, warning: Warning) {
        if self.0.iter().all(|known| discriminant(known) != discriminant(&warning)) {
            self.0.push(warning);
        }
    }

    pub fn iter(&self) -> impl Iterator<Item = &Warning> {
        self.0.iter()
    }
}
