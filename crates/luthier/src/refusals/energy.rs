//! Doubts about energy: a model that returns more light than falls in, or an albedo that differs from a simulation of the layers.
//!
//! Both are measured here, in f64, with the numbers of the file, as at white texels of its maps. Albedos of a model are sums over directions; albedos
//! of the simulation ([`ColorPaths`]) are means over paths. Three wavelengths stand for the colour. Effects are left out. A material takes some
//! hundredths of a second, one with energies of rough interfaces some tenths. `lobes` is not measured, because it is fitted to the simulation. Bakes keep
//! what they found in their store.

use luthier_bake::{Function, MemoryStore, Store, kept};
use luthier_layers::directional_albedo::integral;
use luthier_layers::effects::layer_sample::LayerSample;
use luthier_layers::glam::DVec3;
use luthier_layers::models::lobes::Mix;
use luthier_layers::references::layered_mc::ColorPaths;
use luthier_layers::twins::shaded::{Growth, Place, Shaded, Side, index_of_engine};
use luthier_manifest::ShadingModel;
use luthier_material::{Diagnostic, Material, Metallic, Severity};
use luthier_model::Family;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::schlick::DIELECTRIC_INDEX;
use luthier_optics::stack::{Base, Layer, Stack};

use super::parts::parts_of;

/// Returned share of the light above which there is a warning. Sums and interpolated tables are not precise enough for a limit of 1.
const ALL: f64 = 1.02;

/// Largest difference of albedo from the simulation that causes no warning, for one interface whose model the file names.
const TOLERATED: f64 = 0.1;

/// Angles of the eye from the normal, degrees. Models gain the most between them.
const ANGLES_DEG: [f64; 5] = [0.0, 30.0, 50.0, 70.0, 80.0];

/// Points on either side of the mirror direction, in the angle from the normal and in azimuth: sums over lobes of all widths are within 0.003.
const POINTS: usize = 24;

/// Paths of the simulation for each angle: albedos within 0.01.
const PATHS: u64 = 4096;

/// Family of random numbers of the simulation.
const SEED: u64 = 37;

/// Albedos of a material at one angle, in the channel in which they differ the most.
///
/// ```
/// use luthier::{ShadingModel, refusals};
/// # let text = "schema = 1\nname = \"coat\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.3\n";
///
/// let coat = luthier::parse("coat.toml", text)?;
/// for at in refusals::returned(&coat, ShadingModel::WeidlichWilkie) {
///     assert!(at.simulated.is_some_and(|simulated| simulated < 1.0), "at {} degrees", at.angle_deg);
/// }
/// # Ok::<(), luthier::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Returned {
    /// Share of the light that the model returns.
    pub model: f64,
    /// Share that the simulation returns; `None` where it has no such facets.
    pub simulated: Option<f64>,
    /// Angle of the eye from the normal, degrees.
    pub angle_deg: f64,
}

impl Returned {
    fn error(&self) -> f64 {
        self.simulated.map_or(0.0, |simulated| (self.model - simulated).abs())
    }

    /// The error, or what the model returns beyond all light, whichever is larger.
    fn excess(&self) -> f64 {
        self.error().max(self.model - ALL)
    }

    /// The simulation's albedo as the end of a sentence.
    fn against(&self) -> String {
        match self.simulated {
            Some(simulated) => format!(" where a simulation of the layers returns {simulated:.2}"),
            None => String::new(),
        }
    }
}

/// A warning if a model returns more light than falls in, or if its albedo is wrong. For one interface with a named model, an error above a tenth
/// counts; for a model that stands in for `lobes`, any error. `asked` is the model of the command line.
///
/// ```
/// use luthier::{ShadingModel, refusals};
/// # let text = "schema = 1\nname = \"coat\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.3\n";
///
/// // A closed form lacks 1/n^2 below a coat, and gold is bright.
/// let coat = luthier::parse("coat.toml", text)?;
/// assert!(refusals::of_energy(&coat, Some(ShadingModel::WeidlichWilkie)).is_some());
/// assert!(refusals::of_energy(&coat, None).is_none(), "`lobes` is fitted to a simulation");
/// # Ok::<(), luthier::Error>(())
/// ```
pub fn of_energy(material: &Material, asked: Option<ShadingModel>) -> Option<Diagnostic> {
    of_kept_energy(material, asked, &MemoryStore::default())
}

