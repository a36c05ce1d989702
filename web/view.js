/** The one place that binds templates and hooks together; every component imports from here. */
import { h, render, Fragment } from "./vendor/preact/preact.mjs";
import * as hooks from "./vendor/preact/hooks.mjs";
import htm from "./vendor/htm/htm.mjs";

export { Fragment, render };
export { useEffect, useId, useLayoutEffect, useMemo } from "./vendor/preact/hooks.mjs";

/** @type {import("./types").UseState} */
export const useState = hooks.useState;

/** @type {import("./types").UseRef} */
export const useRef = hooks.useRef;

/** @type {(strings: TemplateStringsArray, ...values: any[]) => any} */
export const html = htm.bind(h);
