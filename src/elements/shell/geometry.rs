//! What a kind of element is, and what the undeformed geometry makes of it, once.

use super::layers::{Layered, Yielding};
use super::section::Plane;
use super::{Description, Motion, Plate, SHEAR_FACTOR, Shell, Shells, Strains, UNEVEN};
use crate::elements::ElementBlock;
use crate::math::Vec3;
use nalgebra::{Matrix3, SMatrix, Vector2, Vector3};
use std::array::from_fn;
use std::marker::PhantomData;

/// A kind of element: its interpolation, with N nodes and V vectors that make up the slopes of the surface.
pub trait Kind<const N: usize, const V: usize>: Send + Sync + Sized {
    /// The vectors v_i = Σ SLOPES[i][a] x_a.
    const SLOPES: [[f64; N]; V];
    /// Ends of the edges at whose middles shear is taken, in the direction of the coordinate along them.
    const EDGES: [[usize; 2]; N];
    /// Integration points (ξ, η), as many as nodes, of equal weight.
    const POINTS: [[f64; 2]; N];
    /// Shape functions there.
    const VALUES: [[f64; N]; N];
    /// Area of the parameters' domain.
    const AREA: f64;
    /// Flexibility of bending within the element, put into its shear: κGh → κGh h²/(h² + α ℓ²), ℓ the longest edge
    /// (Lyly, Stenberg & Vihinen 1993; MacNeal 1978 for beams).
    const FLEXIBILITY: f64;
    /// Where the axes of the plane are taken.
    const CENTRE: [f64; 2];
    /// See [`super::arc`]: a 24th of the squares of the element's spans in its coordinates.
    const ARC: [[f64; 2]; 2];
    /// x,ξ and x,η as sums of the v_i.
    fn slopes(at: [f64; 2]) -> [[f64; V]; 2];
    /// Shear strains of (ξ, η) as sums of those of the edges, x,along·d with the whole edge for x,along.
    fn shear(at: [f64; 2]) -> [[f64; N]; 2];
}

/// Bilinear; x,ξ = v₀ + η v₂ and x,η = v₁ + ξ v₂.
pub struct Quadrilateral;

/// Linear.
pub struct Triangle;

const GAUSS: f64 = 0.577_350_269_189_625_8;
const NEAR: f64 = 0.25 * (1.0 + GAUSS) * (1.0 + GAUSS);
const FAR: f64 = 0.25 * (1.0 - GAUSS) * (1.0 - GAUSS);
const SIDE: f64 = 0.25 * (1.0 - GAUSS * GAUSS);

impl Kind<4, 3> for Quadrilateral {
    const SLOPES: [[f64; 4]; 3] = [[-0.25, 0.25, 0.25, -0.25], [-0.25, -0.25, 0.25, 0.25], [0.25, -0.25, 0.25, -0.25]];
    const EDGES: [[usize; 2]; 4] = [[0, 1], [1, 2], [3, 2], [0, 3]];
    const POINTS: [[f64; 2]; 4] = [[-GAUSS, -GAUSS], [GAUSS, -GAUSS], [GAUSS, GAUSS], [-GAUSS, GAUSS]];
    const VALUES: [[f64; 4]; 4] =
        [[NEAR, SIDE, FAR, SIDE], [SIDE, NEAR, SIDE, FAR], [FAR, SIDE, NEAR, SIDE], [SIDE, FAR, SIDE, NEAR]];
    const AREA: f64 = 4.0;
    const FLEXIBILITY: f64 = 0.0;
    const CENTRE: [f64; 2] = [0.0, 0.0];
    const ARC: [[f64; 2]; 2] = [[1.0 / 6.0, 0.0], [0.0, 1.0 / 6.0]];

    fn slopes([xi, eta]: [f64; 2]) -> [[f64; 3]; 2] {
        [[1.0, 0.0, eta], [0.0, 1.0, xi]]
    }

    fn shear([xi, eta]: [f64; 2]) -> [[f64; 4]; 2] {
        // Edges run over two units of ξ or η.
        let (below, above, left, right) =
            (0.25 * (1.0 - eta), 0.25 * (1.0 + eta), 0.25 * (1.0 - xi), 0.25 * (1.0 + xi));
        [[below, 0.0, above, 0.0], [0.0, right, 0.0, left]]
    }
}

