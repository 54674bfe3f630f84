/* check_page.js - out/bbm.html in node and in headless Chromium, beside ./bbm:
 *     node tests/check_page.js BBM PAGE_NATIVE FOLDER
 *
 * A picture of each state of the page is left in the folder. */
'use strict';
const assert = require('assert'), fs = require('fs'), path = require('path'), vm = require('vm'),
  zlib = require('zlib');
const { spawnSync } = require('child_process'), { open } = require('./chromium.js');
const [bbm, native, folder] = process.argv.slice(2), url = `file://${path.resolve('out/bbm.html')}`;
const read = name => fs.readFileSync(name, 'utf8'), html = read('out/bbm.html'),
  models = 'cases/models/';
const embedded = name => zlib.gunzipSync(Buffer.from(html.split(`data-file="${name}">`)[1]
  .split('<')[0], 'base64'));
const near = (a, b) => assert(Math.abs(a - b) <= 1e-5 * Math.abs(b) + 1e-12, `${a}, expected ${b}`);

/* What ./bbm says of a model; the last row of one of its tables that is wanted. */
function runBBM(file, ...options) {
  const r = spawnSync(bbm, [file, '-o', `${folder}/bbm`, ...options], { encoding: 'utf8' });
  return { said: r.stdout.split('\n').filter(l => l.startsWith('expected')).join('\n'),
    error: r.stderr.trim().split('\n').at(-1).replace(`${folder}/`, '') };
}

function table(name, wanted = () => true) {
  const [head, ...rows] = read(`${folder}/bbm/${name}`).trim().split('\n').map(l => l.split(','));
  return rows.map(r => Object.fromEntries(head.map((h, k) => [h, r[k]]))).findLast(wanted);
}

