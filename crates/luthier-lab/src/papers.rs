//! Table 1 of Elek 2010 and section 3.4.2 of the course of Weidlich and Wilkie 2009, with today's compilers and chips.

use std::fmt::Write as _;

use luthier::{Bake, MemoryStore, outline, read_materials};
use luthier_bake::Options;
use luthier_cost::{CostReport, Counts, Family, Harness, Kernel, Style, compile_apart};
use luthier_export::{GENERATOR, Package, Shader};
use luthier_gpu::Gpu;
use luthier_lut::TexelFormat;
use luthier_manifest::{ColorMode, Manifest, ShadingModel};
use luthier_material::{FresnelMapping, FresnelSettings, Material};
use luthier_report::{FLOOR, Pair, ParitySet};
use luthier_shader::{Form, MaterialSet};
use luthier_terminal::{Failure, Outcome, deliver, valid};

use crate::cli::{PapersOptions, call};

/// Materials of two layers: a coat over a metal, and a coat over a diffuse base. If there are none, the first material of two layers is taken.
const MATERIALS: [&str; 2] = ["car-paint", "red-lacquer"];

/// The goal: shares of the form `full` and of Phong's model in inverse throughput, at this error.
const GOAL: (f64, f64, f64) = (0.40, 1.5, 0.01);

/// Counts the shaders of the papers, as a page.
pub(crate) fn run(options: &PapersOptions) -> Outcome {
    let materials = valid(read_materials(&options.sources.paths)?, true)?;
    let cases = of_tables(&materials)?.into_iter().map(case).collect::<Outcome<Vec<PaperCase>>>()?;
    let kernels =
        [Harness::Bare, Harness::NormalMapped].into_iter().map(|to| Kernel::empty(to).map_err(Failure::input));
    let mut kernels = kernels.collect::<Outcome<Vec<Kernel>>>()?;
    kernels.extend(cases.iter().flat_map(|case| &case.variants).flat_map(|variant| variant.kernels.clone()));
    let families: &[Family] = if options.family.is_empty() { &Family::ALL } else { &options.family };
    let mut report = CostReport { generator: GENERATOR.to_owned(), ..CostReport::default() };
    let mut counts = Vec::new();
    for &family in families {
        let compiled = compile_apart(family, &kernels).map_err(Failure::device)?;
        let [bare, framed, others @ ..] = compiled.counts.as_slice() else {
            return Err(Failure::Device(anyhow::anyhow!("the probe gave no counts")));
        };
        report.add_family(family, &compiled, *bare);
        counts.push((family, *bare, *framed, others.to_vec()));
    }
    let mut page = report.introduction("The papers' own costs", &command(options));
    page.push('\n');
    tables(&mut page, &cases, &counts);
    deliver(&page, options.destination.output.as_deref())
}

/// One material in all variants of the tables.
struct PaperCase {
    material: String,
    variants: Vec<PaperVariant>,
}

/// One row of the page: a variant of the tables.
struct PaperVariant {
    name: &'static str,
    role: Role,
    constant: bool,
    /// Largest error against the form `full`; `None` for another model, or without a device.
    error: Option<f64>,
    /// Kernels in the bare harness, and with a normal map and an environment.
    kernels: [Kernel; 2],
}

/// Variant of a shader in the tables.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    Full,
    Approximate,
    Tables,
    FresnelTable,
    Phong,
}

pub(crate) const ROLES: [(&str, Role); 5] = [
    ("full", Role::Full),
    ("full, approximated Fresnel", Role::Approximate),
    ("precomputed F and D", Role::Tables),
    ("precomputed F, closed D", Role::FresnelTable),
    ("Phong", Role::Phong),
];

/// The materials of the tables among those at hand.
pub(crate) fn of_tables(materials: &[Material]) -> Outcome<Vec<&Material>> {
    let named: Vec<&Material> =
        MATERIALS.iter().filter_map(|name| materials.iter().find(|m| m.name == *name)).collect();
    let chosen: Vec<&Material> =
        if named.is_empty() { materials.iter().filter(|m| m.stack.layers.len() == 2).take(1).collect() } else { named };
    if chosen.is_empty() {
        let text = "none of the materials has two layers, as those of the papers have";
        return Err(Failure::Input(anyhow::anyhow!(text)));
    }
    Ok(chosen)
}

