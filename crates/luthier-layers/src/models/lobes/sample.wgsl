/// Probabilities of the first facet, of the lobes and of the wide remainder, times their sum.
fn luthier_chances_lobes(prepared: LuthierPreparedLobes) -> vec4<f32> {
    let third = vec3<f32>(1.0 / 3.0);
    let wide = dot(prepared.wide, third);
    var rest = dot(luthier_albedo_lobes(prepared), third) - wide;
    //? lobes_patina
    rest -= luthier_bare_energy(prepared);
    // A material that reflects nothing has a remainder without light.
    let least = vec4<f32>(0.0, 0.0, 0.0, 1e-6);
    //? one_lobe|two_lobes
    {
        rest -= dot(luthier_lobe_below(prepared, 0u).energy, third);
        let first = dot(prepared.first_strength, third);
        //? two_lobes
        {
            rest -= dot(luthier_lobe_below(prepared, 1u).energy, third);
            return max(vec4<f32>(rest, first, dot(prepared.second_strength, third), wide), least);
        }
        //? else
        return max(vec4<f32>(rest, first, 0.0, wide), least);
    }
    //? else
    return max(vec4<f32>(rest, 0.0, 0.0, wide), least);
}

/// Density of directions mirrored at the visible normals of the first interface, D / 4 over cos_theta_o (1 + Lambda).
fn luthier_facet_density(prepared: LuthierPreparedLobes, wi: vec3<f32>) -> f32 {
    let sum = vec3<f32>(wi.xy + prepared.wo.xy, max(wi.z + prepared.wo.z, 1e-16));
    return luthier_quarter_density(prepared.coat, sum) / (prepared.masking * prepared.wo.z);
}

/// Share of Gaussian slopes of unit alpha below x, within 1e-7 (Abramowitz and Stegun 1964, 7.1.26); the Gaussian is exp(-x^2).
fn luthier_slope_share(x: f32, gaussian: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.3275911 * abs(x));
    let series = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
    let tail = 0.5 * series * gaussian;
    return select(1.0 - tail, tail, x < 0.0);
}

/// A slope, and a bracket about the one that is looked for.
struct LuthierSlopeSearch {
    x: f32,
    low: f32,
    high: f32,
}

/// A step of Halley's, kept inside the bracket, towards the slope below which lies a target of the visible slopes:
/// cos (1 + erf x) / 2 + sin exp(-x^2) / (2 sqrt pi) for an eye of that cosine and sine.
fn luthier_slope_step(search: LuthierSlopeSearch, eye: vec2<f32>, wanted: f32) -> LuthierSlopeSearch {
    let x = search.x;
    let gaussian = exp(-x * x);
    let excess = eye.x * luthier_slope_share(x, gaussian) + eye.y * (0.2820948 * gaussian) - wanted;
    let low = select(x, search.low, excess > 0.0);
    let high = select(search.high, x, excess > 0.0);
    let visible = max(eye.x - x * eye.y, 1e-6);
    let newton = excess / (0.5641896 * gaussian * visible);
    let next = x - newton / (1.0 + newton * (x + 0.5 * eye.y / visible));
    return LuthierSlopeSearch(select(0.5 * (low + high), next, next >= low && next <= high), low, high);
}

/// The slope along the plane of the eye of a visible facet of Beckmann's distribution of unit alpha (Heitz and d'Eon 2014); slopes end at 4.
fn luthier_draw_slope_along(eye: vec2<f32>, u: f32) -> f32 {
    let limit = min(eye.x / max(eye.y, 1e-6), 4.0);
    let edge = exp(-limit * limit);
    let wanted = u * (eye.x * luthier_slope_share(limit, edge) + eye.y * (0.2820948 * edge));
    let v = clamp(u, 1e-6, 1.0 - 1e-6);
    let guess = eye.x * 0.43 * log(v / (1.0 - v)) - eye.y * sqrt(-log(v));
    let start = max(select(limit - sqrt(1.0 - u), guess, guess < limit), -4.0);
    let first = luthier_slope_step(LuthierSlopeSearch(start, -4.0, limit), eye, wanted);
    let second = luthier_slope_step(first, eye, wanted);
    let third = luthier_slope_step(second, eye, wanted);
    let fourth = luthier_slope_step(third, eye, wanted);
    let fifth = luthier_slope_step(fourth, eye, wanted);
    let sixth = luthier_slope_step(fifth, eye, wanted);
    return sixth.x;
}

