//! Times of plan, factor and solve: the least of many repeats. Arguments keep the structures that
//! begin with one of them: `cargo bench --bench linear -- chain sheet`. `dense` is the product of square matrices.

#[path = "../tests/structures/mod.rs"]
mod structures;

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use rdsolve::linear::{Factorization, Solver, Structure};
use std::time::Instant;
use structures::{Random, Values, chain, entries, fill, frame, quadratic_chain, sheet, slots};

/// Large factorisations are repeated at least so often.
const FEWEST: usize = 5;

/// Least seconds of one `call` over about `budget` seconds of rounds, each preceded by `prepare`.
fn least<T>(subject: &mut T, budget: f64, prepare: impl Fn(&mut T), call: impl Fn(&mut T)) -> f64 {
    let (begin, mut least, mut rounds) = (Instant::now(), f64::INFINITY, 0);
    while begin.elapsed().as_secs_f64() < budget || rounds < FEWEST {
        rounds += 1;
        prepare(subject);
        let start = Instant::now();
        call(subject);
        least = least.min(start.elapsed().as_secs_f64());
    }
    least
}

fn is_wanted(name: &str) -> bool {
    let mut filters = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).peekable();
    filters.peek().is_none() || filters.any(|filter| name.starts_with(&filter))
}

/// The rate that large factorisations are compared with.
fn dense(n: usize, threads: usize) {
    let name = format!("dense {n} /{threads}");
    if is_wanted(&name) {
        let matrix = |shift: usize| Mat::from_fn(n, n, |i, j| ((i * 7 + j * 3 + shift) % 11) as f64 - 5.0);
        let subject = &mut (Mat::zeros(n, n), matrix(0), matrix(1));
        let par = if threads > 1 { Par::rayon(threads) } else { Par::Seq };
        let seconds = least(subject, 2.0, |_| {}, |(C, A, B)| matmul(C, Accum::Replace, &*A, &*B, 1.0, par));
        let flops = 2.0 * (n as f64).powi(3);
        println!("{name:19} {:>67.2} {:>7.2} {flops:>9.2e}", seconds * 1e6, flops / seconds / 1e9);
    }
}

/// A square sheet with positions, which dissection needs.
fn placed_sheet(side: usize) -> Structure {
    let positions = (0..side * side).map(|node| [(node / side) as f64, (node % side) as f64, 0.0]).collect();
    Structure { positions, ..sheet(side, side, 6) }
}

fn measure(name: &str, structure: &Structure, kind: Factorization, values: Values, threads: usize) {
    if !is_wanted(name) {
        return;
    }
    let begin = Instant::now();
    let solver = Solver::new(structure, kind, threads).unwrap();
    let plan = begin.elapsed().as_secs_f64();
    let slots = slots(&solver, &entries(structure, values, &mut Random(6)));
    let n = structure.sizes.iter().sum();
    let subject = &mut (solver, vec![1.0; n]);
    let factor = least(subject, 0.4, |(s, _)| fill(s, &slots), |(s, _)| s.factor().unwrap());
    let solve = least(subject, 0.2, |(_, b)| b.fill(1.0), |(s, b)| s.solve(b));
    let stats = subject.0.stats();
    println!(
        "{name:19} {n:6} {:8} {:11} {:>9.1} {:>11.2} {:>9.2} {:>7.2} {:>9.2e} {:>9} {:14} {:?}",
        format!("{kind:?}"),
        format!("{values:?}"),
        plan * 1e6,
        factor * 1e6,
        solve * 1e6,
        stats.flops / factor / 1e9,
        stats.flops,
        stats.nonzeros,
        stats.ordering,
        Factorization::choose(structure),
    );
}

fn main() {
    println!(
        "{:19} {:>6} {:8} {:11} {:>9} {:>11} {:>9} {:>7} {:>9} {:>9} {:14} chosen",
        "structure", "rows", "kind", "values", "plan µs", "factor µs", "solve µs", "GF/s", "flops", "nonzeros", "order",
    );
    let small = [
        ("chain 5", chain(5, 6)),
        ("chain 20", chain(20, 6)),
        ("chain 100", chain(100, 6)),
        ("three-node chain 10", quadratic_chain(10, 6)),
        ("plane chain 20", chain(20, 3)),
        ("plane chain 200", chain(200, 3)),
        ("plane frame 30x20", frame(30, 20, 1, 3)),
        ("plane sheet 20x20", sheet(20, 20, 3)),
        ("plane sheet 40x40", sheet(40, 40, 3)),
        ("frame 3x2x2", frame(3, 2, 2, 6)),
        ("frame 5x3x3", frame(5, 3, 3, 6)),
        ("plane frame 10x5", frame(10, 5, 1, 3)),
        ("sheet 5x5", sheet(5, 5, 6)),
        ("sheet 10x10", sheet(10, 10, 6)),
        ("frame 10x4x4", frame(10, 4, 4, 6)),
        ("sheet 20x20", sheet(20, 20, 6)),
        ("frame 10x6x6", frame(10, 6, 6, 6)),
    ];
    for (name, structure) in &small {
        for values in [Values::Unsymmetric, Values::Definite] {
            measure(name, structure, Factorization::BlockLu, values, 1);
        }
        for values in [Values::Definite, Values::Indefinite] {
            measure(name, structure, Factorization::Cholesky, values, 1);
        }
    }
    let large = [
        ("frame 15x15x15", frame(15, 15, 15, 6)),
        ("frame 20x22x23", frame(20, 22, 23, 6)),
        ("large sheet 40x40", placed_sheet(40)),
        ("large sheet 100x100", placed_sheet(100)),
        ("large sheet 204x204", placed_sheet(204)),
    ];
    for threads in [1, 2] {
        [2000, 3000].into_iter().for_each(|n| dense(n, threads));
        for (name, structure) in &large {
            measure(&format!("{name} /{threads}"), structure, Factorization::Cholesky, Values::Definite, threads);
        }
    }
}
