//! Beams in the equation of motion: their masses and blocks, and the resultants in their sections.

use super::assembled::{Assembled, NodeSpacing, NumberedBlock, Setting, pieces};
use super::masses::{LumpedElement, NodalMasses, NodalShare};
use crate::system::group::Group;
use crate::system::inertia::ConsistentMass;
use crate::system::plane::MotionPlane;
use crate::tolerances::plane::SMALL;
use base::math::{Mat3, Vec3, quadrature};
use mechanics::elements::beam::{BeamGeometry, BeamSetting, FibreModel, elastic_beams};
use mechanics::elements::{ElementBlock, Force, IntegrationPoint};
use mechanics::sections::{self, Stiffness};
use mechanics::state::Configuration;
use model::{Beam, BeamElement, MassKind, Model, PartType, SectionAt};
use std::ops::Range;

impl Assembled for Beam {
    fn add_masses(&self, stiffnesses: &[Stiffness], masses: &mut NodalMasses) {
        for (index, element) in self.elements.iter().enumerate() {
            masses.add(&lumped(self, index, stiffnesses, masses));
            if self.mass == MassKind::Consistent {
                masses.consistent.push(consistent(self, element, stiffnesses, masses.x));
            }
        }
    }

    fn lumped(&self, element: usize, stiffnesses: &[Stiffness], masses: &NodalMasses) -> Option<LumpedElement> {
        Some(lumped(self, element, stiffnesses, masses))
    }

    /// The rotary inertia of torsion is not raised.
    fn spacing(&self, element: usize, masses: &NodalMasses) -> NodeSpacing {
        let nodes = &self.elements[element].nodes;
        let along = (masses.x[nodes[self.order]] - masses.x[nodes[0]]) / self.order as f64;
        let bending = along.norm_squared() * Mat3::identity() - along * along.transpose();
        NodeSpacing { bending, drilling: Mat3::zeros() }
    }

    fn blocks(&self, setting: &Setting) -> Vec<NumberedBlock> {
        pieces(self.elements.len()).map(|piece| (block(self, piece.clone(), setting), piece.start)).collect()
    }

    fn stays_in(&self, plane: &MotionPlane, stiffnesses: &[Stiffness]) -> bool {
        let fibres = |model: &FibreModel| model.stays_in(in_plane(self, Some(plane.normal)));
        if !self.yielding.as_ref().is_none_or(fibres) {
            return false;
        }
        let points = self.elements.iter().flat_map(|e| (0..self.order).map(|g| e.at_point(g)));
        points.into_iter().all(|at| section_stays_in(plane, &at.frame, &stiffnesses[at.section]))
    }
}

fn block(part: &Beam, piece: Range<usize>, setting: &Setting) -> Box<dyn ElementBlock> {
    let &Setting { model, x, plane } = setting;
    let beta = model.damping.beta(&part.damping);
    let heat = &part.heat.piece(piece.clone());
    let elements = part.elements[piece].iter().map(|e| BeamGeometry {
        nodes: &e.nodes,
        frame: &e.frame,
        stiffness: &model.stiffnesses[e.section],
        varied: e
            .varied
            .as_ref()
            .map(|varied| varied.points.each_ref().map(|at| (&model.stiffnesses[at.section], &at.frame))),
    });
    let elements: Vec<BeamGeometry> = elements.collect();
    let setting = BeamSetting { x, damping: beta, heat };
    match &part.yielding {
        None => elastic_beams(part.order, &elements, setting),
        Some(yielding) => {
            let mut model = yielding.clone();
            if let Some(along_z) = in_plane(part, plane) {
                model.groups.iter_mut().for_each(|group| group.fibres = sections::flattened(&group.fibres, along_z));
            }
            model.beams(part.order, &elements, setting)
        }
    }
}

/// True if a plane motion bends all elements of a part along local z, false if along local y; `None` if neither.
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
    // With the shear centre at the centroid, the coupling of forces and curvatures may be only rounding. It is then small beside the
    // geometric mean of the stiffnesses of forces and moments.
    let rest = turn(&C.NM);
    let paired = rest.amax() > SMALL * C.N.amax().sqrt() * C.M.amax().sqrt();
    plane.decouples(&turn(&C.N)) && plane.decouples(&turn(&C.M)) && (!paired || plane.decouples_rotations(&rest))
}

/// Lumped masses and inertia tensors of an element at its nodes.
pub(super) fn lumped(beam: &Beam, element: usize, stiffnesses: &[Stiffness], masses: &NodalMasses) -> LumpedElement {
    let (_, weights) = quadrature::lobatto(beam.order + 1);
    let element = &beam.elements[element];
    let length = (masses.x[element.nodes[beam.order]] - masses.x[element.nodes[0]]).norm();
    let share = |k: usize| {
        let (node, at, share) = (element.nodes[k], element.mass_nodes()[k], 0.5 * weights[k] * length);
        let SectionAt { section, frame } = element.at_node(k);
        let section = &stiffnesses[section];
        let mass = if masses.has_mass(beam.mass, node) { share * section.mass_per_length } else { 0.0 };
        let keep = beam.rotary_inertia && masses.has_rotary_inertia(beam.mass, node);
        let rotary = || frame * section.inertia_per_length * frame.transpose();
        let J0 = if keep { rotary() * share } else { Mat3::zeros() };
        NodalShare { node: at, arm: masses.x[at] - masses.x[node], mass, J0, turns: masses.turns(node) }
    };
    LumpedElement((0..=beam.order).map(share).collect())
}

/// The consistent mass of an element.
pub(super) fn consistent(beam: &Beam, element: &BeamElement, stiffnesses: &[Stiffness], x: &[Vec3]) -> ConsistentMass {
    let length = (x[element.nodes[beam.order]] - x[element.nodes[0]]).norm();
    let nodes = &element.mass_nodes()[..=beam.order];
    let mass = |section: usize| length * stiffnesses[section].mass_per_length;
    match &element.varied {
        None => ConsistentMass::new(nodes, mass(element.section)),
        Some(varied) => ConsistentMass::varied(nodes, &varied.nodes.map(|at| mass(at.section))[..nodes.len()]),
    }
}

/// Writes N, V_y, V_z, T, M_y, M_z at each node of each element of all beams into `out`, in deck order. The values are polynomials through
/// the integration points, or through both ends if there is one point.
pub fn nodal_resultants<'g>(
    groups: impl Iterator<Item = &'g Group>,
    model: &Model,
    now: &Configuration,
    out: &mut Vec<[f64; 6]>,
) {
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
                    let axes = now.nodes[spec.nodes[k]].R() * spec.at_node(k).frame;
                    in_section(&internal[k], &axes, if k == 0 { -1.0 } else { 1.0 })
                }));
                continue;
            }
            let half = 0.5 * (model.nodes[spec.nodes[beam.order]].x - model.nodes[spec.nodes[0]].x).norm();
            let points = (0..group.block.points())
                .filter_map(|point| group.block.point(e, point, &spec.at_point(point).frame, &now));
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
