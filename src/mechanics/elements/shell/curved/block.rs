//! Forces, energies and results of curved shells.

use super::kinematics::{CurvedShell, CurvedShells, CurvedStrain};
use super::sampling::CurvedStrains;
use super::surface::{CurvedSurface, tangents};
use super::tangent::tangent;
use crate::elements::block::{Branches, Elements, Force, Mechanics, Moduli, Results, subtract};
use crate::elements::results::ShellResultants;
use crate::elements::shell::nodal_vectors::NodalVectors;
use crate::elements::shell::results::MeanStress;
use crate::elements::shell::section::{NewHistory, ShellSections};
use crate::materials::{Dissipation, FAILED_STIFFNESS, Spent};
use crate::state::{Configuration, Node};
use base::math::Vec3;
use std::array::from_fn;

/// The stress of an element in a configuration.
fn stress<const N: usize, const V: usize, const P: usize, const Q: usize, S: ShellSections<P, P, f64>>(
    element: &CurvedShell<N, V, P, Q, S>,
    strains: &CurvedStrain<N, P, Q>,
    now: &Configuration,
) -> CurvedStrain<N, P, Q> {
    CurvedStrain {
        plane: element.section.stress(&strains.plane, now),
        shear: element.shear_stress(&strains.shear),
        drilling: element.drilling_stress(&strains.drilling),
    }
}

/// The elastic energy of an element: in its plane, of shear and of drilling.
fn stored<const N: usize, const V: usize, const P: usize, const Q: usize, S: ShellSections<P, P, f64>>(
    element: &CurvedShell<N, V, P, Q, S>,
    strains: &CurvedStrain<N, P, Q>,
    now: &Configuration,
) -> f64 {
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    element.section.energy(0, &strains.plane, now)
        + 0.5 * sum(&element.shear_stress(&strains.shear), &strains.shear)
        + 0.5 * sum(&element.drilling_stress(&strains.drilling), &strains.drilling)
}

impl<K, const N: usize, const V: usize, const P: usize, const Q: usize, S> Elements for CurvedShells<K, N, V, P, Q, S>
where
    K: CurvedStrains<N, V, P, Q>,
    S: ShellSections<P, P, f64>,
{
    fn len(&self) -> usize {
        self.elements.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        self.heat.as_ref().map_or(&self.elements[e].nodes, |heat| heat.nodes(e))
    }

    fn dofs(&self) -> usize {
        6
    }

    fn is_rotational(&self, _: usize, node: usize) -> bool {
        node < N
    }
}

impl<K, const N: usize, const V: usize, const P: usize, const Q: usize, S> Mechanics for CurvedShells<K, N, V, P, Q, S>
where
    K: CurvedStrains<N, V, P, Q>,
    S: ShellSections<P, P, f64>,
{
    fn is_damped(&self) -> bool {
        self.damping > 0.0
    }

    fn history(&self) -> usize {
        self.history
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        for element in self.elements.iter().filter(|element| !element.section.has_failed(0, now.history)) {
            let motion = element.gather(now.nodes);
            let mut stress = stress(element, &element.strains(&motion, now.nodes), now);
            if let Some(heat) = &element.heat {
                heat.subtract_forces(&stress, now.nodes, F);
            }
            if self.damping > 0.0 {
                // The sum: this less minus one times the other.
                let viscous = element.viscous_stress(-self.damping, &motion, now.nodes);
                stress = stress.less(&viscous, 1.0);
            }
            let gradient = element.gradient(&stress, &motion);
            for a in 0..N {
                let f = &mut F[element.nodes[a]];
                subtract(f, 0, &gradient.x[a]);
                let mut moment = Vec3::zeros();
                for k in 0..3 {
                    moment += motion.triads[k][a].cross(&gradient.triads[k][a]);
                }
                subtract(f, 3, &moment);
            }
        }
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, K: &mut [f64]) {
        let own = self.own_matrix(K);
        tangent(self, e, (now, None), (self.damping > 0.0).then_some(rate_weight), moduli, own);
        if self.elements[e].section.has_failed(0, now.history) {
            own.iter_mut().for_each(|k| *k *= FAILED_STIFFNESS);
        }
        self.widen(e, now, K);
    }

    fn stressed_tangent(&self, e: usize, now: &Configuration, stressed: &[Node], K: &mut [f64]) {
        tangent(self, e, (now, Some(stressed)), None, Moduli::Elastic, self.own_matrix(K));
        self.widen(e, now, K);
    }

    fn update_history(&self, now: &Configuration, part: f64, new: &mut [f64]) -> Dissipation {
        let mut dissipation = Dissipation::default();
        for element in &self.elements {
            let strains = element.strains(&element.gather(now.nodes), now.nodes);
            let mut spent = Spent::ZERO;
            let to = NewHistory { part, new: &mut *new, spent: &mut spent };
            element.section.advance(&strains.plane, now, to);
            dissipation += spent.lane(0);
            if element.section.has_failed(0, new) && !element.section.has_failed(0, now.history) {
                // The layers have counted their own energy already.
                dissipation.eroded += stored(element, &strains, &Configuration { history: new, ..*now });
            }
        }
        dissipation
    }
}

