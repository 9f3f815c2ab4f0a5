// The peer of the benches on complexes of points: GUDHI's Rips complex, simplex tree, witness complex and edge contraction.
//
//   apt-get install -y --no-install-recommends g++ libgudhi-dev libboost-all-dev libeigen3-dev libcgal-dev
//   g++ -std=c++17 -O3 -DNDEBUG -march=native -ffp-contract=off -w -DCGAL_DISABLE_ROUNDING_MATH_CHECK
//       -DBOOST_RESULT_OF_USE_DECLTYPE -I/usr/include/eigen3 gudhi_bench.cpp -o gudhi_bench -lgmp -lmpfr
//
//   gudhi_bench rips def|min|link FILE R K                       the Rips complex: graph, insertion, expansion
//   gudhi_bench query def|min|link FILE R K [SAMPLE] [SECONDS]   queries of random simplices of each dimension
//   gudhi_bench incr def FILE R K insert|remove                  insertion in random order, with faces; removal
//   gudhi_bench contract FILE R N                                contraction of the edges of the first N points
//   gudhi_bench wit FILE L ALPHA2 K e|t [NEIGHBOURS]             witness complex of the first L points, from points or table
//
// FILE is "PTS1", a 32-bit dimension, a 64-bit number of points, doubles, little-endian; the benches write it. `def` keeps
// keys and values, `min` neither; `link`, linked labels, needs -DLINKED_LABELS and a GUDHI that has them (3.13 does).
#include <gudhi/Edge_contraction.h>
#include <gudhi/Euclidean_witness_complex.h>
#include <gudhi/Point.h>
#include <gudhi/Rips_complex.h>
#include <gudhi/Simplex_tree.h>
#include <gudhi/Skeleton_blocker.h>
#include <gudhi/Witness_complex.h>
#include <gudhi/distance_functions.h>

#include <CGAL/Epick_d.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

struct Clock {
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }
};

struct SplitMix64 {
  std::uint64_t state;
  std::uint64_t next() {
    std::uint64_t z = state += 0x9E3779B97F4A7C15ull;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
};

template <class T>
void shuffle(std::vector<T>& items, std::uint64_t seed) {
  SplitMix64 random{seed};
  for (std::size_t i = items.size(); i > 1; i--) std::swap(items[i - 1], items[random.next() % i]);
}

using Point = std::vector<double>;

std::vector<Point> load(const char* name) {
  std::ifstream in(name, std::ios::binary);
  char magic[4];
  std::uint32_t dim = 0;
  std::uint64_t count = 0;
  in.read(magic, 4).read(reinterpret_cast<char*>(&dim), 4).read(reinterpret_cast<char*>(&count), 8);
  if (!in || std::memcmp(magic, "PTS1", 4) != 0) {
    std::fprintf(stderr, "%s: no points\n", name);
    std::exit(1);
  }
  std::vector<Point> points(count, Point(dim));
  for (Point& point : points) in.read(reinterpret_cast<char*>(point.data()), 8 * dim);
  return points;
}

std::size_t resident() {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);)
    if (line.rfind("VmRSS:", 0) == 0) return std::strtoull(line.c_str() + 6, nullptr, 10) * 1024;
  return 0;
}