const SIXTH: f64 = 1.0 / 6.0;
const THIRDS: f64 = 2.0 / 3.0;

impl Kind<3, 2> for Triangle {
    const SLOPES: [[f64; 3]; 2] = [[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]];
    const EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [0, 2]];
    const POINTS: [[f64; 2]; 3] = [[SIXTH, SIXTH], [THIRDS, SIXTH], [SIXTH, THIRDS]];
    const VALUES: [[f64; 3]; 3] = [[THIRDS, SIXTH, SIXTH], [SIXTH, THIRDS, SIXTH], [SIXTH, SIXTH, THIRDS]];
    const AREA: f64 = 0.5;
    const FLEXIBILITY: f64 = 0.1;
    const CENTRE: [f64; 2] = [1.0 / 3.0, 1.0 / 3.0];
    /// Half the sum of e eᵀ/24 over the edges e: the same from each corner.
    const ARC: [[f64; 2]; 2] = [[1.0 / 24.0, -1.0 / 48.0], [-1.0 / 48.0, 1.0 / 24.0]];

    fn slopes(_: [f64; 2]) -> [[f64; 2]; 2] {
        [[1.0, 0.0], [0.0, 1.0]]
    }

    fn shear([xi, eta]: [f64; 2]) -> [[f64; 3]; 2] {
        // γ_ξ = e₀ + c η, γ_η = e₂ − c ξ with c = e₂ − e₀ − e₁ (Lee & Bathe 2004).
        [[1.0 - eta, -eta, eta], [xi, xi, 1.0 - xi]]
    }
}

/// A point of the undeformed surface.
struct Place<const V: usize> {
    weight: f64,
    /// x,₁ and x,₂ as sums of v, along axes turned from those of the centre by the least rotation.
    slopes: [[f64; V]; 2],
    /// ∂(ξ, η)/∂(s₁, s₂) by rows of 1, 2.
    inverse: [[f64; 2]; 2],
    at: [f64; 2],
}

/// Axes at the centre: two in the plane, the normal.
fn axes<K: Kind<N, V>, const N: usize, const V: usize>(v: &[Vec3; V]) -> [Vec3; 3] {
    let [a, b] = K::slopes(K::CENTRE).map(|s| super::sum(&s, v));
    let normal = a.cross(&b).normalize();
    let first = a.normalize();
    [first, normal.cross(&first), normal]
}

fn places<K: Kind<N, V>, const N: usize, const V: usize>(v: &[Vec3; V], axes: &[Vec3; 3]) -> [Place<V>; N] {
    K::POINTS.map(|at| {
        let slopes = K::slopes(at);
        let [a, b] = slopes.map(|s| super::sum(&s, v));
        let area = a.cross(&b);
        let normal = area.normalize();
        let turn = |t: &Vec3| t - (t.dot(&normal) / (1.0 + axes[2].dot(&normal))) * (axes[2] + normal);
        let (t1, t2) = (turn(&axes[0]), turn(&axes[1]));
        // x,α = J_αi t_i.
        let J = [[a.dot(&t1), a.dot(&t2)], [b.dot(&t1), b.dot(&t2)]];
        let det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
        let inverse = [[J[1][1] / det, -J[0][1] / det], [-J[1][0] / det, J[0][0] / det]];
        let slopes = inverse.map(|i| from_fn(|k| i[0] * slopes[0][k] + i[1] * slopes[1][k]));
        Place { weight: K::AREA / N as f64 * area.norm(), slopes, inverse, at }
    })
}

/// Parts of the area that belong to the nodes: ∫ N_a dA.
pub fn shares(x: &[Vec3]) -> [f64; 4] {
    products(x).map(|row| row.iter().sum())
}

/// What a unit of pressure along the normal does to the nodes: ∫ N_a n dA.
pub fn faces(x: &[Vec3]) -> [Vec3; 4] {
    fn of<K: Kind<N, V>, const N: usize, const V: usize>(x: &[Vec3]) -> [Vec3; 4] {
        let x: [Vec3; N] = from_fn(|a| x[a]);
        let v = Motion::slopes::<K, V>(&x);
        let normals = K::POINTS.map(|at| {
            let [a, b] = K::slopes(at).map(|s| super::sum(&s, &v));
            K::AREA / N as f64 * a.cross(&b)
        });
        let face = |a: usize| normals.iter().zip(&K::VALUES).map(|(n, value)| value[a] * n).sum();
        from_fn(|a| if a < N { face(a) } else { Vec3::zeros() })
    }
    if x.len() == 3 { of::<Triangle, 3, 2>(x) } else { of::<Quadrilateral, 4, 3>(x) }
}

