//! Surface files: the material at each place.

use std::ops::Range;

use luthier_manifest::SwitchBy;

use crate::check::check_table;
use crate::diagnostic::{Diagnostic, Severity, Sink};
use crate::grammar::SURFACE;
use crate::section::{Section, parse_toml};

/// A validated surface: grains of several materials, others at some places, and particles on top of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Name: letters, digits and hyphens.
    pub name: String,
    /// Label of the file that it was read from.
    pub source: String,
    /// Text of that file.
    pub text: String,
    /// One or two sentences; empty when the file has none.
    pub description: String,
    /// Grains that cover it.
    pub cells: SurfaceCells,
    /// Other grains at some places; the first switch that holds at a place is seen.
    pub switches: Vec<SurfaceSwitch>,
    /// Particles on top of all of them.
    pub glitter: Option<SurfaceGlitter>,
    name_span: Range<usize>,
}

/// Voronoi cells, each of one of some materials (Weidlich and Wilkie 2009, section 5.2.1).
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceCells {
    /// Seed of the cells.
    pub seed: u32,
    /// Cells per unit of texture coordinate.
    pub frequency: f64,
    /// The materials, all as likely; at least one.
    pub materials: Vec<NamedMaterial>,
}

/// Grains in place of others, and their places.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceSwitch {
    /// The places.
    pub by: SwitchBy,
    /// The grains.
    pub cells: SurfaceCells,
    /// Bytes of the text that say which places: the range of the noise, or the tiles.
    pub span: Range<usize>,
}

/// A share of the Voronoi cells of a map of its own, each of one of some materials and tilted.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceGlitter {
    /// The cells, and the materials of those that glitter.
    pub cells: SurfaceCells,
    /// Share of the cells that glitter, 0..=1.
    pub filled: f64,
    /// Largest tilt, in radians.
    pub tilt: f64,
}

/// A material that a surface names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedMaterial {
    /// The material file, relative to the surface's.
    pub file: String,
    /// Bytes of the text that name it.
    pub span: Range<usize>,
}

impl Surface {
    /// The materials that it names: those of the cells, of each switch, and of the particles; some more than once.
    pub fn materials(&self) -> impl Iterator<Item = &NamedMaterial> {
        let switched = self.switches.iter().map(|switch| &switch.cells);
        let grains = std::iter::once(&self.cells).chain(switched).flat_map(|cells| &cells.materials);
        grains.chain(self.particles())
    }

    /// The materials of its particles, the last of all that it names.
    pub fn particles(&self) -> &[NamedMaterial] {
        self.glitter.as_ref().map_or(&[], |glitter| &glitter.cells.materials)
    }

    /// An error about a material that the surface names.
    pub fn diagnostic(&self, material: &NamedMaterial, message: impl Into<String>, hint: &str) -> Diagnostic {
        let hint = Some(hint.to_owned());
        Sink::one(&self.source, &self.text, Severity::Error, material.span.clone(), message.into(), hint)
    }

    /// A warning about the places of a switch.
    pub fn of_switch(&self, switch: &SurfaceSwitch, message: impl Into<String>, hint: impl Into<String>) -> Diagnostic {
        let hint = Some(hint.into());
        Sink::one(&self.source, &self.text, Severity::Warning, switch.span.clone(), message.into(), hint)
    }

    /// An error about its name.
    pub fn of_name(&self, message: impl Into<String>) -> Diagnostic {
        let hint = Some("give one of the two another name".to_owned());
        Sink::one(&self.source, &self.text, Severity::Error, self.name_span.clone(), message.into(), hint)
    }
}

/// Reads a surface file. `label` names it in diagnostics. The materials that it names are not read.
///
/// ```
/// let text = r#"
/// surface = 1
/// name = "lepidolite"
///
/// [cells]
/// frequency = 40
/// materials = ["lilac.toml", "pink.toml"]
/// "#;
/// let surface = luthier_material::parse_surface("lepidolite.toml", text).unwrap();
/// assert_eq!(surface.materials().map(|m| m.file.as_str()).collect::<Vec<_>>(), ["lilac.toml", "pink.toml"]);
///
/// let wrong = text.replace("frequency", "frequence");
/// let diagnostics = luthier_material::parse_surface("lepidolite.toml", &wrong).unwrap_err();
/// assert_eq!((diagnostics[0].line, diagnostics[0].column), (6, 1));
/// assert_eq!(diagnostics[0].hint.as_deref(), Some("did you mean `frequency`?"));
/// ```
///
/// # Errors
/// All diagnostics, in the order of the text.
pub fn parse_surface(label: &str, text: &str) -> Result<Surface, Vec<Diagnostic>> {
    let mut sink = Sink::new(label, text);
    let Some(document) = parse_toml(text, &mut sink) else { return Err(sink.into_diagnostics()) };
    let document = Section::document(&document);
    check_table(&SURFACE, &[], &document, &mut sink);
    for at in document.sections("switch").iter().filter_map(|at| at.section("noise")) {
        check_range(&at, &mut sink);
    }
    let cells = document.section("cells").filter(|_| !sink.has_errors());
    let Some(at) = cells else { return Err(sink.into_diagnostics()) };
    Ok(Surface {
        name: document.text("name").unwrap_or_default().to_owned(),
        source: label.to_owned(),
        text: text.to_owned(),
        description: document.text("description").unwrap_or_default().to_owned(),
        cells: cells_of(&at, 20.0),
        switches: document.sections("switch").iter().filter_map(switch_of).collect(),
        glitter: document.section("glitter").map(|at| SurfaceGlitter {
            cells: cells_of(&at, 60.0),
            filled: at.number("filled").unwrap_or(0.1),
            tilt: at.number("tilt_deg").unwrap_or(15.0).to_radians(),
        }),
        name_span: document.value_span("name"),
    })
}

