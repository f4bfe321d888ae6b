//! A package: the result of a bake, in memory.

use std::borrow::Cow;

use luthier_lut::{Image, Picture, TableKind};
use luthier_manifest::{Check, Form, Interface, Manifest, MapSlot, MaterialEntry, Names, Target};
use luthier_texture::Texture;

use crate::PackageError;

/// A bake in memory: the manifest, the texels of its tables, its shaders, the maps of its materials.
///
/// ```
/// use luthier_export::{GENERATOR, Package, Shader};
/// use luthier_manifest::{Form, Manifest};
///
/// let manifest = Manifest::new(GENERATOR, Vec::new(), Vec::new());
/// let shaders = vec![Shader::wgsl(Form::Baked, "fn shade() {}\n".to_owned())];
/// let package = Package { manifest, tables: Vec::new(), shaders, maps: Vec::new() };
/// assert_eq!(package.wgsl(Form::Baked)?, "fn shade() {}\n");
/// assert!(package.wgsl(Form::Full).is_err());
/// # Ok::<(), luthier_export::PackageError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Package {
    /// The manifest. Its entries of files have no hashes until the package is encoded.
    pub manifest: Manifest,
    /// Texels of each table of the manifest, in its order.
    pub tables: Vec<Table>,
    /// The emitted shaders. A package that was read from a folder has those in WGSL only.
    pub shaders: Vec<Shader>,
    /// Maps of the materials, in the manifest's order. Materials without maps are the same at every place.
    pub maps: Vec<Map>,
}

/// The texels of a table.
///
/// ```
/// use luthier_export::Table;
/// use luthier_lut::{TableKind, TexelFormat};
/// use luthier_texture::Texture;
///
/// let texture = Texture { format: TexelFormat::R32Float, width: 1, height: 1, bytes: 0.5_f32.to_le_bytes().to_vec() };
/// let table = Table { kind: TableKind::Distribution, texture, truth: None };
/// assert_eq!(table.texture.image()?.data, [0.5]);
/// # Ok::<(), luthier_texture::TextureError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Kind of the table.
    pub kind: TableKind,
    /// Texels as they ship.
    pub texture: Texture,
    /// The values before they were rounded to texels; `None` where the package was read from a folder.
    pub truth: Option<Image>,
}

/// An emitted shader: functions only, no entry point.
///
/// ```
/// use luthier_export::Shader;
/// use luthier_manifest::Form;
///
/// let text = "fn luthier_layer_count(material: u32) -> u32 {\n    return 1u;\n}\n";
/// let shader = Shader::wgsl(Form::Full, text.to_owned());
/// assert!(shader.interface.function("luthier_layer_count").is_some());
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shader {
    /// The way of evaluating a material.
    pub form: Form,
    /// Its language.
    pub target: Target,
    /// UTF-8 text, or the words of SPIR-V, little-endian.
    pub bytes: Vec<u8>,
    /// Functions, structures and bindings for a program around it.
    pub interface: Interface,
    /// Judges that it passed when it was emitted; empty for a text that was not emitted by luthier.
    pub checks: Vec<Check>,
}

/// A map of a material.
///
/// ```
/// use luthier_export::Map;
/// use luthier_lut::Image;
/// use luthier_manifest::MapSlot;
/// use luthier_texture::{picture, png};
///
/// let png = png::encode_gray(&Image { width: 2, height: 1, channels: 1, data: vec![0.0, 1.0] })?;
/// let picture = picture::decode(&png)?.picture;
/// let map = Map { material: 0, slot: MapSlot::Roughness, layer: None, picture, png };
/// assert_eq!(map.picture.size(), [2, 1]);
/// # Ok::<(), luthier_texture::TextureError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// Number of the material.
    pub material: u32,
    /// Quantity that the map varies.
    pub slot: MapSlot,
    /// The layer that has the map; `None` if the whole surface has it.
    pub layer: Option<u32>,
    /// Its texels.
    pub picture: Picture,
    /// The PNG file.
    pub png: Vec<u8>,
}

impl Shader {
    /// A shader in WGSL, whose interface is read from it, and which no judge has read.
    pub fn wgsl(form: Form, text: String) -> Self {
        let interface = Interface::read(&text);
        Self { form, target: Target::Wgsl, bytes: text.into_bytes(), interface, checks: Vec::new() }
    }

    /// The text; empty for SPIR-V.
    pub fn text(&self) -> &str {
        std::str::from_utf8(&self.bytes).unwrap_or_default()
    }
}

