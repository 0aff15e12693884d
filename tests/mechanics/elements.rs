//! Every element: tangent against differences at random large rotations under load, no force in a rigid motion,
//! forces in balance, energy as the potential of the force. Those that yield: the same with a past, and what they remember.

use crate::support::blocks::{forces, nudge};
use crate::support::random::{turn, vector};
use nalgebra::{DMatrix, Vector3};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::elements::bar::YieldingBars;
use rdsolve::elements::beam::{BeamGeometry, BeamSetting, FibreGroup, FibreModel, IntegrationRule, elastic_beams};
use rdsolve::elements::bearing::{Bearing, BearingMatrices, Bearings};
use rdsolve::elements::bouc_wen::BoucWen;
use rdsolve::elements::bushing::{Bushing, Bushings};
use rdsolve::elements::damper::Damper;
use rdsolve::elements::deteriorating::Deteriorating;
use rdsolve::elements::heat::Heat;
use rdsolve::elements::hysteresis::Hysteresis;
use rdsolve::elements::hysteretic_link::{HystereticLink, HystereticLinks, PathLaw};
use rdsolve::elements::isolator::{Isolator, IsolatorLaw, Isolators, SlidingFriction};
use rdsolve::elements::link::{Link, LinkLaw, Links};
use rdsolve::elements::pinching::{Pinching, Reloading};
use rdsolve::elements::relative_rotation::RotationalSpring;
use rdsolve::elements::shell::{self, Plate, Quadrilaterals, Triangles};
use rdsolve::elements::{ElementBlock, Force, Mechanics, Moduli};
use rdsolve::materials::uniaxial::UniaxialLaw;
use rdsolve::materials::{Dissipation, Hardening, MaterialLaw as Material, Overstress, Viscosity};
use rdsolve::math::{Mat3, Mat6, Vec3, quadrature, rotation};
use rdsolve::sections::{Fibre, Stiffness};
use rdsolve::state::{Configuration, Node};

fn section() -> Stiffness {
    Stiffness {
        N: Mat3::new(30.0, 0.0, 0.0, 0.0, 9.0, 1.0, 0.0, 1.0, 7.0),
        M: Mat3::new(2.0, 0.0, 0.0, 0.0, 3.0, 0.5, 0.0, 0.5, 5.0),
        NM: Mat3::new(0.0, 0.0, 0.0, 0.6, 0.0, 0.0, -0.4, 0.0, 0.0),
        mass_center: [0.0; 2],
        mass_per_length: 1.0,
        inertia_per_length: Mat3::identity(),
    }
}

/// An element with the initial positions of its nodes, and what its material points remember.
struct Kind {
    name: String,
    block: Box<dyn ElementBlock>,
    x: Vec<Vec3>,
    past: Vec<f64>,
}

impl Kind {
    /// Some time after the past.
    fn now<'a>(&'a self, nodes: &'a [Node]) -> Configuration<'a> {
        Configuration { nodes, history: &self.past, dt: 0.4, previous: None }
    }

    fn forces(&self, nodes: &[Node]) -> Vec<Force> {
        forces(&*self.block, &self.now(nodes))
    }

    fn tangent(&self, nodes: &[Node], rate_weight: f64, moduli: Moduli) -> DMatrix<f64> {
        let size = self.block.dofs() * nodes.len();
        let mut K = vec![0.0; size * size];
        self.block.tangent(0, &self.now(nodes), rate_weight, moduli, &mut K);
        DMatrix::from_row_slice(size, size, &K)
    }

    /// What is remembered of a motion.
    fn update_history(&self, nodes: &[Node]) -> (Vec<f64>, Dissipation) {
        let mut history = vec![f64::NAN; self.past.len()];
        let spent = self.block.update_history(&self.now(nodes), 1.0, &mut history);
        (history, spent)
    }
}

/// An element of every kind. Materials yield at strains of some hundredths to some tenths, times `firmness`.
fn kinds(rng: &mut StdRng, firmness: f64) -> Vec<Kind> {
    let mut kinds = elastic(rng);
    let yielding = yielding(rng, firmness);
    kinds.extend(yielding);
    kinds
}

/// The same with a past of large strains.
fn strained(rng: &mut StdRng, firmness: f64) -> Vec<Kind> {
    let mut kinds = kinds(rng, firmness);
    for kind in &mut kinds {
        let nodes = moved(rng, &kind.x, 0.15);
        kind.past = kind.update_history(&nodes).0;
    }
    kinds
}

