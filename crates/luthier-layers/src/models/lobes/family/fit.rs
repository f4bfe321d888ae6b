//! Rows of a family from the light of its nodes.

use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::Stack;

use super::Family;
use super::trace::{BETWEEN, DEPTH, Energies, Node, Rest, SHADES, WHITE};
use crate::models::lobes::fit::{Found, Simulation, indices};
use crate::models::lobes::{
    BaseLight, FirstInterface, FitSettings, Frame, Lobe, Lobes, Painted, Row, ViewAxis, Wide, base_below, shown,
};

/// Coefficients of a remainder that no light decides.
const PLAIN_FALLOFF: [f64; 2] = [0.3, 0.0];

impl Family {
    /// The rows of each node of a stack, slopes over [`Self::spreads`].
    pub(in crate::models::lobes) fn lobes(self, stack: &Stack, color: &Color, settings: FitSettings) -> Vec<Lobes> {
        let stack = shown(stack);
        let axis = ViewAxis::of(&stack, settings.rows);
        // Half vectors of the medium below the first interface; those of a stack without a coat have no lobes.
        let index = indices(&stack).get(1).copied().unwrap_or(1.0);
        let first = FirstInterface::of(&stack, color);
        let base = base_below(&stack);
        let mut beside: Vec<Option<[Found; 2]>> = (0..self.nodes()).map(|_| None).collect();
        let mut nodes = Vec::new();
        for number in 0..self.nodes() {
            let node = Node::new(self, number, axis, index, &stack, color, settings);
            let spreads = Self::spreads(self.alphas(number));
            // Fits follow each other from node to node: first over the slopes of the base, and each first one from that of the coat before.
            let before = if number.is_multiple_of(self.base.nodes) {
                number.checked_sub(self.base.nodes)
            } else {
                Some(number - 1)
            };
            let found = if let [once, more] = &node.lobes[..] {
                let known = before.and_then(|before| Some((before, beside[before].as_ref()?)));
                let next = |lobe: usize, simulation: &Simulation| {
                    simulation.lobe(known.map(|(before, found)| {
                        (&found[lobe], spreads[lobe] / Self::spreads(self.alphas(before))[lobe])
                    }))
                };
                Some([next(0, once), next(1, more)])
            } else {
                None
            };
            let falloff = node.falloff.unwrap_or(PLAIN_FALLOFF);
            let own = base.map_or([0.0; 3], |base| base.albedo);
            let seen = if self.is_colored { [WHITE; 3] } else { own };
            let rows = self.rows(&node, found.as_ref(), spreads, falloff, seen);
            beside[number] = found;
            nodes.push(Lobes {
                first: first.clone(),
                frame: Frame {
                    index,
                    wide: Wide::new(falloff, axis),
                    axes: None,
                    // Rows have a shape of the remainder each, as above a diffuse base.
                    base: Some(Painted { albedo: own, is_lambertian: true }),
                },
                axis,
                rows,
            });
        }
        nodes
    }

    fn rows(
        self,
        node: &Node,
        found: Option<&[Found; 2]>,
        spreads: [f64; 2],
        falloff: [f64; 2],
        albedo: Rgb,
    ) -> Vec<Row> {
        let clear = internal_of(&node.rest, albedo, |energies| energies.clear);
        let dimmed = internal_of(&node.rest, albedo, |energies| energies.dimmed);
        let energies: Vec<[Rgb; 2]> = node.rest.iter().map(|rest| self.reflected(rest)).collect();
        let lobes: Vec<Vec<Lobe>> = found.map_or(Vec::new(), |found| {
            let shaped = found.iter().zip(&node.lobes).enumerate().map(|(lobe, (found, simulation))| {
                let energies: Vec<Rgb> = energies.iter().map(|energies| energies[lobe]).collect();
                simulation.with_energies(found, &energies)
            });
            shaped.collect()
        });
        let rows = node.rest.iter().enumerate().map(|(view, rest)| {
            let lobes = lobes.iter().zip(spreads).enumerate().map(|(number, (lobes, spread))| {
                let mut lobe = lobes[view];
                lobe.shift /= spread;
                // Rows have sharpness times the root of the tail; between two tails, sharpness alone is in line.
                lobe.tail = lobe.tail.clamp(LEAST_TAIL, 1.0);
                lobe.sharpness = lobe.sharpness.map(|sharpness| sharpness * spread / lobe.tail.sqrt());
                // Energies between nodes hang on neither node's share.
                lobe.strength = energies[view][number];
                lobe
            });
            let length = |energies: &Energies, c: usize| -libm::log(ratio(energies.dimmed[c], energies.clear[c])) / DEPTH;
            let (albedo_dir, wide, energy, sent_back) = if self.is_colored {
                let facets = rest.first_facet;
                let steep = (facets[2] - facets[0]) / (SHADES[2] - SHADES[0]);
                let albedo = if self.is_coated() {
                    [facets[1], length(&rest.reflected[0], 1), length(&rest.reflected[1], 1)]
                } else {
                    [facets[0] - SHADES[0] * steep, steep, 0.0]
                };
                let wide = if self.is_coated() {
                    {
                    let white = rest.facets.clear.iter().sum::<f64>() / 3.0;
                    [white, white, 0.0]
                }
                } else {
                    chain(&rest.facets)
                };
                let passed = [0, 1].map(|c: usize| {
                    rest.base_once.clear[c] / WHITE / ((1.0 - SHADES[c]) * (1.0 - SHADES[c]))
                });
                let t1 = (passed[1] - passed[0]) / (SHADES[1] - SHADES[0]);
                let energy = [passed[0] - t1 * SHADES[0], t1, length(&rest.base_once, 0)];
                (albedo, wide, energy, closed(clear, dimmed))
            } else {
                let below = |c: usize| rest.reflected.iter().map(|part| part.clear[c]).sum::<f64>();
                let all = [0, 1, 2].map(|c: usize| rest.first_facet[c] + below(c) + rest.base.clear[c] + rest.facets.clear[c]);
                let wide = [0, 1, 2].map(|c: usize| rest.base.clear[c] + rest.facets.clear[c]);
                (all, wide, rest.base.clear, clear)
            };
            let base = Some(BaseLight { energy, internal: sent_back, falloff });
            Row { albedo_dir, lobes: lobes.collect(), wide, base }
        });
        rows.collect()
    }

