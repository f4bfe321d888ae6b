//! Calls of Vulkan: the only `unsafe` of the workspace.
#![expect(unsafe_code, reason = "Vulkan is a C interface")]

use std::collections::BTreeMap;
use std::ffi::{CStr, c_char};

use ash::khr::pipeline_executable_properties as executables;
use ash::vk;

use crate::code::Code;
use crate::{Compiled, CostError, Counts, Family, Kernel, Resource};

/// Compiles kernels on the null device that the environment of this process asks for; see
/// [`Family::environment`].
///
/// # Errors
/// [`CostError::NoDriver`] if there is no loader or no RADV; [`CostError::Vulkan`] when the driver refuses a kernel.
pub fn compile(family: Family, kernels: &[Kernel]) -> Result<Compiled, CostError> {
    let device = NullDevice::open()?;
    let counts = kernels.iter().map(|kernel| device.pipeline(kernel)?.counts(family)).collect::<Result<_, _>>()?;
    Ok(Compiled { driver: device.driver.clone(), device: device.name.clone(), counts })
}

/// The machine code of a kernel as text.
///
/// # Errors
/// As [`compile`].
pub fn assembly(kernel: &Kernel) -> Result<String, CostError> {
    NullDevice::open()?.pipeline(kernel)?.assembly()
}

/// A device without hardware.
struct NullDevice {
    /// The loader stays until everything else is gone.
    _entry: ash::Entry,
    instance: ash::Instance,
    device: ash::Device,
    executables: executables::Device,
    driver: String,
    name: String,
}

impl NullDevice {
    fn open() -> Result<Self, CostError> {
        // SAFETY: the library is a Vulkan loader by its name; it stays loaded as long as the entry lives.
        let entry =
            unsafe { ash::Entry::load() }.map_err(|_| CostError::NoDriver("no Vulkan loader was found".to_owned()))?;
        let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_2);
        let create = vk::InstanceCreateInfo::default().application_info(&application);
        // SAFETY: the structure and what it points to live through the call.
        let instance = match unsafe { entry.create_instance(&create, None) } {
            Ok(instance) => instance,
            Err(vk::Result::ERROR_INCOMPATIBLE_DRIVER) => return Err(no_radv()),
            Err(result) => return Err(failed("cannot open Vulkan", result)),
        };
        match Self::of_instance(&instance) {
            Ok((device, driver, name)) => {
                let executables = executables::Device::new(&instance, &device);
                Ok(Self { _entry: entry, instance, device, executables, driver, name })
            }
            Err(error) => {
                // SAFETY: nothing was made of it that is still there.
                unsafe { instance.destroy_instance(None) };
                Err(error)
            }
        }
    }

    fn of_instance(instance: &ash::Instance) -> Result<(ash::Device, String, String), CostError> {
        // SAFETY: the instance lives.
        let found = unsafe { instance.enumerate_physical_devices() };
        for physical in found.map_err(|result| failed("cannot list the devices of Vulkan", result))? {
            let mut driver = vk::PhysicalDeviceDriverProperties::default();
            let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
            // SAFETY: the device was listed by this instance, of version 1.1 or later.
            unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
            let name = text(&properties.properties.device_name);
            if driver.driver_id != vk::DriverId::MESA_RADV {
                continue;
            }
            let mut wanted =
                vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default().pipeline_executable_info(true);
            let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(0).queue_priorities(&[1.0])];
            let extensions = [executables::NAME.as_ptr()];
            let create = vk::DeviceCreateInfo::default()
                .queue_create_infos(&queues)
                .enabled_extension_names(&extensions)
                .push_next(&mut wanted);
            // SAFETY: the structures live through the call; every device has a first family of queues.
            let device = unsafe { instance.create_device(physical, &create, None) }
                .map_err(|result| failed("cannot open the null device", result))?;
            return Ok((device, format!("{} {}", text(&driver.driver_name), text(&driver.driver_info)), name));
        }
        Err(no_radv())
    }

    fn pipeline(&self, kernel: &Kernel) -> Result<Pipeline<'_>, CostError> {
        let mut pipeline =
            Pipeline { of: self, sets: Vec::new(), layout: vk::PipelineLayout::null(), pipeline: vk::Pipeline::null() };
        let groups = kernel.bindings.iter().map(|b| b.group + 1).max().unwrap_or(0);
        for group in 0..groups {
            let here: Vec<vk::DescriptorSetLayoutBinding<'_>> = kernel
                .bindings
                .iter()
                .filter(|b| b.group == group)
                .map(|b| {
                    vk::DescriptorSetLayoutBinding::default()
                        .binding(b.binding)
                        .descriptor_type(descriptor(b.resource))
                        .descriptor_count(1)
                        .stage_flags(vk::ShaderStageFlags::COMPUTE)
                })
                .collect();
            let create = vk::DescriptorSetLayoutCreateInfo::default().bindings(&here);
            // SAFETY: the structures live through the call.
            let set = unsafe { self.device.create_descriptor_set_layout(&create, None) };
            pipeline.sets.push(set.map_err(|result| failed("cannot describe the bindings", result))?);
        }
        let create = vk::PipelineLayoutCreateInfo::default().set_layouts(&pipeline.sets);
        // SAFETY: the sets are of this device and live.
        pipeline.layout = unsafe { self.device.create_pipeline_layout(&create, None) }
            .map_err(|result| failed("cannot describe the bindings", result))?;

        let create = vk::ShaderModuleCreateInfo::default().code(&kernel.spirv);
        // SAFETY: naga wrote and validated the words.
        let module = unsafe { self.device.create_shader_module(&create, None) }
            .map_err(|result| failed("the driver refuses the kernel", result))?;
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module)
            .name(c"harness");
        let create = vk::ComputePipelineCreateInfo::default()
            .flags(
                vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR
                    | vk::PipelineCreateFlags::CAPTURE_INTERNAL_REPRESENTATIONS_KHR,
            )
            .stage(stage)
            .layout(pipeline.layout);
        // SAFETY: module and layout are of this device and live; the layout has all that the kernel names.
        let made = unsafe { self.device.create_compute_pipelines(vk::PipelineCache::null(), &[create], None) };
        // SAFETY: a pipeline does not need its module any longer.
        unsafe { self.device.destroy_shader_module(module, None) };
        match made {
            Ok(pipelines) => {
                pipeline.pipeline = pipelines.first().copied().unwrap_or_default();
                Ok(pipeline)
            }
            Err((_, result)) => Err(failed("the driver cannot compile the kernel", result)),
        }
    }
}

