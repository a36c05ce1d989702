/** The one place that binds templates and hooks together; every component imports from here. */
import { h, render, Fragment } from "/static/vendor/preact/preact.mjs";
import htm from "/static/vendor/htm/htm.mjs";

export { Fragment, render };
export { useEffect, useId, useLayoutEffect, useMemo, useRef, useState } from "/static/vendor/preact/hooks.mjs";
export const html = htm.bind(h);
