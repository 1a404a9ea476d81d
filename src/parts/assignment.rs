//! The assignment problem: rows to columns, one each, at the least sum of costs.
//!
//! Kuhn's Hungarian method in its form by shortest augmenting paths with potentials (Jonker and Volgenant 1987): rows are
//! added one by one, and for each the cheapest chain of reassignments is found by Dijkstra's algorithm on reduced costs, which
//! the potentials keep from being negative. O(rows^2 x columns).

/// For each row the column that it is assigned to; `costs` has #rows x #columns finite entries, and at least as many columns as rows.
///
/// Equal sums go to the lower columns of the first rows.
#[must_use]
pub(crate) fn assign(costs: &[Vec<f64>]) -> Vec<usize> {
    let columns = costs.first().map_or(0, Vec::len);
    // Column 0 is a place from which the row that is added starts; rows and columns are counted from 1.
    let mut row_potential = vec![0.0; costs.len() + 1];
    let mut column_potential = vec![0.0; columns + 1];
    let mut row_of = vec![0; columns + 1];
    for row in 1..=costs.len() {
        row_of[0] = row;
        let mut least = vec![f64::INFINITY; columns + 1];
        let mut before = vec![0; columns + 1];
        let mut is_done = vec![false; columns + 1];
        let mut at = 0;
        while row_of[at] != 0 {
            is_done[at] = true;
            let own = row_of[at];
            let (mut step, mut next) = (f64::INFINITY, 0);
            for column in 1..=columns {
                if is_done[column] {
                    continue;
                }
                let reduced = costs[own - 1][column - 1] - row_potential[own] - column_potential[column];
                if reduced < least[column] {
                    (least[column], before[column]) = (reduced, at);
                }
                if least[column] < step {
                    (step, next) = (least[column], column);
                }
            }
            if next == 0 {
                // Fewer columns than rows: the last rows get none, which the caller's table excludes.
                break;
            }
            for column in 0..=columns {
                if is_done[column] {
                    row_potential[row_of[column]] += step;
                    column_potential[column] -= step;
                } else {
                    least[column] -= step;
                }
            }
            at = next;
        }
        while at != 0 {
            row_of[at] = row_of[before[at]];
            at = before[at];
        }
    }
    let mut assigned = vec![0; costs.len()];
    for (column, row) in row_of.iter().enumerate().skip(1) {
        if let Some(place) = row.checked_sub(1).and_then(|row| assigned.get_mut(row)) {
            *place = column - 1;
        }
    }
    assigned
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_greedy_choice_is_not_taken_where_it_costs_more_in_the_end() {
        // The least entry of all is 1, but then the other row pays 9.
        assert_eq!(assign(&[vec![1.0, 2.0], vec![2.0, 9.0]]), [1, 0]);
        assert_eq!(assign(&[vec![3.0, 1.0, 2.0]]), [1]);
        assert_eq!(assign(&[]), Vec::<usize>::new());
    }

    fn sum(costs: &[Vec<f64>], columns: &[usize]) -> f64 {
        costs.iter().zip(columns).map(|(row, column)| row[*column]).sum()
    }

    /// The least sum over all ways, by trying them.
    fn least(costs: &[Vec<f64>], taken: &mut Vec<usize>) -> f64 {
        let Some(row) = costs.get(taken.len()) else {
            return sum(costs, taken);
        };
        let mut best = f64::INFINITY;
        for column in 0..row.len() {
            if !taken.contains(&column) {
                taken.push(column);
                best = best.min(least(costs, taken));
                taken.pop();
            }
        }
        best
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn no_other_assignment_costs_less(
            rows in 1..5_usize,
            more in 0..2_usize,
            values in prop::collection::vec(0..20_u8, 30),
        ) {
            let columns = rows + more;
            let costs: Vec<Vec<f64>> = (0..rows)
                .map(|row| values[row * columns..(row + 1) * columns].iter().map(|v| f64::from(*v)).collect())
                .collect();
            let found = assign(&costs);
            let mut distinct = found.clone();
            distinct.sort_unstable();
            distinct.dedup();
            prop_assert_eq!(distinct.len(), rows);
            prop_assert_eq!(sum(&costs, &found), least(&costs, &mut Vec::new()));
        }
    }
}
