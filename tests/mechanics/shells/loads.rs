//! Loads spread over shells that keep their direction, what a deck can say of them, and scenes of one element.

use super::benchmarks::{kind_of, read};
use crate::support;
use rdsolve::math::Vec3;
use rdsolve::model::Model;

const HEAD: &str = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[materials.m]\nmodel = \"elastic\"\n\
                    youngs_modulus = 1e7\npoisson_ratio = 0.3\n";

fn square(n: usize, thickness: f64, kind: &str, rest: &str) -> Model {
    read(&format!(
        "{HEAD}[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nc = [1.0, 1.0, 0.0]\nd = [0.0, 1.0, 0.0]\n\
         [[shells]]\nname = \"plate\"\ncorners = [\"a\", \"b\", \"c\", \"d\"]\nelements = {n}\n{}\n\
         thickness = {thickness:?}\nmaterial = \"m\"\n{rest}",
        kind_of(kind)
    ))
}

/// Sum of the dead forces, and of their moments about the origin.
fn resultant(model: &Model) -> [Vec3; 2] {
    let force = model.loading.nodal.iter().map(|load| load.force).sum();
    [force, model.loading.nodal.iter().map(|load| model.nodes[load.node].x.cross(&load.force)).sum()]
}

/// Resultants of pressure, of force per area and per length, on a flat patch (exact) and on half a cylinder, where pressure is
/// that on the chords: p times the area between the edges, exactly too, since a closed polygon has no resultant.
#[test]
fn resultants_are_exact() {
    for kind in ["quadrilateral", "triangle", "quadrilateral2", "triangle2"] {
        let model =
            square(3, 0.1, kind, "[[loads]]\nat = \"plate\"\npressure = 2.0\nforce_per_area = [1.0, 0.0, 0.5]\n");
        let [f, m] = resultant(&model);
        let whole = Vec3::new(1.0, 0.0, -1.5);
        assert!((f - whole).norm() < 1e-15 && (m - Vec3::new(0.5, 0.5, 0.0).cross(&whole)).norm() < 1e-15, "{f} {m}");
        let model = square(
            3,
            0.1,
            kind,
            "[[loads]]\nat = [\"plate.edge2\", \"plate.edge3\"]\nforce_per_length = [0.0, 1.0, 2.0]\n",
        );
        let [f, m] = resultant(&model);
        let edge = Vec3::new(0.0, 1.0, 2.0);
        let about = Vec3::new(1.0, 0.5, 0.0) + Vec3::new(0.5, 1.0, 0.0);
        assert!((f - 2.0 * edge).norm() < 1e-15 && (m - about.cross(&edge)).norm() < 1e-15, "{f} {m}");
        let half = read(&format!(
            "{HEAD}[points]\na = [1.0, 0.0, 0.0]\nb = [0.0, 0.0, 1.0]\nc = [-1.0, 0.0, 0.0]\n\
             d = [1.0, 2.0, 0.0]\ne = [0.0, 2.0, 1.0]\nf = [-1.0, 2.0, 0.0]\n{}{}[[loads]]\nat = [\"right\", \"left\"]\npressure = 3.0\n",
            quarter("right", "\"a\", \"d\", \"e\", \"b\"", kind),
            quarter("left", "\"b\", \"e\", \"f\", \"c\"", kind)
        ));
        let [f, m] = resultant(&half);
        // Normals point in or out together: 2 by 2 of area between the edges, at the middle of the height.
        assert!((f.norm() - 12.0).abs() < 1e-13 && f.xy().norm() < 1e-13, "{f}");
        assert!((m - Vec3::new(0.0, 1.0, 0.0).cross(&f)).norm() < 1e-13, "{m}");
    }
}

fn quarter(name: &str, corners: &str, kind: &str) -> String {
    format!(
        "[[shells]]\nname = \"{name}\"\ncorners = [{corners}]\nelements = [2, 5]\n{}\nthickness = 0.1\nmaterial = \"m\"\n\
         surface = {{ kind = \"cylinder\", axis = [0.0, 1.0, 0.0] }}\n",
        kind_of(kind)
    )
}

