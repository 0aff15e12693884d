//! Keywords that describe the mesh: nodes, elements, sets, surfaces, parts and their instances.

use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::scopes::{Members, NamedTarget, PlacedElement, ScopeContent, ScopeIndex};
use base::math::{LARGEST_LENGTH, Vec3};
use base::text_file::cards::{Data, name_in};

/// The most numbers that one line adds to a set.
const LONGEST_RANGE: u64 = 10_000_000;

/// `*NODE`.
pub fn nodes(im: &mut Importer, block: &KeywordBlock) {
    if let Some(system) = block.keyword.value("SYSTEM")
        && !system.eq_ignore_ascii_case("R")
    {
        im.refuse(
            block.keyword.line,
            "nodes in cylindrical or spherical coordinates are not read; write them in Cartesian coordinates",
        );
        return;
    }
    let offset = im.scopes.offset_here();
    let set = block.keyword.value("NSET").map(str::to_owned);
    let mut ids = Vec::with_capacity(block.data.len());
    for data in &block.data {
        let Some(id) = im.id(data, 0) else { continue };
        let x = im.vector(data, 1);
        im.scopes.here().nodes.push((id + offset, x));
        ids.push(id + offset);
    }
    if let Some(set) = set {
        im.scopes.here().node_sets.place(&set).extend(ids);
    }
}

/// `*ELEMENT`.
pub fn elements(im: &mut Importer, block: &KeywordBlock) {
    let Some(name) = block.keyword.value("TYPE") else {
        im.refuse(block.keyword.line, "*ELEMENT needs TYPE=");
        return;
    };
    if block.keyword.value("OFFSET").is_some_and(|offset| offset != "0") {
        im.refuse(
            block.keyword.line,
            "OFFSET makes other numbers and is not read; write the elements with their numbers",
        );
        return;
    }
    let kind = im.scopes.kind(name);
    let (nodes, changed) = (im.scopes.types[kind].nodes, im.scopes.types[kind].changed);
    if !changed.is_empty() {
        im.change(block.keyword.line, changed);
    }
    let offset = im.scopes.offset_here();
    let mut ids = Vec::with_capacity(block.data.len());
    for data in &block.data {
        let Some(cell) = element(im, data, (kind, nodes), offset) else { continue };
        ids.push(cell.id);
        im.scopes.here().cells.push(cell);
    }
    if let Some(set) = block.keyword.value("ELSET") {
        im.scopes.here().cell_sets.place(set).extend(ids);
    }
}

/// Reads an element: number, nodes. Nodes may be those of instances.
fn element(im: &mut Importer, data: &Data, (kind, count): (usize, usize), offset: u64) -> Option<PlacedElement> {
    let id = im.id(data, 0)? + offset;
    let mut nodes = Vec::with_capacity(count);
    for word in data.words[1..data.filled()].iter() {
        let found = word.whole().map(|node| node + offset).or_else(|| im.node_of_instance(word));
        // The end of a connector that is left open lies on the ground.
        let Some(node) = found.or(word.bytes.is_empty().then_some(0)) else {
            im.refuse_at(word, "this must be the number of a node");
            return None;
        };
        nodes.push(node);
    }
    let of = &im.scopes.types[kind];
    let fits = count == 0 || nodes.len() == count || of.takes_direction() && nodes.len() == count + 1;
    if !fits {
        let about = format!("element {} has {} nodes; {} has {count}", id - offset, nodes.len(), of.name);
        im.refuse(data.line, &about);
        return None;
    }
    Some(PlacedElement { id, kind, nodes, instance: None, line: data.line })
}

/// `*NSET`.
pub fn node_sets(im: &mut Importer, block: &KeywordBlock) {
    sets(im, block, Members::Nodes);
}

/// `*ELSET`.
pub fn element_sets(im: &mut Importer, block: &KeywordBlock) {
    sets(im, block, Members::Cells);
}

fn sets(im: &mut Importer, block: &KeywordBlock, of: Members) {
    let key = if of == Members::Nodes { "NSET" } else { "ELSET" };
    let Some(name) = block.keyword.value(key) else {
        im.refuse(block.keyword.line, &format!("*{key} needs {key}="));
        return;
    };
    let scope = match block.keyword.value("INSTANCE") {
        None => im.scopes.at,
        Some(instance) => match im.scopes.instance(instance) {
            Some(instance) => ScopeIndex::Instance(instance),
            None => {
                im.refuse(block.keyword.line, &format!("no instance before this line is named `{instance}`"));
                return;
            }
        },
    };
    let mut ids = Vec::new();
    if let Some(cells) = block.keyword.value("ELSET").filter(|_| of == Members::Nodes) {
        let target = NamedTarget { scope, name: cells.to_owned(), is_set: true, line: block.keyword.line };
        ids.extend(nodes_of_cells(im, &target));
    }
    for data in &block.data {
        match block.keyword.has("GENERATE") {
            true => generate(im, data, scope, &mut ids),
            false => members(im, data, (scope, of), &mut ids),
        }
    }
    let set = match of {
        Members::Nodes => im.scopes.here().node_sets.place(name),
        Members::Cells => im.scopes.here().cell_sets.place(name),
    };
    set.extend(ids);
}

/// Numbers of the nodes of a set of elements.
fn nodes_of_cells(im: &mut Importer, target: &NamedTarget) -> Vec<u64> {
    let Some(ids) = im.scopes.members(target, Members::Cells) else {
        im.refuse(target.line, &format!("no element set before this line is named `{}`", target.name));
        return Vec::new();
    };
    let wanted: std::collections::HashSet<u64> = ids.into_iter().collect();
    let of = |content: &ScopeContent, offset: u64| -> Vec<u64> {
        let cells = content.cells.iter().filter(|cell| wanted.contains(&(cell.id + offset)));
        cells.flat_map(|cell| cell.nodes.iter().map(move |node| node + offset)).collect()
    };
    match target.scope {
        ScopeIndex::Part(part) => of(&im.scopes.parts[part], 0),
        _ => {
            let placed = im.scopes.instances.iter().flat_map(|at| of(&im.scopes.parts[at.part], at.offset));
            placed.chain(of(&im.scopes.outer, 0)).collect()
        }
    }
}

