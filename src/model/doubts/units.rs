//! Numbers of the wrong units: those that no material and no planet has.

use crate::deck::Deck;
use crate::deck::output::Units;
use crate::diagnostic::At;
use crate::model::report::Report;
use crate::model::values::vec3;
use crate::names::short;

/// Young's moduli from rubber to diamond, in Pa.
const MODULUS: [f64; 2] = [1e5, 1.3e12];
/// Densities from aerogel to osmium, in kg/m³.
const DENSITY: [f64; 2] = [1.0, 2.3e4];
/// Gravity from the Moon to Jupiter, in m/s².
const GRAVITY: [f64; 2] = [1.6, 26.0];

impl Units {
    /// The deck's word for it.
    pub fn label(self) -> &'static str {
        match self {
            Units::Si => "SI",
            Units::MKgS => "m-kg-s",
            Units::MmTS => "mm-t-s",
            Units::MmKgS => "mm-kg-s",
            Units::MmKgMs => "mm-kg-ms",
        }
    }

    /// Its length, mass and time in metres, kilograms and seconds.
    fn scales(self) -> [f64; 3] {
        match self {
            Units::Si | Units::MKgS => [1.0, 1.0, 1.0],
            Units::MmTS => [1e-3, 1e3, 1.0],
            Units::MmKgS => [1e-3, 1.0, 1.0],
            Units::MmKgMs => [1e-3, 1.0, 1e-3],
        }
    }
}

/// Warns of numbers that are implausible in the units that the deck names.
pub fn check_units(deck: &Deck, units: Units, report: &mut Report) {
    let [length, mass, time] = units.scales();
    let pressure = mass / (length * time * time);
    for (_, material) in &deck.materials.0 {
        plausible(units, "youngs_modulus", material.youngs_modulus.as_ref(), pressure, MODULUS, "Pa", report);
        plausible(units, "density", material.density.as_ref(), mass / length.powi(3), DENSITY, "kg/m³", report);
    }
    let gravity = deck.environment.as_ref().and_then(|environment| environment.gravity.as_ref());
    let gravity = gravity.map(|g| At { value: vec3(g).norm(), span: g.span.clone() });
    let gravity = gravity.filter(|g| g.value > 0.0);
    plausible(units, "gravity", gravity.as_ref(), length / (time * time), GRAVITY, "m/s²", report);
}

fn plausible(
    units: Units,
    key: &str,
    at: Option<&At<f64>>,
    scale: f64,
    [low, high]: [f64; 2],
    si: &str,
    report: &mut Report,
) {
    let Some(at) = at else { return };
    let value = at.value * scale;
    if value > 0.0 && !(low..=high).contains(&value) {
        let message = format!("`{key}` is not plausible in the units {}", units.label());
        report.warn(&at.span, message, format!("that is {} {si}", short(value)));
    }
}
