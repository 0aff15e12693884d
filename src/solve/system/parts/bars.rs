//! Bars in the equation of motion: their masses and blocks.

use super::assembled::{Assembled, NumberedBlock, Setting, pieces};
use super::masses::{LumpedElement, NodalMasses, NodalShare};
use crate::system::inertia::ConsistentMass;
use crate::system::plane::MotionPlane;
use base::math::{Mat3, Vec3};
use mechanics::elements::ElementBlock;
use mechanics::elements::bar::{self, YieldingBars};
use mechanics::sections::Stiffness;
use model::{Bar, MassKind};
use std::ops::Range;

impl Assembled for Bar {
    fn add_masses(&self, _: &[Stiffness], masses: &mut NodalMasses) {
        for nodes in &self.elements {
            masses.add(&lumped(self, nodes, masses));
            if self.mass == MassKind::Consistent {
                masses.consistent.push(ConsistentMass::new(nodes, mass(self, nodes, masses)));
            }
        }
    }

    fn lumped(&self, element: usize, _: &[Stiffness], masses: &NodalMasses) -> Option<LumpedElement> {
        Some(lumped(self, &self.elements[element], masses))
    }

    fn blocks(&self, setting: &Setting) -> Vec<NumberedBlock> {
        pieces(self.elements.len()).map(|piece| (block(self, piece.clone(), setting), piece.start)).collect()
    }

    /// A bar has no direction but that of its nodes.
    fn stays_in(&self, _: &MotionPlane, _: &[Stiffness]) -> bool {
        true
    }
}

fn length(nodes: &[usize; 2], masses: &NodalMasses) -> f64 {
    (masses.x[nodes[1]] - masses.x[nodes[0]]).norm()
}

fn mass(part: &Bar, nodes: &[usize; 2], masses: &NodalMasses) -> f64 {
    part.mass_per_length * part.free * length(nodes, masses)
}

fn lumped(part: &Bar, nodes: &[usize; 2], masses: &NodalMasses) -> LumpedElement {
    let mass = mass(part, nodes, masses);
    let own = |node: usize| if masses.has_mass(part.mass, node) { 0.5 * mass } else { 0.0 };
    LumpedElement(
        nodes
            .iter()
            .map(|&node| NodalShare {
                node,
                arm: Vec3::zeros(),
                mass: own(node),
                J0: Mat3::zeros(),
                turns: masses.turns(node),
            })
            .collect(),
    )
}

fn block(part: &Bar, piece: Range<usize>, &Setting { model, x, .. }: &Setting) -> Box<dyn ElementBlock> {
    let beta = model.damping.beta(&part.damping);
    let (elements, heat) = (&part.elements[piece.clone()], &part.heat.piece(piece));
    match &part.yielding {
        None => {
            let stiffness = part.axial_stiffness;
            Box::new(bar::elastic_bars(elements, stiffness, part.tension_only, (part.free, heat), x, beta))
        }
        Some(law) => {
            let stiffness = (part.axial_stiffness, law);
            Box::new(YieldingBars::new(elements, stiffness, part.tension_only, (part.free, heat), x, beta))
        }
    }
}
