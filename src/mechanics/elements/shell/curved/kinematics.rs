//! Kinematics of a curved element: from the motion of its nodes to its strains, their rates and their derivatives.

use super::sampling::Sampling;
use crate::elements::block::Force;
use crate::elements::heat::HeatNodes;
use crate::elements::shell::in_plane::InPlane;
use crate::elements::shell::nodal_vectors::{NodalVectors, sum};
use crate::elements::shell::section::{ShellSections, StiffnessPack};
use crate::state::Node;
use base::math::Vec3;
use base::math::curved_faces::{NineNodes, SixNodes};
use std::array::from_fn;
use std::marker::PhantomData;
use std::sync::Arc;

/// One curved element: N nodes, V slopes of the surface, P products of them, Q transverse shears.
pub(super) struct CurvedShell<const N: usize, const V: usize, const P: usize, const Q: usize, S> {
    /// Nodes, counter-clockwise about the normal: corners, then sides, then the middle.
    pub nodes: [usize; N],
    /// Directors at t = 0.
    pub D: [Vec3; N],
    /// Vectors p, q of the nodes at t = 0 that measure drilling, ½ (x,r·p + x,s·q).
    pub T: [[Vec3; 2]; N],
    /// Where strains are taken.
    pub sampling: &'static Sampling<N, V, P, Q>,
    /// Slopes along r and s at the nodes, by the nodes.
    pub at_nodes: &'static [[[f64; N]; 2]; N],
    /// Strains at t = 0.
    pub start: CurvedStrain<N, P, Q>,
    /// Stiffness of transverse shear.
    pub shear: [[f64; Q]; Q],
    /// Stiffness of drilling of a node, and of the mean of all.
    pub drilling: [f64; 2],
    /// Strains by temperature; `None` where nothing heats the element.
    pub heat: Option<Box<CurvedHeat<N, P, Q>>>,
    /// The sections at its integration points.
    pub section: S,
}

/// The temperatures of an element.
pub(super) struct CurvedHeat<const N: usize, const P: usize, const Q: usize> {
    pub nodes: Arc<HeatNodes>,
    /// The factor on the change of size.
    pub factor: f64,
    /// Derivatives of the strains by the change of size, and by the curvature.
    pub unit: [CurvedStrain<N, P, Q>; 2],
}

impl<const N: usize, const P: usize, const Q: usize> CurvedHeat<N, P, Q> {
    /// Strains less those without stress. Products of slopes are of second degree in the change of size.
    pub fn less(&self, strains: CurvedStrain<N, P, Q>, nodes: &[Node]) -> CurvedStrain<N, P, Q> {
        let [growth, curvature, _] = self.nodes.strain(nodes);
        let growth = self.factor * growth;
        let [size, bend] = &self.unit;
        let mut grown = size.less(&CurvedStrain::ZERO, growth);
        grown.plane.membrane.iter_mut().for_each(|number| *number *= 1.0 + 0.5 * growth);
        strains.less(&grown, 1.0).less(&bend.less(&CurvedStrain::ZERO, curvature), 1.0)
    }

    /// The derivative of the strains without stress by one of them.
    pub fn derivative(&self, of: usize, nodes: &[Node]) -> CurvedStrain<N, P, Q> {
        let mut unit = self.unit[of.min(1)];
        if of == 0 {
            let growth = self.factor * self.nodes.strain(nodes)[0];
            unit.plane.membrane.iter_mut().for_each(|number| *number *= 1.0 + growth);
            unit = unit.less(&CurvedStrain::ZERO, self.factor);
        }
        unit
    }

    /// The work of a stress by each of the strains.
    pub fn work(&self, stress: &CurvedStrain<N, P, Q>, nodes: &[Node]) -> [f64; 3] {
        [stress.dot(&self.derivative(0, nodes)), stress.dot(&self.derivative(1, nodes)), 0.0]
    }

    /// Subtracts the forces of the temperatures on their nodes from `F`.
    pub fn subtract_forces(&self, stress: &CurvedStrain<N, P, Q>, nodes: &[Node], F: &mut [Force]) {
        self.nodes.subtract_forces(&self.work(stress, nodes), F);
    }
}

/// σ·∂²ε, which is bilinear in positions and directors.
pub(super) struct StrainHessian<const N: usize> {
    /// Coefficients of x_a·x_b.
    pub xx: [[f64; N]; N],
    /// Coefficients of x_a·d_b, x_a·p_b and x_a·q_b.
    pub xd: [[[f64; N]; N]; 3],
}

/// The strains of an element, or the stresses conjugate to them.
#[derive(Debug, Clone, Copy)]
pub(super) struct CurvedStrain<const N: usize, const P: usize, const Q: usize> {
    /// Membrane and bending.
    pub plane: InPlane<P, P>,
    /// Transverse shear.
    pub shear: [f64; Q],
    /// Drilling of the nodes.
    pub drilling: [f64; N],
}

impl<const N: usize, const P: usize, const Q: usize> CurvedStrain<N, P, Q> {
    /// None.
    pub const ZERO: Self = CurvedStrain { plane: InPlane::ZERO, shear: [0.0; Q], drilling: [0.0; N] };