fn elastic(rng: &mut StdRng) -> Vec<Kind> {
    let mut kinds = Vec::new();
    let mut add = |name: &str, block: Box<dyn ElementBlock>, x: &[Vec3]| {
        kinds.push(Kind { name: name.into(), block, x: x.to_vec(), past: vec![] });
    };
    let frame = rotation::matrix(&turn(rng));
    let start = vector(rng, 2.0);
    add("beam of 2 nodes", beam::<2>(&frame, start, 0.0), &nodes_of(2, &frame, start));
    add("beam of 3 nodes", beam::<3>(&frame, start, 0.0), &nodes_of(3, &frame, start));
    add("beam of 4 nodes", beam::<4>(&frame, start, 0.0), &nodes_of(4, &frame, start));
    add("beam of 5 nodes", beam::<5>(&frame, start, 0.0), &nodes_of(5, &frame, start));
    add("varied beam of 2 nodes", varied::<2>(&frame, start, 0.0), &nodes_of(2, &frame, start));
    add("varied beam of 4 nodes", varied::<4>(&frame, start, 0.0), &nodes_of(4, &frame, start));
    add("varied damped beam of 3 nodes", varied::<3>(&frame, start, 0.3), &nodes_of(3, &frame, start));
    add("damped beam of 2 nodes", beam::<2>(&frame, start, 0.3), &nodes_of(2, &frame, start));
    add("damped beam of 4 nodes", beam::<4>(&frame, start, 0.3), &nodes_of(4, &frame, start));
    // The last nodes are the numbers of temperature: places of 5 are strains of 0.05.
    let heated = |own: &[Vec3], numbers: usize| {
        let node = |k: usize| (k < numbers).then_some(own.len() + k);
        let x: Vec<Vec3> = own.iter().copied().chain((0..numbers).map(|_| start)).collect();
        (x, Heat { numbers: std::array::from_fn(node), length: 100.0, factors: vec![0.7] })
    };
    let (warm, heat) = heated(&nodes_of(3, &frame, start), 3);
    let one = [BeamGeometry { nodes: &[0, 1, 2], frame: &frame, stiffness: &section(), varied: None }];
    add("heated beam", elastic_beams(2, &one, BeamSetting { x: &warm, damping: 0.3, heat: &heat }), &warm);
    let (warm, heat) = heated(&nodes_of(2, &frame, start), 1);
    let bar = rdsolve::elements::bar::elastic_bars(&[[0, 1]], 40.0, false, (1.0, &heat), &warm, 0.2);
    add("heated bar", Box::new(bar), &warm);
    for (name, size) in [("heated triangle", 3), ("heated quadrilateral", 4)] {
        let corner = |k: usize| {
            start + frame * [[0.0, 0.0, 0.0], [1.2, 0.1, 0.0], [1.0, 0.9, 0.1], [-0.1, 1.1, 0.0]].map(Vec3::from)[k]
        };
        let own: Vec<Vec3> = (0..size).map(corner).collect();
        let (warm, heat) = heated(&own, 2);
        let nodes: Vec<usize> = (0..size).collect();
        let normals = vec![frame.column(2).into_owned(); size];
        let all = || std::iter::once(shell::ShellGeometry::new(&nodes, &normals));
        let plate = Plate { thickness: 0.1, E: 100.0, nu: 0.3, drilling: shell::DRILLING };
        let block: Box<dyn ElementBlock> = match size {
            3 => Box::new(Triangles::new(all(), &warm, &plate, 0.2).heated(&heat, &warm)),
            _ => Box::new(Quadrilaterals::new(all(), &warm, &plate, 0.2).heated(&heat, &warm)),
        };
        add(name, block, &warm);
    }
    let ends = nodes_of(2, &frame, start);
    let damped = |law, damper, direction| Link::new([0, 1], law, damper, direction, 1.2, [ends[0], ends[1]]);
    let link = |law, direction| damped(law, Damper::linear(0.7), direction);
    let linear = LinkLaw::Linear { stiffness: 20.0, preload: 1.0 };
    let d = frame.column(1).into_owned();
    add("link", Box::new(Links::new(vec![link(linear.clone(), None)])), &ends);
    add("link along a direction", Box::new(Links::new(vec![link(linear, Some(d))])), &ends);
    for (name, exponent, slow) in [("link with a fluid damper", 0.4, 0.3), ("link with drag", 2.0, 0.0)] {
        let damper = Damper { coefficient: 0.7, exponent, slow };
        let law = LinkLaw::Linear { stiffness: 20.0, preload: 1.0 };
        add(name, Box::new(Links::new(vec![damped(law, damper, None)])), &ends);
    }
    let table = LinkLaw::Table { points: vec![[-9.0, -7.0], [0.0, 0.0], [9.0, 20.0]] };
    add("table link", Box::new(Links::new(vec![link(table, None)])), &ends);
    add(
        "bar",
        Box::new(rdsolve::elements::bar::elastic_bars(&[[0, 1]], 40.0, false, (1.0, &Heat::NONE), &ends, 0.2)),
        &ends,
    );
    let moments = [
        ("bushing", Vec3::new(4.0, 5.0, 6.0)),
        ("bushing with a free axis", Vec3::new(0.0, 5.0, 6.0)),
        ("bushing of equal stiffness", Vec3::new(5.0, 5.0, 5.0)),
    ];
    for (name, stiffness) in moments {
        let bushing = Bushing {
            nodes: [0, 1],
            axes: frame,
            stiffness: Vec3::new(10.0, 20.0, 30.0),
            spring: RotationalSpring::new(stiffness),
            damping: [1.0, 0.5, 0.2, 0.1, 0.3, 0.2],
            offset: frame.tr_mul(&(ends[1] - ends[0])),
            failure: None,
        };
        add(name, Box::new(Bushings::new(vec![bushing])), &ends);
    }
    let offset = frame.tr_mul(&(ends[1] - ends[0]));
    let bearing = Bearing { nodes: [0, 1], axes: frame, offset, matrices: bearing_matrices(rng) };
    add("bearing", Box::new(Bearings::new(vec![bearing])), &ends);
    for (name, block, x) in shells() {
        add(name, block, &x);
    }
    kinds
}

/// Those at rest have a potential; those at a speed do not, and act with those of the spins of random states.
fn bearing_matrices(rng: &mut StdRng) -> Vec<BearingMatrices> {
    let mut random = |size: f64| {
        let mut all = Mat6::from_fn(|_, _| rng.random_range(-size..size));
        all.row_mut(3).fill(0.0);
        all.column_mut(3).fill(0.0);
        all
    };
    let [own, more, at_rest, fast] = [4.0, 2.0, 1.0, 1.0].map(&mut random);
    let at =
        |speed, stiffness, damping: Mat6| BearingMatrices { speed, stiffness, damping: damping * damping.transpose() };
    vec![at(0.0, own * own.transpose(), at_rest), at(3.0, own * own.transpose() + more, fast)]
}

