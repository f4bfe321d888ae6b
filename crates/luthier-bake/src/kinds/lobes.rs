//! Lobes tiles: the simulated light from below the first interface of a material.

use std::sync::Arc;

use luthier_layers::models::lobes::{
    Axes, Cover, Critical, EXCESS, Family, FitError, FitSettings, Judge, LOBES, Paint, Painted, Row, SlopeAxis, Traced,
    Varied, Varying, base_below, most_lobes, shown,
};
use luthier_lut::{
    AtlasLayout, Axis, Comparison, ErrorStats, Image, Mapping, RowLayout, Scan, TableKind, TexelFormat, WeightBits,
    measure_scan,
};
use luthier_manifest::{
    AxesRecord, Budget, Candidate, CandidateForm, FamilyRecord, LobesError, LobesRecord, MapSlot, MeasuredError,
    PaintedRecord, Search, SlopesRecord, VaryingFactor, VaryingRecord,
};
use luthier_material::{Material, Patina};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::stack::{Base, Stack};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::{Kind, Site};
use crate::candidates::{self, Found, Refusal, choose, cost, locked};
use crate::graph::{Artefact, Graph, Inputs, Job, JobKind, Results, Store, result_of};
use crate::options::Options;
use crate::plan::Plan;
use crate::settings::{Ask, Settings, Shape, axis};
use crate::tile::{TileData, apron, color_in_words, lone_tile};
use crate::{BakeError, json};

/// Points of the error scan per texel interval.
const PER_CELL: u32 = 8;

/// Rows of a fit.
const ROWS: usize = FitSettings::DEFAULT_ROWS;

/// Steps between the rows that are kept, among which a search chooses.
const STEPS: [usize; 4] = [1, 2, 3, 6];

/// Jobs that fit lobes.
pub(crate) const FIT: JobKind = JobKind::part("fit");

/// Lobes tables.
pub(crate) struct Table;

impl Kind for Table {
    fn fixed(&self, Ask(materials): Ask<'_>) -> Result<Shape, BakeError> {
        Ok(shape(parts(materials, LOBES), common_step(materials), RowLayout::Filtered.format()))
    }

    /// A tile for the first layer, whose lobes contain the light of all layers below.
    fn job(&self, site: &Site<'_>) -> Result<Option<Arc<dyn Job>>, BakeError> {
        let Site { material, layer, shape, .. } = site;
        let is_first = material.stack.layers.first().is_some_and(|first| std::ptr::eq(first, *layer));
        if !is_first {
            return Ok(None);
        }
        let (fit, axes, format) = (fit(material, site.lobes.is_some()), shape.axes(), shape.format);
        Ok(Some(Arc::new(LobesJob { fit, most: site.lobes, tile: 0, axes, format })))
    }

    /// Tiles for the other nodes over the varying factor, or over the azimuth.
    fn followers(&self, site: &Site<'_>) -> Vec<Arc<dyn Job>> {
        let Site { material, shape, lobes: most, .. } = *site;
        let fit = fit(material, most.is_some());
        let (tiles, format) = (1..Varied::tiles_of(&fit.stack, fit.varying_of(most)), shape.format);
        let jobs = tiles.map(|tile| LobesJob { fit: fit.clone(), most, tile, axes: shape.axes(), format });
        jobs.map(|job| Arc::new(job) as Arc<dyn Job>).collect()
    }
}

/// The factor that a texture varies and that rows are over, or the slope parameters and colours of single layers. A material has at most one of these.
fn varying(material: &Material) -> Option<Varying> {
    let first = material.layers.first()?;
    let family = material.family().and_then(|ranges| {
        Some(
            Family::new(&shown(&material.stack), ranges.coat, ranges.base, ranges.is_metallic)?
                .tinted(ranges.is_tinted)
                .below_varied_slab(ranges.has_lengths),
        )
    });
    if let Some(family) = family {
        return Some(Varying::Family(family));
    }
    let slab = first.varies_slab().then_some(Varying::Slab);
    let scaled =
        first.varies(MapSlot::Roughness).then_some(Varying::Alpha).or(slab).or_else(|| Varying::film(&material.stack));
    let is_covered = material.is_bare_in_places() && !material.has_side();
    let covers = is_covered.then_some(match &material.effects.patina {
        &Some(Patina { diffuse_albedo, base_alpha, tarnish, .. }) => Cover { diffuse_albedo, base_alpha, tarnish },
        None => Cover::PLAIN,
    });
    scaled.or_else(|| covers.map(Varying::Patina))
}

