//! The ends of links and joints: a point, a place on a body or a place on the ground.

use crate::places::nodes::Nodes;
use crate::report::{Owner, Report};
use crate::scene::Scene;
use crate::values::{keys, vec3};
use base::diagnostic::Diagnostic;
use base::math::Vec3;
use deck::links as words;
use deck::words::{Maybe, Table};

/// An end as the deck has it.
pub struct EndTable<'b, 'd> {
    /// The link or joint that ends here.
    pub owner: &'b Owner<'d>,
    /// The key of the end, `from` or `to`.
    pub key: &'b str,
    /// The table of the end.
    pub end: &'d Maybe<Table<words::End>>,
    /// The label of a new node.
    pub label: String,
    /// True where the element at this end acts on rotations too.
    pub rotations: bool,
    /// The place on a body where the deck says nothing; `None`: its centre.
    pub default: Option<Vec3>,
}

impl<'d> EndTable<'_, 'd> {
    /// The node at the end, connected: a point's own, a body's, or a new one on a body or on the ground.
    pub fn node(self, scene: &Scene<'d>, nodes: &mut Nodes, report: &mut Report<'d>) -> Option<usize> {
        let end = report.require_nodes(self.owner, self.key, self.end)?;
        let node = match (&end.node, &end.body, &end.ground) {
            (Some(point), None, None) => {
                report.reject_unused("an end on a point", &keys!(end; point));
                scene.names.point("node", point, &scene.parts, report)?
            }
            (None, Some(body), None) => {
                let master = scene.names.body_node(scene.names.body(body, report)?);
                match &end.point {
                    Some(point) if vec3(point) != nodes.x(master) => {
                        nodes.add_dependent(self.label, vec3(point), master, &point.span)
                    }
                    _ if report.is_spoiled(&end.span, "point") => return None,
                    None => match self.default.filter(|place| *place != nodes.x(master)) {
                        Some(place) => nodes.add_dependent(self.label, place, master, &end.span),
                        None => master,
                    },
                    Some(_) => master,
                }
            }
            (None, None, Some(ground)) => {
                report.reject_unused("an end on the ground", &keys!(end; point));
                let node = nodes.add(self.label, false, vec3(ground));
                (0..6).for_each(|dof| nodes.restrain(node, dof, None));
                node
            }
            (None, None, None) if report.is_any_spoiled(&end.span) => return None,
            _ => {
                let message =
                    format!("`{}` of {} must lie on one of a node, a body and the ground", self.key, self.owner.what);
                let hint = "{ node = \"name\" }, { body = \"name\", point = [x, y, z] } or { ground = [x, y, z] }";
                report.push(Diagnostic::error(message).at(&end.span).hint("say which").hint(hint));
                return None;
            }
        };
        nodes.connect(node, self.rotations);
        Some(node)
    }
}
