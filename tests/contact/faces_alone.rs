//! Points against facets by themselves: tangents, balance, indifference to where the scene stands, and nothing that is missed.

use super::touch::vector;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::elements::contact::restitution::{Loss, number};
use rdsolve::elements::contact::{
    ContactLaw, ContactPoint, Facet, FacetContacts, FacetTouchers, MOST_NODES, TouchKind,
};
use rdsolve::elements::{Mechanics, Results, Wandering};
use rdsolve::math::Vec3;
use rdsolve::math::rotation::{exp, matrix};
use rdsolve::state::{Configuration, Node};

pub const STIFFNESS: f64 = 1e3;

pub fn law(friction: f64, loss: Loss) -> ContactLaw {
    ContactLaw {
        stiffness: STIFFNESS,
        loss,
        friction,
        kinetic: friction,
        decay: f64::INFINITY,
        floor: 0.1,
        resolution: f64::INFINITY,
        duration: 0.0,
        near: 1.0,
        touching: 0.0,
        tolerance: None,
        dynamic: true,
    }
}

fn point(node: usize, radius: f64, rolling_radius: f64) -> ContactPoint {
    let mut weights = [0.0; MOST_NODES];
    weights[0] = 1.0;
    ContactPoint { nodes: [node; MOST_NODES], weights, count: 1, radius, rolling_radius, extent: TouchKind::Point }
}

/// A ball against facets: the last node is its own. Or lines against lines.
pub struct Scene {
    pub block: FacetContacts,
    pub nodes: Vec<Node>,
    past: Vec<f64>,
}

impl Scene {
    /// A scene that remembers the state in which it is.
    fn new(law: ContactLaw, nodes: Vec<Node>, facets: Vec<Facet>, radius: f64) -> Scene {
        let points = vec![point(nodes.len() - 1, radius, radius)];
        Scene::of(law, FacetTouchers::Others, points, nodes, facets)
    }

    pub fn of(
        law: ContactLaw,
        touchers: FacetTouchers,
        points: Vec<ContactPoint>,
        nodes: Vec<Node>,
        facets: Vec<Facet>,
    ) -> Scene {
        let x: Vec<Vec3> = nodes.iter().map(|node| node.x).collect();
        let block = FacetContacts::new(law, touchers, points, facets, &x);
        let nothing = vec![0.0; block.history()];
        let mut past = nothing.clone();
        block.update_history(
            &Configuration { nodes: &nodes, history: &nothing, dt: 0.0, previous: None },
            1.0,
            &mut past,
        );
        Scene { block, nodes, past }
    }

    pub fn now<'a>(&'a self, nodes: &'a [Node]) -> Configuration<'a> {
        Configuration { nodes, history: &self.past, dt: 0.0, previous: None }
    }

    pub fn force(&self, nodes: &[Node]) -> Vec<f64> {
        let mut F = vec![[0.0; 6]; nodes.len()];
        self.block.subtract_forces(&self.now(nodes), &mut F);
        F.into_iter().flatten().collect()
    }

    /// The tangent over all nodes, summed from those of pairs.
    fn tangent(&self, rate: f64) -> Vec<f64> {
        let now = self.now(&self.nodes);
        let partners = self.block.partners(&self.nodes);
        assert!(self.block.has_room(&partners, &now));
        let width = 6 * self.nodes.len();
        let mut sum = vec![0.0; width * width];
        let mut room = vec![f64::NAN; (6 * partners.most_nodes()).pow(2)];
        self.block.pair_tangents(&partners, &now, rate, &mut room, &mut |pair, K| {
            let of = partners.nodes(pair);
            let n = 6 * of.len();
            for i in 0..n {
                for j in 0..n {
                    sum[(6 * of[i / 6] + i % 6) * width + 6 * of[j / 6] + j % 6] += K[i * n + j];
                }
            }
        });
        sum
    }

