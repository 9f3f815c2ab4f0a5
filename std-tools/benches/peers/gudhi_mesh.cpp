// The peer of `cargo bench --bench mesh`: GUDHI's simplex tree filled with the tetrahedra of a mesh, the same that the
// bench builds, in the same order.
//
//   apt-get install -y --no-install-recommends g++ libgudhi-dev libboost-dev libeigen3-dev
//   g++ -std=c++17 -O3 -march=native -DNDEBUG -I/usr/include/eigen3 gudhi_mesh.cpp -o gudhi_mesh
//   ./gudhi_mesh default|fast|lean FILE [stars]
//
// FILE is vertex numbers of 32 bits, four a tetrahedron; the bench writes it. Prints the simplices of each dimension, the
// time to insert the vertices and the tetrahedra with their faces, and the peak memory; with `stars` also the time of the
// star of every 100th vertex.
#include <gudhi/Simplex_tree.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <vector>

// As Simplex_tree_options_full_featured, without filtration values and keys: the leanest tree that GUDHI has.
struct Lean : Gudhi::Simplex_tree_options_full_featured {
  static const bool store_key = false;
  static const bool store_filtration = false;
};

static double seconds() {
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

template <class Options>
static int run(const char* path, bool stars) {
  using Tree = Gudhi::Simplex_tree<Options>;
  std::vector<std::array<int32_t, 4>> tetrahedra;
  std::FILE* file = std::fopen(path, "rb");
  if (!file) return std::perror(path), 1;
  for (std::array<int32_t, 4> word; std::fread(&word, sizeof word, 1, file) == 1;) tetrahedra.push_back(word);
  std::fclose(file);
  int vertices = 0;
  for (auto const& word : tetrahedra) vertices = std::max(vertices, *std::max_element(word.begin(), word.end()) + 1);
  Tree tree;
  double start = seconds();
  // In order and first: much the faster way to fill the root.
  for (int v = 0; v < vertices; ++v) tree.insert_simplex(std::array<int, 1>{v});
  for (auto const& word : tetrahedra) tree.insert_simplex_and_subfaces(word);
  double took = seconds() - start;

  std::array<size_t, 4> count{};
  for (auto simplex : tree.complex_simplex_range()) ++count[tree.dimension(simplex)];
  size_t total = count[0] + count[1] + count[2] + count[3];
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  std::printf("simplices %zu %zu %zu %zu = %zu\n", count[0], count[1], count[2], count[3], total);
  std::printf("insert %.3f s, %.1f ns a simplex, peak %.0f MB, %.1f bytes a simplex\n", took, took / total * 1e9,
              usage.ru_maxrss / 1024.0, usage.ru_maxrss * 1024.0 / total);
  if (stars) {
    size_t reported = 0, queries = 0;
    start = seconds();
    for (int v = 0; v < vertices; v += 100, ++queries)
      for (auto coface : tree.star_simplex_range(tree.find(std::array<int, 1>{v}))) reported += tree.dimension(coface) == 3;
    took = seconds() - start;
    std::printf("star %.3f us a vertex, %zu tetrahedra reported\n", took / queries * 1e6, reported);
  }
  return 0;
}

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: gudhi_mesh default|fast|lean FILE [stars]\n");
    return 2;
  }
  bool stars = argc > 3;
  if (!std::strcmp(argv[1], "default")) return run<Gudhi::Simplex_tree_options_full_featured>(argv[2], stars);
  if (!std::strcmp(argv[1], "fast")) return run<Gudhi::Simplex_tree_options_fast_persistence>(argv[2], stars);
  return run<Lean>(argv[2], stars);
}
