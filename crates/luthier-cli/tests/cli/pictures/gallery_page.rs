//! `gallery --html`: the page in a browser, from a disk: what it draws, how long that takes, and that it asks for nothing.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::time::Duration;

use luthier_workshop::material_texts::{fine_lacquer, gold, lacquer, matte};
use luthier_workshop::root;
use serde_json::{Value, json};

use crate::report::page::browser;
use crate::workshop::Workshop;

/// Materials of every model that a shipped file asks for, with films, flakes and patina among them.
const MATERIALS: [&str; 11] = [
    "car-paint",
    "red-lacquer",
    "house-paint",
    "frosted-acrylic",
    "brushed-aluminium",
    "chromium-car-paint",
    "copper-patina",
    "granier-film",
    "yamaguchi-brushed",
    "polished-gold",
    "soap-film",
];

/// Side of compared pictures.
const SIZE: u32 = 96;

/// Longest wait for a page.
const PATIENCE: Duration = Duration::from_secs(240);

/// What the page says of itself once all of its pictures are there, and what the given script adds to that.
const TELL: &str = r#"<script>
(async () => {
  const found = { mistakes };
  const wait = milliseconds => new Promise(done => setTimeout(done, milliseconds));
  const marked = async name => {
    for (;;) {
      const mark = performance.getEntriesByName(name)[0];
      if (mark) return mark.startTime;
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
  found.requests = performance.getEntriesByType("resource").map(entry => entry.name);
  await fetch("http://127.0.0.1:$port/", { method: "POST", mode: "no-cors", body: JSON.stringify(found) });
})();
</script></body>"#;

const LISTEN: &str = "<script>const mistakes = []; addEventListener('error', e => mistakes.push(e.message)); \
                      addEventListener('unhandledrejection', e => mistakes.push(String(e.reason))); \
                      const say = console.error; console.error = (...words) => { mistakes.push(words.join(' ')); say(...words); };</script></head>";

/// Waits for one POST, and gives what it brings.
fn answer(listener: &TcpListener) -> Value {
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
            return serde_json::from_slice(&body).unwrap();
        }
    }
    unreachable!("a listener does not end");
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
        .args(["--headless=new", "--no-sandbox", "--no-first-run", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .arg(format!("--window-size={},{}", size[0], size[1]))
        .arg(format!("file://{}{hash}", workshop.path("used.html").display()))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let (told, told_by) = mpsc::channel();
    std::thread::spawn(move || told.send(answer(&listener)));
    let found = told_by.recv_timeout(PATIENCE);
    child.kill().unwrap();
    child.wait().unwrap();
    let found = found.unwrap_or_else(|_| panic!("the page told nothing in {PATIENCE:?}"));
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

/// Pictures of the page against those of luthier-gpu, in 255ths of what a display shows.
#[test]
#[cfg(feature = "gpu")]
fn pictures_of_the_page_are_those_of_the_device() {
    let Some(browser) = browser_or_skip() else { return };
    let workshop = Workshop::new();
    let files: Vec<String> =
        MATERIALS.iter().map(|name| root().join(format!("materials/{name}.toml")).display().to_string()).collect();
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
        "found.pictures = [];\nfor (const name of {}) found.pictures.push([...await luthierPicture(name, {{ size: {SIZE} }})]);",
        json!(MATERIALS)
    );
    let found = opened(&browser, &workshop, "page.html", [1280, 900], "", &script);
    for (column, (name, pixels)) in (0..).zip(MATERIALS.iter().zip(found["pictures"].as_array().unwrap())) {
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
        eprintln!("{name}: mean {mean:.3}, median {}, 99% {}, largest {}", share(0.5), share(0.99), share(1.0));
        assert!(share(0.5) <= 2 && share(0.99) <= 6 && mean < 1.0, "{name}: mean {mean}");
    }
}
