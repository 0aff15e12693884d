//! Rigid links, joints and restraints.

use base::math::Vec3;
use base::math::turn::RotationAngles;
use base::quantities::{Column, Unit};
use deck::supports::History;
use mechanics::constraints::joint::{ConstraintEquation, Drive, SecondNode};
use std::collections::{HashMap, HashSet};

/// The magnitudes of the force and of the moment of a joint on its first part.
pub const JOINT_MAGNITUDES: [Column; 2] = [
    Column::scalar("force", "magnitude of the force", Unit::Force).kind("force"),
    Column::scalar("moment", "magnitude of the moment", Unit::Moment).kind("moment"),
];

/// The constraints of a scene: rigid links, joints and restraints.
#[derive(Debug, Clone, Default)]
pub struct Constraints {
    /// The dependent nodes, each at most once, in no particular order.
    pub dependents: Vec<DependentNode>,
    /// The joints in deck order; those that hold supports of dependent nodes come last.
    pub joints: Vec<Joint>,
    /// The restraints, at most one for each degree of freedom, sorted by node and degree of freedom.
    pub restraints: Vec<Restraint>,
    /// Displacements from t = 0 at which motions end that begin wherever a stage finds the node: node, direction and value.
    pub targets: Vec<([usize; 2], f64)>,
    /// The nodes with all three rotations given, more than one of them moving.
    pub turns: Vec<GivenTurn>,
    /// The names of `[[ties]]`, in deck order.
    pub ties: Vec<String>,
    /// For the label of each supported node the sets, groups and parts under which `[[supports]]` name it.
    pub sets: HashMap<String, String>,
    /// The labels of the nodes of each of `[sets]`, in deck order; empty where no reaction of the set is expected.
    pub sums: Vec<HashSet<String>>,
}

impl Constraints {
    /// The ties that hold nodes: the index of each in [`Constraints::ties`], and its joints.
    pub fn tied(&self) -> impl Iterator<Item = (usize, std::ops::Range<usize>)> + '_ {
        let mut start = 0;
        self.joints.chunk_by(|a, b| a.origin == b.origin).filter_map(move |joints| {
            let range = start..start + joints.len();
            start = range.end;
            match joints[0].origin {
                JointOrigin::Tie(tie) => Some((tie, range)),
                _ => None,
            }
        })
    }
}

/// A node whose rotation is given by three numbers together.
#[derive(Debug, Clone, Copy)]
pub struct GivenTurn {
    /// The restraints of rx, ry and rz, by index in [`Constraints::restraints`].
    pub restraints: [usize; 3],
    /// The meaning of the three numbers.
    pub angles: RotationAngles,
}

/// A node rigidly attached to another in some of its degrees of freedom (45)-(48).
#[derive(Debug, Clone)]
pub struct DependentNode {
    /// The dependent node.
    pub node: usize,
    /// The node that it depends on.
    pub master: usize,
    /// True for each of ux, uy, uz, rx, ry, rz that follows the master.
    pub dofs: [bool; 6],
    /// Place in the deck that attaches it: first byte, and the one after the last.
    pub place: Option<[usize; 2]>,
}

/// Two nodes joined by Lagrange multipliers (57).
#[derive(Debug, Clone)]
pub struct Joint {
    /// The deck's name, or one made from it.
    pub name: String,
    /// Nodes at `from` and `to`: dependent nodes of a node or body, the node itself, or a restrained node for the ground.
    pub ends: [usize; 2],
    /// The weight of the second node, and more second nodes with theirs: those of a tie to a face, see
    /// [`mechanics::constraints::joint::Joint::more`].
    pub weight: f64,
    /// See `weight`.
    pub more: Vec<SecondNode>,
    /// The constraint equations.
    pub equations: Vec<ConstraintEquation>,
    /// The equations of the deck at t = 0; a stage with other initial positions locks those instead.
    pub of_deck: Vec<ConstraintEquation>,
    /// True where it holds a dependent node to its support; the support's reactions are then the joint's forces.
    pub supports: bool,
    /// The entry of the deck behind it.
    pub origin: JointOrigin,
    /// Its coordinate; `None` where it has none, or it holds a support or an attachment.
    pub coordinate: Option<JointCoordinate>,
}

/// The entry of the deck behind a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointOrigin {
    /// An entry of `[[joints]]`.
    Deck,
    /// A support of a dependent node, or of a node with a free rotation beside the given ones.
    Support,
    /// An attachment that elimination cannot do.
    Attachment,
    /// A node of an entry of `[[ties]]`, by its index.
    Tie(usize),
}

