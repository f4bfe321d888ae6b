/// Light of the environment that a part in the medium outside mirrors, by one read that is blurred as its facets blur the mirrored direction. A level of
/// a width has the blur of slopes of width / sqrt(2); the cosine of an exponent has that of the width exponent^(-1/2).
fn luthier_environment_part(part: LuthierPart, wo: vec3<f32>, frame: mat3x3<f32>) -> vec3<f32> {
    if part.eta != 1.0 {
        return vec3<f32>(0.0);
    }
    let mirrored = 2.0 * dot(part.normal, wo) * part.normal - wo;
    let of_facets = 1.41421356 * sqrt(part.alpha.x * part.alpha.y);
    let width = select(of_facets, inverseSqrt(max(part.exponent, 1.0)), part.exponent >= 0.0);
    let direction = mirrored.x * frame[0] + mirrored.y * frame[1] + mirrored.z * frame[2];
    return part.energy * luthier_environment_alone(direction, min(width, 1.0));
}

/// Light of the environment that the outer interface of a prepared material mirrors and that diffuse bases return. Lobes of interfaces below are left
/// out (Elek 2010, Algorithm 1, lines 28 and 29).
fn luthier_environment_outside(prepared: LuthierPrepared, frame: mat3x3<f32>) -> vec3<f32> {
    var light = prepared.wide * luthier_environment_diffuse(frame[2]);
    $each_shown
    return light;
}

/// Radiance that a prepared material sends to the eye from a prefiltered environment; of other models than `lobes` that of the first interface, with one
/// read, and of diffuse bases. The columns of the frame are tangent, bitangent and normal in the world of the environment. The turn is 0
/// for one sample of a pixel; samples with turns of their own in 0..1 read other directions for `lobes`, whose mean is nearer.
fn luthier_environment(prepared: LuthierPrepared, frame: mat3x3<f32>, turn: f32) -> vec3<f32> {
    if !prepared.open {
        return vec3<f32>(0.0);
    }
    //? lobes
    {
        //? several
        if prepared.model != $model_lobes {
            return luthier_environment_outside(prepared, frame);
        }
        return luthier_environment_$sides(prepared.lobes, frame, turn);
    }
    //? else
    return luthier_environment_outside(prepared, frame);
}