impl Drop for NullDevice {
    fn drop(&mut self) {
        // SAFETY: pipelines borrow the device, so that none is left.
        unsafe {
            self.device.destroy_device(None);
            self.instance.destroy_instance(None);
        }
    }
}

/// A kernel, compiled.
struct Pipeline<'a> {
    of: &'a NullDevice,
    sets: Vec<vk::DescriptorSetLayout>,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
}

impl Pipeline<'_> {
    fn counts(&self, family: Family) -> Result<Counts, CostError> {
        let executable = vk::PipelineExecutableInfoKHR::default().pipeline(self.pipeline);
        // SAFETY: the pipeline lives and was made with the flag for statistics; a compute pipeline has one executable.
        let found = unsafe { self.of.executables.get_pipeline_executable_statistics(&executable) };
        let found = found.map_err(|result| failed("the driver gives no statistics", result))?;
        let statistics: BTreeMap<String, i64> = found.iter().map(|s| (text(&s.name), value(s))).collect();
        let get = |name: &'static str| {
            statistics.get(name).copied().ok_or_else(|| no_statistic(name, statistics.keys().cloned()))
        };
        let code = Code::of(&self.assembly()?);
        Ok(Counts {
            instructions: get("Instructions")?,
            inverse_throughput: get("Inverse Throughput")?,
            latency: get("Latency")?,
            issue_cycles: code.issue_cycles(family),
            vgprs: get("VGPRs")?,
            waves: get("Subgroups per SIMD")?,
            code_bytes: get("Code size")?,
            spills: get("Spilled VGPRs")? + get("Spilled SGPRs")?,
            texture_reads: code.texture_reads,
            buffer_reads: code.buffer_reads,
            branches: get("Branches")?,
        })
    }

    /// The internal representation that RADV calls `Assembly`.
    fn assembly(&self) -> Result<String, CostError> {
        let executable = vk::PipelineExecutableInfoKHR::default().pipeline(self.pipeline);
        let call = self.of.executables.fp().get_pipeline_executable_internal_representations_khr;
        let mut count = 0;
        // SAFETY: with no array the call only counts.
        let result = unsafe { call(self.of.device.handle(), &executable, &mut count, std::ptr::null_mut()) };
        result.result().map_err(|result| failed("the driver gives no machine code", result))?;
        let mut found = vec![vk::PipelineExecutableInternalRepresentationKHR::default(); count as usize];
        // SAFETY: the array has the length that was asked for; without data it is given the names and sizes.
        let result = unsafe { call(self.of.device.handle(), &executable, &mut count, found.as_mut_ptr()) };
        result.result().map_err(|result| failed("the driver gives no machine code", result))?;
        let mut texts: Vec<Vec<u8>> = found.iter().map(|r| vec![0; r.data_size]).collect();
        for (representation, text) in found.iter_mut().zip(&mut texts) {
            representation.p_data = text.as_mut_ptr().cast();
        }
        // SAFETY: every pointer has as many bytes behind it as the driver asked for.
        let result = unsafe { call(self.of.device.handle(), &executable, &mut count, found.as_mut_ptr()) };
        result.result().map_err(|result| failed("the driver gives no machine code", result))?;
        let names = found.iter().map(|r| text(&r.name));
        let code = names.zip(texts).find(|(name, _)| name == "Assembly").map(|(_, text)| text);
        let code = code.ok_or_else(|| no_statistic("Assembly", found.iter().map(|r| text(&r.name))))?;
        Ok(String::from_utf8_lossy(&code).trim_end_matches('\0').to_owned())
    }
}

