//! Evaluation of a model of a material at one place.

use std::sync::Arc;

use luthier::function::{self, Color, Draws, Inputs, Kind, LiveValue, Refusal, Subject};
use luthier_layers::angles::Angles;
use luthier_layers::frame::each_pair;
use luthier_layers::glam::{DVec2, DVec3};
use luthier_layers::model::{Estimate, Model};
use luthier_layers::registry;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::arrays;
use crate::fault::{unknown, value};
use crate::interrupt::{self, Interrupt};
use crate::material::Material;
use crate::store::store;

/// Pairs that a thread evaluates at a time: few enough that an interrupt is soon noticed where one takes a millisecond.
const CHUNK: usize = 512;

/// Most values that are computed without asking for signals: a thread of their own takes longer than so few.
const FEW: usize = 4096;

/// A model of a material at one place, ready to be evaluated.
#[pyclass(frozen, module = "luthier._luthier")]
pub(crate) struct Function {
    function: Arc<function::Function>,
    draws: Draws,
    columns: usize,
}

/// Values that textures and effects have at the place, in Python's names.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct At {
    uv: Option<[f64; 2]>,
    distance: Option<f64>,
    normal: Option<[f64; 3]>,
    effects: bool,
    alpha_factor: Option<f64>,
    slab_factor: Option<f64>,
    film_factor: Option<f64>,
    slope_variance: Option<f64>,
    live: Vec<(usize, String, Vec<f64>)>,
    samples: Option<u64>,
    seed: Option<u64>,
}

impl At {
    fn inputs(self) -> PyResult<Inputs> {
        let factors = [self.alpha_factor, self.slab_factor, self.film_factor, self.slope_variance, self.distance];
        if factors.iter().flatten().any(|factor| !(factor.is_finite() && *factor >= 0.0)) {
            return Err(value("factors, variances and distances are finite and at least 0"));
        }
        if self.samples == Some(0) {
            return Err(value("samples: at least 1"));
        }
        let live = self.live.into_iter().map(|(layer, name, values)| LiveValue { layer, name, values });
        Ok(Inputs {
            uv: self.uv.map(DVec2::from),
            distance: self.distance,
            normal: self.normal.map(unit).transpose()?,
            no_effects: !self.effects,
            alpha_factor: self.alpha_factor,
            slab_factor: self.slab_factor,
            film_factor: self.film_factor,
            slope_variance: self.slope_variance,
            live: live.collect(),
            samples: self.samples,
            seed: self.seed,
            ..Inputs::default()
        })
    }
}

fn unit(normal: [f64; 3]) -> PyResult<DVec3> {
    let normal = DVec3::from(normal).try_normalize().filter(|normal| normal.z > 0.0);
    normal.ok_or_else(|| value("normal: expected a direction above the surface"))
}

/// The model of a name.
fn model(name: &str) -> PyResult<Box<dyn Model>> {
    registry::model(name).ok_or_else(|| {
        let names: Vec<&str> = registry::models().iter().map(|model| model.info().name).collect();
        unknown("model", name, &names)
    })
}

/// A model of a material at a place.
#[pyfunction]
#[pyo3(signature = (material, model_name, color, wavelength_nm, at))]
pub(crate) fn prepare(
    py: Python<'_>,
    material: PyRef<'_, Material>,
    model_name: &str,
    color: &str,
    wavelength_nm: Option<f64>,
    at: At,
) -> PyResult<Function> {
    let (model, inputs) = (model(model_name)?, at.inputs()?);
    let label = &material.source.label;
    let material = material.material.clone();
    let kind = match (wavelength_nm, color) {
        (Some(nm), _) if (1.0..1e5).contains(&nm) => Kind::Wavelength(nm),
        (Some(nm), _) => return Err(value(format!("wavelength_nm: {nm} is no wavelength of light"))),
        (None, "material") => Kind::Color(material.color()),
        (None, "spectral") => Kind::Color(Color::Spectral),
        (None, "three-wavelengths") => Kind::Color(Color::ThreeWavelengths(material.bake.wavelengths_nm())),
        (None, other) => return Err(unknown("color", other, &["material", "spectral", "three-wavelengths"])),
    };
    let (shown, _) = inputs.shown(&material, model.as_ref());
    let (maps, _) = inputs.layer_maps(&material, model.as_ref());
    let has_maps = !maps.is_empty() || inputs.weight_map(&material).is_some();
    if let Some(input) = inputs.not_taken(model.as_ref(), &shown, has_maps, false) {
        return Err(value(format!("model `{model_name}` takes no `{}` for {}", input.name(), label)));
    }
    let made = interrupt::at_once(py, move |_| {
        let subject = Subject::new(model, material, None, function::fits(store()), &inputs, None)?;
        let subject = Arc::new(subject);
        let draws = Draws::new(&subject);
        let function = Arc::new(function::Function::new(&subject, &kind));
        let columns = function.columns();
        Ok(Function { function, draws, columns })
    });
    made?.map_err(|refusal: Refusal| value(refusal))
}

