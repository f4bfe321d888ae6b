//! `five-ways`: balls of textured materials, simulated and by four models.

use std::f64::consts::PI;
use std::fmt::Write as _;

use glam::{DVec2, DVec3};
use luthier::{read_materials, read_picture};
use luthier_gpu::ToneMapping;
use luthier_layers::engines::gltf;
use luthier_layers::model::Model;
use luthier_layers::models::lobes::{Family, Lobes, Mix, Paint, Slopes, Varied, Varying, shown};
use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::ColorPaths;
use luthier_layers::registry::model;
use luthier_lut::Image;
use luthier_material::{Material, PictureRef, TexelUse};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::dielectric_albedo::JointMasking;
use luthier_optics::sampling::split_mix::SplitMix64;
use luthier_optics::stack::Stack;
use luthier_report::{compare_pictures, sheet};
use luthier_terminal::{Bar, Failure, Outcome, deliver, files, valid};
use luthier_texture::png;
use rayon::prelude::*;

use crate::cli::FiveWaysOptions;

const WAVELENGTHS_NM: [f64; 3] = [645.0, 525.0, 445.0];

/// Tone curve of the pictures.
const TONE: ToneMapping = ToneMapping::Shoulder;

/// Names of the ways, in the order of the picture.
const WAYS: [&str; 5] = ["simulated", "lobes", "belcour", "elek", "glTF"];

/// Directions that a pixel of a model is a mean of, and paths of a simulated one.
const DIRECTIONS: u32 = 256;
const PATHS: u64 = 2048;

/// A soft light: radiance in the middle, how fast it falls off, direction.
struct Light(f64, f64, DVec3);

/// Lights of the studio: a window from the upper left, one from behind on the right. Radiance falls off as a Gaussian on the sphere.
const LIGHTS: [Light; 2] =
    [Light(14.0, 50.0, DVec3::new(-0.5, 0.62, 0.6)), Light(9.0, 30.0, DVec3::new(0.92, 0.15, -0.1))];

/// Radiance of the studio from a direction.
fn radiance(w: DVec3) -> f64 {
    let sky = 0.25 + 0.35 * w.y.max(0.0);
    let lights = LIGHTS.iter().map(|Light(peak, fall, d)| peak * libm::exp(fall * (w.dot(d.normalize()) - 1.0)));
    sky + lights.sum::<f64>()
}

/// Layers with lobes of their own: all of a material, or those below a coat with a weight.
struct Side {
    stack: Stack,
    family: Family,
    varied: Varied,
}

impl Side {
    fn new(material: &Material) -> Option<Self> {
        let ranges = material.family()?;
        let stack = shown(&material.stack);
        let family = Family::new(&stack, ranges.coat, ranges.base, ranges.is_metallic)?;
        let color = Color::ThreeWavelengths(WAVELENGTHS_NM);
        Some(Self { varied: Varied::of(&stack, &color, Some(Varying::Family(family))), stack, family })
    }
}

/// A material with the pictures that vary it.
struct Subject {
    material: Material,
    sides: Vec<Side>,
    base: usize,
    color: Option<(PictureRef, Image)>,
    metallic: Option<(PictureRef, Image)>,
    weight: Option<(PictureRef, Image)>,
    roughness: Option<(PictureRef, Image)>,
    /// Maps of slope parameters of the first layer and of the base.
    alphas: [Option<(PictureRef, Image)>; 2],
}

/// Values of a subject at a place.
struct Here {
    color: Rgb,
    mix: Mix,
    weight: f64,
    /// Slope parameters of the first layer and of the base.
    slopes: [Slopes; 2],
}

