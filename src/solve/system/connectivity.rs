//! Which nodes the matrix of the system couples, as far as elements, joints and nodal matrices do.

use super::dependents::independent_nodes;
use super::equations::System;
use mechanics::elements::Partners;

/// The connectivity of the nodes: one list for each element, joint and nodal matrix, with dependent nodes replaced by their independent
/// nodes. `nodes` counts the joints too, whose multipliers are nodes after all others; `partners` are pairs of elements with changing
/// partners.
pub fn connectivity(system: &System, nodes: usize, partners: &[(usize, Partners)]) -> Vec<Vec<usize>> {
    let independent = independent_nodes(&system.rigid_links, nodes);
    let mut connectivity = coupled(system, nodes, &independent);
    for (_, partners) in partners {
        for pair in 0..partners.pairs.len() {
            let mut all: Vec<usize> =
                partners.nodes(pair).iter().flat_map(|&n| independent[n].iter().copied()).collect();
            all.sort_unstable();
            all.dedup();
            connectivity.push(all);
        }
    }
    connectivity
}

/// The connectivity with multipliers in place of elimination: every dependent node is independent, and an additional node after all others
/// ties it to its master.
pub fn connectivity_with_multipliers(system: &System, nodes: usize) -> Vec<Vec<usize>> {
    let alone: Vec<Vec<usize>> = (0..nodes).map(|node| vec![node]).collect();
    let mut connectivity = coupled(system, nodes, &alone);
    connectivity.extend(
        system.rigid_links.iter().enumerate().map(|(k, dependent)| vec![dependent.master, dependent.node, nodes + k]),
    );
    connectivity
}

fn coupled(system: &System, nodes: usize, independent_nodes: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut connectivity: Vec<Vec<usize>> = Vec::new();
    let mut add = |nodes: &[usize]| {
        let mut all: Vec<usize> = nodes.iter().flat_map(|&n| independent_nodes[n].iter().copied()).collect();
        all.sort_unstable();
        all.dedup();
        connectivity.push(all);
    };
    for group in &system.groups {
        (0..group.block.len()).for_each(|e| add(group.block.nodes(e)));
    }
    system.consistent_masses().iter().for_each(|m| add(&m.nodes));
    system.floating().iter().for_each(|mass| add(mass.element.nodes()));
    system.pressures.iter().flat_map(|load| &load.faces).for_each(|face| add(face.nodes()));
    (0..nodes).filter(|&n| independent_nodes[n] != [n]).for_each(|n| add(&[n]));
    // The multipliers of a joint stand for one more of its nodes.
    let joints = system.joints.iter().zip(nodes - system.joints.len()..);
    joints.for_each(|(joint, own)| add(&joint.matrix_nodes().chain([own]).collect::<Vec<_>>()));
    connectivity
}
