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

/// The verdict needs energies: without them the run says that they were not measured.
#[test]
fn without_energies_the_run_says_that_nothing_was_measured() {
    let (code, said, out) = run(&oscillator(UNSTABLE, 5e-3, "[output]\nenergy = false\n"));
    assert!(code == 0 && out.contains("not measured, because `energy` in [output] is false"), "{said}{out}");
}
