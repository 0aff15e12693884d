//! Frequencies of unlimited motion, in words.

use base::names::short;

/// Message about frequencies without a steady motion, in cycles per time, each with the growing mode, counted from 0, if modes are known;
/// `None` without such frequencies.
pub(super) fn resonances_in_words(all: &[(f64, Option<usize>)]) -> Option<String> {
    let (&(frequency, mode), count) = (all.first()?, all.len());
    let mode = mode.map_or_else(String::new, |mode| format!(", that of mode {},", mode + 1));
    let more = if count > 1 { format!(" and {} others", count - 1) } else { String::new() };
    Some(format!(
        "at frequency {}{mode}{more} nothing limits the motion: it is an undamped resonance, or a motion without stiffness. Its amplitudes are \
         left empty. Add damping, such as `beta` = 1e-4 in [damping]",
        short(frequency)
    ))
}
