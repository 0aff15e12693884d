//! `[sections.x]`, of the material of a beam: section stiffnesses, and fibres where it yields.

use super::data::{MassKind, SectionFacts};
use super::materials::Materials;
use super::meshed_sections::{self, PolygonSettings, meshed_section, polygon_materials};
use super::reinforcement::{SectionPart, is_composite, reinforce, require_concrete, with_fibres};
use super::report::{Owner, Report};
use base::diagnostic::At;
use deck::Deck;
use deck::sections as words;
use deck::words::kinds::{Given, OneOf};
use deck::words::{Maybe, Named};
use mechanics::elements::beam::FibreGroup;
use mechanics::materials::uniaxial::UniaxialLaw;
use mechanics::sections::section_shape::shear_factor;
use mechanics::sections::{CrossSection, Section, SectionShape, SectionStresses, Stiffness};
use std::collections::HashMap;

/// The key of a section that an elastic beam does not use.
const UNUSED: &str = "fibres";

/// Largest number of fibres; a section's response no longer changes beyond it.
const MOST_FIBRES: usize = 10_000;

/// The sections of a deck, and the stiffnesses that beams have asked of them so far.
pub(super) struct Sections<'a, 'd> {
    table: &'d Named<OneOf<words::Section>>,
    materials: &'a Materials<'d>,
    /// Section, material, whether it needs a mass and whether it deforms in shear → index in `stiffnesses`, none where there are errors.
    known: HashMap<(usize, Option<usize>, [bool; 2]), Option<usize>>,
    /// Section stiffnesses that beams have asked for.
    pub stiffnesses: Vec<Stiffness>,
    /// What stresses of these sections follow from.
    pub stresses: Vec<Option<SectionStresses>>,
    /// Numbers of the sections of polygons.
    pub facts: Vec<SectionFacts>,
}

impl<'a, 'd> Sections<'a, 'd> {
    /// The sections of a deck, none computed yet.
    pub fn new(deck: &'d Deck, materials: &'a Materials<'d>) -> Self {
        Sections {
            table: &deck.sections,
            materials,
            known: HashMap::new(),
            stiffnesses: Vec::new(),
            stresses: Vec::new(),
            facts: Vec::new(),
        }
    }

