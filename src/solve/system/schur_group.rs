//! The part of G M⁻¹ Gᵀ that belongs to joints which bodies connect: no entry couples it with others, and it is solved by itself.

use super::gradients::Gradients;
use super::independent_rows::IndependentRows;
use super::masses::Masses;
use super::schur_factor::SchurFactor;
use crate::tolerances::independent_rows::MOST;
use crate::tolerances::multipliers::REGULARIZATION;

/// A group of equations with the factor of their matrix. It is allocated once.
pub struct SchurGroup {
    /// The numbers of the equations among all, ascending.
    equations: Vec<usize>,
    factor: SchurFactor,
    /// Which equations are solved for, where some may be redundant and they are not too many to find out.
    independent: Option<IndependentRows>,
    /// Values of the equations of the group: whether no acceleration responds, what loads weigh, by how much the diagonal is raised.
    inert: Vec<bool>,
    weights: Vec<f64>,
    raised: Vec<f64>,
    /// Right-hand side, then the solution; `scratch` holds a copy.
    x: Vec<f64>,
    scratch: Vec<f64>,
}

/// The groups of joints with so many equations each, which move the nodes `rows`. Few equations, and those that depend on no others, are one group.
/// `None` where there is no memory.
pub fn of(sizes: &[usize], gradients: &Gradients, shares: bool) -> Option<Vec<SchurGroup>> {
    let whole = gradients.count() <= SchurFactor::MOST_DENSE || !shares;
    let groups = if whole { vec![(0..sizes.len()).collect()] } else { connected(sizes, gradients) };
    let firsts: Vec<usize> = sizes.iter().scan(0, |next, size| Some(std::mem::replace(next, *next + size))).collect();
    let group = |joints: &Vec<usize>| {
        let own: Vec<usize> = joints.iter().map(|&joint| sizes[joint]).collect();
        let equations: Vec<usize> =
            joints.iter().flat_map(|&joint| firsts[joint]..firsts[joint] + sizes[joint]).collect();
        let own_rows: Vec<_> = equations.iter().map(|&k| gradients.nodes(k)).collect();
        let count = equations.len();
        Some(SchurGroup {
            factor: SchurFactor::new(&own, &own_rows)?,
            independent: (shares && count <= MOST).then(|| IndependentRows::new(&own_rows)),
            equations,
            inert: vec![false; count],
            weights: vec![0.0; count],
            raised: vec![0.0; count],
            x: vec![0.0; count],
            scratch: vec![0.0; count],
        })
    };
    groups.iter().map(group).collect()
}

/// Joints in groups that no node connects, in order of their first joints.
fn connected(sizes: &[usize], gradients: &Gradients) -> Vec<Vec<usize>> {
    let rows = || (0..gradients.count()).map(|k| gradients.nodes(k).iter().flatten());
    let nodes = rows().flatten().max().map_or(0, |last| last + 1);
    let mut towards: Vec<usize> = (0..nodes).collect();
    fn root(towards: &mut [usize], mut node: usize) -> usize {
        while towards[node] != node {
            towards[node] = towards[towards[node]];
            node = towards[node];
        }
        node
    }
    for mut ends in rows() {
        let Some(&a) = ends.next() else { continue };
        for &b in ends {
            let (a, b) = (root(&mut towards, a), root(&mut towards, b));
            towards[a.max(b)] = a.min(b);
        }
    }
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let mut place = vec![usize::MAX; nodes];
    let mut first = 0;
    for (joint, size) in sizes.iter().enumerate() {
        let node = (*size > 0).then(|| gradients.nodes(first).iter().flatten().next()).flatten();
        first += size;
        // A joint that moves nothing has a group of its own.
        match node.map(|&node| root(&mut towards, node)) {
            Some(root) if place[root] != usize::MAX => groups[place[root]].push(joint),
            at => {
                at.into_iter().for_each(|root| place[root] = groups.len());
                groups.push(vec![joint]);
            }
        }
    }
    groups
}

impl SchurGroup {
    /// True where the system is sparse.
    pub fn is_sparse(&self) -> bool {
        self.factor.is_sparse()
    }

    /// Factorizes the matrix with these entries, by numbers among all equations. Returns false where it is singular.
    pub fn factor(
        &mut self,
        gradients: &Gradients,
        inert: &[bool],
        (masses, weights): (&Masses, &[f64]),
        entry: impl Fn(usize, usize) -> f64,
    ) -> bool {
        let SchurGroup { equations, factor, independent, .. } = self;
        let entry = |k: usize, l: usize| entry(equations[k], equations[l]);
        for (own, &k) in equations.iter().enumerate() {
            (self.inert[own], self.weights[own]) = (inert[k], weights[k]);
        }
        if let Some(independent) = independent {
            independent.find(equations, gradients, &self.inert, masses);
            let is_regular = factor.factor(&independent.idle, &self.raised, entry);
            if is_regular {
                independent.find_shares(factor, &self.inert, &self.weights, entry);
            }
            return is_regular;
        }
        self.raised.iter_mut().zip(&self.weights).for_each(|(raised, weight)| *raised = REGULARIZATION * *weight);
        factor.factor(&self.inert, &self.raised, entry)
    }

    /// Solves for the equations of the group in `all`. Where loads are shared, redundant equations do by least norm.
    pub fn solve(&mut self, all: &mut [f64], shares: bool) {
        let SchurGroup { equations, factor, independent, weights, x, scratch, .. } = self;
        x.iter_mut().zip(&*equations).for_each(|(x, &k)| *x = all[k]);
        if shares {
            if let Some(independent) = independent {
                x.iter_mut().zip(&independent.idle).filter(|(_, idle)| **idle).for_each(|(x, _)| *x = 0.0);
            }
            // The regularization leaves the fraction ε of the right-hand side; one iterative refinement leaves ε².
            scratch.copy_from_slice(x);
            factor.refine(x, scratch);
            if let Some(independent) = independent {
                independent.share(x, weights);
            }
        } else {
            factor.substitute(x);
        }
        x.iter().zip(&*equations).for_each(|(x, &k)| all[k] = *x);
    }
}
