//! Named columns of numbers: attributes of the vertices of a complex, or of its simplices of one dimension.
//!
//! What other programs call point data and cell data, properties, references, groups. [`crate::io`] reads them,
//! [`crate::build`] brings them into the order of the ids, files hold them as sections of their own, and
//! [`crate::export`] writes them. A vertex is a simplex: what is said of a cell of dimension 0 is said of its vertex.

use sig_core::format::Column;
use sig_core::{Dim, Relations};

/// The name of the attribute that formats with a single integer a vertex or a cell read and write: MEDIT's references,
/// MFEM's attributes, Gmsh's physical groups, TetGen's boundary markers.
pub const REFERENCE: &str = "ref";

/// The name of the attribute that TetGen's files have, which name none.
pub(crate) const NAMELESS: &str = "attribute";

/// The most components that are read of an attribute: the rest of the work multiplies by it.
pub(crate) const MOST_COMPONENTS: usize = 64;

/// A named column over the vertices, or over the simplices of one dimension.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// The name, not empty; different from those of other attributes of the dimension.
    pub name: Box<str>,
    /// The dimension of the simplices; 0 stands for the vertices.
    pub dim: Dim,
    /// Numbers a row, at least 1.
    pub components: usize,
    /// The numbers, row-major.
    pub values: Values,
}

impl Attribute {
    /// The number of rows.
    #[must_use]
    pub fn num_rows(&self) -> usize {
        self.values.len() / self.components.max(1)
    }

    /// The same column with these rows, by number; where there is none, without a value.
    pub(crate) fn with_rows(&self, rows: impl Iterator<Item = Option<usize>>) -> Self {
        let values = self.values.rows(self.components, rows);
        Self { name: self.name.clone(), values, ..*self }
    }

    /// Whether two of its rows are the same.
    pub(crate) fn is_same(&self, row: usize, other: usize) -> bool {
        (0..self.components).all(|at| {
            let [a, b] = [row, other].map(|row| row * self.components + at);
            with_values!(&self.values, values => values[a].is_same(values[b]))
        })
    }

    /// Whether a row has any value.
    pub(crate) fn has_value(&self, row: usize) -> bool {
        fn has_value<T: Scalar>(row: &[T]) -> bool {
            row.iter().any(|value| !value.is_same(T::MISSING))
        }
        let places = row * self.components..(row + 1) * self.components;
        with_values!(&self.values, values => has_value(&values[places]))
    }

    /// Takes over the rows of another column of as many simplices where `rows` says that it has one: those that have no
    /// value here, while the others must be the same. Whether that can be; if not, nothing changes.
    pub(crate) fn add_rows(&mut self, other: &Self, rows: &[Option<usize>]) -> bool {
        if self.components != other.components || !self.values.is_alike(&other.values) {
            return false;
        }
        let num_rows = self.num_rows();
        let mut both = self.values.clone();
        both.append(other.values.clone());
        let missing = self.with_rows(std::iter::once(None));
        both.append(missing.values);
        let both = Self { values: both, name: self.name.clone(), ..*self };
        let is_free = |row| both.is_same(row, 2 * num_rows);
        let fits = |row| is_free(row) || both.is_same(row, num_rows + row);
        if !rows.iter().enumerate().all(|(row, other)| other.is_none() || fits(row)) {
            return false;
        }
        let row_of = |(row, other): (usize, &Option<usize>)| Some(if other.is_some() { num_rows + row } else { row });
        self.values = both.values.rows(self.components, rows.iter().enumerate().map(row_of));
        true
    }

    /// The attributes of a complex in a file, by dimension and name.
    ///
    /// Cost: a copy.
    #[must_use]
    pub fn all_of(complex: &impl Relations) -> Vec<Self> {
        let attributes = complex.container().sections().filter_map(|section| {
            let values = Values::from_column(&section.column)?;
            let components = section.components as usize;
            section.dim.map(|dim| Self { name: section.name.into(), dim, components, values })
        });
        attributes.collect()
    }
}

/// A number of any of the types.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Number {
    /// An integer.
    Integer(i128),
    /// A floating-point number.
    Float(f64),
}