    /// Fibres of a section with a material of this law, by material; all are free of errors.
    pub fn fibres(
        &self,
        name: &'d At<String>,
        (made_of, law): (&'d At<String>, UniaxialLaw),
        needs_mass: bool,
        report: &mut Report<'d>,
    ) -> Option<Vec<SectionPart>> {
        let (_, section) = report.find("section", self.table, name)?;
        let (_, material) = self.materials.find(made_of, report)?;
        let ratio = material.poisson_ratio.as_ref()?.value;
        let counts = section.values.place("fibres");
        let numbers: Vec<usize> = section.values.numbers("fibres").iter().map(|&n| n as usize).collect();
        if let Some(counts) = counts
            && numbers.iter().try_fold(1usize, |all, &n| all.checked_mul(n)).is_none_or(|all| all > MOST_FIBRES)
        {
            return report.error(counts, format!("a section has at most {MOST_FIBRES} fibres"));
        }
        let (shape, factor) = match cross_section(&name.value, section, false, report)? {
            (CrossSection::Shape(shape), factor) => (shape, factor),
            (CrossSection::Stiffness(_), _) => return None,
            (CrossSection::Polygons { .. }, _) => {
                let message =
                    format!("section `{}` of polygons has no fibres, so its material must not yield", name.value);
                return report.error_with(&made_of.span, message, "take model \"elastic\", or another shape");
            }
        };
        let made = whole(&*shape, ratio, factor).and_then(|section| shape.fibres(&numbers, &section));
        let (fibres, counts) = match made.and_then(|fibres| Ok((fibres, shape.counts(&numbers)?))) {
            Ok(made) => made,
            Err(reason) => {
                let place = counts.unwrap_or(&name.span);
                return report.error(place, format!("section `{}`: {reason}", name.value));
            }
        };
        let density = material.density.as_ref().map_or(0.0, |density| density.value);
        let base = SectionPart { group: FibreGroup { law, fibres }, density };
        if !is_composite(section) {
            return Some(vec![base]);
        }
        require_concrete(made_of, &base.group.law, report)?;
        reinforce(self.materials, (name, section), &*shape, counts, base, needs_mass, report)
    }

    /// Index of the stiffness for a beam's section and material; `shear` is true for a beam with shear deformation.
    pub fn beam_section(
        &mut self,
        owner: &Owner<'d>,
        [section, made_of]: [&'d Maybe<String>; 2],
        (mass, shear): (MassKind, bool),
        report: &mut Report<'d>,
    ) -> Option<usize> {
        let material = match made_of {
            Some(name) => Some((name, self.materials.find(name, report)?)),
            None => None,
        };
        let name = report.require(owner, "section", section)?;
        let (section_index, section) = report.find("section", self.table, name)?;
        if section.polygons.is_some() {
            return self.polygon_section((name, section_index, section), made_of, (mass, shear), report);
        }
        let direct = section.kind.as_ref().is_some_and(|kind| !(kind.make.takes_material)(&section.values));
        if direct && let Some((given, _)) = &material {
            let message = format!("section `{}` gives stiffnesses, so {} takes no material", name.value, owner.what);
            return report.error(&given.span, message);
        }
        if direct && is_composite(section) {
            let message =
                format!("section `{}` gives stiffnesses, so it takes no `bars`, `core` and `cover`", name.value);
            return report.error_with(&name.span, message, "take shape \"rectangle\" or \"circle\"");
        }
        let material = if direct { None } else { Some(material) };
        let (material_index, numbers) = match material {
            None => (None, [0.0; 3]),
            Some(None) => {
                report.require(owner, "material", made_of)?;
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
        let key = (section_index, material_index, [needs_mass, shear]);
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let made = stiffness(&name.value, section, numbers, needs_mass, report);
        let made = made.and_then(|made| match made_of {
            Some(made_of) if is_composite(section) => self.with_bars(made, (name, made_of), needs_mass, report),
            _ => Some(made),
        });
        let added = added_mass(section, report);
        let index = made.map(|(stiffness, stresses)| {
            let stiffness = stiffness.with_mass_on_axis(added);
            self.stresses.push(stresses);
            self.stiffnesses.push(if shear { stiffness } else { stiffness.without_shear() });
            self.stiffnesses.len() - 1
        });
        self.known.insert(key, index);
        index
    }

    /// Index of the stiffness of a section of polygons, see [`Sections::beam_section`].
    fn polygon_section(
        &mut self,
        (name, index, section): (&'d At<String>, usize, &'d At<OneOf<words::Section>>),
        made_of: &'d Maybe<String>,
        (mass, shear): (MassKind, bool),
        report: &mut Report<'d>,
    ) -> Option<usize> {
        let polygons = section.polygons.as_ref()?;
        let (kind, _) = cross_section(&name.value, section, false, report)?;
        let CrossSection::Polygons { axis, mesh_size } = kind else {
            let message = format!("`polygons` do not apply to section `{}`, which has another shape", name.value);
            return report.error_with(&polygons.span, message, "remove them, or write `shape = \"polygons\"`");
        };
        let own = Owner::new(format!("section `{}`", name.value), &section.span);
        if polygons.value.is_empty() {
            let message = format!("{} has an empty list of polygons", own.what);
            return report.error_with(&polygons.span, message, "give one polygon or more, each with its `points`");
        }
        if is_composite(section) {
            let message = format!("{} is made of polygons, so it takes no `bars`, `core` and `cover`", own.what);
            return report.error_with(&name.span, message, "give each material a polygon");
        }
        let needs_mass = self.materials.needs_mass(mass);
        let made_of = made_of.as_ref();
        let material = match made_of {
            Some(made_of) => Some(self.materials.find(made_of, report)?.0),
            None => None,
        };
        let key = (index, material, [needs_mass, shear]);
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let polygons = (&own, polygons.value.as_slice());
        let materials = polygon_materials(polygons, made_of, self.materials, needs_mass, report);
        let settings = PolygonSettings { axis, mesh_size };
        let made = materials.and_then(|materials| meshed_section(section, polygons, &materials, settings, report));
        let added = added_mass(section, report);
        let number = made.map(|made| {
            let stiffness = made.stiffness.clone().with_mass_on_axis(added);
            let (name, material) = (name.value.clone(), made_of.map(|made_of| made_of.value.clone()));
            if self.facts.iter().all(|known| (&known.name, &known.material) != (&name, &material)) {
                self.facts.push(SectionFacts { name, material, ..made.facts.clone() });
            }
            self.stresses.push(made.stresses.clone());
            self.stiffnesses.push(if shear { stiffness } else { stiffness.without_shear() });
            self.stiffnesses.len() - 1
        });
        self.known.insert(key, number);
        number
    }

    /// The material of the core of a section.
    pub fn core(&self, name: &At<String>) -> Option<&'d At<String>> {
        self.table.0[self.table.position(name)?].1.core.as_ref()
    }

    /// A reinforced section, from that of its shape.
    fn with_bars(
        &self,
        plain: (Stiffness, Option<SectionStresses>),
        (name, made_of): (&'d At<String>, &'d At<String>),
        needs_mass: bool,
        report: &mut Report<'d>,
    ) -> Option<(Stiffness, Option<SectionStresses>)> {
        let (_, material) = self.materials.find(made_of, report)?;
        let law = self.materials.law_of_fibres(made_of)?;
        let law = law.unwrap_or(UniaxialLaw::Elastic(material.youngs_modulus.as_ref()?.value));
        let parts = self.fibres(name, (made_of, law), needs_mass, report)?;
        Some(with_fibres(plain, &parts))
    }

    /// Index of the section of a file.
    pub fn add(&mut self, section: &Stiffness, shear: bool) -> usize {
        self.stiffnesses.push(if shear { section.clone() } else { section.without_shear() });
        self.stresses.push(None);
        self.stiffnesses.len() - 1
    }

    /// Index of the section at this part of the way between two stations of a beam, with its place from the axis along its own axes. Both sections
    /// are sound.
    pub fn between(
        &mut self,
        [start, end]: [(Option<&At<String>>, usize); 2],
        made_of: &'d Maybe<String>,
        (part, place, shear): (f64, [f64; 2], bool),
        report: &mut Report<'d>,
    ) -> usize {
        let (from, to) = (&self.stiffnesses[start.1], &self.stiffnesses[end.1]);
        let (mut stiffness, mut stresses) = (from.toward(to, part), None);
        match (start.0, end.0) {
            (Some(a), Some(b)) if a.value == b.value => stresses.clone_from(&self.stresses[start.1]),
            (Some(a), Some(b)) => match self.of_dimensions([a, b], made_of, part) {
                Some(Ok((own, of_shape))) => {
                    (stiffness, stresses) = (if shear { own } else { own.without_shear() }, of_shape);
                }
                Some(Err(reason)) => {
                    let message = format!("between sections `{}` and `{}`: {reason}", a.value, b.value);
                    report.error::<()>(&a.span, message);
                }
                None => {}
            },
            _ => {}
        }
        if place != [0.0; 2] {
            stiffness = stiffness.beside(place);
            stresses = stresses.map(|stresses| stresses.beside(place));
        }
        self.stiffnesses.push(stiffness);
        self.stresses.push(stresses);
        self.stiffnesses.len() - 1
    }

    /// The tables of two sections of one shape; `None` if their shapes differ.
    fn of_one_shape(&self, names: [&At<String>; 2]) -> Option<[&'d At<OneOf<words::Section>>; 2]> {
        let [a, b] = names.map(|name| self.table.position(name).map(|index| &self.table.0[index].1));
        let (a, b) = (a?, b?);
        std::ptr::eq(a.kind.as_ref()?.value, b.kind.as_ref()?.value).then_some([a, b])
    }

    /// A key that keeps the dimensions of two sections of one shape from being linear between them.
    pub fn differing_key(&self, names: [&At<String>; 2]) -> Option<&'static str> {
        let [a, b] = self.of_one_shape(names)?;
        if a.polygons.is_some() || b.polygons.is_some() {
            return Some("polygons");
        }
        // Dimensions determine the mass of the material alone.
        if a.added_mass.is_some() || b.added_mass.is_some() {
            return Some("added_mass");
        }
        a.values.differs(&b.values, UNUSED)
    }

    /// The section with dimensions at this part of the way between two sections of one shape; `None` if shapes or keys differ.
    ///
    /// # Errors
    /// Dimensions that do not go together.
    fn of_dimensions(
        &self,
        names: [&At<String>; 2],
        made_of: &Maybe<String>,
        part: f64,
    ) -> Option<Result<(Stiffness, Option<SectionStresses>), String>> {
        let [a, b] = self.of_one_shape(names)?;
        if self.differing_key(names).is_some() {
            return None;
        }
        let values = a.values.toward(&b.values, part, UNUSED);
        let mut given = Given::new("the section", &a.span, &values, Vec::new());
        let factor = shear_factor(&mut given);
        let Some(section) = (a.kind.as_ref()?.value.make.read)(&mut given, false) else {
            let first = given.problems.first().map_or_else(String::new, |problem| problem.message.clone());
            return Some(Err(first));
        };
        let shape = match section {
            CrossSection::Stiffness(stiffness) => return Some(Ok((*stiffness, None))),
            CrossSection::Shape(shape) => shape,
            CrossSection::Polygons { .. } => return None,
        };
        let material = self.materials.named(made_of.as_ref()?)?;
        let (modulus, ratio) = (material.youngs_modulus.as_ref()?.value, material.poisson_ratio.as_ref()?.value);
        let density = material.density.as_ref().map_or(0.0, |density| density.value);
        let made = whole(&*shape, ratio, factor);
        Some(made.map(|made| (made.stiffness(modulus, ratio, density), shape.stresses(ratio, &made))))
    }
}

/// Areas and moments of a shape of a material of Poisson's ratio `nu`, with the shear factors that the deck gives.
fn whole(shape: &dyn SectionShape, nu: f64, factor: Option<[f64; 2]>) -> Result<Section, String> {
    let section = shape.section(nu)?;
    Ok(match factor {
        Some(factor) => section.with_shear_factor(factor),
        None => section,
    })
}

/// The section that the keys give, and its shear factors; they are read anew for each material, and errors are merged in the end.
fn cross_section<'d>(
    name: &str,
    section: &'d At<OneOf<words::Section>>,
    needs_mass: bool,
    report: &mut Report<'d>,
) -> Option<(CrossSection, Option<[f64; 2]>)> {
    let owner = Owner::new(format!("section `{name}`"), &section.span);
    let kind = report.require(&owner, "shape", &section.kind)?.value;
    let what = format!("a section of shape \"{}\"", kind.word);
    report.read(&owner, &what, &section.values, kind, |given| {
        let factor = shear_factor(given);
        Some(((kind.make.read)(given, needs_mass)?, factor))
    })
}

/// The mass per length of a section besides that of its material.
fn added_mass<'d>(section: &'d At<OneOf<words::Section>>, report: &mut Report<'d>) -> f64 {
    report.not_negative("added_mass", &section.added_mass, 0.0)
}

