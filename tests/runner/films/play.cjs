// Plays pages in Chromium, without a display or a graphics card, and prints as JSON what it saw of each:
//   node play.cjs NODE_MODULES CHROMIUM OUT PAGE...
// Writes the vertices that the graphics card makes at moments into OUT/NAME_MOMENT.f32 (x, y, z and the number of shares, over the mesh's size about
// its middle); plays the last page, and writes pictures of it, light and dark.
const fs = require('fs');
const path = require('path');
const [, , modules, executablePath, out, ...pages] = process.argv;
const {chromium} = require(`${modules}/playwright-core`);

// In the page: where the shader that draws has the mesh's vertices at a moment. While three.js draws, the same source is
// linked anew for transform feedback, and gets the same attributes, uniforms and textures. Where a vertex is drawn must be
// what the camera makes of where it is; and its shadow lies on the ground.
async function measure(moment) {
  const {stage: {mesh, renderer, shadows}, view: {camera}, film, show} = await window.tendril, gl = renderer.getContext();
  const points = new Float32Array(4 * film.arrays.points.length / 3).fill(NaN), size = 32 * mesh.geometry.attributes.point.count;
  let astray = 0, top = -1, aloft = 0;
  const set = {
    [gl.FLOAT]: gl.uniform1f, [gl.FLOAT_VEC2]: gl.uniform2fv, [gl.FLOAT_VEC3]: gl.uniform3fv, [gl.FLOAT_VEC4]: gl.uniform4fv,
    [gl.INT]: gl.uniform1i, [gl.BOOL]: gl.uniform1i, [gl.SAMPLER_2D]: gl.uniform1i,
    [gl.FLOAT_MAT3]: (at, value) => gl.uniformMatrix3fv(at, false, value), [gl.FLOAT_MAT4]: (at, value) => gl.uniformMatrix4fv(at, false, value),
  };
  const link = drawn => {
    const made = gl.createProgram();
    const vertex = gl.getAttachedShaders(drawn).find(shader => gl.getShaderParameter(shader, gl.SHADER_TYPE) === gl.VERTEX_SHADER);
    for (const [type, text] of [[gl.VERTEX_SHADER, gl.getShaderSource(vertex)], [gl.FRAGMENT_SHADER, '#version 300 es\nvoid main() {}']]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(made, shader);
    }
    for (let k = 0; k < gl.getProgramParameter(drawn, gl.ACTIVE_ATTRIBUTES); ++k) {
      const {name} = gl.getActiveAttrib(drawn, k), at = gl.getAttribLocation(drawn, name);
      if (at >= 0) gl.bindAttribLocation(made, at, name);
    }
    gl.transformFeedbackVaryings(made, ['bound', 'gl_Position'], gl.INTERLEAVED_ATTRIBS);
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
    return made;
  };
  mesh.onAfterRender = () => {
    const drawn = gl.getParameter(gl.CURRENT_PROGRAM), made = link(drawn);
    gl.useProgram(made);
    for (let k = 0; k < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); ++k) {
      const {name, type} = gl.getActiveUniform(made, k);
      set[type].call(gl, gl.getUniformLocation(made, name), gl.getUniform(drawn, gl.getUniformLocation(drawn, name)));
    }
    const buffer = gl.createBuffer(), values = new Float32Array(size / 4);
    gl.bindBuffer(gl.TRANSFORM_FEEDBACK_BUFFER, buffer);
    gl.bufferData(gl.TRANSFORM_FEEDBACK_BUFFER, size, gl.DYNAMIC_READ);
    gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
    gl.enable(gl.RASTERIZER_DISCARD);
    gl.beginTransformFeedback(gl.POINTS);
    gl.drawArrays(gl.POINTS, 0, mesh.geometry.attributes.point.count);
    gl.endTransformFeedback();
    gl.disable(gl.RASTERIZER_DISCARD);
    gl.getBufferSubData(gl.TRANSFORM_FEEDBACK_BUFFER, 0, values);
    gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, null);
    const {elements: m} = camera.projectionMatrix.clone().multiply(camera.matrixWorldInverse);
    const {elements: s} = shadows.find(({owner}) => owner === 'mesh').shadow.matrix, {up, ground} = film.view;
    mesh.geometry.attributes.point.array.forEach((point, k) => {
      const [x, y, z, shares, ...drawnAt] = values.subarray(8 * k, 8 * k + 8);
      points.set([x, y, z, shares], 4 * point);
      const [fx, fy, fz, fw] = [0, 1, 2, 3].map(r => s[r] * x + s[4 + r] * y + s[8 + r] * z + s[12 + r]);
      aloft = Math.max(aloft, Math.abs((up[0] * fx + up[1] * fy + up[2] * fz) / fw - ground));
      top = Math.max(top, drawnAt[1] / drawnAt[3]);
      drawnAt.forEach((at, r) => { astray = Math.max(astray, Math.abs(at - (m[r] * x + m[4 + r] * y + m[8 + r] * z + m[12 + r]))); });
    });
    gl.deleteBuffer(buffer);
    gl.deleteProgram(made);
    gl.useProgram(drawn);
  };
  show(moment);
  delete mesh.onAfterRender;
  return {points: Array.from(points), astray, top, aloft};
}

