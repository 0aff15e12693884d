//! The centre of mass of a superelement in motion. It lies at x_c = x̄ + R ξ, with ξ the centre at t = 0 and the parts of displacements,
//! rotations and amplitudes in it. Its velocity is linear in the velocities of the nodes, with H_i the derivative of the vector of the
//! skew part of E_i: v_c = Σ s_i v_i + t_i H_i ω_i + Σ s_k η̇_k + Q Ω. A force F there acts on the nodes by the transposes.

use super::elastic::Moved;
use super::frame::{FloatingFrame, axial, half_trace_less};
use super::{FloatingElement, MassProperties, add_three, three};
use base::math::{Mat3, Vec3, skew};

/// The centre of mass at an instant; components along the axes of the frame.
pub struct Center<'a> {
    of: &'a FloatingElement,
    mass: &'a MassProperties,
    frame: &'a FloatingFrame,
    /// Its position in the frame.
    xi: Vec3,
    /// The matrix Q: the motion of the centre by a turn of the frame about fixed nodes.
    Q: Mat3,
}

/// Its motion.
pub struct CenterMotion {
    /// Angular velocity of the frame.
    spin: Vec3,
    /// Its rate.
    spin_rate: Vec3,
    velocity: Vec3,
    /// Its acceleration.
    pub acceleration: Vec3,
    /// The mean velocity of the nodes.
    mean: Vec3,
    Q_rate: Mat3,
    G_rate: Mat3,
}

/// The change of a force at the centre in a small motion of the nodes.
pub struct ForceChange {
    /// Change of the force along axes that turn with the frame.
    force: Vec3,
    dQ: Mat3,
}

/// A small motion, and how it changes velocities and accelerations along axes that turn with the frame.
pub struct MotionChange<'a> {
    /// The motion.
    pub moved: &'a Moved,
    /// Velocities.
    pub w: &'a [f64],
    /// Accelerations.
    pub a: &'a [f64],
    /// Their change.
    pub dw: &'a [f64],
    /// The change of accelerations of nodes and amplitudes.
    pub da: &'a [f64],
    /// Change of the angular velocity of the frame.
    pub dspin: Vec3,
    /// Change of G.
    pub dG: Mat3,
}

