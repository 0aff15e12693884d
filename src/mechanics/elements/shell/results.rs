//! Stress resultants of shell elements for output: means over an element, and the mean stress in each layer.
//!
//! A resultant is work-conjugate to a strain constant over the element. N is conjugate to x = X + E X. M is conjugate to d = D + K X with x
//! = X − ½ (X·K X) n, a state without shear. Q is conjugate to a constant inclination of the directors. Strains are of first and second
//! degree in positions and directors, so half the difference of those ahead and behind is exact, whatever strains describe the element.

use super::interpolation::Interpolation;
use super::nodal_vectors::{NodalVectors, sum};
use super::pack::{Motion, Shells, Strains};
use super::section::ShellSections;
use crate::elements::pressure::Face;
use crate::elements::results::{LayerStress, MOST_LAYERS, ShellResultants};
use crate::state::Configuration;
use base::math::lanes::Lanes;
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

/// The resultants of element `e`, whose nodes lay at `X`; axis 1 is `axis` projected on the surface at t = 0.
pub(super) fn resultants<K, const N: usize, const V: usize, const P: usize, const E: usize, S>(
    shells: &Shells<K, N, V, P, E, S>,
    e: usize,
    axis: &Vec3,
    X: &[Vec3],
    now: &Configuration,
) -> Option<ShellResultants>
where
    K: Interpolation<N, V, P>,
    S: ShellSections<P, E, Lanes>,
{
    let (pack, lane) = shells.place(e);
    let X: [Vec3; N] = from_fn(|a| X[a] - X[0]);
    let strains = pack.strains_at::<K>(now.nodes);
    let stress = match pack.sections.has_failed(lane, now.history) {
        true => Strains::ZERO,
        false => Strains { plane: pack.sections.stress(&strains.plane, now), shear: pack.shear_stress(&strains.shear) },
    };
    let axes = |k: usize| from_fn(|a| pack.axes[a][k].lane(lane));
    let start = NodalVectors { x: X, triads: from_fn(axes) };
    let at = |way: &NodalVectors<N>, s: f64| {
        let NodalVectors { x, triads } = start.plus(s, way);
        let all = |v: [Vec3; N]| v.map(|v| LaneVec3::gather(|_| v));
        let motion = Motion { x: all(x), triads: triads.map(all) };
        let mut strains = pack.measure::<K>(&motion, &pack.chords(&motion));
        // Twisting moments on bent edges cancel between elements and are no shear forces.
        let bent = pack.bent.curvature(&strains.shear);
        (0..3).for_each(|n| strains.plane.bending[n] -= bent[n]);
        stress.dot(&strains, lane)
    };
    let Motion { x, triads } = pack.gather(now.nodes);
    let one = |v: [LaneVec3; N]| v.map(|v| v.lane(lane));
    let motion = NodalVectors { x: one(x), triads: triads.map(one) };
    let first = sum(&pack.slopes[0].map(|s| s.as_array()[lane]), &X);
    let mean = MeanStress { X: &X, axis, motion: &motion, first };
    mean.resultants(&at, |layers| pack.sections.layers(lane, &strains.plane.lane(lane), now, layers))
}

/// The geometry for the mean stress of an element.
pub(super) struct MeanStress<'a, const N: usize> {
    /// Positions of the nodes at t = 0, from that of the first.
    pub X: &'a [Vec3; N],
    /// Axis 1, before it is projected on the surface.
    pub axis: &'a Vec3,
    /// The nodes now.
    pub motion: &'a NodalVectors<N>,
    /// Along axis 1 of the layers.
    pub first: Vec3,
}

impl<const N: usize> MeanStress<'_, N> {
    /// The resultants; `work` is the work of the stress on the strains of a motion scaled from t = 0, `write_layers` as
    /// [`ShellSections::layers`].
    pub fn resultants(
        &self,
        work: &dyn Fn(&NodalVectors<N>, f64) -> f64,
        write_layers: impl FnOnce(&mut [LayerStress]) -> usize,
    ) -> Option<ShellResultants> {
        let MeanStress { X, axis, motion, first: own } = self;
        let area: Vec3 = Face::of(&from_fn::<_, N, _>(|a| a))?.areas(|a| X[a]).iter().sum();
        let normal = area.normalize();
        let t = result_axes(axis, &normal);
        // This mean stress is conjugate to the strain of a change of positions and directors.
        let mean = |change: &dyn Fn(&Vec3) -> [Vec3; 2]| {
            let mut way = NodalVectors { x: [Vec3::zeros(); N], triads: [[Vec3::zeros(); N]; 3] };
            (0..N).for_each(|a| [way.x[a], way.triads[0][a]] = change(&X[a]));
            0.5 * (work(&way, 1.0) - work(&way, -1.0)) / area.norm()
        };
        // x ↦ E x with one component of E: 11, 22, or 12 and 21 by a half each.
        let even = |i: usize, x: &Vec3| match i {
            2 => 0.5 * (t[1].dot(x) * t[0] + t[0].dot(x) * t[1]),
            _ => t[i].dot(x) * t[i],
        };
        let forces = from_fn(|i| mean(&|x| [even(i, x), Vec3::zeros()]));
        let moments = from_fn(|i| mean(&|x| [-0.5 * x.dot(&even(i, x)) * normal, even(i, x)]));
        let shears = from_fn(|i| mean(&|_| [Vec3::zeros(), t[i]]));

        let mut layers = [LayerStress::default(); MOST_LAYERS];
        let count = write_layers(&mut layers);
        // Layers have the axes of the element, which are rotated to `t`.
        let turned = [t[0].dot(own), -t[1].dot(own)];
        layers[..count].iter_mut().for_each(|layer| layer.stress = rotate(&layer.stress, turned));
        Some(ShellResultants { frame: frame(X, &t, motion), N: forces, M: moments, Q: shears, layers, count })
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
