//! Kinds of tables, with one row of facts for each: other crates know a kind by these.

use serde::{Deserialize, Serialize};

crate::named! {
    /// Kind of a table, by its contents. One texture of each kind serves any number of materials.
    ///
    /// ```
    /// use luthier_lut::TableKind;
    ///
    /// let facts = TableKind::from_name("fgd").unwrap().facts();
    /// assert_eq!((facts.binding, facts.y), (2, Some("alpha")));
    /// assert!(!facts.is_optional);
    /// ```
    #[derive(Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum TableKind("table") {
        /// Fresnel reflectance over the cosine, RGB; one row per interface.
        Fresnel = "fresnel",
        /// `pi alpha^2 D` over angle and alpha; one tile per slope distribution.
        Distribution = "distribution",
        /// Directional albedo with all microsurface bounces over (cos_theta, alpha), RGB, and in A the luminance of
        /// the part that never crossed the interface; one tile per interface.
        Fgd = "fgd",
        /// Granier's `2 cos(2 Phi)` over normalised thickness, RGB; one row per film.
        Phase = "phase",
        /// Granier's T_d over (u, v): normalised thickness, slopes, normalisation factor; one tile per varying film.
        Thickness = "thickness",
        /// Reflectance of an interface over the cosine and the thickness of its film, RGB; one tile per interface whose film varies.
        Film = "film",
        /// Share of a lobe inside a medium that is not totally reflected at its surface, over (cos_theta, alpha), the cosine being that of the
        /// refracted direction outside; one tile per index.
        Escape = "escape",
        /// Light from below the first interface as lobes, part by part, over the cosine of the view; one tile per material.
        Lobes = "lobes",
    }
}

/// Calls a macro with all kinds, as `Variant "name"` separated by commas: for matches whose arms differ by the name alone.
#[macro_export]
macro_rules! for_table_kinds {
    ($callback:ident) => {
        $callback! {
            Fresnel "fresnel", Distribution "distribution", Fgd "fgd", Phase "phase", Thickness "thickness", Film "film",
            Escape "escape", Lobes "lobes"
        }
    };
}

/// The layers that can have a tile of a kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Served {
    /// Interfaces: all layers but diffuse bases.
    Interfaces,
    /// Interfaces that light crosses.
    Transparent,
    /// Interfaces with a film.
    Films,
    /// Interfaces with a film that varies in thickness.
    VaryingFilms,
}

/// The values of a kind of table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Values {
    /// A function that is nowhere negative.
    Positive,
    /// A function of both signs.
    Signed,
    /// A picture, whose only source is the material file.
    Picture,
    /// Rows of numbers of both signs, each unrelated to the rows beside it.
    Apart,
}

/// Facts about a kind of table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KindFacts {
    /// Contents of the table, as a sentence.
    pub holds: &'static str,
    /// Binding number of its texture. 5 is the sampler, 6 the material buffer.
    pub binding: u32,
    /// Word and component of a layer in the material buffer that hold the number of its tile. `None` for tiles that serve a whole material:
    /// the header of the material has their number, and so has the record of the first layer.
    pub slot: Option<[usize; 2]>,
    /// Names of the channels of its unquantised values: letters for a colour, words for others. No name is A, which viewers take for
    /// transparency.
    pub channels: &'static [&'static str],
    /// Quantities that its x axis may have.
    pub x: &'static [&'static str],
    /// Quantity of its y axis; absent when a tile is a single row.
    pub y: Option<&'static str>,
    /// Range of its values.
    pub values: Values,
    /// Layers that can have a tile.
    pub served: Served,
    /// Whether a shader can do without a tile: it computes the function, or takes its usual value.
    pub is_optional: bool,
    /// Whether `[bake.NAME]` in a material file sets the size and the format of its tiles.
    pub has_settings: bool,
}

const RGB: &[&str] = &["R", "G", "B"];
const ONE: &[&str] = &["Y"];

