//! Pictures of every material with both shaders.

use luthier_bake::Function;
use luthier_gpu::{RenderSettings, Shape, ToneMapping};
use luthier_lut::Image;
use luthier_report::{
    Exhibit, Form, PictureErrors, Report, Subject, brightened_difference, compare_pictures, contents,
    picture_color_difference,
};
use luthier_terminal::{Bar, Failure, Outcome, Shaders};
use luthier_texture::png;
use serde_json::json;

use crate::cli::ReportOptions;
use crate::store::store;

/// The pictures of a material in the store. Raise the revision when the renderer draws other ones.
const PICTURES: Function = Function { kind: "picture", revision: 1 };

/// The errors of the pictures, and the pictures with their captions.
type Drawn = (Option<PictureErrors>, Vec<(String, Vec<u8>)>);

/// Directions of the environment for each lobe and sample. Blurred maps are no choice, because the form `full` has no tables of albedos.
const ENVIRONMENT_SAMPLES: u32 = 16;

/// Samples along each side of a pixel.
const SAMPLES: u32 = 2;

/// Renders every material with both shaders, compares them, and puts the figures into the report. A material without the form `full` has a picture
/// of the form `baked` alone.
pub(super) fn pictures(
    report: &mut Report,
    shaders: Option<&Shaders>,
    subject: &Subject<'_>,
    options: &ReportOptions,
) -> Outcome<Vec<Vec<Exhibit>>> {
    let shaders = shaders.filter(|_| options.picture_size > 0);
    let Some(shaders) = shaders else { return Ok(Vec::new()) };
    let (contents, store) = (contents(subject, shaders), store()?);
    let Some(baked) = shaders.scene(Form::Baked) else { return Ok(Vec::new()) };
    let full = shaders.scene(Form::Full);
    let settings = RenderSettings {
        size: options.picture_size,
        samples: SAMPLES,
        environment_samples: ENVIRONMENT_SAMPLES,
        ..RenderSettings::new(Shape::Sphere)?
    };
    let tone = ToneMapping::default();
    let bar = Bar::new("pictures");
    let count = report.materials.len() as u64;
    let mut out = Vec::new();
    for ((number, material), content) in (0_u32..).zip(&mut report.materials).zip(contents) {
        bar.set(u64::from(number) + 1, count);
        let inputs = json!({ "content": content, "maps": subject.manifest.materials[number as usize].maps, "size": settings.size });
        if let Some((errors, pngs)) = PICTURES.recall::<Drawn>(&inputs, store) {
            material.picture = errors;
            out.push(pngs.into_iter().map(|(caption, png)| Exhibit { caption, png }).collect());
            continue;
        }
        let baked = baked.render(&[number], &settings)?;
        let has_full = subject.manifest.materials[number as usize].model.has(Form::Full);
        let exhibits = if let Some(full) = full.filter(|_| has_full) {
            let full = full.render(&[number], &settings)?;
            let compared = compare_pictures(&baked, &full, |v| tone.value(v)).map_err(Failure::input)?;
            let [delta_e_mean, delta_e_max] = picture_color_difference(&baked, &full, |v| tone.value(v));
            let (apart, gain) = brightened_difference(&baked, &full, |v| tone.value(v));
            material.picture = Some(PictureErrors {
                size: settings.size,
                rms_err: compared.rms_err,
                max_abs_err: compared.max_abs_err,
                flip_mean: compared.flip_mean,
                flip_max: compared.flip_max,
                delta_e_mean,
                delta_e_max,
                gain,
            });
            vec![
                exhibit("full", full, tone)?,
                exhibit("baked", baked, tone)?,
                exhibit(&format!("difference × {gain}"), apart, ToneMapping::None)?,
                exhibit(&format!("FLIP, mean {:.4}", compared.flip_mean), compared.flip, ToneMapping::None)?,
            ]
        } else {
            vec![exhibit("baked", baked, tone)?]
        };
        let pngs = exhibits.iter().map(|exhibit| (exhibit.caption.clone(), exhibit.png.clone())).collect();
        PICTURES.keep::<Drawn>(&inputs, store, (material.picture.clone(), pngs));
        out.push(exhibits);
    }
    Ok(out)
}

fn exhibit(caption: &str, image: Image, tone: ToneMapping) -> Outcome<Exhibit> {
    let png = png::encode_image(&tone.image(image)).map_err(Failure::input)?;
    Ok(Exhibit { caption: caption.to_owned(), png })
}
