//! Shells as the model describes them, and what is computed once from the undeformed geometry.

use super::interpolation::{Interpolation, Quadrilateral, Triangle};
use super::kinematics::{NodalVectors, Shell, Shells, Strains, sum};
use super::layers::{LayerModel, LayeredSection};
use super::section::{ShellSection, ShellStiffness, StrainOperator};
use crate::elements::block::ElementBlock;
use crate::math::Vec3;
use nalgebra::{Matrix3, SMatrix, Vector2, Vector3};
use std::array::from_fn;
use std::marker::PhantomData;

/// Part of the drilling stiffness that resists drilling of a node other than the element's mean: an element that bends in its
/// plane drills so, its nodes rotating more than its inside.
const UNEVEN: f64 = 0.05;

/// Shear correction factor: shear stress is not constant through the thickness.
const SHEAR_FACTOR: f64 = 5.0 / 6.0;

/// Thickness and elastic constants of a group of elements.
#[derive(Debug, Clone, Copy)]
pub struct Plate {
    /// Thickness h.
    pub thickness: f64,
    /// Young's modulus.
    pub E: f64,
    /// Poisson's ratio.
    pub nu: f64,
    /// Stiffness of drilling over shear modulus times thickness; see [`super::DRILLING`].
    pub drilling: f64,
}

impl Plate {
    fn shear_modulus(&self) -> f64 {
        0.5 * self.E / (1.0 + self.nu)
    }
}

/// One element as the model describes it.
#[derive(Debug, Clone, Copy)]
pub struct ShellGeometry<'a> {
    /// Its three or four nodes, counter-clockwise about the normals.
    pub nodes: &'a [usize],
    /// Unit normals at the nodes at t = 0, which are the directors there.
    pub normals: &'a [Vec3],
}

/// An integration point of the undeformed surface.
struct SurfacePoint<const V: usize> {
    /// Area that belongs to it.
    weight: f64,
    /// Coefficients of v in x,₁ and x,₂, along the axes of the centre rotated into the tangent plane by the least rotation.
    slopes: [[f64; V]; 2],
    /// ∂(ξ, η)/∂(s₁, s₂) by rows of 1, 2.
    inverse: [[f64; 2]; 2],
    /// (ξ, η).
    at: [f64; 2],
}

/// Axes at the centre: two in the tangent plane, and the normal.
fn axes<K: Interpolation<N, V>, const N: usize, const V: usize>(v: &[Vec3; V]) -> [Vec3; 3] {
    let [a, b] = K::slopes(K::CENTRE).map(|s| sum(&s, v));
    let normal = a.cross(&b).normalize();
    let first = a.normalize();
    [first, normal.cross(&first), normal]
}

/// The integration points of an element with the slopes `v`.
fn surface_points<K: Interpolation<N, V>, const N: usize, const V: usize>(
    v: &[Vec3; V],
    axes: &[Vec3; 3],
) -> [SurfacePoint<V>; N] {
    K::POINTS.map(|at| {
        let slopes = K::slopes(at);
        let [a, b] = slopes.map(|s| sum(&s, v));
        let area = a.cross(&b);
        let normal = area.normalize();
        let turn = |t: &Vec3| t - (t.dot(&normal) / (1.0 + axes[2].dot(&normal))) * (axes[2] + normal);
        let (t1, t2) = (turn(&axes[0]), turn(&axes[1]));
        // x,α = J_αi t_i.
        let J = [[a.dot(&t1), a.dot(&t2)], [b.dot(&t1), b.dot(&t2)]];
        let det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
        let inverse = [[J[1][1] / det, -J[0][1] / det], [-J[1][0] / det, J[0][0] / det]];
        let slopes = inverse.map(|i| from_fn(|k| i[0] * slopes[0][k] + i[1] * slopes[1][k]));
        SurfacePoint { weight: K::AREA / N as f64 * area.norm(), slopes, inverse, at }
    })
}

/// ∫ N_a dA over an element with its three or four corners at `x`: the area that belongs to each node, zero beyond them.
pub fn shares(x: &[Vec3]) -> [f64; 4] {
    products(x).map(|row| row.iter().sum())
}

/// ∫ N_a n dA over an element with its three or four corners at `x`: the forces of a unit pressure along the normal.
pub fn faces(x: &[Vec3]) -> [Vec3; 4] {
    fn of<K: Interpolation<N, V>, const N: usize, const V: usize>(x: &[Vec3]) -> [Vec3; 4] {
        let x: [Vec3; N] = from_fn(|a| x[a]);
        let v = NodalVectors::slopes::<K, V>(&x);
        let normals = K::POINTS.map(|at| {
            let [a, b] = K::slopes(at).map(|s| sum(&s, &v));
            K::AREA / N as f64 * a.cross(&b)
        });
        let face = |a: usize| normals.iter().zip(&K::VALUES).map(|(n, value)| value[a] * n).sum();
        from_fn(|a| if a < N { face(a) } else { Vec3::zeros() })
    }
    if x.len() == 3 { of::<Triangle, 3, 2>(x) } else { of::<Quadrilateral, 4, 3>(x) }
}

