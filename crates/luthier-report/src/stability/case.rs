//! The stacks that methods are stressed on.

use super::aim::Aim;
use luthier_model::Quantity;
use luthier_optics::Rgb;
use luthier_optics::constants::dataset;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Diffuse, Distribution, Film, FilmThickness, Layer, Slab, Stack, Surface};

/// A stack and directions at which methods are stressed.
///
/// ```
/// use luthier_report::stability::cases;
///
/// let furnace = cases().into_iter().find(|case| case.id == "furnace-1").expect("a white furnace");
/// assert!(furnace.swept.is_none() && furnace.stack.layers.len() == 1);
/// ```
#[derive(Debug, Clone)]
pub struct StressCase {
    /// Name, unique.
    pub id: String,
    /// Description of the case, for a reader.
    pub title: String,
    /// The quantity that is swept, and its value.
    pub swept: Option<(Quantity, f64)>,
    /// Directions of the light and of the eye.
    pub aim: Aim,
    /// Whether the colour is spectral. If not, it has three wavelengths.
    pub is_spectral: bool,
    /// Stack of the case.
    pub stack: Stack,
}

fn constant(n: f64, k: f64) -> Ior {
    // All indices of this file are valid. Vacuum, should one not be, would change every verdict.
    Ior::constant(n, k).unwrap_or_else(|_| Ior::vacuum())
}

fn layer(alpha: f64, base: Base) -> Layer {
    Layer { films: Vec::new(), surface: Surface::isotropic(Distribution::Ggx, alpha), base }
}

fn coat(alpha: f64, n: f64, depth: f64) -> Layer {
    let slab = Slab { thickness_um: 1.0, absorption_per_um: [depth; 3] };
    layer(alpha, Base::Dielectric { ior: constant(n, 0.0), slab })
}

fn metal(alpha: f64, n: f64, k: f64) -> Layer {
    layer(alpha, Base::Conductor { ior: constant(n, k) })
}

/// A mirror that reflects everything at all angles. Its index has next to no real part: a material file cannot state zero.
fn mirror(alpha: f64) -> Layer {
    metal(alpha, 1e-12, 10.0)
}

fn diffuse(albedo: Rgb, sigma: f64) -> Layer {
    layer(0.0, Base::Diffuse(Diffuse { albedo, sigma }))
}

fn filmed(n: f64, nm: f64, mut below: Layer) -> Layer {
    below.films = vec![Film { ior: constant(n, 0.0), thickness: FilmThickness { min_nm: nm, max_nm: nm } }];
    below
}

fn in_air(layers: Vec<Layer>) -> Stack {
    Stack { exterior: Ior::vacuum(), layers }
}

/// A metal like copper or silver, the base of ordinary cases.
fn bright(alpha: f64) -> Layer {
    metal(alpha, 0.2, 3.0)
}

/// Collects cases.
struct Cases(Vec<StressCase>);

impl Cases {
    fn add(&mut self, id: &str, title: &str, stack: Stack) -> &mut StressCase {
        let aim = Aim::Ordinary;
        let case =
            StressCase { id: id.to_owned(), title: title.to_owned(), swept: None, aim, is_spectral: false, stack };
        self.0.push(case);
        let last = self.0.len() - 1;
        &mut self.0[last]
    }

    fn sweep(&mut self, quantity: Quantity, values: &[f64], title: &str, make: impl Fn(f64) -> Stack) {
        let stem = match quantity {
            Quantity::Index => "index",
            Quantity::Alpha => "alpha",
            Quantity::FilmNm => "film",
            Quantity::Layers => "layers",
            Quantity::OpticalDepth => "depth",
            Quantity::MetalK => "k",
        };
        for &value in values {
            let case = self.add(&format!("{stem}-{value:e}"), &format!("{title}: {value:?}"), make(value));
            case.swept = Some((quantity, value));
        }
    }
}

/// All cases, in the order of the page.
pub fn cases() -> Vec<StressCase> {
    let mut cases = Cases(Vec::new());
    sweeps(&mut cases);
    singular(&mut cases);
    colours(&mut cases);
    directions(&mut cases);
    cases.0
}

