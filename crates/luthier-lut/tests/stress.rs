//! Hardware filters with weights of few bits: what that costs a row of a table, and how little more texels help.

use luthier_lut::{Image, WeightBits, bilinear};

/// Fresnel reflectance from air at n = 1.5 over the cosine.
fn fresnel(cos: f64) -> f64 {
    let g = (1.25 + cos * cos).sqrt();
    let (outer, inner) = ((g - cos) / (g + cos), (cos * (g + cos) - 1.0) / (cos * (g - cos) + 1.0));
    0.5 * outer * outer * (1.0 + inner * inner)
}

/// `pi alpha^2 D` of GGX over u, tan theta_h = 4 alpha u: a lobe from its peak to a 1/289 of it.
fn lobe(u: f64) -> f64 {
    1.0 / ((1.0 + 16.0 * u * u) * (1.0 + 16.0 * u * u))
}

fn row(texels: u32, f: impl Fn(f64) -> f64) -> Image {
    let data = (0..texels).map(|i| f(f64::from(i) / f64::from(texels - 1)) as f32).collect();
    Image { width: texels, height: 1, channels: 1, data }
}

/// Largest difference that the weights make, and largest error of either, over 1000 places in each interval.
fn errors(image: &Image, f: impl Fn(f64) -> f64, weights: WeightBits) -> [f64; 3] {
    let intervals = image.width - 1;
    let mut worst = [0.0f64; 3];
    for i in 0..1000 * intervals {
        let at = (f64::from(i) + 0.5) / 1000.0;
        let read = |weights| bilinear(image, [at + 0.5, 0.5], weights)[0];
        let (exact, coarse, truth) = (read(WeightBits::Exact), read(weights), f(at / f64::from(intervals)));
        let found = [coarse - exact, exact - truth, coarse - truth].map(f64::abs);
        worst.iter_mut().zip(found).for_each(|(w, e)| *w = w.max(e));
    }
    worst
}

/// Largest step between neighbours: what a whole unit of weight is worth.
fn largest_step(image: &Image) -> f64 {
    image.data.windows(2).map(|pair| f64::from(pair[1] - pair[0]).abs()).fold(0.0, f64::max)
}

/// Half a unit of the weight times the step between texels: 2^-9 of it for 8 bits. It is reached within 1%, and the whole error is at
/// most the sum.
#[test]
fn weights_of_eight_bits_cost_half_a_unit_of_the_step_between_texels() {
    for (name, f, texels, expected) in [
        ("fresnel", fresnel as fn(f64) -> f64, 128, 8.6e-5),
        ("fresnel", fresnel, 512, 2.2e-5),
        ("lobe", lobe, 64, 1.27e-4),
        ("lobe", lobe, 512, 1.58e-5),
    ] {
        let image = row(texels, f);
        for bits in [8, 4] {
            let bound = largest_step(&image) / f64::from(1u32 << (bits + 1));
            let [extra, interpolation, whole] = errors(&image, f, WeightBits::Fixed(bits));
            assert!(extra <= bound * (1.0 + 1e-9) && extra > 0.99 * bound, "{name} {texels}: {extra} of {bound}");
            assert!(whole <= interpolation + bound, "{name} {texels}: {whole}");
            if bits == 8 {
                assert!((extra / expected - 1.0).abs() < 0.03, "{name} {texels}: {extra}");
            }
        }
    }
}

/// Interpolation errs as the square of the spacing, weights as the spacing. A quarter of the error of a lobe's row at 256 texels, they are
/// the larger part at 1024.
#[test]
fn more_texels_help_against_weights_only_as_their_number() {
    let at = |texels| errors(&row(texels, lobe), lobe, WeightBits::Fixed(8));
    let ([extra, interpolation, _], [finer_extra, finer_interpolation, _]) = (at(256), at(1024));
    assert!((extra / finer_extra - 4.0).abs() < 0.1, "{extra} {finer_extra}");
    assert!((interpolation / finer_interpolation - 16.0).abs() < 1.0, "{interpolation} {finer_interpolation}");
    assert!(finer_extra > finer_interpolation, "{finer_extra} {finer_interpolation}");
}
