//! Concrete of fibres: crushing, cracking, and unloading.

use super::kind::{MaterialKind, MaterialModel};
use crate::materials::overstress::Viscosity;
use crate::materials::uniaxial::{ConcreteModel, Softening, UniaxialLaw};
use base::names::short;
use base::words::kinds::{Form, Given, Key};

/// The model's word, keys and law.
pub static KIND: MaterialKind = MaterialKind {
    word: "concrete",
    aliases: &[],
    guesses: &["Concrete01", "Concrete02", "kent-park", "kent-scott-park", "mander", "beton"],
    about: "Concrete of beams under normal stress: a parabola to the strength and a line of crushing after Kent and Park, linear softening \
            in tension, unloading after Yassin.",
    keys: &[
        Key {
            name: "compressive_strength",
            form: Form::Number,
            about: "Strength in compression, above 0. It is reached at the strain 2 compressive_strength / youngs_modulus.",
        },
        Key {
            name: "residual_strength",
            form: Form::Number,
            about: "Compressive stress after crushing, 0 to compressive_strength. Default: 0.2 compressive_strength.",
        },
        Key {
            name: "crushing_strain",
            form: Form::Number,
            about: "Compressive strain, above 0, at which softening ends at residual_strength.",
        },
        Key {
            name: "crushing_energy",
            form: Form::Number,
            about: "Energy per area of crushing, above 0, instead of crushing_strain, which follows from the length that each integration \
                    point stands for: softening then depends little on the mesh.",
        },
        Key { name: "tensile_strength", form: Form::Number, about: "Strength in tension, 0 or more. Default: 0." },
        Key {
            name: "tension_softening_modulus",
            form: Form::Number,
            about: "Slope by which the stress falls after cracking, above 0.",
        },
        Key {
            name: "fracture_energy",
            form: Form::Number,
            about: "Energy per area of cracking, above 0, instead of tension_softening_modulus.",
        },
        Key {
            name: "unloading_ratio",
            form: Form::Number,
            about: "Slope of unloading at the crushing strain over youngs_modulus, 0 to 0.9. Default: 0.1, or more where the residual strength \
                    needs it.",
        },
    ],
    make: MaterialModel { noun: "a concrete", law: Some(law), is_viscous: false },
};

/// The default of `residual_strength` over the strength: that of Kent and Park.
const RESIDUAL: f64 = 0.2;

/// The default of `unloading_ratio`: that of Concrete02.
const UNLOADING: f64 = 0.1;

/// A magnitude, which decks of other programs write below zero.
fn magnitude(given: &mut Given, key: &str) -> Option<f64> {
    match given.number(key)? {
        number if number > 0.0 => Some(number),
        number => {
            let message =
                format!("`{key}` is {}, but strengths and strains of concrete are magnitudes, above 0", short(number));
            match number < 0.0 {
                true => given.error_with(key, message, format!("take {}", short(-number))),
                false => given.error(key, message),
            }
        }
    }
}

fn law(given: &mut Given, [E, _]: [f64; 2], _: Option<Viscosity>) -> Option<UniaxialLaw> {
    given.require("compressive_strength");
    let strength = magnitude(given, "compressive_strength");
    let crushing = softening(given, ["crushing_strain", "crushing_energy"]);
    let residual = given.not_negative("residual_strength", RESIDUAL * strength.unwrap_or(0.0));
    let tension = tension(given, E);
    let ratio = given.between("unloading_ratio", [0.0, 0.9], UNLOADING);
    let (strength, crushing, (tensile_strength, cracking)) = (strength?, crushing?, tension?);
    if residual > strength {
        let message =
            format!("`residual_strength` is {}, above the compressive strength {}", short(residual), short(strength));
        return given.error_with("residual_strength", message, "0.2 of it is common");
    }
    if tensile_strength > strength {
        let message = format!(
            "`tensile_strength` is {}, above the compressive strength {}",
            short(tensile_strength),
            short(strength)
        );
        return given.error_with("tensile_strength", message, "a tenth of it is common");
    }
    let model =
        ConcreteModel { modulus: E, strength, residual, crushing, tensile_strength, cracking, unloading_ratio: ratio };
    if let Softening::Strain(strain) = crushing {
        let peak = model.strain_at_strength();
        if strain <= peak {
            let message = format!(
                "`crushing_strain` is {}, but the strength is reached at 2 compressive_strength / youngs_modulus = {}",
                short(strain),
                short(peak)
            );
            return given.error_with("crushing_strain", message, "softening ends at a larger strain");
        }
        let least = residual / (E * strain);
        if given.has("unloading_ratio") && ratio < least {
            let message = format!(
                "`unloading_ratio` is {}: unloading from the crushing strain would end in tension",
                short(ratio)
            );
            return given.error_with("unloading_ratio", message, format!("take {} or more", short(least)));
        }
    }
    Some(UniaxialLaw::Concrete(model))
}

/// The end of softening by its strain or its energy, of which one must be given.
fn softening(given: &mut Given, [strain, energy]: [&str; 2]) -> Option<Softening> {
    match (given.has(strain), given.has(energy)) {
        (true, true) => given.error(energy, format!("{} takes `{strain}` or `{energy}`, not both", given.what())),
        (true, false) => magnitude(given, strain).map(Softening::Strain),
        (false, true) => magnitude(given, energy).map(Softening::Energy),
        (false, false) => given.require_either(strain, energy),
    }
}

/// Tensile strength and the end of softening in tension.
fn tension(given: &mut Given, E: f64) -> Option<(f64, Softening)> {
    const KEYS: [&str; 2] = ["tension_softening_modulus", "fracture_energy"];
    let strength = given.not_negative("tensile_strength", 0.0);
    if strength > 0.0 {
        let softening = match softening(given, KEYS)? {
            // The stress falls from f_t by the slope.
            Softening::Strain(slope) => Softening::Strain(strength / E + strength / slope),
            energy => energy,
        };
        return Some((strength, softening));
    }
    for key in KEYS.into_iter().filter(|key| given.has(key)).collect::<Vec<_>>() {
        given.error::<()>(key, format!("`{key}` needs `tensile_strength`, from which the stress falls"));
    }
    Some((0.0, Softening::Strain(0.0)))
}
