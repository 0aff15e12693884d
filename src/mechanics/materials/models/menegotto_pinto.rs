//! Reinforcing steel: a curve between two lines, with the Bauschinger effect.

use super::kind::{MaterialKind, MaterialModel};
use crate::materials::overstress::Viscosity;
use crate::materials::uniaxial::{MenegottoPinto, UniaxialLaw};
use base::words::kinds::{Form, Given, Key};

/// The model's word, keys and law.
pub static KIND: MaterialKind = MaterialKind {
    word: "menegotto-pinto",
    aliases: &[],
    guesses: &["Steel02", "giuffre-menegotto-pinto", "rebar", "reinforcing-steel", "ReinforcingSteel"],
    about: "Steel of bars and beams under normal stress after Menegotto and Pinto: curves with the Bauschinger effect, optional isotropic hardening.",
    keys: &[
        Key { name: "yield_stress", form: Form::Number, about: "Initial yield stress in tension, above 0." },
        Key {
            name: "hardening_ratio",
            form: Form::Number,
            about: "Slope far beyond yielding over youngs_modulus, 0 to 0.5. Default: 0.01.",
        },
        Key {
            name: "curvature",
            form: Form::Vector,
            about: "[R0, cR1, cR2], the shape of the knee: R0 above 1 for the first, cR1 from 0 to below 1 and cR2 above 0 for how it rounds \
                    with plastic strain. Default: [20, 0.925, 0.15].",
        },
        Key {
            name: "isotropic",
            form: Form::Numbers,
            about: "[a1, a2, a3, a4], isotropic hardening: growth and its range in yield strains in compression, then in tension. a1 and a3 are \
                    0 or more, a2 and a4 above 0. Default: none.",
        },
    ],
    make: MaterialModel { noun: "a steel of model \"menegotto-pinto\"", law: Some(law), is_viscous: false },
};

fn law(given: &mut Given, [E, _]: [f64; 2], _: Option<Viscosity>) -> Option<UniaxialLaw> {
    let yield_stress = given.require_positive("yield_stress");
    let hardening_ratio = given.between("hardening_ratio", [0.0, 0.5], 0.01);
    let curvature = given.vector("curvature").map_or([20.0, 0.925, 0.15], |v| [v.x, v.y, v.z]);
    let [R0, c1, c2] = curvature;
    if !(R0 > 1.0 && (0.0..1.0).contains(&c1) && c2 > 0.0) {
        let message = "`curvature` = [R0, cR1, cR2] needs R0 above 1, cR1 from 0 to below 1 and cR2 above 0";
        return given.error_with("curvature", message, "take [20, 0.925, 0.15]");
    }
    let isotropic = match *given.numbers("isotropic") {
        [] if !given.has("isotropic") => [0.0, 1.0, 0.0, 1.0],
        [a1, a2, a3, a4] if a1 >= 0.0 && a2 > 0.0 && a3 >= 0.0 && a4 > 0.0 => [a1, a2, a3, a4],
        _ => {
            let message =
                "`isotropic` takes four numbers, [a1, a2, a3, a4]: a1 and a3 are 0 or more, a2 and a4 above 0";
            return given.error("isotropic", message);
        }
    };
    Some(UniaxialLaw::MenegottoPinto(MenegottoPinto {
        modulus: E,
        yield_stress: yield_stress?,
        hardening_ratio,
        curvature,
        isotropic,
    }))
}
