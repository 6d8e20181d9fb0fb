// LAMMPS in a worker: the page stays live while a deck runs. One message with files in, one with what the deck wrote out.
import createModule from "./lammps/lammps.js";

let current = null;
const engine = createModule({
  print: (line) => {
    if (current !== null && line.includes("Stopping criterion")) postMessage({ id: current, relaxed: true });
  },
  printErr: () => {},
});
engine.then(
  () => postMessage({ ready: true }),
  (error) => postMessage({ failed: `LAMMPS could not be started in this browser: ${error.message ?? error}` }),
);

onmessage = async ({ data: { id, files } }) => {
  const { FS, LAMMPSWeb } = await engine;
  const start = performance.now();
  const folder = `/run${id}`;
  FS.mkdir(folder);
  FS.chdir(folder);
  for (const [name, text] of Object.entries(files)) FS.writeFile(name, text);
  const lammps = new LAMMPSWeb();
  try {
    current = id;
    lammps.start();
    lammps.runFile("in.lammps");
    lammps.stop();
    const [curve, states] = ["curve.txt", "states.lammpstrj"].map((name) => FS.readFile(name, { encoding: "utf8" }));
    postMessage({ id, curve, states, seconds: (performance.now() - start) / 1000 });
  } catch (error) {
    const reason = lammps.getLastErrorMessage?.() || error.message || String(error);
    postMessage({ id, failed: `LAMMPS stopped: ${reason}` });
  } finally {
    current = null;
    lammps.delete?.();
    for (const name of FS.readdir(folder)) if (FS.isFile(FS.stat(name).mode)) FS.unlink(name);
    FS.chdir("/");
    FS.rmdir(folder);
  }
};
