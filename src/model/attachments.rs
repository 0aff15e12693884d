//! `[[attachments]]`: points and bodies rigidly attached to a body, nodes rigidly attached to a beam.

use super::data::Joint;
use super::joints::equations;
use super::places::nearest_nodes::NodesAlongAxis;
use super::places::nodes::Nodes;
use super::places::place::Place;
use super::places::spot::Spot;
use super::plausibility::long_chains::hold_long_chains;
use super::report::{Owner, Report};
use super::scene::{Reach, Scene};
use base::diagnostic::{At, Diagnostic};
use base::math::Vec3;
use base::names::short;
use deck::attachments::{Attachment, AttachmentMethod};
use deck::parts::PartIndex;
use deck::words::Maybe;
use std::collections::{HashMap, HashSet};

/// Distances that agree to this relative difference count as equal.
const SAME: f64 = 1e-9;

/// Attaches nodes to bodies and beams; returns the joints for those that elimination cannot attach.
pub(super) fn attachments<'d>(scene: &Scene<'d>, nodes: &mut Nodes, report: &mut Report<'d>) -> Vec<Joint> {
    let (mut joints, mut open, clean) = (Vec::new(), HashSet::new(), report.mark());
    for attachment in &scene.deck.attachments {
        let owner = Owner::new("`[[attachments]]`", &attachment.span);
        if let (Some(name), Some(_)) = (&attachment.beam, &attachment.body) {
            report.error::<()>(&name.span, "an attachment takes a `body` or a `beam`, not both");
        }
        let target = target(scene, &owner, attachment, report);
        let spots = scene.spots(&owner, "nodes", &attachment.nodes, Reach::Parts, report);
        let spots = match &target {
            Some(target) => near(scene, target, (spots, &attachment.within), nodes, report),
            None => spots,
        };
        if report.is_spoiled(owner.span, "dofs") {
            continue;
        }
        let dofs = attachment.dofs.as_ref().map_or([true; 6], |dofs| dofs.0);
        if dofs == [false; 6]
            && let Some(at) = &attachment.dofs
        {
            report.error::<()>(&at.span, "`dofs` is empty, so nothing is attached");
        }
        let method = attachment.method.as_ref().map(|method| method.value);
        if !matches!(method, Some(AttachmentMethod::Elimination | AttachmentMethod::Multipliers)) {
            open.extend(spots.iter().map(|spot| spot.node));
        }
        let mut link = Attacher { dofs, method, scene, nodes: &mut *nodes, joints: &mut joints, report: &mut *report };
        match target {
            Some(Target::Part(name, beam)) => link.attach_to_beam(name, beam, &spots),
            Some(Target::Body(body)) => link.attach_to_body(body, &spots),
            None => {}
        }
    }
    check_cycles(nodes, report);
    if report.is_clean_since(clean) {
        hold_long_chains(nodes, &open, &mut joints);
    }
    joints
}

/// The body or beam that nodes are attached to.
enum Target<'d> {
    Body(usize),
    /// A beam, with the name that the attachment gives it.
    Part(&'d At<String>, PartIndex),
}

fn target<'d>(
    scene: &Scene<'d>,
    owner: &Owner<'d>,
    attachment: &'d Attachment,
    report: &mut Report<'d>,
) -> Option<Target<'d>> {
    let Some(name) = &attachment.beam else {
        if report.is_spoiled(owner.span, "beam") {
            return None;
        }
        let name = report.require(owner, "body", &attachment.body)?;
        return scene.names.body(name, report).map(Target::Body);
    };
    let takes = |part: &PartIndex| part.kind.takes_attachments();
    match scene.names.place(name) {
        Some(Place::Part(part)) if takes(&part) => Some(Target::Part(name, part)),
        // A beam made rigid may be named as the target; the attachment is then to its body.
        Some(Place::Body(body)) if scene.names.rigid_part(body).as_ref().is_some_and(takes) => Some(Target::Body(body)),
        Some(place) => {
            let message = format!("`{}` is {}, not a beam", name.value, place.kind());
            report.error_with(&name.span, message, "name an entry of [[beams]]")
        }
        None => {
            let names = scene.deck.parts().filter(|part| takes(&part.at)).filter_map(|part| part.name());
            report.unknown("beam", name, names.map(|name| name.as_str()).collect::<Vec<_>>().into_iter())
        }
    }
}

