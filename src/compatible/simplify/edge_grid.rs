//! A uniform grid over the edges of one pose, updated as edges come and go.

use crate::math::Point;

/// Edges by the grid cells that their boxes touch. An edge is named by a number of the caller's.
#[derive(Debug)]
pub(super) struct EdgeGrid {
    low: Point,
    cells_per_unit: f64,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<usize>>,
}

impl EdgeGrid {
    /// A grid over the box `low..high` with about as many cells as `edge_count`. Points outside the box count to the
    /// cells at its rim.
    pub(super) fn new(low: Point, high: Point, edge_count: usize) -> Self {
        let size = high - low;
        let cell = ((size.x * size.y).max(0.0) / edge_count.max(1) as f64)
            .sqrt()
            .max(size.max() / 256.0);
        let cells_per_unit = if cell > 0.0 { 1.0 / cell } else { 1.0 };
        let count = |extent: f64| ((extent * cells_per_unit) as usize + 1).min(512);
        let (columns, rows) = (count(size.x), count(size.y));
        Self {
            low,
            cells_per_unit,
            columns,
            rows,
            cells: vec![Vec::new(); columns * rows],
        }
    }

    pub(super) fn insert(&mut self, edge: usize, a: Point, b: Point) {
        for cell in self.cells_of(a, b) {
            self.cells[cell].push(edge);
        }
    }

    pub(super) fn remove(&mut self, edge: usize, a: Point, b: Point) {
        for cell in self.cells_of(a, b) {
            if let Some(place) = self.cells[cell].iter().position(|&e| e == edge) {
                self.cells[cell].swap_remove(place);
            }
        }
    }

    /// Whether any edge whose box shares a cell with the box of `a` and `b` satisfies `hit`. An edge may be asked
    /// about more than once.
    pub(super) fn any_near(&self, a: Point, b: Point, mut hit: impl FnMut(usize) -> bool) -> bool {
        self.cells_of(a, b)
            .any(|cell| self.cells[cell].iter().any(|&edge| hit(edge)))
    }

    fn cells_of(&self, a: Point, b: Point) -> impl Iterator<Item = usize> + use<> {
        let (low, high) = (a.inf(&b), a.sup(&b));
        let column = |x: f64| (((x - self.low.x) * self.cells_per_unit).max(0.0) as usize).min(self.columns - 1);
        let row = |y: f64| (((y - self.low.y) * self.cells_per_unit).max(0.0) as usize).min(self.rows - 1);
        let (columns, rows, stride) = (column(low.x)..=column(high.x), row(low.y)..=row(high.y), self.columns);
        rows.flat_map(move |j| columns.clone().map(move |i| j * stride + i))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_found_until_removed() {
        let mut grid = EdgeGrid::new(Point::new(0.0, 0.0), Point::new(10.0, 10.0), 16);
        let (a, b) = (Point::new(1.0, 1.0), Point::new(9.0, 2.0));
        grid.insert(7, a, b);
        assert!(grid.any_near(Point::new(5.0, 1.5), Point::new(5.0, 1.5), |e| e == 7));
        assert!(!grid.any_near(Point::new(5.0, 9.0), Point::new(6.0, 9.5), |_| true));
        // Far outside the box: the rim cells answer.
        grid.insert(8, Point::new(-50.0, 5.0), Point::new(-40.0, 5.0));
        assert!(grid.any_near(Point::new(-90.0, 5.0), Point::new(-80.0, 5.0), |e| e == 8));
        grid.remove(7, a, b);
        assert!(!grid.any_near(a, b, |e| e == 7));
    }
}
