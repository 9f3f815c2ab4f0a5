// Complexes in WebAssembly, in a browser or in Node: a file is read into the module's memory and asked there.
//
//     import { Complex, RELATION } from "./sig.mjs";
//     const response = await fetch("bunny.sigc");
//     const bunny = await Complex.read(response.body, bits => fetch(`sig${bits}.wasm`).then(part => part.arrayBuffer()));
//     bunny.ask(RELATION.star, 17);        // a Uint32Array, of use until the next question
//
// The names and numbers are those of ../ffi/include/sig.h.

export const RELATION = Object.freeze({
    vertices: 0, facets: 1, boundary: 2, closure: 3, coboundary: 4, star: 5, restrictedStar: 6, link: 7, adjacency: 8,
    kAdjacency: 9, parent: 10, children: 11, siblings: 12, prefixed: 13, clusters: 14, cluster: 15,
});

export const STATUS = Object.freeze({
    ok: 0, argument: 1, notAFile: 2, byteOrder: 3, kind: 4, damaged: 5, memory: 6, room: 7, noSimplex: 8, width: 9,
});

export const COMPLEX_WORDS = 210, SCRATCH_WORDS = 12, MAX_DIM = 31;

const HEADER_BYTES = 48, MAGIC = [0x89, 0x53, 0x49, 0x47, 0x0d, 0x0a, 0x1a, 0x0a], AT_WIDTH = 17, AT_LENGTH = 24;
const PAGE = 65536;

/// An error with the status of a call, or of a file that is none.
export class SigError extends Error {
    constructor(what, status) {
        const name = Object.keys(STATUS).find(name => STATUS[name] === status);
        super(`${what}: ${name}`);
        this.status = status;
    }
}

/// A complex in the memory of a module of its own.
export class Complex {
    #exports; #end; #complex; #scratch; #count; #memory = 0; #bytes = 0; #found = 0; #room = 0;

    /// Reads a file from chunks (an async iterable of Uint8Array, such as the body of a response), each copied once, into the
    /// module's memory. `load` gives the bytes of the module for indices of 16 or 32 bits.
    static async read(chunks, load) {
        const complex = new Complex(), header = new Uint8Array(HEADER_BYTES);
        let at = 0, file = 0, length = 0;
        for await (const chunk of chunks) {
            let rest = chunk;
            if (at < HEADER_BYTES) {
                // The header alone is copied twice: it says which module, and how much memory.
                const part = rest.subarray(0, HEADER_BYTES - at);
                header.set(part, at);
                at += part.length;
                rest = rest.subarray(part.length);
                if (at < HEADER_BYTES) continue;
                length = fileLength(header);
                file = await complex.#start(load, header[AT_WIDTH] * 8, length);
                complex.#view().set(header, file);
            }
            if (at + rest.length > length) throw new SigError("read", STATUS.notAFile);
            complex.#view().set(rest, file + at);
            at += rest.length;
        }
        if (at < HEADER_BYTES || at !== length) throw new SigError("read", STATUS.notAFile);
        complex.#check("sig_open", complex.#exports.sig_open(file, length, complex.#complex));
        complex.#makeScratch(complex.#exports.sig_memory_bytes(complex.#complex, 64));
        complex.#makeRoom(64);
        return complex;
    }

    /// Starts the module; where the file goes.
    async #start(load, bits, length) {
        if (bits !== 16 && bits !== 32) throw new SigError("read", STATUS.width);
        const { instance } = await WebAssembly.instantiate(await load(bits), {});
        this.#exports = instance.exports;
        this.#end = this.#exports.__heap_base.value;
        const file = this.#reserve(length);
        this.#complex = this.#reserve(8 * COMPLEX_WORDS);
        this.#scratch = this.#reserve(8 * SCRATCH_WORDS);
        this.#count = this.#reserve(4);
        return file;
    }

    /// The dimension; -1 if the complex is empty.
    get dim() {
        return this.#exports.sig_dim(this.#complex);
    }

    /// The number of simplices of all dimensions.
    get numSimplices() {
        return this.firstOfDim(MAX_DIM + 1);
    }

    /// The first simplex of a dimension; the number of all simplices past the last.
    firstOfDim(dim) {
        return this.#exports.sig_first_of_dim(this.#complex, dim) >>> 0;
    }

    /// The simplex with the given vertices, which must increase; null if there is none.
    find(vertices) {
        if (vertices.length > this.#room) this.#makeRoom(vertices.length);
        new Uint32Array(this.#exports.memory.buffer, this.#found, vertices.length).set(vertices);
        const status = this.#exports.sig_find(this.#complex, this.#found, vertices.length, this.#count);
        if (status === STATUS.noSimplex) return null;
        this.#check("sig_find", status);
        return this.#counted();
    }

    /// The simplices, or vertices, that a relation leads to: a view of the module's memory, until the next question.
    ask(relation, simplex, argument = 0) {
        for (;;) {
            const status = this.#exports.sig_ask(
                this.#complex, this.#scratch, relation, simplex, argument, this.#found, this.#room, this.#count,
            );
            const count = this.#counted();
            if (status === STATUS.memory) this.#makeScratch(Math.max(count, 2 * this.#bytes));
            else if (status === STATUS.room) this.#makeRoom(Math.max(count, 2 * this.#room));
            else {
                this.#check("sig_ask", status);
                return new Uint32Array(this.#exports.memory.buffer, this.#found, count);
            }
        }
    }

    #counted() {
        return new Uint32Array(this.#exports.memory.buffer, this.#count, 1)[0];
    }

    #makeScratch(bytes) {
        this.#memory = this.#reserve(bytes);
        this.#bytes = bytes;
        const made = this.#exports.sig_scratch_init(this.#complex, this.#memory, bytes, this.#scratch);
        this.#check("sig_scratch_init", made);
    }

    #makeRoom(entries) {
        this.#found = this.#reserve(4 * entries);
        this.#room = entries;
    }

    /// Memory that nobody gives back: what is outgrown is at most as much as what is used.
    #reserve(bytes) {
        const start = Math.ceil(this.#end / 64) * 64, memory = this.#exports.memory;
        this.#end = start + bytes;
        const lacking = this.#end - memory.buffer.byteLength;
        if (lacking > 0) memory.grow(Math.ceil(lacking / PAGE));
        return start;
    }

    #view() {
        return new Uint8Array(this.#exports.memory.buffer);
    }

    #check(what, status) {
        if (status !== STATUS.ok) throw new SigError(what, status);
    }
}

/// The length that a header says, up to what WebAssembly can hold.
function fileLength(header) {
    const length = Number(new DataView(header.buffer).getBigUint64(AT_LENGTH, true));
    if (MAGIC.some((byte, at) => header[at] !== byte) || length < HEADER_BYTES || length > 2 ** 32) {
        throw new SigError("read", STATUS.notAFile);
    }
    return length;
}
