//! A small bake made here, from the exact terms and the layout rules, and devices with planted errors.

use std::sync::OnceLock;

use glam::DVec3;
use luthier_layers::layers::{self, Below, Layers};
use luthier_layers::models::statistics::diffuse_base::Veil;
use luthier_layers::models::statistics::energy::{Energy, ExactEnergy, FacetCache};
use luthier_layers::models::statistics::total_reflection::escaping_share;
use luthier_layers::monochrome::Monochrome;
use luthier_layers::terms::Terms;
use luthier_layers::twins::real_time::Twin;
use luthier_layers::twins::terms::Exact;
use luthier_lut::{AtlasLayout, Axis, ErrorStats, Image, Mapping, TableKind, TexelFormat, Tile, Worst};
use luthier_manifest::{
    ColorMode, FileEntry, LayerKind, LayerRecord, MANIFEST_SCHEMA, Manifest, MaterialEntry, PlaceValues, ShadingModel,
    TableEntry,
};
use luthier_optics::color::Color;
use luthier_optics::ior::{Ior, IorSample};
use luthier_optics::stack::{Base, Diffuse, Distribution, Layer, Slab, Stack, Surface};
use luthier_report::{Device, Form, Pair, Rows, Subject, TableTerms, Weights};

pub(crate) const WAVELENGTHS_NM: [f64; 3] = [645.0, 525.0, 445.0];

/// Named stacks of the shapes that the model knows.
pub(crate) fn stacks() -> Vec<(&'static str, Stack)> {
    let layer = |surface, base| Layer { films: Vec::new(), surface, base };
    let coat = |alpha, absorption_per_um| {
        let slab = Slab { thickness_um: 50.0, absorption_per_um };
        let ior = Ior::constant(1.5, 0.0).unwrap();
        layer(Surface::isotropic(Distribution::Beckmann, alpha), Base::Dielectric { ior, slab })
    };
    let metal = |distribution, alpha| layer(Surface::isotropic(distribution, alpha), Base::Conductor { ior: copper() });
    let base = |albedo, sigma| layer(Surface::smooth(), Base::Diffuse(Diffuse { albedo, sigma }));
    let stack = |layers| Stack { exterior: Ior::vacuum(), layers };
    vec![
        ("red-lacquer", stack(vec![coat(0.05, [0.0002, 0.012, 0.02]), base([0.8, 0.7, 0.7], 0.0)])),
        ("lacquered-copper", stack(vec![coat(0.02, [0.0, 0.001, 0.002]), metal(Distribution::Ggx, 0.3)])),
        ("copper & <satin>", stack(vec![metal(Distribution::Beckmann, 0.15)])),
        ("plaster", stack(vec![base([0.7, 0.68, 0.62], 0.4)])),
    ]
}

/// Roughly copper's; the shape matters, not the metal.
fn copper() -> Ior {
    let samples = [(400.0, 1.2, 2.2), (550.0, 1.0, 2.6), (600.0, 0.4, 3.0), (700.0, 0.2, 4.1)];
    Ior::sampled(samples.map(|(wavelength_nm, n, k)| IorSample { wavelength_nm, n, k }).to_vec()).unwrap()
}

/// A bake of [`stacks`]: the manifest and the decoded texels.
pub(crate) struct Bake {
    pub(crate) manifest: Manifest,
    pub(crate) textures: Vec<(TableKind, Image)>,
    pub(crate) stacks: Vec<Stack>,
}

