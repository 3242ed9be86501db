//! A window's surface: configured, reconfigured when it changes, made anew when it is lost. The event
//! loop is the caller's; nothing here panics when the window is hidden, minimised or dragged between screens.

use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use mouthpiece_rig::{Head, KeyFrame};
use wgpu::rwh::{HasDisplayHandle, HasWindowHandle};

use crate::error::RenderError;
use crate::gpu::{Gpu, GpuError};
use crate::picture::Picture;
use crate::renderer::{Hung, Renderer};
use crate::shot::{Shot, Take};
use crate::tier::Tier;
use crate::view::View;

/// The longest that a picture may take.
const PATIENCE: Duration = Duration::from_secs(10);

/// What became of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Handed to the screen.
    Shown,
    /// The window is covered, minimised or has no area: draw again when that changes, or after a
    /// tenth of a second.
    Hidden,
    /// The screen did not take it in time, or the surface had to be set up again: draw again.
    Retry,
}

type MakeSurface =
    Box<dyn Fn(&wgpu::Instance) -> Result<wgpu::Surface<'static>, wgpu::CreateSurfaceError> + Send>;

/// A window that heads are drawn to.
pub struct WindowTarget {
    // Dropped first: before the window that `make_surface` keeps.
    surface: wgpu::Surface<'static>,
    renderer: Renderer,
    gpu: Gpu,
    config: wgpu::SurfaceConfiguration,
    /// The window's size in pixels, perhaps 0.
    size: (u32, u32),
    max_side: u32,
    make_surface: MakeSurface,
    tier: Tier,
    /// The renderer of another tier, in the making on a thread of its own.
    coming: Option<(Tier, JoinHandle<Result<Renderer, RenderError>>)>,
    /// A picture to be hung behind the head, on its way to the card.
    hanging: Option<JoinHandle<Hung>>,
    cost_ns: i64,
    /// Who wants the next picture back.
    take: Option<Take>,
}

impl std::fmt::Debug for WindowTarget {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("WindowTarget")
            .field("gpu", &self.gpu)
            .field("size", &self.size)
            .finish_non_exhaustive()
    }
}

/// Something drawn over the picture before it is shown.
pub trait Overlay {
    /// Writes its commands to `encoder`, for a target of [`WindowTarget::format`] that has `size` pixels and holds the
    /// picture; gives back what must be done before them.
    fn draw(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        size: (u32, u32),
    ) -> Vec<wgpu::CommandBuffer>;
}

/// Why a window cannot be drawn to.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    /// No adapter, device or surface.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The head cannot be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
}

impl WindowTarget {
    /// Ready to draw `head` to `window`, which has `size` pixels. Call from the thread of the event loop.
    ///
    /// # Errors
    /// When no adapter can draw to this window.
    pub fn new<W>(
        window: Arc<W>,
        size: (u32, u32),
        head: &Head,
        tier: Tier,
    ) -> Result<Self, WindowError>
    where
        W: HasWindowHandle + HasDisplayHandle + std::fmt::Debug + Send + Sync + 'static,
    {
        let mut descriptor = wgpu::InstanceDescriptor::new_with_display_handle_from_env(Box::new(
            Arc::clone(&window),
        ));
        if wgpu::Backends::from_env().is_none() {
            descriptor.backends = wgpu::Backends::PRIMARY | wgpu::Backends::GL;
        }
        let instance = wgpu::Instance::new(descriptor);
        let make_surface: MakeSurface =
            Box::new(move |instance| instance.create_surface(Arc::clone(&window)));
        let surface = make_surface(&instance).map_err(GpuError::Surface)?;
        let gpu = Gpu::for_window(&instance, &surface)?;
        let config = configuration(&gpu, &surface)?;
        let renderer = Renderer::new(&gpu, head, config.format, tier)?;
        let max_side = gpu.device().limits().max_texture_dimension_2d;
        let mut target = Self {
            surface,
            renderer,
            gpu,
            config,
            size: (0, 0),
            max_side,
            make_surface,
            tier,
            coming: None,
            hanging: None,
            cost_ns: 0,
            take: None,
        };
        target.resize(size);
        Ok(target)
    }

    /// The device drawn with.
    #[must_use]
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The format of what is drawn to.
    #[must_use]
    pub fn format(&self) -> wgpu::TextureFormat {
        self.config.format
    }

