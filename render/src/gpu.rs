//! The adapter, device and queue that everything else draws with.
//!
//! Picks the best adapter by kind (never by name), says which, and warns when it is a software one.
//! Asks for nothing beyond WebGPU's downlevel limits, so that any Vulkan, Metal, DX12 or GL driver
//! of the last ten years will do. Knows nothing of heads.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use thiserror::Error;
use wgpu::{Backends, DeviceType};

/// Why there is nothing to draw with.
#[derive(Debug, Error)]
pub enum GpuError {
    /// No driver offers an adapter (or none that can draw to the window).
    #[error(
        "no graphics adapter was found ({looked}): install a Vulkan driver, for example the package \
         mesa-vulkan-drivers, which also draws without a graphics card"
    )]
    NoAdapter {
        /// Which backends were asked.
        looked: String,
    },
    /// `WGPU_ADAPTER_NAME` names none of the adapters.
    #[error(
        "no graphics adapter has {wanted:?} in its name (there are: {found}): change or unset WGPU_ADAPTER_NAME"
    )]
    NoSuchAdapter {
        /// What was asked for.
        wanted: String,
        /// Names of what there is.
        found: String,
    },
    /// The driver refused to open the adapter.
    #[error(
        "the graphics adapter {adapter} cannot be opened: {source}; update its driver or choose another with WGPU_ADAPTER_NAME"
    )]
    Device {
        /// Name of the adapter.
        adapter: String,
        /// What the driver said.
        source: wgpu::RequestDeviceError,
    },
    /// The window system would not give a surface.
    #[error("the window cannot be drawn to: {0}; draw offscreen, or start from a desktop session")]
    Surface(#[from] wgpu::CreateSurfaceError),
    /// The surface offers no format we can draw in.
    #[error(
        "the graphics adapter {adapter} cannot draw to this window: choose another with WGPU_ADAPTER_NAME"
    )]
    UnsupportedSurface {
        /// Name of the adapter.
        adapter: String,
    },
}

/// An open adapter. Clones share the same device.
#[derive(Clone, Debug)]
pub struct Gpu {
    instance: wgpu::Instance,
    adapter: wgpu::Adapter,
    device: wgpu::Device,
    queue: wgpu::Queue,
    info: wgpu::AdapterInfo,
    lost: Arc<AtomicBool>,
    refused: Arc<Mutex<Option<String>>>,
}

impl Gpu {
    /// The best adapter of this machine, for drawing without a window.
    ///
    /// # Errors
    /// When there is no adapter, or it cannot be opened.
    pub fn headless() -> Result<Self, GpuError> {
        // GL is asked only when nothing better answers: opening it without a display makes EGL
        // print errors of its own.
        let chosen = Backends::from_env();
        for backends in [
            chosen.unwrap_or(Backends::PRIMARY),
            chosen.unwrap_or(Backends::GL),
        ] {
            let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
            descriptor.backends = backends;
            let instance = wgpu::Instance::new(descriptor);
            match Self::open(&instance, None) {
                Err(GpuError::NoAdapter { .. }) => {}
                other => return other,
            }
        }
        Err(GpuError::NoAdapter {
            looked: format!("{:?}", chosen.unwrap_or(Backends::PRIMARY | Backends::GL)),
        })
    }

    /// The best adapter of `instance` that can draw to `surface`.
    ///
    /// # Errors
    /// When there is no such adapter, or it cannot be opened.
    pub fn for_window(
        instance: &wgpu::Instance,
        surface: &wgpu::Surface<'_>,
    ) -> Result<Self, GpuError> {
        Self::open(instance, Some(surface))
    }

    /// Another device of the same adapter, with a queue of its own.
    ///
    /// # Errors
    /// When the driver opens it only once.
    pub fn another(&self) -> Result<Self, GpuError> {
        Self::of(&self.instance, self.adapter.clone())
    }

    fn open(
        instance: &wgpu::Instance,
        surface: Option<&wgpu::Surface<'_>>,
    ) -> Result<Self, GpuError> {
        let opened = Self::of(instance, choose(instance, surface)?)?;
        let info = &opened.info;
        tracing::info!(
            adapter = %info.name, kind = ?info.device_type, backend = %info.backend,
            driver = %format!("{} {}", info.driver, info.driver_info), "graphics adapter"
        );
        if opened.is_software() {
            tracing::warn!(
                adapter = %info.name,
                "drawing in software, on the processor: expect few frames a second at large sizes; \
                 install the driver of the graphics card if there is one"
            );
        }
        Ok(opened)
    }

