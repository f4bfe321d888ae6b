//! Bevy draws bakes: `cargo test --test host -- OUT [PART...]` leaves its pictures in the folder OUT (by default target/bevy). Parts are balls, lamps, anew
//! and refusals; by default all.
//!
//! - Balls against `luthier preview`: plain and textured materials under a lamp far away and near, in an environment and in even light.
//! - Three kinds of lamps with shadows, a spot's cone, fog.
//! - A bake that is written anew is shown.
//! - Wrong bakes are named.
//!
//! Needs a Vulkan driver. The environment variable LUTHIER names the program that bakes; by default cargo builds it.

use std::cell::RefCell;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Output};

use image::RgbImage;
use serde_json::{Value, json};

const LAMP: [f64; 3] = [1.75, 1.7, 1.62];

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let out = env::args_os().nth(1).map_or_else(|| root.join("target/bevy"), PathBuf::from);
    fs::create_dir_all(&out).unwrap();
    let out = fs::canonicalize(out).unwrap();
    let host = Host { root: fs::canonicalize(root).unwrap(), out, failures: RefCell::default() };
    let parts: Vec<String> = env::args().skip(2).collect();
    let all: [(&str, fn(&Host)); 4] =
        [("balls", Host::balls), ("lamps", Host::lamps), ("anew", Host::written_anew), ("refusals", Host::refusals)];
    for (name, part) in all {
        if parts.is_empty() || parts.iter().any(|part| part == name) {
            part(&host);
        }
    }
    let failures = host.failures.into_inner();
    if failures.is_empty() {
        return ExitCode::SUCCESS;
    }
    eprintln!("{} failed:\n{}", failures.len(), failures.join("\n"));
    ExitCode::FAILURE
}

struct Host {
    root: PathBuf,
    out: PathBuf,
    failures: RefCell<Vec<String>>,
}

impl Host {
    fn check(&self, holds: bool, words: String) {
        println!("{}: {words}", if holds { "holds" } else { "FAILS" });
        if !holds {
            self.failures.borrow_mut().push(words);
        }
    }

    fn luthier(&self, arguments: &[&str]) {
        let mut command = match env::var_os("LUTHIER") {
            Some(program) => Command::new(program),
            None => {
                let mut cargo = Command::new("cargo");
                cargo.args(["run", "--locked", "--quiet", "-p", "luthier-cli", "--bin", "luthier", "--"]);
                cargo
            }
        };
        let status = command.args(arguments).current_dir(&self.root).status().unwrap();
        assert!(status.success(), "luthier {arguments:?}");
    }

    /// A path in the folder of pictures.
    fn at(&self, name: &str) -> String {
        self.out.join(name).to_str().unwrap().to_owned()
    }

    /// Bakes materials with the functions that Bevy needs.
    fn bake(&self, name: &str, materials: &[&str], functions: &str) -> String {
        let folder = self.at(name);
        let _ = fs::remove_dir_all(&folder);
        let options = ["--out", &folder, "--target", "wgsl", "--form", "baked", "--quiet", "--functions", functions];
        self.luthier(&[&["bake"], materials, &options].concat());
        folder
    }

    /// What the program says of a bake, a scene and a picture.
    fn show(&self, bake: &str, scene: &Value, rest: &[&str]) -> Output {
        let file = self.at("scene.json");
        fs::write(&file, scene.to_string()).unwrap();
        Command::new(env!("CARGO_BIN_EXE_luthier-bevy")).args([bake, &file]).args(rest).output().unwrap()
    }

    /// The picture of a scene.
    fn picture(&self, bake: &str, scene: &Value, name: &str) -> RgbImage {
        let png = self.at(name);
        let output = self.show(bake, scene, &[&png]);
        assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        read(&png)
    }

