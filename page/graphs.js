/* graphs.js - curves over the steps; and the pattern of K. */
'use strict';

const COLOURS = ['--lock', '--slide', '--green', '--load', '--ink'];
const DASHES = [[], [8, 4], [2, 3], [10, 3, 2, 3], [1, 2], [14, 4]];

/* Round numbers that hold 0 and all values between them, about n steps apart. */
function findTicks(values, n) {
  const low = -largest(values.map(a => -a)), high = largest(values), range = high - low || 1;
  const step = 1 / roundDown(n / range), first = Math.floor(low / step + 0.02);
  return times(Math.max(1, Math.ceil(high / step - 0.02) - first) + 1, k => (first + k) * step);
}

/* Of each n values the least and the largest, as [place, value]. */
const thinOut = (values, n) => times(Math.ceil(values.length / n), i => {
  const part = values.slice(n * i, n * i + n);
  return [Math.min(...part), Math.max(...part)].map(a => [n * i + part.indexOf(a), a])
    .sort((p, q) => p[0] - q[0]);
}).flat();

/* Of each frame a number; that of an old frame is not asked for again. */
function valuesOf(name, ask) {
  const values = run.curves[name] ??= [], n = run.frames.length - !!run.frames.at(-1).failure;
  while (values.length < n)
    values.push(ask(run.frames[values.length]));
  return values;
}

/* Curves [name, values, bands [low, high] of `expect`, if any], one scale for all. */
function drawGraph(id, unit, all) {
  const { g, w, h } = begin(id), ink = css('--ink'), left = 68, right = w - 8, bottom = h - 8;
  const curves = all.map(([name, values], k) => ({ name, line: css(COLOURS[k % 5]),
    dash: DASHES[k % 6], points: thinOut(values, Math.ceil(values.length / 300)) }));
  Object.assign(g, { font: `12px ${css('--sans')}`, fillStyle: ink });
  const top = drawNames(g, w, 11, curves) + 13, n = run.frames.length - 1;
  const values = [curves.map(c => c.points.map(p => p[1])), all.map(c => c[2] ?? [])].flat(3);
  const ticks = findTicks([0, ...values], (bottom - top) / 28);
  const low = ticks[0], high = ticks.at(-1);
  const X = k => left + (right - left) * k / Math.max(1, n);
  const Y = a => bottom - (bottom - top) * (a - low) / (high - low);
  for (const [a, b] of all.flatMap(c => c[2] ?? []))
    paint(g, () => g.rect(left, Y(b) - 1, right - left, Y(a) - Y(b) + 2), { fill: css('--band') });
  g.textAlign = 'right';
  for (const a of ticks) {
    paint(g, () => trace(g, [[left, Y(a)], [right, Y(a)]]), { line: css('--line'), width: 0.7 });
    g.fillText(quantity(a, unit), left - 5, Y(a) + 4);
  }
  const now = X(view.at < 0 ? n : view.at);
  paint(g, () => trace(g, [[now, top], [now, bottom]]), { line: css('--pick'), width: 2 });
  for (const { points, line, dash } of curves)
    paint(g, () => trace(g, points.map(([k, a]) => [X(k), Y(a)])), { line, dash, width: 1.8 });
}

/* Energies as they changed since the start, so that one scale serves: what the work of loads and
 * gravity has become. Monitors of nodes, and those of joints with 4 numbers: the numbers for which
 * something is expected, or else all. */
function drawGraphs(frame) {
  const graphs = [['monitors', 'm', 2, []], ['joints', 'N', 4, []]];
  const since = name =>
    valuesOf(name, f => f[name] - (name === 'kinetic' ? 0 : run.frames[0][name]));
  for (const [id, , n, curves] of graphs) {
    run.monitors.forEach(([name, ...what], k) => what.length === n && what.forEach((axis, i) => {
      const asked = rows(frame, 'x').filter(x => x[0] === k), fit = asked.filter(x => x[1] === i);
      if (fit.length || asked.every(x => x[1] >= n))
        curves.push([`${name} ${axis}`, valuesOf(`${k} ${i}`, f => f.o[4 * k + i]),
          fit.map(x => [x[2] - x[3], x[2] + x[3]])]);
    }));
    is(id).hidden = curves.length === 0 || isSecret();
  }
  drawGraph('energies', 'J',
    ['kinetic', 'elastic', 'springs', 'work', 'gained'].map(name => [name, since(name)]));
  drawGraph('passes', '', [['open-close passes', valuesOf('passes', f => f.passes)]]);
  graphs.forEach(([id, unit, , curves]) => drawGraph(id, unit, curves));
}

/* Of the newest step, in the solver's order; the row and column of an element that is picked. */
function drawPattern() {
  const off = rows({ k: numbersOf('k') }, 'k'), { g, w } = begin('K');
  const places = rows(run.frames.at(-1), 'e').map(e => e[25]), n = places.length;
  const q = w / n, at = q * places[view.element];
  const dot = (i, j) => g.rect(j * q, i * q, Math.max(1, q - 0.4), Math.max(1, q - 0.4));
  if (view.element >= 0)
    paint(g, () => { g.rect(0, at, w, Math.max(2, q)); g.rect(at, 0, Math.max(2, q), w); },
      { fill: css('--band') });
  paint(g, () => times(n, i => dot(i, i)), { fill: css('--ink') });
  paint(g, () => off.forEach(([i, j]) => { dot(i, j); dot(j, i); }), { fill: css('--lock') });
}
