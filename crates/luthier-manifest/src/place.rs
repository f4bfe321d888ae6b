//! Values of a `LuthierPlace`: texels of a material's textures at one place of its surface.

/// Values of textures at one place, as shaders get them. Factors multiply the numbers of the material.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceValues {
    /// Normal, unit, in the frame of the directions.
    pub normal: [f32; 3],
    /// Factor on the slope parameters of every layer.
    pub alpha_factor: f32,
    /// Factor on the thickness of the slab below the first interface.
    pub slab_factor: f32,
    /// Factor on the thickness of the film on the first interface.
    pub film_factor: f32,
    /// Variance, along either axis, of the slopes of the normals that a pixel sees.
    pub slope_variance: f32,
    /// Normal of the lower boundary of the film, unit, in the frame of `normal`.
    pub inner_normal: [f32; 3],
    /// Normal of the layers below the first interface, unit, in the frame of `normal`.
    pub flake_normal: [f32; 3],
    /// Albedo of a diffuse base, RGB; `None` leaves the albedo of the material.
    pub base_color: Option<[f32; 3]>,
    /// Amount of patina, 0 to 1; `None` for a material without patina.
    pub patina: Option<f32>,
    /// Factor on the weight of a coat.
    pub weight_factor: f32,
    /// Base colour and metal of a metallic-roughness surface, if maps have them. The albedo that follows replaces `base_color`.
    pub metallic: Option<([f32; 3], f32)>,
    /// F0 of the dielectric above a diffuse base, RGB; `None` leaves that of the material.
    pub f0: Option<[f32; 3]>,
    /// Values of textures of single layers, from the top down; a missing layer has no textures.
    pub layers: Vec<LayerValues>,
}

/// Values of textures of one layer: `LuthierLayerPlace`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayerValues {
    /// Normal of its interface alone, unit.
    pub normal: [f32; 3],
    /// Factors on its slope parameters along the tangent and along the bitangent.
    pub alpha_factors: [f32; 2],
    /// A texel of its tangent map: `2 texel - 1` is the cosine and the sine of twice the angle of the turn; `[1, 0.5]` is no turn.
    pub tangent: [f32; 2],
    /// Factor on the thickness of the slab below it.
    pub slab_factor: f32,
    /// Factors on what that slab absorbs, RGB.
    pub absorption_factors: [f32; 3],
}

impl LayerValues {
    /// A layer without textures.
    pub const NONE: Self = Self {
        normal: UP,
        alpha_factors: [1.0; 2],
        tangent: [1.0, 0.5],
        slab_factor: 1.0,
        absorption_factors: [1.0; 3],
    };
}

impl PlaceValues {
    /// A place without textures.
    pub const NONE: Self = Self {
        normal: UP,
        alpha_factor: 1.0,
        slab_factor: 1.0,
        film_factor: 1.0,
        slope_variance: 0.0,
        inner_normal: UP,
        flake_normal: UP,
        base_color: None,
        patina: None,
        weight_factor: 1.0,
        metallic: None,
        f0: None,
        layers: Vec::new(),
    };
}

const UP: [f32; 3] = [0.0, 0.0, 1.0];
