//! Ways to write or to store one function: formulations that ship and formulations that were rejected, each with its error.

use std::f64::consts::{FRAC_PI_2, PI};

use luthier_layers::models::statistics::spread;
use luthier_layers::models::statistics::total_reflection::escaping_share;
use luthier_layers::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};
use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};
use luthier_lut::{Image, WeightBits, bilinear};
use luthier_optics::albedo::{Effort, FacetStatistics, ReflectanceCurves};
use luthier_optics::f0_table::F0_TABLE;
use luthier_optics::film_color::BelcourBarla;
use luthier_optics::fresnel::{FilmLayer, coated, dielectric_average, interface};
use luthier_optics::masking::{Correlation, kelemen, schlick_smith, smith, v_cavity};
use luthier_optics::microfacet::{distribution, lambda, scaled_distribution};
use luthier_optics::schlick::{F82, Lazanyi, complex_f0};
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;
use serde::{Deserialize, Serialize};

/// Known pitfalls of layered models and of their tables, with the cases that show them. A pitfall without cases has formulations.
pub const PITFALLS: [(&str, &[&str]); 24] = [
    ("D in f16", &[]),
    ("D table, alpha axis linear, 512", &[]),
    ("reading u^8 as (N.H)^8", &[]),
    ("D table, m axis linear", &[]),
    ("D with mip maps", &[]),
    ("8-bit Fresnel row", &[]),
    ("Fresnel row linear in theta", &[]),
    ("Fresnel from inside", &[]),
    ("Schlick with complex F0", &[]),
    ("f32 GGX from cos", &[]),
    ("f32 conductor Fresnel", &["lossless-metal"]),
    ("f16 alpha^2", &[]),
    ("half vector, L = -V", &["opposite-metal", "opposite-coated", "opposite-chalk"]),
    ("grazing", &["grazing-metal", "mirror-metal", "grazing-coated", "mirror-coated", "mirror-chalk"]),
    ("rough coat over smooth base", &["frosted-0.4-0.05", "frosted-0.2-0.2", "frosted-0.3-0.01"]),
    ("Weidlich-Wilkie energy", &["furnace-2", "furnace-3"]),
    ("Weidlich-Wilkie bounces", &["furnace-2"]),
    ("single-scatter microfacets", &["furnace-1"]),
    ("q -> 0", &["q-zero"]),
    ("film with total reflection", &["tunnel"]),
    ("film d -> 0", &["film-1e-6", "film-1e-3"]),
    ("Belcour/Yamaguchi at high alpha with high index, at grazing angles", &["rough-high"]),
    ("gold F0 red", &["gold"]),
    ("hardware bilinear filtering", &[]),
];

/// Row of formulations beside the [`PITFALLS`].
const EXTREMES: &str = "denormal and huge arguments";

/// One way to write or to store a function.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FormulaResult {
    /// Pitfall (one of [`PITFALLS`]), or another subject.
    pub row: String,
    /// The formulation, and its precision.
    pub formulation: String,
    /// Whether it ships.
    pub ships: bool,
    /// Quantity of the error, and the truth that it is compared with.
    pub measure: String,
    /// The error; `None` if values are not finite.
    pub error: Option<f64>,
    /// Largest error with which it holds.
    pub tolerance: f64,
    /// Reason why the formulation is not used, or the formulation that is used instead.
    pub reason: String,
}

impl FormulaResult {
    /// Whether the error is within the tolerance.
    pub fn holds(&self) -> bool {
        self.error.is_some_and(|error| error <= self.tolerance)
    }

    /// Whether the formulation holds, or does not ship and has a reason.
    pub fn is_as_expected(&self) -> bool {
        self.holds() || (!self.ships && !self.reason.is_empty())
    }
}

struct Collector(Vec<FormulaResult>);

impl Collector {
    /// Adds a formulation that ships.
    fn ours(&mut self, row: &str, formulation: &str, measure: &str, error: f64, tolerance: f64) {
        self.push(row, formulation, true, measure, error, tolerance, "");
    }

    /// Adds a formulation that does not ship, with the reason.
    fn rejected(&mut self, row: &str, formulation: &str, measure: &str, error: f64, reason: &str) {
        self.push(row, formulation, false, measure, error, super::HOLDS, reason);
    }

