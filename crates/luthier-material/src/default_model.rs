//! The model of a material whose file names none.

use luthier_manifest::{Feature, Form, ShadingModel};

use crate::left_out::{LeftOut, left_out};
use crate::material::Material;

/// Models that follow light through several layers and return no more than falls in, the nearest to the simulation first
/// (`docs/pages/lobes.md`, `docs/pages/models.md`).
const OF_STACKS: [ShadingModel; 3] = [ShadingModel::Lobes, ShadingModel::Belcour, ShadingModel::Yamaguchi];

/// Closed forms: of one interface both are the same, and the first is the cheaper. The last shows all that a file can ask for.
const CLOSED: [ShadingModel; 2] = [ShadingModel::Elek, ShadingModel::WeidlichWilkie];

impl Material {
    /// The model that shades it: the one that its file names, or else the first that shows all that the file asks for. Of a stack that is
    /// `lobes`, `belcour`, `yamaguchi`, `elek`, `weidlich-wilkie`, in this order; one layer alone has nothing to simulate, and begins with
    /// `elek`. That `belcour` and `yamaguchi` show a Beckmann distribution as GGX does not count.
    pub fn model(&self) -> ShadingModel {
        let stacks = if self.is_stack() { &OF_STACKS[..] } else { &[] };
        self.bake.model.unwrap_or_else(|| self.first_whole(stacks.iter().chain(&CLOSED)))
    }

    /// The model that shades it where nothing is simulated: the one that its file names, or else a closed form.
    pub fn model_without_fit(&self) -> ShadingModel {
        self.bake.model.unwrap_or_else(|| self.first_whole(CLOSED.iter()))
    }

    /// The feature that keeps a stack whose file names no model from the model `lobes`.
    pub fn unfit_for_lobes(&self) -> Option<LeftOut> {
        let is_open = self.bake.model.is_none() && self.is_stack();
        is_open.then(|| self.lack(ShadingModel::Lobes)).flatten()
    }

    fn is_stack(&self) -> bool {
        self.stack.layers.len() > 1
    }

    fn first_whole<'a>(&self, mut models: impl Iterator<Item = &'a ShadingModel>) -> ShadingModel {
        models.find(|model| self.lack(**model).is_none()).copied().unwrap_or(CLOSED[CLOSED.len() - 1])
    }

    /// The first thing that a shader with tables does not show of it.
    fn lack(&self, model: ShadingModel) -> Option<LeftOut> {
        let counts = |part: &LeftOut| !(model.is_statistical() && part.feature == Feature::Beckmann);
        left_out(self, model).into_iter().find(|part| part.forms.contains(&Form::Baked) && counts(part))
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
    const FLAKES: &str = "[effects.flakes]\ncells = { seed = 1, count = 8, spread_deg = 10 }\ntiling = 10\n";

    const PATINA: &str = "[effects.patina]\nextent = 0.5\ntransition = 0.5\nmap = { noise = {} }\n";

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
        let bumpy = "alpha = 0.1\n[layer.maps]\nnormal = \"n.png\"\n";
        for (body, model, without, cause) in [
            (GOLD.to_owned() + rough, "elek", "elek", None),
            (GOLD.to_owned() + brushed, "weidlich-wilkie", "weidlich-wilkie", None),
            (WHITE.to_owned(), "elek", "elek", None),
            (VARYING.to_owned() + GOLD + rough, "elek", "elek", None),
            (COAT.to_owned() + smooth + WHITE, "lobes", "elek", None),
            (COAT.to_owned() + beckmann + GOLD + rough, "lobes", "elek", None),
            (COAT.to_owned() + bumpy + GOLD + rough, "lobes", "elek", None),
            (
                COAT.to_owned() + smooth + GOLD + brushed + "[layer.maps]\ntangent = \"t.png\"\n",
                "yamaguchi",
                "weidlich-wilkie",
                Some("layer.1.maps.tangent"),
            ),
            (
                COAT.to_owned() + smooth + GOLD + rough + "[layer.maps]\nbumps = \"n.png\"\n",
                "elek",
                "elek",
                Some("layer.1.maps.bumps"),
            ),
            (COAT.to_owned() + scratched + WHITE, "lobes", "elek", None),
            (COAT.to_owned() + stained + WHITE, "lobes", "elek", None),
            (COAT.to_owned() + worn + WHITE, "belcour", "elek", Some("layer.0.maps.thickness")),
            (COAT.to_owned() + worn + GOLD + beckmann, "belcour", "elek", Some("layer.0.maps.thickness")),
            (COAT.to_owned() + smooth + GOLD + brushed, "lobes", "weidlich-wilkie", None),
            (
                COAT.to_owned() + scratched + GOLD + brushed,
                "yamaguchi",
                "weidlich-wilkie",
                Some("layer.0.maps.roughness"),
            ),
            (
                COAT.to_owned() + stained + GOLD + brushed,
                "yamaguchi",
                "weidlich-wilkie",
                Some("layer.0.maps.thickness"),
            ),
            (VARYING.to_owned() + COAT + rough + WHITE, "lobes", "elek", None),
            (VARYING.to_owned() + COAT + scratched + WHITE, "elek", "elek", Some("layer.0.film.0.thickness_nm")),
            (COAT.to_owned() + smooth + GOLD + rough + FLAKES, "lobes", "elek", None),
            (COAT.to_owned() + smooth + GOLD + rough + PATINA, "lobes", "elek", None),
            (COAT.to_owned() + beckmann + WHITE + PATINA, "lobes", "elek", None),
            (COAT.to_owned() + scratched + GOLD + rough + PATINA, "elek", "elek", Some("effects.patina")),
            (COAT.to_owned() + stained + GOLD + rough + PATINA, "elek", "elek", Some("effects.patina")),
            (VARYING.to_owned() + COAT + rough + WHITE + PATINA, "elek", "elek", Some("effects.patina")),
            (
                COAT.to_owned() + smooth + GOLD + brushed + PATINA,
                "weidlich-wilkie",
                "weidlich-wilkie",
                Some("effects.patina"),
            ),
            (COAT.to_owned() + smooth + GOLD + rough + FLAKES + PATINA, "lobes", "elek", None),
            (
                COAT.to_owned() + smooth + COAT + rough + GOLD + rough + FLAKES + PATINA,
                "elek",
                "elek",
                Some("effects.patina"),
            ),
            (COAT.to_owned() + smooth + GOLD + brushed + FLAKES, "lobes", "weidlich-wilkie", None),
        ] {
            let found = material(&body);
            assert_eq!([found.model(), found.model_without_fit()].map(ShadingModel::name), [model, without], "{body}");
            assert_eq!(found.unfit_for_lobes().map(|part| part.key).as_deref(), cause, "{body}");
            let named = material(&(body + "[bake]\nmodel = \"phong\"\n"));
            assert_eq!([named.model(), named.model_without_fit()], [ShadingModel::Phong; 2]);
            assert_eq!(named.unfit_for_lobes(), None);
        }
    }

    /// Whatever a file asks for, some model of the list shows it.
    #[test]
    fn the_last_model_shows_everything() {
        let last = CLOSED[CLOSED.len() - 1];
        assert!(Feature::ALL.into_iter().all(|feature| last.honours(feature, Form::Baked)));
    }
}
