//! Normals at the nodes of a mesh.

use rdsolve::math::Vec3;
use rdsolve::mesh::normals;

/// A strip of two quadrilaterals that meet at an angle.
fn folded(angle: f64, faces: [[u32; 4]; 2]) -> (Vec<[Vec3; 4]>, usize) {
    let (sin, cos) = angle.to_radians().sin_cos();
    let x = [
        Vec3::new(-1.0, 0.0, 0.0),
        Vec3::new(-1.0, 1.0, 0.0),
        Vec3::new(0.0, 0.0, 0.0),
        Vec3::new(0.0, 1.0, 0.0),
        Vec3::new(cos, 0.0, sin),
        Vec3::new(cos, 1.0, sin),
    ];
    normals(&x, faces.iter().map(|face| &face[..]))
}

#[test]
fn a_bend_is_shared_and_a_fold_is_not() {
    let faces = [[0, 2, 3, 1], [2, 4, 5, 3]];
    let (sin, cos) = 10f64.to_radians().sin_cos();
    let (n, against) = folded(20.0, faces);
    assert_eq!(against, 0);
    for corner in [n[0][1], n[0][2], n[1][0], n[1][3]] {
        assert!((corner - Vec3::new(-sin, 0.0, cos)).norm() < 1e-15, "{corner}");
    }
    assert!((n[0][0] - Vec3::z()).norm() < 1e-15);
    let (n, _) = folded(40.0, faces);
    assert!((n[0][1] - Vec3::z()).norm() < 1e-15);
    assert!((n[1][0] - Vec3::new(-(40f64.to_radians().sin()), 0.0, 40f64.to_radians().cos())).norm() < 1e-15);
}

#[test]
fn a_face_turned_round_keeps_its_own_sense() {
    let (straight, _) = folded(20.0, [[0, 2, 3, 1], [2, 4, 5, 3]]);
    let (n, against) = folded(20.0, [[0, 2, 3, 1], [3, 5, 4, 2]]);
    assert_eq!(against, 1);
    assert!((n[0][1] - straight[0][1]).norm() < 1e-15);
    assert!((n[1][3] + straight[1][0]).norm() < 1e-15);
}

/// Normals of a sphere cut into triangles in no regular way point outwards to first order in the size of the faces, squared.
#[test]
fn a_sphere_is_round() {
    let (mut x, mut faces) = (vec![-Vec3::z(), Vec3::z()], Vec::new());
    let (rings, round) = (16u32, 32u32);
    for i in 1..rings {
        for j in 0..round {
            let (a, b) = (f64::from(i) / f64::from(rings), f64::from(j) / f64::from(round));
            let (u, v) = (std::f64::consts::PI * (a - 0.5), std::f64::consts::TAU * b);
            x.push(Vec3::new(u.cos() * v.cos(), u.cos() * v.sin(), u.sin()));
        }
    }
    let at = |i: u32, j: u32| 2 + (i - 1) * round + j % round;
    for j in 0..round {
        faces.push(vec![0, at(1, j + 1), at(1, j)]);
        faces.push(vec![1, at(rings - 1, j), at(rings - 1, j + 1)]);
        for i in 1..rings - 1 {
            faces.push(vec![at(i, j), at(i, j + 1), at(i + 1, j + 1)]);
            faces.push(vec![at(i, j), at(i + 1, j + 1), at(i + 1, j)]);
        }
    }
    let (n, against) = normals::<4>(&x, faces.iter().map(Vec::as_slice));
    assert_eq!(against, 0);
    for (face, n) in faces.iter().zip(&n) {
        for (&node, n) in face.iter().zip(n) {
            // Faces span 0.2, and the bound is half of its square.
            assert!((n - x[node as usize]).norm() < 0.02, "{n} at {}", x[node as usize]);
        }
    }
}
