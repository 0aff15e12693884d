//! The triangle of six nodes: strains along a side are taken at three places, two on that side and one inside, transverse shear there too.
//!
//! At these places an interpolated displacement of third degree has the exact slope along the side. Its error is spanned by f(r), f(s),
//! f(t) and r s t, with f(r) = r(r − ½)(r − 1) and t = 1 − r − s; their slopes vanish there. In-plane strains are interpolated to first
//! degree. The space of the shears is that of Bathe, Brezzi, Cho & Fortin (1989),
//!   γ_r = a₁ + b₁ r + c₁ s + s (d r + e s),    γ_s = a₂ + b₂ r + c₂ s − r (d r + e s),
//! met on the sides and, by least squares, inside. Lee & Bathe add a seventh and an eighth shear at the centre; then thin cylinders and
//! plates are some per cent stiffer in coarse meshes.
//!
//! If side nodes of a flat element lie off the middles, strains are not linear in r and s: they are sampled at the integration points.

use super::bubble::soften;
use super::sampling::{CurvedStrains, Sampling};
use super::surface::CurvedSurface;
use crate::elements::shell::geometry::Plate;
use crate::elements::shell::plane_strains::PointStrains;
use base::math::curved_faces::{CurvedFace, SixNodes};
use nalgebra::{Matrix3, SMatrix};
use std::sync::LazyLock;

/// Numbers in the plane: three each of ε_rr, ε_ss and ε_qq, along the third side.
const P: usize = 9;
/// Slopes: three each along r, s and q = s − r.
const V: usize = 9;
/// Shears: two on each side, and one inside along each.
const Q: usize = 9;

/// Gauss's points of second degree on a side, and the height of the third place over it.
const R1: f64 = 0.211_324_865_405_187_1;
const R2: f64 = 0.788_675_134_594_812_9;
const R3: f64 = 0.577_350_269_189_625_8;
/// Integration points, of equal weight.
const POINTS: [[f64; 2]; 3] = [[1.0 / 6.0, 1.0 / 6.0], [2.0 / 3.0, 1.0 / 6.0], [1.0 / 6.0, 2.0 / 3.0]];
/// Where ε_rr, ε_ss and ε_qq are taken.
const PLACES: [[[f64; 2]; 3]; 3] =
    [[[R1, 0.0], [R2, 0.0], [R1, R3]], [[0.0, R1], [0.0, R2], [R3, R1]], [[R2, R1], [R1, R2], [R1, R1]]];

/// Largest rise of an element counted as flat, relative to the thickness.
const FLAT: f64 = 0.05;
/// Largest distance of a side node from the middle of its side, relative to the side, to count as in the middle.
const AT_MIDDLE: f64 = 1e-6;

/// The slopes along r, s and q at a place.
fn slopes(at: [f64; 2]) -> [[f64; 6]; 3] {
    let [r, s] = SixNodes::slopes(at);
    [r, s, std::array::from_fn(|a| s[a] - r[a])]
}

/// Weights of the three places of a strain, by the coordinate along its side and the height over it.
fn weights(along: f64, over: f64) -> [f64; 3] {
    let third = over / R3;
    [(R2 - along) / (R2 - R1) - third, (along - R1) / (R2 - R1), third]
}

static TIED: LazyLock<Sampling<6, V, P, Q>> = LazyLock::new(|| {
    let mut sampling = shears();
    for (i, places) in PLACES.iter().enumerate() {
        for (k, &at) in places.iter().enumerate() {
            sampling.slopes[3 * i + k] = slopes(at)[i];
            sampling.pairs[3 * i + k] = [3 * i + k; 2];
        }
    }
    sampling
});

static UNTIED: LazyLock<Sampling<6, V, P, Q>> = LazyLock::new(|| {
    let mut sampling = shears();
    for (k, &at) in POINTS.iter().enumerate() {
        [sampling.slopes[2 * k], sampling.slopes[2 * k + 1]] = SixNodes::slopes(at);
        let (r, s) = (2 * k, 2 * k + 1);
        sampling.pairs[3 * k..3 * k + 3].copy_from_slice(&[[r, r], [s, s], [r, s]]);
    }
    sampling
});

/// The place of a shear, and whether it is γ_r, γ_s or γ_q.
fn place(k: usize) -> ([f64; 2], usize) {
    if k < 6 { (PLACES[k / 2][k % 2], k / 2) } else { (PLACES[k - 6][2], k - 6) }
}

/// The places of the shears: two of γ_r, γ_s and γ_q on their sides, and one of each inside.
fn shears() -> Sampling<6, V, P, Q> {
    let shear = |k: usize| {
        let (at, i) = place(k);
        [slopes(at)[i], SixNodes::values(at)]
    };
    Sampling { slopes: [[0.0; 6]; V], pairs: [[0; 2]; P], shears: std::array::from_fn(shear) }
}

