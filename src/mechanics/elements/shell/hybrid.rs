//! The quadrilateral by assumed stresses. A membrane with bulging edges has the seven linear modes in equilibrium; bending, and a membrane
//! with straight edges, have the five modes of Pian & Sumihara (1984).
//!
//! By the principle of Hellinger & Reissner, stress is S β and strain C⁻¹ S β, with β = M⁻¹ γ, M = ∫ Sᵀ C⁻¹ S, γ = ∫ Sᵀ ε. Modes S of the
//! membrane follow from Airy's functions, all of second and third degree. The bulge b of an edge of length L does the work −∫ (n·S n) ½ r
//! (1 − r) L² dr b. Two deformation modes have no stress: mean drilling, and drilling of the nodes with alternating sign. The quartic x⁴ −
//! y⁴ would resist the latter, but also stiffens tapering elements in bending.

use super::interpolation::{Interpolation, Quadrilateral};
use super::nodal_vectors::NodalVectors;
use super::plane_strains::{PlaneStrains, PointStrains};
use super::surface::{ElementSurface, SurfacePoint};
use base::math::quadrature;
use nalgebra::{Matrix2, Matrix3, RowVector6, SMatrix, SVector, Vector2, Vector3};
use std::array::from_fn;

/// Products of slopes.
const P: usize = 6;
/// Numbers of the membrane: products, edges, drilling.
const E: usize = 11;
/// Stress modes of the membrane.
const MODES: usize = 7;

/// Compliance for Young's modulus 1, which stresses and strains divide out.
fn compliance(nu: f64) -> Matrix3<f64> {
    Matrix3::new(1.0, -nu, 0.0, -nu, 1.0, 0.0, 0.0, 0.0, 2.0 * (1.0 + nu))
}

/// H⁻¹ Γ, with the modes scaled to entries of one on the diagonal of H; zero where H is singular.
fn amplitudes<const M: usize, const R: usize>(H: SMatrix<f64, M, M>, work: SMatrix<f64, M, R>) -> SMatrix<f64, M, R> {
    let scale = SVector::<f64, M>::from_fn(|m, _| if H[(m, m)] > 0.0 { H[(m, m)].sqrt().recip() } else { 0.0 });
    let scaled = SMatrix::<f64, M, M>::from_fn(|i, j| scale[i] * H[(i, j)] * scale[j]);
    let mut out = SMatrix::<f64, M, R>::from_fn(|m, r| scale[m] * work[(m, r)]);
    match scaled.cholesky() {
        Some(factor) => factor.solve_mut(&mut out),
        None => out.fill(0.0),
    }
    SMatrix::from_fn(|m, r| scale[m] * out[(m, r)])
}

/// The coordinates that stress modes of the membrane are written in.
struct Coordinates {
    /// The centroid.
    centre: Vector2<f64>,
    /// Root mean squares of the distances from the centroid along the axes.
    size: Vector2<f64>,
}

impl Coordinates {
    fn new(surface: &ElementSurface<4, 3>, places: &[Vector2<f64>; 4]) -> Self {
        let mean = |of: &dyn Fn(&Vector2<f64>) -> Vector2<f64>| -> Vector2<f64> {
            let all = surface.points.iter().zip(places);
            all.map(|(point, place)| point.weight / surface.area * of(place)).sum()
        };
        let centre = mean(&|place| *place);
        let size = mean(&|place| (place - centre).component_mul(&(place - centre))).map(f64::sqrt);
        Coordinates { centre, size }
    }

    /// σ₁, σ₂, τ₁₂ of the seven modes at a place.
    fn modes(&self, place: &Vector2<f64>) -> SMatrix<f64, 3, MODES> {
        let from = place - self.centre;
        let [x, y] = [from.x / self.size.x, from.y / self.size.y];
        let ratio = self.size.y / self.size.x;
        let mut S = SMatrix::<f64, 3, MODES>::zeros();
        S.fixed_columns_mut::<3>(0).fill_diagonal(1.0);
        // Airy's functions y³, x³, xy², x²y.
        S.set_column(3, &Vector3::new(y, 0.0, 0.0));
        S.set_column(4, &Vector3::new(0.0, x, 0.0));
        S.set_column(5, &Vector3::new(x, 0.0, -ratio * y));
        S.set_column(6, &Vector3::new(0.0, ratio * y, -x));
        S
    }
}

