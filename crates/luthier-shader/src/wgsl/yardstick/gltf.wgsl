/// The surface of glTF 2.0 (Appendix B) for one view.
struct LuthierPrepared {
    wo: vec3<f32>,
    f0: vec3<f32>,
    diffuse: vec3<f32>,
    alpha_sq: f32,
    root: f32,
}

/// The part of `luthier_eval` that is alike for all lights.
fn luthier_prepare(material: u32, wo: vec3<f32>) -> LuthierPrepared {
    let surface = luthier_materials[2u * material];
    let diffuse = luthier_materials[2u * material + 1u].rgb;
    let alpha_sq = surface.a * surface.a;
    return LuthierPrepared(wo, surface.rgb, diffuse, alpha_sq, luthier_root(alpha_sq, wo.z));
}

/// f cos_theta_i of a light: GGX, Smith's masking, Schlick's reflectance at the half vector, and Lambert's base with the rest (Appendix B.3.5).
fn luthier_light(prepared: LuthierPrepared, wi: vec3<f32>) -> vec3<f32> {
    if min(wi.z, prepared.wo.z) <= 0.0 {
        return vec3<f32>(0.0);
    }
    return wi.z * luthier_surface(prepared.f0, prepared.diffuse, prepared.alpha_sq, prepared.root, prepared.wo, wi);
}
