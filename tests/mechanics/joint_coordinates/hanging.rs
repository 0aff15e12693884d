//! Bodies that hang from joints in statics: nothing but the force of the joint keeps them from swinging, and it is not known as the first load
//! step begins.

use crate::support::run_source;
use rdsolve::diagnostic::Source;
use rdsolve::solve::{Failure, Frame, Outcome};

const STATIC: &str = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.25\n\
                      [environment]\ngravity = [0.0, 0.0, -10.0]\n[output]\njoints = true\n";

/// A body of 3 kg with a joint through a point on the z axis.
fn body(name: &str, [x, z]: [f64; 2], kind: &str, from: &str, at: f64) -> String {
    format!(
        "[[bodies]]\nname = \"{name}\"\ncenter = [{x:?}, 0.0, {z:?}]\nmass = 3.0\ninertia = [1.0, 2.0, 3.0]\n\
         [[joints]]\nname = \"joint of {name}\"\n{kind}\nfrom = {{ {from} }}\nto = {{ body = \"{name}\", point = [0.0, 0.0, {at:?}] }}\n"
    )
}

const GROUND: &str = "ground = [0.0, 0.0, 0.0]";
const HINGE: &str = "kind = \"revolute\"\naxis = [0.0, 1.0, 0.0]";
const BALL: &str = "kind = \"spherical\"";
const CROSS: &str = "kind = \"universal\"\naxis = [0.0, 1.0, 0.0]\ncross_axis = [1.0, 0.0, 0.0]";

#[test]
fn bodies_hang_one_from_the_other() {
    for kind in [HINGE, BALL, CROSS] {
        let text = STATIC.to_owned()
            + &body("upper", [0.0, -1.0], kind, GROUND, 0.0)
            + &body("lower", [0.0, -3.0], kind, "body = \"upper\", point = [0.0, 0.0, -2.0]", -2.0);
        let forces = &mut |frame: &Frame| frame.derived.joints.iter().map(|joint| joint.f.z).collect();
        let done = run_source(&Source::new("hanging.toml", &text, &[]), forces);
        assert!(matches!(done.outcome, Outcome::Done), "{kind}: {:?}", done.outcome);
        assert!(done.warnings.is_empty(), "{kind}: {:?}", done.warnings);
        let last = done.rows.last().expect("rows");
        // Two weights above, one below, to the tolerance of the iteration.
        assert!((last[0].abs() - 60.0).abs() < 1e-7 && (last[1].abs() - 30.0).abs() < 1e-7, "{kind}: {last:?}");
    }
}

/// A contact of faces elsewhere in the scene does not hinder it, whether it touches or not.
#[test]
fn bodies_hang_beside_contacts_of_faces() {
    for gap in [0.01, -1e-5] {
        let sheet = "[materials.steel]\nmodel = \"elastic\"\nyoungs_modulus = 2e11\npoisson_ratio = 0.3\ndensity = 7850.0\n\
                     [points]\np = [4.0, -1.0, 0.0]\nq = [6.0, -1.0, 0.0]\nr = [6.0, 1.0, 0.0]\ns = [4.0, 1.0, 0.0]\n\
                     [[shells]]\nname = \"sheet\"\ncorners = [\"p\", \"q\", \"r\", \"s\"]\nelements = 4\nthickness = 0.02\nmaterial = \"steel\"\n\
                     rigid = true\n[[supports]]\nat = \"sheet\"\nfix = \"all\"\n";
        let ball = format!(
            "[[bodies]]\nname = \"ball\"\ncenter = [5.1, 0.1, {:?}]\nshape = {{ kind = \"sphere\", radius = 0.1 }}\nmass = 1.0\n\
             [[supports]]\nat = \"ball\"\nfix = [\"ux\", \"uy\", \"rx\", \"ry\", \"rz\"]\n\
             [[links]]\nname = \"spring\"\nfrom = {{ ground = [5.1, 0.1, 3.0] }}\nto = {{ body = \"ball\" }}\nstiffness = 1e4\n\
             [[contacts]]\nname = \"on\"\nsurface = {{ part = \"sheet\" }}\nwith = \"ball\"\nstiffness = 1e6\n",
            0.11 + gap
        );
        let text = STATIC.to_owned() + sheet + &ball + &body("lamp", [0.0, -1.0], CROSS, GROUND, 0.0);
        let forces = &mut |frame: &Frame| frame.derived.joints.iter().map(|joint| joint.f.z).collect();
        let done = run_source(&Source::new("beside.toml", &text, &[]), forces);
        assert!(matches!(done.outcome, Outcome::Done), "{gap}: {:?}", done.outcome);
        // The tolerance of the iteration.
        assert!((done.rows.last().expect("rows")[0].abs() - 30.0).abs() < 1e-7, "{gap}: {:?}", done.rows.last());
    }
}

