import {MathUtils, MOUSE, PerspectiveCamera} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

const kAngle = 0.43;  // of view [rad]

// The eye goes round a point, by mouse, fingers, wheel or keys.
export class View {
  constructor(canvas, {eye, target, up}, changed) {
    this.camera = new PerspectiveCamera();
    this.camera.up.fromArray(up);
    this.camera.position.fromArray(eye);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.minDistance = 0.05;
    this.controls.maxDistance = 20;
    this.controls.mouseButtons = {LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.PAN, RIGHT: MOUSE.PAN};
    this.controls.target.fromArray(target);
    this.controls.update();
    this.controls.saveState();
    this.controls.addEventListener('change', changed);
    canvas.addEventListener('dblclick', () => this.reset());
  }

  reset() { this.controls.reset(); }
  turn(left, up) {
    this.controls.rotateLeft(left);
    this.controls.rotateUp(up);
  }
  nearer(factor) { this.controls.dollyIn(1 / factor); }

  get yaw() { return this.controls.getAzimuthalAngle(); }
  get pitch() { return Math.PI / 2 - this.controls.getPolarAngle(); }
  get distance() { return this.controls.getDistance(); }

  // To a picture of which parts of the height, above and below, are covered.
  fit(width, height, {above, below}) {
    const narrow = Math.min(1 - above - below, 0.9 * width / height);
    this.camera.fov = MathUtils.radToDeg(2 * Math.atan(Math.tan(kAngle / 2) / narrow));
    this.camera.near = 0.02 * this.distance;
    this.camera.far = this.distance + 20;
    this.camera.aspect = width / height;
    this.camera.setViewOffset(width, height, 0, 0.5 * (below - above) * height, width, height);
  }
}
