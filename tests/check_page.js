/* check_page.js - out/bbm.html in node and in headless Chromium, beside ./bbm:
 *     node tests/check_page.js BBM PAGE_NATIVE FOLDER
 *
 * A picture of each state of the page is left in the folder. */
'use strict';
const assert = require('assert'), fs = require('fs'), path = require('path'), vm = require('vm');
const { spawnSync } = require('child_process');
const [bbm, native, folder] = process.argv.slice(2), url = `file://${path.resolve('out/bbm.html')}`;
const html = fs.readFileSync('out/bbm.html', 'utf8'), models = 'cases/models/';
const embedded = name => Buffer.from(html.split(`data-file="${name}">`)[1].split('<')[0], 'base64');
const near = (a, b, what) => assert(Math.abs(a - b) <= 1e-5 * Math.abs(b) + 1e-12, `${what}: ${a}, expected ${b}`);

/* What ./bbm says of a model, and a row of a table that it writes, the last one or one that is wanted. */
function runBBM(file, ...options) {
  const r = spawnSync(bbm, [file, '-o', `${folder}/bbm`, ...options], { encoding: 'utf8' });
  return { said: r.stdout.split('\n').filter(l => l.startsWith('expected')).join('\n'), error: r.stderr.trim().split('\n').at(-1) };
}

function table(name, wanted) {
  const [head, ...rows] = fs.readFileSync(`${folder}/bbm/${name}`, 'utf8').trim().split('\n').map(l => l.split(','));
  return rows.map(r => Object.fromEntries(head.map((h, k) => [h, r[k]]))).findLast(wanted);
}

