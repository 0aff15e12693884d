//! Checks lengths for exponents that no computation can hold, because they would end as singular matrices.
//!
//! The key shows whether a number is a length. Areas, moments of area and inertia contain powers of lengths up to the fifth, and their
//! products. Sizes enter differences of coordinates, which have sixteen digits.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use base::diagnostic::{Diagnostic, Span};
use base::math::LARGEST_LENGTH;
use base::names::short;

/// Keys of sizes, which are above zero.
const SIZES: [&str; 14] = [
    "bottom_flange_thickness",
    "bottom_width",
    "diameter",
    "flange_thickness",
    "height",
    "inner_radius",
    "length",
    "radius",
    "size",
    "thickness",
    "top_flange_thickness",
    "top_width",
    "web_thickness",
    "width",
];
/// Keys of coordinates, and of lengths that may be zero or negative.
const PLACES: [&str; 11] = [
    "about",
    "center",
    "ends",
    "free_length",
    "gap",
    "ground",
    "lead",
    "offset_end",
    "offset_start",
    "point",
    "points",
];
/// Keys of powers of sizes.
const POWERS: [(&str, i32); 5] =
    [("area", 2), ("shear_areas", 2), ("moments", 4), ("product_moment", 4), ("torsion_constant", 4)];
/// The tables whose `points` are those of curves: functions of time, forces over elongations.
const OF_CURVES: [&str; 2] = ["amplitudes", "links"];
/// The largest length over the smallest size: a contact or a strain of the smallest has a digit left at the place of the largest.
const LARGEST_RATIO: f64 = 1e15;

/// A length of the deck.
struct Length<'a> {
    key: &'a str,
    place: Span,
    /// In units of length, not negative.
    size: f64,
    /// The number that stands there.
    number: f64,
    is_size: bool,
}

/// Faulty lengths of a deck, with the places of the numbers.
pub(super) fn check(root: &DeTable) -> Vec<(Span, Diagnostic)> {
    let mut lengths = Vec::new();
    for (key, value) in root {
        let first = lengths.len();
        collect(key.get_ref(), value, &mut lengths);
        if OF_CURVES.contains(&key.get_ref().as_ref()) {
            let places = lengths.split_off(first);
            lengths.extend(places.into_iter().filter(|length: &Length| length.key != "points"));
        }
    }
    let (beyond, within): (Vec<Length>, Vec<Length>) =
        lengths.into_iter().partition(|length| length.size > LARGEST_LENGTH);
    let mut wrong: Vec<(Span, Diagnostic)> = beyond.into_iter().map(|length| too_large(&length)).collect();
    let largest = within.iter().max_by(|a, b| a.size.total_cmp(&b.size));
    let sizes = within.iter().filter(|length| length.is_size && length.size > 0.0);
    if let (Some(largest), Some(least)) = (largest, sizes.min_by(|a, b| a.size.total_cmp(&b.size)))
        && largest.size > LARGEST_RATIO * least.size
    {
        wrong.push(too_far_apart(largest, least));
    }
    wrong
}

fn collect<'a>(key: &'a str, value: &'a Spanned<DeValue>, lengths: &mut Vec<Length<'a>>) {
    match value.get_ref() {
        DeValue::Float(number) => lengths.extend(length(key, value.span(), number.as_str().parse().ok())),
        DeValue::Integer(number) => lengths.extend(length(key, value.span(), number.as_str().parse().ok())),
        DeValue::Array(list) => list.iter().for_each(|item| collect(key, item, lengths)),
        // `points` holds coordinates by name; keys of other tables have their own meaning.
        DeValue::Table(table) if key == "points" => table.values().for_each(|item| collect(key, item, lengths)),
        DeValue::Table(table) => table.iter().for_each(|(key, item)| collect(key.get_ref(), item, lengths)),
        _ => {}
    }
}

/// The length that stands under a key; `None` for other numbers.
fn length(key: &str, place: Span, number: Option<f64>) -> Option<Length<'_>> {
    let number = number.filter(|number| number.is_finite())?;
    let power = POWERS.iter().find(|(word, _)| *word == key).map(|(_, power)| *power);
    let is_size = SIZES.contains(&key);
    let power = power.or((is_size || PLACES.contains(&key)).then_some(1))?;
    Some(Length { key, place, size: number.abs().powf(1.0 / f64::from(power)), number, is_size })
}

fn too_large(length: &Length) -> (Span, Diagnostic) {
    let message = format!(
        "`{}` must not be {}: no length may be above {}",
        length.key,
        short(length.number),
        short(LARGEST_LENGTH)
    );
    let problem = Diagnostic::error(message)
        .hint("look at the exponent")
        .hint("volumes and moments are powers of lengths, and these would leave the range of numbers");
    (length.place.clone(), problem)
}

fn too_far_apart(largest: &Length, least: &Length) -> (Span, Diagnostic) {
    let message = format!(
        "`{}` of {} and `{}` of {} do not go together",
        largest.key,
        short(largest.number),
        least.key,
        short(least.number)
    );
    let problem = Diagnostic::error(message).hint("look at the exponents").hint(format!(
        "numbers have sixteen digits: beside lengths of {} nothing of the size {} is left of differences of coordinates",
        short(largest.size),
        short(least.size)
    ));
    (largest.place.clone(), problem)
}