    fn of(instance: &wgpu::Instance, adapter: wgpu::Adapter) -> Result<Self, GpuError> {
        let info = adapter.get_info();
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("mouthpiece"),
            required_limits: limits(&adapter.limits()),
            ..Default::default()
        }))
        .map_err(|source| GpuError::Device {
            adapter: info.name.clone(),
            source,
        })?;
        let lost = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&lost);
        device.set_device_lost_callback(move |reason, message| {
            // Destroying it is our own doing, and no news.
            if reason != wgpu::DeviceLostReason::Destroyed {
                tracing::warn!(?reason, message, "the graphics device was lost");
            }
            flag.store(true, Ordering::Release);
        });
        let refused = Arc::new(Mutex::new(None));
        let first = Arc::clone(&refused);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            tracing::error!(%error, "the graphics device refused a command");
            if let Ok(mut first) = first.lock() {
                first.get_or_insert_with(|| error.to_string());
            }
        }));
        Ok(Self {
            instance: instance.clone(),
            adapter,
            device,
            queue,
            info,
            lost,
            refused,
        })
    }

    /// Which adapter this is.
    #[must_use]
    pub fn info(&self) -> &wgpu::AdapterInfo {
        &self.info
    }

    /// Whether the adapter is the processor itself.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.info.device_type == DeviceType::Cpu
    }

    /// Whether the device has gone away (driver reset, card unplugged): rebuild everything then.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        self.lost.load(Ordering::Acquire)
    }

    /// The first command that the device refused since this was last asked. None is what should be;
    /// one is a mistake of ours, or of the driver.
    pub(crate) fn take_refused(&self) -> Option<String> {
        self.refused.lock().ok()?.take()
    }

    /// The instance the adapter came from.
    #[must_use]
    pub fn instance(&self) -> &wgpu::Instance {
        &self.instance
    }

    /// The adapter.
    #[must_use]
    pub fn adapter(&self) -> &wgpu::Adapter {
        &self.adapter
    }

    /// The device.
    #[must_use]
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// The queue.
    #[must_use]
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// `wanted` samples a pixel if the adapter offers them for `format`, else 1.
    #[must_use]
    pub fn samples(&self, format: wgpu::TextureFormat, wanted: u32) -> u32 {
        let offered = |format| {
            let flags = self.adapter.get_texture_format_features(format).flags;
            flags.sample_count_supported(wanted)
        };
        let resolves = self
            .adapter
            .get_texture_format_features(format)
            .flags
            .contains(wgpu::TextureFormatFeatureFlags::MULTISAMPLE_RESOLVE);
        if wanted <= 1 || (resolves && offered(format) && offered(crate::targets::DEPTH)) {
            wanted.max(1)
        } else {
            tracing::info!(wanted, "multisampling is not offered: edges will be jagged");
            1
        }
    }
}

/// What is asked of an adapter: WebGPU's downlevel limits, those of WebGL 2 where it has not even these (we compute
/// nothing and store nothing, so they do), and whatever size of picture it can.
fn limits(offered: &wgpu::Limits) -> wgpu::Limits {
    let downlevel = wgpu::Limits::downlevel_defaults();
    if downlevel.check_limits(offered) {
        downlevel.using_resolution(offered.clone())
    } else {
        wgpu::Limits::downlevel_webgl2_defaults().using_resolution(offered.clone())
    }
}

/// Discrete before integrated before virtual before software; `WGPU_ADAPTER_NAME` overrides.
fn choose(
    instance: &wgpu::Instance,
    surface: Option<&wgpu::Surface<'_>>,
) -> Result<wgpu::Adapter, GpuError> {
    let mut adapters = pollster::block_on(instance.enumerate_adapters(Backends::all()));
    if let Some(surface) = surface {
        adapters.retain(|a| a.is_surface_supported(surface));
    }
    if adapters.is_empty() {
        let looked = if surface.is_some() {
            "that can draw to this window"
        } else {
            "without a window"
        };
        return Err(GpuError::NoAdapter {
            looked: looked.into(),
        });
    }
    if let Ok(wanted) = std::env::var("WGPU_ADAPTER_NAME") {
        let names: Vec<String> = adapters.iter().map(|a| a.get_info().name).collect();
        let lower = wanted.to_lowercase();
        let at = names.iter().position(|n| n.to_lowercase().contains(&lower));
        return match at {
            Some(at) => Ok(adapters.swap_remove(at)),
            None => Err(GpuError::NoSuchAdapter {
                wanted,
                found: names.join(", "),
            }),
        };
    }
    // A stable sort: within a kind the driver's own order stands.
    adapters.sort_by_key(|a| {
        let info = a.get_info();
        let kind = match info.device_type {
            DeviceType::DiscreteGpu => 0,
            DeviceType::IntegratedGpu => 1,
            DeviceType::VirtualGpu => 2,
            DeviceType::Other => 3,
            DeviceType::Cpu => 4,
        };
        (kind, info.backend == wgpu::Backend::Gl)
    });
    Ok(adapters.swap_remove(0))
}
