// The shaders of `puppet.js`.

/** A corner of a triangle, from a texture of points. A skirt's outer corners lie beyond the boundary. */
const CORNER = `
layout(location = 0) in uvec4 corner; // vertex, the ones before and after it on the boundary, 1 on a skirt's outer side
uniform sampler2D places;
uniform vec2 size;   // of the canvas, in pixels
uniform vec3 view;   // pixels a drawing unit, and where the origin is
uniform float skirt; // in drawing units
vec2 fetched(sampler2D from, uint i, int row) { return texelFetch(from, ivec2(i & 1023u, int(i >> 10) + row), 0).xy; }
vec4 placed() {
  vec2 p = fetched(places, corner.x, 0);
  if (corner.w == 1u) {
    vec2 along = fetched(places, corner.z, 0) - fetched(places, corner.y, 0);
    p += skirt * vec2(along.y, -along.x) / max(length(along), 1e-6);
  }
  vec2 clip = (p * view.x + view.yz) / size * 2.0 - 1.0;
  return vec4(clip.x, -clip.y, 0.0, 1.0);
}`;

const LIGHT = `
vec3 light(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c)); }
vec3 value(vec3 c) { return mix(c * 12.92, 1.055 * pow(max(c, 0.0), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)); }`;

/** So many textures, added up by their weights and cut by the area that the silhouette covers. */
export const textured = (count) => {
  const each = (line) => Array.from({ length: count }, (_, k) => line.replaceAll('$', k)).join('\n');
  return [`${CORNER}
uniform sampler2D drawn;      // the places in the poses that the textures are of, one below the other
uniform int rows[${count}];   // where those of a texture begin
uniform vec4 texels[${count}]; // texture coordinate = place * texels.xy + texels.zw
${each('out vec2 uv$;')}
void main() {
  ${each('uv$ = fetched(drawn, corner.x, rows[$]) * texels[$].xy + texels[$].zw;')}
  gl_Position = placed();
}`, `${LIGHT}
uniform sampler2D areas;
${each('uniform sampler2D picture$;')}
uniform float weights[${count}];
uniform float levels[${count}];
uniform bool in_light;
uniform float height;
uniform float opacity;
uniform vec4 tint; // mixed in by its alpha
${each('in vec2 uv$;')}
out vec4 colour;
vec4 premultiplied(vec4 c) { return vec4((in_light ? light(c.rgb) : c.rgb) * c.a, c.a); }
void main() {
  float area = texelFetch(areas, ivec2(gl_FragCoord.x, height - gl_FragCoord.y), 0).r;
  if (area == 0.0) discard;
  vec4 sum = vec4(0.0);
  ${each('sum += weights[$] * premultiplied(textureLod(picture$, uv$, levels[$]));')}
  if (in_light && sum.a > 0.0) sum.rgb = value(sum.rgb / sum.a) * sum.a;
  sum.rgb = mix(sum.rgb, tint.rgb * sum.a, tint.a);
  colour = sum * area * opacity;
}`];
};

/** The triangles' edges, the inverted ones filled. */
export const MESH = [`${CORNER}
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
