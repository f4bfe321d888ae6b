//! Materials of public collections, `crates/luthier-material/tests/assets`: `check` takes each with the model `lobes`, and `docs/pages/assets.md` says what that shows of
//! its source. `LUTHIER_ACCEPT=1` writes the page.

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use luthier_workshop::{file_name, material_files, root};

use crate::workshop::Workshop;

const FOLDER: &str = "crates/luthier-material/tests/assets";

const HEAD: &str = "\
# Materials of public collections

A test of the command made this page, and compares it with every run: `LUTHIER_ACCEPT=1 cargo test -p luthier-cli --test cli assets`. It reads the header lines of the files in
`crates/luthier-material/tests/assets`, which were written by hand from the numbers of their sources, and asks `luthier check` for the model of each. No file names a model.

- *Shown* is in the bake, texel by texel where the source has a texture. *Approximated* follows a rule that is not that of the source. *Dropped* is in the source alone.
- The materials were chosen by hand, those with textures and coats first. No collection was tried as a whole.
- Textures are stand-ins of 16 x 16 texels, by `scripts/asset-pictures.py`. The table says which parts of a source a file can have, not how near its pictures are.
- Formats of engines let light bounce once, and layers add up; `lobes` has all bounces. That is in no row, because it holds for all.
- Transmission, sheen and emission are the program's, and no material here was chosen for them.
";

/// A file, and the words of its header lines.
struct Asset {
    path: PathBuf,
    text: String,
}

impl Asset {
    /// Those of a folder, which is not there if none is out.
    fn all(folder: &str) -> Vec<Self> {
        if !root().join(folder).is_dir() {
            return Vec::new();
        }
        let read = |path: PathBuf| Self { text: fs::read_to_string(&path).unwrap(), path };
        material_files(folder).into_iter().map(read).collect()
    }

    /// The words after `# KEY: `.
    fn words(&self, key: &str) -> &str {
        let start = format!("# {key}: ");
        self.text
            .lines()
            .find_map(|line| line.strip_prefix(&start))
            .unwrap_or_else(|| panic!("{}: no {start}", self.name()))
    }

    fn name(&self) -> &str {
        file_name(&self.path)
    }

    /// Where the numbers are from, without the note on textures.
    fn source(&self) -> &str {
        self.words("Source").trim_end_matches("; textures are stand-ins")
    }

    fn has_textures(&self) -> bool {
        self.text.contains(".png")
    }
}

#[test]
fn every_material_keeps_lobes() {
    let (kept, out) = (Asset::all(FOLDER), Asset::all(&format!("{FOLDER}/out")));
    let workshop = Workshop::new();
    let mut page = HEAD.to_owned();
    let all = kept.len() + out.len();
    let count = |has: &dyn Fn(&Asset) -> bool| kept.iter().filter(|asset| has(asset)).count();
    writeln!(
        page,
        "\n{all} materials were tried. {} keep `lobes` with all that their files have, {} of them with textures; out: {}. Of those that keep it, {} approximate nothing, {} drop nothing, \
         and {} do neither.\n",
        kept.len(),
        count(&Asset::has_textures),
        out.len(),
        count(&|asset| asset.words("Approximated") == "nothing"),
        count(&|asset| asset.words("Dropped") == "nothing"),
        count(&|asset| asset.words("Approximated") == "nothing" && asset.words("Dropped") == "nothing"),
    )
    .unwrap();
    page.push_str(
        "| file | source | what it is | model | shown | approximated | dropped |\n|---|---|---|---|---|---|---|\n",
    );
    for asset in &kept {
        let run = workshop.run(&["check", asset.path.to_str().unwrap()]).exits(0);
        assert_eq!(run.stderr, "", "{}", asset.name());
        let (_, model) = run.stdout.trim_end().rsplit_once(", model ").unwrap_or_else(|| panic!("{}", run.stdout));
        assert_eq!(model, "lobes", "{}", asset.name());
        let [means, shown, approximated, dropped] =
            ["Means", "Shown", "Approximated", "Dropped"].map(|key| asset.words(key));
        let (name, source) = (asset.name(), asset.source());
        writeln!(page, "| {name} | {source} | {means} | {model} | {shown} | {approximated} | {dropped} |").unwrap();
    }
    if !out.is_empty() {
        page.push_str(
        "\n## Out\n\nEach of these asks for something that no material file can say, or that `lobes` leaves out. The last column is what `check` says.\n\n\
         | file | source | what it is | shown | approximated | dropped | why |\n|---|---|---|---|---|---|---|\n",
    );
    }
    for asset in &out {
        let run = workshop.run(&["check", asset.path.to_str().unwrap()]);
        let why = asset.words("Out");
        let said: Vec<&str> = run
            .stderr
            .lines()
            .filter_map(|line| line.strip_prefix("error: ").or(line.strip_prefix("warning: ")))
            .collect();
        assert_eq!(said.join("; "), why, "{}: if it keeps `lobes` now, move it up", asset.name());
        let [means, shown, approximated, dropped] =
            ["Means", "Shown", "Approximated", "Dropped"].map(|key| asset.words(key));
        let (name, source) = (asset.name(), asset.source());
        writeln!(page, "| {name} | {source} | {means} | {shown} | {approximated} | {dropped} | {why} |").unwrap();
    }
    let path = root().join("docs/pages/assets.md");
    if std::env::var_os("LUTHIER_ACCEPT").is_some() {
        fs::write(&path, &page).unwrap();
    }
    let known = fs::read_to_string(&path).unwrap_or_default();
    assert!(known == page, "docs/pages/assets.md is not up to date: run this test with LUTHIER_ACCEPT=1");
}
