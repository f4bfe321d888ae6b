/// Radiance that a prepared material of the model `lobes` sends to the eye from a prefiltered environment; of another model the light of a diffuse
/// base alone. The columns of the frame are tangent, bitangent and normal in the world of the environment. A turn in 0..1 moves the directions that are read: samples of a
/// pixel with turns of their own see more of them.
fn luthier_environment(prepared: LuthierPrepared, frame: mat3x3<f32>, turn: f32) -> vec3<f32> {
    if !prepared.open {
        return vec3<f32>(0.0);
    }
    //? several
    if prepared.model != $model_lobes {
        return prepared.wide * luthier_environment_diffuse(frame[2]);
    }
    return luthier_environment_lobes(prepared.lobes, frame, turn);
}
