//! The reasons why there are no modes.

use base::snapshot::keep_either;
use linear::TooLarge;
use std::fmt;

/// The reason why modes were not found.
#[derive(Debug, Clone, PartialEq)]
pub enum ModesFault {
    /// Nothing that moves has mass.
    NoMass,
    /// The matrix is singular, whatever the shift.
    Singular {
        /// Name of the node or joint whose pivot vanishes.
        label: String,
        /// Name of the degree of freedom.
        direction: &'static str,
    },
    /// The iteration did not come to its end.
    NotConverged {
        /// Modes wanted.
        wanted: usize,
    },
    /// Some modes stay hidden: there are more than were found.
    Missed {
        /// Modes found below a frequency.
        found: usize,
        /// Modes that there are, by the signs of pivots.
        there: usize,
    },
    /// More modes lie in the range than are computed at once.
    TooMany {
        /// Modes in the range.
        there: usize,
        /// Modes that are computed at most.
        most: usize,
    },
    /// A support moves, and buckling has factors of loads only.
    MovedSupport,
    /// The state without loads is unstable already.
    UnstableUnloaded,
    /// No load acts, or none moves anything.
    NoLoads,
    /// No positive factor of the loads lets anything buckle.
    NoBuckling,
    /// Nothing that is harmonic moves anything.
    NothingExcites,
    /// A signal has stopped the search.
    Stopped,
    /// There is no memory.
    TooLarge(TooLarge),
}

keep_either!(ModesFault {
    0 => NoMass,
    1 => Singular { label, direction },
    2 => NotConverged { wanted },
    3 => Missed { found, there },
    4 => TooMany { there, most },
    5 => MovedSupport,
    6 => UnstableUnloaded,
    7 => NoLoads,
    8 => NoBuckling,
    9 => TooLarge(needed),
    10 => NothingExcites,
    11 => Stopped,
});

impl From<TooLarge> for ModesFault {
    fn from(error: TooLarge) -> ModesFault {
        ModesFault::TooLarge(error)
    }
}

impl ModesFault {
    /// The message of a fault without values.
    fn fixed_message(&self) -> &'static str {
        match self {
            ModesFault::NoMass => {
                "nothing that moves has mass, so there are no modes. Give materials a `density`, or points a mass (`[[masses]]`)"
            }
            ModesFault::MovedSupport => {
                "a support is displaced, but a buckling analysis finds factors of loads and temperatures only. Replace its `motion` by the force that it exerts"
            }
            ModesFault::UnstableUnloaded => {
                "the scene is unstable without these loads, by its prestress or earlier loads, so their factor is not defined. Lower the \
                 prestress, or the loads of earlier `[[stages]]`"
            }
            ModesFault::NoLoads => {
                "no load deforms anything, and buckling needs loads whose factors it finds. Add a load that compresses the structure \
                 (`[[loads]]`)"
            }
            ModesFault::NoBuckling => {
                "neither these loads nor their reverse buckle anything within reach. Check their direction, or follow large motions with \
                 `control` = \"arc-length\""
            }
            ModesFault::NothingExcites => {
                "no harmonic load or motion moves anything: they act on supports alone, or are zero. Let one of them, with an `amplitude` of \
                 kind \"harmonic\", act on a node that is free"
            }
            _ => "a signal stopped the search for `modes`. Start the run again",
        }
    }
}

impl fmt::Display for ModesFault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            ModesFault::Singular { label, direction } => write!(
                f,
                "neither stiffness nor mass resists at `{label}` in direction {direction}, so modes are not defined. Add a support there, or a \
                 mass (`[[masses]]`)"
            ),
            ModesFault::NotConverged { wanted } => {
                write!(f, "the iteration for {wanted} modes did not converge. Give `modes` = {}", wanted.div_ceil(2))
            }
            ModesFault::Missed { found, there } => write!(
                f,
                "only {found} of {there} modes were found, so the list would have gaps. Give `modes` = {}, or a lower `up_to`",
                found.div_ceil(2)
            ),
            ModesFault::TooMany { there, most } => write!(
                f,
                "{there} modes lie below `up_to`, and at most {most} are computed at once. Give `modes` = {most}, or a lower `up_to`"
            ),
            ModesFault::TooLarge(error) => error.fmt(f),
            _ => f.write_str(self.fixed_message()),
        }
    }
}

impl std::error::Error for ModesFault {}
