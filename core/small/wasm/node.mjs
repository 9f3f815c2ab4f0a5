// The report of files in Node: node node.mjs FOLDER-OF-MODULES HEADER FILE...
//
// Compares the numbers in sig.mjs with the header for C, too, and shows that what is no file is refused.

import assert from "node:assert/strict";
import { createReadStream, readFileSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { COMPLEX_WORDS, Complex, MAX_DIM, RELATION, SCRATCH_WORDS, STATUS } from "./sig.mjs";
import { report } from "./report.mjs";

const [modules, header, ...files] = process.argv.slice(2);
const load = bits => readFile(`${modules}/sig${bits}.wasm`);

const text = readFileSync(header, "utf8");
const constant = name => name.replace(/[A-Z]/g, letter => `_${letter}`).toUpperCase();
for (const [kind, numbers] of Object.entries({ STATUS, RELATION })) {
    const expected = Object.entries(numbers).map(([name, number]) => `SIG_${kind}_${constant(name)} = ${number}`);
    assert.deepEqual([...text.matchAll(new RegExp(`SIG_${kind}_\\w+ = \\d+`, "g"))].map(String), expected);
}
for (const [name, number] of Object.entries({ COMPLEX_WORDS, SCRATCH_WORDS, MAX_DIM })) {
    assert.match(text, new RegExp(`#define SIG_${name} ${number}\n`));
}

for (const file of files) {
    const bytes = readFileSync(file);
    for (const part of [[], [bytes.subarray(0, 40)], [bytes.subarray(0, bytes.length - 1)], [bytes.subarray(1)], [bytes, bytes]]) {
        await assert.rejects(Complex.read(part, load), { status: STATUS.notAFile });
    }
    const damaged = Uint8Array.from(bytes);
    damaged[60] ^= 1;
    await assert.rejects(Complex.read([damaged], load), { status: STATUS.damaged });
    console.log(report(await Complex.read(createReadStream(file), load)).join("\n"));
}