/// A range of noise has a least value, and a larger one.
fn check_range(noise: &Section<'_>, sink: &mut Sink<'_>) {
    if let Some([least, most]) = range_of(noise).filter(|[least, most]| least >= most) {
        let message = format!("`between` goes from {least} to {most}, where no noise is");
        let hint = if least > most { format!("between = [{most}, {least}]") } else { "give it some width".to_owned() };
        sink.error(noise.value_span("between"), message, Some(hint));
    }
}

fn range_of(noise: &Section<'_>) -> Option<[f64; 2]> {
    noise.two_numbers("between")
}

fn switch_of(at: &Section<'_>) -> Option<SurfaceSwitch> {
    let (by, span) = match (at.section("noise"), at.section("tiles")) {
        (Some(noise), _) => {
            let by = SwitchBy::Noise {
                seed: noise.integer("seed").unwrap_or(0),
                frequency: noise.number("frequency").unwrap_or(4.0),
                octaves: noise.integer("octaves").unwrap_or(4),
                between: range_of(&noise)?,
            };
            (by, noise.value_span("between"))
        }
        (None, Some(tiles)) => {
            let by = SwitchBy::Tiles {
                seed: tiles.integer("seed").unwrap_or(0),
                frequency: tiles.number("frequency").unwrap_or(5.0),
                share: tiles.number("share").unwrap_or(0.5),
            };
            (by, at.value_span("tiles"))
        }
        (None, None) => return None,
    };
    Some(SurfaceSwitch { by, cells: cells_of(&at.section("cells")?, 20.0), span })
}

