//! The matrices of small motions about a state, K − σ M factorised at a shift.

use super::fault::ModesFault;
use super::gyroscopic::Gyroscopic;
use super::linearized::Linearized;
use crate::system::assembly::Assembly;
use crate::system::{Forces, Loading, TangentWeights};
use crate::tolerances::pencil::{FORBIDDEN, ROUNDING};
use base::math::Vec6;
use linear::eigen::SymmetricOperator;
use linear::{Solver, Sparse};
use mechanics::elements::Moduli;
use mechanics::state::{Configuration, Node, State};

/// The weights K + rate·C + acceleration·M.
pub fn weights(rate: f64, acceleration: f64) -> TangentWeights {
    TangentWeights { stiffness: true, rate, acceleration, turning: None, moduli: Moduli::Elastic }
}

/// K − σ M with its factors, and M.
pub struct Pencil<'a> {
    /// The state.
    pub at: Linearized<'a>,
    /// Its nodes, at rest.
    pub nodes: Vec<Node>,
    /// The solver of the matrix.
    pub solver: &'a mut Solver,
    assembly: &'a mut Assembly,
    /// Forces in the state, with the multipliers of joints.
    pub forces: Forces,
    /// M over the unknowns of nodes.
    pub mass: Sparse,
    /// The shift σ.
    pub shift: f64,
    /// Number of unknowns of nodes.
    unknowns: usize,
    /// A right-hand side with the rows of multipliers.
    rhs: Vec<f64>,
    /// The part of a solution that is found already.
    first: Vec<f64>,
    /// Factorizations so far.
    pub factorizations: usize,
    /// Solutions so far.
    pub solves: usize,
}

