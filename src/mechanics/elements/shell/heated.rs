//! Temperatures of shells: the strains that elements have without stress.
//!
//! A uniform temperature enlarges an element like a picture of itself, so a surface of any shape that may expand has no stress. A gradient
//! along the normal bends it to the curvature α dT/dz in both directions.

use super::interpolation::Interpolation;
use super::pack::{Motion, PackHeat, ShellPack, Shells, Strains};
use super::section::ShellSections;
use crate::elements::heat::{Heat, HeatNodes};
use base::math::Vec3;
use base::math::lanes::Lanes;
use base::math::number::{LaneVec3, Number};
use std::array::from_fn;
use std::sync::Arc;

/// The change of size, or of slope across the element, by which strains are differentiated. They are of second degree but for bending by
/// angles, so the error is the square of this.
const STEP: f64 = 1e-4;

impl<K, const N: usize, const V: usize, const P: usize, const E: usize, S> Shells<K, N, V, P, E, S>
where
    K: Interpolation<N, V, P>,
    S: ShellSections<P, E, Lanes>,
{
    /// Returns the shells with their temperatures. `x`: positions of all nodes at t = 0.
    pub fn heated(mut self, heat: &Heat, x: &[Vec3]) -> Self {
        let own = self.packs.iter().flat_map(|pack| &pack.nodes[..pack.count]).map(|nodes| &nodes[..]);
        let Some(nodes) = HeatNodes::new(heat, own, x).map(Arc::new) else { return self };
        let mut first = 0;
        for pack in &mut self.packs {
            let factor = Lanes::gather(|lane| nodes.factor(first + lane.min(pack.count - 1)));
            first += pack.count;
            pack.heat = Some(Box::new(PackHeat { nodes: Arc::clone(&nodes), factor, unit: pack.units::<K>(x) }));
        }
        self.heat = Some(nodes);
        self
    }
}

impl<const N: usize, const V: usize, const P: usize, const E: usize, S> ShellPack<N, V, P, E, S> {
    fn units<K: Interpolation<N, V, P>>(&self, x: &[Vec3]) -> [Strains<N, P, E>; 2] {
        let lane = |of: &dyn Fn(&[usize; N]) -> Vec3| LaneVec3::<Lanes>::gather(|lane| of(&self.nodes[lane]));
        let at = |a: usize| lane(&|nodes| x[nodes[a]] - x[nodes[0]]);
        let start = Motion { x: from_fn(at), triads: from_fn(|k| from_fn(|a| self.axes[a][k])) };
        let ways = |nodes: &[usize; N]| bending(&nodes.map(|node| x[node]));
        let way = |k: usize, a: usize| lane(&|nodes| ways(nodes)[k][a]);
        let none = [LaneVec3::ZERO; N];
        let bend = Motion { x: from_fn(|a| way(0, a)), triads: [from_fn(|a| way(1, a)), none, none] };
        // Curvature by the length of an element has no unit, like the change of size.
        let size = self.nodes[0].iter().map(|&node| (x[node] - x[self.nodes[0][0]]).norm()).fold(0.0, f64::max);
        let grow = Motion { x: start.x, triads: [none; 3] };
        [(grow, STEP), (bend, STEP / size)].map(|(way, step)| {
            let measure = |s: f64| {
                let motion = start.plus(s, &way);
                self.measure::<K>(&motion, &self.slopes(&motion))
            };
            measure(step).less(&measure(-step), 0.5 / step)
        })
    }
}

/// The change of the positions and of the directors of an element with these nodes by a curvature of one in both directions.
pub(super) fn bending<const N: usize>(x: &[Vec3; N]) -> [[Vec3; N]; 2] {
    let corners = if N > 4 { N.div_ceil(2).min(4) } else { N };
    let middle = x[..corners].iter().sum::<Vec3>() / corners as f64;
    let normal: Vec3 = (0..corners).map(|a| (x[a] - middle).cross(&(x[(a + 1) % corners] - middle))).sum();
    let normal = normal.normalize();
    let flat = x.map(|x| (x - middle) - normal.dot(&(x - middle)) * normal);
    [flat.map(|along| -0.5 * along.norm_squared() * normal), flat]
}
