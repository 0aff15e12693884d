//! Meshes from files: what is read, what is refused, and parts made of them against patches of the deck.

mod cards;
mod command;
mod messages;
mod parts;
mod read;
mod rigid;
mod sets;
mod ties;

use crate::support;
use rdsolve::diagnostic::Source;
use rdsolve::model::{self, Model};
use rdsolve::state::Node;
use std::path::Path;

/// A deck in a folder with files beside it.
pub struct Folder {
    dir: tempfile::TempDir,
}

impl Folder {
    pub fn with(files: &[(&str, &str)]) -> Folder {
        let dir = tempfile::tempdir().unwrap();
        for (name, text) in files {
            std::fs::write(dir.path().join(name), text).unwrap();
        }
        Folder { dir }
    }

    pub fn path(&self) -> &Path {
        self.dir.path()
    }

    fn source(&self, deck: &str) -> Source {
        Source::new(self.path().join("deck.toml").display().to_string(), deck, &[])
    }

    /// The model and what is said, the folder's name left out.
    pub fn read(&self, deck: &str) -> (Option<Model>, String) {
        let source = self.source(deck);
        let (model, problems) = model::read(&source);
        assert_eq!(model.is_none(), problems.iter().any(|problem| problem.is_error()), "a model without errors only");
        problems.iter().for_each(crate::support::assert_says_what_to_change);
        let drawn: Vec<String> = problems.iter().map(|problem| problem.draw(&source, false)).collect();
        (model, drawn.join("\n\n").replace(&format!("{}/", self.path().display()), ""))
    }

    pub fn model(&self, deck: &str) -> Model {
        let (model, said) = self.read(deck);
        model.unwrap_or_else(|| panic!("{said}"))
    }
}

/// Position of a named node after every step.
pub fn positions(model: &Model, label: &str) -> Vec<[f64; 3]> {
    let node = support::node(model, label);
    let done = support::run_to_the_end(model, &mut |frame| support::position(&frame.state.nodes[node]).to_vec());
    done.rows.into_iter().map(|row| [row[0], row[1], row[2]]).collect()
}

/// Displacements of all nodes of a model at the end, by label.
pub fn displacements(model: &Model) -> Vec<(String, [f64; 3])> {
    let done = support::run_to_the_end(model, &mut |frame| {
        let u = |(now, start): (&Node, &model::Node)| <[f64; 3]>::from(now.x - start.x);
        frame.state.nodes.iter().zip(&frame.model.nodes).flat_map(u).collect()
    });
    let last = done.rows.last().unwrap();
    model.nodes.iter().zip(last.chunks(3)).map(|(node, u)| (node.label.clone(), [u[0], u[1], u[2]])).collect()
}

/// A rectangular plate of n by m quadrilaterals in the x-y plane, as three files: groups `plate`, `root` (edge x = 0),
/// `tip` (edge x = length, segments), `corner` (the node at x = length, y = width).
pub struct Plate {
    pub n: usize,
    pub m: usize,
    pub size: [f64; 2],
}

impl Plate {
    pub fn node(&self, i: usize, j: usize) -> usize {
        1 + i + j * (self.n + 1)
    }

    fn x(&self, i: usize, j: usize) -> [f64; 2] {
        [self.size[0] * i as f64 / self.n as f64, self.size[1] * j as f64 / self.m as f64]
    }

