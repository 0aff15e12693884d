//! The place on a face that is nearest to a point, as weights of the nodes of the face.

use super::Vec3;
use super::curved_faces::{CurvedFace, NineNodes, SixNodes, corners, ring};

/// The most nodes of a face.
const MOST: usize = 9;

/// A correction below this part of the sides ends the search: the next one is below rounding.
const SMALL: f64 = 1e-12;

/// Places beyond the sides of a face by less than this part of them lie on it.
const ON_SIDE: f64 = 1e-9;

/// The nearest place of a face.
pub struct Foot {
    /// Weights of the nodes of the face.
    pub weights: [f64; MOST],
    /// The place.
    pub x: Vec3,
}

/// Shape functions with their slopes by r and s.
type Shape = ([f64; MOST], [[f64; MOST]; 2]);

/// The place nearest to `at` on a face of 3, 4, 6 or 9 nodes at `x`.
pub fn foot(x: &[Vec3], at: &Vec3) -> Foot {
    if let Some(weights) = inside(x, at) {
        return Foot { weights, x: sum(x, &weights) };
    }
    let round: Vec<usize> = ring(x.len()).collect();
    let each = round.len() / corners(x.len());
    let sides = (0..corners(x.len())).map(|side| {
        let of = |k: usize| round[(each * side + k) % round.len()];
        let mut weights = [0.0; MOST];
        for (k, weight) in on_side(&(0..=each).map(|k| x[of(k)]).collect::<Vec<_>>(), at).into_iter().enumerate() {
            weights[of(k)] = weight;
        }
        Foot { weights, x: sum(x, &weights) }
    });
    let nearer = |a: Foot, b: Foot| if (b.x - at).norm() < (a.x - at).norm() { b } else { a };
    sides.reduce(nearer).unwrap_or(Foot { weights: [0.0; MOST], x: *at })
}

fn sum(x: &[Vec3], weights: &[f64; MOST]) -> Vec3 {
    x.iter().zip(weights).map(|(x, weight)| *weight * x).sum()
}

fn shape(nodes: usize, at: [f64; 2]) -> Shape {
    fn padded<const N: usize>(of: [f64; N]) -> [f64; MOST] {
        std::array::from_fn(|k| of.get(k).copied().unwrap_or_default())
    }
    let [r, s] = at;
    match nodes {
        3 => (padded([1.0 - r - s, r, s]), [padded([-1.0, 1.0, 0.0]), padded([-1.0, 0.0, 1.0])]),
        6 => (padded(SixNodes::values(at)), SixNodes::slopes(at).map(padded)),
        9 => (padded(NineNodes::values(at)), NineNodes::slopes(at).map(padded)),
        _ => {
            let of = |r: f64, s: f64| {
                [(1.0 - r) * (1.0 - s), (1.0 + r) * (1.0 - s), (1.0 + r) * (1.0 + s), (1.0 - r) * (1.0 + s)]
            };
            let by_r = [s - 1.0, 1.0 - s, 1.0 + s, -1.0 - s];
            let by_s = [r - 1.0, -1.0 - r, 1.0 + r, 1.0 - r];
            let quarter = |of: [f64; 4]| padded(of.map(|value| 0.25 * value));
            (quarter(of(r, s)), [quarter(by_r), quarter(by_s)])
        }
    }
}

