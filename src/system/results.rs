//! What elements feel, for output: forces of links, stress resultants of beams.

use super::System;
use crate::elements::bushing::Bushing;
use crate::elements::link::Link;
use crate::math::{Mat3, Vec3};
use crate::model::Model;
use crate::state::Node;

/// A link at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkState {
    /// Of a bushing: along its first axis.
    pub elongation: f64,
    pub rate: f64,
    /// Tension positive.
    pub force: f64,
    /// Force and moment that the link exerts on its first end (the second end pulls on it), global components.
    pub f: Vec3,
    pub m: Vec3,
}

/// Stress resultants at a Gauss point of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionPoint {
    pub beam: usize,
    pub element: usize,
    pub point: usize,
    /// Arc length from the beam's start.
    pub s: f64,
    /// N, Q_y, Q_z, T, M_y, M_z in section axes.
    pub forces: [f64; 6],
}

/// A link as the deck lists it, apart from the blocks that integrate it.
pub enum Watched {
    Line(Link),
    Bushing(Bushing),
}

impl System {
    /// States of all links in deck order.
    pub fn link_states(&self, nodes: &[Node], out: &mut Vec<LinkState>) {
        out.clear();
        out.extend(self.watched.iter().map(|link| match link {
            Watched::Line(link) => {
                let (elongation, rate, force) = link.state(nodes);
                LinkState { elongation, rate, force, f: force * link.axis(nodes), m: Vec3::zeros() }
            }
            Watched::Bushing(bushing) => {
                let (d, rate, f, m) = bushing.state(nodes);
                let [first, second] = bushing.nodes.map(|n| &nodes[n]);
                let B = first.R() * bushing.axes;
                // Force and moment act at the second end; across the distance of the ends the force turns the first.
                let f_global = B * f;
                let m = B * m + (second.x - first.x).cross(&f_global);
                LinkState { elongation: d.x, rate, force: f.x, f: f_global, m }
            }
        }));
    }

    /// Stress resultants at all Gauss points of all beams in deck order.
    pub fn section_points(&self, model: &Model, nodes: &[Node], out: &mut Vec<SectionPoint>) {
        out.clear();
        // Beams are the first groups, one per part, in deck order.
        let groups = model.beams.iter().filter(|b| !b.elements.is_empty()).enumerate().zip(&self.groups);
        for ((beam, part), group) in groups {
            let mut start = 0.0;
            for (element, spec) in part.elements.iter().enumerate() {
                let frame: &Mat3 = &spec.frame;
                for point in 0..part.order {
                    let Some((s, forces)) = group.block.resultants(element, point, frame, nodes) else { continue };
                    out.push(SectionPoint { beam, element, point, s: start + s, forces });
                }
                let ends = (spec.nodes[0], spec.nodes[part.order]);
                start += (model.nodes[ends.1].x - model.nodes[ends.0].x).norm();
            }
        }
    }
}