    /// The tier that is drawn in.
    #[must_use]
    pub fn tier(&self) -> Tier {
        self.tier
    }

    /// What the last picture cost: from having a place for it to its being done, nanoseconds.
    #[must_use]
    pub fn cost_ns(&self) -> i64 {
        self.cost_ns
    }

    /// Whether another tier is in the making.
    #[must_use]
    pub fn is_preparing(&self) -> bool {
        self.coming.is_some()
    }

    /// Begins to make ready for another tier, beside drawing in this one; pictures are of the other as soon as it can be. Where it
    /// cannot, a warning says so and this one stays.
    pub fn prepare(&mut self, head: &Arc<Head>, tier: Tier) {
        if self.coming.is_some() || tier == self.tier {
            return;
        }
        let (gpu, head, format) = (self.gpu.clone(), Arc::clone(head), self.config.format);
        let spawned = std::thread::Builder::new()
            .name("other tier".into())
            .spawn(move || Renderer::new(&gpu, &head, format, tier));
        match spawned {
            Ok(thread) => self.coming = Some((tier, thread)),
            Err(error) => tracing::warn!(%error, "no thread to make another tier ready"),
        }
    }

    /// Gives the next picture that is shown to `take` as well, on this thread, a picture or two later: it should only
    /// pass it on. Dropped where this screen's pictures cannot be had or the device is lost in between.
    pub fn shoot(&mut self, take: impl FnOnce(Shot) + Send + 'static) {
        if self.config.usage.contains(wgpu::TextureUsages::COPY_SRC) {
            self.take = Some(Box::new(take));
        }
    }

    /// Begins to put `picture` on the card, beside drawing, so that no picture is late when a view comes that has it
    /// behind the head.
    pub fn hang(&mut self, picture: &Arc<Picture>) {
        let hung = self.renderer.hung.as_ref();
        if hung.is_some_and(|hung| Arc::ptr_eq(&hung.picture, picture)) {
            return;
        }
        let (gpu, picture) = (self.gpu.clone(), Arc::clone(picture));
        let maps = self.renderer.layouts.maps.clone();
        let spawned = std::thread::Builder::new()
            .name("backdrop".into())
            .spawn(move || Hung::new(&gpu, &maps, picture));
        // Without a thread, drawing does it.
        self.hanging = spawned.ok();
    }

    /// Whether a picture is still on its way to the card.
    pub fn is_hanging(&mut self) -> bool {
        if self
            .hanging
            .as_ref()
            .is_some_and(|thread| !thread.is_finished())
        {
            return true;
        }
        if let Some(thread) = self.hanging.take()
            && let Ok(hung) = thread.join()
        {
            self.renderer.hung = Some(hung);
        }
        false
    }

    /// Takes over the other tier's renderer once it is there.
    fn take_over(&mut self) {
        if self.coming.as_ref().is_none_or(|(_, t)| !t.is_finished()) {
            return;
        }
        let Some((tier, thread)) = self.coming.take() else {
            return;
        };
        match thread.join() {
            Ok(Ok(mut renderer)) => {
                renderer.hung = self.renderer.hung.take();
                (self.renderer, self.tier) = (renderer, tier);
            }
            Ok(Err(error)) => {
                tracing::warn!(tier = tier.name(), "the tier cannot be drawn: {error}");
            }
            Err(_) => tracing::warn!(tier = tier.name(), "making the tier ready broke down"),
        }
    }

    /// Takes over the window's new size; one without area only stops the drawing.
    pub fn resize(&mut self, size: (u32, u32)) {
        self.size = size;
        if size.0 == 0 || size.1 == 0 {
            return;
        }
        // A window may span screens that together are larger than an image can be.
        self.config.width = size.0.min(self.max_side);
        self.config.height = size.1.min(self.max_side);
        self.surface.configure(self.gpu.device(), &self.config);
    }

