//! Options of `eval` that only some models take.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use glam::DVec2;
use luthier::function::{Inputs, LiveValue};
use luthier_layers::model::{Input, Model};
use luthier_layers::registry::models;
use luthier_manifest::ShadingModel;
use luthier_material::Effects;
use luthier_model::Family;
use luthier_optics::Rgb;
use luthier_terminal::{Failure, Outcome};

use crate::directions::Angles;
use crate::numbers::{not_negative, number, share, wavelength};

#[derive(Debug, Args)]
#[command(next_help_heading = "Options of some models")]
pub(crate) struct ModelInputs {
    /// Texture coordinate of the place; 0,0 for effects and maps of layers of the file (flakes, heterogeneous and its kind)
    #[arg(long, value_name = "U,V", allow_hyphen_values = true)]
    uv: Option<Uv>,
    /// Distance of the eye, in scene units; 0 for flakes of the file (flakes)
    #[arg(long, value_name = "X", value_parser = not_negative, allow_hyphen_values = true)]
    pub(crate) distance: Option<f64>,
    /// How far the patina has developed, in place of what the file says: below 0 not at all, above 1 everywhere (patina)
    #[arg(long, value_name = "X", value_parser = number, allow_hyphen_values = true)]
    pub(crate) extent: Option<f64>,
    /// Value of the patina's map at the place in place of the map's, 0 to 1; dark places come first (patina)
    #[arg(long, value_name = "X", value_parser = share, allow_hyphen_values = true)]
    pub(crate) map: Option<f64>,
    /// Leave out what the file says under `effects` and its maps of single layers, as `luthier_eval` of the shaders does without a place
    #[arg(long)]
    no_effects: bool,
    /// Normal of the inner boundary of the film (granier-heidrich)
    #[arg(long, value_name = "THETA,PHI", allow_hyphen_values = true)]
    inner_normal: Option<Angles>,
    /// Weights of the layers from the top in a mixture of their densities, each at least 0, over their sum; in proportion to their light unless given
    /// (density-layers-local)
    #[arg(long, value_name = "W,...", value_delimiter = ',', value_parser = not_negative)]
    pub(crate) weights: Vec<f64>,
    /// A second material; without it both are the same (heterogeneous and its kind)
    #[arg(long, value_name = "FILE")]
    pub(crate) other: Option<PathBuf>,
    /// Re-radiation matrix of the base as a CSV file, see below; --wavelength is the light seen (fluorescence)
    #[arg(long, value_name = "CSV", requires = "excitation")]
    #[arg(conflicts_with_all = ["furnace", "alpha_factor", "slab_factor", "film_factor", "slope_variance"])]
    pub(crate) matrix: Option<PathBuf>,
    /// Wavelength of the light, when it is not the one seen (fluorescence)
    #[arg(long, value_name = "NM", value_parser = wavelength)]
    #[arg(requires = "matrix", requires = "wavelength")]
    pub(crate) excitation: Option<f64>,
    /// Random samples per value (random-walk, layered-mc and its kind); 4096 unless given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    samples: Option<u64>,
    /// Which random numbers (random-walk, layered-mc and its kind)
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    #[command(flatten)]
    textures: Textures,
    /// Value of a number that the file has under `live`, as a program would write it into the place: a factor, or a colour, with the layer counted from 0,
    /// for models with a shader; may be given several times
    #[arg(long, value_name = "KEY=X,...", conflicts_with_all = ["furnace", "environment"])]
    pub(crate) live: Vec<LiveOption>,
}

/// Values of the textures at the place, for any model.
#[derive(Debug, Args)]
#[command(next_help_heading = "Textures at the place, for every model")]
struct Textures {
    /// Normal of the place
    #[arg(long, value_name = "THETA,PHI", allow_hyphen_values = true, conflicts_with_all = ["furnace", "environment"])]
    normal: Option<Angles>,
    /// Factor on the slope parameters of all layers
    #[arg(long, value_name = "X", value_parser = not_negative, allow_hyphen_values = true)]
    alpha_factor: Option<f64>,
    /// Factor on the thickness of the slab below the first interface
    #[arg(long, value_name = "X", value_parser = not_negative, allow_hyphen_values = true)]
    slab_factor: Option<f64>,
    /// Factor on the thickness of the films on the first interface
    #[arg(long, value_name = "X", value_parser = not_negative, allow_hyphen_values = true)]
    film_factor: Option<f64>,
    /// Factor on the weight of the first layer, a coat, or of the film on it
    #[arg(long, value_name = "X", value_parser = not_negative, allow_hyphen_values = true)]
    weight_factor: Option<f64>,
    /// Variance, along either axis, of the slopes of the normals that a pixel sees
    #[arg(long, value_name = "X", value_parser = not_negative, allow_hyphen_values = true)]
    slope_variance: Option<f64>,
    /// Albedo of the diffuse base, in place of that of the file, for models with a shader
    #[arg(long, value_name = "R,G,B", conflicts_with_all = ["furnace", "environment"])]
    base_color: Option<BaseColor>,
}