function checkFile() {
  assert(html.length < 350e3, `${html.length} bytes`);
  const text = html.replace(/data-file="[^"]*">[^<]*/g, '');
  assert(!/\beval\(|new Function|https?:|(inner|outer)HTML|insertAdj|document\.write/.test(text));
  assert(text.includes("default-src 'none'"));
}

/* The same bits as with musl, whose libm is that of WASI, also of what lies beyond 2 GB; each import
 * is there. */
async function checkBits() {
  for (const part of ['wasi', 'model'])
    vm.runInThisContext(read(`page/${part}.js`));
  const wasm = embedded('bbm.wasm'),
    asked = WebAssembly.Module.imports(new WebAssembly.Module(wasm)).map(i => i.name);
  const { wasi, start, files, load, step, numbers } = vm.runInThisContext(
    '({ wasi, start: startLibrary, files, load: loadModel, step: stepModel, numbers: numbersOf })');
  assert.deepEqual(Object.keys(wasi()).sort(), asked.sort());
  await start(wasm);
  files.set('dam.msh', embedded('dam.msh').toString());
  for (const name of ['arch', 'incline', 'dam', 'wall', 'dominoes']) {
    if (name === 'dominoes')
      vm.runInThisContext('wasm.page_free(run.handle); run = null; wasm.memory.grow(32768);' +
        'while (wasm.malloc(64) > 0);');
    assert.equal(load(`${name}.model`, embedded(`${name}.model`).toString()), '');
    while (step());
    const bits = [...new BigUint64Array(numbers('v').buffer)].map(b =>
      `${b.toString(16)}\n`).join('');
    const expected = spawnSync(native, [`${models}${name}.model`], { encoding: 'utf8',
      maxBuffer: 1e8 }).stdout;
    assert(bits.length > 0 && bits === expected, `${name}: other bits`);
  }
}

/* ------------------------------------------------------------------------ a hand */

/* What a hand does: it holds a point of an element, and pulls it to where(t) for so many steps. */
function pullAt(name, text, element, at, where, steps) {
  const { load, step, hold, pull } = vm.runInThisContext(
    '({ load: loadModel, step: stepModel, hold, pull })');
  assert.equal(load(name, text), '');
  hold(element, ...at);
  for (let k = 1; k <= steps; k++) {
    pull(...where(k));
    assert(step(), `${name}: over after ${k} steps`);
  }
  return vm.runInThisContext('run.frames.at(-1)');
}

/* At rest, or at an even speed, a pull is what theory says, and its work is in the balance. A block
 * that hangs from the hand: its weight, by which the spring is 1/20 of the block longer. A block
 * that is pulled up the incline: along the slope W (sin a + cos a tan(phi)), less tan(phi) times
 * its part across. What still swings is below 1e-5 after so many steps. */
function checkForces() {
  const close = (a, b) => assert(Math.abs(a - b) <= 1e-5 * Math.abs(b), `${a}, expected ${b}`);
  const { h: hanging, work } = pullAt('hanging.model', 'material rock E 1e9 nu 0.2 density 2500\n' +
    'gravity 0 -10\ncontact friction 30\ndynamic dt 0.01 steps 9\nblock a rock 0 0 1 0 1 1 0 1\n',
  0, [0.5, 0.9], () => [0.5, 0.9], 500);
  close(hanging[6], 25e3);
  close(hanging[4] - hanging[2], 0.05);
  let done = 25e3 * 0.05;               /* by gravity, but for its strain; then by the hand */
  vm.runInThisContext('run.frames').slice(1).reduce((y, { h }) => {
    done += h[6] * (h[2] - y);
    return h[2];
  }, 0.9);
  assert(Math.abs(work - done) <= 1e-3 * 25e3 * 0.05, `${work} J, expected ${done}`);
  const s = Math.sin(Math.PI / 6), c = Math.cos(Math.PI / 6), friction = Math.tan(Math.PI / 9),
    W = 2500 * 9.81 / 2, way = k => 1e-3 * k;
  const [, , , , , fx, fy] = pullAt('incline.model', embedded('incline.model').toString(), 1,
    [0.3, 0.4], k => [0.3 + way(k) * c, 0.4 + way(k) * s], 400).h;
  close(fx * c + fy * s + friction * (fy * c - fx * s), W * (s + c * friction));
}

/* Of each model of the gallery the last block that can move, whipped about in curves as large as
 * one of its sides, until WHIPPED ms have passed: no step makes energy, but 1e-7 of the work that
 * steps do, in and out, for what rounding does in 300 of them, and the hand seldom slips. Statics,
 * which may find out that what is pulled falls, has no energy to gain. */
const WHIPPED = 10e3;

function checkWhip(name, text) {
  const { load, step, hold, pull, rows, last } = vm.runInThisContext(`({ load: loadModel,
    step: stepModel, hold, pull, rows, last: () =>
      ({ f: run.frames.at(-1), state: run.state }) })`);
  assert.equal(load(name, text), '');
  const { f } = last(), v = rows(f, 'v'), start = Date.now();
  const e = rows(f, 'e').findLastIndex(q => v[q[23]][4] === 0);
  const [a, b, c] = v.slice(rows(f, 'e')[e][23]), at = [0, 1].map(k => (a[k] + b[k] + c[k]) / 3);
  const size = Math.hypot(a[0] - b[0], a[1] - b[1]);
  let slips = 0, k = 0, work = 0;
  for (hold(e, ...at); k < 300 && last().state < 2 && Date.now() - start < WHIPPED; k++) {
    const before = last().f.work;
    pull(at[0] + size * Math.sin(k / 5), at[1] + size * Math.sin(k / 7));
    step();
    work += Math.abs(last().f.work - before);
    if (last().state < 2 && !last().f.h.length && ++slips)
      hold(e, ...at);
  }
  const end = last().f;
  assert(!end.dynamic || last().state < 2, `${name}: ${end.failure}`);
  assert(end.gained <= 1e-7 * work, `${name}: ${end.gained} J made of ${work}`);
  assert(!end.dynamic || slips <= k / 4, `${name}: ${slips} slips in ${k} steps`);
}

function checkHand() {
  const names = fs.readdirSync(models).filter(f => /\.(model|msh)$/.test(f));
  names.forEach(f => vm.runInThisContext('files').set(f, read(models + f)));
  checkForces();
  names.filter(f => f.endsWith('.model')).forEach(f => checkWhip(f, read(models + f)));
}

/* ------------------------------------------------------------------------ in the browser */

let p;
const text = id => p.do(`document.getElementById('${id}').innerText`);
const push = id => p.do(`document.getElementById('${id}').click()`);
const type = (id, value, event = 'change') => p.do(`(e => { e.value = ${JSON.stringify(value)};
  e.dispatchEvent(new Event('${event}')); })(document.querySelector('${id}'))`);
/* The rows of a table of the page, by what stands first. */
const cells = id => p.do(`Object.fromEntries([...document.getElementById('${id}').rows].map(r =>
  [r.cells[0].innerText, [...r.cells].slice(1).map(c => c.innerText)]))`);

/* The mouse, at a place of the model. */
const place = (X, Y) => p.do(`(r => { const q = findScale(r.width, r.height).to(${X}, ${Y});
  return [r.x + q[0], r.y + q[1]]; })(document.getElementById('view').getBoundingClientRect())`);

async function mouse(type, X, Y, clickCount = 1, buttons = 1) {
  const [x, y] = await place(X, Y);
  await p.send('Input.dispatchMouseEvent', { type: `mouse${type}`, x, y, buttons,
    button: buttons ? 'left' : 'none',
    clickCount });
}

async function clickAt(X, Y, count = 1) {
  await mouse('Pressed', X, Y, count);
  await mouse('Released', X, Y, count);
}

async function dragFrom(X, Y, x, y) {
  await mouse('Pressed', X, Y);
  for (const part of [0.5, 1])
    await mouse('Moved', X + part * (x - X), Y + part * (y - Y));
}

async function runAll(model, button = 'run') {
  if (model)
    await type('#gallery', model);
  if (button)
    await push(button);
  await p.until('!playing && run.state > 0');
  return text('expected');
}

async function checkRuns() {
  for (const name of ['arch', 'incline', 'dam', 'exp1', 'wall']) {
    assert.equal(await runAll(`${name}.model`), runBBM(`${models}${name}.model`).said);
    const facts = await cells('facts'), sum = table('summary.csv');
    assert.match(await text('say'), RegExp(`^step ${sum.step} of`));
    assert.equal(`${facts['open-close passes'][0]} ${facts['contacts closed'][0]}`,
      `${sum.open_close} ${sum.contacts}`);
    await p.shot(name);
  }
}

/* Cracks are boundaries from the step on in which they open. What breaks later depends on the last
 * digits of libm. */
async function checkCracks() {
  assert.match(await runAll('wedge.model'), /^(expected: .*: ok\n?){3}$/);
  assert(await p.do('run.frames.at(-1).d.length > run.frames[0].d.length'));
  await p.shot('wedge');
}

async function checkSliderAndLink() {
  const { said } = runBBM(`${models}incline.model`, '-d', 'phi=31');
  assert.match(said, /NOT MET$/);
  await runAll('incline.model');
  await type('#lets input[type=range]', '31', 'input');
  assert.equal(await runAll(null, null), said);
  await push('link');
  await p.until('/^the link is/.test(hands.said)');
  await p.go(await p.do('location.href'));
  assert.equal(await runAll(), said);
  await type('#when', '40', 'input');
  assert.match(await text('say'), /^step 40 of 100\s+t = 0.4 s/);
  await p.shot('slider');
  await p.do('run.bytes = 2 * ROOM, keepFrame()');      /* every second picture goes */
  for (const [frame, wanted] of [[0, 'run.frames[0]'], [1000, 'run.frames.at(-1)']])
    assert(await p.do(`goTo(${frame}), shown() === ${wanted}`), `frame ${frame} has gone`);
}

async function checkClicks() {
  runBBM(`${models}incline.model`);
  await runAll('incline.model');
  const e = table('elements.csv', r => r.block === 'block'), c = table('contacts.csv');
  await clickAt(+e.x + +e.u, +e.y + +e.v);
  assert.match(await text('who'), RegExp(`^element ${e.element} of block block`));
  const element = await cells('about');
  near(element.sxx[0], e.sxx);
  near(element['u0 [m]'][1], e.vx);
  await p.shot('element');
  await clickAt(c.x, c.y);
  const contact = await cells('about');
  assert.equal(contact.state[0], c.state);
  near(contact.N[0], c.normal);
  near(contact.d_n[0], c.gap);
  await p.shot('contact');
  await type('#when', '1', 'input');
  await push('inside');
  for (const why of ['LOCK\tSLIDE\t.*abs\\(T\\) > bound', 'SLIDE\tSLIDE']) {
    await push('after');
    assert.match(await text('changes'), RegExp(why));
    await p.shot('inside');
  }
  await push('inside');
}

/* Each change of a state is by a row of the table that is of these states. */
async function checkRows() {
  await runAll('dominoes.model');
  const used = await p.do(`[...new Set(run.frames.flatMap(f => looksOf(f).flatMap(look =>
    look.contacts.map(c => [STATES[c[2]], STATES[c[3]], ...rowOf(look, c)].join('|')))))]`);
  assert(used.length >= 9, used);
  for (const [from, to, before, why, after] of used.map(row => row.split('|')))
    assert(before === '' || before === from && why && after.startsWith(to), `${from} ${to}`);
}

/* What may take long is said before it begins. */
async function checkLarge() {
  await type('#text', `material a E 1e9 nu 0.2 density 1\nfix box 0 0 0 1\nload at 9 1 0 -1\n` +
    'static\ngrid plate a 0 0 9 1 90 10\n', 'input');
  await p.until('rows(shown(), "e").length === 900');
  assert.equal(await p.do('is("run").click(), is("say").textContent'), 'solving 5400 unknowns');
  assert.equal(await runAll(null, null), '');
}

async function checkErrors() {
  const good = read(`${models}incline.model`), hack = '<img src=x onerror=hacked=1>',
    file = `${folder}/incline.model`;
  fs.writeFileSync(file, good.replace('gravity', 'grav' + hack));
  const { error } = runBBM(file);
  await type('#gallery', 'incline.model');
  await type('#text', read(file), 'input');
  await p.until('document.getElementById("error").innerText');
  assert((await text('error')).startsWith(error), error);
  assert.equal((await p.do('document.querySelector("#lines .bad").innerText')).trim(),
    error.split(':')[1]);
  await p.shot('error');
  await push('step');                           /* of the model before, which is alive */
  await p.until('!playing');
  assert.match(await text('say'), /^step 1 of 100/);
  fs.writeFileSync(file, good.replace(/^dynamic.*/m, 'static').replace(/^title.*/m,
    `title </script><script>hacked=1</script>${hack}`));
  await type('#text', read(file), 'input');
  await p.until('!document.getElementById("error").innerText');
  await runAll();
  assert.equal(await text('error'), runBBM(file).error);
  await push('link');
  await p.go(await p.do('location.href'));
  assert.equal(await p.do('document.getElementById("text").value'), read(file));
  assert(!await p.do('typeof hacked !== "undefined" || document.querySelector("img") !== null'));
}

/* The chapter that has the exercise. */
const chapter = number => fs.readdirSync('doc').map(f => `doc/${f}`).find(f => /\/0.*md$/.test(f) &&
  read(f).includes(`### Exercise ${number} `));

async function checkExercises() {
  const predictions = { 2.1: ['right u', '0.0156', /NOT MET$/], 6.1: ['corner u', '-0.785', /ok$/],
    8.2: ['tip v', '-8.9e-3', /ok$/], 8.4: ['P u', '2.0', /ok$/] };
  const numbers = await p.do('Object.keys(EXERCISES)');
  assert.deepEqual(numbers, Object.keys(predictions));
  for (const number of numbers) {
    const [what, value, said] = predictions[number];
    await type('#gallery', number);
    assert(read(chapter(number)).includes(`### Exercise ${(await text('task')).split('\n')[0]}\n`));
    await push('run');
    await push('step');
    assert(await p.do('run.frames.length <= 1 && !playing'));
    await type('#what', what);
    await type('#number', value);
    const predict = () => p.do('document.querySelector("#exercise button").click()');
    await predict();
    const first = await runAll(null, null);
    await p.shot(`exercise-${number}`);
    if (!said.test(first)) {                    /* the number comes after the second prediction */
      assert(/^Not so/.test(first) && !/computed/.test(first));
      assert(await p.do('is("monitors").hidden'));
      await predict();
      assert.match(await runAll(null, null), said);
    }
  }
}

/* A phone has one column, its picture first, and fingers; a theme may change while it is open. */
async function checkPhone() {
  const metrics = (width, height, mobile) => p.send('Emulation.setDeviceMetricsOverride',
    { width, height, deviceScaleFactor: 1, mobile });
  const theme = value => p.send('Emulation.setEmulatedMedia', { features: [{
    name: 'prefers-color-scheme', value }] });
  await metrics(390, 844, true);
  await p.go(`${url}#model=incline`);
  assert.equal(await text('error'), '');
  const top = id => p.do(`is("${id}").getBoundingClientRect().top`);
  assert(await top('middle') < 200 && await top('graphs') < await top('left'));
  assert(await p.do('document.documentElement.scrollWidth <= 390'));
  await push('step');
  await p.until('!playing');
  const finger = async (type, X, Y) => p.send('Input.dispatchTouchEvent', { type: `touch${type}`,
    touchPoints: type === 'End' ? [] : [Object.fromEntries((await place(X, Y)).map((a, k) =>
      ['xy'[k], a]))] });
  await finger('Start', 0.3, 0.5);
  await finger('Move', 0.3, 2);
  await finger('Move', 0.3, 2.5);
  await p.until('run.frames.at(-1).o[1] > 1');
  await p.shot('phone');
  await finger('End');
  await p.do('scrollTo(0, 700)');
  await p.shot('phone-below');
  await metrics(1280, 720, false);
  await type('#gallery', 'arch.model');
  await type('#lets label:nth-child(2) input', '1', 'input');
  await runAll();
  const paper = () => p.do('[...is("view").getContext("2d").getImageData(0, 0, 1, 1).data].join()' +
    ' + css("--ink")');
  const light = await paper();
  await theme('dark');
  await p.until(`css("--ink") !== "#1a1a1a"`);
  await p.shot('dark-arch');
  assert.notEqual(await paper(), light);
  await theme('light');
  await p.shot('light-arch');
  await runAll('bolted.model');
  await p.shot('bolt');
}

async function checkKeys() {
  await p.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme',
    value: 'dark' }] });
  await p.go(`${url}#model=dominoes.model`);
  await press(' ');                             /* settles */
  await press(' ');
  assert.match(await text('say'), /^step 1 of 5000/);
  await p.shot('dark');
  await press('f');
  assert(await p.do('document.getElementById("full").checked'));
  await p.shot('full');
}

