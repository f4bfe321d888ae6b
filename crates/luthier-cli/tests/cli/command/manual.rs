//! `completions` and `man`: scripts that shells accept, pages that groff accepts, and a reference that leaves no option out.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use luthier_workshop::{is_installed, root};

use crate::workshop::Workshop;

const SHELLS: [&str; 5] = ["bash", "elvish", "fish", "powershell", "zsh"];

/// Whether this build knows the options of all verbs. The window needs no build of its own for that.
const HAS_ALL: bool = cfg!(feature = "gpu") && cfg!(feature = "cost");

/// Names under `Commands:` of a help text.
fn listed(help: &str) -> Vec<String> {
    let lines = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names = lines.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    names.map(|line| line.split_whitespace().next().unwrap().to_owned()).filter(|name| name != "help").collect()
}

/// The command lines of all verbs, those of functions of `table` among them.
fn verbs(workshop: &Workshop) -> Vec<Vec<String>> {
    let mut verbs = Vec::new();
    let mut open = vec![Vec::new()];
    while let Some(words) = open.pop() {
        let mut args: Vec<&str> = words.iter().map(String::as_str).collect();
        args.push("--help");
        let below = listed(&workshop.run(&args).exits(0).stdout);
        open.extend(below.into_iter().map(|verb| [words.as_slice(), &[verb]].concat()));
        verbs.extend((!words.is_empty()).then_some(words));
    }
    assert!(verbs.len() > 15, "{verbs:?}");
    verbs
}

/// Long options of a verb, as its help lists them.
fn options(help: &str) -> BTreeSet<String> {
    let lines = help.lines().filter(|line| line.starts_with("  -") || line.starts_with("      --"));
    let long = lines.filter_map(|line| line.split([' ', '[', '=']).find(|word| word.starts_with("--")));
    long.map(str::to_owned).filter(|option| option != "--help").collect()
}

/// Output of a program that reads a file and has to find no fault in it.
fn finds_no_fault(program: &str, args: &[&str], file: &Path) {
    let output = Command::new(program).args(args).arg(file).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.is_empty(), "{program} {args:?} {}: {said}", file.display());
}

#[test]
fn scripts_complete_every_verb_in_every_shell() {
    let workshop = Workshop::new();
    let verbs = verbs(&workshop);
    for shell in SHELLS {
        let script = workshop.run(&["completions", shell]).exits(0).stdout;
        for verb in verbs.iter().flatten() {
            assert!(script.contains(verb.as_str()), "{shell}: {verb}");
        }
        assert!(script.contains("max-abs"), "{shell}: an option");
        // Scripts of elvish and PowerShell complete no values.
        assert!(script.contains("filament") || ["elvish", "powershell"].contains(&shell), "{shell}: a value");
    }
    workshop.run(&["completions", "tcsh"]).fails(2, &["tcsh"]);
    workshop.run(&["completions"]).fails(2, &[]);
}

#[test]
fn shells_accept_their_scripts() {
    let workshop = Workshop::new();
    for (shell, args) in [("bash", "-n"), ("zsh", "-n"), ("fish", "--no-execute")] {
        if is_installed(shell, shell) {
            let script = workshop.run(&["completions", shell]).exits(0).stdout;
            fs::write(workshop.path(shell), script).unwrap();
            finds_no_fault(shell, &[args], &workshop.path(shell));
        }
    }
}

#[test]
fn bash_completes_verbs_options_and_values() {
    if !is_installed("bash", "bash") {
        return;
    }
    let workshop = Workshop::new();
    fs::write(workshop.path("script"), workshop.run(&["completions", "bash"]).exits(0).stdout).unwrap();
    for (words, expected) in [("che", "check"), ("bake --max-ab", "--max-abs"), ("shader --target wg", "wgsl")] {
        let typed: Vec<&str> = words.split(' ').collect();
        let (last, before) = (typed[typed.len() - 1], typed.get(typed.len().wrapping_sub(2)).unwrap_or(&"luthier"));
        let call = format!(
            "source ./script; COMP_WORDS=(luthier {words}); COMP_CWORD={}; _luthier luthier '{last}' '{before}'; echo \"${{COMPREPLY[*]}}\"",
            typed.len()
        );
        let output = Command::new("bash").args(["-c", &call]).current_dir(workshop.path("")).output().unwrap();
        assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), expected, "{words}: {output:?}");
    }
}

