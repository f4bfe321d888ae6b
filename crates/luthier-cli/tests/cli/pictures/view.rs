//! The window, on a display without a screen.

use std::io::{BufRead, BufReader};
use std::os::unix::net::UnixStream;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, PoisonError};

use assert_cmd::cargo::cargo_bin;
use image::RgbImage;
use luthier_workshop::{Patience, Run};

use crate::workshop::Workshop;

const WINDOW: [u32; 2] = [700, 480];
/// Width of the panel at the right and, in [`STATUS`], height of the line at the bottom, in pixels.
const PANEL: u32 = 340;
const STATUS: u32 = 28;

/// A display of its own; it goes away with the test.
struct Display {
    server: Child,
    name: String,
}

impl Display {
    /// `None` where there is no server; on a build server there must be one.
    fn open() -> Option<Self> {
        for _ in 0..ATTEMPTS {
            let display = Self::start()?;
            let socket = format!("/tmp/.X11-unix/X{}", display.name.trim_start_matches(':'));
            if UnixStream::connect(socket).is_ok() {
                return Some(display);
            }
        }
        panic!("no server answers at its display");
    }

    fn start() -> Option<Self> {
        // Servers that start or end together may take the same number: they look for locks of others, and remove what was left behind.
        let _alone = STARTING.lock().unwrap_or_else(PoisonError::into_inner);
        // Without `-noreset` a server begins anew after its last client, and refuses the next one meanwhile.
        let arguments = ["-displayfd", "1", "-screen", "0", "1280x1024x24", "-nolisten", "tcp", "-noreset"];
        let started = Command::new("Xvfb").args(arguments).stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let Ok(mut server) = started else {
            assert!(std::env::var_os("CI").is_none(), "`Xvfb` is missing: install the package xvfb");
            eprintln!("skipped: `Xvfb` is not installed (Debian package xvfb)");
            return None;
        };
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        Some(Self { server, name: format!(":{}", number.trim()) })
    }
}

/// Held while a server starts or ends.
static STARTING: Mutex<()> = Mutex::new(());

/// Servers that are tried before a test fails.
const ATTEMPTS: u32 = 4;

impl Drop for Display {
    /// Asks the server to end, so that it takes its lock and its socket with it.
    fn drop(&mut self) {
        let _alone = STARTING.lock().unwrap_or_else(PoisonError::into_inner);
        let asked = Command::new("kill").arg(self.server.id().to_string()).status();
        if !asked.is_ok_and(|status| status.success()) {
            let _ = self.server.kill();
        }
        let _ = self.server.wait();
    }
}

/// `luthier view` at work; it ends with the test.
struct Window<'a> {
    workshop: &'a Workshop,
    process: Child,
}

impl<'a> Window<'a> {
    fn open(workshop: &'a Workshop, display: &Display, args: &[&str]) -> Self {
        let size = format!("{}x{}", WINDOW[0], WINDOW[1]);
        let process = Command::new(cargo_bin!("luthier"))
            .current_dir(workshop.path(""))
            .env("DISPLAY", &display.name)
            .env_remove("WAYLAND_DISPLAY")
            .args(["view", "--samples", "1", "--window", &size])
            .args(args)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        Self { workshop, process }
    }

    /// Waits for a screenshot. `None` for want of an adapter.
    fn shot(&mut self, name: &str) -> Option<RgbImage> {
        let path: PathBuf = self.workshop.path(name);
        let mut patience = Patience::with(self.process.id());
        while !path.exists() {
            if let Some(status) = self.process.try_wait().unwrap() {
                let mut stderr = String::new();
                std::io::Read::read_to_string(&mut self.process.stderr.take().unwrap(), &mut stderr).unwrap();
                // It may have written the file between the two looks.
                if status.success() && path.exists() {
                    break;
                }
                let run = Run::ended("view", status.code(), stderr);
                if run.lacks_adapter() {
                    return None;
                }
                panic!("no {name}: {status}\n{}", run.stderr);
            }
            patience.wait_for(name);
        }
        let picture = image::open(path).unwrap().into_rgb8();
        assert_eq!(picture.dimensions(), (WINDOW[0], WINDOW[1]));
        Some(picture)
    }

    /// Waits for the end, which is a good one.
    fn ends(&mut self) {
        assert_eq!(self.process.wait().unwrap().code(), Some(0));
    }
}

impl Drop for Window<'_> {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// A diffuse base under tables that are baked in a moment.
fn paint(albedo: &str) -> String {
    format!(
        "schema = 1\nname = \"paint\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.3\n\
         [[layer]]\ntype = \"diffuse\"\nalbedo = {albedo}\n\
         [bake]\ncolor = \"three-wavelengths\"\nfgd = {{ size = [8, 8] }}\ndistribution = {{ size = [32, 32] }}\n"
    )
}

