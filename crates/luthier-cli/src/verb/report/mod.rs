//! `report`: a bake judged, as JSON, as Markdown and as a page.

mod evidence;
mod memory;
#[cfg(feature = "gpu")]
mod pictures;
mod scene;
#[cfg(feature = "gpu")]
mod times;

use std::path::Path;

use luthier::Source;
use luthier_export::{Folder, GENERATOR, REPORT_FILES, label, origin, publish_beside, shared};
use luthier_manifest::Manifest;
use luthier_material::{Material, Parsed, VariationSource};
use luthier_report::{
    Asked, Device, Exhibits, FileBudget, FilmMap, FilmSource, Report, Settings, Subject, SurfaceMap, judge, limits,
};
use luthier_scene::{LeaveOut, simplified};
use luthier_terminal::{Bar, Failure, Outcome, counted, print};

use crate::cli::ReportOptions;
use crate::interrupt::whole;
use crate::materials::is_baked_as;
use crate::store::store;

/// Judges a bake and writes the report beside it.
pub(crate) fn run(options: &ReportOptions) -> Outcome {
    if let Some(scene) = &options.scene {
        return scene::run(scene, options);
    }
    // No bake is published while files of this one are read.
    let lock = shared(&options.out);
    let folder = Folder::open(&options.out)?;
    let manifest = folder.manifest();
    let textures = folder.textures()?;
    let maps = maps(&folder)?;
    let materials = materials(manifest, &options.out)?;
    let given = evidence::given(options)?;
    let device = device(&folder, options)?;
    drop(lock);
    let stacks = materials.iter().map(|m| m.reflecting_stack().into_owned()).collect();
    let subject = Subject { manifest, textures, stacks, maps, films: films(&materials)? };
    let bar = Bar::new("judging");
    let judgements = memory::Judgements(store()?);
    let settings = Settings {
        memory: Some(&judgements),
        pairs_per_set: options.pairs,
        budget: options.max_error,
        provenance: provenance(&folder, options, &given),
        progress: Some(&|p| bar.set(p.done, p.total)),
        ..Settings::default()
    };
    let judging = device.as_ref().map(|d| d as &dyn Device);
    let mut report = judge(&subject, judging, &settings).map_err(Failure::input)?;
    drop(bar);
    for material in &mut report.materials {
        // Reports name files by their paths from the current folder.
        material.source = label(&origin(&options.out, &material.source));
    }

    evidence::add(&mut report, &given, options, manifest, &materials)?;
    #[cfg(feature = "gpu")]
    if options.times {
        report.times = device.as_ref().map(|shaders| times::measure(shaders, &subject)).transpose()?;
    }
    let pictures = pictures(&mut report, device.as_ref(), &subject, options)?;
    let budgets: Vec<FileBudget> =
        (0..).zip(&materials).map(|(material, m)| FileBudget { material, budget: m.budget }).collect();
    report.limits = limits(&report, &budgets, &asked(options));
    let exhibits = Exhibits { pictures, stability: given.stability, gallery: options.gallery.clone() };

    let json = report.to_json().map_err(Failure::input)?;
    let contents = [json.clone(), report.to_markdown(), report.to_html(&exhibits)];
    let written: Vec<(&str, &[u8])> = REPORT_FILES.into_iter().zip(contents.iter().map(String::as_bytes)).collect();
    whole(&options.out, || publish_beside(&options.out, folder.sha256(), &written))?;

    print(&if options.json { json } else { text(&report, &options.out) })?;
    if report.is_within_budget() == Some(false) { Err(Failure::Verdict) } else { Ok(()) }
}

/// The maps that ship.
fn maps(folder: &Folder) -> Outcome<Vec<SurfaceMap>> {
    let materials = (0..).zip(&folder.manifest().materials);
    let all = materials.flat_map(|(material, entry)| entry.maps.iter().map(move |map| (material, map)));
    all.map(|(material, map)| {
        let (_, picture) = folder.map(map)?;
        Ok(SurfaceMap { material, slot: map.slot, layer: map.layer, picture })
    })
    .collect()
}