    fn places(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..=self.m).flat_map(|j| (0..=self.n).map(move |i| (i, j)))
    }

    fn quads(&self) -> Vec<[usize; 4]> {
        let of = |(i, j): (usize, usize)| {
            [self.node(i, j), self.node(i + 1, j), self.node(i + 1, j + 1), self.node(i, j + 1)]
        };
        (0..self.m).flat_map(|j| (0..self.n).map(move |i| (i, j))).map(of).collect()
    }

    fn edge(&self, i: usize) -> Vec<[usize; 2]> {
        (0..self.m).map(|j| [self.node(i, j), self.node(i, j + 1)]).collect()
    }

    /// Version 4.1, as Gmsh writes it: one entity each for the corner, the two edges, the plate.
    pub fn msh4(&self) -> String {
        let mut s = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n0 1 \"corner\"\n1 2 \"root\"\n1 3 \"tip\"\n2 4 \"plate\"\n$EndPhysicalNames\n".to_owned();
        let [l, w] = self.size;
        s += &format!(
            "$Entities\n1 2 1 0\n1 {l} {w} 0 1 1 \n1 0 0 0 0 {w} 0 1 2 0 \n2 {l} 0 0 {l} {w} 0 1 3 0 \n1 0 0 0 {l} {w} 0 1 4 2 1 2 \n$EndEntities\n"
        );
        let count = (self.n + 1) * (self.m + 1);
        s += &format!("$Nodes\n1 {count} 1 {count}\n2 1 0 {count}\n");
        self.places().for_each(|(i, j)| s += &format!("{}\n", self.node(i, j)));
        for (i, j) in self.places() {
            let [x, y] = self.x(i, j);
            s += &format!("{x} {y} 0\n");
        }
        let (quads, all) = (self.quads(), 1 + 2 * self.m + self.n * self.m);
        s += &format!("$EndNodes\n$Elements\n4 {all} 1 {all}\n0 1 15 1\n1 {} \n", self.node(self.n, self.m));
        let mut id = 1;
        for (entity, edge) in [(1, self.edge(0)), (2, self.edge(self.n))] {
            s += &format!("1 {entity} 1 {}\n", edge.len());
            for [a, b] in edge {
                id += 1;
                s += &format!("{id} {a} {b} \n");
            }
        }
        s += &format!("2 1 3 {}\n", quads.len());
        for [a, b, c, d] in quads {
            id += 1;
            s += &format!("{id} {a} {b} {c} {d} \n");
        }
        s + "$EndElements\n"
    }

    pub fn msh2(&self) -> String {
        let mut s = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n0 1 \"corner\"\n1 2 \"root\"\n1 3 \"tip\"\n2 4 \"plate\"\n$EndPhysicalNames\n".to_owned();
        s += &format!("$Nodes\n{}\n", (self.n + 1) * (self.m + 1));
        for (i, j) in self.places() {
            let [x, y] = self.x(i, j);
            s += &format!("{} {x} {y} 0\n", self.node(i, j));
        }
        let mut elements = vec![format!("15 2 1 1 {}", self.node(self.n, self.m))];
        elements.extend(self.edge(0).iter().map(|[a, b]| format!("1 2 2 1 {a} {b}")));
        elements.extend(self.edge(self.n).iter().map(|[a, b]| format!("1 2 3 2 {a} {b}")));
        elements.extend(self.quads().iter().map(|[a, b, c, d]| format!("3 2 4 1 {a} {b} {c} {d}")));
        s += &format!("$EndNodes\n$Elements\n{}\n", elements.len());
        for (k, element) in elements.iter().enumerate() {
            s += &format!("{} {element}\n", k + 1);
        }
        s + "$EndElements\n"
    }

    pub fn inp(&self) -> String {
        let mut s = "*HEADING\nplate\n** a comment\n*Node\n".to_owned();
        for (i, j) in self.places() {
            let [x, y] = self.x(i, j);
            s += &format!("{}, {x}, {y}, 0.\n", self.node(i, j));
        }
        s += "*ELEMENT, TYPE=S4R, ELSET=plate\n";
        for (k, [a, b, c, d]) in self.quads().iter().enumerate() {
            s += &format!("{}, {a}, {b},\n {c}, {d}\n", k + 1);
        }
        let list = |i: usize| (0..=self.m).map(|j| self.node(i, j).to_string()).collect::<Vec<_>>().join(", ");
        let (first, last) = (self.node(0, 0), self.node(0, self.m));
        s += &format!("*nset, nset=root, generate\n{first}, {last}, {}\n", self.n + 1);
        s + &format!("*NSET, NSET=tip\n{}\n*NSET, NSET=Corner\n{},\n", list(self.n), self.node(self.n, self.m))
    }
}
