//! `families`: errors of families of lobes against the simulation, at slope parameters and colours that no fit saw.

use std::fmt::Write as _;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use clap::ValueEnum;
use luthier_layers::models::lobes::{Family, FitSettings, Mix, Paint, Slopes, Varied, Varying};
use luthier_layers::registry::model;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::sampling::split_mix::SplitMix64;
use luthier_optics::schlick::{DIELECTRIC_F0, DIELECTRIC_INDEX};
use luthier_optics::stack::{Base, Diffuse, Distribution, Layer, Slab, Stack, Surface};
use luthier_report::{ModelSubject, Reference, Shown, ViewError};
use luthier_terminal::{Bar, Failure, Outcome, deliver};
use rayon::prelude::*;

use crate::cli::{FamiliesOptions, FamilyGroup as Group};
use crate::lobes::{JUDGE_SEED, judge_settings, ranks};

/// Angles of the judge against the normal, degrees: those of `lobes`.
const THETAS_DEG: [f64; 9] = [0.0, 7.0, 30.0, 45.0, 60.0, 70.0, 77.0, 80.0, 85.0];

/// The model beside, which shows such maps, too.
const BESIDE: &str = "belcour";

const WAVELENGTHS_NM: [f64; 3] = [645.0, 525.0, 445.0];

/// Index of coats.
const COAT_INDEX: f64 = 1.5;

/// Slope parameters of coat and base in all groups.
const RANGES: [[f64; 2]; 2] = [[0.001, 0.8], [0.001, 1.0]];

/// Largest distance of the two slope parameters of an anisotropic base from their mean, over that mean: one is nine times the other.
const APART: f64 = 0.8;

impl Group {
    /// As the command line has it.
    fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }

    fn title(self) -> &'static str {
        match self {
            Self::Metal => "coat over metal of any colour, GGX",
            Self::MetalBeckmann => "coat over metal of any colour, Beckmann",
            Self::Plastic => "coat over plastic of any colour",
            Self::Mixture => "coat over one interface half way from plastic to metal",
            Self::Tinted => "tinted coat over metal or plastic of any colour",
            Self::TwoCoats => "two coats over metal of a complex index",
            Self::Copper => "coat over metal of a complex index",
            Self::Bare => "metal or plastic of any colour without a coat",
            Self::Brushed => "coat over anisotropic metal of any colour",
        }
    }

    fn is_metallic(self) -> bool {
        !matches!(self, Self::TwoCoats | Self::Copper)
    }

    /// The stack without metal, or the metal of a complex index.
    fn stack(self, tint: Rgb) -> Stack {
        let distribution = if self == Self::MetalBeckmann { Distribution::Beckmann } else { Distribution::Ggx };
        let layer = |base| Layer { films: vec![], surface: Surface::isotropic(distribution, 1.0), base };
        let clear = |n: f64, tint| Base::Dielectric {
            ior: constant(n, 0.0),
            slab: Slab { thickness_um: 1.0, absorption_per_um: tint },
        };
        let above = constant(if self == Self::Bare { 1.0 } else { COAT_INDEX }, 0.0);
        let ior = Ior::engine(&above, DIELECTRIC_INDEX);
        let plastic = Base::Dielectric {
            ior: ior.with_f0([DIELECTRIC_F0; 3]),
            slab: Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] },
        };
        let diffuse = Base::Diffuse(Diffuse { albedo: [0.5; 3], sigma: 0.0 });
        let mut second = layer(clear(1.35, [0.0; 3]));
        second.surface = Surface::isotropic(distribution, 0.1);
        let metal = Base::Conductor { ior: constant(0.4, 2.6) };
        let layers = match self {
            Self::TwoCoats => vec![layer(clear(COAT_INDEX, tint)), second, layer(metal)],
            Self::Copper => vec![layer(clear(COAT_INDEX, tint)), layer(metal)],
            Self::Bare => vec![layer(plastic), layer(diffuse)],
            _ => vec![layer(clear(COAT_INDEX, tint)), layer(plastic), layer(diffuse)],
        };
        Stack { exterior: Ior::vacuum(), layers }
    }
}

fn constant(n: f64, k: f64) -> Ior {
    Ior::constant(n, k).unwrap_or_else(|_| Ior::vacuum())
}

/// A place: slope parameters of coat and base, colours, and the stack there.
struct Place {
    slopes: [Slopes; 2],
    paint: Paint,
    stack: Stack,
    words: String,
}

