/* graphs.js - curves over the steps; and the pattern of K. */
'use strict';

const LINES = [['--lock', []], ['--slide', [8, 4]], ['--green', [2, 3]], ['--load', [10, 3, 2, 3]],
  ['--ink', [1, 2]]];

/* Curves [name, values], one scale for all; bands [low, high] of `expect`. */
function drawGraph(id, unit, curves, bands = []) {
  const { g, w, h } = begin(id), left = 68, right = w - 8, top = 22, bottom = h - 6;
  const all = [...curves.flatMap(c => c[1]), ...bands.flat()], low = -largest(all.map(a => -a));
  const high = largest(all) > low ? largest(all) : low + 1, n = curves[0]?.[1].length ?? 0;
  const X = k => left + (right - left) * k / Math.max(1, n - 1);
  const Y = a => bottom - (bottom - top) * (a - low) / (high - low);
  const box = (x, y, width, height, style) => paint(g, () => g.rect(x, y, width, height), style);
  let x = 6;
  g.font = `12px ${css('--sans')}`;
  for (const [a, b] of bands)
    box(left, Y(b) - 1, right - left, Y(a) - Y(b) + 2, { fill: css('--band') });
  box(left, top, right - left, bottom - top, { line: css('--line'), width: 1 });
  box(X(at < 0 ? n - 1 : at) - 1, top, 2, bottom - top, { fill: css('--pick') });
  g.fillStyle = css('--ink');
  g.textAlign = 'right';
  g.fillText(quantity(high, unit), left - 4, top + 10);
  g.fillText(quantity(Math.abs(low) < 1e-6 * high ? 0 : low, unit), left - 4, bottom);
  g.textAlign = 'left';
  curves.forEach(([name, values], k) => {
    const [line, dash] = LINES[k % 5];
    paint(g, () => {
      trace(g, [[x, 11], [x + 20, 11]]);
      trace(g, values.map((a, i) => [X(i), Y(a)]));
    }, { line: css(line), dash, width: 1.8 });
    g.fillText(name, x + 23, 15);
    x += 31 + g.measureText(name).width;
  });
}

/* Energies as they changed since the start, so that one scale serves: what the work of loads and
 * gravity has become. Monitors: three, those of which something is expected first. */
function drawGraphs(frame) {
  const frames = run.frames.filter(f => !f.failed), bands = [], curves = [];
  const history = name => frames.map(f => f[name]);
  const since = name => history(name).map(a => a - (name === 'kinetic' ? 0 : frames[0][name]));
  drawGraph('energies', 'J',
    ['kinetic', 'elastic', 'springs', 'work', 'gained'].map(name => [name, since(name)]));
  drawGraph('passes', '', [['open-close passes', history('passes')]]);
  run.monitors.forEach((name, k) => ['u', 'v'].forEach((axis, kind) => {
    const asked = rows(frame, 'x').filter(x => x[0] === k), fit = asked.filter(x => x[1] === kind);
    bands.push(...fit.map(x => [x[2] - x[3], x[2] + x[3]]));
    if (fit.length || asked.every(x => x[1] > 1))
      curves.push([`${name} ${axis}`, frames.map(f => f.o[2 * k + kind]), asked.length]);
  }));
  drawGraph('monitors', 'm', curves.sort((a, b) => b[2] - a[2]).slice(0, 3), bands);
}

/* The solver's order; the row and column of an element that is picked. */
function drawPattern() {
  const off = rows({ k: numbersOf('k') }, 'k'), places = rows(shown(), 'e').map(e => e[25]);
  const { g, w } = begin('K'), n = places.length, q = w / n, at = q * places[picked.element];
  const dot = (i, j) => g.rect(j * q, i * q, Math.max(1, q - 0.4), Math.max(1, q - 0.4));
  if (picked.element >= 0)
    paint(g, () => { g.rect(0, at, w, Math.max(2, q)); g.rect(at, 0, Math.max(2, q), w); },
      { fill: css('--band') });
  paint(g, () => times(n, i => dot(i, i)), { fill: css('--ink') });
  paint(g, () => off.forEach(([i, j]) => { dot(i, j); dot(j, i); }), { fill: css('--lock') });
}
