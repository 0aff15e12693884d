//! The reference frames of Rayleigh's α: supports that move a structure as a whole move its damping too.

use super::data::{DIRECTIONS, Joint, JointOrigin, MassKind, Model, MovingFrame, MovingFrames, Part, PrescribedMotion};
use super::report::Report;
use deck::Deck;
use mechanics::constraints::joint::ConstraintEquation;
use std::collections::{BTreeMap, HashMap, HashSet};

/// Finds the frames of a model with mass-proportional damping, and warns of structures with relative motion between supports.
pub fn moving_frames(model: &Model, deck: &Deck, report: &mut Report) -> MovingFrames {
    if !(model.damping.mass_factor > 0.0 || model.parts.iter().any(|part| is_damped(model, part))) {
        return MovingFrames::default();
    }
    let mut structures = Structures::new(model);
    if !model.analysis.has_modes() {
        structures.warn_of_drives(deck, report);
    }
    let held = held(model);
    if !held.iter().any(|held| held.motion.is_some()) {
        return MovingFrames::default();
    }
    let supports = structures.supports(&held);
    let mut frames = MovingFrames { list: Vec::new(), of_node: vec![MovingFrames::NONE; model.nodes.len()] };
    let mut places = BTreeMap::new();
    for (root, nodes) in &supports {
        let found = Found::of(&held, nodes);
        if let Some(nodes) = found.differ {
            let [one, other] = nodes.map(|node| &model.nodes[node].label);
            let message = format!(
                "the supports at `{one}` and `{other}` move differently, so `alpha` brakes velocities against the ground at rest"
            );
            warn(
                model,
                deck,
                message,
                "`beta` damps strain rates alone: beta = 2 xi / omega for a ratio xi at omega",
                report,
            );
        }
        if let Some(frame) = found.frame {
            places.insert(*root, frames.list.len() as u32);
            frames.list.push(frame);
        }
    }
    for node in 0..model.nodes.len() {
        // A wall has a separate frame.
        let own = structures.is_wall[node].then(|| Found::of(&held, &[node]).frame).flatten();
        if let Some(frame) = own {
            frames.of_node[node] = frames.list.len() as u32;
            frames.list.push(frame);
        } else if !structures.is_wall[node] {
            frames.of_node[node] = places.get(&structures.root(node)).copied().unwrap_or(MovingFrames::NONE);
        }
    }
    if frames.list.is_empty() { MovingFrames::default() } else { frames }
}

/// Places the warning at the active factor: that of the model, or else the first one of a part.
fn warn(model: &Model, deck: &Deck, message: String, hint: &str, report: &mut Report) {
    let of_scene = deck.damping.as_ref().filter(|_| model.damping.mass_factor > 0.0);
    let place = of_scene.map(|damping| damping.mass_factor.as_ref().map_or(&damping.span, |at| &at.span));
    let of_part = || deck.parts().find_map(|part| Some(&part.table.damping()?.alpha.as_ref()?.span));
    if let Some(place) = place.or_else(of_part) {
        report.warn(place, message, hint);
    }
}

/// A degree of freedom of a node that a support holds or moves.
struct Held<'m> {
    node: usize,
    dof: usize,
    /// `None` at rest.
    motion: Option<&'m PrescribedMotion>,
    /// True for a rotation given by an equation, beside a free one.
    is_beside_free: bool,
}

/// All restraints by supports: directly, or by equations if a rotation of the node is free.
fn held(model: &Model) -> Vec<Held<'_>> {
    let constraints = &model.constraints;
    let given =
        |joint: &Joint| joint.supports && joint.equations.iter().any(|row| matches!(row, ConstraintEquation::Given(_)));
    let joints = || constraints.joints.iter().filter(|joint| given(joint));
    let supported: HashMap<usize, usize> = joints().map(|joint| (joint.ends[1], joint.ends[0])).collect();
    let mut held = Vec::new();
    for restraint in constraints.restraints.iter().filter(|restraint| !model.nodes[restraint.node].is_number) {
        let (dof, motion) = (restraint.dof, restraint.motion.as_ref());
        match supported.get(&restraint.node) {
            // Equations measure rotations against this one, which rests.
            Some(_) if dof >= 3 => {}
            Some(&node) => held.push(Held { node, dof, motion, is_beside_free: false }),
            None => held.push(Held { node: restraint.node, dof, motion, is_beside_free: false }),
        }
    }
    for joint in joints() {
        let drive = joint.coordinate.as_ref().and_then(|coordinate| coordinate.drive);
        let motion = drive.and_then(|drive| {
            let at = constraints.restraints.iter().find(|restraint| restraint.node == drive.node)?;
            at.motion.as_ref()
        });
        for row in &joint.equations {
            if let ConstraintEquation::Given(angle) = row {
                held.push(Held { node: joint.ends[0], dof: 3 + angle.axis, motion, is_beside_free: true });
            }
        }
    }
    held
}

/// The common motion of the supports of one structure.
struct Found {
    frame: Option<MovingFrame>,
    /// Two supports that move differently.
    differ: Option<[usize; 2]>,
}

