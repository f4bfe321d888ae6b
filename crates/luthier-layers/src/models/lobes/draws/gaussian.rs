//! Facets of Beckmann, drawn where they mirror light above the horizon.
//!
//! In slopes over the slope parameters the distribution is a Gaussian, and facets whose light leaves fill an ellipse, a disc about the eye's slope in slopes of the
//! surface. The slope along the azimuth of the eye is drawn first, between the ends of the ellipse; the slope across, between the ends of its chord there.
//!
//! The slope along is that of a visible facet (Heitz and d'Eon 2014), or, by a chance, a Gaussian. Its middle and width follow the light that facets return, reflectance
//! times cosine times shadowing, at three slopes: visible facets of dielectrics lack those that reflect much, which are seen at grazing angles.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use luthier_optics::visible_normals::{normal_slope, visible_slope};

/// Slopes beyond this many widths are not drawn.
const LIMIT: f64 = 4.0;

/// Greatest chance of the Gaussian, over the square of what the facets transmit at normal incidence.
const CHANCE: f64 = 0.85;

/// Slopes at which light is compared: along the eye away from it, along towards the horizon and at most by this share of what is left there, and across.
///
/// These, [`POWER`] and the numbers of [`Light`] were fitted to the largest weights of indices from 1.33 to 2.2, reflectances from .02 to .9, slope parameters from .01 to 1
/// and views up to 85 degrees.
const AWAY: f64 = -0.66;
const TOWARDS: f64 = 1.9;
const OF_RANGE: f64 = 0.27;
const ACROSS: f64 = 1.57;

/// Power of the light that the Gaussian follows.
const POWER: f64 = 0.77;

/// Facets of Beckmann as an eye draws them.
#[derive(Debug, Clone, Copy)]
pub(super) struct GaussianDraw {
    alphas: [f64; 2],
    /// Cosine and sine of the eye where the surface is rough by 1, and its azimuth there.
    eye: [f64; 2],
    azimuth: DVec2,
    /// The chord of the ellipse at a slope.
    chord: Chord,
    /// Ends of slopes along the eye, and shares of visible facets below them.
    ends: [f64; 2],
    visible: [f64; 2],
    /// Chance of the Gaussian, its middle and width along, its width across, and shares of it below the ends.
    chance: f64,
    middle: f64,
    widths: [f64; 2],
    shares: [f64; 2],
}

/// The chord of the ellipse of slopes at a slope along the eye: the slopes y across for which `y^2 a + 2 x y b + x^2 c + 2 x d < 1`.
#[derive(Debug, Clone, Copy)]
struct Chord {
    across_sq: f64,
    mixed: f64,
    along_sq: f64,
    lean: f64,
}

impl Chord {
    fn ends(&self, x: f64) -> [f64; 2] {
        let half = x * self.mixed;
        let rest = 1.0 - x * (x * self.along_sq + 2.0 * self.lean);
        let root = libm::sqrt((half * half + self.across_sq * rest).max(0.0));
        [-half - root, -half + root].map(|y| (y / self.across_sq).clamp(-LIMIT, LIMIT))
    }
}

/// Light that facets return to an eye, up to a factor.
struct Light {
    cos_theta_o: f64,
    chord: Chord,
    f0: f64,
    alpha: f64,
}

impl Light {
    /// Its logarithm, by the power that the Gaussian follows: reflectance by Schlick, and a rough guess of the shadowing.
    fn at(&self, x: f64, y: f64) -> f64 {
        let chord = &self.chord;
        let facing = self.cos_theta_o * (1.0 - x * chord.lean);
        let steep_sq = 1.0 + x * x * chord.along_sq + y * y * chord.across_sq + 2.0 * x * y * chord.mixed;
        let steep = libm::sqrt(steep_sq);
        let cosine = (facing / steep).clamp(1e-4, 1.0);
        let rest = 1.0 - cosine;
        let rest_sq = rest * rest;
        let reflectance = self.f0 + (1.0 - self.f0) * (rest_sq * rest_sq * rest);
        let height = (2.0 * cosine / steep - self.cos_theta_o).max(0.003);
        POWER * libm::log(reflectance * facing.max(1e-4)) + 0.29 * libm::log(height / (height + 0.22 * self.alpha))
    }
}

/// Share of Gaussian slopes below x.
fn below(x: f64) -> f64 {
    0.5 * libm::erfc(-x)
}

/// Density of Gaussian slopes.
fn gaussian(x: f64) -> f64 {
    libm::exp(-x * x) / libm::sqrt(PI)
}

