//! `figurant doctor`: what this machine can do, and what is missing.

use std::time::Instant;

use figurant_core::export::atomic;
use figurant_core::job::FrameMaker;

use crate::args::DoctorArgs;
use crate::commands::processors;
use crate::road::{EngineKind, EngineWish, Road, Wishes};
use crate::{Console, Exit, Failure};

/// Checks everything that an export needs and prints a line on each.
pub fn run<R: Road>(
    road: &R,
    args: &DoctorArgs,
    console: &mut Console<'_>,
) -> Result<Exit, Failure> {
    let threads = processors();
    let mut page = Page::default();
    page.good("version", format!("figurant {}", env!("CARGO_PKG_VERSION")));
    page.good("system", format!("{} on {}", std::env::consts::OS, std::env::consts::ARCH));
    page.good("processor", format!("{threads} threads, {}", processor_features()));
    page.good("engine", road.engine(args.simd));
    match memory_mib() {
        Some(mib) if mib < MEMORY_MIB => page.warn(
            "memory",
            format!(
                "{mib} MiB are free, less than {MEMORY_MIB}; use --workers 1 if exports are killed"
            ),
        ),
        Some(mib) => page.good("memory", format!("{mib} MiB free")),
        None => page.good("memory", "not known on this system".to_owned()),
    }
    match try_disk() {
        Ok(text) => page.good("disk", text),
        Err(text) => page.warn("disk", text),
    }
    match road.built_in_assets() {
        Ok(lines) => lines.into_iter().for_each(|line| page.good("assets", line)),
        Err(text) => {
            page.bad("assets", format!("{text}; the program is damaged, install it again"))
        }
    }
    match test_frame(road, args, EngineWish::default(), None) {
        Ok(text) => page.good("test frame", text),
        Err(text) => page.bad("test frame", text),
    }
    graphics(road, args, &mut page);
    page.good("window", window().to_owned());
    console.data(page.text.as_bytes())?;
    Ok(if page.usable { Exit::Done } else { Exit::NoEngine })
}

/// Lists the graphics adapters and has each render the test frame. None is needed.
fn graphics<R: Road>(road: &R, args: &DoctorArgs, page: &mut Page) {
    let Some(adapters) = road.adapters() else {
        page.good("graphics", "not built in; the native engine renders".to_owned());
        return;
    };
    if adapters.is_empty() {
        page.good(
            "graphics",
            "no adapter was found, so that the native engine renders; for one, install the \
             driver of your graphics processor with Vulkan (on Debian: mesa-vulkan-drivers \
             libvulkan1)"
                .to_owned(),
        );
    }
    for adapter in adapters {
        page.good("graphics", adapter.line);
        let wish = EngineWish { kind: EngineKind::Gpu, adapter: Some(adapter.name) };
        let size = (!adapter.hardware).then_some(SOFTWARE_SIZE);
        match test_frame(road, args, wish, size) {
            Ok(text) => page.good("test frame", text),
            Err(text) => page.warn("test frame", text),
        }
    }
}

/// Whether there is anything to open a window on. None is needed.
fn window() -> &'static str {
    let screens = ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"];
    if !cfg!(feature = "gui") {
        "not built in"
    } else if cfg!(target_os = "linux") && screens.iter().all(|n| std::env::var_os(n).is_none()) {
        "this session has no screen to open one on; nothing else needs one"
    } else {
        "this session has a screen; `figurant CONFIG.json` opens one"
    }
}

/// Below this, frames of ordinary size for two workers may not fit.
const MEMORY_MIB: u64 = 1024;

struct Page {
    text: String,
    usable: bool,
}

impl Default for Page {
    fn default() -> Self {
        Self { text: String::new(), usable: true }
    }
}

impl Page {
    fn line(&mut self, mark: &str, what: &str, text: &str) {
        self.text += &format!("{mark:<8}{what:<12}{text}\n");
    }

    fn good(&mut self, what: &str, text: String) {
        self.line("ok", what, &text);
    }

    fn warn(&mut self, what: &str, text: String) {
        self.line("warning", what, &text);
    }

    fn bad(&mut self, what: &str, text: String) {
        self.usable = false;
        self.line("MISSING", what, &text);
    }
}

/// The vector instructions that matter for speed. Results do not depend on them.
fn processor_features() -> String {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    let found = [
        ("SSE4.1", std::is_x86_feature_detected!("sse4.1")),
        ("AVX2", std::is_x86_feature_detected!("avx2")),
        ("AVX-512", std::is_x86_feature_detected!("avx512f")),
    ];
    #[cfg(target_arch = "aarch64")]
    let found = [("NEON", std::arch::is_aarch64_feature_detected!("neon"))];
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64", target_arch = "aarch64")))]
    let found: [(&str, bool); 0] = [];
    let names: Vec<_> = found.into_iter().filter(|(_, has)| *has).map(|(name, _)| name).collect();
    if names.is_empty() { "no known vector instructions".to_owned() } else { names.join(" ") }
}

/// Memory that programs can have without others being pushed out, where the system says.
fn memory_mib() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|l| l.strip_prefix("MemAvailable:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib / 1024)
}

/// Writes a file as an export does and reads it back.
fn try_disk() -> Result<String, String> {
    let folder = std::env::temp_dir();
    let path = folder.join(format!("figurant-doctor-{}", std::process::id()));
    let bytes = vec![0x5a; 1 << 20];
    let start = Instant::now();
    atomic::write(&path, &bytes).map_err(|e| e.to_string())?;
    let spent = start.elapsed();
    let back = std::fs::read(&path);
    drop(std::fs::remove_file(&path));
    match back {
        Ok(back) if back == bytes => Ok(format!(
            "{} can be written to (1 MiB written and synced in {:.1} ms)",
            folder.display(),
            spent.as_secs_f64() * 1e3
        )),
        Ok(_) => Err(format!("{}: what was written is not what is read back", path.display())),
        Err(e) => Err(format!("{}: cannot be read back: {e}", path.display())),
    }
}

/// Size of the test frame for adapters of software: at the config's own they take many seconds.
const SOFTWARE_SIZE: [u32; 2] = [128, 128];

/// Renders a frame of a config that ships with the program, twice: the first also fills caches.
fn test_frame<R: Road>(
    road: &R,
    args: &DoctorArgs,
    engine: EngineWish,
    size: Option<[u32; 2]>,
) -> Result<String, String> {
    let wishes = Wishes { simd: args.simd, engine, size, ..Wishes::default() };
    let job = road.starter(&wishes).map_err(|e| e.to_string())?;
    let start = Instant::now();
    let mut maker = road.maker(&job, processors()).map_err(|e| e.to_string())?;
    maker.make(0).map_err(|e| e.to_string())?;
    let first = start.elapsed();
    let start = Instant::now();
    let made = maker.make(1).map_err(|e| e.to_string())?;
    let second = start.elapsed();
    let labels = &made.annotations;
    let seen = labels.people.iter().filter(|p| p.is_visible()).count();
    Ok(format!(
        "{} x {} pixels with {seen} people in {:.1} ms (the first, with all set-up, in {:.0} ms)",
        labels.width,
        labels.height,
        second.as_secs_f64() * 1e3,
        first.as_secs_f64() * 1e3
    ))
}
