// Bin: which primitives touch which tile of a band.
//
// `count` counts them by tile and moves those that touch very many to a list of their own;
// scan.wgsl lays out one list for each tile; `scatter` fills them, in any order. One
// invocation takes primitives in turn.

@group(0) @binding(1) var<uniform> raster_target: Target;
@group(0) @binding(2) var<storage, read_write> primitives: array<Primitive>;
@group(0) @binding(3) var<storage, read_write> counters: array<atomic<u32>, 8>;
@group(0) @binding(4) var<storage, read_write> tiles: array<array<atomic<u32>, 2>>;
@group(0) @binding(5) var<storage, read_write> lists: array<u32>;

// Primitives that touch more tiles than this are looked at by every tile.
const MANY_TILES: i32 = 256;

fn primitive_count() -> u32 {
    return min(atomicLoad(&counters[0]), arrayLength(&primitives));
}

@compute @workgroup_size(64)
fn count(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let end = primitive_count();
    for (var i = id.x; i < end; i += 64u * groups.x) {
        let t = touched(primitives[i].x, primitives[i].y);
        // Of the band before it may be large.
        let flags = primitives[i].flags & ~LARGE;
        let small = (flags & SMALL) != 0u;
        let others = select(raster_target.tiles.x * raster_target.tiles.y, 0u, small);
        let many = (t.y - t.x + 1) * (t.w - t.z + 1) > MANY_TILES;
        if many {
            let slot = atomicAdd(&counters[1], 1u);
            if slot < LARGE_ROOM {
                lists[slot] = i;
                primitives[i].flags = flags | LARGE;
                continue;
            }
        }
        primitives[i].flags = flags;
        for (var row = t.z; row <= t.w; row++) {
            for (var column = t.x; column <= t.y; column++) {
                let tile = u32(row) * raster_target.tiles.x + u32(column);
                atomicAdd(&tiles[others + tile][0], 1u);
            }
        }
    }
}

@compute @workgroup_size(64)
fn scatter(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let end = primitive_count();
    for (var i = id.x; i < end; i += 64u * groups.x) {
        if (primitives[i].flags & LARGE) != 0u {
            continue;
        }
        let t = touched(primitives[i].x, primitives[i].y);
        let small = (primitives[i].flags & SMALL) != 0u;
        let others = select(raster_target.tiles.x * raster_target.tiles.y, 0u, small);
        for (var row = t.z; row <= t.w; row++) {
            for (var column = t.x; column <= t.y; column++) {
                let tile = u32(row) * raster_target.tiles.x + u32(column);
                let at = atomicAdd(&tiles[others + tile][1], 1u);
                if at < arrayLength(&lists) {
                    lists[at] = i;
                }
            }
        }
    }
}