impl<'a> Pencil<'a> {
    /// The matrices of a state, not factorised yet.
    pub fn new(at: Linearized<'a>, (solver, assembly): (&'a mut Solver, &'a mut Assembly)) -> Pencil<'a> {
        let nodes = at.nodes_at_rest();
        at.system.groups.iter().for_each(|group| group.block.hold_speeds(&at.state.nodes));
        let unknowns = at.unknowns();
        let mut forces = Forces::new(at.system, nodes.len());
        forces.multipliers.values.copy_from_slice(&at.state.multipliers);
        let now = Configuration { nodes: &nodes, history: &at.state.history, dt: 0.0, previous: None };
        at.system.residual(&now, at.loading, &mut forces);
        let of_mass = TangentWeights { stiffness: false, ..weights(0.0, 1.0) };
        assembly.unconstrained(at.system, &now, at.loading, &mut forces, of_mass, solver);
        let mass = solver.matrix(unknowns);
        Pencil {
            at,
            nodes,
            assembly,
            forces,
            mass,
            shift: 0.0,
            unknowns,
            rhs: vec![0.0; at.plan.dofs.unknowns()],
            first: vec![0.0; unknowns],
            factorizations: 0,
            solves: 0,
            solver,
        }
    }

    /// The pencil of another state, by the same solver.
    pub fn about<'s>(&'s mut self, state: &'s State) -> Pencil<'s> {
        Pencil::new(Linearized { state, ..self.at }, (&mut *self.solver, &mut *self.assembly))
    }

    /// Forms K + rate·C + acceleration·M with or without joints in the solver.
    fn form(&mut self, weights: TangentWeights, joints: bool) {
        let Pencil { at, nodes, forces, solver, assembly, .. } = self;
        let now = Configuration { nodes, history: &at.state.history, dt: 0.0, previous: None };
        if joints {
            assembly.tangent(at.system, &now, at.loading, forces, weights, solver);
        } else {
            assembly.unconstrained(at.system, &now, at.loading, forces, weights, solver);
        }
    }

    /// K + rate·C + acceleration·M over the unknowns of nodes, without the rows of joints.
    pub fn matrix(&mut self, weights: TangentWeights) -> Sparse {
        self.form(weights, false);
        self.solver.matrix(self.unknowns)
    }

    /// The rows and columns of the equations of joints, and the terms of their penalties at the unknowns of nodes, with the penalties for
    /// `K + s M`.
    pub fn joints_at(&mut self, s: f64) -> Sparse {
        let all = self.at.plan.dofs.unknowns();
        if all == self.unknowns {
            return Sparse::from_entries(all, |_| {});
        }
        self.form(weights(0.0, s), true);
        let with = self.solver.matrix(all);
        self.form(weights(0.0, s), false);
        let without = self.solver.matrix(all);
        Sparse::sum(&[(1.0, &with), (-1.0, &without)])
    }

    /// Passes the right-hand sides that close the gaps of joints under these motions, real and imaginary, to `visit`: number of the
    /// equation and entries.
    pub fn close_gaps(&mut self, motions: &[Vec<Vec6>; 2], mut visit: impl FnMut(usize, [f64; 2])) {
        let Pencil { at, nodes, forces, .. } = self;
        let multipliers = &mut forces.multipliers;
        let parts = [0, 1].map(|part| {
            at.system.gaps_of_motion(nodes, &motions[part], &mut multipliers.gaps);
            let mut tail = vec![0.0; multipliers.gaps.len()];
            multipliers.write_rhs(&mut tail);
            tail
        });
        (0..multipliers.gaps.len()).for_each(|k| visit(k, [parts[0][k], parts[1][k]]));
    }

    /// Factorises K − σ M. Returns the number of eigenvalues below σ.
    ///
    /// # Errors
    /// Row of a vanishing pivot; arbitrary after a signal, which [`Pencil::singular`] distinguishes.
    pub fn factor(&mut self, shift: f64) -> Result<usize, usize> {
        self.shift = shift;
        self.form(weights(0.0, -shift), true);
        self.factorizations += 1;
        match self.solver.factor_unless(&|| self.at.is_stopped()) {
            Ok(true) => Ok(self.negative()),
            Ok(false) => Err(0),
            Err(singular) => Err(singular.row),
        }
    }

    /// Counts the eigenvalues below `s`, which lies above some of them, by factors of K − sM instead of the factors at the shift.
    ///
    /// # Errors
    /// The row of a pivot that vanishes.
    pub fn count_below(&mut self, s: f64) -> Result<usize, usize> {
        self.form(weights(0.0, -s), true);
        self.factorizations += 1;
        self.solver.factor_indefinite().map_err(|singular| singular.row)?;
        Ok(self.negative())
    }

    /// The number of negative eigenvalues of the matrix factorised last, without those that joints make.
    fn negative(&self) -> usize {
        self.solver.negative_eigenvalues().saturating_sub(self.forces.multipliers.gaps.len())
    }

    /// Solves for the motion that a force on the unknowns of nodes causes, in place.
    pub fn solve(&mut self, b: &mut [f64]) {
        let multipliers = self.forces.multipliers.gaps.len();
        self.solves += 1;
        if multipliers == 0 {
            return self.solver.solve(b);
        }
        let Pencil { at, nodes, solver, forces, unknowns, rhs, first, .. } = self;
        rhs[..*unknowns].copy_from_slice(b);
        rhs[*unknowns..].fill(0.0);
        solver.solve(rhs);
        first.copy_from_slice(&rhs[..*unknowns]);
        // Redundant equations are regularized, which keeps a small part of each gap; a second solution removes it.
        let motions = at.motions(nodes, first);
        at.system.gaps_of_motion(nodes, &motions, &mut forces.multipliers.gaps);
        rhs[..*unknowns].fill(0.0);
        forces.multipliers.write_rhs(&mut rhs[*unknowns..]);
        solver.solve(rhs);
        self.solves += 1;
        for ((b, first), more) in b.iter_mut().zip(first).zip(rhs) {
            *b = *first + *more;
        }
    }

    /// Adds a weight times K of the state, with the stresses of other node positions and with other loads and multipliers. The sum starts
    /// empty and has the entries of the solver without the rows of joints.
    pub fn add_stressed(
        &mut self,
        weight: f64,
        (nodes, loading, multipliers): (&[Node], &Loading, &[f64]),
        sum: &mut Vec<f64>,
    ) {
        let Pencil { at, forces, solver, assembly, .. } = self;
        forces.multipliers.values.copy_from_slice(multipliers);
        let now = Configuration { nodes, history: &at.state.history, dt: 0.0, previous: None };
        at.system.residual(&now, loading, forces);
        let now = Configuration { nodes: &self.nodes, previous: Some(nodes), ..now };
        assembly.stressed(at.system, &now, loading, forces, weights(0.0, 0.0), solver);
        let values = solver.values();
        sum.resize(values.len(), 0.0);
        sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * *value);
        // The state itself again.
        self.forces.multipliers.values.copy_from_slice(&self.at.state.multipliers);
        let now = Configuration { nodes: &self.nodes, history: &self.at.state.history, dt: 0.0, previous: None };
        self.at.system.residual(&now, self.at.loading, &mut self.forces);
    }

