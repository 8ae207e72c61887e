// The mesh on the curve-pairs, evaluated on the graphics card: a point is its place in the nearest share's frame, plus
// the weighted differences of its other shares' places to that. Lengths are over the mesh's size, about its middle.

const bindingShader = spans => `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
uniform sampler2D spans;   // a row a span: curve (w: turn), derivative, offset, in Bernstein form
uniform sampler2D shares;  // three texels a share: (s, u, v, w), (weight, span), rest frame
uniform int sharesWidth;
in uint first;
in uint count;
in vec3 rest;
out vec4 position;  // w: how many shares
out vec4 turned;    // quaternion, since rest
const int P = ${spans.degree};

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
void main() {
  position = vec4(rest, float(count));
  turned = vec4(0.0, 0.0, 0.0, 1.0);
  if (count > 0u) {
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
    position.xyz = base + more;
    turned = normalize(sum);
  }
  gl_Position = vec4(0.0);
  gl_PointSize = 1.0;
}`;

class BoundMesh {
  // of: the point of each vertex that is drawn; the first ones are the points in turn
  constructor(gl, film, spans, rest, of) {
    this.gl = gl;
    this.spans = spans;
    this.count = rest.length / 3;
    this.rest = rest;
    this.readShares(film);
    this.vertices = of.length;
    this.program = program(gl, bindingShader(spans), `#version 300 es
      void main() {}`, ['position', 'turned']);
    this.vao = gl.createVertexArray();
    gl.bindVertexArray(this.vao);
    attribute(gl, this.program, 'first', Uint32Array.from(of, i => this.first[i]), 1, true);
    attribute(gl, this.program, 'count', Uint32Array.from(of, i => this.counts[i]), 1, true);
    attribute(gl, this.program, 'rest', Float32Array.from({length: 3 * of.length}, (_, k) => rest[3 * of[Math.floor(k / 3)] + k % 3]), 3);
    gl.bindVertexArray(null);
    this.outputs = [0, 1].map(() => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, 16 * of.length, gl.DYNAMIC_COPY);
      return buffer;
    });
    gl.bindBuffer(gl.ARRAY_BUFFER, null);
    this.spansTexture = texture(gl, spans.row, spans.list.length);
    this.feedback = gl.createTransformFeedback();
  }

  // Records from places: the coordinates are those that give the rest position, to double precision.
  readShares(film) {
    const {near_pair, near_t, other_count, other_place, other_weight, place_pair, place_t} = film.arrays;
    const spans = this.spans;
    spans.pose(film.restControl);
    const at = (pair, t) => {
      const [from, to] = film.pairs[film.bound[pair]].domain;
      return spans.find(film.bound[pair], from + (to - from) * t / film.parts);
    };
    const places = Array.from(place_pair, (pair, k) => at(pair, place_t[k]));
    const still = new Set(film.still);
    const frames = new Map();
    const frame = (where, known) => {
      if (!known) return spans.frame(where.span, where.s);
      if (!frames.has(where)) frames.set(where, spans.frame(where.span, where.s));
      return frames.get(where);
    };
    this.first = new Uint32Array(this.count);
    this.counts = new Uint32Array(this.count);
    let total = 0, other = 0;
    for (let i = 0; i < this.count; ++i) {
      this.first[i] = total;
      this.counts[i] = still.has(i) ? 0 : 1 + other_count[i];
      total += this.counts[i];
    }
    this.sharesWidth = 3 * 512;
    const values = new Float32Array(4 * this.sharesWidth * Math.ceil(3 * total / this.sharesWidth));
    let to = 0;
    const add = (i, where, weight, known) => {
      const f = frame(where, known), p = this.rest.subarray(3 * i, 3 * i + 3);
      const d = [p[0] - f.origin[0], p[1] - f.origin[1], p[2] - f.origin[2]];
      const q = f.q ??= quaternion(f.lx, f.ly, f.lz);
      values.set([where.s, dot(d, f.lx), dot(d, f.ly), dot(d, f.lz), weight, where.span, 0, 0, -q[0], -q[1], -q[2], q[3]], to);
      to += 12;
    };
    for (let i = 0; i < this.count; ++i) {
      const others = other_count[i];
      if (this.counts[i] > 0) {
        let weight = 1;
        for (let k = 0; k < others; ++k) weight -= other_weight[other + k] / film.parts;
        add(i, at(near_pair[i], near_t[i]), weight, false);
        for (let k = 0; k < others; ++k) add(i, places[other_place[other + k]], other_weight[other + k] / film.parts, true);
      }
      other += others;
    }
    this.sharesTexture = texture(this.gl, this.sharesWidth, values.length / (4 * this.sharesWidth), values);
  }

  // To the curve-pairs as they are posed.
  update() {
    const gl = this.gl;
    upload(gl, this.spansTexture, this.spans.row, this.spans.list.length, Float32Array.from(this.spans.values));
    gl.useProgram(this.program);
    bind(gl, this.program, {spans: this.spansTexture, shares: this.sharesTexture});
    gl.uniform1i(gl.getUniformLocation(this.program, 'sharesWidth'), this.sharesWidth);
    gl.bindVertexArray(this.vao);
    gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, this.feedback);
    this.outputs.forEach((buffer, k) => gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, k, buffer));
    gl.enable(gl.RASTERIZER_DISCARD);
    gl.beginTransformFeedback(gl.POINTS);
    gl.drawArrays(gl.POINTS, 0, this.vertices);
    gl.endTransformFeedback();
    gl.disable(gl.RASTERIZER_DISCARD);
    gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, null);
    [0, 1].forEach(k => gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, k, null));
    gl.bindVertexArray(null);
  }

  // What the vertex shader made of every point: x, y, z and the number of shares.
  read() {
    const gl = this.gl, out = new Float32Array(4 * this.count);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.outputs[0]);
    gl.getBufferSubData(gl.ARRAY_BUFFER, 0, out);
    gl.bindBuffer(gl.ARRAY_BUFFER, null);
    return out;
  }
}
