// Depth of field, second: what disks bring to each texel.
//
// Reads the layers; writes light beyond the focus, and light before it with how much that covers.
// One invocation a texel.

@group(0) @binding(1) var<storage, read> layers: array<array<u32, 5>>;
@group(0) @binding(2) var<storage, read> widest: array<array<u32, 2>>;
@group(0) @binding(3) var<storage, read_write> gathered: array<vec4<u32>>;

// Place of a texel; beyond the border, that of the nearest within.
fn place(at: vec2<i32>, size: vec2<u32>) -> u32 {
    let inside = vec2<u32>(clamp(at, vec2<i32>(0), vec2<i32>(size) - 1));
    return inside.y * size.x + inside.x;
}

fn near_layer(at: u32) -> vec4<f32> {
    return vec4<f32>(unpack2x16float(layers[at][0]), unpack2x16float(layers[at][1]));
}

fn far_layer(at: u32) -> vec4<f32> {
    return vec4<f32>(unpack2x16float(layers[at][2]), unpack2x16float(layers[at][3]));
}

fn reach(radius: f32) -> i32 {
    return i32(ceil(radius + 0.5)) - 1;
}

// The widest disk before the focus, of the squares around.
fn widest_around(square: vec2<u32>, squares: vec2<u32>) -> f32 {
    var most = 0.0;
    let end = min(square + 2u, squares);
    for (var y = max(square.y, 1u) - 1u; y < end.y; y++) {
        for (var x = max(square.x, 1u) - 1u; x < end.x; x++) {
            most = max(most, bitcast<f32>(widest[y * squares.x + x][0]));
        }
    }
    return most;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = layer_size();
    if any(id.xy >= size) {
        return;
    }
    let own = place(vec2<i32>(id.xy), size);
    let radii = unpack2x16float(layers[own][4]);
    let areas = vec2<f32>(per_area(radii.x), per_area(radii.y));
    let square = id.xy / SQUARE;
    let squares = (size + SQUARE - 1u) / SQUARE;
    let of_square = widest[square.y * squares.x + square.x];
    let far_reach = reach(max(bitcast<f32>(of_square[0]), bitcast<f32>(of_square[1])));
    var beyond = vec4<f32>(0.0);
    for (var dy = -far_reach; dy <= far_reach; dy++) {
        for (var dx = -far_reach; dx <= far_reach; dx++) {
            let at = place(vec2<i32>(id.xy) + vec2<i32>(dx, dy), size);
            let theirs = unpack2x16float(layers[at][4]).y;
            let radius = max(min(theirs, radii.y), radii.x);
            let area = min(max(per_area(theirs), areas.y), areas.x);
            let weight = cover(radius, sqrt(f32(dx * dx + dy * dy))) * area;
            beyond += far_layer(at) * weight;
        }
    }
    let near_reach = reach(widest_around(square, squares));
    var before = vec4<f32>(0.0);
    for (var dy = -near_reach; dy <= near_reach; dy++) {
        for (var dx = -near_reach; dx <= near_reach; dx++) {
            let at = place(vec2<i32>(id.xy) + vec2<i32>(dx, dy), size);
            let radius = unpack2x16float(layers[at][4]).x;
            let weight = cover(radius, sqrt(f32(dx * dx + dy * dy))) * per_area(radius);
            before += near_layer(at) * weight;
        }
    }
    var light = far_layer(own).xyz + near_layer(own).xyz;
    if beyond.w > LEAST_SHARE {
        light = beyond.xyz * (1.0 / beyond.w);
    }
    before *= 1.0 / max(before.w, 1.0);
    gathered[own] = vec4<u32>(
        pack2x16float(light.xy),
        pack2x16float(vec2<f32>(light.z, before.w)),
        pack2x16float(before.xy),
        pack2x16float(vec2<f32>(before.z, 0.0)),
    );
}
