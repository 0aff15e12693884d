//! Ends of beams that release rotations, and forces that nodes share.

use crate::support::{read_deck, run_to_the_end};
use rdsolve::solve::Frame;

/// A beam of length 2 with E I = 1000 about both axes between two clamps, under a force of 0.01 at its middle along y and z. Its deflection, 2e-6
/// of its length, changes nothing by more than its square.
fn deflections(release: &str) -> [f64; 2] {
    let text = format!(
        "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[sections.s]\nshape = \"general\"\naxial_stiffness = 1e7\n\
         bending_stiffness = [1000.0, 1000.0]\ntorsional_stiffness = 1000.0\nshear_stiffness = [1e7, 1e7]\n[points]\na = [0.0, 0.0, 0.0]\n\
         m = [1.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\n[[beams]]\nname = \"beam\"\npath = [\"a\", \"m\", \"b\"]\nelements = 1\nshear = false\n\
         section = \"s\"\norientation = [0.0, 1.0, 0.0]\n{release}\n[[supports]]\nat = [\"a\", \"b\"]\nfix = \"all\"\n[[loads]]\nat = \"m\"\n\
         force = [0.0, 0.01, 0.01]\n"
    );
    let model = read_deck(&text);
    let middle = crate::support::node(&model, "m");
    let done = run_to_the_end(&model, &mut |frame: &Frame| {
        let moved = frame.state.nodes[middle].moved(&frame.model.nodes[middle].x);
        vec![moved.y, moved.z]
    });
    let last = done.rows.last().unwrap();
    [last[0], last[1]]
}

/// F l³/(192 E I) between clamps, F l³/(48 E I) between hinges, 7 F l³/(768 E I) with one of each. A shear stiffness of 1e11 adds 1e-8.
#[test]
fn beams_turn_about_released_axes() {
    let unit = 0.01 * 8.0 / 1000.0;
    let [clamped, hinged, one] = [1.0 / 192.0, 1.0 / 48.0, 7.0 / 768.0].map(|factor| factor * unit);
    for (release, [y, z]) in [
        ("", [clamped, clamped]),
        ("release = { start = [\"ry\"], end = \"ry\" }", [clamped, hinged]),
        ("release = { start = \"rz\", end = [\"rz\", \"rx\"] }", [hinged, clamped]),
        ("release = { start = [\"ry\", \"rz\"], end = [\"ry\", \"rz\"] }", [hinged, hinged]),
        ("release = { end = \"rotations\" }", [one, one]),
    ] {
        let found = deflections(release);
        assert!((found[0] / y - 1.0).abs() < 1e-6 && (found[1] / z - 1.0).abs() < 1e-6, "{release}: {found:?} {y} {z}");
    }
}

/// A square plate that cannot deform, on a foundation of 1000 per area under a force at its corner: it sinks by F/(k A) and tilts by the moment
/// F a/2 about both middle lines, k a⁴/12 each, so the corner sinks by F/(k A) (1 + 3 + 3). Integrals of shape functions are exact for it but for
/// what lumping adds: nodes at the border have their share at the border, a²/n² of the second moment.
#[test]
fn plates_lie_on_an_elastic_foundation() {
    for (order, lumped) in [(1, 1.0 + 2.0 / 64.0), (2, 1.0)] {
        let text = format!(
            "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[materials.m]\nmodel = \"elastic\"\nyoungs_modulus = 1e12\n\
             poisson_ratio = 0.3\n[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nc = [1.0, 1.0, 0.0]\nd = [0.0, 1.0, 0.0]\n\
             [[shells]]\nname = \"plate\"\ncorners = [\"a\", \"b\", \"c\", \"d\"]\nelements = 8\norder = {order}\nthickness = 0.5\nmaterial = \"m\"\n\
             foundation = [1.0, 1.0, 1000.0]\n[[loads]]\nat = \"c\"\nforce = [0.0, 0.0, -1e-3]\n"
        );
        let model = read_deck(&text);
        let [near, far] = ["c", "a"].map(|name| crate::support::node(&model, name));
        let sunk = |frame: &Frame, node: usize| -frame.state.nodes[node].moved(&frame.model.nodes[node].x).z;
        let done = run_to_the_end(&model, &mut |frame: &Frame| vec![sunk(frame, near), sunk(frame, far)]);
        let [corner, opposite] = done.rows.last().unwrap()[..] else { unreachable!() };
        // The trapezoidal rule of linear elements has 1 + 2/n² of the second moment; the rule of Simpson is exact.
        for (found, sides) in [(corner, 6.0), (opposite, -6.0)] {
            let expected = 1e-6 * (1.0 + sides / lumped);
            assert!((found / expected - 1.0).abs() < 1e-5, "order {order}: {found} for {expected}");
        }
    }
}

