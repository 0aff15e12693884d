//! Sections of beams, shells and bars: `*BEAM SECTION`, `*SHELL SECTION`, `*SOLID SECTION` and their kin.

use crate::dialect::Dialect;
use crate::file_content::MaterialCard;
use crate::file_content::{SectionCard, SectionOf, SectionValue};
use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::thin_sections::{self, KeysAndCentroid};
use base::math::Vec3;
use base::text_file::Word;

/// Why the size of a circle is not known.
const CIRCLE: &str =
    "SECTION=CIRC has the radius in Abaqus and the diameter in CalculiX: say --from abaqus or --from calculix";
/// How to say another shape.
const OTHERS: &str = "give its walls by SECTION=ARBITRARY, or its moments by SECTION=GENERAL";

/// Elements and material of a section; refuses what lacks them.
fn section(im: &mut Importer, block: &KeywordBlock) -> Option<SectionCard> {
    let line = block.keyword.line;
    let Some(set) = block.keyword.value("ELSET") else {
        im.refuse(line, &format!("*{} needs ELSET=", block.keyword.name));
        return None;
    };
    let material = block.keyword.value("MATERIAL").unwrap_or_default().to_owned();
    let orientation = block.keyword.value("ORIENTATION").map(str::to_owned);
    Some(SectionCard { line, target: im.set_target(set, line), material, what: SectionOf::Bar(0.0), orientation })
}

/// `*SOLID SECTION`.
pub fn solid(im: &mut Importer, block: &KeywordBlock) {
    let area = block.data.first().and_then(|data| im.number_at(data, 0)).unwrap_or(1.0);
    if let Some(card) = section(im, block) {
        im.sections.push(SectionCard { what: SectionOf::Bar(area), ..card });
    }
}

/// `*SHELL SECTION`.
pub fn shell(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    if block.keyword.has("COMPOSITE") {
        return im.refuse(line, "rdsolve has no layered shells");
    }
    if block.keyword.has("SHELLTHICKNESS") {
        return im.refuse(line, "thickness by a distribution is not translated; give each thickness a section");
    }
    let offset = match block.keyword.value("OFFSET").map(str::to_ascii_uppercase).as_deref() {
        None | Some("MIDDLE") => 0.0,
        Some("SPOS") => 0.5,
        Some("SNEG") => -0.5,
        Some(text) => match text.parse::<f64>() {
            Ok(offset) => offset,
            Err(_) => return im.refuse(line, "OFFSET must be a number, SPOS or SNEG"),
        },
    };
    let nodal = block.keyword.has("NODALTHICKNESS");
    let thickness = block.data.first().and_then(|data| im.number_at(data, 0)).filter(|_| !nodal);
    if thickness.is_none() && !nodal {
        return im.refuse(line, "a shell section needs a thickness on the line below");
    }
    let points = block.data.first().and_then(|data| data.words.get(1)).and_then(|word| word.whole());
    if let Some(card) = section(im, block) {
        im.sections.push(SectionCard { what: SectionOf::Shell { thickness, points, offset }, ..card });
    }
}

/// `*SHELL GENERAL SECTION` with a material and a thickness; stiffnesses are refused.
pub fn general_shell(im: &mut Importer, block: &KeywordBlock) {
    if block.keyword.value("MATERIAL").is_none() {
        return im.refuse(block.keyword.line, "shells have a material and a thickness in rdsolve, not stiffnesses");
    }
    shell(im, block);
}

/// `*NODAL THICKNESS`.
pub fn nodal_thickness(im: &mut Importer, block: &KeywordBlock) {
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let Some(thickness) = im.number_at(data, 1) else { continue };
        let target = im.target(&data.words[0]);
        im.thicknesses.push((target, thickness));
    }
}

/// `*BEAM SECTION`.
pub fn beam(im: &mut Importer, block: &KeywordBlock) {
    read_beam(im, block, false);
}

/// `*BEAM GENERAL SECTION`.
pub fn general_beam(im: &mut Importer, block: &KeywordBlock) {
    read_beam(im, block, true);
}

