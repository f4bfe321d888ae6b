//! Pictures of a source: unchanged, or computed from one or two.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use luthier_lut::{Picture, PictureSamples, repeated};
use luthier_texture::{Container, picture, png};

use crate::name::Names;

/// A decoded picture, whose values stand as they are stored.
#[derive(Debug)]
pub(crate) struct Texels(Picture);

impl Texels {
    fn decode(bytes: &[u8]) -> Result<Self, String> {
        let decoded = picture::decode(bytes).map_err(|error| error.to_string())?;
        Ok(Self(Picture { is_srgb: false, ..decoded.picture }))
    }

    /// The stored numbers of a texel.
    pub(crate) fn texel(&self, x: u32, y: u32) -> [f64; 4] {
        self.0.texel(x, y).map(f64::from)
    }

    /// The texels at the place of one of another size: bilinear, and repeated.
    pub(crate) fn at(&self, uv: [f64; 2]) -> [f64; 4] {
        self.filtered(uv, |texel| texel)
    }

    /// The meaning of the texels at texture coordinates: bilinear, and repeated.
    pub(crate) fn filtered(&self, [u, v]: [f64; 2], of: impl Fn([f64; 4]) -> [f64; 4]) -> [f64; 4] {
        let [(columns, s), (rows, t)] = [repeated(u, self.0.width), repeated(v, self.0.height)];
        let line = |y: u32| {
            let [a, b] = columns.map(|x| of(self.texel(x, y)));
            [0, 1, 2, 3].map(|c: usize| a[c] + (b[c] - a[c]) * s)
        };
        let [top, bottom] = rows.map(line);
        [0, 1, 2, 3].map(|c: usize| top[c] + (bottom[c] - top[c]) * t)
    }

    /// Width and height.
    pub(crate) fn size(&self) -> [u32; 2] {
        self.0.size()
    }

    /// Whether alpha is 1 everywhere.
    pub(crate) fn is_opaque(&self) -> bool {
        self.0.texels().all(|texel| texel[3] == 1.0)
    }

    /// The largest value of a channel.
    pub(crate) fn most(&self, channel: usize) -> f64 {
        f64::from(self.0.texels().map(|texel| texel[channel]).fold(0.0, f32::max))
    }
}

/// Decoded pictures that are kept: a material computes from few, and a file may have many large ones.
const DECODED: usize = 4;

/// The pictures of an import.
#[derive(Debug, Default)]
pub(crate) struct Pictures {
    files: BTreeMap<String, Vec<u8>>,
    names: Names,
    /// Paths of unchanged pictures by number.
    unchanged: BTreeMap<usize, Result<String, String>>,
    /// Texels of the last pictures that were decoded, by number: at most [`DECODED`].
    decoded: VecDeque<(usize, Result<Arc<Texels>, String>)>,
    /// Paths of computed pictures by what they were computed from.
    computed: BTreeMap<String, String>,
}

impl Pictures {
    /// The path of a picture as it is. `bytes` reads it.
    pub(crate) fn unchanged(
        &mut self,
        number: usize,
        name: &str,
        bytes: impl FnOnce() -> Result<Vec<u8>, String>,
    ) -> Result<String, String> {
        if let Some(known) = self.unchanged.get(&number) {
            return known.clone();
        }
        let found = bytes().and_then(|bytes| {
            // Of the bytes themselves: endings of names are often wrong.
            let decoded = picture::decode(&bytes).map_err(|error| error.to_string())?;
            let ending = match decoded.container {
                Container::Jpeg => "jpg",
                Container::WebP => "webp",
                _ => "png",
            };
            let path = format!("maps/{}.{ending}", self.names.unique(name, &format!("picture-{number}")));
            self.files.insert(path.clone(), bytes);
            Ok(path)
        });
        self.unchanged.insert(number, found.clone());
        found
    }

    /// The texels of a picture.
    pub(crate) fn texels(
        &mut self,
        number: usize,
        bytes: impl FnOnce() -> Result<Vec<u8>, String>,
    ) -> Result<Arc<Texels>, String> {
        if let Some((_, known)) = self.decoded.iter().find(|(known, _)| *known == number) {
            return known.clone();
        }
        let found = bytes().and_then(|bytes| Texels::decode(&bytes)).map(Arc::new);
        self.decoded.truncate(DECODED - 1);
        self.decoded.push_front((number, found.clone()));
        found
    }

    /// The path of a computed picture of one or three numbers a texel, in 16 bits: `of` the texels of up to two pictures, 1 where there is none. It is as wide
    /// and as high as the largest.
    pub(crate) fn computed<const CHANNELS: usize>(
        &mut self,
        name: &str,
        key: &str,
        sources: [Option<&Texels>; 2],
        of: impl Fn([f64; 4], [f64; 4]) -> [f64; CHANNELS],
    ) -> Result<String, String> {
        if let Some(path) = self.computed.get(key) {
            return Ok(path.clone());
        }
        let sizes = sources.iter().flatten().map(|texels| texels.0.size());
        let [width, height] = sizes.fold([1; 2], |most, size| [0, 1].map(|i: usize| most[i].max(size[i])));
        let places = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let samples = places.flat_map(|[x, y]| {
            let [a, b] = sources.map(|texels| {
                texels.map_or([1.0; 4], |texels| {
                    if texels.0.size() == [width, height] {
                        return texels.texel(x, y);
                    }
                    let place = |at: u32, size: u32| (f64::from(at) + 0.5) / f64::from(size);
                    texels.at([place(x, width), place(y, height)])
                })
            });
            of(a, b).map(quantised)
        });
        let path = self.drawn(name, [width, height], CHANNELS as u32, samples.collect())?;
        self.computed.insert(key.to_owned(), path.clone());
        Ok(path)
    }

    /// The path of a picture of 16 bits; that of an equal one where there is one.
    pub(crate) fn drawn(
        &mut self,
        name: &str,
        [width, height]: [u32; 2],
        channels: u32,
        samples: Vec<u16>,
    ) -> Result<String, String> {
        let samples = PictureSamples::Bits16(samples);
        let picture = Picture { width, height, channels, is_srgb: false, samples };
        let bytes = png::encode_picture(&picture).map_err(|error| error.to_string())?;
        if let Some((path, _)) = self.files.iter().find(|(_, known)| **known == bytes) {
            return Ok(path.clone());
        }
        let path = format!("maps/{}.png", self.names.unique(name, "computed"));
        self.files.insert(path.clone(), bytes);
        Ok(path)
    }

    pub(crate) fn into_files(self) -> BTreeMap<String, Vec<u8>> {
        self.files
    }
}

/// A number from 0 to 1 in 16 bits.
pub(crate) fn quantised(value: f64) -> u16 {
    libm::round(value.clamp(0.0, 1.0) * f64::from(u16::MAX)) as u16
}
