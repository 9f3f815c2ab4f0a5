//! What decides what is kept of a build: the input, the options, the resources, the program.

use std::hash::{DefaultHasher, Hash, Hasher};

use super::{BuildOptions, EncodeOptions, Resources};
use crate::soup::{Coordinates, Labels, Scalars};
use crate::spool::Spill;

/// Names and values.
pub(super) type Key = Vec<(String, String)>;

/// Hashes of 64 bits of the vertices and of the listed simplices.
pub(super) struct Fingerprint {
    vertices: DefaultHasher,
    pub(super) simplices: DefaultHasher,
}

impl Fingerprint {
    /// That of some vertices.
    pub(super) fn new(labels: &Labels, declared: bool, coordinates: Option<&Coordinates>) -> Self {
        let mut hasher = DefaultHasher::new();
        declared.hash(&mut hasher);
        match labels {
            Labels::Numbered(count) => count.hash(&mut hasher),
            Labels::Integers(labels) => labels.hash(&mut hasher),
            Labels::Tokens(labels) => labels.hash(&mut hasher),
        }
        if let Some(Coordinates { dim, values }) = coordinates {
            dim.hash(&mut hasher);
            match values {
                Scalars::F32(values) => hasher.write(bytemuck::cast_slice(values)),
                Scalars::F64(values) => hasher.write(bytemuck::cast_slice(values)),
            }
        }
        Self { vertices: hasher, simplices: DefaultHasher::new() }
    }

    /// The key of a build of the vertices and the listed simplices.
    pub(super) fn key(
        &self,
        spill: &Spill,
        options: &BuildOptions<'_>,
        encode: &EncodeOptions<'_>,
        resources: Resources<'_>,
    ) -> Key {
        let hash = |hasher: &DefaultHasher| format!("{:016x}", hasher.finish());
        let EncodeOptions { width, tree, lower_neighbours, pairs: _, checksums, provenance } = encode;
        let values = [
            ("version of the program", env!("CARGO_PKG_VERSION").to_owned()),
            ("processor", std::env::consts::ARCH.to_owned()),
            ("number of simplices listed, by dimension", format!("{:?}", spill.counts())),
            ("input, by the hash of its vertices", hash(&self.vertices)),
            ("input, by the hash of its simplices", hash(&self.simplices)),
            ("vertex order", format!("{:?}", options.order)),
            ("treatment of unused vertices", format!("{:?}", options.unused)),
            ("width of the indices", width.map_or("the least".to_owned(), |width| width.bits().to_string())),
            (
                "choice of sections",
                format!("tree {tree}, lower neighbours {lower_neighbours:?}, checksums {checksums}"),
            ),
            ("provenance", format!("{provenance:?}")),
            ("amount of memory", format!("{} bytes", resources.memory)),
            ("number of threads", rayon::current_num_threads().to_string()),
        ];
        values.map(|(name, value)| (name.to_owned(), value)).into()
    }
}
