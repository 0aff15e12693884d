//! The frequency response that an analysis computes.

use super::modes::ModeExtent;

/// The steady response to harmonic loads and motions of supports.
#[derive(Debug, Clone, PartialEq)]
pub struct ResponseAsked {
    /// Frequencies, cycles per time, ascending.
    pub frequencies: Vec<f64>,
    /// More frequencies around natural ones.
    pub resonances: Option<AroundResonances>,
    /// The method of solution.
    pub method: ResponseMethod,
    /// The part of critical damping that every mode has besides; zero with direct solution.
    pub damping_ratio: f64,
    /// The modes that answer with their inertia.
    pub extent: ModeExtent,
    /// True where the deck does not give the number of modes with inertia.
    pub extent_is_open: bool,
}

/// More frequencies around the natural ones of a range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AroundResonances {
    /// The first frequency of the range, and the last.
    pub range: [f64; 2],
    /// Frequencies on each side.
    pub count: usize,
}

/// The methods for a response.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ResponseMethod {
    /// By the equations themselves, factorised at each frequency.
    #[default]
    Direct,
    /// By natural modes, all others answering as springs.
    Modal,
}
