//! Steel profiles by their names: `profile = "IPE 200"` of a section stands for its shape and dimensions.
//!
//! I and H profiles have the nominal dimensions of EN 10365, angles those of EN 10056-1, with root radii. Hollow sections have the radii that EN 10210-2 calculates with, 1.5 and
//! 1.0 times the thickness at the outer and the inner corner. Pipes are given by diameter and thickness. Channels UPN are those of EN 10365.
//! W sections have the dimensions of ASTM A6. HSS have the wall of 0.93 times the nominal one, and radii of 2.0 and 1.0 times it, as AISC 360
//! calculates with them.

use super::Spoiled;
use super::profile_sizes::{UNEQUAL, UPN, W};
use base::diagnostic::{Diagnostic, Span};
use std::fmt::Write;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A rolled profile: its number, then height, width, thickness of the web and of the flange, and root radius, in mm.
type Rolled = (u32, [f64; 5]);

/// IPE: number, then height, width, thickness of the web and of the flange, and root radius, in mm.
const IPE: [Rolled; 18] = [
    (80, [80.0, 46.0, 3.8, 5.2, 5.0]),
    (100, [100.0, 55.0, 4.1, 5.7, 7.0]),
    (120, [120.0, 64.0, 4.4, 6.3, 7.0]),
    (140, [140.0, 73.0, 4.7, 6.9, 7.0]),
    (160, [160.0, 82.0, 5.0, 7.4, 9.0]),
    (180, [180.0, 91.0, 5.3, 8.0, 9.0]),
    (200, [200.0, 100.0, 5.6, 8.5, 12.0]),
    (220, [220.0, 110.0, 5.9, 9.2, 12.0]),
    (240, [240.0, 120.0, 6.2, 9.8, 15.0]),
    (270, [270.0, 135.0, 6.6, 10.2, 15.0]),
    (300, [300.0, 150.0, 7.1, 10.7, 15.0]),
    (330, [330.0, 160.0, 7.5, 11.5, 18.0]),
    (360, [360.0, 170.0, 8.0, 12.7, 18.0]),
    (400, [400.0, 180.0, 8.6, 13.5, 21.0]),
    (450, [450.0, 190.0, 9.4, 14.6, 21.0]),
    (500, [500.0, 200.0, 10.2, 16.0, 21.0]),
    (550, [550.0, 210.0, 11.1, 17.2, 24.0]),
    (600, [600.0, 220.0, 12.0, 19.0, 24.0]),
];

/// HE A: number, then height, width, thickness of the web and of the flange, and root radius, in mm.
const HEA: [Rolled; 24] = [
    (100, [96.0, 100.0, 5.0, 8.0, 12.0]),
    (120, [114.0, 120.0, 5.0, 8.0, 12.0]),
    (140, [133.0, 140.0, 5.5, 8.5, 12.0]),
    (160, [152.0, 160.0, 6.0, 9.0, 15.0]),
    (180, [171.0, 180.0, 6.0, 9.5, 15.0]),
    (200, [190.0, 200.0, 6.5, 10.0, 18.0]),
    (220, [210.0, 220.0, 7.0, 11.0, 18.0]),
    (240, [230.0, 240.0, 7.5, 12.0, 21.0]),
    (260, [250.0, 260.0, 7.5, 12.5, 24.0]),
    (280, [270.0, 280.0, 8.0, 13.0, 24.0]),
    (300, [290.0, 300.0, 8.5, 14.0, 27.0]),
    (320, [310.0, 300.0, 9.0, 15.5, 27.0]),
    (340, [330.0, 300.0, 9.5, 16.5, 27.0]),
    (360, [350.0, 300.0, 10.0, 17.5, 27.0]),
    (400, [390.0, 300.0, 11.0, 19.0, 27.0]),
    (450, [440.0, 300.0, 11.5, 21.0, 27.0]),
    (500, [490.0, 300.0, 12.0, 23.0, 27.0]),
    (550, [540.0, 300.0, 12.5, 24.0, 27.0]),
    (600, [590.0, 300.0, 13.0, 25.0, 27.0]),
    (650, [640.0, 300.0, 13.5, 26.0, 27.0]),
    (700, [690.0, 300.0, 14.5, 27.0, 27.0]),
    (800, [790.0, 300.0, 15.0, 28.0, 30.0]),
    (900, [890.0, 300.0, 16.0, 30.0, 30.0]),
    (1000, [990.0, 300.0, 16.5, 31.0, 30.0]),
];

