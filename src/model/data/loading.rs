//! Loads, ground motion and damping.

use super::moving_frame::MovingFrames;
use base::math::{Mat3, Vec3};
use mechanics::amplitude::Amplitude;
use mechanics::constraints::joint::ConstraintEquation;
use mechanics::elements::pressure::Face;
use mechanics::state::Node;

/// The loads of a scene.
#[derive(Debug, Clone)]
pub struct Loading {
    /// Functions of time, which loads and prescribed motions name by index.
    pub amplitudes: Vec<Amplitude>,
    /// Forces and moments on nodes.
    pub nodal: Vec<Load>,
    /// Follower pressures on faces.
    pub pressures: Vec<Pressure>,
    /// Centrifugal forces of masses.
    pub centrifugal: Vec<Centrifugal>,
    /// Acceleration of gravity, global components.
    pub gravity: Vec3,
    /// Index of its amplitude; `None`: constant in dynamics, growing linearly in statics.
    pub gravity_amplitude: Option<usize>,
    /// Accelerations of the ground.
    pub base_accelerations: Vec<BaseAcceleration>,
}

impl Loading {
    /// The node of an unbalance, whose spin is the angular frequency of a response; `None` if spins are those of t = 0.
    pub fn unbalanced_node(&self) -> Option<usize> {
        self.nodal.iter().find(|load| load.is_unbalance()).map(|load| load.node)
    }
}

impl Default for Loading {
    fn default() -> Self {
        Loading {
            amplitudes: Vec::new(),
            nodal: Vec::new(),
            pressures: Vec::new(),
            centrifugal: Vec::new(),
            gravity: Vec3::zeros(),
            gravity_amplitude: None,
            base_accelerations: Vec::new(),
        }
    }
}

/// Force and moment on a node, global components at t = 0.
#[derive(Debug, Clone)]
pub struct Load {
    /// The node.
    pub node: usize,
    /// Force, global components at t = 0.
    pub force: Vec3,
    /// Moment, global components at t = 0.
    pub moment: Vec3,
    /// True where force and moment rotate with the node.
    pub follower: bool,
    /// Index of its amplitude; `None`: constant in dynamics, growing linearly in statics.
    pub amplitude: Option<usize>,
    /// The element or coordinate of a load with this share; `None` for a load on the node alone.
    pub origin: Option<LoadOrigin>,
    /// False for moments without a direct action on the node: moments of spread loads, cancelled by their neighbours, and residual moments
    /// of the last stage.
    pub moment_counts: bool,
}

/// The element or coordinate of a load, with shares on nodes.
#[derive(Debug, Clone, Copy)]
pub enum LoadOrigin {
    /// An element over which a load per length is spread: the part, by its index in [`super::Model::parts`], and its element.
    Element(usize, usize),
    /// Parts, surfaces or edges over which a load is spread.
    Spread,
    /// The coordinate of a joint: the load acts on the node as far as this moves the coordinate.
    Coordinate(LoadedCoordinate),
    /// An unbalance: the force is its size at a spin of 1, and its amplitude gives one of two directions that turn with the spin.
    Unbalance,
}

/// The effort of a motor as the load on one end of its joint. The directions are those of the gradient of the coordinate, so that both ends
/// together do the work of the effort along the coordinate, and action equals reaction.
#[derive(Debug, Clone, Copy)]
pub struct LoadedCoordinate {
    /// The two ends of the joint.
    pub ends: [usize; 2],
    /// Which of them the load acts on, 0 or 1.
    pub end: usize,
    /// The equation that would lock the joint; its violation is the coordinate.
    pub lock: ConstraintEquation,
    /// Force or moment along the coordinate.
    pub effort: f64,
}

impl LoadedCoordinate {
    /// The way of the coordinate between two configurations, less than half a turn apart. The load on the second end counts it, that on the
    /// first none of it.
    pub fn way(&self, from: &[Node], to: &[Node]) -> f64 {
        if self.end == 0 {
            return 0.0;
        }
        let [before, after] = [from, to].map(|nodes| {
            let [a, b] = self.ends.map(|end| &nodes[end]);
            self.lock.gap(a, b)[0]
        });
        self.lock.nearest(after - before)
    }

    /// Writes the load stiffness −∂(f, m)/∂(x, θ) of both ends, 12×12 in row-major order.
    pub fn stiffness(&self, factor: f64, nodes: &[Node], K: &mut [f64]) {
        K.fill(0.0);
        let [a, b] = self.ends.map(|end| &nodes[end]);
        self.lock.stiffness(a, b, -factor * self.effort, |row, column, block| {
            for i in 0..3 {
                for j in 0..3 {
                    K[12 * (3 * row + i) + 3 * column + j] += block[(i, j)];
                }
            }
        });
    }
}

impl Load {
    /// The coordinate of a joint along which it acts.
    pub fn coordinate(&self) -> Option<&LoadedCoordinate> {
        match &self.origin {
            Some(LoadOrigin::Coordinate(coordinate)) => Some(coordinate),
            _ => None,
        }
    }