/// A Gaussian slope of unit alpha: Winitzki's closed form, good to 2e-3, and a step of Halley's on it.
fn luthier_draw_slope_across(u: f32) -> f32 {
    let v = clamp(u, 1e-7, 1.0 - 1e-7);
    let tails = log(4.0 * v * (1.0 - v));
    let middle = 4.3307467 + 0.5 * tails;
    let size = sqrt(max(sqrt(middle * middle - 6.8027211 * tails) - middle, 0.0));
    let guess = select(size, -size, v < 0.5);
    let gaussian = exp(-guess * guess);
    let newton = (luthier_slope_share(guess, gaussian) - v) / (0.5641896 * gaussian);
    return guess - newton / (1.0 + newton * guess);
}

/// A direction mirrored at a visible normal of Beckmann's distribution; below the horizon for light that meets the surface again.
fn luthier_draw_gaussian(alpha: vec2<f32>, axis: vec2<f32>, wo: vec3<f32>, u: vec2<f32>) -> vec3<f32> {
    let eye = vec3<f32>(luthier_in_frame(axis, wo.xy), wo.z);
    let stretched = normalize(vec3<f32>(alpha * eye.xy, eye.z));
    let sin_theta = sqrt(dot(stretched.xy, stretched.xy));
    let along = luthier_draw_slope_along(vec2<f32>(stretched.z, sin_theta), u.x);
    let across = luthier_draw_slope_across(u.y);
    let azimuth = select(vec2<f32>(1.0, 0.0), stretched.xy / max(sin_theta, 1e-20), sin_theta > 1e-20);
    let slope = vec2<f32>(azimuth.x * along - azimuth.y * across, azimuth.y * along + azimuth.x * across);
    let wh = normalize(vec3<f32>(-alpha * slope, 1.0));
    let wi = 2.0 * dot(wh, eye) * wh - eye;
    return vec3<f32>(axis.x * wi.x - axis.y * wi.y, axis.y * wi.x + axis.x * wi.y, wi.z);
}

/// A direction mirrored at a visible normal of the first interface.
fn luthier_draw_facet(prepared: LuthierPreparedLobes, u: vec2<f32>) -> vec3<f32> {
    //? anisotropic
    {
        let alpha = prepared.coat.alpha_xy;
        let axis = prepared.coat.rotation;
    }
    //? else
    {
        let alpha = vec2<f32>(prepared.coat.alpha);
        let axis = vec2<f32>(1.0, 0.0);
    }
    //? beckmann
    {
        //? ggx
        if prepared.coat.distribution > 0.5 {
            return luthier_draw_visible(alpha, axis, prepared.wo, u);
        }
        return luthier_draw_gaussian(alpha, axis, prepared.wo, u);
    }
    //? else
    return luthier_draw_visible(alpha, axis, prepared.wo, u);
}

/// Density in solid angle of light that a lobe sends to the eye.
fn luthier_lobe_density(prepared: LuthierPreparedLobes, shape: LuthierLobeShape, wi: vec3<f32>) -> f32 {
    let place = luthier_place_below(prepared, wi);
    return luthier_half_slope_density(shape, place.xy) * place.z;
}

