//! Surfaces whose stack differs from place to place: cells, glitter, and switches between maps.
//!
//! A. Weidlich and A. Wilkie, "Exploring the potential of layered BRDF models", SIGGRAPH Asia 2009 course, sec. 5.2.1: maps
//! of Voronoi cells choose the stack of each particle, a sparse map of larger cells puts glitter on top, its cells tilted
//! each its own way, and Perlin noise or larger cells switch between whole maps. Any model evaluates what was picked.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use crate::frame;
use crate::model::{Claims, Input, Inputs, Kind, Model, ModelInfo};
use crate::models::weidlich_wilkie::WeidlichWilkie;
use crate::monochrome::Monochrome;
use crate::noise::perlin::Perlin;
use crate::noise::voronoi::Voronoi;

/// Contents of a place: a stack by number, and its normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pick {
    /// Index into the stacks.
    pub stack: usize,
    /// Normal of the particle, unit, in the surface's frame.
    pub normal: DVec3,
}

/// Spread of stacks over a surface.
#[derive(Debug, Clone, PartialEq)]
pub enum Map {
    /// One stack everywhere.
    Uniform(usize),
    /// A surface map: each Voronoi cell one of the stacks, all as likely.
    Cells {
        /// The cells.
        cells: Voronoi,
        /// Stacks to choose from; with none, stack 0.
        stacks: Vec<usize>,
    },
    /// A glitter map over another: most of its cells are transparent.
    Glitter {
        /// The cells.
        cells: Voronoi,
        /// Stacks of the cells that glitter, all as likely; with none, none does.
        stacks: Vec<usize>,
        /// Share of cells that glitter, 0..=1.
        filled: f64,
        /// Largest tilt of a glittering cell, radians, below a right angle; tilts are uniform in solid angle.
        tilt: f64,
        /// Map that shows through the other cells.
        under: Box<Map>,
    },
    /// A switch between two maps.
    Switch {
        /// Which of the two is where.
        switch: Switch,
        /// Map inside the switch.
        inside: Box<Map>,
        /// Map elsewhere.
        outside: Box<Map>,
    },
}

/// Places where one map takes the place of another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Switch {
    /// Where noise is within a range: patches, or veins where the range is narrow.
    Noise {
        /// The noise.
        noise: Perlin,
        /// Its least and largest value inside, both included.
        between: [f64; 2],
    },
    /// A share of larger cells.
    Tiles {
        /// The cells.
        cells: Voronoi,
        /// Share of them that is inside, 0..=1.
        share: f64,
    },
}

impl Switch {
    /// Cells per unit of length; for noise, cells of the first octave.
    fn frequency(&self) -> f64 {
        match self {
            Self::Noise { noise, .. } => noise.frequency,
            Self::Tiles { cells, .. } => cells.frequency,
        }
    }

    /// Whether a place is inside.
    pub fn has(&self, uv: DVec2) -> bool {
        match self {
            Self::Noise { noise, between: [least, most] } => {
                let value = noise.at(uv);
                value >= *least && value <= *most
            }
            Self::Tiles { cells, share } => cells.cell(uv).number(0) < *share,
        }
    }
}

/// How much of a surface a switch has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SwitchShare {
    /// Share of the surface that is inside, 0..=1.
    pub own: f64,
    /// Share of the surface that is inside this switch and inside no switch before it.
    pub seen: f64,
    /// The least and the largest value of its noise at the places; `None` for tiles.
    pub noise: Option<[f64; 2]>,
}

/// Places at which [`switch_shares`] looks.
const PLACES: u32 = 20_000;

/// Cells of the coarsest switch along each side of the square of these places: three cells for each place, so that few share a cell.
const SIDE: f64 = 256.0;

/// Steps of Roberts's sequence R2 (2018): 1/p and 1/p^2 of the plastic number p.
const R2_STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_2];

