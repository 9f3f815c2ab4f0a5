//! The report of complexes in files, as small machines print it, to compare theirs with.
//!
//! On a host there is memory for a second opinion: each relation is also asked of the file as a simplex tree, whose
//! algorithms are others, and counted by the number of simplices of each dimension.

use std::error::Error;

use ask::{Line, Memory, Relation, Summary, report, survey_view};
use sig_core::{AnyComplex, Complex, Index, format, mark_words, with_complex};

fn main() -> Result<(), Box<dyn Error>> {
    for path in std::env::args().skip(1) {
        let bytes = std::fs::read(&path)?;
        format::verify(&bytes)?;
        // Words of 8 bytes, for the alignment of a view.
        let mut words = vec![0_u64; bytes.len() / 8];
        let buffer: &mut [u8] = bytemuck::cast_slice_mut(&mut words);
        buffer.copy_from_slice(&bytes);
        if cfg!(target_endian = "big") {
            format::swap_byte_order(buffer)?;
        }
        with_complex!(AnyComplex::from_bytes(buffer)?, complex => print(&complex)?);
    }
    Ok(())
}

/// Prints the report of a complex; an error if a second way to an answer disagrees.
fn print<I: Index>(complex: &Complex<'_, I>) -> Result<(), Box<dyn Error>> {
    complex.validate()?;
    let total = complex.num_simplices();
    let (mut marks, mut queue) = (vec![0; mark_words(total)], vec![I::ZERO; 2 * total]);
    let (mut masks, mut found) = (vec![0; 2 * total], vec![I::ZERO; 40 * total]);
    let mut memory = Memory { marks: &mut marks, queue: &mut queue, masks: &mut masks, found: &mut found };
    let mut lines = Vec::new();
    report(complex, &mut memory, &mut |line| lines.push(line)).map_err(|error| format!("{error:?}"))?;
    for line in lines {
        let of = |summary: Summary| format!("{} {:08x}", summary.count, summary.checksum);
        match line {
            Line::Number(name, count) => println!("{name} {count}"),
            Line::Summary(name, summary) => println!("{name} {}", of(summary)),
            Line::Grown(name, errors, summary) => println!("grown {name} {errors} {}", of(summary)),
        }
    }
    agrees_with_the_tree(complex, &mut memory)?;
    agrees_with_the_counts(complex, &mut memory)
}

fn agrees_with_the_tree<I: Index>(complex: &Complex<'_, I>, memory: &mut Memory<'_, I>) -> Result<(), Box<dyn Error>> {
    let tree = complex.as_tree().ok_or("the file has no tree")?;
    for relation in Relation::all().into_iter().filter(|relation| !relation.needs_clusters()) {
        let by_clusters = survey_view(complex, relation, &mut memory.scratch())?;
        if by_clusters != survey_view(tree, relation, &mut memory.scratch())? {
            return Err(format!("{}: the tree has other answers", relation.name()).into());
        }
    }
    Ok(())
}

/// Each p-simplex has p + 1 vertices and facets and 2^(p+1) − 1 faces, itself included; what is a face of what is a
/// coface of the other; and all but the vertices have a parent.
fn agrees_with_the_counts<I: Index>(
    complex: &Complex<'_, I>,
    memory: &mut Memory<'_, I>,
) -> Result<(), Box<dyn Error>> {
    let dims = 0..complex.dim().map_or(0, |dim| dim + 1);
    let sum = |faces: fn(usize) -> usize| -> usize {
        dims.clone().map(|dim| faces(dim) * complex.num_simplices_of_dim(dim)).sum()
    };
    let vertices = sum(|dim| dim + 1);
    let (facets, closure) = (vertices - complex.num_vertices(), sum(|dim| (2 << dim) - 1));
    let (faces, not_vertices) = (closure - complex.num_simplices(), complex.num_simplices() - complex.num_vertices());
    for (relation, expected) in [
        (Relation::Vertices, vertices),
        (Relation::Facets, facets),
        (Relation::Boundary, faces),
        (Relation::Closure, closure),
        (Relation::Coboundary, faces),
        (Relation::Star, closure),
        (Relation::RestrictedStar, faces),
        (Relation::Parent, not_vertices),
        (Relation::Children, not_vertices),
    ] {
        let found = survey_view(complex, relation, &mut memory.scratch())?.count;
        if found as usize != expected {
            return Err(format!("{}: {found}, not {expected}", relation.name()).into());
        }
    }
    Ok(())
}
