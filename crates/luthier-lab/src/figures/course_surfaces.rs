//! Figures of the course of Weidlich and Wilkie about surfaces of several materials.

use std::path::Path;

use glam::DVec2;
use luthier::{Bake, MemoryStore, Sources, SurfaceSource, lit, surface_map};
use luthier_gpu::{Camera, Light, RenderSettings, Shape, Shown};
use luthier_lut::Image;
use luthier_manifest::{CellsRecord, Form, ParticlesRecord, SurfaceEntry};
use luthier_material::Material;
use luthier_report::lightness_chroma_hue;
use luthier_terminal::{Failure, Outcome, valid};

use super::claim::{Check, Claim};
use super::course::by_course;
use super::figure::{Figure, LARGE as SIZE, MEDIUM, Made, compared};
use super::numbers::places::{edges, sparkles, sparkles_that_stay};
use super::numbers::tint::tint_deviation;
use super::numbers::{brightest, glitter as glittering, middle, share};
use super::studio::Studio;

pub(crate) const FIGURES: [Figure; 3] = [
    Figure {
        name: "course-5-1",
        title: "stones of grains and glitter",
        source: "A. Weidlich and A. Wilkie, Exploring the Potential of Layered BRDF Models, SIGGRAPH Asia 2009 Courses, figure 5.1",
        caption: "Top row: opaque sunstone, a varnish over a Lambertian base of one colour and a glitter map of four entries, copper of slope 3 degrees below varnish of that colour; pink sunstone, of which many \
                  cells glitter; patterned sunstone, with fewer, in which three functions of Perlin choose the material. The latter two have three entries of slope 5 degrees. In the course they are translucent, with a glitter map inside: luthier's surfaces have no \
                  volume, and a tinted varnish over a pale base stands for it. Bottom row: lepidolite has dark and bright tiles, veins of marble, and few flakes of silver on top, and course-5-3 shows its maps one by one; green and raspberry \
                  aventurine are grains of six shades and flakes. Indices, slopes and numbers of entries are the \
                  course's where it prints them, colours and numbers of cells luthier's: the files are in `materials/surfaces`. A pixel sparkles where it is at least twice as bright as the median around it; \
                  the light moves from the upper left to the upper right.",
        seen: "Six stones that glitter, each of its kind. Against photographs of stones, the flakes are larger and flat, wider than high \
               near the equator, and the stones have no depth: the translucent ones are painted.",
        size: MEDIUM,
        claim: Claim {
            text: "Metallic cells glitter in a stone of one colour, and fewer of them in a stone of many grains. Pink sunstone has \
                  much more glitter than the opaque one, and patterned sunstone less, but its colour varies. Which cells glitter depends on where the light is.",
            checks: &[
                Check::Falls(&["sunstone: sparkles", "sunstone without glitter: sparkles"]),
                Check::Falls(&["lepidolite: sparkles", "lepidolite without glitter: sparkles"]),
                Check::Falls(&["green-aventurine: sparkles", "green-aventurine without glitter: sparkles"]),
                Check::Falls(&["raspberry-aventurine: sparkles", "raspberry-aventurine without glitter: sparkles"]),
                Check::Falls(&["pink-sunstone: sparkles", "sunstone: sparkles", "patterned-sunstone: sparkles"]),
                Check::Falls(&[
                    "pink-sunstone: share of the square that glitters",
                    "sunstone: share of the square that glitters",
                    "patterned-sunstone: share of the square that glitters",
                    "lepidolite: share of the square that glitters",
                ]),
                // Very few cells of the lepidolite's map are filled.
                Check::Within("lepidolite: share of the square that glitters", 0.001, 0.1),
                Check::Within("sunstone: share of the sparkles that stay when the light moves", 0.0, 0.5),
                Check::Falls(&[
                    "lepidolite without glitter: deviation of the colour",
                    "sunstone without glitter: deviation of the colour",
                ]),
                Check::Falls(&[
                    "patterned-sunstone without glitter: deviation of the colour",
                    "sunstone without glitter: deviation of the colour",
                ]),
            ],
        },
        make: stones,
    },
    Figure {
        name: "course-5-2",
        title: "cells, glitter and bumps, one over the other",
        source: "Weidlich and Wilkie 2009, figure 5.2",
        caption: "The course draws how maps of Voronoi cells lie one over the other; here each map is a square of a surface that the shader picks. \
                  The surface map (1) has small cells, grains of the dark lepidolite. The glitter map (2) has fewer and larger cells, most of them transparent: here they are dark. \
                  The surface-glitter map (3) is both. The bump map (4) tilts the cells of the glitter map that are not transparent, and no others: one grey material shows \
                  it. The combined maps (5) are grains, with particles of which some sparkle.",
        seen: "The five squares are those of the course's drawing.",
        size: SIZE,
        claim: Claim {
            text: "The glitter map, most of which is transparent, lies over the surface map. The bump map tilts exactly those cells \
                  of the glitter map that are not transparent. Then some of them sparkle.",
            checks: &[
                Check::Within("2: share that is not transparent", 0.05, 0.5),
                // Pixels on the edges of cells are of both.
                Check::Within("3: share of the transparent places that differ from 1", 0.0, 0.02),
                Check::Within("3: share of the other places that differ from 1", 0.9, 1.0),
                Check::Within("4: share of the transparent places that are tilted", 0.0, 0.02),
                Check::Within("4: share of the other places that are tilted", 0.9, 1.0),
                Check::Falls(&["5: brightest place", "3: brightest place"]),
            ],
        },
        make: maps,
    },
    Figure {
        name: "course-5-3",
        title: "lepidolite from near, and its maps",
        source: "Weidlich and Wilkie 2009, figure 5.3",
        caption: "Lepidolite has a surface map of dark tiles and one of bright tiles, nine entries each, of cells of one size. A map of larger tiles has either. The marble has three entries, \
                  brighter than the bright tiles, and one of either kind of tiles, in much smaller cells. Perlin's noise near 0 puts it into veins: \
                  that is the marble function here, because the course does not print its own. Colours, numbers of cells and the noise are luthier's.",
        seen: "The maps and their combination are those of the course's drawing; the veins are thinner than in a photograph of the stone.",
        size: SIZE,
        claim: Claim {
            text: "Dark and bright tiles of one size share the surface, and veins of marble cross it, whose tiles are brighter and much \
                  smaller.",
            checks: &[
                Check::Falls(&[
                    "marble: lightness L* of the middle",
                    "bright tiles: lightness L* of the middle",
                    "b dark tiles: lightness L* of the middle",
                ]),
                Check::Falls(&["marble: share of edges", "bright tiles: share of edges"]),
                Check::Falls(&["marble: share of edges", "b dark tiles: share of edges"]),
                Check::Within("bright tiles over dark tiles: share of edges", 0.8, 1.25),
                Check::Within("share of the square: bright tiles", 0.1, 0.9),
                Check::Within("share of the square: dark tiles", 0.1, 0.9),
                Check::Within("share of the square: marble", 0.02, 0.4),
            ],
        },
        make: lepidolite,
    },
];