/// A thin hinged plate under pressure: Navier's w = 0.00406235 p L⁴/D at the middle (Timoshenko & Woinowsky-Krieger, table 8),
/// by second order. Shear adds (h/L)² to the exact deflection, 1e-4 here.
#[test]
fn a_hinged_plate_under_pressure() {
    let rest = "[[supports]]\nat = [\"plate.edge1\", \"plate.edge2\", \"plate.edge3\", \"plate.edge4\"]\nfix = [\"uz\"]\n\
                [[supports]]\nat = [\"plate.edge1\", \"plate.edge3\"]\nfix = [\"ry\"]\n\
                [[supports]]\nat = [\"plate.edge2\", \"plate.edge4\"]\nfix = [\"rx\"]\n\
                [[supports]]\nat = \"a\"\nfix = [\"ux\", \"uy\"]\n[[supports]]\nat = \"b\"\nfix = [\"uy\"]\n\
                [[loads]]\nat = \"plate\"\npressure = 1e-4\n";
    let bending = 1e7 * 1e-6 / (12.0 * 0.91);
    let exact = -0.004_062_35 * 1e-4 / bending;
    for kind in ["quadrilateral", "triangle", "quadrilateral2", "triangle2"] {
        let error = |n: usize| {
            let model = square(n, 0.01, kind, rest);
            let middle =
                (0..model.nodes.len()).find(|&k| (model.nodes[k].x - Vec3::new(0.5, 0.5, 0.0)).norm() < 1e-9).unwrap();
            let done = support::run_to_the_end(&model, &mut |frame| vec![frame.state.nodes[middle].x.z]);
            done.rows.last().unwrap()[0] / exact - 1.0
        };
        let meshes = if kind.ends_with('2') { [2, 4, 8] } else { [4, 8, 16] };
        let errors = meshes.map(error);
        println!("{kind}: {errors:?}");
        assert!(errors[2].abs() < 0.01 && errors[2].abs() < 0.5 * errors[1].abs(), "{kind}: {errors:?}");
    }
}

/// One element of each kind, its pressure dead or following; a patch of three corners.
#[test]
fn one_element() {
    for kind in ["quadrilateral", "triangle", "quadrilateral2", "triangle2"] {
        for follower in [false, true] {
            let rest = format!(
                "[[supports]]\nat = \"plate.edge4\"\nfix = \"all\"\n[[loads]]\nat = \"plate\"\npressure = -1.0\nfollower = {follower}\n"
            );
            let model = square(1, 0.1, kind, &rest);
            assert_eq!(
                (model.loading.pressures.len(), model.loading.nodal.is_empty()),
                (usize::from(follower), follower)
            );
            let done = support::run_to_the_end(&model, &mut |frame| {
                let at = |label| frame.state.nodes[support::node(frame.model, label)].x;
                vec![at("b").z, at("c").z]
            });
            let end = done.rows.last().unwrap();
            // w = q L⁴/8 E I ≈ 1.5e-4; one element has it to a fifth.
            assert!(end.iter().all(|w| *w > 0.5e-4 && *w < 3e-4), "{kind}: {end:?}");
        }
    }
    let three = read(&format!(
        "{HEAD}[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nc = [0.0, 1.0, 0.0]\n\
         [[shells]]\nname = \"plate\"\ncorners = [\"a\", \"b\", \"c\"]\nelements = 1\nthickness = 0.1\nmaterial = \"m\"\n\
         [[supports]]\nat = \"plate.edge3\"\nfix = \"all\"\n[[loads]]\nat = \"plate\"\npressure = -1.0\nfollower = true\n"
    ));
    let done = support::run_to_the_end(&three, &mut |frame| vec![frame.state.nodes[1].x.z]);
    assert!(done.rows.last().unwrap()[0] > 1e-6);
}