/// Warped and curved ones, with and without damping.
fn shells() -> Vec<(&'static str, Box<dyn ElementBlock>, Vec<Vec3>)> {
    let rng = &mut StdRng::seed_from_u64(11);
    let plate = Plate { thickness: 0.4, E: 60.0, nu: 0.3, drilling: 0.1 };
    let frame = rotation::matrix(&turn(rng));
    let corners = [[0.0, 0.0], [1.2, 0.1], [1.3, 0.9], [-0.2, 1.1]].map(|[x, y]| Vec3::new(x, y, 0.0));
    let x: Vec<Vec3> = corners.iter().map(|c| frame * (c + vector(rng, 0.1))).collect();
    let normals: Vec<Vec3> = x.iter().map(|_| frame * (Vec3::z() + vector(rng, 0.1)).normalize()).collect();
    let four = || [shell::ShellGeometry::new(&[0, 1, 2, 3], &normals)].into_iter();
    let three = || [shell::ShellGeometry::new(&[0, 1, 2], &normals[..3])].into_iter();
    vec![
        ("quadrilateral", Box::new(Quadrilaterals::new(four(), &x, &plate, 0.0)), x.clone()),
        ("damped quadrilateral", Box::new(Quadrilaterals::new(four(), &x, &plate, 0.2)), x.clone()),
        ("triangle", Box::new(Triangles::new(three(), &x, &plate, 0.0)), x[..3].to_vec()),
        ("damped triangle", Box::new(Triangles::new(three(), &x, &plate, 0.2)), x[..3].to_vec()),
    ]
}

fn nodes_of(n: usize, frame: &Mat3, start: Vec3) -> Vec<Vec3> {
    let axis: Vec3 = frame.column(0).into_owned() * 1.3;
    quadrature::lobatto(n).0.iter().map(|p| start + axis * (0.5 + 0.5 * p)).collect()
}

fn beam<const N: usize>(frame: &Mat3, start: Vec3, damping: f64) -> Box<dyn ElementBlock> {
    let nodes: Vec<usize> = (0..N).collect();
    let one = [BeamGeometry { nodes: &nodes, frame, stiffness: &section(), varied: None }];
    elastic_beams(N - 1, &one, BeamSetting { x: &nodes_of(N, frame, start), damping, heat: &Heat::NONE })
}

/// A beam whose section turns, softens and leaves the axis from point to point.
fn varied<const N: usize>(frame: &Mat3, start: Vec3, damping: f64) -> Box<dyn ElementBlock> {
    let nodes: Vec<usize> = (0..N).collect();
    let parts = [0.1, 0.4, 0.6, 0.9];
    let sections = parts.map(|part| section().beside([0.3 * part, -0.2 * part]).toward(&section(), part));
    let frames = parts.map(|part| rotation::matrix(&rotation::exp(&(frame.column(0) * part))) * frame);
    let points = std::array::from_fn(|g| (&sections[g], &frames[g]));
    let one = [BeamGeometry { nodes: &nodes, frame, stiffness: &section(), varied: Some(points) }];
    elastic_beams(N - 1, &one, BeamSetting { x: &nodes_of(N, frame, start), damping, heat: &Heat::NONE })
}

