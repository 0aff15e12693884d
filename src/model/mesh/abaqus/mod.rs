//! The part of Abaqus and CalculiX input that describes a mesh: nodes, elements, sets, parts and their instances. Case has no
//! meaning in keywords and names. Keywords that make other nodes, elements or sets are errors; all others are skipped with their
//! lines and listed.

mod blocks;
mod flatten;
mod sets;
mod types;

use super::data::{CellShape, MOST_CELL_NODES};
use super::draft::{Draft, RawElement};
use super::ids::short;
use base::math::{LARGEST_LENGTH, Vec3};
use base::text_file::cards::{Card, Cards, Data, Keyword, name_in};
use base::text_file::{Fault, Text};
use blocks::{Blocks, Instance};
use sets::{BlockIndex, Member, SetIndex, SetKind};

/// Keywords refused, with their effect on the mesh.
const CHANGES: [(&str, &str); 8] = [
    ("NGEN", "makes nodes"),
    ("NFILL", "makes nodes"),
    ("NCOPY", "makes nodes"),
    ("NMAP", "moves nodes"),
    ("ELGEN", "makes elements"),
    ("ELCOPY", "makes elements"),
    ("SYSTEM", "moves nodes"),
    ("PARAMETER", "stands for numbers"),
];
/// Parameters refused, by keyword: the value without effect, and the effect of other values on the mesh.
const PARAMETERS: [(&str, &str, &str, &str); 3] = [
    ("NODE", "SYSTEM", "R", "moves nodes"),
    ("ELEMENT", "OFFSET", "0", "makes other numbers"),
    ("INSTANCE", "LIBRARY", "", "reads another file"),
];
/// Parameters without a value; they may follow a comma on a separate line.
const FLAGS: &[&str] = &["GENERATE", "INTERNAL", "UNSORTED"];
/// The remedy for unsupported features.
const FLAT: &str = "write the mesh as one flat file that lists every node and element";

/// The meaning of the data lines after a keyword.
enum DataLines {
    Skipped,
    Nodes {
        set: Option<usize>,
    },
    Elements {
        what: ElementType,
        set: Option<usize>,
    },
    /// Numbers and names of sets, in the instance if one is given.
    Set {
        set: usize,
        kind: SetKind,
        generate: bool,
        instance: Option<usize>,
    },
    /// The position of a part in an assembly.
    Position,
}

/// A type of element.
struct ElementType {
    name: String,
    /// `None` for one that is not read.
    shape: Option<CellShape>,
    /// Fields of an element at least.
    fields: usize,
}

impl ElementType {
    fn new(name: &str) -> Self {
        let name = name.to_ascii_uppercase();
        let shape = types::shape(&name);
        let nodes = shape.map(CellShape::size).or_else(|| types::nodes_of_other(&name));
        ElementType { name, shape, fields: 1 + nodes.unwrap_or(0) }
    }

    /// True where a further node may give the direction of the section.
    fn takes_direction(&self) -> bool {
        self.name.starts_with(['B', 'P'])
    }
}

/// Reads the file into the draft.
///
/// # Errors
/// The first error of format, or the first unsupported way to make nodes, elements or sets.
pub fn read(text: &mut Text, draft: &mut Draft) -> Result<(), Fault> {
    let mut cards = Cards::new(text, FLAGS);
    let (mut assembly, mut lines) = (Blocks::default(), DataLines::Skipped);
    while let Some(card) = cards.card() {
        let mut data = match card {
            Card::Keyword(keyword) => {
                lines = begin(cards.text, draft, &mut assembly, &keyword)?;
                continue;
            }
            Card::Data(data) => data,
        };
        if let DataLines::Elements { what, .. } = &lines {
            cards.complete(&mut data, what.fields);
        }
        match &lines {
            DataLines::Skipped => {}
            DataLines::Position => position(cards.text, &mut assembly, &data)?,
            DataLines::Nodes { set } => node(cards.text, &mut assembly, &data, *set)?,
            DataLines::Elements { what, set } => element(cards.text, draft, &mut assembly, &data, (what, *set))?,
            DataLines::Set { set, kind, generate, instance } => {
                let read = match generate {
                    true => vec![range(cards.text, &data, *instance)?],
                    false => members(cards.text, &assembly, &data, (*set, *kind, *instance))?,
                };
                assembly.block_mut().sets.list[*set].members.extend(read);
            }
        }
    }
    flatten::flatten(cards.text, draft, assembly)
}

