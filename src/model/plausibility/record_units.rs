//! Records in other units than the deck. Headers of data bases give the unit; values are converted where the deck has `units` and no scale.

use super::shaking::{BareRecords, Use, is_converted_twice, is_factor, is_too_strong};
use crate::record::{MotionQuantity, RecordUnit};
use crate::records::Record;
use crate::report::Report;
use base::names::{short, to_digits};
use deck::Deck;
use deck::amplitudes::Amplitude;
use deck::supports::{History, Motion};
use deck::words::Maybe;

/// Records are scaled up and down for analyses of one strength after the other, seldom by more than this.
const SCALING: f64 = 50.0;

/// The strength of a record is reported below this part of it: a factor of 2 on a record in g, without g itself, is a fifth.
const WEAK: f64 = 0.5;

/// Warns of records used as another quantity than their own, and of records in other units than the deck without a conversion.
pub fn check_record_units(deck: &Deck, records: &[Option<Record>], report: &mut Report) {
    for (name, words) in &deck.amplitudes.0 {
        let is_this = |used: &Use| used.amplitude.as_ref().is_some_and(|own| own.value == name.value);
        if let Some(at) = words.unit.as_ref().filter(|_| !uses(deck).iter().any(is_this)) {
            let message = format!("`unit` converts records of a motion, and amplitude `{}` gives none", name.value);
            report.error_with::<()>(&at.span, message, "leave it out, and give `scale`");
        }
    }
    let mut bare = BareRecords::new();
    for used in uses(deck) {
        let Some(name) = used.amplitude else { continue };
        let Some(index) = deck.amplitudes.position(name) else { continue };
        let words = &deck.amplitudes.0[index].1;
        let Some(record) = records.get(index).and_then(Option::as_ref) else { continue };
        let Some(unit) = &record.unit else {
            bare.add(deck, used, (words, record));
            continue;
        };
        let file = words.file.as_ref().map_or("", |file| file.value.as_str());
        if let Some((quantity, _)) = unit.known.filter(|(quantity, _)| *quantity != used.quantity) {
            let message = format!(
                "the record `{file}` has {} in {}, and {} takes it for {}",
                quantity.word(),
                unit.name,
                used.what,
                used.quantity.word()
            );
            report.error_with::<()>(used.place, message, remedy(quantity));
            continue;
        }
        if let Some(place) = words.unit.as_ref().map(|at| &at.span).filter(|_| deck.units.is_none()) {
            let message = "`unit` converts a record to the units of the deck, and the deck does not name them";
            report.error_with::<()>(place, message, "give `units` at the top, such as `units = \"SI\"`");
            continue;
        }
        let converted = conversion(deck, index, record);
        if is_converted_twice(deck, &used, (words, unit, converted.is_some()), report) {
            continue;
        }
        if let Some(factor) = converted {
            if is_too_strong(deck, &used, (words, record, factor), report) {
                continue;
            }
            if words.unit.is_none() {
                note_conversion(deck, &used, (file, unit), factor, report);
            }
            continue;
        }
        let given = [words.scale.as_ref().map(|scale| scale.value), used.scale];
        let factor = given.iter().flatten().product::<f64>().abs();
        // The word for numbers that are in the units of the deck, whatever the header says.
        if given == [Some(1.0), None] {
            continue;
        }
        note_scale(deck, &used, (words, unit), report);
        check_factor(deck, &used, (file, unit), given.iter().any(Option::is_some).then_some(factor), report);
    }
    bare.check(deck, report);
}

/// True for a record of the ground that begins with the first dynamic stage. Its times count from 0, and the deck gives no time for its begin.
pub fn waits_for_motion(deck: &Deck, index: usize, record: &Record) -> bool {
    let words = &deck.amplitudes.0[index].1;
    let begins_at_zero = record.points.first().is_some_and(|[time, _]| *time == 0.0);
    words.shift.is_none() && words.stage.is_none() && begins_at_zero && shakes_alone(deck, index)
}

