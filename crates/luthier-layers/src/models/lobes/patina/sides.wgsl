//? lobes_sides
{
    /// A coat or a film with a weight on layers that have lobes of their own, as seen from a direction: both surfaces, by area.
    struct LuthierPreparedSides {
        /// Share of the surface that the coat covers.
        cover: f32,
        /// All layers, if some of the surface is covered.
        coated: LuthierPreparedLobes,
        /// The layers below the coat, if some of the surface is bare.
        bare: LuthierPreparedLobes,
        //? lobes_side_frames
        {
            /// Normals of both sides in the frame of the directions.
            coated_normal: vec3<f32>,
            bare_normal: vec3<f32>,
            /// Whether the eye is above the horizon of either.
            coated_open: bool,
            bare_open: bool,
        }
        //? lobes_side_bases
        {
            /// The diffuse base that is bare in their place, and the eye.
            base: LuthierLayer,
            is_base: bool,
            wo: vec3<f32>,
        }
    }

    /// The material as seen from wo, above the horizon.
    fn luthier_prepare_sides($place_parameter material: u32, wo: vec3<f32>) -> LuthierPreparedSides {
        var prepared: LuthierPreparedSides;
        prepared.cover = 1.0;
        //? lobes_side_frames
        {
            var coated_place = place;
            var coated_eye = wo;
            prepared.coated_normal = vec3<f32>(0.0, 0.0, 1.0);
            prepared.bare_normal = vec3<f32>(0.0, 0.0, 1.0);
            prepared.coated_open = true;
            prepared.bare_open = true;
        }
        //? ~lobes_sides
        let has_side = luthier_has_side(material);
        //? else
        let has_side = true;
        if has_side {
            let side = luthier_side(material);
            prepared.cover = saturate(luthier_side_weight(material) * place.weight_factor);
            //? lobes_side_frames
            {
                coated_place = luthier_place_on_first(place);
                prepared.coated_normal = coated_place.normal;
                let above_coat = luthier_local(coated_place.normal, wo);
                prepared.coated_open = above_coat.z > 0.0;
                // The limit keeps finite what is not shown.
                coated_eye = vec3<f32>(above_coat.xy, max(above_coat.z, 1e-16));
            }
            if prepared.cover < 1.0 {
                //? lobes_side_frames
                {
                    let on_coat = luthier_place_below_coat(place, luthier_layer_count(material) - luthier_layer_count(side));
                    let below = luthier_place_on_first(on_coat);
                    prepared.bare_normal = below.normal;
                    let above_bare = luthier_local(below.normal, wo);
                    prepared.bare_open = above_bare.z > 0.0;
                    let eye = vec3<f32>(above_bare.xy, max(above_bare.z, 1e-16));
                }
                //? else
                let below = luthier_place_below_coat(place, luthier_layer_count(material) - luthier_layer_count(side));
                //? lobes_side_bases
                {
                    //? lobes_side_rows
                    let is_base = luthier_layer(side, 0u).kind == LUTHIER_DIFFUSE;
                    //? else
                    let is_base = true;
                    prepared.is_base = is_base;
                    //? lobes_side_frames
                    prepared.wo = eye;
                    //? else
                    prepared.wo = wo;
                    if is_base {
                        prepared.base = luthier_layer_at(below, side, 0u);
                    }
                }
                //? else
                let is_base = false;
                //? lobes_side_rows
                if !is_base {
                    //? lobes_side_frames
                    prepared.bare = luthier_prepare_lobes(below, side, eye);
                    //? else
                    prepared.bare = luthier_prepare_lobes(below, side, wo);
                }
            }
        }
        if prepared.cover > 0.0 {
            //? lobes_side_frames
            prepared.coated = luthier_prepare_lobes(coated_place, material, coated_eye);
            //? else
            prepared.coated = luthier_prepare_lobes(place, material, wo);
        }
        return prepared;
    }

    /// f cos_theta_i of the layers below the coat.
    fn luthier_light_bare_side(prepared: LuthierPreparedSides, wi: vec3<f32>) -> vec3<f32> {
        //? lobes_side_bases
        if prepared.is_base {
            let layer = prepared.base;
            return wi.z * $diffuse(layer, wi, prepared.wo);
        }
        //? lobes_side_rows
        return luthier_light_lobes(prepared.bare, wi);
        //? else
        return vec3<f32>(0.0);
    }

    /// f cos_theta_i of both sides for light from wi, above the horizon.
    fn luthier_light_sides(prepared: LuthierPreparedSides, wi: vec3<f32>) -> vec3<f32> {
        var value = vec3<f32>(0.0);
        //? lobes_side_frames
        {
            let coated_wi = luthier_local(prepared.coated_normal, wi);
            let bare_wi = luthier_local(prepared.bare_normal, wi);
            if prepared.cover > 0.0 && prepared.coated_open && coated_wi.z > 0.0 {
                value = prepared.cover * luthier_light_lobes(prepared.coated, coated_wi);
            }
            if prepared.cover < 1.0 && prepared.bare_open && bare_wi.z > 0.0 {
                value += (1.0 - prepared.cover) * luthier_light_bare_side(prepared, bare_wi);
            }
        }
        //? else
        {
            if prepared.cover > 0.0 {
                value = prepared.cover * luthier_light_lobes(prepared.coated, wi);
            }
            if prepared.cover < 1.0 {
                value += (1.0 - prepared.cover) * luthier_light_bare_side(prepared, wi);
            }
        }
        return value;
    }

    //? face
    {
        /// Directional albedo of the layers below the coat, RGB.
        fn luthier_albedo_bare_side(prepared: LuthierPreparedSides) -> vec3<f32> {
            //? lobes_side_bases
            if prepared.is_base {
                let layer = prepared.base;
                let light = luthier_mean_light(prepared.wo);
                return LUTHIER_PI * $diffuse(layer, light, prepared.wo);
            }
            //? lobes_side_rows
            return luthier_albedo_lobes(prepared.bare);
            //? else
            return vec3<f32>(0.0);
        }

        /// Albedo of the covered share of the surface, and of the bare one, each times the share.
        fn luthier_albedos_of_sides(prepared: LuthierPreparedSides) -> array<vec3<f32>, 2> {
            var albedos = array<vec3<f32>, 2>(vec3<f32>(0.0), vec3<f32>(0.0));
            if prepared.cover > 0.0 {
                albedos[0] = prepared.cover * luthier_albedo_lobes(prepared.coated);
            }
            if prepared.cover < 1.0 {
                albedos[1] = (1.0 - prepared.cover) * luthier_albedo_bare_side(prepared);
            }
            //? lobes_side_frames
            {
                albedos[0] = select(vec3<f32>(0.0), albedos[0], prepared.coated_open);
                albedos[1] = select(vec3<f32>(0.0), albedos[1], prepared.bare_open);
            }
            return albedos;
        }

        /// Directional albedo of both sides, RGB.
        fn luthier_albedo_sides(prepared: LuthierPreparedSides) -> vec3<f32> {
            let albedos = luthier_albedos_of_sides(prepared);
            return albedos[0] + albedos[1];
        }

        /// Probability that a direction is drawn for the covered share.
        fn luthier_covered_chance(prepared: LuthierPreparedSides) -> f32 {
            let albedos = luthier_albedos_of_sides(prepared);
            let third = vec3<f32>(1.0 / 3.0);
            // A side that reflects nothing has draws without light.
            let chances = max(vec2<f32>(dot(albedos[0], third), dot(albedos[1], third)), vec2<f32>(0.0)) + 1e-6;
            let chance = chances.x / (chances.x + chances.y);
            //? lobes_side_frames
            {
                // No draws for a side that turns away from the eye, as long as the other has some.
                let is_bare = prepared.cover <= 0.0 || !prepared.coated_open;
                let is_whole = prepared.cover >= 1.0 || (!prepared.bare_open && prepared.cover > 0.0);
                return select(select(chance, 0.0, is_bare), 1.0, is_whole);
            }
            //? else
            return select(select(chance, 0.0, prepared.cover <= 0.0), 1.0, prepared.cover >= 1.0);
        }
    }
}
