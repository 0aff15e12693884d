//! `[sections.x]`, of the material of a beam: section stiffnesses, and fibres where it yields.

use super::data::MassKind;
use super::materials::Materials;
use super::report::{Owner, Report};
use super::values::span;
use crate::deck::Deck;
use crate::deck::beams::Beam;
use crate::deck::sections as words;
use crate::deck::words::{Maybe, Named, Numbers, Table};
use crate::diagnostic::{At, Span};
use crate::sections::{Fibre, Shape, Stiffness};
use std::collections::HashMap;

/// Beyond this a section's answer no longer changes.
const MOST_FIBRES: usize = 10_000;

/// The sections of a deck, and the stiffnesses that beams have asked of them so far.
pub(super) struct Sections<'a, 'd> {
    table: &'d Named<Table<words::Section>>,
    materials: &'a Materials<'d>,
    /// Section, material and whether it needs a mass → index in `stiffnesses`, none where there are errors.
    known: HashMap<(usize, Option<usize>, bool), Option<usize>>,
    pub stiffnesses: Vec<Stiffness>,
}

impl<'a, 'd> Sections<'a, 'd> {
    pub fn new(deck: &'d Deck, materials: &'a Materials<'d>) -> Self {
        Sections { table: &deck.sections, materials, known: HashMap::new(), stiffnesses: Vec::new() }
    }

    /// Fibres of a beam's section, which is sound.
    pub fn fibres(&self, beam: &'d Beam, report: &mut Report<'d>) -> Option<Vec<Fibre>> {
        let name = beam.section.as_ref()?;
        let (_, section) = report.find("section", self.table, name)?;
        let owner = Owner::new(format!("section `{}`", name.value), &section.span);
        let counts = section.fibres.as_ref();
        let numbers: Vec<usize> = counts.iter().flat_map(|c| &c.value.values).map(|n| n.value as usize).collect();
        if let Some(counts) = counts
            && numbers.iter().try_fold(1usize, |all, &n| all.checked_mul(n)).is_none_or(|all| all > MOST_FIBRES)
        {
            return report
                .error(&counts.span, format!("more than {MOST_FIBRES} fibres are taken for a slip of the keyboard"));
        }
        match read_shape(&owner, section, section.shape.as_ref()?.value, report)?.fibres(&numbers) {
            Ok(fibres) => Some(fibres),
            Err(reason) => {
                report.error(counts.map_or(&name.span, |counts| &counts.span), format!("{}: {reason}", owner.what))
            }
        }
    }

    /// Index of the stiffness of a beam's section and material.
    pub fn beam_section(
        &mut self,
        owner: &Owner<'d>,
        beam: &'d Beam,
        mass: MassKind,
        report: &mut Report<'d>,
    ) -> Option<usize> {
        let material = match &beam.material {
            Some(name) => Some((name, self.materials.find(name, report)?)),
            None => None,
        };
        let name = report.require(owner, "section", &beam.section)?;
        let (section_index, section) = report.find("section", self.table, name)?;
        let direct = is_direct(section);
        if direct && let Some((name, _)) = &material {
            let message = format!(
                "section `{}` gives stiffnesses, so {} takes no material",
                beam.section.as_ref()?.value,
                owner.what
            );
            return report.error(&name.span, message);
        }
        let material = if direct { None } else { Some(material) };
        let (material_index, numbers) = match material {
            None => (None, [0.0; 3]),
            Some(None) => {
                report.require(owner, "material", &beam.material)?;
                return None;
            }
            Some(Some((name, (index, material)))) => {
                let density = self.materials.density(name, material, mass, &owner.what, report);
                let what = format!("material `{}`, of which {} is made,", name.value, owner.what);
                let ratio = report.require(&Owner::new(what, &material.span), "poisson_ratio", &material.poisson_ratio);
                (Some(index), [material.youngs_modulus.as_ref()?.value, ratio?.value, density?])
            }
        };
        let needs_mass = self.materials.needs_mass(mass);
        let key = (section_index, material_index, needs_mass);
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let stiffness = stiffness(&name.value, section, numbers, needs_mass, report);
        let index = stiffness.map(|stiffness| {
            self.stiffnesses.push(stiffness);
            self.stiffnesses.len() - 1
        });
        self.known.insert(key, index);
        index
    }
}

fn stiffness<'d>(
    name: &str,
    section: &'d At<Table<words::Section>>,
    [modulus, ratio, density]: [f64; 3],
    needs_mass: bool,
    report: &mut Report<'d>,
) -> Option<Stiffness> {
    let owner = Owner::new(format!("section `{name}`"), &section.span);
    if is_direct(section) {
        return direct(&owner, section, needs_mass, report);
    }
    let shape = report.require(&owner, "shape", &section.shape)?;
    let taken = taken(shape.value);
    let unused: Vec<(&str, Option<&Span>)> =
        keys(section).into_iter().filter(|(key, _)| !taken.contains(key)).collect();
    report.reject_unused(&format!("a section of shape \"{}\"", word(shape.value)), &unused);
    match read_shape(&owner, section, shape.value, report)?.section() {
        Ok(made) => Some(made.stiffness(modulus, ratio, density)),
        Err(reason) => report.error(&shape.span, format!("{}: {reason}", owner.what)),
    }
}

