//! `[mesh]`: the file, its groups as sets, and parts made of its groups.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use sha2::{Digest, Sha256};

use super::build::{Builder, Owner};
use super::places::Place;
use super::{BeamElement, MeshFile, Shell, ShellElement};
use crate::deck::Deck;
use crate::diagnostic::{At, Diagnostic, Excerpt};
use crate::math::Vec3;
use crate::mesh::{self, Kind, Mesh};
use crate::names::{nearest, quoted};

/// A mesh that has been read.
#[derive(Debug)]
pub struct Input {
    pub path: String,
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
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) => {
                let message = format!("cannot read the mesh `{path}`: {error}");
                return (None, vec![Diagnostic::error(message).at(&file.span).hint("from the deck's folder")]);
            }
        };
        match mesh::read(&path, &bytes) {
            Ok(mesh) => {
                let said = said(&mesh, &path, &bytes).into_iter().map(|problem| problem.at(&file.span)).collect();
                let digest = Sha256::digest(&bytes).into();
                (Some(Input { path, mesh, digest }), said)
            }
            Err(problems) => (None, problems.into_iter().map(|problem| problem.at(&file.span)).collect()),
        }
    }
}

/// Warnings about what the reader skipped: elements, then keywords.
fn said(mesh: &Mesh, path: &str, bytes: &[u8]) -> Vec<Diagnostic> {
    let is_keyword = |skipped: &&mesh::Skipped| skipped.what.starts_with(['*', '$']);
    let (keywords, elements): (Vec<_>, Vec<_>) = mesh.skipped.iter().partition(is_keyword);
    let warning = |skipped: &[&mesh::Skipped], message: String| {
        let line = skipped[0].line;
        let text = bytes.split(|&byte| byte == b'\n').nth(line - 1).unwrap_or_default().trim_ascii_end();
        Diagnostic::warning(message).of(Excerpt::new(path.to_owned(), line, text, 0..text.len()))
    };
    let mut said = Vec::new();
    if !elements.is_empty() {
        let list: Vec<String> = elements.iter().map(|s| format!("{} {} (line {})", s.count, s.what, s.line)).collect();
        said.push(warning(&elements, format!("elements that are not read: {}", list.join(", "))));
    }
    if !keywords.is_empty() {
        let line = |s: &&mesh::Skipped| {
            let more = if s.count > 1 { format!(" and {} more", s.count - 1) } else { String::new() };
            format!("{} (line {}{more})", s.what, s.line)
        };
        let list: Vec<String> = keywords.iter().map(line).collect();
        said.push(warning(&keywords, format!("not read: {}", list.join(", "))));
    }
    said
}

/// What the builder knows of the mesh.
#[derive(Default)]
pub(super) struct Meshed<'d> {
    /// The deck names a mesh that could not be read.
    pub lost: bool,
    /// The model's node of the mesh's first one.
    first: usize,
    /// Per group: the deck names it.
    pub named: Vec<bool>,
    /// Groups that are parts, with what they are: "shell `roof`".
    parts: HashMap<&'d str, String>,
    /// Per element: it is in a part.
    taken: Vec<bool>,
    /// Per node of the mesh: its number in the part in hand, from 1; 0 for none.
    local: Vec<u32>,
}

impl Meshed<'_> {
    pub fn new(deck: &Deck, input: Option<&Input>) -> Self {
        let lost = deck.mesh.is_some() && input.is_none();
        let (groups, elements) = input.map_or((0, 0), |input| (input.mesh.groups.len(), input.mesh.elements.len()));
        Meshed { lost, named: vec![false; groups], taken: vec![false; elements], ..Meshed::default() }
    }
}

