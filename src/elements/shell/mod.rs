//! Shells of directors: triangles of three nodes and quadrilaterals of four, at large displacements and rotations.
//!
//! A point of the reference surface has a position x and a director d, both interpolated from the nodes, where
//! d_a = R_a D_a. Strains are Green's, linear through the thickness, less their values at t = 0:
//!   membrane ½ x,α·x,β    bending ½ (x,α·d,β + x,β·d,α)    shear x,α·d    drilling ½ (t₂·x,₁ − t₁·x,₂),
//! with t₁, t₂ in-plane axes that turn with the nodes: the difference between their rotation about the normal and that of
//! the surface (Hughes & Brezzi 1989), which vanishes in rigid motions and wherever the surface stretches without it.
//! All are polynomials in positions and directors, so they are objective, and no frame goes along: of second degree but for
//! bending, which [`arc`] takes by angles instead of chords.
//!
//! An element feels few numbers only. In the plane: the moments of strain that the stress modes of Pian & Sumihara (1984)
//! pick out, five for the quadrilateral (Wagner & Gruttmann 2005 use them so), three for the triangle, the same for membrane
//! and bending; they cure bending in the plane and, of warped elements, membrane locking. Across: the shear strains at the
//! middles of the edges (Dvorkin & Bathe 1984; Lee & Bathe 2004). Drilling: one for each node. Together just as many as
//! the element has ways to deform. With ε these numbers, energy is U(ε), the gradient Bᵀσ, the Hessian BᵀCB + σ·∂²ε, and
//! ∂²ε is all but constant in positions and directors. A spatial rotation δθ changes a director by δθ × d.
//!
//! Where the material yields, a point of the element strains as its stress modes have it while elastic; nothing inside an
//! element needs iteration or memory but the layers themselves.
//! Nodes that drill do not bulge the edges next to them, though that would cure bending in the plane of distorted elements:
//! membrane forces would then pull at the rotations, about normals that differ from element to element, and in thin sheets
//! under tension nothing holds the rotations against it.
//! Left out: change of thickness, curvature in the volume element (h/R against 1), initial stress.

mod arc;
mod geometry;
mod layers;
mod results;
mod section;
mod tangent;

use super::{ElementBlock, Force, Moduli, Resultants, subtract};
use crate::materials::Dissipation;
use crate::math::Vec3;
use crate::state::{Configuration, Node};
use arc::Arc;
pub use geometry::{Kind, Quadrilateral, Triangle, faces, products, shares};
pub use layers::{MOST_LAYERS, Yielding};
pub use section::Plane;
use section::Section;
use std::marker::PhantomData;

/// Stiffness of drilling, as a part of shear modulus times thickness. From a tenth to ten times of it the hemisphere's
/// deflection moves by 1e-3 of itself; with less, large load steps spin nodes about their normals, to states that are none
/// of the surface's.
pub const DRILLING: f64 = 2e-2;

/// Part of it that resists drilling of an element about its mean: an element that bends in its plane drills so, its nodes
/// turning more than its inside.
const UNEVEN: f64 = 0.05;

/// Shear stress is not constant through the thickness.
const SHEAR_FACTOR: f64 = 5.0 / 6.0;

/// What the elements of a group are made of.
#[derive(Debug, Clone, Copy)]
pub struct Plate {
    pub thickness: f64,
    pub E: f64,
    pub nu: f64,
    /// See [`DRILLING`].
    pub drilling: f64,
}

/// What the deck's part says of one element.
#[derive(Debug, Clone, Copy)]
pub struct Description<'a> {
    /// Counter-clockwise about the normals.
    pub nodes: &'a [usize],
    /// Unit normals at the nodes, D.
    pub normals: &'a [Vec3],
}

