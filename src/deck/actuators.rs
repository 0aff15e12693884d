//! `[[actuators]]`: joints of the kind "actuator" under a name of their own.

use schemars::JsonSchema;
use serde::Deserialize;

use super::joints::{Effort, JointMotion};
use super::links::End;
use super::part_damping::SpringDamping;
use super::words::{Maybe, Names, NumberOrTable, Numbers, Table};
use base::diagnostic::Diagnostic;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A link between two points whose length is driven: a hydraulic cylinder, a spindle. It takes all keys of a joint but `kind`; joints.csv has its
/// coordinate, which is the change of its length, and its force.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Actuator {
    /// Name, for messages, results and `[[expect]]`.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// The first end.
    #[schemars(required)]
    pub from: Maybe<Table<End>>,
    /// The second end, at another place.
    #[schemars(required)]
    pub to: Maybe<Table<End>>,
    /// Prescribes the change of its length since t = 0; joints.csv has the force and the power.
    pub motion: Maybe<Table<JointMotion>>,
    /// Instead of `motion`, a force that pushes the ends apart.
    pub effort: Maybe<Table<Effort>>,
    /// Force per length of a spring along it, 0 or more. Default: 0.
    pub stiffness: Maybe<f64>,
    /// Force per velocity of a damper along it, 0 or more, or `{ beta, viscous }`. Default: 0, and beta of `[damping]`.
    pub damping: Maybe<NumberOrTable<Table<SpringDamping>>>,
    /// The least and the largest change of its length, between stops; they hold 0.
    pub limits: Maybe<Numbers<2>>,
    /// Force per length of the stops, above 0. Required with `limits`.
    pub limit_stiffness: Maybe<f64>,
    /// Dry friction: slip force, 0 or more. Default: 0.
    pub friction_force: Maybe<f64>,
    /// Names of the stages in which it acts. Default: all.
    pub stages: Maybe<Names>,
}

/// Moves actuators to the joints, whose reader reads them.
pub(super) fn move_to_joints(root: &mut DeTable) -> Vec<Diagnostic> {
    let mut problems = Vec::new();
    let is_table = |item: &Spanned<DeValue>| matches!(item.get_ref(), DeValue::Table(_));
    let tables = |value: &Spanned<DeValue>| value.get_ref().as_array().is_some_and(|list| list.iter().all(is_table));
    if !root.get("actuators").is_some_and(tables) || !root.get("joints").is_none_or(tables) {
        return problems;
    }
    let Some(actuators) = root.remove("actuators") else { return problems };
    let place = actuators.span();
    let DeValue::Array(list) = actuators.into_inner() else { return problems };
    let mut all: Vec<Spanned<DeValue>> = match root.remove("joints").map(Spanned::into_inner) {
        Some(DeValue::Array(joints)) => joints.into_iter().collect(),
        _ => Vec::new(),
    };
    for mut actuator in list {
        let place = actuator.span();
        if let DeValue::Table(table) = actuator.get_mut() {
            if let Some(kind) = table.remove("kind") {
                let problem = Diagnostic::error("an actuator has no `kind`").at(&kind.span());
                problems.push(problem.hint("remove it, or write [[joints]] for a joint of another kind"));
            }
            let kind = DeValue::String("actuator".into());
            table.insert(Spanned::new(place.clone(), "kind".into()), Spanned::new(place, kind));
        }
        all.push(actuator);
    }
    let joints = DeValue::Array(all.into_iter().collect());
    root.insert(Spanned::new(place.clone(), "joints".into()), Spanned::new(place, joints));
    problems
}
