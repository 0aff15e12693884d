//! A contact by itself, without a scene around it: its block, its nodes, and the past it came by.

use rand::RngExt;
use rand::rngs::StdRng;
use rdsolve::elements::{ElementBlock, Moduli};
use rdsolve::math::Vec3;
use rdsolve::math::rotation::{exp, matrix};
use rdsolve::state::{Configuration, Node};

pub fn vector(rng: &mut StdRng, size: f64) -> Vec3 {
    Vec3::from_fn(|_, _| rng.random_range(-size..size))
}

/// Something that touches a surface. The first node carries the surface; in the block it is the last.
pub struct Touch<B> {
    pub block: B,
    pub nodes: Vec<Node>,
    pub past: Vec<f64>,
}

impl<B: ElementBlock> Touch<B> {
    /// Force and moment on each node, in the order of the block.
    pub fn force(&self, nodes: &[Node]) -> Vec<f64> {
        let mut F = vec![[0.0; 6]; nodes.len()];
        self.block.subtract_forces(&Configuration { nodes, history: &self.past, dt: 0.0, previous: None }, &mut F);
        F.rotate_left(1);
        F.into_iter().flatten().collect()
    }

    /// Compares the tangent with differences of the force, to a part of its largest entry. False where nothing touches, and where
    /// the force has no derivative and second differences do not vanish: between sticking and slipping, at the edge between two
    /// faces, and where a corner comes into the plane of a face.
    pub fn check_tangent(&self, tolerance: f64, what: &str) -> bool {
        self.check_tangent_by(1e-7, tolerance, what)
    }

    /// The same with differences over this way.
    pub fn check_tangent_by(&self, h: f64, tolerance: f64, what: &str) -> bool {
        let base = self.force(&self.nodes);
        if base.iter().all(|f| *f == 0.0) {
            return false;
        }
        let (width, rate) = (6 * self.nodes.len(), 3.0);
        let mut K = vec![f64::NAN; width * width];
        let now = Configuration { nodes: &self.nodes, history: &self.past, dt: 0.0, previous: None };
        self.block.tangent(0, &now, rate, Moduli::Algorithmic, &mut K);
        let largest = K.iter().fold(0.0f64, |m, k| m.max(k.abs()));
        let moved = |column: usize, h: f64| {
            let mut nodes = self.nodes.clone();
            let node = &mut nodes[(column / 6 + 1) % self.nodes.len()];
            let e = Vec3::ith(column % 3, h);
            if column % 6 < 3 {
                node.x += e;
                node.v += rate * e;
            } else {
                node.rotation = exp(&e) * node.rotation;
                node.omega += rate * e;
            }
            self.force(&nodes)
        };
        let columns: Vec<(Vec<f64>, Vec<f64>)> = (0..width).map(|c| (moved(c, h), moved(c, -h))).collect();
        let kink =
            columns.iter().flat_map(|(a, b)| a.iter().zip(b).zip(&base).map(|((a, b), c)| (a + b - 2.0 * c).abs()));
        if kink.fold(0.0, f64::max) > 1e-4 * largest * h {
            return false;
        }
        for (column, (ahead, behind)) in columns.iter().enumerate() {
            for row in 0..width {
                let slope = -(ahead[row] - behind[row]) / (2.0 * h);
                let k = K[row * width + column];
                assert!((slope - k).abs() < tolerance * largest, "{what}: ({row}, {column}): {k} against {slope}");
            }
        }
        true
    }

    /// The forces before and after the whole scene has been turned and moved away, which turns them back.
    pub fn forces_of_turned_scene(&self, rng: &mut StdRng) -> impl Iterator<Item = (Vec3, Vec3)> {
        let (turn, shift) = (exp(&vector(rng, 3.0)), vector(rng, 5.0));
        let R = matrix(&turn);
        let turned: Vec<Node> = self
            .nodes
            .iter()
            .map(|n| Node { x: shift + R * n.x, rotation: turn * n.rotation, v: R * n.v, omega: R * n.omega, ..*n })
            .collect();
        let threes = |F: Vec<f64>| F.chunks(3).map(Vec3::from_column_slice).collect::<Vec<_>>();
        let (before, after) = (threes(self.force(&self.nodes)), threes(self.force(&turned)));
        before.into_iter().map(move |f| R * f).zip(after)
    }
}