/// A random place of a group by number.
fn place(group: Group, family: Family, number: u64) -> Place {
    let mut random = SplitMix64::new(number.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1));
    let mut uniform = || random.unit();
    // Roots are uniform, as nodes are.
    let alphas = RANGES.map(|[least, most]| {
        let root = least.sqrt() + uniform() * (most.sqrt() - least.sqrt());
        root * root
    });
    let color = [0; 3].map(|_: i32| uniform());
    let tint = [0; 3].map(|_: i32| if group == Group::Tinted { 0.7 * uniform() } else { 0.0 });
    let metallic = match group {
        Group::Metal | Group::MetalBeckmann | Group::Brushed => 1.0,
        Group::Plastic => 0.0,
        Group::Mixture => 0.5,
        _ => {
            if uniform() < 0.5 {
                1.0
            } else {
                0.0
            }
        }
    };
    // Metals reflect more.
    let color = if metallic == 1.0 { color.map(|c| 0.3 + 0.7 * c) } else { color };
    let mut slopes = alphas.map(Slopes::from);
    if group == Group::Brushed {
        let (apart, angle) = (APART * uniform(), std::f64::consts::PI * uniform());
        let along = [1.0 + apart, 1.0 - apart].map(|share| (alphas[1] * share).min(1.0));
        slopes[1] = Slopes { along, turn: [libm::cos(angle), libm::sin(angle)] };
    }
    let level = family.apply(&group.stack(tint), slopes);
    let plain = Paint::of(&level);
    let mix = Mix { metal: color, tint: [1.0; 3], dielectric: [0.04; 3], matt: color, metallic };
    let paint = if group.is_metallic() { plain.mixed(mix) } else { plain };
    let stack = match group {
        Group::TwoCoats | Group::Copper => level,
        Group::Mixture => {
            let (f0, albedo) = luthier_optics::schlick::metallic_roughness(color, metallic);
            let mut one = Paint { albedo, ..paint }.plastic_of(&level);
            if let Base::Dielectric { ior, .. } = &mut one.layers[family.interface].base {
                *ior = ior.clone().with_f0(f0);
            }
            one
        }
        _ if metallic == 1.0 => paint.metal_of(&level),
        _ => paint.plastic_of(&level),
    };
    let [coat, base] = alphas;
    let words = format!(
        "coat {coat:.3}, base {}, {} ({:.2}, {:.2}, {:.2})",
        if group == Group::Brushed {
            format!("{:.3} and {:.3}", slopes[1].along[0], slopes[1].along[1])
        } else {
            format!("{base:.3}")
        },
        if metallic == 1.0 { "metal" } else { "plastic" },
        color[0],
        color[1],
        color[2]
    );
    Place { slopes, paint, stack, words }
}

/// Largest errors of a place, of the family and of the model beside.
struct Judged {
    words: String,
    own: [f64; 2],
    views: [Vec<f64>; 2],
    beside: [f64; 2],
    noise: f64,
}

/// A group, fitted and judged.
struct Results {
    group: Group,
    family: Family,
    seconds: f64,
    places: Vec<Judged>,
}

/// Fits and judges, as a page.
pub(crate) fn run(options: &FamiliesOptions) -> Outcome {
    let color = Color::ThreeWavelengths(WAVELENGTHS_NM);
    let groups = if options.group.is_empty() { Group::value_variants() } else { &options.group };
    let total = groups.len() as u64 * u64::from(options.places);
    let (bar, done) = (Bar::new("fitting and judging"), AtomicU64::new(0));
    let results = groups.iter().map(|&group| {
        let stack = group.stack([0.0; 3]);
        let family = Family::new(&stack, RANGES[0], RANGES[1], group.is_metallic())?;
        let (start, before) = (Instant::now(), thread_seconds());
        let settings = FitSettings { rows: options.rows as usize, ..FitSettings::default() };
        let varied = Varied::with(&stack, &color, Some(Varying::Family(family)), settings);
        // Other work on the machine does not count, where the system tells.
        let own = thread_seconds().zip(before).map(|(after, before)| after - before);
        let seconds = own.unwrap_or_else(|| start.elapsed().as_secs_f64());
        let places = (0..u64::from(options.places)).into_par_iter().map(|number| {
            let place = place(group, family, number);
            let judged = judge(&place, &varied, options);
            bar.set(done.fetch_add(1, Ordering::Relaxed) + 1, total);
            judged
        });
        Some(Results { group, family, seconds, places: places.collect::<Option<_>>()? })
    });
    let results: Vec<Results> = results.flatten().collect();
    drop(bar);
    let page = page(&results, options).map_err(Failure::input)?;
    deliver(&page, options.destination.output.as_deref())
}

/// Seconds that this thread has run, where Linux tells.
fn thread_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}

fn judge(place: &Place, varied: &Varied, options: &FamiliesOptions) -> Option<Judged> {
    let subject = ModelSubject { name: String::new(), stack: place.stack.clone(), wavelengths_nm: WAVELENGTHS_NM };
    let reference = Reference::new(&subject, &THETAS_DEG, judge_settings(&options.precision, JUDGE_SEED));
    let lobes = varied.painted(place.slopes, &place.paint)?;
    let own = reference.errors(Shown::Lobes(&lobes));
    let beside = reference.errors(Shown::Model(model(BESIDE)?.as_ref()));
    let largest = |views: &[ViewError]| {
        views
            .iter()
            .fold([0.0; 2], |most: [f64; 2], view| [most[0].max(view.lobe.error), most[1].max(view.albedo.error)])
    };
    Some(Judged {
        words: place.words.clone(),
        own: largest(&own),
        views: [own.iter().map(|view| view.lobe.error).collect(), own.iter().map(|view| view.albedo.error).collect()],
        beside: largest(&beside),
        noise: own.iter().map(|view| view.lobe_floor).fold(0.0, f64::max),
    })
}

