//! The mesh file that `[mesh]` names: it is read before the model is built, its nodes come after points and bodies.

use std::path::Path;

use sha2::{Digest, Sha256};

use super::places::nodes::Nodes;
use super::report::{Owner, Report};
use crate::mesh::{self, Mesh};
use base::diagnostic::Diagnostic;
use base::text_file::includes::Included;
use base::text_file::{Text, read_regular};
use deck::Deck;

/// A mesh that has been read.
#[derive(Debug)]
pub struct Input {
    /// Path as messages name it.
    pub path: String,
    /// Its nodes, elements and groups.
    pub mesh: Mesh,
    /// SHA-256 of the file.
    pub digest: [u8; 32],
}

impl Input {
    /// Reads the mesh that the deck names, from the deck's folder; with all there is to say about the file.
    pub fn load(deck: &Deck, folder: &Path) -> (Option<Input>, Vec<Diagnostic>) {
        let Some(file) = deck.mesh.as_ref().and_then(|mesh| mesh.file.as_ref()) else { return (None, Vec::new()) };
        let path = folder.join(&file.value);
        let path = path.display().to_string();
        let bytes = match read_regular(Path::new(&path)) {
            Ok(bytes) => bytes,
            Err(error) => {
                let message = format!("cannot read the mesh `{path}`: {error}");
                return (
                    None,
                    vec![Diagnostic::error(message).at(&file.span).hint("the path is relative to the deck's folder")],
                );
            }
        };
        match read(&path, bytes) {
            Ok((input, said)) => (Some(input), said.into_iter().map(|problem| problem.at(&file.span)).collect()),
            Err(problems) => (None, problems.into_iter().map(|problem| problem.at(&file.span)).collect()),
        }
    }
}

/// Reads a mesh with its included files; returns its diagnostics too.
fn read(path: &str, bytes: Vec<u8>) -> Result<(Input, Vec<Diagnostic>), Vec<Diagnostic>> {
    let folder = Path::new(path).parent().unwrap_or(Path::new(""));
    let whole = match mesh::may_include(path) {
        true => Included::new(path, bytes, &mut |name: &str| read_regular(folder.join(name)))
            .map_err(|fault| vec![*fault])?,
        false => Included::alone(bytes),
    };
    let mut text = Text::of_pieces(path, &whole.bytes, &whole.pieces);
    let mesh = mesh::read_text(&mut text)?;
    let said = said(&mesh, &text);
    let digest = Sha256::digest(&whole.bytes).into();
    Ok((Input { path: path.to_owned(), mesh, digest }, said))
}

/// Warnings for elements and keywords skipped by the reader, and its notes.
fn said(mesh: &Mesh, text: &Text) -> Vec<Diagnostic> {
    let is_keyword = |skipped: &&mesh::Skipped| skipped.what.starts_with(['*', '$']);
    let (keywords, elements): (Vec<_>, Vec<_>) = mesh.skipped.iter().partition(is_keyword);
    let warning =
        |skipped: &[&mesh::Skipped], message: String| Diagnostic::warning(message).of(text.excerpt(skipped[0].line));
    let place = |line: usize| match text.origin(line) {
        (path, line) if path == text.path => format!("line {line}"),
        (path, line) => format!("line {line} of {path}"),
    };
    let mut said = Vec::new();
    if !elements.is_empty() {
        let of_kind = |s: &&mesh::Skipped| format!("{} {} ({})", s.count, s.what, place(s.line));
        let list: Vec<String> = elements.iter().map(of_kind).collect();
        said.push(
            warning(&elements, format!("elements of unsupported types are skipped: {}", list.join(", ")))
                .hint("give the mesh segments, triangles or quadrilaterals there"),
        );
    }
    if !keywords.is_empty() {
        let line = |s: &&mesh::Skipped| {
            let more = if s.count > 1 { format!(" and {} more", s.count - 1) } else { String::new() };
            format!("{} ({}{more})", s.what, place(s.line))
        };
        let list: Vec<String> = keywords.iter().map(line).collect();
        said.push(
            warning(&keywords, format!("keywords that are not read are skipped: {}", list.join(", ")))
                .hint("remove them, or enter their data in the deck"),
        );
    }
    let note = |note: &mesh::MeshNote| Diagnostic::note(&note.what).hint(&note.meaning).of(text.excerpt(note.line));
    said.extend(mesh.notes.iter().map(note));
    said
}

/// The mesh in the model: all its nodes, one after the other. Unnamed unused nodes are removed from the model in the end.
#[derive(Clone, Copy)]
pub(super) struct MeshNodes<'d> {
    /// The mesh; `None` for a deck without one.
    pub input: Option<&'d Input>,
    /// True for a deck with an unreadable mesh.
    pub is_lost: bool,
    /// The model's node of the first one in the file.
    pub first: usize,
}

impl<'d> MeshNodes<'d> {
    /// Reads `[mesh]` and adds a node for each of the file.
    pub fn add(deck: &'d Deck, input: Option<&'d Input>, nodes: &mut Nodes, report: &mut Report<'d>) -> Self {
        let mesh = MeshNodes { input, is_lost: deck.mesh.is_some() && input.is_none(), first: nodes.list.len() };
        let Some(table) = &deck.mesh else { return mesh };
        report.require(&Owner::new("`[mesh]`", &table.span), "file", &table.file);
        let scale = if table.scale.is_some() { report.positive("scale", &table.scale).unwrap_or(1.0) } else { 1.0 };
        match input {
            Some(input) => input.mesh.nodes.iter().for_each(|node| {
                nodes.add(format!("mesh.{}", node.id), false, node.x * scale);
            }),
            None => report.lose_connections(),
        }
        mesh
    }

    /// The model's node of `mesh.17`.
    pub fn node(&self, name: &str) -> Option<usize> {
        let id = name.strip_prefix("mesh.")?.parse().ok()?;
        Some(self.first + self.input?.mesh.node(id)?)
    }

    /// The file's number of a node of the model.
    pub fn id(&self, node: usize) -> Option<u64> {
        let node = node.checked_sub(self.first)?;
        self.input?.mesh.nodes.get(node).map(|node| node.id)
    }

    /// The model's nodes of a group.
    pub fn group_nodes(&self, group: usize) -> impl Iterator<Item = usize> + use<'d> {
        let nodes = self.input.map_or(&[][..], |input| &input.mesh.groups[group].nodes);
        let first = self.first;
        nodes.iter().map(move |&node| first + node as usize)
    }

    /// Corners of the faces of a group, as the model's nodes.
    pub fn group_faces(&self, group: usize) -> Vec<Vec<usize>> {
        let Some(input) = self.input else { return Vec::new() };
        let elements = input.mesh.groups[group].elements.iter().map(|&e| &input.mesh.elements[e as usize]);
        let corners = |e: &mesh::MeshElement| {
            e.nodes()[..e.kind.corners()].iter().map(|&node| self.first + node as usize).collect()
        };
        elements.filter(|e| !e.kind.is_line()).map(corners).collect()
    }

    /// Segments of a group, as pairs of the model's nodes at their ends.
    pub fn group_segments(&self, group: usize) -> Vec<[usize; 2]> {
        let Some(input) = self.input else { return Vec::new() };
        let elements = input.mesh.groups[group].elements.iter().map(|&e| &input.mesh.elements[e as usize]);
        let node = |node: u32| self.first + node as usize;
        elements.filter(|e| e.kind.is_line()).map(|e| [node(e.nodes()[0]), node(e.nodes()[1])]).collect()
    }
}
