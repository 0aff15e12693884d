//! Temperatures of curved elements, see [`crate::elements::shell`]'s other elements: the strains that they have without stress.

use super::kinematics::{CurvedHeat, CurvedShell, CurvedShells, CurvedStrain};
use super::sampling::CurvedStrains;
use crate::elements::heat::{Heat, HeatNodes};
use crate::elements::shell::heated::bending;
use crate::elements::shell::nodal_vectors::NodalVectors;
use crate::elements::shell::section::ShellSections;
use crate::state::Configuration;
use base::math::Vec3;
use std::array::from_fn;
use std::sync::Arc;

impl<const N: usize, const V: usize, const P: usize, const Q: usize, S> CurvedShell<N, V, P, Q, S> {
    /// The derivatives of the strains by the change of size, and by the curvature.
    fn units(&self, x: &[Vec3]) -> [CurvedStrain<N, P, Q>; 2] {
        let places = self.nodes.map(|node| x[node]);
        let none = [Vec3::zeros(); N];
        let at = places.map(|place| place - places[0]);
        let start = NodalVectors { x: at, triads: [self.D, self.T.map(|t| t[0]), self.T.map(|t| t[1])] };
        let [sunk, turned] = bending(&places);
        let sunk = from_fn(|a| sunk[a] - sunk[0]);
        let ways = [NodalVectors { x: at, triads: [none; 3] }, NodalVectors { x: sunk, triads: [turned, none, none] }];
        // Strains are of second degree, so differences are exact.
        ways.map(|way| self.measure(&start.plus(1.0, &way)).less(&self.measure(&start.plus(-1.0, &way)), 0.5))
    }
}

impl<K, const N: usize, const V: usize, const P: usize, const Q: usize, S> CurvedShells<K, N, V, P, Q, S>
where
    K: CurvedStrains<N, V, P, Q>,
    S: ShellSections<P, P, f64>,
{
    /// Returns the shells with their temperatures. `x`: positions of all nodes at t = 0.
    pub fn heated(mut self, heat: &Heat, x: &[Vec3]) -> Self {
        let own = self.elements.iter().map(|element| &element.nodes[..]);
        let Some(nodes) = HeatNodes::new(heat, own, x).map(Arc::new) else { return self };
        for (e, element) in self.elements.iter_mut().enumerate() {
            let (factor, unit) = (nodes.factor(e), element.units(x));
            element.heat = Some(Box::new(CurvedHeat { nodes: Arc::clone(&nodes), factor, unit }));
        }
        self.heat = Some(nodes);
        self
    }

    /// The part of the memory of a matrix for the nodes of the element itself.
    pub(super) fn own_matrix<'k>(&self, K: &'k mut [f64]) -> &'k mut [f64] {
        if self.heat.is_some() { &mut K[..36 * N * N] } else { K }
    }

    /// Widens the matrix of an element by the rows and columns of its temperatures, with its stiffness before it yields.
    pub(super) fn widen(&self, e: usize, now: &Configuration, K: &mut [f64]) {
        let element = &self.elements[e];
        let Some(heat) = &element.heat else { return };
        let (failed, motion) = (element.section.has_failed(0, now.history), element.gather(now.nodes));
        heat.nodes.widen(6, K, |of, column| {
            if failed {
                column.fill(0.0);
                return [0.0; 3];
            }
            let unit = heat.derivative(of, now.nodes);
            let stress = element.elastic_stress(&unit).less(&CurvedStrain::ZERO, -1.0);
            let gradient = element.gradient(&stress, &motion);
            for a in 0..N {
                let moment: Vec3 = (0..3).map(|k| motion.triads[k][a].cross(&gradient.triads[k][a])).sum();
                column[6 * a..6 * a + 3].copy_from_slice(gradient.x[a].as_slice());
                column[6 * a + 3..6 * a + 6].copy_from_slice(moment.as_slice());
            }
            let mut work = heat.work(&stress, now.nodes);
            if of == 0 {
                // By the second derivative of the strains by the change of size.
                let plane = element.elastic_stress(&element.strains(&motion, now.nodes)).plane;
                let [size, _] = &heat.unit;
                let second: f64 = plane.membrane.iter().zip(&size.plane.membrane).map(|(s, unit)| s * unit).sum();
                work[0] += heat.factor * heat.factor * second;
            }
            work
        });
    }
}
