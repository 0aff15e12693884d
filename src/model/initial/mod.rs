//! `[[initial]]`: motion at t = 0, as the tables say, then made to agree with supports and attachments.

pub mod given_velocities;

use crate::data::{DependentNode, GivenVelocity, InitialMotion, PlaceFactor};
use crate::initial::given_velocities::{GivenVelocities, Giver, InitialQuantity};
use crate::places::nodes::Topology;
use crate::places::spot::{Label, Spot};
use crate::report::{Owner, Report};
use crate::scene::{Reach, Scene};
use crate::values::{flag, keys, vec3, vec3_or_zero};
use base::diagnostic::At;
use base::math::Vec3;
use deck::initial::{Initial, Profile};
use deck::words::Table;
use mechanics::amplitude::Amplitude;
use std::collections::HashSet;
use std::sync::Arc;

/// Gives nodes their initial velocities.
pub fn initial<'d>(scene: &Scene<'d>, amplitudes: &[Amplitude], topology: &mut Topology, report: &mut Report<'d>) {
    let mut motions = Motions { scene, amplitudes, topology, given: GivenVelocities::default(), report };
    motions.of_bodies();
    scene.deck.initial.iter().enumerate().for_each(|(index, initial)| motions.initial_motion(index, initial));
    motions.given.report_contradictions(motions.topology, motions.report);
    stop_restrained(topology);
    move_dependents(topology);
    refuse_idle_speeds(scene, topology, report);
}

/// Refuses `speeds` of a scene that has no spin.
fn refuse_idle_speeds(scene: &Scene, topology: &Topology, report: &mut Report) {
    let speeds = scene.deck.analysis.as_ref().and_then(|analysis| analysis.speeds.as_ref());
    let Some(speeds) = speeds.filter(|_| topology.is_complete()) else { return };
    if topology.list.iter().all(|node| node.omega == Vec3::zeros()) {
        let hint = "give the rotor an `angular_velocity`, in `[[bodies]]` or `[[initial]]`: its direction counts";
        report.error_with::<()>(&speeds.span, "nothing spins at t = 0, so `speeds` rotates nothing", hint);
    }
}

struct Motions<'a, 'd> {
    scene: &'a Scene<'d>,
    amplitudes: &'a [Amplitude],
    topology: &'a mut Topology,
    given: GivenVelocities<'d>,
    report: &'a mut Report<'d>,
}

