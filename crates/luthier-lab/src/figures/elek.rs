//! Figures of Elek 2010 about the model and its tables.

use std::f64::consts::{FRAC_PI_2, PI};

use luthier_gpu::{Camera, Light, Shape};
use luthier_lut::{Image, TexelFormat, WeightBits, bilinear};
use luthier_manifest::{Form, ShadingModel};
use luthier_material::{AlphaMapping, BakeSettings, DistributionMapping, FresnelMapping, Material};
use luthier_report::{Curve, Plot, PlotAxis, PlotColor};
use luthier_terminal::Outcome;

use super::claim::{Check, Claim};
use super::figure::{Figure, Made, SMALL, compared};
use super::numbers::light::even_sky;
use super::numbers::spot::{softened, spot, spot_of};
use super::numbers::{across, brightest, pixels};
use super::studio::{Studio, material, shaded};

pub(crate) const FIGURES: [Figure; 3] = [
    Figure {
        name: "elek-2",
        title: "the roughness clamp",
        source: "O. Elek, Layered Materials in Real-Time Rendering, CESCG 2010, figure 2",
        caption: "A model without sampling does not blur the light that passes through a coat. Elek therefore clamps \
                  the roughness m2 of the lower layer to at least m1, that of the upper layer. The first sheet (m1 / \
                  m2) shows the coat's m1 growing from 0.01 to 0.4: the highlight of the metal widens, and that of \
                  the coat fades. Then it shows m1 0.4 over m2 0.05, with and without the clamp. With the clamp, the \
                  material looks like m2 0.4. Without it, the metal mirrors as sharply as under a smooth coat; \
                  Weidlich and Wilkie's model gives that picture too. The second sheet is not in the paper. It shows \
                  m1 0.4 over m2 0.05 in f64 under two lights. The simulation lies between the two: it is softer \
                  than the model without the clamp and far narrower than the model with it. The clamp avoids the \
                  sharp highlight, so that its RMSE is the smallest. It also greys the whole ball, so that its FLIP \
                  is the largest. The paper offers the clamp as the cure: it trades a highlight that is too narrow for one \
                  that is too wide by a larger factor. `corrected` is Weidlich and Wilkie's model with the factor 1/n^2 and with bounces \
                  inside the coat. Its energy is nearest to the simulation, but its highlight is as sharp as without \
                  the clamp. The metal is chromium of the paper's appendix A; the red coat is luthier's.",
        seen: "The tori are those of the paper: the metal's highlight widens with the coat, and without the clamp it is sharp. The model \
               cannot show more than the paper claims for it: beside the simulation, the clamp greys the ball.",
        size: SMALL,
        claim: Claim {
            text: "The roughness of the coat shapes the reflection of the metal: it gets wider where m1 exceeds m2. Without the \
                  clamp, a metal under a rough coat mirrors more sharply than in the simulation. The clamp brings width and \
                  look of the metal nearer to the simulation.",
            checks: &[
                Check::Falls(&[
                    "coat of m1 0.4 over m2 0.3: width of the metal's highlight",
                    "coat of m1 0.2 over m2 0.3: width of the metal's highlight",
                ]),
                Check::Falls(&[
                    "torus, clamped: width of the metal's highlight",
                    "torus, not clamped: width of the metal's highlight",
                ]),
                Check::Within("ball, no clamp: width of the metal's highlight over that of the simulation", 0.0, 1.0),
                Check::Falls(&[
                    "ball, no clamp: factor between its width and that of the simulation",
                    "ball, clamp: factor between its width and that of the simulation",
                ]),
                Check::Falls(&["ball, no clamp, against simulation: RMSE", "ball, clamp, against simulation: RMSE"]),
                Check::Falls(&[
                    "ball, no clamp, against simulation: mean FLIP",
                    "ball, clamp, against simulation: mean FLIP",
                ]),
            ],
        },
        make: clamp,
    },
    Figure {
        name: "elek-4",
        title: "the mapping of the slope distribution",
        source: "Elek 2010, figure 4",
        caption: "The pictures show a highlight of m = 0.01 through a magnifying glass, with light from the eye. A \
                  table of D that is linear in the angle turns the highlight into a cone of straight pieces, visible \
                  as faint rings. The paper's mapping u^8, and the default table (u^8, logarithmic m, two half \
                  floats), look like the full evaluation; `even m` means equal steps of m. With MIP maps, rows of \
                  other m are mixed in, and the highlight has a hot core in a wide veil. The chart measures the \
                  paper's statement that a linear angle begins to fail below m = 0.02. It also shows an effect that \
                  the paper does not mention: m = 0.01 happens to lie near a row of its table. For smaller m, the \
                  linear axis of m gets nearly as bad as the linear angle, while the logarithmic axis stays \
                  accurate.",
        seen: "The rings of the linear table and the wrong size with MIP maps are seen as in the paper; the mapping u^8 and the full \
               evaluation cannot be told apart. The paper's jaggedness of the MIP maps is not seen, because one level is read for the \
               whole highlight.",
        size: SMALL,
        claim: Claim {
            text: "A table of D that is linear in the angle cannot show a sharp highlight (m 0.01), but does from m 0.02 on. The \
                  mapping u^8 shows it as the full evaluation does. MIP maps make it of a wrong size.",
            checks: &[
                Check::Falls(&[
                    "MIP level 3, m = 0.01: largest error over the peak",
                    "linear angle, m = 0.01: largest error over the peak",
                    "u^8, even m, m = 0.01: largest error over the peak",
                ]),
                // The least contrast that an eye sees is about a hundredth.
                Check::Within("linear angle, m = 0.02: largest error over the peak", 0.0, 0.01),
                Check::Within("linear angle, m = 0.01: largest error over the peak", 0.01, 1.0),
                Check::Within("u^8, even m, m = 0.01: largest error over the peak", 0.0, 0.01),
                // The least difference of lengths that an eye sees is about a fortieth.
                Check::Within(
                    "u^8, even m, m = 0.01: size of the highlight over that of the full evaluation",
                    0.975,
                    1.025,
                ),
                Check::Falls(&[
                    "MIP level 3, m = 0.01: size of the highlight is off by",
                    "u^8, even m, m = 0.01: size of the highlight is off by",
                ]),
                Check::Within("MIP level 3, m = 0.01: size of the highlight is off by", 0.025, 100.0),
            ],
        },
        make: mapping,
    },
    Figure {
        name: "elek-5",
        title: "full evaluation against tables",
        source: "Elek 2010, figure 5",
        caption: "The pictures compare three evaluations: the full one, the tables of the paper's section 3.1 \
                  (Fresnel rows of 128 texels of 8 bits, D in 512 x 512 half floats), and the default tables of \
                  luthier. All three look alike. The differences lie around the highlights, where all terms are \
                  large; they are multiplied by the factors printed below them. The paper found errors of up to 6% \
                  with its material. Both pictures of tables stay far below that.",
        seen: "No difference is seen between full evaluation and tables, as in the paper; the differences had to be multiplied to be \
               shown.",
        size: SMALL,
        claim: Claim {
            text: "Tables of F and D look like the full evaluation; the largest error is below 6 percent.",
            checks: &[
                Check::Within(
                    "tables of the paper against full: largest difference of what a display shows",
                    0.0,
                    0.06,
                ),
                Check::Within("tables of the paper against full: mean FLIP", 0.0, 0.02),
                Check::Within("default tables against full: mean FLIP", 0.0, 0.02),
            ],
        },
        make: tables,
    },
];

