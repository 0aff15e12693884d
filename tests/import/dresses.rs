//! One file in many dresses: the same deck and the same mesh.

use super::{deck, decks, imported, refusals, tables};

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
