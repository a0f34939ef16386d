//! A device with its pipelines, and what went wrong with it.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::adapter::{self, GpuError, GpuOptions};
use super::present::GpuContext;
use super::reload::{ShaderFolder, Sources};
use super::stage::{Access, Stage};
use super::variant::Variant;
use crate::engine::EngineError;

/// What a driver told us out of turn.
#[derive(Default)]
struct Faults {
    lost: Option<String>,
    out_of_memory: Option<String>,
    other: Option<String>,
}

/// An open device.
pub struct Device {
    pub name: String,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub limits: wgpu::Limits,
    /// Whether stages can be timed.
    pub timed: bool,
    /// Whether somebody else waits for it while it renders: software that a window is drawn by as
    /// well. What hardware does in a millisecond takes it a tenth of a second, in which a window would
    /// stand still; so it is given a frame in small parts, each after the one before is done.
    pub takes_turns: bool,
    faults: Arc<Mutex<Faults>>,
    /// Where shaders are read anew from.
    folder: Option<ShaderFolder>,
    /// What the pipelines are made of.
    sources: Arc<Sources>,
    /// What was last looked at; other than `sources` where the device refused it.
    seen: Arc<Sources>,
    pipelines: BTreeMap<(Stage, Variant), wgpu::ComputePipeline>,
}

impl Device {
    /// Opens the adapter that the options name.
    pub fn open(options: &GpuOptions) -> Result<Self, GpuError> {
        let instance = adapter::instance();
        let adapter = adapter::choose(&instance, options)?;
        let name = adapter.get_info().name;
        let mut wanted = GpuContext::descriptor(&adapter);
        if options.minimum_limits {
            wanted.required_limits = wgpu::Limits::defaults();
        }
        let (device, queue) = adapter::block_on(adapter.request_device(&wanted))
            .map_err(|e| GpuError::Refused { adapter: name.clone(), reason: e.to_string() })?;
        Ok(Self::watched(name, device, queue, options.shaders.clone(), false))
    }

    /// A device that somebody else opened.
    pub fn given(context: GpuContext) -> Self {
        let GpuContext { name, hardware, device, queue, shaders } = context;
        Self::watched(name, device, queue, shaders, !hardware)
    }

    /// An open device, whose faults are written down from now on.
    fn watched(
        name: String,
        device: wgpu::Device,
        queue: wgpu::Queue,
        folder: Option<ShaderFolder>,
        takes_turns: bool,
    ) -> Self {
        let faults = Arc::new(Mutex::new(Faults::default()));
        watch(&device, &faults);
        let limits = device.limits();
        let timed = device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let sources = folder.as_ref().map(ShaderFolder::sources).unwrap_or_default();
        let seen = Arc::clone(&sources);
        let pipelines = BTreeMap::new();
        Self {
            name,
            device,
            queue,
            limits,
            timed,
            takes_turns,
            faults,
            folder,
            sources,
            seen,
            pipelines,
        }
    }

    /// Whether the device went away.
    pub fn lost(&self) -> Option<String> {
        self.faults.lock().unwrap_or_else(PoisonError::into_inner).lost.clone()
    }

    /// What went wrong since the last call, if anything did.
    pub fn fault(&self) -> Result<(), EngineError> {
        let mut faults = self.faults.lock().unwrap_or_else(PoisonError::into_inner);
        let adapter = self.name.clone();
        if let Some(reason) = faults.lost.clone() {
            return Err(EngineError::DeviceLost { adapter, reason });
        }
        if let Some(what) = faults.out_of_memory.take() {
            return Err(EngineError::OutOfMemory { adapter, what });
        }
        match faults.other.take() {
            Some(reason) => Err(EngineError::Driver { adapter, reason }),
            None => Ok(()),
        }
    }

    /// What went wrong, which is this where nothing worse was heard of.
    pub fn failed(&self, reason: String) -> EngineError {
        let adapter = self.name.clone();
        self.fault().err().unwrap_or(EngineError::Driver { adapter, reason })
    }

    /// Largest buffer that shaders can be given, bytes.
    pub fn largest_buffer(&self) -> u64 {
        self.limits.max_storage_buffer_binding_size.min(self.limits.max_buffer_size)
    }

