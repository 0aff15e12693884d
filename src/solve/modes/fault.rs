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
    /// Modes over speeds of rotation are asked for, and nothing rotates.
    NothingSpins,
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
    12 => NothingSpins,
});

impl From<TooLarge> for ModesFault {
    fn from(error: TooLarge) -> ModesFault {
        ModesFault::TooLarge(error)
    }
}

impl fmt::Display for ModesFault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            ModesFault::NoMass => write!(
                f,
                "nothing that moves has mass, so there are no modes: materials need a density, or points a mass (`[[masses]]`)"
            ),
            ModesFault::Singular { label, direction } => write!(
                f,
                "neither stiffness nor mass resists at `{label}` in direction {direction}: modes are not defined; hold it \
                 there, or give it a mass"
            ),
            ModesFault::NotConverged { wanted } => {
                write!(f, "the iteration for {wanted} modes did not converge (fewer `modes`)")
            }
            ModesFault::Missed { found, there } => write!(
                f,
                "{found} modes were found where there are {there}: those listed are right, but some between them are missing"
            ),
            ModesFault::TooMany { there, most } => {
                write!(f, "{there} modes lie below `up_to`, and at most {most} are computed at once: a lower `up_to`")
            }
            ModesFault::MovedSupport => write!(
                f,
                "a support is displaced, and a buckling analysis finds factors of loads only: replace it by the force that it exerts"
            ),
            ModesFault::UnstableUnloaded => {
                write!(
                    f,
                    "the scene is unstable without these loads (compressed by what acts already, or its own prestress): nothing is left to \
                     buckle"
                )
            }
            ModesFault::NoLoads => {
                write!(f, "no load acts that deforms anything: buckling needs loads, whose factors are found")
            }
            ModesFault::NoBuckling => {
                write!(f, "no factor of these loads or of their reverse is found that lets anything buckle")
            }
            ModesFault::NothingExcites => {
                write!(f, "nothing that is harmonic moves anything: loads act on supports alone, or are zero")
            }
            ModesFault::NothingSpins => write!(
                f,
                "no body spins at t = 0, so `speeds` has nothing to turn: give the rotor an angular velocity in `[[initial]]`, whose axis counts"
            ),
            ModesFault::Stopped => write!(f, "a signal has stopped the search"),
            ModesFault::TooLarge(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ModesFault {}
