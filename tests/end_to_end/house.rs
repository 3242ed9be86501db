//! The style of the house, kept by a test: short files that say what they are, no machine's own
//! paths, and licences that we may ship.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use mouthpiece_tests::binary;

/// Longer than this and a file is two.
const LINES_MAX: usize = 600;

/// Every file of ours in the checkout.
fn files() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![binary::root()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let foreign = matches!(&*name, ".git" | "target" | "__pycache__" | "out");
            if path.is_dir() && !foreign {
                folders.push(path);
            } else if path.is_file() {
                found.push(path);
            }
        }
    }
    assert!(found.len() > 100, "only {} files", found.len());
    found
}

fn has_ending(path: &Path, endings: &[&str]) -> bool {
    let ending = path.extension().unwrap_or_default();
    endings.iter().any(|e| ending == *e)
}

/// Guards files that can be read in one sitting and begin by saying what they are.
#[test]
fn sources_are_short_and_say_what_they_are() {
    let mut wrong = Vec::new();
    for path in files() {
        if !has_ending(&path, &["rs", "wgsl"]) {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let lines = text.lines().count();
        if lines > LINES_MAX {
            wrong.push(format!("{} has {lines} lines", path.display()));
        }
        let opening = if has_ending(&path, &["rs"]) {
            "//!"
        } else {
            "//"
        };
        if !text.starts_with(opening) {
            wrong.push(format!("{} does not begin with {opening}", path.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Guards the checkout's independence of where it was written.
#[test]
fn no_file_names_a_path_of_one_machine() {
    // In two pieces, so that this file passes its own test.
    let roots = [
        ("/wo", "rk/"),
        ("/ro", "ot/"),
        ("/ho", "me/"),
        ("../sh", "ared"),
    ];
    let roots = roots.map(|(a, b)| [a, b].concat());
    let text_endings = [
        "rs", "wgsl", "toml", "md", "py", "sh", "json", "yml", "yaml", "txt", "PHN", "WRD", "",
    ];
    let mut wrong = Vec::new();
    for path in files() {
        if !has_ending(&path, &text_endings) {
            continue;
        }
        // What is no text names nothing.
        let Ok(text) = fs::read_to_string(&path) else {
            continue;
        };
        for (n, line) in text.lines().enumerate() {
            if roots.iter().any(|root| line.contains(root)) {
                wrong.push(format!("{}:{}: {line}", path.display(), n + 1));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Guards deny.toml where cargo-deny is not installed: every dependency that is built here can be
/// had under a licence of its list.
#[test]
fn every_dependency_has_a_licence_that_we_may_ship() {
    let deny = fs::read_to_string(binary::root().join("deny.toml")).unwrap();
    let deny: toml::Table = toml::from_str(&deny).unwrap();
    let allow = deny["licenses"]["allow"].as_array().unwrap();
    let allow: BTreeSet<_> = allow.iter().filter_map(toml::Value::as_str).collect();
    let host = format!("{}-unknown-linux-gnu", std::env::consts::ARCH);
    let out = Command::new(env!("CARGO"))
        .current_dir(binary::root())
        .args(["metadata", "--format-version=1", "--locked"])
        .args(["--filter-platform", &host])
        .output()
        .unwrap();
    assert!(
        out.status.success(),
        "{}",
        String::from_utf8_lossy(&out.stderr)
    );
    let metadata: serde_json::Value = serde_json::from_slice(&out.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    assert!(packages.len() > 100, "{}", packages.len());
    let refused: Vec<_> = packages
        .iter()
        .filter(|p| !is_allowed(p["license"].as_str().unwrap_or("none"), &allow))
        .map(|p| format!("{} {}: {}", p["name"], p["version"], p["license"]))
        .collect();
    assert!(refused.is_empty(), "{}", refused.join("\n"));
}

/// Whether an SPDX expression can be met from `allow`. OR binds weaker than AND; brackets are
/// resolved from the inside.
fn is_allowed(expression: &str, allow: &BTreeSet<&str>) -> bool {
    let mut text = expression.replace('/', " OR ");
    // One bracket less each turn.
    while let Some(close) = text.find(')') {
        let open = text[..close].rfind('(').expect("brackets in pairs");
        let inner = is_allowed(&text[open + 1..close], allow);
        text.replace_range(open..=close, if inner { "yes" } else { "no" });
    }
    text.split(" OR ").any(|one_of| {
        one_of.split(" AND ").all(|licence| {
            let licence = licence.trim();
            licence == "yes" || allow.contains(licence)
        })
    })
}

/// Guards the little parser above.
#[test]
fn licence_expressions_are_read() {
    let allow = BTreeSet::from(["MIT", "BSD-3-Clause"]);
    for (expression, wanted) in [
        ("MIT", true),
        ("GPL-3.0", false),
        ("MIT OR GPL-3.0", true),
        ("MIT/GPL-3.0", true),
        ("MIT AND GPL-3.0", false),
        ("(MIT OR GPL-3.0) AND BSD-3-Clause", true),
        ("(GPL-2.0 OR GPL-3.0) AND MIT", false),
        ("GPL-3.0 OR MIT AND BSD-3-Clause", true),
        ("none", false),
    ] {
        assert_eq!(is_allowed(expression, &allow), wanted, "{expression}");
    }
}
