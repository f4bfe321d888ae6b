//! Samples of textures: of layers, and noise.

use super::{Sample, sample};

const FILM: &str = "layer.0.film.0.thickness_nm";

pub(super) static SAMPLES: [Sample; 26] = [
    sample(
        "noise.seed",
        FILM,
        "layer = [{ type = 'thin-film', ior = 2.3, thickness_nm = { min = 40, max = 200, extent_um = 20000, map = { noise = { seed = @ } } } }, { type = 'conductor', ior = 'ti', alpha = 0.1 }]",
        &["0", "1", "2"],
    ),
    sample(
        "noise.frequency",
        FILM,
        "layer = [{ type = 'thin-film', ior = 2.3, thickness_nm = { min = 40, max = 200, extent_um = 20000, map = { noise = { frequency = @ } } } }, { type = 'conductor', ior = 'ti', alpha = 0.1 }]",
        &["2", "6", "20"],
    ),
    sample(
        "noise.octaves",
        FILM,
        "layer = [{ type = 'thin-film', ior = 2.3, thickness_nm = { min = 40, max = 200, extent_um = 20000, map = { noise = { octaves = @ } } } }, { type = 'conductor', ior = 'ti', alpha = 0.1 }]",
        &["1", "3", "8"],
    ),
    sample(
        "dielectric-maps.normal",
        "layer.0.maps.normal",
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.05, maps = { @ } }, { type = 'diffuse', albedo = [0.5, 0.05, 0.04] }]\nbake = { model = 'elek' }",
        &["absent|", "'bumps.png'|normal = 'bumps.png'", "'ripples.png'|normal = 'ripples.png'"],
    ),
    sample(
        "dielectric-maps.roughness",
        "layer.0.maps.roughness",
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.3, maps = { @ } }, { type = 'diffuse', albedo = [0.5, 0.05, 0.04] }]\nbake = { model = 'elek' }",
        &["absent|", "'thickness.png'|roughness = 'thickness.png'", "'patina.png'|roughness = 'patina.png'"],
    ),
    sample(
        "dielectric-maps.thickness",
        "layer.0.maps.thickness",
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.05, thickness_um = 100, absorption_per_um = [0.002, 0.012, 0.03], maps = { @ } }, { type = 'diffuse', albedo = 0.8 }]\nbake = { model = 'elek' }",
        &["absent|", "'thickness.png'|thickness = 'thickness.png'", "'patina.png'|thickness = 'patina.png'"],
    ),
    sample(
        "dielectric-maps.absorption",
        "layer.0.maps.absorption",
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.05, thickness_um = 100, absorption_per_um = [0.02, 0.03, 0.03], maps = { @ } }, { type = 'diffuse', albedo = 0.8 }]\nbake = { model = 'elek' }",
        &["absent|", "'paint.png'|absorption = 'paint.png'", "'patina.png'|absorption = 'patina.png'"],
    ),
    sample(
        "dielectric-maps.weight",
        "layer.0.maps.weight",
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.05, thickness_um = 100, absorption_per_um = [0.002, 0.012, 0.03], maps = { @ } }, { type = 'conductor', ior = 'al', alpha = 0.3 }]\nbake = { model = 'elek' }",
        &["absent|", "'thickness.png'|weight = 'thickness.png'", "'patina.png'|weight = 'patina.png'"],
    ),
    sample(
        "film-maps.weight",
        "layer.0.film.0.maps.weight",
        "layer = [{ type = 'thin-film', ior = 2.3, thickness_nm = 110, maps = { @ } }, { type = 'conductor', ior = 'ti', alpha = 0.1 }]",
        &["absent|", "'thickness.png'|weight = 'thickness.png'", "'patina.png'|weight = 'patina.png'"],
    ),
    sample(
        "dielectric-maps.bumps",
        "layer.1.maps.bumps",
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.05 }, { type = 'conductor', ior = 'cu', alpha = 0.2, maps = { @ } }]\nbake = { model = 'elek' }",
        &["absent|", "'bumps.png'|bumps = 'bumps.png'", "'ripples.png'|bumps = 'ripples.png'"],
    ),
    sample(
        "dielectric-maps.alpha",
        "layer.0.maps.alpha",
        "layer = [{ type = 'conductor', ior = 'cu', alpha = 0.5, maps = { @ } }]\nbake = { model = 'elek' }",
        &["absent|", "'thickness.png'|alpha = 'thickness.png'", "'patina.png'|alpha = 'patina.png'"],
    ),
    sample(
        "dielectric-maps.alpha_x",
        "layer.0.maps.alpha_x",
        "layer = [{ type = 'conductor', ior = 'al', alpha_x = 0.5, alpha_y = 0.1, maps = { @ } }]\nbake = { model = 'weidlich-wilkie' }",
        &["absent|", "'thickness.png'|alpha_x = 'thickness.png'", "'patina.png'|alpha_x = 'patina.png'"],
    ),
    sample(
        "dielectric-maps.alpha_y",
        "layer.0.maps.alpha_y",
        "layer = [{ type = 'conductor', ior = 'al', alpha_x = 0.1, alpha_y = 0.5, maps = { @ } }]\nbake = { model = 'weidlich-wilkie' }",
        &["absent|", "'thickness.png'|alpha_y = 'thickness.png'", "'patina.png'|alpha_y = 'patina.png'"],
    ),
    sample(
        "dielectric-maps.tangent",
        "layer.0.maps.tangent",
        "layer = [{ type = 'conductor', ior = 'al', alpha_x = 0.4, alpha_y = 0.06, maps = { @ } }]\nbake = { model = 'weidlich-wilkie' }",
        &["absent|", "'rays.png'|tangent = 'rays.png'", "'circles.png'|tangent = 'circles.png'"],
    ),
    sample(
        "dielectric-maps.f0",
        "layer.0.maps.f0",
        "layer = [{ type = 'conductor', f0 = 0.95, roughness = 0.4, maps = { @ } }]\nbake = { model = 'elek' }",
        &["absent|", "'paint.png'|f0 = 'paint.png'", "'thickness.png'|f0 = 'thickness.png'"],
    ),
    sample(
        "dielectric-maps.lean",
        "layer.0.maps.lean",
        "layer = [{ type = 'dielectric', ior = { n = [1.5, 1.6, 1.8], wavelengths_nm = [645, 525, 445] }, exponents = [60, 60], thickness_um = 1, maps = { @ } }, { type = 'diffuse', albedo = [0.02, 0.05, 0.2] }]\nbake = { model = 'granier-heidrich' }",
        &["absent|", "'bumps.png'|lean = 'bumps.png'", "'ripples.png'|lean = 'ripples.png'"],
    ),
    sample(
        "diffuse-maps.albedo",
        "layer.0.maps.albedo",
        "layer = [{ type = 'diffuse', albedo = 0.8, maps = { @ } }]\nbake = { model = 'elek' }",
        &["absent|", "'paint.png'|albedo = 'paint.png'", "'thickness.png'|albedo = 'thickness.png'"],
    ),
    sample(
        "metallic-maps.base_color",
        "layer.0.maps.base_color",
        "layer = [{ type = 'metallic-roughness', base_color = 0.8, roughness = 0.4, maps = { @ } }]\nbake = { model = 'elek' }",
        &["absent|", "'paint.png'|base_color = 'paint.png'", "'thickness.png'|base_color = 'thickness.png'"],
    ),
    sample(
        "metallic-maps.metallic",
        "layer.0.maps.metallic",
        "layer = [{ type = 'metallic-roughness', base_color = [0.955, 0.638, 0.538], metallic = 1, roughness = 0.4, maps = { @ } }]\nbake = { model = 'elek' }",
        &["absent|", "'thickness.png'|metallic = 'thickness.png'", "'patina.png'|metallic = 'patina.png'"],
    ),
    sample(
        "picture.image",
        "layer.0.maps.albedo",
        "layer = [{ type = 'diffuse', albedo = 0.9, maps = { albedo = { image = @ } } }]",
        &["'paint.png'", "'thickness.png'", "'patina.png'"],
    ),
    sample(
        "picture.channel",
        "layer.0.maps.albedo",
        "layer = [{ type = 'diffuse', albedo = 0.9, maps = { albedo = { image = 'paint.png', channel = @ } } }]",
        &["'r'", "'g'", "'b'"],
    ),
    sample(
        "picture.srgb",
        "layer.0.maps.albedo",
        "layer = [{ type = 'diffuse', albedo = 0.9, maps = { albedo = { image = 'paint.png', srgb = @ } } }]",
        &["false", "true"],
    ),
    sample(
        "picture.scale",
        "layer.0.maps.albedo",
        "layer = [{ type = 'diffuse', albedo = 0.9, maps = { albedo = { image = 'paint.png', scale = @ } } }]",
        &["1", "0.5", "0.2"],
    ),
    sample(
        "uv-transform.offset",
        "layer.0.maps.albedo",
        "layer = [{ type = 'diffuse', albedo = 0.9, maps = { albedo = { image = 'paint.png', transform = { offset = @ } } } }]",
        &["[0, 0]", "[0.25, 0]", "[0.25, 0.25]"],
    ),
    sample(
        "uv-transform.rotation_deg",
        "layer.0.maps.albedo",
        "layer = [{ type = 'diffuse', albedo = 0.9, maps = { albedo = { image = 'paint.png', transform = { rotation_deg = @ } } } }]",
        &["0", "30", "90"],
    ),
    sample(
        "uv-transform.scale",
        "layer.0.maps.albedo",
        "layer = [{ type = 'diffuse', albedo = 0.9, maps = { albedo = { image = 'paint.png', transform = { scale = @ } } } }]",
        &["[1, 1]", "[2, 2]", "[8, 1]"],
    ),
];