/// Each of four nodes has a quarter.
#[test]
fn nodes_share_a_total_force() {
    let points: String = (0..4).map(|k| format!("p{k} = [{k}.0, 0.0, 0.0]\n")).collect();
    let text = format!(
        "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[points]\n{points}[sets]\nall4 = [\"p0\", \"p1\", \"p2\", \"p3\"]\n\
         [[bars]]\nname = \"bar\"\npath = [\"p0\", \"p1\", \"p2\", \"p3\"]\naxial_stiffness = 1.0\n[[supports]]\nat = \"p0\"\n\
         fix = \"translations\"\n[[loads]]\nat = \"all4\"\ntotal_force = [8.0, 0.0, 0.0]\n"
    );
    let model = read_deck(&text);
    assert_eq!(model.loading.nodal.len(), 4);
    assert!(model.loading.nodal.iter().all(|load| load.force == rdsolve::math::Vec3::new(2.0, 0.0, 0.0)));
}

/// A cantilever of one element under a force and a moment at a third of its length: the deflection of its end is F a² (3l − a)/(6 E I) and
/// M a (2l − a)/(2 E I). Elements of third order hold the deflection under a force at their end, so by reciprocity that of the end is exact.
#[test]
fn forces_act_between_nodes() {
    let deflection = |load: &str, elements: usize| {
        let text = format!(
            "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[sections.s]\nshape = \"general\"\naxial_stiffness = 1e7\n\
             bending_stiffness = [1000.0, 1000.0]\ntorsional_stiffness = 1000.0\nshear_stiffness = [1e7, 1e7]\n[points]\na = [0.0, 0.0, 0.0]\n\
             b = [3.0, 0.0, 0.0]\n[[beams]]\nname = \"beam\"\npath = [\"a\", \"b\"]\nelements = {elements}\nshear = false\nsection = \"s\"\n\
             orientation = [0.0, 1.0, 0.0]\n[[supports]]\nat = \"a\"\nfix = \"all\"\n[[loads]]\npart = \"beam\"\ndistance = 1.0\n{load}\n"
        );
        let model = read_deck(&text);
        let end = crate::support::node(&model, "b");
        let done = run_to_the_end(&model, &mut |frame: &Frame| {
            vec![frame.state.nodes[end].moved(&frame.model.nodes[end].x).z]
        });
        done.rows.last().unwrap()[0]
    };
    for elements in [1, 2, 3] {
        let force = deflection("force = [0.0, 0.0, 0.001]", elements) / (0.001 * 8.0 / 6000.0);
        // A moment about −y lifts the end.
        let moment = deflection("moment = [0.0, -0.001, 0.0]", elements) / (0.001 * 5.0 / 2000.0);
        assert!((force - 1.0).abs() < 1e-6 && (moment - 1.0).abs() < 1e-6, "{elements}: {force} {moment}");
    }
}

/// A long beam on an elastic foundation under a force at its middle: F λ/(2 k) with λ⁴ = k/(4 E I) (M. Hetényi, Beams on Elastic Foundation,
/// 1946). Ends 15/λ away change it by e⁻¹⁵, and elements half as long as 1/λ hold its shape to 1e-6.
#[test]
fn beams_lie_on_an_elastic_foundation() {
    let text = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[sections.s]\nshape = \"general\"\naxial_stiffness = 1e7\n\
                bending_stiffness = [1000.0, 1000.0]\ntorsional_stiffness = 1000.0\nshear_stiffness = [1e7, 1e7]\n[points]\na = [-15.0, 0.0, 0.0]\n\
                m = [0.0, 0.0, 0.0]\nb = [15.0, 0.0, 0.0]\n[[beams]]\nname = \"rail\"\npath = [\"a\", \"m\", \"b\"]\nelements = 30\nshear = false\n\
                section = \"s\"\norientation = [0.0, 1.0, 0.0]\nfoundation = [1.0, 1.0, 4000.0]\n[[supports]]\nat = \"a\"\nfix = [\"rx\"]\n\
                [[loads]]\nat = \"m\"\nforce = [0.0, 0.0, -0.08]\n";
    let model = read_deck(text);
    let middle = crate::support::node(&model, "m");
    let done = run_to_the_end(&model, &mut |frame: &Frame| {
        vec![frame.state.nodes[middle].moved(&frame.model.nodes[middle].x).z]
    });
    let found = done.rows.last().unwrap()[0] / (-0.08 / 8000.0);
    assert!((found - 1.0).abs() < 1e-5, "{found}");
}
