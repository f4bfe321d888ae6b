//! Sets of materials that share a shader: the materials of one bake with one model.

use luthier_export::Package;
use luthier_lut::{TableKind, TexelFormat};
use luthier_manifest::{
    Form, FunctionGroup, LAYER_WORDS, LayerKind, MATERIAL_WORDS, Manifest, MaterialEntry, ShadingModel, Target,
    material_buffer,
};
use luthier_shader::{MaterialSet, emit};
use serde::Serialize;

use crate::live::PageLive;
use crate::roughness::{self, PageSlopes};
use crate::{GalleryError, LIGHT_RADIUS, pack};

/// Formats that WebGL 2 reads without an extension; others are read as half floats.
const FORMATS: [TexelFormat; 8] = [
    TexelFormat::R16Float,
    TexelFormat::Rg16Float,
    TexelFormat::R32Float,
    TexelFormat::Rgba8Unorm,
    TexelFormat::Rgb10a2Unorm,
    TexelFormat::Rg11b10Ufloat,
    TexelFormat::Rgba16Float,
    TexelFormat::Rgba32Float,
];

/// A table of a bake.
#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct PageTable {
    name: String,
    format: TexelFormat,
    width: u32,
    height: u32,
    texels: String,
}

/// Materials of a bake that share a model.
#[derive(Debug, Serialize)]
pub(crate) struct PageSet {
    /// Number of the bake.
    package: usize,
    /// Material buffer: the materials, then all of them with slopes widened by the light.
    words: String,
    size: [u32; 2],
    /// Shaders of the forms that the model has.
    baked: Option<PageShader>,
    full: Option<PageShader>,
    /// Numbers in the bake.
    #[serde(skip)]
    numbers: Vec<usize>,
}

#[derive(Debug, Serialize)]
struct PageShader {
    glsl: String,
    /// Words that choose the code around the shader.
    defines: Vec<String>,
    /// Layers that have values of their own in a place.
    layers: usize,
    /// Tables that it reads.
    tables: Vec<String>,
}

impl PageSet {
    /// The sets of a bake, in the order of their first materials.
    pub(crate) fn of(number: usize, package: &Package) -> Result<Vec<Self>, GalleryError> {
        let manifest = &package.manifest;
        let mut models: Vec<ShadingModel> = Vec::new();
        for material in &manifest.materials {
            if !models.contains(&material.model) {
                models.push(material.model);
            }
        }
        models.into_iter().map(|model| Self::new(number, manifest, model)).collect()
    }

    fn new(package: usize, manifest: &Manifest, model: ShadingModel) -> Result<Self, GalleryError> {
        let all = manifest.materials.iter().enumerate();
        let (numbers, own): (Vec<usize>, Vec<MaterialEntry>) =
            all.filter(|(_, entry)| entry.model == model).map(|(i, entry)| (i, entry.clone())).unzip();
        let mut materials = own.clone();
        materials.extend(own.iter().map(lit));
        if own.iter().any(|entry| matches!(PageSlopes::of(entry), PageSlopes::Octaves(_))) {
            roughness::with_places(&mut materials);
        }
        let shows_lobes = materials.iter().any(|entry| entry.shows_lobes());
        let mut manifest = Manifest { materials, surfaces: Vec::new(), ..manifest.clone() };
        manifest.functions = Default::default();
        if shows_lobes {
            manifest.functions = [FunctionGroup::Environment].into_iter().collect();
        }
        for table in manifest.tables.iter_mut().filter(|table| !FORMATS.contains(&table.format)) {
            table.format = TexelFormat::Rgba16Float;
        }
        let shaders =
            [Form::Baked, Form::Full].map(|form| model.has(form).then(|| PageShader::new(&manifest, form)).transpose());
        let [baked, full] = shaders;
        let mut words = material_buffer(&manifest.materials);
        let size = luthier_manifest::MaterialTexture::of(words.len());
        words.resize(size.words(), [0.0; 4]);
        let bytes: Vec<u8> = words.as_flattened().iter().flat_map(|word| word.to_le_bytes()).collect();
        let words = pack::bytes(&bytes, 4);
        Ok(Self { package, words, size: [size.width, size.height], baked: baked?, full: full?, numbers })
    }

    /// Number of a material of a bake in this set.
    pub(crate) fn place(&self, package: usize, number: u32) -> Option<usize> {
        let numbers = if self.package == package { self.numbers.as_slice() } else { &[] };
        numbers.iter().position(|&other| other == number as usize)
    }

    pub(crate) fn count(&self) -> usize {
        self.numbers.len()
    }

    /// Whether it is of a bake.
    pub(crate) fn is_of(&self, package: usize) -> bool {
        self.package == package
    }

    /// Names of the tables that its shaders read.
    pub(crate) fn tables(&self) -> impl Iterator<Item = &String> {
        self.baked.iter().chain(&self.full).flat_map(|shader| &shader.tables)
    }
}

