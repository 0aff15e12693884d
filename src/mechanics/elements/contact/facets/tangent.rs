//! The tangent of a pair: the normal force in closed form, friction by differences.
//!
//! The vector from the nearest point y = Σ N X to the point x is g = x − y = d n. P projects on the triangle, edge or vertex of y; Q
//! projects normal to both n and P. Then
//!
//! ```text
//!  δd = n·δg,   δg = δx − Σ N δX,   B = −Σ ∇N (n·δX),   δn = B + Q δg/d,   δ²d = 2 B·δg + δg·Q δg/d − d B·B
//! ```

use super::crossing;
use super::facet::{Facet, FacetPoint, MOST_CORNERS, Region};
use super::line_friction;
use super::lines::LineHessian;
use super::pair::{FacetPair, MOST_OF_PAIR, PairPlace};
use crate::elements::contact::point::ContactPoint;
use crate::elements::contact::restitution::NormalForce;
use crate::state::Node;
use base::math::rotation::{exp, renormalise};
use base::math::{Mat3, Vec3};
use std::borrow::Cow;

/// How the nearest point moves with the nodes.
struct NearestMotion {
    /// Share of each node in δg.
    c: [f64; MOST_OF_PAIR],
    /// B = −Σ b (n·δx).
    b: [Vec3; MOST_OF_PAIR],
    P: Mat3,
    Q: Mat3,
    /// 1/d, or 0 where the point lies in the facet.
    by_d: f64,
}

/// Adds the tangent of the internal forces of a pair, K ← K + ∂f/∂x + `rate_weight` ∂f/∂v, row-major over all nodes with six directions
/// each.
pub(super) fn add_tangent(pair: &FacetPair, place: &PairPlace, nodes: &[Node], rate_weight: f64, K: &mut [f64]) {
    match pair.is_of_lines() {
        true => {
            let force = pair.force(place, nodes);
            add_normal_of_lines((pair, place), force.normal, nodes, rate_weight, K);
            if let (Some(end), Some((of_end, at_end))) = (&force.less, crossing::deepest_end(pair, nodes)) {
                add_normal_of_lines((&of_end, &at_end), -end.normal, nodes, rate_weight, K);
            }
        }
        false => add_normal(pair, place, nodes, rate_weight, K),
    }
    if pair.law.friction > 0.0 && pair.memory.is_some() {
        add_friction(pair, place, nodes, rate_weight, K);
    }
}

fn add_normal(pair: &FacetPair, place: &PairPlace, nodes: &[Node], rate_weight: f64, K: &mut [f64]) {
    let normal = pair.force(place, nodes).normal;
    let motion = motion(pair, place, nodes);
    let NearestMotion { c, b, P, Q, by_d } = &motion;
    let (n, d, w) = (&place.n, place.d, &place.w);
    let count = pair.point.count + pair.facet.corners;
    // q = Σ ∇N (n·V): b are the gradients by nodes.
    let of_facet = pair.facet.nodes().iter().zip(&b[pair.point.count..]);
    let q: Vec3 = of_facet.map(|(&node, b)| n.dot(&nodes[node].v) * b).sum();
    let rate = |k: usize| {
        let along = -rate_weight * c[k] + b[k].dot(w) + d * q.dot(&b[k]);
        along * n - c[k] * by_d * (Q * w) + c[k] * (P * q)
    };
    let rates: [Vec3; MOST_OF_PAIR] = std::array::from_fn(|k| if k < count { rate(k) } else { Vec3::zeros() });
    let N = n * n.transpose();
    for i in 0..count {
        for j in 0..count {
            let H = c[i] * c[j] * by_d * Q
                - c[j] * n * b[i].transpose()
                - c[i] * b[j] * n.transpose()
                - d * b[i].dot(&b[j]) * N;
            // The force on the nodes is N ∂d/∂x, and ∂d/∂x = c n.
            let block =
                normal.by_depth * c[i] * c[j] * N - normal.force * H - normal.by_rate * c[i] * n * rates[j].transpose();
            put(K, count, (6 * i, 6 * j), &block);
        }
    }
}

