/* chromium.js - a page in headless Chromium, over a pipe: its DevTools protocol, and no package. */
'use strict';
const { spawn } = require('child_process'), fs = require('fs'), path = require('path');

/* Opens the page. do(text) evaluates an expression in it; until(text) waits for one to be true;
 * shot(name) takes a picture. `requests` are all that left it, `errors` what it threw. */
exports.open = async (url, folder) => {
  const waiting = [], requests = [], errors = [];
  const browser = spawn('chromium', ['--headless=new', '--no-sandbox', '--disable-gpu',
    '--no-first-run', '--remote-debugging-pipe',
    `--user-data-dir=${path.resolve(folder, 'profile')}`],
  { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
  let said = Buffer.alloc(0), sessionId;
  browser.on('error', e => { throw e; });
  browser.stdio[4].on('data', piece => {
    said = Buffer.concat([said, piece]);
    for (let end; (end = said.indexOf(0)) >= 0; said = said.subarray(end + 1)) {
      const { id, method, params, result, error } = JSON.parse(said.subarray(0, end));
      waiting[id]?.(error ? Promise.reject(Error(error.message)) : result);
      if (method === 'Network.requestWillBeSent')
        requests.push(params.request.url);
      if (method === 'Runtime.exceptionThrown')
        errors.push(params.exceptionDetails);
    }
  });
  const send = (method, params = {}) => new Promise(done => {
    const id = waiting.push(done) - 1;
    browser.stdio[3].write(JSON.stringify({ id, method, params, sessionId }) + '\0');
  });
  const { targetId } = await send('Target.createTarget', { url: 'about:blank' });
  ({ sessionId } = await send('Target.attachToTarget', { targetId, flatten: true }));
  for (const domain of ['Page', 'Runtime', 'Network'])
    await send(`${domain}.enable`);
  await send('Emulation.setDeviceMetricsOverride', { width: 1280, height: 720, deviceScaleFactor: 1,
    mobile: false });
  const page = { send, requests, errors,
    async do(expression) {
      const r = await send('Runtime.evaluate', { expression, awaitPromise: true,
        returnByValue: true });
      if (r.exceptionDetails)
        throw Error(`${expression}: ${r.exceptionDetails.exception.description}`);
      return r.result.value;
    },
    async until(expression) {
      for (const start = Date.now(); !await page.do(expression);) {
        await new Promise(done => setTimeout(done, 50));
        if (Date.now() - start > 60e3)
          throw Error(`after a minute not yet: ${expression}`);
      }
    },
    async go(to) {
      for (const next of ['about:blank', to])
        await send('Page.navigate', { url: next });
      await page.until('typeof loadModel === "function" && run !== null');
    },
    async shot(name) {
      const { data } = await send('Page.captureScreenshot');
      fs.writeFileSync(path.join(folder, `${name}.png`), Buffer.from(data, 'base64'));
    },
    close: () => browser.kill() };
  await page.go(url);
  return page;
};
