//? beckmann
{
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

    /// The slope along the plane of the eye of a visible facet of Beckmann's distribution of unit alpha (Heitz and d'Eon 2014), for a share of the facets up to the
    /// flattest one, or up to a slope of 4.
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

    /// How facets of Beckmann are drawn, see `GaussianDraw` of the f64 twin.
    struct LuthierGaussianDraw {
        /// Cosine and sine of the eye where the surface is rough by 1, and its azimuth there.
        eye: vec2<f32>,
        azimuth: vec2<f32>,
        /// The chord of the ellipse at a slope: y^2 x + 2 x y y + x^2 z + 2 x w < 1.
        chord: vec4<f32>,
        /// Ends of slopes along the eye, and shares of visible facets below them.
        ends: vec2<f32>,
        visible: vec2<f32>,
        /// Chance of the Gaussian, its middle and width along, its width across, and shares of it below the ends.
        chance: f32,
        middle: f32,
        widths: vec2<f32>,
        shares: vec2<f32>,
    }

    /// Ends of the chord of the ellipse at a slope along the eye.
    fn luthier_chord_ends(chord: vec4<f32>, x: f32) -> vec2<f32> {
        let half = x * chord.y;
        let rest = 1.0 - x * (x * chord.z + 2.0 * chord.w);
        let root = sqrt(max(half * half + chord.x * rest, 0.0));
        return clamp(vec2<f32>(-half - root, root - half) / chord.x, vec2<f32>(-4.0), vec2<f32>(4.0));
    }

    /// The logarithm of the light that facets of a slope return, by the power that the Gaussian follows.
    fn luthier_gaussian_light(chord: vec4<f32>, given: LuthierFacetDraw, cos_theta_o: f32, slope: vec2<f32>) -> f32 {
        let facing = cos_theta_o * (1.0 - slope.x * chord.w);
        let squares = slope.x * slope.x * chord.z + slope.y * slope.y * chord.x + 2.0 * slope.x * slope.y * chord.y;
        let steep = sqrt(1.0 + squares);
        let cosine = clamp(facing / steep, 1e-4, 1.0);
        let rest = 1.0 - cosine;
        let rest_sq = rest * rest;
        let reflectance = given.f0 + (1.0 - given.f0) * (rest_sq * rest_sq * rest);
        let height = max(2.0 * cosine / steep - cos_theta_o, 0.003);
        return 0.77 * log(reflectance * max(facing, 1e-4)) + 0.29 * log(height / (height + 0.22 * sqrt(given.alpha_sq)));
    }

    /// Shares of Gaussian slopes below two.
    fn luthier_slopes_below(ends: vec2<f32>) -> vec2<f32> {
        return vec2<f32>(luthier_slope_share(ends.x, exp(-ends.x * ends.x)), luthier_slope_share(ends.y, exp(-ends.y * ends.y)));
    }

    /// Share of visible slopes below one.
    fn luthier_visible_below(eye: vec2<f32>, x: f32) -> f32 {
        let gaussian = exp(-x * x);
        return eye.x * luthier_slope_share(x, gaussian) + eye.y * (0.2820948 * gaussian);
    }

    fn luthier_gaussian_draw(given: LuthierFacetDraw, wo: vec3<f32>) -> LuthierGaussianDraw {
        var draw: LuthierGaussianDraw;
        let level = luthier_in_frame(given.axis, wo.xy);
        let sin_theta = length(given.eye.xy);
        draw.eye = vec2<f32>(given.eye.z, sin_theta);
        draw.azimuth = select(vec2<f32>(1.0, 0.0), given.eye.xy / max(sin_theta, 1e-20), sin_theta > 1e-20);
        let along = given.alpha * draw.azimuth;
        let across = given.alpha * vec2<f32>(-draw.azimuth.y, draw.azimuth.x);
        let chord = vec4<f32>(dot(across, across), dot(along, across), dot(along, along), sin_theta / given.eye.z);
        draw.chord = chord;
        // The greatest slope whose light leaves, without cancellation.
        let gradient = draw.azimuth / given.alpha;
        let far = length(gradient) + dot(gradient, level);
        let near = gradient.x * level.y - gradient.y * level.x;
        let towards = (dot(gradient, gradient) * wo.z * wo.z + near * near) / (wo.z * far);
        draw.ends = vec2<f32>(max(-far / wo.z, -4.0), min(towards, 4.0));
        draw.visible = vec2<f32>(luthier_visible_below(draw.eye, draw.ends.x), luthier_visible_below(draw.eye, draw.ends.y));
        let end = min(1.9, 0.27 * draw.ends.y);
        let center = 0.5 * (end - 0.66);
        let half = 0.5 * (end + 0.66);
        let least = luthier_gaussian_light(chord, given, wo.z, vec2<f32>(-0.66, 0.0));
        let mean = luthier_gaussian_light(chord, given, wo.z, vec2<f32>(center, 0.0));
        let most = luthier_gaussian_light(chord, given, wo.z, vec2<f32>(end, 0.0));
        let beside = luthier_gaussian_light(chord, given, wo.z, vec2<f32>(center, 1.57));
        let bend = clamp((most + least - 2.0 * mean) / (2.0 * half * half), -1.0, 0.5);
        let squares = 1.0 / (vec2<f32>(1.0) - vec2<f32>(bend, clamp((beside - mean) / 2.4649, -0.3, 0.5)));
        draw.middle = clamp(0.5 * ((most - least) / (2.0 * half) - 2.0 * bend * center) * squares.x, -1.0, 1.0);
        draw.widths = sqrt(squares);
        draw.shares = luthier_slopes_below((draw.ends - draw.middle) / draw.widths.x);
        draw.chance = 0.85 * (1.0 - given.f0) * (1.0 - given.f0);
        return draw;
    }

    /// Density in solid angle of light that drawn facets of Beckmann mirror to the eye, above the horizon; `sum` is that of both directions.
    fn luthier_gaussian_density(given: LuthierFacetDraw, wo: vec3<f32>, sum: vec3<f32>) -> f32 {
        let draw = luthier_gaussian_draw(given, wo);
        let slope = -luthier_in_frame(given.axis, sum.xy) / (sum.z * given.alpha);
        let x = dot(slope, draw.azimuth);
        let y = draw.azimuth.x * slope.y - draw.azimuth.y * slope.x;
        let ends = luthier_chord_ends(draw.chord, x);
        let chord = luthier_slopes_below(ends);
        let wide_chord = luthier_slopes_below(ends / draw.widths.y);
        let facing = max(draw.eye.x - draw.eye.y * x, 0.0) / (draw.visible.y - draw.visible.x);
        let visible = facing * exp(-x * x - y * y) / max(chord.y - chord.x, 1e-6);
        let apart = vec2<f32>(x - draw.middle, y) / draw.widths;
        let of_plain = draw.widths.x * draw.widths.y * (draw.shares.y - draw.shares.x) * max(wide_chord.y - wide_chord.x, 1e-6);
        let plain = exp(-dot(apart, apart)) / of_plain;
        let slopes = mix(visible, plain, draw.chance) / LUTHIER_PI;
        return slopes * dot(sum, sum) / (2.0 * given.alpha_sq * sum.z * sum.z * sum.z);
    }

    /// A direction mirrored at a facet of Beckmann's distribution.
    fn luthier_draw_gaussian(given: LuthierFacetDraw, wo: vec3<f32>, u: vec3<f32>) -> vec3<f32> {
        let axis = given.axis;
        let draw = luthier_gaussian_draw(given, wo);
        var along = 0.0;
        var width = 1.0;
        if u.x < draw.chance {
            width = draw.widths.y;
            along = draw.middle + draw.widths.x * luthier_draw_slope_across(mix(draw.shares.x, draw.shares.y, u.y));
        } else {
            let last = min(draw.eye.x / max(draw.eye.y, 1e-6), 4.0);
            along = luthier_draw_slope_along(draw.eye, mix(draw.visible.x, draw.visible.y, u.y) / luthier_visible_below(draw.eye, last));
        }
        along = clamp(along, draw.ends.x, draw.ends.y);
        let ends = luthier_chord_ends(draw.chord, along);
        let shares = luthier_slopes_below(ends / width);
        let across = clamp(width * luthier_draw_slope_across(mix(shares.x, shares.y, u.z)), ends.x, ends.y);
        let azimuth = draw.azimuth;
        let slope = vec2<f32>(azimuth.x * along - azimuth.y * across, azimuth.y * along + azimuth.x * across);
        let wh = normalize(vec3<f32>(-given.alpha * slope, 1.0));
        let eye = vec3<f32>(luthier_in_frame(axis, wo.xy), wo.z);
        let wi = 2.0 * dot(wh, eye) * wh - eye;
        return vec3<f32>(axis.x * wi.x - axis.y * wi.y, axis.y * wi.x + axis.x * wi.y, wi.z);
    }
}