    /// True for a part of the rotating force of an unbalance.
    pub fn is_unbalance(&self) -> bool {
        matches!(self.origin, Some(LoadOrigin::Unbalance))
    }

    /// Multiplies it by a factor.
    pub fn scale(&mut self, factor: f64) {
        self.force *= factor;
        self.moment *= factor;
        if let Some(LoadOrigin::Coordinate(coordinate)) = &mut self.origin {
            coordinate.effort *= factor;
        }
    }

    /// True where it has a potential, hence a symmetric tangent: it is no follower, and its moment acts only about the `normal` of a plane
    /// motion. The work of moments about fixed axes in space depends on the order of rotations. Moments without direct action are left
    /// aside. The potential of an effort is the coordinate times the effort.
    pub fn has_potential(&self, normal: Option<usize>) -> bool {
        let about_normal = || (0..3).all(|i| self.moment[i] == 0.0 || normal == Some(i));
        self.coordinate().is_some() || !self.follower && (!self.moment_counts || about_normal())
    }
}

/// Follower pressure: it acts on the current area of faces, against their current normals.
#[derive(Debug, Clone)]
pub struct Pressure {
    /// The faces.
    pub faces: Vec<Face>,
    /// Pressure, force per current area.
    pub pressure: f64,
    /// Index of its amplitude; `None`: constant in dynamics, growing linearly in statics.
    pub amplitude: Option<usize>,
}

/// The centrifugal force of masses in a frame that turns steadily: it acts at their current places.
#[derive(Debug, Clone)]
pub struct Centrifugal {
    /// The masses.
    pub of: TurningMasses,
    /// The axis of the rotation.
    pub axis: RotationAxis,
    /// Angular velocity for the factor 1, radians per time.
    pub speed: f64,
    /// Index of its amplitude, which multiplies the speed; `None`: the speed grows linearly in statics.
    pub amplitude: Option<usize>,
}

/// The masses under a centrifugal force.
#[derive(Debug, Clone, Default)]
pub struct TurningMasses {
    /// Indices into [`super::Model::parts`].
    pub parts: Vec<usize>,
    /// Indices into [`super::Model::bodies`].
    pub bodies: Vec<usize>,
    /// Indices into [`super::Model::masses`].
    pub masses: Vec<usize>,
}

/// The axis of a rotation, fixed in space.
#[derive(Debug, Clone, Copy)]
pub struct RotationAxis {
    /// Unit vector along it, global components.
    pub direction: Vec3,
    /// A point on it.
    pub through: Vec3,
}

impl RotationAxis {
    /// The vector from the axis to a place, perpendicular to the axis: centrifugal force per mass at an angular velocity of 1.
    pub fn away(&self, x: &Vec3) -> Vec3 {
        let arm = x - self.through;
        arm - self.direction * self.direction.dot(&arm)
    }

    /// The centrifugal moment of an inertia tensor J about its node at an angular velocity of 1.
    pub fn moment(&self, J: &Mat3) -> Vec3 {
        -self.direction.cross(&(J * self.direction))
    }
}

/// Acceleration of the ground. Every mass M has the force −M a; displacements are relative to the ground.
#[derive(Debug, Clone)]
pub struct BaseAcceleration {
    /// Acceleration for the amplitude 1, global components.
    pub direction: Vec3,
    /// Index of its amplitude.
    pub amplitude: usize,
}

/// Rayleigh factors of a part; `None` for those of the whole model.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct OwnDamping {
    /// α on its mass, 1/time.
    pub alpha: Option<f64>,
    /// β on its elastic stiffness, time.
    pub beta: Option<f64>,
}

impl Damping {
    /// α of a part.
    pub fn alpha(&self, own: &OwnDamping) -> f64 {
        own.alpha.unwrap_or(self.mass_factor)
    }

    /// β of a part.
    pub fn beta(&self, own: &OwnDamping) -> f64 {
        own.beta.unwrap_or(self.stiffness_factor)
    }
}

/// Viscous damping besides that of links.
#[derive(Debug, Clone, Default)]
pub struct Damping {
    /// Rayleigh's α in C = α M + β K, 1/time.
    pub mass_factor: f64,
    /// Rayleigh's β, time; it acts on strain rates of deformable parts and on springs of links and joints.
    pub stiffness_factor: f64,
    /// The part of critical damping of each of the first modes, of a dynamic analysis.
    pub modal: Vec<f64>,
    /// The reference frames of α.
    pub frames: MovingFrames,
    /// Dampers of nodes.
    pub nodal: Vec<NodalDamping>,
}

/// Viscous damping of a node against the ground.
#[derive(Debug, Clone)]
pub struct NodalDamping {
    /// The node.
    pub node: usize,
    /// Force per velocity.
    pub translation: f64,
    /// Moment per angular velocity.
    pub rotation: f64,
}
