// @ts-check
// The weights of all poses where the probe is, as bars and numbers.
import { byId, fixed, h } from './dom.js';
import { choosePose, look, on, store } from './state.js';

const list = byId('weights');
/** @type {{ button: HTMLButtonElement, bar: HTMLElement, seen: HTMLElement, number: HTMLElement, name: string }[]} */
let rows = [];
let names = '';

function build() {
  const now = store.scene.poses.map((pose) => pose.name).join('\n');
  if (now === names) return;
  names = now;
  rows = store.scene.poses.map((pose, index) => {
    const bar = h('span', { class: 'fill' });
    const seen = h('span', { class: 'seen' });
    const number = h('span', { class: 'number' });
    const button = h('button', {
      type: 'button', class: 'weight', title: 'Show its weight over the plane',
      onclick: () => {
        const again = store.pose === index && store.view.map === 'weight';
        choosePose(index);
        look({ map: again ? 'plain' : 'weight' });
      },
    }, h('span', { class: 'name clip' }, pose.name), h('span', { class: 'track' }, bar, seen), number);
    return { button, bar, seen, number, name: pose.name };
  });
  list.replaceChildren(
    h('div', { class: 'caption' }, h('h2', {}, 'Weights'),
      h('span', { class: 'faint small' }, 'bar: shape', h('span', { class: 'tick' }), 'texture')),
    ...rows.map((row) => row.button));
}

function draw() {
  if (!store.frame) return;
  rows.forEach((row, index) => {
    const weight = store.frame.weights[index] ?? 0;
    const seen = store.frame.textureWeights[index] ?? 0;
    row.bar.style.transform = `scaleX(${Math.min(Math.abs(weight), 1)})`;
    row.seen.style.left = `${Math.min(Math.max(seen, 0), 1) * 100}%`;
    row.button.classList.toggle('below', weight < -5e-4);
    row.button.classList.toggle('above', weight > 1 + 5e-4);
    row.button.setAttribute('aria-pressed', String(store.pose === index));
    row.number.textContent = fixed(weight, 3);
    row.button.setAttribute('aria-label', `${row.name}: weight ${weight.toFixed(3)}, texture ${seen.toFixed(3)}`);
  });
}

on('scene', () => {
  build();
  draw();
});
on('frame pose', draw);
