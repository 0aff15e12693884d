//! Distributing couplings: forces at a reference node act on its nodes, so that force and moment stay and no stiffness is added.

use crate::build::Build;
use crate::file_content::DistributingCard;
use crate::surfaces;
use crate::tied_nodes::DistributedNodes;
use base::math::{Mat3, Vec3};
use std::collections::BTreeMap;

/// Moments become forces above this determinant of the second moments of nodes, over the cube of their trace.
const FLAT: f64 = 1e-12;

/// Takes the couplings of the file.
pub fn couplings(build: &mut Build) {
    for card in build.im.constraints.distributing.clone() {
        let Some(reference) = reference(build, &card) else { continue };
        let mut weights: BTreeMap<u64, f64> = BTreeMap::new();
        if let Some(surface) = &card.surface {
            let Some((of_surface, is_even)) = surfaces::weights_of(build, surface) else { continue };
            weights.extend(of_surface);
            if is_even {
                build.im.change(card.line, "the nodes of a face of second degree weigh the same");
            }
        }
        for (target, weight) in &card.nodes {
            weights.extend(build.nodes(target).into_iter().map(|node| (node, *weight)));
        }
        let sum: f64 = weights.values().sum();
        if sum <= 0.0 || weights.values().any(|weight| *weight < 0.0) {
            build.im.refuse(card.line, "the weights of a distributing coupling must be above zero");
            continue;
        }
        if build.mesh.used.contains(&reference) {
            build.im.refuse(
                card.line,
                "the reference node of a distributing coupling has elements, which rdsolve does not couple",
            );
            continue;
        }
        weights.values_mut().for_each(|weight| *weight /= sum);
        let degrees = std::array::from_fn(|dof| card.degrees.is_empty() || card.degrees.contains(&dof));
        build.tied.distributed.insert(reference, DistributedNodes { line: card.line, weights, degrees });
    }
    refuse_supports(build);
}

fn reference(build: &mut Build, card: &DistributingCard) -> Option<u64> {
    if let Some(target) = &card.reference {
        return build.node(target);
    }
    let cells = build.cells(card.cells.as_ref()?);
    if cells.len() != 1 {
        build.im.refuse(card.line, "a distributing coupling has one element at its reference node");
    }
    cells.first().map(|at| build.mesh.cells[*at].nodes[0])
}

/// Refuses supports of reference nodes, which would hold the mean motion of the others.
fn refuse_supports(build: &mut Build) {
    let steps = build.im.steps.list.iter().chain([&build.im.steps.before]);
    let targets: Vec<_> = steps.flat_map(|step| &step.supports).map(|line| line.target.clone()).collect();
    for target in targets {
        let nodes = build.mesh.node_ids(&build.im.scopes, &target).unwrap_or_default();
        if nodes.iter().any(|node| build.tied.distributed.contains_key(node)) {
            build.im.refuse(target.line, "a support at the reference node of a distributing coupling holds a mean motion, which is not translated: use *KINEMATIC");
        }
    }
}

/// Forces at reference nodes as forces at their nodes; others stay. Each force has further data, which its parts share.
pub fn spread<T: Clone>(build: &mut Build, forces: Vec<(u64, [f64; 6], T)>) -> Vec<(u64, [f64; 6], T)> {
    let mut all = Vec::new();
    for (node, six, data) in forces {
        let Some(of) = build.tied.distributed.get(&node) else {
            all.push((node, six, data));
            continue;
        };
        let line = of.line;
        match at_nodes(build, node, of, &six) {
            Ok(at) => all.extend(at.into_iter().map(|(id, force)| {
                let six = [force[0], force[1], force[2], 0.0, 0.0, 0.0];
                (id, six, data.clone())
            })),
            Err(why) => {
                build.im.refuse(line, why);
                continue;
            }
        }
        if build.timeline.linear_step.is_none() {
            build.im.change(line, "the forces keep their shares of the undeformed shape");
        }
    }
    all
}

/// The forces at the nodes: those by weight, and a field that is linear about their centre and has the moment.
fn at_nodes(
    build: &Build,
    reference: u64,
    of: &DistributedNodes,
    six: &[f64; 6],
) -> Result<Vec<(u64, Vec3)>, &'static str> {
    if (0..6).any(|dof| six[dof] != 0.0 && !of.degrees[dof]) {
        return Err("a load acts along a degree of freedom that this coupling leaves free");
    }
    if of.weights.keys().any(|node| !build.mesh.used.contains(node)) {
        return Err("some nodes of this coupling have no element");
    }
    let force = Vec3::new(six[0], six[1], six[2]);
    let center: Vec3 = of.weights.iter().map(|(node, weight)| build.mesh.x(*node) * *weight).sum();
    let moment = Vec3::new(six[3], six[4], six[5]) + (build.mesh.x(reference) - center).cross(&force);
    let arm = |node: u64| build.mesh.x(node) - center;
    let mut second = Mat3::zeros();
    for (node, weight) in &of.weights {
        let r = arm(*node);
        second += (Mat3::identity() * r.norm_squared() - r * r.transpose()) * *weight;
    }
    let turn = if moment == Vec3::zeros() {
        moment
    } else if second.determinant() <= FLAT * second.trace().powi(3) {
        return Err("the nodes of this coupling lie on a line, about which they take no moment");
    } else {
        second.try_inverse().ok_or("the nodes of this coupling take no moment")? * moment
    };
    Ok(of.weights.iter().map(|(node, weight)| (*node, (force + turn.cross(&arm(*node))) * *weight)).collect())
}
