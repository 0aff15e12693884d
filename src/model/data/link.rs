//! Springs, dampers, gaps and bushings between two nodes.

use super::loading::OwnDamping;
use super::part_answers::{Drawing, LinearSpring, NodalAction, PartAnswers};
use base::math::{Mat3, Vec3};
use base::quantities::{Column, LINK};
use mechanics::constraints::joint::ConstraintEquation;
use mechanics::elements::bearing::BearingMatrices;
use mechanics::elements::coordinate_law::CoordinateLaw;
use mechanics::elements::damper::Damper;
use mechanics::elements::hysteretic_link::PathLaw;
use mechanics::elements::isolator::IsolatorLaw;
use mechanics::elements::link::LinkLaw;
use mechanics::elements::link_failure::LinkFailure;

/// A spring, damper or bushing between two nodes.
#[derive(Debug, Clone)]
pub struct Link {
    /// The deck's name, or one made from it.
    pub name: String,
    /// Nodes at `from` and `to`: dependent nodes of a node or body, the node itself, or a restrained node for the ground.
    pub ends: [usize; 2],
    /// Its law.
    pub kind: LinkKind,
    /// Rayleigh factors of this link.
    pub own_damping: OwnDamping,
    /// The forces at failure; `None` for a link that does not fail.
    pub failure: Option<LinkFailure>,
    /// For a pretensioned link, the node whose displacement along x is the length taken up. A load acts on it in the stage of
    /// pretensioning; later stages lock it.
    pub take_up: Option<usize>,
}

/// The law of a link.
#[derive(Debug, Clone)]
pub enum LinkKind {
    /// Force along the line of the ends, or along a fixed global unit vector.
    Line {
        /// The force over the elongation.
        law: LinkLaw,
        /// The force against the rate of the elongation.
        damper: Damper,
        /// The fixed direction; `None` where the force acts along the line of the ends.
        direction: Option<Vec3>,
        /// Length (along the line) without elongation; along `direction` the initial projection, unless a free length is given.
        free_length: f64,
    },
    /// Force along the line of the ends, or along a fixed global unit vector, that depends on its past.
    Hysteretic {
        /// The force over the elongation and its past.
        law: PathLaw,
        /// The force against the rate of the elongation.
        damper: Damper,
        /// The fixed direction; `None` where the force acts along the line of the ends.
        direction: Option<Vec3>,
        /// As for [`LinkKind::Line`].
        free_length: f64,
    },
    /// Six components in a frame that is fixed to the first end: three of the relative position, three of the relative rotation.
    Bushing {
        /// The force per length along each axis, then the moment per radian about each.
        stiffness: [f64; 6],
        /// The force per velocity along each axis, then the moment per angular velocity about each.
        damping: [f64; 6],
        /// The axes (columns, global at t = 0).
        axes: Mat3,
    },
    /// All components by full matrices, in a frame that is fixed to the first end.
    Bearing {
        /// The matrices by rising speed of the second end about the first axis.
        matrices: Vec<BearingMatrices>,
        /// The axes (columns, global at t = 0).
        axes: Mat3,
    },
    /// A seismic isolator, in a frame that is fixed to the first end.
    Isolator {
        /// The force of sliding.
        law: IsolatorLaw,
        /// Force per displacement across the first axis before it slips.
        stiffness: f64,
        /// Force per displacement along the first axis.
        axial_stiffness: f64,
        /// The axes (columns, global at t = 0).
        axes: Mat3,
    },
    /// Along the coordinate of a joint, after which the link is named.
    Joint {
        /// The equation whose violation is the coordinate.
        lock: ConstraintEquation,
        /// The law along the coordinate.
        law: CoordinateLaw,
    },
}

impl Link {
    /// True where the link is part of a joint and not one of the deck.
    pub fn is_of_joint(&self) -> bool {
        matches!(self.kind, LinkKind::Joint { .. })
    }
}

impl Link {
    /// The quantities for `[[expect]]`.
    pub(super) const QUANTITIES: &'static [&'static [Column]] = &[&LINK];
}

impl PartAnswers for Link {
    fn name(&self) -> &str {
        &self.name
    }