/// ∫ N_a N_b dA over an element with its three or four corners at `x`.
pub fn products(x: &[Vec3]) -> [[f64; 4]; 4] {
    fn of<K: Kind<N, V>, const N: usize, const V: usize>(x: &[Vec3]) -> [[f64; 4]; 4] {
        let x: [Vec3; N] = from_fn(|a| x[a]);
        let v = Motion::slopes::<K, V>(&x);
        let places = places::<K, N, V>(&v, &axes::<K, N, V>(&v));
        let entry =
            |a: usize, b: usize| places.iter().zip(&K::VALUES).map(|(p, value)| p.weight * value[a] * value[b]).sum();
        from_fn(|a| from_fn(|b| if a < N && b < N { entry(a, b) } else { 0.0 }))
    }
    if x.len() == 3 { of::<Triangle, 3, 2>(x) } else { of::<Quadrilateral, 4, 3>(x) }
}

/// Stress modes at a place: constant stresses, and for the quadrilateral the two along the coordinates that grow across them
/// (Pian & Sumihara 1984). `from`: where ξ and η have no moment.
fn modes<const M: usize>(at: [f64; 2], from: [f64; 2], along: &[Vector2<f64>; 2]) -> SMatrix<f64, 3, M> {
    let mut P = SMatrix::<f64, 3, M>::zeros();
    for i in 0..3 {
        P[(i, i)] = 1.0;
    }
    for mode in 3..M {
        let (j, across) = (along[mode - 3], 4 - mode);
        let s = at[across] - from[across];
        P.set_column(mode, &(s * Vector3::new(j.x * j.x, j.y * j.y, j.x * j.y)));
    }
    P
}

/// What a section needs to know of its element: strains (ε₁, ε₂, γ₁₂) at its integration points as sums of the element's.
pub(super) struct Spread<const M: usize> {
    pub A: SMatrix<f64, 3, M>,
    pub weight: f64,
}

impl<K, const N: usize, const V: usize, const M: usize> Shells<K, N, V, M>
where
    K: Kind<N, V>,
{
    /// Elastic shells. `x`: initial positions of all nodes; `damping`: factor of stiffness-proportional damping (time).
    pub fn new<'a>(
        elements: impl Iterator<Item = Description<'a>>,
        x: &[Vec3],
        plate: &Plate,
        damping: f64,
    ) -> Shells<K, N, V, M> {
        build(elements, x, plate, damping, |elastic, _| elastic)
    }
}

impl Yielding {
    /// Shells whose layers yield.
    pub fn shells<'a, K, const N: usize, const V: usize, const M: usize>(
        &self,
        elements: impl Iterator<Item = Description<'a>>,
        x: &[Vec3],
        plate: &Plate,
        damping: f64,
    ) -> Box<dyn ElementBlock>
    where
        K: Kind<N, V> + 'static,
    {
        let layers = self.layers(plate.thickness);
        let mut first = 0;
        let section = |elastic, spread: Vec<Spread<M>>| {
            let section = Layered::new(&layers, elastic, spread, first);
            first += super::Section::<M>::history(&section);
            section
        };
        Box::new(build::<K, N, V, M, _>(elements, x, plate, damping, section))
    }
}

fn build<'a, K, const N: usize, const V: usize, const M: usize, S>(
    elements: impl Iterator<Item = Description<'a>>,
    x: &[Vec3],
    plate: &Plate,
    damping: f64,
    mut section: impl FnMut(Plane<M>, Vec<Spread<M>>) -> S,
) -> Shells<K, N, V, M, S>
where
    K: Kind<N, V>,
{
    let elements = elements.map(|e| shell::<K, N, V, M, S>(&e, x, plate, &mut section)).collect();
    Shells { elements, damping, kind: PhantomData }
}

