//! Figures with textures of single layers: crossed tangents, bumps of one interface, flakes of a height field, colours and metal.

use luthier::{Bake, MemoryStore};
use luthier_gpu::Shape;
use luthier_lut::Image;
use luthier_manifest::{Form, MapSlot, ShadingModel};
use luthier_terminal::{Failure, Outcome};
use luthier_texture::png;

use super::claim::{Check, Claim};
use super::elek_examples::lacquer;
use super::figure::{Figure, LARGE, Labelled, Made, SMALL, TONE, enlarged};
use super::numbers::light::KEY;
use super::numbers::places::{color_at, correlation, middle_values, nearest, places_of_ball, sparkles};
use super::numbers::spot::{spot, spot_of};
use super::numbers::tint::colors_apart;
use super::numbers::{average, over_red, pixels};
use super::studio::{Studio, layered, mapped};

pub(crate) const FIGURES: [Figure; 5] = [
    Figure {
        name: "elek-6",
        title: "flakes from a height field",
        source: "Elek 2010, figure 6",
        caption: "Chromium flakes under a tinted coat, and a quarter of the map in large: the heights of the flakes, and the normals that the bake makes of them by finite differences. \
                  A flake is a few pixels wide, so that single ones sparkle; the paper's are smaller than a pixel. The map is twice as wide as high, as the texture coordinates of a ball are, so that \
                  flakes have no long side. Heights and numbers are luthier's; `crates/luthier-lab/maps/make.py` draws them. A pixel sparkles where it is at least twice \
                  as bright as the median around it. Under a coat that absorbs all, flakes cannot be seen.",
        seen: "Single flakes light up around the highlight and all over the ball, as in metallic paint, and heights and normals are of the \
               kind that the paper shows. The ball stands for the paper's object.",
        size: LARGE,
        claim: Claim {
            text: "Flakes of a height field sparkle, most of all under direct light: single places are far brighter than those \
                  around them. The normals are the slopes of the heights, in all directions alike. Flakes tilt what lies \
                  below the coat, and not the coat.",
            checks: &[
                Check::Falls(&["flakes: sparkles", "none: sparkles"]),
                Check::Falls(&["flakes: sparkles", "flakes without the direct light: sparkles"]),
                Check::Within("correlation of the normals with the slopes of the heights, along x", 0.9, 1.0),
                Check::Within("correlation of the normals with the slopes of the heights, along y", 0.9, 1.0),
                Check::Within("mean of the normals' tilt over its root mean square", 0.0, 0.1),
                Check::Within("opaque coat, flakes against none: largest difference of luminance", 0.0, 0.01),
            ],
        },
        make: flakes,
    },
    Figure {
        name: "elek-line-22",
        title: "a diffuse map under lacquers",
        source: "Elek 2010, Algorithm 1, line 22, which no figure shows",
        caption: "A painted base, the same under a clear lacquer, and under a lacquer that absorbs. The map multiplies the albedo of the base: less what the lacquer mirrors, a \
                  painted ball over a white one has the same quotients under the lacquer as bare. Map and numbers are luthier's.",
        seen: "The paint shows through the lacquers as it should. No figure of the paper to set beside it.",
        size: LARGE,
        claim: Claim {
            text: "The map multiplies the diffuse light of the base alone, under a lacquer as without one, and a lacquer that \
                  absorbs colours it further.",
            checks: &[
                Check::Within(
                    "share of the ball where the base under the lacquer has the colours of the bare one",
                    0.95,
                    1.0,
                ),
                Check::Within("bare, with the map over without: least of all channels", 0.0, 0.5),
                Check::Falls(&["clear: blue over red", "tinted: blue over red"]),
            ],
        },
        make: painted,
    },
    Figure {
        name: "lecture-metal",
        title: "textures of base colour and metal",
        source: "The lecture's slide on textures, which has no figure of a layered surface",
        caption: "A metallic-roughness surface without metal, with a map of how metallic it is, and all of metal. The left and the right picture have a white map in its place. \
                  In the middle paint has come off a metal. Maps and numbers are luthier's. The numbers are the mean differences of colour (CIELAB) to the other two where the map is below 0.2 and above 0.8.",
        seen: "Patches of metal and of paint share the middle ball. The lecture has no picture of it.",
        size: LARGE,
        claim: Claim {
            text: "One map makes some places of a surface metal and leaves others paint.",
            checks: &[
                Check::Falls(&[
                    "dark places of the map: difference to metal",
                    "dark places of the map: difference to paint",
                ]),
                Check::Falls(&[
                    "bright places of the map: difference to paint",
                    "bright places of the map: difference to metal",
                ]),
            ],
        },
        make: metal,
    },
    Figure {
        name: "yamaguchi-2",
        title: "a ball with two crossed fields",
        source: "Yamaguchi et al. 2019, figure 2",
        caption: "A coat of index 1.49 on gold, by Yamaguchi's model. From left to right: both layers isotropic, as Belcour's model has them; the tangents of the base on circles \
                  around the middle; those of the coat on rays; both, so that the fields cross everywhere. Each layer has a map of its own. The paper's fields and slopes \
                  are not known; these are luthier's. The numbers are of the same balls under one light beside the middle: the standard deviation of the highlight along the \
                  circle through it, over that along the ray, of the whole and of the base alone, which is red less blue. `coat alone` is over an opaque absorber.",
        seen: "Highlights turn around the middle as the fields do; the isotropic ball has round ones. The crossing is seen as in the \
               paper.",
        size: SMALL,
        claim: Claim {
            text: "Highlights follow the field of tangents of each layer: that of the base is long along circles, that of the coat \
                  along rays. Highlights of isotropic layers are round.",
            checks: &[
                Check::Within("isotropic, base: length along the circle over that along the ray", 0.9, 1.1),
                Check::Within("base, base: length along the circle over that along the ray", 1.1, 100.0),
                Check::Within("crossed, base: length along the circle over that along the ray", 1.1, 100.0),
                Check::Within("coat alone, whole: length along the circle over that along the ray", 0.0, 0.9),
                Check::Falls(&[
                    "base, whole: length along the circle over that along the ray",
                    "isotropic, whole: length along the circle over that along the ray",
                    "coat, whole: length along the circle over that along the ray",
                ]),
            ],
        },
        make: crossed,
    },
    Figure {
        name: "course-3-9-own",
        title: "bumps of one interface",
        source: "Weidlich and Wilkie 2009, figure 3.9d and its reverse",
        caption: "A matt varnish over aluminium: bumps of the metal alone, bumps of the varnish alone above flat metal, and bumps of both. Where the metal is flat, its \
                  reflection is bent by the bumps through which it is seen, less than a bumpy metal bends it. Dark spots are where light that is mirrored inside \
                  would be totally reflected on its way out, which bumps of both avoid. Map and numbers are luthier's.",
        seen: "The reflection of the varnish runs over the bumps below it undisturbed. The second and third tori are luthier's own.",
        size: SMALL,
        claim: Claim {
            text: "Bumps of the metal alone leave the reflection of the varnish as it is, and bumps of the varnish alone bend the \
                  metal less than its own do.",
            checks: &[
                Check::Within("opaque varnish, below against flat: RMSE of linear radiance", 0.0, 1e-3),
                Check::Falls(&[
                    "opaque varnish, above against flat: RMSE of linear radiance",
                    "opaque varnish, below against flat: RMSE of linear radiance",
                ]),
                Check::Falls(&[
                    "below against flat: RMSE of linear radiance",
                    "above against flat: RMSE of linear radiance",
                ]),
            ],
        },
        make: bumps,
    },
];