fn sweeps(cases: &mut Cases) {
    let indices = [0.25, 0.5, 0.667, 0.9, 1.01, 1.33, 1.5, 1.9, 2.0, 2.5, 4.0];
    cases.sweep(Quantity::Index, &indices, "coat of alpha 0.1 over metal of alpha 0.2, index", |n| {
        in_air(vec![coat(0.1, n, 0.0), bright(0.2)])
    });
    let alphas = [1e-310, 1e-4, 1e-3, 0.01, 0.1, 0.3, 0.6, 1.0];
    cases.sweep(Quantity::Alpha, &alphas, "bare metal, GGX, alpha", |alpha| in_air(vec![bright(alpha)]));
    let films = [1e-6, 1e-3, 100.0, 300.0, 1000.0, 5000.0, 20_000.0];
    cases.sweep(
        Quantity::FilmNm,
        &films,
        "film of index 1.4 on metal of alpha 0.1, three wavelengths, thickness in nm",
        |nm| in_air(vec![filmed(1.4, nm, metal(0.1, 1.0, 6.69))]),
    );
    let counts = [1.0, 2.0, 4.0, 8.0, 32.0];
    cases.sweep(
        Quantity::Layers,
        &counts,
        "coats of alpha 0.05 and indices 1.3 and 1.5 in turn, over white; number of layers",
        |count| {
            let coats = (0..count as usize - 1).map(|i| coat(0.05, if i.is_multiple_of(2) { 1.3 } else { 1.5 }, 0.0));
            in_air(coats.chain([diffuse([0.8; 3], 0.0)]).collect())
        },
    );
    let depths = [0.0, 1e-310, 0.1, 1.0, 10.0, 1e6, 1e300];
    cases.sweep(Quantity::OpticalDepth, &depths, "coat of alpha 0.1, index 1.5, over white; optical depth", |depth| {
        in_air(vec![coat(0.1, 1.5, depth), diffuse([0.8; 3], 0.0)])
    });
    let extinctions = [0.0, 1e-310, 1e-3, 3.0, 100.0, 1e4, 1e10, 1e30, 1e150];
    cases.sweep(Quantity::MetalK, &extinctions, "bare metal of alpha 0.1, n = 1.5, k", |k| {
        in_air(vec![metal(0.1, 1.5, k)])
    });
}