fn stiffness<'d>(
    name: &str,
    section: &'d At<OneOf<words::Section>>,
    [modulus, ratio, density]: [f64; 3],
    needs_mass: bool,
    report: &mut Report<'d>,
) -> Option<(Stiffness, Option<SectionStresses>)> {
    let (shape, factor) = match cross_section(name, section, needs_mass, report)? {
        (CrossSection::Stiffness(stiffness), _) => return Some((*stiffness, None)),
        (CrossSection::Shape(shape), factor) => (shape, factor),
        (CrossSection::Polygons { .. }, _) => {
            let owner = Owner::new(format!("section `{name}`"), &section.span);
            report.require(&owner, "polygons", &section.polygons)?;
            return None;
        }
    };
    match whole(&*shape, ratio, factor) {
        Ok(made) => Some((made.stiffness(modulus, ratio, density), shape.stresses(ratio, &made))),
        Err(reason) => report.error(&section.kind.as_ref()?.span, format!("section `{name}`: {reason}")),
    }
}

/// The contact radius of a beam with this section; 0 if the section has no dimensions.
pub(super) fn half_depth(section: &At<OneOf<words::Section>>) -> f64 {
    let Some(kind) = &section.kind else { return 0.0 };
    // Errors of the section are reported where its stiffness is needed.
    let mut given = Given::new("the section", &section.span, &section.values, Vec::new());
    match (kind.make.read)(&mut given, false) {
        Some(CrossSection::Shape(shape)) => shape.half_depth(),
        Some(CrossSection::Polygons { .. }) => meshed_sections::half_depth(section),
        Some(CrossSection::Stiffness(_)) | None => 0.0,
    }
}
