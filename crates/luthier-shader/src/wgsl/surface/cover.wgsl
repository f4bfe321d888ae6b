/// Share of the surface that the first layer of a material covers at a place: weight of a coat times the factor of the place, or amount of patina. Below 0
/// all layers are there.
fn luthier_cover(place: LuthierPlace, material: u32) -> f32 {
    let shape = luthier_materials[luthier_header(material) + $word_patina];
    //? patina
    let other = place.patina;
    //? else
    let other = -1.0;
    return select(other, saturate(shape.x * place.weight_factor), shape.w > 1.5);
}
