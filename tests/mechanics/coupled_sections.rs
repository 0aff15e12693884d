//! Beams whose section has a full matrix: a cantilever by hand, and the numbers of sections without coupling.

use crate::support::{node, read_deck, run_to_the_end};
use rdsolve::math::{Mat6, Vec6};

/// A composite box of a blade: bending about y couples with twist, tension with bending, shear with twist.
const ROWS: [[f64; 6]; 6] = [
    [1.5e7, 0.0, 1e5, 2e4, 3e4, -1e4],
    [0.0, 2e6, 0.0, 1e4, 0.0, 2e3],
    [1e5, 0.0, 1.5e6, -5e3, 1e4, 0.0],
    [2e4, 1e4, -5e3, 3e4, 9e3, 1e3],
    [3e4, 0.0, 1e4, 9e3, 6e4, 2e3],
    [-1e4, 2e3, 0.0, 1e3, 2e3, 1.2e5],
];

fn section(rows: &[[f64; 6]; 6]) -> String {
    format!("stiffness = {rows:?}")
}

/// Position and rotation vector of the tip of a cantilever of 2 m along x, over the load that is small.
fn tip(section: &str, order: usize, elements: usize, load: [f64; 6]) -> Vec6 {
    let small = 1e-6;
    let [force, moment] = [&load[..3], &load[3..]].map(|of| of.iter().map(|f| small * f).collect::<Vec<f64>>());
    let model = read_deck(&format!(
        "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[iteration]\ntolerance = 1e-12\n[sections.blade]\nshape = \"general\"\n{section}\n\
         [points]\na = [0.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\n[[beams]]\nname = \"blade\"\npath = [\"a\", \"b\"]\nelements = {elements}\norder = {order}\n\
         section = \"blade\"\norientation = [0.0, 1.0, 0.0]\n[[supports]]\nat = \"a\"\nfix = \"all\"\n[[loads]]\nat = \"b\"\nforce = {force:?}\n\
         moment = {moment:?}\n"
    ));
    let at = node(&model, "b");
    let row = |frame: &rdsolve::solve::Frame| {
        let node = &frame.state.nodes[at];
        let (u, turn) = (node.x - nalgebra::Vector3::new(2.0, 0.0, 0.0), 2.0 * node.rotation.imag());
        u.iter().chain(turn.iter()).map(|value| value / small).collect()
    };
    let rows = run_to_the_end(&model, &mut { row }).rows;
    Vec6::from_column_slice(rows.last().expect("rows"))
}

/// Strains are S times the forces at each place, and displacements their integrals: u′ = γ + θ × e₁, θ′ = κ.
fn by_hand(rows: &[[f64; 6]; 6], load: [f64; 6]) -> Vec6 {
    let length = 2.0;
    let S = Mat6::from_row_slice(rows.as_flattened()).try_inverse().expect("a stiffness");
    let [nx, ny, nz, mx, my, mz] = load;
    // Gauss points integrate the cubic polynomials of this beam exactly.
    let (points, weights) = rdsolve::math::quadrature::gauss(4);
    let mut sum = Vec6::zeros();
    for (point, weight) in points.iter().zip(weights) {
        let (s, w) = (0.5 * length * (1.0 + point), 0.5 * length * weight);
        let arm = length - s;
        let strain = S * Vec6::new(nx, ny, nz, mx, my - arm * nz, mz + arm * ny);
        let kappa = [strain[3], strain[4], strain[5]];
        // The tip moves by the curvature here times its distance.
        sum += w * Vec6::new(
            strain[0],
            strain[1] + arm * kappa[2],
            strain[2] - arm * kappa[1],
            kappa[0],
            kappa[1],
            kappa[2],
        );
    }
    sum
}

#[test]
fn a_coupled_cantilever_bends_and_twists_as_by_hand() {
    for load in [[0.0, 0.0, 1.0, 0.0, 0.0, 0.0], [0.3, -0.7, 0.4, 0.2, -0.5, 0.6], [0.0, 0.0, 0.0, 1.0, 0.0, 0.0]] {
        let exact = by_hand(&ROWS, load);
        for (order, elements) in [(1, 1), (1, 4), (2, 2), (3, 1)] {
            let found = tip(&section(&ROWS), order, elements, load);
            let off = (found - exact).amax() / exact.amax();
            println!("order {order}, {elements}: {off:.1e}");
            // Displacements of 1e-6 are linear to as many digits; elements of order 1 have the whole flexibility of bending.
            assert!(off < 1e-5, "order {order}, {elements}: {found} {exact}");
        }
    }
}

/// A matrix without coupling is the section of the four stiffnesses to the last bit.
#[test]
fn a_diagonal_matrix_is_the_section_of_its_stiffnesses() {
    let diagonal = [1.5e7, 2e6, 1.5e6, 3e4, 6e4, 1.2e5];
    let rows: [[f64; 6]; 6] = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { diagonal[i] } else { 0.0 }));
    let [axial, y, z, torsion, by, bz] = diagonal;
    let named = format!(
        "axial_stiffness = {axial:?}\nshear_stiffness = [{y:?}, {z:?}]\ntorsional_stiffness = {torsion:?}\nbending_stiffness = [{by:?}, {bz:?}]"
    );
    let load = [0.3, -0.7, 0.4, 0.2, -0.5, 0.6];
    for order in [1, 3] {
        assert_eq!(tip(&section(&rows), order, 2, load), tip(&named, order, 2, load));
    }
}
