"""The peers of the bench `peers` that are called from Python: GUDHI, and Ripser.

    python3 python_peers.py rips|query|betti POINTS RADIUS MAX_DIM
    python3 python_peers.py mesh TETRAHEDRA
    python3 python_peers.py ripser POINTS RADIUS MAX_DIM

`pip install gudhi ripser`. Prints figures as name=number, and the numbers of simplices, or the Betti numbers, behind "dims=".
Points are "PTS1", a 32-bit dimension, a 64-bit number of points and doubles, tetrahedra four 32-bit numbers each.
"""

import resource
import sys
import time

import numpy


def points(path):
    with open(path, "rb") as file:
        assert file.read(4) == b"PTS1"
        dim = numpy.fromfile(file, "<u4", 1)[0]
        count = numpy.fromfile(file, "<u8", 1)[0]
        return numpy.fromfile(file, "<f8").reshape(count, dim)


def timed(work):
    start = time.perf_counter()
    result = work()
    return time.perf_counter() - start, result


def tree_of(path, radius, max_dim):
    import gudhi

    rips = gudhi.RipsComplex(points=points(path), max_edge_length=float(radius))
    return rips.create_simplex_tree(max_dimension=int(max_dim))


def dims(numbers):
    print("dims=" + " ".join(str(number) for number in numbers))


def rips(path, radius, max_dim):
    seconds, tree = timed(lambda: tree_of(path, radius, max_dim))
    print(f"tree_s={seconds}")
    dims(tree.num_simplices_by_dimension())


def mesh(path):
    import gudhi

    tetrahedra = numpy.fromfile(path, "<u4").astype(numpy.int32).reshape(-1, 4).T.copy()
    tree = gudhi.SimplexTree()
    seconds, _ = timed(lambda: tree.insert_batch(tetrahedra, numpy.zeros(tetrahedra.shape[1])))
    print(f"build_s={seconds}")
    dims(tree.num_simplices_by_dimension())


def query(path, radius, max_dim):
    tree = tree_of(path, radius, max_dim)
    random = numpy.random.default_rng(1)
    sample = {}
    for simplex, _ in tree.get_simplices():
        if random.random() < 0.01:
            sample.setdefault(len(simplex) - 1, []).append(simplex)
    queries = {
        "find": tree.find,
        "facets": lambda simplex: sum(1 for _ in tree.get_boundaries(simplex)),
        "cofaces1": lambda simplex: len(tree.get_cofaces(simplex, 1)),
        "star": lambda simplex: len(tree.get_star(simplex)),
    }
    for dim, simplices in sorted(sample.items()):
        random.shuffle(simplices)
        for name, ask in queries.items():
            start, asked = time.perf_counter(), 0
            for simplex in simplices:
                ask(simplex)
                asked += 1
                if time.perf_counter() - start > 0.5:
                    break
            print(f"{name}{dim}={(time.perf_counter() - start) / asked * 1e6}")
    dims(tree.num_simplices_by_dimension())


def betti(path, radius, max_dim):
    tree = tree_of(path, radius, max_dim)
    seconds, _ = timed(lambda: tree.compute_persistence(homology_coeff_field=2, min_persistence=-1))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6
    print(f"betti_s={seconds} peak_mb={peak}")
    dims(tree.betti_numbers()[: int(max_dim)])


def ripser(path, radius, max_dim):
    import ripser as peer

    cloud = points(path)
    work = lambda: peer.ripser(cloud, maxdim=int(max_dim) - 1, thresh=float(radius))
    seconds, found = timed(work)
    print(f"total_s={seconds}")
    # What never dies is there at the radius.
    dims(int(numpy.isinf(diagram[:, 1]).sum()) for diagram in found["dgms"])


TASKS = {"rips": rips, "mesh": mesh, "query": query, "betti": betti, "ripser": ripser}

if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] not in TASKS:
        sys.exit(__doc__)
    TASKS[sys.argv[1]](*sys.argv[2:])