/// An error with its remedy.
fn refused(mut fault: Fault, hint: &str) -> Fault {
    fault.hints.push(hint.to_owned());
    fault
}

/// The meaning of the data lines of a keyword.
fn begin(text: &Text, draft: &mut Draft, assembly: &mut Blocks, keyword: &Keyword) -> Result<DataLines, Fault> {
    let (name, key) = (&keyword.name, keyword.key());
    check(text, keyword, &key)?;
    let lacks = |what: &str| text.fault(format!("*{name} needs {what}="), keyword.line);
    Ok(match key.as_str() {
        "NODE" => DataLines::Nodes { set: keyword.value("NSET").map(|set| assembly.place(SetKind::Nodes, set)) },
        "ELEMENT" => {
            let what = ElementType::new(keyword.value("TYPE").ok_or_else(|| lacks("TYPE"))?);
            let set = keyword.value("ELSET").map(|set| assembly.place(SetKind::Elements, set));
            DataLines::Elements { what, set }
        }
        "NSET" | "ELSET" => {
            let kind = if key == "NSET" { SetKind::Nodes } else { SetKind::Elements };
            let set = assembly.place(kind, keyword.value(&key).ok_or_else(|| lacks(&key))?);
            begin_set(text, assembly, keyword, (set, kind))?
        }
        "PART" => {
            assembly.begin_part(keyword.value("NAME").unwrap_or_default());
            DataLines::Skipped
        }
        "INSTANCE" => {
            let part = keyword.value("PART").ok_or_else(|| lacks("PART"))?;
            let begun = assembly.begin_instance(keyword.value("NAME").unwrap_or(part), part, keyword.line);
            begun.ok_or_else(|| keyword.fault(text, "PART", format!("no part before this line is named `{part}`")))?;
            DataLines::Position
        }
        "ASSEMBLY" | "ENDPART" | "ENDINSTANCE" | "ENDASSEMBLY" => {
            assembly.at = BlockIndex::Root;
            if let Some(name) = keyword.value("NAME") {
                assembly.root.name = name.to_owned();
            }
            DataLines::Skipped
        }
        "HEADING" => DataLines::Skipped,
        "INCLUDE" => return Err(lacks("INPUT")),
        _ => {
            draft.skip(&format!("*{name}"), 1, keyword.line);
            DataLines::Skipped
        }
    })
}

/// Refuses keywords that make nodes, elements or sets in an unsupported way.
fn check(text: &Text, keyword: &Keyword, key: &str) -> Result<(), Fault> {
    let name = &keyword.name;
    if let Some((_, what)) = CHANGES.iter().find(|(word, _)| *word == key) {
        return Err(refused(text.fault(format!("*{name} {what}, and is not read"), keyword.line), FLAT));
    }
    let changes = |(word, parameter, nothing, _): &&(&str, &str, &str, &str)| {
        let means_nothing = || keyword.value(parameter).is_some_and(|value| value.eq_ignore_ascii_case(nothing));
        *word == key && keyword.has(parameter) && !means_nothing()
    };
    if let Some((_, parameter, _, what)) = PARAMETERS.iter().find(changes) {
        let message = format!("{parameter} of *{name} {what}, and is not read");
        return Err(refused(keyword.fault(text, parameter, message), FLAT));
    }
    Ok(())
}

