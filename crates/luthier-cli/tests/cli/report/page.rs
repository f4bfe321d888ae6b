//! The report's page in a browser: what it draws, what its script does, and that it asks for nothing else.

use std::path::{Path, PathBuf};
use std::process::Command;

use luthier_workshop::material_texts::{gold, lacquer};
use serde_json::{Value, json};

use crate::workshop::Workshop;

/// Names of Chromium.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Listens for mistakes before the page's own script runs.
const LISTEN: &str =
    "<script>window.mistakes = []; addEventListener('error', e => mistakes.push(e.message));</script></head>";

/// Uses the page as a reader does, and writes down what came of it.
const USE: &str = r#"<script>
const all = (selector, root = document) => [...root.querySelectorAll(selector)];
const link = document.querySelector('figure.field svg a');
link.dispatchEvent(new MouseEvent('click', { bubbles: true, cancelable: true }));
const led = all('details[open]').map(details => '#' + details.id).join() === link.getAttribute('href');
for (const details of all('details')) details.open = true;
const rows = all('table.sortable').find(t => t.tHead.textContent.includes('baked shader') || t.tHead.textContent.includes('tables, 8-bit'));
const column = [...rows.tHead.rows[0].cells].findIndex(c => c.textContent.startsWith('tables, 8-bit'));
const values = () => [...rows.tBodies[0].rows].map(r => Number(r.cells[column].textContent));
const click = () => rows.tHead.rows[0].cells[column].click();
const found = { led, charts: all('svg.chart').length, ringed: all('svg.chart .chosen').length, cells: all('svg.stability rect').length };
click(); found.up = values(); found.sorted = rows.tHead.rows[0].cells[column].getAttribute('aria-sort');
click(); found.down = values();
const shown = () => all('article').filter(a => a.offsetHeight > 0).map(a => a.querySelector('h3').textContent);
const input = document.querySelector('#filter input');
const filter = text => { input.value = text; input.dispatchEvent(new Event('input')); };
found.before = shown(); filter('GOLD'); found.filtered = shown();
found.filteredRows = [...rows.tBodies[0].rows].filter(r => r.offsetHeight > 0).length;
filter(''); found.after = shown();
const hover = (chart, [x, y]) => {
  chart.scrollIntoView();
  const box = chart.getBoundingClientRect(), unit = box.width / chart.viewBox.baseVal.width;
  const at = { clientX: box.left + x * unit, clientY: box.top + y * unit, bubbles: true };
  (document.elementFromPoint(at.clientX, at.clientY) || chart).dispatchEvent(new PointerEvent('pointermove', at));
  const tip = document.getElementById('tip');
  return tip.hidden ? null : tip.textContent;
};
const line = all('article path[data-name]')[0];
found.line = hover(line.closest('svg'), line.getAttribute('d').slice(1).split('L')[0].split(' ').map(Number));
const ring = all('svg.chart .chosen')[0];
found.chosen = hover(ring.closest('svg'), [Number(ring.getAttribute('cx')), Number(ring.getAttribute('cy'))]);
found.pictures = all('img').map(i => i.complete && i.naturalWidth > 0);
found.requests = performance.getEntriesByType('resource').map(r => r.name).filter(name => !name.startsWith('data:'));
found.mistakes = mistakes;
const pre = document.createElement('pre'); pre.id = 'found'; pre.textContent = JSON.stringify(found); document.body.append(pre);
</script></body>"#;

