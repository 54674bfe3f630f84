/* picture.js - the blocks on a canvas: tints, colours and symbols as in the SVGs of ./bbm (scene.c).
 *
 * `view` has what a person chooses; shape() gathers once what stays as long as the model does. */
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

/* A number with its unit, k, M, G or m, u, n before it. */
function quantity(x, unit, digits = 3) {
  const power = x === 0 || unit === '' ? 0 : Math.floor(Math.log10(Math.abs(x)) / 3 + 1e-9);
  const p = Math.max(-3, Math.min(3, power));
  return `${+(x / 1000 ** p).toPrecision(digits)} ${['n', 'u', 'm', '', 'k', 'M', 'G'][p + 3]}${unit}`;
}

/* A canvas as sharp as the screen, empty. */
function begin(id) {
  const canvas = document.getElementById(id), g = canvas.getContext('2d');
  const w = canvas.clientWidth, h = canvas.clientHeight, sharp = devicePixelRatio;
  canvas.width = w * sharp;
  canvas.height = h * sharp;
  g.setTransform(sharp, 0, 0, sharp, 0, 0);
  return { g, w, h };
}

/* Which elements a block has, whether all of it is held, its box, a tint unlike its neighbours'. */
function shape() {
  const { mesh, edges, held } = run, v = run.frames[0].v, directions = new Map(), blocks = [];
  for (let k = 0; k < count(held, 'h'); k++)
    directions.set(held[2 * k], held[2 * k + 1]);
  for (let e = 0; e < count(mesh, 'a'); e++) {
    const [first, n, b] = row(mesh, 'a', e);
    const block = blocks[b] ??= { elements: [], edges: [], held: true, box: [1 / 0, 1 / 0, -1 / 0, -1 / 0] };
    block.elements.push(e);
    for (let k = first; k < first + n; k++) {
      const [x, y] = row(v, 'v', k), B = block.box;
      block.held &&= directions.get(k) === 3;
      block.box = [Math.min(B[0], x), Math.min(B[1], y), Math.max(B[2], x), Math.max(B[3], y)];
    }
  }
  const normals = new Map();
  for (let d = 0; d < count(edges, 'd'); d++) {
    const [a, b, block] = row(edges, 'd', d), [xa, ya] = row(v, 'v', a), [xb, yb] = row(v, 'v', b);
    const weight = directions.has(a) && directions.get(a) === directions.get(b) ? 1 : 1e-6;
    blocks[block].edges.push(d);
    for (const end of [a, b]) {
      const n = normals.get(end) ?? [0, 0];
      normals.set(end, [n[0] + weight * (yb - ya), n[1] + weight * (xa - xb)]);
    }
  }
  blocks.forEach((block, k) => { block.tint = chooseTint(blocks.slice(0, k), block.box); });
  run.shape = { blocks, directions, normals };
}

/* The one whose nearest block is farthest, as choose_tint in scene.c. */
function chooseTint(others, A) {
  const nearest = TINTS.map(() => Infinity);
  for (const { held, box: B, tint } of others) {
    if (held)
      continue;
    const gap = [0, 1].map(k => Math.max(0, A[k] - B[k + 2], B[k] - A[k + 2]));
    const way = [0, 1].map(k => (A[k] + A[k + 2] - B[k] - B[k + 2]) / 2);
    nearest[tint] = Math.min(nearest[tint], Math.hypot(...gap) + 0.01 * Math.hypot(...way));
  }
  return nearest.indexOf(Math.max(...nearest));
}

/* 1, 2 or 5 times a power of ten: the largest displacement becomes about a tenth of the model. */
function findMagnification(frame) {
  let most = 0;
  for (let k = 0; k < count(frame.v, 'v'); k++)
    most = Math.max(most, Math.hypot(frame.v[4 * k + 2], frame.v[4 * k + 3]));
  const boxes = run.shape.blocks.map(b => b.box);
  const size = Math.max(...[0, 1].map(k => Math.max(...boxes.map(b => b[k + 2])) -
    Math.min(...boxes.map(b => b[k]))));
  const wanted = most > 1e-12 * size ? 0.1 * size / most : 1, ten = 10 ** Math.floor(Math.log10(wanted));
  return frame.scale || Math.max(1, ten * [5, 2, 1].find(f => f * ten <= wanted));
}