impl<'d> Motions<'_, 'd> {
    /// The velocities that bodies have in their own tables.
    fn of_bodies(&mut self) {
        let scene = self.scene;
        for (body, made) in scene.deck.bodies.iter().zip(&scene.bodies) {
            let values = [
                (&body.velocity, InitialQuantity::Velocity),
                (&body.angular_velocity, InitialQuantity::AngularVelocity),
            ];
            for (value, quantity) in values {
                let Some(value) = value else { continue };
                let what = format!("the table of body `{}`", made.name);
                self.given.begin(Giver { what, span: &value.span, replaces: false });
                let motion = InitialMotion { v: vec3(value), omega: vec3(value), ..InitialMotion::default() };
                let by = GivenVelocity { motion: Arc::new(motion), normal: Vec3::zeros() };
                self.given.give(made.node, quantity, by, self.topology);
                if let Some(name) = &body.name {
                    let spot = Spot { node: made.node, name: Label::Name(name), span: &value.span, direct: true };
                    self.given.report_dropped(&[spot], &[quantity], self.amplitudes, self.topology, self.report);
                }
            }
        }
    }

    fn initial_motion(&mut self, index: usize, initial: &'d At<Table<Initial>>) {
        let owner = Owner::new("`[[initial]]`", &initial.span);
        let everything = initial.at.as_ref().is_some_and(|at| at.values.iter().any(|name| name.value == "all"));
        let spots = if everything {
            Vec::new()
        } else {
            self.scene.spots(&owner, "at", &initial.at, Reach::Parts, self.report)
        };
        self.moves_by_itself(&spots);
        let nodes: Vec<usize> = match everything {
            true => (0..self.topology.list.len()).filter(|&node| !self.topology.list[node].is_number).collect(),
            false => spots.iter().map(|spot| spot.node).collect(),
        };
        self.check_keys(&owner, initial);
        let replaces = flag(&initial.replaces, false);
        self.given.begin(Giver { what: title(index, initial), span: owner.span, replaces });
        self.give(initial, nodes, &spots);
        let quantities = given(initial);
        self.given.report_dropped(&spots, &quantities, self.amplitudes, self.topology, self.report);
        if initial.angular_velocity.is_some() && initial.about.is_none() && self.topology.is_complete() {
            self.given.report_without_rotation(&spots, self.topology, self.report);
        }
    }

    /// Reports empty tables and contradictory keys.
    fn check_keys(&mut self, owner: &Owner<'d>, initial: &'d At<Table<Initial>>) {
        let words = ["velocity", "angular_velocity", "normal_velocity"];
        let unread = words.iter().any(|key| self.report.is_spoiled(owner.span, key));
        let normal = initial.normal_velocity.as_ref();
        if initial.velocity.is_none() && initial.angular_velocity.is_none() && normal.is_none() && !unread {
            let hint = "give it `velocity`, `angular_velocity` or `normal_velocity`";
            self.report.error_with::<()>(owner.span, "this initial motion is empty", hint);
        }
        if normal.is_some() {
            let others = keys!(initial; velocity, about);
            self.report.reject_unused("a velocity along normals", &others);
        } else if let (Some(_), Some(profile)) = (&initial.about, &initial.profile) {
            self.report.reject_unused("the motion of a rigid body", &[("profile", Some(&profile.span))]);
        }
    }

    /// Gives nodes the velocities of a table.
    fn give(&mut self, initial: &'d At<Table<Initial>>, nodes: Vec<usize>, spots: &[Spot<'d>]) {
        let normal = initial.normal_velocity.as_ref();
        let profile = initial.profile.as_ref().map_or(&[][..], |profile| &profile.value);
        let factors: Vec<PlaceFactor> = profile.iter().filter_map(|entry| self.factor(entry)).collect();
        let normals = normal.map(|_| self.normals(spots));
        let motion = Arc::new(InitialMotion {
            v: vec3_or_zero(&initial.velocity),
            omega: vec3_or_zero(&initial.angular_velocity),
            about: initial.about.as_ref().map(|about| vec3(about)),
            normal_speed: normal.map(|normal| normal.value),
            factors,
        });
        let quantities = given(initial);
        for node in nodes {
            let normal = normals.as_ref().map_or(Vec3::zeros(), |normals| normals[node]);
            for &quantity in &quantities {
                let by = GivenVelocity { motion: motion.clone(), normal };
                self.given.give(node, quantity, by, self.topology);
            }
        }
    }

    /// Reports named dependent nodes, and names with only nodes dependent on unnamed masters.
    fn moves_by_itself(&mut self, spots: &[Spot<'d>]) {
        for spot in spots.iter().filter(|spot| spot.direct) {
            if let Some(master) = self.topology.master_in(spot.node, 0) {
                let master = self.topology.label(master);
                let message = format!("`{}` moves with `{master}`", spot.name);
                self.report.error_with::<()>(spot.span, message, format!("give the velocity to `{master}`"));
            }
        }
        let named: HashSet<usize> = spots.iter().map(|spot| spot.node).collect();
        for spots in spots.chunk_by(|a, b| a.span == b.span).filter(|spots| !spots[0].direct) {
            let masters: Option<Vec<usize>> = spots.iter().map(|spot| self.topology.master_in(spot.node, 0)).collect();
            if let Some(&[master, ..]) = masters.as_deref().filter(|m| m.iter().all(|node| !named.contains(node))) {
                let master = self.topology.label(master);
                let message = format!("all of this moves with `{master}`");
                self.report.error_with::<()>(spots[0].span, message, format!("give the velocity to `{master}`"));
            }
        }
    }

    fn factor(&mut self, profile: &'d At<Table<Profile>>) -> Option<PlaceFactor> {
        let owner = Owner::new("an entry of `profile`", &profile.span);
        let amplitude = self
            .report
            .require(&owner, "amplitude", &profile.amplitude)
            .and_then(|name| self.report.find("amplitude", &self.scene.deck.amplitudes, name));
        if let (Some((index, _)), Some(name)) = (&amplitude, &profile.amplitude)
            && self.scene.deck.amplitudes.0[*index].1.stage.is_some()
        {
            let message = format!("`{}` counts from a stage, and a profile is a function of place", name.value);
            self.report.error_with::<()>(&name.span, message, "give it an amplitude without `stage`");
        }
        let direction = self.report.require(&owner, "direction", &profile.direction);
        let mut unit = direction.and_then(|direction| self.report.unit("direction", direction));
        let axis = match &profile.axis {
            Some(axis) => Some(self.report.unit("axis", axis)?),
            None => None,
        };
        if let (Some(axis), Some(from), Some(at)) = (axis, unit, direction) {
            let across = from - from.dot(&axis) * axis;
            if across.norm() < 1e-9 {
                return self.report.error(&at.span, "`direction` lies along `axis`, but must have a part across it");
            }
            unit = Some(across.normalize());
        }
        let amplitude = self.amplitudes[amplitude?.0].clone();
        Some(PlaceFactor { amplitude, center: vec3_or_zero(&profile.center), direction: unit?, axis })
    }

    /// The unit normal of shells at each node, zero without a shell; that is an error for nodes of the list.
    fn normals(&mut self, spots: &[Spot<'d>]) -> Vec<Vec3> {
        let mut normals = vec![Vec3::zeros(); self.topology.list.len()];
        for part in &self.scene.parts.list {
            for element in 0..part.elements() {
                for (&node, normal) in part.nodes(element).iter().zip(part.normals(element)) {
                    normals[node] += normal;
                }
            }
        }
        let sure = self.topology.is_complete();
        for spot in spots.iter().filter(|spot| sure && normals[spot.node] == Vec3::zeros()) {
            let message = format!("no shell has a normal at `{}`", spot.name);
            self.report.error_with::<()>(spot.span, message, "name shells or their edges");
        }
        normals.iter().map(|normal| normal.try_normalize(0.0).unwrap_or_default()).collect()
    }
}

/// The quantities of a table; a rigid motion has both a velocity and an angular velocity.
fn given(initial: &Initial) -> Vec<InitialQuantity> {
    let rigid = initial.about.is_some();
    let velocity = rigid || initial.velocity.is_some() || initial.normal_velocity.is_some();
    let angular = rigid || initial.angular_velocity.is_some();
    let both = [(velocity, InitialQuantity::Velocity), (angular, InitialQuantity::AngularVelocity)];
    both.into_iter().filter(|(is_given, _)| *is_given).map(|(_, quantity)| quantity).collect()
}

/// Words for a table in messages: "entry 2 of `[[initial]]` (at `edge`)".
fn title(index: usize, initial: &Initial) -> String {
    let names = initial.at.as_ref().map_or(&[][..], |at| &at.values);
    let more = if names.len() > 1 { ", ..." } else { "" };
    let at = names.first().map_or_else(String::new, |name| format!(" (at `{}`{more})", name.value));
    format!("entry {} of `[[initial]]`{at}", index + 1)
}

/// Sets the initial velocities of restrained degrees of freedom to zero.
fn stop_restrained(topology: &mut Topology) {
    let rests: Vec<[usize; 2]> = topology
        .restraints()
        .filter(|restraint| restraint.motion.is_none())
        .map(|restraint| [restraint.node, restraint.dof])
        .collect();
    for [node, dof] in rests {
        let node = &mut topology.list[node];
        match dof {
            0..3 => node.v[dof] = 0.0,
            _ => node.omega[dof - 3] = 0.0,
        }
    }
}

/// Gives dependent nodes the initial velocities that follow from their masters', masters first.
fn move_dependents(topology: &mut Topology) {
    let mut done = vec![false; topology.dependents.len()];
    for start in 0..done.len() {
        let (mut chain, mut next) = (Vec::new(), Some(start));
        while let Some(index) = next.filter(|&index| !std::mem::replace(&mut done[index], true)) {
            chain.push(index);
            next = topology.attachment(topology.dependents[index].master);
        }
        for index in chain.into_iter().rev() {
            let DependentNode { node, master, dofs, .. } = topology.dependents[index];
            let omega = topology.list[master].omega;
            let v = topology.list[master].v + omega.cross(&(topology.x(node) - topology.x(master)));
            let node = &mut topology.list[node];
            for i in 0..3 {
                if dofs[i] {
                    node.v[i] = v[i];
                }
                if dofs[3 + i] {
                    node.omega[i] = omega[i];
                }
            }
        }
    }
}
