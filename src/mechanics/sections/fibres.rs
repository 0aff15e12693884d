//! Sections as fibres, for materials that yield.
//!
//! Fibres lie in pairs of Gauss points, side by side: areas and moments are exact, as is the plastic moment wherever the neutral axis falls
//! between pairs. The table gives the worst error of M(κ) on a rectangle of n layers, up to 20 times the curvature of first yield, in % of
//! the greatest moment. The material is ideally plastic; numbers in brackets are with the axial force 0.3 N_p. Hardening of 0.7 % of E
//! changes the numbers by at most 0.8. The last column is the error of the bending stiffness, in %.
//!
//! | n | 6 | 8 | 12 | 16 | EI |
//! |---|---|---|---|---|---|
//! | Gauss pairs | 2.9 (2.2) | 1.3 (0.9) | 0.6 (0.4) | 0.3 (0.3) | 0 |
//! | midpoints | 1.9 (2.0) | 1.1 (1.1) | 0.5 (0.5) | 0.3 (0.3) | −1/n² |
//! | Gauss triples | 3.3 (2.1) | | 0.8 (0.6) | | 0 |
//! | Gauss, a rule for each half | 3.3 (2.1) | 1.7 (1.8) | 0.9 (0.5) | 0.5 (0.3) | 0 |
//! | Gauss | 3.9 (3.6) | 2.3 (1.3) | 1.0 (0.5) | 0.6 (0.5) | 0 |
//! | Lobatto | 5.6 (5.6) | 2.9 (2.2) | 1.3 (0.7) | 0.7 (0.6) | 0 |
//! | least error, [`base::math::quadrature::kinked`] | 1.9 (1.4) | 1.0 (0.6) | 0.47 (0.3) | | 0 |
//!
//! Pairs are as good as midpoints, which have an elastic error, and better than any longer rule: at a kink in the stress only the longest
//! gap matters, not the degree. Rectangles have the places of least error up to twelve rows, and pairs beyond.
//!
//! Shear always has the shape of the elastic solution, scaled by Γ₂, Γ₃ and κ₁. So the elastic section is exact, and yielding does not
//! redistribute shear. The capacities Σ A |s| τ_Y, relative to the limits of plasticity, are:
//! - rectangle: shear force √(5k/6), 5/6 at a shear factor k of 5/6; torque 1.05 (square) to 1.01 (10:1);
//! - tube: torque exact, shear force exact if thin;
//! - cell: torque exact at equal thickness, else above 2 A_m t_min τ_Y;
//! - I: shear force about 1.15 of the web's, with the share of its flanges.
//!
//! A uniform mode would give the rectangle 0.91, but yields at the edges, where shear is zero. Under bending and up to 0.7 of A τ_Y the
//! parabola is nearer to Drucker's M/M_p = 1 − (Q/A τ_Y)⁴ (1956, J. Appl. Mech. 23, 509-514).

use super::section::Section;
use base::math::{Mat3, Vec3};

/// A part of a section with one stress.
///
/// Its strains are ε = Γ₁ + z κ₂ − y κ₃ and γ_a = shear[a]·(Γ₂, Γ₃, κ₁). The stress resultants with the same work as σ and τ_a are N = Σ A
/// σ, M_y = Σ A z σ, M_z = −Σ A y σ and (Q_y, Q_z, T) = Σ A Σ_a τ_a shear[a].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fibre {
    /// Area.
    pub area: f64,
    /// Coordinate y from the centroid.
    pub y: f64,
    /// Coordinate z from the centroid.
    pub z: f64,
    /// Shear modes; in a full shape along y and z, in a thin wall along the wall and none.
    pub shear: [[f64; 3]; 2],
}

/// The fibres with their areas scaled to the sum `area`.
pub fn with_area(area: f64, mut fibres: Vec<Fibre>) -> Vec<Fibre> {
    let scale = area / fibres.iter().map(|fibre| fibre.area).sum::<f64>();
    fibres.iter_mut().for_each(|fibre| fibre.area *= scale);
    fibres
}