/// A material with the settings of the papers' tables, by Elek's model and by Phong's.
pub(crate) fn of_models(material: &Material) -> [Material; 2] {
    [ShadingModel::Elek, ShadingModel::Phong].map(|model| {
        let mut material = material.clone();
        material.bake.model = Some(model);
        // Both forms must have the same colour.
        material.bake.color = Some(ColorMode::ThreeWavelengths);
        // Elek's tables (section 3.1): rows over the cosine, D over an angle and the slope parameter.
        material.bake.fresnel = FresnelSettings {
            size: Some(128),
            format: Some(TexelFormat::Rgba16Float),
            mapping: Some(FresnelMapping::Cosine),
        };
        material.bake.distribution.size = Some([512, 512]);
        material
    })
}

/// The shader of a row of the tables, from the materials of a manifest, and its style.
pub(crate) fn shader(manifest: &Manifest, role: Role, constant: bool) -> (MaterialSet<'_>, Style) {
    let set = MaterialSet::from_manifest(manifest);
    let set = if role == Role::FresnelTable { set.with_closed_distribution() } else { set };
    let form = if matches!(role, Role::Tables | Role::FresnelTable) { Form::Baked } else { Form::Full };
    (set, Style { form, constant, approximate: role == Role::Approximate })
}

fn case(material: &Material) -> Outcome<PaperCase> {
    let [elek, phong] = of_models(material);
    let [of_elek, of_phong] = [&elek, &phong]
        .map(|material| outline(std::slice::from_ref(material), &Options::default(), &MemoryStore::default()));
    let (of_elek, of_phong) = (of_elek?, of_phong?);
    let mut variants = Vec::new();
    let mut texts = Vec::new();
    for constant in [false, true] {
        for (name, role) in ROLES {
            let manifest = if role == Role::Phong { &of_phong } else { &of_elek };
            let (set, style) = shader(manifest, role, constant);
            let [bare, mapped] = [Harness::Bare, Harness::NormalMapped]
                .map(|harness| Kernel::of_set(&set, style, harness).map_err(Failure::input));
            let kernels = [bare?, mapped?];
            texts.push(luthier_cost::shader_text(&set, style).map_err(Failure::input)?);
            variants.push(PaperVariant { name, role, constant, error: None, kernels });
        }
    }
    let errors = errors(&elek, &texts)?;
    for (variant, error) in variants.iter_mut().zip(errors) {
        variant.error =
            error.filter(|_| !matches!(variant.role, Role::Phong) && (variant.role != Role::Full || variant.constant));
    }
    Ok(PaperCase { material: material.name.clone(), variants })
}

/// Pairs of directions in each of the sets that errors are found on.
const PAIRS: u32 = 20_000;

/// The largest error of each shader against the first, on the device at hand: relative to the brightest channel, or to
/// [`FLOOR`] where that is darker. Nothing where there is no device.
fn errors(material: &Material, texts: &[String]) -> Outcome<Vec<Option<f64>>> {
    let Ok(gpu) = Gpu::open() else { return Ok(vec![None; texts.len()]) };
    let mut package = Bake::lit().package(std::slice::from_ref(material), &MemoryStore::default())?;
    // Phong's shader would read another buffer.
    let pairs: Vec<Pair> = ParitySet::ALL
        .iter()
        .flat_map(|set| set.pairs(PAIRS, &luthier_layers::layers::Layers::isotropic_rgb(&material.stack).layers))
        .collect();
    let exact = values(&gpu, &mut package, &texts[0], &pairs)?;
    let mut errors = Vec::with_capacity(texts.len());
    for text in texts {
        errors.push(if text.contains("fn luthier_eval_elek") {
            let found = values(&gpu, &mut package, text, &pairs)?;
            let errors = found.iter().zip(&exact).map(|(found, exact)| {
                let scale = exact.iter().fold(FLOOR, |scale, &channel| scale.max(f64::from(channel)));
                let apart = found.iter().zip(exact).map(|(a, b)| (f64::from(*a) - f64::from(*b)).abs());
                apart.fold(0.0, f64::max) / scale
            });
            Some(errors.fold(0.0, f64::max))
        } else {
            None
        });
    }
    Ok(errors)
}

