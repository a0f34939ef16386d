// Present: the 8-bit picture of a band, from the buffer that shading writes to a texture that a
// window shows. Both hold display light; nothing is converted. One invocation a pixel.

@group(0) @binding(1) var<uniform> raster_target: Target;
@group(0) @binding(2) var<storage, read> picture: array<u32>;
@group(0) @binding(3) var shown: texture_storage_2d<rgba8unorm, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= raster_target.width || id.y >= raster_target.band_height {
        return;
    }
    let color = unpack4x8unorm(picture[id.y * raster_target.width + id.x]);
    let at = vec2<u32>(id.x, id.y + raster_target.first_y);
    textureStore(shown, at, vec4<f32>(color.rgb, 1.0));
}
