//! `devices`: costs of operations on devices, fitted to the kept times and counts.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use luthier::{MemoryStore, outline, read_materials};
use luthier_bake::Options;
use luthier_cost::{CostUnit, DeviceCost, Family, FitSource, Misfit, StaticCounts, Style, Timing, misfit};
use luthier_export::GENERATOR;
use luthier_lut::RowLayout;
use luthier_manifest::{FunctionGroup, Manifest, ShadingModel};
use luthier_material::Material;
use luthier_shader::{Form, MaterialSet, Yardstick, count, style_name};
use luthier_terminal::{Failure, Outcome, deliver, valid};
use serde_json::Value;

use crate::cli::{DevicesOptions, call};
use crate::papers::{ROLES, of_models};

/// Counts of a driver's compiler, and times of devices: the short name and the files of each.
const COUNTS: &str = "gpu-cost.json";
const TIMES: [(&str, &[&str]); 2] =
    [("h100", &["bench-gpu.json", "throughput-gpu.json"]), ("llvmpipe", &["bench-llvmpipe.json"])];

/// Families whose issue cycles a wave of the chips has: the order in which files are made.
const FAMILIES: [Family; 3] = Family::ALL;

/// A shader of a material, as rows of measurements name it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    material: String,
    /// Name of a model, of a yardstick, or of a shader of the papers.
    shader: String,
    form: Form,
    closed: bool,
    constant: bool,
    /// Layout of rows of lobes.
    layout: RowLayout,
    /// Lights on a prepared view.
    lights: u32,
}

/// A timed shader, with the cycles that the compiler counted for each family where it did.
struct Row {
    timing: Timing,
    /// The shader in words.
    title: String,
    cycles: Option<[f64; 3]>,
}

/// Fits costs of devices, writes a file for each and prints a page.
pub(crate) fn run(options: &DevicesOptions) -> Outcome {
    let materials = valid(read_materials(&options.sources.paths)?, true)?;
    let mut shaders = Shaders { materials: &materials, manifests: BTreeMap::new(), counts: BTreeMap::new() };
    let counted = json(&options.measurements.join(COUNTS))?;
    let mut cycles: BTreeMap<Key, [f64; 3]> = BTreeMap::new();
    for row in rows(&counted) {
        let Some(family) = row["family"].as_str().and_then(|name| name.parse::<Family>().ok()) else { continue };
        if let (Some(key), Some(count)) = (key(row), row["inverse_throughput"].as_f64()) {
            let place = FAMILIES.iter().position(|known| *known == family).unwrap_or(0);
            cycles.entry(key).or_insert([f64::NAN; 3])[place] = count;
        }
    }
    let mut found = Vec::new();
    for (name, files) in TIMES {
        let mut timed: Vec<Row> = Vec::new();
        let mut adapter = Value::Null;
        for file in files {
            let measured = json(&options.measurements.join(file))?;
            for row in rows(&measured) {
                let Some(time) = row["net_ns"].as_f64() else { continue };
                let Some((key, counts)) = shaders.of_row(row)? else { continue };
                let model = if row["shader"].is_null() { key.shader.clone() } else { paper_model(&key.shader) };
                // Counts are those of all lights of a view.
                let time = 1e3 * time * f64::from(key.lights);
                let timing = Timing { material: key.material.clone(), model, counts, time };
                let title = title(&key, !row["shader"].is_null());
                timed.push(Row { timing, title, cycles: cycles.get(&key).copied() });
            }
            adapter = measured["adapter"].clone();
        }
        let source = FitSource {
            generator: GENERATOR.to_owned(),
            name: name.to_owned(),
            device: text(&adapter["name"]),
            driver: text(&adapter["driver"]),
            unit: CostUnit::Picoseconds,
            source: format!("times of {}, and counts of today's text of the same shaders", files.join(" and ")),
            family: None,
        };
        found.push((fitted(source, &timed)?, timed));
    }
    for (place, family) in FAMILIES.into_iter().enumerate() {
        let mut counted_rows: Vec<Row> = Vec::new();
        for (key, all) in cycles.iter().filter(|(key, _)| !key.constant) {
            let Some(counts) = shaders.counts(key)? else { continue };
            let timing = Timing { material: key.material.clone(), model: key.shader.clone(), counts, time: all[place] };
            counted_rows.push(Row { timing, title: String::new(), cycles: Some(*all) });
        }
        let source = FitSource {
            generator: GENERATOR.to_owned(),
            name: family.name().to_owned(),
            device: family.chip().to_owned(),
            driver: text(&counted["driver"]),
            unit: CostUnit::Cycles,
            source: format!("inverse throughput by the driver's compiler, of {COUNTS}; nothing was timed"),
            family: Some(family),
        };
        found.push((fitted(source, &counted_rows)?, counted_rows));
    }
    for (costs, _) in &found {
        let file = options.folder.join(format!("{}.json", costs.name));
        deliver(&costs.to_json().map_err(Failure::input)?, Some(&file))?;
    }
    deliver(&page(options, &found), options.destination.output.as_deref())
}

