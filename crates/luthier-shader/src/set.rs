//! The set that a shader serves: materials and descriptions of tables. Its bindings.

use std::borrow::Cow;
use std::collections::BTreeMap;

use luthier_lut::{AtlasLayout, TableKind, TexelFormat, Values};
use luthier_manifest::{
    BUFFER_WORDS_MAX, BindingEntry, FunctionGroup, Functions, LAYER_WORDS, LayerKind, LayerRecord, MATERIAL_WORDS,
    Manifest, MaterialEntry, Names, ShadingModel, SurfaceEntry, reads,
};

use crate::identifiers::is_of_word;
use crate::{Form, ShaderError};

/// First binding number that is free for callers. Engines may leave a caller no other group than luthier's: bindings of theirs get this number
/// or a higher one.
pub const RESERVED_BINDINGS: u32 = 16;

/// The most materials of one kind of cells. Shaders multiply a random number of 24 bits by their count: above 256 the product would overflow
/// 32 bits.
const CHOICES_MAX: usize = 256;

/// Binding of the sampler.
const SAMPLER_BINDING: u32 = 5;
/// Binding of the material buffer.
const MATERIALS_BINDING: u32 = 6;
/// Bindings of the environment.
const ENVIRONMENT_BINDINGS: [(u32, &str, &str); 3] = [
    (13, "luthier_environment_map", "texture_cube<f32>"),
    (14, "luthier_irradiance_map", "texture_cube<f32>"),
    (15, "luthier_environment_sampler", "sampler"),
];

const _: () = {
    let mut i = 0;
    while i < TableKind::ALL.len() {
        assert!(TableKind::ALL[i].binding() < RESERVED_BINDINGS, "a binding beyond those that are kept for luthier");
        i += 1;
    }
};

/// Kind, layout and format of a table, without its texels.
#[derive(Debug, Clone, PartialEq)]
pub struct TableFace {
    /// Kind of the table.
    pub kind: TableKind,
    /// Places of its texels.
    pub layout: AtlasLayout,
    /// Format of its texels.
    pub format: TexelFormat,
}

/// The materials that one shader serves, in the order of their numbers, and the tables they point into.
///
/// Tables without a tile of any layer are ignored: they are neither bound nor mentioned.
///
/// ```
/// use luthier_manifest::{FunctionGroup, LayerKind, LayerRecord, MaterialEntry};
/// use luthier_shader::{Form, MaterialSet, Target, emit};
///
/// let layer = LayerRecord { kind: LayerKind::Diffuse, albedo: [0.8; 3], ..LayerRecord::default() };
/// let materials = [MaterialEntry { name: "chalk".to_owned(), layers: vec![layer], ..MaterialEntry::default() }];
/// let mut set = MaterialSet::new(&materials, Vec::new());
/// assert!(!emit(&set, Form::Full, Target::Wgsl)?.contains("fn luthier_albedo("));
/// set.functions = [FunctionGroup::Albedo].into_iter().collect();
/// assert!(emit(&set, Form::Full, Target::Wgsl)?.contains("fn luthier_albedo("));
/// # Ok::<(), luthier_shader::ShaderError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialSet<'a> {
    /// The materials.
    pub materials: Cow<'a, [MaterialEntry]>,
    /// Their places among more materials in a buffer; `None` if the buffer has these alone.
    pub within: Option<Within>,
    /// Surfaces of these materials, in the order of their numbers.
    pub surfaces: &'a [SurfaceEntry],
    /// The tables. Of several of one kind the first counts. The `baked` form evaluates D in closed form for layers without a tile of a
    /// distribution table.
    pub tables: Vec<TableFace>,
    /// Groups of functions in its shaders.
    pub functions: Functions,
    /// Names and places in the program that the shaders are for.
    pub names: Names,
}

/// Places of materials in a buffer that has others, too.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Within {
    /// The number of each.
    pub numbers: Vec<u32>,
    /// Words of the whole buffer.
    pub words: usize,
}

impl<'a> MaterialSet<'a> {
    /// Materials and tables, for shaders of `luthier_eval` alone.
    pub fn new(materials: &'a [MaterialEntry], tables: Vec<TableFace>) -> Self {
        Self {
            materials: materials.into(),
            within: None,
            surfaces: &[],
            tables,
            functions: Functions::default(),
            names: Names::default(),
        }
    }