/// Adds the tangent of a normal force between two lines.
fn add_normal_of_lines(
    (pair, place): (&FacetPair, &PairPlace),
    normal: NormalForce,
    nodes: &[Node],
    rate_weight: f64,
    K: &mut [f64],
) {
    let (n, hessian) = (&place.n, LineHessian::new(pair, place, nodes));
    let ends: Vec<(usize, f64)> = pair.parts(&place.W).collect();
    let N = n * n.transpose();
    for (j, (_, c_j)) in ends.iter().enumerate() {
        let by_motion: Vec3 = ends.iter().enumerate().map(|(i, (node, _))| hessian.block(j, i) * nodes[*node].v).sum();
        let rate = -rate_weight * *c_j * n - by_motion;
        for (i, (_, c_i)) in ends.iter().enumerate() {
            let block = normal.by_depth * *c_i * *c_j * N
                - normal.force * hessian.block(i, j)
                - normal.by_rate * *c_i * n * rate.transpose();
            put(K, ends.len(), (6 * i, 6 * j), &block);
        }
    }
}

fn put(K: &mut [f64], count: usize, (row, column): (usize, usize), block: &Mat3) {
    for i in 0..3 {
        for j in 0..3 {
            K[(row + i) * 6 * count + column + j] += block[(i, j)];
        }
    }
}

fn motion(pair: &FacetPair, place: &PairPlace, nodes: &[Node]) -> NearestMotion {
    let (count, n) = (pair.point.count, &place.n);
    let mut c = [0.0; MOST_OF_PAIR];
    for (k, (_, share)) in pair.parts(&place.W).enumerate() {
        c[k] = share;
    }
    let p = pair.facet.seen_from(&place.x, &nodes[pair.point.nodes[0]], nodes);
    let (gradients, P) = gradients(pair.facet, &place.at, &p);
    let mut b = [Vec3::zeros(); MOST_OF_PAIR];
    let C = pair.facet.corner_weights(place.at.triangle);
    for j in 0..pair.facet.corners {
        b[count + j] = (0..3).map(|i| C[i][j] * gradients[i]).sum();
    }
    let Q = Mat3::identity() - n * n.transpose() - P;
    let by_d = if place.d.abs() > 1e-12 * place.reach { 1.0 / place.d } else { 0.0 };
    let Q = if place.at.region == Region::Interior { Mat3::zeros() } else { Q };
    NearestMotion { c, b, P, Q, by_d }
}

/// The gradients of the shares of a triangle's corners along the triangle, edge or vertex of the nearest point, and the projection on it.
fn gradients(facet: &Facet, at: &FacetPoint, p: &[Vec3; 4]) -> ([Vec3; 3], Mat3) {
    let zero = Vec3::zeros();
    let corners = facet.triangle(at.triangle, p);
    match at.region {
        Region::Vertex(_) => ([zero; 3], Mat3::zeros()),
        Region::Edge(k) => {
            let (k, l) = (k, (k + 1) % 3);
            let along = corners[l] - corners[k];
            let by = along / along.norm_squared();
            let mut gradients = [zero; 3];
            (gradients[k], gradients[l]) = (-by, by);
            (gradients, by * along.transpose())
        }
        Region::Interior => {
            let (u, v) = (corners[1] - corners[0], corners[2] - corners[0]);
            let n = u.cross(&v);
            let square = n.norm_squared();
            let (by_u, by_v) = (v.cross(&n) / square, n.cross(&u) / square);
            ([-by_u - by_v, by_u, by_v], Mat3::identity() - n * n.transpose() / square)
        }
    }
}

/// Largest and least step of the differences of friction, as parts of the pair's size: rounding errs by 1e-9 with the first, by 1e-5 with the second.
const STEPS: [f64; 2] = [1e-6, 1e-10];
/// Step of these differences as a part of the way to the next kink of the force: a stretch, or a depth.
const BEFORE_KINK: f64 = 0.01;
/// A gap, as a part of the distance at touch, that rounding may have made.
const FIRST_TOUCH: f64 = 1e-9;

