/* picture.js - the blocks on a canvas, with the tints, colours and symbols of the SVGs (scene.c).
 *
 * `view` has what a person chooses; findShape gathers what stays as long as the model does. */
'use strict';

const TINTS = ['#f6cf8b', '#b3dcf5', '#8fd3bd', '#f7f0a6', '#e6c3d7', '#eba98f'];
const VIRIDIS = [[68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142],
  [31, 158, 137], [53, 183, 121], [109, 205, 89], [180, 222, 44], [253, 231, 37]];
const STATES = ['OPEN', 'LOCK', 'SLIDE'];
const FIELDS = { u: ['displacement', 'm', e => Math.hypot(e[17], e[18])],
  mises: ['von Mises', 'Pa', e => e[16]], sxx: ['sxx', 'Pa', e => e[12]],
  syy: ['syy', 'Pa', e => e[13]], sxy: ['sxy', 'Pa', e => e[14]] };
const view = { zoom: 1, x: 0, y: 0, magnify: 1, colour: 'block', forces: true };

const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const largest = values => values.reduce((a, b) => Math.max(a, b), 0);
const times = (n, make) => Array.from({ length: n }, (_, k) => make(k));

/* A number with its unit, k, M, G or m, u, n before it. */
function quantity(x, unit) {
  const power = x === 0 ? 0 : Math.floor(Math.log10(Math.abs(x)) / 3 + 1e-9);
  const p = Math.max(-3, Math.min(3, power));
  return `${+(x / 1000 ** p).toPrecision(3)} ${['n', 'u', 'm', '', 'k', 'M', 'G'][p + 3]}${unit}`;
}

/* A canvas as sharp as the screen, empty. */
function begin(id) {
  const canvas = document.getElementById(id), g = canvas.getContext('2d');
  const w = canvas.clientWidth, h = canvas.clientHeight;
  Object.assign(canvas, { width: w * devicePixelRatio, height: h * devicePixelRatio });
  g.scale(devicePixelRatio, devicePixelRatio);
  return { g, w, h };
}

/* Lines or an outline through points in pixels, into the path in hand. */
function trace(g, points, closed) {
  points.forEach(([x, y], k) => { k ? g.lineTo(x, y) : g.moveTo(x, y); });
  if (closed)
    g.closePath();
}

/* Draws a path: filled, then its line. */
function paint(g, path, { fill, line, width = 1.3, dash = [] }) {
  g.beginPath();
  path();
  Object.assign(g, { fillStyle: fill, strokeStyle: line, lineWidth: width });
  g.setLineDash(dash);
  if (fill)
    g.fill();
  if (line)
    g.stroke();
  g.setLineDash([]);
}

/* The blocks: their elements, edges, boxes, tints, and whether all of one is held. Of held vertices
 * the directions; at a vertex, the outward normal of its block. */
function findShape() {
  const v = run.frames[0].v, directions = new Map(), normals = new Map(), blocks = [], node = [],
    blockOf = [];
  for (let k = 0; k < count(run.held, 'h'); k++)
    directions.set(...row(run.held, 'h', k));
  for (let e = 0; e < count(run.mesh, 'a'); e++) {
    const [first, n, b] = row(run.mesh, 'a', e);
    const block = blocks[b] ??= { elements: [], edges: [], held: true, box: [1 / 0, 1 / 0, -1 / 0,
      -1 / 0] };
    block.elements.push(e);
    for (let k = first; k < first + n; k++) {
      const [x, y] = row(v, 'v', k), [x0, y0, x1, y1] = block.box;
      block.held &&= directions.get(k) === 3;
      blockOf[k] = b;
      node[k] = `${b} ${x} ${y}`;
      block.box = [Math.min(x0, x), Math.min(y0, y), Math.max(x1, x), Math.max(y1, y)];
    }
  }
  for (let d = 0; d < count(run.edges, 'd'); d++) {
    const [a, b, block] = row(run.edges, 'd', d), [xa, ya] = row(v, 'v', a), [xb, yb] = row(v, 'v',
      b);
    const weight = directions.has(a) && directions.get(a) === directions.get(b) ? 1 : 1e-6;
    blocks[block].edges.push(d);
    for (const end of [a, b]) {
      const [x, y] = normals.get(node[end]) ?? [0, 0];
      normals.set(node[end], [x + weight * (yb - ya), y + weight * (xa - xb)]);
    }
  }
  blocks.forEach((block, k) => { block.tint = chooseTint(blocks.slice(0, k), block.box); });
  const low = k => Math.min(...blocks.map(b => b.box[k])), high = k => -Math.min(...blocks.map(b =>
    -b.box[k]));
  const normalAt = k => normals.get(node[k]) ?? [0, 0];
  run.shape = { blocks, directions, normalAt, blockOf, box: [low(0), low(1), high(2), high(3)] };
}