impl<'d> Builder<'d> {
    /// A node for each of the mesh; those that nothing names or uses go in the end.
    pub fn mesh_nodes(&mut self) {
        let Some(table) = &self.deck.mesh else { return };
        self.need(&Owner { what: "`[mesh]`".to_owned(), span: &table.span }, "file", &table.file);
        let scale = if table.scale.is_some() { self.positive("scale", &table.scale).unwrap_or(1.0) } else { 1.0 };
        self.meshed.first = self.model.nodes.len();
        let Some(input) = self.input else {
            self.unsure = true;
            return;
        };
        for node in &input.mesh.nodes {
            self.node(format!("mesh.{}", node.id), false, node.x * scale);
        }
    }

    /// Groups by their names, which must be different from all others of the deck but the parts made of them.
    pub fn register_groups(&mut self) {
        let (Some(input), Some(file)) = (self.input, self.deck.mesh.as_ref().and_then(|mesh| mesh.file.as_ref()))
        else {
            return;
        };
        let deck = self.deck;
        let beams = deck.beams.iter().filter_map(|beam| beam.group.as_ref());
        let shells = deck.shells.iter().filter_map(|shell| shell.group.as_ref());
        let parts: HashSet<&str> = beams.chain(shells).map(|group| group.as_str()).collect();
        for (index, group) in input.mesh.groups.iter().enumerate() {
            let name = group.name.as_str();
            if name == "all" || name == "energy" {
                if !parts.contains(name) {
                    let message = format!("group `{name}` of the mesh has a name with a meaning of its own");
                    self.warn(&file.span, message, "it is no set");
                }
                continue;
            }
            match self.places.get(name) {
                None => {
                    self.places.insert(name, (Place::Group(index), &file.span));
                }
                // A part that is called like its group.
                Some(_) if parts.contains(name) => {}
                Some((place, span)) => {
                    let (kind, span) = (place.noun(), *span);
                    let message = format!("{kind} `{name}` has the name of a group of the mesh");
                    self.error_with::<()>(span, message, "give it another one");
                }
            }
        }
    }

    /// The model's node of `mesh.17`.
    pub fn mesh_node(&self, name: &str) -> Option<usize> {
        let id = name.strip_prefix("mesh.")?.parse().ok()?;
        Some(self.meshed.first + self.input?.mesh.node(id)?)
    }

    /// The file's number of a node of the model.
    pub fn mesh_id(&self, node: usize) -> Option<u64> {
        let node = node.checked_sub(self.meshed.first)?;
        self.input?.mesh.nodes.get(node).map(|node| node.id)
    }

    pub fn group_nodes(&self, group: usize) -> impl Iterator<Item = usize> + use<'_, 'd> {
        let nodes = self.input.map_or(&[][..], |input| &input.mesh.groups[group].nodes);
        nodes.iter().map(|&node| self.meshed.first + node as usize)
    }

    /// Segments of a group, as pairs of the model's nodes.
    pub fn group_segments(&self, group: usize) -> Vec<[usize; 2]> {
        let Some(input) = self.input else { return Vec::new() };
        let elements = input.mesh.groups[group].elements.iter().map(|&e| &input.mesh.elements[e as usize]);
        let node = |node: u32| self.meshed.first + node as usize;
        elements.filter(|e| e.kind == Kind::Segment).map(|e| [node(e.nodes()[0]), node(e.nodes()[1])]).collect()
    }

