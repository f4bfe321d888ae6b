//! `compare`: two pictures by two shaders, and how far they are apart.

use std::path::Path;

use luthier_export::Package;
use luthier_gpu::{GpuError, ToneMapping};
use luthier_lut::Image;
use luthier_manifest::{Form, ShadingModel};
use luthier_report::{PIXELS_PER_DEGREE, PictureComparison, brightened_difference, compare_pictures};
use luthier_terminal::{Failure, Outcome, files, open, print};
use serde_json::{Value, json};

use crate::cli::{CompareOptions, ShaderChoice, Shading, ShapeName};
use crate::memory_bake;
use crate::picture::{Format, settings};

/// Directions of the environment where none are asked for.
pub(crate) const ENVIRONMENT_SAMPLES: u32 = 64;

/// Renders a material with two shaders, under the same light with the same samples.
pub(crate) fn run(options: &CompareOptions) -> Outcome {
    if options.shape == ShapeName::Grid {
        return Err(Failure::Input(anyhow::anyhow!("a comparison is of one material; the grid has 25 of its own")));
    }
    let [a, b] = [&options.a, &options.b].map(|choice| Subject::of(options, choice));
    let (a, b) = (a?, b?);
    let look = &options.look;
    let mut settings = settings(look, options.shape, options.mesh.as_deref(), options.size)?;
    settings.environment_samples = look.environment_samples.unwrap_or(ENVIRONMENT_SAMPLES);
    let gpu = open(look.adapter.as_deref())?;
    let render = |subject: &Subject| -> Result<Image, GpuError> {
        gpu.scene(&subject.package, subject.form)?.render(&[subject.material], &settings)
    };
    let a = render(&a)?;
    let b = render(&b)?;

    let tone = ToneMapping::from(look.tone);
    let compared = compare_pictures(&a, &b, |v| tone.value(v)).map_err(Failure::input)?;
    let (difference, gain) = brightened_difference(&a, &b, |v| tone.value(v));
    std::fs::create_dir_all(&options.output).map_err(files(&options.output, "make"))?;
    let pictures = [
        ("a.png", a, tone),
        ("b.png", b, tone),
        ("difference.png", difference, ToneMapping::None),
        ("flip.png", compared.flip.clone(), ToneMapping::None),
    ];
    for (name, image, tone) in pictures {
        Format::Png.write(&options.output.join(name), image, tone)?;
    }
    if options.json {
        return print(&format!("{:#}", json(options, &compared, gain)));
    }
    let PictureComparison { rms_err, max_abs_err, flip_mean, flip_max, .. } = compared;
    print(&format!(
        "a {}, b {}: {} pixels square\n\
         rmse {rms_err:.3e}, largest difference {max_abs_err:.3e} (linear radiance)\n\
         flip {flip_mean:.4} mean, {flip_max:.4} largest ({PIXELS_PER_DEGREE:.2} pixels per degree)\n\
         wrote a.png, b.png, difference.png (times {gain}), flip.png to {}",
        options.a,
        options.b,
        options.size,
        options.output.display(),
    ))
}

/// One side of the comparison.
struct Subject {
    package: Package,
    material: u32,
    form: Form,
}

impl Subject {
    fn of(options: &CompareOptions, choice: &ShaderChoice) -> Outcome<Self> {
        let is_file = Path::new(&options.material).extension().is_some_and(|e| e == "toml");
        if choice.model.is_some() && !is_file {
            return Err(Failure::Input(anyhow::anyhow!(
                "the bake has its models already; name a .toml file to choose one"
            )));
        }
        if options.no_fit && choice.model == Some(ShadingModel::Lobes) {
            return Err(Failure::Usage(anyhow::anyhow!("the model `lobes` is fitted: leave out --no-fit")));
        }
        let shading = Shading { model: choice.model, no_fit: options.no_fit, ..Shading::default() };
        // Both sides have the material's model, if neither names another: one that both forms have.
        let own = [&options.a, &options.b].into_iter().filter(|choice| choice.model.is_none());
        let forms: Vec<Form> = own.map(|choice| choice.form).collect();
        let (package, material) = memory_bake::find(&options.material, &shading, &forms, &options.out)?;
        package.wgsl(choice.form)?;
        Ok(Self { package, material, form: choice.form })
    }
}

fn json(options: &CompareOptions, compared: &PictureComparison, gain: u32) -> Value {
    json!({
        "material": options.material,
        "a": options.a.to_string(),
        "b": options.b.to_string(),
        "size": options.size,
        "rms_err": compared.rms_err,
        "max_abs_err": compared.max_abs_err,
        "flip_mean": compared.flip_mean,
        "flip_max": compared.flip_max,
        "flip_pixels_per_degree": PIXELS_PER_DEGREE,
        "difference_gain": gain,
    })
}
