//! The figure of Yamaguchi et al. 2019 that compares with simulation.

use luthier_lut::Image;
use luthier_material::Material;
use luthier_report::brightened_difference;
use luthier_terminal::Outcome;

use super::claim::{Check, Claim};
use super::figure::{Figure, Made, SIMULATED, TONE, compared};
use super::studio::{Studio, material};

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

/// Slopes along and across the tangent, and its turn in degrees, of coat and base.
struct Brushing {
    name: &'static str,
    coat: [f64; 3],
    base: [f64; 3],
}

/// Brushings as their names say; the paper's numbers are in a supplement that we do not have.
const BRUSHINGS: [Brushing; 3] = [
    Brushing { name: "isotropic", coat: [0.1, 0.1, 0.0], base: [0.3, 0.3, 0.0] },
    Brushing { name: "one way", coat: [0.25, 0.06, 0.0], base: [0.45, 0.12, 0.0] },
    Brushing { name: "crossed", coat: [0.25, 0.06, 90.0], base: [0.45, 0.12, 0.0] },
];

/// Figure 1 (e): coat of 1.49 on gold. Wavelengths are labels, see `materials/papers/yamaguchi-brushed.toml`.
fn brushed(brushing: &Brushing) -> Outcome<Material> {
    let surface = |[x, y, turn]: [f64; 3]| {
        if x == y { format!("alpha = {x}") } else { format!("alpha_x = {x}\nalpha_y = {y}\nrotation_deg = {turn}") }
    };
    let text = format!(
        "schema = 1\nname = \"brushed\"\n\
         [[layer]]\ntype = \"dielectric\"\nior = 1.49\n{}\n\
         [[layer]]\ntype = \"conductor\"\n{}\n\
         ior = {{ n = [0.143, 0.373, 1.444], k = [3.983, 2.387, 1.602], wavelengths_nm = [690, 550, 450] }}\n\
         [bake]\ncolor = \"three-wavelengths\"\nwavelengths_nm = [690, 550, 450]\n",
        surface(brushing.coat),
        surface(brushing.base)
    );
    material(brushing.name, &text)
}

fn simulation(studio: &Studio, made: &mut Made) -> Outcome {
    let mut pictures: Vec<(String, Image)> = Vec::new();
    for brushing in &BRUSHINGS {
        let material = brushed(brushing)?;
        let reference = studio.simulated(&material)?;
        let shown = |label: &str, image: &Image| (label.to_owned(), TONE.image(image.clone()));
        pictures.push(shown(brushing.name, &reference.image));
        made.measure(format!("{}, simulation: noise, in units of the RMSE", brushing.name), reference.noise);
        for model in ["yamaguchi", "belcour"] {
            let image = studio.ball(&material, model)?;
            let rms = compared(&image, &reference.image)?.rms_err;
            made.measure(format!("{}, {model} against simulation: RMSE", brushing.name), rms);
            // Errors of the simulation are independent of those of the model.
            let own = (rms * rms - reference.noise * reference.noise).max(0.0).sqrt();
            made.measure(format!("{}, {model} against simulation: RMSE less the noise", brushing.name), own);
            pictures.push(shown(model, &image));
            let (apart, gain) = brightened_difference(&image, &reference.image, |v| TONE.value(v));
            pictures.push((format!("diff. x{gain}"), apart));
        }
    }
    made.shown("yamaguchi-4", pictures, 5);
    Ok(())
}
