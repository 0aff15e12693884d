//! The part of Abaqus and CalculiX input that describes a mesh: *NODE, *ELEMENT, *NSET, *ELSET. Keywords and names of sets are
//! not case-sensitive; a set of nodes and a set of elements of the same name are one group. At most one part is read, with one
//! instance that is not moved. Keywords that make other nodes, elements or sets are errors; all others are skipped with their
//! lines and listed.

use super::data::{CellShape, MOST_CELL_NODES};
use super::draft::{Draft, RawGroup};
use super::ids::{Ids, short};
use crate::math::{LARGEST_LENGTH, Vec3};
use crate::text_file::{Fault, Text, TextLine, Word};
use std::collections::HashMap;

/// The shape of an element type that is read.
fn cell_shape(name: &str) -> Option<CellShape> {
    match name {
        "B31" => Some(CellShape::Segment),
        "S3" | "S3R" => Some(CellShape::Triangle),
        "S4" | "S4R" => Some(CellShape::Quadrilateral),
        "B32" => Some(CellShape::CurvedSegment),
        "S6" | "STRI65" => Some(CellShape::CurvedTriangle),
        "S8" | "S8R" | "S8R5" => Some(CellShape::Serendipity),
        "S9R5" => Some(CellShape::CurvedQuadrilateral),
        _ => None,
    }
}

/// Keywords that are errors, with what they do to the mesh.
const CHANGES: [(&str, &str); 9] = [
    ("INCLUDE", "reads another file"),
    ("NGEN", "makes nodes"),
    ("NFILL", "makes nodes"),
    ("NCOPY", "makes nodes"),
    ("NMAP", "moves nodes"),
    ("ELGEN", "makes elements"),
    ("ELCOPY", "makes elements"),
    ("SYSTEM", "moves nodes"),
    ("PARAMETER", "stands for numbers"),
];
/// Options of keywords that are errors, with what they do to the mesh.
const OPTIONS: [(&str, &str, &str); 8] = [
    ("NODE", "INPUT", "reads another file"),
    ("NODE", "SYSTEM", "moves nodes"),
    ("ELEMENT", "INPUT", "reads another file"),
    ("ELEMENT", "OFFSET", "makes other numbers"),
    ("NSET", "INPUT", "reads another file"),
    ("NSET", "ELSET", "makes a set of nodes of elements"),
    ("ELSET", "INPUT", "reads another file"),
    ("INSTANCE", "LIBRARY", "reads another file"),
];
/// The remedy for these.
const FLAT: &str = "write the mesh as one flat file: every node and element by itself";

/// Members of a set as the file gives them.
enum Member {
    /// First, last and step, and the line.
    Numbers(u64, u64, u64, u32),
    /// All members of another set, by index.
    Set(usize),
}

/// What the data lines after a keyword describe.
enum DataLines {
    Skipped,
    Nodes {
        set: Option<usize>,
    },
    Elements {
        kind: Option<CellShape>,
        what: String,
        set: Option<usize>,
    },
    Set {
        set: usize,
        nodes: bool,
        generate: bool,
    },
    /// The position of a part in an assembly.
    Instance,
}

/// The sets of the file.
#[derive(Default)]
struct Sets {
    /// Index in `list`, by the name in lower case.
    names: HashMap<String, usize>,
    list: Vec<Set>,
}

/// A set of nodes, of elements, or both.
#[derive(Default)]
struct Set {
    name: String,
    nodes: Vec<Member>,
    elements: Vec<Member>,
}

impl Sets {
    fn find(&self, name: &str) -> Option<usize> {
        self.names.get(&name.to_ascii_lowercase()).copied()
    }

    /// The index of a set, which is added where it is new.
    fn place(&mut self, name: &str) -> usize {
        let next = self.list.len();
        let place = *self.names.entry(name.to_ascii_lowercase()).or_insert(next);
        if place == next {
            self.list.push(Set { name: name.to_owned(), ..Set::default() });
        }
        place
    }
}

