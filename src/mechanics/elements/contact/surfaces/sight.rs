//! The parts of two shapes ignored in contact, for each kind of toucher against each surface. `check` says it of every contact.

use super::SurfaceShape;
use super::kind::Touched;

/// The part of a tube that is always ignored.
const HOLE: &str = "the hole of the tube, into which nothing goes";

/// The shape of a touching body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Toucher {
    /// A sphere, or a point with its contact radius.
    Ball,
    /// A body that is a box.
    Box,
    /// A body that is the hull of points.
    Hull,
    /// A body that is a capsule.
    Capsule,
    /// A body that is a solid cylinder.
    Cylinder,
    /// A body that is a cylinder with a hole.
    Tube,
    /// Nodes of a part or of a body of rigid parts, and places between them that are asked for.
    Nodes,
}

impl Toucher {
    /// All of them.
    pub const ALL: [Toucher; 7] = [
        Toucher::Ball,
        Toucher::Box,
        Toucher::Hull,
        Toucher::Capsule,
        Toucher::Cylinder,
        Toucher::Tube,
        Toucher::Nodes,
    ];

    /// The parts of the toucher and of the surface ignored in contact; `None` if there are none. `by_points`: multipliers keep them apart,
    /// at points alone on planes and cylinders.
    pub fn unseen(self, surface: &SurfaceShape, by_points: bool) -> Option<&'static str> {
        match (self, surface) {
            (Toucher::Ball, _) => None,
            (Toucher::Cylinder | Toucher::Tube, SurfaceShape::Plane(_)) if by_points => {
                Some("the rim between its points")
            }
            (Toucher::Box, SurfaceShape::Cylinder(_)) if by_points => {
                Some("edges and faces of the box between its points")
            }
            (Toucher::Hull, SurfaceShape::Cylinder(_)) if by_points => {
                Some("edges and faces of the hull between its points")
            }
            (Toucher::Capsule, SurfaceShape::Cylinder(_)) if by_points => {
                Some("the side of the capsule between its points")
            }
            (Toucher::Cylinder | Toucher::Tube, SurfaceShape::Cylinder(_)) if by_points => {
                Some("ends and side of the cylinder between its points")
            }
            // Boxes, hulls and capsules touch a plane with their corners or ends, whatever else lies on it, and the others with all of
            // both.
            (
                Toucher::Box | Toucher::Hull | Toucher::Capsule | Toucher::Cylinder,
                SurfaceShape::Plane(_)
                | SurfaceShape::Cuboid(_)
                | SurfaceShape::Hull(_)
                | SurfaceShape::Sphere(_)
                | SurfaceShape::Cylinder(_)
                | SurfaceShape::Capsule(_),
            ) => None,
            (
                Toucher::Tube,
                SurfaceShape::Plane(_)
                | SurfaceShape::Cuboid(_)
                | SurfaceShape::Hull(_)
                | SurfaceShape::Sphere(_)
                | SurfaceShape::Cylinder(_)
                | SurfaceShape::Capsule(_),
            ) => Some(HOLE),
            (Toucher::Nodes, SurfaceShape::Plane(_)) => Some("what bends between nodes"),
            (
                Toucher::Nodes,
                SurfaceShape::Cuboid(_)
                | SurfaceShape::Hull(_)
                | SurfaceShape::Sphere(_)
                | SurfaceShape::Cylinder(_)
                | SurfaceShape::Capsule(_),
            ) => Some("what lies between nodes"),
        }
    }

    /// The parts of the toucher and of the faces of a shell ignored in contact; `None` if there are none.
    pub fn unseen_by_faces(self) -> Option<&'static str> {
        match self {
            Toucher::Ball => None,
            // The nodes of the shell see the faces of the box.
            Toucher::Box => Some("edges of the box that cross edges of the faces"),
            Toucher::Hull => Some("edges of the hull that cross edges of the faces"),
            Toucher::Capsule => Some("the side of the capsule that crosses edges of the faces"),
            Toucher::Cylinder | Toucher::Tube => {
                Some("edges of the faces that cross ends and side of the cylinder between its points")
            }
            Toucher::Nodes => Some("edges that cross edges; they need a separate contact with `edges = true`"),
        }
    }

    /// The parts of a toucher ignored in contact among bodies.
    pub fn unseen_among(self) -> Option<&'static str> {
        (self == Toucher::Tube).then_some(HOLE)
    }

    /// The parts of the toucher and of beams by their radius ignored in contact; `None` if there are none.
    pub fn unseen_by_lines(self) -> Option<&'static str> {
        match self {
            // The nodes of the lines see the faces of boxes and hulls.
            Toucher::Ball | Toucher::Box | Toucher::Hull | Toucher::Capsule => None,
            Toucher::Cylinder | Toucher::Tube => Some("the round side of the cylinder between 16 lines along it"),
            Toucher::Nodes => Some("what lies between nodes"),
        }
    }

    /// True where a body as a whole may pass the surface unseen, and not only sink in a little further than it should.
    pub fn may_pass(self, surface: &SurfaceShape, by_points: bool) -> bool {
        matches!(self, Toucher::Box | Toucher::Hull | Toucher::Capsule | Toucher::Cylinder | Toucher::Tube)
            && self.unseen(surface, by_points).is_some_and(|unseen| unseen != HOLE)
            && !matches!(surface, SurfaceShape::Plane(_))
    }
}

/// The least width of an opening through which a surface goes as a bar does, lengthways: the middle one of its dimensions. Plates
/// have a smaller one, but go through a slit only where they stand on edge. Infinite for a plane.
pub fn passing_width(surface: &SurfaceShape) -> f64 {
    match surface {
        SurfaceShape::Cuboid(cuboid) => {
            let mut half = cuboid.half;
            half.sort_by(f64::total_cmp);
            2.0 * half[1]
        }
        SurfaceShape::Cylinder(cylinder) => 2.0 * cylinder.radius,
        SurfaceShape::Plane(_) | SurfaceShape::Sphere(_) | SurfaceShape::Capsule(_) | SurfaceShape::Hull(_) => {
            surface.least()
        }
    }
}
