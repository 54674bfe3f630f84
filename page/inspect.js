/* inspect.js - what is known of an element, a contact, a step; and the open-close iteration of a
 * step, pass by pass. Texts go in as text alone. */
'use strict';

/* The rows of the table of states, doc/06-contact.md, in the order of page.h. */
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

const RENEWED =
  'All states fit, but the solution turns blocks: once more with vectors for this turn';

const format = x => x === 0 || (Math.abs(x) >= 1e-3 && Math.abs(x) < 1e5)
  ? `${+x.toPrecision(6)}` : x.toExponential(4);

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

/* What it carries, the row that keeps it, and the one that changed it last. */
function tellContact(frame, [corner, edge]) {
  const is = c => c.corner === corner && c.edge === edge, until = run.frames.indexOf(frame) + 1;
  const contacts = times(count(frame.c, 'c'), k => row(frame.c, 'c', k));
  const at = contacts.find(c => c[0] === corner && c[1] === edge);
  const changes = run.frames.slice(Math.max(0, until - 300), until).flatMap(f =>
    looksOf(f).flatMap(look => look.contacts).filter(c => is(c) && c.from !== c.to)
      .map(c => `step ${f.step}: ${sentence(c.row)}`));
  const [, , state, , , , , N, T, gap, strength, slip, now] = at ?? [];
  fill('about', at ? [['state', STATES[state], ''], ['N', N, 'N'], ['T', T, 'N'],
    ['bound of T', strength, 'N'], ['d_n', gap, 'm'], ['slip', slip, 'm']] : []);
  const why = at ? `Now ${sentence(now)}. Last change, ${changes.at(-1) ?? 'none'}.`
    : 'not near in this step';
  document.getElementById('about').append(
    make('tr', {}, make('td', { colSpan: 3, className: 'why' }, why)));
  return `contact, ${nameOf([corner, edge])}`;
}

function tell(frame, picked) {
  fill('about', []);
  document.getElementById('who').textContent = picked.contact ? tellContact(frame, picked.contact)
    : picked.element >= 0 ? tellElement(frame, picked.element) : 'Click an element or a contact';
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

/* The look in hand, as a sentence and a table; what it changes stands first. */
function tellLook(frame, at, onpick) {
  const looks = looksOf(frame), look = looks[at], is = id => document.getElementById(id);
  const on = look ? [look.what === 0, false, false, look.what > 0, look.what === 4] : [];
  const stages = ['list contacts', 'assemble K, F', 'solve K D = F', 'look at D', 'move'];
  is('stage').replaceChildren(...stages.map((name, k) =>
    make('li', { className: on[k] ? 'on' : '' }, name)));
  const contacts = look?.contacts ?? [], changes = c => c.from !== c.to || c.row === 7;
  const changed = contacts.filter(changes), rest = contacts.filter(c => !changes(c));
  const solution = looks.slice(0, at + 1).filter(l => l.what > 0).length;
  is('look').textContent = !look ? 'No step has been done yet: press Step.'
    : `Step ${frame.step}${frame.failed ? ' + 1, which failed' : ''}, look ${at + 1} of ` +
    `${looks.length}, after solution ${solution}: ` +
    `${look.what === 1 && !changed.length ? RENEWED : WHY[look.what]}. ` +
    `${contacts.length} closed before or after, ${changed.length} changed` +
    `${frame.dynamic ? `; h = ${format(look.h)} s` : ''}.`;
  const line = (tag, properties, cells) =>
    make('tr', properties, ...cells.map(text => make(tag, {}, text)));
  is('changes').replaceChildren(
    line('th', {}, ['contact', 'was', 'becomes', 'N [N]', 'T [N]', 'd_n [m]', 'why']),
    ...[...changed, ...rest].slice(0, 200).map(c => line('td',
      { className: changes(c) ? 'changed' : '', onclick: () => onpick([c.corner, c.edge]) },
      [nameOf([c.corner, c.edge]), STATES[c.from], STATES[c.to], format(c.N), format(c.T),
        format(c.gap), look.what ? ROWS[c.row][1] : 'as it began'])));
  return look;
}