fn part(picture: &RgbImage, [x, y, width, height]: [u32; 4]) -> RgbImage {
    image::imageops::crop_imm(picture, x, y, width, height).to_image()
}

/// The picture in the window.
fn view(window: &RgbImage) -> RgbImage {
    part(window, [0, 0, WINDOW[0] - PANEL, WINDOW[1] - STATUS])
}

fn colours(picture: &RgbImage) -> usize {
    picture.pixels().map(|p| p.0).collect::<std::collections::BTreeSet<_>>().len()
}

/// Mean of each channel, 0 to 255.
fn mean(picture: &RgbImage) -> [f64; 3] {
    let count = f64::from(picture.width() * picture.height());
    [0, 1, 2].map(|c| picture.pixels().map(|p| f64::from(p.0[c])).sum::<f64>() / count)
}

/// Pixels of the colour of errors, which is pure red in both themes.
fn alarms(picture: &RgbImage) -> usize {
    picture.pixels().filter(|p| p.0 == [255, 0, 0]).count()
}

#[test]
fn the_window_follows_its_file() {
    let Some(display) = Display::open() else { return };
    let workshop = Workshop::with(&[("paint.toml", &paint("[0.7, 0.05, 0.05]"))]);
    let args = ["paint.toml", "--theme", "dark", "--screenshot", "w.png", "--frames", "2", "--shots", "4"];
    let mut window = Window::open(&workshop, &display, &args);
    let Some(red) = window.shot("w.png") else { return };
    assert!(colours(&view(&red)) > 200, "a lit ball is not flat: {} colours", colours(&view(&red)));
    let panel = part(&red, [WINDOW[0] - PANEL, 0, PANEL, WINDOW[1]]);
    assert!(colours(&panel) > 30 && mean(&panel)[0] < 90.0, "text on dark: {} {:?}", colours(&panel), mean(&panel));
    let [r, g, b] = mean(&view(&red));
    assert!(r > g + 10.0 && r > b + 10.0, "{r} {g} {b}");

    workshop.write("paint.toml", paint("[0.05, 0.05, 0.7]"));
    let blue = window.shot("w-2.png").unwrap();
    let [r, g, b] = mean(&view(&blue));
    assert!(b > g + 10.0 && b > r + 10.0, "{r} {g} {b}");
    assert_eq!(alarms(&blue), 0);

    // The mistake is shown in the lower part; the picture above it stays.
    workshop.write("paint.toml", paint("[0.05, 0.05, 7.0]"));
    let broken = window.shot("w-3.png").unwrap();
    assert!(alarms(&broken) > 100, "a frame around the message: {}", alarms(&broken));
    let upper = |window: &RgbImage| part(window, [0, 0, WINDOW[0] - PANEL, 150]);
    assert!(upper(&broken) == upper(&blue));
    assert!(broken != blue);

    workshop.write("paint.toml", paint("[0.05, 0.05, 0.7]"));
    let mended = window.shot("w-4.png").unwrap();
    assert!(view(&mended) == view(&blue));
    window.ends();
}

#[test]
fn the_full_form_in_a_light_window() {
    let Some(display) = Display::open() else { return };
    let workshop = Workshop::with(&[("paint.toml", &paint("[0.05, 0.7, 0.05]"))]);
    let args = ["paint.toml", "--form", "full", "--shape", "torus", "--theme", "light", "--screenshot", "w.png"];
    let mut window = Window::open(&workshop, &display, &args);
    let Some(picture) = window.shot("w.png") else { return };
    assert!(colours(&view(&picture)) > 200);
    let [r, g, b] = mean(&view(&picture));
    assert!(g > r + 5.0 && g > b + 5.0, "{r} {g} {b}");
    assert!(mean(&part(&picture, [WINDOW[0] - PANEL, 0, PANEL, WINDOW[1]]))[0] > 200.0);
    window.ends();
}

/// A window of a file, its only screenshot. `None` for want of an adapter.
fn once(display: &Display, file: &str, args: &[&str]) -> Option<RgbImage> {
    let workshop = Workshop::with(&[("paint.toml", file)]);
    let common = ["paint.toml", "--theme", "dark", "--shape", "sphere", "--screenshot", "w.png"];
    let mut window = Window::open(&workshop, display, &[&common, args].concat());
    let picture = window.shot("w.png")?;
    window.ends();
    Some(picture)
}

