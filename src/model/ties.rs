//! `[[ties]]` → joints of a node with all nodes of the face beside it, by their weights N.
//!
//! The place of the node is x = Σ N (x_a + R_a A_a), and its rotation is the mean of those of the face, Σ N log(R R_aᵀ) = 0. Arms A are the
//! distance from the face. On faces with straight sides half the way from the corner to the foot adds to it. Sides of shells bend and bulge with
//! the rotations of their ends, and so does the face between them.

use super::data::{Joint, JointOrigin};
use super::places::nearest_nodes::NodesAlongAxis;
use super::places::nodes::Nodes;
use super::places::place::Place;
use super::places::spot::Spot;
use super::report::{Owner, Report};
use super::scene::{Reach, Scene};
use base::diagnostic::Diagnostic;
use base::math::Vec3;
use base::math::face_foot::{Foot, foot};
use base::names::short;
use deck::parts::PartIndex;
use deck::ties::{Beyond, Tie, TiedDofs};
use mechanics::constraints::joint::{ConstraintEquation, SecondNode};
use std::collections::{HashMap, HashSet};

/// Weights and arms below this are rounding: of one, and of the distances in a face.
const ROUNDING: f64 = 1e-12;

/// Nodes beyond the distance by less than this part of it lie within.
const MARGIN: f64 = 1e-6;

/// Nodes coincide where they lie nearer than this part of the size of the model.
const COINCIDENT: f64 = 1e-6;

/// Ties nodes to faces and nodes; returns the joints that hold them.
pub(super) fn ties<'d>(scene: &Scene<'d>, nodes: &mut Nodes, report: &mut Report<'d>) -> Vec<Joint> {
    let (mut joints, mut known) = (Vec::new(), HashMap::new());
    for (index, tie) in scene.deck.ties.iter().enumerate() {
        let (name, owner) = report.named(("tie", "ties", index), tie.name.as_ref(), &tie.span);
        let spots = scene.spots(&owner, "nodes", &tie.nodes, Reach::Parts, report);
        let base = base(scene, &owner, tie, nodes, report);
        let distance = tie.distance.as_ref().and_then(|_| report.positive("distance", &tie.distance));
        if report.is_any_spoiled(owner.span) || spots.is_empty() {
            continue;
        }
        let Some(base) = base else { continue };
        let limit = (1.0 + MARGIN) * distance.unwrap_or_else(|| base.usual_distance(nodes));
        let mut found: Vec<(&Spot, Hold)> = Vec::new();
        let (mut beyond, mut farthest) = (0, (0.0f64, None));
        for spot in spots.iter().filter(|spot| !base.own.contains(&spot.node)) {
            let Some(hold) = base.hold(&nodes.x(spot.node), nodes) else { continue };
            match hold.distance <= limit {
                true => found.push((spot, hold)),
                false => {
                    beyond += 1;
                    farthest = if hold.distance > farthest.0 { (hold.distance, Some(spot)) } else { farthest };
                }
            }
        }
        let is_free = tie.beyond.as_ref().is_some_and(|at| at.value == Beyond::Free);
        if let (distance, Some(spot)) = farthest
            && (!is_free || found.is_empty())
        {
            let place = (spot, nodes.label(spot.node));
            report_far(&owner, (beyond, distance, limit), place, !found.is_empty(), report);
            continue;
        }
        if found.is_empty() {
            let message = format!("{} ties nothing: all its nodes are nodes of `to`", owner.what);
            report.error_with::<()>(
                owner.span,
                message,
                "name the nodes of the other part in `nodes`, or remove the tie",
            );
        }
        let turns = tie.dofs.as_ref().is_none_or(|at| at.value == TiedDofs::All);
        for (spot, hold) in found {
            if let Some(other) = known.insert(spot.node, name.clone()) {
                let message = format!("`{}` is tied twice, by `{other}` and by `{name}`", spot.name);
                report.error_with::<()>(spot.span, message, "a node is tied once: leave it out of one of the two ties");
                continue;
            }
            let joint = hold.join(&name, (spot, owner.span), turns, nodes);
            joints.extend(joint.map(|joint| Joint { origin: JointOrigin::Tie(index), ..joint }));
        }
    }
    joints
}

