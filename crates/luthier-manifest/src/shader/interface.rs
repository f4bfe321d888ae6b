//! Declarations of an emitted shader, for programs around it.

use serde::{Deserialize, Serialize};

/// The part of a shader that a program around it calls, fills and binds. Names and types are those of WGSL, whatever the language of the
/// shader.
///
/// ```
/// use luthier_manifest::Interface;
///
/// let wgsl = "@group(0) @binding(5) var luthier_sampler: sampler;\nfn luthier_layer_count(material: u32) -> u32 {\n}\n";
/// let interface = Interface::read(wgsl);
/// assert!(interface.binds("luthier_sampler") && !interface.has("LuthierPlace"));
/// assert_eq!(interface.function("luthier_layer_count").unwrap().parameters, ["u32"]);
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Interface {
    /// Functions to call.
    pub functions: Vec<FunctionEntry>,
    /// Structures to fill.
    pub structures: Vec<StructureEntry>,
    /// Names of the bindings that it reads, of [`Manifest::bindings`](crate::Manifest::bindings).
    pub bindings: Vec<String>,
}

/// A function of a shader.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FunctionEntry {
    /// Its name: `luthier_eval`.
    pub name: String,
    /// Types of its parameters.
    pub parameters: Vec<String>,
    /// Type of its value.
    pub value: String,
}

/// A structure of a shader.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct StructureEntry {
    /// Its name: `LuthierPlace`.
    pub name: String,
    /// Names of its members.
    pub members: Vec<String>,
}

impl Interface {
    /// All declarations of a WGSL text as luthier writes it: each begins a line of its own.
    pub fn read(wgsl: &str) -> Self {
        Self {
            functions: declared(wgsl, "fn ").filter_map(FunctionEntry::read).collect(),
            structures: declared(wgsl, "struct ").filter_map(StructureEntry::read).collect(),
            bindings: declared(wgsl, "@group(").filter_map(binding).map(str::to_owned).collect(),
        }
    }

    /// A function by its name.
    pub fn function(&self, name: &str) -> Option<&FunctionEntry> {
        self.functions.iter().find(|function| function.name == name)
    }

    /// Whether the shader has a function.
    pub fn calls(&self, function: &str) -> bool {
        self.function(function).is_some()
    }

    /// Whether the shader has a structure.
    pub fn has(&self, structure: &str) -> bool {
        self.structures.iter().any(|entry| entry.name == structure)
    }

    /// Whether a structure has a member.
    pub fn fills(&self, structure: &str, member: &str) -> bool {
        let mut members = self.structures.iter().filter(|entry| entry.name == structure).flat_map(|e| &e.members);
        members.any(|name| name == member)
    }

    /// Whether the shader reads a binding.
    pub fn binds(&self, name: &str) -> bool {
        self.bindings.iter().any(|binding| binding == name)
    }
}

impl FunctionEntry {
    fn read(text: &str) -> Option<Self> {
        let (name, rest) = text.split_once('(')?;
        let (parameters, rest) = rest.split_once(')')?;
        let value = rest.strip_prefix(" -> ")?.split(" {").next()?;
        let parameters = parameters.split(", ").filter_map(|parameter| parameter.split_once(": "));
        let parameters = parameters.map(|(_, kind)| kind.to_owned()).collect();
        Some(Self { name: name.to_owned(), parameters, value: value.to_owned() })
    }
}

impl StructureEntry {
    fn read(text: &str) -> Option<Self> {
        let (name, rest) = text.split_once(" {")?;
        let lines = rest.lines().take_while(|line| *line != "}").map(str::trim).filter(|line| !line.starts_with("//"));
        let members = lines.filter_map(|line| line.split_once(": ")).map(|(member, _)| member.to_owned()).collect();
        Some(Self { name: name.to_owned(), members })
    }
}

/// The name of a binding.
fn binding(text: &str) -> Option<&str> {
    text.split(':').next()?.rsplit(' ').next()
}

/// The text behind each line that begins with a keyword.
fn declared<'t>(wgsl: &'t str, keyword: &str) -> impl Iterator<Item = &'t str> {
    wgsl.match_indices(keyword).filter_map(|(at, keyword)| {
        let begins = at == 0 || wgsl[..at].ends_with('\n');
        begins.then(|| &wgsl[at + keyword.len()..])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declarations_are_read_from_a_text() {
        let interface = Interface::read(
            "// fn no(a: u32) -> u32 {\n@group(0) @binding(0) var<storage, read> words: array<vec4<f32>>;\n\
             @group(0) @binding(5) var linear: sampler;\n\n/// A place.\nstruct Place {\n    /// Kind: one.\n    kind: u32,\n    \
             normal: vec3<f32>,\n}\n\nfn none() -> f32 {\n    return 1.0;\n}\n\nfn at(place: Place, uv: vec2<f32>) -> vec3<f32> {\n",
        );
        let entry = |name: &str, parameters: &[&str], value: &str| FunctionEntry {
            name: name.to_owned(),
            parameters: parameters.iter().map(|&kind| kind.to_owned()).collect(),
            value: value.to_owned(),
        };
        assert_eq!(interface.functions, [entry("none", &[], "f32"), entry("at", &["Place", "vec2<f32>"], "vec3<f32>")]);
        assert!(interface.has("Place") && interface.fills("Place", "normal") && !interface.fills("Place", "uv"));
        assert!(interface.calls("at") && !interface.calls("no"));
        assert_eq!(interface.bindings, ["words", "linear"]);
        assert!(interface.binds("linear") && !interface.binds("Place"));
    }
}
