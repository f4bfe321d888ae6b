//! Every element of the five papers, from a material file to a value: `docs/pages/papers.md`, which `LUTHIER_ACCEPT=1` writes.

mod element;
mod measured;
mod out_of_scope;

use std::any::Any;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind};

use element::{Element, Paper, Standing, papers};
use luthier_gpu::Gpu;
use luthier_workshop::root;
use measured::{GPU, Number, measured};
use rayon::prelude::*;

/// Elements that are known to be open. The number may fall only.
const OPEN: usize = 0;

const HEAD: &str = "\
# Elements of the papers

A test of the command made this page, and compares it with every run: `LUTHIER_ACCEPT=1 cargo test -p luthier-cli --test cli papers`. It reads the elements from the files in
`tests/papers/`. Each has a material file, which the test bakes. *In a file* is the key, or the option, that asks for the element. *Function* is a
function of the emitted shader that has it, *table* the kind of table that its form `baked` reads. *With* and *without* are f cos theta_i by `luthier eval`, for the same
file and for one that lacks the element alone, where they differ most over three pairs of directions and three channels. *Device* is the largest
difference between the shader and `luthier eval` that the test allows, relative to the brightest channel. *By hand* is the row of [by-hand.md](by-hand.md), where the document's
formula is worked out in another language and agrees with luthier to what that page allows. **Open** is a gap, or a formula that was not recomputed. *None* says that the paper has no such
figure, that the element needs no table, or why it has no formula: it is a time, a picture, or words.

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
        if let Some(hand) = element.by_hand() {
            assert!(by_hand.contains(&format!("| {hand} |")), "{}: no row `{hand}`", element.name());
        }
    }
    let elements = papers.iter().flat_map(|paper| &paper.elements);
    let open: Vec<&str> = elements.filter(|e| e.standing() == Standing::Open).map(Element::name).collect();
    assert_eq!(open.len(), OPEN, "open elements: {open:?}");
    let Some(gpu) = &*GPU else { return };
    let is_accepted = std::env::var_os("LUTHIER_ACCEPT").is_some();
    let page = page(&papers, gpu, if is_accepted { 1 } else { step });
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
fn page(papers: &[Paper], gpu: &Gpu, step: usize) -> String {
    let mut page = HEAD.to_owned();
    writeln!(page, "{}", counted(papers.iter().flat_map(|paper| &paper.elements))).unwrap();
    for paper in papers {
        writeln!(page, "\n## {}\n\n{}\n", paper.title, counted(&paper.elements)).unwrap();
        page.push_str(
            "| element | where | in a file | model | function | table | figure | with | without | device | by hand |\n\
             |---|---|---|---|---|---|---|--:|--:|---|---|\n",
        );
        // A thread of the pool says why it failed to the test that began the pool: the reason is told again here.
        let measured = |(i, element): (usize, &Element)| {
            let measured = || if i % step == 0 { measured(element, gpu) } else { Number::Unmeasured };
            catch_unwind(AssertUnwindSafe(measured)).map_err(|fault| format!("{}: {}", element.name(), reason(&*fault)))
        };
        let numbers: Vec<Result<Number, String>> = paper.elements.par_iter().enumerate().map(measured).collect();
        let numbers = numbers.into_iter().map(|number| number.unwrap_or_else(|reason| panic!("{reason}")));
        for (element, number) in paper.elements.iter().zip(numbers) {
            row(&mut page, element, number);
        }
    }
    page + &out_of_scope::section()
}

/// The message of a panic.
fn reason(fault: &(dyn Any + Send)) -> String {
    let text = fault.downcast_ref::<String>().cloned();
    text.or_else(|| fault.downcast_ref::<&str>().map(|text| (*text).to_owned())).unwrap_or_default()
}

/// How many elements there are, and how they stand.
fn counted<'a>(elements: impl IntoIterator<Item = &'a Element>) -> String {
    let standings: Vec<Standing> = elements.into_iter().map(Element::standing).collect();
    let [recomputed, without, open] = [Standing::Recomputed, Standing::NoFormula, Standing::Open]
        .map(|standing| standings.iter().filter(|found| **found == standing).count());
    let all = standings.len();
    format!(
        "{all} elements: {recomputed} with their formula recomputed by hand, {without} without a formula, {open} open."
    )
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
        element.get("hand").unwrap_or("**open**"),
    )
    .unwrap();
}
