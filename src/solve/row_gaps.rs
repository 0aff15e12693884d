//! Watches whether the rows of tables follow the motion. Rows that are farther apart than a third of a period show neither its peaks nor its
//! form, whatever the steps between them resolve.

use crate::tolerances::row_gaps::{ENOUGH_ROWS, MOST, MOST_ROWS, MOST_UNRESOLVED, SEEN, STRAIGHT};
use base::math::Vec3;
use base::snapshot::keep;
use mechanics::state::Node;
use model::{AnalysisKind, Cadence, Model};
use std::f64::consts::{SQRT_2, TAU};

/// The motion of a node from row to row.
#[derive(Debug, Clone, Default)]
struct Track {
    x: Vec3,
    v: Vec3,
    /// The way from the row before.
    way: Vec3,
    /// The corners of the box of all rows.
    low: Vec3,
    high: Vec3,
    /// Rows whose velocities do not explain the way from the row before.
    unresolved: usize,
    /// Sums of squares: of that unexplained way over time, of accelerations, and of changes of the way.
    unexplained: f64,
    acceleration: f64,
    bend: f64,
}

keep!(Track: Default { x, v, way, low, high, unresolved, unexplained, acceleration, bend });

/// The motions that rows show, of the nodes in nodes.csv and of bodies.
#[derive(Debug, Default)]
pub struct RowGaps {
    nodes: Vec<usize>,
    tracks: Vec<Track>,
    rows: usize,
    begin: f64,
    time: f64,
}

keep!(RowGaps { tracks, rows, begin, time } without { nodes });

/// A motion between rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowGap {
    /// The node.
    pub node: usize,
    /// The amplitude of its motion between rows.
    pub amplitude: f64,
    /// The amplitude over the size of the whole motion.
    pub share: f64,
    /// The period of this motion.
    pub period: f64,
}

impl RowGaps {
    /// Watches the nodes of a motion whose rows may be farther apart than its steps.
    pub fn new(model: &Model) -> RowGaps {
        let is_thinned =
            model.analysis.kind == AnalysisKind::Dynamic && !matches!(model.output.cadence, Cadence::Steps(..=1));
        let bodies = model.bodies.iter().map(|body| body.node);
        let nodes: Vec<usize> = match is_thinned {
            true => model.output.nodes.iter().copied().chain(bodies).collect(),
            false => Vec::new(),
        };
        RowGaps { tracks: vec![Track::default(); nodes.len()], nodes, rows: 0, begin: 0.0, time: 0.0 }
    }

    /// Takes account of a row.
    pub fn look(&mut self, time: f64, nodes: &[Node]) {
        let dt = time - self.time;
        if self.nodes.is_empty() || (self.rows > 0 && dt <= 0.0) {
            return;
        }
        for (&node, track) in self.nodes.iter().zip(&mut self.tracks) {
            let Node { x, v, a, .. } = nodes[node];
            if self.rows == 0 {
                (track.low, track.high) = (x, x);
            } else {
                let (way, expected) = (x - track.x, 0.5 * dt * (track.v + v));
                let unexplained = (way - expected).norm();
                track.unresolved += usize::from(unexplained > STRAIGHT * (way.norm() + expected.norm()));
                track.unexplained += (unexplained / dt).powi(2);
                track.acceleration += a.norm_squared();
                if self.rows > 1 {
                    track.bend += (way - track.way).norm_squared();
                }
                track.way = way;
                (track.low, track.high) = (track.low.inf(&x), track.high.sup(&x));
            }
            (track.x, track.v) = (x, v);
        }
        if self.rows == 0 {
            self.begin = time;
        }
        (self.rows, self.time) = (self.rows + 1, time);
    }

    /// The largest motion between rows, as a share of the whole motion of its node; `None` where rows follow all of them, or where it is
    /// below `rounding`. A sine
    /// with the accelerations of the rows, and with their unexplained ways, has this motion. The rows must zigzag by it too.
    pub fn largest(&self, rounding: f64) -> Option<RowGap> {
        let rows = self.rows.checked_sub(1).filter(|rows| *rows >= ENOUGH_ROWS)? as f64;
        let gap = |(&node, track): (&usize, &Track)| {
            let [unexplained, acceleration, bend] =
                [track.unexplained, track.acceleration, track.bend].map(|sum| (sum / rows).sqrt());
            let apart = (self.time - self.begin) / rows;
            let half = half_angle(2.0 * unexplained / (acceleration * apart));
            let frequency = 2.0 * half / apart;
            // Noise of many frequencies has large velocities and accelerations, and rows that lie on a smooth curve.
            let seen = SQRT_2 * bend / (2.0 * half.sin()).powi(2);
            let amplitude = (SQRT_2 * acceleration / (frequency * frequency)).min(seen);
            let share = amplitude / (track.high - track.low).norm();
            let period = TAU / frequency;
            let is_sparse = track.unresolved as f64 > MOST_UNRESOLVED * rows && period < MOST_ROWS * apart;
            (amplitude > rounding && is_sparse && (SEEN..MOST).contains(&share)).then_some(RowGap {
                node,
                amplitude,
                share,
                period,
            })
        };
        self.nodes.iter().zip(&self.tracks).filter_map(gap).max_by(|a, b| a.share.total_cmp(&b.share))
    }
}

/// Half of the angle h of a sine between two rows. `ratio` is the unexplained way between them over half the acceleration times the square of
/// their distance: (sin h/h − cos h)/h. It rises up to h = 2.08, three rows in two periods, which is returned beyond.
fn half_angle(ratio: f64) -> f64 {
    let mut bounds = [1e-6_f64, 2.0816];
    for _ in 0..60 {
        let h: f64 = 0.5 * (bounds[0] + bounds[1]);
        bounds[usize::from((h.sin() / h - h.cos()) / h >= ratio)] = h;
    }
    bounds[0]
}