impl PageShader {
    fn new(manifest: &Manifest, form: Form) -> Result<Self, GalleryError> {
        let set = MaterialSet::from_manifest(manifest);
        let glsl = emit(&set, form, Target::GlslEs300)?;
        let defines = [
            ("struct LuthierPlace", "VIEW_PLACES"),
            (" luthier_eval_lit(", "VIEW_FLUORESCENT"),
            (" luthier_film_place(", "VIEW_FILMS"),
            (" luthier_flake_normal(", "VIEW_FLAKES"),
            ("vec3 flake_normal;", "VIEW_TILTED"),
            (" luthier_patina_amount(", "VIEW_PATINA"),
            ("float weight_factor;", "VIEW_WEIGHTS"),
            (" luthier_cover(", "VIEW_COVERS"),
            (" luthier_glitter_normal(", "VIEW_GLITTER"),
            ("vec3 base_color;", "VIEW_COLORS"),
            ("vec3 inner_normal;", "VIEW_LEANS"),
            ("vec2 alpha_factors;", "VIEW_OWN_ALPHAS"),
            ("vec2 tangent;", "VIEW_OWN_TANGENTS"),
            ("vec3 absorption_factors;", "VIEW_OWN_TINTS"),
            (" luthier_metallic_place(", "VIEW_METALS"),
            (" luthier_lookup_fresnel(", "VIEW_FRESNEL"),
            (" luthier_lookup_fgd(", "VIEW_FGD"),
            (" luthier_lookup_film(", "VIEW_FILM"),
            (" luthier_environment_lobes(", "VIEW_LOBES"),
        ];
        let defines = defines.into_iter().filter(|(text, _)| glsl.contains(text)).map(|(_, define)| define.to_owned());
        let mut defines: Vec<String> = defines.collect();
        let own = |text: &str| glsl.split("struct LuthierLayerPlace {").nth(1)?.split('}').next()?.find(text);
        if own("float slab_factor;").is_some() {
            defines.push("VIEW_OWN_SLABS".to_owned());
        }
        let layers =
            glsl.split("LuthierLayerPlace layers[").nth(1).and_then(|rest| rest.split(']').next()?.parse().ok());
        let layers = layers.unwrap_or(0);
        if manifest.materials.iter().any(|entry| PageLive::of(entry).is_some()) {
            defines.extend(["VIEW_LIVE".to_owned(), format!("VIEW_LIVE_LAYERS {layers}")]);
        }
        let bindings = luthier_shader::bindings(&set, form).into_iter();
        let tables = bindings.filter(|b| b.resource == "texture_2d<f32>").map(|b| b.name).collect();
        Ok(Self { glsl: pack::text(&glsl), defines, layers, tables })
    }
}

/// The tables of a bake that shaders read, by name.
pub(crate) fn tables(package: &Package, is_read: impl Fn(&str) -> bool) -> Result<Vec<PageTable>, GalleryError> {
    let mut tables = Vec::new();
    for table in &package.tables {
        let name = format!("luthier_{}", table.kind.name());
        if !is_read(&name) {
            continue;
        }
        let texture = &table.texture;
        let (mut format, mut bytes) = (texture.format, texture.bytes.clone());
        if !FORMATS.contains(&format) {
            format = TexelFormat::Rgba16Float;
            let image = texture.image().map_err(luthier_export::PackageError::from)?;
            bytes = format.encode(&widened(image));
        }
        let texels = pack::bytes(&bytes, format.texel_bytes() as usize);
        tables.push(PageTable { name, format, width: texture.width, height: texture.height, texels });
    }
    Ok(tables)
}

/// The image with four channels.
fn widened(image: luthier_lut::Image) -> luthier_lut::Image {
    let channels = image.channels as usize;
    let texels = image.data.chunks_exact(channels);
    let data =
        texels.flat_map(|t| [0.0, 0.0, 0.0, 1.0].into_iter().enumerate().map(|(c, none)| *t.get(c).unwrap_or(&none)));
    luthier_lut::Image { channels: 4, data: data.collect(), ..image }
}

/// Numbers of the material buffer that the code of the page has, as lines of GLSL.
pub(crate) fn constants() -> String {
    [
        format!("#define VIEW_MATERIAL_WORDS {MATERIAL_WORDS}u\n#define VIEW_LAYER_WORDS {LAYER_WORDS}u\n"),
        tile("FRESNEL", TableKind::Fresnel),
        tile("FGD", TableKind::Fgd),
        tile("FILM", TableKind::Film),
    ]
    .concat()
}

/// The macro for the number of a tile in a layer record.
fn tile(name: &str, kind: TableKind) -> String {
    let [word, channel] = kind.facts().slot.unwrap_or_default();
    format!("#define VIEW_{name}_TILE view_word(first + {word}u)[{channel}]\n")
}

/// True where surroundings that were blurred beforehand can light a material: the bake has the reflectance and the albedo of every interface, or
/// lobes, and no layer has maps of its own.
pub(crate) fn is_blurred(entry: &MaterialEntry) -> bool {
    if entry.shown_layer_maps(Form::Baked).next().is_some() {
        return false;
    }
    let mut interfaces = entry.records().filter(|layer| layer.kind != LayerKind::Diffuse);
    entry.shows_lobes()
        || interfaces.all(|layer| {
            let kinds = [TableKind::Film, TableKind::Fresnel, TableKind::Fgd];
            let [film, fresnel, fgd] = kinds.map(|kind| layer.tiles[kind].is_some());
            film || (fresnel && fgd)
        })
}

/// A material with slopes widened by the light, under a name of its own.
fn lit(entry: &MaterialEntry) -> MaterialEntry {
    MaterialEntry { name: format!("{}-lit", entry.name), ..entry.widened(LIGHT_RADIUS) }
}