fn read_shape<'d>(
    owner: &Owner<'d>,
    section: &'d words::Section,
    shape: words::Shape,
    report: &mut Report<'d>,
) -> Option<Shape> {
    use words::Shape as Word;
    let s = section;
    if let Some(walls) = &s.thickness {
        let most = if matches!(shape, Word::Box | Word::L) { 2 } else { 1 };
        if walls.values.is_empty() || walls.values.len() > most {
            let message = format!("`thickness` has {} values here; it takes {most}", walls.values.len());
            return report.error(&walls.span, message);
        }
        for wall in &walls.values {
            report.positive("thickness", &Some(wall.clone()))?;
        }
    }
    match shape {
        Word::Rectangle => {
            let width = report.require_positive(owner, "width", &s.width);
            let height = report.require_positive(owner, "height", &s.height);
            Some(Shape::Rectangle { width: width?, height: height? })
        }
        Word::Tube => {
            let radius = match (&s.radius, &s.diameter) {
                (Some(_), Some(diameter)) => {
                    return report.error(&diameter.span, "a tube takes `radius` or `diameter`, not both");
                }
                (None, Some(_)) => report.positive("diameter", &s.diameter).map(|diameter| 0.5 * diameter),
                _ => report.require_positive(owner, "radius", &s.radius),
            };
            let walls = report.require(owner, "thickness", &s.thickness)?;
            Some(Shape::Tube { radius: radius?, thickness: walls.values[0].value })
        }
        Word::Box | Word::L => {
            let width = report.require_positive(owner, "width", &s.width);
            let height = report.require_positive(owner, "height", &s.height);
            let walls = &report.require(owner, "thickness", &s.thickness)?.values;
            let (width, height, first, second) = (width?, height?, walls.first()?.value, walls.last()?.value);
            Some(match shape {
                Word::Box => Shape::Box { width, height, web: first, flange: second },
                _ => Shape::L { height, width, vertical: first, horizontal: second },
            })
        }
        Word::I => {
            let height = report.require_positive(owner, "height", &s.height);
            let web = report.require_positive(owner, "web_thickness", &s.web_thickness);
            let widths =
                pair(owner, ["width", "top_width", "bottom_width"], [&s.width, &s.top_width, &s.bottom_width], report);
            let flanges = pair(
                owner,
                ["flange_thickness", "top_flange_thickness", "bottom_flange_thickness"],
                [&s.flange_thickness, &s.top_flange_thickness, &s.bottom_flange_thickness],
                report,
            );
            let ([top_width, bottom_width], [top_flange, bottom_flange]) = (widths?, flanges?);
            Some(Shape::I { height: height?, top_width, bottom_width, web: web?, top_flange, bottom_flange })
        }
        Word::C => {
            let height = report.require_positive(owner, "height", &s.height);
            let width = report.require_positive(owner, "width", &s.width);
            let web = report.require_positive(owner, "web_thickness", &s.web_thickness);
            let flange = report.require_positive(owner, "flange_thickness", &s.flange_thickness);
            Some(Shape::C { height: height?, width: width?, web: web?, flange: flange? })
        }
        Word::General => {
            let area = report.require_positive(owner, "area", &s.area);
            let moments = both_positive(owner, "moments", &s.moments, report);
            let torsion = report.require_positive(owner, "torsion_constant", &s.torsion_constant);
            let shear = both_positive(owner, "shear_areas", &s.shear_areas, report);
            let product = s.product_moment.as_ref().map_or(0.0, |product| product.value);
            let moments = moments?;
            if product * product >= moments[0] * moments[1] {
                let place = &s.product_moment.as_ref()?.span;
                return report.error(place, "`product_moment` is larger than the moments allow");
            }
            Some(Shape::General { area: area?, moments, Iyz: product, torsion: torsion?, shear_areas: shear? })
        }
    }
}