/// N nodes, V vectors of the surface's slope, M stress modes.
struct Shell<const N: usize, const V: usize, const M: usize, S> {
    nodes: [usize; N],
    D: [Vec3; N],
    /// In-plane axes at t = 0.
    T: [Vec3; 2],
    /// Plane strains are ½ v·Q v and v·Q w, v the slopes of x and w those of d.
    Q: [[[f64; V]; V]; M],
    /// Strains at t = 0.
    start: Strains<N, M>,
    /// Of the shear strains at the edges.
    shear: [[f64; N]; N],
    /// Per integration point: x,₁ and x,₂ as sums of v.
    slopes: [[[f64; V]; 2]; N],
    /// Of the drilling strains at integration points.
    drilling: [[f64; N]; N],
    section: S,
}

/// The numbers an element feels, or the stresses conjugate to them.
#[derive(Debug, Clone, Copy)]
struct Strains<const N: usize, const M: usize> {
    /// Membrane, bending.
    plane: [[f64; M]; 2],
    shear: [f64; N],
    drill: [f64; N],
}

/// Positions, from the first node, and what turns with the nodes: d, t₁, t₂.
#[derive(Clone, Copy)]
struct Motion<const N: usize> {
    x: [Vec3; N],
    turning: [[Vec3; N]; 3],
}

/// σ·∂²ε: numbers that multiply x_a·x_b, and those that multiply x_a·d_b, x_a·t₁_b, x_a·t₂_b.
struct Curvature<const N: usize> {
    xx: [[f64; N]; N],
    xd: [[[f64; N]; N]; 3],
}

/// A group of shells of one kind.
pub struct Shells<K, const N: usize, const V: usize, const M: usize, S = Plane<M>> {
    elements: Vec<Shell<N, V, M, S>>,
    /// Rayleigh factor on the stiffness: stress += factor · C · strain rate.
    damping: f64,
    kind: PhantomData<K>,
}

pub type Quadrilaterals<S = Plane<5>> = Shells<Quadrilateral, 4, 3, 5, S>;
pub type Triangles<S = Plane<3>> = Shells<Triangle, 3, 2, 3, S>;

#[inline(always)]
fn sum<const V: usize>(factors: &[f64; V], v: &[Vec3; V]) -> Vec3 {
    let mut sum = Vec3::zeros();
    for i in 0..V {
        sum += factors[i] * v[i];
    }
    sum
}

impl<const N: usize> Motion<N> {
    #[inline(always)]
    fn slopes<K: Kind<N, V>, const V: usize>(of: &[Vec3; N]) -> [Vec3; V] {
        std::array::from_fn(|i| sum(&K::SLOPES[i], of))
    }

    /// This + s · other.
    #[inline(always)]
    fn plus(&self, s: f64, other: &Motion<N>) -> Motion<N> {
        Motion {
            x: std::array::from_fn(|a| self.x[a] + s * other.x[a]),
            turning: std::array::from_fn(|k| std::array::from_fn(|a| self.turning[k][a] + s * other.turning[k][a])),
        }
    }
}

impl<const N: usize, const V: usize, const M: usize, S> Shell<N, V, M, S> {
    #[inline(always)]
    fn gather(&self, nodes: &[Node]) -> Motion<N> {
        let first = &nodes[self.nodes[0]];
        let mut motion = Motion { x: [Vec3::zeros(); N], turning: [[Vec3::zeros(); N]; 3] };
        for a in 0..N {
            let node = &nodes[self.nodes[a]];
            let R = node.R();
            motion.x[a] = node.relative_position(first);
            motion.turning[0][a] = R * self.D[a];
            motion.turning[1][a] = R * self.T[0];
            motion.turning[2][a] = R * self.T[1];
        }
        motion
    }

    /// Rates of positions and directors.
    #[inline(always)]
    fn rates(&self, motion: &Motion<N>, nodes: &[Node]) -> Motion<N> {
        let node = |a: usize| &nodes[self.nodes[a]];
        Motion {
            x: std::array::from_fn(|a| node(a).v - node(0).v),
            turning: motion.turning.map(|d| std::array::from_fn(|a| node(a).omega.cross(&d[a]))),
        }
    }

