//! Complexes of more than 2^32 simplices: files of more than a hundred gigabytes that are nearly all holes, which a
//! file system does not store and which read as zero.
//!
//! At the ends of its vertices and of its tetrahedra such a complex has the simplices of a small one, all of whose ids,
//! offsets and rows are thus past 2^32. Before them stand 2^32 vertices that are faces of nothing and 2^30 tetrahedra
//! of zeros, which no question here leads to. Where the file system has no holes, or refuses files of the size, the
//! tests say so and do nothing.

#![cfg(all(unix, target_pointer_width = "64"))]

use std::fs::File;
use std::io::{Result, Write};
use std::os::unix::fs::{FileExt, MetadataExt};
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use sig_core::format::{Column, ENTRY_BYTES, HEADER_BYTES, MAGIC, SECTION_ALIGN, SectionKind, crc32};
use sig_core::{AnyComplex, AnyTree, Complex, Dim, Index, IndexWidth, Relations, SimplexId, VertexId};
use sig_tools::build::{BuildOptions, build};
use sig_tools::soup::{Labels, Soup};
use sig_tools::store::{AlignedBytes, EncodeOptions, Encoding};
use sig_tools::{Mapped, OwnedScratch, View};

/// Simplices of each dimension that stand before those of the small complex.
const HOLES: [usize; 4] = [1 << 32, 0, 0, 1 << 30];
/// Opening reads the header and touches no array, and a relation some of their ends.
const SOON: Duration = Duration::from_secs(5);

/// Two tetrahedra on a common triangle, a dangling triangle and a dangling edge.
fn small_file() -> AlignedBytes {
    let mut soup = Soup::new(Labels::Numbered(7), false);
    for simplex in [&[0, 1, 2, 3][..], &[1, 2, 3, 4], &[0, 4, 5], &[5, 6]] {
        soup.push(simplex);
    }
    let built = build(soup, &BuildOptions::default()).unwrap();
    let options = EncodeOptions {
        width: Some(IndexWidth::Bits64),
        lower_neighbours: Some(true),
        checksums: false,
        ..EncodeOptions::default()
    };
    Encoding::new(&built, &options).unwrap().to_bytes().unwrap()
}

/// The large complex beside the small one.
struct Large<'a> {
    small: Complex<'a, u64>,
}

