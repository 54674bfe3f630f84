/* check_page.js - out/bbm.html in node and in headless Chromium, beside ./bbm:
 *     node tests/check_page.js BBM PAGE_NATIVE FOLDER
 *
 * A picture of each state of the page is left in the folder. */
'use strict';
const assert = require('assert'), fs = require('fs'), path = require('path'), vm = require('vm');
const { spawnSync } = require('child_process'), { open } = require('./chromium.js');
const [bbm, native, folder] = process.argv.slice(2), url = `file://${path.resolve('out/bbm.html')}`;
const read = name => fs.readFileSync(name, 'utf8'), html = read('out/bbm.html'),
  models = 'cases/models/';
const embedded = name => Buffer.from(html.split(`data-file="${name}">`)[1].split('<')[0], 'base64');
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
  assert(html.length < 600e3, `${html.length} bytes`);
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

/* ------------------------------------------------------------------------ in the browser */

let p;
const text = id => p.do(`document.getElementById('${id}').innerText`);
const push = id => p.do(`document.getElementById('${id}').click()`);
const type = (id, value, event = 'change') => p.do(`(e => { e.value = ${JSON.stringify(value)};
  e.dispatchEvent(new Event('${event}')); })(document.querySelector('${id}'))`);
/* The rows of a table of the page, by what stands first. */
const cells = id => p.do(`Object.fromEntries([...document.getElementById('${id}').rows].map(r =>
  [r.cells[0].innerText, [...r.cells].slice(1).map(c => c.innerText)]))`);

async function clickAt(X, Y) {
  const [x, y] = await p.do(`(r => { const q = findScale(r.width, r.height).to(${X}, ${Y});
    return [r.x + q[0], r.y + q[1]]; })(document.getElementById('view').getBoundingClientRect())`);
  for (const kind of ['mousePressed', 'mouseReleased'])
    await p.send('Input.dispatchMouseEvent', { type: kind, x, y, button: 'left', buttons: 1,
      clickCount: 1 });
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

async function checkSliderAndLink() {
  const { said } = runBBM(`${models}incline.model`, '-d', 'phi=31');
  assert.match(said, /NOT MET$/);
  await runAll('incline.model');
  await type('#lets input[type=range]', '31', 'input');
  assert.equal(await runAll(null, null), said);
  await push('link');
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
    6.6: ['corner v', '-0.4', /NOT MET$/], 8.2: ['tip v', '-8.9e-3', /ok$/] };
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
    await p.do('document.querySelector("#exercise button").click()');
    assert.match(await runAll(null, null), said);
    await p.shot(`exercise-${number}`);
  }
}

async function checkKeys() {
  const press = async key => {
    await p.send('Input.dispatchKeyEvent', { type: 'keyDown', key, text: key });
    await p.until('!playing');
  };
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

(async () => {
  checkFile();
  await checkBits();
  p = await open(url, folder);
  for (const check of [checkRuns, checkSliderAndLink, checkClicks, checkRows, checkLarge,
      checkErrors, checkExercises, checkKeys])
    await check();
  assert.deepEqual(p.errors, []);
  assert(p.requests.every(r => r.split('#')[0] === url), `${p.requests}`);
  p.close();
  console.log('the page computes and says what ./bbm does');
})().catch(e => { console.log(e); process.exit(1); });
