//! The tutorial, followed by the letter: files are saved, commands run in order, and each prints what the page says.

use std::path::Path;
use std::process::Command;

use luthier_workshop::{Program, root};

use super::pages::{Page, assert_alike, pages};
use crate::workshop::{Luthier, Workshop};

/// Stands for whatever a line has there: times, and names of adapters.
const ANY: char = '…';

/// A command, and the lines that it prints according to the page.
struct Step {
    command: String,
    expected: Vec<String>,
}

fn steps(block: &str) -> Vec<Step> {
    let mut steps: Vec<Step> = Vec::new();
    for line in block.lines() {
        match (line.strip_prefix("$ "), steps.last_mut()) {
            (Some(command), _) => steps.push(Step { command: command.to_owned(), expected: Vec::new() }),
            (None, Some(step)) => step.expected.push(line.to_owned()),
            (None, None) => panic!("a block begins without a command: {line}"),
        }
    }
    steps
}

/// Whether a printed line is the one of the page.
fn is_as_printed(expected: &str, found: &str) -> bool {
    match expected.split_once(ANY) {
        None => expected == found,
        Some((before, after)) => found.strip_prefix(before).is_some_and(|rest| rest.ends_with(after)),
    }
}

/// Runs a command of the page in a folder, both streams as a terminal would mix them.
fn run(folder: &Path, command: &str) -> Vec<String> {
    let program = Path::new(Luthier::PATH).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap_or_default());
    let shell = Command::new("sh")
        .args(["-c", &format!("{{ {command}\n}} 2>&1")])
        .current_dir(folder)
        .env("PATH", path)
        .env("LUTHIER_CACHE", "")
        // Drivers of a machine without a desktop complain otherwise.
        .env("XDG_RUNTIME_DIR", folder)
        .env_remove("CI")
        .output()
        .unwrap();
    let text = String::from_utf8(shell.stdout).unwrap();
    text.lines().map(str::to_owned).collect()
}

/// What a page has under `LUTHIER_ACCEPT=1`: lines that still match stay as they are.
fn accepted(step: &Step, found: &[String]) -> String {
    let same =
        |line: &String| step.expected.iter().find(|expected| is_as_printed(expected, line)).unwrap_or(line).clone();
    let lines: Vec<String> = found.iter().map(same).collect();
    std::iter::once(format!("$ {}", step.command)).chain(lines).map(|line| line + "\n").collect()
}

/// The file that a block is saved as, if the sentence above ends with its name and a colon.
fn saved_as(above: &str) -> Option<&str> {
    above.strip_suffix("`:").and_then(|text| text.rsplit_once('`')).map(|(_, name)| name)
}

/// Follows the page in a folder: the page as it should be, and what is wrong with it.
fn follow(page: &Page, workshop: &Workshop) -> (String, Vec<String>) {
    workshop.write("bowl/.keep", "");
    std::os::unix::fs::symlink(root().canonicalize().unwrap(), workshop.path("luthier")).unwrap();
    let folder = workshop.path("bowl");
    let (mut text, mut wrong) = (page.text.clone(), Vec::new());
    let mut count = 0;
    for block in page.blocks() {
        if let Some(name) = saved_as(block.above).filter(|_| block.language != "console") {
            workshop.write(&format!("bowl/{name}"), &block.text);
        }
        if block.language != "console" {
            continue;
        }
        let mut new = String::new();
        for step in steps(&block.text) {
            count += 1;
            let found = run(&folder, &step.command);
            let is_same = found.len() == step.expected.len()
                && found.iter().zip(&step.expected).all(|(found, expected)| is_as_printed(expected, found));
            if !is_same {
                wrong.push(format!("line {}: $ {}\n{}", block.line, step.command, found.join("\n")));
            }
            new += &accepted(&step, &found);
        }
        text = text.replace(&block.text, &new);
    }
    assert!(count >= 12, "{count} commands");
    (text, wrong)
}

#[test]
fn every_command_prints_what_the_page_says() {
    let pages = pages();
    let page = pages.iter().find(|page| page.name == "docs/tutorial.md").unwrap();
    // Pictures need an adapter, and the last step a browser.
    if Workshop::with(&[("x.toml", "schema = 1\nname = \"x\"\nlayer = [{ type = \"diffuse\", albedo = 0.5 }]\n")])
        .run(&["preview", "x.toml", "-o", "x.png", "--size", "16"])
        .lacks_adapter()
        || !["node", "chromium"].into_iter().all(|program| luthier_workshop::is_installed(program, program))
    {
        return;
    }
    let workshop = Workshop::new();
    let (text, wrong) = follow(page, &workshop);
    let pictures: Vec<&str> = page.links().into_iter().filter(|link| link.starts_with("images/tutorial/")).collect();
    assert_eq!(pictures.len(), 4);
    let made = |picture: &str| workshop.path("bowl").join(Path::new(picture).file_name().unwrap());
    if std::env::var_os("LUTHIER_ACCEPT").is_some() {
        std::fs::write(&page.path, text).unwrap();
        for picture in pictures {
            std::fs::copy(made(picture), page.folder().join(picture)).unwrap();
        }
    } else {
        for picture in pictures {
            assert_alike(&made(picture), &page.folder().join(picture));
        }
        assert!(
            wrong.is_empty(),
            "docs/tutorial.md says something else (LUTHIER_ACCEPT=1 takes these):\n{}",
            wrong.join("\n\n")
        );
    }
}