/// The layers below a coat with a weight, if they have rows of their own.
fn side(material: &Material) -> Option<Material> {
    material.side().filter(has_rows)
}

/// Whether a material has rows: a diffuse base alone has a closed form.
pub(crate) fn has_rows(material: &Material) -> bool {
    Interface::of(&material.stack, 0).is_some()
}

/// Steps of the rows by default from row to row that suffice for all materials. Layers below a coat have the rows of the others.
fn common_step(materials: &[Material]) -> usize {
    let fitted = materials.iter().filter(|material| material.model().is_fitted());
    fitted.map(|material| FitSettings::step(varying(material))).min().unwrap_or(1)
}

/// Whether rows are those of a family.
fn is_family(varying: Option<Varying>) -> bool {
    matches!(varying, Some(Varying::Family(_)))
}

/// A budget that cannot be met, with the error of each material, by number, under the nearest candidate.
pub(crate) type Broken = (Refusal, Vec<(usize, MeasuredError)>);

/// Most layers of a stack with rows over something beside the view: such a stack has a fit for each of its tiles. The
/// time of a fit is proportional to the layers. With transparent layers of alpha 0.25, a fit of 50 takes 31 s of a
/// core, and one of 16 under a roughness map 46 s: no fit takes a minute.
pub const VARIED_LAYERS_MAX: usize = 16;

/// Whether a material of the model `lobes` has more layers than can be fitted.
pub fn is_too_deep(material: &Material) -> bool {
    let is_varied = |material: &Material| Varied::tiles_of(&shown(&material.stack), varying(material)) > 1;
    material.stack.layers.len() > VARIED_LAYERS_MAX
        && material.model().is_fitted()
        && (is_varied(material) || side(material).is_some())
}

/// Whether rows of a material contain the light of a diffuse base, as parts before the others. Families have parts of their own.
fn has_base(material: &Material) -> bool {
    let is_other = matches!(varying(material), Some(Varying::Patina(_) | Varying::Family(_)));
    !is_other && base_below(&material.stack).is_some()
}

/// Numbers of the first part and of the last that rows of materials have, with at most so many lobes.
fn parts(materials: &[Material], lobes: usize) -> [i32; 2] {
    let fitted: Vec<&Material> = materials.iter().filter(|material| material.model().is_fitted()).collect();
    let sides: Vec<Material> = fitted.iter().filter_map(|material| side(material)).collect();
    let ends = fitted.into_iter().chain(&sides).map(|material| match varying(material) {
        Some(Varying::Family(family)) => {
            let parts = family.parts(
                has_lengths(material, family),
                base_below(&material.stack).is_some(),
                family.is_filmed(&material.stack),
            );
            ([family.first_part(), parts as i32 - 1], true)
        }
        _ => ([if has_base(material) { -BASE_PARTS } else { 0 }, Row::parts(lobes) as i32 - 1], false),
    });
    let ends: Vec<([i32; 2], bool)> = ends.collect();
    let ([mut first, mut last], _) = (ends.iter().copied())
        .reduce(|([first, last], _), ([from, to], _)| ([first.min(from), last.max(to)], true))
        .unwrap_or(([0, Row::parts(lobes) as i32 - 1], false));
    let has = |of_family: bool| ends.iter().any(|(_, is_family)| *is_family == of_family);
    if has(true) && has(false) {
        // Beside families other rows have all parts of a base before part 0, or none, and those of two lobes.
        first = if first < 0 { -BASE_PARTS } else { 0 };
        last = last.max(Row::parts(LOBES) as i32 - 1);
    }
    [first, last]
}

/// Number of parts of a diffuse base.
const BASE_PARTS: i32 = Row::BASE_PARTS as i32;

/// Whether rows of a family have lengths of light in a slab, or cosines at which the facets below a film are seen.
fn has_lengths(material: &Material, family: Family) -> bool {
    let is_under_film = !family.is_coated() && family.is_filmed(&material.stack);
    is_under_film || Paint::of(&material.stack).depth != [0.0; 3]
}

/// The layout of rows that options ask for, or else the cheaper one: see [`Options::layout`].
pub(crate) fn layout(materials: &[Material], options: &Options<'_>, asked: &Budget) -> RowLayout {
    let has_one_tile = |material: &Material| {
        let varying = varying(material);
        !is_family(varying) && Varied::tiles_of(&shown(&material.stack), varying) == 1
    };
    let is_alone =
        |material: &Material| has_one_tile(material) && side(material).is_none_or(|side| has_one_tile(&side));
    let mut fitted = materials.iter().filter(|material| material.model().is_fitted());
    options.layout.unwrap_or_else(|| {
        let has_room = asked.max_bytes.is_none() && options.formats.has(RowLayout::Steps.format());
        if has_room && fitted.all(is_alone) { RowLayout::Steps } else { RowLayout::Filtered }
    })
}

