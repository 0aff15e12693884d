//! `[[supports]]`: directions whose motion is given.

pub mod given_rotations;
mod in_axes;

use super::data::{Actors, DIRECTIONS, History, Joint, PrescribedMotion};
use super::joints::equations;
use super::places::axes::axes;
use super::places::nodes::Topology;
use super::places::spot::Spot;
use super::procedure::stops::NamedActors;
use super::report::{Owner, Report};
use super::scene::{Reach, Scene};
use super::stages::CurrentStage;
use super::values::{chosen, keys};
use base::diagnostic::At;
use base::math::Mat3;
use deck::supports as words;
use deck::words::Table;
use given_rotations::{GivenRotations, TurnSetting, TurnedNode};
use in_axes::{GivenDirection as Given, HeldDirections, SupportInAxes};
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
    let held = HeldDirections::default();
    let of_others = scene.stage.iter().flat_map(CurrentStage::ends_elsewhere);
    let ends = of_others.filter_map(|name| scene.names.point("node", name, &scene.parts, report));
    topology.ends_elsewhere = ends.collect();
    let mut tables = Supports { scene, amplitudes, topology, support_points, joints, moved, rotations, held, report };
    let mut named = Vec::new();
    // Supports with axes see which nodes the others hold.
    let (in_axes, others): (Vec<_>, Vec<_>) = scene.deck.supports.iter().partition(|support| support.axes.is_some());
    for support in others.into_iter().chain(in_axes) {
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
    /// The directions held at nodes of supports with axes.
    held: HeldDirections,
    report: &'a mut Report<'d>,
}

