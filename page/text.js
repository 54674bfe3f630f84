/* text.js - the text of the model: the blocks in it, the way in, undo, what is kept, files.
 *
 * `past` has all texts that were there, one after the other. A text of a person's own is kept in
 * the browser, and is a model named NAME (own). */
'use strict';

const NUMBER = '[-+]?(?:\\d+\\.?\\d*|\\.\\d+)(?:[eE][-+]?\\d+)?';
const OWN = ' (own)', PAUSE = 400;              /* ms, after which what was typed is read */
const STATEMENTS = [];                          /* of doc/model-file.md: word, form, meaning */
const kept = (() => { try { return localStorage; } catch { return {}; } })();
const past = { list: [], at: -1, name: '', later: 0 };

const plain = x => String(+x.toPrecision(10));
const linesOf = () => is('text').value.split('\n');
const firstWord = line => line?.trim().split(/\s/)[0];

/* ------------------------------------------------------------------------ blocks */

/* The lines, with their first words, and how deep they are in `repeat` or `stage`. */
function readLines() {
  let depth = 0;
  return linesOf().map((line, row) => {
    const word = firstWord(line);
    depth += /^(repeat|stage)$/.test(word) - (word === 'end');
    return { line, row, word, depth };
  });
}

/* The blocks that a hand can change: of plain numbers, outside of these. */
function findBlocks() {
  const form = RegExp(`^(\\s*block\\s+([^\\s$]+)\\s+\\S+)((?:\\s+${NUMBER}){6,})(\\s*(?:#.*)?)$`);
  return readLines().flatMap(({ line, row, depth }) => {
    const [, head, name, numbers, tail] = line.match(form) ?? [];
    const words = numbers?.trim().split(/\s+/) ?? [];
    return !name || depth || words.length % 2 ? [] : [{ row, head, name, words, tail,
      points: times(words.length / 2, k => [+words[2 * k], +words[2 * k + 1]]) }];
  });
}

/* Why a block is none of these. */
function whyNot(name) {
  const found = readLines().find(({ line, word }) => {
    const [begin, more] = (line.trim().split(/\s+/)[1] ?? '').split('$');
    return /^(block|grid)$/.test(word) && (more ? name.startsWith(begin) : name === begin);
  });
  const why = found?.depth ? 'is in `repeat`' : found?.word === 'grid' ? 'is a grid' : 'has $...';
  return found ? `line ${found.row + 1} ${why}` : 'it comes from elements or a mesh';
}