/// Friction by central differences of its forces, each motion together with its rate. A stiff contact slips after nanometres, and steps beyond would
/// mix sticking with slipping. The differences keep sticking pairs sticking, also pairs at first touch. These have no force yet, and would slip at the
/// smallest step in a direction set by rounding.
fn add_friction(pair: &FacetPair, place: &PairPlace, nodes: &[Node], rate_weight: f64, K: &mut [f64]) {
    let count = pair.point.count + pair.facet.corners;
    let mut local = [Node::at_rest(Vec3::zeros()); MOST_OF_PAIR + MOST_CORNERS + 2];
    for (k, (node, _)) in pair.parts(&place.W).enumerate() {
        local[k] = nodes[node];
    }
    let own_nodes = std::array::from_fn(|k: usize| k.min(pair.point.count - 1));
    let point = Cow::Owned(ContactPoint { nodes: own_nodes, ..ContactPoint::clone(&pair.point) });
    let first = pair.point.count;
    let own = |k: usize| first + if k < pair.facet.corners { k } else { 0 };
    let facet = Facet { nodes: std::array::from_fn(own), ..pair.facet.clone() };
    // The last facet of the point stays fixed, and so do the nodes of the last line that are not shared with the current one.
    let mut keep = |node: usize, at: usize| {
        let same = if pair.is_of_lines() { pair.parts(&place.W).position(|(own, _)| own == node) } else { None };
        local[at] = nodes[node];
        same.unwrap_or(at)
    };
    let left = std::array::from_fn(|k| keep(pair.kept.nodes[k], count + k));
    let kept_line = std::array::from_fn(|k| keep(pair.kept_line[k], count + MOST_CORNERS + k));
    let left = Facet { nodes: left, ..pair.kept.clone() };
    let kept = if std::ptr::eq(pair.kept, pair.facet) { &facet } else { &left };
    let force = pair.force(place, nodes);
    let begins = force.pressed() <= 0.0 && place.gap().abs() <= FIRST_TOUCH * place.reach;
    let slipping = force.friction.as_ref().filter(|friction| !begins && friction.slip != Vec3::zeros());
    let to_kink = slipping.map_or(force.normal.force, |friction| friction.T.norm()) / pair.law.stiffness;
    let slips = slipping.is_some();
    let pair = FacetPair { point, facet: &facet, kept, kept_line, sticks: !slips, ..pair.clone() };
    let length = place.reach.max(place.d.abs()).max(place.at.g.norm());
    let relative = if to_kink > 0.0 { (BEFORE_KINK * to_kink / length).clamp(STEPS[1], STEPS[0]) } else { STEPS[0] };
    for column in 0..6 * count {
        let (k, dof) = (column / 6, column % 6);
        let h = if dof < 3 { relative * length } else { relative };
        let mut at = |sign: f64| {
            let kept = local[k];
            let step = Vec3::ith(dof % 3, sign * h);
            if dof < 3 {
                local[k].x += step;
                local[k].v += rate_weight * step;
            } else {
                local[k].rotation = renormalise(&(exp(&step) * kept.rotation));
            }
            let forces = friction_forces(&pair, &local);
            local[k] = kept;
            forces
        };
        let (ahead, behind) = (at(1.0), at(-1.0));
        for row in 0..6 * count {
            // Internal forces are opposite to those on the nodes.
            K[row * 6 * count + column] -= (ahead[row] - behind[row]) / (2.0 * h);
        }
    }
}

/// Friction forces and moments on the nodes of a pair, six numbers each.
fn friction_forces(pair: &FacetPair, nodes: &[Node]) -> [f64; 6 * MOST_OF_PAIR] {
    let mut f = [0.0; 6 * MOST_OF_PAIR];
    let moved;
    let pair = match pair.is_of_lines() {
        true => {
            moved = line_friction::moved(pair, nodes);
            &moved
        }
        false => pair,
    };
    let place = pair.place(nodes);
    let mut force = pair.force(&place, nodes);
    force.F -= force.normal.force * place.n;
    force.less = None;
    pair.action(&place, &force, nodes).spread(|node, push, moment| {
        for i in 0..3 {
            f[6 * node + i] += push[i];
            f[6 * node + 3 + i] += moment[i];
        }
    });
    f
}
