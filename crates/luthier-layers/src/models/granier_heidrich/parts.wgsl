/// The beam through a film, with energies of the channels.
fn luthier_beam_part(energy: vec3<f32>, exponent: f32, eta: f32, normal: vec3<f32>) -> LuthierPart {
    var part = luthier_no_part();
    part.energy = energy;
    part.exponent = exponent;
    part.eta = eta;
    //? folded
    part.edge = sqrt(max((eta - 1.0) * (eta + 1.0), 0.0)) / eta;
    part.normal = normal;
    return part;
}

/// The parts of the model `granier-heidrich`: the mirrored beam, the transmitted one with the interference of both, and the diffuse term.
fn luthier_parts_granier_heidrich(given: LuthierPrepared, $place_parameter material: u32, wo: vec3<f32>) -> LuthierPrepared {
    var prepared = given;
    let layer = $layer(material, 0u);
    //? granier_film
    let has_film = layer.film_ior_n.x > 0.0;
    //? else
    let has_film = false;
    //? granier_base
    var diffuse = vec3<f32>(1.0);
    //? granier_own
    //? interface
    let own = luthier_own(material, layer.alpha);
    //? else
    let own = luthier_own(material, 1.0);
    //? interface
    {
        var mirror = luthier_no_part();
        mirror.exponent = 2.0 / (layer.alpha * layer.alpha) - 2.0;
    }
    //? granier_transparent
    if layer.kind == LUTHIER_DIELECTRIC || has_film {
        //? granier_film
        let of_index = select(layer.ior_n, layer.film_ior_n, has_film);
        //? else
        let of_index = layer.ior_n;
        //? granier_schlick
        {
            let is_schlick = layer.ior_k.x < 0.0;
            let eta = select(of_index, vec3<f32>(layer.eta), is_schlick);
            let root = (eta - 1.0) / (eta + 1.0);
            let f0 = select(root * root, layer.ior_n, is_schlick);
            mirror.energy = luthier_schlick(f0, wo.z);
        }
        //? else
        {
            let eta = of_index;
            let root = (eta - 1.0) / (eta + 1.0);
            mirror.energy = luthier_schlick(root * root, wo.z);
        }
        let leaving = 1.0 - mirror.energy;
        // The beams interfere as they do along the mirrored direction.
        let inside = sqrt(max(wo.z * wo.z + (eta - 1.0) * (eta + 1.0), vec3<f32>(0.0))) / eta;
        //? granier_own
        {
            let exponent = own.inner_exponent;
            //? granier_height
            {
                // What a lobe of height one carries, of its coefficient. Outside, the same lobe is wider.
                let wider = eta * eta * inside / max(wo.z, 0.05);
                let carried = select(vec3<f32>(1.0), wider * 2.0 * LUTHIER_PI / (exponent + 1.0), own.has_height_one);
                let energy = own.weights.x * carried * (luthier_superpose(layer, mirror.energy, leaving * leaving, 2.0 * inside) - mirror.energy);
            }
            //? else
            let energy = own.weights.x * (luthier_superpose(layer, mirror.energy, leaving * leaving, 2.0 * inside) - mirror.energy);
            //? granier_tilted
            {
                //? place
                let normal = luthier_leaning(own.inner_normal, place.inner_normal);
                //? else
                let normal = own.inner_normal;
                prepared.parts[1] = luthier_beam_part(energy * vec3<f32>(1.0, 0.0, 0.0), exponent, eta.x, normal);
                prepared.parts[2] = luthier_beam_part(energy * vec3<f32>(0.0, 1.0, 0.0), exponent, eta.y, normal);
                prepared.parts[3] = luthier_beam_part(energy * vec3<f32>(0.0, 0.0, 1.0), exponent, eta.z, normal);
            }
            //? else
            prepared.parts[1] = luthier_beam_part(energy, exponent, eta.y, vec3<f32>(0.0, 0.0, 1.0));
        }
        //? else
        {
            let energy = luthier_superpose(layer, mirror.energy, leaving * leaving, 2.0 * inside) - mirror.energy;
            //? place
            {
                let normal = place.inner_normal;
                prepared.parts[1] = luthier_beam_part(energy * vec3<f32>(1.0, 0.0, 0.0), mirror.exponent, eta.x, normal);
                prepared.parts[2] = luthier_beam_part(energy * vec3<f32>(0.0, 1.0, 0.0), mirror.exponent, eta.y, normal);
                prepared.parts[3] = luthier_beam_part(energy * vec3<f32>(0.0, 0.0, 1.0), mirror.exponent, eta.z, normal);
            }
            //? else
            prepared.parts[1] = luthier_beam_part(energy, mirror.exponent, eta.y, vec3<f32>(0.0, 0.0, 1.0));
        }
        //? granier_base
        {
            //? granier_schlick
            let diffuse_reflectance = (20.0 * f0 + 1.0) / 21.0;
            //? else
            let diffuse_reflectance = (21.0 * (eta * eta + 1.0) - 38.0 * eta) / (21.0 * (eta + 1.0) * (eta + 1.0));
            diffuse = luthier_superpose(layer, diffuse_reflectance, 1.0 - diffuse_reflectance, vec3<f32>(2.0));
        }
    }
    //? granier_bare
    if layer.kind == LUTHIER_CONDUCTOR && !has_film {
        mirror.energy = luthier_schlick(luthier_fresnel_term(layer, 1.0), wo.z);
    }
    //? interface
    {
        //? granier_own
        mirror.energy *= own.weights.x;
        //? granier_height
        mirror.energy *= select(1.0, 2.0 * LUTHIER_PI / (mirror.exponent + 1.0), own.has_height_one);
        prepared.parts[0] = mirror;
    }
    //? granier_base
    {
        let last = luthier_layer(material, luthier_layer_count(material) - 1u);
        if last.kind == LUTHIER_DIFFUSE {
            //? granier_own
            prepared.wide = (LUTHIER_PI * own.weights.y) * diffuse * last.lambert;
            //? else
            prepared.wide = LUTHIER_PI * diffuse * last.lambert;
        }
    }
    return prepared;
}
