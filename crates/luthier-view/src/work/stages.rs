//! Stages of a picture: the renderings of one view, coarse first.

/// One rendering of a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stage {
    /// Pixels of the rendering per pixel of the window, along a side.
    pub(crate) scale: f64,
    /// Samples along each side of a pixel.
    pub(crate) samples: u32,
    /// Directions of the environment; 0 reads blurred maps.
    pub(crate) environment_samples: u32,
}

/// Final quality of a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Goal {
    /// Side of the square rendering, in pixels of the window.
    pub(crate) side: u32,
    /// Samples along each side of a pixel at the end.
    pub(crate) samples: u32,
    /// Directions of the environment at the end; 0 where maps serve.
    pub(crate) environment_samples: u32,
    /// True while the view moves. It then has one coarse stage only.
    pub(crate) moving: bool,
}

/// Seconds that a rendering may take while something moves.
pub(crate) const MOVING_SECONDS: f64 = 0.05;

/// A first rendering that takes longer than this has a coarse one before it, in seconds.
const PATIENCE: f64 = 0.25;

/// Coarsest rendering, pixels along a side.
const COARSEST: f64 = 96.0;

/// Directions of the environment in a coarse and in the first full rendering.
const FEW_DIRECTIONS: [u32; 2] = [3, 8];

/// Side of a picture with `pixels` pixels, between the coarsest and `side`.
pub(crate) fn affordable(side: f64, pixels: f64) -> f64 {
    pixels.sqrt().clamp(COARSEST.min(side), side)
}

impl Goal {
    /// The stages, with `seconds` per evaluation of the shader as measured so far.
    pub(crate) fn stages(&self, seconds: f64) -> Vec<Stage> {
        let [coarse, first] = FEW_DIRECTIONS.map(|few| few.min(self.environment_samples));
        let side = f64::from(self.side);
        let pixel = seconds * f64::from(1 + coarse);
        let draft = Stage {
            scale: affordable(side, MOVING_SECONDS / pixel.max(1e-12)) / side,
            samples: 1,
            environment_samples: coarse,
        };
        if self.moving {
            return vec![draft];
        }
        let full = [(1, first), (self.samples, self.environment_samples)];
        let full = full.map(|(samples, environment_samples)| Stage { scale: 1.0, samples, environment_samples });
        let mut stages = full.to_vec();
        stages.dedup();
        if side * side * seconds * f64::from(1 + first) > PATIENCE {
            stages.insert(0, draft);
        }
        stages
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REST: Goal = Goal { side: 800, samples: 3, environment_samples: 0, moving: false };

    #[test]
    fn rest_ends_with_what_was_asked_for() {
        for environment_samples in [0, 2, 64] {
            for seconds in [1e-12, 1e-6, 1e-3] {
                let goal = Goal { environment_samples, ..REST };
                let last = Stage { scale: 1.0, samples: 3, environment_samples };
                assert_eq!(goal.stages(seconds).last(), Some(&last));
                let cost = |s: &Stage| s.scale * f64::from(s.samples * (1 + s.environment_samples));
                let costs: Vec<f64> = goal.stages(seconds).iter().map(cost).collect();
                assert!(costs.windows(2).all(|pair| pair[0] < pair[1]), "{costs:?}");
            }
        }
        assert_eq!(Goal { samples: 1, ..REST }.stages(1e-12).len(), 1, "no stage twice");
    }

    #[test]
    fn motion_costs_what_the_adapter_affords() {
        let moving = Goal { moving: true, ..REST };
        assert_eq!(moving.stages(1e-12)[0].scale, 1.0);
        let [slow] = moving.stages(1e-6)[..] else { panic!("one stage") };
        assert!((slow.scale * 800.0 - (0.05f64 / 1e-6).sqrt()).abs() < 1e-9);
        assert_eq!(moving.stages(1.0)[0].scale * 800.0, 96.0);
        assert_eq!(Goal { side: 40, ..moving }.stages(1.0)[0].scale, 1.0);
    }

    #[test]
    fn slow_adapters_begin_with_a_draft() {
        assert_eq!(REST.stages(1e-9).len(), 2);
        let stages = REST.stages(1e-5);
        assert!(stages.len() == 3 && stages[0].scale < 1.0);
    }
}
