use std::path::PathBuf;

use luthier_report::{Settings, judge};

use crate::fixture::Bake;

fn pages() -> Vec<(&'static str, String)> {
    let bake = Bake::new();
    let device = bake.device(|_, _, n, value| {
        // Stands for f32 arithmetic: a few units in the last place, different for every pair.
        let noise = 1.0 + 3e-6 * ((n * 2_654_435_761) % 1000) as f32 / 1000.0;
        value.map(|v| v * noise)
    });
    let provenance = vec![("commit".to_owned(), "<unknown> & \"quoted\"".to_owned())];
    let settings = Settings { pairs_per_set: 1000, budget: Some(1e-3), provenance, progress: None };
    let broken = bake.device(|_, _, n, value| if n == 3 { [f32::NAN; 3] } else { value });
    let run = |device, settings: &Settings<'_>| judge(&bake.subject(), device, settings).unwrap().to_html();
    vec![
        ("device", run(Some(&device), &settings)),
        ("tables-only", run(None, &Settings { budget: None, ..settings.clone() })),
        ("not-finite", run(Some(&broken), &settings)),
    ]
}

#[test]
fn pages_are_well_formed_and_self_contained() {
    for (name, html) in pages() {
        // For looking at, and for the browser.
        let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("report-{name}.html"));
        std::fs::write(&path, &html).unwrap();
        let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
        let document = roxmltree::Document::parse_with_options(&html, options).unwrap();
        for node in document.descendants().filter(roxmltree::Node::is_element) {
            assert!(!["script", "link", "img", "iframe"].contains(&node.tag_name().name()), "{name}");
            let within = |a: roxmltree::Attribute<'_, '_>| {
                a.name() != "src" && (a.name() != "href" || a.value().starts_with('#'))
            };
            assert!(node.attributes().all(within), "{name}: {:?}", node.tag_name());
            // Every link has a target.
            if let Some(href) = node.attribute("href") {
                assert!(document.descendants().any(|n| n.attribute("id") == href.strip_prefix('#')), "{name}: {href}");
            }
        }
        assert!(!html.contains("url(") && !html.contains("@import"), "{name}");
        // No number went wrong on its way into a drawing.
        for path in document.descendants().filter(|n| n.tag_name().name() == "path") {
            let d = path.attribute("d").unwrap();
            assert!(!d.contains("NaN") && !d.contains("inf"), "{name}: {d}");
        }
    }
}

#[test]
fn the_page_says_what_was_found() {
    let pages = pages();
    assert!(pages[0].1.contains("copper &amp; &lt;satin&gt;") && !pages[0].1.contains("<satin>"));
    assert!(pages[0].1.contains("Fake &amp; Sons &lt;f64&gt;"));
    assert!(pages[1].1.contains("no shader was run"));
    assert!(pages[2].1.contains("Over budget: some values are not finite"));
}
