//! Sections and thicknesses out of proportion to lengths, and sections that no area has: slips of units or digits.

use std::collections::HashMap;

use crate::data::Part;
use crate::places::nodes::Nodes;
use crate::report::Report;
use crate::scene::Scene;
use base::math::{Vec3, curved_faces};
use base::names::short;
use deck::parts::DeckPart;
use std::f64::consts::PI;

/// Numbers of sections are rounded to three digits in tables; beyond this part an inequality is violated.
const ROUNDING: f64 = 0.02;
/// Least ratio of depth to length for a warning; a beam may be a short piece of a longer one.
const FAR: f64 = 10.0;

/// A beam that stands alone may be a bolt between plates or a pin in lugs, so much deeper than long; slips of units are a thousand times.
const BOLT: f64 = 3.0;

/// Depths in the length of a beam beyond which lengths and sections are in different units: such a wire has no bending stiffness to speak of.
const SLENDER: f64 = 1e5;

/// Warns of parts thicker than they are wide or long. The deck is sound.
pub fn check_proportions(scene: &Scene, nodes: &Nodes, report: &mut Report) {
    let connected = Connected::new(scene, nodes);
    for part in scene.deck.parts().filter(|part| part.at.kind.is_deformable()) {
        let of = scene.parts.of(part.at);
        let Some(first) = of.iter().find(|part| part.elements() > 0).map(|part| part.nodes(0)[0]) else { continue };
        let extent = connected.extent(first);
        let Some(depths) = of.iter().find_map(|part| part.depths(&scene.parts.stiffnesses)) else { continue };
        if part.at.kind.is_surface() {
            check_shell(&part, depths[0], &extent, report);
        } else {
            check_line(&part, of, depths, (&extent, nodes), report);
        }
    }
    check_sections(scene, report);
    check_mesh_size(scene, nodes, report);
}

/// Notes a mesh larger than structures are: its file is in another unit of length.
fn check_mesh_size(scene: &Scene, nodes: &Nodes, report: &mut Report) {
    /// Few structures are longer, in m; a part of 0.3 m in mm counts as such.
    const LARGE: f64 = 300.0;
    let (Some(mesh), Some(units)) = (&scene.deck.mesh, &scene.deck.units) else { return };
    let places = || (0..nodes.list.len()).map(|node| nodes.x(node));
    let corner = |pick: fn(&Vec3, &Vec3) -> Vec3| places().reduce(|a, b| pick(&a, &b)).unwrap_or_default();
    let extent = (corner(Vec3::sup) - corner(Vec3::inf)).norm();
    let in_metres = extent * units.value.scales()[0];
    let scale = mesh.scale.as_ref();
    if scale.is_none_or(|scale| scale.value > 1.0) && in_metres > LARGE {
        let message = format!("the model extends over {} m in the units {}", short(in_metres), units.value.label());
        let hint = "if the mesh file is in mm, give `scale = 0.001` in `[mesh]`, or other `units`";
        report.note(scale.map_or(&mesh.span, |scale| &scale.span), message, hint);
    }
}

fn check_shell(part: &DeckPart, thickness: f64, extent: &Extent, report: &mut Report) {
    let width = extent.area / extent.diagonal();
    if thickness > width {
        let message = format!(
            "{} is {} thick, and all of the surface that it belongs to is about {} wide",
            part.title(),
            short(thickness),
            short(width)
        );
        report.warn(part.span, message, "a shell is thin against its width: look at the units of both");
    }
}

fn check_line(part: &DeckPart, of: &[Part], depths: [f64; 2], (extent, nodes): (&Extent, &Nodes), report: &mut Report) {
    let length: f64 =
        of.iter().map(|part| (0..part.elements()).map(|e| length(part.nodes(e), nodes)).sum::<f64>()).sum();
    let depth = depths[0].max(depths[1]);
    // A table may hold all columns of a hall: its box counts.
    let places =
        || of.iter().flat_map(|part| (0..part.elements()).flat_map(|e| part.nodes(e))).map(|&node| nodes.x(node));
    let corner = |pick: fn(&Vec3, &Vec3) -> Vec3| places().reduce(|a, b| pick(&a, &b)).unwrap_or_default();
    let across = (corner(Vec3::sup) - corner(Vec3::inf)).norm();
    if depth > 0.0 && across > SLENDER * depth {
        let (title, times) = (part.title(), short(across / depth));
        let message = format!("{title} extends over {}, {times} times the depth of its section", short(across));
        report.warn(part.span, message, "look at the units of lengths and sections; cables are `[[bars]]`");
    }
    // A bending stiffness far from its area may stand for anything: the depth of a rectangle is the word for it.
    let (deep, long) = match depths {
        [_, larger] if larger > BOLT * extent.length => (larger, extent.length),
        // A short piece of a long line may be as deep as it is wide.
        [smaller, _] if smaller > FAR * length && 2.0 * smaller > extent.length => (smaller, length),
        _ => return,
    };
    let (title, deep, long) = (part.title(), short(deep), short(long));
    let message = format!("the section of {title} is about {deep} deep, and the beam is {long} long");
    report.warn(part.span, message, "a beam is long against its section: look at the units of both");
}

