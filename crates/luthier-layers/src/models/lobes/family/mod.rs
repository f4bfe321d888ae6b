//! Families: one small table for every texel of a stack whose textures vary the slopes and the colours of single layers.
//!
//! Textures of a coated base vary its slope parameters, its colour and how metallic it is; the coat has its own slopes and tint. Slopes are axes of a
//! table, and colours are not: light is split by how often it was reflected by the *base*, the lowest interface, and each part has a closed form in the
//! colour.
//!
//! | light | number of the row | its energy over the F0 f of the base and the albedo r of a diffuse base below |
//! |---|---|---|
//! | reflected by the base once | first lobe, strength (e, E, R) | `(p + q f) / (1 - R f)`, which is e at f = 0 and E at f = 1 |
//! | reflected by it more often | second lobe, strength (e, E, R) | `f^2 (p + q f) / (1 - R f)`, which is e at f = 1/2 and E at f = 1 |
//! | from a diffuse base | light of the base: energy (t0, t1, l), internal (r0, r1, l) | `(1 - f)^2 (t0 + t1 f) r / (1 - R(f) r)`, `R(f) = r0 + r1 f + (1 - r0 - r1) f^2` |
//! | neither: bounces among the facets of the first interface | remainder (e, E, R) | the same; E = e and R = 0 below a coat |
//! | one facet of the first interface | albedo (a0, a1, -) of one interface; (a0, l, l) of a coat | `a0 + a1 f` |
//!
//! Reflectances of the base are Schlick's, linear in f, so that the first form is exact for a base whose facets do not pass light on. Light near the
//! critical angle of the coat is trapped, other light is not: one pole alone would not do. Shapes of lobes do not hang on the colour once light is split
//! so. An absorbing slab below the coat multiplies each energy by `exp(-l depth)`: l is a length of its paths over the thickness, one number of a node.
//!
//! A base that keeps its own colour, a metal of a complex index for instance, has energies by channel in place of these numbers ([`Family::is_colored`]).
//!
//! Slopes of lobes are stored over closed forms ([`Family::spreads`]): ratios are of order 1 at all nodes, and lines between nodes hold.

mod fit;
mod paint;
mod trace;

pub use paint::Paint;

use luthier_optics::stack::{Base, Stack, Surface};

use crate::layers::ALPHA_MIN;

/// Nodes over a range of slope parameters, at equal steps of the root.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SlopeAxis {
    /// Slope parameter of the first node.
    pub least: f64,
    /// That of the last.
    pub most: f64,
    /// Number of nodes: 1 where the slope parameter does not vary.
    pub nodes: usize,
}

/// Steps between nodes from a slope parameter of 0 to one of 1.
const STEPS: f64 = 8.0;

impl SlopeAxis {
    /// The axis of a range, held to the slope parameters of models. One node suffices for a range without extent.
    pub fn new(least: f64, most: f64) -> Self {
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
    /// Whether the base reflects by an F0, whose place among energies is in closed form. Else energies are those of the channels.
    pub is_colored: bool,
}

impl Family {
    /// The family of an isotropic stack with its slope parameters in ranges, those of the coat and those of the base; `None` without an interface.
    pub fn new(stack: &Stack, coat: [f64; 2], base: [f64; 2]) -> Option<Self> {
        let interface = base_interface(stack)?;
        let is_colored = match &stack.layers[interface].base {
            Base::Conductor { ior } | Base::Dielectric { ior, .. } => ior.f0().is_some(),
            Base::Diffuse(_) => false,
        };
        let [base, own] = [base, coat].map(|[least, most]| SlopeAxis::new(least, most));
        let coat = if interface > 0 { own } else { SlopeAxis { least: 0.0, most: 0.0, nodes: 1 } };
        Some(Self { coat, base, interface, is_colored })
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
    pub fn apply(self, stack: &Stack, [coat, base]: [f64; 2]) -> Stack {
        let mut here = stack.clone();
        let alphas = if self.is_coated() { vec![(0, coat), (self.interface, base)] } else { vec![(0, base)] };
        for (number, alpha) in alphas {
            let surface = &mut here.layers[number].surface;
            *surface = Surface::isotropic(surface.distribution, alpha);
        }
        here
    }

    /// Slope parameters about as wide as the lobes: of light that the base reflects once, and more often. Rows have the slopes of lobes over these.
    pub fn spreads([coat, base]: [f64; 2]) -> [f64; 2] {
        let once = base * base + 0.09 * coat * coat;
        let more = 4.84 * base * base + coat * coat;
        [once.sqrt(), more.sqrt().min(1.0)]
    }
}

/// The lowest interface of a stack.
pub fn base_interface(stack: &Stack) -> Option<usize> {
    stack.layers.iter().rposition(|layer| !matches!(layer.base, Base::Diffuse(_)))
}
