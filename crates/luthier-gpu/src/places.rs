//! Evaluation of `luthier_eval_at`: pairs of directions, each at a place of its own.

use luthier_manifest::{LayerValues, PlaceValues};

use crate::context::word;
use crate::{GpuError, Scene};

const KERNEL: &str = include_str!("wgsl/places.wgsl");

/// Number of words of a pair and its place, without the layers.
const PAIR_WORDS: usize = 8;

/// Number of words of a layer.
const LAYER_WORDS: usize = 3;

/// A place, and directions to the light and to the eye.
pub type Spot = (PlaceValues, [f32; 3], [f32; 3]);

impl Scene {
    /// Whether the shader takes a place: [`Self::evaluate_at`] needs it.
    pub fn has_places(&self) -> bool {
        self.interface.has("LuthierPlace")
    }

    /// `luthier_eval_at` of a material: `f cos_theta_i`, linear RGB, at a place for each pair of directions. The shader's place has members only for
    /// quantities that vary in some material of the bake; the others are ignored.
    ///
    /// # Errors
    /// [`GpuError::NoMaterial`], [`GpuError::Refused`] for a shader without places, and whatever the device reports.
    pub fn evaluate_at(&self, material: u32, spots: &[Spot]) -> Result<Vec<[f32; 3]>, GpuError> {
        self.layers(material)?;
        let layers = self.layer_places();
        let pipeline = self.pipeline(&self.places, &self.places_kernel(layers))?;
        self.values("evaluation at places", pipeline, spots, |chunk| {
            chunk.iter().flat_map(|spot| words(material, spot, layers)).collect::<Vec<[f32; 4]>>()
        })
    }

    fn places_kernel(&self, layers: usize) -> String {
        let mut fill: Vec<String> = [
            ("inner_normal", format!("place.inner_normal = {};", input(3, "xyz"))),
            ("flake_normal", format!("place.flake_normal = {};", input(4, "xyz"))),
            ("base_color", format!("place.base_color = {};", input(5, "xyz"))),
            ("weight_factor", format!("place.weight_factor = {};", input(7, "x"))),
            ("patina", format!("place.patina = {};", input(5, "w"))),
            ("slope_variance", format!("place.slope_variance = {};", input(1, "w"))),
        ]
        .into_iter()
        .filter(|(member, _)| self.interface.fills("LuthierPlace", member))
        .map(|(_, line)| line)
        .collect();
        for layer in 0..layers {
            let [first, second, third] = [0, 1, 2].map(|word| PAIR_WORDS + LAYER_WORDS * layer + word);
            let members = [
                ("normal", input(first, "xyz")),
                ("slab_factor", input(first, "w")),
                ("alpha_factors", input(second, "xy")),
                ("tangent", format!("luthier_tangent({})", input(second, "zw"))),
                ("absorption_factors", input(third, "xyz")),
            ];
            let members = members.iter().filter(|(member, _)| self.interface.fills("LuthierLayerPlace", member));
            fill.extend(members.map(|(member, value)| format!("place.layers[{layer}].{member} = {value};")));
        }
        if self.interface.calls("luthier_f0_place") {
            let f0 = input(7, "yzw");
            fill.push(format!("if {f0}.x >= 0.0 {{ place = luthier_f0_place(place, material, {f0}); }}"));
        }
        if self.interface.calls("luthier_metallic_place") {
            let [color, metallic] = ["xyz", "w"].map(|part| input(6, part));
            let next = format!("luthier_metallic_place(place, material, {color}, {metallic})");
            fill.push(format!("if {metallic} >= 0.0 {{ place = {next}; }}"));
        }
        KERNEL
            .replace("$words", &format!("{}u", PAIR_WORDS + LAYER_WORDS * layers))
            .replace("$fill", &fill.join("\n    "))
    }
}

/// An expression of the kernel: some components of a word of a pair.
fn input(word: usize, components: &str) -> String {
    format!("kernel_inputs[first + {word}u].{components}")
}

/// The words of a pair and its place, with so many layers.
fn words(material: u32, (place, wi, wo): &Spot, layers: usize) -> Vec<[f32; 4]> {
    let (color, metallic) = place.metallic.unwrap_or(([0.0; 3], -1.0));
    let [r, g, b] = place.f0.unwrap_or([-1.0; 3]);
    let mut words = vec![
        word(*wi, material as f32),
        word(*wo, place.slope_variance),
        word(place.normal, place.alpha_factor),
        word(place.inner_normal, place.slab_factor),
        word(place.flake_normal, place.film_factor),
        word(place.base_color.unwrap_or([-1.0; 3]), place.patina.unwrap_or(-1.0)),
        word(color, metallic),
        [place.weight_factor, r, g, b],
    ];
    for layer in 0..layers {
        let own = place.layers.get(layer).unwrap_or(&LayerValues::NONE);
        let ([ax, ay], [tx, ty]) = (own.alpha_factors, own.tangent);
        words.extend([word(own.normal, own.slab_factor), [ax, ay, tx, ty], word(own.absorption_factors, 0.0)]);
    }
    words
}