/* The one whose nearest block is farthest, as choose_tint in scene.c. */
function chooseTint(others, A) {
  const nearest = TINTS.map(() => Infinity);
  for (const { held, box: B, tint } of others) {
    const gap = [0, 1].map(k => Math.max(0, A[k] - B[k + 2], B[k] - A[k + 2]));
    const way = [0, 1].map(k => (A[k] + A[k + 2] - B[k] - B[k + 2]) / 2);
    if (!held)
      nearest[tint] = Math.min(nearest[tint], Math.hypot(...gap) + 0.01 * Math.hypot(...way));
  }
  return nearest.indexOf(Math.max(...nearest));
}

/* 1, 2 or 5 times a power of ten: the largest displacement becomes about a tenth of the model. */
function findMagnification(frame) {
  const most = largest(times(count(frame.v, 'v'), k => Math.hypot(...row(frame.v, 'v',
    k).subarray(2))));
  const [x0, y0, x1, y1] = run.shape.box, size = Math.max(x1 - x0, y1 - y0);
  const wanted = most > 1e-12 * size ? 0.1 * size / most : 1,
    ten = 10 ** Math.floor(Math.log10(wanted));
  return frame.scale || Math.max(1, ten * [5, 2, 1].find(f => f * ten <= wanted));
}

/* From metres to pixels, so that the model as it begins fits between the margins. */
function findScale(w, h) {
  const [x0, y0, x1, y1] = run.shape.box, top = view.colour !== 'block' || view.magnify !== 1 ?
    60 : 0;
  const s = view.zoom * Math.min((w - 60) / (x1 - x0), (h - 110 - top) / (y1 - y0));
  const x = w / 2 + view.x - s * (x0 + x1) / 2, y = (h + top) / 2 - 10 + view.y + s * (y0 + y1) / 2;
  return { s, to: (X, Y) => [x + s * X, y - s * Y] };
}

function viridis(share) {
  const at = Math.min(8.999, Math.max(0, 9 * share)), k = Math.floor(at);
  return `rgb(${VIRIDIS[k].map((c, i) => Math.round(c + (at - k) * (VIRIDIS[k + 1][i] - c)))})`;
}

/* What draws a frame: g, the canvas; at(v), the pixels of a vertex; the outline of an element. */
function painter(frame) {
  const p = { ...begin('view'), frame }, scale = findScale(p.w, p.h);
  const at = v => {
    const [x, y, dx, dy] = row(frame.v, 'v', v);
    return scale.to(x + (view.magnify - 1) * dx, y + (view.magnify - 1) * dy);
  };
  const outline = e => trace(p.g, times(run.mesh[7 * e + 1], k => at(run.mesh[7 * e] + k)), true);
  const corner = k => at(run.edges[3 * k]);
  return Object.assign(p, { s: scale.s, at, outline, corner });
}

function hatch() {
  const tile = Object.assign(document.createElement('canvas'), { width: 8, height: 8 }),
    g = tile.getContext('2d');
  paint(g, () => g.rect(0, 0, 8, 8), { fill: css('--held') });
  for (const x of [-8, 0, 8])
    paint(g, () => trace(g, [[x, 8], [x + 8, 0]]), { line: css('--hatch'), width: 1.5 });
  return g.createPattern(tile, 'repeat');
}