    /// Names of the textures of tables with more than 4 bytes a texel: their filtered reads cost more.
    pub fn wide_textures(&self) -> Vec<String> {
        let wide = self.tables.iter().filter(|table| table.format.texel_bytes() > 4);
        wide.map(|table| format!("luthier_{}", table.kind.name())).collect()
    }

    /// All materials, tables and groups of functions of a bake. Names are luthier's own.
    pub fn from_manifest(manifest: &'a Manifest) -> Self {
        let tables = manifest.tables.iter();
        let faces = tables.map(|t| TableFace { kind: t.kind, layout: t.layout.clone(), format: t.format });
        Self {
            materials: manifest.materials.as_slice().into(),
            within: None,
            surfaces: &manifest.surfaces,
            tables: faces.collect(),
            functions: manifest.functions.clone(),
            names: Names::default(),
        }
    }

    /// The materials whose models have a form, with the numbers and the buffer of all; none if there are none. Surfaces of others are left out, and
    /// all with them: their numbers are their places.
    #[must_use]
    pub fn in_form(&self, form: Form) -> Self {
        let has = |material: &MaterialEntry| material.model.has(form);
        if self.materials.iter().all(has) {
            return self.clone();
        }
        let kept = (0u32..).zip(&*self.materials).filter(|(_, material)| has(material));
        let (numbers, materials): (Vec<u32>, Vec<MaterialEntry>) =
            kept.map(|(i, material)| (i, material.clone())).unzip();
        let mut chosen = self.surfaces.iter().flat_map(SurfaceEntry::all_cells).flat_map(|cells| &cells.materials);
        let surfaces = if chosen.all(|number| numbers.contains(number)) { self.surfaces } else { &[] };
        let within = Some(Within { numbers, words: self.words() });
        Self { materials: materials.into(), within, surfaces, ..self.clone() }
    }

    /// The number of a material, by its place in the set.
    pub(crate) fn number(&self, place: usize) -> u32 {
        self.within.as_ref().map_or(place as u32, |within| within.numbers[place])
    }

    /// All records of all materials, in the order of the buffer.
    pub(crate) fn layers(&self) -> impl Iterator<Item = &LayerRecord> {
        self.materials.iter().flat_map(MaterialEntry::records)
    }

    /// The models in use, in the order of their numbers.
    pub(crate) fn models(&self) -> impl Iterator<Item = ShadingModel> {
        ShadingModel::ALL.into_iter().filter(|&model| self.materials.iter().any(|m| m.model == model))
    }

    /// Whether shaders of a form show the environment: they were asked to, and some material with an interface has the form.
    pub(crate) fn shows_environment(&self, form: Form) -> bool {
        let mut shown = self.materials.iter().filter(|material| material.model.facts().forms.contains(&form));
        self.functions.has(FunctionGroup::Environment)
            && shown.any(|material| material.layers.first().is_some_and(|layer| layer.kind != LayerKind::Diffuse))
    }

    /// Words of the material buffer.
    pub(crate) fn words(&self) -> usize {
        let blocks = || self.materials.iter().map(MaterialEntry::blocks).sum::<usize>();
        let own = || self.materials.len() * MATERIAL_WORDS + blocks() * LAYER_WORDS;
        self.within.as_ref().map_or_else(own, |within| within.words)
    }

    /// Whether the set has a table.
    pub(crate) fn has(&self, kind: TableKind) -> bool {
        self.tables.iter().any(|table| table.kind == kind)
    }

    /// The tables that a form reads, in binding order.
    pub(crate) fn tables_read(&self, form: Form) -> impl Iterator<Item = &TableFace> {
        TableKind::ALL
            .into_iter()
            .filter(move |&kind| form == Form::Baked && self.layers().any(|layer| layer.tiles[kind].is_some()))
            .filter_map(|kind| self.tables.iter().find(|t| t.kind == kind))
    }

    /// The identifiers of the materials, in order.
    pub(crate) fn constants(&self) -> Result<Vec<String>, ShaderError> {
        let mut seen: BTreeMap<String, &str> = BTreeMap::new();
        let mut constants = Vec::with_capacity(self.materials.len());
        for material in &*self.materials {
            let constant = identifier(&material.name)?;
            if let Some(first) = seen.insert(constant.clone(), &material.name) {
                let (first, second) = (first.to_owned(), material.name.clone());
                return Err(ShaderError::NameClash { first, second, constant });
            }
            constants.push(constant);
        }
        Ok(constants)
    }

