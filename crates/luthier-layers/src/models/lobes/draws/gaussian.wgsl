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

    /// A direction mirrored at a facet of Beckmann's distribution; below the horizon for light that meets the surface again.
    fn luthier_draw_gaussian(given: LuthierFacetDraw, wo: vec3<f32>, u: vec3<f32>) -> vec3<f32> {
        let axis = given.axis;
        let eye = vec3<f32>(luthier_in_frame(axis, wo.xy), wo.z);
        let stretched = given.eye;
        let sin_theta = sqrt(dot(stretched.xy, stretched.xy));
        var along = 0.0;
        if u.x < given.plain {
            along = luthier_draw_slope_across(u.y * given.seen);
        } else {
            along = luthier_draw_slope_along(vec2<f32>(stretched.z, sin_theta), u.y);
        }
        let across = luthier_draw_slope_across(u.z);
        let azimuth = select(vec2<f32>(1.0, 0.0), stretched.xy / max(sin_theta, 1e-20), sin_theta > 1e-20);
        let slope = vec2<f32>(azimuth.x * along - azimuth.y * across, azimuth.y * along + azimuth.x * across);
        let wh = normalize(vec3<f32>(-given.alpha * slope, 1.0));
        let wi = 2.0 * dot(wh, eye) * wh - eye;
        return vec3<f32>(axis.x * wi.x - axis.y * wi.y, axis.y * wi.x + axis.x * wi.y, wi.z);
    }
}
