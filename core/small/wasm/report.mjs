// The report of a complex, as `host` prints it: a line for each relation, how many simplices it leads to and their checksum.

import { RELATION } from "./sig.mjs";

const BY_DIM = [RELATION.boundary, RELATION.coboundary, RELATION.kAdjacency];

/// As `ask::mix`.
function mix(a, b) {
    let bits = (Math.imul(a, 0x9e3779b1) + b) | 0;
    bits = Math.imul(bits ^ (bits >>> 16), 0x85ebca6b);
    bits = Math.imul(bits ^ (bits >>> 13), 0xc2b2ae35);
    return bits ^ (bits >>> 16);
}

/// The lines of the report of a complex.
export function report(complex) {
    const total = complex.numSimplices, lines = [`simplices ${total}`];
    for (const [name, relation] of Object.entries(RELATION)) {
        let count = 0, checksum = 0;
        for (let simplex = 0; simplex < total; simplex++) {
            for (const argument of argumentsOf(complex, relation, simplex)) {
                const found = complex.ask(relation, simplex, argument), key = mix(simplex, argument);
                for (const id of found) checksum = (checksum + mix(key, id)) | 0;
                count += found.length;
            }
        }
        const title = name.replace(/[A-Z]/g, letter => `-${letter.toLowerCase()}`);
        lines.push(`${title} ${count} ${(checksum >>> 0).toString(16).padStart(8, "0")}`);
    }
    for (let simplex = 0; simplex < total; simplex++) {
        const found = complex.find(complex.ask(RELATION.vertices, simplex));
        if (found !== simplex) throw new Error(`the vertices of ${simplex} are those of ${found}`);
    }
    if (complex.find([total]) !== null || complex.ask(RELATION.star, total).length !== 0) {
        throw new Error("there is a simplex too many");
    }
    return lines;
}

function argumentsOf(complex, relation, simplex) {
    if (BY_DIM.includes(relation)) return Array.from({ length: complex.dim + 1 }, (_, dim) => dim);
    if (relation === RELATION.cluster) return Array.from(complex.ask(RELATION.clusters, simplex));
    return [0];
}
