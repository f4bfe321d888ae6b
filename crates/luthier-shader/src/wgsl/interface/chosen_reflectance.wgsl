//? fitted
/// Reflectance of a layer as a curve, an approximation that its material asks for: Schlick's form with the F0 of n and k (Elek 2010,
/// FresnelTermNP).
/// Some have a correction taken off, weight cos (1 - cos)^exponent (Lazanyi and Szirmay-Kalos 2005).
fn $fresnel_fitted(layer: LuthierLayer, cos_theta_d: f32) -> vec3<f32> {
    let cosine = saturate(cos_theta_d);
    let away = 1.0 - cosine;
    let away_sq = away * away;
    let schlick = layer.f0 + (1.0 - layer.f0) * (away_sq * away_sq * away);
    //? lazanyi
    {
        // The power of 0 is not defined everywhere.
        let correction = layer.edge_weight * (cosine * pow(vec3<f32>(max(away, 1e-7)), layer.edge_exponent));
        return clamp(schlick - correction, vec3<f32>(0.0), max(layer.f0, vec3<f32>(1.0)));
    }
    //? else
    return schlick;
}

//? several_reflectances
/// Reflectance of a layer, as its material has it.
fn $fresnel_chosen(layer: LuthierLayer, cos_theta_d: f32) -> vec3<f32> {
    //? fitted
    if layer.reflectance > 1u {
        return luthier_fresnel_fitted(layer, cos_theta_d);
    }
    //? rows
    {
        //? computed
        if layer.reflectance == 1u {
            return luthier_fresnel_computed(layer, cos_theta_d);
        }
        return luthier_fresnel_read(layer, cos_theta_d);
    }
    //? else
    return luthier_fresnel_computed(layer, cos_theta_d);
}
