//! Figures of Granier and Heidrich 2003.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use luthier::{Bake, MemoryStore};
use luthier_gpu::{RenderSettings, Shape};
use luthier_layers::models::granier_heidrich::Film;
use luthier_layers::monochrome::Monochrome;
use luthier_layers::noise::perlin::Perlin;
use luthier_lut::Image;
use luthier_manifest::{Form, ShadingModel};
use luthier_material::Material;
use luthier_optics::stack::Stack;
use luthier_report::{Curve, Plot, PlotAxis, PlotColor};
use luthier_terminal::Outcome;

use super::claim::{Check, Claim};
use super::figure::{Figure, LARGE, Made, SMALL, TONE};
use super::numbers::light::FROM_EYE;
use super::numbers::places::{BALL_DISTANCE, ball_normal};
use super::numbers::spot::{centres, spot};
use super::numbers::tint::{hue, hues, tint_deviation, tint_grain, tints_apart};
use super::numbers::{across, blown_out, over_red};
use super::studio::{LIGHTS, Studio, material, shaded};

pub(crate) const FIGURES: [Figure; 5] = [
    Figure {
        name: "granier-3",
        title: "the diffuse part under a layer of varying thickness",
        source: "X. Granier and W. Heidrich, A Simple Layered RGB BRDF Model, Graphical Models 65 (2003), figure 3",
        caption: "The pictures show the diffuse part alone: luthier subtracts a picture without the base from one \
                  with it, so that the specular part cancels. The thickness follows Perlin noise. A narrow range of \
                  thicknesses looks like old metal (left) or clay (right); a wide range gives bands of pure colours \
                  (middle). The chart shows the diffuse coefficient for the three wavelengths. It exceeds 1, so that \
                  a white base under this model reflects more light than it receives. The indices 1.5, 1.6, 1.8 are \
                  those of figure 6; the ranges are luthier's.",
        seen: "Old metal, a coloured ball and clay are recognised, as in the paper; the old metal is rather matt, because the diffuse part \
               is alone.",
        size: LARGE,
        claim: Claim {
            text: "A narrow range of thicknesses looks like old metal, or like clay of its reddish yellow. A wide range gives \
                  bands of pure colours: most of all hues.",
            checks: &[
                Check::Falls(&[
                    "coloured, 200 to 700 nm: spread of the channels",
                    "old metal, 52 to 84 nm: spread of the channels",
                ]),
                Check::Falls(&[
                    "coloured, 200 to 700 nm: spread of the channels",
                    "clay, 54 to 68 nm: spread of the channels",
                ]),
                Check::Falls(&[
                    "coloured, 200 to 700 nm: share of the hues",
                    "old metal, 52 to 84 nm: share of the hues",
                ]),
                Check::Falls(&["coloured, 200 to 700 nm: share of the hues", "clay, 54 to 68 nm: share of the hues"]),
                Check::Within("coloured, 200 to 700 nm: share of the hues", 0.5, 1.0),
                // Munsell's red and yellow-red, in which clays lie.
                Check::Within("clay, 54 to 68 nm: hue", 10.0, 77.0),
            ],
        },
        make: diffuse,
    },
    Figure {
        name: "granier-4",
        title: "boundaries that are not parallel",
        source: "Granier and Heidrich 2003, figure 4",
        caption: "The parameters are the printed ones: indices 1.4, 1.45, 1.6, thickness 66 to 76 nm, exponents 90 \
                  and 170, weights 1 and 0.7. The pictures are by the printed equations in f64, with lobes of height one, under two lights and no surroundings. With parallel boundaries, both beams leave in the mirror direction. In the \
                  other pictures the inner boundary is tilted by a constant 14 degrees (the angle of figure 6), \
                  which turns the transmitted beam aside. The bright highlight of each light then stands to the left of a faint one, which the outer boundary mirrors, \
                  and has a blue and a yellow side. With one index \
                  for all colours, it has no coloured sides. With an exponent of 20 for the inner \
                  boundary, it is wide, and its colours blur into each other. The numbers are of the specular part of luthier's shader, whose lobes carry their \
                  coefficients, under the light from the eye: how far from the middle the light of each channel lies, in half sides of the picture, and the mean \
                  saturation of the light.",
        seen: "Deviation and dispersion are seen as in the paper: the highlight of the leaning layer stands aside, blue on one side and \
               yellow on the other. The two pictures on the right are luthier's.",
        size: SMALL,
        claim: Claim {
            text: "Where the boundaries are not parallel, the beam through the layer turns aside: blue, of the highest index, \
                  furthest, and red least. The more they lean, the further apart the colours are. With one index they stay \
                  together. A low exponent blurs the colours into each other.",
            checks: &[
                Check::Falls(&["14 degrees: blue, aside", "14 degrees: green, aside", "14 degrees: red, aside"]),
                Check::Falls(&["14 degrees: green, aside", "7 degrees: green, aside", "parallel: green, aside"]),
                Check::Falls(&[
                    "14 degrees: blue and red apart",
                    "7 degrees: blue and red apart",
                    "parallel: blue and red apart",
                ]),
                Check::Falls(&["14 degrees: blue and red apart", "one index: blue and red apart"]),
                Check::Falls(&[
                    "90 and 20: width of the second highlight",
                    "14 degrees: width of the second highlight",
                ]),
                Check::Falls(&["14 degrees: colours of the highlights", "90 and 20: colours of the highlights"]),
                Check::Within("14 degrees: share blown out", 0.0, 0.001),
            ],
        },
        make: deviation,
    },
    Figure {
        name: "granier-5",
        title: "normals that follow the thickness",
        source: "Granier and Heidrich 2003, figure 5",
        caption: "The pictures show the specular part alone. The inner boundary is flat, or it follows the thickness \
                  like a bump map. A flat boundary gives smooth bands of colour, which are finer for thicker films. \
                  Bumps break these bands up into streaks, like oil on rough ground. One repeat of the thickness map \
                  is 12 and 24 um wide, chosen for the look. The ranges of thickness are luthier's.",
        seen: "Streaks of colours stand where the smooth bands were: it looks like oil on a rough surface. Highlights are white, because \
               lobes that carry their coefficients are brighter than those of the paper.",
        size: SMALL,
        claim: Claim {
            text: "Normals that follow the thickness break up the smooth bands of colour: neighbouring places differ more. The \
                  colours stay as many as those of oil on a surface.",
            checks: &[
                Check::Falls(&["bump 100-400: colour between neighbours", "flat 100-400: colour between neighbours"]),
                Check::Falls(&["bump 200-900: colour between neighbours", "flat 200-900: colour between neighbours"]),
                Check::Within("bump 200-900: share of the hues", 0.5, 1.0),
            ],
        },
        make: correlated,
    },
    Figure {
        name: "granier-6",
        title: "specular and diffuse part together",
        source: "Granier and Heidrich 2003, figure 6",
        caption: "The parameters are the printed ones: indices 1.5, 1.6, 1.8, exponents 130, deviation 14 degrees, \
                  weights 1 and 0.5. The pictures are by the printed equations in f64, as those of granier-4. The ranges of thickness and the index of the object are luthier's. Thin films \
                  are brown, and thicker ones blue, then yellow. A wide range of thickness shows all orders of \
                  interference at once. Highlights have coloured sides. The charts compare the \
                  model with the exact film in the mirror direction. Both have their extremes at the same \
                  thicknesses. But the two beams of the model make the object reflect all light, and more than falls \
                  on it where both are in phase.",
        seen: "The thickness gives the base colour and the lean the coloured sides of highlights, as in the paper. The thin layer is \
               reddish brown rather than red.",
        size: SMALL,
        claim: Claim {
            text: "The thickness gives the colour: red is strongest where the layer is thin, and blue or green where it is \
                  thicker. The deviation takes the colours of the highlight apart, the more the further their indices are \
                  apart.",
            checks: &[
                Check::Within("50 to 70 nm: green over red", 0.0, 1.0),
                Check::Within("50 to 70 nm: blue over red", 0.0, 1.0),
                Check::Within("110 to 140 nm: blue or green over red", 1.0, 100.0),
                Check::Within("160 to 200 nm: blue or green over red", 1.0, 100.0),
                Check::Falls(&["highlight: blue, aside", "highlight: green, aside", "highlight: red, aside"]),
                Check::Falls(&[
                    "indices 1.5, 1.6, 1.8: blue and red apart",
                    "indices 1.4, 1.45, 1.6: blue and red apart",
                ]),
            ],
        },
        make: combined,
    },
    Figure {
        name: "granier-7",
        title: "the model on a mesh",
        source: "Granier and Heidrich 2003, section 7.4 and figure 7",
        caption: "The paper shows a cat of 11,000 triangles on graphics hardware; here it is luthier's model of a ball on a stand, of about as many. \
                  As there, the normals of the inner boundary follow the thickness of the layer, the phase has a table of 256 entries, the \
                  thickness one of 256 by 256 of Perlin's noise, and pictures differ in the range of the thickness alone. The mesh casts shadows on \
                  itself and on its floor. Ranges, indices and exponent are luthier's, the latter those of figure 6 and figure 4.",
        seen: "Pictures of four colours of one mesh, each with subtle variations, as in the paper; the mesh is another.",
        size: SMALL,
        claim: Claim {
            text: "The range of thickness alone gives the layer on a mesh another colour, and within each picture the colour \
                  varies. All differences are larger than those that an eye just notices (2.3 units of CIELAB).",
            checks: &[
                Check::Within("140 to 220 nm against 60 to 110 nm: difference of colour", 2.3, 200.0),
                Check::Within("220 to 360 nm against 140 to 220 nm: difference of colour", 2.3, 200.0),
                Check::Within("200 to 700 nm against 220 to 360 nm: difference of colour", 2.3, 200.0),
                Check::Within("60 to 110 nm: deviation of the colour", 2.3, 200.0),
                Check::Within("140 to 220 nm: deviation of the colour", 2.3, 200.0),
                Check::Within("220 to 360 nm: deviation of the colour", 2.3, 200.0),
                Check::Within("200 to 700 nm: deviation of the colour", 2.3, 200.0),
            ],
        },
        make: on_a_mesh,
    },
];

