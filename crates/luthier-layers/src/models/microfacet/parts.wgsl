/// Share of a lobe that a masking leaves beyond what Smith's takes away, as an estimate for albedos.
fn luthier_masked_share(layer: LuthierLayer, cos_theta: f32) -> f32 {
    //? several_maskings
    {
        //? mask_implicit
        if layer.masking == 5u {
            return mix(cos_theta * cos_theta, 0.5, layer.alpha);
        }
        //? mask_schlick_smith
        if layer.masking == 2u {
            return luthier_schlick_masking(layer, max(cos_theta, 0.5 * layer.alpha));
        }
        return 1.0;
    }
    //? else
    //? mask_implicit
    return mix(cos_theta * cos_theta, 0.5, layer.alpha);
    //? else
    return luthier_schlick_masking(layer, max(cos_theta, 0.5 * layer.alpha));
}

/// The part of the model `microfacet`: its lobe, or its diffuse base.
fn luthier_parts_microfacet(given: LuthierPrepared, $place_parameter material: u32, wo: vec3<f32>) -> LuthierPrepared {
    var prepared = given;
    let layer = $layer(material, 0u);
    //? microfacet_diffuse
    //? smith
    if layer.kind == LUTHIER_DIFFUSE {
        let light = luthier_mean_light(wo);
        prepared.wide = LUTHIER_PI * $diffuse(layer, light, wo);
        return prepared;
    }
    //? else
    {
        let light = luthier_mean_light(wo);
        prepared.wide = LUTHIER_PI * $diffuse(layer, light, wo);
    }
    //? smith
    {
        var part = luthier_no_part();
        part.energy = luthier_fresnel_term(layer, min(wo.z, 1.0));
        //? mask_implicit|mask_schlick_smith
        part.energy *= luthier_masked_share(layer, min(wo.z, 1.0));
        //? anisotropic
        {
            part.alpha = layer.alpha_xy;
            part.axis = layer.rotation;
        }
        //? else
        part.alpha = vec2<f32>(layer.alpha);
        //? cavities
        part.cavity_power = luthier_cavity_power(layer);
        prepared.parts[0] = part;
        //? microfacet_base
        prepared.wide = LUTHIER_PI * luthier_added_base($place_argument material, luthier_mean_light(wo), wo);
    }
    return prepared;
}
