//! Resultants in the sections of beams for output: at integration points, and at the ends of elements.

use super::beam_ends::BeamEnds;
use crate::system::group::Group;
use crate::system::loads::Loading;
use crate::system::mass_damping::MassDamping;
use crate::tolerances::strain::SOFT;
use base::quantities::UnitSystem;
use mechanics::elements::IntegrationPoint;
use mechanics::sections::BeamStresses;
use mechanics::state::Configuration;
use model::{Beam, Load, Model, PartType};

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

/// The loads along beams, for the resultants at the ends of their elements.
pub struct EndForces<'a> {
    /// The ends.
    pub ends: &'a BeamEnds,
    /// The loads of the model, ...
    pub loads: &'a [Load],
    /// ... and their values at the instant.
    pub loading: &'a Loading,
    /// Rayleigh damping of their masses.
    pub damping: &'a MassDamping,
}

/// Writes the stress resultants of all beams into `out`, in deck order: at their integration points, and with `acting` also at the ends of
/// their elements.
pub fn section_points<'g>(
    groups: impl Iterator<Item = &'g Group>,
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
            let nodes = (spec.nodes[0], spec.nodes[beam.order]);
            let end = start + (model.nodes[nodes.1].x - model.nodes[nodes.0].x).norm();
            let ends = acting.as_ref().and_then(|acting| {
                let internal = group.block.end_forces(e, &now)?;
                Some(acting.ends.resultants(count, internal, (acting.loads, acting.loading), acting.damping, &now))
            });
            let mut push = |place, s: f64, at: IntegrationPoint| {
                let stresses = stresses(model, beam, section_at(beam, element, place), &at);
                out.push(SectionPoint { part: group.part, element, place, at: IntegrationPoint { s, stresses, ..at } });
            };
            if let Some([at, _]) = ends {
                push(SectionPlace::Start, start, at);
            }
            for point in 0..group.block.points() {
                let frame = &spec.at_point(point).frame;
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

/// The section at a place of an element, by its index.
fn section_at(beam: &Beam, element: usize, place: SectionPlace) -> usize {
    let spec = &beam.elements[element];
    match place {
        SectionPlace::Start => spec.at_node(0).section,
        // Elements of sections that differ are elastic, with a point less than nodes.
        SectionPlace::Point(point) => spec.at_point(point.min(beam.order - 1)).section,
        SectionPlace::End => spec.at_node(beam.order).section,
    }
}

/// Extreme stresses at a place of a beam: of its fibres where its material yields, which ends have none of, otherwise by its resultants.
fn stresses(model: &Model, beam: &Beam, section: usize, at: &IntegrationPoint) -> Option<BeamStresses> {
    let by_resultants = || elastic_stresses(model, section, &at.forces);
    match &beam.yielding {
        None => by_resultants(),
        Some(yielding) if yielding.shear => at.stresses,
        Some(_) => {
            // Shear stays elastic here, apart from the fibres.
            let [most, least, _, mises] = at.stresses?.values;
            Some(BeamStresses { values: [most, least, by_resultants()?.values[2], mises] })
        }
    }
}

/// True where stresses of elastic beams are judged: the deck has units.
pub fn judges_stresses(model: &Model) -> bool {
    model.output.units.is_some()
        && model.each::<Beam>().any(|beam| beam.yielding.is_none() && !beam.elements.is_empty())
}

/// The largest strain of beams that stay elastic, as part, normal stress and strain. Materials of low modulus, in the unit of stress
/// of the deck, stay elastic far beyond others and do not count.
pub fn largest_elastic_strain(model: &Model, points: &[SectionPoint]) -> Option<(usize, [f64; 2])> {
    let softest = SOFT / UnitSystem::find(model.output.units.as_deref()?)?.pascals();
    let strained = points.iter().filter_map(|point| {
        let beam = Beam::of(&model.parts[point.part]).filter(|beam| beam.yielding.is_none())?;
        let section = section_at(beam, point.element, point.place);
        let modulus = model.stiffnesses[section].N[(0, 0)] / model.stresses[section].as_ref()?.area();
        let [most, least, ..] = point.at.stresses?.values;
        let stress = most.max(-least);
        Some((point.part, [stress, stress / modulus])).filter(|_| modulus >= softest && stress.is_finite())
    });
    strained.max_by(|(_, a), (_, b)| a[1].total_cmp(&b[1]))
}

/// Replaces extreme stresses of elastic beams by those of their resultants.
pub fn renew_stresses(model: &Model, points: &mut [SectionPoint]) {
    for point in points {
        let Some(beam) = Beam::of(&model.parts[point.part]) else { continue };
        let section = section_at(beam, point.element, point.place);
        point.at.stresses = elastic_stresses(model, section, &point.at.forces);
    }
}

/// Extreme stresses of an elastic section; `None` of one that does not say where its area is.
pub fn elastic_stresses(model: &Model, section: usize, forces: &[f64; 6]) -> Option<BeamStresses> {
    Some(model.stresses.get(section)?.as_ref()?.extremes(forces))
}
