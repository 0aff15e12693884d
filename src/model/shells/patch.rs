//! A patch of shells: nodes of its edges, which neighbours share, nodes inside, normals, and the elements between them.

use crate::data::ShellElement;
use crate::places::nodes::Nodes;
use crate::report::{Owner, Report};
use crate::shells::surface_map::Map;
use base::math::Vec3;

/// An edge of a patch that later patches may join.
struct Edge {
    ends: [usize; 2],
    nodes: Vec<usize>,
    /// The point half way along the edge in parameters.
    middle: Vec3,
    order: usize,
    patch: String,
}

/// The edges of all patches so far, each once.
#[derive(Default)]
pub struct Edges(Vec<Edge>);

/// A grid of n × m elements over four corners, or a triangular one with n along each edge over three.
pub struct Patch<'b, 'd> {
    /// The name of the shell.
    pub name: &'b str,
    /// The shell, for messages.
    pub owner: &'b Owner<'d>,
    /// The map from the grid to positions between the edges.
    pub map: Map,
    /// The nodes at the corners.
    pub corners: Vec<usize>,
    /// The numbers of spaces between nodes along the first and the second edge: of elements times their order.
    pub counts: [usize; 2],
    /// The degree of the sides of its elements.
    pub order: usize,
    /// The number of nodes made so far, which numbers their labels.
    pub made: usize,
}

/// Nodes and normals of a patch, row by row; those of three corners leave half of the rows empty.
pub struct Grid {
    /// The nodes; `None` where a row of a triangular grid has ended.
    pub nodes: Vec<Option<usize>>,
    normals: Vec<Vec3>,
    /// Nodes of each edge, in order along it.
    pub edges: Vec<Vec<usize>>,
}

