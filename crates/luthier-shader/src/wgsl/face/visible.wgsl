/// Density of directions mirrored at the visible normals of a GGX surface, seen from wo (Heitz 2018).
fn luthier_visible_density(alpha: vec2<f32>, axis: vec2<f32>, wo: vec3<f32>, wi: vec3<f32>) -> f32 {
    let sum = wi.xy + wo.xy;
    let bisector = vec3<f32>(
        vec2<f32>(axis.x * sum.x + axis.y * sum.y, axis.x * sum.y - axis.y * sum.x) / alpha,
        max(wi.z + wo.z, 1e-16),
    );
    let length_sq = dot(sum, sum) + bisector.z * bisector.z;
    let ratio = length_sq / dot(bisector, bisector);
    let eye = alpha * vec2<f32>(axis.x * wo.x + axis.y * wo.y, axis.x * wo.y - axis.y * wo.x);
    // D / 4 over cos_theta_o (1 + Lambda).
    return ratio * ratio / (2.0 * LUTHIER_PI * alpha.x * alpha.y * (wo.z + sqrt(wo.z * wo.z + dot(eye, eye))));
}

/// A direction mirrored at a visible normal (Dupuy and Benyoub 2023); below the horizon for light that meets the surface again.
fn luthier_draw_visible(alpha: vec2<f32>, axis: vec2<f32>, wo: vec3<f32>, u: vec2<f32>) -> vec3<f32> {
    let eye = vec3<f32>(axis.x * wo.x + axis.y * wo.y, axis.x * wo.y - axis.y * wo.x, wo.z);
    let stretched = normalize(vec3<f32>(alpha * eye.xy, eye.z));
    let phi = 2.0 * LUTHIER_PI * u.y;
    let z = (1.0 - u.x) * (1.0 + stretched.z) - stretched.z;
    let cap = vec3<f32>(sqrt(max(1.0 - z * z, 0.0)) * vec2<f32>(cos(phi), sin(phi)), z) + stretched;
    let wh = normalize(vec3<f32>(alpha * cap.xy, max(cap.z, 1e-6)));
    let wi = 2.0 * dot(wh, eye) * wh - eye;
    return vec3<f32>(axis.x * wi.x - axis.y * wi.y, axis.y * wi.x + axis.x * wi.y, wi.z);
}
