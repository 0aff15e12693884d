//! `[environment]` and `[damping]`: loads and damping on the whole model.

use super::data::{BaseAcceleration, Damping, Loading, NodalDamping};
use super::loads::Loads;
use super::places::nodes::Topology;
use super::report::{Owner, Report};
use super::scene::{Reach, Scene};
use super::stages::CurrentStage;
use super::values::{keys, vec3_or_zero};
use base::diagnostic::{At, Span};
use base::math::Vec3;
use base::names::short;
use deck::Deck;
use deck::environment::RayleighDamping;
use deck::words::Table;
use mechanics::amplitude::Amplitude;
use std::f64::consts::TAU;

/// Accelerations of all masses: gravity with the index of its amplitude, and the accelerations of the ground.
#[derive(Default)]
pub(super) struct AccelerationFields {
    pub gravity: Vec3,
    pub gravity_amplitude: Option<usize>,
    pub base_accelerations: Vec<BaseAcceleration>,
}

impl AccelerationFields {
    /// These with the other loads of a scene.
    pub fn with(self, amplitudes: Vec<Amplitude>, loads: Loads) -> Loading {
        let AccelerationFields { gravity, gravity_amplitude, base_accelerations } = self;
        let Loads { nodal, pressures, centrifugal } = loads;
        Loading { amplitudes, nodal, pressures, centrifugal, gravity, gravity_amplitude, base_accelerations }
    }
}

/// The gravity of a deck, in whatever stages it acts.
pub(super) fn gravity(deck: &Deck) -> Vec3 {
    deck.environment.as_ref().map_or_else(Vec3::zeros, |environment| vec3_or_zero(&environment.gravity))
}

/// Reads `[environment]`.
pub(super) fn environment<'d>(
    deck: &'d Deck,
    stage: Option<CurrentStage<'d>>,
    report: &mut Report<'d>,
) -> AccelerationFields {
    let Some(environment) = &deck.environment else { return AccelerationFields::default() };
    let mut accelerations = Vec::new();
    for base in &environment.base_acceleration {
        let owner = Owner::new("an entry of `base_acceleration`", &base.span);
        let direction = report.require(&owner, "direction", &base.direction);
        let direction = direction.and_then(|direction| report.unit("direction", direction));
        let amplitude = report.require(&owner, "amplitude", &base.amplitude);
        let amplitude = amplitude.and_then(|name| report.find("amplitude", &deck.amplitudes, name));
        let scale = base.scale.as_ref().map_or(1.0, |scale| scale.value);
        if let (Some(direction), Some((amplitude, _))) = (direction, amplitude) {
            accelerations.push(BaseAcceleration { direction: direction * scale, amplitude });
        }
    }
    let own = stage.map(|stage| stage.own_amplitude(&environment.gravity_stages));
    let acts = stage.is_none_or(|stage| stage.is_loaded(&environment.gravity_stages));
    let gravity_amplitude = environment.gravity_amplitude.as_ref().map_or(own, |name| {
        if environment.gravity.is_none() {
            return report.error(&name.span, "`gravity_amplitude` needs `gravity`");
        }
        report.find("amplitude", &deck.amplitudes, name).map(|(index, _)| index)
    });
    AccelerationFields {
        gravity: if acts { gravity(deck) } else { Vec3::zeros() },
        gravity_amplitude,
        base_accelerations: accelerations,
    }
}

/// Reads `[damping]`: Rayleigh factors, and dampers on nodes.
pub(super) fn damping<'d>(scene: &Scene<'d>, topology: &Topology, report: &mut Report<'d>) -> Damping {
    let Some(damping) = &scene.deck.damping else { return Damping::default() };
    let [mass_factor, stiffness_factor] = match &damping.rayleigh {
        Some(table) => {
            report.reject_unused("damping by `rayleigh`", &keys!(damping; mass_factor, stiffness_factor));
            rayleigh(table, report).unwrap_or_default()
        }
        None => [
            report.not_negative("mass_factor", &damping.mass_factor, 0.0),
            report.not_negative("stiffness_factor", &damping.stiffness_factor, 0.0),
        ],
    };
    let mut nodal = Vec::new();
    for entry in &damping.nodal {
        let owner = Owner::new("an entry of `nodal`", &entry.span);
        let spots = scene.spots(&owner, "at", &entry.at, Reach::Nodes, report);
        let translation = report.not_negative("translation", &entry.translation, 0.0);
        let rotation = report.not_negative("rotation", &entry.rotation, 0.0);
        for spot in spots {
            if !topology.is_loose(&spot, "this damper", report) {
                nodal.push(NodalDamping { node: spot.node, translation, rotation });
            }
        }
    }
    let modal = damping.modal.as_ref().map_or_else(Vec::new, |table| modal(scene, table, report));
    Damping { mass_factor, stiffness_factor, modal, nodal, ..Damping::default() }
}

