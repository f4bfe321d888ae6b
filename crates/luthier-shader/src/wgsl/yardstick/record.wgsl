// Numbers of a coat over a surface. Each material has two words: F0 RGB and slope parameter of the surface; diffuse albedo RGB over pi, and
// slope parameter of the coat.
@group(0) @binding(6) var<storage, read> luthier_materials: array<vec4<f32>>;

const LUTHIER_PI: f32 = 3.14159265;

/// D of GGX for a half vector of any length (Walter et al. 2007, eq. 33).
fn luthier_density(alpha_sq: f32, bisector: vec3<f32>) -> f32 {
    let z_sq = bisector.z * bisector.z;
    let across_sq = dot(bisector.xy, bisector.xy);
    let ratio = (z_sq + across_sq) / (alpha_sq * z_sq + across_sq);
    return alpha_sq * ratio * ratio / LUTHIER_PI;
}

/// Root of Smith's masking of GGX for one direction, by its cosine.
fn luthier_root(alpha_sq: f32, cosine: f32) -> f32 {
    return sqrt((1.0 - alpha_sq) * cosine * cosine + alpha_sq);
}

/// G over four times both cosines: Smith's masking of GGX, height-correlated (Heitz 2014, eq. 99), from the root of the eye.
fn luthier_visibility(alpha_sq: f32, root_o: f32, cos_theta_o: f32, cos_theta_i: f32) -> f32 {
    return 0.5 / (cos_theta_i * root_o + cos_theta_o * luthier_root(alpha_sq, cos_theta_i));
}

/// f of a rough surface over Lambert's base, whose light the reflectance at the half vector leaves; without the cosine of the light. `root` is that of
/// the eye's masking.
fn luthier_surface(f0: vec3<f32>, diffuse: vec3<f32>, alpha_sq: f32, root: f32, wo: vec3<f32>, wi: vec3<f32>) -> vec3<f32> {
    let bisector = wi + wo;
    let fresnel = f0 + (1.0 - f0) * luthier_schlick(0.5 * length(bisector));
    let lobe = luthier_density(alpha_sq, bisector) * luthier_visibility(alpha_sq, root, wo.z, wi.z);
    return (1.0 - fresnel) * diffuse + fresnel * lobe;
}

/// Weight of white in Schlick's formula (1994): (1 - cosine)^5.
fn luthier_schlick(cosine: f32) -> f32 {
    let c = 1.0 - min(cosine, 1.0);
    let c_sq = c * c;
    return c_sq * c_sq * c;
}
