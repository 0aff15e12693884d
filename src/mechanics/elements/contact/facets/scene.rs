//! The constant data of points and facets that may touch.

use super::facet::{Ball, Facet};
use super::lines;
use super::memory;
use super::mesh;
use crate::elements::contact::grid::GridBox;
use crate::elements::contact::history::{self, PairMemory};
use crate::elements::contact::law::ContactLaw;
use crate::elements::contact::point::{ContactPoint, TouchKind};
use crate::state::Node;
use base::math::Vec3;
use std::borrow::Cow;
use std::collections::HashMap;

/// The part of a line next to its ends that counts as these.
const AT_END: f64 = 1e-9;
/// Facets that a point may touch at once: two walls and a floor.
const MOST_FACES: usize = 3;
/// Number of lines that a line may touch at once; each memory stays with the line.
const MOST_LINES: usize = 8;
/// Number of balls at least as large that a ball may touch at once: twelve of its size, and two for rounding and penetration.
const MOST_BALLS: usize = 14;

/// Points with equally many nodes against a surface of facets.
pub struct FacetScene {
    /// The contact law.
    pub(super) law: ContactLaw,
    /// The points.
    pub(super) points: Vec<ContactPoint>,
    /// The facets.
    pub(super) facets: Vec<Facet>,
    /// For each point, the facets that it cannot touch because they are near along the surface, in ascending order; empty without
    /// self-contact.
    near_along: Vec<Vec<u32>>,
    /// True where the facets are balls, and each pair of them counts once.
    pub(super) is_of_balls: bool,
    /// These balls.
    pub(super) balls: Vec<Ball>,
    /// True where the points are the balls themselves, in the same order.
    is_among: bool,
    /// True where the points are lines between their two nodes, and the facets lines too.
    pub(super) is_of_lines: bool,
    /// True for edges: these lines touch only where they cross, and their ends are separate points.
    pub(super) is_of_edges: bool,
    /// For touching lines and for line facets: by node, the lines meeting there with their other ends.
    line_ends: [LineEnds; 2],
    /// True where forces on the surface are forces of the surface, and have no resultant.
    pub(super) is_inner: bool,
    /// All nodes that take part, in ascending order.
    pub(super) involved: Vec<usize>,
    /// The nodes with moments from friction.
    pub(super) turned: Vec<usize>,
    /// Length as a fraction of the mean facet size: closer pairs are remembered, and lists hold while no node moves farther.
    pub(super) margin: f64,
    /// The size of the cells for the search of facets.
    pub(super) cell: f64,
    /// Number of facets that a point remembers.
    pub(super) slots: usize,
    /// Number of history variables of a pair.
    pub(super) width: usize,
    /// Friction turns nodes: their rotations belong to the history.
    pub(super) rolls: bool,
}

/// The bodies that touch a surface of facets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FacetTouchers {
    /// Points of something else.
    Others,
    /// The nodes of the surface itself; of lines, these lines in the same order.
    Itself,
    /// The balls among themselves; the facets list the same balls.
    Among,
}

/// For each point the facets near it along the surface, in self-contact.
fn near_along(
    touchers: FacetTouchers,
    (points, facets): (&[ContactPoint], &[Facet]),
    is_of_lines: bool,
    x: &[Vec3],
) -> Vec<Vec<u32>> {
    match touchers {
        FacetTouchers::Itself if is_of_lines => lines_near_along(points, facets, x),
        FacetTouchers::Itself => {
            let nodes: Vec<usize> = points.iter().map(|point| point.nodes[0]).collect();
            // Half a circle about a fold as sharp as the thickness allows.
            let along = |k: usize, facet: &Facet| std::f64::consts::FRAC_PI_2 * (points[k].radius + facet.half);
            mesh::near_along(facets, &nodes, along, &|node| x[node])
        }
        FacetTouchers::Others | FacetTouchers::Among => Vec::new(),
    }
}

