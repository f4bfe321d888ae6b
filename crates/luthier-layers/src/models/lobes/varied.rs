//! Lobes of a stack that varies with a texture: nodes over the factor of the texture, or over the amount of a patina.

use luthier_optics::color::Color;
use luthier_optics::stack::{Base, FilmThickness, Stack, Surface};

use super::fit::{Found, Simulation, indices};
use super::parameters::Basis;
use super::tally::mean;
use super::{
    Axes, Cover, EXCESS, Family, FilmLight, Filmed, FirstInterface, FitError, FitSettings, Frame, Lobes, Paint, Row,
    Slopes, ViewAxis, most_lobes, patina, shown,
};
use crate::layers::ALPHA_MIN;

/// The part of a stack that a texture decides.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Varying {
    /// The slope parameters of all interfaces.
    Alpha,
    /// The thickness of the slab below the first interface.
    Slab,
    /// The thickness of the top film of the first interface. The numbers are the greatest and the least factor on its nominal thickness.
    Film([f64; 2]),
    /// The amount of the first layer, a patina. The factor is this amount in 0..=1. Node 0 (all layers, no patina parameters) lies one step above 1,
    /// or at 1 if the patina has no parameters.
    Patina(Cover),
    /// Slope parameters and colours of single layers, see [`Family`]. The factor is the number of a node.
    Family(Family),
}

impl Varying {
    /// The film of a stack that varies, if it has one.
    pub fn film(stack: &Stack) -> Option<Self> {
        let film = stack.layers.first()?.films.first().filter(|film| film.varies())?;
        let FilmThickness { min_nm, max_nm } = film.thickness;
        Some(Self::Film([max_nm, min_nm].map(|nm| nm / film.thickness.nominal_nm())))
    }

    /// The axes of the rows of a stack: those of an anisotropic one. Rows of a family are in the plane of the eye.
    pub fn axes(varying: Option<Self>, stack: &Stack) -> Option<Axes> {
        if matches!(varying, Some(Self::Family(_))) { None } else { Axes::of(stack) }
    }

    /// Number of nodes.
    pub fn nodes(self) -> usize {
        match self {
            Self::Alpha => 8,
            // Towards thickness 0 the light of a base is a Gaussian of the root of the factor. With an optical depth of 4, chords between fifteen
            // nodes err by up to .012.
            Self::Slab => 15,
            // Interference has a period of about half a wavelength. The number is odd so that the nominal thickness is in the middle.
            Self::Film(_) => 15,
            Self::Patina(cover) => cover.nodes(),
            Self::Family(family) => family.nodes(),
        }
    }

    /// The nominal node traces all paths, and others one in so many. Neighbours among many nodes see nearly the same light, so fewer paths do.
    fn path_share(self) -> u64 {
        match self {
            Self::Alpha | Self::Patina(_) | Self::Family(_) => 1,
            Self::Slab | Self::Film(_) => 2,
        }
    }

    /// A family with half of the steps between nodes, `halvings` times, but one at least over each range; anything else as it is.
    #[must_use]
    pub fn with_fewer_nodes(self, halvings: u32) -> Self {
        let Self::Family(family) = self else { return self };
        let [coat, base] = [family.coat, family.base].map(|axis| {
            let steps = (axis.nodes - 1).div_ceil(1 << halvings);
            super::SlopeAxis { nodes: steps + 1, ..axis }
        });
        Self::Family(Family { coat, base, ..family })
    }

    /// The node of the stack itself: at factor 1, or with all layers.
    pub fn nominal(self) -> usize {
        match self {
            Self::Alpha | Self::Slab | Self::Patina(_) => 0,
            Self::Film(_) => self.nodes() / 2,
            // Textures scale the largest slope parameters down.
            Self::Family(family) => family.nodes() - 1,
        }
    }

    /// The factor at the fractional number of a node. For slope parameters the last node is one root's step before 0: below it lobes only grow
    /// narrower, and their energies hardly change.
    pub fn factor(self, place: f64) -> f64 {
        let share = place / self.steps();
        match self {
            Self::Alpha | Self::Slab => (1.0 - share) * (1.0 - share),
            Self::Film([most, least]) => most + share * (least - most),
            Self::Patina(_) => self.steps() - place,
            Self::Family(_) => place,
        }
    }

