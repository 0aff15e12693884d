//! The step that an element bears, and the mass that it is given for a longer one.

use rdsolve::math::{Mat3, Vec3};
use rdsolve::solve::inner::{ElementScaling, LumpedElement, NodalShare, NodeSpacing, scaling};

/// A bar of two nodes along x: κ = 4 E/ρ L².
#[test]
fn a_bar_is_given_the_square_of_the_ratio_of_steps() {
    let (stiffness, mass) = (3.0, 0.5);
    let mut K = [0.0; 36];
    for (i, j, k) in [(0, 0, 1.0), (3, 3, 1.0), (0, 3, -1.0), (3, 0, -1.0)] {
        K[6 * i + j] = k * stiffness;
    }
    let shares =
        [0, 1].map(|node| NodalShare { node, arm: Vec3::zeros(), mass: 0.5 * mass, J0: Mat3::zeros(), turns: true });
    let element = (&LumpedElement(shares.into()), &NodeSpacing { bending: Mat3::identity(), drilling: Mat3::zeros() });
    let fastest = 4.0 * stiffness / mass;
    assert_eq!(scaling(&K, element, 1.001 * fastest), ElementScaling::KEPT);
    let given = scaling(&K, element, fastest / 6.25);
    // Rounding.
    assert!((given.factor - 6.25).abs() < 1e-14 && given.gyration == Mat3::zeros(), "{given:?}");
}

/// An element that shears alone, γ = (w₂ − w₁)/L − ½ (θ₁ + θ₂): κ = k G A L gᵀ M⁻¹ g, with g = (2/L, −1) over the mass and the
/// inertia of the element.
#[test]
fn rotary_inertia_is_raised_before_mass() {
    let (stiffness, mass, length, radius) = (2.0, 0.5, 1.0_f64, 0.01_f64);
    // Translation along z, rotation about y: w′ + θ_y.
    let row = |node: usize| if node == 0 { (-1.0 / length, 0.5) } else { (1.0 / length, 0.5) };
    let mut strain = [0.0; 12];
    [0, 1].into_iter().for_each(|a| (strain[6 * a + 2], strain[6 * a + 4]) = row(a));
    let K: Vec<f64> = (0..144).map(|i| stiffness * length * strain[i / 12] * strain[i % 12]).collect();
    let J0 = 0.5 * mass * radius * radius * Mat3::identity();
    let shares = [0, 1].map(|node| NodalShare { node, arm: Vec3::zeros(), mass: 0.5 * mass, J0, turns: true });
    let element = LumpedElement(shares.into());
    let bending = length * length * Mat3::from_diagonal(&Vec3::new(0.0, 1.0, 1.0));
    let spacing = NodeSpacing { bending, drilling: Mat3::zeros() };
    let fastest = |r: f64| stiffness * length / mass * (4.0 / (length * length) + 1.0 / (r * r));
    let given = scaling(&K, (&element, &spacing), fastest(0.2));
    // What bisection leaves.
    let off = given.gyration[(1, 1)] - 0.04;
    assert!(given.factor == 1.0 && (0.0..0.125 / 65536.0).contains(&off), "{given:?}");
    // Beyond h/√8 mass is given too.
    let limit = fastest(0.125_f64.sqrt()) / 3.0;
    let given = scaling(&K, (&element, &spacing), limit);
    assert!((given.factor - 3.0).abs() < 1e-12 && given.gyration[(1, 1)] == 0.125, "{given:?}");
    let (mass, J0) = given.of(&element.0[0]);
    assert!((mass - 0.75).abs() < 1e-12 && (J0[(1, 1)] - 0.75 * 0.125).abs() < 1e-12);
    // About its own axis it turns as it did, but for the factor.
    assert!((J0[(0, 0)] - 3.0 * 0.25 * radius * radius).abs() < 1e-18);
}

/// Moments that are large enough stay, and so do the axes.
#[test]
fn tensors_keep_what_is_large() {
    let turn = nalgebra::Rotation3::from_euler_angles(0.3, -0.2, 0.9).into_inner();
    let tensor = |moments: [f64; 3]| turn * Mat3::from_diagonal(&Vec3::from(moments)) * turn.transpose();
    let half = &(0.5 * Mat3::identity());
    let raised = |J0: Mat3| {
        ElementScaling { factor: 1.0, gyration: *half }
            .of(&NodalShare { node: 0, arm: Vec3::zeros(), mass: 1.0, J0, turns: true })
            .1
    };
    let off = raised(tensor([3.0, 0.1, 0.0])) - tensor([3.0, 0.5, 0.0]);
    assert!(off.amax() < 1e-14, "{off}");
    assert_eq!(raised(tensor([3.0, 1.0, 0.7])), tensor([3.0, 1.0, 0.7]));
}
