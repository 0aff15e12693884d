//! The mesh of a section: triangles with six nodes.
//!
//! Edges of polygons are cut into pieces of the mesh size first, so that the meshes of two polygons meet at the nodes of their common edge. Then
//! each polygon is triangulated alone (constrained Delaunay with refinement after Ruppert and Chew, of the library spade).

use super::outlines::{Outlines, Ring, distance, edges, size, undirected};
use spade::handles::{FixedFaceHandle, InnerTag};
use spade::{AngleLimit, ConstrainedDelaunayTriangulation, Point2, RefinementParameters, Triangulation};
use std::collections::{BTreeMap, HashMap, HashSet};

/// Area of an equilateral triangle over the square of its edge, and the share of larger triangles that the refinement splits.
const LARGEST_AREA: f64 = 0.433 * 1.3;

/// The smallest angle that refinement aims at, in degrees: it ends for sure below 30.
const LEAST_ANGLE: f64 = 25.0;

/// Largest difference of the areas of a polygon and of its triangles, over the former: above rounding.
const FILLED: f64 = 1e-9;

/// Most triangles by the default mesh size, about: a thin wall then has one across it, whose quadratic warping has its torsion.
const MOST_BY_DEFAULT: f64 = 6000.0;

/// Most triangles by a given mesh size.
const MOST: f64 = 200_000.0;

/// The triangles of a section. Lengths are parts of [`SectionMesh::scale`], from [`SectionMesh::origin`].
pub(super) struct SectionMesh {
    /// Nodes (y, z).
    pub nodes: Vec<[f64; 2]>,
    /// Six nodes of each triangle: its corners counter-clockwise, and the middles of the edges from corners 0, 1 and 2.
    pub triangles: Vec<[usize; 6]>,
    /// The number of nodes on edges of polygons, which come first, without the middles of the edges of triangles.
    pub edge_nodes: usize,
    /// The polygon of each triangle.
    pub polygons: Vec<usize>,
    /// The diagonal of the box around the section.
    pub scale: f64,
    /// The point of the section that is the origin of the mesh, in the coordinates of the deck.
    pub origin: [f64; 2],
    /// The mesh size over that by the shape, of the polygon where it is largest; 1 by default.
    pub coarseness: f64,
}

/// Why there is no mesh.
pub(super) enum MeshFault {
    /// The mesh size asks for too many triangles: about so many.
    TooFine(f64),
    /// The triangulation failed, or its refinement ended before its triangles were small enough.
    Failed,
    /// So many pieces do not meet along an edge.
    Pieces(usize),
}

impl SectionMesh {
    /// Triangulates polygons; `mesh_size` is the length of edges, `None` for that by the shape of each polygon.
    ///
    /// # Errors
    /// Too many triangles, or polygons that do not meet along edges.
    pub fn new(outlines: &Outlines, mesh_size: Option<f64>) -> Result<SectionMesh, MeshFault> {
        let scale = size(outlines.corners.iter());
        let origin = outlines.corners[0];
        let mut nodes: Vec<[f64; 2]> =
            outlines.corners.iter().map(|at| [0, 1].map(|k| (at[k] - origin[k]) / scale)).collect();
        let areas: Vec<f64> =
            outlines.rings.iter().map(|rings| rings.iter().map(|ring| area(&nodes, ring)).sum()).collect();
        let (sizes, coarseness) = sizes(&nodes, outlines, &areas, mesh_size.map(|size| size / scale))?;
        let rings = divided(&mut nodes, outlines, &sizes);
        let edge_nodes = nodes.len();
        let (triangles, polygons) = (Vec::new(), Vec::new());
        let mut mesh = SectionMesh { nodes, edge_nodes, triangles, polygons, scale, origin, coarseness };
        for (polygon, rings) in rings.iter().enumerate() {
            mesh.fill(polygon, rings, sizes[polygon], areas[polygon]).ok_or(MeshFault::Failed)?;
        }
        match mesh.pieces() {
            1 => {}
            pieces => return Err(MeshFault::Pieces(pieces)),
        }
        mesh.add_middles();
        Ok(mesh)
    }

    /// Triangulates one polygon; `None` where the library refuses its points, or where triangles do not fill it.
    fn fill(&mut self, polygon: usize, rings: &[Ring], size: f64, area: f64) -> Option<()> {
        let mut plane = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
        let mut numbers: HashMap<[u64; 2], usize> = HashMap::new();
        for ring in rings {
            let corners = ring.iter().map(|&node| plane.insert(Point2::from(self.nodes[node])));
            let corners: Vec<_> = corners.collect::<Result<_, _>>().ok()?;
            numbers.extend(ring.iter().map(|&node| (self.nodes[node].map(f64::to_bits), node)));
            for (k, &corner) in corners.iter().enumerate() {
                let next = corners[(k + 1) % corners.len()];
                if !plane.can_add_constraint(corner, next) {
                    return None;
                }
                plane.add_constraint(corner, next);
            }
        }
        let largest = LARGEST_AREA * size * size;
        let parameters = RefinementParameters::new()
            .exclude_outer_faces(true)
            .keep_constraint_edges()
            .with_max_allowed_area(largest)
            .with_angle_limit(AngleLimit::from_deg(LEAST_ANGLE))
            .with_max_additional_vertices(1000 + (10.0 * area / largest) as usize);
        let result = plane.refine(parameters);
        if !result.refinement_complete {
            return None;
        }
        let outside: HashSet<FixedFaceHandle<InnerTag>> = result.excluded_faces.into_iter().collect();
        let inside = || plane.inner_faces().filter(|face| !outside.contains(&face.fix()));
        if (inside().map(|face| face.area()).sum::<f64>() - area).abs() > FILLED * area {
            return None;
        }
        for face in inside() {
            let corners = face.positions().map(|at| {
                let at = [at.x, at.y];
                *numbers.entry(at.map(f64::to_bits)).or_insert_with(|| {
                    self.nodes.push(at);
                    self.nodes.len() - 1
                })
            });
            let [a, b, c] = corners;
            self.triangles.push([a, b, c, a, b, c]);
            self.polygons.push(polygon);
        }
        Some(())
    }

