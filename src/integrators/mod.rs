//! Time integration schemes: a scheme is a handful of numbers ([`Coefficients`], [`Tableau`]) and how a step uses them
//! ([`Stepping`]). One more is a file of its own and an entry of [`SCHEMES`].

pub mod alpha_family;
pub mod bathe;
pub mod central_difference;
pub mod coefficients;
pub mod generalized_alpha;
pub mod hht_alpha;
pub mod load_steps;
pub mod newmark;
pub mod runge_kutta;
pub mod scheme;
pub mod spectrum;
pub mod stability_limit;
pub mod tableau;
pub mod wilson_theta;

pub use crate::math::rotation::RotationUpdate;
pub use alpha_family::AlphaFamily;
pub use bathe::Bathe;
pub use central_difference::CentralDifference;
pub use coefficients::Coefficients;
pub use generalized_alpha::GeneralizedAlpha;
pub use hht_alpha::HhtAlpha;
pub use newmark::Newmark;
pub use runge_kutta::RungeKutta;
pub use scheme::{Backward, Scheme, SchemeKind, Stepping, TwoStages};
use std::sync::Arc;
pub use tableau::Tableau;
pub use wilson_theta::WilsonTheta;

/// The scheme that is taken where the deck names none.
pub fn default_scheme() -> Arc<dyn Scheme> {
    Arc::new(WilsonTheta { theta: 1.4, rotation: RotationUpdate::Exponential })
}

/// All schemes; the first is taken where the deck names none.
pub static SCHEMES: &[&SchemeKind] = &[
    &wilson_theta::KIND,
    &newmark::KIND,
    &hht_alpha::KIND,
    &generalized_alpha::KIND,
    &bathe::KIND,
    &central_difference::KIND,
    &runge_kutta::KIND,
];
