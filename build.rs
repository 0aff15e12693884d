//! Tells the program which commit it was built from. Without git, or outside a checkout of its own, there is the version alone.

use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let version = std::env::var("CARGO_PKG_VERSION").unwrap_or_default();
    let version = commit().map_or(version.clone(), |commit| format!("{version} ({commit})"));
    println!("cargo:rustc-env=RDSOLVE_VERSION={version}");
}

fn commit() -> Option<String> {
    let package = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR")?);
    // Sources unpacked within somebody else's repository do not come from that one.
    let top = PathBuf::from(git(&package, &["rev-parse", "--show-toplevel"])?);
    if top.canonicalize().ok()? != package.canonicalize().ok()? {
        return None;
    }
    // The log of HEAD grows with every commit and checkout, and with nothing else: only then is this asked again. A path that is
    // not there would have cargo ask at every build.
    let watched =
        ["logs/HEAD", "HEAD"].into_iter().filter_map(|name| git(&package, &["rev-parse", "--git-path", name]));
    if let Some(path) = watched.map(|path| package.join(path)).find(|path| path.exists()) {
        println!("cargo:rerun-if-changed={}", path.display());
    }
    git(&package, &["rev-parse", "--short=12", "HEAD"])
}

/// What git answers, in a line.
fn git(folder: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).current_dir(folder).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (output.status.success() && !text.is_empty()).then_some(text)
}
