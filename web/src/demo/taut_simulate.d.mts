import type { CreateModule } from "./module.js";

/** Written by emscripten (apps/browser). */
declare const create: CreateModule;
export default create;
