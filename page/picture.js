/* picture.js - the blocks on a canvas, with the tints, colours and symbols of the SVGs (scene.c).
 *
 * `view` has what a person chooses: the part of the model; the frame, -1 for the newest, and the
 * look at it; what is picked; magnify, 0 for as it finds best; the colour. findShape gathers what
 * stays as long as the model does. */
'use strict';

const TINTS = ['#f6cf8b', '#b3dcf5', '#8fd3bd', '#f7f0a6', '#e6c3d7', '#eba98f'];
const VIRIDIS = ('#440154 #482878 #3e4a89 #31688e #26828e #1f9e89 #35b779 #6dcd59 #b4de2c ' +
  '#fde725').split(' ');
/* Arrows: the state of a contact, or 3 and 4 for a load; its name, unit, colour, dashes. */
const ARROWS = [[1, 'locked', 'N', '--lock', []], [2, 'sliding', 'N', '--slide', [4, 3]],
  [3, 'load', 'N', '--load', []], [4, 'load', 'N/m', '--load', []]];
const WHOLE = { zoom: 1, x: 0, y: 0 }, NEWEST = { at: -1, look: 0 };
const NONE = { element: -1, contact: null };
const view = { ...WHOLE, ...NEWEST, ...NONE, magnify: 0, colour: 'block' };

const dark = matchMedia('(prefers-color-scheme: dark)');
const css = name => css[name + dark.matches] ??=
  getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const largest = values => values.reduce((a, b) => Math.max(a, b), 0);

/* A number with its unit, k, M, G or m, u, n before it. */
function quantity(x, unit) {
  const power = x === 0 ? 0 : Math.floor(Math.log10(Math.abs(x)) / 3 + 1e-9);
  const p = Math.max(-3, Math.min(3, power));
  return `${+(x / 1000 ** p).toPrecision(3)} ${['n', 'u', 'm', '', 'k', 'M', 'G'][p + 3]}${unit}`;
}

/* The largest of ..., 1, 2, 5, 10, ... that is not above x. */
function roundDown(x) {
  const ten = 10 ** Math.floor(Math.log10(x) + 1e-9);
  return ten * ([5, 2].find(f => f * ten <= x * (1 + 1e-9)) ?? 1);
}

const sizeOf = (id, canvas = document.getElementById(id)) =>
  ({ g: canvas.getContext('2d'), w: canvas.clientWidth, h: canvas.clientHeight });

/* A canvas as sharp as the screen, empty. */
function begin(id) {
  const { g, w, h } = sizeOf(id);
  Object.assign(g.canvas, { width: w * devicePixelRatio, height: h * devicePixelRatio });
  g.scale(devicePixelRatio, devicePixelRatio);
  return { g, w, h };
}

/* Whether a path holds a pixel. */
function isInside(g, path, x, y) {
  g.beginPath();
  path();
  return g.isPointInPath(x * devicePixelRatio, y * devicePixelRatio);
}

/* Lines or an outline through points in pixels, into the path in hand. */
function trace(g, points, closed) {
  points.forEach(([x, y], k) => { k ? g.lineTo(x, y) : g.moveTo(x, y); });
  if (closed)
    g.closePath();
}

/* Draws a path, at a place and turned: filled, then its line. */
function paint(g, path, { fill, line, width = 1.3, dash = [] }, place = [0, 0], turn = 0) {
  g.save();
  g.translate(...place);
  g.rotate(turn);
  g.beginPath();
  path();
  Object.assign(g, { fillStyle: fill, strokeStyle: line, lineWidth: width });
  g.setLineDash(dash);
  if (fill)
    g.fill();
  if (line)
    g.stroke();
  g.restore();
}

/* The box around two boxes, each from x, y to x, y. */
const join = ([a, b, c, d], [A, B, C, D]) =>
  [Math.min(a, A), Math.min(b, B), Math.max(c, C), Math.max(d, D)];

/* The blocks: their elements, boxes, tints, and whether all of one is held. */
function findShape() {
  const [frame] = run.frames, blocks = [];
  const block = b => blocks[b] ??= { held: true, elements: [],
    box: [Infinity, Infinity, -Infinity, -Infinity] };
  for (const [x, y, , , held, b] of rows(frame, 'v')) {
    block(b).box = join(block(b).box, [x, y, x, y]);
    block(b).held &&= held === 3;
  }
  rows(frame, 'e').forEach((e, k) => block(e[22]).elements.push([k, e[23], e[24]]));
  blocks.forEach((b, k) => { b.tint = chooseTint(blocks.slice(0, k).reverse(), b.box); });
  Object.assign(run, { blocks, v: frame.v, box: blocks.map(b => b.box).reduce(join) });
}

/* The one whose nearest block is farthest, as choose_tint in scene.c. The others begin with the
 * last, which is mostly near, and what is farther away is passed over. */