/// Fibres with modes for shear and twist about the shear centre → about the centroid, with exactly the section's stiffness.
///
/// Their sum C′ = Σ A s sᵀ differs from C by the quadrature error, and by the corners, different for middle lines of walls and for plates.
/// L L′⁻¹ s, with C = L Lᵀ and C′ = L′ L′ᵀ, is the nearby set that does not. Nothing is returned where the modes depend on each other.
pub fn calibrated(mut fibres: Vec<Fibre>, section: &Section) -> Option<Vec<Fibre>> {
    let Section { torsion, shear: [yy, zz, yz], shear_center: [ys, zs], .. } = *section;
    let C = Mat3::new(yy, yz, 0.0, yz, zz, 0.0, 0.0, 0.0, torsion);
    // The strain of the shear centre is Γ + κ×r_s: (Γ₂ − z_s κ₁, Γ₃ + y_s κ₁).
    let to_centroid = Mat3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, -zs, ys, 1.0);
    let L = to_centroid * C.cholesky()?.l() * shear_stiffness(&fibres).cholesky()?.l().try_inverse()?;
    for fibre in &mut fibres {
        fibre.shear = fibre.shear.map(|s| (L * Vec3::from(s)).into());
    }
    Some(fibres)
}

/// Σ A s sᵀ: what (Q_y, Q_z, T)/G answers to (Γ₂, Γ₃, κ₁).
fn shear_stiffness(fibres: &[Fibre]) -> Mat3 {
    let modes = fibres.iter().flat_map(|fibre| fibre.shear.map(|s| (fibre.area, Vec3::from(s))));
    modes.map(|(area, s)| area * s * s.transpose()).sum()
}

/// The fibres by their height: in the plane of x and z (`along_z`) or of x and y.
fn layers(fibres: &[Fibre], along_z: bool) -> Vec<Vec<Fibre>> {
    let height = |f: &Fibre| if along_z { f.z } else { f.y };
    let mut sorted = fibres.to_vec();
    sorted.sort_by(|a, b| height(a).total_cmp(&height(b)));
    let size = fibres.iter().map(|f| height(f).abs()).fold(0.0, f64::max);
    sorted.chunk_by(|a, b| height(b) - height(a) <= 1e-12 * size).map(<[Fibre]>::to_vec).collect()
}

/// True where no stress over the height, elastic or not, has a moment out of the plane of x and z (`along_z`) or of x and y.
pub fn balance(fibres: &[Fibre], along_z: bool) -> bool {
    let out = |f: &Fibre| if along_z { f.y } else { f.z };
    let reach = fibres.iter().map(|f| out(f).abs()).fold(0.0, f64::max);
    layers(fibres, along_z).iter().all(|layer| {
        let moment: f64 = layer.iter().map(|f| f.area * out(f)).sum();
        // Sums of some hundred products round to less.
        moment.abs() <= 1e-12 * reach * layer.iter().map(|f| f.area.abs()).sum::<f64>()
    })
}