/// Chromium of Elek's appendix A under a red coat; the coat is ours.
fn coated(name: &str, alphas: [f64; 2]) -> Outcome<Material> {
    let [coat, base] = alphas;
    let text = format!(
        "schema = 1\nname = \"{name}\"\n\
         [[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = {coat}\ndistribution = \"beckmann\"\n\
         thickness_um = 1\nabsorption_per_um = [0.03, 0.45, 0.6]\n\
         [[layer]]\ntype = \"conductor\"\nalpha = {base}\ndistribution = \"beckmann\"\n\
         ior = {{ n = [3.84, 3.18, 1.99], k = [4.37, 4.41, 4.22], wavelengths_nm = [690, 550, 450] }}\n\
         [bake]\ncolor = \"three-wavelengths\"\nwavelengths_nm = [690, 550, 450]\n"
    );
    material(name, &text)
}

fn clamp(studio: &Studio, made: &mut Made) -> Outcome {
    let series = [0.01, 0.1, 0.2, 0.4];
    let (clamped, bare) = (ShadingModel::Elek, ShadingModel::WeidlichWilkie);
    let mut materials = Vec::new();
    let mut labels = Vec::new();
    for (i, alpha) in series.into_iter().enumerate() {
        materials.push(shaded(&coated("coated", [alpha, 0.3])?, &format!("series-{i}"), clamped));
        labels.push(format!("{alpha} / 0.3"));
    }
    let odd = coated("odd", [0.4, 0.05])?;
    materials.push(shaded(&odd, "clamped", clamped));
    materials.push(shaded(&odd, "bare", bare));
    labels.extend(["clamped", "not clamped"].map(str::to_owned));
    let pictures = studio.pictures(&materials, Form::Baked, Shape::Torus, |_, _| {})?;
    for (alpha, picture) in series.iter().zip(&pictures) {
        made.measure(format!("coat of m1 {alpha} over m2 0.3: brightest radiance"), brightest(picture));
        made.measure(format!("coat of m1 {alpha} over m2 0.3: width of the metal's highlight"), metal_width(picture));
    }
    if let [.., with, without] = pictures.as_slice() {
        made.measure("torus, clamped: width of the metal's highlight", metal_width(with));
        made.measure("torus, not clamped: width of the metal's highlight", metal_width(without));
        made.apart("tori m1 0.4, m2 0.05, with against without the clamp", with, without)?;
    }
    made.sheet("elek-2", labels.into_iter().zip(pictures), 6);

    let reference = studio.simulated(&odd)?;
    let mut balls = vec![("simulation".to_owned(), reference.image.clone())];
    made.measure("simulation: noise, in units of the RMSE", reference.noise);
    for (label, model) in
        [("clamp", "elek"), ("no clamp", "weidlich-wilkie"), ("corrected", "weidlich-wilkie-corrected")]
    {
        let ball = studio.ball(&odd, model)?;
        let apart = compared(&ball, &reference.image)?;
        made.measure(format!("ball, {label}, against simulation: RMSE"), apart.rms_err);
        made.measure(format!("ball, {label}, against simulation: mean FLIP"), apart.flip_mean);
        let energy = light(&ball) / light(&reference.image);
        made.measure(format!("ball, {label}: mean radiance over that of the simulation"), energy);
        balls.push((label.to_owned(), ball));
    }
    if let [(_, simulated), others @ ..] = balls.as_slice() {
        let simulated = metal_width(&softened(simulated));
        for (label, ball) in others {
            let ratio = metal_width(&softened(ball)) / simulated.max(1e-9);
            made.measure(format!("ball, {label}: width of the metal's highlight over that of the simulation"), ratio);
            let factor = ratio.max(1.0 / ratio.max(1e-9));
            made.measure(format!("ball, {label}: factor between its width and that of the simulation"), factor);
        }
    }
    made.sheet("elek-2-simulation", balls, 4);
    Ok(())
}