    /// Takes the segments or the faces of a group for a part.
    fn take(&mut self, what: &str, name: &'d At<String>, faces: bool) -> Option<Vec<&'d mesh::Element>> {
        if self.meshed.lost {
            return None;
        }
        let Some(input) = self.input else {
            return self.error_with(&name.span, "`group` wants a mesh", "the deck has no [mesh]");
        };
        let mesh = &input.mesh;
        let Some(group) = mesh.group(name) else {
            let message = format!("the mesh has no group `{}`", name.value);
            let known = mesh.groups.iter().map(|group| group.name.as_str());
            let hint = match nearest(name, known.clone()) {
                Some(near) => format!("did you mean `{near}`?"),
                None if mesh.groups.is_empty() => "it has none".to_owned(),
                None => format!("its groups are {}", quoted(known.take(12))),
            };
            self.unsure = true;
            return self.error_with(&name.span, message, hint);
        };
        if let Some(other) = self.meshed.parts.get(name.as_str()) {
            let message = format!("group `{}` is {other} already", name.value);
            return self.error(&name.span, message);
        }
        self.meshed.parts.insert(name.as_str(), what.to_owned());
        if group.skipped > 0 {
            let message =
                format!("{} elements of group `{}` are of kinds that are not read", group.skipped, name.value);
            self.unsure = true;
            return self.error_with(&name.span, message, "mesh it with lines of two nodes and faces of three or four");
        }
        let is_meant = |e: &&mesh::Element| (e.kind != Kind::Segment) == faces;
        let indices = || group.elements.iter().map(|&e| e as usize);
        let elements: Vec<&mesh::Element> = indices().map(|e| &mesh.elements[e]).filter(is_meant).collect();
        if elements.is_empty() {
            self.unsure = true;
            let wanted = if faces { "triangles or quadrilaterals" } else { "segments" };
            return self.error(&name.span, format!("group `{}` has no {wanted}", name.value));
        }
        let mut shared = 0;
        for e in indices().filter(|&e| is_meant(&&mesh.elements[e])) {
            shared += usize::from(std::mem::replace(&mut self.meshed.taken[e], true));
        }
        if shared > 0 {
            let message = format!("{shared} elements of group `{}` are in another part already", name.value);
            return self.error(&name.span, message);
        }
        Some(elements)
    }

    /// The faces of a group, quadrilaterals and triangles apart, into two copies of a shell without elements.
    pub fn meshed_shell(
        &mut self,
        index: usize,
        owner: &Owner<'d>,
        name: &'d At<String>,
        shell: Option<Shell>,
    ) -> Option<()> {
        let faces = self.take(&owner.what, name, true)?;
        let first = self.meshed.first;
        let (own, local) = self.own_nodes(&faces)?;
        for &node in &own {
            self.touch(first + node as usize, true);
            self.shell_nodes[index].push(first + node as usize);
        }
        let shell = shell?;
        let mesh = &self.input?.mesh;
        let x: Vec<Vec3> = own.iter().map(|&node| mesh.nodes[node as usize].x).collect();
        let sizes = faces.iter().map(|face| face.nodes().len());
        let (normals, against) = mesh::normals(&x, local.iter().zip(sizes).map(|(nodes, size)| &nodes[..size]));
        if against > 0 {
            let message = format!("the elements of {} are not oriented alike: at {against} edges", owner.what);
            self.warn(&name.span, message, "pressure acts against the normal of each element");
        }
        let begin = self.model.parts.len();
        for corners in [4, 3] {
            let of = |(number, (face, normals)): (usize, (&&mesh::Element, &[Vec3; 4]))| {
                let at = |k: usize| k.min(corners - 1);
                let element = || ShellElement {
                    nodes: std::array::from_fn(|k| first + face.nodes()[at(k)] as usize),
                    normals: std::array::from_fn(|k| normals[at(k)]),
                };
                (face.nodes().len() == corners).then(|| (number as u32, element()))
            };
            let of = faces.iter().zip(&normals).enumerate().filter_map(of);
            let (numbers, elements): (Vec<u32>, Vec<ShellElement>) = of.unzip();
            if !elements.is_empty() {
                let numbers = if elements.len() < faces.len() { numbers } else { Vec::new() };
                self.model.add(Shell { corners, elements, numbers, ..shell.clone() });
            }
        }
        self.shell_parts[index] = begin..self.model.parts.len();
        Some(())
    }

    /// Nodes of faces, each once in the order of the faces, and these by them. Takes no longer than the faces are many.
    #[allow(clippy::type_complexity)]
    fn own_nodes(&mut self, faces: &[&mesh::Element]) -> Option<(Vec<u32>, Vec<[u32; 4]>)> {
        let local = &mut self.meshed.local;
        local.resize(self.input?.mesh.nodes.len(), 0);
        let (mut own, mut of) = (Vec::new(), Vec::with_capacity(faces.len()));
        for face in faces {
            let mut nodes = [0; 4];
            for (place, &node) in nodes.iter_mut().zip(face.nodes()) {
                let number = &mut local[node as usize];
                if *number == 0 {
                    own.push(node);
                    *number = own.len() as u32;
                }
                *place = *number - 1;
            }
            of.push(nodes);
        }
        own.iter().for_each(|&node| local[node as usize] = 0);
        Some((own, of))
    }

    /// The segments of a group as beam elements with inner nodes at `inner` ∈ [−1, 1], ends among them.
    pub fn meshed_beam(
        &mut self,
        (index, label): (usize, &str),
        owner: &Owner<'d>,
        name: &'d At<String>,
        inner: &[f64],
        frame: impl Fn(Vec3) -> Option<crate::math::Mat3>,
    ) -> Option<Vec<BeamElement>> {
        let segments = self.take(&owner.what, name, false)?;
        let first = self.meshed.first;
        let (mut made, mut nodes, mut seen) = (Vec::new(), Vec::new(), HashSet::new());
        let (mut inside, mut parallel) = (0, 0);
        for segment in &segments {
            let ends = [0, 1].map(|k| first + segment.nodes()[k] as usize);
            for end in ends {
                self.touch(end, true);
                if seen.insert(end) {
                    nodes.push(end);
                }
            }
            let [x0, x1] = ends.map(|end| self.x(end));
            let Some(frame) = frame(x1 - x0) else {
                parallel += 1;
                continue;
            };
            let mut ids = [ends[1]; 5];
            ids[0] = ends[0];
            for (i, xi) in inner.iter().enumerate().take(inner.len() - 1).skip(1) {
                inside += 1;
                ids[i] = self.node(format!("{label}[{inside}]"), false, x0 + (x1 - x0) * (0.5 * (1.0 + xi)));
                self.touch(ids[i], true);
                nodes.push(ids[i]);
            }
            made.push(BeamElement { nodes: ids, frame, section: 0 });
        }
        self.beam_nodes[index] = nodes;
        if parallel > 0 {
            let place = self.deck.beams[index].orientation.as_ref().map_or(owner.span, |at| &at.span);
            let message = format!("`orientation` is parallel to {parallel} segments of group `{}`", name.value);
            return self.error_with(place, message, "it must point to the side, where local y is to lie");
        }
        Some(made)
    }

    /// Elements that are in no part and in no group that the deck names.
    pub fn check_mesh(&mut self) {
        let (Some(input), Some(file)) = (self.input, self.deck.mesh.as_ref().and_then(|mesh| mesh.file.as_ref()))
        else {
            return;
        };
        let mut used = self.meshed.taken.clone();
        for (group, _) in input.mesh.groups.iter().zip(&self.meshed.named).filter(|(_, named)| **named) {
            group.elements.iter().for_each(|&e| used[e as usize] = true);
        }
        let count =
            |kind: Kind| input.mesh.elements.iter().zip(&used).filter(|(e, used)| e.kind == kind && !*used).count();
        let left =
            [(Kind::Segment, "segments"), (Kind::Triangle, "triangles"), (Kind::Quadrilateral, "quadrilaterals")];
        let left: Vec<String> = left
            .map(|(kind, what)| (count(kind), what))
            .iter()
            .filter(|c| c.0 > 0)
            .map(|(n, w)| format!("{n} {w}"))
            .collect();
        // A part with errors would take some of them.
        if !left.is_empty() && !self.problems.iter().any(Diagnostic::is_error) {
            let words: Vec<&str> = left.iter().map(String::as_str).collect();
            let message = format!("{} of the mesh are in no part", crate::names::joined(&words));
            self.warn(&file.span, message, "left out");
        }
        self.model.mesh = Some(MeshFile {
            path: input.path.clone(),
            digest: input.digest,
            nodes: input.mesh.nodes.len(),
            elements: input.mesh.elements.len(),
            used: self.meshed.taken.iter().filter(|&&taken| taken).count(),
        });
    }
}
