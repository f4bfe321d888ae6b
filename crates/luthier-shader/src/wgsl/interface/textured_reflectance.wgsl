/// Reflectance of a layer as it is at a place: Schlick's form with another F0 leaves a constant factor of what it left,
/// less what an edge tint keeps.
fn luthier_fresnel_term(layer: LuthierLayer, cos_theta_d: f32) -> vec3<f32> {
    //? own_edge
    {
        let away = 1.0 - saturate(cos_theta_d);
        let cubed = away * away * away;
        let kept = layer.edge * (saturate(cos_theta_d) * cubed * cubed);
        return max(1.0 - layer.passing * (1.0 - luthier_fresnel_given(layer, cos_theta_d)) - kept, vec3<f32>(0.0));
    }
    //? else
    return 1.0 - layer.passing * (1.0 - luthier_fresnel_given(layer, cos_theta_d));
}
