//! `[[contacts]]`: what touches a surface, and how.

use schemars::JsonSchema;
use serde::Deserialize;

use super::part_table::{PartTable, names};
use super::words::kinds::{Kinds, OneOf};
use super::words::{Maybe, Names, NumberOrTable};
use base::diagnostic::At;
use mechanics::elements::contact::SurfaceShape;
use mechanics::elements::contact::surfaces::SURFACES;
use mechanics::elements::contact::surfaces::kind::{MakeSurface, SurfaceKind};

/// Contact of points with a surface: pressure, friction and rebound. With a stiffness of 0 only the gap is monitored.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Name, for messages, results and `[[expect]]`.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// The surface that is touched. Not with `among`.
    pub surface: Maybe<OneOf<Surface>>,
    /// Names of the touching parts: points, bodies, sets, groups of the mesh, beams, bars, shells and their edges; for a part as surface
    /// also "itself". Not with `among`. Bodies touch a box, hull, sphere, cylinder or capsule with their whole surface, a plane and faces
    /// with corners of a box or hull and ends of a capsule. A cylinder touches planes with its whole surface and faces with its rims.
    /// Beams, bars and free edges touch a whole capsule, corners and edges of a box or hull, and 16 lines along a cylinder; a sphere always
    /// touches as a sphere.
    pub with: Maybe<Names>,
    /// In place of `surface` and `with`: spheres, boxes, hulls, cylinders, capsules and points with a `radius`, each of which may touch
    /// each other. Bodies other than spheres do not touch if a joint connects them.
    pub among: Maybe<Names>,
    /// Names of the stages in which it acts. Default: all.
    pub stages: Maybe<Names>,
    /// Contact radius: distance from a point to its surface, 0 or more. Default: half the thickness of shells, half the smaller side of a
    /// beam's section, the radius of a sphere or a capsule; else 0.
    pub radius: Maybe<f64>,
    /// Penalty stiffness, force per penetration of each point, also for friction. 0: a clearance monitor,
    /// nothing acts. Default in dynamics, and with multipliers: by material, size, weight and speed of what touches; `check` says it.
    pub stiffness: Maybe<f64>,
    /// What keeps things apart. Default: "penalty".
    pub method: Maybe<ContactMethod>,
    /// With "augmented-lagrangian": largest remaining penetration, and elastic slip of a load step, in units of length. At most 1e-4 and by
    /// default 1e-8 of the smallest size of the touching parts.
    pub penetration_tolerance: Maybe<f64>,
    /// Coefficient of restitution, speed after an impact over that before, 0.01 to 1, or 0. Default: 1, nothing is
    /// lost. With 0 nothing rebounds: what lands stays as deep as the impact has pressed it in.
    pub restitution: Maybe<f64>,
    /// Force per normal velocity, 0 or more, instead of a restitution. The contact never pulls.
    pub damping: Maybe<f64>,
    /// Coulomb's coefficient of friction, 0 or more; in dynamics also { static, kinetic, decay }. Default: 0.
    pub friction: Maybe<NumberOrTable<ContactFriction>>,
    /// Further contact points, at most 100: between neighbouring nodes of beams, bars and shells. Also between corners of boxes, ends of
    /// capsules and rims of cylinders that touch by points. Default: 0.
    pub points: Maybe<u64>,
}

/// Two coefficients of friction.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactFriction {
    /// Coulomb's coefficient while the contact sticks, above 0.
    #[schemars(required)]
    #[serde(rename = "static")]
    pub sticking: Maybe<f64>,
    /// Coulomb's coefficient of a contact that slips fast, 0 to `static`.
    #[schemars(required)]
    pub kinetic: Maybe<f64>,
    /// Time per length, above 0: at a slip speed v the coefficient is kinetic + (static − kinetic) exp(−decay v). Default: `kinetic` as soon
    /// as the contact slips.
    pub decay: Maybe<f64>,
}

/// The coefficients of friction of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients {
    /// The coefficient while the contact sticks.
    pub sticking: f64,
    /// The coefficient at a high slip speed.
    pub kinetic: f64,
    /// Time per length: rate at which the coefficient decreases with the slip speed; infinite without `decay`.
    pub decay: f64,
}

impl Contact {
    /// The coefficients of friction; zero where the deck gives none.
    pub fn coefficients(&self) -> Coefficients {
        let value = |at: &Maybe<f64>| at.as_ref().map_or(0.0, |at| at.value);
        let one = |mu: f64| Coefficients { sticking: mu, kinetic: mu, decay: f64::INFINITY };
        match self.friction.as_ref().map(|at| &at.value) {
            Some(NumberOrTable::Table(table)) => Coefficients {
                sticking: value(&table.sticking),
                kinetic: value(&table.kinetic),
                decay: table.decay.as_ref().map_or(f64::INFINITY, |at| at.value),
            },
            Some(NumberOrTable::Number(mu)) => one(*mu),
            None => one(0.0),
        }
    }
}

/// Method that separates touching parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ContactMethod {
    /// Springs of the stiffness given, which are pressed in.
    #[default]
    Penalty,
    /// Multipliers besides, in load steps of static analyses: nothing is pressed in, whatever the stiffness, and what sticks does not creep.
    /// For points, nodes of parts and spheres on shapes, and for bodies on planes and cylinders.
    AugmentedLagrangian,
}

impl PartTable for Contact {
    fn name(&self) -> Option<&At<String>> {
        self.name.as_ref()
    }

    fn members(&self) -> Vec<&At<String>> {
        let part = self.surface.as_ref().and_then(|table| table.part.as_ref());
        let with = names(&self.with).into_iter().filter(|at| part.is_none() || at.value != "itself");
        with.chain(names(&self.among)).chain(part).collect()
    }
}

/// A surface on a body or on the ground, global coordinates at t = 0, or the surface of a body or a part.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// Name of the body that carries it; without a `shape` its own shape is the surface. Default: the ground.
    pub body: Maybe<String>,
    /// Part whose surface is used in place of a shape. A shell gives its faces on both sides, with its thickness; a beam or bar its round
    /// surface with `radius`, by default half the depth of the section of a beam.
    pub part: Maybe<String>,
    /// True: the free edges of the shell `part` are the surface in place of its faces, round with `radius`, by default half the thickness.
    /// Shells in `with` touch them with their own free edges, beams, bars and capsules with all of their length, boxes and hulls with
    /// corners and edges. Default: false.
    pub edges: Maybe<bool>,
}

impl Kinds for Surface {
    const CHOOSER: &'static str = "shape";
    const ABOUT: &'static str = "The shape, on which the other keys depend.";
    const REQUIRED: bool = false;
    type Make = MakeSurface<SurfaceShape>;

    fn list() -> &'static [&'static SurfaceKind<SurfaceShape>] {
        SURFACES
    }
}