impl Found {
    fn of(held: &[Held], nodes: &[usize]) -> Found {
        let here = || held.iter().filter(|held| nodes.binary_search(&held.node).is_ok());
        let mut found = Found { frame: None, differ: None };
        if !here().any(|held| held.motion.is_some()) {
            return found;
        }
        let driven_rotation = here().find(|held| held.dof >= 3 && held.motion.is_some());
        let mut frame = MovingFrame { translation: [None; 3], rotation: None };
        let source = driven_rotation.map(|held| held.node);
        if let Some(node) = source {
            let own = || here().filter(|other| other.node == node && other.dof >= 3);
            // A held rotation beside a free one has a rate where its axis turns with the others.
            let turns = |dof: usize| {
                own().any(|other| other.dof == 3 + dof && (other.motion.is_some() || !other.is_beside_free))
            };
            let axes: Vec<usize> = own().filter(|other| other.motion.is_some()).map(|other| other.dof - 3).collect();
            // Others may guide along the axis alone.
            let against = |other: &&Held| {
                other.node != node && (if other.dof < 3 { axes != [other.dof] } else { other.motion.is_some() })
            };
            if let Some(other) = here().find(against) {
                found.differ = Some([node, other.node]);
                return found;
            }
            frame.rotation = Some((node, [turns(0), turns(1), turns(2)]));
        }
        for dof in 0..DIRECTIONS.len() / 2 {
            let mut along = here().filter(|held| held.dof == dof);
            let Some(first) = along.next() else { continue };
            match along.find(|other| other.motion != first.motion) {
                Some(other) => found.differ = found.differ.or(Some([first.node, other.node])),
                None if first.motion.is_some() => frame.translation[dof] = Some(source.unwrap_or(first.node)),
                None => {}
            }
        }
        found.frame = (frame.rotation.is_some() || frame.translation != [None; 3]).then_some(frame);
        found
    }
}

/// Nodes connected by parts, attachments and joints. Walls separate structures: nodes with all translations restrained.
struct Structures<'m> {
    model: &'m Model,
    parent: Vec<usize>,
    is_wall: Vec<bool>,
    /// Each node beside a wall, with the wall.
    beside: Vec<[usize; 2]>,
}

impl<'m> Structures<'m> {
    fn new(model: &'m Model) -> Structures<'m> {
        let mut held = vec![0; model.nodes.len()];
        model.constraints.restraints.iter().filter(|of| of.dof < 3).for_each(|of| held[of.node] += 1);
        let is_wall = held.into_iter().map(|held| held == 3).collect();
        let mut structures =
            Structures { model, parent: (0..model.nodes.len()).collect(), is_wall, beside: Vec::new() };
        for part in model.parts.iter().filter(|part| !part.kind().is_unilateral()) {
            (0..part.elements()).for_each(|element| structures.connect(part.nodes(element)));
        }
        for dependent in &model.constraints.dependents {
            structures.connect(&[dependent.node, dependent.master]);
        }
        model.constraints.joints.iter().for_each(|joint| structures.connect(&joint.all_ends().collect::<Vec<_>>()));
        structures
    }

    fn root(&mut self, node: usize) -> usize {
        let mut at = node;
        while self.parent[at] != at {
            self.parent[at] = self.parent[self.parent[at]];
            at = self.parent[at];
        }
        at
    }

    fn connect(&mut self, nodes: &[usize]) {
        let Some(&first) = nodes.iter().find(|&&node| !self.is_wall[node]) else { return };
        for &node in nodes {
            if self.is_wall[node] {
                self.beside.push([first, node]);
            } else {
                let [a, b] = [self.root(first), self.root(node)];
                self.parent[a.max(b)] = a.min(b);
            }
        }
    }

    /// The supported nodes of each structure, in ascending order.
    fn supports(&mut self, held: &[Held]) -> BTreeMap<usize, Vec<usize>> {
        let mut supports: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for [node, wall] in std::mem::take(&mut self.beside) {
            supports.entry(self.root(node)).or_default().push(wall);
        }
        for held in held {
            if !self.is_wall[held.node] {
                supports.entry(self.root(held.node)).or_default().push(held.node);
            }
        }
        for nodes in supports.values_mut() {
            nodes.sort_unstable();
            nodes.dedup();
        }
        supports
    }

    /// Warns of drives on parts with mass-proportional damping: the damping acts against their motion relative to the ground.
    fn warn_of_drives(&mut self, deck: &Deck, report: &mut Report) {
        let damped = self.damped();
        let is_driven = |joint: &&Joint| {
            let drive = joint.coordinate.as_ref().and_then(|coordinate| coordinate.drive);
            joint.origin == JointOrigin::Deck && drive.is_some_and(|drive| !drive.is_free)
        };
        let model = self.model;
        let mut brakes =
            |joint: &&Joint| joint.ends.iter().any(|&node| !self.is_wall[node] && damped.contains(&self.root(node)));
        let mut driven = model.constraints.joints.iter().filter(is_driven).filter(|joint| brakes(joint));
        let Some(first) = driven.next() else { return };
        let others = match driven.count() {
            0 => String::new(),
            1 => " and one other".to_owned(),
            more => format!(" and {more} others"),
        };
        let message = format!("`alpha` brakes what joint `{}`{others} drives, against the ground at rest", first.name);
        let hint = "give `damping = { alpha = 0.0 }` at a part to remove its brake; `beta` damps strain rates alone, and a support that moves \
                    carries its part";
        warn(model, deck, message, hint, report);
    }

    /// The structures with a mass that α brakes.
    fn damped(&mut self) -> HashSet<usize> {
        let model = self.model;
        let mut damped = HashSet::new();
        if model.damping.mass_factor > 0.0 {
            let nodes = model.bodies.iter().map(|body| body.node).chain(model.masses.iter().map(|mass| mass.node));
            damped.extend(nodes.map(|node| self.root(node)));
        }
        for part in model.parts.iter().filter(|part| is_damped(model, part)) {
            for element in 0..part.elements() {
                let free = part.nodes(element).iter().find(|&&node| !self.is_wall[node]);
                damped.extend(free.map(|&node| self.root(node)));
            }
        }
        damped
    }
}

/// True for a part with a mass that α brakes.
fn is_damped(model: &Model, part: &Part) -> bool {
    part.mass_kind().is_some_and(|kind| kind != MassKind::None) && model.damping.alpha(&part.own_damping()) > 0.0
}