/// How much of a surface each of some switches has, counted over 20000 fixed places. At a place inside several switches the first one is seen. A share
/// of 0.001 is within 0.0005 at two standard errors.
///
/// ```
/// use luthier_layers::effects::heterogeneous::{Switch, switch_shares};
/// use luthier_layers::noise::perlin::Perlin;
///
/// let between = [0.8, 1.0];
/// let noise = Perlin { seed: 1, frequency: 4.0, octaves: 4 };
/// assert_eq!(switch_shares(&[Switch::Noise { noise, between }])[0].own, 0.0);
/// ```
pub fn switch_shares(switches: &[Switch]) -> Vec<SwitchShare> {
    let coarsest = switches.iter().map(Switch::frequency).fold(f64::INFINITY, f64::min);
    let mut shares = vec![SwitchShare { own: 0.0, seen: 0.0, noise: None }; switches.len()];
    let one = 1.0 / f64::from(PLACES);
    for n in 0..PLACES {
        // Places of Roberts's sequence are far apart from each other, and off the lattice of the noise.
        let uv = DVec2::from_array(R2_STEPS.map(|step| (f64::from(n) * step).fract() * SIDE / coarsest));
        let mut is_covered = false;
        for (switch, share) in switches.iter().zip(&mut shares) {
            if let Switch::Noise { noise, .. } = switch {
                let value = noise.at(uv);
                let [least, most] = share.noise.unwrap_or([value; 2]);
                share.noise = Some([least.min(value), most.max(value)]);
            }
            if switch.has(uv) {
                share.own += one;
                share.seen += if is_covered { 0.0 } else { one };
                is_covered = true;
            }
        }
    }
    shares
}

impl Map {
    /// The stack and the normal at a place.
    pub fn pick(&self, uv: DVec2) -> Pick {
        match self {
            Self::Uniform(stack) => Pick { stack: *stack, normal: DVec3::Z },
            Self::Cells { cells, stacks } => {
                let stack = choose(stacks, cells.cell(uv).number(0)).unwrap_or(0);
                Pick { stack, normal: DVec3::Z }
            }
            Self::Glitter { cells, stacks, filled, tilt, under } => {
                let cell = cells.cell(uv);
                match choose(stacks, cell.number(0)) {
                    Some(stack) if cell.number(1) < *filled => {
                        let cos = 1.0 - cell.number(2) * (1.0 - libm::cos(*tilt));
                        let sin = libm::sqrt((1.0 - cos * cos).max(0.0));
                        let phi = 2.0 * PI * cell.number(3);
                        Pick { stack, normal: DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), cos) }
                    }
                    _ => under.pick(uv),
                }
            }
            Self::Switch { switch, inside, outside } => if switch.has(uv) { inside } else { outside }.pick(uv),
        }
    }
}

fn choose(stacks: &[usize], u: f64) -> Option<usize> {
    let index = (u * stacks.len() as f64) as usize;
    stacks.get(index.min(stacks.len().saturating_sub(1))).copied()
}

/// `f cos_theta_i` of the picked stack. The cosine is that against the particle's normal; zero where the particle or the surface
/// turns away from either direction, and for a pick that is not among the stacks.
pub fn eval(model: &dyn Model, stacks: &[Monochrome], pick: Pick, wi: DVec3, wo: DVec3) -> f64 {
    match stacks.get(pick.stack) {
        Some(stack) if wi.z > 0.0 && wo.z > 0.0 => {
            model.eval(stack, frame::local(pick.normal, wi), frame::local(pick.normal, wo))
        }
        _ => 0.0,
    }
}

/// Pattern in which a model by name spreads two stacks: number 0, and number 1, the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pattern {
    /// Voronoi cells, 20 per unit of length, half of them of either stack.
    Cells,
    /// A fifth of the Voronoi cells, 20 per unit of length, glitters: the other stack, tilted by up to 0.3 radians.
    Glitter,
    /// Perlin noise of three octaves, the first with 4 cells per unit of length: the other stack where it is not below 0.
    Switch,
}

impl Pattern {
    /// All patterns, in the order of listings.
    pub const ALL: [Self; 3] = [Self::Cells, Self::Glitter, Self::Switch];

    fn map(self) -> Map {
        let cells = Voronoi { seed: 0, frequency: 20.0 };
        match self {
            Self::Cells => Map::Cells { cells, stacks: vec![0, 1] },
            Self::Glitter => {
                Map::Glitter { cells, stacks: vec![1], filled: 0.2, tilt: 0.3, under: Box::new(Map::Uniform(0)) }
            }
            Self::Switch => Map::Switch {
                switch: Switch::Noise { noise: Perlin { seed: 0, frequency: 4.0, octaves: 3 }, between: [0.0, 1.0] },
                inside: Box::new(Map::Uniform(1)),
                outside: Box::new(Map::Uniform(0)),
            },
        }
    }
}