    /// The identifiers of the surfaces, in order.
    pub(crate) fn surface_constants(&self) -> Result<Vec<String>, ShaderError> {
        let mut constants: Vec<String> = Vec::with_capacity(self.surfaces.len());
        for surface in self.surfaces {
            let constant = surface_identifier(&surface.name)?;
            if let Some(first) = constants.iter().position(|other| *other == constant) {
                let (first, second) = (self.surfaces[first].name.clone(), surface.name.clone());
                return Err(ShaderError::NameClash { first, second, constant });
            }
            constants.push(constant);
        }
        Ok(constants)
    }

    /// Refuses surfaces with cells of no material, of too many, or of one that the set lacks.
    fn check_surfaces(&self) -> Result<(), ShaderError> {
        let count = self.materials.len() as u32;
        let has = |number: u32| self.within.as_ref().map_or(number < count, |within| within.numbers.contains(&number));
        for surface in self.surfaces {
            let lists = surface.all_cells().map(|cells| cells.materials.as_slice());
            if lists.clone().any(|list| list.is_empty() || list.len() > CHOICES_MAX) {
                return Err(ShaderError::Choices { surface: surface.name.clone(), limit: CHOICES_MAX });
            }
            if let Some(&material) = lists.flatten().find(|material| !has(**material)) {
                return Err(ShaderError::NoMaterial { surface: surface.name.clone(), material, count });
            }
        }
        Ok(())
    }

    /// Refuses a set whose layers the emitted functions cannot all evaluate.
    pub(crate) fn check(&self, form: Form) -> Result<(), ShaderError> {
        if self.materials.is_empty() {
            return Err(ShaderError::NoMaterials);
        }
        self.check_surfaces()?;
        let words = self.words();
        if words > BUFFER_WORDS_MAX {
            return Err(ShaderError::BufferTooLarge { words, limit: BUFFER_WORDS_MAX });
        }
        for material in &*self.materials {
            if material.layers.is_empty() {
                return Err(ShaderError::NoLayers(material.name.clone()));
            }
            if !material.model.has(form) {
                return Err(ShaderError::NoForm { material: material.name.clone(), model: material.model, form });
            }
            for (i, layer) in material.layers.iter().enumerate() {
                self.check_layer(form, material, i, layer, |kind| reads(material.model, kind, &material.layers, i))?;
            }
            if let Some(bare) = material.records().nth(material.layers.len()) {
                // Kinds without a slot have one tile for the whole material, which its first layer names.
                self.check_layer(form, material, material.layers.len(), bare, |kind| {
                    kind.facts().slot.is_some() && reads(material.model, kind, std::slice::from_ref(bare), 0)
                })?;
            }
        }
        Ok(())
    }

    /// Whether layers that read a table need a tile of it.
    fn needs(&self, table: TableKind) -> bool {
        match table {
            // Without any tile of phases, shaders compute the phases of films.
            TableKind::Phase => self.layers().any(|layer| layer.tiles[TableKind::Phase].is_some()),
            _ => !table.facts().is_optional && table.facts().values != Values::Picture,
        }
    }

