//! A model that shows what materials do: a ball of two shells with a cut, on a stand with rims, over a plain floor.
//!
//! The ball has the texture coordinates of a sphere. Turned surfaces have tangents around the axis; the faces of the
//! cut have outward tangents. Lengths are in units of the file: the floor is at height 0 and the ball has a radius of
//! 0.8.

mod lathe;
mod write;

use std::f64::consts::PI;

use crate::{Mesh, soup};
use lathe::{Curve, OUTER, Part};

/// The model as binary glTF, as [`glb`] makes it. It is stored so that other programs can use the file.
pub const GLB: &[u8] = include_bytes!("../../assets/model.glb");

/// Albedo of the floor, linear.
const FLOOR: f64 = 0.36;

/// Height of the middle of the ball, and radii of the hollow and of the ball within.
const MIDDLE: f64 = 1.1;
const HOLLOW: f64 = 0.7;
const INNER: f64 = 0.5;

/// The cut: azimuths between which the shell is open, from +z towards +x, and its lower end against the middle.
const CUT: [f64; 2] = [0.2, 1.5];
const CUT_HEIGHT: f64 = -0.06;

/// The model, ready for rays.
pub fn mesh() -> Mesh {
    let file = soup(GLB, &|_| Err(std::io::ErrorKind::NotFound.into())).expect("a test reads it");
    Mesh::new(file.soup).expect("a test makes it")
}

/// Builds the bytes of the model, which are equal on every platform.
pub fn glb() -> Vec<u8> {
    let mut shown = Part::default();
    shell(&mut shown);
    let ball = Curve::arc([0.0, MIDDLE], INNER, [-0.5 * PI, 0.5 * PI], 26);
    shown.turned(&[ball], [-PI, PI], 48);
    shown.turned(&stand(), [-PI, PI], 60);
    write::glb(&shown, &floor(), FLOOR)
}

/// The outer ball, its hollow, and the faces of the cut.
fn shell(part: &mut Part) {
    // Begins where the collar of the stand hides it.
    let below = Curve::arc([0.0, MIDDLE], OUTER, [-0.42 * PI, cut_angle(OUTER)], 15);
    part.turned(&[below], [-PI, PI], 64);
    let closed = [CUT[1], CUT[0] + 2.0 * PI];
    part.turned(&[above(OUTER, 20)], closed, 54);
    part.turned(&[above(HOLLOW, 14).reversed()], closed, 42);
    let bowl = Curve::arc([0.0, MIDDLE], HOLLOW, [-0.5 * PI, cut_angle(HOLLOW)], 10);
    part.turned(&[bowl.reversed()], [-PI, PI], 48);
    let [outer, hollow] = [OUTER, HOLLOW].map(|radius| [radius * libm::cos(cut_angle(radius)), MIDDLE + CUT_HEIGHT]);
    part.turned(&[Curve::line(outer, hollow)], CUT, 16);
    for (azimuth, faces_forward) in [(CUT[0], true), (CUT[1], false)] {
        part.face(&above(OUTER, 20), &above(HOLLOW, 20), azimuth, faces_forward);
    }
}

/// Angle of the lower end of the cut, from the middle of a ball.
fn cut_angle(radius: f64) -> f64 {
    libm::asin(CUT_HEIGHT / radius)
}

/// The part of a ball above the lower end of the cut.
fn above(radius: f64, rows: u32) -> Curve {
    Curve::arc([0.0, MIDDLE], radius, [cut_angle(radius), 0.5 * PI], rows)
}

/// Half a section of the stand, from the floor outwards and up.
fn stand() -> Vec<Curve> {
    let quarter = 0.5 * PI;
    vec![
        Curve::line([0.80, 0.0], [0.80, 0.09]),
        Curve::arc([0.77, 0.09], 0.03, [0.0, quarter], 5),
        Curve::line([0.77, 0.12], [0.66, 0.12]),
        // A groove.
        Curve::line([0.66, 0.12], [0.66, 0.08]),
        Curve::line([0.66, 0.08], [0.61, 0.08]),
        Curve::line([0.61, 0.08], [0.61, 0.18]),
        Curve::arc([0.58, 0.18], 0.03, [0.0, quarter], 5),
        Curve::line([0.58, 0.21], [0.44, 0.21]),
        // A hollow curve up to the collar.
        Curve::arc([0.44, 0.33], 0.12, [-quarter, -2.0 * quarter], 8),
        // The collar, on which the ball lies.
        Curve::arc([0.33, 0.36], 0.05, [-0.45 * PI, 0.62 * PI], 10),
    ]
}

/// A disc, finer where the stand shades it.
fn floor() -> Part {
    let radii = [0.0, 0.4, 0.65, 0.76, 0.82, 0.9, 1.0, 1.15, 1.35, 1.6, 2.0, 2.6, 3.5, 5.0, 8.0, 14.0];
    let lines: Vec<Curve> = radii.windows(2).map(|r| Curve::line([r[1], 0.0], [r[0], 0.0])).collect();
    let mut part = Part::default();
    part.turned(&lines, [-PI, PI], 48);
    part
}