/// Facts that most kinds have.
const FACTS: KindFacts = KindFacts {
    holds: "",
    binding: 0,
    slot: Some([0, 0]),
    channels: RGB,
    x: &["cos_theta"],
    y: None,
    values: Values::Positive,
    served: Served::Interfaces,
    is_optional: false,
    has_settings: true,
};

impl TableKind {
    /// The facts about a kind.
    pub const fn facts(self) -> KindFacts {
        match self {
            Self::Fresnel => KindFacts {
                holds: "Fresnel reflectance of an interface over the cosine, RGB.",
                binding: 0,
                slot: Some([1, 0]),
                x: &["cos_theta", "theta"],
                ..FACTS
            },
            Self::Distribution => KindFacts {
                holds: "Slope distributions, stored as π α² D.",
                binding: 1,
                slot: Some([1, 1]),
                channels: ONE,
                x: &["cos_theta_h", "theta_h"],
                y: Some("alpha"),
                is_optional: true,
                ..FACTS
            },
            Self::Fgd => KindFacts {
                holds: "Directional albedo of a rough interface with all its microsurface bounces, RGB; in A the luminance of \
                        the part that never crossed.",
                binding: 2,
                slot: Some([1, 2]),
                channels: &["R", "G", "B", "never_crossed.Y"],
                x: &["cos_theta", "theta"],
                y: Some("alpha"),
                ..FACTS
            },
            Self::Phase => KindFacts {
                holds: "Interference of a film: 2 cos(2 Φ) over normalised thickness, RGB.",
                binding: 3,
                slot: Some([1, 3]),
                x: &["s"],
                values: Values::Signed,
                served: Served::Films,
                is_optional: true,
                ..FACTS
            },
            Self::Thickness => KindFacts {
                holds: "Thickness of a varying film: normalised thickness, slopes, normalisation.",
                binding: 4,
                slot: Some([2, 3]),
                channels: &["R", "G", "B", "normalisation.Y"],
                x: &["u"],
                y: Some("v"),
                values: Values::Picture,
                served: Served::VaryingFilms,
                ..FACTS
            },
            Self::Film => KindFacts {
                holds: "Reflectance of an interface over cosine and thickness of its film, RGB.",
                binding: 7,
                slot: Some([6, 3]),
                y: Some("fraction"),
                served: Served::VaryingFilms,
                has_settings: false,
                ..FACTS
            },
            Self::Escape => KindFacts {
                holds: "Share of a lobe that is not totally reflected inside.",
                binding: 8,
                slot: Some([8, 3]),
                channels: ONE,
                y: Some("alpha"),
                served: Served::Transparent,
                is_optional: true,
                has_settings: false,
                ..FACTS
            },
            Self::Lobes => KindFacts {
                holds: "Light from below the first interface in lobes over the cosine of the view: energies RGB and shapes, part by part.",
                binding: 9,
                slot: None,
                channels: &["R", "G", "B", "shape"],
                y: Some("part"),
                values: Values::Apart,
                has_settings: false,
                ..FACTS
            },
        }
    }

    /// Binding number of its texture.
    pub const fn binding(self) -> u32 {
        self.facts().binding
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn bindings_and_slots_are_distinct() {
        assert_eq!(TableKind::ALL.map(TableKind::binding), [0, 1, 2, 3, 4, 7, 8, 9]);
        let slots: BTreeSet<Option<[usize; 2]>> = TableKind::ALL.iter().map(|kind| kind.facts().slot).collect();
        assert_eq!(slots.len(), TableKind::ALL.len());
        for kind in TableKind::ALL {
            assert_eq!(serde_json::to_string(&kind).unwrap(), format!("\"{}\"", kind.name()));
        }
    }

    macro_rules! names {
        ($($kind:ident $name:literal),+) => { [$((TableKind::$kind, $name)),+] };
    }

    #[test]
    fn the_macro_has_every_kind() {
        assert_eq!(for_table_kinds!(names), TableKind::ALL.map(|kind| (kind, kind.name())));
    }
}