    /// Steps between nodes from a root of 1 to one of 0, or from the greatest factor to the least.
    fn steps(self) -> f64 {
        match self {
            Self::Alpha => self.nodes() as f64,
            Self::Slab | Self::Film(_) | Self::Patina(_) | Self::Family(_) => (self.nodes() - 1) as f64,
        }
    }

    /// The fractional number of the node of a factor.
    pub fn place(self, factor: f64) -> f64 {
        let share = match self {
            Self::Family(_) => return factor.clamp(0.0, self.steps()),
            Self::Alpha | Self::Slab => 1.0 - factor.clamp(0.0, 1.0).sqrt(),
            Self::Film([most, least]) => ((most - factor) / (most - least)).clamp(0.0, 1.0),
            Self::Patina(_) => (1.0 - factor / self.steps()).clamp(0.0, 1.0),
        };
        (share * self.steps()).min((self.nodes() - 1) as f64)
    }

    /// The stack at a factor. With a patina these are all layers, without the patina's parameters, or the bare layers at 0.
    pub fn apply(self, stack: &Stack, factor: f64) -> Stack {
        let mut here = stack.clone();
        let first = here.layers.first_mut();
        match self {
            Self::Alpha => {
                here.layers.iter_mut().for_each(|layer| layer.surface = scaled_along(layer.surface, [factor; 2]));
            }
            Self::Slab => {
                if let Some(Base::Dielectric { slab, .. }) = first.map(|layer| &mut layer.base) {
                    slab.thickness_um *= factor;
                }
            }
            Self::Film(_) => {
                if let Some(film) = first.and_then(|layer| layer.films.first_mut()) {
                    let nm = factor * film.thickness.nominal_nm();
                    film.thickness = FilmThickness { min_nm: nm, max_nm: nm };
                }
            }
            Self::Patina(_) if factor > 0.0 => {}
            Self::Patina(_) => return patina::bare(stack),
            Self::Family(family) => return family.apply(stack, family.alphas(factor as usize)),
        }
        here
    }
}

/// Lobes at factors, the greatest first. Between two nodes, rows are linear in the root of the factor, and in the factor itself over films.
///
/// A factor on slope parameters makes lobes narrower by about as much. So rows are divided by it before they are mixed, and multiplied again
/// afterwards.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Varied {
    /// The lobes of each node; one node if nothing varies. All nodes share axis, medium, shape of the remainder, and number of lobes.
    pub nodes: Vec<Lobes>,
    varying: Option<Over>,
}

/// The part of a stack that varies over the nodes.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Over {
    varying: Varying,
    /// Least factor by which slopes are divided: models raise slope parameters that are smaller.
    least: f64,
    stack: Stack,
    color: Color,
}

impl Over {
    /// The factor on slopes at a factor.
    fn spread(&self, factor: f64) -> f64 {
        match self.varying {
            Varying::Alpha => factor.max(self.least),
            Varying::Slab | Varying::Film(_) | Varying::Patina(_) | Varying::Family(_) => 1.0,
        }
    }

    /// The factor on slopes at a node.
    fn spread_at(&self, node: usize) -> f64 {
        self.spread(self.varying.factor(node as f64))
    }
}

impl FitSettings {
    /// Steps of the rows by default from row to row: 2 of a family with many nodes, whose table would be large.
    pub fn step(varying: Option<Varying>) -> usize {
        match varying {
            Some(Varying::Family(family)) if family.nodes() > MANY_NODES => 2,
            _ => 1,
        }
    }

    /// The settings of bakes.
    pub fn of(varying: Option<Varying>) -> Self {
        Self { rows: (Self::DEFAULT_ROWS - 1) / Self::step(varying) + 1, ..Self::default() }
    }
}

/// The least albedo over which the error of rows that are left out counts.
const ALBEDO_MIN: f64 = 0.02;

/// A function that fits lobes as [`Varied::of`] does. It may return lobes that it has kept from before.
pub type Fit<'a> = dyn Fn(&Stack, &Color, Option<Varying>) -> Varied + Send + Sync + 'a;

impl Varied {
    /// The lobes of a stack as bakes have them, see [`Lobes::of`]. An anisotropic stack has its rows over the azimuth, and none over a factor.
    pub fn of(stack: &Stack, color: &Color, varying: Option<Varying>) -> Self {
        Self::with(stack, color, varying, FitSettings::of(varying))
    }

