//! The figure of Yamaguchi et al. 2019 that compares with simulation.

use luthier_lut::Image;
use luthier_report::brightened_difference;
use luthier_terminal::Outcome;

use super::claim::{Check, Claim};
use super::figure::{Figure, Made, SIMULATED, TONE, compared};
use super::studio::Studio;
use super::yamaguchi_balls::brushed;

pub(crate) const FIGURES: [Figure; 1] = [Figure {
    name: "yamaguchi-4",
    title: "statistical layering against simulation",
    source: "T. Yamaguchi et al., Real-time Rendering of Layered Materials with Anisotropic Normal Distributions, SIGGRAPH Asia 2019 \
             Technical Briefs, figure 4",
    caption: "The pictures show a coat of index 1.49 on gold (figure 1 (e)) under two lights, in f64. From left to \
              right they are the simulation, Yamaguchi's model and its difference, Belcour's model and its \
              difference. The highlights of Yamaguchi's model have the shapes of the simulated ones: round, \
              stretched along the brushing, and crossed where the coat is brushed across. Those of Belcour's model \
              are always round. Both models are too dark around the highlights and towards the rim, where the paper \
              finds errors too. Where the brushings cross, Belcour's RMSE is still the smaller one, because \
              Yamaguchi's band across the ball has the right shape but is too faint. The slopes are luthier's, because the \
              paper's supplement, which states its own, was not available. So its RMSE values cannot be compared.",
    size: SIMULATED,
    claim: Claim {
        text: "Highlights of anisotropic layers are those of the simulation, and nearer to it than Belcour's, which are \
              isotropic.",
        checks: &[
            Check::Falls(&[
                "one way, belcour against simulation: RMSE less the noise",
                "one way, yamaguchi against simulation: RMSE less the noise",
            ]),
            Check::Falls(&[
                "crossed, belcour against simulation: RMSE less the noise",
                "crossed, yamaguchi against simulation: RMSE less the noise",
            ]),
        ],
    },
    make: simulation,
}];

/// Brushings as their names say; the paper's numbers are in a supplement that we do not have.
const BRUSHINGS: [(&str, [f64; 3], [f64; 3]); 3] = [
    ("isotropic", [0.1, 0.1, 0.0], [0.3, 0.3, 0.0]),
    ("one way", [0.25, 0.06, 0.0], [0.45, 0.12, 0.0]),
    ("crossed", [0.25, 0.06, 90.0], [0.45, 0.12, 0.0]),
];

fn simulation(studio: &Studio, made: &mut Made) -> Outcome {
    let mut pictures: Vec<(String, Image)> = Vec::new();
    for (name, coat, base) in BRUSHINGS {
        let material = brushed("brushed", coat, base, "")?;
        let reference = studio.simulated(&material)?;
        pictures.push((name.to_owned(), TONE.image(reference.image.clone())));
        made.measure(format!("{name}, simulation: noise, in units of the RMSE"), reference.noise);
        for model in ["yamaguchi", "belcour"] {
            let image = studio.ball(&material, model)?;
            let rms = compared(&image, &reference.image)?.rms_err;
            made.measure(format!("{name}, {model} against simulation: RMSE"), rms);
            // Errors of the simulation are independent of those of the model.
            let own = (rms * rms - reference.noise * reference.noise).max(0.0).sqrt();
            made.measure(format!("{name}, {model} against simulation: RMSE less the noise"), own);
            pictures.push((model.to_owned(), TONE.image(image.clone())));
            let (apart, gain) = brightened_difference(&image, &reference.image, |v| TONE.value(v));
            pictures.push((format!("diff. x{gain}"), apart));
        }
    }
    made.shown("yamaguchi-4", pictures, 5);
    Ok(())
}
