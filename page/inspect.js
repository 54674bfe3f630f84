/* inspect.js - what is known of an element, a contact, a step; and the open-close iteration of a
 * step, pass by pass. Texts go in as text alone. */
'use strict';

/* The rows of the table of states, doc/open-close.md, in the order of page.h. */
const ROWS = [['OPEN', 'd_n >= 0, or it may not enter there', 'OPEN'],
  ['OPEN', 'd_n < 0', 'LOCK'],
  ['OPEN', 'd_n < 0, and its springs would be outside the cone of friction, or it has closed in ' +
    'this step before', 'SLIDE'],
  ['LOCK', 'N < 0; at an unbroken joint, N < -(tensile strength) A', 'OPEN'],
  ['LOCK', 'N < 0, but its shear spring carries more than friction would with N > 0', 'SLIDE'],
  ['LOCK', 'abs(T) > N tan(phi) + c A', 'SLIDE'],
  ['LOCK', 'abs(T) is within N tan(phi) + c A', 'LOCK'],
  ['SLIDE', 'N is not the N that its friction is taken for', 'SLIDE, other N'],
  ['SLIDE', 'N < 0', 'OPEN'],
  ['SLIDE', 's T < N tan(phi) + c A', 'LOCK'],
  ['SLIDE', 'the same, but friction would wedge it in: tan(phi) dN/dF > 1', 'OPEN'],
  ['SLIDE', 's T is above N tan(phi) + c A', 'SLIDE'],
  ['', 'its corner has gone past the end of the edge: handed on to the next one', '']];
const WHY = ['The contacts are listed, with the states in which this attempt begins',
  'The solution was looked at: states that do not fit it change',
  'Some N is not the N of its friction: once more with the new N, states are not judged yet',
  'All states fit: once more with the same K and a new F (a round of multipliers)',
  'All states fit the solution: the step is done'];

const RENEWED = 'All states fit, but the solution turns blocks: once more with vectors for this turn';

const format = x => x === 0 ? '0' : Math.abs(x) >= 1e-3 && Math.abs(x) < 1e5 ? +x.toPrecision(6) + ''
  : x.toExponential(4);

/* A new element of HTML; what is in it is text, or elements. */
function make(tag, properties, ...inside) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...inside);
  return element;
}

const fill = (id, rows) => document.getElementById(id).replaceChildren(...rows.map(cells =>
  make('tr', {}, ...cells.map(c => make('td', {}, typeof c === 'number' ? format(c) : c)))));

const blockOf = edge => textOf('b', run.edges[3 * edge + 2]);
const nameOf = ([corner, edge]) => `node ${textOf('n', run.edges[3 * corner])} of ` +
  `${blockOf(corner)} on ${blockOf(edge)}`;
const sentence = k => ROWS[k][0] ? `${ROWS[k][0]}: ${ROWS[k][1]}: ${ROWS[k][2]}` : ROWS[k][1];

function tellElement(frame, e) {
  const [, , block, E, nu, density, thickness] = row(run.mesh, 'a', e), x = row(frame.e, 'e', e);
  fill('about', [['', 'D', 'V [1/s]'],
    ...['u0 [m]', 'v0 [m]', 'r0', 'ex', 'ey', 'gxy'].map((q, k) => [q, x[k], x[6 + k]]),
    ...['sxx', 'syy', 'sxy', 'szz', 'von Mises'].map((q, k) => [q, x[12 + k], 'Pa']),
    ['E', E, 'Pa'], ['nu', nu, ''], ['density', density, 'kg/m3'], ['thickness', thickness, 'm']]);
  return `element ${textOf('e', e)} of block ${textOf('b', block)}`;
}

