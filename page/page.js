/* page.js - what a person does: writes a model, moves sliders, runs, looks. */
'use strict';

const is = id => document.getElementById(id);
const WORK = 12;                                /* ms of steps between two pictures */
let playing = false, at = -1, lookAt = 0;       /* at: the frame that is shown, -1: the last one */
let picked = { element: -1, contact: null }, given = {}, task = null, linked = '';

const shown = () => run.frames.at(at);
const isPressed = id => is(id).getAttribute('aria-pressed') === 'true';

/* ------------------------------------------------------------------------ the model */

/* The line of a message FILE:LINE: ... is marked; the text is the reader's own. */
function showError(said) {
  const line = +(said.match(/^[^:]*:(\d+):/) ?? [])[1] || 0, area = is('text');
  is('error').hidden = !said;
  is('error').textContent = said;
  is('lines').replaceChildren(...area.value.split('\n').map((_, k) =>
    make('span', { className: k + 1 === line ? 'bad' : '' }, `${k + 1} \n`)));
  is('bar').hidden = !line;
  is('bar').dataset.line = line;
  if (line && Math.abs(20 * line - area.scrollTop - 60) > area.clientHeight - 120)
    area.scrollTop = 20 * line - 60;
  scrollLines();
}

function scrollLines() {
  is('lines').scrollTop = is('text').scrollTop;
  is('bar').style.top = `${6 + 20 * (is('bar').dataset.line - 1) - is('text').scrollTop}px`;
}

/* Each `let` with a number; its range is in a comment `# 0 .. 60`, or from 0 to twice its size. */
function findLets(text) {
  const number = '[-+]?(?:\\d+\\.?\\d*|\\.\\d+)(?:[eE][-+]?\\d+)?';
  const form = RegExp(`^[ \\t]*let[ \\t]+(\\S+)[ \\t]+(${number})[ \\t]*(#.*)?$`, 'gm');
  return [...text.matchAll(form)].map(([, name, word, comment]) => {
    const range = comment?.match(RegExp(`(${number})\\s*\\.\\.\\s*(${number})`)), value = +word;
    const [low, high] = range ? [+range[1], +range[2]]
      : value === 0 ? [-1, 1] : [Math.min(0, 2 * value), Math.max(0, 2 * value)];
    const whole = [value, low, high].every(Number.isInteger) && high - low >= 20;
    return { name, value, low, high, step: whole ? 1 : (high - low) / 200 };
  });
}

function makeSliders() {
  const lets = findLets(is('text').value);
  is('lets').replaceChildren(...lets.map(({ name, value, low, high, step }) => {
    const now = given[name] ?? value, word = make('input', { value: now, ariaLabel: name });
    const slide = make('input', { type: 'range', min: low, max: high, step, value: now,
      ariaLabel: name });
    const set = other => event => {
      given[name] = other.value = event.target.value;
      const again = playing || run?.rows.length > 1;
      if (load() && again)
        play(true);
    };
    slide.oninput = set(word);
    word.onchange = set(slide);
    return make('label', {}, make('span', {}, name), slide, word);
  }));
}

/* Reads the text with the numbers of the sliders; the model that was there stays if it is wrong. */
function load() {
  const lets = findLets(is('text').value).filter(l => l.name in given)
    .map(l => `${l.name}=${given[l.name]}`);
  play(false);
  const said = loadModel(is('gallery').dataset.name, is('text').value, lets.join('\n'));
  showError(said && run ? `${said} (what is shown is the model before)` : said);
  if (said)
    return false;
  findShape();
  at = -1;
  lookAt = 0;
  picked = { element: -1, contact: null };
  is('magnify').dataset.own = '';
  document.title = `${run.title} - bbm`;
  is('element').max = count(run.mesh, 'a') - 1;
  show();
  return true;
}

function setTask(exercise) {
  task = exercise;
  document.body.classList.toggle('asking', !!task);
}

function choose(name, text = files.get('gallery/' + name) ?? `# there is no ${name} here`) {
  is('gallery').dataset.name = is('gallery').value = name;
  is('text').value = text;
  is('text').scrollTop = 0;
  given = {};
  setTask(null);
  is('exercise').hidden = true;
  makeSliders();
  return load();
}

