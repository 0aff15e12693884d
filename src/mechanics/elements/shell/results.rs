//! Stress resultants of shell elements for output: means over an element, and the mean stress in each layer.
//!
//! A resultant is work-conjugate to a strain constant over the element. N is conjugate to x = X + E X. M is conjugate to d = D + K X with x
//! = X − ½ (X·K X) n, a state without shear. Q is conjugate to a constant inclination of the directors. Strains are of first and second
//! degree in positions and directors, so half the difference of those ahead and behind is exact, whatever strains describe the element.

use super::interpolation::Interpolation;
use super::nodal_vectors::{NodalVectors, sum};
use super::pack::{Motion, ShellPack, Strains};
use super::section::ShellSections;
use crate::elements::pressure::Face;
use crate::elements::results::{LayerStress, MOST_LAYERS, ShellResultants};
use crate::state::Configuration;
use base::math::lanes::{LANES, Lanes};
use base::math::number::LaneVec3;
use base::math::{Mat3, Vec3};
use std::array::from_fn;

/// An axis whose part in the plane is smaller than this, some 1° from the normal, gives no direction there.
const STEEP: f64 = 0.02;

/// The direction of `axis` projected on the plane normal to `normal`; if `axis` is normal to the plane, the global axis farthest from it is
/// projected.
fn project(axis: &Vec3, normal: &Vec3) -> Vec3 {
    let across = |a: &Vec3| a - a.dot(normal) * normal;
    let laid = across(axis);
    if laid.norm() > STEEP { laid.normalize() } else { across(&Vec3::ith(axis.iamin(), 1.0)).normalize() }
}

/// Axes 1 and 2 of results in the plane normal to `normal`: the first is `axis` projected on it.
pub fn result_axes(axis: &Vec3, normal: &Vec3) -> [Vec3; 2] {
    let first = project(axis, normal);
    [first, normal.cross(&first)]
}

/// Calls `write` with the place and the resultants of each element of a pack, whose nodes lay at `start`; axis 1 is `axis` projected on the
/// surface at t = 0.
pub(super) fn resultants<K, const N: usize, const V: usize, const P: usize, const E: usize, S>(
    pack: &ShellPack<N, V, P, E, S>,
    axis: &Vec3,
    start: &dyn Fn(usize) -> Vec3,
    now: &Configuration,
    write: &mut dyn FnMut(usize, ShellResultants),
) where
    K: Interpolation<N, V, P>,
    S: ShellSections<P, E, Lanes>,
{
    let strains = pack.strains_at::<K>(now.nodes);
    let stress = Strains { plane: pack.sections.stress(&strains.plane, now), shear: pack.shear_stress(&strains.shear) };
    let means: [MeanStress<N>; LANES] = from_fn(|lane| {
        let nodes = &pack.nodes[lane];
        MeanStress::new(from_fn(|a| start(nodes[a]) - start(nodes[0])), axis)
    });
    let at_start = Motion {
        x: from_fn(|a| LaneVec3::gather(|lane| means[lane].X[a])),
        triads: from_fn(|k| from_fn(|a| pack.axes[a][k])),
    };
    let work: [Lanes; WAYS] = from_fn(|k| {
        let ways: [NodalVectors<N>; LANES] = from_fn(|lane| means[lane].way(k));
        let mut way = Motion { x: [LaneVec3::ZERO; N], triads: [[LaneVec3::ZERO; N]; 3] };
        for a in 0..N {
            way.x[a] = LaneVec3::gather(|lane| ways[lane].x[a]);
            way.triads[0][a] = LaneVec3::gather(|lane| ways[lane].triads[0][a]);
        }
        let at = |s: f64| {
            let motion = at_start.plus(s, &way);
            let mut strains = pack.measure::<K>(&motion, &pack.chords(&motion));
            // Twisting moments on bent edges cancel between elements and are no shear forces.
            let bent = pack.bent.curvature(&strains.shear);
            (0..3).for_each(|n| strains.plane.bending[n] -= bent[n]);
            stress.products(&strains)
        };
        Lanes::splat(0.5) * (at(1.0) - at(-1.0))
    });
    let Motion { x, triads } = pack.gather(now.nodes);
    for (lane, mean) in means.iter().enumerate().take(pack.count) {
        let one = |v: [LaneVec3; N]| v.map(|v| v.lane(lane));
        let motion = NodalVectors { x: one(x), triads: triads.map(one) };
        let first = sum(&pack.slopes[0].map(|s| s.as_array()[lane]), &mean.X);
        let has_failed = pack.sections.has_failed(lane, now.history);
        let work = if has_failed { [0.0; WAYS] } else { work.map(|work| work.as_array()[lane]) };
        let layers = |layers: &mut [_]| pack.sections.layers(lane, &strains.plane.lane(lane), now, layers);
        write(lane, mean.resultants(work, &motion, &first, layers));
    }
}

/// The number of resultants: of N, M and Q.
pub(super) const WAYS: usize = 8;

