//! `[[shells]]`: patches → nodes, normals and elements.

use super::build::{Builder, Owner, chosen, span, vec3_or_zero};
use super::places::Place;
use super::{MassKind, Shell, ShellElement};
use crate::deck::shells as deck;
use crate::deck::words::{OneOrMany, Table};
use crate::diagnostic::{At, Span};
use crate::elements::shell::{DRILLING, MOST_LAYERS, Plate, Yielding};
use crate::math::{Mat3, Vec3};
use crate::names::{joined, short};
use std::collections::{HashMap, HashSet};
use std::f64::consts::{PI, TAU};

/// More elements along an edge are a slip of the keyboard, and would only exhaust memory.
const MOST_ELEMENTS: u64 = 10_000;
const MOST_IN_ALL: usize = 1_000_000;
const DEFAULT_LAYERS: usize = 5;
/// Part of its radius by which corners typed with four digits may miss a sphere.
const ROUND: f64 = 1e-3;

/// An edge between two patches that others may join.
pub(super) struct Edge {
    ends: [usize; 2],
    nodes: Vec<usize>,
    /// Half way, in parameters.
    middle: Vec3,
    patch: String,
}

/// A patch's map from (s, t) ∈ [0, 1]², corners at (0, 0), (1, 0), (1, 1), (0, 1).
struct Map {
    kind: Coordinates,
    center: Vec3,
    /// Columns: e₁, e₂ and the axis.
    axes: Mat3,
    /// Of the corners; between them they are bilinear.
    corners: [Vec3; 4],
    /// From the centre to the corners, for what is pushed out; bilinear too.
    radii: [f64; 4],
}

#[derive(Clone, Copy, PartialEq)]
enum Coordinates {
    Straight,
    /// (r, φ, z)
    Cylinder,
    /// (r, longitude, latitude)
    Sphere,
    /// Straight, then pushed out to the radius.
    Pushed,
}

impl Map {
    /// `None` where a corner has no coordinates, or the patch would go all the way round.
    fn new(kind: Coordinates, center: Vec3, axis: &Vec3, corners: [Vec3; 4]) -> Option<Map> {
        // Any axes across: the one that is the farthest from the axis leads.
        let far = Vec3::ith(axis.iamin(), 1.0);
        let e2 = axis.cross(&far).normalize();
        let axes = Mat3::from_columns(&[e2.cross(axis), e2, *axis]);
        let radii = corners.map(|x| (x - center).norm());
        let size = radii.into_iter().fold(0.0, f64::max);
        let mut map = Map { kind, center, axes, corners, radii };
        let mut last: Option<f64> = None;
        for corner in &mut map.corners {
            let y = axes.tr_mul(&(*corner - center));
            let across = y.x.hypot(y.y);
            let mut angle = y.y.atan2(y.x);
            match kind {
                Coordinates::Straight => continue,
                Coordinates::Pushed if y.norm() > 1e-9 * size => continue,
                Coordinates::Cylinder | Coordinates::Sphere if across > 1e-9 * size => {}
                _ => return None,
            }
            // The shortest way round from the corner before.
            if let Some(last) = last {
                angle += ((last - angle) / TAU).round() * TAU;
            }
            last = Some(angle);
            *corner = match kind {
                Coordinates::Cylinder => Vec3::new(across, angle, y.z),
                _ => Vec3::new(y.norm(), angle, y.z.atan2(across)),
            };
        }
        let closes = (map.corners[3].y - map.corners[0].y).abs() < PI;
        (closes || matches!(kind, Coordinates::Straight | Coordinates::Pushed)).then_some(map)
    }

