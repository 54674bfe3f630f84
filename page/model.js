/* model.js - the library in WebAssembly: loads a model, steps, and keeps what has been computed.
 *
 * `run` is the model in hand. A frame has the facts and monitors of a step and the arrays of
 * page.h; after a while every second one loses its arrays, but not the last one. */
'use strict';

const STRIDE = { v: 6, e: 26, d: 3, c: 10, l: 4, x: 5, k: 2, b: 6, h: 7 },
  ARRAYS = [...'vecdlxpbh'];
const FACTS = ('step t steps dynamic settling settle begun dt passes iterations residual cuts ' +
  'contacts penetration candidates change kinetic elastic springs work gained scale').split(' ');
/* States of contacts; what precedes a look at them, as in page.h. */
const STATES = ['OPEN', 'LOCK', 'SLIDE'], SLIDE = 2, LISTED = 0, JUDGED = 1, FRICTION = 2, DONE = 4;
const ROOM = 150e6;                             /* bytes of all frames */
const files = new Map();
let wasm, run = null, warnings = '';            /* what is allowed and hardly meant, a line each */

const times = (n, make) => Array.from({ length: n }, (_, k) => make(k));
/* The rows of an array: what page.h lists, of each vertex, element, ... */
const rows = (frame, what, n = STRIDE[what]) =>
  times(frame[what].length / n, k => frame[what].subarray(n * k, n * (k + 1)));

async function startLibrary(bytes) {
  const imports = wasi(files, () => wasm.memory, text => { warnings += text; });
  wasm = (await WebAssembly.instantiate(bytes, { wasi_snapshot_preview1: imports }))
    .instance.exports;
  wasm._initialize();
}

function textOf(what, k = 0, handle = run.handle) {
  const at = wasm.page_text(handle, what.charCodeAt(0), k) >>> 0;
  const memory = new Uint8Array(wasm.memory.buffer);
  return new TextDecoder().decode(memory.subarray(at, memory.indexOf(0, at)));
}

function numbersOf(what) {
  const n = wasm.page_numbers(run.handle, what.charCodeAt(0));
  if (n < 0)
    throw Error('no memory for the numbers of this model');
  return new Float64Array(wasm.memory.buffer, wasm.page_data(run.handle) >>> 0, n).slice();
}

/* The message of what is wrong, or ''. Then the model that was there stays. */
function loadModel(name, text) {
  const bytes = new TextEncoder().encode(name + '\0'), at = wasm.malloc(bytes.length) >>> 0;
  new Uint8Array(wasm.memory.buffer).set(bytes, at);
  files.set(name, text);
  warnings = '';
  const handle = wasm.page_load(at), said = wasm.page_state(handle) ? textOf('m', 0, handle) : '';
  wasm.free(at);
  wasm.page_free(said ? handle : run?.handle ?? 0);
  if (said)
    return said;
  run = { handle, name, frames: [], bytes: 0, state: 0, warned: warnings,
    curves: {}, due: 0, at: 0 };
  keepFrame();
  run.monitors = times(run.frames[0].o.length / 4, k =>
    [textOf('o', k), ...textOf('q', k).replace('|moves|stays', '').split('|')]);
  if (run.frames[0].settle === 0)
    stepModel();                                /* begins, at step 0 */
  return '';
}

/* While the model settles there is one frame alone, the present one. */
function keepFrame() {
  const facts = numbersOf('f'), failure = run.state === 2 ? textOf('m') : '';
  const frame = { o: facts.slice(FACTS.length), failure };
  FACTS.forEach((name, k) => { frame[name] = facts[k]; });
  ARRAYS.forEach(what => { frame[what] = numbersOf(what); });
  run.d = frame.d;                              /* cracks add edges */
  frame.said = rows(frame, 'x').map((_, k) => textOf('x', k));
  if (failure)
    frame.step = Math.min(frame.step + 1, frame.steps);
  if (run.frames.at(-1)?.begun === 0) {
    run.frames.pop();
    run.curves = {};
  }
  run.frames.push(frame);
  run.bytes += ARRAYS.reduce((sum, what) => sum + frame.begun * frame[what].byteLength, 0);
  if (run.bytes > ROOM) {
    run.bytes /= 2;
    run.frames.filter(f => f.v).forEach((f, k, all) => ARRAYS.forEach(what =>
      k % 2 && k < all.length - 1 && delete f[what]));
  }
}

/* One step; whether there may be another. */
function stepModel() {
  run.state = wasm.page_step(run.handle);
  keepFrame();
  return run.state === 0;
}

/* A hand takes a point of an element, or lets go (-1). What comes out is no answer to the file any
 * more, and not judged. */
function hold(element, x = 0, y = 0) {
  wasm.page_hold(run.handle, element, x, y);
  run.state = wasm.page_state(run.handle);
  run.isPulled = true;
}

function pull(x, y) {
  wasm.page_pull(run.handle, x, y);
  run.state = wasm.page_state(run.handle);
}
