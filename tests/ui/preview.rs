//! The preview: the exporter's picture, the latest wish only, and a clean end.

use std::num::NonZeroUsize;
use std::time::{Duration, Instant};

use figurant::road::{EngineKind, EngineWish, Road, Wishes};
use figurant::session::Session;
use figurant::studio::Native;
use figurant::viewport::preview::{Answer, Preview};
use figurant::viewport::worker::{Pixels, Renderer, Request, Worker};
use figurant_core::engine::gpu::{GpuContext, GpuPicture, adapters};
use figurant_core::job::FrameMaker;

use super::common::{Folder, SIDE, open, rgb, settle};

const TWO: NonZeroUsize = NonZeroUsize::new(2).unwrap();

/// The picture that an export writes.
fn exported(folder: &Folder, frame: u32, engine: EngineWish) -> Vec<u8> {
    let wishes = Wishes { engine, ..Wishes::default() };
    let job = Native.load(&folder.config(), &wishes).unwrap();
    Native.maker(&job, TWO).unwrap().make(frame).unwrap().picture.unwrap()
}

fn request(folder: &Folder, frame: u32) -> Request {
    let mut session = Session::new(Some(folder.config()), None);
    session.config = Some(Worker::open(Some(&folder.config())).unwrap());
    session.seed = session.config.as_ref().unwrap().document().seed;
    session.frame = frame;
    session.request().unwrap()
}

#[test]
fn the_window_shows_the_exporters_bytes() {
    let folder = Folder::new();
    let mut window = open(folder.config());
    for frame in [0, 1] {
        let shown = settle(&mut window);
        assert_eq!(shown.request.frame, frame);
        assert!(rgb(&shown) == exported(&folder, frame, EngineWish::default()), "frame {frame}");
        window.key_press(eframe::egui::Key::Space);
        window.step();
    }
}

/// A device as a window opens it; nothing, with a word about it, if there is none and none is
/// required.
fn device() -> Option<GpuContext> {
    let Some(first) = adapters().into_iter().next() else {
        let required = std::env::var("REQUIRE_GPU").is_ok_and(|v| v == "1");
        assert!(!required, "REQUIRE_GPU is set, but there is no graphics adapter");
        println!("SKIPPED: there is no graphics adapter; install one of software to run this");
        return None;
    };
    println!("adapter: {}", first.name);
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::PRIMARY,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let all = block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let adapter = all.into_iter().find(|a| a.get_info().name == first.name).unwrap();
    let opened = block_on(adapter.request_device(&GpuContext::descriptor(&adapter)));
    let (device, queue) = opened.unwrap();
    Some(GpuContext::new(&adapter, device, queue).unwrap())
}

fn block_on<T>(future: impl Future<Output = T>) -> T {
    let mut future = std::pin::pin!(future);
    let mut context = std::task::Context::from_waker(std::task::Waker::noop());
    loop {
        if let std::task::Poll::Ready(value) = future.as_mut().poll(&mut context) {
            return value;
        }
    }
}

/// The bytes of a picture that is on a device.
fn read_back(context: &GpuContext, picture: &GpuPicture) -> Vec<u8> {
    let row = (picture.width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = context.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row) * u64::from(picture.height),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = context.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        picture.texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row),
                rows_per_image: None,
            },
        },
        picture.texture.size(),
    );
    context.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |mapped| mapped.unwrap());
    context.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let bytes = buffer.get_mapped_range(..).unwrap();
    let rows = bytes.chunks_exact(row as usize).map(|r| &r[..picture.width as usize * 4]);
    rows.flat_map(|r| r.as_chunks::<4>().0)
        .flat_map(|[r, g, b, a]| {
            assert_eq!(*a, 255);
            [*r, *g, *b]
        })
        .collect()
}

#[test]
fn a_picture_that_stays_on_the_device_has_the_exporters_bytes() {
    let Some(context) = device() else { return };
    let folder = Folder::new();
    let mut worker = Worker::new(Some(context.clone()), TWO);
    let adapter = Some(context.name.clone());
    let wish = EngineWish { kind: EngineKind::Gpu, adapter };
    let mut held = Vec::new();
    // Of another width, too, whose rows are not aligned as copies would have to be.
    for (frame, size) in [(0, [SIDE, SIDE]), (1, [SIDE, SIDE]), (1, [77, 45])] {
        let request = Request { renderer: Renderer::Graphics, size, ..request(&folder, frame) };
        let shown = worker.show(request).unwrap();
        let Pixels::Device(picture) = &shown.pixels else { panic!("it was read back") };
        assert_eq!([picture.width, picture.height], size);
        let wishes = Wishes { engine: wish.clone(), size: Some(size), ..Wishes::default() };
        let job = Native.load(&folder.config(), &wishes).unwrap();
        let made = Native.maker(&job, TWO).unwrap().make(frame).unwrap();
        assert!(read_back(&context, picture) == made.picture.unwrap(), "frame {frame}, {size:?}");
        assert_eq!(shown.annotations.people.len(), made.annotations.people.len());
        held.push(shown);
    }
    // What somebody looks at is not painted over.
    let first = exported(&folder, 0, wish);
    let Pixels::Device(picture) = &held[0].pixels else { panic!("it was read back") };
    assert!(read_back(&context, picture) == first);
}

