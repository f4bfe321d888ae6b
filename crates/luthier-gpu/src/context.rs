use std::sync::mpsc;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use wgpu::util::{BufferInitDescriptor, DeviceExt};

use crate::GpuError;

/// Longest wait for one submission. A chunk of work takes well under a second on a software adapter; a driver that
/// needs longer than this has hung.
const TIMEOUT: Duration = Duration::from_secs(120);

/// A device, its queue, and what went wrong outside any call that could say so.
#[derive(Debug, Clone)]
pub(crate) struct Context {
    pub(crate) device: wgpu::Device,
    queue: wgpu::Queue,
    faults: Arc<Faults>,
}

#[derive(Debug, Default)]
struct Faults {
    lost: Mutex<Option<String>>,
    uncaptured: Mutex<Option<String>>,
}

/// A compute pass whose only result is one buffer.
pub(crate) struct Pass<'a> {
    pub(crate) what: &'a str,
    pub(crate) pipeline: &'a wgpu::ComputePipeline,
    /// Group 0.
    pub(crate) shader_group: &'a wgpu::BindGroup,
    pub(crate) workgroups: [u32; 2],
    /// Bytes of `kernel_inputs`.
    pub(crate) inputs: &'a [u8],
    /// `vec4` words of `kernel_outputs`.
    pub(crate) output_words: usize,
}

impl Context {
    pub(crate) fn new(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let faults = Arc::new(Faults::default());
        let lost = Arc::clone(&faults);
        device.set_device_lost_callback(move |reason, message| {
            put(&lost.lost, format!("{reason:?} {message}"));
        });
        let uncaptured = Arc::clone(&faults);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            put(&uncaptured.uncaptured, error.to_string());
        }));
        Self { device, queue, faults }
    }

    /// Runs calls that create or submit things, and turns the errors that the device reports meanwhile into ours.
    pub(crate) fn guarded<T>(&self, what: &str, calls: impl FnOnce() -> T) -> Result<T, GpuError> {
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let internal = self.device.push_error_scope(wgpu::ErrorFilter::Internal);
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let value = calls();
        let found = [
            pollster::block_on(validation.pop()),
            pollster::block_on(internal.pop()),
            pollster::block_on(memory.pop()),
        ];
        match found.into_iter().flatten().next() {
            Some(wgpu::Error::OutOfMemory { .. }) => Err(GpuError::OutOfMemory { what: what.to_owned() }),
            Some(error) => Err(GpuError::Refused { what: what.to_owned(), message: chain(&error) }),
            None => self.check(what).map(|()| value),
        }
    }

    /// Fails when the device was lost or complained where nobody listened.
    fn check(&self, what: &str) -> Result<(), GpuError> {
        if let Some(reason) = get(&self.faults.lost) {
            return Err(GpuError::Lost(reason));
        }
        match get(&self.faults.uncaptured) {
            Some(message) => Err(GpuError::Refused { what: what.to_owned(), message }),
            None => Ok(()),
        }
    }

    pub(crate) fn upload(&self, label: &str, contents: &[u8]) -> wgpu::Buffer {
        self.device.create_buffer_init(&BufferInitDescriptor {
            label: Some(label),
            contents,
            usage: wgpu::BufferUsages::STORAGE,
        })
    }

    pub(crate) fn upload_texels(&self, texture: &wgpu::Texture, bytes: &[u8], bytes_per_row: u32) {
        self.queue.write_texture(
            texture.as_image_copy(),
            bytes,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(bytes_per_row), rows_per_image: None },
            texture.size(),
        );
    }

    /// Runs a pass and waits for its output.
    pub(crate) fn run(&self, pass: &Pass<'_>) -> Result<Vec<[f32; 4]>, GpuError> {
        let bytes = (pass.output_words * size_of::<[f32; 4]>()) as u64;
        let (readback, submission) = self.guarded(pass.what, || self.submit(pass, bytes))?;

        let (sender, receiver) = mpsc::channel();
        self.guarded(pass.what, || {
            readback.map_async(wgpu::MapMode::Read, .., move |result| {
                // The receiver lives until the answer is there or no longer wanted.
                let _ = sender.send(result);
            });
        })?;
        let wait = wgpu::PollType::Wait { submission_index: Some(submission), timeout: Some(TIMEOUT) };
        match self.device.poll(wait) {
            Ok(_) => {}
            Err(wgpu::PollError::Timeout) => return Err(GpuError::Timeout { seconds: TIMEOUT.as_secs() }),
            Err(error) => return Err(GpuError::Refused { what: pass.what.to_owned(), message: error.to_string() }),
        }
        self.check(pass.what)?;
        let refused = |message: String| GpuError::Refused { what: pass.what.to_owned(), message };
        match receiver.try_recv() {
            Ok(Ok(())) => {}
            Ok(Err(error)) => return Err(refused(error.to_string())),
            Err(_) => return Err(refused("the result was never mapped".to_owned())),
        }
        let view = readback.get_mapped_range(..).map_err(|error| refused(error.to_string()))?;
        let words = bytemuck::pod_collect_to_vec::<u8, [f32; 4]>(&view);
        drop(view);
        readback.unmap();
        Ok(words)
    }

    fn submit(&self, pass: &Pass<'_>, bytes: u64) -> (wgpu::Buffer, wgpu::SubmissionIndex) {
        let inputs = self.upload("kernel_inputs", pass.inputs);
        let outputs = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("kernel_outputs"),
            size: bytes,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let readback = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: bytes,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let kernel_group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("kernel"),
            layout: &pass.pipeline.get_bind_group_layout(1),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: inputs.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: outputs.as_entire_binding() },
            ],
        });
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut compute = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            compute.set_pipeline(pass.pipeline);
            compute.set_bind_group(0, pass.shader_group, &[]);
            compute.set_bind_group(1, &kernel_group, &[]);
            compute.dispatch_workgroups(pass.workgroups[0], pass.workgroups[1], 1);
        }
        encoder.copy_buffer_to_buffer(&outputs, 0, &readback, 0, bytes);
        let submission = self.queue.submit([encoder.finish()]);
        (readback, submission)
    }
}

/// Keeps the first message only: the rest follows from it.
fn put(slot: &Mutex<Option<String>>, message: String) {
    slot.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(message);
}

fn get(slot: &Mutex<Option<String>>) -> Option<String> {
    slot.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

/// The message of an error; for validation wgpu puts the whole chain of causes into it.
fn chain(error: &wgpu::Error) -> String {
    error.to_string().trim_end().to_owned()
}
