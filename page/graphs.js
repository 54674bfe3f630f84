/* graphs.js - curves over the steps, with the open-close passes of each; and the pattern of K. */
'use strict';

const LOOKS_OF_LINES = [['--lock', []], ['--slide', [8, 4]], ['--green', [2, 3]],
  ['--load', [10, 3, 2, 3]], ['--ink', [1, 2]]];

/* Curves [name, values], one scale for all; bands [low, high] of `expect`; bars below them. */
function drawGraph(id, { title, unit, curves, bands = [], bars, now }) {
  const { g, w, h } = begin(id), left = 68, right = w - 10, top = 24, n = run.rows.length;
  const bottom = h - (bars ? 58 : 22), all = [...curves.flatMap(c => c[1]), ...bands.flat(), 0];
  const low = all.reduce((a, b) => Math.min(a, b)), most = all.reduce((a, b) => Math.max(a, b));
  const high = most > low ? most : low + 1, exact = Math.max(high, -low) * 1e-6;
  const X = k => left + (right - left) * k / Math.max(1, n - 1);
  const Y = a => bottom - (bottom - top) * (a - low) / (high - low);
  g.font = `13px ${css('--sans')}`;
  g.fillStyle = css('--band');
  for (const [a, b] of bands)
    g.fillRect(left, Y(b) - 1, right - left, Y(a) - Y(b) + 2);
  g.strokeStyle = css('--line');
  g.strokeRect(left, top, right - left, bottom - top);
  g.fillStyle = css('--ink');
  g.textAlign = 'right';
  g.fillText(quantity(Math.abs(high) < exact ? 0 : high, unit), left - 4, top + 10);
  g.fillText(quantity(Math.abs(low) < exact ? 0 : low, unit), left - 4, bottom);
  g.textAlign = 'left';
  g.font = `600 13px ${css('--sans')}`;
  g.fillText(title, 6, 15);
  let x = 16 + g.measureText(title).width;
  g.font = `13px ${css('--sans')}`;
  curves.forEach(([name, values], k) => {
    const [colour, dash] = LOOKS_OF_LINES[k % LOOKS_OF_LINES.length];
    g.strokeStyle = css(colour);
    g.lineWidth = 1.8;
    g.setLineDash(dash);
    g.beginPath();
    g.moveTo(x, 11);
    g.lineTo(x + 24, 11);
    values.forEach((a, i) => { i ? g.lineTo(X(i), Y(a)) : g.moveTo(X(i), Y(a)); });
    g.stroke();
    g.setLineDash([]);
    if (values.length === 1)
      g.fillRect(X(0) - 2, Y(values[0]) - 2, 5, 5);
    g.fillText(name, x + 28, 15);
    x += 40 + g.measureText(name).width;
  });
  if (bars) {
    const worst = bars.reduce((a, b) => Math.max(a, b), 1);
    g.fillText(`passes, at most ${worst}`, left, h - 4);
    bars.forEach((a, k) => g.fillRect(X(k) - 1, h - 18 - 32 * a / worst,
      Math.max(1, Math.min(12, 0.7 * (right - left) / n)), 32 * a / worst));
  }
  g.fillStyle = css('--pick');
  if (now >= 0)
    g.fillRect(X(now) - 1, top, 2, bottom - top);
}

/* Energies as they changed since the start, so that one scale serves: what the work of loads and
 * gravity has become. */
function drawGraphs(frame) {
  const rows = run.rows, now = rows.findIndex(r => r.step === frame.step);
  const since = name => rows.map(r => r[name] - rows[0][name]);
  drawGraph('energies', { title: 'Energy', unit: 'J', now, bars: rows.map(r => r.passes),
    curves: [['kinetic', rows.map(r => r.kinetic)], ['elastic', since('elastic')],
      ['springs', since('springs')], ['work', since('work')], ['gained', since('gained')]] });
  const curves = [], bands = [];
  run.monitors.forEach((name, k) => ['u', 'v'].forEach((axis, i) => {
    const asked = expectations(frame).filter(x => x.monitor === k);
    const fits = asked.filter(x => x.kind === i);
    fits.forEach(x => bands.push([x.value - x.within, x.value + x.within]));
    if (fits.length || asked.every(x => x.kind > 1))
      curves.push([`${name} ${axis}`, rows.map(r => r.o[2 * k + i])]);
  }));
  drawGraph('monitors', { title: 'Monitors', unit: 'm', now, curves: curves.slice(0, 6), bands });
}

const expectations = frame => frame.said.map((said, k) => {
  const [monitor, kind, value, within, met] = row(frame.x, 'x', k);
  return { monitor, kind, value, within, met, said };
});

/* The solver's order; the row and column of an element that is picked. */
function drawPattern(picked) {
  const k = numbersOf('k'), n = k[0] ?? 0, { g, w } = begin('K'), q = w / Math.max(1, n);
  const dot = (i, j) => g.fillRect(j * q, i * q, Math.max(1, q - 0.4), Math.max(1, q - 0.4));
  g.fillStyle = css('--band');
  if (picked.element >= 0) {
    g.fillRect(0, q * k[1 + picked.element], w, Math.max(2, q));
    g.fillRect(q * k[1 + picked.element], 0, Math.max(2, q), w);
  }
  g.fillStyle = css('--ink');
  for (let i = 0; i < n; i++)
    dot(i, i);
  g.fillStyle = css('--lock');
  for (let b = 1 + n; b < k.length; b += 2) {
    dot(k[b], k[b + 1]);
    dot(k[b + 1], k[b]);
  }
}
