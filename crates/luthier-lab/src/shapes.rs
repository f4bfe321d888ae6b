//! The table by which scenes choose models: costs by shape of the surface.

use luthier::{MemoryStore, outline, read_materials};
use luthier_bake::Options;
use luthier_cost::{Family, Harness, Kernel, StaticCounts, Style, compile_apart};
use luthier_lut::RowLayout;
use luthier_manifest::{LobesForm, ShadingModel};
use luthier_shader::{Form, MaterialSet, count};
use luthier_terminal::{Failure, Outcome, deliver, valid};

use crate::cli::ShapesOptions;

/// A shader that a row of the table is of.
struct Key {
    model: ShadingModel,
    form: Form,
    shape: String,
    lobes: Option<LobesForm>,
    in_steps: bool,
}

/// Costs of every shape that the materials have, whole or without some of their parts: what scenes choose by.
pub(crate) fn run(options: &ShapesOptions) -> Outcome {
    let materials = valid(read_materials(&options.sources.paths)?, true)?;
    let mut keys: Vec<Key> = Vec::new();
    let mut texts = Vec::new();
    let mut kernels = vec![Kernel::empty(Harness::Bare).map_err(Failure::input)?];
    for model in ShadingModel::ALL {
        for mut material in materials.iter().flat_map(luthier_scene::variants).map(|(_, material)| material) {
            material.bake.model = Some(model);
            let shape = luthier_scene::shape_of(model, &luthier_scene::shape(&material.stack));
            // Remove what does not belong to a shape, and what would distinguish two materials of one shape.
            material.effects = Default::default();
            material.bake.distribution = Default::default();
            // Stacks of one shape may differ in the forms of their lobes.
            let of_shape = keys.iter().filter(|known| (known.model, &known.shape) == (model, &shape));
            let known: Vec<Option<LobesForm>> = of_shape.map(|known| known.lobes).collect();
            let of_lobes = luthier_scene::forms(&material)
                .into_iter()
                .flatten()
                .flat_map(|lobes| [RowLayout::Filtered, RowLayout::Steps].map(|layout| (Some(lobes), layout)));
            let of_lobes: Vec<_> = of_lobes.filter(|_| model.is_fitted()).collect();
            let rows = if of_lobes.is_empty() { vec![(None, RowLayout::Filtered)] } else { of_lobes };
            for (lobes, layout) in rows.into_iter().filter(|(lobes, _)| !known.contains(lobes)) {
                material.bake.lobes = lobes;
                let layout = (layout == RowLayout::Filtered).then_some(layout);
                let options = Options { fits: false, layout, ..Options::default() };
                let manifest = outline(std::slice::from_ref(&material), &options, &MemoryStore::default())?;
                let in_steps = manifest.tables.iter().any(|table| table.format.has_steps());
                if layout.is_none() && !in_steps {
                    continue;
                }
                let set = MaterialSet::from_manifest(&manifest);
                for form in Form::ALL.into_iter().filter(|&form| model.has(form)) {
                    let style = Style { form, constant: false, approximate: false };
                    let text = luthier_cost::shader_text(&set, style).map_err(Failure::input)?;
                    texts.push(count(&text, &set.wide_textures(), 1).map_err(Failure::input)?);
                    kernels.push(Kernel::of_set(&set, style, Harness::Bare).map_err(Failure::input)?);
                    keys.push(Key { model, form, shape: shape.clone(), lobes, in_steps });
                }
            }
        }
    }
    let mut driver = String::new();
    let mut cycles: Vec<[i64; 3]> = vec![[0; 3]; keys.len()];
    for (place, family) in Family::ALL.into_iter().enumerate() {
        let compiled = compile_apart(family, &kernels).map_err(Failure::device)?;
        let [harness, counts @ ..] = compiled.counts.as_slice() else {
            return Err(Failure::Device(anyhow::anyhow!("the probe gave no counts")));
        };
        let net = counts.iter().map(|counts| counts.beyond(harness).inverse_throughput);
        cycles.iter_mut().zip(net).for_each(|(row, net)| row[place] = net);
        driver = compiled.driver;
    }
    let rows: Vec<String> = keys
        .iter()
        .zip(cycles.iter().zip(&texts))
        .map(|(Key { model, form, shape, lobes, in_steps }, (cycles, counts))| {
            let (model, form, counts) = (model.name(), form.name(), counts.values());
            let lobes = lobes.map_or_else(String::new, |lobes| format!(r#""lobes":"{lobes}","in_steps":{in_steps},"#));
            format!(
                r#"    {{"model":"{model}","form":"{form}","shape":"{shape}",{lobes}"cycles":{cycles:?},"counts":{counts:?}}}"#
            )
        })
        .collect();
    let text = format!(
        "{{\n  \"driver\": {},\n  \"families\": {},\n  \"counts\": {},\n  \"rows\": [\n{}\n  ]\n}}\n",
        serde_json::json!(driver),
        serde_json::json!(Family::NAMES),
        serde_json::json!(StaticCounts::NAMES),
        rows.join(",\n")
    );
    deliver(&text, options.destination.output.as_deref())
}
