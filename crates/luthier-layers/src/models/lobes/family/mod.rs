//! Families: one small table for every texel of a stack whose textures vary the slopes and the colours of single layers.
//!
//! Slope parameters of the first interface and of the *base*, the lowest interface, are axes of a table. Colours are not. Light is split by how often the base
//! reflected it, once or more often, each in a lobe of its own: the shapes of these lobes do not hang on the colour of the base, and their energies have closed
//! forms in it.
//!
//! A base that is metallic in places ([`Family::is_metallic`]) is a mix of two surfaces: a metal of the F0 c with the share m, and a dielectric over a
//! diffuse base of the albedo r with the share 1 - m. Its rows have
//!
//! | part | x, y, z, w |
//! |---|---|
//! | 0 | reflected by the metal once: energy w at c = 1, and R; share of it that is wide; shift |
//! | 1 | reflected by the metal more often: p + q c at c = .5 and 1, and R; share of it that is wide |
//! | 2 | sharpness of both lobes |
//! | 3 | light but that of one facet of the first interface; facets of the coat alone; light of a diffuse base of the albedo .8; a of the remainder |
//! | 4, below a slab that absorbs | lengths of the light of the diffuse base, of that sent back to it, of light of one visit, and of more |
//! | 4, under a film on the base | 0, 0, mean and standard deviation of the cosine at which facets are seen |
//! | 5, of a metal with an edge tint | what it takes from the F0 of light of one visit below a coat, or of several facets without one; and from one facet without a coat |
//!
//! Light of one visit is `w (1 - R) c / (1 - R c)`, and light of more visits `c^2 (p + q c) / (1 - R c)`: reflectances are Schlick's,
//! linear in c, and trapped light is reflected by the metal again and again. The dielectric reflects once as a metal of its F0 does. The light of the diffuse
//! base is `t r / (1 - s r)`, where s, the share of it that is sent back to the base, is linear in the roots of both slope parameters ([`Family::sent_back`]). A slab multiplies each
//! energy by `exp(-length depth)`, but for light of more visits c, because such light passes it again before each. Without a coat, the first lobe has the
//! light of several facets of the dielectric, x of part 0, and the second that of the metal; the albedo of one facet is x of part 3, plus y of part 0 times the F0.
//!
//! Any other base keeps its colours, and rows have energies by channel:
//!
//! | part | x, y, z, w |
//! |---|---|
//! | 0 | reflected by the base once RGB, shift |
//! | 1 | reflected by the base more often RGB, share of it that is wide |
//! | 2 | sharpness of both lobes |
//! | 3 | light but that of one facet of the first interface RGB, share of the light of one visit that is wide |
//! | 4 | wide remainder RGB, a of it |
//! | 5, 6, to recolour a diffuse base | its light RGB, its length; share of it that is sent back to it RGB, length of that |
//! | 7, or 5 without a base | lengths of the light of one visit, and of more visits without a base |
//!
//! Lengths are 0 unless what the first slab absorbs varies ([`Family::has_lengths`]): then rows are those of a clear slab, and a slab multiplies energies by
//! `exp(-length depth)`, but for light that is sent back and of more visits: by `(1 + length depth)^-b`, where b is 4 for the former below the first interface alone
//! and 1.5 below another, and 4.5 for the latter.
//!
//! Strengths of all families are energies, not yet over the share above the horizon. The lobe of trapped light has its middle at the normal. The b of the remainder is one
//! number of the family.
//!
//! Rows have quotients over closed forms, so that lines between nodes and between rows hold: slopes of lobes over [`Family::spreads`], energies over
//! [`Family::crossing`]. So anisotropy needs no axis: lobes of anisotropic interfaces are stretched by
//! the matrix of their slope parameters ([`Slopes`]). An interpolated share above the horizon would not be that of the interpolated shape: light would be
//! off by a hundredth at all views. Lobes with the tail of GGX have that share in closed form (`Leaving`). Rows of others ([`Family::has_tail`]) have it over an estimate,
//! as x and y of a part before the others, part -1. Tails are one number of the family. Some of the light of both lobes is wide, by the same share in all channels; above no
//! diffuse base, whose light has a shape, of trapped light alone.

mod film;
#[cfg(test)]
mod film_tests;
mod fit;
mod paint;
mod shares;
mod slopes;
#[cfg(test)]
mod tests;
mod texels;
mod trace;

pub use film::FilmLight;
pub(super) use film::{Filmed, facing};
pub use paint::{Mix, Paint};
pub use slopes::{Slopes, Stretch};

