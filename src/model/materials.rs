//! `[materials.x]`: what a material is made of, and its law where it yields.

use super::data::{AnalysisKind, MassKind};
use super::report::{Owner, Report};
use super::values::span;
use crate::deck::Deck;
use crate::deck::environment::Environment;
use crate::deck::materials as words;
use crate::deck::words::{Maybe, Named, Table};
use crate::diagnostic::At;
use crate::materials::{Hardening, MaterialLaw, Overstress, Viscosity};

/// Cowper-Symonds exponents lie between 1 and 10; far beyond this the overstress is a step.
const MOST_EXPONENT: f64 = 100.0;

/// The materials of a deck, with what parts ask of them.
pub(super) struct Materials<'d> {
    table: &'d Named<Table<words::Material>>,
    /// By material: how it yields; `None` for an elastic one and one with errors.
    laws: Vec<Option<MaterialLaw>>,
    /// Deformable parts must have a mass: in dynamics, and where gravity pulls or the ground accelerates.
    inertia_matters: bool,
}

/// Checks `[materials]`.
pub(super) fn materials<'d>(deck: &'d Deck, kind: AnalysisKind, report: &mut Report<'d>) -> Materials<'d> {
    let laws = deck.materials.0.iter().map(|(name, material)| {
        let owner = Owner::new(format!("material `{}`", name.value), &material.span);
        let model = report.require(&owner, "model", &material.model);
        report.require_positive(&owner, "youngs_modulus", &material.youngs_modulus);
        report.positive("density", &material.density);
        if let Some(ratio) = &material.poisson_ratio
            && !(ratio.value > -1.0 && ratio.value <= 0.5)
        {
            report.error::<()>(&ratio.span, "`poisson_ratio` must lie above -1 and not above 0.5");
        }
        model.and_then(|model| law_of(&owner, material, model.value, report))
    });
    let laws = laws.collect();
    let pulls = |environment: &Environment| environment.gravity.is_some() || !environment.base_acceleration.is_empty();
    let pulled = deck.environment.as_ref().is_some_and(|environment| pulls(environment));
    Materials { table: &deck.materials, laws, inertia_matters: kind == AnalysisKind::Dynamic || pulled }
}

impl<'d> Materials<'d> {
    /// The table of a material, with its index.
    pub fn find(&self, name: &At<String>, report: &mut Report<'d>) -> Option<(usize, &'d At<Table<words::Material>>)> {
        report.find("material", self.table, name)
    }

    /// How the material of a part yields, `Some(None)` where it is elastic or the part has none; `None` where it has errors.
    pub fn yielding_of(&self, name: &Maybe<String>) -> Option<Option<MaterialLaw>> {
        let Some(name) = name else { return Some(None) };
        let index = self.table.position(name)?;
        let (_, material) = &self.table.0[index];
        match material.model.as_ref()?.value {
            words::Model::Elastic => Some(None),
            words::Model::ElasticPlastic | words::Model::ElasticViscoplastic => self.laws[index].clone().map(Some),
        }
    }

    /// Whether a deformable part whose mass is spread in this way must have one.
    pub fn needs_mass(&self, mass: MassKind) -> bool {
        mass != MassKind::None && self.inertia_matters
    }

    /// The density of a material, which must be there if `part` has mass.
    pub fn density(
        &self,
        name: &At<String>,
        material: &At<Table<words::Material>>,
        mass: MassKind,
        part: &str,
        report: &mut Report<'d>,
    ) -> Option<f64> {
        match &material.density {
            Some(density) => Some(density.value),
            None if report.is_spoiled(&material.span, "density") => None,
            None if self.needs_mass(mass) => {
                let message = format!("material `{}` has no density, which the mass of {part} needs", name.value);
                report.error_with(&name.span, message, "give it one, or `mass = \"none\"` to the part")
            }
            None => Some(0.0),
        }
    }
}

