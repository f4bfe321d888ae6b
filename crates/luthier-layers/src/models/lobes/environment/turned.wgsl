/// Standard deviation of the blur of a direction over the widths of its lobe, for Beckmann's distribution: with less the directions are seen one by one in
/// small bright lights, with more the lobe is one of angles rather than of slopes. Gaussians about the points of a Gaussian are one; lobes with longer tails
/// want narrower ones in the middle, and wider ones the farther out they are.
const LUTHIER_TAP_BLUR: f32 = $tap_blur;

/// Its greatest standard deviation over the lesser width: the root of a half is that of a Gaussian, whose directions would lie on a line.
const LUTHIER_TAP_NARROWEST: f32 = $tap_narrowest;

/// Standard deviation of the blur of a direction of a lobe, an angle: not wider than the lobe where it is narrow.
fn luthier_shown_blur(lobe: LuthierShownLobe, stretch: vec2<f32>) -> f32 {
    let tail = min(lobe.tail, 1.0);
    let share = LUTHIER_TAP_BLUR * (1.0 - 0.25 * tail);
    let narrowest = LUTHIER_TAP_NARROWEST * (1.0 - 0.566 * tail);
    //? lobes_axes
    {
        let angle_sq = lobe.width_sq * vec3<f32>(stretch * stretch, stretch.x * stretch.y);
        let mean = 0.5 * (angle_sq.x + angle_sq.y);
        let half_difference = 0.5 * (angle_sq.x - angle_sq.y);
        let narrow_sq = max(mean - sqrt(half_difference * half_difference + angle_sq.z * angle_sq.z), 1e-6 * mean);
        let area_sq = max(angle_sq.x * angle_sq.y - angle_sq.z * angle_sq.z, 0.0);
        return min(share * sqrt(sqrt(area_sq)), narrowest * sqrt(narrow_sq));
    }
    //? else
    {
        let angles = lobe.width * stretch;
        return min(share * sqrt(angles.x * angles.y), narrowest * min(angles.x, angles.y));
    }
}

//? lobes_axes
/// The root of what the blurs leave of the squared widths, within which directions lie.
fn luthier_turned_spread(lobe: LuthierShownLobe) -> vec3<f32> {
    let blur = luthier_shown_blur(lobe, lobe.stretch);
    let left = max(lobe.width_sq.xy - (2.0 + 2.0 * lobe.tail) * (blur * blur) / (lobe.stretch * lobe.stretch), vec2<f32>(0.0));
    let along = sqrt(left.x);
    let between = lobe.width_sq.z / max(along, 1e-12);
    return vec3<f32>(along, sqrt(max(left.y - between * between, 0.0)), between);
}
//? else
/// Widths less those of the blurs: within these the directions lie.
fn luthier_turned_spread(lobe: LuthierShownLobe) -> vec3<f32> {
    let angles = lobe.width * lobe.stretch;
    let blur = luthier_shown_blur(lobe, lobe.stretch);
    return vec3<f32>(lobe.width * sqrt(max(1.0 - (2.0 + 2.0 * lobe.tail) * (blur * blur) / (angles * angles), vec2<f32>(0.0))), 0.0);
}

/// Light so far and that of one more direction of a lobe: where it lies over the widths of a Gaussian, the square of its distance from the middle, and its
/// weight. Lobes with longer tails have it farther out, with a wider blur. What would not leave the surface weighs nothing.
fn luthier_turned_tap(shown: LuthierShown, lobe: LuthierShownLobe, spread: vec3<f32>, prepared: LuthierPreparedLobes, frame: mat3x3<f32>, turn: vec2<f32>, tap: vec4<f32>) -> LuthierShown {
    let grown = lobe.tail * tap.z;
    let farther = sqrt(select((exp(grown) - 1.0) / max(grown, 1e-2), 1.0 + 0.5 * grown, grown < 0.02));
    let around = farther * vec2<f32>(turn.x * tap.x - turn.y * tap.y, turn.y * tap.x + turn.x * tap.y);
    let place = luthier_shown_place(lobe, prepared, lobe.middle + spread.xy * around + vec2<f32>(0.0, spread.z * around.x));
    let blur = luthier_shown_above(place, min(luthier_shown_blur(lobe, place.stretch) * exp(0.4 * grown), 1.4));
    let weight = (tap.w * blur.share) * place.weight;
    let light = luthier_environment_around(frame * blur.wi, blur.width);
    return LuthierShown(shown.light + weight * light, shown.weight + weight);
}

