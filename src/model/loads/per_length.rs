//! `[[loads]]` per length of beams and bars, as forces and moments on the nodes of their elements that do the same work.

use crate::data::{LineElement, Load, LoadOrigin, Part};
use crate::places::nodes::Topology;
use base::math::{Vec3, quadrature};
use mechanics::elements::beam;
use mechanics::sections::Stiffness;

/// Gauss points of an element, or of the linear piece of the load in it: products with polynomials of the highest order are integrated
/// exactly.
const POINTS: usize = 5;

/// A load per length.
pub struct LineLoad {
    /// Force per length.
    pub force: Vec3,
    /// True for components in section axes at t = 0.
    pub local: bool,
    /// True for a force per length projected along the force.
    pub projected: bool,
    /// True for a load that turns with the sections.
    pub follower: bool,
    /// Factors by fractions of the length of the part; straight between them, zero outside.
    pub profile: Vec<[f64; 2]>,
    /// Index of its amplitude.
    pub amplitude: Option<usize>,
}

/// An element on which a load per length acts.
struct Line<'p> {
    nodes: &'p [usize],
    ends: [Vec3; 2],
    element: LineElement,
}

impl<'p> Line<'p> {
    /// The element of a part; `None` for parts without lines.
    fn of(part: &'p Part, element: usize, (topology, stiffnesses): (&Topology, &[Stiffness])) -> Option<Line<'p>> {
        let nodes = part.nodes(element);
        let ends = [nodes[0], *nodes.last()?].map(|node| topology.x(node));
        let element = part.line(element, (ends[1] - ends[0]).norm(), stiffnesses)?;
        Some(Line { nodes, ends, element })
    }

    fn length(&self) -> f64 {
        (self.ends[1] - self.ends[0]).norm()
    }
}

/// True for a part of consecutive elements, which has a length along it.
pub fn is_chain(part: &Part) -> bool {
    (1..part.elements()).all(|element| part.nodes(element - 1).last() == part.nodes(element).first())
}

impl LineLoad {
    /// Shares of the load on the nodes of all elements of a beam or bar, which is the `index`-th part.
    pub fn over_part(&self, part: &Part, index: usize, scene: (&Topology, &[Stiffness])) -> Vec<Load> {
        let lines = || (0..part.elements()).filter_map(|element| Line::of(part, element, scene));
        let total: f64 = lines().map(|line| line.length()).sum();
        let (mut loads, mut begin) = (Vec::new(), 0.0);
        for (element, line) in lines().enumerate() {
            let end = begin + line.length() / total;
            loads.extend(self.over(&line, [begin, end], (index, element)));
            begin = end;
        }
        loads
    }

    /// Shares of the load on the nodes of a single element, with the profile along it.
    pub fn over_element(&self, part: &Part, element: (usize, usize), scene: (&Topology, &[Stiffness])) -> Vec<Load> {
        Line::of(part, element.1, scene).map_or_else(Vec::new, |line| self.over(&line, [0.0, 1.0], element))
    }

    /// Shares on an element that reaches from one fraction of the length of its part to another.
    fn over(&self, line: &Line, [begin, end]: [f64; 2], element: (usize, usize)) -> Vec<Load> {
        let axis = line.ends[1] - line.ends[0];
        let (length, tangent) = (axis.norm(), axis.normalize());
        let force = self.force_on(line, &tangent);
        let mut shares = vec![[Vec3::zeros(); 2]; line.nodes.len()];
        let (points, weights) = quadrature::gauss(POINTS);
        for piece in self.profile.windows(2) {
            let [a, b] = [piece[0][0].max(begin), piece[1][0].min(end)];
            if a >= b {
                continue;
            }
            for (&xi, w) in points.iter().zip(weights) {
                let at = 0.5 * ((1.0 - xi) * a + (1.0 + xi) * b);
                let part = (at - piece[0][0]) / (piece[1][0] - piece[0][0]);
                let factor = piece[0][1] + part * (piece[1][1] - piece[0][1]);
                let fraction = (at - begin) / (end - begin);
                let q = (0.5 * w * (b - a) / (end - begin) * length * factor) * force;
                line.share(fraction, &tangent, &q, &mut shares);
            }
        }
        let load = |(&node, [force, moment]): (&usize, [Vec3; 2])| Load {
            node,
            force,
            moment,
            follower: self.follower,
            amplitude: self.amplitude,
            origin: Some(LoadOrigin::Element(element.0, element.1)),
            moment_counts: false,
        };
        line.nodes.iter().zip(shares).filter(|(_, share)| *share != [Vec3::zeros(); 2]).map(load).collect()
    }

    /// Force per length of an element, global components.
    fn force_on(&self, line: &Line, tangent: &Vec3) -> Vec3 {
        let force = match line.element.axes.filter(|_| self.local) {
            Some(axes) => axes * self.force,
            None => self.force,
        };
        if self.projected { force * tangent.cross(&force.normalize()).norm() } else { force }
    }
}

impl Line<'_> {
    /// Adds the action of a force at a fraction of the length to the shares of the nodes.
    fn share(&self, at: f64, tangent: &Vec3, force: &Vec3, shares: &mut [[Vec3; 2]]) {
        let (lobatto, _) = quadrature::lobatto(self.nodes.len());
        for (share, weight) in shares.iter_mut().zip(quadrature::lagrange(lobatto, 2.0 * at - 1.0)) {
            share[0] += weight * force;
        }
        let (Some(axes), Some(shear)) = (self.element.axes, self.element.shear) else { return };
        for (axis, phi) in [1, 2].into_iter().zip(shear) {
            let along = axes.column(axis);
            let across = along.dot(force) * along;
            for (share, [more, arm]) in shares.iter_mut().zip(beam::cubic_deflection(at, phi)) {
                share[0] += more * across;
                share[1] += arm * self.length() * tangent.cross(&across);
            }
        }
    }
}
