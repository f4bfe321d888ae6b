// The environment as lobes show it: maps that were blurred beforehand, read at directions that lobes would draw.

// One lobe in half vectors of a medium, in the plane of the eye.
struct LobesShape {
    // Squared index of the medium, less 1.
    excess: f32,
    // Middle along the plane, and widths along and across it.
    middle: f32,
    width: vec2<f32>,
    // Tail, above 0: near 0 Beckmann's distribution, 1 that of GGX.
    tail: f32,
    energy: vec3<f32>,
}

// Directions for each lobe: with 16 instead the error is twice as large. The samples of a pixel share them.
const LOBES_TAPS: u32 = 64u;
// Slope parameter of the mirror that blurs a direction, over that of the mirror along its normal whose greatest density is that of the direction's
// share; and the factor on slopes that takes the blur's widening back.
const LOBES_BLUR: f32 = 0.8;
const LOBES_SHRUNK: f32 = 0.97;

// The environment in a lobe: at slopes that have equal energies, along a spiral that turns by the golden angle (Vogel 1979), each blurred by its
// share of the lobe (filtered importance sampling: Krivanek and Colbert 2008). What would not leave the surface goes to the others. `chain` is the
// first map that Beckmann's distribution has blurred.
fn lobes_shown(
    lobe: LobesShape, is_coat: bool, prepared: LuthierPreparedLobes, frame: mat3x3<f32>, chain: u32, seed: u32,
) -> vec3<f32> {
    let wo = prepared.wo;
    // Directions inside times the index.
    let eye = vec3<f32>(dot(prepared.azimuth, wo.xy), 0.0, sqrt(wo.z * wo.z + lobe.excess));
    var weights = vec3<f32>(1e-6);
    var light = vec3<f32>(0.0);
    let samples = kernel_inputs.samples * kernel_inputs.samples;
    let parts = min(samples, 16u);
    for (var i = seed % samples % parts; i < LOBES_TAPS; i += parts) {
        let beyond = 1.0 - (f32(i) + 0.5) / f32(LOBES_TAPS);
        let radius = sqrt((exp2(-lobe.tail * log2(beyond)) - 1.0) / lobe.tail);
        let phi = 2.39996323 * f32(i);
        let slope = vec2<f32>(lobe.middle, 0.0) + LOBES_SHRUNK * radius * lobe.width * vec2<f32>(cos(phi), sin(phi));
        let density = exp2((1.0 + lobe.tail) * log2(beyond)) / (ENVIRONMENT_PI * lobe.width.x * lobe.width.y);
        let wh = vec3<f32>(slope, 1.0) * inverseSqrt(1.0 + dot(slope, slope));
        let cos_theta_d = dot(wh, eye);
        let up = 2.0 * cos_theta_d * wh - eye;
        let sin_sq = dot(up.xy, up.xy);
        // Cosine outside, below 0 for what does not leave.
        let above = select(-1.0, 1.0, sin_sq < 1.0 && up.z > 0.0) * sqrt(abs(1.0 - sin_sq));
        let cos_theta_i = max(above, 1e-2);
        let across = up.xy * min(inverseSqrt(max(sin_sq, 1e-12)), 1.0);
        var weight = vec3<f32>(1.0);
        if is_coat {
            let slope_i = prepared.coat.alpha * sqrt(sin_sq) / cos_theta_i;
            let masking = prepared.masking + luthier_slope_lambda(prepared.coat, slope_i);
            let fresnel = luthier_fresnel_term(prepared.coat, clamp(cos_theta_d, 0.0, 1.0));
            weight = max(fresnel, vec3<f32>(1e-6)) * (max(cos_theta_d, 1e-3) / (wh.z * masking * wo.z));
        }
        let sum = vec3<f32>(up.xy + eye.xy, max(up.z + eye.z, 1e-2));
        let factor = 0.5 * dot(sum, sum) / (sum.z * sum.z * sum.z) * cos_theta_i / max(up.z, 1e-2);
        let alpha = min(LOBES_BLUR * inverseSqrt(4.0 * ENVIRONMENT_PI * f32(LOBES_TAPS) * density * factor), 1.0);
        weight *= saturate(0.5 + 0.5 * above / max(alpha, 1e-2));
        let wi = frame * vec3<f32>(
            prepared.azimuth.x * across.x - prepared.azimuth.y * across.y,
            prepared.azimuth.y * across.x + prepared.azimuth.x * across.y,
            cos_theta_i,
        );
        light += weight * environment_mirrored(chain, alpha, wi);
        weights += weight;
    }
    return lobe.energy * light / weights;
}

// The environment as a material of lobes sends it along wo.
fn lobes_environment(material: u32, frame: mat3x3<f32>, wo: vec3<f32>, chain: u32, coat_tail: f32, seed: u32) -> vec3<f32> {
    let prepared = luthier_prepare_lobes(material, vec3<f32>(wo.xy, max(wo.z, 1e-4)));
    var rest = luthier_albedo_lobes(prepared) - prepared.wide;
    var total = prepared.wide * environment_diffuse(frame[2]);
    for (var i = 0u; i < LUTHIER_LOBES; i++) {
        let below = luthier_lobe_below(prepared, i);
        rest -= below.energy;
        let width = inverseSqrt(below.shape.w) / below.shape.yz;
        let lobe = LobesShape(prepared.medium.x, below.shape.x, width, 1.0 / below.shape.w, below.energy);
        total += lobes_shown(lobe, false, prepared, frame, chain, seed);
    }
    let coat = LobesShape(0.0, 0.0, vec2<f32>(prepared.coat.alpha), coat_tail, max(rest, vec3<f32>(0.0)));
    return total + lobes_shown(coat, true, prepared, frame, chain, seed);
}