/* An exercise shows a case, and runs when what will come out has been written down. */
function chooseExercise(number, words = EXERCISES[number].cases[0]) {
  const exercise = EXERCISES[number];
  const cases = exercise.cases.map(c => new Option(c, c, c === words, c === words));
  choose(exercise.model, modelOf(exercise, words, ''));
  is('gallery').value = number;
  setTask(exercise);
  is('exercise').hidden = false;
  is('exercise').replaceChildren(make('b', {}, `Exercise ${number}: ${exercise.title}`),
    make('p', {}, exercise.task), make('p', {}, exercise.equation),
    make('select', { ariaLabel: 'case', onchange: e => chooseExercise(number, e.target.value) },
      ...cases),
    askFor(exercise, sentence => {
      is('text').value = modelOf(exercise, words, sentence);
      setTask(null);
      if (load())
        play(true);
      else
        setTask(exercise);
    }));
}

/* ------------------------------------------------------------------------ the run */

function mayRun() {
  if (task)
    is('exercise').querySelector('input').focus();
  return !task && run?.state === 0;
}

function play(on) {
  const was = playing;
  playing = on && mayRun();
  is('run').textContent = playing ? 'Pause' : 'Run';
  if (playing && !was)
    setTimeout(work, 4);
}

function work() {
  const start = performance.now();
  at = -1;
  while (playing && performance.now() - start < WORK)
    if (!stepModel())
      play(false);
  show();
  if (playing)
    setTimeout(work, 4);
}

/* One step; settling counts as one. */
function oneStep() {
  play(false);
  if (!mayRun())
    return;
  do
    stepModel();
  while (!run.state && !run.frames.at(-1).begun);
  goTo(run.frames.length);
}

function where(f) {
  return !f.begun ? `settling ${f.settle - f.settling} of ${f.settle}` :
    `step ${f.step} of ${f.steps}${f.dynamic ? `  t = ${format(f.t)} s` : ''}` +
    (f.failed ? '  failed' : '');
}

function show() {
  const f = shown(), isOver = run.state === 1 && at < 0;
  if (is('magnify').dataset.own !== '1')
    is('magnify').value = view.magnify = f.dynamic ? 1 : findMagnification(f);
  is('when').max = run.frames.length - 1;
  is('when').value = at < 0 ? run.frames.length - 1 : at;
  is('say').textContent = where(f);
  if (run.failure)
    showError(`${run.name}: ${run.failure}`);
  is('expected').replaceChildren(...warnings.split('\n').filter(line => line).map(line =>
    make('li', {}, line)), ...expectations(f).map(x => make('li',
    { className: !isOver ? '' : x.met ? 'ok' : 'missed' },
      `${isOver ? 'expected' : 'so far'}: ${x.said}`)));
  drawPicture(f, picked, isPressed('inside') ? tellLook(f, lookAt, pickContact) : null);
  tell(f, picked);
  if (!isPressed('inside'))
    drawGraphs(f);
  if (!playing)
    drawPattern(picked);
}

/* ------------------------------------------------------------------------ hands */

function pick(element, contact) {
  picked = { element, contact };
  show();
}

const pickContact = contact => pick(-1, contact);

function pickClosed(k) {
  const closed = times(count(shown().c, 'c'), i => row(shown().c, 'c', i)).filter(c => c[2]);
  pickContact(closed[k] ? [closed[k][0], closed[k][1]] : null);
}

function goTo(frame) {
  play(false);
  at = frame >= run.frames.length - 1 ? -1 : Math.max(0, frame);
  lookAt = 0;
  show();
}

function moveLook(by) {
  lookAt = Math.max(0, Math.min(looksOf(shown()).length - 1, lookAt + by));
  show();
}

function press(id, on = !isPressed(id)) {
  is(id).setAttribute('aria-pressed', on);
  document.body.classList.toggle(id, on);
  show();
}

function setTheme(dark) {
  document.documentElement.dataset.theme = dark ? 'dark' : 'light';
  is('theme').textContent = dark ? 'Light' : 'Dark';
}

function setView(changes) {
  Object.assign(view, changes);
  show();
}

const zoom = f => setView({ zoom: f * view.zoom, x: f * view.x, y: f * view.y });

/* The link names a model of the gallery, or has its text; and what the sliders say. */
function makeLink() {
  const { name } = is('gallery').dataset, link = new URLSearchParams({ model: name });
  if (is('text').value !== files.get('gallery/' + name))
    link.set('text', is('text').value);
  for (const let_ in given)
    link.append('let', `${let_}=${given[let_]}`);
  location.hash = linked = '#' + link;
  navigator.clipboard?.writeText(location.href).catch(() => {});
}

