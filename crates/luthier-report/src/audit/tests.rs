//! Tables with one or two mistakes planted, made with quadrature by a way of their own: no code of the audit says where a texel lies.

use std::sync::OnceLock;

use luthier_lut::{Image, TexelFormat};
use luthier_optics::split_sum::{Masking, SplitSum, split_sums};
use luthier_optics::stack::Distribution;
use luthier_table::Nodes;

use super::*;

/// A table with a planted mistake.
#[derive(Clone, Copy)]
struct Plant {
    size: u32,
    /// (u, v) of a texel in 0..1 to cosine and alpha.
    place: fn(u: f64, v: f64) -> (f64, f64),
    /// Coordinate of texel i of n.
    node: fn(i: u32, n: u32) -> f64,
    masking: Masking,
    store: fn(SplitSum) -> [f64; 2],
}

fn centres(i: u32, n: u32) -> f64 {
    (f64::from(i) + 0.5) / f64::from(n)
}

const RIGHT: Plant = Plant {
    size: 32,
    place: |u, v| (u, v * v),
    node: centres,
    masking: Masking::SmithCorrelated,
    store: |sum| [sum.scale, sum.bias],
};

fn table(plant: Plant) -> Image {
    let n = plant.size;
    let which = Masking::ALL.iter().position(|m| *m == plant.masking).unwrap();
    let mut image = Image::zeros(n, n, 2);
    for y in 0..n {
        for x in 0..n {
            let (cos, alpha) = (plant.place)((plant.node)(x, n), (plant.node)(y, n));
            let sum = split_sums(Distribution::Ggx, alpha, cos)[which];
            let [a, b] = (plant.store)(sum);
            image.texel_mut(x, y).copy_from_slice(&[a as f32, b as f32]);
        }
    }
    image
}

fn statement() -> Statement {
    Statement {
        model: Model::SplitSum { distribution: Distribution::Ggx, masking: Masking::SmithCorrelated },
        layout: Layout::parse("cos_theta,roughness", Nodes::CENTRES).unwrap(),
        channels: vec![0, 1],
        terms: vec![Term::Scale, Term::Bias],
        min_cos: 0.01,
        min_alpha: 0.0025,
        step: f64::from(f32::EPSILON),
    }
}

/// [`super::audit`] with one set of quadratures for all tables under the same model.
fn audit(image: &Image, statement: &Statement) -> Result<Audit, AuditError> {
    static MODEL: Model = Model::SplitSum { distribution: Distribution::Ggx, masking: Masking::SmithCorrelated };
    static TRUTH: OnceLock<Truth> = OnceLock::new();
    if statement.model != MODEL {
        return super::audit(image, statement);
    }
    check(image, statement)?;
    Ok(against(image, statement, TRUTH.get_or_init(|| Truth::new(&MODEL))))
}

fn kinds(found: &Audit) -> Vec<&'static str> {
    found.candidates[0].mistakes.iter().map(|m| m.kind).collect()
}

fn srgb(v: f64) -> f64 {
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * libm::pow(v, 1.0 / 2.4) - 0.055 }
}

#[test]
fn a_right_table_is_as_stated() {
    let found = audit(&table(RIGHT), &statement()).unwrap();
    assert_eq!(found.verdict_line(), "as stated", "{}", found.to_text());
    assert!(found.candidates[0].rms < 1e-6, "{}", found.to_text());
    assert!(found.stated.max_abs_err < 0.05 && found.stated.rms_err < 2e-3, "{}", found.to_text());
    // In bytes too, where rounding is what is left.
    let rounded = TexelFormat::Rgba8Unorm.quantise(&table(RIGHT));
    let found = audit(&rounded, &Statement { step: 1.0 / 255.0, ..statement() }).unwrap();
    assert_eq!(found.verdict_line(), "as stated", "{}", found.to_text());
}

#[test]
#[ignore = "a minute: scripts/nightly.sh tests"]
fn each_planted_mistake_is_named() {
    planted_mistakes_are_named(1);
}

#[test]
fn every_fifth_planted_mistake_is_named() {
    planted_mistakes_are_named(5);
}