impl GaussianDraw {
    /// The draw of an eye (unit, above the surface, in the frame of the tangents) for slope parameters and a reflectance at normal incidence.
    pub(super) fn new(alphas: [f64; 2], wo: DVec3, f0: f64) -> Self {
        let [alpha_x, alpha_y] = alphas;
        let stretched = DVec2::new(alpha_x * wo.x, alpha_y * wo.y);
        let size = libm::hypot(stretched.length(), wo.z);
        let azimuth = stretched.try_normalize().unwrap_or(DVec2::X);
        let along = DVec2::new(alpha_x * azimuth.x, alpha_y * azimuth.y);
        let across = DVec2::new(-alpha_x * azimuth.y, alpha_y * azimuth.x);
        let chord = Chord {
            across_sq: across.length_squared(),
            mixed: along.dot(across),
            along_sq: along.length_squared(),
            lean: stretched.length() / wo.z,
        };
        // Slopes along the eye of the surface's slopes, and their greatest without cancellation.
        let gradient = DVec2::new(azimuth.x / alpha_x, azimuth.y / alpha_y);
        let level = DVec2::new(wo.x, wo.y);
        let (far, near) = (gradient.length() + gradient.dot(level), gradient.perp_dot(level));
        let towards = (gradient.length_squared() * wo.z * wo.z + near * near) / (wo.z * far);
        let ends = [(-far / wo.z).max(-LIMIT), towards.min(LIMIT)];
        let eye = [wo.z / size, stretched.length() / size];
        let light = Light { cos_theta_o: wo.z, chord, f0, alpha: libm::sqrt(alpha_x * alpha_y) };
        let end = TOWARDS.min(OF_RANGE * ends[1]);
        let (center, half) = (0.5 * (end + AWAY), 0.5 * (end - AWAY));
        let [least, mean, most, beside] =
            [(AWAY, 0.0), (center, 0.0), (end, 0.0), (center, ACROSS)].map(|(x, y)| light.at(x, y));
        let bend = ((most + least - 2.0 * mean) / (2.0 * half * half)).clamp(-1.0, 0.5);
        let squares = [1.0 / (1.0 - bend), 1.0 / (1.0 - ((beside - mean) / (ACROSS * ACROSS)).clamp(-0.3, 0.5))];
        let middle = (0.5 * ((most - least) / (2.0 * half) - 2.0 * bend * center) * squares[0]).clamp(-1.0, 1.0);
        let widths = squares.map(libm::sqrt);
        let mut draw = Self {
            alphas,
            eye,
            azimuth,
            chord,
            ends,
            visible: [0.0; 2],
            chance: CHANCE * (1.0 - f0) * (1.0 - f0),
            middle,
            widths,
            shares: ends.map(|x| below((x - middle) / widths[0])),
        };
        draw.visible = ends.map(|x| draw.visible_below(x));
        draw
    }

    /// The visible slopes below x.
    fn visible_below(&self, x: f64) -> f64 {
        let [cos, sin] = self.eye;
        cos * below(x) + 0.5 * sin * gaussian(x)
    }

    /// A facet in the frame of the tangents, for three numbers that are uniform in 0..1.
    pub(super) fn sample(&self, [way, u, v]: [f64; 3]) -> DVec3 {
        let between = |[from, to]: [f64; 2], u: f64| from + u * (to - from);
        let is_plain = way < self.chance;
        let along = if is_plain {
            self.middle + self.widths[0] * normal_slope(between(self.shares, u))
        } else {
            let [cos, sin] = self.eye;
            let last = if sin > 0.0 { (cos / sin).min(LIMIT) } else { LIMIT };
            visible_slope(cos, sin, last, between(self.visible, u) / self.visible_below(last))
        };
        let along = along.clamp(self.ends[0], self.ends[1]);
        let width = if is_plain { self.widths[1] } else { 1.0 };
        let ends = self.chord.ends(along);
        let across = width * normal_slope(between(ends.map(|y| below(y / width)), v));
        let slope = along * self.azimuth + across.clamp(ends[0], ends[1]) * self.azimuth.perp();
        DVec3::new(-self.alphas[0] * slope.x, -self.alphas[1] * slope.y, 1.0).normalize()
    }

    /// Density in solid angle of light that drawn facets mirror to the eye, above the horizon; `sum` is that of both directions, in the frame of the tangents.
    pub(super) fn pdf_solid_angle(&self, sum: DVec3) -> f64 {
        let slope = DVec2::new(-sum.x / (sum.z * self.alphas[0]), -sum.y / (sum.z * self.alphas[1]));
        let (x, y) = (slope.dot(self.azimuth), slope.dot(self.azimuth.perp()));
        let ends = self.chord.ends(x);
        let share = |width: f64| {
            let [from, to] = ends.map(|y| below(y / width));
            (to - from).max(SHARE_MIN)
        };
        let [cos, sin] = self.eye;
        let visible = (cos - sin * x).max(0.0) / (self.visible[1] - self.visible[0]);
        let visible = visible * gaussian(x) * gaussian(y) / share(1.0);
        let [along, across] = self.widths;
        let plain = gaussian((x - self.middle) / along) / (along * (self.shares[1] - self.shares[0]));
        let plain = plain * gaussian(y / across) / (across * share(across));
        let slopes = self.chance * plain + (1.0 - self.chance) * visible;
        slopes * sum.length_squared() / (2.0 * self.alphas[0] * self.alphas[1] * sum.z * sum.z * sum.z)
    }
}

/// Least share of a chord, so that single precision has it, too.
const SHARE_MIN: f64 = 1e-6;
