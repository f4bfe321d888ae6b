//! The page before its script runs.

use std::fmt::Write;

use luthier_export::GENERATOR;
use luthier_manifest::MaterialEntry;

use crate::markup::escape;
use crate::{Exhibit, Gallery, section};

/// Parts of the script, in order.
const SCRIPT: [&str; 7] = [
    include_str!("page/textures.js"),
    include_str!("page/data.js"),
    include_str!("page/painter.js"),
    include_str!("page/look.js"),
    include_str!("page/tiles.js"),
    include_str!("page/stage.js"),
    include_str!("page/page.js"),
];

/// The whole document around the data of the script.
pub(crate) fn html(gallery: &Gallery, data: &str) -> String {
    let mut out = String::with_capacity(data.len() + (256 << 10));
    out.push_str("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>");
    out.push_str("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>");
    // The page loads nothing from elsewhere.
    out.push_str("<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:\"/>");
    let _ = writeln!(out, "<title>{}</title><link rel=\"icon\" href=\"data:,\"/><style>", escape(&gallery.title));
    out.push_str(include_str!("page/style.css"));
    out.push_str("</style></head>\n<body>\n");
    head(&mut out, gallery);
    out.push_str("<main>\n<p id=\"page-trouble\" role=\"alert\" hidden=\"\"></p>\n");
    tiles(&mut out, gallery);
    out.push_str(include_str!("page/stage.html"));
    for (i, exhibit) in gallery.exhibits.iter().enumerate() {
        article(&mut out, gallery, i, exhibit);
    }
    out.push_str("</main>\n<script type=\"application/json\" id=\"page-data\">");
    out.push_str(data);
    out.push_str("</script>\n<script type=\"module\">\n");
    for part in SCRIPT {
        out.push_str(part);
    }
    out.push_str("</script></body></html>\n");
    out
}

fn head(out: &mut String, gallery: &Gallery) {
    let count = gallery.exhibits.len();
    let materials = if count == 1 { "1 material".to_owned() } else { format!("{count} materials") };
    let _ = write!(
        out,
        "<header><div class=\"head\"><h1><a href=\"#\" id=\"page-title\">{}</a></h1><p class=\"sub\">{materials}, {GENERATOR}</p>\
         <div class=\"wall\"><label class=\"sub\">Name <input id=\"page-filter\" type=\"search\" autocomplete=\"off\"/></label>\
         <button id=\"page-turn\" type=\"button\" aria-pressed=\"false\">Turn tiles</button></div></div>",
        escape(&gallery.title)
    );
    out.push_str(include_str!("page/controls.html"));
    out.push_str("</header>\n");
}

fn tiles(out: &mut String, gallery: &Gallery) {
    out.push_str("<ul class=\"tiles\">\n");
    for (i, exhibit) in gallery.exhibits.iter().enumerate() {
        let name = escape(&exhibit.name);
        let model = entry(gallery, exhibit).map_or("", |entry| entry.model.name());
        let _ = writeln!(
            out,
            "<li data-number=\"{i}\"><a href=\"#{name}\"><canvas aria-hidden=\"true\"></canvas><span>{name}</span><small>{model}</small></a></li>"
        );
    }
    out.push_str("</ul>\n");
}

/// The entry of the look that is shown.
fn entry<'g>(gallery: &'g Gallery, exhibit: &Exhibit) -> Option<&'g MaterialEntry> {
    let look = exhibit.looks.first()?;
    gallery.packages.get(look.package)?.manifest.materials.get(look.material as usize)
}

fn article(out: &mut String, gallery: &Gallery, number: usize, exhibit: &Exhibit) {
    let name = escape(&exhibit.name);
    let _ = write!(
        out,
        "<article id=\"{name}\" aria-labelledby=\"page-name-{number}\">\n<div class=\"title\"><h2 id=\"page-name-{number}\">{name}</h2>"
    );
    out.push_str("<nav aria-label=\"Materials\">");
    for (other, words) in [(number.checked_sub(1), "Previous"), (Some(number + 1), "Next")] {
        if let Some(other) = other.and_then(|other| gallery.exhibits.get(other)) {
            let other = escape(&other.name);
            let _ = write!(out, "<a href=\"#{other}\" title=\"{other}\">{words}</a>");
        }
    }
    out.push_str("<a href=\"#\">All</a></nav></div>");
    if !exhibit.description.is_empty() {
        let _ = write!(out, "<p class=\"sub\">{}</p>", escape(&exhibit.description));
    }
    out.push_str("<div class=\"columns\"><div class=\"place\"></div><div class=\"words\">\n");
    if let Some(section) = &exhibit.section {
        section::figure(out, &exhibit.name, section);
    }
    if let Some(text) = &exhibit.text {
        let _ = writeln!(
            out,
            "<details open=\"\"><summary>Material file</summary><pre tabindex=\"0\"><code>{}</code></pre></details>",
            escape(text)
        );
    } else {
        let source = entry(gallery, exhibit).map_or("", |entry| &entry.source);
        let from =
            if source.is_empty() { String::new() } else { format!(" Its file was <code>{}</code>.", escape(source)) };
        let _ = writeln!(out, "<p class=\"sub\">The bake has no text of the material file.{from}</p>");
    }
    out.push_str("</div></div></article>\n");
}
