// The peer of `cargo bench --bench mesh`: GUDHI's simplex tree filled with the tetrahedra of the Freudenthal (Kuhn) grid
// of k x l x m vertices, the same complex that the bench builds.
//
//   apt-get install -y --no-install-recommends g++ libgudhi-dev libboost-dev libeigen3-dev
//   g++ -std=c++17 -O3 -march=native -DNDEBUG -I/usr/include/eigen3 gudhi_mesh.cpp -o gudhi_mesh
//   ./gudhi_mesh default|fast|lean K L M [stars]
//
// Prints the simplices of each dimension, the time to insert the tetrahedra with their faces, and the peak memory; with
// `stars` also the time of the star of every 100th vertex.
#include <gudhi/Simplex_tree.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
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
static int run(int k, int l, int m, bool stars) {
  using Tree = Gudhi::Simplex_tree<Options>;
  auto vertex = [&](int x, int y, int z) { return x + k * (y + l * z); };
  std::vector<std::array<int, 4>> tetrahedra;
  for (int z = 0; z + 1 < m; ++z)
    for (int y = 0; y + 1 < l; ++y)
      for (int x = 0; x + 1 < k; ++x) {
        std::array<int, 3> axes{0, 1, 2};
        do {
          std::array<int, 3> at{x, y, z};
          std::array<int, 4> word;
          word[0] = vertex(at[0], at[1], at[2]);
          for (int i = 0; i < 3; ++i) {
            ++at[axes[i]];
            word[i + 1] = vertex(at[0], at[1], at[2]);
          }
          tetrahedra.push_back(word);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
  Tree tree;
  double start = seconds();
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
    for (int v = 0; v < k * l * m; v += 100, ++queries)
      for (auto coface : tree.star_simplex_range(tree.find(std::array<int, 1>{v}))) reported += tree.dimension(coface) == 3;
    took = seconds() - start;
    std::printf("star %.3f us a vertex, %zu tetrahedra reported\n", took / queries * 1e6, reported);
  }
  return 0;
}

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: gudhi_mesh default|fast|lean K L M [stars]\n");
    return 2;
  }
  int k = std::atoi(argv[2]), l = std::atoi(argv[3]), m = std::atoi(argv[4]);
  bool stars = argc > 5;
  if (!std::strcmp(argv[1], "default")) return run<Gudhi::Simplex_tree_options_full_featured>(k, l, m, stars);
  if (!std::strcmp(argv[1], "fast")) return run<Gudhi::Simplex_tree_options_fast_persistence>(k, l, m, stars);
  return run<Lean>(k, l, m, stars);
}