    /// [`Self::of`] with settings.
    pub fn with(stack: &Stack, color: &Color, varying: Option<Varying>, settings: FitSettings) -> Self {
        Traced::new(stack, color, varying, settings).fit(most_lobes(stack), EXCESS)
    }

    /// Lobes with one width, see [`super::OneWidth`]: where nothing varies, and there is at most one in the plane of the eye.
    #[must_use]
    pub fn of_one_width(mut self) -> Option<Self> {
        let [lobes] = <[Lobes; 1]>::try_from(self.nodes).ok().filter(|_| self.varying.is_none())?;
        self.nodes = vec![lobes.of_one_width()?];
        Some(self)
    }

    /// Lobes whose first interface reflects by a polynomial, see [`super::Curve`]: where nothing varies, and one is near.
    #[must_use]
    pub fn of_curve(mut self) -> Option<Self> {
        let [lobes] = <[Lobes; 1]>::try_from(self.nodes).ok().filter(|_| self.varying.is_none())?;
        self.nodes = vec![lobes.of_curve()?];
        Some(self)
    }

    /// Every `step`-th row. `step` has to divide the number of steps between rows.
    #[must_use]
    pub fn thinned(mut self, step: usize) -> Self {
        for lobes in &mut self.nodes {
            let size = lobes.axis.size();
            let kept = lobes.rows.chunks(size).flat_map(|tile| tile.iter().step_by(step));
            lobes.rows = kept.cloned().collect();
            lobes.axis = lobes.axis.thinned(step);
        }
        self
    }

    /// Errors that [`Self::thinned`] makes where it leaves rows out: that of the albedo, and half of it over the albedo (at least .02: channels beyond Rec.709 are below 0), which no lobe error is below. Rows of a
    /// family have no albedo but in colours: 0.
    pub fn error_of_thinning(&self, step: usize) -> FitError {
        let mut found = FitError::default();
        if matches!(self.varying(), Some(Varying::Family(_))) {
            return found;
        }
        let tiles = self.nodes.iter().flat_map(|lobes| lobes.rows.chunks(lobes.axis.size()));
        for ends in tiles.flat_map(|rows| rows.windows(step + 1).step_by(step)) {
            let [first, last] = [0, step].map(|i| ends[i].albedo_dir);
            for (i, left_out) in ends[..step].iter().enumerate().skip(1) {
                let share = i as f64 / step as f64;
                for (c, albedo) in left_out.albedo_dir.into_iter().enumerate() {
                    let apart = (first[c] + share * (last[c] - first[c]) - albedo).abs();
                    found.albedo = found.albedo.max(apart);
                    found.lobe = found.lobe.max(0.5 * apart / albedo.max(ALBEDO_MIN));
                }
            }
        }
        found
    }

    /// Rows between each two beside them: `parts` steps in place of one. Light read from either is the same.
    #[must_use]
    pub fn refined(mut self, parts: usize) -> Self {
        self.nodes = self.nodes.into_iter().map(|lobes| lobes.refined(parts)).collect();
        self
    }

    /// Number of tiles of a stack: over the azimuth if it is anisotropic and no family, and else over the nodes.
    pub fn tiles_of(stack: &Stack, varying: Option<Varying>) -> usize {
        if Varying::axes(varying, stack).is_some() { Axes::TILES } else { varying.map_or(1, Varying::nodes) }
    }

    /// The lobes of a tile, and the number of the tile in them.
    pub fn tile(&self, tile: usize) -> (&Lobes, usize) {
        if self.varying.is_some() { (&self.nodes[tile], 0) } else { (&self.nodes[0], tile) }
    }

    /// The part that varies.
    pub fn varying(&self) -> Option<Varying> {
        self.varying.as_ref().map(|over| over.varying)
    }

    /// The least factor by which slopes of rows are divided; 1 if slopes do not vary.
    pub fn least_spread(&self) -> f64 {
        self.varying.as_ref().map_or(1.0, |over| over.spread(0.0))
    }

    /// A row of a tile as tables store it: slopes are divided by their factor.
    pub fn stored(&self, tile: usize, row: usize) -> Row {
        let spread = self.varying.as_ref().map_or(1.0, |over| over.spread_at(tile));
        let (lobes, tile) = self.tile(tile);
        lobes.tile(tile)[row].clone().spread(1.0 / spread)
    }

