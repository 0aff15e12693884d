//! `[materials.x]`: what a material is made of, and its law where it yields.

use super::MassKind;
use super::build::{Builder, Owner, span};
use crate::deck::materials as deck;
use crate::deck::words::{Maybe, Table};
use crate::diagnostic::At;
use crate::materials::{Hardening, Law, Overstress, Viscosity};

/// Cowper-Symonds exponents lie between 1 and 10; far beyond this the overstress is a step.
const MOST_EXPONENT: f64 = 100.0;

impl<'d> Builder<'d> {
    pub fn materials(&mut self) {
        for (name, material) in &self.deck.materials.0 {
            let owner = Owner { what: format!("material `{}`", name.value), span: &material.span };
            let model = self.need(&owner, "model", &material.model);
            self.need_positive(&owner, "youngs_modulus", &material.youngs_modulus);
            self.positive("density", &material.density);
            if let Some(ratio) = &material.poisson_ratio
                && !(ratio.value > -1.0 && ratio.value <= 0.5)
            {
                self.error::<()>(&ratio.span, "`poisson_ratio` must lie above -1 and not above 0.5");
            }
            let law = model.and_then(|model| self.law_of(&owner, material, model.value));
            self.laws.push(law);
        }
    }

    /// How the material of a part yields, `Some(None)` where it is elastic or the part has none; `None` where it has errors.
    pub fn yielding_of(&self, name: &Maybe<String>) -> Option<Option<Law>> {
        let Some(name) = name else { return Some(None) };
        let index = self.deck.materials.position(name)?;
        let (_, material) = &self.deck.materials.0[index];
        match material.model.as_ref()?.value {
            deck::Model::Elastic => Some(None),
            deck::Model::ElasticPlastic | deck::Model::ElasticViscoplastic => self.laws[index].clone().map(Some),
        }
    }

    /// Hardening, kinematic share and viscosity; `None` for an elastic material, or one with errors.
    fn law_of(&mut self, owner: &Owner<'d>, material: &'d deck::Material, model: deck::Model) -> Option<Law> {
        let yields = [
            ("yield_stress", span(&material.yield_stress)),
            ("hardening_modulus", span(&material.hardening_modulus)),
            ("hardening", span(&material.hardening)),
            ("kinematic_share", span(&material.kinematic_share)),
        ];
        let viscosity = [("viscosity", span(&material.viscosity))];
        match model {
            deck::Model::Elastic => {
                self.stray("an elastic material", &yields);
                self.stray("an elastic material", &viscosity);
                return None;
            }
            deck::Model::ElasticPlastic => {
                self.stray("an elastic-plastic material: it is rate independent", &viscosity)
            }
            deck::Model::ElasticViscoplastic => {}
        }
        let hardening = self.hardening(owner, material);
        let share = self.not_negative("kinematic_share", &material.kinematic_share, 0.0);
        if let Some(at) = &material.kinematic_share
            && at.value > 1.0
        {
            self.error::<()>(&at.span, "`kinematic_share` must lie between 0 and 1");
        }
        let viscosity = match model {
            deck::Model::ElasticViscoplastic => {
                let viscosity = self.need(owner, "viscosity", &material.viscosity)?;
                Some(self.viscosity(viscosity)?)
            }
            _ => None,
        };
        let ratio = material.poisson_ratio.as_ref().map_or(0.0, |ratio| ratio.value);
        Some(Law::new(material.youngs_modulus.as_ref()?.value, ratio, hardening?, share, viscosity))
    }

    fn hardening(&mut self, owner: &Owner<'d>, material: &'d deck::Material) -> Option<Hardening> {
        let Some(table) = &material.hardening else {
            if self.is_spoiled(owner.span, "hardening") {
                return None;
            }
            if material.yield_stress.is_none() && !self.is_spoiled(owner.span, "yield_stress") {
                self.error::<()>(owner.span, format!("{} needs `yield_stress`, or a table of `hardening`", owner.what));
            }
            let yield_stress = self.positive("yield_stress", &material.yield_stress);
            let modulus = self.not_negative("hardening_modulus", &material.hardening_modulus, 0.0);
            return Some(Hardening::Linear { yield_stress: yield_stress?, modulus });
        };
        let strays =
            [("yield_stress", span(&material.yield_stress)), ("hardening_modulus", span(&material.hardening_modulus))];
        self.stray("a material with a table of `hardening`, which begins with the yield stress", &strays);
        match Hardening::table(table.value.iter().map(|point| point.value.0).collect()) {
            Ok(hardening) => Some(hardening),
            Err(reason) => self.error(&table.span, format!("{}: {reason}", owner.what)),
        }
    }

    fn viscosity(&mut self, viscosity: &'d At<Table<deck::Viscosity>>) -> Option<Viscosity> {
        let owner = Owner { what: "`viscosity`".to_owned(), span: &viscosity.span };
        let law = self.need(&owner, "law", &viscosity.law);
        let rate = self.need_positive(&owner, "rate", &viscosity.rate);
        let exponent = [("exponent", span(&viscosity.exponent))];
        let overstress = match law?.value {
            deck::Overstress::Power => {
                let exponent = self.need(&owner, "exponent", &viscosity.exponent)?;
                if !(1.0..=MOST_EXPONENT).contains(&exponent.value) {
                    let message = format!("`exponent` must lie between 1 and {MOST_EXPONENT}");
                    return self.error(&exponent.span, message);
                }
                Overstress::Power { exponent: exponent.value }
            }
            deck::Overstress::Linear => {
                self.stray("a linear law", &exponent);
                Overstress::Linear
            }
            deck::Overstress::Exponential => {
                self.stray("an exponential law", &exponent);
                Overstress::Exponential
            }
        };
        Some(Viscosity { fluidity: rate?, overstress })
    }

    /// The density of a material, which must be there if `part` has mass.
    pub fn density(
        &mut self,
        name: &At<String>,
        material: &At<Table<deck::Material>>,
        mass: MassKind,
        part: &str,
    ) -> Option<f64> {
        match &material.density {
            Some(density) => Some(density.value),
            None if self.is_spoiled(&material.span, "density") => None,
            None if self.needs_mass(mass) => {
                let message = format!("material `{}` has no density, which the mass of {part} needs", name.value);
                self.error_with(&name.span, message, "give it one, or `mass = \"none\"` to the part")
            }
            None => Some(0.0),
        }
    }
}
