//! Samples: for each key that can be seen a material, and values of the key; for each other key the reason why there is nothing to see.

mod bake;
mod effects;
mod layers;
mod surfaces;
mod textures;
mod unseen;

pub(crate) use unseen::UNSEEN;

/// Values of a key, and a material that shows them.
#[derive(Clone, Copy)]
pub(crate) struct Sample {
    /// The key, as `table.key`.
    pub(crate) key: &'static str,
    /// Key of the file that `luthier_material::LeftOut` states if a model leaves the feature out; or several, with bars.
    pub(crate) at: &'static str,
    /// The file without `schema` and `name`; `@` is the place of the value, `%` of the root of the repository.
    pub(crate) text: &'static str,
    /// Three values, or all if there are fewer. The name on the page stands before a bar, if it differs from the text.
    pub(crate) values: &'static [&'static str],
}

impl Sample {
    /// The names of the values.
    pub(crate) fn labels(&self) -> impl Iterator<Item = &'static str> {
        self.values.iter().map(|value| value.split_once('|').map_or(*value, |(label, _)| label))
    }

    /// Everything that decides the picture.
    pub(crate) fn hashed(&self) -> String {
        format!("{}\n{}", self.text, self.values.join("\n"))
    }

    /// The texts of the files, one for each value.
    pub(crate) fn texts(&self) -> Vec<String> {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
        let kind = if self.is_surface() { "surface" } else { "schema" };
        let texts = self.values.iter().map(|value| {
            let value = value.split_once('|').map_or(*value, |(_, text)| text);
            let text = self.text.replace('@', value).replace('%', root);
            format!("{kind} = 1\nname = \"sample\"\n{text}\n")
        });
        texts.collect()
    }

    /// Whether the file is one of a surface.
    pub(crate) fn is_surface(&self) -> bool {
        self.key.starts_with("surface")
    }

    /// Name of the picture.
    pub(crate) fn picture(&self) -> String {
        format!("{}.png", self.key.replace(['.', '_'], "-"))
    }
}

/// All samples.
pub(crate) fn samples() -> Vec<Sample> {
    [layers::SAMPLES.as_slice(), &textures::SAMPLES, &effects::SAMPLES, &bake::SAMPLES, &surfaces::SAMPLES].concat()
}

const fn sample(key: &'static str, at: &'static str, text: &'static str, values: &'static [&'static str]) -> Sample {
    Sample { key, at, text, values }
}