/// γ_r, γ_s and γ_q at a point by a₁, b₁, c₁, a₂, b₂, c₂.
fn space([r, s]: [f64; 2]) -> [[f64; 6]; 3] {
    [[1.0, r, s, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0, r, s], [-1.0, -r, -s, 1.0, r, s]]
}

/// The terms of γ_r, γ_s and γ_q with d and e, which vanish along the sides.
fn inner([r, s]: [f64; 2]) -> [[f64; 2]; 3] {
    let (along_r, along_s) = ([s * r, s * (s - 1.0)], [r * (1.0 - r), -r * s]);
    [along_r, along_s, [along_s[0] - along_r[0], along_s[1] - along_r[1]]]
}

/// The coefficients of both by the shears.
static SPACE: LazyLock<(SMatrix<f64, 6, Q>, SMatrix<f64, 2, Q>)> = LazyLock::new(|| {
    let sides = SMatrix::<f64, 6, 6>::from_fn(|k, c| space(place(k).0)[place(k).1][c]);
    let mut outer = SMatrix::<f64, 6, Q>::zeros();
    outer.fixed_columns_mut::<6>(0).copy_from(&sides.try_inverse().unwrap_or_default());
    // The remaining inner shears are fitted by least squares.
    let rest = SMatrix::<f64, 3, Q>::from_fn(|i, q| {
        let (at, along) = place(6 + i);
        f64::from(u8::from(q == 6 + i)) - (0..6).map(|c| space(at)[along][c] * outer[(c, q)]).sum::<f64>()
    });
    let by = SMatrix::<f64, 3, 2>::from_fn(|i, c| inner(place(6 + i).0)[place(6 + i).1][c]);
    let inside = (by.transpose() * by).try_inverse().unwrap_or_default() * by.transpose() * rest;
    (outer, inside)
});

/// True for a flat element with nodes off the middles of its sides.
fn is_uneven(surface: &CurvedSurface<6>, thickness: f64) -> bool {
    let X = &surface.X;
    let off = (0..3).any(|k| {
        let (a, b) = (X[k], X[(k + 1) % 3]);
        (X[3 + k] - 0.5 * (a + b)).norm() > AT_MIDDLE * (b - a).norm()
    });
    off && surface.rise() <= FLAT * thickness
}

/// ε_rr, ε_ss, γ_rs at a point from the strains that are taken.
fn interpolated([r, s]: [f64; 2]) -> SMatrix<f64, 3, P> {
    let mut rows = SMatrix::<f64, 3, P>::zeros();
    for (i, weights) in [weights(r, s), weights(s, r), weights(s, 1.0 - r - s)].into_iter().enumerate() {
        for (k, w) in weights.into_iter().enumerate() {
            rows[(i, 3 * i + k)] += w;
        }
    }
    // ε_qq = ε_rr + ε_ss − γ_rs.
    let third = rows.row(0) + rows.row(1) - rows.row(2);
    rows.set_row(2, &third);
    rows
}

impl CurvedStrains<6, V, P, Q> for SixNodes {
    fn sampling(surface: &CurvedSurface<6>, thickness: f64) -> &'static Sampling<6, V, P, Q> {
        if is_uneven(surface, thickness) { &UNTIED } else { &TIED }
    }

    fn strains(surface: &CurvedSurface<6>, plate: &Plate) -> Vec<PointStrains<P, P>> {
        let uneven = is_uneven(surface, plate.thickness);
        let points = POINTS.map(|at| surface.point::<SixNodes>(at));
        let strains = |(k, at): (usize, [f64; 2])| {
            let point = points[k];
            let mut rows = SMatrix::<f64, 3, P>::zeros();
            if uneven {
                rows.fixed_columns_mut::<3>(3 * k).copy_from(&Matrix3::identity());
            } else {
                rows = interpolated(at);
            }
            let rows = point.along_axes() * rows;
            PointStrains { membrane: rows, bending: rows, weight: point.area / 6.0 }
        };
        let mut strains: Vec<_> = POINTS.into_iter().enumerate().map(strains).collect();
        soften(&mut strains, &points, &plate.plane_stress());
        strains
    }

    fn shear(at: [f64; 2]) -> [[f64; Q]; 2] {
        let (outer, inside) = &*SPACE;
        let (linear, more) = (space(at), inner(at));
        [0, 1].map(|i| {
            std::array::from_fn(|q| {
                (0..6).map(|c| linear[i][c] * outer[(c, q)]).sum::<f64>()
                    + (0..2).map(|c| more[i][c] * inside[(c, q)]).sum::<f64>()
            })
        })
    }
}
