//! Convex polyhedra: corners, faces and edges about an origin inside.

use super::{Mat3, Vec3};
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Corners closer to a plane than this part of the size lie in it: decks have some digits only.
const FLAT: f64 = 1e-6;

/// Largest number of points of a hull.
pub const MOST_POINTS: usize = 100;
/// Most corners of a hull: what two of them have in common is computed with room for so many.
pub const MOST_CORNERS: usize = 32;

/// A face of a polyhedron.
#[derive(Debug, Clone, PartialEq)]
pub struct PolyhedronFace {
    /// Unit normal, outward.
    pub normal: Vec3,
    /// The distance of its plane from the origin.
    pub offset: f64,
    /// Its corners by number, counter-clockwise seen from outside.
    pub corners: Vec<usize>,
}

/// An edge of a polyhedron.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PolyhedronEdge {
    /// Its ends by number.
    pub ends: [usize; 2],
    /// The faces at both sides by number.
    pub faces: [usize; 2],
}

/// A convex polyhedron about its centre of volume.
#[derive(Debug, Clone, PartialEq)]
pub struct Polyhedron {
    corners: Vec<Vec3>,
    faces: Vec<PolyhedronFace>,
    edges: Vec<PolyhedronEdge>,
    half: Option<Vec3>,
    reach: f64,
    least: f64,
}

/// Why points have no hull.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoHull {
    /// All lie in one plane, or nearly so.
    Flat,
    /// The hull has so many corners.
    TooManyCorners(usize),
    /// Points lie so close to edges or faces that rounding decides whether they are corners.
    Ragged,
}

/// Volume, centre, and variance of positions in a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolidMoments {
    /// The volume.
    pub volume: f64,
    /// The centre.
    pub mean: Vec3,
    /// The mean of the products of positions about the centre.
    pub variance: Mat3,
}

impl Polyhedron {
    /// The cuboid with half these edges along the axes.
    pub fn cuboid(half: Vec3) -> Polyhedron {
        let corners: Vec<Vec3> = (0..8).map(|k| box_corner(k).component_mul(&half)).collect();
        let mut faces = Vec::new();
        for k in 0..3 {
            let (i, j) = (1 << ((k + 1) % 3), 1 << ((k + 2) % 3));
            // Counter-clockwise about the axis, and about its opposite.
            let (high, low) = (1 << k, 0);
            let around = [vec![high | i | j, high | j, high, high | i], vec![low | i | j, low | i, low, low | j]];
            for (around, side) in around.into_iter().zip([1.0, -1.0]) {
                faces.push(PolyhedronFace { normal: Vec3::ith(k, side), offset: half[k], corners: around });
            }
        }
        Polyhedron { half: Some(half), ..Polyhedron::of_faces(corners, faces) }
    }

    /// The regular prism along the third axis with corners at a radius from it; the middle of one of its sides lies on the first.
    pub fn prism(sides: usize, radius: f64, half: f64) -> Polyhedron {
        let place = |k: usize, z: f64| {
            let (sine, cosine) = (TAU * (k as f64 - 0.5) / sides as f64).sin_cos();
            Vec3::new(radius * cosine, radius * sine, z)
        };
        let corners = [-half, half].into_iter().flat_map(|z| (0..sides).map(move |k| (k, z)));
        let corners: Vec<Vec3> = corners.map(|(k, z)| place(k, z)).collect();
        let end = |side: f64, corners: Vec<usize>| PolyhedronFace { normal: Vec3::z() * side, offset: half, corners };
        let mut faces = vec![end(-1.0, (0..sides).rev().collect()), end(1.0, (sides..2 * sides).collect())];
        let mut edges = Vec::new();
        let offset = radius * (0.5 * TAU / sides as f64).cos();
        for k in 0..sides {
            let (next, own, before) = ((k + 1) % sides, 2 + k, 2 + (k + sides - 1) % sides);
            let (sine, cosine) = (TAU * k as f64 / sides as f64).sin_cos();
            let around = vec![k, next, sides + next, sides + k];
            faces.push(PolyhedronFace { normal: Vec3::new(cosine, sine, 0.0), offset, corners: around });
            edges.push(PolyhedronEdge { ends: [k, next], faces: [own, 0] });
            edges.push(PolyhedronEdge { ends: [sides + k, sides + next], faces: [1, own] });
            edges.push(PolyhedronEdge { ends: [k, sides + k], faces: [before, own] });
        }
        let least = 2.0 * offset.min(half);
        Polyhedron { corners, faces, edges, half: None, reach: radius.hypot(half), least }
    }

