//! Springs, friction, stops and threads along coordinates against closed forms.

use super::{IMPLICIT, all_schemes, opening, shown};
use crate::support::{read_deck, slope};
use std::f64::consts::PI;

/// A cart of 2 kg on a rail along x, with what acts along it.
fn cart(scheme: &str, time_step: f64, [end_time, interval]: [f64; 2], speed: f64, along: &str) -> String {
    opening(scheme, time_step, end_time, interval)
        + &format!(
            "[[bodies]]\nname = \"cart\"\ncenter = [0.0, 0.0, 0.0]\nmass = 2.0\ninertia = [0.1, 0.1, 0.1]\n\
             velocity = [{speed:?}, 0.0, 0.0]\n[[joints]]\nname = \"rail\"\nkind = \"prismatic\"\naxis = [3.0, 0.0, 0.0]\n\
             from = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ body = \"cart\" }}\n{along}\n"
        )
}

#[test]
fn a_spring_with_a_damper_is_its_closed_form() {
    // m ẍ + c ẋ + k (x − r) = 0
    let (k, c, r, v) = (200.0f64, 3.0f64, 0.05f64, 1.0f64);
    let decay = c / 4.0;
    let w = (k / 2.0 - decay * decay).sqrt();
    let exact = |t: f64| r + (-decay * t).exp() * (-r * (w * t).cos() + (v - decay * r) / w * (w * t).sin());
    let along = format!("stiffness = {k:?}\ndamping = {c:?}\nrest = {r:?}");
    for scheme in all_schemes() {
        let points = [4e-3, 2e-3, 1e-3].map(|dt| {
            let rows = shown(&read_deck(&cart(scheme, dt, [1.0, 0.1], v, &along)), "rail");
            (dt, rows.iter().fold(0.0f64, |most, at| most.max((at.coordinate - exact(at.time)).abs())))
        });
        println!("{scheme}: {points:?}");
        assert!(slope(&points) > 1.9 || points[2].1 < 1e-10, "{scheme}: {points:?}");
        assert!(points[2].1 < 1e-4, "{scheme}: {points:?}");
    }
}

/// Each half swing is 2 F/k shorter than the one before, and the cart stays where the spring no longer moves it.
#[test]
fn friction_ends_an_oscillation_as_coulomb_says() {
    let (k, F, v, m) = (200.0f64, 3.0f64, 1.0f64, 2.0f64);
    let half = PI * (m / k).sqrt();
    // ½ m v² = ½ k x² + F x at the first turn, a quarter swing about −F/k.
    let first = -F / k + (F * F / (k * k) + m * v * v / k).sqrt();
    let turn = (F / k / (first + F / k)).acos() * (m / k).sqrt();
    assert!(turn > 0.0 && turn < 0.5 * half);
    let mut amplitude = first;
    let mut swings = 0;
    while k * amplitude > F {
        amplitude -= 2.0 * F / k;
        swings += 1;
    }
    assert_eq!(swings, 3, "three swings before it sticks");
    let rests = -amplitude; // on the other side after an odd number
    let along = format!("stiffness = {k:?}\nfriction_force = {F:?}\nstick = 1e-6");
    for scheme in IMPLICIT.into_iter().chain(["runge-kutta"]) {
        // Springs of friction swing at 1e3 rad/s: a step resolves that where it has to.
        let dt = if scheme == "runge-kutta" { 2e-4 } else { 5e-4 };
        let rows = shown(&read_deck(&cart(scheme, dt, [6.0, 0.5], v, &along)), "rail");
        let end = rows.last().unwrap();
        println!("{scheme}: rests at {} for {rests}, {end:?}", end.coordinate);
        // The way slipped is known to the step in which slip begins or ends: first order, v dt = 5e-4 at most, and 1e-6 of stick.
        assert!((end.coordinate - rests).abs() < 5e-4, "{scheme}: {} for {rests}", end.coordinate);
        // What sticks does not creep: 3.5 s on, it swings by no more than its spring gives.
        for at in rows.iter().filter(|at| at.time > 2.0) {
            assert!((at.coordinate - end.coordinate).abs() < 3e-6, "{scheme}: {at:?} {end:?}");
        }
        let initial = 0.5 * m * v * v;
        let lost = initial - 0.5 * k * end.coordinate * end.coordinate;
        assert!((end.friction - lost).abs() < 5e-3 * initial, "{scheme}: {} of {lost}", end.friction);
        assert!(end.numerical.abs() < 5e-3 * initial, "{scheme}: {end:?}");
    }
}

