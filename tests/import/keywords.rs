//! Every keyword has a verdict, and every refusal its reason.

use super::rows::{BEAM, edited};
use super::{decks, imported, reasons, refusals};
use import::KeywordVerdict;
use import::keywords::{KEYWORDS, Treatment};
use std::collections::BTreeSet;

/// Keywords and parameters that nobody knows are refused.
#[test]
fn unknown_keywords() {
    assert!(refusals(&imported("*TELEPORT\n")).contains(&"1 *TELEPORT: *TELEPORT is not known".to_owned()));
    let stranger = refusals(&imported("*BOUNDARY, SUBMODEL\n"));
    assert!(stranger.contains(&"1 *BOUNDARY: SUBMODEL of *BOUNDARY is not read".to_owned()), "{stranger:?}");
}

/// A mesh alone has one refusal, whatever its elements are. Steps are missed where there is more.
#[test]
fn meshes_alone() {
    let mesh = "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n*ELEMENT, TYPE=CPS3, ELSET=e\n1, 1, 2, 3\n*NSET, NSET=n\n1\n";
    let said = imported(mesh).verdicts.said();
    assert_eq!(
        said.iter().map(|said| &*said.message).collect::<Vec<_>>(),
        ["this file is a mesh alone, without *STEP"]
    );
    assert!(said[0].hints[0].starts_with("name it in a deck: `[mesh] file = "), "{:?}", said[0].hints);
    let gmsh = imported("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n").verdicts.said();
    assert_eq!(gmsh.len(), 1);
    assert_eq!((&*gmsh[0].message, gmsh[0].hints.len()), ("this file is a mesh of Gmsh", 1));
    for (begin, kind) in [
        ("$ made elsewhere\nSOL 101\nCEND\n", "a model of Nastran"),
        ("GRID,1,,0.,0.,0.\n", "a model of Nastran"),
        ("    -1\n   164\n", "a universal file of I-DEAS"),
        ("# vtk DataFile Version 2.0\n", "a mesh of VTK"),
    ] {
        let said = imported(begin).verdicts.said();
        assert_eq!((said.len(), said[0].message.clone()), (1, format!("this file is {kind}")));
        assert!(said[0].hints[0].contains("Gmsh or meshio"), "{:?}", said[0].hints);
    }
    let more = refusals(&imported(&format!("{mesh}*MATERIAL, NAME=m\n")));
    assert!(more.iter().any(|said| said.contains("the file has no *STEP")), "{more:?}");
    assert!(more.iter().any(|said| said.contains("no plane elements")), "{more:?}");
    assert!(refusals(&imported("")).iter().any(|said| said.contains("the file has no *STEP")));
}

/// A parameter that nothing asks for is in the report: as refused where nobody knows it, as changed or refused where it acts on the motion,
/// else as ignored.
#[test]
fn parameters_that_nothing_reads() {
    let with = |keyword: &str, parameter: &str| {
        let text = format!("*{keyword}{parameter}\n1, 2, 3\n");
        imported(&text).verdicts.rows.into_iter().filter(|row| row.line == 1).collect::<Vec<_>>()
    };
    for row in KEYWORDS.iter().filter(|row| matches!(row.treatment, Treatment::Read(_)) && row.harmless != "*") {
        let said = with(row.word, ", NOBODYS=1");
        assert!(said.iter().any(|row| row.verdict == KeywordVerdict::Refused), "{}", row.word);
    }
    for (edits, verdict, wanted) in [
        (("*STEP,", "*STEP, INC=100,"), KeywordVerdict::Ignored, "INC is not read"),
        (("SECTION=RECT", "SECTION=RECT, POISSON=0.3"), KeywordVerdict::Changed, "POISSON: sections keep"),
        (("SECTION=RECT", "SECTION=RECT, POISSON=0."), KeywordVerdict::Ignored, "POISSON is not read"),
        (("SECTION=RECT", "SECTION=RECT, TEMPERATURE=VALUES"), KeywordVerdict::Refused, "TEMPERATURE: temp"),
        (("SECTION=RECT", "SECTION=RECT, TEMPERATURE=GRADIENT"), KeywordVerdict::Ignored, "TEMPERATURE is not"),
        (("*NSET,", "*NSET, UNSORTED,"), KeywordVerdict::Ignored, "UNSORTED is not read"),
    ] {
        let made = imported(&edited(BEAM, &[edits]));
        assert!(reasons(&made, verdict).iter().any(|said| said.contains(wanted)), "{wanted}");
        let of_steps = made.verdicts.rows.iter().filter(|row| row.keyword == "*STEP");
        assert_eq!(of_steps.filter(|row| row.verdict == KeywordVerdict::Translated).count(), 1, "{wanted}");
    }
    let unread = imported(&edited(BEAM, &[("*STEP,", "*STEP, INC=100,")])).verdicts.unread;
    assert_eq!(unread.into_iter().collect::<Vec<_>>(), ["INC of *STEP"]);
    // The program of the file is found by TYPE of all keywords: that is no reading.
    let tie = imported("*TIE, NAME=t, TYPE=SURFACE TO SURFACE\na, b\n");
    assert!(reasons(&tie, KeywordVerdict::Changed).iter().any(|said| said.contains("TYPE: each node is tied")));
}

/// No keyword stands in two rows.
#[test]
fn rows_are_one_for_each_keyword() {
    let words: BTreeSet<&str> = KEYWORDS.iter().map(|row| row.word).collect();
    assert_eq!(words.len(), KEYWORDS.len());
}

/// Each line with a keyword is in the report.
#[test]
fn the_report_has_every_keyword() {
    for (name, text) in decks() {
        let made = imported(&text);
        let lines: Vec<usize> = text
            .lines()
            .enumerate()
            .filter(|(_, line)| {
                line.trim_start_matches(['\u{feff}', ' ']).starts_with('*') && !line.trim_start().starts_with("**")
            })
            .map(|(at, _)| at + 1)
            .collect();
        for (at, line) in lines.iter().enumerate() {
            let next = lines.get(at + 1).copied().unwrap_or(usize::MAX);
            assert!(made.verdicts.rows.iter().any(|row| (*line..next).contains(&row.line)), "{name}:{line}");
        }
    }
}

/// Cut anywhere, a file gives verdicts and no panic.
#[test]
fn files_cut_anywhere() {
    for (_, text) in decks() {
        for end in (0..text.len()).step_by(7).filter(|end| text.is_char_boundary(*end)) {
            imported(&text[..end]);
            imported(&text[end..]);
        }
    }
}