    /// σ·ε.
    #[inline(always)]
    pub fn dot(&self, other: &Self) -> f64 {
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        self.plane.dot(&other.plane) + sum(&self.shear, &other.shear) + sum(&self.drilling, &other.drilling)
    }

    /// `factor` (this − other).
    #[inline(always)]
    pub fn less(mut self, other: &Self, factor: f64) -> Self {
        let less = |a: &mut [f64], b: &[f64]| a.iter_mut().zip(b).for_each(|(a, b)| *a = factor * (*a - b));
        less(&mut self.plane.membrane, &other.plane.membrane);
        less(&mut self.plane.bending, &other.plane.bending);
        less(&mut self.shear, &other.shear);
        less(&mut self.drilling, &other.drilling);
        self
    }
}

/// A group of curved shells of one shape `K`, whose sections are of type `S`.
pub struct CurvedShells<K, const N: usize, const V: usize, const P: usize, const Q: usize, S = StiffnessPack<P, P, f64>>
{
    /// The elements.
    pub(super) elements: Vec<CurvedShell<N, V, P, Q, S>>,
    /// The number of history variables of all.
    pub(super) history: usize,
    /// Rayleigh factor on the stiffness (time): stress += factor · C · strain rate.
    pub(super) damping: f64,
    /// Temperatures; `None` where nothing heats the shells.
    pub(super) heat: Option<Arc<HeatNodes>>,
    /// The shape, which holds no data.
    pub(super) shape: PhantomData<K>,
}

/// Quadrilaterals of nine nodes.
pub type CurvedQuadrilaterals<S = StiffnessPack<24, 24, f64>> = CurvedShells<NineNodes, 9, 20, 24, 12, S>;
/// Triangles of six nodes.
pub type CurvedTriangles<S = StiffnessPack<9, 9, f64>> = CurvedShells<SixNodes, 6, 9, 9, 9, S>;

impl<const N: usize, const V: usize, const P: usize, const Q: usize, S> CurvedShell<N, V, P, Q, S> {
    /// Positions and directors of the nodes.
    #[inline(always)]
    pub fn gather(&self, nodes: &[Node]) -> NodalVectors<N> {
        let first = &nodes[self.nodes[0]];
        let mut motion = NodalVectors { x: [Vec3::zeros(); N], triads: [[Vec3::zeros(); N]; 3] };
        for a in 0..N {
            let node = &nodes[self.nodes[a]];
            let R = node.R();
            motion.x[a] = node.relative_position(first);
            motion.triads[0][a] = R * self.D[a];
            motion.triads[1][a] = R * self.T[a][0];
            motion.triads[2][a] = R * self.T[a][1];
        }
        motion
    }

    /// Rates of positions and directors.
    #[inline(always)]
    pub fn rates(&self, motion: &NodalVectors<N>, nodes: &[Node]) -> NodalVectors<N> {
        let node = |a: usize| &nodes[self.nodes[a]];
        NodalVectors {
            x: from_fn(|a| node(a).v - node(0).v),
            triads: motion.triads.map(|d| from_fn(|a| node(a).omega.cross(&d[a]))),
        }
    }

    /// Strains from zero, those at t = 0 included.
    #[inline(always)]
    pub fn measure(&self, motion: &NodalVectors<N>) -> CurvedStrain<N, P, Q> {
        let NodalVectors { x, triads: [d, p, q] } = motion;
        let slopes = &self.sampling.slopes;
        let (v, w) = (NodalVectors::slopes(slopes, x), NodalVectors::slopes(slopes, d));
        let mut strains = CurvedStrain::ZERO;
        for (n, &[i, j]) in self.sampling.pairs.iter().enumerate() {
            strains.plane.membrane[n] = if i == j { 0.5 * v[i].dot(&v[i]) } else { v[i].dot(&v[j]) };
            strains.plane.bending[n] = if i == j { v[i].dot(&w[i]) } else { v[i].dot(&w[j]) + v[j].dot(&w[i]) };
        }
        for (shear, [slope, value]) in strains.shear.iter_mut().zip(&self.sampling.shears) {
            *shear = sum(slope, x).dot(&sum(value, d));
        }
        for a in 0..N {
            let [by_r, by_s] = &self.at_nodes[a];
            strains.drilling[a] = 0.5 * (sum(by_r, x).dot(&p[a]) + sum(by_s, x).dot(&q[a]));
        }
        strains
    }

    /// Strains from t = 0, less those by the temperatures that are among `nodes`.
    #[inline(always)]
    pub fn strains(&self, motion: &NodalVectors<N>, nodes: &[Node]) -> CurvedStrain<N, P, Q> {
        let strains = self.measure(motion).less(&self.start, 1.0);
        match &self.heat {
            None => strains,
            Some(heat) => heat.less(strains, nodes),
        }
    }

    /// Strain rates: half the difference of the strains ahead and behind by a unit of time, which is exact for polynomials of second
    /// degree.
    #[inline(always)]
    pub fn strain_rates(&self, motion: &NodalVectors<N>, rates: &NodalVectors<N>) -> CurvedStrain<N, P, Q> {
        self.measure(&motion.plus(1.0, rates)).less(&self.measure(&motion.plus(-1.0, rates)), 0.5)
    }