/// A block that is pulled by a spring, whose other end a drive moves at constant speed: it sticks until the spring pulls as hard as
/// friction holds, then goes by v τ − v/ω sin ωτ, and comes to rest again after one period, for a moment.
#[test]
fn a_dragged_block_sticks_and_slips() {
    let (k, F, v, m) = (50.0f64, 4.0f64, 0.2f64, 2.0f64);
    let w = (k / m).sqrt();
    let breaks = F / (k * v);
    let exact = |t: f64| match t - breaks {
        tau if tau <= 0.0 => 0.0,
        tau => v * tau - v / w * (w * tau).sin(),
    };
    let end = breaks + 2.0 * PI / w;
    for scheme in IMPLICIT.into_iter().chain(["runge-kutta"]) {
        let text = opening(scheme, 5e-4, 1.6, 0.05)
            + &format!(
                "[[bodies]]\nname = \"block\"\ncenter = [0.0, 0.0, 0.0]\nmass = {m:?}\ninertia = [0.1, 0.1, 0.1]\n\
                 [[bodies]]\nname = \"puller\"\ncenter = [1.0, 0.0, 0.0]\nmass = 1.0\ninertia = [0.1, 0.1, 0.1]\n\
                 [[joints]]\nname = \"table\"\nkind = \"prismatic\"\naxis = [1.0, 0.0, 0.0]\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\n\
                 to = {{ body = \"block\" }}\nfriction_force = {F:?}\nstick = 1e-6\n\
                 [[joints]]\nname = \"drive\"\nkind = \"prismatic\"\naxis = [1.0, 0.0, 0.0]\nfrom = {{ ground = [1.0, 0.0, 0.0] }}\n\
                 to = {{ body = \"puller\" }}\nmotion = {{ velocity = {v:?} }}\n\
                 [[links]]\nname = \"spring\"\nfrom = {{ body = \"block\" }}\nto = {{ body = \"puller\" }}\nstiffness = {k:?}\n"
            );
        let rows = shown(&read_deck(&text), "table");
        let error = rows
            .iter()
            .filter(|at| at.time < end)
            .fold(0.0f64, |most, at| most.max((at.coordinate - exact(at.time)).abs()));
        println!("{scheme}: {error:e}");
        // Sticking gives 1e-6 before it slips, and swings by that when it does; steps add v dt²ω².
        assert!(error < 5e-6, "{scheme}: {error:e}");
    }
}

/// Between two stops, away and back: each impact leaves a set part of the speed, and takes the rest.
#[test]
fn stops_give_back_a_part_of_the_speed() {
    let (m, v) = (2.0f64, 1.0f64);
    for (e, tolerance) in [(1.0f64, 2e-3), (0.5, 5e-3)] {
        let along = format!("limits = [-0.1, 0.2]\nlimit_stiffness = 1e5\nrestitution = {e:?}");
        for scheme in all_schemes() {
            // An impact lasts 14e-3 and more: some hundred steps.
            let rows = shown(&read_deck(&cart(scheme, 1e-4, [1.5, 0.05], v, &along)), "rail");
            let mut speed = v;
            let mut last = 1.0;
            for at in rows.iter().filter(|at| at.coordinate > -0.1 && at.coordinate < 0.2) {
                if at.rate * last < 0.0 {
                    (speed, last) = (speed * e, at.rate);
                }
                assert!((at.rate.abs() / speed - 1.0).abs() < tolerance, "{scheme}, {e}: {at:?} for {speed}");
                let lost = 0.5 * m * (v * v - speed * speed);
                assert!((at.impact - lost).abs() < tolerance * m, "{scheme}, {e}: {at:?} for {lost}");
            }
            assert!(speed < 1.01 * v * e * e, "{scheme}, {e}: two impacts");
        }
    }
}

