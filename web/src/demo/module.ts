// Emscripten modules of apps/browser and their in-memory file systems.

/** Exports of the modules. */
export interface Module {
  ccall(name: string, returns: "string" | "number" | null, types: readonly string[], values: readonly unknown[]): unknown;
  HEAPU8: Uint8Array;
  FS: {
    writeFile(path: string, text: string): void;
    unlink(path: string): void;
    mkdirTree(path: string): void;
    chdir(path: string): void;
  };
}

/** Creates a module. `wasmBinary`: its code, for environments without fetch. */
export type CreateModule = (options: { wasmBinary?: Uint8Array }) => Promise<Module>;

/** Error or warning about a file. */
export interface Complaint {
  file: string;
  line: number;
  column: number;
  /** True: an error; false: a warning. */
  error: boolean;
  what: string;
  hint: string;
}

/** Texts of files by path, such as "models/prism3.yaml". */
export type Files = Record<string, string>;

export function writeFiles(module: Module, root: string, files: Files): void {
  for (const [path, text] of Object.entries(files)) {
    const place = `${root}/${path}`;
    module.FS.mkdirTree(place.slice(0, place.lastIndexOf("/")));
    module.FS.writeFile(place, text);
  }
}
