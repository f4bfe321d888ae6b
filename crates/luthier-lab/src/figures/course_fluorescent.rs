//! The figure of the course of Weidlich and Wilkie about a fluorescent base under a rough varnish.

use glam::DVec3;
use luthier_layers::effects::fluorescence::Fluorescent;
use luthier_layers::monochrome::Monochrome;
use luthier_lut::Image;
use luthier_terminal::{Failure, Outcome};

use super::claim::{Check, Claim};
use super::figure::{Figure, LARGE, Made};
use super::numbers::across;
use super::studio::{Studio, material};

pub(crate) const FIGURES: [Figure; 1] = [Figure {
    name: "course-5-6",
    title: "a green laser on orange day-glo cardboard",
    source: "Weidlich and Wilkie 2009, figures 5.4 to 5.6",
    caption: "Light of 532 nm falls in from the left on a rough varnish, slope 17 degrees, over a base that sends 0.7 of it out at 600 nm and 0.05 at 532 nm. The \
              course calls 5 degrees grazing: its angles are those to the surface. Each picture is the hemisphere of the eye seen from above: its middle is the normal, its edge the horizon. The facets of the varnish mirror in green, \
              forward of the normal, and the base glows orange everywhere. The numbers are the shares of the light that leave in green and in orange, and how far to the right \
              the light of each lies, in radii. Matrix and index (1.5) are luthier's: at 60 degrees their varnish mirrors 4 of 100 parts in green, and their base sends out 5 unchanged, so that a little more than \
              a tenth of what leaves is green.",
    size: LARGE,
    claim: Claim {
        text: "The base glows in orange, and the varnish mirrors in green, forward, the more the flatter the light falls in. At 60 \
               degrees to the surface practically all that leaves is orange.",
        checks: &[
            Check::Falls(&["5 degrees: leaves in green", "20 degrees: leaves in green", "60 degrees: leaves in green"]),
            // Almost no green: a tenth at most.
            Check::Within("60 degrees: green of all that leaves", 0.0, 0.1),
            Check::Within("5 degrees: forward, green over orange", 1.0, 1e6),
            Check::Falls(&["5 degrees: green, to the right", "5 degrees: orange, to the right"]),
            Check::Falls(&["20 degrees: green, to the right", "20 degrees: orange, to the right"]),
            // The base looks the same from all sides, so the middle of its light is the middle of the disk.
            Check::Within("5 degrees: orange, to the right", -0.05, 0.05),
            Check::Within("60 degrees: orange, to the right", -0.05, 0.05),
        ],
    },
    make: cardboard,
}];

/// Angles of the light to the surface, degrees.
const ANGLES: [f64; 3] = [5.0, 20.0, 60.0];

/// Factor on radiance under light of irradiance 1.
const EXPOSURE: f64 = 4.0;

/// Green and orange of the two wavelengths, linear Rec.709.
const COLORS: [[f64; 3]; 2] = [[0.0, 1.0, 0.15], [1.0, 0.32, 0.0]];

fn cardboard(studio: &Studio, made: &mut Made) -> Outcome {
    let text = "schema = 1\nname = \"cardboard\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nslope_deg = 17\ndistribution = \"beckmann\"\n\
                [[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n";
    let stack = material("cardboard", text)?.stack;
    let coats = [532.0, 600.0].map(|nm| Monochrome::new(&stack, nm, 1)).to_vec();
    // Rows are bins of the light that comes out, columns bins of the light that falls in.
    let surface = Fluorescent::new(coats, &[0.05, 0.0, 0.7, 0.7]).map_err(Failure::input)?;
    let size = studio.size;
    let mut pictures = Vec::new();
    for angle in ANGLES {
        let (sin, cos) = libm::sincos((90.0 - angle).to_radians());
        let wi = DVec3::new(-sin, 0.0, cos);
        let mut image = Image::zeros(size, size, 3);
        let (mut leaving, mut aside, mut forward) = ([0.0; 2], [0.0; 2], [0.0_f64; 2]);
        for (texel, i) in image.data.chunks_mut(3).zip(0..) {
            let [x, y] = [i % size, i / size].map(|i| across(i, size));
            let z_sq = 1.0 - x * x - y * y;
            if z_sq <= 0.0 {
                continue;
            }
            let wo = DVec3::new(x, -y, z_sq.sqrt());
            for (bin, color) in COLORS.iter().enumerate() {
                let radiance = surface.eval(wi, 0, wo, bin);
                // A pixel of the disk is a projected solid angle.
                let light = 4.0 * radiance / f64::from(size * size);
                leaving[bin] += light;
                aside[bin] += light * x;
                if x > 0.0 {
                    forward[bin] = forward[bin].max(radiance);
                }
                for (value, color) in texel.iter_mut().zip(color) {
                    *value += (EXPOSURE * radiance / cos * color) as f32;
                }
            }
        }
        let [green, orange] = leaving;
        made.measure(format!("{angle} degrees: leaves in green"), green / cos);
        made.measure(format!("{angle} degrees: leaves in orange"), orange / cos);
        made.measure(format!("{angle} degrees: green of all that leaves"), green / (green + orange));
        made.measure(format!("{angle} degrees: green, to the right"), aside[0] / green);
        made.measure(format!("{angle} degrees: orange, to the right"), aside[1] / orange);
        made.measure(format!("{angle} degrees: forward, green over orange"), forward[0] / forward[1]);
        pictures.push((format!("{angle} degrees"), image));
    }
    made.sheet("course-5-6", pictures, 3);
    Ok(())
}