impl<K, const N: usize, const V: usize, const P: usize, const Q: usize, S> Results for CurvedShells<K, N, V, P, Q, S>
where
    K: CurvedStrains<N, V, P, Q>,
    S: ShellSections<P, P, f64>,
{
    fn energy(&self, now: &Configuration) -> f64 {
        let whole = self.elements.iter().filter(|element| !element.section.has_failed(0, now.history));
        whole.map(|element| stored(element, &element.strains(&element.gather(now.nodes), now.nodes), now)).sum()
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        if self.damping == 0.0 {
            return 0.0;
        }
        let of = |element: &CurvedShell<N, V, P, Q, S>| {
            let motion = element.gather(now.nodes);
            let rates = element.strain_rates(&motion, &element.rates(&motion, now.nodes));
            element.elastic_stress(&rates).dot(&rates)
        };
        let whole = self.elements.iter().filter(|element| !element.section.has_failed(0, now.history));
        self.damping * whole.map(of).sum::<f64>()
    }

    fn resultants(
        &self,
        axis: &Vec3,
        start: &dyn Fn(usize) -> Vec3,
        now: &Configuration,
        write: &mut dyn FnMut(usize, ShellResultants),
    ) {
        for (e, element) in self.elements.iter().enumerate() {
            let X: [Vec3; N] = from_fn(|a| start(element.nodes[a]) - start(element.nodes[0]));
            let motion = element.gather(now.nodes);
            let strains = element.strains(&motion, now.nodes);
            // A failed element has no stress.
            let part = if element.section.has_failed(0, now.history) { 0.0 } else { 1.0 };
            let stress = stress(element, &strains, now);
            let at_start = NodalVectors { x: X, triads: [element.D, element.T.map(|t| t[0]), element.T.map(|t| t[1])] };
            let mean = MeanStress::new(X, axis);
            let work = from_fn(|k| {
                let way = mean.way(k);
                let work = |s: f64| part * stress.dot(&element.measure(&at_start.plus(s, &way)));
                0.5 * (work(1.0) - work(-1.0))
            });
            let first = CurvedSurface::new::<K>(X).axes[0];
            let layers = |layers: &mut [_]| element.section.layers(0, &strains.plane, now, layers);
            write(e, mean.resultants(work, &motion, &first, layers));
        }
    }

    fn plastic_strain(&self, e: usize, history: &[f64]) -> f64 {
        self.elements[e].section.plastic_strain(0, history)
    }

    fn can_fail(&self) -> bool {
        self.elements.first().is_some_and(|element| element.section.can_fail())
    }

    fn surface_strains(&self, now: &Configuration, of: &mut dyn FnMut(usize, f64, bool)) {
        // A failed element has no strain to report.
        let whole = self.elements.iter().enumerate().filter(|(_, one)| !one.section.has_failed(0, now.history));
        for (e, element) in whole.filter(|_| self.history > 0) {
            let strain = element.section.surface_strain(&element.strains(&element.gather(now.nodes), now.nodes).plane);
            if let Some((strain, is_logarithmic)) = strain {
                of(e, strain, is_logarithmic);
            }
        }
    }

    fn has_failed(&self, e: usize, history: &[f64]) -> bool {
        self.elements[e].section.has_failed(0, history)
    }
}

impl<K, const N: usize, const V: usize, const P: usize, const Q: usize, S> Branches for CurvedShells<K, N, V, P, Q, S>
where
    K: CurvedStrains<N, V, P, Q>,
    S: ShellSections<P, P, f64>,
{
    fn is_turned_over(&self, e: usize, _: &[Node], now: &[Node]) -> bool {
        let motion = self.elements[e].gather(now);
        // The normal at a corner opposes the director there.
        (0..K::CORNERS).any(|a| {
            let [r, s] = tangents::<K, N>(&motion.x, K::NODES[a]);
            r.cross(&s).dot(&motion.triads[0][a]) < 0.0
        })
    }
}