fn read_beam(im: &mut Importer, block: &KeywordBlock, is_general: bool) {
    let line = block.keyword.line;
    let Some(mut card) = section(im, block) else { return };
    let rows: Vec<Vec<f64>> = block.data.iter().map(|data| im.numbers(data)).collect();
    let word = block.keyword.value("SECTION").unwrap_or("GENERAL").to_ascii_uppercase();
    let word = ["RECT", "CIRC"]
        .iter()
        .find(|short| word.starts_with(**short))
        .map_or(word.clone(), |short| (*short).to_owned());
    let sizes = rows.first().map(Vec::as_slice).unwrap_or_default();
    let found = match &word[..] {
        "HEX" if sizes.len() >= 2 => thin_sections::hexagon(sizes[0], sizes[1]),
        "ARBITRARY" => thin_sections::arbitrary(&rows),
        "TRAPEZOID" if sizes.len() >= 4 => thin_sections::trapezoid(sizes),
        "CHANNEL" | "HAT" if im.dialect == Some(Dialect::Calculix) => {
            Err(format!("CalculiX has no SECTION={word}: give its walls as solids, or say --from abaqus"))
        }
        "CHANNEL" => thin_sections::channel(sizes),
        "HAT" => thin_sections::hat(sizes),
        _ => shape(&word, sizes, im.dialect),
    };
    let (keys, centroid) = match found {
        Ok(found) => found,
        Err(why) => return im.refuse(line, &why),
    };
    say_changes(im, line, &word, sizes);
    let walls = if word == "ARBITRARY" { sizes[0] as usize } else { 1 };
    let n1 = match rows.get(walls).map(Vec::as_slice) {
        Some([x, rest @ ..]) if [*x].iter().chain(rest).any(|x| *x != 0.0) => {
            Vec3::new(*x, rest.first().copied().unwrap_or(0.0), rest.get(1).copied().unwrap_or(0.0))
        }
        _ => Vec3::new(0.0, 0.0, -1.0),
    };
    if let Some(row) = rows.get(2).filter(|_| is_general && card.material.is_empty()) {
        own_material(im, block, &mut card, row);
    }
    let mut read = |name: &str| match block.keyword.value(name) {
        None => 0.0,
        Some(text) => text.parse().unwrap_or_else(|_| {
            im.refuse(line, &format!("{name} must be a number"));
            0.0
        }),
    };
    let shares = [read("OFFSET1"), read("OFFSET2")];
    let ellipse = || (word == "CIRC").then(|| sizes.get(..2)).flatten().map(|axes| [axes[0], axes[1]]);
    let Some(sides) = sides(&keys).or_else(ellipse).or((shares == [0.0; 2]).then_some([0.0; 2])) else {
        return im.refuse(line, "OFFSET1 and OFFSET2 are read of rectangles, boxes, tubes and ellipses alone");
    };
    // The file has the place of the nodes over the axis, the deck that of the axis over the nodes.
    let offset = [0, 1].map(|i| centroid[i] - shares[i] * sides[i]);
    card.what = SectionOf::Beam { keys, n1, offset };
    im.sections.push(card);
}

/// How the sizes of a channel are taken.
const CHANNEL: &str = "the sizes are taken in this order: node over the lower side, height, lower width, upper width, lower thickness, upper \
                       thickness, web, node from the back of the web; flanges point along +1";
/// How the sizes of a hat are taken.
const HAT: &str = "the sizes are taken in this order: node over the lower side, height, lower width, top width, rim width, top thickness, rim \
                   thickness, web thickness";
/// What walls along middle lines leave out.
const MIDDLE_LINES: &str = "walls count along their middle lines, and the shear centre is the centroid";

