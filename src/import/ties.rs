//! Constraints of several points and equations: nodes that are one, joints, supports.

use crate::build::Build;
use crate::deck_text::DeckTable;
use crate::dialect::Dialect;
use crate::equations;
use crate::file_content::{PointsCard, RigidCard, SupportLine};
use crate::joints;
use crate::scopes::NamedTarget;
use crate::tied_nodes::NodalEquation;
use std::collections::BTreeMap;

/// How far nodes that are one may lie apart, over the size of the mesh.
const COINCIDENT: f64 = 1e-6;

/// Merges tied nodes that coincide; adds bodies for rigid beams, and supports for equations of one term.
pub fn merge(build: &mut Build) {
    let size = build.mesh.size();
    for card in build.im.constraints.points.clone() {
        let nodes: Vec<Vec<u64>> = card.nodes.iter().map(|target| build.nodes(target)).collect();
        let is_beam = card.kind == "BEAM" && build.im.dialect == Some(Dialect::Abaqus);
        match (&card.kind[..], &nodes[..]) {
            ("BEAM", [_, _]) if build.im.dialect.is_none() => {
                let why = "BEAM is a rigid beam in Abaqus and keeps a distance in CalculiX: say --from abaqus or --from calculix";
                build.im.refuse(card.line, why);
            }
            ("TIE", [slaves, masters]) if slaves.len() == masters.len() => {
                for (a, b) in slaves.iter().zip(masters) {
                    if (build.mesh.x(*a) - build.mesh.x(*b)).norm() > COINCIDENT * size {
                        build.im.refuse(
                            card.line,
                            &format!("nodes {a} and {b} of TIE lie apart; rdsolve merges nodes that coincide"),
                        );
                        continue;
                    }
                    build.mesh.merge(*a, *b);
                }
            }
            ("BEAM", [_, _]) if is_beam => {
                build.im.constraints.rigid.push(RigidCard {
                    line: card.line,
                    name: format!("beam_{}", card.nodes[1].name),
                    reference: card.nodes[1].clone(),
                    rotations: None,
                    surface: None,
                    tied: vec![card.nodes[0].clone()],
                    pinned: Vec::new(),
                    cells: Vec::new(),
                    degrees: Vec::new(),
                    is_coupling: true,
                });
            }
            ("PIN" | "LINK" | "BEAM", [_, _]) | ("LINEAR", [_, _, _]) => {}
            ("STRAIGHT", [_, _, _, ..]) | ("PLANE", [_, _, _, _, ..]) if build.timeline.linear_step.is_some() => {}
            ("STRAIGHT" | "PLANE", [_, _, _, ..]) => {
                let why = "points stay on a line or in a plane at small displacements alone: this file has other steps than linear statics";
                build.im.refuse(card.line, why);
            }
            (kind, _) => build.im.refuse(card.line, &format!("constraints of type {kind} are not translated")),
        }
    }
    for (pair, of_pair) in pairs(build).0 {
        if of_pair.degrees == [true; 6] || of_pair.degrees == [true, true, true, false, false, false] && !of_pair.turns
        {
            build.mesh.merge(pair.1, pair.0);
        }
    }
    build.mesh.apply_merges();
}

/// The equations between two nodes.
struct PairOf {
    degrees: [bool; 6],
    line: usize,
    /// True where one of them has rotations.
    turns: bool,
}

/// Equations of two terms that say that two coincident nodes move alike, by the nodes, and all others; those of one term become supports.
fn pairs(build: &mut Build) -> (BTreeMap<(u64, u64), PairOf>, Vec<NodalEquation>) {
    let size = build.mesh.size();
    let mut pairs: BTreeMap<(u64, u64), PairOf> = BTreeMap::new();
    let mut others = Vec::new();
    for card in build.im.constraints.equations.clone() {
        let nodes: Vec<(Vec<u64>, usize, f64)> =
            card.terms.iter().map(|(target, dof, factor)| (build.nodes(target), *dof, *factor)).collect();
        match &nodes[..] {
            [(_, dof, _)] => hold(build, &card.terms[0].0, *dof, card.line),
            [(a, p, f), (b, q, g)]
                if a.len() == 1
                    && b.len() == 1
                    && p == q
                    && *f == -*g
                    && build.tied.axes.get(&a[0]) == build.tied.axes.get(&b[0])
                    && (build.mesh.x(a[0]) - build.mesh.x(b[0])).norm() <= COINCIDENT * size =>
            {
                let turns = |id: u64| {
                    build.mesh.cells.iter().any(|cell| {
                        cell.nodes.contains(&id)
                            && build.im.scopes.types[cell.kind].becomes <= crate::element_types::ElementUse::Face
                            && build.im.scopes.types[cell.kind].becomes != crate::element_types::ElementUse::Truss
                    })
                };
                let turns = turns(a[0]) || turns(b[0]);
                let pair = pairs.entry((a[0].min(b[0]), a[0].max(b[0]))).or_insert(PairOf {
                    degrees: [false; 6],
                    line: card.line,
                    turns,
                });
                pair.degrees[*p] = true;
            }
            terms => others.extend(of_sets(build, terms, card.line)),
        }
    }
    (pairs, others)
}