    /// The sum of matrices that [`Pencil::add_stressed`] has formed, over the unknowns of nodes.
    pub fn summed(&mut self, sum: &[f64]) -> Sparse {
        self.solver.values().copy_from_slice(sum);
        // Rows are summed by ascending columns, whatever the order of elimination.
        Sparse::sum(&[(1.0, &self.solver.matrix(self.unknowns))])
    }

    /// Factorises K + σ C + σ² M with the matrices of bodies that spin.
    ///
    /// # Errors
    /// The row of a pivot that vanishes.
    pub fn factor_quadratic(&mut self, shift: f64, gyroscopic: &Gyroscopic) -> Result<(), usize> {
        self.form(weights(shift, shift * shift), true);
        self.factorizations += 1;
        let solver = &mut self.solver;
        gyroscopic.entries(&mut |i, j, [rate, turn]| {
            if let Some(slot) = solver.slot(i, j) {
                solver.values()[slot] += shift * rate + turn;
            }
        });
        match self.solver.factor_unless(&|| self.at.is_stopped()) {
            Ok(true) => Ok(()),
            Ok(false) => Err(0),
            Err(singular) => Err(singular.row),
        }
    }

    /// Factorises K + λ K', with K' symmetric, where some of its eigenvalues are negative. Returns their number; `None` where it is singular.
    pub fn factor_along(&mut self, rate: &Sparse, lambda: f64) -> Option<usize> {
        self.form(weights(0.0, 0.0), true);
        self.factorizations += 1;
        for (i, j, value) in rate.entries().filter(|(i, j, _)| i <= j) {
            if let Some(slot) = self.solver.slot(i, j) {
                self.solver.values()[slot] += lambda * value;
            }
        }
        self.solver.factor_indefinite().ok()?;
        Some(self.negative())
    }

    /// Solves like [`Pencil::solve`] with some nodes moved by supports, which joints follow.
    pub fn follow(&mut self, b: &mut [f64], moved: &[Vec6]) {
        let Pencil { at, nodes, solver, forces, unknowns, rhs, .. } = self;
        let (at, multipliers, n) = (*at, &mut forces.multipliers, *unknowns);
        at.system.gaps_of_motion(nodes, moved, &mut multipliers.gaps);
        rhs[..n].copy_from_slice(b);
        b.fill(0.0);
        for _ in 0..3 {
            multipliers.write_rhs(&mut rhs[n..]);
            solver.solve(rhs);
            b.iter_mut().zip(&*rhs).for_each(|(sum, x)| *sum += x);
            if multipliers.gaps.is_empty() {
                break;
            }
            let mut motions = at.motions(nodes, b);
            motions.iter_mut().zip(moved).for_each(|(motion, moved)| *motion += moved);
            at.system.gaps_of_motion(nodes, &motions, &mut multipliers.gaps);
            rhs[..n].fill(0.0);
        }
        self.solves += 1;
    }

    /// Solves as [`Pencil::solve`] does for several forces.
    pub fn solve_all(&mut self, b: &mut [Vec<f64>]) {
        if self.forces.multipliers.gaps.is_empty() {
            self.solves += b.len();
            self.solver.solve_all(b);
        } else {
            b.iter_mut().for_each(|b| self.solve(b));
        }
    }

