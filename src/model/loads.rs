//! `[amplitudes.x]`, `[[loads]]`, `[environment]`, `[damping]`.

use super::attachments::directions;
use super::build::{Builder, Owner, span, vec3_or_zero};
use super::places::{Place, Reach, Spot};
use super::{BaseAcceleration, Damping, Load, NodalDamping, Pressure};
use crate::amplitude::Amplitude;
use crate::deck::amplitudes as deck;
use crate::deck::loads::Load as Spread;
use crate::deck::words::Table;
use crate::diagnostic::At;
use crate::elements::pressure::Face;
use crate::elements::shell;
use crate::math::Vec3;
use std::collections::{BTreeMap, HashSet};

impl<'d> Builder<'d> {
    /// One for each of the deck, also for those with errors: others refer to them.
    pub fn amplitudes(&mut self) {
        for (name, amplitude) in &self.deck.amplitudes.0 {
            let read = self.read_amplitude(&name.value, amplitude).unwrap_or(Amplitude::Constant);
            self.model.amplitudes.push(read);
        }
    }

    fn read_amplitude(&mut self, name: &str, amplitude: &'d At<Table<deck::Amplitude>>) -> Option<Amplitude> {
        let a = amplitude;
        let owner = Owner { what: format!("amplitude `{name}`"), span: &a.span };
        let kind = self.need(&owner, "kind", &a.kind)?.value;
        let points = [("points", span(&a.points))];
        let waves = [("frequency", span(&a.frequency)), ("angular_frequency", span(&a.angular_frequency))];
        let phase = [("phase", span(&a.phase))];
        let window = [("start", span(&a.start)), ("end", span(&a.end))];
        let start = a.start.as_ref().map_or(0.0, |start| start.value);
        let end = a.end.as_ref().map_or(f64::INFINITY, |end| end.value);
        if let Some(at) = &a.end
            && end <= start
        {
            self.error::<()>(&at.span, format!("`end` must come after `start`, which is {start}"));
        }
        match kind {
            deck::AmplitudeKind::Table => {
                self.stray("a table", &[&waves[..], &phase, &window].concat());
                let points = self.need(&owner, "points", &a.points)?;
                self.rising("time", points).map(|points| Amplitude::Table { points })
            }
            deck::AmplitudeKind::Sine => {
                self.stray("a sine", &points);
                let angular_frequency = self.angular_frequency(&owner, a)?;
                let phase = a.phase.as_ref().map_or(0.0, |phase| phase.value);
                Some(Amplitude::Sine { angular_frequency, phase, start, end })
            }
            deck::AmplitudeKind::SineSquared => {
                self.stray("a sine squared", &[points, phase].concat());
                let angular_frequency = self.angular_frequency(&owner, a)?;
                Some(Amplitude::SineSquared { angular_frequency, start, end })
            }
            deck::AmplitudeKind::Ramp => {
                self.stray("a ramp", &[&points[..], &waves, &phase].concat());
                self.need(&owner, "end", &a.end)?;
                Some(Amplitude::Ramp { start, end })
            }
            deck::AmplitudeKind::Step => {
                self.stray("a step", &[&points[..], &waves, &phase].concat());
                Some(Amplitude::Step { start, end })
            }
            deck::AmplitudeKind::Constant => {
                self.stray("a constant", &[&points[..], &waves, &phase, &window].concat());
                Some(Amplitude::Constant)
            }
        }
    }

    /// Radians per time.
    fn angular_frequency(&mut self, owner: &Owner<'d>, a: &'d deck::Amplitude) -> Option<f64> {
        match (&a.frequency, &a.angular_frequency) {
            (Some(_), Some(angular)) => {
                self.error(&angular.span, format!("{} takes `frequency` or `angular_frequency`, not both", owner.what))
            }
            (None, Some(_)) => self.positive("angular_frequency", &a.angular_frequency),
            _ if self.is_spoiled(owner.span, "angular_frequency") => None,
            _ => self.need_positive(owner, "frequency", &a.frequency).map(|hertz| std::f64::consts::TAU * hertz),
        }
    }

    pub fn loads(&mut self) {
        for load in &self.deck.loads {
            if load.force_per_length.is_some() || load.force_per_area.is_some() || load.pressure.is_some() {
                self.spread_load(load);
                continue;
            }
            let owner = Owner { what: "`[[loads]]`".to_owned(), span: &load.span };
            let spots = self.spots(&owner, "at", &load.at, Reach::Nodes);
            let amplitude = load.amplitude.as_ref().map(|name| self.amplitude(name));
            let (force, moment) = (vec3_or_zero(&load.force), vec3_or_zero(&load.moment));
            let loads = ["force", "moment", "force_per_length", "force_per_area", "pressure"];
            let unread = loads.iter().any(|key| self.is_spoiled(owner.span, key));
            if load.force.is_none() && load.moment.is_none() && !unread {
                self.error_with::<()>(owner.span, "this load is empty", "give it `force` or `moment`");
            }
            let follower = load.follower.as_ref().is_some_and(|follower| follower.value);
            for spot in spots {
                if self.is_loose(&spot, "this load") {
                    continue;
                }
                let parts = [(0, &force, span(&load.force)), (3, &moment, span(&load.moment))];
                for (first, part, place) in parts {
                    let lost = (0..3).filter(|&i| part[i] != 0.0 && !self.is_taken(spot.node, first + i));
                    let lost = directions(lost.map(|i| first + i));
                    if let Some(place) = place.filter(|_| self.sure && !lost.is_empty()) {
                        let message = format!("nothing connected to `{}` takes a load in {lost}", spot.name);
                        self.error_with::<()>(place, message, "bars, springs and point masses do not turn");
                    }
                }
                let amplitude = amplitude.flatten();
                self.model.loads.push(Load { node: spot.node, force, moment, follower, amplitude });
            }
        }
    }

