// Reads the maps of the module `environment`. kernel_inputs.maps names the first of their headers: word offset, columns, rows.
// Order: the map, irradiance over pi, then the blurred maps of each slope distribution in use.

const ENVIRONMENT_PI: f32 = 3.14159265358979;
// Blurred maps of a slope distribution, half an octave apart from 1/64.
const ENVIRONMENT_BLURS: u32 = 13u;
const ENVIRONMENT_FINEST_LOG2: f32 = -6.0;

fn environment_read(map: u32, direction: vec3<f32>) -> vec3<f32> {
    let header = bitcast<vec4<u32>>(kernel_inputs.words[kernel_inputs.maps + map]);
    let size = vec2<i32>(header.yz);
    let across = length(direction.xz);
    let uv = vec2<f32>(
        0.5 + atan2(direction.x, -direction.z) / (2.0 * ENVIRONMENT_PI),
        atan2(across, direction.y) / ENVIRONMENT_PI,
    );
    let position = uv * vec2<f32>(size) - 0.5;
    let corner = floor(position);
    let weight = position - corner;
    let left = (i32(corner.x) + size.x) % size.x;
    let right = (left + 1) % size.x;
    let top = clamp(i32(corner.y), 0, size.y - 1) * size.x + i32(header.x);
    let bottom = clamp(i32(corner.y) + 1, 0, size.y - 1) * size.x + i32(header.x);
    let above = mix(kernel_inputs.words[top + left].rgb, kernel_inputs.words[top + right].rgb, weight.x);
    let below = mix(kernel_inputs.words[bottom + left].rgb, kernel_inputs.words[bottom + right].rgb, weight.x);
    return mix(above, below, weight.y);
}

fn environment_radiance(direction: vec3<f32>) -> vec3<f32> {
    return environment_read(0u, direction);
}

// Irradiance over pi.
fn environment_diffuse(normal: vec3<f32>) -> vec3<f32> {
    return environment_read(1u, normal);
}

// Around a mirrored direction, blurred by a rough mirror; `chain` is the first of its maps.
fn environment_mirrored(chain: u32, alpha: f32, direction: vec3<f32>) -> vec3<f32> {
    let octaves = 2.0 * (log2(max(alpha, 1e-6)) - ENVIRONMENT_FINEST_LOG2);
    if octaves < 0.0 {
        let weight = alpha * exp2(-ENVIRONMENT_FINEST_LOG2);
        return mix(environment_read(0u, direction), environment_read(chain, direction), weight);
    }
    let place = min(octaves, f32(ENVIRONMENT_BLURS - 1u));
    let low = u32(place);
    let high = min(low + 1u, ENVIRONMENT_BLURS - 1u);
    return mix(environment_read(chain + low, direction), environment_read(chain + high, direction), fract(place));
}