    /// Strains, with those at t = 0; bending by angles with `ARC`, by chords without.
    #[inline(always)]
    fn measure<K: Kind<N, V>, const ARC: bool>(&self, motion: &Motion<N>) -> Strains<N, M> {
        let Motion { x, turning: [d, t1, t2] } = motion;
        let (v, mut w) = (Motion::slopes::<K, V>(x), Motion::slopes::<K, V>(d));
        if ARC {
            w = Arc::new::<K, N>(w).long;
        }
        let mut strains = Strains { plane: [[0.0; M]; 2], shear: [0.0; N], drill: [0.0; N] };
        for i in 0..V {
            for j in 0..V {
                let (membrane, bending) = (0.5 * v[i].dot(&v[j]), v[i].dot(&w[j]));
                for m in 0..M {
                    strains.plane[0][m] += self.Q[m][i][j] * membrane;
                    strains.plane[1][m] += self.Q[m][i][j] * bending;
                }
            }
        }
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            strains.shear[e] = 0.5 * (x[b] - x[a]).dot(&(d[a] + d[b]));
        }
        for g in 0..N {
            let [x1, x2] = self.slopes[g].map(|s| sum(&s, &v));
            strains.drill[g] = 0.5 * (sum(&K::VALUES[g], t2).dot(&x1) - sum(&K::VALUES[g], t1).dot(&x2));
        }
        strains
    }

    #[inline(always)]
    fn strains<K: Kind<N, V>>(&self, motion: &Motion<N>) -> Strains<N, M> {
        let mut strains = self.measure::<K, true>(motion);
        for m in 0..M {
            strains.plane[0][m] -= self.start.plane[0][m];
            strains.plane[1][m] -= self.start.plane[1][m];
        }
        for a in 0..N {
            strains.shear[a] -= self.start.shear[a];
            strains.drill[a] -= self.start.drill[a];
        }
        strains
    }

    /// Rates of strain, bending by chords: half the difference of the strains a rate ahead and behind, exact for polynomials of second degree.
    #[inline(always)]
    fn strain_rates<K: Kind<N, V>>(&self, motion: &Motion<N>, rates: &Motion<N>) -> Strains<N, M> {
        let (mut ahead, behind) =
            (self.measure::<K, false>(&motion.plus(1.0, rates)), self.measure::<K, false>(&motion.plus(-1.0, rates)));
        let half = |a: &mut [f64], b: &[f64]| a.iter_mut().zip(b).for_each(|(a, b)| *a = 0.5 * (*a - b));
        half(ahead.plane.as_flattened_mut(), behind.plane.as_flattened());
        half(&mut ahead.shear, &behind.shear);
        half(&mut ahead.drill, &behind.drill);
        ahead
    }

    /// Stress of shear and drilling.
    #[inline(always)]
    fn across(&self, strains: &Strains<N, M>) -> ([f64; N], [f64; N]) {
        let times = |C: &[[f64; N]; N], e: &[f64; N]| std::array::from_fn(|i| (0..N).map(|j| C[i][j] * e[j]).sum());
        (times(&self.shear, &strains.shear), times(&self.drilling, &strains.drill))
    }

    /// Stress of an element by the pairs of slopes it works on: of the membrane, of bending.
    #[inline(always)]
    fn by_slopes(&self, plane: &[f64; M]) -> [[f64; V]; V] {
        let mut Q = [[0.0; V]; V];
        for m in 0..M {
            for i in 0..V {
                for j in 0..V {
                    Q[i][j] += plane[m] * self.Q[m][i][j];
                }
            }
        }
        Q
    }

    /// With `ARC` all but that of bending, which [`Bending`] has.
    #[inline(always)]
    fn curvature<K: Kind<N, V>, const ARC: bool>(&self, stress: &Strains<N, M>) -> Curvature<N> {
        let mut out = Curvature { xx: [[0.0; N]; N], xd: [[[0.0; N]; N]; 3] };
        for (part, plane) in stress.plane.iter().enumerate().take(if ARC { 1 } else { 2 }) {
            let Q = self.by_slopes(plane);
            let to = if part == 0 { &mut out.xx } else { &mut out.xd[0] };
            for a in 0..N {
                let half: [f64; V] = std::array::from_fn(|j| (0..V).map(|i| K::SLOPES[i][a] * Q[i][j]).sum());
                for b in 0..N {
                    to[a][b] = (0..V).map(|j| half[j] * K::SLOPES[j][b]).sum();
                }
            }
        }
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            let half = 0.5 * stress.shear[e];
            for to in [a, b] {
                out.xd[0][b][to] += half;
                out.xd[0][a][to] -= half;
            }
        }
        for g in 0..N {
            for a in 0..N {
                for (k, along, sign) in [(1, 1, -0.5), (2, 0, 0.5)] {
                    let slope: f64 = (0..V).map(|i| self.slopes[g][along][i] * K::SLOPES[i][a]).sum();
                    let s = sign * stress.drill[g] * slope;
                    for b in 0..N {
                        out.xd[k][a][b] += s * K::VALUES[g][b];
                    }
                }
            }
        }
        out
    }
}

