//! `parity`: every shader of every material against its f64 twin.

use luthier::{Bake, MemoryStore, of_materials, read_materials};
use luthier_export::{GENERATOR, Package};
use luthier_manifest::ShadingModel;
use luthier_material::Material;
use luthier_optics::stack::{Base, Stack, Surface};
use luthier_report::{POLISHED_ALPHAS, Parity, ParityCase, Share, Subject, Verdict, parity};
use luthier_terminal::{Bar, Failure, Outcome, Shaders, complain, deliver, open, surface_maps, valid};

use crate::cli::{PARITY_PAIRS, ParityOptions, call};

/// Least slope parameter of the polished variants, as in layer records.
const ALPHA_MIN: f64 = luthier_layers::layers::ALPHA_MIN;

/// Compares every shader with its f64 twin.
pub(crate) fn run(options: &ParityOptions) -> Outcome {
    let materials = valid(read_materials(&options.sources.paths)?, true)?;
    let models = models(options);
    let all: Vec<Material> =
        models.iter().flat_map(|model| materials.iter().flat_map(|m| variants(m, *model))).collect();
    let baking = Bar::new("baking");
    // Shaders are compared within the domains of their models and beyond.
    let bake = Bake { refuses: false, ..Bake::wgsl(&[]) };
    let package = bake.package(&all, &MemoryStore::default())?;
    drop(baking);
    let bar = Bar::new("comparing");
    let gpu = open(options.adapter.name.as_deref())?;
    let total = models.len() * materials.len();
    let (mut rows, mut done, mut adapter) = (Vec::new(), 0, String::new());
    let per_model = materials.len() * (1 + POLISHED_ALPHAS.len());
    for (index, _) in models.iter().enumerate() {
        let range = index * per_model..(index + 1) * per_model;
        let stacks = all[range.clone()].iter().map(|m| m.reflecting_stack().into_owned()).collect();
        let package = of_materials(&package, range)?;
        let shaders = Shaders::new(&gpu, &package)?;
        adapter = luthier_report::Device::name(&shaders);
        let cases: Vec<ParityCase> = (0..).zip(&materials).map(|(n, material)| case(n, material)).collect();
        let subject = subject(&package, stacks)?;
        let found = parity(&subject, &shaders, &cases, options.pairs, &mut || {
            done += 1;
            bar.set(done as u64, total as u64);
        });
        rows.extend(found.map_err(Failure::input)?);
    }
    drop(bar);
    let report = Parity::new(GENERATOR, adapter, options.pairs, rows);
    let json = options.format.json.then(|| report.to_json().map_err(Failure::input));
    let text = json.unwrap_or_else(|| Ok(report.to_markdown(&command(options))))?;
    deliver(&text, options.destination.output.as_deref())?;
    for row in report.rows.iter().filter(|row| !row.holds()) {
        let broken = Share::ALL.into_iter().filter(|share| row.verdict(*share) == Verdict::Broken);
        let mut shares: Vec<String> = broken.map(|share| format!("{} {:.2e}", share.name(), row.max(share))).collect();
        let at = row.places.as_ref().filter(|_| !row.holds_at_places()).and_then(|at| at.worst.as_ref());
        shares.extend(at.map(|w| format!("place {} ({}) {:.2e}", w.number, w.place, w.error)));
        complain(&format!(
            "{}, {}, {}: {} not finite; beyond its tolerance: {}",
            row.model.name(),
            row.form,
            row.material,
            row.not_finite,
            shares.join(", ")
        ));
    }
    if report.holds() { Ok(()) } else { Err(Failure::Verdict) }
}

/// The models to compare: all, unless named.
fn models(options: &ParityOptions) -> Vec<ShadingModel> {
    if options.model.is_empty() { ShadingModel::ALL.to_vec() } else { options.model.clone() }
}

/// A material shaded by a model, and its polished variants; names are unique over all models.
fn variants(material: &Material, model: ShadingModel) -> Vec<Material> {
    let mut base = material.clone();
    base.bake.model = Some(model);
    base.name = format!("{}-{}", material.name, model.name());
    let polished = POLISHED_ALPHAS.iter().enumerate().map(|(i, &alpha)| {
        let mut polished = base.clone();
        polish(&mut polished.stack, alpha);
        polished.name = format!("{}-polished-{i}", base.name);
        polished
    });
    std::iter::once(base.clone()).chain(polished).collect()
}

/// Scales all slope parameters alike, so that the largest is `alpha`.
fn polish(stack: &mut Stack, alpha: f64) {
    let interfaces = stack.layers.iter_mut().filter(|layer| !matches!(layer.base, Base::Diffuse(_)));
    let surfaces: Vec<&mut Surface> = interfaces.map(|layer| &mut layer.surface).collect();
    let largest = surfaces.iter().fold(0.0, |largest: f64, s| largest.max(s.alpha_x).max(s.alpha_y));
    let factor = if largest > 0.0 { alpha / largest } else { 1.0 };
    for surface in surfaces {
        for alpha in [&mut surface.alpha_x, &mut surface.alpha_y] {
            *alpha = (*alpha * factor).max(ALPHA_MIN);
        }
    }
}

/// The numbers of the variants of the n-th material.
fn case(n: u32, material: &Material) -> ParityCase {
    let first = n * (1 + POLISHED_ALPHAS.len() as u32);
    ParityCase {
        name: material.name.clone(),
        material: first,
        polished: (1..=POLISHED_ALPHAS.len() as u32).map(|i| first + i).collect(),
    }
}

/// The subject of a judgement: the tables of a package as they ship, and the surfaces that its materials describe.
pub(crate) fn subject(package: &Package, stacks: Vec<Stack>) -> Outcome<Subject<'_>> {
    Ok(Subject {
        manifest: &package.manifest,
        textures: package.textures()?,
        stacks,
        maps: surface_maps(package),
        films: Vec::new(),
    })
}

/// The command line that makes the page.
fn command(options: &ParityOptions) -> String {
    let mut words = vec![call("parity", &options.sources.paths)];
    for model in &options.model {
        words.push(format!("--model {}", model.name()));
    }
    if options.pairs != PARITY_PAIRS {
        words.push(format!("--pairs {}", options.pairs));
    }
    if let Some(path) = &options.destination.output {
        words.push(format!("-o {}", path.display()));
    }
    words.join(" ")
}
