//! Interfaces of shaders against the modules that naga parses.

use luthier_manifest::FunctionGroup;
use luthier_shader::{Form, MaterialSet, Target, emit, interface};
use naga::{Module, TypeInner};

use crate::scenes::{forms, sets, tables};

/// Names of the members of a structure of a module.
fn members<'m>(module: &'m Module, name: &str) -> Vec<&'m str> {
    let (_, found) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).unwrap();
    let TypeInner::Struct { members, .. } = &found.inner else { panic!("{name} is no structure") };
    members.iter().filter_map(|member| member.name.as_deref()).collect()
}

#[test]
fn interfaces_are_those_of_the_modules() {
    let mut filled = 0;
    for (name, materials) in sets() {
        let functions = FunctionGroup::ALL.into_iter().collect();
        let set = MaterialSet { functions, ..MaterialSet::new(&materials, tables()) };
        for form in forms(&materials) {
            let interface = interface(&set, form).unwrap();
            let module = naga::front::wgsl::parse_str(&emit(&set, form, Target::Wgsl).unwrap()).unwrap();
            for entry in &interface.functions {
                let (_, found) = module.functions.iter().find(|(_, f)| f.name.as_ref() == Some(&entry.name)).unwrap();
                assert_eq!(found.arguments.len(), entry.parameters.len(), "{name}: {}", entry.name);
                assert!(found.result.is_some());
            }
            for entry in &interface.structures {
                assert_eq!(members(&module, &entry.name), entry.members, "{name}: {}", entry.name);
                filled += entry.members.len();
            }
            let bound = module.global_variables.iter().filter(|(_, variable)| variable.binding.is_some());
            let bound: Vec<_> = bound.filter_map(|(_, variable)| variable.name.clone()).collect();
            assert_eq!(interface.bindings, bound, "{name}");
            assert!(interface.calls("luthier_eval") && interface.calls("luthier_prepare"), "{name}");
            assert_eq!(interface.calls("luthier_lookup_fresnel"), interface.binds("luthier_fresnel"), "{name}");
            let read = interface.bindings.iter().filter(|name| !name.starts_with("luthier_environment_"));
            let read: Vec<&str> = read.map(String::as_str).filter(|name| *name != "luthier_irradiance_map").collect();
            assert!(form == Form::Baked || read == ["luthier_materials"], "{name}");
        }
    }
    assert!(filled > 0);
}