/// The mean stress of an element, by the work on the motions that its resultants are conjugate to.
pub(super) struct MeanStress<const N: usize> {
    /// Positions of the nodes at t = 0, from that of the first.
    X: [Vec3; N],
    area: f64,
    normal: Vec3,
    /// Axes 1 and 2 of the results.
    t: [Vec3; 2],
}

impl<const N: usize> MeanStress<N> {
    /// The mean stress of an element whose nodes lay at `X`, with `axis` projected on the surface.
    pub fn new(X: [Vec3; N], axis: &Vec3) -> Self {
        let face = Face::of(&from_fn::<_, N, _>(|a| a)).expect("shells have three, four, six or nine nodes");
        let area: Vec3 = face.areas(|a| X[a]).iter().sum();
        let normal = area.normalize();
        MeanStress { X, area: area.norm(), normal, t: result_axes(axis, &normal) }
    }

    /// The change of positions and directors to which resultant `k` of N₁₁, N₂₂, N₁₂, M₁₁, M₂₂, M₁₂, Q₁, Q₂ is conjugate.
    pub fn way(&self, k: usize) -> NodalVectors<N> {
        let MeanStress { X, normal, t, .. } = self;
        // x ↦ E x with one component of E: 11, 22, or 12 and 21 by a half each.
        let even = |i: usize, x: &Vec3| match i {
            2 => 0.5 * (t[1].dot(x) * t[0] + t[0].dot(x) * t[1]),
            _ => t[i].dot(x) * t[i],
        };
        let mut way = NodalVectors { x: [Vec3::zeros(); N], triads: [[Vec3::zeros(); N]; 3] };
        for (a, x) in X.iter().enumerate() {
            [way.x[a], way.triads[0][a]] = match k {
                0..3 => [even(k, x), Vec3::zeros()],
                3..6 => [-0.5 * x.dot(&even(k - 3, x)) * normal, even(k - 3, x)],
                _ => [Vec3::zeros(), t[k - 6]],
            };
        }
        way
    }

    /// The resultants of the nodes at `motion`; `work` is that of the stress on each way, `first` lies along axis 1 of the layers, and
    /// `write_layers` is as [`ShellSections::layers`].
    pub fn resultants(
        &self,
        work: [f64; WAYS],
        motion: &NodalVectors<N>,
        first: &Vec3,
        write_layers: impl FnOnce(&mut [LayerStress]) -> usize,
    ) -> ShellResultants {
        let MeanStress { X, area, t, .. } = self;
        let mut layers = [LayerStress::default(); MOST_LAYERS];
        let count = write_layers(&mut layers);
        // Layers have the axes of the element, which are rotated to `t`.
        let turned = [t[0].dot(first), -t[1].dot(first)];
        layers[..count].iter_mut().for_each(|layer| layer.stress = rotate(&layer.stress, turned));
        let [n11, n22, n12, m11, m22, m12, q1, q2] = work.map(|work| work / area);
        let frame = frame(X, t, motion);
        ShellResultants { frame, N: [n11, n22, n12], M: [m11, m22, m12], Q: [q1, q2], layers, count }
    }
}

/// σ₁₁, σ₂₂, σ₁₂ in axes turned so that the first is (c, s).
fn rotate(stress: &[f64; 3], [c, s]: [f64; 2]) -> [f64; 3] {
    let (c, s) = (c / c.hypot(s), s / c.hypot(s));
    let [a, b, ab] = *stress;
    [
        c * c * a + s * s * b + 2.0 * c * s * ab,
        s * s * a + c * c * b - 2.0 * c * s * ab,
        c * s * (b - a) + (c * c - s * s) * ab,
    ]
}

/// The axes `t` of t = 0 in the deformed element: the first along its material line, and the normal of the mean plane.
fn frame<const N: usize>(X: &[Vec3; N], t: &[Vec3; 2], motion: &NodalVectors<N>) -> Mat3 {
    // x ≈ x̄ + F (X − X̄) by least squares in the plane.
    let centre = |x: &[Vec3; N]| x.iter().sum::<Vec3>() / N as f64;
    let (X0, x0) = (centre(X), centre(&motion.x));
    let mut G = [[0.0; 2]; 2];
    let mut moved = [Vec3::zeros(); 2];
    for a in 0..N {
        let s = [0, 1].map(|i| t[i].dot(&(X[a] - X0)));
        for i in 0..2 {
            moved[i] += s[i] * (motion.x[a] - x0);
            (0..2).for_each(|j| G[i][j] += s[i] * s[j]);
        }
    }
    let det = G[0][0] * G[1][1] - G[0][1] * G[1][0];
    let first = (G[1][1] * moved[0] - G[0][1] * moved[1]) / det;
    let second = (G[0][0] * moved[1] - G[1][0] * moved[0]) / det;
    let (first, normal) = (first.normalize(), first.cross(&second).normalize());
    Mat3::from_columns(&[first, normal.cross(&first), normal])
}