impl<'a> Center<'a> {
    /// The centre for displacements `q` in the frame.
    pub fn new(of: &'a FloatingElement, mass: &'a MassProperties, frame: &'a FloatingFrame, q: &[f64]) -> Center<'a> {
        let mut xi = mass.center;
        for i in 0..frame.z.len() {
            let [by_place, by_turn] = mass.of_node(i);
            xi += by_place * three(q, 6 * i) + by_turn * axial(&frame.E[i]);
        }
        of.each_amplitude(|k, _| xi += q[k] * mass.of_amplitude(k));
        let mut center = Center { of, mass, frame, xi, Q: Mat3::zeros() };
        center.Q = center.lever(&xi, |i| frame.z[i], |i| frame.H[i]);
        center
    }

    /// Its position relative to the first node, global components.
    pub fn beside_first(&self) -> Vec3 {
        self.frame.R * (self.xi - self.frame.z[0])
    }

    /// Q for a centre, positions of nodes and matrices H, or the change of Q for theirs.
    fn lever(&self, xi: &Vec3, z: impl Fn(usize) -> Vec3, H: impl Fn(usize) -> Mat3) -> Mat3 {
        let of_node = |i: usize| {
            let [by_place, by_turn] = self.mass.of_node(i);
            by_place * skew(&z(i)) - by_turn * H(i)
        };
        (0..self.frame.z.len()).map(of_node).sum::<Mat3>() - skew(xi)
    }

    /// Σ s_i a_i + t_i b_i + Σ s_k c_k.
    fn sum(&self, nodes: impl Fn(usize) -> [Vec3; 2], amplitudes: impl Fn(usize) -> f64) -> Vec3 {
        let mut sum = Vec3::zeros();
        for i in 0..self.frame.z.len() {
            let ([by_place, by_turn], [a, b]) = (self.mass.of_node(i), nodes(i));
            sum += by_place * a + by_turn * b;
        }
        self.of.each_amplitude(|k, _| sum += amplitudes(k) * self.mass.of_amplitude(k));
        sum
    }

    /// Its velocity for velocities `w` and the angular velocity of the frame.
    pub fn velocity(&self, w: &[f64], spin: Vec3) -> Vec3 {
        let of_node = |i: usize| [three(w, 6 * i), self.frame.H[i] * three(w, 6 * i + 3)];
        self.sum(of_node, |k| w[k]) + self.Q * spin
    }

    /// The rates of a node along the axes of the frame: of its position, of E and of H.
    fn rates(&self, w: &[f64], i: usize, [mean, spin]: [&Vec3; 2]) -> (Vec3, Mat3, Mat3) {
        let E_rate = skew(&(three(w, 6 * i + 3) - spin)) * self.frame.E[i];
        (three(w, 6 * i) - mean - spin.cross(&self.frame.z[i]), E_rate, half_trace_less(&E_rate))
    }

    /// Its motion, for velocities `w` and accelerations `a`.
    pub fn motion(&self, w: &[f64], a: &[f64], spin: Vec3) -> CenterMotion {
        let (frame, of, velocity) = (self.frame, self.of, self.velocity(w, spin));
        let n = frame.z.len();
        let mean = (0..n).map(|i| three(w, 6 * i)).sum::<Vec3>() / n as f64;
        let rates = |i: usize| self.rates(w, i, [&mean, &spin]);
        // The rates of v_i and of H_i ω_i along axes that turn.
        let accelerations = |i: usize| {
            let omega = three(w, 6 * i + 3);
            let alpha = three(a, 6 * i + 3) - spin.cross(&omega);
            [three(a, 6 * i) - spin.cross(&three(w, 6 * i)), rates(i).2 * omega + frame.H[i] * alpha]
        };
        let (mut S_rate, mut moment) = (Mat3::zeros(), Vec3::zeros());
        for (i, Y) in of.Y.iter().enumerate() {
            let ([a, alpha], (z_rate, E_rate, _)) = (accelerations(i), rates(i));
            S_rate += z_rate * Y.transpose() + of.turning * E_rate;
            moment += 0.5 * Y.cross(&a) + of.turning * alpha;
        }
        let G_rate = half_trace_less(&S_rate);
        let spin_rate = frame.inverse * (moment - G_rate * spin);
        let Q_rate = self.lever(&(velocity - mean - spin.cross(&self.xi)), |i| rates(i).0, |i| rates(i).2);
        let own = self.sum(accelerations, |k| a[k]);
        let acceleration = spin.cross(&velocity) + own + Q_rate * spin + self.Q * spin_rate;
        CenterMotion { spin, spin_rate, velocity, acceleration, mean, Q_rate, G_rate }
    }

    /// Adds the forces that a force at the centre exerts on the nodes.
    pub fn add_force(&self, force: &Vec3, f: &mut [f64]) {
        for i in 0..self.frame.z.len() {
            let [by_place, by_turn] = self.mass.of_node(i);
            add_three(f, 6 * i, &by_place.tr_mul(force));
            add_three(f, 6 * i + 3, &self.frame.H[i].tr_mul(&by_turn.tr_mul(force)));
        }
        self.of.each_amplitude(|k, _| f[k] += self.mass.of_amplitude(k).dot(force));
        self.of.add_turning(self.frame, &(self.frame.inverse * self.Q.tr_mul(force)), f);
    }

    /// The change of H in a small motion.
    fn dH(&self, moved: &Moved, i: usize) -> Mat3 {
        half_trace_less(&(skew(&moved.relative(self.frame, i)[1]) * self.frame.E[i]))
    }

    /// The displacement of a node in the frame, relative to the mean of the nodes.
    fn du(&self, moved: &Moved, i: usize) -> Vec3 {
        moved.relative(self.frame, i)[0] - moved.mean(self.frame.z.len())
    }

    /// The changes of ξ and Q in a small motion.
    fn shift(&self, moved: &Moved) -> (Vec3, Mat3) {
        let of_node = |i: usize| [self.du(moved, i), self.frame.H[i] * moved.relative(self.frame, i)[1]];
        let dxi = self.sum(of_node, |k| f64::from(u8::from(k == moved.dof)));
        (dxi, self.lever(&dxi, |i| self.du(moved, i), |i| self.dH(moved, i)))
    }

    /// Adds the change of the forces that `force` at the centre exerts on the nodes.
    pub fn add_change(&self, (moved, dG): (&Moved, &Mat3), force: &Vec3, change: &ForceChange, df: &mut [f64]) {
        let turning = self.frame.inverse * self.Q.tr_mul(force);
        for i in 0..self.frame.z.len() {
            let ([by_place, by_turn], dH) = (self.mass.of_node(i), self.dH(moved, i));
            add_three(df, 6 * i, &by_place.tr_mul(&change.force));
            let turned = dH.tr_mul(&(by_turn.tr_mul(force) + self.of.turning * turning));
            add_three(df, 6 * i + 3, &(turned + self.frame.H[i].tr_mul(&by_turn.tr_mul(&change.force))));
        }
        self.of.each_amplitude(|k, _| df[k] += self.mass.of_amplitude(k).dot(&change.force));
        let dmoment = change.dQ.tr_mul(force) + self.Q.tr_mul(&change.force) - dG * turning;
        self.of.add_turning(self.frame, &(self.frame.inverse * dmoment), df);
    }

    /// The change of m (a_c − g), with `weight` = m g along the axes of the frame.
    pub fn force_change(&self, at: &CenterMotion, change: &MotionChange, weight: &Vec3) -> ForceChange {
        let n = self.frame.z.len();
        let dmean = (0..n).map(|i| three(change.dw, 6 * i)).sum::<Vec3>() / n as f64;
        let (dxi, dQ) = self.shift(change.moved);
        let acceleration = CenterChange { center: self, at, change, dmean }.acceleration(&dxi, &dQ);
        ForceChange { force: self.mass.total * acceleration + change.moved.phi.cross(weight), dQ }
    }
}

/// How the motion of the centre changes in a small motion of the nodes.
struct CenterChange<'c> {
    center: &'c Center<'c>,
    at: &'c CenterMotion,
    change: &'c MotionChange<'c>,
    dmean: Vec3,
}

