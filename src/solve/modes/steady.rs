//! The steady motion of chosen nodes at each frequency.

use base::math::Vec6;
use base::snapshot::keep;
use linear::eigen::Complex;
use model::{ExpectAt, Model};

/// The response of some nodes.
#[derive(Debug, Clone, Default)]
pub struct Response {
    /// The nodes, ascending.
    pub nodes: Vec<usize>,
    /// The motion at each frequency, ascending.
    pub rows: Vec<ResponseRow>,
}

/// The motion at a frequency.
#[derive(Debug, Clone, Default)]
pub struct ResponseRow {
    /// The frequency, cycles per time.
    pub frequency: f64,
    /// Small motions (u, θ) in the order of [`Response::nodes`], real and imaginary parts: those at ωt = 0 and at −π/2. Not finite
    /// where the undamped scene has no steady motion.
    pub motions: Vec<[Complex; 6]>,
}

keep!(ResponseRow: Default { frequency, motions });

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
}

impl Response {
    /// The motion so far of the nodes that tables or `[[expect]]` name.
    pub(super) fn of(model: &Model, rows: Vec<ResponseRow>) -> Response {
        let expected = model.expects.iter().filter_map(|expect| match expect.at {
            ExpectAt::Response(node, _) => Some(node),
            _ => None,
        });
        let bodies = model.bodies.iter().map(|body| body.node);
        let mut nodes: Vec<usize> = model.output.nodes.iter().copied().chain(bodies).chain(expected).collect();
        nodes.sort_unstable();
        nodes.dedup();
        Response { nodes, rows }
    }

    /// Keeps the motions of the nodes wanted from those of all nodes, real and imaginary parts.
    pub(super) fn keep(&mut self, frequency: f64, [real, imaginary]: [&[Vec6]; 2]) {
        let motion = |&node: &usize| std::array::from_fn(|dof| [real[node][dof], imaginary[node][dof]]);
        self.rows.push(ResponseRow { frequency, motions: self.nodes.iter().map(motion).collect() });
    }

    /// Keeps these motions, in the order of the nodes wanted.
    pub(super) fn add(&mut self, frequency: f64, motions: Vec<[nalgebra::Complex<f64>; 6]>) {
        let motions = motions.into_iter().map(|motion| motion.map(|x| [x.re, x.im])).collect();
        self.rows.push(ResponseRow { frequency, motions });
    }

    /// Amplitude and phase in degrees of each component of a node at a row; `None` where the node is not among those wanted.
    #[must_use]
    pub fn amplitudes(&self, row: &ResponseRow, node: usize) -> Option<[f64; 12]> {
        let motion = &row.motions[self.nodes.binary_search(&node).ok()?];
        let mut values = [0.0; 12];
        for (dof, [real, imaginary]) in motion.iter().enumerate() {
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
