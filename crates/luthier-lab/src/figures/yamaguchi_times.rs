//! The figure of Yamaguchi et al. 2019 about times, from the measurements of `luthier-lab simulation`.

use luthier_report::{Curve, Plot, PlotAxis, PlotColor};
use luthier_terminal::{Failure, Outcome};
use serde_json::Value;

use super::claim::{Check, Claim};
use super::figure::{Figure, Made, SMALL};
use super::studio::Studio;

pub(crate) const FIGURES: [Figure; 1] = [Figure {
    name: "yamaguchi-5",
    title: "time of the anisotropic model over that of the isotropic one",
    source: "Yamaguchi et al. 2019, figure 5",
    caption: "The left chart of the paper has the times of a picture by Belcour's model and by Yamaguchi's, over the samples of a pixel; the right one says by how many \
              percent the second takes longer. Here are both for an anisotropic material and an isotropic one. Times are medians of three pictures of 512 pixels a side on a GPU, from \
              `docs/measurements/simulation-gpu.json`, which `luthier-lab simulation` wrote; the file names the GPU. Pictures of few samples take milliseconds that vary by more \
              than the models differ; the verdict goes by the largest number of samples. gpu-simulation.md has the times of the simulation beside them.",
    seen: "The curves of both models lie together and grow in a straight line with the samples, as in the paper; the percentages are noisy \
           where a picture takes milliseconds.",
    size: SMALL,
    claim: Claim {
        text: "Anisotropic layers cost little more time than isotropic ones (at most 10 percent with 2048 samples).",
        checks: &[
            Check::Within("yamaguchi-brushed, 2048 samples: percent more than belcour", -10.0, 10.0),
            Check::Within("silver-paint, 2048 samples: percent more than belcour", -10.0, 10.0),
        ],
    },
    make: times,
}];

const TIMES: &str = include_str!("../../../../docs/measurements/simulation-gpu.json");

/// Materials of the measurements, with the colours of their curves: of one model and of the other.
const MATERIALS: [(&str, [PlotColor; 2]); 2] =
    [("yamaguchi-brushed", [PlotColor::Ink, PlotColor::Red]), ("silver-paint", [PlotColor::Blue, PlotColor::Green])];

/// Median milliseconds by samples, of a material and a model.
fn medians(all: &Value, material: &str, way: &str) -> Vec<[f64; 2]> {
    let times = all["times"].as_array().into_iter().flatten();
    let of = times.filter(|time| time["material"] == material && time["way"] == way);
    of.filter_map(|time| Some([time["samples"].as_f64()?, time["median_ms"].as_f64()?])).collect()
}

fn times(_: &Studio, made: &mut Made) -> Outcome {
    let all: Value = serde_json::from_str(TIMES).map_err(Failure::input)?;
    let (mut absolute, mut percent) = (Vec::new(), Vec::new());
    for (material, colors) in MATERIALS {
        let ways = ["belcour", "yamaguchi"];
        let [isotropic, anisotropic] = ways.map(|way| medians(&all, material, way));
        let points: Vec<[f64; 2]> =
            isotropic.iter().zip(&anisotropic).map(|(a, b)| [a[0], 100.0 * (b[1] / a[1] - 1.0)]).collect();
        for [samples, percent] in &points {
            made.measure(format!("{material}, {samples} samples: percent more than belcour"), *percent);
        }
        for ((way, color), points) in ways.into_iter().zip(colors).zip([isotropic, anisotropic]) {
            absolute.push(Curve { name: format!("{material}, {way}"), color, points });
        }
        percent.push(Curve { name: material.to_owned(), color: colors[0], points });
    }
    let x = PlotAxis::new("samples of a pixel", [0.0, 2048.0], 512.0);
    let title = "Time of a picture against the samples of a pixel".to_owned();
    made.plot("yamaguchi-5", Plot { title, x: x.clone(), y: axis_over("milliseconds", &absolute), curves: absolute });
    let title = "Time of Yamaguchi's model over Belcour's".to_owned();
    made.plot("yamaguchi-5-more", Plot { title, x, y: axis_over("percent more", &percent), curves: percent });
    Ok(())
}

/// The next larger of 1, 2 and 5 times a power of ten.
fn round_step(step: f64) -> f64 {
    let power = libm::exp10(libm::log10(step.max(1e-9)).floor());
    [1.0, 2.0, 5.0].map(|digit| digit * power).into_iter().find(|round| *round >= step).unwrap_or(10.0 * power)
}

/// An axis over the values of curves, in round steps.
fn axis_over(label: &str, curves: &[Curve]) -> PlotAxis {
    let values = curves.iter().flat_map(|curve| &curve.points).map(|point| point[1]);
    let [least, most] = values.fold([0.0, 0.0_f64], |[least, most], v| [v.min(least), v.max(most)]);
    let step = round_step((most - least) / 5.0);
    PlotAxis::new(label, [step * (least / step).floor(), step * (most / step).ceil()], step)
}
