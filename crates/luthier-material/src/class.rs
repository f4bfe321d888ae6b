//! Classes of layered surfaces, a to h, and of surfaces of one layer.

use std::fmt;

use luthier_optics::stack::{Base, Stack, Surface};

/// The eight classes of layered surfaces of Weidlich and Wilkie 2009, chapter 4, and four classes of surfaces without a coat.
///
/// ```
/// use luthier_material::SurfaceClass;
///
/// assert_eq!(SurfaceClass::D.to_string(), "d) Metal Foil");
/// assert!(SurfaceClass::H.is_layered() && !SurfaceClass::Film.is_layered());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SurfaceClass {
    /// Smooth clear coat on a diffuse base.
    A,
    /// Smooth tinted coat on a diffuse base.
    B,
    /// Rough coat on a diffuse base.
    C,
    /// Smooth coat on a smooth metal.
    D,
    /// Smooth coat on a rough metal.
    E,
    /// Rough coat on a smooth metal.
    F,
    /// Rough coat on a rough metal.
    G,
    /// More than two layers.
    H,
    /// A metal without a coat.
    Metal,
    /// Films on a surface without a coat, or in a free sheet.
    Film,
    /// A diffuse base without a coat.
    Matte,
    /// A transparent medium with nothing below.
    Glass,
}

/// Steepest slope, in degrees, of a surface that counts as smooth. The text calls 0.01 to 4 degrees smooth (glossy
/// paint, and the 4-degree base of its metal foil) and 5 to 40 degrees rough (frosted paint).
pub const SMOOTH_SLOPE_DEG: f64 = 4.5;

/// Smallest optical depth of a channel that tints a coat: 1 % per pass.
const TINT_DEPTH: f64 = 0.01;

impl SurfaceClass {
    /// All classes in order: those of the text, then those of one layer.
    pub const ALL: [Self; 12] = [
        Self::A,
        Self::B,
        Self::C,
        Self::D,
        Self::E,
        Self::F,
        Self::G,
        Self::H,
        Self::Metal,
        Self::Film,
        Self::Matte,
        Self::Glass,
    ];

    /// The class by the decision tree of chapter 4: metal or not; is the top smooth; is the base smooth; and h for more
    /// than two layers. Films share a layer's surface and do not count below or on a coat. A dielectric base, glass for instance,
    /// goes with the diffuse ones: a, b or c by its top.
    ///
    /// The text has coats on all its surfaces. A surface of one layer has a class of its own, by its films and its base.
    pub fn of(stack: &Stack) -> Self {
        let (Some(top), Some(base)) = (stack.layers.first(), stack.layers.last()) else { return Self::Matte };
        if stack.layers.len() > 2 {
            return Self::H;
        }
        if stack.layers.len() == 1 {
            return match &base.base {
                _ if !base.films.is_empty() => Self::Film,
                Base::Conductor { .. } => Self::Metal,
                Base::Diffuse(_) => Self::Matte,
                Base::Dielectric { .. } => Self::Glass,
            };
        }
        let top_smooth = is_smooth(&top.surface) && !matches!(top.base, Base::Diffuse(_));
        let tinted = match &top.base {
            Base::Dielectric { slab, .. } => slab.optical_depth().iter().any(|&d| d >= TINT_DEPTH),
            _ => false,
        };
        match (&base.base, top_smooth) {
            (Base::Conductor { .. }, true) if is_smooth(&base.surface) => Self::D,
            (Base::Conductor { .. }, true) => Self::E,
            (Base::Conductor { .. }, false) if is_smooth(&base.surface) => Self::F,
            (Base::Conductor { .. }, false) => Self::G,
            (_, true) if tinted => Self::B,
            (_, true) => Self::A,
            (_, false) => Self::C,
        }
    }

    /// Its letter in the text, or a word, as in manifests.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::A => "a",
            Self::B => "b",
            Self::C => "c",
            Self::D => "d",
            Self::E => "e",
            Self::F => "f",
            Self::G => "g",
            Self::H => "h",
            Self::Metal => "metal",
            Self::Film => "film",
            Self::Matte => "matte",
            Self::Glass => "glass",
        }
    }

    /// Whether it is one of the text's classes of layered surfaces.
    pub fn is_layered(self) -> bool {
        self <= Self::H
    }

    /// Its name in the text, or ours.
    pub fn name(self) -> &'static str {
        match self {
            Self::A => "Glossy Paint",
            Self::B => "Tinted Glazing",
            Self::C => "Frosted Paint",
            Self::D => "Metal Foil",
            Self::E => "Metallic Paint",
            Self::F => "Frosted Metal",
            Self::G => "Patina",
            Self::H => "Multi-Layer",
            Self::Metal => "Bare Metal",
            Self::Film => "Thin Film",
            Self::Matte => "Matte",
            Self::Glass => "Glass",
        }
    }
}

