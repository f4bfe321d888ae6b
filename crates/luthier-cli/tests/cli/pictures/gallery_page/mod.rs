//! `gallery --html`: the page in a browser, from a disk: what it draws, how long that takes, and that it asks for nothing.

mod bakes;
#[cfg(feature = "gpu")]
mod roughness;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};

use luthier_workshop::material_texts::{fine_lacquer, gold, lacquer, matte};
use luthier_workshop::{LOOK, Patience, root};
use serde_json::{Value, json};

use crate::report::page::browser;
use crate::workshop::Workshop;

/// Materials of every model that a shipped file asks for, with films, flakes and patina among them.
const MATERIALS: [&str; 11] = [
    "papers/car-paint",
    "papers/red-lacquer",
    "papers/house-paint",
    "papers/frosted-acrylic",
    "brushed-aluminium",
    "papers/chromium-car-paint",
    "papers/copper-patina",
    "papers/granier-film",
    "papers/yamaguchi-brushed",
    "polished-gold",
    "soap-film",
];

/// Side of compared pictures.
const SIZE: u32 = 64;

/// What the page says of itself once all of its pictures are there, and what the given script adds to that. It tells of each picture before.
const TELL: &str = r#"<script>
(async () => {
  const found = { mistakes };
  const here = "http://127.0.0.1:$port/";
  const tell = what => fetch(here, { method: "POST", mode: "no-cors", body: JSON.stringify(what) });
  const wait = milliseconds => new Promise(done => setTimeout(done, milliseconds));
  const marked = async name => {
    for (;;) {
      const mark = performance.getEntriesByName(name)[0];
      if (mark) {
        await tell({ progress: name });
        return mark.startTime;
      }
      if (mistakes.length) throw new Error(mistakes.join());
      await wait(20);
    }
  };
  try {
    found.first_ms = await marked("luthier-first-picture");
    found.all_ms = await marked("luthier-all-pictures");
    $script
  } catch (error) {
    found.mistakes.push(String(error.stack || error));
  }
  found.requests = performance.getEntriesByType("resource").map(entry => entry.name).filter(name => name !== here);
  await tell(found);
})();
</script></body>"#;

const LISTEN: &str = "<script>const mistakes = []; addEventListener('error', e => mistakes.push(e.message)); \
                      addEventListener('unhandledrejection', e => mistakes.push(String(e.reason))); \
                      const say = console.error; console.error = (...words) => { mistakes.push(words.join(' ')); say(...words); };</script></head>";

/// Sends on what each POST brings, to the end.
fn listen(listener: &TcpListener, told: &mpsc::Sender<Value>) {
    for stream in listener.incoming() {
        let mut stream = stream.unwrap();
        let mut reader = BufReader::new(stream.try_clone().unwrap());
        let (mut line, mut length, mut is_post) = (String::new(), 0, false);
        while reader.read_line(&mut line).unwrap() > 2 {
            is_post |= line.starts_with("POST ");
            if let Some((name, value)) = line.split_once(':')
                && name.eq_ignore_ascii_case("content-length")
            {
                length = value.trim().parse().unwrap();
            }
            line.clear();
        }
        let mut body = vec![0; length];
        reader.read_exact(&mut body).unwrap();
        stream.write_all(b"HTTP/1.1 204 No Content\r\nConnection: close\r\n\r\n").unwrap();
        if is_post {
            let what: Value = serde_json::from_slice(&body).unwrap();
            let is_last = what["progress"].is_null();
            // Nobody listens where the test has failed.
            if told.send(what).is_err() || is_last {
                return;
            }
        }
    }
}