/// The shape of tiles with parts from the first to the last. `step` is the distance of the rows that are kept.
fn shape([first, last]: [i32; 2], step: usize, format: TexelFormat) -> Shape {
    let rows = (ROWS - 1) / step + 1;
    let axes = [
        axis("cos_theta", "", [0.0, 1.0], rows as u32, Mapping::Rational { bend: 1.0 }),
        axis("part", "", [first, last].map(f64::from), (last - first) as u32 + 1, Mapping::Apart),
    ];
    Shape::grid(axes, format)
}

/// Parts of rows with so many lobes that the light of a view takes.
fn reads(lobes: usize) -> usize {
    [1, 3, 4][lobes.min(LOBES)]
}

/// Most reads of a texture for a view that take no time of their own: by the costs of the H100 two hide behind the arithmetic of the shader (5.7 ps, 7.2 in a buffer),
/// and three do not (8.2 and 7.5).
const HIDDEN_READS: usize = 2;

/// The shape of tiles whose rows have one lobe of one width.
fn shape_of_one_width([first, _]: [i32; 2], step: usize, format: TexelFormat) -> Shape {
    shape([first, ONE_WIDTH_LAST], step, format)
}

/// Number of the last part of rows with one lobe of one width: light takes the parts before it. No other rows end there.
const ONE_WIDTH_LAST: i32 = 2;

/// Whether rows of tiles with such parts have one lobe of one width.
fn is_of_one_width(parts: &Axis) -> bool {
    parts.max == f64::from(ONE_WIDTH_LAST)
}

/// The step between kept rows of an axis with this many nodes.
fn step(size: u32) -> usize {
    (ROWS - 1) / (size as usize - 1)
}

/// The graph of the fits alone, if there are any.
pub(crate) fn fits(graph: &Graph) -> Option<Graph> {
    graph.of::<FitJob>().next()?;
    Some(graph.only(|job| job.kind() == FIT))
}

/// Decides the shape of the tiles, from the fits of a plan. Without limits on the errors of lobes, the tiles have as
/// many parts as the material with the most lobes needs. With limits, the smallest shape that holds them is taken, and
/// the search is reported. Families have fewer nodes where others have fewer lobes.
///
/// # Errors
/// [`Broken`] where no shape holds the limits.
pub(crate) fn decide(
    settings: &mut Settings,
    plan: &Plan,
    materials: &[Material],
    results: &Results,
    budget: &Budget,
    options: &Options<'_>,
) -> Result<Option<Search>, Broken> {
    let fits: Vec<&Fits> = plan.graph.of::<FitJob>().filter_map(|job| results.get(job.key())).collect();
    let given = settings.fixed(TableKind::Lobes).format;
    // Few reads of textures hide behind arithmetic.
    let format_of = |reads: usize| {
        let hides = options.layout.is_none() && reads <= HIDDEN_READS;
        if hides { RowLayout::Filtered.format() } else { given }
    };
    if settings.lobes.is_none() {
        let lobes = lobes_of(&fits, None);
        settings.take_lobes(shape(parts(materials, lobes), common_step(materials), format_of(reads(lobes))));
        return Ok(None);
    }
    let have_one_width = fits.iter().all(|fits| fits.of(Some(1)).of_one_width.is_some());
    let steps = (0..=LOBES).map(|most| (most, false)).chain(have_one_width.then_some((1, true)));
    let choices: Vec<(usize, bool, usize)> =
        steps.flat_map(|(most, has_one_width)| (0..STEPS.len()).map(move |i| (most, has_one_width, i))).collect();
    let shape_of = |(most, has_one_width, i): (usize, bool, usize)| {
        let lobes = lobes_of(&fits, Some(most));
        let parts = parts(materials, lobes);
        match has_one_width {
            true => shape_of_one_width(parts, STEPS[i], format_of(ONE_WIDTH_LAST as usize)),
            false => shape(parts, STEPS[i], format_of(reads(lobes))),
        }
    };
    let candidates = choices.iter().map(|&(most, has_one_width, i)| {
        let errors = fits.iter().map(|fits| fits.of(Some(most)).errors(has_one_width)[i]);
        let error = errors.fold(FitError::default(), FitError::max);
        let tiles = fits.iter().map(|fits| fits.of(Some(most)).varied.tiles() as u32).sum();
        let Shape { x, y, base, format } = shape_of((most, has_one_width, i));
        let cost = cost::axis(&x) + y.as_ref().map_or(1.0, |y| f64::from(y.size)) * cost::read(format);
        let apron = apron(std::iter::once(&x).chain(&y));
        let layout = AtlasLayout { x: x.clone(), y: y.clone(), apron, columns: 1, tiles, base };
        let bytes = layout.size().map(u64::from).iter().product::<u64>() * u64::from(format.texel_bytes());
        let form = CandidateForm::Table { x, y, format, base };
        Candidate { form, bytes, cost, error: measured(error) }
    });
    let found = Found::new(TableKind::Lobes, 0.0, candidates.collect());
    let found = std::slice::from_ref(&found);
    let chosen = locked(found, options.locked, budget, 0).map_or_else(|| choose(found, budget, 0), Ok);
    let chosen = chosen.map_err(|refusal| {
        let (most, has_one_width, i) = match &refusal {
            Refusal::Error { nearest: (_, nearest), .. } => choices[*nearest],
            Refusal::Whole { .. } => choices[0],
        };
        let errors = materials.iter().enumerate().filter_map(|(number, material)| {
            let fits = [Some(fit(material, true)), side(material).map(|side| fit(&side, true))];
            let fits = fits.into_iter().flatten().filter_map(|job| results.get::<Fits>(job.key()));
            let errors = fits.map(|fits| fits.of(Some(most)).errors(has_one_width)[i]);
            Some((number, measured(errors.reduce(FitError::max)?)))
        });
        (refusal, errors.collect())
    })?[0];
    settings.lobes = Some(choices[chosen].0);
    settings.take_lobes(shape_of(choices[chosen]));
    Ok(Some(candidates::report(&found[0], chosen, budget)))
}