// In the page, with everything shown: how many contacts are drawn at all moments, and whether all lines, dots, tubes and
// solids are somewhere.
async function outlines() {
  const {stage, last, show} = await window.tendril, {contacts} = stage.lines;
  document.querySelectorAll('#switches input').forEach(input => input.checked || input.click());
  let drawn = 0, finite = true;
  const check = (attribute, count) => { finite &&= count <= attribute.count; for (let k = 0; finite && k < count; ++k) finite = Number.isFinite(attribute.getX(k) + attribute.getY(k) + attribute.getZ(k)); };
  for (let k = 0; k <= last; ++k) {
    show(k);
    const [forces, dots] = contacts;
    drawn += dots.geometry.drawRange.count;
    finite &&= forces.geometry.instanceCount === dots.geometry.drawRange.count;
    for (const line of Object.values(stage.lines).flat()) {
      const {position, instanceStart, instanceEnd} = line.geometry.attributes;
      if (!instanceStart) check(position, line.geometry.drawRange.count);
      else [instanceStart, instanceEnd].forEach(end => check(end, line.geometry.instanceCount));
    }
    for (const {geometry: {attributes}} of stage.tubes) check(attributes.position, attributes.position.count);
    for (const {matrixWorld} of stage.solids) finite &&= matrixWorld.elements.every(Number.isFinite);
  }
  return {drawn, finite, solids: stage.solids.length};
}

async function see(browser, file) {
  const name = path.basename(file, '.html'), faults = [];
  const page = await browser.newPage({viewport: {width: 1100, height: 780}, colorScheme: 'light', hasTouch: true});
  page.on('console', message => { if (['error', 'warning'].includes(message.type())) faults.push(message.text()); });
  page.on('pageerror', error => faults.push(error.message));
  page.on('request', request => { if (!/^(file|data|blob):/.test(request.url())) faults.push(`asked for ${request.url()}`); });
  await page.goto(`file://${file}`);
  const last = await page.evaluate(async () => (await window.tendril).last);
  const moments = [...new Set([0, Math.floor(last / 2), last])], times = [];
  const mesh = await page.evaluate(async () => !!(await window.tendril).stage.mesh);
  for (const moment of mesh ? moments : []) {
    const {points, astray, aloft} = await page.evaluate(measure, moment);
    if (!(astray < 1e-4)) faults.push(`drawn ${astray} of the picture from where it is`);
    if (!(aloft < 2e-3)) faults.push(`a shadow ${aloft} of the size from the ground`);
    fs.writeFileSync(`${out}/${name}_${moment}.f32`, Buffer.from(Float32Array.from(points).buffer));
    times.push(Number(await page.textContent('#time')));
  }
  return {page, seen: {name, last, moments, times, faults}};
}

// What of a page is worth no picture.
async function look(page) {
  return {outlines: await page.evaluate(outlines), switches: await page.locator('#switches label').allTextContents()};
}

// By keyboard, as a person would.
async function play(page) {
  const film = what => page.evaluate(`window.tendril.then(film => film.${what})`);
  await page.keyboard.press('Home');
  await page.keyboard.press('ArrowRight');
  const stepped = await film('moment');
  await page.keyboard.press('Home');
  await page.keyboard.press('Space');
  await page.waitForFunction('window.tendril.then(film => film.moment > 0.5)', null, {timeout: 120000});
  const playing = await film('playing');
  await page.keyboard.press('Space');
  const paused = !await film('playing');
  await page.keyboard.press('End');
  return {stepped, playing, paused, ended: await film('moment')};
}