/// Directions, weights and densities.
type Drawn<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<f64>>);

/// Values, and errors beside them.
type Estimates<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>);

#[pymethods]
impl Function {
    /// Values per pair: 3 of a colour, 1 at a wavelength.
    #[getter]
    fn columns(&self) -> usize {
        self.columns
    }

    /// Values of (n, 3) and (m, 3) directions, where n is m or either is 1.
    fn eval<'py>(
        &self,
        py: Python<'py>,
        wi: PyReadonlyArray2<'_, f64>,
        wo: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (wi, wo) = (arrays::directions(&wi, "wi")?, arrays::directions(&wo, "wo")?);
        let count = arrays::pairs(wi.len(), wo.len())?;
        // A single value of a model that is an estimate may take a second.
        let at_a_time = if self.function.is_estimate() { 1 } else { CHUNK };
        let values = self.in_parts(py, count, |interrupt| {
            let mut values = vec![0.0; count * self.columns];
            let rows = values.par_chunks_mut(at_a_time * self.columns).enumerate();
            rows.filter(|_| !interrupt.is_raised()).for_each(|(chunk, rows)| {
                let part = |list| part(list, chunk * at_a_time, rows.len() / self.columns);
                let (wi, wo) = (part(wi), part(wo));
                self.function.eval_pairs(wi, wo, rows);
                spoil(wi, wo, rows, self.columns);
            });
            values
        })?;
        arrays::rows(py, self.columns, values)
    }

    /// Values with the standard errors of models that are estimates.
    fn estimate<'py>(
        &self,
        py: Python<'py>,
        wi: PyReadonlyArray2<'_, f64>,
        wo: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Estimates<'py>> {
        let (wi, wo) = (arrays::directions(&wi, "wi")?, arrays::directions(&wo, "wo")?);
        let count = arrays::pairs(wi.len(), wo.len())?;
        let found = self.in_parts(py, count, |interrupt| {
            let pairs: Vec<[DVec3; 2]> = each_pair(wi, wo).collect();
            let rows = pairs.par_iter().map(|&[wi, wo]| match wi.is_nan() || wo.is_nan() || interrupt.is_raised() {
                true => vec![Estimate::exact(f64::NAN); self.columns],
                false => self.function.values(wi, wo),
            });
            rows.collect::<Vec<_>>()
        })?;
        let means = found.iter().flatten().map(|one| one.mean).collect();
        let errors = found.iter().flatten().map(|one| one.std_err).collect();
        Ok((arrays::rows(py, self.columns, means)?, arrays::rows(py, self.columns, errors)?))
    }

    /// Directional albedos seen from (n, 3) directions, and how far each may be off.
    fn albedo<'py>(&self, py: Python<'py>, wo: PyReadonlyArray2<'_, f64>) -> PyResult<Estimates<'py>> {
        let wo = arrays::directions(&wo, "wo")?.to_vec();
        let (function, columns) = (Arc::clone(&self.function), self.columns);
        let found: Vec<(Vec<f64>, Vec<f64>)> = interrupt::at_once(py, move |interrupt| {
            let rows = wo.par_iter().map(|&wo| {
                if wo.iter().any(|x| x.is_nan()) || interrupt.is_raised() {
                    return (vec![f64::NAN; columns], vec![f64::NAN; columns]);
                }
                let albedo = function.albedo(DVec3::from(wo));
                let errors = albedo.values.iter().map(|one| one.std_err).collect();
                (albedo.values.iter().map(|one| one.mean).collect(), albedo.changes.unwrap_or(errors))
            });
            rows.collect()
        })?;
        let (means, errors): (Vec<_>, Vec<_>) = found.into_iter().unzip();
        Ok((arrays::rows(py, self.columns, means.concat())?, arrays::rows(py, self.columns, errors.concat())?))
    }

    /// Directions of light for (n, 3) directions of the eye and (n, 3) numbers in 0..1, with weights and densities; zeros below the horizon.
    fn sample<'py>(
        &self,
        py: Python<'py>,
        wo: PyReadonlyArray2<'_, f64>,
        u: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Drawn<'py>> {
        let (wo, u) = (arrays::directions(&wo, "wo")?, arrays::triples(&u, "u")?);
        let count = arrays::pairs(wo.len(), u.len())?;
        if let Some(row) = u.iter().position(|u| u.iter().any(|u| !(0.0..1.0).contains(u))) {
            return Err(value(format!("u: row {row} is {:?}, and numbers are from 0 up to 1", u[row])));
        }
        let drawn: Vec<([f64; 3], Vec<f64>, f64)> = self.in_parts(py, count, |interrupt| {
            let rows = (0..count).into_par_iter().map(|k| {
                let wo = DVec3::from(wo[if wo.len() == 1 { 0 } else { k }]);
                let u = u[if u.len() == 1 { 0 } else { k }];
                if wo.is_nan() || interrupt.is_raised() {
                    return ([f64::NAN; 3], vec![f64::NAN; self.columns], f64::NAN);
                }
                let Some((wi, pdf)) = self.draws.sample(wo, u) else {
                    return ([0.0; 3], vec![0.0; self.columns], 0.0);
                };
                let weight = self.function.values(wi, wo).iter().map(|one| one.mean / pdf).collect();
                (wi.to_array(), weight, pdf)
            });
            rows.collect()
        })?;
        let directions = drawn.iter().flat_map(|(wi, ..)| *wi).collect();
        let weights = drawn.iter().flat_map(|(_, weight, _)| weight.iter().copied()).collect();
        let densities = drawn.iter().map(|(.., pdf)| *pdf).collect();
        Ok((
            arrays::rows(py, 3, directions)?,
            arrays::rows(py, self.columns, weights)?,
            PyArray1::from_vec(py, densities),
        ))
    }

    /// Densities in solid angle with which `sample` draws directions of light.
    fn pdf<'py>(
        &self,
        py: Python<'py>,
        wi: PyReadonlyArray2<'_, f64>,
        wo: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (wi, wo) = (arrays::directions(&wi, "wi")?, arrays::directions(&wo, "wo")?);
        let count = arrays::pairs(wi.len(), wo.len())?;
        let densities: Vec<f64> = self.in_parts(py, count, |interrupt| {
            let pairs: Vec<[DVec3; 2]> = each_pair(wi, wo).collect();
            let rows = pairs.par_iter().map(|&[wi, wo]| match wi.is_nan() || wo.is_nan() || interrupt.is_raised() {
                true => f64::NAN,
                false => self.draws.pdf_solid_angle(wi, wo),
            });
            rows.collect()
        })?;
        Ok(PyArray1::from_vec(py, densities))
    }
}

