//! Dependent nodes in matrices: the projection 𝒯ᵀ K 𝒯 of a local matrix onto the independent nodes (58).
//!
//! A degree of freedom of a dependent node is either unknown itself, or follows the same degree of freedom of a master, through any chain
//! of masters. Its row is then added to the row of the master. In addition, arms turn forces on translations into moments on rotations: `u
//! = … + G θ` with a 3×3 matrix G, −S~ for an arm S. Only these blocks need a product.

use super::dofs::DofMap;
use base::math::{Mat3, Mat6, skew};
use mechanics::constraints::rigid_link::RigidLink;
use mechanics::state::Node;
use std::ops::Range;

/// The independent nodes that move each node: the node itself, or the ends of its chain of masters (and the node itself if it has
/// unknowns).
pub fn independent_nodes(links: &[RigidLink], nodes: usize) -> Vec<Vec<usize>> {
    let mut independent_nodes: Vec<Vec<usize>> = (0..nodes).map(|n| vec![n]).collect();
    for dependent in links {
        let mut of = independent_nodes[dependent.master].clone();
        if !dependent.rigid {
            of.push(dependent.node);
        }
        independent_nodes[dependent.node] = of;
    }
    independent_nodes
}

/// The projection matrices: for each node and each of its independent nodes, the matrix that maps the motion of the independent node to the
/// node.
pub fn projections(links: &[RigidLink], nodes: &[Node], independent_nodes: &[Vec<usize>]) -> Vec<Vec<Mat6>> {
    let mut projections: Vec<_> = independent_nodes.iter().map(|r| vec![Mat6::identity(); r.len()]).collect();
    update_projections(links, nodes, &mut projections);
    projections
}

/// Updates the projection matrices of dependent nodes along the chains of arms.
pub(super) fn update_projections(links: &[RigidLink], nodes: &[Node], projections: &mut [Vec<Mat6>]) {
    for dependent in links {
        let arm = skew(&dependent.arm(&nodes[dependent.master]));
        for k in 0..projections[dependent.master].len() {
            // D T, where the lower left block of T is zero.
            let mut T = projections[dependent.master][k];
            let turned = arm * T.fixed_view::<3, 3>(3, 3);
            let mut G = T.fixed_view_mut::<3, 3>(0, 3);
            G -= turned;
            for i in (0..6).filter(|&i| !dependent.dofs[i]) {
                T.row_mut(i).fill(0.0);
            }
            projections[dependent.node][k] = T;
        }
        if !dependent.rigid {
            let own = projections[dependent.node].len() - 1;
            let free = dependent.dofs.map(|taken| if taken { 0.0 } else { 1.0 });
            projections[dependent.node][own] = Mat6::from_diagonal(&free.into());
        }
    }
}

/// The dependence of each node on others. It is constant over a run.
pub struct Followers {
    /// For each node the independent nodes that it moves with.
    pub independent_nodes: Vec<Vec<usize>>,
    /// For each node and degree of freedom, the independent node with the same degree of freedom that it follows; the node itself for
    /// unknowns.
    carriers: Vec<[usize; 6]>,
    /// For each node the numbers, among its independent nodes, of those whose rotations move it by an arm.
    armed: Vec<Vec<usize>>,
}

impl Followers {
    /// The followers among this number of nodes.
    pub fn new(links: &[RigidLink], nodes: usize) -> Self {
        let independent_nodes = independent_nodes(links, nodes);
        let mut carriers: Vec<[usize; 6]> = (0..nodes).map(|n| [n; 6]).collect();
        let mut armed = vec![Vec::new(); nodes];
        for dependent in links {
            let of = carriers[dependent.master];
            carriers[dependent.node] = std::array::from_fn(|i| if dependent.dofs[i] { of[i] } else { dependent.node });
            if !dependent.dofs[..3].contains(&true) {
                continue;
            }
            let turns = |k: &usize| of[3..].contains(&independent_nodes[dependent.master][*k]);
            let masters = 0..independent_nodes[dependent.master].len();
            armed[dependent.node] = masters.filter(|k| turns(k) || armed[dependent.master].contains(k)).collect();
        }
        Followers { independent_nodes, carriers, armed }
    }

    /// True for a node that is independent in all degrees of freedom.
    pub fn is_independent(&self, node: usize) -> bool {
        self.independent_nodes[node] == [node]
    }
}

/// An arm of a node: its translations follow rotations of an independent node.
struct Arm {
    node: usize,
    /// Number of the independent node in the list of the node.
    independent: usize,
    /// The first of the three rows of the node's translations in the local matrix, and of the independent node's rotations.
    translations: usize,
    rotations: usize,
}

