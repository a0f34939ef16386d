//! What a person costs who was never seen before: `cargo bench -p figurant-tests --bench people`.
//!
//! Means over the people of some frames of a preset, one thread: the body at rest, and the dressed
//! mesh at each level of detail with its size and error. Who comes again costs a look-up.
//! Times are the processor's where Linux tells them, so that a busy machine counts little. Equal
//! meshes have equal digests: what makes people cheaper should leave them alone.
//! Arguments: a preset, how many frames, and one level of detail if not all are wanted.

use std::sync::Arc;
use std::time::Instant;

use figurant_core::document::{file, presets};
use figurant_core::geometry::body::rest_body;
use figurant_core::geometry::person::dress;
use figurant_core::job::catalogue;
use figurant_core::library::Library;
use figurant_core::library::figure::LOD_COUNT;
use figurant_core::library::mesh::Mesh;
use figurant_core::sampling::Sampler;

/// Seconds that this thread has run.
fn seconds(start: Instant) -> f64 {
    std::fs::read_to_string("/proc/thread-self/schedstat")
        .ok()
        .and_then(|text| text.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()))
        .map_or_else(|| start.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

/// A number that any other vertex or triangle would change: FNV-1a by words.
fn digested(before: u64, mesh: &Mesh) -> u64 {
    let positions = mesh.positions.iter().flatten().chain(mesh.uvs.iter().flatten());
    let floats = positions.map(|v| u64::from(v.to_bits()));
    let normals = mesh.normals.iter().map(|n| u64::from(n.bits()));
    let skin = mesh.skin.iter().flat_map(|s| [s.joints, s.weights]);
    let skin = skin.map(|four| u64::from(u32::from_le_bytes(four)));
    let triangles = mesh.triangles.iter().flat_map(|t| t.get().map(u64::from));
    let words = floats.chain(normals).chain(skin).chain(triangles);
    words.fold(before, |sum, word| (sum ^ word).wrapping_mul(0x0100_0000_01b3))
}

fn main() {
    let clock = Instant::now();
    let words: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let name = words.first().map_or("peoplesanspeople", String::as_str);
    let frames: u32 = words.get(1).and_then(|n| n.parse().ok()).unwrap_or(20);
    let Some(preset) = presets::find(name) else {
        eprintln!("no preset '{name}'");
        return;
    };
    let mut document = file::parse(preset.text).expect("presets are valid");
    document.people.identities = None;
    let library = Library::new(&[], 1024).expect("built-in assets load");
    let sampler = Sampler::new(Arc::new(document), catalogue(&library)).expect("presets are valid");
    let people: Vec<_> = (0..frames).flat_map(|frame| sampler.scene(frame).people).collect();
    let count = people.len() as f64;
    println!("{} people of {name}", people.len());

    let wanted: Option<usize> = words.get(2).and_then(|n| n.parse().ok());
    let start = seconds(clock);
    let body = |p: &figurant_core::scene::Person| {
        rest_body(&library.figure, &p.body, &p.look.face).expect("sampled targets exist")
    };
    let bodies: Vec<_> = people.iter().map(body).collect();
    println!("body at rest      {:7.3} ms", (seconds(clock) - start) * 1e3 / count);
    for lod in (0..LOD_COUNT).filter(|lod| wanted.is_none_or(|w| w == *lod)) {
        let (mut spent, mut size, mut digest) = (0.0, [0; 3], 0);
        for (person, body) in people.iter().zip(&bodies) {
            let start = seconds(clock);
            let mesh = dress(&library.figure, person, body, lod).mesh;
            spent += seconds(clock) - start;
            let parts = [mesh.positions.len(), mesh.triangles.len(), mesh.size_bytes()];
            size = [0, 1, 2].map(|i| size[i] + parts[i]);
            digest = digested(digest, &mesh);
        }
        let ms = spent * 1e3 / count;
        let [vertices, triangles, bytes] = size.map(|sum| sum as f64 / count);
        let error_mm = library.figure.lod_error_m(lod) * 1e3;
        println!(
            "level {lod}, {error_mm:4.1} mm  {ms:7.3} ms {vertices:8.0} vertices {triangles:8.0} \
             triangles {:6.0} KiB  digest {digest:016x}",
            bytes / 1024.0
        );
    }
}