/// Opens the page from the disk in a browser of this size, runs a script in it, and gives what the page tells.
fn opened(browser: &Path, workshop: &Workshop, page: &str, size: [u32; 2], hash: &str, script: &str) -> Value {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    let text = workshop.text(page);
    let policy = "default-src 'none'; ";
    assert_eq!([policy, "</head>", "</body>"].map(|part| text.matches(part).count()), [1; 3]);
    let used = text
        .replace(policy, &format!("{policy}connect-src http://127.0.0.1:{port}; "))
        .replace("</head>", LISTEN)
        .replace("</body>", &TELL.replace("$script", script).replace("$port", &port.to_string()));
    workshop.write("used.html", used);
    let profile = tempfile::tempdir().unwrap();
    let mut child = Command::new(browser)
        .args([
            "--headless=new",
            "--no-sandbox",
            "--no-first-run",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
            // Few pixels: software draws them.
            "--force-device-scale-factor=0.125",
        ])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .arg(format!("--window-size={},{}", size[0], size[1]))
        .arg(format!("file://{}{hash}", workshop.path("used.html").display()))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let (told, told_by) = mpsc::channel();
    std::thread::spawn(move || listen(&listener, &told));
    let mut patience = Patience::with(child.id());
    let mut before = "its begin".to_owned();
    let found = loop {
        let problem = match told_by.recv_timeout(LOOK) {
            Ok(what) => match what["progress"].as_str() {
                Some(progress) => {
                    progress.clone_into(&mut before);
                    patience.progress();
                    continue;
                }
                None => break Ok(what),
            },
            Err(RecvTimeoutError::Disconnected) => "it told something else than its pictures".to_owned(),
            Err(RecvTimeoutError::Timeout) => match (child.try_wait().unwrap(), patience.look()) {
                (Some(status), _) => format!("the browser ended: {status}"),
                (None, Err(did)) => did,
                (None, Ok(())) => continue,
            },
        };
        break Err(problem);
    };
    child.kill().unwrap();
    child.wait().unwrap();
    let found = found.unwrap_or_else(|problem| panic!("nothing of the page after {before}: {problem}"));
    assert_eq!((&found["mistakes"], &found["requests"]), (&json!([]), &json!([])), "mistakes and requests");
    found
}

/// The browser, or a word that there is none.
fn browser_or_skip() -> Option<std::path::PathBuf> {
    let found = browser();
    if found.is_none() {
        assert!(std::env::var_os("CI").is_none(), "no Chromium");
        eprintln!("skipped: no Chromium (Debian: apt-get install chromium)");
    }
    found
}

/// How far a picture of a page is from the one in a column of a sheet, in 255ths: the mean, the median, and what 99% do not exceed.
#[cfg(feature = "gpu")]
struct Apart {
    mean: f64,
    median: u8,
    most_of: u8,
}

#[cfg(feature = "gpu")]
fn apart(sheet: &image::RgbImage, column: u32, pixels: &Value) -> Apart {
    let pixels: Vec<u8> = pixels.as_array().unwrap().iter().map(|v| v.as_u64().unwrap() as u8).collect();
    let mut apart: Vec<u8> = Vec::new();
    for (y, x) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (y, x))) {
        let expected = sheet.get_pixel(8 + column * (SIZE + 8) + x, 8 + y).0;
        let at = 4 * (y * SIZE + x) as usize;
        apart.extend((0..3).map(|c| expected[c].abs_diff(pixels[at + c])));
    }
    apart.sort_unstable();
    let share = |part: f64| apart[((apart.len() - 1) as f64 * part) as usize];
    let mean = apart.iter().map(|v| f64::from(*v)).sum::<f64>() / apart.len() as f64;
    Apart { mean, median: share(0.5), most_of: share(0.99) }
}

#[test]
#[cfg(feature = "gpu")]
fn pictures_of_the_page_are_those_of_the_device() {
    pictures_are_those_of_the_device(&[MATERIALS[0], MATERIALS[4], MATERIALS[6], MATERIALS[9]]);
}

#[test]
#[cfg(feature = "gpu")]
#[ignore = "half a minute: scripts/nightly.sh tests"]
fn all_pictures_of_the_page_are_those_of_the_device() {
    pictures_are_those_of_the_device(&MATERIALS);
}

/// Pictures of the page against those of luthier-gpu, in 255ths of what a display shows.
#[cfg(feature = "gpu")]
fn pictures_are_those_of_the_device(names: &[&str]) {
    let Some(browser) = browser_or_skip() else { return };
    let workshop = Workshop::new();
    let files: Vec<String> =
        names.iter().map(|name| root().join(format!("materials/{name}.toml")).display().to_string()).collect();
    let size = SIZE.to_string();
    let mut words = vec!["gallery", "-o", "sheet.png", "--columns", "11", "--samples", "4", "--size", &size];
    words.extend(files.iter().map(String::as_str));
    let run = workshop.run(&words);
    if run.lacks_adapter() {
        return;
    }
    run.exits(0);
    let sheet = image::open(workshop.path("sheet.png")).unwrap().into_rgb8();
    let mut words = vec!["gallery", "--html", "page.html"];
    words.extend(files.iter().map(String::as_str));
    workshop.run(&words).exits(0);
    let script = format!(
        "found.pictures = [];\nfor (const name of {}) {{ found.pictures.push([...await luthierPicture(name, {{ size: {SIZE} }})]); await tell({{ progress: name }}); }}",
        json!(names.iter().map(|name| name.trim_start_matches("papers/")).collect::<Vec<_>>())
    );
    let found = opened(&browser, &workshop, "page.html", [1280, 900], "", &script);
    for (column, (name, pixels)) in (0..).zip(names.iter().zip(found["pictures"].as_array().unwrap())) {
        let Apart { mean, median, most_of } = apart(&sheet, column, pixels);
        eprintln!("{name}: mean {mean:.3}, median {median}, 99% {most_of}");
        assert!(median <= 2 && most_of <= 6 && mean < 1.0, "{name}: mean {mean}");
    }
}

