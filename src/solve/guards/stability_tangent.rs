//! The tangent at an equilibrium, and the detection of instability between two equilibria by its eigenvalues.

use crate::context::Context;
use crate::guards::mode::Mode;
use crate::linear_system::LinearSystem;
use crate::system::TangentWeights;
use crate::system::{DofMap, Forces, Loading, System};
use crate::tolerances::stability_tangent::{BISECTIONS, ROUNDING, SCANS, TURNS};
use crate::warning::Instability;
use base::math::rotation;
use mechanics::elements::Moduli;
use mechanics::state::{Configuration, Node};
use model::DIRECTIONS;

/// Statics: no rates, no masses.
pub const WEIGHTS: TangentWeights =
    TangentWeights { stiffness: true, rate: 0.0, acceleration: 0.0, turning: None, moduli: Moduli::Algorithmic };

/// The property of a tangent that shows instability.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Criterion {
    /// Loads have a potential: the tangent is symmetric, and its negative eigenvalues count.
    Eigenvalues,
    /// For follower loads, moments about axes fixed in space, and slipping friction: a negative determinant shows a growing motion.
    Determinant,
    /// As for `Determinant`, but only the symmetric part can be stored: a negative eigenvalue may show a growing motion.
    SymmetricPart,
}

/// A tangent to be formed: of the plane of motion, or out of it.
pub struct Tangent<'t> {
    pub system: &'t System,
    pub dofs: &'t DofMap,
    pub matrix: &'t mut LinearSystem,
    pub forces: &'t mut Forces,
    /// Places on the diagonal with the stiffness of supports that are added there.
    pub springs: &'t [(usize, f64)],
    pub criterion: Criterion,
}

/// The two ends of a step: its configurations, loads and times.
pub struct Ends<'s> {
    pub configurations: [Configuration<'s>; 2],
    pub loads: [&'s Loading; 2],
    pub times: [f64; 2],
}

impl Ends<'_> {
    /// The largest turn of a node in the step, in radians.
    fn largest_turn(&self) -> f64 {
        let [start, end] = self.configurations.each_ref().map(|ends| ends.nodes);
        let turn = |(a, b): (&Node, &Node)| rotation::log(&(b.rotation * a.rotation.conjugate())).norm();
        start.iter().zip(end).map(turn).fold(0.0, f64::max)
    }
}