/// Hardening, kinematic share and viscosity; `None` for an elastic material, or one with errors.
fn law_of<'d>(
    owner: &Owner<'d>,
    material: &'d words::Material,
    model: words::Model,
    report: &mut Report<'d>,
) -> Option<MaterialLaw> {
    let yields = [
        ("yield_stress", span(&material.yield_stress)),
        ("hardening_modulus", span(&material.hardening_modulus)),
        ("hardening", span(&material.hardening)),
        ("kinematic_share", span(&material.kinematic_share)),
    ];
    let viscosity = [("viscosity", span(&material.viscosity))];
    match model {
        words::Model::Elastic => {
            report.reject_unused("an elastic material", &yields);
            report.reject_unused("an elastic material", &viscosity);
            return None;
        }
        words::Model::ElasticPlastic => {
            report.reject_unused("an elastic-plastic material: it is rate independent", &viscosity)
        }
        words::Model::ElasticViscoplastic => {}
    }
    let hardening = hardening(owner, material, report);
    let share = report.not_negative("kinematic_share", &material.kinematic_share, 0.0);
    if let Some(at) = &material.kinematic_share
        && at.value > 1.0
    {
        report.error::<()>(&at.span, "`kinematic_share` must lie between 0 and 1");
    }
    let viscosity = match model {
        words::Model::ElasticViscoplastic => {
            let table = report.require(owner, "viscosity", &material.viscosity)?;
            Some(self::viscosity(table, report)?)
        }
        _ => None,
    };
    let ratio = material.poisson_ratio.as_ref().map_or(0.0, |ratio| ratio.value);
    Some(MaterialLaw::new(material.youngs_modulus.as_ref()?.value, ratio, hardening?, share, viscosity))
}

fn hardening<'d>(owner: &Owner<'d>, material: &'d words::Material, report: &mut Report<'d>) -> Option<Hardening> {
    let Some(table) = &material.hardening else {
        if report.is_spoiled(owner.span, "hardening") {
            return None;
        }
        if material.yield_stress.is_none() && !report.is_spoiled(owner.span, "yield_stress") {
            report.error::<()>(owner.span, format!("{} needs `yield_stress`, or a table of `hardening`", owner.what));
        }
        let yield_stress = report.positive("yield_stress", &material.yield_stress);
        let modulus = report.not_negative("hardening_modulus", &material.hardening_modulus, 0.0);
        return Some(Hardening::Linear { yield_stress: yield_stress?, modulus });
    };
    let unused =
        [("yield_stress", span(&material.yield_stress)), ("hardening_modulus", span(&material.hardening_modulus))];
    report.reject_unused("a material with a table of `hardening`, which begins with the yield stress", &unused);
    match Hardening::table(table.value.iter().map(|point| point.value.0).collect()) {
        Ok(hardening) => Some(hardening),
        Err(reason) => report.error(&table.span, format!("{}: {reason}", owner.what)),
    }
}

fn viscosity<'d>(viscosity: &'d At<Table<words::Viscosity>>, report: &mut Report<'d>) -> Option<Viscosity> {
    let owner = Owner::new("`viscosity`", &viscosity.span);
    let law = report.require(&owner, "law", &viscosity.law);
    let rate = report.require_positive(&owner, "rate", &viscosity.rate);
    let exponent = [("exponent", span(&viscosity.exponent))];
    let overstress = match law?.value {
        words::Overstress::Power => {
            let exponent = report.require(&owner, "exponent", &viscosity.exponent)?;
            if !(1.0..=MOST_EXPONENT).contains(&exponent.value) {
                let message = format!("`exponent` must lie between 1 and {MOST_EXPONENT}");
                return report.error(&exponent.span, message);
            }
            Overstress::Power { exponent: exponent.value }
        }
        words::Overstress::Linear => {
            report.reject_unused("a linear law", &exponent);
            Overstress::Linear
        }
        words::Overstress::Exponential => {
            report.reject_unused("an exponential law", &exponent);
            Overstress::Exponential
        }
    };
    Some(Viscosity { fluidity: rate?, overstress })
}
