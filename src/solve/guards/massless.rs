//! Directions without mass in a dynamic analysis: the forces on them must restrain them at every instant, since inertia does not. A node
//! without mass at the end of a spring moves across it as rounding pleases, and one in the middle of a compressed chain buckles at once.
//! Neither has a motion to compute. Directions come from the tangent and may be oblique to the axes.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::guard::Guard;
use crate::guards::mechanism::open_part;
use crate::step::trial::{Stage, Step};
use crate::tolerances::massless::{MOST, ROUNDING, SMALL};
use crate::workspace::Workspace;
use base::math::Vec3;
use base::snapshot::{Keep, Snapshot};
use mechanics::elements::Moduli;
use mechanics::state::{Configuration, Node};
use nalgebra::DMatrix;

/// The nodes without mass that springs, dampers, bars and contacts alone hold. Beams and shells hold theirs by bending, and the
/// matrix says where they do not.
pub struct MasslessNodes {
    clusters: Vec<Cluster>,
    /// The tangent of an element; its memory serves for all.
    K: Vec<f64>,
    /// True once the initial configuration has been found restrained.
    started: bool,
}

/// Nodes that elements join to one another.
struct Cluster {
    /// Node and degree of freedom of each row.
    dofs: Vec<(usize, usize)>,
    elements: Vec<Element>,
    /// The lower triangle and the diagonal, row by row.
    matrix: Vec<f64>,
}

/// An element on a cluster.
struct Element {
    group: usize,
    e: usize,
    /// Pairs of a row of the element matrix and a row of the cluster matrix.
    rows: Vec<(usize, usize)>,
}

impl MasslessNodes {
    /// The nodes of a dynamic scene.
    pub fn new(cx: &Context) -> MasslessNodes {
        let light = light_dofs(cx);
        let largest = cx.system.groups.iter().map(|group| {
            let nodes = (0..group.block.len()).map(|e| group.block.nodes(e).len()).max().unwrap_or(0);
            (group.block.dofs() * nodes).pow(2)
        });
        let has_any = light.iter().any(|light| light.contains(&true));
        let clusters = if has_any { clusters(cx, &light) } else { Vec::new() };
        MasslessNodes { K: vec![0.0; if has_any { largest.max().unwrap_or(0) } else { 0 }], clusters, started: false }
    }

    /// Refuses a configuration with an unrestrained massless direction.
    fn check(&mut self, cx: &Context, now: &Configuration, stage: &Stage) -> Result<(), Failure> {
        let (rate, _) = stage.scheme.weights();
        for cluster in &mut self.clusters {
            cluster.assemble(cx, now, rate, &mut self.K);
            if !cluster.is_held() {
                cluster.assemble(cx, now, rate, &mut self.K);
                return Err(cluster.failure(cx, now));
            }
        }
        Ok(())
    }
}

impl Guard for MasslessNodes {
    /// Refuses a model with a massless direction that is unrestrained before anything moves. Dampers restrain only along their lines: their
    /// forces depend on velocities, which massless nodes do not have at t = 0.
    fn before_step(&mut self, cx: &Context, step: &Step) -> Result<(), Failure> {
        if self.clusters.is_empty() || self.started {
            return Ok(());
        }
        let at_rest = |node: &Node| Node { v: Vec3::zeros(), omega: Vec3::zeros(), ..*node };
        let nodes: Vec<Node> = step.state.nodes.iter().map(at_rest).collect();
        self.check(cx, &step.at_instant(&nodes), &step.stage)?;
        self.started = true;
        Ok(())
    }

    /// Refuses an equilibrium with an unrestrained massless direction.
    fn before_end(&mut self, cx: &Context, ws: &mut Workspace, step: &Step) -> Result<(), Failure> {
        self.check(cx, &step.at_instant(&ws.trial.nodes), &step.stage)
    }

    fn begin_run(&mut self) {
        self.started = false;
    }