/// The maps of films that vary, read again from the material files.
fn films(materials: &[Material]) -> Outcome<Vec<FilmMap>> {
    let layers = (0..)
        .zip(materials)
        .flat_map(|(number, m)| (0..).zip(&m.layers).map(move |(layer, extras)| (number, m, layer, extras)));
    let varying =
        layers.filter_map(|(number, m, layer, extras)| Some((number, m, layer, extras.film_variation.as_ref()?)));
    varying
        .map(|(material, m, layer, variation)| {
            let source = match &variation.source {
                VariationSource::Noise { seed, frequency, octaves } => {
                    FilmSource::Noise { seed: *seed, frequency: *frequency, octaves: *octaves }
                }
                VariationSource::Image(picture) => {
                    let image = luthier::read_image(&m.source, picture);
                    FilmSource::Image(
                        image.map_err(|reason| Failure::Input(anyhow::anyhow!("{}: {reason}", picture.path)))?,
                    )
                }
            };
            Ok(FilmMap { material, layer, source, extent_um: variation.extent_um })
        })
        .collect()
}

/// Facts that identify the run.
fn provenance(folder: &Folder, options: &ReportOptions, given: &evidence::Given) -> Vec<(String, String)> {
    let mut out = vec![
        ("judged by".to_owned(), GENERATOR.to_owned()),
        ("command".to_owned(), command(options)),
        ("bake".to_owned(), options.out.display().to_string()),
        ("manifest SHA-256".to_owned(), folder.sha256().to_owned()),
    ];
    out.extend(given.files.iter().cloned());
    out
}

/// The command line that makes the report.
fn command(options: &ReportOptions) -> String {
    let mut words = vec![format!("luthier report --out {} --pairs {}", options.out.display(), options.pairs)];
    words.extend(options.max_error.map(|limit| format!("--max-error {limit:e}")));
    words.extend(options.max_abs.map(|limit| format!("--max-abs {limit:e}")));
    words.extend(options.max_delta_e.map(|limit| format!("--max-delta-e {limit:e}")));
    words.extend(options.max_bytes.map(|limit| format!("--max-bytes {limit}")));
    words.extend(options.max_lobe.map(|limit| format!("--max-lobe {limit:e}")));
    words.extend(options.reference.map(|paths| format!("--reference={paths}")));
    words.extend(options.cost.as_ref().map(|path| format!("--cost {}", path.display())));
    words.extend(options.stability.as_ref().map(|path| format!("--stability {}", path.display())));
    words.extend(options.gallery.as_ref().map(|gallery| format!("--gallery {gallery}")));
    words.extend(options.no_device.then(|| "--no-device".to_owned()));
    #[cfg(feature = "gpu")]
    {
        words.extend(options.max_flip.map(|limit| format!("--max-flip {limit:e}")));
        words.extend(options.adapter.as_ref().map(|adapter| format!("--adapter {adapter}")));
        words.push(format!("--picture-size {}", options.picture_size));
        words.extend(options.times.then(|| "--times".to_owned()));
    }
    words.join(" ")
}

fn asked(options: &ReportOptions) -> Asked {
    Asked {
        max_abs: options.max_abs,
        delta_e: options.max_delta_e,
        max_bytes: options.max_bytes,
        lobe: options.max_lobe,
        #[cfg(feature = "gpu")]
        flip: options.max_flip,
        #[cfg(not(feature = "gpu"))]
        flip: None,
    }
}

/// The materials of a bake, read again from their files, so that the judge does not rely on the baker.
fn materials(manifest: &Manifest, folder: &Path) -> Outcome<Vec<Material>> {
    manifest
        .materials
        .iter()
        .enumerate()
        .map(|(number, entry)| {
            let file = origin(folder, &entry.source);
            let source = Source::read(&file).map_err(|error| match Failure::from(error) {
                Failure::Files(error) => Failure::Files(error.context(format!(
                    "the bake was made from {}, which the judge reads again; run the report where the bake ran",
                    file.display()
                ))),
                other => other,
            })?;
            let Ok(Parsed { mut material, .. }) = source.parsed else {
                return Err(changed(&file));
            };
            if !is_baked_as(&mut material, entry)? {
                return Err(changed(&file));
            }
            // The choice of a scene may leave out parts of a material; its tables then describe the rest.
            let choice = manifest.choice.as_ref().and_then(|choice| choice.materials.get(number));
            let left_out =
                choice.and_then(|c| c.tried.get(c.chosen)).map(|c| c.left_out.as_slice()).unwrap_or_default();
            let parts: Option<Vec<LeaveOut>> = left_out.iter().map(|name| LeaveOut::from_name(name)).collect();
            parts.and_then(|parts| simplified(&material, &parts)).ok_or_else(|| changed(&file))
        })
        .collect()
}