/// Ranges of thickness of figure 7.
const MESH_RANGES_NM: [[f64; 2]; 4] = [[60.0, 110.0], [140.0, 220.0], [220.0, 360.0], [200.0, 700.0]];

/// Width of a repeat of the thickness map of figure 7: bumps that are seen, and do not hide the ball.
const MESH_UM: f64 = 60.0;

fn on_a_mesh(studio: &Studio, made: &mut Made) -> Outcome {
    let on_mesh = Coating { exponents: [90.0; 2], diffuse: 0.5, extent_um: MESH_UM, frequency: 5, ..COATING };
    let tables = "phase = { size = 256 }\nthickness = { size = 256 }\n";
    let mut materials = Vec::new();
    for (name, thickness_nm) in ["mesh-a", "mesh-b", "mesh-c", "mesh-d"].into_iter().zip(MESH_RANGES_NM) {
        materials.push(Coating { name, thickness_nm, ..on_mesh }.with_tables(tables)?);
    }
    let package = Bake::lit().package(&materials, &MemoryStore::default())?;
    let pictures = studio.staged(&package, |_, settings| mesh_look(settings))?;
    let mut shown = Vec::new();
    for ([min, max], picture) in MESH_RANGES_NM.into_iter().zip(pictures) {
        made.measure(format!("{min} to {max} nm: spread of the channels"), spread(&picture));
        made.measure(format!("{min} to {max} nm: deviation of the colour"), tint_deviation(&picture));
        shown.push((format!("{min}-{max} nm"), picture));
    }
    for (ranges, pair) in MESH_RANGES_NM.windows(2).zip(shown.windows(2)) {
        if let ([[a, b], [c, d]], [(_, thin), (_, thick)]) = (ranges, pair) {
            let apart = tints_apart(thick, thin);
            made.measure(format!("{c} to {d} nm against {a} to {b} nm: difference of colour"), apart);
        }
    }
    made.sheet("granier-7", shown, 2);
    // One as large as a page is wide.
    let mut settings = studio.stage()?;
    mesh_look(&mut settings);
    settings.size = studio.size * 4;
    made.picture("granier-7-large", studio.gpu()?.scene(&package, Form::Baked)?.render(&[1], &settings)?);
    Ok(())
}