fn shell<K, const N: usize, const V: usize, const M: usize, S>(
    e: &Description,
    x: &[Vec3],
    plate: &Plate,
    section: &mut impl FnMut(Plane<M>, Vec<Spread<M>>) -> S,
) -> Shell<N, V, M, S>
where
    K: Kind<N, V>,
{
    let Plate { thickness: h, E, nu, .. } = *plate;
    let nodes: [usize; N] = from_fn(|a| e.nodes[a]);
    let X: [Vec3; N] = from_fn(|a| x[nodes[a]] - x[nodes[0]]);
    let D: [Vec3; N] = from_fn(|a| e.normals[a]);
    let v = Motion::slopes::<K, V>(&X);
    let axes = axes::<K, N, V>(&v);
    let places = places::<K, N, V>(&v, &axes);

    // Stress P β, strain C⁻¹ P β with β = H⁻¹ γ, H = ∫ PᵀC⁻¹P, where γ = ∫ Pᵀε are the strains that the element feels.
    let compliance = Matrix3::new(1.0, -nu, 0.0, -nu, 1.0, 0.0, 0.0, 0.0, 2.0 * (1.0 + nu)) / E;
    let area: f64 = places.iter().map(|p| p.weight).sum();
    let from = [0, 1].map(|i| places.iter().map(|p| p.weight * p.at[i]).sum::<f64>() / area);
    let along = K::slopes(K::CENTRE).map(|s| {
        let a = super::sum(&s, &v);
        Vector2::new(a.dot(&axes[0]), a.dot(&axes[1]))
    });
    // Modes of the size of one, whatever the element's.
    let size = along[0].norm().max(along[1].norm());
    let along = along.map(|a| a / size);
    let modes: [SMatrix<f64, 3, M>; N] = from_fn(|g| modes(places[g].at, from, &along));
    let mut H = SMatrix::<f64, M, M>::zeros();
    let mut Q = [[[0.0; V]; V]; M];
    for (place, P) in places.iter().zip(&modes) {
        H += place.weight * P.transpose() * compliance * P;
        let [s1, s2] = &place.slopes;
        for m in 0..M {
            let w = |i| place.weight * P[(i, m)];
            for i in 0..V {
                for j in 0..V {
                    Q[m][i][j] += w(0) * s1[i] * s1[j] + w(1) * s2[i] * s2[j] + w(2) * (s1[i] * s2[j] + s2[i] * s1[j]);
                }
            }
        }
    }
    let inverse = H.try_inverse().unwrap_or_else(SMatrix::zeros);
    let inverse = 0.5 * (inverse + inverse.transpose());
    let spread =
        places.iter().zip(&modes).map(|(place, P)| Spread { A: compliance * P * inverse, weight: place.weight });
    let elastic = Plane::new(from_fn(|i| from_fn(|j| h * inverse[(i, j)])), h * h / 12.0);

    let G = 0.5 * E / (1.0 + nu);
    let mut shear = [[0.0; N]; N];
    let span = K::EDGES.map(|[a, b]| (X[b] - X[a]).norm_squared()).into_iter().fold(0.0, f64::max);
    let flexible = h * h / (h * h + K::FLEXIBILITY * span);
    for place in &places {
        let edges = K::shear(place.at);
        let w = SHEAR_FACTOR * G * h * flexible * place.weight;
        for i in place.inverse {
            let Z: [f64; N] = from_fn(|e| i[0] * edges[0][e] + i[1] * edges[1][e]);
            for a in 0..N {
                for b in 0..N {
                    shear[a][b] += w * Z[a] * Z[b];
                }
            }
        }
    }
    let mut shell = Shell {
        nodes,
        D,
        T: [axes[0], axes[1]],
        Q,
        start: Strains { plane: [[0.0; M]; 2], shear: [0.0; N], drill: [0.0; N] },
        shear,
        slopes: from_fn(|g| places[g].slopes),
        drilling: from_fn(|g| {
            let own = |k: usize| if g == k { UNEVEN } else { 0.0 } + (1.0 - UNEVEN) * places[k].weight / area;
            from_fn(|k| plate.drilling * G * h * places[g].weight * own(k))
        }),
        section: section(elastic, if M == 3 { one(spread) } else { spread.collect() }),
    };
    shell.start = shell.measure::<K, true>(&Motion { x: X, turning: [D, [axes[0]; N], [axes[1]; N]] });
    shell
}

/// Strains that are the same everywhere need one point.
fn one<const M: usize>(spread: impl Iterator<Item = Spread<M>>) -> Vec<Spread<M>> {
    spread.reduce(|sum, more| Spread { weight: sum.weight + more.weight, ..sum }).into_iter().collect()
}
