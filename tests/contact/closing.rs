//! Contacts that close or open within a load step: the work of loads is then not that of the mean of its ends, and the balance of energy knows.

use super::go;
use rdsolve::solve::Frame;

/// External work, energy of contacts, dissipated by friction, what the balance misses.
fn watch(frame: &Frame) -> Vec<f64> {
    let e = frame.derived.energy.expect("energies");
    vec![e.external, e.contact, e.friction, e.numerical]
}

fn steps(step: f64, tables: &str) -> String {
    format!(
        "analysis = {{ kind = \"static\", end_time = 2.0, time_step = {step:?} }}\noutput = {{ energy = true, contacts = true, every = 1 }}\n\
         materials.steel = {{ model = \"elastic\", youngs_modulus = 200e9, poisson_ratio = 0.3, density = 7850.0 }}\n\
         sections.round = {{ shape = \"tube\", radius = 0.02, thickness = 0.02 }}\n\
         amplitudes.press = {{ kind = \"table\", points = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]] }}\n{tables}"
    )
}

/// A cantilever of 1 m along x whose free end is b.
const CANTILEVER: &str = "points = { a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0], c = [0.9, -0.5, -0.041], d = [0.9, 0.5, -0.041] }\n\
    [[beams]]\nname = \"beam\"\npath = [\"a\", \"b\"]\nelements = 4\nmaterial = \"steel\"\nsection = \"round\"\norientation = [0.0, 0.0, 1.0]\n\
    [[supports]]\nat = \"a\"\nfix = \"all\"\n\
    [[loads]]\nat = \"b\"\nforce = [0.0, 0.0, -500.0]\namplitude = \"press\"\n";

const STOP: &str = "[[contacts]]\nname = \"stop\"\nsurface = { shape = \"plane\", point = [0.0, 0.0, -0.001], normal = [0.0, 0.0, 1.0] }\n\
    with = \"b\"\nstiffness = 1e6\n";

/// A bar that lies across under the cantilever, a millimetre from it.
const ACROSS: &str = "[[beams]]\nname = \"across\"\npath = [\"c\", \"d\"]\nelements = 3\nmaterial = \"steel\"\nsection = \"round\"\norientation = [0.0, 0.0, 1.0]\n\
    [[supports]]\nat = [\"c\", \"d\"]\nfix = \"all\"\n\
    [[contacts]]\nname = \"on\"\nsurface = { part = \"across\" }\nwith = \"beam\"\nstiffness = 1e6\n";

/// A body of this shape on a spring over a thing, pressed down on it by 500 N from a millimetre above.
fn on_a_spring(shape: &str, height: f64, under: &str) -> String {
    format!(
        "bodies = [{{ name = \"one\", center = [0.03, 0.02, {height:?}], shape = {shape}, mass = 1.0 }}]\n\
         points = {{ p = [-0.5, -0.5, 0.0], q = [0.5, -0.5, 0.0], r = [0.5, 0.5, 0.0], s = [-0.5, 0.5, 0.0], up = [0.03, 0.02, 2.0] }}\n\
         [[links]]\nname = \"spring\"\nfrom = {{ node = \"up\" }}\nto = {{ body = \"one\" }}\nstiffness = 1e5\n\
         [[supports]]\nat = \"up\"\nfix = \"all\"\n\
         [[supports]]\nat = \"one\"\nfix = [\"ux\", \"uy\", \"rx\", \"ry\", \"rz\"]\n\
         [[loads]]\nat = \"one\"\nforce = [0.0, 0.0, -500.0]\namplitude = \"press\"\n{under}"
    )
}

const SHEET: &str = "[[shells]]\nname = \"sheet\"\ncorners = [\"p\", \"q\", \"r\", \"s\"]\nelements = 4\nthickness = 0.02\nmaterial = \"steel\"\n\
    [[supports]]\nat = [\"sheet.edge1\", \"sheet.edge3\"]\nfix = \"all\"\n\
    [[contacts]]\nname = \"on\"\nsurface = { part = \"sheet\" }\nwith = \"one\"\nstiffness = 1e6\n";

const BLOCK: &str = "[[contacts]]\nname = \"on\"\nsurface = { shape = \"box\", center = [0.0, 0.0, 0.0], size = [1.0, 1.0, 0.02] }\nwith = \"one\"\n\
    stiffness = 1e6\n";

