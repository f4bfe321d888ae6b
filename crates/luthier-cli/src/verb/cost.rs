//! `cost`: shaders compiled for GPUs that are not here.

use luthier::{outline, read_materials};
use luthier_bake::Options;
use luthier_cost::{
    CostReport, CostRow, DeviceCost, Family, Harness, Kernel, StaticCounts, Style, assembly_apart, compile_apart,
    shader_text,
};
use luthier_export::GENERATOR;
use luthier_lut::{RowLayout, TableKind};
use luthier_manifest::ShadingModel;
use luthier_material::Material;
use luthier_shader::{Form, MaterialSet, count};
use luthier_terminal::{Failure, Outcome, deliver, print, valid};

use crate::cli::CostOptions;
use crate::materials::{is_shaded_by, models, shade_by};
use crate::store::store;
use crate::verb::cost_on;

/// Compiles shaders for GPUs that are not here, and prints what they cost.
pub(crate) fn run(options: &CostOptions) -> Outcome {
    let materials = valid(read_materials(&options.sources.paths)?, true)?;
    let device = options.costs_of.load()?;
    // A family of chips has its compiler, which is asked in place of counts.
    let family: Vec<Family> = device.iter().filter_map(|device| device.family).collect();
    let asked = if family.is_empty() { &options.family } else { &family };
    let variants = variants(options, &materials)?;
    if let Some(costs) = device.filter(|device| device.family.is_none()) {
        return on_device(options, &costs, variants);
    }
    if options.assembly {
        return match (variants.as_slice(), asked.as_slice()) {
            ([variant], [family]) => print(&assembly_apart(*family, &variant.kernel).map_err(Failure::device)?),
            _ => Err(Failure::Usage(anyhow::anyhow!(
                "--assembly prints one kernel, not {}: name one material, --model, --form, --closed, --constant and --family",
                variants.len()
            ))),
        };
    }
    let mut kernels = vec![Kernel::empty(Harness::Bare).map_err(Failure::input)?];
    kernels.extend(variants.iter().map(|v| v.kernel.clone()));
    let families: &[Family] = if asked.is_empty() { &Family::ALL } else { asked };
    let mut report = CostReport { generator: GENERATOR.to_owned(), ..CostReport::default() };
    for &family in families {
        let compiled = compile_apart(family, &kernels).map_err(Failure::device)?;
        let [harness, counts @ ..] = compiled.counts.as_slice() else {
            return Err(Failure::Device(anyhow::anyhow!("the probe gave no counts")));
        };
        report.add_family(family, &compiled, *harness);
        report.rows.extend(variants.iter().zip(counts).map(|(variant, counts)| CostRow {
            material: variant.material.clone(),
            model: variant.model,
            form: variant.style.form,
            closed: variant.closed,
            constant: variant.style.constant,
            family,
            counts: counts.beyond(harness),
        }));
    }
    let text =
        if options.json { report.to_json().map_err(Failure::input)? } else { report.to_markdown(&command(options)) };
    deliver(&text, options.output.as_deref())
}

/// The costs on a device that no compiler counts for.
fn on_device(options: &CostOptions, costs: &DeviceCost, variants: Vec<Variant>) -> Outcome {
    if options.assembly {
        return Err(Failure::Usage(anyhow::anyhow!("--assembly is of gcn5, rdna2 and rdna3, not of {}", costs.name)));
    }
    let shaders = variants.into_iter().map(|Variant { material, model, style, closed, counts, .. }| cost_on::Shader {
        material,
        model,
        form: style.form,
        closed,
        constant: style.constant,
        counts,
    });
    let shaders: Vec<cost_on::Shader> = shaders.collect();
    let text = match options.json {
        true => cost_on::json(costs, &shaders)?,
        false => cost_on::markdown(costs, &shaders, &command(options)),
    };
    deliver(&text, options.output.as_deref())
}

/// One shader to compile.
struct Variant {
    material: String,
    model: ShadingModel,
    style: Style,
    /// Whether D is a closed form.
    closed: bool,
    /// Counts of its text.
    counts: StaticCounts,
    kernel: Kernel,
}