/// A timed shader in words.
fn title(key: &Key, is_of_papers: bool) -> String {
    let mut title = match model_of(key) {
        Some(model) => format!("{model}, {}", style_name(model, key.form, key.closed, key.constant)),
        None if is_of_papers && key.constant => format!("{} (papers), constants", key.shader),
        None if is_of_papers => format!("{} (papers)", key.shader),
        None => key.shader.clone(),
    };
    if key.layout != RowLayout::Filtered {
        title += &format!(", {}", key.layout);
    }
    if key.lights > 1 {
        title += &format!(", {} lights", key.lights);
    }
    title
}

fn fitted(source: FitSource, rows: &[Row]) -> Outcome<DeviceCost> {
    let timings: Vec<Timing> = rows.iter().map(|row| row.timing.clone()).collect();
    DeviceCost::fitted(source, &timings).map_err(Failure::input)
}

fn json(path: &Path) -> Outcome<Value> {
    let named = |error: &dyn std::fmt::Display| Failure::Input(anyhow::anyhow!("{}: {error}", path.display()));
    let bytes = std::fs::read(path).map_err(|error| named(&error))?;
    serde_json::from_slice(&bytes).map_err(|error| named(&error))
}

fn rows(file: &Value) -> impl Iterator<Item = &Value> {
    file["rows"].as_array().into_iter().flatten()
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

/// The shader of a row of counts or of `luthier bench`; `None` for rows of other shaders.
fn key(row: &Value) -> Option<Key> {
    let shader = row["yardstick"].as_str().or(row["model"].as_str())?;
    let is_known = shader.parse::<ShadingModel>().is_ok() || shader.parse::<Yardstick>().is_ok();
    is_known.then_some(Key {
        material: row["material"].as_str()?.to_owned(),
        shader: shader.to_owned(),
        form: row["form"].as_str()?.parse().ok()?,
        closed: row["closed"].as_bool()?,
        constant: row["constant"].as_bool().unwrap_or(false),
        layout: row["layout"].as_str().map_or(Some(RowLayout::Filtered), |layout| layout.parse().ok())?,
        lights: row["lights"].as_u64().unwrap_or(1) as u32,
    })
}

fn model_of(key: &Key) -> Option<ShadingModel> {
    key.shader.parse().ok()
}

/// The model that a shader of the papers is of: groups of a fit are left out by model.
fn paper_model(shader: &str) -> String {
    if shader == "Phong" { ShadingModel::Phong } else { ShadingModel::Elek }.name().to_owned()
}

/// Texts of shaders, counted once each.
struct Shaders<'m> {
    materials: &'m [Material],
    manifests: BTreeMap<(String, String, RowLayout), Manifest>,
    counts: BTreeMap<Key, Option<StaticCounts>>,
}

