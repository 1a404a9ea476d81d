//! Which parts of the poses are one thing.

use super::assignment::assign;
use super::{MOST_PARTS, PartShape};
use crate::math::Point;

/// What it costs to leave a part without a counterpart: half of what a pair may cost. A part that moves by the figure's own size and
/// changes nothing else is still the same.
const ALONE: f64 = 1.5;
/// Cost of a place that differs by the root of the figure's area.
const PLACE: f64 = 1.0;
/// Cost of an area that differs by a factor of e.
const SIZE: f64 = 0.7;
/// Cost of colours as unlike as black and white.
const COLOUR: f64 = 1.6;
/// Cost of an elongation that differs by a factor of e.
const ELONGATION: f64 = 0.4;
/// Cost, or gain, of a landmark that only one, or both, of two parts have: it decides.
const LANDMARK: f64 = 100.0;
/// A part with a smaller share of the figure's area is a small one: a thing if another pose has it, too, otherwise dust.
const SMALL: f64 = 2e-3;
/// More small parts than this in one drawing are dust, whatever they look like.
const MOST_SMALL: usize = 12;
/// What a pair of small parts may cost: dust finds a counterpart by chance.
const SMALL_PAIR: f64 = 0.5;
/// What the place of one may cost, however much sizes differ: a spark grows, and dust seldom lies where other dust lay.
const SMALL_PLACE: f64 = 0.2;

/// Which parts of the poses are one thing.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PartGroups {
    /// For each thing the part that it is in each pose, by index; the thing with the largest area over all poses first.
    pub things: Vec<Vec<Option<usize>>>,
    /// For each pose the parts that are none.
    pub dust: Vec<Vec<usize>>,
}

/// Groups the parts of all poses, #poses lists. `is_kept` says which parts (pose, part) are things whatever their size.
#[must_use]
pub(crate) fn group(poses: &[Vec<PartShape>], is_kept: &dyn Fn(usize, usize) -> bool) -> PartGroups {
    let scales: Vec<Scale> = poses.iter().map(|parts| Scale::of(parts)).collect();
    let candidates: Vec<Vec<usize>> = (poses.iter().zip(&scales).enumerate())
        .map(|(pose, (parts, scale))| candidates(parts, scale, &|part| is_kept(pose, part)))
        .collect();
    let mut order: Vec<usize> = (0..poses.len()).collect();
    order.sort_by_key(|&pose| std::cmp::Reverse(candidates[pose].len()));
    let mut things: Vec<Vec<Option<usize>>> = Vec::new();
    for pose in order {
        let own: Vec<Relative> = candidates[pose]
            .iter()
            .map(|&part| scales[pose].relative(&poses[pose][part]))
            .collect();
        let known: Vec<Relative> = things.iter().map(|thing| mean(thing, poses, &scales)).collect();
        let counterparts = assigned(&own, &known);
        for (&part, counterpart) in candidates[pose].iter().zip(counterparts) {
            match counterpart {
                Some(thing) => things[thing][pose] = Some(part),
                None => {
                    let mut thing = vec![None; poses.len()];
                    thing[pose] = Some(part);
                    things.push(thing);
                }
            }
        }
    }
    let is_thing = |thing: &Vec<Option<usize>>| {
        let members: Vec<(usize, usize)> = (thing.iter().enumerate())
            .filter_map(|(pose, part)| Some((pose, (*part)?)))
            .collect();
        let is_small = |&(pose, part): &(usize, usize)| scales[pose].share(&poses[pose][part]) < SMALL;
        members
            .iter()
            .any(|member| !is_small(member) || is_kept(member.0, member.1))
            || members.len() > 1
    };
    things.retain(is_thing);
    let area = |thing: &Vec<Option<usize>>| -> f64 {
        let shares = thing.iter().enumerate();
        shares
            .filter_map(|(pose, part)| Some(scales[pose].share(&poses[pose][(*part)?])))
            .sum()
    };
    // Sorting is stable: equal ones stay in the order in which they were met.
    things.sort_by(|a, b| area(b).total_cmp(&area(a)));
    let dust = (0..poses.len()).map(|pose| {
        let is_taken = |part: &usize| things.iter().any(|thing| thing[pose] == Some(*part));
        (0..poses[pose].len()).filter(|part| !is_taken(part)).collect()
    });
    PartGroups {
        dust: dust.collect(),
        things,
    }
}

