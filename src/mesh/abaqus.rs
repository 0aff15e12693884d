//! The part of Abaqus and CalculiX input that describes a mesh: *NODE, *ELEMENT, *NSET, *ELSET. Keywords and the names of
//! sets count whatever their case; a set of nodes and one of elements that share a name are one group. A part in an assembly is
//! read where there is one, and one instance of it that is not moved. What would make other nodes, elements or sets of the
//! mesh is an error; every other keyword is skipped with its lines, and said to be.

use super::Kind;
use super::draft::{Draft, Ids, RawGroup, short};
use super::text::{Fault, Line, Text, Word};
use crate::math::Vec3;
use std::collections::HashMap;

fn of(name: &str) -> Option<Kind> {
    match name {
        "B31" => Some(Kind::Segment),
        "S3" | "S3R" => Some(Kind::Triangle),
        "S4" | "S4R" => Some(Kind::Quadrilateral),
        _ => None,
    }
}

/// Keywords that change the mesh, with what they do.
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
/// The same of options of the keywords that are read.
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
/// How a file is to be written instead.
const FLAT: &str = "write the mesh as one flat file: every node and element by itself";

/// A set's members as they are named.
enum Member {
    /// First, last, step; with the line.
    Numbers(u64, u64, u64, u32),
    /// Another set, by index.
    Set(usize),
}

/// What the data lines belong to.
enum Block {
    Skipped,
    Nodes {
        set: Option<usize>,
    },
    Elements {
        kind: Option<Kind>,
        what: String,
        set: Option<usize>,
    },
    Set {
        set: usize,
        nodes: bool,
        generate: bool,
    },
    /// Where parts stand in an assembly.
    Instance,
}

#[derive(Default)]
struct Sets {
    names: HashMap<String, usize>,
    list: Vec<Set>,
}

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

    fn place(&mut self, name: &str) -> usize {
        let next = self.list.len();
        let place = *self.names.entry(name.to_ascii_lowercase()).or_insert(next);
        if place == next {
            self.list.push(Set { name: name.to_owned(), ..Set::default() });
        }
        place
    }
}

pub fn read(text: &mut Text, draft: &mut Draft) -> Result<(), Fault> {
    let (mut sets, mut block, mut others) = (Sets::default(), Block::Skipped, Vec::new());
    let mut frame = Frame::default();
    let mut next = content(text);
    while let Some(line) = next {
        next = content(text);
        // A line that ends in a comma goes on in the next one, of a keyword, or of an element that lacks nodes.
        let mut words: Vec<Word> = line.fields().collect();
        let wants = match &block {
            _ if line.bytes.starts_with(b"*") => usize::MAX,
            Block::Elements { kind, .. } => kind.map_or(usize::MAX, |kind| 1 + kind.size()),
            _ => 0,
        };
        let mut last = line;
        while words.len() < wants && last.bytes.ends_with(b",") {
            let Some(more) = next.filter(|more| !more.bytes.starts_with(b"*")) else { break };
            words.extend(more.fields());
            last = more;
            next = content(text);
        }
        if line.bytes.starts_with(b"*") {
            block = keyword(text, draft, &mut sets, &mut frame, line, &words)?;
            continue;
        }
        // Blank fields at the end say nothing, but for coordinates.
        let trims = !matches!(block, Block::Nodes { .. });
        while trims && words.len() > 1 && words.last().is_some_and(|word| word.bytes.is_empty()) {
            words.pop();
        }
        match &block {
            Block::Skipped => {}
            Block::Instance => {
                return Err(refused(text, "an instance that is moved is not read", line.number, ONE));
            }
            Block::Nodes { set } => {
                let id = number(text, &words, 0, line)?;
                let mut x = Vec3::zeros();
                // A blank coordinate is zero.
                for (i, word) in words.iter().enumerate().skip(1).take(3).filter(|(_, word)| !word.bytes.is_empty()) {
                    let message = "a coordinate must be a finite number";
                    x[i - 1] = word.number().ok_or_else(|| text.fault_at(message, word))?;
                }
                if words.len() < 2 {
                    return Err(text.fault(format!("node {id} has no coordinates"), line.number));
                }
                draft.node(id, x, line.number);
                if let Some(set) = set {
                    sets.list[*set].nodes.push(Member::Numbers(id, id, 1, short(line.number)));
                }
            }
            Block::Elements { kind, what, set } => {
                let id = number(text, &words, 0, line)?;
                if let Some(set) = set {
                    sets.list[*set].elements.push(Member::Numbers(id, id, 1, short(line.number)));
                }
                let Some(kind) = kind else {
                    draft.skip(&format!("elements of type {what}"), 1, line.number);
                    others.push(id);
                    continue;
                };
                if words.len() != 1 + kind.size() {
                    let message = format!("element {id} has {} nodes; {what} has {}", words.len() - 1, kind.size());
                    return Err(text.fault(message, line.number));
                }
                let mut nodes = [0; 4];
                for (i, node) in nodes[..kind.size()].iter_mut().enumerate() {
                    *node = number(text, &words, 1 + i, line)?;
                }
                draft.element(id, *kind, nodes, line.number);
            }
            Block::Set { set, nodes, generate } => members(text, &mut sets, line, &words, (*set, *nodes, *generate))?,
        }
    }
    resolve(text, draft, &sets, others)
}