/// Mean radiance in a lobe: in directions with weights, each blurred. Together the blurs are nearly the lobe, if it is a Gaussian.
fn luthier_shown_turned(lobe: LuthierShownLobe, prepared: LuthierPreparedLobes, frame: mat3x3<f32>, turn: vec2<f32>) -> vec3<f32> {
    let spread = luthier_turned_spread(lobe);
    var shown = LuthierShown(vec3<f32>(0.0), vec3<f32>(1e-6));
    $each_direction
    return shown.light / shown.weight;
}

/// Standard deviation of the blur of a direction of the remainder, an angle.
const LUTHIER_WIDE_BLUR: f32 = 0.2;

/// Light that was read in some directions of the remainder: in its shape, and in that of a cosine.
struct LuthierShownWide {
    shaped: vec3<f32>,
    plain: vec3<f32>,
    weight: f32,
}

/// Light so far and that of one more direction of a cosine about the normal.
fn luthier_turned_wide_tap(shown: LuthierShownWide, prepared: LuthierPreparedLobes, frame: mat3x3<f32>, turn: vec2<f32>, wi: vec3<f32>) -> LuthierShownWide {
    let turned = vec3<f32>(turn.x * wi.x - turn.y * wi.y, turn.y * wi.x + turn.x * wi.y, wi.z);
    let light = luthier_environment_around(frame * turned, LUTHIER_WIDE_BLUR);
    let shape = luthier_wide_shape(prepared, wi.z);
    return LuthierShownWide(shown.shaped + shape * light, shown.plain + light, shown.weight + shape);
}

/// Mean radiance in the remainder, in directions that turn: the irradiance, and what its shape is brighter by in a few directions.
fn luthier_turned_wide(prepared: LuthierPreparedLobes, frame: mat3x3<f32>, turn: vec2<f32>) -> vec3<f32> {
    var shown = LuthierShownWide(vec3<f32>(0.0), vec3<f32>(0.0), 1e-6);
    shown = luthier_turned_wide_tap(shown, prepared, frame, turn, vec3<f32>(0.968246, 0.000000, 0.250000));
    shown = luthier_turned_wide_tap(shown, prepared, frame, turn, vec3<f32>(-0.664655, 0.608879, 0.433013));
    shown = luthier_turned_wide_tap(shown, prepared, frame, turn, vec3<f32>(0.072490, -0.825981, 0.559017));
    shown = luthier_turned_wide_tap(shown, prepared, frame, turn, vec3<f32>(0.456329, 0.595201, 0.661438));
    shown = luthier_turned_wide_tap(shown, prepared, frame, turn, vec3<f32>(-0.651327, -0.115211, 0.750000));
    shown = luthier_turned_wide_tap(shown, prepared, frame, turn, vec3<f32>(0.471674, -0.300040, 0.829156));
    shown = luthier_turned_wide_tap(shown, prepared, frame, turn, vec3<f32>(-0.112412, 0.418167, 0.901388));
    shown = luthier_turned_wide_tap(shown, prepared, frame, turn, vec3<f32>(-0.115227, -0.221862, 0.968246));
    let brighter = shown.shaped / shown.weight - 0.125 * shown.plain;
    return max(luthier_environment_diffuse(frame[2]) + brighter, vec3<f32>(0.0));
}

