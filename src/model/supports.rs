//! `[[supports]]`: directions whose motion is given.

pub mod given_rotations;

use super::data::{Actors, DIRECTIONS, History, Joint, PrescribedMotion};
use super::joints::equations;
use super::places::nodes::Topology;
use super::places::spot::Spot;
use super::procedure::stops::NamedActors;
use super::report::{Owner, Report};
use super::scene::{Reach, Scene};
use super::values::chosen;
use base::diagnostic::{At, Span};
use deck::supports as words;
use deck::words::Table;
use given_rotations::{GivenRotations, TurnSetting, TurnedNode};
use mechanics::amplitude::Amplitude;
use std::collections::HashMap;

/// Restrains nodes, and adds the joints that hold dependent nodes to their supports. Returns the motions by the names of their supports, and the
/// nodes whose rotations are given together.
pub(super) fn supports<'d>(
    scene: &Scene<'d>,
    amplitudes: &[Amplitude],
    (topology, joints): (&mut Topology, &mut Vec<Joint>),
    report: &mut Report<'d>,
) -> (NamedActors<'d>, Vec<TurnedNode>) {
    let (support_points, moved, rotations) = (HashMap::new(), Vec::new(), GivenRotations::default());
    let mut tables = Supports { scene, amplitudes, topology, support_points, joints, moved, rotations, report };
    let mut named = Vec::new();
    for support in &scene.deck.supports {
        tables.support(support);
        let motions = std::mem::take(&mut tables.moved);
        if let Some(name) = support.name.as_ref().filter(|_| !motions.is_empty()) {
            named.push((name, Actors { motions, ..Actors::default() }));
        }
    }
    let Supports { topology, support_points, joints, rotations, report, .. } = tables;
    let setting = TurnSetting { scene, amplitudes, topology, joints, support_points, report };
    let together = rotations.take(setting, &mut named);
    (named, together)
}

/// A direction given by a support: with its motion (`None` for rest) and its place in the deck.
type Given<'d> = (usize, Option<PrescribedMotion>, &'d Span);

struct Supports<'a, 'd> {
    scene: &'a Scene<'d>,
    amplitudes: &'a [Amplitude],
    topology: &'a mut Topology,
    /// For each supported dependent node, the node restrained in its place.
    support_points: HashMap<usize, usize>,
    joints: &'a mut Vec<Joint>,
    /// Nodes and directions moved by the current support.
    moved: Vec<[usize; 2]>,
    /// The nodes whose rotations are given.
    rotations: GivenRotations<'d>,
    report: &'a mut Report<'d>,
}

