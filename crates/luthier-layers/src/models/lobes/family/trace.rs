//! Light of one node of a family, split by how often the base reflected it.

use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::schlick::{DIELECTRIC_F0, F82};
use luthier_optics::stack::{Base, Layer, Stack};

use super::film::{beyond, facing, film_on};
use super::{Family, SQUARE, WHITE};
use crate::models::lobes::fit::{Simulation, seen_from};
use crate::models::lobes::tally::{Cells, Tally};
use crate::models::lobes::{FirstInterface, FitSettings, ViewAxis, Wide};
use crate::references::layered_mc::{ColorPaths, JointPath};

/// F0 of the base in the channels of a simulation whose energies are in closed form; the middle one is where the absorption of slabs is measured.
pub(super) const SHADES: Rgb = [0.04, 0.5, 1.0];

/// Wavelength at which indices bend directions where channels are shades.
pub(super) const SODIUM_D_NM: f64 = 589.3;

/// Optical depth of the slab at which lengths of paths are measured.
pub(super) const DEPTH: f64 = 0.5;

/// Weights of light that is at no F0 between others.
const NONE: [[f64; 2]; 2] = [[0.0; 2]; 2];

/// Light of a node.
pub(super) struct Node {
    /// Light that the base reflected once, and more often.
    pub(super) lobes: [Simulation; 2],
    /// The rest, by view: that of a diffuse base apart from what neither base has sent.
    pub(super) rest: Vec<Rest>,
    /// Coefficients of the remainder.
    pub(super) falloff: Option<[f64; 2]>,
}

/// F0 where the closed forms have energies beside those of [`SHADES`]: of light of one visit to the base, and of more.
pub(super) const BETWEEN: [f64; 2] = [0.8, 0.9];

/// Energies of a view.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Rest {
    /// Light that the base reflected once, and more often.
    pub(super) reflected: [Energies; 2],
    /// Light that several facets of a colourless dielectric without a coat reflected.
    pub(super) plastic: f64,
    /// Light of a diffuse base.
    pub(super) base: Energies,
    /// Light that met the diffuse base exactly once.
    pub(super) base_once: Energies,
    /// Light of facets above alone, without that of one facet.
    pub(super) facets: Energies,
    /// Light of one facet of the first interface.
    pub(super) first_facet: Rgb,
    /// Under a film on the base, squared sine at which facets are seen, and its standard deviation; else 0.
    pub(super) facing: [f64; 2],
    /// Under a film on the base below a coat, those at which light of one visit meets the facets of the base; and of light of more visits the share that the film
    /// reflects totally, and the mean square of the rest.
    pub(super) met: Option<[[f64; 2]; 2]>,
    /// Energy that the edge tint 0 keeps of that light at an F0 of 1.
    pub(super) first_dip: f64,
}

/// Energies by channel: without a slab, and below one of [`DEPTH`].
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Energies {
    pub(super) clear: Rgb,
    pub(super) dimmed: Rgb,
    /// Without a slab, at each F0 of [`BETWEEN`].
    pub(super) between: [f64; 2],
    /// There with the edge tint [`HALF_TINT`].
    pub(super) tinted: [f64; 2],
}

impl Energies {
    fn add(&mut self, weight: Rgb, dimmed: f64, [between, tinted]: [[f64; 2]; 2]) {
        (0..2).for_each(|i| self.between[i] += between[i]);
        (0..2).for_each(|i| self.tinted[i] += tinted[i]);
        for (c, weight) in weight.into_iter().enumerate() {
            self.clear[c] += weight;
            self.dimmed[c] += weight * dimmed;
        }
    }
}

/// Schlick's s of the facets that a path met, `f + (1 - f) s` being what each reflects: that of equal facets is known from two weights.
fn steep([_, half, whole]: Rgb, facets: u32) -> f64 {
    let mean = libm::pow(half / whole, 1.0 / f64::from(facets));
    ((mean - SHADES[1]) / (1.0 - SHADES[1])).clamp(0.0, 1.0)
}

/// Cosine at facets of this s.
fn cosine(steep: f64) -> f64 {
    1.0 - libm::pow(steep, 0.2)
}

