//! Forces and tangents of elastic beams in microseconds an element: forces of a group, tangents one after the other and eight side by side,
//! without their places in the matrix. Least of many repeats, one thread. `cargo bench --bench beams`

use rdsolve::elements::Moduli;
use rdsolve::elements::beam::{BeamGeometry, BeamSetting, elastic_beams};
use rdsolve::elements::heat::Heat;
use rdsolve::math::{Mat3, Vec3, rotation};
use rdsolve::sections::Stiffness;
use rdsolve::state::{Configuration, Node};
use std::hint::black_box;
use std::time::Instant;

const COUNT: usize = 512;
const REPEATS: usize = 300;

/// Microseconds an element.
fn least(mut run: impl FnMut()) -> f64 {
    let once = |_| {
        let began = Instant::now();
        run();
        began.elapsed().as_secs_f64()
    };
    (0..REPEATS).map(once).fold(f64::INFINITY, f64::min) / COUNT as f64 * 1e6
}

fn beams<const N: usize>() {
    let x: Vec<Vec3> = (0..COUNT * (N - 1) + 1).map(|i| Vec3::new(0.1 * i as f64, 0.0, 0.0)).collect();
    let lists: Vec<[usize; N]> = (0..COUNT).map(|e| std::array::from_fn(|a| e * (N - 1) + a)).collect();
    let stiffness = Stiffness::general(2e6, [8e5, 8e5], 1e5, [2e5, 1e5], 1.0, [1.0; 3]);
    let frame = Mat3::identity();
    let elements = lists.iter().map(|nodes| BeamGeometry { nodes, frame: &frame, stiffness: &stiffness, varied: None });
    let block =
        elastic_beams(N - 1, &elements.collect::<Vec<_>>(), BeamSetting { x: &x, damping: 0.0, heat: &Heat::NONE });
    let moved = |(i, x): (usize, &Vec3)| Node {
        rotation: rotation::exp(&Vec3::new(0.01 * (i as f64).cos(), 0.2, 0.03)),
        ..Node::at_rest(x + Vec3::new(1e-3 * (i as f64).sin(), 2e-3 * (0.7 * i as f64).cos(), 0.0))
    };
    let nodes: Vec<Node> = x.iter().enumerate().map(moved).collect();
    let now = Configuration::of(&nodes);
    let mut F = vec![[0.0; 6]; nodes.len()];
    let forces = least(|| {
        block.subtract_forces(&now, &mut F);
        black_box(&F);
    });
    let length = 36 * N * N;
    let mut K = vec![0.0; length * COUNT];
    let one = least(|| {
        let each = K.chunks_mut(length).enumerate();
        each.for_each(|(e, K)| block.tangent(e, &now, 0.0, Moduli::Algorithmic, K));
        black_box(&K);
    });
    let eight = least(|| {
        block.tangents(0, &now, 0.0, Moduli::Algorithmic, &mut K);
        black_box(&K);
    });
    println!("{N} nodes: forces {forces:.3}, tangent {one:.3}, side by side {eight:.3}");
}

fn main() {
    beams::<2>();
    beams::<3>();
    beams::<4>();
    beams::<5>();
}
