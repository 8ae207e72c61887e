// The page: time line, switches, keyboard.

async function main() {
  const film = await readFilm();
  const $ = id => document.getElementById(id);
  const gl = $('view').getContext('webgl2', {antialias: true, stencil: true, alpha: true, preserveDrawingBuffer: true});
  if (!gl) throw new Error('This page needs WebGL 2, which the browser does not offer.');
  const scene = new Scene(gl, film), last = film.times.length - 1;
  const plots = [new EnergyPlot($('energy'), film), new StepPlot($('steps'), film)];
  const switches = [
    {key: 'mesh', name: 'mesh', on: true, there: scene.mesh},
    {key: 'pairs', name: 'curve-pairs', on: !scene.mesh, there: true},
    {key: 'frames', name: 'frames', on: false, there: true},
    {key: 'tubes', name: 'tubes', on: !scene.mesh, there: true},
    {key: 'contacts', name: 'contacts', on: true, there: film.arrays.contact_count.some(n => n > 0)},
    {key: 'ambiguous', name: 'ambiguous', on: false, there: scene.mesh && film.arrays.other_count.some(n => n > 0)},
  ].filter(({there}) => there);
  const shown = Object.fromEntries(switches.map(({key, on}) => [key, on]));
  let moment = 0, playing = false, wanted = false, posed = -1;

  const render = () => {
    wanted = false;
    fit();
    if (posed !== moment) scene.pose(posed = moment);
    scene.draw(shown, orbit, ($('panel').offsetHeight + 14) / window.innerHeight, matchMedia('(prefers-color-scheme: dark)').matches ? 0.45 : 0.16);
    const k = Math.min(last, Math.floor(moment)), next = Math.min(last, k + 1);
    const time = film.times[k] + (moment - k) * (film.times[next] - film.times[k]);
    $('time').textContent = time.toFixed(film.digits);
    $('scrub').value = moment;
    plots.forEach(plot => plot.draw(time));
    const near = Math.round(moment);
    for (const {key} of kSeries) $(`value-${key}`).textContent = short(film.energies[key][near]);
  };
  const ask = () => {
    if (!wanted) requestAnimationFrame(render);
    wanted = true;
  };
  const fit = () => {
    const ratio = Math.min(2, window.devicePixelRatio || 1), canvas = gl.canvas;
    const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
  };
  const orbit = new Orbit($('view'), film.view, ask);
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
    r: () => orbit.reset(),
  };
  window.addEventListener('keydown', event => {
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.key]();
  });
  window.addEventListener('resize', ask);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', ask);
  render();
  return {
    film, last, play, show: to => { play(false); moment = to; render(); },
    get moment() { return moment; }, get playing() { return playing; },
    get view() { return {yaw: orbit.yaw, pitch: orbit.pitch, distance: orbit.distance}; },
    points: () => scene.mesh ? Array.from(scene.mesh.read()) : [],
  };
}

window.tendril = main();
window.tendril.catch(error => {
  document.getElementById('fault').textContent = error.message;
  document.getElementById('fault').hidden = false;
});