fn mesh_look(settings: &mut RenderSettings) {
    settings.environment_samples = 8;
    settings.exposure = 0.8;
}

/// The wavelengths of the paper.
const WAVELENGTHS_NM: [f64; 3] = [645.0, 525.0, 445.0];

/// The constant deviation of figure 6.
const TILT_DEG: f64 = 14.0;

/// Width of one repeat of the thickness map: so wide that the boundary is flat, or so narrow that it is hilly.
const FLAT_UM: f64 = 2e4;
const HILLY_UM: f64 = 12.0;

/// The transmitted lobe is no lobe of a mirror, so its sampling needs more directions; and the model is brighter than white.
fn look(_: usize, settings: &mut RenderSettings) {
    settings.environment_samples = 64;
    settings.exposure = 0.8;
}

/// Seed and octaves of the thickness.
const NOISE_SEED: u32 = 7;
const NOISE_OCTAVES: u32 = 4;

/// A film on an object.
struct Coating {
    name: &'static str,
    /// Index of the film, for R, G and B.
    ior: [f64; 3],
    thickness_nm: [f64; 2],
    /// Phong's exponents of the boundaries.
    exponents: [f64; 2],
    /// Weight of the diffuse part. The weight of the specular part is 1.
    diffuse: f64,
    /// Lean of the inner boundary.
    tilt_deg: f64,
    extent_um: f64,
    /// Cells of the noise along one repeat.
    frequency: u32,
}

