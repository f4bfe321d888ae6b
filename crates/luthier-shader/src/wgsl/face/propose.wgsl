/// Number of directions that `luthier_propose` has for a material.
const LUTHIER_PROPOSALS: u32 = $proposals;

/// Sum of the densities in solid angle with which all parts of a prepared material propose a direction in the frame of the place.
fn luthier_proposed_density(prepared: LuthierPrepared, wi: vec3<f32>) -> f32 {
    //? lobes
    //? several
    if prepared.model == $model_lobes {
        return luthier_density_$sides(prepared.lobes, wi);
    }
    //? else
    return luthier_density_$sides(prepared.lobes, wi);
    //? several|!lobes
    {
        var density = wi.z / LUTHIER_PI;
        $each_proposed
        return density;
    }
}

/// A direction of light that one part of a prepared material proposes, from three numbers that are uniform in 0..1 (Weidlich and Wilkie 2009,
/// section 3.2.2): the lobes from the top, and last diffuse light; a material of the model `lobes` has part 0 alone, its draw of `luthier_sample`. The
/// density is that of the part; it is 0 where the part has no light. The weight is f cos_theta_i over the sum of the densities of all parts,
/// so that the sum of the weights of all proposals has the mean of the weights of `luthier_sample`. A path follows one of them and divides
/// its weight by the probability of that choice.
fn luthier_propose(prepared: LuthierPrepared, part: u32, u: vec3<f32>) -> LuthierSample {
    var proposed = LuthierSample(vec3<f32>(0.0, 0.0, -1.0), 0.0, vec3<f32>(0.0), part);
    var density = 0.0;
    //? lobes
    {
        //? several
        let is_whole = prepared.model == $model_lobes;
        //? else
        let is_whole = true;
        if is_whole && part == 0u {
            proposed = luthier_draw_$sides(prepared.lobes, u);
            density = luthier_density_$sides(prepared.lobes, proposed.wi);
        }
        //? several
        if is_whole && part > 0u {
            return proposed;
        }
    }
    //? several|!lobes
    {
        //? lobes
        let is_wide = !is_whole && part == $parts;
        //? else
        let is_wide = part == $parts;
        if is_wide {
            let phi = 2.0 * LUTHIER_PI * u.z;
            proposed.wi = vec3<f32>(sqrt(u.y) * vec2<f32>(cos(phi), sin(phi)), sqrt(1.0 - u.y));
            density = proposed.wi.z / LUTHIER_PI;
        }
        //? visible|powers
        if part < $parts {
            var lobe = luthier_no_part();
            $each_part
            if luthier_chance(lobe) > 0.0 {
                proposed.wi = luthier_draw_part(lobe, prepared.wo, u.yz);
                density = luthier_part_density(lobe, prepared.wo, proposed.wi);
            }
        }
    }
    let here = proposed.wi;
    //? place
    {
        let normal = prepared.place.normal;
        proposed.wi = luthier_local(vec3<f32>(-normal.xy, normal.z), here);
    }
    if min(here.z, proposed.wi.z) > 0.0 && density > 0.0 && prepared.open {
        proposed.pdf = density;
        proposed.weight = luthier_light(prepared, proposed.wi) / luthier_proposed_density(prepared, here);
    }
    return proposed;
}
