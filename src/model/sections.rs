//! `[sections.x]`, of the material of a beam: section stiffnesses, and fibres where it yields.

use super::MassKind;
use super::build::{Builder, Owner, span};
use crate::deck::beams::Beam;
use crate::deck::sections as deck;
use crate::deck::words::{Maybe, Numbers, Table};
use crate::diagnostic::{At, Span};
use crate::sections::{Fibre, Shape, Stiffness};

/// Beyond this a section's answer no longer changes.
const MOST_FIBRES: usize = 10_000;

impl<'d> Builder<'d> {
    /// Fibres of a beam's section, which is sound.
    pub fn fibres(&mut self, beam: &'d Beam) -> Option<Vec<Fibre>> {
        let name = beam.section.as_ref()?;
        let (_, section) = self.find("section", &self.deck.sections, name)?;
        let owner = Owner { what: format!("section `{}`", name.value), span: &section.span };
        let counts = section.fibres.as_ref();
        let numbers: Vec<usize> = counts.iter().flat_map(|c| &c.value.values).map(|n| n.value as usize).collect();
        if let Some(counts) = counts
            && numbers.iter().try_fold(1usize, |all, &n| all.checked_mul(n)).is_none_or(|all| all > MOST_FIBRES)
        {
            return self
                .error(&counts.span, format!("more than {MOST_FIBRES} fibres are taken for a slip of the keyboard"));
        }
        match self.shape(&owner, section, section.shape.as_ref()?.value)?.fibres(&numbers) {
            Ok(fibres) => Some(fibres),
            Err(reason) => {
                self.error(counts.map_or(&name.span, |counts| &counts.span), format!("{}: {reason}", owner.what))
            }
        }
    }

    /// Index of the stiffness of a beam's section and material.
    pub fn beam_section(&mut self, owner: &Owner<'d>, beam: &'d Beam, mass: MassKind) -> Option<usize> {
        let material = match &beam.material {
            Some(name) => Some((name, self.find("material", &self.deck.materials, name)?)),
            None => None,
        };
        let name = self.need(owner, "section", &beam.section)?;
        let (section_index, section) = self.find("section", &self.deck.sections, name)?;
        let direct = is_direct(section);
        if direct && let Some((name, _)) = &material {
            let message = format!(
                "section `{}` gives stiffnesses, so {} takes no material",
                beam.section.as_ref()?.value,
                owner.what
            );
            return self.error(&name.span, message);
        }
        let material = if direct { None } else { Some(material) };
        let (material_index, numbers) = match material {
            None => (None, [0.0; 3]),
            Some(None) => {
                self.need(owner, "material", &beam.material)?;
                return None;
            }
            Some(Some((name, (index, material)))) => {
                let density = self.density(name, material, mass, &owner.what);
                let what = format!("material `{}`, of which {} is made,", name.value, owner.what);
                let ratio = self.need(&Owner { what, span: &material.span }, "poisson_ratio", &material.poisson_ratio);
                (Some(index), [material.youngs_modulus.as_ref()?.value, ratio?.value, density?])
            }
        };
        let heavy = self.needs_mass(mass);
        let key = (section_index, material_index, heavy);
        if let Some(known) = self.stiffnesses.get(&key) {
            return *known;
        }
        let stiffness = self.stiffness(&name.value, section, numbers, heavy);
        let index = stiffness.map(|stiffness| {
            self.model.stiffnesses.push(stiffness);
            self.model.stiffnesses.len() - 1
        });
        self.stiffnesses.insert(key, index);
        index
    }

    fn stiffness(
        &mut self,
        name: &str,
        section: &'d At<Table<deck::Section>>,
        [modulus, ratio, density]: [f64; 3],
        heavy: bool,
    ) -> Option<Stiffness> {
        let owner = Owner { what: format!("section `{name}`"), span: &section.span };
        if is_direct(section) {
            return self.direct(&owner, section, heavy);
        }
        let shape = self.need(&owner, "shape", &section.shape)?;
        let taken = taken(shape.value);
        let stray: Vec<(&str, Option<&Span>)> =
            keys(section).into_iter().filter(|(key, _)| !taken.contains(key)).collect();
        self.stray(&format!("a section of shape \"{}\"", word(shape.value)), &stray);
        match self.shape(&owner, section, shape.value)?.section() {
            Ok(made) => Some(made.stiffness(modulus, ratio, density)),
            Err(reason) => self.error(&shape.span, format!("{}: {reason}", owner.what)),
        }
    }

