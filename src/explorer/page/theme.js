// @ts-check
// Light or dark: what the system says, until it is chosen.
import { emit } from './state.js';

const system = matchMedia('(prefers-color-scheme: dark)');
/** @type {string | null} */
let chosen = null;
try {
  chosen = localStorage.getItem('inbetween-theme');
} catch { /* no storage */ }

function apply() {
  document.documentElement.dataset.theme = chosen ?? (system.matches ? 'dark' : 'light');
  emit('theme');
}

export const isDark = () => document.documentElement.dataset.theme === 'dark';

export function flipTheme() {
  chosen = isDark() ? 'light' : 'dark';
  if ((chosen === 'dark') === system.matches) chosen = null;
  try {
    if (chosen) localStorage.setItem('inbetween-theme', chosen);
    else localStorage.removeItem('inbetween-theme');
  } catch { /* no storage */ }
  apply();
}

system.addEventListener('change', apply);
apply();