    /// Position, and its derivatives by s and t.
    fn at(&self, s: f64, t: f64) -> [Vec3; 3] {
        let [a, b, c, d] = &self.corners;
        let value = (1.0 - t) * ((1.0 - s) * a + s * b) + t * ((1.0 - s) * d + s * c);
        let slopes = [(1.0 - t) * (b - a) + t * (c - d), (1.0 - s) * (d - a) + s * (c - b)];
        let turn = |r: f64, z: f64, y: Vec3| self.axes * Vec3::new(r * y.x, r * y.y, z);
        match self.kind {
            Coordinates::Straight => [value, slopes[0], slopes[1]],
            Coordinates::Cylinder => {
                let (sin, cos) = value.y.sin_cos();
                let (out, round) = (Vec3::new(cos, sin, 0.0), Vec3::new(-sin, cos, 0.0));
                let x = self.center + turn(value.x, value.z, out);
                let [by_s, by_t] = slopes.map(|d| turn(d.x, d.z, out) + turn(value.x * d.y, 0.0, round));
                [x, by_s, by_t]
            }
            Coordinates::Sphere => {
                let ((sin, cos), (up, across)) = (value.y.sin_cos(), value.z.sin_cos());
                let out = self.axes * Vec3::new(across * cos, across * sin, up);
                let round = self.axes * Vec3::new(-across * sin, across * cos, 0.0);
                let north = self.axes * Vec3::new(-up * cos, -up * sin, across);
                let [by_s, by_t] = slopes.map(|d| d.x * out + value.x * (d.y * round + d.z * north));
                [self.center + value.x * out, by_s, by_t]
            }
            Coordinates::Pushed => {
                let [a, b, c, d] = self.radii;
                let r = (1.0 - t) * ((1.0 - s) * a + s * b) + t * ((1.0 - s) * d + s * c);
                let by = [(1.0 - t) * (b - a) + t * (c - d), (1.0 - s) * (d - a) + s * (c - b)];
                let y = value - self.center;
                let (length, n) = (y.norm(), y.normalize());
                let [by_s, by_t] = [0, 1].map(|i| by[i] * n + r / length * (slopes[i] - slopes[i].dot(&n) * n));
                [self.center + r * n, by_s, by_t]
            }
        }
    }
}

impl<'d> Builder<'d> {
    pub fn shells(&mut self) {
        for (index, shell) in self.deck.shells.iter().enumerate() {
            let name = shell.name.as_ref().or(shell.group.as_ref());
            let name = name.map_or_else(|| format!("shells.{index}"), |name| name.value.clone());
            let owner = Owner { what: format!("shell `{name}`"), span: &shell.span };
            if shell.group.is_none() {
                self.need(&owner, "name", &shell.name);
            }
            self.shell_nodes.push(Vec::new());
            self.shell_edges.push(Vec::new());
            self.shell_parts.push(0..0);
            self.shell(index, name, &owner, shell);
        }
    }

    /// Goes as far as it can, so that all errors of the shell are found; `None` means there were some.
    fn shell(&mut self, index: usize, name: String, owner: &Owner<'d>, shell: &'d deck::Shell) -> Option<()> {
        let mass = chosen(&shell.mass);
        let plate = self.plate(owner, shell, mass);
        if let Some(group) = &shell.group {
            let strays = [
                ("corners", span(&shell.corners)),
                ("elements", span(&shell.elements)),
                ("kind", span(&shell.kind)),
                ("surface", span(&shell.surface)),
            ];
            self.stray("a shell made of a group of the mesh", &strays);
            let part = plate.map(|(plate, density, yielding, axis)| Shell {
                name,
                plate,
                density,
                mass,
                yielding,
                axis,
                corners: 0,
                elements: Vec::new(),
                numbers: Vec::new(),
            });
            return self.meshed_shell(index, owner, group, part);
        }
        if self.is_spoiled(owner.span, "group") {
            return None;
        }
        let corners = self.corners(owner, shell);
        let counts = self.need(owner, "elements", &shell.elements).and_then(|counts| self.shell_counts(counts));
        let corners = corners?;
        let triangles = match &shell.kind {
            Some(at) if at.value == deck::ElementKind::Quadrilateral && corners.len() == 3 => {
                return self.error(&at.span, "a patch of three corners is made of triangles");
            }
            Some(at) => at.value == deck::ElementKind::Triangle,
            None => corners.len() == 3,
        };
        let map = self.map(owner, shell, &corners)?;
        let [n, m] = counts?;
        if corners.len() == 3 && n != m {
            let place = span(&shell.elements).unwrap_or(owner.span);
            return self.error(place, "a patch of three corners has as many elements along each edge: give one number");
        }
        let (plate, density, yielding, axis) = plate?;

        let (nodes, normals) = self.patch(index, &name, owner, &map, &corners, [n, m])?;
        let at = |i: usize, j: usize| j * (n + 1) + i;
        let mut elements = Vec::new();
        let mut add = |of: &[usize]| {
            let id = |k: usize| of[k.min(of.len() - 1)];
            let element = ShellElement {
                nodes: std::array::from_fn(|k| nodes[id(k)].unwrap_or_default()),
                normals: std::array::from_fn(|k| normals[id(k)]),
            };
            elements.push(element);
        };
        for j in 0..m {
            for i in 0..n {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                match (corners.len(), triangles) {
                    (3, _) if i + j < n => {
                        add(&[a, b, d]);
                        if i + j + 1 < n {
                            add(&[b, c, d]);
                        }
                    }
                    (3, _) => {}
                    (_, false) => add(&[a, b, c, d]),
                    // Diagonals in turn, so that none leads.
                    (_, true) if (i + j) % 2 == 0 => [[a, b, c], [a, c, d]].iter().for_each(|t| add(t)),
                    (_, true) => [[a, b, d], [b, c, d]].iter().for_each(|t| add(t)),
                }
            }
        }
        let corners = if triangles { 3 } else { 4 };
        if elements.iter().any(|element| self.folds(element, corners)) {
            let message = format!("{} folds back on itself", owner.what);
            return self.error_with(owner.span, message, "corners go round the patch, each at its own place");
        }
        let numbers = Vec::new();
        let place = self.model.add(Shell { name, plate, density, mass, yielding, axis, corners, elements, numbers });
        self.shell_parts[index] = place..place + 1;
        Some(())
    }

