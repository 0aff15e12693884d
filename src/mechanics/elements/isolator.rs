//! Seismic isolators between two nodes: a slider on a spherical dish (friction pendulum), and rubber with a lead core.
//!
//! Components are along the axes B = R₁ A of the first end, whose first axis n is normal to the dish or to the layers of rubber. The second
//! end has moved by d, of which d_n is along n and u across it. The internal forces, with the sign of a spring, are
//!   pendulum: N = k_n ⟨u²/2R − d_n⟩,  p_n = −N,  p_u = N u/R + q,  |q| ≤ μ N,  μ = μ_f − (μ_f − μ_s) exp(−a |u̇|),
//!   rubber:   p_n = k_n d_n,  p_u = k₂ u + q,  |q| ≤ F_y (1 − k₂/k).
//! q = k₀ (u − u_p) is a spring that slips in the direction of its force (return mapping), so both directions interact on a circle. The
//! slider rises on the dish by u²/2R, which gives N and N u/R one potential. A dish that is lifted off carries nothing, and the slider stands
//! unloaded wherever it lands. The forces act at the second end. J. N. Yang et al.; A. Schellenberg, elements singleFPBearing (with
//! `-inclVertDisp`) and elastomericBearingPlasticity of OpenSees; M. C. Constantinou, A. Mokha & A. M. Reinhorn, J. Struct. Eng. 116 (1990) 455-474.

use super::block::{Branches, Elements, Force, Mechanics, Moduli, Results, subtract};
use crate::materials::Dissipation;
use crate::state::{Configuration, Node};
use base::math::{Mat3, Vec3, skew};
use nalgebra::{Matrix2, Vector2};

/// The number of history variables of each isolator: u_p, q, and 1 where it slipped last.
pub const MEMORY: usize = 5;

/// The coefficient of friction over the sliding speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlidingFriction {
    /// μ_s, at rest.
    pub slow: f64,
    /// μ_f, at a high speed.
    pub fast: f64,
    /// a, time per length; of no effect where both are equal.
    pub rate: f64,
}

impl SlidingFriction {
    /// μ and its derivative by the speed.
    fn at(&self, speed: f64) -> [f64; 2] {
        let fades = (self.fast - self.slow) * (-self.rate * speed).exp();
        [self.fast - fades, self.rate * fades]
    }

    /// True without friction at any speed.
    fn is_none(&self) -> bool {
        self.slow == 0.0 && self.fast == 0.0
    }

    /// True where the coefficient depends on the speed.
    fn changes(&self) -> bool {
        self.fast != self.slow && self.rate > 0.0
    }
}

/// What holds the ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum IsolatorLaw {
    /// A slider on a dish.
    Pendulum {
        /// R, the effective radius.
        radius: f64,
        /// μ.
        friction: SlidingFriction,
    },
    /// Rubber, with a lead core or of high damping.
    Rubber {
        /// F_y.
        yield_force: f64,
        /// k₂.
        post_yield_stiffness: f64,
    },
}

/// One isolator between two nodes.
#[derive(Debug, Clone)]
pub struct Isolator {
    /// The two nodes. The dish turns with the first, the slider stands on the second.
    pub nodes: [usize; 2],
    /// A: the axes as columns, global components at t = 0. The first points from the dish to the slider.
    pub axes: Mat3,
    /// Aᵀ(x₂ − x₁) without force.
    pub offset: Vec3,
    /// The force of sliding.
    pub law: IsolatorLaw,
    /// k, force per displacement across the first axis before it slips.
    pub stiffness: f64,
    /// k_n, force per displacement along the first axis.
    pub axial_stiffness: f64,
    /// Rayleigh's factor on the stiffness of rubber: k_n and k₂.
    pub beta: f64,
}

/// Motion of the second node relative to the first.
struct RelativeMotion {
    B: Mat3,
    /// x₂ − x₁, global components.
    r: Vec3,
    /// Velocity of the second node relative to the frame of the first, global components.
    v: Vec3,
    /// d, in the frame.
    d: Vec3,
    /// Its rate, in the frame.
    rate: Vec3,
}