/// −∫ (n·S n) ½ r (1 − r) L² dr along an edge from `a` to `b` for each mode; `squared` is L².
fn work_of_bulge(coordinates: &Coordinates, [a, b]: [Vector2<f64>; 2], squared: f64) -> SVector<f64, MODES> {
    let along = (b - a).normalize();
    let n = Vector3::new(along.y * along.y, along.x * along.x, -2.0 * along.x * along.y);
    // One degree of the modes and two of the bulge.
    let (points, weights) = quadrature::gauss(2);
    let at = points.iter().zip(weights).map(|(z, w)| (0.5 * (1.0 + z), 0.5 * w));
    at.map(|(r, w)| -0.5 * w * r * (1.0 - r) * squared * coordinates.modes(&(a + r * (b - a))).tr_mul(&n)).sum()
}

/// Strain at an integration point from the products of slopes; warping stretches the edges only. v₂ is split into d₁ v₀ + d₂ v₁ and a part
/// along the normal of the centre, perpendicular to v₀ and v₁ at any time. So ½ |v₂|² = m + ½ (v₂·n)² with m = d₁ v₀·v₂ + d₂ v₁·v₂ − ½ |d₁
/// v₀ + d₂ v₁|². Strain along ξ is ½ |v₀ + η v₂|². In the normal part η² is set to one, its value at the edges; in strain along η so is ξ².
/// In a bent surface the membrane then only keeps the lengths of the edges, shared with the neighbours (compare Y. Ko, P. S. Lee & K. J.
/// Bathe 2017). With the values inside, coarse meshes lock unless their lines follow the curvature. Flat elements have no normal part.
fn of_products(surface: &ElementSurface<4, 3>, point: &SurfacePoint<3>) -> SMatrix<f64, 3, P> {
    let [v0, v1, v2] = NodalVectors::slopes(&surface.slopes, &surface.X).map(|v| surface.flat(&v));
    let mut strain = Quadrilateral::of_products(&point.slopes);
    let Some(inverse) = Matrix2::from_columns(&[v0, v1]).try_inverse() else { return strain };
    let d = inverse * v2;
    let flat = RowVector6::new(-d.x * d.x, -d.y * d.y, -d.x * d.y, d.x, d.y, 0.0);
    // v₂ is measured by the size of the element.
    let size = Quadrilateral::SLOPES[2][0] / surface.slopes[2][0];
    let [s, t] = point.inverse.map(|i| size * Vector2::from(i));
    let edges = Vector3::new(s.norm_squared(), t.norm_squared(), 2.0 * s.dot(&t));
    let inside = strain.column(P - 1).into_owned();
    strain.set_column(P - 1, &edges);
    strain + (inside - edges) * flat
}

/// Strain of the membrane at the integration points.
fn membrane(surface: &ElementSurface<4, 3>, C: &Matrix3<f64>, part: &[f64; 4]) -> [SMatrix<f64, 3, E>; 4] {
    let corners = surface.X.map(|x| surface.flat(&x));
    let places: [Vector2<f64>; 4] = Quadrilateral::VALUES.map(|N| (0..4).map(|a| N[a] * corners[a]).sum());
    let coordinates = Coordinates::new(surface, &places);
    let S = places.map(|place| coordinates.modes(&place));
    let (mut H, mut work) = (SMatrix::<f64, MODES, MODES>::zeros(), SMatrix::<f64, MODES, E>::zeros());
    for (point, S) in surface.points.iter().zip(&S) {
        H += point.weight * S.transpose() * C * S;
        let mut products = work.fixed_columns_mut::<P>(0);
        products += point.weight * S.transpose() * of_products(surface, point);
    }
    for (e, [a, b]) in Quadrilateral::EDGES.into_iter().enumerate() {
        let squared = (surface.X[b] - surface.X[a]).norm_squared();
        let bulge = work_of_bulge(&coordinates, [corners[a], corners[b]], squared);
        work.set_column(P + e, &(Quadrilateral::sense(e) * part[e] * bulge));
    }
    let beta = amplitudes(H, work);
    S.map(|S| C * S * beta)
}

