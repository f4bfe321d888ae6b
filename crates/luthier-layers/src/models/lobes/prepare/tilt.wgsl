/// Slopes of half vectors to light above the horizon: middle of their disc, in the frame of the lobes, and its radius.
fn luthier_leaving_disc(prepared: LuthierPreparedLobes) -> vec3<f32> {
    let radius = 1.0 / max(prepared.inside_cos + sqrt(max(prepared.medium.x, 0.0)), 0.05);
    return vec3<f32>(luthier_in_frame(prepared.azimuth, prepared.wo.xy) * radius, radius);
}

//? lobes_family
/// The first of two values where a number is less than a limit, and else the second, by component: languages differ in conditions of several numbers.
fn luthier_where_less(numbers: vec2<f32>, limit: f32, value: vec2<f32>, other: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(select(other.x, value.x, numbers.x < limit), select(other.y, value.y, numbers.y < limit));
}

//? lobes_tilted|lobes_family
/// Share of a shape above the horizon, as an estimate, where its middle is so far from that of the disc: see `Leaving` of the f64 twin.
fn luthier_lobe_leaving(shape: LuthierLobeShape, apart: vec2<f32>, radius: f32) -> f32 {
    //? lobes_axes
    {
        let determinant = luthier_lobe_determinant(shape);
        let along = length(shape.sharpness.yx * apart - shape.shear * apart.yx) / determinant;
    }
    //? else
    {
        let determinant = shape.sharpness.x * shape.sharpness.y;
        let along = length(apart / shape.sharpness);
    }
    // Widths are those of the shader: the roots of the decay times those of the shape.
    let root = sqrt(determinant);
    let away = length(apart);
    let near = (radius - away) * (away + 1e-4) / (along + 1e-4 / root);
    let edges = vec2<f32>(near, max(2.0 * radius * root - near, near));
    let cosines = exp2(-0.5 * shape.decay * log2(1.0 + edges * edges));
    //? lobes_family
    {
        // Small sines by a series: the difference to 1 would be rounded off.
        let small = shape.decay * edges * edges;
        let squares = luthier_where_less(small, 1e-3, small - 0.5 * small * (small + edges * edges), 1.0 - cosines * cosines);
        let sines = sqrt(max(squares, vec2<f32>(0.0)));
    }
    //? else
    let sines = sqrt(max(1.0 - cosines * cosines, vec2<f32>(0.0)));
    let of_near = select(-sines.x, sines.x, near >= 0.0);
    let of_far = select(-sines.y, sines.y, edges.y >= 0.0);
    return max(0.5 - 0.5 * (cosines.x * cosines.y - of_near * of_far), 1e-3);
}

//? lobes_tilted
/// The lobe where the layers below lean by a slope, with the share of it that is above the horizon where they are level. A lobe gets no brighter by that:
/// see `Below::tilted` of the f64 twin.
fn luthier_lobe_about(given: LuthierLobeShape, slope: vec2<f32>, share: f32, disc: vec3<f32>) -> LuthierLobeShape {
    var shape = given;
    shape.gain = 1.0;
    shape.left = 1.0;
    if slope.x == 0.0 && slope.y == 0.0 {
        return shape;
    }
    //? lobes_axes
    let moved = given.sharpness * slope + given.shear * slope.yx;
    //? else
    let moved = given.sharpness * slope;
    let apart = disc.xy - luthier_lobe_slope(given, vec2<f32>(0.0));
    let level = luthier_lobe_leaving(given, apart, disc.z);
    let leaned = luthier_lobe_leaving(given, apart - slope, disc.z);
    let soon = max(1.0 - 4.0 * length(moved) * sqrt(given.decay), 0.0);
    let stated = clamp(share, 1e-3, 1.0);
    shape.gain = clamp((stated + soon * (level - stated)) / leaned, stated, 1.0);
    shape.left = min(leaned / level, 1.0);
    shape.middle += moved;
    return shape;
}

//? lobes_tilted
/// Slope of what lies below the first interface of a material: that of flakes, and that of the lowest interface against the first one.
fn luthier_slope_below(place: LuthierPlace, material: u32) -> vec2<f32> {
    var slope = vec2<f32>(0.0);
    //? flakes
    slope += place.flake_normal.xy / max(place.flake_normal.z, 1e-3);
    //? lobes_bumps
    {
        let last = luthier_layer_count(material) - 1u;
        let base = luthier_layer(material, last);
        let lowest = last - select(0u, 1u, base.kind == LUTHIER_DIFFUSE);
        let normal = luthier_own_normal(place, lowest);
        slope += normal.xy / max(normal.z, 1e-3);
    }
    return slope;
}

//? lobes_tilted
/// Energy that a lobe loses beyond the horizon where layers are tilted, by the energy that is left.
fn luthier_lost_below(shape: LuthierLobeShape, energy: vec3<f32>) -> vec3<f32> {
    return energy * (1.0 / max(shape.left, 1e-3) - 1.0);
}

