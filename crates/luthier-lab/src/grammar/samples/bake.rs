//! Samples of `[bake]`.

use super::{Sample, sample};

pub(super) static SAMPLES: [Sample; 17] = [
    sample(
        "bake.model",
        "bake.model",
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.05, thickness_um = 20, absorption_per_um = [0.005, 0.02, 0.05] }, { type = 'conductor', ior = 'ag', alpha = 0.2 }]\nbake = { model = @ }",
        &["'phong'", "'elek'", "'lobes'"],
    ),
    sample(
        "bake.masking",
        "bake.masking",
        "layer = [{ type = 'conductor', ior = 'ag', alpha = 0.5 }]\nbake = { model = 'microfacet', masking = @ }",
        &["'smith'", "'v-cavity'", "'implicit'"],
    ),
    sample(
        "bake.reflectance",
        "bake.reflectance",
        "layer = [{ type = 'conductor', ior = { n = [0.3, 0.6, 1.5], k = [1, 1, 1], wavelengths_nm = [690, 550, 450] }, alpha = 0.3 }]\nbake = { model = 'elek', reflectance = @ }",
        &["'exact'", "'approximate'", "'lazanyi'"],
    ),
    sample(
        "bake.internal_reflection",
        "bake.internal_reflection",
        "layer = [{ type = 'dielectric', ior = 3, alpha = 0.4 }, { type = 'conductor', ior = 'cu', alpha = 0.4 }]\nbake = { model = 'elek', internal_reflection = @ }",
        &["'facets'", "'none'", "'directions'"],
    ),
    sample(
        "bake.lower_reflectance",
        "bake.lower_reflectance",
        "layer = [{ type = 'dielectric', ior = 2, alpha = 0.1 }, { type = 'conductor', ior = { n = 0.5, k = 1.5 }, alpha = 0.2 }]\nbake = { model = 'elek', lower_reflectance = @ }",
        &["'in-place'", "'in-air'"],
    ),
    sample(
        "bake.lower_cosine",
        "bake.lower_cosine",
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.2 }, { type = 'conductor', ior = 'cu', alpha = 0.3 }]\nbake = { model = 'elek', lower_cosine = @ }",
        &["'outside'", "'inside'"],
    ),
    sample(
        "bake.lower_facets",
        "bake.lower_facets",
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.1 }, { type = 'conductor', ior = 'cu', alpha = 0.3 }]\nbake = { model = 'elek', lower_facets = @ }",
        &["'torrance-sparrow'", "'blinn-phong'", "'phong'"],
    ),
    sample(
        "bake.lower_alpha",
        "bake.lower_alpha",
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.4 }, { type = 'conductor', ior = 'cu', alpha = 0.1 }]\nbake = { model = 'weidlich-wilkie', lower_alpha = @ }",
        &["'own'", "'at-least-above'"],
    ),
    sample(
        "bake.diffuse_part",
        "bake.diffuse_part",
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.1 }, { type = 'dielectric', f0 = [0.6, 0.4, 0.2], alpha = 0.3 }, { type = 'diffuse', albedo = 0.5 }]\nbake = { model = 'elek', diffuse_part = @ }",
        &["'below'", "'beside'"],
    ),
    sample(
        "bake.diffuse_term",
        "bake.diffuse_term",
        "layer = [{ type = 'dielectric', ior = 1.5, alpha = 0.2 }, { type = 'diffuse', albedo = [0.5, 0.1, 0.05] }]\nbake = { model = 'microfacet', diffuse_term = @ }",
        &["'none'", "'added'"],
    ),
    sample(
        "bake.color",
        "bake.color",
        "layer = [{ type = 'thin-film', ior = 2.3, thickness_nm = 900 }, { type = 'conductor', ior = 'ti', alpha = 0.1 }]\nbake = { color = @ }",
        &["'spectral'", "'three-wavelengths'"],
    ),
    sample(
        "bake.wavelengths_nm",
        "bake.wavelengths_nm",
        "layer = [{ type = 'thin-film', ior = 2.3, thickness_nm = 150 }, { type = 'conductor', ior = 'ti', alpha = 0.1 }]\nbake = { color = 'three-wavelengths', wavelengths_nm = @ }",
        &["[645, 525, 445]", "[690, 550, 450]", "[600, 550, 500]"],
    ),
    sample(
        "beams.specular_weight",
        "bake.granier-heidrich",
        "layer = [{ type = 'dielectric', ior = 1.7, exponents = [90, 170], thickness_um = 1 }, { type = 'diffuse', albedo = [0.1, 0.2, 0.6] }]\nbake = { model = 'granier-heidrich', granier-heidrich = { specular_weight = @ } }",
        &["0", "1", "3"],
    ),
    sample(
        "beams.diffuse_weight",
        "bake.granier-heidrich",
        "layer = [{ type = 'dielectric', ior = 1.7, exponents = [90, 170], thickness_um = 1 }, { type = 'diffuse', albedo = [0.1, 0.2, 0.6] }]\nbake = { model = 'granier-heidrich', granier-heidrich = { diffuse_weight = @ } }",
        &["0", "0.5", "1"],
    ),
    sample(
        "beams.inner_tilt_deg",
        "bake.granier-heidrich",
        "layer = [{ type = 'dielectric', ior = 1.7, exponents = [60, 60], thickness_um = 1 }, { type = 'diffuse', albedo = [0.02, 0.05, 0.2] }]\nbake = { model = 'granier-heidrich', granier-heidrich = { inner_tilt_deg = @ } }",
        &["0", "10", "25"],
    ),
    sample(
        "beams.inner_azimuth_deg",
        "bake.granier-heidrich",
        "layer = [{ type = 'dielectric', ior = 1.7, exponents = [60, 60], thickness_um = 1 }, { type = 'diffuse', albedo = [0.02, 0.05, 0.2] }]\nbake = { model = 'granier-heidrich', granier-heidrich = { inner_tilt_deg = 15, inner_azimuth_deg = @ } }",
        &["0", "90", "180"],
    ),
    sample(
        "beams.lobe_height",
        "bake.granier-heidrich",
        "layer = [{ type = 'dielectric', ior = 1.7, exponents = [20, 40], thickness_um = 1 }, { type = 'diffuse', albedo = [0.1, 0.2, 0.6] }]\nbake = { model = 'granier-heidrich', granier-heidrich = { lobe_height = @ } }",
        &["'scaled'", "'one'"],
    ),
];