/// A coating of the printed indices and exponents of figure 6, without a diffuse part.
const COATING: Coating = Coating {
    name: "coating",
    ior: COMBINED_IOR,
    thickness_nm: [66.0, 76.0],
    exponents: [130.0; 2],
    diffuse: 0.0,
    tilt_deg: 0.0,
    extent_um: FLAT_UM,
    frequency: 4,
};

impl Coating {
    /// The material. The object's index is not in the paper: 2 keeps indices rising, which its formula needs.
    fn material(&self) -> Outcome<Material> {
        self.with_tables("")
    }

    /// The material with settings of its tables.
    fn with_tables(&self, tables: &str) -> Outcome<Material> {
        let Self { name, ior: [r, g, b], thickness_nm: [min, max], exponents, diffuse, tilt_deg, extent_um, frequency } =
            self;
        let text = format!(
            "schema = 1\nname = \"{name}\"\n\
             [[layer]]\ntype = \"thin-film\"\nior = {{ n = [{r}, {g}, {b}], wavelengths_nm = [645, 525, 445] }}\n\
             [layer.thickness_nm]\nmin = {min}\nmax = {max}\nextent_um = {extent_um}\n\
             map = {{ noise = {{ seed = {NOISE_SEED}, frequency = {frequency}, octaves = {NOISE_OCTAVES} }} }}\n\
             [[layer]]\ntype = \"dielectric\"\nior = 2.0\nexponents = {exponents:?}\n\
             [[layer]]\ntype = \"diffuse\"\nalbedo = 1\n\
             [bake]\nmodel = \"granier-heidrich\"\ncolor = \"three-wavelengths\"\nwavelengths_nm = [645, 525, 445]\n{tables}\
             [bake.granier-heidrich]\ndiffuse_weight = {diffuse}\ninner_tilt_deg = {tilt_deg}\n"
        );
        Ok(shaded(&material(name, &text)?, name, ShadingModel::GranierHeidrich))
    }
}

