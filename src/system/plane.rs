//! Recognizes scenes that move in a plane.

use super::inertia::Inertia;
use crate::constraints::rigid_link::RigidLink;
use crate::math::{Mat3, Vec3, skew};
use crate::model::{Joint, Link, LinkKind, Loading, Model, Node, Part};
use crate::sections::Stiffness;

/// The global axis normal to the plane of a scene in which nothing can move out of it, unless the deck keeps
/// out-of-plane motion.
pub fn normal(model: &Model, inertias: &[Inertia], rigid_links: &[RigidLink]) -> Option<usize> {
    if model.analysis.plane { (0..3).rev().find(|&n| is_plane(model, inertias, rigid_links, n)) } else { None }
}

/// A number counts as zero below this fraction of the entries beside it.
const SMALL: f64 = 1e-12;

/// A plane normal to a global axis, through the first node.
struct Plane {
    normal: usize,
    /// Largest distance of a node from the first.
    size: f64,
}

fn is_plane(model: &Model, inertias: &[Inertia], rigid_links: &[RigidLink], normal: usize) -> bool {
    let Some(first) = model.nodes.first() else { return false };
    let size = model.nodes.iter().map(|p| (p.x - first.x).norm()).fold(0.0, f64::max);
    let plane = Plane { normal, size };
    let flat = |p: &Node| (p.x[normal] - first.x[normal]).abs() <= SMALL * size;
    let still = |p: &Node| plane.holds(&p.v) && plane.is_normal(&p.omega);
    model.nodes.iter().all(|p| flat(p) && still(p))
        && plane.holds_loading(&model.loading)
        && plane.holds_constraints(model)
        && inertias.iter().all(|i| plane.keeps_apart(&i.J0))
        && model.parts.iter().all(|part| plane.holds_part(part, &model.stiffnesses))
        // Arms lie in the plane with the nodes, so only their skew matrices need a check.
        && rigid_links.iter().all(|a| plane.pairs_rightly(&skew(&a.S0)) || a.S0 == Vec3::zeros())
}

impl Plane {
    /// True for a vector in the plane. It is judged by its largest entry: the norm of large numbers overflows, and nothing
    /// exceeds infinity.
    fn holds(&self, v: &Vec3) -> bool {
        // The comparison is not reversed, so that entries that are not finite do not count as outside.
        let outside = v[self.normal].abs() > SMALL * v.amax();
        !outside
    }

    /// True for a vector normal to the plane.
    fn is_normal(&self, v: &Vec3) -> bool {
        !(0..3).any(|i| i != self.normal && v[i].abs() > SMALL * v.amax())
    }

    /// True for a symmetric tensor that does not couple the normal with the plane.
    fn keeps_apart(&self, J: &Mat3) -> bool {
        let n = self.normal;
        !(0..3).any(|i| i != n && J[(n, i)].abs().max(J[(i, n)].abs()) > SMALL * J.amax())
    }

    /// False for a matrix that couples a vector in the plane with a rotation about an axis in the plane, or the normal
    /// with a rotation about it.
    fn pairs_rightly(&self, K: &Mat3) -> bool {
        let n = self.normal;
        !(0..3).any(|i| (0..3).any(|j| (i == n) == (j == n) && K[(i, j)].abs() > SMALL * K.amax()))
    }

    /// True where no load and no ground motion drives anything out of the plane.
    fn holds_loading(&self, loading: &Loading) -> bool {
        loading.pressures.is_empty()
            && loading.nodal.iter().all(|load| self.holds(&load.force) && self.is_normal(&load.moment))
            && self.holds(&loading.gravity)
            && loading.base_accelerations.iter().all(|base| self.holds(&base.direction))
    }

    /// True where no prescribed motion and no joint leads out of the plane.
    fn holds_constraints(&self, model: &Model) -> bool {
        let in_plane = |dof: usize| if dof < 3 { dof != self.normal } else { dof - 3 == self.normal };
        let joint_holds = |joint: &Joint| {
            let d = model.nodes[joint.ends[0]].x - model.nodes[joint.ends[1]].x;
            joint.equations.iter().all(|row| row.in_plane(self.normal, &d).is_some())
        };
        let constraints = &model.constraints;
        constraints.restraints.iter().all(|restraint| restraint.motion.is_none() || in_plane(restraint.dof))
            && constraints.joints.iter().all(joint_holds)
    }

    fn holds_part(&self, part: &Part, stiffnesses: &[Stiffness]) -> bool {
        match part {
            Part::Beam(beam) => beam.elements.iter().all(|e| self.holds_section(&e.frame, &stiffnesses[e.section])),
            Part::Bar(_) => true,
            // Shells bend out of any plane they lie in.
            Part::Shell(shell) => shell.elements.is_empty(),
            Part::Link(link) => self.holds_link(link),
            Part::Contact(contact) => {
                let center = contact.surface.center[self.normal].abs();
                center <= SMALL * self.size && contact.surface.keeps(self.normal)
            }
        }
    }

    /// True for a section that bending and stretching in the plane neither bend nor twist out of it.
    fn holds_section(&self, frame: &Mat3, C: &Stiffness) -> bool {
        let turn = |K: &Mat3| frame * K * frame.transpose();
        // The coupling of forces and curvatures may be nothing but rounding, that of a shear centre at the centroid: it
        // is small beside the geometric mean of the stiffnesses of forces and moments.
        let rest = turn(&C.NM);
        let paired = rest.amax() > SMALL * C.N.amax().sqrt() * C.M.amax().sqrt();
        self.keeps_apart(&turn(&C.N)) && self.keeps_apart(&turn(&C.M)) && (!paired || self.pairs_rightly(&rest))
    }

    fn holds_link(&self, link: &Link) -> bool {
        match &link.kind {
            LinkKind::Line { direction, .. } => direction.is_none_or(|d| self.holds(&d)),
            LinkKind::Bushing { stiffness, damping, axes } => [stiffness, damping].into_iter().all(|k| {
                let turn = |k: &[f64]| axes * Mat3::from_diagonal(&Vec3::new(k[0], k[1], k[2])) * axes.transpose();
                self.keeps_apart(&turn(&k[..3])) && self.keeps_apart(&turn(&k[3..]))
            }),
        }
    }
}
