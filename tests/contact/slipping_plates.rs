//! Bolted plates that slip in load steps, with nodes that lie over each other and with nodes that do not.

use super::go;
use rdsolve::math::rotation::log;
use rdsolve::solve::{Frame, Outcome};

/// Two plates of a `thickness` overlap by 80 mm. A bolt presses them together by 20 kN, then one is drawn off the other by 0.5 mm; its mesh is moved by
/// `shift`.
fn plates(shift: f64, thickness: &str, stiffness: &str) -> String {
    let deck = r#"
        analysis = { kind = "static", end_time = 2.0, time_step = 0.1 }
        materials.steel = { model = "elastic", youngs_modulus = 210e9, poisson_ratio = 0.3 }
        bodies = [{ name = "head", center = [0.0, 0.0, 0.008] }, { name = "nut", center = [0.0, 0.0, 0.0] }]
        attachments = [
            { body = "head", nodes = ["upper"], within = 0.021 },
            { body = "nut", nodes = ["lower"], within = 0.021 },
        ]
        loads = [
            { at = "head", force = [0.0, 0.0, -20e3], amplitude = "tight" },
            { at = "nut", force = [0.0, 0.0, 20e3], amplitude = "tight" },
        ]
        contacts = [{ name = "plates", surface = { part = "lower" }, with = "upper", stiffness = 1e9, friction = 0.2 }]
        [output]
        contacts = true
        [amplitudes]
        tight = { kind = "ramp", start = 0.0, end = 1.0 }
        pull = { kind = "ramp", start = 1.0, end = 2.0 }
        [points]
        l1 = [-0.12, -0.04, 0.0]
        l2 = [0.04, -0.04, 0.0]
        l3 = [0.04, 0.04, 0.0]
        l4 = [-0.12, 0.04, 0.0]
        u1 = [LEFT, -0.04, 0.008]
        u2 = [RIGHT, -0.04, 0.008]
        u3 = [RIGHT, 0.04, 0.008]
        u4 = [LEFT, 0.04, 0.008]
        [[shells]]
        name = "lower"
        corners = ["l1", "l2", "l3", "l4"]
        elements = [8, 4]
        thickness = 0.008
        material = "steel"
        [[shells]]
        name = "upper"
        corners = ["u1", "u2", "u3", "u4"]
        elements = [8, 4]
        thickness = 0.008
        material = "steel"
        [[supports]]
        at = "lower.edge4"
        fix = "all"
        [[supports]]
        at = "upper.edge2"
        fix = ["uy"]
        motion = { ux = { amplitude = "pull", scale = 0.0005 } }
        "#;
    let deck = deck.replace("LEFT", &format!("{:?}", -0.04 + shift)).replace("RIGHT", &format!("{:?}", 0.12 + shift));
    deck.replace("0.008", thickness).replace("1e9", stiffness)
}

/// The force is μ N as long as the plates slip, less what their slope of 0.5 % in the joint takes off. It is the same for both meshes, no step is
/// shortened while they slip, and the energies close.
#[test]
fn bolted_plates_slip_alike_on_meshes_that_meet_and_on_others() {
    let forces = [0.0, 0.0025].map(|shift| {
        let done = go(&plates(shift, "0.008", "1e9"), &mut |frame: &Frame| {
            let (contact, energy) = (&frame.derived.contacts[0], frame.derived.energy.expect("energies"));
            vec![frame.state.time, contact.f.x, energy.friction, energy.numerical]
        });
        assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
        let pulled: Vec<_> = done.rows.iter().filter(|row| row[0] > 1.0 + 1e-9).collect();
        assert_eq!(pulled.len(), 10, "steps are shortened");
        for row in &pulled {
            // μ cos θ − sin θ at θ = 0.005 is 0.975 μ.
            assert!(row[1] > 0.96 * 4000.0 && row[1] < 4000.0, "{row:?}");
        }
        let last = pulled[9];
        // At each fold the energy jumps by 20 kN times its angle of 1e-3 times less than a step of 50 µm.
        assert!(last[2] > 1.7 && last[3].abs() < 3e-3 * last[2], "{last:?}");
        pulled.iter().map(|row| row[1]).collect::<Vec<f64>>()
    });
    for (one, other) in forces[0].iter().zip(&forces[1]) {
        // Measured 5e-4 as they break loose, then 1.5e-4: the meshes differ in where the points press.
        assert!((one - other).abs() < 1e-3 * one, "{forces:?}");
    }
}

/// Plates of 4 mm on a contact of 1e10, which slips after 8 nm: no step is shortened, and the resultant of all points leans by the angle of friction
/// against the normal of the joint, which turns with the nut. Beyond the nut the plate bends, the less the finer the mesh is: measured 4e-4 and 7e-5
/// as the joint breaks loose, then 1e-4 and 2e-5.
#[test]
fn thin_plates_slip_on_a_stiff_contact() {
    slip_as_a_whole(&plates(0.0025, "0.004", "1e10"), (10, 10), 6e-4);
    // On the finer mesh most points are at first touch as the bolt is tightened.
    let finer =
        plates(0.0025, "0.004", "1e10").replace("[8, 4]", "[12, 6]").replace("end_time = 2.0", "end_time = 1.2");
    slip_as_a_whole(&finer, (10, 2), 1e-4);
}

/// Runs plates, which are tightened in so many steps and pulled in so many, and compares the slip load within an angle.
fn slip_as_a_whole(deck: &str, steps: (usize, usize), within: f64) {
    let done = go(deck, &mut |frame: &Frame| {
        let f = frame.derived.contacts[0].f;
        let nut = &frame.state.nodes[frame.model.bodies[1].node];
        vec![frame.state.time, f.x.abs().atan2(f.z.abs()), log(&nut.rotation).y.abs()]
    });
    assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
    let (tightened, pulled): (Vec<_>, Vec<_>) =
        done.rows.iter().filter(|row| row[0] > 0.0).partition(|row| row[0] < 1.0 + 1e-9);
    assert_eq!((tightened.len(), pulled.len()), steps, "steps are shortened");
    for row in pulled {
        assert!((row[1] + row[2] - 0.2_f64.atan()).abs() < within, "{row:?}");
    }
}
