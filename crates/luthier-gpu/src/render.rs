//! Rendering of a shape under lights and an environment, in passes of bounded length.

use luthier_manifest::{Distribution, Form};
use luthier_mesh::{Mesh, model};
use std::sync::Arc;

use luthier_environment::{ALPHAS, Blur, Environment};
use luthier_lut::{Image, TableKind};
use luthier_manifest::{LayerKind, LayerRecord, MaterialEntry, material_buffer};

use crate::context::{Pass, word};
use crate::error::setting;
use crate::floor::Grounded;
use crate::mesh;
use crate::surroundings::Surroundings;
use crate::{Camera, GpuError, Light, Scene, Shape, Shown, Sky};

/// Evaluations per submission: about a second on a software adapter.
const EVALUATIONS_PER_PASS: u32 = 1 << 21;

/// Evaluations per submission of a watched rendering, whose caller waits for the pass to end.
const EVALUATIONS_PER_SHORT_PASS: u32 = 1 << 18;

/// Side of a workgroup, pixels.
pub(crate) const PIXELS_PER_WORKGROUP: u32 = 8;

/// `vec4` words before `words` in `picture.wgsl`.
pub(crate) const HEADER_WORDS: usize = 9;

/// Turns of loops that one thread makes in a submission, by a generous count. Software adapters silently end loops after 65,535 turns in all;
/// half of that leaves room for an error of the count.
const TURNS_PER_PASS: u32 = 1 << 15;

/// Turns of a ray through a mesh: at most a few hundred, even with a million triangles.
const RAY_TURNS: u32 = 256;

/// Background behind the shape. It does not light the shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Backdrop {
    /// A colour in the middle that darkens towards the corners.
    Plain([f32; 3]),
    /// The environment itself.
    Environment,
}

/// Lighting and view of a shape. Radiance and irradiance are linear RGB in the same arbitrary unit; +y is up, +z points
/// to the eye.
///
/// ```
/// use luthier_gpu::{RenderSettings, Shape};
///
/// let settings = RenderSettings { size: 64, ..RenderSettings::new(Shape::Torus)? };
/// assert_eq!(settings.camera, Shape::Torus.camera());
/// // Only the shape `mesh` needs triangles.
/// assert!(settings.mesh.is_none() && RenderSettings::new(Shape::Mesh)?.mesh.is_some());
/// # Ok::<(), luthier_gpu::GpuError>(())
/// ```
#[derive(Debug, Clone)]
pub struct RenderSettings {
    /// Side of the picture in pixels, 1 to 4096.
    pub size: u32,
    /// Samples along each side of a pixel, 1 to 16: the middles of equal squares.
    pub samples: u32,
    /// Shape that is rendered.
    pub shape: Shape,
    /// Triangles of [`Shape::Mesh`]; [`RenderSettings::new`] takes [`luthier_mesh::model`].
    pub mesh: Option<Arc<Mesh>>,
    /// Camera that sees the shape.
    pub camera: Camera,
    /// Lights without a body, at most 64. Meshes alone cast shadows.
    pub lights: Vec<Light>,
    /// Angular radius of the lights in radians, 0 to 0.5. For them, the squares of all slope parameters grow by the square
    /// of half of it, so that the highlight of a smooth surface has a size; the reflected energy stays the same.
    pub light_angular_radius: f32,
    /// Light from all around.
    pub environment: Arc<Environment>,
    /// 0 reads maps that were blurred beforehand. 1 to 4096 evaluates the shader for light from that many directions of the environment, per lobe of
    /// the material and sample of the pixel: slow and noisy, but without any other error. `luthier_sample` draws the directions for the place. A
    /// shader without it (`functions` of a bake) draws from the slopes of layer records, with the roughness and the normal of the place.
    pub environment_samples: u32,
    /// Slopes, along the tangent and the bitangent, of the inner boundary of films against the outer one, on top of those
    /// that follow from a varying thickness (Granier and Heidrich 2003, section 7.2). Models without a second boundary ignore it, and so do
    /// sets of materials in which nothing varies.
    pub film_tilt: [f32; 2],
    /// Behind the shape.
    pub backdrop: Backdrop,
    /// Factor on the whole picture. At 1 and with the default lights, the brightest part of a white Lambertian ball is
    /// between 0.9 and 1.
    pub exposure: f32,
}

