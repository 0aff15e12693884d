//! The ball.

use super::kind::{Solid, SolidKind, SolidShape, Touching};
use super::outline::{AROUND, Outline};
use base::math::{Mat3, Vec3};
use base::words::kinds::{Form, Given, Key};
use std::f64::consts::PI;
use std::sync::Arc;

/// The solid's word, keys and maker.
pub static KIND: SolidKind = SolidKind {
    word: "sphere",
    aliases: &[],
    guesses: &["ball"],
    about: "A solid sphere.",
    keys: &[Key { name: "radius", form: Form::Number, about: "Outer radius, above 0." }],
    make: read,
};

fn read(given: &mut Given) -> Option<Solid> {
    let r = given.require_positive("radius")?;
    let inertia = Mat3::identity() * (0.4 * r * r);
    Some(Solid {
        shape: Arc::new(SolidSphere { radius: r }),
        inertia,
        volume: 4.0 / 3.0 * PI * r * r * r,
        center: None,
    })
}

/// A ball about the centre of mass.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidSphere {
    /// Outer radius.
    pub radius: f64,
}

impl SolidShape for SolidSphere {
    fn outline(&self) -> Outline {
        let radius = self.radius;
        let mut outline = Outline::default();
        let circles: Vec<usize> = (1..AROUND / 2)
            .map(|i| (PI * i as f64 / (AROUND / 2) as f64).sin_cos())
            .map(|(sine, cosine)| outline.circle(Vec3::z() * radius * cosine, radius * sine, &Mat3::identity()))
            .collect();
        for pair in circles.windows(2) {
            outline.band(pair[0], pair[1]);
        }
        for (circle, z) in [(circles[0], radius), (circles[circles.len() - 1], -radius)] {
            outline.points.push(Vec3::z() * z);
            outline.cone(circle, outline.points.len() - 1);
        }
        outline
    }

    fn touching(&self, _: usize) -> Touching {
        Touching::Ball(self.radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solids::outline::{is_closed, reach};

    #[test]
    fn it_is_drawn_closed_and_of_its_size() {
        let outline = SolidSphere { radius: 2.0 }.outline();
        assert!(is_closed(&outline));
        assert!((reach(&outline) - 2.0).abs() < 2e-14, "round-off of a few products");
    }
}