impl Bake {
    pub(crate) fn new() -> Self {
        let named = stacks();
        let fresnel_axis = axis("cos_theta", 0.0, 1.0, 128, Mapping::Linear);
        let mut rows = Vec::new();
        let mut materials = Vec::new();
        for (name, stack) in &named {
            let exact = Exact::new(stack, Color::Spectral);
            let mut records = Vec::new();
            for (l, layer) in Layers::isotropic_rgb(stack).layers.iter().enumerate() {
                let mut record = record(layer);
                if record.kind != LayerKind::Diffuse {
                    record.tiles[TableKind::Fresnel] = Some(rows.len() as u32);
                    record.tiles[TableKind::Distribution] =
                        Some(u32::from(layer.surface.distribution == Distribution::Ggx));
                    let row: Vec<_> = (0..128).map(|i| exact.fresnel(l, fresnel_axis.node(i))).collect();
                    rows.push((format!("{name}/{l}"), row));
                }
                records.push(record);
            }
            materials.push(MaterialEntry {
                name: (*name).to_owned(),
                source: format!("materials/{name}.toml"),
                class: "c".to_owned(),
                wavelengths_nm: WAVELENGTHS_NM,
                layers: records,
                ..MaterialEntry::default()
            });
        }
        let layout = AtlasLayout {
            x: fresnel_axis,
            y: None,
            apron: 0,
            columns: 1,
            tiles: rows.len() as u32,
            base: luthier_lut::RowBase::Zero,
        };
        let mut fresnel = Image::zeros(128, rows.len() as u32, 4);
        for (y, (_, row)) in (0..).zip(&rows) {
            for (x, rgb) in (0..).zip(row) {
                fresnel.texel_mut(x, y).copy_from_slice(&[rgb[0] as f32, rgb[1] as f32, rgb[2] as f32, 1.0]);
            }
        }
        let names = rows.into_iter().map(|(name, _)| name).collect();
        let (fresnel_table, fresnel) = table(TableKind::Fresnel, layout, TexelFormat::Rgba16Float, names, &fresnel);
        let (distribution_table, distribution) = distribution();
        let manifest = Manifest {
            schema: MANIFEST_SCHEMA,
            generator: "fixture 1".to_owned(),
            materials,
            surfaces: Vec::new(),
            tables: vec![fresnel_table, distribution_table],
            searches: Vec::new(),
            choice: None,
            shaders: Vec::new(),
            functions: luthier_manifest::Functions::default(),
            names: luthier_manifest::Names::default(),
            bindings: Vec::new(),
            material_buffer: FileEntry::default(),
            material_texture: luthier_manifest::MaterialTexture::default(),
        };
        let textures = vec![(TableKind::Fresnel, fresnel), (TableKind::Distribution, distribution)];
        Self { manifest, textures, stacks: named.into_iter().map(|(_, stack)| stack).collect() }
    }

    /// A bake with tables that statistical models read: albedos at 16 x 6 nodes, one tile for each of the surfaces in turn, and shares that
    /// escape through a coat of n = 1.5.
    pub(crate) fn statistical(model: ShadingModel) -> Self {
        let mut bake = Self::new();
        let alpha_axis = axis("alpha", 0.0, 1.0, 6, Mapping::Power { exponent: 3.0 });
        let x = axis("cos_theta", 0.0, 1.0, 16, Mapping::Power { exponent: 2.0 });
        // The same for every model, and some seconds of work.
        static TILES: OnceLock<Vec<Vec<[f64; 3]>>> = OnceLock::new();
        let tiles = TILES.get_or_init(|| {
            let mut tiles = Vec::new();
            for stack in &bake.stacks {
                for l in (0..stack.layers.len()).filter(|&l| !matches!(stack.layers[l].base, Base::Diffuse(_))) {
                    let alphas = (0..alpha_axis.size).map(|j| alpha_axis.node(j));
                    tiles.push(alphas.flat_map(|alpha| albedos(stack, l, alpha, &x)).collect());
                }
            }
            tiles
        });
        let mut tile = 0..;
        for material in &mut bake.manifest.materials {
            material.model = model;
            for record in material.layers.iter_mut().filter(|r| r.kind != LayerKind::Diffuse) {
                record.tiles[TableKind::Fgd] = tile.next();
                let is_above_metal = record.kind == LayerKind::Dielectric && material.name == "lacquered-copper";
                record.tiles[TableKind::Escape] = is_above_metal.then_some(0);
            }
            material.color = ColorMode::ThreeWavelengths;
            material.constants.internal_reflectance = [0.6; 3];
        }
        let layout = AtlasLayout {
            x,
            y: Some(alpha_axis),
            apron: 0,
            columns: 1,
            tiles: tiles.len() as u32,
            base: luthier_lut::RowBase::Zero,
        };
        let image = filled(&layout, |tile, i, j| tiles[tile as usize][(j * layout.x.size + i) as usize]);
        bake.push(TableKind::Fgd, layout, &image);
        let layout = AtlasLayout {
            x: axis("cos_theta", 0.0, 1.0, 32, Mapping::Linear),
            y: Some(axis("alpha", 0.0, 1.0, 16, Mapping::Power { exponent: 2.0 })),
            apron: 0,
            columns: 1,
            tiles: 1,
            base: luthier_lut::RowBase::Zero,
        };
        let alpha_axis = layout.y.clone().unwrap();
        let image = filled(&layout, |_, i, j| {
            let cos = layout.x.node(i);
            let inside = (1.0 - (1.0 - cos * cos) / 2.25).sqrt();
            [escaping_share(inside, alpha_axis.node(j), 1.0 / 1.5); 3]
        });
        bake.push(TableKind::Escape, layout, &image);
        bake
    }