/// Helpers of scripts that use the page.
const USE: &str = r#"
const all = selector => [...document.querySelectorAll(selector)];
const shown = selector => all(selector).filter(element => element.offsetHeight > 0);
const drawn = async change => {
  performance.clearMarks("luthier-stage");
  change();
  await marked("luthier-stage");
  const canvas = document.getElementById("page-picture");
  return [...canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data];
};
const choose = (id, value) => { const input = document.getElementById("page-" + id); input.value = value; input.dispatchEvent(new Event("change")); };
const apart = (a, b) => a.length === b.length && a.reduce((sum, value, i) => sum + Math.abs(value - b[i]), 0) / a.length;
const beyond = () => document.documentElement.scrollWidth - document.documentElement.clientWidth;
"#;

/// Addresses, keys, two pictures apart, and a filter, on a wide screen and a narrow one.
#[test]
fn the_page_is_used_by_mouse_and_keys() {
    let Some(browser) = browser_or_skip() else { return };
    let workshop = Workshop::with(&[
        ("m/a.toml", &matte("ash")),
        ("m/b.toml", &gold("gold")),
        ("m/c.toml", &lacquer("lacquer")),
        ("m/d.toml", &fine_lacquer("fine-lacquer")),
    ]);
    assert_eq!(workshop.run(&["gallery", "m", "--html", "page.html", "--no-fit"]).exits(0).stdout, "");
    let script = [
        USE,
        r##"
found.tiles = shown(".tiles li").length;
found.unseen = shown("article").length;
found.beyond = [beyond()];
const front = await drawn(() => (location.hash = "#lacquer"));
found.open = shown("article").map(article => article.id);
found.tilesBeside = shown(".tiles li").length;
found.layers = shown("figure.section li").length;
found.text = shown("pre").map(pre => pre.textContent.includes('name = "lacquer"'));
found.beyond.push(beyond());
const canvas = document.getElementById("page-picture");
canvas.focus();
const side = await drawn(() => canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", bubbles: true })));
found.turned = apart(front, side);
const again = await drawn(() => document.getElementById("page-reset").click());
found.reset = apart(front, again);
found.choices = all("#page-a option").map(option => option.textContent);
const pair = await drawn(() => choose("mode", "slider"));
choose("b", 1);
const difference = await drawn(() => choose("mode", "difference"));
found.same_model = difference.filter((value, i) => i % 4 < 3).reduce((most, value) => Math.max(most, value), 0);
const models = await drawn(() => choose("b", 2));
found.other_model = models.filter((value, i) => i % 4 < 3).reduce((most, value) => Math.max(most, value), 0);
found.apart = document.getElementById("page-apart").textContent;
found.facts = all("#page-facts tr").map(row => row.cells[0].textContent);
const slopes = document.getElementById("page-slopes");
const slide = value => { slopes.value = value; slopes.dispatchEvent(new Event("input")); };
await drawn(() => choose("mode", "single"));
const rougher = await drawn(() => slide(1));
found.rougher = [apart(front, rougher), document.getElementById("page-slopes-value").textContent, slopes.ariaValueText ?? slopes.getAttribute("aria-valuetext")];
found.nominal = apart(front, await drawn(() => slide(0)));
found.matte = await (async () => { await drawn(() => (location.hash = "#ash")); return [slopes.disabled, slopes.title]; })();
await drawn(() => (location.hash = "#lacquer"));
dispatchEvent(new KeyboardEvent("keydown", { key: "Escape" }));
await wait(50);
found.back = [shown(".tiles li").length, document.activeElement.getAttribute("href")];
const input = document.getElementById("page-filter");
input.value = "GOLD"; input.dispatchEvent(new Event("input"));
found.filtered = shown(".tiles li").map(item => item.querySelector("span").textContent);
dispatchEvent(new Event("beforeprint"));
const ink = canvas => new Set(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data).size;
found.printed = all("article .printed").map(ink);
found.leftOut = all("article.left-out").length;
dispatchEvent(new Event("afterprint"));
found.unprinted = all(".printed").length;
found.names = all("input, select, button").filter(control => !control.labels?.length && !control.textContent.trim() && !control.ariaLabel).map(control => control.id);
"##,
    ]
    .concat();
    let found = opened(&browser, &workshop, "page.html", [1000, 700], "", &script);
    assert_eq!((&found["tiles"], &found["unseen"], &found["tilesBeside"]), (&json!(4), &json!(0), &json!(0)));
    assert_eq!((&found["open"], &found["text"]), (&json!(["lacquer"]), &json!([true])), "{found}");
    assert!(found["layers"].as_u64().unwrap() >= 3, "exterior and layers: {found}");
    assert_eq!(found["beyond"], json!([0, 0]), "scrolls sideways");
    assert!(found["turned"].as_f64().unwrap() > 0.2 && found["reset"] == 0, "{found}");
    let choices = ["elek, tables", "elek, no tables", "belcour, tables", "belcour, no tables"];
    assert_eq!(found["choices"], json!(choices));
    let [same, other] = ["same_model", "other_model"].map(|name| found[name].as_u64().unwrap());
    assert!(same < 40 && other > 60, "forms of a model are near, models are not: {same} {other}");
    assert!(found["apart"].as_str().unwrap().contains("Root mean square difference"), "{found}");
    assert!(found["rougher"][0].as_f64().unwrap() > 0.2 && found["nominal"] == 0, "{found}");
    assert_eq!([&found["rougher"][1], &found["rougher"][2]], [&json!("× 2.00"), &json!("2.00 times the slopes")]);
    assert_eq!(found["matte"][0], json!(true), "a diffuse base has no slopes");
    assert!(found["matte"][1].as_str().unwrap().contains("no interface"), "{found}");
    assert!(found["facts"].as_array().unwrap().contains(&json!("Bytes of tables")), "{found}");
    assert_eq!(found["back"], json!([4, "#lacquer"]), "Escape leads back to where one was");
    let printed: Vec<u64> = found["printed"].as_array().unwrap().iter().map(|v| v.as_u64().unwrap()).collect();
    assert!(printed.len() == 4 && printed.iter().all(|&values| values > 8), "pictures in print: {printed:?}");
    assert_eq!((&found["leftOut"], &found["unprinted"]), (&json!(3), &json!(0)), "the filter holds in print");
    assert_eq!((&found["filtered"], &found["names"]), (&json!(["gold"]), &json!([])));
    // An address leads to its material at once, on a narrow screen, too.
    let script = [
        USE,
        r##"
await marked("luthier-stage");
found.open = shown("article").map(article => article.id);
found.beyond = [beyond()];
dispatchEvent(new KeyboardEvent("keydown", { key: "Escape" }));
await wait(50);
found.tiles = shown(".tiles li").length;
found.beyond.push(beyond());
"##,
    ]
    .concat();
    let found = opened(&browser, &workshop, "page.html", [500, 844], "#gold", &script);
    assert_eq!((&found["open"], &found["tiles"]), (&json!(["gold"]), &json!(4)));
    assert_eq!(found["beyond"], json!([0, 0]), "scrolls sideways");
}

/// Sixty materials have their first pictures soon: the times are printed, because machines differ.
#[test]
fn a_page_of_sixty() {
    let Some(browser) = browser_or_skip() else { return };
    let texts: Vec<(String, String)> = (0..60)
        .map(|i| {
            let text = [matte, gold, lacquer][i % 3](&format!("m-{i}"));
            (format!("m/{i}.toml"), text)
        })
        .collect();
    let files: Vec<(&str, &str)> = texts.iter().map(|(file, text)| (file.as_str(), text.as_str())).collect();
    let workshop = Workshop::with(&files);
    workshop.run(&["gallery", "m", "--html", "page.html", "--no-fit"]).exits(0);
    let size = workshop.text("page.html").len();
    let found = opened(&browser, &workshop, "page.html", [1280, 900], "", "");
    eprintln!("60 materials: {size} bytes, first picture {} ms, all {} ms", found["first_ms"], found["all_ms"]);
    assert!(size < 5_000_000, "{size} bytes");
}