    /// Compares the tangent with differences; false where nothing touches or the force has a kink.
    pub fn check_tangent(&self, tolerance: f64, what: &str) -> bool {
        let base = self.force(&self.nodes);
        if base.iter().all(|f| *f == 0.0) {
            return false;
        }
        let (width, rate, h) = (6 * self.nodes.len(), 3.0, 1e-7);
        let K = self.tangent(rate);
        let largest = K.iter().fold(0.0f64, |m, k| m.max(k.abs()));
        let moved = |column: usize, h: f64| {
            let mut nodes = self.nodes.clone();
            let node = &mut nodes[column / 6];
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
}

/// Where a ball touches a sheet of one facet.
const REGIONS: [&str; 3] = ["face", "edge", "vertex"];

/// A ball that touches one facet anywhere, everything turned and moving, after it has slid by `slide`.
fn touching(rng: &mut StdRng, corners: usize, region: &str, friction: f64, loss: Loss, slide: f64) -> Scene {
    let (half, radius) = (0.02, 0.1);
    let flat = [[0.0, 0.0], [1.0, 0.1], [0.9, 1.1], [-0.1, 0.9]];
    let turn = matrix(&exp(&vector(rng, 3.0)));
    let corner = |k: usize, rng: &mut StdRng| turn * (Vec3::new(flat[k][0], flat[k][1], 0.0) + vector(rng, 0.05));
    let mut nodes: Vec<Node> = (0..corners).map(|k| Node::at_rest(corner(k, rng))).collect();
    let x = |k: usize| nodes[k].x;
    let middle = (0..corners).map(x).sum::<Vec3>() / corners as f64;
    let (on, out) = match region {
        "face" => (middle + 0.3 * (x(0) - middle) + 0.2 * (x(1) - middle), turn * Vec3::z()),
        "edge" => (0.6 * x(0) + 0.4 * x(1), 0.5 * (x(0) + x(1)) - middle),
        _ => (x(0), x(0) - middle),
    };
    let side = if rng.random_range(0..2) == 0 { 1.0 } else { -1.0 };
    let reach = half + radius - rng.random_range(0.005..0.02);
    let across = if region == "face" { side * out } else { out.normalize() + 0.3 * turn * vector(rng, 1.0) };
    let place = on + reach * across.normalize();
    nodes.push(Node { rotation: exp(&vector(rng, 2.0)), ..Node::at_rest(place) });
    let facets = vec![Facet::new(&[0, 1, 2, 3][..corners], half)];
    let mut scene = Scene::new(law(friction, loss), nodes, facets, radius);
    for node in &mut scene.nodes {
        node.x += vector(rng, 0.3 * slide);
        (node.v, node.omega) = (vector(rng, 0.2), vector(rng, 0.2));
        node.rotation = exp(&vector(rng, slide / radius)) * node.rotation;
    }
    let last = scene.nodes.last_mut().unwrap();
    last.x += turn * vector(rng, slide);
    // Inwards, so that the force is there whatever the damping.
    last.v -= 0.3 * across.normalize();
    scene
}

fn each(mut check: impl FnMut(&mut StdRng, Scene, &str)) {
    let mut rng = StdRng::seed_from_u64(11);
    for corners in [3, 4] {
        for region in REGIONS {
            for (friction, slide) in [(0.0, 1e-3), (0.8, 1e-4), (0.2, 5e-3)] {
                for loss in [Loss::None, Loss::Restitution { number: number(0.5), floor: 0.1 }] {
                    for _ in 0..10 {
                        let scene = touching(&mut rng, corners, region, friction, loss, slide);
                        check(
                            &mut rng,
                            scene,
                            &format!("{region} of {corners} corners, friction {friction}, {loss:?}"),
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn the_tangent_is_the_derivative() {
    let mut checked = 0;
    // Rounding of forces of size 20 over 1e-7 gives 2e-8; the largest entries are 1e3.
    each(|_, scene, what| checked += usize::from(scene.check_tangent(1e-6, what)));
    assert!(checked > 250, "only {checked} of 360 states were in touch and smooth");
}

#[test]
fn forces_and_moments_balance() {
    each(|_, scene, what| {
        let F = scene.force(&scene.nodes);
        let (mut f, mut m, mut size) = (Vec3::zeros(), Vec3::zeros(), 0.0f64);
        for (node, F) in scene.nodes.iter().zip(F.chunks(6)) {
            let (force, moment) = (Vec3::new(F[0], F[1], F[2]), Vec3::new(F[3], F[4], F[5]));
            f += force;
            m += node.x.cross(&force) + moment;
            size = size.max(force.norm());
        }
        // Round-off of sums over some nodes, arms of length one or two.
        assert!(f.norm() < 1e-13 * size.max(1.0) && m.norm() < 1e-13 * size.max(1.0), "{what}: {f} {m}");
    });
}

#[test]
fn forces_turn_with_the_scene() {
    each(|rng, scene, what| {
        let F = scene.force(&scene.nodes);
        let size = F.iter().fold(1.0f64, |m, f| m.max(f.abs()));
        let (turn, shift) = (exp(&vector(rng, 3.0)), vector(rng, 5.0));
        let R = matrix(&turn);
        let turned =
            |n: &Node| Node { x: shift + R * n.x, rotation: turn * n.rotation, v: R * n.v, omega: R * n.omega, ..*n };
        let turned = scene.force(&scene.nodes.iter().map(turned).collect::<Vec<_>>());
        for (before, after) in F.chunks(3).zip(turned.chunks(3)) {
            let off = (R * Vec3::from_column_slice(before) - Vec3::from_column_slice(after)).norm();
            // Depths of 5e-3 are differences of positions of size 5, rounded to 1e-15: 1e-12 of the force.
            assert!(off < 1e-11 * size, "{what}: {off:e}");
        }
    });
}

/// A crumpled sheet of quadrilaterals.
fn sheet(rng: &mut StdRng, n: usize, crumple: f64) -> (Vec<Node>, Vec<Facet>) {
    let place = |i: usize, j: usize, rng: &mut StdRng| Vec3::new(i as f64, j as f64, 0.0) + vector(rng, crumple);
    let nodes = (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j)));
    let nodes: Vec<Node> = nodes.map(|(i, j)| Node::at_rest(place(i, j, rng))).collect();
    let at = |i: usize, j: usize| i * (n + 1) + j;
    let cells = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let facets = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        match (i + j) % 3 {
            0 => vec![Facet::new(&[a, b, c, d], 0.05)],
            _ => vec![Facet::new(&[a, b, c], 0.05), Facet::new(&[a, c, d], 0.05)],
        }
    });
    (nodes, facets.collect())
}

/// The energy of a smooth sheet is that of the nearest of all its facets: none is missed however the ball was thrown, and facets of a
/// surface count once.
#[test]
fn no_facet_is_missed() {
    let mut rng = StdRng::seed_from_u64(5);
    let (mut nodes, facets) = sheet(&mut rng, 12, 0.1);
    nodes.push(Node::at_rest(Vec3::zeros()));
    let radius = 0.3;
    let mut scene = Scene::new(law(0.0, Loss::None), nodes, facets.clone(), radius);
    // Each throw is the first that it knows of.
    scene.past.fill(0.0);
    let ball = scene.nodes.len() - 1;
    let mut touched = 0;
    for throw in 0..10_000 {
        scene.nodes[ball].x =
            Vec3::new(rng.random_range(-1.0..13.0), rng.random_range(-1.0..13.0), rng.random_range(-0.6..0.6));
        let x = scene.nodes[ball].x;
        // By brute force: samples of all triangles, then the nearest of them by its plane.
        let mut least = f64::INFINITY;
        for facet in &facets {
            let p: Vec<Vec3> = facet.nodes().iter().map(|&node| scene.nodes[node].x).collect();
            let middle = p.iter().sum::<Vec3>() / p.len() as f64;
            if (middle - x).norm() > 2.0 {
                continue;
            }
            let triangles: Vec<[Vec3; 3]> = match p.len() {
                3 => vec![[p[0], p[1], p[2]]],
                _ => (0..4).map(|k| [p[k], p[(k + 1) % 4], middle]).collect(),
            };
            least = triangles.iter().map(|triangle| distance(&x, triangle)).fold(least, f64::min);
        }
        let depth = (radius + 0.05 - least).max(0.0);
        let energy = scene.block.energy(&scene.now(&scene.nodes));
        touched += usize::from(depth > 0.0);
        // Two rims of a crumpled sheet may lie in two directions from a ball: then both push, and the deepest is among them.
        let own = 0.5 * STIFFNESS * depth * depth;
        assert!(energy > own - 1e-9 && energy < 2.5 * own + 1e-9, "throw {throw} at {x}: {energy} against {own}");
    }
    assert!(touched > 2000, "{touched}");
}

/// The distance of a point from a triangle, by its plane where that is within, else by its edges.
fn distance(x: &Vec3, [a, b, c]: &[Vec3; 3]) -> f64 {
    let n = (b - a).cross(&(c - a)).normalize();
    let y = x - n.dot(&(x - a)) * n;
    let within = [(a, b), (b, c), (c, a)].iter().all(|(p, q)| (*q - *p).cross(&(y - *p)).dot(&n) >= 0.0);
    if within {
        return n.dot(&(x - a)).abs();
    }
    let edge = |p: &Vec3, q: &Vec3| {
        let s = ((x - p).dot(&(q - p)) / (q - p).norm_squared()).clamp(0.0, 1.0);
        (x - p - s * (q - p)).norm()
    };
    edge(a, b).min(edge(b, c)).min(edge(c, a))
}

/// In the corner of three walls a ball feels all of them, and over a flat mesh one.
#[test]
fn walls_count_one_by_one() {
    let corner = |x: [f64; 3]| Node::at_rest(Vec3::from(x));
    let mut nodes: Vec<Node> =
        [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [1., 0., 1.], [0., 0., 1.], [0., 1., 1.]]
            .map(corner)
            .into();
    nodes.push(corner([0.1, 0.11, 0.12]));
    let facets = [[0, 1, 2, 3], [0, 1, 4, 5], [0, 3, 6, 5]].map(|corners| Facet::new(&corners, 0.0)).into();
    let scene = Scene::new(law(0.0, Loss::None), nodes, facets, 0.15);
    let F = scene.force(&scene.nodes);
    let own = &F[F.len() - 6..];
    // Depths of 0.05, 0.04 and 0.03 along the axes.
    for (f, depth) in own.iter().zip([0.05, 0.04, 0.03]) {
        assert!((f - STIFFNESS * depth).abs() < 1e-9, "{own:?}");
    }
}
