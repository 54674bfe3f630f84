/* page.js - what a person does: writes a model, moves sliders, predicts, runs, looks. */
'use strict';

const is = id => document.getElementById(id);
/* ms of steps between two pictures; unknowns; s by which real time may lag; ms */
const WORK = 12, LARGE = 5000, LAG = 0.05, SLOW = 150;
const EXERCISES = Object.create(null);         /* of the chapters: title, model, text */
let playing = false, turns = 0, task = null, hasPredicted = false, predictions = 0;

/* The frame in hand, or the one before that has kept its arrays. */
const shown = () => run.frames.findLast((f, k) => f.v && (view.at < 0 || k <= view.at));

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
  tellStatement(bad - 1);
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
      rememberSoon();
      if (load() && again)
        play(true);
    };
    return make('label', {}, name, slide, number);
  }));
}

/* Reads the text; the model that was there stays if it is wrong. */
function load() {
  play(false);
  Object.assign(hands, IDLE);
  const said = loadModel(task?.model ?? past.name.replace(OWN, ''), is('text').value);
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

/* A model of the gallery, one of a person's own, or an exercise with its model, without the answers
 * that it comes with. */
function choose(name, text) {
  const model = EXERCISES[name] || /\.model/.test(name) ? name : `${name}.model`;
  text ??= files.get(`gallery/${EXERCISES[model]?.model ?? model}`) ?? `# there is no ${name} here`;
  if (past.list.length)
    remember();
  Object.assign(view, WHOLE);
  is('edit').scrollTop = 0;
  setText(model, EXERCISES[model] ? text.replace(/^ *(#|expect).*\n/gm, '') : text);
  kept.bbm = model;
  remember(false);
}

function setText(name, text) {
  task = EXERCISES[name];
  past.name = is('gallery').value = name;
  is('text').value = text;
  is('exercise').reset();
  is('exercise').hidden = !task;
  is('within').value = task?.within ?? '';
  predictions = 0;
  fill('task', [make('b', {}, task?.title ?? ''), make('p', {}, task?.text ?? '')]);
  makeSliders();
  load();
}

/* The first prediction, if it is wrong, does not bring the number, but a picture of itself. */
const isSecret = () => task && predictions < 2 &&
  !(run.state === 1 && rows(run.frames.at(-1), 'x').every(x => x[4]));

/* An exercise runs when what will come out has been written down. */
function predict() {
  const [what, number, within] = ['what', 'number', 'within'].map(id => is(id).value);
  is('text').value = is('text').value.replace(/\n*expect .*\n*$/, '') +
    `\n\nexpect ${what} ${number} within ${within}\n`;
  hasPredicted = load();
  predictions += hasPredicted;
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

/* In real time no step begins before its time has come; a delay is not made up for. After a pull
 * time is real. Steps take longer than pictures, if there are enough of them. */
function work(once) {
  const start = performance.now(), before = run.frames.at(-1), { t, dynamic, begun } = before;
  const isPaced = dynamic && begun && !once && (run.isPulled || is('paced').checked);
  const end = start + Math.max(WORK, 3 * run.took);
  let more = true;
  run.due = Math.max(t, Math.min(t + LAG, run.due + (start - run.at) / 1e3));
  run.at = start;
  while (more && performance.now() < end && (!isPaced || run.frames.at(-1).t < run.due))
    more = stepModel() && !(once && run.frames.at(-1).begun);
  feel(before);
  play(more, once);
  setView(NEWEST);
}

/* What is expected, and what has come out. What a hand has pulled is not judged. */
function tellExpected(f) {
  const isOver = run.state === 1 && view.at < 0 && !run.isPulled;
  const head = run.isPulled ? 'by hand' : isOver ? 'expected' : 'so far';
  const words = run.isPulled ? /: (ok|NOT MET)$/ : isSecret() ? /; computed.*$/ : /$/;
  const note = run.isPulled ? 'Pulled by hand: ./bbm knows nothing of that, so nothing is judged.'
    : isOver && isSecret() ? 'Not so: the ring is where your number has it. Try once more.' : '';
  const lines = `${note}\n${run.isPulled ? run.warned : warnings}`.split('\n');
  fill('expected', [...lines.filter(line => line).map(line => make('div', {}, line)),
  ...rows(f, 'x').map((x, k) => make('div', { className: !isOver ? '' : x[4] ? 'ok' : 'missed' },
    `${head}: ${f.said[k].replace(words, '')}`))]);
}

/* All but the picture need not be as quick, and is drawn each SLOW ms while it plays. */
function show() {
  const f = shown(), isDeep = is('inside').checked, look = isDeep && looksOf(f)[view.look];
  const start = performance.now();
  drawPicture(f, look);                         /* before what changes the layout */
  run.took = performance.now() - start;
  is('when').max = run.frames.length - 1;
  is('when').value = view.at < 0 ? run.frames.length - 1 : view.at;
  is('say').textContent = !f.begun ? `settling ${f.settle - f.settling} of ${f.settle}`
    : `step ${f.step}${run.isPulled ? '' : ` of ${f.steps}`}` +
    (f.dynamic ? `  t = ${format(f.t)} s` : '') + (f.failure && '  failed');
  if (playing && performance.now() < run.slow)
    return;
  if (f.failure)
    showError(`${run.name}: ${f.failure}`);
  tellExpected(f);
  tell(f);
  isDeep ? tellLook(f) : drawGraphs(f);
  drawPattern();
  run.slow = performance.now() + SLOW;
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
  const link = new URLSearchParams({ model: past.name.replace(OWN, ''), text: is('text').value });
  history.replaceState(null, '', '#' + link);
  navigator.clipboard?.writeText(location.href).then(() => sayHand('the link is copied'),
    () => sayHand('the link is in the line of the address'));
}

function followLink() {
  const link = new URLSearchParams(location.hash.slice(1));
  is('full').checked = link.has('full');
  choose(link.get('model') ?? kept.bbm ?? 'arch.model', link.get('text') ?? undefined);
}

/* Of the keys: what has no button or box with data-key. */
const KEYS = { Delete: deletePicked, Backspace: deletePicked,
  0: () => setView(WHOLE), '+': () => zoom(1.25), '-': () => zoom(0.8),
  Escape: () => hands.corners ? toggleDrawing() : is('full').checked && is('full').click(),
  ArrowLeft: () => goTo((view.at < 0 ? run.frames.length : view.at + 1) - 2),
  ArrowRight: () => view.at >= 0 && goTo(view.at + 1) };

function pressKey(event) {
  const { target, ctrlKey, metaKey } = event, isPressed = /^( |Enter)$/.test(event.key);
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const isOwn = target.matches('textarea, select, input:not([type=checkbox])') ||
    isPressed && target.matches('button, input');
  const button = document.querySelector(`[data-key=${CSS.escape(key)}]`);
  if ((ctrlKey || metaKey) && /^[zy]$/.test(key) && !target.matches('input:not([type]), #notes')) {
    event.preventDefault();
    undo(key === 'y' || event.shiftKey ? 1 : -1);
  }
  if (!KEYS[key] && !button || ctrlKey || metaKey || isOwn && key !== 'Escape')
    return;
  event.preventDefault();
  KEYS[key] ? KEYS[key]() : button.click();
}

/* Drags what a hand takes, or else the picture; picks what a click is at. */
function listenToPicture(canvas) {
  let from, last, isDrag;
  canvas.onpointerdown = e => {
    from = last = [e.offsetX, e.offsetY];
    isDrag = false;
    canvas.setPointerCapture(e.pointerId);
    if (!hands.corners)
      grab(...from);
  };
  canvas.onpointermove = e => {
    const here = hands.place = [e.offsetX, e.offsetY], [dx, dy] = here.map((a, k) => a - last?.[k]);
    isDrag ||= e.buttons && Math.hypot(here[0] - from[0], here[1] - from[1]) >= 4;
    if (e.buttons && isDrag && hands.grip)
      drag(...here);
    else if (e.buttons && isDrag) {
      hands.said = hands.why;
      setView({ x: view.x + dx, y: view.y + dy });
    } else if (isAtStart()) {
      hands.over = findHandle(...here);
      redraw();
    }
    if (isDrag || !e.buttons)
      last = here;
  };
  canvas.onpointerup = canvas.onpointercancel = drop;
  canvas.onclick = e => {
    if (hands.corners && !isDrag)
      setCorner(e.offsetX, e.offsetY, false);
    else if (!isDrag)
      pick(...findAt(shown(), e.offsetX, e.offsetY));
  };
  canvas.ondblclick = e => hands.corners && setCorner(e.offsetX, e.offsetY, true);
  canvas.onwheel = e => { e.preventDefault(); zoom(Math.exp(-e.deltaY / 500)); };
}

/* Each has a line "### Exercise 6.1 A block on a slope", a table with model and tolerance, text. */
function readExercises(text) {
  for (const part of text.split('### Exercise ').slice(1)) {
    const [, title, number, model, words] = part.match(/^((\S+).*)\n.*?([\w-]+\.model)`.*\n([^]*)/);
    const within = part.match(/within (.*)` \|/)?.[1];
    EXERCISES[number] = { title, model, within, text: words.replace(/`|\]\(.*?\)|\[/g, '') };
  }
  return Object.values(EXERCISES).map(e => new Option(e.title, e.title.split(' ')[0]));
}

async function start() {
  const models = [], unpack = text => new Response(new Blob([Uint8Array.from(atob(text),
    c => c.charCodeAt(0))]).stream().pipeThrough(new DecompressionStream('gzip')));
  for (const kind of ['error', 'unhandledrejection'])
    addEventListener(kind, e => showError(`The page has failed: ${e.reason ?? e.message}`));
  for (const { dataset: { file }, textContent } of document.querySelectorAll('[data-file]')) {
    const text = await unpack(textContent).text();
    files.set(file, text).set('gallery/' + file, text);
    if (file.endsWith('.model'))
      models.push(new Option(file.replace('.model', ''), file));
  }
  is('gallery').append(make('optgroup', { id: 'own', label: 'own, kept in this browser' }),
    make('optgroup', { label: 'models' }, ...models), make('optgroup',
      { label: 'exercises: predict' }, ...readExercises(files.get('exercises.txt'))));
  listOwn();
  readStatements(files.get('statements.txt'));
  ROWS.unshift(...files.get('states.txt').trim().split('\n')
    .map(row => row.split(/ *\| */).slice(1, 4)));
  await startLibrary(await unpack(document.querySelector('[data-file="bbm.wasm"]').textContent)
    .arrayBuffer());
  is('text').oninput = () => rememberSoon(() => { makeSliders(); load(); });
  is('text').onkeyup = is('text').onclick = () =>
    tellStatement(is('text').value.slice(0, is('text').selectionStart).split('\n').length - 1);
  listenToPicture(is('view'));
  document.onkeydown = pressKey;
  onresize = show;
  dark.onchange = show;
  onhashchange = followLink;
  setText('arch.model', files.get('gallery/arch.model'));   /* is there if what follows is wrong */
  followLink();
}

start();
