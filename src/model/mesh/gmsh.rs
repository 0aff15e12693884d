//! Gmsh in ASCII, versions 4.1 and 2.2. The groups are the physical groups of dimension 0, 1 and 2. A group without a name is called
//! `physical_7` by its tag; if unnamed groups of several dimensions share the tag, it is called `physical_7_lines`.

use super::data::{CellShape, GroupKind, MOST_CELL_NODES};
use super::draft::{Draft, RawGroup};
use super::ids::short;
use base::math::{LARGEST_LENGTH, Vec3};
use base::text_file::{Fault, Text, TextLine, Word, Words};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// The meaning of an element type number.
enum ElementType {
    Point,
    Cell(CellShape),
    /// A type that is not read, by its name.
    Other(String),
}

/// The element type of a number.
fn element_type(number: u64) -> ElementType {
    ElementType::Other(match number {
        1 => return ElementType::Cell(CellShape::Segment),
        2 => return ElementType::Cell(CellShape::Triangle),
        3 => return ElementType::Cell(CellShape::Quadrilateral),
        8 => return ElementType::Cell(CellShape::CurvedSegment),
        9 => return ElementType::Cell(CellShape::CurvedTriangle),
        10 => return ElementType::Cell(CellShape::CurvedQuadrilateral),
        16 => return ElementType::Cell(CellShape::Serendipity),
        15 => return ElementType::Point,
        4 => "tetrahedra".to_owned(),
        5 => "hexahedra".to_owned(),
        6 => "prisms".to_owned(),
        7 => "pyramids".to_owned(),
        11 => "10-node tetrahedra".to_owned(),
        17 => "20-node hexahedra".to_owned(),
        other => format!("elements of type {other}"),
    })
}

/// Dimension and tag of a physical group.
type Physical = (u8, u64);

/// The physical groups of a file.
#[derive(Default)]
struct Groups {
    list: Vec<(Physical, RawGroup)>,
    /// Index in `list`.
    places: HashMap<Physical, usize>,
    names: HashMap<Physical, String>,
    /// The physical groups of an entity, and whether they reverse its elements; by dimension and tag.
    entities: HashMap<(u8, i64), (Vec<usize>, bool)>,
}

impl Groups {
    /// The index of a group; a new group is added.
    fn place(&mut self, dimension: u8, tag: u64) -> usize {
        let next = self.list.len();
        let place = *self.places.entry((dimension, tag)).or_insert(next);
        if place == next {
            self.list.push(((dimension, tag), RawGroup::default()));
        }
        place
    }

    /// The groups by name: those of one dimension with one name are one.
    fn named(mut self) -> Vec<RawGroup> {
        let alone = |&(dimension, tag): &Physical| {
            let same = |other: &Physical| other.1 == tag && other.0 != dimension && !self.names.contains_key(other);
            !self.places.keys().any(same)
        };
        let name = |key: &Physical| match self.names.get(key) {
            Some(name) => name.clone(),
            None if alone(key) => format!("physical_{}", key.1),
            None => format!("physical_{}_{}", key.1, ["points", "lines", "faces"][key.0.min(2) as usize]),
        };
        let names: Vec<String> = self.list.iter().map(|(key, _)| name(key)).collect();
        let mut groups: Vec<RawGroup> = Vec::new();
        let mut known: HashMap<(u8, String), usize> = HashMap::new();
        for (((dimension, _), group), name) in self.list.drain(..).zip(names) {
            let next = groups.len();
            let at = *known.entry((dimension, name.clone())).or_insert(next);
            if at == next {
                let kind = [GroupKind::Points, GroupKind::Lines, GroupKind::Faces][dimension.min(2) as usize];
                groups.push(RawGroup { name, kind, ..group });
            } else {
                groups[at].nodes.extend(group.nodes);
                groups[at].elements.extend(group.elements);
                groups[at].skipped += group.skipped;
            }
        }
        groups
    }
}