const CHROMIUM: &str = "[[layer]]\ntype = \"conductor\"\n\
     ior = { n = [3.84, 3.18, 1.99], k = [4.37, 4.41, 4.22], wavelengths_nm = [690, 550, 450] }\n\
     alpha = 0.06\ndistribution = \"beckmann\"\n";

fn flakes(studio: &Studio, made: &mut Made) -> Outcome {
    let heights =
        "[effects.flakes]\nheight_map = { image = \"facets.png\", height = 0.02 }\ntiling = 4\nfade_start = 1000\n";
    let coat = lacquer("[0.02, 0.2, 0.6]");
    let with = mapped(layered("flakes", &(coat.clone() + CHROMIUM + heights), ShadingModel::Elek)?);
    let package = Bake::lit().package(&[with], &MemoryStore::default())?;
    let ball = studio.rendered(&package, Form::Full, Shape::Sphere, |_, _| {})?.swap_remove(0);
    let plain = mapped(layered("no-flakes", &(coat + CHROMIUM), ShadingModel::Elek)?);
    let plain = studio.picture(plain, Form::Full, Shape::Sphere)?;
    made.errors("flakes against none", &ball, &plain)?;
    made.measure("flakes: sparkles", sparkles(&ball));
    made.measure("none: sparkles", sparkles(&plain));
    let shaded = studio.rendered(&package, Form::Full, Shape::Sphere, |_, settings| settings.lights.clear())?;
    made.measure("flakes without the direct light: sparkles", shaded.first().map_or(0.0, sparkles));
    let opaque = ["", heights].map(|flakes| lacquer("100") + CHROMIUM + flakes);
    let mut alike = Vec::new();
    for (i, layers) in opaque.into_iter().enumerate() {
        let material = mapped(layered(&format!("opaque-{i}"), &layers, ShadingModel::Elek)?);
        alike.extend(studio.lit(&[material], Form::Full, Shape::Sphere, KEY)?.iter().map(middle_values));
    }
    if let [none, with] = alike.as_slice() {
        let largest = none.iter().zip(with).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        made.measure("opaque coat, flakes against none: largest difference of luminance", largest);
    }
    let heights = png::decode(include_bytes!("../../maps/facets.png")).map_err(Failure::input)?;
    let mut shown: Labelled = vec![("ball".to_owned(), TONE.image(ball))];
    shown.push(("heights".to_owned(), enlarged(&corner(&heights), studio.size, [0, 1, 2])));
    if let Some(map) = package.maps.iter().find(|map| map.slot == MapSlot::FlakeNormal) {
        slopes(made, &heights, &map.picture.image());
        shown.push(("normals".to_owned(), enlarged(&corner(&map.picture.image()), studio.size, [0, 1, 2])));
    }
    made.shown("elek-6", shown, 3);
    Ok(())
}

