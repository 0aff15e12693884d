//! Friction between two lines: a spring at the contact, which may move along both.
//!
//! The nearest points slide along either line, which is no way of the material. The spring therefore stretches by the displacement since
//! the last state of the material now in contact. The shares of the four ends in x − y are c, their displacements δx and rotations δφ since
//! then. With the arms a and b from the axes to the contact, a + b = d,
//!
//! ```text
//!  way = Σ c δx − a δφ_A × n − b δφ_B × n,   F = N n − T,   M_A = a n × T,   M_B = b n × T
//! ```
//!
//! F and M_A act on the ends of the touching line by its shares, −F and M_B on those of the other; this conserves linear and angular
//! momentum. Displacements and rotations are relative to the first node of the touched line: a common rigid motion causes no force. The
//! components of the stretch along and across the touched line are stored, so they rotate with it. Where a line has no rotations to take a
//! moment, a bar, its arm is zero: it rubs at its axis.

use super::lines;
use super::memory::place_of;
use super::pair::{FacetPair, PairPlace, Rub};
use crate::elements::contact::history::{PairMemory, PairMemoryMut};
use crate::state::{Configuration, Node};
use base::math::Vec3;
use base::math::rotation::{exp, log, renormalise};
use std::borrow::Cow;

/// Number of ends: two of the touching line, two of the touched one.
pub(super) const ENDS: usize = 4;

/// The way and the turn of an end, global components.
type Motion = (Vec3, Vec3);

/// The arms from the axes of both lines to the contact: touching line, touched line.
pub(super) fn arms(pair: &FacetPair, place: &PairPlace) -> [f64; 2] {
    let own = pair.point.rolling_radius;
    let arm = if own > 0.0 { place.d * own / place.reach } else { 0.0 };
    [arm, place.d - arm]
}

/// The friction under the normal force `N`.
pub(super) fn rub(pair: &FacetPair, place: &PairPlace, memory: PairMemory, N: f64, nodes: &[Node]) -> Rub {
    let n = &place.n;
    let [along, across] = axes(pair, place, nodes);
    let way = way(pair, place, &ways(pair, memory, nodes));
    let [p, q] = memory.stretch();
    let stretch = p * along + q * across + way - n.dot(&way) * n;
    let (length, limit) = (stretch.norm(), pair.law.friction_at(memory.slip_speed()) * N / pair.law.stiffness);
    let kept = if length > limit { limit / length * stretch } else { stretch };
    Rub { T: pair.law.stiffness * kept, limit: pair.law.stiffness * limit, slip: stretch - kept }
}

/// The displacement of the material at the contact since the last state, relative to the common motion.
fn way(pair: &FacetPair, place: &PairPlace, ways: &[Motion; ENDS]) -> Vec3 {
    let [a, b] = arms(pair, place);
    let (own, other) = ([pair.point.weights[0], pair.point.weights[1]], [place.W[0], place.W[1]]);
    let sum = |from: usize, [c, d]: [f64; 2]| {
        let ((x, phi), (y, psi)) = (ways[from], ways[from + 1]);
        (c * x + d * y, c * phi + d * psi)
    };
    let ((x, phi), (y, psi)) = (sum(0, own), sum(2, other));
    x - y - (a * phi + b * psi).cross(&place.n)
}

/// Unit vectors along the line that is touched and across it, both normal to n.
fn axes(pair: &FacetPair, place: &PairPlace, nodes: &[Node]) -> [Vec3; 2] {
    let n = &place.n;
    let u = nodes[pair.facet.nodes[1]].relative_position(&nodes[pair.facet.nodes[0]]);
    let along = (u - n.dot(&u) * n).try_normalize(1e-9 * u.norm());
    // For lines end to end any direction serves.
    let along = along.unwrap_or_else(|| n.cross(&Vec3::ith(n.iamin(), 1.0)).normalize());
    [along, n.cross(&along)]
}