fn values(gpu: &Gpu, package: &mut Package, text: &str, pairs: &[Pair]) -> Outcome<Vec<[f32; 3]>> {
    package.shaders = vec![Shader::wgsl(Form::Baked, text.to_owned())];
    Ok(gpu.scene(package, Form::Baked)?.evaluate(0, pairs)?)
}

/// Text on the figures above, from the machine code.
const WHY: &str = "
**Where the cycles go, and which goals can be reached**

- A look-up of D costs more than computing D. The coordinate of the table is an eighth root of an angle, which takes an arc tangent, three roots and two \
quotients. Beckmann's closed form takes one exponential and one quotient, has no error and needs no texels. Elek's table pays on chips with slow \
exponentials, and the chips of this page have fast ones. `luthier shader --closed` emits the closed form.
- The table of F pays for metals, because it replaces complex roots at three wavelengths. A clear coat over a diffuse base has a single Fresnel term. \
If its index is a constant, the compiler reduces that term to little more than the cost of the fetch, and the share of *full* approaches 1.
- An interface has more than Fresnel and D: the half vector, the masking, a quotient by both cosines and, for the layers below, two refracted cosines and \
three exponentials of the absorption. The model `microfacet`, which has one interface and no other layer, takes about 1.5 times the cycles of Phong \
(`docs/pages/cost.md`). So a shader that evaluates two interfaces cannot stay below 1.5 of Phong by itself. It can if the normal map and the environment \
are counted for both shaders, as the papers did. By itself it would need one lobe that is fitted to the stack.
- The code that both forms share hides part of the savings of tables, and is therefore kept short. 1 / alpha^2, the peak of D, 1 / eta and the like are in the \
material buffer, half vectors are not normalised, whole numbers need no conversion, and a position in an atlas takes one product and one sum.
- Constants save cycles in a form that computes with numbers of the material, above all in Fresnel terms. With tables they save next to nothing, because \
a number from the buffer costs no instruction either. Some rows have a higher inverse throughput with constants: the compiler removes a branch, and with it the \
discount that its model gives to the code in a branch.
";

/// A count that is compared between variants.
struct Measure {
    title: &'static str,
    /// Kernel of a variant.
    kernel: usize,
    count: fn(&Counts) -> i64,
    /// Whether the harness is subtracted.
    net: bool,
}

const MEASURES: [Measure; 3] = [
    Measure { title: "Inverse throughput of the evaluation", kernel: 0, count: |c| c.inverse_throughput, net: true },
    Measure { title: "Issue of the evaluation", kernel: 0, count: |c| c.issue_cycles, net: true },
    Measure {
        title: "Inverse throughput with a normal map and a reflected environment, harness included",
        kernel: 1,
        count: |c| c.inverse_throughput,
        net: false,
    },
];

/// Counts of one family: the two harnesses, and all kernels of all cases in order.
type FamilyCounts = (Family, Counts, Counts, Vec<Counts>);

/// The tables of this run, with those of the papers.
fn tables(out: &mut String, cases: &[PaperCase], counts: &[FamilyCounts]) {
    out.push_str(
        "\n## Elek's Table 1 and section 3.4.2 of the course\n\n\
         Elek 2010 and Weidlich and Wilkie 2009 give cycles of a GeForce 8800 GTX by NVIDIA's FX Composer, for whole pixel shaders with a \
         normal map and a reflected environment.\n\n\
         | paper | full | approximated Fresnel | precomputed | Phong | precomputed over full | over Phong | error |\n\
         |---|--:|--:|--:|--:|--:|--:|--:|\n\
         | Elek, Table 1: tables of F and D | 436 | – | 236 | 104 | 0.54 | 2.27 | 6 % |\n\
         | course, 3.4.2: table of F, Blinn-Phong | 479 | 268 | 195 | 83 | 0.41 | 2.35 | – |\n\n\
         The tables below are for the model `elek` of luthier. Each cell has the cycles of a shader and, in brackets, their ratios to the cycles of *full* and of \
         *Phong* of the same kind (with or without constants). The error is the largest error of f cos theta_i against *full* over the five sets of directions of \
         `docs/pages/parity.md`, on the graphics adapter of this machine. It is relative to the brightest channel, or to 0.1/pi where that is larger. The approximated \
         Fresnel term is Schlick's, with the reflectance of the complex index at normal incidence (Elek's listing). *Precomputed* reads Fresnel rows of 128 half floats \
         over the cosine and a table of D of 512 x 512 texels, which are Elek's sizes.\n",
    );
    let mut offset = 0;
    for case in cases {
        let here = offset;
        offset += 2 * case.variants.len();
        for measure in &MEASURES {
            let _ = write!(out, "\n**{}**, {}\n\n| shader |", case.material, measure.title);
            for (family, ..) in counts {
                let _ = write!(out, " {family} |");
            }
            out.push_str(" error |\n|---|");
            out.push_str(&"--:|".repeat(counts.len() + 1));
            out.push('\n');
            for (i, variant) in case.variants.iter().enumerate() {
                let numbers = if variant.constant { ", constants" } else { "" };
                let _ = write!(out, "| {}{numbers} |", variant.name);
                for family in counts {
                    let [full, phong] =
                        [Role::Full, Role::Phong].map(|role| ratio(measure, family, here, [i, partner(case, i, role)]));
                    let _ = write!(out, " {} ({full:.2}, {phong:.2}) |", cost(measure, family, here, i));
                }
                let error = variant.error.map_or_else(|| "–".to_owned(), |error| format!("{error:.1e}"));
                let _ = writeln!(out, " {error} |");
            }
        }
        verdict(out, case, here, counts);
    }
    out.push_str(WHY);
}