/// Surface files of the repository, with their labels.
const STONES: [(&str, &str); 6] = [
    ("sunstone", "sunstone"),
    ("pink-sunstone", "pink"),
    ("patterned-sunstone", "patterned"),
    ("lepidolite", "lepidolite"),
    ("green-aventurine", "green aventurine"),
    ("raspberry-aventurine", "raspberry aventurine"),
];

/// The materials and the surface of a file of the repository.
fn stone(name: &str) -> Outcome<(Vec<Material>, SurfaceEntry)> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../materials/surfaces/{name}.toml"));
    let sources = Sources::read([path])?;
    let surface = sources.surfaces.first().and_then(SurfaceSource::entry);
    let materials = valid(sources.materials, true)?;
    Ok((materials, surface.ok_or_else(|| Failure::Input(anyhow::anyhow!("{name} is no surface")))?))
}

/// Renders each surface of some materials, linear.
fn pictures(
    studio: &Studio,
    materials: &[Material],
    surfaces: &[SurfaceEntry],
    settings: impl Fn(usize) -> Outcome<RenderSettings>,
) -> Outcome<Vec<Image>> {
    let bake = Bake { surfaces: surfaces.to_vec(), ..Bake::lit() };
    let package = bake.package(&lit(materials), &MemoryStore::default())?;
    let scene = studio.gpu()?.scene(&package, Form::Baked)?;
    (0..surfaces.len()).map(|n| Ok(scene.render_shown(&[Shown::Surface(n as u32)], &settings(n)?)?)).collect()
}