/// E = 20; hardening of both kinds, linear or by a table.
fn materials(rng: &mut StdRng, firmness: f64) -> [(&'static str, Material); 2] {
    let stress = firmness * 10f64.powf(rng.random_range(-0.3..0.8));
    let table = vec![[0.0, stress], [0.02, 1.2 * stress], [0.3, 1.5 * stress]];
    let overstress = Overstress::Power { exponent: 3.0 };
    let viscosity = Some(Viscosity { fluidity: 2.0, overstress });
    let linear = Hardening::Linear { yield_stress: stress, modulus: 3.0 };
    [
        ("plastic", Material::new(20.0, 0.3, linear, 0.4, None)),
        ("viscous", Material::new(20.0, 0.3, Hardening::table(table).unwrap(), 0.7, viscosity)),
    ]
}

/// Links along a line, and along a direction, that yield at elongations of some hundredths.
fn hysteretic_links(rng: &mut StdRng, firmness: f64, kinds: &mut Vec<Kind>) {
    let backbone = Hysteresis::new(&[[0.04 * firmness, firmness], [0.1 * firmness, 1.8 * firmness]], 4.0).unwrap();
    let smooth = BoucWen {
        stiffness: 25.0,
        post_yield_stiffness: 4.0,
        yield_force: firmness,
        exponent: 2.0,
        bulge: 0.5,
        losses: [0.02, 0.01],
    };
    let laws = [("yielding link", PathLaw::Backbone(backbone)), ("smooth link", PathLaw::BoucWen(smooth))];
    kinds.extend(links_with_memory(rng, &laws));
}

/// Links by these laws, along their line and along a direction.
fn links_with_memory(rng: &mut StdRng, laws: &[(&str, PathLaw)]) -> Vec<Kind> {
    let mut kinds = Vec::new();
    for (name, law) in laws {
        for direction in [None, Some(vector(rng, 1.0).normalize())] {
            let frame = rotation::matrix(&turn(rng));
            let x = nodes_of(2, &frame, vector(rng, 2.0));
            let none = LinkLaw::Linear { stiffness: 0.0, preload: 0.0 };
            let length = direction.map_or(1.3, |d| d.dot(&(x[1] - x[0])));
            let damper = Damper { coefficient: 0.7, exponent: 0.4, slow: 0.3 };
            let link = Link::new([0, 1], none, damper, direction, length, [x[0], x[1]]);
            let block = Box::new(HystereticLinks::new(vec![HystereticLink { link, law: *law, beside: 0.2 }]));
            let past = vec![0.0; block.history()];
            let along = if direction.is_some() { " along a direction" } else { "" };
            kinds.push(Kind { name: format!("{name}{along}"), block, x, past });
        }
    }
    kinds
}

/// A pendulum, pressed in most states, and rubber; both slip at displacements of some hundredths.
fn isolators(rng: &mut StdRng, firmness: f64, kinds: &mut Vec<Kind>) {
    let friction = SlidingFriction { slow: 0.1 * firmness, fast: 0.3 * firmness, rate: 0.5 };
    let pendulum = IsolatorLaw::Pendulum { radius: 2.0, friction };
    let rubber = IsolatorLaw::Rubber { yield_force: firmness, post_yield_stiffness: 4.0 };
    for (name, law, pressed) in [("pendulum link", pendulum, 0.2), ("rubber", rubber, 0.0)] {
        let frame = rotation::matrix(&turn(rng));
        let x = nodes_of(2, &frame, vector(rng, 2.0));
        let offset = frame.tr_mul(&(x[1] - x[0])) + Vec3::new(pressed, 0.0, 0.0);
        let beta = if pressed > 0.0 { 0.0 } else { 0.1 };
        let of = Isolator { nodes: [0, 1], axes: frame, offset, law, stiffness: 25.0, axial_stiffness: 30.0, beta };
        let block = Box::new(Isolators::new(vec![of]));
        let past = vec![0.0; block.history()];
        kinds.push(Kind { name: name.into(), block, x, past });
    }
}

fn yielding(rng: &mut StdRng, firmness: f64) -> Vec<Kind> {
    let mut kinds = Vec::new();
    hysteretic_links(rng, firmness, &mut kinds);
    isolators(rng, firmness, &mut kinds);
    for (name, law) in materials(rng, firmness) {
        for damping in [0.0, 0.3] {
            let damped = if damping > 0.0 { "damped " } else { "" };
            yielding_beams::<2>(rng, &format!("{damped}{name}"), &law, damping, &mut kinds);
            yielding_beams::<3>(rng, &format!("{damped}{name}"), &law, damping, &mut kinds);
            yielding_beams::<4>(rng, &format!("{damped}{name}"), &law, damping, &mut kinds);
            yielding_beams::<5>(rng, &format!("{damped}{name}"), &law, damping, &mut kinds);
            for (rope, what) in [(false, "bar"), (true, "rope")] {
                let frame = rotation::matrix(&turn(rng));
                let x = nodes_of(2, &frame, vector(rng, 2.0));
                let block = Box::new(YieldingBars::new(&[[0, 1]], (40.0, &law), rope, (1.0, &Heat::NONE), &x, damping));
                let past = vec![0.0; block.history()];
                kinds.push(Kind { name: format!("{damped}{name} {what}"), block, x, past });
            }
        }
    }
    kinds
}

/// Beams of N nodes with few fibres, whose section is not theirs alone.
fn yielding_beams<const N: usize>(rng: &mut StdRng, name: &str, law: &Material, damping: f64, kinds: &mut Vec<Kind>) {
    let spots = [-0.35, 0.4].into_iter().flat_map(|y| [-0.4, 0.05, 0.45].map(|z| (y, z)));
    let fibre = |(y, z)| Fibre { area: 0.15, y, z, shear: [[0.9, 0.0, -z], [0.1, 0.9, y]] };
    let fibres: Vec<Fibre> = spots.map(fibre).collect();
    let rules = [(IntegrationRule::Gauss, N - 1), (IntegrationRule::Gauss, 5), (IntegrationRule::Lobatto, N.max(3))];
    for shear in [true, false] {
        for (rule, points) in rules {
            let groups = vec![FibreGroup { law: UniaxialLaw::Plastic(law.clone()), fibres: fibres.clone() }];
            let yielding = FibreModel { groups, shear, rule, points };
            let frame = rotation::matrix(&turn(rng));
            let x = nodes_of(N, &frame, vector(rng, 2.0));
            let nodes: Vec<usize> = (0..N).collect();
            let one = [BeamGeometry { nodes: &nodes, frame: &frame, stiffness: &section(), varied: None }];
            let block = yielding.beams(N - 1, &one, BeamSetting { x: &x, damping, heat: &Heat::NONE });
            let past = vec![0.0; block.history()];
            let with = if shear { "with" } else { "without" };
            let name = format!("{name} beam of {N} nodes, {rule:?} {points}, {with} shear");
            kinds.push(Kind { name, block, x, past });
        }
    }
}

/// Nodes moved far as a whole and strained and rotated against each other.
fn moved(rng: &mut StdRng, x: &[Vec3], strain: f64) -> Vec<Node> {
    let (turn, shift) = (turn(rng), vector(rng, 5.0));
    let R = rotation::matrix(&turn);
    x.iter()
        .map(|x| {
            let mut node = Node::at_rest(R * x + shift + vector(rng, strain));
            let local = rotation::exp(&vector(rng, strain));
            // The sign of a quaternion carries no meaning; elements must not care.
            let sign = if rng.random_range(0.0..1.0) < 0.5 { -1.0 } else { 1.0 };
            node.rotation = local * turn * sign;
            node.v = vector(rng, 1.0);
            node.omega = vector(rng, 1.0);
            node
        })
        .collect()
}

/// Where central differences of one step and of half of it do not agree, a fibre begins to yield, ends, or meets a corner of its
/// hardening between them: such entries have no derivative, and there must be few. The two extrapolated leave truncation of
/// h⁴ and cancellation of 1e-16/h ~ 1e-11, relative, times forces up to ten times the stiffness.
#[test]
fn tangent_is_the_derivative_of_the_force() {
    let mut rng = StdRng::seed_from_u64(7);
    let (mut entries, mut corners, mut worst) = (0usize, 0usize, 0.0f64);
    for round in 0..8 {
        for kind in strained(&mut rng, 1.0) {
            let nodes = moved(&mut rng, &kind.x, 0.15);
            let d = kind.block.dofs();
            let K = kind.tangent(&nodes, 0.0, Moduli::Algorithmic);
            let C = kind.tangent(&nodes, 1.0, Moduli::Algorithmic) - &K;
            let scale = K.amax().max(1.0);
            for column in 0..d * nodes.len() {
                let difference = |change: &dyn Fn(&mut Node, f64), h: f64| {
                    let at = |h: f64| {
                        let mut nodes = nodes.clone();
                        change(&mut nodes[column / d], h);
                        kind.forces(&nodes)
                    };
                    let (plus, minus) = (at(h), at(-h));
                    move |row: usize| (plus[row / d][row % d] - minus[row / d][row % d]) / (2.0 * h)
                };
                let mut compare = |A: &DMatrix<f64>, change: &dyn Fn(&mut Node, f64), what: &str| {
                    let h = 1e-5;
                    let (whole, half) = (difference(change, h), difference(change, 0.5 * h));
                    for row in 0..K.nrows() {
                        let (whole, half) = (whole(row), half(row));
                        entries += 1;
                        if (whole - half).abs() > 1e-6 * scale {
                            corners += 1;
                            continue;
                        }
                        let (a, exact) = (A[(row, column)], half + (half - whole) / 3.0);
                        worst = worst.max((a - exact).abs() / scale);
                        let name = &kind.name;
                        let at = format!("{name}, round {round}, row {row}, column {column}, {what}");
                        assert!((a - exact).abs() < 1e-9 * scale, "{at}: {a} {exact}");
                    }
                };
                compare(&K, &|node, h| nudge(node, column % d, h), "position");
                let faster = |node: &mut Node, h: f64| match column % d {
                    i @ 0..3 => node.v[i] += h,
                    i => node.omega[i - 3] += h,
                };
                compare(&C, &faster, "rate");
            }
        }
    }
    eprintln!("worst {worst:e}, {corners} corners in {entries} entries");
    assert!(corners * 10_000 < entries, "{corners} of {entries}");
}

/// K(e) + K(σ) is as much stiffer than the derivative as C(e) than C(ep): ∫ Bᵀ (C(e) − C(ep)) B is symmetric and never
/// negative, and nothing where nothing yields.
#[test]
fn tangent_of_elastic_moduli() {
    let mut rng = StdRng::seed_from_u64(11);
    for _ in 0..4 {
        for kind in strained(&mut rng, 1.0) {
            let nodes = moved(&mut rng, &kind.x, 0.15);
            let of = |moduli| kind.tangent(&nodes, 0.7, moduli);
            let (K, more) = (of(Moduli::Elastic), of(Moduli::Elastic) - of(Moduli::Algorithmic));
            if kind.name.contains("pendulum") {
                continue; // its limit changes with the compression and the speed
            }
            // Rounding of sums over thirty rows and fibres.
            assert!((&more - more.transpose()).amax() <= 1e-13 * K.amax(), "{}", kind.name);
            let least = more.symmetric_eigenvalues().min();
            assert!(least >= -1e-12 * K.amax(), "{}: {least}", kind.name);
        }
        // The smooth law softens from the first.
        for kind in kinds(&mut rng, 1e6).into_iter().filter(|kind| !kind.name.contains("smooth")) {
            let nodes = moved(&mut rng, &kind.x, 0.15);
            let [elastic, full] =
                [Moduli::Elastic, Moduli::Algorithmic].map(|moduli| kind.tangent(&nodes, 0.7, moduli));
            let off = (&elastic - &full).amax();
            assert!(off <= 1e-13 * full.amax(), "{}: {off}", kind.name); // fibre by fibre, or summed before
        }
    }
}

/// Positions x → R x + s with velocities of a rigid motion: neither stress nor damping. Bound: rounding of positions ~10
/// times stiffness ~60 times 1e-16.
#[test]
fn rigid_motion_gives_no_force() {
    let mut rng = StdRng::seed_from_u64(8);
    for _ in 0..20 {
        for kind in kinds(&mut rng, 1.0) {
            let name = &kind.name;
            if name.contains("link") || name.contains("heated") {
                continue; // preload and free length: stressed by intention
            }
            let mut nodes = moved(&mut rng, &kind.x, 0.0);
            let (v, omega) = (vector(&mut rng, 1.0), vector(&mut rng, 1.0));
            for node in &mut nodes {
                node.omega = omega;
                node.v = v + omega.cross(&node.x);
            }
            for f in kind.forces(&nodes) {
                assert!(f.iter().all(|c| c.abs() < 1e-12), "{name}: {f:?}");
            }
        }
    }
}

/// Internal forces have no resultant and turn with the element, whatever it remembers.
#[test]
fn forces_balance_and_turn_with_the_element() {
    let mut rng = StdRng::seed_from_u64(9);
    for _ in 0..20 {
        for kind in strained(&mut rng, 1.0) {
            let name = &kind.name;
            if name.contains("heated") {
                continue; // numbers of temperature do not turn, and their forces are none in space
            }
            let along = name.contains("direction");
            let nodes = moved(&mut rng, &kind.x, 0.3);
            let F = kind.forces(&nodes);
            let (mut force, mut moment) = (Vec3::zeros(), Vec3::zeros());
            for (node, f) in nodes.iter().zip(&F) {
                let (f, m) = (Vec3::new(f[0], f[1], f[2]), Vec3::new(f[3], f[4], f[5]));
                force += f;
                moment += node.x.cross(&f) + m;
            }
            // A slack rope has no force at all.
            let size = F.iter().flatten().fold(f64::MIN_POSITIVE, |m, c| m.max(c.abs()));
            assert!(force.norm() < 1e-13 * size * 10.0, "{name}: {force}");
            assert!(along || moment.norm() < 1e-13 * size * 100.0, "{name}: {moment}");

            if !along {
                let q = turn(&mut rng);
                let R = rotation::matrix(&q);
                let shift = vector(&mut rng, 3.0);
                let turned: Vec<Node> = nodes
                    .iter()
                    .map(|n| Node {
                        x: R * n.x + shift,
                        rotation: q * n.rotation,
                        v: R * n.v,
                        omega: R * n.omega,
                        ..*n
                    })
                    .collect();
                for (a, b) in kind.forces(&turned).iter().zip(&F) {
                    for i in [0, 3] {
                        let (a, b) = (Vec3::new(a[i], a[i + 1], a[i + 2]), Vec3::new(b[i], b[i + 1], b[i + 2]));
                        // Rounding of positions of ten, times stiffnesses of sixty.
                        assert!((a - R * b).norm() < 1e-12 * size.max(1.0), "{name}");
                    }
                }
            }
        }
    }
}

/// Without velocities there is no damping and the energy is a potential, as long as nothing yields: soft elements make a past
/// for firm ones.
#[test]
fn forces_have_a_potential_while_nothing_yields() {
    for round in 0..8 {
        let soft = strained(&mut StdRng::seed_from_u64(round), 1.0);
        let mut rng = StdRng::seed_from_u64(round);
        for (mut kind, soft) in kinds(&mut rng, 1e6).into_iter().zip(soft) {
            kind.past = soft.past;
            let name = &kind.name;
            let mut nodes = moved(&mut rng, &kind.x, 0.3);
            for node in &mut nodes {
                node.v = Vector3::zeros();
                node.omega = Vector3::zeros();
            }
            let F = kind.forces(&nodes);
            let size = F.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
            let h = 1e-5; // truncation h² ~ 1e-10 and cancellation 1e-16/h ~ 1e-11, relative
            for a in 0..nodes.len() {
                for dof in 0..6 {
                    let energy = |h: f64| {
                        let mut nodes = nodes.clone();
                        nudge(&mut nodes[a], dof, h);
                        kind.block.energy(&kind.now(&nodes))
                    };
                    let slope = (energy(h) - energy(-h)) / (2.0 * h);
                    assert!((F[a][dof] - slope).abs() < 1e-7 * size.max(1.0), "{name}: {} {slope}", F[a][dof]);
                }
            }
        }
    }
}

/// A motion that is remembered is where it was: the same forces with no time gone by, nothing more to remember, nothing
/// more spent. What was spent was lost.
#[test]
fn what_is_remembered_is_the_motion() {
    let mut rng = StdRng::seed_from_u64(13);
    let mut lost = 0.0;
    for _ in 0..8 {
        for kind in strained(&mut rng, 1.0) {
            let name = &kind.name;
            let nodes = moved(&mut rng, &kind.x, 0.15);
            let F = kind.forces(&nodes);
            let (history, spent) = kind.update_history(&nodes);
            assert!(history.iter().all(|h| h.is_finite()), "{name}");
            assert!(spent.plastic >= 0.0 && spent.viscous >= 0.0, "{name}: {spent:?}");
            lost += spent.plastic;
            let again = Configuration { nodes: &nodes, history: &history, dt: 0.0, previous: None };
            // The return ends 1e-14 from the yield surface; the tangent of a fibre is no larger than E, the sum not than F.
            let size = F.iter().flatten().fold(1.0f64, |m, c| m.max(c.abs()));
            for (a, b) in forces(&*kind.block, &again).iter().flatten().zip(F.iter().flatten()) {
                assert!((a - b).abs() < 1e-11 * size, "{name}: {a} {b}");
            }
            let mut more = history.clone();
            let spent = kind.block.update_history(&again, 1.0, &mut more);
            let amount = spent.plastic + spent.viscous + spent.stored.abs();
            assert!(amount < 1e-11 * size, "{name}: {spent:?}");
            let strain = |past: &[f64]| kind.block.plastic_strain(0, past);
            let (first, second, third) = (strain(&kind.past), strain(&history), strain(&more));
            assert!(first <= second && (third - second).abs() < 1e-12 * (1.0 + second), "{name}: {second} {third}");
        }
    }
    assert!(lost > 1.0, "{lost}");
}

/// Before it yields a beam is the elastic beam of its section. That of two nodes goes without MacNeal's correction.
#[test]
fn firm_beams_are_elastic_beams() {
    fn compare<const N: usize>(rng: &mut StdRng) {
        for (_, law) in materials(rng, 1e6) {
            for damping in [0.0, 0.3] {
                let mut firm = Vec::new();
                let seed = rng.random();
                let mut twin = StdRng::seed_from_u64(seed);
                yielding_beams::<N>(&mut StdRng::seed_from_u64(seed), "firm", &law, damping, &mut firm);
                for kind in firm {
                    let frame = rotation::matrix(&turn(&mut twin));
                    let block = beam::<N>(&frame, vector(&mut twin, 2.0), damping);
                    if !kind.name.contains(&format!("Gauss {}", N - 1)) {
                        continue; // more points than the elastic beam has
                    }
                    let elastic = Kind { name: String::new(), block, x: kind.x.clone(), past: vec![] };
                    let nodes = moved(rng, &kind.x, 0.2);
                    let (F, G) = (kind.forces(&nodes), elastic.forces(&nodes));
                    let size = G.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
                    for (f, g) in F.iter().flatten().zip(G.iter().flatten()) {
                        assert!((f - g).abs() < 1e-13 * size, "{}: {f} {g}", kind.name); // rounding of six fibres
                    }
                    let [K, E] = [&kind, &elastic].map(|kind| kind.tangent(&nodes, 0.7, Moduli::Algorithmic));
                    assert!((&K - &E).amax() < 1e-13 * E.amax(), "{}", kind.name);
                    let [u, v] = [&kind, &elastic].map(|kind| kind.block.energy(&kind.now(&nodes)));
                    assert!((u - v).abs() < 1e-13 * v, "{}: {u} {v}", kind.name);
                }
            }
        }
    }
    let mut rng = StdRng::seed_from_u64(14);
    for _ in 0..5 {
        compare::<3>(&mut rng);
        compare::<4>(&mut rng);
        compare::<5>(&mut rng);
    }
}

/// The power of the damping is what the rate-dependent part of the forces takes from the motion. (A rope may go slack by it.)
#[test]
fn damping_takes_power() {
    let mut rng = StdRng::seed_from_u64(10);
    for kind in strained(&mut rng, 1.0) {
        let name = &kind.name;
        if name == "bearing" || name.contains("pendulum") {
            continue; // springs feed whirl, see `a_bearing_keeps_its_balance_of_energy`; friction at any speed counts as plastic
        }
        let nodes = moved(&mut rng, &kind.x, 0.2);
        let still: Vec<Node> = nodes.iter().map(|n| Node { v: Vec3::zeros(), omega: Vec3::zeros(), ..*n }).collect();
        let (F, F0) = (kind.forces(&nodes), kind.forces(&still));
        let mut power = 0.0;
        for ((node, f), f0) in nodes.iter().zip(&F).zip(&F0) {
            for i in 0..3 {
                power += (f[i] - f0[i]) * node.v[i] + (f[3 + i] - f0[3 + i]) * node.omega[i];
            }
        }
        let taken = kind.block.damping_power(&kind.now(&nodes));
        let taut = F.iter().flatten().any(|f| *f != 0.0);
        // Rounding of ~100 terms.
        assert!(!taut || (power - taken).abs() < 1e-11 * (1.0 + taken), "{name}: {power} {taken}");
        // A rope that goes slack by its damper loses the energy that it stores.
        assert!(taken >= 0.0 && (!taut || (taken > 0.0) == kind.block.is_damped()), "{name}: {taken}");
    }
}

/// The power of all forces of a bearing is the rate of its energy and the power that counts as damping: over matrices that change with the
/// speed, and with a skew part. Differences over a time that rotates and speeds up its nodes.
#[test]
fn a_bearing_keeps_its_balance_of_energy() {
    let mut rng = StdRng::seed_from_u64(23);
    for _ in 0..20 {
        let kind = elastic(&mut rng).into_iter().find(|kind| kind.name == "bearing").expect("a bearing");
        let mut nodes = moved(&mut rng, &kind.x, 0.2);
        nodes.iter_mut().for_each(|node| node.alpha = vector(&mut rng, 2.0));
        let after = |h: f64| {
            let moved = |node: &Node| {
                let mut node = *node;
                node.x += h * node.v;
                // The rotation of a steady spin, and what its acceleration adds to second order.
                node.rotation = rotation::exp(&(h * node.omega + 0.5 * h * h * node.alpha)) * node.rotation;
                node.omega += h * node.alpha;
                node
            };
            nodes.iter().map(moved).collect::<Vec<Node>>()
        };
        let energy = |h: f64| kind.block.energy(&kind.now(&after(h)));
        let h = 1e-5;
        let rate = (energy(h) - energy(-h)) / (2.0 * h);
        let power: f64 = nodes
            .iter()
            .zip(kind.forces(&nodes))
            .map(|(node, f)| (0..3).map(|i| f[i] * node.v[i] + f[3 + i] * node.omega[i]).sum::<f64>())
            .sum();
        let taken = kind.block.damping_power(&kind.now(&nodes));
        // Differences of h² and of rounding over h, of powers up to a hundred.
        assert!((power - rate - taken).abs() < 1e-6 * (1.0 + power.abs()), "{power} {rate} {taken}");
    }
}

/// Two nodes: the small-strain stiffness of the exact (Timoshenko) beam with coupled bending, by its flexibility.
#[test]
fn two_node_beam_has_the_exact_linear_stiffness() {
    let x = [Vec3::zeros(), Vec3::new(1.7, 0.0, 0.0)];
    let (length, C) = (1.7, section());
    let frame = Mat3::identity();
    let one = [BeamGeometry { nodes: &[0, 1], frame: &frame, stiffness: &C, varied: None }];
    let beam = elastic_beams(1, &one, BeamSetting { x: &x, damping: 0.0, heat: &Heat::NONE });
    let nodes = x.map(Node::at_rest);
    let mut K = [0.0; 144];
    beam.tangent(0, &Configuration::of(&nodes), 0.0, Moduli::Algorithmic, &mut K);
    // Free end under a unit wrench: strains ε(x) = C⁻¹ σ(x), tip motion by integrating them (three Gauss points: exact).
    let mut C6 = nalgebra::Matrix6::zeros();
    C6.fixed_view_mut::<3, 3>(0, 0).copy_from(&C.N);
    C6.fixed_view_mut::<3, 3>(3, 3).copy_from(&C.M);
    C6.fixed_view_mut::<3, 3>(0, 3).copy_from(&C.NM);
    C6.fixed_view_mut::<3, 3>(3, 0).copy_from(&C.NM.transpose());
    let inverse = C6.try_inverse().unwrap();
    let (points, weights) = rdsolve::math::quadrature::gauss(3);
    let mut flexibility = nalgebra::Matrix6::<f64>::zeros();
    for (xi, w) in points.iter().zip(weights) {
        let arm = 0.5 * length * (1.0 - xi);
        let mut to_section = nalgebra::Matrix6::identity();
        to_section.fixed_view_mut::<3, 3>(3, 0).copy_from(&rdsolve::math::skew(&Vec3::new(arm, 0.0, 0.0)));
        flexibility += 0.5 * length * *w * to_section.transpose() * inverse * to_section;
    }
    let tip = nalgebra::Matrix6::from_fn(|i, j| K[(6 + i) * 12 + 6 + j]);
    let product = tip * flexibility;
    assert!((product - nalgebra::Matrix6::identity()).amax() < 1e-12, "{product}"); // condition ~ 100
}

/// Displacements of 1e-12 of the element: forces are K u to the digits of u, not to those of positions, which would be four.
#[test]
fn small_displacements_keep_their_digits() {
    let mut rng = StdRng::seed_from_u64(11);
    let straight = |kind: &Kind| ["beam", "damped beam", "bar"].iter().any(|name| kind.name.starts_with(name));
    for kind in elastic(&mut rng).iter().filter(|kind| straight(kind)) {
        let rest: Vec<Node> = kind.x.iter().map(|x| Node::at_rest(*x)).collect();
        let d = kind.block.dofs();
        let (mut nodes, mut u) = (rest.clone(), Vec::new());
        for (node, x) in nodes.iter_mut().zip(&kind.x) {
            let (by, turn) = (vector(&mut rng, 1e-12), vector(&mut rng, 1e-12));
            node.place(x, &Vec3::zeros(), &by);
            node.rotation = rotation::exp(&turn);
            u.extend([by, turn].iter().flatten().take(d));
        }
        let K = kind.tangent(&rest, 0.0, Moduli::Elastic);
        let expected = &K * nalgebra::DVector::from_vec(u);
        let got = kind.forces(&nodes);
        for (row, expected) in expected.iter().enumerate() {
            let off = (got[row / d][row % d] - expected).abs() / K.amax();
            // What is of second order in u, 1e-24; positions would leave 1e-16.
            assert!(off < 1e-23, "{}, row {row}: {off:e}", kind.name);
        }
    }
}

/// Links that deteriorate and that pinch, over random motions: the tangent against differences, forces in balance, and a memory that is the motion.
#[test]
fn links_that_deteriorate_and_pinch() {
    let mut rng = StdRng::seed_from_u64(41);
    let deteriorating = Deteriorating {
        stiffness: 25.0,
        yield_force: 1.0,
        post_yield_stiffness: 4.0,
        capping: 0.1,
        post_capping: 0.4,
        residual: 0.1,
        ultimate: f64::INFINITY,
        capacities: [3.0, 4.0, 5.0],
        exponent: 1.0,
    };
    let reloading = Reloading { force: 0.4, elongation: 0.6, damage: [0.02, 0.05], unloading: 0.2 };
    let pinching = Pinching::new(&[[0.04, 1.0], [0.1, 1.8], [0.2, 1.0]], reloading).unwrap();
    let laws =
        [("deteriorating link", PathLaw::Deteriorating(deteriorating)), ("pinching link", PathLaw::Pinching(pinching))];
    let (mut entries, mut corners) = (0, 0);
    for mut kind in links_with_memory(&mut rng, &laws) {
        for _ in 0..30 {
            let nodes = moved(&mut rng, &kind.x, 0.15);
            let (F, K) = (kind.forces(&nodes), kind.tangent(&nodes, 0.0, Moduli::Algorithmic));
            let size = F.iter().flatten().fold(1.0f64, |size, f| size.max(f.abs()));
            assert!((0..3).all(|i| (F[0][i] + F[1][i]).abs() < 1e-13 * size), "{}", kind.name);
            for column in 0..6 {
                let at = |h: f64| {
                    let mut nodes = nodes.clone();
                    nudge(&mut nodes[column / 3], column % 3, h);
                    kind.forces(&nodes)
                };
                let difference = |h: f64, row: usize| (at(h)[row / 3][row % 3] - at(-h)[row / 3][row % 3]) / (2.0 * h);
                for row in 0..6 {
                    let (whole, half) = (difference(1e-5, row), difference(5e-6, row));
                    entries += 1;
                    if (whole - half).abs() > 1e-6 * K.amax().max(1.0) {
                        corners += 1;
                        continue;
                    }
                    // Truncation of h² and cancellation of 1e-16/h of forces up to ten times the stiffness.
                    assert!((K[(row, column)] - half).abs() < 1e-7 * K.amax().max(1.0), "{} {row} {column}", kind.name);
                }
            }
            let (history, _) = kind.update_history(&nodes);
            kind.past = history;
            for (a, b) in kind.forces(&nodes).iter().flatten().zip(F.iter().flatten()) {
                // Rounding of positions of ten, times a stiffness of 25.
                assert!((a - b).abs() < 1e-12 * size, "{}: {a} {b}", kind.name);
            }
        }
    }
    assert!(corners * 100 < entries, "{corners} of {entries}");
}
