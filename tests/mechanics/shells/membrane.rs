//! Membranes of elements with drilling rotations: even strains and rank of any shape, beams bent in their plane by one element over
//! the depth, sheets under tension.

use crate::support::blocks::{forces, stiffness};
use crate::support::random::vector;
use dense::part;
use nalgebra::DVector;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::elements::ElementBlock;
use rdsolve::elements::shell::{DRILLING, Plate, Quadrilaterals, ShellGeometry, Triangles};
use rdsolve::math::{Vec3, rotation};
use rdsolve::state::{Configuration, Node};

/// A mesh of elements of one kind, with the normals of its nodes.
pub struct Sheet {
    pub x: Vec<Vec3>,
    elements: Vec<Vec<usize>>,
    normals: Vec<Vec3>,
}

impl Sheet {
    pub fn flat(x: Vec<Vec3>, elements: Vec<Vec<usize>>) -> Sheet {
        let normals = vec![Vec3::z(); x.len()];
        Sheet { x, elements, normals }
    }

    /// n × m cells of the unit square, mapped by `map`, each one quadrilateral or two triangles.
    fn grid(triangles: bool, [n, m]: [usize; 2], map: impl Fn(f64, f64) -> (Vec3, Vec3)) -> Sheet {
        let node = |i: usize, j: usize| j * (n + 1) + i;
        let places = (0..=m).flat_map(|j| (0..=n).map(move |i| (i as f64 / n as f64, j as f64 / m as f64)));
        let (x, normals) = places.map(|(s, t)| map(s, t)).unzip();
        let cells = (0..m).flat_map(|j| (0..n).map(move |i| (i, j)));
        let elements = cells.flat_map(|(i, j)| {
            let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            if triangles { vec![vec![a, b, c], vec![a, c, d]] } else { vec![vec![a, b, c, d]] }
        });
        Sheet { x, elements: elements.collect(), normals }
    }

    pub fn block(&self, plate: &Plate) -> Box<dyn ElementBlock> {
        let normals: Vec<Vec<Vec3>> =
            self.elements.iter().map(|e| e.iter().map(|&n| self.normals[n]).collect()).collect();
        let all = self.elements.iter().zip(&normals).map(|(nodes, normals)| ShellGeometry::new(nodes, normals));
        match self.elements[0].len() {
            3 => Box::new(Triangles::new(all, &self.x, plate, 0.0)),
            _ => Box::new(Quadrilaterals::new(all, &self.x, plate, 0.0)),
        }
    }

    pub fn rest(&self) -> Vec<Node> {
        self.x.iter().map(|&x| Node::at_rest(x)).collect()
    }
}

/// A convex quadrilateral or a triangle in the plane, squeezed by `thin` along a direction at random.
pub fn shape(rng: &mut StdRng, corners: usize, thin: f64) -> Vec<Vec3> {
    loop {
        let start: f64 = rng.random_range(0.0..6.3);
        let x: Vec<[f64; 2]> = (0..corners)
            .map(|k| {
                let angle = start + (k as f64 + rng.random_range(-0.35..0.35)) * std::f64::consts::TAU / corners as f64;
                let r = rng.random_range(0.5..1.0);
                [r * angle.cos(), thin * r * angle.sin()]
            })
            .collect();
        let (s, c) = rng.random_range(0.0f64..6.3).sin_cos();
        let x: Vec<Vec3> = x.iter().map(|[x, y]| Vec3::new(c * x - s * y, s * x + c * y, 0.0)).collect();
        let turn = |k: usize| {
            let at = |i: usize| x[(k + i) % corners];
            (at(1) - at(0)).cross(&(at(2) - at(1))).z
        };
        if (0..corners).all(|k| turn(k) > 0.02 * thin) {
            return x;
        }
    }
}