impl Shaders<'_> {
    /// The shader of a row of `luthier bench` or of `luthier-lab throughput`, with its counts.
    fn of_row(&mut self, row: &Value) -> Outcome<Option<(Key, StaticCounts)>> {
        if let Some(name) = row["shader"].as_str() {
            let Some((shader, role)) = ROLES.into_iter().find(|(known, _)| *known == name) else { return Ok(None) };
            let material = text(&row["material"]);
            let Some(known) = self.materials.iter().find(|m| m.name == material) else { return Ok(None) };
            let constant = row["constant"].as_bool().unwrap_or(false);
            let [elek, phong] = of_models(known);
            let of_role = if shader == "Phong" { phong } else { elek };
            let layout = RowLayout::Filtered;
            let manifest = self.manifest(&(material.clone(), format!("{shader} of the papers"), layout), || of_role)?;
            let (set, style) = crate::papers::shader(manifest, role, constant);
            let counts = counted(&set, style, 1)?;
            let (shader, form) = (shader.to_owned(), style.form);
            let key = Key { material, shader, form, closed: true, constant, layout, lights: 1 };
            return Ok(Some((key, counts)));
        }
        let Some(key) = key(row) else { return Ok(None) };
        Ok(self.counts(&key)?.map(|counts| (key, counts)))
    }

    /// Counts of a shader of a model; `None` for a material that is not among those at hand.
    fn counts(&mut self, key: &Key) -> Outcome<Option<StaticCounts>> {
        if let Some(counts) = self.counts.get(key) {
            return Ok(*counts);
        }
        let model = model_of(key);
        if let Ok(yardstick) = key.shader.parse::<Yardstick>() {
            return Ok(Some(count(&yardstick.wgsl(), &[], key.lights).map_err(Failure::input)?));
        }
        let material = self.materials.iter().find(|material| material.name == key.material);
        let counts = match model.zip(material.cloned()) {
            None => None,
            Some((model, mut material)) => {
                material.bake.model = Some(model);
                let place = (key.material.clone(), key.shader.clone(), key.layout);
                let set = MaterialSet::from_manifest(self.manifest(&place, || material)?);
                let mut set = if key.closed { set.with_closed_distribution() } else { set };
                if key.lights > 1 {
                    set.functions = [FunctionGroup::Light].into_iter().collect();
                }
                let style = Style { form: key.form, constant: key.constant, approximate: false };
                Some(counted(&set, style, key.lights)?)
            }
        };
        self.counts.insert(key.clone(), counts);
        Ok(counts)
    }

    fn manifest(
        &mut self,
        key: &(String, String, RowLayout),
        material: impl FnOnce() -> Material,
    ) -> Outcome<&Manifest> {
        if !self.manifests.contains_key(key) {
            let manifest = outline(
                &[material()],
                &Options { layout: Some(key.2), ..Options::default() },
                &MemoryStore::default(),
            )?;
            self.manifests.insert(key.clone(), manifest);
        }
        Ok(&self.manifests[key])
    }
}

fn counted(set: &MaterialSet<'_>, style: Style, lights: u32) -> Outcome<StaticCounts> {
    let text = luthier_cost::shader_text(set, style).map_err(Failure::input)?;
    count(&text, &set.wide_textures(), lights).map_err(Failure::input)
}