function checkFile() {
  assert(html.length < 600e3, `${html.length} bytes`);
  const text = html.replace(/data-file="[^"]*">[^<]*/g, '');
  assert(!/\beval\(|new Function|https?:|innerHTML|outerHTML|insertAdjacent|document\.write/.test(text));
  assert(text.includes("default-src 'none'"));
}

/* The same bits as with musl, whose libm is that of WASI. */
async function checkBits() {
  for (const part of ['wasi', 'model'])
    vm.runInThisContext(fs.readFileSync(`page/${part}.js`, 'utf8'));
  const wasm = embedded('bbm.wasm'), asked = WebAssembly.Module.imports(new WebAssembly.Module(wasm)).map(i => i.name);
  assert.deepEqual(Object.keys(vm.runInThisContext('wasi')(new Map())).sort(), asked.sort());
  await vm.runInThisContext('startLibrary')(wasm);
  vm.runInThisContext('files').set('dam.msh', embedded('dam.msh').toString());
  for (const name of ['arch', 'incline', 'dam', 'wall', 'dominoes']) {
    const text = embedded(`${name}.model`).toString();
    assert.equal(text, fs.readFileSync(`${models}${name}.model`, 'utf8'));
    assert.equal(vm.runInThisContext('loadModel')(`${name}.model`, text, ''), '');
    while (vm.runInThisContext('stepModel')());
    const v = new BigUint64Array(vm.runInThisContext("numbersOf('v')").buffer);
    const expected = spawnSync(native, [`${models}${name}.model`], { encoding: 'utf8', maxBuffer: 1e8 }).stdout;
    assert(v.length > 0 && [...v].map(b => `${b.toString(16)}\n`).join('') === expected, `${name}: other bits`);
  }
}

/* ------------------------------------------------------------------------ in the browser */

let p;
const text = id => p.do(`document.getElementById('${id}').innerText`);
const push = id => p.do(`document.getElementById('${id}').click()`);
const type = (id, value, event) => p.do(`(e => { e.value = ${JSON.stringify(value)};
  e.dispatchEvent(new Event('${event}')); })(document.querySelector('${id}'))`);
/* The rows of a table of the page, by what stands first. */
const rows = id => p.do(`Object.fromEntries([...document.getElementById('${id}').rows].map(r =>
  [r.cells[0].innerText, [...r.cells].slice(1).map(c => c.innerText)]))`);

async function clickAt(X, Y) {
  const [x, y] = await p.do(`(r => { const q = findScale(r.width, r.height).to(${X}, ${Y});
    return [r.x + q[0], r.y + q[1]]; })(document.getElementById('view').getBoundingClientRect())`);
  for (const type of ['mousePressed', 'mouseReleased'])
    await p.send('Input.dispatchMouseEvent', { type, x, y, button: 'left', buttons: 1, clickCount: 1 });
}

async function runAll(model) {
  if (model)
    await type('#gallery', model, 'change');
  await push('run');
  await p.until('!playing && run.state > 0');
  return text('expected');
}

async function checkRuns() {
  for (const name of ['arch', 'incline', 'dam', 'exp1', 'wall']) {
    const { said } = runBBM(`${models}${name}.model`), sum = table('summary.csv', () => true);
    assert.equal(await runAll(`${name}.model`), said);
    assert.match(await text('say'), RegExp(`^step ${sum.step} of`));
    const facts = await rows('facts');
    assert.equal(facts['open-close passes'][0], sum.open_close);
    assert.equal(facts['contacts closed'][0], sum.contacts);
    await p.shot(name);
  }
}

async function checkSlider() {
  const { said } = runBBM(`${models}incline.model`, '-d', 'phi=31');
  await runAll('incline.model');
  await type('#lets input[type=range]', '31', 'input');
  await p.until('!playing && run.state > 0');
  assert.equal(await text('expected'), said);
  assert.match(said, /NOT MET$/);
  await push('link');
  await p.go(await p.do('location.href'));
  assert.equal(await runAll(), said);
  await type('#when', '40', 'input');
  assert.match(await text('say'), /^step 40 of 100\s+t = 0.4 s/);
  await p.shot('slider');
}

async function checkClicks() {
  runBBM(`${models}incline.model`);
  await runAll('incline.model');
  const e = table('elements.csv', r => r.block === 'block'), c = table('contacts.csv', () => true);
  await clickAt(+e.x + +e.u, +e.y + +e.v);
  assert.match(await text('who'), RegExp(`^element ${e.element} of block block`));
  let about = await rows('about');
  near(about.sxx[0], e.sxx, 'sxx');
  near(about['u0 [m]'][1], e.vx, 'vx');
  await p.shot('element');
  await clickAt(c.x, c.y);
  about = await rows('about');
  assert.equal(about.state[0], c.state);
  near(about.N[0], c.normal, 'N');
  near(about['d_n'][0], c.gap, 'd_n');
  await p.shot('contact');
  await type('#when', '1', 'input');
  await push('inside');
  for (const became of ['OPEN', 'LOCK', 'SLIDE']) {
    await push('after');
    assert.match(await text('changes'), RegExp(became));
  }
  await p.shot('inside');
  await push('inside');
}

async function checkErrors() {
  const wrong = fs.readFileSync(`${models}incline.model`, 'utf8').replace('gravity', 'grav<img src=x onerror=hacked=1>');
  fs.writeFileSync(`${folder}/incline.model`, wrong);
  const said = runBBM(`${folder}/incline.model`).error.replace(`${folder}/`, ''), line = said.split(':')[1];
  await type('#gallery', 'incline.model', 'change');
  await type('#text', wrong, 'input');
  await p.until('!document.getElementById("error").hidden');
  assert((await text('error')).startsWith(said), `${await text('error')}, expected ${said}`);
  assert.equal((await p.do('document.querySelector("#lines .bad").innerText')).trim(), line);
  await p.shot('error');
  await push('step');                           /* of the model before, which is alive */
  assert.match(await text('say'), /^step 1 of 100/);
  const falls = fs.readFileSync(`${models}incline.model`, 'utf8').replace(/^dynamic.*/m, 'static').replace(/^title.*/m,
    'title </script><script>hacked=1</script><img src=x onerror=hacked=1>');
  fs.writeFileSync(`${folder}/incline.model`, falls);
  await type('#text', falls, 'input');
  await p.until('document.getElementById("error").hidden');
  await runAll();
  assert.equal(await text('error'), runBBM(`${folder}/incline.model`).error.replace(`${folder}/`, ''));
  await push('link');
  await p.go(await p.do('location.href'));
  assert.equal(await p.do('document.getElementById("text").value'), falls);
  assert(!await p.do('typeof hacked !== "undefined" || document.querySelector("img") !== null'));
}

async function checkExercise() {
  const predict = fs.readFileSync('doc/exercises/README.md', 'utf8').match(/^\| \[\d+\].*\| predict \|/gm).map(l => l.slice(3, 5));
  assert.deepEqual(await p.do('Object.keys(EXERCISES).sort()'), predict);
  for (const number of predict) {
    await type('#gallery', number, 'change');
    await push('run');
    await push('step');
    assert(await p.do('run.rows.length <= 1 && !playing && task !== null'));
    await type('.ask input', { '01': '-2.1239', '02': '0.005', '03': '-8.9e-3' }[number], 'change');
    await push('predict');
    await p.until('!playing && run.state > 0');
    assert.match(await text('expected'), number === '03' ? /NOT MET$/ : /ok$/);
    await p.shot(`exercise-${number}`);
  }
}

async function checkLooks() {
  await p.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: 'dark' }] });
  await p.go(`${url}#model=dominoes.model`);
  for (const key of [' ', ' '])
    await p.send('Input.dispatchKeyEvent', { type: 'keyDown', key, text: key });
  assert.match(await text('say'), /^step 1 of 5000/);
  await p.shot('dark');
  await p.send('Input.dispatchKeyEvent', { type: 'keyDown', key: 'f', text: 'f' });
  assert(await p.do('document.body.classList.contains("full")'));
  await p.shot('full');
}

(async () => {
  checkFile();
  await checkBits();
  p = await require('./chromium.js').open(url, folder);
  for (const check of [checkRuns, checkSlider, checkClicks, checkErrors, checkExercise, checkLooks])
    await check();
  assert.deepEqual(p.errors, []);
  assert(p.requests.every(r => r.split('#')[0] === url), `${p.requests}`);
  await p.close();
  console.log('the page is what ./bbm computes');
})().catch(e => { console.log(e); process.exit(1); });