    fn keep(&mut self, snapshot: &mut Snapshot) {
        self.started.keep(snapshot);
    }
}

/// For each node the unknown degrees of freedom that have no mass and no element with bending stiffness.
fn light_dofs(cx: &Context) -> Vec<[bool; 6]> {
    let has_mass = cx.system.has_mass(cx.model.nodes.len());
    let mut light: Vec<[bool; 6]> = (0..cx.model.nodes.len())
        .map(|node| std::array::from_fn(|dof| cx.plan.is_unknown(node, dof) && !has_mass[node][dof / 3]))
        .collect();
    for group in cx.system.groups.iter().filter(|group| group.kind.is_deformable() && group.block.dofs() == 6) {
        for &node in (0..group.block.len()).flat_map(|e| group.block.nodes(e)) {
            light[node] = [false; 6];
        }
    }
    // Joints restrain nodes by multipliers, and forces on a dependent node act on its master through an arm.
    let joined = cx.system.joints.iter().flat_map(|joint| joint.matrix_nodes());
    let leading = cx.system.rigid_links.iter().map(|dependent| dependent.master);
    joined.chain(leading).for_each(|node| light[node] = [false; 6]);
    light
}

/// The clusters of these degrees of freedom.
fn clusters(cx: &Context, light: &[[bool; 6]]) -> Vec<Cluster> {
    let is_light = |node: usize| light[node].contains(&true);
    // Each joined node points to an earlier one, and the first to itself.
    let mut leader: Vec<usize> = (0..light.len()).collect();
    let find = |leader: &[usize], mut node: usize| {
        while leader[node] != node {
            node = leader[node];
        }
        node
    };
    for group in &cx.system.groups {
        for e in 0..group.block.len() {
            let mut nodes = group.block.nodes(e).iter().copied().filter(|&node| is_light(node));
            let Some(first) = nodes.next() else { continue };
            for node in nodes {
                let [a, b] = [find(&leader, first), find(&leader, node)];
                leader[a.max(b)] = a.min(b);
            }
        }
    }
    let mut size = vec![0; light.len()];
    (0..light.len()).for_each(|node| size[find(&leader, node)] += light[node].iter().filter(|light| **light).count());
    let of = |node: usize| {
        let first = find(&leader, node);
        if size[first] > MOST { node } else { first }
    };
    let mut number = vec![None; light.len()];
    let mut clusters: Vec<Cluster> = Vec::new();
    let mut row = vec![[None; 6]; light.len()];
    for node in (0..light.len()).filter(|&node| is_light(node)) {
        let place = *number[of(node)].get_or_insert_with(|| {
            clusters.push(Cluster { dofs: Vec::new(), elements: Vec::new(), matrix: Vec::new() });
            clusters.len() - 1
        });
        for dof in (0..6).filter(|&dof| light[node][dof]) {
            row[node][dof] = Some((place, clusters[place].dofs.len()));
            clusters[place].dofs.push((node, dof));
        }
    }
    for (number, group) in cx.system.groups.iter().enumerate() {
        let d = group.block.dofs();
        for e in 0..group.block.len() {
            let nodes = group.block.nodes(e);
            let all = nodes.iter().enumerate().flat_map(|(k, &node)| (0..d).map(move |dof| (k * d + dof, node, dof)));
            for (own, node, dof) in all {
                let Some((place, row)) = row[node][dof] else { continue };
                let elements = &mut clusters[place].elements;
                if elements.last().is_none_or(|last| (last.group, last.e) != (number, e)) {
                    elements.push(Element { group: number, e, rows: Vec::new() });
                }
                elements.last_mut().into_iter().for_each(|element| element.rows.push((own, row)));
            }
        }
    }
    clusters.iter_mut().for_each(|cluster| cluster.matrix = vec![0.0; cluster.dofs.len().pow(2)]);
    clusters
}

