//! The frames relative to which Rayleigh's α acts: supports that move a structure as a whole carry what damps it.

use super::data::{DIRECTIONS, Model, MovingFrame, MovingFrames, Part, Restraint};
use super::report::Report;
use crate::deck::Deck;
use std::collections::BTreeMap;

/// Finds the frames of a model whose masses are damped, and warns where the supports of a structure move against each other.
pub fn moving_frames(model: &Model, deck: &Deck, report: &mut Report) -> MovingFrames {
    let acts = |part: &Part| part.mass_kind().is_some() && model.damping.alpha(&part.own_damping()) > 0.0;
    let moves = model.constraints.restraints.iter().any(|restraint| is_motion(model, restraint));
    if !moves || !(model.damping.mass_factor > 0.0 || model.parts.iter().any(acts)) {
        return MovingFrames::default();
    }
    let mut structures = Structures::new(model);
    let supports = structures.supports();
    let mut frames = MovingFrames { list: Vec::new(), of_node: vec![MovingFrames::NONE; model.nodes.len()] };
    let mut places = BTreeMap::new();
    for (root, nodes) in &supports {
        let found = Found::of(model, nodes);
        if let Some([one, other]) = found.differ {
            warn(model, deck, [one, other], report);
        }
        if let Some(frame) = found.frame {
            places.insert(*root, frames.list.len() as u32);
            frames.list.push(frame);
        }
    }
    for node in 0..model.nodes.len() {
        // A wall stands for itself.
        let own = structures.is_wall[node].then(|| Found::of(model, &[node]).frame).flatten();
        if let Some(frame) = own {
            frames.of_node[node] = frames.list.len() as u32;
            frames.list.push(frame);
        } else if !structures.is_wall[node] {
            frames.of_node[node] = places.get(&structures.root(node)).copied().unwrap_or(MovingFrames::NONE);
        }
    }
    if frames.list.is_empty() { MovingFrames::default() } else { frames }
}

fn is_motion(model: &Model, restraint: &Restraint) -> bool {
    restraint.motion.is_some() && !model.nodes[restraint.node].is_number
}

fn warn(model: &Model, deck: &Deck, nodes: [usize; 2], report: &mut Report) {
    let place = deck.damping.as_ref().map(|damping| damping.mass_factor.as_ref().map_or(&damping.span, |at| &at.span));
    let of_part = || deck.parts().find_map(|part| Some(&part.table.damping()?.alpha.as_ref()?.span));
    let Some(place) = place.or_else(of_part) else { return };
    let [one, other] = nodes.map(|node| &model.nodes[node].label);
    let message = format!(
        "the supports at `{one}` and `{other}` move differently, so `alpha` brakes velocities against the ground at rest"
    );
    report.warn(place, message, "`beta` damps strain rates alone: beta = 2 xi / omega for a ratio xi at omega");
}

/// What the supports of one structure have in common.
struct Found {
    frame: Option<MovingFrame>,
    /// Two supports that move differently.
    differ: Option<[usize; 2]>,
}

impl Found {
    fn of(model: &Model, nodes: &[usize]) -> Found {
        let restraints = || {
            let all = model.constraints.restraints.iter();
            all.filter(|restraint| nodes.binary_search(&restraint.node).is_ok())
        };
        let mut found = Found { frame: None, differ: None };
        if !restraints().any(|restraint| restraint.motion.is_some()) {
            return found;
        }
        let turning = restraints().find(|restraint| restraint.dof >= 3 && restraint.motion.is_some());
        let mut frame = MovingFrame { translation: [None; 3], rotation: None };
        let source = turning.map(|restraint| restraint.node);
        if let Some(node) = source {
            let turns = |dof: usize| restraints().any(|other| other.node == node && other.dof == 3 + dof);
            let moved = |other: &&Restraint| other.dof >= 3 && other.motion.is_some() && other.node == node;
            let axes: Vec<usize> = restraints().filter(moved).map(|other| other.dof - 3).collect();
            // Others may guide along the axis alone.
            let against = |other: &&Restraint| {
                other.node != node && (if other.dof < 3 { axes != [other.dof] } else { other.motion.is_some() })
            };
            if let Some(other) = restraints().find(against) {
                found.differ = Some([node, other.node]);
                return found;
            }
            frame.rotation = Some((node, [turns(0), turns(1), turns(2)]));
        }
        for dof in 0..DIRECTIONS.len() / 2 {
            let mut along = restraints().filter(|restraint| restraint.dof == dof);
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

/// Nodes that parts, attachments and joints connect, apart from walls: nodes whose place supports hold or move.
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
        model.constraints.joints.iter().for_each(|joint| structures.connect(&joint.ends));
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
    fn supports(&mut self) -> BTreeMap<usize, Vec<usize>> {
        let mut supports: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for [node, wall] in std::mem::take(&mut self.beside) {
            supports.entry(self.root(node)).or_default().push(wall);
        }
        for restraint in &self.model.constraints.restraints {
            if !self.is_wall[restraint.node] && !self.model.nodes[restraint.node].is_number {
                supports.entry(self.root(restraint.node)).or_default().push(restraint.node);
            }
        }
        for nodes in supports.values_mut() {
            nodes.sort_unstable();
            nodes.dedup();
        }
        supports
    }
}
