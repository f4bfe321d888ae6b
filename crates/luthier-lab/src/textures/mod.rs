//! `textures`: the maps of the materials in `materials/textured`, made by programs. They repeat, and their bytes depend on nothing else.

mod noise;
mod patterns;

use std::path::Path;

use luthier_lut::Image;
use luthier_optics::Rgb;
use luthier_terminal::{Failure, Outcome, files};
use luthier_texture::{TextureError, png};

use crate::cli::TexturesOptions;
use patterns::Scratches;

/// A function over the unit square.
type Pattern = Box<dyn Fn([f64; 2]) -> Rgb>;

/// Meaning of the texels of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Colours, stored by the sRGB curve.
    Color,
    /// Numbers from 0 to 1.
    Number,
}

/// A map: name, texels a side, meaning of the texels, and the function.
struct Map(&'static str, u32, Kind, Pattern);

/// All maps.
fn maps() -> Vec<Map> {
    use Kind::{Color, Number};
    let scratches = Scratches::new();
    vec![
        Map("oak-color", 128, Color, Box::new(patterns::oak_color)),
        Map("oak-alpha", 128, Number, Box::new(patterns::oak_alpha)),
        Map("brass-color", 128, Color, Box::new(patterns::brass_color)),
        Map("brass-metal", 256, Number, Box::new(patterns::brass_metal)),
        Map("brass-alpha", 128, Number, Box::new(patterns::brass_alpha)),
        Map("brass-lacquer", 256, Number, Box::new(patterns::brass_lacquer)),
        Map("scratches", 256, Number, Box::new(move |place| scratches.alpha(place))),
        Map("plate-color", 256, Color, Box::new(patterns::plate_color)),
        Map("plate-roughness", 128, Number, Box::new(patterns::plate_roughness)),
        Map("white", 1, Number, Box::new(|_| [1.0; 3])),
        Map("glaze-thickness", 256, Number, Box::new(patterns::glaze_thickness)),
        Map("stone-albedo", 128, Color, Box::new(patterns::stone_albedo)),
    ]
}

impl Map {
    /// The PNG. Texels are the function at their centres.
    fn png(&self) -> Result<Vec<u8>, TextureError> {
        let Self(_, size, kind, pattern) = self;
        let mut image = Image::zeros(*size, *size, if *kind == Kind::Color { 3 } else { 1 });
        for y in 0..*size {
            for x in 0..*size {
                let texel = pattern([x, y].map(|i| (f64::from(i) + 0.5) / f64::from(*size)));
                let channels = image.texel_mut(x, y);
                channels.iter_mut().zip(texel).for_each(|(channel, value)| *channel = value as f32);
            }
        }
        match kind {
            Kind::Color => png::encode_image(&image),
            Kind::Number => png::encode_gray(&image),
        }
    }
}

/// Writes all maps into a folder.
pub(crate) fn run(options: &TexturesOptions) -> Outcome {
    std::fs::create_dir_all(&options.output).map_err(files(&options.output, "create"))?;
    maps().iter().try_for_each(|map| write(map, &options.output))
}

fn write(map: &Map, folder: &Path) -> Outcome {
    let path = folder.join(format!("{}.png", map.0));
    let file = map.png().map_err(|error| Failure::Input(error.into()))?;
    std::fs::write(&path, file).map_err(files(&path, "write"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../materials/textured/maps");

    #[test]
    fn maps_that_ship_are_those_that_are_made() {
        let mut made: Vec<String> = maps().iter().map(|map| format!("{}.png", map.0)).collect();
        for map in maps() {
            let path = format!("{FOLDER}/{}.png", map.0);
            let is_same = std::fs::read(&path).unwrap() == map.png().unwrap();
            assert!(is_same, "{path} is out of date: run luthier-lab textures -o materials/textured/maps");
        }
        let entries = std::fs::read_dir(FOLDER).unwrap();
        let mut there: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        made.sort();
        there.sort();
        assert_eq!(there, made);
    }

    /// The materials are no package of a bake of `materials`, which is timed, and all of them are materials.
    #[test]
    fn the_sample_board_is_a_package_of_its_own() {
        let folder = |name: &str| [format!("{}/../../materials{name}", env!("CARGO_MANIFEST_DIR")).into()];
        let packages = luthier::Files::packages(&folder("")).unwrap();
        let names: Vec<&str> = packages.iter().map(|(name, ..)| name.as_str()).collect();
        assert_eq!(names, ["", "papers"]);
        let mut sources = luthier::Sources::of(luthier::Files::read(&folder("/textured")).unwrap());
        sources.refuse(&luthier::Shading::default());
        assert!(sources.is_usable(), "{:?}", sources.diagnostics().collect::<Vec<_>>());
        let materials = sources.materials(&luthier::Shading::default());
        assert!(materials.len() == 5 && materials.iter().all(|material| !material.images().is_empty()));
    }

    /// Small enough to lie in the repository.
    #[test]
    fn maps_are_small() {
        for map in maps() {
            let bytes = map.png().unwrap().len();
            assert!(map.1 <= 256 && bytes < 60 * 1024, "{}: {bytes}", map.0);
        }
    }
}
