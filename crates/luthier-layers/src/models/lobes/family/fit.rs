//! Rows of a family from the light of its nodes.

use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::Stack;

use super::paint::{
    AROUND_SPREADS, MORE_SPREAD, base_index, chain, chain_numbers, dimmed, kept_by_base, trapped, trapped_numbers,
};
use super::trace::{BETWEEN, DEPTH, Energies, HALF_TINT, Node, Rest, SHADES};
use super::{Family, WHITE};
use crate::models::lobes::fit::{Found, indices, seen_from};
use crate::models::lobes::half_vector::refracted;
use crate::models::lobes::leaving::Leaving;
use crate::models::lobes::{
    BaseLight, FirstInterface, FitSettings, Frame, Lobes, Painted, Row, ViewAxis, Wide, base_below, shown,
};

impl Family {
    /// The rows of each node of a stack, slopes over [`Self::spreads`], and the family with the numbers of all rows.
    pub(in crate::models::lobes) fn lobes(
        self,
        stack: &Stack,
        color: &Color,
        settings: FitSettings,
    ) -> (Self, Vec<Lobes>) {
        let stack = shown(stack);
        let axis = ViewAxis::of(&stack, settings.rows);
        // Half vectors of the medium below the coat, or next to those outside.
        let media = indices(&self.apply(&stack, self.alphas(self.nodes() / 2)));
        let index = media.get(usize::from(self.is_coated())).copied().unwrap_or(1.0);
        let first = FirstInterface::of(&stack, color);
        let base = base_below(&stack);
        let mut beside: Vec<Option<[Found; 2]>> = (0..self.nodes()).map(|_| None).collect();
        let tail = if self.has_tail { LEAST_TAIL } else { 1.0 };
        let (mut nodes, mut sent_back) = (Vec::new(), Vec::new());
        for number in 0..self.nodes() {
            let node = Node::new(self, number, axis, index, &stack, color, settings);
            let spreads = Self::spreads(self.alphas(number));
            // Fits follow each other from node to node: first over the slopes of the base, and each first one from that of the coat before.
            let before = if number.is_multiple_of(self.base.nodes) {
                number.checked_sub(self.base.nodes)
            } else {
                Some(number - 1)
            };
            let known = before.and_then(|before| Some((before, beside[before].as_ref()?)));
            let found = [0, 1].map(|lobe: usize| {
                node.lobes[lobe].lobe(
                    tail,
                    known.map(|(before, found)| {
                        (&found[lobe], spreads[lobe] / Self::spreads(self.alphas(before))[lobe])
                    }),
                )
            });
            // The remainder takes the shape of the light of a diffuse base, or else that of trapped light.
            let falloff = node.falloff.filter(|_| base.is_some()).unwrap_or(found[1].wide_falloff());
            let own = base.map_or([0.0; 3], |base| base.albedo);
            let seen = if self.is_metallic { [WHITE; 3] } else { own };
            sent_back.push(internal_of(&node.rest, seen, |energies| energies.clear)[0]);
            let media = [index, base_index(&stack)];
            let rows = self.rows(&node, &found, spreads, (axis, media, self.alphas(number)[0]), falloff, seen);
            beside[number] = Some(found);
            nodes.push(Lobes {
                first: first.clone(),
                frame: Frame {
                    // Rows have a shape of the remainder each, as above a diffuse base.
                    base: Some(Painted { albedo: own, is_lambertian: true }),
                    ..Frame::new(index, Wide::new(falloff, axis))
                },
                axis,
                rows,
            });
        }
        if self.has_tail {
            self.hold_shares(&mut nodes);
        }
        let sent_back = if self.is_metallic { sent_back } else { Vec::new() };
        (self.with_sent_back(&sent_back), nodes)
    }

