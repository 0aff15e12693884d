//! The stability of plane equilibria against motion out of their plane, which a plane analysis omits.

use crate::context::Context;
use crate::guards::mechanism;
use crate::guards::stability_tangent::{Criterion, Ends, Tangent, WEIGHTS};
use crate::linear_system::LinearSystem;
use crate::plan::Sideways;
use crate::step::trial::TrialMotion;
use crate::system::{DofMap, Forces, Loading, System};
use crate::tolerances::out_of_plane::MOST_HELD;
use crate::warning::{Remark, Warning};
use crate::workspace::Workspace;
use base::math::Vec6;
use base::snapshot::keep;
use linear::TooLarge;
use mechanics::state::{Configuration, Node, State};
use model::DIRECTIONS;

/// The tangent of the motion out of the plane.
pub struct OutOfPlane {
    system: System,
    dofs: DofMap,
    matrix: LinearSystem,
    forces: Forces,
    criterion: Criterion,
    /// Springs on parts that are free to turn about their own axes: the slot on the diagonal and the stiffness. Such a turn strains
    /// nothing, so the springs do not change the energy of other motions.
    springs: Vec<(usize, f64)>,
    /// True once the tangent at t = 0 has been searched for such motions.
    searched: bool,
    /// History variables, of points that a plane motion has fewer of: at the start of the step, and at its end.
    history: [Vec<f64>; 2],
}

keep!(OutOfPlane { matrix, forces, springs, searched, history } without { system, dofs, criterion });

impl OutOfPlane {
    /// The motion out of the plane; `None` where nothing is left out.
    ///
    /// # Errors
    /// There is no memory for its matrix.
    pub fn new(cx: &Context) -> Result<Option<OutOfPlane>, TooLarge> {
        let sideways = Sideways::new(cx.model, cx.system, cx.plan)?;
        Ok(sideways.map(|Sideways { system, dofs, solver, assembly }| OutOfPlane {
            forces: Forces::new(&system, cx.model.nodes.len()),
            criterion: match system.has_potential(None) {
                true => Criterion::Eigenvalues,
                false => Criterion::Determinant,
            },
            springs: Vec::with_capacity(MOST_HELD),
            searched: false,
            history: [vec![0.0; system.history], vec![0.0; system.history]],
            system,
            dofs,
            matrix: LinearSystem::new(solver, assembly),
        }))
    }

    /// Judges the equilibrium after an accepted step from the time `from`; returns false if the check ends with it.
    pub fn check(&mut self, cx: &Context, ws: &mut Workspace, state: &State, from: f64) -> bool {
        let Workspace { loads, end: TrialMotion { nodes: start, .. }, warnings, .. } = ws;
        if !std::mem::replace(&mut self.searched, true) {
            let held = self.hold(cx, start, &loads.start);
            match held {
                Ok(places) if places.is_empty() => {}
                Ok(places) => warnings.remark(Remark::JudgedAsHeld { places }),
                Err(place) => {
                    warnings.remark(Remark::NotHeld { place });
                    return false;
                }
            }
        }
        let OutOfPlane { system, dofs, matrix, forces, criterion, springs, history: [old, new], .. } = self;
        let mut tangent = Tangent { system, dofs, matrix, forces, springs, criterion: *criterion };
        let end = Configuration { nodes: &state.nodes, history: old, dt: state.time - from, previous: None };
        tangent.form(&end, &loads.end);
        let stable = tangent.unstable_modes() == Some(0);
        if !stable {
            let start = Configuration { nodes: start, history: old, dt: 0.0, previous: None };
            let ends =
                Ends { configurations: [start, end], loads: [&loads.start, &loads.end], times: [from, state.time] };
            if let Some(instability) = tangent.locate(cx, &ends) {
                warnings.add(Warning::UnstableOutOfPlane(instability));
                return false;
            }
        }
        if system.history > 0 {
            system.update_history(&end, 1.0, new, cx.plan.threads);
            std::mem::swap(old, new);
        }
        true
    }

    /// Restrains parts that are free out of the plane at t = 0 by springs. Returns where.
    ///
    /// # Errors
    /// A node that is free to leave the plane: a structure without restraint out of its plane is meant to be plane.
    fn hold(
        &mut self,
        cx: &Context,
        start: &[Node],
        loads: &Loading,
    ) -> Result<Vec<(String, &'static str)>, (String, &'static str)> {
        let name = |(node, dof): (usize, usize)| (cx.model.nodes[node].label.clone(), DIRECTIONS[dof]);
        let OutOfPlane { system, dofs, matrix, forces, springs, history: [history, _], .. } = self;
        let now = Configuration { nodes: start, history, dt: 0.0, previous: None };
        if let Some(place) = free_translation(system, dofs, &now, cx.length) {
            return Err(name(place));
        }
        let mut places = Vec::new();
        loop {
            let mut tangent = Tangent { system, dofs, matrix, forces, springs, criterion: Criterion::Eigenvalues };
            tangent.form(&now, loads);
            let stiffness = largest_rotational_stiffness(dofs, tangent.matrix);
            let solver = &mut tangent.matrix.solver;
            let free = match solver.factor() {
                Err(singular) => dofs.nodal_dofs().get(singular.row).copied(),
                Ok(()) => mechanism::find(system, dofs, solver, &now, (WEIGHTS, None), cx.length),
            };
            let Some((node, dof)) = free else { return Ok(places) };
            let slot = dofs.row(node, dof).and_then(|row| solver.slot(row, row));
            match slot {
                Some(slot) if dof >= 3 && places.len() < MOST_HELD && stiffness > 0.0 => {
                    springs.push((slot, stiffness));
                    places.push(name((node, dof)));
                }
                _ => return Err(name((node, dof))),
            }
        }
    }
}

/// The largest entry on the diagonal that belongs to a rotation.
fn largest_rotational_stiffness(dofs: &DofMap, matrix: &mut LinearSystem) -> f64 {
    let mut largest: f64 = 0.0;
    for (row, _) in dofs.nodal_dofs().iter().enumerate().filter(|(_, (_, dof))| *dof >= 3) {
        if let Some(slot) = matrix.solver.slot(row, row) {
            largest = largest.max(matrix.solver.values()[slot].abs());
        }
    }
    largest
}

/// A node that moves if all nodes leave the plane by the same distance, as far as supports allow; `None` if this strains an element.
fn free_translation(system: &System, dofs: &DofMap, now: &Configuration, length: f64) -> Option<(usize, usize)> {
    let &place = dofs.nodal_dofs().iter().find(|(_, dof)| *dof < 3)?;
    let mut motions = vec![Vec6::zeros(); now.nodes.len()];
    dofs.nodal_dofs().iter().filter(|(_, dof)| *dof < 3).for_each(|&(node, dof)| motions[node][dof] = 1.0);
    system.project(now.nodes, &mut motions);
    (!mechanism::strains_elements(system, now, WEIGHTS, &motions, length)).then_some(place)
}
