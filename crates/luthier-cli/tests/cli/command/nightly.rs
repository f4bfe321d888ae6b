//! `scripts/nightly.sh` in a copy of the repository whose crates have their true manifests and no code, with programs that pass in place of
//! those that the steps run.

use std::collections::BTreeSet;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::{Command, Output};

use luthier_workshop::root;

use crate::workshop::Workshop;

/// Scripts that the steps call.
const CALLED: [&str; 26] = [
    "random-tests.sh",
    "fuzz.sh",
    "run-examples.sh",
    "c-host.sh",
    "bevy.sh",
    "babylon.sh",
    "playcanvas.sh",
    "materialx.sh",
    "godot.sh",
    "engines/furnace.sh",
    "formats.sh",
    "add-kind.sh",
    "add-model.sh",
    "package.sh",
    "installed.sh",
    "promises.sh",
    "many.sh",
    "book.sh",
    "other-architecture.sh",
    "farm/slurm.sh",
    "farm/builds.sh",
    "farm/descriptions.sh",
    "farm/s3.sh",
    "gpu.sh",
    "python.sh",
    "mitsuba.sh",
];

/// It passes, unless `FAILS` has its name. As `luthier` it has no window, and bakes a file.
const PROGRAM: &str = r#"#!/usr/bin/env bash
case $* in view*) echo "--features view"; exit 1 ;; bake*) mkdir -p "$4" && echo baked >"$4/file" ;; esac
[ "$(basename "$0")" != "$FAILS" ]
"#;

/// Every step that runs without its name.
const ALL: [&str; 24] = [
    "book",
    "babylon",
    "bevy",
    "c",
    "crash",
    "engines",
    "examples",
    "farm",
    "formats",
    "fuzz",
    "godot",
    "gpu",
    "installed",
    "kind",
    "materialx",
    "mitsuba",
    "packages",
    "playcanvas",
    "promises",
    "python",
    "random",
    "release",
    "scale",
    "tests",
];

struct Repository(Workshop);

impl Repository {
    fn new() -> Self {
        let workshop = Workshop::new();
        let copy = |file: &str| workshop.write(file, fs::read(root().join(file)).unwrap());
        copy("scripts/nightly.sh");
        copy("scripts/steps.sh");
        for crate_folder in fs::read_dir(root().join("crates")).unwrap() {
            let name = crate_folder.unwrap().file_name().into_string().unwrap();
            copy(&format!("crates/{name}/Cargo.toml"));
            for file in ["src/lib.rs", "tests/all.rs", "README.md"] {
                workshop.write(&format!("crates/{name}/{file}"), "");
            }
        }
        // In two pieces: the steps look for these words in the sources of this crate, too.
        for name in ["lut", "layers"] {
            workshop.write(&format!("crates/luthier-{name}/tests/all.rs"), concat!("proptest", "!"));
        }
        workshop.write("crates/luthier-lab/tests/all.rs", concat!("#[", "ignore = \"minutes\"]"));
        for file in [
            "Cargo.toml",
            "Cargo.lock",
            ".cargo/config.toml",
            "README.md",
            "CHANGELOG.md",
            "materials/gold.toml",
            "tests/broken/a.toml",
            "tests/broken-surfaces/a.toml",
            "tests/crash/kill.c",
            "examples/wgpu/main.rs",
            "examples/farm/job",
            "examples/scene.json",
            "examples/browser.mjs",
            "examples/c/ball.c",
            "examples/c/difference.py",
            "examples/web/difference.mjs",
            "examples/web/workshop.mjs",
            "examples/web/src/surface.js",
            "examples/babylon/ball.js",
            "examples/bevy/main.rs",
            "examples/godot/test.gd",
            "examples/materialx/host.py",
            "examples/materialx/tables.py",
            "examples/plain-webgl/ball.js",
            "examples/playcanvas/ball.js",
            "examples/three/ball.js",
            "examples/shaders/ball.frag",
            "examples/mitsuba/luthier_bsdf.py",
            "examples/mitsuba/sky.py",
            "docs/proof.md",
            "docs/pages/nightly.md",
            "docs/measurements/stability.json",
            "docs/measurements/nightly.tsv",
            "crates/luthier-material/examples/library.rs",
            "crates/luthier-fuzz/corpus/a",
            "scripts/add-kind.patch",
            "scripts/add-model.patch",
            "scripts/patched.sh",
            "scripts/formats/validate.mjs",
            "scripts/patience.mjs",
        ] {
            workshop.write(file, "");
        }
        workshop.write(".gitignore", "target/\nbin/\n");
        let called = CALLED.map(|script| format!("scripts/{script}"));
        let programs = ["tests/crash/all.sh", "bin/cargo", "target/debug/luthier", "target/release/luthier"];
        for program in called.iter().map(String::as_str).chain(programs) {
            workshop.write(program, PROGRAM);
            fs::set_permissions(workshop.path(program), fs::Permissions::from_mode(0o755)).unwrap();
        }
        let repository = Self(workshop);
        repository.git(&["init", "--quiet", "--initial-branch", "main"]);
        repository.commit();
        repository
    }

    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        let path = format!("{}:{}", self.0.path("bin").display(), std::env::var("PATH").unwrap());
        command.current_dir(self.0.path("")).env("PATH", path).env_remove("FAILS");
        for (name, value) in [
            ("GIT_CONFIG_GLOBAL", "/dev/null"),
            ("GIT_CONFIG_SYSTEM", "/dev/null"),
            ("GIT_AUTHOR_NAME", "a"),
            ("GIT_AUTHOR_EMAIL", "a@example.com"),
            ("GIT_COMMITTER_NAME", "a"),
            ("GIT_COMMITTER_EMAIL", "a@example.com"),
        ] {
            command.env(name, value);
        }
        // As they are set where a hook of git runs the tests.
        for name in ["GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE"] {
            command.env_remove(name);
        }
        command
    }

    fn git(&self, words: &[&str]) -> String {
        let output = self.command("git").args(words).output().unwrap();
        assert!(output.status.success(), "git {words:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap().trim_end().to_owned()
    }

    fn commit(&self) {
        self.git(&["add", "--all"]);
        self.git(&["commit", "--quiet", "--message", "a change"]);
    }

    fn run(&self, words: &[&str], fails: &str) -> (Output, String) {
        let output = self.command("bash").arg("scripts/nightly.sh").args(words).env("FAILS", fails).output().unwrap();
        let said = String::from_utf8_lossy(&[&output.stdout[..], &output.stderr[..]].concat()).into_owned();
        (output, said)
    }

    /// The exit code of `--check`, the steps that it names, and all that it says.
    fn check(&self) -> (i32, BTreeSet<String>, String) {
        let (output, said) = self.run(&["--check"], "");
        let steps = said.lines().filter_map(|line| line.split("nightly step `").nth(1)?.split('`').next());
        (output.status.code().unwrap(), steps.map(str::to_owned).collect(), said)
    }

    fn rows(&self) -> Vec<Vec<String>> {
        let text = self.0.text("docs/measurements/nightly.tsv");
        text.lines().map(|line| line.split('\t').map(str::to_owned).collect()).collect()
    }

    /// All steps have passed, and their rows are committed.
    fn passed() -> Self {
        let repository = Self::new();
        let (output, said) = repository.run(&[], "");
        assert!(output.status.success(), "{said}");
        repository.commit();
        repository
    }
}