/// Squared sines at which a path met facets of the base, each with the same share of its light over a metal of the middle shade. Two facets are told apart by the
/// weights at all shades; more count as equal.
fn met(path: &JointPath) -> Vec<(f64, f64)> {
    let [dark, half, whole] = path.weight;
    if half <= 0.0 || path.facets == 0 {
        return Vec::new();
    }
    let sines = if path.facets == 2 {
        // Products of f + (1 - f) s are linear in sum and product of both s.
        let [low, middle, _] = SHADES;
        let of_half = half / whole / ((1.0 - middle) * (1.0 - middle)) - 1.0;
        let cross = low * (1.0 - low);
        let product = (dark / whole - low * low - cross * of_half) / ((1.0 - low) * (1.0 - low) - cross);
        let mean = 0.5 * (of_half - product);
        let root = (mean * mean - product).max(0.0).sqrt();
        vec![mean - root, mean + root]
    } else {
        vec![steep(path.weight, path.facets)]
    };
    let share = half / sines.len() as f64;
    let squares = sines.into_iter().map(|steep| {
        let cos_theta = cosine(steep.clamp(0.0, 1.0));
        ((1.0 - cos_theta) * (1.0 + cos_theta), share)
    });
    squares.collect()
}

/// Weights of a path at each F0 of [`BETWEEN`], and with [`HALF_TINT`] there, from those of [`SHADES`].
fn between(weight: Rgb, facets: u32, is_tinted: bool) -> [[f64; 2]; 2] {
    let [_, half, whole] = weight;
    if half <= 0.0 || whole <= 0.0 || facets == 0 {
        return [[whole; 2]; 2];
    }
    let steep = steep(weight, facets);
    let between = BETWEEN.map(|f| whole * libm::pow(f + (1.0 - f) * steep, f64::from(facets)));
    if !is_tinted {
        return [between; 2];
    }
    let cos_theta = cosine(steep);
    let tinted = BETWEEN.map(|f0| {
        let curve = F82 { f0, tint: HALF_TINT };
        whole * libm::pow(curve.eval(cos_theta), f64::from(facets))
    });
    [between, tinted]
}

/// An edge tint at which its effect is measured.
pub(super) const HALF_TINT: f64 = 0.5;

/// The stack whose base is a metal of all shades.
fn of_metal(family: Family, stack: &Stack) -> Stack {
    let mut metal = clear(stack);
    metal.layers.truncate(family.interface + 1);
    if let Some(Layer { base, films, .. }) = metal.layers.last_mut()
        && let Base::Conductor { ior } | Base::Dielectric { ior, .. } = base
    {
        *base = Base::Conductor { ior: ior.clone().with_f0(SHADES) };
        films.clear();
    }
    metal
}

/// The stack over a metal of F0 1 with an edge tint.
fn of_mirror(stack: &Stack, tint: f64) -> Stack {
    let mut metal = stack.clone();
    if let Some(Base::Conductor { ior }) = metal.layers.last_mut().map(|layer| &mut layer.base) {
        *ior = ior.clone().with_f0([1.0; 3]).with_f82_tint([tint; 3]);
    }
    metal
}

/// The stack without metal, with the F0 that rows know over a diffuse base of [`WHITE`].
fn of_plastic(stack: &Stack) -> Option<Stack> {
    let mut plastic = clear(stack);
    let [.., Layer { films, base: interface, .. }, Layer { base: Base::Diffuse(base), .. }] =
        plastic.layers.as_mut_slice()
    else {
        return None;
    };
    films.clear();
    if let Base::Dielectric { ior, .. } = interface {
        *ior = ior.clone().with_f0([DIELECTRIC_F0; 3]);
    }
    base.albedo = [WHITE; 3];
    Some(plastic)
}

/// The stack without the absorption of its first slab.
fn clear(stack: &Stack) -> Stack {
    let mut clear = stack.clone();
    if let Some(Base::Dielectric { slab, .. }) = clear.layers.first_mut().map(|layer| &mut layer.base) {
        slab.absorption_per_um = [0.0; 3];
    }
    clear
}

