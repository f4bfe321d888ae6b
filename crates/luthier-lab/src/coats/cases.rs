//! Surfaces with a coat that all formulas show, and their stacks.

use luthier_optics::ior::Ior;
use luthier_optics::sampling::split_mix::SplitMix64;
use luthier_optics::schlick::{DIELECTRIC_INDEX, metallic_roughness};
use luthier_optics::stack::{Base, Diffuse, Distribution, Layer, Slab, Stack, Surface as Facets};

use super::surface::{INDEX, Surface};

pub(super) const WAVELENGTHS_NM: [f64; 3] = [645.0, 525.0, 445.0];

/// Slope parameters of coats.
const COATS: [f64; 3] = [0.05, 0.2, 0.4];

/// Slope parameters of bases.
const BASES: [f64; 2] = [0.1, 0.3];

const GREY: [f64; 3] = [0.7; 3];
const COPPER: [f64; 3] = [0.95, 0.6, 0.4];
const WHITE: [f64; 3] = [0.8; 3];
const WOOD: [f64; 3] = [0.4, 0.25, 0.12];

/// Random places, as texels have.
const PLACES: u64 = 6;

/// Kinds of cases.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Group {
    Metal,
    Plastic,
    Mixture,
    Place,
    Bare,
    BareMixture,
    Furnace,
}

impl Group {
    pub(super) fn title(self) -> &'static str {
        match self {
            Self::Metal => "Over metals",
            Self::Plastic => "Over plastics",
            Self::Mixture => "Over mixtures",
            Self::Place => "At random places",
            Self::Bare => "Without a coat, metals and plastics",
            Self::BareMixture => "Without a coat, mixtures",
            Self::Furnace => "Over a metal that absorbs nothing",
        }
    }
}

/// A surface of a group.
pub(super) struct Case {
    pub(super) group: Group,
    pub(super) surface: Surface,
}

pub(super) fn cases() -> Vec<Case> {
    let bases = [
        (Group::Metal, GREY, 1.0),
        (Group::Metal, COPPER, 1.0),
        (Group::Plastic, WHITE, 0.0),
        (Group::Plastic, WOOD, 0.0),
        (Group::Mixture, COPPER, 0.5),
        (Group::Furnace, [1.0; 3], 1.0),
    ];
    let mut cases = Vec::new();
    for (group, color, metallic) in bases {
        for alpha in BASES {
            let of = |group, coat| Case { group, surface: Surface { coat, alpha, color, metallic, remedy: None } };
            cases.extend(COATS.map(|coat| of(group, Some(coat))));
            if group != Group::Furnace {
                cases.push(of(if group == Group::Mixture { Group::BareMixture } else { Group::Bare }, None));
            }
        }
    }
    cases.extend((0..PLACES).map(|number| {
        let mut random = SplitMix64::new(number.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1));
        let mut alpha = |most: f64| {
            let root = random.between([0.2, most.sqrt()]);
            root * root
        };
        let [coat, alpha] = [alpha(0.5), alpha(0.6)];
        let color = [0; 3].map(|_: i32| random.between([0.1, 1.0]));
        let metallic = if number % 2 == 0 { 1.0 } else { 0.0 };
        Case { group: Group::Place, surface: Surface { coat: Some(coat), alpha, color, metallic, remedy: None } }
    }));
    cases
}

impl Case {
    /// The layers: a clear coat, and a `metallic-roughness` surface, whose interface reflects by its F0 whatever lies above.
    pub(super) fn stack(&self) -> Stack {
        let Surface { coat, alpha, color, metallic, .. } = self.surface;
        let layer =
            |alpha, base| Layer { films: Vec::new(), surface: Facets::isotropic(Distribution::Ggx, alpha), base };
        let clear = || Ior::constant(INDEX, 0.0).unwrap_or_else(|_| Ior::vacuum());
        let slab = Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] };
        let (f0, albedo) = metallic_roughness(color, metallic);
        let mut layers: Vec<Layer> =
            coat.map(|coat| layer(coat, Base::Dielectric { ior: clear(), slab })).into_iter().collect();
        if metallic == 1.0 {
            layers.push(layer(alpha, Base::Conductor { ior: clear().with_f0(color) }));
        } else {
            let above = if coat.is_some() { clear() } else { Ior::vacuum() };
            let ior = Ior::engine(&above, DIELECTRIC_INDEX);
            layers.push(layer(alpha, Base::Dielectric { ior: ior.with_f0(f0), slab }));
            let diffuse = Base::Diffuse(Diffuse { albedo, sigma: 0.0 });
            layers.push(Layer { films: Vec::new(), surface: Facets::smooth(), base: diffuse });
        }
        Stack { exterior: Ior::vacuum(), layers }
    }
}
