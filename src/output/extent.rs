//! What a table has at one time of a scene: rows, names in them, and numbers that do not stay zero.

use crate::model::{AnalysisKind, Model};
use crate::plan::Plan;
use std::collections::HashMap;

/// A scene, and what of it moves.
pub struct Extent<'a> {
    /// The model.
    pub model: &'a Model,
    plan: &'a Plan,
    /// The axis normal to the plane in which everything moves.
    plane: Option<usize>,
    /// Of nodes that follow others.
    masters: HashMap<usize, usize>,
}

impl<'a> Extent<'a> {
    /// The scene of a model.
    pub fn new(model: &'a Model, plan: &'a Plan) -> Extent<'a> {
        let moves = |dof| (0..model.nodes.len()).any(|node| plan.is_unknown(node, dof));
        let stays = |normal: usize| !moves(normal) && !moves(3 + (normal + 1) % 3) && !moves(3 + (normal + 2) % 3);
        let masters = model.constraints.dependents.iter().map(|dependent| (dependent.node, dependent.master));
        Extent { model, plan, plane: (0..3).find(|&normal| stays(normal)), masters: masters.collect() }
    }

    /// Whether a degree of freedom lies in the plane of motion, if there is one.
    pub fn in_plane(&self, dof: usize) -> bool {
        self.plane.is_none_or(|normal| (dof < 3) == (dof % 3 != normal))
    }

    /// Components of a force, and of a moment, in the plane of motion or in space.
    pub fn components(&self) -> [usize; 2] {
        if self.plane.is_some() { [2, 1] } else { [3, 3] }
    }

    /// Whether each of the six degrees of freedom of a node moves, by itself, with a body or as prescribed.
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
            // A body that turns takes its nodes along wherever the scene goes.
            let follows = |dof: usize| turns || (dof < 3 && carried[dof]);
            (0..6).for_each(|dof| moving[dof] |= follows(dof) && self.in_plane(dof));
        }
        moving
    }

    /// Velocities and accelerations are columns of zeros in a static analysis.
    pub fn is_dynamic(&self) -> bool {
        self.model.analysis.kind == AnalysisKind::Dynamic
    }

    /// Numbers of the motion of a node that are not zero, of those that there are for each of its degrees of freedom.
    pub fn motion(&self, node: usize, of_each: [usize; 2]) -> usize {
        let rates = if self.is_dynamic() { of_each[1] } else { 0 };
        self.moving(node).iter().filter(|moves| **moves).count() * (of_each[0] + rates)
    }
}

/// What a table has at one time.
pub struct Rows {
    /// Number of rows.
    pub rows: usize,
    /// Letters of the names in all rows together.
    pub letters: usize,
    /// Numbers in all rows together that do not stay zero.
    pub numbers: usize,
}

impl Rows {
    /// Rows with a name each.
    pub fn named<'n>(names: impl Iterator<Item = &'n str>, numbers: usize) -> Rows {
        let (mut rows, mut letters) = (0, 0);
        names.for_each(|name| (rows, letters) = (rows + 1, letters + name.len()));
        Rows { rows, letters, numbers }
    }
}
