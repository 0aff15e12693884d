//! The extent of a table at one time of a scene: its rows, the names in them, and the numbers that do not stay zero.

use model::{AnalysisKind, Model};
use solve::plan::Plan;
use std::collections::HashMap;

/// A scene, and its moving degrees of freedom.
pub struct Extent<'a> {
    /// The model.
    pub model: &'a Model,
    plan: &'a Plan,
    /// The axis normal to the plane of motion, 0 to 2; `None` for motion in space.
    plane: Option<usize>,
    /// The masters of the dependent nodes, by node.
    masters: HashMap<usize, usize>,
}

impl<'a> Extent<'a> {
    /// The scene of a model; its plan contains the moving degrees of freedom.
    pub fn new(model: &'a Model, plan: &'a Plan) -> Extent<'a> {
        let moves = |dof| (0..model.nodes.len()).any(|node| plan.is_unknown(node, dof));
        let stays = |normal: usize| !moves(normal) && !moves(3 + (normal + 1) % 3) && !moves(3 + (normal + 2) % 3);
        let masters = model.constraints.dependents.iter().map(|dependent| (dependent.node, dependent.master));
        Extent { model, plan, plane: (0..3).find(|&normal| stays(normal)), masters: masters.collect() }
    }

    /// Whether a degree of freedom, 0 to 5, lies in the plane of motion; true in space.
    pub fn in_plane(&self, dof: usize) -> bool {
        self.plane.is_none_or(|normal| (dof < 3) == (dof % 3 != normal))
    }

    /// The numbers of components of a force and of a moment that do not stay zero.
    pub fn components(&self) -> [usize; 2] {
        if self.plane.is_some() { [2, 1] } else { [3, 3] }
    }

    /// Whether each of the six degrees of freedom of a node moves: freely, with a body or as prescribed.
    pub fn moving(&self, node: usize) -> [bool; 6] {
        let of = |node: usize| -> [bool; 6] { std::array::from_fn(|dof| self.plan.is_unknown(node, dof)) };
        let mut moving = of(node);
        let restraints = &self.model.constraints.restraints;
        let first = restraints.partition_point(|restraint| restraint.node < node);
        let held = restraints[first..].iter().take_while(|restraint| restraint.node == node);
        held.filter(|restraint| restraint.motion.is_some()).for_each(|restraint| moving[restraint.dof] = true);
        if let Some(&master) = self.masters.get(&node) {
            let carried = of(master);
            let turns = carried[3..].contains(&true);
            // A body that turns displaces its nodes in all directions of the scene.
            let follows = |dof: usize| turns || (dof < 3 && carried[dof]);
            (0..6).for_each(|dof| moving[dof] |= follows(dof) && self.in_plane(dof));
        }
        moving
    }

    /// Whether inertia acts; in a static analysis velocities and accelerations are columns of zeros.
    pub fn is_dynamic(&self) -> bool {
        self.model.analysis.kind == AnalysisKind::Dynamic
    }

    /// The number of numbers on the motion of a node that do not stay zero. A degree of freedom has `of_each` of them: those of
    /// position, then those of rates.
    pub fn motion(&self, node: usize, of_each: [usize; 2]) -> usize {
        let rates = if self.is_dynamic() { of_each[1] } else { 0 };
        self.moving(node).iter().filter(|moves| **moves).count() * (of_each[0] + rates)
    }
}

/// The rows of a table at one time.
pub struct Rows {
    /// The number of rows.
    pub rows: usize,
    /// The number of letters of the names in all rows together.
    pub letters: usize,
    /// The number of numbers in all rows together that do not stay zero.
    pub numbers: usize,
}

impl Rows {
    /// One row for each of some names, with so many `numbers` in all of them together.
    pub fn named<'n>(names: impl Iterator<Item = &'n str>, numbers: usize) -> Rows {
        let (mut rows, mut letters) = (0, 0);
        names.for_each(|name| (rows, letters) = (rows + 1, letters + name.len()));
        Rows { rows, letters, numbers }
    }
}