    /// The stresses of transverse shear.
    #[inline(always)]
    pub fn shear_stress(&self, shear: &[f64; Q]) -> [f64; Q] {
        from_fn(|i| (0..Q).map(|j| self.shear[i][j] * shear[j]).sum())
    }

    /// The stresses of drilling.
    #[inline(always)]
    pub fn drilling_stress(&self, drilling: &[f64; N]) -> [f64; N] {
        let [own, mean] = self.drilling;
        let all = mean * drilling.iter().sum::<f64>();
        drilling.map(|angle| own * angle + all)
    }

    /// The gradient Bᵀσ: forces, and the derivatives of energy by d, p and q.
    #[inline(always)]
    pub fn gradient(&self, stress: &CurvedStrain<N, P, Q>, motion: &NodalVectors<N>) -> NodalVectors<N> {
        let NodalVectors { x, triads: [d, p, q] } = motion;
        let slopes = &self.sampling.slopes;
        let (v, w) = (NodalVectors::slopes(slopes, x), NodalVectors::slopes(slopes, d));
        let (mut along, mut across) = ([Vec3::zeros(); V], [Vec3::zeros(); V]);
        for (n, &[i, j]) in self.sampling.pairs.iter().enumerate() {
            let (force, moment) = (stress.plane.membrane[n], stress.plane.bending[n]);
            along[i] += force * v[j] + moment * w[j];
            across[i] += moment * v[j];
            if i != j {
                along[j] += force * v[i] + moment * w[i];
                across[j] += moment * v[i];
            }
        }
        let mut gradient = NodalVectors { x: [Vec3::zeros(); N], triads: [[Vec3::zeros(); N]; 3] };
        for i in 0..V {
            for a in 0..N {
                gradient.x[a] += slopes[i][a] * along[i];
                gradient.triads[0][a] += slopes[i][a] * across[i];
            }
        }
        for (stress, [slope, value]) in stress.shear.iter().zip(&self.sampling.shears) {
            let (along, across) = (*stress * sum(value, d), *stress * sum(slope, x));
            for a in 0..N {
                gradient.x[a] += slope[a] * along;
                gradient.triads[0][a] += value[a] * across;
            }
        }
        for a in 0..N {
            let half = 0.5 * stress.drilling[a];
            let [by_r, by_s] = &self.at_nodes[a];
            gradient.triads[1][a] += half * sum(by_r, x);
            gradient.triads[2][a] += half * sum(by_s, x);
            for b in 0..N {
                gradient.x[b] += half * (by_r[b] * p[a] + by_s[b] * q[a]);
            }
        }
        gradient
    }

    /// σ·∂²ε.
    #[inline(always)]
    pub fn strain_hessian(&self, stress: &CurvedStrain<N, P, Q>) -> StrainHessian<N> {
        let mut out = StrainHessian { xx: [[0.0; N]; N], xd: [[[0.0; N]; N]; 3] };
        let slopes = &self.sampling.slopes;
        for (n, &[i, j]) in self.sampling.pairs.iter().enumerate() {
            let (force, moment) = (stress.plane.membrane[n], stress.plane.bending[n]);
            for a in 0..N {
                for b in 0..N {
                    let both = if i == j {
                        slopes[i][a] * slopes[i][b]
                    } else {
                        slopes[i][a] * slopes[j][b] + slopes[j][a] * slopes[i][b]
                    };
                    out.xx[a][b] += force * both;
                    out.xd[0][a][b] += moment * both;
                }
            }
        }
        for (stress, [slope, value]) in stress.shear.iter().zip(&self.sampling.shears) {
            for a in 0..N {
                for b in 0..N {
                    out.xd[0][a][b] += stress * slope[a] * value[b];
                }
            }
        }
        for b in 0..N {
            let half = 0.5 * stress.drilling[b];
            for a in 0..N {
                out.xd[1][a][b] += half * self.at_nodes[b][0][a];
                out.xd[2][a][b] += half * self.at_nodes[b][1][a];
            }
        }
        out
    }
}

impl<const N: usize, const V: usize, const P: usize, const Q: usize, S: ShellSections<P, P, f64>>
    CurvedShell<N, V, P, Q, S>
{
    /// The elastic stress at the given strains.
    #[inline(always)]
    pub fn elastic_stress(&self, strains: &CurvedStrain<N, P, Q>) -> CurvedStrain<N, P, Q> {
        CurvedStrain {
            plane: self.section.elastic().stress(&strains.plane),
            shear: self.shear_stress(&strains.shear),
            drilling: self.drilling_stress(&strains.drilling),
        }
    }

    /// The stress of damping by a factor.
    #[inline(always)]
    pub fn viscous_stress(&self, damping: f64, motion: &NodalVectors<N>, nodes: &[Node]) -> CurvedStrain<N, P, Q> {
        let rates = self.strain_rates(motion, &self.rates(motion, nodes));
        self.elastic_stress(&rates).less(&CurvedStrain::ZERO, damping)
    }
}
