use std::ffi::OsString;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use luthier_cost::{Compiled, FOREIGN_VARIABLES, Family, Kernel};
use luthier_lut::{MaterialEntry, ShadingModel};
use luthier_material::{Material, ModelSetting};
use luthier_shader::{Form, MaterialSet, TableFace};

use crate::bake_files::{GENERATOR, material_entries};
use crate::cli::CostOptions;
use crate::cost_page::{CostReport, CostRow, FamilyCost};
use crate::failure::{Failure, Outcome, files};
use crate::materials::{read, read_image, valid};
use crate::output::print;

/// The hidden verb of [`probe`].
const PROBE: &str = "cost-probe";

/// Folders where drivers of Vulkan register themselves.
const DRIVER_FOLDERS: [&str; 4] =
    ["/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d", "/usr/local/etc/vulkan/icd.d"];

/// Compiles shaders for GPUs that are not here, and prints what they cost.
pub(crate) fn run(options: &CostOptions) -> Outcome {
    let materials = valid(read(&options.sources.paths)?, true)?;
    let variants = variants(options, &materials)?;
    let mut kernels = vec![Kernel::empty().map_err(Failure::input)?];
    kernels.extend(variants.iter().map(|v| v.kernel.clone()));
    if options.assembly {
        return match (kernels.as_slice(), options.family.as_slice()) {
            ([_, kernel], [family]) => print(&started(family.0, true, std::slice::from_ref(kernel))?),
            _ => Err(Failure::Usage(anyhow::anyhow!(
                "--assembly prints one kernel: name one material, --model, --form and --family"
            ))),
        };
    }
    let mut report =
        CostReport { generator: GENERATOR.to_owned(), driver: String::new(), families: Vec::new(), rows: Vec::new() };
    let families: Vec<Family> =
        if options.family.is_empty() { Family::ALL.to_vec() } else { options.family.iter().map(|f| f.0).collect() };
    for family in families {
        let answer = started(family, false, &kernels)?;
        let compiled: Compiled = serde_json::from_str(&answer).map_err(Failure::input)?;
        let [harness, counts @ ..] = compiled.counts.as_slice() else {
            return Err(Failure::Device(anyhow::anyhow!("the probe gave no counts")));
        };
        report.driver = compiled.driver;
        report.families.push(FamilyCost {
            family,
            chip: family.chip().to_owned(),
            device: compiled.device,
            harness: *harness,
        });
        report.rows.extend(variants.iter().zip(counts).map(|(variant, counts)| CostRow {
            material: variant.material.clone(),
            model: variant.model,
            form: variant.form.name().to_owned(),
            family,
            counts: counts.beyond(harness),
        }));
    }
    let text = if options.json {
        format!("{:#}\n", serde_json::to_value(&report).map_err(Failure::input)?)
    } else {
        report.to_markdown(&command(options))
    };
    match &options.output {
        Some(path) => std::fs::write(path, text).map_err(files(path, "write")),
        None => print(&text),
    }
}

/// One shader to compile.
struct Variant {
    material: String,
    model: ShadingModel,
    form: Form,
    kernel: Kernel,
}

/// Every material (or all as one set) in every model and form asked for.
fn variants(options: &CostOptions, materials: &[Material]) -> Outcome<Vec<Variant>> {
    let models: Vec<ShadingModel> = if options.model.is_empty() {
        ShadingModel::ALL.to_vec()
    } else {
        options.model.iter().filter_map(|setting| ShadingModel::from_name(setting.name())).collect()
    };
    let forms: Vec<Form> =
        if options.form.is_empty() { Form::ALL.to_vec() } else { options.form.iter().map(|&f| f.into()).collect() };
    let mut variants = Vec::new();
    for model in models {
        let mut shaded = materials.to_vec();
        for material in &mut shaded {
            material.bake.model = ModelSetting::from_name(model.name());
        }
        let groups: Vec<(String, &[Material])> = if options.set {
            vec![(format!("set of {}", shaded.len()), shaded.as_slice())]
        } else {
            shaded.iter().map(|m| (m.name.clone(), std::slice::from_ref(m))).collect()
        };
        for (name, group) in groups {
            let (entries, tables) = outline(group)?;
            let set = MaterialSet { materials: &entries, tables };
            for &form in &forms {
                let kernel = Kernel::of_set(&set, form).map_err(Failure::input)?;
                variants.push(Variant { material: name.clone(), model, form, kernel });
            }
        }
    }
    Ok(variants)
}

/// What a bake of these materials would look like.
fn outline(materials: &[Material]) -> Outcome<(Vec<MaterialEntry>, Vec<TableFace>)> {
    let outline = luthier_bake::outline(materials, &read_image).map_err(Failure::input)?;
    let entries = material_entries(materials, &outline.materials, &mut Vec::new())?;
    let tables = outline.tables.into_iter().map(|(kind, layout, format)| TableFace { kind, layout, format }).collect();
    Ok((entries, tables))
}

/// Runs [`probe`] in a process of its own: the driver reads its family from the environment when it is loaded.
fn started(family: Family, assembly: bool, kernels: &[Kernel]) -> Outcome<String> {
    let lost =
        |what: &str, source: std::io::Error| Failure::Device(anyhow::Error::new(source).context(what.to_owned()));
    let program = std::env::current_exe().map_err(|source| lost("cannot find this program", source))?;
    let mut command = Command::new(program);
    command.arg(PROBE).args(assembly.then_some("--assembly")).envs(family.environment());
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
pub(crate) fn probe(assembly: bool) -> Outcome {
    let kernels: Vec<Kernel> = serde_json::from_reader(std::io::stdin().lock()).map_err(Failure::input)?;
    let device = |source: luthier_cost::CostError| Failure::Device(source.into());
    if assembly {
        let texts: Vec<String> =
            kernels.iter().map(luthier_cost::assembly).collect::<Result<_, _>>().map_err(device)?;
        return print(&texts.join("\n"));
    }
    let compiled = luthier_cost::compile(&kernels).map_err(device)?;
    print(&serde_json::to_string(&compiled).map_err(Failure::input)?)
}

/// The command line that makes the page.
fn command(options: &CostOptions) -> String {
    let mut words = vec!["luthier cost".to_owned()];
    words.extend(options.sources.paths.iter().map(|path| path.display().to_string()));
    words.extend(options.model.iter().map(|model| format!("--model {}", model.name())));
    words.extend(options.form.iter().map(|&form| format!("--form {}", Form::from(form).name())));
    words.extend(options.family.iter().map(|family| format!("--family {}", family.0)));
    words.extend(options.set.then(|| "--set".to_owned()));
    words.extend(options.output.iter().map(|path| format!("-o {}", path.display())));
    words.join(" ")
}
