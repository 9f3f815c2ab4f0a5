/* The core of SIG for C: complexes in memory, asked for their relations. See core/small/README.md.
 *
 * Made from core/small/ffi/src by `SIG_BLESS=1 cargo test -p header`, and compared with it by `cargo test -p header`. */

#ifndef SIG_H
#define SIG_H

#include <stddef.h>
#include <stdint.h>

// The words of 8 bytes in a sig_complex.
#define SIG_COMPLEX_WORDS 210

// The largest dimension that a complex may have.
#define SIG_MAX_DIM 31

// The words of 8 bytes in a sig_scratch.
#define SIG_SCRATCH_WORDS 12

// How a call ended.
enum sig_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // It is done.
  SIG_STATUS_OK = 0,
  // A pointer is null or not aligned, a length is more than memory can hold, or there is no relation of that number.
  SIG_STATUS_ARGUMENT = 1,
  // The bytes are no file, or not a whole one, or of another version.
  SIG_STATUS_NOT_A_FILE = 2,
  // The bytes are in the other byte order: sig_swap_byte_order turns them round.
  SIG_STATUS_BYTE_ORDER = 3,
  // The file does not hold a complex of kind *sig*.
  SIG_STATUS_KIND = 4,
  // The file is damaged.
  SIG_STATUS_DAMAGED = 5,
  // The memory is too small; the count is how many bytes the query needs, at least.
  SIG_STATUS_MEMORY = 6,
  // There is not enough room for the answer; the count is how many entries it has.
  SIG_STATUS_ROOM = 7,
  // There is no such simplex.
  SIG_STATUS_NO_SIMPLEX = 8,
  // The library was built without indices of the file's width.
  SIG_STATUS_WIDTH = 9,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sig_status sig_status;
#else
typedef int32_t sig_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A relation of a simplex to others. The numbers are part of the interface for C and WebAssembly.
//
// What the argument is for stands with each; the others ignore it.
enum sig_relation
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // The vertices, increasing.
  SIG_RELATION_VERTICES = 0,
  // The facets, the one without the first vertex first.
  SIG_RELATION_FACETS = 1,
  // The faces of one dimension, the argument, in the order of their ids.
  SIG_RELATION_BOUNDARY = 2,
  // All faces and the simplex itself, in the order of their ids.
  SIG_RELATION_CLOSURE = 3,
  // The cofaces of one dimension, the argument.
  SIG_RELATION_COBOUNDARY = 4,
  // The simplex and all its cofaces.
  SIG_RELATION_STAR = 5,
  // All proper cofaces.
  SIG_RELATION_RESTRICTED_STAR = 6,
  // The faces of the star that do not meet the simplex.
  SIG_RELATION_LINK = 7,
  // The other simplices of the same dimension that share a facet; for a vertex, the other ends of its edges.
  SIG_RELATION_ADJACENCY = 8,
  // The other simplices of the same dimension that share a face of one dimension, the argument.
  SIG_RELATION_K_ADJACENCY = 9,
  // The face without the last vertex; nothing for a vertex.
  SIG_RELATION_PARENT = 10,
  // The simplices with one vertex more, after the last one.
  SIG_RELATION_CHILDREN = 11,
  // The children of the parent, the simplex among them.
  SIG_RELATION_SIBLINGS = 12,
  // The simplices whose words start with the vertices of the simplex.
  SIG_RELATION_PREFIXED = 13,
  // The least simplex of each cluster of top simplices around the simplex; nothing for a top simplex.
  SIG_RELATION_CLUSTERS = 14,
  // The top simplices of the cluster to which one of them, the argument, belongs.
  SIG_RELATION_CLUSTER = 15,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sig_relation sig_relation;
#else
typedef uint32_t sig_relation;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A complex that sig_open opened: copied at will, and of use as long as the bytes of the file are.
typedef struct {
  // Nobody's business.
  uint64_t words[SIG_COMPLEX_WORDS];
} sig_complex;