    /// The convex hull of points, about its centre of volume, and that centre. `points` are at most [`MOST_POINTS`].
    pub fn hull(points: &[Vec3]) -> Result<(Polyhedron, Vec3), NoHull> {
        let middle = points.iter().sum::<Vec3>() / points.len().max(1) as f64;
        let points: Vec<Vec3> = points.iter().map(|x| x - middle).collect();
        let size = points.iter().map(Vec3::norm).fold(0.0, f64::max);
        let points = apart(&points, FLAT * size);
        let faces = planes(&points, FLAT * size);
        let used: BTreeSet<usize> = faces.iter().flat_map(|(_, around)| around.iter().copied()).collect();
        if faces.len() < 4 {
            return Err(NoHull::Flat);
        }
        if used.len() > MOST_CORNERS {
            return Err(NoHull::TooManyCorners(used.len()));
        }
        let place = |corner: &usize| used.range(..corner).count();
        let corners: Vec<Vec3> = used.iter().map(|&k| points[k]).collect();
        let around: Vec<Vec<usize>> = faces.iter().map(|(_, around)| around.iter().map(place).collect()).collect();
        let triangles = around.iter().flat_map(|around| fan(around).map(|triangle| triangle.map(|k| corners[k])));
        let moments = SolidMoments::of(triangles, &Vec3::zeros());
        let moments = moments.ok_or(NoHull::Flat)?;
        let corners: Vec<Vec3> = corners.iter().map(|x| x - moments.mean).collect();
        let face = |((normal, _), around): (&(Vec3, Vec<usize>), Vec<usize>)| {
            let offset = around.iter().map(|&k| normal.dot(&corners[k])).fold(f64::NEG_INFINITY, f64::max);
            PolyhedronFace { normal: *normal, offset, corners: around }
        };
        let faces = faces.iter().zip(around).map(face).collect();
        let hull = Polyhedron::of_faces(corners, faces);
        let sides: usize = hull.faces.iter().map(|face| face.corners.len()).sum();
        match 2 * hull.edges.len() == sides {
            _ if hull.least < 10.0 * FLAT * size => Err(NoHull::Flat),
            true => Ok((hull, middle + moments.mean)),
            false => Err(NoHull::Ragged),
        }
    }

    fn of_faces(corners: Vec<Vec3>, faces: Vec<PolyhedronFace>) -> Polyhedron {
        let sides = |face: &PolyhedronFace| -> Vec<[usize; 2]> {
            let count = face.corners.len();
            (0..count).map(|k| [face.corners[k], face.corners[(k + 1) % count]]).collect()
        };
        let mut edges = Vec::new();
        for (i, face) in faces.iter().enumerate() {
            for [a, b] in sides(face).into_iter().filter(|[a, b]| a < b) {
                let other = faces.iter().position(|other| sides(other).contains(&[b, a]));
                edges.extend(other.map(|j| PolyhedronEdge { ends: [a, b], faces: [i, j] }));
            }
        }
        let reach = corners.iter().map(Vec3::norm).fold(0.0, f64::max);
        let width = |face: &PolyhedronFace| {
            face.offset - corners.iter().map(|x| face.normal.dot(x)).fold(f64::INFINITY, f64::min)
        };
        let least = faces.iter().map(width).fold(f64::INFINITY, f64::min);
        Polyhedron { corners, faces, edges, half: None, reach, least }
    }

