//! The link condition: whether contracting an edge keeps the homotopy type.

use sig_core::{Complex, Index, Scratch, ScratchError, SimplexId, VertexId};

/// Whether Lk(a) ∩ Lk(b) = Lk(ab) for the edge {a, b} of a complex: contracting it then gives a complex of the same homotopy
/// type (simplex-tree-2012, 2.2). `false` if the vertices are not joined by an edge.
///
/// Sufficient, not necessary. Cost: three links ([`Complex::link`]), linear in the stars of a and b, and sorting the
/// two of a and b; nothing that grows with the complex.
///
/// # Errors
/// [`ScratchError`] if the scratch is too small; it can be used again.
pub fn link_condition<I: Index>(
    complex: &Complex<'_, I>,
    a: VertexId,
    b: VertexId,
    scratch: &mut Scratch<'_, I>,
) -> Result<bool, ScratchError> {
    let Some(edge) = complex.find(&[a.min(b), a.max(b)]) else { return Ok(false) };
    // Lk(ab) is in both, whatever the complex.
    let of_edge = complex.link(edge, scratch)?.len();
    let mut of_a: Vec<SimplexId> = complex.link(a.into(), scratch)?.collect();
    of_a.sort_unstable();
    let of_b = complex.link(b.into(), scratch)?;
    let common = of_b.filter(|simplex| of_a.binary_search(simplex).is_ok()).count();
    Ok(common == of_edge)
}
