//! Beams in the equation of motion: their masses and blocks, and the resultants in their sections.

use super::assembled::{Assembled, NumberedBlock, Setting, pieces};
use super::beam_ends::BeamEnds;
use super::masses::NodalMasses;
use crate::elements::beam::{BeamGeometry, Beams, FibreModel};
use crate::elements::{ElementBlock, Force, IntegrationPoint};
use crate::math::{Mat3, Vec3, quadrature};
use crate::model::{Beam, Load, MassKind, Model, PartType};
use crate::sections::{self, Stiffness};
use crate::state::Configuration;
use crate::system::group::Group;
use crate::system::inertia::ConsistentMass;
use crate::system::loads::Loading;
use crate::system::plane::{MotionPlane, SMALL};
use std::ops::Range;

/// The state of an integration point of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionPoint {
    /// The beam's index in [`Model::parts`].
    pub part: usize,
    /// Number of the element within the beam.
    pub element: usize,
    /// The place in the element.
    pub place: SectionPlace,
    /// Resultants and strains at the arc length `s` from the beam's start.
    pub at: IntegrationPoint,
}

/// A place in an element of a beam.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SectionPlace {
    /// The first node of the element.
    Start,
    /// An integration point by its number.
    Point(usize),
    /// The last node of the element.
    End,
}

/// What acts along beams, from which the resultants at the ends of their elements follow.
pub struct EndForces<'a> {
    /// The ends.
    pub ends: &'a BeamEnds,
    /// The loads of the model, ...
    pub loads: &'a [Load],
    /// ... and what they are at the instant.
    pub loading: &'a Loading,
}

impl Assembled for Beam {
    fn add_masses(&self, stiffnesses: &[Stiffness], masses: &mut NodalMasses) {
        for (index, element) in self.elements.iter().enumerate() {
            let nodes = &element.nodes[..=self.order];
            for (a, &node) in nodes.iter().enumerate() {
                let (mass, inertia) = masses.share_of_beam(self, index, a, stiffnesses);
                masses.lumped.add(node, mass, &inertia);
            }
            if self.mass == MassKind::Consistent {
                let section = &stiffnesses[element.section];
                let length = (masses.x[nodes[self.order]] - masses.x[nodes[0]]).norm();
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

/// Writes N, V_y, V_z, T, M_y, M_z at each node of each element of all beams into `out`, in deck order: polynomials through the
/// integration points, or through both ends where there is one point.
pub fn nodal_resultants(groups: &[Group], model: &Model, now: &Configuration, out: &mut Vec<[f64; 6]>) {
    out.clear();
    for group in groups {
        let Some(beam) = Beam::of(&model.parts[group.part]) else { continue };
        let now = group.configuration(now);
        let (at, _) = quadrature::lobatto(beam.order + 1);
        for e in 0..group.block.len() {
            let spec = &beam.elements[group.first + e];
            if beam.order == 1 {
                let internal = group.block.end_forces(e, &now).unwrap_or_default();
                out.extend([0, 1].map(|k| {
                    let axes = now.nodes[spec.nodes[k]].R() * spec.frame;
                    in_section(&internal[k], &axes, if k == 0 { -1.0 } else { 1.0 })
                }));
                continue;
            }
            let half = 0.5 * (model.nodes[spec.nodes[beam.order]].x - model.nodes[spec.nodes[0]].x).norm();
            let points = (0..group.block.points()).filter_map(|point| group.block.point(e, point, &spec.frame, &now));
            let points: Vec<IntegrationPoint> = points.collect();
            let xi: Vec<f64> = points.iter().map(|point| point.s / half - 1.0).collect();
            for &node in at {
                let weights = quadrature::lagrange(&xi, node);
                let value = |i: usize| points.iter().zip(&weights).map(|(point, w)| w * point.forces[i]).sum();
                out.push(std::array::from_fn(value));
            }
        }
    }
}

/// A force and a moment times `sign` in the axes of a section, columns.
pub(super) fn in_section(sum: &Force, axes: &Mat3, sign: f64) -> [f64; 6] {
    let n = axes.tr_mul(&Vec3::new(sum[0], sum[1], sum[2])) * sign;
    let m = axes.tr_mul(&Vec3::new(sum[3], sum[4], sum[5])) * sign;
    [n.x, n.y, n.z, m.x, m.y, m.z]
}

/// Writes the stress resultants of all beams into `out`, in deck order: those at their integration points, and with what acts along the
/// beams those at the ends of their elements too.
pub fn section_points(
    groups: &[Group],
    model: &Model,
    now: &Configuration,
    acting: Option<EndForces>,
    out: &mut Vec<SectionPoint>,
) {
    out.clear();
    let (mut start, mut count) = (0.0, 0);
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
            let nodes = (spec.nodes[0], spec.nodes[beam.order]);
            let end = start + (model.nodes[nodes.1].x - model.nodes[nodes.0].x).norm();
            let ends = acting.as_ref().and_then(|acting| {
                let internal = group.block.end_forces(e, &now)?;
                Some(acting.ends.resultants(count, internal, (acting.loads, acting.loading), &now))
            });
            let mut push = |place, s: f64, at: IntegrationPoint| {
                out.push(SectionPoint { part: group.part, element, place, at: IntegrationPoint { s, ..at } });
            };
            if let Some([at, _]) = ends {
                push(SectionPlace::Start, start, at);
            }
            for point in 0..group.block.points() {
                let Some(at) = group.block.point(e, point, frame, &now) else { continue };
                push(SectionPlace::Point(point), at.s + start, at);
            }
            if let Some([_, at]) = ends {
                push(SectionPlace::End, end, at);
            }
            (start, count) = (end, count + 1);
        }
    }
}