    /// Numbers of the light that the base reflected once, and more often.
    fn reflected(self, rest: &Rest) -> [Rgb; 2] {
        let [once, more] = &rest.reflected;
        if !self.is_colored {
            return [once.clear, more.clear];
        }
        // With g = E / f^2, (p + q f) / (1 - R f) through three points: g = p + q f + R f g.
        let points = [(SHADES[1], more.clear[1]), (BETWEEN, more.between), (SHADES[2], more.clear[2])];
        let [.., pole] = rational(points.map(|(f, energy)| (f, energy / (f * f))));
        [chain(once), [more.clear[1], more.clear[2], pole.clamp(0.0, POLE_MAX)]]
    }
}

/// Numbers of light that many facets of the base may have reflected in one visit.
fn chain(light: &Energies) -> Rgb {
    let [low, _, high] = light.clear;
    let [.., pole] = rational([(SHADES[0], low), (BETWEEN, light.between), (SHADES[2], high)]);
    let pole = pole.clamp(0.0, POLE_MAX);
    // The line that meets both ends under this pole.
    let [low, high] = [low * (1.0 - pole * SHADES[0]), high * (1.0 - pole * SHADES[2])];
    let slope = (high - low) / (SHADES[2] - SHADES[0]);
    [low - slope * SHADES[0], light.clear[2], pole]
}

/// `(p + q f) / (1 - R f)` through three points.
fn rational(points: [(f64, f64); 3]) -> Rgb {
    let [(x, a), (y, b), (z, c)] = points;
    // Differences of p + q f + R f E = E eliminate p.
    let [[q1, r1, e1], [q2, r2, e2]] = [[y - x, y * b - x * a, b - a], [z - y, z * c - y * b, c - b]];
    let determinant = q1 * r2 - q2 * r1;
    if determinant.abs() < 1e-12 {
        return [a, 0.0, 0.0];
    }
    let [q, r] = [(e1 * r2 - e2 * r1) / determinant, (q1 * e2 - q2 * e1) / determinant];
    [a - q * x - r * x * a, q, r]
}

/// Share of the light of a Lambertian base that is sent back to it, by channel.
fn internal_of(views: &[Rest], albedo: Rgb, of: impl Fn(&Energies) -> Rgb) -> Rgb {
    [0, 1, 2].map(|c: usize| {
        let once: f64 = views.iter().map(|rest| of(&rest.base_once)[c]).sum();
        let all: f64 = views.iter().map(|rest| of(&rest.base)[c]).sum();
        if all > 0.0 && albedo[c] > 0.0 { ((all - once) / all / albedo[c]).clamp(0.0, 1.0) } else { 0.0 }
    })
}

/// Least tail of a lobe: a tail this short is hardly one, and far from 0.
const LEAST_TAIL: f64 = 0.05;

/// Largest share of trapped light that the base keeps reflecting.
const POLE_MAX: f64 = 0.98;

/// Numbers of the share sent back over the F0 of the base, and the length of paths there.
fn closed(clear: Rgb, dimmed: Rgb) -> Rgb {
    // r0 + f r1 + f^2 (1 - r0 - r1) at the first two shades: (1 - f^2) r0 + (f - f^2) r1 = share - f^2.
    let [f, g] = [SHADES[0], SHADES[1]];
    let [a, b] = [clear[0] - f * f, clear[1] - g * g];
    let [f0, f1, g0, g1] = [1.0 - f * f, f - f * f, 1.0 - g * g, g - g * g];
    let determinant = f0 * g1 - f1 * g0;
    let length = -libm::log(ratio(dimmed[0], clear[0])) / DEPTH;
    [(a * g1 - b * f1) / determinant, (b * f0 - a * g0) / determinant, length]
}

/// `a / b`, 1 unless both are positive.
fn ratio(a: f64, b: f64) -> f64 {
    if a > 0.0 && b > 0.0 { a / b } else { 1.0 }
}