function followLink() {
  const link = new URLSearchParams(location.hash.slice(1));
  if (location.hash && location.hash === linked)
    return;
  if (link.get('exercise') in EXERCISES) {
    chooseExercise(link.get('exercise'));
    return;
  }
  choose(link.get('model') ?? 'arch.model', link.get('text') ?? undefined);
  given = Object.fromEntries(link.getAll('let').map(l => l.split('=')));
  makeSliders();
  load();
  if (link.has('full'))
    press('full', true);
}

const KEYS = { ' ': oneStep, Enter: () => play(!playing), r: load,
  0: () => setView({ zoom: 1, x: 0, y: 0 }), '+': () => zoom(1.25), '-': () => zoom(0.8),
  f: () => press('full'), Escape: () => press('full', false),
  l: () => press('inside'), '[': () => moveLook(-1), ']': () => moveLook(1),
  ArrowLeft: () => goTo((at < 0 ? run.frames.length - 1 : at) - 1),
  ArrowRight: () => at >= 0 && goTo(at + 1) };
const CLICKS = { reset: load, step: oneStep, run: KEYS.Enter, inside: KEYS.l, full: KEYS.f,
  link: makeLink,
  theme: () => { setTheme(document.documentElement.dataset.theme !== 'dark'); show(); },
  before: KEYS['['], after: KEYS[']'] };
const CHANGES = { gallery: name => (name in EXERCISES ? chooseExercise : choose)(name),
  colour: colour => setView({ colour }), element: k => pick(+k, null), contact: k => pickClosed(+k),
  magnify: word => {
    is('magnify').dataset.own = +word > 0 ? '1' : '';
    setView({ magnify: +word });
  } };

function pressKey(event) {
  const { tagName } = event.target;
  const isWritten = /TEXTAREA|INPUT|SELECT/.test(tagName) && event.key !== 'Escape';
  if (isWritten || !(event.key in KEYS) || event.ctrlKey || event.metaKey ||
      (tagName === 'BUTTON' && /^( |Enter)$/.test(event.key)))
    return;
  event.preventDefault();
  KEYS[event.key]();
}

/* Drags the picture, or picks what a click is at. */
function listenToPicture(canvas) {
  let from = null, moved = false;
  canvas.onpointerdown = e => {
    from = [e.offsetX - view.x, e.offsetY - view.y];
    moved = false;
    canvas.setPointerCapture(e.pointerId);
  };
  canvas.onpointermove = e => {
    const [x, y] = from ? [e.offsetX - from[0], e.offsetY - from[1]] : [view.x, view.y];
    moved ||= Math.hypot(x - view.x, y - view.y) > 3;
    if (from && moved)
      setView({ x, y });
  };
  canvas.onpointerup = e => {
    const found = moved ? picked : findAt(shown(), e.offsetX, e.offsetY);
    from = null;
    pick(found.element, found.contact);
  };
  canvas.onwheel = e => { e.preventDefault(); zoom(Math.exp(-e.deltaY / 500)); };
}

function listen() {
  let later;
  for (const id in CLICKS)
    is(id).onclick = () => CLICKS[id]();
  for (const id in CHANGES)
    is(id).onchange = e => CHANGES[id](e.target.value);
  is('forces').onchange = e => setView({ forces: e.target.checked });
  is('when').oninput = e => goTo(+e.target.value);
  is('text').oninput = () => {
    clearTimeout(later);
    later = setTimeout(() => { makeSliders(); load(); }, 400);
  };
  is('text').onscroll = scrollLines;
  listenToPicture(is('view'));
  document.onkeydown = pressKey;
  onresize = show;
  onhashchange = followLink;
}

async function start() {
  const models = [], bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0));
  onerror = (event, file, line, column, error) =>
    showError(`The page has failed: ${error ?? event}`);
  onunhandledrejection = e => showError(`The page has failed: ${e.reason}`);
  setTheme(matchMedia('(prefers-color-scheme: dark)').matches);
  for (const { dataset: { file }, textContent } of document.querySelectorAll('[data-file]')) {
    const text = file === 'bbm.wasm' ? '' : new TextDecoder().decode(bytes(textContent));
    files.set(file, text).set('gallery/' + file, text);
    if (file.endsWith('.model'))
      models.push(new Option(file.replace('.model', ''), file));
  }
  is('gallery').append(make('optgroup', { label: 'models' }, ...models), make('optgroup',
    { label: 'exercises: predict' }, ...Object.entries(EXERCISES).map(([n, e]) =>
      new Option(`${n} ${e.title}`, n))));
  await startLibrary(bytes(document.querySelector('[data-file="bbm.wasm"]').textContent));
  listen();
  followLink();
}

start();