impl Subject {
    fn new(material: Material) -> Outcome<Self> {
        let unfit = || Failure::Input(anyhow::anyhow!("{}: no base with maps below a coat", material.name));
        let base =
            material.family().filter(|ranges| ranges.is_metallic && ranges.interface > 0).ok_or_else(unfit)?.interface;
        let read = |picture: &Option<PictureRef>, texels: TexelUse| {
            let Some(named) = picture else { return Outcome::Ok(None) };
            let picture = read_picture(&material.source, named, texels)
                .map_err(|reason| Failure::Input(anyhow::anyhow!("{}: {reason}", named.path)))?;
            Ok(Some((named.clone(), picture.image())))
        };
        let (first, own) = (&material.layers[0].maps, &material.layers[base].maps);
        let (color, metallic) = (read(&own.base_color, TexelUse::Color)?, read(&own.metallic, TexelUse::Number)?);
        let (weight, roughness) = (read(&first.weight, TexelUse::Number)?, read(&first.roughness, TexelUse::Number)?);
        let alphas = [read(&first.alpha, TexelUse::Number)?, read(&own.alpha, TexelUse::Number)?];
        let sides = [Some(&material), material.side().as_ref()].into_iter().flatten().filter_map(Side::new).collect();
        Ok(Self { sides, base, color, metallic, weight, roughness, alphas, material })
    }

    fn at(&self, uv: DVec2) -> Option<Here> {
        let number = |map: &Option<(PictureRef, Image)>| map.as_ref().map_or(1.0, |map| f64::from(texel(map, uv)[0]));
        let surface = self.material.layers[self.base].metallic?;
        let tint = self.color.as_ref().map_or([1.0; 3], |map| texel(map, uv).map(f64::from));
        let color = [0, 1, 2].map(|c: usize| surface.base_color[c] * tint[c]);
        let weight = self.material.weight().unwrap_or(1.0) * number(&self.weight);
        let metallic = surface.metallic * number(&self.metallic);
        let mix = match self.material.brightening() {
            Some(below) => Mix {
                metal: below.metal(color, weight),
                tint: surface.f82_tint,
                dielectric: surface.dielectric,
                matt: below.matt(color, weight),
                metallic,
            },
            None => Mix { metal: color, tint: surface.f82_tint, dielectric: surface.dielectric, matt: color, metallic },
        };
        let roughness = number(&self.roughness);
        let slopes = [(0, 0), (1, self.base)].map(|(i, layer)| {
            let own = number(&self.alphas[i]) * roughness * roughness;
            Slopes::from(self.material.stack.layers[layer].surface).scaled(own)
        });
        Some(Here { color, mix, weight, slopes })
    }

    /// The uniform stacks that a place is a mix of by area, each with its share.
    fn stacks(&self, here: &Here) -> Vec<(f64, Stack)> {
        let mut out = Vec::new();
        let coated = self.sides[0].family.apply(&self.sides[0].stack, here.slopes);
        for (share, stack) in [(here.weight, coated.clone()), (1.0 - here.weight, coated.without_first())] {
            let paint = Paint::of(&stack).mixed(here.mix);
            out.push((share * here.mix.metallic, paint.metal_of(&stack)));
            out.push((share * (1.0 - here.mix.metallic), paint.plastic_of(&stack)));
        }
        out.retain(|(share, _)| *share > 0.0);
        out
    }

    /// The lobes of a place, each with its share: below the coat, and where it is not.
    fn lobes(&self, here: &Here) -> Option<Vec<(f64, Lobes)>> {
        let mut out = Vec::new();
        for (side, share) in self.sides.iter().zip([here.weight, 1.0 - here.weight]).filter(|(_, share)| *share > 0.0) {
            let slopes = if side.family.is_coated() { here.slopes } else { [here.slopes[1]; 2] };
            let level = side.family.apply(&side.stack, slopes);
            out.push((share, side.varied.painted(slopes, &Paint::of(&level).mixed(here.mix))?));
        }
        Some(out)
    }

