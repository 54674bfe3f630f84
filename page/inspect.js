/* inspect.js - what is known of an element, a contact, a step; and the open-close iteration of a
 * step, pass by pass. Texts go in as text alone. */
'use strict';

/* [from, why, to]: the table of states of doc/06-contact.md is put before these, which it lacks. */
const ROWS = [['SLIDE', 'friction would wedge it in: tan(phi) dN/dF > 1', 'OPEN'],
  ['', 'its corner has gone past the end of the edge: handed on to the next one', '']];
const WHY = ['The contacts are listed, with the states in which this attempt begins',
  'The solution was looked at: states that do not fit it change',
  'Some N is not the N of its friction: once more with the new N, states are not judged yet',
  'All states fit: once more with the same K and a new F (a round of multipliers)',
  'All states fit the solution: the step is done',
  'All states fit, but the solution turns blocks: once more with vectors for this turn'];

/* The tables: what stands first, which number of a row or frame, its unit or a second number. */
const OF_ELEMENT = [['u0 [m]', 0, 6], ['v0 [m]', 1, 7], ['r0', 2, 8], ['ex', 3, 9], ['ey', 4, 10],
  ['gxy', 5, 11], ['sxx', 12, 'Pa'], ['syy', 13, 'Pa'], ['sxy', 14, 'Pa'], ['szz', 15, 'Pa'],
  ['von Mises', 16, 'Pa'], ['displacement', 17, 'm'], ['E', 18, 'Pa'], ['nu', 19, ''],
  ['density', 20, 'kg/m3'], ['thickness', 21, 'm']];
const OF_CONTACT = [['N', 5, 'N'], ['T', 6, 'N'], ['bound of T', 8, 'N'], ['d_n', 7, 'm'],
  ['slip', 9, 'm']];
const OF_STEP = [['open-close passes', 'passes', ''], ['contacts closed', 'contacts', ''],
  ['deepest contact', 'penetration', 'm'], ['times dt was halved', 'cuts', ''],
  ['PCG iterations', 'iterations', ''], ['residual', 'residual', ''],
  ['pairs compared', 'candidates', ''], ['energy gained', 'gained', 'J']];

const format = x => typeof x === 'string' ? x
  : x === 0 || Math.abs(x) >= 1e-3 && Math.abs(x) < 1e5 ? `${+x.toPrecision(6)}`
  : x.toExponential(4);

/* A new element of HTML; what is in it is text, or elements. */
function make(tag, properties, ...inside) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...inside);
  return element;
}

const line = (cells, properties) =>
  make('tr', properties, ...cells.map(c => make('td', {}, format(c))));
const fill = (id, lines) => is(id).replaceChildren(...lines);
const fillIn = (table, x) => table.map(([name, k, unit]) => line([name, x[k], x[unit] ?? unit]));

const blockOf = edge => textOf('b', run.d[3 * edge + 2]);
const nameOf = ([corner, edge]) => `node ${textOf('n', run.d[3 * corner])} of ` +
  `${blockOf(corner)} on ${blockOf(edge)}`;
const isPicked = c => c[0] === view.contact[0] && c[1] === view.contact[1];

/* The row that led a contact from state to state in a look: the first that fits if it renewed
 * friction, or found tension; else the last. */
function rowOf({ what }, [, , from, to, , , , isTension]) {
  const fit = ROWS.filter(([a, , b]) => a === STATES[from] && b.startsWith(STATES[to]));
  return what === DONE && from !== to ? ROWS.at(-1)
    : fit.at((from === to ? what === FRICTION : isTension) ? 0 : -1);
}

const sentence = row => row.filter(word => word).join(': ');
const isChange = (look, c) => c[2] !== c[3] || look.what === FRICTION && c[3] === SLIDE;

/* What it carries, the row that keeps it, and the one that changed it last. */
function tellContact(frame) {
  const c = rows(frame, 'c').find(isPicked), until = run.frames.indexOf(frame) + 1;
  const last = run.frames.slice(Math.max(0, until - 300), until).flatMap(f =>
    looksOf(f).flatMap(look => look.contacts.filter(l => isPicked(l) && l[2] !== l[3])
      .map(l => `step ${f.step}: ${sentence(rowOf(look, l))}`))).at(-1) ?? 'none';
  fill('about', c ? [line(['state', STATES[c[2]], '']), ...fillIn(OF_CONTACT, c)] : []);
  is('why').textContent = !c ? 'not near in this step'
    : `Now ${sentence(rowOf({}, [0, 0, c[2], c[2]]))}. Last change, ${last}.`;
  return `contact, ${nameOf(view.contact)}`;
}

function tellElement(frame) {
  const e = rows(frame, 'e')[view.element];
  fill('about', [line(['', 'D', 'V [1/s]']), ...fillIn(OF_ELEMENT, e)]);
  return `element ${textOf('e', view.element)} of block ${textOf('b', e[22])}`;
}

function tell(frame) {
  fill('about', []);
  is('why').textContent = '';
  is('who').textContent = view.contact ? tellContact(frame)
    : view.element >= 0 ? tellElement(frame) : 'Click an element or a contact';
  fill('facts', fillIn(OF_STEP, frame));
}

/* ------------------------------------------------------------------------ inside a step */

function looksOf({ p = [] }) {
  const looks = [];
  for (let k = 0; k < p.length;) {
    const [, h, what, n] = p.subarray(k, k += 4);
    looks.push({ h, what, contacts: rows({ p: p.subarray(k, k += 8 * n) }, 'p', 8) });
  }
  return looks;
}

/* The look in hand, as a sentence and a table; what it changes stands first. */
function tellLook(frame) {
  const looks = looksOf(frame), look = looks[view.look], contacts = look?.contacts ?? [];
  const changed = contacts.filter(c => isChange(look, c));
  const solution = looks.slice(0, view.look + 1).filter(l => l.what !== LISTED).length;
  is('look').textContent = !look ? 'No step has been done yet: press Step.'
    : `Step ${frame.step}${frame.failure ? ', which failed' : ''}, look ${view.look + 1} of ` +
    `${looks.length}, after solution ${solution}: ` +
    `${WHY[look.what === JUDGED && !changed.length ? 5 : look.what]}. ${changed.length} of ` +
    `${contacts.length} changed${frame.dynamic ? `; h = ${format(look.h)} s` : ''}.`;
  fill('changes', [line(['contact', 'was', 'becomes', 'N [N]', 'T [N]', 'd_n [m]', 'why']),
    ...[...new Set([...changed, ...contacts])].slice(0, 200).map(c => line([nameOf(c),
      STATES[c[2]], STATES[c[3]], c[4], c[5], c[6],
      look.what === LISTED ? 'as it began' : rowOf(look, c)[1]],
    { className: isChange(look, c) ? 'changed' : '', onclick: () => pick(-1, c) }))]);
}
