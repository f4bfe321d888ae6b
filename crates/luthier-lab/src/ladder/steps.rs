//! Forms of lobes that a material takes under limits, with their errors and costs.

use luthier::{Bake, MemoryStore, Options, outline};
use luthier_cost::{DeviceCost, Style, shader_text};
use luthier_lut::TableKind;
use luthier_manifest::{Budget, FunctionGroup, LobesForm, LobesRecord, Manifest, PlaceValues, ShadingModel};
use luthier_material::Material;
use luthier_report::{Reference, Rows, Shown, Weights};
use luthier_shader::{Form, MaterialSet, StaticCounts, count};
use luthier_terminal::{Failure, Outcome};

use crate::lobes::{QUANTITIES, largest};
use crate::parity::subject;

/// Lights on a prepared view.
pub(super) const LIGHTS: [u32; 3] = [1, 4, 16];

/// Costs of a light, by number of lights.
pub(super) type Costs = [f64; LIGHTS.len()];

/// The limit on the error of the albedo, over that on the lobe error.
const OF_ALBEDO: f64 = 0.4;

/// Limits of which every form holds each.
const ANY: f64 = 1e9;

/// A question to a bake.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Ask {
    /// Nothing: no limit.
    Default,
    /// The tightest limit that a form holds, whatever it costs.
    Least,
    /// The lowest cost within a limit on the lobe error, or that of [`Self::Least`] where no form holds it.
    Limit(f64),
}

impl Ask {
    pub(super) const ALL: [Self; 6] =
        [Self::Default, Self::Least, Self::Limit(0.02), Self::Limit(0.03), Self::Limit(0.05), Self::Limit(0.1)];

    pub(super) fn words(self) -> String {
        match self {
            Self::Default => "none".to_owned(),
            Self::Least => "least error".to_owned(),
            Self::Limit(limit) => limit.to_string(),
        }
    }
}

/// Forms of rows in the order of the page: those over the view alone, and any over something beside it.
pub(super) const FORMS: [Option<LobesForm>; LobesForm::ALL.len() + 1] = [
    Some(LobesForm::NoLobe),
    Some(LobesForm::ShortLobe),
    Some(LobesForm::OneWidth),
    Some(LobesForm::OneLobe),
    Some(LobesForm::TwoLobes),
    Some(LobesForm::ThreeLobes),
    None,
];

/// A form of [`FORMS`] in words.
pub(super) const fn words(form: Option<LobesForm>) -> &'static str {
    match form {
        Some(form) => form.words(),
        None => "rows over more than the view",
    }
}

/// Form, errors and costs of a material as a bake was asked for it.
#[derive(Debug, Clone)]
pub(super) struct Taken {
    /// One of [`FORMS`].
    pub(super) form: Option<LobesForm>,
    /// Whether it is within the limit.
    pub(super) holds: bool,
    /// Lobe error and albedo error as the bake states them.
    pub(super) stated: [f64; QUANTITIES],
    /// Errors of the tables as they ship, by a reference, if there is one.
    pub(super) judged: [f64; QUANTITIES],
    pub(super) costs: Costs,
    record: LobesRecord,
    rows: u32,
}

