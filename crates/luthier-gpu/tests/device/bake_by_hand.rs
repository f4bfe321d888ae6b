//! Small bakes written out in tests: layer records, tables of known values, and the shaders that the emitter makes of
//! them.

use luthier_gpu::{Package, Shader};
use luthier_lut::{AtlasLayout, Axis, Image, Mapping, RowBase, TableKind, TexelFormat};
use luthier_manifest::{
    BindingEntry, ColorMode, Distribution, FileEntry, LayerKind, LayerRecord, Manifest, MaterialEntry, TableEntry,
};
use luthier_shader::{Form, MaterialSet, Target};
use luthier_texture::Texture;

/// A table of a bake.
#[derive(Clone)]
pub(crate) struct Table {
    pub(crate) kind: TableKind,
    pub(crate) layout: AtlasLayout,
    pub(crate) format: TexelFormat,
    pub(crate) truth: Image,
}

impl Table {
    /// Fills the tiles, aprons included, from a function of tile and axis values.
    pub(crate) fn new(
        kind: TableKind,
        layout: AtlasLayout,
        format: TexelFormat,
        value: impl Fn(u32, [f64; 2]) -> [f32; 4],
    ) -> Self {
        let [width, height] = layout.size();
        let mut truth = Image::zeros(width, height, 4);
        let [tile_width, tile_height] = layout.tile_size();
        for tile in 0..layout.tiles {
            let [ox, oy] = layout.origin(tile);
            for y in 0..tile_height {
                for x in 0..tile_width {
                    let at =
                        [node(&layout.x, x, layout.apron), layout.y.as_ref().map_or(0.0, |a| node(a, y, layout.apron))];
                    truth.texel_mut(ox + x, oy + y).copy_from_slice(&value(tile, at));
                }
            }
        }
        Self { kind, layout, format, truth }
    }

    /// The texels that the shader reads: rounded to the format.
    pub(crate) fn texels(&self) -> Image {
        self.format.decode(self.truth.width, self.truth.height, &self.format.encode(&self.truth)).unwrap()
    }
}

/// Value of an axis at a texel of a tile; periodic axes go round in the apron.
fn node(axis: &Axis, texel: u32, apron: u32) -> f64 {
    match axis.mapping {
        Mapping::Periodic => axis.node((texel + axis.size - apron) % axis.size),
        _ => axis.node(texel),
    }
}

pub(crate) fn axis(quantity: &str, max: f64, size: u32, mapping: Mapping) -> Axis {
    let min = if mapping == Mapping::Logarithmic { 1e-3 } else { 0.0 };
    Axis { quantity: quantity.to_owned(), unit: String::new(), min, max, size, mapping }
}

/// A layer that all records are variations of: a smooth glass.
/// One row over the cosine.
pub(crate) fn row_layout() -> AtlasLayout {
    AtlasLayout {
        x: axis("cos_theta", 1.0, 8, Mapping::Linear),
        y: None,
        apron: 0,
        columns: 1,
        tiles: 1,
        base: RowBase::Zero,
    }
}

/// One tile over `x`, to 1.5, and alpha.
pub(crate) fn square_layout(x: &str) -> AtlasLayout {
    AtlasLayout { x: axis(x, 1.5, 8, Mapping::Linear), y: Some(axis("alpha", 1.0, 8, Mapping::Linear)), ..row_layout() }
}

pub(crate) fn dielectric(alpha: f64, n: f64) -> LayerRecord {
    LayerRecord {
        kind: LayerKind::Dielectric,
        distribution: Distribution::Ggx,
        alpha,
        eta: n,
        alpha_xy: [alpha; 2],
        ior_n: [n; 3],
        ..LayerRecord::default()
    }
}

pub(crate) fn conductor(alpha: f64, ior_n: [f64; 3], ior_k: [f64; 3]) -> LayerRecord {
    LayerRecord { kind: LayerKind::Conductor, eta: 1.0, ior_n, ior_k, ..dielectric(alpha, 1.0) }
}

pub(crate) fn diffuse(albedo: [f64; 3], sigma: f64) -> LayerRecord {
    LayerRecord { kind: LayerKind::Diffuse, albedo, sigma, ..dielectric(1.0, 1.0) }
}

fn no_file() -> FileEntry {
    FileEntry { path: "none".to_owned(), sha256: String::new() }
}

/// The manifest of a bake, without its shaders and files.
pub(crate) fn manifest(materials: Vec<Vec<LayerRecord>>, tables: &[Table]) -> Manifest {
    let name = |i: usize| format!("m{i}-material");
    let materials = materials
        .into_iter()
        .enumerate()
        .map(|(i, layers)| MaterialEntry {
            name: name(i),
            source: "by hand".to_owned(),
            color: ColorMode::ThreeWavelengths,
            wavelengths_nm: [645.0, 525.0, 445.0],
            layers,
            ..MaterialEntry::default()
        })
        .collect();
    let tables = tables
        .iter()
        .map(|t| TableEntry {
            kind: t.kind,
            layout: t.layout.clone(),
            format: t.format,
            texel_bytes: t.format.encode(&t.truth).len() as u64,
            texture: no_file(),
            truth: no_file(),
            picture: no_file(),
            tiles: Vec::new(),
        })
        .collect();
    Manifest::new("by hand", materials, tables)
}

/// A bake with the emitter's shader of one form.
pub(crate) fn artefacts(form: Form, materials: Vec<Vec<LayerRecord>>, tables: &[Table]) -> Package {
    let mut manifest = manifest(materials, tables);
    let set = MaterialSet::from_manifest(&manifest);
    let wgsl = luthier_shader::emit(&set, form, Target::Wgsl).unwrap();
    let bindings: Vec<BindingEntry> = luthier_shader::bindings(&set, form);
    manifest.bindings = bindings;
    let shaders = vec![Shader::wgsl(form, wgsl)];
    Package::from_parts(manifest, texels(tables), shaders).unwrap()
}

pub(crate) fn texels(tables: &[Table]) -> Vec<luthier_gpu::Table> {
    let texels = |t: &Table| {
        let (width, height) = (t.truth.width, t.truth.height);
        let texture = Texture { format: t.format, width, height, bytes: t.format.encode(&t.truth) };
        luthier_gpu::Table { kind: t.kind, texture, truth: None }
    };
    tables.iter().map(texels).collect()
}
