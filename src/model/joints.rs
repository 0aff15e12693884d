//! `[[joints]]`, and attachments and supports that elimination cannot do: rows of multipliers between two nodes.

use super::attachments::directions;
use super::build::{Builder, Owner, span};
use super::places::Spot;
use super::{AnalysisKind, Held, History, Joint};
use crate::constraints::joint::{Row, rotations, translations};
use crate::deck::joints::{Joint as Deck, Kind as Word};
use crate::diagnostic::Span;
use crate::math::{Mat3, Vec3};
use crate::names::short;

impl<'d> Builder<'d> {
    pub fn joints(&mut self) {
        for (index, joint) in self.deck.joints.iter().enumerate() {
            let name = joint.name.as_ref().map_or_else(|| format!("joints.{index}"), |name| name.value.clone());
            let owner = Owner { what: format!("joint `{name}`"), span: &joint.span };
            self.need(&owner, "name", &joint.name);
            let kind = self.need(&owner, "kind", &joint.kind).map(|kind| kind.value);
            let from = self.end(&owner, "from", &joint.from, &name, true, None);
            let place = from.map(|from| self.x(from)).filter(|_| kind != Some(Word::Distance));
            let to = self.end(&owner, "to", &joint.to, &name, true, place);
            let axes = kind.and_then(|kind| self.joint_axes(&owner, joint, kind));
            let (Some(kind), Some(ends), Some(axes)) = (kind, from.zip(to), axes) else { continue };
            let ends = [ends.0, ends.1];
            if let Some(rows) = self.joint_rows(&owner, kind, ends, &axes) {
                self.model.joints.push(Joint { name, ends, rows, supports: false });
            }
        }
    }

    /// Axes whose first is the joint's, whose second is that of its cross.
    fn joint_axes(&mut self, owner: &Owner<'d>, joint: &'d Deck, kind: Word) -> Option<Mat3> {
        let cross = [("cross_axis", span(&joint.cross_axis))];
        match kind {
            Word::Ball | Word::Fixed | Word::Distance => {
                let word = format!("a joint of kind \"{}\"", format!("{kind:?}").to_lowercase());
                self.stray(&word, &[("axis", span(&joint.axis)), cross[0]]);
                Some(Mat3::identity())
            }
            Word::Hinge | Word::Slider | Word::Cylinder => {
                self.stray("a joint with one axis", &cross);
                let axis = self.need(owner, "axis", &joint.axis)?;
                let x = self.unit("axis", axis)?;
                // The global axis the most square to it: which one is of no consequence.
                let y = x.cross(&Vec3::ith(x.iamin(), 1.0)).normalize();
                Some(Mat3::from_columns(&[x, y, x.cross(&y)]))
            }
            Word::Universal => {
                let axis = self.need(owner, "axis", &joint.axis);
                let cross = self.need(owner, "cross_axis", &joint.cross_axis);
                let x = axis.and_then(|axis| self.unit("axis", axis));
                let (Some(cross), Some(x)) = (cross, x) else { return None };
                let y = self.unit("cross_axis", cross)?;
                if x.dot(&y).abs() > 1e-6 {
                    return self.error(&cross.span, "`cross_axis` must be square to `axis`");
                }
                let y = (y - x * x.dot(&y)).normalize();
                Some(Mat3::from_columns(&[x, y, x.cross(&y)]))
            }
        }
    }

    fn joint_rows(&mut self, owner: &Owner<'d>, kind: Word, ends: [usize; 2], axes: &Mat3) -> Option<Vec<Row>> {
        if ends[0] == ends[1] {
            let node = &self.model.nodes[ends[0]].label;
            return self.error(owner.span, format!("{} joins `{node}` to itself", owner.what));
        }
        let d = self.x(ends[0]) - self.x(ends[1]);
        if kind == Word::Distance {
            if d.norm() == 0.0 {
                let message = format!("the ends of {} lie at the same place, so there is no distance", owner.what);
                return self.error_with(owner.span, message, "a \"ball\" holds two points together");
            }
            return Some(vec![Row::Distance { length: d.norm() }]);
        }
        // Of the scene's size, wherever it lies, and what rounding of coordinates leaves.
        let first = self.x(ends[0]);
        let far = |reach: f64, node: &super::Node| reach.max((node.x - first).amax());
        let size = self.model.nodes.iter().fold(0.0, far);
        if d.amax() > (1e-6 * size).max(4.0 * f64::EPSILON * first.amax()) {
            let message = format!("the ends of {} must lie at the same place", owner.what);
            let far = format!("they are {} apart; a body's `point` in `to` may be left out", short(d.norm()));
            return self.error_with(owner.span, message, far);
        }
        let meet = |rows: Vec<Row>| translations([true; 3], &d).chain(rows).collect();
        let slide = |rows: Vec<Row>| {
            let square = (1..3).map(|i| axes.column(i).into_owned()).map(|e| Row::Carried { e, at: d.dot(&e) });
            square.chain(rows).collect()
        };
        Some(match kind {
            Word::Ball | Word::Distance => meet(Vec::new()),
            Word::Hinge => meet(rotations([false, true, true], axes)),
            Word::Fixed => meet(rotations([true; 3], axes)),
            Word::Universal => meet(rotations([false, false, true], axes)),
            Word::Slider => slide(rotations([true; 3], axes)),
            Word::Cylinder => slide(rotations([false, true, true], axes)),
        })
    }

