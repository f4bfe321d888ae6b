//! Local frames around tilted normals, of surfaces and of single interfaces, and the half vector of two directions.

use glam::DVec3;

/// The direction `w` in a frame with `normal` as +z, both unit. The frame is the surface's, turned the shortest way, so that tangents keep their
/// sense. `normal.z > -1`; the identity for +z.
pub fn local(normal: DVec3, w: DVec3) -> DVec3 {
    let n = normal;
    let a = 1.0 / (1.0 + n.z);
    let shear = -n.x * n.y * a;
    let tangent = DVec3::new(1.0 - n.x * n.x * a, shear, -n.x);
    let bitangent = DVec3::new(shear, 1.0 - n.y * n.y * a, -n.y);
    DVec3::new(tangent.dot(w), bitangent.dot(w), n.dot(w))
}

/// Pairs of directions: of a single one and of many, or of as many of each.
///
/// # Panics
/// If neither list has a single direction and their lengths differ.
pub fn each_pair<'a>(wi: &'a [[f64; 3]], wo: &'a [[f64; 3]]) -> impl Iterator<Item = [DVec3; 2]> + 'a {
    let count = match (wi.len(), wo.len()) {
        (1, count) | (count, 1) => count,
        (count, other) => {
            assert_eq!(count, other, "directions of light and of the eye");
            count
        }
    };
    let step = |list: &[[f64; 3]]| usize::from(list.len() > 1);
    let (step_i, step_o) = (step(wi), step(wo));
    (0..count).map(move |k| [DVec3::from(wi[k * step_i]), DVec3::from(wo[k * step_o])])
}

/// The half vector of two unit directions and the cosine of either to it; `None` where they are opposite.
///
/// For unit directions that cosine is half the length of their sum; in this form directions that were rounded to f32 do not cancel at
/// grazing angles.
pub(crate) fn half_vector(wi: DVec3, wo: DVec3) -> Option<(DVec3, f64)> {
    let bisector = wi + wo;
    let length = bisector.length();
    (length != 0.0).then(|| (bisector / length, (0.5 * length).min(1.0)))
}

/// The cosine of two unit directions to their half vector, as in [`half_vector`]; 0 where they are opposite.
pub(crate) fn cos_theta_d(wi: DVec3, wo: DVec3) -> f64 {
    half_vector(wi, wo).map_or(0.0, |(_, cos_theta_d)| cos_theta_d)
}

/// Both directions in the frame of an interface's own normal, and the factor on its light: the cosine of `wi` there over its cosine in the frame of
/// the place. `None` if the interface turns away from either direction.
///
/// A tilted facet of a surface gets `L cos(wi, n)` and not `L cos(wi, z)`, and a pixel sees its radiance. Slabs keep the thickness along the
/// place's normal that they have without bumps.
pub(crate) fn onto(normal: DVec3, wi: DVec3, wo: DVec3) -> Option<(DVec3, DVec3, f64)> {
    if normal == DVec3::Z {
        return Some((wi, wo, 1.0));
    }
    let [wi_here, wo_here] = [wi, wo].map(|w| local(normal, w));
    (wi_here.z > 0.0 && wo_here.z > 0.0).then(|| (wi_here, wo_here, wi_here.z / wi.z))
}

/// Directions below an interface, back in the frame of the place, and the factor on the light as in [`onto`].
pub(crate) fn off(normal: DVec3, wi: DVec3, wo: DVec3) -> Option<(DVec3, DVec3, f64)> {
    // The least rotation back is that to the normal's mirror image.
    onto(DVec3::new(-normal.x, -normal.y, normal.z), wi, wo)
}

/// A place in the frame of its first interface: the normal of that interface, and the normals of all layers against it, the first of which is +z. `normal`
/// is that of the place, and `own` are the normals of its layers in the frame of the place. All are unit, and layers without one, up to `count`, are level
/// there.
pub(crate) fn on_first(normal: DVec3, own: &[DVec3], count: usize) -> (DVec3, Vec<DVec3>) {
    if own.iter().all(|own| *own == DVec3::Z) {
        return (normal, own.to_vec());
    }
    // The least rotation back is that to the normal's mirror image.
    let back = DVec3::new(-normal.x, -normal.y, normal.z);
    let level = std::iter::repeat_n(DVec3::Z, count.saturating_sub(own.len()));
    let above = own.iter().copied().chain(level).map(|own| local(back, own));
    let first = above.clone().next().unwrap_or(normal);
    (first, std::iter::once(DVec3::Z).chain(above.skip(1).map(|own| local(first, own))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_on_its_first_interface_has_the_same_normals() {
        let unit = |x, y, z| DVec3::new(x, y, z).normalize();
        let (normal, own) = (unit(0.2, 0.1, 0.9), [unit(-0.3, 0.2, 0.8), unit(0.1, 0.4, 1.0), DVec3::Z]);
        let (first, layers) = on_first(normal, &own, 3);
        assert_eq!(layers[0], DVec3::Z);
        // Angles between all normals stay, and so does that to a direction.
        let w = unit(0.5, -0.3, 0.7);
        let (in_place, on_coat) = (local(normal, w), local(first, w));
        for (a, b) in own.iter().zip(&layers) {
            assert!((a.dot(in_place) - b.dot(on_coat)).abs() < 1e-15);
            assert!((a.dot(own[0]) - b.dot(layers[0])).abs() < 1e-15);
        }
        assert_eq!(on_first(normal, &[DVec3::Z; 2], 2), (normal, vec![DVec3::Z; 2]));
        // Layers without a normal are level in the place, as those that say so.
        let stated = on_first(normal, &[own[0], DVec3::Z, DVec3::Z], 3);
        assert_eq!(on_first(normal, &own[..1], 3), stated);
        assert!((local(first, normal) - stated.1[1]).length() < 1e-15);
        // Once more changes nothing.
        let (again, twice) = on_first(first, &layers, 3);
        assert!((again - first).length() < 1e-15 && twice.iter().zip(&layers).all(|(a, b)| (*a - *b).length() < 1e-15));
    }

    #[test]
    fn the_normal_becomes_z_and_angles_stay() {
        let n = DVec3::new(0.3, -0.5, 0.7).normalize();
        let (a, b) = (DVec3::new(0.1, 0.9, 0.2).normalize(), DVec3::new(-0.4, 0.2, 0.6).normalize());
        assert!((local(n, n) - DVec3::Z).length() < 1e-15);
        assert!((local(n, a).dot(local(n, b)) - a.dot(b)).abs() < 1e-15);
        // Right-handed.
        assert!((local(n, a.cross(b)) - local(n, a).cross(local(n, b))).length() < 1e-15);
        assert_eq!(local(DVec3::Z, a), a);
    }

    #[test]
    fn off_undoes_onto() {
        let n = DVec3::new(0.2, -0.3, 0.8).normalize();
        let (wi, wo) = (DVec3::new(0.1, 0.2, 0.9).normalize(), DVec3::new(-0.4, 0.1, 0.7).normalize());
        let (a, b, there) = onto(n, wi, wo).unwrap();
        let (c, d, back) = off(n, a, b).unwrap();
        assert!((c - wi).length() < 1e-15 && (d - wo).length() < 1e-15);
        assert!((there * back - 1.0).abs() < 1e-15);
        assert!((a.z - wi.dot(n)).abs() < 1e-15);
    }
}
