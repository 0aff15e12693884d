//! Modal damping: C = Σ 2 ζ ω (M φ)(M φ)ᵀ over the first modes of the drawn state, with φ of modal mass 1.
//!
//! Its forces are part of every residual and its power is that of dampers. The tangent of a step does without: C is small beside M/Δt, by ζ ω Δt, and that is
//! the contraction of the iteration. E. L. Wilson & J. Penzien, Earthquake Eng. Struct. Dyn. 1 (1972) 5-10.

use mechanics::elements::Force;
use mechanics::state::Node;
use std::sync::OnceLock;

/// A damped mode.
#[derive(Debug, Clone)]
pub struct DampedMode {
    /// 2 ζ ω.
    pub rate: f64,
    /// M φ by unknown.
    pub momentum: Vec<f64>,
}

/// The damped modes over the unknowns of nodes.
#[derive(Debug, Clone, Default)]
pub struct DampedModes {
    /// Node and direction of each unknown.
    pub dofs: Vec<(usize, usize)>,
    /// The modes.
    pub list: Vec<DampedMode>,
}

/// The modal damping of a scene, whose modes are found before its first step.
#[derive(Debug, Clone, Default)]
pub struct ModalDamping {
    /// ζ of each mode, the lowest first.
    pub ratios: Vec<f64>,
    modes: OnceLock<DampedModes>,
}

impl ModalDamping {
    /// Damping by these ratios.
    pub fn new(ratios: &[f64]) -> ModalDamping {
        ModalDamping { ratios: ratios.to_vec(), modes: OnceLock::new() }
    }

    /// True where modes are damped.
    pub fn acts(&self) -> bool {
        !self.ratios.is_empty()
    }

    /// True where modes are still to be found.
    pub fn lacks_modes(&self) -> bool {
        self.acts() && self.modes.get().is_none()
    }

    /// Sets the modes; later calls have no effect.
    pub fn set(&self, modes: DampedModes) {
        self.modes.get_or_init(|| modes);
    }

    /// Adds the forces −C v to nodes, and returns the power v·C v. Without forces it returns the power alone.
    pub fn add(&self, nodes: &[Node], mut forces: Option<&mut [Force]>) -> f64 {
        let Some(DampedModes { dofs, list }) = self.modes.get() else { return 0.0 };
        let rate = |&(node, dof): &(usize, usize)| match dof {
            0..3 => nodes[node].v[dof],
            _ => nodes[node].omega[dof - 3],
        };
        let mut power = 0.0;
        for mode in list {
            let speed: f64 = dofs.iter().zip(&mode.momentum).map(|(dof, momentum)| momentum * rate(dof)).sum();
            power += mode.rate * speed * speed;
            let Some(forces) = forces.as_deref_mut() else { continue };
            for (&(node, dof), momentum) in dofs.iter().zip(&mode.momentum) {
                forces[node][dof] -= mode.rate * speed * momentum;
            }
        }
        power
    }
}