/// Rays along each side of a pixel of a ball of the printed equations.
const RAYS: u32 = 2;

/// Factor on the lights by which the brightest highlights keep their colours.
const DIM: f64 = 0.45;

impl Coating {
    /// A ball under the two lights of the studio by the paper's equations 5 and 18, with lobes of height one and no environment, linear.
    fn as_printed(&self, size: u32) -> Image {
        let noise = Perlin { seed: NOISE_SEED, frequency: f64::from(self.frequency), octaves: NOISE_OCTAVES };
        let (sin, cos) = libm::sincos(self.tilt_deg.to_radians());
        let inner_normal = DVec3::new(sin, 0.0, cos);
        let mut image = Image::zeros(size, size, 3);
        let fine = size * RAYS;
        for i in 0..fine * fine {
            let Some(n) = ball_normal([across(i % fine, fine), -across(i / fine, fine)]).map(DVec3::from_array) else {
                continue;
            };
            let tangent = DVec3::new(n.z, 0.0, -n.x).normalize_or(DVec3::X);
            let local = |w: DVec3| DVec3::new(w.dot(tangent), w.dot(n.cross(tangent)), w.dot(n));
            let wo = local((DVec3::new(0.0, 0.0, BALL_DISTANCE) - n).normalize());
            let uv = DVec2::new(0.5 + libm::atan2(n.x, n.z) / (2.0 * PI), libm::acos(n.y.clamp(-1.0, 1.0)) / PI);
            let [min, max] = self.thickness_nm;
            let thickness_nm = min + (max - min) * (0.5 + noise.at(uv)).clamp(0.0, 1.0);
            let texel = image.texel_mut(i % fine / RAYS, i / fine / RAYS);
            for ((value, ior), (nm, c)) in texel.iter_mut().zip(self.ior).zip(WAVELENGTHS_NM.into_iter().zip(0..)) {
                let mut film = film(ior, thickness_nm / nm, 0.0);
                (film.exponents, film.inner_normal) = (self.exponents, inner_normal);
                for light in &LIGHTS {
                    let wi = local(DVec3::from_array(light.direction).normalize());
                    if wi.z <= 0.0 {
                        continue;
                    }
                    let sent = film.specular(wi, wo) + self.diffuse * film.diffuse() * wi.z;
                    let irradiance: f64 = light.irradiance[c];
                    *value += (DIM * irradiance * sent / f64::from(RAYS * RAYS)) as f32;
                }
            }
        }
        image
    }
}

fn materials(coatings: &[Coating]) -> Outcome<Vec<Material>> {
    coatings.iter().map(Coating::material).collect()
}

fn diffuse(studio: &Studio, made: &mut Made) -> Outcome {
    let ranges = [("old metal", [52.0, 84.0]), ("coloured", [200.0, 700.0]), ("clay", [54.0, 68.0])];
    let names = [["metal", "metal-0"], ["coloured", "coloured-0"], ["clay", "clay-0"]];
    let pairs = ranges.iter().zip(names).flat_map(|((_, thickness_nm), [lit, unlit])| {
        let film = Coating { thickness_nm: *thickness_nm, frequency: 6, ..COATING };
        [Coating { name: lit, diffuse: 0.6, ..film }, Coating { name: unlit, diffuse: 0.0, ..film }]
    });
    let pictures = studio.pictures(&materials(&pairs.collect::<Vec<_>>())?, Form::Baked, Shape::Sphere, look)?;
    let mut shown = Vec::new();
    for ((name, [min, max]), pair) in ranges.iter().zip(pictures.chunks_exact(2)) {
        // The specular part is equal in both, so the difference is the diffuse part.
        if let [lit, unlit] = pair {
            let image = less(lit, unlit);
            made.measure(format!("{name}, {min} to {max} nm: spread of the channels"), spread(&image));
            made.measure(format!("{name}, {min} to {max} nm: share of the hues"), hues(&image));
            made.measure(format!("{name}, {min} to {max} nm: hue"), hue(&image, 0.5));
            shown.push((format!("{min}-{max} nm"), image));
        }
    }
    made.sheet("granier-3", shown, 3);

    let mut curves = Vec::new();
    let channels = [("R", PlotColor::Red), ("G", PlotColor::Green), ("B", PlotColor::Blue)];
    for ((channel, color), (nm, ior)) in channels.into_iter().zip(WAVELENGTHS_NM.iter().zip(COMBINED_IOR)) {
        let points = (0..=350_u32).map(|i| {
            let d = f64::from(i) * 2.0;
            [d, film(ior, d / nm, 0.0).diffuse()]
        });
        let name = format!("{channel}: {nm} nm, index {ior}");
        curves.push(Curve { name, color, points: points.collect() });
    }
    made.plot(
        "granier-3-thickness",
        Plot {
            title: "Diffuse coefficient against the thickness of the film".to_owned(),
            x: PlotAxis::new("thickness of the film, nm", [0.0, 700.0], 100.0),
            y: PlotAxis::new("diffuse coefficient (eq. 18)", [0.0, 2.0], 0.5),
            curves,
        },
    );
    Ok(())
}