function tellContact(frame, [corner, edge]) {
  let k = 0, last = null;
  while (k < count(frame.c, 'c') && (frame.c[13 * k] !== corner || frame.c[13 * k + 1] !== edge))
    k++;
  if (k === count(frame.c, 'c')) {
    fill('about', [['not near in this step', '']]);
    return `contact, ${nameOf([corner, edge])}`;
  }
  const [, , state, , , , , N, T, gap, strength, slip, now] = row(frame.c, 'c', k);
  for (const f of run.frames.slice(0, run.frames.indexOf(frame) + 1))
    looksOf(f).forEach(look => look.contacts.forEach(c => {
      if (c.corner === corner && c.edge === edge && c.from !== c.to)
        last = [f.step, c.row];
    }));
  fill('about', [['state', STATES[state], ''], ['N', N, 'N'], ['T', T, 'N'], ['bound of T', strength, 'N'],
    ['d_n', gap, 'm'], ['slip', slip, 'm']]);
  document.getElementById('about').append(make('tr', {}, make('td', { colSpan: 3, className: 'why' },
    `Now: ${sentence(now)}. ` + (last ? `Last change, step ${last[0]}: ${sentence(last[1])}.` : ''))));
  return `contact, ${nameOf([corner, edge])}`;
}

function tell(frame, picked) {
  const who = document.getElementById('who');
  if (picked.contact)
    who.textContent = tellContact(frame, picked.contact);
  else if (picked.element >= 0)
    who.textContent = tellElement(frame, picked.element);
  else {
    who.textContent = 'Click an element or a contact';
    fill('about', []);
  }
  fill('facts', [['open-close passes', frame.passes], ['contacts closed', frame.contacts],
    ['deepest contact [m]', frame.penetration], ['times dt was halved', frame.cuts],
    ['PCG iterations', frame.iterations], ['residual', frame.residual],
    ['pairs compared', frame.candidates], ['energy gained [J]', frame.gained]]);
}

/* ------------------------------------------------------------------------ inside a step */

function looksOf(frame) {
  const looks = [], p = frame.p;
  for (let k = 0; k < p.length;) {
    const [t, h, what, n] = p.subarray(k, k += 4), contacts = [];
    for (let i = 0; i < n; i++) {
      const [corner, edge, from, to, N, T, gap, why] = p.subarray(k, k += 8);
      contacts.push({ corner, edge, from, to, N, T, gap, row: why });
    }
    looks.push({ t, h, what, contacts });
  }
  return looks;
}

/* The look in hand: its sentence, and the contacts that it changes first. */
function tellLook(frame, at, onpick) {
  const looks = looksOf(frame), look = looks[at], is = id => document.getElementById(id);
  is('stage').replaceChildren(...['list contacts', 'assemble K, F', 'solve K D = F', 'look at D',
    'move'].map((name, k) => make('li', { className: look && (k === 0 && look.what === 0 ||
    k === 3 && look.what > 0 || k === 4 && look.what === 4) ? 'on' : '' }, name)));
  if (!look) {
    is('look').textContent = 'No step has been done yet: press Step.';
    is('changes').replaceChildren();
    return null;
  }
  const solutions = looks.slice(0, at + 1).filter(l => l.what > 0).length, changed = new Set();
  look.contacts.forEach(c => { if (c.from !== c.to || c.row === 7) changed.add(c); });
  is('look').textContent = `Step ${frame.step}${frame.failed ? ' + 1, which failed' : ''}, look ${at + 1} of ` +
    `${looks.length}, after ${solutions} solutions: ` +
    `${look.what === 1 && !changed.size ? RENEWED : WHY[look.what]}.  ${look.contacts.length} closed before ` +
    `or after, ${changed.size} changed${frame.dynamic ? `; h = ${format(look.h)} s` : ''}.`;
  const list = [...changed, ...look.contacts.filter(c => !changed.has(c))].slice(0, 200);
  is('changes').replaceChildren(make('tr', {}, ...['contact', 'was', 'becomes', 'N [N]', 'T [N]', 'd_n [m]',
    'why'].map(c => make('th', {}, c))), ...list.map(c => make('tr', { className: changed.has(c) ? 'changed' : '',
    onclick: () => onpick([c.corner, c.edge]) }, ...[nameOf([c.corner, c.edge]), STATES[c.from], STATES[c.to],
    format(c.N), format(c.T), format(c.gap), look.what ? ROWS[c.row][1] : 'as it began']
    .map(text => make('td', {}, text)))));
  return look;
}
