/* The report of complexes in files that this program maps itself, as `host` prints it: a line for each relation, how many
 * simplices it leads to and their checksum. */
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "sig.h"

_Static_assert(sizeof(sig_complex) == 8 * SIG_COMPLEX_WORDS, "what sig_open writes");
_Static_assert(sizeof(sig_scratch) == 8 * SIG_SCRATCH_WORDS, "what sig_scratch_init writes");

static const struct {
    uint32_t relation;
    const char *name;
} relations[] = {
    {SIG_RELATION_VERTICES, "vertices"},
    {SIG_RELATION_FACETS, "facets"},
    {SIG_RELATION_BOUNDARY, "boundary"},
    {SIG_RELATION_CLOSURE, "closure"},
    {SIG_RELATION_COBOUNDARY, "coboundary"},
    {SIG_RELATION_STAR, "star"},
    {SIG_RELATION_RESTRICTED_STAR, "restricted-star"},
    {SIG_RELATION_LINK, "link"},
    {SIG_RELATION_ADJACENCY, "adjacency"},
    {SIG_RELATION_K_ADJACENCY, "k-adjacency"},
    {SIG_RELATION_PARENT, "parent"},
    {SIG_RELATION_CHILDREN, "children"},
    {SIG_RELATION_SIBLINGS, "siblings"},
    {SIG_RELATION_PREFIXED, "prefixed"},
    {SIG_RELATION_CLUSTERS, "clusters"},
    {SIG_RELATION_CLUSTER, "cluster"},
};

/* All memory that queries take. */
enum { MOST = 4096 };
static uint64_t memory[4096];
static size_t found[MOST], representatives[MOST];

static void fail(const char *what, int status) {
    fprintf(stderr, "%s: status %d\n", what, status);
    exit(1);
}

static void expect(int status, int expected, const char *what) {
    if (status != expected) {
        fail(what, status);
    }
}

/* As `ask::mix`. */
static uint32_t mix(uint32_t a, uint32_t b) {
    uint32_t bits = a * UINT32_C(0x9E3779B1) + b;
    bits = (bits ^ (bits >> 16)) * UINT32_C(0x85EBCA6B);
    bits = (bits ^ (bits >> 13)) * UINT32_C(0xC2B2AE35);
    return bits ^ (bits >> 16);
}

struct summary {
    uint32_t count, checksum;
};

static void add(const sig_complex *complex, sig_scratch *scratch, uint32_t relation, size_t simplex, size_t argument,
                struct summary *summary) {
    size_t count = 0;
    expect(sig_ask(complex, scratch, relation, simplex, argument, found, MOST, &count), SIG_STATUS_OK, "sig_ask");
    for (size_t at = 0; at < count; at++) {
        summary->checksum += mix(mix((uint32_t)simplex, (uint32_t)argument), (uint32_t)found[at]);
    }
    summary->count += (uint32_t)count;
}

static void survey(const sig_complex *complex, sig_scratch *scratch, size_t relation, size_t total) {
    struct summary summary = {0, 0};
    const uint32_t code = relations[relation].relation;
    const int by_dim = code == SIG_RELATION_BOUNDARY || code == SIG_RELATION_COBOUNDARY || code == SIG_RELATION_K_ADJACENCY;
    for (size_t simplex = 0; simplex < total; simplex++) {
        if (code == SIG_RELATION_CLUSTER) {
            size_t clusters = 0;
            expect(sig_ask(complex, scratch, SIG_RELATION_CLUSTERS, simplex, 0, representatives, MOST, &clusters),
                   SIG_STATUS_OK, "sig_ask");
            for (size_t at = 0; at < clusters; at++) {
                add(complex, scratch, code, simplex, representatives[at], &summary);
            }
        } else {
            const size_t arguments = by_dim ? (size_t)(sig_dim(complex) + 1) : 1;
            for (size_t argument = 0; argument < arguments; argument++) {
                add(complex, scratch, code, simplex, argument, &summary);
            }
        }
    }
    printf("%s %" PRIu32 " %08" PRIx32 "\n", relations[relation].name, summary.count, summary.checksum);
}

/* What each simplex is called is where it is found. */
static void find_all(const sig_complex *complex, sig_scratch *scratch, size_t total) {
    for (size_t simplex = 0; simplex < total; simplex++) {
        size_t count = 0, id = 0;
        expect(sig_ask(complex, scratch, SIG_RELATION_VERTICES, simplex, 0, found, MOST, &count), SIG_STATUS_OK, "sig_ask");
        expect(sig_find(complex, found, count, &id), SIG_STATUS_OK, "sig_find");
        if (id != simplex) {
            fail("sig_find found another simplex", 0);
        }
    }
    const size_t nobody = total;
    size_t id = 0;
    expect(sig_find(complex, &nobody, 1, &id), SIG_STATUS_NO_SIMPLEX, "sig_find of no simplex");
}

