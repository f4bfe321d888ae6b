//! Brute-force walks on Smith micro-surfaces: the oracle for every albedo with more than one bounce.
//!
//! Written from Heitz, Hanika, d'Eon and Dachsbacher 2016, "Multiple-Scattering Microfacet BSDFs with the Smith Model",
//! sections 4 and 5, and as naively as can be: heights are heights (Gaussian or uniform), visible normals are found by
//! rejection, and every event has one outcome. A walk that leaves counts 1, so the standard error of a share follows
//! from the share. Nothing here comes from the crates under test.

use std::f64::consts::PI;

use glam::DVec3;

/// Distribution of slopes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Slopes {
    /// Beckmann.
    Gaussian,
    /// GGX: the normals of an ellipsoid.
    Ellipsoid,
}

/// Distribution of heights. Results must not depend on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Heights {
    /// Gaussian heights of unit variance.
    Gaussian,
    /// Uniform heights on -1..1.
    Uniform,
}

/// Treatment of light by facets. Indices are relative to the medium above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Facets {
    /// Reflect everything.
    Mirror,
    /// Reflect or absorb.
    Conductor {
        /// Real part of the index.
        n: f64,
        /// Imaginary part.
        k: f64,
    },
    /// Reflect or refract.
    Dielectric {
        /// Index.
        n: f64,
    },
}

/// A rough interface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Surface {
    pub(crate) slopes: Slopes,
    pub(crate) heights: Heights,
    pub(crate) alpha: f64,
    pub(crate) facets: Facets,
}

/// Fates of the walks, as shares of all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shares {
    pub(crate) walks: u32,
    /// Left upward after one reflection.
    pub(crate) once: f64,
    /// Left upward and never crossed the interface; includes `once`.
    pub(crate) never_crossed: f64,
    /// Left upward after crossing it and coming back.
    pub(crate) crossed: f64,
}

impl Shares {
    /// Standard error of a share.
    pub(crate) fn sigma(&self, share: f64) -> f64 {
        (share * (1.0 - share) / f64::from(self.walks)).sqrt()
    }
}

impl Surface {
    /// Sends `walks` rays down at `cos_theta_i`.
    pub(crate) fn shares(&self, cos_theta_i: f64, walks: u32, seed: u64) -> Shares {
        let mut counts = [0u32; 3];
        for walk in 0..walks {
            let mut random = Random::new(seed, u64::from(walk));
            match self.walk(cos_theta_i, &mut random) {
                Fate::Above { facets, crossed: false } => {
                    counts[0] += u32::from(facets == 1);
                    counts[1] += 1;
                }
                Fate::Above { crossed: true, .. } => counts[2] += 1,
                Fate::Below | Fate::Absorbed => {}
            }
        }
        let [once, never_crossed, crossed] = counts.map(|n| f64::from(n) / f64::from(walks));
        Shares { walks, once, never_crossed, crossed }
    }

    fn walk(&self, cos_theta_i: f64, random: &mut Random) -> Fate {
        let mut ray = -DVec3::new((1.0 - cos_theta_i * cos_theta_i).sqrt(), 0.0, cos_theta_i);
        let mut height = f64::INFINITY;
        let (mut above, mut crossed, mut facets) = (true, false, 0);
        while let Some(next) = self.next_height(ray, height, random) {
            height = next;
            facets += 1;
            let m = self.visible_normal(-ray, random);
            let cos = -ray.dot(m);
            if random.next() < self.reflectance(above, cos) {
                ray += 2.0 * cos * m;
            } else if let Facets::Dielectric { n } = self.facets {
                let ratio = if above { 1.0 / n } else { n };
                let cos_t = (1.0 - ratio * ratio * (1.0 - cos * cos)).max(0.0).sqrt();
                let through = ratio * ray + (ratio * cos - cos_t) * m;
                // Turned over, the surface is as before: symmetric in slopes and in heights.
                ray = DVec3::new(through.x, through.y, -through.z);
                height = -height;
                above = !above;
                crossed = true;
            } else {
                return Fate::Absorbed;
            }
            ray = ray.normalize();
        }
        if above { Fate::Above { facets, crossed } } else { Fate::Below }
    }

