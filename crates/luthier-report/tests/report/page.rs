use std::path::PathBuf;

use luthier_lut::{Axis, Mapping, RowBase, TableKind, TexelFormat};
use luthier_manifest::{Budget, Candidate, CandidateForm, MeasuredError, Search, ShadingModel};
use luthier_report::{
    AgainstReference, Costs, Exhibit, Exhibits, PictureErrors, ReferencePaths, Report, Settings, ShaderCost, ShapeCost,
    judge,
};

use crate::fixture::Bake;

fn pages() -> Vec<(&'static str, String)> {
    let bake = Bake::new();
    let device = bake.device(|_, _, n, value| {
        // Stands for f32 arithmetic: a few units in the last place, different for every pair.
        let noise = 1.0 + 3e-6 * ((n * 2_654_435_761) % 1000) as f32 / 1000.0;
        value.map(|v| v * noise)
    });
    let provenance = vec![("commit".to_owned(), "<unknown> & \"quoted\"".to_owned())];
    let settings = Settings { pairs_per_set: 1000, budget: Some(1e-3), provenance, ..Settings::default() };
    let broken = bake.device(|_, _, n, value| if n == 3 { [f32::NAN; 3] } else { value });
    let run = |device, settings: &Settings<'_>| page(judge(&bake.subject(), device, settings).unwrap());
    vec![
        ("device", run(Some(&device), &settings)),
        ("tables-only", run(None, &Settings { budget: None, ..settings.clone() })),
        ("not-finite", run(Some(&broken), &settings)),
    ]
}

/// A page with all that a caller can put into it.
fn page(mut report: Report) -> String {
    let exhibits = filled(&mut report);
    report.to_html(&exhibits)
}

/// Puts evidence of every sort into a report.
pub(crate) fn filled(report: &mut Report) -> Exhibits {
    let candidate = |size: u32, bytes: u64, max_abs: f64| {
        let (quantity, unit) = ("cos_theta".to_owned(), String::new());
        let x = Axis { quantity, unit, min: 0.0, max: 1.0, size, mapping: Mapping::Power { exponent: 2.0 } };
        let (format, base) = (TexelFormat::Rgba16Float, RowBase::Schlick);
        let error = MeasuredError { max_abs, max_rel: 2.0 * max_abs, delta_e: Some(0.1), ..MeasuredError::default() };
        Candidate { form: CandidateForm::Table { x, y: None, format, base }, bytes, cost: 40.0 + bytes as f64, error }
    };
    let closed = CandidateForm::ClosedForm;
    let search = Search {
        kind: TableKind::Fresnel,
        budget: Budget { max_abs: Some(1e-3), ..Budget::default() },
        chosen: 1,
        front: vec![
            Candidate {
                form: closed,
                bytes: 0,
                cost: 9.0,
                error: MeasuredError { max_abs: 0.2, max_rel: 0.4, ..MeasuredError::default() },
            },
            candidate(32, 256, 5e-4),
            candidate(64, 512, 1e-4),
        ],
        measured: 7,
    };
    report.searches = vec![search.clone()];
    let cost = |material: &str, model, form: &str, cycles| ShaderCost {
        material: material.to_owned(),
        model,
        form: form.to_owned(),
        closed: form == "full",
        constant: false,
        family: "rdna2".to_owned(),
        inverse_throughput: cycles,
        vgprs: 12,
        texture_reads: 2,
    };
    let mut rows = Vec::new();
    let mut pictures = Vec::new();
    for (n, material) in (0..).zip(&mut report.materials) {
        material.alone = vec![search.clone()];
        material.choice = Some(serde_json::json!({"why": "the <cheapest> that holds", "next_cheaper": {"error": 0.1}}));
        for (model, cycles) in [(ShadingModel::Phong, 40), (ShadingModel::Elek, 120)] {
            rows.push(cost(&material.name, model, "baked", cycles));
            rows.push(cost(&material.name, model, "full", 2 * cycles));
            material.against_reference.push(AgainstReference {
                model,
                albedo_err: 0.1,
                albedo_std_err: 1e-3,
                lobe_err: 20.0 / f64::from(n + 1) / cycles as f64,
                lobe_noise: 0.01,
                worst_theta_deg: 80.0,
                worst_wavelength_nm: 445.0,
                delta_e: 3.0,
                by_angle: vec![(0.0, 0.1), (80.0, 0.2)],
            });
        }
        material.picture = Some(PictureErrors {
            size: 1,
            rms_err: 0.1,
            max_abs_err: 0.2,
            flip_mean: 0.05,
            flip_max: 0.3,
            delta_e_mean: 1.0,
            delta_e_max: 4.0,
            gain: 8,
        });
        // The test looks at the markup, a browser's picture is made of a bake.
        pictures.push(vec![Exhibit { caption: "baked & <lit>".to_owned(), png: vec![0x89, b'P', b'N', b'G'] }]);
    }
    report.costs = Some(Costs { generator: "luthier 0".to_owned(), driver: "radv <1>".to_owned(), rows });
    report.reference = Some(ReferencePaths { paths: 10, seed: 1 });
    Exhibits { pictures, stability: None, gallery: None }
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
            assert!(!["link", "iframe", "object"].contains(&node.tag_name().name()), "{name}");
            let within = |a: roxmltree::Attribute<'_, '_>| {
                let is_inside = match a.name() {
                    "src" => a.value().starts_with("data:image/png;base64,"),
                    "href" => a.value().starts_with('#'),
                    _ => true,
                };
                is_inside && !a.name().starts_with("on")
            };
            assert!(node.attributes().all(within), "{name}: {:?}", node.tag_name());
            // Every link has a target.
            if let Some(href) = node.attribute("href") {
                assert!(document.descendants().any(|n| n.attribute("id") == href.strip_prefix('#')), "{name}: {href}");
            }
        }
        for network in ["fetch(", "XMLHttpRequest", "import(", "http:", "https:"] {
            assert!(!html.contains(network), "{name}: {network}");
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
    assert!(pages[2].1.contains("Over the limit: some values are not finite"));
}