#[test]
fn engines_are_switched_and_switched_back() {
    let Some(context) = device() else { return };
    let folder = Folder::new();
    let mut worker = Worker::new(Some(context.clone()), TWO);
    let native = worker.show(request(&folder, 0)).unwrap();
    let wanted = Request { renderer: Renderer::Graphics, ..request(&folder, 0) };
    let graphics = worker.show(wanted).unwrap();
    let again = worker.show(request(&folder, 0)).unwrap();
    assert!(rgb(&native) == rgb(&again));
    let Pixels::Device(picture) = &graphics.pixels else { panic!("it was read back") };
    let (a, b) = (rgb(&native), read_back(&context, picture));
    let apart: u64 = a.iter().zip(&b).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    assert!((apart as f64) < 0.5 * a.len() as f64, "{apart} steps of {} apart", a.len());
    assert_eq!(native.annotations.people.len(), graphics.annotations.people.len());
}

#[test]
fn without_a_device_the_graphics_engine_is_refused_and_the_worker_goes_on() {
    let folder = Folder::new();
    let mut worker = Worker::new(None, TWO);
    let wanted = Request { renderer: Renderer::Graphics, ..request(&folder, 0) };
    let error = worker.show(wanted).err().unwrap().to_string();
    assert!(error.contains("no graphics adapter"), "{error}");
    assert!(worker.show(request(&folder, 0)).is_ok());
}

fn preview() -> Preview {
    Preview::start(None, TWO, Box::new(|| {})).unwrap()
}

/// Answers up to the picture of a frame.
fn answers_until(preview: &mut Preview, frame: u32) -> usize {
    let start = Instant::now();
    let mut count = 0;
    loop {
        assert!(start.elapsed() < Duration::from_secs(120), "frame {frame} never came");
        match preview.poll() {
            Some(Answer::Shown(shown)) => {
                count += 1;
                if shown.request.frame == frame {
                    return count;
                }
            }
            Some(_) => panic!("it failed"),
            None => std::thread::sleep(Duration::from_millis(1)),
        }
    }
}

#[test]
fn wishes_that_are_replaced_are_never_rendered() {
    let folder = Folder::new();
    let (first, mut preview) = (request(&folder, 0), preview());
    preview.ask(first.clone());
    answers_until(&mut preview, 0);
    for frame in 1..=60 {
        preview.ask(Request { frame, ..first.clone() });
    }
    assert!(preview.is_busy());
    let made = answers_until(&mut preview, 60);
    assert!(made <= 3, "{made} pictures were made of 60 wishes that came at once");
    assert!(!preview.is_busy() && preview.poll().is_none());
    // A wish that is fulfilled is not rendered again.
    preview.ask(Request { frame: 60, ..first });
    assert!(!preview.is_busy());
}

#[test]
fn a_window_that_is_closed_while_it_renders_ends() {
    let folder = Folder::new();
    let first = request(&folder, 0);
    for wait_ms in [0, 3, 40] {
        let mut preview = preview();
        preview.ask(Request { size: [640, 640], ..first.clone() });
        std::thread::sleep(Duration::from_millis(wait_ms));
        preview.ask(Request { frame: 7, ..first.clone() });
        let start = Instant::now();
        drop(preview);
        assert!(start.elapsed() < Duration::from_secs(60));
    }
    let window = open(folder.config());
    drop(window);
}

#[test]
fn a_frame_that_cannot_be_made_is_told_and_the_next_one_is_shown() {
    let folder = Folder::new();
    let first = request(&folder, 0);
    let mut preview = preview();
    preview.ask(Request { size: [100_000, 16], ..first.clone() });
    let start = Instant::now();
    let text = loop {
        assert!(start.elapsed() < Duration::from_secs(60));
        match preview.poll() {
            Some(Answer::Failed(text)) => break text,
            Some(_) => panic!("it was shown"),
            None => std::thread::sleep(Duration::from_millis(1)),
        }
    };
    assert!(text.contains("100000"), "{text}");
    preview.ask(first);
    answers_until(&mut preview, 0);
}