/// ∫ N_a N_b dA over an element with its three or four corners at `x`: the consistent mass matrix for a unit mass per area.
pub fn products(x: &[Vec3]) -> [[f64; 4]; 4] {
    fn of<K: Interpolation<N, V>, const N: usize, const V: usize>(x: &[Vec3]) -> [[f64; 4]; 4] {
        let x: [Vec3; N] = from_fn(|a| x[a]);
        let v = NodalVectors::slopes::<K, V>(&x);
        let points = surface_points::<K, N, V>(&v, &axes::<K, N, V>(&v));
        let entry =
            |a: usize, b: usize| points.iter().zip(&K::VALUES).map(|(p, value)| p.weight * value[a] * value[b]).sum();
        from_fn(|a| from_fn(|b| if a < N && b < N { entry(a, b) } else { 0.0 }))
    }
    if x.len() == 3 { of::<Triangle, 3, 2>(x) } else { of::<Quadrilateral, 4, 3>(x) }
}

/// The stress modes P at a point: constant stresses, and for the quadrilateral two that act along the directions `along` of ξ and
/// η and vary linearly across them (Pian & Sumihara 1984). `from`: the point (ξ, η) about which they vary, the centroid.
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

impl<K, const N: usize, const V: usize, const M: usize> Shells<K, N, V, M>
where
    K: Interpolation<N, V>,
{
    /// Elastic shells. `x`: positions of all nodes at t = 0; `damping`: factor of stiffness-proportional damping (time).
    pub fn new<'a>(
        elements: impl Iterator<Item = ShellGeometry<'a>>,
        x: &[Vec3],
        plate: &Plate,
        damping: f64,
    ) -> Shells<K, N, V, M> {
        build(elements, x, plate, damping, |elastic, _| elastic)
    }
}

impl LayerModel {
    /// Shells whose layers yield. `x`: positions of all nodes at t = 0; `damping`: factor of stiffness-proportional damping (time).
    pub fn shells<'a, K, const N: usize, const V: usize, const M: usize>(
        &self,
        elements: impl Iterator<Item = ShellGeometry<'a>>,
        x: &[Vec3],
        plate: &Plate,
        damping: f64,
    ) -> Box<dyn ElementBlock>
    where
        K: Interpolation<N, V> + 'static,
    {
        let layers = self.layers(plate.thickness);
        let mut first = 0;
        let section = |elastic, operators: Vec<StrainOperator<M>>| {
            let section = LayeredSection::new(&layers, elastic, operators, first);
            first += ShellSection::<M>::history(&section);
            section
        };
        Box::new(build::<K, N, V, M, _>(elements, x, plate, damping, section))
    }
}

/// Shells whose sections `section` makes from the elastic stiffness of an element and the strains at its integration points.
fn build<'a, K, const N: usize, const V: usize, const M: usize, S>(
    elements: impl Iterator<Item = ShellGeometry<'a>>,
    x: &[Vec3],
    plate: &Plate,
    damping: f64,
    mut section: impl FnMut(ShellStiffness<M>, Vec<StrainOperator<M>>) -> S,
) -> Shells<K, N, V, M, S>
where
    K: Interpolation<N, V>,
{
    let elements = elements.map(|e| shell::<K, N, V, M, S>(&e, x, plate, &mut section)).collect();
    Shells { elements, damping, interpolation: PhantomData }
}

/// An undeformed element with its directors and axes.
fn shell<K, const N: usize, const V: usize, const M: usize, S>(
    e: &ShellGeometry,
    x: &[Vec3],
    plate: &Plate,
    section: &mut impl FnMut(ShellStiffness<M>, Vec<StrainOperator<M>>) -> S,
) -> Shell<N, V, M, S>
where
    K: Interpolation<N, V>,
{
    let nodes: [usize; N] = from_fn(|a| e.nodes[a]);
    let X: [Vec3; N] = from_fn(|a| x[nodes[a]] - x[nodes[0]]);
    let D: [Vec3; N] = from_fn(|a| e.normals[a]);
    let v = NodalVectors::slopes::<K, V>(&X);
    let axes = axes::<K, N, V>(&v);
    let points = surface_points::<K, N, V>(&v, &axes);
    let area: f64 = points.iter().map(|p| p.weight).sum();
    let InPlane { Q, elastic, operators } = in_plane::<K, N, V, M>(&v, &axes, &points, area, plate);
    let mut shell = Shell {
        nodes,
        D,
        T: [axes[0], axes[1]],
        Q,
        start: Strains { plane: [[0.0; M]; 2], shear: [0.0; N], drill: [0.0; N] },
        shear: shear_stiffness::<K, N, V>(&X, &points, plate),
        slopes: from_fn(|g| points[g].slopes),
        drilling: drilling_stiffness(&points, area, plate),
        section: section(elastic, operators),
    };
    shell.start = shell.measure::<K, true>(&NodalVectors { x: X, turning: [D, [axes[0]; N], [axes[1]; N]] });
    shell
}

