//! Bar or cable: a straight two-node element that only resists stretching, N = EA (l − L)/L.

use super::link::{Law, Link, Links};
use crate::math::Vec3;

/// A bar is a line spring of stiffness EA/L; `damping` is the factor of stiffness-proportional damping (time).
pub fn links(elements: &[[usize; 2]], axial_stiffness: f64, tension_only: bool, x: &[Vec3], damping: f64) -> Links {
    let link = |&nodes: &[usize; 2]| {
        let length = (x[nodes[1]] - x[nodes[0]]).norm();
        let stiffness = axial_stiffness / length;
        let law = match tension_only {
            true => Law::TensionOnly { stiffness, gap: 0.0 },
            false => Law::Linear { stiffness, preload: 0.0 },
        };
        Link { nodes, law, damping: damping * stiffness, direction: None, free_length: length }
    };
    Links(elements.iter().map(link).collect())
}
