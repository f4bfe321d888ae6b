/// A surface of glTF 2.0 below a coat (KHR_materials_clearcoat) for one view.
struct LuthierPrepared {
    wo: vec3<f32>,
    f0: vec3<f32>,
    diffuse: vec3<f32>,
    alpha_sq: f32,
    root: f32,
    coat_alpha_sq: f32,
    coat_root: f32,
    coat_fresnel: f32,
}

/// The part of `luthier_eval` that is alike for all lights. It has the coat's reflectance, which is one at the eye's cosine, not at the half vector.
fn luthier_prepare(material: u32, wo: vec3<f32>) -> LuthierPrepared {
    let surface = luthier_materials[2u * material];
    let coat = luthier_materials[2u * material + 1u];
    let alpha_sq = surface.a * surface.a;
    let coat_alpha_sq = coat.a * coat.a;
    return LuthierPrepared(
        wo,
        surface.rgb,
        coat.rgb,
        alpha_sq,
        luthier_root(alpha_sq, wo.z),
        coat_alpha_sq,
        luthier_root(coat_alpha_sq, wo.z),
        0.04 + 0.96 * luthier_schlick(wo.z),
    );
}

/// f cos_theta_i of a light: the surface and the lobe of the coat, mixed by the coat's reflectance. The coat's factor is 1, its index 1.5.
fn luthier_light(prepared: LuthierPrepared, wi: vec3<f32>) -> vec3<f32> {
    let cos_theta_o = prepared.wo.z;
    if min(wi.z, cos_theta_o) <= 0.0 {
        return vec3<f32>(0.0);
    }
    let surface = luthier_surface(prepared.f0, prepared.diffuse, prepared.alpha_sq, prepared.root, prepared.wo, wi);
    let coat = luthier_density(prepared.coat_alpha_sq, wi + prepared.wo)
        * luthier_visibility(prepared.coat_alpha_sq, prepared.coat_root, cos_theta_o, wi.z);
    return mix(surface, vec3<f32>(coat), prepared.coat_fresnel) * wi.z;
}