/// The square in the upper left corner of a map, half as high as it.
fn corner(map: &Image) -> Image {
    let mut square = Image::zeros(map.height / 2, map.height / 2, map.channels);
    for (x, y) in pixels(&square) {
        square.texel_mut(x, y).copy_from_slice(map.texel(x, y));
    }
    square
}

/// Compares a map of normals with the slopes of the heights that it is of. Heights rise towards the light: a normal leans to
/// where they fall. Rows of a map run down, and +y of a normal is up.
fn slopes(made: &mut Made, heights: &Image, normals: &Image) {
    let (width, height) = (heights.width, heights.height);
    let mut lists: [[Vec<f64>; 2]; 2] = Default::default();
    for (x, y) in pixels(heights) {
        let texel = normals.texel(x * normals.width / width, y * normals.height / height);
        let around = [(x + width - 1, y), (x + 1, y), (x, y + 1), (x, y + height - 1)];
        let [left, right, below, above] = around.map(|(x, y)| f64::from(heights.texel(x % width, y % height)[0]));
        let fall = [left - right, below - above];
        for (axis, list) in lists.iter_mut().enumerate() {
            list[0].push(2.0 * f64::from(texel[axis]) - 1.0);
            list[1].push(fall[axis]);
        }
    }
    let (mut mean, mut square) = (0.0, 0.0);
    for (axis, [normals, falls]) in ["x", "y"].into_iter().zip(&lists) {
        let what = format!("correlation of the normals with the slopes of the heights, along {axis}");
        made.measure(what, correlation(normals, falls));
        let count = normals.len().max(1) as f64;
        mean = libm::hypot(mean, normals.iter().sum::<f64>() / count);
        square += normals.iter().map(|tilt| tilt * tilt).sum::<f64>() / count;
    }
    made.measure("mean of the normals' tilt over its root mean square", mean / square.max(1e-12).sqrt());
}

