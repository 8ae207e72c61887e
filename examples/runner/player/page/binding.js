// The mesh on the curve-pairs, evaluated on the graphics card: a point is its place in the nearest share's frame, plus
// the weighted differences of its other shares' places to that. Lengths are over the mesh's size, about its middle.

import {BufferAttribute, Color, DataTexture, FloatType, Matrix4, Mesh, Quaternion, RGBAFormat, SRGBColorSpace, Vector3} from 'three';
import {mergeVertices} from 'three/addons/utils/BufferGeometryUtils.js';
import {creased, lit} from './shape.js';

// Stands before the shader that three.js makes of a material.
const bindingShader = degree => `
uniform sampler2D spans;   // a row a span: curve (w: turn), derivative, offset, in Bernstein form
uniform sampler2D shares;  // three texels a share: (s, u, v, w), (weight, span), rest frame
uniform int sharesWidth;
uniform float marked;      // how far points of several shares are colored
in uint first;
in uint count;
out vec4 bound;            // w: how many shares
vec4 turned;               // quaternion, since rest
const int P = ${degree};

vec4 share(int index) {
  return texelFetch(shares, ivec2(index % sharesWidth, index / sharesWidth), 0);
}
vec4 curve(int row, int from, int degree, float s) {
  vec4 b[P + 1];
  for (int j = 0; j <= P; ++j) if (j <= degree) b[j] = texelFetch(spans, ivec2(from + j, row), 0);
  for (int r = P; r > 0; --r) if (r <= degree)
    for (int j = 0; j < P; ++j) if (j < r) b[j] = mix(b[j], b[j + 1], s);
  return b[0];
}
vec4 times(vec4 a, vec4 b) {
  return vec4(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz));
}
vec4 quaternion(vec3 x, vec3 y, vec3 z) {
  vec4 four = 1.0 + vec4(x.x - y.y - z.z, y.y - x.x - z.z, z.z - x.x - y.y, x.x + y.y + z.z);
  if (four.w > 1.0) return normalize(vec4(y.z - z.y, z.x - x.z, x.y - y.x, four.w));
  if (four.x >= four.y && four.x >= four.z) return normalize(vec4(four.x, x.y + y.x, z.x + x.z, y.z - z.y));
  if (four.y >= four.z) return normalize(vec4(x.y + y.x, four.y, y.z + z.y, z.x - x.z));
  return normalize(vec4(z.x + x.z, y.z + z.y, four.z, x.y - y.x));
}
// (cos, sin) to single precision, which GLSL does not promise of its own: reduced to an eighth of a turn, then the
// polynomials of the Cephes library.
vec2 turn(float angle) {
  float quarters = floor(angle * 0.63661977 + 0.5);
  float r = ((angle - quarters * 1.5703125) - quarters * 4.83751297e-4) - quarters * 7.54978995e-8, z = r * r;
  float c = 1.0 - 0.5 * z + z * z * (4.166664568e-2 + z * (-1.388731625e-3 + z * 2.443315712e-5));
  float s = r + r * z * (-1.6666654611e-1 + z * (8.3321608736e-3 - z * 1.9515295891e-4));
  int k = int(quarters) & 3;
  return k == 0 ? vec2(c, s) : k == 1 ? vec2(-s, c) : k == 2 ? vec2(-c, -s) : vec2(s, -c);
}
void place(int index, out vec3 point, out vec4 frame, out float weight) {
  vec4 record = share(3 * index), more = share(3 * index + 1);
  int row = int(more.y);
  vec4 c = curve(row, 0, P, record.x);
  vec3 h = curve(row, P + 1, P - 1, record.x).xyz;
  vec3 n = curve(row, 2 * P + 1, P, record.x).xyz;
  vec3 z = normalize(h), x0 = normalize(cross(n, z)), y0 = cross(z, x0);
  vec2 t = turn(c.w);
  vec3 x = t.x * x0 + t.y * y0, y = t.x * y0 - t.y * x0;
  point = c.xyz + (record.y * x + record.z * y + record.w * z);
  frame = times(quaternion(x, y, z), share(3 * index + 2));
  weight = more.x;
}
void bind(vec3 rest) {
  bound = vec4(rest, float(count));
  turned = vec4(0.0, 0.0, 0.0, 1.0);
  if (count == 0u) return;
  vec3 base, other;
  vec4 frame, sum;
  float weight;
  place(int(first), base, sum, weight);
  sum *= weight;
  vec3 more = vec3(0.0);
  for (uint k = 1u; k < count; ++k) {
    place(int(first + k), other, frame, weight);
    more += weight * (other - base);
    sum += weight * (dot(sum, frame) < 0.0 ? -frame : frame);
  }
  bound.xyz = base + more;
  turned = normalize(sum);
}
`;