/// Forces on the second end, in the frame, and what comes of them.
struct IsolatorForce {
    p: Vec3,
    by_d: Mat3,
    by_rate: Mat3,
    /// Slip of this step.
    slip: Vector2<f64>,
    /// q.
    sticking: Vector2<f64>,
    energy: f64,
    damping_power: f64,
}

/// The force that slips, q, and its derivatives.
#[derive(Default)]
struct Sliding {
    q: Vector2<f64>,
    by_u: Matrix2<f64>,
    /// By the limit.
    by_limit: Vector2<f64>,
    slip: Vector2<f64>,
}

/// Returns the spring of stiffness `k` at the stretch `s` to the circle of the radius `limit`.
fn slide(k: f64, s: &Vector2<f64>, limit: f64) -> Sliding {
    let trial = k * s;
    let size = trial.norm();
    if size <= limit {
        return Sliding { q: trial, by_u: k * Matrix2::identity(), by_limit: Vector2::zeros(), slip: Vector2::zeros() };
    }
    let e = trial / size;
    let by_u = limit / size * k * (Matrix2::identity() - e * e.transpose());
    Sliding { q: limit * e, by_u, by_limit: e, slip: (size - limit) / k * e }
}

impl Isolator {
    fn motion(&self, nodes: &[Node]) -> RelativeMotion {
        let [a, b] = self.nodes.map(|n| &nodes[n]);
        let B = a.R() * self.axes;
        let r = b.relative_position(a);
        let v = b.v - a.v - a.omega.cross(&r);
        RelativeMotion { B, r, v, d: B.tr_mul(&r) - self.offset, rate: B.tr_mul(&v) }
    }

    /// The forces at a displacement and its rate, from u_p at the end of the last step.
    fn at(&self, d: &Vec3, rate: &Vec3, memory: &[f64], moduli: Moduli) -> IsolatorForce {
        let slipped = match memory {
            &[y, z, ..] => Vector2::new(y, z),
            _ => Vector2::zeros(),
        };
        let (u, speed) = (Vector2::new(d.y, d.z), Vector2::new(rate.y, rate.z));
        match &self.law {
            IsolatorLaw::Pendulum { radius, friction } => {
                self.pendulum((*radius, friction), (d.x, &u, &speed), &slipped, moduli)
            }
            IsolatorLaw::Rubber { yield_force, post_yield_stiffness } => {
                self.rubber([*yield_force, *post_yield_stiffness], (d, rate, &u), &slipped, moduli)
            }
        }
    }

    fn pendulum(
        &self,
        (radius, friction): (f64, &SlidingFriction),
        (d_n, u, speed): (f64, &Vector2<f64>, &Vector2<f64>),
        slipped: &Vector2<f64>,
        moduli: Moduli,
    ) -> IsolatorForce {
        let k = self.axial_stiffness;
        let depth = 0.5 * u.norm_squared() / radius - d_n;
        let N = k * depth.max(0.0);
        // The derivative of the depth.
        let J = Vec3::new(-1.0, u.x / radius, u.y / radius);
        let v = speed.norm();
        let [mu, by_speed] = friction.at(v);
        let mut sliding = match friction.is_none() {
            // Nothing sticks, not even at rest.
            true => Sliding { slip: u - slipped, ..Sliding::default() },
            false => slide(self.stiffness, &(u - slipped), mu * N),
        };
        let energy = 0.5 * k * depth.max(0.0).powi(2) + 0.5 * sliding.q.norm_squared() / self.stiffness;
        if depth == 0.0 {
            // Before the first load a slider without friction has nothing else that holds it.
            sliding.by_u = self.stiffness * Matrix2::identity();
        } else if depth > 0.0 && !friction.is_none() && moduli == Moduli::Elastic {
            sliding.by_u = self.stiffness * Matrix2::identity();
            sliding.by_limit = Vector2::zeros();
        }
        let across = |q: &Vector2<f64>| Vec3::new(0.0, q.x, q.y);
        let e = across(&sliding.by_limit);
        let (mut by_d, mut by_rate) = (Mat3::zeros(), Mat3::zeros());
        // A slider that just touches is held, so that a first load finds a stiffness.
        if depth >= 0.0 {
            by_d = k * J * J.transpose() + mu * k * e * J.transpose();
            let flat = N / radius * Matrix2::identity() + sliding.by_u;
            add_across(&mut by_d, &flat);
            let along = if v > 0.0 { across(&(speed / v)) } else { Vec3::zeros() };
            by_rate = N * by_speed * e * along.transpose();
        }
        IsolatorForce {
            p: N * J + across(&sliding.q),
            by_d,
            by_rate,
            slip: sliding.slip,
            sticking: sliding.q,
            energy,
            damping_power: 0.0,
        }
    }

