/* page.js - what a person does: writes a model, moves sliders, runs, looks. */
'use strict';

const is = id => document.getElementById(id);
const FRAME_TIME = 12;                          /* ms of steps in each frame of the screen */
let playing = false, at = -1, lookAt = 0;       /* at: the frame that is shown, -1: the last one */
let picked = { element: -1, contact: null }, given = {}, task = null, linked = '';

const shown = () => run.frames.at(at);
const isLooking = () => !is('looks').hidden;

/* ------------------------------------------------------------------------ the model */

/* The line of a message FILE:LINE: ... is marked; the text is the reader's own. */
function showError(said) {
  const line = +(said.match(/^[^:]*:(\d+):/) ?? [])[1] || 0, lines = is('text').value.split('\n');
  is('error').hidden = !said;
  is('error').textContent = said;
  is('lines').replaceChildren(...lines.map((_, k) =>
    make('span', { className: k + 1 === line ? 'bad' : '' }, `${k + 1} \n`)));
  is('bar').hidden = !line;
  is('bar').dataset.line = line;
  if (line && Math.abs(20 * line - is('text').scrollTop - 60) > is('text').clientHeight - 120)
    is('text').scrollTop = 20 * line - 60;
  scrollLines();
}

function scrollLines() {
  is('lines').scrollTop = is('text').scrollTop;
  is('bar').style.top = `${6 + 20 * (is('bar').dataset.line - 1) - is('text').scrollTop}px`;
}

/* Each `let` with a number; its range is in a comment `# 0 .. 60`, or goes from 0 to twice its size. */
function findLets(text) {
  const number = '[-+]?(?:\\d+\\.?\\d*|\\.\\d+)(?:[eE][-+]?\\d+)?', found = [];
  const form = RegExp(`^[ \\t]*let[ \\t]+(\\S+)[ \\t]+(${number})[ \\t]*(#.*)?$`, 'gm');
  for (const [, name, word, comment] of text.matchAll(form)) {
    const range = comment?.match(RegExp(`(${number})\\s*\\.\\.\\s*(${number})`)), value = +word;
    const [low, high] = range ? [+range[1], +range[2]]
      : value === 0 ? [-1, 1] : [Math.min(0, 2 * value), Math.max(0, 2 * value)];
    const whole = [value, low, high].every(Number.isInteger) && high - low >= 20;
    found.push({ name, value, low, high, step: whole ? 1 : (high - low) / 200 });
  }
  return found;
}

function makeSliders() {
  is('lets').replaceChildren(...findLets(is('text').value).map(({ name, value, low, high, step }) => {
    const now = given[name] ?? value, slide = make('input', { type: 'range', min: low, max: high, step,
      value: now, ariaLabel: name }), word = make('input', { value: now, ariaLabel: name });
    const set = other => x => {
      given[name] = other.value = x.target.value;
      const again = playing || run?.rows.length > 1;
      if (load() && again)
        play(true);
    };
    slide.oninput = set(word);
    word.onchange = set(slide);
    return make('label', {}, make('span', {}, name), slide, word);
  }));
}

const nameOfModel = () => is('gallery').dataset.name ?? 'my.model';

/* Reads the text with the numbers of the sliders; the model that was there stays if it is wrong. */
function load() {
  const lets = findLets(is('text').value).filter(l => l.name in given)
    .map(l => `${l.name}=${given[l.name]}`).join('\n');
  play(false);
  const said = loadModel(nameOfModel(), is('text').value, lets);
  showError(said && run ? `${said} (what is shown is the model before)` : said);
  if (said)
    return false;
  shape();
  at = -1;
  lookAt = 0;
  picked = { element: -1, contact: null };
  view.magnify = run.frames[0].dynamic ? 1 : 0;
  document.title = run.title ? `${run.title} - bbm` : 'bbm';
  is('element').max = count(run.mesh, 'a') - 1;
  show();
  return true;
}

function choose(name, text = files.get('gallery/' + name)) {
  is('gallery').dataset.name = name;
  is('gallery').value = name;
  is('text').value = text ?? '';
  is('text').scrollTop = 0;
  given = {};
  task = null;
  is('exercise').hidden = true;
  document.body.classList.remove('asking');
  makeSliders();
  return load();
}

