//! Requirements of explicit schemes on a scene: masses, and inertia at every unknown.

use super::Plan;
use super::dof_status::DofStatus;
use crate::system::System;
use crate::system::constraint_schur::ConstraintSchur;
use crate::system::masses::Masses;
use crate::tolerances::mass_scaling::MOST;
use base::diagnostic::Diagnostic;
use mechanics::integrators::Stepping;
use model::{DIRECTIONS, Model};

impl Plan {
    /// Block-diagonal masses, if each moving node is a rigid body.
    pub fn masses(&self, system: &System) -> Option<Masses> {
        Masses::new(system, &self.dofs)
    }

    /// The matrix of an explicit step in words.
    pub(super) fn explain_masses(&self, system: &System) -> Vec<String> {
        let Some(masses) = self.masses(system) else {
            return vec![
                "mass matrix (and joints), factorized at every evaluation: it couples several nodes".to_string(),
            ];
        };
        match (system.multipliers(), ConstraintSchur::new(system, &masses, self.has_redundant_constraints())) {
            (0, _) => vec!["block-diagonal masses: nothing is factorized".to_string()],
            (rows, Some(schur)) => {
                let kind = if schur.is_sparse() { "sparse" } else { "dense" };
                vec![format!(
                    "block-diagonal masses; a {kind} system of the {rows} constraint equations of joints at every evaluation"
                )]
            }
            (_, None) => vec!["mass matrix and joints, factorized at every evaluation".to_string()],
        }
    }

    /// An error for each unknown of an explicit scheme that has no mass, and so no equation of motion.
    pub fn massless(&self, model: &Model, system: &System) -> Vec<Diagnostic> {
        if !self.explicit {
            return Vec::new();
        }
        // The common number of gears has no mass and needs none: the joints drive it.
        let shared: Vec<usize> = system.joints.iter().filter_map(|joint| Some(joint.shared()?.node)).collect();
        let mut missing: Vec<(usize, usize)> = match self.masses(system) {
            Some(masses) => {
                masses.blocks.iter().filter_map(|block| block.massless().map(|dof| (block.node, dof))).collect()
            }
            None => {
                let has_mass = system.has_mass(model.nodes.len());
                self.dofs
                    .nodal_dofs()
                    .iter()
                    .filter(|(node, dof)| !has_mass[*node][usize::from(*dof > 2)])
                    .copied()
                    .collect()
            }
        };
        missing.retain(|(node, _)| !shared.contains(node));
        let scheme = model.solution.scheme.word();
        let error = |&(node, dof): &(usize, usize)| {
            let (label, direction) = (&model.nodes[node].label, DIRECTIONS[dof]);
            let message = format!(
                "`{label}` has no mass in direction {direction}: \"{scheme}\" finds accelerations with masses alone"
            );
            let hint = match dof {
                0..3 => "give it a mass, its parts a density, or take an implicit scheme",
                _ => {
                    "give it inertia (rotary_inertia of beams, inertia of bodies and masses), or take an implicit scheme"
                }
            };
            placed(Diagnostic::error(message).hint(hint), model.nodes[node].place)
        };
        let mut errors: Vec<Diagnostic> = missing.iter().take(MOST).map(error).collect();
        if missing.len() > MOST {
            let message = format!("{} more directions have no mass either", missing.len() - MOST);
            errors.push(Diagnostic::error(message).hint("give them mass likewise"));
        }
        errors
    }

    /// An error for each node with Runge-Kutta that follows its master in some rotations and has others free. The rotation vector of a step
    /// ties it to its master, not the rates at the stages, which would be of first order.
    pub fn partial_rotations(&self, model: &Model) -> Vec<Diagnostic> {
        if !matches!(model.solution.scheme.stepping(), Stepping::RungeKutta(_)) {
            return Vec::new();
        }
        let master = |node: usize| {
            model
                .constraints
                .dependents
                .iter()
                .find(|dependent| dependent.node == node)
                .map(|dependent| dependent.master)
        };
        let moves = |mut node: usize, dof: usize| {
            while let (DofStatus::Dependent, Some(next)) = (self.nodes[node][dof], master(node)) {
                node = next;
            }
            let driven = || {
                model
                    .constraints
                    .restraints
                    .iter()
                    .any(|restraint| (restraint.node, restraint.dof) == (node, dof) && restraint.motion.is_some())
            };
            self.nodes[node][dof] == DofStatus::Unknown || driven()
        };
        let half = model.constraints.dependents.iter().filter(|dependent| {
            (3..6).any(|dof| self.nodes[dependent.node][dof] == DofStatus::Unknown)
                && (3..6).any(|dof| dependent.dofs[dof] && moves(dependent.master, dof))
        });
        let error = |dependent: &model::DependentNode| {
            let [node, master] = [dependent.node, dependent.master].map(|node| &model.nodes[node].label);
            let message = format!(
                "`{node}` turns with `{master}` about some axes only, which \"{}\" does not follow",
                model.solution.scheme.word()
            );
            placed(Diagnostic::error(message).hint("a joint of kind \"revolute\", or another scheme"), dependent.place)
        };
        half.take(MOST).map(error).collect()
    }
}

fn placed(error: Diagnostic, place: Option<[usize; 2]>) -> Diagnostic {
    match place {
        Some([start, end]) => error.at(&(start..end)),
        None => error,
    }
}