/// Adds first to last by a step. Numbers may exist later in the file; those that never do are passed over at the end.
fn generate(im: &mut Importer, data: &Data, scope: ScopeIndex, ids: &mut Vec<u64>) {
    let (Some(first), Some(last)) = (im.id(data, 0), im.id(data, 1)) else { return };
    let step = if data.filled() > 2 { im.id(data, 2).unwrap_or(1) } else { 1 };
    if step == 0 || last < first {
        im.refuse(data.line, "first, last and step must count upwards");
        return;
    }
    // A typing error in a last number does not take hours.
    let last = last.min(im.scopes.largest);
    let offset = match scope {
        ScopeIndex::Instance(instance) => im.scopes.instances[instance].offset,
        ScopeIndex::Outer => im.scopes.outer_offset,
        ScopeIndex::Part(_) => 0,
    };
    if last.saturating_sub(first) / step > LONGEST_RANGE {
        return im.refuse(data.line, "this range is too long");
    }
    ids.extend((first..=last).step_by(step as usize).map(|id| id + offset));
}

/// Adds numbers and sets by their names.
fn members(im: &mut Importer, data: &Data, (scope, of): (ScopeIndex, Members), ids: &mut Vec<u64>) {
    for word in data.words.iter().filter(|word| !word.bytes.is_empty()) {
        let target = NamedTarget { scope, name: name_in(word), is_set: false, line: word.line };
        // Sets of a part are read before it has instances.
        let found = im.scopes.members(&target, of);
        match found {
            Some(found) => ids.extend(found),
            None => im.refuse_at(word, &format!("no set before this line is named `{}`", target.name)),
        }
    }
}

/// `*SURFACE`.
pub fn surfaces(im: &mut Importer, block: &KeywordBlock) {
    let Some(name) = block.keyword.value("NAME") else {
        im.refuse(block.keyword.line, "*SURFACE needs NAME=");
        return;
    };
    let of_nodes = block.keyword.value("TYPE").is_some_and(|of| of.eq_ignore_ascii_case("NODE"));
    let mut lines = Vec::new();
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let side = data.words.get(1).filter(|_| !of_nodes).map(name_in).unwrap_or_default().to_ascii_uppercase();
        let side = if of_nodes { "NODE".to_owned() } else { side };
        lines.push((im.target(&data.words[0]), side));
    }
    im.scopes.here().surfaces.insert(name.to_lowercase(), lines);
}

/// `*PART`.
pub fn part(im: &mut Importer, block: &KeywordBlock) {
    let name = block.keyword.value("NAME").unwrap_or("part").to_owned();
    im.scopes.at = ScopeIndex::Part(im.scopes.parts.len());
    im.scopes.parts.push(ScopeContent { name, ..ScopeContent::default() });
}

/// `*END PART`, `*ASSEMBLY`, `*END INSTANCE`, `*END ASSEMBLY`.
pub fn outside(im: &mut Importer, _: &KeywordBlock) {
    im.scopes.at = ScopeIndex::Outer;
}

/// `*USER ELEMENT`; U1 of CalculiX is a beam.
pub fn user_element(im: &mut Importer, block: &KeywordBlock) {
    let value = |name: &str| block.keyword.value(name).unwrap_or_default().to_ascii_uppercase();
    if ["TYPE", "NODES", "MAXDOF"].map(value) != ["U1", "2", "6"] {
        im.refuse(block.keyword.line, "user elements are not translated");
    }
}

/// `*INSTANCE`.
pub fn instance(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    if block.keyword.has("LIBRARY") {
        return im.refuse(line, "LIBRARY reads the results of another run");
    }
    let wanted = block.keyword.value("PART").unwrap_or_default().to_owned();
    let same = |part: &ScopeContent| part.name.to_lowercase() == wanted.to_lowercase();
    let Some(part) = im.scopes.parts.iter().position(same) else {
        return im.refuse(line, &format!("no part before this line is named `{wanted}`"));
    };
    let name = block.keyword.value("NAME").unwrap_or(&wanted).to_owned();
    let offset = im.scopes.instances.len() as u64 * im.scopes.step;
    im.scopes.add_instance(&name, part, offset);
    let index = im.scopes.instances.len() - 1;
    im.scopes.at = ScopeIndex::Instance(index);
    for data in &block.data {
        let [first, second] = [im.vector(data, 0), im.vector(data, 3)];
        let angle = im.number_at(data, 6);
        let at = &mut im.scopes.instances[index];
        at.rows += 1;
        match (at.rows, angle) {
            (1, _) => at.translation = first,
            (2, Some(angle)) if at.set_turn(first, second, angle).is_some() => {}
            _ => im.refuse(
                data.line,
                "an instance takes a translation, and two different points of an axis with an angle",
            ),
        }
    }
}

impl Importer<'_, '_> {
    /// Three coordinates from a field on; blank ones are zero.
    pub fn vector(&mut self, data: &Data, first: usize) -> Vec3 {
        let mut x = Vec3::zeros();
        for i in 0..3 {
            let value = self.number_at(data, first + i).unwrap_or(0.0);
            if value.abs() > LARGEST_LENGTH {
                self.refuse(data.line, &format!("a coordinate must be at most {LARGEST_LENGTH:e}"));
                continue;
            }
            x[i] = value;
        }
        x
    }
}
