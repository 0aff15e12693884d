//! Keywords that make nodes and elements of others: `*NGEN`, `*NFILL`, `*ELGEN`, `*NCOPY`, `*ELCOPY`.

use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::scopes::{Members, NamedTarget, PlacedElement};
use base::math::{Vec3, rotation};
use base::text_file::cards::Data;
use std::collections::HashMap;

/// The most nodes or elements that one line makes.
const MOST: u64 = 10_000_000;

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
            "NCOPY" => largest = largest.saturating_add(added("CHANGENUMBER")),
            "ELCOPY" => largest = largest.saturating_add(added("ELEMENTSHIFT").max(added("SHIFTNODES"))),
            _ => {}
        }
    }
    largest.min(u64::from(u32::MAX))
}

/// The places of all nodes read so far in the scope of a line.
fn places(im: &mut Importer) -> HashMap<u64, Vec3> {
    im.scopes.here().nodes.iter().copied().collect()
}

/// Adds nodes to the scope of the line, and to a set where a parameter names one.
fn add(im: &mut Importer, block: &KeywordBlock, parameter: &str, nodes: &[(u64, Vec3)]) {
    let set = block.keyword.value(parameter).map(str::to_owned);
    let here = im.scopes.here();
    here.nodes.extend(nodes);
    if let Some(set) = set {
        here.node_sets.place(&set).extend(nodes.iter().map(|node| node.0));
    }
}

/// Numbers between two, both among them, by an increment; refuses an increment that does not lead from one to the other.
fn numbers(im: &mut Importer, data: &Data, first: u64, last: u64, step: u64) -> Option<Vec<u64>> {
    let (low, high) = (first.min(last), first.max(last));
    if step == 0 || !(high - low).is_multiple_of(step) || (high - low) / step > MOST {
        im.refuse(data.line, &format!("the increment {step} does not lead from node {first} to node {last}"));
        return None;
    }
    let count = (high - low) / step;
    Some((0..=count).map(|k| if first <= last { first + k * step } else { first - k * step }).collect())
}

/// `*NGEN`: nodes on the line between two.
pub fn between_nodes(im: &mut Importer, block: &KeywordBlock) {
    if block.keyword.has("LINE") {
        return im.refuse(block.keyword.line, "nodes on a straight line alone are made; write those of arcs");
    }
    let (known, offset) = (places(im), im.scopes.offset_here());
    let mut made = Vec::new();
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let (Some(first), Some(last)) = (im.id(data, 0), im.id(data, 1)) else { continue };
        let step = if data.filled() > 2 { im.id(data, 2).unwrap_or(1) } else { 1 };
        let Some(ids) = numbers(im, data, first, last, step) else { continue };
        let (Some(a), Some(b)) = (known.get(&(first + offset)), known.get(&(last + offset))) else {
            im.refuse(data.line, &format!("node {first} or node {last} does not exist before this line"));
            continue;
        };
        let parts = (ids.len() - 1).max(1) as f64;
        made.extend(ids.iter().enumerate().map(|(k, id)| (id + offset, a + (b - a) * (k as f64 / parts))));
    }
    let ends: Vec<u64> = made.iter().map(|node| node.0).filter(|id| known.contains_key(id)).collect();
    let new: Vec<(u64, Vec3)> = made.into_iter().filter(|node| !known.contains_key(&node.0)).collect();
    add(im, block, "NSET", &new);
    if let Some(set) = block.keyword.value("NSET") {
        im.scopes.here().node_sets.place(set).extend(ends);
    }
}

