//! The window of `head landmarks`: winit's events, the surface, and egui's frames on it. Drawn when something happens,
//! not all the time.

use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::{Context as _, anyhow, bail};
use mouthpiece_render::{Gpu, GpuError};
use mouthpiece_shop::marking::Camera;
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::window::{Window, WindowId};

use super::mesh::{Painter, Scene};
use super::session::Session;
use super::shape::Shape;
use super::{panel, view};
use crate::interrupt;

/// How often the terminal's Ctrl-C is looked for while nothing else happens.
const LISTEN: Duration = Duration::from_millis(250);

/// Failures to get a picture on the screen in a row, after which the window gives up.
const FAILURES_MAX: u32 = 20;

/// Connects to the display; an error of one sentence where there is none.
pub fn connect() -> anyhow::Result<EventLoop<()>> {
    let named = ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"]
        .into_iter()
        .find_map(|name| std::env::var(name).ok().filter(|v| !v.is_empty()));
    if cfg!(target_os = "linux") && named.is_none() {
        bail!(
            "`head landmarks` works in a window and there is no display (neither WAYLAND_DISPLAY nor DISPLAY is set): \
             start it from a desktop session, or write the landmark file by other means"
        );
    }
    EventLoop::with_user_event().build().map_err(|error| {
        tracing::debug!(%error, "no event loop");
        anyhow!(
            "`head landmarks` works in a window and the display {} cannot be opened: start it from a desktop session",
            named.unwrap_or_default()
        )
    })
}

/// Shows the window until it is closed.
pub fn show(
    events: EventLoop<()>,
    session: Session,
    scan: Shape,
    reference: Shape,
) -> anyhow::Result<()> {
    let points: Vec<glam::Vec3> = reference
        .vertices
        .iter()
        .map(|v| v.position.into())
        .collect();
    let mut app = App {
        session,
        whole: Camera::at(&points),
        shapes: Some((scan, reference)),
        open: None,
        wake: None,
        error: None,
    };
    events.run_app(&mut app).context("the window has failed")?;
    match app.error {
        Some(error) => Err(error),
        None => Ok(()),
    }
}

struct App {
    session: Session,
    /// Looks at all of the reference head.
    whole: Camera,
    /// Until they are on the graphics card.
    shapes: Option<(Shape, Shape)>,
    open: Option<Open>,
    /// When egui wants to draw again by itself.
    wake: Option<Instant>,
    error: Option<anyhow::Error>,
}

/// The window and what draws into it.
struct Open {
    // Dropped before the window.
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    gpu: Gpu,
    painter: Painter,
    scan: Scene,
    reference: Scene,
    renderer: egui_wgpu::Renderer,
    input: egui_winit::State,
    context: egui::Context,
    window: Arc<Window>,
    title: String,
    failures: u32,
}

