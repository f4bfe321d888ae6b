//! The manifest of a bake.

use luthier_lut::{AtlasLayout, TableKind, TexelFormat, Tile};
use luthier_model::Form;
use serde::{Deserialize, Serialize};

use crate::choice::SceneChoice;
use crate::error::ManifestError;
use crate::file::FileEntry;
use crate::limits::MaterialTexture;
use crate::material::MaterialEntry;
use crate::search::Search;
use crate::shader::{Check, Functions, Interface, Names};
use crate::surface::SurfaceEntry;
use crate::target::Target;

/// Version of the manifest's shape. A reader refuses any other.
pub const MANIFEST_SCHEMA: u32 = 4;

/// `manifest.json`: all files and records of a bake. Paths are relative to the manifest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// [`MANIFEST_SCHEMA`].
    pub schema: u32,
    /// Program and version: `luthier 0.2.0`.
    pub generator: String,
    /// The materials, in the order of their numbers in the shader.
    pub materials: Vec<MaterialEntry>,
    /// Surfaces of several materials, in the order of their numbers in the shader; absent where there is none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub surfaces: Vec<SurfaceEntry>,
    /// The tables, at most one of each kind, in binding order.
    pub tables: Vec<TableEntry>,
    /// Searches for the sizes, mappings and formats of tables.
    #[serde(default)]
    pub searches: Vec<Search>,
    /// Choice of the models, for a bake of a scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub choice: Option<SceneChoice>,
    /// The emitted shaders.
    pub shaders: Vec<ShaderEntry>,
    /// Groups of functions of every shader; absent if there is `eval` alone.
    #[serde(default, skip_serializing_if = "Functions::is_eval_alone")]
    pub functions: Functions,
    /// Names in shaders, and places of their resources; absent if they are those by default.
    #[serde(default, skip_serializing_if = "Names::is_default")]
    pub names: Names,
    /// Resources, and where to bind them in the group of `names`.
    pub bindings: Vec<BindingEntry>,
    /// The material buffer: little-endian `vec4<f32>` words, see [`crate::material_buffer`].
    pub material_buffer: FileEntry,
    /// Size of the material buffer as a texture of RGBA32F; absent from earlier bakes.
    #[serde(default)]
    pub material_texture: MaterialTexture,
}

/// One table: a texture and its truth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TableEntry {
    /// Kind of the table.
    pub kind: TableKind,
    /// Places of its texels.
    pub layout: AtlasLayout,
    /// Texel format of the texture.
    pub format: TexelFormat,
    /// Bytes of its texels, uncompressed.
    pub texel_bytes: u64,
    /// The texture: KTX2.
    pub texture: FileEntry,
    /// The unquantised values: EXR, 32-bit float.
    pub truth: FileEntry,
    /// A picture to look at: PNG, sRGB-encoded, clipped to 0..1.
    pub picture: FileEntry,
    /// One entry per tile.
    pub tiles: Vec<Tile>,
}

/// An emitted shader.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShaderEntry {
    /// Its language.
    pub target: Target,
    /// How it evaluates a material.
    pub form: Form,
    /// The file.
    pub file: FileEntry,
    /// Numbers of the materials that it is for; absent if it is for all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub materials: Option<Vec<u32>>,
    /// Functions, structures and bindings for a program around it; absent from earlier bakes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interface: Option<Interface>,
    /// Judges that it passed when it was emitted; absent from earlier bakes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub checks: Vec<Check>,
}

/// One binding of group 0.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct BindingEntry {
    /// Binding number.
    pub binding: u32,
    /// Name of the variable in the shaders.
    pub name: String,
    /// `texture_2d<f32>`, `texture_cube<f32>`, `sampler` (linear, clamp-to-edge), `buffer` (read-only, array of `vec4<f32>`), or `buffer<vec4<u32>>`: a
    /// table whose texels have steps, read-only.
    pub resource: String,
}

impl BindingEntry {
    /// Resource of the material buffer.
    pub const BUFFER: &str = "buffer";
    /// Resource of a table whose texels have steps: 16 bytes each.
    pub const STEPS: &str = "buffer<vec4<u32>>";

