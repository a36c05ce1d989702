/** Where the server asks for a token: its own page takes it, and leads back here. */

let isLeaving = false;

export function signIn() {
  if (isLeaving) return;
  isLeaving = true;
  addEventListener("pageshow", () => (isLeaving = false));
  location.assign(`/login?next=${encodeURIComponent(location.pathname + location.search + location.hash)}`);
}
