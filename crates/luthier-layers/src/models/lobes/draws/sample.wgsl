/// Ways in which a material is drawn from, and their chances.
struct LuthierLobesDraw {
    /// Probabilities of the first facet, of two lobes and of the wide remainder, times the sum of all.
    chances: vec4<f32>,
    //? three_lobes
    {
        /// Probability of the third lobe, times the sum of all.
        third_chance: f32,
        third: LuthierLobeDraw,
    }
    wide: vec3<f32>,
    //? one_lobe|two_lobes
    first: LuthierLobeDraw,
    //? two_lobes
    second: LuthierLobeDraw,
}

fn luthier_lobes_draw(prepared: LuthierPreparedLobes) -> LuthierLobesDraw {
    let third = vec3<f32>(1.0 / 3.0);
    let wide = dot(prepared.wide, third);
    var facets = dot(luthier_albedo_lobes(prepared), third) - wide;
    var given: LuthierLobesDraw;
    given.wide = luthier_wide_draw(prepared);
    //? lobes_patina
    facets -= luthier_bare_energy(prepared);
    //? one_lobe|two_lobes
    {
        facets -= dot(luthier_lobe_below(prepared, 0u).energy, third);
        given.first = luthier_lobe_draw(prepared, prepared.first_shape);
        given.chances.y = max(dot(prepared.first_strength, third) * given.first.chance, 0.0);
    }
    //? two_lobes
    {
        facets -= dot(luthier_lobe_below(prepared, 1u).energy, third);
        given.second = luthier_lobe_draw(prepared, prepared.second_shape);
        given.chances.z = max(dot(prepared.second_strength, third) * given.second.chance, 0.0);
    }
    //? three_lobes
    {
        facets -= dot(luthier_lobe_below(prepared, 2u).energy, third);
        given.third = luthier_lobe_draw(prepared, prepared.third_shape);
        given.third_chance = max(dot(prepared.third_strength, third) * given.third.chance, 0.0);
    }
    // Factors are bounds on weights. The remainder takes some draws over from facets: see the f64 twin.
    let boosted = 1.3 * max(facets, 0.0);
    given.chances.x = 0.96 * boosted;
    // A material that reflects nothing has a remainder without light.
    given.chances.w = max(wide, 0.0) * given.wide.z + 0.04 * boosted + 1e-6;
    return given;
}

/// Sum of the chances of the first facet, of the lobes and of the wide remainder.
fn luthier_total_chance(given: LuthierLobesDraw) -> f32 {
    //? three_lobes
    return dot(given.chances, vec4<f32>(1.0)) + given.third_chance;
    //? else
    return dot(given.chances, vec4<f32>(1.0));
}

/// Density in solid angle with which `luthier_draw_lobes` draws a direction above the horizon.
fn luthier_density_lobes(prepared: LuthierPreparedLobes, wi: vec3<f32>) -> f32 {
    let given = luthier_lobes_draw(prepared);
    let chances = given.chances;
    var density = chances.x * luthier_facet_density(prepared, wi) + chances.w * luthier_wide_density(given.wide, wi.z);
    //? one_lobe|two_lobes
    density += chances.y * luthier_lobe_density(prepared, given.first, prepared.first_shape, wi);
    //? two_lobes
    density += chances.z * luthier_lobe_density(prepared, given.second, prepared.second_shape, wi);
    //? three_lobes
    density += given.third_chance * luthier_lobe_density(prepared, given.third, prepared.third_shape, wi);
    //? lobes_patina
    {
        let bare = luthier_bare_energy(prepared);
        density += bare * luthier_facet_density(luthier_bare_lobes(prepared), wi);
        return density / (luthier_total_chance(given) + bare);
    }
    //? else
    return density / luthier_total_chance(given);
}

/// Direction and part of a draw, without its density and weight: 0 the first facet, that of a bare layer too, 1 and 2 the lobes, 3 the wide remainder, 4 a third lobe.
fn luthier_draw_lobes(prepared: LuthierPreparedLobes, u: vec3<f32>) -> LuthierSample {
    let given = luthier_lobes_draw(prepared);
    let chances = given.chances;
    //? lobes_patina
    {
        let total = luthier_total_chance(given);
        let choice = u.x * (total + luthier_bare_energy(prepared));
    }
    //? else
    let choice = u.x * luthier_total_chance(given);
    let lobes = chances.x + chances.y + chances.z;
    //? three_lobes
    let of_wide = (choice - (lobes + given.third_chance)) / chances.w;
    //? else
    let of_wide = (choice - lobes) / chances.w;
    var drawn = LuthierSample(luthier_draw_wide(given.wide, vec3<f32>(saturate(of_wide), u.yz)), 0.0, vec3<f32>(0.0), 3u);
    if choice < chances.x {
        drawn.wi = luthier_draw_facet(prepared, vec3<f32>(choice / chances.x, u.yz));
        drawn.part = 0u;
    }
    //? lobes_patina
    if choice > total {
        drawn.wi = luthier_draw_facet(luthier_bare_lobes(prepared), vec3<f32>((choice - total) / max(luthier_bare_energy(prepared), 1e-6), u.yz));
        drawn.part = 0u;
    }
    //? one_lobe|two_lobes
    {
        let first = chances.x + chances.y;
        if choice >= chances.x && choice < first {
            drawn.wi = luthier_sample_lobe(prepared, given.first, prepared.first_shape, u.yz);
            drawn.part = 1u;
        }
    }
    //? two_lobes
    if choice >= first && choice < first + chances.z {
        drawn.wi = luthier_sample_lobe(prepared, given.second, prepared.second_shape, u.yz);
        drawn.part = 2u;
    }
    //? three_lobes
    if choice >= lobes && choice < lobes + given.third_chance {
        drawn.wi = luthier_sample_lobe(prepared, given.third, prepared.third_shape, u.yz);
        drawn.part = 4u;
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
