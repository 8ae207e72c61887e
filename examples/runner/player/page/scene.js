// The run at a moment: mesh, curve-pairs, frames, rods, solids, contacts. A soft sky and one lamp behind the eye's left
// shoulder light it.

import {Color, DirectionalLight, Group, HemisphereLight, Mesh, Plane, Quaternion, Scene, Vector2, Vector3, Vector4, WebGLRenderer} from 'three';
import {ShadowMesh} from 'three/addons/objects/ShadowMesh.js';
import {Spans} from './curves.js';
import {color, Dots, Strokes} from './lines.js';
import {BoundMesh} from './mesh.js';
import {creased, lit, Tube} from './shape.js';

const kPalette = [[0.10, 0.45, 0.82], [0.85, 0.37, 0.05], [0.20, 0.60, 0.25], [0.62, 0.25, 0.68], [0.75, 0.15, 0.20],
                  [0.05, 0.58, 0.58], [0.55, 0.45, 0.05], [0.35, 0.35, 0.75]];
const kAxes = [['lx', color(0.85, 0.2, 0.2)], ['ly', color(0.2, 0.65, 0.25)], ['lz', color(0.2, 0.4, 0.9)]];
const kContact = color(0.95, 0.55, 0.05);
const kLongest = 0.03;  // of what is drawn of a frame

function renderer(canvas) {
  try {
    const made = new WebGLRenderer({canvas, antialias: true, alpha: true, stencil: true});
    if (made.extensions.has('EXT_color_buffer_float')) return made;
  } catch {}  // three.js has said why
  throw new Error('This page needs WebGL 2 that draws numbers of 32 bits, which the browser does not offer.');
}

export class Stage {
  constructor(canvas, film) {
    this.film = film;
    this.renderer = renderer(canvas);
    this.scene = new Scene();
    this.spans = new Spans(film.pairs);
    this.control = new Float64Array(7 * this.spans.controls);
    this.controls = this.readControls();
    film.restControl = this.controls.shift();
    this.addLights();
    this.parts = {};
    this.shadows = [];
    if (film.arrays.points.length > 0) this.addMesh();
    this.addSolids();
    this.addTubes();
    this.addLines();
  }

  // Control points at rest and at each moment.
  readControls() {
    const {control} = this.film.arrays, n = 7 * this.spans.controls;
    const units = this.film.controlUnits, out = [];
    for (let from = 0; from < control.length; from += n)
      out.push(Float64Array.from({length: n}, (_, k) => control[from + k] * units[k % 7 < 3 ? 0 : k % 7 < 6 ? 1 : 2]));
    return out;
  }

  // What is diffuse divides by pi.
  addLights() {
    const {up, lamp, ground} = this.film.view;
    const sky = new HemisphereLight(new Color(0.62, 0.65, 0.70), new Color(0.30, 0.28, 0.27), Math.PI);
    sky.position.fromArray(up);
    const sun = new DirectionalLight(new Color(1.0, 0.97, 0.92), 0.62 * Math.PI);
    sun.position.fromArray(lamp).normalize();
    this.scene.add(sky, sun);
    // Shadows fall a little above the ground, not to lie in a floor that is drawn.
    this.ground = new Plane(new Vector3(...up), ground + 0.001);  // as ShadowMesh has it: its height, not less that
    this.lamp = new Vector4(...sun.position, 0);
  }

  part(name, ...things) {
    const group = this.parts[name] = new Group();
    things.forEach(thing => group.add(thing));
    this.scene.add(group);
  }

  addShadow(of, owner) {
    const shadow = new ShadowMesh(of);
    this.shadows.push({shadow, owner});
    this.scene.add(shadow);
    return shadow;
  }

  addMesh() {
    this.mesh = new BoundMesh(this.film, this.spans);
    this.part('mesh', this.mesh);
    this.mesh.bind(this.addShadow(this.mesh, 'mesh').material);
  }

  addSolids() {
    const {film} = this, {solid_points, solid_triangles} = film.arrays;
    this.solids = film.solids.map(({from, to, color: packed, flat}) => {
      const paint = color((packed & 255) / 255, (packed >> 8 & 255) / 255, (packed >> 16 & 255) / 255);
      const see = flat ? {transparent: true, opacity: 0.25, depthWrite: false} : {};
      return new Mesh(creased(solid_points, solid_triangles.subarray(from, to), film.solidUnit), lit({color: paint, ...see}));
    });
    this.part('solids', ...this.solids);
    this.solids.forEach((solid, k) => {
      if (film.solids[k].flat) solid.renderOrder = -1;
      else this.addShadow(solid, 'solids');
    });
  }

  addTubes() {
    this.tubes = this.film.pairs.map((pair, p) =>
      new Tube(pair, this.spans.samples(p), color(...kPalette[p % kPalette.length].map(x => 0.35 * x + 0.55))));
    this.part('tubes', ...this.tubes);
    this.tubes.forEach(tube => this.addShadow(tube, 'tubes'));
  }

