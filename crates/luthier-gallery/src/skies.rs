//! Light from all around for a page: maps, filtered beforehand.

use luthier_environment::{ALPHAS, Blur, Environment, EnvironmentError, Layout, Scenery, Sky};
use luthier_lut::Image;
use luthier_manifest::{Distribution, LayerKind, MaterialEntry};
use serde::Serialize;

use crate::pack;

/// Rows of the maps of sceneries, and of those that are blurred.
const ROWS: u32 = 128;
const BLURRED_ROWS: u32 = 64;

/// The filtered maps that materials read.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Reads {
    beckmann: bool,
    ggx: bool,
    cubes: bool,
}

impl Reads {
    pub(crate) fn of<'a>(materials: impl Iterator<Item = &'a MaterialEntry>) -> Self {
        let mut reads = Self::default();
        for material in materials {
            if material.shows_lobes() {
                reads.cubes = true;
                continue;
            }
            for layer in material.records().filter(|layer| layer.kind != LayerKind::Diffuse) {
                match layer.distribution {
                    Distribution::Ggx | Distribution::Abc(_) => reads.ggx = true,
                    _ => reads.beckmann = true,
                }
            }
        }
        reads
    }
}

/// Surroundings in a page.
#[derive(Debug, Serialize)]
pub(crate) struct PageSky {
    name: String,
    /// Whether the light that pictures have by default belongs to it.
    has_light: bool,
    /// Columns and rows of the map, of irradiance, and of the blurred maps.
    sizes: Vec<[u32; 2]>,
    /// Number of the first blurred map of Beckmann and of GGX; the number of the map itself if there is none.
    chains: [usize; 2],
    maps: String,
    /// Texels along the faces of the largest cube, 0 without cubes; each next one has half of it, down to 4.
    cube: u32,
    /// Texels along the faces of irradiance.
    irradiance: u32,
    cubes: String,
}

impl PageSky {
    /// The studio of pictures without surroundings of their own.
    pub(crate) fn studio(reads: Reads) -> Result<Self, EnvironmentError> {
        let sky = Environment::sky(&Sky::default())?;
        Ok(Self::new("studio", true, sky.map(), &sky, reads))
    }

    /// Surroundings that luthier makes.
    pub(crate) fn scenery(scenery: Scenery, reads: Reads) -> Result<Self, EnvironmentError> {
        let [sharp, blurred] = [scenery.map(ROWS)?, scenery.map(BLURRED_ROWS)?];
        Ok(Self::new(scenery.name(), false, &sharp, &Environment::new(blurred)?, reads))
    }

    fn new(name: &str, has_light: bool, sharp: &Image, sky: &Environment, reads: Reads) -> Self {
        let mut maps: Vec<&Image> = vec![sharp, sky.irradiance_map()];
        let mut chains = [0; 2];
        for (chain, blur, is_read) in [(0, Blur::Beckmann, reads.beckmann), (1, Blur::Ggx, reads.ggx)] {
            if is_read {
                chains[chain] = maps.len();
                maps.extend(sky.chain(blur));
            }
        }
        debug_assert!(maps.len() <= 2 + 2 * ALPHAS.len());
        let sizes = maps.iter().map(|map| [map.width, map.height]).collect();
        let maps = pack::images(maps, false);
        let (mut cube, mut irradiance, mut cubes) = (0, 0, String::new());
        if reads.cubes {
            let even = sky.irradiance_level(Layout::Cube);
            let levels = sky.cube_levels();
            cube = levels[0].images[0].width;
            irradiance = even[0].width;
            cubes = pack::images(levels.iter().flat_map(|level| &level.images).chain(&even), false);
        }
        Self { name: name.to_owned(), has_light, sizes, chains, maps, cube, irradiance, cubes }
    }
}
