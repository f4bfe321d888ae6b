//! Charts of the contents, errors and sizes of tables.

use crate::measure::scan::report::{AlphaPoint, ReflectanceCurve, TableReport};
use crate::svg::frame::{Frame, Margin};
use crate::svg::scale::Scale;
use crate::text::format::bytes;

/// Reflectance of a Fresnel row over the angle, three channels.
pub(crate) fn reflectance(name: &str, curve: &ReflectanceCurve) -> String {
    let largest = curve.rgb.iter().flatten().copied().fold(1.0, f64::max);
    let top = libm::ceil(largest * 10.0 - 1e-9) / 10.0;
    let margin = Margin { left: 28.0, right: 8.0, top: 10.0, bottom: 22.0 };
    let mut frame = Frame::new([236.0, 150.0], margin, Scale::linear(0.0, 90.0, 30.0), Scale::linear(0.0, top, 0.5));
    frame.x_axis("");
    frame.y_axis("");
    for (channel, class) in ["c-blue", "c-green", "c-red"].into_iter().enumerate() {
        let channel = 2 - channel;
        let points = (0..).zip(&curve.rgb).map(|(n, rgb): (u32, _)| (curve.step_deg * f64::from(n), rgb[channel]));
        frame.line(class, ["R", "G", "B"][channel], points.map(Some));
    }
    frame.finish(&format!("Reflectance of {name} over the angle, 0 to 90 degrees"))
}

/// The classes of distribution curves, in order of tiles.
const DISTRIBUTION_CLASSES: [&str; 4] = ["s-baked", "s-tables", "s-full", "s-arithmetic"];

/// Largest error over the angle as a fraction of the peak, against alpha; one curve per tile.
pub(crate) fn error_by_alpha(curves: &[(&str, &[AlphaPoint])]) -> String {
    let points = curves.iter().flat_map(|(_, points)| points.iter());
    let x = Scale::decades(points.clone().map(|p| p.alpha), 1e-4);
    let y = Scale::decades(points.map(|p| p.max_err_of_peak), 1e-9);
    let margin = Margin { left: 44.0, right: 80.0, top: 24.0, bottom: 38.0 };
    let mut frame = Frame::new([560.0, 250.0], margin, x, y);
    frame.x_axis("alpha");
    frame.y_axis("largest error over the angle / peak at that alpha");
    for (i, (name, points)) in curves.iter().enumerate() {
        let class = DISTRIBUTION_CLASSES[i % DISTRIBUTION_CLASSES.len()];
        frame.line(class, name, points.iter().map(|p| Some((p.alpha, p.max_err_of_peak))));
        if let Some(last) = points.last() {
            let (x, y) = (frame.px(last.alpha), frame.py(last.max_err_of_peak));
            frame.text(x + 6.0, y + 4.0, "start", &format!("name {class}"), name);
        }
    }
    frame.finish("Error of the slope distributions against alpha")
}

/// A bar per table: bytes of texels.
pub(crate) fn bytes_by_table(tables: &[TableReport]) -> String {
    const ROW: f64 = 26.0;
    let largest = tables.iter().map(|t| t.texel_bytes).max().unwrap_or(0).max(1) as f64;
    let margin = Margin { left: 110.0, right: 80.0, top: 4.0, bottom: 4.0 };
    let height = margin.top + margin.bottom + ROW * tables.len() as f64;
    let x = Scale::linear(0.0, largest, largest);
    let mut frame = Frame::new([490.0, height], margin, x, Scale::linear(0.0, 1.0, 1.0));
    for (row, table) in tables.iter().enumerate() {
        let y = margin.top + ROW * (row as f64 + 0.5);
        frame.text(margin.left - 10.0, y + 4.0, "end", "label", table.kind.name());
        frame.bar("s-baked", table.texel_bytes as f64, y, 14.0);
        let end = frame.px(table.texel_bytes as f64);
        frame.text(end + 6.0, y + 4.0, "start", "value", &bytes(table.texel_bytes));
    }
    frame.finish("Bytes of texels of every table")
}
