//! The nodes of a part that is reduced, and its elements.

use super::linearized::Linearized;
use base::math::Vec6;
use mechanics::elements::Moduli;
use mechanics::state::{Configuration, Node};
use model::Reduction;
use nalgebra::DMatrix;

/// The nodes of a part: its interface, those that bodies carry, then those inside. Columns hold the motions of these alone.
pub struct OwnNodes {
    nodes: Vec<usize>,
    /// The place of each node of the scene among them; the number of nodes for others.
    pub place: Vec<usize>,
}

impl OwnNodes {
    /// Those of a part in a scene of so many nodes.
    pub fn new(of: &Reduction, scene: usize) -> OwnNodes {
        let nodes: Vec<usize> = of.nodes().collect();
        let mut place = vec![nodes.len(); scene];
        nodes.iter().enumerate().for_each(|(k, &node)| place[node] = k);
        OwnNodes { nodes, place }
    }

    /// The nodes.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// The motions of these nodes out of those of the scene.
    pub fn of(&self, scene: &[Vec6]) -> Vec<Vec6> {
        self.nodes.iter().map(|&node| scene[node]).collect()
    }

    /// Motions of these nodes as columns.
    pub fn matrix(&self, motions: &[Vec<Vec6>]) -> DMatrix<f64> {
        DMatrix::from_fn(6 * self.nodes.len(), motions.len(), |row, column| motions[column][row / 6][row % 6])
    }
}

/// Calls `visit` with the nodes of each element, its degrees of freedom per node and its stiffness.
pub fn each_element(at: &Linearized, nodes: &[Node], mut visit: impl FnMut(&[usize], usize, &[f64])) {
    let now = Configuration { nodes, history: &at.state.history, dt: 0.0, previous: None };
    let mut K = Vec::new();
    for group in &at.system.groups {
        let (block, own) = (&group.block, &group.configuration(&now));
        for e in 0..block.len() {
            let of = block.nodes(e);
            K.clear();
            K.resize((block.dofs() * of.len()).pow(2), 0.0);
            block.tangent(e, own, 0.0, Moduli::Elastic, &mut K);
            visit(of, block.dofs(), &K);
        }
    }
}