/// Begins a set: its instance, and the elements whose nodes it holds.
fn begin_set(
    text: &Text,
    assembly: &mut Blocks,
    keyword: &Keyword,
    (set, kind): (usize, SetKind),
) -> Result<DataLines, Fault> {
    let instance = match keyword.value("INSTANCE") {
        None => None,
        Some(name) => {
            let message = || keyword.fault(text, "INSTANCE", format!("no instance before this line is named `{name}`"));
            Some(assembly.instance(name).ok_or_else(message)?)
        }
    };
    if kind == SetKind::Nodes
        && let Some(name) = keyword.value("ELSET")
    {
        let found = assembly.refer(instance, SetKind::Elements, name);
        let message = || keyword.fault(text, "ELSET", unknown(assembly, instance, SetKind::Elements, name));
        let member = Member::NodesOf(found.ok_or_else(message)?, short(keyword.line));
        assembly.block_mut().sets.list[set].members.push(member);
    }
    Ok(DataLines::Set { set, kind, generate: keyword.has("GENERATE"), instance })
}

/// The message for an unknown set.
fn unknown(assembly: &Blocks, instance: Option<usize>, kind: SetKind, name: &str) -> String {
    let (what, other, others) = match kind {
        SetKind::Nodes => ("node", SetKind::Elements, "an element"),
        SetKind::Elements => ("element", SetKind::Nodes, "a node"),
    };
    match assembly.refer(instance, other, name) {
        Some(_) => format!("no {what} set is named `{name}`, which is {others} set"),
        None => format!("no {what} set before this line is named `{name}`"),
    }
}

/// A whole number among the words of a line.
fn number(text: &Text, data: &Data, at: usize) -> Result<u64, Fault> {
    let word = data.words.get(at).ok_or_else(|| text.fault("this line lacks a number", data.line))?;
    word.whole().ok_or_else(|| text.fault_at("this must be a whole number", word))
}

/// Coordinates among the words of a line; blank ones are zero.
fn vector(text: &Text, data: &Data, first: usize) -> Result<Vec3, Fault> {
    let mut x = Vec3::zeros();
    let words = data.words.iter().skip(first).take(3).enumerate();
    for (i, word) in words.filter(|(_, word)| !word.bytes.is_empty()) {
        let message = || format!("a coordinate must be a finite number, at most {LARGEST_LENGTH:e}");
        let read = word.fortran_number().filter(|x| x.abs() <= LARGEST_LENGTH);
        x[i] = read.ok_or_else(|| text.fault_at(message(), word))?;
    }
    Ok(x)
}

/// Reads a node: number, x, y, z.
fn node(text: &Text, assembly: &mut Blocks, data: &Data, set: Option<usize>) -> Result<(), Fault> {
    let id = number(text, data, 0)?;
    let (x, line) = (vector(text, data, 1)?, short(data.line));
    let block = assembly.block_mut();
    block.nodes.push((id, x, line));
    if let Some(set) = set {
        block.sets.list[set].members.push(Member::Number(id, None, line));
    }
    Ok(())
}

/// Reads an element: number, nodes.
fn element(
    text: &Text,
    draft: &mut Draft,
    assembly: &mut Blocks,
    data: &Data,
    (what, set): (&ElementType, Option<usize>),
) -> Result<(), Fault> {
    let (id, line) = (number(text, data, 0)?, short(data.line));
    let block = assembly.block_mut();
    if let Some(set) = set {
        block.sets.list[set].members.push(Member::Number(id, None, line));
    }
    let Some(kind) = what.shape else {
        draft.skip(&format!("elements of type {}", what.name), 1, data.line);
        block.others.push(id);
        return Ok(());
    };
    let count = data.filled() - 1;
    let directed = kind.is_line() && what.takes_direction() && count == kind.size() + 1;
    if count != kind.size() && !directed {
        let message = format!("element {id} has {count} nodes; {} has {}", what.name, kind.size());
        return Err(text.fault(message, data.line));
    }
    let mut nodes = [0; MOST_CELL_NODES];
    for (i, node) in nodes[..kind.size()].iter_mut().enumerate() {
        *node = number(text, data, 1 + i)?;
    }
    // Here the node between the ends of a line comes second.
    if kind == CellShape::CurvedSegment {
        nodes.swap(1, 2);
    }
    let toward = if directed { Some(number(text, data, count)?) } else { None };
    let (kind, nodes) = without_repeated_corner(kind, nodes);
    block.elements.push(RawElement { id, kind, nodes, toward, line });
    Ok(())
}

