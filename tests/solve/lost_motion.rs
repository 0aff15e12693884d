//! Implicit runs whose energy grows beyond what there was end, and what the message proposes works.

use assert_cmd::Command;

/// A mass on a spring, ω = 1000, by Newmark's method with `beta`, which is stable up to ω dt = 2 √(1/(1 − 4 beta)) at γ = ½.
fn oscillator(scheme: &str, time_step: f64, more: &str) -> String {
    format!(
        r#"
[analysis]
kind = "dynamic"
end_time = 0.1
time_step = {time_step:?}
[integrator]
{scheme}
[points]
p = [1.0, 0.0, 0.0]
[[masses]]
at = "p"
mass = 1.0
[[links]]
name = "spring"
from = {{ ground = [0.0, 0.0, 0.0] }}
to = {{ node = "p" }}
stiffness = 1e6
[[supports]]
at = "p"
fix = ["uy", "uz"]
[[initial]]
at = "p"
velocity = [1.0, 0.0, 0.0]
{more}"#
    )
}

fn run(deck: &str) -> (i32, String, String) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("deck.toml"), deck).unwrap();
    let mut command = Command::cargo_bin("rdsolve").unwrap();
    let done = command.current_dir(folder.path()).args(["run", "deck.toml"]).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (done.status.code().unwrap(), text(&done.stderr), text(&done.stdout))
}

const UNSTABLE: &str = "scheme = \"newmark\"\ngamma = 0.5\nbeta = 0.1";

#[test]
fn a_motion_that_grows_without_end_fails_and_shorter_steps_or_dissipation_mend_it() {
    // ω dt = 5 against a limit of 2.58.
    let (code, said, _) = run(&oscillator(UNSTABLE, 5e-3, ""));
    assert_eq!(code, 4, "{said}");
    let told = "energy growth: `newmark` has generated ";
    assert!(said.contains(told) && said.contains("the motion is lost. Give `scheme = "), "{said}");
    // Its balance was kept at t = 0 alone.
    assert!(said.contains("results are valid up to t = 0\n"), "{said}");
    for deck in [oscillator(UNSTABLE, 5e-4, ""), oscillator("scheme = \"bathe\"", 5e-3, "")] {
        let (code, said, _) = run(&deck);
        assert!(code == 0 && !said.contains("lost"), "{said}");
    }
}

/// A motion that automatic steps have lost is computed again with shorter ones. A mass on a spring of ω = 6.3 carries a millionth of it on a spring
/// of ω = 1000, and steps that suit the first are ten times too long for the second, which grows beyond ten times the energy that there was.
#[test]
fn automatic_steps_that_lose_a_motion_are_shortened() {
    let link = |name: &str, ends: &str, stiffness: f64| {
        format!("[[links]]\nname = \"{name}\"\n{ends}\nstiffness = {stiffness:?}\n")
    };
    let deck = format!(
        "analysis = {{ kind = \"dynamic\", end_time = 1.0, time_step = \"auto\", error_tolerance = 0.5 }}\n\
             integrator = {{ scheme = \"newmark\", beta = 0.1 }}\npoints = {{ p = [1.0, 0.0, 0.0], q = [2.0, 0.0, 0.0] }}\n\
             masses = [{{ at = \"p\", mass = 1.0 }}, {{ at = \"q\", mass = 1e-6 }}]\n\
             supports = [{{ at = [\"p\", \"q\"], fix = [\"uy\", \"uz\"] }}]\n\
             initial = [{{ at = [\"p\", \"q\"], velocity = [1.0, 0.0, 0.0] }}]\n\
             [[expect]]\nat = \"p\"\nquantity = \"ux\"\ntime = 1.0\nvalue = {:?}\nabsolute_tolerance = 0.01\n{}{}",
        // The first mass alone: the amplitude is 0.158.
        40.0_f64.sqrt().sin() / 40.0_f64.sqrt(),
        link("soft", "from = { ground = [0.0, 0.0, 0.0] }\nto = { node = \"p\" }", 40.0),
        link("stiff", "from = { node = \"p\" }\nto = { node = \"q\" }", 1.0)
    );
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("deck.toml"), deck).unwrap();
    let mut command = Command::cargo_bin("rdsolve").unwrap();
    let done = command.current_dir(folder.path()).args(["run", "deck.toml"]).output().unwrap();
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(0), "{said}");
    let log = std::fs::read_to_string(folder.path().join("deck.out/run.log")).unwrap();
    assert!(log.contains("the run begins again at t = 0, with shorter steps"), "{log}");
}

/// Without energies the kinetic energy at the end alone is compared with the most that there can be: that of the start and of a weight. With a
/// load whose work nobody has summed the run says that nothing was measured.
#[test]
fn without_energies_a_lost_motion_fails_where_its_energy_is_known() {
    let output = "[output]\nenergy = false\n";
    let gravity = "[environment]\ngravity = [9.81, 0.0, 0.0]\n";
    for more in ["", gravity] {
        let (code, said, _) = run(&oscillator(UNSTABLE, 5e-3, &format!("{output}{more}")));
        assert!(code == 4 && said.contains("the motion is lost"), "{said}");
        let (code, said, _) = run(&oscillator("scheme = \"newmark\"", 5e-4, &format!("{output}{more}")));
        assert!(code == 0 && said.is_empty(), "{said}");
    }
    // A fall from rest has no energy at the start; its kinetic energy is the bound, not ten times that.
    let fall = oscillator("scheme = \"newmark\"", 5e-4, &format!("{output}{gravity}"));
    let fall = fall.replace("stiffness = 1e6", "stiffness = 0.0").replace("velocity = [1.0", "velocity = [0.0");
    let (code, said, _) = run(&fall);
    assert_eq!(code, 0, "{said}");
    let loaded = format!("{output}[[loads]]\nat = \"p\"\nforce = [1.0, 0.0, 0.0]\n");
    let (code, said, out) = run(&oscillator(UNSTABLE, 5e-3, &loaded));
    assert!(code == 0 && out.contains("not measured, because `energy` in [output] is false"), "{said}{out}");
}

/// A ball that meets the ground at 50 m/s.
fn ball(time_step: f64, velocity: f64) -> String {
    format!(
        r#"
[analysis]
kind = "dynamic"
end_time = 0.1
time_step = {time_step:?}
[integrator]
scheme = "newmark"
[[bodies]]
name = "b"
center = [0.0, 0.0, 0.2]
mass = 1.0
velocity = [0.0, 0.0, {velocity:?}]
shape = {{ kind = "sphere", radius = 0.1 }}
[[contacts]]
name = "g"
surface = {{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
with = "b"
stiffness = 2.5e7
restitution = 0.1
"#
    )
}

/// Steps of two thirds of an impact add 13 % of the energy: the warning and the line at the end have one number.
#[test]
fn energy_that_was_added_is_said_in_one_number() {
    let (code, said, printed) = run(&ball(4e-4, -50.0));
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("has added 13 % of the largest energy"), "{said}");
    assert!(printed.contains("numerical growth of energy: 13 % of the largest energy"), "{printed}");
    let (code, said, _) = run(&ball(4e-5, -50.0));
    assert!(code == 0 && !said.contains("energy growth"), "{said}");
}

#[test]
fn a_contact_that_nothing_touched_is_named() {
    let untouched = |velocity: f64| run(&ball(4e-5, velocity)).1.contains("nothing ever touched in contact `g`");
    assert!(untouched(50.0) && !untouched(-50.0));
}
