//! The meaning of several rotations of a node given together by supports.

use crate::data::{DIRECTIONS, GivenTurn, History, Joint, JointCoordinate, JointDrive, PrescribedMotion, Restraint};
use crate::places::nodes::Topology;
use crate::places::spot::Spot;
use crate::procedure::stops::NamedActors;
use crate::report::Report;
use crate::scene::Scene;
use base::diagnostic::{At, Span};
use base::math::Vec3;
use base::math::turn::RotationAngles;
use deck::supports::Rotation;
use mechanics::amplitude::Amplitude;
use mechanics::constraints::given_angle::GivenAngle;
use mechanics::constraints::joint::ConstraintEquation;
use std::collections::{BTreeMap, HashMap};

/// The rotations of a node in the deck.
struct NodeRotations<'d> {
    /// The node's name in the deck, and where it stands.
    name: String,
    span: &'d Span,
    rotation: Option<&'d At<Rotation>>,
}

/// A node whose three rotations are given together.
#[derive(Debug, Clone, Copy)]
pub struct TurnedNode {
    node: usize,
    angles: RotationAngles,
}

/// The rotations that are given together, by the restraints of the model.
pub fn given_turns(turned: &[TurnedNode], restraints: &[Restraint]) -> Vec<GivenTurn> {
    let of = |turned: &TurnedNode| {
        let place =
            |dof: usize| restraints.binary_search_by_key(&(turned.node, dof), |held| (held.node, held.dof)).ok();
        Some(GivenTurn { restraints: [place(3)?, place(4)?, place(5)?], angles: turned.angles })
    };
    turned.iter().filter_map(of).collect()
}

/// The nodes with rotations given by supports, and their input.
#[derive(Default)]
pub struct GivenRotations<'d>(BTreeMap<usize, NodeRotations<'d>>);

/// Where rotations get their meaning.
pub struct TurnSetting<'a, 'd> {
    pub scene: &'a Scene<'d>,
    pub amplitudes: &'a [Amplitude],
    pub topology: &'a mut Topology,
    pub joints: &'a mut Vec<Joint>,
    /// For each supported dependent node, the node restrained in its place.
    pub support_points: HashMap<usize, usize>,
    pub report: &'a mut Report<'d>,
}

impl<'d> GivenRotations<'d> {
    /// Notes the key `rotation` of a support for a node.
    pub fn note(&mut self, spot: &Spot<'d>, rotation: Option<&'d At<Rotation>>, report: &mut Report<'d>) {
        let new = NodeRotations { name: spot.name.to_string(), span: spot.span, rotation };
        let known = self.0.entry(spot.node).or_insert(new);
        match (known.rotation, rotation) {
            (Some(one), Some(other)) if one.value != other.value => {
                let message = format!("two supports give the rotations of `{}` different meanings", spot.name);
                report.error_with::<()>(&other.span, message, "one `rotation` is for all rotations of a node");
            }
            (None, Some(_)) => known.rotation = rotation,
            _ => {}
        }
    }

    /// Interprets moving rotations of one node together: if all three are given, they are prescribed at once; beside a free one, the others
    /// are equations. Rotations at rest, or one moving with the others restrained, need no interpretation. Returns the nodes of the first
    /// sort.
    pub fn take(self, mut setting: TurnSetting<'_, 'd>, named: &mut NamedActors) -> Vec<TurnedNode> {
        let mut together = Vec::new();
        for (node, of) in self.0 {
            let held = setting.support_points.get(&node).copied().unwrap_or(node);
            let given: Vec<&Restraint> = (3..6).filter_map(|dof| setting.topology.restraint(held, dof)).collect();
            let moving = given.iter().filter(|restraint| restraint.motion.is_some()).count();
            let angles = of.rotation.map_or(RotationAngles::Vector, |word| word.value.angles());
            match given.len() {
                3 if moving > 1 => together.push(TurnedNode { node: held, angles }),
                2 if moving > 0 => setting.hold_apart(node, &of, angles, named),
                1 if of.rotation.is_some() => setting.hold_apart(node, &of, angles, named),
                _ => {}
            }
        }
        together
    }
}

impl<'d> TurnSetting<'_, 'd> {
    /// Replaces the restraints of some rotations of a node by equations, since another one is free.
    fn hold_apart(
        &mut self,
        node: usize,
        rotations: &NodeRotations<'d>,
        angles: RotationAngles,
        named: &mut NamedActors,
    ) {
        let (label, x) = (self.topology.label(node).to_owned(), self.topology.x(node));
        let known = self.support_points.get(&node).copied();
        let support = known.unwrap_or_else(|| self.topology.add(label.clone(), false, x));
        for joint in self.joints.iter_mut().filter(|joint| joint.supports && joint.ends == [node, support]) {
            joint.equations.retain(|row| !row.is_rotational());
            joint.of_deck.retain(|row| !row.is_rotational());
        }
        self.joints.retain(|joint| !joint.supports || !joint.equations.is_empty());
        let held = known.unwrap_or(node);
        let given: Vec<Restraint> = (3..6).filter_map(|dof| self.topology.release(held, dof)).collect();
        (3..6).for_each(|dof| self.topology.restrain(support, dof, None));
        for Restraint { dof, motion, .. } in given {
            let lock = ConstraintEquation::Given(GivenAngle::new(dof - 3, angles));
            let name = format!("{label} on its support, {}", DIRECTIONS[dof]);
            let Some(motion) = motion else {
                self.joints.push(Joint::new(name, [node, support], vec![lock], true));
                continue;
            };
            self.check_begin(rotations, dof, &motion);
            let number = self.topology.add_number(format!("{label}.{}", DIRECTIONS[dof]), node);
            self.topology.restrain(number, 0, Some(motion));
            let motions = named.iter_mut().flat_map(|(_, actors)| &mut actors.motions);
            motions.filter(|moved| **moved == [held, dof]).for_each(|moved| *moved = [number, 0]);
            let mut joint = Joint::new(name, [node, support], Vec::new(), true);
            let axis = Vec3::ith(dof - 3, 1.0);
            joint.coordinate = Some(JointCoordinate { lock, axis, drive: None, effort: None, spring: None });
            joint.set_drive(JointDrive { node: number, ratio: 1.0, is_free: false });
            self.joints.push(joint);
        }
    }

    /// Reports a rotation beside a free one with a nonzero start value, because the node starts undisplaced.
    fn check_begin(&mut self, rotations: &NodeRotations<'d>, dof: usize, motion: &PrescribedMotion) {
        let analysis = &self.scene.analysis;
        let begins = analysis.is_dynamic() && analysis.begin == 0.0;
        let displaced = motion.history == History::Displacement
            && motion.scale * self.amplitudes[motion.amplitude].value(0.0) != 0.0;
        if begins && displaced {
            let message = format!(
                "the motion of `{}` in {} does not begin at zero, but another rotation is free",
                rotations.name, DIRECTIONS[dof]
            );
            let hint = "let the amplitude begin at zero, or give all three rotations";
            self.report.error_with::<()>(rotations.span, message, hint);
        }
    }
}
