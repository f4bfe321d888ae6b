//! The sRGB transfer function (IEC 61966-2-1).

/// The linear value of a code in 0..=1.
pub fn linear(code: f32) -> f32 {
    let v = f64::from(code);
    (if v <= 0.040_45 { v / 12.92 } else { libm::pow((v + 0.055) / 1.055, 2.4) }) as f32
}

/// The code in 0..=1 of a linear value, which is clipped to 0..=1; NaN stays NaN, and becomes 0 as an integer.
pub fn code(linear: f32) -> f64 {
    let v = f64::from(linear).clamp(0.0, 1.0);
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * libm::pow(v, 1.0 / 2.4) - 0.055 }
}
