/* graphs.js - curves over the steps, with the open-close passes of each; and the pattern of K. */
'use strict';

const LINES = [['--lock', []], ['--slide', [8, 4]], ['--green', [2, 3]], ['--load', [10, 3, 2, 3]],
  ['--ink', [1, 2]]];

/* Curves [name, values], one scale for all; bands [low, high] of `expect`; bars below them. */
function drawGraph(id, { title, unit, curves, bands = [], bars, now }) {
  const { g, w, h } = begin(id), left = 68, right = w - 10, n = run.rows.length;
  const top = curves.length > 3 ? 42 : 25, bottom = h - (bars ? 58 : 22), ink = css('--ink');
  const all = [...curves.flatMap(c => c[1]), ...bands.flat()], low = -largest(all.map(a => -a));
  const high = largest(all) > low ? largest(all) : low + 1, exact = Math.max(high, -low) * 1e-6;
  const X = k => left + (right - left) * k / Math.max(1, n - 1);
  const Y = a => bottom - (bottom - top) * (a - low) / (high - low);
  const put = (text, x, y) => { g.fillStyle = ink; g.fillText(text, x, y); };
  g.font = `13px ${css('--sans')}`;
  for (const [a, b] of bands)
    paint(g, () => g.rect(left, Y(b) - 1, right - left, Y(a) - Y(b) + 2), { fill: css('--band') });
  paint(g, () => g.rect(left, top, right - left, bottom - top), { line: css('--line'), width: 1 });
  for (const [a, y] of [[high, top + 10], [low, bottom]]) {
    const text = quantity(Math.abs(a) < exact ? 0 : a, unit);
    put(text, left - 4 - g.measureText(text).width, y);
  }
  put(title, 6, 15);
  let x = 16 + g.measureText(title).width, y = 15;
  curves.forEach(([name, values], k) => {
    const points = values.map((a, i) => [X(i), Y(a)]), wide = g.measureText(name).width;
    if (x + 30 + wide > w)
      [x, y] = [16, 33];
    paint(g, () => { trace(g, [[x, y - 4], [x + 24, y - 4]]); trace(g, points); },
      { line: css(LINES[k % 5][0]), dash: LINES[k % 5][1], width: 1.8 });
    put(name, x + 28, y);
    x += 40 + wide;
  });
  const most = largest(bars ?? []), thick = Math.max(1, Math.min(12, 0.7 * (right - left) / n));
  paint(g, () => bars?.forEach((a, k) => g.rect(X(k) - thick / 2, h - 18, thick, -32 * a / most)),
    { fill: ink });
  if (bars)
    put(`open-close passes, at most ${most}`, left, h - 4);
  paint(g, () => g.rect(X(now) - 1, top, 2, bottom - top), { fill: css('--pick') });
}

/* Energies as they changed since the start, so that one scale serves: what the work of loads and
 * gravity has become. Monitors: four, those of which something is
 * expected first. */
function drawGraphs(frame) {
  const { rows, monitors } = run, now = rows.findIndex(r => r.step === frame.step);
  const curves = [], bands = [];
  const since = name => rows.map(r => r[name] - (name === 'kinetic' ? 0 : rows[0][name]));
  drawGraph('energies', { title: 'Energy', unit: 'J', now, bars: rows.map(r => r.passes),
    curves: ['kinetic', 'elastic', 'springs', 'work', 'gained'].map(name => [name, since(name)]) });
  monitors.forEach((name, k) => ['u', 'v'].forEach((axis, kind) => {
    const asked = expectations(frame).filter(x => x.monitor === k);
    const fit = asked.filter(x => x.kind === kind);
    bands.push(...fit.map(x => [x.value - x.within, x.value + x.within]));
    if (fit.length || asked.every(x => x.kind > 1))
      curves.push([`${name} ${axis}`, rows.map(r => r.o[2 * k + kind]), asked.length > 0]);
  }));
  curves.sort((a, b) => b[2] - a[2]);
  drawGraph('monitors', { title: 'Monitors', unit: 'm', now, curves: curves.slice(0, 4), bands });
}

const expectations = frame => frame.said.map((said, k) => {
  const [monitor, kind, value, within, met] = row(frame.x, 'x', k);
  return { monitor, kind, value, within, met, said };
});

/* The solver's order; the row and column of an element that is picked. */
function drawPattern(picked) {
  const k = numbersOf('k'), n = k[0], { g, w } = begin('K'), q = w / n;
  const at = q * k[1 + picked.element];
  const dot = (i, j) => g.rect(j * q, i * q, Math.max(1, q - 0.4), Math.max(1, q - 0.4));
  if (picked.element >= 0)
    paint(g, () => { g.rect(0, at, w, Math.max(2, q)); g.rect(at, 0, Math.max(2, q), w); },
      { fill: css('--band') });
  paint(g, () => times(n, i => dot(i, i)), { fill: css('--ink') });
  paint(g, () => times((k.length - 1 - n) / 2, b => {
    const [i, j] = k.subarray(1 + n + 2 * b);
    dot(i, j);
    dot(j, i);
  }), { fill: css('--lock') });
}