fn deviation(studio: &Studio, made: &mut Made) -> Outcome {
    let coating =
        |name, ior, inner, tilt_deg| Coating { name, ior, exponents: [90.0, inner], diffuse: 0.7, tilt_deg, ..COATING };
    let rising = [1.4, 1.45, 1.6];
    let coatings = [
        coating("parallel", rising, 170.0, 0.0),
        coating("deviated", rising, 170.0, TILT_DEG),
        coating("no-dispersion", [1.45; 3], 170.0, TILT_DEG),
        coating("rough", rising, 20.0, TILT_DEG),
    ];
    let pictures: Vec<Image> = coatings.iter().map(|coating| coating.as_printed(studio.size)).collect();
    let labels = ["parallel", "14 degrees", "one index", "90 and 20"];
    for (label, picture) in labels.iter().zip(&pictures) {
        made.measure(format!("{label}: spread of the channels"), spread(picture));
        made.measure(format!("{label}: share blown out"), blown_out(picture));
    }
    // The specular part alone, under one light.
    let bare: Vec<Coating> = coatings
        .into_iter()
        .chain([coating("half", rising, 170.0, 0.5 * TILT_DEG)])
        .map(|coating| Coating { diffuse: 0.0, ..coating })
        .collect();
    let lit = studio.lit(&materials(&bare)?, Form::Baked, Shape::Sphere, FROM_EYE)?;
    for (label, picture) in labels.iter().chain([&"7 degrees"]).zip(&lit) {
        let beam = if *label == "parallel" { picture.clone() } else { less(picture, &lit[0]) };
        let [red, green, blue] = centres(&beam).map(|[x, y]| libm::hypot(x, y));
        for (channel, aside) in [("red", red), ("green", green), ("blue", blue)] {
            made.measure(format!("{label}: {channel}, aside"), aside);
        }
        made.measure(format!("{label}: blue and red apart"), (blue - red).abs());
        made.measure(format!("{label}: width of the second highlight"), spot(&beam).share.sqrt());
        made.measure(format!("{label}: colours of the highlights"), saturation_of_light(picture));
    }
    made.sheet("granier-4", labels.into_iter().zip(pictures), 4);
    Ok(())
}

