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
        assert_eq!(found.warnings.len(), usize::from(analysis.contains('4')), "{analysis}: {:?}", found.warnings);
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

/// Many poses, of which some leave a rounding error that looks like stiffness.
fn many_poses() -> Vec<Mat3> {
    let mut rng = SmallRng::seed_from_u64(11);
    (0..40).map(|_| *UnitQuaternion::new_unchecked(turn(&mut rng)).to_rotation_matrix().matrix()).collect()
}

/// A beam on a hinge swings freely, which rounding may take for a stiffness of any size: what bends is found beside it in any pose.
#[test]
fn a_beam_that_swings_bends_the_same_in_any_pose() {
    let deck = |R: &Mat3, analysis: &str| {
        let row = |x: f64, y: f64, z: f64| {
            let v = R * Vec3::new(x, y, z);
            format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
        };
        format!(
            "analysis = {{ kind = \"modal\", {analysis} }}\npoints = {{ p = [0.0, 0.0, 0.0], q = {} }}\n\
             materials.m = {{ model = \"elastic\", youngs_modulus = 210e9, poisson_ratio = 0.3, density = 7850.0 }}\n\
             sections.s = {{ shape = \"rectangle\", width = 0.03, height = 0.02 }}\n\
             [[beams]]\nname = \"be\"\npath = [\"p\", \"q\"]\nelements = 2\nmaterial = \"m\"\nsection = \"s\"\norientation = {}\n\
             [[joints]]\nname = \"j\"\nkind = \"revolute\"\nfrom = {{ node = \"p\" }}\nto = {{ ground = [0.0, 0.0, 0.0] }}\naxis = {}\n",
            row(1.0, 0.0, 0.0),
            row(0.0, 1.0, 0.0),
            row(0.0, 1.0, 0.0)
        )
    };
    for analysis in ["modes = 10", "up_to = 500.0", "modes = 6, damped = true"] {
        let wanted = omegas(&modes(&deck(&Mat3::identity(), analysis)));
        assert!(wanted[0] == 0.0 && wanted[1] > 100.0 && wanted.len() > 5, "{analysis}: {wanted:?}");
        for R in many_poses() {
            let found = modes(&deck(&R, analysis));
            let omegas = omegas(&found);
            assert_eq!(omegas.len(), wanted.len(), "{analysis}: {omegas:?} {wanted:?}");
            assert!(omegas[0] < 1e-3 && off(&omegas[1..], &wanted[1..]) < 1e-6, "{analysis}: {omegas:?} {wanted:?}");
            assert_eq!(found.unstable, 0, "{analysis}");
        }
    }
}

/// A body that slides freely beside one on springs: seven modes, one of them zero, whatever is asked for and however the slide lies.
#[test]
fn a_free_slide_hides_nothing() {
    for R in many_poses() {
        let axis = R * Vec3::new(1.0, 0.0, 0.0);
        for analysis in ["modes = 4", "modes = 20", "modes = 4\ndamped = true", "modes = 20\ndamped = true"] {
            let text = format!(
                "[analysis]\nkind = \"modal\"\n{analysis}\n[[bodies]]\nname = \"a\"\ncenter = [-0.3, -0.2, 0.09]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n\
                 [[joints]]\nname = \"j\"\nkind = \"prismatic\"\nfrom = {{ ground = [-0.45, -0.12, -0.015] }}\nto = {{ body = \"a\", point = [-0.45, -0.12, -0.015] }}\n\
                 axis = [{:?}, {:?}, {:?}]\n[[bodies]]\nname = \"b\"\ncenter = [-1.06, 0.19, -0.43]\nmass = 2.0\ninertia = [1.0, 1.0, 1.0]\n\
                 [[links]]\nname = \"k\"\nfrom = {{ ground = [-1.06, 0.19, -0.43] }}\nto = {{ body = \"b\" }}\nbushing = [100.0, 100.0, 100.0, 50.0, 50.0, 50.0]\n",
                axis.x, axis.y, axis.z
            );
            let found = modes(&text);
            let omegas = omegas(&found);
            assert_eq!(omegas.len(), if analysis.contains("20") { 7 } else { 4 }, "{analysis}: {omegas:?}");
            let exact = 50f64.sqrt();
            assert!(omegas[0] < 1e-6 * exact && off(&omegas[1..], &vec![exact; omegas.len() - 1]) < 1e-6, "{omegas:?}");
            assert_eq!(found.unstable, 0, "{analysis}");
        }
    }
}

/// Motions without stiffness are roots at zero, each listed once beside what damps and vibrates: four of a slide and a ball, six of a bushing.
#[test]
fn damped_modes_list_every_free_motion() {
    for R in many_poses() {
        let axis = R * Vec3::new(1.0, 0.0, 0.0);
        for analysis in
            ["modes = 20", "up_to = 0.01", "up_to = 5.0", "modes = 20\ndamped = true", "modes = 6\ndamped = true"]
        {
            let text = format!(
                "[analysis]\nkind = \"modal\"\n{analysis}\n[[bodies]]\nname = \"a\"\ncenter = [-0.3, -0.2, 0.09]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n\
                 [[joints]]\nname = \"j\"\nkind = \"prismatic\"\nfrom = {{ ground = [-0.45, -0.12, -0.015] }}\nto = {{ body = \"a\", point = [-0.45, -0.12, -0.015] }}\n\
                 axis = [{:?}, {:?}, {:?}]\n[[bodies]]\nname = \"b\"\ncenter = [-1.06, 0.19, -0.43]\nmass = 2.0\ninertia = [1.0, 1.0, 1.0]\n\
                 [[bodies]]\nname = \"c\"\ncenter = [0.4, 0.3, 0.2]\nmass = 1.0\ninertia = [1.0, 2.0, 3.0]\n\
                 [[joints]]\nname = \"ball\"\nkind = \"spherical\"\nfrom = {{ ground = [0.4, 0.3, 0.0] }}\nto = {{ body = \"c\" }}\n\
                 [[links]]\nname = \"k\"\nfrom = {{ ground = [-1.06, 0.19, -0.43] }}\nto = {{ body = \"b\" }}\nbushing = [100.0, 110.0, 130.0, 50.0, 60.0, 70.0]\n\
                 bushing_damping = [0.1, 0.2, 0.3, 0.05, 0.06, 0.07]\n",
                axis.x, axis.y, axis.z
            );
            let omegas = omegas(&modes(&text));
            let zeros = omegas.iter().filter(|omega| **omega < 1e-5).count();
            let all = if analysis.contains("0.01") {
                4
            } else if analysis.contains("= 6") {
                6
            } else {
                10
            };
            assert_eq!((zeros, omegas.len()), (4, all), "{analysis}: {omegas:?}");
        }
    }
}