/// HE B: number, then height, width, thickness of the web and of the flange, and root radius, in mm.
const HEB: [Rolled; 24] = [
    (100, [100.0, 100.0, 6.0, 10.0, 12.0]),
    (120, [120.0, 120.0, 6.5, 11.0, 12.0]),
    (140, [140.0, 140.0, 7.0, 12.0, 12.0]),
    (160, [160.0, 160.0, 8.0, 13.0, 15.0]),
    (180, [180.0, 180.0, 8.5, 14.0, 15.0]),
    (200, [200.0, 200.0, 9.0, 15.0, 18.0]),
    (220, [220.0, 220.0, 9.5, 16.0, 18.0]),
    (240, [240.0, 240.0, 10.0, 17.0, 21.0]),
    (260, [260.0, 260.0, 10.0, 17.5, 24.0]),
    (280, [280.0, 280.0, 10.5, 18.0, 24.0]),
    (300, [300.0, 300.0, 11.0, 19.0, 27.0]),
    (320, [320.0, 300.0, 11.5, 20.5, 27.0]),
    (340, [340.0, 300.0, 12.0, 21.5, 27.0]),
    (360, [360.0, 300.0, 12.5, 22.5, 27.0]),
    (400, [400.0, 300.0, 13.5, 24.0, 27.0]),
    (450, [450.0, 300.0, 14.0, 26.0, 27.0]),
    (500, [500.0, 300.0, 14.5, 28.0, 27.0]),
    (550, [550.0, 300.0, 15.0, 29.0, 27.0]),
    (600, [600.0, 300.0, 15.5, 30.0, 27.0]),
    (650, [650.0, 300.0, 16.0, 31.0, 27.0]),
    (700, [700.0, 300.0, 17.0, 32.0, 27.0]),
    (800, [800.0, 300.0, 17.5, 33.0, 30.0]),
    (900, [900.0, 300.0, 18.5, 35.0, 30.0]),
    (1000, [1000.0, 300.0, 19.0, 36.0, 30.0]),
];

/// Equal angles: leg and thickness in mm, then the radius between the legs.
const L: [[f64; 3]; 13] = [
    [40.0, 4.0, 6.0],
    [50.0, 5.0, 7.0],
    [60.0, 6.0, 8.0],
    [70.0, 7.0, 9.0],
    [75.0, 8.0, 9.0],
    [80.0, 8.0, 10.0],
    [90.0, 9.0, 11.0],
    [100.0, 10.0, 12.0],
    [100.0, 12.0, 12.0],
    [120.0, 12.0, 13.0],
    [150.0, 15.0, 16.0],
    [180.0, 18.0, 18.0],
    [200.0, 20.0, 18.0],
];

/// The families, with the words before or after the number.
const FAMILIES: [(&str, &[Rolled]); 3] = [("IPE", &IPE), ("HEA", &HEA), ("HEB", &HEB)];
/// Millimetres of the units of length of a section.
const UNITS: [(&str, f64); 5] = [("m", 1e-3), ("cm", 0.1), ("mm", 1.0), ("in", 1.0 / 25.4), ("ft", 1.0 / 304.8)];
/// Radii of the corners of hollow sections over their thickness, outside and inside: EN 10210-2, and AISC.
const CORNERS: [f64; 2] = [1.5, 1.0];
const HSS_CORNERS: [f64; 2] = [2.0, 1.0];
/// The wall that AISC calculates with over the nominal one.
const HSS_WALL: f64 = 0.93;
/// Millimetres of an inch.
const INCH: f64 = 25.4;

/// A section that names a profile.
pub struct ProfileWords {
    section: String,
    /// The keys of the shape as TOML, or what is wrong with the name.
    keys: Result<String, [String; 2]>,
    /// The place of the name, and that of the section.
    places: [Span; 2],
}

/// The sections of a deck that name a profile.
pub fn words(root: &DeTable) -> Vec<ProfileWords> {
    let sections = root.get("sections").and_then(|sections| sections.get_ref().as_table());
    let label = root.get("units").and_then(|units| units.get_ref().as_str());
    let mut all = Vec::new();
    for (name, section) in sections.into_iter().flatten() {
        let Some(table) = section.get_ref().as_table() else { continue };
        let Some(profile) = table.get("profile") else { continue };
        // Another type is reported where the section is read.
        let Some(text) = profile.get_ref().as_str() else { continue };
        let unit = table.get("unit").and_then(|unit| unit.get_ref().as_str());
        let millimetre = match (unit, label) {
            (Some(unit), _) => UNITS.iter().find(|(word, _)| *word == unit).map(|(_, millimetre)| *millimetre),
            (None, Some(label)) => Some(if label.starts_with("mm") { 1.0 } else { 1e-3 }),
            (None, None) => None,
        };
        let keys = match millimetre {
            _ if table.contains_key("shape") => {
                Err(["a profile has a shape of its own".to_owned(), "remove `shape`, or `profile`".to_owned()])
            }
            Some(millimetre) => keys_of(text, millimetre),
            None => Err([
                "the unit of length of this profile is not known".to_owned(),
                "give `units` at the top of the deck, or `unit` = \"m\", \"cm\", \"mm\", \"in\" or \"ft\" here"
                    .to_owned(),
            ]),
        };
        let places = [profile.span(), section.span()];
        all.push(ProfileWords { section: name.get_ref().to_string(), keys, places });
    }
    all
}

