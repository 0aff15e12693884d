//! Resultants at both ends of each beam element, from its equilibrium: internal forces on its end nodes, less the shares of distributed
//! loads, weight and inertia. They balance joints, supports and other forces at the node up to the convergence error.

use super::beams::{consistent, in_section, lumped};
use super::masses::NodalMasses;
use crate::system::inertia::{ConsistentMass, Inertia, OwnDrag};
use crate::system::loads::{Loading, load_on};
use crate::system::mass_damping::MassDamping;
use crate::system::mass_scaling::MassScaling;
use crate::system::scale::Scale;
use base::math::{Mat3, Vec3};
use mechanics::elements::{Force, IntegrationPoint, subtract};
use mechanics::state::Configuration;
use model::{AnalysisKind, Beam, ExpectAt, LoadOrigin, MassKind, Model, PartType, RotationAxis, SectionPlaces};
use std::collections::HashMap;

/// The ends of all elements of all beams, in deck order.
pub struct BeamEnds {
    ends: Vec<[BeamEnd; 2]>,
    dynamic: bool,
}

/// An end of an element.
struct BeamEnd {
    /// The node there.
    node: usize,
    /// The lumped mass that is the element's, at the node or beside it.
    lumped: Inertia,
    /// The row of the consistent mass matrix: each node of the element with its mass.
    row: Vec<(usize, f64)>,
    /// Rayleigh factor on the mass, per time.
    alpha: f64,
    /// Axes of the section, columns, global components at t = 0.
    frame: Mat3,
    /// Loads that are shares of one along the element, by their index in the model.
    loads: Vec<usize>,
    /// Centrifugal loads on the beam, by their index in the model, with their axes.
    turning: Vec<(usize, RotationAxis)>,
}

impl BeamEnds {
    /// True if a table or an expected value uses resultants at ends.
    pub fn wanted(model: &Model) -> bool {
        let listed = model.output.sections.is_some_and(|places| places != SectionPlaces::Points);
        listed || model.expects.iter().any(|expect| matches!(expect.at, ExpectAt::Sections(_)))
    }

    /// The ends of the beams of a model at its initial positions, with the mass scaling.
    pub fn new(model: &Model, x: &[Vec3], mass_scaling: Option<&MassScaling>) -> BeamEnds {
        let mut loads: HashMap<(usize, usize, usize), Vec<usize>> = HashMap::new();
        for (index, load) in model.loading.nodal.iter().enumerate() {
            if let Some(LoadOrigin::Element(part, element)) = load.origin {
                loads.entry((part, element, load.node)).or_default().push(index);
            }
        }
        let masses = NodalMasses::new(model, x);
        let mut ends = Vec::new();
        for (part, beam) in model.parts.iter().enumerate().filter_map(|(part, of)| Some((part, Beam::of(of)?))) {
            let turning = model.loading.centrifugal.iter().enumerate();
            let turning = turning.filter(|(_, load)| load.of.parts.contains(&part));
            let turning: Vec<_> = turning.map(|(index, load)| (index, load.axis)).collect();
            for (element, spec) in beam.elements.iter().enumerate() {
                let nodes = &spec.nodes[..=beam.order];
                let is_consistent = beam.mass == MassKind::Consistent;
                let consistent = is_consistent.then(|| consistent(beam, spec, &model.stiffnesses, x));
                let alpha = model.damping.alpha(&beam.damping);
                let own = lumped(beam, element, &model.stiffnesses, &masses);
                let scaling = mass_scaling.map(|scaling| scaling.of(part, element));
                ends.push([0, beam.order].map(|a| {
                    let share = &own.0[a];
                    let (mass, J0) = scaling.map_or((share.mass, share.J0), |scaling| scaling.of(share));
                    let (node, mass_node) = (nodes[a], spec.mass_nodes()[a]);
                    let row = consistent.iter().flat_map(ConsistentMass::pairs).filter(|&(row, ..)| row == mass_node);
                    BeamEnd {
                        node,
                        lumped: Inertia {
                            node: mass_node,
                            mass,
                            weighing: share.mass,
                            J0,
                            of_deck: None,
                            rotary: J0 != Mat3::zeros(),
                            turns: false,
                            own: None,
                            drag: Some(Box::new(OwnDrag { mass: alpha * mass, J0: alpha * J0 })),
                        },
                        row: row.map(|(_, column, m)| (column, m)).collect(),
                        alpha,
                        frame: spec.at_node(a).frame,
                        loads: loads.remove(&(part, element, node)).unwrap_or_default(),
                        turning: turning.clone(),
                    }
                }));
            }
        }
        BeamEnds { ends, dynamic: model.analysis.kind == AnalysisKind::Dynamic }
    }

    /// The resultants at the ends of an element, counted over all beams, from the internal forces on its nodes there.
    pub fn resultants(
        &self,
        element: usize,
        internal: [Force; 2],
        loads: (&[model::Load], &Loading),
        damping: &MassDamping,
        now: &Configuration,
    ) -> [IntegrationPoint; 2] {
        let ends = &self.ends[element];
        [0, 1].map(|k| {
            let (end, internal) = (&ends[k], internal[k]);
            let outer = self.distributed(end, loads, damping, now);
            // On the first node the section acts from the other side.
            let sign = if k == 0 { -1.0 } else { 1.0 };
            let sum: Force = std::array::from_fn(|i| internal[i] - outer[i]);
            let axes = now.nodes[end.node].R() * end.frame;
            IntegrationPoint { s: 0.0, forces: in_section(&sum, &axes, sign), plastic_strain: 0.0, stresses: None }
        })
    }

    /// The share of an end in the loads along the element: loads, weight less inertia, and damping of the mass.
    fn distributed(
        &self,
        end: &BeamEnd,
        (loads, loading): (&[model::Load], &Loading),
        damping: &MassDamping,
        now: &Configuration,
    ) -> Force {
        let node = &now.nodes[end.lumped.node];
        let mut sum = end.lumped.force(node, &loading.field, self.dynamic, &mut Scale::default());
        let drags = self.dynamic && end.alpha > 0.0;
        if drags {
            damping.add(&end.lumped, now.nodes, &mut sum);
        }
        for &(column, m) in &end.row {
            let other = &now.nodes[column];
            let mut inertia = if self.dynamic { other.a } else { Vec3::zeros() };
            if drags {
                inertia += end.alpha * damping.relative(column, now.nodes)[0];
            }
            subtract(&mut sum, 0, &(m * (inertia - loading.field)));
        }
        for (index, axis) in &end.turning {
            let square = loading.squares[*index];
            let own = (end.lumped.node, end.lumped.mass);
            for (column, m) in end.row.iter().copied().chain([own]) {
                subtract(&mut sum, 0, &(-square * m * axis.away(&now.nodes[column].x)));
            }
            subtract(&mut sum, 3, &(-square * axis.moment(&end.lumped.J(node))));
        }
        if end.node != end.lumped.node {
            // Forces on the centre of mass turn the node.
            let arm = node.relative_position(&now.nodes[end.node]);
            let force = Vec3::new(sum[0], sum[1], sum[2]);
            subtract(&mut sum, 3, &-arm.cross(&force));
        }
        for &index in &end.loads {
            let (f, m) = load_on(&loads[index], loading.factors[index], now.nodes);
            subtract(&mut sum, 0, &-f);
            subtract(&mut sum, 3, &-m);
        }
        sum
    }
}
