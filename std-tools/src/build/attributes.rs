//! Attributes of the listed simplices become attributes of the simplices by id.
//!
//! The construction forgets which listed simplex a simplex comes from; it is found again by its vertices, in the tree.

use rayon::prelude::*;
use sig_core::{Dim, Index, MAX_DIM};

use crate::attribute::Attribute;
use crate::build::limits::available_memory;
use crate::build::order::Order;
use crate::build::{BuildError, BuildOptions, SigArrays};
use crate::soup::Soup;

/// The attributes of a soup, and the simplices whose rows they have.
pub(super) struct Listed {
    attributes: Vec<Attribute>,
    /// Those of the dimensions with attributes, as the soup lists them.
    simplices: Vec<Vec<u32>>,
}

impl Listed {
    /// Takes the attributes from a soup, and copies the simplices that have some.
    ///
    /// # Errors
    /// [`BuildError::MalformedAttribute`].
    pub(super) fn take(soup: &mut Soup) -> Result<Self, BuildError> {
        let mut simplices = vec![Vec::new(); soup.simplices.len()];
        for (index, Attribute { dim, components, values, .. }) in soup.attributes.iter().enumerate() {
            let dim = *dim;
            let listed = soup.simplices.get(dim).map_or(&[][..], Vec::as_slice);
            let rows = if dim == 0 { soup.labels.len() } else { listed.len() / (dim + 1) };
            if *components == 0 || components.checked_mul(rows) != Some(values.len()) || dim > MAX_DIM {
                return Err(BuildError::MalformedAttribute { index, dim, values: values.len(), rows });
            }
            if dim > 0 && simplices.get(dim).is_some_and(Vec::is_empty) {
                simplices[dim] = listed.to_vec();
            }
        }
        let mut attributes = std::mem::take(&mut soup.attributes);
        attributes.sort_by(|a, b| (a.dim, &a.name).cmp(&(b.dim, &b.name)));
        Ok(Self { attributes, simplices })
    }

    /// The attributes with a row for each simplex of their dimension, and how many listed simplices repeat another with
    /// other values; those of the first stay.
    ///
    /// Cost: a search in the tree for each listed simplex of a dimension with attributes.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if the rows do not fit the memory.
    pub(super) fn by_id<I: Index>(
        self,
        arrays: &SigArrays<I>,
        order: &Order,
        options: &BuildOptions<'_>,
    ) -> Result<(Vec<Attribute>, usize), BuildError> {
        self.check_room(arrays, options)?;
        let (mut by_id, mut differing) = (Vec::with_capacity(self.attributes.len()), 0);
        for attributes in self.attributes.chunk_by(|a, b| a.dim == b.dim) {
            let dim = attributes[0].dim;
            if arrays.ids(dim).is_empty() {
                continue;
            }
            if dim == 0 {
                let rows = || order.inputs().iter().map(|&input| Some(input as usize));
                by_id.extend(attributes.iter().map(|attribute| attribute.with_rows(rows())));
                continue;
            }
            let ids = arrays.ids(dim);
            let mut sources = vec![usize::MAX; ids.len()];
            for (row, id) in ids_of(&self.simplices[dim], dim, arrays, order).into_iter().enumerate() {
                let source = &mut sources[id - ids.start];
                if *source == usize::MAX {
                    *source = row;
                } else {
                    differing += usize::from(attributes.iter().any(|attribute| !attribute.is_same(*source, row)));
                }
            }
            let rows = || sources.iter().map(|&row| (row != usize::MAX).then_some(row));
            by_id.extend(attributes.iter().map(|attribute| attribute.with_rows(rows())));
        }
        Ok((by_id, differing))
    }

    /// Refuses attributes that, with a row for each simplex, do not fit the memory.
    fn check_room<I: Index>(&self, arrays: &SigArrays<I>, options: &BuildOptions<'_>) -> Result<(), BuildError> {
        let bytes = self.attributes.iter().map(|attribute| {
            let row = attribute.values.num_bytes().checked_div(attribute.num_rows()).unwrap_or(0);
            row as u128 * arrays.ids(attribute.dim).len() as u128
        });
        let (bytes, at_least) = (bytes.sum::<u128>(), arrays.num_simplices as u64);
        let room = u128::from(options.max_bytes.or_else(available_memory).unwrap_or(u64::MAX));
        if bytes <= room {
            return Ok(());
        }
        // At the same mean size.
        let limit = u64::try_from(u128::from(at_least) * room / bytes).unwrap_or(u64::MAX);
        Err(BuildError::TooLarge { at_least, limit })
    }
}

