//! ARCHITECTURE.md says which crate may use which; `cargo metadata` says which one does.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::process::Command;

use luthier_workshop::root;
use serde_json::Value;

type Edges = BTreeMap<String, BTreeSet<String>>;

/// The commands, and what they say to terminals.
const COMMANDS: [&str; 3] = ["luthier-cli", "luthier-lab", "luthier-terminal"];

/// Crates that only some of ours may depend on, tests aside.
const OWNERS: [(&str, &[&str]); 15] = [
    ("ash", &["luthier-cost"]),
    ("toml", &["luthier-material"]),
    ("naga", &["luthier-shader"]),
    ("wgpu", &["luthier-gpu"]),
    ("arboard", &["luthier-view"]),
    ("eframe", &["luthier-view"]),
    ("exr", &["luthier-texture"]),
    ("image", &["luthier-texture"]),
    ("ktx2", &["luthier-texture"]),
    ("numpy", &["luthier-python"]),
    ("object_store", &["luthier-store"]),
    ("pyo3", &["luthier-python"]),
    ("indicatif", &["luthier-terminal"]),
    ("clap", &COMMANDS),
    ("anyhow", &COMMANDS),
];

/// Dependencies that ship, by crate; those of tests and builds are left out.
fn dependencies() -> Edges {
    let manifest = root().join("Cargo.toml");
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--offline", "--format-version", "1", "--manifest-path"])
        .arg(manifest)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let name = |value: &Value| value["name"].as_str().unwrap().to_owned();
    let normal = |package: &Value| {
        let all = package["dependencies"].as_array().unwrap();
        all.iter().filter(|d| d["kind"].is_null()).map(name).collect()
    };
    metadata["packages"].as_array().unwrap().iter().map(|p| (name(p), normal(p))).collect()
}

/// The name of a crate that the table has without its beginning; the front door has nothing else.
fn full(short: &str) -> String {
    if short == "luthier" { short.to_owned() } else { format!("luthier-{short}") }
}

/// The third column of the table under "Crates"; `None` is `all`.
fn allowed() -> BTreeMap<String, Option<BTreeSet<String>>> {
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let section = text.split("\n## ").find(|s| s.starts_with("Crates\n")).unwrap();
    let mut rows = BTreeMap::new();
    for line in section.lines().filter(|line| line.starts_with("| luthier")) {
        let [name, _, uses] = line.trim_matches('|').split('|').map(str::trim).collect::<Vec<_>>().try_into().unwrap();
        let uses = match uses {
            "all" => None,
            "–" => Some(BTreeSet::new()),
            list => Some(list.split(", ").map(full).collect()),
        };
        assert!(rows.insert(name.to_owned(), uses).is_none(), "{name} twice");
    }
    rows
}

fn internal(dependencies: &Edges) -> Edges {
    let ours = |uses: &BTreeSet<String>| uses.iter().filter(|d| d.starts_with("luthier")).cloned().collect();
    dependencies.iter().map(|(name, uses)| (name.clone(), ours(uses))).collect()
}

#[test]
fn edges_are_those_of_the_table() {
    let (found, allowed) = (internal(&dependencies()), allowed());
    let names: Vec<&String> = found.keys().collect();
    assert_eq!(names, allowed.keys().collect::<Vec<_>>(), "crates in the workspace and in ARCHITECTURE.md");
    for (name, uses) in &found {
        match &allowed[name] {
            Some(allowed) => assert_eq!(uses, allowed, "{name}"),
            None => assert!(uses.iter().all(|d| found.contains_key(d)), "{name}"),
        }
    }
}

/// Every crate says what it is for, where it stands and what is not in it.
#[test]
fn every_crate_has_a_readme() {
    for name in allowed().keys() {
        let path = root().join("crates").join(name).join("README.md");
        let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        assert!(text.starts_with(&format!("# {name}\n")), "{name}");
        for part in ["\nNot in this crate: ", "\nIts place: "] {
            assert!(text.contains(part), "{name}: {part}");
        }
    }
}

#[test]
fn the_graph_has_no_cycle() {
    let mut left = internal(&dependencies());
    while !left.is_empty() {
        let free: Vec<String> = left.iter().filter(|(_, uses)| uses.is_empty()).map(|(name, _)| name.clone()).collect();
        assert!(!free.is_empty(), "a cycle among {:?}", left.keys());
        left.retain(|name, _| !free.contains(name));
        for uses in left.values_mut() {
            uses.retain(|d| !free.contains(d));
        }
    }
}

#[test]
fn some_dependencies_have_owners() {
    let found = dependencies();
    for (dependency, owners) in OWNERS {
        let users: Vec<&str> = found.iter().filter(|(_, d)| d.contains(dependency)).map(|(n, _)| n.as_str()).collect();
        assert_eq!(users, owners, "{dependency}");
    }
}

/// Commands stand at the end, and nothing that ships needs what tests have in common.
#[test]
fn nothing_depends_on_commands() {
    for (name, uses) in internal(&dependencies()) {
        for end in ["luthier-cli", "luthier-lab", "luthier-fuzz", "luthier-python", "luthier-workshop"] {
            assert!(!uses.contains(end), "{name} uses {end}");
        }
    }
}

/// The runtime and the judge see packages alone, without the front door that makes them.
#[test]
fn the_runtime_does_not_use_the_baker() {
    let uses = internal(&dependencies());
    for name in ["luthier-gpu", "luthier-report", "luthier-export"] {
        assert!(!uses[name].contains("luthier"), "{name} uses the front door");
    }
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--locked", "-p", "luthier-gpu", "-e", "normal", "--prefix", "none"])
        .current_dir(root())
        .output()
        .unwrap();
    let tree = String::from_utf8_lossy(&output.stdout);
    assert!(tree.contains("luthier-export") && !tree.contains("luthier-bake"), "{tree}");
}

#[test]
fn the_judge_does_not_use_the_baker() {
    let uses = &internal(&dependencies());
    let mut reached = BTreeSet::from(["luthier-report".to_owned()]);
    let mut open = vec!["luthier-report".to_owned()];
    while let Some(name) = open.pop() {
        open.extend(uses[&name].iter().filter(|d| reached.insert((*d).clone())).cloned());
    }
    assert!(!reached.contains("luthier-bake"), "{reached:?}");
}