    #[expect(clippy::too_many_arguments, reason = "the fields of a line of a table")]
    fn push(
        &mut self,
        row: &str,
        formulation: &str,
        ships: bool,
        measure: &str,
        error: f64,
        tolerance: f64,
        reason: &str,
    ) {
        self.0.push(FormulaResult {
            row: row.to_owned(),
            formulation: formulation.to_owned(),
            ships,
            measure: measure.to_owned(),
            error: error.is_finite().then_some(error),
            tolerance,
            reason: reason.to_owned(),
        });
    }
}

/// All formulations, measured.
pub fn formulas() -> Vec<FormulaResult> {
    let mut out = Collector(Vec::new());
    storage_of_d(&mut out);
    rows_of_fresnel(&mut out);
    single_precision(&mut out);
    energies(&mut out);
    films(&mut out);
    filtering(&mut out);
    extremes(&mut out);
    out.0
}

/// Rounds to a half float by way of single precision, as tables do. `half` converts doubles in one step or in two, depending on the machine.
fn halved(value: f64) -> f64 {
    half::f16::from_f32(value as f32).to_f64()
}

fn beckmann(alpha: f64, theta: f64) -> f64 {
    let (sin, cos) = libm::sincos(theta);
    scaled_distribution(Distribution::Beckmann, alpha, cos, sin * sin)
}

/// Largest difference between a function and straight lines between its values at `texels` points of 0..=1.
fn interpolation(texels: u32, f: impl Fn(f64) -> f64) -> f64 {
    let intervals = f64::from(texels - 1);
    let mut worst = 0.0_f64;
    for i in 0..texels - 1 {
        let [a, b] = [i, i + 1].map(|i| f(f64::from(i) / intervals));
        for k in 1..16 {
            let t = f64::from(k) / 16.0;
            worst = worst.max((a + t * (b - a) - f((f64::from(i) + t) / intervals)).abs());
        }
    }
    worst
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    // Unlike f64::max, keeps NaN.
    values.fold(0.0, |worst, value| if value > worst || value.is_nan() { value } else { worst })
}

fn storage_of_d(out: &mut Collector) {
    let m = 1e-3;
    let peak = 1.0 / (PI * m * m);
    let truth = "peak of Beckmann at m = 0.001, relative to f64";
    let row = PITFALLS[0].0;
    out.rejected(
        row,
        "1/(pi m^2) in a half float",
        truth,
        (halved(peak) / peak - 1.0).abs(),
        "The value overflows a half float below m = 0.0022.",
    );
    out.rejected(row, "m of row i is i/511", truth, f64::NAN, "Row 0 is 0/0, and row 1 overflows.");
    let ours = largest((0..1000).map(|i| {
        let value = beckmann(1.0, FRAC_PI_2 * f64::from(i) / 1000.0);
        (libm::pow(halved(libm::pow(value, 0.0625)), 16.0) - value).abs()
    }));
    out.ours(
        row,
        "(pi m^2 D)^(1/16) in a half float",
        "all angles at m = 1, as a fraction of the largest peak, 4/e",
        ours / 1.4715,
        8e-3,
    );

    for m in [0.02, 0.005] {
        let truth = format!("row of 512 texels at m = {m}, against D, as a fraction of the peak");
        let linear = interpolation(512, |u| beckmann(m, FRAC_PI_2 * u));
        out.rejected(PITFALLS[1].0, "angle linear", &truth, linear, "The lobe is narrower than a texel.");
        let eighth = interpolation(512, |u| beckmann(m, FRAC_PI_2 * libm::pow(u, 8.0)));
        out.ours(PITFALLS[1].0, "angle = (pi/2) u^8", &truth, eighth, 2e-4);
        let cosine = interpolation(512, |u| beckmann(m, libm::acos(libm::pow(u, 0.125))));
        out.rejected(PITFALLS[2].0, "cosine = u^(1/8)", &truth, cosine, "The nodes near the normal are too far apart.");
        out.ours(PITFALLS[2].0, "angle = (pi/2) u^8", &truth, eighth, 2e-4);
        let row = libm::floor(m * 511.0);
        let truth = format!("peak halfway between two rows at m = {m}, relative to the peak");
        let [low, high] = [row, row + 1.0].map(|i| 1.0 / (i * i));
        let middle = 1.0 / ((row + 0.5) * (row + 0.5));
        let error = 0.5 * (low + high) / middle - 1.0;
        out.rejected(
            PITFALLS[3].0,
            "D over m, linear, 512 rows",
            &truth,
            error,
            "1/m^2 is far from linear between two rows.",
        );
        // The rows that ship are a ratio of 1000^(1/511) apart. Halfway between two rows the error is largest.
        let ratio = libm::pow(1000.0, 0.5 / 511.0);
        let error = largest((0..400).map(|i| {
            let theta = 4.0 * m * f64::from(i) / 400.0;
            (0.5 * (beckmann(m * ratio, theta) + beckmann(m / ratio, theta)) - beckmann(m, theta)).abs()
        }));
        out.ours(
            PITFALLS[3].0,
            "pi m^2 D over log m, 512 rows",
            &truth.replace("peak halfway", "lobe halfway"),
            error,
            1e-3,
        );
    }
    let rows = (0..16).map(|i| (0.02 * 511.0 - 7.5 + f64::from(i)) / 511.0);
    let mean = rows.clone().map(|m| 1.0 / (m * m)).sum::<f64>() / 16.0 * 4e-4;
    let truth = "mean of the peaks of 16 rows around m = 0.02, relative to the peak there";
    out.rejected(
        PITFALLS[4].0,
        "mip maps of D",
        truth,
        mean - 1.0,
        "A mip map averages D over m, and the mean of 1/m^2 from a to b is 1/(ab).",
    );
    let ours = rows.map(|m| beckmann(m, 0.0)).sum::<f64>() / 16.0;
    out.ours(PITFALLS[4].0, "one level of pi m^2 D", truth, (ours - 1.0).abs(), 1e-12);
}