fn stones(studio: &Studio, made: &mut Made) -> Outcome {
    let mut all = Vec::new();
    for (name, label) in STONES {
        let (materials, surface) = stone(name)?;
        made.measure(
            format!("{name}: share of the square that glitters"),
            shares(&surface).last().copied().unwrap_or_default(),
        );
        let plain = SurfaceEntry { name: "plain".to_owned(), glitter: None, ..surface.clone() };
        let plain = pictures(studio, &materials, &[plain], |_| ball(studio))?;
        let picture = pictures(studio, &materials, std::slice::from_ref(&surface), |_| ball(studio))?;
        let moved = pictures(studio, &materials, &[surface], |_| {
            let lights = vec![Light::Directional { direction: [0.45, 0.7, 0.6], irradiance: [1.75, 1.7, 1.62] }];
            Ok(RenderSettings { lights, ..ball(studio)? })
        })?;
        for ((picture, moved), plain) in picture.iter().zip(&moved).zip(&plain) {
            made.measure(format!("{name}: share at least twice as bright as the median"), glittering(picture));
            made.measure(format!("{name}: sparkles"), sparkles(picture));
            made.measure(format!("{name} without glitter: sparkles"), sparkles(plain));
            made.measure(format!("{name} without glitter: deviation of the colour"), tint_deviation(plain));
            let stay = sparkles_that_stay(picture, moved);
            made.measure(format!("{name}: share of the sparkles that stay when the light moves"), stay);
        }
        all.extend(picture.into_iter().map(|picture| (label.to_owned(), picture)));
    }
    made.sheet("course-5-1", all, 3);
    Ok(())
}

/// A surface with other cells, and without switches and glitter.
fn bare(whole: &SurfaceEntry, name: &str, cells: CellsRecord) -> SurfaceEntry {
    SurfaceEntry { name: name.to_owned(), cells, switches: Vec::new(), glitter: None, ..whole.clone() }
}

/// A ball without samples of the environment: their directions would be drawn about the level surface, and miss what tilted flakes mirror.
fn ball(studio: &Studio) -> Outcome<RenderSettings> {
    Ok(RenderSettings { environment_samples: 0, ..studio.settings(Shape::Sphere)? })
}

/// A square of the plane, from above, that fills the picture. Its environment is blurred beforehand, so that flakes have no grain.
pub(super) fn square(studio: &Studio) -> Outcome<RenderSettings> {
    let mut settings = studio.settings(Shape::Plane)?;
    settings.camera = Camera { eye: [0.0, 7.0, 0.7], target: [0.0; 3], half_extent: 0.97 };
    settings.environment_samples = 0;
    Ok(settings)
}

/// Places of the unit square in which shares are counted, along each side.
const COUNTED: u32 = 512;

/// Shares of a surface that its maps cover: its cells, the cells of its switches, its particles.
fn shares(surface: &SurfaceEntry) -> Vec<f64> {
    let mut numbered = surface.clone();
    let SurfaceEntry { cells, switches, glitter, .. } = &mut numbered;
    let inside = switches.iter_mut().map(|switch| &mut switch.cells);
    let all = std::iter::once(cells).chain(inside).chain(glitter.as_mut().map(|glitter| &mut glitter.cells));
    for (number, cells) in (0..).zip(all) {
        cells.materials = vec![number];
    }
    let map = surface_map(&numbered);
    let mut counts = vec![0.0; numbered.switches.len() + 2];
    for i in 0..COUNTED * COUNTED {
        let uv = (DVec2::new(f64::from(i % COUNTED), f64::from(i / COUNTED)) + 0.5) / f64::from(COUNTED);
        counts[map.pick(uv).stack] += f64::from(COUNTED * COUNTED).recip();
    }
    counts
}

/// Cells of the schematic, in which single ones can be seen, and the share of larger ones that glitters.
const SMALL: f64 = 16.0;
const LARGE: f64 = 7.0;
const FILLED: f64 = 0.3;

