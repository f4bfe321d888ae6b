//! Materials of glTF as numbers at places, as the format means them: nothing is changed for a material file.

use std::io;

use luthier_lut::srgb;
use luthier_mesh::Asset;

use super::document::{Anisotropy, Clearcoat, Material, Metallic, Specular, Texture};
use super::surface::{NONE_OF_REFLECTANCE, UNIT};
use super::textures::{Textures, placed};
use crate::rules::{self, F0};
use crate::{ImportError, gltf::materials};

/// A material of glTF at a place: factors times texels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GltfPoint {
    /// Base colour, linear.
    pub base_color: [f64; 3],
    /// Share of the metal.
    pub metallic: f64,
    /// Slope parameters along and across the direction of anisotropy.
    pub alpha: [f64; 2],
    /// Angle from the tangent of the surface to that direction, radians.
    pub turn: f64,
    /// F0 of the plastic: `min(((n - 1) / (n + 1))^2 specularColor, 1)`.
    pub f0: [f64; 3],
    /// Factor on all that its interface reflects.
    pub specular: f64,
    /// Weight and slope parameter of a clear coat.
    pub coat: Option<[f64; 2]>,
}

/// A material at some places.
#[derive(Debug, Clone, PartialEq)]
pub struct GltfPoints {
    /// Its name in the file.
    pub name: String,
    /// One for each place.
    pub points: Vec<GltfPoint>,
    /// Extensions that change its reflectance and are not in the numbers, and pictures that cannot be read: white stands for these.
    pub left_out: Vec<String>,
}

/// The materials of a glTF 2.0 file as numbers of the core and of `KHR_materials_clearcoat`, `_ior`, `_specular` and `_anisotropy`, in the order of the file.
/// `places` are the texture coordinates that a material is asked at, by its number. Textures repeat, are bilinear, and are placed by
/// `KHR_texture_transform`; all have the one set of coordinates. Normals are left out.
///
/// ```
/// let text = br#"{"asset": {"version": "2.0"}, "materials": [{"pbrMetallicRoughness": {"roughnessFactor": 0.5}}]}"#;
/// let none = |_: &str| Err(std::io::ErrorKind::NotFound.into());
/// let found = luthier_import::gltf_points(text, &none, &|_| vec![[0.5, 0.5]]).unwrap();
/// assert_eq!(found[0].points[0].alpha, [0.25, 0.25]);
/// ```
///
/// # Errors
/// As [`gltf`](crate::gltf).
pub fn gltf_points(
    bytes: &[u8],
    files: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    places: &dyn Fn(usize) -> Vec<[f64; 2]>,
) -> Result<Vec<GltfPoints>, ImportError> {
    let asset = Asset::open(bytes, files)?;
    let mut textures = Textures::new(&asset);
    let named = materials(&asset)?.into_iter().enumerate();
    let found = named.map(|(number, (name, material))| {
        let places = places(number);
        let mut reading = Reading { textures: &mut textures, places: &places, left_out: Vec::new() };
        let points = reading.points(&material);
        GltfPoints { name, points, left_out: reading.left_out }
    });
    Ok(found.collect())
}

struct Reading<'r, 'a> {
    textures: &'r mut Textures<'a>,
    places: &'r [[f64; 2]],
    left_out: Vec<String>,
}

