/* hands.js - a hand in the picture: what it has taken hold of, and how that looks.
 *
 * `hands` has the grip: a point of an element that is pulled. */
'use strict';

const hands = { grip: null, said: '' };

const redraw = () => drawPicture(shown(), false);
const sayHand = text => { hands.said = text; redraw(); };
const isFree = (frame, e) => e >= 0 && !run.blocks[rows(frame, 'e')[e][22]].held;

/* Where a point of an element is, if its vertices are not in `from` but in `to`. */
function carry(q, [, first, n], from, to) {
  const cross = ([ax, ay], [bx, by], [cx, cy]) => (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
  const [P, Q] = [from, to].map(all => all.slice(first, first + n));
  const areas = P.map(p => Math.abs(cross(P[0], P[1], p))), k = areas.indexOf(Math.max(...areas));
  const share = [cross(q, P[1], P[k]), cross(P[0], q, P[k]), cross(P[0], P[1], q)]
    .map(a => a / cross(P[0], P[1], P[k]));
  return [0, 1].map(a => share[0] * Q[0][a] + share[1] * Q[1][a] + share[2] * Q[k][a]);
}

/* ------------------------------------------------------------------------ what a hand does */

/* Takes what is at a pixel of the newest picture, if it can move. */
function grab(x, y) {
  const f = shown(), e = view.at < 0 && run.state < 2 ? findElement(f, x, y) : -1;
  hands.said = '';
  if (!isFree(f, e))
    return;
  const p = painter(f), at = carry([x, y], rows(f, 'e')[e].subarray(22), p.at, rows(f, 'v'));
  hands.grip = { element: e, at, x, y, scale: p.s * p.magnify };
}

/* A picture keeps its magnification while it is pulled at. */
function drag(x, y) {
  const g = hands.grip;
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
  if (!g?.holds)
    return;
  hold(-1);
  play(true);
}

/* Whether the hand has slipped in the steps since a frame. */
function feel(before) {
  const last = run.frames.at(-1);
  if (!hands.grip?.holds || last === before || last.h.length)
    return;
  hands.grip = null;
  hands.said = 'the hand slipped: that is more than the blocks can bear';
}

/* ------------------------------------------------------------------------ how it looks */

/* Text that is read on anything, within the canvas. */
function drawLabel({ g, w, h }, text, x, y, textAlign = 'left') {
  const place = [Math.max(8, Math.min(w - 8, x)), Math.max(20, Math.min(h - 8, y))];
  Object.assign(g, { font: `600 15px ${css('--sans')}`, textAlign, lineWidth: 4,
    strokeStyle: css('--paper'), fillStyle: css('--pick') });
  g.strokeText(text, ...place);
  g.fillText(text, ...place);
  g.textAlign = 'left';
}

/* From the point to the hand; the force as an arrow, and as a number. */
function drawPull(p) {
  const [e, x, y, X, Y, fx, fy] = p.frame.h, { g, s, magnify } = p, line = css('--pick');
  const P = carry([x, y], rows(p.frame, 'e')[e].subarray(22), rows(p.frame, 'v'), p.at);
  const Q = [P[0] + s * magnify * (X - x), P[1] - s * magnify * (Y - y)], turn = Math.atan2(-fy, fx);
  const l = Math.max(36, Math.min(70, Math.hypot(Q[0] - P[0], Q[1] - P[1])));
  paint(g, () => trace(g, [P, Q]), { line, width: 1, dash: [3, 3] });
  paint(g, () => g.arc(0, 0, 4, 0, 7), { fill: line }, P);
  if (fx || fy)
    paint(g, () => {
      trace(g, [[0, 0], [l, 0]]);
      trace(g, [[l - 11, 5], [l, 0], [l - 11, -5]]);
    }, { line, width: 3 }, P, turn);
  drawLabel(p, quantity(Math.hypot(fx, fy), 'N'), P[0] + (l + 12) * Math.cos(turn),
    P[1] + (l + 16) * Math.sin(turn) + 5, Math.cos(turn) < 0 ? 'right' : 'left');
}

function drawHands(p) {
  if (p.frame.h?.length)
    drawPull(p);
  drawLabel(p, hands.said, 8, 20);
}