fn reflectance(above: f64, below: f64, cos: f64) -> f64 {
    interface(Complex64::new(above, 0.0), Complex64::new(below, 0.0), cos).unpolarised()
}

fn rows_of_fresnel(out: &mut Collector) {
    for n in [1.5, 1.33] {
        let f0 = reflectance(1.0, n, 1.0);
        let truth = format!("rounding error of F0 at n = {n}, relative");
        let reason = "Half a step of the format is a tenth of the highlight of water.";
        out.rejected(PITFALLS[5].0, "unorm8", &truth, 0.5 / 255.0 / f0, reason);
        let half = largest((0..=100).map(|i| {
            let value = reflectance(1.0, n, f64::from(i) / 100.0);
            (halved(value) / value - 1.0).abs()
        }));
        out.ours(PITFALLS[5].0, "half float", &truth, half, 5e-4);
    }
    for n in [1.01, 1.5] {
        let truth = format!("128 texels, n = {n}, absolute, against Fresnel's formulas");
        let theta = interpolation(128, |u| reflectance(1.0, n, libm::cos(FRAC_PI_2 * u)));
        out.rejected(
            PITFALLS[6].0,
            "theta",
            &truth,
            theta,
            "The reflectance is steep at grazing angles. A row over theta is used only where a material asks for it.",
        );
        out.ours(PITFALLS[6].0, "cosine", &truth, interpolation(128, |u| reflectance(1.0, n, u)), 6e-3);
    }
    let critical = (1.0 - 1.0 / 2.25_f64).sqrt();
    let truth = "128 texels from 1.5 into 1, absolute, against Fresnel's formulas";
    let plain = interpolation(128, |u| reflectance(1.5, 1.0, u));
    let reason = "It misses the kink at the critical angle. Rows are seen from above; `luthier check` warns of a material whose interface has the denser medium above it.";
    out.rejected(PITFALLS[7].0, "cosine over 0..1", truth, plain, reason);
    let knot = interpolation(64, |u| reflectance(1.5, 1.0, critical + (1.0 - critical) * u * u));
    out.rejected(
        PITFALLS[7].0,
        "knot at the critical angle, u^2 beyond",
        truth,
        knot,
        "It holds, but no material needs it so far.",
    );

    let metals = [("copper", 0.213, 4.05), ("aluminium", 1.0, 6.69), ("chromium", 3.18, 4.41), ("1.01", 1.01, 0.0)];
    for (name, n, k) in metals {
        let below = Complex64::new(n, k);
        let truth = format!("{name}, absolute, all angles, against Fresnel's formulas");
        let error = worst_angle(below, |cos| complex_f0(1.0, below, cos));
        out.rejected(
            PITFALLS[8].0,
            "Schlick with complex F0",
            &truth,
            error,
            "The error is not the 5% that the literature claims.",
        );
        let lazanyi = Lazanyi::fit(1.0, below);
        let error = worst_angle(below, |cos| lazanyi.eval(cos));
        out.rejected(
            PITFALLS[8].0,
            "with Lazanyi's correction",
            &truth,
            error,
            "The correction is better, but still not close to Fresnel's formulas.",
        );
        let row = interpolation(128, |cos| interface(Complex64::ONE, below, cos).unpolarised());
        out.ours(PITFALLS[8].0, "row of 128 texels", &truth, row, 6e-3);
    }
}