    /// Solves as [`Pencil::solve`] does, and returns the multipliers of joints besides.
    pub fn respond(&mut self, b: &mut [f64]) -> Vec<f64> {
        let Pencil { at, nodes, solver, forces, unknowns, rhs, .. } = self;
        let (at, multipliers, n) = (*at, &mut forces.multipliers, *unknowns);
        multipliers.values.fill(0.0);
        multipliers.gaps.fill(0.0);
        rhs[..n].copy_from_slice(b);
        let mut sum = vec![0.0; n];
        for _ in 0..3 {
            multipliers.write_rhs(&mut rhs[n..]);
            solver.solve(rhs);
            sum.iter_mut().zip(&*rhs).for_each(|(sum, x)| *sum += x);
            multipliers.add(&rhs[n..]);
            let motions = at.motions(nodes, &sum);
            at.system.gaps_of_motion(nodes, &motions, &mut multipliers.gaps);
            rhs[..n].fill(0.0);
            if multipliers.gaps.is_empty() {
                break;
            }
        }
        b.copy_from_slice(&sum);
        self.solves += 1;
        std::mem::replace(&mut self.forces.multipliers.values, self.at.state.multipliers.clone())
    }

    /// Moves the part of these forces that joints balance into their multipliers; returns the remaining motion.
    pub fn balance(&mut self, forces: &[f64]) -> Vec<f64> {
        let Pencil { solver, forces: Forces { multipliers, .. }, unknowns, rhs, .. } = self;
        rhs[..*unknowns].copy_from_slice(forces);
        rhs[*unknowns..].fill(0.0);
        multipliers.gaps.fill(0.0);
        solver.solve(rhs);
        self.solves += 1;
        multipliers.add(&rhs[*unknowns..]);
        rhs[..*unknowns].to_vec()
    }

    /// True if joints allow a motion, given as one or more parts of any size. Joint equations are regularized, so a forbidden motion still
    /// has a meaningless frequency.
    pub fn allows(&mut self, parts: &[&[f64]]) -> bool {
        let Pencil { at, nodes, forces, .. } = self;
        let gaps = &mut forces.multipliers.gaps;
        let (mut widest, mut largest) = (0.0f64, 0.0f64);
        for part in parts {
            let motions = at.motions(nodes, part);
            at.system.gaps_of_motion(nodes, &motions, gaps);
            widest = gaps.iter().fold(widest, |widest, gap| widest.max(gap.abs()));
            largest = motions.iter().fold(largest, |largest, motion| largest.max(motion.amax()));
        }
        largest > 0.0 && widest <= FORBIDDEN * largest
    }

    /// Smallest ratio of stiffness to mass of a degree of freedom; 1 if none has both. A ratio this far below the largest is rounding of a
    /// motion without resistance.
    pub fn least_ratio(&mut self) -> f64 {
        self.form(weights(0.0, 0.0), false);
        let mut ratios = vec![0.0; self.unknowns];
        for (row, ratio) in ratios.iter_mut().enumerate() {
            let mass: f64 = self.mass.row(row).filter(|(column, _)| *column == row).map(|(_, m)| m).sum();
            if let Some(slot) = self.solver.slot(row, row).filter(|_| mass > 0.0) {
                *ratio = self.solver.values()[slot] / mass;
            }
        }
        let largest = ratios.iter().copied().fold(0.0, f64::max);
        let least = ratios.into_iter().filter(|ratio| *ratio > ROUNDING * largest).fold(f64::INFINITY, f64::min);
        if least.is_finite() { least } else { 1.0 }
    }

    /// The fault of an iteration for so many modes that has not come to its end.
    pub fn not_converged(&self, wanted: usize) -> ModesFault {
        if self.at.is_stopped() { ModesFault::Stopped } else { ModesFault::NotConverged { wanted } }
    }

    /// Fault of a matrix that is singular at this row, or without factors after a signal.
    pub fn singular(&self, row: usize) -> ModesFault {
        if self.at.is_stopped() {
            return ModesFault::Stopped;
        }
        let (label, direction) = self.at.name(row);
        ModesFault::Singular { label, direction }
    }
}

impl SymmetricOperator for Pencil<'_> {
    fn dimension(&self) -> usize {
        self.unknowns
    }

    fn apply(&mut self, x: &[&[f64]]) -> Vec<Vec<f64>> {
        let mut images = self.mass.products(x);
        self.solve_all(&mut images);
        images
    }

    fn metric(&mut self, x: &[f64], y: &mut [f64]) {
        self.mass.multiply(x, y);
    }

    fn may_move(&mut self, x: &[f64]) -> bool {
        self.forces.multipliers.gaps.is_empty() || self.allows(&[x])
    }

    fn is_stopped(&self) -> bool {
        self.at.is_stopped()
    }
}