fn page(options: &DevicesOptions, found: &[(DeviceCost, Vec<Row>)]) -> String {
    let mut page = format!(
        "# Costs of operations on devices\n\nGenerated by `{}`. A cost comes from the counts of a shader's text, each times a number of the device. Reads of textures are \
         one side, all other operations the other; the cost is the longer side, and of the shorter one what does not hide behind it. The numbers are fitted: not negative, with the least sum \
         of squared relative errors. Counts are those of today's text of the shaders; the times were taken before, of the text that the \
         shaders had then. Shaders with materials as constants are fitted for times, and not for counts of the compiler.\n\n\
         | device | driver | numbers fitted to |\n|---|---|---|\n",
        call("devices", &options.sources.paths)
    );
    for (costs, _) in found {
        let _ = writeln!(page, "| {}: {} | {} | {} |", costs.name, costs.device, costs.driver, costs.source);
    }
    page.push_str("\n## Cost of one operation\n\nA wide read is one through a sampler of more than 4 bytes a texel. *Hidden* is the share of the shorter side that hides behind the longer: 0 is the sum of both, 1 the longer one alone. A number in brackets is assumed: no shader of the fit has such a read.\n\n| device | unit |");
    for name in StaticCounts::NAMES {
        let _ = write!(page, " {} |", name.replace('_', " "));
    }
    page.push_str(" hidden |\n|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (costs, _) in found {
        let _ = write!(page, "| {} | {} |", costs.name, costs.unit);
        for (name, value) in StaticCounts::NAMES.iter().zip(costs.coefficients.values()) {
            let is_assumed = costs.assumed.iter().any(|kind| kind == name);
            let number = if value >= 100.0 { format!("{value:.0}") } else { format!("{value:.3}") };
            let _ = if is_assumed { write!(page, " ({number}) |") } else { write!(page, " {number} |") };
        }
        let _ = writeln!(page, " {:.2} |", costs.hidden);
    }
    page.push_str(
        "\nReads of several kinds stand side by side in most shaders, so that their sum is known better than each.\n\n## How far the costs are off\n\n\
         Relative errors over the shaders, and the share of pairs of shaders of one material, with times at least 5 % apart, that the costs put into the order of the times. \
         *Not seen* means that the numbers were fitted to the rows of the other materials, or of the other models. *Counts alone* are operations of no device (a plain operation 1, a \
         special function, texel or word 4, a filtered read 16 for each 4 bytes of a texel) times one number, fitted to the other models.\n\n\
         | device | costs | shaders | median error | largest | pairs in order |\n|---|---|--:|--:|--:|--:|\n",
    );
    for (costs, rows) in found {
        let fit = &costs.fit;
        let mut lines: Vec<(&str, Option<Misfit>)> = vec![
            ("fitted", Some(fit.own)),
            ("fitted, material not seen", fit.without_material),
            ("fitted, model not seen", fit.without_model),
            ("counts alone, model not seen", Some(fit.counts_alone)),
        ];
        let by_compiler = (costs.family.is_none()).then(|| of_compiler(rows)).flatten();
        lines.push(("cycles of RDNA2 by RADV's compiler, times one number", by_compiler));
        for (what, found) in lines {
            let Some(Misfit { median, largest, in_order }) = found else { continue };
            let count = if what.starts_with("cycles") { counted_too(rows).len() } else { fit.rows as usize };
            let [median, largest, in_order] = [median, largest, in_order].map(|share| 100.0 * share);
            let _ = writeln!(
                page,
                "| {} | {what} | {count} | {median:.0} % | {largest:.0} % | {in_order:.0} % |",
                costs.name
            );
        }
    }
    page.push('\n');
    for (costs, _) in found {
        let verdict = if costs.fit.is_better_than_counts() {
            "is nearer to models that it has not seen than counts alone"
        } else {
            "is not nearer to models that it has not seen than counts alone"
        };
        let _ = writeln!(page, "- {}: the fit {verdict}.", costs.name);
    }
    for (costs, rows) in found.iter().filter(|(costs, _)| costs.family.is_none()) {
        let _ = write!(
            page,
            "\n## Shaders timed on {}\n\nTimes of {} are net of the harness, in {}.\n\n| material | shader |",
            costs.name, costs.device, costs.unit
        );
        for name in StaticCounts::NAMES {
            let _ = write!(page, " {} |", name.replace('_', " "));
        }
        page.push_str(" time | cost | off by |\n|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
        for Row { timing, title, .. } in rows {
            let _ = write!(page, "| {} | {title} |", timing.material);
            for count in timing.counts.values() {
                let _ = write!(page, " {count} |");
            }
            let cost = costs.cost(&timing.counts);
            let off = 100.0 * (cost / timing.time - 1.0);
            let [time, cost] = [timing.time, cost].map(|x| if x < 1e3 { format!("{x:.1}") } else { format!("{x:.0}") });
            let _ = writeln!(page, " {time} | {cost} | {off:+.0} % |");
        }
    }
    page
}

/// Timed shaders that the compiler counted for RDNA2, too, with its cycles.
fn counted_too(rows: &[Row]) -> Vec<(Timing, f64)> {
    let place = FAMILIES.iter().position(|family| *family == Family::Rdna2).unwrap_or(0);
    rows.iter().filter_map(|row| Some((row.timing.clone(), row.cycles?[place]))).collect()
}

/// How well the compiler's cycles of RDNA2, times one number, meet the times of a device.
fn of_compiler(rows: &[Row]) -> Option<Misfit> {
    let (timings, cycles): (Vec<Timing>, Vec<f64>) = counted_too(rows).into_iter().unzip();
    let ratios: Vec<f64> = timings.iter().zip(&cycles).map(|(row, cycles)| cycles / row.time).collect();
    let scale = ratios.iter().sum::<f64>() / ratios.iter().map(|r| r * r).sum::<f64>();
    (!timings.is_empty()).then(|| misfit(&timings, &cycles.iter().map(|c| scale * c).collect::<Vec<_>>()))
}
