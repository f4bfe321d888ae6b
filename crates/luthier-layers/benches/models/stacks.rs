//! Stacks of the benchmarks.

use luthier_layers::monochrome::Monochrome;
use luthier_optics::constants::dataset;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Diffuse, Distribution, Film, FilmThickness, Layer, Slab, Stack, Surface};

/// Rough gold.
pub(crate) fn bare_conductor() -> Stack {
    stack(vec![gold()])
}

/// A rough coat that absorbs a little, over rough gold.
pub(crate) fn coated_conductor() -> Stack {
    stack(vec![coat(Vec::new()), gold()])
}

/// The coat of [`coated_conductor`] with a film on it, over a rough diffuse base.
pub(crate) fn film_slab_diffuse() -> Stack {
    let film = Film { ior: index(1.38), thickness: FilmThickness { min_nm: 150.0, max_nm: 150.0 } };
    let base = Base::Diffuse(Diffuse { albedo: [0.7, 0.5, 0.3], sigma: 0.3 });
    stack(vec![coat(vec![film]), Layer { films: Vec::new(), surface: Surface::smooth(), base }])
}

/// The stack in the green.
pub(crate) fn green(stack: &Stack) -> Monochrome {
    Monochrome::new(stack, 550.0, 1)
}

fn stack(layers: Vec<Layer>) -> Stack {
    Stack { exterior: Ior::vacuum(), layers }
}

fn gold() -> Layer {
    let ior = dataset("au").expect("gold is built in").ior.clone();
    Layer { films: Vec::new(), surface: Surface::isotropic(Distribution::Ggx, 0.3), base: Base::Conductor { ior } }
}

fn coat(films: Vec<Film>) -> Layer {
    let slab = Slab { thickness_um: 10.0, absorption_per_um: [0.01, 0.02, 0.03] };
    Layer {
        films,
        surface: Surface::isotropic(Distribution::Ggx, 0.1),
        base: Base::Dielectric { ior: index(1.5), slab },
    }
}

fn index(n: f64) -> Ior {
    Ior::constant(n, 0.0).expect("a valid index")
}
