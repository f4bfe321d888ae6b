//! The device and its queue: compute passes, read-back, and the faults that wgpu reports outside of calls.

use std::sync::mpsc;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use wgpu::util::{BufferInitDescriptor, DeviceExt};

use crate::GpuError;

/// Longest wait for one submission. A chunk of work takes well under a second on a software adapter; a driver that
/// needs longer than this has hung.
const TIMEOUT: Duration = Duration::from_secs(120);

/// Usage of a buffer that a kernel fills.
const WRITTEN: wgpu::BufferUsages = wgpu::BufferUsages::STORAGE.union(wgpu::BufferUsages::COPY_SRC);

/// Usage of a buffer that is read on the host.
const READABLE: wgpu::BufferUsages = wgpu::BufferUsages::MAP_READ.union(wgpu::BufferUsages::COPY_DST);

/// A device, its queue, and the faults that it reported outside any call.
#[derive(Debug, Clone)]
pub(crate) struct Context {
    pub(crate) device: wgpu::Device,
    queue: wgpu::Queue,
    faults: Arc<Faults>,
    /// Factor on the work of one submission: 1 on an adapter whose speed is unknown.
    pub(crate) batch: u32,
    /// Outputs of timed passes, which are not read: one buffer for all, the largest so far.
    unread: Arc<Mutex<Option<wgpu::Buffer>>>,
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
    pub(crate) fn new(device: wgpu::Device, queue: wgpu::Queue, batch: u32) -> Self {
        let faults = Arc::new(Faults::default());
        let lost = Arc::clone(&faults);
        device.set_device_lost_callback(move |reason, message| {
            put(&lost.lost, format!("{reason:?} {message}"));
        });
        let uncaptured = Arc::clone(&faults);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            put(&uncaptured.uncaptured, error.to_string());
        }));
        Self { device, queue, faults, batch, unread: Arc::default() }
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
            Some(error) => Err(refused(what, chain(&error))),
            None => self.check(what).map(|()| value),
        }
    }

    /// Fails if the device was lost, or reported an error outside any error scope.
    fn check(&self, what: &str) -> Result<(), GpuError> {
        if let Some(reason) = get(&self.faults.lost) {
            return Err(GpuError::Lost(reason));
        }
        match get(&self.faults.uncaptured) {
            Some(message) => Err(refused(what, message)),
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

    fn buffer(&self, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let label = Some(label);
        self.device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false })
    }

    /// Group 1 of a kernel.
    fn kernel_group(
        &self,
        pipeline: &wgpu::ComputePipeline,
        inputs: &wgpu::Buffer,
        outputs: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("kernel"),
            layout: &pipeline.get_bind_group_layout(1),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: inputs.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: outputs.as_entire_binding() },
            ],
        })
    }

    /// Fills a level of a face of a cube.
    pub(crate) fn upload_face(&self, texture: &wgpu::Texture, level: u32, face: u32, bytes: &[u8]) {
        let size = (texture.width() >> level).max(1);
        let origin = wgpu::Origin3d { x: 0, y: 0, z: face };
        let rows = bytes.len() as u32 / size;
        self.queue.write_texture(
            wgpu::TexelCopyTextureInfo { mip_level: level, origin, ..texture.as_image_copy() },
            bytes,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(rows), rows_per_image: None },
            wgpu::Extent3d { width: size, height: size, depth_or_array_layers: 1 },
        );
    }

    /// Runs a pass and waits for its output.
    pub(crate) fn run(&self, pass: &Pass<'_>) -> Result<Vec<[f32; 4]>, GpuError> {
        let bytes = (pass.output_words * size_of::<[f32; 4]>()) as u64;
        let (readback, submission) = self.guarded(pass.what, || self.submit(pass, bytes))?;

        self.read(pass.what, &readback, submission)
    }

    /// Waits for a submission and reads a buffer that it filled.
    fn read<T: bytemuck::Pod>(
        &self,
        what: &str,
        readback: &wgpu::Buffer,
        submission: wgpu::SubmissionIndex,
    ) -> Result<Vec<T>, GpuError> {
        let (sender, receiver) = mpsc::channel();
        self.guarded(what, || {
            readback.map_async(wgpu::MapMode::Read, .., move |result| {
                // The receiver lives until the answer is there or no longer wanted.
                let _ = sender.send(result);
            });
        })?;
        let wait = wgpu::PollType::Wait { submission_index: Some(submission), timeout: Some(TIMEOUT) };
        match self.device.poll(wait) {
            Ok(_) => {}
            Err(wgpu::PollError::Timeout) => return Err(GpuError::Timeout { seconds: TIMEOUT.as_secs() }),
            Err(error) => return Err(refused(what, error)),
        }
        self.check(what)?;
        // A thread that polls at that time may be the one that has the answer, and has yet to send it.
        match receiver.recv_timeout(TIMEOUT) {
            Ok(Ok(())) => {}
            Ok(Err(error)) => return Err(refused(what, error)),
            Err(mpsc::RecvTimeoutError::Timeout) => return Err(GpuError::Timeout { seconds: TIMEOUT.as_secs() }),
            Err(mpsc::RecvTimeoutError::Disconnected) => return Err(refused(what, "the result was never mapped")),
        }
        let view = readback.get_mapped_range(..).map_err(|error| refused(what, error))?;
        let words = bytemuck::pod_collect_to_vec::<u8, T>(&view);
        drop(view);
        readback.unmap();
        Ok(words)
    }

    fn submit(&self, pass: &Pass<'_>, bytes: u64) -> (wgpu::Buffer, wgpu::SubmissionIndex) {
        let inputs = self.upload("kernel_inputs", pass.inputs);
        let outputs = self.buffer("kernel_outputs", bytes, WRITTEN);
        let readback = self.buffer("readback", bytes, READABLE);
        let kernel_group = self.kernel_group(pass.pipeline, &inputs, &outputs);
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

/// Buffers of a pass that is timed. Its outputs are not read.
#[derive(Debug)]
pub(crate) struct TimedPass {
    group: wgpu::BindGroup,
    /// A pair of timestamps, the buffer that they are resolved to, and one to read; `None` if the device has no timestamps.
    clock: Option<(wgpu::QuerySet, wgpu::Buffer, wgpu::Buffer)>,
    /// The outputs: without timestamps, their first word is read to wait for the pass.
    outputs: wgpu::Buffer,
    last: wgpu::Buffer,
}

impl TimedPass {
    pub(crate) fn has_timestamps(&self) -> bool {
        self.clock.is_some()
    }
}

/// Bytes of a pair of timestamps, and of one word of outputs.
const STAMPS: u64 = 16;

impl Context {
    /// A buffer of at least so many bytes for outputs that are not read.
    fn unread(&self, bytes: u64) -> wgpu::Buffer {
        let mut unread = self.unread.lock().unwrap_or_else(PoisonError::into_inner);
        match unread.as_ref().filter(|buffer| buffer.size() >= bytes) {
            Some(buffer) => buffer.clone(),
            None => unread.insert(self.buffer("kernel_outputs", bytes, WRITTEN)).clone(),
        }
    }

    pub(crate) fn timed_pass(
        &self,
        pipeline: &wgpu::ComputePipeline,
        inputs: &[u8],
        output_words: usize,
    ) -> Result<TimedPass, GpuError> {
        self.guarded("timing", || {
            let inputs = self.upload("kernel_inputs", inputs);
            let bytes = (output_words * size_of::<[f32; 4]>()) as u64;
            let outputs = self.unread(bytes);
            let group = self.kernel_group(pipeline, &inputs, &outputs);
            let clock = self.device.features().contains(wgpu::Features::TIMESTAMP_QUERY).then(|| {
                let queries = self.device.create_query_set(&wgpu::QuerySetDescriptor {
                    label: Some("clock"),
                    ty: wgpu::QueryType::Timestamp,
                    count: 2,
                });
                let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
                let resolved = self.buffer("clock", STAMPS, usage);
                (queries, resolved, self.buffer("clock readback", STAMPS, READABLE))
            });
            let last = self.buffer("readback", STAMPS, READABLE);
            TimedPass { group, clock, outputs, last }
        })
    }

    /// Runs a pass and waits for it: its nanoseconds by the device's clock, if that has one.
    pub(crate) fn run_timed(
        &self,
        pass: &TimedPass,
        pipeline: &wgpu::ComputePipeline,
        shader_group: &wgpu::BindGroup,
        workgroups: u32,
    ) -> Result<Option<f64>, GpuError> {
        let submission = self.guarded("timing", || {
            let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            {
                let timestamp_writes = pass.clock.as_ref().map(|(queries, ..)| wgpu::ComputePassTimestampWrites {
                    query_set: queries,
                    beginning_of_pass_write_index: Some(0),
                    end_of_pass_write_index: Some(1),
                });
                let mut compute =
                    encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("timed"), timestamp_writes });
                compute.set_pipeline(pipeline);
                compute.set_bind_group(0, shader_group, &[]);
                compute.set_bind_group(1, &pass.group, &[]);
                compute.dispatch_workgroups(workgroups, 1, 1);
            }
            match &pass.clock {
                Some((queries, resolved, readback)) => {
                    encoder.resolve_query_set(queries, 0..2, resolved, 0);
                    encoder.copy_buffer_to_buffer(resolved, 0, readback, 0, STAMPS);
                }
                None => encoder.copy_buffer_to_buffer(&pass.outputs, 0, &pass.last, 0, STAMPS),
            }
            self.queue.submit([encoder.finish()])
        })?;
        let Some((_, _, readback)) = &pass.clock else {
            return self.read::<f32>("timing", &pass.last, submission).map(|_| None);
        };
        let stamps: Vec<u64> = self.read("timing", readback, submission)?;
        let ticks = stamps.last().copied().unwrap_or(0).wrapping_sub(stamps.first().copied().unwrap_or(0));
        Ok(Some(ticks as f64 * f64::from(self.queue.get_timestamp_period())))
    }
}

/// Keeps the first message only: later faults follow from the first.
fn put(slot: &Mutex<Option<String>>, message: String) {
    slot.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(message);
}

fn get(slot: &Mutex<Option<String>>) -> Option<String> {
    slot.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

fn refused(what: &str, message: impl ToString) -> GpuError {
    GpuError::Refused { what: what.to_owned(), message: message.to_string() }
}

/// A `vec4` word of a kernel's buffer.
pub(crate) fn word([x, y, z]: [f32; 3], w: f32) -> [f32; 4] {
    [x, y, z, w]
}

/// The message of an error; for validation wgpu puts the whole chain of causes into it.
fn chain(error: &wgpu::Error) -> String {
    error.to_string().trim_end().to_owned()
}
