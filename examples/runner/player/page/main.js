// The page: time line, switches, keyboard.

import {readFilm} from './data.js';
import {EnergyPlot, kSeries, short, StepPlot} from './plots.js';
import {Stage} from './scene.js';
import {View} from './view.js';

export async function main(inflate) {
  const film = await readFilm(inflate);
  const $ = id => document.getElementById(id);
  const stage = new Stage($('view'), film), last = film.times.length - 1;
  const plots = [new EnergyPlot($('energy'), film), new StepPlot($('steps'), film)];
  const switches = [
    {key: 'mesh', name: 'mesh', on: true, there: stage.mesh},
    {key: 'pairs', name: 'curve-pairs', on: !stage.mesh, there: true},
    {key: 'frames', name: 'frames', on: false, there: true},
    {key: 'tubes', name: 'tubes', on: !stage.mesh, there: true},
    {key: 'contacts', name: 'contacts', on: true, there: film.arrays.contact_count.some(n => n > 0)},
    {key: 'ambiguous', name: 'ambiguous', on: false, there: stage.mesh && film.arrays.other_count.some(n => n > 0)},
  ].filter(({there}) => there);
  const shown = Object.fromEntries(switches.map(({key, on}) => [key, on]));
  let moment = 0, playing = false, wanted = false, posed = -1;

  const render = () => {
    wanted = false;
    if (posed !== moment) stage.pose(posed = moment);
    stage.draw(shown, view, room(), matchMedia('(prefers-color-scheme: dark)').matches ? 0.45 : 0.16);
    const k = Math.min(last, Math.floor(moment)), next = Math.min(last, k + 1);
    const time = film.times[k] + (moment - k) * (film.times[next] - film.times[k]);
    $('time').textContent = time.toFixed(film.digits);
    $('scrub').value = moment;
    plots.forEach(plot => plot.draw(time));
    const near = Math.round(moment);
    for (const {key} of kSeries) $(`value-${key}`).textContent = short(film.energies[key][near]);
  };
  // On a narrow screen the switches are a row above the picture, else they stand beside it.
  const room = () => {
    const row = $('switches').offsetWidth > 0.5 * window.innerWidth;
    return {above: row ? $('top').offsetHeight / window.innerHeight : 0, below: ($('panel').offsetHeight + 14) / window.innerHeight};
  };
  const ask = () => {
    if (!wanted) requestAnimationFrame(render);
    wanted = true;
  };
  const view = new View($('view'), film.view, ask);
  const show = to => {
    moment = Math.min(last, Math.max(0, to));
    ask();
  };
  const play = on => {
    playing = on && last > 0;
    $('play').textContent = playing ? '❚❚' : '▶';
    $('play').setAttribute('aria-label', playing ? 'pause' : 'play');
    if (!playing) return;
    if (moment >= last) moment = 0;
    let before = null;
    const tick = now => {
      if (!playing) return;
      if (before !== null) {
        const time = at(moment) + (now - before) / 1000 * film.pace;
        if (time >= film.times[last]) { moment = $('loop').checked ? 0 : last; if (moment) play(false); }
        else moment = momentOf(time);
      }
      before = now;
      render();
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  };
  const at = m => {
    const k = Math.min(last - 1, Math.floor(m));
    return film.times[k] + (m - k) * (film.times[k + 1] - film.times[k]);
  };
  const momentOf = time => {
    let k = 0;
    while (k + 1 < last && film.times[k + 1] <= time) ++k;
    return last > 0 ? Math.min(last, k + Math.max(0, (time - film.times[k]) / (film.times[k + 1] - film.times[k]))) : 0;
  };

  document.title = film.name;
  $('name').textContent = film.name;
  $('about').textContent = film.about;
  $('unit').textContent = film.timeUnit;
  for (const {key, name, color} of kSeries)
    $('legend').insertAdjacentHTML('beforeend', `<span><i style="background:var(${color})"></i>${name} <b id="value-${key}"></b></span>`);
  for (const {key, name, on} of switches) {
    $('switches').insertAdjacentHTML('beforeend', `<label><input type="checkbox" id="show-${key}"${on ? ' checked' : ''}>${name}</label>`);
    $(`show-${key}`).addEventListener('change', event => { shown[key] = event.target.checked; ask(); });
  }
  $('scrub').max = last;
  $('scrub').addEventListener('input', event => { play(false); show(Math.round(Number(event.target.value))); });
  $('play').addEventListener('click', () => play(!playing));
  for (const plot of plots) {
    const go = event => { play(false); show(Math.round(momentOf(plot.time(event.offsetX)))); };
    plot.canvas.addEventListener('pointerdown', event => { plot.canvas.setPointerCapture(event.pointerId); go(event); });
    plot.canvas.addEventListener('pointermove', event => { if (event.buttons & 1) go(event); });
  }
  const keys = {
    ' ': () => play(!playing),
    ArrowRight: () => { play(false); show(Math.floor(moment) + 1); },
    ArrowLeft: () => { play(false); show(Math.ceil(moment) - 1); },
    Home: () => { play(false); show(0); },
    End: () => { play(false); show(last); },
    r: () => view.reset(),
    '+': () => view.nearer(kNearer),
    '-': () => view.nearer(1 / kNearer),
  };
  const turns = {ArrowLeft: [kTurn, 0], ArrowRight: [-kTurn, 0], ArrowUp: [0, kTurn], ArrowDown: [0, -kTurn]};
  window.addEventListener('keydown', event => {
    const turn = event.shiftKey && turns[event.key], key = turn ? () => view.turn(...turn) : keys[event.key];
    if (!key || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    key();
  });
  window.addEventListener('resize', ask);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', ask);
  render();
  return {
    film, last, stage, play, view, show: to => { play(false); moment = to; render(); },
    get moment() { return moment; }, get playing() { return playing; },
  };
}

const kTurn = 0.1, kNearer = 1.1;
