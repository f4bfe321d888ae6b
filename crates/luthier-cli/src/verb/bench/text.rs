//! The result as a table for people.

use luthier_gpu::Gpu;
use luthier_shader::style_name;
use luthier_terminal::adapter_label;

use super::Bench;

impl Bench {
    pub(super) fn to_text(&self, gpu: &Gpu) -> String {
        let kind = if gpu.is_software() { ", a program on the CPU" } else { "" };
        let mut out = format!(
            "{}{kind}; clock: {}; {} evaluations, {} repeats\n\n\
             {:<24} {:<17} {:<16} {:>9} {:>8} {:>9} {:>7} {:>7}\n",
            adapter_label(gpu),
            self.clock,
            self.evaluations,
            self.repeats,
            "material",
            "model",
            "form",
            "median ns",
            "MAD",
            "net ns",
            "/phong",
            "/full"
        );
        for row in &self.rows {
            out.push_str(&format!(
                "{:<24} {:<17} {:<16} {:>9.4} {:>8.4} {:>9.4} {:>7} {:>7}\n",
                row.material,
                row.model.name(),
                style_name(row.model, row.form, row.closed, false),
                row.median_ns,
                row.mad_ns,
                row.net_ns,
                ratio(row.of_phong),
                ratio(row.of_full)
            ));
        }
        out
    }
}

/// A ratio to a shader; none where there is no such shader.
fn ratio(value: f64) -> String {
    if value.is_nan() { "-".to_owned() } else { format!("{value:.2}") }
}