function chooseTint(others, [x0, y0, x1, y1]) {
  const nearest = TINTS.map(() => Infinity);
  for (const { held, box: [X0, Y0, X1, Y1], tint } of others) {
    const gx = Math.max(0, x0 - X1, X0 - x1), gy = Math.max(0, y0 - Y1, Y0 - y1);
    if (held || Math.max(gx, gy) >= nearest[tint])
      continue;
    const way = Math.hypot(x0 + x1 - X0 - X1, y0 + y1 - Y0 - Y1) / 2;
    nearest[tint] = Math.min(nearest[tint], Math.hypot(gx, gy) + 0.01 * way);
  }
  return nearest.indexOf(Math.max(...nearest));
}

/* 1, 2 or 5 times a power of ten: the largest displacement becomes about a tenth of the model. */
function findMagnification(frame) {
  const most = largest(rows(frame, 'v').map(v => Math.hypot(v[2], v[3])));
  const [x0, y0, x1, y1] = run.box, size = Math.max(x1 - x0, y1 - y0);
  const wanted = most > 1e-12 * size ? 0.1 * size / most : 1;
  return frame.dynamic ? 1 : frame.scale || Math.max(1, roundDown(wanted));
}

/* From metres to pixels, so that the model as it begins fits between the margins. */
function findScale(w, h) {
  const [x0, y0, x1, y1] = run.box, s = view.zoom * Math.min((w - 60) / (x1 - x0),
    (h - 130) / (y1 - y0));
  const x = w / 2 + view.x - s * (x0 + x1) / 2, y = h / 2 + 10 + view.y + s * (y0 + y1) / 2;
  return { s, to: (X, Y) => [x + s * X, y - s * Y], from: (X, Y) => [(X - x) / s, (y - Y) / s] };
}

function viridis(share) {
  const k = Math.min(8, Math.floor(9 * share));
  return `color-mix(in srgb, ${VIRIDIS[k + 1]} ${100 * (9 * share - k)}%, ${VIRIDIS[k]})`;
}

/* What draws a frame: g, the canvas; at[v], the pixels of a vertex; the outline of an element. */
function painter(frame, canvas = sizeOf('view')) {
  const magnify = view.magnify || run.magnify || findMagnification(frame);
  const p = { ...canvas, frame, magnify };
  const { s, to } = findScale(p.w, p.h), m = p.magnify - 1;
  const at = rows(frame, 'v').map(([x, y, u, v]) => to(x + m * u, y + m * v));
  const outline = ([, first, n]) => trace(p.g, at.slice(first, first + n), true);
  const thin = Math.min(1, Math.sqrt(p.w * p.h / run.blocks.length) / 30);     /* for many blocks */
  return { ...p, s, at, outline, thin, corner: d => at[run.d[3 * d]] };
}

function hatch() {
  const tile = Object.assign(document.createElement('canvas'), { width: 8, height: 8 });
  const g = tile.getContext('2d');
  paint(g, () => g.rect(0, 0, 8, 8), { fill: css('--held') });
  paint(g, () => [-8, 0, 8].forEach(x => trace(g, [[x, 8], [x + 8, 0]])),
    { line: css('--hatch'), width: 1.5 });
  return g.createPattern(tile, 'repeat');
}

/* Returns the field that the colours show, with its range in the blocks that are free. */
function drawBlocks({ g, frame, outline, at, thin }) {
  const [name, of, unit] = OF_ELEMENT.find(row => row[0] === view.colour) ?? [], held = hatch();
  const free = run.blocks.filter(b => !b.held).flatMap(b => b.elements);
  const values = of ? free.map(([k]) => frame.e[STRIDE.e * k + of]) : [];
  const [least, high] = [Math.min, Math.max].map(f => values.reduce((a, b) => f(a, b), values[0]));
  const low = Math.abs(least) < 1e-6 * high ? 0 : least;
  values.forEach((a, k) => paint(g, () => outline(free[k]),
    { fill: viridis((a - low) / (high - low || 1)) }));
  Map.groupBy(run.blocks, b => b.held ? held : of ? null : TINTS[b.tint]).forEach((blocks, fill) =>
    paint(g, () => blocks.forEach(b => b.elements.forEach(outline)),
      { line: '#667788', width: 0.5 * thin, fill }));
  paint(g, () => rows(frame, 'd').forEach(([p, q]) => trace(g, [at[p], at[q]])),
    { line: css('--ink'), width: 1.3 * thin });
  return name && { name, unit, low, high };
}

/* A triangle holds both directions, a circle one; at the side of the block that is nearest, and 8
 * pixels apart or more. */