impl ApplicationHandler for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        let Some((scan, reference)) = self.shapes.take() else {
            return;
        };
        match Open::new(events, scan, reference) {
            Ok(open) => self.open = Some(open),
            Err(error) => self.give_up(events, error),
        }
    }

    fn new_events(&mut self, events: &ActiveEventLoop, _cause: StartCause) {
        if let Err(interrupted) = interrupt::check() {
            return self.give_up(events, interrupted.into());
        }
        if self.wake.is_some_and(|wake| wake <= Instant::now()) {
            self.wake = None;
            if let Some(open) = &self.open {
                open.window.request_redraw();
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _id: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else {
            return;
        };
        // To egui the request to redraw is itself a reason to redraw.
        let redraw = matches!(event, WindowEvent::RedrawRequested);
        if open.input.on_window_event(&open.window, &event).repaint && !redraw {
            open.window.request_redraw();
        }
        match event {
            WindowEvent::CloseRequested => {
                self.session.close();
                open.window.request_redraw();
            }
            WindowEvent::Destroyed => events.exit(),
            WindowEvent::Resized(size) => open.resize(size.width, size.height),
            WindowEvent::RedrawRequested => match open.redraw(&mut self.session, &self.whole) {
                Ok(delay) => self.wake = Instant::now().checked_add(delay),
                Err(error) => self.give_up(events, error),
            },
            _ => {}
        }
        if self.session.done {
            events.exit();
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let listen = Instant::now() + LISTEN;
        let until = self.wake.map_or(listen, |wake| wake.min(listen));
        events.set_control_flow(ControlFlow::WaitUntil(until));
    }

    fn exiting(&mut self, _events: &ActiveEventLoop) {
        // The surface goes before the connection to the display does.
        self.open = None;
    }
}

impl App {
    fn give_up(&mut self, events: &ActiveEventLoop, error: anyhow::Error) {
        self.error = Some(error);
        self.open = None;
        events.exit();
    }
}

impl Open {
    fn new(events: &ActiveEventLoop, scan: Shape, reference: Shape) -> anyhow::Result<Self> {
        let attributes = Window::default_attributes()
            .with_title("Mouthpiece: landmarks")
            .with_inner_size(LogicalSize::new(1280, 860))
            .with_min_inner_size(LogicalSize::new(640, 480));
        let window = events
            .create_window(attributes)
            .context("no window could be opened")?;
        let window = Arc::new(window);
        let mut descriptor = wgpu::InstanceDescriptor::new_with_display_handle_from_env(Box::new(
            events.owned_display_handle(),
        ));
        if wgpu::Backends::from_env().is_none() {
            descriptor.backends = wgpu::Backends::PRIMARY | wgpu::Backends::GL;
        }
        let instance = wgpu::Instance::new(descriptor);
        let surface = instance
            .create_surface(Arc::clone(&window))
            .map_err(GpuError::Surface)?;
        let gpu = Gpu::for_window(&instance, &surface)?;
        let size = window.inner_size();
        let unsupported = || GpuError::UnsupportedSurface {
            adapter: gpu.info().name.clone(),
        };
        let mut config = surface
            .get_default_config(gpu.adapter(), size.width.max(1), size.height.max(1))
            .ok_or_else(unsupported)?;
        // egui's colours are finished: a surface that converts them would wash them out.
        let formats = surface.get_capabilities(gpu.adapter()).formats;
        if let Some(format) = formats.iter().find(|f| {
            matches!(
                f,
                wgpu::TextureFormat::Bgra8Unorm | wgpu::TextureFormat::Rgba8Unorm
            )
        }) {
            config.format = *format;
        }
        config.present_mode = wgpu::PresentMode::AutoVsync;
        config.desired_maximum_frame_latency = 1;
        surface.configure(gpu.device(), &config);
        let painter = Painter::new(&gpu);
        let (scan, reference) = (painter.scene(scan)?, painter.scene(reference)?);
        let context = egui::Context::default();
        context.set_theme(egui::Theme::Dark);
        let input = egui_winit::State::new(
            context.clone(),
            egui::ViewportId::ROOT,
            &window,
            Some(window.scale_factor() as f32),
            window.theme(),
            Some(gpu.device().limits().max_texture_dimension_2d as usize),
        );
        let renderer = egui_wgpu::Renderer::new(
            gpu.device(),
            config.format,
            egui_wgpu::RendererOptions::default(),
        );
        window.request_redraw();
        Ok(Self {
            surface,
            config,
            painter,
            scan,
            reference,
            renderer,
            input,
            context,
            window,
            title: String::new(),
            failures: 0,
            gpu,
        })
    }

    fn resize(&mut self, width: u32, height: u32) {
        let most = self.gpu.device().limits().max_texture_dimension_2d;
        if width > 0 && height > 0 {
            (self.config.width, self.config.height) = (width.min(most), height.min(most));
            self.surface.configure(self.gpu.device(), &self.config);
            self.window.request_redraw();
        }
    }

    /// Draws once; when to draw again if nothing happens.
    fn redraw(&mut self, session: &mut Session, whole: &Camera) -> anyhow::Result<Duration> {
        use wgpu::CurrentSurfaceTexture as Got;
        anyhow::ensure!(
            !self.gpu.is_lost() && self.failures < FAILURES_MAX,
            "the graphics device stopped working: update its driver or choose another with WGPU_ADAPTER_NAME; what was not saved is lost"
        );
        let texture = match self.surface.get_current_texture() {
            Got::Success(texture) | Got::Suboptimal(texture) => texture,
            Got::Occluded => return Ok(LISTEN),
            Got::Timeout | Got::Validation | Got::Outdated | Got::Lost => {
                self.failures += 1;
                self.surface.configure(self.gpu.device(), &self.config);
                return Ok(Duration::from_millis(50));
            }
        };
        self.failures = 0;
        let title = format!(
            "Mouthpiece: landmarks, {}{}",
            session.output.display(),
            if session.is_dirty() { " *" } else { "" }
        );
        if title != self.title {
            self.window.set_title(&title);
            self.title = title;
        }
        let input = self.input.take_egui_input(&self.window);
        let context = self.context.clone();
        let mut output = context.run_ui(input, |ui| self.contents(ui, session, whole));
        self.input
            .handle_platform_output(&self.window, output.platform_output);
        let jobs = context.tessellate(output.shapes, output.pixels_per_point);
        let screen = egui_wgpu::ScreenDescriptor {
            size_in_pixels: [self.config.width, self.config.height],
            pixels_per_point: output.pixels_per_point,
        };
        let (device, queue) = (self.gpu.device(), self.gpu.queue());
        for (id, deltas) in &output.textures_delta.set {
            for delta in deltas {
                self.renderer.update_texture(device, queue, *id, delta);
            }
        }
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let extra = self
            .renderer
            .update_buffers(device, queue, &mut encoder, &jobs, &screen);
        let target = texture
            .texture
            .create_view(&wgpu::TextureViewDescriptor::default());
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("egui"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        self.renderer
            .render(&mut pass.forget_lifetime(), &jobs, &screen);
        queue.submit(extra.into_iter().chain([encoder.finish()]));
        self.window.pre_present_notify();
        queue.present(texture);
        for id in &output.textures_delta.free {
            self.renderer.free_texture(id);
        }
        output.textures_delta.clear();
        let root = output.viewport_output.get(&egui::ViewportId::ROOT);
        Ok(root.map_or(Duration::MAX, |v| v.repaint_delay))
    }

    fn contents(&mut self, ui: &mut egui::Ui, session: &mut Session, whole: &Camera) {
        if session.asking {
            panel::question(ui, session);
        } else {
            panel::keys(ui, session);
        }
        egui::Panel::top("bar").show(ui, |ui| panel::bar(ui, session, self.scan.coloured));
        egui::Panel::bottom("status").show(ui, |ui| panel::status(ui, session));
        egui::Panel::right("landmarks")
            .default_size(340.0)
            .size_range(280.0..=560.0)
            .show(ui, |ui| {
                panel::current(
                    ui,
                    session,
                    &self.painter,
                    &mut self.reference,
                    whole,
                    &mut self.renderer,
                );
                panel::warnings(ui, &mut session.marking);
                ui.separator();
                panel::list(ui, &mut session.marking);
            });
        egui::CentralPanel::no_frame().show(ui, |ui| {
            view::show(
                ui,
                session,
                &self.painter,
                &mut self.scan,
                &mut self.renderer,
            );
        });
    }
}