#[test]
fn every_verb_has_a_manual_page() {
    let workshop = Workshop::new();
    let verbs = verbs(&workshop);
    let run = workshop.run(&["man", "--out", "share/man1"]).exits(0);
    assert_eq!(run.stdout, format!("{} pages into share/man1\n", verbs.len() + 1));
    let mut names: BTreeSet<String> = verbs.iter().map(|words| format!("luthier-{}.1", words.join("-"))).collect();
    names.insert("luthier.1".to_owned());
    let entries = fs::read_dir(workshop.path("share/man1")).unwrap();
    let found: BTreeSet<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(found, names);
    for name in &names {
        let path = workshop.path("share/man1").join(name);
        let page = fs::read_to_string(&path).unwrap();
        let title = name.trim_end_matches(".1");
        let version = env!("CARGO_PKG_VERSION");
        assert!(page.starts_with(&format!(".TH {title} 1 \"\" \"luthier {version}\" \"luthier manual\"\n")), "{page}");
        for section in ["NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXAMPLES"] {
            assert!(page.contains(&format!("\n.SH {section}\n")), "{name}: {section}");
        }
        assert!(page.contains("\n.nf\nluthier "), "{name}: examples are set as they are");
    }
    let page = workshop.run(&["man"]).exits(0).stdout;
    assert_eq!(page, fs::read_to_string(workshop.path("share/man1/luthier.1")).unwrap());
    for section in ["EXIT CODES", "ENVIRONMENT VARIABLES"] {
        assert!(page.contains(&format!("\n.SH \"{section}\"\n")), "{page}");
    }
    for words in &verbs {
        let mut args: Vec<&str> = words.iter().map(String::as_str).collect();
        args.push("--help");
        let page = format!("share/man1/luthier-{}.1", words.join("-"));
        let page = fs::read_to_string(workshop.path(&page)).unwrap();
        for option in options(&workshop.run(&args).exits(0).stdout) {
            assert!(page.contains(&option.replace('-', "\\-")), "{words:?}: {option}");
        }
    }
    if is_installed("groff", "groff-base") {
        for name in &names {
            finds_no_fault("groff", &["-man", "-ww", "-z", "-Tutf8"], &workshop.path("share/man1").join(name));
        }
    }
}

#[test]
fn pages_that_cannot_be_written_are_a_failure() {
    let workshop = Workshop::with(&[("file", "")]);
    workshop.run(&["man", "--out", "file"]).fails(3, &["file"]);
    workshop.run(&["man", "--out", "pages", "--markdown"]).fails(2, &["--out"]);
}

/// The page that is part of the repository is the one that the definition gives.
#[test]
fn the_reference_is_up_to_date() {
    let workshop = Workshop::new();
    if !HAS_ALL {
        workshop.run(&["man", "--markdown"]).fails(2, &["--features"]);
        return;
    }
    let page = workshop.run(&["man", "--markdown"]).exits(0).stdout;
    let kept = fs::read_to_string(root().join("docs/reference.md")).unwrap();
    assert!(page == kept, "docs/reference.md is out of date: scripts/pages.sh reference");
}

#[test]
fn the_reference_has_every_option_of_every_verb() {
    if !HAS_ALL {
        return;
    }
    let workshop = Workshop::new();
    let page = workshop.run(&["man", "--markdown"]).exits(0).stdout;
    let mut seen = 0;
    for words in verbs(&workshop) {
        let mut args: Vec<&str> = words.iter().map(String::as_str).collect();
        args.push("--help");
        let help = workshop.run(&args).exits(0).stdout;
        let title = format!("\n## luthier {}\n", words.join(" "));
        let section = page.split_once(&title).unwrap_or_else(|| panic!("no {title}")).1;
        let section = section.split("\n## ").next().unwrap();
        for option in options(&help) {
            let has = |line: &str| {
                line.starts_with("- `-") && line.split(['`', ' ', '[', '=', '.', ',']).any(|w| w == option)
            };
            assert!(section.lines().any(has), "{words:?}: {option}");
            seen += 1;
        }
        assert!(section.contains("Examples:\n\n    luthier "), "{words:?}");
    }
    assert!(seen > 150, "{seen}");
    assert!(page.contains("\n## luthier view\n"), "the window's options are there without the window");
    let codes = page.split_once("Exit codes:\n").unwrap().1;
    (0..=4).for_each(|code| assert!(codes.contains(&format!("\n    {code}  ")), "{code}"));
}
