import {BufferAttribute, BufferGeometry, DoubleSide, Mesh, MeshPhongMaterial} from 'three';
import {toCreasedNormals} from 'three/addons/utils/BufferGeometryUtils.js';

const kCrease = 40 * Math.PI / 180;  // as the pictures have it

export function lit(parameters) {
  return new MeshPhongMaterial({side: DoubleSide, shininess: 40, ...parameters});
}

// Triangles with corners of their own, and normals that are smooth but for creases.
// points: whole numbers, of that unit; three.js takes for one what lies in one hundredth
// more: attributes besides, name and a value a point
export function creased(points, triangles, unit, more = []) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(Float32Array.from(points), 3));
  for (const [name, values] of more) geometry.setAttribute(name, new BufferAttribute(values, 1));
  geometry.setIndex(new BufferAttribute(Uint32Array.from(triangles), 1));
  return toCreasedNormals(geometry, kCrease).scale(unit, unit, unit);
}

const kSides = 14;

// A rod as a tube of its sections' width.
export class Tube extends Mesh {
  constructor({nodes, width}, samples, paint) {
    const rings = samples + 4, geometry = new BufferGeometry(), index = [];
    for (const name of ['position', 'normal']) geometry.setAttribute(name, new BufferAttribute(new Float32Array(3 * kSides * rings), 3));
    for (let at = kSides; at < kSides * rings; at += kSides)
      for (let k = 0; k < kSides; ++k) {
        const next = (k + 1) % kSides, before = at - kSides;
        index.push(before + k, before + next, at + k, before + next, at + next, at + k);
      }
    geometry.setIndex(index);
    super(geometry, lit({color: paint}));
    this.frustumCulled = false;
    this.nodes = nodes;
    this.widths = width;
  }

  radius(t) {
    const {nodes, widths} = this;
    let k = 1;
    while (k + 1 < nodes.length && t > nodes[k]) ++k;
    const part = (t - nodes[k - 1]) / (nodes[k] - nodes[k - 1]);
    return 0.5 * ((1 - part) * widths[k - 1] + part * widths[k]);
  }

  // frames: along the rod, each with its parameter t
  update(frames) {
    const {position, normal} = this.geometry.attributes;
    let at = 0;
    const ring = (f, radius, end) => {
      for (let k = 0; k < kSides; ++k, ++at) {
        const angle = 2 * Math.PI * k / kSides;
        const n = f.lx.clone().multiplyScalar(Math.cos(angle)).addScaledVector(f.ly, Math.sin(angle));
        position.setXYZ(at, ...f.origin.clone().addScaledVector(n, radius));
        if (end) n.copy(f.lz).multiplyScalar(end);
        normal.setXYZ(at, ...n);
      }
    };
    const first = frames[0], last = frames[frames.length - 1];
    ring(first, 0, -1);
    ring(first, this.radius(first.t), -1);
    for (const f of frames) ring(f, this.radius(f.t), 0);
    ring(last, this.radius(last.t), 1);
    ring(last, 0, 1);
    position.needsUpdate = normal.needsUpdate = true;
  }
}