// By mouse, two fingers and keys: whether the view turned and came nearer, and to which output a click on a plot went.
async function touch(page) {
  const view = () => page.evaluate(async () => {
    const {yaw, pitch, distance} = (await window.tendril).view;
    return {yaw, pitch, distance};
  });
  const between = (a, b) => Math.atan2(Math.sin(b.yaw - a.yaw), Math.cos(b.yaw - a.yaw));
  const first = await view();
  await page.mouse.move(400, 250);
  await page.mouse.down();
  await page.mouse.move(480, 270, {steps: 3});
  await page.mouse.up();
  const turned = await view();
  const session = await page.context().newCDPSession(page);
  const fingers = (type, apart) => session.send('Input.dispatchTouchEvent', {
    type, touchPoints: type === 'touchEnd' ? [] : [{x: 400 - apart, y: 250, id: 0}, {x: 400 + apart, y: 250, id: 1}]});
  await fingers('touchStart', 40);
  for (const apart of [50, 65, 80]) await fingers('touchMove', apart);
  await fingers('touchEnd');
  const near = await view();
  await page.keyboard.press('Shift+ArrowLeft');
  await page.keyboard.press('+');
  const keyed = await view();
  const plot = await page.locator('#energy').boundingBox();
  await page.mouse.click(plot.x + plot.width / 2, plot.y + plot.height / 2);
  const moment = await page.evaluate('window.tendril.then(film => film.moment)');
  await page.mouse.dblclick(400, 250);
  const home = await view();
  return {turned: [between(first, turned), turned.pitch - first.pitch], nearer: near.distance / first.distance,
          keyed: [between(near, keyed), keyed.distance / near.distance], clicked: moment, home: home.distance === first.distance && home.yaw === first.yaw};
}

// On a telephone: where what is above the picture ends, and where the mesh begins, from the screen's upper edge.
async function narrow(page) {
  const height = 780;
  await page.setViewportSize({width: 390, height});
  await page.waitForFunction('document.getElementById("view").width === Math.round(390 * Math.min(2, window.devicePixelRatio))');
  const {top} = await page.evaluate(measure, 0), {y, height: covered} = await page.locator('#top').boundingBox();
  return {covered: y + covered, mesh: 0.5 * (1 - top) * height};
}

// In a browser without what the page needs: what it says instead of a picture.
async function refusal(browser, file) {
  const page = await browser.newPage();
  await page.addInitScript('delete window.DecompressionStream');
  await page.goto(`file://${file}`);
  const text = await page.locator('#fault').textContent();
  await page.close();
  return text;
}

async function picture(page, name, last) {
  await page.evaluate(async k => (await window.tendril).show(k), Math.floor(last / 2));
  const inputs = await page.locator('#switches input').all();
  const first = await Promise.all(inputs.map(input => input.isChecked()));
  for (const input of inputs) await input.check();
  await page.screenshot({path: `${out}/${name}_all.png`});
  for (const [k, input] of inputs.entries()) await input.setChecked(first[k]);
  await page.screenshot({path: `${out}/${name}_light.png`});
  await page.emulateMedia({colorScheme: 'dark'});
  await page.evaluate(async k => (await window.tendril).show(k), Math.floor(last / 2));
  await page.screenshot({path: `${out}/${name}_dark.png`});
  return page.locator('#switches label').allTextContents();
}

(async () => {
  const browser = await chromium.launch({executablePath, args: ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--no-sandbox']});
  const seen = [];
  for (const [k, file] of pages.entries()) {
    const {page, seen: one} = await see(browser, path.resolve(file));
    if (k === pages.length - 1) Object.assign(one, await play(page), await touch(page), {switches: await picture(page, one.name, one.last)},
                                                 {narrow: await narrow(page), refusal: await refusal(browser, path.resolve(file))});
    else Object.assign(one, await look(page));
    await page.close();
    seen.push(one);
  }
  await browser.close();
  console.log(JSON.stringify(seen));
})().catch(error => { console.error(error.message); process.exit(1); });
