//! The mesh as one list of nodes and elements: instances at their positions with distinct numbers, and the sets of all blocks.

use super::blocks::{Block, Blocks};
use super::sets::{BlockIndex, Member, Set, SetIndex, SetKind};
use crate::mesh::data::{GroupKind, MeshNote};
use crate::mesh::draft::{Draft, RawElement, RawGroup};
use crate::mesh::ids::{Ids, short};
use base::text_file::{Fault, Text};
use std::collections::HashSet;

/// The offsets of the numbers of each instance, and of the assembly.
struct Offsets {
    instances: Vec<u64>,
    root: u64,
}

/// Puts the blocks into the draft, with their sets as groups.
///
/// # Errors
/// Unknown nodes or elements in a set, or numbers too large for several instances.
pub fn flatten(text: &Text, draft: &mut Draft, mut assembly: Blocks) -> Result<(), Fault> {
    if assembly.instances.is_empty() {
        for part in (0..assembly.parts.len()).filter(|&part| !assembly.parts[part].nodes.is_empty()).collect::<Vec<_>>()
        {
            assembly.add_instance(&assembly.parts[part].name.clone(), part, 1);
        }
    }
    let offsets = offsets(text, draft, &assembly)?;
    let mut others = Vec::new();
    for (instance, offset) in assembly.instances.iter().zip(&offsets.instances) {
        for block in [&assembly.parts[instance.part], &instance.own] {
            others.extend(block.others.iter().map(|id| id + offset));
            let nodes = block.nodes.iter().map(|(id, x, line)| (id + offset, instance.place(x), *line));
            nodes.for_each(|(id, x, line)| draft.node(id, x, line as usize));
            draft.elements.extend(block.elements.iter().map(|element| element.moved(*offset)));
        }
    }
    let root = &mut assembly.root;
    others.extend(root.others.drain(..).map(|id| id + offsets.root));
    for (id, x, line) in root.nodes.drain(..) {
        draft.node(id + offsets.root, x, line as usize);
    }
    draft.elements.extend(root.elements.drain(..).map(|element| element.moved(offsets.root)));
    draft.drop_repeated();
    say_left_out(draft, &assembly);
    Groups::new(text, draft, &assembly, &offsets, &others).add(draft)
}

/// Numbers for each instance: those of the file for the first, and for the others with a multiple of a power of ten added.
fn offsets(text: &Text, draft: &mut Draft, assembly: &Blocks) -> Result<Offsets, Fault> {
    let ids = |block: &Block| {
        let elements = block.elements.iter().map(|element| element.id).chain(block.others.iter().copied());
        block.nodes.iter().map(|node| node.0).chain(elements).max().unwrap_or(0)
    };
    let blocks = assembly.parts.iter().chain(assembly.instances.iter().map(|instance| &instance.own));
    let largest = blocks.chain([&assembly.root]).map(ids).max().unwrap_or(0);
    let step = 10u64.checked_pow(largest.checked_ilog10().unwrap_or(0) + 1);
    let count = assembly.instances.len() as u64;
    let collides = !assembly.instances.is_empty() && has_numbers_of_instances(assembly);
    if count < 2 && !collides {
        return Ok(Offsets { instances: vec![0; assembly.instances.len()], root: 0 });
    }
    let Some(step) = step.filter(|step| step.checked_mul(count + 1).is_some()) else {
        return Err(text.fault(format!("numbers up to {largest} are too large for several instances"), 1));
    };
    let mut note = |name: &str, offset: u64, line: usize| {
        let what = format!("numbers of `{name}` are those of the file plus {offset}");
        let meaning = format!("its node 1 is `mesh.{}` in the deck and in results", offset + 1);
        draft.notes.push(MeshNote { what, meaning, line });
    };
    for (instance, at) in assembly.instances.iter().zip(0..).skip(1) {
        note(&instance.own.name, at * step, instance.line);
    }
    let root = if collides { count * step } else { 0 };
    if collides {
        let first = assembly.root.nodes.first().map_or(1, |node| node.2 as usize);
        note(&assembly.root.name, root, first);
    }
    Ok(Offsets { instances: (0..count).map(|at| at * step).collect(), root })
}