/// The stress modes of bending at a point: constant stresses, and two that act along the directions `along` of ξ and η and vary
/// linearly across them. `from`: the point (ξ, η) about which they vary, the centroid.
fn bending_modes(point: &SurfacePoint<3>, from: [f64; 2], along: &[Vector2<f64>; 2]) -> SMatrix<f64, 3, 5> {
    let mut S = SMatrix::<f64, 3, 5>::zeros();
    S.fixed_columns_mut::<3>(0).fill_diagonal(1.0);
    for (i, a) in along.iter().enumerate() {
        let across = point.at[1 - i] - from[1 - i];
        S.set_column(3 + i, &(across * Vector3::new(a.x * a.x, a.y * a.y, a.x * a.y)));
    }
    S
}

/// Curvature at the integration points.
fn bending(surface: &ElementSurface<4, 3>, C: &Matrix3<f64>) -> [SMatrix<f64, 3, P>; 4] {
    five_modes(surface, C, |point| Quadrilateral::of_products(&point.slopes))
}

/// Membrane strain of an element with straight edges only.
fn straight(surface: &ElementSurface<4, 3>, C: &Matrix3<f64>) -> [SMatrix<f64, 3, P>; 4] {
    five_modes(surface, C, |point| of_products(surface, point))
}

/// Strain at the integration points with the stress modes of bending, from compatible strain by products of slopes.
fn five_modes(
    surface: &ElementSurface<4, 3>,
    C: &Matrix3<f64>,
    of_products: impl Fn(&SurfacePoint<3>) -> SMatrix<f64, 3, P>,
) -> [SMatrix<f64, 3, P>; 4] {
    let points = &surface.points;
    let from = [0, 1].map(|i| points.iter().map(|p| p.weight * p.at[i]).sum::<f64>() / surface.area);
    let corners = surface.X.map(|x| surface.flat(&x));
    let along = [0, 1].map(|i| (0..4).map(|a| Quadrilateral::SLOPES[i][a] * corners[a]).sum::<Vector2<f64>>());
    let longer = along[0].norm().max(along[1].norm());
    let along = along.map(|a| a / longer);
    let S: [SMatrix<f64, 3, 5>; 4] = from_fn(|g| bending_modes(&points[g], from, &along));
    let (mut H, mut work) = (SMatrix::<f64, 5, 5>::zeros(), SMatrix::<f64, 5, P>::zeros());
    for (point, S) in points.iter().zip(&S) {
        H += point.weight * S.transpose() * C * S;
        work += point.weight * S.transpose() * of_products(point);
    }
    let beta = amplitudes(H, work);
    S.map(|S| C * S * beta)
}

impl PlaneStrains<4, 3, P, E> for Quadrilateral {
    fn strains(surface: &ElementSurface<4, 3>, nu: f64, bulge: &[f64; 4]) -> Vec<PointStrains<P, E>> {
        let C = compliance(nu);
        let bending = bending(surface, &C);
        let membrane = if bulge == &[0.0; 4] {
            straight(surface, &C).map(|products| {
                let mut membrane = SMatrix::<f64, 3, E>::zeros();
                membrane.fixed_columns_mut::<P>(0).copy_from(&products);
                membrane
            })
        } else {
            membrane(surface, &C, bulge)
        };
        let at =
            |g: usize| PointStrains { membrane: membrane[g], bending: bending[g], weight: surface.points[g].weight };
        (0..4).map(at).collect()
    }

    fn drilling(surface: &ElementSurface<4, 3>, bulge: &[f64; 4]) -> [[f64; E]; 2] {
        let mut rows = [[0.0; E]; 2];
        rows[0][E - 1] = 1.0;
        if bulge == &[0.0; 4] {
            return rows;
        }
        // Drilling with alternating sign, less its part linear in the plane, as in in-plane bending (Flanagan & Belytschko 1981): Σ γ_a
        // θ_a.
        let turns = [1.0, -1.0, 1.0, -1.0];
        let corners = surface.X.map(|x| surface.flat(&x));
        let slopes: Vector2<f64> = (0..4).map(|a| turns[a] * corners[a]).sum();
        let gamma: [f64; 4] =
            from_fn(|a| 0.25 * (turns[a] - slopes.x * surface.slopes[0][a] - slopes.y * surface.slopes[1][a]));
        // It is written by differences along the edges, Σ α_e (θ_e − θ_e+1).
        let mut alpha = [0.0; 4];
        (1..4).for_each(|a| alpha[a] = alpha[a - 1] + gamma[a]);
        let mean = 0.25 * alpha.iter().sum::<f64>();
        (0..4).for_each(|e| rows[1][P + e] = Quadrilateral::sense(e) * (alpha[e] - mean));
        rows
    }
}