/* An exercise shows a case, and runs when what will come out has been written down. */
function chooseExercise(number, words = EXERCISES[number].cases[0]) {
  const exercise = EXERCISES[number], box = is('exercise');
  choose(exercise.model, modelOf(exercise, words, ''));
  is('gallery').value = number;
  task = exercise;
  document.body.classList.add('asking');
  const which = make('select', { id: 'case', ariaLabel: 'case',
    onchange: () => chooseExercise(number, which.value) }, ...exercise.cases.map(c => new Option(c, c)));
  which.value = words;
  box.replaceChildren(make('b', {}, `Exercise ${number}: ${exercise.title}`), make('p', {}, exercise.task),
    make('p', {}, exercise.equation), which, askFor(exercise, sentence => {
      is('text').value = modelOf(exercise, words, sentence);
      task = null;
      document.body.classList.remove('asking');
      if (load())
        play(true);
      else
        task = exercise;
    }));
  box.hidden = false;
  show();
}

/* ------------------------------------------------------------------------ the run */

function mayRun() {
  if (task)
    is('exercise').querySelector('input').focus();
  return !task && run && run.state === 0;
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
  while (playing && performance.now() - start < FRAME_TIME)
    if (!stepModel())
      play(false);
  show();
  if (playing)
    setTimeout(work, 4);
}

function oneStep() {
  play(false);
  if (!mayRun())
    return;
  do
    stepModel();                                /* settling, and its end, count as one */
  while (!run.state && !run.frames.at(-1).begun);
  at = -1;
  lookAt = 0;
  show();
}

function where(f) {
  if (!f.begun)
    return `settling ${f.settle - f.settling} of ${f.settle}`;
  const time = f.dynamic ? `  t = ${format(f.t)} s` : '';
  return `step ${f.step} of ${f.steps}${time}${f.failed ? '  failed' : ''}`;
}

function show() {
  const f = shown(), last = run.frames.length - 1;
  if (!(view.magnify > 0) || is('magnify').dataset.own !== '1' && !f.dynamic)
    view.magnify = findMagnification(f);
  is('magnify').value = view.magnify;
  is('when').max = last;
  is('when').value = at < 0 ? last : at;
  is('say').textContent = where(f);
  if (run.failure)
    showError(`${run.name}: ${run.failure}`);
  is('expected').replaceChildren(...expectations(f).map(x => make('li', { className:
    run.state !== 1 || at >= 0 ? '' : x.met ? 'ok' : 'missed' },
    `${run.state === 1 && at < 0 ? 'expected' : 'so far'}: ${x.said}`)));
  const look = isLooking() ? tellLook(f, lookAt, pickContact) : null;
  drawPicture(f, picked, look);
  tell(f, picked);
  if (isLooking())
    return;
  drawGraphs(f);
  if (!playing)
    drawPattern(picked);
}

function pickContact(contact) {
  picked = { element: -1, contact };
  show();
}

/* ------------------------------------------------------------------------ hands */

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

function press(id, on) {
  is(id).setAttribute('aria-pressed', on);
  if (id === 'full')
    document.body.classList.toggle('full', on);
  else {
    document.body.classList.toggle('looking', on);
    is('looks').hidden = !on;
    is('graphs').hidden = on;
  }
  show();
}

const isPressed = id => is(id).getAttribute('aria-pressed') === 'true';

function setTheme(dark) {
  document.documentElement.dataset.theme = dark ? 'dark' : 'light';
  is('theme').textContent = dark ? 'Light' : 'Dark';
}

function zoom(factor) {
  view.zoom *= factor;
  view.x *= factor;
  view.y *= factor;
  show();
}

/* The link names a model of the gallery, or has its text; and what the sliders say. */
function makeLink() {
  const name = nameOfModel(), link = new URLSearchParams({ model: name });
  if (is('text').value !== files.get('gallery/' + name))
    link.set('text', is('text').value);
  for (const name in given)
    link.append('let', `${name}=${given[name]}`);
  location.hash = linked = '#' + link;
  navigator.clipboard?.writeText(location.href).catch(() => {});
}

function followLink() {
  const link = new URLSearchParams(location.hash.slice(1));
  if (location.hash && location.hash === linked)
    return;
  if (link.get('exercise') in EXERCISES)
    return chooseExercise(link.get('exercise'));
  const name = link.get('model') ?? 'arch.model';
  choose(name, link.get('text') ?? files.get('gallery/' + name) ?? `# no model ${name} here`);
  given = Object.fromEntries(link.getAll('let').map(l => [l.split('=')[0], l.slice(l.indexOf('=') + 1)]));
  makeSliders();
  if (Object.keys(given).length)
    load();
  if (link.has('full'))
    press('full', true);
}