/// Largest difference over all angles between a form of the reflectance of an interface and Fresnel's formulas.
fn worst_angle(below: Complex64, form: impl Fn(f64) -> f64) -> f64 {
    largest((0..=2000).map(|i| {
        let cos = libm::cos(f64::from(i) / 2000.0 * FRAC_PI_2);
        (form(cos) - interface(Complex64::ONE, below, cos).unpolarised()).abs()
    }))
}

fn single_precision(out: &mut Collector) {
    for alpha in [1e-2, 1e-3, 1e-4] {
        let truth = format!("GGX at alpha = {alpha}, two alpha about the peak, relative to f64");
        let a = alpha as f32;
        let (mut bad, mut good) = (0.0_f64, 0.0_f64);
        for i in 0..400 {
            let theta = alpha * f64::from(i) / 200.0;
            let (sin, cos) = libm::sincos(theta);
            let exact = distribution(Distribution::Ggx, alpha, cos, sin * sin);
            let (c, s) = (cos as f32, (sin * sin) as f32);
            let from_cos = c * c * (a * a - 1.0) + 1.0;
            let from_sine = c * c * a * a + s;
            let [cancelled, error] =
                [from_cos, from_sine].map(|d| (f64::from(a * a / (std::f32::consts::PI * d * d)) / exact - 1.0).abs());
            bad = if cancelled > bad || cancelled.is_nan() { cancelled } else { bad };
            good = good.max(error);
        }
        out.rejected(
            PITFALLS[9].0,
            "from the cosine, f32",
            &truth,
            bad,
            "1 - cos^2 cancels and has no correct digits.",
        );
        out.ours(PITFALLS[9].0, "from the squared sine, f32", &truth, good, 2e-6);
    }
    let (n, k) = (0.01_f64, 10.0_f64);
    let exact = 4.0 * n / ((n + 1.0) * (n + 1.0) + k * k);
    let truth = "1 - F at normal incidence, n = 0.01, k = 10, relative to 4n/((n+1)^2+k^2)";
    let (nf, kf) = (n as f32, k as f32);
    let t0 = nf * nf - kf * kf;
    let modulus = (t0 * t0 + 4.0 * nf * nf * kf * kf).sqrt();
    let a = (0.5 * (modulus + t0)).max(0.0).sqrt();
    let usual = 1.0 - f64::from((modulus + 1.0 - 2.0 * a) / (modulus + 1.0 + 2.0 * a));
    let error = (usual / exact - 1.0).abs();
    out.rejected(PITFALLS[10].0, "the usual form, f32", truth, error, "Squares of k cancel. Tables are baked in f64.");
    let ours = 1.0 - interface(Complex64::ONE, Complex64::new(n, k), 1.0).unpolarised();
    out.ours(PITFALLS[10].0, "interface(), f64", truth, (ours / exact - 1.0).abs(), 1e-11);
    let truth = "alpha^2 for alpha from 0.001 to 0.0078, relative";
    let alphas = (0..200).map(|i| 1e-3 + 6.8e-3 * f64::from(i) / 200.0);
    let half = largest(alphas.clone().map(|a| (halved(a * a) / (a * a) - 1.0).abs()));
    out.rejected(PITFALLS[11].0, "half float", truth, half, "alpha^2 is below the smallest normal half float.");
    let single = largest(alphas.map(|a| (f64::from((a as f32) * (a as f32)) / (a * a) - 1.0).abs()));
    out.ours(PITFALLS[11].0, "f32", truth, single, 3e-7);
}