/// True for an amplitude that moves the ground and nothing else.
pub fn shakes_alone(deck: &Deck, index: usize) -> bool {
    let name = &deck.amplitudes.0[index].0;
    let is_this = |own: &Maybe<String>| own.as_ref().is_some_and(|own| own.value == name.value);
    let mut ground = deck.environment.iter().flat_map(|environment| &environment.base_acceleration);
    let shakes = ground.any(|base| is_this(&base.amplitude));
    let weighs = deck.environment.as_ref().is_some_and(|environment| is_this(&environment.gravity_amplitude));
    let moves = deck.supports.iter().filter_map(|support| support.motion.as_ref()).any(|motions| {
        let all = [&motions.ux, &motions.uy, &motions.uz, &motions.rx, &motions.ry, &motions.rz];
        all.into_iter().flatten().any(|motion| is_this(&motion.amplitude))
    });
    let drives = deck.joints.iter().any(|joint| {
        joint.motion.as_ref().is_some_and(|motion| is_this(&motion.amplitude))
            || joint.effort.as_ref().is_some_and(|effort| is_this(&effort.amplitude))
    });
    let loads = deck.loads.iter().any(|load| is_this(&load.amplitude));
    shakes && !(weighs || moves || drives || loads)
}

/// The factor from the unit of a record to the units of the deck. `None` if the deck has no `units`. Without `unit`, a `scale` of the amplitude
/// replaces it, and so does a scale of the motion that equals it in three digits. Another scale of the motion multiplies the whole record.
pub fn conversion(deck: &Deck, index: usize, record: &Record) -> Option<f64> {
    let (name, words) = &deck.amplitudes.0[index];
    let (quantity, si) = record.unit.as_ref()?.known?;
    let [length, _, time] = deck.units.as_ref()?.value.scales();
    let is_this = |used: &Use| used.amplitude.as_ref().is_some_and(|own| own.value == name.value);
    let used: Vec<Use> = uses(deck).into_iter().filter(is_this).collect();
    let factor = si * time.powi(quantity.power_of_time()) / length;
    let leaves =
        words.scale.is_none() && !used.iter().any(|used| used.scale.is_some_and(|scale| is_factor(scale, factor)));
    let is_right = used.iter().all(|used| used.quantity == quantity);
    ((leaves || words.unit.is_some()) && is_right && !used.is_empty()).then_some(factor)
}

/// Notes that a record is converted, unless it is in the units of the deck already.
fn note_conversion(deck: &Deck, used: &Use, (file, unit): (&str, &RecordUnit), factor: f64, report: &mut Report) {
    let (Some(units), true) = (&deck.units, factor != 1.0) else { return };
    let besides = used.scale.map_or(String::new(), |scale| format!("; the scale {} is a factor on it", short(scale)));
    let message = format!(
        "the record `{file}` is in {}, and its values are converted to the units {}{besides}",
        unit.name,
        units.label()
    );
    let hint =
        format!("that is `scale = {}`; `scale = 1.0` in the amplitude leaves the numbers unconverted", short(factor));
    report.note(used.place, message, hint);
}

/// Notes that the scale of a motion replaces the conversion by the header.
fn note_scale(deck: &Deck, used: &Use, (words, unit): (&Amplitude, &RecordUnit), report: &mut Report) {
    let (Some(units), Some(scale), None, Some((quantity, si))) = (&deck.units, used.scale, &words.scale, unit.known)
    else {
        return;
    };
    let [length, _, time] = units.value.scales();
    let right = si * time.powi(quantity.power_of_time()) / length;
    if right != 1.0 && is_factor(scale, right) {
        let (scale, label) = (short(scale), units.value.label());
        let message = format!("the scale {scale} converts the record from {} to the units {label}", unit.name);
        let hint = format!(
            "it is no factor on the record then; `unit = \"{}\"` in the amplitude converts the record, and every scale is a factor",
            unit.name.to_lowercase()
        );
        report.note(used.place, message, hint);
    }
}