use luthier_optics::stack::{Base, Distribution, Layer, Stack};

use crate::layers::ALPHA_MIN;

/// Nodes over a range of slope parameters, at equal steps of the root.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SlopeAxis {
    /// Slope parameter of the first node.
    pub least: f64,
    /// Slope parameter of the last node.
    pub most: f64,
    /// Number of nodes: 1 where the slope parameter does not vary.
    pub nodes: usize,
}

/// Steps between nodes from a slope parameter of 0 to one of 1. A table has at most 8 tiles for one slope parameter, and 64 for two: atlases have a power of two.
const STEPS: f64 = 7.0;

impl SlopeAxis {
    /// The axis of a range, held to the slope parameters of models. One node suffices for a range without extent.
    pub fn new([least, most]: [f64; 2]) -> Self {
        let [least, most] = [least, most].map(|alpha| alpha.clamp(ALPHA_MIN, 1.0));
        let extent = most.sqrt() - least.sqrt();
        if extent < EXTENT_MIN {
            return Self { least: most, most, nodes: 1 };
        }
        Self { least, most, nodes: 1 + libm::ceil(STEPS * extent - EXTENT_MIN).max(1.0) as usize }
    }

    /// Fractional number of the node of a slope parameter, held to the range.
    pub fn place(self, alpha: f64) -> f64 {
        if self.nodes == 1 {
            return 0.0;
        }
        let [least, most] = [self.least, self.most].map(f64::sqrt);
        ((alpha.max(0.0).sqrt() - least) / (most - least)).clamp(0.0, 1.0) * (self.nodes - 1) as f64
    }

    /// The slope parameter at a fractional number of a node.
    pub fn alpha(self, place: f64) -> f64 {
        if self.nodes == 1 {
            return self.least;
        }
        let [least, most] = [self.least, self.most].map(f64::sqrt);
        let root = least + (most - least) * place / (self.nodes - 1) as f64;
        root * root
    }
}

/// Ranges of roots of slope parameters below this are one node.
const EXTENT_MIN: f64 = 1e-3;

/// The axes of a family.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Family {
    /// Slope parameter of the first interface, where that is a coat; one node where the base is the first interface.
    pub coat: SlopeAxis,
    /// Slope parameter of the base.
    pub base: SlopeAxis,
    /// Number of the base among the layers: the lowest interface.
    pub interface: usize,
    /// Whether the base is metallic in places, whose colours are in closed form. Else energies are those of the channels.
    pub is_metallic: bool,
    /// Whether that metal has an edge tint, for which rows have two numbers more.
    pub is_tinted: bool,
    /// Whether lobes have another tail than GGX: rows have their shares above the horizon.
    pub has_tail: bool,
    /// Of a base that is metallic in places, the share of the light of a diffuse base that layers send back to it: at slope parameters of 0, and what it grows by over a unit of
    /// the root of that of the coat, and of that of the base. 0 before a fit.
    pub sent_back: [f64; 3],
    /// Whether the optical depth of the first slab varies above a base that keeps its colours: rows have lengths of light in it.
    pub has_lengths: bool,
}

impl Family {
    /// The family of a stack with its slope parameters in ranges, those of the coat and those of the base; `None` without an interface, and where interfaces
    /// between these two are anisotropic. A base that is metallic in places is the lowest interface over a diffuse base, as it is without metal.
    pub fn new(stack: &Stack, coat: [f64; 2], base: [f64; 2], is_metallic: bool) -> Option<Self> {
        let interface = base_interface(stack)?;
        if stack.layers[..interface].iter().skip(1).any(Layer::is_anisotropic) {
            return None;
        }
        let base = SlopeAxis::new(base);
        let coat = if interface > 0 { SlopeAxis::new(coat) } else { SlopeAxis { least: 0.0, most: 0.0, nodes: 1 } };
        let has_tail = stack.layers[interface].surface.distribution == Distribution::Beckmann;
        let (is_tinted, has_lengths) = (false, false);
        Some(Self { coat, base, interface, is_metallic, is_tinted, has_lengths, has_tail, sent_back: [0.0; 3] })
    }

    /// The family with an edge tint of the metal, if its base is metallic in places.
    #[must_use]
    pub fn tinted(self, is_tinted: bool) -> Self {
        Self { is_tinted: is_tinted && self.is_metallic, ..self }
    }

