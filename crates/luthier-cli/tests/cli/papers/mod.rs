//! Every element of the five papers, from a material file to a value: `docs/pages/papers.md`, which `LUTHIER_ACCEPT=1` writes.

mod element;
mod measured;

use std::collections::BTreeSet;
use std::fmt::Write as _;

use element::{Element, Paper, papers};
use luthier_gpu::Gpu;
use luthier_workshop::root;
use measured::{GPU, Number, measured};
use rayon::prelude::*;

/// Gaps that are known: columns of elements that still begin with `open`. The number may fall only.
const OPEN: usize = 0;

/// Elements without a gap, and with a number of their own.
const ALL: usize = 125;

const HEAD: &str = "\
# Elements of the papers

A test of the command made this page, and compares it with every run: `LUTHIER_ACCEPT=1 cargo test -p luthier-cli --test cli papers`. It reads the elements from the files in
`tests/papers/`. Each has a material file, which the test bakes. *In a file* is the key, or the option, that asks for the element. *Function* is a
function of the emitted shader that has it, *table* the kind of table that its form `baked` reads. *With* and *without* are f cos theta_i by `luthier eval`, for the same
file and for one that lacks the element alone, where they differ most over three pairs of directions and three channels. *Device* is the largest
difference between the shader and `luthier eval` that the test allows, relative to the brightest channel. *By hand* is the row of [by-hand.md](by-hand.md), a calculation in
another language. **Open** is a gap; *none* says that the paper has no such figure, or that the element needs no table.

";

/// All elements are described, and every third is measured, as the page says.
#[test]
fn elements_are_measured() {
    measure(3);
}

#[test]
#[ignore = "a minute: scripts/nightly.sh tests"]
fn every_element_is_measured() {
    measure(1);
}

/// Compares the page with one of so many elements: nothing is empty, no two share what they are measured by, and the page is up to date. Writes
/// it with all.
fn measure(step: usize) {
    let papers = papers();
    let mut subjects = BTreeSet::new();
    let by_hand = std::fs::read_to_string(root().join("docs/pages/by-hand.md")).unwrap();
    for element in papers.iter().flat_map(|paper| &paper.elements) {
        element.check();
        assert!(
            !element.is_measured() || subjects.insert(element.subject()),
            "{}: measured as another element is",
            element.name()
        );
        if let Some(hand) = element.get("hand") {
            assert!(by_hand.contains(&format!("| {hand} |")), "{}: no row `{hand}`", element.name());
        }
    }
    let all: Vec<&Element> = papers.iter().flat_map(|paper| &paper.elements).collect();
    let open = all.iter().filter(|element| element.is_open()).count();
    assert_eq!((all.len(), open), (ALL, OPEN), "elements, and those with a gap");
    let Some(gpu) = &*GPU else { return };
    let is_accepted = std::env::var_os("LUTHIER_ACCEPT").is_some();
    let page = page(&papers, open, gpu, if is_accepted { 1 } else { step });
    let path = root().join("docs/pages/papers.md");
    if is_accepted {
        std::fs::write(&path, &page).unwrap();
    }
    let known = std::fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(known.lines().count(), page.lines().count(), "docs/pages/papers.md is not up to date");
    for (known, found) in known.lines().zip(page.lines()) {
        let same = known.split('|').zip(found.split('|')).all(|(a, b)| is_alike(a.trim(), b.trim()));
        assert!(same, "docs/pages/papers.md is not up to date:\n{known}\n{found}");
    }
}

/// In place of a number of an element that was not measured.
const UNMEASURED: &str = "?";

/// Numbers may differ in their last digits from platform to platform.
fn is_alike(known: &str, found: &str) -> bool {
    match (known.parse::<f64>(), found.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= 0.02 * a.abs().max(b.abs()),
        _ => known == found || found == UNMEASURED,
    }
}

/// The page, with the numbers of one element of `step`.
fn page(papers: &[Paper], open: usize, gpu: &Gpu, step: usize) -> String {
    let mut page = HEAD.to_owned();
    let all = papers.iter().map(|paper| paper.elements.len()).sum::<usize>();
    writeln!(page, "{all} elements, {} of them without a gap.", all - open).unwrap();
    for paper in papers {
        let whole = paper.elements.iter().filter(|element| !element.is_open()).count();
        writeln!(page, "\n## {}\n\n{whole} of {} elements without a gap.\n", paper.title, paper.elements.len())
            .unwrap();
        page.push_str(
            "| element | where | in a file | model | function | table | figure | with | without | device | by hand |\n\
             |---|---|---|---|---|---|---|--:|--:|---|---|\n",
        );
        let measured = |(i, element)| if i % step == 0 { measured(element, gpu) } else { Number::Unmeasured };
        let numbers: Vec<Number> = paper.elements.par_iter().enumerate().map(measured).collect();
        for (element, number) in paper.elements.iter().zip(numbers) {
            row(&mut page, element, number);
        }
    }
    page
}

fn row(page: &mut String, element: &Element, number: Number) {
    let open = |text: &str, whole: String| match text.strip_prefix("open") {
        Some(rest) => format!("**open**{rest}"),
        None => whole,
    };
    let code = |text: &str| open(text, if text.starts_with("none") { text.to_owned() } else { format!("`{text}`") });
    let figure = element.cell("figure");
    let picture = match figure.rsplit_once('.') {
        Some((name, "png" | "svg")) => format!("[{name}](figures/{figure})"),
        _ => open(figure, figure.to_owned()),
    };
    let [with, without, device] = match number {
        Number::Values(values, device) => {
            let [with, without] = values.map(|value| format!("{value:.4}"));
            [with, without, device]
        }
        Number::Unmeasured => [UNMEASURED; 3].map(str::to_owned),
        Number::Open => ["**open**", "-", "-"].map(str::to_owned),
        Number::Page(page) => [format!("[page]({page})"), "-".to_owned(), "-".to_owned()],
    };
    let kind = element.cell("table");
    let table = if kind.contains(' ') { open(kind, kind.to_owned()) } else { code(kind) };
    writeln!(
        page,
        "| {} | {} | {} | `{}` | {} | {table} | {picture} | {with} | {without} | {device} | {} |",
        element.name(),
        element.cell("where"),
        code(element.cell("key")),
        element.get("f64_model").unwrap_or(element.cell("model")),
        code(element.cell("function")),
        element.get("hand").unwrap_or("-"),
    )
    .unwrap();
}