    /// Its corners.
    pub fn corners(&self) -> &[Vec3] {
        &self.corners
    }

    /// Its faces.
    pub fn faces(&self) -> &[PolyhedronFace] {
        &self.faces
    }

    /// Its edges, each once.
    pub fn edges(&self) -> &[PolyhedronEdge] {
        &self.edges
    }

    /// Half its edges, where it is a cuboid.
    pub fn half(&self) -> Option<&Vec3> {
        self.half.as_ref()
    }

    /// Radius of the ball about the origin that holds it.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Its least width between a face and the corner opposite.
    pub fn least(&self) -> f64 {
        self.least
    }

    /// Volume, centre and variance.
    pub fn moments(&self) -> Option<SolidMoments> {
        let triangles = self.faces.iter().flat_map(|face| fan(&face.corners).map(|k| k.map(|k| self.corners[k])));
        SolidMoments::of(triangles, &Vec3::zeros())
    }

    /// The corner that lies farthest along an axis.
    pub fn farthest(&self, axis: &Vec3) -> Vec3 {
        if let Some(half) = &self.half {
            return half.zip_map(axis, |half, along| half.copysign(along));
        }
        let mut best = (f64::NEG_INFINITY, Vec3::zeros());
        for corner in &self.corners {
            let along = corner.dot(axis);
            if along > best.0 {
                best = (along, *corner);
            }
        }
        best.1
    }

    /// Distance of a point, negative inside.
    pub fn distance(&self, y: &Vec3) -> f64 {
        if let Some(half) = &self.half {
            let q = y.abs() - half;
            return q.sup(&Vec3::zeros()).norm() + q.max().min(0.0);
        }
        let nearest = self.nearest(y);
        if nearest.free == Freedom::Face { nearest.face_distance } else { nearest.g.norm() }
    }

    /// The distance of a point, negative inside, and its gradient.
    pub fn distance_and_gradient(&self, y: &Vec3) -> (f64, Vec3) {
        let Some(half) = &self.half else {
            let nearest = self.nearest(y);
            let d = nearest.g.norm();
            return match nearest.free {
                Freedom::Face => (nearest.face_distance, nearest.normal),
                _ => (d, nearest.g / d),
            };
        };
        let q = y.abs() - half;
        let out = q.sup(&Vec3::zeros());
        let d = out.norm();
        if d > 0.0 {
            return (d, out.zip_map(y, |out, y| out.copysign(y)) / d);
        }
        let side = q.imax();
        (q[side], Vec3::ith(side, 1f64.copysign(y[side])))
    }

    /// The part of the surface that is nearest to a point.
    pub fn nearest(&self, y: &Vec3) -> NearestPart {
        let plane = |face: &PolyhedronFace| face.normal.dot(y) - face.offset;
        let mut highest = (f64::NEG_INFINITY, Vec3::z());
        for face in &self.faces {
            let face_distance = plane(face);
            if face_distance > highest.0 {
                highest = (face_distance, face.normal);
            }
        }
        let (face_distance, normal) = highest;
        if face_distance <= 0.0 {
            return NearestPart { g: face_distance * normal, face_distance, normal, free: Freedom::Face };
        }
        let over = self.faces.iter().find(|face| plane(face) > 0.0 && self.is_over(face, y));
        if let Some(face) = over {
            let (face_distance, normal) = (plane(face), face.normal);
            return NearestPart { g: face_distance * normal, face_distance, normal, free: Freedom::Face };
        }
        let mut best = NearestPart { g: Vec3::repeat(f64::INFINITY), face_distance, normal, free: Freedom::Corner };
        for edge in &self.edges {
            let [a, b] = edge.ends.map(|k| self.corners[k]);
            let way = b - a;
            let part = way.dot(&(y - a)) / way.norm_squared();
            let (g, free) = match part {
                part if part <= 0.0 => (y - a, Freedom::Corner),
                part if part >= 1.0 => (y - b, Freedom::Corner),
                part => (y - a - part * way, Freedom::Edge(way.normalize())),
            };
            if g.norm_squared() < best.g.norm_squared() {
                best = NearestPart { g, face_distance, normal, free };
            }
        }
        best
    }

