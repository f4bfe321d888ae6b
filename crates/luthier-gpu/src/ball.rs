use luthier_lut::{Image, LayerRecord, MaterialEntry, TableKind, material_buffer};

use crate::context::Pass;
use crate::sky::{check_direction, setting};
use crate::{GpuError, Scene, Sky};

/// Distance from the eye to the centre of the ball, in its radii: a long lens.
const EYE: f32 = 7.0;

/// Half the side of the picture in the plane through the centre, in radii of the ball.
const HALF_EXTENT: f32 = 1.22;

/// Samples per submission: below a second on a software adapter.
const SAMPLES_PER_PASS: u32 = 1 << 21;

/// Side of a workgroup, pixels.
const WORKGROUP: u32 = 8;

/// How a preview ball is lit and seen. Radiance and irradiance are linear RGB in the same arbitrary unit; +y is up,
/// +z points to the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BallSettings {
    /// Side of the picture in pixels, 1 to 4096.
    pub size: u32,
    /// Samples along each side of a pixel, 1 to 16.
    pub samples: u32,
    /// To the light; need not be unit.
    pub light_direction: [f32; 3],
    /// What the light gives to a patch that faces it.
    pub light_irradiance: [f32; 3],
    /// Angular radius of the light in radians, 0 to 0.5. The squares of all slope parameters grow by the square of half
    /// of it, so that the highlight of a smooth surface has a size; the reflected energy stays the same.
    pub light_angular_radius: f32,
    /// Everything else that shines.
    pub sky: Sky,
    /// Behind the ball, in the middle; it darkens towards the corners and is not part of the light.
    pub backdrop: [f32; 3],
    /// Factor on the whole picture. At 1 and with the default lights, the brightest part of a white Lambertian ball is
    /// between 0.9 and 1.
    pub exposure: f32,
}

impl Default for BallSettings {
    fn default() -> Self {
        Self {
            size: 512,
            samples: 4,
            light_direction: [-0.45, 0.7, 0.6],
            light_irradiance: [1.75, 1.7, 1.62],
            light_angular_radius: 0.05,
            sky: Sky::default(),
            backdrop: [0.13, 0.13, 0.133],
            exposure: 1.0,
        }
    }
}

impl Scene {
    /// Renders a ball of a material: linear RGB, `settings.size` squared, not tone mapped; highlights exceed 1.
    ///
    /// The light goes through `luthier_eval`. The sky, being smooth, is reflected by each interface as its albedo
    /// (the FGD table where the layer has a tile of it, else Fresnel) times the blurred sky around the mirrored
    /// direction, and by a diffuse base as albedo times irradiance / pi; layers above attenuate both by Fresnel
    /// transmission and absorption along the refracted directions. Simplifications of the sky part: the base counts
    /// as Lambert, light from everywhere enters at its mean cosine 2/3, nothing bounces between layers.
    ///
    /// # Errors
    /// [`GpuError::PreviewForm`] unless the scene runs the baked form, [`GpuError::Setting`], [`GpuError::NoMaterial`],
    /// and whatever the device reports.
    pub fn render_ball(&self, material: u32, settings: &BallSettings) -> Result<Image, GpuError> {
        if self.form() != "baked" {
            return Err(GpuError::PreviewForm { form: self.form().to_owned() });
        }
        settings.check()?;
        let layers = widened(self.layers(material)?, settings.light_angular_radius);
        let group = self.bindings.group(&self.context, &self.widened_words(settings.light_angular_radius))?;
        let pipeline = self.pipeline(&self.ball, &self.ball_kernel())?;

        let size = settings.size;
        let rows = (SAMPLES_PER_PASS / (size * settings.samples * settings.samples)).clamp(1, size);
        let mut data = Vec::with_capacity((size * size * 3) as usize);
        for row in (0..size).step_by(rows as usize) {
            let rows = rows.min(size - row);
            let inputs = settings.words(material, row, &layers);
            let pixels = self.context.run(&Pass {
                what: "preview",
                pipeline,
                shader_group: &group,
                workgroups: [size.div_ceil(WORKGROUP), rows.div_ceil(WORKGROUP)],
                inputs: bytemuck::cast_slice(&inputs),
                output_words: (size * rows) as usize,
            })?;
            data.extend(pixels.iter().flat_map(|pixel| &pixel[..3]));
        }
        Ok(Image { width: size, height: size, channels: 3, data })
    }

