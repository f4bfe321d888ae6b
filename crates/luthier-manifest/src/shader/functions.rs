//! Groups of functions that an emitted shader has.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

luthier_lut::named! {
    /// A group of functions of an emitted shader.
    #[derive(Serialize, Deserialize)]
    #[serde(into = "&'static str", try_from = "String")]
    pub enum FunctionGroup("group of functions") {
        /// `luthier_eval`, look-ups, records, places. Every shader has them.
        Eval = "eval",
        /// `luthier_prepare` once for a view, `luthier_light` for each light.
        Light = "light",
        /// `luthier_sample` and `luthier_pdf`; they bring `light`.
        Sample = "sample",
        /// `luthier_propose`: a direction for each lobe, of which a path follows one; it brings `sample`.
        Propose = "propose",
        /// `luthier_albedo`; it brings `light`.
        Albedo = "albedo",
        /// `luthier_environment`, which shows a prefiltered environment; it brings `light`. Lobes of the model `lobes` have eight reads each.
        Environment = "environment",
        /// `environment` with four reads for each lobe.
        Environment4 = "environment-4",
        /// `environment` with two reads for each lobe.
        Environment2 = "environment-2",
        /// `environment` with one read for each lobe.
        Environment1 = "environment-1",
        /// `LuthierPlace` for every material, with the variance of slopes of the normals in a pixel, and the normal of what lies below the
        /// first interface; it brings `light`.
        Surface = "surface",
    }
}

impl FunctionGroup {
    /// Reads of the environment for each lobe; `None` of a group that does not show it.
    pub fn environment_reads(self) -> Option<u32> {
        match self {
            Self::Environment => Some(8),
            Self::Environment4 => Some(4),
            Self::Environment2 => Some(2),
            Self::Environment1 => Some(1),
            Self::Eval | Self::Light | Self::Sample | Self::Propose | Self::Albedo | Self::Surface => None,
        }
    }
}

/// Groups of functions of one shader: `eval` always, others if they were asked for.
///
/// ```
/// use luthier_manifest::{FunctionGroup, Functions};
///
/// let functions: Functions = [FunctionGroup::Propose].into_iter().collect();
/// // A group brings the groups that it calls.
/// assert!(functions.has(FunctionGroup::Sample) && functions.has(FunctionGroup::Light));
/// assert!(!functions.has(FunctionGroup::Albedo) && Functions::default().is_eval_alone());
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Vec<FunctionGroup>", into = "Vec<FunctionGroup>")]
pub struct Functions(BTreeSet<FunctionGroup>);

impl Functions {
    /// Whether a group is there.
    pub fn has(&self, group: FunctionGroup) -> bool {
        self.0.contains(&group)
    }

    /// Reads of the environment for each lobe of the model `lobes`: the fewest of those that were asked for.
    ///
    /// ```
    /// use luthier_manifest::{FunctionGroup, Functions};
    ///
    /// let functions: Functions = [FunctionGroup::Environment4].into_iter().collect();
    /// assert!(functions.has(FunctionGroup::Environment) && functions.environment_reads() == 4);
    /// assert_eq!(Functions::from_iter([FunctionGroup::Environment]).environment_reads(), 8);
    /// ```
    pub fn environment_reads(&self) -> u32 {
        self.0.iter().filter_map(|group| group.environment_reads()).min().unwrap_or(8)
    }

    /// Whether there is no other group than `eval`.
    pub fn is_eval_alone(&self) -> bool {
        self.0.len() == 1
    }
}

impl Default for Functions {
    /// `eval` alone.
    fn default() -> Self {
        Self::from_iter([])
    }
}

impl FromIterator<FunctionGroup> for Functions {
    /// The groups that were asked for, and those that they bring.
    fn from_iter<T: IntoIterator<Item = FunctionGroup>>(asked: T) -> Self {
        let mut groups: BTreeSet<FunctionGroup> = asked.into_iter().collect();
        groups.insert(FunctionGroup::Eval);
        if groups.contains(&FunctionGroup::Propose) {
            groups.insert(FunctionGroup::Sample);
        }
        if groups.iter().any(|group| group.environment_reads().is_some()) {
            groups.insert(FunctionGroup::Environment);
        }
        if groups.len() > 1 {
            groups.insert(FunctionGroup::Light);
        }
        Self(groups)
    }
}

impl From<Vec<FunctionGroup>> for Functions {
    fn from(groups: Vec<FunctionGroup>) -> Self {
        groups.into_iter().collect()
    }
}

impl From<Functions> for Vec<FunctionGroup> {
    fn from(functions: Functions) -> Self {
        functions.0.into_iter().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_bring_what_they_call() {
        let json =
            |groups: &[FunctionGroup]| serde_json::to_string(&groups.iter().copied().collect::<Functions>()).unwrap();
        assert_eq!(json(&[]), r#"["eval"]"#);
        assert_eq!(json(&[FunctionGroup::Light]), r#"["eval","light"]"#);
        assert_eq!(json(&[FunctionGroup::Sample]), r#"["eval","light","sample"]"#);
        assert_eq!(json(&[FunctionGroup::Propose]), r#"["eval","light","sample","propose"]"#);
        assert_eq!(json(&[FunctionGroup::Albedo]), r#"["eval","light","albedo"]"#);
        assert!(Functions::default().is_eval_alone());
        let read: Functions = serde_json::from_str(r#"["sample"]"#).unwrap();
        assert_eq!(read, Functions::from_iter([FunctionGroup::Sample]));
    }
}
