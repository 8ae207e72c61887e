import {Color, DataTexture, LinearFilter, Points, BufferAttribute, BufferGeometry, PointsMaterial, SRGBColorSpace} from 'three';
import {LineMaterial} from 'three/addons/lines/LineMaterial.js';
import {LineSegments2} from 'three/addons/lines/LineSegments2.js';
import {LineSegmentsGeometry} from 'three/addons/lines/LineSegmentsGeometry.js';

// Lines and dots lie over everything else; sizes are in pixels.
const kOnTop = {vertexColors: true, transparent: true, depthTest: false, depthWrite: false};

// As it is seen on the screen.
export function color(red, green, blue) {
  return new Color().setRGB(red, green, blue, SRGBColorSpace);
}

// At most `room` segments.
export class Strokes extends LineSegments2 {
  constructor(room, width) {
    const geometry = new LineSegmentsGeometry();
    geometry.setPositions(new Float32Array(6 * room));
    geometry.setColors(new Float32Array(6 * room));
    super(geometry, new LineMaterial({...kOnTop, linewidth: width}));
    this.begin();
    this.frustumCulled = false;
    this.renderOrder = 1;
  }
  begin() { this.geometry.instanceCount = 0; }
  add(from, to, paint) {
    const {instanceStart, instanceEnd, instanceColorStart, instanceColorEnd} = this.geometry.attributes;
    const k = this.geometry.instanceCount++;
    instanceStart.setXYZ(k, from.x, from.y, from.z);
    instanceEnd.setXYZ(k, to.x, to.y, to.z);
    for (const end of [instanceColorStart, instanceColorEnd]) end.setXYZ(k, paint.r, paint.g, paint.b);
  }
  end() { for (const name of ['instanceStart', 'instanceColorStart']) this.geometry.attributes[name].data.needsUpdate = true; }
}

// White, and round to within a pixel of its own.
function disc() {
  const n = 32, texels = new Uint8Array(4 * n * n).fill(255);
  for (let y = 0; y < n; ++y)
    for (let x = 0; x < n; ++x)
      texels[4 * (n * y + x) + 3] = 255 * Math.min(1, Math.max(0, n / 2 - Math.hypot(x + 0.5 - n / 2, y + 0.5 - n / 2)));
  const made = new DataTexture(texels, n, n);
  made.magFilter = made.minFilter = LinearFilter;
  made.needsUpdate = true;
  return made;
}

// At most `room` dots.
export class Dots extends Points {
  constructor(room, size) {
    const geometry = new BufferGeometry();
    for (const name of ['position', 'color']) geometry.setAttribute(name, new BufferAttribute(new Float32Array(3 * room), 3));
    super(geometry, new PointsMaterial({...kOnTop, size, sizeAttenuation: false, map: disc()}));
    this.begin();
    this.end();
    this.frustumCulled = false;
    this.renderOrder = 2;
  }
  begin() { this.count = 0; }
  add(at, paint) {
    this.geometry.attributes.position.setXYZ(this.count, at.x, at.y, at.z);
    this.geometry.attributes.color.setXYZ(this.count++, paint.r, paint.g, paint.b);
  }
  end() {
    this.geometry.setDrawRange(0, this.count);
    for (const name of ['position', 'color']) this.geometry.attributes[name].needsUpdate = true;
  }
}
