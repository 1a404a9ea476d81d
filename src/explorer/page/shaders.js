// @ts-check
// The shaders of `puppet.js`.

/**
 * A vertex's place, which is the attribute of this number, on the canvas.
 * @type {(location: number) => string}
 */
const placed = (location) => `
layout(location = ${location}) in vec2 place; // in drawing units
uniform vec2 size; // of the canvas, in pixels
uniform vec3 view; // pixels a drawing unit, and where the origin is
vec4 placed() {
  vec2 clip = (place * view.x + view.yz) / size * 2.0 - 1.0;
  return vec4(clip.x, -clip.y, 0.0, 1.0);
}`;

const LIGHT = `
vec3 light(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c)); }
vec3 value(vec3 c) { return mix(c * 12.92, 1.055 * pow(max(c, 0.0), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)); }`;

/**
 * So many textures, added up by their weights, in light or as values, and cut by the area that the silhouette covers. Whether in light
 * is not asked in the shader: where both sides of a question are computed, as on processors, powers cost more than all else.
 * @type {(count: number, inLight: boolean) => [string, string]}
 */
export const textured = (count, inLight) => {
  /** @type {(line: string) => string} */
  const each = (line) => Array.from({ length: count }, (_, k) => line.replaceAll('$', String(k))).join('\n');
  return [`${placed(count)}
${each('layout(location = $) in vec2 at$; // where in the texture')}
${each('out vec2 uv$;')}
void main() {
  ${each('uv$ = at$;')}
  gl_Position = placed();
}`, `${inLight ? LIGHT : ''}
uniform sampler2D areas;
${each('uniform sampler2D picture$;')}
uniform float weights[${count}];
uniform float levels[${count}];
uniform float height;
uniform float opacity;
uniform vec4 tint; // mixed in by its alpha
${each('in vec2 uv$;')}
out vec4 colour;
vec4 premultiplied(vec4 c) { return vec4(${inLight ? 'light(c.rgb)' : 'c.rgb'} * c.a, c.a); }
void main() {
  float area = texelFetch(areas, ivec2(gl_FragCoord.x, height - gl_FragCoord.y), 0).r;
  vec4 sum = vec4(0.0);
  ${each('sum += weights[$] * premultiplied(textureLod(picture$, uv$, levels[$]));')}
  ${inLight ? 'if (sum.a > 0.0) sum.rgb = value(sum.rgb / sum.a) * sum.a;' : ''}
  sum.rgb = mix(sum.rgb, tint.rgb * sum.a, tint.a);
  colour = sum * area * opacity;
}`];
};

/**
 * The triangles' edges, the inverted ones filled.
 * @type {[string, string]}
 */
export const MESH = [`${placed(0)}
out vec3 corners;
void main() {
  corners = vec3(gl_VertexID % 3 == 0, gl_VertexID % 3 == 1, gl_VertexID % 3 == 2);
  gl_Position = placed();
}`, `
uniform vec4 line;
uniform vec4 wrong;
uniform float thickness;
in vec3 corners;
out vec4 colour;
void main() {
  vec3 far = corners / max(fwidth(corners), vec3(1e-6));
  float near = clamp(thickness + 0.5 - min(far.x, min(far.y, far.z)), 0.0, 1.0);
  colour = gl_FrontFacing ? line * near : mix(wrong * 0.45, wrong, near);
}`];

/**
 * A picture whose texels are shown as squares, in a box of the canvas: left, top, width and height in pixels.
 * @type {[string, string]}
 */
export const SQUARES = [`
uniform vec2 size; // of the canvas, in pixels
uniform vec4 box;
out vec2 at;
void main() {
  at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  vec2 clip = (box.xy + at * box.zw) / size * 2.0 - 1.0;
  gl_Position = vec4(clip.x, -clip.y, 0.0, 1.0);
}`, `
uniform sampler2D picture;
uniform float opacity;
in vec2 at;
out vec4 colour;
void main() {
  vec4 texel = texture(picture, at);
  colour = vec4(texel.rgb * texel.a, texel.a) * opacity;
}`];
