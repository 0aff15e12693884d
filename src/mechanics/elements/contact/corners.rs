//! Corners of a solid and the nodes of a mesh under it: which of them press.
//!
//! A solid on a mesh has two kinds of contact: its corners on faces, and the nodes of these faces on its surface. Where it lies flat all
//! are equally deep, and nodes lie under it as the mesh happens to be: if they pressed too, they would turn it. A node therefore presses
//! only once it is deeper than all corners pushed in its own direction; from then on its additional depth counts.

use super::history::{PairMemory, PairMemoryMut};
use super::kinematics::{ContactKinematics, Contacts};
use super::nearest_corner::NearestCorner;
use super::normal_motion::safe_time;
use crate::state::{Configuration, Node};

/// Least cosine of the angle between the directions of a corner and a node to count as one.
const ONE_DIRECTION: f64 = 0.7;
/// Least difference between two depths, relative to a facet, that is not rounding.
const ROUNDING: f64 = 1e-9;

impl Contacts {
    /// The starting depth of the spring of a point.
    #[inline]
    pub(super) fn inset(&self, old: PairMemory) -> f64 {
        old.inset(&self.law).max(0.0)
    }

    /// True for a node that does not press, because a corner is deeper.
    #[inline]
    pub(super) fn is_idle(&self, old: PairMemory) -> bool {
        self.corners.is_some() && (!old.is_known() || old.inset(&self.law) < 0.0)
    }

    /// Writes the starting depth of the spring of a point, `inset` by its own motion; for an idle point it writes the gap to the
    /// surface.
    pub(super) fn remember_inset(
        &self,
        at: &ContactKinematics,
        inset: f64,
        now: &Configuration,
        old: PairMemory,
        new: &mut PairMemoryMut,
    ) {
        let Some(corners) = &self.corners else { return new.set_inset(&self.law, inset) };
        let was_idle = self.is_idle(old);
        if !was_idle && at.gap < 0.0 {
            return new.set_inset(&self.law, inset);
        }
        let gap = at.gap - self.inset(old);
        // Points that cannot touch in the next steps are skipped.
        let is_far = self.law.dynamic && gap > 4.0 * now.dt * at.w.norm() && gap > 0.0;
        if is_far || !self.is_nearest(&**corners, at, gap, now.nodes) {
            new.set_inset(&self.law, -1.0);
            self.set_gap(gap, at, new);
            return;
        }
        // Initial overlaps are pushed out; later the force starts from zero.
        let inset = if !was_idle || now.dt <= 0.0 { inset.min(-gap).max(0.0) } else { (-gap).max(0.0) };
        new.set_inset(&self.law, inset);
        self.set_gap(gap + inset, at, new);
    }

    /// Writes the gap to the start of the spring, and a time too short for it to close.
    fn set_gap(&self, gap: f64, at: &ContactKinematics, new: &mut PairMemoryMut) {
        new.set_gap(gap);
        new.set_safe_time(safe_time(&self.law, gap, at.w.norm()));
    }

    /// True where a node is nearer to the solid than any of its corners, in about the same direction, to the faces.
    fn is_nearest(&self, corners: &dyn NearestCorner, at: &ContactKinematics, gap: f64, nodes: &[Node]) -> bool {
        let outward = at.R * at.closest.n;
        let least = corners.least_gap_toward(&-outward, ONE_DIRECTION, nodes);
        gap < least - ROUNDING * corners.margin()
    }
}
