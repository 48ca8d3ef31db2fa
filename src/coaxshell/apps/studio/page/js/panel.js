// A panel that a job feeds: what is known already is drawn at once, anything else is asked for, with progress, and can be cancelled;
// what was shown stays meanwhile, dimmed.
import { request } from "./api.js";
import { el } from "./dom.js";
import { finished } from "./events.js";
import { told } from "./words.js";

const MOST = 12; // answers kept

export class Panel {
  constructor(box, ...controls) {
    Object.assign(this, { kept: new Map(), wanted: "", shown: "", work: null, body: el("div", { class: "panel-body" }), state: el("p", { class: "note", role: "status" }) });
    this.stop = el("button", { type: "button", class: "quiet", hidden: true, onclick: () => this.work?.cancel() }, "Cancel");
    box.replaceChildren(el("div", { class: "player" }, ...controls), el("div", { class: "bar status plain" }, this.state, this.stop), this.body);
  }

  // What a job (kind and entries) comes to, drawn by draw(answer); `words` says what is being done.
  async ask(job, words, draw) {
    const key = JSON.stringify(job), show = (answer) => { this.shown = key; this.body.classList.remove("old"); this.say(""); draw(answer); };
    if (this.kept.has(key)) { this.wanted = key; this.work?.cancel(); this.work = null; return show(this.kept.get(key)); }
    if (this.wanted === key) return null;
    this.work?.cancel();
    this.wanted = key;
    this.body.classList.toggle("old", Boolean(this.shown));
    const mine = (this.work = finished(job, ({ fraction }) => this.work === mine && this.say(`${words}: ${Math.round(100 * (fraction ?? 0))}\u202f%`, true)));
    try {
      const done = await mine.promise, answer = await request(`/api/jobs/${done.id}/result`);
      if (this.work !== mine) return null;
      this.kept.set(key, answer);
      if (this.kept.size > MOST) this.kept.delete(this.kept.keys().next().value);
      show(answer);
    } catch (failure) {
      if (this.work === mine) { this.say(failure.cancelled ? "Cancelled." : told(failure)); this.wanted = ""; }
    }
    return null;
  }

  say(text, busy = false) {
    this.state.textContent = text;
    this.stop.hidden = !busy;
  }

  // Instead of what a job could show, a sentence.
  instead(text) {
    this.work?.cancel();
    Object.assign(this, { work: null, wanted: "", shown: "" });
    this.say("");
    this.body.replaceChildren(el("p", { class: "empty" }, text));
  }

  forget() { this.kept.clear(); Object.assign(this, { shown: "", wanted: "", work: null }); }
}

// The options of a select brought up to date; what is chosen stays if it is still there.
export function offer(select, options, chosen) {
  const text = JSON.stringify(options);
  if (select.dataset.options !== text) {
    select.replaceChildren(...options.map(([value, words]) => el("option", { value }, words)));
    select.dataset.options = text;
  }
  const value = options.some(([one]) => String(one) === String(chosen)) ? chosen : options[0]?.[0] ?? "";
  select.value = value;
  return value;
}
