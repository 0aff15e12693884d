//! Frequencies at which nothing limits the motion, in words.

use crate::names::short;

/// A frequency at which there is no steady motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Resonance {
    /// The frequency, cycles per time.
    pub frequency: f64,
    /// The mode that grows without limit, from 0; `None` where modes are not known.
    pub mode: Option<usize>,
}

/// What is said of them; `None` where there are none.
pub(super) fn resonances_in_words(all: &[Resonance]) -> Option<String> {
    let (first, count) = (all.first()?, all.len());
    let mode = first.mode.map_or_else(String::new, |mode| format!(", that of mode {},", mode + 1));
    let more = if count > 1 { format!(" and {} others", count - 1) } else { String::new() };
    Some(format!(
        "at frequency {}{mode}{more} nothing limits the motion (undamped resonance, or a motion without stiffness): amplitudes stay empty. \
         Give what moves some damping",
        short(first.frequency)
    ))
}
