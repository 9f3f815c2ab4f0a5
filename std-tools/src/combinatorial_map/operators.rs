//! Removal and contraction of edges of 2-maps (mcc-2012, 4.3).
//!
//! They are the first type of the Euler operators: removal, K1C2C, deletes an edge and one of the two faces at it;
//! contraction, K0C1C, an edge and one of its two ends. On the incidence graph of the cells they have the same condition
//! and the same effect, but for one: a sphere of one vertex and one face has no edge, so no dart, and no map. So the last
//! edge of a component stays.

use sig_core::{Dim, SimplexId};

use super::{CombinatorialMap, NONE, Walk};

/// Why an edge cannot be removed or contracted.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OperatorError {
    /// The map is not a 2-map.
    #[error("edges are removed and contracted in maps of dimension 2, and this has dimension {0}")]
    Dimension(Dim),
    /// There is no such edge, or no longer.
    #[error("{0} is not an edge of the map")]
    NotAnEdge(SimplexId),
    /// The cell to be deleted is not at the edge.
    #[error("cell {cell} is not incident with edge {edge}")]
    NotIncident {
        /// The edge.
        edge: SimplexId,
        /// The cell.
        cell: SimplexId,
    },
    /// The cell to be deleted is at both sides, or at both ends, of the edge.
    #[error("cell {cell} is at both ends or on both sides of edge {edge}")]
    Twice {
        /// The edge.
        edge: SimplexId,
        /// The cell.
        cell: SimplexId,
    },
    /// The edge is the last of its component, which would be without a dart.
    #[error("{0} is the last edge of its component: a map without darts has no cells")]
    LastEdge(SimplexId),
}

impl CombinatorialMap {
    /// Removes an edge and one of the faces at it, which the other takes over: K1C2C(edge, face).
    ///
    /// Cost: O(1) for each dart of the two faces.
    ///
    /// # Errors
    /// [`OperatorError`] if the map is not a 2-map, or the edge does not lie between that face and another, or is the last
    /// of its component. Nothing is changed then.
    pub fn remove(&mut self, edge: SimplexId, face: SimplexId, walk: &mut Walk) -> Result<(), OperatorError> {
        let (dart, twin) = self.side(edge, face, 2)?;
        let (next, twin_next) = (self.b(1, dart), self.b(1, twin));
        // Both faces are this edge alone.
        if next == dart && twin_next == twin {
            return Err(OperatorError::LastEdge(edge));
        }
        let (before, twin_before) = (self.before(dart, walk), self.before(twin, walk));
        let kept = self.c(2, twin);
        self.walk_cell(dart, 2, walk);
        for at in 0..walk.orbit.len() {
            self.set_cell(2, walk.orbit[at], kept);
        }
        // A face of one edge leaves nothing between its ends: pass on to what follows the twin, and conversely.
        let after = |next: u32, of: u32, other: u32| if next == of { other } else { next };
        let (to, twin_to) = (after(twin_next, twin, next), after(next, dart, twin_next));
        if before != dart {
            self.set_beta(1, before, to);
        }
        if twin_before != twin {
            self.set_beta(1, twin_before, twin_to);
        }
        // What follows the twin leaves the vertex that the dart left, and conversely; both are in the face that is kept.
        self.delete(dart, twin, face, [to, twin_to]);
        Ok(())
    }

    /// Contracts an edge and one of its ends into the other end: K0C1C(vertex, edge).
    ///
    /// Cost: O(1) for each dart of the vertex and of the two faces at the edge.
    ///
    /// # Errors
    /// [`OperatorError`] if the map is not a 2-map, or the edge does not lead from that vertex to another, or is the last of
    /// its component. Nothing is changed then.
    pub fn contract(&mut self, edge: SimplexId, vertex: SimplexId, walk: &mut Walk) -> Result<(), OperatorError> {
        let (dart, twin) = self.side(edge, vertex, 0)?;
        let (next, twin_next) = (self.b(1, dart), self.b(1, twin));
        // Both ends are the ends of this edge alone.
        if next == twin && twin_next == dart {
            return Err(OperatorError::LastEdge(edge));
        }
        let (before, twin_before) = (self.before(dart, walk), self.before(twin, walk));
        let kept = self.c(0, twin);
        self.walk_cell(dart, 0, walk);
        for at in 0..walk.orbit.len() {
            self.set_cell(0, walk.orbit[at], kept);
        }
        // Where the edge turns back at an end, both darts of it are passed over.
        let to = if next == twin { twin_next } else { next };
        let twin_to = if twin_next == dart { next } else { twin_next };
        if before != twin {
            self.set_beta(1, before, to);
        }
        if twin_before != dart {
            self.set_beta(1, twin_before, twin_to);
        }
        // Both now leave the vertex that is kept, and are in the faces of the two darts.
        self.delete(dart, twin, vertex, [to, twin_to]);
        Ok(())
    }

