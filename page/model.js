/* model.js - the library in WebAssembly: loads a model, steps, and keeps what has been computed.
 *
 * `run` is the model in hand. A frame is what page.h lists, at one time; after a while every second
 * one is given up. `run.rows` has the facts and monitors of every step, for the graphs. */
'use strict';

const STRIDE = { v: 4, e: 22, a: 7, d: 3, c: 13, h: 2, l: 4, o: 2, x: 5 };
const FACTS = ('step t steps dynamic settling settle begun dt passes iterations residual cuts ' +
  'contacts penetration candidates change kinetic elastic springs work gained scale').split(' ');
const ROOM = 150e6;                             /* bytes of all frames */
const files = new Map();
let wasm, run = null, warnings = '';            /* what is allowed and hardly meant, a line each */

async function startLibrary(bytes) {
  const imports = { wasi_snapshot_preview1: wasi(files, () => wasm.memory,
    text => { warnings += text; }) };
  wasm = (await WebAssembly.instantiate(bytes, imports)).instance.exports;
  wasm._initialize();
}

function putText(text) {
  const bytes = new TextEncoder().encode(text + '\0'), at = wasm.malloc(bytes.length);
  new Uint8Array(wasm.memory.buffer).set(bytes, at);
  return at;
}

function getText(at) {
  const memory = new Uint8Array(wasm.memory.buffer);
  return new TextDecoder().decode(memory.subarray(at, memory.indexOf(0, at)));
}

const textOf = (what, k = 0, handle = run.handle) =>
  getText(wasm.page_text(handle, what.charCodeAt(0), k));

function numbersOf(what) {
  const n = wasm.page_numbers(run.handle, what.charCodeAt(0));
  if (n < 0)
    throw Error('no memory for the numbers of this model');
  return new Float64Array(wasm.memory.buffer, wasm.page_data(run.handle), n).slice();
}

const count = (array, what) => array.length / STRIDE[what];
const row = (array, what, k) => array.subarray(STRIDE[what] * k, STRIDE[what] * (k + 1));

/* The message of what is wrong, or ''. Then the model that was there stays. */
function loadModel(name, text, lets) {
  files.set(name, text);
  warnings = '';
  const a = putText(name), b = putText(lets), handle = wasm.page_load(a, b);
  wasm.free(a);
  wasm.free(b);
  if (handle === 0 || wasm.page_state(handle) !== 0) {
    const said = handle ? textOf('m', 0, handle) : 'out of memory';
    wasm.page_free(handle);
    return said;
  }
  if (run)
    wasm.page_free(run.handle);
  run = { handle, name, frames: [], rows: [], bytes: 0, state: 0, failure: '' };
  Object.assign(run, { mesh: numbersOf('a'), edges: numbersOf('d'), held: numbersOf('h'),
    title: textOf('t') });
  keepFrame();
  run.monitors = Array.from({ length: count(run.frames[0].o, 'o') }, (_, k) => textOf('o', k));
  if (run.frames[0].settle === 0)
    stepModel();                                /* begins, at step 0 */
  return '';
}

function readFrame() {
  const facts = numbersOf('f');
  const values = Object.fromEntries(FACTS.map((name, k) => [name, facts[k]]));
  const frame = { ...values, row: values };
  for (const what of 'vecloxp')
    frame[what] = numbersOf(what);
  values.o = frame.o;
  frame.said = Array.from({ length: count(frame.x, 'x') }, (_, k) => textOf('x', k));
  return frame;
}

const sizeOf = frame => 'vecloxp'.split('').reduce((sum, what) => sum + frame[what].byteLength, 0);

/* While the model settles there is one frame alone, the present one. */
function keepFrame() {
  const frame = readFrame();
  if (run.frames.length && !run.frames.at(-1).begun)
    run.bytes -= sizeOf(run.frames.pop());
  run.frames.push(frame);
  run.bytes += sizeOf(frame);
  if (run.bytes > ROOM) {
    run.frames = run.frames.filter((_, k) => k % 2 === 0 || k > run.frames.length - 10);
    run.bytes = run.frames.reduce((sum, f) => sum + sizeOf(f), 0);
  }
  return frame;
}

/* One step; whether there may be another. */
function stepModel() {
  if (run.state)
    return false;
  run.state = wasm.page_step(run.handle);
  const frame = keepFrame();
  if (run.state === 2) {
    run.failure = textOf('m');
    frame.failed = true;
  } else if (frame.begun) {
    run.rows.push(frame.row);
  }
  return run.state === 0;
}