/// The chosen point is ringed in every chart of what is paid and what is got.
#[test]
fn charts_mark_what_was_chosen() {
    let bake = Bake::new();
    let device = bake.device(|_, _, _, value| value);
    let mut report =
        judge(&bake.subject(), Some(&device), &Settings { pairs_per_set: 100, ..Settings::default() }).unwrap();
    let exhibits = filled(&mut report);
    let html = report.to_html(&exhibits);
    let materials = report.materials.len();
    let charts: Vec<&str> = html
        .split("<svg ")
        .filter(|c| c.contains("against error\""))
        .map(|c| c.split("</svg>").next().unwrap())
        .collect();
    // Bytes and cost of the table, of the table for each material alone, and the models of each material.
    assert_eq!(charts.len(), 2 + 3 * materials);
    for chart in charts {
        assert_eq!(chart.matches("class=\"chosen\"").count(), 1, "{chart}");
    }
    assert!(html.contains("the &lt;cheapest&gt; that holds"));
    // Once with the material, once at the top.
    assert_eq!(html.matches("data:image/png;base64,iVBORw==").count(), 2 * materials);
    // Links to a page of pictures, where one is named.
    assert!(!html.contains("in the gallery"));
    let exhibits = Exhibits { gallery: Some("../a&b.html".to_owned()), ..exhibits };
    let html = report.to_html(&exhibits);
    assert_eq!(html.matches("<a href=\"../a&amp;b.html#").count(), materials);
}

/// The first thing behind the verdict: a mark for each material and form, by cost where costs were given, by bytes otherwise.
#[test]
fn all_materials_are_in_one_chart() {
    let bake = Bake::new();
    let device = bake.device(|_, _, _, value| value.map(|v| 1.01 * v));
    let mut report =
        judge(&bake.subject(), Some(&device), &Settings { pairs_per_set: 100, ..Settings::default() }).unwrap();
    let chart = |html: &str| -> String {
        let (_, rest) = html.split_once("<figure class=\"field\">").unwrap();
        rest.split_once("</figure>").unwrap().0.to_owned()
    };
    let materials = report.materials.len();
    let bytes = chart(&report.to_html(&Exhibits::default()));
    assert_eq!(bytes.matches("<a href=\"#material-").count(), materials);
    assert!(bytes.contains("No cost of shaders was given") && bytes.contains("bytes of the tables"), "{bytes}");
    // Of the fixture's tables each material reads some.
    assert!(bytes.contains("KiB of tables") || bytes.contains(" B of tables"), "{bytes}");
    for material in &mut report.materials {
        material.shape_cost = Some(ShapeCost { baked: 77, full: Some(212), is_of_similar: false });
    }
    let kinds = chart(&report.to_html(&Exhibits::default()));
    assert_eq!(kinds.matches("<a href=\"#material-").count(), 2 * materials, "baked and full");
    assert!(kinds.contains("77 cycles, ") && kinds.contains("for layers of the same kinds"), "{kinds}");
    let exhibits = filled(&mut report);
    let html = report.to_html(&exhibits);
    let costs = chart(&html);
    assert_eq!(costs.matches("<a href=\"#material-").count(), 2 * materials, "baked and full");
    assert!(costs.contains("120 cycles, ") && costs.contains("240 cycles, no table"), "{costs}");
    let position = |text: &str| html.find(text).unwrap();
    assert!(position("how fast") < position("<figure class=\"field\">"));
    assert!(position("<figure class=\"field\">") < position("id=\"levels\""));
    assert!(html.contains("<dd>120 cycles</dd>"), "the median of what ships");
}

/// The summary says what the page says, in tables that Markdown reads: as many cells in every row as in the head.
#[test]
fn the_summary_is_a_table_for_each_question() {
    let bake = Bake::new();
    let settings = Settings { pairs_per_set: 100, budget: Some(1e-9), ..Settings::default() };
    let mut report = judge(&bake.subject(), None, &settings).unwrap();
    filled(&mut report);
    let text = report.to_markdown();
    assert!(text.contains("**A limit is broken.**") && text.contains("| **broken** |"), "{text}");
    for material in &report.materials {
        assert!(text.contains(&format!("\n| {} | elek |", material.name)), "{}", material.name);
    }
    for block in text.split("\n\n").filter(|b| b.starts_with('|')) {
        let cells: Vec<usize> = block.lines().map(|line| line.matches('|').count()).collect();
        assert!(cells.iter().all(|n| *n == cells[0]), "{block}");
    }
}