impl<const N: usize> Curvature<N> {
    /// The gradient: forces, and what pulls at d, t₁ and t₂.
    #[inline(always)]
    fn gradient(&self, motion: &Motion<N>) -> Motion<N> {
        let mut gradient = Motion { x: [Vec3::zeros(); N], turning: [[Vec3::zeros(); N]; 3] };
        for a in 0..N {
            gradient.x[a] = sum(&self.xx[a], &motion.x);
            for k in 0..3 {
                gradient.x[a] += sum(&self.xd[k][a], &motion.turning[k]);
                for b in 0..N {
                    gradient.turning[k][b] += self.xd[k][a][b] * motion.x[a];
                }
            }
        }
        gradient
    }
}

/// What the stress of bending does to slopes, by angles.
struct Bending<const V: usize> {
    arc: Arc<V>,
    Q: [[f64; V]; V],
    /// Q v.
    p: [Vec3; V],
}

impl<const V: usize> Bending<V> {
    #[inline(always)]
    fn new<K: Kind<N, V>, const N: usize>(Q: [[f64; V]; V], motion: &Motion<N>) -> Self {
        let v = Motion::slopes::<K, V>(&motion.x);
        let arc = Arc::new::<K, N>(Motion::slopes::<K, V>(&motion.turning[0]));
        Bending { arc, p: std::array::from_fn(|k| sum(&Q[k], &v)), Q }
    }

    #[inline(always)]
    fn add_gradient<K: Kind<N, V>, const N: usize>(&self, gradient: &mut Motion<N>) {
        let g = self.arc.gradient(&self.p);
        for i in 0..V {
            let f = sum(&self.Q[i], &self.arc.long);
            for a in 0..N {
                gradient.x[a] += K::SLOPES[i][a] * f;
                gradient.turning[0][a] += K::SLOPES[i][a] * g[i];
            }
        }
    }
}

impl<K, const N: usize, const V: usize, const M: usize, S> Shells<K, N, V, M, S>
where
    K: Kind<N, V>,
    S: Section<M>,
{
    /// Stress of damping.
    #[inline(always)]
    fn viscous(&self, element: &Shell<N, V, M, S>, motion: &Motion<N>, nodes: &[Node]) -> Strains<N, M> {
        let rates = element.strain_rates::<K>(motion, &element.rates(motion, nodes));
        let mut stress = element.elastic(&rates);
        let times = |a: &mut [f64]| a.iter_mut().for_each(|a| *a *= self.damping);
        times(stress.plane.as_flattened_mut());
        times(&mut stress.shear);
        times(&mut stress.drill);
        stress
    }
}