    /// Reports joints of the deck between things that cannot move against each other. The deck is sound otherwise.
    pub fn check_joints(&mut self) {
        let mut held = vec![[false; 6]; self.model.nodes.len()];
        self.model.held.iter().filter(|held| held.motion.is_none()).for_each(|h| held[h.node][h.dof] = true);
        for joint in &self.deck.joints {
            // By name: one may have been left out for what is wrong elsewhere, as in a mesh that could not be read.
            let named = |made: &Joint| joint.name.as_ref().is_some_and(|name| name.value == made.name);
            let Some(index) = self.model.joints.iter().position(named) else { continue };
            let ends = self.model.joints[index].ends.map(|node| self.carrier(node));
            let name = &self.model.joints[index].name;
            if ends[0] == ends[1] {
                let label = &self.model.nodes[ends[0]].label;
                let message = format!("both ends of joint `{name}` lie on `{label}`, so it holds nothing");
                self.error::<()>(&joint.span, message);
            } else if ends.iter().all(|&end| held[end] == [true; 6]) {
                self.error::<()>(&joint.span, format!("both ends of joint `{name}` are fixed, so it holds nothing"));
            }
        }
    }

    /// The node that a node rides on in every direction, in the end.
    fn carrier(&self, mut node: usize) -> usize {
        while let Some((rider, _)) = self.rides.get(&node)
            && self.model.riders[*rider].dofs == [true; 6]
        {
            node = self.model.riders[*rider].master;
        }
        node
    }

    /// Holds a node to a point of its own on a master, in the directions taken from it.
    pub fn join(&mut self, spot: &Spot, master: usize, to: &str, dofs: [bool; 6]) {
        let label = self.model.nodes[spot.node].label.clone();
        let there = self.rider(format!("{label} on {to}"), self.x(spot.node), master, spot.span);
        self.touch(there, true);
        self.touch(spot.node, dofs[3..].contains(&true));
        let rows = rows(dofs);
        self.model.joints.push(Joint {
            name: format!("{label} on {to}"),
            ends: [spot.node, there],
            rows,
            supports: false,
        });
    }

    /// Supports a node in directions in which it rides: on a point of its own, which is held.
    pub fn hold_rider(&mut self, spot: &Spot, dofs: &[(usize, Option<super::Motion>, &Span)]) {
        let ghost = match self.ghosts.get(&spot.node) {
            Some(&ghost) => ghost,
            None => {
                let label = self.model.nodes[spot.node].label.clone();
                let ghost = self.node(label, false, self.x(spot.node));
                self.ghosts.insert(spot.node, ghost);
                ghost
            }
        };
        let mut new = [false; 6];
        for (dof, motion, place) in dofs {
            if let Some(motion) = motion
                && self.model.analysis.kind == AnalysisKind::Dynamic
                && motion.history == History::Displacement
                && motion.scale * self.model.amplitudes[motion.amplitude].value(0.0) != 0.0
            {
                let message =
                    format!("the motion of `{}` does not begin at zero, but it rides on something", spot.name);
                self.error_with::<()>(place, message, "what it rides on starts where it is");
            }
            match self.held.get(&(ghost, *dof)) {
                Some((held, _)) if held.motion.is_some() || motion.is_some() => {
                    let what = directions([*dof]);
                    self.error::<()>(place, format!("two supports give the motion of `{}` in {what}", spot.name));
                }
                Some(_) => {}
                None => {
                    let held = Held { node: ghost, dof: *dof, motion: motion.clone() };
                    self.held.insert((ghost, *dof), (held, (*place).clone()));
                    new[*dof] = true;
                }
            }
        }
        if new != [false; 6] {
            let name = format!("{} on its support", self.model.nodes[spot.node].label);
            self.model.joints.push(Joint { name, ends: [spot.node, ghost], rows: rows(new), supports: true });
        }
    }
}

/// Rows between nodes at one place, about global axes at t = 0.
fn rows(dofs: [bool; 6]) -> Vec<Row> {
    let [x, y, z, rx, ry, rz] = dofs;
    translations([x, y, z], &Vec3::zeros()).chain(rotations([rx, ry, rz], &Mat3::identity())).collect()
}