/// The nodes of the four ends.
fn ends(pair: &FacetPair) -> [usize; ENDS] {
    [pair.point.nodes[0], pair.point.nodes[1], pair.facet.nodes[0], pair.facet.nodes[1]]
}

/// Ways and turns of the four ends since the last state, relative to the first node of the line that is remembered. An end without a memory
/// moves like the shared end of its line: the contact has just passed to the next element.
fn ways(pair: &FacetPair, memory: PairMemory, nodes: &[Node]) -> [Motion; ENDS] {
    let old = [pair.kept_line[0], pair.kept_line[1], pair.kept.nodes[0], pair.kept.nodes[1]];
    let origin = &nodes[old[2]];
    let (R, q) = (origin.R(), origin.rotation.conjugate());
    let motion = |k: usize| -> Motion {
        let Some(stored) = place_of(k) else { return (Vec3::zeros(), Vec3::zeros()) };
        let node = &nodes[old[k]];
        let turned = log(&renormalise(&(q * node.rotation * memory.end_rotation(stored).conjugate())));
        (node.relative_position(origin) - R * memory.end(stored), R * turned)
    };
    let known: [Motion; ENDS] = std::array::from_fn(motion);
    let now = ends(pair);
    std::array::from_fn(|k| {
        let line = if k < 2 { [0, 1] } else { [2, 3] };
        let same = line.into_iter().find(|&j| old[j] == now[k]);
        let shared = || line.into_iter().find(|&j| line.iter().any(|&i| old[j] == now[i]));
        match same.or_else(shared) {
            Some(j) => known[j],
            None => {
                let [(x, phi), (y, psi)] = line.map(|j| known[j]);
                (0.5 * (x + y), 0.5 * (phi + psi))
            }
        }
    })
}

/// Writes the positions of the four ends after `part` of the way since the last state; without a memory, extrapolated by the velocities.
pub(super) fn remember(pair: &FacetPair, now: &Configuration, part: f64, new: &mut PairMemoryMut) {
    let (nodes, ends) = (now.nodes, ends(pair));
    let origin = &nodes[ends[2]];
    let (R, q) = (origin.R(), origin.rotation.conjugate());
    // The part of the motion to `now` that remains after the end of the step.
    let left: [Motion; ENDS] = match pair.memory {
        Some(memory) => ways(pair, memory, nodes).map(|(x, phi)| ((1.0 - part) * x, (1.0 - part) * phi)),
        None => {
            let dt = (1.0 - part) * now.dt;
            ends.map(|node| (dt * nodes[node].v, dt * nodes[node].omega))
        }
    };
    let (common, turn) = left[2];
    for k in 0..ENDS {
        let Some(stored) = place_of(k) else { continue };
        let node = &nodes[ends[k]];
        let arm = node.relative_position(origin);
        let (x, phi) = left[k];
        let way = x - common - turn.cross(&arm);
        let rotation = exp(&-R.tr_mul(&(phi - turn))) * (q * node.rotation);
        new.set_end(stored, &R.tr_mul(&(arm - way)), &renormalise(&rotation));
    }
}

/// Writes the stretch after `part` of the way from that of the last state to the one found.
pub(super) fn remember_stretch(
    pair: &FacetPair,
    place: &PairPlace,
    (stretch, part): (&Vec3, f64),
    nodes: &[Node],
    new: &mut PairMemoryMut,
) {
    let [along, across] = axes(pair, place, nodes);
    let old = pair.memory.map_or([0.0; 2], |memory| memory.stretch());
    let toward = |old: f64, axis: &Vec3| old + part * (stretch.dot(axis) - old);
    new.set_stretch([toward(old[0], &along), toward(old[1], &across)]);
}

/// The pair where its nodes lie thus: the nearest points are found anew.
pub(super) fn moved<'a>(pair: &FacetPair<'a>, nodes: &[Node]) -> FacetPair<'a> {
    let share = lines::share(&pair.point, pair.facet, nodes);
    let point = share.map_or_else(|| pair.point.clone(), |share| Cow::Owned(pair.point.at(share)));
    FacetPair { point, ..pair.clone() }
}
