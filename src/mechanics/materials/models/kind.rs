//! The registry entry of a material model, and the keys shared by several models.

use crate::materials::failure::{FactorTable, FailureCriterion};
use crate::materials::hardening::Hardening;
use crate::materials::law::MaterialLaw;
use crate::materials::overstress::Viscosity;
use crate::materials::uniaxial::UniaxialLaw;
use base::names::short;
use base::words::kinds::{Form, Given, Key, Kind};

/// A model of material that the deck can name.
pub type MaterialKind = Kind<MaterialModel>;

/// The law of a model, and its words.
#[derive(Debug)]
pub struct MaterialModel {
    /// Words for a material of this model in messages: "an elastic material".
    pub noun: &'static str,
    /// Makes the law from the keys; `None` for a model that does not yield.
    pub law: Option<MakeLaw>,
    /// The overstress depends on the rate of plastic strain, as the table `viscosity` says.
    pub is_viscous: bool,
}

/// The law of a material with E, ν and the viscosity it needs; `None` where a key is wrong. A constant that the deck does not give is not a
/// number.
pub type MakeLaw = fn(&mut Given, [f64; 2], Option<Viscosity>) -> Option<UniaxialLaw>;

/// The keys of J2 plasticity.
pub const PLASTICITY: [Key; 7] = [
    Key { name: "yield_stress", form: Form::Number, about: "Initial yield stress in tension, above 0." },
    Key {
        name: "hardening_modulus",
        form: Form::Number,
        about: "Slope of the yield stress over the plastic strain, 0 or more. Default: 0, perfectly plastic.",
    },
    Key {
        name: "hardening",
        form: Form::Pairs,
        about: "[[plastic strain, yield stress], ...], straight lines from plastic strain 0 on, constant after the last, \
                instead of `yield_stress` and `hardening_modulus`.",
    },
    Key {
        name: "kinematic_share",
        form: Form::Number,
        about: "Mixed-hardening ratio: the part of the hardening that is kinematic, 0 (isotropic) to 1. Default: 0.",
    },
    Key {
        name: "failure_strain",
        form: Form::Number,
        about: "Accumulated plastic strain, above 0, at failure of a point of the material: the point then carries no stress, and an element is \
                removed after failure of all its points. Its mass stays with its nodes. Default: it does not fail.",
    },
    Key {
        name: "failure_triaxiality",
        form: Form::Pairs,
        about: "[[triaxiality, factor], ...]: a factor of `failure_strain` over the triaxiality, the mean stress over the equivalent stress. It \
                is 1/3 in tension, 0 in shear, -1/3 in compression. Straight lines, constant beyond the ends. Default: 1 throughout.",
    },
    Key {
        name: "failure_rate",
        form: Form::Pairs,
        about: "[[rate, factor], ...]: `failure_strain` is multiplied by a factor that depends on the rate of plastic strain per time, \
                likewise. Default: 1 throughout.",
    },
];

/// J2 plasticity of the keys [`PLASTICITY`].
pub fn plasticity(given: &mut Given, [E, nu]: [f64; 2], viscosity: Option<Viscosity>) -> Option<UniaxialLaw> {
    let hardening = hardening(given);
    let share = given.not_negative("kinematic_share", 0.0);
    if share > 1.0 {
        given.error::<()>("kinematic_share", "`kinematic_share` must lie between 0 and 1");
    }
    let law = MaterialLaw::new(E, nu, hardening?, share, viscosity);
    if !given.has("failure_strain") {
        for key in ["failure_triaxiality", "failure_rate"].into_iter().filter(|key| given.has(key)).collect::<Vec<_>>()
        {
            let needs = format!("`{key}` needs `failure_strain`, which it multiplies");
            given.error::<()>(key, needs);
        }
        return Some(UniaxialLaw::Plastic(law));
    }
    let strain = given.positive("failure_strain")?;
    if strain > MOST_LIKELY_FAILURE {
        let message = format!("{} fails at a plastic strain of {} %", given.what(), short(100.0 * strain));
        given.warn("failure_strain", message, "give `failure_strain` as a strain, not in per cent");
    }
    let triaxiality = factors(given, "failure_triaxiality");
    let rate = factors(given, "failure_rate");
    if rate.as_ref().is_some_and(|rate| rate.first() < 0.0) {
        given.error::<()>("failure_rate", "rates of plastic strain must not be negative");
    }
    Some(UniaxialLaw::Plastic(law.failing_at(FailureCriterion { strain, triaxiality, rate })))
}

/// The table of factors behind a key, where it is written.
fn factors(given: &mut Given, key: &str) -> Option<FactorTable> {
    if !given.has(key) {
        return None;
    }
    let points = given.numbers(key).chunks_exact(2).map(|point| [point[0], point[1]]);
    match FactorTable::new(points.collect()) {
        Ok(table) => Some(table),
        Err(reason) => given.error(key, format!("`{key}`: {reason}")),
    }
}

/// A failure strain above this was meant in per cent: no metal stretches to three times its length.
const MOST_LIKELY_FAILURE: f64 = 2.0;

fn hardening(given: &mut Given) -> Option<Hardening> {
    if given.is_unreadable("hardening") {
        return None;
    }
    if !given.has("hardening") {
        if !given.has("yield_stress") && !given.is_unreadable("yield_stress") {
            let message = format!("{} needs `yield_stress`, or a table of `hardening`", given.what());
            given.error::<()>("yield_stress", message);
        }
        let yield_stress = given.positive("yield_stress");
        let modulus = given.not_negative("hardening_modulus", 0.0);
        return Some(Hardening::Linear { yield_stress: yield_stress?, modulus });
    }
    for key in ["yield_stress", "hardening_modulus"].into_iter().filter(|key| given.has(key)).collect::<Vec<_>>() {
        let whose = "a material with a table of `hardening`, which begins with the yield stress";
        given.error::<()>(key, format!("`{key}` does not apply to {whose}"));
    }
    let points = given.numbers("hardening").chunks_exact(2).map(|point| [point[0], point[1]]);
    match Hardening::table(points.collect()) {
        Ok(hardening) => Some(hardening),
        Err(reason) => {
            let message = format!("{}: {reason}", given.what());
            given.error("hardening", message)
        }
    }
}
