//! Vectors of three, in single precision as meshes have them.

pub(crate) type V = [f32; 3];

pub(crate) fn dot(a: V, b: V) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a + t b`.
pub(crate) fn along(a: V, t: f32, b: V) -> V {
    [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]]
}

/// The unit vector of this direction; `None` if it has none.
pub(crate) fn unit(v: V) -> Option<V> {
    // In double precision, so that lengths near the ends of the range have squares.
    let v = v.map(f64::from);
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    (length > 1e-30 && length.is_finite()).then(|| v.map(|x| (x / length) as f32))
}

/// A unit vector across a unit vector.
pub(crate) fn across(n: V) -> V {
    let axis = if n[0].abs() > 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
    unit(cross(n, axis)).unwrap_or([1.0, 0.0, 0.0])
}

/// The angle at a corner, radians.
pub(crate) fn angle(at: V, b: V, c: V) -> f32 {
    let (ab, ac) = (sub(b, at), sub(c, at));
    let across = cross(ab, ac);
    libm::atan2f(dot(across, across).sqrt(), dot(ab, ac))
}