    /// Height of the next facet on the way of a ray, or `None` when it leaves. With C the share of the surface below a height,
    /// a ray going up meets nothing between two heights with probability (C/C')^Lambda; going down, (C'/C)^(1 + Lambda).
    fn next_height(&self, ray: DVec3, height: f64, random: &mut Random) -> Option<f64> {
        let below = self.heights.share_below(height);
        let free = random.next();
        let lambda = self.lambda(ray.z.abs());
        if ray.z < 0.0 {
            return Some(self.heights.of_share(below * free.powf(1.0 / (1.0 + lambda))));
        }
        let reached = below * free.powf(-1.0 / lambda);
        (reached < 1.0).then(|| self.heights.of_share(reached))
    }

    /// Smith's Lambda upward, as integrals of the slopes that hide (Heitz 2014, section 5).
    fn lambda(&self, cos: f64) -> f64 {
        let tan = (1.0 - cos * cos).max(0.0).sqrt() / cos;
        match self.slopes {
            Slopes::Ellipsoid => (-1.0 + (1.0 + (self.alpha * tan).powi(2)).sqrt()) / 2.0,
            Slopes::Gaussian => {
                let a = 1.0 / (self.alpha * tan);
                ((-a * a).exp() / (a * PI.sqrt()) - libm::erfc(a)) / 2.0
            }
        }
    }

    /// A normal of density proportional to D max(0, w.m), by rejection.
    fn visible_normal(&self, w: DVec3, random: &mut Random) -> DVec3 {
        // Stretched, the surface has alpha = 1.
        let w = DVec3::new(self.alpha * w.x, self.alpha * w.y, w.z).normalize();
        let m = match self.slopes {
            Slopes::Ellipsoid => visible_on_dome(w, random),
            Slopes::Gaussian => {
                let sin = w.x.hypot(w.y);
                let along = visible_gaussian_slope(w.z, sin, random);
                let across = (-random.next().ln()).sqrt() * (2.0 * PI * random.next()).cos();
                let axis = if sin > 0.0 { DVec3::new(w.x / sin, w.y / sin, 0.0) } else { DVec3::X };
                DVec3::Z - along * axis - across * DVec3::Z.cross(axis)
            }
        };
        DVec3::new(self.alpha * m.x, self.alpha * m.y, m.z).normalize()
    }

    fn reflectance(&self, above: bool, cos: f64) -> f64 {
        match self.facets {
            Facets::Mirror => 1.0,
            Facets::Conductor { n, k } => conductor(n, k, cos),
            Facets::Dielectric { n } => dielectric(if above { n } else { 1.0 / n }, cos),
        }
    }
}

enum Fate {
    Above { facets: u32, crossed: bool },
    Below,
    Absorbed,
}

/// Normals of a hemisphere of unit radius, seen from `w`: uniform over its outline.
fn visible_on_dome(w: DVec3, random: &mut Random) -> DVec3 {
    let (s, t) = w.any_orthonormal_pair();
    loop {
        let (x, y) = (2.0 * random.next() - 1.0, 2.0 * random.next() - 1.0);
        let r_sq = x * x + y * y;
        if r_sq < 1.0 {
            let point = x * s + y * t + (1.0 - r_sq).sqrt() * w;
            if point.z > 0.0 {
                return point;
            }
        }
    }
}