    /// Radiance of a pixel in all ways.
    fn pixel(&self, models: &[Box<dyn Model>; 2], [t, b, n]: [DVec3; 3], uv: DVec2, seed: u64) -> Option<[Rgb; 5]> {
        let here = self.at(uv)?;
        let wo = DVec3::new(t.z, b.z, n.z);
        let world = |w: DVec3| w.x * t + w.y * b + w.z * n;
        let mut sums = [[0.0; 3]; 5];
        let stacks = self.stacks(&here);
        let color = Color::ThreeWavelengths(WAVELENGTHS_NM);
        for (share, stack) in &stacks {
            let count = (PATHS as f64 * share).ceil() as u64;
            ColorPaths::new(stack, &color).trace(seed, count, wo, |path| {
                let light = radiance(world(path.wi)) * share / count as f64;
                (0..3).for_each(|c| sums[0][c] += path.weight[c] * light);
            });
        }
        let stacks: Vec<(f64, [Monochrome; 3])> = stacks
            .iter()
            .map(|(share, stack)| (*share, stack.crossed_once()))
            .map(|(share, stack)| (share, [0, 1, 2].map(|c: usize| Monochrome::new(&stack, WAVELENGTHS_NM[c], c))))
            .collect();
        let lobes = self.lobes(&here)?;
        let lobes: Vec<_> = lobes.iter().filter_map(|(share, lobes)| Some((*share, lobes.prepare(wo)?))).collect();
        let formula = gltf(&here);
        let mut random = SplitMix64::new(seed);
        let shift = [0; 3].map(|_: i32| random.unit());
        for i in 0..DIRECTIONS {
            // Roberts 2018: multiples of the powers of the root of x^4 = x + 1. A third of the directions by the cosine, others by the lobes.
            let u = [0.819_172_5, 0.671_043_6, 0.549_700_5];
            let u = [0, 1, 2].map(|d: usize| (u[d] * f64::from(i) + shift[d]).fract());
            let wi = if i % 3 == 0 {
                let (sin, cos) = libm::sincos(2.0 * PI * u[1]);
                Some(DVec3::new(u[0].sqrt() * cos, u[0].sqrt() * sin, (1.0 - u[0]).sqrt()))
            } else {
                let (share, first) = &lobes[0];
                let drawn = if u[0] < *share || lobes.len() == 1 { first } else { &lobes[1].1 };
                let choice = if lobes.len() == 1 {
                    u[0]
                } else if u[0] < *share {
                    u[0] / share
                } else {
                    (u[0] - share) / (1.0 - share)
                };
                drawn.sample([choice, u[1], u[2]]).map(|sample| sample.wi)
            };
            let Some(wi) = wi.filter(|wi| wi.z > 1e-4) else { continue };
            let drawn = f64::from(DIRECTIONS.div_ceil(3)) / f64::from(DIRECTIONS);
            let by_lobes: f64 = lobes.iter().map(|(share, lobes)| share * lobes.pdf_solid_angle(wi)).sum();
            let density = drawn * wi.z / PI + (1.0 - drawn) * by_lobes;
            let light = radiance(world(wi)) / (density * f64::from(DIRECTIONS));
            let mut add = |way: usize, value: Rgb| (0..3).for_each(|c| sums[way][c] += value[c] * light);
            for (share, lobes) in &lobes {
                add(1, lobes.eval(wi).map(|value| share * value));
            }
            for (way, model) in models.iter().enumerate() {
                for (share, stacks) in &stacks {
                    add(2 + way, stacks.each_ref().map(|stack| share * model.eval(stack, wi, wo)));
                }
            }
            add(4, formula.eval(wi, wo));
        }
        Some(sums)
    }
}

/// A texel of a map that repeats, unfiltered.
fn texel((named, image): &(PictureRef, Image), uv: DVec2) -> [f32; 3] {
    let uv =
        named.transform.map_or(uv, |moved| DVec2::from(moved.matrix().map(|[u, v, one]| u * uv.x + v * uv.y + one)));
    let [x, y] = [(uv.x, image.width), (uv.y, image.height)]
        .map(|(at, size)| (((at - at.floor()) * f64::from(size)) as u32).min(size - 1));
    let texel = image.texel(x, y);
    [0, 1, 2].map(|c: usize| texel[c.min(texel.len() - 1)])
}

/// The material of glTF at a place, with the masking of viewers.
fn gltf(here: &Here) -> gltf::Material {
    let [alpha, base] = here.slopes.map(Slopes::mean);
    gltf::Material {
        base_color: here.color,
        metallic: here.mix.metallic,
        coat: Some(gltf::Coat { weight: here.weight, alpha }),
        masking: JointMasking::Correlated,
        ..gltf::Material::plastic(base)
    }
}

