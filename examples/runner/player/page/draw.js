// What is seen. Everything is lit by a soft sky and one lamp behind the eye's left shoulder.

const lightShader = `
vec3 lit(vec3 color, vec3 normal, vec3 toEye) {
  float sky = 0.5 + 0.5 * dot(normal, up);
  vec3 light = mix(vec3(0.30, 0.28, 0.27), vec3(0.62, 0.65, 0.70), sky) + 0.62 * vec3(1.0, 0.97, 0.92) * max(0.0, dot(normal, lamp));
  float shine = pow(max(0.0, dot(normal, normalize(lamp + toEye))), 40.0);
  return color * light + 0.06 * shine;
}
vec3 screen(vec3 c) {
  return mix(12.92 * c, 1.055 * pow(max(c, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055, step(vec3(0.0031308), c));
}`;

const surfaceFragment = `#version 300 es
precision highp float;
uniform vec3 up, lamp, eye;
uniform float solid;
in vec3 seen, normal, color;
out vec4 pixel;
${lightShader}
void main() {
  vec3 n = normalize(normal);
  vec3 toEye = normalize(eye - seen);
  if (dot(n, toEye) < 0.0 && !gl_FrontFacing) n = -n;
  pixel = vec4(screen(lit(color, n, toEye)), 1.0) * solid;
}`;

const meshVertex = `#version 300 es
precision highp float;
uniform mat4 camera, squash;
uniform vec3 mark;
uniform float marked;
in vec4 position, turned;
in vec3 facing;
in vec4 paint;
out vec3 seen, normal, color;
void main() {
  seen = position.xyz;
  normal = facing + 2.0 * cross(turned.xyz, cross(turned.xyz, facing) + turned.w * facing);
  color = pow(paint.rgb, vec3(2.2));
  if (position.w > 1.5) color = mix(color, mark, marked);
  gl_Position = camera * squash * vec4(seen, 1.0);
}`;

const plainVertex = `#version 300 es
precision highp float;
uniform mat4 camera, squash, model;
in vec3 place, facing;
in vec4 paint;
out vec3 seen, normal, color;
void main() {
  vec4 p = model * vec4(place, 1.0);
  seen = p.xyz;
  normal = mat3(model) * facing;
  color = pow(paint.rgb, vec3(2.2));
  gl_Position = camera * squash * p;
}`;

const shadowFragment = `#version 300 es
precision highp float;
uniform float dark;
out vec4 pixel;
void main() { pixel = vec4(0.0, 0.0, 0.0, dark); }`;

const lineVertex = `#version 300 es
precision highp float;
uniform mat4 camera;
uniform vec2 size;
in vec3 from, to;
in vec4 paint;
in float width;
out vec4 color;
out vec2 along;
void main() {
  vec4 a = camera * vec4(from, 1.0), b = camera * vec4(to, 1.0);
  vec2 pa = a.xy / a.w * size, pb = b.xy / b.w * size;
  vec2 way = pb - pa;
  way = length(way) > 1e-4 ? normalize(way) : vec2(1.0, 0.0);
  float end = gl_VertexID < 2 ? -1.0 : 1.0, side = gl_VertexID % 2 == 0 ? -1.0 : 1.0;
  vec2 p = (end < 0.0 ? pa : pb) + width * (end * way + side * vec2(-way.y, way.x));
  vec4 base = end < 0.0 ? a : b;
  gl_Position = vec4(p / size * base.w, base.zw);
  color = paint;
  float total = length(pb - pa) / width;
  along = vec2(end < 0.0 ? -1.0 : total + 1.0, side);
  along.x = end < 0.0 ? -1.0 : 1.0;
  if (total > 1.0) along.x = 0.0;
}`;
const lineFragment = `#version 300 es
precision highp float;
in vec4 color;
in vec2 along;
out vec4 pixel;
void main() {
  float far = length(along), soft = fwidth(far);
  float alpha = color.a * (1.0 - smoothstep(1.0 - soft, 1.0, far));
  pixel = vec4(color.rgb * alpha, alpha);
}`;

// Lines of a width in pixels, and dots, which are lines without a length.
class Lines {
  constructor(gl) {
    this.gl = gl;
    this.program = program(gl, lineVertex, lineFragment);
    this.vao = gl.createVertexArray();
    gl.bindVertexArray(this.vao);
    this.buffers = [['from', 3], ['to', 3], ['paint', 4], ['width', 1]].map(
      ([name, size]) => attribute(gl, this.program, name, new Float32Array(0), size, false, 1));
    gl.bindVertexArray(null);
    this.clear();
  }
  clear() { this.values = [[], [], [], []]; }
  add(from, to, color, width = 1.5) {
    this.values[0].push(...from);
    this.values[1].push(...to);
    this.values[2].push(...color);
    this.values[3].push(width);
  }
  draw(camera, width, height) {
    const gl = this.gl, count = this.values[3].length;
    if (count === 0) return;
    this.buffers.forEach((buffer, k) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, Float32Array.from(this.values[k]), gl.DYNAMIC_DRAW);
    });
    gl.useProgram(this.program);
    gl.uniformMatrix4fv(gl.getUniformLocation(this.program, 'camera'), false, camera);
    gl.uniform2f(gl.getUniformLocation(this.program, 'size'), width / 2, height / 2);
    gl.bindVertexArray(this.vao);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    gl.bindVertexArray(null);
  }
}

