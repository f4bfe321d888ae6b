//! Numbers of a material in a format. Formats have these in common, each with its own meaning of roughness and anisotropy.

use luthier_optics::Rgb;

/// Numbers of a material.
#[derive(Debug, Clone, PartialEq)]
pub struct Numbers {
    /// Colour of the diffuse base, and F0 of the metal; linear Rec.709, 0 to 1.
    pub base_color: Rgb,
    /// Share of the metal.
    pub metallic: f64,
    /// Roughness of the diffuse base by the measure of the format; glTF has none.
    pub diffuse_roughness: f64,
    /// Factor on what the dielectric's interface reflects: `specularFactor`, `specular_weight`, `specular`.
    pub specular: f64,
    /// Its colour: `specularColorFactor`, `specular_color`. Of a metal the edge of OpenPBR and of Standard Surface.
    pub specular_color: Rgb,
    /// Index of the dielectric.
    pub ior: f64,
    /// Roughness by the measure of the format.
    pub roughness: f64,
    /// Anisotropy by the measure of the format.
    pub anisotropy: f64,
    /// Angle from the tangent to the direction of anisotropy, counter-clockwise, radians.
    pub turn: f64,
    /// The coat.
    pub coat: Option<Coat>,
    /// The film on the base.
    pub film: Option<Film>,
}

/// Numbers of a coat.
#[derive(Debug, Clone, PartialEq)]
pub struct Coat {
    /// Share of the surface that it covers.
    pub weight: f64,
    /// Transmittance to and fro along the normal, RGB; glTF has none.
    pub color: Rgb,
    /// Roughness by the measure of the format.
    pub roughness: f64,
    /// Anisotropy by the measure of the format; glTF has none.
    pub anisotropy: f64,
    /// Angle from the tangent to the direction of anisotropy, counter-clockwise, radians.
    pub turn: f64,
    /// Index; 1.5 in glTF.
    pub ior: f64,
    /// Whether the base is darker for the light that comes back to it: `coat_darkening` of OpenPBR.
    pub darkens: bool,
}

/// Numbers of a film.
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    /// Share of the surface that it covers.
    pub weight: f64,
    /// Index.
    pub ior: f64,
    /// Least and greatest thickness, nm; equal without a map.
    pub thickness_nm: [f64; 2],
}

impl Numbers {
    /// A white dielectric of index 1.5, smooth and without a coat.
    pub(crate) fn plain() -> Self {
        Self {
            base_color: [1.0; 3],
            metallic: 0.0,
            diffuse_roughness: 0.0,
            specular: 1.0,
            specular_color: [1.0; 3],
            ior: 1.5,
            roughness: 0.0,
            anisotropy: 0.0,
            turn: 0.0,
            coat: None,
            film: None,
        }
    }
}