/// A direction whose half vector has a slope that a lobe draws; below the horizon where light does not leave there.
fn luthier_sample_lobe(prepared: LuthierPreparedLobes, shape: LuthierLobeShape, u: vec2<f32>) -> vec3<f32> {
    // Of y, the tail times the logarithm of the share beyond, exp(y) - 1 without cancellation.
    let y = -log(1.0 - min(u.x, 0.9999999)) / shape.decay;
    let series = y * (1.0 + y * (0.5 + y * (1.0 / 6.0)));
    let radius = sqrt(select(exp(y) - 1.0, series, y < 0.02));
    let phi = 2.0 * LUTHIER_PI * u.y;
    let slope = luthier_lobe_slope(shape, radius * vec2<f32>(cos(phi), sin(phi)));
    let wh = normalize(vec3<f32>(slope, 1.0));
    // Directions inside times the index, in the frame of the lobes.
    let eye = vec3<f32>(luthier_in_frame(prepared.azimuth, prepared.wo.xy), prepared.inside_cos);
    let inside = 2.0 * dot(wh, eye) * wh - eye;
    let cos_sq = 1.0 - dot(inside.xy, inside.xy);
    let leaves = inside.z > 0.0 && cos_sq > 0.0;
    let turn = prepared.azimuth;
    let across = vec2<f32>(turn.x * inside.x - turn.y * inside.y, turn.y * inside.x + turn.x * inside.y);
    return vec3<f32>(across, select(-1.0, sqrt(max(cos_sq, 0.0)), leaves));
}

/// Density in solid angle with which `luthier_draw_lobes` draws a direction above the horizon.
fn luthier_density_lobes(prepared: LuthierPreparedLobes, wi: vec3<f32>) -> f32 {
    let chances = luthier_chances_lobes(prepared);
    var density = chances.x * luthier_facet_density(prepared, wi) + chances.w * (wi.z / LUTHIER_PI);
    //? one_lobe|two_lobes
    density += chances.y * luthier_lobe_density(prepared, prepared.first_shape, wi);
    //? two_lobes
    density += chances.z * luthier_lobe_density(prepared, prepared.second_shape, wi);
    //? lobes_patina
    {
        let bare = luthier_bare_energy(prepared);
        density += bare * luthier_facet_density(luthier_bare_lobes(prepared), wi);
        return density / (dot(chances, vec4<f32>(1.0)) + bare);
    }
    //? else
    return density / dot(chances, vec4<f32>(1.0));
}

/// Direction and part of a draw, without its density and weight: 0 the first facet, that of a bare layer too, 1 and 2 the lobes, 3 the wide remainder.
fn luthier_draw_lobes(prepared: LuthierPreparedLobes, u: vec3<f32>) -> LuthierSample {
    let chances = luthier_chances_lobes(prepared);
    //? lobes_patina
    {
        let total = dot(chances, vec4<f32>(1.0));
        let choice = u.x * (total + luthier_bare_energy(prepared));
    }
    //? else
    let choice = u.x * dot(chances, vec4<f32>(1.0));
    let phi = 2.0 * LUTHIER_PI * u.z;
    var drawn = LuthierSample(vec3<f32>(sqrt(u.y) * vec2<f32>(cos(phi), sin(phi)), sqrt(1.0 - u.y)), 0.0, vec3<f32>(0.0), 3u);
    if choice < chances.x {
        drawn.wi = luthier_draw_facet(prepared, u.yz);
        drawn.part = 0u;
    }
    //? lobes_patina
    if choice > total {
        drawn.wi = luthier_draw_facet(luthier_bare_lobes(prepared), u.yz);
        drawn.part = 0u;
    }
    //? one_lobe|two_lobes
    {
        let first = chances.x + chances.y;
        if choice >= chances.x && choice < first {
            drawn.wi = luthier_sample_lobe(prepared, prepared.first_shape, u.yz);
            drawn.part = 1u;
        }
    }
    //? two_lobes
    if choice >= first && choice < first + chances.z {
        drawn.wi = luthier_sample_lobe(prepared, prepared.second_shape, u.yz);
        drawn.part = 2u;
    }
    return drawn;
}