/// The page in frames of a screen's and of a telephone's size, looked at and used.
const FRAMES: &str = r#"<!DOCTYPE html><html><body><script>
const text = $page;
const frame = width => new Promise(done => {
  const f = document.createElement('iframe');
  f.style.cssText = `width: ${width}px; height: 800px; border: 0`;
  f.onload = () => done(f);
  f.srcdoc = text;
  document.body.append(f);
});
const beyond = d => d.documentElement.scrollWidth - d.documentElement.clientWidth;
(async () => {
  const found = {};
  const wide = await frame(1280), d = wide.contentDocument, w = wide.contentWindow;
  const all = selector => [...d.querySelectorAll(selector)];
  const bottom = selector => { const e = d.querySelector(selector); return e && e.getBoundingClientRect().bottom; };
  found.folded = d.documentElement.scrollHeight;
  found.bottoms = ['.verdict', '.glance', 'figure.field svg.chart', '.thumbs'].map(bottom);
  found.marks = all('figure.field svg a').length;
  found.open = all('details[open]').length;
  found.beyond = [beyond(d)];
  const link = d.querySelector('figure.field svg a');
  link.focus();
  const tip = d.getElementById('tip');
  found.tip = tip.hidden ? null : tip.textContent;
  found.reached = d.activeElement === link;
  w.dispatchEvent(new w.Event('beforeprint'));
  found.printed = all('details:not([open])').length;
  found.unfolded = d.documentElement.scrollHeight;
  found.beyond.push(beyond(d));
  w.dispatchEvent(new w.Event('afterprint'));
  found.after = all('details[open]').length;
  const narrow = await frame(390), n = narrow.contentDocument;
  found.beyond.push(beyond(n));
  for (const details of n.querySelectorAll('details')) details.open = true;
  found.beyond.push(beyond(n));
  const pre = document.createElement('pre'); pre.id = 'found'; pre.textContent = JSON.stringify(found); document.body.append(pre);
})();
</script></body></html>"#;

pub(crate) fn browser() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let files = std::env::split_paths(&path).flat_map(|folder| BROWSERS.map(|name| folder.join(name)));
    files.into_iter().find(|file| file.is_file())
}

