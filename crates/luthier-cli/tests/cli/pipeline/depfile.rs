//! What Make and Ninja read of a depfile.

use std::fs::{File, FileTimes};
use std::path::Path;
use std::process::Command;
use std::time::{Duration, SystemTime};

use luthier_workshop::material_texts::matte;
use luthier_workshop::{Program, is_installed};

use crate::workshop::{Luthier, Workshop};

/// A folder with an odd name that holds a material, and the rules that bake it into another.
struct Build {
    workshop: Workshop,
    program: &'static str,
}

impl Build {
    /// `folder` is baked into `out` by `program`, with the depfile in `dep.d`. The command counts its runs in `runs`.
    fn new(program: &'static str, folder: &str, out: &str) -> Self {
        let build = Self { workshop: Workshop::new(), program };
        build.workshop.write(&format!("{folder}/m.toml"), matte("m"));
        let quoted = |text: &str| format!("'{}'", text.replace('\'', "'\\''"));
        let command = format!(
            "echo run >>runs && {} bake {} --out={} --no-fit --depfile dep.d --quiet",
            quoted(Luthier::PATH),
            quoted(folder),
            quoted(out)
        )
        .replace('$', "$$");
        let escaped = |signs: &str, sign: &str| {
            let name = format!("{out}/manifest.json").replace('$', "$$");
            signs.chars().fold(name, |name, c| name.replace(c, &format!("{sign}{c}")))
        };
        let (rules, text) = match program {
            "make" => ("Makefile", format!("{}:\n\t{command}\n-include dep.d\n", escaped(" #:", "\\"))),
            _ => {
                let rule = format!("rule bake\n  command = {command}\n  depfile = dep.d\n  deps = gcc\n");
                ("build.ninja", format!("{rule}build {}: bake\n", escaped(" :", "$")))
            }
        };
        build.workshop.write(rules, text);
        build
    }

    /// Builds; the runs of the command.
    fn runs(&self) -> usize {
        let output =
            Command::new(self.program).current_dir(self.workshop.path("")).env("LUTHIER_CACHE", "").output().unwrap();
        let said = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
        assert!(output.status.success(), "{said}");
        assert!(!said.contains("warning"), "{said}");
        let runs = std::fs::read_to_string(self.workshop.path("runs")).unwrap_or_default().lines().count();
        let _ = std::fs::remove_file(self.workshop.path("runs"));
        runs
    }

    /// Dates a file now.
    fn touch(&self, path: &str) {
        let file = File::open(self.workshop.path(path)).unwrap();
        file.set_times(FileTimes::new().set_modified(SystemTime::now())).unwrap();
    }

    /// Gives everything a date an hour ago, so that no later one is the same.
    fn settle(&self) {
        fn age(path: &Path) {
            if path.is_dir() {
                std::fs::read_dir(path).unwrap().for_each(|entry| age(&entry.unwrap().path()));
            }
            let file = File::open(path).unwrap();
            let modified = file.metadata().unwrap().modified().unwrap();
            file.set_times(FileTimes::new().set_modified(modified - Duration::from_secs(3600))).unwrap();
        }
        age(&self.workshop.path(""));
    }
}

fn programs() -> impl Iterator<Item = &'static str> {
    [("make", "make"), ("ninja", "ninja-build")]
        .into_iter()
        .filter(|(program, package)| is_installed(program, package))
        .map(|(program, _)| program)
}

const NAMES: [&str; 19] = [
    "a b", "#1", "$x", "10:30:00", "a~b", "~x", "[1]", "]", "-x", "+x", "é", "a'b", "(c)", "{d}", "e,f", "@g", "!h",
    "i%j", "k=l",
];

/// Oracle: the programs themselves. A name that they do not read is missed, or makes them bake each time.
#[test]
fn both_read_every_name() {
    for program in programs() {
        for name in NAMES {
            // Ninja reads it since version 1.13.
            if program == "ninja" && name.contains('\'') {
                continue;
            }
            // The first of the names is none that Make takes for a variable; a target has no `%` and no `=`.
            let is_target = !name.contains(['%', '=']) && !name.starts_with('~');
            let out = if is_target { format!("{name}.out") } else { "out".to_owned() };
            let build = Build::new(program, &format!("m/{name}"), &out);
            if name.contains('=') {
                let bake = ["bake", &format!("m/{name}"), "--depfile", "dep.d"];
                build.workshop.run(&bake).fails(1, &["--depfile cannot name"]);
                continue;
            }
            assert_eq!((build.runs(), build.runs()), (1, 0), "{program} {name}");
            build.settle();
            assert_eq!(build.runs(), 0, "{program} {name}");
            build.touch(&format!("m/{name}/m.toml"));
            assert_eq!((build.runs(), build.runs()), (1, 0), "{program} {name}: touched");
        }
    }
}

/// A material that comes into the folder is baked, and nothing is baked twice; the package may lie in the folder.
#[test]
fn a_folder_is_a_dependency() {
    for program in programs() {
        for out in ["out", "m/out"] {
            let build = Build::new(program, "m", out);
            assert_eq!((build.runs(), build.runs()), (1, 0), "{program} {out}");
            build.settle();
            build.workshop.write("m/n.toml", matte("n"));
            assert_eq!((build.runs(), build.runs()), (1, 0), "{program} {out}: a new file");
            let manifest = build.workshop.json(&format!("{out}/manifest.json"));
            assert_eq!(manifest["materials"].as_array().unwrap().len(), 2);
            // The package stays as it is, and its manifest gets a date.
            build.settle();
            build.workshop.write("m/notes.txt", "");
            assert_eq!((build.runs(), build.runs()), (1, 0), "{program} {out}: another file");
        }
    }
}

#[test]
fn folders_that_the_bake_writes_into_are_left_out() {
    let workshop = Workshop::with(&[("m/a.toml", &matte("a")), ("m/inner/b.toml", &matte("b"))]);
    let rule = |words: &[&str], depfile: &str| {
        workshop.run(&[&["bake", "m", "--no-fit", "--quiet", "--depfile", depfile], words].concat()).exits(0);
        workshop.text(depfile)
    };
    let files = "m/a.toml \\\n  m/inner/b.toml";
    assert_eq!(rule(&[], "m.d"), format!("out/manifest.json: {files} \\\n  m/. \\\n  m/inner/.\n"));
    assert_eq!(rule(&[], "m/m.d"), format!("out/manifest.json: {files} \\\n  m/inner/.\n"));
    assert_eq!(rule(&["--out", "m"], "m.d"), format!("m/manifest.json: {files}\n"));
}

#[test]
fn a_bake_whose_files_cannot_be_named_is_not_begun() {
    let workshop = Workshop::with(&[("a;b/m.toml", &matte("m"))]);
    workshop.run(&["bake", "a;b", "--depfile", "m.d"]).fails(1, &["--depfile cannot name", "a;b/m.toml", "';'"]);
    assert_eq!(workshop.files(""), ["a;b/m.toml"]);
}