/// Tells how the deck's section of this shape differs.
fn say_changes(im: &mut Importer, line: usize, word: &str, sizes: &[f64]) {
    let how = match (word, im.dialect) {
        ("GENERAL", Some(Dialect::Calculix)) => {
            "beams bend along both axes; CalculiX 2.20 hardly bends U1 along the second one"
        }
        ("GENERAL", _) => "the shear areas are the area; Abaqus lowers them for slender elements",
        ("BOX", _) if sizes[2] != sizes[4] || sizes[3] != sizes[5] => {
            "the shear centre of a box of unlike walls is its centroid"
        }
        ("ARBITRARY", _) => "the shear centre is the centroid",
        ("CHANNEL", _) if sizes[2] == sizes[3] && sizes[4] == sizes[5] => CHANNEL,
        ("CHANNEL", _) => return im.change(line, &format!("{CHANNEL}; {MIDDLE_LINES}")),
        ("HAT", _) => return im.change(line, &format!("{HAT}; {MIDDLE_LINES}")),
        ("TRAPEZOID", _) => "the torsion constant is A⁴/(40 I), with I about the centroid; the shear centre is there",
        _ => return,
    };
    im.change(line, how);
}

/// Adds the material that a general section has by its own moduli.
fn own_material(im: &mut Importer, block: &KeywordBlock, card: &mut SectionCard, row: &[f64]) {
    let ([modulus, shear, ..], line) = (row, block.keyword.line) else { return };
    let first = format!("{}_material", card.target.name);
    let mut names = std::iter::once(first.clone()).chain((2..).map(|next| format!("{first}_{next}")));
    card.material = names.find(|name| im.materials.find(name).is_none()).unwrap_or(first);
    let text = block.keyword.value("DENSITY");
    let density = text.and_then(|text| Word { bytes: text.as_bytes(), column: 0, line }.fortran_number());
    if text.is_some() && density.is_none() {
        im.refuse(line, "DENSITY must be a number");
    }
    let elastic = Some([*modulus, modulus / (2.0 * shear) - 1.0]);
    let name = card.material.clone();
    im.materials.list.push(MaterialCard { name, line, elastic, density, ..MaterialCard::default() });
}