/// Reads the file into the draft.
///
/// # Errors
/// The first place where the file is not as its format says.
pub fn read(text: &mut Text, draft: &mut Draft) -> Result<(), Fault> {
    let four = format(text)?;
    let (mut groups, mut nodes, mut elements) = (Groups::default(), false, false);
    while let Some(line) = text.line() {
        let Some(name) = line.bytes.trim_ascii_start().strip_prefix(b"$") else {
            return Err(text.fault("this line belongs to no section", line.number));
        };
        match name {
            b"PhysicalNames" => names(text, &mut groups)?,
            b"Entities" if four => entities(text, &mut groups)?,
            b"PartitionedEntities" => return Err(text.fault("partitioned meshes are not read", line.number)),
            b"Nodes" | b"ParametricNodes" => {
                nodes = true;
                if four { nodes_4(text, draft)? } else { nodes_2(text, draft, name == b"ParametricNodes")? }
            }
            b"Elements" => {
                elements = true;
                if four { elements_4(text, draft, &mut groups)? } else { elements_2(text, draft, &mut groups)? }
            }
            other => {
                skip_section(text, draft, &String::from_utf8_lossy(other), line)?;
                continue;
            }
        }
        end(text, &String::from_utf8_lossy(name))?;
    }
    for (there, name) in [(nodes, "$Nodes"), (elements, "$Elements")] {
        if !there {
            return Err(text.fault_at_end(format!("the file has no {name}")));
        }
    }
    draft.groups = groups.named();
    Ok(())
}

/// The first section: true for version 4.1, false for 2.2.
fn format(text: &mut Text) -> Result<bool, Fault> {
    let mut first = text.line().ok_or_else(|| text.fault("the file is empty", 1))?;
    while first.bytes.trim_ascii_start() == b"$Comments" {
        skip_section(text, &mut Draft::default(), "Comments", first)?;
        first = text.line().ok_or_else(|| text.fault_at_end("the file has no $MeshFormat"))?;
    }
    if first.bytes.trim_ascii_start() != b"$MeshFormat" {
        return Err(text.fault("a Gmsh file begins with $MeshFormat", first.number));
    }
    let line = within(text, "MeshFormat")?;
    let mut words = Numbers::of(text, line);
    let version = words.word("the version")?;
    let four = match version.bytes {
        b"4.1" => true,
        b"2.2" | b"2.1" | b"2" => false,
        _ => {
            let mut fault =
                text.fault_at(format!("Gmsh format {} is not read; 4.1 and 2.2 are", version.text()), &version);
            fault.hints.push("write it with Mesh.MshFileVersion = 4.1".to_owned());
            return Err(fault);
        }
    };
    if words.whole("the file type")? != 0 {
        let mut fault = text.fault("binary Gmsh files are not read", line.number);
        fault.hints.push("write it with Mesh.Binary = 0".to_owned());
        return Err(fault);
    }
    end(text, "MeshFormat")?;
    Ok(four)
}

/// Passes over a section that is not read, up to its end.
fn skip_section(text: &mut Text, draft: &mut Draft, name: &str, line: TextLine) -> Result<(), Fault> {
    let close = format!("$End{name}");
    loop {
        match text.line() {
            Some(line) if line.bytes.trim_ascii_start() == close.as_bytes() => break,
            Some(_) => {}
            None => return Err(text.fault_at_end(format!("the file ends within ${name}"))),
        }
    }
    if name != "Comments" {
        draft.skip(&format!("${name}"), 1, line.number);
    }
    Ok(())
}

/// The next line of a section; an error where the section or the file ends.
fn within<'t>(text: &mut Text<'t>, section: &str) -> Result<TextLine<'t>, Fault> {
    match text.line() {
        Some(line) if line.bytes.trim_ascii_start().starts_with(b"$") => {
            Err(text.fault(format!("${section} has fewer lines than its counts require"), line.number))
        }
        Some(line) => Ok(line),
        None => Err(text.fault_at_end(format!("the file ends within ${section}"))),
    }
}

/// Reads the end of a section.
fn end(text: &mut Text, section: &str) -> Result<(), Fault> {
    match text.line() {
        Some(line) if line.bytes.trim_ascii_start().strip_prefix(b"$End") == Some(section.as_bytes()) => Ok(()),
        Some(line) => Err(text.fault(format!("$End{section} is missing here"), line.number)),
        None => Err(text.fault_at_end(format!("the file ends before $End{section}"))),
    }
}