/// Reads the file into the draft.
///
/// # Errors
/// The first place where the file is not as its format says, or makes nodes, elements or sets in a way that is not read.
pub fn read(text: &mut Text, draft: &mut Draft) -> Result<(), Fault> {
    let (mut sets, mut block, mut others) = (Sets::default(), DataLines::Skipped, Vec::new());
    let mut frame = Frame::default();
    let mut next = content(text);
    while let Some(line) = next {
        next = content(text);
        let words = continued(text, &block, line, &mut next);
        if line.bytes.starts_with(b"*") {
            block = keyword(text, draft, &mut sets, &mut frame, line, &words)?;
            continue;
        }
        match &block {
            DataLines::Skipped => {}
            DataLines::Instance => {
                return Err(refused(text, "an instance that is moved is not read", line.number, ONE));
            }
            DataLines::Nodes { set } => node(text, draft, &mut sets, line, &words, *set)?,
            DataLines::Elements { kind, what, set } => {
                let read = element(text, draft, &mut sets, line, &words, (*kind, what, *set))?;
                others.extend(read.err());
            }
            DataLines::Set { set, nodes, generate } => {
                members(text, &mut sets, line, &words, (*set, *nodes, *generate))?
            }
        }
    }
    resolve(text, draft, &sets, others)
}

/// The words of a line and of those that continue it: after a last comma a keyword goes on, or an element that lacks nodes. `next`
/// is the line after the last.
fn continued<'t>(
    text: &mut Text<'t>,
    block: &DataLines,
    line: TextLine<'t>,
    next: &mut Option<TextLine<'t>>,
) -> Vec<Word<'t>> {
    let mut words: Vec<Word> = line.fields().collect();
    let keyword = line.bytes.starts_with(b"*");
    let wants = match block {
        _ if keyword => usize::MAX,
        DataLines::Elements { kind, .. } => kind.map_or(usize::MAX, |kind| 1 + kind.size()),
        _ => 0,
    };
    let mut last = line;
    while words.len() < wants && last.bytes.ends_with(b",") {
        let Some(more) = next.filter(|more| !more.bytes.starts_with(b"*")) else { break };
        words.extend(more.fields());
        last = more;
        *next = content(text);
    }
    // Blank fields at the end have no meaning, except as coordinates.
    let trims = !keyword && !matches!(block, DataLines::Nodes { .. });
    while trims && words.len() > 1 && words.last().is_some_and(|word| word.bytes.is_empty()) {
        words.pop();
    }
    words
}

/// Reads a node: number, x, y, z.
fn node(
    text: &Text,
    draft: &mut Draft,
    sets: &mut Sets,
    line: TextLine,
    words: &[Word],
    set: Option<usize>,
) -> Result<(), Fault> {
    let id = number(text, words, 0, line)?;
    let mut x = Vec3::zeros();
    // A blank coordinate is zero.
    for (i, word) in words.iter().enumerate().skip(1).take(3).filter(|(_, word)| !word.bytes.is_empty()) {
        let message = || format!("a coordinate must be a finite number, at most {LARGEST_LENGTH:e}");
        x[i - 1] = word.coordinate().ok_or_else(|| text.fault_at(message(), word))?;
    }
    if words.len() < 2 {
        return Err(text.fault(format!("node {id} has no coordinates"), line.number));
    }
    draft.node(id, x, line.number);
    if let Some(set) = set {
        sets.list[set].nodes.push(Member::Numbers(id, id, 1, short(line.number)));
    }
    Ok(())
}

