//! The darts of one n-simplex, and where the permutations take them: tables that depend on n alone.
//!
//! A flag of a simplex, a chain of one face of each dimension, is an order (w_0, …, w_n) of its vertices: the face of
//! dimension i is {w_0, …, w_i}. The involution α_i, which takes a flag to the one that differs from it in dimension i only,
//! exchanges w_i and w_{i+1} for i < n. A map has the flags of one orientation, and βi = α_i ∘ α_0 leads from one to
//! another of them.
//!
//! In the lexicographic list of all orders the two at places 2r and 2r + 1 differ in their last two vertices, so that one
//! is even and one odd. Dart r of a simplex is that of the two which has the orientation of the simplex.

use sig_core::Dim;

use crate::build::narrow;

/// The tables of dimension n. Positions are those of the vertices in the sorted word of a simplex.
pub(super) struct Words {
    dim: Dim,
    /// Darts of a simplex.
    pub(super) count: usize,
    /// The order of the vertices of each dart, n + 1 positions; of a positive simplex, and of a negative one.
    orders: [Vec<u8>; 2],
    /// β1, …, β(n−1) of each dart: n − 1 darts of the same simplex.
    within: [Vec<u32>; 2],
    /// Where βn leaves: the position of the vertex that is not in the facet, and the number of the rest of the flag.
    leaving: [Vec<(u8, u32)>; 2],
    /// Where βn arrives: the dart, by the position of the vertex that is not in the facet and the number of the flag.
    arriving: Vec<u32>,
    /// The flags of a facet: n!.
    flags: usize,
}

impl Words {
    /// The tables for simplices of dimension `dim`, of which each has `count` darts.
    ///
    /// Cost: O(n²) for each of the (n + 1)! orders.
    pub(super) fn new(dim: Dim, count: usize) -> Self {
        let flags = (2..=dim).product();
        let mut words = Self {
            dim,
            count,
            orders: [Vec::new(), Vec::new()],
            within: [Vec::new(), Vec::new()],
            leaving: [Vec::new(), Vec::new()],
            arriving: vec![0; (dim + 1) * flags],
            flags,
        };
        for rank in 0..2 * count {
            words.add(&order(rank, dim + 1));
        }
        words
    }

    /// Adds one order, in lexicographic order of them all.
    fn add(&mut self, order: &[u8]) {
        let n = self.dim;
        let sign = usize::from(is_odd(order));
        self.orders[sign].extend_from_slice(order);
        let dart = self.orders[sign].len() / (n + 1) - 1;
        let mut turned = order.to_vec();
        turned.swap(0, 1);
        for i in 1..n {
            turned.swap(i, i + 1);
            self.within[sign].push(narrow(rank(&turned) / 2));
            turned.swap(i, i + 1);
        }
        self.leaving[sign].push((turned[n], narrow(self.facet_flag(&turned))));
        let arrival = usize::from(order[n]) * self.flags + self.facet_flag(order);
        self.arriving[arrival] = narrow(dart);
    }

    /// The number of the flag in the facet without the last vertex.
    fn facet_flag(&self, order: &[u8]) -> usize {
        let last = order[self.dim];
        let facet: Vec<u8> = order[..self.dim].iter().map(|&position| position - u8::from(position > last)).collect();
        rank(&facet)
    }

    /// The positions (w_0, …, w_n) of a dart of a simplex, positive or negative.
    pub(super) fn order(&self, is_negative: bool, dart: usize) -> &[u8] {
        &self.orders[usize::from(is_negative)][dart * (self.dim + 1)..][..self.dim + 1]
    }

    /// β1, …, β(n−1) of a dart, as darts of the simplex.
    pub(super) fn within(&self, is_negative: bool, dart: usize) -> &[u32] {
        &self.within[usize::from(is_negative)][dart * (self.dim - 1)..][..self.dim - 1]
    }

    /// The facet through which βn leaves, by the position of the vertex that it omits, and the flag to arrive with.
    pub(super) fn leaving(&self, is_negative: bool, dart: usize) -> (usize, usize) {
        let (position, flag) = self.leaving[usize::from(is_negative)][dart];
        (usize::from(position), flag as usize)
    }

    /// The dart at which βn arrives through the facet that omits a position.
    pub(super) fn arriving(&self, position: usize, flag: usize) -> u32 {
        self.arriving[position * self.flags + flag]
    }
}

/// The order of `len` positions at a place of the lexicographic list.
fn order(mut rank: usize, len: usize) -> Vec<u8> {
    let mut left: Vec<u8> = (0..32).take(len).collect();
    let mut order = Vec::with_capacity(len);
    let mut rest: usize = (2..len).product();
    for at in (0..len).rev() {
        order.push(left.remove(rank / rest));
        rank %= rest;
        rest /= at.max(1);
    }
    order
}

/// The place of an order of positions in the lexicographic list.
fn rank(order: &[u8]) -> usize {
    let smaller = |at: usize| order[at + 1..].iter().filter(|&&later| later < order[at]).count();
    (0..order.len()).fold(0, |rank, at| rank * (order.len() - at) + smaller(at))
}

fn is_odd(order: &[u8]) -> bool {
    let inversions = |at: usize| order[at + 1..].iter().filter(|&&later| later < order[at]).count();
    (0..order.len()).map(inversions).sum::<usize>() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_listed_lexicographically() {
        for len in 1..6 {
            let orders: Vec<Vec<u8>> = (0..(1..=len).product()).map(|rank| order(rank, len)).collect();
            assert!(orders.is_sorted_by(|a, b| a < b));
            assert!(orders.iter().enumerate().all(|(at, order)| rank(order) == at));
        }
    }

    #[test]
    fn every_second_flag_is_a_dart() {
        for dim in 1..6 {
            let count = (3..=dim + 1).product();
            let words = Words::new(dim, count);
            for is_negative in [false, true] {
                for dart in 0..count {
                    let order = words.order(is_negative, dart);
                    assert_eq!((is_odd(order), rank(order) / 2), (is_negative, dart));
                }
            }
        }
    }
}
