//! Decks and files that nobody has checked: very long ones, devices, bytes that terminals take for commands.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

const HEAD: &str = "[analysis]\nkind = \"dynamic\"\nend_time = 0.01\ntime_step = 1e-3\n";
const BALL: &str = "[[bodies]]\nname = \"ball\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\n\
                    shape = { kind = \"sphere\", radius = 0.1 }\n";

/// Exit code, standard output and standard error.
fn rdsolve(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let done = Command::new(env!("CARGO_BIN_EXE_rdsolve")).current_dir(folder).args(arguments).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    (done.status.code().unwrap_or(-1), text(&done.stdout), text(&done.stderr))
}

/// A deck is read in a time that grows with its length. The limit is ten times what it takes at the least optimisation on one
/// slow core; what was quadratic in these took minutes.
#[test]
fn long_decks_are_read_in_seconds() {
    const MANY: usize = 20_000;
    let list = |line: &dyn Fn(usize) -> String| (0..MANY).map(line).collect::<String>();
    let points = format!("[points]\n{}", list(&|i| format!("p{i} = [{i}.0, 0.0, 0.0]\n")));
    let decks = [
        // Sets side by side, in a chain, and in a circle.
        ("sets", 0, format!("{BALL}[sets]\n{}", list(&|i| format!("s{i} = [\"ball\"]\n")))),
        (
            "chain",
            0,
            format!(
                "{BALL}[sets]\n{}",
                list(&|i| match i {
                    0 => "s0 = [\"ball\"]\n".into(),
                    _ => format!("s{i} = [\"s{}\"]\n", i - 1),
                })
            ),
        ),
        ("circle", 3, format!("{BALL}[sets]\n{}", list(&|i| format!("s{i} = [\"s{}\"]\n", (i + 1) % MANY)))),
        // Names that stand for nothing: in one list, in lists of their own, near to names that do.
        ("words", 3, format!("{BALL}[sets]\na = [\n{}]\n", list(&|i| format!("\"q{i}\",\n")))),
        ("lists", 3, format!("{BALL}{}", list(&|i| format!("[[attachments]]\nbody = \"ball\"\nnodes = [\"q{i}\"]\n")))),
        ("near", 3, format!("{points}{BALL}[sets]\na = [{}]\n", list(&|i| format!("\"q{i}\",")))),
    ];
    let dir = tempfile::tempdir().unwrap();
    for (name, code, text) in decks {
        let deck = format!("{name}.toml");
        fs::write(dir.path().join(&deck), format!("{HEAD}{text}")).unwrap();
        let began = Instant::now();
        let (ended, _, said) = rdsolve(dir.path(), &["check", &deck]);
        let took = began.elapsed();
        println!("{name}: {took:?}, {} bytes said", said.len());
        assert_eq!(ended, code, "{name}: {}", &said[..said.len().min(2000)]);
        assert!(took < Duration::from_secs(20), "{name}: {took:?}");
        assert!(said.len() < 100_000, "{name}: {} bytes", said.len());
        if code == 3 {
            assert!(said.matches("error: ").count() <= 51, "{name}");
            let all = if name == "circle" { 50 } else { MANY };
            assert!(said.contains(&format!("`{deck}` has {all} errors")), "{name}: {}", &said[said.len() - 300..]);
            assert!(all == 50 || said.contains(&format!("… and {} more errors", MANY - 50)), "{name}");
        }
    }
}

