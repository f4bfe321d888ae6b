use std::path::Path;

use luthier_lut::Manifest;
use luthier_material::Parsed;
use luthier_optics::stack::Stack;
use luthier_report::{Device, Report, Settings, Subject, judge};
use luthier_scene::{LeaveOut, simplified};

use crate::artefacts::{manifest, textures};
use crate::bake_files::{GENERATOR, REPORT_FILES, source_hash};
use crate::cli::ReportOptions;
use crate::failure::{Failure, Outcome};
use crate::materials::read_one;
use crate::output::print;
use crate::progress::Bar;
use crate::staging::Staging;

/// Judges a bake and writes report/index.html and report/report.json beside it.
pub(crate) fn run(options: &ReportOptions) -> Outcome {
    let manifest = manifest(&options.out)?;
    let textures = textures(&options.out, &manifest)?;
    let stacks = stacks(&manifest)?;
    let device = device(options)?;
    let subject = Subject { manifest: &manifest, textures, stacks };
    let bar = Bar::new("judging");
    let settings = Settings {
        pairs_per_set: options.pairs,
        budget: options.max_error,
        provenance: vec![
            ("judged by".to_owned(), GENERATOR.to_owned()),
            ("bake".to_owned(), options.out.display().to_string()),
        ],
        progress: Some(&|p| bar.set(p.done, p.total)),
    };
    let report = judge(&subject, device.as_deref(), &settings).map_err(Failure::input)?;
    drop(bar);

    let json = report.to_json().map_err(Failure::input)?;
    let mut staging = Staging::for_folder(&options.out)?;
    let [data, page] = REPORT_FILES;
    staging.write(data, json.as_bytes())?;
    staging.write(page, report.to_html().as_bytes())?;
    staging.publish()?;

    print(&if options.json { json } else { text(&report, &options.out) })?;
    if report.is_within_budget() == Some(false) { Err(Failure::Verdict) } else { Ok(()) }
}

/// The materials of a bake, read again from their files: the judge takes nothing on trust.
fn stacks(manifest: &Manifest) -> Outcome<Vec<Stack>> {
    manifest
        .materials
        .iter()
        .enumerate()
        .map(|(number, entry)| {
            let source = read_one(Path::new(&entry.source)).map_err(|failure| match failure {
                Failure::Files(error) => Failure::Files(error.context(format!(
                    "the bake was made from {}, which the judge reads again; run the report where the bake ran",
                    entry.source
                ))),
                other => other,
            })?;
            let Ok(Parsed { material, .. }) = &source.parsed else {
                return Err(changed(&entry.source));
            };
            if source_hash(material)? != entry.source_hash {
                return Err(changed(&entry.source));
            }
            // A scene may have left out parts of a material: the tables are of what is left.
            let choice = manifest.choice.as_ref().and_then(|choice| choice.materials.get(number));
            let left_out =
                choice.and_then(|c| c.tried.get(c.chosen)).map(|c| c.left_out.as_slice()).unwrap_or_default();
            let parts: Option<Vec<LeaveOut>> = left_out.iter().map(|name| LeaveOut::from_name(name)).collect();
            let rest = parts.and_then(|parts| simplified(material, &parts));
            Ok(rest.ok_or_else(|| changed(&entry.source))?.stack)
        })
        .collect()
}

fn changed(source: &str) -> Failure {
    let text = format!("{source} has changed since it was baked, or a file that it names; bake again");
    Failure::Input(anyhow::anyhow!(text))
}

#[cfg(feature = "gpu")]
fn device(options: &ReportOptions) -> Outcome<Option<Box<dyn Device>>> {
    use crate::device::{Shaders, device, open};
    use luthier_gpu::Artefacts;

    if options.no_device {
        return Ok(None);
    }
    let artefacts = Artefacts::load(&options.out).map_err(device)?;
    let gpu = open(options.adapter.as_deref())?;
    Ok(Some(Box::new(Shaders::new(&gpu, &artefacts)?)))
}

#[cfg(not(feature = "gpu"))]
fn device(options: &ReportOptions) -> Outcome<Option<Box<dyn Device>>> {
    if options.no_device {
        return Ok(None);
    }
    let text = "this luthier was built without the feature `gpu` and cannot run shaders; judge the tables alone with --no-device";
    Err(Failure::Input(anyhow::anyhow!(text)))
}

fn text(report: &Report, folder: &Path) -> String {
    let mut out = format!(
        "{} materials judged{}\n",
        report.materials.len(),
        report.device.as_ref().map_or_else(|| ", tables only".to_owned(), |name| format!(" on {name}")),
    );
    out.push_str(&format!("largest relative error: {:.2e}\n", report.max_error()));
    if let Some(arithmetic) = report.max_arithmetic_error() {
        out.push_str(&format!("of it, arithmetic: {arithmetic:.2e}\n"));
    }
    if let (Some(budget), Some(within)) = (report.budget, report.is_within_budget()) {
        out.push_str(&format!("budget {budget:e}: {}\n", if within { "held" } else { "exceeded" }));
    }
    out.push_str(&format!("wrote {}\n", folder.join(REPORT_FILES[1]).display()));
    out
}
