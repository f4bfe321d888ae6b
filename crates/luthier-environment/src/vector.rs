//! Vectors of three, on the host.

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}

/// Two unit vectors that make a right-handed frame with a unit `n` that is not along y: the first is level.
pub(crate) fn tangents(n: [f64; 3]) -> [[f64; 3]; 2] {
    let t = unit(cross([0.0, 1.0, 0.0], n));
    [t, cross(n, t)]
}