/// A quadrilateral that has a corner twice is a triangle.
fn without_repeated_corner(kind: CellShape, nodes: [u64; MOST_CELL_NODES]) -> (CellShape, [u64; MOST_CELL_NODES]) {
    let repeated = |&i: &usize| nodes[i] == nodes[(i + 1) % 4];
    if kind != CellShape::Quadrilateral || (0..4).filter(repeated).count() != 1 {
        return (kind, nodes);
    }
    let mut corners = [0; MOST_CELL_NODES];
    let kept = (0..4).filter(|i| !repeated(i)).map(|i| nodes[i]);
    corners.iter_mut().zip(kept).for_each(|(corner, node)| *corner = node);
    (CellShape::Triangle, corners)
}

/// Reads where an instance stands: a translation, then two points of an axis and an angle in degrees about it.
fn position(text: &Text, assembly: &mut Blocks, data: &Data) -> Result<(), Fault> {
    let BlockIndex::Instance(at) = assembly.at else { return Ok(()) };
    let [first, second] = [vector(text, data, 0)?, vector(text, data, 3)?];
    let instance: &mut Instance = &mut assembly.instances[at];
    instance.rows += 1;
    match instance.rows {
        1 => instance.translation = first,
        2 => {
            let angle = data.words.get(6).and_then(|word| word.fortran_number());
            let angle = angle.ok_or_else(|| text.fault("this line needs two points and an angle", data.line))?;
            let turned = instance.turn(first, second, angle);
            turned.ok_or_else(|| text.fault("the two points of the axis coincide", data.line))?;
        }
        _ => return Err(text.fault("an instance can have a translation and a rotation, on two lines", data.line)),
    }
    Ok(())
}

/// Reads first, last and step of numbers in a set.
fn range(text: &Text, data: &Data, instance: Option<usize>) -> Result<Member, Fault> {
    let (first, last) = (number(text, data, 0)?, number(text, data, 1)?);
    let step = if data.filled() > 2 { number(text, data, 2)? } else { 1 };
    if step == 0 || last < first {
        return Err(text.fault("first, last and step must count upwards", data.line));
    }
    Ok(Member::Range([first, last, step], instance, short(data.line)))
}

/// Reads members of a set: numbers and names of sets, also with those of their instances.
fn members(
    text: &Text,
    assembly: &Blocks,
    data: &Data,
    (set, kind, instance): (usize, SetKind, Option<usize>),
) -> Result<Vec<Member>, Fault> {
    let mut read = Vec::new();
    for word in data.words.iter().filter(|word| !word.bytes.is_empty()) {
        if let Some(id) = word.whole() {
            read.push(Member::Number(id, instance, short(data.line)));
            continue;
        }
        let name = name_in(word);
        let itself = SetIndex { block: assembly.at, instance: None, set };
        let other = assembly.refer(instance, kind, &name).filter(|&other| other != itself);
        match (other, assembly.number_in_instance(&name)) {
            (Some(other), _) => read.push(Member::Set(other)),
            (None, Some((instance, id))) => read.push(Member::Number(id, Some(instance), short(data.line))),
            (None, None) => return Err(text.fault_at(unknown(assembly, instance, kind, &name), word)),
        }
    }
    Ok(read)
}