/// Numbers of one type.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Bytes.
    U8(Vec<u8>),
    /// 16-bit integers.
    U16(Vec<u16>),
    /// 32-bit integers.
    U32(Vec<u32>),
    /// 64-bit integers.
    U64(Vec<u64>),
    /// 32-bit integers with sign.
    I32(Vec<i32>),
    /// 64-bit integers with sign.
    I64(Vec<i64>),
    /// Single-precision numbers.
    F32(Vec<f32>),
    /// Double-precision numbers.
    F64(Vec<f64>),
}

/// Evaluates an expression for the vector of whatever type.
macro_rules! with_values {
    ($values:expr, $vector:ident => $result:expr) => {
        match $values {
            $crate::attribute::Values::U8($vector) => $result,
            $crate::attribute::Values::U16($vector) => $result,
            $crate::attribute::Values::U32($vector) => $result,
            $crate::attribute::Values::U64($vector) => $result,
            $crate::attribute::Values::I32($vector) => $result,
            $crate::attribute::Values::I64($vector) => $result,
            $crate::attribute::Values::F32($vector) => $result,
            $crate::attribute::Values::F64($vector) => $result,
        }
    };
}
use with_values;

/// A number of one of the types.
trait Scalar: Copy {
    /// What stands where there is no value: NaN, of integers 0.
    const MISSING: Self;

    /// Whether two are equal, NaN and NaN being so.
    fn is_same(self, other: Self) -> bool;

    /// The number that is, or is nearest to, `number`; `None` if it does not fit.
    fn from_number(number: Number) -> Option<Self>;

    /// A vector of them.
    fn wrap(vector: Vec<Self>) -> Values;
}

macro_rules! integers {
    ($($scalar:ident $variant:ident),*) => {$(
        impl Scalar for $scalar {
            const MISSING: Self = 0;

            fn is_same(self, other: Self) -> bool {
                self == other
            }

            fn from_number(number: Number) -> Option<Self> {
                match number {
                    Number::Integer(integer) => Self::try_from(integer).ok(),
                    Number::Float(_) => None,
                }
            }

            fn wrap(vector: Vec<Self>) -> Values {
                Values::$variant(vector)
            }
        }
    )*};
}

integers!(u8 U8, u16 U16, u32 U32, u64 U64, i32 I32, i64 I64);

macro_rules! floats {
    ($($scalar:ident $variant:ident),*) => {$(
        impl Scalar for $scalar {
            const MISSING: Self = Self::NAN;

            fn is_same(self, other: Self) -> bool {
                self == other || self.is_nan() && other.is_nan()
            }

            #[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "the nearest number")]
            fn from_number(number: Number) -> Option<Self> {
                Some(match number {
                    Number::Integer(integer) => integer as Self,
                    Number::Float(float) => float as Self,
                })
            }

            fn wrap(vector: Vec<Self>) -> Values {
                Values::$variant(vector)
            }
        }
    )*};
}

floats!(f32 F32, f64 F64);

impl Values {
    /// Integers of 32 bits if all fit, else of 64.
    pub(crate) fn from_integers(integers: Vec<i64>) -> Self {
        let narrow: Result<Vec<i32>, _> = integers.iter().map(|&integer| integer.try_into()).collect();
        narrow.map_or(Self::I64(integers), Self::I32)
    }

    /// How many numbers there are.
    #[must_use]
    pub fn len(&self) -> usize {
        with_values!(self, values => values.len())
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The bytes that they take.
    #[must_use]
    pub fn num_bytes(&self) -> usize {
        with_values!(self, values => size_of_val(values.as_slice()))
    }

    /// The numbers as a file has them.
    #[must_use]
    pub fn column(&self) -> Column<'_> {
        match self {
            Self::U8(values) => Column::U8(values),
            Self::U16(values) => Column::U16(values),
            Self::U32(values) => Column::U32(values),
            Self::U64(values) => Column::U64(values),
            Self::I32(values) => Column::I32(values),
            Self::I64(values) => Column::I64(values),
            Self::F32(values) => Column::F32(values),
            Self::F64(values) => Column::F64(values),
        }
    }