    /// True for an element that is not seen the same way round from each of its corners.
    fn folds(&self, element: &ShellElement, corners: usize) -> bool {
        let x = |k: usize| self.x(element.nodes[k % corners]);
        (0..corners).any(|k| {
            let normal = (x(k + 1) - x(k)).cross(&(x(k + corners - 1) - x(k)));
            normal.dot(&element.normals[k]) <= 0.0 || element.normals[k].dot(&element.normals[0]) <= 0.0
        })
    }

    /// The shell that a name stands for, a rigid one and one made of the group of this name too; by its index in the deck.
    pub fn shell_of(&self, place: Place) -> Option<usize> {
        let group = |group: usize| Some(self.input?.mesh.groups[group].name.as_str());
        match place {
            Place::Shell(shell) => Some(shell),
            Place::Body(body) => self.rigid.body_of.iter().find_map(|(part, of)| match part {
                Place::Shell(shell) if *of == body => Some(*shell),
                _ => None,
            }),
            Place::Group(index) => {
                let name = group(index)?;
                self.deck.shells.iter().position(|shell| shell.group.as_ref().is_some_and(|group| group.value == name))
            }
            _ => None,
        }
    }

    /// Nodes of the faces of a shell, also of a rigid one.
    pub fn faces_of(&self, shell: usize) -> Vec<Vec<usize>> {
        if let Some(faces) = self.rigid.faces.get(&shell) {
            return faces.clone();
        }
        let parts = &self.model.parts[self.shell_parts[shell].clone()];
        parts.iter().flat_map(|part| (0..part.elements()).map(|e| part.nodes(e).to_vec())).collect()
    }

    /// Pairs of nodes along which a load per length acts: the segments of a group, or edges of shells between nodes of a set,
    /// those at the border if there are any.
    pub fn line_of(&mut self, place: Place, name: &At<String>) -> Vec<[usize; 2]> {
        if let Place::Group(group) = place {
            let segments = self.group_segments(group);
            if !segments.is_empty() {
                return segments;
            }
        }
        let set: HashSet<usize> = self.nodes_of(place).into_iter().collect();
        // Each edge between two of them, with the number of its faces; in order of first appearance.
        let (mut edges, mut places): (Vec<([usize; 2], usize)>, _) = (Vec::new(), HashMap::new());
        let mut whole = false;
        for shell in 0..self.deck.shells.len() {
            for face in self.faces_of(shell) {
                whole |= face.iter().all(|node| set.contains(node));
                for (k, &a) in face.iter().enumerate() {
                    let b = face[(k + 1) % face.len()];
                    if set.contains(&a) && set.contains(&b) {
                        let next = edges.len();
                        let place = *places.entry([a.min(b), a.max(b)]).or_insert(next);
                        if place == next {
                            edges.push(([a, b], 0));
                        }
                        edges[place].1 += 1;
                    }
                }
            }
        }
        let border: Vec<[usize; 2]> = edges.iter().filter(|edge| edge.1 == 1).map(|edge| edge.0).collect();
        if !border.is_empty() {
            return border;
        }
        if whole {
            let message = format!("`{}` holds whole elements, not an edge", name.value);
            self.error_with::<()>(&name.span, message, "name the nodes along one line");
        } else if edges.is_empty() && self.sure {
            let message = format!("no edge of a shell lies between two nodes of `{}`", name.value);
            self.error_with::<()>(&name.span, message, "a load per length acts along edges of shells or segments");
        }
        edges.into_iter().map(|edge| edge.0).collect()
    }