impl RenderSettings {
    /// The defaults for a shape: its camera, one light from the left, the studio of [`Sky::default`].
    ///
    /// # Errors
    /// Never with the default sky; [`Environment::sky`] can fail with others.
    pub fn new(shape: Shape) -> Result<Self, GpuError> {
        Ok(Self {
            size: 512,
            samples: 4,
            shape,
            mesh: (shape == Shape::Mesh).then(|| Arc::new(model::mesh())),
            camera: shape.camera(),
            lights: vec![Light::Directional { direction: [-0.45, 0.7, 0.6], irradiance: [1.75, 1.7, 1.62] }],
            light_angular_radius: 0.05,
            environment: Arc::new(Environment::sky(&Sky::default())?),
            environment_samples: 0,
            film_tilt: [0.0; 2],
            backdrop: Backdrop::Plain([0.13, 0.13, 0.133]),
            exposure: 1.0,
        })
    }
}

impl Scene {
    /// Renders a shape, one material for each of its parts ([`Shape::materials`]): linear RGB, `settings.size` squared, not
    /// tone mapped; highlights exceed 1.
    ///
    /// `luthier_eval` shades lights, and also the environment if `environment_samples` is set. Otherwise the reflection of the environment is split in
    /// two factors (Karis 2013). Each interface reflects its albedo (from the FGD table if the layer has a tile, else Fresnel) times the environment
    /// around the mirrored direction, blurred by the lobe of the surface at normal incidence. A diffuse base reflects its albedo times irradiance / pi.
    /// Layers above attenuate both by Fresnel transmission, and by absorption along the refracted directions.
    ///
    /// The split simplifies: the lobe does not stretch towards grazing angles, the base counts as Lambert, light from everywhere enters at its mean
    /// cosine 2/3, nothing bounces between layers. It also differs from `luthier_eval` in energy. The albedo holds all bounces within one interface,
    /// `luthier_eval` only the first. Below a coat `luthier_eval` spreads a lobe over eta^2 the solid angle without dimming it (Weidlich and Wilkie's
    /// eq. 3.1 lacks 1 / eta^2); the split conserves energy.
    ///
    /// A material of the model `lobes` uses the energies of its rows: `luthier_environment` of the emitted shader reads cubes that were blurred
    /// beforehand, and the samples of a pixel turn its directions. `docs/pages/environment.md` has its errors.
    ///
    /// # Errors
    /// [`GpuError::Prefiltered`] for another form than `baked` without samples, [`GpuError::NoReflectance`] for a material without
    /// the tables that this takes, [`GpuError::LayerMaps`] for one with maps of single layers, [`GpuError::Setting`], [`GpuError::NoMaterial`], and whatever the device reports.
    pub fn render(&self, materials: &[u32], settings: &RenderSettings) -> Result<Image, GpuError> {
        self.render_shown(&parts(materials), settings)
    }

    /// Renders as [`Scene::render`] does; parts may be surfaces. Particles of a surface turn the frame as a normal map does.
    ///
    /// # Errors
    /// As [`Scene::render`], and [`GpuError::NoSurface`].
    pub fn render_shown(&self, parts: &[Shown], settings: &RenderSettings) -> Result<Image, GpuError> {
        let image = self.render_passes(parts, settings, &|_, _| true, EVALUATIONS_PER_PASS * self.context.batch)?;
        Ok(image.expect("nobody stops it"))
    }

    /// Renders as [`Scene::render_shown`] does, in short passes that can be watched. Before every pass, `goes_on` gets the number of passes done and of
    /// all; the result is `None` if it returns false. A pass takes a fraction of a second on a software adapter, unless the mesh is large.
    ///
    /// # Errors
    /// As [`Scene::render_shown`].
    pub fn render_watched(
        &self,
        parts: &[Shown],
        settings: &RenderSettings,
        goes_on: &dyn Fn(usize, usize) -> bool,
    ) -> Result<Option<Image>, GpuError> {
        self.render_passes(parts, settings, goes_on, EVALUATIONS_PER_SHORT_PASS * self.context.batch)
    }