fn painted(studio: &Studio, made: &mut Made) -> Outcome {
    let base = "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.9\nmaps = { albedo = \"paint.png\" }\n";
    let all = [("bare", String::new()), ("clear", lacquer("0")), ("tinted", lacquer("[0.02, 0.12, 0.3]"))];
    let mut materials = Vec::new();
    for (label, coat) in &all {
        materials.push(mapped(layered(&format!("paint-{label}"), &(coat.clone() + base), ShadingModel::Elek)?));
    }
    let shown = studio.pictures(&materials, Form::Full, Shape::Sphere, |_, _| {})?;
    // Under the light alone, which the base sees from one side: painted, white and black, bare and lacquered.
    let white = base.replace("maps = { albedo = \"paint.png\" }\n", "");
    let black = white.replace("albedo = 0.9", "albedo = 0");
    let mut quotients = Vec::new();
    for coat in ["", &lacquer("0")] {
        let mut three = Vec::new();
        for (i, below) in [base, &white, &black].into_iter().enumerate() {
            let material = mapped(layered(&format!("part-{i}"), &(coat.to_owned() + below), ShadingModel::Elek)?);
            three.extend(studio.lit(&[material], Form::Full, Shape::Sphere, KEY)?);
        }
        if let [painted, white, black] = three.as_slice() {
            let of_texels = (0..white.data.len()).map(|i| {
                let [painted, white, black] = [painted, white, black].map(|image| f64::from(image.data[i]));
                // Where there is light on a base; the backdrop is the same in all.
                (white - black > 0.02).then(|| (painted - black) / (white - black))
            });
            quotients.push(of_texels.collect::<Vec<Option<f64>>>());
        }
    }
    if let [bare, lacquered] = quotients.as_slice() {
        let both: Vec<[f64; 2]> = bare.iter().zip(lacquered).filter_map(|(a, b)| Some([(*a)?, (*b)?])).collect();
        let alike = both.iter().filter(|[a, b]| (a - b).abs() < 0.02).count() as f64 / both.len().max(1) as f64;
        made.measure("share of the ball where the base under the lacquer has the colours of the bare one", alike);
        let least = both.iter().map(|[a, _]| *a).fold(f64::INFINITY, f64::min);
        made.measure("bare, with the map over without: least of all channels", least);
    }
    for ((label, _), picture) in all.iter().zip(&shown) {
        made.measure(format!("{label}: blue over red"), over_red(picture, 2));
    }
    made.sheet("elek-line-22", all.iter().map(|(label, _)| *label).zip(shown), 3);
    Ok(())
}

fn metal(studio: &Studio, made: &mut Made) -> Outcome {
    let all = [("paint", 0, ""), ("map", 1, "maps = { metallic = \"thickness.png\" }\n"), ("metal", 1, "")];
    let mut shown = Vec::new();
    for (label, metallic, maps) in all {
        let layers = format!(
            "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = [0.95, 0.6, 0.4]\nmetallic = {metallic}\nroughness = 0.5\n{maps}"
        );
        let material = mapped(layered(&format!("metal-{label}"), &layers, ShadingModel::Elek)?);
        shown.push(studio.picture(material, Form::Full, Shape::Sphere)?);
    }
    made.errors("the map against paint", &shown[1], &shown[0])?;
    made.errors("the map against metal", &shown[1], &shown[2])?;
    let map = png::decode(include_bytes!("../../maps/thickness.png")).map_err(Failure::input)?;
    for (label, is_there) in [("dark", (0.0..0.2)), ("bright", (0.8..1.01))] {
        for (to, other) in [("paint", &shown[0]), ("metal", &shown[2])] {
            let places =
                places_of_ball(&shown[1]).filter(|(_, uv)| is_there.contains(&f64::from(nearest(&map, *uv)[0])));
            let apart = places.map(|(place, _)| colors_apart(color_at(&shown[1], place), color_at(other, place)));
            made.measure(format!("{label} places of the map: difference to {to}"), average(apart));
        }
    }
    made.sheet("lecture-metal", all.iter().map(|(label, ..)| *label).zip(shown), 3);
    Ok(())
}