/// Reports nodes beyond the distance: how many, the farthest, and how far it is.
fn report_far(
    owner: &Owner,
    (beyond, distance, limit): (usize, f64, f64),
    (spot, label): (&Spot, &str),
    has_near: bool,
    report: &mut Report,
) {
    let are = if beyond == 1 { "1 node lies".to_owned() } else { format!("{beyond} nodes lie") };
    let message = format!(
        "{}: {are} beyond `distance` = {}, the farthest is `{}` at {}",
        owner.what,
        short(limit),
        label,
        short(distance)
    );
    let raise = format!("give distance = {}, or name only nodes beside `to`", short(1.01 * distance));
    let error = Diagnostic::error(message).at(spot.span).hint(raise);
    report.push(match has_near {
        true => error.hint("with beyond = \"free\" the others stay free"),
        false => error,
    });
}

/// The faces, or the nodes, that a tie holds to.
struct Base {
    faces: Vec<BaseFace>,
    /// The nodes of the faces, or those to choose from.
    own: HashSet<usize>,
    /// The nodes along an axis, where there are no faces.
    line: Option<NodesAlongAxis>,
}

struct BaseFace {
    nodes: Vec<usize>,
    x: Vec<Vec3>,
    /// A ball that holds the face.
    center: Vec3,
    radius: f64,
    thickness: f64,
}

fn base<'d>(
    scene: &Scene<'d>,
    owner: &Owner<'d>,
    tie: &'d Tie,
    nodes: &Nodes,
    report: &mut Report<'d>,
) -> Option<Base> {
    let names = report.require_nodes(owner, "to", &tie.to)?;
    let (mut faces, mut own) = (Vec::new(), HashSet::new());
    for name in &names.values {
        let place = scene.names.find_in_parts(name, report)?;
        for leaf in scene.names.leaves(place) {
            let of_leaf = faces_of(scene, leaf);
            for (part, face, named) in of_leaf {
                let entry = scene.parts.entry(part);
                faces.push(BaseFace::new(face, entry.map_or(0.0, |entry| 2.0 * entry.contact_radius), nodes));
                own.extend(named);
            }
            own.extend(scene.nodes_of(leaf));
        }
        if own.is_empty() {
            scene.report_empty(place, name, report);
        }
    }
    if own.is_empty() {
        return None;
    }
    own.extend(faces.iter().flat_map(|face| &face.nodes));
    let line = faces.is_empty().then(|| NodesAlongAxis::new(&own, nodes));
    Some(Base { faces, own, line })
}

/// The faces of shells that a name means, with their parts, and their nodes by the names of the deck.
fn faces_of(scene: &Scene, place: Place) -> Vec<(PartIndex, Vec<usize>, Vec<usize>)> {
    let of_part = |part: PartIndex| {
        let elements = scene.parts.elements(part).into_iter().zip(scene.parts.elements_by_name(part));
        elements.map(move |(nodes, named)| (part, nodes, named))
    };
    if let Some(part) = scene.names.surface_of(place) {
        return of_part(part).collect();
    }
    let Place::Group(group) = place else { return Vec::new() };
    let Some(group) = group.faces.one() else { return Vec::new() };
    let sorted = |mut corners: Vec<usize>| {
        corners.sort_unstable();
        corners
    };
    let meant: HashSet<Vec<usize>> = scene.names.mesh.group_faces(group).into_iter().map(sorted).collect();
    let surfaces = scene.deck.parts().filter(|part| part.at.kind.is_surface());
    let corners = |named: &[usize]| sorted(named[..base::math::curved_faces::corners(named.len())].to_vec());
    surfaces.flat_map(|part| of_part(part.at)).filter(|(_, _, named)| meant.contains(&corners(named))).collect()
}

impl BaseFace {
    fn new(nodes: Vec<usize>, thickness: f64, all: &Nodes) -> BaseFace {
        let x: Vec<Vec3> = nodes.iter().map(|&node| all.x(node)).collect();
        let center = x.iter().sum::<Vec3>() / x.len() as f64;
        // Curved faces bulge beyond their nodes by less than the way between these.
        let radius = 2.0 * x.iter().map(|x| (x - center).norm()).fold(0.0, f64::max);
        BaseFace { nodes, x, center, radius, thickness }
    }
}

