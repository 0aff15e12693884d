//! The results of elements for output: forces of links, stress resultants of beams and shells.

use super::equations::System;
use super::watched::Watched;
use crate::elements::{IntegrationPoint, ShellResultants};
use crate::math::{Mat3, Vec3};
use crate::model::{Beam, Model, PartType, Shell};
use crate::state::{Configuration, Node};

/// The state of a link at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkState {
    /// Elongation; of a bushing, the relative displacement along its first axis.
    pub elongation: f64,
    /// Rate of the elongation.
    pub rate: f64,
    /// Axial force, positive in tension.
    pub force: f64,
    /// Force that the link exerts on its first end, global components; the second end pulls on it.
    pub f: Vec3,
    /// Moment that the link exerts on its first end, global components.
    pub m: Vec3,
}

/// The state of an integration point of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionPoint {
    /// The beam's index in [`Model::parts`].
    pub part: usize,
    /// Number of the element within the beam.
    pub element: usize,
    /// Number of the integration point within the element.
    pub point: usize,
    /// Resultants and strains at the arc length `s` from the beam's start.
    pub at: IntegrationPoint,
}

/// The state of a shell element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShellState {
    /// The shell's index in [`Model::parts`].
    pub part: usize,
    /// The element's number in the deck's part.
    pub element: usize,
    /// Stress resultants, and the stresses of layers.
    pub at: ShellResultants,
}

impl ShellState {
    /// Von Mises stress in the lowest layer and in the highest.
    pub fn outer_von_mises(&self) -> [f64; 2] {
        let layers = self.at.layers();
        [layers.first(), layers.last()].map(|layer| layer.map_or(0.0, |layer| layer.von_mises()))
    }

    /// Von Mises stress, the largest over the layers.
    pub fn von_mises(&self) -> f64 {
        self.at.layers().iter().map(|layer| layer.von_mises()).fold(0.0, f64::max)
    }

    /// Accumulated plastic strain, the largest over the layers.
    pub fn plastic_strain(&self) -> f64 {
        self.at.layers().iter().map(|layer| layer.plastic_strain).fold(0.0, f64::max)
    }
}

/// Writes the states of all links into `out`, in deck order.
pub fn link_states(system: &System, nodes: &[Node], out: &mut Vec<LinkState>) {
    out.clear();
    out.extend(system.watched.iter().map(|link| match link {
        Watched::Line(link) => {
            let (elongation, rate, force) = link.state(nodes);
            LinkState { elongation, rate, force, f: force * link.axis(nodes), m: Vec3::zeros() }
        }
        Watched::Bushing(bushing) => {
            let (d, rate, f, m) = bushing.state(nodes);
            let [first, second] = bushing.nodes.map(|n| &nodes[n]);
            let B = first.R() * bushing.axes;
            // Force and moment act at the second end; the force, across the distance of the ends, adds a moment on
            // the first.
            let f_global = B * f;
            let m = B * m + (second.x - first.x).cross(&f_global);
            LinkState { elongation: d.x, rate, force: f.x, f: f_global, m }
        }
    }));
}

/// Writes the largest accumulated plastic strain of each element into `out`: all beams, bars and shells in deck
/// order.
pub fn plastic_strains(system: &System, now: &Configuration, out: &mut Vec<f64>) {
    out.clear();
    for group in system.groups.iter().filter(|group| group.kind.is_deformable()) {
        let history = group.share(now).history;
        out.extend((0..group.block.len()).map(|e| group.block.plastic_strain(e, history)));
    }
}

/// Writes the stress resultants of all elements of all shells into `out`, in deck order.
pub fn shell_states(system: &System, model: &Model, now: &Configuration, out: &mut Vec<ShellState>) {
    out.clear();
    for group in &system.groups {
        let Some(shell) = Shell::of(&model.parts[group.part]) else { continue };
        let now = group.share(now);
        for e in 0..group.block.len() {
            let element = group.first + e;
            let start = shell.elements[element].nodes.map(|node| model.nodes[node].x);
            let resultants = group.block.resultants(e, &shell.axis, &start[..shell.corners], &now);
            let Some(mut at) = resultants else { continue };
            if at.layers().is_empty() {
                at.set_elastic_layers(shell.plate.thickness);
            }
            out.push(ShellState { part: group.part, element: shell.number(element), at });
        }
    }
}

/// Writes the stress resultants at all integration points of all beams into `out`, in deck order.
pub fn section_points(system: &System, model: &Model, now: &Configuration, out: &mut Vec<SectionPoint>) {
    out.clear();
    let mut start = 0.0;
    for group in &system.groups {
        let Some(beam) = Beam::of(&model.parts[group.part]) else { continue };
        let now = group.share(now);
        if group.first == 0 {
            start = 0.0;
        }
        for e in 0..group.block.len() {
            let element = group.first + e;
            let spec = &beam.elements[element];
            let frame: &Mat3 = &spec.frame;
            for point in 0..group.block.points() {
                let Some(mut at) = group.block.point(e, point, frame, &now) else { continue };
                at.s += start;
                out.push(SectionPoint { part: group.part, element, point, at });
            }
            let ends = (spec.nodes[0], spec.nodes[beam.order]);
            start += (model.nodes[ends.1].x - model.nodes[ends.0].x).norm();
        }
    }
}
