//! The files of the output folder. Each format is one file here; [`Files`] opens those the deck asks for and shows them
//! every accepted step. Errors name the file.

pub mod compare;
pub mod expect;
pub mod log;
pub mod progress;
pub mod report;
pub mod result_json;

pub mod bodies_csv;
pub mod contacts_csv;
pub mod energy_csv;
mod fields;
pub mod links_csv;
pub mod nodes_csv;
mod parts_csv;
mod reactions_csv;
pub(crate) mod rows;
mod sections_csv;
mod shape;
pub mod shells_csv;
mod steps_csv;
mod table;
mod vtu;

use crate::model::{ExpectAt, Model, PartKind};
use crate::solve::{Frame, Observer, Wanted};
use fields::Fields;
use std::fs;
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};
use table::Table;

/// Finished rows reach their files at least this often, and at [`Files::finish`].
const PATIENCE: Duration = Duration::from_millis(200);

/// A file, or family of files, that grows with the run.
enum Format {
    Nodes(Table),
    Bodies(Table),
    Energy(Table),
    Links(Table),
    Contacts(Table),
    Reactions(Table),
    Sections(Table),
    Parts(Table),
    Shells(Table, shells_csv::Order),
    Layers(Table, shells_csv::Order),
    Steps(Table),
    Fields(Fields),
}

impl Format {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        match self {
            Format::Steps(table) => steps_csv::write(table, frame),
            Format::Fields(fields) => fields.on_step(frame),
            _ if !frame.due => Ok(()),
            Format::Nodes(table) => nodes_csv::write(table, frame),
            Format::Bodies(table) => bodies_csv::write(table, frame),
            Format::Energy(table) => energy_csv::write(table, frame),
            Format::Links(table) => links_csv::write(table, frame),
            Format::Contacts(table) => contacts_csv::write(table, frame),
            Format::Reactions(table) => reactions_csv::write(table, frame),
            Format::Sections(table) => sections_csv::write(table, frame),
            Format::Parts(table) => parts_csv::write(table, frame),
            Format::Shells(table, order) => shells_csv::write(table, order, frame),
            Format::Layers(table, order) => shells_csv::write_layers(table, order, frame),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Format::Nodes(table)
            | Format::Bodies(table)
            | Format::Energy(table)
            | Format::Links(table)
            | Format::Contacts(table)
            | Format::Reactions(table)
            | Format::Sections(table)
            | Format::Parts(table)
            | Format::Shells(table, _)
            | Format::Layers(table, _)
            | Format::Steps(table) => table.flush(),
            Format::Fields(_) => Ok(()), // whole after every frame
        }
    }
}

/// Writes what the deck asks for. [`Files::finish`] ends the run however it went.
pub struct Files {
    formats: Vec<Format>,
    flushed: Instant,
}

impl Files {
    /// Creates the folder and its files; with `keep_to`, goes on with those of a run interrupted after that step.
    pub fn open(dir: &Path, model: &Model, keep_to: Option<usize>) -> io::Result<Files> {
        fs::create_dir_all(dir).map_err(|e| at(dir, e))?;
        if keep_to.is_none() {
            remove_stale(dir)?;
        }
        let asked = &model.output;
        let mut formats = Vec::new();
        let mut table = |asked: bool, format: &dyn Fn(Table) -> Format, name: &str, header: String| {
            if asked {
                formats.push(format(Table::open(dir, name, &header, keep_to)?));
            }
            io::Result::Ok(())
        };
        table(!asked.nodes.is_empty(), &Format::Nodes, "nodes.csv", nodes_csv::header())?;
        table(!model.bodies.is_empty(), &Format::Bodies, "bodies.csv", bodies_csv::header())?;
        table(asked.energy, &Format::Energy, "energy.csv", energy_csv::header())?;
        table(asked.links && model.has(PartKind::Link), &Format::Links, "links.csv", links_csv::header())?;
        let contacts = asked.contacts && model.has(PartKind::Contact);
        table(contacts, &Format::Contacts, "contacts.csv", contacts_csv::header())?;
        table(asked.reactions, &Format::Reactions, "reactions.csv", reactions_csv::header())?;
        table(asked.sections && model.has(PartKind::Beam), &Format::Sections, "sections.csv", sections_csv::header())?;
        table(asked.parts, &Format::Parts, "parts.csv", parts_csv::header())?;
        let shells = model.has(PartKind::Shell);
        let of_shells = |table| Format::Shells(table, shells_csv::Order::of(model));
        let of_layers = |table| Format::Layers(table, shells_csv::Order::of(model));
        table(asked.sections && shells, &of_shells, "shells.csv", shells_csv::header())?;
        table(asked.layers && shells, &of_layers, "layers.csv", shells_csv::header_of_layers())?;
        table(true, &Format::Steps, "steps.csv", steps_csv::header())?;
        if let Some(every) = asked.fields {
            formats.push(Format::Fields(Fields::open(dir, model, every, keep_to)?));
        }
        Ok(Files { formats, flushed: Instant::now() })
    }