/// The parts of a drawing that may be things.
fn candidates(parts: &[PartShape], scale: &Scale, is_kept: &dyn Fn(usize) -> bool) -> Vec<usize> {
    let is_small = |part: &usize| scale.share(&parts[*part]) < SMALL;
    let is_crowd = (0..parts.len()).filter(is_small).count() > MOST_SMALL;
    let mut found: Vec<usize> = (0..parts.len())
        .filter(|part| is_kept(*part) || !is_crowd || !is_small(part))
        .collect();
    found.sort_by(|a, b| parts[*b].area.total_cmp(&parts[*a].area));
    found.truncate(MOST_PARTS);
    found
}

/// The place and size of a whole figure.
struct Scale {
    centre: Point,
    area: f64,
}

impl Scale {
    fn of(parts: &[PartShape]) -> Self {
        let area: f64 = parts.iter().map(|part| part.area).sum();
        let moment: Point = parts.iter().map(|part| part.centroid * part.area).sum();
        Self {
            centre: if area > 0.0 { moment / area } else { Point::zeros() },
            area: area.max(f64::MIN_POSITIVE),
        }
    }

    fn share(&self, part: &PartShape) -> f64 {
        part.area / self.area
    }

    fn relative(&self, part: &PartShape) -> Relative {
        Relative {
            place: (part.centroid - self.centre) / self.area.sqrt(),
            size: self.share(part).ln(),
            colour: part.colour,
            elongation: part.elongation,
            landmarks: part.landmarks.clone(),
            is_small: self.share(part) < SMALL,
        }
    }
}

/// A part relative to its figure.
struct Relative {
    place: Point,
    /// The logarithm of its share of the area.
    size: f64,
    colour: [f64; 4],
    elongation: f64,
    landmarks: Vec<usize>,
    is_small: bool,
}

/// The mean of a thing's parts.
fn mean(thing: &[Option<usize>], poses: &[Vec<PartShape>], scales: &[Scale]) -> Relative {
    let members: Vec<Relative> = (thing.iter().enumerate())
        .filter_map(|(pose, part)| Some(scales[pose].relative(&poses[pose][(*part)?])))
        .collect();
    let count = members.len().max(1) as f64;
    let sum = |value: &dyn Fn(&Relative) -> f64| -> f64 { members.iter().map(value).sum::<f64>() / count };
    Relative {
        place: members.iter().map(|member| member.place).sum::<Point>() / count,
        size: sum(&|member| member.size),
        colour: std::array::from_fn(|k| sum(&|member| member.colour[k])),
        elongation: sum(&|member| member.elongation),
        landmarks: members
            .iter()
            .flat_map(|member| member.landmarks.iter().copied())
            .collect(),
        is_small: members.iter().all(|member| member.is_small),
    }
}

fn cost(a: &Relative, b: &Relative) -> f64 {
    let colour: f64 = (a.colour.iter().zip(&b.colour))
        .map(|(a, b)| (a - b).abs())
        .sum::<f64>()
        / 4.0;
    let place = PLACE * (a.place - b.place).norm();
    let plain =
        place + SIZE * (a.size - b.size).abs() + COLOUR * colour + ELONGATION * (a.elongation - b.elongation).abs();
    let shared = a
        .landmarks
        .iter()
        .filter(|landmark| b.landmarks.contains(landmark))
        .count();
    let landmarks = -LANDMARK * shared as f64;
    if a.is_small && b.is_small && plain > SMALL_PAIR && place > SMALL_PLACE && shared == 0 {
        return 2.0 * ALONE + 1.0;
    }
    plain + landmarks
}