impl<'d> Supports<'_, 'd> {
    fn support(&mut self, support: &'d At<Table<words::Support>>) {
        let owner = Owner::new("`[[supports]]`", &support.span);
        let spots = self.scene.spots(&owner, "at", &support.at, Reach::Parts, self.report);
        let spots = if support.motion.is_none() { self.without_resting(spots) } else { spots };
        let spots = self.topology.without_loose(spots, "this support", self.report);
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
        if let Some(at) = &support.axes {
            let rotation = support.rotation.as_ref().map(|at| &at.span);
            self.report.reject_unused("a support with `axes`", &[("rotation", rotation)]);
            let motions_of = support.motion.iter().flat_map(|motions| motions.each()).flatten();
            if let Some(to) = motions_of.filter_map(|motion| motion.to.as_ref()).next() {
                let hint = "give `scale`, which counts from where the stage finds the node";
                self.report.error_with::<()>(&to.span, "`to` does not go with `axes`", hint);
            }
            if let Some(axes) = axes(at, self.report) {
                self.hold_in_axes(&spots, &axes, fixed, &motions);
            }
            return;
        }
        let turns = fixed[3..].contains(&true) || motions.iter().any(|(dof, ..)| *dof > 2);
        if let (Some(word), false, false) = (&support.rotation, turns, unread) {
            let hint = "leave it out, or give rotations in `fix` or `motion`";
            self.report.error_with::<()>(&word.span, "`rotation` needs a rotation that this support gives", hint);
        }
        for spot in &spots {
            if !self.topology.is_loose(spot, "this support", self.report) {
                self.restrain(spot, fixed, &motions);
                self.aim(spot.node, support);
                if turns {
                    self.rotations.note(spot, support.rotation.as_ref(), self.report);
                }
            }
        }
    }

    /// The spots that this support holds. A support that moves nothing rests where links and joints of other stages alone end.
    fn without_resting(&mut self, spots: Vec<Spot<'d>>) -> Vec<Spot<'d>> {
        let is_free = |node: usize| (0..6).all(|dof| !self.topology.is_taken(node, dof));
        let rests = |spot: &Spot| self.topology.ends_elsewhere.contains(&spot.node) && is_free(spot.node);
        let (resting, spots): (Vec<Spot>, Vec<Spot>) = spots.into_iter().partition(rests);
        if let Some(first) = resting.first() {
            let others = if resting.len() > 1 { format!(" and {} more", resting.len() - 1) } else { String::new() };
            let about = format!("this support holds nothing at `{}`{others} in this stage", first.name);
            let hint = "links and joints of other stages end there: `stages` of the support can name theirs";
            self.report.note(first.span, about, hint);
        }
        spots
    }

    /// Holds and moves nodes along axes that are not global ones.
    fn hold_in_axes(&mut self, spots: &[Spot<'d>], axes: &Mat3, fixed: [bool; 6], motions: &[Given<'d>]) {
        if let Some((dof, _, place)) = motions.iter().find(|(dof, ..)| *dof > 2) {
            let message = format!("`axes` do not turn the motion in {}", DIRECTIONS[*dof]);
            let hint = "give rotations that move in a support of their own, about global axes";
            self.report.error_with::<()>(place, message, hint);
            return;
        }
        for (_, motion, place) in motions {
            let displaced = motion.as_ref().is_some_and(|motion| {
                motion.history == History::Displacement
                    && motion.scale * self.amplitudes[motion.amplitude].value(0.0) != 0.0
            });
            if displaced && self.scene.analysis.is_dynamic() && self.scene.analysis.begin == 0.0 {
                let message = "a motion along `axes` does not begin at zero";
                self.report.error_with::<()>(
                    place,
                    message,
                    "let the amplitude begin at zero: nodes start undisplaced",
                );
            }
        }
        let turned = [3, 4, 5].map(|dof| fixed[dof]);
        for spot in spots {
            let mut fixed = fixed;
            if self.topology.is_loose(spot, "this support", self.report) {
                continue;
            }
            if turned == [true; 3] {
                // All three rotations are the same about any axes.
                self.restrain(spot, [false, false, false, true, true, true], &[]);
                fixed[3..].fill(false);
            }
            let support = SupportInAxes { axes, fixed, motions };
            let (moved, given_twice) = support.hold(spot, &mut self.held, (self.topology, self.joints));
            self.moved.extend(moved);
            if let Some(place) =
                given_twice.and_then(|k| motions.iter().find(|(dof, ..)| *dof == k)).map(|given| given.2)
            {
                let message = format!("two supports prescribe the motion of `{}` along this axis", spot.name);
                self.report.error_with::<()>(place, message, "remove one of the two motions");
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

    /// Notes where the motions of a node end.
    fn aim(&mut self, node: usize, support: &words::Support) {
        let held = self.support_points.get(&node).copied().unwrap_or(node);
        let motions = support.motion.iter().flat_map(|motions| motions.each()).enumerate();
        let targets = motions.filter_map(|(dof, motion)| Some(([held, dof], motion.as_ref()?.to.as_ref()?.value)));
        self.topology.targets.extend(targets);
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
            let to = self.target(motion, (dof, own.is_some()));
            let scale = to.or(motion.scale.as_ref().map(|scale| scale.value)).unwrap_or(1.0);
            let Some(amplitude) = amplitude else { continue };
            let amplitude = self.scene.amplitude_of_motion(amplitude, history);
            read.push((dof, Some(PrescribedMotion { amplitude, scale, history }), &motion.span));
        }
        read
    }

    /// The displacement at which a motion ends, where the deck gives one.
    fn target(&mut self, motion: &'d At<Table<words::Motion>>, (dof, in_stage): (usize, bool)) -> Option<f64> {
        let to = motion.to.as_ref()?;
        let others = keys!(motion; amplitude, scale, history);
        let hint = "it leads to a displacement from t = 0, whatever a static stage begins with";
        if let Some((key, at)) = others.into_iter().find_map(|(key, at)| Some((key, at?))) {
            self.report.error_with::<()>(at, format!("`to` takes no `{key}` beside it"), hint);
        } else if dof > 2 {
            self.report.error_with::<()>(
                &to.span,
                format!("`to` does not lead {}", DIRECTIONS[dof]),
                "it is for ux, uy and uz",
            );
        } else if !in_stage {
            let hint = "give `amplitude` and `scale`, which count from t = 0 in a deck without stages";
            self.report.error_with::<()>(&to.span, "`to` needs a support that first acts in a static stage", hint);
        }
        Some(to.value)
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
