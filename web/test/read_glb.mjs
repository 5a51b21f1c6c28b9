// Validates a .glb file with the Khronos Group's validator, loads it with three.js, and prints the results as
// JSON.
//
//   node read_glb.mjs FILE
import { readFileSync } from "node:fs";
import { Box3, Vector3 } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import validator from "gltf-validator";

const bytes = new Uint8Array(readFileSync(process.argv[2]));
const report = await validator.validateBytes(bytes, { maxIssues: 50 });
const issues = report.issues.messages.map(({ code, message, pointer, severity }) => ({ code, message, pointer, severity }));

globalThis.self ??= globalThis;
const { scene } = await new GLTFLoader().parseAsync(bytes.buffer, "");
scene.updateMatrixWorld(true);

/** Returns the volume enclosed by closed triangles. */
function volumeOf(mesh) {
  const { position } = mesh.geometry.attributes;
  const index = mesh.geometry.index.array;
  const [a, b, c] = [new Vector3(), new Vector3(), new Vector3()];
  const origin = new Vector3().fromBufferAttribute(position, index[0]);
  let six = 0;
  for (let i = 0; i < index.length; i += 3) {
    [a, b, c].forEach((point, k) => point.fromBufferAttribute(position, index[i + k]).sub(origin));
    six += a.dot(b.clone().cross(c));
  }
  return six / 6;
}

const meshes = [];
const nodes = [];
const places = {};
scene.traverse((object) => {
  if (object.isMesh) {
    const { material } = object;
    meshes.push({
      name: object.userData.name ?? object.name,
      parent: object.parent.userData.name ?? object.parent.name,
      material: material.name,
      colour: material.color.toArray(),
      volume: volumeOf(object),
      middle: new Box3().setFromObject(object, true).getCenter(new Vector3()).toArray(),
    });
  } else {
    const name = object.userData.name ?? object.name;
    nodes.push(name);
    places[name] = object.getWorldPosition(new Vector3()).toArray();
  }
});
console.log(JSON.stringify({ issues, meshes, nodes, places }));
