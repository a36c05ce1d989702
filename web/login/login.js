// @ts-check
// The way in: a token is exchanged for a session, whose cookie no script can read.

const WAIT_MS = 10_000;
const UNREACHABLE = "The rig does not answer. Is pivotrig still running?";

/**
 * Where to go once the session is open: a place of this site, or its first page.
 * @param {string} search  of this page's address
 * @param {string} origin  of this page
 */
export function target(search, origin) {
  const next = new URLSearchParams(search).get("next") ?? "/";
  try {
    const place = new URL(next, origin);
    return place.origin === origin && !place.pathname.startsWith("/login") ? place.href : `${origin}/`;
  } catch {
    return `${origin}/`;
  }
}

/**
 * What went wrong, or "" when the session is open.
 * @param {string} token
 */
export async function logIn(token) {
  try {
    const answer = await fetch("/api/v1/login", {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify({ token }),
      signal: AbortSignal.timeout(WAIT_MS),
    });
    if (answer.ok) return "";
    return String((await answer.json()).detail ?? UNREACHABLE);
  } catch {
    return UNREACHABLE;
  }
}

/** @param {Document} page */
function attend(page) {
  const form = page.querySelector("form");
  const field = page.querySelector("input");
  const button = page.querySelector("button");
  const problem = page.getElementById("problem");
  if (!form || !field || !button || !problem) return;
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    button.disabled = true;
    problem.textContent = "";
    const wrong = await logIn(field.value.trim());
    if (wrong === "") {
      location.replace(target(location.search, location.origin));
      return;
    }
    button.disabled = false;
    problem.textContent = wrong;
    field.setAttribute("aria-invalid", "true");
    field.select();
  });
  field.focus();
}

if (typeof document !== "undefined") attend(document);
