//! Modes over speeds of rotation, and critical speeds.

use linear::eigen::Complex;

/// The modes at a speed of rotation.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedModes {
    /// The speed of the body that spins fastest.
    pub speed: f64,
    /// The modes, by their frequency.
    pub list: Vec<SpeedMode>,
}

/// A mode at a speed, without its shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedMode {
    /// Growth rate and angular frequency, 0 or more.
    pub root: Complex,
    /// As in [`super::EigenMode::whirl`].
    pub whirl: Option<f64>,
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
