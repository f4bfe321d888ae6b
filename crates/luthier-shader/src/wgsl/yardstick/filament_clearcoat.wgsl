/// A surface below Filament's clear coat for one view.
struct LuthierPrepared {
    wo: vec3<f32>,
    f0: vec3<f32>,
    f90: f32,
    diffuse: vec3<f32>,
    alpha_sq: f32,
    root: f32,
    coat_alpha_sq: f32,
}

/// The part of `luthier_eval` that is alike for all lights. The surface is at least as rough as the coat, and its F0 becomes that below a coat of
/// index 1.5, by Filament's polynomial.
fn luthier_prepare(material: u32, wo: vec3<f32>) -> LuthierPrepared {
    let surface = luthier_materials[2u * material];
    let coat = luthier_materials[2u * material + 1u];
    let alpha = max(surface.a, coat.a);
    let alpha_sq = alpha * alpha;
    let air = surface.rgb;
    let f0 = saturate(air * (air * (0.941892 - 0.263008 * air) + 0.346479) - 0.0285998);
    let f90 = saturate(dot(f0, vec3<f32>(50.0 * 0.33)));
    return LuthierPrepared(wo, f0, f90, coat.rgb, alpha_sq, luthier_root(alpha_sq, wo.z), coat.a * coat.a);
}

/// f cos_theta_i of a light: Kelemen's masking for the coat, and below it what the coat's reflectance at the half vector leaves. The coat's factor
/// is 1.
fn luthier_light(prepared: LuthierPrepared, wi: vec3<f32>) -> vec3<f32> {
    let cos_theta_o = prepared.wo.z;
    if min(wi.z, cos_theta_o) <= 0.0 {
        return vec3<f32>(0.0);
    }
    let bisector = wi + prepared.wo;
    let length_sq = dot(bisector, bisector);
    let grazing = luthier_schlick(0.5 * sqrt(length_sq));
    let fresnel = prepared.f0 + (prepared.f90 - prepared.f0) * grazing;
    let lobe = luthier_density(prepared.alpha_sq, bisector)
        * luthier_visibility(prepared.alpha_sq, prepared.root, cos_theta_o, wi.z);
    let coat_fresnel = 0.04 + 0.96 * grazing;
    // Kelemen's masking over the four cosines is a quarter of the inverse squared cosine to the half vector, which is half the length of the sum.
    let coat = coat_fresnel * luthier_density(prepared.coat_alpha_sq, bisector) / length_sq;
    return ((prepared.diffuse + fresnel * lobe) * (1.0 - coat_fresnel) + coat) * wi.z;
}