/// The fibres for motion in the plane of x and z (`along_z`) or of x and y: those at one height in the plane become one.
///
/// Areas add, and so does the energy of in-plane shear (its mode is the root of the mean square). Coordinates and modes out of the plane
/// are dropped. Bending and shear in the plane keep their stiffness, bending also its plastic answer.
pub fn flattened(fibres: &[Fibre], along_z: bool) -> Vec<Fibre> {
    let height = |f: &Fibre| if along_z { f.z } else { f.y };
    let mode = usize::from(along_z);
    layers(fibres, along_z)
        .iter()
        .map(|layer| {
            let mean = |of: &dyn Fn(&Fibre) -> f64| {
                let area: f64 = layer.iter().map(|f| f.area).sum();
                layer.iter().map(|f| f.area * of(f)).sum::<f64>() / area
            };
            let at = mean(&height);
            let mut s = [0.0; 3];
            s[mode] = mean(&|f| f.shear[0][mode].powi(2) + f.shear[1][mode].powi(2)).sqrt();
            let (y, z) = if along_z { (0.0, at) } else { (at, 0.0) };
            Fibre { area: layer.iter().map(|f| f.area).sum(), y, z, shear: [s, [0.0; 3]] }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sections::SectionShape;
    use crate::sections::c::C;
    use crate::sections::general::General;
    use crate::sections::hollow_box::HollowBox;
    use crate::sections::i::I;
    use crate::sections::l::L;
    use crate::sections::rectangle::Rectangle;
    use crate::sections::rectangle::rectangle;
    use crate::sections::tests::close;
    use crate::sections::tube::Tube;
    use crate::sections::tube::tube;
    use rand::{RngExt, SeedableRng, rngs::SmallRng};
    use std::f64::consts::PI;

    /// Poisson's ratio where a test does not say its own.
    const NU: f64 = 0.3;

    fn lay(shape: &dyn SectionShape, counts: &[usize]) -> Result<Vec<Fibre>, String> {
        shape.fibres(counts, &shape.section(NU)?)
    }

    fn random_shapes() -> Vec<Box<dyn SectionShape>> {
        let mut random = SmallRng::seed_from_u64(5);
        let mut shapes = Vec::new();
        for _ in 0..20 {
            let mut r = |low: f64, high: f64| random.random_range(low..high);
            let (h, w) = (r(0.05, 0.5), r(0.05, 0.5));
            let (t, u, v) = (r(1e-3, 0.012), r(1e-3, 0.012), r(1e-3, 0.012));
            let more: [Box<dyn SectionShape>; 8] = [
                Box::new(Rectangle { width: w, height: h }),
                Box::new(Tube { radius: w, thickness: t }),
                Box::new(Tube { radius: w, thickness: w * r(0.5, 1.0) }),
                Box::new(Tube { radius: w, thickness: w }),
                Box::new(HollowBox { width: w, height: h, web: t, flange: u }),
                Box::new(I {
                    height: h,
                    top_width: w,
                    bottom_width: r(0.05, 0.5),
                    web: t,
                    top_flange: u,
                    bottom_flange: v,
                }),
                Box::new(C { height: h, width: w, web: t, flange: u }),
                Box::new(L { height: h, width: w, vertical: t, horizontal: u }),
            ];
            shapes.extend(more);
        }
        shapes
    }

    fn sum(fibres: &[Fibre], of: impl Fn(&Fibre) -> f64) -> f64 {
        fibres.iter().map(|f| f.area * of(f)).sum()
    }

    /// Moment about y of a curvature κ₂ at N = `axial`, with E = yield strain = 1.
    fn moment(fibres: &[Fibre], kappa: f64, axial: f64) -> f64 {
        let stress = |f: &Fibre, strain: f64| (strain + kappa * f.z).clamp(-1.0, 1.0);
        let edge = 1.0 + fibres.iter().map(|f| (kappa * f.z).abs()).fold(0.0, f64::max);
        let (mut low, mut high) = (-edge, edge);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let half = if sum(fibres, |f| stress(f, middle)) < axial { &mut low } else { &mut high };
            *half = middle;
        }
        sum(fibres, |f| f.z * stress(f, low))
    }

    /// Plastic force of a strain (Γ₂, Γ₃, κ₁) at τ_Y = 1: Σ A |s|.
    fn capacity(fibres: &[Fibre], strain: [f64; 3]) -> f64 {
        sum(fibres, |f| {
            f.shear.map(|s| Vec3::from(s).dot(&Vec3::from(strain))).iter().map(|g| g * g).sum::<f64>().sqrt()
        })
    }

    /// All the section knows comes back from its fibres, at any counts. Bounds are round-off: 1e-13 of the area times lengths, more where
    /// the shear centre lies far out and its arm dominates the stiffness.
    #[test]
    fn the_elastic_section_is_exact() {
        for shape in random_shapes() {
            let section = shape.section(NU).unwrap();
            for counts in [&[][..], &[4, 2], &[10, 4]] {
                let fibres = lay(&*shape, counts).unwrap();
                let (A, I) = (section.area, section.Iy + section.Iz);
                close(sum(&fibres, |_| 1.0), A, 1e-13);
                close(sum(&fibres, |f| f.z * f.z), section.Iy, 1e-13);
                close(sum(&fibres, |f| f.y * f.y), section.Iz, 1e-13);
                assert!((sum(&fibres, |f| f.y * f.z) - section.Iyz).abs() < 1e-14 * I, "{shape:?}");
                for first in [sum(&fibres, |f| f.y), sum(&fibres, |f| f.z)] {
                    assert!(first.abs() < 1e-14 * (A * I).sqrt(), "{shape:?}: {first}");
                }
                let elastic = section.stiffness(2.0, 0.0, 0.0); // G = 1
                let (Q, T) = (elastic.NM.column(0), elastic.M[(0, 0)]);
                let [yy, zz, yz] = section.shear;
                let exact = Mat3::new(yy, yz, Q[1], yz, zz, Q[2], Q[1], Q[2], T);
                let C = shear_stiffness(&fibres);
                for (i, j) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
                    let scale = (exact[(i, i)] * exact[(j, j)]).sqrt();
                    assert!((C - exact)[(i, j)].abs() < 1e-12 * scale, "{shape:?} {counts:?}: {C} for {exact}");
                }
            }
        }
    }

    /// The modes hardly need their calibration: energy of shear and twist about the shear centre as it comes.
    /// Full shapes miss by the fourth moment of the rule; walls by their corners, of the order of thickness over length.
    #[test]
    fn modes_are_nearly_right_by_themselves() {
        let of_fibres = |n| shear_stiffness(&super::super::rectangle::rectangle_fibres(0.1, 0.2, [n, n]));
        let exact = rectangle(0.1, 0.2, 0.0).unwrap();
        close(of_fibres(12)[(0, 0)], exact.shear[0], 2e-3);
        close(of_fibres(12)[(2, 2)], exact.torsion, 3e-3);
        // Cowper's factor is the energy of the closed form; Gauss pairs meet it with their fourth order.
        for (inner, bound) in [(0.0, 1e-3), (0.05, 1e-3), (0.098, 1e-6)] {
            let shear = tube(0.1, 0.1 - inner, 0.0).unwrap().shear[0];
            let tube = super::super::tube::tube_fibres(0.1, inner, shear, [20, 6]);
            close(shear_stiffness(&tube)[(0, 0)], shear, bound);
        }
        let (top_width, top_flange) = (0.1, 0.0085);
        let i = I { height: 0.2, top_width, bottom_width: 0.1, web: 0.0056, top_flange, bottom_flange: 0.0085 };
        let section = i.section(0.0).unwrap();
        let C = shear_stiffness(&i.lay_fibres([8, 4], &section).unwrap());
        close(C[(0, 0)], section.shear[0], 0.01);
        close(C[(1, 1)], section.shear[1], 0.05);
        close(C[(2, 2)], section.torsion, 0.05);
    }

    /// Plastic moments about y by hand, with the accuracy at default counts; round-off where pairs meet the neutral axis.
    #[test]
    fn plastic_moments() {
        let (t, u): (f64, f64) = (0.006, 0.008);
        let plates = |b: f64, h: f64, webs: f64| b * u * (h - u) + webs * (0.5 * h - u).powi(2);
        let shapes: [(Box<dyn SectionShape>, f64, f64); 5] = [
            (Box::new(Rectangle { width: 0.1, height: 0.2 }), 0.1 * 0.2 * 0.2 / 4.0, 1e-12),
            (Box::new(HollowBox { width: 0.1, height: 0.2, web: t, flange: u }), plates(0.1, 0.2, 2.0 * t), 1e-3),
            (
                Box::new(I { height: 0.2, top_width: 0.1, bottom_width: 0.1, web: t, top_flange: u, bottom_flange: u }),
                plates(0.1, 0.2, t),
                1e-12,
            ),
            (Box::new(Tube { radius: 0.1, thickness: 0.002 }), 4.0 / 3.0 * (1e-3 - 0.098f64.powi(3)), 5e-3),
            (Box::new(Tube { radius: 0.1, thickness: 0.1 }), 4.0 / 3.0 * 1e-3, 5e-3),
        ];
        for (shape, exact, bound) in shapes {
            let fibres = lay(&*shape, &[]).unwrap();
            close(moment(&fibres, 1e6, 0.0), exact, bound);
        }
    }

    /// Torque: 2π/3 (R³ − r³) for any tube; 2 A_m t for a cell of equal walls, to t/b squared. The sand heap of a full rectangle, b² (3h −
    /// b)/6, lies below the torque of the elastic warping. Shear: all of a thin tube's walls (to the 20 fibres around), 5/6 of the
    /// rectangle.
    #[test]
    fn plastic_shear_and_torque() {
        let twist = [0.0, 0.0, 1.0];
        for thickness in [0.002, 0.04, 0.1] {
            let tube = lay(&Tube { radius: 0.1, thickness }, &[]).unwrap();
            close(capacity(&tube, twist), 2.0 * PI / 3.0 * (1e-3 - (0.1 - thickness).powi(3)), 1e-12);
        }
        let tube = Tube { radius: 0.1, thickness: 1e-4 };
        let area = tube.section(NU).unwrap().area;
        close(capacity(&lay(&tube, &[]).unwrap(), [0.0, 1.0, 0.0]), 2.0 / PI * area, 5e-3);
        let t = 0.002;
        let cell = lay(&HollowBox { width: 0.1, height: 0.2, web: t, flange: t }, &[]).unwrap();
        close(capacity(&cell, twist), 2.0 * (0.1 - t) * (0.2 - t) * t, 1e-3);
        for (height, above) in [(0.1, 0.047), (0.2, 0.043), (1.0, 0.010)] {
            let rectangle = Rectangle { width: 0.1, height };
            let rectangle = rectangle.fibres(&[], &rectangle.section(0.0).unwrap()).unwrap();
            let sand_heap = 0.1 * 0.1 * (3.0 * height - 0.1) / 6.0;
            close(capacity(&rectangle, twist), sand_heap * (1.0 + above), 2e-3);
            close(capacity(&rectangle, [0.0, 1.0, 0.0]), 5.0 / 6.0 * 0.1 * height, 1e-3);
        }
    }

    /// The default on a rectangle against the closed form, ideally plastic, without and with an axial force.
    #[test]
    fn moment_and_curvature_of_a_rectangle() {
        let fibres = lay(&Rectangle { width: 1.0, height: 2.0 }, &[]).unwrap();
        let exact = |kappa: f64| if kappa < 1.0 { 2.0 / 3.0 * kappa } else { 1.0 - 1.0 / (3.0 * kappa * kappa) };
        for i in 1..200 {
            let kappa = 0.1 * f64::from(i);
            assert!((moment(&fibres, kappa, 0.0) - exact(kappa)).abs() < 0.0047, "{kappa}");
        }
        let plane = flattened(&fibres, true);
        assert_eq!(plane.len(), 12);
        close(moment(&plane, 1e6, 0.3 * 2.0), 1.0 - 0.3 * 0.3, 0.0045);
    }

    /// In the plane: area, bending and shear stiffness, and M(κ) as before, all to round-off; nothing out of it.
    #[test]
    fn flattened_keeps_the_plane() {
        for shape in random_shapes() {
            let section = shape.section(NU).unwrap();
            let fibres = lay(&*shape, &[]).unwrap();
            for (along_z, mode) in [(true, 1), (false, 0)] {
                let plane = flattened(&fibres, along_z);
                assert!(plane.len() < fibres.len());
                let C = shear_stiffness(&plane);
                close(sum(&plane, |_| 1.0), section.area, 1e-13);
                close(C[(mode, mode)], section.shear[mode], 1e-12);
                assert!((C.sum() - C[(mode, mode)]).abs() == 0.0);
                // The other coordinate is gone, so the polar moment is that of the plane.
                let I = if along_z { section.Iy } else { section.Iz };
                close(sum(&plane, |f| f.y * f.y + f.z * f.z), I, 1e-12);
            }
            let top = fibres.iter().map(|f| f.z).fold(0.0, f64::max);
            for kappa in [1.5 / top, 5.0 / top] {
                let plane = flattened(&fibres, true);
                close(moment(&plane, kappa, 0.0), moment(&fibres, kappa, 0.0), 1e-10);
            }
        }
    }

    #[test]
    fn counts_out_of_range_are_named() {
        let rectangle = Rectangle { width: 1.0, height: 1.0 };
        assert_eq!(lay(&rectangle, &[4]).unwrap().len(), 16);
        assert!(lay(&rectangle, &[7]).unwrap_err().contains("must be even"));
        assert!(lay(&rectangle, &[4, 4, 4]).unwrap_err().contains("two at most"));
        assert!(lay(&Tube { radius: 1.0, thickness: 0.1 }, &[2]).unwrap_err().contains("4 fibres around"));
        let general = General { area: 1.0, moments: [1.0; 2], Iyz: 0.0, torsion: 1.0, shear_areas: [1.0; 2] };
        assert!(lay(&general, &[]).unwrap_err().contains("no fibres"));
    }
}