/// The coordinate of a joint, its drive and its effort.
#[derive(Debug, Clone)]
pub struct JointCoordinate {
    /// The equation that would lock it; its violation is the coordinate.
    pub lock: ConstraintEquation,
    /// The axis, a unit vector, global at t = 0.
    pub axis: Vec3,
    /// The drive of the coordinate; the last equation of the joint is then [`JointCoordinate::lock`].
    pub drive: Option<JointDrive>,
    /// The force or moment between the ends.
    pub effort: Option<JointEffort>,
    /// Index, among all links, of the one that acts along the coordinate and counts its turns.
    pub spring: Option<usize>,
}

/// The drive of a joint's coordinate: a prescribed motion, or gears.
#[derive(Debug, Clone, Copy)]
pub struct JointDrive {
    /// The node whose displacement along x, times the ratio, is the coordinate.
    pub node: usize,
    /// Coordinate per displacement of the node.
    pub ratio: f64,
    /// True without a prescribed motion: the node is then an unknown.
    pub is_free: bool,
}

impl JointCoordinate {
    /// True with a prescribed motion or a motor: something gives power. Gears only pass it on.
    pub fn is_driven(&self) -> bool {
        self.effort.is_some() || self.drive.is_some_and(|drive| !drive.is_free)
    }
}

impl JointDrive {
    /// The drive with the node's place, from the places of all nodes at t = 0.
    pub fn at(&self, x: &[Vec3]) -> Drive {
        Drive { node: self.node, start: x[self.node], ratio: self.ratio, is_free: self.is_free }
    }
}

/// A force or moment between the ends of a joint; it acts as two loads.
#[derive(Debug, Clone, Copy)]
pub struct JointEffort {
    /// Force along the axis, or moment about it, on the second end.
    pub value: f64,
    /// Index of its amplitude; `None`: constant in dynamics, growing linearly in statics.
    pub amplitude: Option<usize>,
}

impl Joint {
    /// A joint as the deck has it.
    pub fn new(name: String, ends: [usize; 2], equations: Vec<ConstraintEquation>, supports: bool) -> Joint {
        let origin = if supports { JointOrigin::Support } else { JointOrigin::Deck };
        Joint {
            name,
            ends,
            weight: 1.0,
            more: Vec::new(),
            of_deck: equations.clone(),
            equations,
            supports,
            origin,
            coordinate: None,
        }
    }

    /// Marks the joint as the substitute of an attachment.
    pub fn of_attachment(self) -> Joint {
        Joint { origin: JointOrigin::Attachment, ..self }
    }

    /// The joint of a tied node and those of the face under it, with their weights.
    pub fn tie(name: String, node: usize, shares: &[SecondNode], equations: Vec<ConstraintEquation>) -> Option<Joint> {
        let (first, more) = shares.split_first()?;
        let joint = Joint::new(name, [node, first.node], equations, false);
        Some(Joint { weight: first.weight, more: more.to_vec(), origin: JointOrigin::Tie(0), ..joint })
    }

    /// True for a joint of a tied node.
    pub fn is_tie(&self) -> bool {
        matches!(self.origin, JointOrigin::Tie(_))
    }

    /// Its nodes: the first, then all second ones.
    pub fn all_ends(&self) -> impl Iterator<Item = usize> + '_ {
        self.ends.into_iter().chain(self.more.iter().map(|share| share.node))
    }

    /// True for joints with rows in joints.csv: supports are in reactions.csv, ties in ties.csv.
    pub fn is_listed(&self) -> bool {
        !self.supports && !self.is_tie()
    }

    /// Lets its coordinate follow a drive, by one more equation. A joint without a coordinate is not changed.
    pub fn set_drive(&mut self, drive: JointDrive) {
        if let Some(coordinate) = &mut self.coordinate {
            coordinate.drive = Some(drive);
            self.equations.push(coordinate.lock);
            self.of_deck.push(coordinate.lock);
        }
    }
}

/// A restrained degree of freedom: it is at rest, or its motion is prescribed.
#[derive(Debug, Clone)]
pub struct Restraint {
    /// The node.
    pub node: usize,
    /// Degree of freedom, 0..6 for ux, uy, uz, rx, ry, rz.
    pub dof: usize,
    /// The prescribed motion; `None` at rest.
    pub motion: Option<PrescribedMotion>,
}

/// A prescribed motion: an amplitude times a factor.
#[derive(Debug, Clone, PartialEq)]
pub struct PrescribedMotion {
    /// Index into [`super::Loading::amplitudes`].
    pub amplitude: usize,
    /// Factor of the amplitude.
    pub scale: f64,
    /// The quantity that the amplitude prescribes: displacement, velocity or acceleration.
    pub history: History,
}
