//! Links, anchors, names of files, and the table of contents.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use luthier_workshop::root;

use super::pages::{Page, pages};

#[test]
fn links_and_anchors_lead_somewhere() {
    let pages = pages();
    let mut count = 0;
    for page in &pages {
        for link in page.links() {
            count += 1;
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { page.path.clone() } else { page.folder().join(file) };
            assert!(target.exists(), "{}: there is no {link}", page.name);
            if anchor.is_empty() {
                continue;
            }
            let target = target.canonicalize().unwrap();
            let of_page = pages.iter().find(|other| other.path.canonicalize().unwrap() == target);
            let has = of_page.is_some_and(|other| other.anchors().iter().any(|known| known == anchor));
            assert!(has, "{}: no heading makes {link}", page.name);
        }
    }
    assert!(count > 200, "{count} links");
}

/// The book has every page of `docs/`, each once, and no page leads out of it: the link would be dead there.
#[test]
fn the_book_has_every_page() {
    let pages = pages();
    let contents = pages.iter().find(|page| page.name == "docs/SUMMARY.md").unwrap();
    let mut listed: Vec<&str> = contents.links();
    listed.sort_unstable();
    let in_docs = pages.iter().filter_map(|page| page.name.strip_prefix("docs/"));
    let mut expected: Vec<&str> = in_docs.filter(|name| *name != "SUMMARY.md").collect();
    expected.sort_unstable();
    assert_eq!(listed, expected);
    let docs = root().join("docs").canonicalize().unwrap();
    for page in pages.iter().filter(|page| page.name.starts_with("docs/")) {
        for link in page.links() {
            let file = link.split('#').next().unwrap();
            let target = page.folder().join(file).canonicalize().unwrap();
            assert!(target.starts_with(&docs), "{}: {link} is not in the book", page.name);
        }
    }
}

/// Paths in backquotes that look like files of the repository: not those that a bake writes.
fn named(page: &Page) -> impl Iterator<Item = &str> {
    let quoted = page.text.split('`').skip(1).step_by(2);
    quoted.filter(|path| {
        let first = path.split('/').next().unwrap_or_default();
        let is_made = ["out", "target", "tables", "shaders", "maps", "build", "luts"].contains(&first);
        path.contains('/')
            && !path.contains("NAME")
            && !path.contains(char::is_whitespace)
            && !is_made
            && Path::new(path).extension().is_some()
    })
}

#[test]
fn files_that_pages_name_exist() {
    let root = root();
    let crates = fs::read_dir(root.join("crates")).unwrap().map(|entry| entry.unwrap().path());
    let mut bases: Vec<PathBuf> = crates.collect();
    bases.extend([root.clone(), root.join("crates")]);
    let mut count = 0;
    // The page of foreign files names those of other repositories.
    for page in pages().into_iter().filter(|page| page.name != "docs/pages/foreign.md") {
        let own = page.folder().to_owned();
        for name in named(&page).collect::<BTreeSet<_>>() {
            count += 1;
            let exists = bases.iter().chain([&own]).any(|base| base.join(name).exists());
            assert!(exists, "{}: there is no {name}", page.name);
        }
    }
    assert!(count > 50, "{count} files are named");
}
