//! `layouts`: rows of lobes in either layout beside an engine's coat, as counts on chips that are not there and as times by the costs of devices.

use std::fmt::Write as _;

use luthier::{MemoryStore, Options, outline, read_materials};
use luthier_cost::{CostReport, DeviceCost, Family, Harness, Kernel, Style, compile_apart, shader_text};
use luthier_export::GENERATOR;
use luthier_lut::RowLayout;
use luthier_manifest::{BindingEntry, FunctionGroup, Manifest, ShadingModel};
use luthier_material::Material;
use luthier_report::Spread;
use luthier_shader::{Form, MaterialSet, Yardstick, count};
use luthier_terminal::{Failure, Outcome, deliver, valid};

use crate::cli::{LayoutsOptions, call};

/// Lights on a prepared view.
const LIGHTS: [u32; 3] = [1, 4, 16];

/// A shader of a material.
struct Text {
    wgsl: String,
    bound: Vec<BindingEntry>,
    wide: Vec<String>,
}

/// A shader that the page compares.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shader {
    Yardstick(Yardstick),
    Rows(RowLayout),
    /// The filtered rows with arithmetic in place of every read: a bound.
    Unread,
}

const SHADERS: [Shader; 5] = [
    Shader::Yardstick(Yardstick::GltfClearcoat),
    Shader::Yardstick(Yardstick::FilamentClearcoat),
    Shader::Rows(RowLayout::Filtered),
    Shader::Rows(RowLayout::Steps),
    Shader::Unread,
];

impl Shader {
    fn title(self) -> String {
        match self {
            Self::Yardstick(yardstick) => yardstick.name().to_owned(),
            Self::Rows(layout) => format!("lobes, {}", layout.name()),
            Self::Unread => "lobes without reads".to_owned(),
        }
    }
}

/// Counts the shaders of every material and prints a page.
pub(crate) fn run(options: &LayoutsOptions) -> Outcome {
    let materials = valid(read_materials(&options.sources.paths)?, true)?;
    let store = MemoryStore::default();
    let texts = materials.iter().map(|material| texts(material, &store)).collect::<Outcome<Vec<_>>>()?;
    let mut report = CostReport { generator: GENERATOR.to_owned(), ..CostReport::default() };
    let mut tables = Vec::new();
    for family in Family::ALL {
        let mut kernels = vec![Kernel::empty(Harness::Bare).map_err(Failure::input)?];
        for lights in LIGHTS {
            let harness = Harness::Lights(lights);
            kernels.push(Kernel::empty(harness).map_err(Failure::input)?);
            for Text { wgsl, bound, .. } in texts.iter().flatten() {
                kernels.push(Kernel::of_text(wgsl, bound, harness).map_err(Failure::input)?);
            }
        }
        let compiled = compile_apart(family, &kernels).map_err(Failure::device)?;
        report.add_family(family, &compiled, compiled.counts[0]);
        let each = texts.iter().map(Vec::len).sum::<usize>() + 1;
        // Issue cycles of a light, by number of lights, material and shader.
        let cycles = compiled.counts[1..].chunks(each).zip(LIGHTS).map(|(counts, lights)| {
            let net = counts[1..].iter().map(|count| count.issue_cycles - counts[0].issue_cycles);
            let of_light: Vec<f64> = net.map(|cycles| cycles as f64 / f64::from(lights)).collect();
            of_light.chunks(SHADERS.len()).map(<[f64]>::to_vec).collect::<Vec<_>>()
        });
        tables.push((format!("issue cycles on {family}, by the compiler"), cycles.collect::<Vec<_>>()));
    }
    for name in DeviceCost::names() {
        let Some(costs) = DeviceCost::shipped(name).filter(|costs| costs.family.is_none()) else { continue };
        let mut of_lights = Vec::new();
        for lights in LIGHTS {
            let of_text = |text: &Text| {
                let counts = count(&text.wgsl, &text.wide, lights).map_err(Failure::input)?;
                Ok(costs.cost(&counts) / f64::from(lights))
            };
            let of_material = |texts: &Vec<Text>| texts.iter().map(of_text).collect::<Outcome<Vec<f64>>>();
            of_lights.push(texts.iter().map(of_material).collect::<Outcome<Vec<Vec<f64>>>>()?);
        }
        tables.push((format!("predicted {}", costs.label()), of_lights));
    }
    let command = call("layouts", &options.sources.paths);
    let mut page = report.introduction("Layouts of rows, and an engine's coat", &command);
    page.push_str(INTRODUCTION);
    let _ = writeln!(
        page,
        "\nThe materials: {}.",
        materials.iter().map(|m| m.name.as_str()).collect::<Vec<_>>().join(", ")
    );
    for (title, of_lights) in &tables {
        table(&mut page, title, of_lights);
    }
    deliver(&page, options.destination.output.as_deref())
}

