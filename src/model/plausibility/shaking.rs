//! The strength of recorded accelerations: records without a unit, and records that are converted twice.

use crate::record::{MotionQuantity, RecordUnit};
use crate::records::Record;
use crate::report::Report;
use base::diagnostic::Span;
use base::names::{short, to_digits};
use deck::Deck;
use deck::amplitudes::Amplitude;
use deck::words::Maybe;

/// Standard gravity, in m/s².
const G: f64 = 9.80665;

/// Peaks of accelerations that records of earthquakes have, in g. A structure is seldom computed under less than the first, and no
/// instrument has measured more than the second. A record in g that is read in m/s² has 0.102 times its strength, one in cm/s² 100 times.
const PEAKS: [f64; 2] = [0.1, 5.0];

/// A scale is a conversion if it is one up to this part of it: 9.81 for 9.80665.
const ROUNDED: f64 = 0.01;

/// A use of a record as a motion in the deck.
pub struct Use<'d> {
    /// The amplitude.
    pub amplitude: &'d Maybe<String>,
    /// The quantity that the amplitude gives.
    pub quantity: MotionQuantity,
    /// The factor on the amplitude, where the deck has one.
    pub scale: Option<f64>,
    /// The moved thing, for messages.
    pub what: &'static str,
    /// The place of the use in the deck.
    pub place: &'d Span,
}

/// The unit of acceleration of the deck, in m/s².
fn acceleration(deck: &Deck) -> Option<f64> {
    let [length, _, time] = deck.units.as_ref()?.value.scales();
    Some(length / (time * time))
}

/// Warns of accelerations from a file that names no unit, if no earthquake has their peak in the units of the deck. A scale says that their
/// unit has been thought of.
pub fn check_bare(deck: &Deck, used: &Use, (words, record): (&Amplitude, &Record), report: &mut Report) {
    let is_scaled = words.scale.is_some() || used.scale.is_some();
    let Some(unit) = acceleration(deck).filter(|_| used.quantity == MotionQuantity::Acceleration && !is_scaled) else {
        return;
    };
    let largest = record.points.iter().fold(0.0, |largest: f64, [_, value]| largest.max(value.abs()));
    let peak = largest * unit / G;
    if peak == 0.0 || (PEAKS[0]..=PEAKS[1]).contains(&peak) {
        return;
    }
    let (file, what) = (words.file.as_ref().map_or("", |file| file.value.as_str()), used.what);
    let label = deck.units.as_ref().map_or("", |units| units.value.label());
    let message = format!(
        "the record `{file}` names no unit: in the units {label} its peak, {}, moves {what} with {} g",
        short(largest),
        to_digits(peak, 3)
    );
    let hint = "give the amplitude the unit of the file, such as `unit = \"g\"`, \"cm/s2\" or \"m/s2\"";
    report.warn(used.place, message, hint);
}

/// Warns of a record that two of the header or `unit`, the scale of the amplitude and the scale of its use convert. True if it does.
pub fn is_converted_twice(
    deck: &Deck,
    used: &Use,
    (words, unit, is_converted): (&Amplitude, &RecordUnit, bool),
    report: &mut Report,
) -> bool {
    let Some((units, (quantity, si))) = deck.units.as_ref().zip(unit.known) else { return false };
    let [length, _, time] = units.value.scales();
    let right = si * time.powi(quantity.power_of_time()) / length;
    let is_conversion = |scale: &f64| (scale.abs() / right - 1.0).abs() < ROUNDED;
    let scales = [words.scale.as_ref().map(|scale| scale.value), used.scale];
    let conversions: Vec<f64> = scales.into_iter().flatten().filter(is_conversion).collect();
    let count = conversions.len() + usize::from(is_converted);
    if count < 2 || is_conversion(&1.0) {
        return false;
    }
    let file = words.file.as_ref().map_or("", |file| file.value.as_str());
    let first = if is_converted { "its unit" } else { "a first scale" };
    let message = format!(
        "the record `{file}` is in {}: {first} converts it to the units {}, and the scale {} does so once more",
        unit.name,
        units.value.label(),
        short(conversions[0])
    );
    report.warn(used.place, message, "leave that scale out, or give a factor on the whole record, such as 1.5");
    true
}