    /// Share of the light of a diffuse base that is sent back to it, where that is metallic in places.
    fn back(self, [coat, base]: [f64; 2]) -> f64 {
        let [least, by_coat, by_base] = self.sent_back;
        least + by_coat * coat.sqrt() + by_base * base.sqrt()
    }

    /// The family with the line through such shares of its nodes, by least squares: nodes are a grid, so that each axis has its steepness.
    fn with_sent_back(self, shares: &[f64]) -> Self {
        let roots: Vec<[f64; 2]> = (0..shares.len()).map(|node| self.alphas(node).map(f64::sqrt)).collect();
        let count = shares.len().max(1) as f64;
        let mean = shares.iter().sum::<f64>() / count;
        let [coat, base] = [0, 1].map(|axis: usize| {
            let middle = roots.iter().map(|roots| roots[axis]).sum::<f64>() / count;
            let away = || roots.iter().map(|roots| roots[axis] - middle);
            let square: f64 = away().map(|x| x * x).sum();
            let steep: f64 = away().zip(shares).map(|(x, share)| x * share).sum();
            (middle, if square > EXTENT_MIN * EXTENT_MIN { steep / square } else { 0.0 })
        });
        Self { sent_back: [mean - coat.0 * coat.1 - base.0 * base.1, coat.1, base.1], ..self }
    }

    /// The family with an optical depth of the first slab that varies. A base that is metallic in places has it in closed form anyway.
    #[must_use]
    pub fn below_varied_slab(self, has_lengths: bool) -> Self {
        Self { has_lengths: has_lengths && !self.is_metallic, ..self }
    }

    /// Whether interfaces lie above the base.
    pub fn is_coated(self) -> bool {
        self.interface > 0
    }

    /// Number of nodes.
    pub fn nodes(self) -> usize {
        self.coat.nodes * self.base.nodes
    }

    /// The slope parameters of a node, of coat and base. Nodes over the base follow each other for each node of the coat.
    pub fn alphas(self, node: usize) -> [f64; 2] {
        let [coat, base] = [node / self.base.nodes, node % self.base.nodes].map(|i| i as f64);
        [self.coat.alpha(coat), self.base.alpha(base)]
    }

    /// The stack with slope parameters of coat and base.
    pub fn apply<S: Into<Slopes>>(self, stack: &Stack, slopes: [S; 2]) -> Stack {
        let mut here = stack.clone();
        let [coat, base] = slopes.map(Into::into);
        let slopes = if self.is_coated() { vec![(0, coat), (self.interface, base)] } else { vec![(0, base)] };
        for (number, slopes) in slopes {
            let surface = &mut here.layers[number].surface;
            *surface = slopes.on(*surface);
        }
        here
    }

    /// The slope parameters of the coat and the base of a stack.
    pub fn slopes(self, stack: &Stack) -> [Slopes; 2] {
        [0, self.interface].map(|number| stack.layers[number].surface.into())
    }

    /// About the share of light that crosses a coat of a slope parameter, at a cosine of the view: what Schlick's formula lets through where a mean facet
    /// is seen. Energies of rows are over this; 1 without a coat.
    ///
    /// Facets of slope parameter a show themselves at flat views by a cosine of about the root of .4 a. Light from below follows from that within a
    /// tenth over all slope parameters, so that energies over it hardly change from node to node, nor from row to row towards the horizon.
    pub fn crossing(self, coat: f64, cos_theta: f64) -> f64 {
        if !self.is_coated() {
            return 1.0;
        }
        let cos_sq = cos_theta * cos_theta;
        let leaning = FACING * coat * coat / (coat + FLAT * cos_theta);
        let missed = 1.0 - (cos_sq + (1.0 - cos_sq) * leaning).sqrt();
        1.0 - missed * missed * (missed * missed) * missed
    }
}

/// Albedo of a diffuse base in the simulation of a family whose base is metallic in places.
const WHITE: f64 = 0.8;

/// The b of the remainder above a diffuse base: in fits it is .06 within .05, and hangs on no slope parameter.
const SQUARE: f64 = 0.06;

/// Squared cosine at which flat views see the facets of a coat, over its slope parameter.
const FACING: f64 = 0.4;

/// Slope parameter, over the cosine of the view, at which facets begin to lean towards it.
const FLAT: f64 = 0.2;

/// The lowest interface of a stack.
pub fn base_interface(stack: &Stack) -> Option<usize> {
    stack.layers.iter().rposition(|layer| !matches!(layer.base, Base::Diffuse(_)))
}
