//! Motion out of the plane, which plane analyses omit: a compressed structure may buckle there.

use super::Plan;
use crate::system::assembly::Assembly;
use crate::system::{DofMap, System};
use linear::{Factorization, Solver, TooLarge};
use model::Model;

/// The equations of the motion out of the plane. While the scene is plane they do not couple with those in the plane.
pub struct Sideways {
    /// The system with all directions.
    pub system: System,
    /// The unknowns out of the plane alone.
    pub dofs: DofMap,
    /// The solver for the matrix of these unknowns.
    pub solver: Solver,
    /// The assembly of that matrix and of its right-hand side.
    pub assembly: Assembly,
}

impl Sideways {
    /// The omitted equations; `None` if nothing deformable is omitted, or if joints exist, whose forces out of the plane are unknown.
    ///
    /// # Errors
    /// There is no memory for the solver.
    pub fn new(model: &Model, plane: &System, plan: &Plan) -> Result<Option<Sideways>, TooLarge> {
        if !deforms_in_plane(plane) || !plane.joints.is_empty() {
            return Ok(None);
        }
        let Ok(system) = System::in_space(model) else { return Ok(None) };
        let statuses = super::dof_status::classify(model, &system);
        let unknown = statuses.iter().enumerate().map(|(node, status)| {
            let left_out = |dof: usize| status[dof] == super::DofStatus::Unknown && !plan.is_unknown(node, dof);
            std::array::from_fn(left_out)
        });
        let dofs = DofMap::new(unknown, &[]);
        if dofs.unknowns() == 0 {
            return Ok(None);
        }
        let structure = super::structure(&system, &dofs);
        // Without a potential the tangent is unsymmetric, and its determinant decides stability.
        let kind = match system.has_potential(None) {
            true => Factorization::choose(&structure),
            false => Factorization::BlockLu,
        };
        let solver = Solver::new(&structure, kind, plan.threads)?;
        let assembly = Assembly::new(&system, &dofs, &solver, plan.threads);
        Ok(Some(Sideways { system, dofs, solver, assembly }))
    }
}

/// True where something deforms in a plane motion.
fn deforms_in_plane(system: &System) -> bool {
    system.plane.is_some() && system.groups.iter().any(|group| group.kind.is_deformable())
}
