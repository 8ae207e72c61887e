// The run at a moment: mesh, curve-pairs, frames, rods, solids, contacts.

const kPalette = [[0.10, 0.45, 0.82], [0.85, 0.37, 0.05], [0.20, 0.60, 0.25], [0.62, 0.25, 0.68], [0.75, 0.15, 0.20],
                  [0.05, 0.58, 0.58], [0.55, 0.45, 0.05], [0.35, 0.35, 0.75]];

class Scene {
  constructor(gl, film) {
    this.gl = gl;
    this.film = film;
    this.spans = new Spans(film.pairs);
    this.control = new Float64Array(7 * this.spans.controls);
    this.controls = this.readControls();
    film.restControl = this.controls[0];
    this.controls = this.controls.slice(1);
    if (film.arrays.points.length > 0) this.addMesh();
    if (film.arrays.solid_points.length > 0) this.addSolids();
    this.lines = new Lines(gl);
    this.tubes = new Map();
    this.lamp = unit(film.view.lamp);
  }

  // Control points at rest and at each moment.
  readControls() {
    const {control} = this.film.arrays, n = 7 * this.spans.controls;
    const units = this.film.controlUnits, out = [];
    for (let from = 0; from < control.length; from += n)
      out.push(Float64Array.from({length: n}, (_, k) => control[from + k] * units[k % 7 < 3 ? 0 : k % 7 < 6 ? 1 : 2]));
    return out;
  }

  addMesh() {
    const {gl, film} = this, {triangles, colors, points} = film.arrays;
    const rest = Float64Array.from(points, x => x * film.pointUnit);
    const {point, index, attributes} = vertices(rest.length / 3, triangles, smooth(rest, triangles),
      k => colors.length === 0 ? 0x92a1b0 : film.colorsOfFaces ? colors[Math.floor(k / 3)] : colors[triangles[k]]);
    this.mesh = new BoundMesh(gl, film, this.spans, rest, point);
    const [position, turned] = this.mesh.outputs;
    this.skin = new Shape(gl, meshVertex, [['position', position, 4], ['turned', turned, 4], ...attributes], index);
  }

  addSolids() {
    const {gl, film} = this, {solid_points, solid_triangles} = film.arrays;
    const places = Float64Array.from(solid_points, x => x * film.solidUnit);
    this.solids = film.solids.map(({from, to, color}) => {
      const triangles = solid_triangles.subarray(from, to);
      const {point, index, attributes} = vertices(places.length / 3, triangles, smooth(places, triangles), () => color);
      const place = Float32Array.from({length: 3 * point.length}, (_, k) => places[3 * point[Math.floor(k / 3)] + k % 3]);
      return new Shape(gl, plainVertex, [['place', place, 3], ...attributes], index);
    });
  }

  // Between two outputs control points go straight; `moment` is a whole number at an output.
  pose(moment) {
    const k = Math.min(this.controls.length - 1, Math.floor(moment)), part = moment - k;
    this.moment = moment;
    const a = this.controls[k], b = this.controls[Math.min(k + 1, this.controls.length - 1)];
    if (part > 0) for (let i = 0; i < a.length; ++i) this.control[i] = (1 - part) * a[i] + part * b[i];
    else this.control.set(a);
    this.spans.pose(this.control);
    if (this.mesh) this.mesh.update();
    this.tubes.forEach(tube => tube.free());
    this.tubes.clear();
  }

  model(solid) {
    const poses = this.film.poses, k = Math.min(poses.length - 1, Math.floor(this.moment)), part = this.moment - k;
    const a = poses[k][solid], b = poses[Math.min(k + 1, poses.length - 1)][solid];
    const sign = a.q.reduce((sum, x, c) => sum + x * b.q[c], 0) < 0 ? -1 : 1;
    let q = a.q.map((x, c) => (1 - part) * x + part * sign * b.q[c]);
    const length = Math.hypot(...q), p = a.p.map((x, c) => (1 - part) * x + part * b.p[c]);
    q = q.map(x => x / length);
    const [x, y, z, w] = q;
    return [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0, 2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0,
            2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0, ...p, 1];
  }

  along(pair, visit) {
    const {first, count} = this.spans.of[pair];
    for (let k = first; k < first + count; ++k) for (let j = k > first ? 1 : 0; j <= 12; ++j) visit(k, j / 12);
  }

  // Rods as tubes of their sections' width.
  tube(pair) {
    const kSides = 14, {nodes, width} = this.film.pairs[pair], points = [], facing = [], index = [];
    const radius = t => {
      let k = 1;
      while (k + 1 < nodes.length && t > nodes[k]) ++k;
      const part = (t - nodes[k - 1]) / (nodes[k] - nodes[k - 1]);
      return 0.5 * ((1 - part) * width[k - 1] + part * width[k]);
    };
    let rings = 0;
    const ring = (f, r, end) => {
      for (let k = 0; k < kSides; ++k) {
        const a = 2 * Math.PI * k / kSides, n = f.lx.map((x, c) => Math.cos(a) * x + Math.sin(a) * f.ly[c]);
        points.push(...f.origin.map((x, c) => x + r * n[c]));
        facing.push(...(end ? f.lz.map(x => end * x) : n));
        const next = (k + 1) % kSides, at = kSides * (rings - 1);
        if (rings > 0) index.push(at + k, at + next, at + kSides + k, at + next, at + kSides + next, at + kSides + k);
      }
      ++rings;
    };
    const {first, count} = this.spans.of[pair], start = this.spans.frame(first, 0), stop = this.spans.frame(first + count - 1, 1);
    ring(start, 0, -1);
    ring(start, radius(nodes[0]), -1);
    this.along(pair, (span, s) => {
      const {from, to} = this.spans.list[span];
      ring(this.spans.frame(span, s), radius(from + (to - from) * s), 0);
    });
    ring(stop, radius(nodes[nodes.length - 1]), 1);
    ring(stop, 0, 1);
    const paint = kPalette[pair % kPalette.length].map(x => Math.round(255 * (0.35 * x + 0.55)));
    return new Shape(this.gl, plainVertex, [['place', Float32Array.from(points), 3], ['facing', Float32Array.from(facing), 3],
      ['paint', Uint8Array.from({length: points.length / 3 * 4}, (_, k) => k % 4 < 3 ? paint[k % 4] : 255), 4]], Uint32Array.from(index));
  }

