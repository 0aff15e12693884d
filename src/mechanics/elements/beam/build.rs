//! Beams as the model describes them, and the quantities computed once from the undeformed geometry.

use super::composite::{CompositeProfile, CompositeSection, FibreGroup};
use super::fibres::{FibreProfile, FibreSection};
use super::kinematics::{Beam, BeamHeat, Beams};
use super::section::{BeamSection, BeamStiffness};
use super::shape::{IntegrationRule, ShapeFunctions};
use super::varied::VariedSection;
use crate::elements::block::ElementBlock;
use crate::elements::heat::{Heat, HeatNodes};
use crate::materials::uniaxial::UniaxialLaw;
use crate::materials::{FibreStress, MaterialLaw, StressState, Uniaxial};
use crate::sections::{Fibre, Stiffness, balance};
use base::math::{Mat3, Vec3};
use std::collections::HashMap;
use std::sync::Arc;

/// One element as the model describes it.
pub struct BeamGeometry<'a> {
    /// Its nodes from one end to the other.
    pub nodes: &'a [usize],
    /// Tangent and section axes at t = 0: columns, global components.
    pub frame: &'a Mat3,
    /// Stiffness of its section, in section axes.
    pub stiffness: &'a Stiffness,
    /// Stiffness and axes of its sections at the integration points, where they differ.
    pub varied: Option<[(&'a Stiffness, &'a Mat3); 4]>,
}

/// What all elements of a beam have in common.
#[derive(Clone, Copy)]
pub struct BeamSetting<'a> {
    /// Positions of all nodes at t = 0.
    pub x: &'a [Vec3],
    /// Factor of stiffness-proportional damping (time).
    pub damping: f64,
    /// Temperatures.
    pub heat: &'a Heat,
}

/// Elastic beams of a polynomial order, 1 to 4. All kinds of beams are made here, so that no other crate compiles them again.
pub fn elastic_beams(order: usize, elements: &[BeamGeometry], setting: BeamSetting) -> Box<dyn ElementBlock> {
    match (order, elements.iter().any(|element| element.varied.is_some())) {
        (1, false) => Box::new(Beams::<2>::new(elements, setting)),
        (2, false) => Box::new(Beams::<3>::new(elements, setting)),
        (3, false) => Box::new(Beams::<4>::new(elements, setting)),
        (_, false) => Box::new(Beams::<5>::new(elements, setting)),
        (1, true) => Box::new(Beams::<2, _>::varied(elements, setting)),
        (2, true) => Box::new(Beams::<3, _>::varied(elements, setting)),
        (3, true) => Box::new(Beams::<4, _>::varied(elements, setting)),
        (_, true) => Box::new(Beams::<5, _>::varied(elements, setting)),
    }
}

/// The section of an element of N nodes and this length that stays elastic.
fn elastic_section<const N: usize>(stiffness: &Stiffness, frame: &Mat3, length: f64) -> BeamStiffness {
    match N {
        2 => BeamStiffness::new(&with_bending_flexibility(stiffness, length), frame),
        _ => BeamStiffness::new(stiffness, frame),
    }
}

impl<const N: usize> Beams<N> {
    fn new(elements: &[BeamGeometry], setting: BeamSetting) -> Self {
        let section = |e: &BeamGeometry, length| elastic_section::<N>(e.stiffness, e.frame, length);
        Beams::build(elements, setting, IntegrationRule::Gauss.points(N - 1), section)
    }
}

impl<const N: usize> Beams<N, VariedSection> {
    fn varied(elements: &[BeamGeometry], setting: BeamSetting) -> Self {
        let section = |e: &BeamGeometry, length| {
            let at = |(stiffness, frame)| elastic_section::<N>(stiffness, frame, length);
            VariedSection(Box::new(e.varied.unwrap_or([(e.stiffness, e.frame); 4]).map(at)))
        };
        Beams::build(elements, setting, IntegrationRule::Gauss.points(N - 1), section)
    }
}

/// A section of fibres of one or several materials of which one yields.
#[derive(Debug, Clone)]
pub struct FibreModel {
    /// The fibres of the section by material.
    pub groups: Vec<FibreGroup>,
    /// Shear stress enters the yield condition; otherwise shear and torsion stay elastic.
    pub shear: bool,
    /// The integration rule along the length of an element.
    pub rule: IntegrationRule,
    /// The number of integration points of an element, at least its order.
    pub points: usize,
}

impl FibreModel {
    /// Beams of a polynomial order, 1 to 4, all of one section. The shear stiffness of two-node elements is not corrected, because the
    /// correction is that of an elastic beam.
    pub fn beams(&self, order: usize, elements: &[BeamGeometry], setting: BeamSetting) -> Box<dyn ElementBlock> {
        match order {
            1 => self.of_nodes::<2>(elements, setting),
            2 => self.of_nodes::<3>(elements, setting),
            3 => self.of_nodes::<4>(elements, setting),
            _ => self.of_nodes::<5>(elements, setting),
        }
    }

