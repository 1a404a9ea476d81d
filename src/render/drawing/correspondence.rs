//! Which subpath of one drawing's element becomes which of another's.
//!
//! - Elements with equally many subpaths, each with as many curves as its counterpart and closed as it is: in the order of the file.
//! - Others: the mesh carries all to the pose of the first drawing, where nearest ones of similar size become pairs, closed ones
//!   with closed ones and open ones with open ones. One that is left over shrinks to a point, its middle carried along, where it
//!   has no counterpart.
//!
//! Which point becomes which is the matter of module `alignment`.

use kurbo::CubicBez;

use super::alignment::aligned;
use super::binding::PoseMesh;
use super::strand::{Carriers, Strand};
use crate::input::{ArtElement, Subpath};
use crate::math::{Point, point};

/// The strands of an element that `carriers.meshes.len()` drawings have.
pub(super) fn corresponding(elements: &[&ArtElement], carriers: &Carriers) -> Vec<Strand> {
    slots(elements, &carriers.meshes)
        .into_iter()
        .filter_map(|slot| strand(elements, &slot, carriers))
        .collect()
}

/// For each drawing, which of its subpaths it is.
type Slot = Vec<Option<usize>>;

fn slots(elements: &[&ArtElement], meshes: &[&PoseMesh]) -> Vec<Slot> {
    let Some(first) = elements.first() else {
        return Vec::new();
    };
    let is_alike = |element: &&&ArtElement| {
        element.subpaths.len() == first.subpaths.len()
            && element
                .subpaths
                .iter()
                .zip(&first.subpaths)
                .all(|(a, b)| a.is_closed == b.is_closed && a.cubics.len() == b.cubics.len())
    };
    if elements.iter().skip(1).all(|element| is_alike(&element)) {
        return (0..first.subpaths.len())
            .map(|k| vec![Some(k); elements.len()])
            .collect();
    }
    let common = meshes[0].positions();
    let places: Vec<Vec<Place>> = elements
        .iter()
        .zip(meshes)
        .map(|(element, mesh)| {
            let place = |subpath| Place::of(subpath, mesh, common);
            element.subpaths.iter().map(place).collect()
        })
        .collect();
    let mut slots: Vec<Slot> = Vec::new();
    let mut place_of: Vec<Place> = Vec::new();
    for (drawing, own) in places.iter().enumerate() {
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        for (slot, known) in place_of.iter().enumerate() {
            for (k, place) in own.iter().enumerate() {
                if known.is_closed == place.is_closed {
                    pairs.push((known.distance(place), slot, k));
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut is_taken = vec![false; own.len()];
        for (_, slot, k) in pairs {
            if slots[slot][drawing].is_none() && !is_taken[k] {
                slots[slot][drawing] = Some(k);
                is_taken[k] = true;
            }
        }
        for (k, place) in own.iter().enumerate().filter(|(k, _)| !is_taken[*k]) {
            let mut slot = vec![None; elements.len()];
            slot[drawing] = Some(k);
            slots.push(slot);
            place_of.push(*place);
        }
    }
    slots
}

/// Where a subpath is, carried to a pose that all share.
#[derive(Debug, Clone, Copy)]
struct Place {
    middle: Point,
    size: f64,
    is_closed: bool,
}

impl Place {
    fn of(subpath: &Subpath, mesh: &PoseMesh, common: &[Point]) -> Self {
        let carried: Vec<Point> = subpath.points().map(|p| mesh.bind_here(*p).at(common)).collect();
        Self {
            middle: middle(&carried),
            size: point::diagonal(&carried),
            is_closed: subpath.is_closed,
        }
    }

    fn distance(&self, other: &Self) -> f64 {
        (self.middle - other.middle).norm() + (self.size - other.size).abs()
    }
}

fn middle(points: &[Point]) -> Point {
    point::bounding_box(points).map_or(Point::zeros(), |(low, high)| (low + high) * 0.5)
}

fn strand(elements: &[&ArtElement], slot: &Slot, carriers: &Carriers) -> Option<Strand> {
    let present: Vec<(usize, &Subpath)> = slot
        .iter()
        .enumerate()
        .filter_map(|(drawing, k)| k.map(|k| (drawing, &elements[drawing].subpaths[k])))
        .collect();
    let &(owner, subpath) = present.first()?;
    let of_each: Vec<Vec<CubicBez>> = present.iter().map(|(_, subpath)| cubics(subpath)).collect();
    let meshes: Vec<&PoseMesh> = present.iter().map(|(drawing, _)| carriers.meshes[*drawing]).collect();
    let curves = aligned(of_each, &meshes, subpath.is_closed);
    // Where it is not, it is as in the first drawing that has it, until it is shrunk.
    let column = |drawing: usize| present.iter().position(|(own, _)| *own == drawing);
    let columns: Vec<Option<usize>> = (0..elements.len()).map(column).collect();
    let all: Vec<Vec<CubicBez>> = curves
        .into_iter()
        .map(|row| columns.iter().map(|column| row[column.unwrap_or(0)]).collect())
        .collect();
    let all_carriers = Carriers {
        meshes: columns
            .iter()
            .enumerate()
            .map(|(drawing, column)| carriers.meshes[column.map_or(owner, |_| drawing)])
            .collect(),
        ..*carriers
    };
    let mut strand = Strand::new(&all, subpath.is_closed, &all_carriers);
    let points: Vec<Point> = subpath.points().copied().collect();
    let place = carriers.meshes[owner].bind_here(middle(&points));
    for (drawing, _) in columns.iter().enumerate().filter(|(_, column)| column.is_none()) {
        strand.shrink(drawing, place);
    }
    Some(strand)
}

fn cubics(subpath: &Subpath) -> Vec<CubicBez> {
    let p = |p: Point| kurbo::Point::new(p.x, p.y);
    let mut from = subpath.start;
    subpath
        .cubics
        .iter()
        .map(|&[a, b, c]| {
            let cubic = CubicBez::new(p(from), p(a), p(b), p(c));
            from = c;
            cubic
        })
        .collect()
}