// Corner normals as the pictures have them: the mean of the faces beside that turn by less than 40 degrees.
function smooth(points, triangles) {
  const faces = triangles.length / 3, area = new Float64Array(3 * faces), begin = new Uint32Array(points.length / 3 + 1);
  for (let f = 0; f < faces; ++f) {
    const [a, b, c] = [0, 1, 2].map(k => points.subarray(3 * triangles[3 * f + k], 3 * triangles[3 * f + k] + 3));
    area.set(cross([b[0] - a[0], b[1] - a[1], b[2] - a[2]], [c[0] - a[0], c[1] - a[1], c[2] - a[2]]), 3 * f);
  }
  for (const i of triangles) ++begin[i + 1];
  for (let i = 1; i < begin.length; ++i) begin[i] += begin[i - 1];
  const next = begin.slice(), list = new Uint32Array(triangles.length);
  triangles.forEach((i, k) => { list[next[i]++] = k / 3; });
  const lengths = Float64Array.from({length: faces}, (_, f) => Math.hypot(area[3 * f], area[3 * f + 1], area[3 * f + 2]));
  const out = new Float32Array(3 * triangles.length);
  for (let k = 0; k < triangles.length; ++k) {
    const f = Math.floor(k / 3), own = area.subarray(3 * f, 3 * f + 3), sum = [0, 0, 0];
    for (let at = begin[triangles[k]]; at < begin[triangles[k] + 1]; ++at) {
      const g = list[at], other = area.subarray(3 * g, 3 * g + 3);
      if (dot(own, other) >= 0.766 * lengths[f] * lengths[g]) for (let x = 0; x < 3; ++x) sum[x] += other[x];
    }
    out.set(unit(sum), 3 * k);
  }
  return out;
}

// A vertex for each different normal and color of a point; the first ones are the points in turn.
function vertices(points, triangles, normals, colorOf) {
  const most = points + triangles.length, index = new Uint32Array(triangles.length), next = new Int32Array(most).fill(-1);
  const used = new Uint8Array(points), point = new Uint32Array(most), colors = new Int32Array(most), facing = new Float32Array(3 * most);
  for (let i = 0; i < points; ++i) point[i] = i;
  let count = points;
  for (let k = 0; k < triangles.length; ++k) {
    const i = triangles[k], color = colorOf(k), [x, y, z] = normals.subarray(3 * k, 3 * k + 3);
    const alike = v => colors[v] === color && Math.abs(facing[3 * v] - x) + Math.abs(facing[3 * v + 1] - y) + Math.abs(facing[3 * v + 2] - z) < 1e-3;
    let v = used[i] ? i : -1, last = -1;
    while (v >= 0 && !alike(v)) [last, v] = [v, next[v]];
    if (v < 0) {
      v = last < 0 ? i : count++;
      if (last < 0) used[i] = 1; else next[last] = v;
      point[v] = i;
      colors[v] = color;
      facing.set([x, y, z], 3 * v);
    }
    index[k] = v;
  }
  const paint = Uint8Array.from({length: 4 * count}, (_, k) => k % 4 < 3 ? colors[k >> 2] >> 8 * (k % 4) & 255 : 255);
  return {point: point.slice(0, count), index, attributes: [['facing', facing.slice(0, 3 * count), 3], ['paint', paint, 4]]};
}

// Triangles that are drawn, and their shadow.
class Shape {
  constructor(gl, vertexShader, attributes, index) {
    this.gl = gl;
    this.lit = shared(gl, vertexShader, surfaceFragment);
    this.dark = shared(gl, vertexShader, shadowFragment);
    this.count = index.length;
    this.buffers = [];
    this.vaos = [this.lit, this.dark].map(made => {
      const vao = gl.createVertexArray();
      gl.bindVertexArray(vao);
      for (const [name, values, size] of attributes) this.buffers.push(attribute(gl, made, name, values, size));
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, index, gl.STATIC_DRAW);
      this.buffers.push(buffer);
      gl.bindVertexArray(null);
      return vao;
    });
  }
  free() {
    this.buffers.forEach(buffer => this.gl.deleteBuffer(buffer));
    this.vaos.forEach(vao => this.gl.deleteVertexArray(vao));
  }
  draw(scene, shadow, numbers = {}) {
    const gl = this.gl, made = shadow ? this.dark : this.lit;
    gl.useProgram(made);
    const at = name => gl.getUniformLocation(made, name);
    gl.uniformMatrix4fv(at('camera'), false, scene.camera);
    gl.uniformMatrix4fv(at('squash'), false, shadow ? scene.squash : kIdentity);
    gl.uniformMatrix4fv(at('model'), false, numbers.model || kIdentity);
    for (const name of ['up', 'lamp', 'eye']) gl.uniform3fv(at(name), scene[name]);
    gl.uniform1f(at('solid'), numbers.solid || 1);
    gl.uniform1f(at('dark'), scene.dark);
    gl.uniform3fv(at('mark'), [0.75, 0.12, 0.05]);
    gl.uniform1f(at('marked'), numbers.marked || 0);
    gl.bindVertexArray(this.vaos[shadow ? 1 : 0]);
    gl.drawElements(gl.TRIANGLES, this.count, gl.UNSIGNED_INT, 0);
    gl.bindVertexArray(null);
  }
}

const kIdentity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