/* Returns the field that the colours show, with its range. */
function drawBlocks({ g, frame, outline, at }) {
  const [name, unit, of] = FIELDS[view.colour] ?? [], held = hatch();
  const values = of ? times(count(run.mesh, 'a'), e => of(row(frame.e, 'e', e))) : [];
  const low = Math.min(...values), high = Math.max(...values);
  for (const block of run.shape.blocks) {
    const edges = () => block.edges.forEach(d => trace(g,
      [0, 1].map(k => at(run.edges[3 * d + k]))));
    for (const e of of && !block.held ? block.elements : [])
      paint(g, () => outline(e),
        { fill: viridis(high > low ? (values[e] - low) / (high - low) : 0.5) });
    paint(g, () => block.elements.forEach(outline), { line: '#667788', width: 0.5,
      fill: block.held ? held : of ? null : TINTS[block.tint] });
    paint(g, edges, { line: css('--ink') });
  }
  return name && { name, unit, low, high };
}

/* A triangle holds both directions, a circle one; they stand 8 pixels apart or more. */
function drawSupports({ g, at }) {
  const last = {}, style = { fill: css('--paper'), line: css('--ink'), width: 1 };
  for (const [v, held] of run.shape.directions) {
    let [nx, ny] = run.shape.normalAt(v);
    const [x, y] = at(v), [lx, ly] = last[held] ?? [-99, -99];
    if (run.shape.blocks[run.shape.blockOf[v]].held || Math.hypot(x - lx, y - ly) < 8)
      continue;
    last[held] = [x, y];
    if (held !== 3)
      [nx, ny] = held === 1 ? [nx < 0 ? -1 : 1, 0] : [0, ny > 0 ? 1 : -1];
    else if (nx === 0 && ny === 0)
      ny = -1;
    const l = 11 / Math.hypot(nx, ny), dx = l * nx, dy = -l * ny;
    paint(g, () => {
      if (held === 3)
        trace(g, [[x, y], [x + dx - dy / 2, y + dy + dx / 2], [x + dx + dy / 2, y + dy - dx / 2]],
          true);
      else
        g.arc(x + dx / 2, y + dy / 2, 5.5, 0, 7);
      trace(g, [[x + dx - 0.7 * dy, y + dy + 0.7 * dx], [x + dx + 0.7 * dy, y + dy - 0.7 * dx]]);
    }, style);
  }
}

/* Arrows, the longest of `most` pixels; those under 2 pixels are left out. */
function drawArrows(g, arrows, most, line, dash) {
  const size = largest(arrows.map(a => Math.hypot(a.fx, a.fy)));
  for (const { x, y, fx, fy, ends } of arrows) {
    const dx = most * fx / size, dy = -most * fy / size, l = Math.hypot(dx, dy);
    const hx = Math.min(6, l / 2) * dx / l, hy = Math.min(6, l / 2) * dy / l;
    const [X, Y] = ends ? [x - dx, y - dy] : [x, y], tip = [X + dx, Y + dy];
    if (!(l >= 2))
      continue;
    paint(g, () => trace(g, [[X, Y], tip]), { line, width: 2, dash });
    paint(g, () => trace(g, [[tip[0] - hx + hy / 2, tip[1] - hy - hx / 2], tip,
      [tip[0] - hx - hy / 2, tip[1] - hy + hx / 2]]), { line, width: 2 });
  }
  return size;
}

/* Loads, spread along their edges; the forces on what is carried, so they point up. */
function drawForces(p) {
  const legend = [], loads = [[], []], blue = css('--lock'), orange = css('--slide'),
    pink = css('--load');
  for (let k = 0; k < count(p.frame.l, 'l'); k++) {
    const [a, b, fx, fy] = row(p.frame.l, 'l', k), [xa, ya] = p.at(a);
    const [xb, yb] = b < 0 ? [xa, ya] : p.at(b);
    const n = b < 0 ? 1 : Math.max(1, Math.floor(Math.hypot(xb - xa, yb - ya) / 16));
    const [nx, ny] = b < 0 ? run.shape.normalAt(a) : [ya - yb, xb - xa];
    loads[+(b >= 0)].push(...times(n, i => ({ fx, fy, ends: fx * nx - (b < 0 ? -fy : fy) * ny < 0,
      x: xa + (i + 0.5) / n * (xb - xa), y: ya + (i + 0.5) / n * (yb - ya) })));
  }
  loads.forEach((list, k) => list.length && legend.push([pink, [],
    `load ${quantity(drawArrows(p.g, list, k ? 24 : 40, pink, []), k ? 'N/m' : 'N')}`]));
  const forces = times(count(p.frame.c, 'c'), k => {
    const [corner, , state, , , fx, fy] = row(p.frame.c, 'c', k), [x, y] = p.corner(corner),
      up = fy < 0 ? -1 : 1;
    return { x, y, fx: up * fx, fy: up * fy, state };
  });
  const closed = forces.filter(a => a.state);
  const size = list => largest(list.map(a => Math.hypot(a.fx, a.fy)));
  const free = run.shape.blocks.filter(b => !b.held).map(({ box: B }) =>
    (B[2] - B[0]) * (B[3] - B[1]));
  const length = Math.max(16, Math.min(48, 0.9 * p.s * Math.sqrt(largest(free))));
  const kinds = [[1, 'locked', blue, []], [2, 'sliding', orange, [4, 3]]];
  for (const [state, name, colour, dash] of kinds) {
    const mine = closed.filter(a => a.state === state);
    drawArrows(p.g, mine, length * size(mine) / (size(closed) || 1), colour, dash);
    if (mine.length)
      legend.push([colour, dash, `${name} ${quantity(size(mine), 'N')}`]);
  }
  return legend;
}