fn maps(studio: &Studio, made: &mut Made) -> Outcome {
    let (mut materials, entry) = stone("lepidolite")?;
    for (name, albedo) in [("transparent", 0.02), ("grey", 0.5)] {
        let layers = format!(
            "[[layer]]\ntype = \"dielectric\"\nior = 1.56\nslope_deg = 4\n[[layer]]\ntype = \"diffuse\"\nalbedo = {albedo}\n"
        );
        materials.push(by_course(name, &layers)?);
    }
    let last = materials.len() as u32 - 1;
    let (transparent, grey) = ([last - 1], [last]);
    let glitter = entry.glitter.clone();
    let glitter = glitter.ok_or_else(|| Failure::Input(anyhow::anyhow!("the lepidolite does not glitter")))?;
    let (grains, flakes) = (&entry.cells.materials[..], &glitter.cells.materials[..]);
    let surfaces = [
        ("surface", grains, None),
        ("glitter", &transparent[..], Some((flakes, 0.0))),
        ("surface-glitter", grains, Some((flakes, 0.0))),
        ("bump", &grey[..], Some((&grey[..], glitter.tilt))),
        ("combined", grains, Some((flakes, glitter.tilt))),
    ];
    let surfaces = surfaces.map(|(name, grains, particles)| {
        let cells = CellsRecord { frequency: SMALL, materials: grains.to_vec(), ..entry.cells.clone() };
        let glitter = particles.map(|(materials, tilt)| {
            let cells = CellsRecord { frequency: LARGE, materials: materials.to_vec(), ..glitter.cells.clone() };
            ParticlesRecord { cells, filled: FILLED, tilt }
        });
        SurfaceEntry { glitter, ..bare(&entry, name, cells) }
    });
    let labels = ["1 surface", "2 glitter", "3 both", "4 bumps", "5 combined"];
    let all = pictures(studio, &materials, &surfaces, |_| square(studio))?;
    let level = [("transparent", transparent), ("level", grey)].map(|(name, materials)| {
        let cells = CellsRecord { frequency: SMALL, materials: materials.to_vec(), ..entry.cells.clone() };
        bare(&entry, name, cells)
    });
    let level = pictures(studio, &materials, &level, |_| square(studio))?;
    let filled = differ(&all[1], &level[0]);
    made.measure("2: share that is not transparent", share(filled.iter().copied()));
    for (what, of) in [("3", differ(&all[2], &all[0])), ("4", differ(&all[3], &level[1]))] {
        let is = if what == "3" { "differ from 1" } else { "are tilted" };
        for (which, is_filled) in [("transparent", false), ("other", true)] {
            let hits = of.iter().zip(&filled).filter(|(_, filled)| **filled == is_filled).map(|(hit, _)| *hit);
            made.measure(format!("{what}: share of the {which} places that {is}"), share(hits));
        }
    }
    made.measure("3: brightest place", brightest(&all[2]));
    made.measure("5: brightest place", brightest(&all[4]));
    made.measure("cells of the surface map per cell of the glitter map", SMALL * SMALL / (LARGE * LARGE));
    made.measure(format!("share of the square that glitters, {FILLED} of the cells"), shares(&surfaces[4])[1]);
    made.measure("3 against 1: mean FLIP", compared(&all[2], &all[0])?.flip_mean);
    made.measure("5 against 3: mean FLIP", compared(&all[4], &all[2])?.flip_mean);
    made.sheet("course-5-2", labels.into_iter().zip(all), 5);
    Ok(())
}

/// True for each pixel in which two pictures differ by more than rounding.
fn differ(a: &Image, b: &Image) -> Vec<bool> {
    a.texels().zip(b.texels()).map(|(a, b)| a.iter().zip(b).any(|(a, b)| (a - b).abs() > 1e-3)).collect()
}

fn lepidolite(studio: &Studio, made: &mut Made) -> Outcome {
    let (materials, whole) = stone("lepidolite")?;
    let [marble, bright] = &whole.switches[..] else {
        return Err(Failure::Input(anyhow::anyhow!("the lepidolite has other switches than marble and bright tiles")));
    };
    let combined = SurfaceEntry { name: "combined".to_owned(), glitter: None, ..whole.clone() };
    let tiles = SurfaceEntry { switches: vec![bright.clone()], ..bare(&whole, "tiles", whole.cells.clone()) };
    let surfaces = [
        whole.clone(),
        bare(&whole, "dark", whole.cells.clone()),
        bare(&whole, "bright", bright.cells.clone()),
        tiles,
        bare(&whole, "marble", marble.cells.clone()),
        combined,
    ];
    let labels = ["a close-up", "b dark tiles", "bright tiles", "larger tiles", "marble", "combined"];
    let all = pictures(studio, &materials, &surfaces, |n: usize| {
        if n > 0 {
            return square(studio);
        }
        let mut settings = studio.settings(Shape::Sphere)?;
        settings.camera = Camera { target: [0.25, -0.1, 0.0], half_extent: 0.65, ..settings.camera };
        settings.environment_samples = 0;
        Ok(settings)
    })?;
    for (label, picture) in labels.iter().zip(&all).skip(1).filter(|(label, _)| !label.contains("larger")) {
        made.measure(format!("{label}: lightness L* of the middle"), lightness_chroma_hue(middle(picture, 0.2))[0]);
        made.measure(format!("{label}: share of edges"), edges(picture));
    }
    made.measure("bright tiles over dark tiles: share of edges", edges(&all[2]) / edges(&all[1]).max(1e-9));
    let names = ["dark tiles", "marble", "bright tiles", "glitter"];
    for (name, share) in names.iter().zip(shares(&whole)) {
        made.measure(format!("share of the square: {name}"), share);
    }
    made.sheet("course-5-3", labels.into_iter().zip(all), 3);
    Ok(())
}