impl FacetScene {
    /// `points` have equally many nodes, one or more, or are lines, as all facets then are; `x` are the places of all nodes at t = 0.
    pub fn new(
        law: ContactLaw,
        touchers: FacetTouchers,
        points: Vec<ContactPoint>,
        mut facets: Vec<Facet>,
        x: &[Vec3],
    ) -> FacetScene {
        mesh::connect(&mut facets);
        // Middles have names beyond those of nodes.
        let pieces = facets.iter().enumerate().flat_map(|(k, facet)| facet.pieces(x.len() + k));
        let facets: Vec<Facet> = pieces.collect();
        let balls = Ball::all(&facets);
        let (is_of_balls, balls) = (balls.is_some(), balls.unwrap_or_default());
        let sizes: Vec<f64> = facets.iter().map(|facet| size(facet, x)).collect();
        let mean = sizes.iter().sum::<f64>() / sizes.len().max(1) as f64;
        let mut involved: Vec<usize> = points.iter().flat_map(ContactPoint::nodes).copied().collect();
        involved.extend(facets.iter().flat_map(Facet::nodes));
        involved.sort_unstable();
        involved.dedup();
        let is_of_lines = points.first().is_some_and(|point| point.is_line());
        let is_of_edges = points.first().is_some_and(|point| point.extent == TouchKind::Edge);
        let near_along = near_along(touchers, (&points, &facets), is_of_lines, x);
        let of_points = points.iter().filter(|_| is_of_lines).map(|point| [point.nodes[0], point.nodes[1]]);
        let of_facets = facets.iter().filter(|_| is_of_lines).map(|facet| [facet.nodes[0], facet.nodes[1]]);
        let line_ends = [LineEnds::new(of_points), LineEnds::new(of_facets)];
        let rubs = law.friction > 0.0;
        let rolls = rubs && points.iter().any(|point| point.rolling_radius > 0.0);
        let rotations = points.first().map_or(0, |point| if rolls { point.count } else { 0 });
        let turned = turned(&law, &points, &facets, &involved);
        FacetScene {
            width: history::width(&law, if is_of_lines { memory::OF_LINES } else { history::of_points(rotations) }),
            slots: match (is_of_balls, is_of_lines) {
                (true, _) => MOST_BALLS,
                (_, true) => MOST_LINES,
                _ => MOST_FACES,
            },
            margin: 0.25 * mean,
            cell: 2.0 * mean,
            // The lists exclude distant pairs already.
            law: ContactLaw { near: f64::INFINITY, ..law },
            is_inner: touchers != FacetTouchers::Others,
            is_among: touchers == FacetTouchers::Among,
            is_of_lines,
            is_of_edges,
            line_ends,
            points,
            facets,
            near_along,
            is_of_balls,
            balls,
            involved,
            turned,
            rolls,
        }
    }

    /// The box around a point, or around the ends of a line, at the node positions `x`.
    pub(super) fn extent(&self, e: usize, x: impl Fn(usize) -> Vec3) -> GridBox {
        if self.is_of_lines {
            return GridBox::around(self.points[e].nodes().iter().map(|&node| x(node)));
        }
        let at = self.points[e].parts().map(|(node, w)| w * x(node)).sum();
        GridBox { low: at, high: at }
    }

    /// A point; for a line its point with this share of the second end, or its middle.
    pub(super) fn point_at(&self, e: usize, share: Option<f64>) -> Cow<'_, ContactPoint> {
        let point = &self.points[e];
        match share {
            Some(share) => Cow::Owned(point.at(share)),
            None => Cow::Borrowed(point),
        }
    }

    /// The share of the second end of a line that touches in its point nearest to a facet; none for points.
    pub(super) fn share(&self, e: usize, facet: &Facet, nodes: &[Node]) -> Option<f64> {
        lines::share(&self.points[e], facet, nodes)
    }

    /// True where two lines have their minimal distance here, with `g` from the facet to the touching line. At an end, only the nearest of
    /// the lines meeting there counts. Edges count where they cross.
    pub(super) fn is_nearest(
        &self,
        e: usize,
        (facet, of_facet): (usize, f64),
        share: f64,
        g: &Vec3,
        nodes: &[Node],
    ) -> bool {
        let (own, of_facet) = (end_at(share), end_at(of_facet));
        if self.is_of_edges {
            return own.is_none()
                && of_facet.is_none()
                && !lines::are_parallel(&self.points[e], &self.facets[facet], nodes);
        }
        let ends = &self.points[e].nodes;
        let other = &self.facets[facet].nodes;
        own.is_none_or(|k| self.line_ends[0].is_least(e, ends[k], g, nodes))
            && of_facet.is_none_or(|k| self.line_ends[1].is_least(facet, other[k], &-g, nodes))
    }

    /// The lines that touch and meet at a node.
    pub(super) fn lines_at(&self, node: usize) -> impl Iterator<Item = usize> + '_ {
        self.line_ends[0].0.get(&node).into_iter().flatten().map(|(line, _)| *line)
    }

    /// The place of a node among those that take part.
    pub(super) fn place_of(&self, node: usize) -> usize {
        self.involved.partition_point(|&other| other < node)
    }

    /// False for pairs without contact: a point with its own facets, and the reversed pair of two balls.
    pub(super) fn may_touch(&self, e: usize, facet: u32) -> bool {
        if self.is_of_lines {
            let shares = self.points[e].nodes().iter().any(|node| self.facets[facet as usize].nodes().contains(node));
            return !shares && !self.is_near_along(e, facet) && (!self.is_inner || e < facet as usize);
        }
        if !self.is_among {
            return self.points[e].nodes().iter().all(|node| !self.facets[facet as usize].nodes().contains(node))
                || self.near_along.get(e).is_some();
        }
        let other = facet as usize;
        let (own, of_other) = (self.points[e].radius, self.facets[other].half);
        own < of_other || own == of_other && e < other
    }

    /// True where a facet lies near a point along the surface of both.
    pub(super) fn is_near_along(&self, e: usize, facet: u32) -> bool {
        self.near_along.get(e).is_some_and(|near| near.binary_search(&facet).is_ok())
    }

    /// The history of a point, of that of the block, from its first slot on.
    pub(super) fn of_point<'a>(&self, e: usize, history: &'a [f64]) -> &'a [f64] {
        &history[e * self.to_next_point()..]
    }

    /// The memory in a slot of a point's history.
    pub(super) fn memory<'a>(&self, history: &'a [f64], slot: usize) -> PairMemory<'a> {
        let from = slot * self.to_next_slot();
        PairMemory(&history[from..from + self.width])
    }

    /// From the slot of one point to the same slot of the next. Of balls the first slots of all come first, then the second ones: most of
    /// a heap fills few, which then lie side by side.
    pub(super) fn to_next_point(&self) -> usize {
        if self.is_of_balls { self.width } else { self.slots * self.width }
    }

    /// From one slot of a point to its next.
    pub(super) fn to_next_slot(&self) -> usize {
        if self.is_of_balls { self.points.len() * self.width } else { self.width }
    }

    /// The memories of all pairs in the history of the block that are known.
    pub(super) fn known_memories<'a>(&'a self, history: &'a [f64]) -> impl Iterator<Item = PairMemory<'a>> {
        let of_point = move |e: usize| {
            let own = self.of_point(e, history);
            let all = (0..self.slots).map(move |slot| self.memory(own, slot));
            // Balls fill their slots from the first on.
            all.take_while(|memory| !self.is_of_balls || memory.is_known())
        };
        (0..self.points.len()).flat_map(of_point).filter(|memory| memory.is_known())
    }
}

