//! The guards that a scene needs.

use crate::system::{System, judges_stresses};
use model::{AnalysisKind, Model};

/// Kinds of guards, which refuse steps or warn of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GuardKind {
    /// Steps too long for contacts, and contacts that are pressed in too deep.
    Contacts,
    /// Directions without mass that nothing holds.
    Massless,
    /// Joints that are open at the end of a step.
    Joints,
    /// Bushings and supports that have lost count of turns.
    Links,
    /// Load steps that leave the path of equilibria, or turn nodes too far.
    Jump,
    /// Steps of a motion that turn nodes of shells against their elements.
    Twist,
    /// Shells stretched beyond their strain measure, superelements bent beyond their matrices, and elastic beams with implausible strain.
    Strain,
    /// Drift of rotations that supports fix alone.
    Drift,
    /// Equilibria that are unstable.
    Stability,
}

/// Guards of a scene, in the order of their calls. `linear`: the matrix never changes; `explicit`: no step is one of equilibrium, and
/// steppers check their ends themselves.
pub fn choose(model: &Model, system: &System, linear: bool, explicit: bool) -> Vec<GuardKind> {
    let dynamic = model.analysis.kind == AnalysisKind::Dynamic;
    let has_shells = system.groups.iter().any(|group| group.kind.is_surface());
    let has_floating = system.groups.iter().any(|group| group.kind.is_floating());
    let counts_turns = system.has_links() || system.joints.iter().any(|joint| joint.supports);
    let holds_rotations = model.constraints.restraints.iter().any(|held| held.dof > 2 && held.motion.is_none());
    let asked = [
        (GuardKind::Contacts, system.has_contacts()),
        (GuardKind::Massless, dynamic && !explicit),
        (GuardKind::Joints, !explicit && !system.joints.is_empty()),
        (GuardKind::Links, !explicit && counts_turns),
        (GuardKind::Jump, !dynamic && !linear),
        (GuardKind::Twist, dynamic && !explicit && !linear && has_shells),
        (GuardKind::Strain, has_shells || has_floating || judges_stresses(model)),
        (GuardKind::Drift, model.analysis.begin == 0.0 && holds_rotations),
        (GuardKind::Stability, !dynamic && !linear),
    ];
    asked.into_iter().filter(|(_, is_needed)| *is_needed).map(|(kind, _)| kind).collect()
}