/// Audits tables with one mistake each, one of so many.
fn planted_mistakes_are_named(step: usize) {
    let cases: [(&str, Plant); 17] = [
        ("axes swapped", Plant { place: |u, v| (v, u * u), ..RIGHT }),
        ("flipped in x", Plant { place: |u, v| (1.0 - u, v * v), ..RIGHT }),
        ("flipped in y", Plant { place: |u, v| (u, (1.0 - v) * (1.0 - v)), ..RIGHT }),
        (
            "half-texel remap in both axes: the first and last nodes are the ends of the axis",
            Plant { node: |i, n| f64::from(i) / f64::from(n - 1), ..RIGHT },
        ),
        (
            "half a texel off in both axes: coordinates too low",
            Plant { node: |i, n| f64::from(i) / f64::from(n), ..RIGHT },
        ),
        ("alpha where roughness was stated", Plant { place: |u, v| (u, v), ..RIGHT }),
        (
            "theta where cos_theta was stated, flipped in x",
            Plant { place: |u, v| (libm::cos(u * std::f64::consts::FRAC_PI_2), v * v), ..RIGHT },
        ),
        ("cos_theta_sq where cos_theta was stated", Plant { place: |u, v| (u.sqrt(), v * v), ..RIGHT }),
        ("sqrt_cos_theta where cos_theta was stated", Plant { place: |u, v| (u * u, v * v), ..RIGHT }),
        ("masking separable", Plant { masking: Masking::SmithSeparable, ..RIGHT }),
        ("masking v-cavity", Plant { masking: Masking::VCavity, ..RIGHT }),
        ("masking schlick-karis", Plant { masking: Masking::SchlickKaris, ..RIGHT }),
        ("channels swapped: bias,scale where scale,bias was stated", Plant { store: |s| [s.bias, s.scale], ..RIGHT }),
        ("bias,albedo where scale,bias was stated", Plant { store: |s| [s.bias, s.albedo()], ..RIGHT }),
        ("sRGB-encoded", Plant { store: |s| [srgb(s.scale), srgb(s.bias)], ..RIGHT }),
        ("roughness never below 0.1", Plant { place: |u, v| (u, v.max(0.1) * v.max(0.1)), ..RIGHT }),
        ("roughness from 0.05 on, not 0", Plant { place: |u, v| (u, (0.05 + 0.95 * v) * (0.05 + 0.95 * v)), ..RIGHT }),
    ];
    for (expected, plant) in cases.into_iter().step_by(step) {
        let found = audit(&table(plant), &statement()).unwrap();
        // The angle falls where its cosine rises.
        let expected = if expected.starts_with("theta") { "theta where cos_theta was stated" } else { expected };
        assert_eq!(found.verdict_line(), format!("fits better as: {expected}"), "{}", found.to_text());
        assert!(found.candidates[0].rms < 3e-5, "{}", found.to_text());
    }
}

#[test]
fn every_masking_term_is_told_from_the_others() {
    for masking in Masking::ALL {
        let found = audit(&table(Plant { masking, size: 24, ..RIGHT }), &statement()).unwrap();
        let expected = if masking == Masking::SmithCorrelated {
            "as stated".to_owned()
        } else {
            format!("fits better as: masking {}", masking.name())
        };
        assert_eq!(found.verdict_line(), expected, "{}", found.to_text());
    }
}

/// The reverse of `alpha where roughness was stated`, and nodes at centres where ends were stated.
#[test]
fn statements_may_be_the_wrong_ones() {
    let layout = Layout::parse("cos_theta,alpha", Nodes::CENTRES).unwrap();
    let found = audit(&table(RIGHT), &Statement { layout, ..statement() }).unwrap();
    assert_eq!(found.verdict_line(), "fits better as: roughness where alpha was stated", "{}", found.to_text());
    let layout = Layout::parse("cos_theta,roughness", Nodes::Ends).unwrap();
    let found = audit(&table(RIGHT), &Statement { layout, ..statement() }).unwrap();
    let expected = "fits better as: no half-texel remap in both axes: nodes are texel centres of 0..1";
    assert_eq!(found.verdict_line(), expected, "{}", found.to_text());
}