impl<'d> Supports<'_, 'd> {
    fn support(&mut self, support: &'d At<Table<words::Support>>) {
        let owner = Owner::new("`[[supports]]`", &support.span);
        let spots = self.scene.spots(&owner, "at", &support.at, Reach::Parts, self.report);
        let mut motions = support.motion.as_ref().map_or_else(Vec::new, |motions| self.motions(support, motions));
        let fixed = support.fix.as_ref().map_or([false; 6], |fix| fix.0);
        let unread = self.report.is_spoiled(owner.span, "fix") || self.report.is_spoiled(owner.span, "motion");
        if fixed == [false; 6] && support.motion.is_none() && !unread {
            let place = support.fix.as_ref().map_or(owner.span, |fix| &fix.span);
            self.report.error_with::<()>(place, "this support restrains nothing", "give it `fix` or `motion`");
        }
        for (dof, _, place) in motions.extract_if(.., |(dof, ..)| fixed[*dof]) {
            let message = format!("{} is both fixed and prescribed by this support", DIRECTIONS[dof]);
            self.report.error_with::<()>(
                place,
                message,
                "list the other directions in `fix`, such as [\"uy\", \"uz\"]",
            );
        }
        let turns = fixed[3..].contains(&true) || motions.iter().any(|(dof, ..)| *dof > 2);
        if let (Some(word), false, false) = (&support.rotation, turns, unread) {
            let hint = "leave it out, or give rotations in `fix` or `motion`";
            self.report.error_with::<()>(&word.span, "`rotation` needs a rotation that this support gives", hint);
        }
        for spot in &spots {
            if !self.topology.is_loose(spot, "this support", self.report) {
                self.restrain(spot, fixed, &motions);
                if turns {
                    self.rotations.note(spot, support.rotation.as_ref(), self.report);
                }
            }
        }
    }

    /// Restrains a node in the fixed or moved directions; dependent directions are restrained by a joint.
    fn restrain(&mut self, spot: &Spot<'d>, fixed: [bool; 6], motions: &[Given<'d>]) {
        let node = spot.node;
        let dependent: [bool; 6] = std::array::from_fn(|dof| self.topology.master_in(node, dof).is_some());
        let fixes = (0..6).filter(|&dof| fixed[dof]).map(|dof| (dof, None, spot.span));
        let given = fixes.chain(motions.iter().cloned());
        let (of_dependent, own): (Vec<Given>, Vec<Given>) = given.partition(|(dof, ..)| dependent[*dof]);
        if !of_dependent.is_empty() {
            self.restrain_dependent(spot, &of_dependent);
        }
        for given in own {
            let (dof, place) = (given.0, given.2);
            if given.1.is_none() || self.topology.is_taken(node, dof) {
                self.restrain_in(spot, node, given);
            } else if self.topology.is_complete() {
                let message =
                    format!("nothing connected to `{}` has the degree of freedom {}", spot.name, DIRECTIONS[dof]);
                self.report.error_with::<()>(place, message, "remove it, or connect a part that has it");
            }
        }
    }

    /// The motions of a support.
    fn motions(&mut self, support: &'d words::Support, motions: &'d At<Table<words::Motions>>) -> Vec<Given<'d>> {
        let own = self.scene.stage.filter(|stage| stage.begins_static(&support.stages));
        let own = own.map(|stage| stage.own_amplitude(&support.stages));
        let given = motions.each();
        if given.iter().all(|motion| motion.is_none()) && !self.report.is_any_spoiled(&motions.span) {
            let hint = "such as { ux = { amplitude = \"quake\" } }";
            self.report.error_with::<()>(&motions.span, "`motion` is empty", hint);
        }
        let mut read = Vec::new();
        for (dof, motion) in given.into_iter().enumerate() {
            let Some(motion) = motion else { continue };
            let owner = Owner::new(format!("the motion in {}", DIRECTIONS[dof]), &motion.span);
            let amplitude = match (&motion.amplitude, own) {
                (None, Some(own)) if !self.report.is_spoiled(owner.span, "amplitude") => Some(own),
                (given, _) => {
                    let name = self.report.require(&owner, "amplitude", given);
                    let found = name.and_then(|name| self.report.find("amplitude", &self.scene.deck.amplitudes, name));
                    found.map(|(index, _)| index)
                }
            };
            let history: History = chosen(&motion.history);
            if let Some(at) = &motion.history
                && self.scene.analysis.is_static()
                && amplitude.is_none_or(|i| self.amplitudes[i].harmonic_phase().is_none())
                && history != History::Displacement
            {
                self.report.error::<()>(&at.span, "a static analysis takes `history = \"displacement\"` only");
            }
            let scale = motion.scale.as_ref().map_or(1.0, |scale| scale.value);
            let Some(amplitude) = amplitude else { continue };
            let amplitude = self.scene.amplitude_of_motion(amplitude, history);
            read.push((dof, Some(PrescribedMotion { amplitude, scale, history }), &motion.span));
        }
        read
    }

    /// Restrains a node, named by `spot`, in a direction; returns true if it was free before. Two supports may fix the same direction; if
    /// one of them moves it, they contradict each other.
    fn restrain_in(&mut self, spot: &Spot, node: usize, (dof, motion, place): Given) -> bool {
        match self.topology.restraint(node, dof) {
            Some(restraint) if restraint.motion.is_some() || motion.is_some() => {
                let message = format!("two supports prescribe the motion of `{}` in {}", spot.name, DIRECTIONS[dof]);
                self.report.error_with::<()>(place, message, "remove one of the two");
                false
            }
            Some(_) => false,
            None => {
                self.moved.extend(motion.as_ref().map(|_| [node, dof]));
                self.topology.restrain(node, dof, motion);
                true
            }
        }
    }

    /// Supports a node in dependent directions, by a joint to a new restrained point.
    fn restrain_dependent(&mut self, spot: &Spot, given: &[Given]) {
        let support_point = *self.support_points.entry(spot.node).or_insert_with(|| {
            let (label, x) = (self.topology.label(spot.node).to_owned(), self.topology.x(spot.node));
            self.topology.add(label, false, x)
        });
        let mut new = [false; 6];
        for (dof, motion, place) in given {
            if let Some(motion) = motion
                && self.scene.analysis.is_dynamic()
                && self.scene.analysis.begin == 0.0
                && motion.history == History::Displacement
                && motion.scale * self.amplitudes[motion.amplitude].value(0.0) != 0.0
            {
                let message =
                    format!("the motion of `{}` does not begin at zero, but it is attached to something", spot.name);
                self.report.error_with::<()>(
                    place,
                    message,
                    "let the amplitude begin at zero: the attached parts start undisplaced",
                );
            }
            new[*dof] |= self.restrain_in(spot, support_point, (*dof, motion.clone(), place));
        }
        if new != [false; 6] {
            let name = format!("{} on its support", self.topology.label(spot.node));
            self.joints.push(Joint::new(name, [spot.node, support_point], equations(new), true));
        }
    }
}