/* From metres to pixels and back, so that the model as it begins fits between the margins. */
function findScale(w, h) {
  const boxes = run.shape.blocks.map(b => b.box);
  const low = [0, 1].map(k => Math.min(...boxes.map(b => b[k])));
  const high = [0, 1].map(k => Math.max(...boxes.map(b => b[k + 2])));
  const s = view.zoom * Math.min((w - 60) / (high[0] - low[0]), (h - 110) / (high[1] - low[1]));
  const x = w / 2 + view.x - s * (low[0] + high[0]) / 2;
  const y = h / 2 - 10 + view.y + s * (low[1] + high[1]) / 2;
  return { s, to: (X, Y) => [x + s * X, y - s * Y], back: (px, py) => [(px - x) / s, (y - py) / s] };
}

function viridis(share) {
  const at = Math.min(8.999, Math.max(0, 9 * share)), k = Math.floor(at);
  return `rgb(${VIRIDIS[k].map((c, i) => Math.round(c + (at - k) * (VIRIDIS[k + 1][i] - c)))})`;
}

/* What draws a frame: g, the canvas; at(v), the pixels of a vertex. */
function painter(frame) {
  const { g, w, h } = begin('view'), scale = findScale(w, h), more = view.magnify - 1;
  const place = v => {
    const [x, y, dx, dy] = row(frame.v, 'v', v);
    return scale.to(x + more * dx, y + more * dy);
  };
  const path = (points, close) => {
    points.forEach(([x, y], k) => { k ? g.lineTo(x, y) : g.moveTo(x, y); });
    if (close)
      g.closePath();
  };
  const outline = e => {
    const [first, n] = row(run.mesh, 'a', e);
    path(Array.from({ length: n }, (_, k) => place(first + k)), true);
  };
  return { g, w, h, frame, scale, at: place, path, outline };
}

function hatch(g) {
  const tile = document.createElement('canvas'), t = tile.getContext('2d');
  tile.width = tile.height = 8;
  t.fillStyle = css('--held');
  t.fillRect(0, 0, 8, 8);
  t.strokeStyle = css('--hatch');
  t.lineWidth = 1.5;
  for (const x of [-8, 0, 8]) {
    t.moveTo(x, 8);
    t.lineTo(x + 8, 0);
  }
  t.stroke();
  return g.createPattern(tile, 'repeat');
}

function drawBlocks(p) {
  const { g, frame } = p, field = FIELDS[view.colour], held = hatch(g);
  const values = field && run.mesh.length ? Array.from({ length: count(run.mesh, 'a') },
    (_, e) => field[2](row(frame.e, 'e', e))) : [];
  const low = Math.min(...values), high = Math.max(...values);
  for (const block of run.shape.blocks) {
    const fill = () => { g.beginPath(); block.elements.forEach(p.outline); g.fill(); };
    g.fillStyle = block.held ? held : TINTS[block.tint];
    if (!field || block.held)
      fill();
    for (const e of field && !block.held ? block.elements : []) {
      g.fillStyle = viridis(high > low ? (values[e] - low) / (high - low) : 0.5);
      g.beginPath();
      p.outline(e);
      g.fill();
    }
    g.strokeStyle = '#667788';
    g.lineWidth = 0.5;
    g.beginPath();
    block.elements.forEach(p.outline);
    g.stroke();
    g.strokeStyle = css('--ink');
    g.lineWidth = 1.3;
    g.beginPath();
    for (const d of block.edges)
      p.path([0, 1].map(k => p.at(run.edges[3 * d + k])));
    g.stroke();
  }
  return field && { name: field[0], unit: field[1], low, high };
}