    /// Whether the bake has the albedo of every interface of a material, which [`Scene::render`] needs without samples of the environment. A bake has
    /// these tables if its shader reads them, or if they were requested.
    ///
    /// # Errors
    /// [`GpuError::NoMaterial`].
    pub fn has_albedo(&self, material: u32) -> Result<bool, GpuError> {
        self.layers(material)?;
        if self.manifest.materials[material as usize].shows_lobes() {
            return Ok(self.bindings.has_surroundings());
        }
        Ok(self.interfaces(material).all(|layer| {
            let has_albedo = layer.tiles[TableKind::Fgd].is_some() || layer.tiles[TableKind::Film].is_some();
            has_reflectance(layer) && has_albedo
        }))
    }

    /// Whether a mesh has the texture coordinates that the materials need.
    fn check_coordinates(&self, parts: &[Shown], materials: &[u32], settings: &RenderSettings) -> Result<(), GpuError> {
        let lacks_uv = settings.mesh.as_ref().is_some_and(|mesh| settings.shape == Shape::Mesh && !mesh.has_uv());
        let is_surface = parts.iter().any(|part| matches!(part, Shown::Surface(_)));
        for entry in materials.iter().filter(|_| lacks_uv).map(|&i| &self.manifest.materials[i as usize]) {
            let is_anisotropic = entry.records().any(|layer| layer.alpha_xy[0] != layer.alpha_xy[1]);
            let reason = match (is_surface, entry.varies(), is_anisotropic) {
                (true, ..) => "it is of a surface",
                (_, true, _) => "it varies from place to place",
                (_, _, true) => "it is anisotropic, and its tangents follow them",
                _ => continue,
            };
            return Err(GpuError::NoTextureCoordinates { material: entry.name.clone(), reason });
        }
        Ok(())
    }

    /// The interfaces whose reflectance the blurred environment takes from tables.
    fn interfaces(&self, material: u32) -> impl Iterator<Item = &LayerRecord> {
        let entry = self.manifest.materials.get(material as usize);
        let entry = entry.into_iter().filter(|entry| !entry.shows_lobes());
        entry.flat_map(MaterialEntry::records).filter(|layer| layer.kind != LayerKind::Diffuse)
    }

