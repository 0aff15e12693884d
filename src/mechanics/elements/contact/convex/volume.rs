//! The depth of two polyhedra, from the solid they have in common.
//!
//! With S the variance of the positions in that solid, V⁻¹∫(x − c)(x − c)ᵀ dV, the depth is D = √(12/tr S⁻¹). A plate of thickness δ,
//! common to two faces, has S = diag(δ², a², b²)/12 and D = δ, if δ is small beside its edges a, b. Neither the size of the plate nor its
//! place on the faces matters: flush edges and overhangs are no special cases and cause no lateral force. A prism, where an edge stands in
//! a face or crosses one, or the tip of a corner gives a multiple of the penetration. Where one side is thicker D² grows by 3 θ² I/A, as
//! for springs at the corners. D and its gradient are continuous wherever the two overlap, for any bounding faces and edges; no feature has
//! to be chosen or remembered.
//!
//! Growth at x by the motion of a face changes S by ((x − c)(x − c)ᵀ − S)/V. It changes D by q(x) = 6/(D V (tr S⁻¹)²) (|S⁻¹(x − c)|² − tr
//! S⁻¹). So ∂D is a sum of q over the moving faces.

use super::depth::Depth;
use super::overlap::{Faces, faces};
use super::pose::PolyhedronPose;
use base::math::polyhedron::SolidMoments;
use base::math::{Mat3, Vec3, frame_along, stack};

/// Most faces, and room for points, of what two boxes have in common, and most hulls.
const FEW: (usize, usize) = (24, 48);
/// Room for others: what needs more is pushed along the axis of the least overlap alone.
const MANY: (usize, usize) = (128, 255);

/// The depth of two polyhedra with the deepest point `origin` along an `axis`; `None` where the common solid vanishes by rounding.
pub(super) fn depth_by_volume(pose: &PolyhedronPose, axis: &Vec3, origin: &Vec3) -> Option<Depth> {
    let T = frame_along(axis);
    let few = by_moments::<{ FEW.0 }, { FEW.1 }>(pose, &T, origin);
    few.or_else(|| by_moments::<{ MANY.0 }, { MANY.1 }>(pose, &T, origin)).flatten()
}

/// The depth with room for FACES and POINTS; `None` if that is too small.
fn by_moments<const FACES: usize, const POINTS: usize>(
    pose: &PolyhedronPose,
    T: &Mat3,
    origin: &Vec3,
) -> Option<Option<Depth>> {
    Some(of_faces(pose, T, origin, &faces::<FACES, POINTS>(pose, T, origin)?))
}

fn of_faces<const FACES: usize, const POINTS: usize>(
    pose: &PolyhedronPose,
    T: &Mat3,
    origin: &Vec3,
    faces: &Faces<FACES, POINTS>,
) -> Option<Depth> {
    let moments = faces.moments()?;
    let measure = Measure::of(&moments)?;
    let center = T.tr_mul(&(pose.y - origin));
    let (mut by_x, mut by_turn) = (Vec3::zeros(), Vec3::zeros());
    for face in faces.iter().filter(|face| face.moves) {
        let (sum, first) = face.integral(&|x| measure.growth(x));
        by_x += sum * face.normal;
        by_turn += (first - sum * center).cross(&face.normal);
    }
    let g = stack(&(T * by_x), &(T * by_turn));
    let D = measure.D;
    D.is_finite().then(|| Depth { D, g, c: origin + T * measure.mean, lever: measure.lever })
}

/// The depth of two by the moments of the common solid.
pub(super) struct Measure {
    /// The depth.
    pub D: f64,
    /// The centre of the common solid.
    pub mean: Vec3,
    /// The radius of friction about the normal.
    pub lever: f64,
    /// The inverse of the variance, and its trace.
    inverse: Mat3,
    trace: f64,
    scale: f64,
}

impl Measure {
    /// `None` where the variance is singular by rounding.
    pub fn of(moments: &SolidMoments) -> Option<Self> {
        let S = moments.variance;
        let inverse = S.try_inverse()?;
        let trace = inverse.trace();
        if trace.is_nan() || trace <= 0.0 || S.trace() <= 0.0 {
            return None;
        }
        let D = (12.0 / trace).sqrt();
        let scale = 6.0 / (D * moments.volume * trace * trace);
        // The mean distance from the middle is L/4 for a line (variance L²/12) and 2 R/3 for a disc (variance R²/4 twice); rectangles agree
        // within 1 %. The second invariant is the product of the two large variances.
        let minors = S.m11 * S.m22 - S.m12 * S.m21 + S.m22 * S.m33 - S.m23 * S.m32 + S.m33 * S.m11 - S.m31 * S.m13;
        let lever = (0.75 * S.trace() + 5.0 / 18.0 * minors.max(0.0).sqrt()).sqrt();
        Some(Measure { D, mean: moments.mean, lever, inverse, trace, scale })
    }

    /// q(x): the growth of the depth by that of the solid at x, per volume.
    pub fn growth(&self, x: &Vec3) -> f64 {
        self.scale * ((self.inverse * (x - self.mean)).norm_squared() - self.trace)
    }
}
