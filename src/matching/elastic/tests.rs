use std::f64::consts::TAU;

use super::*;
use crate::matching::curve::{Curve, Samples};
use crate::matching::start::cheapest_paths;
use crate::math::{Point, rotation};
use crate::outline::Ring;

fn wavy(amplitude: f64, turn: f64) -> Curve {
    let ring = Ring::new((0..180).map(|k| {
        let t = TAU * k as f64 / 180.0;
        rotation(t + turn) * Point::new(1.0 + 0.2 * (2.0 * t + 1.0).sin() + amplitude * (5.0 * t).cos(), 0.0)
    }));
    Curve::new(&ring.expect("a ring")).expect("a curve")
}

fn even(count: usize) -> Vec<f64> {
    (0..count).map(|k| k as f64 / count as f64).collect()
}

fn compared(first: &Curve, rows: Vec<f64>, second: &Curve, columns: Vec<f64>) -> MismatchTable {
    let first = Samples::fine(first, rows.clone());
    MismatchTable::new(rows, &[first], Samples::fine(second, columns))
}

fn table(count: usize) -> MismatchTable {
    compared(&wavy(0.1, 0.0), even(count), &wavy(0.15, 1.0), even(count))
}

/// The definition, by recursion over all nodes: the cost of the cheapest way from `(0, start)` to each node.
fn naive_cost(table: &MismatchTable, start: usize) -> f32 {
    let (rows, columns) = (table.row_count(), table.column_count());
    let mut cost = vec![vec![f32::INFINITY; start + columns + 1]; rows + 1];
    cost[0][start] = 0.0;
    for i in 1..=rows {
        for j in start..=start + columns {
            for (a, b) in STEPS {
                if a > i || start + b > j {
                    continue;
                }
                let divisions = a.max(b);
                let mismatch: f32 = (0..divisions)
                    .map(|inner| (i - inner * a / divisions, j - inner * b / divisions))
                    .map(|(row, column)| table.mismatches(row, column..column + 1)[0])
                    .sum();
                let ds1 = table.row_parameter(i) - table.row_parameter(i - a);
                let ds2 = table.column_parameter(j) - table.column_parameter(j - b);
                let step = step_cost(f64::from(mismatch / divisions as f32 / TURNING_COST), ds1, ds2) as f32;
                cost[i][j] = cost[i][j].min(cost[i - a][j - b] + step);
            }
        }
    }
    cost[rows][start + columns]
}

#[test]
fn the_cheapest_path_is_that_of_the_definition() {
    let table = table(24);
    for start in [0, 5, 23] {
        let path = cheapest_path(&table, start, &table.reachable(start)).expect("a path");
        assert!((path.cost - naive_cost(&table, start)).abs() < 1e-5);
        assert_eq!(path.nodes.first(), Some(&(0, start)));
        assert_eq!(path.nodes.last(), Some(&(24, start + 24)));
        for pair in path.nodes.windows(2) {
            assert!(STEPS.contains(&(pair[1].0 - pair[0].0, pair[1].1 - pair[0].1)));
        }
    }
}

#[test]
fn a_curve_matches_itself_along_the_diagonal() {
    let curve = wavy(0.1, 0.0);
    let table = compared(&curve, even(32), &curve, even(32));
    let path = cheapest_path(&table, 0, &table.reachable(0)).expect("a path");
    assert_eq!(path.cost, 0.0);
    assert!(path.nodes.iter().all(|(i, j)| i == j));
}

#[test]
fn paths_go_through_forced_rows() {
    let columns: Vec<f64> = (0..32)
        .map(|k| {
            if k < 8 {
                k as f64 / 80.0
            } else {
                0.1 + (k - 8) as f64 * 0.0375
            }
        })
        .collect();
    let (first, second) = (wavy(0.1, 0.0), wavy(0.15, 0.0));
    let sampled = || {
        (
            even(32),
            [Samples::fine(&first, even(32))],
            Samples::fine(&second, columns.clone()),
        )
    };
    let targets: Vec<Point> = (0..32).map(|k| second.at(k as f64 / 31.0)).collect();
    for forced in [vec![], vec![8], vec![3, 8, 9, 21]] {
        let (rows, curves, other) = sampled();
        let pinned = MismatchTable::pinned(rows, &curves, other, forced.clone());
        let path = cheapest_path(&pinned, 0, &pinned.reachable(0)).expect("a path");
        assert!(forced.iter().all(|&k| path.nodes.contains(&(k, k))));
        // What is not compared makes no difference.
        let (rows, curves, other) = sampled();
        let mut whole = MismatchTable::new(rows, &curves, other);
        whole.forced = forced;
        assert_eq!(cheapest_path(&whole, 0, &whole.reachable(0)), Some(path));
        let drawn = [pinned, whole].map(|table| {
            let table = table.drawn_to(&targets, &second, 3.0);
            cheapest_path(&table, 0, &table.reachable(0)).expect("a path")
        });
        assert_eq!(drawn[0], drawn[1]);
    }
}

#[test]
fn dividing_the_starts_finds_the_best_of_all() {
    let table = table(48);
    let exhaustive = (0..48)
        .filter_map(|start| cheapest_path(&table, start, &table.reachable(start)))
        .map(|path| path.cost)
        .fold(f32::INFINITY, f32::min);
    let best = cheapest_paths(&table, 2, 3);
    assert!((best[0].cost - exhaustive).abs() < 1e-6);
    assert!(best.windows(2).all(|pair| pair[0].cost <= pair[1].cost));
}

#[test]
fn the_cheapest_start_is_that_of_the_cheapest_path() {
    let uneven = (0..24).map(|k| (k as f64 / 24.0).powf(1.2)).collect();
    for columns in [even(24), uneven] {
        let table = compared(&wavy(0.1, 0.0), even(24), &wavy(0.15, 1.0), columns);
        for (first, last, reach) in [(0_usize, 4_usize, 3_usize), (9, 31, 20), (20, 23, 6)] {
            // A straight band about the middle start: it holds some paths from some of the starts.
            let middle = (first + last) / 2;
            let band: Vec<_> = (0..=24)
                .map(|i| ((middle + i).saturating_sub(reach), middle + i + reach))
                .collect();
            let paths = (first..=last).filter_map(|start| Some((start, cheapest_path(&table, start, &band)?.cost)));
            let best = paths.reduce(|a, b| if b.1 < a.1 { b } else { a });
            assert_eq!(
                cheapest_start(&table, first..=last, &band),
                best.map(|(start, _)| start)
            );
            assert!(best.is_some());
        }
    }
}