fn set(steps: &[&str]) -> BTreeSet<String> {
    steps.iter().map(|step| (*step).to_owned()).collect()
}

/// Oracle: the table of crates in ARCHITECTURE.md, gone through by hand.
#[test]
fn a_change_outdates_exactly_the_steps_that_depend_on_it() {
    let repository = Repository::passed();
    assert_eq!(repository.check().1, set(&[]));
    let all_but_book = &ALL[1..];
    let cases: [(&str, &[&str]); 24] = [
        ("CHANGELOG.md", &[]),
        ("docs/pages/nightly.md", &[]),
        ("docs/proof.md", &["book"]),
        ("docs/measurements/stability.json", &["book", "tests"]),
        (
            "materials/gold.toml",
            &[
                "babylon",
                "bevy",
                "c",
                "examples",
                "farm",
                "formats",
                "fuzz",
                "godot",
                "gpu",
                "materialx",
                "playcanvas",
                "python",
                "random",
                "release",
                "tests",
            ],
        ),
        ("examples/wgpu/main.rs", &["examples"]),
        ("examples/farm/job", &["farm"]),
        ("examples/c/ball.c", &["c"]),
        ("examples/c/difference.py", &["c", "materialx"]),
        ("examples/web/src/surface.js", &["babylon", "examples", "playcanvas"]),
        ("examples/web/workshop.mjs", &["babylon", "examples", "godot", "playcanvas"]),
        ("examples/mitsuba/luthier_bsdf.py", &["mitsuba"]),
        ("tests/crash/kill.c", &["crash"]),
        ("scripts/engines/furnace.sh", &["engines"]),
        ("Cargo.lock", all_but_book),
        ("crates/luthier-optics/src/lib.rs", all_but_book),
        // An example's build script bakes.
        ("crates/luthier-build/src/lib.rs", &["examples", "installed", "packages", "promises"]),
        // Tests of a crate matter to those who run them.
        ("crates/luthier-optics/tests/all.rs", &["installed", "packages", "promises"]),
        ("crates/luthier-gpu/tests/all.rs", &["gpu", "installed", "packages", "promises"]),
        ("crates/luthier-lut/tests/all.rs", &["installed", "packages", "promises", "random"]),
        // The window is a feature of the command.
        ("crates/luthier-view/src/lib.rs", &["installed", "packages", "promises", "release"]),
        // Meshes are for pictures, and their files for imports, which are a part of the command.
        (
            "crates/luthier-mesh/src/lib.rs",
            &[
                "babylon",
                "bevy",
                "godot",
                "materialx",
                "playcanvas",
                "c",
                "crash",
                "examples",
                "farm",
                "formats",
                "fuzz",
                "gpu",
                "kind",
                "installed",
                "mitsuba",
                "packages",
                "promises",
                "python",
                "release",
                "scale",
                "tests",
            ],
        ),
        ("crates/luthier-fuzz/corpus/a", &["fuzz", "installed", "packages", "promises"]),
        (
            "crates/luthier-gallery/src/lib.rs",
            &[
                "babylon",
                "bevy",
                "godot",
                "materialx",
                "playcanvas",
                "c",
                "crash",
                "examples",
                "farm",
                "formats",
                "gpu",
                "kind",
                "installed",
                "mitsuba",
                "packages",
                "promises",
                "python",
                "release",
                "scale",
            ],
        ),
    ];
    for (file, expected) in cases {
        repository.0.edit(file, |text| text + "\n# changed\n");
        repository.commit();
        let (code, found, said) = repository.check();
        assert_eq!(found, set(expected), "{file}: {said}");
        // Only the cheap step is an error.
        assert_eq!(code, i32::from(expected.contains(&"book")), "{file}: {said}");
        repository.git(&["reset", "--quiet", "--hard", "HEAD~1"]);
    }
    // What a step does is a part of what it depends on.
    repository.0.edit("scripts/nightly.sh", |text| text.replace("fuzz.sh 600", "fuzz.sh 6"));
    assert_eq!(repository.check().1, set(&["fuzz"]));
}

