// Curves over the run's time, and the place in it.

export const kSeries = [
  {key: 'kinetic', name: 'kinetic', color: '--blue'},
  {key: 'elastic', name: 'elastic', color: '--red'},
  {key: 'potential', name: 'potential', color: '--green'},
  {key: 'total', name: 'total', color: '--ink'},
];

class Plot {
  constructor(canvas, film) {
    this.canvas = canvas;
    this.film = film;
    this.from = film.times[0];
    this.to = film.times[film.times.length - 1];
  }

  begin() {
    const ratio = window.devicePixelRatio || 1, {clientWidth: width, clientHeight: height} = this.canvas;
    if (this.canvas.width !== Math.round(width * ratio)) this.canvas.width = Math.round(width * ratio);
    if (this.canvas.height !== Math.round(height * ratio)) this.canvas.height = Math.round(height * ratio);
    const context = this.canvas.getContext('2d');
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    this.width = width;
    this.height = height;
    return context;
  }
  x(time) { return kMargin + (this.width - 2 * kMargin) * (this.to > this.from ? (time - this.from) / (this.to - this.from) : 0); }
  time(x) { return this.from + (this.to - this.from) * Math.min(1, Math.max(0, (x - kMargin) / (this.width - 2 * kMargin))); }

  line(context, points, color, width = 1.5) {
    context.strokeStyle = style(color);
    context.lineWidth = width;
    context.lineJoin = 'round';
    context.beginPath();
    points.forEach(([x, y], k) => k > 0 ? context.lineTo(x, y) : context.moveTo(x, y));
    context.stroke();
  }
  cursor(context, time) {
    this.line(context, [[this.x(time), 0], [this.x(time), this.height]], '--accent', 1.5);
  }
  label(context, text, y) {
    context.fillStyle = style('--soft');
    context.font = '11px system-ui, sans-serif';
    context.fillText(text, kMargin, y);
  }
}

export class EnergyPlot extends Plot {
  draw(time) {
    const context = this.begin(), {times, energies} = this.film;
    const change = kSeries.map(({key}) => energies[key].map(e => e - energies[key][0]));
    const [low, high] = range(change.flat()), room = high - low || 1;
    const y = e => this.height - 5 - (this.height - 22) * (e - low) / room;
    this.line(context, [[kMargin, y(0)], [this.width - kMargin, y(0)]], '--line', 1);
    change.forEach((values, k) => this.line(context, values.map((e, m) => [this.x(times[m]), y(e)]), kSeries[k].color));
    this.label(context, 'energy since the start', 11);
    this.cursor(context, time);
  }
}

export class StepPlot extends Plot {
  draw(time) {
    const context = this.begin(), {at, step} = this.film.steps;
    if (step.length > 0) {
      const [low, high] = range(step).map(Math.log);
      const room = Math.max(high - low, Math.log(4)), middle = 0.5 * (low + high);
      const y = h => this.height - 5 - (this.height - 22) * (0.5 + (Math.log(h) - middle) / room);
      this.line(context, step.flatMap((h, k) => [[this.x(k > 0 ? at[k - 1] : this.from), y(h)], [this.x(at[k]), y(h)]]), '--violet', 1.2);
      this.label(context, `step size, ${short(Math.exp(low))} to ${short(Math.exp(high))}, logarithmic`, 11);
    }
    this.cursor(context, time);
  }
}

const kMargin = 10;

function range(values) {
  return values.reduce(([low, high], x) => [Math.min(low, x), Math.max(high, x)], [Infinity, -Infinity]);
}

function style(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
export function short(x) {
  if (x === 0) return '0';
  const size = Math.abs(x);
  return size >= 1e5 || size < 1e-3 ? x.toExponential(2).replace('e+', 'e') : String(Number(x.toPrecision(3)));
}