/* A state as a shape, so that colour alone says nothing: a ring, a square, a triangle. */
function drawState(g, [x, y], state, size) {
  paint(g, [() => g.arc(x, y, size - 1, 0, 7), () => g.rect(x - size, y - size, 2 * size, 2 * size),
    () => trace(g, [[0, -1.3], [1.2, 0.9], [-1.2, 0.9]]
      .map(([a, b]) => [x + size * a, y + size * b]), true)][state],
  { fill: css(['--paper', '--lock', '--slide'][state]), line: css('--ink') });
}

function drawLegend({ g, w, h, s }, legend, bar) {
  const metre = 10 ** Math.floor(Math.log10(120 / s)), right = ['', ''];
  let x = 12;
  const entry = (line, dash, length, text) => {
    paint(g, () => trace(g, [[x, h - 14], [x + length, h - 14]]), { line, width: 2, dash });
    g.fillStyle = css('--ink');
    g.fillText(text, x + length + 6, h - 9);
    x += length + 22 + g.measureText(text).width;
  };
  g.font = `14px ${css('--sans')}`;
  entry(css('--ink'), [], metre * s, quantity(metre, 'm'));
  legend.forEach(([colour, dash, text]) => entry(colour, dash, 26, text));
  for (let k = 0; bar && k < 200; k++)
    paint(g, () => g.rect(w - 215 + k, 12, 1.5, 12), { fill: viridis(k / 199) });
  if (bar)
    right[0] = `${bar.name}: ${quantity(bar.low, bar.unit)} to ${quantity(bar.high, bar.unit)}`;
  if (view.magnify !== 1)
    right[1] = `displacements x ${view.magnify}`;
  g.fillStyle = css('--ink');
  right.forEach((text, k) => g.fillText(text, w - 14 - g.measureText(text).width, 42 + 20 * k));
}

function drawPicture(frame, picked, look) {
  const p = painter(frame), { g } = p, bar = drawBlocks(p), mark = css('--pick');
  drawSupports(p);
  const legend = view.forces && !look ? drawForces(p) : [];
  if (picked.element >= 0)
    paint(g, () => p.outline(picked.element), { line: mark, width: 4 });
  for (const c of look ? look.contacts : [])
    drawState(g, p.corner(c.corner), c.to, c.from === c.to ? 4 : 7);
  if (picked.contact)
    paint(g, () => g.arc(...p.corner(picked.contact[0]), 12, 0, 7), { line: mark, width: 3 });
  drawLegend(p, legend, bar);
}

/* What lies at a pixel: a contact as [corner, edge], or an element. */
function findAt(frame, x, y) {
  const p = painter(frame), all = times(count(frame.c, 'c'), k => row(frame.c, 'c', k));
  const contacts = all.filter(c => c[2]);
  const far = c => Math.hypot(p.corner(c[0])[0] - x, p.corner(c[0])[1] - y);
  const [near] = contacts.sort((a, b) => far(a) - far(b));
  if (near && far(near) < 10)
    return { element: -1, contact: [near[0], near[1]] };
  return { contact: null, element: times(count(run.mesh, 'a'), e => e).findLast(e => {
    p.g.beginPath();
    p.outline(e);
    return p.g.isPointInPath(x * devicePixelRatio, y * devicePixelRatio);
  }) ?? -1 };
}