/// The sides of a section along its first and second axis.
fn sides(keys: &[(&'static str, SectionValue)]) -> Option<[f64; 2]> {
    match keys {
        [
            (_, SectionValue::Word("rectangle" | "box")),
            (_, SectionValue::Number(a)),
            (_, SectionValue::Number(b)),
            ..,
        ] => Some([*a, *b]),
        [(_, SectionValue::Word("circle" | "tube")), (_, SectionValue::Number(radius)), ..] => Some([2.0 * radius; 2]),
        _ => None,
    }
}

/// The keys of a section of beams, and the place of its centroid from the node.
fn shape(word: &str, sizes: &[f64], dialect: Option<Dialect>) -> Result<KeysAndCentroid, String> {
    use SectionValue::{Number, Numbers, Word};
    let needs = |count: usize| match sizes.len() >= count {
        true => Ok(()),
        false => Err(format!("SECTION={word} needs {count} numbers on the line below")),
    };
    let at = |i: usize| Number(sizes[i]);
    let keys = match word {
        "RECT" => {
            // CalculiX takes the first side for a second one that is missing.
            needs(if dialect == Some(Dialect::Calculix) { 1 } else { 2 })?;
            vec![("shape", Word("rectangle")), ("width", at(0)), ("height", at(sizes.len().min(2) - 1))]
        }
        "CIRC" => {
            needs(1)?;
            let radius = match dialect {
                None => return Err(CIRCLE.to_owned()),
                Some(Dialect::Abaqus) => sizes[0],
                Some(Dialect::Calculix) if sizes.get(1).is_some_and(|other| *other != sizes[0]) => {
                    return Ok((ellipse(sizes[0], sizes[1]), [0.0; 2]));
                }
                Some(Dialect::Calculix) => 0.5 * sizes[0],
            };
            vec![("shape", Word("circle")), ("radius", Number(radius))]
        }
        "PIPE" | "THICKPIPE" => {
            needs(2)?;
            vec![("shape", Word("tube")), ("radius", at(0)), ("thickness", at(1))]
        }
        "BOX" => {
            needs(6)?;
            if sizes[2] != sizes[4] || sizes[3] != sizes[5] {
                return thin_sections::box_of_unlike_walls(sizes);
            }
            let walls = Numbers(vec![sizes[2], sizes[3]]);
            vec![("shape", Word("box")), ("width", at(0)), ("height", at(1)), ("thickness", walls)]
        }
        "I" => {
            needs(7)?;
            return Ok(i_section(sizes));
        }
        "L" => {
            needs(4)?;
            let legs = Numbers(vec![sizes[3], sizes[2]]);
            vec![("shape", Word("l")), ("width", at(0)), ("height", at(1)), ("thickness", legs)]
        }
        "GENERAL" => {
            needs(4)?;
            general(sizes, dialect)
        }
        _ => return Err(format!("SECTION={word} is not translated; {OTHERS}")),
    };
    Ok((keys, [0.0; 2]))
}

/// An ellipse with these axes, by its integrals.
fn ellipse(a: f64, b: f64) -> Vec<(&'static str, SectionValue)> {
    use SectionValue::{Number, Numbers, Word};
    let (a, b) = (0.5 * a, 0.5 * b);
    let area = std::f64::consts::PI * a * b;
    let torsion = area * a * a * b * b / (a * a + b * b);
    vec![
        ("shape", Word("general")),
        ("area", Number(area)),
        ("moments", Numbers(vec![0.25 * area * b * b, 0.25 * area * a * a])),
        ("torsion_constant", Number(torsion)),
        ("shear_areas", Numbers(vec![0.9 * area, 0.9 * area])),
    ]
}

/// An I section, whose node lies at some height over its lower edge.
fn i_section(sizes: &[f64]) -> KeysAndCentroid {
    use SectionValue::{Number, Word};
    let [l, height, bottom, top, lower, upper, web] = sizes[..7] else { unreachable!("seven numbers") };
    let middle = height - lower - upper;
    let areas =
        [(bottom * lower, 0.5 * lower), (top * upper, height - 0.5 * upper), (web * middle, lower + 0.5 * middle)];
    let area: f64 = areas.iter().map(|part| part.0).sum();
    let centroid = areas.iter().map(|(area, z)| area * z).sum::<f64>() / area;
    // Pre-processors round the height of the centroid.
    let over = if (l - centroid).abs() > 1e-3 * height { centroid - l } else { 0.0 };
    let keys = vec![
        ("shape", Word("i")),
        ("height", Number(height)),
        ("bottom_width", Number(bottom)),
        ("top_width", Number(top)),
        ("bottom_flange_thickness", Number(lower)),
        ("top_flange_thickness", Number(upper)),
        ("web_thickness", Number(web)),
    ];
    (keys, [0.0, over])
}

/// Area and moments: area, I11, I12, I22, then the torsion constant of Abaqus or the shear factor of CalculiX. I11 of Abaqus bends beams
/// about the first axis. I11 of CalculiX bends them along it.
fn general(sizes: &[f64], dialect: Option<Dialect>) -> Vec<(&'static str, SectionValue)> {
    use SectionValue::{Number, Numbers, Word};
    let fifth = sizes.get(4).copied().filter(|x| *x > 0.0);
    let (moments, torsion, factor) = match dialect {
        Some(Dialect::Calculix) => ([sizes[3], sizes[1]], sizes[1] + sizes[3], fifth.unwrap_or(5.0 / 6.0)),
        _ => ([sizes[1], sizes[3]], fifth.unwrap_or(sizes[1] + sizes[3]), 1.0),
    };
    let mut keys = vec![
        ("shape", Word("general")),
        ("area", Number(sizes[0])),
        ("moments", Numbers(moments.to_vec())),
        ("torsion_constant", Number(torsion)),
        ("shear_areas", Numbers(vec![factor * sizes[0], factor * sizes[0]])),
    ];
    if sizes[2] != 0.0 {
        keys.push(("product_moment", Number(sizes[2])));
    }
    keys
}