/// Stiffnesses as given; masses may be left out where nothing needs them.
fn direct<'d>(
    owner: &Owner<'d>,
    s: &'d words::Section,
    needs_mass: bool,
    report: &mut Report<'d>,
) -> Option<Stiffness> {
    if let Some(shape) = report.require(owner, "shape", &s.shape)
        && shape.value != words::Shape::General
    {
        report.error::<()>(&shape.span, "stiffnesses can be given only to a section of shape \"general\"");
    }
    let unused: Vec<(&str, Option<&Span>)> = keys(s).into_iter().filter(|(key, _)| !DIRECT.contains(key)).collect();
    report.reject_unused("a section that gives its stiffnesses", &unused);
    let axial = report.require_positive(owner, "axial_stiffness", &s.axial_stiffness);
    let shear = both_positive(owner, "shear_stiffness", &s.shear_stiffness, report);
    let torsion = report.require_positive(owner, "torsional_stiffness", &s.torsional_stiffness);
    let bending = both_positive(owner, "bending_stiffness", &s.bending_stiffness, report);
    if needs_mass {
        report.require(owner, "mass_per_length", &s.mass_per_length);
        report.require(owner, "inertia_per_length", &s.inertia_per_length);
    }
    let mass = report.not_negative("mass_per_length", &s.mass_per_length, 0.0);
    let inertia = s.inertia_per_length.as_ref().map_or([0.0; 3], |inertia| inertia.value.0);
    if let Some(place) = &s.inertia_per_length
        && inertia.iter().any(|&j| j < 0.0)
    {
        return report.error(&place.span, "`inertia_per_length` must not be negative");
    }
    Some(Stiffness::general(axial?, shear?, torsion?, bending?, mass, inertia))
}

/// One value for both flanges, or one for each.
fn pair<'d>(
    owner: &Owner<'d>,
    names: [&str; 3],
    values: [&'d Maybe<f64>; 3],
    report: &mut Report<'d>,
) -> Option<[f64; 2]> {
    let [both, top, bottom] = values;
    if both.is_some() {
        let what = format!("a section with `{}`", names[0]);
        report.reject_unused(&what, &[(names[1], span(top)), (names[2], span(bottom))]);
        return report.positive(names[0], both).map(|value| [value, value]);
    }
    if top.is_none() && bottom.is_none() {
        report.require(owner, names[0], both)?;
    }
    let top = report.require_positive(owner, names[1], top);
    let bottom = report.require_positive(owner, names[2], bottom);
    Some([top?, bottom?])
}

fn both_positive<'d>(
    owner: &Owner<'d>,
    key: &str,
    value: &'d Maybe<Numbers<2>>,
    report: &mut Report<'d>,
) -> Option<[f64; 2]> {
    let value = report.require(owner, key, value)?;
    if value.value.0.iter().all(|&number| number > 0.0) {
        return Some(value.value.0);
    }
    report.error(&value.span, format!("both values of `{key}` must be above zero"))
}

const DIRECT: [&str; 6] = [
    "axial_stiffness",
    "shear_stiffness",
    "torsional_stiffness",
    "bending_stiffness",
    "mass_per_length",
    "inertia_per_length",
];

/// Whether a section gives its stiffnesses itself.
fn is_direct(section: &words::Section) -> bool {
    keys(section).iter().any(|(key, place)| place.is_some() && DIRECT.contains(key))
}

fn keys(s: &words::Section) -> [(&'static str, Option<&Span>); 23] {
    [
        ("width", span(&s.width)),
        ("height", span(&s.height)),
        ("radius", span(&s.radius)),
        ("diameter", span(&s.diameter)),
        ("thickness", span(&s.thickness)),
        ("top_width", span(&s.top_width)),
        ("bottom_width", span(&s.bottom_width)),
        ("web_thickness", span(&s.web_thickness)),
        ("flange_thickness", span(&s.flange_thickness)),
        ("top_flange_thickness", span(&s.top_flange_thickness)),
        ("bottom_flange_thickness", span(&s.bottom_flange_thickness)),
        ("fibres", span(&s.fibres)),
        ("area", span(&s.area)),
        ("moments", span(&s.moments)),
        ("product_moment", span(&s.product_moment)),
        ("torsion_constant", span(&s.torsion_constant)),
        ("shear_areas", span(&s.shear_areas)),
        ("axial_stiffness", span(&s.axial_stiffness)),
        ("shear_stiffness", span(&s.shear_stiffness)),
        ("torsional_stiffness", span(&s.torsional_stiffness)),
        ("bending_stiffness", span(&s.bending_stiffness)),
        ("mass_per_length", span(&s.mass_per_length)),
        ("inertia_per_length", span(&s.inertia_per_length)),
    ]
}

fn taken(shape: words::Shape) -> &'static [&'static str] {
    use words::Shape;
    match shape {
        Shape::Rectangle => &["width", "height", "fibres"],
        Shape::Tube => &["radius", "diameter", "thickness", "fibres"],
        Shape::Box | Shape::L => &["width", "height", "thickness", "fibres"],
        Shape::I => &[
            "width",
            "height",
            "top_width",
            "bottom_width",
            "web_thickness",
            "flange_thickness",
            "top_flange_thickness",
            "bottom_flange_thickness",
            "fibres",
        ],
        Shape::C => &["width", "height", "web_thickness", "flange_thickness", "fibres"],
        Shape::General => &["area", "moments", "product_moment", "torsion_constant", "shear_areas"],
    }
}

fn word(shape: words::Shape) -> &'static str {
    use words::Shape;
    match shape {
        Shape::Rectangle => "rectangle",
        Shape::Tube => "tube",
        Shape::Box => "box",
        Shape::I => "i",
        Shape::C => "c",
        Shape::L => "l",
        Shape::General => "general",
    }
}