/// The most lobes of any fit, if each has at most `most`.
fn lobes_of(fits: &[&Fits], most: Option<usize>) -> usize {
    fits.iter().map(|fits| fits.of(most).lobes()).max().unwrap_or(0)
}

fn measured(error: FitError) -> MeasuredError {
    MeasuredError { lobe: Some(error.lobe), albedo: Some(error.albedo), ..MeasuredError::default() }
}

/// The job that fits a material; for every number of lobes, if a search chooses among them.
fn fit(material: &Material, is_searched: bool) -> Arc<FitJob> {
    let (stack, color, varying) = (shown(&material.stack), material.color(), varying(material));
    let stack = match varying {
        Some(Varying::Family(family)) => alike(&stack, family),
        _ => stack,
    };
    Arc::new(FitJob { stack, color, varying, is_searched })
}

/// The stack of a family with the same numbers in place of all that its rows do not hang on: slope parameters that are axes, and colours in closed
/// form. Materials that differ in these alone share a fit.
fn alike(stack: &Stack, family: Family) -> Stack {
    let mut stack = family.apply(stack, family.alphas(0));
    if family.is_metallic
        && let Some(Base::Diffuse(base)) = stack.layers.last_mut().map(|layer| &mut layer.base)
    {
        base.albedo = ANY_COLOR;
    }
    stack
}

/// A colour that stands for others.
const ANY_COLOR: Rgb = [0.5; 3];

/// The lobes of a stack, as in bakes without limits on their errors. They come from the store, or are fitted now and
/// kept.
pub fn fitted(stack: &Stack, color: &Color, varying: Option<Varying>, store: &dyn Store) -> Varied {
    let job = FitJob { stack: shown(stack), color: *color, varying, is_searched: false };
    let fits = result_of(&job, store);
    let fits: &Fits = fits.get().unwrap_or_else(|| unreachable!("results at the address of a fit are fits"));
    fits.of(None).varied.clone()
}

/// Placeholder numbers where nothing was fitted.
const UNFITTED: LobesRecord = LobesRecord {
    index: 1.5,
    falloff: [0.5, 0.1],
    integral: 0.95,
    critical_cot_sq: 0.0,
    critical_width: 0.0,
    critical_plain_share: 0.0,
    lobes: 2,
    inverse_tails: [1.0; 2],
    rise: None,
    varying: None,
    axes: None,
    painted: None,
    error: None,
};