    /// What a shell is made of: plate, density, how it yields.
    fn plate(
        &mut self,
        owner: &Owner<'d>,
        shell: &'d deck::Shell,
        mass: MassKind,
    ) -> Option<(Plate, f64, Option<Yielding>, Vec3)> {
        let thickness = self.need_positive(owner, "thickness", &shell.thickness);
        let name = self.need(owner, "material", &shell.material)?;
        let (_, material) = self.find("material", &self.deck.materials, name)?;
        let density = self.density(name, material, mass, &owner.what);
        let what = format!("material `{}`, of which {} is made,", name.value, owner.what);
        let nu = self.need(&Owner { what, span: &material.span }, "poisson_ratio", &material.poisson_ratio);
        let yielding = self.layers(owner, shell);
        let axis = shell.axis.as_ref().map_or(Some(Vec3::x()), |axis| self.unit("axis", axis));
        let E = material.youngs_modulus.as_ref()?.value;
        let plate = Plate { thickness: thickness?, E, nu: nu?.value, drilling: DRILLING };
        Some((plate, density?, yielding?, axis?))
    }

    /// Nodes of three or four corners.
    fn corners(&mut self, owner: &Owner<'d>, shell: &'d deck::Shell) -> Option<Vec<usize>> {
        let corners = self.need(owner, "corners", &shell.corners)?;
        if !(3..=4).contains(&corners.values.len()) {
            self.unsure = true;
            self.error_with::<()>(
                &corners.span,
                "a patch has three or four corners",
                "such as [\"a\", \"b\", \"c\", \"d\"]",
            );
        }
        let nodes: Vec<Option<usize>> = corners.values.iter().map(|point| self.point("corners", point)).collect();
        // What meets at these points is known even if the rest has errors.
        nodes.iter().flatten().for_each(|&node| self.touch(node, true));
        nodes.into_iter().collect::<Option<Vec<usize>>>().filter(|nodes| (3..=4).contains(&nodes.len()))
    }

    fn shell_counts(&mut self, counts: &At<OneOrMany<u64>>) -> Option<[usize; 2]> {
        let values = &counts.values;
        if values.is_empty() || values.len() > 2 {
            return self.error_with(&counts.span, "`elements` takes two numbers here", "along edge1 and along edge2");
        }
        for count in values {
            if count.value == 0 || count.value > MOST_ELEMENTS {
                return self.error(&count.span, format!("`elements` must lie between 1 and {MOST_ELEMENTS}"));
            }
        }
        let [n, m] = [values.first()?.value as usize, values.last()?.value as usize];
        if n * m > MOST_IN_ALL {
            let message = format!("{n} x {m} elements: at most {MOST_IN_ALL} in a patch are taken to be meant");
            return self.error(&counts.span, message);
        }
        self.made(n * m, &counts.span)?;
        Some([n, m])
    }

    /// How the shell yields, `Some(None)` where its material is elastic.
    fn layers(&mut self, owner: &Owner<'d>, shell: &'d deck::Shell) -> Option<Option<Yielding>> {
        // Where the material is wrong, that has been said.
        let Some(law) = self.yielding_of(&shell.material)? else {
            self.stray(&format!("{}, whose material is elastic", owner.what), &[("layers", span(&shell.layers))]);
            return Some(None);
        };
        let layers = self.count("layers", &shell.layers, DEFAULT_LAYERS);
        match &shell.layers {
            Some(at) if !(2..=MOST_LAYERS).contains(&layers) => {
                self.error(&at.span, format!("`layers` must lie between 2 and {MOST_LAYERS}"))
            }
            _ => Some(Some(Yielding { law, layers })),
        }
    }