    /// Renders as [`Scene::render`] does, unless `stop` returns true: then the result is `None`. It is asked before every pass; a pass takes a fraction
    /// of a second on a software adapter.
    ///
    /// # Errors
    /// As [`Scene::render`].
    pub fn render_unless(
        &self,
        materials: &[u32],
        settings: &RenderSettings,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<Image>, GpuError> {
        self.render_watched(&parts(materials), settings, &|_, _| !stop())
    }

    /// The surroundings of the shown part, with the floor of its mesh in them: blurred maps have no rays that could meet a floor. They are kept for
    /// the next picture.
    fn grounded(&self, settings: &RenderSettings) -> Result<Arc<Environment>, GpuError> {
        let RenderSettings { environment, lights, mesh, .. } = settings;
        let Some(mesh) = mesh else { return Ok(Arc::clone(environment)) };
        let mut kept = self.grounded.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if !kept.as_ref().is_some_and(|kept| kept.is_of(environment, lights, mesh)) {
            *kept = Grounded::new(environment, lights, mesh)?;
        }
        Ok(Arc::clone(kept.as_ref().map_or(environment, |kept| &kept.environment)))
    }

    fn render_passes(
        &self,
        parts: &[Shown],
        settings: &RenderSettings,
        goes_on: &dyn Fn(usize, usize) -> bool,
        evaluations: u32,
    ) -> Result<Option<Image>, GpuError> {
        settings.check(parts)?;
        let materials = &self.materials_of(parts)?;
        self.check_coordinates(parts, materials, settings)?;
        if self.form() != Form::Baked && settings.environment_samples == 0 {
            return Err(GpuError::Prefiltered { form: self.form() });
        }
        let prefiltered = materials.iter().filter(|_| settings.environment_samples == 0);
        for &material in prefiltered.clone() {
            let entry = &self.manifest.materials[material as usize];
            let hides = !self.bindings.has_surroundings() && entry.shows_lobes();
            if hides || !self.interfaces(material).all(has_reflectance) {
                return Err(GpuError::NoReflectance { material: entry.name.clone() });
            }
        }
        for &material in prefiltered {
            if self.has_layer_maps(material)? {
                let material = self.manifest.materials[material as usize].name.clone();
                return Err(GpuError::LayerMaps { material });
            }
        }
        let mut settings = settings.clone();
        if settings.environment_samples == 0 && settings.shape == Shape::Mesh {
            settings.environment = self.grounded(&settings)?;
        }
        let settings = &settings;
        let surroundings = if self.bindings.has_surroundings() && settings.environment_samples == 0 {
            Surroundings::new(&self.context, &settings.environment)?
        } else {
            Surroundings::black(&self.context)?
        };
        let words = self.widened_words(settings.light_angular_radius);
        let group = self.bindings.group(&self.context, &words, &surroundings)?;
        let is_drawn = settings.environment_samples > 0;
        let cell = &self.render[usize::from(settings.shape == Shape::Mesh)][usize::from(is_drawn)];
        let pipeline = self.pipeline(cell, &self.render_kernel(settings.shape, is_drawn))?;
        let mut inputs = self.inputs(parts, materials, settings);

        let size = settings.size;
        let lobes = 1 + self.manifest.materials.iter().map(|m| m.layers.len()).max().unwrap_or(0) as u32;
        let shares = shares(settings, lobes);
        let per_pixel =
            shares.iter().map(|[_, samples, _, directions]| samples * (1 + directions * lobes)).max().unwrap_or(1);
        // Rays through a mesh take longer than evaluations, and the ratio differs between GPUs: a pass with rays is equally small on all adapters.
        let cost = if settings.shape == Shape::Mesh { 4 * self.context.batch } else { 1 };
        let rows = (evaluations / size.saturating_mul(per_pixel).saturating_mul(cost).max(1)).clamp(1, size);
        let mut data = vec![0.0; (size * size * 3) as usize];
        let blocks = (0..size).step_by(rows as usize).flat_map(|row| shares.iter().map(move |share| (row, *share)));
        let count = size.div_ceil(rows) as usize * shares.len();
        for (done, (row, share)) in blocks.enumerate() {
            if !goes_on(done, count) {
                return Ok(None);
            }
            let rows = rows.min(size - row);
            inputs[5][1] = row;
            inputs[HEADER_WORDS - 1] = share;
            let pixels = self.context.run(&Pass {
                what: "rendering",
                pipeline,
                shader_group: &group,
                workgroups: [size.div_ceil(PIXELS_PER_WORKGROUP), rows.div_ceil(PIXELS_PER_WORKGROUP)],
                inputs: bytemuck::cast_slice(&inputs),
                output_words: (size * rows) as usize,
            })?;
            let block = &mut data[(row * size * 3) as usize..];
            for (sum, value) in block.iter_mut().zip(pixels.iter().flat_map(|pixel| &pixel[..3])) {
                *sum += value;
            }
        }
        Ok(Some(Image { width: size, height: size, channels: 3, data }))
    }

    /// The material buffer: all materials, then all again with slopes widened by the lights.
    pub(crate) fn widened_words(&self, angular_radius: f32) -> Vec<[f32; 4]> {
        let mut materials = self.manifest.materials.clone();
        materials.extend(self.manifest.materials.iter().map(|m| m.widened(angular_radius.into())));
        material_buffer(&materials)
    }

    /// The kernel, by directions of the environment or by its blurred maps.
    fn render_kernel(&self, shape: Shape, is_drawn: bool) -> String {
        let [rays, shading, around, render] =
            mesh::kernel(shape, &if is_drawn { self.drawn_around() } else { self.prefiltered_around() });
        [
            &rays,
            include_str!("wgsl/environment.wgsl"),
            &shading,
            &around,
            include_str!("wgsl/picture.wgsl"),
            &render,
            &self.surface_functions(),
            self.pick_function(),
        ]
        .join("\n")
    }

    /// WGSL that samples the environment: in directions that the shader draws, or, if it has no such functions, from the slopes of layer records.
    fn drawn_around(&self) -> String {
        if !self.interface.calls("luthier_sample") {
            return include_str!("wgsl/around/by_records.wgsl").to_owned();
        }
        let prepared = match self.has_places() {
            true => "luthier_prepare_at(surface, material, wo)",
            false => "luthier_prepare(material, wo)",
        };
        // A fluorescent base moves light between channels, so its value is no factor per channel times the light.
        let reflected = match self.interface.calls("luthier_light_lit") {
            true => "luthier_light_lit(prepared, wi, $radiance) / drawn.pdf",
            false => "drawn.weight * $radiance",
        };
        include_str!("wgsl/around/drawn.wgsl").replace("$prepared", prepared).replace("$reflected", reflected)
    }

    /// WGSL that reads the blurred maps of the environment, with the look-ups that the shader has. Missing look-ups give black: a set of diffuse bases
    /// has no Fresnel table and needs none.
    fn prefiltered_around(&self) -> String {
        let [fresnel, fgd, film] = [
            (TableKind::Fresnel, "luthier_lookup_fresnel(tile, cos_theta)"),
            (TableKind::Fgd, "luthier_lookup_fgd(tile, cos_theta, alpha).rgb"),
            (TableKind::Film, "luthier_lookup_film(tile, cos_theta, fraction)"),
        ]
        .map(|(kind, call)| if self.reads(kind) { call } else { "vec3<f32>(0.0)" });
        let has_lobes = self.manifest.materials.iter().any(MaterialEntry::shows_lobes);
        let shown = if self.bindings.has_surroundings() && has_lobes {
            let place = if self.has_places() { "surface, " } else { "" };
            format!(
                "luthier_environment_lobes(luthier_prepare_lobes({place}material, vec3<f32>(wo.xy, max(wo.z, 1e-4))), frame, turn)"
            )
        } else {
            "vec3<f32>(0.0)".to_owned()
        };
        let look_ups = format!(
            "fn shading_fresnel(tile: f32, cos_theta: f32) -> vec3<f32> {{\n    return {fresnel};\n}}\n\
             fn shading_fgd(tile: f32, cos_theta: f32, alpha: f32) -> vec3<f32> {{\n    return {fgd};\n}}\n\
             fn shading_film(tile: f32, cos_theta: f32, fraction: f32) -> vec3<f32> {{\n    return {film};\n}}\n\
             fn lobes_environment(\n    material: u32, surface: ShadingSurface, frame: mat3x3<f32>, wo: vec3<f32>, turn: f32,\n\
             ) -> vec3<f32> {{\n    return {shown};\n}}\n"
        );
        [include_str!("wgsl/around/prefiltered.wgsl"), &look_ups].join("\n")
    }

    /// The words of `Render` in `picture.wgsl`.
    pub(crate) fn inputs(&self, parts: &[Shown], materials: &[u32], settings: &RenderSettings) -> Vec<[u32; 4]> {
        let used = self.blurs();
        let mut words: Vec<[u32; 4]> = parts.iter().map(|part| part.word()).collect();
        let lights = words.len();
        words.extend(settings.lights.iter().flat_map(Light::words).map(bits));

        let headers = words.len();
        let entries = &self.manifest.materials;
        let mut first = headers + entries.len();
        for entry in entries {
            words.push([
                first as u32,
                entry.layers.len() as u32,
                0,
                f32::from(u8::from(entry.shows_lobes())).to_bits(),
            ]);
            first += entry.records().count() * 4;
        }
        for layer in entries.iter().flat_map(MaterialEntry::records) {
            // Maps: the environment, irradiance, then a chain for each distribution in use.
            words.extend(layer_words(layer, first_map(&used, blur_of(layer)) as f32).map(bits));
        }
        let halvings = self.halvings(materials);
        for (i, entry) in entries.iter().enumerate() {
            let first = words.len();
            words[headers + i][2] = first as u32;
            let used = materials.contains(&(i as u32));
            words.extend(if used { self.map_words(i, entry, first, &halvings) } else { self.no_map_words() });
        }

        let prefiltered = settings.environment_samples == 0;
        let environment = &settings.environment;
        let mut maps = vec![environment.map()];
        if prefiltered || settings.shape == Shape::Mesh {
            maps.push(environment.irradiance_map());
        }
        if prefiltered {
            maps.extend(used.iter().flat_map(|&blur| environment.chain(blur)));
        }
        let map_headers = words.len();
        let mut first = map_headers + maps.len();
        for map in &maps {
            words.push([first as u32, map.width, map.height, 0]);
            first += map.texel_count();
        }
        for map in &maps {
            words.extend(map.texels().map(|t| bits([t[0], t[1], t[2], 0.0])));
        }
        if let Some(mesh) = settings.mesh.as_deref().filter(|_| settings.shape == Shape::Mesh) {
            let first = words.len();
            words[0][2] = first as u32;
            words.extend(mesh::words(mesh, settings.light_angular_radius, first));
        }
        let starts = [lights, headers, map_headers].map(|at| at as u32);
        let mut inputs = self.header(settings, starts);
        inputs.extend(words);
        inputs
    }

    fn header(&self, settings: &RenderSettings, [lights, headers, maps]: [u32; 3]) -> Vec<[u32; 4]> {
        let [mut eye, mut target, right, up] = settings.camera.words();
        let (backdrop, behind) = match settings.backdrop {
            Backdrop::Plain(color) => (color, 0.0),
            Backdrop::Environment => ([0.0; 3], 1.0),
        };
        (eye[3], target[3]) = (settings.exposure, behind);
        let [r, g, b] = backdrop.map(f32::to_bits);
        let header: [[u32; 4]; HEADER_WORDS] = [
            bits(eye),
            bits(target),
            bits(right),
            bits(up),
            [r, g, b, settings.size],
            [settings.samples, 0, settings.shape.number(), settings.environment_samples],
            [settings.lights.len() as u32, self.manifest.materials.len() as u32, 0, lights],
            [headers, maps, settings.film_tilt[0].to_bits(), settings.film_tilt[1].to_bits()],
            // Every pass writes its share of samples here.
            [0; 4],
        ];
        header.to_vec()
    }

    /// The slope distributions of all layers, in the order of their chains.
    fn blurs(&self) -> Vec<Blur> {
        let materials = self.manifest.materials.iter().filter(|m| !m.shows_lobes());
        let layers = materials.flat_map(MaterialEntry::records).filter(|l| l.kind != LayerKind::Diffuse);
        let used: Vec<Blur> = layers.map(blur_of).collect();
        [Blur::Ggx, Blur::Beckmann].into_iter().filter(|blur| used.contains(blur)).collect()
    }
}

/// Shares of the samples of a pixel and of their directions, one for each submission: first sample, number of samples, first direction, number of
/// directions. `lobes` counts those of a material, and the cosine as one.
fn shares(settings: &RenderSettings, lobes: u32) -> Vec<[u32; 4]> {
    let (samples, directions) = (settings.samples * settings.samples, settings.environment_samples);
    // Turns for the boxes and triangles that a ray passes.
    let ray = if settings.shape == Shape::Mesh { RAY_TURNS } else { 0 };
    let lights = settings.lights.len() as u32;
    // For each direction: the densities of all lobes, the loops of an evaluation, and rays. A place that a ray meets may look at all lights.
    let per_direction = lobes * (16 + lobes * lobes) + lobes * ray * (1 + lights);
    let per_sample = directions.saturating_mul(per_direction).saturating_add(256 + ray * (2 + lights));
    if per_sample <= TURNS_PER_PASS {
        let most = TURNS_PER_PASS / per_sample;
        return (0..samples)
            .step_by(most as usize)
            .map(|first| [first, most.min(samples - first), 0, directions])
            .collect();
    }
    let most = (TURNS_PER_PASS / per_direction).max(1);
    let parts = (0..directions).step_by(most as usize).map(|first| (first, most.min(directions - first)));
    (0..samples).flat_map(|sample| parts.clone().map(move |(first, count)| [sample, 1, first, count])).collect()
}

/// Parts that show these materials.
fn parts(materials: &[u32]) -> Vec<Shown> {
    materials.iter().copied().map(Shown::Material).collect()
}

/// Number of the first map that is blurred by a slope distribution. Maps 0 and 1 are the environment and its irradiance; the chains of the used
/// distributions follow.
fn first_map(used: &[Blur], blur: Blur) -> u32 {
    2 + (used.iter().position(|other| *other == blur).unwrap_or(0) * ALPHAS.len()) as u32
}

fn has_reflectance(layer: &LayerRecord) -> bool {
    layer.tiles[TableKind::Fresnel].is_some() || layer.tiles[TableKind::Film].is_some()
}

fn blur_of(layer: &LayerRecord) -> Blur {
    match layer.distribution {
        Distribution::Ggx | Distribution::Abc(_) => Blur::Ggx,
        // Blinn's distribution is near Beckmann's; the shifted gamma distribution falls like Beckmann's far from the normal.
        Distribution::Beckmann | Distribution::Blinn | Distribution::Sgd(_) => Blur::Beckmann,
    }
}

fn bits(word: [f32; 4]) -> [u32; 4] {
    word.map(f32::to_bits)
}

/// The words of `ShadingLayer` in `shading.wgsl`.
fn layer_words(layer: &LayerRecord, chain: f32) -> [[f32; 4]; 4] {
    let kind = match layer.kind {
        LayerKind::Dielectric => 0.0,
        LayerKind::Conductor => 1.0,
        LayerKind::Diffuse => 2.0,
    };
    let [fresnel, fgd, film] = [TableKind::Fresnel, TableKind::Fgd, TableKind::Film]
        .map(|kind| layer.tiles[kind].map_or(-1.0, |tile| tile as f32));
    // Layers without a film divide 0 by the guard.
    let film_fraction = layer.film_thickness_nm / layer.film_thickness_max_nm.max(1e-30);
    [
        [kind, layer.alpha as f32, layer.eta as f32, chain],
        [fresnel, fgd, film, film_fraction as f32],
        word(layer.optical_depth.map(|v| v as f32), layer.critical_cot_sq as f32),
        word(layer.albedo.map(|v| v as f32), 0.0),
    ]
}

impl RenderSettings {
    pub(crate) fn check(&self, parts: &[Shown]) -> Result<(), GpuError> {
        let of_mesh = self.mesh.as_ref().filter(|_| self.shape == Shape::Mesh).map(|mesh| mesh.materials());
        if parts.len() != of_mesh.unwrap_or(self.shape.materials()) {
            return Err(setting("materials", parts.len().to_string(), "one for each part of the shape"));
        }
        if self.shape == Shape::Mesh && self.mesh.is_none() {
            return Err(setting("mesh", "None".to_owned(), "the shape `mesh` needs one"));
        }
        if !(1..=4096).contains(&self.size) {
            return Err(setting("size", self.size.to_string(), "1 to 4096 pixels"));
        }
        if !(1..=16).contains(&self.samples) {
            return Err(setting("samples", self.samples.to_string(), "1 to 16 along a side of a pixel"));
        }
        if self.environment_samples > 4096 {
            return Err(setting("environment_samples", self.environment_samples.to_string(), "0 to 4096"));
        }
        if !self.film_tilt.iter().all(|slope| slope.is_finite()) {
            return Err(setting("film_tilt", format!("{:?}", self.film_tilt), "finite slopes"));
        }
        if self.lights.len() > 64 {
            return Err(setting("lights", self.lights.len().to_string(), "at most 64"));
        }
        if !(0.0..=0.5).contains(&self.light_angular_radius) {
            return Err(setting("light_angular_radius", self.light_angular_radius.to_string(), "0 to 0.5 radians"));
        }
        let backdrop = match self.backdrop {
            Backdrop::Plain(color) => color,
            Backdrop::Environment => [0.0; 3],
        };
        for value in backdrop.into_iter().chain([self.exposure]) {
            if !value.is_finite() || value < 0.0 {
                return Err(setting("backdrop or exposure", value.to_string(), "finite and not negative"));
            }
        }
        self.lights.iter().try_for_each(Light::check)?;
        self.camera.check()
    }
}
