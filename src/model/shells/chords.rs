//! Triangles of order 1 that are too long for a curved surface.

use crate::data::{PartType, Shell};
use crate::parts::Parts;
use crate::places::nodes::Nodes;
use crate::report::Report;
use base::math::Vec3;
use base::names::short;
use deck::Deck;
use mechanics::elements::shell::SLENDER;

/// Limit of the distance between surface and chord, relative to the thickness. Beyond it, bending without stretching is more than 1 to 2 %
/// too stiff; a pinched hemisphere is 10 % too stiff at 1.5, and the error grows with the square.
const FAR: f64 = 0.6;

/// Warns once for each shell with triangles that measure stretch along chords far from the surface. Shorter ones measure it along arcs, and
/// quadrilaterals do not lock.
pub fn check_chords(deck: &Deck, parts: &Parts, nodes: &Nodes, report: &mut Report) {
    for surface in deck.parts().filter(|part| part.at.kind.is_surface()) {
        let (mut count, mut farthest) = (0, 0.0_f64);
        for shell in parts.of(surface.at).iter().filter_map(Shell::of).filter(|shell| shell.size() == 3) {
            for element in &shell.elements {
                let side = |k: usize| {
                    let [a, b] = [k, (k + 1) % 3];
                    let along: Vec3 = nodes.x(element.nodes[b]) - nodes.x(element.nodes[a]);
                    (along.norm(), (element.normals[b] - element.normals[a]).norm())
                };
                let sides = [side(0), side(1), side(2)];
                let is_slender = sides.iter().any(|(length, _)| *length > SLENDER * shell.plate.thickness);
                // The rise of an arc over its chord.
                let rise = sides.iter().map(|(length, turn)| length * turn / 8.0).fold(0.0, f64::max);
                let distance = rise / shell.plate.thickness;
                if is_slender && distance > FAR {
                    count += 1;
                    farthest = farthest.max(distance);
                }
            }
        }
        if count > 0 {
            let name = surface.name().map_or_else(|| "a shell".to_owned(), |_| surface.title());
            let triangles = if count == 1 { "a triangle".to_owned() } else { format!("{count} triangles") };
            let message = format!(
                "{triangles} of {name}, longer than {SLENDER} thicknesses, up to {} thicknesses away from its curved surface",
                short((100.0 * farthest).round() / 100.0)
            );
            let hint = "where the surface bends without stretching it is too stiff, by some 10 % at 1.5 thicknesses: take shorter ones, \
                        quadrilaterals or `order = 2`";
            report.warn(surface.span, message, hint);
        }
    }
}
