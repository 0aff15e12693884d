//! Frequencies at which nothing limits the motion, in words.

use base::names::short;

/// What is said of frequencies at which there is no steady motion, in cycles per time, each with the mode that grows without limit, from 0, where
/// modes are known; `None` where there are none.
pub(super) fn resonances_in_words(all: &[(f64, Option<usize>)]) -> Option<String> {
    let (&(frequency, mode), count) = (all.first()?, all.len());
    let mode = mode.map_or_else(String::new, |mode| format!(", that of mode {},", mode + 1));
    let more = if count > 1 { format!(" and {} others", count - 1) } else { String::new() };
    Some(format!(
        "at frequency {}{mode}{more} nothing limits the motion (undamped resonance, or a motion without stiffness): amplitudes stay empty. \
         Give what moves some damping",
        short(frequency)
    ))
}