/// Forms that a material takes, one for each of [`Ask::ALL`]; `None` where it has no rows. Fits are made once for all limits.
pub(super) fn steps(
    material: &Material,
    reference: Option<&Reference>,
    device: &DeviceCost,
) -> Outcome<Option<Vec<Taken>>> {
    let mut material = material.clone();
    material.shade_by(ShadingModel::Lobes);
    let store = MemoryStore::default();
    let of = |budget| outline(std::slice::from_ref(&material), &with(budget), &store);
    let limited = |limit| {
        let albedo = Some(OF_ALBEDO * limit);
        Budget { max_lobe_err: Some(limit), max_albedo_err: albedo, ..Budget::default() }
    };
    let all = of(limited(ANY))?;
    let found = all.searches.iter().filter(|search| search.kind == TableKind::Lobes).flat_map(|search| &search.front);
    let limits = found.filter_map(|candidate| Some(candidate.error.lobe?.max(candidate.error.albedo? / OF_ALBEDO)));
    let Some(least) = limits.reduce(f64::min) else { return Ok(None) };
    // A product of a quotient may be a last bit off.
    let least = limited(least * (1.0 + 1e-9));
    let mut taken: Vec<Taken> = Vec::new();
    for ask in Ask::ALL {
        let (budget, holds) = match ask {
            Ask::Default => (Budget::default(), true),
            Ask::Least => (least, true),
            Ask::Limit(limit) => {
                let budget = limited(limit);
                if of(budget).is_ok() { (budget, true) } else { (least, false) }
            }
        };
        let Some(mut here) = form(&of(budget)?, device)? else { return Ok(None) };
        here.holds = holds;
        if let Some(reference) = reference {
            let known = taken.iter().find(|other| (other.record, other.rows) == (here.record, here.rows));
            here.judged = match known {
                Some(known) => known.judged,
                None => shipped(&material, budget, &store, reference)?,
            };
        }
        taken.push(here);
    }
    Ok(Some(taken))
}

fn with(budget: Budget) -> Options<'static> {
    Options { budget, ..Options::default() }
}

/// The form of the one material of an outline.
fn form(outlined: &Manifest, device: &DeviceCost) -> Outcome<Option<Taken>> {
    let record = outlined.materials[0].constants.lobes;
    let Some((record, error)) = record.and_then(|lobes| Some((lobes, lobes.error?))) else { return Ok(None) };
    let tables = outlined.tables.iter();
    let rows = tables.filter(|table| table.kind == TableKind::Lobes).map(|table| table.layout.x.size).sum();
    Ok(Some(Taken {
        form: LobesForm::of(&record).filter(|_| record.axes.is_none()),
        holds: true,
        stated: [error.lobe, error.albedo],
        judged: [0.0; QUANTITIES],
        costs: of_manifest(outlined, device)?,
        record,
        rows,
    }))
}

/// Largest errors of the tables that ship, read as a shader reads them, under a reference of the stack.
fn shipped(
    material: &Material,
    budget: Budget,
    store: &MemoryStore,
    reference: &Reference,
) -> Outcome<[f64; QUANTITIES]> {
    let bake = Bake { options: with(budget), refuses: false, ..Bake::wgsl(&[Form::Baked]) };
    let package = bake.package(std::slice::from_ref(material), store)?;
    let subject = subject(&package, vec![material.reflecting_stack().into_owned()])?;
    let rows = Rows::new(&subject, 0, &PlaceValues::NONE, Weights::EightBit).map_err(Failure::input)?;
    Ok(largest(&reference.errors(Shown::Values(&|wi, wo| rows.eval(wi, wo)))))
}

/// Costs of a material by another model.
pub(super) fn by(model: ShadingModel, material: &Material, device: &DeviceCost) -> Outcome<Costs> {
    let mut material = material.clone();
    material.shade_by(model);
    let outlined = outline(std::slice::from_ref(&material), &Options::default(), &MemoryStore::default())?;
    of_manifest(&outlined, device)
}

fn of_manifest(outlined: &Manifest, device: &DeviceCost) -> Outcome<Costs> {
    let mut set = MaterialSet::from_manifest(outlined);
    set.functions = [FunctionGroup::Light].into_iter().collect();
    let style = Style { form: Form::Baked, constant: false, approximate: false };
    let text = shader_text(&set, style).map_err(Failure::input)?;
    costs(device, |lights| count(&text, &set.wide_textures(), lights))
}

/// Costs of a light, by number of lights.
pub(super) fn costs<E: std::error::Error + Send + Sync + 'static>(
    device: &DeviceCost,
    counts: impl Fn(u32) -> Result<StaticCounts, E>,
) -> Outcome<Costs> {
    let mut costs = Costs::default();
    for (cost, lights) in costs.iter_mut().zip(LIGHTS) {
        *cost = device.cost(&counts(lights).map_err(Failure::input)?) / f64::from(lights);
    }
    Ok(costs)
}