    /// Energy of one facet of the layer below a patina, a mean of the channels. It is 0 in all tiles but the one of the bare layers. Shaders draw
    /// directions by it.
    pub fn bare_facets(&self, tile: usize, row: usize) -> f64 {
        let is_bare = matches!(self.varying(), Some(Varying::Patina(_))) && tile + 1 == self.nodes.len();
        if is_bare && self.nodes[tile].first.is_some() { mean(self.nodes[tile].rows[row].first_facet()) } else { 0.0 }
    }

    /// The lobes of the stack itself, without a texture.
    pub fn nominal(mut self) -> Lobes {
        if let Some(Over { varying: Varying::Family(family), stack, .. }) = &self.varying
            && let Some(lobes) = self.painted(family.slopes(stack), &Paint::of(stack))
        {
            return lobes;
        }
        let node = self.varying().map_or(0, Varying::nominal);
        self.nodes.swap_remove(node)
    }

    /// The lobes of the stack itself, and those of its bare layers, if rows are over the amount of the first one.
    pub fn ends(self) -> (Lobes, Option<Lobes>) {
        let over_cover = matches!(self.varying(), Some(Varying::Patina(_)));
        let bare = self.nodes.last().filter(|_| over_cover).cloned();
        (self.nominal(), bare)
    }

    /// The rows of a family at a fractional number of a node of the coat, and of the base.
    fn among(&self, family: Family, [coat, base]: [f64; 2]) -> Lobes {
        let [coat, base] = [(coat, family.coat), (base, family.base)].map(|(place, axis)| {
            let first = (place as usize).min(axis.nodes.saturating_sub(2));
            (first, (first + 1).min(axis.nodes - 1), place - first as f64)
        });
        let mut lobes = self.nodes[0].clone();
        let rows = (0..lobes.rows.len()).map(|row| {
            let [low, high] = [coat.0, coat.1].map(|coat| {
                let [low, high] = [base.0, base.1].map(|base| self.stored(coat * family.base.nodes + base, row));
                low.between(&high, base.2)
            });
            low.between(&high, coat.2)
        });
        lobes.rows = rows.collect();
        lobes
    }

    /// The rows of a family at the nodes of one over the same ranges, with fewer nodes; those of anything else as they are.
    #[must_use]
    pub fn at_nodes(self, fewer: Option<Varying>) -> Self {
        let (Some(Over { varying: Varying::Family(family), .. }), Some(Varying::Family(fewer))) =
            (&self.varying, fewer)
        else {
            return self;
        };
        let (family, fewer) = (*family, Family { sent_back: family.sent_back, ..fewer });
        let places = (0..fewer.nodes()).map(|node| family.places(fewer.alphas(node)));
        let mut nodes: Vec<Lobes> = places.map(|place| self.among(family, place)).collect();
        if fewer.has_tail {
            fewer.hold_shares(&mut nodes);
        }
        let varying = self.varying.map(|over| Over { varying: Varying::Family(fewer), ..over });
        Self { nodes, varying }
    }

    /// Number of tiles.
    pub fn tiles(&self) -> usize {
        self.nodes.iter().map(|lobes| lobes.rows.len() / lobes.axis.size()).sum()
    }

    /// The lobes of a family at slope parameters of coat and base, held to the ranges, and in colours; the first interface is that of the stack.
    pub fn painted<S: Into<Slopes>>(&self, slopes: [S; 2], paint: &Paint) -> Option<Lobes> {
        let over = self.varying.as_ref()?;
        let Varying::Family(family) = over.varying else { return None };
        let slopes = slopes.map(Into::into);
        let alphas = slopes.map(Slopes::mean);
        let held = family.held(alphas);
        // Between rows, numbers are in line, and what follows from them is not.
        let mut lobes = self.among(family, family.places(alphas)).refined(PAINTED_STEPS);
        let (frame, axis) = (lobes.frame, lobes.axis);
        let filmed = Filmed::new(&over.stack, family, paint, &over.color);
        for (place, row) in lobes.rows.iter_mut().enumerate() {
            // Rows of the horizon are traced just above it.
            let cos_theta = if place == 0 { 0.0 } else { axis.cos_theta(place as f64) };
            let film = filmed.as_ref().map(|film| film.light(family, row));
            *row = family.painted(row, held, (&frame, cos_theta), paint, film.as_ref());
        }
        lobes.frame.stretch = family.stretch(slopes);
        lobes.first = FirstInterface::of(&paint.on(&family.apply(&over.stack, slopes), family), &over.color);
        if let (Some(film), Some(first)) = (filmed.filter(|_| !family.is_coated()), &mut lobes.first) {
            first.reflectance = film.mixed(paint.metallic);
        }
        Some(lobes)
    }

