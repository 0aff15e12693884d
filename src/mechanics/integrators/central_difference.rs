//! Central differences as velocity Verlet. Positions at t + Δt follow from the motion at t, accelerations from equilibrium with the mass
//! alone, velocities from the mean of the accelerations. Nothing is solved for but M a = r. Second order, no damping, periods shortened;
//! stable while the step resolves the fastest mode of the scene: ω Δt ≤ 2, see [`super::stability_limit`]. Momenta of free motion are
//! conserved. A free body follows its angular momentum: exactly with two equal principal inertias, otherwise with an energy oscillation of
//! second order. With coupled masses or restrained directions the rotation Δt ω + ½ Δt² α is not reversible. Such a body gains or loses
//! energy steadily, by the third power of the step.
//!
//! Forces of velocity use the prediction v + Δt a, which keeps the order; the limit becomes ¼ (ω Δt)² + 2 ξ ω Δt ≤ 1. `mass_scaling_step`
//! raises the mass of elements until each is stable at that step. L. Verlet, Phys. Rev. 159 (1967); T. Belytschko, T. J. R. Hughes (eds.),
//! Computational Methods for Transient Analysis (1983).

use std::sync::Arc;

use super::coefficients::Coefficients;
use super::scheme::{MakeScheme, Scheme, SchemeKind, Stepping};
use base::math::rotation::RotationUpdate;
use base::names::short;
use base::words::kinds::{Form, Key};

/// The scheme's word, keys and maker.
pub static KIND: SchemeKind = SchemeKind {
    word: "central-difference",
    aliases: &[],
    guesses: &["verlet", "leapfrog", "leap-frog", "explicit"],
    about: "Explicit, of second order: the masses are its only matrix. Steps must not exceed the limit of the highest mode (omega dt <= 2). \
            time_step = \"auto\" uses 0.8 of the critical time step, 0.5 if contacts or links may stiffen.",
    keys: &[Key {
        name: "mass_scaling_step",
        form: Form::Number,
        about: "Mass scaling: a critical time step, above 0. Elements of beams, bars and shells with a shorter step get rotary inertia, and mass \
                if that is not enough. Weight acts on the true mass; rdsolve prints the additions. Default: none.",
    }],
    make: MakeScheme {
        scheme: |given, rotation| {
            Arc::new(CentralDifference { rotation, mass_scaling_step: given.positive("mass_scaling_step") })
        },
        rotation_update: true,
    },
};

/// Central differences.
#[derive(Debug, Clone, PartialEq)]
pub struct CentralDifference {
    /// The update of rotations.
    pub rotation: RotationUpdate,
    /// Lower limit of the critical time step of each element, reached by added mass.
    pub mass_scaling_step: Option<f64>,
}

impl Scheme for CentralDifference {
    fn word(&self) -> &'static str {
        KIND.word
    }

    fn in_words(&self) -> String {
        match self.mass_scaling_step {
            Some(step) => format!("{}, mass_scaling_step = {}", KIND.word, short(step)),
            None => KIND.word.to_owned(),
        }
    }

    fn note(&self) -> Option<&'static str> {
        Some(
            "explicit: steps beyond the critical time step of the fastest mode are cut back, however slow the motion of interest is",
        )
    }

    fn stepping(&self) -> Stepping<'_> {
        Stepping::Verlet
    }

    fn coefficients(&self, dt: f64) -> Coefficients {
        Coefficients::verlet(dt, self.rotation)
    }
}