/* A block in hand follows it in real time, against its weight; what comes out is not judged. The
 * page's clock is made to go on by 0.02 s a picture, however busy the machine is. No step begins
 * more than 0.05 s before its time, and each takes 0.01 s. */
async function checkPull() {
  await p.do('{ let now = 0; performance.now = () => now += 0.01;' +
    '(function picture() { now += 20; requestAnimationFrame(picture); })(); }');
  const times = () => p.do('[performance.now() / 1e3, run.frames.at(-1).t]');
  await push('paced');
  const [begin] = await times();
  await runAll('incline.model');                        /* of 1 s */
  const took = (await times())[0] - begin;
  assert(took > 0.94, `1 s of the model in ${took} s`);
  await push('paced');
  await type('#gallery', 'incline.model');
  await push('step');
  await p.until('!playing');
  await dragFrom(0.3, 0.5, 0.3, 2);
  const [start, t] = await times();
  await p.until('run.frames.at(-1).o[1] > 1');
  await p.shot('pull');
  const [end, reached] = await times();
  assert(reached - t < end - start + 0.06, `${reached - t} s of the model in ${end - start} s`);
  assert.match(await text('expected'), /^Pulled by hand[^]*by hand: corner u/);
  await p.until('run.frames.at(-1).step > 200');        /* the file has 100 */
  await mouse('Released', 0.3, 2);
  assert(await p.do('hands.grip === null'));
  await p.until('run.frames.at(-1).h.length === 0 && run.frames.at(-1).o[1] < 1');
  await p.do('delete performance.now');
}