fn changed(file: &Path) -> Failure {
    let file = file.display();
    let text = format!("{file} has changed since it was baked, or a file that it names; bake again");
    Failure::Input(anyhow::anyhow!(text))
}

#[cfg(feature = "gpu")]
type Runner = luthier_terminal::Shaders;

/// Stands in for a device in a build without the feature `gpu`.
#[cfg(not(feature = "gpu"))]
type Runner = NoShaders;

#[cfg(feature = "gpu")]
fn device(folder: &Folder, options: &ReportOptions) -> Outcome<Option<Runner>> {
    use luthier_terminal::{Shaders, open};

    if options.no_device {
        return Ok(None);
    }
    let package = folder.package()?;
    let gpu = open(options.adapter.as_deref()).map_err(|failure| match failure {
        Failure::Device(error) => {
            Failure::Device(anyhow::anyhow!("{error}; --no-device judges the tables without a driver"))
        }
        other => other,
    })?;
    Ok(Some(Shaders::new(&gpu, &package)?))
}

#[cfg(feature = "gpu")]
use pictures::pictures;

#[cfg(not(feature = "gpu"))]
enum NoShaders {}

#[cfg(not(feature = "gpu"))]
impl Device for NoShaders {
    fn name(&self) -> String {
        match *self {}
    }

    fn identity(&self) -> String {
        match *self {}
    }

    fn evaluate(&self, _: luthier_report::Form, _: u32, _: &[luthier_report::Pair]) -> Result<Vec<[f32; 3]>, String> {
        match *self {}
    }

    fn evaluate_at(
        &self,
        _: luthier_report::Form,
        _: u32,
        _: &[(luthier_manifest::PlaceValues, luthier_report::Pair)],
    ) -> Result<Vec<[f32; 3]>, String> {
        match *self {}
    }
}

#[cfg(not(feature = "gpu"))]
fn device(_: &Folder, options: &ReportOptions) -> Outcome<Option<Runner>> {
    if options.no_device {
        return Ok(None);
    }
    let text = "this luthier was built without the feature `gpu` and cannot run shaders; judge the tables alone with --no-device";
    Err(Failure::device(anyhow::anyhow!(text)))
}

#[cfg(not(feature = "gpu"))]
fn pictures(
    _: &mut Report,
    _: Option<&Runner>,
    _: &Subject<'_>,
    _: &ReportOptions,
) -> Outcome<Vec<Vec<luthier_report::Exhibit>>> {
    Ok(Vec::new())
}

fn text(report: &Report, folder: &Path) -> String {
    let mut out = format!(
        "{} judged{}\n",
        counted(report.materials.len(), "material"),
        report.device.as_ref().map_or_else(|| ", tables only".to_owned(), |name| format!(" on {name}")),
    );
    out.push_str(&format!("largest relative error: {:.2e}\n", report.max_error()));
    if let Some(arithmetic) = report.max_arithmetic_error() {
        out.push_str(&format!("largest error of f32 arithmetic: {arithmetic:.2e}\n"));
    }
    if let Some(budget) = report.budget {
        let is_held = report.max_error() <= budget;
        out.push_str(&format!("budget {budget:e}: {}\n", verdict(is_held)));
    }
    for limit in &report.limits {
        let found = limit.found.map_or_else(|| "not measured".to_owned(), |found| format!("{found:.2e}"));
        out.push_str(&format!(
            "{}, limit {:e} of {}: {found}, {}\n",
            limit.quantity,
            limit.limit,
            limit.stated_by,
            verdict(limit.is_held)
        ));
    }
    let [_, summary, page] = REPORT_FILES.map(|file| folder.join(file).display().to_string());
    out.push_str(&format!("wrote {page} and {summary}\n"));
    out
}

fn verdict(is_held: bool) -> &'static str {
    if is_held { "held" } else { "exceeded" }
}