    /// The law and the fibres of a section of one material with J2 plasticity; `None` of all others.
    pub fn plastic(&self) -> Option<(&MaterialLaw, &[Fibre])> {
        match &self.groups[..] {
            [FibreGroup { law: UniaxialLaw::Plastic(law), fibres }] => Some((law, fibres)),
            _ => None,
        }
    }

    /// True if bending in the plane of x and z (`along_z`) or of x and y causes no moment out of it. Each material has to balance at each
    /// height. `None` is a plane along no axis of the section.
    pub fn stays_in(&self, along_z: Option<bool>) -> bool {
        let balances = |along_z| self.groups.iter().all(|group| balance(&group.fibres, along_z));
        self.plastic().is_some() || along_z.is_some_and(balances)
    }

    /// The number of fibres, without areas that others displace.
    pub fn fibres(&self) -> usize {
        self.groups.iter().flat_map(|group| &group.fibres).filter(|fibre| fibre.area > 0.0).count()
    }

    fn of_nodes<const N: usize>(&self, elements: &[BeamGeometry], setting: BeamSetting) -> Box<dyn ElementBlock> {
        match (self.plastic(), self.shear) {
            (Some(plastic), true) => self.in_state::<N, _, 3>((FibreStress, plastic), elements, setting),
            (Some(plastic), false) => self.in_state::<N, _, 1>((Uniaxial, plastic), elements, setting),
            (None, _) => self.composite::<N>(elements, setting),
        }
    }

    /// Beams of several materials, or of one that has normal stress alone. Points share their fibres where their lengths agree in single
    /// precision, for lengths of equal elements differ by rounding.
    fn composite<const N: usize>(&self, elements: &[BeamGeometry], setting: BeamSetting) -> Box<dyn ElementBlock> {
        let rule = self.rule.points(self.points);
        let needs_length = self.groups.iter().any(|group| group.law.needs_length());
        let (mut profiles, mut first) = (HashMap::new(), 0);
        let section = |e: &BeamGeometry, length: f64| {
            let of_point = |weight: &f64| {
                let own = if needs_length { (0.5 * weight * length) as f32 } else { 1.0 };
                let new = || Arc::new(CompositeProfile::new(&self.groups, own.into(), e.stiffness));
                Arc::clone(profiles.entry(own.to_bits()).or_insert_with(new))
            };
            let section = CompositeSection::new(rule.1.iter().map(of_point).collect(), e.frame, first);
            first += section.history();
            section
        };
        Box::new(Beams::<N, CompositeSection>::build(elements, setting, rule, section))
    }

    /// Beams whose fibres are in the stress state `state`.
    fn in_state<const N: usize, S: StressState<C> + 'static, const C: usize>(
        &self,
        (state, (law, fibres)): (S, (&MaterialLaw, &[Fibre])),
        elements: &[BeamGeometry],
        setting: BeamSetting,
    ) -> Box<dyn ElementBlock> {
        let (mut profile, mut first) = (None, 0);
        let section = |e: &BeamGeometry, _| {
            let new = || Arc::new(FibreProfile::new(law, state, fibres, e.stiffness));
            let section = FibreSection::new(profile.get_or_insert_with(new), e.stiffness, e.frame, first, self.points);
            first += section.history();
            section
        };
        Box::new(Beams::<N, FibreSection<S, C>>::build(elements, setting, self.rule.points(self.points), section))
    }
}

