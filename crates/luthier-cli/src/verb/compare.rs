//! `compare`: two pictures by two shaders, and how far they are apart.

use std::path::Path;

use luthier_export::Package;
use luthier_gpu::{Gpu, RenderSettings, Shown, ToneMapping};
use luthier_manifest::{Form, ShadingModel};
use luthier_report::{PIXELS_PER_DEGREE, PictureComparison, brightened_difference, compare_pictures};
use luthier_terminal::{Failure, Outcome, files, open, print};
use serde_json::{Value, json};

use crate::cli::{CompareOptions, Shading, ShapeName, Side};
use crate::memory_bake;
use crate::picture::{Format, settings};
use crate::simulated::{self, Picture};

/// Directions of the environment where none are asked for.
pub(crate) const ENVIRONMENT_SAMPLES: u32 = 64;

/// Renders a material with two shaders, under the same light with the same samples.
pub(crate) fn run(options: &CompareOptions) -> Outcome {
    if options.shape == ShapeName::Grid {
        return Err(Failure::Input(anyhow::anyhow!("a comparison is of one material; the grid has 25 of its own")));
    }
    let look = &options.look;
    // Before the bake, which is for nothing where no driver is there.
    let gpu = open(look.adapter.as_deref())?;
    let [a, b] = [&options.a, &options.b].map(|side| Subject::of(options, side));
    let (a, b) = (a?, b?);
    let mut settings = settings(look, options.shape, options.mesh.as_deref(), options.size)?;
    settings.environment_samples = look.environment_samples.unwrap_or(ENVIRONMENT_SAMPLES);
    let Picture { image: a, noise: noise_a } = a.render(&gpu, &settings)?;
    let Picture { image: b, noise: noise_b } = b.render(&gpu, &settings)?;
    let noise = libm::hypot(noise_a, noise_b);

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
        return print(&format!("{:#}", json(options, &compared, gain, noise)));
    }
    let of_which = if noise > 0.0 { format!(", of which noise {noise:.3e}") } else { String::new() };
    let PictureComparison { rms_err, max_abs_err, flip_mean, flip_max, .. } = compared;
    print(&format!(
        "a {}, b {}: {} pixels square\n\
         rmse {rms_err:.3e}{of_which}, largest difference {max_abs_err:.3e} (linear radiance)\n\
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
    way: Way,
}

/// How a picture comes about.
enum Way {
    Shader(Form),
    /// With so many samples of each pixel.
    Simulated(u32),
}

impl Subject {
    fn render(&self, gpu: &Gpu, settings: &RenderSettings) -> Outcome<Picture> {
        let Self { package, material, way } = self;
        match *way {
            Way::Shader(form) => {
                let image = gpu.scene(package, form)?.render(&[*material], settings)?;
                Ok(Picture { image, noise: 0.0 })
            }
            Way::Simulated(samples) => {
                simulated::picture(gpu, package, &[Shown::Material(*material)], settings, samples, |_| Ok(()))
            }
        }
    }

    fn of(options: &CompareOptions, side: &Side) -> Outcome<Self> {
        let choice = match side {
            Side::Shader(choice) => choice,
            Side::Simulated(samples) => {
                let (package, material) = simulated::find(&options.material, &options.out)?;
                return Ok(Self { package, material, way: Way::Simulated(*samples) });
            }
        };
        let is_file = Path::new(&options.material).extension().is_some_and(|e| e == "toml");
        if choice.model.is_some() && !is_file {
            return Err(Failure::Input(anyhow::anyhow!(
                "the bake has its models already; name a .toml file to choose one"
            )));
        }
        if options.no_fit && choice.model.is_some_and(ShadingModel::is_fitted) {
            return Err(Failure::Usage(anyhow::anyhow!("the model `lobes` is fitted: leave out --no-fit")));
        }
        let shading = Shading { model: choice.model, no_fit: options.no_fit, ..Shading::default() };
        // If neither side names a model, both have the material's: one with both forms.
        let sides = [&options.a, &options.b].into_iter().filter_map(Side::shader);
        let own = sides.filter(|choice| choice.model.is_none());
        let forms: Vec<Form> = own.map(|choice| choice.form).collect();
        let (package, material) = memory_bake::find(&options.material, &shading, &forms, &options.out)?;
        package.wgsl(choice.form)?;
        Ok(Self { package, material, way: Way::Shader(choice.form) })
    }
}

fn json(options: &CompareOptions, compared: &PictureComparison, gain: u32, noise: f64) -> Value {
    let mut json = json!({
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
    });
    if noise > 0.0 {
        json["noise"] = noise.into();
    }
    json
}