/// Red over blue of the key light, and so of what a coat reflects.
pub(super) const KEY_RED_OVER_BLUE: f64 = 1.75 / 1.62;

/// Width of the highlight of a metal under a red coat: the root of the share of the picture where it is at least half as bright
/// as at its peak. Red less blue is the light of the metal, because the coat reflects without colour.
fn metal_width(picture: &Image) -> f64 {
    spot_of(picture, |[red, _, blue]| red - KEY_RED_OVER_BLUE * blue).share.sqrt()
}

/// Slope parameters at which tables are compared, and the number of the one in figure 4.
const SHARP: [f64; 6] = [0.05, 0.02, 0.01, 0.005, 0.0025, 0.00125];
const SHOWN: usize = 2;

/// Half the side of the picture over the slope parameter, and distance of the eye.
const ZOOM: [f64; 2] = [3.3, 7.0];

/// Metal alone, one for each slope parameter.
fn sharp() -> Outcome<Vec<Material>> {
    let metals = SHARP.into_iter().enumerate().map(|(i, alpha)| {
        let mut metal = coated("sharp", [alpha, alpha])?;
        metal.stack.layers.remove(0);
        metal.layers.remove(0);
        Ok(shaded(&metal, &format!("sharp-{i}"), ShadingModel::Elek))
    });
    metals.collect()
}

