//! The page of foreign files.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::record::{Collection, Counted, Data};

const INTRODUCTION: &str = "\
# Files that others wrote

`luthier-lab foreign` makes this page, from `docs/measurements/foreign.json`. It tries every file of a public collection with the reader that bakes and pictures
use: meshes with that of `--mesh`, skies with that of `--environment`, pictures with that of maps, and tables of indices with that of `ior`. Materials of glTF and
MaterialX are imported, checked and baked: notes are what is approximated or dropped, and the models that their materials take. No file of these
collections is part of this repository: fetch one by hand, and run

    luthier-lab foreign --collection NAME --data docs/measurements/foreign.json --page docs/pages/foreign.md FOLDER

A file is *read*, with notes on what luthier ignores of it or without, or it is *refused* with a reason. Numbers in reasons are `N` here. A panic is a
fault of luthier.
";

/// The page of all collections.
pub(super) fn of(data: &Data) -> String {
    let mut out = INTRODUCTION.to_owned();
    // Writing to a string does not fail.
    let _ = tables(&mut out, data);
    out
}

fn tables(out: &mut String, data: &Data) -> std::fmt::Result {
    writeln!(out, "\n## Collections\n\n| collection | from | licence |\n|---|---|---|")?;
    for Collection { name, from, licence, .. } in &data.collections {
        writeln!(out, "| {} | {} | {} |", cell(name), cell(from), cell(licence))?;
    }
    let kinds =
        || data.collections.iter().flat_map(|of| of.kinds.iter().map(move |(kind, counted)| (of, kind, counted)));
    writeln!(out, "\n## Counts\n")?;
    writeln!(out, "| collection | kind | files | read | of these with notes | refused | panics | slowest |")?;
    writeln!(out, "|---|---|---|---|---|---|---|---|")?;
    for (of, kind, counted) in kinds() {
        let Counted { files, read, noted, refused, panicked, slowest, slowest_s, .. } = counted;
        let [refused, panicked] = [refused, panicked].map(|of| of.values().map(Vec::len).sum::<usize>());
        let slowest = if slowest.is_empty() { String::new() } else { format!("{slowest_s} s: {}", cell(slowest)) };
        let name = cell(&of.name);
        writeln!(out, "| {name} | {kind} | {files} | {read} | {noted} | {refused} | {panicked} | {slowest} |")?;
    }
    for (of, kind, counted) in kinds() {
        for (what, groups) in [("Notes", &counted.notes), ("Refused", &counted.refused), ("Panics", &counted.panicked)]
        {
            if !groups.is_empty() {
                writeln!(out, "\n## {what}: {}, {kind}\n\n| files | words |\n|---|---|", of.name)?;
                let names = what != "Notes";
                rows(out, groups, names)?;
            }
        }
    }
    Ok(())
}

/// A row for each sentence, the most frequent first, and under them the files of each, where they are to be named.
fn rows(out: &mut String, groups: &BTreeMap<String, Vec<String>>, names: bool) -> std::fmt::Result {
    let mut groups: Vec<_> = groups.iter().collect();
    groups.sort_by_key(|(_, files)| std::cmp::Reverse(files.len()));
    for (sentence, files) in &groups {
        writeln!(out, "| {} | {} |", files.len(), cell(sentence))?;
    }
    for (sentence, files) in groups.iter().filter(|_| names) {
        let files: Vec<String> = files.iter().map(|file| format!("`{}`", file.replace('`', "'"))).collect();
        writeln!(out, "\n{}: {}", cell(sentence), files.join(", "))?;
    }
    Ok(())
}

/// A text in a cell of a table: one line, and no sign that ends the cell or begins a tag.
fn cell(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|").replace('<', "&lt;")
}