    fn rubber(
        &self,
        [yield_force, post_yield_stiffness]: [f64; 2],
        (d, rate, u): (&Vec3, &Vec3, &Vector2<f64>),
        slipped: &Vector2<f64>,
        moduli: Moduli,
    ) -> IsolatorForce {
        let hysteretic = self.sticking_stiffness();
        let limit = yield_force * hysteretic / self.stiffness;
        let mut sliding = slide(hysteretic, &(u - slipped), limit);
        if moduli == Moduli::Elastic {
            sliding.by_u = hysteretic * Matrix2::identity();
        }
        let k = Vec3::new(self.axial_stiffness, post_yield_stiffness, post_yield_stiffness);
        let elastic = k.component_mul(d);
        let viscous = self.beta * k.component_mul(rate);
        let mut by_d = Mat3::from_diagonal(&k);
        add_across(&mut by_d, &sliding.by_u);
        IsolatorForce {
            p: elastic + viscous + Vec3::new(0.0, sliding.q.x, sliding.q.y),
            by_d,
            by_rate: Mat3::from_diagonal(&(self.beta * k)),
            slip: sliding.slip,
            sticking: sliding.q,
            energy: 0.5 * elastic.dot(d) + 0.5 * sliding.q.norm_squared() / hysteretic,
            damping_power: viscous.dot(rate),
        }
    }

    /// The work that the slip of a step dissipates, from the force `before` that slipped already or not. The limit changes evenly over a step that slips
    /// throughout, and falls to that of the end where the force was above it. Without a limit the stored energy is lost.
    fn dissipated(&self, before: &Vector2<f64>, slipped: bool, force: &IsolatorForce) -> f64 {
        let [start, end] = [before.norm(), force.sticking.norm()];
        if end == 0.0 {
            return 0.5 * start * start / self.sticking_stiffness();
        }
        let mean = if slipped || start > end { 0.5 * (start + end) } else { end };
        mean * force.slip.norm()
    }

    /// The stiffness of the spring that slips.
    fn sticking_stiffness(&self) -> f64 {
        match self.law {
            IsolatorLaw::Pendulum { .. } => self.stiffness,
            IsolatorLaw::Rubber { post_yield_stiffness, .. } => self.stiffness - post_yield_stiffness,
        }
    }

    /// d, its rate along the first axis, and the force on the second end; components in the frame. `memory`: its history variables.
    pub fn state(&self, nodes: &[Node], memory: &[f64]) -> (Vec3, f64, Vec3) {
        let motion = self.motion(nodes);
        (motion.d, motion.rate.x, self.at(&motion.d, &motion.rate, memory, Moduli::Algorithmic).p)
    }

    /// True for a pendulum that is lifted off its dish.
    fn is_lifted(&self, nodes: &[Node]) -> bool {
        let IsolatorLaw::Pendulum { radius, .. } = self.law else { return false };
        let d = self.motion(nodes).d;
        0.5 * (d.y * d.y + d.z * d.z) / radius < d.x
    }
}

