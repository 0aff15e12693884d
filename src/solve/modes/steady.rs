//! The steady motion of chosen nodes, and the forces of links, at each frequency.

use super::linearized::Linearized;
use super::link_forces::LinkForce;
use base::math::Vec6;
use base::snapshot::keep;
use linear::eigen::Complex;
use model::{ExpectAt, ResponseOf};

/// The response of some nodes.
#[derive(Debug, Clone, Default)]
pub struct Response {
    /// The nodes, ascending.
    pub nodes: Vec<usize>,
    /// The motion at each frequency, ascending.
    pub rows: Vec<ResponseRow>,
    /// The matrices of the forces of links, in deck order; empty if no table or expected value needs them.
    pub(super) links: Vec<LinkForce>,
}

/// The motion at a frequency.
#[derive(Debug, Clone, Default)]
pub struct ResponseRow {
    /// The frequency, cycles per time.
    pub frequency: f64,
    /// Small motions (u, θ) in the order of [`Response::nodes`], real and imaginary parts: those at ωt = 0 and at −π/2. Not finite
    /// where the undamped scene has no steady motion.
    pub motions: Vec<[Complex; 6]>,
    /// Force and moment of links on their first ends, likewise.
    pub links: Vec<[Complex; 6]>,
}

keep!(ResponseRow: Default { frequency, motions, links });

/// Response found so far, for a search that was interrupted.
#[derive(Debug, Default)]
pub struct ResponseSoFar {
    /// The rows of the frequencies solved for, ascending.
    pub rows: Vec<ResponseRow>,
    /// Largest residual of the equations, and its frequency.
    pub(super) worst: (f64, f64),
    /// Frequencies without a steady motion, each with the growing mode, counted from 0.
    pub(super) resonances: Vec<(f64, Option<usize>)>,
}

keep!(ResponseSoFar { rows, worst, resonances });

/// The progress of an interruptible search: the response found so far, and whether it pauses between two frequencies.
pub struct ResponseProgress<'s> {
    /// Response found so far; a complete response moves its rows there.
    pub so_far: &'s mut ResponseSoFar,
    /// Returns whether a checkpoint is due.
    pub pauses: &'s mut dyn FnMut() -> bool,
}

impl ResponseRow {
    /// The largest component of any motion.
    pub(super) fn largest(&self) -> f64 {
        let sizes = self.motions.iter().flatten().map(|[real, imaginary]| real.hypot(*imaginary));
        sizes.fold(0.0, f64::max)
    }

    /// Marks a resonance without a limit.
    pub(super) fn set_unlimited(&mut self) {
        self.motions.iter_mut().chain(&mut self.links).for_each(|values| *values = [[f64::INFINITY; 2]; 6]);
    }
}

impl Response {
    /// The response so far of the nodes and links that tables or `[[expect]]` name.
    pub(super) fn of(at: &Linearized, rows: Vec<ResponseRow>) -> Response {
        let model = at.model;
        let expected = || {
            model.expects.iter().filter_map(|expect| match expect.at {
                ExpectAt::Response(of, _) => Some(of),
                _ => None,
            })
        };
        let has_links = model.output.links || expected().any(|of| matches!(of, ResponseOf::LinkForce(_)));
        let links = if has_links { LinkForce::all(at) } else { Vec::new() };
        let expected = expected().filter_map(|of| match of {
            ResponseOf::Node(node) => Some(node),
            ResponseOf::LinkForce(_) => None,
        });
        let bodies = model.bodies.iter().map(|body| body.node);
        let shown = model.output.nodes.iter().copied().chain(bodies).chain(expected);
        let mut nodes: Vec<usize> = shown.chain(links.iter().flat_map(LinkForce::nodes)).collect();
        nodes.sort_unstable();
        nodes.dedup();
        Response { nodes, rows, links }
    }

    /// Forms the matrices of links anew, where those of bearings have changed with the speed.
    pub(super) fn renew_links(&mut self, at: &Linearized) {
        if !self.links.is_empty() {
            self.links = LinkForce::all(at);
        }
    }

    /// Keeps the motions of the nodes wanted from those of all nodes, real and imaginary parts.
    pub(super) fn keep(&mut self, frequency: f64, [real, imaginary]: [&[Vec6]; 2]) {
        let motion = |&node: &usize| std::array::from_fn(|dof| [real[node][dof], imaginary[node][dof]]);
        self.push(frequency, self.nodes.iter().map(motion).collect());
    }

    /// Keeps these motions, in the order of the nodes wanted.
    pub(super) fn add(&mut self, frequency: f64, motions: Vec<[nalgebra::Complex<f64>; 6]>) {
        self.push(frequency, motions.into_iter().map(|motion| motion.map(|x| [x.re, x.im])).collect());
    }

    fn push(&mut self, frequency: f64, motions: Vec<[Complex; 6]>) {
        let of = |node: usize| self.nodes.binary_search(&node).map_or([[0.0; 2]; 6], |place| motions[place]);
        let links = self.links.iter().map(|link| link.at(frequency, of)).collect();
        self.rows.push(ResponseRow { frequency, motions, links });
    }

    /// Amplitude and phase in degrees of each component of a motion or of a force at a row; `None` for a node or link that was not wanted.
    #[must_use]
    pub fn amplitudes(&self, row: &ResponseRow, of: ResponseOf) -> Option<[f64; 12]> {
        let components = match of {
            ResponseOf::Node(node) => &row.motions[self.nodes.binary_search(&node).ok()?],
            ResponseOf::LinkForce(link) => row.links.get(link)?,
        };
        let mut values = [0.0; 12];
        for (dof, [real, imaginary]) in components.iter().enumerate() {
            values[dof] = real.hypot(*imaginary);
            // The angle of zero is zero, whatever its sign.
            values[6 + dof] = match values[dof] {
                0.0 => 0.0,
                size if !size.is_finite() => f64::NAN,
                _ => imaginary.atan2(*real).to_degrees(),
            };
        }
        Some(values)
    }
}