/// Values at which a formula divides by zero, or at which a promise breaks most easily.
fn singular(cases: &mut Cases) {
    cases.add("matched", "coat of index 1 over metal", in_air(vec![coat(0.1, 1.0, 0.0), bright(0.2)]));
    cases.add("index-tiny", "bare metal, n = 1e-300, k = 0.5", in_air(vec![metal(0.1, 1e-300, 0.5)]));
    cases.add("index-huge", "coat of index 1e30 over metal", in_air(vec![coat(0.1, 1e30, 0.0), bright(0.2)]));
    cases.add("lossless-metal", "almost lossless metal, n = 0.01, k = 10", in_air(vec![metal(0.1, 0.01, 10.0)]));
    cases.add("furnace-1", "white furnace: mirror of alpha 1", in_air(vec![mirror(1.0)]));
    let coated = in_air(vec![coat(0.1, 1.5, 0.0), mirror(0.1)]);
    cases.add("furnace-2", "white furnace: coat of alpha 0.1, index 1.5, over a mirror of alpha 0.1", coated.clone());
    for (id, n) in [("furnace-3", 1.5), ("furnace-4", 4.0)] {
        let title = format!("white furnace: coat of alpha 0.1, index {n}, over white");
        cases.add(id, &title, in_air(vec![coat(0.1, n, 0.0), diffuse([1.0; 3], 0.0)]));
    }
    let smooth = in_air(vec![coat(0.0, 1.5, 0.0), mirror(0.0)]);
    cases.add("q-zero", "smooth coat over a smooth mirror, seen at grazing angles: 1 - R21 Rb goes to 0", smooth).aim =
        Aim::Grazing;
    for (top, base) in [(0.4, 0.05), (0.2, 0.2), (0.3, 0.01)] {
        let stack = in_air(vec![coat(top, 1.5, 0.0), mirror(base)]);
        cases.add(
            &format!("frosted-{top}-{base}"),
            &format!("coat of alpha {top} over a mirror of alpha {base}"),
            stack,
        );
    }
    let high = in_air(vec![coat(0.8, 2.4, 0.0), metal(0.8, 3.2, 3.3)]);
    cases
        .add("rough-high", "coat of alpha 0.8 and index 2.4 over chromium of alpha 0.8, at grazing angles", high)
        .aim = Aim::Grazing;
    let brushed = Surface { distribution: Distribution::Ggx, alpha_x: 1e-3, alpha_y: 1.0, rotation: 0.5 };
    let base = bright(0.0).base;
    cases.add(
        "brushed",
        "metal of alpha 0.001 along and 1 across",
        in_air(vec![Layer { films: Vec::new(), surface: brushed, base }]),
    );
    for alpha in [1e-3, 1.0] {
        let mut layer = bright(alpha);
        layer.surface.distribution = Distribution::Beckmann;
        cases.add(&format!("beckmann-{alpha}"), &format!("bare metal, Beckmann, alpha {alpha}"), in_air(vec![layer]));
    }
    let sigma = std::f64::consts::FRAC_PI_2;
    cases.add("oren-nayar", "white Oren-Nayar base with a sigma of 90 degrees", in_air(vec![diffuse([1.0; 3], sigma)]));
    cases.add(
        "from-inside",
        "from index 1.5 through a gap of index 1 onto white",
        Stack { exterior: constant(1.5, 0.0), layers: vec![coat(0.1, 1.0, 0.0), diffuse([0.8; 3], 0.0)] },
    );
    cases.add(
        "tunnel",
        "100 nm of air between glass and glass: frustrated total reflection",
        Stack {
            exterior: constant(1.5, 0.0),
            layers: vec![filmed(1.0, 100.0, coat(0.01, 1.5, 0.0)), diffuse([0.0; 3], 0.0)],
        },
    );
}

/// Colours outside the gamut, and fringes that three wavelengths miss.
fn colours(cases: &mut Cases) {
    if let Some(gold) = dataset("au") {
        let base = Base::Conductor { ior: gold.ior.clone() };
        cases
            .add("gold", "gold, spectral: its red is above 1, out of the gamut", in_air(vec![layer(0.1, base)]))
            .is_spectral = true;
    }
    for (nm, what) in [(380.0, "out of the gamut"), (20_000.0, "fringes narrower than the colour-matching curves")] {
        let stack = in_air(vec![filmed(2.4, nm, metal(0.1, 1.0, 6.69))]);
        let case =
            cases.add(&format!("film-spectral-{nm}"), &format!("film of index 2.4, {nm} nm, spectral: {what}"), stack);
        case.is_spectral = true;
    }
    let soap = in_air(vec![filmed(1.33, 400.0, coat(1e-3, 1.0, 0.0)), diffuse([0.0; 3], 0.0)]);
    cases.add("soap", "free soap film, 400 nm, spectral", soap).is_spectral = true;
}

/// Hard directions on three ordinary stacks.
fn directions(cases: &mut Cases) {
    let stacks = [
        ("metal", in_air(vec![bright(0.3)])),
        ("coated", in_air(vec![coat(0.2, 1.5, 0.1), bright(0.4)])),
        ("chalk", in_air(vec![coat(0.2, 1.5, 0.1), diffuse([0.8, 0.5, 0.2], 0.3)])),
    ];
    for aim in [Aim::Grazing, Aim::Mirror, Aim::Opposite, Aim::Retro] {
        for (name, stack) in &stacks {
            let title = format!("{}: {name}", aim.title());
            cases.add(&format!("{}-{name}", aim.name()), &title, stack.clone()).aim = aim;
        }
    }
}