    /// Hands over the rows still waiting: at the end of a run, and before a checkpoint.
    pub fn finish(&mut self) -> io::Result<()> {
        self.flushed = Instant::now();
        self.formats.iter_mut().try_for_each(Format::flush)
    }
}

impl Observer for Files {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        self.formats.iter_mut().try_for_each(|format| format.on_step(frame))?;
        // The clock is looked at where there is something to write.
        let writes = frame.due || frame.step.is_multiple_of(64);
        if writes && self.flushed.elapsed() > PATIENCE { self.finish() } else { Ok(()) }
    }
}

/// What the files and expectations of a model need to be computed.
pub fn wanted(model: &Model) -> Wanted {
    let expects = |at: fn(&ExpectAt) -> bool| model.expects.iter().any(|expect| at(&expect.at));
    Wanted {
        steps: true,
        energy: model.output.energy || expects(|at| matches!(at, ExpectAt::Energy)),
        reactions: model.output.reactions || expects(|at| matches!(at, ExpectAt::Joint(_))),
        links: model.output.links || expects(|at| matches!(at, ExpectAt::Link(_))),
        contacts: model.output.contacts || expects(|at| matches!(at, ExpectAt::Contact(_))),
        sections: model.output.sections,
        parts: model.output.parts,
        shells: model.has(PartKind::Shell)
            && (model.output.sections
                || model.output.layers
                || model.output.fields.is_some()
                || expects(|at| matches!(at, ExpectAt::Shells(..)))),
        plastic_strains: model.yields()
            && (model.output.fields.is_some() || expects(|at| matches!(at, ExpectAt::Elements(..)))),
    }
}

/// Files that a run writes, besides those of fields and its log.
const OURS: [&str; 14] = [
    "nodes.csv",
    "bodies.csv",
    "energy.csv",
    "links.csv",
    "contacts.csv",
    "reactions.csv",
    "sections.csv",
    "shells.csv",
    "layers.csv",
    "parts.csv",
    "steps.csv",
    "fields.csv",
    "fields.pvd",
    "result.json",
];

/// Takes away results of an earlier run, so that none of them is taken for one of this; other files stay.
fn remove_stale(dir: &Path) -> io::Result<()> {
    remove(dir, &is_ours)
}

fn is_ours(name: &str) -> bool {
    OURS.contains(&name) || (name.starts_with("fields_") && name.ends_with(".vtu"))
}

/// A file that a run writes, whole or not.
fn is_of_a_run(name: &str) -> bool {
    name == log::NAME || is_ours(name.strip_suffix(PART).unwrap_or(name))
}

/// Takes away what an earlier run has left, and its folder unless something else is in it.
pub(crate) fn remove_run(dir: &Path) -> io::Result<()> {
    remove(dir, &is_of_a_run)?;
    remove_empty(dir)
}

/// True where a folder holds files of a run.
pub(crate) fn run_files(dir: &Path) -> io::Result<bool> {
    for entry in fs::read_dir(dir).map_err(|e| at(dir, e))? {
        let entry = entry.map_err(|e| at(dir, e))?;
        if entry.file_name().to_str().is_some_and(is_of_a_run) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Takes away a folder with nothing in it.
pub(crate) fn remove_empty(dir: &Path) -> io::Result<()> {
    let mut entries = fs::read_dir(dir).map_err(|e| at(dir, e))?;
    if entries.next().is_none() { fs::remove_dir(dir).map_err(|e| at(dir, e)) } else { Ok(()) }
}

/// Takes away the files of these names.
pub(crate) fn remove(dir: &Path, ours: &dyn Fn(&str) -> bool) -> io::Result<()> {
    for entry in fs::read_dir(dir).map_err(|e| at(dir, e))? {
        let entry = entry.map_err(|e| at(dir, e))?;
        let path = entry.path();
        // A link was put there by somebody.
        if !entry.file_type().map_err(|e| at(&path, e))?.is_file() {
            continue;
        }
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if ours(name) {
            fs::remove_file(&path).map_err(|e| at(&path, e))?;
        }
    }
    Ok(())
}

/// The error with the file it is about.
pub(crate) fn at(path: &Path, error: io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}

/// At the end of the name of a file that is not whole yet.
const PART: &str = ".tmp";

/// Writes a small file so that a reader sees the old one or the new one, never a part.
pub(crate) fn replace(path: &Path, text: &[u8]) -> io::Result<()> {
    let mut name = path.as_os_str().to_owned();
    name.push(PART);
    fs::write(&name, text).and_then(|()| fs::rename(&name, path)).map_err(|e| at(path, e))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_results_of_an_earlier_run_go() {
        let dir = tempfile::tempdir().unwrap();
        for name in ["links.csv", "fields_000010.vtu", "notes.txt", "my_nodes.csv"] {
            fs::write(dir.path().join(name), "old").unwrap();
        }
        remove_stale(dir.path()).unwrap();
        let mut left: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
        left.sort();
        assert_eq!(left, ["my_nodes.csv", "notes.txt"]);
    }
}
