// Facets of a micro-surface: density, visible area, samples. Directions are in the frame of the tangents of the layer, on either side of it;
// the z axis points into their side. Those of rays between facets may lie below the horizon.

const SIMULATION_INVERSE_ROOT_PI: f32 = 0.564189583547756;

// Complementary error function, to 1.2e-7 of itself (Press et al., Numerical Recipes, section 6.2).
fn simulation_erfc(x: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.5 * abs(x));
    let low = -0.82215223 + t * 0.17087277;
    let middle = 0.27886807 + t * (-1.13520398 + t * (1.48851587 + t * low));
    let high = -1.26551223 + t * (1.00002368 + t * (0.37409196 + t * (0.09678418 + t * (-0.18628806 + t * middle))));
    let tail = t * exp(-x * x + high);
    return select(2.0 - tail, tail, x >= 0.0);
}

// Density D of facet normals; zero from the horizon down.
fn simulation_density(layer: SimulationLayer, m: vec3<f32>) -> f32 {
    if m.z <= 0.0 {
        return 0.0;
    }
    let slope = m.xy / layer.alpha;
    let slope_sq = dot(slope, slope);
    let z_sq = m.z * m.z;
    let peak = 1.0 / (SIMULATION_PI * layer.alpha.x * layer.alpha.y);
    if layer.is_ggx {
        return peak / ((z_sq + slope_sq) * (z_sq + slope_sq));
    }
    return peak * exp(-slope_sq / z_sq) / (z_sq * z_sq);
}

// Area of facets that a direction sees: cos (1 + Lambda) from above, |cos| Lambda from below (Heitz et al. 2016, eq. 10).
fn simulation_area(layer: SimulationLayer, w: vec3<f32>) -> f32 {
    let across = layer.alpha * w.xy;
    let s_sq = dot(across, across);
    if layer.is_ggx {
        let size = sqrt(w.z * w.z + s_sq);
        return 0.5 * select(w.z + size, s_sq / (size - w.z), w.z < 0.0);
    }
    if s_sq == 0.0 {
        return max(w.z, 0.0);
    }
    let s = sqrt(s_sq);
    let nu = w.z / s;
    return max(0.5 * w.z * simulation_erfc(-nu) + 0.5 * s * exp(-nu * nu) * SIMULATION_INVERSE_ROOT_PI, 0.0);
}

// Smith's Lambda of a direction above the horizon.
fn simulation_lambda(layer: SimulationLayer, w: vec3<f32>) -> f32 {
    return simulation_area(layer, -w) / max(w.z, 1e-20);
}

// The slope x along the plane of incidence with C(x) = u C(x_max), C being the cumulative visible distribution of Gaussian slopes
// (Heitz and d'Eon 2014). Newton's steps, kept inside a bracket.
fn simulation_visible_slope(cosine: f32, sine: f32, u: f32) -> f32 {
    let scale = 0.5 * SIMULATION_INVERSE_ROOT_PI;
    var low = -6.0;
    var high = 6.0;
    if sine > 0.0 {
        high = clamp(cosine / sine, -6.0, 6.0);
    }
    let limit = high;
    let whole = cosine * 0.5 * simulation_erfc(-high) + sine * scale * exp(-high * high);
    let goal = u * whole;
    let v = clamp(u, 1e-6, 1.0 - 1e-6);
    let guess = max(cosine, 0.0) * 0.43 * log(v / (1.0 - v)) - sine * sqrt(-log(v));
    var x = max(select(limit - sqrt(1.0 - u), guess, guess < limit), low);
    for (var i = 0; i < 24; i++) {
        let gauss = exp(-x * x);
        let excess = cosine * 0.5 * simulation_erfc(-x) + sine * scale * gauss - goal;
        if excess > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let slope = scale * 2.0 * gauss * (cosine - x * sine);
        var next = x - excess / slope;
        if !(next > low && next < high) {
            next = 0.5 * (low + high);
        }
        let step = abs(next - x);
        x = next;
        if step < 1e-5 || high - low < 1e-6 {
            break;
        }
    }
    return x;
}

// A facet normal with density D max(0, w.m) / area; unit. GGX: Dupuy and Benyoub 2023.
fn simulation_normal(layer: SimulationLayer, w: vec3<f32>, u: vec2<f32>) -> vec3<f32> {
    let stretched = normalize(vec3<f32>(layer.alpha * w.xy, w.z));
    let around = vec2<f32>(cos(2.0 * SIMULATION_PI * u.y), sin(2.0 * SIMULATION_PI * u.y));
    if layer.is_ggx {
        let sine_sq = dot(stretched.xy, stretched.xy);
        let span = select(1.0 + stretched.z, sine_sq / (1.0 - stretched.z), stretched.z < 0.0);
        let up = (1.0 - u.x) * span;
        let z = up - stretched.z;
        let m = sqrt(max(1.0 - z * z, 0.0)) * around + stretched.xy;
        return normalize(vec3<f32>(layer.alpha * m, max(up, 1e-12)));
    }
    let sine = length(stretched.xy);
    let along = simulation_visible_slope(stretched.z, sine, u.x);
    // Box and Muller 1958, of the width of the slopes.
    let across = sqrt(-log(1.0 - simulation_draw().x)) * around.x;
    var axis = vec2<f32>(1.0, 0.0);
    if sine > 0.0 {
        axis = stretched.xy / sine;
    }
    let slope = vec2<f32>(axis.x * along - axis.y * across, axis.y * along + axis.x * across);
    return normalize(vec3<f32>(-layer.alpha * slope, 1.0));
}