#[test]
fn rows_tell_the_commit_and_how_far_it_is_behind() {
    let repository = Repository::passed();
    let commit = repository.git(&["rev-parse", "--short=12", "HEAD~1"]);
    assert!(repository.rows().iter().all(|row| row.len() == 7 && row[2] == commit));
    for _ in 0..3 {
        repository.0.edit("materials/gold.toml", |text| text + "#\n");
        repository.commit();
    }
    let (_, _, said) = repository.check();
    assert!(said.contains(&format!("the nightly step `farm` passed at {commit}, 3 changes ago")), "{said}");
    assert!(repository.run(&["--page"], "").0.status.success());
    let page = repository.0.text("docs/pages/nightly.md");
    let line = |step: &str| page.lines().find(|line| line.starts_with(&format!("| `{step}`"))).unwrap().to_owned();
    let row = repository.rows().into_iter().find(|row| row[0] == "farm").unwrap();
    assert!(line("farm").ends_with(&format!("| `{commit}` | `{}` | 3 |", row[1])), "{}", line("farm"));
    assert!(line("kind").ends_with("| 0 |"));
    assert!(line("architecture").contains("| never |"));
}

#[test]
fn rows_that_no_run_wrote_are_refused() {
    let repository = Repository::passed();
    let kept = repository.0.text("docs/measurements/nightly.tsv");
    for place in 1..6 {
        let mut rows = repository.rows();
        let crash = rows.iter_mut().find(|row| row[0] == "crash").unwrap();
        crash[place] = "9".repeat(crash[place].len());
        let lines: Vec<String> = rows.iter().map(|row| row.join("\t") + "\n").collect();
        repository.0.write("docs/measurements/nightly.tsv", lines.concat());
        let (code, _, said) = repository.check();
        assert!(code == 1 && said.contains("no run wrote the row of the nightly step `crash`"), "{place}: {said}");
    }
    repository.0.write("docs/measurements/nightly.tsv", kept + "crash\t942ee093bbade903\t359\t2026-11-25\n");
    assert_eq!(repository.check().0, 1);
}

#[test]
fn a_step_runs_on_what_is_committed() {
    let repository = Repository::passed();
    let before = repository.rows();
    for change in [("materials/gold.toml", "# changed"), ("materials/new.toml", "# new")] {
        repository.0.write(change.0, change.1);
        let (output, said) = repository.run(&["farm"], "");
        assert!(output.status.code() == Some(1) && said.contains("runs on what is committed"), "{said}");
        assert!(said.contains(change.0), "{said}");
        assert_eq!(repository.rows(), before);
        // Another step does not depend on it.
        assert!(repository.run(&["book"], "").0.status.success());
        fs::remove_file(repository.0.path(change.0)).unwrap();
        repository.git(&["checkout", "--quiet", "--", "materials"]);
        repository.git(&["checkout", "--quiet", "--", "docs"]);
    }
}

#[test]
fn a_step_that_fails_loses_its_row_and_stops_no_other() {
    let repository = Repository::passed();
    let (output, said) = repository.run(&["kind", "scale"], "add-kind.sh");
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("failed with 1: kind"), "{said}");
    let steps: Vec<String> = repository.rows().into_iter().map(|row| row[0].clone()).collect();
    assert!(!steps.contains(&"kind".to_owned()) && steps.last().unwrap() == "scale", "{steps:?}");
    let (output, said) = repository.run(&["nothing"], "");
    assert!(output.status.code() == Some(2) && said.contains("no nightly step `nothing`"), "{said}");
}
