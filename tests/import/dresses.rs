//! One file in many dresses: the same deck and the same mesh.

use super::rows::{BEAM, edited};
use super::{deck, decks, imported, refusals, tables};
use assert_cmd::Command;
use import::Imported;
use rdsolve::text_file::includes::Included;

/// Case in keywords, blanks, tabs, ends of lines, comments, the order of blocks: the same tables and the same mesh.
#[test]
fn lines_in_every_dress() {
    // `syntax` is in a dress of its own.
    for (name, plain) in decks().into_iter().filter(|(name, _)| name != "syntax") {
        let wanted = imported(&plain);
        let upper = |line: &str| {
            if line.starts_with('*') {
                line.replacen(line.split(',').next().unwrap(), &line.split(',').next().unwrap().to_uppercase(), 1)
            } else {
                line.to_owned()
            }
        };
        let dresses = [
            ("ends of lines with CR", plain.replace('\n', "\r\n")),
            ("a byte order mark", format!("\u{feff}{plain}")),
            ("blanks before", plain.replace('\n', "\n  ")),
            ("tabs", plain.replace(", ", ",\t")),
            ("comments", plain.replace('\n', "\n** a remark\n").replace("*Heading\n** a remark\n", "*Heading\n")),
            ("keywords in capitals", plain.lines().map(upper).collect::<Vec<_>>().join("\n")),
        ];
        for (what, text) in dresses {
            let made = imported(&text);
            assert_eq!(tables(&made.deck), tables(&wanted.deck), "{name}: {what}");
            assert_eq!(made.mesh, wanted.mesh, "{name}: {what}");
        }
    }
}

/// A keyword line, and data of more than four numbers, may go on after a comma; names count in any case, and exponents may be D.
#[test]
fn broken_lines_and_other_names() {
    for name in ["plate_s4", "rigid_edge"] {
        let plain = deck(name);
        let wanted = imported(&plain);
        let broken = |line: &str| match line {
            _ if line.starts_with("*Shell") || line.starts_with("*SHELL") => line.replace(", ", ",\n  "),
            _ if line.split(", ").count() == 5 => line.replacen(", ", ",\n", 3).replacen(",\n", ", ", 2),
            _ => line.to_owned(),
        };
        let exponents = plain.replace("2.1E+11", "2.1D+11").replace("210000,", "2.1D5,");
        let dresses = [
            ("broken lines", plain.lines().map(broken).collect::<Vec<_>>().join("\n")),
            ("exponents of Fortran", exponents),
            ("nodes and elements given twice", twice(&plain)),
        ];
        for (what, text) in dresses {
            assert_ne!(text, plain, "{name}: {what}");
            let made = imported(&text);
            assert_eq!(refusals(&made), [""; 0], "{name}: {what}");
            assert_eq!(made.mesh, wanted.mesh, "{name}: {what}");
            assert_eq!(tables(&made.deck), tables(&wanted.deck), "{name}: {what}");
        }
    }
}

/// The file with its first blocks of nodes and of elements once more.
fn twice(text: &str) -> String {
    let begin = text.find("*Node").unwrap();
    let cells = begin + text[begin..].find("*E").unwrap();
    let end = cells + 1 + text[cells + 1..].find('*').unwrap();
    format!("{}{}", &text[..end], &text[begin..])
}

/// A file that includes its nodes and its step, the second one from a folder, or reads the nodes by INPUT: the same deck and mesh.
#[test]
fn includes() {
    let plain = deck("rigid_edge");
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir_all(folder.path().join("parts")).unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let (before, rest) = plain.split_once("*Node\n").unwrap();
    let (nodes, rest) = rest.split_once("*Element").unwrap();
    let (middle, step) = rest.split_once("*Step").unwrap();
    write("whole.inp", &plain);
    write("nodes.inp", &format!("*Node\n{nodes}"));
    write("parts/step.inp", &format!("*Step{step}"));
    write("split.inp", &format!("{before}*Include, Input=nodes.inp\n*Element{middle}*INCLUDE, INPUT=parts/step.inp\n"));
    write("numbers.txt", nodes);
    write("input.inp", &format!("{before}*Node, Input=numbers.txt\n*Element{rest}"));
    let made = ["whole", "split", "input"].map(|name| {
        let mut program = Command::cargo_bin("rdsolve").unwrap();
        let done = program.current_dir(folder.path()).args(["import", &format!("{name}.inp")]).output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let text = |end: &str| std::fs::read_to_string(folder.path().join(format!("{name}.{end}"))).unwrap();
        (tables(&text("toml")).replace(&format!("{name}.mesh"), "whole.mesh"), text("mesh.inp"))
    });
    assert_eq!(made[0], made[1]);
    assert_eq!(made[0], made[2]);
}