    /// The lobes at a factor. If any patina has grown, it is their first interface.
    pub fn at(&self, factor: f64) -> Lobes {
        let mut lobes = self.nodes[0].clone();
        let Some(over) = &self.varying else { return lobes };
        let place = over.varying.place(factor);
        let first = (place as usize).min(self.nodes.len() - 2);
        let rows = (0..lobes.rows.len()).map(|row| {
            let ends = [first, first + 1].map(|node| self.stored(node, row));
            ends[0].between(&ends[1], place - first as f64).spread(over.spread(factor))
        });
        lobes.rows = rows.collect();
        lobes.first = FirstInterface::of(&over.varying.apply(&over.stack, factor), &over.color);
        lobes
    }
}

impl Family {
    /// A row of numbers, read between nodes at a cosine of the view, at slope parameters of coat and base that are held to the ranges, and in colours.
    /// A film on the base is one at the place.
    pub fn row_in(
        self,
        row: &Row,
        alphas: [f64; 2],
        seen: (&Frame, f64),
        paint: &Paint,
        film: Option<&FilmLight>,
    ) -> Row {
        self.painted(row, self.held(alphas), seen, paint, film)
    }

    /// Fractional numbers of the nodes of slope parameters of coat and base.
    pub fn places(self, [coat, base]: [f64; 2]) -> [f64; 2] {
        [self.coat.place(coat), self.base.place(base)]
    }

    /// Slope parameters of coat and base held to the ranges.
    pub(super) fn held(self, alphas: [f64; 2]) -> [f64; 2] {
        let [coat, base] = self.places(alphas);
        [self.coat.alpha(coat), self.base.alpha(base)]
    }
}

/// Nodes of a family with rows at every step: its table has less than 10 KiB.
const MANY_NODES: usize = 7;

/// Steps from row to row of painted lobes.
const PAINTED_STEPS: usize = 16;

impl Lobes {
    fn refined(mut self, parts: usize) -> Self {
        let size = self.axis.size();
        let refined = self.rows.chunks(size).flat_map(|tile| {
            (0..(size - 1) * parts + 1).map(|place| {
                let first = (place / parts).min(size - 2);
                tile[first].between(&tile[first + 1], place as f64 / parts as f64 - first as f64)
            })
        });
        self.rows = refined.collect();
        self.axis = self.axis.refined(parts);
        self
    }
}

/// The light of a stack, at every node.
#[derive(Debug)]
pub struct Traced {
    simulations: Vec<Simulation>,
    varying: Option<Over>,
    settings: FitSettings,
}

impl Traced {
    /// Traces the paths of a stack.
    pub fn new(stack: &Stack, color: &Color, varying: Option<Varying>, settings: FitSettings) -> Self {
        let stack = shown(stack);
        let Some(varying) = over(&stack, varying) else {
            let simulations = vec![Simulation::new(&stack, color, settings)];
            return Self { simulations, varying: None, settings };
        };
        let alphas = (stack.layers.iter())
            .filter(|layer| !matches!(layer.base, Base::Diffuse(_)))
            .map(|layer| layer.surface.alpha_x.clamp(ALPHA_MIN, 1.0));
        let least = ALPHA_MIN / alphas.fold(ALPHA_MIN, f64::max);
        if let Varying::Family(_) = varying {
            // Nodes trace their paths as they are fitted: all at once would be too much memory.
            let varying = Some(Over { varying, least: 1.0, stack, color: *color });
            return Self { simulations: Vec::new(), varying, settings };
        }
        let axis = ViewAxis::of(&stack, settings.rows);
        if let Varying::Patina(cover) = varying {
            let simulations = patina::simulations(&cover, axis, &stack, color, settings);
            let varying = Some(Over { varying, least: 1.0, stack, color: *color });
            return Self { simulations, varying, settings };
        }
        let indices = indices(&stack);
        let simulations = (0..varying.nodes()).map(|node| {
            let here = varying.apply(&stack, varying.factor(node as f64));
            let share = if node == varying.nominal() { 1 } else { varying.path_share() };
            // All nodes use the media of the stack itself, so that their lobes can be mixed.
            Simulation::within(&indices, axis, &here, color, FitSettings { paths: settings.paths / share, ..settings })
        });
        let simulations = simulations.collect();
        Self { simulations, varying: Some(Over { varying, least, stack, color: *color }), settings }
    }