/// The next line that is no comment.
fn content<'t>(text: &mut Text<'t>) -> Option<Line<'t>> {
    std::iter::from_fn(|| text.line()).find(|line| !line.bytes.starts_with(b"**"))
}

/// What frames the mesh in a file with parts and instances.
#[derive(Default)]
struct Frame {
    parts: usize,
    instances: usize,
}

const ONE: &str = "write the mesh as one part, where it stands";

fn refused(text: &Text, message: impl Into<String>, line: usize, hint: &str) -> Fault {
    let mut fault = text.fault(message, line);
    fault.hints.push(hint.to_owned());
    fault
}

/// A whole number among the words of a line.
fn number(text: &Text, words: &[Word], at: usize, line: Line) -> Result<u64, Fault> {
    let word = words.get(at).ok_or_else(|| text.fault("this line lacks a number", line.number))?;
    word.whole().ok_or_else(|| text.fault_at("this must be a whole number", word))
}

/// NAME, KEY=VALUE, KEY …
fn keyword(
    text: &Text,
    draft: &mut Draft,
    sets: &mut Sets,
    frame: &mut Frame,
    line: Line,
    words: &[Word],
) -> Result<Block, Fault> {
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
        "NODE" => Block::Nodes { set: value("NSET").map(|set| sets.place(&set)) },
        "ELEMENT" => {
            let what = value("TYPE").ok_or_else(|| lacks("TYPE"))?.to_ascii_uppercase();
            Block::Elements { kind: of(&what), what, set: value("ELSET").map(|set| sets.place(&set)) }
        }
        "NSET" | "ELSET" => {
            let set = sets.place(&value(&name).ok_or_else(|| lacks(&name))?);
            Block::Set { set, nodes: name == "NSET", generate: flag("GENERATE") }
        }
        "PART" | "INSTANCE" => {
            let count = if name == "PART" { &mut frame.parts } else { &mut frame.instances };
            *count += 1;
            if *count > 1 {
                return Err(refused(text, format!("a second *{name} is not read"), line.number, ONE));
            }
            if name == "PART" { Block::Skipped } else { Block::Instance }
        }
        // What only frames the mesh is no loss.
        "HEADING" | "END PART" | "ASSEMBLY" | "END ASSEMBLY" | "END INSTANCE" => Block::Skipped,
        _ => {
            draft.skip(&format!("*{name}"), 1, line.number);
            Block::Skipped
        }
    })
}

/// Numbers and names of sets, or first, last and step.
fn members(
    text: &Text,
    sets: &mut Sets,
    line: Line,
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
                    let message = || text.fault_at(format!("no set is named {name}"), word);
                    Member::Set(sets.find(name.trim_matches('"')).filter(|&other| other != set).ok_or_else(message)?)
                }
            });
        }
    }
    if nodes { &mut sets.list[set].nodes } else { &mut sets.list[set].elements }.extend(read);
    Ok(())
}

/// Sets as groups, by the elements that have been read. `others`: those that were skipped.
fn resolve(text: &Text, draft: &mut Draft, sets: &Sets, others: Vec<u64>) -> Result<(), Fault> {
    let (elements, _) = Ids::new(draft.elements.iter().map(|element| element.id));
    let (others, _) = Ids::new(others.iter().copied());
    let (nodes, _) = Ids::new(draft.nodes.iter().map(|node| node.id));
    // The first that is not there ends it, so that a slip in a last number does not count for hours.
    let missing = |what: &str, id: u64, set: usize, line: u32| {
        let message = format!("`{}` holds {what} {id}, which is not there", sets.list[set].name);
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

/// Every number in a set and in the sets it names, each of these once.
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