// What the shader of a material does instead, or besides, at its parts.
const kBound = [
  ['#include <uv_vertex>', 'bind(position);'],
  ['#include <color_vertex>', '#include <color_vertex>\n#ifdef USE_COLOR\nif (bound.w > 1.5) vColor.rgb = mix(vColor.rgb, vec3(0.75, 0.12, 0.05), marked);\n#endif'],
  ['#include <beginnormal_vertex>', 'vec3 objectNormal = normal + 2.0 * cross(turned.xyz, cross(turned.xyz, normal) + turned.w * normal);'],
  ['#include <begin_vertex>', 'vec3 transformed = bound.xyz;'],
];

function texture(values, width) {
  return Object.assign(new DataTexture(values, width, values.length / (4 * width), RGBAFormat, FloatType), {needsUpdate: true});
}

export class BoundMesh extends Mesh {
  constructor(film, spans) {
    const {triangles, colors, points} = film.arrays, rest = Float64Array.from(points, x => x * film.pointUnit);
    const flat = creased(points, triangles, film.pointUnit, [['point', Uint32Array.from({length: rest.length / 3}, (_, i) => i)]]);
    const paint = new Color(), paints = new BufferAttribute(new Float32Array(3 * triangles.length), 3);
    triangles.forEach((i, k) => {
      const packed = colors.length === 0 ? 0x92a1b0 : colors[film.colorsOfFaces ? Math.floor(k / 3) : i];
      paint.setRGB((packed & 255) / 255, (packed >> 8 & 255) / 255, (packed >> 16 & 255) / 255, SRGBColorSpace);
      paints.setXYZ(k, paint.r, paint.g, paint.b);
    });
    flat.setAttribute('color', paints);
    super(mergeVertices(flat), lit({vertexColors: true}));
    this.frustumCulled = false;
    this.spans = spans;
    // Of each vertex that is drawn, the mesh's vertex.
    this.of = this.geometry.attributes.point.array;
    this.geometry.deleteAttribute('point');
    const {first, counts, shares} = this.readShares(film, rest);
    for (const [name, values] of [['first', first], ['count', counts]])
      this.geometry.setAttribute(name, new BufferAttribute(Uint32Array.from(this.of, i => values[i]), 1));
    this.posed = texture(new Float32Array(spans.values.length), spans.row);
    this.marked = {value: 0};
    this.uniforms = {spans: {value: this.posed}, shares: {value: texture(shares, kSharesWidth)}, sharesWidth: {value: kSharesWidth}, marked: this.marked};
    this.bind(this.material);
  }

  // To the curve-pairs goes what is drawn with this material: the mesh, its shadow.
  bind(material) {
    material.onBeforeCompile = shader => {
      Object.assign(shader.uniforms, this.uniforms);
      for (const [part, ours] of kBound) {
        if (!shader.vertexShader.includes(part)) throw new Error(`no ${part} in the shader of ${material.type}`);
        shader.vertexShader = shader.vertexShader.replace(part, ours);
      }
      shader.vertexShader = bindingShader(this.spans.degree) + shader.vertexShader;
    };
  }

  // Records from places: the coordinates are those that give the rest position, to double precision.
  readShares(film, rest) {
    const {near_pair, near_t, other_count, other_place, other_weight, place_pair, place_t} = film.arrays;
    const {spans} = this, size = rest.length / 3;
    spans.pose(film.restControl);
    const frame = (pair, t) => {
      const [from, to] = film.pairs[film.bound[pair]].domain;
      const {span, s} = spans.find(film.bound[pair], from + (to - from) * t / film.parts), f = spans.frame(span, s);
      const back = new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(f.lx, f.ly, f.lz)).conjugate();
      return {...f, span, s, back};
    };
    const places = Array.from(place_pair, (pair, k) => frame(pair, place_t[k]));
    const still = new Set(film.still), first = new Uint32Array(size), counts = new Uint32Array(size);
    let total = 0;
    for (let i = 0; i < size; ++i) {
      first[i] = total;
      counts[i] = still.has(i) ? 0 : 1 + other_count[i];
      total += counts[i];
    }
    const shares = new Float32Array(4 * kSharesWidth * Math.max(1, Math.ceil(3 * total / kSharesWidth)));
    const point = new Vector3(), d = new Vector3();
    let to = 0, other = 0;
    const add = ({span, s, origin, lx, ly, lz, back}, weight) => {
      d.subVectors(point, origin);
      shares.set([s, d.dot(lx), d.dot(ly), d.dot(lz), weight, span, 0, 0, ...back], to);
      to += 12;
    };
    for (let i = 0; i < size; other += other_count[i++]) {
      if (counts[i] === 0) continue;
      point.fromArray(rest, 3 * i);
      const weights = Array.from(other_weight.subarray(other, other + other_count[i]), w => w / film.parts);
      add(frame(near_pair[i], near_t[i]), weights.reduce((left, w) => left - w, 1));
      weights.forEach((w, k) => add(places[other_place[other + k]], w));
    }
    return {first, counts, shares};
  }

  // To the curve-pairs as they are posed.
  update() {
    this.posed.image.data.set(this.spans.values);
    this.posed.needsUpdate = true;
  }
}

const kSharesWidth = 3 * 512;