// The memory of queries that sig_scratch_init made, for one query at a time.
typedef struct {
  // Nobody's business.
  uint64_t words[SIG_SCRATCH_WORDS];
} sig_scratch;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Opens the complex in a file of kind *sig*, which lies at an address that is a multiple of 8, in the host's byte order.
// The bytes stay where they are and must not change as long as the complex is used. Takes constant time, and looks into no
// array: on what it accepts every query ends; sig_validate says whether the answers are right.
//
// # Safety
// `bytes` leads to `length` bytes, `complex` to a sig_complex, or they are null.
sig_status sig_open(const uint8_t *bytes,
                    size_t length,
                    sig_complex *complex);

// Checks the checksums of a file as it lies on disk, in little-endian order. Takes time linear in its length.
//
// # Safety
// `bytes` leads to `length` bytes, or is null.
sig_status sig_verify(const uint8_t *bytes, size_t length);

// Turns a file from one byte order into the other, in place: on a big-endian host a file must be turned round before it is
// opened. Takes time linear in its length; of what is not a file it leaves the bytes as they are.
//
// # Safety
// `bytes` leads to `length` bytes that may be written and are not an open complex, or is null.
sig_status sig_swap_byte_order(uint8_t *bytes,
                               size_t length);

// Checks the arrays of a complex, which sig_open does not: after it, answers are right. Takes time linear in the file.
//
// # Safety
// `complex` leads to a complex that sig_open opened, or is null.
sig_status sig_validate(const sig_complex *complex);

// The dimension of a complex; -1 if it is empty, or null.
//
// # Safety
// `complex` leads to a complex that sig_open opened, or is null.
int32_t sig_dim(const sig_complex *complex);

// The first simplex of a dimension: simplices are numbered by dimension, then by their vertices. The number of all
// simplices past the dimension of the complex; 0 if it is null.
//
// # Safety
// `complex` leads to a complex that sig_open opened, or is null.
size_t sig_first_of_dim(const sig_complex *complex, size_t dim);

// The simplex with the given vertices, which must increase.
//
// # Safety
// `complex` leads to a complex that sig_open opened, `vertices` to `length` vertices, `simplex` to room for one, or they
// are null.
sig_status sig_find(const sig_complex *complex,
                    const size_t *vertices,
                    size_t length,
                    size_t *simplex);

// How many bytes sig_scratch_init needs for queries whose traversals and answers have up to `entries` simplices.
//
// # Safety
// `complex` leads to a complex that sig_open opened, or is null.
size_t sig_memory_bytes(const sig_complex *complex, size_t entries);

// Makes a scratch for the queries on a complex from memory at an address that is a multiple of 8: as many entries as fit.
// It can be used again and again, by one thread at a time. Takes time linear in the memory.
//
// # Safety
// `complex` leads to a complex that sig_open opened, `memory` to `bytes` bytes that nobody else uses as long as the scratch
// is used, `scratch` to a sig_scratch, or they are null.
sig_status sig_scratch_init(const sig_complex *complex,
                            uint8_t *memory,
                            size_t bytes,
                            sig_scratch *scratch);

// Asks for a relation of a simplex: writes the simplices, or vertices, that it leads to, up to `capacity`, and how many they
// are. What the relations are and what the argument is says sig_relation.
//
// If the memory of the scratch is too small, the count is how many bytes the query needs at least, and nothing is written;
// make a scratch of more. If only the room for the answer is, the count is how many entries it has. The scratch can be used
// again in any case.
//
// # Safety
// `complex` leads to a complex that sig_open opened, `scratch` to a scratch that sig_scratch_init made for it, `found` to
// room for `capacity` entries, `count` to room for one, or they are null.
sig_status sig_ask(const sig_complex *complex,
                   sig_scratch *scratch,
                   uint32_t relation,
                   size_t simplex,
                   size_t argument,
                   size_t *found,
                   size_t capacity,
                   size_t *count);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SIG_H */