fn energies(out: &mut Collector) {
    let statistics = FacetStatistics::new(Distribution::Ggx, 1.0, 1.0, Effort { first: 24, later: 24 }, 1);
    let mirror = ReflectanceCurves::new(1, |_, _| 1.0);
    let truth = "mirror of GGX, alpha 1, normal incidence, against 1";
    let single = 1.0 - statistics.single_scattering(&mirror)[0];
    out.rejected(
        "single-scatter microfacets",
        "one bounce",
        truth,
        single,
        "Shaders evaluate one bounce; it lacks ln 2 of the light in this case.",
    );
    let all = (1.0 - statistics.albedo(&mirror)[0]).abs();
    out.ours("single-scatter microfacets", "FGD with all bounces", truth, all, 1e-6);

    let row = "rough coat over smooth base";
    for (coat, base) in [(0.4, 0.05), (0.3, 0.01)] {
        let seen = median_alpha(coat, base);
        let truth =
            format!("alpha of the base seen, coat {coat}, base {base}, n = 1.5, relative to 20000 walks ({seen:.3})");
        let variance = {
            // One pass at normal incidence: refraction adds h(alpha (1 - 1/n) / 2) below and as much above, times j (Belcour 2018).
            let (entering, leaving) = (0.5 * coat * (1.0 / 3.0), 0.5 * coat * 0.5);
            spread::variance(leaving) + 1.5 * (spread::variance(entering) + spread::variance(base))
        };
        let belcour = spread::alpha(variance);
        let error = (belcour / seen - 1.0).abs();
        out.push(row, "Belcour's sum of variances", true, &truth, error, 0.1, "");
        out.rejected(
            row,
            "Elek's clamp",
            &truth,
            (coat / seen - 1.0).abs(),
            "This is the formula of the paper. `luthier check` warns of a base that is smoother than its coat.",
        );
    }

    let f = 1.0_f64;
    let naive = f + (1.0 - f) * (1.0 - f) / (1.0 - f);
    let truth = "reflectance of a coat and a base that reflect everything, against 1";
    out.rejected(
        "q -> 0",
        "F + (1-F)^2/(1-F)",
        truth,
        naive - 1.0,
        "The formula is 0/0. Models and shaders stop where an interface transmits nothing.",
    );
    let gold = F0_TABLE.iter().find(|entry| entry.name == "Gold").and_then(|entry| entry.computed());
    let red = gold.map_or(f64::NAN, |rgb| rgb[0]);
    let truth = "red of gold at normal incidence, against 1.0376 from its spectrum, relative";
    out.rejected(
        "gold F0 red",
        "unorm8",
        truth,
        (red.min(1.0) / 1.0376 - 1.0).abs(),
        "The format clips values above 1.",
    );
    out.ours("gold F0 red", "half float", truth, (halved(red) / 1.0376 - 1.0).abs(), 1e-3);
}

/// Median slope of half vectors of the light that a mirror of alpha `base` sends back through a coat of index 1.5 at normal incidence, without the
/// coat's own reflection. For a bare GGX surface the median is alpha.
fn median_alpha(coat: f64, base: f64) -> f64 {
    let glass = MonochromeBelow::Dielectric { ior: 1.5, complex_ior: Complex64::new(1.5, 0.0), optical_depth: 0.0 };
    let mut lights: Vec<(f64, f64)> = Vec::new();
    // A base of the coat's own index is black: subtracting its light leaves that of the mirror.
    for (sign, ior) in [(1.0, Complex64::new(0.0, 1.0)), (-1.0, Complex64::new(1.5, 0.0))] {
        let layers = [(coat, 1.0, glass), (base, 1.5, MonochromeBelow::Conductor { ior })];
        let layers = layers.map(|(alpha, above, below)| MonochromeLayer {
            surface: Surface::isotropic(Distribution::Ggx, alpha),
            above,
            films: Vec::new(),
            below,
            f0: None,
        });
        let stack = Monochrome { exterior: 1.0, layers: layers.into() };
        let paths = LayeredMc { mode: InterfaceMode::SmithWalk, samples: 20_000, seed: 3 };
        let paths = paths.paths(&stack, glam::DVec3::Z).flatten();
        lights.extend(paths.map(|(w, weight)| (libm::hypot(w.x, w.y) / (1.0 + w.z), sign * weight)));
    }
    lights.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = lights.iter().map(|(_, weight)| weight).sum();
    let mut sum = 0.0;
    let middle = lights.iter().find(|(_, weight)| {
        sum += weight;
        sum >= 0.5 * total
    });
    middle.map_or(f64::NAN, |(slope, _)| *slope)
}