const KEYS = { ' ': () => oneStep(), Enter: () => play(!playing), r: () => load(), 0: () => {
  Object.assign(view, { zoom: 1, x: 0, y: 0 });
  show();
}, '+': () => zoom(1.25), '-': () => zoom(0.8), f: () => press('full', !isPressed('full')),
Escape: () => press('full', false), l: () => press('inside', !isPressed('inside')),
'[': () => moveLook(-1), ']': () => moveLook(1), ArrowLeft: () => goTo((at < 0 ? run.frames.length - 1 : at) - 1),
ArrowRight: () => at >= 0 && goTo(at + 1) };

document.onkeydown = event => {
  const busy = /TEXTAREA|INPUT|SELECT/.test(event.target.tagName) ||
    (event.target.tagName === 'BUTTON' && /^( |Enter)$/.test(event.key));
  if (busy ? event.key !== 'Escape' : !(event.key in KEYS) || event.ctrlKey || event.metaKey)
    return;
  event.preventDefault();
  KEYS[event.key]();
};

function listen() {
  let later, from = null, moved = false;
  const canvas = is('view'), click = (id, what) => { is(id).onclick = what; };
  is('gallery').onchange = e => (e.target.value in EXERCISES ? chooseExercise : choose)(e.target.value);
  is('text').oninput = () => {
    clearTimeout(later);
    later = setTimeout(() => { makeSliders(); load(); }, 400);
  };
  is('text').onscroll = scrollLines;
  click('reset', load);
  click('step', oneStep);
  click('run', () => play(!playing));
  click('inside', () => press('inside', !isPressed('inside')));
  click('full', () => press('full', !isPressed('full')));
  click('link', makeLink);
  click('theme', () => { setTheme(document.documentElement.dataset.theme !== 'dark'); show(); });
  click('before', () => moveLook(-1));
  click('after', () => moveLook(1));
  is('colour').onchange = e => { view.colour = e.target.value; show(); };
  is('forces').onchange = e => { view.forces = e.target.checked; show(); };
  is('magnify').onchange = e => { view.magnify = +e.target.value; e.target.dataset.own = view.magnify > 0 ? '1' : '';
    show(); };
  is('when').oninput = e => goTo(+e.target.value);
  is('element').onchange = e => { picked = { element: +e.target.value, contact: null }; show(); };
  is('contact').onchange = e => {
    const closed = Array.from({ length: count(shown().c, 'c') }, (_, k) => row(shown().c, 'c', k)).filter(c => c[2]);
    const c = closed[+e.target.value];
    pickContact(c ? [c[0], c[1]] : null);
  };
  canvas.onpointerdown = e => {
    from = [e.offsetX - view.x, e.offsetY - view.y];
    moved = false;
    canvas.setPointerCapture(e.pointerId);
  };
  canvas.onpointermove = e => {
    if (!from || !e.buttons)
      return;
    const [x, y] = [e.offsetX - from[0], e.offsetY - from[1]];
    moved ||= Math.hypot(x - view.x, y - view.y) > 3;
    if (moved)
      Object.assign(view, { x, y }), show();
  };
  canvas.onpointerup = e => {
    if (from && !moved)
      picked = findAt(shown(), e.offsetX, e.offsetY);
    from = null;
    show();
  };
  canvas.onwheel = e => { e.preventDefault(); zoom(Math.exp(-e.deltaY / 500)); };
  onresize = () => show();
  onhashchange = followLink;
  onerror = (event, file, line, column, error) => showError(`The page has failed: ${error ?? event}`);
  onunhandledrejection = e => showError(`The page has failed: ${e.reason}`);
}

async function start() {
  const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0)), models = [];
  onunhandledrejection = e => { is('error').hidden = false; is('error').textContent = e.reason; };
  setTheme(matchMedia('(prefers-color-scheme: dark)').matches);
  for (const { dataset: { file }, textContent } of document.querySelectorAll('[data-file]'))
    if (file !== 'bbm.wasm') {
      const text = new TextDecoder().decode(bytes(textContent));
      files.set(file, text).set('gallery/' + file, text);
      if (file.endsWith('.model'))
        models.push(file);
    }
  is('gallery').append(make('optgroup', { label: 'models' }, ...models.map(m =>
    new Option(m.replace('.model', ''), m))), make('optgroup', { label: 'exercises: predict' },
  ...Object.entries(EXERCISES).map(([n, e]) => new Option(`${n} ${e.title}`, n))));
  await startLibrary(bytes(document.querySelector('[data-file="bbm.wasm"]').textContent));
  listen();
  followLink();
}

start();
