// The preview ball: a unit sphere at the origin, seen in perspective from +z, +y up. One thread per pixel.

struct BallLayer {
    // 0 dielectric, 1 conductor, 2 diffuse base.
    kind: f32,
    alpha: f32,
    eta: f32,
    sigma: f32,
    fresnel_tile: f32,
    distribution_tile: f32,
    fgd_tile: f32,
    phase_tile: f32,
    optical_depth: vec3<f32>,
    thickness_tile: f32,
    albedo: vec3<f32>,
    distribution: f32,
}

struct Ball {
    // To the light, unit.
    light_direction: vec3<f32>,
    exposure: f32,
    // On a patch that faces the light.
    light_irradiance: vec3<f32>,
    // Distance from the eye to the centre.
    eye: f32,
    backdrop: vec3<f32>,
    // Half the side of the picture in the plane through the centre.
    half_extent: f32,
    size: u32,
    samples: u32,
    // First row of this dispatch.
    row: u32,
    material: u32,
    sky: Sky,
    layers: array<BallLayer>,
}

@group(1) @binding(0) var<storage, read> kernel_inputs: Ball;
@group(1) @binding(1) var<storage, read_write> kernel_outputs: array<vec4<f32>>;

// Mean cosine of light that reaches a patch evenly from its hemisphere.
const BALL_MEAN_COSINE: f32 = 2.0 / 3.0;

// Cosine below an interface for one above it; 0 when nothing is refracted.
fn ball_refract(cos_theta: f32, eta: f32) -> f32 {
    return sqrt(max(1.0 - (1.0 - cos_theta * cos_theta) / (eta * eta), 0.0));
}

// Light of the sky that the layers send along wo. The sky is smooth, so a reflection is an albedo times the blurred
// sky around the mirrored direction; the diffuse base sees the irradiance. Layers attenuate as in luthier_eval, with
// the cosine of wo for light that comes mirrored and the mean cosine for light that comes from everywhere.
fn ball_sky(normal: vec3<f32>, wo: vec3<f32>, cos_theta_o: f32) -> vec3<f32> {
    let mirrored = reflect(-wo, normal);
    var leaving = vec3<f32>(1.0);
    var entering = vec3<f32>(1.0);
    var cos_out = cos_theta_o;
    var cos_in = BALL_MEAN_COSINE;
    var alpha = 0.0;
    var total = vec3<f32>(0.0);
    for (var i = 0u; i < arrayLength(&kernel_inputs.layers); i++) {
        let layer = kernel_inputs.layers[i];
        if layer.kind == 2.0 {
            total += leaving * entering * layer.albedo * sky_irradiance(kernel_inputs.sky, normal) / SKY_PI;
            break;
        }
        alpha = max(alpha, layer.alpha);
        let reflected_out = ball_fresnel(layer.fresnel_tile, cos_out);
        var albedo = reflected_out;
        if layer.fgd_tile >= 0.0 {
            albedo = ball_fgd(layer.fgd_tile, cos_out, alpha);
        }
        total += leaving * leaving * albedo * sky_radiance(kernel_inputs.sky, mirrored, alpha);
        if layer.kind == 1.0 {
            break;
        }
        let reflected_in = ball_fresnel(layer.fresnel_tile, cos_in);
        cos_out = ball_refract(cos_out, layer.eta);
        cos_in = ball_refract(cos_in, layer.eta);
        if min(cos_out, cos_in) <= 0.0 {
            break;
        }
        leaving *= (1.0 - reflected_out) * exp(-layer.optical_depth / cos_out);
        entering *= (1.0 - reflected_in) * exp(-layer.optical_depth / cos_in);
    }
    return total;
}

// Radiance along the ray from the eye through a point of the plane z = 0.
fn ball_radiance(at: vec2<f32>) -> vec3<f32> {
    let eye = vec3<f32>(0.0, 0.0, kernel_inputs.eye);
    let ray = normalize(vec3<f32>(at, 0.0) - eye);
    // Point of the ray nearest to the centre, formed without cancellation.
    let moment = cross(eye, ray);
    let nearest = cross(ray, moment);
    let depth_sq = 1.0 - dot(moment, moment);
    if depth_sq <= 0.0 {
        let r = at / kernel_inputs.half_extent;
        return kernel_inputs.backdrop * (1.0 - 0.3 * min(dot(r, r), 2.0));
    }
    let normal = normalize(nearest - sqrt(depth_sq) * ray);
    let wo = -ray;
    // Tangent along the parallels; any at the poles.
    var tangent = vec3<f32>(normal.z, 0.0, -normal.x);
    let length_sq = dot(tangent, tangent);
    tangent = select(vec3<f32>(1.0, 0.0, 0.0), tangent * inverseSqrt(length_sq), length_sq > 1e-12);
    let frame = mat3x3<f32>(tangent, cross(normal, tangent), normal);
    let wi_local = kernel_inputs.light_direction * frame;
    let wo_local = wo * frame;
    let lit = luthier_eval(kernel_inputs.material, wi_local, wo_local) * kernel_inputs.light_irradiance;
    return lit + ball_sky(normal, wo, clamp(wo_local.z, 1e-4, 1.0));
}

@compute @workgroup_size(8, 8)
fn kernel_ball(@builtin(global_invocation_id) thread: vec3<u32>) {
    let size = kernel_inputs.size;
    let index = thread.y * size + thread.x;
    if thread.x >= size || index >= arrayLength(&kernel_outputs) {
        return;
    }
    let pixel = vec2<f32>(f32(thread.x), f32(kernel_inputs.row + thread.y));
    let samples = kernel_inputs.samples;
    var sum = vec3<f32>(0.0);
    for (var j = 0u; j < samples; j++) {
        for (var i = 0u; i < samples; i++) {
            let at = (pixel + (vec2<f32>(f32(i), f32(j)) + 0.5) / f32(samples)) / f32(size);
            sum += ball_radiance(vec2<f32>(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y) * kernel_inputs.half_extent);
        }
    }
    kernel_outputs[index] = vec4<f32>(sum * (kernel_inputs.exposure / f32(samples * samples)), 1.0);
}
