// Spheres that keep surrounding light off what is near them. core/src/draw/abi.rs has the formula,
// core/src/engine/cpu/shade/light.rs the other engine's form of it. Needs blockers and a workgroup
// of 8 x 8 pixels that runs all of find_blockers.

const BLOCKER_REACH: f32 = 4.0;
const BLOCKER_OWN_BIAS: f32 = 0.25;
const BLOCKER_WORDS: u32 = MAX_BLOCKERS / 32u;
const GROUP: u32 = 64u;

// Which spheres may reach what the workgroup shows, a bit each: in order, however they were found.
var<workgroup> reaching: array<atomic<u32>, BLOCKER_WORDS>;
// Largest and smallest depth of its samples as bits, and the box of its rays.
var<workgroup> nearest: atomic<u32>;
var<workgroup> farthest: atomic<u32>;
var<workgroup> ray_low: array<atomic<u32>, 2>;
var<workgroup> ray_high: array<atomic<u32>, 2>;

// Numbers in an order that is that of the floats.
fn ordered(x: f32) -> u32 {
    let bits = bitcast<u32>(x);
    return select(bits | 0x80000000u, ~bits, (bits & 0x80000000u) != 0u);
}

fn unordered(x: u32) -> f32 {
    return bitcast<f32>(select(~x, x & 0x7fffffffu, (x & 0x80000000u) != 0u));
}

// Finds the spheres for a workgroup; `first` are the samples of the invocation's pixel, if it is
// `inside` the picture, and `ray` leads through the pixel's middle.
fn find_blockers(index: u32, inside: bool, first: u32, ray: vec2<f32>) {
    for (var w = index; w < BLOCKER_WORDS; w += GROUP) {
        atomicStore(&reaching[w], 0u);
    }
    if index == 0u {
        atomicStore(&nearest, 0u);
        atomicStore(&farthest, 0xffffffffu);
        for (var axis = 0; axis < 2; axis++) {
            atomicStore(&ray_low[axis], 0xffffffffu);
            atomicStore(&ray_high[axis], 0u);
        }
    }
    workgroupBarrier();
    if inside {
        for (var i = 0u; i < SAMPLES; i++) {
            let own = samples[first + i];
            if own.x != NOTHING {
                atomicMax(&nearest, own.y);
                atomicMin(&farthest, own.y);
            }
        }
        for (var axis = 0; axis < 2; axis++) {
            atomicMin(&ray_low[axis], ordered(ray[axis]));
            atomicMax(&ray_high[axis], ordered(ray[axis]));
        }
    }
    workgroupBarrier();
    let depth = vec2<f32>(
        bitcast<f32>(atomicLoad(&nearest)),
        bitcast<f32>(atomicLoad(&farthest)),
    );
    if depth.x > 0.0 {
        let distance = frame.near_m / depth * vec2<f32>(0.9999, 1.0001);
        var low = vec2<f32>(unordered(atomicLoad(&ray_low[0])), unordered(atomicLoad(&ray_low[1])));
        var high =
            vec2<f32>(unordered(atomicLoad(&ray_high[0])), unordered(atomicLoad(&ray_high[1])));
        // From the middles of the outer pixels to beyond their edges.
        let more = (high - low) * (1.0 / 7.0) + 1.0 / frame.focal;
        low -= more;
        high += more;
        let box_low = vec3<f32>(min(low * distance.x, low * distance.y), -distance.y);
        let box_high = vec3<f32>(max(high * distance.x, high * distance.y), -distance.x);
        for (var i = index; i < frame.blocker_count; i += GROUP) {
            let sphere = blockers[i];
            let way = max(max(box_low - sphere.center, sphere.center - box_high), vec3<f32>(0.0));
            let reach = BLOCKER_REACH * sphere.radius_m;
            if dot(way, way) < reach * reach {
                atomicOr(&reaching[i / 32u], 1u << (i % 32u));
            }
        }
    }
    workgroupBarrier();
}

// Share of surrounding light that the spheres found let through; `own` are the object's.
fn unblocked(position: vec3<f32>, normal: vec3<f32>, own: vec2<u32>) -> f32 {
    var open = 1.0;
    let words = (frame.blocker_count + 31u) / 32u;
    for (var w = 0u; w < words; w++) {
        var bits = atomicLoad(&reaching[w]);
        while bits != 0u {
            let i = w * 32u + firstTrailingBit(bits);
            bits &= bits - 1u;
            let sphere = blockers[i];
            let way = sphere.center - position;
            let distance2 = max(dot(way, way), 1e-12);
            let reach = BLOCKER_REACH * sphere.radius_m;
            let far = distance2 / max(reach * reach, 1e-12);
            if far >= 1.0 {
                continue;
            }
            let bias = select(0.0, BLOCKER_OWN_BIAS, i >= own.x && i < own.y);
            let cosine = dot(normal, way) / sqrt(distance2);
            let faces = max(cosine - bias, 0.0) * (1.0 / (1.0 - bias));
            let share = min(sphere.radius_m * sphere.radius_m / distance2, 1.0);
            let window = 1.0 - far * far;
            open *= 1.0 - faces * share * (window * window);
        }
    }
    return open;
}
