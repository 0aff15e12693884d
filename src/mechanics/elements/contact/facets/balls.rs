//! Pairs of balls, numerous in a heap: the search is short, and the memories of a ball fill its first slots without gaps. Unused slots are
//! neither read nor written.

use super::facing::Facing;
use super::found::{FacetTouch, TouchQuery};
use super::scene::FacetScene;
use crate::elements::contact::history::PairMemory;
use crate::state::{Configuration, Node};
use std::ops::Range;

/// A gap, relative to the radius of the smaller ball, below which every pair is remembered.
const NEAR: f64 = 0.1;
/// A pair is remembered from this number of steps before its landing.
const AHEAD: f64 = 8.0;

/// All balls within the gap asked for.
pub(super) fn find_within(
    of: &FacetScene,
    near: &[u32],
    TouchQuery { e, limit, .. }: TouchQuery,
    nodes: &[Node],
    found: &mut Vec<FacetTouch>,
) {
    let point = &of.points[e];
    let origin = &nodes[point.nodes[0]];
    let x = point.relative_position(origin, nodes);
    for &number in near {
        let ball = &of.balls[number as usize];
        let g = x - nodes[ball.node].relative_position(origin);
        let reach = ball.radius + point.radius;
        let square = g.norm_squared();
        // Most are too far.
        if square > (reach + limit).powi(2) {
            continue;
        }
        let distance = square.sqrt();
        let normal = g.try_normalize(0.0).unwrap_or_default();
        found.push(FacetTouch {
            facet: number as usize,
            gap: distance - reach,
            toward: normal,
            rim: [None; 2],
            normal,
            facing: Facing::Normal,
            counts: true,
            inset: 0.0,
            goes_on: false,
            slot: None,
            share: None,
            from: None,
        });
    }
}

/// True where two balls may have passed each other's centre in a step with no motion beyond `way` relative to the mean.
pub(super) fn may_have_passed(of: &FacetScene, e: usize, number: u32, way: f64, nodes: &[Node]) -> bool {
    let ball = &of.balls[number as usize];
    let apart = nodes[of.points[e].nodes[0]].relative_position(&nodes[ball.node]).norm();
    apart <= 0.5 * (ball.radius + of.points[e].radius) + 2.0 * way
}

/// True for a pair to remember: it is near, lands soon, or has an impact in progress.
pub(super) fn is_memorable(
    of: &FacetScene,
    e: usize,
    touch: &FacetTouch,
    now: &Configuration,
    old: Option<PairMemory>,
) -> bool {
    let is_after_impact = || old.is_some_and(|old| old.impact_speed() > 0.0);
    // Load steps have no rates to tell what will land.
    if !of.law.dynamic || touch.gap <= NEAR * of.points[e].radius || is_after_impact() {
        return true;
    }
    let [own, other] = [of.points[e].nodes[0], of.balls[touch.facet].node].map(|node| now.nodes[node].v);
    touch.gap <= AHEAD * now.dt * (other - own).dot(&touch.toward)
}

/// Empties the slots of a ball, which are filled without gaps.
pub(super) fn clear(of: &FacetScene, e: usize, history: &mut [f64]) {
    for slot in 0..of.slots {
        let numbers = &mut history[place(of, e, slot)];
        if !PairMemory(numbers).is_known() {
            break;
        }
        numbers.fill(0.0);
    }
}

/// Where a slot of a ball stands in the history of the block.
pub(super) fn place(of: &FacetScene, e: usize, slot: usize) -> Range<usize> {
    let from = e * of.to_next_point() + slot * of.to_next_slot();
    from..from + of.width
}