  addLines() {
    const {pairs, arrays} = this.film, sum = numbers => numbers.reduce((a, b) => a + b, 0);
    const nodes = sum(pairs.map(pair => pair.nodes.length)), pieces = sum(pairs.map((_, p) => this.spans.samples(p) - 1));
    const contacts = Math.max(0, ...arrays.contact_count);
    this.lines = {
      pairs: [new Strokes(pieces, 1.3), new Strokes(pieces, 2.6), new Dots(nodes, 6)],
      frames: [new Strokes(3 * nodes, 1.8)],
      contacts: [new Strokes(contacts, 2.6), new Dots(contacts, 7)],
    };
    for (const [name, lines] of Object.entries(this.lines)) this.part(name, ...lines);
  }

  // Between two outputs control points go straight; `moment` is a whole number at an output.
  pose(moment) {
    const k = Math.min(this.controls.length - 1, Math.floor(moment)), part = moment - k;
    const a = this.controls[k], b = this.controls[Math.min(k + 1, this.controls.length - 1)];
    if (part > 0) for (let i = 0; i < a.length; ++i) this.control[i] = (1 - part) * a[i] + part * b[i];
    else this.control.set(a);
    this.spans.pose(this.control);
    if (this.mesh) this.mesh.binding.evaluate(this.renderer);
    this.moveSolids(k, part);
    this.moment = moment;
    this.stale = new Set(['tubes', 'pairs', 'frames', 'contacts']);
    this.along = null;
    this.shadows.forEach(({shadow}) => shadow.update(this.ground, this.lamp));
  }

  moveSolids(k, part) {
    const {poses} = this.film, next = poses[Math.min(k + 1, poses.length - 1)];
    this.solids.forEach((solid, i) => {
      const a = poses[k][i], b = next[i];
      solid.position.lerpVectors(new Vector3(...a.p), new Vector3(...b.p), part);
      solid.quaternion.slerpQuaternions(new Quaternion(...a.q), new Quaternion(...b.q), part);
      solid.updateMatrixWorld();
    });
  }

  // What is drawn of `name` follows the last pose.
  freshen(name) {
    if (!this.stale.delete(name)) return;
    const lines = this.lines[name] ?? [], {pairs} = this.film;
    lines.forEach(line => line.begin());
    if (name === 'contacts') this.drawContacts(...lines);
    if (name === 'frames') pairs.forEach((_, p) => this.drawFrames(p, ...lines));
    if (name === 'pairs' || name === 'tubes') this.along ??= pairs.map((_, p) => this.spans.along(p));
    if (name === 'pairs') this.along.forEach((frames, p) => this.drawPair(frames, p, ...lines));
    if (name === 'tubes') this.tubes.forEach((tube, p) => tube.update(this.along[p]));
    lines.forEach(line => line.end());
  }

  nodes(p) {
    return this.film.pairs[p].nodes.map(t => {
      const {span, s} = this.spans.find(p, t);
      return this.spans.frame(span, s);
    });
  }

  drawPair(frames, p, sides, axes, nodes) {
    const paint = color(...kPalette[p % kPalette.length]), pale = color(...kPalette[p % kPalette.length].map(x => 0.5 * x + 0.3));
    // Of the orientation curve only the direction matters: it is drawn no farther off than frames are long.
    const beside = f => f.origin.clone().addScaledVector(f.offset, Math.min(1, kLongest / f.offset.length()));
    for (let i = 1; i < frames.length; ++i) {
      axes.add(frames[i - 1].origin, frames[i].origin, paint);
      sides.add(beside(frames[i - 1]), beside(frames[i]), pale);
    }
    for (const f of this.nodes(p)) nodes.add(f.origin, paint);
  }

  drawFrames(p, strokes) {
    for (const f of this.nodes(p))
      for (const [axis, paint] of kAxes) strokes.add(f.origin, f.origin.clone().addScaledVector(f[axis], kLongest), paint);
  }

  drawContacts(forces, dots) {
    const {arrays, arrowUnit} = this.film, {contact_count, contact_ends} = arrays, moment = Math.round(this.moment);
    const first = contact_count.subarray(0, moment).reduce((sum, n) => sum + n, 0);
    for (let k = first; k < first + contact_count[moment]; ++k) {
      const [from, to] = [0, 3].map(x => new Vector3().fromArray(contact_ends, 6 * k + x).multiplyScalar(arrowUnit));
      dots.add(from, kContact);
      forces.add(from, to, kContact);
    }
  }

  fit() {
    const {clientWidth: width, clientHeight: height} = this.renderer.domElement, ratio = Math.min(2, window.devicePixelRatio || 1);
    const last = this.renderer.getSize(new Vector2());
    if (ratio !== this.renderer.getPixelRatio()) this.renderer.setPixelRatio(ratio);
    if (width !== last.x || height !== last.y) this.renderer.setSize(width, height, false);
    return [width, height];
  }

  // room: the parts of the picture's height that other things cover, above and below; dark: how dark shadows are
  draw(shown, view, room, dark) {
    view.fit(...this.fit(), room);
    const seen = name => shown[name] ?? name === 'solids';
    for (const [name, part] of Object.entries(this.parts)) if ((part.visible = seen(name))) this.freshen(name);
    const above = this.ground.normal.dot(view.camera.position) > this.ground.constant;
    for (const {shadow, owner} of this.shadows) {
      shadow.visible = above && seen(owner);
      shadow.material.opacity = dark;
    }
    if (this.mesh) this.mesh.marked.value = shown.ambiguous ? 0.85 : 0;
    this.renderer.render(this.scene, view.camera);
  }
}
