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

/// Points that push away from a surface, rub on it and bounce off it; or, with a stiffness of 0, a zone whose gap
/// is watched.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Name, for messages, results and `[[expect]]`.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// The surface that is touched. Not with `among`.
    pub surface: Maybe<OneOf<Surface>>,
    /// What touches it, by name: points, bodies (all of them on a box, hull, sphere, cylinder or capsule; on planes and faces corners of a
    /// box or hull and ends of a capsule, on planes all of a cylinder, on faces its rims; on beams, bars and free edges all of a capsule,
    /// corners and edges of a box or hull, and 16 lines along a cylinder; a sphere as it is), sets, groups of the mesh, beams, bars, shells and their edges; for a part as surface also "itself". Not with `among`.
    pub with: Maybe<Names>,
    /// In place of `surface` and `with`: bodies that are spheres, boxes, hulls, cylinders or capsules, and points with a `radius`, of which
    /// each may touch each; bodies other than spheres that a joint holds together do not.
    pub among: Maybe<Names>,
    /// Names of the stages in which it is there. Default: all.
    pub stages: Maybe<Names>,
    /// Contact radius: the distance from a point at which it touches, 0 or more. Default: half the thickness of
    /// shells, half the smaller side of a beam's section, the radius of a sphere or a capsule; else 0.
    pub radius: Maybe<f64>,
    /// Penalty stiffness, force per penetration of each point, also for friction. 0: a clearance monitor,
    /// nothing acts. Default in dynamics, and with multipliers: by material, size, weight and speed of what touches; `check` says it.
    pub stiffness: Maybe<f64>,
    /// What keeps things apart. Default: "penalty".
    pub method: Maybe<ContactMethod>,
    /// With "augmented-lagrangian": the largest depth, and elastic slip of a load step, that are left, in units of length, at most 1e-4 and by default 1e-8 of
    /// the smallest size of what touches.
    pub penetration_tolerance: Maybe<f64>,
    /// Coefficient of restitution, speed after an impact over that before, 0.01 to 1, or 0. Default: 1, nothing is
    /// lost. With 0 nothing rebounds: what lands stays as deep as the impact has pressed it in.
    pub restitution: Maybe<f64>,
    /// Force per normal velocity, 0 or more, instead of a restitution. The contact never pulls.
    pub damping: Maybe<f64>,
    /// Coulomb's coefficient of friction, 0 or more; in dynamics also { static, kinetic, decay }. Default: 0.
    pub friction: Maybe<NumberOrTable<ContactFriction>>,
    /// Further contact points between neighbouring nodes of beams, bars and shells, and between corners of
    /// boxes, ends of capsules and rims of cylinders where these touch by points, at most 100. Default: 0.
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
    /// Time per length, the rate at which the coefficient falls with the slip speed; infinite without `decay`.
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

/// What keeps things apart that touch.
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
    /// Name of a shell whose faces are the surface, in place of a shape: both sides, with its thickness, wherever it
    /// bends; or of a beam or bar, by its `radius`, which of a beam is half the depth of its section by default.
    pub part: Maybe<String>,
    /// True: of a shell that is the `part`, the free edges are the surface in place of the faces, round, by `radius`, which is half the
    /// thickness by default. Shells in `with` touch them with their own free edges, beams, bars and capsules with all of their length,
    /// boxes and hulls with corners and edges. Default: false.
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