/// Data in a file of INPUT= are those below the keyword. A keyword whose file is not read is refused, and a missing file is an error.
#[test]
fn data_in_files() {
    let more = "*ELSET, ELSET=all\n1\n*AMPLITUDE, NAME=A\n0., 0., 1., 2.\n*EQUATION\n2\n2, 1, 1., 2, 2, -1.\n\
                *INITIAL CONDITIONS, TYPE=TEMPERATURE\n1, 20.\n2, 20.\n*BOUNDARY\n";
    let loads = "*CLOAD, AMPLITUDE=A\n2, 3, 5.\n*DLOAD\nrod, PY, 3.\n*TEMPERATURE\n1, 30.\n2, 30.\n";
    let mpc = "*MPC\nPIN, 2, 3\n*BOUNDARY\n";
    let plain =
        edited(BEAM, &[("*BOUNDARY\n", more), ("*CLOAD\n2, 3, 5.\n", loads), ("0.3\n", "0.3\n*EXPANSION\n1e-5\n")]);
    let made_of = |text: &str, data: Option<&str>| {
        let mut read = |_: &str| data.map(|data| data.as_bytes().to_vec()).ok_or(std::io::ErrorKind::NotFound.into());
        let whole = Included::new("a.inp", text.as_bytes().to_vec(), &mut read).map_err(drop)?;
        Ok::<_, ()>(imported(&String::from_utf8(whole.bytes).unwrap()))
    };
    let read = [
        "NODE",
        "ELEMENT",
        "NSET",
        "ELSET",
        "AMPLITUDE",
        "EQUATION",
        "INITIAL CONDITIONS",
        "BOUNDARY",
        "CLOAD",
        "DLOAD",
        "TEMPERATURE",
        "MPC",
    ];
    for (word, is_read) in read.map(|word| (word, true)).into_iter().chain([("EXPANSION", false), ("DENSITY", false)]) {
        let plain = if word == "MPC" { edited(BEAM, &[("*BOUNDARY\n", mpc)]) } else { plain.clone() };
        let wanted = imported(&plain);
        assert!(word == "MPC" || refusals(&wanted).is_empty(), "{:?}", refusals(&wanted));
        let begin = plain.find(&format!("*{word}")).unwrap();
        let head = begin + plain[begin..].find('\n').unwrap();
        let end = head + plain[head..].find('*').unwrap();
        let text = format!("{}, INPUT=data.txt\n{}", &plain[..head], &plain[end..]);
        let made = made_of(&text, Some(&plain[head + 1..end]));
        if is_read {
            let made = made.unwrap();
            // An equation has the number of its line in its name.
            let tables = |made: &Imported| tables(&made.deck).replace("equation_26", "equation_25");
            assert_eq!((tables(&made), &made.mesh), (tables(&wanted), &wanted.mesh), "{word}");
            assert_eq!(refusals(&made).len(), refusals(&wanted).len(), "{word}");
            assert!(made_of(&text, None).is_err(), "{word}");
        } else {
            let said = refusals(&made.unwrap()).join("; ");
            assert!(said.contains(&format!("INPUT of *{word} is not read")), "{said}");
        }
    }
}

/// Blocks may stand in another order: sections before materials, supports before elements.
#[test]
fn blocks_in_another_order() {
    let plain = deck("beam_pipe");
    let wanted = imported(&plain);
    let (before, rest) = plain.split_once("*PHYSICAL").unwrap();
    let (middle, steps) = rest.split_once("*STEP").unwrap();
    let (material, section) = middle.split_once("*BEAM SECTION").unwrap();
    let turned = format!("{before}*BEAM SECTION{section}*PHYSICAL{material}*STEP{steps}");
    assert_eq!(tables(&imported(&turned).deck), tables(&wanted.deck));
}

/// An instance that is moved to where its part stands already, and a file in parts and flat.
#[test]
fn parts_and_flat() {
    let plain = deck("oscillator");
    let (mesh, rest) = plain.split_once("*BOUNDARY").unwrap();
    let flat = imported(&plain);
    // The part is drawn elsewhere, and its instance moved back.
    let inside = mesh.replace("\n1, 0., 0., 0.\n2, 1., 0., 0.", "\n1, 8., 2., 0.\n2, 9., 2., 0.");
    let parts = format!(
        "*PART, NAME=P\n{inside}*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n-8., -2., 0.\n*END INSTANCE\n\
         *NSET, NSET=ONE, INSTANCE=I\n1\n*NSET, NSET=TWO, INSTANCE=I\n2\n*END ASSEMBLY\n*BOUNDARY{}",
        rest.replace("\n1, 1, 3", "\nONE, 1, 3")
            .replace("\n2, 2, 3", "\nTWO, 2, 3")
            .replace("\n2, 1, 1.", "\nTWO, 1, 1.")
    );
    let made = imported(&parts);
    assert_eq!(refusals(&made), [""; 0]);
    let nodes = |deck: &str| tables(deck).replace("\"ONE\"", "\"mesh.1\"").replace("\"TWO\"", "\"mesh.2\"");
    assert_eq!(nodes(&made.deck), tables(&flat.deck));
}
