// Prints schemas published by Foxglove, by name, as JSON.
//
//   node foxglove_schemas.mjs NAME...
import { createRequire } from "node:module";

const schemas = createRequire(import.meta.url)("@foxglove/schemas/jsonschema");
console.log(JSON.stringify(Object.fromEntries(process.argv.slice(2).map((name) => [name, schemas[name]]))));