    /// The texels of a table.
    pub(crate) fn texels(&mut self, kind: TableKind) -> &mut [f32] {
        &mut self.textures.iter_mut().find(|(k, _)| *k == kind).unwrap().1.data
    }

    fn push(&mut self, kind: TableKind, layout: AtlasLayout, truth: &Image) {
        let names = (0..layout.tiles).map(|tile| format!("{}-{tile}", kind.name())).collect();
        let (entry, texels) = table(kind, layout, TexelFormat::Rgba16Float, names, truth);
        self.manifest.tables.push(entry);
        self.textures.push((kind, texels));
    }

    pub(crate) fn subject(&self) -> Subject<'_> {
        Subject {
            manifest: &self.manifest,
            textures: self.textures.clone(),
            stacks: self.stacks.clone(),
            maps: Vec::new(),
            films: Vec::new(),
        }
    }

    /// A device with f64 inside and f32 at its ends: reads the tables with exact weights, and spoils each value with
    /// `spoil`.
    pub(crate) fn device<S: Fn(Form, u32, usize, [f32; 3]) -> [f32; 3]>(&self, spoil: S) -> FakeDevice<'_, S> {
        FakeDevice { subject: self.subject(), spoil, baked_reads_tables: true }
    }
}

/// Albedos of an interface of a stack at three wavelengths, of another slope parameter, at the nodes over the cosine.
fn albedos(stack: &Stack, layer: usize, alpha: f64, cosines: &Axis) -> Vec<[f64; 3]> {
    let mut stack = stack.clone();
    stack.layers[layer].surface = Surface::isotropic(stack.layers[layer].surface.distribution, alpha);
    let mut facets = FacetCache::default();
    let energies =
        [0, 1, 2].map(|c: usize| ExactEnergy::with_facets(&Monochrome::new(&stack, WAVELENGTHS_NM[c], c), &mut facets));
    let at = |i| energies.each_ref().map(|energy| energy.fgd(layer, cosines.node(i), alpha)[0]);
    (0..cosines.size).map(at).collect()
}

/// Texels of an atlas of one column: RGB of tile, column and row.
fn filled(layout: &AtlasLayout, texel: impl Fn(u32, u32, u32) -> [f64; 3]) -> Image {
    let [width, height] = layout.size();
    let [_, tile_height] = layout.tile_size();
    let mut image = Image::zeros(width, height, 4);
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let [r, g, b] = texel(y / tile_height, x, y % tile_height).map(|v| v as f32);
        image.texel_mut(x, y).copy_from_slice(&[r, g, b, 1.0]);
    }
    image
}

pub(crate) struct FakeDevice<'a, S> {
    subject: Subject<'a>,
    spoil: S,
    /// Whether the baked form reads tables; otherwise it evaluates the exact spectral terms: a device without table error.
    pub(crate) baked_reads_tables: bool,
}

impl<S: Fn(Form, u32, usize, [f32; 3]) -> [f32; 3]> Device for FakeDevice<'_, S> {
    fn name(&self) -> String {
        "Fake & Sons <f64>".to_owned()
    }

    fn identity(&self) -> String {
        self.name()
    }

    fn evaluate(&self, form: Form, material: u32, pairs: &[Pair]) -> Result<Vec<[f32; 3]>, String> {
        let stack = &self.subject.stacks[material as usize];
        let entry = &self.subject.manifest.materials[material as usize];
        let (model, constants) = (entry.model, &entry.constants);
        let twin = Twin::new(model, stack, WAVELENGTHS_NM, Color::Spectral);
        let tables = TableTerms::new(&self.subject, material as usize, Weights::Exact).map_err(|e| e.to_string())?;
        let spectral = Exact::new(stack, Color::Spectral);
        let veil = Veil { internal: constants.internal_reflectance, upward: [1.0 - constants.upward_loss; 3] };
        let three = Exact::level(stack, Color::ThreeWavelengths(WAVELENGTHS_NM), veil);
        let wide = |w: [f32; 3]| DVec3::from(w.map(f64::from));
        let value = |(n, &(wi, wo)): (usize, &Pair)| {
            let value = match form {
                Form::Baked if self.baked_reads_tables => twin.eval(&tables, wide(wi), wide(wo)),
                Form::Baked => twin.eval(&spectral, wide(wi), wide(wo)),
                Form::Full => twin.eval(&three, wide(wi), wide(wo)),
            };
            (self.spoil)(form, material, n, value.map(|v| v as f32))
        };
        Ok(pairs.iter().enumerate().map(value).collect())
    }

    fn evaluate_at(&self, form: Form, material: u32, spots: &[(PlaceValues, Pair)]) -> Result<Vec<[f32; 3]>, String> {
        let wide = |w: [f32; 3]| DVec3::from(w.map(f64::from));
        let value = |(n, (place, (wi, wo))): (usize, &(PlaceValues, Pair))| {
            let rows = Rows::new(&self.subject, material as usize, place, Weights::Exact).map_err(|e| e.to_string())?;
            let value = rows.eval(wide(*wi), wide(*wo));
            Ok((self.spoil)(form, material, n, value.map(|v| v as f32)))
        };
        spots.iter().enumerate().map(value).collect()
    }
}

