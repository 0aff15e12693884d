//! Beams in the equation of motion: their masses and blocks, and the resultants in their sections.

use super::assembled::{Assembled, NumberedBlock, Setting, pieces};
use super::masses::NodalMasses;
use crate::elements::beam::{BeamGeometry, Beams, FibreModel};
use crate::elements::{ElementBlock, IntegrationPoint};
use crate::math::{Mat3, quadrature};
use crate::model::{Beam, MassKind, Model, PartType};
use crate::sections::{self, Stiffness};
use crate::state::Configuration;
use crate::system::group::Group;
use crate::system::inertia::ConsistentMass;
use crate::system::plane::{MotionPlane, SMALL};
use std::ops::Range;

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

impl Assembled for Beam {
    fn add_masses(&self, stiffnesses: &[Stiffness], masses: &mut NodalMasses) {
        let (_, weights) = quadrature::lobatto(self.order + 1);
        for element in &self.elements {
            let nodes = &element.nodes[..=self.order];
            let section = &stiffnesses[element.section];
            let length = (masses.x[nodes[self.order]] - masses.x[nodes[0]]).norm();
            let rotary = element.frame * section.inertia_per_length * element.frame.transpose();
            for (&node, w) in nodes.iter().zip(weights) {
                let share = 0.5 * w * length;
                let mass = if masses.has_mass(self.mass, node) { share * section.mass_per_length } else { 0.0 };
                let keep = self.rotary_inertia && masses.has_rotary_inertia(self.mass, node);
                masses.lumped.add(node, mass, &if keep { rotary * share } else { Mat3::zeros() });
            }
            if self.mass == MassKind::Consistent {
                masses.consistent.push(ConsistentMass::new(nodes, length * section.mass_per_length));
            }
        }
    }

    fn blocks(&self, setting: &Setting) -> Vec<NumberedBlock> {
        let block = |piece: Range<usize>| match self.order {
            1 => block::<2>(self, piece, setting),
            2 => block::<3>(self, piece, setting),
            3 => block::<4>(self, piece, setting),
            _ => block::<5>(self, piece, setting),
        };
        pieces(self.elements.len()).map(|piece| (block(piece.clone()), piece.start)).collect()
    }

    fn stays_in(&self, plane: &MotionPlane, stiffnesses: &[Stiffness]) -> bool {
        self.elements.iter().all(|e| section_stays_in(plane, &e.frame, &stiffnesses[e.section]))
    }
}

fn block<const N: usize>(part: &Beam, piece: Range<usize>, setting: &Setting) -> Box<dyn ElementBlock> {
    let &Setting { model, x, beta, plane } = setting;
    let elements = part.elements[piece].iter().map(|e| BeamGeometry {
        nodes: &e.nodes,
        frame: &e.frame,
        stiffness: &model.stiffnesses[e.section],
    });
    match &part.yielding {
        None => Box::new(Beams::<N>::new(elements, x, beta)),
        Some(yielding) => {
            let fibres = match in_plane(part, plane) {
                Some(along_z) => sections::flattened(&yielding.fibres, along_z),
                None => yielding.fibres.clone(),
            };
            FibreModel { fibres, ..yielding.clone() }.beams::<N>(elements, x, beta)
        }
    }
}

/// True where a plane motion bends all elements of a part along local z, false where along local y; `None` if it does
/// neither.
fn in_plane(part: &Beam, plane: Option<usize>) -> Option<bool> {
    let normal = plane?;
    let across = |axis: usize| part.elements.iter().all(|e| e.frame[(normal, axis)].abs() > 1.0 - 1e-12);
    if across(1) { Some(true) } else { across(2).then_some(false) }
}

/// True where fibres of a yielding beam with the same strain in a plane motion are merged into one. `plane` is the normal of the
/// motion.
pub fn merges_fibres(beam: &Beam, plane: Option<usize>) -> bool {
    beam.yielding.is_some() && in_plane(beam, plane).is_some()
}

/// True for a section that bending and stretching in the plane neither bend nor twist out of it.
fn section_stays_in(plane: &MotionPlane, frame: &Mat3, C: &Stiffness) -> bool {
    let turn = |K: &Mat3| frame * K * frame.transpose();
    // The coupling of forces and curvatures may be nothing but rounding, that of a shear centre at the centroid: it
    // is small beside the geometric mean of the stiffnesses of forces and moments.
    let rest = turn(&C.NM);
    let paired = rest.amax() > SMALL * C.N.amax().sqrt() * C.M.amax().sqrt();
    plane.decouples(&turn(&C.N)) && plane.decouples(&turn(&C.M)) && (!paired || plane.decouples_rotations(&rest))
}

/// Writes the stress resultants at all integration points of all beams into `out`, in deck order.
pub fn section_points(groups: &[Group], model: &Model, now: &Configuration, out: &mut Vec<SectionPoint>) {
    out.clear();
    let mut start = 0.0;
    for group in groups {
        let Some(beam) = Beam::of(&model.parts[group.part]) else { continue };
        let now = group.configuration(now);
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