function drawSupports({ g, at }) {
  let last = [-99, -99];
  rows(run, 'v').forEach(([x, y, , , held, b], k) => {
    const { box: [x0, y0, x1, y1], held: isFixed } = run.blocks[b];
    if (!held || isFixed || Math.hypot(at[k][0] - last[0], at[k][1] - last[1]) < 8)
      return;
    const sides = [[y - y0, 0], [x - x0, 1], [y1 - y, 2], [x1 - x, 3]].sort((p, q) => p[0] - q[0]);
    const side = sides.find(([, turn]) => held === 3 || turn % 2 === held % 2)[1];
    last = at[k];
    paint(g, () => {
      trace(g, [[-8, 11], [8, 11]]);
      if (held === 3)
        trace(g, [[0, 0], [5.5, 11], [-5.5, 11]], true);
      else
        g.arc(0, 5.5, 5.5, Math.PI / 2, 2.5 * Math.PI);
    }, { fill: css('--paper'), line: css('--ink'), width: 1 }, last, side * Math.PI / 2);
  });
}

/* Contact forces act on what is carried, so they point up. Loads end where they act, those of an
 * edge 16 pixels apart. */
function findArrows({ frame, at, corner }) {
  const arrows = rows(frame, 'c').filter(c => c[2]).map(([c, , kind, fx, fy]) => ({ kind,
    x: corner(c)[0], y: corner(c)[1], fx: fy < 0 ? -fx : fx, fy: Math.abs(fy) }));
  for (const [a, b, fx, fy] of rows(frame, 'l')) {
    const [xa, ya] = at[a], [xb, yb] = at[b] ?? at[a];
    const n = Math.max(1, Math.floor(Math.hypot(xb - xa, yb - ya) / 16));
    arrows.push(...times(n, i => ({ kind: b < 0 ? 3 : 4, fx, fy, x: xa + (i + 0.5) / n * (xb - xa),
      y: ya + (i + 0.5) / n * (yb - ya) })));
  }
  return arrows;
}

/* Those under 2 pixels are left out. Returns the legend: what is largest of each kind. */
function drawForces(p) {
  const { g } = p, all = findArrows(p);
  const size = list => largest(list.map(a => Math.hypot(a.fx, a.fy)));
  const free = run.blocks.filter(b => !b.held).map(({ box: B }) => (B[2] - B[0]) * (B[3] - B[1]));
  const contacts = size(all.filter(a => a.kind < 3));
  const length = Math.max(16, Math.min(48, 0.9 * p.s * Math.sqrt(largest(free))));
  return ARROWS.flatMap(([kind, name, unit, colour, dash]) => {
    const mine = all.filter(a => a.kind === kind), most = size(mine), line = css(colour);
    const draw = (points, style) => paint(g, () => mine.forEach(({ x, y, fx, fy }) => {
      const f = Math.hypot(fx, fy), l = f * (kind < 3 ? length / contacts : 40 / most);
      if (l >= 2)
        trace(g, points(l, kind < 3 ? l : 0, Math.min(6, l / 2)).map(([along, across]) =>
          [x + (along * fx + across * fy) / f, y - (along * fy - across * fx) / f]));
    }), { line, width: 2, ...style });
    draw((l, tip) => [[tip - l, 0], [tip, 0]], { dash });
    draw((l, tip, head) => [[tip - head, head / 2], [tip, 0], [tip - head, -head / 2]]);
    return mine.length ? [{ name: `${name} ${quantity(most, unit)}`, line, dash }] : [];
  });
}

/* Through each block that two others press together, from where the force of the one acts to that
 * of the other, as draw_thrust in scene.c. */
function drawThrust({ g, frame, corner }) {
  const felt = run.blocks.map(() => new Map()), line = css('--thrust');
  for (const [c, e, state, fx, fy, N] of rows(frame, 'c')) {
    const pair = [c, e].map(d => run.d[3 * d + 2]), [x, y] = corner(c);
    [1, -1].forEach((sign, k) => state && felt[pair[k]].set(pair[1 - k], [N * x, N * y, sign * fx,
      -sign * fy, N].map((a, i) => a + (felt[pair[k]].get(pair[1 - k])?.[i] ?? 0))));
  }
  let lines = felt.map((by, k) => {
    const [[x, y, fx, fy, N], [X, Y, FX, FY, M]] = [...by.values(), [], []];
    const way = [X / M - x / N, Y / M - y / N], force = Math.hypot(fx, fy) + Math.hypot(FX, FY);
    return by.size === 2 && !run.blocks[k].held && N > 0 && M > 0 && (fx - FX) * way[0] +
      (fy - FY) * way[1] > 0.5 * Math.hypot(...way) * force && [[x / N, y / N], [X / M, Y / M]];
  });
  const ends = (l, k) => l && [...felt[k].keys()].some(o => !lines[o] && !run.blocks[o].held &&
    felt[o].size > 1);
  while (lines.some(ends))
    lines = lines.map((l, k) => !ends(l, k) && l);
  paint(g, () => lines.forEach(l => l && trace(g, l)), { line, width: 2.5 });
  return lines.some(l => l) ? [{ name: 'line of thrust', line }] : [];
}

