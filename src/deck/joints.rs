//! `[[joints]]`: constraints between two bodies or points.

use schemars::JsonSchema;
use serde::Deserialize;

use super::links::End;
use super::words::kinds::Kinds;
use super::words::{Maybe, Names, Table};
use crate::constraints::joints::kind::MakeJoint;
use crate::constraints::joints::{JOINTS, JointKind};

/// Two ends that may move against each other only as the kind of joint allows; Lagrange multipliers hold them.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// Name, for messages, results and `[[expect]]`.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// The first end.
    #[schemars(required)]
    pub from: Maybe<Table<End>>,
    /// The second end. Where it is on a body, its `point` may be left out: it then lies where `from` lies (not
    /// with "distance").
    #[schemars(required)]
    pub to: Maybe<Table<End>>,
    /// Names of the stages in which it is there; it joins its ends as it then finds them. Default: all.
    pub stages: Maybe<Names>,
}

impl Kinds for Joint {
    const CHOOSER: &'static str = "kind";
    const ABOUT: &'static str = "What the joint leaves free.";
    const REQUIRED: bool = true;
    type Make = MakeJoint;

    fn list() -> &'static [&'static JointKind] {
        JOINTS
    }
}
