//! `scene.json`, which the three examples share, and the ball in it.

#![expect(clippy::disallowed_methods, reason = "a platform's own sines are good enough for a picture")]

use std::f32::consts::PI;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use serde_json::Value;

/// Lights that the uniform buffer has room for.
const MAX_LIGHTS: usize = 4;
const SEGMENTS: [u16; 2] = [128, 64];

/// A ball of radius 1 at the origin, seen from +z.
pub struct Scene {
    /// Width and height of the picture in pixels.
    pub size: u32,
    /// Name of the material.
    pub material: String,
    /// Linear RGB around the ball.
    pub background: [f32; 3],
    focal: f32,
    eye_distance: f32,
    lights: Vec<Light>,
}

struct Light {
    /// To the light, unit.
    direction: [f32; 3],
    /// Of a surface that faces the light, linear RGB.
    irradiance: [f32; 3],
}

impl Scene {
    pub fn open(path: &Path) -> Result<Self> {
        let file = fs::read_to_string(path).with_context(|| path.display().to_string())?;
        let scene: Value = serde_json::from_str(&file)?;
        let lights = scene["lights"].as_array().context("a scene without lights")?;
        ensure!(lights.len() <= MAX_LIGHTS, "more than {MAX_LIGHTS} lights");
        let light = |light: &Value| {
            let [x, y, z] = triple(&light["direction"])?;
            let length = (x * x + y * y + z * z).sqrt();
            Ok(Light { direction: [x / length, y / length, z / length], irradiance: triple(&light["irradiance"])? })
        };
        Ok(Self {
            size: scene["size"].as_u64().context("a scene without a size")? as u32,
            material: scene["material"].as_str().context("a scene without a material")?.to_owned(),
            background: triple(&scene["background"])?,
            focal: 1.0 / (0.5 * number(&scene["fov_y_deg"])?.to_radians()).tan(),
            eye_distance: number(&scene["eye_distance"])?,
            lights: lights.iter().map(light).collect::<Result<_>>()?,
        })
    }

    /// The uniform buffer of `ball.wgsl`.
    pub fn uniforms(&self, material: u32) -> Vec<u8> {
        let mut words = vec![self.focal.to_bits(), self.eye_distance.to_bits(), material, self.lights.len() as u32];
        for light in &self.lights {
            for [x, y, z] in [light.direction, light.irradiance] {
                words.extend([x.to_bits(), y.to_bits(), z.to_bits(), 0]);
            }
        }
        words.resize(4 + 8 * MAX_LIGHTS, 0);
        bytemuck::cast_slice(&words).to_vec()
    }
}

/// Points of the ball, which are its normals too, and the corners of its triangles, counter-clockwise from outside.
pub fn ball() -> (Vec<[f32; 3]>, Vec<u16>) {
    let [columns, rows] = SEGMENTS;
    let mut points = Vec::new();
    let mut corners = Vec::new();
    for row in 0..=rows {
        let theta = PI * f32::from(row) / f32::from(rows);
        for column in 0..=columns {
            let phi = 2.0 * PI * f32::from(column) / f32::from(columns);
            points.push([-phi.cos() * theta.sin(), theta.cos(), phi.sin() * theta.sin()]);
            if row < rows && column < columns {
                let here = row * (columns + 1) + column;
                let below = here + columns + 1;
                corners.extend([here + 1, here, below + 1, here, below, below + 1]);
            }
        }
    }
    (points, corners)
}

fn number(value: &Value) -> Result<f32> {
    Ok(value.as_f64().with_context(|| format!("{value} should be a number"))? as f32)
}

fn triple(value: &Value) -> Result<[f32; 3]> {
    Ok([number(&value[0])?, number(&value[1])?, number(&value[2])?])
}
