//! Matrices of dependent nodes, projected onto those that move by themselves.

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::constraints::rigid_link::{RigidLink, sorted};
use rdsolve::math::{Mat6, Vec3, rotation};
use rdsolve::solve::inner::{Arms, Followers};
use rdsolve::state::Node;
use rdsolve::system::DofMap;
use rdsolve::system::dependents::{independent_nodes, projections};

const ALL: [bool; 6] = [true; 6];
const BALL: [bool; 6] = [true, true, true, false, false, false];
const TURNS: [bool; 6] = [false, false, false, true, true, true];
const MIXED: [bool; 6] = [true, false, true, false, true, true];
const NODES: usize = 8;

/// Node 0 is free, like 7; the others follow 0 rigidly, as a ball, in a chain of both, and in single directions.
fn links(x: &[Vec3]) -> Vec<RigidLink> {
    let ties = [(1, 0, ALL), (2, 1, ALL), (3, 2, BALL), (4, 3, BALL), (5, 4, MIXED), (6, 0, TURNS)];
    sorted(ties.map(|(node, master, dofs)| RigidLink::new(node, master, x, dofs)).to_vec(), NODES).unwrap()
}

/// 𝒯ᵀ K 𝒯 by general products: the motion of `nodes`, with `d` degrees of freedom each, from that of all nodes.
fn general(K: &[f64], d: usize, nodes: &[usize], of: &[Vec<usize>], T: &[Vec<Mat6>]) -> nalgebra::DMatrix<f64> {
    let width = d * nodes.len();
    let mut whole = nalgebra::DMatrix::zeros(width, 6 * NODES);
    for (a, &node) in nodes.iter().enumerate() {
        for (&independent, T) in of[node].iter().zip(&T[node]) {
            let mut block = whole.view_mut((d * a, 6 * independent), (d, 6));
            block += T.rows(0, d);
        }
    }
    whole.transpose() * nalgebra::DMatrix::from_row_slice(width, width, K) * whole
}

/// At random states, against general products; rounding of some hundred terms is left.
#[test]
fn matrices_are_projected_as_by_general_products() {
    let mut rng = StdRng::seed_from_u64(5);
    let mut vector = |size: f64| Vec3::from_fn(|_, _| rng.random_range(-size..size));
    let x: Vec<Vec3> = (0..NODES).map(|_| vector(2.0)).collect();
    let links = links(&x);
    let mut nodes: Vec<Node> = x.iter().map(|x| Node::at_rest(*x)).collect();
    nodes.iter_mut().for_each(|node| node.rotation = rotation::exp(&vector(2.0)));
    let dofs = DofMap::new([[true; 6]; NODES].into_iter(), &[]);
    let followers = Followers::new(&links, NODES);
    let of = independent_nodes(&links, NODES);
    let T = projections(&links, &nodes, &of);
    let lists: [&[usize]; 7] = [&[1], &[5], &[0, 1], &[7, 2, 3], &[5, 4, 1, 6], &[6, 0], &[2, 4, 7, 3, 5]];
    for list in lists {
        for d in [3, 6] {
            let width = d * list.len();
            let mut K: Vec<f64> = (0..width * width).map(|_| vector(1.0).x).collect();
            let expected = general(&K, d, list, &of, &T);
            let mut arms = Arms::default();
            let (projection, rows) = arms.push(&followers, &dofs, list, d);
            let mut room = vec![0.0; rows.len().pow(2)];
            let result = arms.project(&projection, &T, (&mut K, width), &mut room);
            let mut sum = nalgebra::DMatrix::zeros(6 * NODES, 6 * NODES);
            for (k, value) in result.iter().enumerate() {
                let [row, column] = [k / rows.len(), k % rows.len()].map(|i| 6 * rows[i].0 + rows[i].1);
                sum[(row, column)] += value;
            }
            let error = (&sum - &expected).amax();
            assert!(error < 1e-13 * expected.amax(), "{list:?}, {d} a node: {error:e}");
        }
    }
}
