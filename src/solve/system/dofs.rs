//! The numbering of the unknowns: the row in the matrix of each degree of freedom. Rows of nodes come first, node by node; the multipliers
//! of each joint follow, as if the joint were one more node.

use base::math::Vec6;
use mechanics::constraints::joint::Joint;

/// Marks a degree of freedom without a row. No other file sees it.
const NONE: u32 = u32::MAX;

/// The rows of one node's degrees of freedom, or of one joint's multipliers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NodeRows([u32; 6]);

impl NodeRows {
    /// The row of the degree of freedom `dof`; `None` where it is no unknown.
    #[inline]
    pub fn get(&self, dof: usize) -> Option<usize> {
        if self.has(dof) { Some(self.0[dof] as usize) } else { None }
    }

    /// True where the degree of freedom is an unknown.
    #[inline]
    pub fn has(&self, dof: usize) -> bool {
        self.0[dof] != NONE
    }

    /// True for each degree of freedom that is an unknown.
    pub fn unknown(&self) -> [bool; 6] {
        std::array::from_fn(|dof| self.has(dof))
    }

    /// Number of unknowns of the node.
    pub fn count(&self) -> usize {
        (0..6).filter(|&dof| self.has(dof)).count()
    }

    /// The first row of a node with six unknowns; the other five follow it. `None` for other nodes.
    pub fn first_of_six(&self) -> Option<usize> {
        if self.count() == 6 { self.get(0) } else { None }
    }

    /// The entries of `x` in these rows, and zero for a degree of freedom that is no unknown.
    #[inline]
    pub fn gather(&self, x: &[f64]) -> Vec6 {
        Vec6::from_fn(|dof, _| self.get(dof).map_or(0.0, |row| x[row]))
    }

    /// Writes the entries of `values` into these rows of `x`.
    #[inline]
    pub fn scatter(&self, values: &Vec6, x: &mut [f64]) {
        for dof in 0..6 {
            if let Some(row) = self.get(dof) {
                x[row] = values[dof];
            }
        }
    }

    /// The `values` of the unknowns, and zero for other degrees of freedom.
    #[inline]
    pub fn mask(&self, values: &Vec6) -> Vec6 {
        Vec6::from_fn(|dof, _| if self.has(dof) { values[dof] } else { 0.0 })
    }
}

/// The rows of all nodes, then those of the multipliers of all joints. They are constant over a run.
#[derive(Debug, Clone)]
pub struct DofMap {
    rows: Vec<NodeRows>,
    nodes: usize,
    /// Node and degree of freedom of each row that belongs to a node.
    nodal_dofs: Vec<(usize, usize)>,
    unknowns: usize,
}

impl DofMap {
    /// Numbers the unknown degrees of freedom, node by node, then the multipliers of the joints.
    pub fn new(unknown: impl Iterator<Item = [bool; 6]>, joints: &[Joint]) -> DofMap {
        let mut map = DofMap { rows: Vec::new(), nodes: 0, nodal_dofs: Vec::new(), unknowns: 0 };
        for (node, unknown) in unknown.enumerate() {
            map.nodal_dofs.extend((0..6).filter(|&dof| unknown[dof]).map(|dof| (node, dof)));
            map.push(unknown);
        }
        map.nodes = map.rows.len();
        joints.iter().for_each(|joint| map.push(std::array::from_fn(|k| k < joint.equations.len())));
        map
    }

    /// Gives the next rows to a node or a joint.
    fn push(&mut self, unknown: [bool; 6]) {
        self.rows.push(NodeRows(unknown.map(|unknown| {
            let row = self.unknowns as u32;
            self.unknowns += usize::from(unknown);
            if unknown { row } else { NONE }
        })));
    }

    /// The row of a degree of freedom of a node; `None` where it is no unknown.
    #[inline]
    pub fn row(&self, node: usize, dof: usize) -> Option<usize> {
        self.rows[node].get(dof)
    }

    /// The rows of a node, or of the multipliers of the k-th joint at [`DofMap::nodes`] + k.
    #[inline]
    pub fn of(&self, node: usize) -> &NodeRows {
        &self.rows[node]
    }

    /// The rows of all nodes, without those of multipliers.
    pub fn each_node(&self) -> &[NodeRows] {
        &self.rows[..self.nodes]
    }

    /// The rows of all nodes, then those of the multipliers of all joints.
    pub fn each(&self) -> &[NodeRows] {
        &self.rows
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// Node and degree of freedom (0 to 5) of each row that belongs to a node. The rows of multipliers come after
    /// these.
    pub fn nodal_dofs(&self) -> &[(usize, usize)] {
        &self.nodal_dofs
    }

    /// Number of rows: degrees of freedom and multipliers.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }
}