impl<const N: usize, const V: usize, const M: usize, S: Section<M>> Shell<N, V, M, S> {
    #[inline(always)]
    fn elastic(&self, strains: &Strains<N, M>) -> Strains<N, M> {
        let (shear, drill) = self.across(strains);
        Strains { plane: self.section.elastic().stress(&strains.plane), shear, drill }
    }
}

impl<K, const N: usize, const V: usize, const M: usize, S> ElementBlock for Shells<K, N, V, M, S>
where
    K: Kind<N, V>,
    S: Section<M>,
{
    fn len(&self) -> usize {
        self.elements.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.elements[e].nodes
    }

    fn dofs(&self) -> usize {
        6
    }

    fn is_damped(&self) -> bool {
        self.damping > 0.0
    }

    fn history(&self) -> usize {
        self.elements.iter().map(|e| e.section.history()).sum()
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        for element in &self.elements {
            let motion = element.gather(now.nodes);
            let strains = element.strains::<K>(&motion);
            let (shear, drill) = element.across(&strains);
            let stress = Strains { plane: element.section.stress(&strains.plane, now), shear, drill };
            let mut gradient = element.curvature::<K, true>(&stress).gradient(&motion);
            Bending::new::<K, N>(element.by_slopes(&stress.plane[1]), &motion).add_gradient::<K, N>(&mut gradient);
            if self.damping > 0.0 {
                let viscous = self.viscous(element, &motion, now.nodes);
                gradient = gradient.plus(1.0, &element.curvature::<K, false>(&viscous).gradient(&motion));
            }
            for a in 0..N {
                let f = &mut F[element.nodes[a]];
                subtract(f, 0, &gradient.x[a]);
                let mut moment = Vec3::zeros();
                for k in 0..3 {
                    moment += motion.turning[k][a].cross(&gradient.turning[k][a]);
                }
                subtract(f, 3, &moment);
            }
        }
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, K: &mut [f64]) {
        if self.damping > 0.0 {
            self.tangent_of::<true>(e, now, rate_weight, moduli, K);
        } else {
            self.tangent_of::<false>(e, now, rate_weight, moduli, K);
        }
    }

    fn update_history(&self, now: &Configuration, part: f64, history: &mut [f64]) -> Dissipation {
        let mut spent = Dissipation::default();
        for element in &self.elements {
            let strains = element.strains::<K>(&element.gather(now.nodes));
            spent += element.section.update_history(&strains.plane, now, part, history);
        }
        spent
    }

    fn energy(&self, now: &Configuration) -> f64 {
        let mut sum = 0.0;
        for element in &self.elements {
            let strains = element.strains::<K>(&element.gather(now.nodes));
            let (shear, drill) = element.across(&strains);
            sum += element.section.energy(&strains.plane, now);
            for a in 0..N {
                sum += 0.5 * (shear[a] * strains.shear[a] + drill[a] * strains.drill[a]);
            }
        }
        sum
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        if self.damping == 0.0 {
            return 0.0;
        }
        let mut sum = 0.0;
        for element in &self.elements {
            let motion = element.gather(now.nodes);
            let rates = element.strain_rates::<K>(&motion, &element.rates(&motion, now.nodes));
            let stress = element.elastic(&rates);
            let power = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            sum += power(stress.plane.as_flattened(), rates.plane.as_flattened())
                + power(&stress.shear, &rates.shear)
                + power(&stress.drill, &rates.drill);
        }
        self.damping * sum
    }

    fn resultants(&self, e: usize, axis: &Vec3, start: &[Vec3], now: &Configuration) -> Option<Resultants> {
        self.resultants_of(e, axis, start, now)
    }

    fn plastic_strain(&self, e: usize, past: &[f64]) -> f64 {
        self.elements[e].section.plastic_strain(past)
    }
}