impl fmt::Display for SurfaceClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.is_layered() {
            true => write!(f, "{}) {}", self.symbol(), self.name()),
            false => f.write_str(self.name()),
        }
    }
}

fn is_smooth(surface: &Surface) -> bool {
    surface.alpha_isotropic() <= libm::tan(SMOOTH_SLOPE_DEG.to_radians())
}

#[cfg(test)]
mod tests {
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::{Diffuse, Distribution, Film, FilmThickness, Layer, Slab};

    use super::*;

    fn slope(deg: f64) -> Surface {
        Surface::isotropic(Distribution::Beckmann, libm::tan(deg.to_radians()))
    }

    fn coat(deg: f64, absorption: f64) -> Layer {
        let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.0, absorption, 0.0] };
        let base = Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab };
        Layer { films: Vec::new(), surface: slope(deg), base }
    }

    fn metal(deg: f64) -> Layer {
        Layer {
            films: Vec::new(),
            surface: slope(deg),
            base: Base::Conductor { ior: Ior::constant(1.0, 5.0).unwrap() },
        }
    }

    fn diffuse() -> Layer {
        let base = Base::Diffuse(Diffuse { albedo: [0.5; 3], sigma: 0.0 });
        Layer { films: Vec::new(), surface: Surface::smooth(), base }
    }

    fn symbol(layers: Vec<Layer>) -> &'static str {
        SurfaceClass::of(&Stack { exterior: Ior::vacuum(), layers }).symbol()
    }

    /// The tree of figure 4.3 and the thresholds of the text, branch by branch.
    #[test]
    fn the_tree_has_eight_leaves() {
        assert_eq!(symbol(vec![coat(3.5, 0.0), diffuse()]), "a");
        assert_eq!(symbol(vec![coat(1.5, 1.0), diffuse()]), "b");
        assert_eq!(symbol(vec![coat(10.0, 1.0), diffuse()]), "c");
        assert_eq!(symbol(vec![coat(1.0, 0.5), metal(4.0)]), "d");
        assert_eq!(symbol(vec![coat(1.0, 0.5), metal(12.0)]), "e");
        assert_eq!(symbol(vec![coat(17.0, 0.5), metal(1.0)]), "f");
        assert_eq!(symbol(vec![coat(7.0, 0.0), metal(10.0)]), "g");
        assert_eq!(symbol(vec![coat(30.0, 0.0), coat(7.0, 0.0), diffuse()]), "h");
    }

    /// The labels of figure 4.4.
    #[test]
    fn classes_have_the_names_of_the_text() {
        let labels = [
            "a) Glossy Paint",
            "b) Tinted Glazing",
            "c) Frosted Paint",
            "d) Metal Foil",
            "e) Metallic Paint",
            "f) Frosted Metal",
            "g) Patina",
            "h) Multi-Layer",
        ];
        for (class, label) in SurfaceClass::ALL.into_iter().zip(labels) {
            assert_eq!((class.to_string().as_str(), class.is_layered()), (label, true));
        }
    }

    #[test]
    fn surfaces_without_a_coat_have_classes_of_their_own() {
        let film =
            Film { ior: Ior::constant(1.33, 0.0).unwrap(), thickness: FilmThickness { min_nm: 300.0, max_nm: 300.0 } };
        let filmed = |layer: Layer| Layer { films: vec![film.clone()], ..layer };
        assert_eq!(symbol(vec![metal(0.0)]), "metal");
        assert_eq!(symbol(vec![metal(20.0)]), "metal");
        assert_eq!(symbol(vec![filmed(metal(20.0))]), "film");
        assert_eq!(symbol(vec![filmed(coat(0.0, 0.0))]), "film");
        assert_eq!(symbol(vec![diffuse()]), "matte");
        assert_eq!(symbol(vec![coat(0.0, 1.0)]), "glass");
        // A coat makes a layered surface of them.
        assert_eq!(symbol(vec![filmed(coat(0.0, 0.0)), metal(0.0)]), "d");
        assert_eq!(
            SurfaceClass::of(&Stack { exterior: Ior::vacuum(), layers: vec![metal(0.0)] }).to_string(),
            "Bare Metal"
        );
    }
}