    fn map(&mut self, owner: &Owner<'d>, shell: &'d deck::Shell, corners: &[usize]) -> Option<Map> {
        let (mut kind, mut center, mut axis) = (Coordinates::Straight, Vec3::zeros(), Vec3::z());
        let mut place = owner.span;
        if let Some(surface) = &shell.surface {
            (kind, axis) = self.surface(surface)?;
            center = vec3_or_zero(&surface.center);
            place = &surface.span;
        } else if self.is_spoiled(owner.span, "surface") {
            return None;
        }
        if matches!(kind, Coordinates::Sphere | Coordinates::Pushed) {
            self.on_a_sphere(place, center, corners)?;
        }
        let x = |i: usize| self.model.nodes[corners[i]].x;
        let three = corners.len() == 3;
        // Three corners: a corner beyond the third edge makes the coordinates linear.
        let fourth = if three { x(2) } else { x(3) };
        let mut map = match Map::new(kind, center, &axis, [x(0), x(1), x(2), fourth]) {
            Some(map) => map,
            None => {
                let message = "this surface has no place for the corners";
                return self.error_with(
                    place,
                    message,
                    "a corner lies on the axis, or the patch goes all the way round it",
                );
            }
        };
        if three {
            let [a, b, c, _] = map.corners;
            map.corners = [a, b, b + c - a, c];
            let [a, b, c, _] = map.radii;
            map.radii = [a, b, b + c - a, c];
        }
        Some(map)
    }

    /// Reports corners of a sphere at different distances from its centre.
    fn on_a_sphere(&mut self, place: &Span, center: Vec3, corners: &[usize]) -> Option<()> {
        let distances: Vec<f64> = corners.iter().map(|&corner| (self.x(corner) - center).norm()).collect();
        let (least, most) = distances.iter().fold((f64::INFINITY, 0.0f64), |(a, b), &r| (a.min(r), b.max(r)));
        if most - least <= ROUND * most {
            return Some(());
        }
        let of = corners.iter().zip(&distances);
        let list: Vec<String> =
            of.map(|(&corner, &r)| format!("`{}` {}", self.model.nodes[corner].label, short(r))).collect();
        let words: Vec<&str> = list.iter().map(String::as_str).collect();
        let message = "the corners of a sphere must lie at the same distance from its `center`";
        self.error_with(place, message, format!("distances: {}", joined(&words)))
    }

    fn surface(&mut self, surface: &'d At<Table<deck::Surface>>) -> Option<(Coordinates, Vec3)> {
        let owner = Owner { what: "`surface`".to_owned(), span: &surface.span };
        match (self.need(&owner, "kind", &surface.kind)?.value, &surface.axis) {
            (deck::SurfaceKind::Sphere, None) => Some((Coordinates::Pushed, Vec3::z())),
            (deck::SurfaceKind::Sphere, Some(axis)) => Some((Coordinates::Sphere, self.unit("axis", axis)?)),
            (deck::SurfaceKind::Cylinder, _) => {
                let axis = self.need(&owner, "axis", &surface.axis)?;
                Some((Coordinates::Cylinder, self.unit("axis", axis)?))
            }
        }
    }