/// The view-independent numbers of a material's lobes; [`UNFITTED`] in an outline without fits.
pub(crate) fn record(material: &Material, settings: &Settings, results: &Results) -> LobesRecord {
    let axes = Varying::axes(varying(material), &material.stack).map(|Axes { turn, is_mirrored }| AxesRecord {
        turn,
        is_mirrored,
        tiles: Axes::TILES as u32,
    });
    let fits = results.get::<Fits>(fit(material, settings.lobes.is_some()).key());
    let Some((fits, shape)) = fits.zip(settings.shape(TableKind::Lobes)) else {
        let base = base_below(&material.stack).filter(|_| has_base(material) || is_family(varying(material)));
        let painted = base.map(|base| PaintedRecord { albedo: base.albedo, moments: None });
        let varying = varying(material).and_then(|varying| match varying {
            Varying::Family(family) => Some(VaryingRecord {
                factor: VaryingFactor::Family,
                tiles: family.nodes() as u32,
                least_spread: 1.0,
                factors: None,
                family: Some(family_record(family)),
            }),
            _ => None,
        });
        return LobesRecord { axes, painted, varying, ..UNFITTED };
    };
    let fit = fits.of(settings.lobes);
    let has_one_width = shape.y.as_ref().is_some_and(is_of_one_width);
    let varied = fit.shaped(has_one_width);
    let step = step(shape.x.size);
    let error = STEPS.iter().position(|known| *known == step).map(|i| {
        let FitError { lobe, lobe_noise, albedo, albedo_noise } = fit.errors(has_one_width)[i];
        LobesError { lobe, lobe_noise, albedo, albedo_noise }
    });
    let lobes = &varied.nodes[0];
    let (wide, Critical { cot_sq, width, plain_share }) = (lobes.frame.wide, lobes.axis.critical());
    LobesRecord {
        index: lobes.frame.index,
        falloff: wide.falloff(),
        integral: wide.integral(),
        critical_cot_sq: cot_sq,
        critical_width: width,
        critical_plain_share: plain_share,
        lobes: fit.lobes() as u32,
        inverse_tails: texels_of(
            lobes
                .frame
                .one_width
                .map_or(varied.stored(0, 0).inverse_tails(), |one_width| [one_width.inverse_tail, 0.0]),
            shape.format,
        ),
        rise: lobes.frame.one_width.map(|one_width| one_width.rise),
        varying: varied.varying().map(|varying| VaryingRecord {
            factor: match varying {
                Varying::Alpha => VaryingFactor::AlphaFactor,
                Varying::Slab => VaryingFactor::SlabFactor,
                Varying::Film(_) => VaryingFactor::FilmFactor,
                Varying::Patina(_) if material.weight().is_some() => VaryingFactor::WeightFactor,
                Varying::Patina(_) => VaryingFactor::Patina,
                Varying::Family(_) => VaryingFactor::Family,
            },
            factors: match varying {
                Varying::Film(factors) => Some(factors),
                Varying::Alpha | Varying::Slab | Varying::Patina(_) | Varying::Family(_) => None,
            },
            family: match varying {
                Varying::Family(family) => Some(family_record(family)),
                Varying::Alpha | Varying::Slab | Varying::Film(_) | Varying::Patina(_) => None,
            },
            tiles: varied.nodes.len() as u32,
            least_spread: varied.least_spread(),
        }),
        axes,
        painted: lobes.frame.base.map(|Painted { albedo, is_lambertian }| PaintedRecord {
            // Fits of families have any colour.
            albedo: base_below(&material.stack).map_or(albedo, |base| base.albedo),
            moments: varied.varying().filter(|_| is_lambertian).map(|_| wide.moments()),
        }),
        error,
    }
}

/// The axes of a family for the manifest.
fn family_record(family: Family) -> FamilyRecord {
    let axis = |SlopeAxis { least, most, nodes }| SlopesRecord { least, most, nodes: nodes as u32 };
    FamilyRecord {
        coat: family.is_coated().then(|| axis(family.coat)),
        base: axis(family.base),
        interface: family.interface as u32,
        is_metallic: family.is_metallic,
        is_tinted: family.is_tinted,
        has_tail: family.has_tail,
        sent_back: family.sent_back,
        has_lengths: family.has_lengths,
    }
}

/// Numbers as texels of a format have them.
fn texels_of(numbers: [f64; 2], format: TexelFormat) -> [f64; 2] {
    let image = Image { width: 1, height: 1, channels: 2, data: numbers.map(|x| x as f32).to_vec() };
    let texels = format.quantise(&image).data;
    [texels[0], texels[1]].map(f64::from)
}

