//! The model of a material whose file names none.

use std::collections::BTreeSet;

use luthier_model::{DefaultFor, Feature, Form, ShadingModel};
use luthier_optics::stack::{Base, Layer};

use crate::bake_settings::SODIUM_D_NM;
use crate::left_out::{LeftOut, left_out};
use crate::material::Material;

/// Slope parameter up to which further bounces are neglected: a white interface then lacks 0.01 at 86 degrees, where GGX loses the most
/// (`luthier-layers/tests/layers/bounces.rs`).
const ONE_BOUNCE_ALPHA: f64 = 0.008;

/// F0 above which a second interface counts as a mirror: closed forms may then return more light than falls in, because they leave out that
/// light spreads by n^2 when it comes out of a slab.
const MIRROR_F0: f64 = 0.2;

impl Material {
    /// The model that shades it: the one that its file names, or else the first that shows all that the file asks for. Of a stack that is
    /// `lobes`, `belcour`, `yamaguchi`, `elek`, `weidlich-wilkie`, in this order; one rough interface alone begins with `lobes` and goes on with
    /// `elek`, and one smooth interface or a base has nothing to simulate and begins with `elek`. That `belcour` and `yamaguchi` show a Beckmann
    /// distribution as GGX does not count.
    ///
    /// Over a second interface that is a mirror, closed forms return more light than falls in, and are no defaults. If no model shows all, the
    /// one that leaves out the least is taken.
    pub fn model(&self) -> ShadingModel {
        self.bake.model.unwrap_or_else(|| {
            let kind = if self.is_stack() { DefaultFor::Stack } else { DefaultFor::Facets };
            let open = kind.models().filter(|_| self.has_further_bounces());
            let closed = DefaultFor::Closed.models().filter(|_| !self.covers_mirror());
            self.most_whole(open.chain(closed))
        })
    }

    /// The model that shades it without a simulation: the one that its file names, or else a closed form.
    pub fn model_without_fit(&self) -> ShadingModel {
        self.bake.model.unwrap_or_else(|| self.most_whole(DefaultFor::Closed.models()))
    }

    /// The features that keep the material from the model `lobes`, each once; those that its model leaves out, too, if there are no others. None if its
    /// file names a model, and if there is nothing to simulate.
    pub fn unfit_for_lobes(&self) -> Vec<LeftOut> {
        let is_open = self.bake.model.is_none() && self.has_further_bounces() && !self.model().is_fitted();
        let mut parts = if is_open { self.lacks(ShadingModel::Lobes) } else { Vec::new() };
        let others: BTreeSet<Feature> = self.lacks(self.model()).iter().map(|part| part.feature).collect();
        if parts.iter().any(|part| !others.contains(&part.feature)) {
            parts.retain(|part| !others.contains(&part.feature));
        }
        let mut told = BTreeSet::new();
        parts.retain(|part| told.insert(part.feature));
        parts
    }

    /// Whether a model shows all that the file asks for, in a shader with tables.
    pub fn is_whole_in(&self, model: ShadingModel) -> bool {
        self.lacks(model).is_empty()
    }

    fn is_stack(&self) -> bool {
        self.stack.layers.len() > 1
    }

    /// Whether light bounces more than once on it: it has several layers, or facets.
    pub fn has_further_bounces(&self) -> bool {
        self.is_stack()
            || self.stack.layers.first().is_some_and(|Layer { surface, base, .. }| {
                !matches!(base, Base::Diffuse(_)) && surface.alpha_x.max(surface.alpha_y) > ONE_BOUNCE_ALPHA
            })
    }

    /// Whether an interface below the first may reflect much: a metal, an interface with an F0 that is large or in textures, or one to a thinner
    /// medium. False if a layer has slopes that only closed forms show: no other model is left then.
    fn covers_mirror(&self) -> bool {
        let layers = &self.stack.layers;
        let have_walks =
            layers.iter().all(|layer| matches!(layer.base, Base::Diffuse(_)) || layer.surface.distribution.has_walks());
        let mut above = None;
        let mut mirrors = layers.iter().zip(&self.layers).map(|(layer, extras)| match &layer.base {
            Base::Conductor { .. } => true,
            Base::Diffuse(_) => false,
            Base::Dielectric { ior, .. } => {
                let n = ior.at(SODIUM_D_NM).re;
                let is_thinner = above.replace(n).is_some_and(|above| n < above);
                let is_bright = ior.f0().is_some_and(|f0| f0.into_iter().any(|f0| f0 > MIRROR_F0));
                is_thinner || is_bright || extras.varies_f0()
            }
        });
        // The first interface counts as the medium above the second.
        mirrors.next();
        have_walks && mirrors.any(|is_mirror| is_mirror)
    }

    /// The model that leaves out the fewest of its features; of several the first.
    fn most_whole(&self, models: impl Iterator<Item = ShadingModel>) -> ShadingModel {
        models.min_by_key(|model| self.lacks(*model).len()).unwrap_or_default()
    }

