//! Cross-sections of materials, drawn.

use std::fmt::Write;

use luthier_material::{CrossSection, Part, PartKind};

use crate::markup::escape;

/// Width of the drawing, in its own units.
const WIDTH: f64 = 300.0;

/// A cross-section with the numbers of its parts beside it.
pub(crate) fn figure(out: &mut String, name: &str, section: &CrossSection) {
    let height: f64 = WIDTH * section.parts.iter().map(|part| part.height).sum::<f64>();
    let _ = write!(
        out,
        "<figure class=\"section\"><svg viewBox=\"0 0 {WIDTH} {height:.1}\" role=\"img\" aria-label=\"Cross-section of {}: {}\">",
        escape(name),
        escape(&section.parts.iter().map(|part| part.label.as_str()).collect::<Vec<_>>().join(", "))
    );
    let mut top = 0.0;
    let mut letters = String::new();
    for (i, part) in section.parts.iter().enumerate() {
        if part.kind != PartKind::Exterior {
            boundary(out, part, top, height);
        }
        let middle = top + 0.5 * WIDTH * part.height;
        let ink = if part.kind == PartKind::Exterior { "plain" } else { ink(part) };
        let _ = write!(letters, "<text x=\"12\" y=\"{:.1}\" class=\"{ink}\">{}</text>", middle + 4.5, i + 1);
        top += WIDTH * part.height;
    }
    out.push_str(&letters);
    out.push_str("</svg><ol>");
    for part in &section.parts {
        let _ = write!(out, "<li><b>{}</b><dl>", escape(&part.label));
        for number in &part.numbers {
            let _ = write!(out, "<div><dt>{}</dt><dd>{}</dd></div>", escape(number.name), escape(&number.value));
        }
        out.push_str("</dl></li>");
    }
    out.push_str("</ol>");
    for effect in &section.effects {
        let _ = write!(out, "<p class=\"sub\">With {}.</p>", escape(effect));
    }
    out.push_str(
        "<figcaption class=\"sub\">Slopes are to scale, heights are not. Colours: the light that a slab passes, the reflectance of an opaque part, the \
         albedo of a diffuse one.",
    );
    if section.parts.iter().flat_map(|part| &part.numbers).any(|number| number.name.starts_with("relative")) {
        out.push_str(" Relative indices are over that of the medium above, at three wavelengths where they are three.");
    }
    out.push_str("</figcaption></figure>\n");
}

/// A part, from its upper boundary down to the bottom, which the parts below cover.
fn boundary(out: &mut String, part: &Part, top: f64, bottom: f64) {
    let mut line = String::new();
    for [x, y] in &part.outline {
        let _ = write!(line, "{:.1},{:.1} ", x * WIDTH, top - y * WIDTH);
    }
    let color = hex(part);
    let _ = write!(out, "<polygon points=\"{line}{WIDTH},{bottom:.1} 0,{bottom:.1}\" fill=\"{color}\"/>");
    let _ = write!(out, "<polyline points=\"{}\"/>", line.trim_end());
}

/// The colour of a part for displays.
fn srgb(part: &Part) -> [f64; 3] {
    let linear = part.color.map(|v| v.clamp(0.0, 1.0));
    linear.map(|v| if v > 0.003_130_8 { 1.055 * libm::pow(v, 1.0 / 2.4) - 0.055 } else { 12.92 * v })
}

fn hex(part: &Part) -> String {
    let [r, g, b] = srgb(part).map(|v| (v * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Dark letters on light parts, light ones on dark parts.
fn ink(part: &Part) -> &'static str {
    let [r, g, b] = srgb(part);
    if 0.3 * r + 0.6 * g + 0.1 * b > 0.5 { "dark" } else { "light" }
}
