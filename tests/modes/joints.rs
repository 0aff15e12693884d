//! Modes of bodies that joints hold.

use super::{modes, off, omegas};
use crate::support::random::turn;
use nalgebra::UnitQuaternion;
use rand::{SeedableRng, rngs::SmallRng};
use rdsolve::math::{Mat3, Vec3};

/// A lever on a hinge with a spring at its end: ω² = k L²/(I + m L²/4), one mode, however it is asked for. The equations of the hinge are
/// regularised by 1e-7, of which the second solution leaves the square.
#[test]
fn lever_on_a_hinge() {
    let text = |analysis: &str| {
        format!(
            "[analysis]\nkind = \"modal\"\n{analysis}\n[[bodies]]\nname = \"lever\"\ncenter = [0.5, 0.0, 0.0]\nmass = 2.0\n\
             inertia = [0.01, 0.2, 0.2]\n[[joints]]\nname = \"hinge\"\nkind = \"revolute\"\naxis = [0.0, 1.0, 0.0]\n\
             from = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ body = \"lever\" }}\n[[links]]\nname = \"spring\"\n\
             from = {{ ground = [1.0, 0.0, -0.5] }}\nto = {{ body = \"lever\", point = [1.0, 0.0, 0.0] }}\nstiffness = 1000.0\n"
        )
    };
    let exact = (1000.0f64 / 0.7).sqrt();
    for analysis in ["up_to = 50.0", "up_to = 6.1", "modes = 1", "modes = 4", "modes = 4\ndamped = true"] {
        let found = modes(&text(analysis));
        assert_eq!(found.list.len(), 1, "{analysis}: {:?}", omegas(&found));
        assert!(off(&omegas(&found), &[exact]) < 1e-9, "{analysis}: {:?} {exact}", omegas(&found));
        assert_eq!(found.doubts.len(), usize::from(analysis.contains('4')), "{analysis}: {:?}", found.doubts);
    }
    assert_eq!(modes(&text("up_to = 5.9")).list.len(), 0);
}

/// Two bodies of different inertia, the first on a bushing to the ground and the second on a joint and a bushing to the first, turned in space
/// and with stiffness in another unit of time; with loads for buckling.
fn turned(R: &Mat3, kind: &str, stiffness: f64, analysis: &str) -> String {
    let vector = |v: Vec3| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z);
    let row = |x: f64, y: f64, z: f64| vector(R * Vec3::new(x, y, z));
    let inertia = |x: f64, y: f64, z: f64| {
        let J = R * Mat3::from_diagonal(&Vec3::new(x, y, z)) * R.transpose();
        format!(
            "[{:?}, {:?}, {:?}, {:?}, {:?}, {:?}]",
            J[(0, 0)],
            J[(1, 1)],
            J[(2, 2)],
            J[(0, 1)],
            J[(1, 2)],
            J[(0, 2)]
        )
    };
    let axes = format!("[{}, {}]", row(1.0, 0.0, 0.0), row(0.0, 1.0, 0.0));
    let bushing = |k: [f64; 6]| format!("{:?}", k.map(|k| k * stiffness));
    let loads = match analysis.contains("buckling") {
        true => format!(
            "[[loads]]\nat = \"b0\"\nforce = {}\n[[loads]]\nat = \"b1\"\nforce = {}\n",
            row(17.0, 51.0, -137.0),
            row(62.0, -20.0, -92.0)
        ),
        false => String::new(),
    };
    let axis = |x, y, z| if kind == "fixed" { String::new() } else { format!("axis = {}\n", row(x, y, z)) };
    format!(
        "[analysis]\n{analysis}\n[[bodies]]\nname = \"b0\"\ncenter = {}\nmass = 1.9\ninertia = {}\n[[bodies]]\nname = \"b1\"\ncenter = {}\n\
         mass = 1.5\ninertia = {}\n[[links]]\nname = \"l\"\nfrom = {{ ground = {} }}\nto = {{ body = \"b0\", point = {} }}\nbushing = {}\naxes = {axes}\n\
         [[links]]\nname = \"m\"\nfrom = {{ body = \"b0\", point = {} }}\nto = {{ body = \"b1\", point = {} }}\nbushing = {}\naxes = {axes}\n\
         [[joints]]\nname = \"j\"\nkind = \"{kind}\"\n{}from = {{ body = \"b0\", point = {} }}\nto = {{ body = \"b1\", point = {} }}\n\
         {loads}",
        row(0.0, 0.0, 0.19),
        inertia(0.069, 0.068, 0.061),
        row(0.0, 0.05, 0.44),
        inertia(0.080, 0.073, 0.065),
        row(0.0, 0.0, 0.19),
        row(0.0, 0.0, 0.19),
        bushing([2630.0, 1960.0, 1020.0, 170.0, 375.0, 210.0]),
        row(0.0, 0.02, 0.31),
        row(0.0, 0.02, 0.31),
        bushing([4230.0, 2750.0, 3430.0, 370.0, 260.0, 480.0]),
        axis(0.1, 0.2, 0.97),
        row(0.0, 0.02, 0.31),
        row(0.0, 0.02, 0.31),
    )
}