/// Puts the keys of the shapes in place of the names of profiles. A section whose name is wrong has neither.
pub fn expand<'i>(root: &mut DeTable<'i>, words: &'i [ProfileWords]) -> (Vec<Diagnostic>, Vec<Spoiled>) {
    let (mut problems, mut spoiled) = (Vec::new(), Vec::new());
    let Some(DeValue::Table(sections)) = root.get_mut("sections").map(Spanned::get_mut) else {
        return (problems, spoiled);
    };
    for ProfileWords { section, keys, places: [name, place] } in words {
        let Some(DeValue::Table(table)) = sections.get_mut(section.as_str()).map(Spanned::get_mut) else { continue };
        table.remove("profile");
        table.remove("unit");
        match keys {
            Ok(text) => {
                for (key, value) in DeTable::parse(text).map(Spanned::into_inner).into_iter().flatten() {
                    table.insert(Spanned::new(name.clone(), key.into_inner()), at(name, value.into_inner()));
                }
            }
            Err([message, hint]) => {
                table.remove("shape");
                problems.push(Diagnostic::error(message).at(name).hint(hint));
                spoiled.push(Spoiled { table: Some(place.clone()), key: "shape".to_owned() });
            }
        }
    }
    (problems, spoiled)
}

/// A value with all of its places at the name of the profile.
fn at<'i>(place: &Span, value: DeValue<'i>) -> Spanned<DeValue<'i>> {
    let value = match value {
        DeValue::Array(list) => DeValue::Array(list.into_iter().map(|item| at(place, item.into_inner())).collect()),
        other => other,
    };
    Spanned::new(place.clone(), value)
}