//? lobes_sides
{
    /// Density in solid angle with which `luthier_draw_sides` draws a direction above the horizon.
    fn luthier_density_sides(prepared: LuthierPreparedSides, wi: vec3<f32>) -> f32 {
        let chance = luthier_covered_chance(prepared);
        var density = 0.0;
        //? lobes_side_frames
        {
            let coated_wi = luthier_local(prepared.coated_normal, wi);
            let bare_wi = luthier_local(prepared.bare_normal, wi);
            let is_coated = chance > 0.0 && prepared.coated_open && coated_wi.z > 0.0;
            let is_bare = chance < 1.0 && prepared.bare_open && bare_wi.z > 0.0;
        }
        //? else
        {
            let coated_wi = wi;
            let bare_wi = wi;
            let is_coated = chance > 0.0;
            let is_bare = chance < 1.0;
        }
        if is_coated {
            density = chance * luthier_density_lobes(prepared.coated, coated_wi);
        }
        if is_bare {
            var bare = bare_wi.z / LUTHIER_PI;
            //? lobes_side_rows
            //? lobes_side_bases
            if !prepared.is_base {
                bare = luthier_density_lobes(prepared.bare, bare_wi);
            }
            //? else
            bare = luthier_density_lobes(prepared.bare, bare_wi);
            density += (1.0 - chance) * bare;
        }
        return density;
    }

    //? lobes_side_frames
    /// A draw of a side in the frame of both; below the horizon where it is below that of the side.
    fn luthier_off_side(normal: vec3<f32>, given: LuthierSample) -> LuthierSample {
        var drawn = given;
        let there = luthier_local(vec3<f32>(-normal.xy, normal.z), given.wi);
        drawn.wi = select(vec3<f32>(0.0, 0.0, -1.0), there, given.wi.z > 0.0);
        return drawn;
    }

    /// Direction and part of a draw of either side, without its density and weight: see `luthier_draw_lobes`.
    fn luthier_draw_sides(prepared: LuthierPreparedSides, u: vec3<f32>) -> LuthierSample {
        let chance = luthier_covered_chance(prepared);
        if u.x < chance {
            //? lobes_side_frames
            return luthier_off_side(prepared.coated_normal, luthier_draw_lobes(prepared.coated, vec3<f32>(u.x / chance, u.yz)));
            //? else
            return luthier_draw_lobes(prepared.coated, vec3<f32>(u.x / chance, u.yz));
        }
        let rest = vec3<f32>((u.x - chance) / max(1.0 - chance, 1e-6), u.yz);
        //? lobes_side_bases
        //? lobes_side_rows
        if prepared.is_base {
            let phi = 2.0 * LUTHIER_PI * rest.z;
            let across = sqrt(rest.y) * vec2<f32>(cos(phi), sin(phi));
            //? lobes_side_frames
            return luthier_off_side(prepared.bare_normal, LuthierSample(vec3<f32>(across, sqrt(1.0 - rest.y)), 0.0, vec3<f32>(0.0), 3u));
            //? else
            return LuthierSample(vec3<f32>(across, sqrt(1.0 - rest.y)), 0.0, vec3<f32>(0.0), 3u);
        }
        //? else
        {
            let phi = 2.0 * LUTHIER_PI * rest.z;
            let across = sqrt(rest.y) * vec2<f32>(cos(phi), sin(phi));
            //? lobes_side_frames
            return luthier_off_side(prepared.bare_normal, LuthierSample(vec3<f32>(across, sqrt(1.0 - rest.y)), 0.0, vec3<f32>(0.0), 3u));
            //? else
            return LuthierSample(vec3<f32>(across, sqrt(1.0 - rest.y)), 0.0, vec3<f32>(0.0), 3u);
        }
        //? lobes_side_rows
        //? lobes_side_frames
        return luthier_off_side(prepared.bare_normal, luthier_draw_lobes(prepared.bare, rest));
        //? else
        return luthier_draw_lobes(prepared.bare, rest);
    }
}