/// The strains of an element in its plane, and their elastic stiffness.
struct InPlane<const V: usize, const M: usize> {
    /// See [`Shell::Q`].
    Q: [[[f64; V]; V]; M],
    elastic: ShellStiffness<M>,
    /// One for each integration point, or a single one where strains are constant.
    operators: Vec<StrainOperator<M>>,
}

/// Stress P β, strain C⁻¹ P β with β = H⁻¹ γ, H = ∫ PᵀC⁻¹P, where γ = ∫ Pᵀε are the strains of the element.
fn in_plane<K: Interpolation<N, V>, const N: usize, const V: usize, const M: usize>(
    v: &[Vec3; V],
    axes: &[Vec3; 3],
    points: &[SurfacePoint<V>; N],
    area: f64,
    plate: &Plate,
) -> InPlane<V, M> {
    let Plate { thickness: h, E, nu, .. } = *plate;
    let compliance = Matrix3::new(1.0, -nu, 0.0, -nu, 1.0, 0.0, 0.0, 0.0, 2.0 * (1.0 + nu)) / E;
    let from = [0, 1].map(|i| points.iter().map(|p| p.weight * p.at[i]).sum::<f64>() / area);
    let along = K::slopes(K::CENTRE).map(|s| {
        let a = sum(&s, v);
        Vector2::new(a.dot(&axes[0]), a.dot(&axes[1]))
    });
    // Modes are of the order of one whatever the size of the element.
    let size = along[0].norm().max(along[1].norm());
    let along = along.map(|a| a / size);
    let modes: [SMatrix<f64, 3, M>; N] = from_fn(|g| modes(points[g].at, from, &along));
    let mut H = SMatrix::<f64, M, M>::zeros();
    let mut Q = [[[0.0; V]; V]; M];
    for (point, P) in points.iter().zip(&modes) {
        H += point.weight * P.transpose() * compliance * P;
        let [s1, s2] = &point.slopes;
        for m in 0..M {
            let w = |i| point.weight * P[(i, m)];
            for i in 0..V {
                for j in 0..V {
                    Q[m][i][j] += w(0) * s1[i] * s1[j] + w(1) * s2[i] * s2[j] + w(2) * (s1[i] * s2[j] + s2[i] * s1[j]);
                }
            }
        }
    }
    let inverse = H.try_inverse().unwrap_or_else(SMatrix::zeros);
    let inverse = 0.5 * (inverse + inverse.transpose());
    let operators = points.iter().zip(&modes);
    let operators = operators.map(|(point, P)| StrainOperator { A: compliance * P * inverse, weight: point.weight });
    let elastic = ShellStiffness::new(from_fn(|i| from_fn(|j| h * inverse[(i, j)])), h * h / 12.0);
    InPlane { Q, elastic, operators: if M == 3 { merged(operators) } else { operators.collect() } }
}

/// Stiffness of the shear strains at the edges.
fn shear_stiffness<K: Interpolation<N, V>, const N: usize, const V: usize>(
    X: &[Vec3; N],
    points: &[SurfacePoint<V>; N],
    plate: &Plate,
) -> [[f64; N]; N] {
    let (h, G) = (plate.thickness, plate.shear_modulus());
    let mut shear = [[0.0; N]; N];
    let span = K::EDGES.map(|[a, b]| (X[b] - X[a]).norm_squared()).into_iter().fold(0.0, f64::max);
    let flexible = h * h / (h * h + K::FLEXIBILITY * span);
    for point in points {
        let edges = K::shear(point.at);
        let w = SHEAR_FACTOR * G * h * flexible * point.weight;
        for i in point.inverse {
            let Z: [f64; N] = from_fn(|e| i[0] * edges[0][e] + i[1] * edges[1][e]);
            for a in 0..N {
                for b in 0..N {
                    shear[a][b] += w * Z[a] * Z[b];
                }
            }
        }
    }
    shear
}

/// Stiffness of the drilling strains at integration points: of their mean, and by the part [`UNEVEN`] of each by itself.
fn drilling_stiffness<const N: usize, const V: usize>(
    points: &[SurfacePoint<V>; N],
    area: f64,
    plate: &Plate,
) -> [[f64; N]; N] {
    let (h, G) = (plate.thickness, plate.shear_modulus());
    from_fn(|g| {
        let own = |k: usize| if g == k { UNEVEN } else { 0.0 } + (1.0 - UNEVEN) * points[k].weight / area;
        from_fn(|k| plate.drilling * G * h * points[g].weight * own(k))
    })
}

/// One point in place of all, for strains that are constant over the element.
fn merged<const M: usize>(points: impl Iterator<Item = StrainOperator<M>>) -> Vec<StrainOperator<M>> {
    points.reduce(|sum, more| StrainOperator { weight: sum.weight + more.weight, ..sum }).into_iter().collect()
}
