// Of requests that are overtaken only the newest counts: `newest.js` of the page, which needs no browser.
//
// Usage: node newest.mjs
import { deepEqual, equal, rejects } from 'node:assert/strict';
import { readFile } from 'node:fs/promises';

const text = await readFile(new URL('../../src/explorer/page/newest.js', import.meta.url), 'utf8');
const { Newest, OneAtATime } = await import(`data:text/javascript,${encodeURIComponent(text)}`);

const asked = [];
let answer = () => {};
const line = new OneAtATime((what) => {
  asked.push(what);
  return new Promise((done) => (answer = done));
});
const turn = () => new Promise((done) => setTimeout(done));

const all = line.want(1);
deepEqual(asked, [1], 'the first is asked for at once');
line.want(2);
const last = line.want(3);
await turn();
deepEqual(asked, [1], 'while it is on its way no other is');
answer();
await turn();
deepEqual(asked, [1, 3], 'then the newest, and what it overtook never');
line.want(4);
line.forget();
answer();
await Promise.all([all, last]);
deepEqual(asked, [1, 3], 'what is not wanted any more is not asked for');
const again = line.want(5);
deepEqual(asked, [1, 3, 5], 'after that the next is asked for at once');
answer();
await again;

const broken = new OneAtATime(async (what) => {
  if (what) throw new Error(what);
});
await rejects(broken.want('no answer'), 'a failure is told');
await broken.want('');

const requests = new Newest();
const first = requests.begin();
equal(requests.is(first), true);
const second = requests.begin();
equal(requests.is(first), false, 'what was overtaken is dropped');
equal(requests.is(second), true);
console.log('ok   explorer: of requests that are overtaken only the newest counts');