/// The weights at the place whose distance is normal to the face; `None` where it lies beyond the sides.
fn inside(x: &[Vec3], at: &Vec3) -> Option<[f64; MOST]> {
    let is_triangle = corners(x.len()) == 3;
    let mut place = if is_triangle { [1.0 / 3.0; 2] } else { [0.0; 2] };
    for _ in 0..40 {
        let (weights, slopes) = shape(x.len(), place);
        let miss = at - sum(x, &weights);
        let [a, b] = slopes.map(|by| sum(x, &by));
        let (aa, ab, bb) = (a.norm_squared(), a.dot(&b), b.norm_squared());
        let (ra, rb, det) = (a.dot(&miss), b.dot(&miss), aa * bb - ab * ab);
        let step = [(bb * ra - ab * rb) / det, (aa * rb - ab * ra) / det];
        place = [place[0] + step[0], place[1] + step[1]];
        if !place.iter().all(|at| at.abs() < 1e3) {
            return None;
        }
        if step[0].abs().max(step[1].abs()) <= SMALL {
            break;
        }
    }
    let [r, s] = place;
    let is_inside = match is_triangle {
        true => r >= -ON_SIDE && s >= -ON_SIDE && r + s <= 1.0 + ON_SIDE,
        false => r.abs().max(s.abs()) <= 1.0 + ON_SIDE,
    };
    is_inside.then(|| shape(x.len(), place).0)
}

/// The weights of the nodes of a side, from end to end, at its place nearest to `at`.
fn on_side(x: &[Vec3], at: &Vec3) -> Vec<f64> {
    let values = |t: f64| match x.len() {
        2 => vec![0.5 * (1.0 - t), 0.5 * (1.0 + t)],
        _ => vec![0.5 * t * (t - 1.0), 1.0 - t * t, 0.5 * t * (t + 1.0)],
    };
    let slopes = |t: f64| if x.len() == 2 { vec![-0.5, 0.5] } else { vec![t - 0.5, -2.0 * t, t + 0.5] };
    let sum = |by: Vec<f64>| x.iter().zip(by).map(|(x, by)| by * x).sum::<Vec3>();
    let mut t = 0.0f64;
    for _ in 0..40 {
        let along = sum(slopes(t));
        let step = along.dot(&(at - sum(values(t)))) / along.norm_squared();
        t = (t + step).clamp(-1.0, 1.0);
        if step.abs() <= SMALL || t.is_nan() {
            break;
        }
    }
    values(if t.is_nan() { 0.0 } else { t })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lifted([x, y]: [f64; 2]) -> Vec3 {
        Vec3::new(1.0 + 2.0 * x - 0.5 * y, 0.3 * x + y, 0.2 * x - 0.1 * y)
    }

    /// Plane faces: the foot of a point above them is the point below it, whatever the shape; beyond a side it lies on the side.
    #[test]
    fn feet_of_plane_faces() {
        let triangle = [[0.0, 0.0], [1.0, 0.1], [0.2, 0.9]];
        let quadrilateral = [[0.0, 0.0], [1.0, -0.1], [1.3, 1.1], [-0.2, 0.8]];
        let middle = |a: [f64; 2], b: [f64; 2]| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let of = |corners: &[[f64; 2]]| {
            let n = corners.len();
            let mut all = corners.to_vec();
            all.extend((0..n).map(|k| middle(corners[k], corners[(k + 1) % n])));
            if n == 4 {
                all.push(middle(all[4], all[6]));
            }
            all
        };
        let normal =
            (lifted([1.0, 0.0]) - lifted([0.0, 0.0])).cross(&(lifted([0.0, 1.0]) - lifted([0.0, 0.0]))).normalize();
        for face in [triangle.to_vec(), quadrilateral.to_vec(), of(&triangle), of(&quadrilateral)] {
            let x: Vec<Vec3> = face.iter().map(|at| lifted(*at)).collect();
            let below = lifted([0.35, 0.3]);
            let found = foot(&x, &(below + 0.7 * normal));
            // Rounding of places of size 2.
            assert!((found.x - below).norm() < 1e-14, "{} nodes", x.len());
            assert!((found.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            let side = (x[1] - x[0]).normalize();
            let at = x[0] + 0.3 * (x[1] - x[0]);
            let beyond = at + side.cross(&normal) * 0.4 - 0.2 * normal;
            assert!((foot(&x, &beyond).x - at).norm() < 1e-14, "{} nodes, beyond", x.len());
        }
    }
}
