//! Materials of MaterialX files.
//!
//! Each uses those above it, none below.
//!
//! - `document`: elements with their places, includes merged.
//! - `value`: numbers, and spaces of colours.
//! - `expression`, `nodes`, `graph`: values that depend on the place, the functions of nodes, and what graphs make of them.
//! - `pictured`: expressions as numbers and pictures.
//! - `surface`: a coat, a film and a base as layers.
//! - `inputs`, `models`: inputs of shaders, and the shaders as surfaces.

mod document;
mod expression;
mod graph;
mod inputs;
mod models;
mod nodes;
mod pictured;
mod surface;
mod value;

use std::io;

use self::graph::Graph;
use self::inputs::Inputs;
use self::models::model;
use self::pictured::Pictured;
use self::surface::Writer;
use crate::draft::{Draft, plain};
use crate::name::Names;
use crate::{Fate, Import, ImportError, Imported, Line};

/// The materials of a MaterialX file, of version 1.38 and later. `label` names it in the texts. `files` reads includes and pictures by paths relative to it, and decides which paths it reads.
///
/// The shaders `standard_surface`, `open_pbr_surface`, `gltf_pbr`, `disney_principled` and `UsdPreviewSurface` are read, as materials or alone. Values may come from node graphs of constants, pictures, texture
/// coordinates and arithmetic, and from graphs that the file defines: pictures stay as they are where a material file can say what is done to them, and are computed in 16 bits where not. Colours
/// become linear Rec.709.
///
/// # Errors
/// [`ImportError::Xml`] with a place, for texts that are no MaterialX; [`ImportError::Empty`] without a shader that is read. A value that cannot be read is a [`Line`], and its default is taken.
pub fn materialx(
    label: &str,
    bytes: &[u8],
    files: &dyn Fn(&str) -> io::Result<Vec<u8>>,
) -> Result<Import, ImportError> {
    let root = document::read(label, bytes, files)?;
    let mut graph = Graph::new(&root);
    let mut pictured = Pictured::new(files);
    let mut names = Names::default();
    let mut import = Import::default();
    let mut found = Vec::new();
    let scope = graph.root().clone();
    for material in root.children.iter().filter(|child| child.category == "surfacematerial") {
        let shader = material.input("surfaceshader").and_then(|input| graph.connected(input, &scope));
        match shader {
            Some((shader, scope)) => {
                let given = |name: &&str| material.input(name).is_some_and(|input| inputs::is_given(input));
                let lost: Vec<&str> = ["displacementshader", "backsurfaceshader"].into_iter().filter(given).collect();
                found.push((material.name().to_owned(), shader, scope, lost));
            }
            None => {
                let note = format!("{}: the material has no shader", material.place);
                import.lines.push(Line::new(material.name(), Fate::Dropped, note));
            }
        }
    }
    if root.children.iter().all(|child| child.category != "surfacematerial") {
        let shaders = root.children.iter().filter(|child| model(&child.category).is_some());
        found.extend(shaders.map(|shader| (shader.name().to_owned(), shader.clone(), scope.clone(), Vec::new())));
    }
    for (number, (source_name, shader, scope, lost)) in found.into_iter().enumerate() {
        let (shader, scope) = graph.shader(shader, scope, |category| model(category).is_some());
        let Some(model) = model(&shader.category) else {
            let note = format!("{}: the shader `{}` is not read", shader.place, shader.category);
            import.lines.push(Line::new(&plain(&source_name), Fate::Dropped, note));
            continue;
        };
        let name = names.unique(&source_name, &format!("material-{number}"));
        let (surface, mut lines) = model(Inputs::new(&mut graph, &shader, &scope));
        for name in lost {
            lines.push(Line::new(name, Fate::Dropped, "the form of the surface, and its other side, are not read"));
        }
        let layers = Writer { pictured: &mut pictured, lines: &mut lines }.layers(&surface);
        let mut comments = vec![format!("Source: {label}, `{source_name}`, {}", shader.category)];
        comments.extend(crate::told(&lines));
        let text = Draft { name: name.clone(), comments, layers, ..Draft::default() }.toml();
        import.materials.push(Imported { name, source_name: plain(&source_name), text, lines });
    }
    if import.materials.is_empty() {
        let reason = import.lines.first().map(|line| format!(": {}: {}", line.property, line.note));
        return Err(ImportError::Empty(reason.unwrap_or_default()));
    }
    import.pictures = pictured.into_files();
    Ok(import)
}

/// Whether a text is XML, in UTF-8 or not.
pub(crate) fn is_xml(bytes: &[u8]) -> bool {
    let marks: [&[u8]; 2] = [b"\xff\xfe<", b"\xfe\xff\0<"];
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    text.starts_with(b"<") || marks.iter().any(|mark| bytes.starts_with(mark))
}
