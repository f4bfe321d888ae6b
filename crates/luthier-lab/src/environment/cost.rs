//! Predicted costs of the steps.

use luthier::{MemoryStore, Options, outline};
use luthier_cost::{DeviceCost, Style, shader_text};
use luthier_manifest::{FunctionGroup, ShadingModel};
use luthier_material::Material;
use luthier_shader::{Form, MaterialSet, count};
use luthier_terminal::{Failure, Outcome};

use super::STEPS;

/// Device whose costs the page has.
pub(super) const DEVICE: &str = "h100";

/// The look-up in place of an evaluation. The frame is made of numbers that a surface would give.
const LOOKED_UP: &str = "
fn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    return luthier_environment(luthier_prepare(material, wo), mat3x3<f32>(wi.yzx, wi.zxy, wi), $turn);
}
";

/// Predicted picoseconds of a look-up, with the view that it prepares.
pub(super) struct Costs {
    pub(super) material: String,
    /// By step: with a turn, and for one sample.
    pub(super) steps: Vec<[f64; 2]>,
    /// By the first model of papers.
    pub(super) paper: f64,
    /// An evaluation of one light, for comparison.
    pub(super) light: f64,
}

impl Costs {
    pub(super) fn of(material: &Material) -> Outcome<Self> {
        let device =
            DeviceCost::shipped(DEVICE).ok_or_else(|| Failure::Usage(anyhow::anyhow!("no costs of {DEVICE}")))?;
        // Fits are made once.
        let store = MemoryStore::default();
        let cost = |model, functions, turn| cost(&device, &store, material, model, functions, turn);
        let steps = STEPS.map(|step| {
            let [turned, still] = ["wi.x", "0.0"].map(|turn| cost(ShadingModel::Lobes, step, Some(turn)));
            Ok([turned?, still?])
        });
        Ok(Self {
            material: material.name.clone(),
            steps: steps.into_iter().collect::<Outcome<_>>()?,
            paper: cost(super::PAPERS[0], STEPS[0], Some("0.0"))?,
            light: cost(ShadingModel::Lobes, STEPS[0], None)?,
        })
    }
}

/// The cost of a look-up with a turn, or of an evaluation.
fn cost(
    device: &DeviceCost,
    store: &MemoryStore,
    material: &Material,
    model: ShadingModel,
    functions: FunctionGroup,
    turn: Option<&str>,
) -> Outcome<f64> {
    let mut material = material.clone();
    material.shade_by(model);
    let outlined = outline(std::slice::from_ref(&material), &Options::default(), store)?;
    let mut set = MaterialSet::from_manifest(&outlined);
    set.functions = [functions].into_iter().collect();
    let style = Style { form: Form::Baked, constant: false, approximate: false };
    let mut text = shader_text(&set, style).map_err(Failure::input)?;
    if let Some(turn) = turn {
        text = text.replace("fn luthier_eval(", "fn luthier_eval_of_light(") + &LOOKED_UP.replace("$turn", turn);
    }
    let mut wide = set.wide_textures();
    wide.extend(["luthier_environment_map", "luthier_irradiance_map"].map(str::to_owned));
    Ok(device.cost(&count(&text, &wide, 1).map_err(Failure::input)?))
}

/// Bytes of both cubes with four half floats a texel.
pub(super) fn bytes(size: u32) -> u32 {
    let levels = (0..).map(|level| size >> level).take_while(|side| *side >= 4).map(|side| side * side).sum::<u32>();
    6 * 8 * (levels + 32 * 32)
}
