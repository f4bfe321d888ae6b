//! Tests of the painter on whatever adapter there is: pictures beside each other, and simulations that go on or begin anew.

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::Context;
use luthier::{Bake, MemoryStore};
use luthier_gpu::{Gpu, GpuError, Package, RenderSettings, Shape, ToneMapping};
use luthier_lut::Image;
use luthier_manifest::{Form, ShadingModel};
use luthier_material::Material;

use crate::host::{Differences, Host, MaterialFile, Screenshot};
use crate::look::Look;
use crate::orbit::Orbit;
use crate::work::baker::{Ready, Way};
use crate::work::painter::{PaintOrder, Painted, Painter};
use crate::work::view::View;

/// Far more than a busy machine needs.
const PATIENCE: Duration = Duration::from_secs(240);

/// A program that compares pictures, and does nothing else.
struct Comparer;

impl Host for Comparer {
    fn changed(&self) -> Option<Vec<MaterialFile>> {
        None
    }

    fn bake(&self, _: &Material, _: Form) -> Result<Package, String> {
        Err("no baker".to_owned())
    }

    fn simulated(&self, _: &Material) -> Result<Package, String> {
        Err("no baker".to_owned())
    }

    fn parsed(&self, _: &str, _: &str) -> Result<Material, String> {
        Err("no reader".to_owned())
    }

    fn compare(&self, a: &Image, b: &Image, _: ToneMapping) -> Option<Differences> {
        let squares: f64 = a.data.iter().zip(&b.data).map(|(a, b)| f64::from((a - b) * (a - b))).sum();
        Some(Differences { rms_err: (squares / a.data.len() as f64).sqrt(), flip_mean: 0.0 })
    }

    fn save(&self, _: &Screenshot, _: u32, _: bool) -> Result<String, String> {
        Err("no folder".to_owned())
    }
}