/// Lobes of a material, and their errors with each of [`STEPS`].
#[derive(Debug, Serialize, Deserialize)]
struct Fit {
    varied: Varied,
    errors: [FitError; STEPS.len()],
    /// Errors with [`OneWidth`](luthier_layers::models::lobes::OneWidth), of a search where lobes have it.
    of_one_width: Option<[FitError; STEPS.len()]>,
}

impl Fit {
    fn new(varied: Varied, judge: &Judge) -> Self {
        Self { errors: STEPS.map(|step| judge.error(&thinned(varied.clone(), step))), varied, of_one_width: None }
    }

    /// With the errors of lobes of one width.
    fn and_of_one_width(self, judge: &Judge) -> Self {
        let narrowed = self.varied.clone().of_one_width();
        let of_one_width = narrowed.map(|varied| STEPS.map(|step| judge.error(&thinned(varied.clone(), step))));
        Self { of_one_width, ..self }
    }

    /// Errors with each of [`STEPS`].
    fn errors(&self, has_one_width: bool) -> &[FitError; STEPS.len()] {
        self.of_one_width.as_ref().filter(|_| has_one_width).unwrap_or(&self.errors)
    }

    /// The lobes, with one width if so.
    fn shaped(&self, has_one_width: bool) -> Varied {
        let narrowed = has_one_width.then(|| self.varied.clone().of_one_width()).flatten();
        narrowed.unwrap_or_else(|| self.varied.clone())
    }

    /// Number of lobes.
    fn lobes(&self) -> usize {
        self.varied.nodes[0].rows[0].lobes.len()
    }
}

/// Lobes with every `step`-th of [`ROWS`]. Fits with fewer get those between.
fn thinned(varied: Varied, step: usize) -> Varied {
    let own = (ROWS - 1) / (varied.nodes[0].axis.size() - 1);
    let varied = if own > 1 { varied.refined(own) } else { varied };
    varied.thinned(step)
}

/// Result of a [`FitJob`]: one fit without a search, else one for each largest number of lobes from 0 on, or of a family for as many halvings of its nodes as
/// lobes lack.
#[derive(Debug, Serialize, Deserialize)]
struct Fits(Vec<Fit>);

impl Fits {
    /// The fit; with at most `most` lobes, if a search decided so.
    fn of(&self, most: Option<usize>) -> &Fit {
        &self.0[most.unwrap_or(0).min(self.0.len() - 1)]
    }
}

/// The simulation of a stack, and the fits to it: [`Fits`].
#[derive(Debug)]
struct FitJob {
    stack: Stack,
    color: Color,
    varying: Option<Varying>,
    is_searched: bool,
}

impl FitJob {
    /// Part of the stack that rows are over, where a search allows so many lobes: a family always has two, and fewer nodes in place of fewer lobes.
    fn varying_of(&self, most: Option<usize>) -> Option<Varying> {
        let fewer = most.map_or(0, |most| LOBES.saturating_sub(most) as u32);
        self.varying.map(|varying| varying.with_fewer_nodes(fewer))
    }
}

impl Job for FitJob {
    fn kind(&self) -> JobKind {
        FIT
    }

    fn revision(&self) -> u32 {
        if is_family(self.varying) { 13 } else { 8 }
    }

    fn inputs(&self) -> Value {
        let FitSettings { rows, paths, seed } = FitSettings::of(self.varying);
        json!({
            "stack": json::stack(&self.stack),
            "color": json::color(&self.color),
            "lobes": most_lobes(&self.stack),
            "excess": EXCESS,
            "rows": rows,
            "paths": paths,
            "seed": seed,
            "varying": self.varying.map(|varying| json!([factor_name(varying), numbers(varying)])),
            "is_searched": self.is_searched,
        })
    }

    fn run(&self, _: &Inputs<'_>) -> Artefact {
        let Self { stack, color, varying, is_searched } = self;
        let traced = Traced::new(stack, color, *varying, FitSettings::of(*varying));
        let judge = Judge::new(stack, color, *varying);
        let most = most_lobes(stack);
        if *is_searched && is_family(*varying) {
            let whole: Varied = traced.fit(most, EXCESS);
            let fits = (0..=LOBES).map(|most| {
                let fewer = self.varying_of(Some(most));
                let varied = whole.clone().at_nodes(fewer);
                let judge = Judge::new(stack, color, fewer);
                Fit::new(varied, &judge)
            });
            return Artefact::new(Fits(fits.collect()));
        }
        let wanted: Vec<(usize, f64)> =
            if *is_searched { (0..=most).map(|most| (most, 0.0)).collect() } else { vec![(most, EXCESS)] };
        let fits = wanted.into_iter().map(|(most, excess)| {
            let fit = Fit::new(traced.fit(most, excess), &judge);
            if *is_searched && most <= 1 { fit.and_of_one_width(&judge) } else { fit }
        });
        Artefact::new(Fits(fits.collect()))
    }

