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

/// Peaks of accelerations that records of earthquakes have, in g. Below the first a structure is hardly ever computed, seldom below the
/// second, and no instrument has measured more than the last. A record in g that is read in m/s² has 0.102 times its strength, one in cm/s²
/// 100 times.
const PEAKS: [f64; 3] = [0.02, 0.1, 5.0];

/// A scale replaces the conversion if both differ by less than this part, ...
const WRITTEN: f64 = 1e-3;
/// ... and seems to convert once more if they differ by less than this one.
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

/// Uses of records that name no unit, with their peaks in the unit of the file and in g.
pub struct BareRecords<'d>(Vec<(Use<'d>, &'d str, [f64; 2])>);

impl<'d> BareRecords<'d> {
    /// None yet.
    pub fn new() -> Self {
        BareRecords(Vec::new())
    }

    /// Adds a use that gives accelerations. A scale says that the unit has been thought of.
    pub fn add(&mut self, deck: &Deck, used: Use<'d>, (words, record): (&'d Amplitude, &Record)) {
        let is_scaled = words.scale.is_some() || used.scale.is_some();
        let Some(unit) = acceleration(deck).filter(|_| used.quantity == MotionQuantity::Acceleration && !is_scaled)
        else {
            return;
        };
        let largest = largest(record);
        let file = words.file.as_ref().map_or("", |file| file.value.as_str());
        self.0.push((used, file, [largest, largest * unit / G]));
    }

    /// Warns if no earthquake has the peak of the strongest record that moves the ground, supports or joints, in the units of the deck. The
    /// other components of a station may be weak. Notes a peak that is rare.
    pub fn check(self, deck: &Deck, report: &mut Report) {
        let label = deck.units.as_ref().map_or("", |units| units.value.label());
        let mut strongest: Vec<(Use, &str, [f64; 2])> = Vec::new();
        for one in self.0 {
            match strongest.iter_mut().find(|of| of.0.what == one.0.what) {
                Some(of) if of.2[1] < one.2[1] => *of = one,
                Some(_) => {}
                None => strongest.push(one),
            }
        }
        for (used, file, [largest, peak]) in strongest {
            if peak == 0.0 || (PEAKS[1]..=PEAKS[2]).contains(&peak) {
                continue;
            }
            let message = format!(
                "the record `{file}` names no unit: in the units {label} its peak, {}, moves {} with {} g",
                short(largest),
                used.what,
                to_digits(peak, 3)
            );
            let hint = "`scale = 1.0` says that it is in the units of the deck; else give the unit of the file, such as `unit = \"g\"`, \"cm/s2\" or \"m/s2\"";
            match (PEAKS[0]..=PEAKS[2]).contains(&peak) {
                true => report.note(used.place, message, hint),
                false => report.warn(used.place, message, hint),
            }
        }
    }
}

/// Scales over the factor of conversion that were most likely meant to convert.
const AGAIN: std::ops::Range<f64> = 0.3..1.6;

/// Warns of a converted record whose scale makes it stronger than any that was measured: the scale may have been meant to convert it. True if it does.
pub fn is_too_strong(
    deck: &Deck,
    used: &Use,
    (words, record, factor): (&Amplitude, &Record, f64),
    report: &mut Report,
) -> bool {
    let scales = [words.scale.as_ref().map(|scale| scale.value), used.scale];
    let scale = scales.iter().flatten().product::<f64>();
    let Some(unit) = acceleration(deck).filter(|_| used.quantity == MotionQuantity::Acceleration) else { return false };
    let peak = largest(record) * (factor * scale * unit / G).abs();
    // The conversion times a usual factor on a record, such as 2/3 of g for a vertical one.
    let converts_again = factor != 1.0 && AGAIN.contains(&(scale / factor).abs());
    if scales.iter().all(Option::is_none) || peak <= PEAKS[2] && !converts_again {
        return false;
    }
    let file = words.file.as_ref().map_or("", |file| file.value.as_str());
    let message = format!(
        "the record `{file}` is converted to the units of the deck, and with the scale {} it moves {} with {} g",
        short(scale),
        used.what,
        to_digits(peak, 3)
    );
    let hint = format!("the scale is a factor on the whole record: give `scale` = {}", to_digits(scale / factor, 4));
    report.warn(used.place, message, hint);
    true
}

/// The largest magnitude of a record.
fn largest(record: &Record) -> f64 {
    record.points.iter().fold(0.0, |largest: f64, [_, value]| largest.max(value.abs()))
}

/// True for a scale that is this factor between units, rounded as in decks: 9.8 or 9.81 for 9.80665.
pub fn is_factor(scale: f64, factor: f64) -> bool {
    (scale.abs() / factor - 1.0).abs() < WRITTEN
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
