// The eye goes round a point, by mouse, touch or wheel.

class Orbit {
  constructor(canvas, view, changed) {
    this.up = view.up;
    const least = [0, 1, 2].reduce((a, b) => Math.abs(view.up[b]) < Math.abs(view.up[a]) ? b : a);
    const axis = [0, 0, 0];
    axis[least] = 1;
    this.side = unit(cross(axis, view.up));
    this.front = cross(view.up, this.side);
    this.home = view;
    this.changed = changed;
    this.reset();
    this.listen(canvas);
  }

  reset() {
    const {eye, target} = this.home, d = eye.map((x, k) => x - target[k]);
    this.target = [...target];
    this.distance = Math.hypot(...d);
    this.pitch = Math.asin(dot(d, this.up) / this.distance);
    this.yaw = Math.atan2(dot(d, this.side), dot(d, this.front));
    this.changed();
  }

  listen(canvas) {
    const fingers = new Map();
    const spread = () => {
      const [a, b] = [...fingers.values()];
      return {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.hypot(a.x - b.x, a.y - b.y)};
    };
    canvas.addEventListener('pointerdown', event => {
      canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    });
    canvas.addEventListener('pointermove', event => {
      const last = fingers.get(event.pointerId);
      if (!last) return;
      const now = {x: event.clientX, y: event.clientY};
      if (fingers.size === 1) {
        if (event.shiftKey || event.buttons & 6) this.pan(now.x - last.x, now.y - last.y, canvas.clientHeight);
        else this.turn(now.x - last.x, now.y - last.y);
        fingers.set(event.pointerId, now);
      } else {
        const before = spread();
        fingers.set(event.pointerId, now);
        const after = spread();
        this.zoom(before.apart / Math.max(after.apart, 1));
        this.pan(after.x - before.x, after.y - before.y, canvas.clientHeight);
      }
    });
    for (const name of ['pointerup', 'pointercancel']) canvas.addEventListener(name, event => fingers.delete(event.pointerId));
    canvas.addEventListener('wheel', event => {
      event.preventDefault();
      this.zoom(Math.exp(0.001 * event.deltaY));
    }, {passive: false});
    canvas.addEventListener('dblclick', () => this.reset());
    canvas.addEventListener('contextmenu', event => event.preventDefault());
  }

  turn(x, y) {
    this.yaw -= 0.006 * x;
    this.pitch = Math.min(1.5, Math.max(-1.5, this.pitch + 0.006 * y));
    this.changed();
  }
  zoom(factor) {
    this.distance = Math.min(20, Math.max(0.05, this.distance * factor));
    this.changed();
  }
  pan(x, y, height) {
    const {right, up} = this.axes(), step = 2 * this.distance * Math.tan(kAngle / 2) / height;
    this.target = this.target.map((t, k) => t - step * x * right[k] + step * y * up[k]);
    this.changed();
  }

  axes() {
    const c = Math.cos(this.pitch);
    const back = [0, 1, 2].map(k => c * Math.sin(this.yaw) * this.side[k] + c * Math.cos(this.yaw) * this.front[k] + Math.sin(this.pitch) * this.up[k]);
    const right = unit(cross(this.up, back));
    return {back, right, up: cross(back, right)};
  }

  // lift: the part of the picture's height that lies under the time line
  camera(width, height, lift) {
    const {back, right, up} = this.axes();
    const eye = this.target.map((t, k) => t + this.distance * back[k]);
    const look = [0, 1, 2].flatMap(k => [right[k], up[k], back[k], 0]).concat([-dot(right, eye), -dot(up, eye), -dot(back, eye), 1]);
    const near = 0.02 * this.distance, far = this.distance + 20, f = 1 / Math.tan(kAngle / 2);
    const narrow = Math.min(1 - lift, width / height);
    const project = [f * narrow * height / width, 0, 0, 0, 0, f * narrow, 0, 0, 0, -lift, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0];
    return {eye, camera: multiply(project, look)};
  }
}

const kAngle = 0.43;  // of view [rad]
