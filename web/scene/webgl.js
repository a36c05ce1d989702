/** Whether this browser can draw in three dimensions at all. */
export function drawsThreeDimensions() {
  const context = document.createElement("canvas").getContext("webgl2");
  // Browsers allow a page only a few of them.
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context !== null;
}