impl Cluster {
    /// Writes the tangent, with damping by the weight of velocities.
    fn assemble(&mut self, cx: &Context, now: &Configuration, rate: f64, K: &mut [f64]) {
        let size = self.dofs.len();
        self.matrix.fill(0.0);
        for Element { group, e, rows } in &self.elements {
            let group = &cx.system.groups[*group];
            let now = &group.configuration(now);
            if group.block.is_inactive(*e, now) {
                continue;
            }
            let n = group.block.dofs() * group.block.nodes(*e).len();
            let K = &mut K[..n * n];
            K.fill(0.0);
            group.block.tangent(*e, now, rate, Moduli::Algorithmic, K);
            for &(i, row) in rows {
                rows.iter().for_each(|&(j, column)| self.matrix[row * size + column] += K[i * n + j]);
            }
        }
        for damping in cx.system.nodal_damping() {
            for (row, _) in self.dofs.iter().enumerate().filter(|(_, (node, _))| *node == damping.node) {
                let c = if self.dofs[row].1 < 3 { damping.translation } else { damping.rotation };
                self.matrix[row * size + row] += rate * c;
            }
        }
    }

    /// True if all pivots of a Cholesky factorization are above rounding; the factor overwrites the matrix.
    fn is_held(&mut self) -> bool {
        let (size, K) = (self.dofs.len(), &mut self.matrix);
        for k in 0..size {
            let diagonal = K[k * size + k];
            let sum: f64 = (0..k).map(|j| K[k * size + j] * K[k * size + j]).sum();
            let pivot = diagonal - sum;
            // A NaN counts as unrestrained.
            if pivot <= ROUNDING * diagonal || pivot.is_nan() {
                return false;
            }
            let root = pivot.sqrt();
            K[k * size + k] = root;
            for i in k + 1..size {
                let sum: f64 = (0..k).map(|j| K[i * size + j] * K[k * size + j]).sum();
                K[i * size + k] = (K[i * size + k] - sum) / root;
            }
        }
        true
    }

    /// The node with the softest direction, and this direction.
    fn failure(&self, cx: &Context, now: &Configuration) -> Failure {
        let size = self.dofs.len();
        // Forces and moments are compared by their diagonals.
        let scale = |i: usize| match self.matrix[i * size + i].abs() {
            diagonal if diagonal > 0.0 && diagonal.is_finite() => 1.0 / diagonal.sqrt(),
            _ => 1.0,
        };
        let entry = |i: usize, j: usize| {
            let value = self.matrix[i.max(j) * size + i.min(j)] * scale(i) * scale(j);
            if value.is_finite() { value } else { 0.0 }
        };
        let eigen = DMatrix::from_fn(size, size, entry).symmetric_eigen();
        let least = (0..size).min_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b])).unwrap_or(0);
        let mode: Vec<f64> = (0..size).map(|i| eigen.eigenvectors[(i, least)] * scale(i)).collect();
        let (node, dof) = (0..size)
            .max_by(|&a, &b| eigen.eigenvectors[(a, least)].abs().total_cmp(&eigen.eigenvectors[(b, least)].abs()))
            .map_or((0, 0), |i| self.dofs[i]);
        let of =
            |axis: usize| self.dofs.iter().position(|&at| at == (node, 3 * (dof / 3) + axis)).map_or(0.0, |i| mode[i]);
        let direction = Vec3::from_fn(|axis, _| of(axis));
        let (unit, sign) = (direction / direction.norm(), direction[direction.iamax()].signum());
        let shown = unit.map(|x| if x.abs() < SMALL * unit.amax() { 0.0 } else { x * sign });
        Failure::MasslessDirection {
            label: cx.model.nodes[node].label.clone(),
            rotation: dof >= 3,
            direction: shown.into(),
            buckles: eigen.eigenvalues[least] < -ROUNDING,
            open: open_part(cx.model, cx.system, now, node),
        }
    }
}