/// A boom that its drive lifts while a weight hangs from its tip, by a joint or by a rod.
#[test]
fn a_crane_lifts_what_hangs_from_it() {
    let crane = "[[stages]]\nname = \"weight\"\nkind = \"static\"\nduration = 1.0\ntime_step = 1.0\n\
                 [[stages]]\nname = \"lift\"\nkind = \"static\"\nduration = 1.0\ntime_step = 0.1\n\
                 [environment]\ngravity = [0.0, 0.0, -10.0]\n\
                 [output]\njoints = true\n[amplitudes.lifts]\nkind = \"ramp\"\nend = 1.0\nstage = \"lift\"\n\
                 [points]\ntip = [2.0, 0.0, 0.0]\n[[attachments]]\nbody = \"boom\"\nnodes = \"tip\"\n"
        .to_owned()
        + &body("boom", [1.0, 0.0], HINGE, GROUND, 0.0)
        + "motion = { position = -0.8, amplitude = \"lifts\" }\n\
           [[bodies]]\nname = \"load\"\ncenter = [2.0, 0.0, -1.5]\nmass = 30.0\ninertia = [1.0, 2.0, 3.0]\n";
    let hook = |kind: &str| {
        format!(
            "[[joints]]\nname = \"hook\"\n{kind}\nfrom = {{ node = \"tip\" }}\nto = {{ body = \"load\", point = [2.0, 0.0, 0.0] }}\n"
        )
    };
    let rod = "[[joints]]\nname = \"hook\"\nkind = \"distance\"\nfrom = { node = \"tip\" }\n\
               to = { body = \"load\", point = [2.0, 0.0, -1.0] }\n";
    for hook in [hook(HINGE), hook(BALL), rod.to_owned()] {
        let text = crane.clone() + &hook;
        let effort = &mut |frame: &Frame| vec![frame.derived.joints[0].drive];
        let done = run_source(&Source::new("crane.toml", &text, &[]), effort);
        assert!(matches!(done.outcome, Outcome::Done), "{hook}: {:?}", done.outcome);
        let exact = -(30.0 * 1.0 + 300.0 * 2.0) * 0.8f64.cos();
        let found = done.rows.last().expect("rows")[0];
        // To the tolerance of the iteration, 1e-8 of the moments.
        assert!((found / exact - 1.0).abs() < 1e-7, "{hook}: {found} {exact}");
    }
}

/// A light wind turns what hangs to the angle at which its moment and that of the weight balance, from the first load step on. To where a
/// gale would blow it no path of equilibria leads: the angle is the same under the least of both loads.
#[test]
fn what_hangs_swings_into_the_resultant() {
    let blown = |wind: f64| {
        let text = STATIC.to_owned()
            + &body("plate", [0.0, -1.0], HINGE, GROUND, 0.0)
            + "[points]\nrim = [0.0, 0.0, -2.0]\n[[attachments]]\nbody = \"plate\"\nnodes = \"rim\"\n"
            + &format!("[[loads]]\nat = \"rim\"\nforce = [{wind:?}, 0.0, 0.0]\n");
        let places = &mut |frame: &Frame| frame.state.nodes.iter().flat_map(|node| [node.x.x, node.x.z]).collect();
        run_source(&Source::new("wind.toml", &text, &[]), places)
    };
    for wind in [-0.3, 1e-3] {
        let done = blown(wind);
        assert!(matches!(done.outcome, Outcome::Done), "{wind}: {:?}", done.outcome);
        let (sine, cosine) = (2.0 * wind / 30.0).atan().sin_cos();
        let places = done.rows.last().expect("rows");
        // The iteration ends at 1e-8.
        let is_there = |x: f64, z: f64| places.chunks(2).any(|of| (of[0] - x).hypot(of[1] - z) < 1e-7);
        assert!(is_there(sine, -cosine) && is_there(2.0 * sine, -2.0 * cosine), "{places:?} {sine} {cosine}");
    }
    for wind in [10.0, -300.0] {
        let done = blown(wind);
        assert!(
            matches!(done.outcome, Outcome::Failed { failure: Failure::Singular { .. }, .. }),
            "{wind}: {:?}",
            done.outcome
        );
    }
}

#[test]
fn what_no_force_holds_is_refused() {
    let slider = "kind = \"prismatic\"\naxis = [1.0, 0.0, 0.0]";
    let lift = "kind = \"prismatic\"\naxis = [0.0, 0.0, 1.0]";
    let weightless = STATIC.replace("-10.0", "0.0");
    for (head, center, kind) in [
        (STATIC, [0.0, 0.0], HINGE),
        (STATIC, [0.0, -1.0], slider),
        (STATIC, [0.0, -1.0], lift),
        (&weightless, [0.0, -1.0], HINGE),
    ] {
        let text = head.to_owned() + &body("body", center, kind, GROUND, 0.0);
        let done = run_source(&Source::new("mechanism.toml", &text, &[]), &mut |_| Vec::new());
        let refused = matches!(&done.outcome, Outcome::Failed { failure: Failure::Singular { label, .. }, time } if label == "body" && *time == 0.0);
        assert!(refused, "{center:?} {kind}: {:?}", done.outcome);
    }
}

/// Masts side by side fall each by itself: two signs that a determinant does not show.
#[test]
fn what_stands_upright_is_refused() {
    for kind in [HINGE, BALL, CROSS] {
        for count in 1..=3 {
            let mast = |i: usize| body(&format!("mast{i}"), [0.0, 1.0], kind, GROUND, 0.0);
            let text = STATIC.to_owned() + &(0..count).map(mast).collect::<String>();
            let done = run_source(&Source::new("upright.toml", &text, &[]), &mut |_| Vec::new());
            let refused = matches!(&done.outcome, Outcome::Failed { failure: Failure::Singular { label, .. }, time } if label.starts_with("mast") && *time == 0.0);
            assert!(refused, "{count} {kind}: {:?}", done.outcome);
        }
    }
}