/// True where a node or an element of the assembly may have the number of an instance's.
fn has_numbers_of_instances(assembly: &Blocks) -> bool {
    let root = &assembly.root;
    if assembly.instances.len() > 1 {
        return !root.nodes.is_empty() || !root.elements.is_empty();
    }
    let blocks = || assembly.instances.iter().flat_map(|instance| [&assembly.parts[instance.part], &instance.own]);
    let nodes: HashSet<u64> = root.nodes.iter().map(|node| node.0).collect();
    let elements: HashSet<u64> = root.elements.iter().map(|element| element.id).collect();
    blocks().flat_map(|block| &block.nodes).any(|node| nodes.contains(&node.0))
        || blocks().flat_map(|block| &block.elements).any(|element| elements.contains(&element.id))
}

/// Notes parts without an instance.
fn say_left_out(draft: &mut Draft, assembly: &Blocks) {
    for (index, part) in assembly.parts.iter().enumerate() {
        if let Some((_, _, line)) = part.nodes.first()
            && !assembly.instances.iter().any(|instance| instance.part == index)
        {
            let what = format!("part `{}` has no instance", part.name);
            draft.notes.push(MeshNote { what, meaning: "it is left out".to_owned(), line: *line as usize });
        }
    }
}

/// The sets of a file as groups in the making.
struct Groups<'a, 't> {
    text: &'a Text<'t>,
    assembly: &'a Blocks,
    offsets: &'a Offsets,
    nodes: Ids,
    elements: Ids,
    others: Ids,
    /// The largest number of all.
    largest: u64,
}

impl<'a, 't> Groups<'a, 't> {
    fn new(text: &'a Text<'t>, draft: &Draft, assembly: &'a Blocks, offsets: &'a Offsets, others: &[u64]) -> Self {
        let (nodes, _) = Ids::new(draft.nodes.iter().map(|node| node.id));
        let (elements, _) = Ids::new(draft.elements.iter().map(|element| element.id));
        let ids = draft.nodes.iter().map(|node| node.id).chain(draft.elements.iter().map(|element| element.id));
        let largest = ids.chain(others.iter().copied()).max().unwrap_or(0);
        let (others, _) = Ids::new(others.iter().copied());
        Groups { text, assembly, offsets, nodes, elements, others, largest }
    }

    /// Adds all sets to the draft: those of instances and of their parts, then those outside.
    fn add(&self, draft: &mut Draft) -> Result<(), Fault> {
        let framed = !self.assembly.instances.is_empty();
        for (at, instance) in self.assembly.instances.iter().enumerate() {
            let part = &self.assembly.parts[instance.part].name;
            let scopes = vec![instance.own.name.clone(), part.clone()];
            for block in [BlockIndex::Part(instance.part), BlockIndex::Instance(at)] {
                self.add_block(block, Some(at), &scopes, draft)?;
            }
        }
        let scopes = if framed { vec![self.assembly.root.name.clone()] } else { Vec::new() };
        self.add_block(BlockIndex::Root, None, &scopes, draft)
    }

    fn add_block(
        &self,
        block: BlockIndex,
        instance: Option<usize>,
        scopes: &[String],
        draft: &mut Draft,
    ) -> Result<(), Fault> {
        for (set, Set { name, kind, .. }) in self.assembly.block(block).sets.list.iter().enumerate() {
            let kind = match kind {
                SetKind::Nodes => GroupKind::Nodes,
                SetKind::Elements => GroupKind::Elements,
            };
            let mut group = RawGroup { name: name.clone(), kind, scopes: scopes.to_vec(), ..RawGroup::default() };
            group.is_outer = block == BlockIndex::Root;
            self.fill(&mut group, SetIndex { block, instance, set }, draft)?;
            draft.groups.push(group);
        }
        Ok(())
    }