impl Tangent<'_> {
    /// Writes the tangent into the matrix.
    pub fn form(&mut self, now: &Configuration, loads: &Loading) {
        self.form_with(now, loads, WEIGHTS);
    }

    fn form_with(&mut self, now: &Configuration, loads: &Loading, weights: TangentWeights) {
        self.system.residual(now, loads, self.forces);
        let LinearSystem { solver, assembly, .. } = &mut *self.matrix;
        assembly.tangent(self.system, now, loads, self.forces, weights, solver);
        for &(slot, stiffness) in self.springs {
            solver.values()[slot] += stiffness;
        }
    }

    /// The number of unstable modes in the matrix; `None` if it is singular.
    pub fn unstable_modes(&mut self) -> Option<usize> {
        self.matrix.solver.factor().ok().map(|()| self.count())
    }

    /// The number of unstable modes in the matrix factorized last. Each multiplier adds one negative eigenvalue.
    pub fn count(&self) -> usize {
        let (solver, multipliers) = (&self.matrix.solver, self.system.multipliers());
        match self.criterion {
            Criterion::Determinant => usize::from(solver.is_determinant_negative() == multipliers.is_multiple_of(2)),
            _ => solver.negative_eigenvalues().saturating_sub(multipliers),
        }
    }

    /// The criterion of stability between the ends of a step with a possibly unsymmetric tangent.
    pub fn criterion_between(&mut self, ends: &Ends) -> Criterion {
        if self.matrix.solver.is_symmetric() {
            return Criterion::SymmetricPart;
        }
        let unsymmetric = (0..2).any(|i| {
            self.form(&ends.configurations[i], ends.loads[i]);
            self.matrix.solver.has_unsymmetric_values()
        });
        if unsymmetric { Criterion::Determinant } else { Criterion::Eigenvalues }
    }

    /// The number of unstable modes at the end of a step; `None` where the tangent is singular there.
    pub fn unstable_modes_at_end(&mut self, ends: &Ends) -> Option<usize> {
        self.form(&ends.configurations[1], ends.loads[1]);
        self.unstable_modes()
    }

    /// True where the end of a step would be stable, were its material elastic from there on.
    pub fn is_stable_with_elastic_moduli(&mut self, ends: &Ends) -> bool {
        self.form_with(&ends.configurations[1], ends.loads[1], TangentWeights { moduli: Moduli::Elastic, ..WEIGHTS });
        self.unstable_modes() == Some(0)
    }

    /// True where the start of a step is stable and its end is not, by more than rounding.
    pub fn turns_unstable(&mut self, ends: &Ends) -> bool {
        self.form(&ends.configurations[0], ends.loads[0]);
        if self.unstable_modes() != Some(0) {
            return false;
        }
        self.form(&ends.configurations[1], ends.loads[1]);
        self.add_rounding();
        self.unstable_modes().is_some_and(|modes| modes > 0)
    }

    /// The first instability in the step; `None` where the tangents between its ends show none.
    pub fn locate(&mut self, cx: &Context, ends: &Ends) -> Option<Instability> {
        let [begin, end] = [0, 1].map(|i| {
            self.form(&ends.configurations[i], ends.loads[i]);
            self.matrix.solver.values().to_vec()
        });
        let combine = |tangent: &mut Self, theta: f64| {
            let values = tangent.matrix.solver.values().iter_mut();
            values.zip(&begin).zip(&end).for_each(|((k, k0), k1)| *k = k0 + theta * (k1 - k0));
        };
        let unstable_at = |tangent: &mut Self, theta: f64| {
            combine(tangent, theta);
            tangent.unstable_modes()
        };
        let points = if self.criterion == Criterion::Determinant { SCANS } else { 1 };
        let mut scanned = (0..points).map(|k| 1.0 - k as f64 / points as f64);
        let (mut unstable, modes) = scanned.find_map(|theta| {
            let modes = unstable_at(self, theta).filter(|modes| *modes > 0)?;
            combine(self, theta);
            self.add_rounding();
            (self.unstable_modes() != Some(0)).then_some((theta, modes))
        })?;
        if unstable < 1.0 && self.criterion == Criterion::Determinant && ends.largest_turn() > TURNS {
            return None;
        }
        let mut stable = 0.0;
        let already = unstable_at(self, 0.0).is_some_and(|modes| modes > 0);
        if already {
            unstable = 0.0;
        } else {
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (stable + unstable);
                match unstable_at(self, middle) {
                    Some(0) => stable = middle,
                    _ => unstable = middle,
                }
            }
        }
        unstable_at(self, unstable);
        let mode = Mode::softest(&mut self.matrix.solver, self.dofs, cx.length);
        let film = |node: usize| {
            let part = cx.model.parts.iter().find(|part| part.folds_at(node, &cx.model.nodes))?;
            Some(part.name().to_owned())
        };
        let (label, direction, film) = match mode.and_then(|mode| mode.largest(self.dofs)) {
            Some((node, dof)) => (cx.model.nodes[node].label.clone(), DIRECTIONS[dof], film(node)),
            None => (String::new(), "", None),
        };
        let [from, to] = ends.times;
        let time = from + unstable * (to - from);
        let certain = self.criterion != Criterion::SymmetricPart;
        Some(Instability { time, already, certain, modes, seen: to, label, direction, film: film.unwrap_or_default() })
    }

    /// Adds possible rounding errors to the diagonal.
    fn add_rounding(&mut self) {
        let solver = &mut self.matrix.solver;
        for row in 0..self.dofs.nodal_dofs().len() {
            if let Some(slot) = solver.slot(row, row) {
                let value = &mut solver.values()[slot];
                *value += ROUNDING * value.abs();
            }
        }
    }
}