fn films(out: &mut Collector) {
    let cos = 0.5;
    let film = [FilmLayer { ior: Complex64::ONE, waves: 100.0 / 550.0 }];
    let glass = Complex64::new(1.5, 0.0);
    let truth = "100 nm of air in glass, 60 degrees, 550 nm, against 0.63127563";
    let row = "film with total reflection";
    let found = coated(glass, &film, glass, cos).unpolarised();
    out.ours(row, "Airy's formula, complex", truth, (found - 0.631_275_63).abs(), 1e-8);
    let published = BelcourBarla { above: 1.5, film: 1.0, thickness_nm: 100.0, below: glass, orders: 2 };
    let error = (published.monochrome(550.0, cos) - 0.631_275_63).abs();
    out.rejected(
        row,
        "Belcour and Barla's shader",
        truth,
        error,
        "The published shader returns 1 beyond the critical angle.",
    );
    let base = Complex64::new(0.213, 4.05);
    let truth = "film of index 1.5, 0.01 nm on copper, all angles, against the bare metal";
    let error = largest((1..=100).map(|i| {
        let cos = f64::from(i) / 100.0;
        let film = [FilmLayer { ior: glass, waves: 0.01 / 690.0 }];
        (coated(Complex64::ONE, &film, base, cos).unpolarised() - interface(Complex64::ONE, base, cos).unpolarised())
            .abs()
    }));
    out.ours("film d -> 0", "Airy's formula, complex", truth, error, 1e-3);
}

fn filtering(out: &mut Collector) {
    let truth = "128 texels of Fresnel at n = 1.5, absolute, against exact weights";
    let data = (0..128).map(|i| reflectance(1.0, 1.5, f64::from(i) / 127.0) as f32).collect();
    let image = Image { width: 128, height: 1, channels: 1, data };
    let error = largest((0..127 * 500).map(|i| {
        let at = [(f64::from(i) + 0.5) / 500.0 + 0.5, 0.5];
        (bilinear(&image, at, WeightBits::Fixed(8))[0] - bilinear(&image, at, WeightBits::Exact)[0]).abs()
    }));
    out.ours("hardware bilinear filtering", "weights of 8 bits", truth, error, 2e-4);
}

/// Values from the smallest denormal to the largest number.
const EXTREME: [f64; 12] = [0.0, 5e-324, 1e-310, 1e-150, 1e-30, 1e-7, 1e-3, 1.0, 10.0, 1e30, 1e150, f64::MAX];

/// Distance of a share from 0..=1; NaN for a value that is not finite.
fn beyond_unit(value: f64) -> f64 {
    if value.is_finite() { (value - 1.0).max(-value).max(0.0) } else { f64::NAN }
}

/// Distance of a number below 0; NaN stays. Infinity is allowed, because some of these functions have an infinite limit.
fn beyond_zero(value: f64) -> f64 {
    if value.is_nan() { f64::NAN } else { (-value).max(0.0) }
}