    /// The material buffer with slopes widened by the light.
    fn widened_words(&self, angular_radius: f32) -> Vec<[f32; 4]> {
        let widen = |m: &MaterialEntry| MaterialEntry { layers: widened(&m.layers, angular_radius), ..m.clone() };
        material_buffer(&self.manifest.materials.iter().map(widen).collect::<Vec<_>>())
    }

    /// The kernel, with the look-ups that the shader has. A set of diffuse bases has no Fresnel table, and needs none.
    fn ball_kernel(&self) -> String {
        let body = |kind, call| if self.reads(kind) { call } else { "vec3<f32>(0.0)" };
        let fresnel = body(TableKind::Fresnel, "luthier_lookup_fresnel(tile, cos_theta)");
        let fgd = body(TableKind::Fgd, "luthier_lookup_fgd(tile, cos_theta, alpha).rgb");
        format!(
            "{}\n{}\n\
             fn ball_fresnel(tile: f32, cos_theta: f32) -> vec3<f32> {{\n    return {fresnel};\n}}\n\
             fn ball_fgd(tile: f32, cos_theta: f32, alpha: f32) -> vec3<f32> {{\n    return {fgd};\n}}\n",
            include_str!("wgsl/sky.wgsl"),
            include_str!("wgsl/ball.wgsl"),
        )
    }
}

/// Layers with slopes widened by a light of this angular radius: the half vector turns by half of what the light does.
fn widened(layers: &[LayerRecord], angular_radius: f32) -> Vec<LayerRecord> {
    let spread = 0.5 * f64::from(angular_radius);
    let wider = |alpha: f64| libm::sqrt(alpha * alpha + spread * spread).min(1.0);
    let widen = |layer: &LayerRecord| LayerRecord {
        alpha: wider(layer.alpha),
        alpha_xy: layer.alpha_xy.map(wider),
        ..layer.clone()
    };
    layers.iter().map(widen).collect()
}

impl BallSettings {
    fn check(&self) -> Result<(), GpuError> {
        if !(1..=4096).contains(&self.size) {
            return Err(setting("size", self.size.to_string(), "1 to 4096 pixels"));
        }
        if !(1..=16).contains(&self.samples) {
            return Err(setting("samples", self.samples.to_string(), "1 to 16 along a side of a pixel"));
        }
        check_direction("light_direction", self.light_direction)?;
        if !(0.0..=0.5).contains(&self.light_angular_radius) {
            return Err(setting("light_angular_radius", self.light_angular_radius.to_string(), "0 to 0.5 radians"));
        }
        let [[lr, lg, lb], [br, bg, bb]] = [self.light_irradiance, self.backdrop];
        for value in [lr, lg, lb, br, bg, bb, self.exposure] {
            if !value.is_finite() || value < 0.0 {
                return Err(setting(
                    "light_irradiance, backdrop or exposure",
                    value.to_string(),
                    "finite and not negative",
                ));
            }
        }
        self.sky.check()
    }

    /// The words of `Ball` in `ball.wgsl`.
    fn words(&self, material: u32, row: u32, layers: &[LayerRecord]) -> Vec<[u32; 4]> {
        let bits = |word: [f32; 4]| word.map(f32::to_bits);
        let with = |[x, y, z]: [f32; 3], w: f32| bits([x, y, z, w]);
        let length = libm::sqrtf(self.light_direction.iter().map(|x| x * x).sum());
        let mut words = vec![
            with(self.light_direction.map(|x| x / length), self.exposure),
            with(self.light_irradiance, EYE),
            with(self.backdrop, HALF_EXTENT),
            [self.size, self.samples, row, material],
        ];
        words.extend(self.sky.words().map(bits));
        for layer in layers {
            words.extend(layer.words().into_iter().take(4).map(bits));
        }
        words
    }
}