/// The words of a line, read as numbers one after the other. `what` names the number in messages.
struct Numbers<'a, 't> {
    text: &'a Text<'t>,
    line: TextLine<'t>,
    words: Words<'t>,
}

impl<'a, 't> Numbers<'a, 't> {
    fn of(text: &'a Text<'t>, line: TextLine<'t>) -> Self {
        Numbers { text, line, words: line.words() }
    }

    fn word(&mut self, what: &str) -> Result<Word<'t>, Fault> {
        self.words.next().ok_or_else(|| self.text.fault(format!("this line lacks {what}"), self.line.number))
    }

    fn whole(&mut self, what: &str) -> Result<u64, Fault> {
        let word = self.word(what)?;
        word.whole().ok_or_else(|| self.text.fault_at(format!("{what} must be a whole number"), &word))
    }

    fn signed(&mut self, what: &str) -> Result<i64, Fault> {
        let word = self.word(what)?;
        word.signed().ok_or_else(|| self.text.fault_at(format!("{what} must be a whole number"), &word))
    }

    fn number(&mut self, what: &str) -> Result<f64, Fault> {
        let word = self.word(what)?;
        word.number().ok_or_else(|| self.text.fault_at(format!("{what} must be a finite number"), &word))
    }

    fn coordinate(&mut self, what: &str) -> Result<f64, Fault> {
        let word = self.word(what)?;
        let message = || format!("{what} must be a finite number, at most {LARGEST_LENGTH:e}");
        word.coordinate().ok_or_else(|| self.text.fault_at(message(), &word))
    }

    fn vector(&mut self) -> Result<Vec3, Fault> {
        Ok(Vec3::new(self.coordinate("x")?, self.coordinate("y")?, self.coordinate("z")?))
    }

    fn nodes(&mut self, kind: CellShape) -> Result<[u64; MOST_CELL_NODES], Fault> {
        let mut nodes = [0; MOST_CELL_NODES];
        for node in &mut nodes[..kind.size()] {
            *node = self.whole("a node")?;
        }
        Ok(nodes)
    }

    /// Makes sure that the line has no more words.
    fn end(mut self) -> Result<(), Fault> {
        match self.words.next() {
            Some(word) => Err(self.text.fault_at("this is one number too many", &word)),
            None => Ok(()),
        }
    }
}

/// Names of groups. A line has: dimension tag "name".
fn names(text: &mut Text, groups: &mut Groups) -> Result<(), Fault> {
    let line = within(text, "PhysicalNames")?;
    for _ in 0..Numbers::of(text, line).whole("the number of names")? {
        let line = within(text, "PhysicalNames")?;
        let mut words = Numbers::of(text, line);
        let (dimension, tag) = (words.whole("the dimension")?, words.signed("the tag")?);
        let quoted = String::from_utf8_lossy(line.bytes);
        let name = quoted.split_once('"').and_then(|(_, rest)| rest.rsplit_once('"')).map(|(name, _)| name);
        let Some(name) = name.filter(|name| !name.is_empty()) else {
            return Err(text.fault("this line lacks a name in quotes", line.number));
        };
        if dimension > 3 {
            return Err(text.fault("the dimension must lie between 0 and 3", line.number));
        }
        if dimension < 3 {
            let key = (dimension as u8, tag.unsigned_abs());
            groups.names.insert(key, name.to_owned());
            groups.place(key.0, key.1);
        }
    }
    Ok(())
}

