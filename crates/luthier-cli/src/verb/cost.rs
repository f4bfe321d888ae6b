use std::ffi::OsString;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use luthier_bake::Options;
use luthier_cost::{Compiled, FOREIGN_VARIABLES, Family, Harness, Kernel, Style};
use luthier_export::{GENERATOR, outline, read};
use luthier_lut::TableKind;
use luthier_manifest::ShadingModel;
use luthier_material::Material;
use luthier_shader::{Form, MaterialSet};

use crate::cli::CostOptions;
use crate::cost_page::{CostReport, CostRow, FamilyCost, reads_d};
use crate::cost_papers;
use crate::failure::{Failure, Outcome, files};
use crate::materials::valid;
use crate::output::print;

/// The hidden verb of [`probe`].
const PROBE: &str = "cost-probe";

/// Folders where drivers of Vulkan register themselves.
const DRIVER_FOLDERS: [&str; 4] =
    ["/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d", "/usr/local/etc/vulkan/icd.d"];

/// Compiles shaders for GPUs that are not here, and prints what they cost.
pub(crate) fn run(options: &CostOptions) -> Outcome {
    let materials = valid(read(&options.sources.paths)?, true)?;
    if options.shapes {
        return shapes(options, &materials);
    }
    let variants = variants(options, &materials)?;
    if options.assembly {
        return match (variants.as_slice(), options.family.as_slice()) {
            ([variant], [family]) => print(&started(family.0, true, std::slice::from_ref(&variant.kernel))?),
            _ => Err(Failure::Usage(anyhow::anyhow!(
                "--assembly prints one kernel, not {}: name one material, --model, --form, --closed, --constant and --family",
                variants.len()
            ))),
        };
    }
    let papers = if options.json { Vec::new() } else { cost_papers::cases(&materials)? };
    let mut kernels = vec![empty(Harness::Bare)?, empty(Harness::NormalMapped)?];
    kernels.extend(variants.iter().map(|v| v.kernel.clone()));
    kernels.extend(papers.iter().flat_map(|case| case.variants.iter()).flat_map(|v| v.kernels.clone()));
    let families: Vec<Family> =
        if options.family.is_empty() { Family::ALL.to_vec() } else { options.family.iter().map(|f| f.0).collect() };
    let mut report = CostReport { generator: GENERATOR.to_owned(), ..CostReport::default() };
    let mut paper_counts = Vec::new();
    for family in families {
        let compiled: Compiled = serde_json::from_str(&started(family, false, &kernels)?).map_err(Failure::input)?;
        let [harness, framed, counts @ ..] = compiled.counts.as_slice() else {
            return Err(Failure::Device(anyhow::anyhow!("the probe gave no counts")));
        };
        let (own, others) = counts.split_at(variants.len());
        report.driver = compiled.driver;
        report.families.push(FamilyCost {
            family,
            chip: family.chip().to_owned(),
            device: compiled.device,
            harness: *harness,
        });
        report.rows.extend(variants.iter().zip(own).map(|(variant, counts)| CostRow {
            material: variant.material.clone(),
            model: variant.model,
            form: variant.style.form.name().to_owned(),
            closed: variant.closed,
            constant: variant.style.constant,
            family,
            counts: counts.beyond(harness),
        }));
        paper_counts.push((family, *harness, *framed, others.to_vec()));
    }
    let text = if options.json {
        report.to_json().map_err(Failure::input)?
    } else {
        let papers = cost_papers::to_markdown(&papers, &paper_counts);
        report.to_markdown(&command(options), &papers)
    };
    match &options.output {
        Some(path) => std::fs::write(path, text).map_err(files(path, "write")),
        None => print(&text),
    }
}

