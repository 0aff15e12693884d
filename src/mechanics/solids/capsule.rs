//! The capsule: a cylinder with round ends.

use super::kind::{Solid, SolidKind, SolidShape, Touching};
use super::outline::{AROUND, Outline};
use super::segment::{ENDS, segment_of};
use base::math::convex::{ConvexShape, Spherocylinder};
use base::math::{Mat3, Vec3, frame_along};
use base::words::kinds::{Form, Given, Key};
use std::f64::consts::PI;
use std::sync::Arc;

/// The solid's word, keys and maker.
pub static KIND: SolidKind = SolidKind {
    word: "capsule",
    aliases: &[],
    guesses: &["pill", "spherocylinder", "sausage"],
    about: "A solid cylinder with round ends. `center` places its centre of mass; otherwise its ends define it.",
    keys: &[ENDS, Key { name: "radius", form: Form::Number, about: "Outer radius, above 0." }],
    make: read,
};

fn read(given: &mut Given) -> Option<Solid> {
    let (segment, center) = segment_of(given)?;
    Some(Solid {
        inertia: inertia(&segment),
        volume: volume(&segment),
        center: Some(center),
        shape: Arc::new(SolidCapsule { segment }),
    })
}

/// A cylinder between two halves of a ball.
fn volume(segment: &Spherocylinder) -> f64 {
    let (r, half) = (segment.radius, segment.half.norm());
    PI * r * r * (2.0 * half + 4.0 / 3.0 * r)
}

/// About the centre, per unit of mass.
fn inertia(segment: &Spherocylinder) -> Mat3 {
    let (r, half) = (segment.radius, segment.half.norm());
    // The shares of mass of the cylinder and of the two halves of a ball, whose centres lie 3/8 r beyond the ends.
    let round = 4.0 / 3.0 * r / (2.0 * half + 4.0 / 3.0 * r);
    let straight = 1.0 - round;
    let along = straight * 0.5 * r * r + round * 0.4 * r * r;
    let out = half + 0.375 * r;
    let across = straight * (0.25 * r * r + half * half / 3.0) + round * ((0.4 - 0.375 * 0.375) * r * r + out * out);
    let axis = segment.half / half;
    Mat3::identity() * across + axis * axis.transpose() * (along - across)
}

/// A capsule about its centre of mass.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidCapsule {
    /// Its line and radius, in the axes of the body.
    pub segment: Spherocylinder,
}

impl SolidShape for SolidCapsule {
    fn outline(&self) -> Outline {
        let Spherocylinder { half, radius } = self.segment;
        let axis = half.try_normalize(0.0).unwrap_or_else(Vec3::x);
        let axes = frame_along(&axis);
        let mut outline = Outline::default();
        let quarter = AROUND / 4;
        let angles = (0..=quarter).map(|i| 0.5 * PI * i as f64 / quarter as f64).skip(1);
        let arc: Vec<(f64, f64)> = angles.map(f64::sin_cos).collect();
        let low = arc.iter().map(|(sine, cosine)| (-1.0, *sine, *cosine));
        let high = arc.iter().rev().map(|(sine, cosine)| (1.0, *sine, *cosine));
        let circles: Vec<usize> = low
            .chain(high)
            .map(|(side, sine, cosine)| outline.circle(side * (half + radius * cosine * axis), radius * sine, &axes))
            .collect();
        for pair in circles.windows(2) {
            outline.band(pair[0], pair[1]);
        }
        for (circle, side) in [(circles[0], -1.0), (circles[circles.len() - 1], 1.0)] {
            outline.points.push(side * (half + radius * axis));
            outline.cone(circle, outline.points.len() - 1);
        }
        outline
    }

    fn as_convex(&self) -> Option<ConvexShape> {
        Some(ConvexShape::Spherocylinder(self.segment))
    }

    /// The ends of the line, and as many points as asked for between them.
    fn touching(&self, between: usize) -> Touching {
        let part = |k: usize| 2.0 * k as f64 / (between + 1) as f64 - 1.0;
        let points = (0..=between + 1).map(|k| part(k) * self.segment.half).collect();
        Touching::Points { points, radius: self.segment.radius }
    }

    fn opening(&self, between: usize) -> Option<f64> {
        Some(2.0 * self.segment.half.norm() / (between + 1) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solids::outline::{is_closed, reach};

    #[test]
    fn it_is_drawn_closed_and_of_its_size() {
        let segment = Spherocylinder { half: Vec3::new(1.0, 2.0, -2.0), radius: 0.5 };
        let outline = SolidCapsule { segment }.outline();
        assert!(is_closed(&outline));
        assert!((reach(&outline) - 3.5).abs() < 1e-14 * 10.0, "round-off of a few products");
    }

    /// By slices across the axis: discs of radius ρ(z), exact but for the rule of the sum.
    #[test]
    fn volume_and_inertia_are_those_of_its_slices() {
        let segment = Spherocylinder { half: Vec3::new(0.0, 0.0, 0.7), radius: 0.4 };
        let (r, half) = (segment.radius, 0.7);
        let (mut volume_sum, mut along, mut across) = (0.0, 0.0, 0.0);
        let slices = 200_000;
        let dz = 2.0 * (half + r) / slices as f64;
        for k in 0..slices {
            let z = -half - r + (k as f64 + 0.5) * dz;
            let over = (z.abs() - half).max(0.0);
            let squared = r * r - over * over;
            let disc = PI * squared * dz;
            volume_sum += disc;
            along += disc * 0.5 * squared;
            across += disc * (0.25 * squared + z * z);
        }
        let J = inertia(&segment);
        // The rule of midpoints errs by (dz/r)² of the sum, some 1e-10.
        assert!((volume(&segment) / volume_sum - 1.0).abs() < 1e-9);
        assert!((J[(2, 2)] * volume_sum / along - 1.0).abs() < 1e-9);
        assert!((J[(0, 0)] * volume_sum / across - 1.0).abs() < 1e-9);
    }
}