    /// Nodes and normals of a patch, row by row; without a node where a patch of three corners has none.
    #[allow(clippy::type_complexity)]
    fn patch(
        &mut self,
        index: usize,
        name: &str,
        owner: &Owner<'d>,
        map: &Map,
        corners: &[usize],
        [n, m]: [usize; 2],
    ) -> Option<(Vec<Option<usize>>, Vec<Vec3>)> {
        let three = corners.len() == 3;
        let st = |i: usize, j: usize| (i as f64 / n as f64, j as f64 / m as f64);
        let at = |i: usize, j: usize| j * (n + 1) + i;
        let inside = |i: usize, j: usize| !three || i + j <= n;
        let (mut nodes, mut normals) = (vec![None; (n + 1) * (m + 1)], vec![Vec3::zeros(); (n + 1) * (m + 1)]);
        for j in 0..=m {
            for i in (0..=n).filter(|&i| inside(i, j)) {
                let (s, t) = st(i, j);
                let [_, by_s, by_t] = map.at(s, t);
                let normal = by_s.cross(&by_t);
                if normal.norm() <= 1e-9 * by_s.norm_squared().max(by_t.norm_squared()) {
                    let message = format!("{} has no area near one of its corners", owner.what);
                    return self.error_with(owner.span, message, "corners go round the patch, each at its own place");
                }
                normals[at(i, j)] = normal.normalize();
            }
        }
        let edges: Vec<Vec<usize>> = if three {
            let along = |of: &dyn Fn(usize) -> usize| (0..=n).map(of).collect();
            vec![along(&|k| at(k, 0)), along(&|k| at(n - k, k)), along(&|k| at(0, n - k))]
        } else {
            vec![
                (0..=n).map(|k| at(k, 0)).collect(),
                (0..=m).map(|k| at(n, k)).collect(),
                (0..=n).map(|k| at(n - k, m)).collect(),
                (0..=m).map(|k| at(0, m - k)).collect(),
            ]
        };
        let position = |of: usize| {
            let (s, t) = st(of % (n + 1), of / (n + 1));
            map.at(s, t)[0]
        };
        let mut made = 0;
        let mut label = || {
            made += 1;
            format!("{name}[{made}]")
        };
        for (k, edge) in edges.iter().enumerate() {
            let ends = [corners[k], corners[(k + 1) % corners.len()]];
            let middles = if three {
                [(0.5, 0.0), (0.5, 0.5), (0.0, 0.5)].to_vec()
            } else {
                [(0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5)].to_vec()
            };
            let middle = map.at(middles[k].0, middles[k].1)[0];
            let line = self.edge(name, owner, ends, middle, edge.len() - 1, |of| position(edge[of]), &mut label)?;
            edge.iter().zip(&line).for_each(|(&of, &node)| nodes[of] = Some(node));
            self.shell_edges[index].push(line);
        }
        for j in 0..=m {
            for i in (0..=n).filter(|&i| inside(i, j)) {
                if nodes[at(i, j)].is_none() {
                    let node = self.node(label(), false, position(at(i, j)));
                    self.touch(node, true);
                    nodes[at(i, j)] = Some(node);
                }
            }
        }
        self.shell_nodes[index] = nodes.iter().copied().flatten().collect();
        Some((nodes, normals))
    }

    /// Nodes of an edge from its first end to its second: those of an earlier patch that has the same edge, or new ones.
    #[allow(clippy::too_many_arguments)]
    fn edge(
        &mut self,
        name: &str,
        owner: &Owner<'d>,
        ends: [usize; 2],
        middle: Vec3,
        count: usize,
        position: impl Fn(usize) -> Vec3,
        label: &mut impl FnMut() -> String,
    ) -> Option<Vec<usize>> {
        let size = (self.x(ends[1]) - self.x(ends[0])).norm();
        let reversed = [ends[1], ends[0]];
        let same =
            |edge: &&Edge| (edge.ends == ends || edge.ends == reversed) && (edge.middle - middle).norm() < 1e-6 * size;
        if let Some(edge) = self.edges.iter().find(same) {
            if edge.nodes.len() != count + 1 {
                let (here, there) = (count, edge.nodes.len() - 1);
                let message = format!(
                    "{} has {here} elements along an edge where shell `{}` has {there}",
                    owner.what, edge.patch
                );
                return self.error_with(owner.span, message, "patches that meet need the same number there");
            }
            let mut nodes = edge.nodes.clone();
            if edge.ends != ends {
                nodes.reverse();
            }
            return Some(nodes);
        }
        let mut nodes = vec![ends[0]];
        for k in 1..count {
            let node = self.node(label(), false, position(k));
            self.touch(node, true);
            nodes.push(node);
        }
        nodes.push(ends[1]);
        self.edges.push(Edge { ends, nodes: nodes.clone(), middle, patch: name.to_owned() });
        Some(nodes)
    }
}
