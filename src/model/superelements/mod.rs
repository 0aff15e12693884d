//! `[[superelements]]`: matrices from files → parts between points.

pub mod files;
mod matrix_file;
mod order;
pub mod rigid_motion;

use super::data::{Part, PartIndex, PartKind, Superelement};
use super::own_damping;
use super::part_context::PartContext;
use super::places::axes::axes;
use super::places::nodes::Nodes;
use super::report::Owner;
use super::values::chosen;
use base::diagnostic::Span;
use base::math::{Mat3, Vec3};
use deck::superelements as words;
use deck::superelements::PointDofs;
use files::GivenMatrices;
use mechanics::elements::superelement::SuperelementData;
use nalgebra::DMatrix;
use rigid_motion::SuperelementMatrices;
use std::collections::HashSet;
use std::sync::Arc;

/// Reads `[[superelements]]`, with the matrices that have been read for them.
pub(super) fn superelements(matrices: &[Option<GivenMatrices>], cx: &mut PartContext) {
    for (index, table) in cx.deck.superelements.iter().enumerate() {
        let named = ("superelement", "superelements", index);
        let (name, owner) = cx.report.named(named, table.name.as_ref(), &table.span);
        let at = PartIndex { kind: PartKind::Superelement, index };
        cx.parts.begin(at);
        let given = matrices.get(index).and_then(Option::as_ref);
        let made = read(at, name, &owner, (table, given), cx);
        cx.parts.add(at, made.map(Part::from));
    }
}

fn read<'d>(
    at: PartIndex,
    name: String,
    owner: &Owner<'d>,
    (table, given): (&'d words::Superelement, Option<&GivenMatrices>),
    cx: &mut PartContext<'_, 'd>,
) -> Option<Superelement> {
    let damping = own_damping::of_part(&table.damping, cx.report);
    let axes = match &table.axes {
        Some(table) => axes(table, cx.report),
        None => Some(Mat3::identity()),
    };
    let place = cx.report.require(owner, "stiffness", &table.stiffness).map(|at| &at.span);
    let turns = chosen(&table.dofs) == PointDofs::All;
    let points = points(owner, table, turns, cx)?;
    cx.parts.entry_mut(at).nodes.clone_from(&points);
    let (given, place, axes) = (given?, place?, axes?);
    let rows = order::rows(owner, table, (turns, given.stiffness.nrows()), cx.report)?;
    let x: Vec<Vec3> = points.iter().map(|&node| cx.nodes.x(node)).collect();
    let ordered = |matrix: &DMatrix<f64>| rows.in_order(matrix, &axes, turns);
    let made = SuperelementMatrices {
        stiffness: ordered(&given.stiffness),
        mass: given.mass.as_ref().map(ordered),
        damping: given.damping.as_ref().map(ordered),
    };
    let found = rigid_motion::settle(made, &x, turns).map_err(|wrong| {
        let key = wrong.key;
        let spans: [(&str, &Option<base::diagnostic::At<String>>); 2] =
            [("mass", &table.mass), ("damping_matrix", &table.damping_matrix)];
        let own = spans.into_iter().find(|(of, _)| *of == key).and_then(|(_, at)| at.as_ref());
        let place = own.map_or(place, |at| &at.span);
        cx.report.error_with::<()>(place, format!("{}: {}", owner.what, wrong.message), wrong.hint);
    });
    let (made, mass, corrected) = found.ok()?;
    if let Some(part) = corrected {
        say_corrected(owner, place, part, cx);
    }
    let nodes = with_numbers(&name, points, rows.modes, cx.nodes);
    let interface = nodes.len() - rows.modes;
    let entries = |matrix: &DMatrix<f64>| Arc::from(matrix.as_slice());
    let matrices = SuperelementData {
        nodes,
        interface,
        turns,
        stiffness: entries(&made.stiffness),
        mass: made.mass.as_ref().map_or_else(|| Arc::from([]), entries),
        damping: made.damping.as_ref().map_or_else(|| Arc::from([]), entries),
        second_order: None,
    };
    Some(Superelement { name, matrices, mass, damping })
}

fn say_corrected(owner: &Owner, place: &Span, part: f64, cx: &mut PartContext) {
    let message = format!(
        "{}: a rigid motion exerts forces of {part:.0e} of the stiffness, as from rounded numbers; they are removed",
        owner.what
    );
    cx.report.warn(place, message, "write the matrices with all digits, such as 1.234567890123456e5");
}

/// The nodes of the points, which are connected.
fn points<'d>(
    owner: &Owner<'d>,
    table: &'d words::Superelement,
    turns: bool,
    cx: &mut PartContext<'_, 'd>,
) -> Option<Vec<usize>> {
    let list = cx.report.require_nodes(owner, "nodes", &table.nodes)?;
    let found: Vec<Option<usize>> =
        list.values.iter().map(|point| cx.names.point("nodes", point, &cx.parts, cx.report)).collect();
    found.iter().flatten().for_each(|&node| cx.nodes.connect(node, turns));
    let points = found.into_iter().collect::<Option<Vec<usize>>>()?;
    let mut seen = HashSet::new();
    if let Some(k) = (0..points.len()).find(|&k| !seen.insert(points[k])) {
        let again = &list.values[k];
        let message = format!("{} names `{}` twice", owner.what, again.value);
        return cx.report.error_with(&again.span, message, "name each point once, in the order of the matrices");
    }
    let x = |k: usize| cx.nodes.x(points[k]);
    let spans_plane = || {
        let arms = (1..points.len()).map(|k| x(k) - x(0));
        let longest = arms.clone().fold(Vec3::zeros(), |long, arm| if arm.norm() > long.norm() { arm } else { long });
        arms.map(|arm| arm.cross(&longest).norm()).fold(0.0, f64::max) > 1e-6 * longest.norm_squared()
    };
    if points.is_empty() || !turns && !spans_plane() {
        let message = format!("the points of {} do not tell how it turns", owner.what);
        let hint = "with `dofs` = \"translations\" name three points or more that do not lie on a line";
        return cx.report.error_with(&list.span, message, hint);
    }
    Some(points)
}

/// The nodes of the points, then one for each amplitude.
fn with_numbers(name: &str, mut points: Vec<usize>, modes: usize, nodes: &mut Nodes) -> Vec<usize> {
    let first = points[0];
    points.extend((1..=modes).map(|mode| {
        let node = nodes.add_number(format!("{name}, mode {mode}"), first);
        nodes.connect(node, false);
        node
    }));
    points
}