/// Standard output and error of the browser on a page.
fn run(browser: &Path, arguments: &[String]) -> (String, String) {
    let profile = tempfile::tempdir().unwrap();
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--enable-logging=stderr"])
        .args(["--virtual-time-budget=10000", "--window-size=1200,900"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .args(arguments)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (text(&output.stdout), text(&output.stderr))
}

/// The value that a script has written down in a page.
fn found_in(dom: &str) -> Value {
    let found = dom.split("<pre id=\"found\">").nth(1).and_then(|rest| rest.split("</pre>").next()).unwrap();
    serde_json::from_str(&found.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")).unwrap()
}

/// A bake of two materials, and a report on it with costs, models and stability.
fn reported() -> Workshop {
    let workshop = Workshop::with(&[("m/lacquer.toml", &lacquer("lacquer")), ("m/gold.toml", &gold("gold"))]);
    let row = |material: &str, model: &str, form: &str, cycles: i64| {
        json!({"material": material, "model": model, "form": form, "closed": true, "constant": false, "family": "rdna2",
               "inverse_throughput": cycles, "vgprs": 16, "texture_reads": 2})
    };
    let rows: Vec<Value> = ["lacquer", "gold"]
        .into_iter()
        .flat_map(|m| [row(m, "elek", "baked", 150), row(m, "elek", "full", 350), row(m, "phong", "baked", 50)])
        .collect();
    let costs = json!({"schema": 1, "generator": "luthier test", "driver": "none", "families": [], "rows": rows});
    workshop.write("cost.json", costs.to_string());
    let suite = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/measurements/stability.json");
    workshop.write("stability.json", std::fs::read_to_string(suite).unwrap());
    workshop.run(&["bake", "m", "-q"]).exits(0);
    let mut words =
        vec!["report", "--pairs", "64", "--reference=50", "--cost", "cost.json", "--stability", "stability.json"];
    if cfg!(not(feature = "gpu")) || super::judgement::has_no_adapter(&workshop) {
        words.push("--no-device");
    }
    workshop.run(&words).exits(0);
    workshop
}

#[test]
fn the_page_works_in_a_browser() {
    let Some(browser) = browser() else {
        assert!(std::env::var_os("CI").is_none(), "no Chromium");
        eprintln!("skipped: no Chromium (Debian: apt-get install chromium)");
        return;
    };
    let workshop = reported();
    let page = workshop.text("out/report/index.html");
    assert_eq!((page.matches("</head>").count(), page.matches("</body>").count()), (1, 1));
    workshop.write("used.html", page.replace("</head>", LISTEN).replace("</body>", USE));
    let url = |file: &str| format!("file://{}", workshop.path(file).display());
    let (dom, log) = run(&browser, &["--dump-dom".to_owned(), url("used.html")]);
    assert!(!log.contains("CONSOLE"), "{log}");
    let found = found_in(&dom);

    assert_eq!(found["mistakes"], json!([]));
    assert_eq!(found["requests"], json!([]), "the page asks for nothing");
    assert_eq!(found["led"], true, "a mark leads to its material, and opens it: {found}");
    // Overview (3), each material: error by angle, models; the searched tables come on top.
    assert!(found["charts"].as_u64().unwrap() >= 3 + 2 * 2, "{found}");
    assert!(found["ringed"].as_u64().unwrap() >= 2, "{found}");
    assert!(found["cells"].as_u64().unwrap() > 1000, "the heat map: {found}");
    let numbers =
        |name: &str| -> Vec<f64> { found[name].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect() };
    let (up, mut down) = (numbers("up"), numbers("down"));
    assert!(up.len() == 2 && up[0] < up[1], "{found}");
    down.reverse();
    assert_eq!(up, down);
    assert_eq!(found["sorted"], "ascending");
    assert_eq!(found["before"], json!(["gold", "lacquer"]));
    assert_eq!((&found["filtered"], &found["filteredRows"]), (&json!(["gold"]), &json!(1)));
    assert_eq!(found["after"], found["before"]);
    assert!(found["line"].as_str().is_some_and(|tip| tip.contains(" at ")), "{found}");
    assert!(found["chosen"].as_str().is_some_and(|tip| tip.contains("error")), "{found}");
    assert!(found["pictures"].as_array().unwrap().iter().all(|loaded| loaded == true), "{found}");

    // The first screen answers both questions; the rest folds, and everything can be reached, on any width and on paper.
    let text = serde_json::to_string(&page).unwrap().replace("</", "<\\/");
    workshop.write("frames.html", FRAMES.replace("$page", &text));
    let (dom, log) = run(&browser, &["--dump-dom".to_owned(), url("frames.html")]);
    assert!(!log.contains("CONSOLE"), "{log}");
    let found = found_in(&dom);
    let bottoms = found["bottoms"].as_array().unwrap();
    let has_pictures = page.contains("data:image/png");
    assert_eq!(bottoms[3].is_number(), has_pictures, "{found}");
    assert!(bottoms.iter().filter_map(Value::as_f64).all(|bottom| bottom > 0.0 && bottom <= 800.0), "{found}");
    assert!(found["marks"].as_u64().unwrap() >= 2 && found["open"] == 0, "{found}");
    let height = |name: &str| found[name].as_f64().unwrap();
    assert!(height("folded") < 2500.0 && height("unfolded") > 2.0 * height("folded"), "{found}");
    assert!(found["beyond"].as_array().unwrap().iter().all(|pixels| pixels == 0), "scrolls sideways: {found}");
    assert!(found["tip"].as_str().is_some_and(|tip| tip.contains("error")) && found["reached"] == true, "{found}");
    assert_eq!(
        (&found["printed"], &found["after"]),
        (&json!(0), &json!(0)),
        "folded on paper, open behind it: {found}"
    );

    // On paper: nothing that was folded away is lost, so that there are several pages.
    let paper = workshop.path("page.pdf");
    run(&browser, &[format!("--print-to-pdf={}", paper.display()), url("out/report/index.html")]);
    let paper = std::fs::read(paper).unwrap();
    let pages = paper.windows(12).filter(|w| w.starts_with(b"/Type /Page") && w[11] != b's').count();
    assert!(paper.starts_with(b"%PDF") && pages > 3, "{pages} pages");
}