/// The difference of a picture to itself is black; to another model it is not.
#[test]
fn differences_are_shown() {
    let Some(display) = Display::open() else { return };
    let file = paint("[0.7, 0.05, 0.05]");
    // The name of the difference is at the upper edge.
    let brightest = |window: &RgbImage| {
        let below = part(window, [0, 40, WINDOW[0] - PANEL, WINDOW[1] - STATUS - 40]);
        below.pixels().flat_map(|pixel| pixel.0).max().unwrap()
    };
    let args = ["--model", "elek", "--difference", "1024", "--against"];
    let Some(none) = once(&display, &file, &[&args[..], &["elek"]].concat()) else { return };
    assert_eq!(brightest(&none), 0);
    let some = once(&display, &file, &[&args[..], &["microfacet"]].concat()).unwrap();
    assert!(brightest(&some) > 200, "{}", brightest(&some));
    assert_eq!(alarms(&some), 0);
}

/// The first picture at the left of the divider, the simulated one at its right.
#[test]
fn a_simulation_beside_the_picture() {
    let Some(display) = Display::open() else { return };
    let file = paint("[0.7, 0.05, 0.05]");
    let args = ["--model", "lobes", "--environment-samples", "16"];
    let Some(alone) = once(&display, &file, &args) else { return };
    let beside = once(&display, &file, &[&args[..], &["--against", "simulated/8"]].concat()).unwrap();
    let middle = (WINDOW[0] - PANEL) / 2;
    let height = WINDOW[1] - STATUS - 60;
    let left = |window: &RgbImage| part(window, [0, 40, middle - 4, height]);
    let right = |window: &RgbImage| part(window, [middle + 4, 40, middle - 8, height]);
    assert!(left(&alone) == left(&beside), "the first picture is as without a second");
    assert!(right(&alone) != right(&beside));
    // Both are pictures of the same ball, one with the noise of eight paths; elek would be 12 brighter.
    let (model, simulated) = (mean(&right(&alone)), mean(&right(&beside)));
    assert!((0..3).all(|c| (model[c] - simulated[c]).abs() < 5.0), "{model:?} {simulated:?}");
    assert_eq!(alarms(&beside), 0);
}

/// A material that the simulation does not take has its picture, and the panel says why there is no second.
#[test]
fn a_film_is_not_simulated() {
    let Some(display) = Display::open() else { return };
    let film = "[[layer]]\ntype = \"thin-film\"\nior = 2.0\nthickness_nm = 300\n";
    let file = paint("0.5").replacen("[[layer]]", &format!("{film}[[layer]]"), 1);
    let args = ["--environment-samples", "16"];
    let Some(alone) = once(&display, &file, &args) else { return };
    let refused = once(&display, &file, &[&args[..], &["--against", "simulated"]].concat()).unwrap();
    assert!(view(&alone) == view(&refused), "one picture, without a divider");
    let panel = |window: &RgbImage| part(window, [WINDOW[0] - PANEL, 0, PANEL, WINDOW[1]]);
    // The reason has the colour of warnings, which nothing else has.
    let orange = |window: &RgbImage| panel(window).pixels().filter(|p| p.0 == [255, 143, 0]).count();
    assert!(orange(&alone) == 0 && orange(&refused) > 20, "{} {}", orange(&alone), orange(&refused));
}

/// A file that was never a material: there is no picture to keep.
#[test]
fn a_window_may_begin_with_a_mistake() {
    let Some(display) = Display::open() else { return };
    let workshop = Workshop::with(&[("paint.toml", "schema = 1\nname = \"paint\"\n")]);
    let mut window = Window::open(&workshop, &display, &["paint.toml", "--screenshot", "w.png"]);
    let Some(picture) = window.shot("w.png") else { return };
    assert!(alarms(&picture) > 100);
    window.ends();
}

#[test]
fn without_a_display() {
    let workshop = Workshop::with(&[("paint.toml", &paint("0.5"))]);
    let output = Command::new(cargo_bin!("luthier"))
        .current_dir(workshop.path(""))
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .args(["view", "paint.toml"])
        .output()
        .unwrap();
    let run = Run::ended("view paint.toml", output.status.code(), String::from_utf8(output.stderr).unwrap());
    if run.lacks_adapter() {
        return;
    }
    run.fails(4, &["cannot open a window", "xvfb-run", "apt-get install"]);
}

#[test]
fn windows_that_cannot_be() {
    let workshop = Workshop::with(&[("paint.toml", &paint("0.5"))]);
    workshop.run(&["view", "missing.toml"]).fails(3, &["missing.toml"]);
    workshop.run(&["view", "paint.toml", "--shape", "grid"]).fails(1, &["grid"]);
    workshop.run(&["view", "paint.toml", "--screenshot", "w.exr"]).fails(1, &["w.exr", ".png"]);
    workshop.run(&["view", "paint.toml", "--window", "10x10"]).fails(2, &["--window"]);
    workshop.run(&["view", "paint.toml", "--frames", "3"]).fails(2, &["required"]);
    workshop.run(&["view", "paint.toml", "--difference", "3"]).fails(2, &["required"]);
    workshop.run(&["view", "paint.toml", "--against", "simulated/0"]).fails(2, &["simulated/N"]);
}
