//! Tests of OpenEXR files of other makers, which the `exr` crate writes.

use std::io::Cursor;

use ::exr::math::Vec2;
use ::exr::meta::attribute::{Chromaticities, EnvironmentMap, IntegerBounds};
use ::exr::meta::header::{ImageAttributes, LayerAttributes};
use ::exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Image as ExrImage, Layer, SmallVec, SpecificChannels,
    WritableImage, f16,
};

use super::super::{Picture, decode};

/// Names of channels, each with its values.
type Named<'a> = [(&'a str, Vec<f32>)];

fn layer(name: &str, at: [i32; 2], size: [usize; 2], channels: &Named<'_>) -> Layer<AnyChannels<FlatSamples>> {
    let list = channels.iter().map(|(name, values)| AnyChannel::new(*name, FlatSamples::F32(values.clone())));
    let attributes = LayerAttributes::named(name).with_position(Vec2(at[0], at[1]));
    let channels = AnyChannels::sort(list.collect::<SmallVec<_>>());
    Layer::new(Vec2(size[0], size[1]), attributes, Encoding::SMALL_LOSSLESS, channels)
}

fn bytes(image: &ExrImage<::exr::image::Layers<AnyChannels<FlatSamples>>>) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut file).unwrap();
    file.into_inner()
}

fn file(display: IntegerBounds, layers: Vec<Layer<AnyChannels<FlatSamples>>>) -> Vec<u8> {
    bytes(&ExrImage::from_layers(ImageAttributes::new(display), layers))
}

/// A file of one part of two texels with these channels.
fn pair(channels: &Named<'_>) -> Vec<u8> {
    file(IntegerBounds::from_dimensions((2, 1)), vec![layer("one", [0, 0], [2, 1], channels)])
}

fn rgb(prefix: &str, red: f32) -> Vec<(String, Vec<f32>)> {
    ["R", "G", "B"].iter().zip(0..).map(|(c, i)| (format!("{prefix}{c}"), vec![red + i as f32, 9.0])).collect()
}

fn named(channels: &[(String, Vec<f32>)]) -> Vec<(&str, Vec<f32>)> {
    channels.iter().map(|(name, values)| (name.as_str(), values.clone())).collect()
}

#[test]
fn our_own_files() {
    let image =
        luthier_lut::Image { width: 3, height: 2, channels: 3, data: (0..18).map(|i| i as f32 * 0.5).collect() };
    let file = crate::exr::encode(&image, &crate::exr::RGB, &crate::Metadata::new()).unwrap();
    assert_eq!(decode(&file).unwrap(), Picture { image, notes: Vec::new() });
}

/// Half floats and wavelet compression, which cameras and renderers write.
#[test]
fn half_floats_and_piz() {
    let value = |x: usize, y: usize| (x * 7 + y * 3) as f32 * 0.25;
    let pixels = |place: Vec2<usize>| {
        let v = value(place.0, place.1);
        (f16::from_f32(v), f16::from_f32(2.0 * v), f16::from_f32(4.0 * v))
    };
    let encoding = Encoding { compression: Compression::PIZ, ..Encoding::FAST_LOSSLESS };
    let layer = Layer::new((40, 20), LayerAttributes::default(), encoding, SpecificChannels::rgb(pixels));
    let mut file = Cursor::new(Vec::new());
    ExrImage::from_layer(layer).write().non_parallel().to_buffered(&mut file).unwrap();
    let image = decode(&file.into_inner()).unwrap().image;
    assert_eq!((image.width, image.height, image.channels), (40, 20, 3));
    for (x, y) in [(0, 0), (39, 0), (5, 19)] {
        let v = value(x, y);
        assert_eq!(image.texel(x as u32, y as u32), [v, 2.0 * v, 4.0 * v], "{x} {y}");
    }
}

