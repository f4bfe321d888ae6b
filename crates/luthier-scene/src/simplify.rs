use luthier_material::Material;
use luthier_optics::stack::{Base, Slab, Surface};

/// Something that a stack can do without.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LeaveOut {
    /// What slabs absorb.
    Absorption,
    /// All films.
    Films,
    /// Slopes of a diffuse base: Lambert's in place of Oren and Nayar's.
    DiffuseSlopes,
    /// Anisotropy: both slope parameters become their geometric mean.
    Anisotropy,
    /// A transparent layer, by its number from the top; what is below it comes up.
    Layer(usize),
}

impl LeaveOut {
    const PARTS: [Self; 4] = [Self::Absorption, Self::Films, Self::DiffuseSlopes, Self::Anisotropy];

    /// The name in manifests and reports.
    pub fn name(self) -> String {
        match self {
            Self::Absorption => "absorption".to_owned(),
            Self::Films => "films".to_owned(),
            Self::DiffuseSlopes => "diffuse slopes".to_owned(),
            Self::Anisotropy => "anisotropy".to_owned(),
            Self::Layer(layer) => format!("layer {layer}"),
        }
    }

    /// What has this name.
    pub fn from_name(name: &str) -> Option<Self> {
        let part = Self::PARTS.into_iter().find(|part| part.name() == name);
        part.or_else(|| Some(Self::Layer(name.strip_prefix("layer ")?.parse().ok()?)))
    }
}

/// A material without some of its parts; `None` where one of them is not there, or cannot be missed.
pub fn simplified(material: &Material, left_out: &[LeaveOut]) -> Option<Material> {
    let mut material = material.clone();
    for part in left_out {
        if !leave_out(&mut material, *part) {
            return None;
        }
    }
    Some(material)
}

fn leave_out(material: &mut Material, part: LeaveOut) -> bool {
    let layers = &mut material.stack.layers;
    let mut found = false;
    match part {
        LeaveOut::Absorption => {
            for layer in layers {
                if let Base::Dielectric { slab, .. } = &mut layer.base {
                    found |= slab.optical_depth() != [0.0; 3];
                    *slab = Slab { absorption_per_um: [0.0; 3], ..*slab };
                }
            }
        }
        LeaveOut::Films => {
            for (layer, extras) in layers.iter_mut().zip(&mut material.layers) {
                found |= !layer.films.is_empty();
                layer.films.clear();
                extras.film_variation = None;
            }
        }
        LeaveOut::DiffuseSlopes => {
            for layer in layers {
                if let Base::Diffuse(diffuse) = &mut layer.base {
                    found |= diffuse.sigma != 0.0;
                    diffuse.sigma = 0.0;
                }
            }
        }
        LeaveOut::Anisotropy => {
            for layer in layers {
                let Surface { distribution, alpha_x, alpha_y, .. } = layer.surface;
                found |= alpha_x != alpha_y;
                layer.surface = Surface::isotropic(distribution, (alpha_x * alpha_y).sqrt());
            }
        }
        LeaveOut::Layer(index) => {
            let is_coat = layers.get(index).is_some_and(|layer| matches!(layer.base, Base::Dielectric { .. }));
            // Flakes, patina and maps belong to layers by number.
            let effects = &material.effects;
            let stays = effects.flakes.is_some() || effects.patina.is_some();
            if is_coat && index + 1 < layers.len() && !stays {
                layers.remove(index);
                material.layers.remove(index);
                found = true;
            }
        }
    }
    found
}

/// All that can be left out together: every set of parts that are there, with at most one layer. The whole material first.
pub fn variants(material: &Material) -> Vec<(Vec<LeaveOut>, Material)> {
    let mut found: Vec<(Vec<LeaveOut>, Material)> = Vec::new();
    let layers = (0..material.stack.layers.len()).map(|layer| Some(LeaveOut::Layer(layer)));
    for layer in std::iter::once(None).chain(layers) {
        for bits in 0..1_u32 << LeaveOut::PARTS.len() {
            let parts =
                LeaveOut::PARTS.into_iter().enumerate().filter(|(i, _)| bits >> i & 1 == 1).map(|(_, part)| part);
            let left_out: Vec<LeaveOut> = layer.into_iter().chain(parts).collect();
            if let Some(simple) = simplified(material, &left_out) {
                found.push((left_out, simple));
            }
        }
    }
    found
}