    fn shape(&mut self, owner: &Owner<'d>, section: &'d deck::Section, shape: deck::Shape) -> Option<Shape> {
        use deck::Shape as Word;
        let s = section;
        if let Some(walls) = &s.thickness {
            let most = if matches!(shape, Word::Box | Word::L) { 2 } else { 1 };
            if walls.values.is_empty() || walls.values.len() > most {
                let message = format!("`thickness` has {} values here; it takes {most}", walls.values.len());
                return self.error(&walls.span, message);
            }
            for wall in &walls.values {
                self.positive("thickness", &Some(wall.clone()))?;
            }
        }
        match shape {
            Word::Rectangle => {
                let width = self.need_positive(owner, "width", &s.width);
                let height = self.need_positive(owner, "height", &s.height);
                Some(Shape::Rectangle { width: width?, height: height? })
            }
            Word::Tube => {
                let radius = match (&s.radius, &s.diameter) {
                    (Some(_), Some(diameter)) => {
                        return self.error(&diameter.span, "a tube takes `radius` or `diameter`, not both");
                    }
                    (None, Some(_)) => self.positive("diameter", &s.diameter).map(|diameter| 0.5 * diameter),
                    _ => self.need_positive(owner, "radius", &s.radius),
                };
                let walls = self.need(owner, "thickness", &s.thickness)?;
                Some(Shape::Tube { radius: radius?, thickness: walls.values[0].value })
            }
            Word::Box | Word::L => {
                let width = self.need_positive(owner, "width", &s.width);
                let height = self.need_positive(owner, "height", &s.height);
                let walls = &self.need(owner, "thickness", &s.thickness)?.values;
                let (width, height, first, second) = (width?, height?, walls.first()?.value, walls.last()?.value);
                Some(match shape {
                    Word::Box => Shape::Box { width, height, web: first, flange: second },
                    _ => Shape::L { height, width, vertical: first, horizontal: second },
                })
            }
            Word::I => {
                let height = self.need_positive(owner, "height", &s.height);
                let web = self.need_positive(owner, "web_thickness", &s.web_thickness);
                let widths =
                    self.pair(owner, ["width", "top_width", "bottom_width"], [&s.width, &s.top_width, &s.bottom_width]);
                let flanges = self.pair(
                    owner,
                    ["flange_thickness", "top_flange_thickness", "bottom_flange_thickness"],
                    [&s.flange_thickness, &s.top_flange_thickness, &s.bottom_flange_thickness],
                );
                let ([top_width, bottom_width], [top_flange, bottom_flange]) = (widths?, flanges?);
                Some(Shape::I { height: height?, top_width, bottom_width, web: web?, top_flange, bottom_flange })
            }
            Word::C => {
                let height = self.need_positive(owner, "height", &s.height);
                let width = self.need_positive(owner, "width", &s.width);
                let web = self.need_positive(owner, "web_thickness", &s.web_thickness);
                let flange = self.need_positive(owner, "flange_thickness", &s.flange_thickness);
                Some(Shape::C { height: height?, width: width?, web: web?, flange: flange? })
            }
            Word::General => {
                let area = self.need_positive(owner, "area", &s.area);
                let moments = self.both_positive(owner, "moments", &s.moments);
                let torsion = self.need_positive(owner, "torsion_constant", &s.torsion_constant);
                let shear = self.both_positive(owner, "shear_areas", &s.shear_areas);
                let product = s.product_moment.as_ref().map_or(0.0, |product| product.value);
                let moments = moments?;
                if product * product >= moments[0] * moments[1] {
                    let place = &s.product_moment.as_ref()?.span;
                    return self.error(place, "`product_moment` is larger than the moments allow");
                }
                Some(Shape::General { area: area?, moments, Iyz: product, torsion: torsion?, shear_areas: shear? })
            }
        }
    }

    /// Stiffnesses as given; masses may be left out where nothing needs them.
    fn direct(&mut self, owner: &Owner<'d>, s: &'d deck::Section, heavy: bool) -> Option<Stiffness> {
        if let Some(shape) = self.need(owner, "shape", &s.shape)
            && shape.value != deck::Shape::General
        {
            self.error::<()>(&shape.span, "stiffnesses can be given only to a section of shape \"general\"");
        }
        let stray: Vec<(&str, Option<&Span>)> = keys(s).into_iter().filter(|(key, _)| !DIRECT.contains(key)).collect();
        self.stray("a section that gives its stiffnesses", &stray);
        let axial = self.need_positive(owner, "axial_stiffness", &s.axial_stiffness);
        let shear = self.both_positive(owner, "shear_stiffness", &s.shear_stiffness);
        let torsion = self.need_positive(owner, "torsional_stiffness", &s.torsional_stiffness);
        let bending = self.both_positive(owner, "bending_stiffness", &s.bending_stiffness);
        if heavy {
            self.need(owner, "mass_per_length", &s.mass_per_length);
            self.need(owner, "inertia_per_length", &s.inertia_per_length);
        }
        let mass = self.not_negative("mass_per_length", &s.mass_per_length, 0.0);
        let inertia = s.inertia_per_length.as_ref().map_or([0.0; 3], |inertia| inertia.value.0);
        if let Some(place) = &s.inertia_per_length
            && inertia.iter().any(|&j| j < 0.0)
        {
            return self.error(&place.span, "`inertia_per_length` must not be negative");
        }
        Some(Stiffness::general(axial?, shear?, torsion?, bending?, mass, inertia))
    }

    /// One value for both flanges, or one for each.
    fn pair(&mut self, owner: &Owner<'d>, names: [&str; 3], values: [&'d Maybe<f64>; 3]) -> Option<[f64; 2]> {
        let [both, top, bottom] = values;
        if both.is_some() {
            let what = format!("a section with `{}`", names[0]);
            self.stray(&what, &[(names[1], span(top)), (names[2], span(bottom))]);
            return self.positive(names[0], both).map(|value| [value, value]);
        }
        if top.is_none() && bottom.is_none() {
            self.need(owner, names[0], both)?;
        }
        let top = self.need_positive(owner, names[1], top);
        let bottom = self.need_positive(owner, names[2], bottom);
        Some([top?, bottom?])
    }

    fn both_positive(&mut self, owner: &Owner<'d>, key: &str, value: &'d Maybe<Numbers<2>>) -> Option<[f64; 2]> {
        let value = self.need(owner, key, value)?;
        if value.value.0.iter().all(|&number| number > 0.0) {
            return Some(value.value.0);
        }
        self.error(&value.span, format!("both values of `{key}` must be above zero"))
    }
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
fn is_direct(section: &deck::Section) -> bool {
    keys(section).iter().any(|(key, place)| place.is_some() && DIRECT.contains(key))
}

fn keys(s: &deck::Section) -> [(&'static str, Option<&Span>); 23] {
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

fn taken(shape: deck::Shape) -> &'static [&'static str] {
    use deck::Shape;
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

fn word(shape: deck::Shape) -> &'static str {
    use deck::Shape;
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