    /// A load spread over edges or shells, as forces on their nodes.
    fn spread_load(&mut self, load: &'d At<Table<Spread>>) {
        let owner = Owner { what: "`[[loads]]`".to_owned(), span: &load.span };
        self.stray("a load spread over shells", &[("force", span(&load.force)), ("moment", span(&load.moment))]);
        let follower = load.follower.as_ref().filter(|follower| follower.value);
        if let Some(at) = follower
            && (load.force_per_length.is_some() || load.force_per_area.is_some())
        {
            let hint = "give what keeps its direction a table of its own";
            self.error_with::<()>(&at.span, "of loads spread over shells only `pressure` follows", hint);
        }
        let amplitude = load.amplitude.as_ref().map(|name| self.amplitude(name));
        let Some(names) = self.need(&owner, "at", &load.at) else { return };
        let (line, area) = (vec3_or_zero(&load.force_per_length), vec3_or_zero(&load.force_per_area));
        let pressure = load.pressure.as_ref().map_or(0.0, |pressure| pressure.value);
        let mut forces: BTreeMap<usize, Vec3> = BTreeMap::new();
        let mut faces = Vec::new();
        if names.values.is_empty() {
            self.error::<()>(&names.span, "`at` is empty");
        }
        // What is named twice is loaded once, like nodes.
        let mut seen = HashSet::new();
        for name in &names.values {
            let place = self.lookup(name);
            if place.is_some_and(|place| !seen.insert(self.shell_of(place).map_or(place, Place::Shell))) {
                continue;
            }
            match place {
                None => {}
                Some(Place::Edge(shell, edge)) if load.force_per_length.is_some() => {
                    let nodes = self.shell_edges[shell].get(edge).cloned().unwrap_or_default();
                    for pair in nodes.windows(2) {
                        let half = 0.5 * (self.x(pair[1]) - self.x(pair[0])).norm();
                        pair.iter().for_each(|&node| *forces.entry(node).or_default() += half * line);
                    }
                }
                Some(place @ (Place::Group(_) | Place::Set(_))) if load.force_per_length.is_some() => {
                    for pair in self.line_of(place, name) {
                        let spots = pair.map(|node| {
                            let name_of = self.label(node, name);
                            Spot { node, name: name_of, span: &name.span, direct: false }
                        });
                        if spots.iter().any(|spot| self.is_loose(spot, "this load")) {
                            continue;
                        }
                        let half = 0.5 * (self.x(pair[1]) - self.x(pair[0])).norm();
                        pair.iter().for_each(|&node| *forces.entry(node).or_default() += half * line);
                    }
                }
                Some(place) if load.force_per_length.is_none() && self.shell_of(place).is_some() => {
                    let Some(shell) = self.shell_of(place) else { continue };
                    for nodes in self.faces_of(shell) {
                        if follower.is_some() {
                            faces.extend(Face::of(&nodes));
                            continue;
                        }
                        let x: Vec<Vec3> = nodes.iter().map(|&node| self.model.nodes[node].x).collect();
                        let parts = shell::shares(&x).into_iter().zip(shell::faces(&x));
                        for (&node, (share, face)) in nodes.iter().zip(parts) {
                            *forces.entry(node).or_default() += share * area - pressure * face;
                        }
                    }
                }
                Some(place) => {
                    let wants = if load.force_per_length.is_some() { "edges of shells" } else { "shells" };
                    let message = format!("this load wants {wants}, and `{}` is {}", name.value, place.kind());
                    self.error::<()>(&name.span, message);
                }
            }
        }
        let amplitude = amplitude.flatten();
        let load = |(node, force)| Load { node, force, moment: Vec3::zeros(), follower: false, amplitude };
        self.model.loads.extend(forces.into_iter().map(load));
        if !faces.is_empty() {
            self.model.pressures.push(Pressure { faces, pressure, amplitude });
        }
    }

    pub fn environment(&mut self) {
        let Some(environment) = &self.deck.environment else { return };
        self.model.gravity = vec3_or_zero(&environment.gravity);
        for base in &environment.base_acceleration {
            let owner = Owner { what: "an entry of `base_acceleration`".to_owned(), span: &base.span };
            let direction = self.need(&owner, "direction", &base.direction);
            let direction = direction.and_then(|direction| self.unit("direction", direction));
            let amplitude = self.need(&owner, "amplitude", &base.amplitude).and_then(|name| self.amplitude(name));
            let scale = base.scale.as_ref().map_or(1.0, |scale| scale.value);
            if let (Some(direction), Some(amplitude)) = (direction, amplitude) {
                let base = BaseAcceleration { direction: direction * scale, amplitude };
                self.model.base_accelerations.push(base);
            }
        }
    }

    pub fn damping(&mut self) {
        let Some(damping) = &self.deck.damping else { return };
        let mass_factor = self.not_negative("mass_factor", &damping.mass_factor, 0.0);
        let stiffness_factor = self.not_negative("stiffness_factor", &damping.stiffness_factor, 0.0);
        let mut nodal = Vec::new();
        for entry in &damping.nodal {
            let owner = Owner { what: "an entry of `nodal`".to_owned(), span: &entry.span };
            let spots = self.spots(&owner, "at", &entry.at, Reach::Nodes);
            let translation = self.not_negative("translation", &entry.translation, 0.0);
            let rotation = self.not_negative("rotation", &entry.rotation, 0.0);
            for spot in spots {
                if !self.is_loose(&spot, "this damper") {
                    nodal.push(NodalDamping { node: spot.node, translation, rotation });
                }
            }
        }
        self.model.damping = Damping { mass_factor, stiffness_factor, nodal };
    }
}
