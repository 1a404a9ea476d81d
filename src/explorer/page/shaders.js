// The shaders of `puppet.js`. Passes draw upside down, so that `gl_FragCoord` counts rows from the top; the last one turns the
// picture over.

/** A corner of a triangle, from a texture of points. A skirt's outer corners lie beyond the boundary. */
const CORNER = `
layout(location = 0) in uvec4 corner; // vertex, the ones before and after it on the boundary, 1 on a skirt's outer side
uniform sampler2D places;
uniform vec2 size;       // of the target, in pixels
uniform vec3 view;       // pixels a drawing unit, and where the origin is
uniform float skirt;     // in drawing units, the sign says which side is outside
uniform float triangles; // 0: all behind
vec2 fetched(sampler2D from, uint i) { return texelFetch(from, ivec2(i & 1023u, i >> 10), 0).xy; }
vec4 placed() {
  vec2 p = fetched(places, corner.x);
  if (corner.w == 1u) {
    vec2 along = fetched(places, corner.z) - fetched(places, corner.y);
    p += skirt * vec2(along.y, -along.x) / max(length(along), 1e-6);
  }
  // The later of two triangles that overlap is in front, as in the frames.
  float depth = triangles > 0.0 ? 1.0 - 2.0 * float(gl_VertexID / 3 + 1) / (triangles + 2.0) : 1.0;
  return vec4((p * view.x + view.yz) / size * 2.0 - 1.0, depth, 1.0);
}`;

const LIGHT = `
vec3 light(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c)); }
vec3 value(vec3 c) { return mix(c * 12.92, 1.055 * pow(max(c, 0.0), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)); }`;

/** One texture, times its weight. */
export const TEXTURED = [`${CORNER}
uniform sampler2D drawn; // the places in the pose that the texture is of
uniform vec4 texels;     // texture coordinate = place * texels.xy + texels.zw
out vec2 uv;
void main() {
  uv = fetched(drawn, corner.x) * texels.xy + texels.zw;
  gl_Position = placed();
}`, `${LIGHT}
uniform sampler2D picture;
uniform float weight;
uniform bool in_light;
in vec2 uv;
out vec4 colour;
void main() {
  vec4 c = texture(picture, uv);
  colour = weight * vec4((in_light ? light(c.rgb) : c.rgb) * c.a, c.a);
}`];

/** The area to the right of one edge in each pixel, signed; edges are instances. */
export const AREA = [`
layout(location = 0) in vec4 ends; // x, y, x, y in drawing units
uniform vec2 size;
uniform vec3 view;
uniform vec4 window; // left, top, right, bottom
flat out vec4 edge;
void main() {
  edge = vec4(ends.xy * view.x + view.yz, ends.zw * view.x + view.yz);
  float left = clamp(floor(min(edge.x, edge.z)), window.x, window.z);
  float top = clamp(floor(min(edge.y, edge.w)), window.y, window.w);
  float bottom = clamp(ceil(max(edge.y, edge.w)), window.y, window.w);
  vec2 p = vec2((gl_VertexID & 1) == 0 ? left : window.z, (gl_VertexID & 2) == 0 ? top : bottom);
  gl_Position = vec4(p / size * 2.0 - 1.0, 0.0, 1.0);
}`, `
flat in vec4 edge;
out vec4 area;
float whole(float x) { return x <= 0.0 ? 0.0 : x >= 1.0 ? x - 0.5 : 0.5 * x * x; }
void main() {
  vec2 pixel = gl_FragCoord.xy - 0.5;
  float from = clamp(edge.y, pixel.y, pixel.y + 1.0), to = clamp(edge.w, pixel.y, pixel.y + 1.0);
  float fall = to - from;
  if (fall == 0.0) { area = vec4(0.0); return; }
  float slope = (edge.z - edge.x) / (edge.w - edge.y);
  float a = edge.x + (from - edge.y) * slope - pixel.x, b = edge.x + (to - edge.y) * slope - pixel.x;
  float outside = abs(b - a) < 1e-3 ? clamp(0.5 * (a + b), 0.0, 1.0) : (whole(b) - whole(a)) / (b - a);
  area = vec4(fall * (1.0 - outside));
}`];

/** Colours cut by areas, turned over, on what is there. */
export const CUT = [`
void main() {
  vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(p * 4.0 - 1.0, 0.0, 1.0);
}`, `${LIGHT}
uniform sampler2D colours;
uniform sampler2D areas;
uniform float height;
uniform float opacity;
uniform bool in_light;
uniform vec4 tint; // mixed in by its alpha
out vec4 colour;
void main() {
  ivec2 at = ivec2(gl_FragCoord.x, height - gl_FragCoord.y);
  vec4 c = texelFetch(colours, at, 0);
  if (in_light && c.a > 0.0) c.rgb = value(c.rgb / c.a) * c.a;
  c.rgb = mix(c.rgb, tint.rgb * c.a, tint.a);
  colour = c * min(abs(texelFetch(areas, at, 0).r), 1.0) * opacity;
}`];

/** The triangles' edges, the inverted ones filled. */
export const MESH = [`${CORNER}
uniform float height;
out vec3 corners;
void main() {
  vec4 p = placed();
  corners = vec3(gl_VertexID % 3 == 0, gl_VertexID % 3 == 1, gl_VertexID % 3 == 2);
  gl_Position = vec4(p.x, -p.y, 0.0, 1.0);
}`, `
uniform vec4 line;
uniform vec4 wrong;
uniform float thickness;
in vec3 corners;
out vec4 colour;
void main() {
  vec3 far = corners / max(fwidth(corners), vec3(1e-6));
  float near = clamp(thickness + 0.5 - min(far.x, min(far.y, far.z)), 0.0, 1.0);
  // Turned over by this pass: what is the right way round shows its back.
  bool inverted = gl_FrontFacing;
  vec4 drawn = inverted ? mix(wrong * 0.45, wrong, near) : line * near;
  colour = drawn;
}`];
