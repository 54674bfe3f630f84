/* hands.js - a hand in the picture. As long as nothing has run it changes the text: it drags
 * corners and blocks, and draws new ones. In a run it pulls.
 *
 * `hands` has the grip, a block of the text or a point of an element; what is under the pointer;
 * why it cannot be dragged; the corners of a new block; where the pointer is. A place is the
 * nearest corner or edge of another block, which is touched then, or else one of the grid. */
'use strict';

const NEAR = 9, GRID = 24;                      /* pixels */
const IDLE = { grip: null, over: null, why: '', corners: null, said: '' };
const hands = { ...IDLE, place: [0, 0] };

const redraw = () => drawPicture(shown(), false);
const sayHand = text => { hands.said = text; redraw(); };
const isAtStart = () => run.frames.length === 1 && !playing && !run.isPulled &&
  run.frames[0].settling === run.frames[0].settle;

/* Where a point of an element is, if its vertices are not in `from` but in `to`. */
function carry(q, [, first, n], from, to) {
  const cross = ([ax, ay], [bx, by], [cx, cy]) => (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
  const [P, Q] = [from, to].map(all => all.slice(first, first + n));
  const areas = P.map(p => Math.abs(cross(P[0], P[1], p))), k = areas.indexOf(Math.max(...areas));
  const share = [cross(q, P[1], P[k]), cross(P[0], q, P[k]), cross(P[0], P[1], q)]
    .map(a => a / cross(P[0], P[1], P[k]));
  return [0, 1].map(a => share[0] * Q[0][a] + share[1] * Q[1][a] + share[2] * Q[k][a]);
}

/* ------------------------------------------------------------------------ places */

const scaleOf = canvas => findScale(canvas.clientWidth, canvas.clientHeight);
const gridOf = s => roundDown(GRID / s);
const distance = ([x, y], [X, Y]) => Math.hypot(x - X, y - Y);

/* The place for a point of the block `own`: a corner counts as half as far as it is. far: Infinity,
 * if it is one of the grid. */
function snap(point, s, own) {
  const v = rows(run, 'v'), grid = gridOf(s);
  const [best] = rows(run, 'd').filter(d => textOf('b', d[2]) !== own).flatMap(([a, b]) => {
    const [A, B] = [v[a], v[b]].map(p => [p[0], p[1]]), way = [0, 1].map(k => B[k] - A[k]);
    const t = [0, 1].reduce((sum, k) => sum + way[k] * (point[k] - A[k]), 0) / distance(A, B) ** 2;
    const foot = [0, 1].map(k => A[k] + t * way[k]);
    return [{ to: A, far: distance(A, point) / 2 },
      { to: foot, far: t >= 0 && t <= 1 ? distance(foot, point) : Infinity }];
  }).filter(place => place.far < NEAR / s).sort((p, q) => p.far - q.far);
  return best ?? { far: Infinity, to: point.map(x => Math.round(x / grid) * grid) };
}

/* The block of the text that is under a pixel, and which corner, or -1. */
function findHandle(x, y) {
  const { to } = scaleOf(is('view')), { g } = sizeOf('view');
  const found = findBlocks().reverse().map(block => {
    const points = block.points.map(p => to(...p));
    const side = largest(points.map((p, k) => distance(p, points.at(k - 1))));
    const corner = points.findIndex(p => distance(p, [x, y]) < Math.min(NEAR, side / 4));
    return { block, corner, isIn: isInside(g, () => trace(g, points, true), x, y) };
  });
  return found.find(f => f.corner >= 0) ?? found.find(f => f.isIn) ?? null;
}

/* ------------------------------------------------------------------------ what a hand does */

/* Takes what is at a pixel: a block of the text; of the newest picture what can move. */
function grab(x, y) {
  const f = shown(), e = view.at < 0 && run.state < 2 ? findElement(f, x, y) : -1;
  const found = isAtStart() && findHandle(x, y), block = rows(f, 'e')[e]?.[22];
  const name = e >= 0 && textOf('b', block);
  hands.said = '';
  hands.why = isAtStart() && name ? `block ${name} cannot be dragged: ${whyNot(name)}` : '';
  if (found)
    hands.grip = { ...found, points: found.block.points, start: scaleOf(is('view')).from(x, y) };
  if (isAtStart() || e < 0 || run.blocks[block].held)
    return;
  const p = painter(f), at = carry([x, y], rows(f, 'e')[e].subarray(22), p.at, rows(f, 'v'));
  hands.grip = { element: e, at, x, y, scale: p.s * p.magnify };
}

/* A corner goes to its place; a block by the way that is nearest to one of its corners. */
function dragBlock({ block, corner, start }, to, s) {
  const way = [0, 1].map(a => to[a] - start[a]), grid = gridOf(s), { name, points } = block;
  if (corner >= 0) {
    hands.grip.points = points.with(corner, snap(to, s, name).to);
    return sayHand(`corner ${corner + 1} of ${name}`);
  }
  const [near] = points.map(p => ({ p, ...snap([p[0] + way[0], p[1] + way[1]], s, name) }))
    .sort((a, b) => a.far - b.far);
  const by = [0, 1].map(a => near.far < Infinity ? near.to[a] - near.p[a]
    : Math.round(way[a] / grid) * grid);
  hands.grip.points = points.map(p => [p[0] + by[0], p[1] + by[1]]);
  return sayHand(`${name} by ${by.map(x => +x.toPrecision(4)).join('  ')} m` +
    (near.far < Infinity ? ', touches' : ''));
}

/* A picture keeps its magnification while it is pulled at. */
function drag(x, y) {
  const g = hands.grip, { s, from } = scaleOf(is('view'));
  if (g.block)
    return dragBlock(g, from(x, y), s);
  if (g.isGone)
    return;
  if (!g.holds) {
    run.magnify = painter(shown()).magnify;
    hold(g.element, ...g.at);
    g.holds = true;
  }
  pull(g.at[0] + (x - g.x) / g.scale, g.at[1] - (y - g.y) / g.scale);
  if (!playing)
    play(true);
}

function drop() {
  const g = hands.grip;
  hands.grip = null;
  if (g?.holds) {
    hold(-1);
    play(true);
  }
  if (g?.block && g.points !== g.block.points)
    moveBlock(g.block, g.points);
}

/* A click sets a corner of a new block. It ends at its first corner, or by a double click. */
function setCorner(x, y, isEnd) {
  const { s, from } = scaleOf(is('view')), all = hands.corners, { to } = snap(from(x, y), s);
  const isAt = p => p && distance(p, to) < NEAR / s / 2;
  if (all.length > 2 && (isEnd || isAt(all[0]))) {
    toggleDrawing();
    return addBlock(all);
  }
  if (!isAt(all.at(-1)))
    all.push(to);
  return redraw();
}

function toggleDrawing() {
  const corners = hands.corners ? null : [];
  if (corners && !isAtStart())
    load();
  hands.corners = corners;
  is('draw').classList.toggle('on', !!corners);
  sayHand(corners ? 'click the corners; a double click ends the block' : '');
}

/* The block that is picked, or else that under the pointer. */
function deletePicked() {
  const picked = rows(shown(), 'e')[view.element];
  const name = picked ? textOf('b', picked[22]) : hands.over?.block.name;
  if (isAtStart() && findBlocks().some(b => b.name === name))
    return deleteBlock(name);
  return sayHand(!isAtStart() ? 'Reset first: what runs cannot be changed'
    : name ? `block ${name} cannot be deleted: ${whyNot(name)}` : 'click a block first');
}

/* Whether the hand has slipped in the steps since a frame. */
function feel(before) {
  const last = run.frames.at(-1);
  if (!hands.grip?.holds || last === before || last.h.length)
    return;
  hands.grip = { isGone: true };
  hands.said = 'the hand slipped: that is more than the blocks can bear';
}

/* ------------------------------------------------------------------------ how it looks */

/* Text that is read on anything, within the canvas; left of a place, or right of it. */
function drawLabel({ g, w, h }, text, x, y, isLeft) {
  Object.assign(g, { font: `600 15px ${css('--sans')}`, textAlign: 'left', lineWidth: 4,
    strokeStyle: css('--paper'), fillStyle: css('--pick') });
  const { width } = g.measureText(text);
  const place = [Math.max(8, Math.min(w - 8 - width, x - (isLeft ? width : 0))),
    Math.max(20, Math.min(h - 8, y))];
  g.strokeText(text, ...place);
  g.fillText(text, ...place);
}

/* From the point to the hand; the force as an arrow, and as a number. */
function drawPull(p) {
  const [e, x, y, X, Y, fx, fy] = p.frame.h, { g, s, magnify } = p, line = css('--pick');
  const P = carry([x, y], rows(p.frame, 'e')[e].subarray(22), rows(p.frame, 'v'), p.at);
  const Q = [P[0] + s * magnify * (X - x), P[1] - s * magnify * (Y - y)];
  const turn = Math.atan2(-fy, fx);
  const l = Math.max(36, Math.min(70, Math.hypot(Q[0] - P[0], Q[1] - P[1])));
  paint(g, () => trace(g, [P, Q]), { line, width: 1, dash: [3, 3] });
  paint(g, () => g.arc(0, 0, 4, 0, 7), { fill: line }, P);
  if (fx || fy)
    paint(g, () => {
      trace(g, [[0, 0], [l, 0]]);
      trace(g, [[l - 11, 5], [l, 0], [l - 11, -5]]);
    }, { line, width: 3 }, P, turn);
  drawLabel(p, quantity(Math.hypot(fx, fy), 'N'), P[0] + (l + 12) * Math.cos(turn),
    P[1] + (l + 16) * Math.sin(turn) + 5, Math.cos(turn) < 0);
}

/* The block that is dragged or drawn, with the grid; or the one under the pointer, with corners.
 * What is in the text, but not in the picture, since it is wrong, is dashed. */
function drawEdit(p) {
  const { g, w, h } = p, { s, to, from } = findScale(w, h), line = css('--pick'), grid = gridOf(s);
  const { grip, corners, over } = hands, [x0, y1] = from(0, 0), [x1, y0] = from(w, h);
  const outline = (points, style, closed = true) => paint(g, () =>
    trace(g, points.map(q => to(...q)), closed), { line, width: 2, ...style });
  const isShown = q => rows(run, 'v').some(v => distance(v, q) <= 1e-9 * Math.hypot(...q));
  findBlocks().filter(b => is('error').textContent && !b.points.every(isShown)).forEach(b =>
    outline(b.points, { line: css('--bad'), dash: [4, 4] }));
  const points = corners ? [...corners, snap(from(...hands.place), s).to] : grip?.points;
  if (points) {
    const ticks = (a, b) => times(Math.ceil((b - a) / grid), k => (Math.ceil(a / grid) + k) * grid);
    paint(g, () => ticks(x0, x1).forEach(x => ticks(y0, y1).forEach(y =>
      g.rect(to(x, 0)[0] - 0.5, to(0, y)[1] - 0.5, 1.4, 1.4))), { fill: css('--dim') });
    const corner = corners ? points.at(-1) : points[grip.corner];
    outline(points, { dash: [6, 4] }, !corners || points.length > 2);
    if (corner)
      drawLabel(p, corner.map(plain).join('  '), to(...corner)[0] + 12, to(...corner)[1] - 10);
    drawLabel(p, `grid ${quantity(grid, 'm')}`, 8, 40);
  } else if (over) {
    outline(over.block.points);
    over.block.points.map(q => to(...q)).forEach(([x, y], k) => paint(g, () =>
      g.rect(x - 4, y - 4, 8, 8), { line, fill: k === over.corner ? line : css('--paper') }));
  }
}

function drawHands(p) {
  if (isAtStart())
    drawEdit(p);
  if (p.frame.h?.length)
    drawPull(p);
  drawLabel(p, hands.said, 8, 20);
}
