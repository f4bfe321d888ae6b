//! Pictures of a ball from values for pairs of directions: of models in f64 that no shader has, and of simulations.

use glam::DVec3;
use luthier_layers::model::{Estimate, Model};
use luthier_layers::monochrome::Monochrome;
use luthier_lut::Image;
use luthier_optics::Rgb;
use luthier_optics::stack::Stack;
use rayon::prelude::*;

/// Distance of the eye from the centre, and half the side of the picture at the centre: a long lens from +z.
const EYE: f64 = 7.0;
const HALF_EXTENT: f64 = 1.22;

/// A light that is far away. World: +y is up, +z to the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DistantLight {
    /// Direction to the light; need not be unit.
    pub direction: [f64; 3],
    /// Irradiance that the light gives to a patch that faces it, linear RGB.
    pub irradiance: Rgb,
}

/// A picture with its noise.
#[derive(Debug, Clone, PartialEq)]
pub struct BallPicture {
    /// Radiance, linear RGB; black around the ball.
    pub image: Image,
    /// Root of the mean squared standard error over all pixels and channels; 0 for models without noise.
    pub noise: f64,
}

/// Renders the unit ball of a material under some lights, `size` pixels square, seen from (0, 0, 7). Each pixel has one ray through its middle; three
/// wavelengths (nm) are taken as R, G and B. Tangents follow the parallels, as in `luthier preview`.
pub fn render_ball(
    model: &dyn Model,
    stack: &Stack,
    wavelengths_nm: [f64; 3],
    lights: &[DistantLight],
    size: u32,
) -> BallPicture {
    let stacks = [0, 1, 2].map(|c: usize| Monochrome::new(stack, wavelengths_nm[c], c));
    let mut image = Image::zeros(size, size, 3);
    let rows: Vec<f64> = image
        .data
        .par_chunks_mut(3 * size as usize)
        .enumerate()
        .map(|(y, row)| {
            let mut variance = 0.0;
            for (x, texel) in row.chunks_exact_mut(3).enumerate() {
                let Some(place) = Place::hit([x as u32, y as u32], size) else { continue };
                for (channel, (stack, value)) in stacks.iter().zip(texel).enumerate() {
                    let seen = place.seen(model, stack, lights, channel);
                    *value = seen.mean as f32;
                    variance += seen.variance();
                }
            }
            variance
        })
        .collect();
    let noise = (rows.iter().sum::<f64>() / image.data.len().max(1) as f64).sqrt();
    BallPicture { image, noise }
}

/// Renders the ball of [`render_ball`] from the values of a function. `values` gets all pairs of unit directions to a light and to the eye, in the local
/// frame, both above the horizon, and returns `f cos_theta_i` for each, in their order.
///
/// # Errors
/// That of `values`.
pub fn render_ball_of<E>(
    lights: &[DistantLight],
    size: u32,
    values: impl FnOnce(&[(DVec3, DVec3)]) -> Result<Vec<[Estimate; 3]>, E>,
) -> Result<BallPicture, E> {
    let (mut pairs, mut of) = (Vec::new(), Vec::new());
    for pixel in 0..size * size {
        let Some(place) = Place::hit([pixel % size, pixel / size], size) else { continue };
        let wo = place.local(place.to_eye);
        for light in lights {
            let wi = place.local(DVec3::from_array(light.direction).normalize());
            if wi.z > 0.0 && wo.z > 0.0 {
                pairs.push((wi, wo));
                of.push((pixel, light.irradiance));
            }
        }
    }
    let mut image = Image::zeros(size, size, 3);
    let mut variance = 0.0;
    for ((pixel, irradiance), value) in of.into_iter().zip(values(&pairs)?) {
        let texel = image.texel_mut(pixel % size, pixel / size);
        for c in 0..3 {
            texel[c] += (irradiance[c] * value[c].mean) as f32;
            variance += irradiance[c] * irradiance[c] * value[c].variance();
        }
    }
    let noise = (variance / image.data.len().max(1) as f64).sqrt();
    Ok(BallPicture { image, noise })
}

/// A point of the ball.
struct Place {
    /// Tangent, bitangent, normal.
    frame: [DVec3; 3],
    /// Direction to the eye, unit.
    to_eye: DVec3,
}

impl Place {
    /// Point of the ball that the ray through the middle of a pixel meets.
    fn hit(pixel: [u32; 2], size: u32) -> Option<Self> {
        let [right, down] = pixel.map(|i| 2.0 * (f64::from(i) + 0.5) / f64::from(size) - 1.0);
        let eye = DVec3::new(0.0, 0.0, EYE);
        let ray = (DVec3::new(right * HALF_EXTENT, -down * HALF_EXTENT, 0.0) - eye).normalize();
        let along = -eye.dot(ray);
        let depth_sq = 1.0 - (eye + along * ray).length_squared();
        if depth_sq <= 0.0 {
            return None;
        }
        let n = (eye + (along - depth_sq.sqrt()) * ray).normalize();
        let across = DVec3::new(n.z, 0.0, -n.x);
        let t = if across.length_squared() > 0.0 { across.normalize() } else { DVec3::X };
        Some(Self { frame: [t, n.cross(t), n], to_eye: -ray })
    }

