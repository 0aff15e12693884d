//! Beams eight side by side have the bits of one after the other.

use crate::support::random::{turn, vector};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::elements::beam::{BeamGeometry, BeamSetting, FibreGroup, FibreModel, IntegrationRule, elastic_beams};
use rdsolve::elements::heat::Heat;
use rdsolve::elements::{ElementBlock, Moduli};
use rdsolve::materials::uniaxial::UniaxialLaw;
use rdsolve::materials::{FailureCriterion, Hardening, MaterialLaw};
use rdsolve::math::{Mat3, Vec3, quadrature, rotation};
use rdsolve::sections::{Fibre, Stiffness};
use rdsolve::state::{Configuration, Node};

/// Two packs, and more than half a pack.
const COUNT: usize = 22;

/// A chain of elements along x whose sections and axes differ.
struct Chain<const N: usize> {
    x: Vec<Vec3>,
    nodes: Vec<[usize; N]>,
    frames: Vec<Mat3>,
    sections: Vec<Stiffness>,
}

impl<const N: usize> Chain<N> {
    fn new(rng: &mut StdRng) -> Self {
        let (at, _) = quadrature::lobatto(N);
        let mut x = vec![vector(rng, 2.0)];
        for e in 0..COUNT {
            let start = x[e * (N - 1)];
            x.extend(at[1..].iter().map(|xi| start + Vec3::x() * (0.3 + 0.01 * e as f64) * (1.0 + xi)));
        }
        let about = |angle: f64| rotation::matrix(&rotation::exp(&Vec3::new(angle, 0.0, 0.0)));
        let section = |e: usize| {
            let mut C = Stiffness::general(30.0, [9.0, 7.0], 2.0, [3.0, 5.0 + 0.1 * e as f64], 1.0, [1.0; 3]);
            if e % 3 == 1 {
                C.NM = Mat3::new(0.0, 0.0, 0.0, 0.6, 0.0, 0.0, -0.4, 0.0, 0.0);
            }
            C
        };
        Chain {
            x,
            nodes: (0..COUNT).map(|e| std::array::from_fn(|a| e * (N - 1) + a)).collect(),
            frames: (0..COUNT).map(|e| about(0.3 * e as f64)).collect(),
            sections: (0..COUNT).map(section).collect(),
        }
    }

    fn block(
        &self,
        elements: std::ops::Range<usize>,
        yielding: Option<&FibreModel>,
        damping: f64,
    ) -> Box<dyn ElementBlock> {
        let elements = elements.map(|e| BeamGeometry {
            nodes: &self.nodes[e],
            frame: &self.frames[e],
            stiffness: &self.sections[if yielding.is_some() { 0 } else { e }],
            varied: None,
        });
        let elements: Vec<BeamGeometry> = elements.collect();
        let setting = BeamSetting { x: &self.x, damping, heat: &Heat::NONE };
        match yielding {
            None => elastic_beams(N - 1, &elements, setting),
            Some(model) => model.beams(N - 1, &elements, setting),
        }
    }

    /// Nodes moved far as a whole, and against each other the more the farther along the chain.
    fn moved(&self, rng: &mut StdRng, most: f64) -> Vec<Node> {
        let (q, shift) = (turn(rng), vector(rng, 3.0));
        let R: Mat3 = rotation::matrix(&q);
        let mut node = |(i, x): (usize, &Vec3)| {
            let strain = most * i as f64 / self.x.len() as f64;
            let sign = if rng.random_range(0.0..1.0) < 0.5 { -1.0 } else { 1.0 };
            Node {
                rotation: rotation::exp(&vector(rng, strain)) * q * sign,
                low: vector(rng, 1e-17),
                v: vector(rng, 1.0),
                omega: vector(rng, 1.0),
                ..Node::at_rest(R * (x + vector(rng, strain)) + shift)
            }
        };
        self.x.iter().enumerate().map(&mut node).collect()
    }
}

fn agrees<const N: usize>(rng: &mut StdRng) {
    let chain = Chain::<N>::new(rng);
    let fibres = [-0.3, 0.1, 0.4].map(|y| Fibre { area: 0.3, y, z: 0.5 * y, shear: [[0.9, 0.0, -y], [0.1, 0.9, y]] });
    let law = |failing: f64| {
        let law = MaterialLaw::new(20.0, 0.3, Hardening::Linear { yield_stress: 1.0, modulus: 3.0 }, 0.0, None);
        if failing > 0.0 { law.failing_at(FailureCriterion::at(failing)) } else { law }
    };
    let model = |failing| FibreModel {
        groups: vec![FibreGroup { law: UniaxialLaw::Plastic(law(failing)), fibres: fibres.to_vec() }],
        shear: N.is_multiple_of(2),
        rule: IntegrationRule::Gauss,
        points: N.max(3),
    };
    for yielding in [None, Some(model(0.0)), Some(model(0.03))] {
        for damping in [0.0, 0.3] {
            let block = chain.block(0..COUNT, yielding.as_ref(), damping);
            let (first, now, before) = (chain.moved(rng, 0.3), chain.moved(rng, 0.05), chain.moved(rng, 0.05));
            let mut history = vec![0.0; block.history()];
            let past = Configuration { nodes: &first, history: &vec![0.0; block.history()], dt: 1.0, previous: None };
            block.update_history(&past, 1.0, &mut history);
            let failed = (0..COUNT).filter(|&e| block.has_failed(e, &history)).count();
            assert!(failed < COUNT && (failed > 0) == block.can_fail(), "{failed} have failed");
            for previous in [None, Some(&before[..])] {
                let now = Configuration { nodes: &now, history: &history, dt: 1.0, previous };
                for moduli in [Moduli::Algorithmic, Moduli::Elastic] {
                    tangents_agree::<N>(&*block, &now, moduli);
                }
                let mut together = vec![[0.0; 6]; chain.x.len()];
                block.subtract_forces(&now, &mut together);
                let (mut alone, each) = (vec![[0.0; 6]; chain.x.len()], block.history() / COUNT);
                for e in 0..COUNT {
                    let history = &history[e * each..(e + 1) * each];
                    let one = chain.block(e..e + 1, yielding.as_ref(), damping);
                    one.subtract_forces(&Configuration { history, ..now }, &mut alone);
                }
                assert_eq!(together, alone);
            }
        }
    }
}

fn tangents_agree<const N: usize>(block: &dyn ElementBlock, now: &Configuration, moduli: Moduli) {
    let length = 36 * N * N;
    for from in [0, 8, COUNT - 3] {
        let mut all = vec![f64::NAN; (COUNT - from) * length];
        block.tangents(from, now, 0.7, moduli, &mut all);
        for (e, together) in (from..).zip(all.chunks(length)) {
            let mut alone = vec![f64::NAN; length];
            block.tangent(e, now, 0.7, moduli, &mut alone);
            assert_eq!(together, alone, "{N} nodes, element {e}, from {from}");
        }
    }
}

/// Forces and tangents of all orders: elastic with sections that couple forces and moments or do not, with fibres that yield and that
/// fail, damped and not, with stresses of the iterate before; whole packs and parts of one, from any element on.
#[test]
fn beams_side_by_side_are_those_of_one_after_the_other() {
    let mut rng = StdRng::seed_from_u64(21);
    agrees::<2>(&mut rng);
    agrees::<3>(&mut rng);
    agrees::<4>(&mut rng);
    agrees::<5>(&mut rng);
}