fn cells_of(at: &Section<'_>, frequency: f64) -> SurfaceCells {
    SurfaceCells {
        seed: at.integer("seed").unwrap_or(0),
        frequency: at.number("frequency").unwrap_or(frequency),
        materials: at.spanned_texts("materials").map(|(file, span)| NamedMaterial { file, span }).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FileKind;

    const MICA: &str = "surface = 1\nname = \"mica\"\n\n[cells]\nseed = 3\nfrequency = 40\nmaterials = [\"a.toml\", \
                        \"b.toml\", \"a.toml\"]\n\n[glitter]\nfilled = 0.2\ntilt_deg = 20\nmaterials = [\"c.toml\"]\n";

    #[test]
    fn a_surface_is_read() {
        let surface = parse_surface("mica.toml", MICA).unwrap();
        assert_eq!((surface.cells.seed, surface.cells.frequency), (3, 40.0));
        let glitter = surface.glitter.as_ref().unwrap();
        assert_eq!((glitter.cells.seed, glitter.cells.frequency, glitter.filled), (0, 60.0, 0.2));
        assert!((glitter.tilt - 0.349_065_850_398_865_9).abs() < 1e-15, "{}", glitter.tilt);
        let named: Vec<&str> = surface.materials().map(|material| material.file.as_str()).collect();
        assert_eq!(named, ["a.toml", "b.toml", "a.toml", "c.toml"]);
        for material in surface.materials() {
            assert_eq!(MICA[material.span.clone()], format!("\"{}\"", material.file));
        }
    }

    /// With defaults, and with all keys.
    #[test]
    fn switches_are_read() {
        let noise = "[[switch]]\nnoise = { between = [-0.05, 0.05] }\ncells = { materials = [\"d.toml\"] }\n\n";
        let tiles = "[[switch]]\ncells = { seed = 1, frequency = 80, materials = [\"e.toml\", \"a.toml\"] }\n\
                     [switch.tiles]\nseed = 2\nfrequency = 3\nshare = 0.25\n\n";
        let text = MICA.replace("[glitter]", &format!("{noise}{tiles}[glitter]"));
        let surface = parse_surface("mica.toml", &text).unwrap();
        let [first, second] = &surface.switches[..] else { panic!("{:?}", surface.switches) };
        assert_eq!(first.by, SwitchBy::Noise { seed: 0, frequency: 4.0, octaves: 4, between: [-0.05, 0.05] });
        assert_eq!((first.cells.seed, first.cells.frequency), (0, 20.0));
        assert_eq!(second.by, SwitchBy::Tiles { seed: 2, frequency: 3.0, share: 0.25 });
        assert_eq!((second.cells.seed, second.cells.frequency), (1, 80.0));
        let named: Vec<&str> = surface.materials().map(|material| material.file.as_str()).collect();
        assert_eq!(named, ["a.toml", "b.toml", "a.toml", "d.toml", "e.toml", "a.toml", "c.toml"]);
        assert_eq!(surface.particles().iter().map(|one| one.file.as_str()).collect::<Vec<_>>(), ["c.toml"]);
        let warning = surface.of_switch(first, "nowhere", "elsewhere");
        assert_eq!((&text[first.span.clone()], warning.severity), ("[-0.05, 0.05]", Severity::Warning));
    }

    #[test]
    fn mistakes_of_switches_are_pointed_at() {
        let good = MICA.to_owned()
            + "[[switch]]\nnoise = { octaves = 3, between = [-0.1, 0.1] }\ncells = { materials = [\"d.toml\"] }\n";
        assert!(parse_surface("mica.toml", &good).is_ok());
        for (from, to, line, message, hint) in [
            ("[-0.1, 0.1]", "[0.3, 0.1]", 14, "goes from 0.3 to 0.1", "between = [0.1, 0.3]"),
            ("[-0.1, 0.1]", "[0.1, 0.1]", 14, "goes from 0.1 to 0.1", "width"),
            ("[-0.1, 0.1]", "[0.1, 2]", 14, "must be from -1 to 1", ""),
            ("[-0.1, 0.1]", "0.1", 14, "`between`", ""),
            ("[-0.1, 0.1]", "[0.1]", 14, "`between`", ""),
            (", between = [-0.1, 0.1]", "", 14, "`between` is missing", ""),
            ("octaves = 3", "octaves = 0", 14, "`octaves` must be", ""),
            ("noise =", "nose =", 14, "unknown key `nose`", "did you mean `noise`?"),
            ("noise = { octaves = 3, between = [-0.1, 0.1] }", "", 13, "has no place", "tiles = { share = 0.5 }"),
            (
                "\ncells = { materials = [\"d.toml\"] }",
                "\ntiles = {}\ncells = { materials = [\"d.toml\"] }",
                15,
                "a second place",
                "keep one of",
            ),
            ("\ncells = { materials = [\"d.toml\"] }", "", 13, "`cells` is missing", ""),
            ("[[switch]]", "[switch]", 13, "`switch`", ""),
        ] {
            let found = parse_surface("mica.toml", &good.replacen(from, to, 1)).unwrap_err();
            let first = found.iter().find(|one| one.line == line).unwrap_or_else(|| panic!("{to}: {found:?}"));
            assert!(first.message.contains(message), "{to}: {found:?}");
            assert!(first.hint.clone().unwrap_or_default().contains(hint), "{to}: {found:?}");
        }
    }

    #[test]
    fn files_say_what_they_are() {
        assert_eq!(FileKind::of(MICA), FileKind::Surface);
        let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
        let found = crate::parse("mica.toml", MICA, &no_files).unwrap_err();
        assert_eq!((found.len(), found[0].line), (1, 1));
        assert_eq!(found[0].message, "this is a surface, not a material");
    }

    /// Each mistake has one message, at its place, with a way out.
    #[test]
    fn mistakes_are_pointed_at() {
        for (from, to, line, message, hint) in [
            ("surface = 1", "surface = 2", 1, "`surface` must be 1", "surface = 1"),
            ("frequency = 40", "frequency = 0", 6, "`frequency` must be", ""),
            ("filled = 0.2", "filled = 20", 10, "`filled` must be", ""),
            ("tilt_deg = 20", "tilt_deg = 60", 11, "must be from 0 to 45", ""),
            ("tilt_deg", "tilt", 11, "unknown key `tilt`", "tilt_deg"),
            ("[\"c.toml\"]", "[]", 12, "", ""),
            ("[\"c.toml\"]", "\"c.toml\"", 12, "", ""),
            ("[cells]", "[cell]", 4, "unknown key `cell`", "did you mean `cells`?"),
        ] {
            let found = parse_surface("mica.toml", &MICA.replacen(from, to, 1)).unwrap_err();
            let first = found.iter().find(|one| one.line == line).unwrap_or_else(|| panic!("{to}: {found:?}"));
            assert!(first.message.contains(message), "{to}: {found:?}");
            assert!(first.hint.clone().unwrap_or_default().contains(hint), "{to}: {found:?}");
        }
    }
}