impl Function {
    /// The result of work on a number of values, without the interpreter's lock.
    fn in_parts<T: Send>(
        &self,
        py: Python<'_>,
        count: usize,
        work: impl FnOnce(&Interrupt) -> T + Send,
    ) -> PyResult<T> {
        if count <= FEW && !self.function.is_estimate() {
            return Ok(py.detach(|| work(&Interrupt::default())));
        }
        interrupt::in_parts(py, work)
    }
}

/// A part of a list; of a list with a single direction that.
fn part(list: &[[f64; 3]], start: usize, count: usize) -> &[[f64; 3]] {
    if list.len() == 1 { list } else { &list[start..start + count] }
}

/// Makes values of directions that are no numbers no numbers.
fn spoil(wi: &[[f64; 3]], wo: &[[f64; 3]], rows: &mut [f64], columns: usize) {
    let has_nan = |list: &[[f64; 3]]| list.as_flattened().iter().any(|x| x.is_nan());
    if has_nan(wi) || has_nan(wo) {
        for ([wi, wo], row) in each_pair(wi, wo).zip(rows.chunks_exact_mut(columns)) {
            if wi.is_nan() || wo.is_nan() {
                row.fill(f64::NAN);
            }
        }
    }
}

/// Unit directions of angles in degrees, bit by bit those of the command.
#[pyfunction]
pub(crate) fn directions<'py>(
    py: Python<'py>,
    theta_deg: PyReadonlyArray1<'_, f64>,
    phi_deg: PyReadonlyArray1<'_, f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let (theta, phi) = (theta_deg.as_array(), phi_deg.as_array());
    let angles = theta.iter().zip(phi).map(|(&theta_deg, &phi_deg)| Angles { theta_deg, phi_deg });
    arrays::rows(py, 3, angles.flat_map(|angles| angles.direction().to_array()).collect())
}