    fn decode(&self, bytes: &[u8]) -> Option<Artefact> {
        Artefact::decode::<Fits>(bytes)
    }
}

/// Numbers of the varying factor, for the key.
fn numbers(varying: Varying) -> Value {
    match varying {
        Varying::Alpha | Varying::Slab | Varying::Film(_) => json!([varying.factor(0.0), varying.factor(1.0)]),
        Varying::Patina(Cover { diffuse_albedo, base_alpha, tarnish }) => json!([diffuse_albedo, base_alpha, tarnish]),
        Varying::Family(Family { coat, base, interface, is_metallic, is_tinted, has_lengths, .. }) => {
            let axis = |SlopeAxis { least, most, nodes }| json!([least, most, nodes]);
            if is_tinted {
                return json!([axis(coat), axis(base), interface, is_metallic, "edge tint"]);
            }
            if has_lengths {
                return json!([axis(coat), axis(base), interface, is_metallic, "lengths"]);
            }
            json!([axis(coat), axis(base), interface, is_metallic])
        }
    }
}

/// Name of the varying factor.
fn factor_name(varying: Varying) -> &'static str {
    match varying {
        Varying::Alpha => "slope parameters",
        Varying::Slab => "thickness of the first slab",
        Varying::Film(_) => "thickness of the film",
        Varying::Patina(cover) if cover.is_plain() => "first layer",
        Varying::Patina(_) => "patina",
        Varying::Family(_) => "slope parameters of single layers",
    }
}

/// Rows as parts of four numbers.
#[derive(Debug, Clone, Copy)]
enum Parts {
    /// With so many lobes, and the light of a base (0 if rows have none) or without its parts.
    Lobes(usize, bool),
    /// With one lobe of one width, and the light of a base or without its parts.
    OneWidth(bool),
    /// Of a family, with lobes of this tail.
    Family(Family, f64),
}

impl Parts {
    /// A row filled up to the lobes of the tile, and with the light of a base if it has a place for it.
    fn filled(self, row: Row) -> Row {
        match self {
            Self::Lobes(most, has_base) => {
                Row { base: has_base.then(|| row.base.unwrap_or_default()), ..row.filled(most) }
            }
            Self::OneWidth(has_base) => Self::Lobes(1, has_base).filled(row),
            Self::Family(..) => row,
        }
    }

    /// The row as parts, all that it may have.
    fn of(self, row: Row) -> Vec<[f64; 4]> {
        match self {
            Self::Lobes(..) => self.filled(row).to_parts(),
            Self::OneWidth(_) => self.filled(row).to_parts_of_one_width(),
            Self::Family(family, _) => family.to_parts(&row),
        }
    }

    /// The row of parts, those that a tile has.
    fn read(self, parts: &[[f64; 4]]) -> Row {
        match self {
            Self::Lobes(_, has_base) | Self::OneWidth(has_base) => Row::of_parts(parts, has_base),
            Self::Family(family, tail) => family.of_parts(family.first_part(), parts, tail),
        }
    }
}

#[derive(Debug)]
struct LobesJob {
    fit: Arc<FitJob>,
    /// Most lobes, if a search decided them.
    most: Option<usize>,
    /// Number of the tile, over the varying factor or over the azimuth.
    tile: usize,
    /// Cosine of the view, and part.
    axes: [Axis; 2],
    format: TexelFormat,
}

impl Job for LobesJob {
    fn kind(&self) -> JobKind {
        JobKind::tile(TableKind::Lobes)
    }

    fn revision(&self) -> u32 {
        if is_family(self.fit.varying) { 9 } else { 6 }
    }

    fn inputs(&self) -> Value {
        json!({
            "fit": self.fit.key().to_string(),
            "most": self.most,
            "tile": self.tile,
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
            "format": self.format.name(),
        })
    }

    fn dependencies(&self) -> Vec<Arc<dyn Job>> {
        vec![self.fit.clone()]
    }

