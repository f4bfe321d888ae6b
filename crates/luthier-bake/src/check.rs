//! Checks of a set of materials before anything is computed.

use std::collections::BTreeMap;

use luthier_material::Material;

use crate::options::{Options, budget};
use crate::{BakeError, planner};

/// Refuses a set of materials for its names, settings and limits, before anything is computed. Images are not read.
///
/// # Errors
/// All that is wrong, at least one.
pub fn check(materials: &[Material], options: &Options<'_>) -> Result<(), Vec<BakeError>> {
    let mut errors = Vec::new();
    if materials.is_empty() {
        errors.push(BakeError::Empty);
    }
    let mut named: BTreeMap<&str, &Material> = BTreeMap::new();
    for (number, material) in materials.iter().enumerate() {
        if let Some(first) = named.get(material.name.as_str()) {
            let (name, first, second) = (material.name.clone(), first.place("name"), material.place("name"));
            errors.push(BakeError::DuplicateName { material: number, name, first, second });
        } else {
            named.insert(&material.name, material);
        }
    }
    errors.extend(planner::settings(materials).err());
    errors.extend(budget(materials, &options.budget).err());
    let limits = [("max_lobe_err", options.budget.max_lobe_err), ("max_albedo_err", options.budget.max_albedo_err)];
    if let Some((name, _)) = limits.into_iter().find(|(_, limit)| limit.is_some())
        && materials.iter().all(|material| !material.model().is_fitted())
    {
        errors.push(BakeError::NoLobes { name });
    }
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}