/// The nodes within a distance of the target, if the deck gives one.
fn near<'d>(
    scene: &Scene<'d>,
    target: &Target,
    (mut spots, within): (Vec<Spot<'d>>, &'d Maybe<f64>),
    nodes: &Nodes,
    report: &mut Report<'d>,
) -> Vec<Spot<'d>> {
    let Some(at) = within else { return spots };
    if report.positive("within", within).is_none() || spots.is_empty() {
        return spots;
    }
    let own: HashSet<usize> = match target {
        Target::Body(body) => HashSet::from([scene.bodies[*body].node]),
        Target::Part(_, beam) => scene.parts.entry(*beam).into_iter().flat_map(|entry| &entry.nodes).copied().collect(),
    };
    // The nodes of the target itself are near, and attach nothing.
    spots.retain(|spot| !own.contains(&spot.node));
    let centers: Vec<Vec3> = own.iter().map(|&node| nodes.x(node)).collect();
    let distance = |node: usize| centers.iter().map(|x| (nodes.x(node) - x).norm()).fold(f64::INFINITY, f64::min);
    for of in spots.chunk_by(|a, b| a.span == b.span) {
        let nearest = of.iter().map(|spot| distance(spot.node)).fold(f64::INFINITY, f64::min);
        if nearest > at.value * (1.0 + SAME) {
            let message = format!("no node of this lies within {}", short(at.value));
            let hint = format!("the nearest is {} away: give more, or divide the mesh there", short(nearest));
            report.error_with::<()>(of[0].span, message, hint);
        }
    }
    // A node on the circle counts, whatever the last digits of the deck are.
    spots.retain(|spot| distance(spot.node) <= at.value * (1.0 + SAME));
    spots
}

/// Attaches nodes as one table says.
struct Attacher<'a, 'd> {
    dofs: [bool; 6],
    method: Option<AttachmentMethod>,
    scene: &'a Scene<'d>,
    nodes: &'a mut Nodes,
    joints: &'a mut Vec<Joint>,
    report: &'a mut Report<'d>,
}

