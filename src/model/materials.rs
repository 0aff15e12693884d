//! `[materials.x]`: the constants of a material, and its law if it yields.

use super::data::MassKind;
use super::report::{Owner, Report};
use super::values::keys;
use base::diagnostic::At;
use deck::Deck;
use deck::environment::Environment;
use deck::materials as words;
use deck::words::kinds::OneOf;
use deck::words::{Maybe, Named};
use mechanics::materials::models::MaterialKind;
use mechanics::materials::uniaxial::UniaxialLaw;
use mechanics::materials::{MaterialLaw, Viscosity};

/// The materials of a deck, with what parts ask of them.
pub(super) struct Materials<'d> {
    table: &'d Named<OneOf<words::Material>>,
    /// The law of each material; `None` where it is elastic or has errors.
    laws: Vec<Option<UniaxialLaw>>,
    /// Deformable parts must have a mass: in dynamics, and where gravity pulls or the ground accelerates.
    inertia_matters: bool,
}

/// Checks `[materials]`.
pub(super) fn materials<'d>(deck: &'d Deck, has_inertia: bool, report: &mut Report<'d>) -> Materials<'d> {
    let laws = deck.materials.0.iter().map(|(name, material)| {
        let owner = Owner::new(format!("material `{}`", name.value), &material.span);
        let model = report.require(&owner, "model", &material.kind);
        report.require_positive(&owner, "youngs_modulus", &material.youngs_modulus);
        report.positive("density", &material.density);
        if let Some(ratio) = &material.poisson_ratio
            && !(ratio.value > -1.0 && ratio.value <= 0.5)
        {
            report.error::<()>(&ratio.span, "`poisson_ratio` must lie above -1 and not above 0.5");
        }
        model.and_then(|kind| law_of(&owner, material, kind.value, report))
    });
    let laws = laws.collect();
    let pulls = |environment: &Environment| environment.gravity.is_some() || !environment.base_acceleration.is_empty();
    let pulled = deck.environment.as_ref().is_some_and(|environment| pulls(environment))
        || deck.loads.iter().any(|load| load.centrifugal.is_some());
    Materials { table: &deck.materials, laws, inertia_matters: has_inertia || pulled }
}

impl<'d> Materials<'d> {
    /// The table of a material, with its index.
    pub fn find(&self, name: &At<String>, report: &mut Report<'d>) -> Option<(usize, &'d At<OneOf<words::Material>>)> {
        report.find("material", self.table, name)
    }

    /// The table of a material of the deck.
    pub fn named(&self, name: &At<String>) -> Option<&'d At<OneOf<words::Material>>> {
        Some(&self.table.0[self.table.position(name)?].1)
    }

    /// The law of normal stress of a material; `Some(None)` where it is elastic, `None` after errors.
    pub fn law_of_fibres(&self, name: &At<String>) -> Option<Option<UniaxialLaw>> {
        let index = self.table.position(name)?;
        let (_, material) = &self.table.0[index];
        match material.kind.as_ref()?.make.law {
            None => Some(None),
            Some(_) => self.laws[index].clone().map(Some),
        }
    }

    /// The law of the material of a part under several stresses; `Some(None)` for elastic material or none, `None` after errors.
    pub fn yielding_of(
        &self,
        name: &Maybe<String>,
        part: &str,
        report: &mut Report<'d>,
    ) -> Option<Option<MaterialLaw>> {
        let Some(name) = name else { return Some(None) };
        match self.law_of_fibres(name)? {
            None | Some(UniaxialLaw::Elastic(_)) => Some(None),
            Some(UniaxialLaw::Plastic(law)) => Some(Some(law)),
            Some(UniaxialLaw::Concrete(_) | UniaxialLaw::MenegottoPinto(_)) => {
                let word = self.named(name)?.kind.as_ref()?.word;
                let message =
                    format!("{part} cannot be made of material `{}`: model \"{word}\" is for beams", name.value);
                report.error_with(&name.span, message, "take model \"elastic-plastic\"")
            }
        }
    }

    /// True where a deformable part with this distribution of mass must have a density.
    pub fn needs_mass(&self, mass: MassKind) -> bool {
        mass != MassKind::None && self.inertia_matters
    }

    /// The density of a material, which must be there if `part` has mass.
    pub fn density(
        &self,
        name: &At<String>,
        material: &At<OneOf<words::Material>>,
        mass: MassKind,
        part: &str,
        report: &mut Report<'d>,
    ) -> Option<f64> {
        self.density_if(self.needs_mass(mass), name, material, part, report)
    }

    /// The density of a material, which must be there if `part` `needs` it.
    pub fn density_if(
        &self,
        needs: bool,
        name: &At<String>,
        material: &At<OneOf<words::Material>>,
        part: &str,
        report: &mut Report<'d>,
    ) -> Option<f64> {
        match &material.density {
            Some(density) => Some(density.value),
            None if report.is_spoiled(&material.span, "density") => None,
            None if needs => {
                let message = format!("material `{}` has no density, which the mass of {part} needs", name.value);
                report.error_with(&name.span, message, "give it one, or `mass = \"none\"` to the part")
            }
            None => Some(0.0),
        }
    }
}

/// The law of a material; `None` where it is elastic or has errors.
fn law_of<'d>(
    owner: &Owner<'d>,
    material: &'d OneOf<words::Material>,
    kind: &'static MaterialKind,
    report: &mut Report<'d>,
) -> Option<UniaxialLaw> {
    let model = &kind.make;
    let viscosity = if model.is_viscous {
        report.require(owner, "viscosity", &material.viscosity).map(|table| viscosity(table, report))
    } else {
        report.reject_unused(model.noun, &keys!(material; viscosity));
        Some(None)
    };
    let modulus = material.youngs_modulus.as_ref().map(|modulus| modulus.value);
    let ratio = material.poisson_ratio.as_ref().map_or(0.0, |ratio| ratio.value);
    // The other keys are checked also where constants are missing or wrong.
    let law = report.read(owner, model.noun, &material.values, kind, |given| {
        (model.law?)(given, [modulus.unwrap_or(f64::NAN), ratio], viscosity.flatten())
    });
    let is_complete = modulus.is_some() && viscosity.is_some_and(|viscosity| viscosity.is_some() || !model.is_viscous);
    law.filter(|_| is_complete)
}

fn viscosity<'d>(table: &'d At<OneOf<words::Viscosity>>, report: &mut Report<'d>) -> Option<Viscosity> {
    let owner = Owner::new("`viscosity`", &table.span);
    let kind = report.require(&owner, "law", &table.kind);
    let rate = report.require_positive(&owner, "rate", &table.rate);
    let kind = kind?.value;
    let what = format!("the law \"{}\"", kind.word);
    let overstress = report.read(&owner, &what, &table.values, kind, kind.make);
    Some(Viscosity { fluidity: rate?, overstress: overstress? })
}