/// The device under test. Without an adapter, a test fails where the environment variable `CI` is set, and is skipped with a note elsewhere.
fn gpu() -> Option<Gpu> {
    match Gpu::open() {
        Ok(gpu) => Some(gpu),
        Err(error @ GpuError::NoAdapter) if std::env::var_os("CI").is_none() => {
            eprintln!("skipped: {error}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

fn package(film: &str, model: ShadingModel) -> Arc<Package> {
    let text = format!(
        "schema = 1\nname = \"m\"\n{film}[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.3\n\
         [[layer]]\ntype = \"diffuse\"\nalbedo = [0.6, 0.3, 0.1]\n\
         [bake]\ncolor = \"three-wavelengths\"\nfgd = {{ size = [8, 8] }}\ndistribution = {{ size = [32, 32] }}\n"
    );
    let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let mut material = luthier_material::parse("m.toml", &text, &no_files).unwrap().material;
    material.shade_by(model);
    Arc::new(Bake::lit().package(&[material], &MemoryStore::default()).unwrap())
}

/// A painter, and the orders to it.
struct Easel {
    painter: Painter,
    settings: RenderSettings,
    version: u64,
}

impl Easel {
    fn open() -> Option<Self> {
        let gpu = gpu()?;
        // The model, too.
        let mesh = RenderSettings::new(Shape::Mesh).unwrap().mesh;
        let settings = RenderSettings { mesh, ..RenderSettings::new(Shape::Sphere).unwrap() };
        let painter = Painter::start(Arc::new(Comparer), gpu, settings.clone(), Context::default()).unwrap();
        Some(Self { painter, settings, version: 0 })
    }

    fn view(&self) -> View {
        View {
            shape: Shape::Sphere,
            orbit: Orbit::of(Shape::Sphere),
            look: Look::of(&self.settings, ToneMapping::None),
            backdrop: [0.1; 3],
            size: [32, 24],
            samples: 1,
            environment_samples: 0,
            moving: false,
        }
    }

    /// Paints until nothing more follows; all that was seen on the way, at least the last.
    fn paint(&mut self, side: &Ready, other: Option<&Ready>, paths: u32, view: View) -> Vec<Painted> {
        self.version += 1;
        let (version, environment) = (self.version, Arc::clone(&self.settings.environment));
        let (side, other) = (side.clone(), other.cloned());
        self.painter.orders.put(PaintOrder { version, side, other, paths, environment, live: Arc::from([]), view });
        let (begin, mut seen) = (Instant::now(), Vec::new());
        loop {
            if let Some(painted) = self.painter.painted.take().filter(|painted| painted.version == version) {
                let finished = painted.finished;
                seen.push(painted);
                if finished {
                    return seen;
                }
            }
            assert!(begin.elapsed() < PATIENCE, "no picture after {PATIENCE:?}");
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}

/// The image of a side.
fn image(painted: &Painted, side: usize) -> Arc<Image> {
    Arc::clone(&painted.pictures[side].as_ref().unwrap().as_ref().unwrap().image)
}

fn shaded(package: &Arc<Package>, form: Form) -> Ready {
    Ready { package: Arc::clone(package), way: Way::Shader(form) }
}

#[test]
fn equal_sides_have_no_difference() {
    let Some(mut easel) = Easel::open() else { return };
    let elek = shaded(&package("", ShadingModel::Elek), Form::Baked);
    let view = easel.view();
    let seen = easel.paint(&elek, Some(&elek), 0, view);
    let last = seen.last().unwrap();
    assert_eq!(image(last, 0), image(last, 1));
    assert_eq!(last.differences.unwrap().rms_err, 0.0);
    assert_eq!((image(last, 0).width, image(last, 0).height), (32, 24));
    assert_eq!(last.progress, None);

    let other = shaded(&package("", ShadingModel::Microfacet), Form::Baked);
    let rms_err = easel.paint(&elek, Some(&other), 0, view).last().unwrap().differences.unwrap().rms_err;
    assert!(rms_err > 1e-3, "a model without the base differs: {rms_err}");
    // The forms of one model differ by the error of the tables alone.
    let full = shaded(&elek.package, Form::Full);
    let of_forms = easel.paint(&elek, Some(&full), 0, view).last().unwrap().differences.unwrap().rms_err;
    assert!(of_forms > 0.0 && of_forms < 0.5 * rms_err, "{of_forms} {rms_err}");
}

/// Samples count on while the material, the camera and the light stay, whatever the first side is; and from the beginning after a change.
#[test]
fn a_simulation_goes_on_until_something_changes() {
    let Some(mut easel) = Easel::open() else { return };
    let package = package("", ShadingModel::Elek);
    let simulated = Ready { package: Arc::clone(&package), way: Way::Simulation };
    let elek = shaded(&package, Form::Baked);
    let view = easel.view();
    let paths = |seen: &[Painted]| -> Vec<u32> {
        seen.iter().filter_map(|painted| painted.progress).map(|progress| progress.paths).collect()
    };

    let first = easel.paint(&elek, Some(&simulated), 16, view);
    let of_first = paths(&first);
    assert!(of_first.is_sorted() && of_first.last() == Some(&16), "{of_first:?}");
    let noise = |seen: &[Painted]| seen.last().unwrap().progress.unwrap().noise;
    assert!(noise(&first) > 0.0 && first.last().unwrap().differences.unwrap().rms_err > 0.0);

    // Another form, another tone curve: the reference goes on.
    let look = Look { tone: ToneMapping::Reinhard, ..view.look };
    let second = easel.paint(&shaded(&package, Form::Full), Some(&simulated), 64, View { look, ..view });
    let of_second = paths(&second);
    assert!(of_second.iter().all(|paths| *paths >= 16) && of_second.last() == Some(&64), "{of_second:?}");
    let ratio = noise(&first) / noise(&second);
    assert!((1.5..2.7).contains(&ratio), "four times the paths have half the noise: {ratio}");

    // Another light: from the beginning, with less in the sums than before.
    let look = Look { azimuth_deg: view.look.azimuth_deg + 90.0, ..view.look };
    let third = easel.paint(&elek, Some(&simulated), 8, View { look, ..view });
    let of_third = paths(&third);
    assert_eq!(of_third.last(), Some(&8), "{of_third:?}");
    assert!(image(third.last().unwrap(), 1) != image(first.last().unwrap(), 1));

    // Another material, of the same shader.
    let again = Ready { package: Arc::new((*package).clone()), way: Way::Simulation };
    let fourth = easel.paint(&elek, Some(&again), 4, View { look, ..view });
    assert_eq!(paths(&fourth).last(), Some(&4));
    // The order of random numbers is that of the samples, so that a new beginning gives the picture again.
    let fifth = easel.paint(&elek, Some(&simulated), 16, view);
    assert_eq!(image(fifth.last().unwrap(), 1), image(first.last().unwrap(), 1));
}

#[test]
fn refusals_leave_the_first_picture() {
    let Some(mut easel) = Easel::open() else { return };
    let film = "[[layer]]\ntype = \"thin-film\"\nior = 2.0\nthickness_nm = 300\n";
    let filmed = package(film, ShadingModel::Elek);
    let simulated = Ready { package: Arc::clone(&filmed), way: Way::Simulation };
    let elek = shaded(&filmed, Form::Baked);
    let view = easel.view();
    let of_model = View { shape: Shape::Mesh, orbit: Orbit::of(Shape::Mesh), ..view };
    for (view, reason) in [(view, "films"), (of_model, "triangles")] {
        let seen = easel.paint(&elek, Some(&simulated), 16, view);
        let last = seen.last().unwrap();
        assert!(image(last, 0).data.iter().any(|v| *v > 0.2));
        let problem = last.pictures[1].as_ref().unwrap().as_ref().unwrap_err();
        assert!(problem.contains(reason), "{problem}");
        assert_eq!((last.progress, last.differences), (None, None));
    }
}
