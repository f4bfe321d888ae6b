use luthier_shader::{Form, MaterialSet, Target, bindings, emit, spirv_words};
use serde::{Deserialize, Serialize};

use crate::CostError;

/// Reads two directions, evaluates, writes.
const HARNESS: &str = include_str!("wgsl/harness.wgsl");

/// Stands in for a shader: all that is left is the harness.
const EMPTY: &str =
    "fn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {\n    return wi * wo;\n}\n";

/// A compute kernel to compile, with what it binds.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Kernel {
    /// SPIR-V words; one entry point.
    pub spirv: Vec<u32>,
    /// All that it may name.
    pub bindings: Vec<Binding>,
}

/// One binding of a kernel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Binding {
    /// Descriptor set.
    pub group: u32,
    /// Number in it.
    pub binding: u32,
    /// What is bound.
    pub resource: Resource,
}

/// What a kernel may bind.
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
    /// The evaluation of one form of the shader of a set, in the harness. The material's number comes from a uniform buffer,
    /// as a draw call would give it.
    ///
    /// # Errors
    /// Those of [`emit`].
    pub fn of_set(set: &MaterialSet<'_>, form: Form) -> Result<Self, CostError> {
        let resource = |kind: &str| match kind {
            "buffer" => Resource::Storage,
            "sampler" => Resource::Sampler,
            _ => Resource::Texture,
        };
        let face = bindings(set, form);
        let shader = face.iter().map(|e| Binding { group: 0, binding: e.binding, resource: resource(&e.resource) });
        Self::new(&emit(set, form, Target::Wgsl)?, shader)
    }

    /// The harness alone. The two directions are multiplied, so that both are read: three instructions that are not in the
    /// others.
    ///
    /// # Errors
    /// A defect of the harness.
    pub fn empty() -> Result<Self, CostError> {
        Self::new(EMPTY, std::iter::empty())
    }

    fn new(shader: &str, bindings: impl Iterator<Item = Binding>) -> Result<Self, CostError> {
        let harness = [(0, Resource::Storage), (1, Resource::Storage), (2, Resource::Uniform)];
        let harness = harness.into_iter().map(|(binding, resource)| Binding { group: 1, binding, resource });
        let spirv = spirv_words(&format!("{shader}\n{HARNESS}"))?;
        Ok(Self { spirv, bindings: bindings.chain(harness).collect() })
    }
}