/// Every material (or all as one set) in every model, form and style asked for.
fn variants(options: &CostOptions, materials: &[Material]) -> Outcome<Vec<Variant>> {
    // The compiler counts fewer cycles for rows that a sampler filters.
    let layout = options.layout.unwrap_or(RowLayout::Filtered);
    let models = models(&options.model, options.no_fit);
    let forms: Vec<Form> = if options.form.is_empty() { Form::ALL.to_vec() } else { options.form.clone() };
    let mut variants = Vec::new();
    for model in models {
        let mut shaded: Vec<Material> =
            materials.iter().filter(|material| is_shaded_by(material, model, &options.model)).cloned().collect();
        if shaded.is_empty() {
            continue;
        }
        for material in &mut shaded {
            shade_by(material, model, options.fresnel)?;
        }
        let groups: Vec<(String, &[Material])> = if options.set {
            vec![(format!("set of {}", shaded.len()), shaded.as_slice())]
        } else {
            shaded.iter().map(|m| (m.name.clone(), std::slice::from_ref(m))).collect()
        };
        for (name, group) in groups {
            let manifest = outline(group, &Options { layout: Some(layout), ..Options::default() }, store()?)?;
            // A form that is asked for by name is kept: if the model lacks it, the emitter refuses it.
            for &form in forms.iter().filter(|form| !options.form.is_empty() || model.has(**form)) {
                for (closed, constant) in styles(options) {
                    // A shader without a table of D is the same in both styles.
                    let has_d = manifest.table(TableKind::Distribution).is_some();
                    let has_table = form == Form::Baked && model.reads_some(TableKind::Distribution) && has_d;
                    if closed && !has_table && !options.closed {
                        continue;
                    }
                    let set = MaterialSet::from_manifest(&manifest);
                    let set = if closed { set.with_closed_distribution() } else { set };
                    let style = Style { form, constant, approximate: false };
                    let kernel = Kernel::of_set(&set, style, Harness::Bare).map_err(Failure::input)?;
                    let text = shader_text(&set, style).map_err(Failure::input)?;
                    let counts = count(&text, &set.wide_textures(), 1).map_err(Failure::input)?;
                    let closed = closed || !has_table;
                    variants.push(Variant { material: name.clone(), model, style, closed, counts, kernel });
                }
            }
        }
    }
    Ok(variants)
}

/// The styles to compile: whether D is a closed form, and whether the material is constants.
fn styles(options: &CostOptions) -> Vec<(bool, bool)> {
    let all = [(false, false), (true, false), (false, true), (true, true)];
    let wanted = all.into_iter().filter(|&(closed, constant)| {
        (closed || !options.closed) && (constant || !options.constant) && !(constant && options.set)
    });
    // Assembly is printed for one kernel only: the style that the options name.
    wanted.filter(|style| !options.assembly || *style == (options.closed, options.constant)).collect()
}

/// The command line that makes the page.
fn command(options: &CostOptions) -> String {
    let mut words = vec!["luthier cost".to_owned()];
    words.extend(options.sources.paths.iter().map(|path| path.display().to_string()));
    words.extend(options.model.iter().map(|model| format!("--model {}", model.name())));
    words.extend(options.form.iter().map(|&form| format!("--form {}", form.name())));
    words.extend(options.fresnel.iter().map(|reflectance| format!("--fresnel {reflectance}")));
    words.extend(options.layout.iter().map(|layout| format!("--layout {}", layout.name())));
    words.extend(options.family.iter().map(|family| format!("--family {}", family)));
    words.extend(options.costs_of.device.iter().map(|name| format!("--device {name}")));
    words.extend(options.costs_of.costs.iter().map(|path| format!("--costs {}", path.display())));
    let flags = [
        ("--no-fit", options.no_fit),
        ("--set", options.set),
        ("--closed", options.closed),
        ("--constant", options.constant),
    ];
    words.extend(flags.iter().filter(|(_, is_set)| *is_set).map(|(flag, _)| (*flag).to_owned()));
    words.extend(options.output.iter().map(|path| format!("-o {}", path.display())));
    words.join(" ")
}