fn extremes(out: &mut Collector) {
    let cosines = || EXTREME.into_iter().filter(|value| *value <= 1.0);
    let alphas = || EXTREME.into_iter().filter(|value| *value > 0.0 && *value <= 1.0);
    let range = "arguments from the least to the largest double, cosines down to 0: distance from the interval 0 to 1";
    let indices = || EXTREME.into_iter().flat_map(|n| EXTREME.map(|k| Complex64::new(n, k)));
    // The formulas square moduli twice, which overflows beyond 1e75. Indices of real materials are below 1e3.
    let bare = largest(
        indices()
            .filter(|ior| ior.l1_norm() > 1e-75 && ior.l1_norm() < 1e75)
            .flat_map(|ior| cosines().map(move |cos| beyond_unit(interface(Complex64::ONE, ior, cos).unpolarised()))),
    );
    out.ours(
        EXTREMES,
        "Fresnel, interface()",
        "moduli of the index from 1e-75 to 1e75, cosines down to 0: distance from the interval 0 to 1",
        bare,
        0.0,
    );
    let film = largest(indices().filter(|ior| (1e-3..1e4).contains(&ior.l1_norm())).flat_map(|ior| {
        let films = [0.0, 1e-310, 1e-3, 1.0, 36.0].map(|waves| FilmLayer { ior, waves });
        films.into_iter().flat_map(|film| {
            cosines().map(move |cos| {
                beyond_unit(coated(Complex64::ONE, &[film], Complex64::new(1.5, 2.0), cos).unpolarised())
            })
        })
    }));
    out.ours(
        EXTREMES,
        "films, coated()",
        "moduli of the film's index from 1e-3 to 1e4, up to 20 um: distance from the interval 0 to 1",
        film,
        0.0,
    );
    for kind in [Distribution::Ggx, Distribution::Beckmann] {
        let d = largest(alphas().filter(|a| *a >= 1e-30).flat_map(|alpha| {
            cosines().map(move |cos| beyond_zero(scaled_distribution(kind, alpha, cos, 1.0 - cos * cos)))
        }));
        out.ours(
            EXTREMES,
            &format!("pi alpha^2 D, {}", kind.name()),
            "alphas from 1e-30 to 1: distance below 0",
            d,
            0.0,
        );
        let g = largest(alphas().filter(|a| *a >= 1e-30).flat_map(|alpha| {
            cosines().flat_map(move |a| {
                cosines().map(move |b| {
                    let [i, o] = [a, b].map(|cos| lambda(kind, alpha, cos));
                    let [s, h] = [Correlation::Separable, Correlation::Height].map(|c| beyond_unit(smith(c, i, o)));
                    if s.is_nan() { s } else { largest([s, h].into_iter()) }
                })
            })
        }));
        out.ours(EXTREMES, &format!("Smith's masking, {}", kind.name()), range, g, 0.0);
    }
    let masks = largest(cosines().flat_map(|a| {
        cosines().flat_map(move |b| {
            cosines().map(move |d| {
                let all = [v_cavity(a, b, 1.0, d), schlick_smith(0.3, a, b)];
                largest(all.into_iter().map(beyond_unit).chain([beyond_zero(kelemen(a, b, d))]))
            })
        })
    }));
    out.ours(EXTREMES, "V-cavities, Schlick's and Kelemen's masking", range, masks, 0.0);
    let approximations = largest([0.01, 0.5, 1.0, 1.5, 4.0].into_iter().flat_map(|n| {
        [0.0, 0.5, 10.0].into_iter().flat_map(move |k| {
            let below = Complex64::new(n, k);
            cosines().map(move |cos| {
                let values =
                    [complex_f0(1.0, below, cos), Lazanyi::fit(1.0, below).eval(cos), F82::of(1.0, below).eval(cos)];
                largest(values.into_iter().map(|v| if v.is_finite() { 0.0 } else { f64::NAN }))
            })
        })
    }));
    out.push(
        EXTREMES,
        "Schlick's forms (complex F0, Lazanyi, F82)",
        false,
        "0 if all values are finite",
        approximations,
        0.0,
        "A value is not finite.",
    );
    let average = largest([1.0 + 1e-3, 1.01, 1.5, 4.0, 100.0].into_iter().map(|n| beyond_unit(dielectric_average(n))));
    out.ours(
        EXTREMES,
        "mean reflectance, closed form",
        "indices from 1.001 to 100: distance from the interval 0 to 1",
        average,
        0.0,
    );
    let escape = largest(cosines().flat_map(|cos| {
        alphas().flat_map(move |alpha| {
            [1e-7, 0.25, 0.667, 0.999_999, 1.0, 4.0].map(|eta| beyond_unit(escaping_share(cos, alpha, eta)))
        })
    }));
    out.ours(EXTREMES, "share that escapes total reflection", range, escape, 0.0);
    let round_trip = largest(
        [1e-4, 1e-3, 0.1, 0.9].into_iter().map(|alpha| (spread::alpha(spread::variance(alpha)) / alpha - 1.0).abs()),
    );
    out.ours(EXTREMES, "variance of a lobe and back", "alphas from 1e-4 to 0.9, relative", round_trip, 1e-9);
}
