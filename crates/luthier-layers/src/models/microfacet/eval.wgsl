//? microfacet_base
/// f of the diffuse base as if no interface lay above it; 0 of materials that add none.
fn luthier_added_base($place_parameter material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    let layer = $layer(material, luthier_layer_count(material) - 1u);
    if layer.kind != LUTHIER_DIFFUSE || luthier_materials[luthier_header(material) + $word_phong_specular].w < 0.5 {
        return vec3<f32>(0.0);
    }
    return $diffuse(layer, wi, wo);
}

/// f cos_theta_i of the first layer alone, one bounce: F D G / (4 cos_theta_o) (Torrance and Sparrow 1967; Walter et al. 2007,
/// eq. 20). What it lets through is lost.
fn luthier_eval_microfacet($place_parameter material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    let layer = $layer(material, 0u);
    //? smith
    {
        //? microfacet_diffuse
        if layer.kind == LUTHIER_DIFFUSE {
            return wi.z * $diffuse(layer, wi, wo);
        }
        let lobe = luthier_smith_lobe(layer, wi, wo);
        //? microfacet_base
        return luthier_fresnel_term(layer, lobe.cos_theta_d) * lobe.value + wi.z * luthier_added_base($place_argument material, wi, wo);
        //? else
        return luthier_fresnel_term(layer, lobe.cos_theta_d) * lobe.value;
    }
    //? else
    return wi.z * $diffuse(layer, wi, wo);
}
