// The surrounding of the preview ball: device copy of sky.rs.

struct SoftLight {
    direction: vec3<f32>,
    sharpness: f32,
    radiance: vec3<f32>,
}

struct Sky {
    // Legendre coefficients in the height of the direction.
    bands: array<vec3<f32>, 3>,
    lights: array<SoftLight, 2>,
}

const SKY_PI: f32 = 3.14159265358979;

// Integral of exp(k (cos - 1)) over the sphere.
fn sky_lobe_integral(sharpness: f32) -> f32 {
    return 2.0 * SKY_PI * (1.0 - exp(-2.0 * sharpness)) / sharpness;
}

// Radiance around a direction, blurred as by a mirror with slope parameter alpha.
fn sky_radiance(sky: Sky, direction: vec3<f32>, alpha: f32) -> vec3<f32> {
    let y = direction.y;
    let variance = 2.0 * alpha * alpha;
    let first = exp(-variance) * y;
    let second = exp(-3.0 * variance) * (1.5 * y * y - 0.5);
    var total = sky.bands[0] + sky.bands[1] * first + sky.bands[2] * second;
    for (var i = 0; i < 2; i++) {
        let light = sky.lights[i];
        let blurred = 1.0 / (1.0 / light.sharpness + variance);
        let peak = sky_lobe_integral(light.sharpness) / sky_lobe_integral(blurred);
        total += light.radiance * (peak * exp(blurred * (dot(light.direction, direction) - 1.0)));
    }
    return total;
}

// Irradiance of a patch.
fn sky_irradiance(sky: Sky, normal: vec3<f32>) -> vec3<f32> {
    let y = normal.y;
    var total = SKY_PI * (sky.bands[0] + sky.bands[1] * (2.0 / 3.0 * y) + sky.bands[2] * (0.25 * (1.5 * y * y - 0.5)));
    for (var i = 0; i < 2; i++) {
        let light = sky.lights[i];
        let x = dot(light.direction, normal);
        let first = 1.0 / tanh(light.sharpness) - 1.0 / light.sharpness;
        let second = 1.0 - 3.0 * first / light.sharpness;
        let received = 0.25 + 0.5 * first * x + 0.3125 * second * (1.5 * x * x - 0.5);
        total += light.radiance * (sky_lobe_integral(light.sharpness) * max(received, 0.0));
    }
    return total;
}
