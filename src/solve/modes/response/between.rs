//! Resonances between two frequencies of a response, which its rows do not show.
//!
//! Near a mode each component of the motion is a/(z − ω), z the complex frequency of the mode. Its inverse is linear in ω, and two frequencies determine z.
//! Beside a resonance the motion falls away from the gap on both sides; beside an antiresonance it rises.

use super::super::steady::ResponseRow;
use super::excitation::C64;
use crate::tolerances::response_between::{HIGHER, ROUNDING, UNLIMITED};
use base::names::{short, to_digits};

/// A resonance between two rows.
struct Missed {
    between: [f64; 2],
    /// Its frequency, and half the width of its peak.
    frequency: f64,
    half_width: f64,
    /// Its motion over the larger one of both rows.
    higher: f64,
    /// The part of the component in the largest motion of its kind.
    share: f64,
}

/// Warning of the resonances between frequencies of these rows, ascending; `None` without any.
pub(super) fn missed_in_words(rows: &[ResponseRow]) -> Option<String> {
    let all: Vec<Missed> = (1..rows.len()).filter_map(|after| missed(rows, after)).collect();
    let worst = all.iter().max_by(|a, b| a.higher.total_cmp(&b.higher))?;
    let [before, after] = worst.between.map(short);
    let others: Vec<String> =
        all.iter().map(|one| short(to_five(one.frequency))).filter(|f| *f != short(to_five(worst.frequency))).collect();
    let others = if others.is_empty() { String::new() } else { format!("; others lie near {}", others.join(", ")) };
    let peak = match worst.higher > UNLIMITED {
        true => "nothing limits the motion there".to_owned(),
        false => {
            format!("its peak is about {} times the motion at these, and no row has it", to_digits(worst.higher, 2))
        }
    };
    Some(format!(
        "a resonance lies between the frequencies {before} and {after}, near {}: {peak}{others}. Give a range with `around_resonances` = 10 in \
         `frequencies`, or more frequencies there, {} apart",
        short(to_five(worst.frequency)),
        to_digits(worst.half_width.max(1e-6 * worst.frequency), 2)
    ))
}

/// A number in five digits.
fn to_five(value: f64) -> f64 {
    to_digits(value, 5).parse().unwrap_or(value)
}

/// The resonance between a row and the one before. Of the components that show one, the largest counts.
fn missed(rows: &[ResponseRow], after: usize) -> Option<Missed> {
    let places = (0..rows[after].motions.len()).flat_map(|node| (0..6).map(move |dof| (node, dof)));
    places.filter_map(|place| missed_by(rows, after, place)).max_by(|a, b| a.share.total_cmp(&b.share))
}

/// The resonance of one component, if it is higher than both rows by more than a little.
fn missed_by(rows: &[ResponseRow], after: usize, (node, dof): (usize, usize)) -> Option<Missed> {
    let complex = |[real, imaginary]: [f64; 2]| C64::new(real, imaginary);
    let at = |k: usize| rows.get(k).map(|row| complex(row.motions[node][dof]));
    let (a, b) = (at(after - 1)?, at(after)?);
    let alike = if dof < 3 { 0..3 } else { 3..6 };
    let motions = rows[after].motions.iter().flat_map(|motion| &motion[alike.clone()]);
    let largest = motions.map(|motion| complex(*motion).norm()).fold(0.0, f64::max);
    let falls = |k: Option<usize>, size: f64| k.and_then(at).is_none_or(|x| x.norm() < size);
    let share = b.norm() / largest;
    let is_seen = share > ROUNDING && falls(after.checked_sub(2), a.norm()) && falls(Some(after + 1), b.norm());
    let [from, to] = [rows[after - 1].frequency, rows[after].frequency];
    let slope = (b.inv() - a.inv()) / (to - from);
    let root = from - a.inv() / slope;
    let higher = (root - from).norm() / root.im.abs() * (a.norm() / a.norm().max(b.norm()));
    let is_between = root.re > from && root.re < to;
    (is_seen && is_between && higher > HIGHER).then(|| Missed {
        between: [from, to],
        frequency: root.re,
        half_width: root.im.abs(),
        higher,
        share,
    })
}
