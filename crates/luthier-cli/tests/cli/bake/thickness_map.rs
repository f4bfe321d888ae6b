//! A film whose thickness comes from a picture.

use image::{ImageBuffer, Luma};
use luthier_workshop::material_texts::film;

use crate::workshop::Workshop;

/// Where a texel of the 16 x 16 table is in its picture: one texel of apron all round.
const APRON: u32 = 1;

/// Linear value of an 8-bit sRGB code (IEC 61966-2-1).
fn linear(code: u8) -> f64 {
    let c = f64::from(code) / 255.0;
    if c <= 0.040_45 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) }
}

/// Red is d / (2 d_max). The film is from 100 to 400 nm: 1/8 where the map is black, 1/2 where it is white, and in the
/// middle where it is 50 % grey, (100 + 300/2) / 800.
#[test]
fn black_is_thin_and_white_is_thick() {
    let workshop = Workshop::new();
    workshop.write("m/film.toml", film("film", "{ image = \"maps/steps.png\" }"));
    workshop.write("m/maps/readme", "");
    let columns = [0, u16::MAX, u16::MAX / 2, u16::MAX / 2];
    let steps = ImageBuffer::from_fn(32, 8, |x, _| Luma([columns[x as usize / 8]]));
    steps.save(workshop.path("m/maps/steps.png")).unwrap();
    workshop.run(&["bake", "m/film.toml", "-q"]).exits(0);

    let picture = image::open(workshop.path("out/tables/thickness.png")).unwrap().into_rgb8();
    assert_eq!(picture.dimensions(), (18, 18));
    // Well inside each step: the first is texels 0 to 3, the second 4 to 7, grey the rest.
    for (texel, expected) in [(2, 0.125), (6, 0.5), (10, 0.3125), (13, 0.3125)] {
        for y in [APRON, APRON + 9] {
            let found = linear(picture.get_pixel(APRON + texel, y)[0]);
            assert!((found - expected).abs() < 4e-3, "texel {texel}: {found}, not {expected}");
        }
    }
}

/// The picture is part of the input: another one, other bytes.
#[test]
fn the_table_follows_the_picture() {
    let workshop = Workshop::new();
    workshop.write("film.toml", film("film", "{ image = \"map.png\" }"));
    let mut tables = Vec::new();
    for code in [60_u8, 200] {
        let map = ImageBuffer::from_fn(4, 4, |x, _| Luma([if x < 2 { code } else { 30 }]));
        map.save(workshop.path("map.png")).unwrap();
        workshop.run(&["bake", "film.toml", "-q"]).exits(0);
        tables.push(workshop.tree("out/tables")["thickness.ktx2"].clone());
    }
    assert_ne!(tables[0], tables[1]);
}