/* Supports stand outside: a triangle holds both directions, a circle one; 8 pixels apart or more. */
function drawSupports(p) {
  const { g } = p, size = 11, last = {};
  g.fillStyle = css('--paper');
  g.strokeStyle = css('--ink');
  g.lineWidth = 1;
  for (const [v, held] of run.shape.directions) {
    const block = run.shape.blocks[run.mesh[7 * (run.vertexElement ??= ownerOfVertices())[v] + 2]];
    const [x, y] = p.at(v), [lx, ly] = last[held] ?? [-99, -99];
    if (block.held || Math.hypot(x - lx, y - ly) < 8)
      continue;
    last[held] = [x, y];
    let [nx, ny] = run.shape.normals.get(v) ?? [0, -1];
    if (held !== 3)
      [nx, ny] = held === 1 ? [nx < 0 ? -1 : 1, 0] : [0, ny > 0 ? 1 : -1];
    const l = Math.hypot(nx, ny) || 1, dx = size * nx / l, dy = -size * ny / l;
    g.beginPath();
    if (held === 3)
      p.path([[x, y], [x + dx - dy / 2, y + dy + dx / 2], [x + dx + dy / 2, y + dy - dx / 2]], true);
    else
      g.arc(x + dx / 2, y + dy / 2, size / 2, 0, 7);
    p.path([[x + dx - 0.7 * dy, y + dy + 0.7 * dx], [x + dx + 0.7 * dy, y + dy - 0.7 * dx]]);
    g.fill();
    g.stroke();
  }
}

function ownerOfVertices() {
  const owner = [];
  for (let e = 0; e < count(run.mesh, 'a'); e++)
    for (let k = 0; k < run.mesh[7 * e + 1]; k++)
      owner[run.mesh[7 * e] + k] = e;
  return owner;
}

/* Arrows of one kind, the longest of `most` pixels; those under 2 pixels are left out. */
function drawArrows(p, arrows, most, colour, dash = []) {
  const { g } = p, largest = Math.max(0, ...arrows.map(a => Math.hypot(a.fx, a.fy)));
  g.strokeStyle = colour;
  g.lineWidth = 2;
  for (const { x, y, fx, fy, ends } of arrows) {
    const dx = most * fx / largest, dy = -most * fy / largest, l = Math.hypot(dx, dy);
    if (!(l >= 2))
      continue;
    const hx = Math.min(6, l / 2) * dx / l, hy = Math.min(6, l / 2) * dy / l;
    const [X, Y] = ends ? [x - dx, y - dy] : [x, y], tip = [X + dx, Y + dy];
    g.setLineDash(dash);
    g.beginPath();
    p.path([[X, Y], tip]);
    g.stroke();
    g.setLineDash([]);
    g.beginPath();
    p.path([[tip[0] - hx + hy / 2, tip[1] - hy - hx / 2], tip,
      [tip[0] - hx - hy / 2, tip[1] - hy + hx / 2]]);
    g.stroke();
  }
  return largest;
}

/* The forces on what is carried, so they point up; loads, spread along their edges. */
function drawForces(p) {
  const legend = [], loads = [[], []], forces = [];
  for (let k = 0; k < count(p.frame.l, 'l'); k++) {
    const [a, b, fx, fy] = row(p.frame.l, 'l', k), A = p.at(a), B = b < 0 ? A : p.at(b);
    const n = b < 0 ? 1 : Math.max(1, Math.floor(Math.hypot(B[0] - A[0], B[1] - A[1]) / 16));
    const [nx, ny] = b < 0 ? run.shape.normals.get(a) ?? [0, 0] : [A[1] - B[1], A[0] - B[0]];
    for (let i = 0; i < n; i++) {
      const s = (i + 0.5) / n, ends = fx * nx + fy * (b < 0 ? ny : -ny) < 0;
      loads[+(b >= 0)].push({ x: A[0] + s * (B[0] - A[0]), y: A[1] + s * (B[1] - A[1]), fx, fy, ends });
    }
  }
  loads.forEach((list, k) => {
    const most = drawArrows(p, list, k ? 24 : 40, css('--load'));
    if (most > 0)
      legend.push([css('--load'), [], `load ${quantity(most, k ? 'N/m' : 'N')}`]);
  });
  for (let k = 0; k < count(p.frame.c, 'c'); k++) {
    const [, , state, , , fx, fy] = row(p.frame.c, 'c', k), up = fy < 0 ? -1 : 1;
    const [x, y] = placeOfContact(p, k);
    if (state)
      forces.push({ x, y, fx: up * fx, fy: up * fy, state });
  }
  const most = Math.max(0, ...forces.map(a => Math.hypot(a.fx, a.fy)));
  for (const [state, name, dash] of [[1, 'locked', []], [2, 'sliding', [4, 3]]]) {
    const mine = forces.filter(a => a.state === state), colour = css(state === 1 ? '--lock' : '--slide');
    const largest = Math.max(0, ...mine.map(a => Math.hypot(a.fx, a.fy)));
    drawArrows(p, mine, most > 0 ? 48 * largest / most : 0, colour, dash);
    if (mine.length)
      legend.push([colour, dash, `${name} ${quantity(largest, 'N')}`]);
  }
  return legend;
}