/// Reads an element: number, nodes. Gives the number of one whose type `what` is not read as the inner error.
fn element(
    text: &Text,
    draft: &mut Draft,
    sets: &mut Sets,
    line: TextLine,
    words: &[Word],
    (kind, what, set): (Option<CellShape>, &str, Option<usize>),
) -> Result<Result<(), u64>, Fault> {
    let id = number(text, words, 0, line)?;
    if let Some(set) = set {
        sets.list[set].elements.push(Member::Numbers(id, id, 1, short(line.number)));
    }
    let Some(kind) = kind else {
        draft.skip(&format!("elements of type {what}"), 1, line.number);
        return Ok(Err(id));
    };
    if words.len() != 1 + kind.size() {
        let message = format!("element {id} has {} nodes; {what} has {}", words.len() - 1, kind.size());
        return Err(text.fault(message, line.number));
    }
    let mut nodes = [0; MOST_CELL_NODES];
    for (i, node) in nodes[..kind.size()].iter_mut().enumerate() {
        *node = number(text, words, 1 + i, line)?;
    }
    // Here the node between the ends of a line comes second.
    if kind == CellShape::CurvedSegment {
        nodes.swap(1, 2);
    }
    draft.element(id, kind, nodes, line.number);
    Ok(Ok(()))
}

/// The next line that is not a comment.
fn content<'t>(text: &mut Text<'t>) -> Option<TextLine<'t>> {
    std::iter::from_fn(|| text.line()).find(|line| !line.bytes.starts_with(b"**"))
}

/// The number of parts and instances read so far.
#[derive(Default)]
struct Frame {
    parts: usize,
    instances: usize,
}

/// The remedy for several parts, or for instances that are moved.
const ONE: &str = "write the mesh as one part, where it stands";

/// An error with its remedy.
fn refused(text: &Text, message: impl Into<String>, line: usize, hint: &str) -> Fault {
    let mut fault = text.fault(message, line);
    fault.hints.push(hint.to_owned());
    fault
}

/// A whole number among the words of a line.
fn number(text: &Text, words: &[Word], at: usize, line: TextLine) -> Result<u64, Fault> {
    let word = words.get(at).ok_or_else(|| text.fault("this line lacks a number", line.number))?;
    word.whole().ok_or_else(|| text.fault_at("this must be a whole number", word))
}

/// Reads a keyword line, *NAME, KEY=VALUE, KEY …, and says what its data lines describe.
fn keyword(
    text: &Text,
    draft: &mut Draft,
    sets: &mut Sets,
    frame: &mut Frame,
    line: TextLine,
    words: &[Word],
) -> Result<DataLines, Fault> {
    let first = words.first().map(|word| word.text()).unwrap_or_default();
    let name = first.trim_start_matches('*').split_whitespace().collect::<Vec<_>>().join(" ").to_ascii_uppercase();
    let value = |key: &str| {
        words[1..].iter().find_map(|word| {
            let text = word.text();
            let (found, value) = text.split_once('=')?;
            let value = value.trim().trim_matches('"').to_owned();
            (found.trim().eq_ignore_ascii_case(key) && !value.is_empty()).then_some(value)
        })
    };
    let flag = |key: &str| words[1..].iter().any(|word| word.text().eq_ignore_ascii_case(key));
    let lacks = |key: &str| text.fault(format!("*{name} needs {key}="), line.number);
    if let Some((_, what)) = CHANGES.iter().find(|(word, _)| *word == name) {
        return Err(refused(text, format!("*{name} {what}, and is not read"), line.number, FLAT));
    }
    let has = |key: &str| flag(key) || value(key).is_some();
    if let Some((_, key, what)) = OPTIONS.iter().find(|(word, key, _)| *word == name && has(key)) {
        return Err(refused(text, format!("{key} of *{name} {what}, and is not read"), line.number, FLAT));
    }
    Ok(match name.as_str() {
        "NODE" => DataLines::Nodes { set: value("NSET").map(|set| sets.place(&set)) },
        "ELEMENT" => {
            let what = value("TYPE").ok_or_else(|| lacks("TYPE"))?.to_ascii_uppercase();
            DataLines::Elements { kind: cell_shape(&what), what, set: value("ELSET").map(|set| sets.place(&set)) }
        }
        "NSET" | "ELSET" => {
            let set = sets.place(&value(&name).ok_or_else(|| lacks(&name))?);
            DataLines::Set { set, nodes: name == "NSET", generate: flag("GENERATE") }
        }
        "PART" | "INSTANCE" => {
            let count = if name == "PART" { &mut frame.parts } else { &mut frame.instances };
            *count += 1;
            if *count > 1 {
                return Err(refused(text, format!("a second *{name} is not read"), line.number, ONE));
            }
            if name == "PART" { DataLines::Skipped } else { DataLines::Instance }
        }
        // These keywords hold nothing that could be lost.
        "HEADING" | "END PART" | "ASSEMBLY" | "END ASSEMBLY" | "END INSTANCE" => DataLines::Skipped,
        _ => {
            draft.skip(&format!("*{name}"), 1, line.number);
            DataLines::Skipped
        }
    })
}