impl Large<'_> {
    fn count(&self, dim: Dim) -> usize {
        self.small.num_simplices_of_dim(dim) + HOLES[dim]
    }

    /// The first id of a dimension; of the one past the last, the number of all simplices.
    fn start(&self, dim: Dim) -> usize {
        (0..dim).map(|dim| self.count(dim)).sum()
    }

    /// The id of a simplex of the small complex, which is as far from the end of its dimension; a dimension's end, too,
    /// for an id at that of the small one.
    fn id(&self, dim: Dim, small: usize) -> usize {
        let (_, end) = self.small.simplices_of_dim(dim).bounds();
        self.start(dim + 1) - (end.index() - small)
    }

    fn of(&self, small: SimplexId) -> SimplexId {
        SimplexId::new(self.id(self.small.dim_of(small).unwrap(), small.index()))
    }

    fn vertex(&self, small: VertexId) -> VertexId {
        VertexId::new(small.index() + HOLES[0])
    }

    fn column(&self, kind: SectionKind) -> Column<'_> {
        self.small.container().section(kind).unwrap().column
    }

    fn numbers(&self, kind: SectionKind) -> Vec<usize> {
        let column = self.column(kind);
        (0..column.len()).map(|row| column.index_at(row).unwrap()).collect()
    }

    /// The elements of a section that are not holes, in runs, each with the number of its first; and how many there are
    /// with the holes.
    fn section(&self, kind: SectionKind) -> (Vec<(usize, Vec<u64>)>, usize) {
        let num_pointers = self.start(3);
        let shifted =
            |value: usize, by: usize| if value == u64::STOP.to_usize() { u64::STOP } else { (value + by) as u64 };
        // The runs of numbers that stand with each simplex of the first dimensions.
        let by_dim = |dims: usize, each: &dyn Fn(Dim, SimplexId) -> u64| -> Vec<(usize, Vec<u64>)> {
            let run = |dim| {
                let ids = self.small.simplices_of_dim(dim);
                (self.id(dim, ids.bounds().0.index()), ids.map(|simplex| each(dim, simplex)).collect())
            };
            (0..dims).map(run).collect()
        };
        let own = |kind, simplex: SimplexId| self.column(kind).index_at(simplex.index()).unwrap();
        match kind {
            SectionKind::Lookup => (vec![(0, (0..4).map(|dim| self.start(dim) as u64).collect())], 4),
            SectionKind::Boundary => {
                let (mut runs, mut rows) = (Vec::new(), 0);
                for (dim, holes) in HOLES.into_iter().enumerate().skip(1) {
                    rows += holes * (dim + 1);
                    let facets = |simplex| self.small.facets(simplex).map(|facet| self.of(facet).index() as u64);
                    let run: Vec<u64> = self.small.simplices_of_dim(dim).flat_map(facets).collect();
                    runs.push((rows, run.clone()));
                    rows += run.len();
                }
                (runs, rows)
            }
            SectionKind::Pointers => {
                let pointer = |_, simplex| match self.small.is_single_cluster(simplex) {
                    true => self.of(self.small.partial_coboundary(simplex).next().unwrap()).index() as u64,
                    // List 0 is that of all the holes: it is empty.
                    false => own(SectionKind::Pointers, simplex) as u64 + 1,
                };
                (by_dim(3, &pointer), num_pointers)
            }
            SectionKind::Lists => {
                let entry = |entry: usize| match self.small.dim_of(SimplexId::new(entry)) {
                    Some(dim) => self.id(dim, entry) as u64,
                    None => u64::STOP,
                };
                let lists: Vec<u64> =
                    std::iter::once(u64::STOP).chain(self.numbers(kind).into_iter().map(entry)).collect();
                let len = lists.len();
                (vec![(0, lists)], len)
            }
            SectionKind::ChildOffsets => {
                let mut runs = by_dim(3, &|dim, simplex| self.id(dim + 1, own(kind, simplex)) as u64);
                runs.push((num_pointers, vec![self.start(4) as u64]));
                (runs, num_pointers + 1)
            }
            SectionKind::LastVertices => {
                (by_dim(4, &|_, simplex| shifted(own(kind, simplex), HOLES[0])), self.start(4))
            }
            SectionKind::LowerOffsets => {
                let offsets = self.numbers(kind).into_iter().map(|offset| shifted(offset, HOLES[1])).collect();
                (vec![(HOLES[0], offsets)], self.count(0) + 1)
            }
            SectionKind::LowerNeighbours => {
                let vertices = self.numbers(kind).into_iter().map(|vertex| shifted(vertex, HOLES[0])).collect();
                (vec![(HOLES[1], vertices)], self.count(1))
            }
            _ => panic!("no section {kind}"),
        }
    }

    /// Writes a file of some sections, by FORMAT.md: the header, the table, and what of the sections is no hole.
    fn write(&self, path: &Path, kind: u8, kinds: &[SectionKind]) -> Result<u64> {
        let file = File::options().read(true).write(true).create_new(true).open(path)?;
        let (mut table, mut end) = (Vec::new(), (HEADER_BYTES + kinds.len() * ENTRY_BYTES) as u64);
        for &kind in kinds {
            let start = end.next_multiple_of(SECTION_ALIGN as u64);
            let (element, count, bytes) = if kind == SectionKind::Flags {
                let bits = self.start(3);
                for simplex in (0..2).flat_map(|dim| self.small.simplices_of_dim(dim)) {
                    let (byte, bit) = (self.of(simplex).index() as u64 / 8, self.of(simplex).index() % 8);
                    let mut flags = [0];
                    if self.small.is_single_cluster(simplex) {
                        // Past the end there is nothing to read yet.
                        let _ = file.read_at(&mut flags, start + byte)?;
                        file.write_all_at(&[flags[0] | 1 << bit], start + byte)?;
                    }
                }
                (0, bits, bits.div_ceil(8))
            } else {
                let (runs, count) = self.section(kind);
                for (first, run) in runs {
                    let bytes: Vec<u8> = run.into_iter().flat_map(u64::to_le_bytes).collect();
                    file.write_all_at(&bytes, start + 8 * first as u64)?;
                }
                (4, count, 8 * count)
            };
            table.extend(kind.code().to_le_bytes());
            table.extend([element, 0xFF, 1, 0, 0, 0]);
            table.extend(start.to_le_bytes());
            table.extend((count as u64).to_le_bytes());
            end = start + bytes as u64;
        }
        let length = end.next_multiple_of(SECTION_ALIGN as u64);
        let mut header = MAGIC.to_vec();
        header.extend(0x0A0B_0C0D_u32.to_le_bytes());
        header.extend([1, 0, 0, 0, kind, 8, 4, 0]);
        header.extend(u32::try_from(kinds.len()).unwrap().to_le_bytes());
        header.extend(length.to_le_bytes());
        header.extend((self.start(4) as u64).to_le_bytes());
        header.extend([0; 8]);
        header.extend(table);
        let checksum = crc32(0, &header);
        header[40..44].copy_from_slice(&checksum.to_le_bytes());
        file.write_all_at(&header, 0)?;
        file.set_len(length)?;
        Ok(length)
    }

    /// The file in a directory, if the file system has holes and files as long as that.
    fn sparse_file(&self, path: &Path, kind: u8, kinds: &[SectionKind]) -> bool {
        let refused = match self.write(path, kind, kinds) {
            Ok(length) => {
                let stored = std::fs::metadata(path).unwrap().blocks() * 512;
                assert!(length > 100 << 30, "{length} bytes");
                (stored > 1 << 24).then(|| format!("{stored} bytes are stored"))
            }
            Err(error) => Some(error.to_string()),
        };
        if let Some(why) = &refused {
            // Not captured, so that it is seen in any run.
            let _ = writeln!(std::io::stderr(), "SKIPPED: no test past 2^32 on this file system: {why}");
        }
        refused.is_none()
    }

    /// Every relation of every simplex of the small complex, in the large one.
    fn check<V: Relations>(&self, large: &V) {
        let begun = Instant::now();
        for dim in 0..4 {
            assert_eq!(large.num_simplices_of_dim(dim), self.count(dim));
        }
        let mut memory = OwnedScratch::new(large);
        let mut scratch = memory.scratch();
        let mut small_memory = OwnedScratch::new(&self.small);
        let mut small_scratch = small_memory.scratch();
        let ids = |found: &mut dyn Iterator<Item = SimplexId>| {
            let mut ids: Vec<SimplexId> = found.collect();
            ids.sort_unstable();
            ids
        };
        let moved = |found: &mut dyn Iterator<Item = SimplexId>| ids(&mut found.map(|simplex| self.of(simplex)));
        for small in self.small.simplices() {
            let simplex = self.of(small);
            assert!(simplex.index() >= 1 << 32);
            assert_eq!(large.dim_of(simplex), self.small.dim_of(small));
            let word: Vec<VertexId> = self.small.vertices(small).map(|vertex| self.vertex(vertex)).collect();
            assert_eq!(large.vertices(simplex).collect::<Vec<_>>(), word);
            assert_eq!(large.find(&word), Some(simplex));
            assert_eq!(large.is_top(simplex), self.small.is_top(small));
            assert_eq!(ids(&mut large.facets(simplex)), moved(&mut self.small.facets(small)));
            assert_eq!(ids(&mut large.closure(simplex)), moved(&mut self.small.closure(small)));
            assert_eq!(ids(&mut large.children(simplex)), moved(&mut self.small.children(small)));
            let expected = moved(&mut self.small.star(small, &mut small_scratch).unwrap());
            assert_eq!(ids(&mut large.star(simplex, &mut scratch).unwrap()), expected);
            let expected = moved(&mut self.small.link(small, &mut small_scratch).unwrap());
            assert_eq!(ids(&mut large.link(simplex, &mut scratch).unwrap()), expected);
            let expected = moved(&mut self.small.adjacency(small, &mut small_scratch).unwrap());
            assert_eq!(ids(&mut large.adjacency(simplex, &mut scratch).unwrap()), expected);
            for dim in 0..4 {
                assert_eq!(ids(&mut large.boundary(simplex, dim)), moved(&mut self.small.boundary(small, dim)));
                let expected = moved(&mut self.small.coboundary(small, dim, &mut small_scratch).unwrap());
                assert_eq!(ids(&mut large.coboundary(simplex, dim, &mut scratch).unwrap()), expected);
            }
        }
        let isolated = SimplexId::new((1 << 32) - 7);
        assert!(large.is_top(isolated));
        assert_eq!(large.star(isolated, &mut scratch).unwrap().collect::<Vec<_>>(), [isolated]);
        assert_eq!(large.dim_of(SimplexId::new(self.start(4))), None);
        assert!(begun.elapsed() < SOON, "{:?}", begun.elapsed());
    }
}