/// A nut on a thread falls with g/(1 + J (2π/p)²/m), and turns as it does; a drive of its angle moves it by the lead of each turn.
#[test]
fn a_nut_on_a_thread_is_its_closed_form() {
    let nut = |scheme: &str, along: &str| {
        opening(scheme, 2e-3, 1.0, 0.1)
            + "[environment]\ngravity = [0.0, 0.0, -9.81]\n[[bodies]]\nname = \"nut\"\ncenter = [0.0, 0.0, 0.0]\nmass = 2.0\n\
               inertia = [0.3, 0.3, 0.05]\n[[joints]]\nname = \"thread\"\nkind = \"screw\"\nlead = -0.6\naxis = [0.0, 0.0, 1.0]\n\
               from = { ground = [0.0, 0.0, 0.0] }\nto = { body = \"nut\" }\n"
            + along
    };
    let lever = -0.6 / (2.0 * PI);
    let a = -9.81 * 2.0 * lever / (0.05 + 2.0 * lever * lever);
    for scheme in all_schemes() {
        let rows = shown(&read_deck(&nut(scheme, "")), "thread");
        for at in &rows {
            let exact = 0.5 * a * at.time * at.time;
            // The acceleration is constant: no scheme errs in it but for the tolerance of the iteration.
            assert!((at.coordinate - exact).abs() < 1e-8 * exact.abs().max(1.0), "{scheme}: {at:?} for {exact}");
        }
        assert!(rows.last().unwrap().coordinate > 2.0 * 2.0 * PI, "more than two turns");
        let driven = "motion = { velocity = 40.0 }\ncoordinate = \"angle\"\n";
        for at in shown(&read_deck(&nut(scheme, driven)), "thread").iter().skip(1) {
            assert!((at.coordinate - 40.0 * at.time).abs() < 1e-9, "{scheme}: {at:?}");
            // At constant speed the drive bears the weight by the thread.
            assert!((at.effort - 2.0 * 9.81 * lever).abs() < 1e-5, "{scheme}: {at:?}");
        }
    }
}

/// A point mass has no rotations, whatever acts along its rail: the force lies along the axis that the other end carries.
#[test]
fn a_bead_on_a_rail_needs_no_rotary_inertia() {
    // Down a slope of 4 in 5 under g = 10, m = 3: t = 1.
    let (m, pull) = (3.0f64, 24.0f64);
    let damped = |c: f64| pull / c * (1.0 - m / c * (1.0 - (-c / m).exp()));
    for (along, exact) in [
        ("friction_force = 6.0", 0.5 * (pull - 6.0) / m),
        // It presses by 3 · 10 · 3/5; what is not known at t = 0 comes a step later.
        ("friction = 0.5", 0.5 * (pull - 9.0) / m),
        ("damping = 2.0", damped(2.0)),
        ("stiffness = 12.0", pull / 12.0 * (1.0 - 2.0f64.cos())),
        ("effort = { value = -6.0 }", 0.5 * (pull + 6.0) / m),
        ("limits = [-9.0, 9.0]\nlimit_stiffness = 1e4", 0.5 * pull / m),
    ] {
        for scheme in ["wilson-theta", "newmark", "esdirk3"] {
            let deck = opening(scheme, 1e-3, 1.0, 0.5)
                + &format!(
                    "[environment]\ngravity = [0.0, -10.0, 0.0]\n[points]\nbead = [0.0, 0.0, 0.0]\n\
                     [[masses]]\nat = \"bead\"\nmass = {m:?}\n[[joints]]\nname = \"rail\"\nkind = \"in-line\"\n\
                     axis = [3.0, -4.0, 0.0]\nfrom = {{ node = \"bead\" }}\nto = {{ ground = [0.0, 0.0, 0.0] }}\n{along}\n"
                );
            let end = shown(&read_deck(&deck), "rail").last().copied().unwrap();
            // Slip begins inside a step, and friction by a coefficient comes a step late: of first order, 1e-3 of the run. The others are of second.
            let allowed = if along.starts_with("friction") { 5e-3 } else { 1e-4 };
            assert!((end.coordinate.abs() - exact).abs() < allowed * exact, "{scheme} {along}: {end:?} for {exact}");
        }
    }
}