fn crossed(studio: &Studio, made: &mut Made) -> Outcome {
    let all = [
        ("isotropic", ["", ""], [0.12, 0.12], [0.23, 0.23]),
        ("base", ["", "circles.png"], [0.12, 0.12], [0.45, 0.12]),
        ("coat", ["rays.png", ""], [0.25, 0.06], [0.23, 0.23]),
        ("crossed", ["rays.png", "circles.png"], [0.25, 0.06], [0.45, 0.12]),
    ];
    let (mut shown, mut measured) = (Vec::new(), Vec::new());
    for (label, [coat, base], above, below) in all {
        let [above, below] = [(above, coat), (below, base)].map(|([x, y], map)| {
            let map = if map.is_empty() { String::new() } else { format!("maps = {{ tangent = \"{map}\" }}\n") };
            format!("alpha_x = {x}\nalpha_y = {y}\n{map}")
        });
        let layers = format!(
            "[[layer]]\ntype = \"dielectric\"\nior = 1.49\n{above}[[layer]]\ntype = \"conductor\"\n\
             ior = {{ n = [0.143, 0.373, 1.444], k = [3.983, 2.387, 1.602], wavelengths_nm = [690, 550, 450] }}\n{below}"
        );
        let material = mapped(layered(&format!("field-{label}"), &layers, ShadingModel::Yamaguchi)?);
        shown.push(studio.picture(material.clone(), Form::Baked, Shape::Sphere)?);
        measured.push((label, material));
    }
    let alone = "[[layer]]\ntype = \"dielectric\"\nior = 1.49\nalpha_x = 0.25\nalpha_y = 0.06\nmaps = { tangent = \"rays.png\" }\n\
                 thickness_um = 1\nabsorption_per_um = 100\n[[layer]]\ntype = \"conductor\"\nior = { n = 1.5, k = 1.5 }\nalpha = 0.23\n";
    measured.push(("coat alone", mapped(layered("coat-alone", alone, ShadingModel::Yamaguchi)?)));
    for (label, material) in measured {
        let picture = studio.lit(&[material], Form::Baked, Shape::Sphere, BESIDE)?.swap_remove(0);
        // The coat reflects without colour, and gold does not.
        for (part, spot) in [("whole", spot(&picture)), ("base", spot_of(&picture, |[red, _, blue]| red - blue))] {
            let [x, y] = spot.middle;
            let length = spot.deviation([-y, x]) / spot.deviation([x, y]).max(1e-9);
            made.measure(format!("{label}, {part}: length along the circle over that along the ray"), length);
        }
    }
    made.sheet("yamaguchi-2", all.iter().map(|(label, ..)| *label).zip(shown), 4);
    Ok(())
}

/// Direction of a light whose highlight lies beside the middle of a ball, at a slant.
const BESIDE: [f32; 3] = [0.5, 0.5, 0.7];

fn bumps(studio: &Studio, made: &mut Made) -> Outcome {
    let bumpy = "maps = { bumps = \"bumps.png\" }\n";
    let all = [("flat", "", ""), ("below", "", bumpy), ("above", bumpy, ""), ("both", bumpy, bumpy)];
    let mut shown = Vec::new();
    for (label, coat, base) in all {
        let material = layered(&format!("bumps-{label}"), &varnished(coat, base), ShadingModel::WeidlichWilkie)?;
        // Directions are drawn about the level surface: steep bumps need more.
        shown.extend(studio.pictures(&[mapped(material)], Form::Full, Shape::Torus, |_, settings| {
            settings.environment_samples = 128
        })?);
    }
    for (label, picture) in ["below", "above", "both"].into_iter().zip(&shown[1..]) {
        made.errors(&format!("{label} against flat"), picture, &shown[0])?;
    }
    // An opaque varnish leaves only its own reflection.
    let mut alone = Vec::new();
    for (label, coat, base) in &all[..3] {
        let layers = varnished(coat, base).replace("thickness_um = 0.3", "thickness_um = 1\nabsorption_per_um = 100");
        let material = mapped(layered(&format!("opaque-{label}"), &layers, ShadingModel::WeidlichWilkie)?);
        alone.extend(studio.lit(&[material], Form::Full, Shape::Torus, KEY)?);
    }
    for (label, picture) in ["below", "above"].into_iter().zip(&alone[1..]) {
        made.errors(&format!("opaque varnish, {label} against flat"), picture, &alone[0])?;
    }
    made.sheet("course-3-9-own", all.iter().map(|(label, ..)| *label).zip(shown), 4);
    Ok(())
}

/// Varnished aluminium, with keys of the varnish and of the metal.
fn varnished(coat: &str, base: &str) -> String {
    let varnish =
        "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nslope_deg = 4\ndistribution = \"beckmann\"\nthickness_um = 0.3\n";
    let metal = "[[layer]]\ntype = \"conductor\"\nior = \"al\"\nslope_deg = 6\ndistribution = \"beckmann\"\n";
    [varnish, coat, metal, base].concat()
}
