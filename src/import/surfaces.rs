//! Surfaces: sets of nodes, faces of elements and edges of shells under one name.

use crate::build::Build;
use crate::scopes::{Members, NamedTarget};
use base::math::Vec3;
use base::math::curved_faces::corners;
use base::math::quadrature::gauss;
use std::collections::{BTreeMap, BTreeSet};

/// The sets of a surface with their sides; a set of nodes is a surface too. Refuses other names.
pub fn lines(build: &mut Build, surface: &NamedTarget) -> Option<Vec<(NamedTarget, String)>> {
    let found = build.im.scopes.surface(surface);
    let is_set = build.im.scopes.members(surface, Members::Nodes).is_some();
    let lines =
        found.or_else(|| is_set.then(|| vec![(NamedTarget { is_set: true, ..surface.clone() }, "NODE".to_owned())]));
    if lines.is_none() {
        build.im.refuse(surface.line, &format!("no surface is named `{}`", surface.name));
    }
    let here = |(set, side): (NamedTarget, String)| (NamedTarget { line: surface.line, ..set }, side);
    Some(lines?.into_iter().map(here).collect())
}

/// The nodes of a surface: those of a set, of elements, or of their edges.
pub fn nodes_of(build: &mut Build, surface: &NamedTarget) -> Option<BTreeSet<u64>> {
    let mut nodes = BTreeSet::new();
    for (set, side) in lines(build, surface)? {
        if side == "NODE" {
            nodes.extend(build.nodes(&set));
            continue;
        }
        for at in build.cells(&set) {
            let all = &build.mesh.cells[at].nodes;
            nodes.extend(match edge(&side, all.len()) {
                Some(edge) => edge.into_iter().filter_map(|k| all.get(k).copied()).collect(),
                None => all.clone(),
            });
        }
    }
    Some(nodes)
}

/// The weights of the nodes of a surface: 1 in sets of nodes, their shares of the faces or edges in others. True where faces of second degree
/// share out their area evenly.
pub fn weights_of(build: &mut Build, surface: &NamedTarget) -> Option<(BTreeMap<u64, f64>, bool)> {
    let (mut weights, mut seen, mut is_even) = (BTreeMap::new(), BTreeSet::new(), false);
    for (set, side) in lines(build, surface)? {
        if side == "NODE" {
            build.nodes(&set).into_iter().for_each(|node| *weights.entry(node).or_insert(0.0) = 1.0);
            continue;
        }
        for at in build.cells(&set) {
            let nodes = build.mesh.cells[at].nodes.clone();
            let of_edge = edge(&side, nodes.len());
            if !seen.insert((at, of_edge.clone())) {
                continue;
            }
            let x: Vec<Vec3> = nodes.iter().map(|id| build.mesh.x(*id)).collect();
            let mut add = |k: usize, weight: f64| *weights.entry(nodes[k]).or_insert(0.0) += weight;
            match of_edge {
                Some(of_edge) => {
                    let of_nodes: Vec<Vec3> = of_edge.iter().map(|k| x[*k]).collect();
                    for (shares, slope) in along_edge(&of_nodes) {
                        of_edge.iter().zip(shares).for_each(|(k, share)| add(*k, share * slope.norm()));
                    }
                }
                None => {
                    is_even |= nodes.len() > corners(nodes.len());
                    shares_of_face(&x).into_iter().enumerate().for_each(|(k, share)| add(k, share));
                }
            }
        }
    }
    Some((weights, is_even))
}

/// The shares of the nodes of a face in its area: of a quadrilateral ∫ N dA by four points, of others even ones.
fn shares_of_face(x: &[Vec3]) -> Vec<f64> {
    let area = |a: &Vec3, b: &Vec3, c: &Vec3| 0.5 * (b - a).cross(&(c - a)).norm();
    match x {
        [a, b, c, d] => {
            let (places, _) = gauss(2);
            let mut shares = vec![0.0; 4];
            for (r, s) in places.iter().flat_map(|r| places.iter().map(move |s| (r, s))) {
                let along = (b - a) * (1.0 - s) + (c - d) * (1.0 + s);
                let across = (d - a) * (1.0 - r) + (c - b) * (1.0 + r);
                let size = along.cross(&across).norm() / 16.0;
                let n = [(1.0 - r) * (1.0 - s), (1.0 + r) * (1.0 - s), (1.0 + r) * (1.0 + s), (1.0 - r) * (1.0 + s)];
                shares.iter_mut().zip(n).for_each(|(share, n)| *share += 0.25 * n * size);
            }
            shares
        }
        [a, b, c] => vec![area(a, b, c) / 3.0; 3],
        _ => {
            let whole = match corners(x.len()) {
                3 => area(&x[0], &x[1], &x[2]),
                _ => area(&x[0], &x[1], &x[2]) + area(&x[0], &x[2], &x[3]),
            };
            vec![whole / x.len() as f64; x.len()]
        }
    }
}

/// The sets of nodes of a surface, by which the deck names them.
pub fn node_sets(build: &Build, surface: &NamedTarget) -> Vec<NamedTarget> {
    match build.im.scopes.surface(surface) {
        Some(lines) => lines.into_iter().filter(|(_, side)| side == "NODE").map(|(set, _)| set).collect(),
        None => vec![NamedTarget { is_set: true, ..surface.clone() }],
    }
}

/// The places, among its nodes, of those of an edge of a shell: E1 of Abaqus, S3 of CalculiX for the first one. Ends come first.
pub fn edge(side: &str, nodes: usize) -> Option<Vec<usize>> {
    let number: usize = side.get(1..)?.parse().ok()?;
    let first = match side.as_bytes()[0] {
        b'E' => number.checked_sub(1)?,
        _ => number.checked_sub(3)?,
    };
    let n = corners(nodes);
    let middle = (nodes > n).then_some(n + first);
    (first < n).then(|| [first, (first + 1) % n].into_iter().chain(middle).collect())
}

/// Gauss's points of an edge by its nodes, both ends first: weights of the nodes there, and the slope of the place.
pub fn along_edge(x: &[Vec3]) -> Vec<(Vec<f64>, Vec3)> {
    let (places, weights) = gauss(3);
    let point = |(s, weight): (&f64, &f64)| {
        // Shape functions over s from −1 to 1, and their slopes.
        let (n, d) = match x.len() {
            2 => (vec![0.5 * (1.0 - s), 0.5 * (1.0 + s)], vec![-0.5, 0.5]),
            _ => (vec![0.5 * s * (s - 1.0), 0.5 * s * (s + 1.0), 1.0 - s * s], vec![s - 0.5, s + 0.5, -2.0 * s]),
        };
        let slope: Vec3 = x.iter().zip(&d).map(|(x, d)| x * *d).sum();
        (n.into_iter().map(|n| n * weight).collect(), slope)
    };
    places.iter().zip(weights).map(point).collect()
}