std::size_t allocated() {
  auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

template <bool KEYS, bool VALUES, bool LINKED>
struct Options {
  using Indexing_tag = Gudhi::linear_indexing_tag;
  using Vertex_handle = int;
  using Filtration_value = double;
  using Simplex_key = std::uint32_t;
  static const bool store_key = KEYS;
  static const bool store_filtration = VALUES;
  static const bool contiguous_vertices = false;
  static const bool link_nodes_by_label = LINKED;
  static const bool stable_simplex_handles = false;
};
using Default = Gudhi::Simplex_tree<Options<true, true, false>>;
using Least = Gudhi::Simplex_tree<Options<false, false, false>>;

template <class Tree>
void count(typename Tree::Siblings* siblings, const Tree& tree, std::size_t dim, std::vector<std::size_t>& counts) {
  if (counts.size() <= dim) counts.resize(dim + 1);
  counts[dim] += siblings->members().size();
  for (auto& member : siblings->members())
    if (tree.has_children(&member)) count(member.second.children(), tree, dim + 1, counts);
}

template <class Tree>
std::vector<std::size_t> print_counts(Tree& tree) {
  std::vector<std::size_t> counts;
  count(tree.root(), tree, 0, counts);
  std::printf("dims=");
  for (std::size_t of_dim : counts) std::printf("%zu ", of_dim);
  std::printf("\n");
  return counts;
}

// Expands the points' graph, and says what that takes; returns the numbers of simplices by dimension.
template <class Tree>
std::vector<std::size_t> rips(Tree& tree, const char* file, double radius, int max_dim) {
  auto points = load(file);
  Clock of_graph;
  Gudhi::rips_complex::Rips_complex<double> complex(points, radius, Gudhi::Euclidean_distance());
  double graph = of_graph.seconds();
  std::vector<Point>().swap(points);
  Clock of_insertion;
  complex.create_complex(tree, 1);
  double insertion = of_insertion.seconds();
  malloc_trim(0);
  Clock of_expansion;
  tree.expansion(max_dim);
  double expansion = of_expansion.seconds();
  std::size_t memory = resident(), heap = allocated(), simplices = tree.num_simplices();
  std::printf("BUILD |K|=%zu ", simplices);
  auto counts = print_counts(tree);
  std::printf("BUILD graph_s=%.3f insert_graph_s=%.3f expansion_s=%.3f rss_B/simplex=%.2f heap_B/simplex=%.2f\n",
              graph, insertion, expansion, double(memory) / double(simplices), double(heap) / double(simplices));
  return counts;
}

template <class Tree>
void query(const char* file, double radius, int max_dim, std::size_t size, double limit) {
  using Simplex = typename Tree::Simplex_handle;
  Tree tree;
  std::size_t dims = rips(tree, file, radius, max_dim).size();
  // A reservoir of each dimension.
  std::vector<std::vector<Simplex>> samples(dims);
  std::vector<std::size_t> seen(dims);
  std::vector<SplitMix64> random;
  for (std::size_t dim = 0; dim < dims; dim++) random.push_back({7 + dim});
  for (Simplex simplex : tree.complex_simplex_range()) {
    std::size_t dim = tree.dimension(simplex), at = seen[dim]++;
    if (samples[dim].size() < size) {
      samples[dim].push_back(simplex);
    } else if ((at = random[dim].next() % (at + 1)) < size) {
      samples[dim][at] = simplex;
    }
  }
  for (auto& sample : samples) shuffle(sample, 99);
  volatile std::uint64_t sink = 0;
  auto run = [&](const char* name, std::size_t first, auto ask) {
    for (std::size_t dim = first; dim < dims; dim++) {
      std::size_t asked = 0, found = 0;
      Clock clock;
      for (Simplex simplex : samples[dim]) {
        found += ask(simplex);
        if ((++asked & 15) == 0 && clock.seconds() > limit) break;
      }
      std::printf("Q %s dim=%zu n=%zu us/simplex=%.4f avg_out=%.3f\n", name, dim, asked,
                  clock.seconds() * 1e6 / double(asked), double(found) / double(asked));
    }
  };
  auto sum = [&](auto&& simplices) {
    std::size_t found = 0;
    for (auto simplex : simplices) {
      found++;
      sink = sink + std::uint64_t(simplex->first);
    }
    return found;
  };
  run("boundary", 1, [&](Simplex simplex) { return sum(tree.boundary_simplex_range(simplex)); });
  run("vertices", 0, [&](Simplex simplex) {
    std::size_t found = 0;
    for (auto vertex : tree.simplex_vertex_range(simplex)) {
      found++;
      sink = sink + std::uint64_t(vertex);
    }
    return found;
  });
  for (std::size_t dim = 0; dim < dims; dim++) {
    std::vector<std::vector<int>> words;
    for (Simplex simplex : samples[dim]) {
      auto range = tree.simplex_vertex_range(simplex);
      words.emplace_back(range.begin(), range.end());
      std::reverse(words.back().begin(), words.back().end());
    }
    std::size_t hits = 0;
    Clock clock;
    for (auto& word : words) hits += tree.find(word) != tree.null_simplex();
    std::printf("Q find_hit dim=%zu n=%zu us=%.4f hit=%zu\n", dim, words.size(),
                clock.seconds() * 1e6 / double(words.size()), hits);
  }
  run("cofaces1", 0, [&](Simplex simplex) { return sum(tree.cofaces_simplex_range(simplex, 1)); });
  run("star", 0, [&](Simplex simplex) { return sum(tree.star_simplex_range(simplex)); });
}

// Words of the simplices of the expansion, those of dimension `dim` only unless it is negative, in random order.
std::vector<std::vector<int>> words(Default& tree, int dim) {
  std::vector<std::vector<int>> words;
  for (auto simplex : tree.complex_simplex_range()) {
    if (dim >= 0 && tree.dimension(simplex) != dim) continue;
    auto range = tree.simplex_vertex_range(simplex);
    words.emplace_back(range.begin(), range.end());
  }
  shuffle(words, 5);
  return words;
}

void incremental(const char* file, double radius, int max_dim, const std::string& what) {
  Default tree;
  rips(tree, file, radius, max_dim);
  auto tops = words(tree, max_dim);
  if (what == "remove") {
    std::size_t count = std::min<std::size_t>(tops.size(), 200000);
    Clock clock;
    for (std::size_t i = 0; i < count; i++) tree.remove_maximal_simplex(tree.find(tops[i]));
    std::printf("INCR find+remove_maximal_simplex n=%zu us=%.4f\n", count, clock.seconds() * 1e6 / double(count));
    return;
  }
  auto all = words(tree, -1);
  {
    Default other;
    Clock clock;
    for (auto& word : all) other.insert_simplex(word, 0.);
    std::printf("INCR insert_simplex random order n=%zu us=%.4f\n", all.size(),
                clock.seconds() * 1e6 / double(all.size()));
  }
  std::size_t count = std::min<std::size_t>(tops.size(), 500000);
  Default other;
  Clock clock;
  for (std::size_t i = 0; i < count; i++) other.insert_simplex_and_subfaces(tops[i], 0.);
  std::printf("INCR insert_simplex_and_subfaces n=%zu us=%.4f\n", count, clock.seconds() * 1e6 / double(count));
}

struct Geometry {
  using Point = Point_d;
};

void contract(const char* file, double radius, std::size_t count) {
  using Complex = Gudhi::skeleton_blocker::Skeleton_blocker_geometric_complex<
      Gudhi::skeleton_blocker::Skeleton_blocker_simple_geometric_traits<Geometry>>;
  using Profile = Gudhi::contraction::Edge_profile<Complex>;
  auto points = load(file);
  count = std::min(count, points.size());
  Complex complex;
  for (std::size_t i = 0; i < count; i++) complex.add_vertex(Point_d(points[i].begin(), points[i].end()));
  for (std::size_t i = 0; i < count; i++)
    for (std::size_t j = i + 1; j < count; j++)
      if (Gudhi::Euclidean_distance()(points[i], points[j]) <= radius)
        complex.add_edge_without_blockers(Complex::Vertex_handle(int(i)), Complex::Vertex_handle(int(j)));
  Clock clock;
  Gudhi::contraction::Skeleton_blocker_contractor<Complex> contractor(
      complex, new Gudhi::contraction::Edge_length_cost<Profile>,
      Gudhi::contraction::make_first_vertex_placement<Profile>(),
      Gudhi::contraction::make_link_valid_contraction<Profile>(),
      Gudhi::contraction::make_remove_popable_blockers_visitor<Profile>());
  contractor.contract_edges();
  double seconds = clock.seconds();
  std::size_t done = count - std::size_t(complex.num_vertices());
  std::printf("CONTRACT vertices=%d edges=%d s=%.3f us/contraction=%.2f\n", int(complex.num_vertices()),
              int(complex.num_edges()), seconds, seconds * 1e6 / double(done));
}

template <class Complex>
void print_witness(Complex& complex, double relaxation, std::size_t max_dim) {
  Default tree;
  Clock clock;
  complex.create_complex(tree, relaxation, max_dim);
  double seconds = clock.seconds();
  std::printf("weak |K|=%zu s=%.3f ", tree.num_simplices(), seconds);
  print_counts(tree);
}

void witness(const char* file, std::size_t landmarks, double relaxation, std::size_t max_dim, char mode,
             std::size_t neighbours) {
  auto points = load(file);
  if (mode == 'e') {
    using Kernel = CGAL::Epick_d<CGAL::Dynamic_dimension_tag>;
    std::vector<Kernel::Point_d> all;
    for (Point& point : points) all.emplace_back(int(point.size()), point.begin(), point.end());
    std::vector<Kernel::Point_d> first(all.begin(), all.begin() + long(landmarks));
    Clock clock;
    Gudhi::witness_complex::Euclidean_witness_complex<Kernel> complex(first, all);
    std::printf("WIT ctor_s=%.3f ", clock.seconds());
    return print_witness(complex, relaxation, max_dim);
  }
  // The nearest landmarks of each point, by looking at all; distances are squared, as the relaxation is.
  using Row = std::vector<std::pair<std::size_t, double>>;
  std::vector<Row> table;
  Clock clock;
  neighbours = std::min(landmarks, neighbours);
  for (Point& point : points) {
    Row row;
    for (std::size_t j = 0; j < landmarks; j++) {
      double square = 0;
      for (std::size_t d = 0; d < point.size(); d++) square += (point[d] - points[j][d]) * (point[d] - points[j][d]);
      row.emplace_back(j, square);
    }
    auto nearer = [](auto& a, auto& b) { return a.second < b.second; };
    std::partial_sort(row.begin(), row.begin() + long(neighbours), row.end(), nearer);
    table.emplace_back(row.begin(), row.begin() + long(neighbours));
  }
  std::printf("WIT brute_nn_s=%.3f ", clock.seconds());
  Gudhi::witness_complex::Witness_complex<std::vector<Row>> complex(table);
  print_witness(complex, relaxation, max_dim);
}

template <class Tree>
int of_points(const std::string& mode, int count, char** words) {
  double radius = std::atof(words[1]);
  int max_dim = std::atoi(words[2]);
  if (mode == "query") {
    query<Tree>(words[0], radius, max_dim, count > 3 ? std::atoi(words[3]) : 100000, count > 4 ? std::atof(words[4]) : 2);
  } else {
    Tree tree;
    rips(tree, words[0], radius, max_dim);
    std::fflush(nullptr);
    std::_Exit(0);  // Without taking the tree apart, which takes longer than the expansion.
  }
  return 0;
}

int main(int count, char** words) {
  std::string mode = count > 1 ? words[1] : "", options = count > 2 ? words[2] : "";
  if ((mode == "rips" || mode == "query") && count > 5) {
    if (options == "def") return of_points<Default>(mode, count - 3, words + 3);
    if (options == "min") return of_points<Least>(mode, count - 3, words + 3);
#ifdef LINKED_LABELS
    using Linked = Gudhi::Simplex_tree<Options<true, true, true>>;
    if (options == "link") return of_points<Linked>(mode, count - 3, words + 3);
#endif
  } else if (mode == "incr" && options == "def" && count > 6) {
    incremental(words[3], std::atof(words[4]), std::atoi(words[5]), words[6]);
    return 0;
  } else if (mode == "contract" && count > 4) {
    contract(words[2], std::atof(words[3]), std::strtoull(words[4], nullptr, 10));
    return 0;
  } else if (mode == "wit" && count > 6) {
    std::size_t neighbours = count > 7 ? std::strtoull(words[7], nullptr, 10) : 64;
    witness(words[2], std::strtoull(words[3], nullptr, 10), std::atof(words[4]), std::strtoull(words[5], nullptr, 10),
            words[6][0], neighbours);
    return 0;
  }
  std::fprintf(stderr, "no such mode, or too few arguments; see the first lines of the source\n");
  return 2;
}