function drawBolts({ g, frame, at }) {
  const ends = rows(frame, 'b').map(([a, b, c, ...share]) => [0, 1].map(k =>
    share[0] * at[a][k] + share[1] * at[b][k] + share[2] * at[c][k]));
  paint(g, () => ends.forEach((end, k) => k % 2 && trace(g, [ends[k - 1], end])),
    { line: css('--ink'), width: 3 });
}

/* From where the node of a monitor is to a ring where a wrong prediction has it. */
function drawPrediction({ g, frame, magnify, h, w }) {
  const [k, kind, value] = rows(frame, 'x').at(-1) ?? [], name = run.monitors[k]?.[0];
  const place = is('text').value.match(
    RegExp(`^\\s*monitor\\s+${name}\\s+at\\s+(${NUMBER})\\s+(${NUMBER})`, 'm'));
  if (!place || !isSecret() || run.state !== 1)
    return;
  const at = [0, 1].map(a => +place[a + 1] + magnify * frame.o[4 * k + a]), line = css('--pick');
  const ring = at.with(kind, +place[kind + 1] + magnify * value), { to } = findScale(w, h);
  paint(g, () => trace(g, [to(...at), to(...ring)]), { line, width: 3 });
  paint(g, () => g.arc(0, 0, 8, 0, 7), { line, width: 3 }, to(...ring));
}

/* A state as a shape, so that colour alone says nothing: a ring, a square, a triangle. */
function drawState(g, place, state, r) {
  paint(g, [() => g.arc(0, 0, r - 1, 0, 7), () => g.rect(-r, -r, 2 * r, 2 * r),
    () => trace(g, [[0, -1.3 * r], [1.2 * r, 0.9 * r], [-1.2 * r, 0.9 * r]], true)][state],
  { fill: css(['--paper', '--lock', '--slide'][state]), line: css('--ink') }, place);
}

/* Names beside their lines, in rows from y on. Returns the y of the last one. */
function drawNames(g, w, y, names) {
  let x = 8;
  for (const { name, line, dash, length = 20 } of names) {
    const width = length + 12 + g.measureText(name).width;
    if (x + width > w)
      [x, y] = [8, y + 15];
    paint(g, () => trace(g, [[x, y], [x + length, y]]), { line, dash, width: 1.8 });
    g.fillText(name, x + length + 4, y + 4);
    x += width;
  }
  return y;
}

function drawLegend({ g, w, h, s, magnify }, legend, field) {
  const metre = roundDown(120 / s), ink = css('--ink');
  Object.assign(g, { font: `14px ${css('--sans')}`, fillStyle: ink });
  const bar = { name: quantity(metre, 'm'), line: ink, length: metre * s };
  drawNames(g, w, h - 14, [bar, ...legend]);
  g.textAlign = 'right';
  if (magnify !== 1)
    g.fillText(`displacements x ${magnify}`, w - 14, 62);
  if (!field)
    return;
  const [low, high] = [field.low, field.high].map(a => quantity(a, field.unit));
  g.fillText(`${field.name}: ${low} to ${high}`, w - 14, 42);
  times(100, k => paint(g, () => g.rect(w - 214 + 2 * k, 12, 3, 12), { fill: viridis(k / 99) }));
}

function drawPicture(frame, look) {
  const p = painter(frame, begin('view')), { g } = p, field = drawBlocks(p), line = css('--pick');
  drawSupports(p);
  drawBolts(p);
  const legend = is('forces').checked && !look ? [...drawForces(p), ...drawThrust(p)] : [];
  for (const [corner, , from, to] of look?.contacts ?? [])
    drawState(g, p.corner(corner), to, from === to ? 4 : 7);
  if (view.element >= 0)
    paint(g, () => p.outline(rows(frame, 'e')[view.element].subarray(22)), { line, width: 4 });
  if (view.contact)
    paint(g, () => g.arc(...p.corner(view.contact[0]), 12, 0, 7), { line, width: 3 });
  drawPrediction(p);
  drawLegend(p, legend, field);
  drawHands(p);
}

/* The element at a pixel, or -1. */
function findElement(frame, x, y, p = painter(frame)) {
  return rows(frame, 'e').findLastIndex(e =>
    isInside(p.g, () => p.outline(e.subarray(22)), x, y));
}

/* What lies at a pixel: an element, -1 if there is none; and a contact. */
function findAt(frame, x, y) {
  const p = painter(frame), far = c => Math.hypot(p.corner(c[0])[0] - x, p.corner(c[0])[1] - y);
  const near = rows(frame, 'c').find(c => c[2] && far(c) < 10);
  return near ? [-1, near] : [findElement(frame, x, y, p), null];
}
