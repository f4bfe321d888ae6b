//! Errors for pictures that cannot be used, and doubts about pictures that are probably not meant so.

use luthier_lut::Picture;
use luthier_material::{Diagnostic, Material, NamedImage, PictureRef, Severity, TexelUse};

use crate::pictures::{self, Read};

/// Diagnostics of the pictures that a material names.
///
/// ```
/// let text = "schema = 1\nname = \"oak\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\nmaps = { albedo = \"grain.png\" }\n";
/// let oak = luthier::parse("oak.toml", text)?;
/// let errors = luthier::refusals::of_pictures(&oak);
/// assert!(errors[0].is_error() && errors[0].line == 6, "there is no grain.png");
/// # Ok::<(), luthier::Error>(())
/// ```
pub fn of_pictures(material: &Material) -> Vec<Diagnostic> {
    material.images().iter().flat_map(|image| told(material, image)).collect()
}

/// Diagnostics of a picture that a material names: an error if it cannot be used, else doubts.
fn told(material: &Material, image: &NamedImage<'_>) -> Vec<Diagnostic> {
    let NamedImage { key, picture, texels } = image;
    let path = &picture.path;
    match pictures::read(&material.source, picture, *texels) {
        Ok(read) => {
            let warnings = doubts(&read, picture, *texels).into_iter().map(|(sentence, hint)| {
                material.diagnostic(Severity::Warning, key, format!("the map `{path}`: {sentence}"), Some(hint))
            });
            warnings.collect()
        }
        Err(reason) => {
            let hint = "name a PNG, JPEG or WebP file by its path relative to the material file".to_owned();
            let message = format!("cannot use the map `{path}`: {reason}");
            vec![material.diagnostic(Severity::Error, key, message, Some(hint))]
        }
    }
}

/// Most texels that are examined. Of larger pictures, every n-th row and column is.
const SEEN_MAX: usize = 1 << 20;

/// Share of normals pointing into the surface above which the map is doubted: a few may be accidents.
const INWARD: f64 = 0.01;

/// Cosine of the largest lean of the mean normal, 30 degrees. The mean normal of a height field that repeats does not lean.
const UPRIGHT: f64 = 0.866;

/// Ratio of the errors of a height field, as it is to green turned over, above which the map is doubted.
const FLIPPED: f64 = 4.0;

/// A sentence and a hint for each doubt.
fn doubts(read: &Read, asked: &PictureRef, texels: TexelUse) -> Vec<(String, String)> {
    let mut found = Vec::new();
    match texels {
        TexelUse::Number if asked.channel.is_none() && has_colours(&read.decoded.picture) => found.push((
            "it has colours, and this is one number: its red channel is taken".to_owned(),
            format!("say which: `{{ image = \"{}\", channel = \"g\" }}`", asked.path),
        )),
        TexelUse::Color if asked.srgb.is_none() && read.decoded.says_srgb => found.push((
            "it is read as linear, and says that its colours are stored by the sRGB curve".to_owned(),
            format!("write `{{ image = \"{0}\", srgb = true }}`, or `srgb = false` where it is linear", asked.path),
        )),
        TexelUse::Normal => found.extend(Normals::of(&read.picture).doubt()),
        _ => {}
    }
    found
}

fn has_colours(picture: &Picture) -> bool {
    picture.channels >= 3 && picture.texels().any(|[r, g, b, _]| r != g || g != b)
}

/// Statistics of a map of normals.
struct Normals {
    count: f64,
    inward: f64,
    grey: f64,
    /// Sum of the unit normals.
    sum: [f64; 3],
    /// Squared curl of the slopes, which is 0 for a height field: with green as it is, and turned over.
    curl: [f64; 2],
}

impl Normals {
    fn of(picture: &Picture) -> Self {
        let [width, height] = picture.size();
        let step = (1..).find(|step| picture.texel_count() / (step * step) <= SEEN_MAX).unwrap_or(1) as u32;
        let mut all = Self { count: 0.0, inward: 0.0, grey: 0.0, sum: [0.0; 3], curl: [0.0; 2] };
        for y in (0..height).step_by(step as usize) {
            for x in (0..width).step_by(step as usize) {
                let here = normal(picture, x, y);
                let length = here.iter().map(|v| v * v).sum::<f64>().sqrt().max(1e-6);
                all.count += 1.0;
                all.inward += f64::from(here[2] <= 0.0);
                all.grey += f64::from(here[0] == here[1] && here[1] == here[2]);
                all.sum = [0, 1, 2].map(|c| all.sum[c] + here[c] / length);
                // Heights rise by -x/z to the right, and by y/z downwards where green is up.
                let slopes = [normal(picture, x + 1, y), normal(picture, x, y + 1), here];
                let [[_, down], [right, _], [here_right, here_down]] =
                    slopes.map(|[x, y, z]| [-x / z.max(0.1), y / z.max(0.1)]);
                let (across, along) = (right - here_right, down - here_down);
                let (up, down) = (across - along, across + along);
                all.curl = [all.curl[0] + up * up, all.curl[1] + down * down];
            }
        }
        all
    }

