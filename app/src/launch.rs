//! Opening the window, and what to say where that fails.

use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind, set_hook, take_hook};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui::{ViewportBuilder, vec2};
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup};
use eframe::{CreationContext, NativeOptions};
use figurant_core::engine::gpu::GpuContext;

use crate::shell::Shell;

/// What windows need beside a screen, by the names of Debian's packages.
const PACKAGES: &str = "libxkbcommon-x11-0 libx11-xcb1 libxcursor1 libxi6 libxrandr2 \
    libwayland-client0 mesa-vulkan-drivers";

/// Opens the window and waits until it is closed.
///
/// # Errors
/// What a person can do about it, when there is no window system or no driver to draw with.
pub fn open(path: Option<PathBuf>) -> Result<(), String> {
    let screens = ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"];
    if cfg!(target_os = "linux") && screens.iter().all(|n| std::env::var_os(n).is_none()) {
        let text = "this session has no screen (neither DISPLAY nor WAYLAND_DISPLAY is set)";
        return Err(text.to_owned());
    }
    let hush = Hush::new();
    let opened = hush.clone();
    let make = move |creation: &CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
        opened.end();
        let render = creation.wgpu_render_state.clone();
        Ok(Box::new(Shell::new(&creation.egui_ctx, render, path)?))
    };
    // Bindings to the window system's libraries panic where one is missing.
    let run = || eframe::run_native("Figurant", options(), Box::new(make));
    let ended = catch_unwind(AssertUnwindSafe(run));
    match (ended, hush.end()) {
        (Ok(Ok(())), _) => Ok(()),
        (Ok(Err(e)), _) => Err(plain(&e.to_string())),
        (Err(_), Some(text)) => Err(format!("{text} (on Debian, windows need {PACKAGES})")),
        (Err(_), None) => Err("the program is at fault; see above".to_owned()),
    }
}

/// An error of the window system without the places in source code that it begins with.
fn plain(text: &str) -> String {
    let after_place = text.rsplit_once(".rs:").and_then(|(_, rest)| rest.split_once(": "));
    after_place.map_or(text, |(_, rest)| rest).trim_end_matches('.').to_owned()
}

type Hook = Box<dyn Fn(&PanicHookInfo<'_>) + Send + Sync>;

/// Keeps panics to itself until the window is there, so that they end in one plain message.
#[derive(Clone)]
struct Hush {
    usual: Arc<Mutex<Option<Hook>>>,
    heard: Arc<Mutex<Option<String>>>,
}

impl Hush {
    fn new() -> Self {
        let heard = Arc::<Mutex<Option<String>>>::default();
        let usual = Arc::new(Mutex::new(Some(take_hook())));
        let ear = Arc::clone(&heard);
        set_hook(Box::new(move |panic| {
            let text = panic.payload_as_str().unwrap_or("something is missing");
            *ear.lock().unwrap_or_else(PoisonError::into_inner) =
                Some(text.trim_end_matches('.').to_owned());
        }));
        Self { usual, heard }
    }

    /// Has panics told as usual again; what was heard before.
    fn end(&self) -> Option<String> {
        if let Some(usual) = self.usual.lock().unwrap_or_else(PoisonError::into_inner).take() {
            set_hook(usual);
        }
        self.heard.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

fn options() -> NativeOptions {
    let mut wgpu_options = WgpuConfiguration::default();
    if let WgpuSetup::CreateNew(setup) = &mut wgpu_options.wgpu_setup {
        setup.device_descriptor = Arc::new(GpuContext::descriptor);
    }
    NativeOptions {
        viewport: ViewportBuilder::default()
            .with_title("Figurant")
            .with_app_id("figurant")
            .with_inner_size(vec2(1280.0, 800.0))
            .with_min_inner_size(vec2(640.0, 420.0)),
        wgpu_options,
        ..NativeOptions::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_told_without_places_in_source_code() {
        let text = "winit EventLoopError: os error at /a/b.rs:788: Failed to open connection: no.";
        assert_eq!(plain(text), "Failed to open connection: no");
        assert_eq!(plain("No suitable adapter: none."), "No suitable adapter: none");
    }
}