/// Renders, as a picture and a page.
pub(crate) fn run(options: &FiveWaysOptions) -> Outcome {
    let models = ["belcour", "elek"].map(model);
    let [Some(belcour), Some(elek)] = models else { return Ok(()) };
    let models = [belcour, elek];
    let (mut pictures, mut page) = (Vec::new(), INTRODUCTION.to_owned());
    let all = valid(read_materials(&options.paths)?, true)?;
    let bar = Bar::new("rendering");
    let total = all.len() as u64;
    for (number, material) in all.into_iter().enumerate() {
        let name = material.name.clone();
        let ways = balls(&Subject::new(material)?, &models, options.size);
        let mean = |image: &Image| image.data.iter().map(|v| f64::from(*v)).sum::<f64>() / image.data.len() as f64;
        for (way, image) in WAYS.iter().zip(&ways).skip(1) {
            let compared = compare_pictures(image, &ways[0], |v| TONE.value(v)).map_err(Failure::input)?;
            let (light, error) = (mean(image) / mean(&ways[0]), compared.rms_err / mean(&ways[0]));
            let _ = writeln!(page, "| {name} | {way} | {:+.3} | {error:.3} | {:.3} |", light - 1.0, compared.flip_mean);
        }
        pictures.extend(WAYS.iter().zip(ways).map(|(way, image)| ((*way).to_owned(), TONE.image(image))));
        bar.set(number as u64 + 1, total);
    }
    drop(bar);
    let bytes = png::encode_image(&sheet(&pictures, WAYS.len() as u32)).map_err(Failure::input)?;
    std::fs::write(&options.picture, bytes).map_err(files(&options.picture, "write"))?;
    deliver(&page, options.destination.output.as_deref())
}

/// The unit ball in all ways, seen from far along z. Tangents follow the parallels.
fn balls(subject: &Subject, models: &[Box<dyn Model>; 2], size: u32) -> [Image; 5] {
    let pixels: Vec<[Rgb; 5]> = (0..size * size)
        .into_par_iter()
        .map(|number| {
            let [x, y] =
                [number % size, number / size].map(|i| EXTENT * (2.0 * (f64::from(i) + 0.5) / f64::from(size) - 1.0));
            let depth_sq = 1.0 - x * x - y * y;
            if depth_sq <= 1e-3 {
                return [[0.0; 3]; 5];
            }
            let n = DVec3::new(x, -y, depth_sq.sqrt());
            let t = DVec3::new(n.z, 0.0, -n.x).normalize();
            let uv = DVec2::new(0.5 + libm::atan2(n.x, n.z) / (2.0 * PI), 0.5 - libm::asin(n.y) / PI);
            subject.pixel(models, [t, n.cross(t), n], uv, u64::from(number)).unwrap_or_default()
        })
        .collect();
    [0, 1, 2, 3, 4].map(|way: usize| {
        let mut image = Image::zeros(size, size, 3);
        let values = pixels.iter().flat_map(|ways| ways[way]);
        image.data.iter_mut().zip(values).for_each(|(texel, value)| *texel = value as f32);
        image
    })
}

/// Half a side of the picture, in radii of the ball.
const EXTENT: f64 = 1.06;

const INTRODUCTION: &str = "\
# Five ways to show a textured coat

Generated by `luthier-lab five-ways`.

![Two balls, each five times: simulated, and by lobes, belcour, elek and the formula of glTF](../images/five-ways.png)

Two materials of `materials/textured/board` under a window, a second light and an even sky. *Simulated* follows light through the layers of every pixel. `lobes` are the families that a bake of the file has, in
f64. `belcour` and `elek` are those models with the stack of the pixel. *glTF* is the formula of glTF 2.0 (appendix B) with KHR_materials_clearcoat, typed from the specification. A texel of metal or of a coat between 0 and 1 is a mix by
area in all ways.

varnished-oak asks for a coat that does not darken its base (`darkening = false`), which is what the formula of glTF shows; so all ways mean the same colour there. worn-brass has a coat that darkens.

*Light* is the mean of the picture over that of the simulation, less 1. *Error* is the root of the mean squared difference over the mean of the simulation. FLIP is the visible difference (Andersson et al. 2020), 0 to 1. The simulation has
2048 paths a pixel, and its noise is part of error and FLIP.

| material | way | light | error | FLIP |
|---|---|--:|--:|--:|
";
