// What is wrong with how the page lies in its window, as sentences; evaluated by the tests in the page.
() => {
  const faults = [];
  const LEAST = 44; // px, of what a finger finds without looking
  const wide = document.documentElement.scrollWidth;
  if (wide > innerWidth) faults.push(`the page is ${wide} px wide in a window of ${innerWidth} px`);

  const name = (element) => {
    const words = (element.getAttribute("aria-label") ?? element.textContent ?? "").trim().replace(/\s+/g, " ").slice(0, 40);
    return `<${element.tagName.toLowerCase()} class="${element.getAttribute("class") ?? ""}"> “${words}”`;
  };
  const isSeen = (element) => {
    const style = getComputedStyle(element);
    return element.checkVisibility({ opacityProperty: true, visibilityProperty: true }) && !element.closest(".unseen")
      && style.clipPath !== "inset(50%)";
  };

  /** Where the lines of a text are laid out. */
  const linesOf = (node) => {
    const range = document.createRange();
    range.selectNodeContents(node);
    return [...range.getClientRects()].filter(({ width, height }) => width > 1 && height > 1);
  };

  /** What hides or scrolls the rest of what it holds. */
  const holderOf = (element) => {
    for (let at = element; at && at !== document.body; at = at.parentElement) {
      const style = getComputedStyle(at);
      if (style.position === "fixed") return null;
      if (style.overflowX !== "visible" && style.display !== "inline") return { at, style };
    }
    return null;
  };

  /** The part of a line that its holder shows. */
  const shownOf = (line, holder) => {
    if (!holder) return line;
    const box = holder.at.getBoundingClientRect();
    const [left, right] = [Math.max(line.left, box.left), Math.min(line.right, box.right)];
    const [top, bottom] = [Math.max(line.top, box.top), Math.min(line.bottom, box.bottom)];
    return { left, right, top, bottom };
  };

  const texts = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const parent = node.parentElement;
    if (!node.data.trim() || !parent || parent.closest("svg, noscript, script, option, canvas") || !isSeen(parent)) continue;
    const lines = linesOf(node);
    if (lines.length > 0) texts.push({ node, parent, lines });
  }

  // A text is cut when what holds it hides a part of it, unless the whole of it can be read in its title.
  for (const { parent, lines } of texts) {
    const holder = holderOf(parent);
    if (!holder) continue;
    const box = holder.at.getBoundingClientRect();
    const right = Math.max(...lines.map((line) => line.right));
    const hides = ["hidden", "clip"].includes(holder.style.overflowX);
    const told = parent.closest("[title]") !== null;
    if (hides && right > box.right + 1 && !told) faults.push(`${name(parent)} is cut by ${Math.round(right - box.right)} px`);
  }

  // Two texts that lie on each other, neither in a layer above the page.
  const layerOf = (element) => {
    for (let at = element; at && at !== document.body; at = at.parentElement) {
      const { position, overflowY, overflowX } = getComputedStyle(at);
      if (["fixed", "sticky", "absolute"].includes(position)) return at;
      if (["auto", "scroll"].includes(overflowY) || ["auto", "scroll"].includes(overflowX)) return at;
    }
    return document.body;
  };
  const placed = texts.map(({ parent, lines }) => {
    const holder = holderOf(parent);
    return { parent, lines: lines.map((line) => shownOf(line, holder)), layer: layerOf(parent) };
  });
  const within = 3;
  const meet = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > within
    && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > within;
  for (let i = 0; i < placed.length; i += 1) {
    for (let j = i + 1; j < placed.length; j += 1) {
      const [a, b] = [placed[i], placed[j]];
      if (a.layer !== b.layer || a.parent === b.parent) continue;
      if (a.lines.some((line) => b.lines.some((other) => meet(line, other)))) {
        faults.push(`${name(a.parent)} lies on ${name(b.parent)}`);
      }
    }
  }

  // STOP: in the window, and nothing before it.
  const stop = [...document.querySelectorAll("button")].find((button) => button.textContent === "STOP");
  const box = stop?.getBoundingClientRect();
  if (!box) return [...faults, "there is no STOP"];
  const inside = box.left >= 0 && box.top >= 0 && box.right <= innerWidth && box.bottom <= innerHeight;
  if (!inside) faults.push("STOP lies outside the window");
  if (Math.min(box.width, box.height) < LEAST) faults.push(`STOP is only ${box.width} × ${box.height} px`);
  const before = document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2);
  if (inside && before !== stop) faults.push(`${before ? name(before) : "nothing"} lies before STOP`);

  // Fingers find STOP and the jog without looking; the smaller sizes of everything else are axe's to judge.
  for (const pad of [...document.querySelectorAll(".jog-pad")].filter(isSeen)) {
    const { width, height } = pad.getBoundingClientRect();
    if (Math.min(width, height) < LEAST) faults.push(`${name(pad)} is only ${width} × ${height} px`);
  }
  // Who asks for no motion gets none.
  const moving = document.getAnimations().filter(({ effect }) => isSeen(effect.target));
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) faults.push(...moving.map(({ effect }) => `${name(effect.target)} moves`));
  return [...new Set(faults)];
}
