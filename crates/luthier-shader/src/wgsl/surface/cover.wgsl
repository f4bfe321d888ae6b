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

//? weight_film
/// Whether the weight of a material is that of a film: the bare record is the first layer without it.
fn luthier_weighs_film(material: u32) -> bool {
    return luthier_materials[luthier_header(material) + $word_patina].w > 2.5;
}

//? lobes_sides
{
    /// Whether the layers that the coat or the film of a material leaves bare have lobes of their own.
    fn luthier_has_side(material: u32) -> bool {
        return (u32(luthier_materials[luthier_header(material) + $word_patina_diffuse_albedo].w) & LUTHIER_OVER_SIDE) != 0u;
    }

    /// These layers, or those without the film on the first, as a material: their header lies behind the layers of the material and the bare one, which are
    /// as long as a header.
    fn luthier_side(material: u32) -> u32 {
        // Whole numbers below 2^23 have no remainder.
        let first = f32(luthier_whole(luthier_materials[luthier_header(material)].x));
        let block = u32(first / f32(LUTHIER_MATERIAL_WORDS) + 0.5);
        return block + luthier_layer_count(material) + 1u;
    }

    /// Weight of the coat or of the film of a material with such layers.
    fn luthier_side_weight(material: u32) -> f32 {
        return luthier_materials[luthier_header(luthier_side(material))].z;
    }
}