impl Reading<'_, '_> {
    fn points(&mut self, material: &Material) -> Vec<GltfPoint> {
        let extensions = &material.extensions;
        let Metallic { base_color_factor: [r, g, b, _], metallic_factor, roughness_factor, .. } =
            material.pbr_metallic_roughness;
        let base = [r, g, b].map(unit);
        let colors = self.texels("baseColorTexture", material.pbr_metallic_roughness.base_color_texture.as_ref(), true);
        let surfaces = self.texels(
            "metallicRoughnessTexture",
            material.pbr_metallic_roughness.metallic_roughness_texture.as_ref(),
            false,
        );
        let no_coat = Clearcoat::default();
        let coat = extensions.clearcoat.as_ref().filter(|coat| coat.clearcoat_factor > 0.0);
        let given = coat.unwrap_or(&no_coat);
        let weights = self.texels("clearcoatTexture", given.clearcoat_texture.as_ref(), false);
        let rough = self.texels("clearcoatRoughnessTexture", given.clearcoat_roughness_texture.as_ref(), false);
        let of_ior = extensions.ior.as_ref().map_or(F0, |ior| rules::f0(ior.ior));
        let none = Specular::default();
        let given_specular = extensions.specular.as_ref().unwrap_or(&none);
        let tints = self.texels("specularColorTexture", given_specular.specular_color_texture.as_ref(), true);
        let speculars = self.texels("specularTexture", given_specular.specular_texture.as_ref(), false);
        let isotropic = Anisotropy::default();
        let anisotropy = extensions.anisotropy.as_ref().filter(|found| found.anisotropy_strength > 0.0);
        let anisotropy = anisotropy.unwrap_or(&isotropic);
        let directions = self.texels("anisotropyTexture", anisotropy.anisotropy_texture.as_ref(), false);
        self.others(material);
        let point = |n: usize| {
            let [direction, surface] = [directions[n], surfaces[n]];
            let turn = match anisotropy.anisotropy_texture {
                Some(_) => libm::atan2(2.0 * direction[1] - 1.0, 2.0 * direction[0] - 1.0),
                None => 0.0,
            };
            let strength = unit(anisotropy.anisotropy_strength) * direction[2];
            GltfPoint {
                base_color: [0, 1, 2].map(|c: usize| base[c] * colors[n][c]),
                metallic: unit(metallic_factor) * surface[2],
                alpha: rules::gltf_alphas(unit(roughness_factor) * surface[1], strength),
                turn: anisotropy.anisotropy_rotation + turn,
                f0: [0, 1, 2]
                    .map(|c: usize| (of_ior * given_specular.specular_color_factor[c].max(0.0) * tints[n][c]).min(1.0)),
                specular: unit(given_specular.specular_factor) * speculars[n][3],
                coat: coat.map(|coat| {
                    let roughness = unit(coat.clearcoat_roughness_factor) * rough[n][1];
                    [unit(coat.clearcoat_factor) * weights[n][0], roughness * roughness]
                }),
            }
        };
        (0..self.places.len()).map(point).collect()
    }

    /// The texels at all places; white where there is none.
    fn texels(&mut self, property: &str, texture: Option<&Texture>, is_srgb: bool) -> Vec<[f64; 4]> {
        let white = vec![[1.0; 4]; self.places.len()];
        let Some(texture) = texture else { return white };
        match self.textures.texels(texture) {
            Ok(texels) => {
                let meant = |[r, g, b, a]: [f64; 4]| {
                    let [r, g, b] = [r, g, b].map(|v| if is_srgb { f64::from(srgb::linear(v as f32)) } else { v });
                    [r, g, b, a]
                };
                self.places.iter().map(|uv| texels.filtered(placed(texture, *uv), meant)).collect()
            }
            Err(reason) => {
                self.left_out.push(format!("{property}: {reason}"));
                white
            }
        }
    }

    /// Names the extensions that change a reflectance and are not in the numbers.
    fn others(&mut self, material: &Material) {
        let extensions = &material.extensions;
        let has_film = extensions.iridescence.as_ref().is_some_and(|film| film.iridescence_factor > 0.0);
        let is_clear = extensions.transmission.as_ref().is_some_and(|found| found.transmission_factor > 0.0);
        let known = [("KHR_materials_iridescence", has_film), ("KHR_materials_transmission", is_clear)];
        self.left_out.extend(known.iter().filter(|(_, is_there)| *is_there).map(|(name, _)| (*name).to_owned()));
        let others = extensions.others.keys().filter(|name| !NONE_OF_REFLECTANCE.contains(&name.as_str()));
        self.left_out.extend(others.cloned());
    }
}

/// A number held to the range of shares.
fn unit(value: f64) -> f64 {
    let [least, most] = UNIT;
    value.clamp(least, most)
}