fn correlated(studio: &Studio, made: &mut Made) -> Outcome {
    let film = Coating { ior: [1.4, 1.45, 1.6], exponents: [90.0; 2], ..COATING };
    let coatings = [
        ("flat", FLAT_UM, [100.0, 400.0]),
        ("hilly", HILLY_UM, [100.0, 400.0]),
        ("flat-oil", FLAT_UM, [200.0, 900.0]),
        ("hilly-oil", 2.0 * HILLY_UM, [200.0, 900.0]),
    ];
    let coatings = coatings.map(|(name, extent_um, thickness_nm)| Coating { name, extent_um, thickness_nm, ..film });
    let pictures = studio.pictures(&materials(&coatings)?, Form::Baked, Shape::Sphere, look)?;
    let labels = ["flat 100-400", "bump 100-400", "flat 200-900", "bump 200-900"];
    for (label, picture) in labels.iter().zip(&pictures) {
        made.measure(format!("{label}: colour between neighbours"), tint_grain(picture));
        made.measure(format!("{label}: share of the hues"), hues(picture));
        made.measure(format!("{label}: spread of the channels"), spread(picture));
    }
    made.sheet("granier-5", labels.into_iter().zip(pictures), 4);
    Ok(())
}

/// Thickness at which the beams of a film of index 1.6 are in phase at 80 degrees and 525 nm: 525 / (2 1.6 0.788).
const IN_PHASE_NM: f64 = 208.0;

/// Index of the film of figure 6, used for figure 3, too, which states none.
const COMBINED_IOR: [f64; 3] = [1.5, 1.6, 1.8];

fn combined(studio: &Studio, made: &mut Made) -> Outcome {
    let ranges = [("a", [50.0, 70.0]), ("b", [110.0, 140.0]), ("c", [160.0, 200.0]), ("d", [200.0, 600.0])];
    let tilted = Coating { diffuse: 0.5, tilt_deg: TILT_DEG, ..COATING };
    let coatings = ranges.map(|(name, thickness_nm)| Coating { name, thickness_nm, ..tilted });
    let mut shown = Vec::new();
    for ((_, [min, max]), coating) in ranges.iter().zip(&coatings) {
        let picture = coating.as_printed(studio.size);
        made.measure(format!("{min} to {max} nm: spread of the channels"), spread(&picture));
        made.measure(format!("{min} to {max} nm: share blown out"), blown_out(&picture));
        let [green, blue] = [1, 2].map(|channel| over_red(&picture, channel));
        made.measure(format!("{min} to {max} nm: green over red"), green);
        made.measure(format!("{min} to {max} nm: blue over red"), blue);
        made.measure(format!("{min} to {max} nm: blue or green over red"), green.max(blue));
        shown.push((format!("{min}-{max} nm"), picture));
    }
    made.sheet("granier-6", shown, 4);
    // The specular part alone, under one light, of the indices of figure 6 and of figure 4.
    let bare = [COMBINED_IOR, [1.4, 1.45, 1.6]].map(|ior| [0.0, TILT_DEG].map(|tilt_deg| (ior, tilt_deg)));
    let bare = bare.concat().into_iter().zip(["p", "q", "r", "s"]).map(|((ior, tilt_deg), name)| Coating {
        name,
        ior,
        tilt_deg,
        ..COATING
    });
    let lit = studio.lit(&materials(&bare.collect::<Vec<_>>())?, Form::Baked, Shape::Sphere, FROM_EYE)?;
    for (label, pair) in ["1.5, 1.6, 1.8", "1.4, 1.45, 1.6"].into_iter().zip(lit.chunks_exact(2)) {
        let [red, green, blue] = centres(&less(&pair[1], &pair[0])).map(|[x, y]| libm::hypot(x, y));
        if label.starts_with("1.5") {
            for (channel, aside) in [("red", red), ("green", green), ("blue", blue)] {
                made.measure(format!("highlight: {channel}, aside"), aside);
            }
        }
        made.measure(format!("indices {label}: blue and red apart"), (blue - red).abs());
    }

    let green = Coating { name: "green", ior: [1.6; 3], thickness_nm: [100.0; 2], frequency: 1, ..COATING };
    let stack = green.material()?.stack;
    let over_thickness = curves(&stack, (0..=350_u32).map(|i| (f64::from(i) * 2.0, f64::from(i) * 2.0, 0.0)));
    let over_angle = (0..=178_u32).map(|i| (f64::from(i) * 0.5, IN_PHASE_NM, (f64::from(i) * 0.5).to_radians()));
    let over_angle = curves(&stack, over_angle);
    for (what, curves) in [("at the normal, over thickness", &over_thickness), ("at 208 nm, over angle", &over_angle)] {
        for curve in curves {
            let largest = curve.points.iter().map(|p| p[1]).fold(0.0, f64::max);
            made.measure(format!("525 nm, {what}, {}: largest", curve.name), largest);
        }
    }
    let y = PlotAxis::new("reflectance in the mirror direction, 525 nm", [0.0, 2.0], 0.5);
    made.plot(
        "granier-6-thickness",
        Plot {
            title: "Reflectance at the normal against the thickness of the film".to_owned(),
            x: PlotAxis::new("thickness of the film, nm", [0.0, 700.0], 100.0),
            y: y.clone(),
            curves: over_thickness.into(),
        },
    );
    made.plot(
        "granier-6-angle",
        Plot {
            title: "Reflectance in the mirror direction against the angle, film of 208 nm".to_owned(),
            x: PlotAxis::new("angle to the normal, degrees", [0.0, 90.0], 15.0),
            y: y.clone(),
            curves: over_angle.into(),
        },
    );
    Ok(())
}

