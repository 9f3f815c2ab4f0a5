//! The rings that coefficients are taken from: the integers in 64 bits, checked; the integers of any size; a prime field.

use std::hash::Hash;

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, Zero};

/// A number does not fit 64 bits.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Overflow;

/// A Euclidean ring.
pub(super) trait Ring: Sync {
    /// Its elements.
    type Element: Clone + Eq + Hash + Send + Sync;

    /// The image of an integer.
    fn of(&self, integer: i64) -> Self::Element;

    fn is_zero(&self, a: &Self::Element) -> bool;

    /// `a + b c`.
    fn add_product(&self, a: &Self::Element, b: &Self::Element, c: &Self::Element) -> Result<Self::Element, Overflow>;

    fn negate(&self, a: &Self::Element) -> Result<Self::Element, Overflow>;

    /// The inverse of a unit.
    fn inverse(&self, a: &Self::Element) -> Option<Self::Element>;

    /// The quotient of a division with remainder; the remainder is smaller than `b`. In a field there is none.
    fn quotient(&self, a: &Self::Element, b: &Self::Element) -> Result<Self::Element, Overflow>;

    /// Whether `a` is smaller than `b` in the sense of the division with remainder.
    fn is_smaller(&self, a: &Self::Element, b: &Self::Element) -> bool;

    /// The element as an integer, of a prime field one from 0 on.
    fn integer(&self, a: &Self::Element) -> BigInt;

    /// The element up to units, as an integer.
    fn magnitude(&self, a: &Self::Element) -> BigInt;
}

/// ℤ in 64 bits; what does not fit is an error.
pub(super) struct SmallIntegers;

impl Ring for SmallIntegers {
    type Element = i64;

    #[inline]
    fn of(&self, integer: i64) -> i64 {
        integer
    }

    #[inline]
    fn is_zero(&self, a: &i64) -> bool {
        *a == 0
    }

    #[inline]
    fn add_product(&self, a: &i64, b: &i64, c: &i64) -> Result<i64, Overflow> {
        b.checked_mul(*c).and_then(|product| a.checked_add(product)).ok_or(Overflow)
    }

    #[inline]
    fn negate(&self, a: &i64) -> Result<i64, Overflow> {
        a.checked_neg().ok_or(Overflow)
    }

    #[inline]
    fn inverse(&self, a: &i64) -> Option<i64> {
        (a.unsigned_abs() == 1).then_some(*a)
    }

    fn quotient(&self, a: &i64, b: &i64) -> Result<i64, Overflow> {
        a.checked_div(*b).ok_or(Overflow)
    }

    fn is_smaller(&self, a: &i64, b: &i64) -> bool {
        a.unsigned_abs() < b.unsigned_abs()
    }

    fn integer(&self, a: &i64) -> BigInt {
        BigInt::from(*a)
    }

    fn magnitude(&self, a: &i64) -> BigInt {
        BigInt::from(a.unsigned_abs())
    }
}

/// ℤ.
pub(super) struct Integers;

impl Ring for Integers {
    type Element = BigInt;

    fn of(&self, integer: i64) -> BigInt {
        BigInt::from(integer)
    }

    fn is_zero(&self, a: &BigInt) -> bool {
        a.is_zero()
    }

    fn add_product(&self, a: &BigInt, b: &BigInt, c: &BigInt) -> Result<BigInt, Overflow> {
        Ok(a + b * c)
    }

    fn negate(&self, a: &BigInt) -> Result<BigInt, Overflow> {
        Ok(-a)
    }

    fn inverse(&self, a: &BigInt) -> Option<BigInt> {
        a.magnitude().is_one().then(|| a.clone())
    }

    fn quotient(&self, a: &BigInt, b: &BigInt) -> Result<BigInt, Overflow> {
        Ok(a / b)
    }

    fn is_smaller(&self, a: &BigInt, b: &BigInt) -> bool {
        a.magnitude() < b.magnitude()
    }

    fn integer(&self, a: &BigInt) -> BigInt {
        a.clone()
    }

    fn magnitude(&self, a: &BigInt) -> BigInt {
        a.abs()
    }
}

/// ℤ/p for a prime p below 2³².
pub(super) struct PrimeField(pub(super) u32);

impl PrimeField {
    fn modulus(&self) -> u64 {
        self.0.into()
    }
}

impl Ring for PrimeField {
    type Element = u64;

    #[inline]
    fn of(&self, integer: i64) -> u64 {
        integer.rem_euclid(self.0.into()).unsigned_abs()
    }

    #[inline]
    fn is_zero(&self, a: &u64) -> bool {
        *a == 0
    }

    #[inline]
    fn add_product(&self, a: &u64, b: &u64, c: &u64) -> Result<u64, Overflow> {
        // Below (p − 1) + (p − 1)² < 2⁶⁴.
        Ok((a + b * c) % self.modulus())
    }

    #[inline]
    fn negate(&self, a: &u64) -> Result<u64, Overflow> {
        Ok(if *a == 0 { 0 } else { self.modulus() - a })
    }

    fn inverse(&self, a: &u64) -> Option<u64> {
        let (a, modulus) = (i64::try_from(*a).ok()?, i64::from(self.0));
        let gcd = a.extended_gcd(&modulus);
        (a != 0).then(|| self.of(gcd.x))
    }

    fn quotient(&self, a: &u64, b: &u64) -> Result<u64, Overflow> {
        let inverse = self.inverse(b).ok_or(Overflow)?;
        self.add_product(&0, a, &inverse)
    }

    fn is_smaller(&self, a: &u64, b: &u64) -> bool {
        *a == 0 && *b != 0
    }

    fn integer(&self, a: &u64) -> BigInt {
        BigInt::from(*a)
    }

    fn magnitude(&self, a: &u64) -> BigInt {
        BigInt::from(u8::from(*a != 0))
    }
}

/// The entries of a vector that are not zero, by increasing position.
pub(super) type Sparse<E> = Vec<(u32, E)>;

/// Adds `factor` times a vector to another one.
pub(super) fn add_multiple<R: Ring>(
    ring: &R,
    to: &mut Sparse<R::Element>,
    factor: &R::Element,
    vector: &[(u32, R::Element)],
) -> Result<(), Overflow> {
    let zero = ring.of(0);
    let mut sum = Vec::with_capacity(to.len() + vector.len());
    let mut others = vector.iter().peekable();
    for (at, value) in to.drain(..) {
        while let Some((other, entry)) = others.next_if(|(other, _)| *other < at) {
            sum.push((*other, ring.add_product(&zero, factor, entry)?));
        }
        let value = match others.next_if(|(other, _)| *other == at) {
            Some((_, entry)) => ring.add_product(&value, factor, entry)?,
            None => value,
        };
        sum.push((at, value));
    }
    for (other, entry) in others {
        sum.push((*other, ring.add_product(&zero, factor, entry)?));
    }
    sum.retain(|(_, value)| !ring.is_zero(value));
    *to = sum;
    Ok(())
}