    /// A copy of a column of numbers.
    pub(crate) fn from_column(column: &Column<'_>) -> Option<Self> {
        Some(match column {
            Column::Bits { .. } => return None,
            Column::U8(values) => Self::U8(values.to_vec()),
            Column::U16(values) => Self::U16(values.to_vec()),
            Column::U32(values) => Self::U32(values.to_vec()),
            Column::U64(values) => Self::U64(values.to_vec()),
            Column::I32(values) => Self::I32(values.to_vec()),
            Column::I64(values) => Self::I64(values.to_vec()),
            Column::F32(values) => Self::F32(values.to_vec()),
            Column::F64(values) => Self::F64(values.to_vec()),
        })
    }

    /// Adds a number; whether it is one of the type.
    pub(crate) fn push(&mut self, number: Number) -> bool {
        fn push<T: Scalar>(values: &mut Vec<T>, number: Number) -> bool {
            let scalar = T::from_number(number);
            values.extend(scalar);
            scalar.is_some()
        }
        with_values!(self, values => push(values, number))
    }

    /// Whether these are integers, and all are this one.
    pub(crate) fn are_all(&self, integer: i64) -> bool {
        fn are_all<T: Scalar>(values: &[T], integer: i64) -> bool {
            let integer = T::from_number(Number::Integer(integer.into()));
            integer.is_some_and(|integer| values.iter().all(|value| value.is_same(integer)))
        }
        self.are_integers() && with_values!(self, values => are_all(values, integer))
    }

    /// Whether these are integers.
    pub(crate) const fn are_integers(&self) -> bool {
        !matches!(self, Self::F32(_) | Self::F64(_))
    }

    /// Whether both have the same type.
    pub(crate) fn is_alike(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }

    /// Rows of `components` numbers, by their numbers; where there is none, without a value.
    pub(crate) fn rows(&self, components: usize, rows: impl Iterator<Item = Option<usize>>) -> Self {
        fn gather<T: Scalar>(values: &[T], components: usize, rows: impl Iterator<Item = Option<usize>>) -> Values {
            let mut gathered = Vec::with_capacity(rows.size_hint().0.saturating_mul(components));
            for row in rows {
                match row {
                    Some(row) => gathered.extend_from_slice(&values[row * components..(row + 1) * components]),
                    None => gathered.resize(gathered.len() + components, T::MISSING),
                }
            }
            T::wrap(gathered)
        }
        with_values!(self, values => gather(values, components, rows))
    }

    /// Leaves only the rows of `components` numbers that stay.
    pub(crate) fn retain(&mut self, components: usize, stays: &[bool]) {
        with_values!(self, values => {
            let mut each = stays.iter().flat_map(|stays| std::iter::repeat_n(stays, components));
            values.retain(|_| each.next() == Some(&true));
        });
    }

    /// Adds numbers without a value, up to this many in all.
    pub(crate) fn fill(&mut self, len: usize) {
        fn fill<T: Scalar>(values: &mut Vec<T>, len: usize) {
            values.resize(len.max(values.len()), T::MISSING);
        }
        with_values!(self, values => fill(values, len));
    }

    /// Appends numbers of the same type; whether they are.
    pub(crate) fn append(&mut self, more: Self) -> bool {
        match (self, more) {
            (Self::U8(all), Self::U8(more)) => all.extend(more),
            (Self::U16(all), Self::U16(more)) => all.extend(more),
            (Self::U32(all), Self::U32(more)) => all.extend(more),
            (Self::U64(all), Self::U64(more)) => all.extend(more),
            (Self::I32(all), Self::I32(more)) => all.extend(more),
            (Self::I64(all), Self::I64(more)) => all.extend(more),
            (Self::F32(all), Self::F32(more)) => all.extend(more),
            (Self::F64(all), Self::F64(more)) => all.extend(more),
            _ => return false,
        }
        true
    }
}

/// The name of the type of the numbers in a column.
#[must_use]
pub const fn type_name(column: &Column<'_>) -> &'static str {
    match column {
        Column::Bits { .. } => "bits",
        Column::U8(_) => "u8",
        Column::U16(_) => "u16",
        Column::U32(_) => "u32",
        Column::U64(_) => "u64",
        Column::I32(_) => "i32",
        Column::I64(_) => "i64",
        Column::F32(_) => "f32",
        Column::F64(_) => "f64",
    }
}