#[test]
fn two_and_three_mistakes_at_once() {
    let two = Plant { place: |u, v| (u, (1.0 - v) * (1.0 - v)), masking: Masking::SmithSeparable, ..RIGHT };
    let found = audit(&table(two), &statement()).unwrap();
    assert_eq!(found.verdict_line(), "fits better as: flipped in y, masking separable", "{}", found.to_text());
    let three = Plant {
        place: |u, v| (v, u),
        node: |i, n| f64::from(i) / f64::from(n - 1),
        store: |s| [s.bias, s.scale],
        ..RIGHT
    };
    let found = audit(&table(three), &statement()).unwrap();
    assert_eq!(kinds(&found), ["axes", "nodes", "quantity", "channels"], "{}", found.to_text());
    // What cmgen of Filament writes (libs/ibl/src/CubemapIBL.cpp): from 1 at the top, a texel off.
    let filament = Plant { place: |u, v| (u, v * v), node: centres, store: |s| [s.bias, s.albedo()], ..RIGHT };
    let mut image = table(filament);
    let n = filament.size;
    for y in 0..n {
        let coordinate = ((f64::from(n - y) + 0.5) / f64::from(n)).min(1.0);
        for x in 0..n {
            let sum = split_sums(Distribution::Ggx, coordinate * coordinate, centres(x, n))[0];
            image.texel_mut(x, y).copy_from_slice(&[sum.bias as f32, sum.albedo() as f32]);
        }
    }
    let layout = Layout::parse("cos_theta,-roughness", Nodes::CENTRES).unwrap();
    let found = audit(&image, &Statement { layout, terms: vec![Term::Bias, Term::Albedo], ..statement() }).unwrap();
    assert_eq!(found.verdict_line(), "fits better as: a texel off in y: coordinates too low", "{}", found.to_text());
}

/// A pseudo-random value in -1..1 for each number: the finaliser of MurmurHash3.
fn noise(i: usize) -> f32 {
    let mut h = (i as u32).wrapping_mul(0x9e37_79b9);
    h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
    (h ^ (h >> 16)) as f32 / 2_147_483_648.0 - 1.0
}

#[test]
fn noise_does_not_hide_a_mistake_nor_make_one() {
    for (plant, expected) in [
        (RIGHT, "as stated"),
        (
            Plant { place: |u, v| (u, v), masking: Masking::SchlickHalf, ..RIGHT },
            "fits better as: alpha where roughness was stated, masking schlick-half",
        ),
    ] {
        let mut image = table(plant);
        image.data.iter_mut().enumerate().for_each(|(i, v)| *v += 0.01 * noise(i));
        let found = audit(&image, &statement()).unwrap();
        let line = found.verdict_line().replace(", values below 0 not clamped", "");
        assert_eq!(line, expected, "{}", found.to_text());
        // Even in -0.01..0.01: root mean square 0.01/sqrt(3).
        assert!((found.candidates[0].rms - 0.01 / 3.0f64.sqrt()).abs() < 1e-3, "{}", found.to_text());
    }
}

#[test]
fn values_below_zero_are_counted_and_named() {
    // The bias less a hundredth, as a fit would leave it where it is all but 0; and right elsewhere.
    let mut image = table(RIGHT);
    image.data.iter_mut().filter(|v| **v < 0.02).for_each(|v| *v = -0.1);
    image.data.iter_mut().filter(|v| **v < 0.0).for_each(|v| *v = -0.2);
    let found = audit(&image, &statement()).unwrap();
    assert_eq!(kinds(&found), ["clamp"], "{}", found.to_text());
    assert!(found.negative > 100 && !found.is_within(1.0));
}

#[test]
fn what_is_no_such_table_fits_nothing() {
    let mut image = table(RIGHT);
    image.data.iter_mut().enumerate().for_each(|(i, v)| *v = noise(i));
    let found = audit(&image, &statement()).unwrap();
    assert_eq!(found.verdict_line(), "fits nothing that was tried", "{}", found.to_text());
    image.data.fill(f32::NAN);
    let found = audit(&image, &statement()).unwrap();
    assert_eq!((found.verdict, found.not_finite), (AuditVerdict::FitsNothing, 2048));
    assert!(!found.is_within(f64::INFINITY));
}