const press = async (key, modifiers = 0) => {
  await p.send('Input.dispatchKeyEvent', { type: 'keyDown', key, modifiers,
    text: modifiers ? '' : key.length === 1 ? key : '' });
  await p.until('!playing');
};
const model = () => p.do('is("text").value');
const lineOf = async name => (await model()).split('\n').find(l => l.startsWith(name));
const shape = async name => (await lineOf(`block ${name}`)).split(/\s+/).slice(3).map(Number);

async function drop(X, Y, x, y, shot) {
  await dragFrom(X, Y, x, y);
  if (shot)
    await p.shot(shot);
  await mouse('Released', x, y);
}

/* Corners and blocks by the mouse: what they touch, what follows, what is refused; and undo. */
async function checkEdit() {
  await type('#gallery', 'incline.model');
  const before = await model(), block = [0, 0, 0.8660254038, 0.5, 0.6160254038, 0.9330127019,
    -0.25, 0.4330127019];
  await drop(-0.25, 0.4330127019, -1.98, 3.03, 'corner');
  const [X, Y] = (await shape('block')).slice(6);
  assert(Math.hypot(X + 2, Y - 3) < 1e-9, `corner at ${X} ${Y}`);         /* of the grid */
  assert.deepEqual((await shape('block')).slice(0, 6), block.slice(0, 6));
  assert(await p.do('document.querySelector("#lines .now").innerText.trim()') ===
    `${before.split('\n').findIndex(l => l.startsWith('block block')) + 1}`);
  await press('z', 2);
  assert.equal(await model(), before);
  await drop(0.3, 0.5, 0.3 + 1.75, 0.5 + 0.99);          /* nearly along the slope: snaps to it */
  const moved = await shape('block'), s = 0.5, c = Math.sqrt(0.75);
  assert(Math.abs(moved[1] * c - moved[0] * s) < 1e-8 && moved[0] > 1, `${moved}`);
  moved.forEach((x, k) => near(x - moved[k % 2], block[k]));
  assert.equal(await lineOf('monitor'), `monitor corner at ${moved[0]} ${moved[1]} of block`);
  assert.equal(await text('error'), '');
  await drop(moved[0] + 0.3, moved[1] + 0.5, moved[0] + 0.2, moved[1] - 0.3);       /* into it */
  assert.match(await text('error'), /overlap/);
  await p.shot('overlap');
  const [x, y] = await shape('block');
  await drop(x + 0.3, y + 0.5, x + 0.3, y + 2);
  assert.equal(await text('error'), '');
  await drop(-2, -1.3, -3, -1.3);                        /* the block that is fixed, too */
  assert((await shape('incline'))[0] < -10.5);
  for (let k = 0; k < 4; k++)
    await press('z', 2);
  assert.equal(await model(), before);
  await press('y', 2);
  assert.equal(await lineOf('monitor'), `monitor corner at ${moved[0]} ${moved[1]} of block`);
}