    /// Calls `found` with each s where the nearest part of the surface to `from` + s `way` changes, in any order.
    ///
    /// The nearest region of an edge is bounded by the planes through it along the normals of its two faces. The nearest region of a corner
    /// is bounded by the planes through it across its edges, as far as between these normals.
    pub fn region_changes(&self, from: &Vec3, way: &Vec3, found: &mut dyn FnMut(f64)) {
        let crossing = |at: &Vec3, normal: &Vec3| {
            let s = normal.dot(&(at - from)) / normal.dot(way);
            s.is_finite().then(|| (s, from + s * way - at))
        };
        for edge in &self.edges {
            let [a, b] = edge.ends.map(|k| self.corners[k]);
            let along = b - a;
            let normals = edge.faces.map(|k| self.faces[k].normal);
            for normal in &normals {
                let Some((s, out)) = crossing(&a, &normal.cross(&along)) else { continue };
                let part = out.dot(&along);
                if out.dot(normal) >= 0.0 && (0.0..=along.norm_squared()).contains(&part) {
                    found(s);
                }
            }
            let between = normals[0].cross(&normals[1]);
            for corner in [a, b] {
                let Some((s, out)) = crossing(&corner, &along) else { continue };
                if normals[0].cross(&out).dot(&between) >= 0.0 && out.cross(&normals[1]).dot(&between) >= 0.0 {
                    found(s);
                }
            }
        }
    }

    /// True where the foot of a point lies within a face.
    fn is_over(&self, face: &PolyhedronFace, y: &Vec3) -> bool {
        let count = face.corners.len();
        (0..count).all(|k| {
            let [a, b] = [face.corners[k], face.corners[(k + 1) % count]].map(|k| self.corners[k]);
            (b - a).cross(&(y - a)).dot(&face.normal) >= 0.0
        })
    }

    /// True where it is its own image in the plane through the origin normal to a unit vector.
    pub fn is_symmetric(&self, e: &Vec3) -> bool {
        let image = |x: &Vec3| x - 2.0 * e.dot(x) * e;
        let has = |x: Vec3| self.corners.iter().any(|other| (other - x).norm() < 1e-12 * self.reach);
        self.corners.iter().all(|x| has(image(x)))
    }
}

/// The directions of motion of the nearest point on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Freedom {
    /// It lies in a face.
    Face,
    /// It lies on an edge of this direction.
    Edge(Vec3),
    /// It is a corner.
    Corner,
}

/// The part of a surface that is nearest to a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestPart {
    /// Vector from the surface to the point.
    pub g: Vec3,
    /// The distance from the plane of that face, or of the farthest; negative inside.
    pub face_distance: f64,
    /// The normal of this face.
    pub normal: Vec3,
    /// The kind of the part, by the directions in which its nearest point may move.
    pub free: Freedom,
}

impl SolidMoments {
    /// Sums over the tetrahedra between a point in the middle and the triangles around a solid; `None` where there is no volume. About
    /// a point that is far from a thin solid, the squares of its thickness would be lost.
    pub fn of(triangles: impl Iterator<Item = [Vec3; 3]>, middle: &Vec3) -> Option<SolidMoments> {
        let (mut volume, mut first, mut second) = (0.0, Vec3::zeros(), Mat3::zeros());
        for triangle in triangles {
            let [a, b, c] = triangle.map(|x| x - middle);
            let part = a.dot(&b.cross(&c)) / 6.0;
            let sum = a + b + c;
            volume += part;
            first += part / 4.0 * sum;
            second += part / 20.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
        }
        let mean = first / volume;
        let variance = second / volume - mean * mean.transpose();
        (volume > 0.0).then_some(SolidMoments { volume, mean: middle + mean, variance })
    }
}

