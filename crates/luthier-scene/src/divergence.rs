//! Cost of a scene whose neighbouring pixels differ: threads of a wave execute each other's models.

use luthier_manifest::ShadingModel;

/// The model that shades a material, and the cost of its shader for this material alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shaded {
    /// The model.
    pub model: ShadingModel,
    /// Cost of one evaluation.
    pub cost: f64,
}

/// Cost of all materials of a scene together, one evaluation each, where a share of neighbours differs.
///
/// A pixel costs what its own shader costs while its neighbours are of its material. Among neighbours of all materials its wave executes every model of the
/// scene, each with the features of all its materials, as dear as the dearest of them. Between, for a share `s`:
///
/// ```text
/// cost of a pixel = (1 - s) own + s (sum over models of the dearest of their materials)
/// ```
///
/// Measured on an NVIDIA H200, 22 materials of six models took 13.6 ps where 64 threads in a row had one material, 37 where eight had, and 98 where each
/// thread had another one; in one model 21.7, 19.9 and 26.6. Six models at the mean of 13.6 make 82 for a share of 1, 17 % less than measured. Eight threads
/// in a row give a warp of 32 four materials and so 3.1 of six models, a share of 0.42, and 42 ps, 14 % more than measured. One model makes 21.7, 18 % less
/// than measured.
///
/// ```
/// use luthier_manifest::ShadingModel::{Belcour, Elek, Lobes};
/// use luthier_scene::{Shaded, scene_cost};
///
/// let cheapest = [Shaded { model: Elek, cost: 5.0 }, Shaded { model: Belcour, cost: 9.0 }];
/// let of_one = cheapest.map(|_| Shaded { model: Lobes, cost: 11.0 });
/// assert_eq!([scene_cost(&cheapest, 0.0), scene_cost(&of_one, 0.0)], [14.0, 22.0]);
/// // Where all neighbours differ, one model for both is cheaper.
/// assert_eq!([scene_cost(&cheapest, 1.0), scene_cost(&of_one, 1.0)], [28.0, 22.0]);
/// ```
pub fn scene_cost(materials: &[Shaded], neighbours_differ: f64) -> f64 {
    let own: f64 = materials.iter().map(|material| material.cost).sum();
    let dearest = |model| {
        let costs = materials.iter().filter(|material| material.model == model).map(|material| material.cost);
        costs.fold(0.0, f64::max)
    };
    let of_all: f64 = ShadingModel::ALL.into_iter().map(dearest).sum();
    (1.0 - neighbours_differ) * own + neighbours_differ * of_all * materials.len() as f64
}

/// The choice with the lowest [`scene_cost`]: for each material the place of one of its candidates, none of which is dearer than another of the same
/// model. Every set of models is tried; among equal costs the one with fewer models is taken.
pub(crate) fn cheapest(candidates: &[Vec<Shaded>], neighbours_differ: f64) -> Option<Vec<usize>> {
    let models = ShadingModel::ALL;
    let mut sets: Vec<u32> = (1..1 << models.len()).collect();
    sets.sort_by_key(|set| set.count_ones());
    let mut best: Option<(f64, Vec<usize>)> = None;
    for set in sets {
        let is_in = |shaded: &Shaded| models.iter().position(|m| *m == shaded.model).is_some_and(|i| set >> i & 1 == 1);
        let chosen: Option<Vec<usize>> = candidates
            .iter()
            .map(|of_one| {
                let places = (0..of_one.len()).filter(|&i| is_in(&of_one[i]));
                places.min_by(|&a, &b| of_one[a].cost.total_cmp(&of_one[b].cost))
            })
            .collect();
        let Some(chosen) = chosen else { continue };
        let shaded: Vec<Shaded> = chosen.iter().zip(candidates).map(|(&i, of_one)| of_one[i]).collect();
        let cost = scene_cost(&shaded, neighbours_differ);
        if best.as_ref().is_none_or(|(least, _)| cost < least * (1.0 - 1e-12)) {
            best = Some((cost, chosen));
        }
    }
    best.map(|(_, chosen)| chosen)
}

#[cfg(test)]
mod tests {
    use ShadingModel::{Belcour, Elek, Lobes, Microfacet, Phong, WeidlichWilkie};

    use super::*;

    /// Expected number of distinct models of `models` equally frequent ones among some draws.
    fn distinct(models: f64, draws: f64) -> f64 {
        models * (1.0 - libm::pow(1.0 - 1.0 / models, draws))
    }

    /// Oracle: times on an NVIDIA H200 of 22 materials in one buffer, ps an evaluation, for one material in 64 threads, in 8, and in each.
    #[test]
    fn times_of_one_device_are_met_within_a_fifth() {
        let six = [Belcour, Elek, Lobes, Microfacet, Phong, WeidlichWilkie];
        let of_six: Vec<Shaded> = (0..22).map(|i| Shaded { model: six[i % 6], cost: 13.6 }).collect();
        let of_one: Vec<Shaded> = (0..22).map(|_| Shaded { model: Lobes, cost: 21.7 }).collect();
        // A warp has 32 threads: four groups of eight.
        let share = (distinct(6.0, 4.0) - 1.0) / 5.0;
        let mut off = Vec::new();
        for (set, share, measured) in
            [(&of_six, share, 37.0), (&of_six, 1.0, 98.0), (&of_one, share, 19.9), (&of_one, 1.0, 26.6)]
        {
            off.push(100.0 * (scene_cost(set, share) / 22.0 / measured - 1.0));
        }
        let rounded: Vec<i32> = off.iter().map(|off| off.round() as i32).collect();
        assert_eq!(rounded, [14, -17, 9, -18]);
    }

    #[test]
    fn the_share_decides_between_many_models_and_one() {
        let [elek, lobes] = [5.0, 8.0].map(|cost| move |model| Shaded { model, cost });
        let candidates =
            vec![vec![elek(Elek), lobes(Lobes)], vec![elek(Phong), lobes(Lobes)], vec![elek(Belcour), lobes(Lobes)]];
        assert_eq!(cheapest(&candidates, 0.0), Some(vec![0, 0, 0]));
        assert_eq!(cheapest(&candidates, 0.2), Some(vec![0, 0, 0]));
        assert_eq!(cheapest(&candidates, 0.5), Some(vec![1, 1, 1]));
        assert_eq!(cheapest(&[vec![]], 0.5), None);
    }
}