/// Costs of every shape that the materials have, whole or without some of their parts: what scenes choose by.
fn shapes(options: &CostOptions, materials: &[Material]) -> Outcome {
    let family = Family::Rdna2;
    let simpler = || materials.iter().flat_map(luthier_scene::variants).map(|(_, material)| material);
    let mut keys: Vec<(ShadingModel, luthier_scene::Form, String)> = Vec::new();
    let mut kernels = vec![empty(Harness::Bare)?];
    for model in ShadingModel::ALL {
        for mut material in simpler() {
            material.bake.model = Some(model);
            let shape = luthier_scene::shape_of(model, &luthier_scene::shape(&material.stack));
            // What is no matter of shape, and what would make two materials of one shape differ.
            material.effects = Default::default();
            material.bake.distribution = Default::default();
            if keys.iter().any(|(known, _, s)| (*known, s) == (model, &shape)) {
                continue;
            }
            let manifest = outline(std::slice::from_ref(&material), &Options::default())?;
            let set = MaterialSet::from_manifest(&manifest);
            for (form, key) in [(Form::Baked, luthier_scene::Form::Baked), (Form::Full, luthier_scene::Form::Full)] {
                let style = Style { form, constant: false, approximate: false };
                kernels.push(Kernel::of_set(&set, style, Harness::Bare).map_err(Failure::input)?);
                keys.push((model, key, shape.clone()));
            }
        }
    }
    let compiled: Compiled = serde_json::from_str(&started(family, false, &kernels)?).map_err(Failure::input)?;
    let [harness, counts @ ..] = compiled.counts.as_slice() else {
        return Err(Failure::Device(anyhow::anyhow!("the probe gave no counts")));
    };
    let mut rows: Vec<String> = Vec::new();
    keys.iter().zip(counts).for_each(|((model, form, shape), counts)| {
        let (model, form, cycles) = (model.name(), form.name(), counts.beyond(harness).inverse_throughput);
        rows.push(format!(r#"    {{"model":"{model}","form":"{form}","shape":"{shape}","cycles":{cycles}}}"#));
    });
    let text = format!(
        "{{\n  \"driver\": {},\n  \"family\": \"{}\",\n  \"rows\": [\n{}\n  ]\n}}\n",
        serde_json::json!(compiled.driver),
        family.name(),
        rows.join(",\n")
    );
    match &options.output {
        Some(path) => std::fs::write(path, text).map_err(files(path, "write")),
        None => print(&text),
    }
}

fn empty(harness: Harness) -> Outcome<Kernel> {
    Kernel::empty(harness).map_err(Failure::input)
}

/// One shader to compile.
struct Variant {
    material: String,
    model: ShadingModel,
    style: Style,
    /// Whether D is a closed form.
    closed: bool,
    kernel: Kernel,
}

/// Every material (or all as one set) in every model, form and style asked for.
fn variants(options: &CostOptions, materials: &[Material]) -> Outcome<Vec<Variant>> {
    let models: Vec<ShadingModel> =
        if options.model.is_empty() { ShadingModel::ALL.to_vec() } else { options.model.clone() };
    let forms: Vec<Form> = if options.form.is_empty() { Form::ALL.to_vec() } else { options.form.clone() };
    let mut variants = Vec::new();
    for model in models {
        let mut shaded = materials.to_vec();
        for material in &mut shaded {
            material.bake.model = Some(model);
        }
        let groups: Vec<(String, &[Material])> = if options.set {
            vec![(format!("set of {}", shaded.len()), shaded.as_slice())]
        } else {
            shaded.iter().map(|m| (m.name.clone(), std::slice::from_ref(m))).collect()
        };
        for (name, group) in groups {
            let manifest = outline(group, &Options::default())?;
            for &form in &forms {
                for (closed, constant) in styles(options) {
                    // What reads no table of D has it in closed form, or has none, either way.
                    let has_d = manifest.table(TableKind::Distribution).is_some();
                    let has_table = form == Form::Baked && reads_d(model) && has_d;
                    if closed && !has_table && !options.closed {
                        continue;
                    }
                    let set = without_d(MaterialSet::from_manifest(&manifest), closed);
                    let style = Style { form, constant, approximate: false };
                    let kernel = Kernel::of_set(&set, style, Harness::Bare).map_err(Failure::input)?;
                    let closed = closed || !has_table;
                    variants.push(Variant { material: name.clone(), model, style, closed, kernel });
                }
            }
        }
    }
    Ok(variants)
}

/// Whether D is a closed form, and whether the material is constants.
fn styles(options: &CostOptions) -> Vec<(bool, bool)> {
    let all = [(false, false), (true, false), (false, true), (true, true)];
    let wanted = |&(closed, constant): &(bool, bool)| {
        (closed || !options.closed) && (constant || !options.constant) && !(constant && options.set)
    };
    // One kernel was asked for where its machine code is.
    let exact = |style: &(bool, bool)| !options.assembly || *style == (options.closed, options.constant);
    all.into_iter().filter(wanted).filter(exact).collect()
}

/// The set, without a table of D where this is a closed form.
pub(crate) fn without_d(mut set: MaterialSet<'_>, closed: bool) -> MaterialSet<'_> {
    set.tables.retain(|table| !(closed && table.kind == TableKind::Distribution));
    set
}

/// Runs [`probe`] in a process of its own: the driver reads its family from the environment when it is loaded.
fn started(family: Family, assembly: bool, kernels: &[Kernel]) -> Outcome<String> {
    let lost =
        |what: &str, source: std::io::Error| Failure::Device(anyhow::Error::new(source).context(what.to_owned()));
    let program = std::env::current_exe().map_err(|source| lost("cannot find this program", source))?;
    let mut command = Command::new(program);
    command.args([PROBE, family.name()]).args(assembly.then_some("--assembly")).envs(family.environment());
    for variable in FOREIGN_VARIABLES {
        command.env_remove(variable);
    }
    if let Some(drivers) = drivers() {
        command.env("VK_DRIVER_FILES", &drivers).env("VK_ICD_FILENAMES", &drivers);
    }
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(|source| lost("cannot start the probe", source))?;
    let input = serde_json::to_vec(kernels).map_err(Failure::input)?;
    if let Some(mut stdin) = child.stdin.take() {
        // A probe that ended early says why by itself.
        let _ = stdin.write_all(&input);
    }
    let output = child.wait_with_output().map_err(|source| lost("cannot wait for the probe", source))?;
    let words = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if output.status.success() {
        return Ok(words(&output.stdout));
    }
    let said = words(&output.stderr);
    let error = said.lines().find_map(|line| line.strip_prefix("error: "));
    let text =
        error.map_or_else(|| format!("the probe of {family} ended with {}: {said}", output.status), str::to_owned);
    Err(Failure::Device(anyhow::anyhow!(text)))
}

/// The descriptions of RADV, for the loader to load nothing else; `None` leaves the choice to the user's own variables.
fn drivers() -> Option<OsString> {
    if ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].iter().any(|name| std::env::var_os(name).is_some()) {
        return None;
    }
    let is_radv = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        name.starts_with("radeon_icd") && name.ends_with(".json")
    };
    let in_folder = |folder: &str| {
        let entries = std::fs::read_dir(Path::new(folder)).into_iter().flatten().flatten();
        let mut found: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(is_radv).collect();
        found.sort();
        found
    };
    let found: Vec<PathBuf> = DRIVER_FOLDERS.into_iter().flat_map(in_folder).collect();
    if found.is_empty() { None } else { std::env::join_paths(found).ok() }
}

/// Reads kernels from standard input, compiles them on the null device of this process and prints what came of it.
pub(crate) fn probe(family: Family, assembly: bool) -> Outcome {
    let kernels: Vec<Kernel> = serde_json::from_reader(std::io::stdin().lock()).map_err(Failure::input)?;
    let device = |source: luthier_cost::CostError| Failure::Device(source.into());
    if assembly {
        let texts: Vec<String> =
            kernels.iter().map(luthier_cost::assembly).collect::<Result<_, _>>().map_err(device)?;
        return print(&texts.join("\n"));
    }
    let compiled = luthier_cost::compile(family, &kernels).map_err(device)?;
    print(&serde_json::to_string(&compiled).map_err(Failure::input)?)
}

/// The command line that makes the page.
fn command(options: &CostOptions) -> String {
    let mut words = vec!["luthier cost".to_owned()];
    words.extend(options.sources.paths.iter().map(|path| path.display().to_string()));
    words.extend(options.model.iter().map(|model| format!("--model {}", model.name())));
    words.extend(options.form.iter().map(|&form| format!("--form {}", form.name())));
    words.extend(options.family.iter().map(|family| format!("--family {}", family.0)));
    let flags = [("--set", options.set), ("--closed", options.closed), ("--constant", options.constant)];
    words.extend(flags.iter().filter(|(_, is_set)| *is_set).map(|(flag, _)| (*flag).to_owned()));
    words.extend(options.output.iter().map(|path| format!("-o {}", path.display())));
    words.join(" ")
}
