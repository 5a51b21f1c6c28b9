// Share links of the browser demo, without a browser: web/src/demo/link.ts, compiled on the fly, with links of
// attackers, and with random damage. TAUT_LINKS: number of random links (5000).
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { deflateRawSync, inflateRawSync } from "node:zlib";
import { transformWithEsbuild } from "vite";

const COUNT = Number(process.env.TAUT_LINKS ?? 5000);
const SHIPPED = { "models/prism3.yaml": "taut: 1\n", "experiments/hang.yaml": "taut: 1\nmodel: prism3.yaml\n" };
const MESSAGES = [/^there is no file "/, /^the link is damaged: /, /^the link is longer than /, /^the link unpacks to more than /,
  /^the link belongs to another version of this page: /];
let folder, fragmentOf, sharedBy;

before(async () => {
  const source = fileURLToPath(new URL("../src/demo/link.ts", import.meta.url));
  folder = mkdtempSync(join(tmpdir(), "taut-link-"));
  writeFileSync(join(folder, "link.mjs"), (await transformWithEsbuild(readFileSync(source, "utf8"), source)).code);
  ({ fragmentOf, sharedBy } = await import(pathToFileURL(join(folder, "link.mjs"))));
});
after(() => rmSync(folder, { recursive: true }));

const packed = (text) => `#=${deflateRawSync(text).toString("base64url")}`;
const refusal = async (fragment) => {
  try {
    return await sharedBy(fragment, SHIPPED), "accepted";
  } catch (error) {
    return error.message;
  }
};

test("ALinkHoldsItsTexts", async () => {
  for (const edits of [{}, { "models/prism3.yaml": "" }, { "models/prism3.yaml": "\u{1f980} <script> \0", "experiments/hang.yaml": "x".repeat(200_000) }]) {
    const shared = { path: "experiments/hang.yaml", edits };
    assert.deepEqual(await sharedBy(await fragmentOf(shared), SHIPPED), shared);
  }
});

test("TextsThatAreTooLongForALinkAreRefused", async () => {
  const random = Array.from({ length: 20_000 }, () => Math.random()).join();
  for (const text of [random, "x".repeat(5_000_000)]) {
    await assert.rejects(fragmentOf({ path: "models/prism3.yaml", edits: { "models/prism3.yaml": text } }), /too long for a link/);
  }
});

test("NamesOfBuiltInPropertiesAreNoFiles", async () => {
  for (const name of ["constructor", "toString", "__proto__", "hasOwnProperty"]) {
    assert.equal(await refusal(`#${name}`), `there is no file "${name}"`);
    assert.equal(await refusal(packed(`{"path": "${name}", "edits": {}}`)), `there is no file "${name}"`);
    assert.match(await refusal(packed(`{"path": "models/prism3.yaml", "edits": {"${name}": "text"}}`)), /unknown files/);
  }
});

test("LinksWithoutAnObjectAreDamaged", async () => {
  for (const text of ["null", "1", "\"text\"", "", "[", "{\"path\": "]) assert.match(await refusal(packed(text)), /^the link is damaged: /);
  for (const fragment of ["#%", "#%ff", "#=%", "#=AAAA", "#="]) assert.match(await refusal(fragment), /^the link is damaged: /);
  assert.match(await refusal(packed("[]")), /unknown files/);
});

test("AFewPackedBytesDoNotBecomeGigabytes", async () => {
  const bomb = packed(Buffer.alloc(40_000_000, " "));
  assert.ok(bomb.length < 60_000);
  assert.equal(await refusal(bomb), "the link unpacks to more than 4 MB");
  assert.equal(await refusal(`#=${"A".repeat(60_000)}`), "the link is longer than 60000 characters");
});

/** Random numbers of mulberry32, which follow from the seed. */
function randomOf(seed) {
  return (below) => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return Math.floor((((t ^ (t >>> 14)) >>> 0) / 2 ** 32) * below);
  };
}

/** Replaces, removes, repeats or inserts some bytes. */
function damaged(bytes, random) {
  const words = ["__proto__", "constructor", "null", "{", "}", "[", "\"", ":", "\\u0000", "path", "edits", "models/prism3.yaml", "%", "="];
  let out = Buffer.from(bytes);
  for (let i = random(4); i >= 0; --i) {
    const at = random(out.length + 1), end = Math.min(out.length, at + 1 + random(8));
    const middle = [Buffer.from([random(256)]), Buffer.alloc(0), out.subarray(at, end), Buffer.from(words[random(words.length)])][random(4)];
    out = Buffer.concat([out.subarray(0, at), middle, out.subarray(random(2) ? at : end)]);
  }
  return out;
}

test("RandomDamageIsAcceptedOrHasAMessage", async () => {
  const seed = Number(process.env.TAUT_LINKS_SEED ?? 1), random = randomOf(seed);
  const good = await fragmentOf({ path: "experiments/hang.yaml", edits: { "models/prism3.yaml": "taut: 1\nkind: model\n" } });
  const text = inflateRawSync(Buffer.from(good.slice(2), "base64url"));
  for (let i = 0; i < COUNT; ++i) {
    // Damage of the address, of the packed bytes, of the text
    const fragment = [() => `#${damaged(Buffer.from(random(2) ? good.slice(1) : "models/prism3.yaml"), random).toString("latin1")}`,
      () => `#=${damaged(Buffer.from(good.slice(2), "base64url"), random).toString("base64url")}`,
      () => packed(damaged(text, random))][random(3)]();
    try {
      const shared = await sharedBy(fragment, SHIPPED);
      if (shared === null) continue;
      assert.ok(Object.hasOwn(SHIPPED, shared.path), fragment);
      for (const [name, one] of Object.entries(shared.edits)) assert.ok(Object.hasOwn(SHIPPED, name) && typeof one === "string", fragment);
      assert.deepEqual(await sharedBy(await fragmentOf(shared), SHIPPED), shared, fragment);
    } catch (error) {
      assert.ok(MESSAGES.some((message) => message.test(error.message)), `seed ${seed}, ${fragment}: ${error.stack}`);
    }
  }
});