/// A slope x of density proportional to max(0, cos - x sin) exp(-x^2), by rejection.
fn visible_gaussian_slope(cos: f64, sin: f64, random: &mut Random) -> f64 {
    let seen = |x: f64| (cos - x * sin).max(0.0);
    if cos <= 0.0 {
        // Only slopes beyond |cos|/sin are seen: proposals of density |x| exp(-x^2) out there.
        let least = cos / sin;
        loop {
            let x = -(least * least - random.next().ln()).sqrt();
            if random.next() * sin * x.abs() < seen(x) {
                return x;
            }
        }
    }
    // cos - x sin is below cos + sin max(0, -x): a mixture of a Gaussian and half a Rayleigh distribution.
    let gaussian = cos * PI.sqrt();
    let rayleigh = sin / 2.0;
    loop {
        let radius = (-random.next().ln()).sqrt();
        let x = if random.next() * (gaussian + rayleigh) < gaussian {
            radius * (2.0 * PI * random.next()).cos()
        } else {
            -radius
        };
        if random.next() * (cos + sin * (-x).max(0.0)) < seen(x) {
            return x;
        }
    }
}

impl Heights {
    fn share_below(self, height: f64) -> f64 {
        match self {
            Self::Gaussian => 0.5 * libm::erfc(-height / 2f64.sqrt()),
            Self::Uniform => (0.5 * (height + 1.0)).clamp(0.0, 1.0),
        }
    }

    fn of_share(self, share: f64) -> f64 {
        match self {
            Self::Uniform => 2.0 * share - 1.0,
            Self::Gaussian => {
                // Newton, inside a bracket, from the logistic distribution of the same width.
                let (mut low, mut high) = (-38.0, 38.0);
                let mut h = ((share / (1.0 - share)).ln() / 1.702).clamp(low, high);
                for _ in 0..100 {
                    let excess = self.share_below(h) - share;
                    if excess > 0.0 {
                        high = h;
                    } else {
                        low = h;
                    }
                    let step = excess * (2.0 * PI).sqrt() * (0.5 * h * h).exp();
                    let next = h - step;
                    if step.abs() < 1e-9 {
                        return next;
                    }
                    h = if next > low && next < high { next } else { 0.5 * (low + high) };
                }
                h
            }
        }
    }
}

/// Reflectance of a dielectric of relative index `n`, unpolarised, in real numbers.
pub(crate) fn dielectric(n: f64, cos: f64) -> f64 {
    let cos_t_sq = 1.0 - (1.0 - cos * cos) / (n * n);
    if cos_t_sq <= 0.0 {
        return 1.0;
    }
    let cos_t = cos_t_sq.sqrt();
    let s = (cos - n * cos_t) / (cos + n * cos_t);
    let p = (n * cos - cos_t) / (n * cos + cos_t);
    0.5 * (s * s + p * p)
}

/// Reflectance of a conductor of relative index `n + i k`, unpolarised, in real numbers (Born and Wolf, section 14.2, in the
/// form with a^2 + b^2).
pub(crate) fn conductor(n: f64, k: f64, cos: f64) -> f64 {
    let (cos_sq, sin_sq) = (cos * cos, 1.0 - cos * cos);
    let t0 = n * n - k * k - sin_sq;
    let a2_b2 = (t0 * t0 + 4.0 * n * n * k * k).sqrt();
    let a = (0.5 * (a2_b2 + t0)).max(0.0).sqrt();
    let (t1, t2) = (a2_b2 + cos_sq, 2.0 * a * cos);
    let s = (t1 - t2) / (t1 + t2);
    let (t3, t4) = (cos_sq * a2_b2 + sin_sq * sin_sq, t2 * sin_sq);
    0.5 * (s + s * (t3 - t4) / (t3 + t4))
}

/// Random numbers from a counter.
pub(crate) struct Random {
    key: u64,
    counter: u64,
}

impl Random {
    pub(crate) fn new(seed: u64, stream: u64) -> Self {
        Self { key: mix(mix(seed) ^ stream), counter: 0 }
    }

    /// Uniform in 0..1, both ends excluded.
    pub(crate) fn next(&mut self) -> f64 {
        self.counter += 1;
        let bits = mix(self.key.wrapping_add(self.counter.wrapping_mul(0x9e37_79b9_7f4a_7c15))) >> 12;
        (bits as f64 + 0.5) / (1u64 << 52) as f64
    }
}

/// The finaliser of SplitMix64 (Steele, Lea and Flood 2014).
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