    /// The number of pieces that edges join.
    fn pieces(&self) -> usize {
        let mut group: Vec<usize> = (0..self.triangles.len()).collect();
        fn first(group: &mut [usize], mut of: usize) -> usize {
            while group[of] != of {
                group[of] = group[group[of]];
                of = group[of];
            }
            of
        }
        let mut sides: HashMap<(usize, usize), usize> = HashMap::new();
        for (number, triangle) in self.triangles.iter().enumerate() {
            for edge in edges(&triangle[..3]).map(undirected) {
                if let Some(&other) = sides.get(&edge) {
                    let (one, two) = (first(&mut group, number), first(&mut group, other));
                    group[one.max(two)] = one.min(two);
                }
                sides.insert(edge, number);
            }
        }
        (0..group.len()).filter(|&number| group[number] == number).count()
    }

    /// Adds the nodes in the middles of edges.
    fn add_middles(&mut self) {
        let mut middles: HashMap<(usize, usize), usize> = HashMap::new();
        for triangle in &mut self.triangles {
            for side in 0..3 {
                let (a, b) = (triangle[side], triangle[(side + 1) % 3]);
                triangle[3 + side] = *middles.entry(undirected((a, b))).or_insert_with(|| {
                    let [p, q] = [self.nodes[a], self.nodes[b]];
                    self.nodes.push([0, 1].map(|k| 0.5 * (p[k] + q[k])));
                    self.nodes.len() - 1
                });
            }
        }
    }
}

/// The area left of a ring.
fn area(nodes: &[[f64; 2]], ring: &[usize]) -> f64 {
    edges(ring).map(|(a, b)| 0.5 * (nodes[a][0] * nodes[b][1] - nodes[a][1] * nodes[b][0])).sum()
}

/// The length of edges in each polygon, and the largest ratio of it to that by the shape.
fn sizes(
    nodes: &[[f64; 2]],
    outlines: &Outlines,
    areas: &[f64],
    given: Option<f64>,
) -> Result<(Vec<f64>, f64), MeshFault> {
    let all: f64 = areas.iter().sum();
    let least = (all / (0.433 * MOST_BY_DEFAULT)).sqrt();
    let by_shape = outlines.rings.iter().zip(areas).map(|(rings, area)| {
        let sides = rings.iter().flat_map(|ring| edges(ring)).map(|(a, b)| distance(nodes[a], nodes[b]));
        (2.0 / 3.0 * area / sides.sum::<f64>()).min(area.sqrt() / 16.0).max(least)
    });
    let by_shape: Vec<f64> = by_shape.collect();
    let Some(given) = given else { return Ok((by_shape, 1.0)) };
    let triangles = all / (0.433 * given * given);
    if triangles > MOST {
        return Err(MeshFault::TooFine(triangles));
    }
    let least = by_shape.into_iter().fold(f64::INFINITY, f64::min);
    Ok((vec![given; areas.len()], given / least))
}

/// Cuts the edges of all rings into pieces of the size of the finer polygon beside them.
fn divided(nodes: &mut Vec<[f64; 2]>, outlines: &Outlines, sizes: &[f64]) -> Vec<Vec<Ring>> {
    let mut finest: BTreeMap<(usize, usize), f64> = BTreeMap::new();
    for (rings, &size) in outlines.rings.iter().zip(sizes) {
        for edge in rings.iter().flat_map(|ring| edges(ring)).map(undirected) {
            let least = finest.entry(edge).or_insert(size);
            *least = least.min(size);
        }
    }
    let mut inner: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for (&(a, b), &size) in &finest {
        let [p, q] = [nodes[a], nodes[b]];
        let pieces = (distance(p, q) / size).ceil().max(1.0) as usize;
        let between = (1..pieces).map(|k| {
            let part = k as f64 / pieces as f64;
            nodes.push([0, 1].map(|axis| p[axis] + part * (q[axis] - p[axis])));
            nodes.len() - 1
        });
        inner.insert((a, b), between.collect());
    }
    let divide = |ring: &Ring| {
        let mut divided = Vec::new();
        for (a, b) in edges(ring) {
            divided.push(a);
            let between = &inner[&undirected((a, b))];
            match a < b {
                true => divided.extend(between),
                false => divided.extend(between.iter().rev()),
            }
        }
        divided
    };
    outlines.rings.iter().map(|rings| rings.iter().map(divide).collect()).collect()
}