  drawLines(shown, scene, width, height, ratio) {
    const lines = this.lines, film = this.film;
    lines.clear();
    film.pairs.forEach((pair, p) => {
      const color = kPalette[p % kPalette.length];
      if (shown.pairs) {
        let last = null;
        this.along(p, (span, s) => {
          // Of the orientation curve only the direction matters: it is drawn no farther off than frames are long.
          const f = this.spans.frame(span, s), reach = Math.min(1, 0.03 / Math.hypot(...f.offset));
          const side = f.origin.map((x, k) => x + reach * f.offset[k]);
          if (last) {
            lines.add(last[0], f.origin, [...color, 1], 1.6 * ratio);
            lines.add(last[1], side, [...color.map(x => 0.5 * x + 0.3), 1], 0.8 * ratio);
          }
          last = [f.origin, side];
        });
      }
      for (const t of pair.nodes) {
        const {span, s} = this.spans.find(p, t), f = this.spans.frame(span, s);
        if (shown.pairs) lines.add(f.origin, f.origin, [...color, 1], 3.2 * ratio);
        if (shown.frames)
          [[f.lx, [0.85, 0.2, 0.2]], [f.ly, [0.2, 0.65, 0.25]], [f.lz, [0.2, 0.4, 0.9]]].forEach(
            ([axis, paint]) => lines.add(f.origin, f.origin.map((x, k) => x + 0.03 * axis[k]), [...paint, 1], 1.4 * ratio));
      }
    });
    if (shown.contacts) {
      const {contact_count, contact_ends} = film.arrays, moment = Math.round(this.moment);
      const first = contact_count.subarray(0, moment).reduce((sum, n) => sum + n, 0);
      for (let k = first; k < first + contact_count[moment]; ++k) {
        const [from, to] = [0, 3].map(x => Array.from(contact_ends.subarray(6 * k + x, 6 * k + x + 3), c => c * film.arrowUnit));
        lines.add(from, from, [0.95, 0.55, 0.05, 1], 3.5 * ratio);
        lines.add(from, to, [0.95, 0.55, 0.05, 1], 1.5 * ratio);
      }
    }
    const gl = this.gl;
    gl.disable(gl.DEPTH_TEST);
    lines.draw(scene.camera, width, height);
    gl.enable(gl.DEPTH_TEST);
  }

  draw(shown, orbit, lift, dark) {
    const gl = this.gl, {width, height} = gl.canvas, {view} = this.film;
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    const {eye, camera} = orbit.camera(width, height, lift);
    const scene = {eye, camera, up: view.up, lamp: this.lamp, squash: this.squash(), dark};
    const things = [], floors = [];
    if (this.skin && shown.mesh) things.push(shadow => this.skin.draw(scene, shadow, {marked: shown.ambiguous ? 0.85 : 0}));
    (this.solids || []).forEach((solid, k) => {
      const {flat} = this.film.solids[k];
      (flat ? floors : things).push(shadow => solid.draw(scene, shadow, {model: this.model(k), solid: flat ? 0.25 : 1}));
    });
    if (shown.tubes) this.film.pairs.forEach((_, p) => {
      if (!this.tubes.has(p)) this.tubes.set(p, this.tube(p));
      things.push(shadow => this.tubes.get(p).draw(scene, shadow));
    });
    gl.depthMask(false);
    floors.forEach(draw => draw(false));
    gl.depthMask(true);
    if (dot(eye, view.up) > view.ground) {
      // Each pixel of the ground is darkened once.
      gl.enable(gl.STENCIL_TEST);
      gl.stencilFunc(gl.EQUAL, 0, 255);
      gl.stencilOp(gl.KEEP, gl.KEEP, gl.INCR);
      gl.depthMask(false);
      things.forEach(draw => draw(true));
      gl.depthMask(true);
      gl.disable(gl.STENCIL_TEST);
    }
    things.forEach(draw => draw(false));
    this.drawLines(shown, scene, width, height, window.devicePixelRatio || 1);
  }

  // Onto the ground, along the lamp's light; a little above it, not to lie in a floor that is drawn.
  squash() {
    const {up} = this.film.view, l = this.lamp, slope = dot(l, up), ground = this.film.view.ground + 0.001;
    const out = [...kIdentity];
    for (let r = 0; r < 3; ++r) {
      for (let c = 0; c < 3; ++c) out[4 * c + r] = (r === c ? 1 : 0) - l[r] * up[c] / slope;
      out[12 + r] = l[r] * ground / slope;
    }
    return out;
  }
}
