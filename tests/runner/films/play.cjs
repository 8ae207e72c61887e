// Plays pages in Chromium, without a display or a graphics card, and prints as JSON what it saw of each:
//   node play.cjs NODE_MODULES CHROMIUM OUT PAGE...
// Writes the vertices of moments into OUT/NAME_MOMENT.f32 (x, y, z and the number of shares, over the mesh's size about
// its middle); plays the last page, and writes pictures of it, light and dark.
const fs = require('fs');
const path = require('path');
const [, , modules, executablePath, out, ...pages] = process.argv;
const {chromium} = require(`${modules}/playwright-core`);

async function see(browser, file) {
  const name = path.basename(file, '.html'), faults = [];
  const page = await browser.newPage({viewport: {width: 1100, height: 780}, colorScheme: 'light', hasTouch: true});
  page.on('console', message => { if (['error', 'warning'].includes(message.type())) faults.push(message.text()); });
  page.on('pageerror', error => faults.push(error.message));
  page.on('request', request => { if (!/^(file|data|blob):/.test(request.url())) faults.push(`asked for ${request.url()}`); });
  await page.goto(`file://${file}`);
  const last = await page.evaluate(async () => (await window.tendril).last);
  const moments = [...new Set([0, Math.floor(last / 2), last])], times = [];
  for (const moment of moments) {
    const points = await page.evaluate(async k => { const film = await window.tendril; film.show(k); return film.points(); }, moment);
    fs.writeFileSync(`${out}/${name}_${moment}.f32`, Buffer.from(Float32Array.from(points).buffer));
    times.push(Number(await page.textContent('#time')));
  }
  return {page, seen: {name, last, moments, times, faults}};
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

// By mouse and by two fingers: whether the view turned and came nearer, and to which output a click on a plot went.
async function touch(page) {
  const view = () => page.evaluate('window.tendril.then(film => film.view)');
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
  const plot = await page.locator('#energy').boundingBox();
  await page.mouse.click(plot.x + plot.width / 2, plot.y + plot.height / 2);
  const moment = await page.evaluate('window.tendril.then(film => film.moment)');
  await page.mouse.dblclick(400, 250);
  const home = await view();
  return {turned: [turned.yaw - first.yaw, turned.pitch - first.pitch], nearer: near.distance / first.distance,
          clicked: moment, home: home.distance === first.distance && home.yaw === first.yaw};
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
    if (k === pages.length - 1) Object.assign(one, await play(page), await touch(page), {switches: await picture(page, one.name, one.last)});
    await page.close();
    seen.push(one);
  }
  await browser.close();
  console.log(JSON.stringify(seen));
})().catch(error => { console.error(error.message); process.exit(1); });