    fn is_listed(&self) -> bool {
        !self.is_of_joint()
    }

    fn elements(&self) -> usize {
        1
    }

    fn nodes(&self, _: usize) -> &[usize] {
        &self.ends
    }

    fn visit_nodes(&mut self, visit: &mut dyn FnMut(&mut usize)) {
        self.ends.iter_mut().chain(&mut self.take_up).for_each(visit);
    }

    fn has_damped_stiffness(&self) -> bool {
        match &self.kind {
            LinkKind::Line { law: LinkLaw::Linear { stiffness, .. }, .. } => *stiffness > 0.0,
            LinkKind::Line { .. } | LinkKind::Hysteretic { .. } => true,
            LinkKind::Bushing { stiffness, .. } => stiffness.iter().any(|k| *k > 0.0),
            // Its matrices of damping are all that damps it.
            LinkKind::Bearing { .. } => false,
            // The stiffness of a pendulum only holds its parts together.
            LinkKind::Isolator { law, .. } => matches!(law, IsolatorLaw::Rubber { .. }),
            LinkKind::Joint { law, .. } => law.stiffness > 0.0 || law.hysteresis.is_some(),
        }
    }

    fn own_damping(&self) -> OwnDamping {
        self.own_damping
    }

    fn may_stiffen(&self) -> bool {
        match &self.kind {
            LinkKind::Line { law, .. } => !matches!(law, LinkLaw::Linear { .. }),
            LinkKind::Bushing { .. } => false,
            LinkKind::Hysteretic { .. } | LinkKind::Isolator { .. } => true,
            LinkKind::Bearing { matrices, .. } => matrices.len() > 1,
            LinkKind::Joint { law, .. } => law.stops.is_some() || law.friction.is_some() || law.hysteresis.is_some(),
        }
    }

    fn action(&self) -> NodalAction {
        match &self.kind {
            LinkKind::Joint { law, .. } if *law == CoordinateLaw::FREE => NodalAction::Nothing,
            LinkKind::Line { .. } | LinkKind::Hysteretic { .. } => NodalAction::Forces,
            LinkKind::Bushing { .. }
            | LinkKind::Bearing { .. }
            | LinkKind::Isolator { .. }
            | LinkKind::Joint { .. } => NodalAction::Moments,
        }
    }

    fn may_feed(&self) -> bool {
        matches!(self.kind, LinkKind::Bearing { .. })
    }

    fn may_release(&self) -> bool {
        let releases = |law: &LinkLaw| matches!(law, LinkLaw::Table { .. }) || law.force(0.0).0 != 0.0;
        self.failure.is_some() || matches!(&self.kind, LinkKind::Line { law, .. } if releases(law))
    }

    fn linear_spring(&self) -> Option<LinearSpring> {
        match self.kind {
            _ if self.failure.is_some() => None,
            LinkKind::Line { law: LinkLaw::Linear { stiffness, .. }, damper, .. } if damper.is_linear() => {
                Some(LinearSpring { ends: self.ends, stiffness, damping: damper.coefficient })
            }
            LinkKind::Joint { law, .. } if law == CoordinateLaw::FREE => {
                Some(LinearSpring { ends: self.ends, stiffness: 0.0, damping: 0.0 })
            }
            LinkKind::Line { .. }
            | LinkKind::Hysteretic { .. }
            | LinkKind::Bushing { .. }
            | LinkKind::Bearing { .. }
            | LinkKind::Isolator { .. }
            | LinkKind::Joint { .. } => None,
        }
    }

    fn drawing(&self, element: usize) -> Option<Drawing<'_>> {
        (!self.is_of_joint()).then(|| Drawing::Curve { nodes: self.nodes(element), axes: Mat3::identity() })
    }
}

/// Replaces the equations of links along joint coordinates, given by their index among all links.
pub fn set_coordinate_equations<'l>(
    links: impl Iterator<Item = &'l mut Link>,
    equations: &[(usize, ConstraintEquation)],
) {
    let mut links: Vec<&mut Link> = links.collect();
    for &(index, counted) in equations {
        if let LinkKind::Joint { lock, .. } = &mut links[index].kind {
            *lock = counted;
        }
    }
}