    fn run(&self, inputs: &Inputs<'_>) -> Artefact {
        let [x, y] = &self.axes;
        let fits: &Fits = inputs.part(self.fit.as_ref());
        let varied = thinned(fits.of(self.most).shaped(is_of_one_width(y)), step(x.size));
        let (lobes, tile) = varied.tile(self.tile);
        let most = (y.max as usize + 1 - Row::parts(0)) / (Row::parts(1) - Row::parts(0));
        let layout = match varied.varying() {
            Some(Varying::Family(family)) => Parts::Family(family, 1.0 / varied.stored(0, 0).inverse_tails()[0]),
            _ if is_of_one_width(y) => Parts::OneWidth(y.min < 0.0),
            _ => Parts::Lobes(most.min(LOBES), y.min < 0.0),
        };
        // Parts of families begin with their own, where those of a base have a place before it.
        let first = match layout {
            Parts::Family(family, _) => (f64::from(family.first_part()) - y.min) as u32,
            Parts::Lobes(..) | Parts::OneWidth(_) => 0,
        };
        // Parts lie side by side. The first and the last node of each are repeated, so that filtering does not mix in a
        // neighbour.
        let mut truth = Image::zeros((x.size + 2) * y.size, 1, 4);
        for i in 0..x.size + 2 {
            let row = varied.stored(self.tile, (i.max(1) - 1).min(x.size - 1) as usize);
            let mut parts = layout.of(row);
            if let (Some(Varying::Patina(_)), Some([.., free])) = (varied.varying(), parts.last_mut()) {
                *free = varied.bare_facets(self.tile, (i.max(1) - 1).min(x.size - 1) as usize);
            }
            for (j, part) in (first..y.size).zip(parts) {
                truth.texel_mut(j * (x.size + 2) + i, 0).copy_from_slice(&part.map(|value| value as f32));
            }
        }
        let atlas = lone_tile(TableKind::Lobes, &[x, y], self.format, &truth);
        let scan = Scan::whole([x.intervals(), 0], [PER_CELL, 0]);
        let energies = layout.filled(lobes.row_of(tile, 0.0)).energies().len();
        let errors = (0..energies).map(|part| {
            measure_scan(
                &scan,
                |u| {
                    let c = x.decode(u[0]);
                    let parts =
                        (first..y.size).map(|j| atlas.sample(0, [c, y.min + f64::from(j)], WeightBits::Fixed(8)));
                    let read = layout.read(&parts.collect::<Vec<_>>());
                    // Without what the tile has no part for.
                    let mut truth = layout.of(lobes.row_of(tile, c));
                    truth.truncate((y.size - first) as usize);
                    let [expected, sampled] = [layout.read(&truth), read].map(|row| {
                        let [r, g, b] = row.energies()[part];
                        [r, g, b, 0.0]
                    });
                    Comparison { expected, sampled }
                },
                |u| vec![x.decode(u[0]), part as f64],
            )
        });
        let error = errors.reduce(ErrorStats::with_worst_of).unwrap_or_else(|| unreachable!("a row has energies"));
        let over = if lobes.axis.critical().cot_sq > 0.0 { ", rows close together at its critical angle" } else { "" };
        let azimuth = lobes.frame.axes.map(|axes: Axes| {
            let [cos, sin] = axes.azimuth(tile as f64);
            format!(
                " seen {:.1} degrees from the axis of its lowest anisotropic surface",
                libm::atan2(sin, cos).to_degrees()
            )
        });
        let factors = varied.varying().map(|varying: Varying| match (varying, varying.factor(self.tile as f64)) {
            (Varying::Patina(_), amount) if amount > 1.0 => {
                " with all layers, and none of the light of its patina".to_owned()
            }
            (Varying::Family(family), _) => {
                let [coat, base] = family.alphas(self.tile);
                let of_coat = if family.is_coated() { format!("{coat:.4} of the coat and ") } else { String::new() };
                format!(" at slope parameters {of_coat}{base:.4} of the base")
            }
            (_, factor) => format!(" with {factor:.4} of its {}", factor_name(varying)),
        });
        let here = factors.or(azimuth).unwrap_or_default();
        let model = format!(
            "{} fitted to the simulated stack{here}, in half vectors of a medium of index {:.3}{over}; {}; errors are those of energies \
             against the rows before they were rounded",
            ["no lobe", "one lobe", "two lobes"][lobes.rows[0].lobes.len().min(LOBES)],
            lobes.frame.index,
            color_in_words(&self.fit.color)
        );
        Artefact::new(TileData { model, truth, size: atlas.texels.size(), bytes: atlas.bytes, error })
    }
}
