//! Files that are no files, and texts made to be expensive. A command that waits for a pipe or reads a device to its end does not
//! return; the workshop's patience makes that a failure.

use std::fs;

use luthier_workshop::material_texts::{film, gold, matte};

use crate::workshop::Workshop;

/// Odd things where a file is expected: their names, and the words of the message.
#[cfg(unix)]
const ODD: [(&str, &str); 3] =
    [("pipe", "a pipe or a device"), ("zero", "a pipe or a device"), ("folder", "it is a folder")];

/// A folder with a pipe that nobody writes to, a way to a device without end, and a folder, each under all the extensions of files.
#[cfg(unix)]
fn workshop() -> Workshop {
    let workshop = Workshop::with(&[("matte.toml", &matte("matte"))]);
    for extension in ["toml", "csv", "png", "hdr", "exr"] {
        let path = |name: &str| workshop.path(&format!("{name}.{extension}"));
        assert!(std::process::Command::new("mkfifo").arg(path("pipe")).status().unwrap().success());
        std::os::unix::fs::symlink("/dev/zero", path("zero")).unwrap();
        fs::create_dir(path("folder")).unwrap();
    }
    workshop
}

#[cfg(unix)]
#[test]
fn pipes_devices_and_folders_are_no_files() {
    let workshop = workshop();
    for (odd, words) in ODD {
        workshop.write("ior.toml", gold("x").replace("\"au\"", &format!("\"{odd}.csv\"")));
        workshop.write("map.toml", film("x", &format!("{{ image = \"{odd}.png\" }}")));
        workshop.write(
            "scene.toml",
            format!(
                "scene = 1\nname = \"s\"\n[[material]]\nfile = \"{odd}.toml\"\n[[light]]\ntype = \"environment\"\n[budget]\nmax_rel = 1\n"
            ),
        );
        for verb in ["check", "bake"] {
            for (file, place) in
                [("ior.toml", "ior.toml:6:7"), ("map.toml", "map.toml:12:"), ("scene.toml", "scene.toml:4:8")]
            {
                workshop.run(&[verb, file]).exits(1).says(&[words, place]);
            }
            if odd != "folder" {
                workshop.run(&[verb, &format!("{odd}.toml")]).fails(3, &[words, &format!("{odd}.toml")]);
            }
        }
        let exr = format!("{odd}.exr");
        workshop.run(&["audit", &exr, "--preset", "filament"]).fails(3, &[words, &exr]);
        let csv = format!("{odd}.csv");
        let directions = ["eval", "matte.toml", "--model", "lambert", "--directions", &csv];
        workshop.run(&directions).fails(3, &[words, &csv]);
        #[cfg(feature = "gpu")]
        {
            let hdr = format!("{odd}.hdr");
            workshop.run(&["preview", "matte.toml", "-o", "x.png", "--environment", &hdr]).fails(3, &[words, &hdr]);
        }
    }
    assert!(!workshop.path("out").exists());
}

/// A hundred thousand mistakes: twenty are told, the others counted.
#[test]
fn many_mistakes_are_counted() {
    let unknown: String = (0..100_000).map(|i| format!("unknown_{i} = {i}\n")).collect();
    let workshop = Workshop::with(&[("x.toml", &matte("x").replacen("\n\n", &format!("\n{unknown}\n"), 1))]);
    let run = workshop.run(&["check", "x.toml"]).exits(1);
    assert_eq!(run.errors().len(), 21);
    assert!(run.stderr.contains("error: and 99980 more errors"), "{}", run.stderr);
    assert_eq!(run.stdout, "x.toml: 100000 errors\n");
    let json = workshop.run(&["check", "x.toml", "--json"]).exits(1).json();
    assert_eq!(json[0]["diagnostics"].as_array().map(Vec::len), Some(21));
}

/// The names of what is made of a material are those that file systems take.
#[test]
fn names_fit_file_systems() {
    let effects = "\n[effects.patina]\nextent = 0.5\ntransition = 0.5\nmap = { noise = {} }\n";
    let coat = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nsmooth = true\n\n[[layer]]";
    let named = |length: usize| {
        matte(&"n".repeat(length)).replacen("[[layer]]", coat, 1) + effects + "\n[bake]\nfgd = { size = [8, 8] }\n"
    };
    let workshop = Workshop::with(&[("long.toml", &named(100)), ("longer.toml", &named(101))]);
    workshop.run(&["bake", "long.toml", "-q"]).exits(0);
    assert!(workshop.path(&format!("out/maps/{}-patina.png", "n".repeat(100))).exists());
    for verb in ["check", "bake"] {
        workshop.run(&[verb, "longer.toml"]).exits(1).says(&["101 characters", "at most 100", "longer.toml:2:8"]);
    }
}