    /// The picture of `luthier preview` of the ball.
    fn preview(&self, bake: &str, material: &str, light: &[&str], name: &str) -> RgbImage {
        let (png, color) = (self.at(name), LAMP.map(|value| value.to_string()).join(","));
        let ball = ["preview", material, "--out", bake, "-o", &png, "--shape", "sphere", "--size", "256"];
        let plain = ["--samples", "1", "--tone", "none", "--light-color", &color, "--background"];
        self.luthier(&[&ball[..], &plain, light].concat());
        read(&png)
    }

    /// A map of one radiance, which a byte states: 0, or one half for 128.
    fn even(&self, name: &str, byte: u8) -> String {
        let file = self.at(name);
        let mut map = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n".to_vec();
        map.extend([byte; 8]);
        fs::write(&file, map).unwrap();
        file
    }

    fn balls(&self) {
        let plain = ["materials/polished-gold.toml", "materials/red-lacquer.toml", "materials/copper-patina.toml"];
        let plain = self.bake("plain", &plain, "surface");
        let lit = self.bake("lit", &["materials/red-lacquer.toml"], "surface,environment,albedo");
        let board = self.bake("board", &["materials/textured", "--no-fit"], "surface");
        let film = self.bake("film", &["materials/papers/granier-film.toml"], "surface");
        let studio = self.at("studio");
        self.luthier(&["environment", "--sky", "strip-studio", "--layout", "cube", "--out", &studio]);
        let (black, grey) = (self.even("black.hdr", 0), self.even("grey.hdr", 128));

        let far = json!({ "lights": [{ "direction": [0.5, 0.7, 0.6], "irradiance": LAMP }] });
        let near = json!({ "lights": [{ "position": [1.0, 1.5, 2.0], "irradiance": LAMP }] });
        let around = json!({ "lights": [], "environment": studio, "slope_variance": 0.0 });
        let even = json!({ "lights": [], "ambient": 0.5, "slope_variance": 0.0 });
        let dark = ["--environment", &black, "--environment-samples", "1"];
        let from = [&dark[..], &["--light", "0.5,0.7,0.6"]].concat();
        let at = [&dark[..], &["--point-light", "1,1.5,2"]].concat();
        let sky = vec!["--sky", "strip-studio"];
        let half = vec!["--environment", &grey];
        let cases = [
            ("gold", "polished-gold", &plain, &far, &from),
            ("lacquer", "red-lacquer", &plain, &far, &from),
            ("near-lacquer", "red-lacquer", &plain, &near, &at),
            ("lit-lacquer", "red-lacquer", &lit, &around, &sky),
            ("even-lacquer", "red-lacquer", &lit, &even, &half),
            ("patina", "copper-patina", &plain, &far, &from),
            ("film", "granier-film", &film, &far, &from),
            ("brass", "worn-brass", &board, &far, &from),
            ("tile", "celadon-tile", &board, &far, &from),
        ];
        for (name, material, bake, light, options) in cases {
            let expected = self.preview(bake, material, options, &format!("{name}-preview.png"));
            let shown = self.picture(bake, &scene(material, light), &format!("{name}.png"));
            // Behind the ball there is the environment in one, and nothing in the other.
            let Apart { median, p95, p99, most, pixels } = apart(&expected, &shown, options.starts_with(&dark));
            // A texture that is misread makes 5 or more in the 95 %.
            self.check(
                median <= 2 && p95 <= 3,
                format!("{name} by Bevy against preview: median {median} of 255, 95 % within {p95}, 99 % within {p99}, largest {most}, {pixels} pixels"),
            );
        }
    }

