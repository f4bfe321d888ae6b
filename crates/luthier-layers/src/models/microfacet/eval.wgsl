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
        return luthier_fresnel_term(layer, lobe.cos_theta_d) * lobe.value;
    }
    //? else
    return wi.z * $diffuse(layer, wi, wo);
}
