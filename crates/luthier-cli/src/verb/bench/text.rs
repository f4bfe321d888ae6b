//! The result as a table for people.

use luthier_gpu::Gpu;
use luthier_manifest::ShadingModel;
use luthier_shader::style_name;
use luthier_terminal::adapter_label;

use super::Bench;

impl Bench {
    pub(super) fn to_text(&self, gpu: &Gpu) -> String {
        let kind = if gpu.is_software() { ", a program on the CPU" } else { "" };
        let mut out = format!(
            "{}{kind}; clock: {}; {} evaluations, {} repeats; times are per evaluation, of one light\n\n",
            adapter_label(gpu),
            self.clock,
            self.evaluations,
            self.repeats,
        );
        if !self.rows.is_empty() {
            out.push_str(&self.single_text());
        }
        if !self.per_pixel.is_empty() {
            out.push_str(&self.per_pixel_text());
        }
        out
    }

    fn single_text(&self) -> String {
        let mut out = format!(
            "{:<24} {:<18} {:<26} {:>6} {:>9} {:>8} {:>9} {:>7} {:>7} {:>15}\n",
            "material", "shader", "form", "lights", "median ns", "MAD", "net ns", "/phong", "/full", "/gltf-clearcoat"
        );
        for row in &self.rows {
            let (shader, form) = match row.model {
                Some(model) => {
                    let style = style_name(model, row.form, row.closed, false);
                    (model.name(), row.layout.map_or(style.clone(), |layout| format!("{style}, {layout}")))
                }
                None => (row.yardstick.unwrap_or_default(), "-".to_owned()),
            };
            out.push_str(&format!(
                "{:<24} {:<18} {:<26} {:>6} {:>9.4} {:>8.4} {:>9.4} {:>7} {:>7} {:>15}\n",
                row.material,
                shader,
                form,
                row.lights,
                row.median_ns,
                row.mad_ns,
                row.net_ns,
                ratio(row.of_phong),
                ratio(row.of_full),
                ratio(row.of_gltf_clearcoat)
            ));
        }
        out
    }

    fn per_pixel_text(&self) -> String {
        let mut out = format!(
            "{:>9} {:<18} {:>6} {:<18} {:>9} {:>8} {:>9} {:>9} {:>7}\n",
            "materials", "model", "lights", "one material for", "median ns", "MAD", "net ns", "alone ns", "/alone"
        );
        for row in &self.per_pixel {
            let model =
                row.model.map_or_else(|| format!("of the file ({})", row.models), |m| ShadingModel::name(m).to_owned());
            let run = match row.run {
                None => "one run of threads".to_owned(),
                Some(1) => "each thread".to_owned(),
                Some(run) => format!("{run} threads"),
            };
            out.push_str(&format!(
                "{:>9} {:<18} {:>6} {:<18} {:>9.4} {:>8.4} {:>9.4} {:>9.4} {:>7}\n",
                row.materials,
                model,
                row.lights,
                run,
                row.median_ns,
                row.mad_ns,
                row.net_ns,
                row.alone_ns,
                ratio(row.of_alone)
            ));
        }
        out
    }
}

/// A ratio to a shader; none where there is no such shader.
fn ratio(value: f64) -> String {
    if value.is_nan() { "-".to_owned() } else { format!("{value:.2}") }
}
