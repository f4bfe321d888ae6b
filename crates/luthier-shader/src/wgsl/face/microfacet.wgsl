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
    let light = luthier_mean_light(wo);
    prepared.wide = LUTHIER_PI * $diffuse(layer, light, wo);
    //? end
    //? end
    //? smith
    var part = luthier_no_part();
    part.energy = luthier_fresnel_term(layer, min(wo.z, 1.0));
    //? anisotropic
    part.alpha = layer.alpha_xy;
    part.axis = layer.rotation;
    //? else
    part.alpha = vec2<f32>(layer.alpha);
    //? end
    prepared.parts[0] = part;
    //? end
    return prepared;
}