    fn rows(
        self,
        node: &Node,
        found: &[Found; 2],
        spreads: [f64; 2],
        (axis, [index, base], coat): (ViewAxis, [f64; 2], f64),
        falloff: [f64; 2],
        albedo: Rgb,
    ) -> Vec<Row> {
        let sent_back = internal_of(&node.rest, albedo, |energies| energies.clear);
        let dimmed = internal_of(&node.rest, albedo, |energies| energies.dimmed);
        // All channels have the same share, but those in which the base is black.
        let brightest = (0..3).max_by(|&a, &b| albedo[a].total_cmp(&albedo[b])).unwrap_or(0);
        let passed = ratio(dimmed[brightest], sent_back[brightest]);
        // Below a coat over a base that is metallic in places, light that the dielectric itself sends back passes no slab.
        let is_apart = self.is_metallic && self.is_coated();
        let kept = if is_apart { kept_by_base(sent_back[brightest], base) } else { 0.0 };
        let around = -libm::log(((passed - kept) / (1.0 - kept)).max(PASSED_MIN)) / DEPTH;
        let energies: Vec<[Rgb; 2]> = node.rest.iter().map(|rest| self.reflected(rest)).collect();
        let lobes = [0, 1].map(|lobe: usize| {
            let energies: Vec<Rgb> = energies.iter().map(|energies| energies[lobe]).collect();
            node.lobes[lobe].with_energies(&found[lobe], &energies)
        });
        let wide_shares = [0, 1].map(|lobe: usize| node.lobes[lobe].wide_shares(&found[lobe]));
        let rows = node.rest.iter().enumerate().map(|(view, rest)| {
            let wo = seen_from(axis, [1.0, 0.0], view);
            let (sin_theta, leaving) = (wo.x, Leaving::new(refracted(wo, index), index));
            let crossing = self.crossing(coat, wo.z);
            let over = |energy: f64| energy / crossing;
            let lobes = lobes.iter().zip(spreads).enumerate().map(|(number, (lobes, spread))| {
                let mut lobe = lobes[view];
                lobe.tail = if self.has_tail { lobe.tail.clamp(LEAST_TAIL, 1.0) } else { 1.0 };
                // Between rows the share is that of the shape there: rows have what its estimate lacks.
                lobe.share = match self.has_tail {
                    true => leaving.summed(&lobe, sin_theta) / leaving.in_plane(&lobe, sin_theta),
                    false => 1.0,
                };
                lobe.shift /= spread;
                lobe.sharpness = lobe.sharpness.map(|sharpness| sharpness * spread);
                // Energies between nodes hang on neither node's share.
                let strength = energies[view][number].map(over);
                // Poles are no energies.
                let [first, second, _] = strength;
                lobe.strength = match (self.is_metallic, number) {
                    (true, 0) => [first, energies[view][0][1], 0.0],
                    (true, _) => [first, second, energies[view][1][2]],
                    (false, _) => strength,
                };
                // Lobes in the plane of the eye have no shear: its place has the share of the light of the other lobe that is in the remainder.
                lobe.shear = wide_shares[1 - number][view] / lobe.tail.sqrt();
                lobe
            });
            let length =
                |energies: &Energies, c: usize| -libm::log(ratio(energies.dimmed[c], energies.clear[c])) / DEPTH;
            let (albedo_dir, wide, energy, internal) = if self.is_metallic {
                let facets = rest.first_facet;
                let light = rest.base.clear[0];
                let white = rest.facets.clear.iter().sum::<f64>() / 3.0;
                let albedo = if self.is_coated() {
                    let [once, more] = &rest.reflected;
                    [over(1.0 - facets[1]), length(once, 1), between_visits(energies[view][1], more.dimmed[1])]
                } else {
                    [facets[0] - SHADES[0] * slope(facets), rest.facing[0], rest.facing[1]]
                };
                // A metal has an edge tint, or a film below a coat.
                let dips = [self.dip(energies[view], &rest.reflected), rest.first_dip];
                let [once, more] = rest.met.unwrap_or([dips, [0.0; 2]]);
                let energy = [over(light), length(&rest.base_once, 0), more[0]];
                (albedo, [over(white), once[0], once[1]], energy, [0.0, around, more[1]])
            } else {
                let wide = [0, 1, 2].map(|c: usize| over(rest.base.clear[c] + rest.facets.clear[c]));
                (rest.first_facet.map(|facet| over(1.0 - facet)), wide, rest.base.clear.map(over), sent_back)
            };
            let mean = |energies: &Energies| {
                let [dimmed, clear] = [energies.dimmed, energies.clear].map(|energies| energies.iter().sum::<f64>());
                -libm::log(ratio(dimmed, clear)) / DEPTH
            };
            let lengths = if self.has_lengths {
                let [once, more, base] = [&rest.reflected[0], &rest.reflected[1], &rest.base_once].map(mean);
                let second = if albedo == [0.0; 3] { spread_length(more, MORE_SPREAD) } else { base };
                [once, second, spread_length(around, AROUND_SPREADS[usize::from(self.is_coated())])]
            } else {
                [0.0; 3]
            };
            let base = Some(BaseLight { energy, internal, falloff, lengths, met: None });
            Row { albedo_dir, lobes: lobes.collect(), wide, base }
        });
        rows.collect()
    }