    fn doubt(&self) -> Option<(String, String)> {
        let length = self.sum.iter().map(|v| v * v).sum::<f64>().sqrt();
        let [a, b] = self.curl.map(|squares| (squares / self.count).sqrt());
        if self.grey > 0.99 * self.count && self.sum[2] < 0.999 * self.count {
            let hint = "it may hold heights: make normals of them, (2 RGB - 1) is a unit vector with blue up";
            return Some(("it is grey, as no map of normals is".to_owned(), hint.to_owned()));
        }
        if self.inward > INWARD * self.count {
            let hint =
                "blue must be above 0.5; of maps with two channels (BC5) it has to be computed, as sqrt(1 - x^2 - y^2)";
            let percent = (100.0 * self.inward / self.count).round();
            return Some((format!("{percent} % of its normals point into the surface"), hint.to_owned()));
        }
        if self.sum[2] < UPRIGHT * length {
            let lean = libm::acos(self.sum[2] / length).to_degrees().round();
            let hint = "a map of normals in the tangent space is blue on the whole";
            return Some((format!("its mean normal leans by {lean} degrees"), hint.to_owned()));
        }
        if a > FLIPPED * b && a > 0.02 {
            let hint = "it may be made for DirectX: turn its green channel over";
            return Some(("its bumps fit together only with green turned over".to_owned(), hint.to_owned()));
        }
        None
    }
}

/// The normal of a texel, not of unit length. The map repeats beyond its border.
fn normal(picture: &Picture, x: u32, y: u32) -> [f64; 3] {
    let [width, height] = picture.size();
    let [r, g, b, _] = picture.texel(x % width, y % height);
    [r, g, b].map(|v| 2.0 * f64::from(v) - 1.0)
}

#[cfg(test)]
mod tests {
    use luthier_lut::{Image, Picture};

    use super::*;

    /// Normals of h = .02 sin(2 pi (u + 2 v)) on 64 texels, row 0 at the top; `green` is 1 where green is up.
    fn waves(green: f64) -> Picture {
        let mut image = Image::zeros(64, 64, 3);
        for (x, y) in (0..64u32).flat_map(|y| (0..64).map(move |x| (x, y))) {
            let phase = std::f64::consts::TAU * (f64::from(x) + 2.0 * f64::from(y)) / 64.0;
            let slope = 0.3 * libm::cos(phase);
            let normal = [-slope, green * 2.0 * slope, 1.0];
            let length = normal.iter().map(|v| v * v).sum::<f64>().sqrt();
            image.texel_mut(x, y).copy_from_slice(&normal.map(|v| (0.5 + 0.5 * v / length) as f32));
        }
        image.into()
    }

    fn doubt(picture: &Picture) -> Option<String> {
        Normals::of(picture).doubt().map(|(sentence, _)| sentence)
    }

    #[test]
    fn usual_maps_of_normals_are_not_doubted() {
        assert_eq!(doubt(&waves(1.0)), None);
        let flat = Image { width: 1, height: 1, channels: 3, data: vec![128.0 / 255.0, 128.0 / 255.0, 1.0] };
        assert_eq!(doubt(&flat.into()), None);
    }

    #[test]
    fn unlikely_maps_of_normals_are_told() {
        assert!(doubt(&waves(-1.0)).unwrap().contains("green"));
        let uniform = |rgb: [f32; 3]| Picture::from(Image { width: 1, height: 1, channels: 3, data: rgb.to_vec() });
        assert!(doubt(&uniform([0.5, 0.6, 0.0])).unwrap().contains("100 % of its normals point into"));
        assert!(doubt(&uniform([0.0; 3])).unwrap().contains("grey"));
        assert!(doubt(&uniform([0.7; 3])).unwrap().contains("grey"));
        assert!(doubt(&uniform([0.9, 0.5, 0.8])).unwrap().contains("leans by 53 degrees"));
    }
}
