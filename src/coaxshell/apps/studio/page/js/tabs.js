// The tabs of the lower panel, as the ARIA pattern has it: arrows move, one tab in the order of the page.
import { by } from "./dom.js";

const tabs = [...document.querySelectorAll('[role="tab"]')];
const watchers = new Set();

export const onTab = (watcher) => watchers.add(watcher);
export const shown = () => tabs.find((tab) => tab.getAttribute("aria-selected") === "true").getAttribute("aria-controls");

export function choose(name) {
  for (const tab of tabs) {
    const mine = tab.getAttribute("aria-controls") === name;
    tab.setAttribute("aria-selected", String(mine));
    tab.tabIndex = mine ? 0 : -1;
    by(tab.getAttribute("aria-controls")).hidden = !mine;
  }
  for (const watcher of watchers) watcher(name);
}

tabs.forEach((tab, i) => {
  tab.addEventListener("click", () => choose(tab.getAttribute("aria-controls")));
  tab.addEventListener("keydown", (event) => {
    const next = { ArrowRight: i + 1, ArrowLeft: i - 1, Home: 0, End: tabs.length - 1 }[event.key];
    if (next === undefined) return;
    event.preventDefault();
    const other = tabs.at(next % tabs.length);
    choose(other.getAttribute("aria-controls"));
    other.focus();
  });
});
