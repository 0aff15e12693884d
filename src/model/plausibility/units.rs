//! Numbers of the wrong units: those that no material and no planet has, alone or together.

use crate::report::Report;
use crate::values::vec3;
use base::diagnostic::At;
use base::names::short;
use deck::Deck;
use deck::materials::Material;
use deck::output::Units;
use deck::words::kinds::OneOf;

/// Young's moduli from rubber to diamond, in Pa.
const MODULUS: [f64; 2] = [1e5, 1.3e12];
/// Densities from aerogel to osmium, in kg/m³.
const DENSITY: [f64; 2] = [1.0, 2.3e4];
/// Gravity from the Moon to Jupiter, in m/s².
const GRAVITY: [f64; 2] = [1.6, 26.0];
/// √(E/ρ) of gel, in m/s. There is no upper bound: a density next to nothing is meant, mostly.
const SPEED_OF_SOUND: f64 = 10.0;
/// Common materials: Young's modulus in Pa, density in kg/m³, both from and to.
const COMMON: [(&str, [f64; 2], [f64; 2]); 8] = [
    ("steel", [185e9, 215e9], [7700.0, 8100.0]),
    ("cast iron", [90e9, 180e9], [6900.0, 7400.0]),
    ("aluminium", [65e9, 75e9], [2600.0, 2850.0]),
    ("titanium", [100e9, 120e9], [4400.0, 4600.0]),
    ("copper or brass", [95e9, 135e9], [8300.0, 9000.0]),
    ("concrete", [20e9, 45e9], [2200.0, 2600.0]),
    ("carbon fibre", [60e9, 200e9], [1500.0, 1650.0]),
    ("wood", [8e9, 16e9], [350.0, 800.0]),
];
/// Solids denser than this, in kg/m³, are metals, stone and glass, ...
const DENSE: f64 = 2600.0;
/// ... and none of those is softer, in Pa: lead has 16e9.
const STIFF: f64 = 4e9;
/// Solids softer than this, in Pa, are foams and gels, ...
const SOFT: f64 = 4.5e5;
/// ... which hardly change their volume, or are light.
const INCOMPRESSIBLE: f64 = 0.45;
/// Yield strains of materials: lead 3e-4, steel 1e-3, springs 1e-2, rubber 1. A smaller one makes a solid rigid before it flows.
const YIELD_STRAIN: [f64; 2] = [1e-5, 0.5];
/// Young's moduli of such materials, in Pa, ...
const METAL: [f64; 2] = [1e9, 1.3e12];
/// ... and the units of their values, in Pa: Pa, MPa, GPa, psi and ksi.
const PRESSURES: [f64; 5] = [1.0, 1e6, 1e9, 6894.76, 6.89476e6];
/// Expansions from invar to liquids, in parts per kelvin: no solid has more.
const MOST_EXPANSION: f64 = 1e-3;
/// Factor on the yield stress above which nothing is meant to yield.
const NEVER: f64 = 1e5;
/// A hardening modulus below this part of Young's modulus has no effect.
const NO_HARDENING: f64 = 2e-8;

/// Warns of numbers implausible in the units of the deck, and of numbers inconsistent in any units.
pub fn check_units(deck: &Deck, report: &mut Report) {
    let gravity = deck.environment.as_ref().and_then(|environment| environment.gravity.as_ref());
    let gravity = gravity.map(|g| At { value: vec3(g).norm(), span: g.span.clone() }).filter(|g| g.value > 0.0);
    let units = deck.units.as_ref().map(|units| units.value);
    if let Some(units) = units {
        let [length, _, time] = units.scales();
        plausible(units, "gravity", gravity.as_ref(), length / (time * time), GRAVITY, "m/s²", report);
    }
    for (name, material) in &deck.materials.0 {
        let mark = report.mark();
        if let Some(units) = units {
            let [length, mass, time] = units.scales();
            let pressure = mass / (length * time * time);
            plausible(units, "youngs_modulus", material.youngs_modulus.as_ref(), pressure, MODULUS, "Pa", report);
            plausible(units, "density", material.density.as_ref(), mass / length.powi(3), DENSITY, "kg/m³", report);
            if report.is_clean_since(mark) {
                check_stiffness(&name.value, material, units, report);
            }
        } else {
            let is_earth = gravity.as_ref().and_then(|gravity| earth(gravity.value));
            if gravity.is_none() || is_earth.is_some() {
                check_unlabelled(&name.value, material, is_earth, report);
            }
        }
        if report.is_clean_since(mark) {
            check_yield(&name.value, material, report);
        }
        if let Some(expansion) = material.expansion.as_ref().filter(|at| at.value > MOST_EXPANSION) {
            let message = format!(
                "material `{}` expands by {} per unit of temperature, more than any solid",
                name.value,
                short(expansion.value)
            );
            report.warn(&expansion.span, message, "give a part of the length, such as 1.2e-5 for steel");
        }
    }
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
        report.warn(&at.span, message, format!("that is {} {si}; give it in {}", short(value), units.label()));
    }
}