    /// Numbers of the light that the base reflected once, and more often.
    fn reflected(self, rest: &Rest) -> [Rgb; 2] {
        let [once, more] = &rest.reflected;
        if !self.is_metallic {
            return [once.clear, more.clear];
        }
        let once = if self.is_coated() {
            chain_numbers([once.between[0], once.clear[2]])
        } else {
            [rest.plastic, slope(rest.first_facet), 0.0]
        };
        [once, trapped_numbers([more.clear[1], more.between[1], more.clear[2]])]
    }
}

impl Family {
    /// About the mean of `cos (1 - cos)^6 / (1 - (1 - cos)^5)`, over the numerator at 81.8 degrees, at the facets of a tinted metal: that much an edge tint takes
    /// from the F0. It is that of light of one visit below a coat, and of several facets without one; 0 without a tint.
    fn dip(self, energies: [Rgb; 2], light: &[Energies; 2]) -> f64 {
        if !self.is_tinted {
            return 0.0;
        }
        let lobe = usize::from(!self.is_coated());
        let (energies, tinted, f0) = (energies[lobe], light[lobe].tinted[lobe], BETWEEN[lobe]);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..BISECTIONS {
            let dip = 0.5 * (low + high);
            let f0 = dimmed(f0, HALF_TINT, dip);
            let found = if self.is_coated() { chain(energies, f0) } else { trapped(energies, f0) };
            *if found < tinted { &mut high } else { &mut low } = dip;
        }
        0.5 * (low + high)
    }
}

/// The number g of `(1 + g depth)^-spread`, which is `exp(-length depth)` at [`DEPTH`].
fn spread_length(length: f64, spread: f64) -> f64 {
    (libm::exp(length * DEPTH / spread) - 1.0) / DEPTH
}

/// Steepness of an energy in the F0, from those of the least of [`SHADES`] and the greatest.
fn slope(energy: Rgb) -> f64 {
    (energy[2] - energy[0]) / (SHADES[2] - SHADES[0])
}

/// Length of the way from visit to visit of the base, of light of more visits with such energies, which a slab of [`DEPTH`] dims to this at the F0 of the
/// middle shade.
fn between_visits(energies: Rgb, dimmed: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..BISECTIONS {
        let passed = 0.5 * (low + high);
        *if trapped(energies, SHADES[1] * passed) < dimmed { &mut low } else { &mut high } = passed;
    }
    -libm::log(0.5 * (low + high)) / DEPTH
}

/// Halvings of the interval in which [`between_visits`] looks: down to the digits of a half float.
const BISECTIONS: u32 = 16;

/// Share of the light of a Lambertian base that is sent back to it, by channel.
fn internal_of(views: &[Rest], albedo: Rgb, of: impl Fn(&Energies) -> Rgb) -> Rgb {
    [0, 1, 2].map(|c: usize| {
        let once: f64 = views.iter().map(|rest| of(&rest.base_once)[c]).sum();
        let all: f64 = views.iter().map(|rest| of(&rest.base)[c]).sum();
        if all > 0.0 && albedo[c] > 0.0 { ((all - once) / all / albedo[c]).clamp(0.0, 1.0) } else { 0.0 }
    })
}

/// Least share of light that a slab lets through of which there is a length.
const PASSED_MIN: f64 = 1e-3;

/// Least tail of a lobe: a tail this short is hardly one, and far from 0.
const LEAST_TAIL: f64 = 0.05;

/// `a / b`, 1 unless both are positive.
fn ratio(a: f64, b: f64) -> f64 {
    if a > 0.0 && b > 0.0 { a / b } else { 1.0 }
}