fn page(results: &[Results], options: &FamiliesOptions) -> Result<String, std::fmt::Error> {
    let mut out = String::new();
    writeln!(
        out,
        "# Families of lobes\n\nGenerated by `luthier-lab families{} --places {} --noise {} --rows {}`.\n",
        options.group.iter().map(|group| format!(" --group {}", group.name())).collect::<String>(),
        options.places,
        options.precision.noise,
        options.rows
    )?;
    out.push_str(INTRODUCTION);
    writeln!(
        out,
        "\n## Errors\n\n| group | error | median | 95th percentile | largest | {BESIDE}: median | 95th percentile | largest |\n\
         |---|---|--:|--:|--:|--:|--:|--:|"
    )?;
    for Results { group, places, .. } in results {
        for (quantity, (name, digits)) in [("lobe", 3), ("albedo", 4)].into_iter().enumerate() {
            let [own, beside] = [false, true].map(|is_beside| {
                ranks(places.iter().map(|place| if is_beside { place.beside } else { place.own }[quantity]))
            });
            let cells = own.iter().chain(&beside).map(|value| format!(" {value:.digits$} |"));
            writeln!(out, "| {} | {name} |{}", group.title(), cells.collect::<String>())?;
        }
        for (quantity, (name, digits)) in [("lobe", 3), ("albedo", 4)].into_iter().enumerate() {
            let views = ranks(places.iter().flat_map(|place| place.views[quantity].iter().copied()));
            let cells = views.iter().map(|value| format!(" {value:.digits$} |"));
            writeln!(out, "| | {name}, of single views |{} | | |", cells.collect::<String>())?;
        }
    }
    let noise = results.iter().flat_map(|group| &group.places).map(|place| place.noise).fold(0.0, f64::max);
    writeln!(out, "\nThe judge's own random numbers make a lobe error of at most {noise:.3}.")?;
    writeln!(
        out,
        "\n## Tables\n\nTexels of half floats, with the ends of each part repeated.\n\n\
         | group | nodes of the coat | of the base | rows | bytes | seconds of one core |\n|---|--:|--:|--:|--:|--:|"
    )?;
    for Results { group, family, seconds, .. } in results {
        let parts = (family.parts(*group == Group::Tinted, false, false) as i32 - family.first_part()) as usize;
        let bytes = family.nodes() * (options.rows as usize + 2) * parts * 8;
        writeln!(
            out,
            "| {} | {} | {} | {} | {bytes} | {seconds:.0} |",
            group.title(),
            family.coat.nodes,
            family.base.nodes,
            options.rows
        )?;
    }
    writeln!(
        out,
        "\n## The worst places\n\n| group | place | lobe error | albedo error | lobe error of {BESIDE} |\n|---|---|--:|--:|--:|"
    )?;
    for Results { group, places, .. } in results {
        let mut worst: Vec<&Judged> = places.iter().collect();
        worst.sort_by(|a, b| b.own[0].total_cmp(&a.own[0]));
        for place in worst.into_iter().take(WORST) {
            let [lobe, albedo] = place.own;
            writeln!(
                out,
                "| {} | {} | {lobe:.3} | {albedo:.4} | {:.3} |",
                group.title(),
                place.words,
                place.beside[0]
            )?;
        }
    }
    Ok(out)
}

/// Places of a group with the largest errors that the page lists.
const WORST: usize = 3;

const INTRODUCTION: &str = "\
Where textures vary slope parameters or colours of single layers, the rows of `lobes` are a family (`luthier-layers/src/models/lobes/family`): one table over the slope
parameters of the first interface and of the lowest, the base, with colours in closed form. This page compares such tables with another simulation, the judge, at places
that no fit saw. Roots of slope parameters are uniform, those of coats up to .8 and of bases up to 1; colours are uniform, those of metals from .3.

Errors are those of [lobes.md](lobes.md): the largest over three wavelengths and nine angles of the eye, 0 to 85 degrees, so that one number stands for a place. The lines *of
single views* have every angle and wavelength by itself. Beside are the errors of the model that showed such maps before, with the stack of the place.

A texel of `metallic` between 0 and 1 is a mix of two surfaces by area, whose light is the mean of both: its errors are at most those of its ends. The group *half way* compares it with the one interface that a
number `metallic = 0.5` in a file means. Both are meanings of the same parameter, and they differ most where the colour is bright.

Anisotropic interfaces read the rows of the mean of their two slope parameters, and their lobes are stretched in closed form: neither anisotropy nor its direction is an axis. The group has bases with slope parameters up to
a ratio of nine. Its tables are those of the first group.

Not in families: films that vary on a base without an F0. Files with such maps take another model. A coat with a weight lies over a family of its own.
";