/// Reads members of a set: numbers and names of sets, or, with `generate`, first, last and step.
fn members(
    text: &Text,
    sets: &mut Sets,
    line: TextLine,
    words: &[Word],
    (set, nodes, generate): (usize, bool, bool),
) -> Result<(), Fault> {
    let at = short(line.number);
    let mut read = Vec::new();
    if generate {
        let (first, last) = (number(text, words, 0, line)?, number(text, words, 1, line)?);
        let step = if words.len() > 2 { number(text, words, 2, line)? } else { 1 };
        if step == 0 || last < first {
            return Err(text.fault("first, last and step must count upwards", line.number));
        }
        read.push(Member::Numbers(first, last, step, at));
    } else {
        for word in words.iter().filter(|word| !word.bytes.is_empty()) {
            read.push(match word.whole() {
                Some(id) => Member::Numbers(id, id, 1, at),
                None => {
                    let name = word.text();
                    let message = || text.fault_at(format!("no set is named `{name}`"), word);
                    Member::Set(sets.find(name.trim_matches('"')).filter(|&other| other != set).ok_or_else(message)?)
                }
            });
        }
    }
    if nodes { &mut sets.list[set].nodes } else { &mut sets.list[set].elements }.extend(read);
    Ok(())
}

/// Adds the sets as groups to the draft. `others`: numbers of the elements that were skipped.
fn resolve(text: &Text, draft: &mut Draft, sets: &Sets, others: Vec<u64>) -> Result<(), Fault> {
    let (elements, _) = Ids::new(draft.elements.iter().map(|element| element.id));
    let (others, _) = Ids::new(others.iter().copied());
    let (nodes, _) = Ids::new(draft.nodes.iter().map(|node| node.id));
    // The first missing number ends it, so that a typing error in a last number does not take hours.
    let missing = |what: &str, id: u64, set: usize, line: u32| {
        let message = format!("set `{}` holds {what} {id}, which does not exist", sets.list[set].name);
        Err(text.fault_on(message, line as usize, Some(id)))
    };
    for index in 0..sets.list.len() {
        let mut group = RawGroup { name: sets.list[index].name.clone(), ..RawGroup::default() };
        each(sets, index, true, &mut |id, line| {
            group.nodes.push((id, line));
            if nodes.get(id).is_some() { Ok(()) } else { missing("node", id, index, line) }
        })?;
        each(sets, index, false, &mut |id, line| {
            match (elements.get(id), others.get(id)) {
                (Some(element), _) => group.elements.push(short(element)),
                (None, Some(_)) => group.skipped += 1,
                (None, None) => return missing("element", id, index, line),
            }
            Ok(())
        })?;
        draft.groups.push(group);
    }
    Ok(())
}

/// Calls `take` for each number in a set and in the sets that it holds, each of these once.
fn each(
    sets: &Sets,
    set: usize,
    nodes: bool,
    take: &mut impl FnMut(u64, u32) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let (mut todo, mut seen) = (vec![set], vec![false; sets.list.len()]);
    while let Some(set) = todo.pop() {
        if std::mem::replace(&mut seen[set], true) {
            continue;
        }
        let set = &sets.list[set];
        for member in if nodes { &set.nodes } else { &set.elements } {
            match member {
                Member::Set(other) => todo.push(*other),
                Member::Numbers(first, last, step, line) => {
                    (*first..=*last).step_by(*step as usize).try_for_each(|id| take(id, *line))?;
                }
            }
        }
    }
    Ok(())
}