const INTRODUCTION: &str = "\n\nThe page compares the two layouts of rows of `lobes` (`--layout`) with the coats of engines, for one light on a view and for several on one that was \
    prepared: a number is that of one light, the median over the materials, and in brackets its median ratio to `gltf-clearcoat` for as many lights. `lobes without reads` has arithmetic in place of every \
    read: no layout is cheaper than it. Yardsticks have no textures. Issue cycles count a read as one instruction, whatever it waits for; predicted times come from costs that were fitted to \
    times of other shaders, and have their errors (`luthier-lab devices`). None of these numbers is a time of the shader itself: `luthier bench` measures those.\n";

/// The shaders of a material, in the order of [`SHADERS`].
fn texts(material: &Material, store: &MemoryStore) -> Outcome<Vec<Text>> {
    SHADERS.into_iter().map(|shader| text(material, shader, store)).collect()
}

fn text(material: &Material, shader: Shader, store: &MemoryStore) -> Outcome<Text> {
    let layout = match shader {
        Shader::Yardstick(yardstick) => {
            return Ok(Text { wgsl: yardstick.wgsl(), bound: vec![Yardstick::binding()], wide: Vec::new() });
        }
        Shader::Rows(layout) => layout,
        Shader::Unread => RowLayout::Filtered,
    };
    let mut material = material.clone();
    material.bake.model = Some(ShadingModel::Lobes);
    let options = Options { layout: Some(layout), ..Options::default() };
    let outlined: Manifest = outline(std::slice::from_ref(&material), &options, store)?;
    let mut set = MaterialSet::from_manifest(&outlined);
    set.functions = [FunctionGroup::Light].into_iter().collect();
    let style = Style { form: Form::Baked, constant: false, approximate: false };
    let mut wgsl = shader_text(&set, style).map_err(Failure::input)?;
    if shader == Shader::Unread {
        wgsl = unread(&wgsl);
    }
    Ok(Text { wgsl, bound: luthier_shader::bindings(&set, Form::Baked), wide: set.wide_textures() })
}

/// The text with the place of a read in place of its value.
fn unread(wgsl: &str) -> String {
    let mut out = wgsl.to_owned();
    for name in ["fresnel", "lobes"] {
        out = out
            .replace(&format!("textureSampleLevel(luthier_{name}, luthier_sampler, position, 0.0)"), "position.xyxy");
    }
    out
}

/// Medians over the materials: a row for each shader, a column for each number of lights.
fn table(page: &mut String, title: &str, of_lights: &[Vec<Vec<f64>>]) {
    let _ = writeln!(
        page,
        "\n## {}{}\n\n| shader | one light | each of 4 | each of 16 |\n|---|--:|--:|--:|",
        title[..1].to_uppercase(),
        &title[1..]
    );
    for (i, shader) in SHADERS.into_iter().enumerate() {
        let _ = write!(page, "| {} |", shader.title());
        for materials in of_lights {
            let values: Vec<f64> = materials.iter().map(|shaders| shaders[i]).collect();
            let ratios: Vec<f64> = materials.iter().map(|shaders| shaders[i] / shaders[0]).collect();
            let _ = write!(page, " {:.1} ({:.2}) |", Spread::of(&values).median, Spread::of(&ratios).median);
        }
        page.push('\n');
    }
}