/// A gap that closes in one step and opens in the next leaves nothing in the balance, whatever touches: a point, a beam across a beam, a ball on a
/// sheet, a box on a box. So does what begins pressed in, and gives way in the first step.
#[test]
fn a_gap_that_closes_in_a_step_is_in_the_balance() {
    let ball = "{ kind = \"sphere\", radius = 0.1 }";
    let cube = "{ kind = \"box\", size = [0.2, 0.2, 0.2] }";
    for (what, scene) in [
        ("point", format!("{CANTILEVER}{STOP}")),
        ("beams", format!("{CANTILEVER}{ACROSS}")),
        ("ball", on_a_spring(ball, 0.111, SHEET)),
        ("box", on_a_spring(cube, 0.111, BLOCK)),
        ("pressed ball", on_a_spring(ball, 0.1095, SHEET)),
        ("pressed box", on_a_spring(cube, 0.1095, BLOCK)),
    ] {
        for step in [1.0, 0.25] {
            let done = go(&steps(step, &scene), &mut watch);
            let most = done.rows.iter().map(|row| row[0].abs()).fold(0.0, f64::max);
            let pressed = done.rows.iter().map(|row| row[1]).fold(0.0, f64::max);
            println!("{what} {step}: {most} {pressed} {:?}", done.rows);
            assert!(pressed > 1e-2 * most, "{what}: {pressed} of {most}");
            // What bends and turns in a step is not quite linear; of the gap half a part in ten was missed.
            let missed = done.rows.iter().map(|row| row[3].abs()).fold(0.0, f64::max);
            assert!(missed < 1e-4 * most, "{what} {step}: {missed} of {most}");
        }
    }
}

/// The same with friction, which begins where the gap closes.
#[test]
fn friction_after_a_gap_is_in_the_balance() {
    let aslant = CANTILEVER.replace("force = [0.0, 0.0, -500.0]", "force = [0.0, 150.0, -500.0]");
    let rough = STOP.replace("stiffness = 1e6", "stiffness = 1e6\nfriction = 0.2");
    let done = go(&steps(0.25, &format!("{aslant}{rough}")), &mut watch);
    let last = done.rows.last().unwrap();
    let most = done.rows.iter().map(|row| row[0]).fold(0.0, f64::max);
    println!("{most} {last:?}");
    let missed = done.rows.iter().map(|row| row[3].abs()).fold(0.0, f64::max);
    assert!(last[2] > 1e-3 * most && missed < 1e-3 * most, "{missed} of {most}: {last:?}");
}

/// What a structure misses is still told where a contact closes: a slender beam held at both ends, whose force grows with the cube of its way.
#[test]
fn what_is_not_of_the_contact_is_still_missed() {
    let beam = "points = { l = [-1.0, 0.0, 0.0], m = [0.0, 0.0, 0.0], r = [1.0, 0.0, 0.0] }\n\
                [[beams]]\nname = \"beam\"\npath = [\"l\", \"m\", \"r\"]\nelements = 4\nmaterial = \"steel\"\nsection = \"round\"\n\
                orientation = [0.0, 0.0, 1.0]\n\
                [[supports]]\nat = [\"l\", \"r\"]\nfix = \"all\"\n\
                [[supports]]\nat = \"m\"\nmotion = { uz = { amplitude = \"press\", scale = -0.2 } }\n";
    let stop = "[[contacts]]\nname = \"stop\"\nsurface = { shape = \"plane\", point = [0.0, 0.0, -0.16], normal = [0.0, 0.0, 1.0] }\n\
                with = \"m\"\nstiffness = 1e7\n";
    let missed = |scene: &str| {
        let text = steps(1.0, scene).replace("end_time = 2.0", "end_time = 1.0");
        go(&text, &mut watch).rows.last().unwrap().clone()
    };
    let (alone, stopped) = (missed(beam), missed(&format!("{beam}{stop}")));
    println!("{alone:?} {stopped:?}");
    // The mean of the ends counts up to twice what is stored under the cube of the way: 17 %, and 8 in the three steps that the contact asks for.
    assert!(alone[3] > 0.1 * alone[0] && stopped[1] > 7900.0, "{alone:?} {stopped:?}");
    assert!(stopped[3] > 0.05 * stopped[0], "{alone:?} {stopped:?}");
}
