//! Finds constraint equations of joints that are redundant at t = 0: a closed planar loop of revolute joints constrains
//! the motion out of the plane many times.

use crate::system::dependents;
use crate::system::{DofMap, System};
use crate::tolerances::redundant_constraints::{MOST, NEW, ROUNDING};
use base::math::{Vec3, Vec6};
use mechanics::constraints::joint::MOST_ENDS;
use mechanics::state::Node;
use model::Model;
use std::collections::BTreeSet;
use std::ops::Range;

/// The largest distance of a node from the center of all; 1 where they are at one place, to rounding.
fn size(nodes: &[Node]) -> f64 {
    let reach = nodes.iter().map(|node| node.x.amax()).fold(0.0, f64::max);
    let center: Vec3 = nodes.iter().map(|node| node.x).sum::<Vec3>() / nodes.len().max(1) as f64;
    let length = nodes.iter().map(|node| (node.x - center).norm()).fold(0.0, f64::max);
    if length > ROUNDING * reach { length } else { 1.0 }
}

/// Multipliers whose equations depend linearly on earlier ones; `None` if there are too many to search.
pub fn find(model: &Model, system: &System, dofs: &DofMap) -> Option<Vec<usize>> {
    let directions = dofs.nodal_dofs().len();
    let count = dofs.unknowns() - directions;
    let nodes: Vec<Node> = model.nodes.iter().map(|node| Node::at_rest(node.x)).collect();
    let independent_nodes = dependents::independent_nodes(&system.rigid_links, nodes.len());
    let projections = dependents::projections(&system.rigid_links, &nodes, &independent_nodes);
    // The size of the scene makes rotations comparable with translations.
    let length = size(&nodes);

    // Columns are the degrees of freedom of joints, numbered as they occur.
    let mut column = vec![None; directions];
    let mut columns = 0;
    let mut sparse: Vec<Vec<(usize, f64)>> = Vec::with_capacity(count);
    let mut joints: Vec<Range<usize>> = Vec::with_capacity(system.joints.len());
    let mut room = [Vec6::zeros(); MOST_ENDS];
    for joint in &system.joints {
        joints.push(sparse.len()..sparse.len() + joint.equations.len());
        for k in 0..joint.equations.len() {
            let mut entries = Vec::new();
            let mut add = |row: usize, value: f64| {
                let at = *column[row].get_or_insert_with(|| {
                    columns += 1;
                    columns - 1
                });
                entries.push((at, value));
            };
            if let Some(drive) = joint.shared().filter(|_| joint.is_driven(k))
                && let Some(row) = dofs.row(drive.node, 0)
            {
                add(row, -drive.ratio);
            }
            for (node, G) in joint.ends().zip(joint.gradient(k, &nodes, &mut room)) {
                for (&independent, T) in independent_nodes[node].iter().zip(&projections[node]) {
                    let G = T.tr_mul(G);
                    for dof in 0..6 {
                        let Some(row) = dofs.row(independent, dof) else { continue };
                        add(row, if dof < 3 { G[dof] } else { G[dof] / length });
                    }
                }
            }
            sparse.push(entries);
        }
    }
    let rows = without_branches(&sparse, &joints, columns);
    let groups = connected(&sparse, &rows, columns);
    let operations = |rows: &Vec<usize>, columns: usize| (rows.len() * rows.len()) as f64 * columns as f64;
    if groups.iter().map(|(rows, columns)| operations(rows, columns.len())).sum::<f64>() > MOST {
        return None;
    }
    let mut redundant: Vec<usize> = Vec::new();
    for (rows, columns) in &groups {
        let own = |&(column, value): &(usize, f64)| Some((columns.binary_search(&column).ok()?, value));
        let own: Vec<Vec<(usize, f64)>> =
            rows.iter().map(|&row| sparse[row].iter().filter_map(own).collect()).collect();
        let own: Vec<&[(usize, f64)]> = own.iter().map(|row| &row[..]).collect();
        redundant.extend(dependent_rows(&own, columns.len()).into_iter().map(|row| rows[row]));
    }
    redundant.sort_unstable();
    Some(redundant)
}