/// Poses of a scene: as it is, turned by quarters, and at random.
fn poses() -> Vec<Mat3> {
    let mut rng = SmallRng::seed_from_u64(7);
    let mut all = vec![Mat3::identity()];
    all.extend((0..10).map(|_| *UnitQuaternion::new_unchecked(turn(&mut rng)).to_rotation_matrix().matrix()));
    all
}

/// A scene of few bodies has fewer modes than the search tries at once. All are found, damped or not, whatever the pose and the unit of time, and no
/// more: what joints forbid is none, nor are motions at infinity. The tolerance is that of the double roots of complex modes.
#[test]
fn modes_on_joints_do_not_depend_on_pose_and_unit() {
    for (kind, count) in [("prismatic", 7), ("revolute", 7), ("fixed", 6)] {
        let wanted = omegas(&modes(&turned(&Mat3::identity(), kind, 1.0, "kind = \"modal\"\nmodes = 40")));
        assert_eq!(wanted.len(), count, "{kind}: {wanted:?}");
        assert!(wanted[0] > 1.0, "{kind}: {wanted:?}");
        for R in poses() {
            for stiffness in [1.0, 1e-6, 1e6] {
                for analysis in ["modes = 40", "modes = 5", "modes = 40\ndamped = true", "modes = 5\ndamped = true"] {
                    let found = modes(&turned(&R, kind, stiffness, &format!("kind = \"modal\"\n{analysis}")));
                    let scaled: Vec<f64> = omegas(&found).iter().map(|omega| omega / stiffness.sqrt()).collect();
                    let asked = if analysis.contains("40") { count } else { 5 };
                    assert_eq!(scaled.len(), asked, "{kind} {stiffness} {analysis}: {scaled:?} {wanted:?}");
                    assert!(
                        off(&scaled, &wanted[..asked]) < 1e-6,
                        "{kind} {stiffness} {analysis}: {scaled:?} {wanted:?}"
                    );
                    assert_eq!(found.unstable, 0, "{kind} {stiffness} {analysis}");
                }
            }
        }
    }
}

/// The factors of loads do not depend on the pose either; differences of stiffness leave 1e-6 of them.
#[test]
fn factors_on_joints_do_not_depend_on_the_pose() {
    for kind in ["prismatic", "revolute", "fixed"] {
        let factors = |R: &Mat3| -> Vec<f64> {
            let found = modes(&turned(R, kind, 1.0, "kind = \"buckling\"\nmodes = 2"));
            found.list.iter().filter_map(|mode| mode.factor).collect()
        };
        let wanted = factors(&Mat3::identity());
        for R in poses() {
            let found = factors(&R);
            assert!(off(&found, &wanted) < 1e-6, "{kind}: {found:?} {wanted:?}");
        }
    }
}
