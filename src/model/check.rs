//! What is odd about a deck that is otherwise sound: nothing in it, things nothing uses, numbers of the wrong units.

use super::build::{Builder, span};
use crate::deck::bodies::Body;
use crate::deck::output::Units;
use crate::deck::read::ROOT;
use crate::diagnostic::{At, Diagnostic};
use crate::names::short;

impl Units {
    pub fn label(self) -> &'static str {
        match self {
            Units::Si => "SI",
            Units::MKgS => "m-kg-s",
            Units::MmTS => "mm-t-s",
            Units::MmKgS => "mm-kg-s",
            Units::MmKgMs => "mm-kg-ms",
        }
    }

    /// Its length, mass and time in metres, kilograms and seconds.
    fn scales(self) -> [f64; 3] {
        match self {
            Units::Si | Units::MKgS => [1.0, 1.0, 1.0],
            Units::MmTS => [1e-3, 1e3, 1.0],
            Units::MmKgS => [1e-3, 1.0, 1.0],
            Units::MmKgMs => [1e-3, 1.0, 1e-3],
        }
    }
}

/// From rubber to diamond, in Pa.
const MODULUS: [f64; 2] = [1e5, 1.3e12];
/// From aerogel to osmium, in kg/m³.
const DENSITY: [f64; 2] = [1.0, 2.3e4];
/// From the Moon to Jupiter, in m/s².
const GRAVITY: [f64; 2] = [1.6, 26.0];

impl<'d> Builder<'d> {
    pub fn check(&mut self) {
        self.check_content();
        // What an error has left out may be all that used it.
        if self.deck.spoiled.is_empty() && !self.problems.iter().any(Diagnostic::is_error) {
            self.check_use();
            self.check_joints();
        }
        self.check_mesh();
        self.check_slivers();
        if self.model.analysis.kind == super::AnalysisKind::Static {
            self.check_static();
        }
        self.check_explicit();
        if let Some(units) = &self.deck.units {
            self.check_units(units.value);
        }
    }

    fn check_content(&mut self) {
        let deck = self.deck;
        let parts = [deck.beams.len(), deck.bars.len(), deck.shells.len(), deck.bodies.len(), deck.masses.len()];
        let spoiled =
            ["beams", "bars", "shells", "bodies", "masses", "links"].iter().any(|key| self.is_spoiled(&ROOT, key));
        if parts.iter().all(|&count| count == 0) && !spoiled {
            let message = "the deck has nothing that could move: no beams, bars, shells, bodies or masses";
            self.problems.push(Diagnostic::error(message));
        }
    }

    fn check_use(&mut self) {
        let deck = self.deck;
        let masters: std::collections::HashSet<usize> = self.model.riders.iter().map(|rider| rider.master).collect();
        for (node, (name, _)) in deck.points.0.iter().enumerate() {
            let used = self.acts[node].contains(&true) || self.rides.contains_key(&node) || masters.contains(&node);
            if !used {
                let message = format!("nothing is connected to point `{}`", name.value);
                self.warn(&name.span, message, "it is left out of the computation");
            }
        }
        self.check_table("material", deck.materials.0.iter().map(|(name, _)| name));
        self.check_table("section", deck.sections.0.iter().map(|(name, _)| name));
        self.check_table("amplitude", deck.amplitudes.0.iter().map(|(name, _)| name));
    }

    fn check_static(&mut self) {
        let deck = self.deck;
        let velocity = |body: &'d Body| [span(&body.velocity), span(&body.angular_velocity)];
        let velocities = deck.bodies.iter().flat_map(|body| velocity(body)).flatten();
        let places = velocities.chain(deck.initial.iter().map(|initial| &initial.span)).chain(span(&deck.damping));
        for place in places {
            self.warn(place, "this has no effect in a static analysis", "nothing moves by itself");
        }
        // Rotations are updated in load steps too.
        let Some(integrator) = &deck.integrator else { return };
        let numbers = [&integrator.theta, &integrator.gamma, &integrator.beta, &integrator.alpha];
        let numbers = numbers.into_iter().chain([&integrator.spectral_radius, &integrator.split]).filter_map(span);
        let words = [span(&integrator.scheme), span(&integrator.order)].into_iter().flatten();
        for place in words.chain(numbers) {
            self.warn(place, "this has no effect in a static analysis", "load steps take no scheme in time");
        }
    }

    fn check_table(&mut self, what: &'static str, names: impl Iterator<Item = &'d At<String>>) {
        for (index, name) in names.enumerate() {
            if !self.used.contains(&(what, index)) {
                self.warn(&name.span, format!("nothing uses {what} `{}`", name.value), "never named");
            }
        }
    }

    fn check_units(&mut self, units: Units) {
        let [length, mass, time] = units.scales();
        let pressure = mass / (length * time * time);
        for (_, material) in &self.deck.materials.0 {
            self.plausible(units, "youngs_modulus", material.youngs_modulus.as_ref(), pressure, MODULUS, "Pa");
            self.plausible(units, "density", material.density.as_ref(), mass / length.powi(3), DENSITY, "kg/m³");
        }
        let gravity = self.deck.environment.as_ref().and_then(|environment| environment.gravity.as_ref());
        let gravity = gravity.map(|g| At { value: super::build::vec3(g).norm(), span: g.span.clone() });
        let gravity = gravity.filter(|g| g.value > 0.0);
        self.plausible(units, "gravity", gravity.as_ref(), length / (time * time), GRAVITY, "m/s²");
    }

    fn plausible(
        &mut self,
        units: Units,
        key: &str,
        at: Option<&At<f64>>,
        scale: f64,
        [low, high]: [f64; 2],
        si: &str,
    ) {
        let Some(at) = at else { return };
        let value = at.value * scale;
        if value > 0.0 && !(low..=high).contains(&value) {
            let message = format!("`{key}` is not plausible in the units {}", units.label());
            self.warn(&at.span, message, format!("that is {} {si}", short(value)));
        }
    }
}