    /// Whether it is a read-only storage buffer.
    pub fn is_buffer(&self) -> bool {
        [Self::BUFFER, Self::STEPS].contains(&self.resource.as_str())
    }
}

impl TableEntry {
    /// Checks texels against the entry: size, format and bytes.
    ///
    /// # Errors
    /// [`ManifestError::Layout`], [`ManifestError::TableMismatch`].
    pub fn check(&self, size: [u32; 2], format: TexelFormat, bytes: usize) -> Result<(), ManifestError> {
        let stated = self.layout.checked_size().ok_or(ManifestError::Layout(self.kind))?;
        let texels = u128::from(stated[0]) * u128::from(stated[1]);
        let texel_bytes = texels * u128::from(self.format.texel_bytes());
        let [found, expected] = [(size, format, bytes as u128), (stated, self.format, texel_bytes)]
            .map(|([width, height], format, bytes)| format!("{width} x {height} {format}, {bytes} bytes"));
        if found == expected { Ok(()) } else { Err(ManifestError::TableMismatch { kind: self.kind, found, expected }) }
    }
}

impl Manifest {
    /// The entries of all files.
    pub fn files_mut(&mut self) -> impl Iterator<Item = &mut FileEntry> {
        let tables = self.tables.iter_mut().flat_map(|t| [&mut t.texture, &mut t.truth, &mut t.picture]);
        let maps = self.materials.iter_mut().flat_map(|m| &mut m.maps).map(|map| &mut map.file);
        let shaders = self.shaders.iter_mut().map(|shader| &mut shader.file);
        tables.chain(maps).chain(shaders).chain([&mut self.material_buffer])
    }

    /// JSON, indented, with a final newline.
    ///
    /// # Errors
    /// [`ManifestError::Json`] if a number is not finite.
    pub fn to_json(&self) -> Result<String, ManifestError> {
        let mut json = serde_json::to_string_pretty(self)?;
        // JSON has no infinite number and no NaN: they have become null, which does not read back.
        serde_json::from_str::<Self>(&json)?;
        json.push('\n');
        Ok(json)
    }

    /// Whether the model of some material has a form.
    pub fn has(&self, form: Form) -> bool {
        self.materials.iter().any(|material| material.model.has(form))
    }

    /// Numbers of the materials whose models have a form; `None` if all have it.
    pub fn partial(&self, form: Form) -> Option<Vec<u32>> {
        let numbers = (0u32..).zip(&self.materials).filter(|(_, material)| material.model.has(form));
        let numbers: Vec<u32> = numbers.map(|(number, _)| number).collect();
        (numbers.len() < self.materials.len()).then_some(numbers)
    }

    /// A manifest of materials and tables, without shaders and files.
    pub fn new(generator: &str, materials: Vec<MaterialEntry>, tables: Vec<TableEntry>) -> Self {
        Self {
            schema: MANIFEST_SCHEMA,
            generator: generator.to_owned(),
            materials,
            surfaces: Vec::new(),
            tables,
            searches: Vec::new(),
            choice: None,
            shaders: Vec::new(),
            functions: Functions::default(),
            names: Names::default(),
            bindings: Vec::new(),
            material_buffer: FileEntry::default(),
            material_texture: MaterialTexture::default(),
        }
    }

    /// Reads what [`Manifest::to_json`] wrote.
    ///
    /// # Errors
    /// [`ManifestError::Json`] for other JSON, [`ManifestError::Schema`] for another version.
    pub fn from_json(json: &str) -> Result<Self, ManifestError> {
        #[derive(Deserialize)]
        struct Version {
            schema: u32,
        }
        let Version { schema } = serde_json::from_str(json)?;
        if schema != MANIFEST_SCHEMA {
            return Err(ManifestError::Schema { found: schema, expected: MANIFEST_SCHEMA });
        }
        Ok(serde_json::from_str(json)?)
    }

