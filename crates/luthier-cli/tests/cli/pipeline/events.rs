//! `--events`: standard error has lines of JSON and nothing else, whatever happens.

use luthier_workshop::material_texts::{doubtful, gold, lacquer, matte};
use serde_json::Value;

use crate::workshop::Workshop;

/// Runs a bake with events, and gives them: every line is an object with a name.
fn events(workshop: &Workshop, words: &[&str], code: i32) -> Vec<Value> {
    let run = workshop.run(&[words, &["--events"]].concat()).exits(code);
    let line = |line: &str| -> Value {
        let event: Value = serde_json::from_str(line).unwrap_or_else(|e| panic!("{words:?}: {e}: `{line}`"));
        assert!(event["event"].is_string(), "{words:?}: {line}");
        event
    };
    run.stderr.lines().map(line).collect()
}

fn of(events: &[Value], name: &str) -> Vec<Value> {
    events.iter().filter(|event| event["event"] == name).cloned().collect()
}

#[test]
fn warnings_are_events() {
    let workshop = Workshop::with(&[
        ("doubtful.toml", &doubtful("doubtful")),
        ("gold.toml", &gold("gold")),
        ("frustrated.toml", FRUSTRATED),
    ]);
    let told = of(&events(&workshop, &["bake", "doubtful.toml", "--no-cache"], 0), "diagnostic");
    assert_eq!(told.len(), 1, "{told:?}");
    assert_eq!((&told[0]["file"], &told[0]["severity"]), (&"doubtful.toml".into(), &"warning".into()));
    let missed = of(&events(&workshop, &["bake", "frustrated.toml", "--no-cache", "--out", "b"], 0), "diagnostic");
    assert!(missed.iter().any(|told| told["message"].as_str().unwrap().contains("table of layer")), "{missed:?}");
    // A store that is damaged, and warnings of a bake that has nothing to do.
    let bake = ["bake", "doubtful.toml", "--cache", "store", "--out", "c"];
    assert_eq!(of(&events(&workshop, &bake, 0), "published").len(), 1);
    let again = events(&workshop, &bake, 0);
    assert_eq!((of(&again, "up-to-date").len(), of(&again, "note").len()), (1, 1), "{again:?}");
    let bake = ["bake", "gold.toml", "--cache", "store", "--out", "d"];
    events(&workshop, &bake, 0);
    for path in workshop.files("store/objects").iter().filter(|path| path.ends_with("-fresnel")) {
        workshop.write(&format!("store/objects/{path}"), "damaged");
    }
    let told = of(&events(&workshop, &["bake", "gold.toml", "--cache", "store", "--out", "e"], 0), "warning");
    assert!(told.len() == 1 && told[0]["message"].as_str().unwrap().contains("damaged"), "{told:?}");
    // A lock that no longer serves.
    events(&workshop, &["bake", "gold.toml", "--relock", "--cache", "store", "--out", "f"], 0);
    assert_eq!(
        of(&events(&workshop, &["bake", "gold.toml", "--check", "--out", "g", "--no-cache"], 1), "failed").len(),
        0
    );
}

/// A film that absorbs what would be totally reflected: no row is smooth over any cosine, and its tile misses the aim of a bake.
const FRUSTRATED: &str = "schema = 1
name = \"frustrated\"
exterior = 1.5

[[layer]]
type = \"thin-film\"
ior = { n = 1.45, k = 0.02 }
thickness_nm = 200

[[layer]]
type = \"dielectric\"
ior = 1.0
alpha = 0.1

[bake]
model = \"elek\"

[bake.fgd]
size = [8, 8]
";

#[test]
fn failures_are_events() {
    let workshop = Workshop::with(&[
        ("lacquer.toml", &lacquer("lacquer")),
        ("broken.toml", "schema = 1\nname = \"broken\"\nshine = 3\n"),
        ("matte.toml", &matte("matte")),
        ("bad/luthier.lock", "no lock"),
        ("bad/matte.toml", &matte("matte")),
        ("scene.toml", "scene = 1\nname = \"scene\"\n[[material]]\nfile = \"none.toml\"\n"),
    ]);
    for (words, code, kind) in [
        (&["bake", "broken.toml"][..], 1, "input"),
        (&["bake", "none.toml"], 3, "files"),
        (&["bake", "scene.toml"], 1, "input"),
        (&["bake", "bad"], 1, "input"),
        (&["bake", "matte.toml", "--out", "matte.toml/x"], 3, "files"),
        (&["bake", "matte.toml", "--cache", "matte.toml"], 3, "files"),
        (&["bake", "matte.toml", "--shine"], 2, "usage"),
        (&["bake", "matte.toml", "--threads", "none"], 2, "usage"),
        (&["polish", "matte.toml"], 2, "usage"),
        (&["merge", "matte.toml"], 2, "usage"),
        (&["bake", "matte.toml", "--allow-miss"], 2, "usage"),
        (&["bake", "lacquer.toml", "--max-abs", "1e-12"], 1, "input"),
    ] {
        let told =
            events(&workshop, &[words, &["--no-cache"][..usize::from(!words.contains(&"--cache"))]].concat(), code);
        let failed = of(&told, "failed");
        assert_eq!(failed.len(), 1, "{words:?}: {told:?}");
        assert_eq!((&failed[0]["code"], &failed[0]["kind"]), (&code.into(), &kind.into()), "{words:?}");
        assert!(!failed[0]["message"].as_str().unwrap().is_empty(), "{words:?}");
    }
    // What is wrong with a file comes before, and with the failure.
    let told = events(&workshop, &["bake", "broken.toml", "--no-cache"], 1);
    let diagnostics = of(&told, "failed")[0]["diagnostics"].as_array().unwrap().len();
    assert!(diagnostics > 0 && of(&told, "diagnostic").len() == diagnostics, "{told:?}");
}

/// Scenes have no jobs of their own to tell of, but what they publish.
#[test]
fn scenes_tell_what_they_publish() {
    let scene = "scene = 1\nname = \"shelf\"\n\n[[material]]\nfile = \"matte.toml\"\n\n[[light]]\ntype = \"directional\"\n\
                 from_eye_deg = 50\n\n[view]\nangles_deg = [0, 45]\nfootprint_deg = 1\n\n[budget]\nmax_rel = 0.5\n";
    let workshop = Workshop::with(&[("matte.toml", &matte("matte")), ("scene.toml", scene)]);
    let told = events(&workshop, &["bake", "scene.toml", "--no-cache", "--allow-miss", "--no-fit"], 0);
    assert_eq!(of(&told, "published").len(), 1, "{told:?}");
}