impl<'d> Attacher<'_, 'd> {
    fn attach_to_body(&mut self, body: usize, spots: &[Spot<'d>]) {
        let (master, body) = (self.scene.bodies[body].node, &self.scene.bodies[body].name);
        for spot in spots {
            if spot.node == master {
                let message = format!("body `{body}` is attached to itself");
                let hint = if spot.direct { "remove it from `nodes`" } else { "it is a member of this set" };
                self.report.error_with::<()>(spot.span, message, hint);
            } else {
                self.attach(spot, master, body);
            }
        }
    }

    /// Attaches free nodes by elimination and attached ones by multipliers, unless the deck gives the method.
    fn attach(&mut self, spot: &Spot, master: usize, to: &str) {
        let first = self.nodes.master(spot.node);
        if first == Some(master) {
            let message = format!("`{}` is attached to `{to}` twice", spot.name);
            self.report.error_with::<()>(spot.span, message, "remove one of the two attachments");
        } else if self.method == Some(AttachmentMethod::Multipliers)
            || first.is_some() && self.method != Some(AttachmentMethod::Elimination)
        {
            self.join(spot, master, to);
        } else if let Some(first) = first {
            let first = self.nodes.label(first);
            let message = format!("`{}` is attached to `{first}`, so it cannot be eliminated again", spot.name);
            self.report.error_with::<()>(spot.span, message, "leave out `method`, or write \"multipliers\"");
        } else {
            self.nodes.attach(spot.node, master, self.dofs, spot.span);
        }
    }

    /// Joins a node by a joint to a new point on a master.
    fn join(&mut self, spot: &Spot, master: usize, to: &str) {
        let name = format!("{} on {to}", self.nodes.label(spot.node));
        let there = self.nodes.add_dependent(name.clone(), self.nodes.x(spot.node), master, spot.span);
        self.nodes.connect(there, true);
        self.nodes.connect(spot.node, self.dofs[3..].contains(&true));
        self.joints.push(Joint::new(name, [spot.node, there], equations(self.dofs), false).of_attachment());
    }

    /// Attaches each node to the nearest node of a beam; the beam's own stay.
    fn attach_to_beam(&mut self, name: &At<String>, beam: PartIndex, spots: &[Spot<'d>]) {
        let own: HashSet<usize> =
            self.scene.parts.entry(beam).into_iter().flat_map(|entry| &entry.nodes).copied().collect();
        let line = NodesAlongAxis::new(&own, self.nodes);
        let lengths = self.element_vectors(beam);
        let (mut far, mut farthest, mut between) = (0, 0.0f64, Vec::new());
        for spot in spots.iter().filter(|spot| !own.contains(&spot.node)) {
            let x = self.nodes.x(spot.node);
            let Some((master, second)) = line.nearest_two(&x, self.nodes) else { continue };
            let distance = (self.nodes.x(master) - x).norm();
            if let Some(other) = second.filter(|&other| (self.nodes.x(other) - x).norm() <= distance * (1.0 + SAME)) {
                between.push((spot, [spot.node, master, other]));
                continue;
            }
            if let Some(length) = lengths.get(&master) {
                let along = (x - self.nodes.x(master)).dot(length).abs() / length.norm_squared();
                far += usize::from(along > 0.5 + SAME);
                farthest = farthest.max(along);
            }
            let to = self.nodes.label(master).to_owned();
            self.attach(spot, master, &to);
        }
        self.report_between(name, &between);
        if far > 0 {
            let message = format!(
                "nodes lie farther along beam `{}` from its nearest node than half an element: {far}",
                name.value
            );
            self.report.warn(
                &name.span,
                message,
                format!("the farthest by {} elements: extend the beam, or divide it where they are", short(farthest)),
            );
        }
    }

    /// Maps each node of a beam to the vector from end to end of an element there.
    fn element_vectors(&self, beam: PartIndex) -> HashMap<usize, Vec3> {
        let mut vectors = HashMap::new();
        for part in self.scene.parts.of(beam) {
            for nodes in (0..part.elements()).map(|element| part.nodes(element)) {
                let vector = self.nodes.x(nodes[nodes.len() - 1]) - self.nodes.x(nodes[0]);
                vectors.extend(nodes.iter().map(|&node| (node, vector)));
            }
        }
        vectors
    }

    /// Reports nodes, each with two of a beam that are equally near: of each name in the list the first, and how many others.
    fn report_between(&mut self, beam: &At<String>, between: &[(&Spot<'d>, [usize; 3])]) {
        for of in between.chunk_by(|a, b| a.0.span == b.0.span) {
            let (spot, nodes) = &of[0];
            let [node, a, b] = nodes.map(|node| self.nodes.label(node));
            let message = format!("`{node}` is as near to `{a}` as to `{b}` of beam `{}`", beam.value);
            let error = Diagnostic::error(message).at(spot.span);
            let error = error.hint("the meshes must match: give the beam a node next to each attached node");
            self.report.push(match of.len() {
                1 => error,
                count => error.hint(format!("the same goes for {} more nodes", count - 1)),
            });
        }
    }
}

/// Reports nodes that, from master to master, depend on themselves.
fn check_cycles(nodes: &Nodes, report: &mut Report) {
    let mut known = vec![false; nodes.list.len()];
    for start in &nodes.dependents {
        let (mut chain, mut node) = (Vec::new(), start.node);
        while let (Some(master), Some(place)) = (nodes.master(node), nodes.attachment_place(node))
            && !known[node]
        {
            known[node] = true;
            chain.push(node);
            node = master;
            let Some(begin) = chain.iter().position(|&earlier| earlier == node) else { continue };
            let names: Vec<String> =
                chain[begin..].iter().chain([&node]).map(|&n| format!("`{}`", nodes.label(n))).collect();
            let message = format!("these attachments go round in a circle: {}", names.join(" on "));
            report.push(Diagnostic::error(message).at(place).hint("remove one of these attachments"));
            break;
        }
    }
}
