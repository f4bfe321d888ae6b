//! Models in the sources: crates ask a model for its facts, and few files name single models.

use std::collections::BTreeSet;

use super::sources::sources;

/// Files that name single models, tests and the project's own pages apart.
const NAMING: [(&str, &str); 19] = [
    ("cli/src/model_inputs.rs", "names the model that could show what another drops"),
    ("cli/src/simulated.rs", "takes the cheapest model where only stacks count"),
    ("cli/src/verb/bench.rs", "times everything over Phong's model"),
    ("cli/src/verb/gallery/page.rs", "shows a second model beside that of the file"),
    ("crates/luthier/src/refusals/energy.rs", "names the model that returns what the simulation does"),
    ("layers/src/models/belcour/mod.rs", "is the model"),
    ("layers/src/models/elek/mod.rs", "is the model"),
    ("layers/src/models/granier_heidrich/mod.rs", "is the model"),
    ("layers/src/models/lobes/mod.rs", "is the model"),
    ("layers/src/models/microfacet/mod.rs", "is the model"),
    ("layers/src/models/mod.rs", "has the doors of rooms"),
    ("layers/src/models/phong/mod.rs", "is the model"),
    ("layers/src/models/weidlich_wilkie/mod.rs", "is the model"),
    ("layers/src/models/yamaguchi/mod.rs", "is the model"),
    ("layers/src/twins/shaded.rs", "has Elek's mean of slope parameters, and rows of lobes at a place"),
    ("material/src/default_model.rs", "says what keeps a material from the best model"),
    ("material/src/doubt.rs", "says what two models do with a smooth layer below a rough one"),
    ("report/src/models/colored.rs", "takes one facet for the first bounce"),
    ("scene/src/director.rs", "leaves costs out where rows are not baked"),
];

/// Whether code of a file, tests apart, names a single model.
fn names_a_model(text: &str) -> bool {
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
    let mut lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    let single = |rest: &str| {
        let word: String = rest.chars().take_while(|c| c.is_alphanumeric()).collect();
        let model = luthier_manifest::ShadingModel::ALL.into_iter().find(|model| format!("{model:?}") == word);
        model.is_some()
    };
    lines.any(|line| line.split("ShadingModel::").skip(1).any(single))
}

#[test]
fn few_files_name_single_models() {
    let is_test = |name: &str| name.ends_with("/tests.rs") || name.ends_with("_tests.rs");
    let all = sources().into_iter().filter(|(name, _)| !name.starts_with("crates/luthier-lab/") && !is_test(name));
    let found: BTreeSet<String> =
        all.filter(|(_, text)| names_a_model(text)).map(|(name, _)| name.replace("crates/luthier-", "")).collect();
    for name in &found {
        let is_listed = NAMING.iter().any(|(listed, _)| name.starts_with(listed));
        assert!(is_listed, "{name} names single models: ask `ShadingModel::facts`, or say here what it is");
    }
    for (listed, _) in NAMING {
        assert!(found.iter().any(|name| name.starts_with(listed)), "{listed} names no model any more");
    }
}
