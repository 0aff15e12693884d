//! The gradients of constraint equations by the motion of the nodes behind the ends of their joints, row after row.

use base::math::Vec6;
use base::snapshot::keep;
use std::ops::Range;

/// Gradients with their nodes. It is allocated once.
#[derive(Default)]
pub struct Gradients {
    /// Where the ends of each equation begin; the last entry is their number.
    firsts: Vec<usize>,
    /// The independent node behind each end; `None` if it has no unknown.
    nodes: Vec<Option<usize>>,
    /// ∂c/∂(x, θ) of these nodes.
    values: Vec<Vec6>,
    /// The accelerations of these nodes under a unit multiplier.
    responses: Vec<Vec6>,
}

keep!(Gradients { values, responses } without { firsts, nodes });

impl Gradients {
    /// Zero gradients for equations whose ends are carried by these nodes.
    pub fn new<'a>(rows: impl Iterator<Item = &'a [Option<usize>]>) -> Gradients {
        let mut all = Gradients { firsts: vec![0], ..Gradients::default() };
        for ends in rows {
            all.nodes.extend(ends);
            all.firsts.push(all.nodes.len());
        }
        all.values = vec![Vec6::zeros(); all.nodes.len()];
        all.responses = all.values.clone();
        all
    }

    /// The number of equations.
    pub fn count(&self) -> usize {
        self.firsts.len() - 1
    }

    fn range(&self, equation: usize) -> Range<usize> {
        self.firsts[equation]..self.firsts[equation + 1]
    }

    /// The nodes behind the ends of an equation.
    pub fn nodes(&self, equation: usize) -> &[Option<usize>] {
        &self.nodes[self.range(equation)]
    }

    /// The gradients of an equation, end by end.
    pub fn of(&self, equation: usize) -> &[Vec6] {
        &self.values[self.range(equation)]
    }

    /// The accelerations of the nodes under a unit multiplier of an equation, end by end.
    pub fn response(&self, equation: usize) -> &[Vec6] {
        &self.responses[self.range(equation)]
    }

    /// Writes the gradient of an equation at one of its ends, and the response to it.
    pub fn set(&mut self, (equation, end): (usize, usize), gradient: Vec6, response: Vec6) {
        let at = self.firsts[equation] + end;
        (self.values[at], self.responses[at]) = (gradient, response);
    }

    /// The equations in order, each with the nodes, the gradients and the responses of its ends that move.
    pub fn each(&self) -> impl Iterator<Item = impl Iterator<Item = (usize, &Vec6, &Vec6)>> {
        (0..self.count()).map(|k| {
            let ends = self.nodes(k).iter().zip(self.of(k)).zip(self.response(k));
            ends.filter_map(|((node, G), W)| Some(((*node)?, G, W)))
        })
    }
}