/// [`of_energy`] with the albedos that a store has.
pub(crate) fn of_kept_energy(
    material: &Material,
    asked: Option<ShadingModel>,
    store: &dyn Store,
) -> Option<Diagnostic> {
    let model = asked.unwrap_or_else(|| material.model());
    if !is_questionable(material, model) {
        return None;
    }
    let stands_in = asked.is_none() && !material.unfit_for_lobes().is_empty();
    // Named models of stacks are known to be inexact (`docs/pages/models.md`), so they are simulated only for the words of a warning.
    let is_compared = stands_in || material.stack.layers.len() == 1;
    let gains = !is_compared && kept_albedos(material, model, false, store).iter().any(|found| found.model > ALL);
    if !is_compared && !gains {
        return None;
    }
    let all = kept_albedos(material, model, true, store);
    let most = all.iter().copied().max_by(|a, b| a.model.total_cmp(&b.model))?;
    let worst = all.iter().copied().max_by(|a, b| a.error().total_cmp(&b.error()))?;
    let name = model.name();
    let message = if most.model > ALL {
        format!(
            "the model `{name}` returns {:.2} times the light that falls in, seen at {} degrees,{}",
            most.model,
            most.angle_deg,
            most.against()
        )
    } else if worst.error() > TOLERATED || stands_in {
        format!(
            "the albedo of the model `{name}` is off by {:.2}: it returns {:.2} of the light, seen at {} degrees,{}",
            worst.error(),
            worst.model,
            worst.angle_deg,
            worst.against()
        )
    } else {
        return None;
    };
    let message = message.trim_end_matches(',').to_owned();
    let hint = match material.bake.model.or(asked) {
        Some(_) if material.is_whole_in(ShadingModel::Lobes) => {
            "the model `lobes` returns what the simulation does: leave the model out".to_owned()
        }
        _ => "`lobes` would return what the simulation does, but does not show all that the file asks for".to_owned(),
    };
    let key = if material.places.has("bake.model") { "bake.model" } else { "layer.0.type" };
    Some(material.diagnostic(Severity::Warning, key, message, Some(hint)))
}

/// True where albedos of a model can be wrong. `lobes` is fitted to a simulation, and one bounce off a smooth interface or a base is exact.
fn is_questionable(material: &Material, model: ShadingModel) -> bool {
    !model.is_fitted() && (material.has_further_bounces() || model.facts().family == Family::Coefficients)
}

/// Albedos of a material in a model, angle by angle, at white texels of its maps. Where a texture decides what is metal, places without metal are
/// measured, too.
///
/// ```
/// use luthier::{ShadingModel, refusals};
/// # let text = "schema = 1\nname = \"coat\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.3\n";
///
/// let coat = luthier::parse("coat.toml", text)?;
/// let angles: Vec<f64> = refusals::returned(&coat, ShadingModel::Elek).iter().map(|at| at.angle_deg).collect();
/// assert_eq!(angles, [0.0, 30.0, 50.0, 70.0, 80.0]);
/// # Ok::<(), luthier::Error>(())
/// ```
pub fn returned(material: &Material, model: ShadingModel) -> Vec<Returned> {
    albedos(material, model, true)
}

/// Albedos in stores: of the model, of the simulation, and at which angle.
const ALBEDOS: Function = Function { kind: "energy", revision: 1 };

/// [`albedos`], which a store keeps by all that they hang on.
fn kept_albedos(material: &Material, model: ShadingModel, is_compared: bool, store: &dyn Store) -> Vec<Returned> {
    let places = [index_of_engine(model), DIELECTRIC_INDEX].map(|index| places(material, model, index));
    let stacks = (&material.stack, material.stack_of(model));
    let simulation = is_compared.then_some((PATHS, SEED, POINTS));
    let nm = material.bake.wavelengths_nm();
    let inputs = format!("{:?}", (model, stacks, nm, places, parts_of(material, model), ANGLES_DEG, simulation));
    let found = kept(ALBEDOS, &inputs.into(), store, || {
        let found = albedos(material, model, is_compared).into_iter();
        found.map(|Returned { model, simulated, angle_deg }| (model, simulated, angle_deg)).collect::<Vec<_>>()
    });
    found.into_iter().map(|(model, simulated, angle_deg)| Returned { model, simulated, angle_deg }).collect()
}

