//! Which graphics adapters there are, and which one renders.

use std::fmt::{Display, Formatter, Result as FmtResult};
use std::future::Future;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

use super::reload::ShaderFolder;

/// Why no adapter renders.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// There is none.
    #[error(
        "no graphics adapter was found; install a Vulkan driver (on Debian: mesa-vulkan-drivers \
         libvulkan1), or use --engine cpu"
    )]
    NoAdapter,
    /// There are only software adapters, and none was asked for.
    #[error(
        "there is no graphics hardware, only software ({found}), which is slower than the native \
         engine; use --engine cpu, or name it with --adapter to use it all the same"
    )]
    OnlySoftware {
        /// What there is.
        found: String,
    },
    /// There is none of that name.
    #[error("no graphics adapter is called \"{name}\"; there are {found}")]
    UnknownAdapter {
        /// What was asked for.
        name: String,
        /// What there is.
        found: String,
    },
    /// The adapter gives no device.
    #[error("{adapter} cannot be used ({reason}); update its driver, or use --engine cpu")]
    Refused {
        /// Its name.
        adapter: String,
        /// What the driver says.
        reason: String,
    },
}

/// What is known of an adapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterReport {
    /// As `--adapter` takes it.
    pub name: String,
    /// Name and version of the driver.
    pub driver: String,
    /// The interface it is reached by, such as `vulkan`.
    pub backend: String,
    /// Whether it is a graphics processor and not a program that pretends to be one.
    pub hardware: bool,
    /// Largest buffer that a shader can read, bytes.
    pub largest_binding: u64,
    /// Largest buffer, bytes.
    pub largest_buffer: u64,
}

impl Display for AdapterReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> FmtResult {
        let kind = if self.hardware { "hardware" } else { "software" };
        write!(
            f,
            "{} ({kind}, {}, {}; buffers up to {} MiB)",
            self.name,
            self.backend,
            self.driver,
            self.largest_binding.min(self.largest_buffer) >> 20
        )
    }
}

/// Which adapter is wanted, and how it is used.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct GpuOptions {
    /// Part of its name in any case; the fastest hardware if absent.
    pub adapter: Option<String>,
    /// Use no more than every WebGPU device has, whatever this one has.
    pub minimum_limits: bool,
    /// Shaders in place of the program's own, read anew whenever they change.
    pub shaders: Option<ShaderFolder>,
}

/// All adapters that could render, the fastest hardware first, software last.
#[must_use]
pub fn adapters() -> Vec<AdapterReport> {
    found(&instance()).iter().map(report).collect()
}

/// The adapter that an engine with these options uses.
///
/// # Errors
/// When there is none.
pub fn choice(options: &GpuOptions) -> Result<AdapterReport, GpuError> {
    choose(&instance(), options).map(|adapter| report(&adapter))
}

pub(super) fn instance() -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::PRIMARY,
        flags: wgpu::InstanceFlags::empty(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    })
}

/// The adapter that the options name.
pub(super) fn choose(
    instance: &wgpu::Instance,
    options: &GpuOptions,
) -> Result<wgpu::Adapter, GpuError> {
    let mut all = found(instance);
    if all.is_empty() {
        return Err(GpuError::NoAdapter);
    }
    let names = || all.iter().map(|a| a.get_info().name).collect::<Vec<_>>().join(", ");
    let chosen = match &options.adapter {
        Some(name) => {
            let wanted = name.to_lowercase();
            let called = |a: &wgpu::Adapter| a.get_info().name.to_lowercase().contains(&wanted);
            all.iter()
                .position(called)
                .ok_or_else(|| GpuError::UnknownAdapter { name: name.clone(), found: names() })?
        }
        None if is_hardware(&all[0].get_info()) => 0,
        None => return Err(GpuError::OnlySoftware { found: names() }),
    };
    Ok(all.swap_remove(chosen))
}

/// Adapters with compute shaders, the fastest hardware first.
fn found(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
    let mut all = block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let computes = wgpu::DownlevelFlags::COMPUTE_SHADERS | wgpu::DownlevelFlags::INDIRECT_EXECUTION;
    all.retain(|a| a.get_downlevel_capabilities().flags.contains(computes));
    all.sort_by_key(|a| rank(a.get_info().device_type));
    all
}

const fn rank(kind: wgpu::DeviceType) -> u8 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}

pub(super) fn is_hardware(info: &wgpu::AdapterInfo) -> bool {
    info.device_type != wgpu::DeviceType::Cpu
}

fn report(adapter: &wgpu::Adapter) -> AdapterReport {
    let (info, limits) = (adapter.get_info(), adapter.limits());
    AdapterReport {
        hardware: is_hardware(&info),
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
        backend: info.backend.to_str().to_owned(),
        name: info.name,
        largest_binding: limits.max_storage_buffer_binding_size,
        largest_buffer: limits.max_buffer_size,
    }
}

/// The value of a future that wgpu has ready at once, as all of its are outside browsers.
pub(super) fn block_on<T>(future: impl Future<Output = T>) -> T {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        if let Poll::Ready(value) = future.as_mut().poll(&mut context) {
            return value;
        }
        std::thread::yield_now();
    }
}
