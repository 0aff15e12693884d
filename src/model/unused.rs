//! Nodes that nothing needs: those of a mesh that no part uses, the inside of rigid parts.

use super::Model;
use super::build::Builder;

impl Builder<'_> {
    /// Takes out nodes that neither the deck names nor anything acts on, and numbers the others anew. Decks without a mesh and
    /// rigid parts have none.
    pub fn drop_unused(&mut self) {
        let model = &mut self.model;
        if self.input.is_some() || !model.rigid.is_empty() {
            let kept = kept(model);
            renumber(model, &kept);
        }
        if self.writes_all {
            let mut is_body = vec![false; model.nodes.len()];
            model.bodies.iter().for_each(|body| is_body[body.node] = true);
            model.output.nodes = (0..model.nodes.len()).filter(|&node| !is_body[node]).collect();
        }
    }
}

fn kept(model: &Model) -> Vec<bool> {
    let mut kept: Vec<bool> = model.nodes.iter().map(|node| node.named).collect();
    let mut keep = |node: usize| kept[node] = true;
    model.bodies.iter().for_each(|body| keep(body.node));
    model.masses.iter().for_each(|mass| keep(mass.node));
    for beam in &model.beams {
        beam.elements.iter().flat_map(|e| &e.nodes[..=beam.order]).for_each(|&node| keep(node));
    }
    model.bars.iter().flat_map(|bar| &bar.elements).flatten().for_each(|&node| keep(node));
    for shell in &model.shells {
        shell.elements.iter().flat_map(|e| &e.nodes[..shell.corners]).for_each(|&node| keep(node));
    }
    model.links.iter().flat_map(|link| link.ends).for_each(&mut keep);
    model.held.iter().for_each(|held| keep(held.node));
    model.loads.iter().for_each(|load| keep(load.node));
    model.damping.nodal.iter().for_each(|damping| keep(damping.node));
    model.output.nodes.iter().for_each(|&node| keep(node));
    for expect in &model.expects {
        if let super::ExpectAt::Node(node) = expect.at {
            keep(node);
        }
    }
    // What rides needs what it rides on.
    let mut masters = vec![None; kept.len()];
    model.riders.iter().for_each(|rider| masters[rider.node] = Some(rider.master));
    for node in 0..kept.len() {
        let mut next = if kept[node] { masters[node] } else { None };
        while let Some(master) = next.filter(|&master| !kept[master]) {
            kept[master] = true;
            next = masters[master];
        }
    }
    kept
}

fn renumber(model: &mut Model, kept: &[bool]) {
    let mut number = Vec::with_capacity(kept.len());
    let mut count = 0;
    for &keep in kept {
        number.push(count);
        count += usize::from(keep);
    }
    let renew = |node: &mut usize| *node = number[*node];
    let mut flags = kept.iter();
    model.nodes.retain(|_| flags.next().copied().unwrap_or(true));
    model.riders.retain(|rider| kept[rider.node]);
    for rider in &mut model.riders {
        renew(&mut rider.node);
        renew(&mut rider.master);
    }
    model.bodies.iter_mut().for_each(|body| renew(&mut body.node));
    model.masses.iter_mut().for_each(|mass| renew(&mut mass.node));
    model.beams.iter_mut().flat_map(|beam| &mut beam.elements).flat_map(|e| &mut e.nodes).for_each(renew);
    model.bars.iter_mut().flat_map(|bar| &mut bar.elements).flatten().for_each(renew);
    model.shells.iter_mut().flat_map(|shell| &mut shell.elements).flat_map(|e| &mut e.nodes).for_each(renew);
    model.links.iter_mut().flat_map(|link| &mut link.ends).for_each(renew);
    model.held.iter_mut().for_each(|held| renew(&mut held.node));
    model.loads.iter_mut().for_each(|load| renew(&mut load.node));
    model.damping.nodal.iter_mut().for_each(|damping| renew(&mut damping.node));
    model.output.nodes.iter_mut().for_each(renew);
    for expect in &mut model.expects {
        if let super::ExpectAt::Node(node) = &mut expect.at {
            renew(node);
        }
    }
}
