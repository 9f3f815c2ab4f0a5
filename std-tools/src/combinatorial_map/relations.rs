//! Boundary, co-boundary and adjacency over the darts, of cells of maps of any kind.

use sig_core::{Dim, SimplexId};

use super::{CombinatorialMap, Walk};

impl CombinatorialMap {
    /// B_{p,q}: the cells of dimension q < p in the boundary of a p-cell, each once, in no particular order; none for other q,
    /// and for a cell that is deleted or past the end.
    ///
    /// Cost: O(p) for each dart of the cell with the same cells above it; (p + 1)!/2 of them for a simplex.
    pub fn boundary<'w>(&self, cell: SimplexId, q: Dim, walk: &'w mut Walk) -> &'w [SimplexId] {
        walk.start();
        if let (Some(dart), Some(p)) = (self.dart_of(cell), self.dim_of(cell))
            && q < p
        {
            self.add_boundary(dart.0, p, q, walk);
        }
        walk.finish()
    }

    /// Adds the cells of dimension q in the boundary of the p-cell of a dart.
    fn add_boundary(&self, dart: u32, p: Dim, q: Dim, walk: &mut Walk) {
        self.walk_boundary(dart, p, walk);
        for at in 0..walk.orbit.len() {
            walk.add(self.c(q, walk.orbit[at]));
        }
        // An edge has one dart of each orientation, and each knows one end.
        if p == 1 {
            walk.add(self.c(0, self.b(1, dart)));
        }
    }

    /// C_{p,q}: the cells of dimension q > p whose boundary contains a p-cell, each once, in no particular order; none for
    /// other q, and for a cell that is deleted or past the end.
    ///
    /// Cost: O(n) for each dart of the p-cell.
    pub fn coboundary<'w>(&self, cell: SimplexId, q: Dim, walk: &'w mut Walk) -> &'w [SimplexId] {
        walk.start();
        if let (Some(dart), Some(p)) = (self.dart_of(cell), self.dim_of(cell))
            && (p + 1..=self.dim).contains(&q)
        {
            self.walk_cell(dart.0, p, walk);
            for at in 0..walk.orbit.len() {
                walk.add(self.c(q, walk.orbit[at]));
            }
        }
        walk.finish()
    }

    /// A p-cell and all cells whose boundary contains it, each once, in no particular order; none for a cell that is deleted
    /// or past the end.
    ///
    /// Cost: O(n) for each dart of the cell.
    pub fn star<'w>(&self, cell: SimplexId, walk: &'w mut Walk) -> &'w [SimplexId] {
        walk.start();
        if let (Some(dart), Some(p)) = (self.dart_of(cell), self.dim_of(cell)) {
            self.walk_cell(dart.0, p, walk);
            for at in 0..walk.orbit.len() {
                (p..=self.dim).for_each(|q| walk.add(self.c(q, walk.orbit[at])));
            }
        }
        walk.finish()
    }

    /// The cells without a vertex of a cell in the boundaries of the n-cells around it, each once, in no particular order: the
    /// link, in a map that is a simplicial complex. None for a cell that is deleted or past the end.
    ///
    /// Cost: O(n) for each dart of the n-cells around the cell.
    pub fn link<'w>(&self, cell: SimplexId, walk: &'w mut Walk) -> &'w [SimplexId] {
        let n = self.dim;
        let (Some(dart), Some(p)) = (self.dart_of(cell), self.dim_of(cell)) else { return &[] };
        walk.own.clear();
        walk.own.push(self.c(0, dart.0));
        if p > 0 {
            self.boundary(cell, 0, walk);
            walk.own.clear();
            walk.own.extend(walk.found.iter().map(|vertex| self.c(0, self.dart_of[vertex.index()])));
        }
        self.coboundary(cell, n, walk);
        let (mut tops, own) = (std::mem::take(&mut walk.starts), std::mem::take(&mut walk.own));
        tops.clear();
        tops.extend(walk.found.iter().map(|top| self.dart_of[top.index()]));
        let is_own = |dart: u32| own.contains(&self.c(0, dart));
        walk.start();
        for &top in &tops {
            self.walk_boundary(top, n, walk);
            // A cell in the boundary of an n-cell has a dart there for each of its vertices; but of an edge of a face of a
            // 2-map there is one only, and the other end is that of the next.
            for at in 0..walk.orbit.len() {
                let dart = walk.orbit[at];
                if is_own(dart) {
                    (0..n).for_each(|q| walk.pass_over(self.c(q, dart)));
                }
                if is_own(self.b(1, dart)) {
                    walk.pass_over(self.c(1, dart));
                }
            }
            for at in 0..walk.orbit.len() {
                (0..n).for_each(|q| walk.add(self.c(q, walk.orbit[at])));
            }
        }
        (walk.starts, walk.own) = (tops, own);
        walk.finish()
    }

    /// A_p: for p > 0 the other p-cells that share a (p−1)-cell of their boundaries with a p-cell; for p = 0 the other ends of
    /// the edges at it. Each once, in no particular order; none for a cell that is deleted or past the end.
    ///
    /// Cost: for p = n, O(n) for each dart of the cell, which knows its neighbour; else that of the co-boundaries of all facets
    /// of the cell, or of the vertex.
    pub fn adjacency<'w>(&self, cell: SimplexId, walk: &'w mut Walk) -> &'w [SimplexId] {
        walk.start();
        let (Some(dart), Some(p)) = (self.dart_of(cell), self.dim_of(cell)) else { return walk.finish() };
        walk.pass_over(self.c(p, dart.0));
        match p {
            0 => {
                self.walk_cell(dart.0, 0, walk);
                for at in 0..walk.orbit.len() {
                    walk.add(self.c(0, self.b(1, walk.orbit[at])));
                }
            }
            _ if p == self.dim => {
                self.walk_cell(dart.0, p, walk);
                for at in 0..walk.orbit.len() {
                    walk.add(self.c(p, self.b(p, walk.orbit[at])));
                }
            }
            _ => self.add_adjacent(dart.0, p, walk),
        }
        walk.finish()
    }

    /// Adds the p-cells around the facets of a p-cell, 0 < p < n.
    fn add_adjacent(&self, dart: u32, p: Dim, walk: &mut Walk) {
        // One dart of each facet: they are few, and the walks around them need the orbit's memory.
        let mut facets = std::mem::take(&mut walk.starts);
        facets.clear();
        self.walk_boundary(dart, p, walk);
        let ends = (p == 1).then(|| self.b(1, dart));
        for &at in walk.orbit.iter().chain(&ends) {
            if !facets.iter().any(|&other| self.c(p - 1, other) == self.c(p - 1, at)) {
                facets.push(at);
            }
        }
        for &facet in &facets {
            self.walk_cell(facet, p - 1, walk);
            for at in 0..walk.orbit.len() {
                walk.add(self.c(p, walk.orbit[at]));
            }
        }
        walk.starts = facets;
    }
}
