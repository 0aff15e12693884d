//! Keywords that make nodes and elements of others: `*NGEN`, `*NFILL`, `*ELGEN`, `*NCOPY`, `*ELCOPY`.

use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::scopes::{Members, NamedTarget, PlacedElement, ScopeContent};
use base::math::{Vec3, rotation};
use base::text_file::cards::Data;

/// The most nodes and elements that the keywords of a file make: a typing error in a count does not fill the memory.
const MOST: u64 = 2_000_000;
/// How far a node may lie from the place where a line makes it, over the length of the line.
const SAME: f64 = 1e-9;

/// The largest number of a node or an element that these keywords may make; `largest`: of those that stand in the file.
pub fn largest(blocks: &[KeywordBlock], mut largest: u64) -> u64 {
    for block in blocks {
        let whole = |data: &Data, at: usize| data.words.get(at).and_then(|word| word.whole()).unwrap_or(0);
        let keyword = &block.keyword;
        let added = |name: &str| keyword.value(name).and_then(|text| text.parse::<u64>().ok()).unwrap_or(0);
        match keyword.key().as_str() {
            "ELGEN" => {
                let last = |data: &Data| {
                    let along = |first: usize| whole(data, first).saturating_mul(whole(data, first + 2).max(1));
                    [1, 4, 7].iter().fold(whole(data, 0), |sum, first| sum.saturating_add(along(*first)))
                };
                largest = block.data.iter().map(last).fold(largest, u64::max);
            }
            "NFILL" => {
                let added = |data: &Data| whole(data, 2).saturating_mul(whole(data, 3));
                largest = largest.saturating_add(block.data.iter().map(added).max().unwrap_or(0));
            }
            "NCOPY" => largest = largest.saturating_add(added("CHANGENUMBER")),
            "ELCOPY" => largest = largest.saturating_add(added("ELEMENTSHIFT").max(added("SHIFTNODES"))),
            _ => {}
        }
    }
    largest.min(u64::from(u32::MAX))
}

/// The scope of the line with its maps.
fn updated<'i>(im: &'i mut Importer) -> &'i mut ScopeContent {
    let here = im.scopes.here();
    here.update();
    here
}

/// True where the file may make so many more; refuses more.
fn has_room(im: &mut Importer, line: usize, count: u64) -> bool {
    let made = im.scopes.made.saturating_add(count);
    if made > MOST {
        im.refuse(line, &format!("keywords make more than {MOST} nodes and elements: write the mesh as one flat file"));
        return false;
    }
    im.scopes.made = made;
    true
}

/// `*NGEN`: nodes on the line between two.
pub fn between_nodes(im: &mut Importer, block: &KeywordBlock) {
    if block.keyword.has("LINE") {
        return im.refuse(block.keyword.line, "nodes on a straight line alone are made; write those of arcs");
    }
    let offset = im.scopes.offset_here();
    let mut all = Vec::new();
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let (Some(first), Some(last)) = (im.id(data, 0), im.id(data, 1)) else { continue };
        let step = if data.filled() > 2 { im.id(data, 2).unwrap_or(1) } else { 1 };
        let length = first.abs_diff(last);
        if step == 0 || !length.is_multiple_of(step) {
            im.refuse(data.line, &format!("the increment {step} does not lead from node {first} to node {last}"));
            continue;
        }
        let parts = length / step;
        let places = &updated(im).places.0;
        let ends = [first, last].map(|id| places.get(&(id + offset)).copied());
        let [Some(a), Some(b)] = ends else {
            im.refuse(data.line, &format!("node {first} or node {last} does not exist before this line"));
            continue;
        };
        if !has_room(im, data.line, parts.saturating_sub(1)) {
            return;
        }
        for k in 0..=parts {
            let id = offset + if first <= last { first + k * step } else { first - k * step };
            let x = a + (b - a) * (k as f64 / parts.max(1) as f64);
            all.push(id);
            add(im, (id, x), (data.line, (b - a).norm()));
        }
    }
    if let Some(set) = block.keyword.value("NSET") {
        im.scopes.here().node_sets.place(set).extend(all);
    }
}

