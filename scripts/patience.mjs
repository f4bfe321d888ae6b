// Waiting for a program by the work that it does, because machines differ and are shared; luthier-workshop/src/patience.rs has the same rule
// for tests in Rust.

import { readdirSync, readFileSync } from "node:fs";

const LOOK_MS = 200;
/** Processor time without progress after which a program has hung, in ticks of 10 ms: an hour. */
const WORK_MAX = 360_000;
/** Looks at which all of its threads slept, ten minutes of sleep. */
const ASLEEP_MAX = 3_000;

/** Fields of a `stat` file behind the name of the program; none where it has ended. */
function fields(path) {
  try {
    return readFileSync(path, "utf8").split(") ").at(-1).split(" ");
  } catch {
    return undefined;
  }
}

/** Processor time of a process and its descendants, and whether all of their threads sleep. */
function seen(process) {
  const stat = fields(`/proc/${process}/stat`);
  if (!stat) return { ticks: 0, isAsleep: true };
  const all = { ticks: stat.slice(11, 15).reduce((sum, field) => sum + Number(field), 0), isAsleep: true };
  let tasks = [];
  let children = [];
  try {
    tasks = readdirSync(`/proc/${process}/task`);
    children = tasks.flatMap((task) => readFileSync(`/proc/${process}/task/${task}/children`, "utf8").split(" ").filter(Boolean));
  } catch {
    // It has ended meanwhile.
  }
  all.isAsleep = tasks.every((task) => "SIZX".includes(fields(`/proc/${process}/task/${task}/stat`)?.[0] ?? "X"));
  for (const { ticks, isAsleep } of children.map(seen)) {
    all.ticks += ticks;
    all.isAsleep &&= isAsleep;
  }
  return all;
}

/**
 * A promise that fails once a process and its descendants have used too much processor time since the last progress, or slept too long. Neither
 * grows while they wait for a processor. `progress` begins anew. Without Linux' /proc it never fails.
 */
export function patience(process) {
  let before = 0;
  let asleep = 0;
  let fail;
  const failed = new Promise((_, reject) => (fail = reject));
  const look = () => {
    const { ticks, isAsleep } = seen(process);
    // Where there is no /proc, there is neither work nor sleep.
    if (ticks === 0) return;
    asleep += isAsleep ? 1 : 0;
    if (ticks - before > WORK_MAX) fail(new Error(`${Math.round((ticks - before) / 100)} s of processor time without progress`));
    if (asleep > ASLEEP_MAX) fail(new Error(`asleep at ${asleep} looks, without progress`));
  };
  setInterval(look, LOOK_MS).unref();
  const progress = () => {
    before = seen(process).ticks;
    asleep = 0;
  };
  return { failed, progress };
}