#[test]
fn densities_are_told_apart() {
    use luthier_optics::microfacet::{distribution, scaled_distribution};
    use std::f64::consts::FRAC_PI_2;
    let n = 48;
    let make = |f: &dyn Fn(f64, f64) -> f64| {
        let mut image = Image::zeros(n, n, 1);
        for y in 0..n {
            for x in 0..n {
                let (u, alpha) = (f64::from(x) / f64::from(n - 1), 0.01 + 0.99 * f64::from(y) / f64::from(n - 1));
                image.texel_mut(x, y)[0] = f(FRAC_PI_2 * libm::pow(u, 4.0), alpha) as f32;
            }
        }
        image
    };
    let (cos, sin_sq) = (|t: f64| libm::cos(t), |t: f64| libm::sin(t) * libm::sin(t));
    let stated = Statement {
        model: Model::Density { distribution: Distribution::Ggx },
        layout: Layout::parse("theta_h=0..1.5707963267948966^4,alpha=0.01..1", Nodes::Ends).unwrap(),
        channels: vec![0],
        terms: vec![Term::ScaledDensity],
        ..statement()
    };
    let ggx = make(&|t, a| scaled_distribution(Distribution::Ggx, a, cos(t), sin_sq(t)));
    let found = audit(&ggx, &stated).unwrap();
    assert_eq!(found.verdict_line(), "as stated", "{}", found.to_text());
    let found =
        audit(&make(&|t, a| scaled_distribution(Distribution::Beckmann, a, cos(t), sin_sq(t))), &stated).unwrap();
    assert_eq!(found.verdict_line(), "fits better as: distribution Beckmann", "{}", found.to_text());
    let found = audit(&make(&|t, a| distribution(Distribution::Ggx, a, cos(t), sin_sq(t))), &stated).unwrap();
    assert_eq!(found.verdict_line(), "fits better as: d where scaled-d was stated", "{}", found.to_text());
}

#[test]
fn reflectance_rows() {
    use luthier_optics::color::Color;
    use luthier_optics::constants::dataset;
    use luthier_optics::interface::Interface;
    use luthier_optics::ior::Ior;
    use luthier_optics::schlick::schlick;
    let gold = Interface { above: Ior::vacuum(), films: Vec::new(), below: dataset("au").unwrap().ior.clone() };
    let sampled = gold.sampled(&Color::Spectral);
    let f0 = sampled.rgb(1.0);
    let n = 64;
    let make = |f: &dyn Fn(f64) -> [f64; 3]| {
        let data = (0..n).flat_map(|i| f(centres(i, n))).map(|v| v as f32).collect();
        Image { width: n, height: 1, channels: 3, data }
    };
    let stated = Statement {
        model: Model::Reflectance { interface: gold.clone() },
        layout: Layout::parse("cos_theta", Nodes::CENTRES).unwrap(),
        channels: vec![0, 1, 2],
        terms: vec![Term::Red, Term::Green, Term::Blue],
        ..statement()
    };
    let line = |image: &Image| audit(image, &stated).unwrap().verdict_line();
    assert_eq!(line(&make(&|c| sampled.rgb(c))), "as stated");
    assert_eq!(line(&make(&|c| sampled.rgb(1.0 - c))), "fits better as: flipped in x");
    assert_eq!(line(&make(&|c| f0.map(|f0| schlick(f0, c)))), "fits better as: Schlick's Fresnel");
    let three = |c| [645.0, 525.0, 445.0].map(|nm| gold.at(nm, 0).reflectance(c));
    assert_eq!(line(&make(&three)), "fits better as: three wavelengths for red, green, blue");
    let bgr = |c| {
        let [r, g, b] = sampled.rgb(c);
        [b, g, r]
    };
    let expected = "fits better as: channels swapped: blue,green,red where red,green,blue was stated";
    assert_eq!(line(&make(&bgr)), expected);
}

#[test]
fn statements_that_do_not_suit_are_refused() {
    let image = table(Plant { size: 4, ..RIGHT });
    let refused = |statement| audit(&image, &statement).unwrap_err().to_string();
    assert!(refused(Statement { channels: vec![0, 2], ..statement() }).contains("no channel 2"));
    assert!(refused(Statement { channels: vec![0], ..statement() }).contains("1 channels are read and 2"));
    assert!(refused(Statement { terms: vec![Term::Red, Term::Bias], ..statement() }).contains("scale, bias, albedo"));
    let layout = Layout::parse("cos_theta", Nodes::CENTRES).unwrap();
    assert!(refused(Statement { layout, ..statement() }).contains("roughness"));
    let row = Image { width: 16, height: 1, channels: 2, data: vec![0.5; 32] };
    assert!(audit(&row, &statement()).is_err());
}