/// The command line that makes the page.
fn command(options: &PapersOptions) -> String {
    let mut words = vec![call("papers", &options.sources.paths)];
    words.extend(options.family.iter().map(|family| format!("--family {family}")));
    words.extend(options.destination.output.iter().map(|path| format!("-o {}", path.display())));
    words.join(" ")
}

/// The variant of a role with the same kind of constants.
fn partner(case: &PaperCase, i: usize, role: Role) -> usize {
    let constant = case.variants[i].constant;
    case.variants.iter().position(|v| v.role == role && v.constant == constant).unwrap_or(i)
}

fn cost(measure: &Measure, (_, bare, framed, kernels): &FamilyCounts, first: usize, i: usize) -> i64 {
    let harness = if measure.kernel == 0 { bare } else { framed };
    let all = (measure.count)(&kernels[first + 2 * i + measure.kernel]);
    if measure.net { all - (measure.count)(harness) } else { all }
}

/// The ratio of the costs of two variants.
fn ratio(measure: &Measure, family: &FamilyCounts, first: usize, pair: [usize; 2]) -> f64 {
    let [own, other] = pair.map(|i| cost(measure, family, first, i) as f64);
    own / other
}

/// Compares the costs and errors with the goal.
fn verdict(out: &mut String, case: &PaperCase, first: usize, counts: &[FamilyCounts]) {
    let (of_full, of_phong, error) = GOAL;
    let _ = writeln!(
        out,
        "\nGoal: the precomputed form takes at most {of_full:.2} of the inverse throughput of *full* and {of_phong} of that of *Phong*, with an error of at most {:.0} %. Ratios are the largest over the instruction sets.",
        100.0 * error
    );
    for (i, variant) in case.variants.iter().enumerate() {
        if !matches!(variant.role, Role::Tables | Role::FresnelTable) {
            continue;
        }
        let numbers = if variant.constant { ", constants" } else { "" };
        let most = |measure: &Measure, other: usize| {
            counts.iter().map(|family| ratio(measure, family, first, [i, other])).fold(0.0, f64::max)
        };
        let [own_full, own_phong] = [Role::Full, Role::Phong].map(|role| partner(case, i, role));
        let [full, phong, default] = [own_full, own_phong, 0].map(|other| most(&MEASURES[0], other));
        let framed = most(&MEASURES[2], own_phong);
        let [of_own_full, of_default, of_own_phong, of_framed] =
            [full <= of_full, default <= of_full, phong <= of_phong, framed <= of_phong].map(says);
        let exact = match variant.error {
            Some(found) => format!("error {found:.1e}: {}", says(found <= error)),
            None => "error not measured".to_owned(),
        };
        let _ = writeln!(
            out,
            "- {}{numbers}: {full:.2} of its full form: {of_own_full}; {default:.2} of the full form that reads a buffer: {of_default}; \
             {phong:.2} of Phong: {of_own_phong}; {framed:.2} of Phong with normal map and environment: {of_framed}; {exact}.",
            variant.name,
        );
    }
}

fn says(holds: bool) -> &'static str {
    if holds { "reached" } else { "missed" }
}
