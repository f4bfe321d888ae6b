//! Pictures of a source: unchanged, or computed from one or two.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::rc::Rc;

use image::{DynamicImage, ImageBuffer, ImageFormat, ImageReader, Limits, Luma, Rgb};

use crate::name::Names;

/// Most texels a side.
const SIDE_MAX: u32 = 16384;

/// Most bytes of a decoded picture.
const DECODED_MAX: u64 = 512 << 20;

/// Texels as they are stored, from 0 to 1, RGBA.
#[derive(Debug)]
pub(crate) struct Texels {
    width: u32,
    height: u32,
    data: Vec<[f32; 4]>,
}

impl Texels {
    fn decode(bytes: &[u8]) -> Result<Self, String> {
        let mut reader =
            ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|error| error.to_string())?;
        let mut limits = Limits::default();
        limits.max_image_width = Some(SIDE_MAX);
        limits.max_image_height = Some(SIDE_MAX);
        limits.max_alloc = Some(DECODED_MAX);
        reader.limits(limits);
        let picture = reader.decode().map_err(|error| error.to_string())?.into_rgba32f();
        let (width, height) = picture.dimensions();
        let data = picture.pixels().map(|pixel| pixel.0).collect();
        Ok(Self { width, height, data })
    }

    /// The texels at the place of one of another size: bilinear, and repeated.
    fn at(&self, [u, v]: [f64; 2]) -> [f64; 4] {
        let place = |at: f64, size: u32| {
            let at = at * f64::from(size) - 0.5;
            let first = at.floor();
            let wrapped = |i: f64| i.rem_euclid(f64::from(size)) as u32;
            ([wrapped(first), wrapped(first + 1.0)], at - first)
        };
        let ([x0, x1], s) = place(u, self.width);
        let ([y0, y1], t) = place(v, self.height);
        let texel = |x: u32, y: u32| self.data[(y * self.width + x) as usize].map(f64::from);
        let [a, b, c, d] = [texel(x0, y0), texel(x1, y0), texel(x0, y1), texel(x1, y1)];
        [0, 1, 2, 3].map(|i: usize| (1.0 - t) * ((1.0 - s) * a[i] + s * b[i]) + t * ((1.0 - s) * c[i] + s * d[i]))
    }

    /// Whether alpha is 1 everywhere.
    pub(crate) fn is_opaque(&self) -> bool {
        self.data.iter().all(|texel| texel[3] == 1.0)
    }

    /// The largest value of a channel.
    pub(crate) fn most(&self, channel: usize) -> f64 {
        f64::from(self.data.iter().map(|texel| texel[channel]).fold(0.0, f32::max))
    }
}

/// The linear value of one stored by the sRGB curve (IEC 61966-2-1).
pub(crate) fn linear(stored: f64) -> f64 {
    if stored <= 0.04045 { stored / 12.92 } else { libm::pow((stored + 0.055) / 1.055, 2.4) }
}

/// The pictures of an import.
#[derive(Debug, Default)]
pub(crate) struct Pictures {
    files: BTreeMap<String, Vec<u8>>,
    names: Names,
    /// Paths of unchanged pictures by number, and texels of those that were decoded.
    unchanged: BTreeMap<usize, Result<String, String>>,
    decoded: BTreeMap<usize, Result<Rc<Texels>, String>>,
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
            let ending = match image::guess_format(&bytes) {
                Ok(ImageFormat::Png) => "png",
                Ok(ImageFormat::Jpeg) => "jpg",
                Ok(ImageFormat::WebP) => "webp",
                _ => return Err("the picture is neither PNG, JPEG nor WebP".to_owned()),
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
    ) -> Result<Rc<Texels>, String> {
        let decoded = self.decoded.entry(number);
        decoded.or_insert_with(|| bytes().and_then(|bytes| Texels::decode(&bytes)).map(Rc::new)).clone()
    }

    /// The path of a computed picture of one number a texel, in 16 bits: `of` the texels of up to two pictures, 1 where there is none. The size is that of
    /// the larger.
    pub(crate) fn number(
        &mut self,
        name: &str,
        key: &str,
        sources: [Option<&Texels>; 2],
        of: impl Fn([f64; 4], [f64; 4]) -> f64,
    ) -> Result<String, String> {
        self.compute(name, key, sources, |width, height, values| {
            let texels = values.iter().map(|&[a, b]| quantised(of(a, b))).collect();
            ImageBuffer::<Luma<u16>, _>::from_raw(width, height, texels).map(DynamicImage::ImageLuma16)
        })
    }

    /// The path of a computed picture of three numbers a texel, in 16 bits.
    pub(crate) fn color(
        &mut self,
        name: &str,
        key: &str,
        sources: [Option<&Texels>; 2],
        of: impl Fn([f64; 4], [f64; 4]) -> [f64; 3],
    ) -> Result<String, String> {
        self.compute(name, key, sources, |width, height, values| {
            let texels = values.iter().flat_map(|&[a, b]| of(a, b).map(quantised)).collect();
            ImageBuffer::<Rgb<u16>, _>::from_raw(width, height, texels).map(DynamicImage::ImageRgb16)
        })
    }

    fn compute(
        &mut self,
        name: &str,
        key: &str,
        sources: [Option<&Texels>; 2],
        make: impl FnOnce(u32, u32, &[[[f64; 4]; 2]]) -> Option<DynamicImage>,
    ) -> Result<String, String> {
        if let Some(path) = self.computed.get(key) {
            return Ok(path.clone());
        }
        let sizes = sources.iter().flatten().map(|texels| (texels.width, texels.height));
        let (width, height) =
            sizes.max_by_key(|&(width, height)| u64::from(width) * u64::from(height)).unwrap_or((1, 1));
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let values = places.map(|(x, y)| {
            sources.map(|texels| {
                texels.map_or([1.0; 4], |texels| {
                    if (texels.width, texels.height) == (width, height) {
                        return texels.data[(y * width + x) as usize].map(f64::from);
                    }
                    let place = |at: u32, size: u32| (f64::from(at) + 0.5) / f64::from(size);
                    texels.at([place(x, width), place(y, height)])
                })
            })
        });
        let values: Vec<[[f64; 4]; 2]> = values.collect();
        let picture = make(width, height, &values).ok_or("a picture without texels")?;
        let mut bytes = Vec::new();
        picture.write_to(&mut Cursor::new(&mut bytes), ImageFormat::Png).map_err(|error| error.to_string())?;
        let path = format!("maps/{}.png", self.names.unique(name, "computed"));
        self.files.insert(path.clone(), bytes);
        self.computed.insert(key.to_owned(), path.clone());
        Ok(path)
    }

    pub(crate) fn into_files(self) -> BTreeMap<String, Vec<u8>> {
        self.files
    }
}

fn quantised(value: f64) -> u16 {
    libm::round(value.clamp(0.0, 1.0) * f64::from(u16::MAX)) as u16
}