/// The groups of entities. The line of a point has: tag x y z n groups…; that of others: tag, six bounds, n groups…, and the
/// entities on the boundary.
fn entities(text: &mut Text, groups: &mut Groups) -> Result<(), Fault> {
    let line = within(text, "Entities")?;
    let mut words = Numbers::of(text, line);
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = words.whole("a number of entities")?;
    }
    for (dimension, count) in counts.into_iter().enumerate() {
        for _ in 0..count {
            let line = within(text, "Entities")?;
            let mut words = Numbers::of(text, line);
            let tag = words.signed("the tag")?;
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                words.number("a coordinate")?;
            }
            let (mut places, mut turned) = (Vec::new(), true);
            for _ in 0..words.whole("the number of physical groups")? {
                // A negative group reverses the elements; version 2.2 writes them reversed.
                let group = words.signed("a physical group")?;
                turned &= group < 0;
                if dimension < 3 {
                    places.push(groups.place(dimension as u8, group.unsigned_abs()));
                }
            }
            let turned = turned && !places.is_empty();
            groups.entities.insert((dimension as u8, tag), (places, turned));
        }
    }
    Ok(())
}

/// Nodes of version 4.1: blocks by entity, each with all numbers, then all coordinates.
fn nodes_4(text: &mut Text, draft: &mut Draft) -> Result<(), Fault> {
    let line = within(text, "Nodes")?;
    let mut words = Numbers::of(text, line);
    let (blocks, all) = (words.whole("the number of blocks")?, words.whole("the number of nodes")?);
    let before = draft.nodes.len();
    let mut ids = Vec::new();
    for _ in 0..blocks {
        let line = within(text, "Nodes")?;
        let mut words = Numbers::of(text, line);
        words.signed("the dimension")?;
        words.signed("the entity")?;
        words.whole("the parametric flag")?;
        let count = words.whole("the number of nodes")?;
        words.end()?;
        ids.clear();
        for _ in 0..count {
            let line = within(text, "Nodes")?;
            let mut words = Numbers::of(text, line);
            ids.push((words.whole("a node")?, line.number));
            words.end()?;
        }
        for (id, at) in ids.drain(..) {
            let line = within(text, "Nodes")?;
            let x = Numbers::of(text, line).vector()?;
            draft.node(id, x, at);
        }
    }
    counted(text, line, "Nodes", "nodes", all, draft.nodes.len() - before)
}

/// Nodes of version 2.2. A line has: number x y z. Behind these `parametric` ones have the dimension of their entity, its tag, and a
/// parameter for each dimension below three.
fn nodes_2(text: &mut Text, draft: &mut Draft, parametric: bool) -> Result<(), Fault> {
    let section = if parametric { "ParametricNodes" } else { "Nodes" };
    let line = within(text, section)?;
    for _ in 0..Numbers::of(text, line).whole("the number of nodes")? {
        let line = within(text, section)?;
        let mut words = Numbers::of(text, line);
        let id = words.whole("a node")?;
        let x = words.vector()?;
        if parametric {
            let dimension = words.whole("the dimension")?;
            words.signed("the entity")?;
            for _ in 0..if dimension < 3 { dimension } else { 0 } {
                words.number("a parameter")?;
            }
        }
        words.end()?;
        draft.node(id, x, line.number);
    }
    Ok(())
}

/// Compares the announced number of nodes or elements with the number found.
fn counted(text: &Text, line: TextLine, section: &str, what: &str, said: u64, found: usize) -> Result<(), Fault> {
    if said == found as u64 {
        return Ok(());
    }
    Err(text.fault(format!("${section} announces {said} {what} and has {found}"), line.number))
}

/// Elements of version 4.1: blocks by entity, which gives the groups.
fn elements_4(text: &mut Text, draft: &mut Draft, groups: &mut Groups) -> Result<(), Fault> {
    let line = within(text, "Elements")?;
    let mut words = Numbers::of(text, line);
    let (blocks, all) = (words.whole("the number of blocks")?, words.whole("the number of elements")?);
    let mut found = 0;
    for _ in 0..blocks {
        let line = within(text, "Elements")?;
        let mut words = Numbers::of(text, line);
        let dimension = words.whole("the dimension")?;
        let entity = words.signed("the entity")?;
        let kind = element_type(words.whole("the type")?);
        let count = words.whole("the number of elements")?;
        words.end()?;
        let places = u8::try_from(dimension).ok().and_then(|dimension| groups.entities.get(&(dimension, entity)));
        let (places, turned) = places.map_or((&[][..], false), |(places, turned)| (places.as_slice(), *turned));
        for _ in 0..count {
            let line = within(text, "Elements")?;
            found += 1;
            let mut words = Numbers::of(text, line);
            let id = words.whole("an element")?;
            element(&mut words, (id, &kind), line, draft, (&mut groups.list, places))?;
            if let (ElementType::Cell(kind), Some(element), true) = (&kind, draft.elements.last_mut(), turned) {
                turn(*kind, &mut element.nodes);
            }
            if !matches!(kind, ElementType::Other(_)) {
                words.end()?;
            }
        }
    }
    counted(text, line, "Elements", "elements", all, found)
}