    fn local(&self, w: DVec3) -> DVec3 {
        let [t, b, n] = self.frame;
        DVec3::new(w.dot(t), w.dot(b), w.dot(n))
    }

    fn seen(&self, model: &dyn Model, stack: &Monochrome, lights: &[DistantLight], channel: usize) -> Estimate {
        let wo = self.local(self.to_eye);
        Estimate::sum(lights.iter().map(|light| {
            let wi = self.local(DVec3::from_array(light.direction).normalize());
            let one = match model.estimator() {
                Some(estimator) => estimator.eval_with_error(stack, wi, wo),
                None => Estimate::exact(model.eval(stack, wi, wo)),
            };
            (light.irradiance[channel], one)
        }))
    }
}

#[cfg(test)]
mod tests {
    use luthier_layers::models::diffuse::Lambert;
    use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::{Base, Diffuse, Layer, Surface};

    use super::*;

    fn white() -> Stack {
        let base = Base::Diffuse(Diffuse { albedo: [1.0, 0.5, 0.25], sigma: 0.0 });
        let layer = Layer { films: Vec::new(), surface: Surface::smooth(), base };
        Stack { exterior: Ior::vacuum(), layers: vec![layer] }
    }

    const WAVELENGTHS_NM: [f64; 3] = [645.0, 525.0, 445.0];

    /// Lambert's ball under a light from the eye: cos theta / pi in the middle, nothing around.
    #[test]
    fn a_white_ball_is_as_bright_as_its_cosine() {
        let lights = [DistantLight { direction: [0.0, 0.0, 1.0], irradiance: [std::f64::consts::PI; 3] }];
        let seen = render_ball(&Lambert, &white(), WAVELENGTHS_NM, &lights, 33);
        let middle = seen.image.texel(16, 16);
        for (value, expected) in middle.iter().zip([1.0, 0.5, 0.25]) {
            assert!((value - expected).abs() < 1e-6, "{middle:?}");
        }
        assert_eq!((seen.image.texel(0, 0), seen.noise), (&[0.0; 3][..], 0.0));
    }

    /// Both ways to a picture are one where the values are those of the model.
    #[test]
    fn values_make_the_picture_of_their_model() {
        let lights = [
            DistantLight { direction: [0.3, 0.5, 1.0], irradiance: [1.0, 2.0, 3.0] },
            DistantLight { direction: [-1.0, 0.1, -0.2], irradiance: [0.5; 3] },
        ];
        let stack = white();
        let stacks = [0, 1, 2].map(|c: usize| Monochrome::new(&stack, WAVELENGTHS_NM[c], c));
        let value = |(wi, wo): &(DVec3, DVec3)| stacks.each_ref().map(|s| Estimate::exact(Lambert.eval(s, *wi, *wo)));
        let seen = render_ball_of(&lights, 24, |pairs| Ok::<_, ()>(pairs.iter().map(value).collect())).unwrap();
        let expected = render_ball(&Lambert, &stack, WAVELENGTHS_NM, &lights, 24);
        let most = seen.image.data.iter().zip(&expected.image.data).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(most < 1e-6 && seen.image.data.iter().any(|v| *v > 0.1), "{most}");
        // Errors of 0.1 of a value of 1, times irradiances of 1, 2 and 3, on the lit share of the picture.
        let known = |pairs: &[(DVec3, DVec3)]| Ok::<_, ()>(vec![[Estimate::known(1.0, 0.1); 3]; pairs.len()]);
        let seen = render_ball_of(&lights[..1], 24, known).unwrap();
        let lit = seen.image.texels().filter(|texel| *texel == [1.0, 2.0, 3.0]).count() as f64 / (24.0 * 24.0);
        let expected = 0.1 * ((1.0 + 4.0 + 9.0) / 3.0 * lit).sqrt();
        assert!(lit > 0.3 && (seen.noise / expected - 1.0).abs() < 1e-9, "{} {expected}", seen.noise);
    }

    /// Simulations of a ball are as far apart as their stated noise says, and equal at every run.
    #[test]
    fn noise_is_what_it_says() {
        let lights = [DistantLight { direction: [0.3, 0.5, 1.0], irradiance: [1.0; 3] }];
        let mut stack = white();
        let coat = Surface::isotropic(luthier_optics::stack::Distribution::Ggx, 0.4);
        let slab = luthier_optics::stack::Slab { thickness_um: 1.0, absorption_per_um: [0.0; 3] };
        let base = Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab };
        stack.layers.insert(0, Layer { films: Vec::new(), surface: coat, base });
        let render = |samples, seed| {
            let model = LayeredMc { samples, seed, ..LayeredMc::new(InterfaceMode::SmithWalk) };
            render_ball(&model, &stack, WAVELENGTHS_NM, &lights, 16)
        };
        let (a, b) = (render(64, 0), render(64, 1));
        assert_eq!(a, render(64, 0));
        let squares = a.image.data.iter().zip(&b.image.data).map(|(a, b)| f64::from(a - b) * f64::from(a - b));
        let apart = (squares.sum::<f64>() / a.image.data.len() as f64).sqrt();
        let expected = (a.noise * a.noise + b.noise * b.noise).sqrt();
        // 16 x 16 x 3 values of which half are lit: the ratio of two deviations scatters by some percent.
        assert!((apart / expected - 1.0).abs() < 0.25, "{apart} {expected}");
    }
}