/// The equations of nodes, or of sets of as many nodes each.
fn of_sets(build: &mut Build, terms: &[(Vec<u64>, usize, f64)], line: usize) -> Vec<NodalEquation> {
    let count = terms.iter().map(|term| term.0.len()).max().unwrap_or(0);
    if terms.iter().any(|term| term.0.len() != count && term.0.len() != 1) {
        build.im.refuse(line, "the sets of an equation need as many nodes each");
        return Vec::new();
    }
    let node = |nodes: &[u64], at: usize| if nodes.len() == 1 { nodes[0] } else { nodes[at] };
    let of = |at: usize| -> Vec<(u64, usize, f64)> {
        terms.iter().map(|(nodes, dof, factor)| (node(nodes, at), *dof, *factor)).collect()
    };
    (0..count).map(|at| equations::along_axes(build, line, &of(at))).collect()
}

/// Holds a degree of freedom.
fn hold(build: &mut Build, target: &NamedTarget, dof: usize, line: usize) {
    let support = SupportLine {
        line,
        target: target.clone(),
        degrees: vec![dof],
        value: 0.0,
        amplitude: None,
        history: "displacement",
        is_imaginary: false,
        is_fixed: false,
    };
    let steps = &mut build.im.steps;
    if steps.before.supports.iter().any(|known| known.line == line) {
        return;
    }
    // An equation holds in all steps, whatever supports end there.
    for step in build.timeline.general.iter().map(|&at| build.timeline.stages[at].step) {
        if steps.list[step].new_supports {
            steps.list[step].supports.push(support.clone());
        }
    }
    steps.before.supports.push(support);
}

/// Adds joints between points.
pub fn joints(build: &mut Build) {
    for card in build.im.constraints.points.clone() {
        let is_beam = card.kind == "BEAM" && build.im.dialect == Some(Dialect::Abaqus);
        let kind = match &card.kind[..] {
            "PIN" => "spherical",
            "LINK" | "BEAM" if !is_beam => "distance",
            "LINEAR" | "STRAIGHT" | "PLANE" => {
                in_line(build, &card);
                continue;
            }
            _ => continue,
        };
        let nodes: Vec<u64> = card.nodes.iter().filter_map(|target| build.node(target)).collect();
        if let [a, b] = nodes[..]
            && kind == "spherical"
            && (build.mesh.x(a) - build.mesh.x(b)).norm() > COINCIDENT * build.mesh.size()
        {
            // The ends of a joint lie at one place; nodes apart have the same displacements.
            let alike = |dof: usize| NodalEquation { line: card.line, terms: vec![(a, dof, 1.0), (b, dof, -1.0)] };
            build.tied.equations.extend((0..3).map(alike));
        } else if let [a, b] = nodes[..]
            && !(kind == "distance" && joints::refuse_one_place(build, card.line, [a, b]))
        {
            add(build, (kind, &card.kind.to_lowercase()), (a, b), card.line, None);
        }
    }
    let (alike, others) = pairs(build);
    build.tied.equations.extend(others);
    for ((a, b), pair) in alike {
        match pair.degrees {
            [true, true, true, true, true, true] => {}
            [true, true, true, false, false, false] if pair.turns => {
                add(build, ("spherical", "tie"), (a, b), pair.line, None)
            }
            [true, true, true, false, false, false] => {}
            [true, true, true, rx, ry, rz] if [rx, ry, rz].iter().filter(|held| !**held).count() == 1 => {
                let axis = [rx, ry, rz].map(|held| if held { 0.0 } else { 1.0 });
                add(build, ("revolute", "tie"), (a, b), pair.line, Some(axis));
            }
            held => {
                let of = (0..6).filter(|dof| held[*dof]);
                let all: Vec<NodalEquation> =
                    of.map(|dof| equations::along_axes(build, pair.line, &[(a, dof, 1.0), (b, dof, -1.0)])).collect();
                build.tied.equations.extend(all);
            }
        }
    }
}

/// Points between others, on their line or in their plane.
fn in_line(build: &mut Build, card: &PointsCard) {
    let nodes: Vec<u64> = card.nodes.iter().flat_map(|target| build.nodes(target)).collect();
    match (&card.kind[..], &nodes[..]) {
        ("LINEAR", &[point, a, b]) => equations::linear(build, card.line, [point, a, b]),
        ("STRAIGHT", [_, _, _, ..]) => equations::flat(build, card.line, &nodes, 2),
        ("PLANE", [_, _, _, _, ..]) => equations::flat(build, card.line, &nodes, 3),
        _ => {}
    }
}

fn add(build: &mut Build, (kind, name): (&str, &str), (a, b): (u64, u64), line: usize, axis: Option<[f64; 3]>) {
    let (a, b) = (build.mesh.kept(a), build.mesh.kept(b));
    if a == b {
        return;
    }
    let name = build.deck.unique(&format!("{name}_{a}_{b}"));
    build.mesh.used.extend([a, b]);
    let table = DeckTable::new("joints", line)
        .text("name", &name)
        .text("kind", kind)
        .value("from", build.end(a, b))
        .value("to", build.end(b, a));
    build.deck.add(match axis {
        Some(axis) => table.numbers("axis", &axis),
        None => table,
    });
}
