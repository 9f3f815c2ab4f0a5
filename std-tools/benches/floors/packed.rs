//! What a packed variant would take and cost: a prototype of the boundary, the pointers and the lists in packed blocks.
//!
//! Each column of a block of 64 rows is its least value and the differences from it, in as many bits as the largest of
//! them takes, with one more value for the stop code: an element is found at once, by the block's header and the bits.
//! Canonical order makes the columns of a block alike, and that of the parents increasing.

#![allow(clippy::cast_possible_truncation, reason = "a machine that has the files has words of 64 bits")]

use std::error::Error;
use std::hint::black_box;

use sig_core::format::SectionKind;
use sig_core::{Complex, Dim, Index, SimplexId, VertexId};
use sig_tools::generate::SplitMix64;

use crate::common::{Timing, timed};

const ROWS: usize = 64;
const ROUNDS: usize = 5;
const SAMPLE: usize = 200_000;

/// A column of integers, packed.
struct Packed {
    /// Of each block the least value, the bits of a difference, and where its bits start in `words`.
    blocks: Vec<(u64, u32, u64)>,
    words: Vec<u64>,
    stop: u64,
}

impl Packed {
    fn new(values: impl Iterator<Item = u64>, stop: u64) -> Self {
        let values: Vec<u64> = values.collect();
        let mut packed = Self { blocks: Vec::new(), words: Vec::new(), stop };
        for block in values.chunks(ROWS) {
            let others = || block.iter().filter(|&&value| value != stop);
            let least = others().min().copied().unwrap_or(0);
            let most = others().max().map_or(0, |most| most - least);
            let has_stop = block.contains(&stop);
            // All ones is the stop code, where there is one.
            let width = u64::BITS - (most + u64::from(has_stop)).leading_zeros();
            let start = packed.words.len() as u64;
            packed.words.resize(packed.words.len() + (width as usize * block.len()).div_ceil(64), 0);
            for (row, &value) in block.iter().enumerate() {
                let code = if value == stop { u64::MAX >> (64 - width) } else { value - least };
                let (word, bit) = (start as usize + row * width as usize / 64, row * width as usize % 64);
                if width > 0 {
                    packed.words[word] |= code << bit;
                    if bit + width as usize > 64 {
                        packed.words[word + 1] |= code >> (64 - bit);
                    }
                }
            }
            packed.blocks.push((least, width | u32::from(has_stop) << 31, start));
        }
        packed.words.push(0);
        packed
    }

    #[inline]
    fn get(&self, row: usize) -> u64 {
        let (least, shape, start) = self.blocks[row / ROWS];
        let width = (shape & 0xFF) as usize;
        let at = row % ROWS * width;
        let (word, bit) = (start as usize + at / 64, at % 64);
        let both = u128::from(self.words[word]) | u128::from(self.words[(word + 1).min(self.words.len() - 1)]) << 64;
        let mask = (1_u64 << width).wrapping_sub(1);
        let code = (both >> bit) as u64 & mask;
        if shape >> 31 == 1 && code == mask { self.stop } else { least + code }
    }

    /// Bytes of a file: for each block a value of the paper's integers, a byte for the width and five for the start.
    fn bytes(&self, integer: usize) -> usize {
        self.blocks.len() * (integer + 6) + self.words.len() * 8
    }
}