    /// The table of a kind, if the bake has one.
    pub fn table(&self, kind: TableKind) -> Option<&TableEntry> {
        self.tables.iter().find(|t| t.kind == kind)
    }

    /// The number of a surface in the shader.
    pub fn surface_index(&self, name: &str) -> Option<u32> {
        self.surfaces.iter().position(|surface| surface.name == name).map(|i| i as u32)
    }

    /// The number of a material in the shader.
    pub fn material_index(&self, name: &str) -> Option<u32> {
        self.materials.iter().position(|m| m.name == name).map(|i| i as u32)
    }
}

#[cfg(test)]
mod tests {
    use crate::Tiles;

    use super::*;
    use luthier_lut::{Axis, ErrorStats, Mapping, Worst};
    use luthier_optics::stack::Distribution;

    use crate::{
        Budget, Candidate, CandidateForm, ColorMode, FlakesRecord, GlitterRecord, LayerKind, LayerRecord, MapEntry,
        MapSlot, MaterialConstants, MeasuredError, PatinaRecord, ShadingModel,
    };

    fn manifest() -> Manifest {
        let file = |path: &str| FileEntry { path: path.into(), sha256: "00ff".repeat(16) };
        let axis = |quantity: &str, mapping| Axis {
            quantity: quantity.into(),
            unit: "rad".into(),
            min: 1e-3,
            max: std::f64::consts::FRAC_PI_2,
            size: 512,
            mapping,
        };
        let error = ErrorStats {
            max_abs_err: 0.1 + 0.2,
            rms_err: 1.234_567_890_123_456_7e-5,
            p99_abs_err: 4.9e-324,
            slack: 0.1,
            worst: Worst { at: vec![1.0 / 3.0, 2.0 / 3.0], channel: 2, expected: 0.7, sampled: 1e300 },
            points: u64::MAX,
        };
        let layer = LayerRecord {
            kind: LayerKind::Dielectric,
            distribution: Distribution::Beckmann,
            alpha: 0.09,
            eta: 1.5,
            optical_depth: [0.1, 0.2, 0.3],
            ior_n: [1.49, 1.5, 1.51],
            tiles: Tiles::of([(TableKind::Fresnel, 0), (TableKind::Distribution, 1)]),
            ..LayerRecord::default()
        };
        let table = |kind: TableKind, mapping| TableEntry {
            kind,
            layout: AtlasLayout {
                x: axis("theta_h", mapping),
                y: Some(axis("alpha", Mapping::Logarithmic)),
                apron: 0,
                columns: 1,
                tiles: 1,
                base: luthier_lut::RowBase::Zero,
            },
            format: TexelFormat::R16Float,
            texel_bytes: 524_288,
            texture: file("tables/distribution.ktx2"),
            truth: file("tables/distribution.exr"),
            picture: file("tables/distribution.png"),
            tiles: vec![Tile {
                name: "beckmann".into(),
                model: "pi alpha^2 D, Beckmann".into(),
                input_hash: "ab".repeat(32),
                error: error.clone(),
                aim: Some(2e-3),
                largest: Some(1.0),
            }],
        };
        Manifest {
            schema: MANIFEST_SCHEMA,
            generator: "luthier 0.1.0".into(),
            materials: vec![MaterialEntry {
                name: "red-lacquer".into(),
                source: "materials/red-lacquer.toml".into(),
                source_hash: "12".repeat(32),
                class: "c".into(),
                model: ShadingModel::Belcour,
                color: ColorMode::Spectral,
                wavelengths_nm: [645.0, 525.0, 445.0],
                constants: MaterialConstants {
                    flakes: Some(FlakesRecord {
                        seed: u32::MAX,
                        count: 0,
                        tiling: 3.0,
                        spread: 0.0,
                        scale: 0.7,
                        fade_start: 2.0,
                    }),
                    patina: Some(PatinaRecord {
                        extent: 0.3,
                        transition: 0.1,
                        diffuse_albedo: [0.1, 0.2, 0.3],
                        base_alpha: Some(0.4),
                        tarnish: [0.9, 0.8, 0.7],
                        bare: layer.clone(),
                    }),
                    glitter: Some(GlitterRecord { seed: 7, frequency: 30.0, filled: 0.1, tilt: 0.3 }),
                    ..MaterialConstants::default()
                },
                layers: vec![layer],
                live: Vec::new(),
                maps: vec![
                    MapEntry {
                        slot: MapSlot::FlakeNormal,
                        layer: None,
                        source: "maps/flakes.png".into(),
                        file: file("maps/red-lacquer-flake-normal.png"),
                        width: 64,
                        height: 32,
                        factor: None,
                        srgb: false,
                        transform: None,
                    },
                    MapEntry {
                        slot: MapSlot::Roughness,
                        layer: Some(1),
                        source: "scratches.png".into(),
                        file: file("maps/red-lacquer-roughness-1.png"),
                        width: 1,
                        height: 1,
                        factor: Some([0.1, 0.2, 0.3]),
                        srgb: false,
                        transform: None,
                    },
                ],
            }],
            surfaces: Vec::new(),
            tables: vec![
                table(TableKind::Distribution, Mapping::Power { exponent: 8.0 }),
                table(TableKind::Thickness, Mapping::Periodic),
            ],
            searches: vec![Search {
                kind: TableKind::Fresnel,
                budget: Budget { max_abs: Some(1e-3), ..Budget::default() },
                chosen: 0,
                front: vec![Candidate {
                    form: CandidateForm::ClosedForm,
                    bytes: 0,
                    cost: 12.0,
                    error: MeasuredError { max_abs: 1.0 / 3.0, max_rel: 0.1, ..MeasuredError::default() },
                }],
                measured: 12,
            }],
            choice: None,
            shaders: vec![ShaderEntry {
                target: Target::Wgsl,
                form: Form::Baked,
                file: file("shaders/baked.wgsl"),
                materials: None,
                interface: Some(Interface::default()),
                checks: vec![Check { by: "naga 30".into(), read: Target::Wgsl, capabilities: Some(Vec::new()) }],
            }],
            functions: Functions::default(),
            names: Names::default(),
            bindings: vec![BindingEntry {
                binding: 1,
                name: "luthier_distribution".into(),
                resource: "texture_2d<f32>".into(),
            }],
            material_buffer: file("materials.bin"),
            material_texture: MaterialTexture { width: 33, height: 1 },
        }
    }

