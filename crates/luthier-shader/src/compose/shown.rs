//! Directions in which a lobe of the model `lobes` shows the environment.

use std::f64::consts::PI;

/// A number of reads for each lobe. Blurs were measured: `docs/pages/environment.md` has the errors.
struct Step {
    reads: u32,
    /// Blur of a direction of a lobe, over its widths.
    blur: f64,
    /// Blur of a direction of facets of Beckmann over their spread where that is narrow.
    coat_blur: f64,
    /// Steps of the lattice of such directions across the plane of the eye, from one to the next, and for a whole turn.
    across: [f64; 2],
}

const STEPS: [Step; 6] = [
    Step { reads: 1, blur: 1.0, coat_blur: 1.0, across: [4.4, 4.4] },
    Step { reads: 2, blur: 1.0, coat_blur: 1.0, across: [4.5, 4.5] },
    Step { reads: 4, blur: 0.6, coat_blur: 0.9, across: [4.75, 4.75] },
    Step { reads: 8, blur: 0.3, coat_blur: 0.7, across: [4.375, 4.375] },
    Step { reads: 16, blur: 0.22, coat_blur: 0.5, across: [0.618_034, 7.0] },
    Step { reads: 32, blur: 0.2, coat_blur: 0.45, across: [2.781_25, 2.781_25] },
];

/// The golden angle: directions lie along a spiral (Vogel 1979).
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// The text with this many directions for each lobe.
pub(super) fn directions(text: &str, reads: u32) -> String {
    let step = STEPS.iter().find(|step| step.reads >= reads).unwrap_or(&STEPS[STEPS.len() - 1]);
    let count = f64::from(step.reads);
    // One direction is the middle, and two are opposite each other.
    let angle = if step.reads == 2 { PI } else { GOLDEN_ANGLE };
    let spiral = (0..step.reads).map(|i| {
        let beyond = if step.reads == 1 { 0.999 } else { 1.0 - (f64::from(i) + 0.5) / count };
        let (sin, cos) = libm::sincos(f64::from(i) * angle);
        format!(
            "    shown = luthier_shown_tap(shown, lobe, prepared, frame, {beyond:.6}, vec2<f32>({cos:.6}, {sin:.6}));\n"
        )
    });
    let lattice = (0..step.reads).map(|i| {
        let along = (f64::from(i) + 0.5) / count;
        let across = (step.across[0] * (f64::from(i) + 0.5) + 0.5 * step.across[1]).fract();
        format!("        shown = luthier_shown_even_tap(shown, lobe, prepared, frame, {along:.6}, {across:.6});\n")
    });
    let words = [
        ("    $each_direction\n", spiral.collect()),
        ("        $each_even\n", lattice.collect()),
        ("$reads", format!("{count:?}")),
        ("$tap_blur", format!("{:?}", step.blur)),
        ("$coat_blur", format!("{:?}", step.coat_blur)),
        ("$across_turn", format!("{:?}", step.across[1])),
    ];
    words.iter().fold(text.to_owned(), |text, (word, value)| text.replace(word, value))
}

#[cfg(test)]
mod tests {
    use luthier_manifest::FunctionGroup;

    use super::*;

    #[test]
    fn every_group_has_its_step() {
        let text = "    $each_direction\n        $each_even\nconst READS: f32 = $reads;";
        for reads in FunctionGroup::ALL.into_iter().filter_map(FunctionGroup::environment_reads) {
            let found = directions(text, reads);
            for tap in ["luthier_shown_tap(", "luthier_shown_even_tap("] {
                assert_eq!(found.matches(tap).count(), reads as usize, "{tap}");
            }
            assert!(found.ends_with(&format!("READS: f32 = {reads}.0;")) && !found.contains('$'), "{found}");
        }
    }
}