impl Base {
    /// The default distance of a tie.
    fn usual_distance(&self, nodes: &Nodes) -> f64 {
        let thickness = self.faces.iter().map(|face| face.thickness).fold(0.0, f64::max);
        if thickness > 0.0 {
            return thickness;
        }
        let center = nodes.list[0].x;
        COINCIDENT * nodes.list.iter().map(|node| (node.x - center).norm()).fold(0.0, f64::max)
    }

    /// The hold of a node at `x`: the nearest place on the faces, or the nearest node.
    fn hold(&self, x: &Vec3, nodes: &Nodes) -> Option<Hold> {
        if let Some(line) = &self.line {
            let (node, _) = line.nearest_two(x, nodes)?;
            let arm = x - nodes.x(node);
            return Some(Hold { distance: arm.norm(), shares: vec![(SecondNode { node, weight: 1.0 }, arm)] });
        }
        let from_center = |face: &BaseFace| (x - face.center).norm_squared();
        // The face with the nearest centre comes first, so that most others are seen to be farther.
        let nearest = self.faces.iter().min_by(|a, b| from_center(a).total_cmp(&from_center(b)));
        let mut best: Option<(&BaseFace, Foot, f64)> = None;
        for face in nearest.into_iter().chain(&self.faces) {
            let least = best.as_ref().map_or(f64::INFINITY, |(.., distance)| *distance);
            if (x - face.center).norm() - face.radius > least {
                continue;
            }
            let foot = foot(&face.x, x);
            let distance = (x - foot.x).norm();
            if distance < least {
                best = Some((face, foot, distance));
            }
        }
        let (face, foot, distance) = best?;
        Some(Hold { distance, shares: face.shares(&foot, x) })
    }
}

impl BaseFace {
    /// The nodes that carry a foot, with their weights and arms towards the node at `at`.
    fn shares(&self, foot: &Foot, at: &Vec3) -> Vec<(SecondNode, Vec3)> {
        let along = if self.nodes.len() > 4 { 0.0 } else { 0.5 };
        let offset = at - foot.x;
        let all = self.nodes.iter().zip(&self.x).zip(&foot.weights);
        let acting = all.filter(|(_, weight)| weight.abs() > ROUNDING);
        let share = |((&node, x), &weight): ((&usize, &Vec3), &f64)| {
            (SecondNode { node, weight }, along * (foot.x - x) + offset)
        };
        let mut shares: Vec<(SecondNode, Vec3)> = acting.map(share).collect();
        let rounding = ROUNDING * self.radius;
        shares.iter_mut().filter(|(_, arm)| arm.norm() <= rounding).for_each(|(_, arm)| *arm = Vec3::zeros());
        shares
    }
}

/// The hold of a node: other nodes with their weights, and the arms on them.
struct Hold {
    distance: f64,
    shares: Vec<(SecondNode, Vec3)>,
}

impl Hold {
    /// The joint between a node and its hold. Its equations are zero at t = 0.
    fn join(
        self,
        name: &str,
        (spot, place): (&Spot, &std::ops::Range<usize>),
        all: bool,
        nodes: &mut Nodes,
    ) -> Option<Joint> {
        let turns = all && nodes.turns(spot.node);
        let name = format!("{name} at {}", nodes.label(spot.node));
        let shares: Vec<SecondNode> = self
            .shares
            .into_iter()
            .map(|(share, arm)| {
                if arm == Vec3::zeros() {
                    return share;
                }
                let label = format!("{name} on {}", nodes.label(share.node));
                let node = nodes.add_dependent(label, nodes.x(share.node) + arm, share.node, place);
                nodes.connect(node, true);
                SecondNode { node, ..share }
            })
            .collect();
        nodes.connect(spot.node, turns);
        let x = nodes.x(spot.node);
        let gap: Vec3 = shares.iter().map(|share| share.weight * (x - nodes.x(share.node))).sum();
        let moves = (0..3).map(|axis| ConstraintEquation::GlobalAxis { axis, at: gap[axis] });
        let turned = (0..3).filter(|_| turns).map(|axis| ConstraintEquation::Turn { axis });
        Joint::tie(name, spot.node, &shares, moves.chain(turned).collect())
    }
}