/// Adds a node, unless it is there already; refuses one that is at another place. `size`: a length beside which places are compared.
fn add(im: &mut Importer, (id, x): (u64, Vec3), (line, size): (usize, f64)) {
    match updated_place(im, id) {
        None => im.scopes.here().nodes.push((id, x)),
        Some(known) if (known - x).norm() <= SAME * size => {}
        Some(_) => im.refuse(line, &format!("node {id} exists before this line, at another place")),
    }
}

/// The place of a node of the scope of the line, as of the last update.
fn updated_place(im: &mut Importer, id: u64) -> Option<Vec3> {
    im.scopes.here().places.0.get(&id).copied()
}

/// `*NFILL`: nodes between those of two sets.
pub fn between_sets(im: &mut Importer, block: &KeywordBlock) {
    if ["BIAS", "TWOSTEP", "SINGULAR"].iter().any(|name| block.keyword.has(name)) {
        return im.refuse(block.keyword.line, "nodes at even distances alone are made; write others");
    }
    let mut all = Vec::new();
    updated(im);
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let (Some(parts), Some(step)) = (im.id(data, 2), im.id(data, 3)) else { continue };
        let ends: Vec<_> = (0..2).map(|at| im.target(&data.words[at])).collect();
        let ends = ends.iter().map(|target| im.scopes.members(target, Members::Nodes)).collect::<Option<Vec<_>>>();
        let Some([first, last]) = ends.as_deref() else {
            im.refuse(data.line, "no node set before this line has one of these names");
            continue;
        };
        let is_paired = |(a, b): (&u64, &u64)| parts.checked_mul(step).is_some_and(|span| a + span == *b);
        if first.len() != last.len() || parts == 0 || !first.iter().zip(last).all(is_paired) {
            let why =
                "each node of the first set, with the increment for each interval, must lead to that of the second set";
            im.refuse(data.line, why);
            continue;
        }
        if !has_room(im, data.line, (parts - 1).saturating_mul(first.len() as u64)) {
            return;
        }
        for (id, end) in first.iter().zip(last) {
            let (Some(a), Some(b)) = (updated_place(im, *id), updated_place(im, *end)) else {
                im.refuse(data.line, "a node of these sets does not exist before this line");
                break;
            };
            for k in 1..parts {
                let node = (id + k * step, a + (b - a) * (k as f64 / parts as f64));
                add(im, node, (data.line, (b - a).norm()));
            }
            all.extend((0..=parts).map(|k| id + k * step));
        }
    }
    if let Some(set) = block.keyword.value("NSET") {
        im.scopes.here().node_sets.place(set).extend(all);
    }
}

/// `*ELGEN`: rows and layers of elements like one.
pub fn rows_of_elements(im: &mut Importer, block: &KeywordBlock) {
    let offset = im.scopes.offset_here();
    let mut all = Vec::new();
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let Some(id) = im.id(data, 0) else { continue };
        let here = updated(im);
        let master = here.cells_at.0.get(&(id + offset)).map(|at| here.cells[*at].clone());
        let Some(master) = master else {
            im.refuse(data.line, &format!("element {id} does not exist before this line"));
            continue;
        };
        // Count, step of nodes, step of elements: along a row, over rows, over layers.
        let mut cells = vec![master];
        for first in [1, 4, 7].into_iter().filter(|first| data.filled() > *first) {
            let mut read = |at: usize| {
                let is_blank = data.words.get(at).is_none_or(|word| word.bytes.is_empty());
                if is_blank { Some(1) } else { im.id(data, at) }
            };
            let (Some(count), Some(nodes), Some(elements)) = (read(first), read(first + 1), read(first + 2)) else {
                break;
            };
            if count == 0 {
                im.refuse(data.line, "a number of elements is 1 or more");
                break;
            }
            if !has_room(im, data.line, (count - 1).saturating_mul(cells.len() as u64)) {
                return;
            }
            let row = cells.clone();
            for k in 1..count {
                cells.extend(row.iter().map(|cell| PlacedElement {
                    id: cell.id + k * elements,
                    nodes: cell.nodes.iter().map(|node| node + k * nodes).collect(),
                    line: data.line,
                    ..cell.clone()
                }));
            }
        }
        all.extend(cells.iter().map(|cell| cell.id));
        im.scopes.here().cells.extend(cells.into_iter().skip(1));
    }
    if let Some(set) = block.keyword.value("ELSET") {
        im.scopes.here().cell_sets.place(set).extend(all);
    }
}