impl Package {
    /// A package of parts in memory, without maps. Tables may come in any order.
    ///
    /// # Errors
    /// [`PackageError::MissingTexels`] and [`PackageError::Table`] where texels do not match the manifest; [`PackageError::NoMaterials`],
    /// [`PackageError::NoLayers`] and [`PackageError::NoSurfaceMaterial`] where it has nothing to shade.
    pub fn from_parts(manifest: Manifest, mut tables: Vec<Table>, shaders: Vec<Shader>) -> Result<Self, PackageError> {
        if manifest.materials.is_empty() {
            return Err(PackageError::NoMaterials);
        }
        if let Some(MaterialEntry { name, .. }) = manifest.materials.iter().find(|m| m.layers.is_empty()) {
            return Err(PackageError::NoLayers { name: name.clone() });
        }
        let count = manifest.materials.len();
        if let Some(surface) = manifest.surfaces.iter().find(|s| s.materials().iter().any(|&m| m as usize >= count)) {
            return Err(PackageError::NoSurfaceMaterial { surface: surface.name.clone() });
        }
        let mut ordered = Vec::with_capacity(manifest.tables.len());
        for entry in &manifest.tables {
            let position = tables.iter().position(|t| t.kind == entry.kind);
            let table = tables.swap_remove(position.ok_or(PackageError::MissingTexels { kind: entry.kind })?);
            let Texture { format, width, height, bytes } = &table.texture;
            entry.check([*width, *height], *format, bytes.len())?;
            ordered.push(table);
        }
        Ok(Self { manifest, tables: ordered, shaders, maps: Vec::new() })
    }

    /// The texels of a table, if the package has it.
    pub fn table(&self, kind: TableKind) -> Option<&Texture> {
        self.tables.iter().find(|t| t.kind == kind).map(|t| &t.texture)
    }

    /// The texels of all tables as a shader reads them.
    ///
    /// # Errors
    /// [`PackageError::Texels`] where bytes are not those of their format.
    pub fn textures(&self) -> Result<Vec<(TableKind, Image)>, PackageError> {
        self.tables.iter().map(|table| Ok((table.kind, table.texture.image()?))).collect()
    }

    /// The WGSL of a form.
    ///
    /// # Errors
    /// [`PackageError::NoShader`].
    pub fn wgsl(&self, form: Form) -> Result<&str, PackageError> {
        self.shader(form).map(Shader::text)
    }

    /// The shader of a form in WGSL.
    ///
    /// # Errors
    /// [`PackageError::NoShader`].
    pub fn shader(&self, form: Form) -> Result<&Shader, PackageError> {
        let texts: Vec<&Shader> = self.shaders.iter().filter(|s| s.target == Target::Wgsl).collect();
        texts.iter().copied().find(|s| s.form == form).ok_or_else(|| PackageError::NoShader {
            form,
            known: texts.iter().map(|s| s.form.name()).collect::<Vec<_>>().join(", "),
        })
    }

    /// The package with luthier's own names in its WGSL, and in its bindings and the interfaces of shaders: what the runtime calls. Texts of other languages stay.
    ///
    /// ```
    /// use luthier_export::{GENERATOR, Package, Shader};
    /// use luthier_manifest::{Form, Manifest, Names};
    ///
    /// let names = Names { prefix: "car".to_owned(), ..Names::default() };
    /// let manifest = Manifest { names, ..Manifest::new(GENERATOR, Vec::new(), Vec::new()) };
    /// let shaders = vec![Shader::wgsl(Form::Baked, "fn car_eval() {}\n".to_owned())];
    /// let package = Package { manifest, tables: Vec::new(), shaders, maps: Vec::new() };
    /// assert_eq!(package.in_own_names().wgsl(Form::Baked)?, "fn luthier_eval() {}\n");
    /// # Ok::<(), luthier_export::PackageError>(())
    /// ```
    pub fn in_own_names(&self) -> Cow<'_, Self> {
        let names = &self.manifest.names;
        if names.is_default() {
            return Cow::Borrowed(self);
        }
        let mut own = self.clone();
        own.manifest.bindings.iter_mut().for_each(|entry| entry.name = names.own(&entry.name));
        for shader in &mut own.shaders {
            names.in_interface(Names::own, &mut shader.interface);
            if shader.target == Target::Wgsl {
                shader.bytes = names.own_wgsl(shader.text()).into_bytes();
            }
        }
        own.manifest.names = Names { first_binding: names.first_binding, ..Names::default() };
        Cow::Owned(own)
    }

    /// Bytes of the texels of all tables.
    pub fn texel_bytes(&self) -> u64 {
        self.manifest.tables.iter().fold(0, |sum: u64, table| sum.saturating_add(table.texel_bytes))
    }
}