/* The line of a block with other corners. Places `at X Y` on a corner that moves go with it. */
function moveBlock({ row, head, name, words, tail, points: old }, points) {
  const write = (p, k) => p.map((x, a) => x === old[k][a] ? words[2 * k + a] : plain(x)).join(' ');
  const place = RegExp(`\\bat\\s+(${NUMBER})\\s+(${NUMBER})(\\s+of\\s+(\\S+))?`, 'g');
  const follow = (all, x, y, of = '', owner = name) => {
    const k = old.findIndex(p => Math.hypot(p[0] - x, p[1] - y) < 1e-9 * (1 + Math.hypot(x, y)));
    return k < 0 || owner !== name ? all : `at ${points[k].map(plain).join(' ')}${of}`;
  };
  rewrite(linesOf().map((line, k) => k === row ? `${head}  ${points.map(write).join('  ')}${tail}`
    : line.replace(/^[^#]*/, words => words.replace(place, follow))), row);
}

/* A new block goes behind the last one, and is of its material. */
function addBlock(points) {
  const last = findBlocks().at(-1), lines = linesOf(), row = last ? last.row + 1 : lines.length;
  const material = (last ? last.head : is('text').value.match(/^\s*material\s+\S+/m)?.[0] ?? 'rock')
    .split(/\s+/).at(-1);
  const name = times(999, k => `new${k + 1}`).find(n => !is('text').value.includes(n));
  lines.splice(row, 0, `block ${name} ${material}  ${points.map(p => p.map(plain).join(' '))
    .join('  ')}`);
  rewrite(lines, row);
}

/* With what is said of the block alone. */
function deleteBlock(name) {
  const of = RegExp(`^\\s*(fixblock|velocity|stress|use\\s+\\S+\\s+on)\\s+${name}(\\s|$)`);
  const { row } = findBlocks().find(b => b.name === name);
  rewrite(linesOf().filter((line, k) => k !== row && !of.test(line)), row);
}

/* ------------------------------------------------------------------------ one way in; undo */

/* What is no typing: it is read at once, and its line is shown. */
function rewrite(lines, row) {
  is('text').value = lines.join('\n');
  remember();
  makeSliders();
  load();
  is('edit').scrollTop = 20 * row - is('edit').clientHeight / 2;
  is('lines').children[row]?.classList.add('now');
  tellStatement(row);
}

/* The text is one that may come back; what a person has made of a model is kept. */
function remember(isOwn = true) {
  const { name } = past, text = is('text').value;
  clearTimeout(past.later);
  if (past.list[past.at]?.text === text)
    return;
  past.list.splice(past.at + 1, Infinity, { name, text });
  past.at++;
  if (isOwn && !EXERCISES[name])
    keepOwn(name.replace(OWN, ''), text);
  past.list[past.at].name = past.name;
}

/* Later, when it has stayed for a while. */
function rememberSoon(then = () => {}) {
  clearTimeout(past.later);
  past.later = setTimeout(() => { remember(); then(); }, PAUSE);
}

function undo(by) {
  remember();
  const to = past.list[past.at + by];
  if (!to)
    return;
  const { value } = is('text'), at = [...to.text].findIndex((c, k) => c !== value[k]);
  past.at += by;
  setText(to.name, to.text);
  is('text').setSelectionRange(Math.max(0, at), Math.max(0, at));
}

/* ------------------------------------------------------------------------ what is kept */

function keepOwn(name, text) {
  if (text === files.get(`gallery/${name}`))
    return;
  kept[`bbm ${name}`] = text;
  listOwn();
  kept.bbm = past.name = is('gallery').value = name + OWN;
}

function listOwn() {
  const names = Object.keys(kept).filter(key => key.startsWith('bbm ')).map(key => key.slice(4));
  fill('own', names.sort().map(n => new Option(n.replace('.model', '') + OWN, n + OWN)));
  names.forEach(n => files.set(`gallery/${n}${OWN}`, kept[`bbm ${n}`]));
}

function saveFile() {
  const href = URL.createObjectURL(new Blob([is('text').value]));
  make('a', { href, download: past.name.replace(OWN, '') }).click();
  setTimeout(URL.revokeObjectURL, 1e3, href);
}

/* A model, and the meshes and records that it or the model in hand names. */
async function openFiles(list) {
  for (const file of list)
    files.set(file.name, await file.text());
  const model = [...list].find(file => !/\.(msh|csv|dat|txt|geo)$/.test(file.name));
  if (!model)
    return load();
  remember();
  keepOwn(model.name, files.get(model.name));
  return choose(past.name);
}

/* ------------------------------------------------------------------------ statements */

/* What may stand in a line, by its first word; below it all that there is. */
function tellStatement(row) {
  const word = firstWord(linesOf()[row]), mine = STATEMENTS.filter(s => s.word === word);
  is('form').textContent = mine.map(s => s.form).join('\n') || 'all statements';
  fill('help', [...mine, ...STATEMENTS.filter(s => s.word !== word)].map(({ form, meaning }) =>
    make('p', {}, make('code', {}, form), ` ${meaning}`)));
}

/* Rows of the table in doc/model-file.md. */
function readStatements(text) {
  STATEMENTS.push(...text.trim().split('\n').map(row => {
    const [form, meaning] = row.slice(2, -2).split(' | ')
      .map(cell => cell.replace(/\[([^\]]*)\]\(.*?\)/g, '$1').replace(/`/g, ''));
    return { word: firstWord(form), form, meaning };
  }));
}