/// The nodes with moments from friction.
fn turned(law: &ContactLaw, points: &[ContactPoint], facets: &[Facet], involved: &[usize]) -> Vec<usize> {
    match law.friction > 0.0 {
        // A bar that touches as a line has no rotations.
        true if points.first().is_some_and(|point| point.is_line()) => {
            let rolling = points.iter().filter(|point| point.rolling_radius > 0.0);
            rolling.flat_map(ContactPoint::nodes).chain(facets.iter().flat_map(Facet::nodes)).copied().collect()
        }
        true => involved.to_vec(),
        false => Vec::new(),
    }
}

/// The end of a line on which a point lies, by the share of the second end. The tolerance keeps rounding from choosing the line where
/// several meet at a node.
pub(super) fn end_at(share: f64) -> Option<usize> {
    match share {
        _ if share < AT_END => Some(0),
        _ if share > 1.0 - AT_END => Some(1),
        _ => None,
    }
}

/// The lines that meet at each node, by their numbers and their other ends.
#[derive(Default)]
struct LineEnds(HashMap<usize, Vec<(usize, usize)>>);

impl LineEnds {
    fn new(lines: impl Iterator<Item = [usize; 2]>) -> LineEnds {
        let mut ends: HashMap<usize, Vec<(usize, usize)>> = HashMap::new();
        for (number, [a, b]) in lines.enumerate() {
            ends.entry(a).or_default().push((number, b));
            ends.entry(b).or_default().push((number, a));
        }
        LineEnds(ends)
    }

    /// True where no other line at the node leads against `g`, and this is the first of the lines meeting there.
    fn is_least(&self, line: usize, node: usize, g: &Vec3, nodes: &[Node]) -> bool {
        let leads_nearer = |&(_, other): &(usize, usize)| {
            let along = nodes[other].relative_position(&nodes[node]);
            g.dot(&along) < -AT_END * along.norm_squared()
        };
        let meeting = self.0.get(&node).into_iter().flatten();
        !meeting.clone().any(|of| of.0 != line && leads_nearer(of)) && meeting.map(|of| of.0).min() == Some(line)
    }
}

/// For each line those that it cannot come to touch by bending.
fn lines_near_along(points: &[ContactPoint], facets: &[Facet], x: &[Vec3]) -> Vec<Vec<u32>> {
    let ends = |k: usize| points.iter().map(move |point| point.nodes[k]);
    let nodes: Vec<usize> = ends(0).chain(ends(1)).collect();
    // Half a circle about a bend as sharp as the radius allows.
    let along = |k: usize, facet: &Facet| std::f64::consts::FRAC_PI_2 * (points[k % points.len()].radius + facet.half);
    let near = mesh::near_along(facets, &nodes, along, &|node| x[node]);
    let (first, last) = near.split_at(points.len());
    let both = |(a, b): (&Vec<u32>, &Vec<u32>)| {
        let mut all = [&a[..], &b[..]].concat();
        all.sort_unstable();
        all.dedup();
        all
    };
    first.iter().zip(last).map(both).collect()
}

/// The diameter of a facet at t = 0.
fn size(facet: &Facet, x: &[Vec3]) -> f64 {
    if facet.is_ball() {
        return 2.0 * facet.half;
    }
    let nodes = facet.nodes();
    let apart = nodes.iter().flat_map(|&a| nodes.iter().map(move |&b| (x[a] - x[b]).norm()));
    apart.fold(0.0, f64::max)
}