/// For each part the thing that it is, if it is one of those known. Of `#known + #own` columns the last ones stand for being a new thing.
fn assigned(own: &[Relative], known: &[Relative]) -> Vec<Option<usize>> {
    let costs: Vec<Vec<f64>> = own
        .iter()
        .map(|part| {
            let pairs = known.iter().map(|thing| cost(part, thing));
            pairs.chain(own.iter().map(|_| 2.0 * ALONE)).collect()
        })
        .collect();
    let columns = assign(&costs).into_iter();
    columns.map(|column| (column < known.len()).then_some(column)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(x: f64, y: f64, area: f64, colour: [f64; 3]) -> PartShape {
        let half = Point::repeat(0.5 * area.sqrt());
        let centroid = Point::new(x, y);
        PartShape {
            area,
            centroid,
            bounds: [centroid - half, centroid + half],
            colour: [colour[0], colour[1], colour[2], 1.0],
            elongation: 0.0,
            landmarks: vec![],
        }
    }

    const INK: [f64; 3] = [0.1, 0.1, 0.3];
    const RED: [f64; 3] = [0.9, 0.1, 0.1];

    fn grouped(poses: &[Vec<PartShape>]) -> PartGroups {
        group(poses, &|_, _| false)
    }

    #[test]
    fn a_dot_that_passes_its_stem_stays_a_dot() {
        let dot = |y| part(200.0, y, 3800.0, INK);
        let stem = |y| PartShape {
            elongation: 1.4,
            ..part(200.0, y, 13000.0, INK)
        };
        let groups = grouped(&[vec![dot(80.0), stem(250.0)], vec![stem(150.0), dot(330.0)]]);
        assert_eq!(groups.things, [[Some(1), Some(0)], [Some(0), Some(1)]]);
    }

    #[test]
    fn one_drop_becomes_three_and_two_are_new() {
        let drop = |x, area| part(x, 200.0, area, RED);
        let groups = grouped(&[
            vec![drop(200.0, 38000.0)],
            vec![drop(90.0, 11000.0), drop(200.0, 11000.0), drop(310.0, 11000.0)],
        ]);
        assert_eq!(groups.things[0], [Some(0), Some(1)]);
        assert_eq!(groups.things.len(), 3);
        assert!(groups.things[1..].iter().all(|thing| thing[0].is_none()));
    }

    #[test]
    fn alike_parts_go_by_their_places() {
        let eyebrow = |x, y| part(x, y, 300.0, INK);
        let head = |x| part(x, 100.0, 30000.0, RED);
        let groups = grouped(&[
            vec![head(100.0), eyebrow(70.0, 0.0), eyebrow(130.0, 0.0)],
            vec![eyebrow(635.0, -20.0), head(600.0), eyebrow(575.0, -5.0)],
            vec![head(0.0)],
        ]);
        assert_eq!(groups.things[0], [Some(0), Some(1), Some(0)]);
        assert!(groups.things[1..].contains(&vec![Some(1), Some(2), None]));
        assert!(groups.things[1..].contains(&vec![Some(2), Some(0), None]));
        assert!(groups.dust.iter().all(Vec::is_empty));
    }

    #[test]
    fn a_landmark_settles_what_looks_otherwise() {
        let with = |landmark, part: PartShape| PartShape {
            landmarks: vec![landmark],
            ..part
        };
        let ball = |x| part(x, 0.0, 1000.0, RED);
        let body = || part(100.0, 100.0, 9000.0, INK);
        let groups = grouped(&[
            vec![body(), with(0, ball(0.0)), ball(200.0)],
            vec![body(), ball(0.0), with(0, ball(200.0))],
        ]);
        assert!(groups.things.contains(&vec![Some(1), Some(2)]));
    }

    #[test]
    fn specks_in_one_drawing_and_crowds_of_them_are_dust() {
        let body = || part(100.0, 100.0, 35000.0, INK);
        let speck = |k: usize| part(10.0 * k as f64, 37.0 * (k % 7) as f64, 21.0, INK);
        let few = grouped(&[vec![body(), speck(1)], vec![body(), speck(30)]]);
        assert_eq!((few.things.len(), few.dust), (1, vec![vec![1], vec![1]]));
        let crowd = || std::iter::once(body()).chain((0..100).map(speck)).collect::<Vec<_>>();
        let many = grouped(&[crowd(), crowd()]);
        assert_eq!((many.things.len(), many.dust[0].len()), (1, 100));
        // Specks of one drawing lie elsewhere than those of another, but a spark may grow where it is.
        let grown = grouped(&[
            vec![body(), part(30.0, 20.0, 21.0, INK)],
            vec![body(), part(40.0, 10.0, 60.0, INK)],
        ]);
        assert_eq!(grown.things.len(), 2);
        // A spark as small as a speck that both drawings have is a thing, and so is one that is kept.
        let spark = grouped(&[vec![body(), speck(20)], vec![body(), speck(20)]]);
        assert_eq!(spark.things.len(), 2);
        let kept = group(&[vec![body(), speck(1)], vec![body()]], &|pose, part| {
            (pose, part) == (0, 1)
        });
        assert_eq!(kept.things, [[Some(0), Some(0)], [Some(1), None]]);
    }
}