    /// The pipeline of a stage in a form; compiled when first asked for.
    pub fn pipeline(&mut self, stage: Stage, variant: Variant) -> &wgpu::ComputePipeline {
        let variant = variant.of(stage);
        let (device, sources, folder) = (&self.device, &self.sources, &self.folder);
        self.pipelines.entry((stage, variant)).or_insert_with(|| {
            let Some(folder) = folder.as_ref().filter(|_| !sources.are_own()) else {
                return compile(device, stage, variant, sources);
            };
            try_compile(device, stage, variant, sources).unwrap_or_else(|reason| {
                folder.refused(stage, &reason);
                compile(device, stage, variant, &Sources::default())
            })
        })
    }

    /// Makes pipelines anew if the folder of shaders has changed since the last call; whether it
    /// had. Pipelines are replaced all at once, or not at all if one cannot be made.
    pub fn reload(&mut self) -> bool {
        let Some(folder) = &self.folder else { return false };
        let sources = folder.sources();
        if Arc::ptr_eq(&sources, &self.seen) {
            return false;
        }
        self.seen = Arc::clone(&sources);
        let mut remade = BTreeMap::new();
        for &(stage, variant) in self.pipelines.keys() {
            if stage.source(variant, &sources) == stage.source(variant, &self.sources) {
                continue;
            }
            match try_compile(&self.device, stage, variant, &sources) {
                Ok(pipeline) => remade.insert((stage, variant), pipeline),
                Err(reason) => {
                    folder.refused(stage, &reason);
                    return false;
                }
            };
        }
        self.sources = sources;
        self.pipelines.extend(remade);
        true
    }
}

/// Has faults written down instead of ending the program.
fn watch(device: &wgpu::Device, faults: &Arc<Mutex<Faults>>) {
    let kept = Arc::clone(faults);
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        let mut faults = kept.lock().unwrap_or_else(PoisonError::into_inner);
        let place = match &error {
            wgpu::Error::OutOfMemory { .. } => &mut faults.out_of_memory,
            _ => &mut faults.other,
        };
        place.get_or_insert_with(|| error.to_string());
    }));
    let kept = Arc::clone(faults);
    device.set_device_lost_callback(move |reason, message| {
        let mut faults = kept.lock().unwrap_or_else(PoisonError::into_inner);
        let text = if message.is_empty() { format!("{reason:?}") } else { message };
        faults.lost.get_or_insert(text);
    });
}

/// A pipeline, or why the device refuses it. The fault is kept from where others are written down.
fn try_compile(
    device: &wgpu::Device,
    stage: Stage,
    variant: Variant,
    sources: &Sources,
) -> Result<wgpu::ComputePipeline, String> {
    let invalid = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
    let pipeline = compile(device, stage, variant, sources);
    let errors = [adapter::block_on(internal.pop()), adapter::block_on(invalid.pop())];
    match errors.into_iter().flatten().next() {
        Some(error) => Err(error.to_string()),
        None => Ok(pipeline),
    }
}

fn compile(
    device: &wgpu::Device,
    stage: Stage,
    variant: Variant,
    sources: &Sources,
) -> wgpu::ComputePipeline {
    let label = format!("{stage:?} {variant:?}");
    let module = module(device, stage, variant, sources, &label);
    let entries: Vec<_> = (0..)
        .zip(stage.bindings())
        .map(|(binding, (_, access))| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: match access {
                    Access::Uniform => wgpu::BufferBindingType::Uniform,
                    Access::Read => wgpu::BufferBindingType::Storage { read_only: true },
                    Access::Write => wgpu::BufferBindingType::Storage { read_only: false },
                },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        })
        .collect();
    let group = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(&label),
        entries: &entries,
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(&label),
        bind_group_layouts: &[Some(&group)],
        immediate_size: 0,
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(&label),
        layout: Some(&layout),
        module: &module,
        entry_point: Some(stage.entry()),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    })
}

fn module(
    device: &wgpu::Device,
    stage: Stage,
    variant: Variant,
    sources: &Sources,
    label: &str,
) -> wgpu::ShaderModule {
    let descriptor = wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(stage.source(variant, sources).into()),
    };
    if !sources.are_own() {
        return device.create_shader_module(descriptor);
    }
    let checks = wgpu::ShaderRuntimeChecks {
        force_loop_bounding: false,
        ..wgpu::ShaderRuntimeChecks::checked()
    };
    #[expect(unsafe_code, reason = "loops that count their own end cannot be unrolled")]
    // SAFETY: every loop of our shaders counts up to a number that was read before it starts;
    // all other checks stay on. Shaders of others are checked in full.
    unsafe {
        device.create_shader_module_trusted(descriptor, checks)
    }
}