    /// Every bit of every number survives, subnormal ones and long fractions included.
    #[test]
    fn json_round_trip() {
        let manifest = manifest();
        let json = manifest.to_json().unwrap();
        assert!(json.ends_with("}\n"));
        let again = Manifest::from_json(&json).unwrap();
        assert_eq!(again, manifest);
        assert_eq!(again.to_json().unwrap(), json);
    }

    #[test]
    fn names_in_the_file_are_those_documented() {
        let value: serde_json::Value = serde_json::from_str(&manifest().to_json().unwrap()).unwrap();
        assert_eq!(value["materials"][0]["color"], "spectral");
        assert_eq!(value["materials"][0]["model"], "belcour");
        assert_eq!(value["materials"][0]["maps"][0]["slot"], "flake-normal");
        assert_eq!(value["materials"][0]["maps"][1]["layer"], 1);
        assert_eq!(value["tables"][0]["kind"], "distribution");
        assert_eq!(value["tables"][0]["format"], "r16float");
        assert_eq!(value["tables"][0]["layout"]["x"]["mapping"]["kind"], "power");
        assert_eq!(value["tables"][0]["layout"]["x"]["mapping"]["exponent"], 8.0);
        assert_eq!(value["materials"][0]["layers"][0]["kind"], "dielectric");
        assert_eq!(value["materials"][0]["layers"][0]["fgd_tile"], serde_json::Value::Null);
    }