/// Warns of a modulus that does not go with the density in the units of the deck, or of a solid softer than rubber.
fn check_stiffness(name: &str, material: &Material, units: Units, report: &mut Report) {
    let [length, mass, time] = units.scales();
    let (pressure, per_volume) = (mass / (length * time * time), mass / length.powi(3));
    let Some(modulus) = &material.youngs_modulus else { return };
    let stiffness = modulus.value * pressure;
    let Some(density) = material.density.as_ref().filter(|density| density.value > 0.0) else {
        let is_gel = material.poisson_ratio.as_ref().is_some_and(|ratio| ratio.value >= INCOMPRESSIBLE);
        if stiffness > 0.0 && stiffness < SOFT && !is_gel {
            let message = format!(
                "material `{name}` is softer than rubber: in {} its modulus is {} Pa",
                units.label(),
                short(stiffness)
            );
            report.warn(&modulus.span, message, format!("steel has {} there", short(2.1e11 / pressure)));
        }
        return;
    };
    let dense = density.value * per_volume;
    let is_soft = dense > DENSE && stiffness < STIFF || (stiffness / dense).sqrt() < SPEED_OF_SOUND;
    let as_water = common(stiffness, 1e3 * dense);
    if stiffness > 0.0 && (is_soft || as_water.is_some()) {
        let message = format!(
            "modulus and density of material `{name}` do not go together in the units {}: {} Pa with {} kg/m³",
            units.label(),
            short(stiffness),
            short(dense)
        );
        let hint =
            format!("steel has {} and a density of {} there", short(2.1e11 / pressure), short(7850.0 / per_volume));
        report.warn(&modulus.span, message, hint);
    }
}

/// The common material of this modulus, in Pa, and density, in kg/m³.
fn common(modulus: f64, density: f64) -> Option<&'static str> {
    let is = |[low, high]: [f64; 2], value: f64| (low..=high).contains(&value);
    COMMON.iter().find(|(_, e, rho)| is(*e, modulus) && is(*rho, density)).map(|(name, ..)| *name)
}

/// The units of length and time, in m and s, of decks: metres, millimetres, centimetres, inches and feet with seconds, and millimetres with
/// milliseconds.
const LENGTH_AND_TIME: [[f64; 2]; 6] =
    [[1.0, 1.0], [1e-3, 1.0], [0.01, 1.0], [0.0254, 1.0], [0.3048, 1.0], [1e-3, 1e-3]];
/// Metric units in which moduli are written, in Pa: Pa, kPa, MPa and GPa. Numbers in pounds and inches look like too many others.
const MODULI: [f64; 4] = [1.0, 1e3, 1e6, 1e9];
/// Metric units in which densities are written, in kg/m³: kg/m³, t/m³, g/mm³, kg/mm³ and t/mm³.
const DENSITIES: [f64; 5] = [1.0, 1e3, 1e6, 1e9, 1e12];
/// Units of velocity are powers of ten here; this is beyond rounding.
const SAME_UNIT: f64 = 1e-9;

/// The units of length and time of a deck whose gravity is that of the Earth; `None` for another gravity.
fn earth(gravity: f64) -> Option<[f64; 2]> {
    LENGTH_AND_TIME.into_iter().find(|[length, time]| (9.78..=9.84).contains(&(gravity * length / (time * time))))
}