/// Albedos as [`returned`] has them, with or without the simulation.
fn albedos(material: &Material, model: ShadingModel, is_compared: bool) -> Vec<Returned> {
    let is_simulated = is_compared && material.stack.layers.iter().all(has_walks);
    let nm = material.bake.wavelengths_nm();
    let color = Color::ThreeWavelengths(nm);
    let reflecting = material.stack_of(model);
    let mut all = Vec::new();
    let as_simulated = places(material, model, DIELECTRIC_INDEX);
    for (place, truth) in places(material, model, index_of_engine(model)).into_iter().zip(as_simulated) {
        let stack = at(&material.stack, &truth);
        let ends = match place.patina {
            Some(coat) => {
                vec![(coat.amount, stack.clone()), (1.0 - coat.amount, place.side.unwrap_or(Side::Coat).bare(&stack))]
            }
            None => vec![(1.0, stack)],
        };
        let paths = is_simulated
            .then(|| ends.iter().map(|(share, stack)| (*share, ColorPaths::new(stack, &color))).collect::<Vec<_>>());
        let Some(shaded) = Shaded::with(model, &reflecting, nm, color, &place, parts_of(material, model)) else {
            continue;
        };
        for angle_deg in ANGLES_DEG {
            let (sin, cos) = libm::sincos(angle_deg.to_radians());
            let wo = DVec3::new(sin, 0.0, cos);
            let own = integral(&|wi: DVec3| shaded.eval(wi, wo), DVec3::new(-sin, 0.0, cos), POINTS);
            let simulated = paths.as_ref().map(|paths| simulated(paths, wo));
            let channels =
                [0, 1, 2].map(|c| Returned { model: own[c], simulated: simulated.map(|all| all[c]), angle_deg });
            all.extend(channels.into_iter().max_by(|a, b| a.excess().total_cmp(&b.excess())));
        }
    }
    all
}

/// True where the simulation has the facets of a layer, or needs none.
fn has_walks(layer: &Layer) -> bool {
    matches!(layer.base, Base::Diffuse(_)) || layer.surface.distribution.has_walks()
}

/// Mean albedo of paths on stacks, each of which has a share of the surface.
fn simulated(ends: &[(f64, ColorPaths)], wo: DVec3) -> Rgb {
    let mut sum = [0.0; 3];
    for (share, paths) in ends {
        paths.trace(SEED, PATHS, wo, |path| (0..3).for_each(|c| sum[c] += share * path.weight[c] / PATHS as f64));
    }
    sum
}

/// Places of a material where its albedos are compared.
fn places(material: &Material, model: ShadingModel, index: f64) -> Vec<Place> {
    let textured = material.layers.iter().enumerate().find_map(|(number, layer)| Some((number, layer.metallic?)));
    // Where a coat has its greatest weight, no texel makes it less.
    let patina = material.weight().filter(|_| !material.weighs_film() || model.is_path()).map(Growth::of_coat);
    let side = material.weighs_film().then_some(Side::Film);
    let Some((number, Metallic { base_color, metallic, f82_tint: tint, dielectric, is_metal })) = textured else {
        return vec![Place { patina, side, ..Place::NONE }];
    };
    let shares = if is_metal {
        vec![1.0]
    } else if metallic > 0.0 {
        vec![metallic, 0.0]
    } else {
        vec![0.0]
    };
    let places = shares.into_iter().map(|metallic| {
        let mix = match material.brightening() {
            Some(below) => {
                let weight = material.weight().unwrap_or(1.0);
                Mix {
                    metal: below.metal(base_color, weight),
                    tint,
                    dielectric,
                    matt: below.matt(base_color, weight),
                    metallic,
                }
            }
            None => Mix { metal: base_color, tint, dielectric, matt: base_color, metallic },
        };
        let (curves, albedo) = mix.surface(index);
        let mut layers = vec![LayerSample::NONE; number + 1];
        layers[number].f0 = Some(curves);
        Place { patina, side, base_color: Some(albedo), layers, metal: Some(mix), ..Place::NONE }
    });
    places.collect()
}

/// The stack at such a place.
fn at(stack: &Stack, place: &Place) -> Stack {
    let mut here = stack.clone();
    let metal = place.layers.last().and_then(|sample| sample.f0).filter(|_| place.base_color == Some([0.0; 3]));
    if let Some(curves) = metal {
        // Metal is opaque, as in a file without maps.
        here.layers.truncate(place.layers.len());
        if let Some(layer) = here.layers.last_mut() {
            layer.base = Base::Conductor { ior: Ior::vacuum().with_f82(curves) };
        }
        return here;
    }
    for (layer, sample) in here.layers.iter_mut().zip(&place.layers) {
        if let (Base::Dielectric { ior, .. }, Some(curves)) = (&mut layer.base, sample.f0) {
            *ior = ior.clone().with_f82(curves);
        }
    }
    if let (Some(Base::Diffuse(base)), Some(color)) = (here.layers.last_mut().map(|l| &mut l.base), place.base_color) {
        base.albedo = color;
    }
    here
}