/// Even strains in elements of any shape, with drilling of the rotation: the strain energy is exact, forces inside a patch vanish, and
/// only three motions in the plane are free.
#[test]
fn even_strains_in_any_shape() {
    let mut rng = StdRng::seed_from_u64(31);
    let plate = Plate { thickness: 0.1, E: 1.0, nu: 0.3, drilling: DRILLING };
    let (mut worst, mut most, mut weakest) = ([0.0f64; 2], [0.0f64; 2], f64::INFINITY);
    for round in 0..1000 {
        for corners in [3, 4] {
            let thin = 10f64.powf(-rng.random_range(0.0..3.0));
            let sheet = Sheet::flat(shape(&mut rng, corners, thin), vec![(0..corners).collect()]);
            let K = stiffness(&*sheet.block(&plate), &sheet.rest());
            // u = G x and θ = ½ (G₂₁ − G₁₂).
            let G: [[f64; 2]; 2] = std::array::from_fn(|_| std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
            let u = DVector::from_fn(6 * corners, |i, _| {
                let x = sheet.x[i / 6];
                match i % 6 {
                    k @ 0..2 => G[k][0] * x.x + G[k][1] * x.y,
                    5 => 0.5 * (G[1][0] - G[0][1]),
                    _ => 0.0,
                }
            });
            let (e, f, g) = (G[0][0], G[1][1], G[0][1] + G[1][0]);
            let [s1, s2, t] = [(e + 0.3 * f) / 0.91, (f + 0.3 * e) / 0.91, g / 2.6];
            // Forces at the corners: the stress on half of each adjacent side.
            let F = &K * &u;
            let mut size = 0.0f64;
            let mut far = 0.0f64;
            for a in 0..corners {
                let across = sheet.x[(a + 1) % corners] - sheet.x[(a + corners - 1) % corners];
                let n = 0.05 * Vec3::new(across.y, -across.x, 0.0);
                let wanted = [s1 * n.x + t * n.y, t * n.x + s2 * n.y];
                size = size.max(wanted[0].hypot(wanted[1]));
                far = far.max((F[6 * a] - wanted[0]).hypot(F[6 * a + 1] - wanted[1]));
            }
            worst[corners - 3] = worst[corners - 3].max(far / K.amax());
            most[corners - 3] = most[corners - 3].max(far / size);
            // In the plane: three rigid motions. Rotations in units of the element's size.
            let plane: Vec<usize> = (0..6 * corners).filter(|i| [0, 1, 5].contains(&(i % 6))).collect();
            let K = part(&K, &plane);
            let values = dense::eigenvalues(&dense::scaled(&K));
            // What bends is as weak as the square of the thinness, and what drills at short edges as its fourth power.
            assert!(values[2].abs() < 1e-14 / thin.powi(2), "{round} {corners} {thin} {values:?}");
            assert!(values[3] > 1e-3 * thin.powi(4), "{round} {corners} {thin} {values:?}");
            weakest = weakest.min(values[3] / thin.powi(4));
        }
    }
    println!("to the stiffness {worst:?}, to the forces {most:?}, weakest {weakest:?}");
    // Rounding of the largest stiffness; of four corners almost in a line, a thousand times as long as high, somewhat more.
    assert!(worst[0] < 1e-13 && worst[1] < 1e-10 && most[0] < 1e-10, "{worst:?} {most:?}");
}

/// The cantilever of MacNeal & Harder by six elements over its length and one over its depth, tip deflection over that of a beam.
/// `slant`: of the sides between elements; `moment` in place of a force.
fn cantilever(triangles: bool, shape: &str, n: usize, moment: bool) -> f64 {
    let slant = |k: usize| match (shape, k) {
        ("regular", _) | (_, 0 | 6) => 0.0,
        ("trapezoids", _) if k.is_multiple_of(2) => -0.1,
        _ => 0.1,
    };
    let sheet = Sheet::grid(triangles, [6 * n, n], |s, t| {
        let k = ((6.0 * s + 1e-9).floor() as usize).min(5);
        let r = 6.0 * s - k as f64;
        let x = 6.0 * s + ((1.0 - r) * slant(k) + r * slant(k + 1)) * (2.0 * t - 1.0);
        (Vec3::new(x, 0.2 * t, 0.0), Vec3::z())
    });
    let plate = Plate { thickness: 0.1, E: 1e7, nu: 0.3, drilling: DRILLING };
    let K = stiffness(&*sheet.block(&plate), &sheet.rest());
    let free: Vec<usize> =
        (0..6 * sheet.x.len()).filter(|i| [0, 1, 5].contains(&(i % 6)) && sheet.x[i / 6].x > 1e-9).collect();
    let mut F = DVector::zeros(free.len());
    // ML²/2EI = 1 for M = EI/18.
    let M = 1e7 * 0.1 * 0.008 / 12.0 / 18.0;
    for (row, &i) in free.iter().enumerate() {
        let x = sheet.x[i / 6];
        let corner = x.y.min(0.2 - x.y) < 1e-9;
        if x.x > 6.0 - 1e-9 {
            match i % 6 {
                0 if moment && corner => F[row] = if x.y < 0.1 { M / 0.2 } else { -M / 0.2 },
                1 if !moment => F[row] = if corner { 0.5 } else { 1.0 } / n as f64,
                _ => (),
            }
        }
    }
    let u = part(&K, &free).cholesky().unwrap().solve(&F);
    let tip = |y: f64| {
        let at = |i: &usize| i % 6 == 1 && (sheet.x[i / 6] - Vec3::new(6.0, y, 0.0)).norm() < 1e-9;
        u[free.iter().position(at).unwrap()]
    };
    0.5 * (tip(0.0) + tip(0.2)) / if moment { 1.0 } else { 0.108_094 }
}

#[test]
fn beams_bent_in_their_plane() {
    for triangles in [false, true] {
        for n in [1, 2, 4] {
            let row = ["regular", "trapezoids", "parallelograms"]
                .map(|shape| [false, true].map(|moment| cantilever(triangles, shape, n, moment)));
            println!("triangles {triangles} {n}: {row:.4?}");
            // With one element over the depth; what is printed of other elements ranges from 0.02 to 0.99.
            let least = if !triangles {
                0.97
            } else if n == 1 {
                0.45
            } else {
                0.59
            };
            assert!(row.as_flattened().iter().all(|part| (least..1.07).contains(part)), "{row:?}");
            assert!(row[0].iter().all(|part| *part > 0.99), "rectangles: {row:?}");
        }
    }
}

/// A sheet under tension, or one with a kink in it.
fn stretched(triangles: bool, name: &str) -> Sheet {
    let mut rng = StdRng::seed_from_u64(5);
    let mut sheet = Sheet::grid(triangles, [4, 4], |s, t| match name {
        "cylinder" => {
            let (sin, cos) = (t - 0.5).sin_cos();
            (Vec3::new(s, sin, cos), Vec3::new(0.0, sin, cos))
        }
        _ => (Vec3::new(s, t, 0.0), Vec3::z()),
    });
    if name == "irregular" || name == "kinked" {
        let inside = |c: f64| c > 0.01 && c < 0.99;
        for x in &mut sheet.x {
            let d = vector(&mut rng, 0.05);
            x.x += if inside(x.x) { d.x } else { 0.0 };
            x.y += if inside(x.y) { d.y } else { 0.0 };
            x.z += if name == "kinked" { 0.6 * d.z } else { 0.0 };
        }
    }
    sheet
}

/// The number of negative eigenvalues of the exact tangent where the edges that are pulled are held; `motion` from where nodes
/// lay.
fn unstable(sheet: &Sheet, h: f64, biaxial: bool, motion: impl Fn(&Vec3) -> Vec3) -> usize {
    let plate = Plate { thickness: h, E: 1.0, nu: 0.3, drilling: DRILLING };
    let nodes: Vec<Node> = sheet.x.iter().map(|x| Node::at_rest(motion(x))).collect();
    let K = stiffness(&*sheet.block(&plate), &nodes);
    let widest = sheet.x.iter().map(|x| x.y).fold(0.0, f64::max);
    let least = sheet.x.iter().map(|x| x.y).fold(widest, f64::min);
    let held = |x: &Vec3| x.x < 1e-9 || x.x > 1.0 - 1e-9 || biaxial && (x.y < least + 1e-9 || x.y > widest - 1e-9);
    let free: Vec<usize> = (0..K.nrows()).filter(|i| !held(&sheet.x[i / 6])).collect();
    dense::eigenvalues(&part(&K, &free)).iter().filter(|value| **value < 0.0).count()
}

/// Tension loads no rotation, whatever the angle between elements: the tangent of stretched sheets stays positive definite, also
/// where strain times (L/h)² is a million.
#[test]
fn sheets_under_tension_are_stable() {
    for triangles in [false, true] {
        for name in ["flat", "irregular", "kinked", "cylinder"] {
            let sheet = stretched(triangles, name);
            for h in [1e-1, 1e-2, 1e-3, 1e-4] {
                for strain in [1e-5, 1e-4, 1e-3, 1e-2] {
                    for biaxial in [false, true] {
                        // No stress across: E₂₂ = −ν E₁₁.
                        let long: f64 = 1.0 + strain;
                        let across = if biaxial { long } else { (1.0 - 0.3 * (long * long - 1.0)).sqrt() };
                        let below = unstable(&sheet, h, biaxial, |x| match name {
                            "kinked" if !biaxial => Vec3::new(long * x.x, across * x.y, x.z),
                            _ => Vec3::new(long * x.x, across * x.y, across * x.z),
                        });
                        let what = format!("triangles {triangles} {name} {h} {strain} biaxial {biaxial}");
                        assert!(below == 0, "{what}: {below} negative eigenvalues");
                    }
                }
            }
        }
    }
}

/// Central differences (leapfrog) with lumped masses, from velocities `start` and angular velocities; `held` nodes stay. Returns the
/// largest and smallest energy over the steps, and the kinetic energy at the start.
fn leapfrog(
    sheet: &Sheet,
    plate: &Plate,
    mut nodes: Vec<Node>,
    held: impl Fn(usize) -> bool,
    start: impl FnMut(usize) -> (Vec3, Vec3),
    steps: usize,
) -> [f64; 3] {
    let block = sheet.block(plate);
    let mut mass = vec![0.0; nodes.len()];
    for e in &sheet.elements {
        let x: Vec<Vec3> = e.iter().map(|&n| sheet.x[n]).collect();
        for (&n, share) in e.iter().zip(rdsolve::elements::shell::shares(&x)) {
            mass[n] += plate.thickness * share;
        }
    }
    let rotary = plate.thickness.powi(2) / 12.0;
    // The waves that pass an element first: of rotation against shear, of stretching.
    let step = 0.15 * plate.thickness.min(0.25);
    let mut motion: Vec<(Vec3, Vec3)> = (0..nodes.len()).map(start).collect();
    let kinetic = |motion: &[(Vec3, Vec3)]| -> f64 {
        motion.iter().zip(&mass).map(|((v, w), m)| 0.5 * m * (v.norm_squared() + rotary * w.norm_squared())).sum()
    };
    let first = kinetic(&motion);
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    let rest = block.energy(&Configuration::of(&nodes));
    for k in 0..steps {
        let F = forces(&*block, &Configuration::of(&nodes));
        let before = kinetic(&motion);
        for n in 0..nodes.len() {
            let (v, w) = &mut motion[n];
            if held(n) {
                (*v, *w) = (Vec3::zeros(), Vec3::zeros());
                continue;
            }
            *v -= step / mass[n] * Vec3::new(F[n][0], F[n][1], F[n][2]);
            *w -= step / (mass[n] * rotary) * Vec3::new(F[n][3], F[n][4], F[n][5]);
        }
        if k % 50 == 0 && k > 0 {
            let energy = 0.5 * (before + kinetic(&motion)) + block.energy(&Configuration::of(&nodes)) - rest;
            (least, most) = (least.min(energy), most.max(energy));
        }
        for (node, (v, w)) in nodes.iter_mut().zip(&motion) {
            node.x += step * v;
            node.rotation = rotation::exp(&(step * w)) * node.rotation;
        }
    }
    [least, most, first]
}

/// Noise on a stretched sheet neither grows nor dies over 20,000 steps.
#[test]
fn noise_on_a_stretched_sheet_is_bounded() {
    for triangles in [false, true] {
        let sheet = stretched(triangles, "kinked");
        let plate = Plate { thickness: 0.01, E: 1.0, nu: 0.3, drilling: DRILLING };
        let nodes = sheet.x.iter().map(|x| Node::at_rest(1.003 * x)).collect();
        let rim = |c: f64| !(1e-9..=1.0 - 1e-9).contains(&c);
        let mut rng = StdRng::seed_from_u64(6);
        let start = |_| (vector(&mut rng, 1e-4), vector(&mut rng, 1e-2));
        let held = |n: usize| rim(sheet.x[n].x) || rim(sheet.x[n].y);
        let [least, most, first] = leapfrog(&sheet, &plate, nodes, held, start, 20_000);
        println!("triangles {triangles}: energy {least:e} to {most:e}, at the start {first:e}");
        // The energy of the scheme, not that of the sheet, is constant: they differ by (ω Δt)², of which all modes have their share.
        assert!(least > 0.0 && most < 1.02 * least, "{least:e} to {most:e}");
    }
}

/// A free sheet that spins about an axis in space keeps its energy over 20,000 steps, some 10 turns.
#[test]
fn spinning_sheet_keeps_its_energy() {
    for triangles in [false, true] {
        let sheet = stretched(triangles, "irregular");
        let plate = Plate { thickness: 0.01, E: 1.0, nu: 0.3, drilling: DRILLING };
        // Strains of some ρω²L²/E = 1e-3.
        for axis in [Vec3::z(), Vec3::new(1.0, 0.3, 0.0).normalize()] {
            let omega = 0.05 * axis;
            let centre = Vec3::new(0.5, 0.5, 0.0);
            let start = |n: usize| (omega.cross(&(sheet.x[n] - centre)), omega);
            let [least, most, first] = leapfrog(&sheet, &plate, sheet.rest(), |_| false, start, 20_000);
            println!("triangles {triangles} {axis:?}: energy {least:e} to {most:e}, at the start {first:e}");
            assert!((most - least).abs() < 1e-7 * first && (most - first).abs() < 1e-7 * first);
        }
    }
}