    /// Relative indices of the media in whose half vectors lobes may be; none where something varies.
    pub fn media(&self) -> Vec<f64> {
        match (&self.varying, self.simulations.as_slice()) {
            (None, [only]) => only.cells.iter().map(|cells| cells.index).collect(),
            _ => Vec::new(),
        }
    }

    /// The light for lobes in the half vectors of one of [`Self::media`], by number.
    #[must_use]
    pub fn in_medium(&self, medium: usize) -> Self {
        let simulations = self.simulations.iter().map(|simulation| simulation.in_cells(medium)).collect();
        Self { simulations, varying: self.varying.clone(), settings: self.settings }
    }

    /// [`Self::fit`] without excess for every number of lobes from 0 up to `most`.
    pub fn fit_each(&self, most: usize) -> Vec<Varied> {
        match (&self.varying, self.simulations.as_slice()) {
            (None, [only]) => {
                only.fit_each(most).into_iter().map(|lobes| Varied { nodes: vec![lobes], varying: None }).collect()
            }
            _ => (0..=most).map(|most| self.fit(most, 0.0)).collect(),
        }
    }

    /// One short lobe, see [`Simulation::fit_short`]; `None` where something varies.
    pub fn fit_short(&self) -> Option<Varied> {
        let [only] = self.simulations.as_slice() else { return None };
        let lobes = only.fit_short().filter(|_| self.varying.is_none())?;
        Some(Varied { nodes: vec![lobes], varying: None })
    }

    /// The fewest lobes, up to `most`, that are no farther from the light than the best by more than `excess`, see [`Simulation::fit_fewest`].
    pub fn fit(&self, most: usize, excess: f64) -> Varied {
        let Some(over) = &self.varying else {
            return Varied { nodes: vec![self.simulations[0].fit_fewest(most, excess)], varying: None };
        };
        if let Varying::Patina(cover) = over.varying {
            let nodes = patina::nodes(&cover, &self.simulations, most, excess);
            return Varied { nodes, varying: self.varying.clone() };
        }
        if let Varying::Family(family) = over.varying {
            let (family, nodes) = family.lobes(&over.stack, &over.color, self.settings);
            return Varied { nodes, varying: Some(Over { varying: Varying::Family(family), ..over.clone() }) };
        }
        let (count, nominal) = (self.simulations.len(), over.varying.nominal());
        let [here, middle] = [nominal, count / 2].map(|node| (node, self.simulations[node].fewest(most, excess)));
        // Lobes may be farther apart at the middle node, and more of them seen there: the node with more lobes starts.
        let [lobes, lobes_middle] = [&here, &middle].map(|(_, found)| found.starts(Basis::Isotropic).len());
        let (seed, start) = if lobes_middle > lobes { middle } else { here };
        let mut found: Vec<Option<Found>> = (0..count).map(|_| None).collect();
        found[seed] = Some(start);
        let pairs = (seed + 1..count).map(|node| (node, node - 1)).chain((0..seed).rev().map(|node| (node, node + 1)));
        for (node, beside) in pairs {
            let from = found[beside].as_ref();
            let factor = over.spread_at(node) / over.spread_at(beside);
            found[node] = from.map(|from| self.simulations[node].follow(from, factor));
        }
        let pairs = self.simulations.iter().zip(&found);
        let nodes = pairs.filter_map(|(simulation, found)| Some(simulation.lobes(found.as_ref()?))).collect();
        Varied { nodes, varying: self.varying.clone() }
    }
}

