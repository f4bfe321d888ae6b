//! The figure of Yamaguchi et al. 2019 that compares with simulation.

use luthier_lut::Image;
use luthier_report::brightened_difference;
use luthier_terminal::Outcome;

use super::claim::{Check, Claim};
use super::elek::KEY_RED_OVER_BLUE;
use super::figure::{Figure, Made, SIMULATED, TONE, compared};
use super::numbers::places::ball_normal;
use super::numbers::spot::{Spot, softened, spot_of};
use super::numbers::{across, pixels};
use super::studio::Studio;
use super::yamaguchi_balls::{BALLS, brushed};

pub(crate) const FIGURES: [Figure; 1] = [Figure {
    name: "yamaguchi-4",
    title: "statistical layering against simulation",
    source: "T. Yamaguchi et al., Real-time Rendering of Layered Materials with Anisotropic Normal Distributions, SIGGRAPH Asia 2019 \
             Technical Briefs, figure 4",
    caption: "The pictures show (a), (b) and (d) of figure 1 under two lights, in f64, on balls whose tangents are level: a coat of index 1.49 on the printed base of index (1 + 1i, 1, 1). From left to \
              right they are the simulation, Yamaguchi's model and its difference, and Belcour's model and its difference, which the paper's figure does not have. \
              The base is dark: all pictures have 2.5 times the exposure. The length of a highlight is that of red less blue, the light of the base; the rim is beyond three quarters of the radius. The model stretches highlights by a third less than the simulation does. The slopes are those of \
              luthier's figure 1, because the paper's supplement, which states its own, was not available. So its RMSE values cannot be compared.",
    seen: "The highlights of Yamaguchi's model have the shapes of the simulation, round and long, and its differences are broad and dim. \
           Belcour's are round where they should be long.",
    size: SIMULATED,
    claim: Claim {
        text: "The highlights look like those of the reference: round in (a), and stretched along the tangent in (b) and (d), as \
              Belcour's are not. Errors are rather large at the rim, where one looks along the surface.",
        checks: &[
            Check::Within(
                "a isotropic, yamaguchi: length of the base's highlight over that of the simulation",
                0.8,
                1.25,
            ),
            Check::Falls(&[
                "b base, yamaguchi: length of the base's highlight over its height",
                "b base, belcour: length of the base's highlight over its height",
            ]),
            Check::Falls(&[
                "d one way, yamaguchi: length of the base's highlight over its height",
                "d one way, belcour: length of the base's highlight over its height",
            ]),
            Check::Falls(&[
                "b base, belcour against simulation: RMSE less the noise",
                "b base, yamaguchi against simulation: RMSE less the noise",
            ]),
            Check::Falls(&[
                "d one way, belcour against simulation: RMSE less the noise",
                "d one way, yamaguchi against simulation: RMSE less the noise",
            ]),
            Check::Falls(&["a isotropic, yamaguchi: RMSE at the rim", "a isotropic, yamaguchi: RMSE in the middle"]),
            Check::Falls(&["b base, yamaguchi: RMSE at the rim", "b base, yamaguchi: RMSE in the middle"]),
            Check::Falls(&["d one way, yamaguchi: RMSE at the rim", "d one way, yamaguchi: RMSE in the middle"]),
        ],
    },
    make: simulation,
}];

/// The balls of figure 1 that figure 4 has: (a), (b) and (d).
const COMPARED: [usize; 3] = [0, 1, 3];

/// Factor on radiance: the base is dark.
const BRIGHTER: f32 = 2.5;

/// Share of the radius from which a place is at the rim.
const RIM: f64 = 0.75;

fn simulation(studio: &Studio, made: &mut Made) -> Outcome {
    let mut pictures: Vec<(String, Image)> = Vec::new();
    for (name, coat, base, ior) in COMPARED.map(|n| BALLS[n]) {
        let material = brushed("brushed", coat, base, ior, "")?;
        let simulated = studio.simulated(&material)?;
        let noise = simulated.noise * f64::from(BRIGHTER);
        let reference = brighter(simulated.image);
        pictures.push((name.to_owned(), TONE.image(reference.clone())));
        made.measure(format!("{name}, simulation: noise, in units of the RMSE"), noise);
        for model in ["yamaguchi", "belcour"] {
            let image = brighter(studio.ball(&material, model)?);
            let rms = compared(&image, &reference)?.rms_err;
            made.measure(format!("{name}, {model} against simulation: RMSE"), rms);
            // Errors of the simulation are independent of those of the model.
            let own = (rms * rms - noise * noise).max(0.0).sqrt();
            made.measure(format!("{name}, {model} against simulation: RMSE less the noise"), own);
            let [middle, rim] = zones(&image, &reference);
            made.measure(format!("{name}, {model}: RMSE in the middle"), middle);
            made.measure(format!("{name}, {model}: RMSE at the rim"), rim);
            let [here, there] = [&image, &reference].map(|image| base_light(image).elongation());
            made.measure(format!("{name}, {model}: length of the base's highlight over its height"), here);
            let ratio = here / there.max(1e-9);
            made.measure(format!("{name}, {model}: length of the base's highlight over that of the simulation"), ratio);
            pictures.push((model.to_owned(), TONE.image(image.clone())));
            let (apart, gain) = brightened_difference(&image, &reference, |v| TONE.value(v));
            pictures.push((format!("diff. x{gain}"), apart));
        }
    }
    made.shown("yamaguchi-4", pictures, 5);
    Ok(())
}

fn brighter(mut image: Image) -> Image {
    image.data.iter_mut().for_each(|value| *value *= BRIGHTER);
    image
}

/// The highlight of the base under the key light, which stands on the left: red less blue, because the coat reflects without colour.
fn base_light(image: &Image) -> Spot {
    let mut left = image.clone();
    for (x, y) in pixels(image) {
        if across(x, image.width) > 0.3 {
            left.texel_mut(x, y).fill(0.0);
        }
    }
    spot_of(&softened(&left), |[red, _, blue]| red - KEY_RED_OVER_BLUE * blue)
}

/// Root mean square differences of two pictures of a ball: in its middle, and at its rim.
fn zones(a: &Image, b: &Image) -> [f64; 2] {
    let mut sums = [[0.0, 0.0]; 2];
    for (x, y) in pixels(a) {
        let Some([nx, ny, _]) = ball_normal([across(x, a.width), across(y, a.height)]) else { continue };
        let [sum, count] = &mut sums[usize::from(libm::hypot(nx, ny) > RIM)];
        for (a, b) in a.texel(x, y).iter().zip(b.texel(x, y)) {
            let apart = f64::from(a - b);
            *sum += apart * apart;
            *count += 1.0;
        }
    }
    sums.map(|[sum, count]| (sum / f64::max(count, 1.0)).sqrt())
}