/// The model of Weidlich and Wilkie at a place of a pattern. [`Model::stack_index`] says which of the two stacks is there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heterogeneous {
    pattern: Pattern,
    pick: Pick,
}

impl Heterogeneous {
    /// The model at a texture coordinate.
    pub fn new(pattern: Pattern, uv: DVec2) -> Self {
        Self { pattern, pick: pattern.map().pick(uv) }
    }
}

impl Model for Heterogeneous {
    fn info(&self) -> ModelInfo {
        let (name, domain, claims) = match self.pattern {
            Pattern::Cells => {
                ("heterogeneous", "two stacks spread by Voronoi cells, 20 per unit of length", Claims::RECIPROCAL)
            }
            Pattern::Glitter => (
                "heterogeneous-glitter",
                "one stack in a fifth of the Voronoi cells, tilted by up to 0.3 rad, over another",
                Claims::NONE,
            ),
            Pattern::Switch => (
                "heterogeneous-switch",
                "two stacks, switched by Perlin noise of three octaves from 4 per unit of length",
                Claims::RECIPROCAL,
            ),
        };
        ModelInfo {
            name,
            kind: Kind::Place,
            claims,
            source: "Weidlich and Wilkie 2009, section 5.2.1, over eq. 3.1-3.3",
            domain,
            leaves_out: "what weidlich-wilkie leaves out; light that passes from one particle to another",
            inputs: &[Input::Uv, Input::OtherStack],
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        eval(&WeidlichWilkie::default(), std::slice::from_ref(stack), Pick { stack: 0, ..self.pick }, wi, wo)
    }

    fn with_inputs(&self, inputs: &Inputs) -> Option<Box<dyn Model>> {
        let place = inputs.uv.map_or(*self, |uv| Self::new(self.pattern, uv));
        Some(Box::new(place))
    }

    fn stack_index(&self) -> usize {
        self.pick.stack
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places() -> impl Iterator<Item = DVec2> {
        (0..100).flat_map(|i| (0..100).map(move |j| DVec2::new(f64::from(i), f64::from(j)) / 100.0))
    }

    #[test]
    fn glitter_covers_its_share_and_tilts_within_its_limit() {
        let map = Map::Glitter {
            cells: Voronoi { seed: 2, frequency: 60.0 },
            stacks: vec![3, 4],
            filled: 0.1,
            tilt: 0.3,
            under: Box::new(Map::Uniform(7)),
        };
        let (mut counts, mut cosines) = ([0u32; 8], 0.0);
        for pick in places().map(|uv| map.pick(uv)) {
            counts[pick.stack] += 1;
            assert!(pick.normal.z >= libm::cos(0.3) - 1e-12 && (pick.normal.length() - 1.0).abs() < 1e-12);
            if pick.stack != 7 {
                cosines += pick.normal.z;
            } else {
                assert_eq!(pick.normal, DVec3::Z);
            }
        }
        // 3600 cells: standard error of the share 0.005, more by unequal areas.
        let glitter = f64::from(counts[3] + counts[4]) / 10_000.0;
        assert!((glitter - 0.1).abs() < 0.025, "{glitter}");
        assert!(counts[3] > 300 && counts[4] > 300);
        // Uniform in solid angle: the mean cosine is halfway.
        let mean = cosines / f64::from(counts[3] + counts[4]);
        assert!((mean - 0.5 * (1.0 + libm::cos(0.3))).abs() < 0.003, "{mean}");
    }

    #[test]
    fn cells_share_the_surface_and_noise_switches() {
        let cells =
            |seed, stacks: &[usize]| Map::Cells { cells: Voronoi { seed, frequency: 50.0 }, stacks: stacks.to_vec() };
        let switch = Switch::Noise { noise: Perlin { seed: 4, frequency: 8.0, octaves: 3 }, between: [0.0, 1.0] };
        let (inside, outside) = (Box::new(cells(2, &[2, 3])), Box::new(cells(1, &[0, 1])));
        let map = Map::Switch { switch, inside, outside };
        let mut counts = [0u32; 4];
        for uv in places() {
            counts[map.pick(uv).stack] += 1;
        }
        for count in counts {
            assert!((1700..3300).contains(&count), "{counts:?}");
        }
        assert_eq!(cells(1, &[]).pick(DVec2::ZERO).stack, 0);
    }

    /// A narrow range around 0 is a vein: it has little area, and the noise has both signs beside it. Tiles have their share.
    #[test]
    fn switches_are_veins_and_tiles() {
        let noise = Perlin { seed: 4, frequency: 6.0, octaves: 3 };
        let vein = Switch::Noise { noise, between: [-0.02, 0.02] };
        let inside: Vec<DVec2> = places().filter(|&uv| vein.has(uv)).collect();
        assert!((300..1200).contains(&inside.len()), "{}", inside.len());
        for &uv in &inside {
            let around = (0..16).map(|i| noise.at(uv + 0.04 * DVec2::from_angle(PI * f64::from(i) / 8.0)));
            let (least, most) = around.fold((1.0f64, -1.0f64), |(a, b), v| (a.min(v), b.max(v)));
            assert!(most > 0.02 || least < -0.02, "{uv}: {least} {most}");
        }
        let tiles = Switch::Tiles { cells: Voronoi { seed: 3, frequency: 40.0 }, share: 0.3 };
        let share = places().filter(|&uv| tiles.has(uv)).count();
        // 1600 tiles: standard error of the share 0.012, more by unequal areas.
        assert!((2500..3500).contains(&share), "{share}");
    }

    /// Oracles: symmetry of the noise, the share of tiles, and the product of both.
    #[test]
    fn shares_of_switches_are_those_of_places() {
        let noise = |between| Switch::Noise { noise: Perlin { seed: 2, frequency: 2.0, octaves: 4 }, between };
        let tiles = Switch::Tiles { cells: Voronoi { seed: 3, frequency: 4.0 }, share: 0.3 };
        let found = switch_shares(&[noise([0.0, 1.0]), tiles, noise([0.9, 1.0]), noise([-1.0, 1.0]), tiles]);
        for (share, [own, seen]) in found.iter().zip([[0.5, 0.5], [0.3, 0.15], [0.0, 0.0], [1.0, 0.35], [0.3, 0.0]]) {
            assert!((share.own - own).abs() < 0.015 && (share.seen - seen).abs() < 0.015, "{share:?}: {own} {seen}");
        }
        let [least, most] = found[2].noise.unwrap();
        assert!(least > -0.8 && least < -0.4 && most > 0.4 && most < 0.8 && found[1].noise.is_none(), "{least} {most}");
        assert!(switch_shares(&[]).is_empty());
    }

    #[test]
    fn patterns_use_both_stacks_and_only_glitter_tilts() {
        for pattern in Pattern::ALL {
            let picks: Vec<Pick> = places().map(|uv| Heterogeneous::new(pattern, uv).pick).collect();
            let others = picks.iter().filter(|pick| pick.stack == 1).count();
            let expected = if pattern == Pattern::Glitter { 1000..3000 } else { 3500..6500 };
            assert!(expected.contains(&others), "{pattern:?}: {others}");
            let tilted = picks.iter().filter(|pick| pick.normal != DVec3::Z).count();
            assert_eq!(tilted, if pattern == Pattern::Glitter { others } else { 0 }, "{pattern:?}");
        }
    }

    /// A flat particle is the model; a tilted one the model in its frame.
    #[test]
    fn what_is_picked_is_evaluated() {
        use crate::monochrome::MonochromeBelow;
        use luthier_optics::stack::{Distribution, Surface};
        let below = MonochromeBelow::Conductor { ior: num_complex::Complex64::new(0.2, 3.0) };
        let surface = Surface::isotropic(Distribution::Ggx, 0.3);
        let stack = Monochrome::bare(&[(surface, below)]);
        let (wi, wo) = (DVec3::new(0.3, 0.2, 0.8).normalize(), DVec3::new(-0.1, 0.3, 0.9).normalize());
        let flat = WeidlichWilkie::default().eval(&stack, wi, wo);
        for uv in places() {
            let place = Heterogeneous::new(Pattern::Glitter, uv);
            let n = place.pick.normal;
            let found = place.eval(&stack, wi, wo);
            if n == DVec3::Z {
                assert_eq!(found, flat);
            } else {
                let expected = WeidlichWilkie::default().eval(&stack, frame::local(n, wi), frame::local(n, wo));
                assert_eq!(found, expected);
            }
        }
    }
}