/// The varying part of a stack. Rows of an anisotropic one are over the azimuth instead, unless they are those of a family.
fn over(stack: &Stack, varying: Option<Varying>) -> Option<Varying> {
    varying.filter(|_| Varying::axes(varying, stack).is_none())
}

/// A surface with factors on its slope parameters along the tangent and the bitangent, within the range of layer records before and after.
pub(crate) fn scaled_along(surface: Surface, factors: [f64; 2]) -> Surface {
    if factors == [1.0; 2] {
        return surface;
    }
    let [alpha_x, alpha_y] = [(surface.alpha_x, factors[0]), (surface.alpha_y, factors[1])]
        .map(|(alpha, factor)| (alpha.clamp(ALPHA_MIN, 1.0) * factor).clamp(ALPHA_MIN, 1.0));
    Surface { alpha_x, alpha_y, ..surface }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::{Diffuse, Distribution, Layer, Slab};

    use super::*;

    const COLOR: Color = Color::ThreeWavelengths([650.0, 550.0, 450.0]);
    const SETTINGS: FitSettings = FitSettings { rows: 8, paths: 16000, seed: 3 };

    fn coated(alpha: f64, thickness_um: f64, base: Base, base_alpha: f64) -> Stack {
        let coat = Base::Dielectric {
            ior: Ior::constant(1.5, 0.0).unwrap(),
            slab: Slab { thickness_um, absorption_per_um: [0.2, 0.4, 0.8] },
        };
        let layer = |alpha, base| Layer { films: vec![], surface: Surface::isotropic(Distribution::Ggx, alpha), base };
        Stack { exterior: Ior::vacuum(), layers: vec![layer(alpha, coat), layer(base_alpha, base)] }
    }

    fn metal() -> Base {
        Base::Conductor { ior: Ior::constant(0.3, 3.0).unwrap() }
    }

    /// Albedos are read at the eyes of the rows that are left out, as a renderer reads them.
    #[test]
    fn errors_of_thinning_are_those_of_the_rows_left_out() {
        let settings = FitSettings { rows: 7, ..SETTINGS };
        let varied = Varied::with(&coated(0.02, 2.0, metal(), 0.3), &COLOR, None, settings);
        for step in [2, 3, 6] {
            let thinned = varied.clone().thinned(step);
            let [full, few] = [&varied, &thinned].map(|varied| varied.at(1.0));
            let mut most = 0.0f64;
            for view in 0..full.axis.size() {
                let cos_theta = full.axis.cos_theta(view as f64);
                let wo = DVec3::new(((1.0 - cos_theta) * (1.0 + cos_theta)).max(0.0).sqrt(), 0.0, cos_theta);
                let [own, other] = [&full, &few].map(|lobes| lobes.prepare(wo).map(|prepared| prepared.albedo_dir()));
                let Some((own, other)) = own.zip(other) else { continue };
                most = (0..3).fold(most, |most, c| most.max((own[c] - other[c]).abs()));
            }
            let found = varied.error_of_thinning(step);
            assert!((found.albedo - most).abs() < 1e-9 && most > 1e-3, "{step}: {} {most}", found.albedo);
            assert!(found.lobe >= 0.5 * found.albedo);
        }
        assert_eq!(varied.error_of_thinning(1), FitError::default());
        // Albedos of colours beyond Rec.709 are below 0: rows of 0, -.05 and 0 are off by .05, which is 1.25 times the least albedo of .02.
        let mut odd = varied.thinned(3);
        let [first, left_out, last] = &mut odd.nodes[0].rows[..] else { panic!() };
        first.albedo_dir = [0.0; 3];
        left_out.albedo_dir = [-0.05, 0.0, 0.0];
        last.albedo_dir = [0.0; 3];
        let found = odd.error_of_thinning(2);
        assert!((found.lobe - 1.25).abs() < 1e-12 && (found.albedo - 0.05).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn factors_and_places_are_inverse() {
        let film = Varying::Film([1.5, 0.5]);
        for (varying, last) in [(Varying::Alpha, 1.0 / 64.0), (Varying::Slab, 0.0), (film, 0.5)] {
            assert_eq!(varying.factor(varying.nominal() as f64), 1.0);
            assert!((varying.factor((varying.nodes() - 1) as f64) - last).abs() < 1e-15, "{varying:?}");
            for place in [0.0, 0.25, 3.5, 7.0] {
                assert!((varying.place(varying.factor(place)) - place).abs() < 1e-12, "{varying:?} {place}");
            }
            assert_eq!(varying.place(0.0), (varying.nodes() - 1) as f64);
        }
        let grown = Cover { diffuse_albedo: [0.0; 3], base_alpha: Some(0.3), tarnish: [1.0; 3] };
        for (cover, last) in [(grown, 2.0), (Cover { base_alpha: None, ..grown }, 1.0)] {
            let varying = Varying::Patina(cover);
            // Bare layers come last; the nominal stack is the first.
            assert_eq!(
                [0.0, 0.25, 1.0, last].map(|amount| varying.place(amount)),
                [last, last - 0.25, last - 1.0, 0.0]
            );
            assert!((varying.factor(varying.place(0.25)) - 0.25).abs() < 1e-15);
        }
    }

    /// Oracle: optics. A metal under a smooth coat shows its own distribution, as much narrower as the factor says.
    #[test]
    fn lobes_are_as_wide_as_the_factor_says() {
        let stack = coated(0.0, 0.0, metal(), 0.2);
        let varied = Varied::with(&stack, &COLOR, Some(Varying::Alpha), SETTINGS);
        assert_eq!((varied.nodes.len(), varied.varying()), (8, Some(Varying::Alpha)));
        let width = |factor: f64| {
            let lobes = varied.at(factor);
            let [along, across] = lobes.rows[lobes.rows.len() - 1].lobes[0].sharpness;
            1.0 / (along * across).sqrt()
        };
        for factor in [1.0, 0.6, 0.3, 0.1, 0.02] {
            let ratio = width(factor) / (0.2 * factor);
            // Few paths, as a test has: widths of single fits are off by a few hundredths.
            assert!((ratio - 1.0).abs() < 0.08, "{factor}: {ratio}");
        }
    }

    /// Oracle: Bouguer's law. Light that goes down and up along the normal through the slab is attenuated as `exp(-2 d sigma)`.
    #[test]
    fn energies_between_nodes_are_those_of_the_slab() {
        let diffuse = Base::Diffuse(Diffuse { albedo: [0.5; 3], sigma: 0.0 });
        let varied = Varied::with(&coated(0.01, 1.0, diffuse, 0.0), &COLOR, Some(Varying::Slab), SETTINGS);
        let smooth = Varied::with(&coated(0.0, 1.0, metal(), 0.01), &COLOR, Some(Varying::Slab), SETTINGS);
        assert_eq!(varied.least_spread(), 1.0);
        for factor in [1.0, 0.7, 0.41, 0.2, 0.05, 0.0] {
            let clear = smooth.at(0.0).row(DVec3::Z);
            let row = smooth.at(factor).row(DVec3::Z);
            let [below, all] = [&row, &clear].map(|row| [0, 2].map(|c: usize| row.albedo_dir[c] - 0.04));
            for (k, sigma) in [0.2, 0.8].into_iter().enumerate() {
                let (expected, found) = (libm::exp(-2.0 * factor * sigma), below[k] / all[k]);
                assert!((found - expected).abs() < 0.02, "{factor} {sigma}: {found} {expected}");
            }
            let albedo = varied.at(factor).row(DVec3::new(0.6, 0.0, 0.8)).albedo_dir;
            assert!(albedo[2] <= albedo[0] + 1e-3 && albedo[0] < 0.6, "{factor}: {albedo:?}");
        }
    }

    #[test]
    fn the_first_node_is_the_fit_without_maps() {
        let stack = coated(0.2, 1.0, metal(), 0.1);
        let alone = Varied::with(&stack, &COLOR, None, SETTINGS);
        let varied = Varied::with(&stack, &COLOR, Some(Varying::Slab), SETTINGS);
        assert_eq!(alone.at(0.5).rows, alone.nodes[0].rows);
        if varied.nodes[0].rows[0].lobes.len() == alone.nodes[0].rows[0].lobes.len() {
            assert_eq!(varied.nodes[0].rows, alone.nodes[0].rows);
        }
        assert_eq!(varied.at(1.0).rows[3].albedo_dir, varied.nodes[0].rows[3].albedo_dir);
        assert!(varied.nodes.iter().all(|node| node.rows.len() == 8));
    }
}
