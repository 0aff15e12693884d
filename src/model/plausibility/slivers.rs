//! Badly shaped shell elements. They pass the patch test, so they are accepted, but they lose precision.

use crate::data::Drawing;
use crate::parts::Parts;
use crate::places::nodes::Nodes;
use crate::report::Report;
use base::math::{Vec3, curved_faces};
use base::names::short;
use deck::Deck;

/// Longest edge over least height, beyond which bending has lost six digits.
const LONG: f64 = 1e3;
/// A quadrilateral's corner beyond this angle, in degrees, is next to none.
const FLAT: f64 = 179.0;

/// The worst element of a shell in one way, and where it lies.
#[derive(Clone, Copy, Default)]
struct Worst {
    value: f64,
    at: Vec3,
    count: usize,
}

impl Worst {
    fn meet(&mut self, value: f64, limit: f64, at: Vec3) {
        self.count += usize::from(value > limit);
        if value > self.value {
            (self.value, self.at) = (value, at);
        }
    }

    fn place(&self) -> String {
        let [x, y, z] = self.at.into();
        format!("near ({}, {}, {})", short(x), short(y), short(z))
    }
}

/// Warns once for each shell of the deck and each kind of badly shaped elements.
pub fn check_slivers(deck: &Deck, parts: &Parts, nodes: &Nodes, report: &mut Report) {
    for surface in deck.parts().filter(|part| part.at.kind.is_surface()) {
        let (mut long, mut flat) = (Worst::default(), Worst::default());
        for (part, element) in parts.of(surface.at).iter().flat_map(|part| (0..part.elements()).map(move |e| (part, e)))
        {
            let Some(Drawing::Face { nodes: of }) = part.drawing(element) else { continue };
            let n = curved_faces::corners(of.len());
            let x: [Vec3; 4] = std::array::from_fn(|k| nodes.x(of[k % n]));
            let centre = x[..n].iter().sum::<Vec3>() / n as f64;
            long.meet(length_to_height(&x, n), LONG, centre);
            if n == 4 {
                flat.meet(widest(&x), FLAT, centre);
            }
        }
        let name = surface.name().map_or_else(|| "a shell".to_owned(), |_| surface.title());
        if long.count > 0 {
            let message = format!("{} of {name}: up to {:.0} times as long as high", slivers(long.count), long.value);
            let hint = format!(
                "give more equal edges {}; bending loses about {:.0} digits of precision there",
                long.place(),
                2.0 * long.value.log10()
            );
            report.warn(surface.span, message, hint);
        }
        if flat.count > 0 {
            let message = format!("{name} has a quadrilateral with a corner of {} degrees", degrees(flat.value));
            let hint = format!("move one of its corners {}; it acts like a triangle", flat.place());
            report.warn(surface.span, message, hint);
        }
    }
}

fn slivers(count: usize) -> String {
    if count == 1 { "a sliver among the elements".to_owned() } else { format!("{count} slivers among the elements") }
}

/// An angle near 180 with enough digits to differ from 180.
fn degrees(angle: f64) -> String {
    let digits = (1..9).find(|&digits| (180.0 - angle) * 10.0_f64.powi(digits) > 0.9).unwrap_or(9);
    format!("{angle:.digits$}", digits = digits as usize)
}

/// Longest side over the distance of the two that it keeps apart: the square of the longest edge over the area.
fn length_to_height(x: &[Vec3; 4], corners: usize) -> f64 {
    let longest = (0..corners).map(|k| (x[(k + 1) % corners] - x[k]).norm()).fold(0.0, f64::max);
    let area = match corners {
        3 => (x[1] - x[0]).cross(&(x[2] - x[0])).norm(),
        _ => 0.5 * (x[2] - x[0]).cross(&(x[3] - x[1])).norm(),
    };
    longest * longest / area
}

/// Largest angle at a corner of a quadrilateral, in degrees.
fn widest(x: &[Vec3; 4]) -> f64 {
    let angle = |k: usize| {
        let (a, b) = (x[(k + 1) % 4] - x[k], x[(k + 3) % 4] - x[k]);
        a.cross(&b).norm().atan2(a.dot(&b)).to_degrees()
    };
    (0..4).map(angle).fold(0.0, f64::max)
}
