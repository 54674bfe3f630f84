/* page.js - what a person does: writes a model, moves sliders, predicts, runs, looks. */
'use strict';

const is = id => document.getElementById(id);
const WORK = 12, LARGE = 5000;  /* ms of steps between two pictures; unknowns */
const NUMBER = '[-+]?(?:\\d+\\.?\\d*|\\.\\d+)(?:[eE][-+]?\\d+)?';
const EXERCISES = Object.create(null);         /* of the chapters: title, model, text */
let playing = false, turns = 0, task = null, hasPredicted = false;

/* The frame in hand, or the one before that has kept its arrays. */
const shown = () => run.frames.slice(0, view.at < 0 ? undefined : view.at + 1).findLast(f => f.v);

/* ------------------------------------------------------------------------ the model */

/* The line of a message FILE:LINE: ... is marked; the text is the reader's own. */
function showError(said) {
  const bad = said.match(/^[^:]*:(\d+):/)?.[1], lines = is('text').value.split('\n');
  is('error').textContent = said;
  is('text').rows = lines.length;
  is('text').cols = largest(lines.map(l => l.length)) + 2;
  is('lines').replaceChildren(...lines.map((_, k) =>
    make('div', { className: `${k + 1}` === bad ? 'bad' : '' }, `${k + 1}`)));
  document.querySelector('.bad')?.scrollIntoView({ block: 'nearest' });
}

/* A slider for each `let` with a number. Its range is in a comment `# 0 .. 60`, or from 0 to twice
 * the number. What is set goes into the text. */
function makeSliders() {
  const form = RegExp(`^([ \\t]*let[ \\t]+(\\S+)[ \\t]+)(${NUMBER})[ \\t]*` +
    `(?:#.*?(${NUMBER})\\s*\\.\\.\\s*(${NUMBER}).*|#.*)?$`, 'gm');
  fill('lets', [...is('text').value.matchAll(form)].map(([, let_, name, word, from, to]) => {
    const [low, high] = from ? [+from, +to] : +word ? [0, 2 * word].sort((a, b) => a - b) : [-1, 1];
    const isWhole = [+word, low, high].every(Number.isInteger) && high - low >= 6;
    const number = make('input', { value: word, ariaLabel: name });
    const slide = make('input', { type: 'range', min: low, max: high, ariaLabel: name,
      step: isWhole ? 1 : (high - low) / 200, value: word });
    slide.oninput = number.onchange = ({ target: { value } }) => {
      const again = playing || run.frames.length > 1;
      is('text').value = is('text').value.replace(let_ + word, let_ + value);
      word = slide.value = number.value = value;
      if (load() && again)
        play(true);
    };
    return make('label', {}, name, slide, number);
  }));
}

/* Reads the text; the model that was there stays if it is wrong. */
function load() {
  play(false);
  const said = loadModel(task?.model ?? is('gallery').value, is('text').value);
  showError(said && run ? `${said} (what is shown is the model before)` : said);
  if (said)
    return false;
  findShape();
  hasPredicted = false;
  fill('what', run.monitors.flatMap(([name, ...what]) => what.map(axis => `${name} ${axis}`))
    .map(text => new Option(text, text, false, text === is('what').value)));
  document.title = `${textOf('t')} - bbm`;
  setView({ ...NEWEST, ...NONE });
  return true;
}