/// A shape with its dimensions in mm.
struct Shape {
    word: &'static str,
    sizes: Vec<(&'static str, f64)>,
    /// Radii of the corners, of a hollow section.
    radii: Option<[f64; 2]>,
    /// Slope of the flanges, of a channel.
    slope: Option<f64>,
}

/// The keys of the shape of a profile, with the length of a millimetre in the unit of the deck.
fn keys_of(text: &str, millimetre: f64) -> Result<String, [String; 2]> {
    let plain: String = text.to_uppercase().replace(['×', '*'], "X").replace(',', ".");
    let plain: String = plain.chars().filter(|c| c.is_ascii_alphanumeric() || ".-/".contains(*c)).collect();
    let letters = plain.find(|c: char| c.is_ascii_digit() || c == '.').unwrap_or(plain.len());
    let (family, rest) = plain.split_at(letters);
    let family = family.trim_end_matches('-');
    let numbers: Option<Vec<f64>> = rest.split('X').map(number).collect();
    let numbers = numbers.unwrap_or_default();
    let shape = match family {
        "CHS" | "PIPE" | "TUBE" => pipe(&numbers),
        "SHS" | "RHS" => hollow(&numbers),
        "L" => angle(&numbers),
        "UPN" | "UNP" => channel(&numbers),
        "W" => wide_flange(&numbers),
        "HSS" => structural_tube(&numbers),
        _ => rolled(family, rest),
    };
    let Shape { word, sizes, radii, slope } =
        shape.map_err(|hint| [format!("there is no profile `{text}` here"), hint])?;
    let mut keys = format!("shape = \"{word}\"\n");
    for (key, value) in sizes {
        // A String takes every character.
        let _ = writeln!(keys, "{key} = {:?}", value * millimetre);
    }
    if let Some(slope) = slope {
        let _ = writeln!(keys, "flange_slope = {slope:?}");
    }
    if let Some([outer, inner]) = radii.map(|radii| radii.map(|radius| radius * millimetre)) {
        let _ = writeln!(keys, "corner_radii = [{outer:?}, {inner:?}]");
    }
    Ok(keys)
}

/// A number, a fraction such as 3/8, or both such as 1-1/4; `None` if it is not above 0.
fn number(text: &str) -> Option<f64> {
    let (whole, part) = text.split_once('-').unwrap_or(("0", text));
    let part = match part.split_once('/') {
        Some((above, below)) => above.parse::<f64>().ok()? / below.parse::<f64>().ok()?,
        None if text.contains('-') => return None,
        None => part.parse().ok()?,
    };
    Some(whole.parse::<f64>().ok()? + part).filter(|x| x.is_finite() && *x > 0.0)
}

fn pipe(numbers: &[f64]) -> Result<Shape, String> {
    let &[diameter, thickness] = numbers else {
        return Err("a pipe is \"CHS 114.3x5\": diameter and thickness in mm".to_owned());
    };
    Ok(Shape { word: "tube", sizes: vec![("diameter", diameter), ("thickness", thickness)], radii: None, slope: None })
}

fn hollow(numbers: &[f64]) -> Result<Shape, String> {
    let [a, b, thickness] = match *numbers {
        [side, thickness] => [side, side, thickness],
        [a, b, thickness] => [a, b, thickness],
        _ => return Err("a hollow section is \"SHS 100x5\" or \"RHS 200x100x8\": sides and thickness in mm".to_owned()),
    };
    let sizes = vec![("height", a.max(b)), ("width", a.min(b)), ("thickness", thickness)];
    Ok(Shape { word: "box", sizes, radii: Some(CORNERS.map(|radius| radius * thickness)), slope: None })
}

fn angle(numbers: &[f64]) -> Result<Shape, String> {
    let size = match *numbers {
        [leg, thickness] => Some([leg, leg, thickness]),
        [a, b, thickness] => Some([a.max(b), a.min(b), thickness]),
        _ => None,
    };
    let equal = L.iter().map(|[leg, thickness, radius]| [*leg, *leg, *thickness, *radius]);
    let mut all = equal.chain(UNEQUAL);
    let known = size.and_then(|size| all.find(|[a, b, thickness, _]| [*a, *b, *thickness] == size));
    let Some([height, width, thickness, radius]) = known else {
        let equal = L.iter().map(|[leg, thickness, _]| format!("{leg}x{thickness}"));
        let unequal = UNEQUAL.iter().map(|[a, b, thickness, _]| format!("{a}x{b}x{thickness}"));
        let known: Vec<String> = equal.chain(unequal).collect();
        return Err(format!("known are the angles {}", known.join(", ")));
    };
    let sizes = vec![("height", height), ("width", width), ("thickness", thickness), ("root_radius", radius)];
    Ok(Shape { word: "l", sizes, radii: None, slope: None })
}

/// Slopes of the flanges are 8 %, with the thickness at half the width, and above 300 mm 5 %, with that at half of what stands out.
fn channel(numbers: &[f64]) -> Result<Shape, String> {
    let known = UPN.iter().find(|(number, _)| *numbers == [f64::from(*number)]);
    let Some((_, [height, width, web, flange, radius])) = known.copied() else {
        let known: Vec<String> = UPN.iter().map(|(number, _)| number.to_string()).collect();
        return Err(format!("UPN has {}", known.join(", ")));
    };
    let (slope, flange) = if height > 300.0 { (0.05, flange + 0.05 * 0.5 * web) } else { (0.08, flange) };
    let mut sizes = vec![("height", height), ("width", width), ("web_thickness", web), ("flange_thickness", flange)];
    sizes.push(("root_radius", radius));
    Ok(Shape { word: "c", sizes, radii: None, slope: Some(slope) })
}

fn wide_flange(numbers: &[f64]) -> Result<Shape, String> {
    let known = W.iter().find(|(name, _)| *numbers == name.map(f64::from));
    let Some((_, size)) = known else {
        let known: Vec<String> = W.iter().map(|([depth, weight], _)| format!("{depth}x{weight}")).collect();
        return Err(format!("W, in inches and pounds per foot, has {}", known.join(", ")));
    };
    Ok(i_shape(size.map(|inches| inches * INCH)))
}

fn structural_tube(numbers: &[f64]) -> Result<Shape, String> {
    // Walls are rounded to 0.001 in, as the tables have them.
    let wall = |nominal: f64| (nominal * HSS_WALL * 1e3).round() / 1e3 * INCH;
    match *numbers {
        [diameter, nominal] => pipe(&[diameter * INCH, wall(nominal)]),
        [a, b, nominal] => {
            let shape = hollow(&[a * INCH, b * INCH, wall(nominal)])?;
            Ok(Shape { radii: Some(HSS_CORNERS.map(|radius| radius * wall(nominal))), ..shape })
        }
        _ => Err("in inches, it is \"HSS 8x4x3/8\": sides and nominal thickness; or \"HSS 6.625x0.280\": diameter and nominal thickness".to_owned()),
    }
}

fn i_shape(size: [f64; 5]) -> Shape {
    let keys = ["height", "width", "web_thickness", "flange_thickness", "root_radius"];
    Shape { word: "i", sizes: keys.into_iter().zip(size).collect(), radii: None, slope: None }
}

fn rolled(family: &str, rest: &str) -> Result<Shape, String> {
    // "HE 200 A" is "HEA 200".
    let (family, number) = match (family, rest.strip_suffix('A'), rest.strip_suffix('B')) {
        ("HE", Some(number), _) => ("HEA", number),
        ("HE", _, Some(number)) => ("HEB", number),
        _ => (family, rest),
    };
    let Some((_, list)) = FAMILIES.iter().find(|(word, _)| *word == family) else {
        return Err("known are IPE, HEA, HEB, UPN, L, W, HSS, CHS, SHS and RHS; of others give `shape` and dimensions"
            .to_owned());
    };
    let Some((_, size)) = list.iter().find(|(known, _)| number.parse() == Ok(*known)) else {
        let known: Vec<String> = list.iter().map(|(number, _)| number.to_string()).collect();
        return Err(format!("{family} has {}", known.join(", ")));
    };
    Ok(i_shape(*size))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The keys of a profile as numbers.
    fn numbers(text: &str) -> Vec<(String, f64)> {
        let keys = keys_of(text, 1.0).unwrap();
        let number = |line: &str| {
            let (key, value) = line.split_once(" = ")?;
            Some((key.to_owned(), value.parse().ok()?))
        };
        keys.lines().filter_map(number).collect()
    }

    #[test]
    fn names_are_read_as_they_are_written() {
        for name in ["IPE 200", "ipe200", "IPE-200", "IPE_200"] {
            assert_eq!(numbers(name)[0], ("height".to_owned(), 200.0), "{name}");
        }
        for name in ["HEB 300", "HE 300 B", "HE300B", "heb300"] {
            assert_eq!(
                numbers(name)[1..3],
                [("width".to_owned(), 300.0), ("web_thickness".to_owned(), 11.0)],
                "{name}"
            );
        }
        assert_eq!(numbers("CHS 114,3 x 5")[0], ("diameter".to_owned(), 114.3));
        assert_eq!(numbers("RHS 100×200×8")[..2], [("height".to_owned(), 200.0), ("width".to_owned(), 100.0)]);
        assert_eq!(numbers("L 100x10")[3], ("root_radius".to_owned(), 12.0));
        assert_eq!(numbers("L100x100x10"), numbers("L 100x10"));
        assert_eq!(numbers("L 65x100x8")[..2], [("height".to_owned(), 100.0), ("width".to_owned(), 65.0)]);
        assert!(keys_of("L 100x65x9", 1.0).unwrap_err()[1].contains("100x65x8"));
        assert_eq!(numbers("UPN 200")[5], ("flange_slope".to_owned(), 0.08));
        assert_eq!(numbers("W14x90"), numbers("W 14 X 90"));
        for name in ["HSS 8x4x3/8", "HSS8X4X.375", "HSS 8x4x0.375"] {
            assert_eq!(numbers(name), numbers("HSS 8x4x0.375"), "{name}");
        }
        assert_eq!(numbers("HSS 6.625x0.280")[1], ("thickness".to_owned(), 0.26 * 25.4));
        assert_eq!(
            [number("1-1/4"), number("3/8"), number("1-2"), number("1/0")],
            [Some(1.25), Some(0.375), None, None]
        );
        assert_eq!(numbers("SHS 100x5")[2], ("thickness".to_owned(), 5.0));
        for (name, hint) in [
            ("IPE 210", "IPE has 80"),
            ("M14x90", "known are"),
            ("W360x134", "in inches"),
            ("UPN 400", "UPN has 80"),
            ("HSS 6", "nominal"),
            ("SHS 100", "sides"),
            ("CHS", "a pipe is"),
            ("HE 300", "known"),
        ] {
            let [message, told] = keys_of(name, 1.0).unwrap_err();
            assert!(message.contains(name) && told.contains(hint), "{name}: {message}, {told}");
        }
        assert!(keys_of("IPE 200", 1e-3).unwrap().contains("height = 0.2\n"));
    }
}