/// The data window inside of the display window, over its edges, and beside it.
#[test]
fn the_picture_is_the_display_window() {
    let windows = |display: [i32; 2], at: [i32; 2]| {
        let values = |first: u8| (first..first + 6).map(f32::from).collect::<Vec<_>>();
        let channels = [("R", values(1)), ("G", values(11)), ("B", values(21))];
        let bounds = IntegerBounds::new(Vec2(display[0], display[1]), Vec2(4, 3));
        decode(&file(bounds, vec![layer("crop", at, [3, 2], &channels)]))
    };
    let red = |picture: &Picture| picture.image.texels().map(|texel| texel[0] as u8).collect::<Vec<_>>();
    let inside = windows([10, -5], [11, -4]).unwrap();
    assert_eq!((inside.image.width, inside.image.height), (4, 3));
    assert_eq!(red(&inside), [0, 0, 0, 0, 0, 1, 2, 3, 0, 4, 5, 6]);
    assert_eq!(inside.image.texel(3, 2), [6.0, 16.0, 26.0]);
    assert!(inside.notes[0].contains("3 x 2 at 11, -4") && inside.notes[0].contains("4 x 3 at 10, -5"));
    assert_eq!(red(&windows([0, 0], [-2, -1]).unwrap()), [6, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!(red(&windows([0, 0], [3, 2]).unwrap()), [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1]);
    for at in [[4, 0], [0, 3], [-3, 0], [1 << 20, 0], [0, -1 << 20]] {
        let message = windows([0, 0], at).unwrap_err().to_string();
        assert!(message.contains("3 x 2 at") && message.contains("4 x 3 at 0, 0"), "{message}");
    }
}

/// A display window that a file of its length cannot fill takes no memory.
#[test]
fn display_windows_have_limits() {
    let grey = [("Y", vec![1.0])];
    let with = |size: (usize, usize)| {
        decode(&file(IntegerBounds::from_dimensions(size), vec![layer("one", [0, 0], [1, 1], &grey)]))
    };
    assert!(with((16_000, 4000)).unwrap_err().to_string().contains("too short"));
    assert!(matches!(with((20_000, 1)), Err(crate::TextureError::Size { .. })));
}

/// Oracles: ITU-R BT.2087; IEC 61966-2-1 for XYZ of red and of white, which XYZ does not adapt.
#[test]
fn chromaticities() {
    let of = |red, green, blue, white, channels: &Named<'_>| {
        let mut attributes = ImageAttributes::new(IntegerBounds::from_dimensions((2, 1)));
        attributes.chromaticities = Some(Chromaticities { red, green, blue, white });
        decode(&bytes(&ExrImage::from_layers(attributes, vec![layer("one", [0, 0], [2, 1], channels)]))).unwrap()
    };
    let colors = [("R", vec![1.0, 0.5]), ("G", vec![0.0, 0.5]), ("B", vec![0.0, 0.5])];
    let d65 = Vec2(0.3127, 0.329);
    let wide = of(Vec2(0.708, 0.292), Vec2(0.17, 0.797), Vec2(0.131, 0.046), d65, &colors);
    for (found, expected) in wide.image.data.iter().zip([1.6605, -0.1246, -0.0182, 0.5, 0.5, 0.5]) {
        assert!((found - expected).abs() < 2e-4, "{:?}", wide.image.data);
    }
    assert!(wide.notes[0].contains("0.7080, 0.2920"));
    let third = Vec2(1.0 / 3.0, 1.0 / 3.0);
    let red_and_d65 = [("R", vec![0.4124, 0.9505]), ("G", vec![0.2126, 1.0]), ("B", vec![0.0193, 1.089])];
    let xyz = of(Vec2(1.0, 0.0), Vec2(0.0, 1.0), Vec2(0.0, 0.0), third, &red_and_d65);
    for (found, expected) in xyz.image.data.iter().zip([1.0, 0.0, 0.0, 1.0, 1.0, 1.0]) {
        assert!((found - expected).abs() < 1e-3, "{:?}", xyz.image.data);
    }
    assert!(xyz.notes[0].contains("CIE XYZ"));
    let usual = of(Vec2(0.64, 0.33), Vec2(0.3, 0.6), Vec2(0.15, 0.06), d65, &colors);
    assert!(usual.image.data == [1.0, 0.0, 0.0, 0.5, 0.5, 0.5] && usual.notes.is_empty());
    // Grey has no primaries.
    let grey = of(Vec2(0.708, 0.292), Vec2(0.17, 0.797), Vec2(0.131, 0.046), third, &[("Y", vec![2.0, 3.0])]);
    assert!(grey.image.data == [2.0, 2.0, 2.0, 3.0, 3.0, 3.0] && grey.notes.is_empty());
}

#[test]
fn channels_by_their_names() {
    let first = |channels: &[(String, Vec<f32>)]| {
        let picture = decode(&pair(&named(channels))).unwrap();
        (picture.image.texel(0, 0).to_vec(), picture.notes)
    };
    assert_eq!(first(&[rgb("", 5.0), rgb("a.", 1.0)].concat()), (vec![5.0, 6.0, 7.0], vec![]));
    assert_eq!(first(&rgb("left.", 2.0)), (vec![2.0, 3.0, 4.0], vec![]));
    let (texel, notes) = first(&[rgb("View.Albedo.", 1.0), rgb("View.Combined.", 3.0)].concat());
    assert!(texel == [3.0, 4.0, 5.0] && notes[0].contains("`View.Combined`"), "{notes:?}");
    assert_eq!(
        first(&rgb("diffuse.", 1.0).into_iter().map(|(n, v)| (n.to_lowercase(), v)).collect::<Vec<_>>()).0[2],
        3.0
    );
    let grey = pair(&[("Y", vec![2.0, 1.0]), ("A", vec![1.0, 1.0])]);
    assert_eq!(decode(&grey).unwrap().image.texel(0, 0), [2.0; 3]);
    for odd in [&["X", "Y", "Z"][..], &["R", "G"], &["Z"], &["BY", "RY", "Y"]] {
        let channels: Vec<_> = odd.iter().map(|name| (*name, vec![1.0, 1.0])).collect();
        let message = decode(&pair(&channels)).unwrap_err().to_string();
        assert!(
            odd.iter().all(|name| message.contains(&format!("`{name}`"))) && message.contains("R, G and B"),
            "{message}"
        );
    }
}

#[test]
fn parts_cubes_and_aspects() {
    let display = IntegerBounds::from_dimensions((2, 1));
    let (depth, color) = ([("Z", vec![1.0, 1.0])], rgb("", 7.0));
    let parts = vec![layer("depth", [0, 0], [2, 1], &depth), layer("color", [0, 0], [2, 1], &named(&color))];
    assert_eq!(decode(&file(display, parts)).unwrap().image.texel(0, 0), [7.0, 8.0, 9.0]);
    let with = |map, pixel_aspect| {
        let mut one = layer("one", [0, 0], [2, 1], &named(&color));
        one.attributes.environment_map = Some(map);
        let attributes = ImageAttributes { pixel_aspect, ..ImageAttributes::new(display) };
        decode(&bytes(&ExrImage::from_layers(attributes, vec![one])))
    };
    assert!(with(EnvironmentMap::Cube, 1.0).unwrap_err().to_string().contains("cube"));
    assert!(with(EnvironmentMap::LatitudeLongitude, 2.0).unwrap().notes.is_empty());
    assert!(with(EnvironmentMap::LatitudeLongitude, 1.5).unwrap().notes[0].contains("1.5"));
}
