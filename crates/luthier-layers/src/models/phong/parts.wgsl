/// The parts of the model `phong`: its lobe and its diffuse term.
fn luthier_parts_phong(given: LuthierPrepared, $place_parameter material: u32, wo: vec3<f32>) -> LuthierPrepared {
    var prepared = given;
    let header = luthier_header(material);
    let diffuse = luthier_materials[header + $word_phong_diffuse];
    var part = luthier_no_part();
    part.energy = luthier_materials[header + $word_phong_specular].rgb;
    //? place
    part.exponent = max((diffuse.w + 0.5) / (place.alpha_factor * place.alpha_factor) - 0.5, 0.0);
    //? else
    part.exponent = diffuse.w;
    prepared.parts[0] = part;
    prepared.wide = diffuse.rgb;
    return prepared;
}