impl ModelInputs {
    /// The inputs that these options give.
    pub(crate) fn given(&self) -> Inputs {
        let Textures { normal, alpha_factor, slab_factor, film_factor, weight_factor, slope_variance, base_color } =
            self.textures;
        Inputs {
            uv: self.uv.map(|Uv(uv)| uv),
            distance: self.distance,
            extent: self.extent,
            map: self.map,
            no_effects: self.no_effects,
            inner_normal: self.inner_normal.map(Angles::direction),
            weights: self.weights.clone(),
            samples: self.samples,
            seed: self.seed,
            normal: normal.map(Angles::direction),
            alpha_factor,
            slab_factor,
            film_factor,
            weight_factor,
            slope_variance,
            base_color: base_color.map(|BaseColor(rgb)| rgb),
            live: self.live.iter().map(|LiveOption(live)| live.clone()).collect(),
        }
    }

    /// Refuses options that neither the model, nor the effects that it shows, nor the choice of a surface take.
    pub(crate) fn check(
        &self,
        model: &dyn Model,
        shown: &Effects,
        has_maps: bool,
        is_surface: bool,
        environment: bool,
    ) -> Outcome {
        let given = [
            (Input::OtherStack, self.other.is_some()),
            (Input::Environment, environment),
            (Input::Matrix, self.matrix.is_some()),
            (Input::Excitation, self.excitation.is_some()),
        ];
        let info = model.info();
        if self.textures.base_color.is_some() && !info.shading().is_some_and(takes_base_color) {
            let takers = ShadingModel::ALL.into_iter().filter(|model| takes_base_color(*model)).map(ShadingModel::name);
            let takers: Vec<&str> = takers.collect();
            return Err(Failure::Usage(anyhow::anyhow!(
                "model `{}` does not take --base-color; those that do: {}",
                info.name,
                takers.join(", ")
            )));
        }
        let refused = self.given().not_taken(model, shown, has_maps, is_surface);
        let own = given.into_iter().find(|(input, is_given)| *is_given && !info.inputs.contains(input));
        let Some(input) = refused.or(own.map(|(input, _)| input)) else { return Ok(()) };
        let infos = models().into_iter().map(|model| model.info());
        let takers: Vec<&str> = infos.filter(|i| i.inputs.contains(&input)).map(|i| i.name).collect();
        let effects = match input {
            Input::Uv => {
                "; and `elek`, `weidlich-wilkie` and `lobes` for a file with flakes or patina, any model for one with glitter and for a surface; and models that show the maps of layers of a file"
            }
            Input::Distance => "; and `elek`, `weidlich-wilkie` and `lobes` for a file with flakes",
            Input::Extent | Input::Map => "; and `elek`, `weidlich-wilkie` and `lobes` for a file with patina",
            _ => "",
        };
        Err(Failure::Usage(anyhow::anyhow!(
            "model `{}` does not take --{}; those that do: {}{effects}",
            info.name,
            input.name(),
            takers.join(", ")
        )))
    }
}

#[derive(Debug, Clone, Copy)]
struct Uv(DVec2);

impl FromStr for Uv {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once(',').map(|(u, v)| [u, v].map(|text| number(text.trim()))) {
            Some([Ok(u), Ok(v)]) => Ok(Self(DVec2::new(u, v))),
            _ => Err("expected a texture coordinate u,v, such as 0.25,0.5".to_owned()),
        }
    }
}

#[derive(Debug, Clone, Copy)]
struct BaseColor(Rgb);

impl FromStr for BaseColor {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let values: Result<Vec<f64>, String> = text.split(',').map(|part| share(part.trim())).collect();
        let rgb = values.ok().and_then(|values| Rgb::try_from(values).ok());
        rgb.map(Self).ok_or_else(|| "expected three numbers from 0 to 1, such as 0.8,0.3,0.1".to_owned())
    }
}

/// A live number, and the value that it gets.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LiveOption(LiveValue);

impl FromStr for LiveOption {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text.split_once('=').and_then(|(key, values)| {
            let (layer, name) = key.trim().strip_prefix("layer.")?.split_once('.')?;
            let values: Option<Vec<f64>> = values.split(',').map(|value| number(value.trim()).ok()).collect();
            Some(LiveValue { layer: layer.parse().ok()?, name: name.to_owned(), values: values? })
        });
        let expected = "expected a key and numbers, such as layer.1.base_color=0.8,0.3,0.1";
        parsed.filter(|live| live.values.len() <= 3).map(Self).ok_or_else(|| expected.to_owned())
    }
}

fn takes_base_color(model: ShadingModel) -> bool {
    model.facts().family != Family::Coefficients
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_those_of_layers() {
        let LiveOption(live) = "layer.1.base_color=0.8, 0.3,0.1".parse().unwrap();
        assert_eq!((live.layer, live.name.as_str(), live.values.as_slice()), (1, "base_color", &[0.8, 0.3, 0.1][..]));
        for wrong in ["base_color=1", "layer.x.alpha=1", "layer.0.alpha", "layer.0.alpha=", "layer.0.alpha=1,1,1,1"] {
            assert!(wrong.parse::<LiveOption>().is_err(), "{wrong}");
        }
    }
}