/// Reflectances in the mirror direction by the model and by Airy's formula. Each point has a place on the axis, a thickness in nm and an angle.
fn curves(stack: &Stack, points: impl Iterator<Item = (f64, f64, f64)>) -> [Curve; 2] {
    let (mut beams, mut exact) = (Vec::new(), Vec::new());
    for (x, thickness_nm, theta) in points {
        let waves = thickness_nm / WAVELENGTHS_NM[1];
        let (sin, cos) = libm::sincos(theta);
        let (wi, wo) = (DVec3::new(sin, 0.0, cos), DVec3::new(-sin, 0.0, cos));
        beams.push([x, film(1.6, waves, 130.0).specular(wi, wo)]);
        let mut here = Monochrome::new(stack, WAVELENGTHS_NM[1], 1);
        here.layers.iter_mut().flat_map(|layer| &mut layer.films).for_each(|film| film.waves = waves);
        exact.push([x, here.layers.first().map_or(0.0, |layer| layer.reflectance(libm::cos(theta)))]);
    }
    let (model, airy) = ("two beams (eq. 5), lobes of height one", "exact, film of index 1.6 on an object of index 2");
    [(model, PlotColor::Ink, beams), (airy, PlotColor::Red, exact)].map(|(name, color, points)| Curve {
        name: name.to_owned(),
        color,
        points,
    })
}

/// A film in air, `waves` wavelengths of vacuum thick.
fn film(ior: f64, waves: f64, exponent: f64) -> Film {
    Film { eta: ior, f0: None, waves_inside: Some(ior * waves), inner_normal: DVec3::Z, exponents: [exponent; 2] }
}

/// Largest channel less the smallest, as a display shows them, mean over the picture.
fn spread(image: &Image) -> f64 {
    let spreads = image.texels().map(|texel| {
        let (low, high) =
            texel.iter().map(|v| TONE.value(*v)).fold((f32::INFINITY, 0.0_f32), |(a, b), v| (a.min(v), b.max(v)));
        f64::from(high - low)
    });
    spreads.sum::<f64>() / image.texel_count() as f64
}

/// The light that a picture has in excess of another.
fn less(picture: &Image, other: &Image) -> Image {
    let mut rest = picture.clone();
    rest.data.iter_mut().zip(&other.data).for_each(|(a, b)| *a = (*a - b).max(0.0));
    rest
}

/// Mean saturation of the light of a picture, weighted by its brightness: the largest channel less the smallest, over the largest.
fn saturation_of_light(picture: &Image) -> f64 {
    let (mut apart, mut whole) = (0.0, 0.0);
    for texel in picture.texels() {
        let (low, high) = texel.iter().fold((f32::INFINITY, 0.0_f32), |(a, b), v| (a.min(*v), b.max(*v)));
        apart += f64::from(high - low);
        whole += f64::from(high);
    }
    apart / f64::max(whole, 1e-12)
}