/// Turns an element over: its nodes go round the other way.
fn turn(kind: CellShape, nodes: &mut [u64; MOST_CELL_NODES]) {
    let n = kind.corners();
    nodes[..n].reverse();
    // The side between the first and the last corner keeps its place, and so does the middle.
    if kind.order() == 2 && n > 2 {
        nodes[n..2 * n - 1].reverse();
    }
}

/// Elements of version 2.2. A line has: number type n tags… nodes…; the first tag is the physical group, 0 for none.
fn elements_2(text: &mut Text, draft: &mut Draft, groups: &mut Groups) -> Result<(), Fault> {
    let line = within(text, "Elements")?;
    // An element of several groups is written once for each group, with other numbers.
    let mut known: HashMap<(CellShape, [u64; MOST_CELL_NODES]), u32, BuildHasherDefault<Mix>> = HashMap::default();
    for _ in 0..Numbers::of(text, line).whole("the number of elements")? {
        let line = within(text, "Elements")?;
        let mut words = Numbers::of(text, line);
        let id = words.whole("an element")?;
        let kind = element_type(words.whole("the type")?);
        let mut physical = 0;
        for tag in 0..words.whole("the number of tags")? {
            let value = words.signed("a tag")?.unsigned_abs();
            if tag == 0 {
                physical = value;
            }
        }
        let dimension = match &kind {
            ElementType::Point => Some(0),
            ElementType::Cell(kind) => Some(if kind.is_line() { 1 } else { 2 }),
            ElementType::Other(_) => None,
        };
        let place = dimension.filter(|_| physical > 0).map(|dimension| groups.place(dimension, physical));
        if let ElementType::Cell(kind) = kind {
            let nodes = words.nodes(kind)?;
            words.end()?;
            let element = match place {
                Some(_) => *known.entry((kind, nodes)).or_insert_with(|| draft.element(id, kind, nodes, line.number)),
                None => draft.element(id, kind, nodes, line.number),
            };
            if let Some(place) = place {
                groups.list[place].1.elements.push(element);
            }
            continue;
        }
        element(&mut words, (id, &kind), line, draft, (&mut groups.list, place.as_slice()))?;
    }
    Ok(())
}

/// A hash for numbers that are not chosen to collide: a million elements take a second less than with the standard one.
#[derive(Default)]
struct Mix(u64);

impl Hasher for Mix {
    fn finish(&self) -> u64 {
        // Multiplication mixes the high bits, and tables use the low ones.
        self.0 ^ (self.0 >> 32)
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.0 = (self.0.rotate_left(5) ^ u64::from_le_bytes(word)).wrapping_mul(0x517c_c1b7_2722_0a95);
        }
    }
}

/// Reads the nodes of an element and adds it to the draft and to the groups at `places`.
fn element(
    words: &mut Numbers,
    (id, kind): (u64, &ElementType),
    line: TextLine,
    draft: &mut Draft,
    (groups, places): (&mut [(Physical, RawGroup)], &[usize]),
) -> Result<(), Fault> {
    match kind {
        ElementType::Point => {
            let node = words.whole("a node")?;
            places.iter().for_each(|&place| groups[place].1.nodes.push((node, short(line.number))));
        }
        ElementType::Cell(kind) => {
            let nodes = words.nodes(*kind)?;
            let element = draft.element(id, *kind, nodes, line.number);
            places.iter().for_each(|&place| groups[place].1.elements.push(element));
        }
        ElementType::Other(what) => {
            draft.skip(what, 1, line.number);
            places.iter().for_each(|&place| groups[place].1.skipped += 1);
        }
    }
    Ok(())
}
