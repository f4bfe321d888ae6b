//! The camera that the mouse turns.

use std::f64::consts::{FRAC_PI_2, PI};

use luthier_gpu::{Camera, Shape};

/// A camera on a sphere around the origin, with a lens that zooms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orbit {
    /// Around +y from +z towards +x, in radians, -pi to pi.
    pub azimuth: f64,
    /// Elevation above the horizon, in radians, less than a right angle: at the pole the upward direction is undefined.
    pub elevation: f64,
    /// Magnification against [`Shape::camera`], [`Orbit::ZOOM_MIN`] to [`Orbit::ZOOM_MAX`].
    pub zoom: f64,
}

/// Largest elevation.
const STEEPEST: f64 = FRAC_PI_2 - 0.02;

impl Orbit {
    /// Smallest magnification: a third of the usual size.
    pub const ZOOM_MIN: f64 = 1.0 / 3.0;
    /// Largest magnification: close enough to tell flakes apart.
    pub const ZOOM_MAX: f64 = 40.0;

    /// The orbit at which [`Shape::camera`] is.
    pub fn of(shape: Shape) -> Self {
        let [x, y, z] = shape.camera().eye.map(f64::from);
        Self { azimuth: libm::atan2(x, z), elevation: libm::atan2(y, libm::hypot(x, z)), zoom: 1.0 }
    }

    /// A drag of the mouse over a share of the picture's side, to the right and down: the shape follows it, half a turn for
    /// the whole side.
    pub fn drag(&mut self, right: f64, down: f64) {
        self.azimuth -= PI * right / self.zoom.max(1.0);
        self.azimuth -= 2.0 * PI * (self.azimuth / (2.0 * PI)).round();
        self.elevation = (self.elevation + PI * down / self.zoom.max(1.0)).clamp(-STEEPEST, STEEPEST);
    }

    /// A turn of the wheel, in notches: each makes the picture a tenth larger or smaller.
    pub fn wheel(&mut self, notches: f64) {
        self.zoom = (self.zoom * libm::exp(notches * 0.1)).clamp(Self::ZOOM_MIN, Self::ZOOM_MAX);
    }

    /// The camera. `widening` is the side of the square picture over the shorter side of what is seen of it, at least 1.
    pub fn camera(&self, shape: Shape, widening: f64) -> Camera {
        let usual = shape.camera();
        let distance = usual.eye.iter().map(|&v| f64::from(v) * f64::from(v)).sum::<f64>().sqrt();
        let (sin_azimuth, cos_azimuth) = libm::sincos(self.azimuth);
        let (sin_elevation, cos_elevation) = libm::sincos(self.elevation);
        let towards = [sin_azimuth * cos_elevation, sin_elevation, cos_azimuth * cos_elevation];
        Camera {
            eye: towards.map(|v| (v * distance) as f32),
            target: [0.0; 3],
            half_extent: (f64::from(usual.half_extent) * widening / self.zoom) as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHAPES: [Shape; 3] = [Shape::Sphere, Shape::Torus, Shape::Plane];

    fn close(a: [f32; 3], b: [f32; 3]) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5)
    }

    #[test]
    fn it_starts_where_the_shape_is_usually_seen_from() {
        for shape in SHAPES {
            let (camera, usual) = (Orbit::of(shape).camera(shape, 1.0), shape.camera());
            assert!(close(camera.eye, usual.eye) && (camera.half_extent - usual.half_extent).abs() < 1e-6, "{shape:?}");
        }
    }

    #[test]
    fn half_a_picture_is_a_quarter_turn() {
        let mut orbit = Orbit::of(Shape::Sphere);
        orbit.drag(0.5, 0.0);
        // The shape follows the mouse to the right, so the eye goes to the left.
        assert!(close(orbit.camera(Shape::Sphere, 1.0).eye, [-7.0, 0.0, 0.0]));
        orbit.drag(-0.5, 0.25);
        let diagonal = 7.0 * std::f32::consts::FRAC_1_SQRT_2;
        assert!(close(orbit.camera(Shape::Sphere, 1.0).eye, [0.0, diagonal, diagonal]));
    }

    #[test]
    fn there_is_no_way_over_the_pole() {
        for down in [10.0, -10.0] {
            let mut orbit = Orbit::of(Shape::Torus);
            orbit.drag(0.3, down);
            let [x, y, z] = orbit.camera(Shape::Torus, 1.0).eye;
            assert!(libm::hypotf(x, z) > 0.1 && f64::from(y) * down > 0.0, "{x} {y} {z}");
        }
    }

    #[test]
    fn many_turns_stay_within_one() {
        let mut orbit = Orbit::of(Shape::Sphere);
        for _ in 0..1000 {
            orbit.drag(0.37, 0.0);
            assert!(orbit.azimuth.abs() <= PI + 1e-9);
        }
    }

    #[test]
    fn the_wheel_zooms_within_limits_and_back() {
        let mut orbit = Orbit::of(Shape::Sphere);
        orbit.wheel(3.0);
        assert!(orbit.camera(Shape::Sphere, 1.0).half_extent < Shape::Sphere.camera().half_extent);
        orbit.wheel(-3.0);
        assert!((orbit.zoom - 1.0).abs() < 1e-12);
        orbit.wheel(1000.0);
        assert_eq!(orbit.zoom, Orbit::ZOOM_MAX);
        orbit.wheel(-1000.0);
        assert_eq!(orbit.zoom, Orbit::ZOOM_MIN);
    }

    /// A picture twice as wide as high shows the shape at the same size.
    #[test]
    fn a_wide_picture_shows_more() {
        let camera = Orbit::of(Shape::Sphere).camera(Shape::Sphere, 2.0);
        assert!((camera.half_extent - 2.0 * Shape::Sphere.camera().half_extent).abs() < 1e-6);
    }
}
