/** What changes under the hands of somebody who works with it. */

const CONTROLS = "a[href], button, input, select, textarea, summary, [tabindex]";

const nameOf = (e: Element): string => e.id || e.getAttribute("aria-label") || (e.textContent ?? "");
const usable = (e: Element): e is HTMLElement => e instanceof HTMLElement && !e.closest("[hidden]") && !(e as HTMLButtonElement).disabled;

/** Lets `change` work on what an element holds. Who had the focus in there keeps it: where it was, else on what has the
 * same name now, else on what took that place. */
export function keepingFocus(holder: Element, change: () => void): void {
  const had = document.activeElement;
  if (!had || had === holder || !holder.contains(had)) return change();
  const place = [...holder.querySelectorAll(CONTROLS)].indexOf(had);
  const name = nameOf(had);
  change();
  if (document.activeElement !== document.body) return;
  const now = (holder.contains(had) ? [had] : [...holder.querySelectorAll(CONTROLS)]).filter(usable);
  const same = now.find((e) => nameOf(e) === name);
  const next = same ?? now[Math.min(place, now.length - 1)];
  next?.focus({ preventScroll: true });
  if (!(next && next === same && next !== had && had instanceof HTMLInputElement && next instanceof HTMLInputElement)) return;
  next.value = had.value; // somebody types there
  if (had.selectionStart !== null) next.setSelectionRange(had.selectionStart, had.selectionEnd);
}

/** Puts other children in the place of those that an element has. Focus stays, and what was unfolded stays so. */
export function renew(holder: Element, ...children: (Node | string)[]): void {
  const unfolded = new Set([...holder.querySelectorAll("details[open] > summary")].map(nameOf));
  keepingFocus(holder, () => {
    holder.replaceChildren(...children);
    if (unfolded.size === 0) return;
    for (const summary of holder.querySelectorAll("details > summary"))
      if (unfolded.has(nameOf(summary))) (summary.parentElement as HTMLDetailsElement).open = true;
  });
}
