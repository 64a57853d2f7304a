// The same pictures as shade.rs and raster.rs make without a graphics card:
// a change here is a change there.

struct Light {
    // Directions in the camera's axes: right, up, towards the viewer.
    up: vec4f,
    key: vec4f,
    fill: vec4f,
    // From the floor, from the sky, of the key lamp, of the fill lamp.
    strength: vec4f,
    // Which part of the picture this pass draws: scale and shift of x and y.
    crop: vec4f,
}

@group(0) @binding(0) var<uniform> light: Light;
@group(1) @binding(0) var picture: texture_2d<f32>;
@group(1) @binding(1) var reading: sampler;

// Leave out what lies below the cutoff.
override MASKED: bool = false;
// Let what lies behind shine through.
override BLENDED: bool = false;

// The same under any lamp.
override UNLIT: bool = false;

struct Corner {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
    @location(3) colour: vec4f,
}

struct Placement {
    @location(4) clip0: vec4f,
    @location(5) clip1: vec4f,
    @location(6) clip2: vec4f,
    @location(7) clip3: vec4f,
    // The normals' columns; the first carries the cutoff as its fourth number.
    @location(8) normal0: vec4f,
    @location(9) normal1: vec4f,
    @location(10) normal2: vec4f,
    @location(11) colour: vec4f,
}

struct Point {
    @builtin(position) position: vec4f,
    @location(0) normal: vec3f,
    @location(1) uv: vec2f,
    @location(2) colour: vec4f,
    @location(3) @interpolate(flat) cutoff: f32,
}

@vertex
fn place(corner: Corner, at: Placement) -> Point {
    let p = corner.position;
    let n = corner.normal;
    var point: Point;
    let clip = at.clip0 * p.x + at.clip1 * p.y + at.clip2 * p.z + at.clip3;
    point.position = vec4f(clip.xy * light.crop.xy + light.crop.zw * clip.w, clip.zw);
    point.normal = at.normal0.xyz * n.x + at.normal1.xyz * n.y + at.normal2.xyz * n.z;
    point.uv = corner.uv;
    point.colour = corner.colour * at.colour;
    point.cutoff = at.normal0.w;
    return point;
}

// The level of the texture whose pixels come nearest to the picture's.
fn level(uv: vec2f) -> f32 {
    let size = vec2f(textureDimensions(picture));
    let across = dpdx(uv) * size;
    let down = dpdy(uv) * size;
    let area = max(dot(across, across), dot(down, down));
    return floor(0.5 * log2(max(area, 1.0)) + 0.5);
}

@fragment
fn shade(point: Point, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let surface = textureSampleLevel(picture, reading, point.uv, level(point.uv));
    let colour = clamp(point.colour, vec4f(0.0), vec4f(1.0)) * surface;
    if MASKED && colour.a < point.cutoff {
        discard;
    }
    let alpha = select(1.0, colour.a, BLENDED);
    let bright = select(brightness(point.normal, front), 1.0, UNLIT);
    let lit = min(colour.rgb * bright, vec3f(1.0));
    return vec4f(lit * alpha, alpha);
}

fn brightness(normal: vec3f, front: bool) -> f32 {
    let length = length(normal);
    let facing = select(-1.0, 1.0, front);
    // What has no normal faces the viewer.
    var n = vec3f(0.0, 0.0, 1.0);
    if length > 0.0 {
        n = normal * (facing / length);
    }
    let sky = 0.5 + 0.5 * dot(n, light.up.xyz);
    let s = light.strength;
    return s.x + (s.y - s.x) * sky
        + s.z * max(dot(n, light.key.xyz), 0.0)
        + s.w * max(dot(n, light.fill.xyz), 0.0);
}