fn mapping(studio: &Studio, made: &mut Made) -> Outcome {
    let metals = sharp()?;
    let dark = even_sky(0.0)?;
    let render = |form: Form, angle: Option<DistributionMapping>| {
        let mut variants = metals.clone();
        for variant in &mut variants {
            if let Some(angle) = angle {
                elek_tables(&mut variant.bake, angle);
            }
        }
        studio.pictures(&variants, form, Shape::Sphere, |n: usize, settings| {
            let alpha = SHARP[n];
            let [extent, distance] = [ZOOM[0] * alpha, ZOOM[1]].map(|v| v as f32);
            settings.camera = Camera { eye: [0.0, 0.0, distance], target: [0.0; 3], half_extent: extent };
            settings.lights = vec![Light::Directional { direction: [0.0, 0.0, 1.0], irradiance: [1.0; 3] }];
            settings.light_angular_radius = 0.0;
            settings.environment = dark.clone();
            settings.environment_samples = 1;
            settings.samples = 1;
            // The peak is F D / 4 with D = 1 / (pi m^2): to about 1.
            settings.exposure = (8.0 * PI * alpha * alpha) as f32;
        })
    };
    let full = render(Form::Full, None)?;
    let tables = [
        ("linear angle", PlotColor::Red, render(Form::Baked, Some(DistributionMapping::Linear))?),
        ("u^8, even m", PlotColor::Blue, render(Form::Baked, Some(DistributionMapping::Power))?),
        ("u^8, log m", PlotColor::Ink, render(Form::Baked, None)?),
    ];
    let mut curves = Vec::new();
    let mut shown = Vec::new();
    for (label, color, pictures) in &tables {
        let errors =
            SHARP.iter().zip(pictures.iter().zip(&full)).map(|(alpha, (image, full))| [*alpha, error(image, full)]);
        let points: Vec<[f64; 2]> = errors.collect();
        for [alpha, error] in &points {
            made.measure(format!("{label}, m = {alpha}: largest error over the peak"), *error);
        }
        curves.push(Curve { name: (*label).to_owned(), color: *color, points });
        shown.push(((*label).to_owned(), pictures[SHOWN].clone()));
    }
    let mipped = mipped(&full[SHOWN], SHARP[SHOWN]);
    made.measure("MIP level 3, m = 0.01: largest error over the peak", error(&mipped, &full[SHOWN]));
    for (label, picture) in [("u^8, even m", &tables[1].2[SHOWN]), ("MIP level 3", &mipped)] {
        let ratio = spot(picture).share.sqrt() / spot(&full[SHOWN]).share.sqrt().max(1e-9);
        made.measure(format!("{label}, m = 0.01: size of the highlight over that of the full evaluation"), ratio);
        made.measure(format!("{label}, m = 0.01: size of the highlight is off by"), (ratio - 1.0).abs());
    }
    shown.push(("full".to_owned(), full[SHOWN].clone()));
    shown.push(("MIP level 3".to_owned(), mipped));
    made.sheet("elek-4", shown, 5);
    made.plot(
        "elek-4-error",
        Plot {
            title: "Error of the table of D against the slope parameter".to_owned(),
            x: PlotAxis::new("slope parameter m", [0.0, 1.0], 0.0),
            y: PlotAxis::new("largest error of a highlight over its peak", [0.0, 1.0], 0.0),
            curves,
        },
    );
    Ok(())
}

/// Largest difference of the green channel, over its peak.
fn error(image: &Image, full: &Image) -> f64 {
    let [image, full] = [image, full].map(|image| image.texels().map(|texel| texel[1]).collect::<Vec<f32>>());
    let peak = full.iter().copied().fold(0.0, f32::max);
    f64::from(image.iter().zip(&full).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max) / peak)
}

