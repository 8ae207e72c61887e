// Points on the curve-pairs, evaluated in a vertex shader: a point is its place in the nearest share's frame, plus the
// weighted differences of its other shares' places to that. Lengths are over the mesh's size, about its middle.

import {
  BufferAttribute, BufferGeometry, Camera, DataTexture, FloatType, GLSL3, Matrix4, NearestFilter, NoBlending, Points, Quaternion, RawShaderMaterial,
  RGBAFormat, Vector2, Vector3, WebGLRenderTarget,
} from 'three';

const vertexShader = degree => `
precision highp float;
precision highp int;
precision highp sampler2D;
uniform sampler2D spans;   // a row a span: curve (w: turn), derivative, offset, in Bernstein form
uniform sampler2D shares;  // three texels a share: (s, u, v, w), (weight, span), rest frame
uniform int sharesWidth;
uniform ivec2 size;        // of what is drawn into, a texel a point
in uint first;
in uint count;
in vec3 position;          // at rest
flat out vec4 bound;       // w: how many shares
flat out vec4 turned;      // quaternion, since rest
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
void bind() {
  bound = vec4(position, float(count));
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
void main() {
  bind();
  vec2 texel = vec2(gl_VertexID % size.x, gl_VertexID / size.x) + 0.5;
  gl_Position = vec4(2.0 * texel / vec2(size) - 1.0, 0.0, 1.0);
  gl_PointSize = 1.0;
}`;

const kFragmentShader = `
precision highp float;
flat in vec4 bound, turned;
layout(location = 0) out vec4 place;
layout(location = 1) out vec4 turn;
void main() {
  place = bound;
  turn = turned;
}`;

function texture(values, width) {
  return Object.assign(new DataTexture(values, width, values.length / (4 * width), RGBAFormat, FloatType), {needsUpdate: true});
}

export class Binding {
  // rest: of the points, three numbers each
  constructor(film, spans, rest) {
    this.spans = spans;
    const {first, counts, shares} = this.readShares(film, rest), count = rest.length / 3;
    this.posed = texture(new Float32Array(spans.values.length), spans.row);
    const size = new Vector2(Math.min(kWidth, count), Math.ceil(count / kWidth));
    // Where each point is, and how it is turned: drawn once a pose, read by all that show the mesh.
    this.target = new WebGLRenderTarget(size.x, size.y, {
      count: 2, type: FloatType, minFilter: NearestFilter, magFilter: NearestFilter, depthBuffer: false});
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(Float32Array.from(rest), 3));
    geometry.setAttribute('first', new BufferAttribute(first, 1));
    geometry.setAttribute('count', new BufferAttribute(counts, 1));
    this.points = new Points(geometry, new RawShaderMaterial({
      glslVersion: GLSL3, vertexShader: vertexShader(spans.degree), fragmentShader: kFragmentShader,
      uniforms: {
        spans: {value: this.posed}, shares: {value: texture(shares, kSharesWidth)}, sharesWidth: {value: kSharesWidth}, size: {value: size}},
      blending: NoBlending, depthTest: false, depthWrite: false}));
    this.points.frustumCulled = false;
  }

  // To the curve-pairs as they are posed.
  evaluate(renderer) {
    this.posed.image.data.set(this.spans.values);
    this.posed.needsUpdate = true;
    renderer.setRenderTarget(this.target);
    renderer.render(this.points, new Camera());
    renderer.setRenderTarget(null);
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
}

const kWidth = 1024, kSharesWidth = 3 * 512;
