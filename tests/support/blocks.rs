//! Elements asked one by one, without a scene around them.

use nalgebra::DMatrix;
use rdsolve::elements::{ElementBlock, Force, Moduli, ShellResultants};
use rdsolve::math::{Vec3, rotation};
use rdsolve::state::{Configuration, Node};

/// The internal forces on all nodes.
pub fn forces(block: &dyn ElementBlock, now: &Configuration) -> Vec<Force> {
    let mut F = vec![[0.0; 6]; now.nodes.len()];
    block.subtract_forces(now, &mut F);
    F.iter().map(|f| f.map(|c| -c)).collect()
}

/// The stiffness of all elements together.
pub fn stiffness(block: &dyn ElementBlock, nodes: &[Node]) -> DMatrix<f64> {
    let mut K = DMatrix::zeros(6 * nodes.len(), 6 * nodes.len());
    for e in 0..block.len() {
        let of = block.nodes(e);
        let n = 6 * of.len();
        let mut k = vec![0.0; n * n];
        block.tangent(e, &Configuration::of(nodes), 0.0, Moduli::Algorithmic, &mut k);
        for i in 0..n {
            for j in 0..n {
                K[(6 * of[i / 6] + i % 6, 6 * of[j / 6] + j % 6)] += k[i * n + j];
            }
        }
    }
    K
}

/// Moves a node by `h` along one of its degrees of freedom.
pub fn nudge(node: &mut Node, dof: usize, h: f64) {
    let mut d = Vec3::zeros();
    d[dof % 3] = h;
    if dof < 3 { node.x += d } else { node.rotation = rotation::exp(&d) * node.rotation }
}

/// The stress resultants of shell elements, whose nodes lay at `x`.
pub fn resultants(block: &dyn ElementBlock, axis: &Vec3, x: &[Vec3], now: &Configuration) -> Vec<ShellResultants> {
    let mut all = Vec::new();
    block.resultants(axis, &|node| x[node], now, &mut |_, at| all.push(at));
    all
}
