//! `[[supports]]`: motion that is given.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Directions, Maybe, Names, Table, Vector};
use base::math::turn::RotationAngles;

/// Directions held at rest or moved as told.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Support {
    /// Names of points, bodies, parts or sets.
    #[schemars(required)]
    pub at: Maybe<Names>,
    /// Degrees of freedom that are restrained at zero: "all", "translations", "rotations" or a list such as ["ux", "ry"].
    pub fix: Maybe<Directions>,
    /// Axes of `fix` and `motion`, which stay as they are: their x, and a vector in their x-y plane. "ux" is then the translation along
    /// that x, "rx" the rotation about it; only translations can move. Default: global axes.
    pub axes: Maybe<Vec<Vector>>,
    /// Name, for `stop` of a stage and for `[[load_cases]]`. Default: none.
    pub name: Maybe<String>,
    /// Names of the stages in which it acts; it holds its nodes where it finds them. Default: all.
    pub stages: Maybe<Names>,
    /// Degrees of freedom that are prescribed as functions of time.
    pub motion: Maybe<Table<Motions>>,
    /// Meaning of several rotations of `fix` and `motion` together; `history` refers to these numbers. Default: "vector".
    pub rotation: Maybe<Rotation>,
}

/// Meaning of rotations about the global axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Rotation {
    /// The components of one rotation vector, as in nodes.csv.
    #[default]
    Vector,
    /// Angles one after the other: rx about global x, ry about y as rx has turned it, rz about z as both have turned it.
    Xyz,
    /// Angles in the sequence rx, rz, ry.
    Xzy,
    /// Angles in the sequence ry, rx, rz.
    Yxz,
    /// Angles in the sequence ry, rz, rx.
    Yzx,
    /// Angles in the sequence rz, rx, ry.
    Zxy,
    /// Angles in the sequence rz, ry, rx: yaw, pitch and roll.
    Zyx,
}

impl Rotation {
    /// Definition of the three numbers.
    pub fn angles(self) -> RotationAngles {
        RotationAngles::Sequence(match self {
            Rotation::Vector => return RotationAngles::Vector,
            Rotation::Xyz => [0, 1, 2],
            Rotation::Xzy => [0, 2, 1],
            Rotation::Yxz => [1, 0, 2],
            Rotation::Yzx => [1, 2, 0],
            Rotation::Zxy => [2, 0, 1],
            Rotation::Zyx => [2, 1, 0],
        })
    }
}

/// Prescribed motion by direction.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motions {
    /// Displacement along global x.
    pub ux: Maybe<Table<Motion>>,
    /// Displacement along global y.
    pub uy: Maybe<Table<Motion>>,
    /// Displacement along global z.
    pub uz: Maybe<Table<Motion>>,
    /// Rotation about global x, radians. With more than one rotation given, see `rotation`.
    pub rx: Maybe<Table<Motion>>,
    /// Rotation about global y, radians.
    pub ry: Maybe<Table<Motion>>,
    /// Rotation about global z, radians.
    pub rz: Maybe<Table<Motion>>,
}

impl Motions {
    /// The motions in the six directions, displacements first.
    pub fn each(&self) -> [&Maybe<Table<Motion>>; 6] {
        [&self.ux, &self.uy, &self.uz, &self.rx, &self.ry, &self.rz]
    }
}

/// A motion: scale times amplitude.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Name of an amplitude. Optional for a support that first acts in a static stage: the motion then grows over that stage, and stays.
    pub amplitude: Maybe<String>,
    /// Factor on the amplitude. Default: 1.
    pub scale: Maybe<f64>,
    /// Instead of `amplitude` and `scale`, in static stages: the displacement from t = 0 at the end of the first stage in which the support acts.
    /// (ux, uy, uz)
    pub to: Maybe<f64>,
    /// The quantity that the amplitude gives. Default: "displacement".
    pub history: Maybe<History>,
}

/// The quantity that the amplitude of a prescribed motion gives over time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum History {
    /// The displacement or, about an axis, the rotation.
    #[default]
    Displacement,
    /// The velocity, which is integrated from zero displacement on.
    Velocity,
    /// The acceleration, which is integrated twice.
    Acceleration,
}
