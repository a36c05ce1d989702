import assert from "node:assert/strict";
import test from "node:test";

import { projection } from "../../web/camera/projection.js";
import { columnsOf, indexAt, mayHavePictures, pathAt, recordingOf, trailTo } from "../../web/replay/recording.js";

const RUN = { id: "r1", label: "eight", state: "finished", started_at: "2026-11-23T12:00:00Z", controller: "geometric", trajectory: { name: "eight" } };

test("the index at a time is that of the last value not after it", () => {
  const times = [0, 0.1, 0.1, 0.5];
  assert.deepEqual([-1, 0, 0.05, 0.1, 0.4, 0.5, 9].map((time) => indexAt(times, time)), [-1, 0, 0, 2, 2, 3, 3]);
  assert.equal(indexAt([], 1), -1);
});

test("angles go on over the turn instead of jumping back, and stay together", () => {
  const { heading_deg, heading_measured_deg } = columnsOf({
    time_s: [0, 1, 2, 3, 4], heading_deg: [170, 179, null, -178, -170], heading_measured_deg: [171, -179, null, null, 191],
  });
  assert.deepEqual(heading_deg, [170, 179, null, 182, 190]);
  assert.deepEqual(heading_measured_deg, [171, 181, null, null, 191]);
});

test("columns that were not recorded are there and empty", () => {
  const columns = columnsOf({ time_s: [0, 1] });
  assert.deepEqual(columns.error_mm, [null, null]);
  assert.deepEqual(columnsOf({}).time_s, []);
});

test("the path is the one that was walked at the time, the first one before all", () => {
  const paths = [{ time_s: 1, points_mm: [[0, 0]] }, { time_s: 5, points_mm: [[9, 9]] }];
  assert.deepEqual([0, 1, 4.9, 5].map((time) => pathAt({ paths }, time)[0][0]), [0, 0, 0, 9]);
  assert.equal(pathAt({ paths: [] }, 1), null);
});

test("the trail ends at the robot, skips what is not known and is no longer than the rig's", () => {
  const count = 1000;
  const time_s = Array.from({ length: count }, (_, index) => index);
  const x_mm = time_s.map((time) => (time % 7 === 0 ? null : time));
  const trail = trailTo({ series: { time_s, x_mm, y_mm: time_s.map(() => 0) } }, 990, { x_mm: 990.5, y_mm: 0 });
  assert.deepEqual(trail.at(-1), [990.5, 0]);
  assert.ok(trail.every(([x]) => x !== null));
  const length = trail.at(-1)[0] - trail[0][0];
  assert.ok(length > 260 && length < 280, `${length} mm`);
});

test("a recording without much in it is still a recording", () => {
  const recording = recordingOf(RUN, {});
  assert.equal(recording.duration_s, 0);
  assert.equal(recording.name, "eight");
  assert.equal(recording.parts, "geometric · eight");
  assert.equal(mayHavePictures(recording), true);
  assert.equal(mayHavePictures(recordingOf(RUN, { frames: 0 })), false);
});

test("where nobody knows the camera the plate is seen from straight above, whole and the right way up", () => {
  const { camera, half_mm } = recordingOf(RUN, {});
  const project = projection(camera.model);
  for (const [x, y] of [[half_mm, half_mm], [-half_mm, -half_mm]]) {
    const [u, v] = project(x, y);
    assert.ok(u >= 0 && u <= camera.size[0] && v >= 0 && v <= camera.size[1], `${u}, ${v} px`);
  }
  assert.ok(project(0, 10)[1] < project(0, 0)[1] && project(10, 0)[0] > project(0, 0)[0]);
});
