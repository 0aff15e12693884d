//! `rdsolve import` and `rdsolve model.inp`: files, exit codes, messages.

use super::deck;
use assert_cmd::Command;
use std::path::Path;
use tempfile::TempDir;

pub fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, text)| std::fs::write(folder.path().join(name), text).unwrap());
    folder
}

/// Exit code, standard output, standard error.
pub fn rdsolve(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let done = Command::cargo_bin("rdsolve").unwrap().current_dir(folder).args(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (done.status.code().unwrap(), text(done.stdout), text(done.stderr))
}

#[test]
fn files_are_written_once() {
    let folder = folder(&[("rod.inp", &deck("oscillator"))]);
    let (code, said, problems) = rdsolve(folder.path(), &["import", "rod.inp"]);
    assert_eq!((code, problems.as_str()), (0, ""));
    assert_eq!(
        said,
        "rod.inp: 13 translated, 2 ignored\nnot read, without effect: INC of *STEP, NSET of *NODE PRINT\nwritten: rod.toml, rod.mesh.inp, rod.import.csv\n"
    );
    let report = std::fs::read_to_string(folder.path().join("rod.import.csv")).unwrap();
    assert!(
        report.starts_with("file,line,keyword,verdict,text\nrod.inp,1,*NODE,translated,nodes of the mesh\n"),
        "{report}"
    );
    assert_eq!(rdsolve(folder.path(), &["check", "rod.toml"]).0, 0);
    let (code, _, problems) = rdsolve(folder.path(), &["import", "rod.inp"]);
    assert_eq!(code, 2);
    assert!(problems.contains("the file `rod.toml` exists") && problems.contains("--force"), "{problems}");
    assert_eq!(rdsolve(folder.path(), &["import", "rod.inp", "--force"]).0, 0);
    assert_eq!(rdsolve(folder.path(), &["import", "rod.inp", "-o", "other/place"]).0, 0);
    assert_eq!(rdsolve(folder.path(), &["import", "rods.inp"]).0, 6);
    assert_eq!(rdsolve(folder.path(), &["import", "rod.inp", "--from", "nastran"]).0, 2);
}

/// A robot has no mesh; `rdsolve arm.urdf` runs it, and --from is for input files.
#[test]
fn robots_and_the_program_of_a_file() {
    let arm = "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"><inertial><origin xyz=\"1 0 0\"/><mass value=\"1\"/>\n\
               <inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial></link>\n\
               <joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/><axis xyz=\"0 1 0\"/></joint></robot>\n";
    let folder = folder(&[("arm.urdf", arm), ("bad.urdf", &arm[..90]), ("rod.inp", &deck("oscillator"))]);
    let (code, said, _) = rdsolve(folder.path(), &["import", "arm.urdf"]);
    assert_eq!(code, 0);
    assert!(said.ends_with("written: arm.toml, arm.import.csv\n"), "{said}");
    assert_eq!(rdsolve(folder.path(), &["arm.urdf", "--quiet"]).0, 0);
    assert!(folder.path().join("arm.out/joints.csv").exists());
    let (code, _, problems) = rdsolve(folder.path(), &["import", "bad.urdf"]);
    assert!(code == 3 && problems.contains("--> bad.urdf:1"), "{problems}");
    assert_eq!(rdsolve(folder.path(), &["rod.inp", "--from", "abaqus", "--quiet"]).0, 0);
    let (code, _, problems) = rdsolve(folder.path(), &["arm.toml", "--from", "abaqus"]);
    assert!(code == 2 && problems.contains("remove --from"), "{problems}");
}

#[test]
fn refusals_come_all_at_once() {
    let folder = folder(&[("disc.inp", &deck("spinning_disc"))]);
    let (code, said, problems) = rdsolve(folder.path(), &["import", "disc.inp"]);
    assert_eq!((code, said.as_str()), (3, ""));
    insta::assert_snapshot!("spinning_disc", problems);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    let (code, said, _) = rdsolve(folder.path(), &["import", "disc.inp", "--check"]);
    assert_eq!(code, 3);
    assert!(said.contains("disc.inp,25,*VISCO,refused,"), "{said}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    let (code, said, _) = rdsolve(folder.path(), &["import", "disc.inp", "--partial"]);
    assert_eq!(code, 3);
    assert!(said.contains("written, incomplete: disc.toml"), "{said}");
    let written = std::fs::read_to_string(folder.path().join("disc.toml")).unwrap();
    assert!(written.contains("\n# REFUSED\n") && written.contains("# disc.inp:25 *VISCO: "), "{written}");
}

#[test]
fn strict_units_and_included_files() {
    let plain = deck("rigid_edge");
    let (nodes, rest) = plain.split_once("**\n*Element").unwrap();
    let main = format!("*Include, input=nodes.txt\n*Element{rest}").replace("*Static,", "*Static, Stabilize,");
    let folder = folder(&[("edge.inp", &main), ("nodes.txt", nodes)]);
    let (code, _, problems) = rdsolve(folder.path(), &["import", "edge.inp", "--units", "mm-t-s"]);
    assert_eq!(code, 0, "{problems}");
    let written = std::fs::read_to_string(folder.path().join("edge.toml")).unwrap();
    assert!(written.contains("units = \"mm-t-s\""), "{written}");
    let (code, _, problems) = rdsolve(folder.path(), &["import", "edge.inp", "--strict", "--force"]);
    assert_eq!(code, 3, "{problems}");
    assert!(problems.contains("nothing is stabilized by dampers"), "{problems}");
    // A value that no deck has: the deck stays, for the message shows its line.
    std::fs::write(folder.path().join("thin.inp"), plain.replace("*Elastic\n", "*Elastic\n-")).unwrap();
    let (code, _, problems) = rdsolve(folder.path(), &["import", "thin.inp"]);
    assert!(code == 3 && problems.contains("`youngs_modulus` must be above zero"), "{code} {problems}");
    assert!(folder.path().join("thin.toml").exists());
    std::fs::remove_file(folder.path().join("nodes.txt")).unwrap();
    assert_eq!(rdsolve(folder.path(), &["import", "edge.inp", "--force"]).0, 6);
}

#[test]
fn a_file_runs_in_one_go() {
    let folder = folder(&[("rod.inp", &deck("oscillator")), ("disc.inp", &deck("spinning_disc"))]);
    assert_eq!(rdsolve(folder.path(), &["rod.inp", "--quiet"]).0, 0);
    for name in ["rod.toml", "rod.mesh.inp", "rod.import.csv", "nodes.csv", "result.json"] {
        assert!(folder.path().join("rod.out").join(name).exists(), "{name}");
    }
    assert_eq!(rdsolve(folder.path(), &["rod.inp", "--quiet"]).0, 2);
    assert_eq!(rdsolve(folder.path(), &["rod.inp", "--quiet", "--overwrite"]).0, 0);
    assert_eq!(rdsolve(folder.path(), &["disc.inp"]).0, 3);
    assert!(!folder.path().join("disc.out").exists());
}