impl CenterChange<'_> {
    fn at_node(of: &[f64], i: usize) -> [Vec3; 2] {
        [three(of, 6 * i), three(of, 6 * i + 3)]
    }

    /// Of [`Center::velocity`].
    fn velocity(&self, dQ: &Mat3) -> Vec3 {
        let MotionChange { moved, w, dw, dspin, .. } = self.change;
        let of_node = |i: usize| {
            let ([_, omega], [dv, domega]) = (Self::at_node(w, i), Self::at_node(dw, i));
            [dv, self.center.dH(moved, i) * omega + self.center.frame.H[i] * domega]
        };
        dQ * self.at.spin + self.center.Q * dspin + self.center.sum(of_node, |k| dw[k])
    }

    /// Of [`Center::rates`].
    fn rates(&self, i: usize) -> (Vec3, Mat3, Mat3) {
        let MotionChange { moved, w, dw, dspin, .. } = self.change;
        let (frame, spin) = (self.center.frame, &self.at.spin);
        let ([_, omega], [dv, domega]) = (Self::at_node(w, i), Self::at_node(dw, i));
        let dz_rate = dv - self.dmean - dspin.cross(&frame.z[i]) - spin.cross(&self.center.du(moved, i));
        let dE = skew(&moved.relative(frame, i)[1]) * frame.E[i];
        let dE_rate = skew(&(domega - dspin)) * frame.E[i] + skew(&(omega - spin)) * dE;
        (dz_rate, dE_rate, half_trace_less(&dE_rate))
    }

    /// Of the rates of v_i and of H_i ω_i along axes that turn.
    fn accelerations(&self, i: usize) -> [Vec3; 2] {
        let MotionChange { moved, w, a, dw, da, dspin, .. } = self.change;
        let (center, spin) = (self.center, &self.at.spin);
        let ([v, omega], [dv, domega], [da, dalpha]) =
            (Self::at_node(w, i), Self::at_node(dw, i), Self::at_node(da, i));
        let H_rate = center.rates(w, i, [&self.at.mean, spin]).2;
        let alpha = three(a, 6 * i + 3) - spin.cross(&omega);
        let dalpha = dalpha - dspin.cross(&omega) - spin.cross(&domega);
        let turned = self.rates(i).2 * omega + H_rate * domega;
        [da - dspin.cross(&v) - spin.cross(&dv), turned + center.dH(moved, i) * alpha + center.frame.H[i] * dalpha]
    }

    /// Of the acceleration of the centre.
    fn acceleration(&self, dxi: &Vec3, dQ: &Mat3) -> Vec3 {
        let (center, at, MotionChange { da, dspin, dG, .. }) = (self.center, self.at, self.change);
        let (spin, dvelocity) = (&at.spin, self.velocity(dQ));
        let (mut dS_rate, mut dmoment) = (Mat3::zeros(), Vec3::zeros());
        for (i, Y) in center.of.Y.iter().enumerate() {
            let ([da, dalpha], (dz_rate, dE_rate, _)) = (self.accelerations(i), self.rates(i));
            dS_rate += dz_rate * Y.transpose() + center.of.turning * dE_rate;
            dmoment += 0.5 * Y.cross(&da) + center.of.turning * dalpha;
        }
        let dmoment = dmoment - half_trace_less(&dS_rate) * spin - at.G_rate * dspin - dG * at.spin_rate;
        let dspin_rate = center.frame.inverse * dmoment;
        let dxi_rate = dvelocity - self.dmean - dspin.cross(&center.xi) - spin.cross(dxi);
        let dQ_rate = center.lever(&dxi_rate, |i| self.rates(i).0, |i| self.rates(i).2);
        let own = center.sum(|i| self.accelerations(i), |k| da[k]);
        let turned = dQ_rate * spin + at.Q_rate * dspin + dQ * at.spin_rate + center.Q * dspin_rate;
        dspin.cross(&at.velocity) + spin.cross(&dvelocity) + own + turned
    }
}
