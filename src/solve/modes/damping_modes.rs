//! The modes that modal damping acts on: those of the drawn state without loads.

use super::fault::ModesFault;
use super::linearized::Linearized;
use super::modal::natural_pairs;
use super::pencil::Pencil;
use crate::plan::Plan;
use crate::system::modal_damping::{DampedMode, DampedModes};
use crate::system::{Excitation, Loading, Side, System};
use base::math::Vec6;
use mechanics::state::{Node, State, Work};
use model::{ModeExtent, Model};
use std::sync::atomic::AtomicBool;

/// Finds the damped modes of a scene; returns their number beside that of the deck.
///
/// # Errors
/// The reason why there are none.
pub fn find_damped(
    (model, system, plan): (&Model, &System, &Plan),
    excitation: &Excitation,
    stop: &AtomicBool,
) -> Result<[usize; 2], ModesFault> {
    let damping = system.modal_damping();
    let nodes: Vec<Node> = model.nodes.iter().map(|node| Node::at_rest(node.x)).collect();
    let state = State {
        time: model.analysis.begin,
        jerk: vec![Vec6::zeros(); nodes.len()],
        nodes,
        history: vec![0.0; system.history],
        reactions: vec![0.0; model.constraints.restraints.len()],
        multipliers: vec![0.0; system.multipliers()],
        algorithmic_accelerations: Vec::new(),
        work: Work::default(),
    };
    let mut loading = Loading::default();
    excitation.loading(model.analysis.begin, Side::After, &mut loading);
    let nothing = loading.plus(-1.0, &loading);
    let at = Linearized { model, system, plan, state: &state, loading: &nothing, factored: &nothing, stop };
    let (mut solver, mut assembly) = at.symmetric_solver()?;
    let mut pencil = Pencil::new(at, (&mut solver, &mut assembly));
    if pencil.mass.is_zero() {
        return Err(ModesFault::NoMass);
    }
    let wanted = damping.ratios.len();
    let pairs = natural_pairs(&mut pencil, ModeExtent::Count(wanted))?;
    let mode = |((square, shape), ratio): (&(f64, Vec<f64>), &f64)| {
        let mut momentum = vec![0.0; shape.len()];
        pencil.mass.multiply(shape, &mut momentum);
        DampedMode { rate: 2.0 * ratio * square.max(0.0).sqrt(), momentum }
    };
    let list: Vec<DampedMode> = pairs.iter().zip(&damping.ratios).map(mode).collect();
    let found = [list.len(), wanted];
    damping.set(DampedModes { dofs: plan.dofs.nodal_dofs().to_vec(), list });
    Ok(found)
}
