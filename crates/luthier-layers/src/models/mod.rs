//! Reflectance models, each under its own name.
//!
//! Each model with a shader has a room, [`room::Room`]: a folder with its formula, its kernels in WGSL, and `eval.rs`, the f64 twin of
//! `eval.wgsl`. Models of a path and models of statistics share the twin of their family: `path/eval.rs` and `statistics/eval.rs`.

pub mod belcour;
pub mod densities;
pub mod diffuse;
pub mod elek;
pub mod granier_heidrich;
pub mod lobes;
pub mod microfacet;
pub mod parts;
pub mod path;
pub mod phong;
pub mod room;
pub mod shade;
pub mod statistics;
pub mod weidlich_wilkie;
pub mod yamaguchi;

use luthier_model::ShadingModel;

use room::Room;

/// The room of a model.
pub fn room(model: ShadingModel) -> Room {
    match model {
        ShadingModel::Elek => elek::ROOM,
        ShadingModel::WeidlichWilkie => weidlich_wilkie::ROOM,
        ShadingModel::GranierHeidrich => granier_heidrich::ROOM,
        ShadingModel::Belcour => belcour::ROOM,
        ShadingModel::Yamaguchi => yamaguchi::ROOM,
        ShadingModel::Phong => phong::ROOM,
        ShadingModel::Microfacet => microfacet::ROOM,
        ShadingModel::Lobes => lobes::ROOM,
    }
}