    #[test]
    fn another_schema_is_refused_before_its_shape_is_looked_at() {
        let refused = Manifest::from_json(r#"{"schema": 5, "future": true}"#);
        assert!(matches!(refused, Err(ManifestError::Schema { found: 5, expected: MANIFEST_SCHEMA })));
        for other in ["", "{}", "[]", r#"{"schema": "1"}"#, r#"{"schema": 4}"#, r#"{"schema": -1}"#] {
            assert!(matches!(Manifest::from_json(other), Err(ManifestError::Json(_))), "{other}");
        }
    }

    #[test]
    fn a_name_that_does_not_exist_is_refused_with_those_that_do() {
        let json = manifest().to_json().unwrap();
        for (name, other, known) in [
            ("\"belcour\"", "\"ward\"", "elek, weidlich-wilkie"),
            ("\"distribution\": \"beckmann\"", "\"distribution\": \"phong\"", "beckmann, ggx"),
            ("\"wgsl\"", "\"cg\"", "wgsl, glsl450"),
            ("\"baked\"", "\"raw\"", "baked, full"),
            ("\"r16float\"", "\"r8unorm\"", "r16float, rg16float"),
            ("\"flake-normal\"", "\"flakes\"", "normal, roughness"),
        ] {
            let error = Manifest::from_json(&json.replace(name, other)).unwrap_err().to_string();
            assert!(error.contains(known), "{error}");
        }
    }

    #[test]
    fn a_number_that_is_not_finite_is_refused() {
        for bad in [f64::NAN, f64::INFINITY] {
            let mut manifest = manifest();
            manifest.tables[0].tiles[0].error.max_abs_err = bad;
            assert!(matches!(manifest.to_json(), Err(ManifestError::Json(_))), "{bad}");
        }
    }

    #[test]
    fn look_ups_by_kind_and_name() {
        let manifest = manifest();
        assert_eq!(manifest.table(TableKind::Thickness).unwrap().layout.x.mapping, Mapping::Periodic);
        assert!(manifest.table(TableKind::Fresnel).is_none());
        assert_eq!(manifest.material_index("red-lacquer"), Some(0));
        assert_eq!(manifest.material_index("blue-lacquer"), None);
    }

    #[test]
    fn each_cause_of_variation_counts() {
        let whole = manifest().materials.remove(0);
        let plain = MaterialEntry { constants: MaterialConstants::default(), maps: Vec::new(), ..whole.clone() };
        assert!(!plain.varies());
        let constants = &whole.constants;
        let none = MaterialConstants::default;
        for constants in [
            MaterialConstants { flakes: constants.flakes, ..none() },
            MaterialConstants { patina: constants.patina.clone(), ..none() },
            MaterialConstants { glitter: constants.glitter, ..none() },
        ] {
            assert!(MaterialEntry { constants, ..plain.clone() }.varies());
        }
        assert!(MaterialEntry { maps: whole.maps.clone(), ..plain.clone() }.varies());
        let mut film = plain;
        film.layers[0].film_thickness_max_nm = 1.0;
        assert!(film.varies());
    }

    #[test]
    fn records_end_with_the_layer_below_a_patina() {
        let mut material = manifest().materials.remove(0);
        assert_eq!(material.records().count(), 2);
        material.constants.patina = None;
        assert_eq!(material.records().collect::<Vec<_>>(), [&material.layers[0]]);
    }

    #[test]
    fn texels_are_compared_with_the_entry() {
        let entry = manifest().tables.remove(0);
        assert!(entry.check([512, 512], TexelFormat::R16Float, 524_288).is_ok());
        for (size, format, bytes) in [
            ([512, 511], TexelFormat::R16Float, 524_288),
            ([511, 512], TexelFormat::R16Float, 524_288),
            ([512, 512], TexelFormat::Rg16Float, 524_288),
            ([512, 512], TexelFormat::R16Float, 524_287),
        ] {
            assert!(matches!(entry.check(size, format, bytes), Err(ManifestError::TableMismatch { .. })), "{size:?}");
        }
        let mut overlong = entry;
        overlong.layout.x.size = u32::MAX;
        overlong.layout.columns = u32::MAX;
        assert!(matches!(overlong.check([1, 1], TexelFormat::R16Float, 2), Err(ManifestError::Layout(_))));
    }
}