/// Without a label a modulus and a density that are those of a common material, each in a unit of its own, tell the unit of velocity, length
/// over time. One that no system of units has is a slip, as is another than that of the `earth`'s gravity.
fn check_unlabelled(name: &str, material: &Material, earth: Option<[f64; 2]>, report: &mut Report) {
    let (Some(modulus), Some(density)) = (&material.youngs_modulus, &material.density) else { return };
    let velocity = |[length, time]: [f64; 2]| length / time;
    let known: Vec<f64> = match earth {
        Some(units) => vec![velocity(units)],
        None => LENGTH_AND_TIME.into_iter().map(velocity).collect(),
    };
    let mut found = None;
    for (pressure, per_volume) in MODULI.iter().flat_map(|p| DENSITIES.iter().map(move |d| (p, d))) {
        let Some(is) = common(modulus.value * pressure, density.value * per_volume) else { continue };
        let unit = (pressure / per_volume).sqrt();
        if known.iter().any(|known| (unit / known - 1.0).abs() < SAME_UNIT) {
            return;
        }
        found = found.or(Some((is, *pressure, *per_volume)));
    }
    let beside = if earth.is_some() { " with the gravity" } else { "" };
    let message = format!("modulus and density of material `{name}` do not go together{beside}");
    if let Some((is, pressure, per_volume)) = found {
        let stiffness = short(modulus.value * pressure);
        let dense = short(density.value * per_volume);
        let hint = format!(
            "they look like those of {is}, {stiffness} Pa and {dense} kg/m³, in units that do not belong together: in m, kg and s give these, in \
             mm, t and s {} and {}",
            short(modulus.value * pressure * 1e-6),
            short(density.value * per_volume * 1e-12)
        );
        report.warn(&modulus.span, message, hint);
        return;
    }
    let Some([length, time]) = earth else { return };
    let speed = (modulus.value / density.value).sqrt() * length / time;
    if speed > 0.0 && speed < SPEED_OF_SOUND {
        let hint = format!("sound would travel at {} m/s: solids have 50 to 20000 m/s, steel 5200", short(speed));
        report.warn(&modulus.span, message, hint);
    }
}

/// Warns of a yield stress or hardening that does not go with Young's modulus in any unit.
fn check_yield(name: &str, material: &OneOf<Material>, report: &mut Report) {
    let Some(modulus) = material.youngs_modulus.as_ref().filter(|modulus| modulus.value > 0.0) else { return };
    let (key, stress) = match (material.values.numbers("yield_stress"), material.values.numbers("hardening")) {
        (&[stress], _) => ("yield_stress", stress),
        (_, &[_, stress, ..]) => ("hardening", stress),
        _ => return,
    };
    let ratio = stress / modulus.value;
    let place = |key: &str| material.values.place(key).unwrap_or(&modulus.span);
    if let Some(factor) = slip(stress, modulus.value).filter(|_| ratio > 0.0 && ratio < YIELD_STRAIN[0]) {
        let message = format!("material `{name}` yields at a strain of {}: metals do at 1e-4 to 1e-2", short(ratio));
        let hint = format!("`{key}` and `youngs_modulus` are in one unit: is it {}?", short(stress * factor));
        report.warn(place(key), message, hint);
    } else if ratio > YIELD_STRAIN[1] && ratio < NEVER {
        let message = format!("the yield stress of material `{name}` is {} times its Young's modulus", short(ratio));
        report.warn(&modulus.span, message, softer(stress, modulus));
    }
    let hardening = material.values.numbers("hardening_modulus");
    if let (&[hardening], Some(place)) = (hardening, material.values.place("hardening_modulus"))
        && hardening > 0.0
        && hardening < NO_HARDENING * modulus.value
    {
        let part = short(hardening / modulus.value);
        let message =
            format!("the hardening of material `{name}` is {part} of its Young's modulus, which has no effect");
        let hint = format!("give both in the same unit, such as {}, or leave it out", short(1e6 * hardening));
        report.warn(place, message, hint);
    }
}

/// The factor of units that makes a yield stress plausible beside the modulus of a metal.
fn slip(stress: f64, modulus: f64) -> Option<f64> {
    let is_metal = |pressure: &f64| (METAL[0]..=METAL[1]).contains(&(modulus * pressure));
    let plausible = |factor: &f64| (1e-4..=2e-2).contains(&(stress * factor / modulus));
    PRESSURES.iter().any(is_metal).then(|| [1e6, 1e3, 1e9].into_iter().find(plausible)).flatten()
}

fn softer(stress: f64, modulus: &At<f64>) -> String {
    let plausible = |factor: &f64| (1e-4..=2e-2).contains(&(stress / (factor * modulus.value)));
    match [1e6, 1e3, 1e9].into_iter().find(plausible) {
        Some(factor) => format!("in the unit of the yield stress it may be {}", short(factor * modulus.value)),
        None => "give both in the same unit".to_owned(),
    }
}