/* A new block is drawn, falls, is deleted; a block of `repeat` says why it stays. */
async function checkDraw() {
  await type('#gallery', 'incline.model');
  const before = await model();
  await push('draw');
  for (const [x, y] of [[1, 3], [2, 3], [2, 4]])
    await clickAt(x, y);
  await mouse('Moved', 1, 4, 0, 0);
  await p.shot('draw');
  await clickAt(1, 4);
  await clickAt(1, 4, 2);
  assert.deepEqual(await shape('new1'), [1, 3, 2, 3, 2, 4, 1, 4]);
  assert.equal(await text('error'), '');
  await push('run');
  await p.until('!playing');
  assert(await p.do('run.blocks.length === 3 && rows(run.frames.at(-1), "v").at(-1)[3] < -0.5'));
  await press('R');
  await clickAt(1.5, 3.5);
  await press('Delete');
  assert.equal(await model(), before);
  await type('#gallery', 'arch.model');
  const arch = await model(), row = arch.split('\n').findIndex(l => l.includes('block v$i')) + 1;
  await clickAt(0, 10);
  await press('Delete');
  assert(await p.do(`hands.said === 'block v8 cannot be deleted: line ${row} is in \`repeat\`'`));
  assert.equal(await model(), arch);
}

/* What a person has written is there after a choice and a reload; files come in. */
async function checkOwn() {
  const own = read(`${models}column.model`).replace(/^title.*/m, 'title My own');
  await type('#gallery', 'column.model');
  await type('#text', own, 'input');
  await p.until('document.title.startsWith("My own")');
  await p.until('is("gallery").value === "column.model (own)"');
  await type('#gallery', 'arch.model');
  await type('#gallery', 'column.model (own)');
  assert.equal(await model(), own);
  await p.go(url);
  assert.equal(await model(), own);
  fs.writeFileSync(`${folder}/my.msh`, read(`${models}dam.msh`));
  fs.writeFileSync(`${folder}/my.model`, read(`${models}dam.model`).replace('dam.msh', 'my.msh'));
  const { root } = await p.send('DOM.getDocument');
  const { nodeId } = await p.send('DOM.querySelector', { nodeId: root.nodeId, selector: '#open' });
  await p.send('DOM.setFileInputFiles', { nodeId, files: ['my.model', 'my.msh'].map(f =>
    path.resolve(folder, f)) });
  await p.until('is("gallery").value === "my.model (own)"');
  assert.equal(await text('error'), '');
  assert.equal(await runAll(), runBBM(`${folder}/my.model`).said);
  await type('#text', 'static\nblock a rock 0 0\n', 'input');
  await p.until('document.getElementById("error").innerText');
  assert.match(await text('form'), /^block NAME MATERIAL X1 Y1/);
}

(async () => {
  checkFile();
  await checkBits();
  checkHand();
  p = await open(url, folder);
  for (const check of [checkRuns, checkCracks, checkSliderAndLink, checkClicks, checkRows,
      checkLarge, checkErrors, checkExercises, checkPull, checkEdit, checkDraw, checkOwn,
      checkPhone, checkKeys])
    await check();
  assert.deepEqual(p.errors, []);
  assert(p.requests.every(r => r.split('#')[0] === url), `${p.requests}`);
  p.close();
  console.log('the page computes and says what ./bbm does');
})().catch(e => { console.log(e); process.exit(1); });