/// What the command prints.
fn sig(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_sig")).args(arguments).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

const TREE: [SectionKind; 5] = [
    SectionKind::Lookup,
    SectionKind::ChildOffsets,
    SectionKind::LastVertices,
    SectionKind::LowerOffsets,
    SectionKind::LowerNeighbours,
];

#[test]
fn a_sig_past_the_ids_of_32_bits() {
    let (bytes, folder) = (small_file(), tempfile::tempdir().unwrap());
    let large = Large { small: Complex::from_bytes(&bytes).unwrap() };
    let path = folder.path().join("large.sigc");
    let [lookup, offsets, last, ..] = TREE;
    let kinds = [SectionKind::Boundary, SectionKind::Pointers, SectionKind::Lists, SectionKind::Flags];
    let kinds = [&[lookup][..], &kinds, &[offsets, last]].concat();
    if !large.sparse_file(&path, 1, &kinds) {
        return;
    }
    let begun = Instant::now();
    let map = Mapped::open(&path).unwrap();
    let AnyComplex::Bits64(complex) = map.complex().unwrap() else { panic!("not of 64 bits") };
    assert!(begun.elapsed() < SOON);
    large.check(&complex);
    for small in large.small.simplices() {
        let expected: Vec<_> = large.small.partial_coboundary(small).map(|top| large.of(top)).collect();
        assert_eq!(complex.partial_coboundary(large.of(small)).collect::<Vec<_>>(), expected);
    }
    let label = |vertex: usize| (vertex + HOLES[0]).to_string();
    let star = sig(&["query", path.to_str().unwrap(), "star", &format!("{},{}", label(4), label(5))]);
    assert_eq!(star, format!("{1},{2}\n{0},{1},{2}\n", label(0), label(4), label(5)));
    let tetrahedra = sig(&["query", path.to_str().unwrap(), "coboundary", &label(4), "--dim", "3"]);
    assert_eq!(tetrahedra, format!("{},{},{},{}\n", label(1), label(2), label(3), label(4)));
}

#[test]
fn a_tree_past_the_ids_of_32_bits() {
    let (bytes, folder) = (small_file(), tempfile::tempdir().unwrap());
    let large = Large { small: Complex::from_bytes(&bytes).unwrap() };
    let path = folder.path().join("large.sigc");
    if !large.sparse_file(&path, 2, &TREE) {
        return;
    }
    let map = Mapped::open(&path).unwrap();
    let View::Tree(AnyTree::Bits64(tree)) = map.view() else { panic!("no tree of 64 bits") };
    large.check(&tree);
    let info = sig(&["info", path.to_str().unwrap(), "--json"]);
    let counts: Vec<String> = (0..4).map(|dim| large.count(dim).to_string()).collect();
    assert!(info.contains(&format!("\"simplices\":[{}]", counts.join(","))), "{info}");
    assert!(info.contains("\"index_bits\":64"), "{info}");
    let link = sig(&["query", path.to_str().unwrap(), "link", &(HOLES[0] + 6).to_string()]);
    assert_eq!(link, format!("{}\n", HOLES[0] + 5));
}