impl<'d> Patch<'_, 'd> {
    fn is_triangular(&self) -> bool {
        self.corners.len() == 3
    }

    /// Index of a point of the grid.
    fn at(&self, i: usize, j: usize) -> usize {
        j * (self.counts[0] + 1) + i
    }

    /// All points (i, j) of the grid, row by row.
    fn points(&self) -> Vec<[usize; 2]> {
        let [n, m] = self.counts;
        let of_row = |j: usize| (0..=if self.is_triangular() { n.saturating_sub(j) } else { n }).map(move |i| [i, j]);
        (0..=m).flat_map(of_row).collect()
    }

    /// Position and its derivatives at a point of the grid.
    fn map_at(&self, i: usize, j: usize) -> [Vec3; 3] {
        let [n, m] = self.counts;
        self.map.at(i as f64 / n as f64, j as f64 / m as f64)
    }

    /// Makes the nodes of the patch, except those that an earlier patch shares with it. The edges made before an error are kept
    /// in `grid`.
    pub fn make_nodes(
        &mut self,
        grid: &mut Grid,
        edges: &mut Edges,
        nodes: &mut Nodes,
        report: &mut Report<'d>,
    ) -> Option<()> {
        for (k, edge) in self.edge_points().into_iter().enumerate() {
            let line = self.edge(k, &edge, edges, nodes, report)?;
            edge.iter().zip(&line).for_each(|(&[i, j], &node)| grid.nodes[self.at(i, j)] = Some(node));
            grid.edges.push(line);
        }
        let points = self.points();
        nodes.reserve(points.iter().filter(|&&[i, j]| grid.nodes[self.at(i, j)].is_none()).count());
        for [i, j] in points {
            if grid.nodes[self.at(i, j)].is_none() {
                grid.nodes[self.at(i, j)] = Some(self.add_node(self.map_at(i, j)[0], nodes));
            }
        }
        Some(())
    }

    /// The normals at all points of the grid, as yet without nodes.
    pub fn grid(&self, report: &mut Report<'d>) -> Option<Grid> {
        let [n, m] = self.counts;
        let mut normals = vec![Vec3::zeros(); (n + 1) * (m + 1)];
        for [i, j] in self.points() {
            let [_, by_s, by_t] = self.map_at(i, j);
            let normal = by_s.cross(&by_t);
            if normal.norm() <= 1e-9 * by_s.norm_squared().max(by_t.norm_squared()) {
                let message = format!("{} has no area near one of its corners", self.owner.what);
                let hint = "list the corners in order round the patch, at different places";
                return report.error_with(self.owner.span, message, hint);
            }
            normals[self.at(i, j)] = normal.normalize();
        }
        Some(Grid { nodes: vec![None; normals.len()], normals, edges: Vec::new() })
    }

    /// Points of the grid along each edge, from corner to corner.
    fn edge_points(&self) -> Vec<Vec<[usize; 2]>> {
        let [n, m] = self.counts;
        if self.is_triangular() {
            return vec![
                (0..=n).map(|k| [k, 0]).collect(),
                (0..=n).map(|k| [n - k, k]).collect(),
                (0..=n).map(|k| [0, n - k]).collect(),
            ];
        }
        vec![
            (0..=n).map(|k| [k, 0]).collect(),
            (0..=m).map(|k| [n, k]).collect(),
            (0..=n).map(|k| [n - k, m]).collect(),
            (0..=m).map(|k| [0, m - k]).collect(),
        ]
    }

    /// Nodes of an edge from its first end to its second: those of an earlier patch that has the same edge, or new ones.
    fn edge(
        &mut self,
        k: usize,
        points: &[[usize; 2]],
        edges: &mut Edges,
        nodes: &mut Nodes,
        report: &mut Report<'d>,
    ) -> Option<Vec<usize>> {
        let ends = [self.corners[k], self.corners[(k + 1) % self.corners.len()]];
        let middles = match self.is_triangular() {
            true => [(0.5, 0.0), (0.5, 0.5), (0.0, 0.5), (0.0, 0.5)],
            false => [(0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5)],
        };
        let middle = self.map.at(middles[k].0, middles[k].1)[0];
        let size = (nodes.x(ends[1]) - nodes.x(ends[0])).norm();
        let reversed = [ends[1], ends[0]];
        let same =
            |edge: &&Edge| (edge.ends == ends || edge.ends == reversed) && (edge.middle - middle).norm() < 1e-6 * size;
        let count = points.len() - 1;
        if let Some(edge) = edges.0.iter().find(same) {
            if edge.order != self.order {
                let (what, other) = (&self.owner.what, &edge.patch);
                let message = format!("{what} shares an edge with shell `{other}`, whose elements have another order");
                let hint = "patches that share an edge need elements of the same `order`";
                return report.error_with(self.owner.span, message, hint);
            }
            let there = (edge.nodes.len() - 1) / self.order;
            let count = count / self.order;
            if there != count {
                let (what, other) = (&self.owner.what, &edge.patch);
                let message = format!("{what} has {count} elements along an edge where shell `{other}` has {there}");
                return report.error_with(
                    self.owner.span,
                    message,
                    "patches that share an edge need the same number of elements along it",
                );
            }
            let mut shared = edge.nodes.clone();
            if edge.ends != ends {
                shared.reverse();
            }
            return Some(shared);
        }
        let mut line = vec![ends[0]];
        for &[i, j] in &points[1..count] {
            line.push(self.add_node(self.map_at(i, j)[0], nodes));
        }
        line.push(ends[1]);
        edges.0.push(Edge { ends, nodes: line.clone(), middle, order: self.order, patch: self.name.to_owned() });
        Some(line)
    }

    fn add_node(&mut self, x: Vec3, nodes: &mut Nodes) -> usize {
        self.made += 1;
        let node = nodes.add(format!("{}[{}]", self.name, self.made), false, x);
        nodes.connect(node, true);
        node
    }

    /// Elements between the nodes of a grid, row by row.
    pub fn elements(&self, grid: &Grid, triangles: bool) -> Vec<ShellElement> {
        let [n, m] = self.counts.map(|count| count / self.order);
        let mut elements = Vec::with_capacity(if triangles && !self.is_triangular() { 2 * n * m } else { n * m });
        // Corners as points of the grid of elements.
        let mut add = |of: &[[usize; 2]]| {
            let places = self.places(of);
            let nodes: Vec<usize> = places.iter().map(|&place| grid.nodes[place].unwrap_or_default()).collect();
            let normals: Vec<Vec3> = places.iter().map(|&place| grid.normals[place]).collect();
            elements.push(ShellElement::new(&nodes, &normals));
        };
        for j in 0..m {
            for i in 0..n {
                let [a, b, c, d] = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
                match (self.is_triangular(), triangles) {
                    (true, _) if i + j < n => {
                        add(&[a, b, d]);
                        if i + j + 1 < n {
                            add(&[b, c, d]);
                        }
                    }
                    (true, _) => {}
                    (_, false) => add(&[a, b, c, d]),
                    // Diagonals alternate, so that no direction is preferred.
                    (_, true) if (i + j) % 2 == 0 => [[a, b, c], [a, c, d]].iter().for_each(|t| add(t)),
                    (_, true) => [[a, b, d], [b, c, d]].iter().for_each(|t| add(t)),
                }
            }
        }
        elements
    }

    /// The places in the grid of the nodes of an element with these corners.
    fn places(&self, corners: &[[usize; 2]]) -> Vec<usize> {
        let at = |i: usize, j: usize| self.at(i, j);
        if self.order == 1 {
            return corners.iter().map(|&[i, j]| at(i, j)).collect();
        }
        let n = corners.len();
        let side = |k: usize| {
            let ([a, b], [c, d]) = (corners[k], corners[(k + 1) % n]);
            at(a + c, b + d)
        };
        let mut places: Vec<usize> = corners.iter().map(|&[i, j]| at(2 * i, 2 * j)).collect();
        places.extend((0..n).map(side));
        if n == 4 {
            places.push(at(corners[0][0] + corners[2][0], corners[0][1] + corners[2][1]));
        }
        places
    }
}