/// Adds a matrix across the first axis.
fn add_across(to: &mut Mat3, flat: &Matrix2<f64>) {
    let mut part = to.fixed_view_mut::<2, 2>(1, 1);
    part += flat;
}

/// A group of isolators.
pub struct Isolators {
    list: Vec<Isolator>,
}

impl Isolators {
    /// A group of these isolators.
    pub fn new(list: Vec<Isolator>) -> Isolators {
        Isolators { list }
    }

    fn memory<'a>(&self, e: usize, history: &'a [f64]) -> &'a [f64] {
        history.get(MEMORY * e..MEMORY * (e + 1)).unwrap_or(&[])
    }

    /// Each isolator with its motion and its forces.
    fn each<'a>(
        &'a self,
        now: &'a Configuration,
    ) -> impl Iterator<Item = (&'a Isolator, RelativeMotion, IsolatorForce)> {
        self.list.iter().enumerate().map(|(e, isolator)| {
            let motion = isolator.motion(now.nodes);
            let memory = self.memory(e, now.history);
            let force = isolator.at(&motion.d, &motion.rate, memory, Moduli::Algorithmic);
            (isolator, motion, force)
        })
    }
}

impl Elements for Isolators {
    fn len(&self) -> usize {
        self.list.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.list[e].nodes
    }

    fn dofs(&self) -> usize {
        6
    }

    fn is_rotational(&self, _: usize, node: usize) -> bool {
        node == 0
    }
}

impl Mechanics for Isolators {
    fn history(&self) -> usize {
        MEMORY * self.list.len()
    }

    fn slips_by_load(&self) -> bool {
        self.list.iter().any(|of| matches!(&of.law, IsolatorLaw::Pendulum { friction, .. } if !friction.is_none()))
    }

    fn is_damped(&self) -> bool {
        self.list.iter().any(|of| match &of.law {
            IsolatorLaw::Pendulum { friction, .. } => friction.changes(),
            IsolatorLaw::Rubber { .. } => of.beta > 0.0,
        })
    }

    fn damps_most_at_rest(&self) -> bool {
        self.list.iter().any(|of| matches!(&of.law, IsolatorLaw::Pendulum { friction, .. } if friction.changes()))
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        for (isolator, motion, force) in self.each(now) {
            let f = motion.B * force.p;
            let [a, b] = isolator.nodes;
            subtract(&mut F[a], 0, &-f);
            subtract(&mut F[a], 3, &-motion.r.cross(&f));
            subtract(&mut F[b], 0, &f);
        }
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, K: &mut [f64]) {
        let isolator = &self.list[e];
        let motion = isolator.motion(now.nodes);
        let force = isolator.at(&motion.d, &motion.rate, self.memory(e, now.history), moduli);
        let B = motion.B;
        let (k, c) = (B * force.by_d * B.transpose(), B * force.by_rate * B.transpose());
        let f = skew(&(B * force.p));
        let (r, v) = (skew(&motion.r), skew(&motion.v));
        // δf = F_r (δx₂ − δx₁) + F_1 δθ₁, as for a bushing.
        let omega = now.nodes[isolator.nodes[0]].omega;
        let F_r = k + c * (rate_weight * Mat3::identity() - skew(&omega));
        let F_1 = k * r + c * (v + rate_weight * r) - f;
        let columns = [(-F_r, -f), (F_1, Mat3::zeros()), (F_r, f), (Mat3::zeros(), Mat3::zeros())];
        for (column, (df, arm)) in columns.iter().enumerate() {
            // Of −r × f on the first end.
            let moment = arm - r * df;
            for (row, block) in [-df, moment, *df, Mat3::zeros()].iter().enumerate() {
                for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
                    K[(3 * row + i) * 12 + 3 * column + j] = block[(i, j)];
                }
            }
        }
    }

    fn update_history(&self, now: &Configuration, part: f64, new: &mut [f64]) -> Dissipation {
        let mut lost = Dissipation::default();
        new.copy_from_slice(now.history);
        for ((isolator, _, force), memory) in self.each(now).zip(new.chunks_exact_mut(MEMORY)) {
            let slip = part * force.slip;
            let (before, after) = (Vector2::new(memory[2], memory[3]), force.sticking);
            lost.plastic += part * isolator.dissipated(&before, memory[4] > 0.0, &force);
            let stored = before + part * (after - before);
            let slid = if slip == Vector2::zeros() { 0.0 } else { 1.0 };
            memory.copy_from_slice(&[memory[0] + slip.x, memory[1] + slip.y, stored.x, stored.y, slid]);
        }
        lost
    }
}