/// `*NFILL`: nodes between those of two sets.
pub fn between_sets(im: &mut Importer, block: &KeywordBlock) {
    if ["BIAS", "TWOSTEP", "SINGULAR"].iter().any(|name| block.keyword.has(name)) {
        return im.refuse(block.keyword.line, "nodes at even distances alone are made; write others");
    }
    let known = places(im);
    let mut made = Vec::new();
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let (Some(parts), Some(step)) = (im.id(data, 2), im.id(data, 3)) else { continue };
        let ends: Vec<_> = (0..2).map(|at| im.target(&data.words[at])).collect();
        let ids = |target| {
            let mut ids = im.scopes.members(target, Members::Nodes)?;
            ids.sort_unstable();
            ids.dedup();
            Some(ids)
        };
        let ends = ends.iter().map(ids).collect::<Option<Vec<_>>>();
        let Some([first, last]) = ends.as_deref() else {
            im.refuse(data.line, "no node set before this line has one of these names");
            continue;
        };
        let places = |ids: &[u64]| ids.iter().map(|id| known.get(id).copied()).collect::<Option<Vec<Vec3>>>();
        let (Some(from), Some(to)) = (places(first), places(last)) else {
            im.refuse(data.line, "a node of these sets does not exist before this line");
            continue;
        };
        if first.len() != last.len() || parts == 0 || parts * first.len() as u64 > MOST {
            im.refuse(data.line, "both sets need the same number of nodes, and one interval or more");
            continue;
        }
        for ((id, a), b) in first.iter().zip(from).zip(to) {
            made.extend((1..parts).map(|k| (id + k * step, a + (b - a) * (k as f64 / parts as f64))));
        }
    }
    add(im, block, "NSET", &made);
}

/// `*ELGEN`: rows and layers of elements like one.
pub fn rows_of_elements(im: &mut Importer, block: &KeywordBlock) {
    let offset = im.scopes.offset_here();
    let mut made: Vec<PlacedElement> = Vec::new();
    let mut all = Vec::new();
    for data in block.data.iter().filter(|data| data.filled() > 0) {
        let Some(id) = im.id(data, 0) else { continue };
        let Some(master) = im.scopes.here().cells.iter().find(|cell| cell.id == id + offset).cloned() else {
            im.refuse(data.line, &format!("element {id} does not exist before this line"));
            continue;
        };
        // Count, step of nodes, step of elements: along a row, over rows, over layers.
        let mut cells = vec![master];
        all.push(id + offset);
        for first in [1, 4, 7].into_iter().filter(|first| data.filled() > *first) {
            let mut read = |at: usize, blank: u64| {
                let is_blank = data.words.get(at).is_none_or(|word| word.bytes.is_empty());
                if is_blank { Some(blank) } else { im.id(data, at) }
            };
            let (Some(count), Some(nodes), Some(elements)) = (read(first, 1), read(first + 1, 1), read(first + 2, 1))
            else {
                continue;
            };
            if count == 0 || count.saturating_mul(cells.len() as u64) > MOST {
                im.refuse(data.line, "these are no elements, or too many");
                break;
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
        made.extend(cells.into_iter().skip(1));
    }
    all.extend(made.iter().map(|cell| cell.id));
    let set = block.keyword.value("ELSET").map(str::to_owned);
    let here = im.scopes.here();
    here.cells.extend(made);
    if let Some(set) = set {
        here.cell_sets.place(&set).extend(all);
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
    let ids = im.scopes.members(&target, of);
    if ids.is_none() {
        im.refuse(line, &format!("no set before this line is named `{}`", target.name));
    }
    ids
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
    let known = places(im);
    let made: Vec<(u64, Vec3)> = ids.iter().filter_map(|id| Some((id + change, place(known.get(id)?)))).collect();
    add(im, block, "NEWSET", &made);
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
    let wanted: std::collections::HashSet<u64> = ids.into_iter().collect();
    let set = block.keyword.value("NEWSET").map(str::to_owned);
    let here = im.scopes.here();
    let like = |cell: &PlacedElement| PlacedElement {
        id: cell.id + elements,
        nodes: cell.nodes.iter().map(|node| node + nodes).collect(),
        line: block.keyword.line,
        ..cell.clone()
    };
    let made: Vec<PlacedElement> = here.cells.iter().filter(|cell| wanted.contains(&cell.id)).map(like).collect();
    if let Some(set) = set {
        here.cell_sets.place(&set).extend(made.iter().map(|cell| cell.id));
    }
    here.cells.extend(made);
}
