//! Formats by name.

luthier_lut::named! {
    /// A format that takes parameters.
    pub enum Format("format") {
        /// glTF 2.0 with the extensions of Khronos for coats, indices, specular colours, anisotropy and iridescence.
        Gltf = "gltf",
        /// OpenPBR 1.1, as MaterialX 1.39.
        OpenPbr = "openpbr",
        /// Autodesk Standard Surface, as MaterialX 1.39.
        StandardSurface = "standard-surface",
    }
}

impl Format {
    /// Its name in prose.
    pub fn title(self) -> &'static str {
        match self {
            Self::Gltf => "glTF",
            Self::OpenPbr => "OpenPBR",
            Self::StandardSurface => "Standard Surface",
        }
    }

    /// Name of the file that has the materials.
    pub fn file_name(self) -> &'static str {
        match self {
            Self::Gltf => "materials.gltf",
            Self::OpenPbr | Self::StandardSurface => "materials.mtlx",
        }
    }
}