pub(crate) fn axis(quantity: &str, min: f64, max: f64, size: u32, mapping: Mapping) -> Axis {
    Axis { quantity: quantity.to_owned(), unit: String::new(), min, max, size, mapping }
}

/// Beckmann and GGX side by side, from their textbook forms.
fn distribution() -> (TableEntry, Image) {
    let half_pi = std::f64::consts::FRAC_PI_2;
    let x = axis("theta_h", 0.0, half_pi, 512, Mapping::Power { exponent: 8.0 });
    let y = axis("alpha", 1e-3, 1.0, 512, Mapping::Logarithmic);
    let layout =
        AtlasLayout { x, y: Some(y.clone()), apron: 0, columns: 2, tiles: 2, base: luthier_lut::RowBase::Zero };
    let mut image = Image::zeros(1024, 512, 1);
    for j in 0..512 {
        let alpha = y.node(j);
        for i in 0..512 {
            let tan = libm::tan(layout.x.node(i));
            let cos_sq = 1.0 / (1.0 + tan * tan);
            let slope_sq = (tan / alpha) * (tan / alpha);
            let beckmann = if i == 511 { 0.0 } else { libm::exp(-slope_sq) / (cos_sq * cos_sq) };
            let inverse = cos_sq * (1.0 + slope_sq);
            let ggx = 1.0 / (inverse * inverse);
            image.texel_mut(i, j)[0] = beckmann as f32;
            image.texel_mut(512 + i, j)[0] = ggx as f32;
        }
    }
    let names = vec!["beckmann".to_owned(), "ggx".to_owned()];
    table(TableKind::Distribution, layout, TexelFormat::R16Float, names, &image)
}

pub(crate) fn table(
    kind: TableKind,
    layout: AtlasLayout,
    format: TexelFormat,
    names: Vec<String>,
    truth: &Image,
) -> (TableEntry, Image) {
    let bytes = format.encode(truth);
    let texels = format.decode(truth.width, truth.height, &bytes).unwrap();
    let file =
        |extension: &str| FileEntry { path: format!("tables/{}.{extension}", kind.name()), sha256: String::new() };
    let at = vec![0.0; if layout.y.is_some() { 2 } else { 1 }];
    let tile = |name| Tile {
        name,
        model: "from the fixture".to_owned(),
        input_hash: String::new(),
        // Generous, so that the judge has nothing to find.
        error: ErrorStats {
            max_abs_err: 0.5,
            rms_err: 0.1,
            p99_abs_err: 0.2,
            slack: 0.0,
            worst: Worst { at: at.clone(), channel: 0, expected: 0.5, sampled: 1.0 },
            points: 1,
        },
        aim: None,
        largest: None,
    };
    let entry = TableEntry {
        kind,
        layout,
        format,
        texel_bytes: bytes.len() as u64,
        texture: file("ktx2"),
        truth: file("exr"),
        picture: file("png"),
        tiles: names.into_iter().map(tile).collect(),
    };
    (entry, texels)
}

fn record(layer: &layers::Layer) -> LayerRecord {
    let mut record = LayerRecord {
        kind: LayerKind::Conductor,
        distribution: layer.surface.distribution,
        alpha: layer.surface.alpha_x,
        alpha_xy: [layer.surface.alpha_x; 2],
        eta: 1.0,
        ior_n: [1.0; 3],
        ..LayerRecord::default()
    };
    match layer.below {
        Below::Conductor => {}
        Below::Dielectric { optical_depth, .. } => {
            (record.kind, record.eta, record.optical_depth) = (LayerKind::Dielectric, layer.eta(), optical_depth);
        }
        Below::Diffuse { albedo, sigma } => {
            (record.kind, record.albedo, record.sigma) = (LayerKind::Diffuse, albedo, sigma);
        }
    }
    record
}