/// Names, paths, options and lines of other files may hold what a terminal takes for commands.
#[test]
#[cfg(unix)]
fn no_message_commands_a_terminal() {
    let dir = tempfile::tempdir().unwrap();
    let is_plain = |text: &str| !text.chars().any(|c| (c.is_control() && c != '\n' && c != '\t') || c == '\u{202e}');
    let evil = "\u{1b}]0;owned\u{7}\u{1b}[2J\u{9b}1m\u{202e}";
    let written = "\\u001b]0;owned\\u0007\\u001b[2J\\u009b1m\\u202e";
    let ball = BALL.replace("ball", written);
    let missing = format!("{HEAD}{ball}[[loads]]\nat = \"x{written}\"\nforce = [0.0, 0.0, 1.0]\n");
    let word = format!("{HEAD}{BALL}[integrator]\nscheme = \"{written}\"\n");
    let key = format!("{HEAD}{BALL}[output]\n\"{written}\" = 1\n");
    let mesh = format!("{HEAD}{BALL}[mesh]\nfile = \"{evil}.msh\"\n").replace(evil, written);
    let bad_mesh = format!("{HEAD}{BALL}[mesh]\nfile = \"m.msh\"\n");
    fs::write(dir.path().join("m.msh"), format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n{evil}\n")).unwrap();
    for (number, deck) in [missing, word, key, mesh, bad_mesh].iter().enumerate() {
        fs::write(dir.path().join("x.toml"), deck).unwrap();
        let (code, out, said) = rdsolve(dir.path(), &["check", "x.toml"]);
        assert!(code == 3 && is_plain(&out) && is_plain(&said), "{number}: {code} {said:?}");
    }
    // A sound deck with names that turn the direction of writing: what is printed, the log and the comparison.
    let written = "\\u202e";
    let ball = BALL.replace("ball", written);
    let title = format!(
        "title = \"{written}\"\n{HEAD}{ball}[[expect]]\nat = \"{written}\"\nquantity = \"x\"\ntime = 0.01\nvalue = 1.0\ntolerance = 0.1\n"
    );
    fs::write(dir.path().join(format!("{evil}.toml")), title).unwrap();
    let (deck, folder) = (format!("{evil}.toml"), format!("{evil}.out"));
    let (code, out, said) = rdsolve(dir.path(), &[&deck]);
    assert!(code == 5 && is_plain(&out) && is_plain(&said), "{code} {out:?} {said:?}");
    let log = fs::read_to_string(dir.path().join(&folder).join("run.log")).unwrap();
    assert!(is_plain(&log), "{log:?}");
    for arguments in
        [&["check", &deck][..], &["compare", &folder, &folder], &["report", &folder], &["check", "none\u{1b}[2J.toml"]]
    {
        let (_, out, said) = rdsolve(dir.path(), arguments);
        assert!(is_plain(&out) && is_plain(&said), "{arguments:?} {out:?} {said:?}");
    }
    let (_, out, said) = rdsolve(dir.path(), &[&deck, "--set", &format!("points.{evil}=1"), "-o", "y"]);
    assert!(is_plain(&out) && is_plain(&said), "{said:?}");
}

/// A device without end, a pipe that nobody fills, a folder: said at once, wherever a deck names a file.
#[test]
#[cfg(unix)]
fn a_file_is_judged_before_it_is_read() {
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir(dir.path().join("folder.msh")).unwrap();
    assert!(Command::new("mkfifo").arg(dir.path().join("pipe.msh")).status().unwrap().success());
    std::os::unix::fs::symlink("/dev/zero", dir.path().join("zero.msh")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", dir.path().join("zero.inp")).unwrap();
    let wanted = [
        ("folder.msh", "it is a folder"),
        ("pipe.msh", "not a regular file"),
        ("zero.msh", "not a regular file"),
        ("zero.inp", "not a regular file"),
    ];
    for (file, words) in wanted {
        fs::write(dir.path().join("x.toml"), format!("{HEAD}{BALL}[mesh]\nfile = \"{file}\"\n")).unwrap();
        let began = Instant::now();
        let (code, _, said) = rdsolve(dir.path(), &["check", "x.toml"]);
        assert!(code == 3 && said.contains(words) && said.contains(file), "{code} {said}");
        assert!(began.elapsed() < Duration::from_secs(5));
    }
    // A reference of a study, and a table of a folder of results.
    fs::write(
        dir.path().join("x.toml"),
        format!("{HEAD}{BALL}[study]\nreference = \"pipe.msh\"\ntime_steps = [1e-3]\n"),
    )
    .unwrap();
    let (code, _, said) = rdsolve(dir.path(), &["study", "x.toml"]);
    assert!(code == 3 && said.contains("not a regular file"), "{code} {said}");
    fs::create_dir(dir.path().join("out")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", dir.path().join("out/nodes.csv")).unwrap();
    for arguments in [&["compare", "out", "out"][..], &["report", "out"]] {
        let (code, _, said) = rdsolve(dir.path(), arguments);
        assert!(code == 6 && said.contains("nodes.csv: it is a device or a pipe"), "{code} {said}");
    }
    // A line of a file of any kind is shown in part, whatever it holds.
    let line = format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n{}\n", "secret ".repeat(5000));
    fs::write(dir.path().join("long.msh"), line).unwrap();
    fs::write(dir.path().join("x.toml"), format!("{HEAD}{BALL}[mesh]\nfile = \"long.msh\"\n")).unwrap();
    let (code, _, said) = rdsolve(dir.path(), &["check", "x.toml"]);
    assert!(code == 3 && said.len() < 1500, "{code} {} {said}", said.len());
}
