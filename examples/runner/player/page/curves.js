// B-spline curve-pairs in double precision, as pieces in Bernstein form on [0, 1], all of one degree.

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
class Spans {
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

  bernstein(at, degree, s, components) {
    const out = [0, 0, 0, 0];
    for (let x = 0; x < components; ++x) {
      const b = [];
      for (let j = 0; j <= degree; ++j) b.push(this.values[at + 4 * j + x]);
      for (let r = degree; r > 0; --r) for (let j = 0; j < r; ++j) b[j] += s * (b[j + 1] - b[j]);
      out[x] = b[0];
    }
    return out;
  }

  // Point and frame, as the library has them.
  frame(span, s) {
    const P = this.degree, at = 4 * this.row * span;
    const [x, y, z, turn] = this.bernstein(at, P, s, 4);
    const n = this.bernstein(at + 4 * (2 * P + 1), P, s, 3);
    const lz = unit(this.bernstein(at + 4 * (P + 1), P - 1, s, 3));
    let lx = unit(cross(n, lz)), ly = cross(lz, lx);
    const c = Math.cos(turn), d = Math.sin(turn);
    [lx, ly] = [lx.map((value, k) => c * value + d * ly[k]), ly.map((value, k) => c * value - d * lx[k])];
    return {origin: [x, y, z], lx, ly, lz, offset: n};
  }
}

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
function unit(a) {
  const length = Math.hypot(a[0], a[1], a[2]) || 1;
  return [a[0] / length, a[1] / length, a[2] / length];
}

// Quaternion (x, y, z, w) of the rotation whose matrix has these columns.
function quaternion(x, y, z) {
  const m = [[x[0], y[0], z[0]], [x[1], y[1], z[1]], [x[2], y[2], z[2]]];
  const trace = m[0][0] + m[1][1] + m[2][2];
  if (trace > 0) {
    const s = 2 * Math.sqrt(1 + trace);
    return [(m[2][1] - m[1][2]) / s, (m[0][2] - m[2][0]) / s, (m[1][0] - m[0][1]) / s, s / 4];
  }
  const i = m[0][0] > m[1][1] && m[0][0] > m[2][2] ? 0 : m[1][1] > m[2][2] ? 1 : 2, j = (i + 1) % 3, k = (i + 2) % 3;
  const s = 2 * Math.sqrt(1 + m[i][i] - m[j][j] - m[k][k]), q = [0, 0, 0, (m[k][j] - m[j][k]) / s];
  q[i] = s / 4;
  q[j] = (m[j][i] + m[i][j]) / s;
  q[k] = (m[k][i] + m[i][k]) / s;
  return q;
}
