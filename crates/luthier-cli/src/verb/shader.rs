//! `shader`: the shader of some materials, without a bake.

use std::path::Path;

use luthier::{Files, Functions, outline, row_layout};
use luthier_bake::Options;
use luthier_shader::{MaterialSet, Target, complete, complete_spirv, emit, emit_constant, emit_spirv};
use luthier_terminal::{Failure, Outcome, STDOUT, files, print_bytes};

use crate::cli::ShaderOptions;
use crate::materials::{bakeable_with_surfaces, refuse_environment, shows_environment};
use crate::store::store;

/// Prints or writes the shader of some materials, without baking them.
pub(crate) fn run(options: &ShaderOptions) -> Outcome {
    if let Some(path) = &options.output {
        refuse_ending(path, options.target)?;
    }
    let found = Files::read(&options.sources.paths)?;
    let (materials, surfaces) = bakeable_with_surfaces(found, &options.shading.in_forms(&[options.form]), false)?;
    let is_shown = materials.iter().any(|material| shows_environment(material, &[options.form]));
    refuse_environment(&options.functions, is_shown)?;
    let functions: Functions = options.functions.iter().copied().collect();
    let layout = options.layout.or_else(|| row_layout(&functions, &[options.target]));
    let mut manifest = outline(&materials, &Options { layout, ..Options::default() }, store()?)?;
    manifest.surfaces = surfaces;
    manifest.functions = functions;
    let set = MaterialSet { names: options.names.names(), ..MaterialSet::from_manifest(&manifest) };
    let set = if options.closed { set.with_closed_distribution() } else { set };
    let (form, target) = (options.form, options.target);
    let bytes = match (target, options.complete) {
        (Target::SpirV, true) => complete_spirv(&set, form),
        (Target::SpirV, false) if options.constant => {
            return Err(Failure::Usage(anyhow::anyhow!("--constant is for languages of text: compile the WGSL")));
        }
        (_, _) if options.constant => emit_constant(&set, form, target).map(String::into_bytes),
        (Target::SpirV, false) => emit_spirv(&set, form),
        (_, true) => complete(&set, form, target).map(String::into_bytes),
        (_, false) => emit(&set, form, target).map(String::into_bytes),
    };
    let bytes = bytes.map_err(Failure::input)?;
    match options.output.as_deref().filter(|path| *path != Path::new(STDOUT)) {
        Some(path) => std::fs::write(path, bytes).map_err(files(path, "write")),
        None => print_bytes(&bytes, target != Target::SpirV),
    }
}

/// Refuses a file whose ending belongs to another language. Endings of no language are accepted.
fn refuse_ending(path: &Path, target: Target) -> Outcome {
    let name = path.to_string_lossy().to_lowercase();
    let fitting = Target::ALL.into_iter().filter(|target| name.ends_with(&format!(".{}", target.extension())));
    let fitting: Vec<Target> = fitting.collect();
    // Both kinds of GLSL are found in files that end in .glsl alone.
    let other = fitting.first().copied().filter(|_| !fitting.contains(&target));
    let is_glsl = name.ends_with(".glsl") && !target.extension().ends_with("glsl");
    let Some(other) = other.map(Target::name).or(is_glsl.then_some("glsl450 or glsl-es300")) else { return Ok(()) };
    Err(Failure::Usage(anyhow::anyhow!(
        "{}: the ending is not that of {}, the language of --target: write --target {other}, or another ending",
        path.display(),
        target.name()
    )))
}