impl<const N: usize, S: BeamSection> Beams<N, S> {
    /// Beams integrated by `rule`; `section` makes the sections of an element of given length.
    fn build(
        elements: &[BeamGeometry],
        BeamSetting { x, damping, heat }: BeamSetting,
        rule: (&'static [f64], &[f64]),
        mut section: impl FnMut(&BeamGeometry, f64) -> S,
    ) -> Self {
        let nodes = HeatNodes::new(heat, elements.iter().map(|e| &e.nodes[..N]), x);
        let axes = |e: &BeamGeometry| [1, 2].map(|k| e.frame.column(k).into_owned());
        let heat = nodes.map(|nodes| BeamHeat { nodes, axes: elements.iter().map(axes).collect() });
        let elements = elements
            .iter()
            .map(|e| {
                let mut nodes = [0; N];
                nodes.copy_from_slice(&e.nodes[..N]);
                let axis = x[nodes[N - 1]] - x[nodes[0]];
                let length = axis.norm();
                let start = nodes.map(|node| x[node]);
                Beam { nodes, start, jacobian: 0.5 * length, tangent: axis / length, section: section(e, length) }
            })
            .collect();
        Beams { shape: ShapeFunctions::new(rule), elements, damping, heat }
    }
}

/// The stiffness of a section with the bending flexibility of an element of the given length added to its shear flexibility,
/// 1/GA + h²/12EI (MacNeal, J. Struct. Mech. 6, 1978). The shear centre stays where it is.
fn with_bending_flexibility(section: &Stiffness, length: f64) -> Stiffness {
    if section.is_coupled() {
        return with_coupled_flexibility(section, length);
    }
    let mut out = section.clone();
    let shear = section.N.fixed_view::<2, 2>(1, 1).into_owned();
    let bending = section.M.fixed_view::<2, 2>(1, 1).into_owned();
    let (Some(shear_flexibility), Some(f)) = (shear.try_inverse(), bending.try_inverse()) else { return out };
    // Q_y bends about z, Q_z about −y.
    let swapped = nalgebra::Matrix2::new(f[(1, 1)], -f[(0, 1)], -f[(1, 0)], f[(0, 0)]);
    let Some(reduced) = (shear_flexibility + swapped * (length * length / 12.0)).try_inverse() else { return out };
    let arm = shear_flexibility * section.NM.fixed_view::<2, 1>(1, 0);
    let coupling = reduced * arm;
    out.N.fixed_view_mut::<2, 2>(1, 1).copy_from(&reduced);
    out.M[(0, 0)] += (arm.tr_mul(&(reduced - shear)) * arm)[(0, 0)];
    out.NM.fixed_view_mut::<2, 1>(1, 0).copy_from(&coupling);
    out
}

/// [`with_bending_flexibility`] for a fully coupled section. The flexibility of bending adds to that of shear in the inverse of the matrix.
fn with_coupled_flexibility(section: &Stiffness, length: f64) -> Stiffness {
    let Some(mut flexibility) = section.matrix().try_inverse() else { return section.clone() };
    let more = length * length / 12.0;
    // Q_y bends about z, Q_z about −y.
    for (i, j, k, l, sign) in [(1, 1, 5, 5, 1.0), (1, 2, 5, 4, -1.0), (2, 1, 4, 5, -1.0), (2, 2, 4, 4, 1.0)] {
        flexibility[(i, j)] += sign * more * flexibility[(k, l)];
    }
    flexibility.try_inverse().map_or_else(|| section.clone(), |K| section.with_matrix(&K))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Elastic bars at these places with these moduli, a material each.
    fn bars(bars: &[([f64; 2], f64)]) -> FibreModel {
        let group = |(places, modulus): (Vec<[f64; 2]>, f64)| FibreGroup {
            law: UniaxialLaw::Elastic(modulus),
            fibres: places.iter().map(|&[y, z]| Fibre { area: 1e-4, y, z, shear: [[0.0; 3]; 2] }).collect(),
        };
        let mut moduli: Vec<f64> = bars.iter().map(|bar| bar.1).collect();
        moduli.dedup();
        let of = |modulus: f64| bars.iter().filter(|bar| bar.1 == modulus).map(|bar| bar.0).collect();
        let groups = moduli.into_iter().map(|modulus| group((of(modulus), modulus))).collect();
        FibreModel { groups, shear: false, rule: IntegrationRule::Gauss, points: 3 }
    }

    /// Bars that mirror each other keep a motion in its plane; the same bars of two materials, and bars across a diagonal, do not.
    #[test]
    fn each_material_balances_about_the_plane() {
        let (left, right, low) = ([-0.1, 0.2], [0.1, 0.2], [0.1, -0.2]);
        let both = |model: FibreModel| [true, false].map(|along_z| model.stays_in(Some(along_z)));
        assert_eq!(both(bars(&[(left, 1.0), (right, 1.0)])), [true, false]);
        assert_eq!(both(bars(&[(right, 1.0), (low, 1.0)])), [false, true]);
        assert_eq!(both(bars(&[(left, 1.0), (right, 2.0)])), [false, false]);
        assert_eq!(both(bars(&[(left, 1.0), (low, 1.0)])), [false, false]);
        // Three bars on a circle balance as elastic ones, but not if they yield one after the other.
        let ring = |n: usize| (0..n).map(move |k| (std::f64::consts::TAU * k as f64 / n as f64).sin_cos());
        let of = |n: usize| ring(n).map(|(z, y)| ([y, z], 1.0)).collect::<Vec<_>>();
        assert_eq!(both(bars(&of(3))), [false, true]);
        assert_eq!(both(bars(&of(4))), [true, true]);
        assert!(!bars(&of(4)).stays_in(None));
    }
}