/// Sizes by section, and the times of facets and vertices of random top simplices beside those of the plain arrays.
pub(super) fn packed<I: Index>(complex: &Complex<'_, I>) -> Result<(), Box<dyn Error>> {
    let top = complex.dim().filter(|&top| top > 0).ok_or("no edges")?;
    let section = |kind| -> &[I] {
        let section = complex.container().section(kind).map_or(&[][..], |section| section.column.as_bytes());
        bytemuck::try_cast_slice(section).unwrap_or_default()
    };
    let value = |value: &I| if *value == I::STOP { u64::MAX } else { value.to_usize() as u64 };
    let (mut rest, mut columns) = (section(SectionKind::Boundary), Vec::new());
    let (mut plain_bytes, mut packed_bytes) = (0, 0);
    let mut report = |name: &str, integers: usize, packed: usize| {
        let plain = integers * I::WIDTH.bytes();
        let share = packed as f64 / plain.max(1) as f64;
        println!(
            "{name:<14} {integers:>12} {plain:>13} {packed:>13} {share:8.2} {:6.1}",
            packed as f64 * 8.0 / integers as f64
        );
        plain_bytes += plain;
        packed_bytes += packed;
    };
    println!(
        "\npacked blocks of {ROWS} rows\ncolumn             integers         bytes        packed    share   bits each"
    );
    for dim in 1..=top {
        let (rows, behind) = rest.split_at(complex.num_simplices_of_dim(dim) * (dim + 1));
        rest = behind;
        let of_dim: Vec<Packed> = (0..=dim)
            .map(|column| Packed::new(rows.iter().skip(column).step_by(dim + 1).map(value), u64::MAX))
            .collect();
        for (column, packed) in of_dim.iter().enumerate() {
            report(&format!("F_{dim}[{column}]"), rows.len() / (dim + 1), packed.bytes(I::WIDTH.bytes()));
        }
        columns.push(of_dim);
    }
    let pointers = section(SectionKind::Pointers);
    for dim in 0..top {
        let (first, end) = complex.simplices_of_dim(dim).bounds();
        let of_dim = pointers.get(first.index()..end.index()).unwrap_or_default();
        report(
            &format!("pointers, {dim}"),
            of_dim.len(),
            Packed::new(of_dim.iter().map(value), u64::MAX).bytes(I::WIDTH.bytes()),
        );
    }
    let lists = section(SectionKind::Lists);
    report("lists", lists.len(), Packed::new(lists.iter().map(value), u64::MAX).bytes(I::WIDTH.bytes()));
    println!("all            {plain_bytes:>26} {packed_bytes:>13} {:8.2}", packed_bytes as f64 / plain_bytes as f64);

    let mut random = SplitMix64::new(3);
    let (first, _) = complex.simplices_of_dim(top).bounds();
    let count = complex.num_simplices_of_dim(top);
    println!("random {top}-simplices, ns each    plain   packed    ratio");
    for (name, among) in [("all of the file", count), ("the first 1000", count.min(1000))] {
        let sample: Vec<usize> = (0..SAMPLE).map(|_| random.next_below(among)).collect();
        let mut seconds = [(); 4].map(|()| Vec::new());
        let facet = |dim: Dim, row: usize, column: usize| columns[dim - 1][column].get(row) as usize;
        let start = |dim| complex.simplices_of_dim(dim).bounds().0.index();
        let starts: Vec<usize> = (0..=top).map(start).collect();
        let first_vertex = |dim: Dim, id: usize| (1..=dim).rev().fold(id, |id, dim| facet(dim, id - starts[dim], dim));
        let vertices = |row: usize| {
            let (mut sum, mut rest) = (0, first.index() + row);
            for dim in (0..=top).rev() {
                sum += first_vertex(dim, rest);
                if dim > 0 {
                    rest = facet(dim, rest - starts[dim], 0);
                }
            }
            sum
        };
        for _ in 0..ROUNDS {
            let plain = |row: &usize| SimplexId::new(first.index() + row);
            let facets = |row: &usize| (0..=top).map(|column| facet(top, *row, column)).sum::<usize>();
            let (time, a) = timed(|| {
                sample.iter().map(|row| complex.facets(plain(row)).map(SimplexId::index).sum::<usize>()).sum::<usize>()
            });
            seconds[0].push(time);
            let (time, b) = timed(|| sample.iter().map(facets).sum::<usize>());
            seconds[1].push(time);
            let (time, c) = timed(|| {
                sample.iter().map(|row| complex.vertices(plain(row)).map(VertexId::index).sum::<usize>()).sum::<usize>()
            });
            seconds[2].push(time);
            let (time, d) = timed(|| sample.iter().map(|&row| vertices(row)).sum::<usize>());
            seconds[3].push(time);
            if black_box((a, c)) != black_box((b, d)) {
                return Err("the packed columns are not the same".into());
            }
        }
        let [facets, packed_facets, words, packed_words] =
            seconds.map(|samples| Timing::of(samples).median * 1e9 / SAMPLE as f64);
        println!("facets, {name:<16} {facets:10.1} {packed_facets:8.1} {:8.2}", packed_facets / facets);
        println!("vertices, {name:<14} {words:10.1} {packed_words:8.1} {:8.2}", packed_words / words);
    }
    Ok(())
}