impl Results for Isolators {
    fn energy(&self, now: &Configuration) -> f64 {
        self.each(now).map(|(_, _, force)| force.energy).sum()
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        self.each(now).map(|(_, _, force)| force.damping_power).sum()
    }
}

impl Branches for Isolators {
    fn is_inactive(&self, e: usize, now: &Configuration) -> bool {
        self.list[e].is_lifted(now.nodes)
    }

    fn has_kinks(&self) -> bool {
        true
    }

    fn branches(&self, now: &Configuration) -> usize {
        self.list.iter().filter(|isolator| isolator.is_lifted(now.nodes)).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pendulum(slow: f64, fast: f64) -> Isolator {
        let friction = SlidingFriction { slow, fast, rate: 2.0 };
        let law = IsolatorLaw::Pendulum { radius: 2.0, friction };
        Isolator {
            nodes: [0, 1],
            axes: Mat3::identity(),
            offset: Vec3::zeros(),
            law,
            stiffness: 1e3,
            axial_stiffness: 1e4,
            beta: 0.0,
        }
    }

    /// The elastic moduli are those of a slider that sticks: symmetric, without a derivative by the speed.
    #[test]
    fn elastic_moduli_are_symmetric() {
        let (d, rate) = (Vec3::new(-0.01, 0.3, -0.2), Vec3::new(0.1, 0.4, 0.2));
        let [elastic, slipping] =
            [Moduli::Elastic, Moduli::Algorithmic].map(|moduli| pendulum(0.1, 0.2).at(&d, &rate, &[], moduli));
        assert_eq!(elastic.by_d, elastic.by_d.transpose());
        assert_eq!(elastic.by_rate, Mat3::zeros());
        assert!(slipping.by_d != slipping.by_d.transpose() && slipping.by_rate != Mat3::zeros());
    }

    /// Without friction a slider at rest is held by the dish alone.
    #[test]
    fn nothing_sticks_without_friction() {
        for moduli in [Moduli::Elastic, Moduli::Algorithmic] {
            let at = pendulum(0.0, 0.0).at(&Vec3::new(-0.01, 0.0, 0.0), &Vec3::zeros(), &[], moduli);
            assert_eq!(at.by_d, Mat3::from_diagonal(&Vec3::new(1e4, 50.0, 50.0)));
        }
    }

    /// The spring of a slider that sticks loses its stored energy when the slider lifts off.
    #[test]
    fn a_lift_dissipates_what_was_stored() {
        let mut nodes = [0.0, -0.01].map(|z| crate::state::Node::at_rest(Vec3::new(z, 0.0, 0.0)));
        let block = Isolators::new(vec![pendulum(0.5, 0.5)]);
        let mut history = vec![0.0; MEMORY];
        let mut spent = 0.0;
        for (z, u) in [(-0.01, 0.02), (0.02, 0.02), (0.02, 0.1)] {
            nodes[1].x = Vec3::new(z, u, 0.0);
            let mut next = vec![0.0; MEMORY];
            let now = Configuration { nodes: &nodes, history: &history, dt: 0.1, previous: None };
            spent += block.update_history(&now, 1.0, &mut next).plastic;
            history = next;
        }
        assert!((spent - 0.5 * 1e3 * 0.02 * 0.02).abs() < 1e-15, "{spent}");
    }
}
