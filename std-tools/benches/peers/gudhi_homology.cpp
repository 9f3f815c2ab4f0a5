// The peer of `cargo bench --bench homology`: persistent cohomology over Z/2 with all filtration values 0 (of a mesh) or as the
// flag complex has them, in GUDHI's simplex tree for persistence. The top dimension is left out, as GUDHI does.
//
//   apt-get install -y --no-install-recommends g++ libgudhi-dev libboost-dev libeigen3-dev
//   g++ -std=c++17 -O3 -march=native -DNDEBUG -ffp-contract=off -I/usr/include/eigen3 gudhi_homology.cpp -o gudhi_homology
//   ./gudhi_homology rips FILE R K
//   ./gudhi_homology mesh FILE
//
// FILE is "PTS1", a 32-bit dimension, a 64-bit number of points, doubles, little-endian; or vertex numbers of 32 bits, four a
// tetrahedron. The bench writes both. Edges of the flag complex enter at 0 as well: the sort is by dimension.
#include <iostream>

#include <gudhi/Persistent_cohomology.h>
#include <gudhi/Rips_complex.h>
#include <gudhi/Simplex_tree.h>
#include <gudhi/distance_functions.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <vector>

using Tree = Gudhi::Simplex_tree<Gudhi::Simplex_tree_options_fast_persistence>;
using Cohomology = Gudhi::persistent_cohomology::Persistent_cohomology<Tree, Gudhi::persistent_cohomology::Field_Zp>;

static double seconds() {
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

static double peak() {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024.0;
}

static void fill_rips(Tree& tree, const char* file, double radius, int max_dim) {
  std::ifstream in(file, std::ios::binary);
  char magic[4];
  std::uint32_t dim = 0;
  std::uint64_t count = 0;
  in.read(magic, 4).read(reinterpret_cast<char*>(&dim), 4).read(reinterpret_cast<char*>(&count), 8);
  std::vector<std::vector<double>> points(count, std::vector<double>(dim));
  for (auto& point : points) in.read(reinterpret_cast<char*>(point.data()), 8 * dim);
  if (!in) std::fprintf(stderr, "%s: no points\n", file), std::exit(1);
  Gudhi::rips_complex::Rips_complex<float> complex(points, radius, Gudhi::Euclidean_distance());
  complex.create_complex(tree, 1);
  for (auto simplex : tree.complex_simplex_range()) tree.assign_filtration(simplex, 0);
  double start = seconds();
  tree.expansion(max_dim);
  std::printf("fill_s=%.3f ", seconds() - start);
}

static void fill_mesh(Tree& tree, const char* file) {
  std::vector<std::array<std::int32_t, 4>> tetrahedra;
  std::ifstream in(file, std::ios::binary);
  for (std::array<std::int32_t, 4> word; in.read(reinterpret_cast<char*>(&word), sizeof word);) tetrahedra.push_back(word);
  int vertices = 0;
  for (auto const& word : tetrahedra) vertices = std::max(vertices, *std::max_element(word.begin(), word.end()) + 1);
  double start = seconds();
  for (int v = 0; v < vertices; ++v) tree.insert_simplex(std::array<int, 1>{v}, 0);
  for (auto const& word : tetrahedra) tree.insert_simplex_and_subfaces(word, 0);
  std::printf("fill_s=%.3f ", seconds() - start);
}

int main(int argc, char** argv) {
  Tree tree;
  if (argc == 5 && !std::strcmp(argv[1], "rips")) {
    fill_rips(tree, argv[2], std::atof(argv[3]), std::atoi(argv[4]));
  } else if (argc == 3 && !std::strcmp(argv[1], "mesh")) {
    fill_mesh(tree, argv[2]);
  } else {
    return std::fprintf(stderr, "usage: gudhi_homology rips FILE R K | mesh FILE\n"), 2;
  }
  double start = seconds();
  tree.initialize_filtration();
  double sorted = seconds();
  Cohomology cohomology(tree);
  cohomology.init_coefficients(2);
  cohomology.compute_persistent_cohomology(0);
  std::printf("sort_s=%.3f cohomology_s=%.3f peak_mb=%.1f simplices=%zu betti=", sorted - start, seconds() - sorted, peak(),
              static_cast<std::size_t>(tree.num_simplices()));
  for (int dim = 0; dim < tree.dimension(); ++dim) std::printf("%d ", cohomology.betti_number(dim));
  std::printf("\n");
  std::fflush(stdout);
  // Taking the tree down is not measured.
  std::_Exit(0);
}
