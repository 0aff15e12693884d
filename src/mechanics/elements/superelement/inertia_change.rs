//! The tangent of inertia forces and weight, with all gyroscopic and centrifugal terms, column by column.

use super::center::{Center, CenterMotion, MotionChange};
use super::elastic::Moved;
use super::frame::{FloatingFrame, half_trace_less};
use super::{FloatingElement, FloatingWeights, MassProperties, add_three, multiply, set_three, three};
use base::math::{Mat3, Vec3, skew};

/// The motion about which the tangent is taken, along the axes of the frame. Vectors hold, in order: velocities, accelerations, momenta of
/// the rest of the mass, forces, and the changes of velocities, accelerations, momenta and forces.
pub struct InertiaChange<'a> {
    of: &'a FloatingElement,
    mass: &'a MassProperties,
    frame: &'a FloatingFrame,
    center: &'a Center<'a>,
    at: CenterMotion,
    spin: Vec3,
    /// Σ v × p + ω × p, divided by G.
    turning: Vec3,
    /// m (a_c − g).
    force: Vec3,
    /// m g.
    weight: Vec3,
}

impl<'a> InertiaChange<'a> {
    /// The motion with these velocities and accelerations, whose forces are written.
    pub fn new(
        (of, mass): (&'a FloatingElement, &'a MassProperties),
        (frame, center): (&'a FloatingFrame, &'a Center<'a>),
        weight: Vec3,
        [w, a, p, f, .., product]: &mut [Vec<f64>; 8],
    ) -> InertiaChange<'a> {
        let spin = of.turn(frame, w);
        let at = center.motion(w, a, spin);
        let force = mass.total * at.acceleration - weight;
        f.fill(0.0);
        let turning = of.add_rest(mass, frame, (w, a, spin), [p, product], f);
        center.add_force(&force, f);
        InertiaChange { of, mass, frame, center, at, spin, turning, force, weight }
    }

    /// The change of velocities and accelerations, and those of G and of the angular velocity of the frame.
    fn change_motion(
        &self,
        weights: &FloatingWeights,
        moved: &Moved,
        [w, a, dw, da]: [&mut Vec<f64>; 4],
    ) -> (Mat3, Vec3) {
        let (of, frame, phi) = (self.of, self.frame, moved.phi);
        let (mut dS, mut turned) = (Mat3::zeros(), Vec3::zeros());
        dw.fill(0.0);
        da.fill(0.0);
        for (i, Y) in of.Y.iter().enumerate() {
            let [d, theta] = moved.of(i);
            let ([v, omega], [acceleration, alpha]) = (at_node(w, i), at_node(a, i));
            let dv = weights.rate * d - phi.cross(&v);
            // ∂ω/∂θ = rate − ½ ω~ along the rotation vector of the step, and likewise for accelerations.
            let domega = weights.rate * theta - 0.5 * omega.cross(&theta) - phi.cross(&omega);
            set_three(dw, 6 * i, &dv);
            set_three(dw, 6 * i + 3, &domega);
            set_three(da, 6 * i, &(weights.acceleration * d - phi.cross(&acceleration)));
            let dalpha = weights.acceleration * theta - 0.5 * alpha.cross(&theta) - phi.cross(&alpha);
            set_three(da, 6 * i + 3, &dalpha);
            let [du, e] = moved.relative(frame, i);
            let dE = skew(&e) * frame.E[i];
            dS += du * Y.transpose() + of.turning * dE;
            turned += 0.5 * Y.cross(&dv) + of.turning * (half_trace_less(&dE) * omega + frame.H[i] * domega);
        }
        if moved.dof >= of.placed() {
            (dw[moved.dof], da[moved.dof]) = (weights.rate, weights.acceleration);
        }
        let dG = half_trace_less(&dS);
        (dG, frame.inverse * (turned - dG * self.spin))
    }

    /// Writes the change of the forces in a unit motion into the last vector.
    pub fn column(&self, weights: &FloatingWeights, moved: &Moved, vectors: &mut [Vec<f64>; 8]) {
        let [w, a, p, f, dw, da, dp, df] = vectors;
        let (of, frame, phi) = (self.of, self.frame, moved.phi);
        let (dG, dspin) = self.change_motion(weights, moved, [&mut *w, &mut *a, &mut *dw, &mut *da]);
        let change = MotionChange { moved, w, a, dw, da, dspin, dG };
        let of_center = self.center.force_change(&self.at, &change, &self.weight);
        self.change_rest((w, p, dspin), [dw, da, dp, df]);
        let mut dmoment = Vec3::zeros();
        for i in 0..of.data.interface {
            let ([v, omega], [p_x, p_t]) = (at_node(w, i), at_node(p, i));
            let ([dv, domega], [dp_x, dp_t]) = (at_node(dw, i), at_node(dp, i));
            dmoment += dv.cross(&p_x) + v.cross(&dp_x) + domega.cross(&p_t) + omega.cross(&dp_t);
        }
        of.add_turning(frame, &(frame.inverse * (dmoment - dG * self.turning)), df);
        self.center.add_change((moved, &dG), &self.force, &of_center, df);
        for i in 0..of.data.interface {
            let dH = half_trace_less(&(skew(&moved.relative(frame, i)[1]) * frame.E[i]));
            add_three(df, 6 * i + 3, &(of.turning * dH.tr_mul(&self.turning)));
            [6 * i, 6 * i + 3].iter().for_each(|&at| add_three(df, at, &phi.cross(&three(f, at))));
        }
        if weights.alpha > 0.0 {
            dw.fill(0.0);
            dw[moved.dof] = weights.alpha * weights.rate;
            of.momenta((self.mass, self.center), frame, dw, dp);
            df.iter_mut().zip(&*dp).for_each(|(df, p)| *df += p);
        }
    }

    /// Writes the change of ṗ − ω × p of the rest, and of p.
    fn change_rest(&self, (w, p, dspin): (&[f64], &[f64], Vec3), [dw, da, dp, df]: [&mut Vec<f64>; 4]) {
        let (of, spin) = (self.of, self.spin);
        // Accelerations along axes that turn.
        for i in 0..of.data.interface {
            for at in [6 * i, 6 * i + 3] {
                add_three(da, at, &-(dspin.cross(&three(w, at)) + spin.cross(&three(dw, at))));
            }
        }
        multiply(&self.mass.rest, da, df);
        multiply(&self.mass.rest, dw, dp);
        for i in 0..of.data.interface {
            let ([_, omega], [p_x, p_t]) = (at_node(w, i), at_node(p, i));
            let ([_, domega], [dp_x, dp_t]) = (at_node(dw, i), at_node(dp, i));
            add_three(df, 6 * i, &(dspin.cross(&p_x) + spin.cross(&dp_x)));
            let turned = dspin.cross(&p_t) + spin.cross(&dp_t) - domega.cross(&p_t) - omega.cross(&dp_t);
            add_three(df, 6 * i + 3, &turned);
        }
    }
}

/// The displacement and the rotation of a node, or their rates.
fn at_node(of: &[f64], i: usize) -> [Vec3; 2] {
    [three(of, 6 * i), three(of, 6 * i + 3)]
}
