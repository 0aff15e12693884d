//! Builds the blocks of like elements, and the joints from the model.

use super::group::{Group, GroupBlock};
use super::parts::{Setting, assembled};
use super::reduced;
use base::math::Vec3;
use mechanics::constraints::joint::{ConstraintEquation, Joint};
use mechanics::elements::superelement::SuperelementBlock;
use model::{self, Model, PartKind};

/// The blocks of like elements in the order of the parts. `plane` is the normal of a plane motion.
pub fn groups(model: &Model, x: &[Vec3], plane: Option<usize>) -> Vec<Group> {
    let setting = Setting { model, x, plane };
    let mut groups = Vec::new();
    let mut end = 0;
    for (place, part) in model.parts.iter().enumerate() {
        if model.reduction(place).is_some() {
            let first_here = model.reductions.iter().filter(|of| of.parts[0] == place);
            let made = first_here.filter_map(|of| reduced::element(model, of, x, model.damping.beta(&of.damping)));
            groups.extend(made.map(|element| Group {
                block: GroupBlock::Elements(Box::new(SuperelementBlock(element))),
                kind: PartKind::Superelement,
                part: place,
                first: 0,
                history: end..end,
                reduces: true,
            }));
            continue;
        }
        let elements = assembled(part).blocks(&setting).into_iter();
        let elements = elements.map(|(block, first)| (GroupBlock::Elements(block), first));
        let pairs = assembled(part).pairs(&setting).into_iter();
        let pairs = pairs.map(|(block, first)| (GroupBlock::Pairs(block), first));
        for (block, first) in elements.chain(pairs) {
            if !block.is_empty() {
                let history = end..end + block.history();
                end = history.end;
                groups.push(Group { block, kind: part.kind(), part: place, first, history, reduces: false });
            }
        }
    }
    groups
}

/// The joints with the constraint equations that a plane motion needs.
pub fn joints(model: &Model, x: &[Vec3], plane: Option<usize>) -> Vec<Joint> {
    let joint = |joint: &model::Joint| {
        let d = x[joint.ends[0]] - x[joint.ends[1]];
        let says = |row: &&ConstraintEquation| plane.is_none_or(|normal| row.in_plane(normal, &d) != Some(false));
        let drive = joint.coordinate.as_ref().and_then(|coordinate| coordinate.drive.as_ref());
        Joint {
            nodes: joint.ends,
            weight: joint.weight,
            more: joint.more.clone(),
            equations: joint.equations.iter().filter(says).copied().collect(),
            supports: joint.supports,
            drive: drive.map(|drive| drive.at(x)),
        }
    };
    model.constraints.joints.iter().map(joint).collect()
}
