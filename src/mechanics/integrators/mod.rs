//! Time integration schemes: a scheme is a handful of numbers ([`Coefficients`], [`Tableau`]) and how a step uses them ([`Stepping`]). A
//! new scheme needs a file and an entry of [`SCHEMES`].

pub mod alpha_family;
pub mod bathe;
pub mod central_difference;
pub mod coefficients;
pub mod esdirk3;
pub mod generalized_alpha;
pub mod hht_alpha;
pub mod load_steps;
pub mod newmark;
pub mod runge_kutta;
pub mod scheme;
pub mod spectrum;
pub mod stability_limit;
pub mod stage_tableau;
pub mod tableau;
pub mod wilson_theta;

pub use alpha_family::AlphaFamily;
pub use base::math::rotation::RotationUpdate;
pub use bathe::Bathe;
pub use central_difference::CentralDifference;
pub use coefficients::Coefficients;
pub use esdirk3::Esdirk3;
pub use generalized_alpha::GeneralizedAlpha;
pub use hht_alpha::HhtAlpha;
pub use newmark::Newmark;
pub use runge_kutta::RungeKutta;
pub use scheme::{Backward, Scheme, SchemeKind, Stepping, TwoStages};
pub use stage_tableau::StageTableau;
use std::sync::Arc;
pub use tableau::Tableau;
pub use wilson_theta::WilsonTheta;

/// The default scheme.
pub fn default_scheme() -> Arc<dyn Scheme> {
    Arc::new(WilsonTheta { theta: 1.4, rotation: RotationUpdate::Exponential })
}

/// The default scheme of automatic steps: explicit of high order if nothing is `stiff`.
pub fn automatic_scheme(stiff: bool) -> Arc<dyn Scheme> {
    if stiff { Arc::new(Esdirk3 { rotation: RotationUpdate::Exponential }) } else { Arc::new(RungeKutta::default()) }
}

/// All schemes; the first is taken where the deck names none.
pub static SCHEMES: &[&SchemeKind] = &[
    &wilson_theta::KIND,
    &newmark::KIND,
    &hht_alpha::KIND,
    &generalized_alpha::KIND,
    &bathe::KIND,
    &esdirk3::KIND,
    &central_difference::KIND,
    &runge_kutta::KIND,
];

/// The scheme whose steps stability limits, with its defaults.
pub fn stability_limited() -> Arc<dyn Scheme> {
    Arc::new(CentralDifference { rotation: RotationUpdate::default(), mass_scaling_step: None })
}
