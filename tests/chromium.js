/* chromium.js - a page in headless Chromium, over a pipe: its DevTools protocol, and no package. */
'use strict';
const { spawn } = require('child_process'), fs = require('fs'), os = require('os'), path = require('path');

/* Opens the page; do(text) evaluates an expression there, shot(name) takes a picture. Each request
 * that leaves the page for another place than the file itself is counted. */
exports.open = async (url, folder) => {
  const home = fs.mkdtempSync(path.join(os.tmpdir(), 'page-'));
  const browser = spawn(process.env.CHROMIUM || 'chromium', ['--headless=new', '--no-sandbox', '--disable-gpu',
    '--no-first-run', '--disable-backgrounding-occluded-windows', '--disable-renderer-backgrounding',
    '--remote-debugging-pipe', '--window-size=1280,720', `--user-data-dir=${home}`],
  { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
  const waiting = new Map(), page = { requests: [], errors: [] };
  let said = Buffer.alloc(0), last = 0, session;
  browser.on('error', e => { console.log(`${e}`); process.exit(1); });
  browser.stdio[4].on('data', piece => {
    said = Buffer.concat([said, piece]);
    for (let end; (end = said.indexOf(0)) >= 0; said = said.subarray(end + 1)) {
      const m = JSON.parse(said.subarray(0, end));
      if (m.id)
        waiting.get(m.id)(m);
      else if (m.method === 'Network.requestWillBeSent')
        page.requests.push(m.params.request.url);
      else if (m.method === 'Runtime.exceptionThrown')
        page.errors.push(m.params.exceptionDetails.exception?.description ?? m.params.exceptionDetails.text);
    }
  });
  const send = (method, params = {}) => new Promise((done, fail) => {
    waiting.set(++last, m => m.error ? fail(Error(`${method}: ${m.error.message}`)) : done(m.result));
    browser.stdio[3].write(JSON.stringify({ id: last, method, params, sessionId: session }) + '\0');
  });
  const { targetId } = await send('Target.createTarget', { url: 'about:blank' });
  session = (await send('Target.attachToTarget', { targetId, flatten: true })).sessionId;
  for (const domain of ['Page', 'Runtime', 'Network'])
    await send(`${domain}.enable`);
  page.send = send;
  page.do = async expression => {
    const r = await send('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true });
    if (r.exceptionDetails)
      throw Error(`${expression}: ${r.exceptionDetails.exception?.description}`);
    return r.result.value;
  };
  page.until = async expression => {
    for (const start = Date.now(); !await page.do(expression); await new Promise(r => setTimeout(r, 50)))
      if (Date.now() - start > 60e3)
        throw Error(`after a minute not yet: ${expression}; ${await page.do('document.body.innerText.slice(0, 300)')}`);
  };
  page.go = async to => {
    await send('Page.navigate', { url: 'about:blank' });
    await send('Page.navigate', { url: to });
    await page.until('typeof loadModel === "function" && run !== null');
  };
  page.click = async (x, y) => {
    for (const type of ['mousePressed', 'mouseReleased'])
      await send('Input.dispatchMouseEvent', { type, x, y, button: 'left', buttons: 1, clickCount: 1 });
  };
  page.shot = async name => fs.writeFileSync(path.join(folder, `${name}.png`),
    Buffer.from((await send('Page.captureScreenshot')).data, 'base64'));
  page.close = () => new Promise(done => {
    browser.on('exit', () => done(fs.rmSync(home, { recursive: true, force: true, maxRetries: 9, retryDelay: 200 })));
    browser.kill();
  });
  await send('Page.bringToFront');
  await send('Emulation.setDeviceMetricsOverride', { width: 1280, height: 720, deviceScaleFactor: 1, mobile: false });
  await page.go(url);
  return page;
};