impl Drop for Pipeline<'_> {
    fn drop(&mut self) {
        let device = &self.of.device;
        // SAFETY: made by this device, used by nobody else; null is allowed.
        unsafe {
            device.destroy_pipeline(self.pipeline, None);
            device.destroy_pipeline_layout(self.layout, None);
            for &set in &self.sets {
                device.destroy_descriptor_set_layout(set, None);
            }
        }
    }
}

fn descriptor(resource: Resource) -> vk::DescriptorType {
    match resource {
        Resource::Texture => vk::DescriptorType::SAMPLED_IMAGE,
        Resource::Sampler => vk::DescriptorType::SAMPLER,
        Resource::Storage => vk::DescriptorType::STORAGE_BUFFER,
        Resource::Uniform => vk::DescriptorType::UNIFORM_BUFFER,
    }
}

fn value(statistic: &vk::PipelineExecutableStatisticKHR<'_>) -> i64 {
    // SAFETY: the format says which member of the union is there.
    unsafe {
        match statistic.format {
            vk::PipelineExecutableStatisticFormatKHR::BOOL32 => i64::from(statistic.value.b32),
            vk::PipelineExecutableStatisticFormatKHR::INT64 => statistic.value.i64,
            vk::PipelineExecutableStatisticFormatKHR::UINT64 => statistic.value.u64 as i64,
            _ => statistic.value.f64 as i64,
        }
    }
}

/// A text from an array of fixed size.
fn text(characters: &[c_char]) -> String {
    let bytes: Vec<u8> = characters.iter().map(|&c| c as u8).collect();
    CStr::from_bytes_until_nul(&bytes).map_or_else(|_| String::new(), |text| text.to_string_lossy().into_owned())
}

fn no_statistic(name: &'static str, known: impl Iterator<Item = String>) -> CostError {
    CostError::NoStatistic { name, known: known.collect::<Vec<_>>().join(", ") }
}

fn no_radv() -> CostError {
    CostError::NoDriver("the Vulkan loader finds none".to_owned())
}

fn failed(what: &str, result: vk::Result) -> CostError {
    CostError::Vulkan { what: what.to_owned(), result }
}