/// Where a record of this quantity belongs.
fn remedy(quantity: MotionQuantity) -> &'static str {
    match quantity {
        MotionQuantity::Acceleration => "`history = \"acceleration\"` of a support, or `base_acceleration`",
        MotionQuantity::Velocity => "`history = \"velocity\"` of a support",
        MotionQuantity::Displacement => "`history = \"displacement\"` of a support",
    }
}

fn check_factor(deck: &Deck, used: &Use, (file, unit): (&str, &RecordUnit), factor: Option<f64>, report: &mut Report) {
    let in_deck = deck.units.as_ref().zip(unit.known).map(|(units, (quantity, si))| {
        let [length, _, time] = units.value.scales();
        (units.value.label(), si * time.powi(quantity.power_of_time()) / length)
    });
    match (in_deck, factor) {
        (Some((label, right)), _) => {
            let factor_is =
                factor.map_or("no `scale` converts it".to_owned(), |factor| format!("the scale is {}", short(factor)));
            let given = factor.unwrap_or(1.0);
            let hint = format!(
                "in the units {label} the whole record is `scale = {}`; with `unit = \"{}\"` in the amplitude the scale is a factor on the \
                 whole record",
                short(right),
                unit.name.to_lowercase()
            );
            let slack = if factor.is_some() { SCALING } else { 1.001 };
            if !(right / slack..=right * slack).contains(&given) && given != 0.0 {
                let message = format!("the record `{file}` is in {}, and {factor_is}", unit.name);
                report.warn(used.place, message, hint);
            } else if given < WEAK * right && given != 0.0 {
                let message = format!(
                    "the record `{file}` is in {}, and {factor_is}: it acts at {} of its strength",
                    unit.name,
                    to_digits(given / right, 3)
                );
                report.warn(used.place, message, hint);
            }
        }
        (None, None) => {
            let message = format!(
                "the record `{file}` is in {}, and its numbers are taken as they are: nothing says how much that is",
                unit.name
            );
            let hint = match unit.known {
                Some((_, si)) => format!(
                    "`scale = {}` in metres and seconds, {} in millimetres and seconds; 1.0 where the deck has this unit",
                    short(si),
                    short(1e3 * si)
                ),
                None => "`scale` converts it to the units of the deck; 1.0 says that it is in them".to_owned(),
            };
            report.warn(used.place, message, hint);
        }
        (None, Some(_)) => {}
    }
}

fn uses(deck: &Deck) -> Vec<Use<'_>> {
    let ground = deck.environment.iter().flat_map(|environment| &environment.base_acceleration).map(|base| Use {
        amplitude: &base.amplitude,
        quantity: MotionQuantity::Acceleration,
        scale: base.scale.as_ref().map(|scale| scale.value),
        what: "the ground",
        place: &base.span,
    });
    let motions = deck.supports.iter().filter_map(|support| support.motion.as_ref());
    let supports = motions.flat_map(|motions| [&motions.ux, &motions.uy, &motions.uz]).flatten().map(|motion| Use {
        amplitude: &motion.amplitude,
        quantity: of_support(motion),
        scale: motion.scale.as_ref().map(|scale| scale.value),
        what: "the support",
        place: &motion.span,
    });
    let joints = deck.joints.iter().filter_map(|joint| joint.motion.as_ref()).flat_map(|motion| {
        let quantities = [MotionQuantity::Displacement, MotionQuantity::Velocity, MotionQuantity::Acceleration];
        quantities.into_iter().zip([&motion.position, &motion.velocity, &motion.acceleration]).filter_map(
            move |(quantity, value)| {
                let scale = Some(value.as_ref()?.value);
                Some(Use { amplitude: &motion.amplitude, quantity, scale, what: "the joint", place: &motion.span })
            },
        )
    });
    ground.chain(supports).chain(joints).collect()
}

fn of_support(motion: &Motion) -> MotionQuantity {
    match motion.history.as_ref().map_or(History::Displacement, |history| history.value) {
        History::Displacement => MotionQuantity::Displacement,
        History::Velocity => MotionQuantity::Velocity,
        History::Acceleration => MotionQuantity::Acceleration,
    }
}
