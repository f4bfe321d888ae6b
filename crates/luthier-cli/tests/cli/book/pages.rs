//! Pages of the repository, and their parts.

use std::fs;
use std::path::{Path, PathBuf};

use luthier_workshop::root;

/// A page that people read.
pub(crate) struct Page {
    /// Path from the root of the repository, with forward slashes.
    pub(crate) name: String,
    pub(crate) path: PathBuf,
    pub(crate) text: String,
}

/// A fenced block.
pub(crate) struct Block<'p> {
    /// Language.
    pub(crate) language: &'p str,
    /// Number of its first line.
    pub(crate) line: usize,
    /// The line above the fence that is not empty.
    pub(crate) above: &'p str,
    pub(crate) text: String,
}

/// The pages in the root, in `docs/` and of the examples.
pub(crate) fn pages() -> Vec<Page> {
    let root = root();
    let mut folders = vec![root.clone(), root.join("docs"), root.join("docs/pages"), root.join("docs/measurements")];
    folders.extend(fs::read_dir(root.join("examples")).unwrap().map(|entry| entry.unwrap().path()));
    let files = folders.iter().filter(|folder| folder.is_dir()).flat_map(|folder| fs::read_dir(folder).unwrap());
    let mut paths: Vec<PathBuf> =
        files.map(|entry| entry.unwrap().path()).filter(|path| path.extension().is_some_and(|e| e == "md")).collect();
    paths.sort();
    let page = |path: PathBuf| Page {
        name: path.strip_prefix(&root).unwrap().to_str().unwrap().replace('\\', "/"),
        text: fs::read_to_string(&path).unwrap().replace("\r\n", "\n"),
        path,
    };
    paths.into_iter().map(page).collect()
}

impl Page {
    /// Its fenced blocks.
    pub(crate) fn blocks(&self) -> Vec<Block<'_>> {
        let mut blocks = Vec::new();
        let mut open: Option<Block<'_>> = None;
        let mut above = "";
        for (number, line) in self.text.lines().enumerate() {
            match (&mut open, line.strip_prefix("```")) {
                (None, Some(language)) => {
                    open = Some(Block { language, line: number + 2, above, text: String::new() });
                }
                (Some(_), Some(_)) => blocks.extend(open.take()),
                (Some(block), None) => block.text += &format!("{line}\n"),
                (None, None) if !line.is_empty() => above = line,
                (None, None) => {}
            }
        }
        assert!(open.is_none(), "{}: a block is not closed", self.name);
        blocks
    }

    /// Its lines outside of blocks.
    pub(crate) fn prose(&self) -> impl Iterator<Item = &str> {
        let mut is_code = false;
        self.text.lines().filter(move |line| {
            let is_fence = line.starts_with("```");
            is_code ^= is_fence;
            !is_code && !is_fence && !line.starts_with("    ")
        })
    }

    /// The anchors that it names, and those of its headings, as GitHub and mdBook make them.
    pub(crate) fn anchors(&self) -> Vec<String> {
        let named = self.text.split("<a id=\"").skip(1).filter_map(|rest| rest.split('"').next());
        let mut anchors: Vec<String> = named.map(str::to_owned).collect();
        for line in self.prose().filter(|line| line.starts_with('#')) {
            let heading = line.trim_start_matches('#').trim();
            let plain = heading.to_lowercase().replace(' ', "-");
            let kept: String = plain.chars().filter(|c| c.is_alphanumeric() || matches!(c, '-' | '_')).collect();
            let times = anchors.iter().filter(|known| **known == kept).count();
            anchors.push(kept.clone());
            if times > 0 {
                anchors.push(format!("{kept}-{times}"));
            }
        }
        anchors
    }

    /// Destinations of its links and pictures.
    pub(crate) fn links(&self) -> Vec<&str> {
        let ends = self.prose().flat_map(|line| line.split("](").skip(1));
        ends.filter_map(|rest| rest.split(')').next()).filter(|link| !link.contains("://")).collect()
    }

    /// The folder that links begin at.
    pub(crate) fn folder(&self) -> &Path {
        self.path.parent().unwrap()
    }
}

/// Fails where a picture of a page is not the one that its command makes now. Drivers differ in last bits; a changed number is seen.
#[cfg(feature = "gpu")]
pub(crate) fn assert_alike(made: &Path, kept: &Path) {
    let [made, known] = [made, kept].map(|path| image::open(path).unwrap().to_rgb8());
    assert_eq!(made.dimensions(), known.dimensions(), "{}", kept.display());
    let apart: u64 = made.as_raw().iter().zip(known.as_raw()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    let mean = apart as f64 / made.as_raw().len() as f64;
    assert!(mean < 0.5, "{} is off by {mean:.2} of 255: scripts/pages.sh recipes tutorial", kept.display());
}
