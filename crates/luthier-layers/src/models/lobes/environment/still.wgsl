/// A lobe in few directions that do not turn. Its blurs are as wide as the lobe is where it is narrow; the directions lie on a line along it.
struct LuthierStill {
    /// The slope of one standard deviation along the line, beyond what the blur has.
    along: vec2<f32>,
    /// Where light stops to leave, over the part of that in the plane of the eye.
    ends: vec2<f32>,
    /// The axis across the line, over the stretch of the middle, and the variance of the lobe along it.
    across: vec2<f32>,
    across_sq: f32,
    /// Distance of two directions whose blurs have one variance, over the length of the line.
    apart: f32,
    /// By how much lobes get darker towards the horizon: they are multiplied by the exponential of this times the cosine.
    fall: f32,
    /// The variance of the blurs over that of the lobe, and the share of the light: in the core of a lobe and in its tail.
    core: vec2<f32>,
    tail: vec2<f32>,
}

/// Half the length of the line, in standard deviations, for so many directions on it.
const LUTHIER_STILL_REACH: f32 = $still_reach;

/// The line of a lobe.
fn luthier_still_line(lobe: LuthierShownLobe) -> LuthierStill {
    var still: LuthierStill;
    //? lobes_axes
    {
        let angle_sq = 0.5 * lobe.width_sq * vec3<f32>(lobe.stretch * lobe.stretch, lobe.stretch.x * lobe.stretch.y);
        let mean = 0.5 * (angle_sq.x + angle_sq.y);
        let half = 0.5 * (angle_sq.x - angle_sq.y);
        let radius = sqrt(half * half + angle_sq.z * angle_sq.z);
        still.across_sq = max(mean - radius, 1e-6 * mean);
        let cosine = half / max(radius, 1e-9 * mean);
        let axis = sqrt(saturate(0.5 + 0.5 * vec2<f32>(cosine, -cosine)));
        let line = vec2<f32>(axis.x, select(-axis.y, axis.y, angle_sq.z >= 0.0));
        still.along = line * (sqrt(2.0 * radius) / lobe.stretch);
        still.across = vec2<f32>(-line.y, line.x) / lobe.stretch;
    }
    //? else
    {
        let angles = 0.70711 * lobe.width * lobe.stretch;
        let rest = sqrt(abs(angles.x - angles.y) * (angles.x + angles.y));
        let line = select(vec2<f32>(0.0, 1.0), vec2<f32>(1.0, 0.0), angles.x >= angles.y);
        let narrow = min(angles.x, angles.y);
        still.across_sq = narrow * narrow;
        still.along = line * (rest / lobe.stretch);
        still.across = line.yx / lobe.stretch;
    }
    // Slopes of half vectors with light along the surface.
    let inverse_z = 1.0 / (sqrt(max(dot(lobe.eye, lobe.eye) - 1.0, 0.0)) + lobe.eye.z);
    still.ends = (vec2<f32>(-1.0, 1.0) * inverse_z + lobe.eye.x * inverse_z - lobe.middle.x) / max(still.along.x, 1e-9);
    still.fall = select(1.0, 0.3, lobe.is_coat);
    let tail = min(lobe.tail, 1.0);
    $still_blurs
    return still;
}

/// Light so far and that of one more direction: its place on the line from 0 to 1, the variance of its blur, and its weight.
fn luthier_still_tap(shown: LuthierShown, still: LuthierStill, lobe: LuthierShownLobe, prepared: LuthierPreparedLobes, frame: mat3x3<f32>, at: f32, blur: vec2<f32>) -> LuthierShown {
    let scale = sqrt(blur.x);
    let ends = clamp(still.ends / scale, vec2<f32>(-LUTHIER_STILL_REACH), vec2<f32>(LUTHIER_STILL_REACH));
    let line = ends.y - ends.x;
    let x = mix(ends.x, ends.y, at);
    let place = luthier_shown_place(lobe, prepared, lobe.middle + still.along * (x * scale));
    let across = still.across * place.stretch;
    let apart = still.along * place.stretch * (still.apart * line);
    // Wider blurs where the directions are farther apart than twice the blur.
    let narrow = still.across_sq * dot(across, across);
    let variance = blur.x * max(narrow, 0.73 * narrow + 0.085 * dot(apart, apart));
    // A von Mises-Fisher lobe times such an exponential is another.
    let wi = place.wi + vec3<f32>(0.0, 0.0, still.fall * variance);
    let inverse = inverseSqrt(dot(wi, wi));
    let width = min(sqrt(variance * inverse), 1.4);
    let weight = (blur.y * exp(-0.5 * x * x) * line * saturate(0.5 + 0.5 * place.above / max(sqrt(variance), 0.014))) * place.weight;
    let light = luthier_environment_alone(frame * (wi * inverse), width);
    return LuthierShown(shown.light + weight * light, shown.weight + weight);
}

/// Mean radiance in a lobe, in directions that do not turn.
fn luthier_shown_still(lobe: LuthierShownLobe, prepared: LuthierPreparedLobes, frame: mat3x3<f32>) -> vec3<f32> {
    let still = luthier_still_line(lobe);
    var shown = LuthierShown(vec3<f32>(0.0), vec3<f32>(1e-9));
    $each_still
    return shown.light / shown.weight;
}