/// Groups of rows that no column connects, with the columns of each, all ascending.
fn connected(sparse: &[Vec<(usize, f64)>], rows: &[usize], columns: usize) -> Vec<(Vec<usize>, Vec<usize>)> {
    let mut acting: Vec<Vec<usize>> = vec![Vec::new(); columns];
    for &row in rows {
        sparse[row].iter().for_each(|&(column, _)| acting[column].push(row));
    }
    let mut seen: BTreeSet<usize> = BTreeSet::new();
    let mut groups = Vec::new();
    for &first in rows {
        if !seen.insert(first) {
            continue;
        }
        let (mut own_rows, mut own_columns, mut todo) = (vec![first], BTreeSet::new(), vec![first]);
        while let Some(row) = todo.pop() {
            for &(column, _) in &sparse[row] {
                if own_columns.insert(column) {
                    let new: Vec<usize> = acting[column].iter().copied().filter(|row| seen.insert(*row)).collect();
                    own_rows.extend(&new);
                    todo.extend(new);
                }
            }
        }
        own_rows.sort_unstable();
        groups.push((own_rows, own_columns.into_iter().collect()));
    }
    groups
}

/// The rows that may depend on each other. A joint whose independent equations concern separate degrees of freedom, such as at the end of a
/// chain, does not affect dependence. Without it the next joint is at the end.
fn without_branches(sparse: &[Vec<(usize, f64)>], joints: &[Range<usize>], columns: usize) -> Vec<usize> {
    let columns_of = |joint: &Range<usize>| -> BTreeSet<usize> {
        sparse[joint.clone()].iter().flatten().map(|&(column, _)| column).collect()
    };
    let touched: Vec<BTreeSet<usize>> = joints.iter().map(columns_of).collect();
    let mut acting: Vec<Vec<usize>> = vec![Vec::new(); columns];
    for (joint, touched) in touched.iter().enumerate() {
        touched.iter().for_each(|&column| acting[column].push(joint));
    }
    let mut left: Vec<usize> = acting.iter().map(Vec::len).collect();
    let mut kept = vec![true; joints.len()];
    let mut todo: Vec<usize> = (0..joints.len()).collect();
    while let Some(joint) = todo.pop() {
        let own: Vec<usize> = touched[joint].iter().copied().filter(|&column| left[column] == 1).collect();
        let in_own = |row: &Vec<(usize, f64)>| -> Vec<(usize, f64)> {
            let rounding = NEW * row.iter().map(|(_, value)| value.abs()).fold(0.0, f64::max);
            let entries = row.iter().filter(|(_, value)| value.abs() > rounding);
            entries.filter_map(|&(column, value)| Some((own.binary_search(&column).ok()?, value))).collect()
        };
        let rows: Vec<Vec<(usize, f64)>> = sparse[joints[joint].clone()].iter().map(in_own).collect();
        let rows: Vec<&[(usize, f64)]> = rows.iter().map(|row| &row[..]).collect();
        if !kept[joint] || rows.len() > own.len() || !dependent_rows(&rows, own.len()).is_empty() {
            continue;
        }
        kept[joint] = false;
        for &column in &touched[joint] {
            left[column] -= 1;
            if left[column] == 1 {
                todo.extend(acting[column].iter().filter(|other| kept[**other]));
            }
        }
    }
    joints.iter().zip(kept).filter(|(_, kept)| *kept).flat_map(|(joint, _)| joint.clone()).collect()
}

/// The numbers of rows that depend linearly on those before them.
fn dependent_rows(sparse: &[&[(usize, f64)]], columns: usize) -> Vec<usize> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut redundant = Vec::new();
    for (number, entries) in sparse.iter().enumerate() {
        let mut v = vec![0.0; columns];
        entries.iter().for_each(|&(at, value)| v[at] += value);
        let whole = entries.iter().map(|(_, value)| value * value).sum::<f64>().sqrt();
        // Orthogonalizing twice is enough (Kahan).
        for _ in 0..2 {
            for b in &basis {
                let part: f64 = v.iter().zip(b).map(|(v, b)| v * b).sum();
                v.iter_mut().zip(b).for_each(|(v, b)| *v -= part * b);
            }
        }
        let rest = norm(&v);
        if rest <= NEW * whole || whole == 0.0 {
            redundant.push(number);
        } else {
            v.iter_mut().for_each(|v| *v /= rest);
            basis.push(v);
        }
    }
    redundant
}

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}