/* A model of the gallery, or an exercise with its model, without the answers that it comes with. */
function choose(name, text) {
  task = EXERCISES[name];
  text ??= files.get(`gallery/${task?.model ?? name}`) ?? `# there is no ${name} here`;
  is('gallery').value = name;
  is('text').value = task ? text.replace(/^ *(#|expect).*\n/gm, '') : text;
  is('edit').scrollTop = 0;
  Object.assign(view, WHOLE);
  is('exercise').reset();
  is('exercise').hidden = !task;
  fill('task', [make('b', {}, task?.title ?? ''), make('p', {}, task?.text ?? '')]);
  makeSliders();
  load();
}

/* An exercise runs when what will come out has been written down. */
function predict() {
  const [what, number, within] = ['what', 'number', 'within'].map(id => is(id).value);
  is('text').value = is('text').value.replace(/\n*expect .*\n*$/, '') +
    `\n\nexpect ${what} ${number} within ${within}\n`;
  hasPredicted = load();
  play(true);
  return false;
}

/* ------------------------------------------------------------------------ the run */

function mayRun() {
  if (task && !hasPredicted)
    is('number').focus();
  return (!task || hasPredicted) && run?.state === 0;
}

/* Runs or pauses; or takes one step, after those that settle. A picture comes first, so that it is
 * said before what may take long. */
function play(on, once = false) {
  const turn = ++turns, unknowns = run ? 6 * rows(shown(), 'e').length : 0;
  playing = on && mayRun();
  is('run').textContent = playing && !once ? 'Pause' : 'Run';
  if (playing && unknowns > LARGE)
    is('say').textContent = `solving ${unknowns} unknowns`;
  if (playing)
    requestAnimationFrame(() => setTimeout(() => turn === turns && work(once)));
}

function work(once) {
  const start = performance.now();
  let more = true;
  while (more && performance.now() - start < WORK)
    more = stepModel() && !(once && run.frames.at(-1).begun);
  play(more, once);
  setView(NEWEST);
}

function show() {
  const f = shown(), isOver = run.state === 1 && view.at < 0, isInside = is('inside').checked;
  is('when').max = run.frames.length - 1;
  is('when').value = view.at < 0 ? run.frames.length - 1 : view.at;
  is('say').textContent = !f.begun ? `settling ${f.settle - f.settling} of ${f.settle}`
    : `step ${f.step} of ${f.steps}${f.dynamic ? `  t = ${format(f.t)} s` : ''}` +
    (f.failure && '  failed');
  if (f.failure)
    showError(`${run.name}: ${f.failure}`);
  fill('expected', [...warnings.split('\n').filter(word => word).map(word => make('div', {}, word)),
    ...rows(f, 'x').map((x, k) => make('div', { className: !isOver ? '' : x[4] ? 'ok' : 'missed' },
      `${isOver ? 'expected' : 'so far'}: ${f.said[k]}`))]);
  drawPicture(f, isInside && tellLook(f));
  tell(f);
  if (!isInside)
    drawGraphs(f);
  drawPattern();
}

/* ------------------------------------------------------------------------ hands */

function setView(changes) {
  Object.assign(view, changes);
  show();
}

const zoom = f => setView({ zoom: f * view.zoom, x: f * view.x, y: f * view.y });
const pick = (element, contact) =>
  setView({ element: Math.min(element, rows(shown(), 'e').length - 1), contact });
const pickClosed = k => pick(-1, rows(shown(), 'c').filter(c => c[2])[k]);

function goTo(frame) {
  play(false);
  setView({ at: frame >= run.frames.length - 1 ? -1 : Math.max(0, frame), look: 0 });
}

const moveLook = by =>
  setView({ look: Math.max(0, Math.min(looksOf(shown()).length - 1, view.look + by)) });

/* The link has a name of the gallery, and the text. */
function makeLink() {
  const link = new URLSearchParams({ model: is('gallery').value, text: is('text').value });
  history.replaceState(null, '', '#' + link);
  navigator.clipboard?.writeText(location.href).catch(() => {});
}

function followLink() {
  const link = new URLSearchParams(location.hash.slice(1));
  is('full').checked = link.has('full');
  choose(link.get('model') ?? 'arch.model', link.get('text') ?? undefined);
}

/* Of the keys: what has no button or box with data-key. */
const KEYS = { 0: () => setView(WHOLE), '+': () => zoom(1.25), '-': () => zoom(0.8),
  Escape: () => is('full').checked && is('full').click(),
  ArrowLeft: () => goTo((view.at < 0 ? run.frames.length : view.at + 1) - 2),
  ArrowRight: () => view.at >= 0 && goTo(view.at + 1) };

function pressKey(event) {
  const { key, target, ctrlKey, metaKey } = event, isPressed = key === ' ' || key === 'Enter';
  const isOwn = target.matches('textarea, select, input:not([type=checkbox])') ||
    isPressed && target.matches('button, input');
  const button = document.querySelector(`[data-key=${CSS.escape(key)}]`);
  if (!KEYS[key] && !button || ctrlKey || metaKey || isOwn && key !== 'Escape')
    return;
  event.preventDefault();
  KEYS[key] ? KEYS[key]() : button.click();
}

/* Drags the picture, or picks what a click is at. */
function listenToPicture(canvas) {
  let from, last;
  canvas.onpointerdown = e => {
    from = last = [e.offsetX, e.offsetY];
    canvas.setPointerCapture(e.pointerId);
  };
  canvas.onpointermove = e => {
    if (e.buttons)
      setView({ x: view.x + e.offsetX - last[0], y: view.y + e.offsetY - last[1] });
    last = [e.offsetX, e.offsetY];
  };
  canvas.onclick = e => Math.hypot(e.offsetX - from[0], e.offsetY - from[1]) < 4 &&
    pick(...findAt(shown(), e.offsetX, e.offsetY));
  canvas.onwheel = e => { e.preventDefault(); zoom(Math.exp(-e.deltaY / 500)); };
}

/* Each has a line "### Exercise 6.1 A block on a slope", a row of a table with the model, text. */
function readExercises(text) {
  for (const part of text.split('### Exercise ').slice(1)) {
    const [, title, number, model, words] = part.match(/^((\S+).*)\n.*?([\w-]+\.model)`.*\n([^]*)/);
    EXERCISES[number] = { title, model, text: words.replace(/`|\]\(.*?\)|\[/g, '') };
  }
  return Object.values(EXERCISES).map(e => new Option(e.title, e.title.split(' ')[0]));
}

async function start() {
  const models = [], bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0));
  let later;
  for (const kind of ['error', 'unhandledrejection'])
    addEventListener(kind, e => showError(`The page has failed: ${e.reason ?? e.message}`));
  for (const { dataset: { file }, textContent } of document.querySelectorAll('[data-file]')) {
    const text = new TextDecoder().decode(bytes(textContent));
    files.set(file, text).set('gallery/' + file, text);
    if (file.endsWith('.model'))
      models.push(new Option(file.replace('.model', ''), file));
  }
  is('gallery').append(make('optgroup', { label: 'models' }, ...models), make('optgroup',
    { label: 'exercises: predict' }, ...readExercises(files.get('exercises.txt'))));
  ROWS.unshift(...files.get('states.txt').trim().split('\n')
    .map(row => row.split(/ *\| */).slice(1, 4)));
  await startLibrary(bytes(document.querySelector('[data-file="bbm.wasm"]').textContent));
  is('text').oninput = () => {
    clearTimeout(later);
    later = setTimeout(() => { makeSliders(); load(); }, 400);
  };
  listenToPicture(is('view'));
  document.onkeydown = pressKey;
  onresize = show;
  onhashchange = followLink;
  followLink();
}

start();