impl Node {
    /// Traces the paths of a node.
    pub(super) fn new(
        family: Family,
        node: usize,
        axis: ViewAxis,
        index: f64,
        stack: &Stack,
        color: &Color,
        settings: FitSettings,
    ) -> Self {
        let alphas = family.alphas(node);
        let plain = family.apply(stack, alphas);
        // Channels stand for shades of the metal, not for wavelengths.
        let shades = Color::ThreeWavelengths([SODIUM_D_NM; 3]);
        let color = if family.is_metallic { &shades } else { color };
        // A base that is metallic in places has two simulations.
        let (here, below) = if family.is_metallic {
            (of_metal(family, &plain), of_plastic(&plain))
        } else if family.has_lengths {
            (clear(&plain), None)
        } else {
            (plain, None)
        };
        let spreads = Family::spreads(alphas);
        let cells = spreads.map(|spread| Cells::new(index, spread));
        let (paths, paths_below) =
            (ColorPaths::new(&here, color).rejecting(), below.map(|below| ColorPaths::new(&below, color).rejecting()));
        let first = FirstInterface::of(&here, color);
        let [untinted, tinted] = [1.0, 0.0].map(|tint| {
            let metal = family.is_tinted.then(|| of_mirror(&here, tint));
            metal.and_then(|metal| FirstInterface::of(&metal, color))
        });
        let has_base = stack.layers.len() > family.interface + 1;
        let film = film_on(stack, family);
        let (mut once, mut more, mut wide, mut rest) = (vec![], vec![], vec![], vec![]);
        for row in 0..axis.size() {
            let wo = seen_from(axis, [1.0, 0.0], row);
            let [mut of_once, mut of_more] = cells.map(|cells| Tally::new(&[cells], false));
            let mut of_rest = Tally::new(&[], true);
            let mut energies = Rest::default();
            // Nodes have families of random numbers of their own.
            let seed = settings.seed.wrapping_add(((node * axis.size() + row) as u64) << 8);
            let share = |path: &JointPath| path.weight.map(|w| w / settings.paths as f64);
            let mut add_base = |path: &JointPath, energies: &mut Rest| {
                let (weight, dimmed) = (share(path), libm::exp(-DEPTH * path.length));
                energies.base.add(weight, dimmed, NONE);
                if path.base_visits == 1 {
                    energies.base_once.add(weight, dimmed, NONE);
                }
                of_rest.add(&[], [path.wi, wo], weight, path.base_visits);
            };
            let (mut of_facets, mut squares) = (Vec::new(), [const { Vec::new() }; 2]);
            if let Some(paths) = &paths_below {
                paths.trace(seed.wrapping_add(1), settings.paths, wo, |path| match path.is_first_facet {
                    true => {}
                    _ if path.base_visits > 0 => add_base(&path, &mut energies),
                    // Below a coat the dielectric reflects as a metal of its F0 does.
                    _ if family.is_coated() => {}
                    _ => {
                        energies.plastic += share(&path)[0];
                        of_once.add(&cells[..1], [path.wi, wo], share(&path), 0);
                    }
                });
            }
            paths.trace(seed, settings.paths, wo, |path| {
                let (weight, dimmed) = (share(&path), libm::exp(-DEPTH * path.length));
                let more = match path.reflections {
                    _ if path.is_first_facet => return,
                    _ if path.base_visits > 0 => return add_base(&path, &mut energies),
                    0 if family.is_coated() => {
                        energies.facets.add(weight, 1.0, NONE);
                        of_facets.push((path.wi, weight));
                        return;
                    }
                    reflections if family.is_coated() => reflections > 1,
                    // Without a coat the second lobe has what several facets of the metal reflect, and the first that of any other base.
                    _ => family.is_metallic,
                };
                if film.is_some() && family.is_coated() {
                    squares[usize::from(more)].extend(met(&path));
                }
                energies.reflected[usize::from(more)].add(
                    weight,
                    dimmed,
                    between(weight, path.facets, family.is_tinted),
                );
                let tally = if more { &mut of_more } else { &mut of_once };
                let cells = if more { &cells[1..] } else { &cells[..1] };
                tally.add(cells, [path.wi, wo], weight, 0);
            });
            // Without a diffuse base this light decides the shape of the remainder.
            for (wi, weight) in of_facets {
                of_rest.add(&[], [wi, wo], weight, u32::from(!has_base));
            }
            energies.first_facet = first.as_ref().map_or([0.0; 3], |first| first.energy(wo));
            if let Some((ior, late)) = film {
                let [once, more] = &squares;
                energies.met = family.is_coated().then(|| [facing(once, late), beyond(more, ior)]);
                energies.facing = first.as_ref().map_or([0.0; 2], |first| first.facing(wo, late));
            }
            let [whole, left] = [&untinted, &tinted].map(|of| of.as_ref().map_or(0.0, |first| first.energy(wo)[0]));
            energies.first_dip = whole - left;
            once.push(of_once);
            more.push(of_more);
            wide.push(of_rest);
            rest.push(energies);
        }
        let falloff = Wide::fall_of(axis, &wide, SQUARE);
        let of_base = falloff.filter(|_| has_base);
        let [narrow, broad] = cells;
        let lobes = [
            // Wide light of one visit takes the shape of that of the base, or is in its lobe.
            Simulation::of_part(axis, narrow, spreads[0], once, of_base.is_some(), of_base),
            Simulation::of_part(axis, broad, spreads[1], more, true, of_base).centred(),
        ];
        Self { lobes, rest, falloff }
    }
}