/// The signs of the k-th corner of a box, of 8.
pub fn box_corner(k: usize) -> Vec3 {
    let sign = |bit: usize| if k >> bit & 1 == 0 { -1.0 } else { 1.0 };
    Vec3::new(sign(0), sign(1), sign(2))
}

/// The triangles about its first corner that make up a polygon.
fn fan(around: &[usize]) -> impl Iterator<Item = [usize; 3]> + '_ {
    (1..around.len().max(2) - 1).map(|k| [around[0], around[k], around[k + 1]])
}

/// Removes points that coincide with others.
fn apart(points: &[Vec3], flat: f64) -> Vec<Vec3> {
    let mut kept: Vec<Vec3> = Vec::new();
    for x in points {
        if kept.iter().all(|other| (other - x).norm() > flat) {
            kept.push(*x);
        }
    }
    kept
}

/// The planes that hold three points or more and have all others on one side: their outward normals, and their corners around them.
///
/// All triples are tested, which is robust for any set of points; a hundred points take 10 million products.
fn planes(points: &[Vec3], flat: f64) -> Vec<(Vec3, Vec<usize>)> {
    let count = points.len();
    let mut found: Vec<(Vec3, Vec<usize>)> = Vec::new();
    for i in 0..count {
        for j in i + 1..count {
            for k in j + 1..count {
                let n = (points[j] - points[i]).cross(&(points[k] - points[i]));
                // Three points nearly in line define no plane.
                let longest = (points[j] - points[i]).norm().max((points[k] - points[i]).norm());
                if n.norm() <= flat * longest {
                    continue;
                }
                for n in [n.normalize(), -n.normalize()] {
                    let at = n.dot(&points[i]);
                    if points.iter().any(|x| n.dot(x) > at + flat) {
                        continue;
                    }
                    let held: Vec<usize> = (0..count).filter(|&m| n.dot(&points[m]) > at - flat).collect();
                    if found.iter().all(|(_, others)| !held.iter().all(|m| others.contains(m))) {
                        found.retain(|(_, others)| !others.iter().all(|m| held.contains(m)));
                        found.push((n, held));
                    }
                }
            }
        }
    }
    let around = |(n, held): (Vec3, Vec<usize>)| {
        let around = convex_polygon(points, &n, held, flat);
        (n, around)
    };
    found.into_iter().map(around).filter(|(_, around)| around.len() >= 3).collect()
}

/// The corners of the convex polygon that points in a plane normal to `n` span, counter-clockwise about it.
fn convex_polygon(points: &[Vec3], n: &Vec3, mut held: Vec<usize>, flat: f64) -> Vec<usize> {
    let axes = super::frame_along(n);
    let seen = |k: usize| {
        let x = axes.tr_mul(&points[k]);
        (x.x, x.y)
    };
    held.sort_by(|&a, &b| seen(a).partial_cmp(&seen(b)).unwrap_or(std::cmp::Ordering::Equal));
    // Lower chain, then upper chain (A. M. Andrew, 1979); points on an edge are no corners.
    let left = |a: usize, b: usize, c: usize| {
        let ((ax, ay), (bx, by), (cx, cy)) = (seen(a), seen(b), seen(c));
        let turn = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
        turn > flat * (points[c] - points[a]).norm()
    };
    let chain = |order: &mut dyn Iterator<Item = usize>| {
        let mut chain: Vec<usize> = Vec::new();
        for k in order {
            while chain.len() >= 2 && !left(chain[chain.len() - 2], chain[chain.len() - 1], k) {
                chain.pop();
            }
            chain.push(k);
        }
        chain.pop();
        chain
    };
    let mut around = chain(&mut held.iter().copied());
    around.extend(chain(&mut held.iter().rev().copied()));
    around
}