    fn lamps(&self) {
        let bake = self.bake("lamps", &["materials/red-lacquer.toml", "--no-fit"], "surface");
        let lit = |lamp: Value| {
            let mut scene = scene("red-lacquer", &json!({ "lights": [lamp] }));
            scene["floor"] = json!("red-lacquer");
            scene
        };
        let up = json!([1.0, 4.0, 1.5]);
        let lamps = [
            ("directional", json!({ "direction": up, "irradiance": LAMP })),
            ("point", json!({ "position": up, "irradiance": LAMP })),
            ("spot", json!({ "position": up, "irradiance": LAMP, "cone_deg": 14.0 })),
        ];
        let mut pictures = Vec::new();
        for (kind, mut lamp) in lamps {
            let open = self.picture(&bake, &lit(lamp.clone()), &format!("{kind}.png"));
            lamp["shadows"] = json!(true);
            let shadowed = self.picture(&bake, &lit(lamp), &format!("{kind}-shadow.png"));
            let count = |picture: &RgbImage| picture.pixels().filter(|pixel| bright(pixel) > 20).count();
            let dark = open
                .pixels()
                .zip(shadowed.pixels())
                .filter(|(open, shadowed)| bright(open) > bright(shadowed) + 10)
                .count();
            self.check(
                count(&open) > 1000 && dark > 300,
                format!("a {kind} lamp: {} pixels lit, {dark} of them in its shadow", count(&open)),
            );
            pictures.push(open);
        }
        let [_, point, spot] = pictures.as_slice() else { unreachable!() };
        let pairs = || point.pixels().zip(spot.pixels());
        let outside = pairs().filter(|(point, spot)| bright(point) > 10 && bright(spot) == 0).count();
        let other =
            pairs().filter(|(point, spot)| bright(spot) > 0 && bright(point).abs_diff(bright(spot)) > 1).count();
        let inside = pairs().filter(|(_, spot)| bright(spot) > 0).count();
        self.check(
            outside > 1000 && inside > 1000 && other * 20 < inside,
            format!("a spot is a lamp within its cone: {outside} pixels outside, {inside} inside, {other} of these differ by more than 1"),
        );

        let mut thick = scene("red-lacquer", &json!({ "lights": [{ "direction": up, "irradiance": LAMP }] }));
        thick["fog"] = json!(0.01);
        thick["background"] = json!([0.2, 0.3, 0.4]);
        let hidden = self.picture(&bake, &thick, "fog.png");
        let [first, ..] = hidden.pixels().map(|pixel| pixel.0).collect::<Vec<_>>()[..] else { unreachable!() };
        let most = hidden.pixels().flat_map(|pixel| (0..3).map(|c| pixel.0[c].abs_diff(first[c]))).max();
        self.check(most <= Some(1) && first[2] > 100, format!("thick fog has its colour: {most:?} off"));
    }