/* From no entry at all, the errors lead to enough memory. */
static void grow(const sig_complex *complex) {
    sig_scratch scratch;
    size_t bytes = sig_memory_bytes(complex, 0), count = 0;
    if (bytes == 0) {
        return; /* Without simplices there is nothing to grow for. */
    }
    expect(sig_scratch_init(complex, (uint8_t *)memory, bytes - 1, &scratch), SIG_STATUS_MEMORY, "no room for marks");
    int status, errors = 0;
    do {
        if (bytes > sizeof memory) {
            fail("more than there is", 0);
        }
        expect(sig_scratch_init(complex, (uint8_t *)memory, bytes, &scratch), SIG_STATUS_OK, "sig_scratch_init");
        status = sig_ask(complex, &scratch, SIG_RELATION_STAR, 0, 0, found, MOST, &count);
        if (status == SIG_STATUS_MEMORY && (count <= bytes || ++errors > MOST)) {
            fail("an error asked for what there was", status);
        }
        bytes = status == SIG_STATUS_MEMORY ? count : bytes;
    } while (status == SIG_STATUS_MEMORY);
    expect(status, SIG_STATUS_OK, "a star");
    const size_t entries = count;
    expect(sig_ask(complex, &scratch, SIG_RELATION_STAR, 0, 0, found, entries - 1, &count), SIG_STATUS_ROOM, "too little room");
    if (errors == 0 || count != entries) {
        fail("the errors were others", errors);
    }
}

/* What a caller may get wrong is told. */
static void refuse(const uint8_t *bytes, size_t length, const sig_complex *complex, sig_scratch *scratch) {
    sig_complex other;
    size_t count;
    expect(sig_open(bytes, length - 1, &other), SIG_STATUS_NOT_A_FILE, "a short file");
    expect(sig_open(bytes + 1, length - 1, &other), SIG_STATUS_NOT_A_FILE, "no file");
    expect(sig_open(NULL, length, &other), SIG_STATUS_ARGUMENT, "no bytes");
    expect(sig_open(bytes, length, NULL), SIG_STATUS_ARGUMENT, "no complex");
    expect(sig_open(bytes, SIZE_MAX, &other), SIG_STATUS_ARGUMENT, "more bytes than there can be");
    expect(sig_ask(complex, scratch, SIG_RELATION_STAR, 0, 0, found, SIZE_MAX, &count), SIG_STATUS_ARGUMENT, "as many entries");
    expect(sig_ask(complex, scratch, SIG_RELATION_CLUSTER + 1, 0, 0, found, MOST, &count), SIG_STATUS_ARGUMENT, "no relation");
    expect(sig_ask(complex, scratch, SIG_RELATION_STAR, SIZE_MAX, 0, found, MOST, &count), SIG_STATUS_OK, "no simplex");
    if (count != 0) {
        fail("no simplex has a star", 0);
    }
}

static void report(const char *path) {
    const int file = open(path, O_RDONLY);
    struct stat about;
    if (file < 0 || fstat(file, &about) != 0) {
        perror(path);
        exit(1);
    }
    const size_t length = (size_t)about.st_size;
    /* A private map: turning it round on a big-endian host does not touch the file. */
    uint8_t *bytes = mmap(NULL, length, PROT_READ | PROT_WRITE, MAP_PRIVATE, file, 0);
    if (bytes == MAP_FAILED) {
        perror(path);
        exit(1);
    }
    expect(sig_verify(bytes, length), SIG_STATUS_OK, "sig_verify");
    sig_complex complex;
    sig_status opened = sig_open(bytes, length, &complex);
    if (opened == SIG_STATUS_BYTE_ORDER) {
        expect(sig_swap_byte_order(bytes, length), SIG_STATUS_OK, "sig_swap_byte_order");
        opened = sig_open(bytes, length, &complex);
    }
    expect(opened, SIG_STATUS_OK, "sig_open");
    expect(sig_validate(&complex), SIG_STATUS_OK, "sig_validate");
    sig_scratch scratch;
    expect(sig_scratch_init(&complex, (uint8_t *)memory, sizeof memory, &scratch), SIG_STATUS_OK, "sig_scratch_init");
    const size_t total = sig_first_of_dim(&complex, SIG_MAX_DIM + 1);
    printf("simplices %zu\n", total);
    for (size_t relation = 0; relation < sizeof relations / sizeof relations[0]; relation++) {
        survey(&complex, &scratch, relation, total);
    }
    find_all(&complex, &scratch, total);
    refuse(bytes, length, &complex, &scratch);
    grow(&complex);
    munmap(bytes, length);
    close(file);
}

int main(int count, char **paths) {
    for (int path = 1; path < count; path++) {
        report(paths[path]);
    }
    return 0;
}
