//! Tests of levels: even maps, a narrow light, the mean over all directions.

use super::*;
use crate::vector::{dot, unit};
use crate::{Sky, SoftLight};

const LAYOUTS: [Layout; 2] = [Layout::Cube, Layout::Equirect];

/// Solid angles and values of all texels of a level.
fn texels(layout: Layout, level: &Level) -> impl Iterator<Item = (f64, [f64; 3], f64)> {
    level.images.iter().enumerate().flat_map(move |(face, image)| {
        let texels = (0..image.height).flat_map(move |y| (0..image.width).map(move |x| (x, y)));
        texels.map(move |(x, y)| {
            let (solid_angle, direction) = match layout {
                Layout::Cube => {
                    (cube::solid_angle(image.height, x, y), cube::texel_direction(face, image.height, x, y))
                }
                Layout::Equirect => (panorama::solid_angle(image, y), panorama::texel_direction(image, x, y)),
            };
            (solid_angle, direction, f64::from(image.texel(x, y)[1]))
        })
    })
}

#[test]
fn an_even_map_stays_even() {
    let environment = Environment::sky(&Sky::uniform([0.25, 1.0, 3.0])).unwrap();
    for layout in LAYOUTS {
        let levels = environment.levels(layout, 64).unwrap();
        assert_eq!(levels.len(), 5);
        let irradiance = environment.irradiance_level(layout);
        for image in levels.iter().flat_map(|level| &level.images).chain(&irradiance) {
            for texel in image.texels() {
                for (found, expected) in texel.iter().zip([0.25, 1.0, 3.0]) {
                    assert!((found / expected - 1.0).abs() < 1e-6, "{layout:?}: {found} {expected}");
                }
            }
        }
    }
}

/// A soft light is a lobe of the same kind: blurred, its mean cosine is the product of both (Mardia and Jupp 2000, section 9.3), with what
/// texels blur when they are read. Measured: 0.065 at most.
#[test]
fn a_light_has_the_second_moment_of_the_blur() {
    let centre = unit([0.3, 0.5, -1.0]);
    let sharpness = 900.0;
    let light = SoftLight { direction: centre.map(|v| v as f32), sharpness: 900.0, radiance: [1.0; 3] };
    let mut sky = Sky::uniform([0.0; 3]);
    sky.lights[0] = light;
    let environment = Environment::sky(&sky).unwrap();
    let mean_cosine = |k: f64| 1.0 / libm::tanh(k) - 1.0 / k;
    for layout in LAYOUTS {
        let levels = environment.levels(layout, 256).unwrap();
        for level in levels.iter().skip(2) {
            let (mut sum, mut cosines) = (0.0, 0.0);
            for (solid_angle, direction, value) in texels(layout, level) {
                sum += solid_angle * value;
                cosines += solid_angle * value * dot(direction, centre);
            }
            let texel = layout.texel(level.images[0].height);
            let variance = level.width * level.width - texel * texel / 6.0;
            let expected = mean_cosine(1.0 / variance) * mean_cosine(sharpness);
            let error = (1.0 - cosines / sum) / (1.0 - expected) - 1.0;
            eprintln!("{layout:?}, width {:.4}: second moment off by {error:.4}", level.width);
            assert!(error.abs() < 0.075, "{layout:?} {}: {error}", level.width);
        }
    }
}

#[test]
fn levels_keep_the_mean_of_a_sky() {
    let environment = Environment::sky(&Sky::default()).unwrap();
    for layout in LAYOUTS {
        let mut means = environment.levels(layout, 64).unwrap().into_iter().map(|level| {
            let (sum, weights) = texels(layout, &level).fold((0.0, 0.0), |(sum, weights), (solid_angle, _, value)| {
                (sum + solid_angle * value, weights + solid_angle)
            });
            (level.width, sum / weights)
        });
        let (_, exact) = means.next().unwrap();
        for (width, mean) in means {
            eprintln!("{layout:?}, width {width:.4}: mean off by {:.5}", mean / exact - 1.0);
            assert!((mean / exact - 1.0).abs() < 0.01, "{layout:?} {width}: {mean} {exact}");
        }
    }
}

/// Cosines of normals over pi: on average over all normals irradiance over pi is the mean of the sky over 4.
#[test]
fn irradiance_has_the_mean_of_a_sky() {
    let environment = Environment::sky(&Sky::default()).unwrap();
    let sky: f64 = texels(Layout::Cube, &environment.levels(Layout::Cube, 64).unwrap()[0]).map(|(w, _, v)| w * v).sum();
    for layout in LAYOUTS {
        let level = Level { width: 0.0, images: environment.irradiance_level(layout) };
        let mean: f64 = texels(layout, &level).map(|(w, _, v)| w * v).sum::<f64>();
        assert!((mean / sky - 1.0).abs() < 0.01, "{layout:?}: {mean} {sky}");
    }
}

#[test]
fn sizes_that_do_not_halve_are_refused() {
    let environment = Environment::sky(&Sky::uniform([1.0; 3])).unwrap();
    assert!(environment.levels(Layout::Cube, 48).is_err() && environment.levels(Layout::Cube, 2048).is_err());
    assert!((Environment::level_width(256, 1) - 1.0 / 32.0).abs() < 1e-12);
}
