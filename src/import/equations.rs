//! Equations between degrees of freedom that no joint says: `*EQUATION` and points on a line as `[[equations]]`.

use crate::bodies::DEGREES;
use crate::build::Build;
use crate::deck_text::{DeckTable, inline, list, number, quoted};
use crate::file_content::SupportLine;
use crate::tied_nodes::NodalEquation;
use base::math::{Mat3, Vec3};
use std::collections::BTreeMap;

/// An equation whose terms are along the axes of their nodes.
pub fn along_axes(build: &Build, line: usize, terms: &[(u64, usize, f64)]) -> NodalEquation {
    let mut all = Vec::new();
    for &(node, dof, factor) in terms {
        let axis = build.tied.axes.get(&node).map_or(Mat3::identity(), |axes| *axes).column(dof % 3) * factor;
        let first = dof - dof % 3;
        all.extend((0..3).filter(|i| axis[*i] != 0.0).map(|i| (node, first + i, axis[i])));
    }
    NodalEquation { line, terms: all }
}

/// Adds all equations.
pub fn equations(build: &mut Build) {
    for of in std::mem::take(&mut build.tied.equations) {
        add(build, &of);
    }
}

/// Adds an equation along global axes; terms of nodes that are held at rest are left out.
fn add(build: &mut Build, of: &NodalEquation) {
    let mut sum: BTreeMap<(u64, usize), f64> = BTreeMap::new();
    for &(node, dof, factor) in &of.terms {
        let node = build.mesh.kept(node);
        if !build.mesh.used.contains(&node) {
            if !is_at_rest(build, node, dof) && build.im.is_incomplete() {
                return;
            }
            if !is_at_rest(build, node, dof) {
                let why = format!("node {node} of this equation has no element: give it one, or hold it");
                build.im.refuse(of.line, &why);
                return;
            }
            continue;
        }
        *sum.entry((node, dof)).or_default() += factor;
    }
    sum.retain(|_, factor| *factor != 0.0);
    match sum.len() {
        0 => build.im.ignore(of.line, "this equation holds by itself"),
        1 => build.im.refuse(of.line, "this equation holds one degree of freedom: give it by *BOUNDARY"),
        _ => write(build, of.line, &sum),
    }
}

fn write(build: &mut Build, line: usize, sum: &BTreeMap<(u64, usize), f64>) {
    let name = build.deck.unique(&format!("equation_{line}"));
    let terms = sum.iter().map(|((node, dof), factor)| {
        let node = quoted(&format!("mesh.{node}"));
        inline(&[("node", node), ("dof", quoted(DEGREES[*dof])), ("factor", number(*factor))])
    });
    let table = DeckTable::new("equations", line).text("name", &name).value("terms", list(terms));
    build.deck.add(table);
}

/// True for a degree of freedom without elements that supports before or in the first step hold at zero.
fn is_at_rest(build: &Build, node: u64, dof: usize) -> bool {
    let steps = &build.im.steps;
    let holds = |line: &&SupportLine| {
        let nodes = build.mesh.node_ids(&build.im.scopes, &line.target);
        line.degrees.contains(&dof) && nodes.is_some_and(|nodes| nodes.contains(&node))
    };
    let lines = steps.before.supports.iter().chain(steps.list.iter().flat_map(|step| &step.supports));
    let held: Vec<&SupportLine> = lines.filter(holds).collect();
    !held.is_empty() && held.iter().all(|line| line.value == 0.0)
}

/// The equations of a point that follows others by their shares, along some directions of its translation or rotation.
fn shared(line: usize, point: u64, shares: &[(u64, f64)], (first, along): (usize, &[Vec3])) -> Vec<NodalEquation> {
    let of = |along: &Vec3| {
        let whole = [(point, 1.0)].into_iter().chain(shares.iter().map(|(node, share)| (*node, -share)));
        let terms = whole.flat_map(|(node, share)| (0..3).map(move |i| (node, first + i, share * along[i])));
        NodalEquation { line, terms: terms.filter(|term| term.2 != 0.0).collect() }
    };
    along.iter().map(of).collect()
}

/// `*MPC` LINEAR: a point between two others has their mean motion by its share of the way.
pub fn linear(build: &mut Build, line: usize, nodes: [u64; 3]) {
    let [point, a, b] = nodes;
    let x = |node: u64| build.mesh.x(node);
    let way = x(b) - x(a);
    let share = if way == Vec3::zeros() { 0.0 } else { (x(point) - x(a)).dot(&way) / way.norm_squared() };
    let shares = [(a, 1.0 - share), (b, share)];
    let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
    build.tied.equations.extend(shared(line, point, &shares, (0, &axes)));
    if nodes.iter().all(|node| build.rotating.contains(node)) {
        build.tied.equations.extend(shared(line, point, &shares, (3, &axes)));
    }
}

/// `*MPC` STRAIGHT and PLANE at small displacements: points stay on the line through the first two, or in the plane through the first three.
pub fn flat(build: &mut Build, line: usize, nodes: &[u64], corners: usize) {
    let (held, points) = nodes.split_at(corners);
    let x: Vec<Vec3> = held.iter().map(|node| build.mesh.x(*node)).collect();
    let [way, second] = [x[1] - x[0], x[corners - 1] - x[0]];
    let normal = if corners == 3 { way.cross(&second) } else { way.cross(&least_axis(&way)) };
    let Some(normal) = normal.try_normalize(0.0) else {
        return build.im.refuse(line, "the first nodes of this constraint lie in one place or on one line");
    };
    let normals = if corners == 3 { vec![normal] } else { vec![normal, way.cross(&normal).normalize()] };
    for &point in points {
        let r = build.mesh.x(point) - x[0];
        let shares = if corners == 3 {
            let area = way.cross(&second).dot(&normal);
            let [s, t] = [r.cross(&second).dot(&normal) / area, way.cross(&r).dot(&normal) / area];
            vec![(held[0], 1.0 - s - t), (held[1], s), (held[2], t)]
        } else {
            let s = r.dot(&way) / way.norm_squared();
            vec![(held[0], 1.0 - s), (held[1], s)]
        };
        build.tied.equations.extend(shared(line, point, &shares, (0, &normals)));
    }
}

/// The global axis that is farthest from a direction.
fn least_axis(x: &Vec3) -> Vec3 {
    let mut axis = Vec3::zeros();
    axis[x.map(f64::abs).imin()] = 1.0;
    axis
}