/// Sum over all pixels and channels.
pub(super) fn light(image: &Image) -> f64 {
    image.data.iter().map(|v| f64::from(*v)).sum()
}

/// The tables of Elek's section 3.1: rows of 128 texels of 8 bits, 512 x 512 half floats.
fn elek_tables(bake: &mut BakeSettings, angle: DistributionMapping) {
    bake.fresnel.size = Some(128);
    bake.fresnel.format = Some(TexelFormat::Rgba8Unorm);
    bake.fresnel.mapping = Some(FresnelMapping::Theta);
    bake.distribution.size = Some([512, 512]);
    bake.distribution.format = Some(TexelFormat::R16Float);
    bake.distribution.mapping = Some(angle);
    bake.distribution.alpha_mapping = Some(AlphaMapping::Linear);
}

/// Angle of the half vector to the normal at a pixel of the zoomed ball; light and eye both at +z.
fn half_angle(x: u32, y: u32, size: u32, alpha: f64) -> f64 {
    let [extent, distance] = [ZOOM[0] * alpha, ZOOM[1]];
    // Angle of the ray at the eye, then of the normal, by the law of sines.
    let ray = libm::atan(libm::hypot(across(x, size) * extent, across(y, size) * extent) / distance);
    let normal = libm::asin((distance * libm::sin(ray)).min(1.0)) - ray;
    // Light and eye differ by the angle of the ray: the half vector lies between.
    normal + 0.5 * ray
}

/// The highlight with D from level 3 of the MIP chain of Elek's table (D itself, linear m): each texel the mean of 8 x 8.
fn mipped(full: &Image, alpha: f64) -> Image {
    const SIDE: u32 = 512;
    const BLOCK: u32 = 8;
    const LARGEST_HALF: f64 = 65504.0;
    let mut table = Image::zeros(SIDE / BLOCK, SIDE / BLOCK, 1);
    for j in 0..SIDE {
        for i in 0..SIDE {
            let [u, m] = [i, j].map(|i| (f64::from(i) + 0.5) / f64::from(SIDE));
            let value = beckmann(FRAC_PI_2 * libm::pow(u, 8.0), m).min(LARGEST_HALF);
            table.texel_mut(i / BLOCK, j / BLOCK)[0] += (value / f64::from(BLOCK * BLOCK)) as f32;
        }
    }
    let peaks = [0, 1, 2].map(|c: usize| full.texels().map(|texel| texel[c]).fold(0.0, f32::max));
    let mut image = full.clone();
    let texels = f64::from(SIDE / BLOCK);
    for (x, y) in pixels(full) {
        let u = libm::pow(half_angle(x, y, image.width, alpha) / FRAC_PI_2, 0.125);
        let read = bilinear(&table, [u * texels, alpha * texels], WeightBits::Fixed(8))[0];
        let ratio = (read / beckmann(0.0, alpha)) as f32;
        image.texel_mut(x, y).copy_from_slice(&peaks.map(|peak| peak * ratio));
    }
    image
}

fn beckmann(theta: f64, m: f64) -> f64 {
    let (tan, cos) = (libm::tan(theta), libm::cos(theta));
    libm::exp(-tan * tan / (m * m)) / (PI * m * m * cos * cos * cos * cos)
}

fn tables(studio: &Studio, made: &mut Made) -> Outcome {
    let ours = shaded(&coated("coated", [0.08, 0.3])?, "coated", ShadingModel::Elek);
    let mut his = ours.clone();
    elek_tables(&mut his.bake, DistributionMapping::Power);
    let full = studio.picture(ours.clone(), Form::Full, Shape::Torus)?;
    let [his, ours] = [his, ours].map(|material| studio.picture(material, Form::Baked, Shape::Torus));
    let (his, ours) = (his?, ours?);
    let his_difference = made.compare("tables of the paper against full", &his, &full)?;
    let our_difference = made.compare("default tables against full", &ours, &full)?;
    let shown = [("full", full), ("its tables", his), ("our tables", ours)];
    let [full, his, ours] = shown.map(|(label, image)| (label.to_owned(), super::figure::TONE.image(image)));
    made.shown("elek-5", vec![full, his, his_difference, ours, our_difference], 5);
    Ok(())
}
