/// The parts of the model `lobes` are its own; a diffuse base has none.
fn luthier_parts_lobes(given: LuthierPrepared, $place_parameter material: u32, wo: vec3<f32>) -> LuthierPrepared {
    var prepared = given;
    //? lobes_diffuse
    {
        let layer = $layer(material, 0u);
        //? lobes
        if layer.kind == LUTHIER_DIFFUSE {
            let light = luthier_mean_light(wo);
            prepared.wide = LUTHIER_PI * $diffuse(layer, light, wo);
            prepared.model = $model_base;
            return prepared;
        }
        //? else
        {
            let light = luthier_mean_light(wo);
            prepared.wide = LUTHIER_PI * $diffuse(layer, light, wo);
        }
    }
    //? lobes
    prepared.lobes = luthier_prepare_$sides($place_argument material, wo);
    return prepared;
}
