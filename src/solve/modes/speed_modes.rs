//! Modes over speeds of rotation, and critical speeds.

use crate::tolerances::speeds::PLANAR;
use linear::eigen::Complex;

/// The modes at a speed of rotation.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedModes {
    /// The speed of the body that spins fastest.
    pub speed: f64,
    /// The modes, by their frequency.
    pub list: Vec<SpeedMode>,
}

/// The orbits of a mode about the axis of the spin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Whirl {
    /// 1 circular with the spin, −1 circular against it, 0 along lines.
    pub sense: f64,
    /// True for torsion and motion along the axis, which have no orbits.
    pub is_along: bool,
}

impl Whirl {
    /// The orbits in a word.
    pub fn kind(&self) -> &'static str {
        match self.sense {
            _ if self.is_along => "torsion or axial",
            sense if sense.abs() < PLANAR => "planar",
            sense if sense > 0.0 => "forward",
            _ => "backward",
        }
    }
}

/// A mode at a speed, without its shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedMode {
    /// Growth rate and angular frequency, 0 or more.
    pub root: Complex,
    /// As in [`super::EigenMode::whirl`].
    pub whirl: Option<Whirl>,
}

/// A speed that is the frequency of a mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CriticalSpeed {
    /// The speed.
    pub speed: f64,
    /// The mode.
    pub mode: SpeedMode,
}

impl SpeedMode {
    /// The part of critical damping; `None` where nothing oscillates nor decays.
    pub fn damping_ratio(&self) -> Option<f64> {
        let size = self.root[0].hypot(self.root[1]);
        (size > 0.0).then(|| -self.root[0] / size + 0.0)
    }
}