    fn check_layer(
        &self,
        form: Form,
        material: &MaterialEntry,
        i: usize,
        layer: &LayerRecord,
        reads: impl Fn(TableKind) -> bool,
    ) -> Result<(), ShaderError> {
        if form == Form::Full {
            return Ok(());
        }
        for table in TableKind::ALL {
            if matches!(table, TableKind::Distribution | TableKind::Phase) && !self.has(table) {
                continue;
            }
            let tiles = self.tables.iter().find(|t| t.kind == table).map_or(0, |t| t.layout.tiles);
            match layer.tiles[table] {
                None if reads(table) && self.needs(table) => {
                    return Err(ShaderError::NoTile { material: material.name.clone(), layer: i, table });
                }
                Some(tile) if tile >= tiles => {
                    let material = material.name.clone();
                    return Err(ShaderError::TileOutOfRange { material, layer: i, table, tile, tiles });
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// Resources to bind for a form of the shader, with luthier's own names and the numbers of [`MaterialSet::names`]: textures and buffers of tables that are read, the sampler if any of them is filtered, the
/// material buffer, and the environment's.
///
/// ```
/// use luthier_manifest::{LayerKind, LayerRecord, MaterialEntry};
/// use luthier_shader::{Form, MaterialSet, bindings};
///
/// let layer = LayerRecord { kind: LayerKind::Diffuse, ..LayerRecord::default() };
/// let materials = [MaterialEntry { layers: vec![layer], ..MaterialEntry::default() }];
/// let entries = bindings(&MaterialSet::new(&materials, Vec::new()), Form::Full);
/// // The full form computes everything: it reads the material buffer and no table.
/// assert_eq!(entries.iter().map(|entry| entry.name.as_str()).collect::<Vec<_>>(), ["luthier_materials"]);
/// ```
pub fn bindings(set: &MaterialSet<'_>, form: Form) -> Vec<BindingEntry> {
    let mut bindings = Vec::new();
    let mut is_sampled = false;
    for table in set.tables_read(form) {
        is_sampled |= table.format.is_filterable();
        let resource = if table.format.has_steps() { BindingEntry::STEPS } else { "texture_2d<f32>" };
        bindings.push(entry(table.kind.binding(), &format!("luthier_{}", table.kind.name()), resource));
    }
    if is_sampled {
        bindings.push(entry(SAMPLER_BINDING, "luthier_sampler", "sampler"));
    }
    bindings.push(entry(MATERIALS_BINDING, "luthier_materials", BindingEntry::BUFFER));
    if set.shows_environment(form) {
        bindings.extend(ENVIRONMENT_BINDINGS.map(|(binding, name, resource)| entry(binding, name, resource)));
    }
    bindings.iter_mut().for_each(|entry| entry.binding += set.names.first_binding);
    bindings
}

fn entry(binding: u32, name: &str, resource: &str) -> BindingEntry {
    BindingEntry { binding, name: name.to_owned(), resource: resource.to_owned() }
}

/// Constants of the shaders themselves, which no material may get.
const TAKEN: [&str; 1] = ["LUTHIER_MATERIAL_WORDS"];

/// The constant of a material in shaders. `_ID` follows a last digit, because naga adds an underscore to names that end in one. It also
/// follows `WORDS`, because shaders have a constant of that name.
///
/// ```
/// use luthier_shader::identifier;
///
/// assert_eq!(identifier("red-lacquer").unwrap(), "LUTHIER_MATERIAL_RED_LACQUER");
/// assert_eq!(identifier("film-2").unwrap(), "LUTHIER_MATERIAL_FILM_2_ID");
/// assert!(identifier("red lacquer").is_err());
/// ```
///
/// # Errors
/// [`ShaderError::Name`] for a name with other characters than letters, digits, hyphens and underscores, or with neither letter nor digit.
pub fn identifier(name: &str) -> Result<String, ShaderError> {
    constant("MATERIAL", name)
}

/// The constant of a surface in shaders: `LUTHIER_SURFACE_LEPIDOLITE` for `lepidolite`, otherwise as [`identifier`].
///
/// # Errors
/// As [`identifier`].
pub fn surface_identifier(name: &str) -> Result<String, ShaderError> {
    constant("SURFACE", name)
}

fn constant(kind: &str, name: &str) -> Result<String, ShaderError> {
    let words: Vec<&str> = name.split(['-', '_']).filter(|word| !word.is_empty()).collect();
    if words.is_empty() || !name.chars().all(|c| is_of_word(c) || c == '-') {
        return Err(ShaderError::Name(name.to_owned()));
    }
    let mut constant = format!("LUTHIER_{kind}_{}", words.join("_").to_ascii_uppercase());
    if constant.ends_with(|c: char| c.is_ascii_digit()) || TAKEN.contains(&constant.as_str()) {
        constant.push_str("_ID");
    }
    Ok(constant)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_are_upper_case_and_end_in_a_letter() {
        for (name, expected) in [
            ("red-lacquer", "LUTHIER_MATERIAL_RED_LACQUER"),
            ("granier-film-2", "LUTHIER_MATERIAL_GRANIER_FILM_2_ID"),
            ("a--b-", "LUTHIER_MATERIAL_A_B"),
            ("words-of-gold", "LUTHIER_MATERIAL_WORDS_OF_GOLD"),
        ] {
            assert_eq!(identifier(name).unwrap(), expected);
            assert_eq!(surface_identifier(name).unwrap(), expected.replace("MATERIAL", "SURFACE"));
        }
        assert_eq!(identifier("Words").unwrap(), "LUTHIER_MATERIAL_WORDS_ID");
        assert_eq!(surface_identifier("words").unwrap(), "LUTHIER_SURFACE_WORDS");
        for name in ["", "-", "sp ace", "émail", "a;b"] {
            assert!(matches!(identifier(name), Err(ShaderError::Name(_))), "{name}");
        }
    }
}
