use luthier_gpu::{Gpu, GpuError};

/// The device under test. Without an adapter, a test fails where the environment variable `CI` is set, and is skipped
/// with a note elsewhere.
pub(crate) fn gpu() -> Option<Gpu> {
    match Gpu::open() {
        Ok(gpu) => Some(gpu),
        Err(error @ GpuError::NoAdapter) if std::env::var_os("CI").is_none() => {
            eprintln!("skipped: {error}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn the_device_says_what_it_is() {
    let Some(gpu) = gpu() else { return };
    assert!(!gpu.adapter_name().is_empty());
    assert!(["vulkan", "metal", "dx12", "gl"].contains(&gpu.backend().as_str()), "{}", gpu.backend());
    eprintln!("{} / {} / {} / software {}", gpu.adapter_name(), gpu.driver(), gpu.backend(), gpu.is_software());
}

#[test]
fn adapters_are_chosen_by_part_of_their_name() {
    let Some(gpu) = gpu() else { return };
    let name = gpu.adapter_name();
    assert_eq!(Gpu::open_named(&name.to_uppercase()).unwrap().adapter_name(), name);
    let error = Gpu::open_named("no such thing").unwrap_err();
    assert!(matches!(&error, GpuError::NoSuchAdapter { found, .. } if found.contains(&name)), "{error}");
}

#[test]
fn no_adapter_says_what_to_install() {
    assert!(GpuError::NoAdapter.to_string().contains("mesa-vulkan-drivers"));
}