    fn fill(&self, group: &mut RawGroup, set: SetIndex, draft: &Draft) -> Result<(), Fault> {
        match group.kind {
            GroupKind::Nodes => self.each(set, &mut |member, line| {
                match member {
                    Found::Number(id) if self.nodes.get(id).is_none() => return self.missing(set, "node", id, line),
                    Found::Number(id) => group.nodes.push((id, line)),
                    Found::NodesOf(id) => match self.elements.get(id) {
                        Some(element) => {
                            let RawElement { kind, nodes, .. } = draft.elements[element];
                            group.nodes.extend(nodes[..kind.size()].iter().map(|&node| (node, line)));
                        }
                        None => return self.missing(set, "nodes of element", id, line),
                    },
                }
                Ok(())
            }),
            _ => self.each(set, &mut |member, line| {
                let (Found::Number(id) | Found::NodesOf(id)) = member;
                match (self.elements.get(id), self.others.get(id)) {
                    (Some(element), _) => group.elements.push(short(element)),
                    (None, Some(_)) => group.skipped += 1,
                    (None, None) => return self.missing(set, "element", id, line),
                }
                Ok(())
            }),
        }
    }

    fn missing(&self, set: SetIndex, what: &str, id: u64, line: u32) -> Result<(), Fault> {
        let name = &self.assembly.block(set.block).sets.list[set.set].name;
        let reason = if self.others.get(id).is_some() { "whose type is not read" } else { "which does not exist" };
        // The message shows the number in the file, without the offset.
        let offset = set.instance.map_or(self.offsets.root, |instance| self.offsets.instances[instance]);
        let id = id.checked_sub(offset).unwrap_or(id);
        let message = format!("set `{name}` holds {what} {id}, {reason}");
        let mut fault = self.text.fault_on(message, line as usize, Some(id));
        if let (BlockIndex::Root, [instance, ..]) = (set.block, &self.assembly.instances[..]) {
            fault
                .hints
                .push(format!("numbers of an instance need `INSTANCE={}` in the line of the set", instance.own.name));
        }
        Err(fault)
    }

    /// Calls `take` for each number in a set and in the sets that it holds, each of these once.
    fn each(&self, set: SetIndex, take: &mut impl FnMut(Found, u32) -> Result<(), Fault>) -> Result<(), Fault> {
        let (mut todo, mut seen) = (vec![(set, None)], HashSet::new());
        while let Some((at, nodes_of)) = todo.pop() {
            if !seen.insert((at, nodes_of.is_some())) {
                continue;
            }
            let set = &self.assembly.block(at.block).sets.list[at.set];
            let offset = |instance: Option<usize>| match instance.or(at.instance) {
                Some(instance) => self.offsets.instances[instance],
                None => self.offsets.root,
            };
            let inner = |other: &SetIndex| SetIndex { instance: other.instance.or(at.instance), ..*other };
            for member in &set.members {
                match member {
                    Member::Set(other) => todo.push((inner(other), nodes_of)),
                    Member::NodesOf(other, line) => todo.push((inner(other), Some(*line))),
                    Member::Number(id, instance, line) => {
                        let id = id.saturating_add(offset(*instance));
                        match nodes_of {
                            Some(line) => take(Found::NodesOf(id), line)?,
                            None => take(Found::Number(id), *line)?,
                        }
                    }
                    Member::Range([first, last, step], instance, line) => {
                        let offset = offset(*instance);
                        // A typing error in a last number does not take hours.
                        let last = (*last).min(self.largest.saturating_sub(offset));
                        let ids = (*first..=last).step_by(*step as usize).map(|id| id + offset);
                        let is_there = |id: &u64| match set.kind {
                            SetKind::Nodes => self.nodes.get(*id).is_some(),
                            SetKind::Elements => self.elements.get(*id).or_else(|| self.others.get(*id)).is_some(),
                        };
                        for id in ids.filter(is_there) {
                            match nodes_of {
                                Some(line) => take(Found::NodesOf(id), line)?,
                                None => take(Found::Number(id), *line)?,
                            }
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

/// A number that a set holds.
enum Found {
    /// The number of a node or an element.
    Number(u64),
    /// The number of an element whose nodes are meant.
    NodesOf(u64),
}
