//! The steady forces of links: their tangents times the motions of their nodes.

use super::linearized::Linearized;
use crate::system::{Group, results};
use base::math::{Mat6, Vec6};
use linear::eigen::Complex;
use mechanics::elements::Moduli;
use mechanics::state::Configuration;
use std::f64::consts::TAU;

/// The force of a link on its first end over small motions of its nodes.
#[derive(Debug, Clone)]
pub struct LinkForce {
    /// The nodes, each with the force and moment per displacement, and per velocity.
    by_node: Vec<(usize, [Mat6; 2])>,
}

impl LinkForce {
    /// The forces of all links of the deck about a state, in deck order. Bearings have the speeds that were held last.
    pub fn all(at: &Linearized) -> Vec<LinkForce> {
        let nodes = at.nodes_at_rest();
        let now = Configuration { nodes: &nodes, history: &at.state.history, dt: 0.0, previous: None };
        let links = results::links_of_deck(at.system).into_iter();
        links.map(|(group, e)| LinkForce::of(group, e, &group.configuration(&now))).collect()
    }

    fn of(group: &Group, e: usize, now: &Configuration) -> LinkForce {
        let (nodes, dofs) = (group.block.nodes(e), group.block.dofs());
        let width = dofs * nodes.len();
        let [K, with_rates] = [0.0, 1.0].map(|rate| {
            let mut matrix = vec![0.0; width * width];
            group.block.tangent(e, now, rate, Moduli::Elastic, &mut matrix);
            matrix
        });
        // The elements resist, so that their force has the opposite sign of the tangent.
        let of_node = |j: usize| {
            let place = |r: usize, c: usize| (r < dofs && c < dofs).then_some(r * width + j * dofs + c);
            let stiffness = Mat6::from_fn(|r, c| place(r, c).map_or(0.0, |at| -K[at]));
            let damping = Mat6::from_fn(|r, c| place(r, c).map_or(0.0, |at| K[at] - with_rates[at]));
            [stiffness, damping]
        };
        LinkForce { by_node: nodes.iter().enumerate().map(|(j, &node)| (node, of_node(j))).collect() }
    }

    /// Its nodes.
    pub fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.by_node.iter().map(|(node, _)| *node)
    }

    /// Real and imaginary parts of force and moment at a frequency from those of the motion of a node; not finite where a motion is not.
    pub fn at(&self, frequency: f64, motion: impl Fn(usize) -> [Complex; 6]) -> [Complex; 6] {
        let omega = TAU * frequency;
        let [mut real, mut imaginary] = [Vec6::zeros(); 2];
        for (node, [K, C]) in &self.by_node {
            let motion = motion(*node);
            if motion.iter().flatten().any(|x| !x.is_finite()) {
                return [[f64::INFINITY; 2]; 6];
            }
            let [re, im] = [0, 1].map(|part| Vec6::from_fn(|dof, _| motion[dof][part]));
            real += K * re - omega * (C * im);
            imaginary += K * im + omega * (C * re);
        }
        std::array::from_fn(|dof| [real[dof], imaginary[dof]])
    }
}
