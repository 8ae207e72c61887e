// B-spline curve-pairs in double precision, as pieces in Bernstein form on [0, 1], all of one degree.

import {Vector3, Vector4} from 'three';

// Bezier points of the span [knots[i], knots[i + 1]] as combinations of the control points i - degree .. i.
function bezierOf(knots, degree, i) {
  const blossom = arguments_ => {
    let rows = [];
    for (let j = 0; j <= degree; ++j) rows.push(Array.from({length: degree + 1}, (_, k) => k === j ? 1 : 0));
    for (let r = 1; r <= degree; ++r) {
      const next = [];
      for (let j = r; j <= degree; ++j) {
        const a = knots[i - degree + j], b = knots[i + 1 + j - r];
        const x = (arguments_[r - 1] - a) / (b - a);
        next.push(rows[j - r].map((value, k) => (1 - x) * value + x * rows[j - r + 1][k]));
      }
      rows = next;
    }
    return rows[0];
  };
  const out = [];
  for (let j = 0; j <= degree; ++j)
    out.push(blossom(Array.from({length: degree}, (_, k) => k < degree - j ? knots[i] : knots[i + 1])));
  return out;
}

function elevate(rows) {
  const n = rows.length;
  const out = [rows[0]];
  for (let j = 1; j < n; ++j) out.push(rows[j].map((value, k) => (j / n) * rows[j - 1][k] + (1 - j / n) * value));
  out.push(rows[n - 1]);
  return out;
}

// The spans of all curve-pairs: which control points they are combinations of, and how.
export class Spans {
  constructor(pairs) {
    this.degree = Math.max(...pairs.map(pair => pair.degree));
    this.list = [];
    this.of = [];
    let control = 0;
    for (const pair of pairs) {
      const {knots, degree} = pair, first = this.list.length;
      for (let i = degree; i < knots.length - degree - 1; ++i) {
        if (!(knots[i] < knots[i + 1])) continue;
        let rows = bezierOf(knots, degree, i);
        while (rows.length <= this.degree) rows = elevate(rows);
        this.list.push({from: knots[i], to: knots[i + 1], first: control + i - degree, rows});
      }
      this.of.push({first, count: this.list.length - first, control, controls: knots.length - degree - 1});
      control += knots.length - degree - 1;
    }
    this.controls = control;
    this.row = 3 * this.degree + 2;  // points of the curve, of its derivative by s, of the offset
    this.values = new Float64Array(4 * this.row * this.list.length);
  }

  find(pair, t) {
    const {first, count} = this.of[pair];
    let k = first;
    while (k + 1 < first + count && t >= this.list[k + 1].from) ++k;
    const span = this.list[k];
    return {span: k, s: Math.min(1, Math.max(0, (t - span.from) / (span.to - span.from)))};
  }

  // control: seven numbers a control point: the primary curve's, the offset of the orientation curve's, the turn.
  pose(control) {
    const P = this.degree, values = this.values;
    this.list.forEach(({first, rows}, index) => {
      const at = 4 * this.row * index;
      for (let j = 0; j <= P; ++j) {
        const c = at + 4 * j, n = at + 4 * (2 * P + 1 + j);
        for (let k = 0; k < 4; ++k) values[c + k] = values[n + k] = 0;
        rows[j].forEach((weight, k) => {
          const from = 7 * (first + k);
          for (let x = 0; x < 3; ++x) {
            values[c + x] += weight * control[from + x];
            values[n + x] += weight * control[from + 3 + x];
          }
          values[c + 3] += weight * control[from + 6];
        });
      }
      for (let j = 0; j < P; ++j)
        for (let x = 0; x < 3; ++x)
          values[at + 4 * (P + 1 + j) + x] = P * (values[at + 4 * (j + 1) + x] - values[at + 4 * j + x]);
    });
  }

  // at: of the first of the piece's points, among the values
  bernstein(at, degree, s) {
    const b = [];
    for (let j = 0; j <= degree; ++j) b.push(new Vector4().fromArray(this.values, at + 4 * j));
    for (let r = degree; r > 0; --r) for (let j = 0; j < r; ++j) b[j].lerp(b[j + 1], s);
    return b[0];
  }

  // Point and frame, as the library has them.
  frame(span, s) {
    const P = this.degree, at = 4 * this.row * span;
    const curve = this.bernstein(at, P, s), offset = new Vector3().copy(this.bernstein(at + 4 * (2 * P + 1), P, s));
    const lz = new Vector3().copy(this.bernstein(at + 4 * (P + 1), P - 1, s)).normalize();
    const x = offset.clone().cross(lz).normalize(), y = lz.clone().cross(x);
    const c = Math.cos(curve.w), d = Math.sin(curve.w);
    const lx = x.clone().multiplyScalar(c).addScaledVector(y, d), ly = y.multiplyScalar(c).addScaledVector(x, -d);
    const {from, to} = this.list[span];
    return {origin: new Vector3().copy(curve), lx, ly, lz, offset, t: from + (to - from) * s};
  }

  // Frames along a curve-pair, twelve to a span.
  along(pair) {
    const {first, count} = this.of[pair], out = [];
    for (let k = first; k < first + count; ++k)
      for (let j = k > first ? 1 : 0; j <= kParts; ++j) out.push(this.frame(k, j / kParts));
    return out;
  }
  samples(pair) { return kParts * this.of[pair].count + 1; }
}

const kParts = 12;