/// α and β from ζ at two frequencies: ζ = α/(2 ω) + β ω/2 at both.
fn rayleigh<'d>(table: &'d At<Table<RayleighDamping>>, report: &mut Report<'d>) -> Option<[f64; 2]> {
    let owner = Owner::new("`rayleigh`", &table.span);
    let (ratios, place) = match &table.ratios {
        Some(ratios) => {
            report.reject_unused("a list of `ratios`", &keys!(table; ratio));
            (ratios.0, &ratios.span)
        }
        None => {
            let ratio = report.require(&owner, "ratio", &table.ratio)?;
            ([ratio.value; 2], &ratio.span)
        }
    };
    let frequencies = report.require(&owner, "frequencies", &table.frequencies)?;
    let [low, high] = frequencies.0;
    if !(low > 0.0 && high > low && high.is_finite()) {
        let hint = "give those of two modes, the lower one first, in cycles per unit of time";
        return report.error_with(&frequencies.span, "`rayleigh` needs two positive, ascending `frequencies`", hint);
    }
    if ratios.iter().any(|ratio| !is_damping_ratio(*ratio)) {
        out_of_range(report, place);
        return None;
    }
    let [[first, second], [one, other]] = [[TAU * low, TAU * high], ratios];
    let factor = 2.0 / (second * second - first * first);
    let alpha = factor * first * second * (one * second - other * first);
    let beta = factor * (other * second - one * first);
    if alpha < 0.0 || beta < 0.0 {
        let message = format!("these ratios need a negative {}", if alpha < 0.0 { "alpha" } else { "beta" });
        let (least, most) = (short(one * first / second), short(one * second / first));
        let hint = format!("with {} at the lower frequency the other ratio is {least} to {most}", short(one));
        return report.error_with(place, message, hint);
    }
    Some([alpha, beta])
}

/// True for a part of critical damping that vibrations may have.
fn is_damping_ratio(ratio: f64) -> bool {
    (0.0..1.0).contains(&ratio)
}

fn out_of_range(report: &mut Report, place: &Span) {
    let hint = "a part of critical damping, such as 0.02";
    report.error_with::<()>(place, "a damping ratio must be 0 or more, and below 1", hint);
}

/// ζ of each damped mode.
fn modal<'d>(
    scene: &Scene<'d>,
    At { value: table, span: place }: &'d At<Table<deck::environment::ModalDamping>>,
    report: &mut Report<'d>,
) -> Vec<f64> {
    /// So many modes take seconds to find, and as long as the other forces in each step.
    const MOST: usize = 1000;
    if scene.analysis.damps_modes() || scene.analysis.has_modes() && scene.stage.is_none() {
        let hint = "responses and damped modes take alpha, beta and dampers";
        report.error_with::<()>(place, "`modal` damping acts in dynamic analyses", hint);
    }
    if let Some(ratios) = &table.ratios {
        report.reject_unused("a list of `ratios`", &keys!(table; ratio, modes));
        if ratios.is_empty() {
            report.error_with::<()>(&ratios.span, "`ratios` is empty", "give one for each mode, such as [0.02, 0.03]");
        }
        for ratio in ratios.iter().filter(|ratio| !is_damping_ratio(ratio.value)) {
            out_of_range(report, &ratio.span);
        }
        return ratios.iter().map(|ratio| ratio.value).collect();
    }
    let owner = Owner::new("`modal`", place);
    let ratio = report.require(&owner, "ratio", &table.ratio);
    report.require(&owner, "modes", &table.modes);
    let mut modes = report.count("modes", &table.modes, 0);
    if let (Some(given), true) = (&table.modes, modes > MOST) {
        let hint = "damp the higher ones by `stiffness_factor`, or by the scheme";
        report.error_with::<()>(&given.span, format!("`modal` damping takes at most {MOST} modes"), hint);
        modes = MOST;
    }
    match ratio {
        Some(ratio) if !is_damping_ratio(ratio.value) => {
            out_of_range(report, &ratio.span);
            Vec::new()
        }
        ratio => vec![ratio.map_or(0.0, |ratio| ratio.value); modes],
    }
}