    /// The features that a shader with tables leaves out.
    fn lacks(&self, model: ShadingModel) -> Vec<LeftOut> {
        let mut parts = left_out(self, model);
        parts.retain(|part| part.forms.contains(&Form::Baked));
        parts.retain(|part| !(model.is_statistical() && part.feature == Feature::Beckmann));
        parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COAT: &str = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\n";
    const GOLD: &str = "[[layer]]\ntype = \"conductor\"\nior = \"au\"\n";
    const WHITE: &str = "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
    const VARYING: &str = "[[layer]]\ntype = \"thin-film\"\nior = 1.9\n[layer.thickness_nm]\nmin = 100\nmax = 200\n\
                           extent_um = 1000\nmap = { noise = { seed = 1, frequency = 2, octaves = 1 } }\n";
    const METALLIC: &str = "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = 0.9\nmetallic = 1\n";
    const ENGINE: &str = "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = 0.5\n";
    const F0: &str = "maps = { f0 = \"f.png\" }\n";
    const FLAKES: &str = "[effects.flakes]\ncells = { seed = 1, count = 8, spread_deg = 10 }\ntiling = 10\n";

    const PATINA: &str = "[effects.patina]\nextent = 0.5\ntransition = 0.5\nmap = { noise = {} }\n";

    const WEIGHT: &str = "weight = 0.5\n";
    const WEIGHT_MAP: &str = "weight = \"w.png\"\n";
    const OWN: &str = "maps = { alpha = \"a.png\" }\n";
    const PAINT: &str = "maps = { albedo = \"paint.png\" }\n";

    fn material(body: &str) -> Material {
        let text = format!("schema = 1\nname = \"x\"\n{body}");
        let parsed = crate::parse("x.toml", &text, &|_| Err(std::io::Error::other("none")));
        parsed.unwrap_or_else(|errors| panic!("{}", errors[0].render(&text))).material
    }

    /// Models of files that name none, with and without a fit; and what keeps `lobes` away. Chosen by hand from the table of features.
    #[test]
    fn the_default_shows_all_that_a_file_asks_for() {
        let (smooth, rough, beckmann) =
            ("alpha = 0.01\n", "alpha = 0.2\n", "alpha = 0.2\ndistribution = \"beckmann\"\n");
        let brushed = "alpha_x = 0.1\nalpha_y = 0.3\n";
        let scratched = "alpha = 0.1\n[layer.maps]\nroughness = \"r.png\"\n";
        let stained = "alpha = 0.1\n[layer.maps]\nthickness = \"t.png\"\n";
        let worn = "alpha = 0.1\n[layer.maps]\nroughness = \"r.png\"\nthickness = \"t.png\"\n";
        let (painted, bumps) = ("[layer.maps]\nmetallic = \"m.png\"\n", "[layer.maps]\nbumps = \"n.png\"\n");
        let film = "[[layer]]\ntype = \"thin-film\"\nior = 1.9\nthickness_nm = 200\nweight = 0.5\n";
        let bumpy = "alpha = 0.1\n[layer.maps]\nnormal = \"n.png\"\n";
        for (body, model, without, cause) in [
            (GOLD.to_owned() + "alpha = 0.008\n", "elek", "elek", None),
            (GOLD.to_owned() + rough, "lobes", "elek", None),
            (COAT.to_owned() + rough, "lobes", "elek", None),
            (GOLD.to_owned() + brushed, "lobes", "weidlich-wilkie", None),
            (GOLD.to_owned() + scratched, "lobes", "elek", None),
            (GOLD.to_owned() + rough + "[layer.maps]\nbumps = \"n.png\"\n", "lobes", "elek", None),
            (COAT.to_owned() + smooth + WEIGHT + WHITE + bumps, "lobes", "elek", None),
            (COAT.to_owned() + smooth + COAT + rough + bumps + WHITE + bumps, "lobes", "elek", None),
            (
                COAT.to_owned() + smooth + COAT + rough + bumps + COAT + rough + WHITE + bumps,
                "elek",
                "elek",
                Some("layer.1.maps.bumps"),
            ),
            (GOLD.to_owned() + "distribution = \"blinn\"\n" + rough, "elek", "elek", Some("layer.0.distribution")),
            (WHITE.to_owned(), "elek", "elek", None),
            (VARYING.to_owned() + GOLD + rough, "lobes", "elek", None),
            (COAT.to_owned() + smooth + METALLIC + rough + painted, "lobes", "elek", None),
            (METALLIC.to_owned() + rough + painted, "lobes", "elek", None),
            (COAT.to_owned() + rough + OWN + GOLD + rough + OWN, "lobes", "elek", None),
            (
                COAT.to_owned() + rough + COAT + rough + OWN + GOLD + rough,
                "belcour",
                "elek",
                Some("layer.1.maps.alpha"),
            ),
            (COAT.to_owned() + rough + WEIGHT + OWN + WHITE, "lobes", "elek", None),
            (COAT.to_owned() + rough + WEIGHT + COAT + rough + "f0 = 0.016\n" + OWN + WHITE, "lobes", "elek", None),
            (COAT.to_owned() + smooth + METALLIC + brushed + painted, "lobes", "weidlich-wilkie", None),
            (COAT.to_owned() + smooth + WHITE, "lobes", "elek", None),
            (COAT.to_owned() + beckmann + GOLD + rough, "lobes", "elek", None),
            (COAT.to_owned() + bumpy + GOLD + rough, "lobes", "elek", None),
            (
                COAT.to_owned() + smooth + GOLD + brushed + "[layer.maps]\ntangent = \"t.png\"\n",
                "lobes",
                "weidlich-wilkie",
                None,
            ),
            (
                COAT.to_owned() + rough + COAT + brushed + GOLD + brushed + "[layer.maps]\ntangent = \"t.png\"\n",
                "yamaguchi",
                "weidlich-wilkie",
                Some("layer.2.maps.tangent"),
            ),
            (COAT.to_owned() + smooth + GOLD + rough + "[layer.maps]\nbumps = \"n.png\"\n", "lobes", "elek", None),
            (COAT.to_owned() + scratched + WHITE, "lobes", "elek", None),
            (COAT.to_owned() + stained + WHITE, "lobes", "elek", None),
            (COAT.to_owned() + worn + WHITE, "lobes", "elek", None),
            (COAT.to_owned() + worn + GOLD + beckmann, "lobes", "elek", None),
            (COAT.to_owned() + smooth + GOLD + brushed, "lobes", "weidlich-wilkie", None),
            (COAT.to_owned() + scratched + GOLD + brushed, "lobes", "weidlich-wilkie", None),
            (COAT.to_owned() + stained + GOLD + brushed, "lobes", "weidlich-wilkie", None),
            (COAT.to_owned() + stained + ENGINE + rough + OWN, "lobes", "elek", None),
            (COAT.to_owned() + worn + ENGINE + rough, "lobes", "elek", None),
            (GOLD.replace("ior = \"au\"", "f0 = 0.9") + rough + F0, "lobes", "elek", None),
            (COAT.to_owned() + stained + &GOLD.replace("ior = \"au\"", "f0 = 0.9") + rough + F0, "lobes", "elek", None),
            (COAT.to_owned() + "f0 = 0.2\n" + rough + F0 + WHITE + PAINT, "lobes", "elek", None),
            (VARYING.to_owned() + COAT + rough + WHITE, "lobes", "elek", None),
            (VARYING.to_owned() + COAT + scratched + WHITE, "elek", "elek", Some("layer.0.film.0.thickness_nm")),
            (COAT.to_owned() + smooth + GOLD + rough + FLAKES, "lobes", "elek", None),
            (COAT.to_owned() + smooth + GOLD + rough + PATINA, "lobes", "elek", None),
            (COAT.to_owned() + beckmann + WHITE + PATINA, "lobes", "elek", None),
            (COAT.to_owned() + scratched + GOLD + rough + PATINA, "lobes", "elek", None),
            (COAT.to_owned() + stained + GOLD + rough + PATINA, "lobes", "elek", None),
            (COAT.to_owned() + scratched + WHITE + PATINA, "elek", "elek", Some("effects.patina")),
            (VARYING.to_owned() + COAT + rough + WHITE + PATINA, "elek", "elek", Some("effects.patina")),
            (COAT.to_owned() + smooth + GOLD + brushed + PATINA, "lobes", "weidlich-wilkie", None),
            (COAT.to_owned() + smooth + GOLD + rough + FLAKES + PATINA, "lobes", "elek", None),
            (COAT.to_owned() + smooth + COAT + rough + GOLD + rough + FLAKES + PATINA, "lobes", "elek", None),
            (COAT.to_owned() + smooth + WEIGHT + GOLD + rough, "lobes", "elek", None),
            (COAT.to_owned() + smooth + WEIGHT + WHITE + PAINT, "lobes", "elek", None),
            (COAT.to_owned() + smooth + "weight = 1\n" + WHITE + PAINT, "lobes", "elek", None),
            (COAT.to_owned() + scratched + WEIGHT_MAP + WHITE, "lobes", "elek", None),
            (VARYING.to_owned() + COAT + rough + WEIGHT + WHITE, "lobes", "elek", None),
            (COAT.to_owned() + smooth + WEIGHT + GOLD + brushed, "lobes", "weidlich-wilkie", None),
            (COAT.to_owned() + smooth + GOLD + brushed + FLAKES, "lobes", "weidlich-wilkie", None),
            (film.to_owned() + COAT + rough + OWN + GOLD + rough, "lobes", "elek", None),
        ] {
            let found = material(&body);
            assert_eq!([found.model(), found.model_without_fit()].map(ShadingModel::name), [model, without], "{body}");
            assert_eq!(found.unfit_for_lobes().first().map(|part| part.key.as_str()), cause, "{body}");
            let named = material(&(body + "[bake]\nmodel = \"phong\"\n"));
            assert_eq!([named.model(), named.model_without_fit()], [ShadingModel::Phong; 2]);
            assert_eq!(named.unfit_for_lobes(), []);
        }
    }
}