/// The arms of all local matrices, one after the other.
#[derive(Default)]
pub struct Arms(Vec<Arm>);

/// The place of a local matrix with dependent nodes among [`Arms`].
pub struct Projection {
    arms: Range<usize>,
    /// Number of rows of the projected matrix: the rows of the local one, then additional rotations.
    width: usize,
}

impl Arms {
    /// Adds the arms of a local matrix over `nodes` with `d` degrees of freedom each. Returns its place, and node and degree
    /// of freedom of each row of the projected matrix.
    pub fn push(
        &mut self,
        followers: &Followers,
        dofs: &DofMap,
        nodes: &[usize],
        d: usize,
    ) -> (Projection, Vec<(usize, usize)>) {
        let first = self.0.len();
        let own = |&node: &usize| (0..d).map(move |i| (followers.carriers[node][i], i));
        let mut rows: Vec<(usize, usize)> = nodes.iter().flat_map(own).collect();
        for (a, &node) in nodes.iter().enumerate() {
            for &k in &followers.armed[node] {
                let master = followers.independent_nodes[node][k];
                if (3..6).all(|dof| dofs.row(master, dof).is_none()) {
                    continue;
                }
                let turns = [3, 4, 5].map(|dof| (master, dof));
                let rotations = rows.windows(3).position(|three| three == turns).unwrap_or(rows.len());
                if rotations == rows.len() {
                    rows.extend(turns);
                }
                self.0.push(Arm { node, independent: k, translations: d * a, rotations });
            }
        }
        (Projection { arms: first..self.0.len(), width: rows.len() }, rows)
    }

    /// Projects the matrix `K` of `width` rows. The result has as many rows as [`Arms::push`] has named, and stands in `K`
    /// itself or in `room`.
    pub fn project<'k>(
        &self,
        projection: &Projection,
        projections: &[Vec<Mat6>],
        (K, width): (&'k mut [f64], usize),
        room: &'k mut [f64],
    ) -> &'k [f64] {
        let K = if projection.width == width { K } else { widen(K, width, projection.width, room) };
        for arm in &self.0[projection.arms.clone()] {
            let G = projections[arm.node][arm.independent].fixed_view::<3, 3>(0, 3).into_owned();
            transfer(&G, arm, K, projection.width);
        }
        K
    }
}

impl Projection {
    /// Number of rows of the projected matrix.
    pub fn width(&self) -> usize {
        self.width
    }
}

/// Copies a square matrix of `width` rows into the upper left corner of one of `wider` rows.
fn widen<'r>(K: &[f64], width: usize, wider: usize, room: &'r mut [f64]) -> &'r mut [f64] {
    let room = &mut room[..wider * wider];
    for (i, row) in room.chunks_mut(wider).enumerate() {
        let (own, rest) = row.split_at_mut(width);
        if i < width {
            own.copy_from_slice(&K[i * width..(i + 1) * width]);
        } else {
            own.fill(0.0);
        }
        rest.fill(0.0);
    }
    room
}

/// Adds K G to the columns of the rotations, then Gᵀ K to their rows. Row-major or column-major is the same.
#[inline]
fn transfer(G: &Mat3, &Arm { translations, rotations, .. }: &Arm, K: &mut [f64], width: usize) {
    for row in K.chunks_exact_mut(width) {
        let [x, y, z] = [row[translations], row[translations + 1], row[translations + 2]];
        for (j, sum) in row[rotations..rotations + 3].iter_mut().enumerate() {
            *sum += x * G[(0, j)] + y * G[(1, j)] + z * G[(2, j)];
        }
    }
    let (from, to) = (translations * width, rotations * width);
    let (source, target) = if from < to {
        let (low, high) = K.split_at_mut(to);
        (&low[from..from + 3 * width], &mut high[..3 * width])
    } else {
        let (low, high) = K.split_at_mut(from);
        (&high[..3 * width], &mut low[to..to + 3 * width])
    };
    let (x, rest) = source.split_at(width);
    let (y, z) = rest.split_at(width);
    for (i, row) in target.chunks_exact_mut(width).enumerate() {
        let [gx, gy, gz] = [G[(0, i)], G[(1, i)], G[(2, i)]];
        for (((sum, x), y), z) in row.iter_mut().zip(x).zip(y).zip(z) {
            *sum += gx * x + gy * y + gz * z;
        }
    }
}
