//! Libraries of plausible materials, as many as it takes: the same for the same seed.

use std::fmt::Write as _;

use luthier_optics::sampling::split_mix::{GOLDEN, SplitMix64};

/// Metals and semiconductors by the names of their data sets.
const METALS: [&str; 12] = ["ag", "al", "au", "brass_70_30", "co", "cr", "cu", "fe", "ni", "steel_316", "ti", "w"];

/// A library of materials of one to four layers: coats over metals, over diffuse bases or over nothing, some with a film, of both
/// distributions.
pub(crate) struct Library {
    pub(crate) seed: u64,
    /// Number of indices that coats have, and of thicknesses that films have. Materials share interfaces where it is small.
    pub(crate) variety: u32,
}

impl Library {
    /// The file of a material.
    pub(crate) fn material(&self, number: u32) -> String {
        let mut random = Random(SplitMix64::new(self.seed ^ u64::from(number).wrapping_mul(GOLDEN)));
        let mut out = format!("schema = 1\nname = \"material-{number:05}\"\n");
        for _ in 0..random.below(4) {
            self.film(&mut random, &mut out);
            self.coat(&mut random, &mut out);
        }
        match random.below(5) {
            0 | 1 => {
                self.film(&mut random, &mut out);
                let metal = METALS[random.below(self.variety.min(METALS.len() as u32)) as usize];
                let _ = writeln!(out, "\n[[layer]]\ntype = \"conductor\"\nior = \"{metal}\"");
                surface(&mut random, &mut out, [0.1, 0.9]);
            }
            2 | 3 => {
                let [r, g, b] = [(); 3].map(|()| random.between(0.02, 0.9));
                let _ = writeln!(out, "\n[[layer]]\ntype = \"diffuse\"\nalbedo = [{r:.2}, {g:.2}, {b:.2}]");
            }
            _ => {
                self.film(&mut random, &mut out);
                self.coat(&mut random, &mut out);
            }
        }
        out
    }

    fn coat(&self, random: &mut Random, out: &mut String) {
        let ior = 1.3 + 0.5 * self.step(random);
        let _ = writeln!(out, "\n[[layer]]\ntype = \"dielectric\"\nior = {ior:.3}");
        surface(random, out, [0.0, 0.6]);
        if random.below(2) == 0 {
            let thickness = random.between(0.5, 50.0);
            let [r, g, b] = [(); 3].map(|()| random.between(0.0, 1.0) / thickness);
            let _ = writeln!(out, "thickness_um = {thickness:.1}\nabsorption_per_um = [{r:.4}, {g:.4}, {b:.4}]");
        }
    }

    /// Adds a film to one interface of six.
    fn film(&self, random: &mut Random, out: &mut String) {
        if random.below(6) == 0 {
            let thickness = 80.0 + 500.0 * self.step(random);
            let ior = 1.35 + 0.1 * f64::from(random.below(self.variety.min(11)));
            let _ = writeln!(out, "\n[[layer]]\ntype = \"thin-film\"\nior = {ior:.2}\nthickness_nm = {thickness:.1}");
        }
    }

    /// One of as many numbers from 0 up to 1 as there is variety.
    fn step(&self, random: &mut Random) -> f64 {
        f64::from(random.below(self.variety)) / f64::from(self.variety)
    }
}

fn surface(random: &mut Random, out: &mut String, [least, most]: [f64; 2]) {
    let _ = writeln!(out, "roughness = {:.3}", random.between(least, most));
    if random.below(2) == 0 {
        out.push_str("distribution = \"beckmann\"\n");
    }
}

/// Random choices.
struct Random(SplitMix64);

impl Random {
    fn below(&mut self, end: u32) -> u32 {
        (((self.0.bits() >> 32) * u64::from(end)) >> 32) as u32
    }

    fn between(&mut self, least: f64, most: f64) -> f64 {
        self.0.between([least, most])
    }
}