    /// How often cell `p` of dimension i appears on the boundary of cell `q` of dimension i + 1, for all pairs that are
    /// incident: the arcs of the incidence graph of a 2-map with their multiplicities, in the order of (p, q).
    ///
    /// Cost: a sort of the 4 n_1 flags.
    ///
    /// # Errors
    /// [`OperatorError::Dimension`] if the map is not a 2-map.
    pub fn arcs(&self) -> Result<Vec<(SimplexId, SimplexId, usize)>, OperatorError> {
        if self.dim != 2 {
            return Err(OperatorError::Dimension(self.dim));
        }
        let pairs = |dart| [(self.c(0, dart), self.c(1, dart)), (self.c(1, dart), self.c(2, dart))];
        let mut flags: Vec<(u32, u32)> = self.dart_numbers().flat_map(pairs).collect();
        flags.sort_unstable();
        let arc = |same: &[(u32, u32)]| {
            let [p, q] = [same[0].0, same[0].1].map(|cell| SimplexId::new(cell as usize));
            (p, q, same.len())
        };
        Ok(flags.chunk_by(|a, b| a == b).map(arc).collect())
    }

    /// The dart of an edge whose cell of dimension `dim` is `cell`, and its other dart, whose cell is another.
    fn side(&self, edge: SimplexId, cell: SimplexId, dim: Dim) -> Result<(u32, u32), OperatorError> {
        if self.dim != 2 {
            return Err(OperatorError::Dimension(self.dim));
        }
        let not_an_edge = OperatorError::NotAnEdge(edge);
        let dart = self.dart_of(edge).filter(|_| self.dim_of(edge) == Some(1)).ok_or(not_an_edge)?.0;
        let twin = self.b(2, dart);
        let is_it = |dart| self.c(dim, dart) as usize == cell.index();
        match (is_it(dart), is_it(twin)) {
            (true, false) => Ok((dart, twin)),
            (false, true) => Ok((twin, dart)),
            (true, true) => Err(OperatorError::Twice { edge, cell }),
            (false, false) => Err(OperatorError::NotIncident { edge, cell }),
        }
    }

    /// β1⁻¹ in a 2-map: the last dart of a walk around the face.
    fn before(&self, dart: u32, walk: &mut Walk) -> u32 {
        self.walk_cell(dart, 2, walk);
        walk.orbit.last().copied().unwrap_or(dart)
    }

    /// Deletes the two darts of an edge, the edge, and a cell whose darts have been given away. The darts
    /// `stand_ins` stay, and stand for the vertices and faces that the two darts may have stood for.
    fn delete(&mut self, dart: u32, twin: u32, cell: SimplexId, stand_ins: [u32; 2]) {
        let edge = self.c(1, dart) as usize;
        for gone in [dart, twin] {
            let start = gone as usize * (2 * self.dim + 1);
            self.darts[start] = NONE;
        }
        self.num_darts -= 2;
        self.dart_of[edge] = NONE;
        self.dart_of[cell.index()] = NONE;
        self.num_cells[1] -= 1;
        let dim = self.dim_of(cell).unwrap_or(0);
        self.num_cells[dim] -= 1;
        for dart in stand_ins {
            for dim in [0, 2] {
                let cell = self.c(dim, dart) as usize;
                self.dart_of[cell] = dart;
            }
        }
    }

    fn set_beta(&mut self, i: Dim, dart: u32, image: u32) {
        self.darts[(2 * self.dim + 1) * dart as usize + i - 1] = image;
    }

    fn set_cell(&mut self, dim: Dim, dart: u32, cell: u32) {
        self.darts[(2 * self.dim + 1) * dart as usize + self.dim + dim] = cell;
    }
}