    /// The folder of a bake gets the files of another, whose material of the name is another.
    fn written_anew(&self) {
        let work = self.bake("anew", &["materials/red-lacquer.toml", "--no-fit"], "surface");
        let text = fs::read_to_string(self.root.join("materials/red-lacquer.toml")).unwrap();
        let green = swap_colours(&text);
        let file = self.at("green/red-lacquer.toml");
        fs::create_dir_all(self.out.join("green")).unwrap();
        fs::write(&file, green).unwrap();
        let other = self.bake("other", &[&file, "--no-fit"], "surface");
        let far = json!({ "lights": [{ "direction": [0.5, 0.7, 0.6], "irradiance": LAMP }] });
        let expected = self.picture(&other, &scene("red-lacquer", &far), "other.png");
        let (before, after) = (self.at("anew-before.png"), self.at("anew-after.png"));
        let output = self.show(&work, &scene("red-lacquer", &far), &[&before, &other, &after]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let (before, after) = (apart(&expected, &read(&before), true), apart(&expected, &read(&after), true));
        self.check(
            before.median > 5 && after.most <= 1,
            format!(
                "a bake that is written anew is shown: median {} of 255 off before, largest {} after",
                before.median, after.most
            ),
        );
    }

    /// Bakes that the loader refuses, and a word of the reason.
    fn refusals(&self) {
        let folder = self.at("refused");
        let gold = ["bake", "materials/polished-gold.toml", "--no-fit", "--quiet", "--form", "baked", "--out", &folder];
        let refused = |word: &str| {
            let output =
                self.show(&folder, &scene("polished-gold", &json!({ "lights": [] })), &[&self.at("refused.png")]);
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            let error = said.lines().rfind(|line| line.starts_with("error: ")).unwrap_or("nothing");
            self.check(!output.status.success() && error.contains(word), format!("a bake is refused: {error}"));
        };
        let bake = |options: &[&str]| {
            let _ = fs::remove_dir_all(&folder);
            self.luthier(&[&gold[..], options].concat());
        };
        bake(&["--target", "wgsl"]);
        refused("--functions surface");
        bake(&["--target", "glsl450", "--functions", "surface"]);
        refused("--target wgsl");
        bake(&["--target", "wgsl", "--functions", "surface", "--prefix", "gold"]);
        refused("without --prefix");
        bake(&["--target", "wgsl", "--functions", "surface"]);
        let manifest = self.at("refused/manifest.json");
        let text = fs::read_to_string(&manifest).unwrap();
        fs::write(&manifest, text.replacen("\"schema\": 4", "\"schema\": 5", 1)).unwrap();
        refused("schema");
        fs::write(&manifest, &text[1..]).unwrap();
        refused("manifest.json");
    }
}

/// The ball of `preview --shape sphere` with the camera 7 away, in light that may state more. Lamps have a size.
fn scene(material: &str, light: &Value) -> Value {
    let fov_y_deg = 2.0 * (1.22_f64 / 7.0).atan().to_degrees();
    let slope_variance = 0.05 * 0.05 / 8.0;
    let mut scene = json!({
        "size": 256, "fov_y_deg": fov_y_deg, "eye_distance": 7.0, "background": [0.0, 0.0, 0.0],
        "material": material, "slope_variance": slope_variance,
    });
    scene.as_object_mut().unwrap().extend(light.as_object().unwrap().clone());
    scene
}

/// The file with red and green exchanged in every list of three numbers.
fn swap_colours(text: &str) -> String {
    let swap = |line: &str| -> Option<String> {
        let (head, rest) = line.split_once('[')?;
        let (list, tail) = rest.split_once(']')?;
        let [r, g, b] = list.split(',').map(str::trim).collect::<Vec<_>>().try_into().ok()?;
        [r, g, b]
            .iter()
            .all(|number: &&str| number.parse::<f64>().is_ok())
            .then(|| format!("{head}[{g}, {r}, {b}]{tail}"))
    };
    text.lines().map(|line| swap(line).unwrap_or_else(|| line.to_owned()) + "\n").collect()
}

struct Apart {
    median: u8,
    p95: u8,
    p99: u8,
    most: u8,
    pixels: usize,
}

/// Differences of the channels that are farthest, of pixels that are lit in the second, or in either.
fn apart(a: &RgbImage, b: &RgbImage, in_either: bool) -> Apart {
    assert_eq!(a.dimensions(), b.dimensions());
    let lit = a.pixels().zip(b.pixels()).filter(|(p, q)| bright(q) > 0 || in_either && bright(p) > 0);
    let mut steps: Vec<u8> = lit.map(|(p, q)| (0..3).map(|c| p.0[c].abs_diff(q.0[c])).max().unwrap_or(0)).collect();
    steps.sort_unstable();
    let pixels = steps.len();
    assert!(pixels > 0, "both pictures are black");
    let at = |share: f64| steps[((share * pixels as f64) as usize).min(pixels - 1)];
    Apart { median: at(0.5), p95: at(0.95), p99: at(0.99), most: at(1.0), pixels }
}

fn bright(pixel: &image::Rgb<u8>) -> u16 {
    pixel.0.into_iter().max().unwrap_or(0).into()
}

fn read(png: &str) -> RgbImage {
    image::open(png).unwrap().to_rgb8()
}