/// A whole number of a parameter; refuses others.
fn whole(im: &mut Importer, block: &KeywordBlock, name: &str) -> Option<u64> {
    let number = block.keyword.value(name).and_then(|text| text.parse::<u64>().ok());
    let number = number.filter(|number| *number <= u64::from(u32::MAX));
    if number.is_none() {
        im.refuse(block.keyword.line, &format!("*{} needs {name}= with a whole number", block.keyword.name));
    }
    number
}

/// Nodes or elements of the set that is copied.
fn copied(im: &mut Importer, block: &KeywordBlock, of: Members) -> Option<Vec<u64>> {
    let line = block.keyword.line;
    let name = block.keyword.value("OLDSET").unwrap_or_default().to_owned();
    let target = NamedTarget { scope: im.scopes.at, name, is_set: true, line };
    match im.scopes.members(&target, of) {
        Some(ids) => has_room(im, line, ids.len() as u64).then_some(ids),
        None => {
            im.refuse(line, &format!("no set before this line is named `{}`", target.name));
            None
        }
    }
}

/// `*NCOPY`: nodes moved, then turned.
pub fn copied_nodes(im: &mut Importer, block: &KeywordBlock) {
    let line = block.keyword.line;
    if !block.keyword.has("SHIFT") || block.keyword.has("MULTIPLE") {
        return im.refuse(line, "nodes are copied once and by SHIFT alone; write others");
    }
    let (Some(change), Some(ids)) = (whole(im, block, "CHANGENUMBER"), copied(im, block, Members::Nodes)) else {
        return;
    };
    let rows: Vec<&Data> = block.data.iter().filter(|data| data.filled() > 0).collect();
    let translation = rows.first().map_or(Vec3::zeros(), |data| im.vector(data, 0));
    let turn = match rows.get(1) {
        None => None,
        Some(data) => {
            let (from, to) = (im.vector(data, 0), im.vector(data, 3));
            let angle = im.number_at(data, 6).unwrap_or(0.0).to_radians();
            let axis = (to - from).try_normalize(0.0);
            if axis.is_none() && angle != 0.0 {
                return im.refuse(data.line, "the two points of the axis must differ");
            }
            axis.map(|axis| (from, rotation::matrix(&rotation::exp(&(axis * angle)))))
        }
    };
    let place = |x: &Vec3| {
        let x = x + translation;
        turn.as_ref().map_or(x, |(center, turn)| center + turn * (x - center))
    };
    let places = &updated(im).places.0;
    let made: Vec<(u64, Option<Vec3>)> = ids.iter().map(|id| (*id, places.get(id).map(place))).collect();
    if let Some((id, _)) = made.iter().find(|node| node.1.is_none()) {
        return im.refuse(line, &format!("node {id} of this set does not exist before this line"));
    }
    for (id, x) in &made {
        let x = x.unwrap_or_default();
        add(im, (id + change, x), (line, x.norm()));
    }
    if let Some(set) = block.keyword.value("NEWSET") {
        im.scopes.here().node_sets.place(set).extend(ids.iter().map(|id| id + change));
    }
}

/// `*ELCOPY`: elements between copied nodes.
pub fn copied_elements(im: &mut Importer, block: &KeywordBlock) {
    if block.keyword.has("REFLECT") {
        return im.refuse(block.keyword.line, "elements are copied without reflection alone; write others");
    }
    let (Some(elements), Some(nodes), Some(ids)) =
        (whole(im, block, "ELEMENTSHIFT"), whole(im, block, "SHIFTNODES"), copied(im, block, Members::Cells))
    else {
        return;
    };
    let here = updated(im);
    let like = |cell: &PlacedElement| PlacedElement {
        id: cell.id + elements,
        nodes: cell.nodes.iter().map(|node| node + nodes).collect(),
        line: block.keyword.line,
        ..cell.clone()
    };
    let found = ids.iter().map(|id| here.cells_at.0.get(id).map(|at| like(&here.cells[*at])).ok_or(*id));
    match found.collect::<Result<Vec<PlacedElement>, u64>>() {
        Ok(made) => {
            if let Some(set) = block.keyword.value("NEWSET") {
                here.cell_sets.place(set).extend(made.iter().map(|cell| cell.id));
            }
            here.cells.extend(made);
        }
        Err(id) => im.refuse(block.keyword.line, &format!("element {id} of this set does not exist before this line")),
    }
}
