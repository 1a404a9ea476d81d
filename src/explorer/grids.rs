//! What weights and shapes are like over the plane.

use inbetween::mesh::geometry;
use inbetween::pipeline::{LayerShape, Posed};
use inbetween::scene::Workbench;
use rayon::prelude::*;

use super::frames::{asked_provider, numbers};
use super::http::{Request, Response};
use super::model::Shown;
use super::problem::{Problem, Refusal, Where};
use super::session::Session;
use super::wire::Words;

/// Cells along a side of a grid of weights.
const MOST_CELLS: usize = 512;
/// Cells along a side of a grid of shapes, each of which is a frame.
const MOST_FRAMES: usize = 128;

/// Places in a plane.
struct Grid {
    columns: usize,
    rows: usize,
    /// Two coordinates each, row by row.
    places: Vec<f64>,
}

fn grid(request: &Request, shown: &Shown, standard: usize, most: usize) -> Result<Grid, Refusal> {
    if shown.framed_scene()?.dimension() != 2 {
        return Err(Refusal::conflict(Problem::at("only a plane has maps", Where::Space)));
    }
    let count = |name: &str| match request.value(name) {
        None => Ok(standard),
        Some(text) => {
            let count = text.parse().ok().filter(|count| (1..=most).contains(count));
            count.ok_or_else(|| Refusal::bad(format!("`{name}` must be a number from 1 to {most}")))
        }
    };
    let (columns, rows) = (count("columns")?, count("rows")?);
    let corners = numbers(request.value("box").unwrap_or_default())?;
    let [left, top, right, bottom] = corners[..] else {
        return Err(Refusal::bad("say where: box=X0,Y0,X1,Y1"));
    };
    // As `inbetween weights --grid` has it.
    let along = |from: f64, to: f64, k: usize, count: usize| from + (to - from) * (k as f64 + 0.5) / count as f64;
    let cell = |i: usize| {
        [
            along(left, right, i % columns, columns),
            along(top, bottom, i / columns, rows),
        ]
    };
    Ok(Grid {
        columns,
        rows,
        places: (0..columns * rows).flat_map(cell).collect(),
    })
}

/// `GET api/grid`.
pub(super) fn weights(request: &Request, session: &Session) -> Result<Response, Refusal> {
    let shown = session.shown();
    let grid = grid(request, &shown, 64, MOST_CELLS)?;
    let provider = shown.provider(asked_provider(request)?)?;
    let mut weights = Vec::new();
    provider
        .weights_of_many(&grid.places, &mut weights)
        .map_err(Refusal::bad)?;
    let mut bytes = Vec::with_capacity(4 * (weights.len() + 3));
    let mut words = Words(&mut bytes);
    words.u32(grid.columns);
    words.u32(grid.rows);
    words.u32(provider.pose_count());
    words.f32s(&weights);
    Ok(Response::binary(bytes))
}

/// `GET api/validity`.
pub(super) fn validity(request: &Request, session: &Session) -> Result<Response, Refusal> {
    let shown = session.shown();
    let bench = shown.bench()?;
    let grid = grid(request, &shown, 32, MOST_FRAMES)?;
    let provider = shown.provider(asked_provider(request)?)?;
    let cell = |place: &[f64]| -> Result<(usize, [f64; 2]), Refusal> {
        let weights = provider.weights_at(place).map_err(Refusal::bad)?;
        let posed = bench.posed(&weights, None)?;
        Ok((posed.flipped(), stretch(bench, &posed)))
    };
    let cells: Vec<_> = grid.places.par_chunks_exact(2).map(cell).collect();
    let mut bytes = Vec::new();
    let mut words = Words(&mut bytes);
    words.u32(grid.columns);
    words.u32(grid.rows);
    for cell in cells {
        let (flipped, stretches) = cell?;
        words.u32(flipped);
        words.f32s(&stretches);
    }
    Ok(Response::binary(bytes))
}

/// The largest stretch of a triangle from the pose that it is most like, and what 95 % of them stay below; over the layers that
/// are seen.
fn stretch(bench: &Workbench, posed: &Posed) -> [f64; 2] {
    let mut all = Vec::new();
    for (shape, layer) in bench.layers().iter().zip(&posed.layers) {
        if layer.opacity > 0.0 {
            all.extend(stretches(shape, &layer.positions));
        }
    }
    let largest = all.iter().copied().fold(1.0, f64::max);
    let most = all.len() * 95 / 100;
    if most >= all.len() {
        return [1.0, 1.0];
    }
    [largest, *all.select_nth_unstable_by(most, f64::total_cmp).1]
}

fn stretches(shape: &LayerShape, positions: &[inbetween::math::Point]) -> Vec<f64> {
    let poses = &shape.mapping().poses;
    let from_nearest = |triangle: &[usize; 3]| {
        let here = geometry::corners(positions, *triangle);
        let from = |rest: &Vec<_>| geometry::stretch(geometry::corners(rest, *triangle), here);
        poses.positions().iter().map(from).fold(f64::INFINITY, f64::min)
    };
    poses.topology().triangles().iter().map(from_nearest).collect()
}