/// The id of each listed simplex of dimension `dim`, all of which are there.
fn ids_of<I: Index>(listed: &[u32], dim: Dim, arrays: &SigArrays<I>, order: &Order) -> Vec<usize> {
    let id_of = |simplex: &[u32]| {
        let mut word = [0; MAX_DIM + 1];
        let word = &mut word[..=dim];
        for (id, &vertex) in word.iter_mut().zip(simplex) {
            *id = order.id(vertex);
        }
        word.sort_unstable();
        let child = |parent: usize, last: &u32| {
            let start = arrays.child_offsets[parent].to_usize();
            let siblings = &arrays.last_vertices[start..arrays.child_offsets[parent + 1].to_usize()];
            start + siblings.partition_point(|sibling| sibling < last)
        };
        word[1..].iter().fold(word[0] as usize, child)
    };
    listed.par_chunks_exact(dim + 1).map(id_of).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;

    use super::*;
    use crate::attribute::Values;
    use crate::build::{VertexOrder, build};
    use crate::soup::{Coordinates, Labels, Scalars};

    /// The labels of the vertices of each simplex of a dimension, in the order of the ids.
    fn names(built: &crate::build::Built, dim: Dim) -> Vec<Vec<u64>> {
        let arrays = built.arrays.clone().into_wide();
        let label = |id: u64| match &built.labels {
            Labels::Integers(labels) => labels[usize::try_from(id).unwrap()],
            _ => id,
        };
        // Facet by facet: the first vertex is left out of the first.
        let mut words: Vec<Vec<u64>> = arrays.ids(0).map(|id| vec![id as u64]).collect();
        for p in 1..=dim {
            let first = arrays.ids(p - 1).start as u64;
            let word = |row: &[u64]| {
                let of = |facet: u64| &words[usize::try_from(facet - first).unwrap()];
                let mut word = of(row[p]).clone();
                word.extend(of(row[0]).last());
                word
            };
            words = arrays.facets(p).chunks(p + 1).map(word).collect();
        }
        words.iter().map(|word| word.iter().map(|&id| label(id)).collect()).collect()
    }

    proptest! {
        /// Each simplex has the value of the first listed simplex with its vertices, whatever the order of the vertices.
        #[test]
        fn values_are_those_of_the_first_listed(
            simplices in proptest::collection::vec(proptest::collection::btree_set(0_u32..7, 1..5), 0..20),
            labels in Just((10..17).collect::<Vec<u64>>()).prop_shuffle(),
            order in prop::sample::select(vec![VertexOrder::Input, VertexOrder::Hilbert, VertexOrder::Rcm]),
            turned: bool,
        ) {
            let mut soup = Soup::new(Labels::Integers(labels.clone()), true);
            soup.coordinates = Some(Coordinates { dim: 2, values: Scalars::F32((0..14_u8).map(f32::from).collect()) });
            for simplex in simplices {
                let mut simplex: Vec<u32> = simplex.into_iter().collect();
                if turned {
                    simplex.reverse();
                }
                soup.push(&simplex);
            }
            let mut expected: Vec<BTreeMap<Vec<u64>, i64>> = Vec::new();
            let mut differing = 0;
            for dim in 0..soup.simplices.len() {
                let name = |simplex: &[u32]| {
                    let mut name: Vec<u64> = simplex.iter().map(|&vertex| labels[vertex as usize]).collect();
                    name.sort_unstable();
                    name
                };
                let keys: Vec<Vec<u64>> = if dim == 0 {
                    (0..7).map(|vertex| name(&[vertex])).collect()
                } else {
                    soup.of_dim(dim).map(name).collect()
                };
                let mut of_dim = BTreeMap::new();
                for (value, key) in (1..).zip(&keys) {
                    match of_dim.entry(key.clone()) {
                        std::collections::btree_map::Entry::Vacant(entry) => drop(entry.insert(value)),
                        std::collections::btree_map::Entry::Occupied(_) => differing += 1,
                    }
                }
                let values = Values::I64((1..).take(keys.len()).collect());
                soup.attributes.push(Attribute { name: "a".into(), dim, components: 1, values });
                expected.push(of_dim);
            }
            let built = build(soup, &BuildOptions { order, ..BuildOptions::default() }).unwrap();
            prop_assert_eq!(built.report.differing, differing);
            for attribute in &built.attributes {
                let Values::I64(values) = &attribute.values else { panic!("another type") };
                let names = names(&built, attribute.dim);
                prop_assert_eq!(values.len(), names.len());
                for (name, value) in names.iter().zip(values) {
                    let mut key: Vec<u64> = name.clone();
                    key.sort_unstable();
                    prop_assert_eq!(expected[attribute.dim].get(&key).copied().unwrap_or(0), *value);
                }
            }
        }
    }

    #[test]
    fn rows_must_be_as_many_as_simplices() {
        let mut soup = Soup::new(Labels::Numbered(3), true);
        soup.push(&[0, 1, 2]);
        let values = Values::U8(vec![1, 2, 3]);
        soup.attributes.push(Attribute { name: "a".into(), dim: 2, components: 2, values });
        let error = build(soup, &BuildOptions::default()).unwrap_err();
        assert_eq!(error, BuildError::MalformedAttribute { index: 0, dim: 2, values: 3, rows: 1 });
        assert_eq!(
            error.to_string(),
            "attribute 0 has 3 numbers, which is not a row for each of 1 simplices of dimension 2"
        );
    }
}
