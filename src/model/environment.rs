//! `[environment]` and `[damping]`: loads and damping on the whole model.

use super::data::{BaseAcceleration, Damping, Loading, NodalDamping};
use super::loads::Loads;
use super::places::nodes::Topology;
use super::report::{Owner, Report};
use super::scene::{Reach, Scene};
use super::stages::CurrentStage;
use super::values::vec3_or_zero;
use base::math::Vec3;
use deck::Deck;
use mechanics::amplitude::Amplitude;

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
    let mass_factor = report.not_negative("mass_factor", &damping.mass_factor, 0.0);
    let stiffness_factor = report.not_negative("stiffness_factor", &damping.stiffness_factor, 0.0);
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
    Damping { mass_factor, stiffness_factor, nodal, ..Damping::default() }
}