fn length(line: &[usize], nodes: &Nodes) -> f64 {
    let (first, last) = (line[0], line[line.len() - 1]);
    (nodes.x(last) - nodes.x(first)).norm()
}

/// Warns of sections with area and moments that no area has.
fn check_sections(scene: &Scene, report: &mut Report) {
    for (name, section) in &scene.deck.sections.0 {
        let number = |key: &str| section.values.numbers(key);
        let (&[area], &[y, z]) = (number("area"), number("moments")) else { continue };
        let product = number("product_moment").first().copied().unwrap_or(0.0);
        let place = section.values.place("moments").unwrap_or(&name.span);
        // Among areas of one size an ellipse has the smallest determinant of second moments, (A²/4π)².
        let least = (area * area / (4.0 * PI)).powi(2);
        if y * z - product * product < (1.0 - ROUNDING) * least {
            let round = area * area / (4.0 * PI);
            let message =
                format!("no area of {} has the `moments` of section `{}`: they are too small", short(area), name.value);
            let hint = format!("a full circle has the least, {} about each axis", short(round));
            report.warn(place, message, hint);
        }
        if let &[torsion] = number("torsion_constant")
            && torsion > (1.0 + ROUNDING) * (y + z)
        {
            let place = section.values.place("torsion_constant").unwrap_or(&name.span);
            let message = format!(
                "no section has the `torsion_constant` of `{}`: it is larger than the sum of its `moments`, {}",
                name.value,
                short(y + z)
            );
            report.warn(place, message, "of a circle or a round tube it is their sum, of all others less");
        }
    }
}

/// Length, area and box of the beams, bars and shells that share nodes.
#[derive(Clone, Copy)]
struct Extent {
    length: f64,
    area: f64,
    low: Vec3,
    high: Vec3,
}

impl Extent {
    fn diagonal(&self) -> f64 {
        (self.high - self.low).norm()
    }
}

/// Groups of elements that share nodes.
struct Connected {
    towards: Vec<usize>,
    extents: HashMap<usize, Extent>,
}

impl Connected {
    fn new(scene: &Scene, nodes: &Nodes) -> Connected {
        let parts = || scene.parts.list.iter().filter(|part| part.kind().is_deformable());
        let elements = || parts().flat_map(|part| (0..part.elements()).map(move |e| (part, part.nodes(e))));
        let mut connected = Connected { towards: (0..nodes.list.len()).collect(), extents: HashMap::new() };
        for (_, of) in elements() {
            for &node in &of[1..] {
                let (a, b) = (connected.group(of[0]), connected.group(node));
                connected.towards[a.max(b)] = a.min(b);
            }
        }
        for (part, of) in elements() {
            let group = connected.group(of[0]);
            let x = nodes.x(of[0]);
            let extent = connected.extents.entry(group).or_insert(Extent { length: 0.0, area: 0.0, low: x, high: x });
            for &node in of {
                (extent.low, extent.high) = (extent.low.inf(&nodes.x(node)), extent.high.sup(&nodes.x(node)));
            }
            match part.kind().is_surface() {
                true => {
                    let side = |k: usize| nodes.x(of[k]) - x;
                    let round: Vec<usize> = curved_faces::ring(of.len()).collect();
                    let area = |k: usize| 0.5 * side(round[k - 1]).cross(&side(round[k])).norm();
                    extent.area += (2..round.len()).map(area).sum::<f64>();
                }
                false => extent.length += length(of, nodes),
            }
        }
        connected
    }

    fn extent(&self, node: usize) -> Extent {
        let mut group = node;
        while self.towards[group] != group {
            group = self.towards[group];
        }
        self.extents[&group]
    }

    fn group(&mut self, mut node: usize) -> usize {
        while self.towards[node] != node {
            self.towards[node] = self.towards[self.towards[node]];
            node = self.towards[node];
        }
        node
    }
}