    /// Draws and shows one picture, with something over it or not. With winit, call `pre_present_notify` before it.
    ///
    /// # Errors
    /// When the frame is of another head, or the device is lost: then make a new `WindowTarget`.
    pub fn draw(
        &mut self,
        key_frame: &KeyFrame,
        view: &View,
        over: Option<&mut dyn Overlay>,
    ) -> Result<Outcome, WindowError> {
        use wgpu::CurrentSurfaceTexture as Acquired;
        // A lost device says so only when asked; its surface would have us try again for ever.
        let _ = self.gpu.device().poll(wgpu::PollType::Poll);
        if self.gpu.is_lost() {
            return Err(RenderError::DeviceLost.into());
        }
        if self.size.0 == 0 || self.size.1 == 0 {
            return Ok(Outcome::Hidden);
        }
        self.take_over();
        let (texture, stale) = match self.surface.get_current_texture() {
            Acquired::Success(texture) => (texture, false),
            Acquired::Suboptimal(texture) => (texture, true),
            Acquired::Occluded => return Ok(Outcome::Hidden),
            Acquired::Timeout => return Ok(Outcome::Retry),
            Acquired::Outdated | Acquired::Validation => {
                self.surface.configure(self.gpu.device(), &self.config);
                return Ok(Outcome::Retry);
            }
            Acquired::Lost => {
                tracing::warn!("the window's surface was lost; making a new one");
                self.surface =
                    (self.make_surface)(self.gpu.instance()).map_err(GpuError::Surface)?;
                self.surface.configure(self.gpu.device(), &self.config);
                return Ok(Outcome::Retry);
            }
        };
        let begun = Instant::now();
        let target = texture
            .texture
            .create_view(&wgpu::TextureViewDescriptor::default());
        let size = (texture.texture.width(), texture.texture.height());
        let mut submission = self
            .renderer
            .draw(&self.gpu, key_frame, view, &target, size)?;
        if let Some(over) = over {
            submission = self.draw_over(over, &target, size);
        }
        if let Some(take) = self.take.take() {
            let (device, queue) = (self.gpu.device(), self.gpu.queue());
            Shot::request(device, queue, &texture.texture, take);
        }
        self.gpu.queue().present(texture);
        // To know what pictures cost, and so that none queue up. A card that takes longer than this hangs.
        let done = self.gpu.device().poll(wgpu::PollType::Wait {
            submission_index: Some(submission),
            timeout: Some(PATIENCE),
        });
        if done.is_err() || self.gpu.is_lost() {
            return Err(RenderError::DeviceLost.into());
        }
        self.cost_ns = i64::try_from(begun.elapsed().as_nanos()).unwrap_or(i64::MAX);
        // A command that is refused once is refused each time: not an error to end with, but one to hear of.
        self.gpu.take_refused();
        if stale {
            self.surface.configure(self.gpu.device(), &self.config);
        }
        Ok(Outcome::Shown)
    }
}

impl WindowTarget {
    fn draw_over(
        &self,
        over: &mut dyn Overlay,
        target: &wgpu::TextureView,
        size: (u32, u32),
    ) -> wgpu::SubmissionIndex {
        let label = Some("overlay");
        let device = self.gpu.device();
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
        let first = over.draw(&self.gpu, &mut encoder, target, size);
        let commands = first.into_iter().chain([encoder.finish()]);
        self.gpu.queue().submit(commands)
    }
}

/// The surface's best settings: plain bytes (the shaders give sRGB values) if they are offered, in step with the screen, no queue of
/// old pictures.
fn configuration(
    gpu: &Gpu,
    surface: &wgpu::Surface<'_>,
) -> Result<wgpu::SurfaceConfiguration, GpuError> {
    let unsupported = || GpuError::UnsupportedSurface {
        adapter: gpu.info().name.clone(),
    };
    let mut config = surface
        .get_default_config(gpu.adapter(), 1, 1)
        .ok_or_else(unsupported)?;
    let offered = surface.get_capabilities(gpu.adapter());
    let formats = offered.formats;
    // For shots; where it is not offered there are none.
    config.usage |= offered.usages & wgpu::TextureUsages::COPY_SRC;
    let eight_bit = |f: &wgpu::TextureFormat| {
        use wgpu::TextureFormat as F;
        matches!(
            f,
            F::Bgra8UnormSrgb | F::Rgba8UnormSrgb | F::Bgra8Unorm | F::Rgba8Unorm
        )
    };
    config.format = formats
        .iter()
        .copied()
        .find(|f| eight_bit(f) && !f.is_srgb())
        .or_else(|| formats.iter().copied().find(eight_bit))
        .ok_or_else(unsupported)?;
    config.present_mode = wgpu::PresentMode::AutoVsync;
    config.desired_maximum_frame_latency = 1;
    Ok(config)
}
