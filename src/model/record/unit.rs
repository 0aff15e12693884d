//! The units that headers of records name.

/// The quantity of a motion that a record gives over time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionQuantity {
    /// A length.
    Displacement,
    /// A length per time.
    Velocity,
    /// A length per time squared.
    Acceleration,
}

impl MotionQuantity {
    /// The word of the field for it.
    pub fn word(self) -> &'static str {
        match self {
            MotionQuantity::Displacement => "displacements",
            MotionQuantity::Velocity => "velocities",
            MotionQuantity::Acceleration => "accelerations",
        }
    }

    /// The exponent of time in the denominator of the unit.
    pub fn power_of_time(self) -> i32 {
        match self {
            MotionQuantity::Displacement => 0,
            MotionQuantity::Velocity => 1,
            MotionQuantity::Acceleration => 2,
        }
    }
}

/// The unit that the header of a record names. The values are not converted.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordUnit {
    /// The unit as the file writes it.
    pub name: String,
    /// The quantity and the unit in metres and seconds; `None` for a unit that is not known here.
    pub known: Option<(MotionQuantity, f64)>,
}

/// Standard gravity, in m/s².
const G: f64 = 9.80665;

impl RecordUnit {
    /// The unit of this name.
    pub fn new(name: &str) -> RecordUnit {
        RecordUnit { name: name.to_owned(), known: known(&name.to_ascii_uppercase()) }
    }
}

/// True for a unit of a motion or of time.
pub fn is_unit(name: &str) -> bool {
    known(&name.to_ascii_uppercase()).is_some() || seconds_of(name).is_some()
}

/// The seconds of a unit of time, as the head of a column names it.
pub fn seconds_of(name: &str) -> Option<f64> {
    let name = name.trim_end_matches('.').to_ascii_uppercase();
    // One name has no plural: "S" is a second.
    let singular = name.strip_suffix('S').unwrap_or(&name);
    TIMES.iter().find(|(names, _)| names.contains(&singular) || names.contains(&&*name)).map(|(_, seconds)| *seconds)
}

/// The word for a unit of time of so many seconds.
pub fn word_of_time(seconds: f64) -> &'static str {
    TIMES.iter().find(|(_, own)| *own == seconds).map_or("another unit", |(names, _)| names[0])
}

/// Names of units of time in the singular, and their seconds.
const TIMES: [(&[&str], f64); 6] = [
    (&["seconds", "S", "SEC", "SECOND"], 1.0),
    (&["milliseconds", "MS", "MSEC", "MILLISEC", "MILLISECOND"], 1e-3),
    (&["microseconds", "US", "USEC", "\u{b5}S", "\u{3bc}S", "MICROSEC", "MICROSECOND"], 1e-6),
    (&["nanoseconds", "NS", "NSEC", "NANOSECOND"], 1e-9),
    (&["minutes", "MIN", "MINUTE"], 60.0),
    (&["hours", "H", "HR", "HOUR"], 3600.0),
];

fn known(name: &str) -> Option<(MotionQuantity, f64)> {
    let name = &name.replace('²', "2").replace(['⁻', '−'], "-");
    match name.as_str() {
        "G" | "G'S" | "GS" => return Some((MotionQuantity::Acceleration, G)),
        "MG" => return Some((MotionQuantity::Acceleration, 1e-3 * G)),
        "%G" => return Some((MotionQuantity::Acceleration, 0.01 * G)),
        "GAL" | "GALS" => return Some((MotionQuantity::Acceleration, 0.01)),
        _ => {}
    }
    // As m/s2 or as a product, m s-2.
    let product = || name.split_once([' ', '·', '*', '.']).filter(|(_, per)| per.contains('-'));
    let (length, per) = name.split_once('/').or_else(product).unwrap_or((name, ""));
    let length = match length {
        "M" => 1.0,
        "CM" => 0.01,
        "MM" => 1e-3,
        "IN" => 0.0254,
        "FT" => 0.3048,
        _ => return None,
    };
    let quantity = match per.replace("SEC", "S").replace(['*', '^', '-'], "").as_str() {
        "" => MotionQuantity::Displacement,
        "S" => MotionQuantity::Velocity,
        "S2" | "S/S" => MotionQuantity::Acceleration,
        _ => return None,
    };
    Some((quantity, length))
}
