//! The quadrilateral of nine nodes: 16 places, by Gauss's points of second and third degree.
//!
//! ε_rr and γ_r are sampled at 2 × 3 points, ε_ss and γ_s at 3 × 2, and all strains at 2 × 2. The mean uses the 2 × 2 rule too, which is
//! exact for the displacements of flat elements.

use super::sampling::{CurvedStrains, Sampling};
use super::surface::CurvedSurface;
use crate::elements::shell::geometry::Plate;
use crate::elements::shell::plane_strains::PointStrains;
use base::math::curved_faces::{CurvedFace, NineNodes};
use nalgebra::SMatrix;
use std::sync::LazyLock;

/// Numbers in the plane: 6 of ε_rr, 6 of ε_ss, and ε_rr, ε_ss, γ_rs at each of the 2 × 2 points.
const P: usize = 24;
/// Slopes: 6 along r, 6 along s, two at each of the 2 × 2 points.
const V: usize = 20;
/// Shears: 6 along r, 6 along s.
const Q: usize = 12;
/// First number of the 2 × 2 points.
const INNER: usize = 12;

const TWO: [f64; 2] = [-0.577_350_269_189_625_8, 0.577_350_269_189_625_8];
const THREE: [f64; 3] = [-0.774_596_669_241_483_4, 0.0, 0.774_596_669_241_483_4];

/// The place of ε_rr number k.
fn along_r(k: usize) -> [f64; 2] {
    [TWO[k % 2], THREE[k / 2]]
}

/// The place of ε_ss number k.
fn along_s(k: usize) -> [f64; 2] {
    [THREE[k / 2], TWO[k % 2]]
}

/// The 2 × 2 points.
fn inner(k: usize) -> [f64; 2] {
    [TWO[k % 2], TWO[k / 2]]
}

fn linear(r: f64) -> [f64; 2] {
    let ratio = r / TWO[1];
    [0.5 * (1.0 - ratio), 0.5 * (1.0 + ratio)]
}

fn quadratic(s: f64) -> [f64; 3] {
    let ratio = s / THREE[2];
    [0.5 * ratio * (ratio - 1.0), 1.0 - ratio * ratio, 0.5 * ratio * (ratio + 1.0)]
}

/// The weights of the six places along r at a point.
fn weights_r([r, s]: [f64; 2]) -> [f64; 6] {
    let (a, b) = (linear(r), quadratic(s));
    std::array::from_fn(|k| a[k % 2] * b[k / 2])
}

static SAMPLING: LazyLock<Sampling<9, V, P, Q>> = LazyLock::new(|| {
    let mut sampling = Sampling { slopes: [[0.0; 9]; V], pairs: [[0; 2]; P], shears: [[[0.0; 9]; 2]; Q] };
    for k in 0..6 {
        for (i, at) in [along_r(k), along_s(k)].into_iter().enumerate() {
            let slope = NineNodes::slopes(at)[i];
            sampling.slopes[6 * i + k] = slope;
            sampling.pairs[6 * i + k] = [6 * i + k; 2];
            sampling.shears[6 * i + k] = [slope, NineNodes::values(at)];
        }
    }
    for k in 0..4 {
        let (r, s) = (INNER + 2 * k, INNER + 2 * k + 1);
        [sampling.slopes[r], sampling.slopes[s]] = NineNodes::slopes(inner(k));
        let first = INNER + 3 * k;
        sampling.pairs[first..first + 3].copy_from_slice(&[[r, r], [s, s], [r, s]]);
    }
    sampling
});

/// The factors on strain `number` of coordinate `row` sampled at `at`, less the mean strain there.
fn less_mean(
    surface: &CurvedSurface<9>,
    mean: &SMatrix<f64, 3, P>,
    (at, row, number): ([f64; 2], usize, usize),
) -> SMatrix<f64, 1, P> {
    let mut factors = -(surface.point::<NineNodes>(at).along_coordinates().row(row) * mean);
    factors[number] += 1.0;
    factors
}

impl CurvedStrains<9, V, P, Q> for NineNodes {
    fn sampling(_: &CurvedSurface<9>, _: f64) -> &'static Sampling<9, V, P, Q> {
        &SAMPLING
    }

    fn strains(surface: &CurvedSurface<9>, _: &Plate) -> Vec<PointStrains<P, P>> {
        let point = |at| surface.point::<NineNodes>(at);
        // The mean of the four points.
        let (mut mean, mut area) = (SMatrix::<f64, 3, P>::zeros(), 0.0);
        for k in 0..4 {
            let at = point(inner(k));
            let mut columns = mean.fixed_columns_mut::<3>(INNER + 3 * k);
            columns += at.area * at.along_axes();
            area += at.area;
        }
        mean /= area;
        let rest = |place| less_mean(surface, &mean, place);
        let of_r: [_; 6] = std::array::from_fn(|k| rest((along_r(k), 0, k)));
        let of_s: [_; 6] = std::array::from_fn(|k| rest((along_s(k), 1, 6 + k)));
        let of_rs: [_; 4] = std::array::from_fn(|k| rest((inner(k), 2, INNER + 3 * k + 2)));
        let mut points: Vec<PointStrains<P, P>> = Vec::new();
        for &(at, w) in NineNodes::RULE {
            let (to_axes, area) = (point(at).along_axes(), point(at).area);
            let sum = |weights: &[f64], of: &[SMatrix<f64, 1, P>]| -> SMatrix<f64, 1, P> {
                weights.iter().zip(of).map(|(w, of)| *w * of).sum()
            };
            let (a, b) = (linear(at[0]), linear(at[1]));
            let inner: [f64; 4] = std::array::from_fn(|k| a[k % 2] * b[k / 2]);
            let rows = [sum(&weights_r(at), &of_r), sum(&weights_r([at[1], at[0]]), &of_s), sum(&inner, &of_rs)];
            let rest: SMatrix<f64, 3, P> = to_axes * SMatrix::from_rows(&rows);
            points.push(PointStrains { membrane: rest, bending: rest, weight: w * area });
        }
        // The interpolated part has zero mean.
        let whole: f64 = points.iter().map(|p| p.weight).sum();
        let of_rest: SMatrix<f64, 3, P> = points.iter().map(|p| p.weight / whole * p.membrane).sum();
        for point in &mut points {
            point.membrane += mean - of_rest;
            point.bending = point.membrane;
        }
        points
    }

    fn shear(at: [f64; 2]) -> [[f64; Q]; 2] {
        let (r, s) = (weights_r(at), weights_r([at[1], at[0]]));
        let none = [0.0; 6];
        let join = |a: [f64; 6], b: [f64; 6]| std::array::from_fn(|k| if k < 6 { a[k] } else { b[k - 6] });
        [join(r, none), join(none, s)]
    }
}
