//! Kernels: a shader in a harness.

use luthier_manifest::BindingEntry;
use luthier_shader::{Form, MaterialSet, Target, bindings, emit, emit_constant, spirv_words};
use serde::{Deserialize, Serialize};

use crate::CostError;

/// Replaces a shader to measure the harness alone.
const EMPTY: &str =
    "fn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {\n    return wi * wo;\n}\n";

/// Replaces a shader in two steps.
const EMPTY_LIT: &str = "struct LuthierPrepared {\n    wo: vec3<f32>,\n}\nfn luthier_prepare(material: u32, wo: vec3<f32>) -> LuthierPrepared {\n    \
    return LuthierPrepared(wo);\n}\nfn luthier_light(prepared: LuthierPrepared, wi: vec3<f32>) -> vec3<f32> {\n    return wi * prepared.wo;\n}\n";

/// The bare harness with one view and so many lights, each of which differs from the first by an instruction per component.
fn lit(bare: &str, lights: u32) -> String {
    let mut each =
        "let prepared = luthier_prepare(harness_material.x, wo);\n    var value = luthier_light(prepared, wi);\n"
            .to_owned();
    for light in 1..lights {
        each.push_str(&format!(
            "    value += luthier_light(prepared, bitcast<vec3<f32>>(bitcast<vec3<u32>>(wi) ^ vec3<u32>({}u)));\n",
            light << 12
        ));
    }
    bare.replace("let value = luthier_eval(harness_material.x, wi, wo);\n", &each)
}

/// Schlick's form with the reflectance at normal incidence of a complex index (Elek 2010, `FresnelTermNP`). It replaces the exact equations.
const APPROXIMATE_FRESNEL: &str = include_str!("wgsl/approximate_fresnel.wgsl");

/// Code that surrounds the evaluation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Harness {
    /// No surroundings: two directions in, a value out.
    Bare,
    /// The surroundings in Elek's pixel shaders: a normal map and a reflected environment.
    NormalMapped,
    /// Two directions and more, no surroundings: a view that is prepared once, and so many lights on it, each from a direction of its own.
    Lights(u32),
}

/// Variant of the shader of a set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Style {
    /// Form of the shader.
    pub form: Form,
    /// The numbers of the one material are constants of the code.
    pub constant: bool,
    /// Fresnel reflectance of bare interfaces is approximated. Only the form `full` has such code.
    pub approximate: bool,
}

/// A compute kernel to compile, with its bindings.
///
/// ```
/// use luthier_cost::{Harness, Kernel};
///
/// // Elek's surroundings bind two textures and a sampler besides the two buffers of the bare harness.
/// let [bare, mapped] = [Harness::Bare, Harness::NormalMapped].map(|harness| Kernel::empty(harness).unwrap());
/// assert_eq!((bare.bindings.len(), mapped.bindings.len()), (2, 5));
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Kernel {
    /// SPIR-V words; one entry point.
    pub spirv: Vec<u32>,
    /// All resources that the kernel may use.
    pub bindings: Vec<Binding>,
}

/// One binding of a kernel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Binding {
    /// Descriptor set.
    pub group: u32,
    /// Number in it.
    pub binding: u32,
    /// Resource that is bound.
    pub resource: Resource,
}

/// Resource that a kernel may bind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Resource {
    /// A sampled image.
    Texture,
    /// A sampler.
    Sampler,
    /// A storage buffer.
    Storage,
    /// A uniform buffer.
    Uniform,
}

impl Kernel {
    /// The shader of a set, evaluated in a harness. The material's number comes from a uniform buffer, as in a draw call.
    ///
    /// # Errors
    /// Those of [`emit`] and [`emit_constant`].
    pub fn of_set(set: &MaterialSet<'_>, style: Style, harness: Harness) -> Result<Self, CostError> {
        let mut bound = bindings(set, style.form);
        bound.retain(|entry| !(style.constant && entry.resource == BindingEntry::BUFFER));
        Self::of_text(&shader_text(set, style)?, &bound, harness)
    }

    /// A text with the functions of a shader, evaluated in a harness.
    ///
    /// # Errors
    /// Those of naga.
    pub fn of_text(wgsl: &str, bound: &[BindingEntry], harness: Harness) -> Result<Self, CostError> {
        let shader = bound.iter().map(|entry| {
            let resource = match entry.resource.as_str() {
                _ if entry.is_buffer() => Resource::Storage,
                "sampler" => Resource::Sampler,
                _ => Resource::Texture,
            };
            Binding { group: 0, binding: entry.binding, resource }
        });
        Self::new(wgsl, shader, harness)
    }

    /// The harness alone. It multiplies the two directions, so that both are read: three instructions that other kernels lack.
    ///
    /// # Errors
    /// A defect of the harness.
    pub fn empty(harness: Harness) -> Result<Self, CostError> {
        let shader = if matches!(harness, Harness::Lights(_)) { EMPTY_LIT } else { EMPTY };
        Self::new(shader, std::iter::empty(), harness)
    }

    fn new(shader: &str, bindings: impl Iterator<Item = Binding>, harness: Harness) -> Result<Self, CostError> {
        let bare = include_str!("wgsl/harness.wgsl");
        let (text, resources): (_, &[Resource]) = match harness {
            Harness::Bare => (bare.to_owned(), &[Resource::Storage, Resource::Uniform]),
            Harness::Lights(lights) => (lit(bare, lights), &[Resource::Storage, Resource::Uniform]),
            Harness::NormalMapped => (
                include_str!("wgsl/harness_normal_mapped.wgsl").to_owned(),
                &[Resource::Storage, Resource::Uniform, Resource::Texture, Resource::Texture, Resource::Sampler],
            ),
        };
        let own = (0..).zip(resources).map(|(binding, &resource)| Binding { group: 1, binding, resource });
        let spirv = spirv_words(&format!("{shader}\n{text}"))?;
        Ok(Self { spirv, bindings: bindings.chain(own).collect() })
    }
}

/// WGSL of a shader in a style.
///
/// # Errors
/// Those of [`emit`] and [`emit_constant`].
pub fn shader_text(set: &MaterialSet<'_>, style: Style) -> Result<String, CostError> {
    let text = match style.constant {
        true => emit_constant(set, style.form, Target::Wgsl)?,
        false => emit(set, style.form, Target::Wgsl)?,
    };
    Ok(if style.approximate { approximated(&text) } else { text })
}

/// The text with the exact Fresnel function, if there is one, replaced by the approximation.
fn approximated(text: &str) -> String {
    let Some((before, rest)) = text.split_once("fn luthier_fresnel(") else { return text.to_owned() };
    let after = rest.split_once("\n}\n").map_or("", |(_, after)| after);
    format!("{before}{APPROXIMATE_FRESNEL}{after}")
}