const placeOfContact = (p, k) => p.at(run.edges[3 * p.frame.c[13 * k]]);

/* A state as a shape, so that colour alone says nothing: a ring, a square, a triangle. */
function drawState(g, x, y, state, size = 5) {
  g.beginPath();
  if (state === 0)
    g.arc(x, y, size - 1, 0, 7);
  else if (state === 1)
    g.rect(x - size, y - size, 2 * size, 2 * size);
  else
    [[0, -1.3], [1.2, 0.9], [-1.2, 0.9]].forEach(([a, b], k) => {
      k ? g.lineTo(x + size * a, y + size * b) : g.moveTo(x + size * a, y + size * b);
    }), g.closePath();
  g.fillStyle = css(['--paper', '--lock', '--slide'][state]);
  g.strokeStyle = css('--ink');
  g.lineWidth = 1.2;
  g.fill();
  g.stroke();
}

function drawLegend(p, legend, bar) {
  const { g, w, h } = p, metre = 10 ** Math.floor(Math.log10(120 / p.scale.s));
  let x = 12;
  g.font = `14px ${css('--sans')}`;
  g.fillStyle = g.strokeStyle = css('--ink');
  g.lineWidth = 2;
  g.strokeRect(x, h - 14, metre * p.scale.s, 0.01);
  g.fillText(quantity(metre, 'm'), x, h - 20);
  x += Math.max(80, metre * p.scale.s + 24);
  for (const [colour, dash, text] of legend) {
    g.strokeStyle = colour;
    g.setLineDash(dash);
    g.beginPath();
    p.path([[x, h - 14], [x + 26, h - 14]]);
    g.stroke();
    g.setLineDash([]);
    g.fillText(text, x + 32, h - 9);
    x += 48 + g.measureText(text).width;
  }
  for (let k = 0; bar && k < 200; k++) {
    g.fillStyle = viridis(k / 199);
    g.fillRect(w - 215 + k, 12, 1.5, 12);
  }
  g.fillStyle = css('--ink');
  g.textAlign = 'right';
  if (bar)
    g.fillText(`${bar.name}: ${quantity(bar.low, bar.unit)} to ${quantity(bar.high, bar.unit)}`, w - 14, 42);
  if (view.magnify !== 1)
    g.fillText(`displacements x ${view.magnify}`, w - 14, bar ? 62 : 24);
  g.textAlign = 'left';
}

function drawPicture(frame, picked, look) {
  const p = painter(frame), { g } = p, bar = drawBlocks(p);
  drawSupports(p);
  const legend = view.forces && !look ? drawForces(p) : [];
  if (picked.element >= 0) {
    g.strokeStyle = css('--pick');
    g.lineWidth = 4;
    g.beginPath();
    p.outline(picked.element);
    g.stroke();
  }
  for (const c of look ? look.contacts : []) {
    const [x, y] = p.at(run.edges[3 * c.corner]);
    drawState(g, x, y, c.to, c.from === c.to ? 4 : 7);
  }
  if (picked.contact) {
    const [x, y] = p.at(run.edges[3 * picked.contact[0]]);
    g.strokeStyle = css('--pick');
    g.lineWidth = 3;
    g.beginPath();
    g.arc(x, y, 12, 0, 7);
    g.stroke();
  }
  drawLegend(p, legend, bar);
}

/* What lies at a pixel: a contact as [corner, edge], or an element. */
function findAt(frame, px, py) {
  const p = painter(frame), found = { element: -1, contact: null };
  let nearest = 10;
  for (let k = 0; k < count(frame.c, 'c'); k++) {
    const [x, y] = placeOfContact(p, k), far = Math.hypot(x - px, y - py);
    if (frame.c[13 * k + 2] && far < nearest) {
      nearest = far;
      found.contact = [frame.c[13 * k], frame.c[13 * k + 1]];
    }
  }
  for (let e = 0; e < count(run.mesh, 'a') && !found.contact; e++) {
    p.g.beginPath();
    p.outline(e);
    if (p.g.isPointInPath(px * devicePixelRatio, py * devicePixelRatio))
      found.element = e;
  }
  return found;
}
